# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads that are not circles, degrees 0 to 6: seeded random curves in space, closed and open,
checked independently."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import minimize

from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.rotation import global_search, local_optimisation
from freecad_am.core.planning.task import Task
from freecad_am.core.toolpath import Bead, Layer, Toolpath

FLIP = spherical_wrist.branch_index(("front", "up", "flip"))
TURN = 2.0 * np.pi
POINTS = 48
SEEDS = (1, 2, pytest.param(3, marks=pytest.mark.long))


def curve(seed, closed, count):
    """Points and tool axes of a random smooth curve above the platform, for any number of
    points."""
    rng = np.random.default_rng(seed)
    wave, tilt, phase = rng.normal(size=(3, 4)), rng.normal(size=(2, 3)), rng.uniform(0, TURN)
    s = np.linspace(0.0, 1.0, count)
    angle = TURN * s * (1.0 if closed else 0.6) + phase
    order = np.arange(1, 4)[:, None]
    ripple = (np.cos(order * angle + wave[:, 3:]) * [[4.0], [3.0], [2.0]] * wave[:, :1]).sum(axis=0)
    height = 40.0 + (
        np.cos(order * angle + wave[:, 2:3]) * [[5.0], [4.0], [2.0]] * wave[:, 1:2]
    ).sum(axis=0)
    points = np.c_[(45.0 + ripple) * np.cos(angle), (38.0 + ripple) * np.sin(angle), height]
    lean = 0.12 * tilt @ np.cos(order * angle + phase)
    tool = np.c_[lean.T, np.ones(count)]
    if closed:
        points[-1], tool[-1] = points[0], tool[0]
    return points, tool / np.linalg.norm(tool, axis=1, keepdims=True)


def bead_of(seed, closed, count=POINTS, finer=1):
    """A bead; a `finer` one has the parameter of the coarse one's points, so that one polynomial
    serves both."""
    dense, tool = curve(seed, closed, (count - 1) * finer + 1)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(dense[::finer], axis=0), axis=1))]
    parameter = np.interp(
        np.arange(len(dense)) / finer, np.arange(count), TURN * length / length[-1]
    )
    return Bead(dense, tool, tool, parameter, np.full(len(dense), 6.0), closed)


@pytest.fixture(scope="module")
def cell():
    return cells.resolve(
        CellParameters(limits="paper", branch=("front", "up", "flip")), np.eye(4), "surface"
    )


@pytest.fixture(scope="module")
def optima(cell):
    """optima(seed, closed, degree) -> the planned joint path of one bead."""
    paths = {}

    def find(seed, closed, degree):
        key = (seed, closed, degree)
        if key not in paths:
            bead = bead_of(seed, closed)
            path = Toolpath((Layer((bead,)),), np.eye(4), 5.0, 1.0, family="surface")
            paths[key] = plan_joints(path, cell, JointParameters(degree=degree))
        return paths[key]

    return find


@pytest.mark.parametrize("closed", [True, False], ids=["closed", "open"])
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.always("1-closed", "1-open")
def test_a_higher_degree_is_never_worse(optima, seed, closed):
    paths = [optima(seed, closed, degree) for degree in range(7)]
    assert all(path.feasible for path in paths), [path.issues for path in paths]
    worth = np.array([path.beads[0].objective for path in paths])
    assert (worth[1:] <= worth[:-1] * (1.0 + 1e-4)).all(), worth
    assert worth[6] < 0.98 * worth[0]


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5, 6])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_closed_bead_joins_up(optima, seed, degree):
    """The rotation of a closed bead is continuous modulo whole turns."""
    path = optima(seed, True, degree).beads[0]
    assert np.polynomial.Polynomial(path.coefficients)(path.bead.parameter) == pytest.approx(
        path.phi, abs=1e-9
    )
    turns = (path.phi[-1] - path.phi[0]) / TURN
    assert abs(turns - np.round(turns)) < 1e-9
    differences = (path.joints[-1] - path.joints[0]) / TURN
    assert np.abs(differences - np.round(differences)).max() < 1e-9


