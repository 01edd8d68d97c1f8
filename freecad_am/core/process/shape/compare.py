# SPDX-License-Identifier: LGPL-2.1-or-later
"""Comparison of a predicted deposit with the part: allowance on the faces, and whether it is sufficient."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots
from ...geometry.formatting import place, round_step
from ...geometry.mesh.coarsen import doubled_areas
from ...geometry.mesh.solid import divide_triangles
from ...geometry.toolpath_records import DeviationMap, PredictedShape
from ...issues import WARNING, Issue, Text, Word
from ...types import Array, Index, Mask
from .laying import PredictedDeposit
from .strands import Grid

PLACES = 20_000  # approximate number of sample points
LEAF_SIZE = 2 * PLACES
FACING = 0.99  # minimum cosine between opposite faces in contact
CONTACT = 0.05  # mm; maximum distance between faces in contact
SPACINGS = 1.0  # sampling distances; maximum distance between points of faces in contact
OUTSIDE, BOTH = "outside", "both"


@dataclass(frozen=True, eq=False)
class Faces:
    """Sampled faces of a part.

    points: (n, 3) mm. normals: (n, 3) outward unit vectors. areas: (n,) area that each point represents, mm2. open: (n,)
    whether the face belongs to an open shell; the side with less allowance then counts.
    """

    points: Array
    normals: Array
    areas: Array
    open: Mask

    def __len__(self) -> int:
        return len(self.points)

    def rows(self, mask: Mask) -> Faces:
        """Return the faces selected by a mask."""
        return Faces(self.points[mask], self.normals[mask], self.areas[mask], self.open[mask])


def faces(vertices: Array, triangles: Index, side: str = OUTSIDE) -> Faces:
    """Sample triangles with evenly distributed points.

    Parameters
    ----------
    vertices : (k, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Vertex indices, counter-clockwise seen from outside.
    side : str, optional
        OUTSIDE for a solid, BOTH for an open shell.

    Returns
    -------
    Faces
        Points with normals and areas.
    """
    corners = vertices[triangles]
    vectors = doubled_areas(corners)
    twice = np.linalg.norm(vectors, axis=1)
    is_proper = twice > 1e-12 * max(float(twice.max(initial=0.0)), 1e-300)
    corners, vectors, twice = corners[is_proper], vectors[is_proper], twice[is_proper]
    points, triangle = divide_triangles(
        corners, float(np.sqrt(2.0 * twice.sum() / PLACES))
    )  # triangles are half squares
    areas = 0.5 * twice[triangle] / np.bincount(triangle, minlength=len(corners))[triangle]
    return Faces(
        points, vectors[triangle] / twice[triangle, None], areas, np.full(len(points), side == BOTH)
    )


def thin_faces(dense: Faces) -> Faces:
    """Reduce faces with far more than PLACES points to points of about equal area.

    Slivers, whose normals are unreliable, disappear.
    """
    if len(dense) <= LEAF_SIZE:
        return dense
    ends = np.cumsum(dense.areas)
    sample = np.unique(np.searchsorted(ends, (np.arange(PLACES) + 0.5) / PLACES * ends[-1]))
    areas = np.diff(ends[sample], prepend=0.0)
    areas[-1] += ends[-1] - ends[sample[-1]]
    return Faces(dense.points[sample], dense.normals[sample], areas, dense.open[sample])


def uncovered_faces(parts: Sequence[Faces]) -> Faces:
    """Join the faces of several parts, without the contact areas between parts, which are not machined.

    A point is in contact if the nearest point of another part is in the same plane, faces the opposite way, and is
    within the sampling distance.
    """
    free_faces = []
    for k, part in enumerate(parts):
        free = ~part.open
        for other_part in (*parts[:k], *parts[k + 1 :]):
            distance, nearest = cKDTree(other_part.points).query(part.points)
            out = np.abs(dots(part.points - other_part.points[nearest], part.normals))
            facing = dots(part.normals, other_part.normals[nearest]) < -FACING
            free &= ~(
                (distance < SPACINGS * np.sqrt(other_part.areas[nearest]))
                & (out < CONTACT)
                & facing
                & ~other_part.open[nearest]
            )
        free_faces.append(part.rows(free | part.open))
    return join_faces(free_faces)


def join_faces(parts: Sequence[Faces]) -> Faces:
    """Join the faces of several parts."""
    return Faces(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("points", "normals", "areas", "open")
        )
    )


CODE, DRIFT = "ALLOWANCE", "LAYER_DRIFT"
MAX_DRIFT_SHARE = 0.5  # layer heights; maximum height error of a layer that is not reported
KNOWN = 0.25  # cube edges; accuracy of the surface
HALF = 0.5  # fill fraction of a cube on the surface
STEP = 0.5  # cube edges; distance between samples along a normal
REACH = 2.0  # bead widths plus layer heights; search range for the deposit, outwards and inwards
STANDS = (
    0.25  # layer heights; maximum height above the start of a first layer of a face on the ground
)
DOWN = 0.5  # minimum cosine between the normal of such a face and the downward direction
KNOWN_WIDTHS = 1.5  # bead widths; distance from a first layer within which the ground is known
AT_ONCE = 4_000


@dataclass(frozen=True, eq=False)
class Compared:
    """Comparison of the deposit with faces that must be covered.

    deviation: (n,) distance that the deposit reaches beyond the faces along the normals, mm, negative where the part
    protrudes; for open shells, on the side with less deposit. bare: (n,) where no deposit is within `reach` mm, the
    limit of deviations. piece_rows: (n,) nearest piece of the deposit.
    """

    faces: Faces
    deviation: Array
    bare: Mask
    reach: float
    piece_rows: Index

    @property
    def surface(self) -> Array:
        """Return the points of the deposit's surface that correspond to the faces.

        Returns
        -------
        (n, 3) array
            Points, mm.
        """
        points: Array = self.faces.points + self.deviation[:, None] * self.faces.normals
        return points


def compare_deposit(deposit: PredictedDeposit, faces: Faces) -> Compared:
    """Compare the deposit with all faces, except faces on the ground and faces below the first layer."""
    pieces = deposit.pieces
    covered = faces.rows(_to_be_covered(deposit, faces))
    reach = REACH * (float(pieces.width.max()) + float(pieces.height.max()))
    out, bare = _reach_distances(deposit.grid, covered.points, covered.normals, reach)
    if covered.open.any():
        back_out, back_bare = _reach_distances(
            deposit.grid, covered.points, -covered.normals, reach
        )
        less = covered.open & (back_out < out)
        turned = np.where(less[:, None], -covered.normals, covered.normals)
        covered = Faces(covered.points, turned, covered.areas, covered.open)
        out, bare = np.where(less, back_out, out), np.where(less, back_bare, bare)
    piece_rows = (
        np.asarray(cKDTree(pieces.middle).query(covered.points)[1])
        if len(covered)
        else np.zeros(0, dtype=np.intp)
    )
    return Compared(covered, out, bare, reach, piece_rows)


def _to_be_covered(deposit: PredictedDeposit, faces: Faces) -> Mask:
    """Return which points are neither below a first layer nor on faces on the layer's ground."""
    begins = deposit.pieces.rows(np.flatnonzero(deposit.pieces.is_first))
    distance, nearest = cKDTree(begins.middle).query(faces.points)
    build, height = begins.build[nearest], begins.height[nearest]
    up = dots(faces.points - begins.middle[nearest], build)
    adjacent = (
        np.sqrt(np.maximum(distance * distance - up * up, 0.0))
        < KNOWN_WIDTHS * begins.width[nearest]
    )
    down = dots(faces.normals, build) < -DOWN
    below = adjacent & ((up < -STANDS * height) | ((up < STANDS * height) & down))
    result: Mask = ~below
    return result


def _reach_distances(grid: Grid, points: Array, normals: Array, reach: float) -> tuple[Array, Mask]:
    """Return how far (n,) mm the deposit extends from points (n, 3) along unit normals.

    At a point without deposit the value is negative: the distance to the deposit, inwards along the normal or to a
    nearer side. Also returns where no deposit is within `reach` mm.
    """
    count = int(np.ceil(reach / (STEP * grid.edge)))
    steps = np.linspace(0.0, reach, count + 1)
    lengths_, bare = np.empty(len(points)), np.zeros(len(points), dtype=bool)
    full = cKDTree(grid.centres(np.flatnonzero(grid.filled >= HALF)))
    for start in range(0, len(points), AT_ONCE):
        rows = slice(start, start + AT_ONCE)
        inside = grid.fill_at(points[rows]) >= HALF
        sign = np.where(inside, 1.0, -1.0)
        length = _first_change(grid, points[rows], sign[:, None] * normals[rows], steps, inside)
        distance = np.minimum(
            np.asarray(full.query(points[rows], distance_upper_bound=reach + grid.edge)[0]),
            reach + grid.edge,
        )
        length = np.where(
            inside, length, np.minimum(length, np.maximum(distance - 0.5 * grid.edge, 0.0))
        )
        lengths_[rows], bare[rows] = sign * length, ~inside & (length >= reach)
    return lengths_, bare


def _first_change(
    grid: Grid, points: Array, directions: Array, steps: Array, inside: Mask
) -> Array:
    """Return the distances (n,) along rays at which the deposit first begins or ends, mm, else the last step."""
    length = np.full(len(points), steps[-1])
    remaining = np.arange(len(points))
    previous = grid.fill_at(points)
    for start, end in zip(steps[:-1], steps[1:], strict=True):
        now = grid.fill_at(points[remaining] + end * directions[remaining])
        changed = (now >= HALF) != inside[remaining]
        rows = remaining[changed]
        share = (HALF - previous[changed]) / (now[changed] - previous[changed])
        length[rows] = start + share * (end - start)
        remaining, previous = remaining[~changed], now[~changed]
        if not len(remaining):
            break
    return length


def figures(deposit: PredictedDeposit, comparison: Compared, allowance: float) -> PredictedShape:
    """Return the statistics of a comparison.

    Parameters
    ----------
    deposit : PredictedDeposit
        The predicted deposit.
    comparison : Compared
        The comparison with the faces.
    allowance : float
        Required allowance on all faces, mm.

    Returns
    -------
    PredictedShape
        The statistics.

    Raises
    ------
    ValueError
        If there are no faces to cover.
    """
    if not len(comparison.faces):
        raise ValueError("there are no faces to be covered")
    area, worst = comparison.faces.areas, int(comparison.deviation.argmin())
    total, resolution = float(area.sum()), KNOWN * deposit.grid.edge
    pieces, worst_piece = deposit.pieces, comparison.piece_rows[worst]

    def share(mask: Mask) -> float:
        return float(area[mask].sum()) / total

    return PredictedShape(
        deposit.fed,
        deposit.deposited,
        deposit.grid.edge,
        deposit.drift,
        allowance,
        len(area),
        float(comparison.deviation[worst]),
        float(comparison.deviation @ area) / total,
        float(comparison.deviation.max()),
        share(comparison.deviation < allowance - resolution),
        share(comparison.deviation < -resolution),
        share(comparison.bare),
        comparison.reach,
        comparison.faces.points[worst],
        int(pieces.layer[worst_piece]),
        int(deposit.bead_in_layer[worst_piece]),
        int(pieces.point[worst_piece]),
    )


def issues(
    shape: PredictedShape,
    layer_heights: Array,
    is_first: Mask,
    remedy: str,
    courses: Array | None = None,
) -> tuple[Issue, ...]:
    """Return the issues of a predicted shape.

    Parameters
    ----------
    shape : PredictedShape
        The statistics of the comparison.
    layer_heights : (layers,) array
        Planned heights, mm.
    is_first : (layers,) bool array
        Layers without a layer of their feature below.
    remedy : str
        Remedy for a deposit that is too small, with {} for the missing mm.
    courses : (layers,) array or None, optional
        Number of turns stacked within a layer, 1 except for spirals; None for 1.

    Returns
    -------
    tuple of Issue
        Issues of layers higher or lower than planned, and of insufficient allowance.
    """
    courses = np.ones(len(layer_heights)) if courses is None else courses
    drifts, low = _drift(shape.drift, layer_heights, is_first, courses)
    if shape.short <= 0.0:
        return drifts
    lacks = shape.allowance - shape.least
    if shape.least <= -shape.reach:
        text = Text("no deposit within {:.3g} mm", shape.reach)
    elif shape.least < 0.0:
        text = Text("the part protrudes by {:.3g} mm", -shape.least)
    else:
        text = Text("{:.3g} mm are left to machine", shape.least)
    # if layers are too low, more deposit is needed everywhere
    remedy = (
        "First set strategy.layer_height to the predicted height"
        if low
        else Text(remedy, f"{lacks:.3g}")
    )
    return (
        *drifts,
        Issue(
            WARNING,
            CODE,
            Text(
                "on {:.3g} % of the faces the predicted deposit extends less than {:g} mm beyond "
                "the part, and on {:.3g} % the deposit ends inside the part: at {} {}. {}",
                100.0 * shape.short,
                shape.allowance,
                100.0 * shape.outside,
                place(shape.worst),
                Word(text),
                remedy,
            ),
            shape.layer,
            shape.bead,
            shape.point,
        ),
    )


def _drift(
    drift: Array, layer_heights: Array, is_first: Mask, courses: Array
) -> tuple[tuple[Issue, ...], bool]:
    """Report the layer whose top deviates most from the start of the next layer, if by more than MAX_DRIFT_SHARE.

    Also returns whether this top is too low.
    """
    off = np.nan_to_num(drift) / layer_heights
    worst = int(np.abs(off).argmax()) if len(off) else 0
    if not len(off) or abs(off[worst]) <= MAX_DRIFT_SHARE:
        return (), False
    lowest = int(np.flatnonzero(is_first[: worst + 1])[-1]) if is_first[: worst + 1].any() else 0
    actual_height = layer_heights[worst] + drift[worst] / courses[lowest : worst + 1].sum()
    direction = "below" if drift[worst] < 0.0 else "above"
    return (
        Issue(
            WARNING,
            DRIFT,
            Text(
                "the layer is predicted to end {:.3g} mm {} the start of the next layer: up to "
                "here layers are {:.3g} mm high on average instead of {:g} mm; set "
                "strategy.layer_height to {:.3g} mm, or change the wire feed",
                abs(drift[worst]),
                Word(direction),
                actual_height,
                layer_heights[worst],
                actual_height,
            ),
            worst,
        ),
    ), bool(drift[worst] < 0.0)


MOST_PLACES = 3000  # maximum number of points kept in the map
NAMED = 5  # number of worst points that are named
MIN_SEPARATION_SHARE = 0.1  # fraction of the part size; minimum distance between two named points
STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)  # bar widths of a histogram, times powers of ten
BARS = 40  # approximate number of histogram bars


