# SPDX-License-Identifier: LGPL-2.1-or-later
"""Starts of closed beads: near a point, at the sharpest corner, hidden from a viewer, or spread.

Places depend only on the beads and on parameters in part coordinates. A moved part has the same places.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.columns import crosses, dots, lengths, unit_rows
from ..geometry.curves.outline import CORNER
from ..geometry.frames import unit
from ..geometry.ramps import MIN_STEP, STEPS
from ..geometry.step_count import round_down
from ..issues import WARNING, InputError, Issue, Text
from ..parameters.process import (
    BY_ANGLE,
    BY_POINT,
    HIDDEN,
    SHARPEST,
    SPREAD,
    ProcessParameters,
    SeamParameters,
)
from ..toolpath import Bead, Scarf, Toolpath
from ..types import Array, Mask

NO_EFFECT = "NO_EFFECT"
SNAP_MM = 0.01  # mm; maximum distance at which a seam moves to an existing point of the bead
EQUAL_MM = 1e-6  # mm; places at distances that differ less are equally near
EQUAL_RAD = math.radians(1.0)  # corners whose turns differ less are equally sharp
LEAST_SENSE = 0.1  # cosine; a bead whose area is nearly along the layer has no sense of rotation
HALVINGS = 20  # iterations for the largest possible distance between starts
STEP_SHARE = 0.2  # of the shortest ramp step; a point this close to a step counts as its end
TOUCH_MM = 1e-7  # mm; stretches nearer to each other are one
BEFORE_START_MM = 1e-3  # mm; a place this far before the start of the bead counts as at the start


class SeamLocation(NamedTuple):
    """A place on a bead: index of a segment, and fraction of the segment."""

    segment: int
    share: float


START = SeamLocation(0, 0.0)


class _Loop:
    """A closed bead as a polyline.

    chords: (n, 3) mm. length: (n,) mm, of the chords. arc: (n + 1,) mm, from the start of the bead.
    """

    def __init__(self, bead: Bead) -> None:
        self.bead = bead
        self.chords = np.diff(bead.points, axis=0)
        self.length = lengths(self.chords)
        self.arc = np.r_[0.0, np.cumsum(self.length)]

    @property
    def total(self) -> float:
        """Length of the bead, mm."""
        return float(self.arc[-1])

    @property
    def sense(self) -> float:
        """1 if the bead runs counter-clockwise about its build directions, -1 if clockwise."""
        mean = self.bead.build[:-1].mean(axis=0)
        area = self.area
        share = float(area @ mean) / max(float(np.linalg.norm(area)), 1e-300)
        return -1.0 if share < -LEAST_SENSE else 1.0

    @property
    def area(self) -> Array:
        """Area vector (3,), mm2; the bead runs counter-clockwise about it."""
        points = self.bead.points - self.bead.points[0]
        return np.asarray(0.5 * np.cross(points[:-1], points[1:]).sum(axis=0))

    def location_at(self, arc: float) -> SeamLocation:
        """Return the place at an arc length, mm, from the start of the bead."""
        arc = arc % self.total
        segment = int(np.clip(np.searchsorted(self.arc, arc, "right") - 1, 0, len(self.length) - 1))
        return self.snapped(segment, (arc - float(self.arc[segment])) / float(self.length[segment]))

    def snapped(self, segment: int, share: float) -> SeamLocation:
        """Return a place, moved to a point of the bead that is nearer than SNAP_MM."""
        length = float(self.length[segment])
        if share * length <= SNAP_MM and share <= 0.5:
            return SeamLocation(segment, 0.0)
        if (1.0 - share) * length <= SNAP_MM:
            return SeamLocation((segment + 1) % len(self.length), 0.0)
        return SeamLocation(segment, share)

    def point(self, location: SeamLocation) -> Array:
        """Return the point (3,) of a place on the polyline, mm."""
        point: Array = (
            self.bead.points[location.segment] + location.share * self.chords[location.segment]
        )
        return point

    def nearest(self, target: Array) -> tuple[SeamLocation, float]:
        """Return the place nearest to a target (3,), and its distance, mm."""
        offset = target - self.bead.points[:-1]
        share = np.clip(dots(offset, self.chords) / self.length**2, 0.0, 1.0)
        distance = lengths(offset - share[:, None] * self.chords)
        segment = int(np.argmax(distance <= distance.min() + EQUAL_MM))
        return self.snapped(segment, float(share[segment])), float(distance[segment])


# ---- Rules: the candidate places of a bead


def find_corners(bead: Bead) -> tuple[Array, Mask]:
    """Return the corners of a closed bead.

    Parameters
    ----------
    bead : Bead
        The bead, n + 1 points.

    Returns
    -------
    turns : (n,) array
        Turn of the bead at each point, rad.
    outwards : (n,) bool array
        Whether the bead turns there in its own sense, so that a corner points out of the loop.
    """
    arriving = np.roll(unit_rows(bead.outline.arriving), 1, axis=0)
    leaving = unit_rows(bead.outline.leaving)
    turn_axis = crosses(np.ascontiguousarray(arriving), leaving)
    turns = np.arctan2(lengths(turn_axis), dots(arriving, leaving))
    return np.asarray(turns), _Loop(bead).sense * dots(turn_axis, bead.build[:-1]) > 0.0


def _sharpest(loop: _Loop) -> list[SeamLocation]:
    """Return the sharpest corners: those that point out of the loop, else those that point into it."""
    turns, outwards = find_corners(loop.bead)
    sharp = turns >= CORNER
    candidates = sharp & outwards if (sharp & outwards).any() else sharp
    if not candidates.any():
        return []
    candidates &= turns >= turns[candidates].max() - EQUAL_RAD
    return [SeamLocation(int(index), 0.0) for index in np.flatnonzero(candidates)]


def _hidden(loop: _Loop, direction: Array, tolerance: float) -> list[SeamLocation]:
    """Return the middles of the longest stretches farthest from a viewer in a direction (3,).

    A stretch is within `tolerance`, mm, of the farthest point. If the whole bead is, no side is hidden.
    """
    level = loop.bead.points @ direction
    level[-1] = level[0]  # a closed bead ends within rounding of its start
    limit = float(level.min()) + tolerance
    stretches = _stretches_below(loop, level, limit)
    if not stretches or max(end - start for start, end in stretches) >= loop.total - EQUAL_MM:
        return []
    longest = max(end - start for start, end in stretches)
    return [
        loop.location_at(0.5 * (start + end))
        for start, end in stretches
        if end - start >= longest - tolerance
    ]


def _stretches_below(loop: _Loop, level: Array, limit: float) -> list[tuple[float, float]]:
    """Return the stretches of a bead on which the level (n + 1,) is at most a limit.

    A stretch is a start and an end, mm along the bead; the end is past the bead's length if the
    stretch crosses its start.
    """
    inside = level <= limit
    start, end = level[:-1], level[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = loop.arc[:-1] + loop.length * (limit - start) / (end - start)
    enters = crossing[~inside[:-1] & inside[1:]]
    leaves = crossing[inside[:-1] & ~inside[1:]]
    if not len(enters):
        return [(0.0, loop.total)] if inside.all() else []
    if inside[0]:
        leaves = np.r_[leaves[1:], leaves[0] + loop.total]
    return list(zip(enters.tolist(), leaves.tolist(), strict=True))


def find_free_arc(
    loop: _Loop, starts_nearby: Array, distance: float, start: float, sense: float
) -> float | None:
    """Return the first arc length from a start at which a bead is far enough from points.

    The exact intervals of the chords inside the spheres about the points are excluded.

    Parameters
    ----------
    loop : _Loop
        The bead.
    starts_nearby : (m, 3) array
        The points, mm.
    distance : float
        Radius of the spheres, mm.
    start : float
        Arc length at which the search begins, mm.
    sense : float
        1 to search forwards along the bead, -1 backwards.

    Returns
    -------
    float or None
        The arc length, mm; None if the spheres hide the whole bead.
    """
    offset = loop.bead.points[:-1] - starts_nearby[:, None]
    along = (offset * loop.chords).sum(axis=2)
    square = loop.length**2
    inside = along**2 - square * ((offset**2).sum(axis=2) - distance**2)
    root = np.sqrt(np.maximum(inside, 0.0))
    low = np.clip((-along - root) / square, 0.0, 1.0)
    high = np.clip((-along + root) / square, 0.0, 1.0)
    rows, segments = np.nonzero((inside > 0.0) & (high > low))
    ends = loop.arc[segments] + np.stack([low, high])[:, rows, segments] * loop.length[segments]
    enter = (sense * (ends[0 if sense > 0.0 else 1] - start)) % loop.total
    leave = enter + ends[1] - ends[0]
    enter, leave = np.r_[enter, enter - loop.total], np.r_[leave, leave - loop.total]
    order = np.argsort(enter, kind="stable")
    order = order[leave[order] > 0.0]
    reached = np.maximum.accumulate(np.r_[0.0, leave[order]])
    gaps = np.r_[enter[order], np.inf] > reached + TOUCH_MM
    free = float(reached[int(np.argmax(gaps))])
    return None if free > loop.total - TOUCH_MM else (start + sense * free) % loop.total


def _farthest_arc(
    loop: _Loop, starts_nearby: Array, distance: float, start: float, sense: float
) -> float:
    """Return the arc length at which a bead is farthest from points, mm; arguments as in `find_free_arc`."""
    low, high, arc = 0.0, distance, start
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        free = find_free_arc(loop, starts_nearby, middle, start, sense)
        low, high, arc = (low, middle, arc) if free is None else (middle, high, free)
    return arc


# ---- Layers in print order


class SeamPlacer:
    """Choose the starts of closed beads, layer by layer.

    Of equal places, the place nearest to a start in the layer below is chosen, else the first place
    from the start that `process.seam.angle` gives. Spread starts move on counter-clockwise from layer to layer.
    """

    def __init__(self, seam: SeamParameters, chord_error: float, bead_width: float) -> None:
        """Create the placer; chord error and bead width in mm."""
        self._seam = seam
        self._tolerance = chord_error
        self._bead_width = bead_width
        self._below: Array = np.zeros((0, 3))
        self._applies = False  # whether any bead has a place by the rule
        self._without = 0  # number of closed beads without a place
        self._starts_below: Array = np.zeros((0, 3))  # of open beads too
        self._short: list[tuple[float, int]] = []  # distance from another start, mm, and layer
        self._nearest = (math.inf, 0)  # distance of the seam point, mm, and layer of that bead
        self._is_inside = False

    @property
    def is_active(self) -> bool:
        """Whether the start of any bead may differ from the start by angle."""
        return self._seam.position != BY_ANGLE

    def begin_stack(self) -> None:
        """Forget the layer below."""
        self._below = self._starts_below = np.zeros((0, 3))

    def choose_locations(self, beads: Sequence[Bead], layer: int) -> list[SeamLocation]:
        """Return the start of each bead of a layer; START for open beads.

        Parameters
        ----------
        beads : sequence of Bead
            Beads of the layer, the layer above those of the previous call.
        layer : int
            Index of the layer, for messages.

        Returns
        -------
        list of SeamLocation
            The starts.
        """
        locations = []
        starts: list[Array] = []
        open_starts = [bead.points[0] for bead in beads if not bead.closed]
        for bead in beads:
            if not bead.closed:
                locations.append(START)
                continue
            loop = _Loop(bead)
            starts_nearby = np.array([*open_starts, *starts]).reshape(-1, 3)
            locations.append(self._locate(loop, starts_nearby, layer))
            starts.append(loop.point(locations[-1]))
        if self._seam.position == BY_POINT:
            self._measure_point(beads, layer)
        self._below = np.array(starts).reshape(-1, 3)
        self._starts_below = np.array([*open_starts, *starts]).reshape(-1, 3)
        return locations

    def _locate(self, loop: _Loop, starts_nearby: Array, layer: int) -> SeamLocation:
        seam = self._seam
        if seam.position == SPREAD:
            return self._locate_apart(loop, np.vstack([starts_nearby, self._starts_below]), layer)
        if seam.position == BY_POINT:
            self._applies = True
            return loop.nearest(np.array(seam.point))[0]
        locations = (
            _sharpest(loop)
            if seam.position == SHARPEST
            else _hidden(loop, unit(np.array(seam.away_from)), self._tolerance)
        )
        self._applies |= bool(locations)
        self._without += not locations
        return self._preferred(loop, locations) if locations else START

    def _locate_apart(self, loop: _Loop, starts_nearby: Array, layer: int) -> SeamLocation:
        """Return the first place far enough from other starts (m, 3), else the farthest one."""
        start = 0.0
        if len(self._below):  # above the start of the bead below
            gaps = np.linalg.norm(loop.bead.points[:, None] - self._below, axis=2).min(axis=0)
            above = loop.nearest(self._below[int(np.argmin(gaps))])[0]
            start = float(loop.arc[above.segment] + above.share * loop.length[above.segment])
        wanted_distance = self._seam.distance
        margin = self._tolerance + SNAP_MM  # the seam is on the curve, not on the chord
        low, high = loop.bead.points.min(axis=0), loop.bead.points.max(axis=0)
        outside = np.maximum(low - starts_nearby, starts_nearby - high).max(axis=1)
        starts_nearby = starts_nearby[outside < wanted_distance + margin]
        arc = find_free_arc(loop, starts_nearby, wanted_distance + margin, start, loop.sense)
        if arc is not None:
            return loop.location_at(arc)
        arc = _farthest_arc(loop, starts_nearby, wanted_distance, start, loop.sense)
        location = loop.location_at(arc)
        gap = float(np.linalg.norm(starts_nearby - loop.point(location), axis=1).min())
        if gap < wanted_distance:
            self._short.append((gap, layer))
        return location

    def _preferred(self, loop: _Loop, locations: Sequence[SeamLocation]) -> SeamLocation:
        """Return the place nearest to a start below, else the first place along the bead."""
        arc = np.array([loop.arc[location.segment] for location in locations]) + np.array(
            [location.share * loop.length[location.segment] for location in locations]
        )
        order = (arc + BEFORE_START_MM) % loop.total
        if len(self._below):
            points = np.array([loop.point(location) for location in locations])
            distance = np.linalg.norm(points[:, None] - self._below, axis=2).min(axis=1)
            order = np.where(distance <= distance.min() + SNAP_MM, order, np.inf)
        return locations[int(np.argmin(order))]

    def _measure_point(self, beads: Sequence[Bead], layer: int) -> None:
        """Note whether the nearest layer surrounds the seam point."""
        point = np.array(self._seam.point)
        outer = [_Loop(bead) for bead in beads if bead.closed and not bead.role.ring]
        if not outer:
            return
        distance = min(loop.nearest(point)[1] for loop in outer)
        if distance < self._nearest[0]:
            self._nearest = distance, layer
            self._is_inside = sum(_surrounds(loop, point) for loop in outer) % 2 == 1

    def issues(self) -> list[Issue]:
        """Return what the user should know about the seams of all layers so far."""
        seam = self._seam
        distance, layer = self._nearest
        if self._is_inside and distance > self._bead_width:
            return [
                Issue(
                    WARNING,
                    "SEAM_POINT",
                    Text(
                        "seen along the build direction, process.seam.point is inside the closed "
                        "beads, {:.3g} mm from the nearest bead, so a small change of a layer may "
                        "move its seam to the other side; choose a point on the surface or outside",
                        distance,
                    ),
                    layer,
                )
            ]
        if self._short:
            gap, layer = min(self._short)
            return [
                Issue(
                    WARNING,
                    "SEAM_DISTANCE",
                    Text(
                        "{} closed bead(s) in {} layer(s) start nearer than process.seam.distance, "
                        "{:g} mm, to another start, at worst {:.3g} mm in layer {}; use a smaller "
                        "distance",
                        len(self._short),
                        len({number for _, number in self._short}),
                        seam.distance,
                        gap,
                        layer,
                    ),
                    layer,
                )
            ]
        if not self._without:
            return []
        if seam.position == SHARPEST and not self._applies:
            return [
                Issue(
                    WARNING,
                    NO_EFFECT,
                    Text(
                        "process.seam.position: sharpest has no effect: no closed bead turns by "
                        "{:.3g} deg or more at a point; the beads start by process.seam.angle",
                        math.degrees(CORNER),
                    ),
                )
            ]
        if seam.position == HIDDEN:
            return [
                Issue(
                    WARNING,
                    "SEAM_SIDE",
                    Text(
                        "{} closed bead(s) are in a plane across process.seam.away_from without "
                        "a hidden side, and start by process.seam.angle; choose a direction "
                        "along the layers",
                        self._without,
                    ),
                )
            ]
        return []


def _surrounds(loop: _Loop, point: Array) -> bool:
    """Whether a bead runs around a point (3,), seen along the normal of the bead's area."""
    normal = unit_rows(loop.area[None])[0]
    local = loop.bead.points - point
    ahead, behind = local[1:], local[:-1]
    across = np.cross(behind, ahead) @ normal
    along = dots(behind, ahead) - (behind @ normal) * (ahead @ normal)
    return bool(abs(np.arctan2(across, along).sum()) > math.pi)


