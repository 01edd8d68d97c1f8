# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plane regions with holes: built from loops, repaired at crossings, offset by parallel curves.

This is the only file that uses shapely (decision 0010), versions 1.8 and 2. The library is imported
on first use. Inputs and outputs are arrays.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...issues import NOTE, InputError, Issue, Text
from ...types import Array, Index, Mask
from ..curves.plane_curve import doubled_area, nearest_on_rings, running_sums, winding
from ..step_count import turn_segments

MERGED = 1e-12  # of the extent; closer points are merged
# of the extent; deviation of a straight border, and minimum width of a region
STRAIGHTNESS_TOLERANCE = 1e-9
SLIVER = 1e-12  # of the squared extent; default minimum area of a piece
AT_ONCE, BEND = 200, 1.5  # maximum points and total turn (rad) of a line piece to buffer
_POLYGON, _MULTI_POLYGON = 3, 6  # codes in well-known binary (WKB)
# shapely join style for mitred corners, and their mitre limit
_MITRE, SHARPEST = 2, 1000.0
MITRE_LIMIT = 2.0  # ratio of a mitre's length to the offset; sharper corners are cut off
DIGITS = 9  # decimals of mm for simplification, so that last bits have no effect
LEAST_ARC = 8  # minimum number of segments of a full turn
EIGHT = 2.8  # of the squared radius; slightly less than the area of an inscribed octagon
ON_EDGE = 1e-6  # mm; maximum distance of a collinear point from the line of its neighbours
SAME_TURN = 1e-6  # rad; turn angles that differ by less are equal
ROUND_AREA = 0.02  # relative; second moments of area that differ by less are equal
WIDTH = 0.005  # relative tolerance of a region's width
SIZE_MARGIN = 1.0 - 1e-9  # margin for the rounding of measured areas
WIDENING = 2.0  # chord errors; wider bands leave no slivers between chords of neighbouring curves
FINE_SLIT, LONG_SLIT = (
    0.1,
    20.0,
)  # of a slit's width: chord error for closing; minimum border length removed


class Shapely(NamedTuple):
    """Modules of shapely, and the name of one argument."""

    geometry: Any
    ops: Any
    wkb: Any
    arcs: str  # name of the argument for segments per quarter turn


@lru_cache(maxsize=1)
def shapely() -> Shapely:
    """Import shapely. Raises InputError MISSING_LIBRARY if it is not installed."""
    try:
        import shapely as package
        from shapely import geometry, ops, wkb
    except ImportError:
        raise InputError(
            "MISSING_LIBRARY",
            "filling",
            "filling solids needs the Python package shapely (1.8 or newer), which is not "
            "installed; on Debian: apt-get install python3-shapely, elsewhere: pip install "
            "shapely",
        ) from None
    return Shapely(
        geometry, ops, wkb, "resolution" if package.__version__.startswith("1.") else "quad_segs"
    )


