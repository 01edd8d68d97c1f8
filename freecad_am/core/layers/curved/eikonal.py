# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distance by the way through a solid, on a grid: |grad u| = 1 inside, u given at seeds.

Solved by the fast iterative method (Jeong and Whitaker 2008), which updates whole fronts at once, with Godunov's upwind
scheme; then once more, band by band outwards, with second differences where there are any (Sethian 1999, 4.1).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from .voxels import Voxels

CONVERGED = 1e-9  # of a step; a node that comes no nearer than that is done
BAND = 0.5  # of a step; nodes whose distances differ by less depend on one another
ROUNDS = 3  # in a band


class Links(NamedTuple):
    """Nodes inside, numbered through: nodes (n,) of the flat grid; beside (6, n) the neighbours behind and ahead along x,
    along y, along z; n where there is none inside."""

    nodes: Index
    neighbours: Index

    def beyond(self, side: int, nodes: Index) -> Index:
        """The second neighbours (k,) of nodes (k,) on one of the six sides; n where there is none."""
        column = np.append(self.neighbours[side], len(self.nodes))
        found: Index = column[column[nodes]]
        return found


def links(grid: Voxels) -> Links:
    """The neighbours of all nodes inside."""
    nodes = grid.nodes
    number = np.full(grid.solid.size + 1, len(nodes), dtype=np.intp)
    number[nodes] = np.arange(len(nodes))
    return Links(
        nodes,
        np.stack([number[nodes + sign * stride] for stride in grid.strides() for sign in (-1, 1)]),
    )


def arrival(linked: Links, step: float, seeds: Index, values: Array) -> Array:
    """How far (n,) mm nodes are from the seeds (k,), of which the values (k,) are known; inf where no way leads."""
    u = np.full(len(linked.nodes) + 1, np.inf)
    u[seeds] = values
    fixed = np.zeros(len(u), dtype=bool)
    fixed[seeds] = fixed[-1] = True
    active = _around(linked, seeds, fixed)
    while len(active):
        found = _godunov(
            u[linked.neighbours[0::2, active]], u[linked.neighbours[1::2, active]], step
        )
        better = found < u[active] - CONVERGED * step
        u[active[better]] = found[better]
        active = _around(linked, active[better], fixed)
    return _sharpened(linked, step, u, fixed)[:-1]


def _around(linked: Links, nodes: Index, fixed: Mask) -> Index:
    """The nodes beside some, without those that are fixed."""
    marked = np.zeros(len(fixed), dtype=bool)
    marked[linked.neighbours[:, nodes]] = True
    found: Index = np.flatnonzero(marked & ~fixed)
    return found


def _godunov(behind: Array, ahead: Array, step: float) -> Array:
    """The distance (k,) that neighbours (3, k) behind and ahead along the three axes give a node."""
    return _root(np.minimum(behind, ahead), np.full(behind.shape, step))


def _root(values: Array, steps: Array) -> Array:
    """The larger root u (k,) of sum ((u - v) / h)^2 = 1 over those of three v (3, k) with steps h that are below u."""
    order = np.argsort(values, axis=0, kind="stable")
    v, h = np.take_along_axis(values, order, axis=0), np.take_along_axis(steps, order, axis=0)
    found: Array = v[0] + h[0]
    weight, first, second = np.zeros(v.shape[1]), np.zeros(v.shape[1]), np.zeros(v.shape[1])
    base = np.where(
        np.isfinite(v[0]), v[0], 0.0
    )  # relative to the least: far from the seeds squares would lose digits
    for k in range(3):
        use = (found > v[k]) & np.isfinite(v[k])
        relative = np.where(use, v[k] - base, 0.0)
        share = np.where(use, h[k] ** -2, 0.0)
        weight, first, second = (
            weight + share,
            first + share * relative,
            second + share * relative**2,
        )
        inside = first**2 - weight * (second - 1.0)
        root = base + (first + np.sqrt(np.maximum(inside, 0.0))) / np.maximum(weight, 1e-300)
        found = np.where(use & (inside >= 0.0), root, found)
    return found


def _sharpened(linked: Links, step: float, u: Array, fixed: Mask) -> Array:
    """The same distances (n + 1,) with second differences, from the seeds outwards."""
    free = np.flatnonzero(~fixed & np.isfinite(u))
    order = free[np.argsort(u[free], kind="stable")]
    band = np.floor(u[order] / (BAND * step))
    sharp = u.copy()
    for some in np.split(order, np.flatnonzero(np.diff(band)) + 1):
        if not len(some):
            continue
        nearest, steps = _upwind(linked, step, u, sharp, some)
        for _ in range(ROUNDS):
            sharp[some] = _root(nearest, steps)
            nearest, steps = _upwind(linked, step, u, sharp, some)
    return sharp


def _upwind(
    linked: Links, step: float, first: Array, sharp: Array, nodes: Index
) -> tuple[Array, Array]:
    """What stands for the neighbour along each axis, and its step, (3, k): of second order where the second node behind it
    is no farther from the seeds. `first` decides which neighbour is upwind."""
    values, steps = np.full((3, len(nodes)), np.inf), np.full((3, len(nodes)), step)
    for axis in range(3):
        sides = linked.neighbours[2 * axis : 2 * axis + 2, nodes]
        lower = np.argmin(first[sides], axis=0)
        near = sides[lower, np.arange(len(nodes))]
        far = np.where(
            lower == 0, linked.beyond(2 * axis, nodes), linked.beyond(2 * axis + 1, nodes)
        )
        upwind = first[near] < first[nodes]
        two = upwind & (first[far] <= first[near])
        a, b = sharp[near], np.where(two, sharp[far], 0.0)
        values[axis] = np.where(
            two, (4.0 * np.where(two, a, 0.0) - b) / 3.0, np.where(upwind, a, np.inf)
        )
        steps[axis] = np.where(two, 2.0 * step / 3.0, step)
    return values, steps
