# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers each point of which lies at the layer height from the nearest point of the curve below.

Chalvin 2019, equations 5 and 6, solved as one system: instead of a search over Delta_ij with a distance measured anew
each time, Newton finds the height u on the line v = const and the nearest place w below together. Corners, where smooth
stretches of the front meet, are found as points of their own and kept (errata).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.walls.surface import Surface
from ...issues import InputError
from ...types import Array
from ..backstop import refuse_too_many
from ..refinement import ROUNDS, finer_grid
from .offset import Offset, Places
from .wall_layer import WallLayer

AT_CORNER = 1e-9  # of the period; a grid point this near to a corner is the corner
ABOVE = (
    1e-9  # of u: a third branch that overtops a crossing by more means that it is not the corner
)
NARROWEST = (
    1e-9  # of the period; a change of branch in a narrower stretch is a corner in its middle
)


def next_layer(
    surface: Surface, below: WallLayer, height: float, grid: Array, label: str = "wall"
) -> WallLayer:
    """The layer at the distance `height` (mm) from the curve of the layer below.

    grid: (n,) values of v from one seam to the next, rising; nodes are added at corners and where cubic arcs would not
    follow the front. InputError LAYER_HEIGHT where no point of a line v = const has that distance.
    """
    offset = Offset(surface, below.curve, below.u, height)
    period = grid[-1] - grid[0]
    ends = grid[0] + np.mod(np.array(offset.fan_ends) - grid[0], period)
    v = np.unique(np.r_[grid, ends])
    v = v[np.r_[True, np.diff(v) > AT_CORNER * period]]
    v[-1] = grid[-1]
    places = _asked(offset, v, height, label)
    for _ in range(ROUNDS * 3):
        corner, added = _corners(offset, v, places, period)
        layer = _assembled(surface, offset, v, places, corner, period)
        if not len(added):
            added = finer_grid(layer.curve)
            if not len(added):
                break
        more = _asked(offset, added, height, label)
        order = np.argsort(np.r_[v, added], kind="stable")
        v = np.r_[v, added][order]
        places = Places(*(np.concatenate(pair)[order] for pair in zip(places, more)))
    return layer


def layers(
    surface: Surface,
    first: WallLayer,
    height: float,
    u_end: float,
    points: int = 360,
    label: str = "wall",
) -> list[WallLayer]:
    """All layers from the first to the first one wholly past u_end, each with at least `points` points."""
    grid = first.v[0] + (first.v[-1] - first.v[0]) * np.linspace(0.0, 1.0, points + 1)
    done = [first]
    while done[-1].u.min() < u_end:
        refuse_too_many(len(done), height, label)
        done.append(next_layer(surface, done[-1], height, grid, label))
    return done


def _asked(offset: Offset, v: Array, height: float, label: str) -> Places:
    places = offset.at(v)
    if (places.run < 0).any():
        where = v[np.flatnonzero(places.run < 0)[0]]
        raise InputError(
            "LAYER_HEIGHT",
            label,
            "no point of the wall at v = {:.4g} lies {:g} mm from the layer below; keep the layer "
            "height below the wall's smallest radius of curvature",
            where,
            height,
        )
    return places


class _Corners(NamedTuple):
    """v, u and the slopes du/dv on either side of corners, (k,)."""

    v: Array
    u: Array
    into: Array
    out: Array


def _corners(offset: Offset, v: Array, places: Places, period: float) -> tuple[_Corners, Array]:
    """The corners between neighbours on different branches, and values of v to ask for where it is not yet clear."""
    at = np.flatnonzero(np.diff(places.run) != 0)
    at = at[[not _smooth(offset, places, int(i)) for i in at]] if len(at) else at
    if not len(at):
        return _Corners(*(np.empty(0),) * 4), np.empty(0)
    run = np.stack([places.run[at], places.run[at + 1]], axis=1)
    w = np.stack([places.w[at], places.w[at + 1]], axis=1)
    where, u, w = offset.crossings(
        v[at], v[at + 1], 0.5 * (places.u[at] + places.u[at + 1]), w, run
    )
    clear = np.isfinite(where)
    if clear.any():
        top = offset.at(where[clear]).u
        clear[clear] = top <= u[clear] + ABOVE * max(1.0, np.abs(u[clear]).max())
    narrow = ~clear & (v[at + 1] - v[at] < NARROWEST * period)
    where = np.where(narrow, 0.5 * (v[at] + v[at + 1]), where)
    u = np.where(narrow, 0.5 * (places.u[at] + places.u[at + 1]), u)
    w = np.where(narrow[:, None], np.stack([places.w[at], places.w[at + 1]], axis=1), w)
    kept = clear | narrow
    into = offset.slopes(where[kept], u[kept], w[kept, 0], run[kept, 0])
    out = offset.slopes(where[kept], u[kept], w[kept, 1], run[kept, 1])
    middle: Array = 0.5 * (v[at] + v[at + 1])[~kept]
    return _Corners(where[kept], u[kept], into, out), middle


def _smooth(offset: Offset, places: Places, i: int) -> bool:
    """True where a branch goes over into the sphere about its own end: no corner."""
    one, other = offset.runs[places.run[i]], offset.runs[places.run[i + 1]]
    if one.fan == other.fan:
        return False
    return bool(abs(one.v[-1] - other.v[0]) < 1e-12 and abs(one.w[-1] - other.w[0]) < 1e-12)


def _assembled(
    surface: Surface, offset: Offset, v: Array, places: Places, corner: _Corners, period: float
) -> WallLayer:
    """The layer through the places asked for and the corners, which take the place of neighbours that coincide."""
    where, u, into, out = corner
    start, end = v[0], v[-1]
    near = np.searchsorted(np.sort(where), v)
    gap = np.full(len(v), np.inf)
    if len(where):
        ordered = np.sort(where)
        gap = np.minimum(
            np.abs(v - ordered[np.clip(near - 1, 0, len(where) - 1)]),
            np.abs(v - ordered[np.clip(near, 0, len(where) - 1)]),
        )
    keep = gap > AT_CORNER * period
    keep[[0, -1]] = True
    seam = np.minimum(np.abs(where - start), np.abs(where - end)) <= AT_CORNER * period
    columns = np.stack([v, places.u, places.slope, places.slope])[:, keep]
    if seam.any():
        k = np.flatnonzero(seam)[0]
        columns[1:, 0] = columns[1:, -1] = u[k], into[k], out[k]
    columns = np.concatenate([columns, np.stack([where, u, into, out])[:, ~seam]], axis=1)
    columns = columns[:, np.argsort(columns[0], kind="stable")]
    columns[1, -1] = columns[1, 0]
    if not seam.any():
        columns[2:, [0, -1]] = columns[2, 0]
    return WallLayer.of(surface, *columns)
