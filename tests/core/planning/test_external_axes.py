# SPDX-License-Identifier: LGPL-2.1-or-later
"""A robot with the torch and a positioner with the part: driven in the world by two PyKDL chains
built here from the files, one for the robot and one for the positioner."""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import PyKDL
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.cell_records import EXTERNAL, ExternalMechanism
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import MotionRules

ROBOT, POSITIONER = "kuka-kr8-r2100-2-arc-hw", "motoman-motopos-d500"
STANDS = (1400.0, 120.0, -50.0, 0.0, 0.0, 30.0)  # mm, deg
TORCH, PLATFORM = (20.0, 0.0, 300.0, 0.0, 35.0, 0.0), 5.0
UP = np.array([0.0, 0.0, 1.0])


def cell_for(toolpath, positioner=POSITIONER, stands=STANDS, **options):
    return cells.resolve(
        CellParameters(
            **{
                "machine": ROBOT,
                "setup": "tool-on-robot",
                "branch": "auto",
                "platform": PLATFORM,
                "external": f"{positioner} at {' '.join(map(str, stands))} carries part",
                "nozzle": NozzleParameters(tool=(*TORCH[:3], *np.radians(TORCH[3:]))),
                **options,
            }
        ),
        toolpath.frame,
    )


def kdl_pose(xyz, rpy_deg=(0.0, 0.0, 0.0)):
    return PyKDL.Frame(PyKDL.Rotation.RPY(*np.radians(rpy_deg)), PyKDL.Vector(*xyz))


def kdl_chain(path):
    """The joints of a machine file from base plate to flange."""
    description = json.loads(Path(path).read_text(encoding="utf-8"))
    chain = PyKDL.Chain()
    for joint in description["joints"]:
        chain.addSegment(PyKDL.Segment(PyKDL.Joint(), kdl_pose(joint["origin"], joint["rpy"])))
        axis = PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*joint["axis"]), PyKDL.Joint.RotAxis)
        chain.addSegment(PyKDL.Segment(axis, PyKDL.Frame()))
    chain.addSegment(
        PyKDL.Segment(
            PyKDL.Joint(), kdl_pose(description["flange"]["origin"], description["flange"]["rpy"])
        )
    )
    base = description.get("base", {"origin": (0, 0, 0), "rpy": (0, 0, 0)})
    return chain, kdl_pose(base["origin"], base["rpy"]).Inverse()


def drive_chain(chain, values):
    angles = PyKDL.JntArray(len(values))
    for index, value in enumerate(values):
        angles[index] = value
    frame = PyKDL.Frame()
    PyKDL.ChainFkSolverPos_recursive(chain).JntToCart(angles, frame)
    return frame


def bryant(six):
    """Rx Ry Rz, as the interface defines."""
    x, y, z = np.radians(six[3:])
    turned = PyKDL.Rotation.RotX(x) * PyKDL.Rotation.RotY(y) * PyKDL.Rotation.RotZ(z)
    return PyKDL.Frame(turned, PyKDL.Vector(*six[:3]))


def in_the_world(joints, positioner_file, stands=STANDS):
    """For joint values (n, 8), computed through the world: tip and tool axis in the part's frame
    (mounted upright on the platform), and the tool axis in the world."""
    robot, robot_base = kdl_chain(machines.file_of(ROBOT))
    table, table_base = kdl_chain(positioner_file)
    tips, tools, upward = [], [], []
    for row in joints:
        tip = robot_base * drive_chain(robot, row[:6]) * bryant(TORCH)
        part_frame = (
            bryant(stands)
            * table_base
            * drive_chain(table, row[6:])
            * kdl_pose((0.0, 0.0, PLATFORM))
        )
        tip_in_part = part_frame.Inverse() * tip
        tips.append(list(tip_in_part.p))
        tools.append([-component for component in tip_in_part.M.UnitZ()])
        upward.append([-component for component in tip.M.UnitZ()])
    return np.array(tips), np.array(tools), np.array(upward)


def file_of_built_in():
    return machines.BUILT_IN / "mechanisms" / f"{POSITIONER}.json"


def levelled_to(toolpath, degrees):
    return dataclasses.replace(toolpath, rules=MotionRules(max_from_vertical=math.radians(degrees)))


