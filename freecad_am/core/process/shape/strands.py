# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads divided into short straight pieces with their fed volume."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.columns import dots, lengths, unit_rows
from ...parameters.process import ProcessParameters
from ...toolpath import Bead, Toolpath, settings_of
from ...types import Array, Index, Mask
from ..deposit.pieces import cut_beads, join_pieces
from ..deposit.spacing import is_spiral, turns_of

SIDE = 8  # cubes along the edge of a block
CUBES = SIDE**3
_MIDDLE = 1 << 20  # maximum number of blocks along an axis on either side of the origin


class Grid:
    """Sparse grid of cubes with a given edge, mm; the origin is a corner of a cube.

    filled: (blocks * CUBES,) filled fractions of the cubes. The indices, from `indices_of`, never change.
    """

    def __init__(self, edge: float) -> None:
        self.edge = edge
        self.filled = np.zeros(0)
        self._keys = np.zeros(0, dtype=np.int64)  # sorted block keys
        self._slots = np.zeros(0, dtype=np.int64)  # slot of each block
        self._corners = np.zeros((0, 3), dtype=np.int64)  # first cube of each block, by slot

    def indices_of(self, cubes: Index, make: bool = True) -> Index:
        """Return the indices (n,) of cubes at integer coordinates (n, 3).

        A missing block is created if `make` is true, else its index is -1.
        """
        block = cubes >> 3
        within = cubes - (block << 3)
        key = (
            ((block[:, 0] + _MIDDLE) << 42)
            | ((block[:, 1] + _MIDDLE) << 21)
            | (block[:, 2] + _MIDDLE)
        )
        if make:
            self._make(key, block)
        if not len(self._keys):
            return np.full(len(cubes), -1, dtype=np.intp)
        slot_row = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        index = (
            self._slots[slot_row] * CUBES
            + (within[:, 0] * SIDE + within[:, 1]) * SIDE
            + within[:, 2]
        )
        indices: Index = index if make else np.where(self._keys[slot_row] == key, index, -1)
        return indices

    def _make(self, key: Index, block: Index) -> None:
        unique_keys, block_row = np.unique(key, return_index=True)
        new = ~np.isin(unique_keys, self._keys, assume_unique=True)
        if not new.any():
            return
        count = len(self._keys)
        self._corners = np.concatenate([self._corners, block[block_row[new]] << 3])
        self._slots = np.concatenate([self._slots, count + np.arange(int(new.sum()))])
        keys = np.concatenate([self._keys, unique_keys[new]])
        order = np.argsort(keys)
        self._keys, self._slots = keys[order], self._slots[order]
        self.filled = np.concatenate([self.filled, np.zeros(CUBES * int(new.sum()))])

    def centres(self, indices: Index) -> Array:
        """Return the centres of cubes.

        Parameters
        ----------
        indices : (n,) int array
            Indices of the cubes.

        Returns
        -------
        (n, 3) array
            Centres, mm.
        """
        slot, within = np.divmod(indices, CUBES)
        local = np.stack([within // (SIDE * SIDE), within // SIDE % SIDE, within % SIDE], axis=1)
        centres_: Array = (self._corners[slot] + local + 0.5) * self.edge
        return centres_

    def fill_at(self, points: Array) -> Array:
        """Return the filled fraction of the grid at points.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.

        Returns
        -------
        (n,) array
            Fractions, interpolated between the centres of cubes.
        """
        along = points / self.edge - 0.5
        low = np.floor(along).astype(np.int64)
        share = along - low
        total = np.zeros(len(points))
        for corner in np.ndindex(2, 2, 2):
            index = self.indices_of(low + np.array(corner), make=False)
            weight = np.where(corner, share, 1.0 - share).prod(axis=1)
            total += weight * np.where(index >= 0, self.filled[index], 0.0)
        return total

    @property
    def volume(self) -> float:
        """Filled volume, mm3."""
        return float(self.filled.sum()) * self.edge**3


PIECE = 0.25  # bead widths; length of a piece
BEND = 0.25  # bead widths; maximum gap on the outer side between two consecutive pieces without a corner


@dataclass(frozen=True, eq=False)
class Strands:
    """Pieces (n) in print order.

    middle: (n, 3) midpoint on the path, mm. along, side, build: (n, 3) orthogonal unit vectors: travel direction, left
    of travel, build direction. length, width: mm. volume: fed volume, mm3. height: layer height, mm. arc: arc length
    from the bead's start to the midpoint, mm. around: length of a closed bead, mm, else infinite. ends: whether the bead
    ends or has a corner at the piece. layer, bead (counted over the toolpath), point: (n,) indices. is_first: whether
    the layer has no layer of its feature below. real: whether the width is from a bead model.
    """

    middle: Array
    along: Array
    side: Array
    build: Array
    length: Array
    width: Array
    volume: Array
    height: Array
    arc: Array
    around: Array
    ends: Mask
    layer: Index
    bead: Index
    point: Index
    is_first: Mask
    real: Mask

    def __len__(self) -> int:
        return len(self.middle)

    def rows(self, selection: slice | Index) -> Strands:
        """Return the selected pieces."""
        return Strands(*(column[selection] for column in vars(self).values()))

    def are_separate(self, i: Index, j: Index) -> Mask:
        """Return which pairs belong to two beads, or to one bead that returns to itself."""
        arc = np.abs(self.arc[i] - self.arc[j])
        arc = np.minimum(arc, self.around[i] - arc)
        result: Mask = (self.bead[i] != self.bead[j]) | (arc > 1.5 * self.width[i])
        return result


def join_strands(parts: Sequence[Strands]) -> Strands:
    """Join the strands of several features; beads and layers count from 0 in each feature."""
    return Strands(
        *(
            np.concatenate(columns)
            for columns in zip(*(vars(part).values() for part in parts), strict=True)
        )
    )


def sections(bead: Bead, toolpath: Toolpath, process: ProcessParameters) -> Array:
    """Return the cross-section fed along a bead.

    Parameters
    ----------
    bead : Bead
        The bead of n points.
    toolpath : Toolpath
        Toolpath of the bead, with wire feed and bead size.
    process : ProcessParameters
        Wire and schedules.

    Returns
    -------
    (n - 1,) array
        Volume per length of each segment, mm3/mm. This is width times height without a wire, or
        with a schedule of the class, whose feed is unknown here.
    """
    combinations, index = np.unique(settings_of(bead)[1:].astype(int), return_inverse=True)
    schedules = [
        process.at_place(bead.role.bead_class, active).schedule for active in combinations.tolist()
    ]
    by_wire = np.array([schedule == process.schedule for schedule in schedules])[np.ravel(index)]
    if bead.wire_share is not None:
        fed = np.full(len(bead) - 1, process.wire.section * bead.wire_share)
    elif toolpath.wire_feed:
        fed = process.wire.section * toolpath.wire_feed / bead.speed[1:]
    else:
        by_wire = np.zeros(len(bead) - 1, dtype=bool)
        fed = np.zeros(len(bead) - 1)
    if by_wire.all():
        return np.asarray(fed)
    wide = np.full(len(bead), toolpath.bead_width or 0.0) if bead.width is None else bead.width
    tall = np.full(len(bead), toolpath.layer_height) if bead.height is None else bead.height
    unwrapped = wide * tall
    return np.where(by_wire, fed, 0.5 * (unwrapped[1:] + unwrapped[:-1]))


def strands(toolpath: Toolpath, process: ProcessParameters) -> Strands:
    """Divide all beads of a feature into pieces. Raises ValueError if the bead width is unknown."""
    pieces = join_pieces(cut_beads(toolpath, PIECE), PIECE)
    beads = list(toolpath)
    bead, build = pieces.bead, pieces.build
    arc = np.cumsum(pieces.length)
    starts = np.flatnonzero(np.diff(bead, prepend=-1))
    arc -= (
        np.repeat((arc - pieces.length)[starts], np.diff(np.append(starts, len(bead))))
        + 0.5 * pieces.length
    )
    side = unit_rows(np.cross(build, pieces.travel))
    closed = np.array([bead_.closed for _, _, bead_ in beads])
    bead_lengths = np.array([bead_.length for _, _, bead_ in beads])
    layers = toolpath.layers
    is_first = np.array([number == 0 or layer.first for number, layer in enumerate(layers)])
    on_ground = is_first[pieces.layer]
    if is_spiral(toolpath):  # a spiral supports itself from the second turn on
        on_ground &= turns_of(layers[0].beads[0])[pieces.point] == 0
    return Strands(
        pieces.middle,
        np.cross(side, build),
        side,
        build,
        pieces.length,
        pieces.width,
        _volumes(toolpath, process, bead, arc, pieces.length),
        np.full(len(bead), toolpath.layer_height),
        arc,
        np.where(closed, bead_lengths, np.inf)[bead],
        _ends(pieces.travel, bead, closed),
        pieces.layer,
        bead,
        pieces.point,
        on_ground,
        np.full(len(bead), toolpath.law is not None),
    )


def _volumes(
    toolpath: Toolpath, process: ProcessParameters, bead_row: Index, arc: Array, length: Array
) -> Array:
    """Return the volume fed between start and end of each piece, (n,) mm3; `bead_row` are the pieces' beads."""
    beads = [bead for _, _, bead in toolpath]
    steps = [lengths(np.diff(bead.points, axis=0)) for bead in beads]
    fed = [
        step * sections(bead, toolpath, process) for step, bead in zip(steps, beads, strict=True)
    ]
    # join all beads, so that one interpolation gives the volume fed up to any position
    path_length = np.concatenate([[0.0], np.cumsum(np.concatenate(steps))])
    total = np.concatenate([[0.0], np.cumsum(np.concatenate(fed))])
    offset = np.concatenate([[0.0], np.cumsum([step.sum() for step in steps])])[bead_row]
    ends = np.interp(offset + arc + 0.5 * length, path_length, total)
    volumes: Array = ends - np.interp(offset + arc - 0.5 * length, path_length, total)
    return volumes


def _ends(travel: Array, bead: Index, closed: Mask) -> Mask:
    """Return which pieces begin or end a bead, or are adjacent to a corner."""
    turn = (
        np.sqrt(np.maximum(2.0 - 2.0 * dots(travel[:-1], travel[1:]), 0.0))
        if len(travel) > 1
        else np.zeros(0)
    )
    same = bead[:-1] == bead[1:]
    corner = same & (turn > BEND)
    starts, is_end = np.append(True, ~same), np.append(~same, True)
    result: Mask = (
        ((starts | is_end) & ~closed[bead]) | np.append(False, corner) | np.append(corner, False)
    )
    seam = np.flatnonzero(starts)
    result[seam] |= closed[bead[seam]]  # a closed bead may have a corner at its seam
    return result
