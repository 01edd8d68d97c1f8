# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cell set-ups: one record per set-up states its consequences, so code never tests for a set-up."""

from __future__ import annotations

from dataclasses import dataclass

from ..issues import InputError


@dataclass(frozen=True)
class Arrangement:
    """What the flange carries, and its consequences.

    setup: value of `cell.setup`. carries_part: the flange carries the part under a fixed nozzle;
    otherwise it carries the nozzle. free: number of coordinates that point and tool axis leave free
    without external axes; on a robot it is the rotation about the tool axis. holds_part: a robot
    holds and rotates the part, so linear motion in the world is not a line on the part.
    links_known: files describe the links, so collisions can be checked; otherwise links are only
    drawn. named_axes: the controller names axes (X, A) instead of numbering them. planned: jobs can
    use this set-up.
    """

    setup: str
    carries_part: bool
    free: int
    holds_part: bool
    links_known: bool
    named_axes: bool
    planned: bool = True


_HOLDING_PART = Arrangement(
    "part-on-robot",
    carries_part=True,
    free=1,
    holds_part=True,
    links_known=True,
    named_axes=False,
)
_HOLDING_TOOL = Arrangement(
    "tool-on-robot",
    carries_part=False,
    free=1,
    holds_part=False,
    links_known=True,
    named_axes=False,
)
_WITH_POSITIONER = Arrangement(
    "tool-on-robot+positioner",
    carries_part=False,
    free=1,
    holds_part=False,
    links_known=True,
    named_axes=False,
    planned=False,
)
# the chain begins at the torch, so its flange always carries the part
_FIVE_AXIS = Arrangement(
    "rotary-table",
    carries_part=True,
    free=0,
    holds_part=False,
    links_known=False,
    named_axes=True,
)
OF_ROBOTS = (_HOLDING_PART, _HOLDING_TOOL, _WITH_POSITIONER)  # the most common set-up first
OF_FIVE_AXES = (_FIVE_AXIS,)
_ALL = {one.setup: one for one in (*OF_ROBOTS, *OF_FIVE_AXES)}


def arrangement_of(setup: str) -> Arrangement:
    """Return the record of a set-up. Raises KeyError for an unknown set-up."""
    return _ALL[setup]


def planned_of(setup: str) -> Arrangement:
    """Return the record of a set-up.

    Raises InputError NOT_YET for a set-up that jobs cannot use yet.
    """
    arrangement = _ALL.get(setup)
    if arrangement is None or not arrangement.planned:
        *other_setups, last_setup = (
            candidate.setup for candidate in _ALL.values() if candidate.planned
        )
        raise InputError(
            "NOT_YET",
            "cell.setup",
            "{} cannot be planned yet; use {} or {}",
            setup,
            ", ".join(other_setups),
            last_setup,
        )
    return arrangement
