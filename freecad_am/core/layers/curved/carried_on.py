# SPDX-License-Identifier: LGPL-2.1-or-later
"""A field of a solid's nodes carried on a little past its surface, so that its levels can be cut where the solid ends."""

from __future__ import annotations

import numpy as np

from ...types import Array, Mask
from .eikonal import Links, links
from .voxels import Voxels

LAYERS = 2  # of nodes past the surface


def extrapolate(grid: Voxels, linked: Links, values: Array) -> Array:
    """Extend the field with values (n,) at the nodes inside by LAYERS of nodes, to (nx, ny, nz);
    NaN elsewhere.

    The value at a new node is the mean of the linear extrapolations from its known
    neighbours.
    """
    field = np.full(grid.solid.size, np.nan)
    field[linked.nodes] = np.where(np.isfinite(values), values, np.nan)
    is_known = grid.solid.ravel() & np.isfinite(field)
    for _ in range(LAYERS):
        field, is_known = _add_layer(grid, field, is_known)
    return field.reshape(grid.solid.shape)


def _add_layer(grid: Voxels, field: Array, is_known: Mask) -> tuple[Array, Mask]:
    linked = links(Voxels(grid.origin, grid.step, is_known.reshape(grid.solid.shape)))
    slope = gradients(linked, field[linked.nodes], 1.0)
    total, count = np.zeros(field.size), np.zeros(field.size)
    strides = grid.strides()
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            for z in (-1, 0, 1):
                step = np.array([x, y, z])
                to = linked.nodes + int(step @ strides)
                new = (to >= 0) & (to < field.size)
                new[new] = ~is_known[to[new]]
                extrapolated = field[linked.nodes[new]] + slope[new] @ step
                weight = 1.0 / max(np.abs(step).sum(), 1) ** 2
                total += np.bincount(to[new], weights=weight * extrapolated, minlength=field.size)
                count += np.bincount(
                    to[new], minlength=field.size, weights=np.full(int(new.sum()), weight)
                )
    reached = count > 0.0
    field = field.copy()
    field[reached] = total[reached] / count[reached]
    return field, is_known | reached


def gradients(linked: Links, values: Array, step: float) -> Array:
    """Return the slope (n, 3) of values (n,) of the nodes inside.

    By both neighbours along each axis, or the one that exists; without either, by the slopes
    of the adjacent nodes; 0 if these have none either.
    """
    padded = np.append(values, np.nan)
    slopes = np.zeros((len(values), 3))
    for axis in range(3):
        behind = values - padded[linked.neighbours[2 * axis]]
        ahead = padded[linked.neighbours[2 * axis + 1]] - values
        slopes[:, axis] = _mean(np.stack([behind, ahead])) / step
        lacking = np.flatnonzero(np.isnan(slopes[:, axis]))
        around = np.append(slopes[:, axis], np.nan)[linked.neighbours[:, lacking]]
        slopes[lacking, axis] = np.nan_to_num(_mean(around))
    return slopes


def _mean(values: Array) -> Array:
    """Return the mean (n,) of the known values (k, n); NaN where none is known."""
    is_known = np.isfinite(values)
    count = is_known.sum(axis=0)
    mean: Array = np.where(
        count > 0, np.where(is_known, values, 0.0).sum(axis=0) / np.maximum(count, 1), np.nan
    )
    return mean
