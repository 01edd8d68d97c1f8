# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layer-by-layer prediction of the deposit: fed material fills the space below the surface of its bead.

The cross-section of an isolated bead is a parabola. The bead width and the fed volume determine its height. Over existing
deposit, the surface rises until the volume below it equals the fed volume. Over a bead of the same width, it rises by the
layer height, and the sides of the wall are straight.

A bead ends halfway to an adjacent bead and rises by the volume that it would have deposited there, so that the area is
kept. Up to a spacing of 0.738 widths the surface between two beads is flat; beyond, it has a valley (Ding, Pan, Cuiuri, Li
2015, tangent overlapping model). Beads that count as wide as their spacing are assumed to have this spacing. As a melt
levels, fed material spreads over a bead width along and across the bead before its height is determined.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from ...geometry.columns import dots
from ...issues import Text
from ...parameters.process import ProcessParameters
from ...toolpath import Toolpath
from ...types import Array, Index, Mask
from ..deposit.spacing import is_spiral, turns_of
from .strands import Grid, Strands, join_strands, strands

STEP = 1.0 / np.sqrt(
    3.0
)  # cube edges; a lattice of this step has a point in every cube, in any orientation
SAMPLES = 1_500_000  # number of lattice points processed at once; bounds the memory
FULL_SHARE = 1.0 - 1e-9
BRIDGED = 1.25  # bead widths; a melt closes the gap between beads that would touch at this width


@dataclass(frozen=True, eq=False)
class Footprint:
    """Cubes (k) of a layer, with the pieces that fill them.

    cubes: (k,) indices in the grid. piece_rows: (k,) nearest piece. other_piece: (k,) nearest piece of an adjacent bead,
    or the nearest piece if there is none. share: (k,) fraction of the cube on the nearest piece's side of the border
    between the two. up: (k,) height of the cube's centre above the path, along the piece's build direction, mm. aside:
    (k,) distance from the bead's centreline, positive to the left, mm. cover: (k,) fraction of the cube within the bead
    widths. pieces: (n, k) fraction of each cube that belongs to each piece. Along a bead it is split between the two
    nearest pieces, to avoid a beat between cubes and pieces of similar length.
    """

    cubes: Index
    piece_rows: Index
    other_piece: Index
    share: Array
    up: Array
    aside: Array
    cover: Array
    pieces: csr_matrix

    def mixed(self, of_pieces: Array) -> Array:
        """Interpolate values of pieces at cubes.

        Parameters
        ----------
        of_pieces : (n,) array
            Values of the pieces.

        Returns
        -------
        (k,) array
            Values at the cubes.
        """
        return np.asarray(
            self.share * of_pieces[self.piece_rows]
            + (1.0 - self.share) * of_pieces[self.other_piece],
            dtype=np.float64,
        )


def footprint(grid: Grid, pieces: Strands, low: Array, high: Array) -> Footprint:
    """Return the cubes of the pieces of a layer that are not full yet.

    Parameters
    ----------
    grid : Grid
        The grid.
    pieces : Strands
        The n pieces of the layer.
    low, high : (n,) array
        Range above the path, mm.

    Returns
    -------
    Footprint
        The cubes with their pieces.
    """
    candidates = [_near(grid, pieces, rows, low, high) for rows in _chunks(grid, pieces, low, high)]
    cubes, piece_rows, up, aside, along, off = (
        np.concatenate(columns) for columns in zip(*candidates, strict=True)
    )
    # nearest piece first, relative to the width; ties go to the earlier piece
    order = np.lexsort((piece_rows, off / pieces.width[piece_rows], cubes))
    cubes, piece_rows = cubes[order], piece_rows[order]
    up, aside, along, off = up[order], aside[order], along[order], off[order]
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
    ]  # nearest piece of another bead for each cube
    cover, second, share = alone[begins], piece_rows[begins], np.ones(len(begins))
    mine = cube_row[other_rows]
    second[mine] = piece_rows[other_rows]
    # gaps between beads are bridged if both beads are near
    bridged_cover = np.minimum(bridged[other_rows], bridged[begins][mine])
    cover[mine] = np.maximum(
        cover[mine] + alone[other_rows],
        np.where(alone[other_rows] < bridged_cover, 2.0 * bridged_cover, 0.0),
    )
    wide, other_wide = pieces.width[piece_rows[begins][mine]], pieces.width[piece_rows[other_rows]]
    to_border = (off[other_rows] * wide - off[begins][mine] * other_wide) / (wide + other_wide)
    share[mine] = np.clip(to_border / grid.edge + 0.5, 0.0, 1.0)
    second_along = along[begins]
    second_along[mine] = along[other_rows]
    counted = [
        (rows, cube_shares * part_shares)
        for at, offset, cube_shares in (
            (piece_rows[begins], along[begins], share),
            (second, second_along, 1.0 - share),
        )
        for rows, part_shares in _along_bead(pieces, at, offset, grid.edge)
    ]
    number = np.arange(len(begins))
    return Footprint(
        cubes[begins],
        piece_rows[begins],
        second,
        share,
        up[begins],
        aside[begins],
        np.minimum(cover, 1.0),
        csr_matrix(
            (
                np.concatenate([shares for _, shares in counted]),
                (np.concatenate([rows for rows, _ in counted]), np.tile(number, len(counted))),
            ),
            shape=(len(pieces), len(begins)),
        ),
    )