@pytest.mark.parametrize("closed", [True, False], ids=["closed", "open"])
@pytest.mark.parametrize("seed", SEEDS)
def test_limits_and_condition_hold_on_a_finer_grid(cell, optima, seed, closed):
    for degree in (1, 3, 6):
        path = optima(seed, closed, degree).beads[0]
        bead = bead_of(seed, closed, finer=10)
        task = Task(cell, FLIP, JointParameters())
        points = gather([bead], cell)
        phi = points.polynomial(path.coefficients[None])
        joints = task.joints(points, phi)
        assert not cell.limits.exceeded(joints).any()
        assert (task.condition(points, phi, joints) >= task.thresholds(points)).all()
        assert np.abs(np.diff(joints, axis=0)).max() < 0.2  # no jump between the coarse points


@pytest.mark.parametrize("closed", [True, False], ids=["closed", "open"])
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.always
def test_a_second_solver_is_not_better_by_more_than_two_percent(cell, optima, seed, closed):
    """Without our gradients and our search: scipy's SLSQP by differences, from random polynomials
    that close."""
    degree = 3
    path = optima(seed, closed, degree).beads[0]
    task = Task(cell, FLIP, JointParameters(degree=degree), True)
    points = gather([bead_of(seed, closed)], cell)
    threshold = task.thresholds(points)
    x = points.parameter / np.pi - 1.0

    def coefficients(free, turns):
        # a polynomial of x in -1 .. 1 with equal ends except for whole turns, written without our
        # basis
        a, b, c, d = free
        values = a + c * (x * x - 1.0) + d * (x**3 - x) + (np.pi * turns * x if closed else b * x)
        return (
            np.polynomial.Polynomial.fit(points.parameter, values, degree, domain=[])
            .convert()
            .coef[None, None]
        )

    def objective(free, turns):
        judged = global_search.judge(task, points, threshold, coefficients(free, turns))
        return float(np.nan_to_num(judged.objective[0, 0], posinf=1e3))

    def margin(free, turns):
        return float(
            max(
                global_search.judge(task, points, threshold, coefficients(free, turns)).margin[
                    0, 0
                ],
                -10.0,
            )
        )

    rng = np.random.default_rng(100 + seed)
    best = np.inf
    for turns in (-1, 0, 1) if closed else (0,):
        for _ in range(4):
            start = rng.uniform([-np.pi, -np.pi, -0.3, -0.3], [np.pi, np.pi, 0.3, 0.3])
            end = minimize(
                objective,
                start,
                args=(turns,),
                method="SLSQP",
                options={"maxiter": 40},
                constraints=[{"type": "ineq", "fun": margin, "args": (turns,)}],
            ).x
            if margin(end, turns) >= 0.0:
                best = min(best, objective(end, turns))
    assert path.objective <= 1.02 * best


def test_beads_of_revolution_need_not_join(cell):
    """Only the family differs: the same bead as a layer of a part of revolution may end at a
    different rotation."""
    bead = bead_of(1, True)
    free = Toolpath((Layer((bead,)),), np.eye(4), 5.0, 1.0)
    joined = dataclasses.replace(free, family="surface")
    open_path, closed_path = (
        plan_joints(path, cell, JointParameters()).beads[0] for path in (free, joined)
    )
    assert open_path.objective <= closed_path.objective * (1.0 + 1e-6)
    assert abs(np.sin(0.5 * (closed_path.phi[-1] - closed_path.phi[0]))) < 1e-9


def test_gradients_along_what_may_change(cell):
    """Directions of allowed changes keep closed beads closed."""
    task = Task(cell, FLIP, JointParameters(degree=5), True)
    points = gather([bead_of(1, True), bead_of(2, False)], cell)
    directions = local_optimisation.refine_state.changes(task, points, 5)
    assert np.abs(directions[0, :, 1]).max() == 0.0 and np.linalg.matrix_rank(directions[1]) == 6
    assert np.linalg.matrix_rank(directions[0]) == 5
    low, high = points.ends
    for bead in (0, 1):
        values = [
            np.vander([low[bead], high[bead]], 6, increasing=True) @ column
            for column in directions[bead].T
        ]
        end_differences = [abs(value[1] - value[0]) for value in values]
        assert bead == 1 or max(end_differences) < 1e-9
