# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which cubes of a grid the pieces of a layer may fill: the nearest piece of each, and its share covered by beads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...types import Array, Index, Mask
from .grid import Grid
from .strands import Strands

STEP = 1.0 / np.sqrt(
    3.0
)  # of a cube's edge: a lattice of this step has a point in every cube, in any orientation
SAMPLES = 1_500_000  # of such lattices made at once; bounds the memory
FULL_SHARE = 1.0 - 1e-9
BRIDGED = 1.25  # widths: a melt closes the gap between two beads that would be as wide as this


@dataclass(frozen=True, eq=False)
class Footprint:
    """k cubes of a layer.

    cubes: (k,) indices in the grid. piece_rows: (k,) the nearest piece; other_piece: (k,) the piece of the adjacent bead, or the
    same without one, and share: (k,) how much of the cube is on the nearest piece's side of the middle between. up: (k,) mm of the
    middle of the cube along the piece's build direction, from the path; aside: (k,) mm from the middle of the bead, positive to
    its left. cover: (k,) share of the cube that is within the beads' widths.
    """

    cubes: Index
    piece_rows: Index
    other_piece: Index
    share: Array
    up: Array
    aside: Array
    cover: Array

    def mixed(self, of_pieces: Array) -> Array:
        """(k,) at cubes, of values (n,) of pieces."""
        return np.asarray(
            self.share * of_pieces[self.piece_rows]
            + (1.0 - self.share) * of_pieces[self.other_piece],
            dtype=np.float64,
        )

    def summed(self, of_cubes: Array, count: int) -> Array:
        """(n,) sums over the cubes of `count` pieces, of values (k,)."""
        sums = np.bincount(self.piece_rows, self.share * of_cubes, count)
        return np.asarray(
            sums + np.bincount(self.other_piece, (1.0 - self.share) * of_cubes, count),
            dtype=np.float64,
        )


def footprint(grid: Grid, pieces: Strands, low: Array, high: Array) -> Footprint:
    """The cubes of every piece of a layer that are not full yet, from `low` to `high` (n,) mm above the path."""
    candidates = [_near(grid, pieces, rows, low, high) for rows in _chunks(grid, pieces, low, high)]
    cubes, piece_rows, up, aside, off = (
        np.concatenate(columns) for columns in zip(*candidates, strict=True)
    )
    # the nearest first, measured by the width; ties go to the earlier piece
    order = np.lexsort((piece_rows, off / pieces.width[piece_rows], cubes))
    cubes, piece_rows = cubes[order], piece_rows[order]
    up, aside, off = up[order], aside[order], off[order]
    alone, bridged = (
        np.clip((0.5 * wide * pieces.width[piece_rows] - off) / grid.edge + 0.5, 0.0, 1.0)
        for wide in (1.0, BRIDGED)
    )
    begins = np.flatnonzero(np.diff(cubes, prepend=-1))
    cube_row = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(cubes))))
    other_rows: Index = np.flatnonzero(
        pieces.are_separate(piece_rows[begins][cube_row], piece_rows)
    )
    other_rows = other_rows[
        np.sort(np.unique(cube_row[other_rows], return_index=True)[1])
    ]  # of each cube the nearest one of another bead
    cover, second, share = alone[begins], piece_rows[begins], np.ones(len(begins))
    mine = cube_row[other_rows]
    second[mine] = piece_rows[other_rows]
    # between beads; bridged where both are near
    bridged_cover = np.minimum(bridged[other_rows], bridged[begins][mine])
    cover[mine] = np.maximum(
        cover[mine] + alone[other_rows],
        np.where(alone[other_rows] < bridged_cover, 2.0 * bridged_cover, 0.0),
    )
    share[mine] = np.clip((off[other_rows] - off[begins][mine]) / (2.0 * grid.edge) + 0.5, 0.0, 1.0)
    return Footprint(
        cubes[begins],
        piece_rows[begins],
        second,
        share,
        up[begins],
        aside[begins],
        np.minimum(cover, 1.0),
    )


def _chunks(grid: Grid, pieces: Strands, low: Array, high: Array) -> Iterator[Index]:
    """Chunks of pieces; end pieces, which reach farther, are separate."""
    for rows in (np.flatnonzero(~pieces.ends), np.flatnonzero(pieces.ends)):
        if not len(rows):
            continue
        samples_per_piece = float(np.prod(_counts(grid, pieces, rows, low, high)))
        yield from np.array_split(rows, 1 + int(samples_per_piece * len(rows) / SAMPLES))


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
    """Cubes near some pieces: cube, piece, mm above the path, aside, and from the line of the piece, for each pair."""
    ahead, aside = _reach(grid, pieces, rows)
    counts = _counts(grid, pieces, rows, low, high)
    lattice = [np.linspace(-1.0, 1.0, count) for count in counts]
    axes = (
        ahead[:, None] * pieces.along[rows],
        aside[:, None] * pieces.side[rows],
        (0.5 * (high - low)[rows])[:, None] * (pieces.build[rows]),
    )
    middle = pieces.middle[rows] + (0.5 * (low + high)[rows])[:, None] * pieces.build[rows]
    cubes, corner, spans = [], [], []
    for axis in range(3):  # one after the other: sums of few numbers along each way first
        samples = middle[:, axis, None] + axes[0][:, axis, None] * lattice[0]
        samples = samples[:, :, None] + (axes[1][:, axis, None] * lattice[1])[:, None]
        samples = samples[:, :, :, None] + (axes[2][:, axis, None] * lattice[2])[:, None, None]
        cube = np.floor(samples.reshape(len(rows), -1) * (1.0 / grid.edge)).astype(np.int64)
        corner.append(cube.min(axis=1))
        cube -= corner[-1][:, None]
        spans.append(int(cube.max()) + 1)
        cubes.append(cube)
    # each cube once for each piece, marked in a box around the piece: quicker than sorting
    box = spans[0] * spans[1] * spans[2]
    ticked = np.zeros(len(rows) * box, dtype=np.bool_)
    ticked[
        (cubes[0] * spans[1] + cubes[1]) * spans[2] + cubes[2] + box * np.arange(len(rows))[:, None]
    ] = True
    row, number = np.divmod(np.flatnonzero(ticked), box)
    cube_rows = grid.indices_of(
        np.stack(np.unravel_index(number, tuple(spans)), axis=1) + np.stack(corner, axis=1)[row]
    )
    free = grid.filled[cube_rows] < FULL_SHARE
    cube_rows, piece_rows = cube_rows[free], rows[row[free]]
    offset = grid.centres(cube_rows) - pieces.middle[piece_rows]
    along, left_offset, up = (
        np.einsum("ij,ij->i", offset, column[piece_rows])
        for column in (pieces.along, pieces.side, pieces.build)
    )
    off = np.hypot(left_offset, np.maximum(np.abs(along) - 0.5 * pieces.length[piece_rows], 0.0))
    is_near: Mask = off < 0.5 * (BRIDGED * pieces.width[piece_rows] + grid.edge)
    return cube_rows[is_near], piece_rows[is_near], up[is_near], left_offset[is_near], off[is_near]