@dataclass(frozen=True, eq=False)
class Region:
    """A connected plane region with holes, mm."""

    shape: Any  # a valid shapely Polygon; private to this file
    # mm; u (`strip.Period`) at the centre, for a region over more than half a turn of the plane
    sheet: float = 0.0

    @cached_property
    def _borders(self) -> tuple[Array, ...]:
        outer, *inner = _closed_rings(self.shape)
        holes = [_ring(hole, -1.0) for hole in inner]
        return (_ring(outer, 1.0), *sorted(holes, key=lambda ring: (ring[0, 0], ring[0, 1])))

    def borders(self) -> tuple[Array, ...]:
        """Return the borders: the outer border, then the holes in the order of their first points.

        Returns
        -------
        tuple of (n, 2) array
            Points, mm, material to the left. A border begins at its leftmost point, which is
            not repeated at the end.
        """
        return self._borders

    @property
    def area(self) -> float:
        """Area, mm^2."""
        return float(self.shape.area)

    @cached_property
    def middle(self) -> Array:
        """Return the centroid, which may be in a hole or outside.

        Returns
        -------
        (2,) array
            mm.
        """
        point = self.shape.centroid
        return np.array([point.x, point.y])

    def axis(self) -> Array:
        """Return the principal direction of the largest extent.

        Returns
        -------
        (2,) array
            Unit vector; x if the extents are equal, as for a circle or a square.
        """
        tensor = np.zeros((2, 2))
        for border in self._borders:
            ahead, here = np.roll(border, -1, axis=0) - self.middle, border - self.middle
            cross = here[:, 0] * ahead[:, 1] - here[:, 1] * ahead[:, 0]
            both = here + ahead
            tensor += np.einsum("n,ni,nj->ij", cross, here, here) + np.einsum(
                "n,ni,nj->ij", cross, ahead, ahead
            )
            tensor += np.einsum("n,ni,nj->ij", cross, both, both)
        sizes, ways = np.linalg.eigh(tensor)
        if sizes[1] - sizes[0] <= ROUND_AREA * sizes[1]:
            return np.array([1.0, 0.0])
        way: Array = ways[:, 1]
        return way if tuple(np.round(way, 9)) > (0.0, 0.0) else -way

    @cached_property
    def extent(self) -> float:
        """Diagonal of the bounding box, mm."""
        return float(np.hypot(*np.ptp(self._borders[0], axis=0)))

    @property
    def bounds(self) -> Array:
        """Return the bounding box.

        Returns
        -------
        (2, 2) array
            Lowest and highest corner, mm.
        """
        return np.reshape(self.shape.bounds, (2, 2))

    def contains(self, points: Array) -> Mask:
        """Return whether points are inside the region.

        Parameters
        ----------
        points : (..., 2) array
            Points of the plane, mm.

        Returns
        -------
        (...) array of bool
            True inside; undefined on the border.
        """
        return np.reshape(
            winding(self._borders, np.reshape(points, (-1, 2))) > 0, np.shape(points)[:-1]
        )

    @cached_property
    def _boxes(self) -> tuple[Array, Array]:
        """Lowest and highest coordinates (n, 2) of the borders."""
        return np.array([each.min(axis=0) for each in self._borders]), np.array(
            [each.max(axis=0) for each in self._borders]
        )

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Find the border points nearest to points.

        Parameters
        ----------
        points : (n, 2) array
            Points of the plane, mm.

        Returns
        -------
        places : (n, 2) array
            Nearest border points, mm.
        distances : (n,) array
            Distances, mm.
        """
        return nearest_on_rings(self._borders, self._boxes, points)

    @cached_property
    def width(self) -> float:
        """Diameter of the largest inscribed circle, mm; at most WIDTH (relative) too small."""
        low, high = self.area / float(self.shape.length), math.sqrt(self.area / math.pi)
        while high - low > WIDTH * high:
            middle = 0.5 * (low + high)
            if self.has_room(2.0 * middle, 0.1 * WIDTH * middle):
                low = middle
            else:
                high = middle
        return 2.0 * low

    def grown(self, distance: float, chord_error: float) -> tuple[Region, ...]:
        """Offset the border outwards by `distance` mm, with round corners; negative inwards.

        Arcs of the parallel curve are polylines within the chord error (mm) on the material side.
        """
        if distance == 0.0:
            return (self,)
        return _parts(self._grown(distance, chord_error), self._sliver, self.sheet)

    def grown_with_corners(self, distance: float) -> tuple[Region, ...]:
        """Offset the border by `distance` mm, with mitred corners; acute corners are cut off.

        Parameters
        ----------
        distance : float
            Distance, mm; negative inwards.

        Returns
        -------
        tuple of Region
            The parts, mm.
        """
        shape = self.shape.buffer(distance, join_style=_MITRE, mitre_limit=MITRE_LIMIT)
        return _parts(_polygons(shape), self._sliver, self.sheet)

    def has_room(self, width: float, chord_error: float) -> bool:
        """Return whether a circle of diameter `width` (mm) fits inside the region."""
        return any(part.area > self._sliver for part in self._grown(-0.5 * width, chord_error))

    @property
    def _sliver(self) -> float:
        """Minimum area of a piece, mm^2."""
        return SLIVER * self.extent**2

    def _grown(self, distance: float, chord_error: float) -> list[Any]:
        return _polygons(_buffered(self.shape, distance, chord_error))

    def without(
        self,
        others: Sequence[Region],
        wide: float = 0.0,
        least_area: float = 0.0,
        least_extent: float = 0.0,
    ) -> tuple[Region, ...]:
        """Subtract regions.

        Parameters
        ----------
        others : sequence of Region
            Regions to subtract.
        wide : float, optional
            Diameter, mm; pieces whose area is too small for a circle of this diameter are
            dropped.
        least_area : float, optional
            Minimum area of a piece, mm^2.
        least_extent : float, optional
            Minimum diagonal of the bounding box of a piece, mm.

        Returns
        -------
        tuple of Region
            Remaining regions, in the order of their leftmost points.
        """
        least = max(self._sliver, EIGHT * (0.5 * wide) ** 2, least_area)
        left = _larger(self.shape.difference(_union(others)), least, least_extent)
        if wide > 0.0:
            left = _cut_hairs(left, STRAIGHTNESS_TOLERANCE * self.extent)
        return _parts(left, least, self.sheet)

    def common(self, others: Sequence[Region], every_point: bool = False) -> tuple[Region, ...]:
        """Intersect the region with the union of `others`. every_point: as in `regions`."""
        return _parts(
            _polygons(self.shape.intersection(_union(others))),
            self._sliver,
            every_point=every_point,
        )

    def pieces(self, line: Array) -> list[Array]:
        """Return the pieces of a line inside the region.

        Parameters
        ----------
        line : (n, 2) array
            An open line without self-intersections, mm.

        Returns
        -------
        list of (m, 2) array
            Pieces in the order and sense of the line, mm.
        """
        library = shapely()
        whole = library.geometry.LineString(line)
        cut = whole.intersection(self.shape)
        cut = library.ops.linemerge(cut) if cut.geom_type == "MultiLineString" else cut
        parts = [
            part
            for part in getattr(cut, "geoms", [cut])
            if part.geom_type == "LineString" and not part.is_empty
        ]
        ordered_pieces = []
        for part in parts:
            ends = [float(whole.project(library.geometry.Point(part.coords[k]))) for k in (0, -1)]
            ordered_pieces.append(
                (min(ends), np.array(part.coords, dtype=float)[:: 1 if ends[0] <= ends[1] else -1])
            )
        return [piece for _, piece in sorted(ordered_pieces, key=lambda item: item[0])]

    def distance(self, other: Region) -> float:
        """Return the distance to another region, mm; 0 if they touch."""
        return float(self.shape.distance(other.shape))

    def simple(self, tolerance: float) -> Region:
        """Simplify the region within `tolerance` mm, independently of where its rings begin."""
        geometry = shapely().geometry
        rings = [_at_corner(ring[:-1]) for ring in _closed_rings(self.shape)]
        simple = geometry.Polygon(rings[0], rings[1:]).simplify(tolerance)
        simple_regions = _parts(_polygons(simple), 0.0, self.sheet)
        if len(simple_regions) != 1:
            return self
        if all(len(ring) != 4 for ring in simple_regions[0].borders()):
            return simple_regions[0]
        # shapely keeps at least four points of a ring
        rings = [_drop_fourth(ring, tolerance) for ring in simple_regions[0].borders()]
        return Region(geometry.Polygon(rings[0], rings[1:]), self.sheet)

    def inside(self) -> Array:
        """Return a point inside the region, away from the border.

        Returns
        -------
        (2,) array
            mm.
        """
        point = self.shape.representative_point()
        return np.array([point.x, point.y])


class Mended(NamedTuple):
    """Regions of loops; area changed by repairs and area of dropped slivers, mm^2."""

    regions: tuple[Region, ...]
    changed: float
    dropped: float

    def issues(self, layer: int | None = None) -> tuple[Issue, ...]:
        """Return notes about repairs and slivers for the user."""
        repair_notes = []
        if self.changed > 0.0:
            text = Text(
                "contours that cross or touch were repaired; {:.3g} mm^2 changed", self.changed
            )
            repair_notes.append(Issue(NOTE, "REGION_MENDED", text, layer))
        if self.dropped > 0.0:
            repair_notes.append(
                Issue(
                    NOTE,
                    "REGION_SLIVERS",
                    Text("slivers of {:.3g} mm^2 were removed", self.dropped),
                    layer,
                )
            )
        return tuple(repair_notes)


def regions(
    loops: Sequence[Array], least_area: float | None = None, every_point: bool = False
) -> tuple[Region, ...]:
    """Return the regions that closed loops bound; islands in holes are separate regions.

    Parameters
    ----------
    loops : sequence of (n, 2) array
        Closed loops, mm, material to their left.
    least_area : float, optional
        Minimum area of a piece, mm^2; by default SLIVER of the squared extent.
    every_point : bool, optional
        Keep collinear points, such as points of lines in (u, v) that bend when unrolled.

    Returns
    -------
    tuple of Region
        Regions in the order of their leftmost points.
    """
    return mended(loops, least_area, every_point).regions


def mended(
    loops: Sequence[Array], least_area: float | None = None, every_point: bool = False
) -> Mended:
    """Return regions as `regions`; crossing loops enclose points with a positive winding number.

    Parameters
    ----------
    loops : sequence of (n, 2) array
        Closed loops, mm, material to their left.
    least_area : float, optional
        Minimum area of a piece, mm^2; by default SLIVER of the squared extent.
    every_point : bool, optional
        Keep collinear points.

    Returns
    -------
    Mended
        The regions, and the areas changed and dropped, mm^2.
    """
    clean = [ring for loop in loops if len(ring := _distinct(np.asarray(loop, dtype=float))) > 2]
    if not clean:
        return Mended((), 0.0, 0.0)
    extent = float(np.hypot(*np.ptp(np.vstack(clean), axis=0)))
    least = SLIVER * extent**2 if least_area is None else least_area
    shape, changed = _nested(clean), 0.0
    if shape is None:
        shape, changed = _wound(clean)
    kept = _parts(_polygons(shape), least, every_point=every_point)
    dropped = max(float(shape.area) - sum(region.area for region in kept), 0.0)
    noise = SLIVER * extent**2
    return Mended(kept, changed if changed > noise else 0.0, dropped if dropped > noise else 0.0)


def along(
    curves: Sequence[tuple[Array, bool]], half: float | Array, chord_error: float
) -> tuple[Region, ...]:
    """Return the regions within a distance of curves.

    Parameters
    ----------
    curves : sequence of tuple of (n, 2) array and bool
        Points of each of k curves, mm, and whether it is closed.
    half : float or (k,) array
        Distance, common or per curve, mm.
    chord_error : float
        Chord error of arcs, mm; holes smaller than the squared chord error are filled.

    Returns
    -------
    tuple of Region
        Regions in the order of their leftmost points.
    """
    return _parts(_fill_pinholes(_bands(curves, half, chord_error), chord_error**2), 0.0)


def measure_bands(
    regions: Sequence[Region],
    curves: Sequence[tuple[Array, bool]],
    half: float | Array,
    chord_error: float,
    pane: Sequence[Region] = (),
) -> tuple[float, float]:
    """Measure the bands within `half` mm of curves, without gaps narrower than 2 WIDENING chord errors.

    Chords of neighbouring curves leave thousands of such gaps, whose union took most of the time of
    a filling.

    Parameters
    ----------
    regions : sequence of Region
        Regions that contain the curves.
    curves, half, chord_error
        As for `along`.
    pane : sequence of Region
        If not empty, only the bands inside these regions count.

    Returns
    -------
    inside, area : float
        Area of the bands inside the regions, and total area of the bands, mm^2.
    """
    wider = WIDENING * chord_error
    bands = _buffered(_bands(curves, half + wider, chord_error), -wider, chord_error)
    if pane:
        bands = bands.intersection(_union(pane))
    inside = math.fsum(float(region.shape.intersection(bands).area) for region in regions)
    return inside, float(bands.area)


def _bands(curves: Sequence[tuple[Array, bool]], half: float | Array, chord_error: float) -> Any:
    """Return the shape of the points within `half` mm of curves."""
    lines = [np.vstack([points, points[:1]]) if closed else points for points, closed in curves]
    widths = np.full(len(lines), half).tolist()
    return _bands_of(
        tuple(np.ascontiguousarray(line).tobytes() for line in lines), tuple(widths), chord_error
    )


@lru_cache(maxsize=4)
def _bands_of(contents: tuple[bytes, ...], widths: tuple[float, ...], chord_error: float) -> Any:
    """Return `_bands` of lines given as bytes.

    The cache serves gaps, cover and closing of a filling, which request the same bands in turn.
    """
    lines = [np.frombuffer(content).reshape(-1, 2) for content in contents]
    straight = [number for number, line in enumerate(lines) if len(line) == 2]
    bands = [
        _buffered(shapely().geometry.LineString(stretch), width, chord_error)
        for line, width in zip(lines, widths)
        if len(line) > 2
        for stretch in _bends(line)
    ]
    if straight:
        edges = np.array([lines[number] for number in straight])
        radii = np.array([widths[number] for number in straight])
        segments = np.array([_quarter_segments(radius, chord_error) for radius in radii])
        bands += [
            _capsules(edges[segments == count], radii[segments == count], count)
            for count in set(segments.tolist())
        ]
    return shapely().ops.unary_union(bands)


def _capsules(edges: Array, radii: Array, segments: int) -> Any:
    """Return capsules of radii (n,) mm about edges (n, 2, 2) as one shape of n polygons.

    The polygons may overlap. segments: segments per quarter circle. Shapely buffers edges one by
    one, which takes eight times as long; the corners are the same.
    """
    start, end = edges[:, 0], edges[:, 1]
    size = np.hypot(*(end - start).T)[:, None]
    along = np.where(size > 0.0, (end - start) / np.maximum(size, 1e-300), [1.0, 0.0])
    left = np.stack([-along[:, 1], along[:, 0]], axis=1)
    angle = np.linspace(0.0, math.pi, 2 * segments + 1)[:, None]
    cap = radii[:, None, None] * (np.sin(angle) * along[:, None] - np.cos(angle) * left[:, None])
    corners = np.concatenate(
        [end[:, None] + cap, start[:, None] - cap, (end + cap[:, 0])[:, None]], axis=1
    )
    ring = np.dtype([("order", "u1"), ("counts", "<u4", 3), ("corners", "<f8", corners.shape[1:])])
    rings = np.zeros(len(edges), dtype=ring)
    rings["order"], rings["corners"] = 1, corners
    rings["counts"] = _POLYGON, 1, corners.shape[1]  # polygons of one ring
    head = np.array([(1, (_MULTI_POLYGON, len(edges)))], dtype=[("order", "u1"), ("is", "<u4", 2)])
    return shapely().wkb.loads(head.tobytes() + rings.tobytes())


def _fill_pinholes(shape: Any, area: float) -> list[Any]:
    """Return the polygons of a shape without holes below an area (mm^2).

    Chords of arcs leave thousands of such holes between bands.
    """
    polygons = []
    for polygon in _polygons(shape):
        outer, *holes = _closed_rings(polygon)
        large = [hole for hole in holes if abs(doubled_area(hole[:-1])) >= 2.0 * area]
        if len(large) < len(holes):
            polygon = shapely().geometry.Polygon(outer, large)
        polygons.append(polygon)
    return polygons


def _union(regions: Sequence[Region]) -> Any:
    return shapely().ops.unary_union([region.shape for region in regions])


def join(parts: Sequence[Region], width: float) -> tuple[Region, ...]:
    """Close slits thinner than `width` mm in and between regions of a plane.

    Returns the given regions if there are no slits, or only short slits.
    """
    error = FINE_SLIT * width
    grown = [_buffered(part.shape, 0.5 * width, error) for part in parts]
    shape = shapely().ops.unary_union(grown)
    if len(_polygons(shape)) == len(parts) and not any(
        _has_slit(part.shape, wider, width) for part, wider in zip(parts, grown)
    ):
        return tuple(parts)  # rounded corners of many parts are not slits
    shape = _buffered(shape, -0.5 * width, error)
    if sum(part.shape.length for part in parts) - shape.length < LONG_SLIT * width:
        return tuple(parts)
    return _parts(_polygons(shape), SLIVER * shape.area)


def _has_slit(shape: Any, wider: Any, width: float) -> bool:
    """Return whether a polygon has a long slit thinner than `width` mm.

    wider: the polygon grown by half of `width`.
    """
    closed = _buffered(wider, -0.5 * width, FINE_SLIT * width)
    return bool(shape.length - closed.length >= LONG_SLIT * width)


def _bends(line: Array) -> list[Array]:
    """Split a line (n, 2) into pieces that do not run alongside themselves.

    Otherwise shapely may fill enclosed areas or return a self-intersecting shape.
    """
    if len(line) < 3:
        return [line]
    way = line[1:] - line[:-1]
    heading = np.arctan2(way[:, 1], way[:, 0])
    turn = np.abs(np.remainder(heading[1:] - heading[:-1] + math.pi, 2.0 * math.pi) - math.pi)
    number = np.floor(running_sums(turn) / BEND + np.arange(len(way)) / AT_ONCE)
    if number[-1] < 1.0:
        return [line]
    cuts = [0, *(np.flatnonzero(np.diff(number) > 0.0) + 1).tolist(), len(way)]
    return [line[a : b + 1] for a, b in zip(cuts, cuts[1:])]


def simplified(points: Array, tolerance: float, closed: bool = False) -> Array:
    """Simplify a curve within a tolerance.

    Parameters
    ----------
    points : (n, 2) array
        The curve, mm.
    tolerance : float
        Maximum distance of dropped points from the result, mm.
    closed : bool, optional
        Whether the curve is closed, without its first point repeated.

    Returns
    -------
    (m, 2) array
        Remaining points; the first, and the last of an open curve, are kept.
    """
    whole = np.vstack([points, points[:1]]) if closed else points
    found: Array = whole[select_simplified(whole, tolerance)]
    return found[:-1] if closed else found


def select_simplified(points: Array, tolerance: float) -> Index:
    """Select the points of an open curve that `simplified` keeps.

    Parameters
    ----------
    points : (n, 2) array
        The curve, mm.
    tolerance : float
        Maximum distance of dropped points from the result, mm.

    Returns
    -------
    (m,) array of int
        Indices of the points, rising.
    """
    numbered = np.column_stack([np.round(points, DIGITS), np.arange(len(points))])
    line = shapely().geometry.LineString(numbered).simplify(tolerance, preserve_topology=False)
    return np.array(line.coords, dtype=float)[:, 2].astype(np.intp)


def _buffered(shape: Any, distance: float, chord_error: float) -> Any:
    return shape.buffer(distance, **{shapely().arcs: _quarter_segments(distance, chord_error)})


def _quarter_segments(distance: float, chord_error: float) -> int:
    return math.ceil(turn_segments(abs(distance), chord_error, 2.0 * math.pi, LEAST_ARC) / 4)


def _distinct(loop: Array) -> Array:
    """Drop points of a loop that repeat the previous point."""
    if len(loop) == 0:
        return loop
    away = np.abs(loop - np.roll(loop, 1, axis=0)).max(axis=1)
    kept: Array = loop[away > MERGED * max(float(np.ptp(loop, axis=0).max()), 1e-300)]
    return kept


def _nested(loops: list[Array]) -> Any:
    """Build the shape of loops that bound regions without repair; None if they do not."""
    geometry = shapely().geometry
    turned = [doubled_area(loop) for loop in loops]
    outers = [loop for loop, area in zip(loops, turned) if area > 0.0]
    sizes = np.array([area for area in turned if area > 0.0])
    holes: list[list[Array]] = [[] for _ in outers]
    for hole in (loop for loop, area in zip(loops, turned) if area <= 0.0):
        about = [k for k, outer in enumerate(outers) if winding((outer,), hole[:1])[0] > 0]
        if not about:
            return None
        holes[about[int(np.argmin(sizes[about]))]].append(hole)
    polygons = [geometry.Polygon(outer, inner) for outer, inner in zip(outers, holes)]
    shape = polygons[0] if len(polygons) == 1 else geometry.MultiPolygon(polygons)
    return shape if shape.is_valid else None


def _wound(loops: list[Array]) -> tuple[Any, float]:
    """Return the shape of positive winding numbers, and the area changed, mm^2."""
    library = shapely()
    lines = library.ops.unary_union(
        [library.geometry.LineString(np.vstack([loop, loop[:1]])) for loop in loops]
    )
    faces = list(library.ops.polygonize(lines))
    if not faces:
        return library.geometry.Polygon(), 0.0
    spots = np.array([[spot.x, spot.y] for spot in (face.representative_point() for face in faces)])
    count = winding(loops, spots)
    inside = count > 0
    area = np.array([face.area for face in faces])
    kept = library.ops.unary_union([face for face, is_in in zip(faces, inside) if is_in])
    return kept, float((np.abs(count - inside) * area).sum())


def _drop_fourth(ring: Array, tolerance: float) -> Array:
    """Drop a collinear point, within a tolerance (mm), from a ring (n, 2) of four points."""
    if len(ring) != 4:
        return ring
    along = np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0)
    gap = ring - np.roll(ring, 1, axis=0)
    off = np.abs(along[:, 0] * gap[:, 1] - along[:, 1] * gap[:, 0]) / np.hypot(*along.T)
    straight = int(np.argmin(off))
    return ring if off[straight] > tolerance else np.delete(ring, straight, axis=0)


def _at_corner(ring: Array) -> Array:
    """Start a ring (n, 2) at its sharpest corner if its first point is collinear.

    Mesh sections may begin at a redundant point on a straight edge, and simplification keeps the
    first point of a ring.
    """
    edge = ring[1] - ring[-1]
    gap = ring[0] - ring[-1]
    if abs(edge[0] * gap[1] - edge[1] * gap[0]) > ON_EDGE * max(float(np.hypot(*edge)), 1e-300):
        return ring
    way = np.roll(ring, -1, axis=0) - ring
    before = np.roll(way, 1, axis=0)
    turn = np.abs(
        np.arctan2(
            before[:, 0] * way[:, 1] - before[:, 1] * way[:, 0], np.einsum("ni,ni->n", before, way)
        )
    )
    return np.roll(ring, -int(np.argmax(turn >= turn.max() - SAME_TURN)), axis=0)


def _closed_rings(polygon: Any) -> list[Array]:
    """Return the rings (n, 2) of a polygon, outer ring first; each repeats its first point.

    The rings are read from well-known binary (WKB). Shapely below version 2 creates an object per
    ring, which took a third of the time for filling a solid.
    """
    data = polygon.wkb
    numbers = "<u4" if data[0] == 1 else ">u4"
    coordinates = "<f8" if data[0] == 1 else ">f8"
    number = int(np.frombuffer(data, numbers, 1, 5)[0])
    rings, position = [], 9
    for _ in range(number):
        size = int(np.frombuffer(data, numbers, 1, position)[0])
        ring = np.frombuffer(data, coordinates, 2 * size, position + 4)
        rings.append(ring.astype(float).reshape(size, 2))
        position += 4 + 16 * size
    return rings


def _ring(points: Array, sense: float) -> Array:
    """Return a closed ring (n + 1, 2) as a border (n, 2) that begins at its leftmost point."""
    x, y = points[:, 0] - points[0, 0], points[:, 1] - points[0, 1]
    points = points[:-1] if (x[:-1] @ y[1:] - x[1:] @ y[:-1]) * sense >= 0.0 else points[-2::-1]
    leftmost = np.flatnonzero(
        points[:, 0] <= points[:, 0].min() + STRAIGHTNESS_TOLERANCE * _extent(points)
    )
    first = int(leftmost[np.argmin(points[leftmost, 1])])
    return np.concatenate([points[first:], points[:first]])


def _parts(
    polygons: Sequence[Any], least_area: float, sheet: float = 0.0, every_point: bool = False
) -> tuple[Region, ...]:
    """Return polygons larger than an area (mm^2), in the order of their leftmost points."""
    kept_regions = [
        Region(part if every_point else _plain(part), sheet)
        for part in polygons
        if part.area > least_area
    ]
    if len(kept_regions) < 2:
        return tuple(kept_regions)
    # rounded, so that last bits do not order regions in a column
    return tuple(
        sorted(kept_regions, key=lambda region: region.borders()[0][0].round(DIGITS).tolist())
    )


def _cut_hairs(polygons: Sequence[Any], hair: float) -> list[Any]:
    """Cut polygons at connections up to `hair` mm wide, which come from rounding errors."""
    corners = {"join_style": _MITRE, "mitre_limit": SHARPEST}
    pieces = []
    for polygon in polygons:
        cores = _polygons(polygon.buffer(-hair, **corners))
        pieces += [core.buffer(hair, **corners) for core in cores] if len(cores) > 1 else [polygon]
    return [part for each in pieces for part in _polygons(each)]


def _plain(polygon: Any) -> Any:
    """Drop points and spikes of a polygon that come from rounding errors.

    They differ between versions of shapely and would change results inside regions.
    """
    rings = [ring[:-1] for ring in _closed_rings(polygon)]
    tolerance = STRAIGHTNESS_TOLERANCE * _extent(rings[0])
    plain = [_drop_straight(ring, tolerance) for ring in rings]
    if all(len(ring) == len(before) for ring, before in zip(plain, rings)):
        return polygon
    if len(plain[0]) < 3:
        return polygon
    made = shapely().geometry.Polygon(plain[0], [hole for hole in plain[1:] if len(hole) > 2])
    return made if made.is_valid else polygon


def _drop_straight(ring: Array, tolerance: float) -> Array:
    """Drop collinear points and tips of spikes from a ring (n, 2)."""
    while len(ring) > 2:
        into = ring - np.concatenate([ring[-1:], ring[:-1]])
        out = np.concatenate([into[1:], into[:1]])
        longer = np.sqrt(np.maximum((into**2).sum(axis=1), (out**2).sum(axis=1)))
        aside = np.abs(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0])
        needless = aside <= tolerance * longer
        if not needless.any():
            break
        ring = ring[~_every_other(needless)]
    return ring


def _every_other(marked: Mask) -> Mask:
    """Keep every other mark of each run of marks (n,) around a ring, beginning with the first."""
    first = int(np.argmin(marked))
    marked = np.roll(marked, -first)
    number = np.arange(len(marked))
    before = np.maximum.accumulate(np.where(marked, 0, number))
    return np.asarray(np.roll(marked & ((number - before) % 2 == 1), first), dtype=bool)


def _extent(points: Array) -> float:
    return float(np.hypot(*np.ptp(points, axis=0)))


def _polygons(shape: Any) -> list[Any]:
    if shape.geom_type == "Polygon":
        return [] if shape.is_empty else [shape]
    return [part for item in getattr(shape, "geoms", ()) for part in _polygons(item)]


def _larger(shape: Any, least_area: float, least_extent: float) -> list[Any]:
    """Return the polygons of a shape larger than an area, mm^2, and a diagonal of the bounding box, mm.

    Chords of neighbouring borders leave thousands of slivers, and shapely 1.8 takes longer to hand
    over a polygon than to find it; so slivers are dropped in well-known binary (WKB).
    """
    if shape.geom_type != "MultiPolygon":
        return [polygon for polygon in _polygons(shape) if polygon.area > least_area]
    binary = shape.wkb
    order = "<" if binary[0] == 1 else ">"
    (count,) = struct.unpack_from(f"{order}I", binary, 5)
    read = struct.Struct(f"{order}II").unpack_from  # count of rings; count of points of the first
    ring_size = struct.Struct(f"{order}I").unpack_from
    position, polygons, firsts, sizes = 9, [], [], []
    for _ in range(count):
        start = position
        rings, size = read(binary, position + 5)
        firsts.append(position + 13)
        sizes.append(size)
        position += 13 + 16 * size
        for _ in range(rings - 1):
            position += 4 + 16 * ring_size(binary, position)[0]
        polygons.append((start, position))
    areas, extents = _ring_sizes(binary, np.array(firsts), np.array(sizes), f"{order}f8")
    large = (areas > SIZE_MARGIN * least_area) & (extents >= SIZE_MARGIN * least_extent)
    candidates = [shapely().wkb.loads(binary[slice(*polygons[k])]) for k in np.flatnonzero(large)]
    return [polygon for polygon in candidates if polygon.area > least_area]


def _ring_sizes(binary: bytes, starts: Index, sizes: Index, kind: str) -> tuple[Array, Array]:
    """Return area (k,), mm^2, and diagonal of the bounding box (k,), mm, of closed rings in bytes.

    starts: (k,) first bytes. sizes: (k,) counts of points; the last repeats the first.
    """
    firsts = np.cumsum(sizes) - sizes
    places = np.repeat(starts - 16 * firsts, sizes) + 16 * np.arange(sizes.sum())
    coordinate_bytes = np.frombuffer(binary, dtype=np.uint8)[places[:, None] + np.arange(16)]
    points = coordinate_bytes.view(kind).astype(float)
    low, high = (function.reduceat(points, firsts) for function in (np.minimum, np.maximum))
    offset = points - np.repeat(points[firsts], sizes, axis=0)
    cross = np.zeros(len(points))
    cross[:-1] = offset[:-1, 0] * offset[1:, 1] - offset[1:, 0] * offset[:-1, 1]
    cross[firsts + sizes - 1] = 0.0  # from one ring to the next
    return 0.5 * np.abs(np.add.reduceat(cross, firsts)), np.hypot(*(high - low).T)


ASPECT = 1e-3  # slope of the curve of values, so that only values affect simplification


def select_significant(positions: Array, values: Array, tolerance: float) -> Mask:
    """Select the values required for linear interpolation within a tolerance.

    Parameters
    ----------
    positions : (n,) array
        Positions in ascending order.
    values : (n,) array
        Values at the positions.
    tolerance : float
        Error of interpolated values, in the unit of the values.

    Returns
    -------
    (n,) array of bool
        True for values to keep, including the first and the last.
    """
    positions, values = np.round(positions, DIGITS), np.round(values, DIGITS)
    stretch = float(np.ptp(values)) / (ASPECT * max(float(np.ptp(positions)), 1e-300))
    if not stretch > 0.0:
        return np.asarray(np.isin(np.arange(len(positions)), (0, len(positions) - 1)), dtype=bool)
    line = np.round(np.stack([positions * stretch, values], axis=1), DIGITS)
    return np.asarray(np.isin(line[:, 0], simplified(line, tolerance)[:, 0]), dtype=bool)
