# SPDX-License-Identifier: LGPL-2.1-or-later
"""Five-axis machines: beads held at the torch between their points too, poles passed, limits kept,
speeds as requested."""

import dataclasses
import math

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, Layer, MotionRules, Toolpath
from freecad_am.kdl import KdlArm, available

MACHINES = ["table-xyzac", "table-xyzbc", "head-table-xyzbc"]


def bead(points, build, closed=False, speed=8.0):
    build = build / np.linalg.norm(build, axis=1)[:, None]
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(
        points,
        build,
        build,
        2.0 * math.pi * length / length[-1],
        np.full(len(points), speed),
        closed,
    )


def toolpath(*beads, chord_error=0.02):
    return Toolpath(
        tuple(Layer((layer_bead,)) for layer_bead in beads),
        np.eye(4),
        2.0,
        chord_error,
        family="developable",
    )


def resolved(machine="table-xyzac", platform=(0.0, 0.0, 30.0, 0.0, 0.0, 0.0), **options):
    parameters = CellParameters(
        machine=machine, setup="rotary-table", platform=platform, mount="part", **options
    )
    return cells.resolve(parameters, np.eye(4), "developable")


def ring_around(base, distance, z, n=181, start=0.0):
    """A closed bead around a hub whose axis is the table's."""
    theta = start + np.linspace(0.0, 2.0 * math.pi, n)
    surface = base.offset(distance)
    rho = surface.radius * (1.0 - z / surface.height)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), np.full(n, z)], axis=1)
    points[-1] = points[0]
    return bead(points, base.normals(points), True)


def check(cell, path, chord_error=0.02):
    """Every position between two points, driven by PyKDL, is on the bead and has its tool
    direction."""
    forward = (KdlArm(cell.machine) if available() else cell.machine.chain).forward
    for bead_path in path.beads:
        share = np.linspace(0.0, 1.0, 12)[:, None]
        axes = (
            bead_path.joints[:-1, None] + share * np.diff(bead_path.joints, axis=0)[:, None]
        ).reshape(-1, 5)
        tip, tool = cell.tip_in_part(forward(axes))
        start, segments = bead_path.bead.points[:-1], np.diff(bead_path.bead.points, axis=0)
        tip = tip.reshape(len(segments), 12, 3)
        t = np.clip(
            ((tip - start[:, None]) * segments[:, None]).sum(-1) / (segments**2).sum(-1)[:, None],
            0.0,
            1.0,
        )
        assert (
            np.linalg.norm(tip - start[:, None] - t[..., None] * segments[:, None], axis=-1).max()
            < 1.05 * chord_error
        )
        at_points = cell.tip_in_part(forward(bead_path.joints))
        np.testing.assert_allclose(at_points[0], bead_path.bead.points, atol=1e-8)
        np.testing.assert_allclose(at_points[1], bead_path.bead.tool, atol=1e-10)
        between = tool.reshape(len(segments), 12, 3)
        straight = (
            bead_path.bead.tool[:-1, None] + share * np.diff(bead_path.bead.tool, axis=0)[:, None]
        )
        straight /= np.linalg.norm(straight, axis=-1)[..., None]
        assert np.degrees(np.arccos(np.clip((between * straight).sum(-1), -1, 1))).max() < 0.55
        assert (bead_path.joints >= cell.limits.lower).all() and (
            bead_path.joints <= cell.limits.upper
        ).all()


def test_free_is_what_a_machine_has_beyond_five_axes():
    robot = CellParameters(setup="tool-on-robot", mount="part")
    beside = "motoman-motopos-d500 at 1000 60 -600 0 0 20 carries part"
    for cell, free in [
        *((resolved(machine), 0) for machine in MACHINES),
        (cells.resolve(robot, np.eye(4)), 1),
        (cells.resolve(dataclasses.replace(robot, external=beside), np.eye(4)), 3),
    ]:
        assert cell.machine.free == free == cell.machine.chain.axes - 5


