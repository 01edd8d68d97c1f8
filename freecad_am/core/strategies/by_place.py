# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings by place: where their conditions hold on a toolpath, and beads cut where they change.

A bead gets a point where a condition begins or ends to hold, and stays one deposit. Points are added
on the chords, so that beads keep their length. A surface belongs to its zone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..collision import tree
from ..collision.inside import inside_of
from ..geometry.columns import dots, lengths
from ..geometry.mesh.triangle_mesh import closest, cut_evenly
from ..geometry.obstacles import Body
from ..issues import WARNING, InputError, Issue, Text
from ..parameters.process import ProcessParameters
from ..parameters.settings import WHERE, Setting
from ..toolpath import Bead, Toolpath
from ..types import Array, Index, Integers, Mask

UNUSED_CODE = "SETTING_UNUSED"
SURFACE_MM = 1e-4  # mm; points this close to the surface of a solid belong to it
EXACT_MM = 1e-6  # mm; tolerance of boxes, heights and distances
MIN_PIECE_MM = 2.5e-3  # mm; a shorter piece would be a move that no controller resolves
MIN_PIECE_S = 1.1e-4  # s; likewise
BATCH = 1024  # segments or points searched at once
SAMPLES = 50_000  # points of faces, from which distances are estimated


class Zone(NamedTuple):
    """The geometry of the conditions of a setting, in part coordinates.

    solid: a closed solid or mesh. faces: (m, 3, 3) triangles, mm, of the faces.
    """

    solid: Body | None = None
    faces: Array | None = None


class TriangleSearch:
    """Triangles near boxes, found by a tree of boxes."""

    def __init__(self, corners: Array) -> None:
        self.corners = corners[tree.packed(corners.mean(axis=1))]
        self._levels = []
        for size in tree.sizes(len(corners)):
            starts = np.arange(0, len(corners), size)
            low = np.minimum.reduceat(self.corners.min(axis=1), starts)
            high = np.maximum.reduceat(self.corners.max(axis=1), starts)
            self._levels.append((low, high))

    def pairs(self, low: Array, high: Array) -> tuple[Index, Index]:
        """Return the pairs of boxes and triangles whose bounding boxes meet.

        Parameters
        ----------
        low, high : (n, 3) array
            Corners of the boxes, mm.

        Returns
        -------
        box, triangle : (k,) int array
            Indices of boxes, and of triangles in `corners`.
        """
        box, node = tree.each_with_each(len(low), len(self._levels[-1][0]))
        for depth in range(len(self._levels) - 1, -1, -1):
            lows, highs = self._levels[depth]
            for axis in range(3):
                meet = (low[box, axis] <= highs[node, axis]) & (high[box, axis] >= lows[node, axis])
                box, node = box[meet], node[meet]
            if depth:
                box, node = tree.below(box, node, len(self._levels[depth - 1][0]))
        return box, node


@dataclass(frozen=True, eq=False)
class _Segments:
    """All n segments of a toolpath.

    start, end: (n, 3) mm. layer: (n,). build: (n, 3) unit build directions. up: (3,) unit vector of the
    stacking direction, along which heights count from `ground`, mm.
    """

    start: Array
    end: Array
    layer: Index
    build: Array
    up: Array
    ground: float

    def at(self, rows: Index, shares: Array) -> Array:
        """Return the points (k, 3) at fractions of segments."""
        return self.start[rows] + shares[:, None] * (self.end[rows] - self.start[rows])


Cuts = tuple[Index, Array]  # segments (k,) and the fractions (k,) at which a condition may change
Holds = Callable[
    [Index, Array], Mask
]  # whether a condition holds at points (k, 3) of segments (k,)


@dataclass(frozen=True, eq=False)
class _Condition:
    """Where a condition may change, and whether it holds."""

    cuts: Cuts
    holds: Holds