def _along_bead(
    pieces: Strands, piece_rows: Index, along: Array, edge: float
) -> tuple[tuple[Index, Array], tuple[Index, Array]]:
    """Split cubes between the nearest piece and the next piece along the bead.

    along: (k,) position of the cubes relative to the piece's midpoint, mm. edge: cube edge, mm. Returns both pieces (k,)
    with their fraction (k,) of the cube.
    """
    beside = np.clip(piece_rows + np.where(along < 0.0, -1, 1), 0, len(pieces) - 1)
    share = np.clip((np.abs(along) - 0.5 * pieces.length[piece_rows]) / edge + 0.5, 0.0, 0.5)
    share = np.where(pieces.bead[beside] == pieces.bead[piece_rows], share, 0.0)
    return (piece_rows, 1.0 - share), (beside, share)


def _chunks(grid: Grid, pieces: Strands, low: Array, high: Array) -> Iterator[Index]:
    """Yield chunks of pieces; end pieces reach farther and have separate chunks."""
    for rows in (np.flatnonzero(~pieces.ends), np.flatnonzero(pieces.ends)):
        if not len(rows):
            continue
        samples_per_piece = float(np.prod(_counts(grid, pieces, rows, low, high)))
        yield from np.array_split(rows, 1 + int(samples_per_piece * len(rows) / SAMPLES))


def _reach(grid: Grid, pieces: Strands, rows: Index) -> tuple[Array, Array]:
    """Return the maximum distances (n,) of cubes from the midpoint of pieces, along and across the bead, mm."""
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
) -> tuple[Index, Index, Array, Array, Array, Array]:
    """Return pairs of cubes and near pieces.

    For each pair: cube, piece, and the cube's distance above the path, aside, along, and from the line of the piece, mm.
    """
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
    for axis in range(3):  # axis by axis, to add the few offsets of each direction first
        samples = middle[:, axis, None] + axes[0][:, axis, None] * lattice[0]
        samples = samples[:, :, None] + (axes[1][:, axis, None] * lattice[1])[:, None]
        samples = samples[:, :, :, None] + (axes[2][:, axis, None] * lattice[2])[:, None, None]
        cube = np.floor(samples.reshape(len(rows), -1) * (1.0 / grid.edge)).astype(np.int64)
        corner.append(cube.min(axis=1))
        cube -= corner[-1][:, None]
        spans.append(int(cube.max()) + 1)
        cubes.append(cube)
    # mark each cube once per piece in a box around the piece; this is faster than sorting
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
    return (
        cube_rows[is_near],
        piece_rows[is_near],
        up[is_near],
        left_offset[is_near],
        along[is_near],
        off[is_near],
    )


MAX_CUBES = 400_000  # approximate maximum number of cubes of a deposit
MIN_EDGE_SHARE = (
    0.5  # minimum cube edge as a fraction of the layer height; half of it for the bead width
)
PARABOLA = 1.5  # ratio of the height of a parabola to its mean height
FLAT_SPACING_WIDTHS = 0.738  # bead widths; maximum spacing with a flat surface between beads
NEIGHBOUR_WIDTHS = 1.05  # mean widths; maximum distance of adjacent beads without a gap
SAG = 0.5  # layer heights; maximum depth that a bead fills below its planned base
LOOKED = 2.0  # layer heights; search range above and below for the deposit below a layer
SEARCH_HEIGHT = 1.0  # layer heights; search range above the planned top of a bead
AGAIN = 4  # maximum number of searches, each with twice the range
POOL = 1.5  # bead widths; distance over which a melt levels
ROUNDS = 10  # iterations of the levels
MIN_RISING_SHARE = 0.05  # minimum fraction of a piece's area that counts as rising
HALVINGS = 60
ROUNDING = 1e-9  # relative rounding error of a cube
ROUNDING_SHARE = 1e-12  # fraction of the volume fed to a layer; rounding error

