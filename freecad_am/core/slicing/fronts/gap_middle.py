# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads along the middle of gaps between fronts."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.step_count import step_count
from ...geometry.walls.surface import dot
from ...types import Array
from .curve import fit_to_wall
from .even_line import resample, smooth_points
from .slicing import Slicing

MIN_STRAIGHTNESS = 1.2  # of the height; shorter beads are
ROUND = 0.8  # of the height; standard deviation of the mean that rounds a bead


def gap_middle(slicing: Slicing, borders: list[Array]) -> SpaceCurve | None:
    """Return the curve midway between the sides of a gap with the borders (k, 3): open for one
    border, closed within a ring.
    """
    longest = max(borders, key=len)
    if len(borders) == 2:
        inner_border = next(border for border in borders if border is not longest)
        return _through(slicing, 0.5 * (longest + _opposite(longest, inner_border)), True)
    farthest = int(np.argmax(np.linalg.norm(longest - longest.mean(axis=0), axis=1)))
    border = np.roll(longest, -farthest, axis=0)
    end = int(np.argmax(np.linalg.norm(border - border[0], axis=1)))
    if end < 1 or end > len(border) - 1:
        return None
    side, back = border[: end + 1], np.vstack([border[end:], border[:1]])
    points = 0.5 * (side + _opposite(side, back))
    return _through(slicing, np.vstack([border[:1], points[1:-1], border[end : end + 1]]), False)


def _opposite(points: Array, border: Array) -> Array:
    """The nearest points (n, 3) of a border, sampled."""
    share = np.linspace(0.0, 1.0, 8, endpoint=False)[None, :, None]
    samples = np.vstack(
        [((1.0 - share) * border[:-1, None] + share * border[1:, None]).reshape(-1, 3), border[-1:]]
    )
    nearest: Array = samples[cKDTree(samples).query(points)[1]]
    return nearest


def _through(slicing: Slicing, points: Array, closed: bool) -> SpaceCurve | None:
    """A smooth curve on the wall near a line of points."""
    wall, height = slicing.wall, slicing.height
    if closed:
        points = np.vstack([points, points[:1]])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    points = points[np.r_[True, steps > 1e-9]]
    length = float(steps.sum())
    count = step_count(length, 0.5 * height, 6 if closed else 2)
    if len(points) < 2:
        return None
    # only the fine mesh knows the sides of a gap, and its middle has hooks at the ends
    line = resample(points, closed, 16 * count)
    wide = min(ROUND * height / (length / (16 * count)), 4.0 * count)
    nodes = smooth_points(line, closed, wide)[::16]
    if closed:
        nodes = np.vstack([nodes, nodes[:1]])
    elif length < MIN_STRAIGHTNESS * height:
        nodes = line[0] + np.linspace(0.0, 1.0, count + 1)[:, None] * (line[-1] - line[0])
    w = np.linspace(0.0, length, count + 1)
    nodes, normal = wall.project(nodes)
    if closed:
        nodes[-1], normal[-1] = nodes[0], normal[0]
    slope = CubicSpline(w, nodes, bc_type="periodic" if closed else "natural")(w, 1)
    slope -= dot(slope, normal)[:, None] * normal
    return fit_to_wall(wall, SpaceCurve(w, nodes, slope, slope, closed))
