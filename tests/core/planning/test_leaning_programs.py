# SPDX-License-Identifier: LGPL-2.1-or-later
"""A blade with sharp corners printed by a deflected and a tilted torch, from the solid to programs
read back."""

import dataclasses
import math

import numpy as np
import pytest

from freecad_am import verify as verification
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.on_hub import Base, Group, SolidsOnHub
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.filled import DevelopableParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.process import wire
from freecad_am.core.strategies.solids.plan import plan as plan_solids
from freecad_am.core.toolpath import Bead, Layer, SpeedLaw, Toolpath
from freecad_am.posts import catalogue
from tests.core.strategies.test_developable import box
from tests.programs import build

CHORD_ERROR, LEAN, MAX_TURN_DEG_PER_MM = (
    0.05,
    20.0,
    3.0,
)  # mm; deg; deg/mm, the default of max_turn on hubs
HUB = Developable(60.0)
UP = np.array(
    [[0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)  # X of the hub to Z
TABLE = CellParameters(
    machine="table-xyzac",
    setup="rotary-table",
    platform=(5.0, -8.0, 20.0, 0.0, 0.0, 0.3),
    mount="part",
)
ON_ROBOT = CellParameters(
    setup="tool-on-robot",
    deposition_point=(1000.0, 0.0, 200.0, 0.0, 0.0, 0.0),
    mount="part",
    nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
)


def toolpath(torch_mode, frame, **changes):
    """The blade's first two layers, 50 x 22 mm, with a deflected or tilted torch, at the speeds of
    a bead model."""
    body = box(np.array([40.0, -11.0, 20.0]), np.array([76.0, 11.0, 70.0]))
    body = dataclasses.replace(body, vertices=body.vertices @ frame[:3, :3].T)
    model = wire.load("csw")
    options = {"deflection": math.radians(LEAN)} if torch_mode == "deflected" else {}
    strategy = DevelopableParameters(
        layer_height=8.0, chord_error=CHORD_ERROR, bead_spacing=6.0, **options
    )
    turned = BuildDirectionParameters(
        **{"tilt": math.radians(LEAN) if torch_mode == "tilted" else 0.0, **changes}
    )
    process = ProcessParameters(bead_width=9.5, wire=WireParameters(feed=model.wire_feed))
    solid = SolidsOnHub("part", (Group(Base("hub", HUB, frame), (body,)),), 0.0)
    return plan_solids(solid, strategy, turned, process, model)


def motion_of(cell, path):
    planned = plan_joints(path, cell, JointParameters(degree=1))
    assert planned.feasible, [issue.message for issue in planned.issues]
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not has_errors(issues), issues
    return planned, motion


def read_back(cell, motion, post, kind):
    program = build(
        motion, cell, ProcessParameters(), ProgramParameters(post=post, motion=kind), "blade"
    )
    writer = catalogue.load(post)
    return verification.verify(cell, motion, program, writer.write(program), writer, CHORD_ERROR)


def measure_lean(motion, frame):
    """Lean from the hub's normals and rotation per mm, from the tips and torches of the motion."""
    rows = motion.deposit
    inside = motion.position[rows] @ frame[:3, :3]
    normal = np.column_stack(
        [inside[:, :2] / np.hypot(inside[:, 0], inside[:, 1])[:, None], np.zeros(len(inside))]
    )
    tool = motion.tool[rows] @ frame[:3, :3]

    def angle(a, b):
        return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))

    same = (np.diff(motion.layer[rows]) == 0) & (np.diff(motion.bead[rows]) == 0)
    lengths = np.linalg.norm(np.diff(inside, axis=0), axis=1)
    return angle(tool, normal), (angle(tool[1:], tool[:-1]) / np.maximum(lengths, 1e-12))[same]


@pytest.fixture(scope="module", params=["deflected", "tilted"])
def on_table(request):
    cell = cells.resolve(TABLE, np.eye(4), "developable")
    planned, motion = motion_of(cell, toolpath(request.param, np.eye(4)))
    return cell, planned, motion


