# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fits beads to axes of a positioner that have less than a whole turn: by another seam, another way
to turn the part, waiting at a limit while the tool leans within its allowance, or as the last
resort by cutting the bead.

The range of such an axis has a gap that whole turns cannot bridge. From a point on, a way to turn
the part is usable until it exceeds the limits by more than the allowed lean, so seams and cuts
follow from how far each way reaches.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from ...geometry.columns import lengths
from ...geometry.frames import TURN
from ...kinematics.cell import Cell
from ...kinematics.external import ExternalAxes, tilt_from
from ...kinematics.inverse import rotary_pair
from ...kinematics.limits import RESERVE
from ...toolpath import Bead
from ...types import Array, Index, Mask
from ..turns import directed

STEPS = 200  # steps of the search for the middle of directions


def directions_on_face(cell: Cell, tool: Array) -> Array:
    """Return tool axes in the frame of the face that carries the part.

    Parameters
    ----------
    cell : Cell
        The cell.
    tool : (n, 3) array
        Tool axes in the part frame.

    Returns
    -------
    (n, 3) array
        The same directions in the frame of the face.
    """
    turned = cell.poses.station[:3, :3] @ cell.poses.mount[:3, :3].T
    return np.asarray(tool @ turned.T)


def middle(directions: Array) -> Array | None:
    """Return the direction with the least maximum angle to all directions.

    Parameters
    ----------
    directions : (n, 3) array
        Unit vectors.

    Returns
    -------
    (3,) array or None
        Unit vector; None if the mean of the directions vanishes.

    References
    ----------
    Badoiu and Clarkson 2003: step towards the farthest direction, by less each time.
    """
    mean = directions.mean(axis=0)
    if np.linalg.norm(mean) < 1e-6:
        return None
    mean = mean / np.linalg.norm(mean)
    middle = mean
    # Badoiu and Clarkson 2003: step towards the farthest direction, by less each time
    for step in range(1, STEPS):
        farthest = directions[int((directions @ middle).argmin())]
        middle = middle + (farthest - middle) / (step + 1)
        middle /= np.linalg.norm(middle)
    nearer = float((directions @ middle).min()) > float((directions @ mean).min())
    return np.asarray(middle if nearer else mean)


def upright(external: ExternalAxes, directions: Array) -> list[Array]:
    """Return all ways to turn directions upright, up to whole turns.

    Parameters
    ----------
    external : ExternalAxes
        The external axes, one or two of which turn the part.
    directions : (n, 3) array
        Unit vectors in the frame of the face.

    Returns
    -------
    list of (n, k) array
        Angles of the turning axes, rad, continuous along the rows.
    """
    source = directions @ external.at_zero.T
    if len(external.turning) == 1:
        return [
            np.unwrap(rotary_pair.nearest(external.turning[0], source, external.up).angle)[:, None]
        ]
    first_axis, second_axis = external.turning
    solutions = rotary_pair.solve_turns(
        first_axis, second_axis, directed.onto_pole(source, second_axis), external.up
    )
    if not np.isfinite(
        solutions.first_turn + solutions.second_turn
    ).all():  # axes that are not at right angles do not reach farther
        angle = rotary_pair.nearest(second_axis, source, external.up).angle
        return [np.unwrap(np.stack([np.zeros(len(angle)), angle], axis=-1), axis=0)]
    return directed.rotary_courses(solutions)


def chosen(cell: Cell, courses: Sequence[Array], previous: Array) -> Array:
    """Choose the course with the least motion within the limits.

    All courses and whole turns are candidates. A tie goes to the one that starts nearest to the
    previous values.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    courses : sequence of (n, t) array
        Values of the t turning axes, rad.
    previous : (k,) array
        Values of all external axes before.

    Returns
    -------
    (n, k) array
        Values of all external axes; the others keep their previous values.
    """
    rows, lower, upper = limits_of(cell)
    speed = cell.machine.max_speed[cell.robot.chain.axes + rows]
    all_axes = np.ones(len(rows), dtype=bool)
    best = directed.chosen_course(
        courses, previous[rows], lower, upper, speed, all_axes, least_motion=True
    )
    values = np.tile(previous, (len(best), 1))
    values[:, rows] = best
    return values


def limits_of(cell: Cell) -> tuple[Index, Array, Array]:
    """Return the external axes that turn the part and their limits.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.

    Returns
    -------
    rows : (t,) int array
        Indices among the external axes.
    lower, upper : (t,) array
        Limits less the reserve, rad.
    """
    assert cell.external is not None
    rows = cell.external.turned
    axes = cell.robot.chain.axes + rows
    return rows, cell.limits.lower[axes] + RESERVE, cell.limits.upper[axes] - RESERVE


