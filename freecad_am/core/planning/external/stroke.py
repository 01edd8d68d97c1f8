# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit beads to positioner axes with a range of less than a full turn.

The means are another seam, another solution for turning the part, waiting at a limit while the tool
tilt is allowed, and as a last resort splitting the bead.

Whole turns cannot bridge the gap in the range of such an axis. From a given point on, a solution is
usable until it exceeds the limits by more than the allowed tilt. Seams and cuts follow from how far
each solution reaches.
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

STEPS = 200  # steps of the search for the central direction


def directions_on_face(cell: Cell, tool: Array) -> Array:
    """Transform tool axes to the frame of the face that carries the part.

    Parameters
    ----------
    cell : Cell
        The cell.
    tool : (n, 3) array
        Tool axes in the part frame.

    Returns
    -------
    (n, 3) array
        Directions in the frame of the face.
    """
    turned = cell.poses.station[:3, :3] @ cell.poses.mount[:3, :3].T
    return np.asarray(tool @ turned.T)


def middle(directions: Array) -> Array | None:
    """Return the central direction, which minimises the maximum angle to all directions.

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
    Badoiu and Clarkson 2003: take decreasing steps towards the farthest direction.
    """
    mean = directions.mean(axis=0)
    if np.linalg.norm(mean) < 1e-6:
        return None
    mean = mean / np.linalg.norm(mean)
    middle = mean
    # Badoiu and Clarkson 2003: take decreasing steps towards the farthest direction
    for step in range(1, STEPS):
        farthest = directions[int((directions @ middle).argmin())]
        middle = middle + (farthest - middle) / (step + 1)
        middle /= np.linalg.norm(middle)
    nearer = float((directions @ middle).min()) > float((directions @ mean).min())
    return np.asarray(middle if nearer else mean)


def upright(external: ExternalAxes, directions: Array) -> list[Array]:
    """Return all solutions that turn directions upright, up to whole turns.

    Parameters
    ----------
    external : ExternalAxes
        The external axes; one or two of them turn the part.
    directions : (n, 3) array
        Unit vectors in the frame of the face.

    Returns
    -------
    list of (n, k) array
        Angles of the revolute axes, rad, continuous along the rows.
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
    ).all():  # axes that are not perpendicular cannot reach every direction
        angle = rotary_pair.nearest(second_axis, source, external.up).angle
        return [np.unwrap(np.stack([np.zeros(len(angle)), angle], axis=-1), axis=0)]
    return directed.rotary_courses(solutions)


def chosen(cell: Cell, courses: Sequence[Array], previous: Array) -> Array:
    """Choose the course within the limits with the least motion.

    All courses and whole turns are candidates. The distance of the start from the previous values
    resolves ties.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    courses : sequence of (n, t) array
        Values of the t revolute axes, rad.
    previous : (k,) array
        Previous values of all external axes.

    Returns
    -------
    (n, k) array
        Values of all external axes; axes that do not turn the part keep their previous values.
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
    """Return the external axes that turn the part, and their limits.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.

    Returns
    -------
    rows : (t,) int array
        Indices of these axes among the external axes.
    lower, upper : (t,) array
        Limits, narrowed by RESERVE, rad.
    """
    assert cell.external is not None
    rows = cell.external.turned
    axes = cell.robot.chain.axes + rows
    return rows, cell.limits.lower[axes] + RESERVE, cell.limits.upper[axes] - RESERVE


ROUNDING = 1e-9
ROUNDS = 6  # maximum number of refinements of a bead
# rad; distance between the planning limit and an axis that waits there, so that rounding cannot
# exceed the limit
WAITS = RESERVE


def lacks(cell: Cell, values: Array, whole_turns: bool = False) -> bool:
    """Whether an axis exceeds its limits at any of the values.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    values : (n, k) array
        External axis values, rad or mm.
    whole_turns : bool, optional
        Whether to check axes with a full turn as well.

    Returns
    -------
    bool
        True if a checked axis exceeds its limits.
    """
    rows, lower, upper = limits_of(cell)
    over = np.maximum(lower - values[:, rows], values[:, rows] - upper)
    return bool((over[:, whole_turns | (upper - lower < TURN)] > ROUNDING).any())


