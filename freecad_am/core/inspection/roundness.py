# SPDX-License-Identifier: LGPL-2.1-or-later
"""Roundness of measured points: circle and sphere of least squares, and the narrowest zone between two concentric ones.

Circularity and sphericity in ISO 1101 are the width of the narrowest zone; coordinate measuring machines often report the zone
about the least-squares centre, which is never smaller (Chalvin 2020, table 2, does not say which).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, linprog

from ..issues import InputError, Word
from ..types import Array

ROUNDS = 60
MIN_EXTENT_RATIO = (
    1e-6  # of the largest extent: points that are all in a line, or a plane, have no centre
)
STILL = 1e-13  # of the radius


@dataclass(frozen=True, eq=False)
class Round:
    """A circle (two coordinates) or sphere (three) fitted to points.

    centre: (d,) mm. radius: mm. inner, outer: mm, the smallest and largest distance of a point from the centre.
    """

    centre: Array
    radius: float
    inner: float
    outer: float

    @property
    def zone(self) -> float:
        """Width of the zone that holds all points, mm."""
        return self.outer - self.inner


def least_squares_round(points: Array, where: str) -> Round:
    """The circle or sphere with the least sum of squared distances from points (n, d), d 2 or 3; InputError, naming `where`, if none
    exists.
    """
    start, scale = _algebraic(points, where)

    def residuals(unknown: Array) -> Array:
        return np.asarray(np.linalg.norm(points - unknown[:-1], axis=1) - unknown[-1])

    def slopes(unknown: Array) -> Array:
        offsets = points - unknown[:-1]
        return np.column_stack([-_unit(offsets), np.full(len(points), -1.0)])

    solution = least_squares(
        residuals, start, slopes, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=scale
    ).x
    return _round(points, solution[:-1], float(solution[-1]))


def narrowest(points: Array, where: str) -> Round:
    """The centre about which the zone of points (n, d) is narrowest; the radius is the middle of the zone.

    Found from the least-squares centre by linear programs for the change of the centre, each within a box about the last
    centre that shrinks when the zone does not (Chebyshev approximation by trust region); the narrowest zone near it, which
    is the global one for points all round.
    """
    best = least_squares_round(points, where)
    reach = max(best.zone, STILL * best.radius)
    dimension = points.shape[1]
    for _ in range(ROUNDS):
        offsets = points - best.centre
        distance, slope = np.linalg.norm(offsets, axis=1), -_unit(offsets)
        # unknown: change of the centre, inner and outer radius; inner <= distance + slope . change <= outer
        none, ones = np.zeros((len(points), 1)), np.ones((len(points), 1))
        rows = np.block([[-slope, ones, none], [slope, none, -ones]])
        limits = np.concatenate([distance, -distance])
        cost = np.concatenate([np.zeros(dimension), [-1.0, 1.0]])
        bounds = [(-reach, reach)] * dimension + [(None, None)] * 2
        step = linprog(cost, A_ub=rows, b_ub=limits, bounds=bounds, method="highs")
        if step.status != 0 or step.x is None:
            break
        trial = _round(points, best.centre + step.x[:dimension], 0.0)
        promised = best.zone - (step.x[-1] - step.x[-2])
        if trial.zone < best.zone:
            best = trial
        else:
            reach *= 0.25
        if reach <= STILL * best.outer or promised <= STILL * best.outer:
            break
    return Round(best.centre, 0.5 * (best.inner + best.outer), best.inner, best.outer)


def _unit(offsets: Array) -> Array:
    """Unit vectors; zero for a point at the centre, which may move anywhere."""
    return np.asarray(
        offsets / np.maximum(np.linalg.norm(offsets, axis=1, keepdims=True), np.finfo(float).tiny)
    )


def _round(points: Array, centre: Array, radius: float) -> Round:
    distance = np.linalg.norm(points - centre, axis=1)
    return Round(centre, radius, float(distance.min()), float(distance.max()))


def _algebraic(points: Array, where: str) -> tuple[Array, float]:
    """Centre and radius (d + 1,) from the linear equations of the circle or sphere, and the extent of the points."""
    dimension = points.shape[1]
    name = "circle" if dimension == 2 else "sphere"
    if len(points) < dimension + 1:
        raise InputError(
            "TOO_FEW_POINTS",
            where,
            "{} points do not define a {}; measure at least {}",
            len(points),
            Word(name),
            dimension + 1,
        )
    middle = points.mean(axis=0)
    local = points - middle
    spread = np.linalg.svd(local, compute_uv=False)
    if spread[-1] <= MIN_EXTENT_RATIO * spread[0]:
        shape = "line" if dimension == 2 else "plane"
        raise InputError(
            "FLAT_POINTS",
            where,
            "all points are in one {}, and no {} fits; measure over a wider arc",
            Word(shape),
            Word(name),
        )
    system = np.column_stack([2.0 * local, np.ones(len(points))])
    solved = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)[0]
    centre, constant = solved[:-1], solved[-1]
    radius = np.sqrt(constant + centre @ centre)
    return np.concatenate([centre + middle, [radius]]), float(np.ptp(points, axis=0).max())
