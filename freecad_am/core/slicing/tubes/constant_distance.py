# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers at a constant distance from the nearest point of the layer below.

Equations 5 and 6 of Chalvin 2019 are solved as one system. Instead of searching over Delta_ij and
recomputing a distance in each step, Newton's method solves for the height u on the line v = const
and the nearest position w below. Corners between smooth stretches of the front are computed
separately and kept (errata).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.walls.surface import Surface
from ...issues import InputError
from ...types import Array
from ..first_layer import ROUNDS, finer_grid
from ..smoothest_heights import refuse_too_many
from .offset import Offset, Places
from .smooth_spacing import WallLayer

AT_CORNER = 1e-9  # fraction of the period; grid points this close to a corner are replaced by it
ABOVE = 1e-9  # relative to u; a crossing is no corner if a third branch is higher by more
# fraction of the period; a change of branch in a narrower interval is a corner at its midpoint
MIN_INTERVAL = 1e-9


def next_layer(
    surface: Surface, below: WallLayer, height: float, grid: Array, label: str = "wall"
) -> WallLayer:
    """Compute the layer at a constant distance from the layer below.

    Parameters
    ----------
    surface : Surface
        The wall.
    below : WallLayer
        The layer below.
    height : float
        The distance, mm.
    grid : (n,) array
        Ascending values of v from one seam to the next. Nodes are added at corners and where cubic
        arcs deviate from the front.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    WallLayer
        The layer.

    Raises
    ------
    InputError
        LAYER_HEIGHT if a line v = const has no point at this distance.
    """
    offset = Offset(surface, below.curve, below.u, height)
    period = grid[-1] - grid[0]
    ends = grid[0] + np.mod(np.array(offset.fan_ends) - grid[0], period)
    v = np.unique(np.r_[grid, ends])
    v = v[np.r_[True, np.diff(v) > AT_CORNER * period]]
    v[-1] = grid[-1]
    positions = _evaluate_offset(offset, v, height, label)
    for _ in range(ROUNDS * 3):
        corner, added = _corners(offset, v, positions, period)
        layer = _assemble_layer(surface, offset, v, positions, corner, period)
        if not len(added):
            added = finer_grid(layer.curve)
            if not len(added):
                break
        new_positions = _evaluate_offset(offset, added, height, label)
        order = np.argsort(np.r_[v, added], kind="stable")
        v = np.r_[v, added][order]
        positions = Places(*(np.concatenate(pair)[order] for pair in zip(positions, new_positions)))
    return layer


def layers(
    surface: Surface,
    first_layer: WallLayer,
    height: float,
    u_end: float,
    points: int = 360,
    label: str = "wall",
) -> list[WallLayer]:
    """Compute all layers, from the first layer to the first one completely beyond the end.

    Parameters
    ----------
    surface : Surface
        The wall.
    first_layer : WallLayer
        The first layer.
    height : float
        Distance from layer to layer, mm.
    u_end : float
        End of the wall in u.
    points : int, optional
        Minimum number of points per layer.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    list of WallLayer
        The layers, including `first_layer`.

    Raises
    ------
    InputError
        LAYER_HEIGHT as in `next_layer`, or for too many layers.
    """
    grid = first_layer.v[0] + (first_layer.v[-1] - first_layer.v[0]) * np.linspace(
        0.0, 1.0, points + 1
    )
    wall_layers = [first_layer]
    while wall_layers[-1].u.min() < u_end:
        refuse_too_many(len(wall_layers), height, label)
        wall_layers.append(next_layer(surface, wall_layers[-1], height, grid, label))
    return wall_layers


def _evaluate_offset(offset: Offset, v: Array, height: float, label: str) -> Places:
    positions = offset.evaluate(v)
    if (positions.run < 0).any():
        where = v[np.flatnonzero(positions.run < 0)[0]]
        raise InputError(
            "LAYER_HEIGHT",
            label,
            "the wall at v = {:.4g} has no point {:g} mm from the layer below; keep the layer "
            "height below the smallest radius of curvature of the wall",
            where,
            height,
        )
    return positions


