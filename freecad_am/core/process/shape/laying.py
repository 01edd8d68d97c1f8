# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deposit as it comes to be, layer by layer: what is fed lies where there is room under its bead's surface.

A bead alone has the section of a parabola as wide as it, as high as what is fed makes it. On what lies below, that surface
rises until as much room is under it as is fed: over a bead of the same width it moves up by the layer's share, and the
wall's sides are straight. Beside a neighbour a bead ends halfway, and rises by what it would have laid on it: the area is
kept. Up to a distance of 0.738 widths the surface between two is flat, beyond it falls into a valley (Ding, Pan, Cuiuri, Li
2015, tangent overlapping); beads that count as wide as they are apart are taken to lie at that distance. What is fed spreads
over a bead's width along and across, as a melt levels itself, before it finds its height.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from ...geometry.columns import dots
from ...issues import Text
from ...parameters.process import ProcessParameters
from ...toolpath import Toolpath
from ...types import Array, Index
from ..deposit.spacing import is_spiral, turns_of
from .footprint import Footprint, footprint
from .grid import Grid
from .strands import Strands, strands, together

MAX_CUBES = 400_000  # cubes, about, of a deposit
FINEST = 0.5  # of a layer height, and half of that of a bead's width: no cube is smaller
PARABOLA = 1.5  # height of a parabola over the mean of it
FLAT = 0.738  # of a width: beads no farther apart have a flat surface between them
NEIGHBOUR_WIDTHS = 1.05  # of the mean of two widths: what is farther apart has nothing between
SAG = 0.5  # layer heights that a bead fills at most below where it should lie
LOOKED = 2.0  # layer heights above and below, within which what a layer lies on is looked for
SEARCH_HEIGHT = 1.0  # layer heights that a bead is looked for above where it should end
AGAIN = 4  # times that more room is looked for, twice as much each time
POOL = 1.5  # widths over which a melt levels itself
ROUNDS = 10  # in which levels are found
LEAST = 0.05  # of a piece's area that counts as rising at least
HALVINGS = 60
LEFT = 1e-12  # of what a layer is fed; less has no place for rounding alone

Report = Callable[[float, str], None]


@dataclass(frozen=True, eq=False)
class Part:
    """What a feature deposits: its toolpath, the numbers (k,) of its layers in the whole, and its process."""

    toolpath: Toolpath
    numbers: Index
    process: ProcessParameters


@dataclass(frozen=True, eq=False)
class PredictedDeposit:
    """A deposit. grid: what is filled. fed, deposited: mm3 that the wire fed, and that found a place. pieces: all strands,
    with level (n,): mm of the surface in their middle above the path, and bead_in_layer (n,). drift: (layers,) mm by which
    the surface of each layer, in the mean, ends above where the next one should begin, NaN where it has no beads."""

    grid: Grid
    pieces: Strands
    level: Array
    bead_in_layer: Index
    fed: float
    deposited: float
    drift: Array


def parts_of(toolpath: Toolpath, processes: Sequence[ProcessParameters]) -> tuple[Part, ...]:
    """The features of a toolpath with the process of each."""
    return tuple(
        Part(part, numbers, own)
        for (part, numbers), own in zip(toolpath.parts, processes, strict=True)
    )


def edge_of(pieces: Strands) -> float:
    """mm of the cubes for a deposit of these pieces: fine against layers and beads, as far as their number allows."""
    fine = FINEST * min(float(pieces.height.min()), 0.5 * float(pieces.width.min()))
    return max(fine, float(np.cbrt(pieces.volume.sum() / MAX_CUBES)))


def predicted_deposit(
    parts: Sequence[Part], report: Report, edge: float | None = None
) -> PredictedDeposit:
    """The deposit of features, one after the other. edge: mm of the cubes it is told in, as `edge_of` where it is left out.
    ValueError where it is not known how wide beads count."""
    each = [strands(part.toolpath, part.process) for part in parts]
    pieces = together(each)
    grid = Grid(edge_of(pieces) if edge is None else edge)
    layers = sum(len(part.toolpath.layers) for part in parts)
    drift, total = np.full(layers, np.nan), 0.0
    levels, beads = [], []
    for part, own in zip(parts, each, strict=True):
        below: tuple[Strands, Array] | None = None
        spiral = is_spiral(part.toolpath)
        courses = turns_of(part.toolpath.layers[0].beads[0])[own.point] if spiral else own.layer
        means: list[float] = []
        bounds = np.searchsorted(courses, np.arange(courses.max(initial=-1) + 2))
        for start, end in zip(bounds.tolist(), bounds[1:].tolist(), strict=False):
            if start == end:
                continue
            some = own.rows(slice(start, end))
            done = int(part.numbers[some.layer[0]]) + 1
            report(done / layers, Text("layer {} of {}", done, layers))
            layer = _Layer(grid, some, _base(grid, some, below))
            total += layer.lay()
            over = layer.level - layer.rise - some.height
            means.append(float(np.average(over, weights=some.length)))
            drift[part.numbers[some.layer[0]]] = means[-1]
            levels.append(layer.level)
            beads.append(some.bead - some.bead[0])
            below = some, over
        if spiral:
            drift[part.numbers[0]] = _spiral_drift(means)
    numbered = np.concatenate(
        [part.numbers[own.layer] for part, own in zip(parts, each, strict=True)]
    )
    return PredictedDeposit(
        grid,
        replace(pieces, layer=numbered),
        np.concatenate(levels),
        np.concatenate(beads),
        float(pieces.volume.sum()),
        total,
        drift,
    )