def _levels(values: Array, ends: Array, levels: Sequence[float]) -> Cuts:
    """Return where a value that is linear on segments passes levels. values, ends: (n,)."""
    rows, shares = [], []
    for level in levels:
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (level - values) / (ends - values)
        passed = np.flatnonzero((share > 0.0) & (share < 1.0))
        rows.append(passed)
        shares.append(share[passed])
    return _join_cuts(rows, shares)


def _join_cuts(rows: Sequence[Index], shares: Sequence[Array]) -> Cuts:
    if not rows:
        return np.zeros(0, dtype=np.intp), np.zeros(0)
    return np.concatenate(rows), np.concatenate(shares)


def _distances(corners: Array, points: Array) -> Array:
    """Return the distances (k,) of points (k, 3) from triangles (k, 3, 3)."""
    return closest(corners[:, 0], corners[:, 1], corners[:, 2], points)[0]


def _layer_condition(segments: _Segments, setting: Setting) -> _Condition:
    lowest = -1 if setting.first_layer is None else setting.first_layer
    highest = np.inf if setting.last_layer is None else setting.last_layer
    active = (segments.layer >= lowest) & (segments.layer <= highest)
    return _Condition(_join_cuts((), ()), lambda rows, points: active[rows])


def _height_condition(segments: _Segments, setting: Setting) -> _Condition:
    low = -np.inf if setting.low is None else setting.low - EXACT_MM
    high = np.inf if setting.high is None else setting.high + EXACT_MM
    start, end = (ends @ segments.up - segments.ground for ends in (segments.start, segments.end))

    def holds(rows: Index, points: Array) -> Mask:
        height = points @ segments.up - segments.ground
        return np.asarray((height >= low) & (height <= high))

    return _Condition(
        _levels(start, end, [level for level in (low, high) if np.isfinite(level)]), holds
    )


def _box_condition(segments: _Segments, setting: Setting) -> _Condition:
    assert setting.box is not None
    low = np.array(setting.box[:3]) - EXACT_MM
    high = np.array(setting.box[3:]) + EXACT_MM
    cuts = [
        _levels(segments.start[:, axis], segments.end[:, axis], (low[axis], high[axis]))
        for axis in range(3)
    ]

    def holds(rows: Index, points: Array) -> Mask:
        return np.asarray(((points >= low) & (points <= high)).all(axis=1))

    return _Condition(_join_cuts(*zip(*cuts)), holds)


