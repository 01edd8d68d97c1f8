# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs of five-axis machines: axis letters, positions and directions in the rotating part
frame, feeds."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters, StartParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.program import LayerStart, Wait, slide_feeds
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from tests.programs import build

PLATFORM = (10.0, -4.0, 30.0, 0.0, 0.0, 0.4)


def spiral(distance, turn=1.2, n=120, start=0.0):
    """An open bead that climbs around a cone with the tool along the cone's normal."""
    base = Developable(60.0, 200.0).offset(distance)
    theta, z = start + np.linspace(0.0, turn, n), np.linspace(10.0, 70.0, n)
    rho = base.radius * (1.0 - z / base.height)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    build_ = base.normals(points)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(points, build_, build_, 2.0 * math.pi * length / length[-1], np.full(n, 8.0), False)


def planned(machine, layers=2):
    beads = [spiral(3.0 * k, start=0.5 * k) for k in range(layers)]
    parameters = CellParameters(
        machine=machine, setup="rotary-table", platform=PLATFORM, mount="part"
    )
    cell = cells.resolve(parameters, np.eye(4), "developable")
    toolpath = Toolpath(
        tuple(Layer((bead,)) for bead in beads), np.eye(4), 3.0, 0.02, family="developable"
    )
    path = plan_joints(toolpath, cell, JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    motion, issues = assemble(path, cell, ProcessParameters(travel_speed=8.0))
    assert not issues
    return cell, motion


def program(cell, run, **options):
    return build(
        run,
        cell,
        ProcessParameters(travel_speed=8.0),
        ProgramParameters(post="linuxcnc", **options),
        "cone",
    )


@pytest.mark.parametrize(
    ("machine", "names"),
    [
        ("table-xyzac", "XYZAC"),
        ("table-xyzbc", "XYZBC"),
        ("head-table-xyzbc", None),
        ("head-xyzab", None),
    ],
)
def test_axes_go_by_their_letters(machine, names):
    parameters = CellParameters(
        machine=machine, setup="rotary-table", platform=PLATFORM, mount="part"
    )
    cell = cells.resolve(parameters, np.eye(4), "developable")
    _, motion = planned("table-xyzac")
    program_ = build(motion, cell, ProcessParameters(), ProgramParameters(post="siemens"), "x")
    assert (
        sorted(program_.axis_names) == sorted(set(program_.axis_names))
        and len(program_.axis_names) == 5
    )
    assert [
        kind for name, kind in zip(program_.axis_names, program_.axis_kinds) if name in "XYZ"
    ] == ["linear"] * 3
    assert [
        kind for name, kind in zip(program_.axis_names, program_.axis_kinds) if name in "ABC"
    ] == ["rotary"] * 2
    if names:
        assert "".join(program_.axis_names) == names


@pytest.mark.parametrize("origin", ["auto", (5.0, 6.0, 7.0, 0.3, 0.0, -0.8)])
def test_positions_and_directions_turn_with_the_part(origin):
    """Positions and directions rotate with the part."""
    cell, motion = planned("table-xyzac")
    program_ = program(cell, motion, motion="cartesian", origin=origin)
    on_part = cell.poses.mount if origin == "auto" else frames.bryant(origin)
    part_to_origin = frames.inverse(on_part)
    rows = motion.moves
    position, direction = (
        np.concatenate([getattr(m, name) for m in program_.moves])
        for name in ("position", "direction")
    )
    np.testing.assert_allclose(
        position,
        motion.position[rows] @ part_to_origin[:3, :3].T + part_to_origin[:3, 3],
        atol=1e-9,
    )
    np.testing.assert_allclose(direction, motion.tool[rows] @ part_to_origin[:3, :3].T, atol=1e-12)
    # the trunnion's own formulas, with the work offset stated by the program
    offset = frames.bryant(program_.carried)
    x, y, z = (position @ offset[:3, :3].T + offset[:3, 3]).T
    joints = np.concatenate([m.joints for m in program_.moves])
    a, c = joints[:, 3], joints[:, 4]
    xr, yr = np.cos(c) * x - np.sin(c) * y, np.sin(c) * x + np.cos(c) * y
    np.testing.assert_allclose(joints[:, 0], xr, atol=1e-8)
    np.testing.assert_allclose(
        joints[:, 1], np.cos(a) * (yr - 20.0) - np.sin(a) * (z - 10.0) + 20.0, atol=1e-8
    )
    np.testing.assert_allclose(
        joints[:, 2], np.sin(a) * (yr - 20.0) + np.cos(a) * (z - 10.0) + 10.0, atol=1e-8
    )
    turned = (
        frames.rotation_about((1.0, 0.0, 0.0), a)
        @ frames.rotation_about((0.0, 0.0, 1.0), c)
        @ offset[:3, :3]
    )
    np.testing.assert_allclose(
        np.einsum("nij,nj->ni", turned, direction), np.tile([0.0, 0.0, 1.0], (len(a), 1)), atol=1e-9
    )
    assert all(m.rotation is None and m.configuration is None for m in program_.moves)


def test_feed_of_the_linear_axes_keeps_the_speed_at_the_bead():
    """The feed of the linear axes keeps the speed at the bead."""
    cell, motion = planned("table-xyzac")
    program_ = program(cell, motion)
    start_joints = program_.moves[0].joints[-1]
    run = program_.moves[1]
    feeds = slide_feeds(start_joints, run.joints, run.duration, program_.axis_kinds)
    # driven with these feeds in small steps: the tip moves along the bead at the requested speed
    steps = 200
    for k in range(len(feeds)):
        start, end = (start_joints if k == 0 else run.joints[k - 1]), run.joints[k]
        axes = start + np.linspace(0.0, 1.0, steps + 1)[:, None] * (end - start)
        tip = cell.tip_in_part(cell.machine.chain.forward(axes))[0]
        slid = np.linalg.norm(np.diff(axes[:, :3], axis=0), axis=1).sum()
        length = np.linalg.norm(np.diff(tip, axis=0), axis=1).sum()
        assert length / (slid / feeds[k]) == pytest.approx(8.0, rel=2e-3)


def test_where_only_the_table_turns_the_linear_axes_have_no_feed():
    kinds = ("linear", "linear", "linear", "rotary", "rotary")
    joints = np.array(
        [[1.0, 2.0, 3.0, 0.0, 0.1], [1.0, 2.0, 3.0, 0.0, 0.2], [4.0, 6.0, 3.0, 0.0, 0.2]]
    )
    feeds = slide_feeds(joints[0], joints[1:], np.array([0.5, 0.5]), kinds)
    np.testing.assert_allclose(feeds, [0.0, 10.0])


@pytest.mark.parametrize(("between", "written"), [(0.0, [30.0, 7.5]), (10.0, [30.0, 10.0, 10.0])])
def test_waits_of_layers_are_written(between, written):
    """Waits between layers are written after the retract and before the next layer."""
    cell, motion = planned("table-xyzac", 4)
    process = ProcessParameters(between_layers=BetweenLayersParameters(wait=between))
    for start, expected_slice in (
        (StartParameters(), slice(None)),
        (StartParameters(layer=1), slice(1, None)),
    ):
        parameters = ProgramParameters(post="linuxcnc", start_at=start)
        program_ = build(motion, cell, process, parameters, "cone", (0.0, 30.0, 0.0, 7.5))
        assert [block.seconds for block in program_.blocks if isinstance(block, Wait)] == written[
            expected_slice
        ]
        # the retract from the previous bead, then the wait, then the next layer
        for number, block in enumerate(program_.blocks):
            if isinstance(block, Wait):
                assert program_.blocks[number - 1].kind == "rapid" and isinstance(
                    program_.blocks[number + 1], LayerStart
                )
