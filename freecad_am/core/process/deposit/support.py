# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads over nothing: where neither earlier deposit nor anything that stands there carries a bead.

Below is against the build direction. A piece of a bead is carried where the ray from its middle meets something no more than
REACH layer heights below: earlier deposit as wide as it counts, or, of the first layer, ground; of others, whose own height
is between their path and what carries it, ground DOWN layer heights below. So a bead may overhang what is below by half of
its width. It is carried too where that holds of both its sides, as over a seam between two beads. What is carried at both
ends bridges a gap up to its own width.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import lengths
from ...issues import WARNING, Issue, Text
from ...toolpath import Toolpath
from ...types import Array, Index, Mask
from .pieces import Pieces, cut

Ground = Callable[[Array, Array, Mask], Mask]
Held = Callable[[Array, Index], Mask]  # places (n, 3) for pieces (n,): whether ground carries them

CODE = "UNSUPPORTED"
REACH = 1.5  # layer heights that what carries a bead may be below it
# layer heights that ground may be below beads of other layers than the first: beside slopes layers have steps of half of
# one; with a whole one a layer is missing there
DOWN = 0.75
LEVEL_WITH = 0.1  # layer heights; what is no farther below than this is beside
GRACE = 0.05  # of the width that counts; pieces have places, and chords are not arcs
PIECE = 0.25  # of the width: no piece of a bead is longer, but for the chord error, by which beads count as wider
SIDE = 0.25  # of the width, from the middle of a bead to those of its halves
BACK = 1.5  # how much longer than REACH the way back along a bead has to be, for it to lie on itself as a spiral does
MOST_NAMED = 10  # layers
FIRST_ASKED = 8  # pieces about the place below that are asked before all
PAIRS = 2_000_000  # of pieces looked at together; bounds the memory


def carried(
    toolpath: Toolpath, ground: Ground, first: bool, lowest: Mask, numbers: Index | None = None
) -> tuple[dict[int, float], list[Issue]]:
    """How much of the layers of a toolpath lies over nothing, mm of those with such beads, and an issue for each of these,
    the longest ten.

    ground(points (n, 3), build (n, 3), lowest (n,)): whether something other than deposit carries them, which of them are of
    the layers that are laid on ground, `lowest` (l,) of all. numbers: (k,) rising, of the layers asked about, all where left
    out. first: something carries all of the first of these. Time grows little faster than pieces, memory as they do.
    """
    pieces = cut(toolpath, PIECE)
    numbers = np.arange(len(toolpath.layers)) if numbers is None else numbers
    asked = np.flatnonzero(np.isin(pieces.layer, numbers[1:] if first else numbers))

    def held(points: Array, which: Index) -> Mask:
        return ground(points, pieces.build[which], lowest[pieces.layer[which]])

    open_ = _alone(pieces, toolpath, held, asked)
    open_ = _without_both(pieces, toolpath, held, open_)
    free = np.zeros(len(pieces), dtype=bool)
    free[open_] = True
    runs = list(_runs(pieces, free, toolpath))
    open_by_layer: dict[int, float] = {}
    for run in runs:
        open_by_layer[run.layer] = open_by_layer.get(run.layer, 0.0) + run.length
    return open_by_layer, _issues(runs, toolpath, lowest)


def _without_both(pieces: Pieces, toolpath: Toolpath, held: Held, some: Index) -> Index:
    """Those of some pieces that are not carried at both of their sides."""
    found = []
    for side in (SIDE, -SIDE):
        across = np.cross(pieces.build[some], pieces.travel[some])
        across *= (side * pieces.width[some] / np.maximum(lengths(across), 1e-300))[:, None]
        found.append(_alone(pieces, toolpath, held, some, across))
        some = np.setdiff1d(some, found[-1], assume_unique=True)
    return np.union1d(*found)


