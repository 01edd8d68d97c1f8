# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rapids between beads: retract, travel and approach, feasible for the machine and clear."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.bead_ends import Beads
from ...geometry.obstacles import Body
from ...geometry.step_count import step_count
from ...issues import ERROR, NOTE, Issue, Text
from ...kinematics.cell import Cell
from ...motion import APPROACH, RETRACT, TRAVEL
from ...parameters.joints import JointParameters
from ...types import Array, Integers, Mask
from .. import nozzle_obstacles
from ..arm_clearance import Cylinders, check_moves, clearance_issue, contact_of
from ..joint_path import BeadPath, JointPath
from .clearance import Moves, RapidObstacles
from .path_around_obstacles import LARGEST_TURN, Attempt, LedRound, attempts
from .retracts import DEFAULT_CHOICE, LIMIT, SINGULAR, Ends, Failure, Leg, Retracts, branch_of

# maximum number of additional moves to divide a large rotation into, to avoid a singularity
MORE_MOVES = 3


@dataclass(frozen=True, eq=False)
class Way:
    """The rapid to a bead, or the retract from the last bead.

    start: (axes,) joints before the first row; None before the first bead. joints: (m, axes).
    role: (m,) motion roles.
    """

    start: Array | None
    joints: Array
    role: Integers
    singular: float | None = None  # condition of an intermediate row, if below the minimum


