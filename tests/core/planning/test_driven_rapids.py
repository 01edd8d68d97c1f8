# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rapids as executed: linear in the joints from row to row, by PyKDL, against the deposit by brute
force."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.collision.bead_ends import Beads
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import ERROR, has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.motion import APPROACH, DEPOSIT, RETRACT, TRAVEL
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.rapids import clearance
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.kdl import KdlArm
from tests.core.planning.test_random_cells import conditions

UP = np.array([0.0, 0.0, 1.0])


def straight(start, end, count=15):
    points = np.linspace(start, end, count)
    up = np.tile(UP, (count, 1))
    return Bead(points, up, up, np.linspace(0.0, 1.0, count), np.full(count, 8.0), False)


def wall_between():
    """A wall 24 mm high, and after it one bead on either side, at its foot."""
    beads = [straight([0.0, -40.0, z], [0.0, 40.0, z]) for z in np.arange(1.0, 25.0, 1.0)]
    beads += [
        straight([-25.0, 30.0, 1.0], [-25.0, 0.0, 1.0]),
        straight([25.0, 0.0, 1.0], [25.0, 30.0, 1.0]),
    ]
    return Toolpath(
        tuple(Layer((bead,)) for bead in beads), np.eye(4), 1.0, 0.02, family="developable"
    )


@pytest.fixture(scope="module")
def on_table():
    parameters = CellParameters(
        machine="table-xyzac",
        setup="rotary-table",
        platform=(0.0, 0.0, 30.0, 0.0, 0.0, 0.0),
        mount="part",
    )
    cell = cells.resolve(parameters, np.eye(4), "developable")
    path = plan_joints(wall_between(), cell, JointParameters())
    assert path.feasible, path.issues
    return cell, path


def lifting(lift):
    return ProcessParameters(between_layers=BetweenLayersParameters(lift=lift))


def places(motion, cell, row, count):
    """Tips and axes on the move to a row, by another library's kinematics."""
    share = np.linspace(0.0, 1.0, count)[:, None]
    joints = motion.joints[row - 1] + share * (motion.joints[row] - motion.joints[row - 1])
    flange = KdlArm(cell.machine).forward(joints)
    tip_in_part = cell.poses.mount @ np.linalg.inv(flange @ cell.poses.carried) @ cell.poses.station
    return tip_in_part[:, :3, 3], tip_in_part[:, :3, 2]


def deepest(motion, cell, row, count=60):
    """Maximum depth (mm) of a deposit point inside the nozzle on the move to a row; points within
    one diameter of the tip or above the nozzle do not count."""
    nozzle = cell.nozzle
    deposited = motion.position[:row][motion.deposit[:row]]
    deep = -np.inf
    for tip, axis in zip(*places(motion, cell, row, count)):
        height = (deposited - tip) @ axis
        across = np.linalg.norm(deposited - tip - height[:, None] * axis, axis=1)
        is_near_tip = np.linalg.norm(deposited - tip, axis=1) <= nozzle.diameter
        inside = 0.5 * nozzle.diameter + height * np.tan(nozzle.half_angle) - across
        deep = max(
            deep,
            inside[(height > 0.0) & (height < nozzle.length) & ~is_near_tip].max(initial=-np.inf),
        )
    return deep


@pytest.mark.parametrize("lift", [0.0, 5.0, 20.0])
def test_no_retract_distance_lets_the_nozzle_through_a_wall(on_table, lift):
    """The nozzle passes over a wall with every retract distance."""
    cell, path = on_table
    motion, issues = assemble(path, cell, lifting(lift))
    # without a retract the tip moves sideways off the wall's last bead and touches it
    assert [(issue.code, issue.layer) for issue in issues] == [
        ("RAPID_LIFTED", len(path.beads) - (2 if lift == 0.0 else 1))
    ]
    assert not has_errors(issues)
    worst = max(deepest(motion, cell, row) for row in np.flatnonzero(~motion.deposit[1:]) + 1)
    assert worst < 0.1
    # and between beads of the wall the rapids are unchanged
    is_wall_rapid = (motion.layer == 3) & ~motion.deposit
    assert motion.role[is_wall_rapid].tolist() == (
        [TRAVEL] if lift == 0.0 else [RETRACT, TRAVEL, APPROACH]
    )
    assert ((motion.role == DEPOSIT) == motion.deposit).all()