def feasible(toolpath, cell, **joints):
    planned = plan_joints(toolpath, cell, JointParameters(**joints))
    assert planned.feasible, [issue.message for issue in planned.issues]
    return planned


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return levelled_to(sliced("sphere", 10.0, chord_error=0.1), 10.0)


@pytest.fixture(scope="module")
def planned(hemisphere):
    return feasible(hemisphere, cell_for(hemisphere))


def test_every_point_is_met_and_the_tool_is_upright(hemisphere, planned):
    points = np.concatenate([path.bead.points for path in planned.beads])
    axes = np.concatenate([path.bead.tool for path in planned.beads])
    tip, tool, upward = in_the_world(planned.joints, file_of_built_in())
    frame = hemisphere.frame
    tip, tool = tip @ frame[:3, :3].T + frame[:3, 3], tool @ frame[:3, :3].T
    assert np.abs(tip - points).max() < 1e-6
    assert np.abs(tool - axes).max() < 1e-9
    assert np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0))).max() < 10.0 + 1e-6
    # the tool leans more than that in the part, so the positioner rotates
    assert np.degrees(np.arccos(axes @ frame[:3, 2])).max() > 40.0


def test_between_the_points_too(hemisphere, planned):
    """Between the points the tip stays within the chord error."""
    for path in planned.beads[::3]:
        start, end = path.joints[:-1], path.joints[1:]
        for share in (0.2, 0.5, 0.9):
            tip, _, upward = in_the_world(start + share * (end - start), file_of_built_in())
            tip = tip @ hemisphere.frame[:3, :3].T + hemisphere.frame[:3, 3]
            along = np.diff(path.bead.points, axis=0)
            gap = tip - path.bead.points[:-1]
            share_of_segment = np.clip((gap * along).sum(1) / (along * along).sum(1), 0.0, 1.0)
            assert (
                np.linalg.norm(gap - share_of_segment[:, None] * along, axis=1).max()
                <= hemisphere.chord_error + 1e-6
            )
            assert np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0))).max() < 10.5


def test_rapids_keep_the_limits_and_the_positioner_stands_still_on_retracts(hemisphere, planned):
    cell = cell_for(hemisphere)
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    lower = np.r_[cell.robot.limits("maker").lower, np.radians([-134.9946, -199.9966])]
    upper = np.r_[cell.robot.limits("maker").upper, np.radians([134.9946, 199.9966])]
    assert (motion.joints >= lower - 1e-9).all() and (motion.joints <= upper + 1e-9).all()
    retracts = np.flatnonzero(motion.role == 1)
    assert (
        len(retracts)
        and np.abs(motion.joints[retracts, 6:] - motion.joints[retracts - 1, 6:]).max() < 1e-12
    )


def test_nothing_turns_that_need_not(sliced):
    toolpath = sliced("sphere", 10.0, chord_error=0.1)  # any angle is allowed
    external = plan_joints(toolpath, cell_for(toolpath), JointParameters(method="constant")).joints[
        :, 6:
    ]
    assert (external == external[0]).all()


def test_a_turntable_turns_no_less(planned):
    """One turn around a part of revolution takes a whole turn of the table, whatever the other axes
    do."""
    turned = sum(np.abs(np.diff(path.joints[:, 7])).sum() for path in planned.beads)
    tilted = sum(np.abs(np.diff(path.joints[:, 6])).sum() for path in planned.beads)
    assert turned <= 2.0 * math.pi * len(planned.beads) + 1e-6
    assert tilted < 1e-6


SKEW = {
    "id": "skew",
    "title": "Skew positioner",
    "sources": ["made up"],
    "joints": [
        {
            "name": "tilt",
            "origin": [10, -20, 400],
            "rpy": [3, 0, 5],
            "axis": [0, 1, 0],
            "max_speed": 90,
        },
        {
            "name": "turn",
            "origin": [35, 12, 60],
            "rpy": [0, 8, 0],
            "axis": [0, 0, 1],
            "max_speed": 180,
        },
    ],
    "flange": {"origin": [2, -3, 70], "rpy": [1, 0, 40]},
    "controller": {"matrix": [[1, 0], [0, 1]], "offset": [0, 0], "remark": "as it is", "posts": []},
    "limits": {"maker": {"axes": [[-140, 140], [-400, 400]], "source": "made up"}},
}


