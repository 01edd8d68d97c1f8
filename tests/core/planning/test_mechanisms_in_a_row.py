# SPDX-License-Identifier: LGPL-2.1-or-later
"""One table, and one mounted on another: driven in the world by PyKDL chains built from their
numbers."""

import dataclasses
import json
import math

import numpy as np
import pytest

from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import MotionRules
from tests.core.planning.test_external_axes import (
    PLATFORM,
    ROBOT,
    TORCH,
    UP,
    bryant,
    drive_chain,
    kdl_chain,
    kdl_pose,
)

STANDS = {
    "turn": (1250.0, 80.0, 200.0, 0.0, 0.0, 20.0),
    "tilt": (1300.0, 40.0, 150.0, 0.0, 0.0, -15.0),
}
ON_TILT = (
    1310.0,
    30.0,
    420.0,
    2.0,
    0.0,
    50.0,
)  # of the turntable in the world, with the tilting table at zero
TABLES = {
    "turn": {
        "origin": [5, 0, 60],
        "rpy": [0, 2, 0],
        "axis": [0, 0, 1],
        "limits": [-400, 400],
        "flange": {"origin": [0, 0, 40], "rpy": [0, 0, 10]},
    },
    "tilt": {
        "origin": [0, 10, 180],
        "rpy": [0, 0, 4],
        "axis": [0, 1, 0],
        "limits": [-110, 110],
        "flange": {"origin": [20, 0, 60], "rpy": [0, 0, 0]},
    },
}


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Machine files of a turntable and a tilting table."""
    folder, files = tmp_path_factory.mktemp("tables"), {}
    for name, table in TABLES.items():
        path = files[name] = folder / f"{name}.json"
        joint = {
            "name": name,
            **{key: table[key] for key in ("origin", "rpy", "axis")},
            "max_speed": 120,
        }
        description = {
            "id": name,
            "title": name,
            "sources": ["made up"],
            "joints": [joint],
            "flange": table["flange"],
            "controller": {"matrix": [[1]], "offset": [0], "remark": "as it is", "posts": []},
            "limits": {"maker": {"axes": [table["limits"]], "source": "made up"}},
            "check_poses": [],
        }
        path.write_text(json.dumps(description), encoding="utf-8")
        chain, _ = kdl_chain(path)
        description["check_poses"] = [
            {
                "q": [degrees],
                "origin": list(flange.p),
                "rotation": [[flange.M[i, k] for k in range(3)] for i in range(3)],
            }
            for degrees in (0.0, 35.0, -80.0)
            for flange in [drive_chain(chain, [math.radians(degrees)])]
        ]
        path.write_text(json.dumps(description), encoding="utf-8")
    return files


def cell_for(toolpath, external):
    return cells.resolve(
        CellParameters(
            machine=ROBOT,
            setup="tool-on-robot",
            branch="auto",
            platform=PLATFORM,
            external=external,
            nozzle=NozzleParameters(tool=(*TORCH[:3], *np.radians(TORCH[3:]))),
        ),
        toolpath.frame,
    )


def named(path, stands):
    return f"{path} at {' '.join(map(str, stands))} carries part"


def in_the_world(toolpath, joints, stand):
    """Tip and tool axis in part coordinates, and the tool axis in the world, for joints (n, axes);
    `stand` gives the pose of the plate that carries the part for the external values."""
    robot, robot_base = kdl_chain(machines.file_of(ROBOT))
    poses = []
    for row in joints:
        tip = robot_base * drive_chain(robot, row[:6]) * bryant(TORCH)
        tip_in_plate = (stand(row[6:]) * kdl_pose((0.0, 0.0, PLATFORM))).Inverse() * tip
        poses.append(
            [
                list(tip_in_plate.p),
                [-x for x in tip_in_plate.M.UnitZ()],
                [-x for x in tip.M.UnitZ()],
            ]
        )
    tip, tool, upward = np.array(poses).transpose(1, 0, 2)
    turn, origin = toolpath.frame[:3, :3], toolpath.frame[:3, 3]
    return tip @ turn.T + origin, tool @ turn.T, upward


def check_tips(toolpath, planned, stand):
    assert planned.feasible, [issue.message for issue in planned.issues]
    tip, tool, upward = in_the_world(toolpath, planned.joints, stand)
    assert np.abs(tip - np.concatenate([path.bead.points for path in planned.beads])).max() < 1e-6
    assert np.abs(tool - np.concatenate([path.bead.tool for path in planned.beads])).max() < 1e-9
    return np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0)))


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return sliced("sphere", 15.0, chord_error=0.2)


def test_a_turntable_alone_turns_what_the_robot_need_not(hemisphere, tables):
    """A turntable reduces the motion of the robot."""
    cell = cell_for(hemisphere, named(tables["turn"], STANDS["turn"]))
    chain, base = kdl_chain(tables["turn"])
    stand = lambda values: bryant(STANDS["turn"]) * base * drive_chain(chain, values)  # noqa: E731
    optimised_path, level_path = (
        plan_joints(hemisphere, cell, JointParameters(external_axes=rule))
        for rule in ("optimised", "level")
    )
    for planned in (optimised_path, level_path):
        check_tips(hemisphere, planned, stand)
        lower, upper = np.radians(TABLES["turn"]["limits"])
        assert (planned.joints[:, 6] >= lower).all() and (planned.joints[:, 6] <= upper).all()
    still, moved = (
        level_path.joints[:, 6],
        np.concatenate([np.diff(path.joints[:, 6]) for path in optimised_path.beads]),
    )
    assert (still == still[0]).all()
    assert np.abs(moved).sum() > math.pi

    def largest_range(planned):
        return max(np.ptp(path.joints[:, :6], axis=0).max() for path in planned.beads)

    assert largest_range(optimised_path) < largest_range(level_path)


def test_a_table_on_another_one_keeps_the_tool_upright(hemisphere, tables):
    levelled = dataclasses.replace(
        hemisphere, rules=MotionRules(max_from_vertical=math.radians(10.0))
    )
    cell = cell_for(
        levelled, f"{named(tables['tilt'], STANDS['tilt'])}; {named(tables['turn'], ON_TILT)}"
    )
    (tilt, tilt_base), (turn, turn_base) = kdl_chain(tables["tilt"]), kdl_chain(tables["turn"])

    def plate(value):
        return bryant(STANDS["tilt"]) * tilt_base * drive_chain(tilt, [value])

    def stand(values):
        return (
            plate(values[0])
            * plate(0.0).Inverse()
            * bryant(ON_TILT)
            * turn_base
            * drive_chain(turn, values[1:])
        )

    planned = plan_joints(levelled, cell, JointParameters())
    assert check_tips(levelled, planned, stand).max() < 10.0 + 1e-6
    assert (
        np.ptp(planned.joints[:, 6]) > math.radians(5.0) and np.ptp(planned.joints[:, 7]) > math.pi
    )
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    for axis, name in ((6, "tilt"), (7, "turn")):
        lower, upper = np.radians(TABLES[name]["limits"])
        assert (motion.joints[:, axis] >= lower).all() and (motion.joints[:, axis] <= upper).all()
