# SPDX-License-Identifier: LGPL-2.1-or-later
"""How round measured points are: circle and sphere of least squares, and the narrowest zone between two concentric ones.

Circularity and sphericity as ISO 1101 means them are the width of the narrowest zone; coordinate measuring machines often
report that of the least-squares centre, which is never smaller (Chalvin 2020, table 2, does not say which).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, linprog

from ..issues import InputError, Word
from ..types import Array

ROUNDS = 60
FLAT = 1e-6  # of the largest extent: points that are all in a line, or a plane, have no centre
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


def least(points: Array, where: str) -> Round:
    """The circle or sphere with the least sum of squared distances from points (n, d), d 2 or 3; InputError where there is
    none, naming `where`."""
    start, scale = _algebraic(points, where)

    def residuals(unknown: Array) -> Array:
        return np.asarray(np.linalg.norm(points - unknown[:-1], axis=1) - unknown[-1])

    def slopes(unknown: Array) -> Array:
        away = points - unknown[:-1]
        return np.column_stack([-_along(away), np.full(len(points), -1.0)])

    found = least_squares(
        residuals, start, slopes, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=scale
    ).x
    return _round(points, found[:-1], float(found[-1]))


def narrowest(points: Array, where: str) -> Round:
    """The centre about which the zone of points (n, d) is narrowest; the radius is that of the zone's middle.

    Found from the least-squares centre by linear programs for the change of the centre, each within a box about the last
    centre that shrinks when the zone does not (Chebyshev approximation by trust region); the narrowest zone near it, which
    is the narrowest of all for points all round.
    """
    best = least(points, where)
    reach = max(best.zone, STILL * best.radius)
    dimension = points.shape[1]
    for _ in range(ROUNDS):
        away = points - best.centre
        distance, slope = np.linalg.norm(away, axis=1), -_along(away)
        # unknown: change of the centre, inner and outer radius; inner <= distance + slope . change <= outer
        none, one = np.zeros((len(points), 1)), np.ones((len(points), 1))
        rows = np.block([[-slope, one, none], [slope, none, -one]])
        limits = np.concatenate([distance, -distance])
        cost = np.concatenate([np.zeros(dimension), [-1.0, 1.0]])
        bounds = [(-reach, reach)] * dimension + [(None, None)] * 2
        step = linprog(cost, A_ub=rows, b_ub=limits, bounds=bounds, method="highs")
        if step.status != 0 or step.x is None:
            break
        tried = _round(points, best.centre + step.x[:dimension], 0.0)
        promised = best.zone - (step.x[-1] - step.x[-2])
        if tried.zone < best.zone:
            best = tried
        else:
            reach *= 0.25
        if reach <= STILL * best.outer or promised <= STILL * best.outer:
            break
    return Round(best.centre, 0.5 * (best.inner + best.outer), best.inner, best.outer)


def _along(away: Array) -> Array:
    """Unit vectors; nothing of a point at the centre itself, which may go anywhere."""
    return np.asarray(
        away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), np.finfo(float).tiny)
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
            "{} points do not make a {}; measure {} or more",
            len(points),
            Word(name),
            dimension + 1,
        )
    middle = points.mean(axis=0)
    local = points - middle
    spread = np.linalg.svd(local, compute_uv=False)
    if spread[-1] <= FLAT * spread[0]:
        shape = "line" if dimension == 2 else "plane"
        raise InputError(
            "FLAT_POINTS",
            where,
            "all points lie in one {}, which no {} fits; measure further round",
            Word(shape),
            Word(name),
        )
    system = np.column_stack([2.0 * local, np.ones(len(points))])
    solved = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)[0]
    centre, rest = solved[:-1], solved[-1]
    radius = np.sqrt(rest + centre @ centre)
    return np.concatenate([centre + middle, [radius]]), float(np.ptp(points, axis=0).max())