def find_room(
    cell: Cell, bead: Bead, max_lean: float, previous: Array, overlap: float
) -> list[Bead]:
    """Return a bead, or its pieces, that the external axes can follow.

    Another seam is tried first, then the minimum number of pieces. Points are added where seams or
    cuts fit only between the points of the bead.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    bead : Bead
        The bead.
    max_lean : float
        Maximum angle from the vertical, rad.
    previous : (k,) array
        External axis values before the bead.
    overlap : float
        Seam overlap of a closed bead, mm.

    Returns
    -------
    list of Bead
        The bead or its pieces, with external axis values; empty if nothing helps.
    """
    overlap = bead.overlap_of(overlap)
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
    """Return a closed bead from a seam that gives the axes enough stroke; None if there is none."""
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
    """Split a bead at suitable points.

    A closed bead starts where fewer pieces suffice. The last piece includes the overlap.
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
    """Return the end of a piece as a fraction of the bead segment that ends at `last_point`.

    `last_point` keeps counting over several rounds of a closed bead.
    """
    if not bead.closed:
        return 1.0
    end = 1 + (last_point - 1) % (len(bead) - 1)
    deposited = section.points[-1] - section.points[-2]
    segment = bead.points[end] - bead.points[end - 1]
    return float(np.linalg.norm(deposited) / np.linalg.norm(segment))


def runs_on(cell: Cell, bead: Bead, max_lean: float, overlap: float) -> bool:
    """Whether a closed bead keeps the tilt limit over its seam overlap.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    bead : Bead
        The bead, with external axis values; open beads have no overlap.
    max_lean : float
        Maximum angle from the vertical, rad.
    overlap : float
        Overlap length, mm.

    Returns
    -------
    bool
        True if the tilt limit is kept or there is no overlap.
    """
    external, overlap = cell.external, bead.overlap_of(overlap)
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
    """Return the external axis values for the seam overlap of a bead.

    They repeat the start of the bead, up to whole turns. If this exceeds the limits of an axis, the
    axes wait at their last values.

    Parameters
    ----------
    cell : Cell
        The cell with external axes.
    values : (n, k) array
        External axis values of the bead.
    beginning : (m, k) array
        External axis values of the points that the overlap repeats.

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
    """Solutions that turn the directions (n, 3) of a bead upright within the limits.

    They cover a closed bead three times; copies by whole turns are separate solutions. rows:
    indices of the axes that turn the part. values: (ways, n, k) of these axes. clamped: (ways, n)
    rad by which limits hold the axes back. fits: (ways, n) whether the tool keeps `max_lean`.
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
        """(ways, n) last point that each solution reaches from a point within its stroke; the
        previous point if it reaches none.
        """
        count = self.fits.shape[1]
        without = np.where(self.fits, count, np.arange(count))
        return np.asarray(np.minimum.accumulate(without[:, ::-1], axis=1)[:, ::-1] - 1)

    @cached_property
    def reach(self) -> Index:
        """(n,) last point that any solution reaches from a point."""
        return np.asarray(self.furthest.max(axis=0, initial=-1))

    def last(self, start: int, overlap: float) -> int:
        """Return the last point of the bead, including its overlap, if it begins at `start`."""
        return (
            start
            + len(self.bead)
            - 1
            + (_overlap_points(self.bead, start, overlap) if self.bead.closed else 0)
        )

    def nearly_round(self, count: int) -> Index:
        """Return segments of a closed bead at which a solution ends that covers all others."""
        course, start = np.nonzero(self.fits[:, 1 : count + 1] & ~self.fits[:, :count])
        end = self.furthest[course, start + 1]
        nearly_complete = (
            end - start > count - 2
        )  # including part of both end segments, such a solution may cover the whole bead
        return np.asarray(
            np.unique(np.concatenate([start[nearly_complete], end[nearly_complete] % count]))
        )

    def seams(self, count: int, previous: Array) -> Iterator[tuple[int, Array]]:
        """Yield the possible seams of a closed bead, with its values (count + 1, k).

        count: number of segments. At a seam, one solution has enough stroke for the whole bead.
        Seams are ordered by how far limits hold the axes back, then by distance from the present
        seam, then by travel time of the axes.
        """
        course, start = np.nonzero(self.furthest[:, :count] >= np.arange(count) + count)
        so_far = np.cumsum(np.pad(self.clamped, ((0, 0), (1, 0))), axis=1)
        clamped = np.round(so_far[course, start + count + 1] - so_far[course, start], 6)
        distances = self._travel_time(self.values[course, start], previous)
        for k in np.lexsort((distances, np.minimum(start, count - start), clamped)):
            yield int(start[k]), self.values[course[k], start[k] : start[k] + count + 1]

    def choose_values(self, low: int, high: int, previous: Array) -> Array:
        """Return values (n, k) from one point to another.

        They are constant if possible. Otherwise take the usable solution that limits hold back
        least, then the one with the least motion, then the one nearest to the current values.
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
        """Return travel times (m,) of the axes to values (m, k), s, rounded to 1 us."""
        speed = self.cell.machine.max_speed[self.cell.robot.chain.axes + self.rows]
        return np.asarray(np.round((np.abs(values - previous[self.rows]) / speed).max(axis=1), 6))


def _overlap_points(bead: Bead, start: int, overlap: float) -> int:
    """Return the number of overlap points of a closed bead that begins at point `start`."""
    if overlap <= 0.0:
        return 0
    along = np.cumsum(np.roll(lengths(np.diff(bead.points, axis=0)), -start))
    return 1 + int(np.searchsorted(along[:-1], overlap))


def _whole_turn_copies(course: Array, lower: Array, upper: Array) -> Iterator[Array]:
    """Yield copies of a course (n, k), shifted by all whole turns that are partly within limits.

    Axes without limits are not shifted.
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
    """Set the values (n, k) of the axes that turn the part; other axes keep `previous` values."""
    external = np.tile(previous, (len(bead), 1))
    external[:, rows] = values
    return dataclasses.replace(bead, external=external)


def _cuts(reach: Index, low: int, high: int) -> list[int]:
    """Return the cuts for the minimum number of pieces between two points, each of maximum length.

    Empty if there is no solution.
    """
    cuts = [low]
    while cuts[-1] < high:
        furthest = min(int(reach[cuts[-1]]), high)
        if furthest <= cuts[-1]:
            return []
        cuts.append(furthest)
    return cuts


def _balanced(reach: Index, cuts: Sequence[int]) -> list[int]:
    """Return the cuts for the same number of pieces with lengths as equal as possible.

    The start of a piece limits its end from above; the end of the bead limits it from below.
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