ROUNDING = 1e-9
ROUNDS = 6  # rounds that add points between the points of a bead
# rad between the planning limit and an axis that waits at it, so that rounding keeps it within
# limits
WAITS = RESERVE


def lacks(cell: Cell, values: Array, whole_turns: bool = False) -> bool:
    """Return whether an axis leaves its limits at some of the values.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    values : (n, k) array
        Values of the external axes, rad or mm.
    whole_turns : bool, optional
        Whether axes with a whole turn are also checked.

    Returns
    -------
    bool
        True if such an axis leaves its limits.
    """
    rows, lower, upper = limits_of(cell)
    over = np.maximum(lower - values[:, rows], values[:, rows] - upper)
    return bool((over[:, whole_turns | (upper - lower < TURN)] > ROUNDING).any())


def find_room(
    cell: Cell, bead: Bead, max_lean: float, previous: Array, overlap: float
) -> list[Bead]:
    """Return a bead, or its pieces, with room for the external axes.

    Another seam is tried first, then the fewest pieces. Points are added where seams or ends of
    pieces have room between the points of the bead.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    bead : Bead
        The bead.
    max_lean : float
        Largest angle to the vertical, rad.
    previous : (k,) array
        Values of the external axes before the bead.
    overlap : float
        Length that a closed bead runs past its seam, mm.

    Returns
    -------
    list of Bead
        The bead or its pieces with values of the external axes; empty if nothing helps.
    """
    moved = _begun_elsewhere(cell, bead, max_lean, previous, overlap) if bead.closed else None
    if moved is not None:
        return [moved]
    for _ in range(ROUNDS):
        solutions = _Ways.of_bead(cell, bead, max_lean)
        if cuts := _cuts(solutions.reach, 0, solutions.last(0, overlap)):
            return _split_bead(solutions, cuts, previous, overlap)
        if not solutions.fits.any(axis=0).all():
            break
        count = len(bead) - 1
        bead = bead.halved(np.flatnonzero(solutions.reach[:count] <= np.arange(count)))
    return []


def _begun_elsewhere(
    cell: Cell, bead: Bead, max_lean: float, previous: Array, overlap: float
) -> Bead | None:
    """Return a closed bead from a seam at which the axes have stroke for the whole bead, else None."""
    for _ in range(ROUNDS):
        solutions, count = _Ways.of_bead(cell, bead, max_lean), len(bead) - 1
        for start, values in solutions.seams(count, previous):
            moved = _set_external(bead.started_at(start), values, previous, solutions.rows)
            if runs_on(cell, moved, max_lean, overlap):
                return moved
        ends = solutions.nearly_round(count)
        if not len(ends):
            break
        bead = bead.halved(ends)
    return None


def _split_bead(
    solutions: _Ways, cuts: Sequence[int], previous: Array, overlap: float
) -> list[Bead]:
    """Return a bead in pieces, cut at suitable points; a closed bead starts where fewer pieces
    suffice. The last piece gets the overlap.
    """
    bead = solutions.bead
    starts = [0, *(cut % (len(bead) - 1) for cut in cuts[1:-1] if bead.closed)]
    cut_lists = [_cuts(solutions.reach, start, solutions.last(start, overlap)) for start in starts]
    cuts = _balanced(solutions.reach, min(filter(None, cut_lists), key=len))
    extended = (bead.started_at(cuts[0]) if cuts[0] else bead).run_on(overlap)
    sections = list[Bead]()
    for low, high in itertools.pairwise(cuts):
        values = solutions.choose_values(low, high, previous)
        section = extended.part(slice(low - cuts[0], high + 1 - cuts[0]))
        if high == cuts[-1] and overlap > 0.0:
            values[-1] = values[-2] + _share(bead, high, section) * (values[-1] - values[-2])
        sections.append(_set_external(section, values, previous, solutions.rows))
        previous = np.array(previous)
        previous[solutions.rows] = values[-1]
    return sections


def _share(bead: Bead, last_point: int, section: Bead) -> float:
    """Return the position of a piece's end in the bead segment that ends at point `last_point`.

    `last_point` counts on over several rounds. The position is a share of the segment.
    """
    if not bead.closed:
        return 1.0
    end = 1 + (last_point - 1) % (len(bead) - 1)
    deposited = section.points[-1] - section.points[-2]
    segment = bead.points[end] - bead.points[end - 1]
    return float(np.linalg.norm(deposited) / np.linalg.norm(segment))