def test_beads_have_their_width_where_the_nozzle_goes_over(on_table):
    """A retract that clears the wall's centre line by 1 mm: the cone would enter the flank of 8 mm
    beads."""
    cell, path = on_table
    lift = 24.0
    lines, issues = assemble(path, cell, lifting(lift))
    assert not issues
    moved, issues = assemble(
        path,
        cell,
        ProcessParameters(between_layers=BetweenLayersParameters(lift=lift), bead_width=8.0),
        layer_height=4.0,
    )
    assert [issue.code for issue in issues] == ["RAPID_LIFTED"]
    over = [
        np.flatnonzero((m.role == TRAVEL) & (m.layer == len(path.beads) - 1))
        for m in (lines, moved)
    ]
    assert lines.position[over[0], 2].max() < 28.0 <= moved.position[over[1], 2].min()


@pytest.mark.parametrize("lift", [20.0, 200.0])
def test_a_retract_keeps_to_its_line_however_long(sliced, cell_of, lift):
    """A retract follows its line at any length."""
    toolpath = sliced("sphere", 15.0, chord_error=0.3)
    cell = cell_of(toolpath)
    path = plan_joints(toolpath, cell, JointParameters())
    motion, issues = assemble(path, cell, lifting(lift))
    assert not has_errors(issues)
    rows = np.flatnonzero((motion.role == RETRACT) | (motion.role == APPROACH))
    deposit_rows = np.flatnonzero(motion.deposit)
    assert len(rows) >= 2 * len(path.beads)
    counted = 0
    for row in rows:
        if row == 0:
            continue
        bead_row = (
            deposit_rows[deposit_rows < row][-1]
            if motion.role[row] == RETRACT
            else deposit_rows[deposit_rows > row][0]
        )
        tip = places(motion, cell, row, 50)[0] - motion.position[bead_row]
        deviation = np.linalg.norm(
            tip - (tip @ motion.tool[bead_row])[:, None] * motion.tool[bead_row], axis=1
        )
        assert deviation.max() < 0.55, (row, deviation.max())
        counted += 1
    assert counted >= len(rows) - 1
    if lift == 20.0:  # short retracts are one move
        assert len(rows) == 2 * len(path.beads)


def limit_axis(cell, axis, low, high):
    """The cell with different limits of an axis."""
    lower, upper = cell.limits.lower.copy(), cell.limits.upper.copy()
    lower[axis], upper[axis] = low, high
    return dataclasses.replace(
        cell, limits=dataclasses.replace(cell.limits, lower=lower, upper=upper)
    )


def test_a_limit_that_leaves_room_for_less_is_kept_and_told_and_one_that_leaves_none_refuses(
    on_table,
):
    cell, path = on_table
    motion, _ = assemble(path, cell, lifting(20.0))
    deposit, joints = motion.joints[motion.deposit], motion.joints
    # the axis whose range the retracts widen most
    wider = np.stack(
        [deposit.min(axis=0) - joints.min(axis=0), joints.max(axis=0) - deposit.max(axis=0)]
    )
    end, axis = np.unravel_index(wider.argmax(), wider.shape)
    low, high = cell.limits.lower[axis], cell.limits.upper[axis]

    def leaving(room):
        ends = (
            (deposit[:, axis].min() - room, high)
            if end == 0
            else (low, deposit[:, axis].max() + room)
        )
        return limit_axis(cell, axis, *ends)

    short = leaving(8.0)
    motion, issues = assemble(path, short, lifting(20.0))
    assert "RAPID_OTHER" in [issue.code for issue in issues]
    assert (motion.joints[:, axis] >= short.limits.lower[axis]).all() and (
        motion.joints[:, axis] <= short.limits.upper[axis]
    ).all()
    none = leaving(0.1)
    _, issues = assemble(path, none, lifting(20.0))
    wrong = [issue for issue in issues if issue.level == ERROR and issue.code == "RAPID_LIMIT"]
    assert wrong and all(issue.layer is not None and issue.bead == 0 for issue in wrong)
    bound = none.limits.lower[axis] if end == 0 else none.limits.upper[axis]
    assert all(f"{none.limits.labels[axis]} would be at" in issue.message for issue in wrong)
    assert all(
        f"{bound:g} mm" in issue.message and "process.between_layers.lift" in issue.message
        for issue in wrong
    )


