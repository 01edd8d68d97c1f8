# SPDX-License-Identifier: LGPL-2.1-or-later
"""A path from one position to another in the joints, around obstacles, by sampling.

Two trees of clear moves grow towards the same samples, one from each end, until a clear move joins
them (RRT-Connect, after Kuffner and LaValle 2000); here they grow by many samples at once. The
joined path is then shortened: the clear moves between its points that take the least time are kept,
and these points are pulled towards each other as far as the path stays clear. The samples are
always the same, without randomness, so that the same job has the same rapids.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.even_samples import spread_points
from ...geometry.obstacles import Body
from ...kinematics.cell import Cell
from ...kinematics.limits import RESERVE
from ...program import SHORTEST_RAPID
from ...toolpath import Bead
from ...types import Array, Index, Mask
from .clearance import Moves
from .retracts import DIRECTIONS, STRAY_MM, Leg, Retracts

# how many times the retract distance is tried where the nozzle would meet something, and further, beyond everything there is
RETRACT_FACTORS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
EXTENSION_FACTOR = 1.5
# of a retract distance of nothing, mm
FIRST_RETRACT = 2.0
# how near to the straight line a retract is held that meets something on its way, mm
FINE_MM = 0.02
# retract distances in directions other than the tool axis, as shares of the one asked for
SIDE_SHARES = (1.0, 4.0)


@dataclass(frozen=True)
class Attempt:
    """Height (mm) and direction of a retract, and how near (mm) it is held to the line."""

    height: float
    direction: int = 0
    tolerance: float = STRAY_MM


def attempts(
    cell: Cell, retract: float, beads: Sequence[Bead], bodies: Sequence[Body]
) -> list[Attempt]:
    """Return the retracts to try after the requested one.

    Heights grow up to where the nozzle is beyond the sphere about all obstacles.

    Parameters
    ----------
    cell : Cell
        The cell, with the platform.
    retract : float
        Requested height, mm; 0 for none.
    beads : sequence of Bead
        The beads, part coordinates.
    bodies : sequence of Body
        Obstacles in part coordinates.

    Returns
    -------
    list of Attempt
        Attempts in order of preference.
    """
    radius = 0.5 * cell.platform_diameter
    x, y, origin = cell.poses.mount[:3, 0], cell.poses.mount[:3, 1], cell.poses.mount[:3, 3]
    platform = [origin + radius * (a * x + b * y) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
    all_ = (*bodies, *cell.in_part())
    points = np.vstack(
        [*(bead.points for bead in beads), platform, *(body.vertices for body in all_)]
    )
    # from any inside point, a move by the diameter in any direction leads outside
    furthest = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    base = retract or FIRST_RETRACT
    heights = [*([] if retract else [base]), *(factor * base for factor in RETRACT_FACTORS)]
    while heights[-1] < furthest:
        heights.append(min(EXTENSION_FACTOR * heights[-1], furthest))
    return [
        *([Attempt(retract, 0, FINE_MM)] if retract else []),
        *(Attempt(height) for height in heights),
        *(Attempt(share * base, direction) for direction in DIRECTIONS for share in SIDE_SHARES),
    ]


Free = Callable[
    [Array, Array], Mask
]  # (k,) whether moves straight in the joints from (k, axes) to (k, axes) are clear
Fits = Callable[[Array], Mask]  # (k,) whether joints (k, axes) are allowed

BATCH, ROUNDS = 32, 30  # samples that trees grow by at once, and how often
FULL_RANGE_ROUND = (
    10  # rounds until samples are of the whole ranges; the first are of a part next to both ends
)
STEP = 0.2  # longest move that a tree grows by, as a share of the ranges
SHORTENED = 4  # times that a way is made shorter
PULLS = np.array([0.0, 0.03, 0.1, 0.3])  # of the way from a place to halfway between its neighbours


@dataclass(frozen=True, eq=False)
class Ranges:
    """The search space of the joints: low, high (axes,), and the largest speed of each axis."""

    low: Array
    high: Array
    speed: Array

    def lasts(self, start: Array, end: Array) -> Array:
        """Return the time that moves take, by the slowest axis.

        Parameters
        ----------
        start, end : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (...) array
            Times, s.
        """
        seconds: Array = (np.abs(end - start) / self.speed).max(axis=-1)
        return seconds


class _Tree:
    """A tree of joint positions (n, axes), each reached from its parent (n,) by a clear move, in a
    total of `lasts` (n,) s.
    """

    def __init__(self, root: Array) -> None:
        self.place, self.parent, self.lasts = root[None], np.array([-1]), np.zeros(1)

    def nearest(self, ranges: Ranges, position: Array) -> Index:
        """Return the indices (k,) of the nodes nearest to the positions (k, axes)."""
        return np.asarray(ranges.lasts(self.place[None], position[:, None]).argmin(axis=1))

    def add_nodes(self, position: Array, parent: Index, lasts: Array) -> None:
        """Add positions that moves of `lasts` s lead to from their parents."""
        self.place = np.concatenate([self.place, position])
        self.lasts = np.concatenate([self.lasts, self.lasts[parent] + lasts])
        self.parent = np.concatenate([self.parent, parent])

    def back(self, number: int) -> list[Array]:
        """The places from one of its own to the first."""
        route = []
        while number >= 0:
            route.append(self.place[number])
            number = int(self.parent[number])
        return route


def way_round(start: Array, end: Array, ranges: Ranges, free: Free, fits: Fits) -> Array | None:
    """Find a clear path between two positions in the joints.

    Parameters
    ----------
    start, end : (axes,) array
        The positions, rad or mm.
    ranges : Ranges
        The search space and the axis speeds.
    free : Free
        Returns whether moves between rows of joints are clear.
    fits : Fits
        Returns whether positions keep limits and condition.

    Returns
    -------
    (m, axes) array or None
        The positions in between; None if the search fails.
    """
    route = _connect(start, end, ranges, free, fits)
    if route is None:
        return None
    route = _shortest(route, ranges, free)
    for _ in range(SHORTENED):
        if len(route) > 2:
            route = _shorten_by_pulling(route, ranges, free, fits)
    return _shortest(route, ranges, free)[1:-1]


def _connect(start: Array, end: Array, ranges: Ranges, free: Free, fits: Fits) -> Array | None:
    """Places (m, axes) from the start to the end that clear moves join, both among them."""
    if free(start[None], end[None])[0]:
        return np.stack([start, end])
    trees = _Tree(start), _Tree(end)
    all_samples = spread_points(BATCH * ROUNDS, len(start))
    for round_ in range(ROUNDS):
        margin = min(1.0, (round_ + 1) / FULL_RANGE_ROUND) * (ranges.high - ranges.low)
        low = np.maximum(np.minimum(start, end) - margin, ranges.low)
        high = np.minimum(np.maximum(start, end) + margin, ranges.high)
        samples = low + all_samples[BATCH * round_ : BATCH * (round_ + 1)] * (high - low)
        for tree, opposite in (trees, trees[::-1]):
            added = _grow(tree, samples, ranges, free, fits)
            meeting = _find_meeting(tree, opposite, added, ranges, free)
            if meeting is not None:
                from_tree, from_opposite = tree.back(meeting[0])[::-1], opposite.back(meeting[1])
                route = np.array([*from_tree, *from_opposite])
                return route if tree is trees[0] else route[::-1]
    return None


def _grow(tree: _Tree, samples: Array, ranges: Ranges, free: Free, fits: Fits) -> Index:
    """Grows a tree towards samples; the numbers of the places added."""
    parent = tree.nearest(ranges, samples)
    offset = samples - tree.place[parent]
    share = (np.abs(offset) / np.maximum(ranges.high - ranges.low, 1e-9)).max(axis=1)
    target = tree.place[parent] + offset * np.minimum(1.0, STEP / np.maximum(share, 1e-9))[:, None]
    rows = np.flatnonzero(fits(target))
    rows = rows[free(tree.place[parent[rows]], target[rows])]
    old_count = len(tree.place)
    tree.add_nodes(target[rows], parent[rows], ranges.lasts(tree.place[parent[rows]], target[rows]))
    return np.arange(old_count, len(tree.place))


def _find_meeting(
    tree: _Tree, opposite: _Tree, added: Index, ranges: Ranges, free: Free
) -> tuple[int, int] | None:
    """The numbers of a place added to one tree and of one of the other that a clear move joins, by which it is soonest."""
    if not len(added):
        return None
    nearest = opposite.nearest(ranges, tree.place[added])
    rows = np.flatnonzero(free(tree.place[added], opposite.place[nearest]))
    if not len(rows):
        return None
    lasts = (
        tree.lasts[added]
        + opposite.lasts[nearest]
        + ranges.lasts(tree.place[added], opposite.place[nearest])
    )
    best = int(rows[lasts[rows].argmin()])
    return int(added[best]), int(nearest[best])


def _shortest(route: Array, ranges: Ranges, free: Free) -> Array:
    """The soonest way by some of the places (m, axes) of one, the first and the last among them; moves from each to the next
    are clear."""
    count = len(route)
    start_rows, end_rows = np.triu_indices(count, 1)
    clear = end_rows == start_rows + 1
    unchecked = np.flatnonzero(~clear)
    clear[unchecked] = free(route[start_rows[unchecked]], route[end_rows[unchecked]])
    lasts = np.full((count, count), np.inf)
    lasts[start_rows, end_rows] = np.where(
        clear, np.maximum(ranges.lasts(route[start_rows], route[end_rows]), SHORTEST_RAPID), np.inf
    )
    soonest, predecessors = np.zeros(count), np.zeros(count, dtype=np.intp)
    for number in range(1, count):
        total = soonest[:number] + lasts[:number, number]
        predecessors[number] = int(total.argmin())
        soonest[number] = total[predecessors[number]]
    chosen_numbers = [count - 1]
    while chosen_numbers[-1]:
        chosen_numbers.append(int(predecessors[chosen_numbers[-1]]))
    return route[chosen_numbers[::-1]]


def _shorten_by_pulling(route: Array, ranges: Ranges, free: Free, fits: Fits) -> Array:
    """Return a path (m, axes) with each inner point at its position or pulled towards halfway between its
    neighbours, so that it takes the least time; its moves are clear.
    """
    inner, halfway = route[1:-1], 0.5 * (route[:-2] + route[2:])
    pulled = inner[:, None] + PULLS[:, None] * (halfway - inner)[:, None]
    stands = fits(pulled.reshape(-1, route.shape[1])).reshape(len(inner), len(PULLS))
    stands[:, 0] = True
    layers = [route[:1], *(layer[allowed] for layer, allowed in zip(pulled, stands)), route[-1:]]
    starts = [
        np.repeat(layer, len(next_layer), axis=0)
        for layer, next_layer in zip(layers[:-1], layers[1:])
    ]
    stops = [
        np.tile(next_layer, (len(layer), 1)) for layer, next_layer in zip(layers[:-1], layers[1:])
    ]
    a, b = np.concatenate(starts), np.concatenate(stops)
    lasts = np.where(free(a, b), np.maximum(ranges.lasts(a, b), SHORTEST_RAPID), np.inf)
    soonest, choices, offset = np.zeros(1), [], 0
    for layer, next_layer in zip(layers[:-1], layers[1:]):
        total = soonest[:, None] + lasts[offset : offset + len(layer) * len(next_layer)].reshape(
            len(layer), len(next_layer)
        )
        choices.append(total.argmin(axis=0))
        soonest, offset = total.min(axis=0), offset + len(layer) * len(next_layer)
    position, pulled_route = 0, []
    for layer, choice in zip(layers[::-1], [*choices[::-1], None]):
        pulled_route.append(layer[position])
        position = 0 if choice is None else int(choice[position])
    return np.array(pulled_route[::-1])


# rad; largest turn of a continuous axis in one rapid move: such an axis takes the shorter way, so
# half a turn is ambiguous
LARGEST_TURN = np.radians(170.0)
# rapids without a detour after which the search stops: it takes seconds, and the job is infeasible
MAX_FAILED_DETOURS = 3
KNOWN = 8  # ways found before that are tried first

Legs = dict[int, Leg | None]


class LedRound:
    """Finds detours around obstacles.

    The argument `clear` returns whether moves are free of contact. The attribute `ways` holds the
    numbers of the rapids with a detour.
    """

    def __init__(self, cell: Cell, retracts: Retracts, clear: Callable[[Moves], Mask]) -> None:
        self.cell, self.retracts, self.clear = cell, retracts, clear
        self.ways: list[int] = []
        self._lost = 0
        self._known: list[
            Array
        ] = []  # places of the last ways found, there and back: the next one often leads the same way

    def find_detour(
        self,
        ends: Mapping[int, Array],
        legs: Mapping[int, Leg | None],
        attempts: Sequence[Attempt],
        deposited: int,
    ) -> tuple[Legs, Array] | None:
        """Find legs and a path between them that avoid all obstacles.

        Parameters
        ----------
        ends : mapping of int to Array
            Joints (axes,) at the ends of the beads, by number of the end.
        legs : Mapping[int, Leg or None]
            Legs tried before, by number of the end; None without one.
        attempts : sequence of Attempt
            Retracts to try.
        deposited : int
            Number of printed points.

        Returns
        -------
        legs : dict
            Leg or None by number of the end.
        via_points : (m, axes) array
            Positions between the legs.

        Notes
        -----
        None is returned in place of both if the search fails, or failed too often before.
        """
        if not ends or self._lost >= MAX_FAILED_DETOURS:
            return None
        new_legs: Legs = {}
        far_ends: list[Array] = []
        for end, joints in ends.items():
            off = self._find_leg(end, joints, legs[end], attempts, deposited)
            if off is not None:
                new_legs[end] = off[0]
                far_ends.append(off[1])
        via_points = (
            self._between(far_ends[0], far_ends[1], deposited)
            if len(far_ends) == len(ends)
            else None
        )
        if via_points is None:
            self._lost += 1
            return None
        self._known = [via_points, via_points[::-1], *self._known][:KNOWN]
        return new_legs, via_points

    def _find_leg(
        self,
        end: int,
        joints: Array,
        tried_leg: Leg | None,
        attempts: Sequence[Attempt],
        deposited: int,
    ) -> tuple[Leg | None, Array] | None:
        """Return a clear leg off the end of a bead and its far joints; None without one.

        The leg is None if the end needs none.
        """
        if tried_leg is None and self._clear(joints[None], joints[None], deposited)[0]:
            return None, joints
        for leg in self._others(end, tried_leg, attempts):
            rows = np.vstack([joints, leg.joints])
            if self._clear(rows[:-1], rows[1:], deposited).all():
                return leg, leg.joints[-1]
        return None

    def _others(
        self, end: int, tried_leg: Leg | None, attempts: Sequence[Attempt]
    ) -> Iterator[Leg]:
        """Yield the leg tried before, then those of every attempt."""
        if tried_leg is not None:
            yield tried_leg
        for attempt in attempts:
            legs, _ = self.retracts.find_legs(
                np.array([end]),
                np.array([attempt.height]),
                attempt.direction,
                attempt.tolerance,
                thorough=False,
            )
            if legs[0] is not None:
                yield legs[0]

    def _between(self, start: Array, goal: Array, deposited: int) -> Array | None:
        """The places of a way round."""
        for via_points in self._known:
            route = np.vstack([start, via_points, goal])
            if self._clear(route[:-1], route[1:], deposited).all():
                return via_points
        return way_round(
            start,
            goal,
            self._ranges(start, goal),
            lambda a, b: self._clear(a, b, deposited),
            self._fits,
        )

    def _clear(self, start: Array, end: Array, deposited: int) -> Mask:
        """(k,) whether moves can be driven, and meet nothing."""
        continuous = self.cell.limits.continuous
        short: Mask = (np.abs(end - start)[:, continuous] <= LARGEST_TURN).all(axis=1)
        rows = np.flatnonzero(short)
        short[rows] = self.clear(
            Moves(start[rows], end[rows], np.full(len(rows), deposited, dtype=np.intp))
        )
        return short

    def _ranges(self, start: Array, goal: Array) -> Ranges:
        """Return the ranges of the axes between start and goal.

        Robot axes may use their limits, continuous axes half a turn beyond both ends, and external
        axes only the range between both ends.
        """
        limits, robot_axes = self.cell.limits, self.cell.robot.chain.axes
        lowest, highest = np.minimum(start, goal), np.maximum(start, goal)
        reserve = self.retracts.reserve_of_limits(RESERVE)[: limits.axes]
        low = np.where(limits.continuous, lowest - np.pi, limits.lower + reserve)
        high = np.where(limits.continuous, highest + np.pi, limits.upper - reserve)
        low[robot_axes:], high[robot_axes:] = lowest[robot_axes:], highest[robot_axes:]
        return Ranges(low, high, self.cell.machine.max_speed)

    def _fits(self, joints: Array) -> Mask:
        """(k,) whether joints keep limits and condition, and are of the configuration of the beads."""
        fits = self.retracts.fits(joints[:, None], self.retracts.reserve_of_limits(RESERVE))
        arm, branch = self.cell.robot.arm, self.retracts.branch
        rows = np.flatnonzero(fits)
        if branch is not None and arm is not None and len(rows):
            fits[rows] = arm.branch_of(joints[rows, : self.cell.robot.chain.axes]) == branch
        return fits