@pytest.fixture(scope="module")
def skew(tmp_path_factory):
    """A positioner whose axes neither intersect nor are perpendicular."""
    path = tmp_path_factory.mktemp("cell") / "skew.json"
    path.write_text(json.dumps(SKEW), encoding="utf-8")
    chain, base = kdl_chain(path)
    poses = []
    for values in ((0.0, 0.0), (40.0, -70.0), (-90.0, 300.0)):
        flange = base.Inverse() * drive_chain(chain, np.radians(values))
        poses.append(
            {
                "q": values,
                "origin": list(flange.p),
                "rotation": [[flange.M[row, column] for column in range(3)] for row in range(3)],
            }
        )
    path.write_text(json.dumps({**SKEW, "check_poses": poses}), encoding="utf-8")
    return path


def test_axes_that_neither_meet_nor_are_square(hemisphere, skew):
    planned = feasible(hemisphere, cell_for(hemisphere, positioner=skew))
    points = np.concatenate([path.bead.points for path in planned.beads])
    tip, _, upward = in_the_world(planned.joints, skew)
    assert np.abs(tip @ hemisphere.frame[:3, :3].T + hemisphere.frame[:3, 3] - points).max() < 1e-6
    assert np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0))).max() < 10.0 + 1e-6


def test_what_cannot_be_brought_upright_is_told(hemisphere, skew, tmp_path):
    description = json.loads(Path(skew).read_text(encoding="utf-8"))
    description["limits"]["maker"]["axes"] = [[-20, 20], [-400, 400]]
    path = tmp_path / "short.json"
    path.write_text(json.dumps(description), encoding="utf-8")
    planned = plan_joints(
        hemisphere, cell_for(hemisphere, positioner=path), JointParameters(method="constant")
    )
    assert not planned.feasible
    assert {"NOT_LEVEL", "LIMIT"} & {issue.code for issue in planned.issues}


@pytest.mark.parametrize(("setup", "holds"), [("tool-on-robot", False), ("part-on-robot", True)])
def test_what_leans_is_told_where_nothing_turns_the_part(hemisphere, setup, holds):
    """With the tool on the robot its axis leans like the wall, plus or minus the platform's slant;
    a part on the robot is always brought under the torch."""
    stands = (1300.0, 0.0, 300.0, 0.0, *np.radians([25.0, 0.0]))
    cell = cells.resolve(
        CellParameters(
            machine=ROBOT,
            setup=setup,
            branch="auto",
            deposition_point=stands,
            world_up="0 0 2",
            nozzle=NozzleParameters(tool=(0.0, 0.0, 300.0, 0.0, 0.0, 0.0)),
        ),
        hemisphere.frame,
    )
    planned = plan_joints(levelled_to(hemisphere, 40.0), cell, JointParameters(method="constant"))
    not_level = {
        (issue.layer, issue.bead): issue for issue in planned.issues if issue.code == "NOT_LEVEL"
    }
    slant = np.array(
        math.sin(math.radians(25.0)) * np.array([1.0, 0.0, 0.0]) + math.cos(math.radians(25.0)) * UP
    )
    for layer, number, bead in hemisphere:
        turned = np.array(
            [
                [math.cos(math.radians(25.0)), 0.0, math.sin(math.radians(25.0))],
                [0.0, 1.0, 0.0],
                [-math.sin(math.radians(25.0)), 0.0, math.cos(math.radians(25.0))],
            ]
        )
        axes = slant[None] if holds else bead.tool @ hemisphere.frame[:3, :3] @ turned.T
        leans = math.degrees(math.acos(float(np.clip((axes @ UP).min(), -1.0, 1.0))))
        assert ((layer, number) in not_level) == (leans > 40.0)
        if leans > 40.0:
            assert f"would be {leans:.3g} deg from the vertical" in not_level[layer, number].message
            assert (
                "no axis turns the part; put the part on a positioner"
                in not_level[layer, number].message
            )
    assert bool(not_level) != holds


