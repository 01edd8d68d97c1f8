# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lower bound of the objective over all rotations: no executable path is below it, and it is
tight."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.parameters.joints import OBJECTIVES, JointParameters
from freecad_am.core.planning import criteria
from freecad_am.core.planning.certificate import bound as certificate
from freecad_am.core.planning.certificate import least_ahead
from freecad_am.core.planning.certificate.lattice import Lattice
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.task import Task

BEADS = (0, 3)
FINE = 240  # rotations of the second search


@pytest.fixture(scope="module")
def planned_on(sliced, cell_of, with_axis_6):
    """planned_on(part, half) -> the task and some beads of a coarsely sliced part, with or without
    limits of its last axis."""

    def plan(part, half):
        toolpath = sliced(part, 25.0, chord_error=1.0)
        cell = cell_of(toolpath) if half is None else with_axis_6(cell_of(toolpath), half)
        path = plan_joints(toolpath, cell, JointParameters())
        assert path.feasible
        task = Task(cell, spherical_wrist.branch_index(path.branch), JointParameters())
        return task, [path.beads[k] for k in BEADS if k < len(path.beads)]

    return plan


@pytest.fixture(scope="module")
def planned(planned_on):
    """With limits of the last axis, so that every axis counts."""
    return planned_on("laval nozzle", 450.0)


def summed(weights, joints):
    """Eq. 17 of joints (n, axes) by complex numbers, which ignore whole turns."""
    step = np.angle(np.exp(1j * joints[1:]) / np.exp(1j * joints[:-1]))
    return float((step**2 @ weights).sum())


def shortest(task, path):
    """The least eq. 17 over FINE rotations at every point of a bead, by a search over pairs."""
    points = gather([path.bead], task.cell)
    phi = np.arange(FINE) * 2.0 * np.pi / FINE
    joints = np.stack(
        [task.raw_joints(points.select_points(np.full(FINE, i)), phi) for i in range(len(points))]
    )
    phasors = np.exp(1j * (joints - task.middle))
    reachable = np.isfinite(joints).all(axis=2) & (
        np.abs(np.angle(phasors))
        <= np.where(
            task.continuous, np.inf, 0.5 * (task.cell.limits.upper - task.cell.limits.lower)
        )
    ).all(axis=2)
    ratio = np.stack(
        [
            task.condition_at(points.frames.of(np.full(FINE, i)).flange_poses(phi), joints[i])
            for i in range(len(points))
        ]
    )
    reachable &= ratio >= path.threshold[:, None]
    minimum = np.where(reachable[0], 0.0, np.inf)
    for previous, current, is_allowed in zip(joints, joints[1:], reachable[1:]):
        cost = sum(
            weight * np.angle(np.exp(1j * (current[None, :, axis] - previous[:, None, axis]))) ** 2
            for axis, weight in enumerate(task.weights)
        )
        minimum = np.where(
            is_allowed,
            np.nanmin(np.where(np.isnan(cost), np.inf, cost) + minimum[:, None], axis=0),
            np.inf,
        )
    return float(minimum.min())


@pytest.mark.parametrize("part", ["sphere", "laval nozzle", "intake funnel"])
def test_the_default_is_within_one_percent(planned_on, part):
    task, paths = planned_on(part, None)
    result = certificate.certified(task, paths)
    for path, objective in zip(paths, result.objective):
        assert objective == pytest.approx(summed(task.weights, path.joints), rel=1e-9)
    assert (result.bound <= result.objective).all() and (result.gaps < 0.01).all()


def test_no_course_of_the_rotation_goes_below(planned):
    """No continuous rotation along the bead is below the bound."""
    task, paths = planned
    rng = np.random.default_rng(20261123)
    result = certificate.certified(task, paths)
    for path, bound in zip(paths, result.bound):
        points = gather([path.bead], task.cell)
        share = np.linspace(0.0, 1.0, len(points))
        for size in 10.0 ** rng.uniform(-4.0, 0.5, 40):
            turns = np.outer(share, rng.integers(0, 6, 4)) + rng.uniform(0.0, 1.0, 4)
            waves = np.sin(2.0 * np.pi * turns) @ rng.normal(size=4)
            joints = task.raw_joints(points, path.phi + size * waves + rng.normal() * size)
            if np.isfinite(joints).all():
                assert summed(task.weights, joints) >= bound


def test_a_search_of_all_pairs_finds_little_better(planned):
    task, paths = planned
    path = min(paths, key=lambda candidate: len(candidate.phi))
    (bound,) = certificate.certified(task, [path]).bound
    assert bound <= shortest(task, path) * (1.0 + 1e-9)