def _solid_condition(segments: _Segments, solid: Body) -> _Condition:
    inside, search = inside_of(solid), TriangleSearch(solid.corners())
    if inside is None:
        raise InputError(
            "OPEN_MESH",
            f"{WHERE}.where.inside",
            "{} is open, so it has no inside; close it, or use a closed solid or a box",
            solid.name,
        )

    def find_crossings(segment: Index, triangle: Index) -> Cuts:
        start, corner = segments.start[segment], search.corners[triangle]
        direction = segments.end[segment] - start
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        height = dots(normal, start - corner[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            share = -height / dots(normal, direction)
        passes = (share > 0.0) & (share < 1.0)
        segment, share = segment[passes], share[passes]
        # a hit beside the triangle does no harm, as only changes cut a bead
        hit = _distances(corner[passes], segments.at(segment, share)) < SURFACE_MM
        return segment[hit], share[hit]

    def holds(rows: Index, points: Array) -> Mask:
        active = np.zeros(len(points), dtype=bool)
        close = np.flatnonzero(
            ((points >= inside.low - SURFACE_MM) & (points <= inside.high + SURFACE_MM)).all(axis=1)
        )
        build = segments.build[rows[close]]
        direction = segments.end[rows[close]] - segments.start[rows[close]]
        side = np.cross(build, direction)
        side /= np.maximum(lengths(side), 1e-300)[:, None]
        for offset in (build, -build, side, -side):
            active[close] |= inside.holds(points[close] + SURFACE_MM * offset)
        return active

    return _Condition(_search_cuts(segments, search, 0.0, find_crossings), holds)


def _search_cuts(
    segments: _Segments,
    search: TriangleSearch,
    reach: float,
    cut: Callable[[Index, Index], Cuts],
    among: Index | None = None,
) -> Cuts:
    """Return the cuts of segments by the triangles within `reach`, mm, of their boxes.

    among: (k,) the segments that may be cut; None for all.
    """
    rows_among = np.arange(len(segments.start)) if among is None else among
    rows, shares = [], []
    for begin in range(0, len(rows_among), BATCH):
        batch = rows_among[begin : begin + BATCH]
        start, end = segments.start[batch], segments.end[batch]
        pairs = search.pairs(
            np.minimum(start, end) - reach - EXACT_MM, np.maximum(start, end) + reach + EXACT_MM
        )
        for box, triangle in tree.parts(*pairs):
            search_cuts = cut(batch[box], triangle)
            rows.append(search_cuts[0])
            shares.append(search_cuts[1])
    return _join_cuts(rows, shares)


def _roots(square: Array, linear: Array, constant: Array) -> Iterator[Array]:
    """Yield the two solutions of square t^2 + 2 linear t + constant = 0; NaN without any."""
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(linear * linear - square * constant)
        for sign in (-1.0, 1.0):
            yield (-linear + sign * root) / square


def _face_condition(segments: _Segments, faces: Array, within: float) -> _Condition:
    search = TriangleSearch(faces)
    edge = float(lengths((faces - np.roll(faces, 1, axis=1)).reshape(-1, 3)).max())
    longest = max(0.5 * within, edge * float(np.sqrt(0.5 * len(faces) / SAMPLES)))
    samples = cKDTree(cut_evenly(faces, longest)[0].reshape(-1, 3))

    def estimate(points: Array) -> Array:
        """Return distances (k,) that are exact or up to `longest` too large."""
        return np.asarray(samples.query(points)[0])

    def find_borders(segment: Index, triangle: Index) -> Cuts:
        """Where the distance from a triangle may be `within`: at offset planes, round its edges and corners."""
        corner = search.corners[triangle]
        start = segments.start[segment]
        direction = segments.end[segment] - start
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        normal /= np.maximum(lengths(normal), 1e-300)[:, None]
        candidates = []
        with np.errstate(divide="ignore", invalid="ignore"):
            for sign in (-1.0, 1.0):
                offset = dots(normal, corner[:, 0] - start) + sign * within
                candidates.append(offset / dots(normal, direction))
        for k in range(3):
            from_corner = start - corner[:, k]
            edge = corner[:, (k + 1) % 3] - corner[:, k]
            edge /= np.maximum(lengths(edge), 1e-300)[:, None]
            across = direction - dots(direction, edge)[:, None] * edge
            beside = from_corner - dots(from_corner, edge)[:, None] * edge
            for u, v in ((direction, from_corner), (across, beside)):
                candidates += _roots(dots(u, u), dots(u, v), dots(v, v) - within * within)
        rows, shares = [], []
        for share in candidates:
            good = np.flatnonzero((share > 0.0) & (share < 1.0))
            points = segments.at(segment[good], share[good])
            distance = _distances(corner[good], points)
            exact = np.abs(distance - within) < SURFACE_MM
            rows.append(segment[good][exact])
            shares.append(share[good][exact])
        return _join_cuts(rows, shares)

    def holds(rows: Index, points: Array) -> Mask:
        about = estimate(points)
        active = about <= within
        unsure = np.flatnonzero(~active & (about - longest <= within + EXACT_MM))
        for begin in range(0, len(unsure), BATCH):
            batch = unsure[begin : begin + BATCH]
            reach = within + EXACT_MM
            for point, triangle in tree.parts(
                *search.pairs(points[batch] - reach, points[batch] + reach)
            ):
                distance = _distances(search.corners[triangle], points[batch[point]])
                active[batch[point[distance <= reach]]] = True
        return np.asarray(active)

    about, size = estimate(segments.start), lengths(segments.end - segments.start)
    may_change = (about + size > within) & (about - longest - size <= within + EXACT_MM)
    return _Condition(
        _search_cuts(segments, search, within, find_borders, np.flatnonzero(may_change)), holds
    )


def _conditions(segments: _Segments, setting: Setting, zone: Zone) -> list[_Condition]:
    conditions = []
    if setting.first_layer is not None or setting.last_layer is not None:
        conditions.append(_layer_condition(segments, setting))
    if setting.low is not None or setting.high is not None:
        conditions.append(_height_condition(segments, setting))
    if setting.box is not None:
        conditions.append(_box_condition(segments, setting))
    if zone.solid is not None:
        conditions.append(_solid_condition(segments, zone.solid))
    if zone.faces is not None and setting.within is not None:
        conditions.append(_face_condition(segments, zone.faces, setting.within))
    return conditions


def apply_settings(
    toolpath: Toolpath, process: ProcessParameters, zones: Sequence[Zone], up: Array
) -> Toolpath:
    """Return the toolpath with beads cut where settings by place change, at the speeds of their places.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath of one feature.
    process : ProcessParameters
        The process with its settings by place.
    zones : sequence of Zone
        The geometry of each setting; empty if no setting has any.
    up : (3,) array
        Unit vector of the stacking direction, part coordinates.

    Returns
    -------
    Toolpath
        The toolpath, with a warning for each setting whose place no bead meets. Unchanged without
        settings.

    Raises
    ------
    InputError
        OPEN_MESH for a zone without an inside.
    """
    if not process.settings:
        return toolpath
    beads = [bead for _, _, bead in toolpath]
    segments = _segments(toolpath, up)
    zones = zones or (Zone(),) * len(process.settings)
    conditions = [
        _conditions(segments, setting, zone)
        for setting, zone in zip(process.settings, zones, strict=True)
    ]
    own_speeds = [setting.travel_speed or 0.0 for setting in process.settings]
    speeds = np.concatenate([np.maximum(bead.speed[1:], max(own_speeds)) for bead in beads])
    spans = _divide_segments(
        segments, [condition for group in conditions for condition in group], speeds
    )
    active = np.zeros(len(spans.row), dtype=np.int64)
    middles = segments.at(spans.row, 0.5 * (spans.begin + spans.end))
    for number, group in enumerate(conditions):
        holds = np.ones(len(active), dtype=bool)
        for condition in group:
            rows = np.flatnonzero(holds)
            holds[rows] = condition.holds(spans.row[rows], middles[rows])
        active |= holds.astype(np.int64) << number
    return _cut_toolpath(toolpath, process, spans, active)


def _segments(toolpath: Toolpath, up: Array) -> _Segments:
    beads = list(toolpath)
    points = [bead.points for _, _, bead in beads]
    counts = [len(bead) - 1 for _, _, bead in beads]
    return _Segments(
        np.concatenate([rows[:-1] for rows in points]),
        np.concatenate([rows[1:] for rows in points]),
        np.repeat([layer for layer, _, _ in beads], counts),
        np.concatenate([bead.build[1:] for _, _, bead in beads]),
        up,
        min(float((rows @ up).min()) for rows in points),
    )


class _Spans(NamedTuple):
    """Pieces of segments between possible changes, in order: segment (k,), its fractions (k,)."""

    row: Index
    begin: Array
    end: Array


def _divide_segments(
    segments: _Segments, conditions: Sequence[_Condition], speeds: Array
) -> _Spans:
    """Return the pieces of all segments; none is too short for a controller. speeds: (n,) mm/s."""
    count = len(segments.start)
    row, share = _join_cuts(*zip(*(condition.cuts for condition in conditions)))
    order = np.lexsort((share, row))
    row, share = row[order], share[order]
    size = lengths(segments.end - segments.start)
    shortest = np.maximum(MIN_PIECE_MM, MIN_PIECE_S * speeds) / np.maximum(size, 1e-300)
    inside = (share > shortest[row]) & (share < 1.0 - shortest[row])
    row, share = row[inside], share[inside]
    kept_rows = _select_spaced(row, share, shortest)
    row, share = row[kept_rows], share[kept_rows]
    rows = np.sort(np.r_[np.arange(count), row])
    begin, end = np.zeros(len(rows)), np.ones(len(rows))
    begin_row = np.flatnonzero(np.r_[True, np.diff(rows) > 0])
    later_rows = np.setdiff1d(np.arange(len(rows)), begin_row)
    begin[later_rows], end[later_rows - 1] = share, share
    return _Spans(rows, begin, end)


def _select_spaced(row: Index, share: Array, shortest: Array) -> Index:
    """Return the cuts that keep the shortest distance from the last kept one of their segment."""
    close = (np.diff(row) == 0) & (np.diff(share) < shortest[row[1:]])
    if not close.any():
        return np.arange(len(row))
    kept_rows: list[int] = []
    for k in range(len(row)):  # only runs with cuts that are nearly equal come here
        if (
            not kept_rows
            or row[kept_rows[-1]] != row[k]
            or share[k] - share[kept_rows[-1]] >= shortest[row[k]]
        ):
            kept_rows.append(k)
    return np.array(kept_rows)


def _cut_toolpath(
    toolpath: Toolpath, process: ProcessParameters, spans: _Spans, active: Integers
) -> Toolpath:
    """Return the toolpath with points between pieces with other settings. active: (k,) sums of 2^entry of the pieces."""
    same_row = np.diff(spans.row) == 0
    changes = np.flatnonzero(same_row & (np.diff(active) != 0)) + 1
    stays = np.r_[True, ~same_row | (np.diff(active) != 0)]
    cut_row, cut_share = spans.row[changes], spans.begin[changes]
    kept_row, kept_held = spans.row[stays], active[stays]
    begin_row = 0
    layers = list(toolpath.layers)
    for number, layer in enumerate(layers):
        beads = []
        for bead in layer.beads:
            end_row = begin_row + len(bead) - 1
            own_cuts = slice(*np.searchsorted(cut_row, (begin_row, end_row)))
            own_settings = kept_held[slice(*np.searchsorted(kept_row, (begin_row, end_row)))]
            beads.append(
                _cut_bead(
                    bead, process, cut_row[own_cuts] - begin_row, cut_share[own_cuts], own_settings
                )
            )
            begin_row = end_row
        layers[number] = replace(layer, beads=tuple(beads))
    return replace(
        toolpath,
        layers=tuple(layers),
        issues=(*toolpath.issues, *_unused_issues(process, active)),
    )


def _cut_bead(
    bead: Bead, process: ProcessParameters, row: Index, share: Array, active: Integers
) -> Bead:
    """Return a bead with points at fractions (k,) of segments, and the settings of each segment."""
    if not active.any():
        return bead
    if len(row):
        bead = bead.divided(row, share, on_chord=True)
    name, speed = bead.role.bead_class, bead.speed.copy()
    usual = process.for_class(name).travel_speed
    for combination in np.unique(active).tolist():
        factor = process.at_place(name, combination).travel_speed / usual
        if factor != 1.0:
            speed[1:][active == combination] *= factor
    speed[0] = speed[1]
    return replace(bead, speed=speed, settings=np.r_[active[0], active].astype(float))


def _unused_issues(process: ProcessParameters, active: Integers) -> list[Issue]:
    """Return a warning for each setting whose place no bead meets."""
    met_settings = int(np.bitwise_or.reduce(active)) if len(active) else 0
    return [
        Issue(
            WARNING,
            UNUSED_CODE,
            Text(
                "settings[{}] has no effect, because no bead meets its place ({}); move or enlarge "
                "the place, or remove the entry",
                number,
                " and ".join(setting.conditions()),
            ),
        )
        for number, setting in enumerate(process.settings)
        if not met_settings >> number & 1
    ]
