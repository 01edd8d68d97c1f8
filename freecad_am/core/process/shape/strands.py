# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads as short straight pieces that know how much is fed while they are laid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.columns import dots, lengths, unit_rows
from ...parameters.process import ProcessParameters
from ...toolpath import Bead, Toolpath
from ...types import Array, Index, Mask
from ..deposit.pieces import cut, joined
from ..deposit.spacing import is_spiral, turns_of

PIECE = 0.25  # of a bead's width
BEND = 0.25  # of a bead's width that its outer side gapes at most between two pieces that run into each other


@dataclass(frozen=True, eq=False)
class Strands:
    """n pieces in the order of deposit. middle: (n, 3) mm on the path. along, side, build: (n, 3) unit vectors, square to
    each other: the way of travel, to its left, and where the bead grows. length, width: mm. volume: mm3 that is fed there.
    height: mm of the layer. at: mm from the start of the bead to the middle; around: mm of the whole of it where it is
    closed, else infinite. ends: where nothing of the bead goes straight on. layer, bead (of all), point: (n,). first: of
    layers that nothing of their feature lies below. real: whether the width is that of a bead model, not what it counts."""

    middle: Array
    along: Array
    side: Array
    build: Array
    length: Array
    width: Array
    volume: Array
    height: Array
    at: Array
    around: Array
    ends: Mask
    layer: Index
    bead: Index
    point: Index
    first: Mask
    real: Mask

    def __len__(self) -> int:
        return len(self.middle)

    def rows(self, some: slice | Index) -> Strands:
        """Some of them."""
        return Strands(*(column[some] for column in vars(self).values()))

    def apart(self, one: Index, other: Index) -> Mask:
        """Which pairs are of two beads, or of one that comes beside itself."""
        arc = np.abs(self.at[one] - self.at[other])
        arc = np.minimum(arc, self.around[one] - arc)
        found: Mask = (self.bead[one] != self.bead[other]) | (arc > 1.5 * self.width[one])
        return found


def together(some: Sequence[Strands]) -> Strands:
    """Those of several features as one; their beads and layers count from 0 in each."""
    return Strands(
        *(
            np.concatenate(columns)
            for columns in zip(*(vars(one).values() for one in some), strict=True)
        )
    )


def sections(bead: Bead, toolpath: Toolpath, process: ProcessParameters) -> Array:
    """mm2 (n - 1,) that the wire feeds for each mm of the segments of a bead; where there is no wire, or a schedule of their
    own feeds it, which nobody knows here, what the segments count."""
    own = process.for_class(bead.bead_class).schedule
    if own == process.schedule and bead.wire_share is not None:
        return np.full(len(bead) - 1, process.wire.section * bead.wire_share)
    if own == process.schedule and toolpath.wire_feed:
        fed: Array = process.wire.section * toolpath.wire_feed / bead.speed[1:]
        return fed
    wide = np.full(len(bead), toolpath.bead_width or 0.0) if bead.width is None else bead.width
    tall = np.full(len(bead), toolpath.layer_height) if bead.height is None else bead.height
    unwrapped = wide * tall
    middle: Array = 0.5 * (unwrapped[1:] + unwrapped[:-1])
    return middle


def strands(toolpath: Toolpath, process: ProcessParameters) -> Strands:
    """All beads of one feature. ValueError where it is not known how wide they count."""
    pieces = joined(cut(toolpath, PIECE), PIECE)
    beads = list(toolpath)
    bead, build = pieces.bead, pieces.build
    at = np.cumsum(pieces.length)
    starts = np.flatnonzero(np.diff(bead, prepend=-1))
    at -= (
        np.repeat((at - pieces.length)[starts], np.diff(np.append(starts, len(bead))))
        + 0.5 * pieces.length
    )
    side = unit_rows(np.cross(build, pieces.travel))
    closed = np.array([one.closed for _, _, one in beads])
    whole = np.array([one.length for _, _, one in beads])
    layers = toolpath.layers
    first = np.array([number == 0 or layer.first for number, layer in enumerate(layers)])
    on_ground = first[pieces.layer]
    if is_spiral(toolpath):  # which lies on itself from its second turn on
        on_ground &= turns_of(layers[0].beads[0])[pieces.point] == 0
    return Strands(
        pieces.middle,
        np.cross(side, build),
        side,
        build,
        pieces.length,
        pieces.width,
        _volumes(toolpath, process, bead, at, pieces.length),
        np.full(len(bead), toolpath.layer_height),
        at,
        np.where(closed, whole, np.inf)[bead],
        _ends(pieces.travel, bead, closed),
        pieces.layer,
        bead,
        pieces.point,
        on_ground,
        np.array([one.width is not None for _, _, one in beads])[bead],
    )


def _volumes(
    toolpath: Toolpath, process: ProcessParameters, of: Index, at: Array, length: Array
) -> Array:
    """mm3 of pieces (n,) of the beads `of`: what is fed from where each of them starts to where it ends."""
    beads = [bead for _, _, bead in toolpath]
    steps = [lengths(np.diff(bead.points, axis=0)) for bead in beads]
    fed = [
        step * sections(bead, toolpath, process) for step, bead in zip(steps, beads, strict=True)
    ]
    # all beads one after the other, so that one look tells what was fed up to any place of any of them
    way = np.concatenate([[0.0], np.cumsum(np.concatenate(steps))])
    total = np.concatenate([[0.0], np.cumsum(np.concatenate(fed))])
    before = np.concatenate([[0.0], np.cumsum([step.sum() for step in steps])])[of]
    ends = np.interp(before + at + 0.5 * length, way, total)
    found: Array = ends - np.interp(before + at - 0.5 * length, way, total)
    return found


def _ends(travel: Array, bead: Index, closed: Mask) -> Mask:
    """Which pieces begin or end a bead, or meet their neighbour at a corner, outside of which nothing else fills it."""
    turn = (
        np.sqrt(np.maximum(2.0 - 2.0 * dots(travel[:-1], travel[1:]), 0.0))
        if len(travel) > 1
        else np.zeros(0)
    )
    same = bead[:-1] == bead[1:]
    corner = same & (turn > BEND)
    starts, last = np.append(True, ~same), np.append(~same, True)
    found: Mask = (
        ((starts | last) & ~closed[bead]) | np.append(False, corner) | np.append(corner, False)
    )
    seam = np.flatnonzero(starts)
    found[seam] |= closed[bead[seam]]  # whose beginning and end may meet at a corner
    return found