def test_a_path_without_optimisation_has_a_gap(planned):
    task, paths = planned
    turned = []
    for path in paths[:1]:
        phi = path.phi + 0.3 * path.bead.parameter
        joints = task.raw_joints(gather([path.bead], task.cell), phi)
        turned.append(dataclasses.replace(path, phi=phi, joints=joints))
    best, worse = certificate.certified(task, paths[:1]), certificate.certified(task, turned)
    assert worse.bound[0] <= best.objective[0]
    assert best.gaps[0] < 0.05 < 0.2 < worse.gaps[0]


def test_what_is_proved_does_not_depend_on_the_path_that_is_asked_about(planned):
    """The bound does not depend on the path that is certified."""
    task, paths = planned
    path = min(paths, key=lambda candidate: len(candidate.phi))
    phi = path.phi + 0.3 * path.bead.parameter
    turned = dataclasses.replace(
        path, phi=phi, joints=task.raw_joints(gather([path.bead], task.cell), phi)
    )
    of_best, of_worse = certificate.certified(task, [path, turned]).bound
    assert of_worse > 0.98 * of_best


def test_the_best_course_closes_the_gap(planned):
    """From a path that rotates needlessly to within a percent of the bound, within limits and with
    the required conditioning."""
    task, paths = planned
    for path in paths[:1]:  # the other path is at the limits of its last axis
        points = gather([path.bead], task.cell)
        phi = path.phi + 0.3 * np.sin(3.0 * path.bead.parameter)
        turned = dataclasses.replace(path, phi=phi, joints=task.joints(points, phi))
        best = certificate.closed(task, turned)
        value = summed(task.weights, best.joints)
        assert best.objective == pytest.approx(value, rel=1e-9) and value < 0.8 * summed(
            task.weights, turned.joints
        )
        (bound,) = certificate.certified(task, [best]).bound
        assert bound <= value < 1.01 * bound
        limits = task.cell.limits
        assert (best.joints >= limits.lower - 1e-9).all() and (
            best.joints <= limits.upper + 1e-9
        ).all()
        assert np.degrees(np.abs(np.diff(best.phi)).max()) < 30.0
        flange = points.frames.flange_poses(best.phi)
        np.testing.assert_allclose(task.cell.machine.chain.forward(best.joints), flange, atol=1e-6)
        assert (task.condition_at(flange, best.joints) >= best.threshold).all()


def test_a_bead_that_joins_up_still_does(planned):
    task, paths = planned
    joined = dataclasses.replace(task, joined=True)
    path = paths[0]
    phi = (
        path.phi[0]
        + path.bead.parameter
        - path.bead.parameter[0]
        + 0.2 * np.sin(2.0 * path.bead.parameter)
    )
    turned = dataclasses.replace(
        path, phi=phi, joints=task.joints(gather([path.bead], task.cell), phi)
    )
    if not turned.bead.closed or not (task.rows.margin(turned.joints) >= 0.0).all():
        pytest.skip("this bead does not come round")
    best = certificate.closed(joined, turned)
    assert best is not turned
    assert best.phi[-1] - best.phi[0] == pytest.approx(turned.phi[-1] - turned.phi[0], abs=1e-9)


def test_a_plan_with_its_gap_closed(sliced, cell_of, with_axis_6):
    """With its gap closed a plan is close to the bound."""
    full_toolpath = sliced("laval nozzle", 25.0, chord_error=1.0)
    cell = with_axis_6(cell_of(full_toolpath), 450.0)
    toolpath = dataclasses.replace(
        full_toolpath, layers=full_toolpath.layers[:2]
    )  # where no limit is active
    usual = sum(path.objective for path in plan_joints(toolpath, cell, JointParameters()).beads)
    closed = plan_joints(toolpath, cell, JointParameters(certificate=True, close_gap=True))
    assert closed.feasible and 0.0 <= closed.optimality["gap"] < 0.005
    assert closed.optimality["bound"] < 0.98 * usual  # linear rotations are farther from the bound
    total = closed.optimality["with_ways_between"]
    transitions = [
        next_path.joints[0] - bead_path.joints[-1]
        for bead_path, next_path in zip(closed.beads, closed.beads[1:])
    ]
    weights = Task(cell, 0, JointParameters()).weights
    assert total["objective"] == pytest.approx(
        sum(bead["objective"] for bead in closed.optimality["beads"])
        + sum(transition**2 @ weights for transition in transitions),
        rel=1e-9,
    )
    assert closed.optimality["bound"] * 0.97 < total["bound"] <= total["objective"]


def wavy(rng, points, count):
    """Joints (points, count, 3) of a fictitious arm, smooth in rotation and along the bead, and
    where they are allowed."""
    phi = -np.pi + np.arange(count) * 2.0 * np.pi / count
    along = np.linspace(0.0, 1.0, points)[:, None]
    joints = np.zeros((points, count, 3))
    for axis in range(3):
        joints[..., axis] = rng.integers(-1, 2) * phi  # including whole turns
        for order in (1, 2, 3):
            size, turned, drift = rng.normal() / order, rng.uniform(0.0, 6.0), rng.normal() * 2.0
            joints[..., axis] += size * np.cos(order * phi + turned + drift * along)
    middle, half = rng.uniform(-3.0, 3.0) + rng.normal() * along, rng.uniform(0.3, 2.0)
    shut = np.abs(np.angle(np.exp(1j * (phi - middle)))) < half
    return joints, ~shut