Report = Callable[[float, str], None]


@dataclass(frozen=True, eq=False)
class Part:
    """A feature's toolpath, the indices (k,) of its layers in the whole toolpath, and its process."""

    toolpath: Toolpath
    numbers: Index
    process: ProcessParameters


@dataclass(frozen=True, eq=False)
class PredictedDeposit:
    """A predicted deposit.

    grid: filled cubes. pieces: all strands. level: (n,) height of the surface above the path at the pieces' midpoints,
    mm. bead_in_layer: (n,) bead index. fed: wire volume, mm3. deposited: volume that fits into the grid, mm3. drift:
    (layers,) height of each layer's mean surface above the start of the next layer, mm, NaN without beads.
    """

    grid: Grid
    pieces: Strands
    level: Array
    bead_in_layer: Index
    fed: float
    deposited: float
    drift: Array


def feature_parts(toolpath: Toolpath, processes: Sequence[ProcessParameters]) -> tuple[Part, ...]:
    """Return the features of a toolpath with the process of each.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    processes : sequence of ProcessParameters
        Process of each feature.

    Returns
    -------
    tuple of Part
        The features.
    """
    return tuple(
        Part(feature, numbers, feature_process)
        for (feature, numbers), feature_process in zip(toolpath.parts, processes, strict=True)
    )


def edge_of(pieces: Strands) -> float:
    """Return the edge of the cubes for a deposit of these strands, mm.

    The cubes are small compared with layers and beads, as far as the limit of their number allows.
    The minimum layer height is a whole number of cubes.
    """
    height = float(pieces.height.min())
    fine = MIN_EDGE_SHARE * min(height, 0.5 * float(pieces.width.min()))
    edge = max(fine, float(np.cbrt(pieces.volume.sum() / MAX_CUBES)))
    return height / int(height / edge + ROUNDING) if edge < height else edge