def _alone(
    pieces: Pieces, toolpath: Toolpath, held: Held, some: Index, aside: Array | None = None
) -> Index:
    """Those of some pieces that nothing carries, at their middles or `aside` (n, 3) mm of these."""
    height = toolpath.layer_height
    at = pieces.middle[some] if aside is None else pieces.middle[some] + aside
    left = np.arange(len(some))
    layer = pieces.layer[some]
    bounds = np.searchsorted(pieces.layer, np.arange(len(toolpath.layers) + 1))
    done = np.zeros(len(some), dtype=bool)
    # most lie on the layer before: the piece of it nearest to where it should be is asked first
    order = np.argsort(layer, kind="stable")
    ends = np.searchsorted(layer[order], np.arange(len(toolpath.layers) + 1))
    for number in range(1, len(toolpath.layers)):
        mine = order[ends[number] : ends[number + 1]]
        low, high = bounds[number - 1], bounds[number]
        if not len(mine) or low == high:
            continue
        tree = cKDTree(pieces.middle[low:high])
        nearest = np.asarray(tree.query(at[mine] - height * pieces.build[some[mine]])[1]) + low
        done[mine] = _below(pieces, some[mine], at[mine], nearest, toolpath)
    left = left[~done]
    left = left[~held(at[left], some[left])]
    if not len(left):
        return np.zeros(0, dtype=np.intp)
    tree = cKDTree(pieces.middle)
    near = np.asarray(
        tree.query(at[left] - height * pieces.build[some[left]], k=min(FIRST_ASKED, len(pieces)))[1]
    )
    for column in near.reshape(len(left), -1).T:  # a spiral lies on itself
        mine = some[left]
        done[
            left[
                _earlier(pieces, mine, column, toolpath)
                & _below(pieces, mine, at[left], column, toolpath)
            ]
        ] = True
    left = left[~done[left]]
    if not len(left):
        return np.zeros(0, dtype=np.intp)
    wide = 0.5 * float(pieces.width.max()) * (1.0 + 2.0 * GRACE)
    radius = math.hypot(wide, 0.5 * (REACH - LEVEL_WITH) * height) + toolpath.chord_error
    radius = max(radius, REACH * height * (1.0 + 1e-9)) if pieces.closing.any() else radius
    centre = at[left] - 0.5 * (REACH + LEVEL_WITH) * height * pieces.build[some[left]]
    centre[pieces.closing[some[left]]] = at[left][pieces.closing[some[left]]]
    carried = np.zeros(len(left), dtype=bool)
    for rows in _chunks(tree, centre, radius):
        found = tree.query_ball_point(centre[rows], radius, return_sorted=False)
        count = np.fromiter(map(len, found), dtype=np.intp, count=len(found))
        other = np.fromiter(
            (i for one in found for i in one), dtype=np.intp, count=int(count.sum())
        )
        which = np.repeat(rows, count)
        mine = some[left[which]]
        hit = _earlier(pieces, mine, other, toolpath) & _below(
            pieces, mine, at[left[which]], other, toolpath
        )
        carried[which[hit]] = True
    free: Index = some[left[~carried]]
    return free