class RapidWays:
    """The rapids of a joint path: rapid k leads to bead k, the last one off the last bead."""

    def __init__(
        self,
        joint_path: JointPath,
        cell: Cell,
        retract: float,
        bodies: Sequence[Body],
        parameters: JointParameters,
        width: float = 0.0,
        height: float = 0.0,
        cylinders: Cylinders = (),
    ) -> None:
        """width, height: size of beads without a size, mm."""
        self.beads, self.cell, self.retract = joint_path.beads, cell, retract
        self.retracts = Retracts(
            cell, Ends.of(self.beads), branch_of(joint_path.branch), parameters
        )
        # by index of the bead end, see `Ends`
        self.legs: dict[int, Leg | None] = dict.fromkeys(range(2 * len(self.beads)))
        self.failures: dict[int, Failure] = {}
        if retract > 0.0:
            self._ask()
        self.ways = [self._way(k, self.legs) for k in range(len(self.beads) + 1)]
        self.rows = np.concatenate([[0], np.cumsum([len(path.bead) for path in self.beads])])
        beads = [path.bead for path in self.beads]
        self.obstacles = RapidObstacles(cell, Beads.of(beads, width, height), bodies)
        self.arm = contact_of(beads, cell, cylinders, bodies, width, height)
        self.attempts = attempts(cell, retract, beads, bodies)
        self.raised: list[int] = []
        met, hopeless = self._clear()
        self.led = LedRound(cell, self.retracts, self._clear_moves)
        self.met = sorted({*self._lead_round(met), *hopeless})

    def _ask(self) -> None:
        """Find the requested legs, or the nearest feasible alternatives."""
        sound = np.flatnonzero(self.retracts.sound)
        legs, failures = self.retracts.find_legs(sound, np.full(len(sound), self.retract))
        for end, leg, failure in zip(sound.tolist(), legs, failures):
            self.legs[end] = leg
            if leg is None and failure is not None:
                self.failures[end] = failure
        unreachable = np.array(
            [end for end, leg in self.legs.items() if leg is None], dtype=np.intp
        )
        for end, leg in zip(
            unreachable.tolist(),
            self.retracts.asked(unreachable, np.full(len(unreachable), self.retract)),
        ):
            self.legs[end] = leg

    def ends(self, k: int) -> list[int]:
        """Return the bead ends that rapid k connects."""
        return [end for end in (2 * k - 1, 2 * k) if end in self.legs]

    def _way(self, k: int, legs: Mapping[int, Leg | None], round_: Array | None = None) -> Way:
        """Build rapid k from its legs.

        round_: (m, axes) via points between the legs, for a detour.
        """
        previous = self.beads[k - 1] if k else None
        path = self.beads[k] if k < len(self.beads) else None
        retract, onto = legs.get(2 * k - 1), legs.get(2 * k)
        rows: list[Array] = []
        role: list[int] = []
        if retract is not None:
            rows += list(retract.joints)
            role += [RETRACT] * len(rows)
        if path is not None:
            onward = [path.joints[0]] if onto is None else [*onto.joints[::-1], path.joints[0]]
            travels = [] if round_ is None else list(round_)
            rows += [*travels, *onward]
            role += [TRAVEL] * (1 + len(travels)) + [APPROACH] * (len(onward) - 1)
        start = None if previous is None else previous.joints[-1]
        joints = np.array(rows).reshape(-1, self.cell.machine.chain.axes)
        if start is None or path is None:
            return Way(start, joints, np.array(role, dtype=np.int64))
        return self._in_shorter_turns(Way(start, joints, np.array(role, dtype=np.int64)))

    def _in_shorter_turns(self, rapid: Way) -> Way:
        """Add rows to the rapid where a continuous axis rotates too far in one move."""
        assert rapid.start is not None
        rows_with_start = np.vstack([rapid.start, rapid.joints])
        continuous = self.cell.limits.continuous
        turn = np.fmax.reduce(
            np.abs(rows_with_start[1:, continuous] - rows_with_start[:-1, continuous]),
            axis=1,
            initial=0.0,
        )  # fmax ignores NaN
        if turn.max() <= LARGEST_TURN:
            return rapid
        rows: list[Array] = []
        role: list[int] = []
        singular: float | None = None
        for start, end, kind, turn_size in zip(
            rows_with_start[:-1], rows_with_start[1:], rapid.role.tolist(), turn.tolist()
        ):
            between, lowest_condition = self._between(
                start, end, step_count(turn_size, LARGEST_TURN)
            )
            singular = lowest_condition if singular is None else singular
            rows += [*between, end]
            role += [kind] * (len(between) + 1)
        return Way(rapid.start, np.array(rows), np.array(role, dtype=np.int64), singular)

    def _between(self, start: Array, end: Array, moves: int) -> tuple[list[Array], float | None]:
        """Return the rows that divide a move into `moves` parts, and their minimum condition.

        If a row is near a singularity, up to MORE_MOVES more parts are tried. The condition is
        None if a division avoids the singularity.
        """
        subdivisions = [
            [start + (end - start) * (k / count) for k in range(1, count)]
            for count in range(moves, moves + MORE_MOVES + 1)
        ]
        if moves == 1 or not np.isfinite(subdivisions[0]).all():
            return subdivisions[0], None
        lowest_conditions = [
            float(self.retracts.condition(np.array(rows)).min()) for rows in subdivisions
        ]
        for rows, condition in zip(subdivisions, lowest_conditions):
            if condition >= self.retracts.floor:
                return rows, None
        return subdivisions[0], lowest_conditions[0]

    def _moves(self, k: int, rapid: Way) -> Moves:
        """Return the moves of rapid k for the collision check."""
        joints = rapid.joints if rapid.start is None else np.vstack([rapid.start, rapid.joints])
        return Moves(
            joints[:-1], joints[1:], np.full(max(len(joints) - 1, 0), self.rows[k], dtype=np.intp)
        )

    def _find_collisions(self, numbers: Sequence[int], rapids: Sequence[Way]) -> list[int]:
        """Return which rapids of `numbers` hit an obstacle."""
        moves = [self._moves(k, rapid) for k, rapid in zip(numbers, rapids)]
        if not moves:
            return []
        together = Moves(*(np.concatenate(columns) for columns in zip(*moves)))
        met = ~self._clear_moves(together)
        number = np.repeat(
            np.arange(len(moves)), [len(moves_of_rapid.start) for moves_of_rapid in moves]
        )
        return [numbers[k] for k in np.unique(number[met]).tolist()]

    def _clear_moves(self, moves: Moves) -> Mask:
        """Return which moves (k,) are free of contact."""
        met = self.obstacles.find_collisions(moves)
        if self.cell.part_moves or self.cell.shapes.external_links:
            met |= nozzle_obstacles.find_contacts(self.cell, moves.start, moves.end).any(axis=0)
        remaining = np.flatnonzero(~met)
        if self.arm is not None and len(remaining):
            move, touched = check_moves(self.arm, *moves.of(remaining))
            met[remaining[move[touched.any]]] = True
        return ~met

    def _clear(self) -> tuple[list[int], set[int]]:
        """Replace rapids that hit an obstacle by higher or sideways retracts.

        Return the rapids that still hit an obstacle, and those that no retract can clear.
        """
        sound = self.retracts.sound
        candidates = [k for k in range(len(self.ways)) if sound[self.ends(k)].all()]
        met = self._find_collisions(candidates, [self.ways[k] for k in candidates])
        # if a link is too close at the bead end itself, no retract or approach helps
        hopeless = self._standing_too_near(met)
        met = [k for k in met if k not in hopeless]
        for attempt in self.attempts:
            if not met:
                break
            met = self._retry_with(met, attempt)
        return list(met), hopeless

    def _lead_round(self, met: Sequence[int]) -> list[int]:
        """Find detours around the obstacles; return the rapids without a detour."""
        unsolved = []
        for k in met:
            ends = (
                {}
                if k in (0, len(self.beads))
                else {2 * k - 1: self.beads[k - 1].joints[-1], 2 * k: self.beads[k].joints[0]}
            )
            detour = self.led.find_detour(ends, self.legs, self.attempts, self.rows[k])
            if detour is None:
                unsolved.append(k)
                continue
            legs, via_points = detour
            self.ways[k] = self._way(k, legs, via_points)
            self.legs.update(legs)
            for end in legs:
                self.failures.pop(end, None)
            self.led.ways.append(k)
        return unsolved

    def _standing_too_near(self, numbers: Sequence[int]) -> set[int]:
        """Return which rapids of `numbers` start or end with a link too close to an obstacle."""
        if self.arm is None or not numbers:
            return set()
        ends = [(k, self.beads[k - 1].joints[-1]) for k in numbers if k > 0]
        ends += [(k, self.beads[k].joints[0]) for k in numbers if k < len(self.beads)]
        touches = self.arm.touches(
            np.array([joints for _, joints in ends]), np.array([self.rows[k] for k, _ in ends])
        )
        return {k for (k, _), is_near in zip(ends, touches.any) if is_near}

    def _retry_with(self, met: Sequence[int], attempt: Attempt) -> list[int]:
        """Use an attempt for the rapids that it clears; return the other rapids."""
        # without a retract distance, the machine stays at the end of the last bead
        candidates = [k for k in met if self.retract > 0.0 or k < len(self.beads)]
        ends = np.array(sorted({end for k in candidates for end in self.ends(k)}), dtype=np.intp)
        legs_found, _ = self.retracts.find_legs(
            ends,
            np.full(len(ends), attempt.height),
            attempt.direction,
            attempt.tolerance,
            thorough=False,
        )
        legs: dict[int, Leg | None] = {
            end: leg for end, leg in zip(ends.tolist(), legs_found) if leg is not None
        }
        able = [k for k in candidates if all(end in legs for end in self.ends(k))]
        attempts_by_number = {k: self._way(k, legs) for k in able}
        still = set(self._find_collisions(able, list(attempts_by_number.values())))
        for k in able:
            if k not in still:
                self.ways[k] = attempts_by_number[k]
                for end in self.ends(k):
                    self.legs[end] = legs[end]
                    self.failures.pop(end, None)
                self.raised.append(k)
        return [k for k in met if k not in attempts_by_number or k in still]

    def place(self, k: int) -> BeadPath:
        """Return the bead that issues of rapid k refer to: the next bead, or the last one."""
        return self.beads[min(k, len(self.beads) - 1)]

    def reasons(self, k: int) -> list[str]:
        """Return the obstacles that the nozzle hits on rapid k."""
        moves = self._moves(k, self.ways[k])
        names = self.obstacles.names(moves)
        if self.cell.part_moves or self.cell.shapes.external_links:
            met = nozzle_obstacles.find_contacts(self.cell, moves.start, moves.end)
            adjacent = [
                name
                for name, hits in zip(nozzle_obstacles.in_the_way(self.cell), met)
                if hits.any()
            ]
            names += [name for name in adjacent if name not in names]
        return names

    def arm_issue(self, k: int) -> Issue | None:
        """Return an issue if a link gets too close to an obstacle on rapid k."""
        if self.arm is None:
            return None
        _, touched = check_moves(self.arm, *self._moves(k, self.ways[k]))
        if not touched.any.any():
            return None
        first_touch, path = int(np.argmax(touched.any)), self.place(k)
        link = self.arm.links[touched.link[first_touch]]
        what = self.arm.names[touched.what[first_touch]]
        return clearance_issue(self.cell, link, what, path.layer, path.index, on_way=True)