@pytest.mark.parametrize("kind", ["joint", "cartesian"])
@pytest.mark.parametrize("post", ["siemens", "linuxcnc"])
@pytest.mark.always
def test_tables_lay_it(on_table, post, kind):
    cell, planned, motion = on_table
    assert not [issue for issue in planned.issues if issue.level != "note"], planned.issues
    lean, turn = measure_lean(motion, np.eye(4))
    assert abs(lean.max() - LEAN) < 0.05 and turn.max() < MAX_TURN_DEG_PER_MM * 1.01
    result = read_back(cell, motion, post, kind)
    assert result.issues == () and result.at_points_mm <= result.bound_mm


@pytest.mark.parametrize("held", ["deflected", "tilted"])
def test_a_robot_lays_it(held):
    cell = cells.resolve(ON_ROBOT, np.eye(4), "developable")
    _, motion = motion_of(cell, toolpath(held, UP))
    lean, turn = measure_lean(motion, UP)
    assert abs(lean.max() - LEAN) < 0.05 and turn.max() < MAX_TURN_DEG_PER_MM * 1.01
    for kind in ("joint", "cartesian"):
        result = read_back(cell, motion, "fanuc", kind)
        assert result.issues == () and result.at_points_mm <= result.bound_mm


def test_corners_without_a_limit_are_slowed_and_that_is_told():
    """Corners without a rotation limit are slowed, with a warning."""
    cell = cells.resolve(TABLE, np.eye(4), "developable")
    path = toolpath("deflected", np.eye(4), max_turn="inf")
    planned, motion = motion_of(cell, path)
    (warning,) = [issue for issue in planned.issues if issue.code == "SLOWED"]
    assert warning.level == "warning" and "short places" in warning.message
    bead = next(
        bead_path
        for bead_path in planned.beads
        if (bead_path.layer, bead_path.index) == (warning.layer, warning.bead)
    )
    assert bead.bead.speed[warning.point] == min(
        bead_path.bead.speed.min() for bead_path in planned.beads
    )
    moves = motion.deposit & (motion.point > 0)
    rate = (
        np.abs(np.diff(motion.joints, axis=0, prepend=motion.joints[:1]))[moves]
        / motion.duration[moves, None]
    )
    share = (rate / cell.machine.max_speed).max(axis=1)
    assert share.max() <= 1.0 + 1e-9
    assert read_back(cell, motion, "siemens", "joint").issues == ()
    endless = dataclasses.replace(
        cell, machine=dataclasses.replace(cell.machine, max_speed=1e6 * cell.machine.max_speed)
    )
    unlimited = plan_joints(path, endless, JointParameters(degree=1))
    slowed, total, largest = 0.0, 0.0, {"more width": 0.0, "more height": 0.0}
    for bead_path, unlimited_path in zip(planned.beads, unlimited.beads, strict=True):
        new, old = bead_path.bead, unlimited_path.bead
        assert (new.points == old.points).all() and (new.speed <= old.speed).all()
        lengths = np.linalg.norm(np.diff(new.points, axis=0), axis=1)
        share = (
            np.abs(np.diff(bead_path.joints, axis=0))
            * (new.speed[1:] / lengths)[:, None]
            / cell.machine.max_speed
        ).max(axis=1)
        slow = new.speed[1:] < 0.999999 * old.speed[1:]
        if not slow.any():
            assert (new.width == old.width).all() and (new.height == old.height).all()
            continue
        # as fast as possible: either an axis is at its limit, or the speed changes by 20 mm/s^2
        spacings = 0.5 * (lengths[1:] + lengths[:-1])
        change = np.diff(new.speed[1:] ** 2) / (2.0 * spacings)
        is_near_slow = slow[1:] | slow[:-1]
        assert np.abs(change[is_near_slow]).max() < 20.0 + 1e-6
        ramp = np.abs(np.abs(np.r_[0.0, change, 0.0]) - 20.0) < 1e-6
        assert (share[slow] > 0.999)[~(ramp[1:] | ramp[:-1])[slow]].all()
        # width and height follow table 1 of Dai 2020 for the slower speed, for any radius
        root = np.cbrt(1.0 / (60.0 * new.speed[1:])) - np.cbrt(1.0 / (60.0 * old.speed[1:]))
        expected_gain = 0.5 * (root[1:] + root[:-1])
        np.testing.assert_allclose(
            (new.width - old.width)[1:-1], 85.55 * expected_gain, rtol=1e-3, atol=1e-9
        )
        model = wire.load("csw")
        height = model.heights(new.speed[1:], np.inf) - model.heights(old.speed[1:], np.inf)
        np.testing.assert_allclose(
            (new.height - old.height)[1:-1], 0.5 * (height[1:] + height[:-1]), atol=1e-9
        )
        largest = {
            "more width": max(largest["more width"], (new.width - old.width).max()),
            "more height": max(largest["more height"], (new.height - old.height).max()),
        }
        slowed, total = slowed + lengths[slow].sum(), total + lengths.sum()
    assert 0.0 < slowed < 0.15 * total
    for word, value in largest.items():
        assert f"{value:.2g} mm {word}" in warning.message and value > 0.1
    rows = motion.deposit & np.isfinite(motion.width)
    np.testing.assert_allclose(
        motion.width[rows], np.concatenate([bead_path.bead.width for bead_path in planned.beads])
    )