@pytest.mark.parametrize(
    ("changed", "code"),
    [
        ({"external": "no-such-table at 0 0 0 0 0 0 carries part"}, "UNKNOWN_MACHINE"),
        ({"external": f"{POSITIONER} at 0 0 0 0 0 0 carries robot"}, "NOT_YET"),
        ({"external": "kuka-kr16-2 at 0 0 0 0 0 0 carries part"}, "NOT_YET"),
        ({"external": f"{ROBOT} at 0 0 0 0 0 0 carries part"}, "BAD_VALUE"),
        ({"external": f"{ROBOT} at 0 0 0 0 0 0 carries robot"}, "BAD_VALUE"),
        ({"setup": "part-on-robot"}, "WRONG_SETUP"),
    ],
)
def test_refused_with_a_reason(hemisphere, changed, code):
    with pytest.raises(InputError) as error:
        cell_for(hemisphere, **changed)
    assert error.value.code == code


def test_two_mechanisms_of_one_name(hemisphere, skew, tmp_path):
    description = json.loads(Path(skew).read_text(encoding="utf-8"))
    one_axis = {
        **description,
        "joints": description["joints"][:1],
        "limits": {"maker": {"axes": [[-90, 90]], "source": "made up"}},
        "controller": {"matrix": [[1]], "offset": [0], "remark": "as it is"},
    }
    chain = PyKDL.Chain()
    joint = description["joints"][0]
    chain.addSegment(PyKDL.Segment(PyKDL.Joint(), kdl_pose(joint["origin"], joint["rpy"])))
    chain.addSegment(
        PyKDL.Segment(
            PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*joint["axis"]), PyKDL.Joint.RotAxis),
            PyKDL.Frame(),
        )
    )
    chain.addSegment(
        PyKDL.Segment(
            PyKDL.Joint(), kdl_pose(description["flange"]["origin"], description["flange"]["rpy"])
        )
    )
    one_axis["check_poses"] = [
        {
            "q": [degrees],
            "origin": list(pose_at.p),
            "rotation": [[pose_at.M[i, k] for k in range(3)] for i in range(3)],
        }
        for degrees in (0.0, 30.0, -80.0)
        for pose_at in [drive_chain(chain, [math.radians(degrees)])]
    ]
    one_axis_file = tmp_path / "other.json"
    one_axis_file.write_text(json.dumps(one_axis), encoding="utf-8")
    pose_at = " ".join(map(str, STANDS))
    with pytest.raises(InputError, match="share the name 'skew'; change the id of one file"):
        cell_for(
            hemisphere,
            external=f"{one_axis_file} at {pose_at} carries part; {skew} at 1400 0 300 0 0 0 carries part",
        )
    twice = f"{one_axis_file} at {pose_at} carries part"
    with pytest.raises(InputError, match="'skew' is listed twice"):
        cell_for(hemisphere, external=f"{twice}; {twice}")
    # the same machine twice, one on the other, is allowed
    assert (
        cell_for(
            hemisphere, external=f"{twice}; {one_axis_file} at 1400 0 400 0 0 90 carries part"
        ).machine.chain.axes
        == 8
    )


@pytest.mark.parametrize(
    "text",
    [
        "motoman-motopos-d500",
        "d500 at 1 2 3 carries part",
        "d500 at 1 2 3 4 5 x carries part",
        "d500 at 1 2 3 4 5 6 carries nozzle",
        "d500 at 1 2 3 4 5 inf carries part",
    ],
)
def test_texts_that_name_no_axes(text):
    with pytest.raises(InputError):
        CellParameters(external=text)


def test_text_and_back():
    named = (
        ExternalMechanism("d500", (1500.25, 0.0, -3.0, 0.0, 0.1, math.pi)),
        ExternalMechanism("track", (0.0,) * 6, "robot"),
    )
    again = EXTERNAL.read("; ".join(map(str, named)))
    assert [mechanism.machine for mechanism in again] == ["d500", "track"] and again[
        1
    ].carries == "robot"
    assert np.allclose(
        [mechanism.pose for mechanism in again], [mechanism.pose for mechanism in named], atol=1e-9
    )
