# SPDX-License-Identifier: LGPL-2.1-or-later
"""Errors of the rapids of a job, and notes on rapids that differ from the requested ones."""

from __future__ import annotations

from collections.abc import Sequence

from ...issues import ERROR, NOTE, Issue, Text
from ...kinematics.cell import Cell
from ..joint_path import BeadPath
from .retract_ways import DEFAULT_CHOICE, LIMIT, SINGULAR, Failure, Leg
from .ways import RapidWays


def findings(rapids: RapidWays) -> tuple[Issue, ...]:
    """Return an error for each bead that cannot be reached or left, and notes about rapids that replace
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
    """Return the error of a bead on whose rapid the nozzle would meet the obstacles `names`."""
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
    """One issue for each bead, for its first reason."""
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
        # what couples axes couples turning ones
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
    """Notes about other ways taken because something was met."""
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
    """A note about other ways taken because the machine cannot go those asked for."""
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
                "at {} bead ends the retract of {:g} mm would violate limits, reach or the "
                "condition; it is {:.3g} to {:.3g} mm there, {} times off the tool axis and {} "
                "times with the tool turned",
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
