# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which cubes of a grid the pieces of a layer may fill: the nearest piece of each, and how much of it their beads cover."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...types import Array, Index, Mask
from .grid import Grid
from .strands import Strands

STEP = 1.0 / np.sqrt(
    3.0
)  # of a cube's edge: a lattice of it, however it is turned, has a place in every cube
SAMPLES = 1_500_000  # of such lattices made at once; bounds the memory
FULL = 1.0 - 1e-9
BRIDGED = (
    1.25  # widths: a melt closes what is left open between two beads that would be as wide as this
)


@dataclass(frozen=True, eq=False)
class Footprint:
    """k cubes of a layer. place: (k,) in the grid. piece: (k,) the nearest one; other: (k,) that of the bead beside
    it, the same where there is none, and share: (k,) how much of the cube is on the nearest one's side of the middle
    between. up: (k,) mm of the middle of the cube along the piece's build direction, from the path; aside: (k,) mm
    from the middle of the bead, to its left with a plus. cover: (k,) share of the cube that is within the beads'
    widths."""

    place: Index
    piece: Index
    other: Index
    share: Array
    up: Array
    aside: Array
    cover: Array

    def mixed(self, of_pieces: Array) -> Array:
        """(k,) at cubes, of values (n,) of pieces."""
        return np.asarray(
            self.share * of_pieces[self.piece] + (1.0 - self.share) * of_pieces[self.other],
            dtype=np.float64,
        )

    def summed(self, of_cubes: Array, count: int) -> Array:
        """(n,) over the cubes of each of so many pieces, of values (k,)."""
        own = np.bincount(self.piece, self.share * of_cubes, count)
        return np.asarray(
            own + np.bincount(self.other, (1.0 - self.share) * of_cubes, count), dtype=np.float64
        )


def footprint(grid: Grid, pieces: Strands, low: Array, high: Array) -> Footprint:
    """The cubes of all pieces of a layer that are not full yet, from `low` to `high` (n,) mm above the path."""
    found = [_near(grid, pieces, rows, low, high) for rows in _chunks(grid, pieces, low, high)]
    place, piece, up, aside, off = (np.concatenate(columns) for columns in zip(*found, strict=True))
    # the nearest first, measured by the width; where two are alike the one laid first
    order = np.lexsort((piece, off / pieces.width[piece], place))
    place, piece = place[order], piece[order]
    up, aside, off = up[order], aside[order], off[order]
    alone, bridged = (
        np.clip((0.5 * wide * pieces.width[piece] - off) / grid.edge + 0.5, 0.0, 1.0)
        for wide in (1.0, BRIDGED)
    )
    begins = np.flatnonzero(np.diff(place, prepend=-1))
    of = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(place))))
    other: Index = np.flatnonzero(pieces.apart(piece[begins][of], piece))
    other = other[
        np.sort(np.unique(of[other], return_index=True)[1])
    ]  # of each cube the nearest one of another bead
    cover, second, share = alone[begins], piece[begins], np.ones(len(begins))
    mine = of[other]
    second[mine] = piece[other]
    # between beads; bridged where both are near
    near = np.minimum(bridged[other], bridged[begins][mine])
    cover[mine] = np.maximum(
        cover[mine] + alone[other], np.where(alone[other] < near, 2.0 * near, 0.0)
    )
    share[mine] = np.clip((off[other] - off[begins][mine]) / (2.0 * grid.edge) + 0.5, 0.0, 1.0)
    return Footprint(
        place[begins],
        piece[begins],
        second,
        share,
        up[begins],
        aside[begins],
        np.minimum(cover, 1.0),
    )


def _chunks(grid: Grid, pieces: Strands, low: Array, high: Array) -> Iterator[Index]:
    """Pieces in parts, those that end a bead, which reach farther, by themselves."""
    for some in (np.flatnonzero(~pieces.ends), np.flatnonzero(pieces.ends)):
        if not len(some):
            continue
        each = float(np.prod(_counts(grid, pieces, some, low, high)))
        yield from np.array_split(some, 1 + int(each * len(some) / SAMPLES))


def _reach(grid: Grid, pieces: Strands, rows: Index) -> tuple[Array, Array]:
    """How far (n,) mm cubes may be from the middle of pieces along them, and to a side."""
    beyond = np.where(pieces.ends[rows], 0.5 * pieces.width[rows] + 0.5 * grid.edge, grid.edge)
    return 0.5 * pieces.length[rows] + beyond, 0.5 * BRIDGED * pieces.width[rows] + 0.5 * grid.edge


def _counts(
    grid: Grid, pieces: Strands, rows: Index, low: Array, high: Array
) -> tuple[int, int, int]:
    ahead, aside = _reach(grid, pieces, rows)
    spans = 2.0 * ahead.max(), 2.0 * aside.max(), float((high[rows] - low[rows]).max())
    along, across, up = (int(np.ceil(span / (STEP * grid.edge))) + 1 for span in spans)
    return along, across, up


def _near(
    grid: Grid, pieces: Strands, rows: Index, low: Array, high: Array
) -> tuple[Index, Index, Array, Array, Array]:
    """Cubes near some pieces: place, piece, mm above the path, aside, and from the line of the piece, for each pair."""
    ahead, aside = _reach(grid, pieces, rows)
    counts = _counts(grid, pieces, rows, low, high)
    way = [np.linspace(-1.0, 1.0, count) for count in counts]
    ways = (
        ahead[:, None] * pieces.along[rows],
        aside[:, None] * pieces.side[rows],
        (0.5 * (high - low)[rows])[:, None] * (pieces.build[rows]),
    )
    middle = pieces.middle[rows] + (0.5 * (low + high)[rows])[:, None] * pieces.build[rows]
    cubes, corner, spans = [], [], []
    for axis in range(3):  # one after the other: sums of few numbers along each way first
        some = middle[:, axis, None] + ways[0][:, axis, None] * way[0]
        some = some[:, :, None] + (ways[1][:, axis, None] * way[1])[:, None]
        some = some[:, :, :, None] + (ways[2][:, axis, None] * way[2])[:, None, None]
        cube = np.floor(some.reshape(len(rows), -1) * (1.0 / grid.edge)).astype(np.int64)
        corner.append(cube.min(axis=1))
        cube -= corner[-1][:, None]
        spans.append(int(cube.max()) + 1)
        cubes.append(cube)
    # each cube once for each piece: ticked off in a box around the piece, which is quicker than sorting them
    box = spans[0] * spans[1] * spans[2]
    ticked = np.zeros(len(rows) * box, dtype=np.bool_)
    ticked[
        (cubes[0] * spans[1] + cubes[1]) * spans[2] + cubes[2] + box * np.arange(len(rows))[:, None]
    ] = True
    own, number = np.divmod(np.flatnonzero(ticked), box)
    place = grid.places(
        np.stack(np.unravel_index(number, tuple(spans)), axis=1) + np.stack(corner, axis=1)[own]
    )
    free = grid.filled[place] < FULL
    place, piece = place[free], rows[own[free]]
    away = grid.centres(place) - pieces.middle[piece]
    along, left, up = (
        np.einsum("ij,ij->i", away, column[piece])
        for column in (pieces.along, pieces.side, pieces.build)
    )
    off = np.hypot(left, np.maximum(np.abs(along) - 0.5 * pieces.length[piece], 0.0))
    kept: Mask = off < 0.5 * (BRIDGED * pieces.width[piece] + grid.edge)
    return place[kept], piece[kept], up[kept], left[kept], off[kept]