def test_the_way_off_the_last_bead_is_looked_at_too(on_table):
    """A block above the back end of the nozzle, next to its axis, that only the final retract
    approaches."""
    cell, path = on_table
    nozzle, end = cell.nozzle, path.beads[-1].bead.points[-1]
    wide = 0.5 * nozzle.diameter
    middle = end + [0.0, 15.0, nozzle.length + 8.0]
    corners = middle + np.array(
        [[a, b, c] for a in (-2.0, 2.0) for b in (-2.0, 2.0) for c in (-2.0, 2.0)]
    )
    sides = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 7, 5),
        (4, 6, 7),
        (0, 5, 1),
        (0, 4, 5),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
        (1, 5, 7),
        (1, 7, 3),
    ]
    free, issues = assemble(path, cell, lifting(20.0))
    motion, issues_with_block = assemble(
        path, cell, lifting(20.0), [Body("block", corners, np.array(sides))]
    )
    new_codes = {issue.code for issue in issues_with_block} - {issue.code for issue in issues}
    assert new_codes and new_codes <= {"RAPID_COLLISION", "RAPID_ASIDE", "RAPID_OTHER"}, (
        issues_with_block
    )
    end_row = int(np.flatnonzero(motion.deposit)[-1]) + 1
    same = int(np.flatnonzero(free.deposit)[-1]) + 1
    assert end_row == same and np.array_equal(
        motion.joints[:end_row], free.joints[:same]
    )  # all earlier rows are unchanged

    def deep(checked):
        return max(
            float(
                np.minimum(
                    wide + height * np.tan(nozzle.half_angle) - across, nozzle.length - height
                ).max()
            )
            for row in range(end_row, len(checked))
            for tip, axis in zip(*places(checked, cell, row, 60))
            for height in [(corners - tip) @ axis]
            for across in [np.linalg.norm(corners - tip - height[:, None] * axis, axis=1)]
        )

    assert deep(free) > 3.0 and ("RAPID_COLLISION" in new_codes or deep(motion) < 0.2)


def off_beads(motion):
    """Rows of retracts, travels and approaches that are not on a bead."""
    onto = np.r_[motion.deposit[1:], False]
    return np.flatnonzero(~motion.deposit & ~((motion.role == APPROACH) & onto))


@pytest.fixture(scope="module")
def far_away(sliced, cell_of):
    """A joint path whose retracts of 200 mm have intermediate rows, and its motion for a cell and a
    minimum condition."""
    toolpath = sliced("intake funnel", 15.0, chord_error=0.3)
    cell = cell_of(toolpath)
    path = plan_joints(toolpath, cell, JointParameters())

    def assemble_with(other_cell=None, min_condition=0.0):
        parameters = dataclasses.replace(JointParameters(), min_condition=min_condition)
        return assemble(path, other_cell or cell, lifting(200.0), (), parameters)

    return cell, assemble_with


def retracts(motion):
    """The rows (k,) of each retract, preceded by the row of the bead that it leaves."""
    for start in np.flatnonzero((motion.role == RETRACT) & np.r_[False, motion.deposit[:-1]]):
        yield np.arange(
            start - 1, start + int(np.argmax(np.r_[motion.role[start:] != RETRACT, True]))
        )


def test_rows_between_the_ends_of_a_retract_keep_within_limits_too(far_away):
    """One axis reverses during a retract: only intermediate rows exceed a limit just short of the
    reversal."""
    cell, assemble_with = far_away
    (motion, _), overshoots = assemble_with(), []
    for rows in retracts(motion):
        values = motion.joints[rows]
        ends = values[[0, -1]].max(axis=0)
        over = values.max(axis=0) - ends
        overshoots.append((over.max(), int(over.argmax()), ends[over.argmax()]))
    over, axis, end = max(overshoots)
    assert over > np.radians(0.05)
    bound, upper = end + 0.4 * over, cell.limits.upper.copy()
    upper[axis] = bound
    limited_motion, issues = assemble_with(
        dataclasses.replace(cell, limits=dataclasses.replace(cell.limits, upper=upper))
    )
    assert "RAPID_OTHER" in [issue.code for issue in issues]
    limited_values = [
        limited_motion.joints[rows, axis]
        for rows in retracts(limited_motion)
        if limited_motion.joints[rows[0], axis] <= bound
    ]
    assert len(limited_values) >= 2 and max(values.max() for values in limited_values) <= bound