def deviation_map(deposit: PredictedDeposit, comparison: Compared, layers: int) -> DeviationMap:
    """Return the deviation map of a comparison: evenly sampled points, worst first.

    Parameters
    ----------
    deposit : PredictedDeposit
        The predicted deposit.
    comparison : Compared
        The comparison with the faces.
    layers : int
        Number of layers of the path.

    Returns
    -------
    DeviationMap
        The map with a histogram and statistics by layer.
    """
    named = _worst(comparison.faces.points, comparison.deviation)
    count = len(comparison.deviation)
    sample = np.arange(0, count, -(-count // MOST_PLACES))
    rows = np.concatenate([named, sample[~np.isin(sample, named)]])
    pieces, worst_pieces = deposit.pieces, comparison.piece_rows[named]
    edges, shares = _histogram(comparison.deviation, comparison.faces.areas)
    return DeviationMap(
        comparison.faces.points[rows],
        comparison.faces.normals[rows],
        comparison.deviation[rows],
        np.column_stack(
            [
                pieces.layer[worst_pieces],
                deposit.bead_in_layer[worst_pieces],
                pieces.point[worst_pieces],
            ]
        ).astype(np.int64),
        edges,
        shares,
        _by_layer(
            comparison.deviation,
            comparison.faces.areas,
            np.asarray(pieces.layer[comparison.piece_rows], dtype=np.intp),
            layers,
        ),
    )


def name_of(number: int) -> str:
    """Return the letter that names a worst point."""
    return "ABCDEFGHIJ"[number]


def _worst(points: Array, deviation: Array) -> Index:
    """Return the rows of the points of least deviation, separated from each other."""
    separation = MIN_SEPARATION_SHARE * float(np.linalg.norm(np.ptp(points, axis=0)))
    remaining: Index = np.argsort(deviation, kind="stable")
    rows: list[int] = []
    while len(remaining) and len(rows) < NAMED:
        rows.append(int(remaining[0]))
        remaining = remaining[
            np.linalg.norm(points[remaining] - points[remaining[0]], axis=1) > separation
        ]
    return np.array(rows, dtype=np.intp)


def _histogram(deviation: Array, areas: Array) -> tuple[Array, Array]:
    """Return the bar edges (k + 1,), mm, including 0, and the area fraction (k,) in each bar."""
    low, high = float(deviation.min()), float(deviation.max())
    width = round_step(max(high - low, 1e-6) / BARS, STEPS)
    edges = width * np.arange(np.floor(low / width), np.floor(high / width) + 2)
    return edges, np.histogram(deviation, edges, weights=areas)[0] / areas.sum()


def _by_layer(deviation: Array, areas: Array, layer: Index, layers: int) -> Array:
    """Return minimum and mean deviation (layers, 2), mm, at the points nearest to each layer; NaN without points."""
    lowest, area = np.full(layers, np.inf), np.bincount(layer, areas, layers)
    np.minimum.at(lowest, layer, deviation)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.bincount(layer, areas * deviation, layers) / area
    return np.column_stack(
        [np.where(area > 0.0, lowest, np.nan), np.where(area > 0.0, mean, np.nan)]
    )