def predicted_deposit(
    parts: Sequence[Part], report: Report, edge: float | None = None
) -> PredictedDeposit:
    """Predict the deposit of features, feature by feature.

    Parameters
    ----------
    parts : sequence of Part
        The features.
    report : Report
        Called with the completed fraction and a text; may raise to cancel.
    edge : float or None, optional
        Edge of the cubes, mm; None uses `edge_of`.

    Returns
    -------
    PredictedDeposit
        The deposit.

    Raises
    ------
    ValueError
        If the bead width is unknown.
    """
    feature_strands = [strands(part.toolpath, part.process) for part in parts]
    pieces = join_strands(feature_strands)
    grid = Grid(edge_of(pieces) if edge is None else edge)
    layers = sum(len(part.toolpath.layers) for part in parts)
    drift, total = np.full(layers, np.nan), 0.0
    levels, beads = [], []
    for part, part_strands in zip(parts, feature_strands, strict=True):
        below: tuple[Strands, Array] | None = None
        spiral = is_spiral(part.toolpath)
        courses = (
            turns_of(part.toolpath.layers[0].beads[0])[part_strands.point]
            if spiral
            else part_strands.layer
        )
        means: list[float] = []
        bounds = np.searchsorted(courses, np.arange(courses.max(initial=-1) + 2))
        for start, end in zip(bounds.tolist(), bounds[1:].tolist(), strict=False):
            if start == end:
                continue
            layer_strands = part_strands.rows(slice(start, end))
            layer_number = int(part.numbers[layer_strands.layer[0]]) + 1
            report(layer_number / layers, Text("layer {} of {}", layer_number, layers))
            layer = _Layer(grid, layer_strands, _base(grid, layer_strands, below))
            total += layer.lay()
            over = layer.level - layer.rise - layer_strands.height
            means.append(float(np.average(over, weights=layer_strands.length)))
            drift[part.numbers[layer_strands.layer[0]]] = means[-1]
            levels.append(layer.level)
            beads.append(layer_strands.bead - layer_strands.bead[0])
            below = layer_strands, over
        if spiral:
            drift[part.numbers[0]] = _spiral_drift(means)
    numbered = np.concatenate(
        [
            part.numbers[part_strands.layer]
            for part, part_strands in zip(parts, feature_strands, strict=True)
        ]
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
    """Return the maximum height error of a spiral's turns, mm, relative to the first rising turn.

    The first and the last turn are excluded. They overlap the rising turns and are reported as over-deposition.
    """
    rising = np.array(means[1:-1])
    if not len(rising):
        return 0.0
    off = rising - rising[0]
    return float(off[np.abs(off).argmax()])


def _base(grid: Grid, pieces: Strands, below: tuple[Strands, Array] | None) -> Array:
    """Return the height of the deposit below the pieces' midpoints, relative to the path, (n,) mm; 0 without deposit.

    The search runs from above the top of the layer below to below its planned height.
    """
    base = np.zeros(len(pieces))
    if below is None or pieces.is_first.all():
        return base
    lower, over = below
    nearest = cKDTree(lower.middle + lower.height[:, None] * lower.build).query(pieces.middle)[1]
    start = np.maximum(over[nearest], 0.0) + LOOKED * pieces.height
    end = np.minimum(over[nearest], 0.0) - LOOKED * pieces.height
    count = int(np.ceil(float((start - end).max()) / (0.5 * grid.edge)))
    remaining, previous = np.flatnonzero(~pieces.is_first), np.zeros(len(pieces))
    for number in range(count + 1):
        up = start + (end - start) * (number / count)
        now = grid.fill_at(pieces.middle[remaining] + up[remaining, None] * pieces.build[remaining])
        met = now >= 0.5
        rows = remaining[met]
        back = np.where(
            number, (now[met] - 0.5) / np.maximum(now[met] - previous[rows], 1e-12), 0.0
        )
        base[rows] = up[rows] + back * (start - end)[rows] / count
        previous[remaining] = now
        remaining = remaining[~met]
        if not len(remaining):
            break
    return base


class _Layer:
    """One layer during its deposit.

    Heights (n,) are in mm above the path of the pieces: `base`, the top of the deposit below;
    `level`, the surface of the pieces; `rise`, from the mean of the surface to its crest.
    """

    def __init__(self, grid: Grid, pieces: Strands, base: Array) -> None:
        self.grid, self.pieces = grid, pieces
        area = pieces.volume / pieces.length
        free = _free_sides(pieces)
        self.fall = (
            PARABOLA * (area / pieces.width)[:, None] * free
        )  # mm (n, 2); drop of the surface from the crest to each side
        self.rise = self.fall.sum(axis=1) / 6.0
        base = np.where(pieces.is_first | (base == 0.0), base, base - self.rise)
        self.base = base
        self.level = base + pieces.height + self.rise

    def lay(self) -> float:
        """Fill the grid with the volume fed to the layer; return the volume that fits, mm3."""
        high = self.base + self.rise + (1.0 + SEARCH_HEIGHT) * self.pieces.height
        fed = float(self.pieces.volume.sum())
        placed, volumes = 0.0, self.pieces.volume
        for _ in range(AGAIN):
            placed += self._fill(volumes, high)
            missing = fed - placed
            if missing <= ROUNDING_SHARE * fed:
                break
            volumes = missing * self.pieces.volume / fed
            high = self.base + 2.0 * (high - self.base)
        return placed

    def _fill(self, volumes: Array, high: Array) -> float:
        """Deposit volumes (n,), mm3, up to heights `high` (n,), mm; return the volume that fits, mm3."""
        grid, pieces = self.grid, self.pieces
        low = self.base - np.where(pieces.is_first, 0.0, pieces.height)
        cells = footprint(grid, pieces, low - grid.edge, high)
        fall = self._fall(cells)
        surface = cells.up + fall
        # fill only above the surface of the layer below and a part of its shortfall, never below the layer
        lowest = np.where(pieces.is_first, 0.0, self.base - pieces.height)
        sagged = self.base - SAG * pieces.height + self.rise
        bottom = np.where(
            pieces.is_first[cells.piece_rows],
            0.0,
            np.maximum(sagged[cells.piece_rows] - fall, lowest[cells.piece_rows]),
        )
        capacity = cells.cover * np.clip((cells.up - bottom) / grid.edge + 0.5, 0.0, 1.0)
        present = grid.filled[cells.cubes]

        def filled(level: Array) -> Array:
            upto = np.clip((cells.mixed(level) - surface) / grid.edge + 0.5, 0.0, 1.0)
            full: Array = np.maximum(capacity * upto - present, 0.0)
            return full

        level = np.minimum(self._level(volumes, cells, filled, high), high)
        # distribute the remainder from rounding and pools evenly
        lowest, highest, cube = low.min() - high.max(), high.max() - low.min(), grid.edge**3
        total = float(volumes.sum())
        for _ in range(HALVINGS):
            middle = 0.5 * (lowest + highest)
            over = float(filled(np.minimum(level + middle, high)).sum()) * cube > total
            lowest, highest = (lowest, middle) if over else (middle, highest)
        self.level = np.minimum(level + highest, high)
        added = filled(self.level)
        grid.filled[cells.cubes] += added
        return float(added.sum()) * cube

    def _level(
        self, volumes: Array, cells: Footprint, filled: Callable[[Array], Array], high: Array
    ) -> Array:
        """Return the surface heights (n,) of pieces at which filled and fed volume are equal, averaged over pools, mm.

        filled: returns the filled fractions of cubes (k,) for heights (n,).
        """
        pieces, edge = self.pieces, self.grid.edge
        pool = _pools(pieces)
        cube, level = edge**3, pool @ (self.base + self.rise) / pool.sum(axis=1).A1 + pieces.height

        def margin(levels_: Array) -> Array:
            volumes: Array = cells.pieces @ filled(levels_) * cube
            return volumes

        for _ in range(ROUNDS):
            volume = margin(level)
            # finite difference of the volume over a half cube gives the rising area
            area = (margin(level + 0.25 * edge) - margin(level - 0.25 * edge)) / (0.5 * edge)
            step = (pool @ (volumes - volume)) / np.maximum(
                pool @ area, MIN_RISING_SHARE * (pool @ (pieces.width * pieces.length))
            )
            level = np.minimum(level + np.clip(step, -pieces.height, pieces.height), high)
        levels: Array = level
        return levels

    def _fall(self, cells: Footprint) -> Array:
        """Return the drop of the bead surface from the crest to each cube, (k,) mm."""
        offset = 2.0 * cells.aside / self.pieces.width[cells.piece_rows]
        fall: Array = self.fall[cells.piece_rows, (cells.aside < 0.0).astype(np.intp)] * np.minimum(
            offset * offset, 1.0
        )
        return fall


def _free_sides(pieces: Strands) -> Array:
    """Return the drop of the surface to the left and right of pieces, (n, 2), as a fraction of a parabola's drop.

    It is 1 without an adjacent bead, 0 next to a close bead.
    """
    free = np.ones((len(pieces), 2))
    reach = NEIGHBOUR_WIDTHS * float(pieces.width.max())
    pairs = cKDTree(pieces.middle).query_pairs(reach, output_type="ndarray").astype(np.intp)
    if not len(pairs):
        return free
    i, j = np.vstack([pairs, pairs[:, ::-1]]).T
    is_pair = pieces.are_separate(i, j)
    i, j = i[is_pair], j[is_pair]
    offset = pieces.middle[j] - pieces.middle[i]
    aside, ahead = dots(offset, pieces.side[i]), dots(offset, pieces.along[i])
    mean = 0.5 * (pieces.width[i] + pieces.width[j])
    share = np.abs(aside) / mean
    adjacent = (np.abs(ahead) <= 0.5 * (pieces.length[i] + pieces.length[j])) & (
        share <= NEIGHBOUR_WIDTHS
    )
    valley = np.where(
        pieces.real[i],
        np.clip((share - FLAT_SPACING_WIDTHS) / (1.0 - FLAT_SPACING_WIDTHS), 0.0, 1.0),
        0.0,
    )
    np.minimum.at(free, (i[adjacent], (aside < 0.0).astype(np.intp)[adjacent]), valley[adjacent])
    return free


def _pools(pieces: Strands) -> csr_matrix:
    """Return the weights (n, n) of pieces in each other's pool, in which a melt levels."""
    pairs = (
        cKDTree(pieces.middle)
        .query_pairs(POOL * float(pieces.width.max()), output_type="ndarray")
        .astype(np.intp)
    )
    diagonal = np.arange(len(pieces))
    i, j = np.concatenate([pairs, pairs[:, ::-1], np.stack([diagonal, diagonal], axis=1)]).T
    distance = np.sqrt(((pieces.middle[i] - pieces.middle[j]) ** 2).sum(axis=1))
    weight = np.maximum(1.0 - distance / (POOL * np.minimum(pieces.width[i], pieces.width[j])), 0.0)
    return csr_matrix((weight, (i, j)), shape=(len(pieces), len(pieces)))
