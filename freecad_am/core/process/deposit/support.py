# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unsupported beads: beads with neither earlier deposit nor ground below.

Below means against the build direction. A piece of a bead is supported if the ray from its midpoint meets earlier
deposit, at its effective width, or, in the first layer, the ground at most REACH layer heights below. In later layers the
ground may be at most DOWN layer heights below. A bead may thus overhang by half its width. A piece is also supported if
both sides are supported, as over a seam between two beads. A bead supported at both ends bridges a gap of up to its
width.
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
from .pieces import Pieces, cut_beads

Ground = Callable[[Array, Array, Mask], Mask]
Held = Callable[
    [Array, Index], Mask
]  # (points (n, 3), pieces (n,)) -> whether the ground supports them

CODE = "UNSUPPORTED"
REACH = 1.5  # layer heights; maximum depth of the support below a bead
# layer heights; maximum depth of the ground below beads of later layers. Along slopes layers have
# steps of half a layer height; a step of a whole layer height means that a layer is missing
DOWN = 0.75
LEVEL_WITH = 0.1  # layer heights; deposit at most this far below is adjacent, not below
GRACE = 0.05  # fraction of the effective width; tolerance for sampling and chords
PIECE = 0.25  # fraction of the width; maximum length of a piece of a bead
SIDE = 0.25  # fraction of the width; distance from the centreline to the centre of each half
BACK = 1.5  # times the distance to a possible support; minimum arc length after which a bead supports itself
MOST_NAMED = 10  # maximum number of layers with an issue
FIRST_ASKED = 8  # number of nearest pieces checked before all pieces
PAIRS = 2_000_000  # pairs of pieces checked in one batch; bounds the memory


def find_unsupported(
    toolpath: Toolpath,
    ground: Ground,
    is_first_carried: bool,
    lowest: Mask,
    numbers: Index | None = None,
) -> tuple[dict[int, float], list[Issue]]:
    """Return the unsupported length of the layers of a toolpath.

    Time grows slightly faster than the number of pieces, memory in proportion to it.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    ground : Ground
        Returns whether anything other than deposit supports points (n, 3) with build
        directions (n, 3). The last argument (n,) marks points in layers on the ground.
    is_first_carried : bool
        Whether the whole first layer of `numbers` is supported.
    lowest : (layers,) bool array
        Layers deposited on the ground.
    numbers : (k,) int array or None, optional
        Layers to check, ascending; None for all layers.

    Returns
    -------
    lengths : dict of int to float
        Unsupported length by layer, mm.
    issues : list of Issue
        Issues for the ten longest runs.
    """
    pieces = cut_beads(toolpath, PIECE)
    numbers = np.arange(len(toolpath.layers)) if numbers is None else numbers
    rows = np.flatnonzero(np.isin(pieces.layer, numbers[1:] if is_first_carried else numbers))

    def is_on_ground(points: Array, rows_: Index) -> Mask:
        return ground(points, pieces.build[rows_], lowest[pieces.layer[rows_]])

    open_ = _unsupported(pieces, toolpath, is_on_ground, rows)
    open_ = _unsupported_at_a_side(pieces, toolpath, is_on_ground, open_)
    free = np.zeros(len(pieces), dtype=bool)
    free[open_] = True
    runs = list(_runs(pieces, free, toolpath))
    open_by_layer: dict[int, float] = {}
    for run in runs:
        open_by_layer[run.layer] = open_by_layer.get(run.layer, 0.0) + run.length
    return open_by_layer, _issues(runs, toolpath, lowest)


def _unsupported_at_a_side(
    pieces: Pieces, toolpath: Toolpath, is_on_ground: Held, rows: Index
) -> Index:
    """Return the pieces of `rows` that are not supported on both sides."""
    open_sides = []
    for side in (SIDE, -SIDE):
        across = np.cross(pieces.build[rows], pieces.travel[rows])
        across *= (side * pieces.width[rows] / np.maximum(lengths(across), 1e-300))[:, None]
        open_sides.append(_unsupported(pieces, toolpath, is_on_ground, rows, across))
        rows = np.setdiff1d(rows, open_sides[-1], assume_unique=True)
    return np.union1d(*open_sides)