def start_bead(bead: Bead, location: SeamLocation) -> Bead:
    """Return the bead with its seam at a place, where a point is added if it has none; START changes nothing."""
    if location == START:
        return bead
    if location.share == 0.0:
        return bead.started_at(location.segment)
    divided = bead.divided(np.array([location.segment]), np.array([location.share]))
    return divided.started_at(location.segment + 1)


def place_seams(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with closed beads that start where `process.seam` says.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath, whose closed beads start at the seam angle.
    process : ProcessParameters
        Seam and bead width.

    Returns
    -------
    Toolpath
        The toolpath, with issues about the seams.
    """
    placer = SeamPlacer(process.seam, toolpath.chord_error, process.bead_width)
    if not placer.is_active:
        return toolpath
    layers = []
    for number, layer in enumerate(toolpath.layers):
        if layer.first:
            placer.begin_stack()
        locations = placer.choose_locations(layer.beads, number)
        beads = tuple(map(start_bead, layer.beads, locations))
        layers.append(dataclasses.replace(layer, beads=beads))
    return dataclasses.replace(
        toolpath, layers=tuple(layers), issues=(*toolpath.issues, *placer.issues())
    )


# ---- Parameters that do not fit the rule or the beads


def check_parameters(seam: SeamParameters) -> None:
    """Raise InputError BAD_VALUE if the parameter that a position needs is missing."""
    for position, value, key, example in (
        (BY_POINT, seam.point, "point", "[40, 0, 0]"),
        (HIDDEN, seam.away_from, "away_from", "[0, -1, 0]"),
    ):
        if seam.position == position and value is None:
            raise InputError(
                "BAD_VALUE",
                f"process.seam.{key}",
                "position: {} needs a value; give three numbers such as {}, or choose another "
                "position",
                position,
                example,
            )


def check_distance(toolpath: Toolpath, seam: SeamParameters) -> None:
    """Raise InputError BAD_VALUE if starts are to be farther apart than any closed bead is long."""
    longest = max((bead.length for _, _, bead in toolpath if bead.closed), default=math.inf)
    if seam.position == SPREAD and longest < seam.distance:
        raise InputError(
            "BAD_VALUE",
            "process.seam.distance",
            "is {:g} mm, but the longest closed bead is only {:.4g} mm long; use less than half of "
            "that length",
            seam.distance,
            longest,
        )


def unused_issues(toolpath: Toolpath, seam: SeamParameters) -> list[Issue]:
    """Return warnings about parameters that change nothing.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    seam : SeamParameters
        The parameters of the seam.

    Returns
    -------
    list of Issue
        Issues NO_EFFECT.
    """
    usual = SeamParameters()
    used = {
        "angle": (BY_ANGLE, SHARPEST, SPREAD),
        "step": (BY_ANGLE, SHARPEST),
        "point": (BY_POINT,),
        "away_from": (HIDDEN,),
        "distance": (SPREAD,),
    }
    issues = [
        Issue(
            WARNING,
            NO_EFFECT,
            Text(
                "process.seam.{} has no effect with process.seam.position: {}; remove the key, "
                "or use position: {}",
                key,
                seam.position,
                positions[0],
            ),
        )
        for key, positions in used.items()
        if getattr(seam, key) != getattr(usual, key) and seam.position not in positions
    ]
    if seam.position != BY_ANGLE and not any(bead.closed for _, _, bead in toolpath):
        issues.append(
            Issue(
                WARNING,
                NO_EFFECT,
                Text(
                    "process.seam.position: {} has no effect, as no bead is closed; remove "
                    "process.seam.position",
                    seam.position,
                ),
            )
        )
    return issues


# ---- Scarf seams

SCARF = "process.seam.scarf"


def set_scarfs(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with scarf seams on closed beads, and points for the steps of their ramps.

    Planning applies the scarfs where it continues beads past their seams.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    process : ProcessParameters
        Length of the scarfs, and what they exclude.

    Returns
    -------
    Toolpath
        The toolpath, with issues about beads too short for a scarf.

    Raises
    ------
    InputError
        BAD_VALUE if every closed bead is too short, or other parameters set the speeds at the
        ends of beads.
    """
    length = process.seam.scarf
    closed = [bead for _, _, bead in toolpath if bead.closed]
    if length <= 0.0:
        return toolpath
    if not closed:
        text = Text("{} has no effect: no bead is closed; remove it", SCARF)
        return dataclasses.replace(
            toolpath, issues=(*toolpath.issues, Issue(WARNING, NO_EFFECT, text))
        )
    _refuse_other_speeds(process)
    longest = max(bead.length for bead in closed)
    if longest < 2.0 * length:
        raise InputError(
            "BAD_VALUE",
            SCARF,
            "is {:g} mm, more than half of the longest closed bead; use at most {:.4g} mm",
            length,
            0.5 * longest,
        )
    short: list[int] = []
    layers = []
    for number, layer in enumerate(toolpath.layers):
        fits = [bead.closed and bead.length >= 2.0 * length for bead in layer.beads]
        short += [number for bead, fit in zip(layer.beads, fits) if bead.closed and not fit]
        beads = tuple(
            _add_scarf(bead, length, toolpath.layer_height) if fit else bead
            for bead, fit in zip(layer.beads, fits)
        )
        layers.append(dataclasses.replace(layer, beads=beads))
    return dataclasses.replace(
        toolpath,
        layers=tuple(layers),
        issues=(*toolpath.issues, *_scarf_issues(short, process)),
    )


def _add_scarf(bead: Bead, length: float, height: float) -> Bead:
    """Return a closed bead with a scarf and points at the steps of its ramps."""
    scarf, loop = Scarf(length, height), _Loop(bead)
    steps = max(1, min(STEPS, round_down(length / MIN_STEP)))
    positions = scarf.positions(loop.total, steps)
    gap = np.abs(positions[:, None] - loop.arc).min(axis=1)
    positions = positions[gap > STEP_SHARE * MIN_STEP]
    segment = np.searchsorted(loop.arc, positions, "right") - 1
    shares = (positions - loop.arc[segment]) / loop.length[segment]
    return dataclasses.replace(bead.divided(segment, shares), scarf=scarf)


def _scarf_issues(short: Sequence[int], process: ProcessParameters) -> list[Issue]:
    """Return warnings about beads without a scarf, in layers `short`, and about the overlap."""
    issues = []
    if short:
        issues.append(
            Issue(
                WARNING,
                "SEAM_SCARF",
                Text(
                    "{} closed bead(s) in {} layer(s) are shorter than two scarfs of {:g} mm and "
                    "have none; use a shorter process.seam.scarf",
                    len(short),
                    len(set(short)),
                    process.seam.scarf,
                ),
                short[0],
            )
        )
    elif process.overlap > 0.0:
        issues.append(
            Issue(
                WARNING,
                NO_EFFECT,
                Text(
                    "process.overlap has no effect with process.seam.scarf, which overlaps the "
                    "seam itself; remove one"
                ),
            )
        )
    return issues


def _refuse_other_speeds(process: ProcessParameters) -> None:
    """Raise InputError BAD_VALUE if another parameter sets the speed or the wire at the ends of beads."""
    if process.wire.feed_mode != "constant":
        raise InputError(
            "BAD_VALUE",
            SCARF,
            "a scarf changes the section by the travel speed at a constant wire feed; remove it, or "
            "use process.wire.feed_mode: constant",
        )
    processes = [process, *(process.for_class(entry.name) for entry in process.classes)]
    phases = [phase for one_process in processes for phase in (one_process.start, one_process.end)]
    if any(phase.there and phase.travel_speed is not None for phase in phases):
        raise InputError(
            "BAD_VALUE",
            SCARF,
            "process.start or process.end sets the travel speed where the scarf does; remove the "
            "scarf, or their travel_speed",
        )
