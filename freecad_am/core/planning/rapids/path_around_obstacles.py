# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path planning around obstacles in joint space, by sampling.

Two trees of clear moves grow from both ends towards the same samples until a clear move joins them
(RRT-Connect, after Kuffner and LaValle 2000). Here they grow by many samples at once. The joined
path is then shortened: the fastest sequence of clear moves between its points is kept, and these
points are pulled towards their neighbours as far as the path stays clear. The samples are
deterministic, so the same job always has the same rapids.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.obstacles import Body
from ...geometry.step_count import spread_points
from ...kinematics.cell import Cell
from ...kinematics.limits import RESERVE
from ...program import SHORTEST_RAPID
from ...toolpath import Bead
from ...types import Array, Index, Mask
from .clearance import Moves
from .retracts import DIRECTIONS, STRAY_MM, Leg, Retracts

# multiples of the retract distance to try; then each height is extended until it clears everything
RETRACT_FACTORS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
EXTENSION_FACTOR = 1.5
# mm; first retract distance to try if the requested distance is 0
FIRST_RETRACT = 2.0
# mm; maximum deviation from the straight line for a retract that hits an obstacle on its way
FINE_MM = 0.02
# retract distances in other directions than the tool axis, relative to the requested distance
SIDE_SHARES = (1.0, 4.0)


@dataclass(frozen=True)
class Attempt:
    """A retract to try.

    height: mm. direction: index. tolerance: maximum deviation from the straight line, mm.
    """

    height: float
    direction: int = 0
    tolerance: float = STRAY_MM