def _unsupported(
    pieces: Pieces, toolpath: Toolpath, is_on_ground: Held, some: Index, aside: Array | None = None
) -> Index:
    """Return the unsupported pieces of `some`, at the midpoints or offset by `aside` (n, 3), mm."""
    height = toolpath.layer_height
    position = pieces.middle[some] if aside is None else pieces.middle[some] + aside
    open_ = np.arange(len(some))
    layer = pieces.layer[some]
    bounds = np.searchsorted(pieces.layer, np.arange(len(toolpath.layers) + 1))
    is_supported = np.zeros(len(some), dtype=bool)
    # the previous layer supports most pieces, so its nearest piece is tried first
    order = np.argsort(layer, kind="stable")
    ends = np.searchsorted(layer[order], np.arange(len(toolpath.layers) + 1))
    for number in range(1, len(toolpath.layers)):
        selection = order[ends[number] : ends[number + 1]]
        low, high = bounds[number - 1], bounds[number]
        if not len(selection) or low == high:
            continue
        tree = cKDTree(pieces.middle[low:high])
        nearest = (
            np.asarray(tree.query(position[selection] - height * pieces.build[some[selection]])[1])
            + low
        )
        is_supported[selection] = _below(
            pieces, some[selection], position[selection], nearest, toolpath
        )
    open_ = open_[~is_supported]
    open_ = open_[~is_on_ground(position[open_], some[open_])]
    if not len(open_):
        return np.zeros(0, dtype=np.intp)
    tree = cKDTree(pieces.middle)
    near = np.asarray(
        tree.query(
            position[open_] - height * pieces.build[some[open_]], k=min(FIRST_ASKED, len(pieces))
        )[1]
    )
    for column in near.reshape(len(open_), -1).T:  # a spiral supports itself
        selection = some[open_]
        is_supported[
            open_[
                _earlier(pieces, selection, column, toolpath)
                & _below(pieces, selection, position[open_], column, toolpath)
            ]
        ] = True
    open_ = open_[~is_supported[open_]]
    if not len(open_):
        return np.zeros(0, dtype=np.intp)
    wide = 0.5 * float(pieces.width.max()) * (1.0 + 2.0 * GRACE)
    radius = math.hypot(wide, 0.5 * (REACH - LEVEL_WITH) * height) + toolpath.chord_error
    radius = max(radius, REACH * height * (1.0 + 1e-9)) if pieces.closing.any() else radius
    centre = position[open_] - 0.5 * (REACH + LEVEL_WITH) * height * pieces.build[some[open_]]
    centre[pieces.closing[some[open_]]] = position[open_][pieces.closing[some[open_]]]
    carried = np.zeros(len(open_), dtype=bool)
    for rows in _chunks(tree, centre, radius):
        neighbours = tree.query_ball_point(centre[rows], radius, return_sorted=False)
        count = np.fromiter(map(len, neighbours), dtype=np.intp, count=len(neighbours))
        other_piece = np.fromiter(
            (i for row in neighbours for i in row), dtype=np.intp, count=int(count.sum())
        )
        open_row = np.repeat(rows, count)
        selection = some[open_[open_row]]
        hit = _earlier(pieces, selection, other_piece, toolpath) & _below(
            pieces, selection, position[open_[open_row]], other_piece, toolpath
        )
        carried[open_row[hit]] = True
    free: Index = some[open_[~carried]]
    return free