@pytest.mark.parametrize("machine", MACHINES)
def test_random_beads_anywhere(machine):
    rng = np.random.default_rng(3)
    beads = []
    for _ in range(6):
        t = np.linspace(0.0, 1.0, 60)[:, None]
        a, b, c = rng.uniform(-60, 60, (3, 3))
        lean = rng.normal(size=(2, 3)) + [0.0, 0.0, 1.5]
        beads.append(bead(a + t * b + t * t * c, lean[0] + t * lean[1]))
    cell = resolved(machine)
    path = plan_joints(toolpath(*beads), cell, JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    check(cell, path)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("off", [0.0, 1e-7, 0.3])
def test_over_the_vertical(machine, off):
    # a bead over the top of a ball: exactly through the pole, very close to it, and near it
    angle = np.linspace(-0.8, 0.8, 81)
    points = 50.0 * np.stack(
        [np.sin(angle) * np.cos(0.4), np.sin(angle) * np.sin(0.4), np.cos(angle)], axis=1
    )
    points += [0.0, off, 0.0]
    cell = resolved(machine)
    path = plan_joints(toolpath(bead(points, points)), cell, JointParameters())
    if (
        off == 0.3
    ):  # so close to the pole the axis must rotate by half a turn in a moment: reported with a feasible speed
        assert [issue.code for issue in path.issues] == ["SPEED"]
        check(cell, path)
        return
    assert path.feasible, [issue.message for issue in path.issues]
    check(cell, path)
    assert np.abs(np.diff(path.beads[0].joints, axis=0)[:, cell.machine.chain.sliding]).max() < 12.0
    if off < 0.1:  # the tilt continues to the other side, and the table does not rotate
        turning = path.beads[0].joints[:, ~cell.machine.chain.sliding]
        assert np.ptp(turning, axis=0).min() < 1e-5 and np.ptp(
            turning, axis=0
        ).max() == pytest.approx(1.6, abs=1e-5)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("way", ["nearly upright", "over level ground"])
def test_beside_the_vertical_the_table_has_the_way_there_to_turn(machine, way):
    """Curved layers are upright except for some tenths of a degree either way, or lean, are upright
    for a while and lean in a different direction: the table would have rotated within hundredths of
    a millimetre, or nowhere."""
    x = np.linspace(0.0, 60.0, 61)
    lean, aside = np.zeros((2, len(x)))
    if way == "nearly upright":
        lean, aside = np.radians(np.random.default_rng(5).uniform(-0.13, 0.13, (2, len(x))))
    else:
        lean = np.tan(np.radians(np.interp(x, [20.0, 25.0], [15.0, 0.0])))
        aside = np.tan(np.radians(np.interp(x, [35.0, 40.0], [0.0, 15.0])))
    cell = resolved(machine)
    requested = bead(
        np.stack([x, 5.0 + 0.0 * x, 20.0 + 0.0 * x], axis=1),
        np.stack([lean, aside, np.ones(len(x))], axis=1),
    )
    path = plan_joints(toolpath(requested), cell, JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    assert [issue.code for issue in path.issues] == []
    check(cell, path)
    run = path.beads[0]
    directions = np.stack(
        [np.interp(run.bead.points[:, 0], x, column) for column in requested.tool.T], axis=1
    )
    sine = np.linalg.norm(np.cross(directions, run.bead.tool), axis=1) / np.linalg.norm(
        directions, axis=1
    )
    assert np.degrees(np.arcsin(sine)).max() < 0.41
    turning = ~cell.machine.chain.sliding
    rate = (
        np.abs(np.diff(run.joints, axis=0))[:, turning]
        / np.diff(run.bead.points[:, 0])[:, None]
        * 8.0
    )
    assert (rate <= cell.machine.max_speed[turning]).all()


def test_a_tilting_axis_without_room_beyond_the_pole_stays_on_its_side():
    """Straight through the vertical the axis would reach -15 deg; the table rotates next to the
    pole instead, and the bead is slowed."""
    x = np.linspace(0.0, 60.0, 61)
    lean, aside = (
        np.tan(np.radians(15.0 * (1.0 - x / 30.0))),
        np.full(len(x), np.tan(np.radians(0.15))),
    )
    requested = bead(
        np.stack([x, 5.0 + 0.0 * x, 20.0 + 0.0 * x], axis=1),
        np.stack([lean, aside, np.ones(len(x))], axis=1),
        speed=2.5,
    )
    cell = limit_axis(resolved("table-xyzac"), 3, -5.0, 100.0)
    path = plan_joints(toolpath(requested), cell, JointParameters())
    assert path.feasible and len(path.beads) == 1
    assert [issue.code for issue in path.issues] == ["SLOWED"]
    check(cell, path)
    free = plan_joints(toolpath(requested), resolved("table-xyzac"), JointParameters())
    assert (
        free.feasible and not free.issues and np.degrees(free.beads[0].joints[:, 3].min()) < -10.0
    )


def test_round_a_hub_on_the_turning_axis_only_the_table_turns():
    """Around a hub on the rotary axis only the table rotates."""
    base = Developable(60.0, 200.0)
    cell = resolved()
    beads = [ring_around(base, 3.0 * k, 40.0, start=0.3 * k) for k in range(4)]
    path = plan_joints(toolpath(*beads, chord_error=0.02), cell, JointParameters())
    assert path.feasible
    for bead_path in path.beads:
        np.testing.assert_allclose(np.ptp(bead_path.joints, axis=0)[:4], 0.0, atol=1e-8)
        assert np.ptp(bead_path.joints[:, 4]) == pytest.approx(2.0 * math.pi, abs=1e-9)
    assert np.degrees(abs(path.beads[0].joints[0, 3])) == pytest.approx(73.3, abs=0.01)
    motion, issues = assemble(path, cell, ProcessParameters(travel_speed=8.0))
    assert not [issue for issue in issues if issue.level == "error"]
    # the linear axes are at rest, but the torch has its speed along the bead
    rows = motion.deposit & (motion.point > 0)
    length = np.linalg.norm(np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1)
    np.testing.assert_allclose(length[rows] / motion.duration[rows], 8.0, rtol=1e-12)
    # and between beads it retracts without a rotation, so it touches nothing
    joined = np.diff(motion.joints[:, 4])
    assert np.abs(joined).max() < math.pi


def test_a_limited_axis_unwinds_between_beads():
    base = Developable(60.0)
    cell = resolved("head-table-xyzbc")
    limits = cell.limits
    limited = type(limits)(
        limits.name,
        np.where(np.isfinite(limits.lower), limits.lower, -2.1 * math.pi),
        np.where(np.isfinite(limits.upper), limits.upper, 2.1 * math.pi),
        limits.coefficients,
        limits.coupled_lower,
        limits.coupled_upper,
        limits.labels,
        limits.source,
    )
    cell = dataclasses.replace(cell, limits=limited)
    path = plan_joints(
        toolpath(*(ring_around(base, 3.0, 5.0 * k) for k in range(5))), cell, JointParameters()
    )
    assert path.feasible, [issue.message for issue in path.issues]
    check(cell, path)
    back = [
        abs(b.joints[0, 4] - a.joints[-1, 4]) > 1.5 * math.pi
        for a, b in zip(path.beads, path.beads[1:])
    ]
    assert any(back) and [issue.message for issue in path.issues] == [
        f"axis c rewinds {sum(back)} times between beads, first before layer {1 + back.index(True)}"
    ]


def limit_axis(cell, axis, lower_deg, upper_deg):
    lower, upper = cell.limits.lower.copy(), cell.limits.upper.copy()
    lower[axis], upper[axis] = math.radians(lower_deg), math.radians(upper_deg)
    return dataclasses.replace(
        cell, limits=dataclasses.replace(cell.limits, lower=lower, upper=upper)
    )


@pytest.mark.parametrize("overlap", [0.0, 8.0])
def test_seams_are_moved_where_a_limited_axis_has_room(overlap):
    # 400 deg of range: a whole turn fits from starts within 40 deg only, and the seams are all
    # around
    cell = limit_axis(resolved(), 4, -200.0, 200.0)
    beads = [ring_around(Developable(60.0, 200.0), 2.0 * k, 40.0, start=1.1 * k) for k in range(6)]
    planned = dataclasses.replace(toolpath(*beads), rules=MotionRules(overlap=overlap))
    path = plan_joints(planned, cell, JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    assert "SEAM_MOVED" in {issue.code for issue in path.issues} and len(path.beads) == len(beads)
    for bead_path, requested in zip(path.beads, beads):
        assert np.degrees(np.ptp(bead_path.joints[:, 4])) == pytest.approx(
            360.0 + math.degrees(overlap / 57.0), abs=3.0 + overlap
        )
        # the same ring with another start
        assert bead_path.bead.length == pytest.approx(requested.length + overlap, abs=0.03)
        np.testing.assert_allclose(bead_path.bead.points[:, 2], 40.0, atol=1e-9)
        assert (
            np.degrees(bead_path.joints[:, 4].min()) >= -200.0
            and np.degrees(bead_path.joints[:, 4].max()) <= 200.0
        )
    check(cell, path)


def test_beads_are_split_where_no_seam_helps():
    """Beads are split where no seam helps."""
    cell = limit_axis(resolved(), 4, -150.0, 150.0)
    beads = [ring_around(Developable(60.0, 200.0), 2.0 * k, 40.0, start=0.4 * k) for k in range(3)]
    path = plan_joints(toolpath(*beads), cell, JointParameters())
    assert path.feasible, [issue.message for issue in path.issues]
    assert "BEAD_SPLIT" in {issue.code for issue in path.issues}
    assert [(bead_path.layer, bead_path.index) for bead_path in path.beads] == [
        (k, half_index) for k in range(3) for half_index in range(2)
    ]
    for k, requested in enumerate(beads):
        first_half, second_half = path.beads[2 * k : 2 * k + 2]
        np.testing.assert_allclose(
            first_half.bead.points[-1], second_half.bead.points[0], atol=1e-12
        )
        assert first_half.bead.length + second_half.bead.length == pytest.approx(
            requested.length, abs=0.02
        )
    check(cell, path)
    motion, issues = assemble(path, cell, ProcessParameters())
    assert not issues and motion.reachable.all()


def test_robots_lock_no_axis():
    cell = cells.resolve(CellParameters(), np.eye(4))
    with pytest.raises(InputError) as caught:
        plan_joints(
            toolpath(ring_around(Developable(60.0), 0.0, 40.0)),
            cell,
            JointParameters(lock="second"),
        )
    assert caught.value.code == "NOT_FOR_SETUP" and caught.value.where == "joints.lock"


def test_a_limit_that_cannot_be_kept_is_told_with_axis_and_place():
    base = Developable(60.0, 200.0)
    cell = resolved(
        platform=(450.0, 0.0, 30.0, 0.0, 0.0, 0.0)
    )  # far off the table's axis: it leaves the range
    path = plan_joints(toolpath(ring_around(base, 0.0, 40.0)), cell, JointParameters())
    assert not path.feasible
    limit = next(issue for issue in path.issues if issue.code == "LIMIT")
    assert (
        "mm, beyond its limit of" in limit.message
        and limit.message[:2] in ("mx", "my", "mz")
        and limit.point is not None
    )


@pytest.mark.parametrize("lock_at", ["auto", math.radians(60.0)])
def test_four_axes(lock_at):
    base = Developable(60.0, 200.0)
    cell = resolved()
    beads = [ring_around(base, 3.0 * k, 40.0) for k in range(2)]
    path = plan_joints(toolpath(*beads), cell, JointParameters(lock="first", lock_at=lock_at))
    assert path.feasible
    note = next(issue for issue in path.issues if issue.code == "FOUR_AXES")
    tilt = path.beads[0].joints[:, 3]
    assert np.ptp(tilt) == 0.0
    if lock_at == "auto":
        assert (
            abs(math.degrees(tilt[0])) == pytest.approx(73.3, abs=0.02)
            and "axis a is locked" in note.message
        )
        missed = np.arccos(
            np.clip((path.beads[0].bead.tool * path.beads[0].bead.build).sum(axis=1), -1, 1)
        )
        assert np.degrees(missed).max() < 0.02
    else:
        assert "13.3 deg off" in note.message
    # the message and the verification state the real tool direction
    tip, tool = cell.tip_in_part(cell.machine.chain.forward(path.beads[1].joints))
    np.testing.assert_allclose(tool, path.beads[1].bead.tool, atol=1e-12)
    np.testing.assert_allclose(tip, path.beads[1].bead.points, atol=1e-9)


def test_four_axes_that_miss_too_much_are_refused():
    cell, beads = resolved(), [ring_around(Developable(60.0, 200.0), 0.0, 40.0)]
    parameters = JointParameters(
        lock="first", lock_at=math.radians(60.0), max_residual=math.radians(13.0)
    )
    path = plan_joints(toolpath(*beads), cell, parameters)
    assert [issue.code for issue in path.issues if issue.level == "error"] == ["FOUR_AXES"]
    assert "13.3 deg off" in path.issues[-1].message and "max_residual" in path.issues[-1].message


def test_a_cone_and_a_cylinder_on_one_spindle_share_what_is_missed():
    # the best common tilt leaves each half of the angle between them
    cell = resolved()
    beads = [
        ring_around(Developable(60.0, 200.0), 2.0, 40.0),
        ring_around(Developable(60.0), 2.0, -20.0),
    ]
    path = plan_joints(toolpath(*beads), cell, JointParameters(lock="first"))
    assert path.feasible
    half = math.degrees(math.atan2(60.0, 200.0)) / 2.0
    note = next(issue for issue in path.issues if issue.code == "FOUR_AXES").message
    assert f"{half:.3g} deg off" in note
    for bead_path, build in zip(path.beads, beads):
        missed = np.arccos(np.clip((bead_path.bead.tool * bead_path.bead.build).sum(axis=1), -1, 1))
        np.testing.assert_allclose(np.degrees(missed), half, atol=0.01)
        assert len(bead_path.bead) >= len(build)


def test_the_locked_axis_stands_within_its_limits():
    cell = resolved()
    cell = limit_axis(cell, 3, -40.0, 50.0)
    path = plan_joints(
        toolpath(ring_around(Developable(60.0, 200.0), 0.0, 40.0)),
        cell,
        JointParameters(lock="first"),
    )
    assert path.feasible and math.degrees(path.beads[0].joints[0, 3]) == pytest.approx(
        49.95, abs=0.01
    )


def test_a_direction_out_of_reach_is_told():
    cell = resolved("head-xyzab", platform=(0.0, 0.0, 30.0, 0.0, 0.0, 0.0))
    points = np.stack([np.linspace(0, 20, 30), np.zeros(30), np.zeros(30)], axis=1)
    down = np.tile([0.0, 0.05, -1.0], (30, 1))
    path = plan_joints(toolpath(bead(points, down)), cell, JointParameters())
    assert not path.feasible
    assert {issue.code for issue in path.issues} <= {"LIMIT", "UNREACHABLE"}


def test_a_robot_is_no_table_and_a_table_no_robot():
    for setup, machine in (
        ("rotary-table", "fanuc-arcmate120ic"),
        ("part-on-robot", "table-xyzac"),
    ):
        with pytest.raises(Exception, match="use ") as caught:
            cells.resolve(CellParameters(machine=machine, setup=setup), np.eye(4))
        assert caught.value.code == "WRONG_SETUP"


def test_an_overlap_runs_on():
    """An overlap extends a closed bead."""
    cell = resolved()
    ring = ring_around(Developable(60.0), 0.0, 20.0)
    path = plan_joints(
        Toolpath(
            (Layer((ring,)),),
            np.eye(4),
            2.0,
            0.05,
            rules=MotionRules(overlap=7.0),
            family="developable",
        ),
        cell,
        JointParameters(),
    )
    assert path.beads[0].bead.length - ring.length == pytest.approx(7.0, abs=0.02)
    assert np.ptp(path.beads[0].joints[:, 4]) > 2.0 * math.pi