def attempts(
    cell: Cell, retract: float, beads: Sequence[Bead], bodies: Sequence[Body]
) -> list[Attempt]:
    """Return the retracts to try after the requested one.

    Heights increase until the nozzle is outside the sphere around all obstacles.

    Parameters
    ----------
    cell : Cell
        The cell, including the platform.
    retract : float
        Requested height, mm; 0 for no retract.
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
    # from any point inside, moving by the diameter in any direction leads outside
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
]  # whether joint moves (k,) from (k, axes) to (k, axes) are clear
Fits = Callable[[Array], Mask]  # whether joints (k, axes) are allowed, (k,)

BATCH, ROUNDS = 32, 30  # samples per growth step, and number of growth steps
FULL_RANGE_ROUND = (
    10  # growth steps until samples cover the full ranges; the first samples lie near both ends
)
STEP = 0.2  # maximum length of a growth move, fraction of the ranges
SHORTENED = 4  # number of shortening passes
PULLS = np.array([0.0, 0.03, 0.1, 0.3])  # fractions of the way to the midpoint of the neighbours


@dataclass(frozen=True, eq=False)
class Ranges:
    """The search space of the joints: low, high (axes,), and the maximum speed of each axis."""

    low: Array
    high: Array
    speed: Array

    def lasts(self, start: Array, end: Array) -> Array:
        """Return the duration of moves, limited by the slowest axis.

        Parameters
        ----------
        start, end : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (...) array
            Durations, s.
        """
        seconds: Array = (np.abs(end - start) / self.speed).max(axis=-1)
        return seconds


class _Tree:
    """A tree of joint positions that clear moves connect.

    place: (n, axes). parent: (n,) index of the previous position. lasts: (n,) duration from the
    root, s.
    """

    def __init__(self, root: Array) -> None:
        self.place, self.parent, self.lasts = root[None], np.array([-1]), np.zeros(1)

    def nearest(self, ranges: Ranges, position: Array) -> Index:
        """Return the indices (k,) of the nodes nearest to positions (k, axes)."""
        return np.asarray(ranges.lasts(self.place[None], position[:, None]).argmin(axis=1))

    def add_nodes(self, position: Array, parent: Index, lasts: Array) -> None:
        """Add positions, each with the duration `lasts` (s) of the move from its parent."""
        self.place = np.concatenate([self.place, position])
        self.lasts = np.concatenate([self.lasts, self.lasts[parent] + lasts])
        self.parent = np.concatenate([self.parent, parent])

    def back(self, number: int) -> list[Array]:
        """Return the positions from a node back to the root."""
        route = []
        while number >= 0:
            route.append(self.place[number])
            number = int(self.parent[number])
        return route


def way_round(start: Array, end: Array, ranges: Ranges, free: Free, fits: Fits) -> Array | None:
    """Find a clear path between two joint positions.

    Parameters
    ----------
    start, end : (axes,) array
        Joint positions, rad or mm.
    ranges : Ranges
        Search space and axis speeds.
    free : Free
        Returns whether moves between joint positions are clear.
    fits : Fits
        Returns whether joint positions keep limits and condition.

    Returns
    -------
    (m, axes) array or None
        Intermediate positions; None if the search fails.
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
    """Return positions (m, axes) of a clear path, both ends included; None if there is none."""
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
    """Grow a tree towards samples; return the indices of the added nodes."""
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
    """Return the node of each tree where a clear move joins the trees with the shortest duration.

    Only nodes `added` to the first tree are considered. None if no move is clear.
    """
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
    """Return the fastest clear path through a subset of the positions (m, axes) of a clear path.

    The first and last position stay.
    """
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
    """Pull inner positions of a path (m, axes) towards the midpoint of their neighbours.

    Each position moves or stays so that the duration is minimal and all moves stay clear.
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


# rad; maximum rotation of a continuous axis in one rapid: such an axis takes the shorter way, which
# is ambiguous at half a turn
LARGEST_TURN = np.radians(170.0)
# failed searches before the search for detours stops: a search takes seconds, and the job is
# infeasible
MAX_FAILED_DETOURS = 3
KNOWN = 8  # number of earlier detours to try first

Legs = dict[int, Leg | None]


class LedRound:
    """Finds detours around obstacles.

    The argument `clear` returns whether moves are free of contact. The attribute `ways` lists the
    rapids with a detour.
    """

    def __init__(self, cell: Cell, retracts: Retracts, clear: Callable[[Moves], Mask]) -> None:
        self.cell, self.retracts, self.clear = cell, retracts, clear
        self.ways: list[int] = []
        self._lost = 0
        self._known: list[
            Array
        ] = []  # positions of the last detours, in both directions, because detours often repeat

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
            Joints (axes,) at the bead ends, by end index.
        legs : Mapping[int, Leg or None]
            Legs tried before, by end index; None without a leg.
        attempts : sequence of Attempt
            Retracts to try.
        deposited : int
            Number of points printed before.

        Returns
        -------
        legs : dict
            Leg or None, by end index.
        via_points : (m, axes) array
            Joint positions between the legs.

        Notes
        -----
        The result is None if the search fails, or if it has failed too often before.
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
        """Return a clear leg from a bead end and its far joints; None if there is none.

        The leg is None if the end needs no leg.
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
        """Yield the leg tried before, then the legs of all attempts."""
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
        """Return the intermediate positions of a detour; None if there is none."""
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
        """Return which moves (k,) are possible and clear."""
        continuous = self.cell.limits.continuous
        short: Mask = (np.abs(end - start)[:, continuous] <= LARGEST_TURN).all(axis=1)
        rows = np.flatnonzero(short)
        short[rows] = self.clear(
            Moves(start[rows], end[rows], np.full(len(rows), deposited, dtype=np.intp))
        )
        return short

    def _ranges(self, start: Array, goal: Array) -> Ranges:
        """Return the ranges of the axes between start and goal.

        Robot axes may use their full limits, continuous axes half a turn beyond start and goal, and
        external axes only the range between them.
        """
        limits, robot_axes = self.cell.limits, self.cell.robot.chain.axes
        lowest, highest = np.minimum(start, goal), np.maximum(start, goal)
        reserve = self.retracts.reserve_of_limits(RESERVE)[: limits.axes]
        low = np.where(limits.continuous, lowest - np.pi, limits.lower + reserve)
        high = np.where(limits.continuous, highest + np.pi, limits.upper - reserve)
        low[robot_axes:], high[robot_axes:] = lowest[robot_axes:], highest[robot_axes:]
        return Ranges(low, high, self.cell.machine.max_speed)

    def _fits(self, joints: Array) -> Mask:
        """Return which joints (k,) keep limits, condition and the configuration of the beads."""
        fits = self.retracts.fits(joints[:, None], self.retracts.reserve_of_limits(RESERVE))
        arm, branch = self.cell.robot.arm, self.retracts.branch
        rows = np.flatnonzero(fits)
        if branch is not None and arm is not None and len(rows):
            fits[rows] = arm.branch_of(joints[rows, : self.cell.robot.chain.axes]) == branch
        return fits