def _chunks(tree: cKDTree, centre: Array, radius: float) -> Iterator[Index]:
    """Yield chunks of the rows of centres with about PAIRS pairs each."""
    sample = centre[:: max(1, len(centre) // 64)]
    dense = float(np.mean(tree.query_ball_point(sample, radius, return_length=True)))
    count = min(len(centre), 1 + int(dense * len(centre) / PAIRS))
    yield from np.array_split(np.arange(len(centre)), count)


def _earlier(pieces: Pieces, rows: Index, other_rows: Index, toolpath: Toolpath) -> Mask:
    """Whether other pieces are earlier and not in an adjacent bead of the layer; a spiral may support itself."""
    back = BACK * np.hypot(0.5 * pieces.width[rows], REACH * toolpath.layer_height)
    same = pieces.bead[rows] == pieces.bead[other_rows]
    is_earlier = np.where(
        same,
        pieces.along[rows] - pieces.along[other_rows] > back,
        pieces.bead[other_rows] < pieces.bead[rows],
    )
    is_separate = same | (pieces.layer[rows] != pieces.layer[other_rows]) | pieces.closing[rows]
    result: Mask = is_earlier & is_separate
    return result


def _below(
    pieces: Pieces, rows: Index, points: Array, other_rows: Index, toolpath: Toolpath
) -> Mask:
    """Whether other pieces are below points (n, 3) of pieces; for closing beads, near them on any side."""
    gap = points - pieces.middle[other_rows]
    build = pieces.build[rows]
    square = np.einsum("ij,ij->i", gap, gap)
    deep = np.einsum("ij,ij->i", gap, build)
    aside = np.sqrt(np.maximum(square - deep * deep, 0.0))
    height = toolpath.layer_height
    max_depth = REACH * height * (1.0 + 1e-6) + toolpath.chord_error
    max_aside = 0.5 * pieces.width[other_rows] * (1.0 + 2.0 * GRACE) + toolpath.chord_error
    under = (deep >= LEVEL_WITH * height) & (deep <= max_depth) & (aside <= max_aside)
    result: Mask = under | (pieces.closing[rows] & (square <= max_depth * max_depth))
    return result


@dataclass(frozen=True)
class _Run:
    """A run of consecutive unsupported pieces: start and length, mm."""

    layer: int
    bead: int
    point: int
    length: float


def _runs(pieces: Pieces, free: Mask, toolpath: Toolpath) -> Iterator[_Run]:
    """Yield the unsupported runs, except bridged gaps and ends that overhang by at most half a width."""
    marked = np.unique(pieces.bead[free])
    low = np.searchsorted(pieces.bead, marked)
    high = np.searchsorted(pieces.bead, marked, side="right")
    beads = [(number, bead) for _, number, bead in toolpath]
    for k, a, b in zip(marked.tolist(), low.tolist(), high.tolist()):
        number, bead = beads[k]
        is_open, count = free[a:b], b - a
        length, wide = pieces.length[a:b], float(pieces.width[a:b].mean())
        turn = int(np.flatnonzero(~is_open)[0]) if bead.closed and not is_open.all() else 0
        order = np.r_[turn:count, :turn]
        change = np.diff(np.r_[False, is_open[order], False].astype(np.int8))
        for start, end in zip(
            np.flatnonzero(change > 0).tolist(), np.flatnonzero(change < 0).tolist()
        ):
            total = float(length[order[start:end]].sum())
            at_end = not bead.closed and (start == 0 or end == count)
            if is_open.all() or total > (0.5 if at_end else 1.0) * wide:
                start_piece = a + int(order[start])
                yield _Run(
                    int(pieces.layer[start_piece]), number, int(pieces.point[start_piece]), total
                )


def _issues(runs: list[_Run], toolpath: Toolpath, lowest: Mask) -> list[Issue]:
    layers: dict[int, list[_Run]] = {}
    for run in runs:
        layers.setdefault(run.layer, []).append(run)
    total = {
        layer: math.fsum(run.length for run in layer_runs) for layer, layer_runs in layers.items()
    }
    worst = sorted(sorted(total, key=lambda layer: (-total[layer], layer))[:MOST_NAMED])
    issues_ = []
    for layer in worst:
        longest = max(layers[layer], key=lambda run: run.length)
        reach = (REACH if lowest[layer] else DOWN) * toolpath.layer_height
        issues_.append(
            Issue(
                WARNING,
                CODE,
                Text(
                    "{:.4g} mm of bead are unsupported, and the longest run, from here, is "
                    "{:.4g} mm: the surface below is more than {:.4g} mm away, or beads overhang "
                    "by more than half their width; deposit the support first, change the growth "
                    "direction, or remove these beads",
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
        remaining = math.fsum(length for layer, length in total.items() if layer not in worst)
        issues_.append(
            Issue(
                WARNING,
                CODE,
                Text(
                    "{} more layers have unsupported beads, {:.5g} mm in total",
                    len(total) - len(worst),
                    remaining,
                ),
            )
        )
    return issues_