def findings(rapids: RapidWays) -> tuple[Issue, ...]:
    """Return the issues of the rapids.

    Parameters
    ----------
    rapids : RapidWays
        The rapids of a joint path.

    Returns
    -------
    tuple of Issue
        An error for each bead with an infeasible rapid, and notes about rapids that replace
        the requested ones.
    """
    met: list[Issue] = []
    for k in rapids.met:
        names, arm = rapids.reasons(k), rapids.arm_issue(k)
        if names or arm is None:
            met.append(_collision(names, rapids.place(k).layer, rapids.place(k).index))
        if arm is not None:
            met.append(arm)
    return (*met, *_failures(rapids), *_raised(rapids), *_others(rapids))


def _collision(names: Sequence[str], layer: int, bead: int) -> Issue:
    """Return the error of a bead on whose rapid the nozzle would hit the obstacles `names`."""
    return Issue(
        ERROR,
        "RAPID_COLLISION",
        Text(
            "on the travel from the previous bead the nozzle would hit {} at every retract "
            "distance and direction tried, and no detour was found; move the seam or the part, "
            "or use a more slender nozzle",
            Text.joined(", ", names),
        ),
        layer,
        bead,
    )


def _failures(rapids: RapidWays) -> list[Issue]:
    """Return one issue per bead, for its first failure."""
    first_issues: dict[tuple[int, int], Issue] = {}
    failed = [(rapids.beads[end // 2], failure) for end, failure in sorted(rapids.failures.items())]
    failed += [
        (rapids.place(k), Failure(SINGULAR, 0, rapid.singular, rapids.retracts.floor))
        for k, rapid in enumerate(rapids.ways)
        if rapid.singular is not None and rapids.retracts.sound[rapids.ends(k)].all()
    ]
    for path, failure in failed:
        first_issues.setdefault((path.layer, path.index), _failed(failure, path, rapids.cell))
    return list(first_issues.values())


def _failed(failure: Failure, path: BeadPath, cell: Cell) -> Issue:
    limits, machine = cell.limits, cell.machine
    if failure.kind == LIMIT:
        # coupled limits involve revolute axes only
        alone = failure.label < limits.axes
        unit, per = (
            (machine.units[failure.label], float(machine.unit_values[failure.label]))
            if alone
            else ("deg", float(machine.unit_values[-1]))
        )
        text: str = Text(
            "{} would be at {:.2f} {} on the retract before or after the bead, beyond its limit "
            "of {:g} {}, and no other height, direction or rotation is within limits; lower "
            "process.between_layers.lift or move the part in the cell",
            limits.labels[failure.label],
            failure.value / per,
            unit,
            failure.bound / per,
            unit,
        )
    elif failure.kind == SINGULAR:
        text = Text(
            "inverse condition number {:.4f} on a rapid before or after the bead is below {:g}, "
            "and no other height, direction or rotation is farther from a singularity; lower "
            "joints.min_condition or move the part in the cell",
            failure.value,
            failure.bound,
        )
    else:
        text = (
            "the retract before or after the bead cannot be reached at any height, direction or rotation tried; lower "
            "process.between_layers.lift or move the part in the cell"
        )
    return Issue(ERROR, f"RAPID_{failure.kind}", text, path.layer, path.index)


def _raised(rapids: RapidWays) -> list[Issue]:
    """Return notes about rapids that were changed for clearance."""
    raised, aside, highest = [], [], 0.0
    for k in sorted(rapids.raised):
        legs = [leg for end in rapids.ends(k) if (leg := rapids.legs[end]) is not None]
        height = max((leg.height for leg in legs), default=0.0)
        if height > rapids.retract:
            raised.append(rapids.place(k).layer)
            highest = max(highest, height)
        if any(leg.choice != DEFAULT_CHOICE for leg in legs):
            aside.append(rapids.place(k).layer)
    notes = []
    if raised:
        notes.append(
            Issue(
                NOTE,
                "RAPID_LIFTED",
                Text(
                    "before {} beads the tool retracts up to {:.3g} mm instead of {:g} mm for "
                    "clearance",
                    len(raised),
                    highest,
                    rapids.retract,
                ),
                raised[0],
            )
        )
    if aside:
        notes.append(
            Issue(
                NOTE,
                "RAPID_ASIDE",
                Text(
                    "before {} beads the tool retracts off its axis, or turns on the way, for "
                    "clearance",
                    len(aside),
                ),
                aside[0],
            )
        )
    if rapids.led.ways:
        notes.append(
            Issue(
                NOTE,
                "RAPID_ROUND",
                Text(
                    "before {} beads the rapid takes a detour through intermediate points, as "
                    "all direct retracts are blocked",
                    len(rapids.led.ways),
                ),
                rapids.place(rapids.led.ways[0]).layer,
            )
        )
    return notes


def _others(rapids: RapidWays) -> list[Issue]:
    """Return a note about rapids that replace infeasible retracts."""
    cleared = {end for k in (*rapids.raised, *rapids.led.ways) for end in rapids.ends(k)}
    changed_legs: list[tuple[int, Leg]] = [
        (end, leg)
        for end, leg in rapids.legs.items()
        if leg is not None and leg.choice != DEFAULT_CHOICE and end not in cleared
    ]
    if not changed_legs:
        return []
    heights = [leg.height for _, leg in changed_legs]
    leaning = sum(leg.choice.direction != DEFAULT_CHOICE.direction for _, leg in changed_legs)
    turning = sum(
        (leg.choice.turn, leg.choice.lean) != (DEFAULT_CHOICE.turn, DEFAULT_CHOICE.lean)
        for _, leg in changed_legs
    )
    return [
        Issue(
            NOTE,
            "RAPID_OTHER",
            Text(
                "at {} bead ends the retract of {:g} mm would violate joint limits, reach or the "
                "condition number; the retract is {:.3g} to {:.3g} mm there, {} times off the "
                "tool axis and {} times with the tool turned",
                len(changed_legs),
                rapids.retract,
                min(heights),
                max(heights),
                leaning,
                turning,
            ),
            rapids.beads[changed_legs[0][0] // 2].layer,
        )
    ]