def along_the_pole(speed, width=None, turn=math.pi, over=20.0):
    """A straight bead next to the table's C axis whose torch, 30 deg from it, rotates half around
    it within `over` mm of the middle."""
    n = 161
    points = np.column_stack([np.linspace(-20.0, 20.0, n), np.full(n, 30.0), np.full(n, 10.0)])
    about = turn * np.clip(0.5 + 0.5 * points[:, 0] / over, 0.0, 1.0)
    sine = math.sin(math.radians(30.0))
    tool = np.column_stack(
        [sine * np.cos(about), sine * np.sin(about), np.full(n, math.cos(math.radians(30.0)))]
    )
    widths, heights = (
        (None, None) if width is None else (np.full(n, width), np.full(n, 3.0))
    )  # as predicted by a bead model
    along = np.linspace(0.0, 2.0 * math.pi, n)
    bead = Bead(points, tool, tool, along, np.full(n, speed), False, widths, height=heights)
    return Toolpath((Layer((bead,)),), np.eye(4), 3.0, CHORD_ERROR, family="developable")


@pytest.mark.parametrize(
    ("width", "advice"),
    [(None, "lower the travel speed to 40.00 mm/s"), (9.5, "process.bead_width")],
)
def test_what_would_pile_up_is_refused(width, advice):
    """C rotates at 180 deg/s at most, so half a turn over 40 mm takes a second."""
    cell = cells.resolve(TABLE, np.eye(4), "developable")
    planned = plan_joints(along_the_pole(80.0, width), cell, JointParameters())
    (error,) = [issue for issue in planned.issues if issue.code == "SPEED"]
    assert (
        error.level == "error"
        and "axis c would move at 360 deg/s" in error.message
        and advice in error.message
    )
    assert not [issue for issue in planned.issues if issue.code == "SLOWED"]
    slower = plan_joints(
        along_the_pole(45.0, width), cell, JointParameters()
    )  # 5 mm too much: less than a bead's width
    assert slower.feasible and [issue.code for issue in slower.issues] == ["SLOWED"]
    assert slower.beads[0].bead.speed[1:] == pytest.approx(40.0)


def test_what_piles_up_on_ramps_counts():
    """20 deg in 2 mm, for which C allows 18 mm/s instead of 30: 1.3 mm too much, 8.4 mm with ramps
    of 20 mm/s^2."""
    cell = cells.resolve(TABLE, np.eye(4), "developable")
    path = along_the_pole(30.0, 8.0, math.radians(20.0), 1.0)
    for acceleration, serves in ((1e6, True), (20.0, False)):
        planned = plan_joints(
            dataclasses.replace(path, law=SpeedLaw(0.0, 0.0, 5.0, acceleration)),
            cell,
            JointParameters(),
        )
        assert planned.feasible == serves
        assert [issue.code for issue in planned.issues] == ["SLOWED" if serves else "SPEED"]
    wider = dataclasses.replace(
        path, layers=along_the_pole(30.0, 14.0, math.radians(20.0), 1.0).layers
    )
    planned = plan_joints(
        dataclasses.replace(wider, law=SpeedLaw(0.0, 0.0, 5.0, 20.0)), cell, JointParameters()
    )
    bead = planned.beads[0].bead
    assert planned.feasible and bead.speed.min() == pytest.approx(18.0, rel=0.02)
    lengths = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    pile = float((lengths * (30.0 / bead.speed[1:] - 1.0)).sum())
    assert 8.0 < pile < 14.0 and f"up to {pile:.2g} mm of bead" in planned.issues[0].message