def _spiral_drift(means: Sequence[float]) -> float:
    """mm by which turns of a spiral end too high, at the worst one, from how much each does in the mean. The turn that
    rises from the flat first one and the flat last one, which lie on what is rising, are reported as deposited twice."""
    rising = np.array(means[1:-1])
    if not len(rising):
        return 0.0
    off = rising - rising[0]
    return float(off[np.abs(off).argmax()])


def _base(grid: Grid, pieces: Strands, below: tuple[Strands, Array] | None) -> Array:
    """mm (n,) above their path of the deposit that the middles of pieces lie on, that of a layer to be laid; 0 where there
    is none. It is looked for from about where the layer below ended down to where it should have, and a little farther."""
    found = np.zeros(len(pieces))
    if below is None or pieces.first.all():
        return found
    lower, over = below
    near = cKDTree(lower.middle + lower.height[:, None] * lower.build).query(pieces.middle)[1]
    start = np.maximum(over[near], 0.0) + LOOKED * pieces.height
    end = np.minimum(over[near], 0.0) - LOOKED * pieces.height
    count = int(np.ceil(float((start - end).max()) / (0.5 * grid.edge)))
    left, before = np.flatnonzero(~pieces.first), np.zeros(len(pieces))
    for number in range(count + 1):
        up = start + (end - start) * (number / count)
        now = grid.at(pieces.middle[left] + up[left, None] * pieces.build[left])
        met = now >= 0.5
        rows = left[met]
        back = np.where(number, (now[met] - 0.5) / np.maximum(now[met] - before[rows], 1e-12), 0.0)
        found[rows] = up[rows] + back * (start - end)[rows] / count
        before[left] = now
        left = left[~met]
        if not len(left):
            break
    return found