def _chunks(tree: cKDTree, centre: Array, radius: float) -> Iterator[Index]:
    """Rows of centres in parts that have about PAIRS neighbours each."""
    sample = centre[:: max(1, len(centre) // 64)]
    dense = float(np.mean(tree.query_ball_point(sample, radius, return_length=True)))
    parts = min(len(centre), 1 + int(dense * len(centre) / PAIRS))
    yield from np.array_split(np.arange(len(centre)), parts)


def _earlier(pieces: Pieces, mine: Index, other: Index, toolpath: Toolpath) -> Mask:
    """Whether others were there before, and not as neighbours in the same layer; a bead may lie on itself, as spirals do."""
    back = BACK * np.hypot(0.5 * pieces.width[mine], REACH * toolpath.layer_height)
    same = pieces.bead[mine] == pieces.bead[other]
    before = np.where(
        same,
        pieces.along[mine] - pieces.along[other] > back,
        pieces.bead[other] < pieces.bead[mine],
    )
    apart = same | (pieces.layer[mine] != pieces.layer[other]) | pieces.closing[mine]
    found: Mask = before & apart
    return found


def _below(pieces: Pieces, mine: Index, at: Array, other: Index, toolpath: Toolpath) -> Mask:
    """Whether others lie below places (n, 3) of pieces; beads that close gaps lie on what is near, on whichever side."""
    gap = at - pieces.middle[other]
    build = pieces.build[mine]
    square = np.einsum("ij,ij->i", gap, gap)
    deep = np.einsum("ij,ij->i", gap, build)
    aside = np.sqrt(np.maximum(square - deep * deep, 0.0))
    height = toolpath.layer_height
    far = REACH * height * (1.0 + 1e-6) + toolpath.chord_error
    held = 0.5 * pieces.width[other] * (1.0 + 2.0 * GRACE) + toolpath.chord_error
    under = (deep >= LEVEL_WITH * height) & (deep <= far) & (aside <= held)
    found: Mask = under | (pieces.closing[mine] & (square <= far * far))
    return found


@dataclass(frozen=True)
class _Run:
    """Pieces in a row that nothing carries: where they begin, and their length, mm."""

    layer: int
    bead: int
    point: int
    length: float


def _runs(pieces: Pieces, free: Mask, toolpath: Toolpath) -> Iterator[_Run]:
    """What of beads lies over nothing in a row, without gaps that are bridged and ends that stand out by half a width."""
    marked = np.unique(pieces.bead[free])
    low, high = (
        np.searchsorted(pieces.bead, marked),
        np.searchsorted(pieces.bead, marked, side="right"),
    )
    beads = [(number, bead) for _, number, bead in toolpath]
    for k, a, b in zip(marked.tolist(), low.tolist(), high.tolist()):
        number, bead = beads[k]
        own, count = free[a:b], b - a
        length, wide = pieces.length[a:b], float(pieces.width[a:b].mean())
        turn = int(np.flatnonzero(~own)[0]) if bead.closed and not own.all() else 0
        order = np.r_[turn:count, :turn]
        change = np.diff(np.r_[False, own[order], False].astype(np.int8))
        for start, end in zip(
            np.flatnonzero(change > 0).tolist(), np.flatnonzero(change < 0).tolist()
        ):
            total = float(length[order[start:end]].sum())
            at_end = not bead.closed and (start == 0 or end == count)
            if own.all() or total > (0.5 if at_end else 1.0) * wide:
                first = a + int(order[start])
                yield _Run(int(pieces.layer[first]), number, int(pieces.point[first]), total)


def _issues(runs: list[_Run], toolpath: Toolpath, lowest: Mask) -> list[Issue]:
    layers: dict[int, list[_Run]] = {}
    for run in runs:
        layers.setdefault(run.layer, []).append(run)
    total = {layer: math.fsum(run.length for run in some) for layer, some in layers.items()}
    worst = sorted(sorted(total, key=lambda layer: (-total[layer], layer))[:MOST_NAMED])
    found = []
    for layer in worst:
        longest = max(layers[layer], key=lambda run: run.length)
        reach = (REACH if lowest[layer] else DOWN) * toolpath.layer_height
        found.append(
            Issue(
                WARNING,
                CODE,
                Text(
                    "{:.4g} mm of beads lie over nothing, {:.4g} mm of them in a row from here: what is below "
                    "is more than {:.4g} mm away, or they overhang it by more than half of their width; deposit what carries "
                    "them first, let the part grow from another side, or leave them out",
                    total[layer],
                    longest.length,
                    reach,
                ),
                layer,
                longest.bead,
                longest.point,
            )
        )
    if len(total) > len(worst):
        rest = math.fsum(length for layer, length in total.items() if layer not in worst)
        found.append(
            Issue(
                WARNING,
                CODE,
                Text(
                    "{} layers more have beads over nothing, {:.5g} mm of them",
                    len(total) - len(worst),
                    rest,
                ),
            )
        )
    return found