@pytest.mark.parametrize(
    "seed", [0, 1, *(pytest.param(k, marks=pytest.mark.long) for k in range(2, 34))]
)
def test_made_up_arms_against_a_search_on_a_much_finer_lattice(seed):
    points, coarse, subdivisions = 9, 180, 4 if seed < 2 else 8
    joints, free = wavy(np.random.default_rng(seed), points, coarse * subdivisions)
    weights = np.random.default_rng(seed + 100).uniform(0.05, 1.0, 3)
    # a cell is possible if one of the fine rotations in it is
    ends = np.concatenate([free, free[:, :1]], axis=1)
    possible = np.stack(
        [ends[:, k : k + coarse * subdivisions : subdivisions] for k in range(subdivisions + 1)]
    ).any(axis=0)
    minimum = np.where(free[-1], 0.0, np.inf)
    for previous, current, is_allowed in zip(joints[-2::-1], joints[:0:-1], free[-2::-1]):
        cost = sum(
            weight * np.angle(np.exp(1j * (current[None, :, axis] - previous[:, None, axis]))) ** 2
            for axis, weight in enumerate(weights)
        )
        minimum = np.where(is_allowed, (cost + minimum).min(axis=1), np.inf)
    lattice = Lattice(joints[:, ::subdivisions], possible, weights, np.ones(3, dtype=bool))
    counts = np.ones(points - 1)
    value = least_ahead.ahead(lattice, np.zeros(coarse), counts, 2.0 * float(minimum.min()))
    bound = least_ahead.least_of(value, lattice)
    assert 0.9 * minimum.min() <= bound <= minimum.min() * (1.0 + 1e-9)
    # from every rotation too, except that the bound may be slightly off next to dead ends
    from_each = minimum[::subdivisions][free[0, ::subdivisions]]
    assert (value[free[0, ::subdivisions]] <= from_each + 0.02 * minimum.min()).all()


def test_sums_that_leap_at_an_edge_hide_no_lower_ones():
    """At the last rotation before a forbidden range sums are thirty times their neighbours, and
    parabolas through them fall below all others: the minimum must still be that of a rotation, or
    next to it."""
    looked_at = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        joints, _ = wavy(rng, 1, 180)
        phi = np.arange(180) * 2.0 * np.pi / 180
        waves = (
            rng.normal() * 4.0 / k * np.cos(k * phi + rng.uniform(0.0, 6.0)) for k in range(1, 6)
        )
        free = np.convolve(rng.random(190) < 0.06, np.ones(11), "valid") == 0
        lattice = Lattice(
            joints, (free & np.roll(free, -1))[None], np.ones(3), np.ones(3, dtype=bool)
        )
        is_passable = lattice.passable[0]
        edge = is_passable & ~np.roll(is_passable, -1)
        value = np.where(is_passable, np.exp(sum(waves)) * np.where(edge, 30.0, 1.0), np.inf)
        if edge.any():
            looked_at += 1
            assert least_ahead.least_of(value, lattice) <= value.min()
    assert looked_at > 50


@pytest.mark.parametrize("objective", [name for name in OBJECTIVES if name != "displacement"])
def test_objectives_of_points_one_by_one(planned, objective):
    task, paths = planned
    task = dataclasses.replace(task, parameters=JointParameters(objective=objective))
    path = paths[0]
    points = gather([path.bead], task.cell)
    phi = np.linspace(-np.pi, np.pi, 361)
    point_indices = np.repeat(np.arange(len(points)), len(phi))
    repeated = points.select_points(point_indices)
    turned = np.tile(phi, len(points))
    joints = task.in_range(task.raw_joints(repeated, turned), repeated)
    flange = repeated.frames.flange_poses(turned)
    good = np.isfinite(joints).all(axis=1)
    value, ratio = np.full(len(joints), np.inf), np.zeros(len(joints))
    rows = points.select_points(point_indices[good])
    value[good] = criteria.value(
        task, rows, joints[good], task.jacobian_at(rows.frames, turned[good], joints[good])
    )
    ratio[good] = task.condition_at(flange[good], joints[good])
    is_allowed = (task.given_rows.margin(joints) >= 0.0) & (ratio >= path.threshold[point_indices])
    minima = np.where(is_allowed, value, np.inf).reshape(len(points), -1).min(axis=1)
    expected = float(minima.max() if objective == "limits-klein" else minima.mean())
    (bound,) = certificate.certified(task, [dataclasses.replace(path, objective=np.inf)]).bound
    assert 0.98 * expected <= bound <= expected * (1.0 + 1e-9)