def runs_on(cell: Cell, bead: Bead, max_lean: float, overlap: float) -> bool:
    """Return whether a closed bead keeps the tilt limit over its seam overlap.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    bead : Bead
        The bead with values of the external axes; open beads have no overlap.
    max_lean : float
        Largest angle to the vertical, rad.
    overlap : float
        Length of the overlap, mm.

    Returns
    -------
    bool
        True also without an overlap.
    """
    external = cell.external
    if overlap <= 0.0 or not bead.closed:
        return True
    assert external is not None and bead.external is not None
    count = _overlap_points(bead, 0, overlap) + 1
    beginning = bead.external[:count]
    values = waiting(cell, bead.external, beginning)
    tilt = tilt_from(
        external.upright(directions_on_face(cell, bead.tool[:count]), values), external.up
    )
    return values is beginning or bool((tilt <= max_lean).all())


def waiting(cell: Cell, values: Array, beginning: Array) -> Array:
    """Return the external values for the seam overlap of a bead.

    They equal its beginning. If that leaves the limits of an axis, apart from whole turns, the
    axes wait at the values of its end.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    values : (n, k) array
        External values of the bead.
    beginning : (m, k) array
        External values of the points that the overlap repeats.

    Returns
    -------
    (m, k) array
        `beginning` itself, or the repeated last row of `values`.
    """
    rows, lower, upper = limits_of(cell)
    turned = beginning[:, rows] + TURN * np.round((values[-1, rows] - values[0, rows]) / TURN)
    all_values = np.concatenate([values[:, rows], turned])
    fewest = np.ceil((lower - all_values.min(axis=0)) / TURN - ROUNDING)
    greatest = np.floor((upper - all_values.max(axis=0)) / TURN + ROUNDING)
    return (
        beginning
        if (fewest <= greatest).all()
        else np.asarray(np.tile(values[-1], (len(beginning), 1)))
    )


@dataclasses.dataclass(frozen=True)
class _Ways:
    """Ways to turn the directions (n, 3) of a bead upright, each within the limits.

    They cover a closed bead three times; copies by whole turns are separate ways. values: (ways, n,
    k) of the turning axes, which are `rows` of the external axes. clamped: (ways, n) rad by which
    limits hold the axes back. fits: (ways, n) whether the tool keeps `max_lean`.
    """

    cell: Cell
    bead: Bead
    external: ExternalAxes
    directions: Array
    max_lean: float
    rows: Index
    values: Array
    clamped: Array
    fits: Mask

    @classmethod
    def of_bead(cls, cell: Cell, bead: Bead, max_lean: float) -> _Ways:
        external, (rows, lower, upper) = cell.external, limits_of(cell)
        assert external is not None
        directions = directions_on_face(cell, bead.tool)
        if bead.closed:
            directions = np.concatenate([directions[:-1], directions[:-1], directions])
        values, clamped, fits = [], [], []
        for course in upright(external, directions):
            for turned in _whole_turn_copies(course, lower - max_lean, upper + max_lean):
                inside = ((turned >= lower) & (turned <= upper)).all(axis=1)
                clipped = np.where(
                    inside[:, None], turned, np.clip(turned, lower + WAITS, upper - WAITS)
                )
                external_values = np.zeros((len(clipped), external.axes))
                external_values[:, rows] = clipped
                values.append(clipped)
                clamped.append(np.abs(clipped - turned).sum(axis=1))
                fits.append(
                    inside
                    | (
                        tilt_from(external.upright(directions, external_values), external.up)
                        <= max_lean
                    )
                )
        count = len(directions)
        return cls(
            cell,
            bead,
            external,
            directions,
            max_lean,
            rows,
            np.array(values).reshape(-1, count, len(rows)),
            np.array(clamped).reshape(-1, count),
            np.array(fits, dtype=bool).reshape(-1, count),
        )

    @cached_property
    def furthest(self) -> Index:
        """(ways, n) the last point that each way reaches within its stroke from a point; the
        previous point if none.
        """
        count = self.fits.shape[1]
        without = np.where(self.fits, count, np.arange(count))
        return np.asarray(np.minimum.accumulate(without[:, ::-1], axis=1)[:, ::-1] - 1)

    @cached_property
    def reach(self) -> Index:
        """The last point (n,) that any way reaches from a point."""
        return np.asarray(self.furthest.max(axis=0, initial=-1))

    def last(self, start: int, overlap: float) -> int:
        """The point at which the bead, or its overlap, ends if it begins at a given point."""
        return (
            start
            + len(self.bead)
            - 1
            + (_overlap_points(self.bead, start, overlap) if self.bead.closed else 0)
        )

    def nearly_round(self, count: int) -> Index:
        """Segments of a closed bead in which a way runs out of room although it covers all other
        segments.
        """
        course, start = np.nonzero(self.fits[:, 1 : count + 1] & ~self.fits[:, :count])
        end = self.furthest[course, start + 1]
        nearly_complete = (
            end - start > count - 2
        )  # so with a share of both end segments it may cover the whole bead
        return np.asarray(
            np.unique(np.concatenate([start[nearly_complete], end[nearly_complete] % count]))
        )

    def seams(self, count: int, previous: Array) -> Iterator[tuple[int, Array]]:
        """Yield the possible seams of a closed bead of `count` segments, with their values (count +
        1, k).

        At a seam, one way has stroke for the whole bead. The order is by the amount that limits
        hold an axis back, then by the distance from the present seam, then by the travel time of
        the axes.
        """
        course, start = np.nonzero(self.furthest[:, :count] >= np.arange(count) + count)
        so_far = np.cumsum(np.pad(self.clamped, ((0, 0), (1, 0))), axis=1)
        clamped = np.round(so_far[course, start + count + 1] - so_far[course, start], 6)
        distances = self._travel_time(self.values[course, start], previous)
        for k in np.lexsort((distances, np.minimum(start, count - start), clamped)):
            yield int(start[k]), self.values[course[k], start[k] : start[k] + count + 1]

    def choose_values(self, low: int, high: int, previous: Array) -> Array:
        """Values (n, k) from one point to another: constant if that serves, else the usable way
        that clamps the axes least, then moves least, then starts nearest to their current
        values.
        """
        directions = self.directions[low : high + 1]
        mean_direction = middle(directions)
        if (
            mean_direction is not None
            and float(tilt_from(directions, mean_direction).max()) <= self.max_lean
        ):
            standing = chosen(self.cell, upright(self.external, mean_direction[None]), previous)
            if not lacks(self.cell, standing):
                return np.asarray(np.tile(standing[:, self.rows], (len(directions), 1)))
        able = np.flatnonzero(self.furthest[:, low] >= high)
        values = self.values[able, low : high + 1]
        clamped = np.round(self.clamped[able, low : high + 1].sum(axis=1), 6)
        motion = np.round(np.abs(np.diff(values, axis=1)).sum(axis=(1, 2)), 6)
        return np.asarray(
            values[np.lexsort((self._travel_time(values[:, 0], previous), motion, clamped))[0]]
        )

    def _travel_time(self, values: Array, previous: Array) -> Array:
        """Return the travel times (m,) of the axes to values (m, k), s, rounded to the microsecond."""
        speed = self.cell.machine.max_speed[self.cell.robot.chain.axes + self.rows]
        return np.asarray(np.round((np.abs(values - previous[self.rows]) / speed).max(axis=1), 6))