def test_rapids_keep_the_least_condition_or_it_says_so(far_away):
    """Rapids keep the minimum condition, or an issue says so."""
    cell, assemble_with = far_away
    arm = KdlArm(cell.machine)
    motion, issues = assemble_with()
    assert not issues
    rapid_conditions = conditions(arm, cell, motion.joints[off_beads(motion)])
    min_condition = float(rapid_conditions.min() + 0.1 * np.ptp(rapid_conditions))
    motion, issues = assemble_with(min_condition=min_condition)
    assert [issue.code for issue in issues] == ["RAPID_OTHER"]
    assert conditions(arm, cell, motion.joints[off_beads(motion)]).min() >= min_condition - 1e-6
    _, issues = assemble_with(min_condition=0.9)
    wrong = [issue for issue in issues if issue.level == ERROR]
    assert {issue.code for issue in wrong} == {"RAPID_SINGULAR"} and all(
        issue.layer is not None for issue in wrong
    )


def test_an_endless_axis_never_has_half_a_turn_to_go_in_one_move(sliced, cell_of):
    """Its controller takes the shorter direction, so a bead that starts a turn and a half farther
    needs several moves."""
    toolpath = sliced("sphere", 15.0, chord_error=0.3)
    cell = cell_of(toolpath)
    path = plan_joints(toolpath, cell, JointParameters())
    (axis,) = np.flatnonzero(cell.limits.continuous)
    offset = np.eye(6)[axis] * 3.0 * np.pi
    beads = tuple(
        dataclasses.replace(bead, joints=bead.joints + number * offset, phi=bead.phi)
        for number, bead in enumerate(path.beads)
    )
    motion, _ = assemble(dataclasses.replace(path, beads=beads), cell, lifting(20.0))
    turned = np.abs(np.diff(motion.joints[:, axis]))
    assert turned[~motion.deposit[1:]].max() <= np.radians(170.0) + 1e-9
    for layer in range(1, len(beads)):
        is_travel = (motion.layer == layer) & ~motion.deposit & (motion.role == TRAVEL)
        assert is_travel.sum() >= 2


def test_a_retract_beyond_all_reach_is_refused_with_its_place(sliced, cell_of):
    toolpath = sliced("sphere", 15.0, chord_error=0.3)
    cell = cell_of(toolpath)
    motion, issues = assemble(
        plan_joints(toolpath, cell, JointParameters()), cell, lifting(100_000.0)
    )
    wrong = [issue for issue in issues if issue.level == ERROR]
    assert {issue.code for issue in wrong} == {"RAPID_UNREACHABLE"} and not motion.reachable.all()
    assert [issue.layer for issue in wrong] == list(range(len(toolpath.layers)))
    assert all("cannot be reached at any height" in issue.message for issue in wrong)


def test_few_looks_find_what_all_of_them_do(on_table, monkeypatch):
    """Random moves, many through the wall and some that graze it: adaptive sampling finds the
    contacts of dense sampling with a fraction of the checks."""
    cell, path = on_table
    check_counts = []
    test_contact = clearance.RapidObstacles._test_contact
    monkeypatch.setattr(
        clearance.RapidObstacles,
        "_test_contact",
        lambda self, nozzle, looks, moves: (
            check_counts.append(len(looks.move)),
            test_contact(self, nozzle, looks, moves),
        )[1],
    )
    beads = [path_or_hit.bead for path_or_hit in path.beads]
    obstacles = clearance.RapidObstacles(cell, Beads.of(beads, 8.0, 1.0), ())
    random = np.random.default_rng(3)
    ends = np.concatenate([path_or_hit.joints for path_or_hit in path.beads])[
        random.integers(300, size=(2, 80))
    ]
    ends[:, :, 2] += random.uniform(-2.0, 20.0, size=(2, 80))
    moves = clearance.Moves(*ends, np.full(80, 300))
    met = obstacles.find_collisions(moves)
    check_count = sum(check_counts)
    all_looks = clearance._evaluate_looks(cell, moves, clearance.FINE)
    hit = test_contact(obstacles, obstacles._nozzle(moves, all_looks), all_looks, moves)
    assert (met == (np.bincount(all_looks.move, hit, minlength=80) > 0)).all()
    assert 20 < met.sum() < 70 and check_count < 0.25 * len(all_looks.move)
    nozzle = obstacles._nozzle(moves, all_looks)
    hit = [
        obstacles._deposit_touched(nozzle, all_looks, moves).any(),
        obstacles._nearby_bodies(all_looks.tip)
        .find_touching(nozzle.bodies, all_looks.tip, all_looks.axis)
        .any(),
    ]
    assert obstacles.names(moves) == [
        name
        for name, path_or_hit in zip(["the deposit", "the platform"], hit, strict=True)
        if path_or_hit
    ]
    assert obstacles.names(moves.of(np.flatnonzero(~met))) == []