class _Layer:
    """One layer that is being laid. base: mm (n,) above their path that its pieces lie on. level: mm (n,) of their surface.
    rise: mm (n,) that the middle of a surface is above its mean."""

    def __init__(self, grid: Grid, pieces: Strands, base: Array) -> None:
        self.grid, self.pieces = grid, pieces
        area = pieces.volume / pieces.length
        free = _free_sides(pieces)
        self.fall = (
            PARABOLA * (area / pieces.width)[:, None] * free
        )  # mm (n, 2) of a surface from its middle to each side
        self.rise = self.fall.sum(axis=1) / 6.0
        base = np.where(pieces.first | (base == 0.0), base, base - self.rise)
        self.base = base
        self.level = base + pieces.height + self.rise

    def lay(self) -> float:
        """Fill the grid with what is fed to the layer; mm3 that found a place."""
        high = self.base + self.rise + (1.0 + SEARCH_HEIGHT) * self.pieces.height
        fed = float(self.pieces.volume.sum())
        placed, wanted = 0.0, self.pieces.volume
        for _ in range(AGAIN):
            placed += self._fill(wanted, high)
            missing = fed - placed
            if missing <= LEFT * fed:
                break
            wanted = missing * self.pieces.volume / fed
            high = self.base + 2.0 * (high - self.base)
        return placed

    def _fill(self, wanted: Array, high: Array) -> float:
        """Lay volumes (n,) mm3 up to `high` (n,) mm at most; mm3 that found a place."""
        grid, pieces = self.grid, self.pieces
        low = self.base - np.where(pieces.first, 0.0, pieces.height)
        near = footprint(grid, pieces, low - grid.edge, high)
        fall = self._fall(near)
        surface = near.up + fall
        # nothing below what beads lie on: the surface of the layer below, a little of what that lacks, never its underside
        lowest = np.where(pieces.first, 0.0, self.base - pieces.height)
        sagged = self.base - SAG * pieces.height + self.rise
        bottom = np.where(
            pieces.first[near.piece], 0.0, np.maximum(sagged[near.piece] - fall, lowest[near.piece])
        )
        most = near.cover * np.clip((near.up - bottom) / grid.edge + 0.5, 0.0, 1.0)
        there = grid.filled[near.place]

        def filled(level: Array) -> Array:
            upto = np.clip((near.mixed(level) - surface) / grid.edge + 0.5, 0.0, 1.0)
            full: Array = np.maximum(most * upto - there, 0.0)
            return full

        level = np.minimum(self._level(wanted, near, filled, high), high)
        # what rounding and the pools have left over goes on or off everywhere alike
        lowest, highest, cube = low.min() - high.max(), high.max() - low.min(), grid.edge**3
        total = float(wanted.sum())
        for _ in range(HALVINGS):
            middle = 0.5 * (lowest + highest)
            over = float(filled(np.minimum(level + middle, high)).sum()) * cube > total
            lowest, highest = (lowest, middle) if over else (middle, highest)
        self.level = np.minimum(level + highest, high)
        more = filled(self.level)
        grid.filled[near.place] += more
        return float(more.sum()) * cube

    def _level(
        self, wanted: Array, near: Footprint, filled: Callable[[Array], Array], high: Array
    ) -> Array:
        """mm (n,) of the surface of pieces at which as much is filled as is fed, each counted with those of its pool.
        filled: (k,) shares of cubes at levels (n,)."""
        pieces, edge = self.pieces, self.grid.edge
        pool = _pools(pieces)
        cube, level = edge**3, pool @ (self.base + self.rise) / pool.sum(axis=1).A1 + pieces.height

        def margin(at: Array) -> Array:
            found: Array = near.summed(filled(at), len(pieces)) * cube
            return found

        for _ in range(ROUNDS):
            here = margin(level)
            # what a surface a quarter of a cube higher and lower would hold more
            area = (margin(level + 0.25 * edge) - margin(level - 0.25 * edge)) / (0.5 * edge)
            step = (pool @ (wanted - here)) / np.maximum(
                pool @ area, LEAST * (pool @ (pieces.width * pieces.length))
            )
            level = np.minimum(level + np.clip(step, -pieces.height, pieces.height), high)
        found: Array = level
        return found

    def _fall(self, near: Footprint) -> Array:
        """mm (k,) that the surface of beads is lower at cubes than in their middle."""
        part = 2.0 * near.aside / self.pieces.width[near.piece]
        fall: Array = self.fall[near.piece, (near.aside < 0.0).astype(np.intp)] * np.minimum(
            part * part, 1.0
        )
        return fall


def _free_sides(pieces: Strands) -> Array:
    """(n, 2) of how much of a parabola's fall the surface has to the left and to the right of pieces of a layer: all of it
    where no other bead lies beside, none where one lies close."""
    free = np.ones((len(pieces), 2))
    reach = NEIGHBOUR_WIDTHS * float(pieces.width.max())
    pairs = cKDTree(pieces.middle).query_pairs(reach, output_type="ndarray").astype(np.intp)
    if not len(pairs):
        return free
    one, other = np.vstack([pairs, pairs[:, ::-1]]).T
    kept = pieces.apart(one, other)
    one, other = one[kept], other[kept]
    way = pieces.middle[other] - pieces.middle[one]
    aside, ahead = dots(way, pieces.side[one]), dots(way, pieces.along[one])
    mean = 0.5 * (pieces.width[one] + pieces.width[other])
    share = np.abs(aside) / mean
    adjacent = (np.abs(ahead) <= 0.5 * (pieces.length[one] + pieces.length[other])) & (
        share <= NEIGHBOUR_WIDTHS
    )
    valley = np.where(pieces.real[one], np.clip((share - FLAT) / (1.0 - FLAT), 0.0, 1.0), 0.0)
    np.minimum.at(free, (one[adjacent], (aside < 0.0).astype(np.intp)[adjacent]), valley[adjacent])
    return free


def _pools(pieces: Strands) -> csr_matrix:
    """(n, n) of how much each piece is in the pool of another: a melt levels itself."""
    pairs = (
        cKDTree(pieces.middle)
        .query_pairs(POOL * float(pieces.width.max()), output_type="ndarray")
        .astype(np.intp)
    )
    own = np.arange(len(pieces))
    one, other = np.concatenate([pairs, pairs[:, ::-1], np.stack([own, own], axis=1)]).T
    away = np.sqrt(((pieces.middle[one] - pieces.middle[other]) ** 2).sum(axis=1))
    near = np.maximum(1.0 - away / (POOL * np.minimum(pieces.width[one], pieces.width[other])), 0.0)
    return csr_matrix((near, (one, other)), shape=(len(pieces), len(pieces)))