def _overlap_points(bead: Bead, start: int, overlap: float) -> int:
    """Return the number of overlap points of a closed bead that begins at its point `start`."""
    if overlap <= 0.0:
        return 0
    along = np.cumsum(np.roll(lengths(np.diff(bead.points, axis=0)), -start))
    return 1 + int(np.searchsorted(along[:-1], overlap))


def _whole_turn_copies(course: Array, lower: Array, upper: Array) -> Iterator[Array]:
    """Yield a course (n, k) moved by all whole turns that bring some of it within limits; axes
    without limits stay.
    """
    with np.errstate(invalid="ignore"):
        fewest = np.ceil((lower - course.max(axis=0)) / TURN)
        greatest = np.floor((upper - course.min(axis=0)) / TURN)
    ranges = [
        range(int(a), int(b) + 1) if np.isfinite(b - a) else range(1)
        for a, b in zip(fewest, greatest, strict=True)
    ]
    for turns in itertools.product(*ranges):
        yield course + TURN * np.array(turns, float)


def _set_external(bead: Bead, values: Array, previous: Array, rows: Index) -> Bead:
    """The bead with values (n, k) of the axes that turn the part, and unchanged values (k,) of the
    others.
    """
    external = np.tile(previous, (len(bead), 1))
    external[:, rows] = values
    return dataclasses.replace(bead, external=external)


def _cuts(reach: Index, low: int, high: int) -> list[int]:
    """Return the ends of the fewest pieces between two points, each as long as possible.

    Empty if no way exists.
    """
    cuts = [low]
    while cuts[-1] < high:
        furthest = min(int(reach[cuts[-1]]), high)
        if furthest <= cuts[-1]:
            return []
        cuts.append(furthest)
    return cuts


def _balanced(reach: Index, cuts: Sequence[int]) -> list[int]:
    """Return as many pieces with lengths as equal as possible.

    The start of a piece gives its latest end; the end of the bead gives its earliest end.
    """
    low, high, count = cuts[0], cuts[-1], len(cuts) - 1
    earliest = [high]
    for _ in range(count - 1):
        earliest.append(low + int(np.searchsorted(reach[low : high + 1], earliest[-1])))
    equal_cuts = np.round(np.linspace(low, high, count + 1)).astype(int).tolist()
    ends = [low]
    for earliest_end, equal in zip(reversed(earliest[1:]), equal_cuts[1:-1], strict=True):
        ends.append(min(int(reach[ends[-1]]), max(earliest_end, equal)))
    return [*ends, high]
