# SPDX-License-Identifier: LGPL-2.1-or-later
"""A field of a solid's nodes carried on a little past its surface, so that its levels can be cut where the solid ends."""

from __future__ import annotations

import numpy as np

from ...types import Array, Mask
from .eikonal import Links, links
from .voxels import Voxels

LAYERS = 2  # of nodes past the surface


def carried_on(grid: Voxels, linked: Links, values: Array) -> Array:
    """The field (nx, ny, nz) with values (n,) at the nodes inside, and LAYERS of nodes past them by what the field does
    there: the mean of what each known neighbour's gradient says. nan elsewhere."""
    field = np.full(grid.solid.size, np.nan)
    field[linked.nodes] = np.where(np.isfinite(values), values, np.nan)
    known = grid.solid.ravel() & np.isfinite(field)
    for _ in range(LAYERS):
        field, known = _one_more(grid, field, known)
    return field.reshape(grid.solid.shape)


def _one_more(grid: Voxels, field: Array, known: Mask) -> tuple[Array, Mask]:
    linked = links(Voxels(grid.origin, grid.step, known.reshape(grid.solid.shape)))
    slope = gradients(linked, field[linked.nodes], 1.0)
    total, count = np.zeros(field.size), np.zeros(field.size)
    strides = grid.strides()
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            for z in (-1, 0, 1):
                away = np.array([x, y, z])
                to = linked.nodes + int(away @ strides)
                new = (to >= 0) & (to < field.size)
                new[new] = ~known[to[new]]
                said = field[linked.nodes[new]] + slope[new] @ away
                weight = 1.0 / max(np.abs(away).sum(), 1) ** 2
                total += np.bincount(to[new], weights=weight * said, minlength=field.size)
                count += np.bincount(
                    to[new], minlength=field.size, weights=np.full(int(new.sum()), weight)
                )
    found = count > 0.0
    field = field.copy()
    field[found] = total[found] / count[found]
    return field, known | found


def gradients(linked: Links, values: Array, step: float) -> Array:
    """The slope (n, 3) of values (n,) of the nodes inside: by both neighbours along each axis, or the one there is; where
    there is none, that of the nodes beside it; 0 where these have none either."""
    padded = np.append(values, np.nan)
    found = np.zeros((len(values), 3))
    for axis in range(3):
        behind = values - padded[linked.neighbours[2 * axis]]
        ahead = padded[linked.neighbours[2 * axis + 1]] - values
        found[:, axis] = _mean(np.stack([behind, ahead])) / step
        lacking = np.flatnonzero(np.isnan(found[:, axis]))
        around = np.append(found[:, axis], np.nan)[linked.neighbours[:, lacking]]
        found[lacking, axis] = np.nan_to_num(_mean(around))
    return found


def _mean(values: Array) -> Array:
    """The mean (n,) of those of values (k, n) that are known; nan where none is."""
    known = np.isfinite(values)
    count = known.sum(axis=0)
    mean: Array = np.where(
        count > 0, np.where(known, values, 0.0).sum(axis=0) / np.maximum(count, 1), np.nan
    )
    return mean