class _Corners(NamedTuple):
    """Corners: v, u and the slopes du/dv before and after each corner, (k,)."""

    v: Array
    u: Array
    into: Array
    out: Array


def _corners(offset: Offset, v: Array, positions: Places, period: float) -> tuple[_Corners, Array]:
    """Find the corners between neighbouring points on different branches.

    Also returns values of v to evaluate where a corner cannot be located yet.
    """
    jumps = np.flatnonzero(np.diff(positions.run) != 0)
    jumps = jumps[[not _smooth(offset, positions, int(i)) for i in jumps]] if len(jumps) else jumps
    if not len(jumps):
        return _Corners(*(np.empty(0),) * 4), np.empty(0)
    run = np.stack([positions.run[jumps], positions.run[jumps + 1]], axis=1)
    w = np.stack([positions.w[jumps], positions.w[jumps + 1]], axis=1)
    where, u, w = offset.crossings(
        v[jumps], v[jumps + 1], 0.5 * (positions.u[jumps] + positions.u[jumps + 1]), w, run
    )
    clear = np.isfinite(where)
    if clear.any():
        top = offset.evaluate(where[clear]).u
        clear[clear] = top <= u[clear] + ABOVE * max(1.0, np.abs(u[clear]).max())
    narrow = ~clear & (v[jumps + 1] - v[jumps] < MIN_INTERVAL * period)
    where = np.where(narrow, 0.5 * (v[jumps] + v[jumps + 1]), where)
    u = np.where(narrow, 0.5 * (positions.u[jumps] + positions.u[jumps + 1]), u)
    w = np.where(narrow[:, None], np.stack([positions.w[jumps], positions.w[jumps + 1]], axis=1), w)
    is_corner = clear | narrow
    into = offset.slopes(where[is_corner], u[is_corner], w[is_corner, 0], run[is_corner, 0])
    out = offset.slopes(where[is_corner], u[is_corner], w[is_corner, 1], run[is_corner, 1])
    middle: Array = 0.5 * (v[jumps] + v[jumps + 1])[~is_corner]
    return _Corners(where[is_corner], u[is_corner], into, out), middle


def _smooth(offset: Offset, positions: Places, i: int) -> bool:
    """Whether a branch continues smoothly into the fan at its end, without a corner."""
    run_before, run_after = offset.runs[positions.run[i]], offset.runs[positions.run[i + 1]]
    if run_before.fan == run_after.fan:
        return False
    return bool(
        abs(run_before.v[-1] - run_after.v[0]) < 1e-12
        and abs(run_before.w[-1] - run_after.w[0]) < 1e-12
    )


def _assemble_layer(
    surface: Surface, offset: Offset, v: Array, positions: Places, corner: _Corners, period: float
) -> WallLayer:
    """Build the layer through positions and corners; corners replace coincident positions."""
    where, u, into, out = corner
    start, end = v[0], v[-1]
    neighbour = np.searchsorted(np.sort(where), v)
    gap = np.full(len(v), np.inf)
    if len(where):
        ordered = np.sort(where)
        gap = np.minimum(
            np.abs(v - ordered[np.clip(neighbour - 1, 0, len(where) - 1)]),
            np.abs(v - ordered[np.clip(neighbour, 0, len(where) - 1)]),
        )
    keep = gap > AT_CORNER * period
    keep[[0, -1]] = True
    seam = np.minimum(np.abs(where - start), np.abs(where - end)) <= AT_CORNER * period
    columns = np.stack([v, positions.u, positions.slope, positions.slope])[:, keep]
    if seam.any():
        k = np.flatnonzero(seam)[0]
        columns[1:, 0] = columns[1:, -1] = u[k], into[k], out[k]
    columns = np.concatenate([columns, np.stack([where, u, into, out])[:, ~seam]], axis=1)
    columns = columns[:, np.argsort(columns[0], kind="stable")]
    columns[1, -1] = columns[1, 0]
    if not seam.any():
        columns[2:, [0, -1]] = columns[2, 0]
    return WallLayer.of(surface, *columns)
