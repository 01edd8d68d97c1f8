# SPDX-License-Identifier: LGPL-2.1-or-later
"""One table alone, and one that stands on another: driven in the world by PyKDL chains built here of the numbers."""

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
    driven,
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
)  # of the turning one in the world, with the tilting one at zero
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
    """Machine files of a table that turns and of one that tilts."""
    folder, found = tmp_path_factory.mktemp("tables"), {}
    for name, table in TABLES.items():
        path = found[name] = folder / f"{name}.json"
        joint = {
            "name": name,
            **{key: table[key] for key in ("origin", "rpy", "axis")},
            "max_speed": 120,
        }
        told = {
            "id": name,
            "title": name,
            "sources": ["made up"],
            "joints": [joint],
            "flange": table["flange"],
            "controller": {"matrix": [[1]], "offset": [0], "remark": "as it is", "posts": []},
            "limits": {"maker": {"axes": [table["limits"]], "source": "made up"}},
            "check_poses": [],
        }
        path.write_text(json.dumps(told), encoding="utf-8")
        chain, _ = kdl_chain(path)
        told["check_poses"] = [
            {
                "q": [degrees],
                "origin": list(at.p),
                "rotation": [[at.M[i, k] for k in range(3)] for i in range(3)],
            }
            for degrees in (0.0, 35.0, -80.0)
            for at in [driven(chain, [math.radians(degrees)])]
        ]
        path.write_text(json.dumps(told), encoding="utf-8")
    return found


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
    """Tip and tool axis in part coordinates, and the tool axis in the world, of joints (n, axes); `stand` gives where the
    plate that carries the part is for the external ones."""
    robot, robot_base = kdl_chain(machines.file_of(ROBOT))
    found = []
    for row in joints:
        tip = robot_base * driven(robot, row[:6]) * bryant(TORCH)
        seen = (stand(row[6:]) * kdl_pose((0.0, 0.0, PLATFORM))).Inverse() * tip
        found.append([list(seen.p), [-x for x in seen.M.UnitZ()], [-x for x in tip.M.UnitZ()]])
    tip, tool, upward = np.array(found).transpose(1, 0, 2)
    turn, origin = toolpath.frame[:3, :3], toolpath.frame[:3, 3]
    return tip @ turn.T + origin, tool @ turn.T, upward


def on_its_points(toolpath, planned, stand):
    assert planned.feasible, [issue.message for issue in planned.issues]
    tip, tool, upward = in_the_world(toolpath, planned.joints, stand)
    assert np.abs(tip - np.concatenate([path.bead.points for path in planned.beads])).max() < 1e-6
    assert np.abs(tool - np.concatenate([path.bead.tool for path in planned.beads])).max() < 1e-9
    return np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0)))


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return sliced("sphere", 15.0, chord_error=0.2)


def test_a_turntable_alone_turns_what_the_robot_need_not(hemisphere, tables):
    cell = cell_for(hemisphere, named(tables["turn"], STANDS["turn"]))
    chain, base = kdl_chain(tables["turn"])
    stand = lambda values: bryant(STANDS["turn"]) * base * driven(chain, values)  # noqa: E731
    turned, held = (
        plan_joints(hemisphere, cell, JointParameters(external_axes=rule))
        for rule in ("optimised", "level")
    )
    for planned in (turned, held):
        on_its_points(hemisphere, planned, stand)
        lower, upper = np.radians(TABLES["turn"]["limits"])
        assert (planned.joints[:, 6] >= lower).all() and (planned.joints[:, 6] <= upper).all()
    still, moved = (
        held.joints[:, 6],
        np.concatenate([np.diff(path.joints[:, 6]) for path in turned.beads]),
    )
    assert (still == still[0]).all()
    assert np.abs(moved).sum() > math.pi

    def most(planned):
        return max(np.ptp(path.joints[:, :6], axis=0).max() for path in planned.beads)

    assert most(turned) < most(held)


def test_a_table_on_another_one_keeps_the_tool_upright(hemisphere, tables):
    levelled = dataclasses.replace(
        hemisphere, rules=MotionRules(max_from_vertical=math.radians(10.0))
    )
    cell = cell_for(
        levelled, f"{named(tables['tilt'], STANDS['tilt'])}; {named(tables['turn'], ON_TILT)}"
    )
    (tilt, tilt_base), (turn, turn_base) = kdl_chain(tables["tilt"]), kdl_chain(tables["turn"])

    def plate(value):
        return bryant(STANDS["tilt"]) * tilt_base * driven(tilt, [value])

    def stand(values):
        return (
            plate(values[0])
            * plate(0.0).Inverse()
            * bryant(ON_TILT)
            * turn_base
            * driven(turn, values[1:])
        )

    planned = plan_joints(levelled, cell, JointParameters())
    assert on_its_points(levelled, planned, stand).max() < 10.0 + 1e-6
    assert (
        np.ptp(planned.joints[:, 6]) > math.radians(5.0) and np.ptp(planned.joints[:, 7]) > math.pi
    )
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    for axis, name in ((6, "tilt"), (7, "turn")):
        lower, upper = np.radians(TABLES[name]["limits"])
        assert (motion.joints[:, axis] >= lower).all() and (motion.joints[:, axis] <= upper).all()
