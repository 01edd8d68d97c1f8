# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lower bound of the objective over all rotations: nothing that can be run goes below it, and it is near."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.kinematics.inverse import opw
from freecad_am.core.parameters.joints import OBJECTIVES, JointParameters
from freecad_am.core.planning import criteria
from freecad_am.core.planning.certificate import bound as certificate
from freecad_am.core.planning.certificate.cells import Cells
from freecad_am.core.planning.certificate.step_bounds import least_steps
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.task import Task

BEADS = (0, 3)
FINE = 240  # rotations at which a second search looks


@pytest.fixture(scope="module")
def planned_on(sliced, cell_of, with_axis_6):
    """planned_on(part, half) -> the task and some beads of a part laid coarsely, its last axis with limits or without."""

    def plan(part, half):
        toolpath = sliced(part, 25.0, chord_error=1.0)
        cell = cell_of(toolpath) if half is None else with_axis_6(cell_of(toolpath), half)
        path = plan_joints(toolpath, cell, JointParameters())
        assert path.feasible
        task = Task(cell, opw.branch_index(path.branch), JointParameters())
        return task, [path.beads[k] for k in BEADS if k < len(path.beads)]

    return plan


@pytest.fixture(scope="module")
def planned(planned_on):
    """Where the last axis has limits, so that every axis counts."""
    return planned_on("laval nozzle", 450.0)


def summed(weights, joints):
    """Eq. 17 of joints (n, axes) by complex numbers, which know no turns."""
    step = np.angle(np.exp(1j * joints[1:]) / np.exp(1j * joints[:-1]))
    return float((step**2 @ weights).sum())


def shortest(task, path):
    """The least eq. 17 over rotations of FINE values at every point of a bead: what a search of pairs finds."""
    points = gather([path.bead], task.cell)
    phi = np.arange(FINE) * 2.0 * np.pi / FINE
    joints = np.stack([task.raw_joints(points.each(np.full(FINE, i)), phi) for i in range(len(points))])
    away = np.exp(1j * (joints - task.middle))
    reachable = np.isfinite(joints).all(axis=2) & (np.abs(np.angle(away)) <= np.where(
        task.continuous, np.inf, 0.5 * (task.cell.limits.upper - task.cell.limits.lower))).all(axis=2)
    ratio = np.stack([
        task.condition_at(points.frames.of(np.full(FINE, i)).at(phi), joints[i]) for i in range(len(points))
    ])
    reachable &= ratio >= path.threshold[:, None]
    least = np.where(reachable[0], 0.0, np.inf)
    for before, after, there in zip(joints, joints[1:], reachable[1:]):
        cost = sum(
            weight * np.angle(np.exp(1j * (after[None, :, axis] - before[:, None, axis]))) ** 2
            for axis, weight in enumerate(task.weights)
        )
        least = np.where(there, np.nanmin(np.where(np.isnan(cost), np.inf, cost) + least[:, None], axis=0), np.inf)
    return float(least.min())


@pytest.mark.parametrize("part", ["sphere", "laval nozzle", "intake funnel"])
def test_the_default_is_within_one_percent(planned_on, part):
    task, paths = planned_on(part, None)
    found = certificate.certified(task, paths)
    for path, objective in zip(paths, found.objective):
        assert objective == pytest.approx(summed(task.weights, path.joints), rel=1e-9)
    assert (found.bound <= found.objective).all() and (found.gaps < 0.01).all()


def test_no_course_of_the_rotation_goes_below(planned):
    task, paths = planned
    rng = np.random.default_rng(20261123)
    found = certificate.certified(task, paths)
    for path, bound in zip(paths, found.bound):
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
    path = min(paths, key=lambda one: len(one.phi))
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


def test_what_is_proved_does_not_depend_on_the_path_that_is_asked_about(planned, monkeypatch):
    """Where few cells may be open: those that lead below a bad path are not all worth it."""
    task, paths = planned
    path = min(paths, key=lambda one: len(one.phi))
    phi = path.phi + 0.3 * path.bead.parameter
    turned = dataclasses.replace(path, phi=phi, joints=task.raw_joints(gather([path.bead], task.cell), phi))
    monkeypatch.setattr(certificate, "MOST_STEPS", 200_000)
    of_best, of_worse = certificate.certified(task, [path, turned]).bound
    assert of_worse > 0.98 * of_best


def test_where_cells_are_too_many_a_lower_bound_is_aimed_at(planned, monkeypatch):
    task, paths = planned
    path = min(paths, key=lambda one: len(one.phi))
    monkeypatch.setattr(certificate, "MOST_STEPS", 60_000)
    (lower,) = certificate.certified(task, [path]).bound
    monkeypatch.setattr(certificate, "LESS", (0.0,))
    (left,) = certificate.certified(task, [path]).bound
    assert 1.02 * left < lower <= shortest(task, path) * (1.0 + 1e-9)


@pytest.mark.parametrize("objective", [name for name in OBJECTIVES if name != "displacement"])
def test_objectives_of_points_one_by_one(planned, objective):
    task, paths = planned
    task = dataclasses.replace(task, parameters=JointParameters(objective=objective))
    path = paths[0]
    points = gather([path.bead], task.cell)
    phi = np.linspace(-np.pi, np.pi, 361)
    every = np.repeat(np.arange(len(points)), len(phi))
    each = points.each(every)
    turned = np.tile(phi, len(points))
    joints = task.in_range(task.raw_joints(each, turned), each)
    flange = each.frames.at(turned)
    good = np.isfinite(joints).all(axis=1)
    value, ratio = np.full(len(joints), np.inf), np.zeros(len(joints))
    rows = points.each(every[good])
    value[good] = criteria.value(task, rows, joints[good], task.jacobian_at(rows.frames, turned[good], joints[good]))
    ratio[good] = task.condition_at(flange[good], joints[good])
    kept = (task.given_rows.margin(joints) >= 0.0) & (ratio >= path.threshold[every])
    least = np.where(kept, value, np.inf).reshape(len(points), -1).min(axis=1)
    known = float(least.max() if objective == "limits-klein" else least.mean())
    (bound,) = certificate.certified(task, [dataclasses.replace(path, objective=np.inf)]).bound
    assert 0.98 * known <= bound <= known * (1.0 + 1e-9)


def test_steps_between_cells_by_looking_everywhere_in_them():
    rng = np.random.default_rng(7)
    count, half = 200, 0.05
    start, end = (
        Cells(rng.normal(size=(count, 6)), rng.normal(size=(count, 6)), np.abs(rng.normal(scale=1e-3, size=(count, 6))),
              np.ones(count, dtype=bool), half)
        for _ in range(2)
    )
    end = dataclasses.replace(end, middle=start.middle + rng.normal(scale=0.05, size=(count, 6)))
    weights, multiplier = rng.uniform(0.1, 2.0, 6), (0.05, -0.08)
    found = least_steps(weights, start, end, multiplier)
    s, t = (grid.ravel() for grid in np.meshgrid(*[np.linspace(-half, half, 41)] * 2))
    least = np.full(count, np.inf)
    for k in range(count):
        apart = (end.middle[k] + np.outer(t, end.slope[k])) - (start.middle[k] + np.outer(s, start.slope[k]))
        near = np.maximum(np.abs(apart) - start.off[k] - end.off[k], 0.0)
        least[k] = (near**2 @ weights + multiplier[0] * s - multiplier[1] * t).min()
    assert (found <= least + 1e-12).all()
    assert np.median(least - found) < 0.1 * np.median(np.abs(least))
