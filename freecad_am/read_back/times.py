# SPDX-License-Identifier: LGPL-2.1-or-later
"""Times and speeds of a text against the planned ones: of each move to what its digits allow, and of each bead."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array, Mask

from ..core.issues import Issue
from ..core.kinematics.cell import Cell
from ..core.program import FIRST_SHARE, FIRST_TIME, SHORTEST_RAPID
from ..core.read_moves import ReadMoves
from .planned import COMPUTED_AXIS, Planned
from .text_path import digits

# s: the step of a time in milliseconds and in tenths of a second, and where the second begins
MILLISECOND, TENTH, LONGEST_MSEC = 0.001, 0.05, 32.0
# rad: a rapid that turns no axis farther than this has no time to speak of
STILL = 2e-5


def time_issues(cell: Cell, planned: Planned, text: ReadMoves) -> list[Issue]:
    """Times against the planned speed: each move to what its digits allow, and each bead as a whole.

    The first move of all starts from a place the program does not know: it goes at its own share of the axes' speeds, or
    takes its own time.
    """
    timed = np.arange(len(text.duration)) > 0
    step = np.linalg.norm(np.diff(planned.position, axis=0, prepend=planned.position[:1]), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        expected = np.where(planned.deposit, step / planned.speed, planned.duration)
    text_speed = np.full(len(timed), np.nan) if text.speed is None else text.speed
    by_speed = np.isfinite(text_speed)
    off = by_speed & ~(np.abs(text_speed - planned.speed) <= text.speed_digits + 1e-9)
    issues = planned.issue("VERIFY_SPEED", off, "the speed in the text is not the planned one")
    timed &= ~by_speed
    allowed = np.where(expected < LONGEST_MSEC, MILLISECOND, TENTH) + 1e-9
    text_times, coarse = text.duration, allowed > TENTH
    if text.duration_digits is not None:
        allowed, coarse = (
            text.duration_digits + 1e-9 * expected + 1e-12,
            np.ones(len(timed), dtype=bool),
        )
    if cell.arrangement.named_axes:  # rapids at the machine's own speed: the text says no more
        timed &= planned.deposit | np.isfinite(text_times)
    # written as 1 ms, the shortest there is
    short = timed & ~planned.deposit & (expected < MILLISECOND) & (text_times <= MILLISECOND + 1e-9)
    if text.share is not None:
        times, times_allowed, tame = _share_times(cell, planned, text, text.share, expected)
        by_share = np.isfinite(text.share)
        text_times, allowed = (
            np.where(by_share, times, text_times),
            np.where(by_share, times_allowed, allowed),
        )
        coarse |= by_share
        short |= timed & ~planned.deposit & by_share & tame
    allowed_below = allowed + np.where(coarse, 0.0, owed(expected))
    wrong = (
        timed
        & ~short
        & ~((text_times - expected <= allowed) & (expected - text_times <= allowed_below))
    )
    issues += planned.issue(
        "VERIFY_TIME", wrong, "the time in the text does not give the planned speed"
    )
    share = np.nan if text.share is None else float(text.share[0])
    is_slow_first = (
        abs(share - FIRST_SHARE) <= 1e-6 or abs(text_times[0] - FIRST_TIME) <= allowed[0] + 1e-6
    )
    message = "the first move, from the unknown start position, is too fast"
    issues += planned.issue(
        "VERIFY_TIME", np.arange(len(timed)) == (-1 if is_slow_first else 0), message
    )
    beads = np.flatnonzero(np.diff(planned.deposit, prepend=False) & planned.deposit)
    if len(beads) and not issues:
        off = np.where(planned.deposit & timed, text_times - expected, 0.0)
        rounded = np.where(planned.deposit & coarse, allowed, 0.0)
        excess = np.abs(np.add.reduceat(off, beads)) > MILLISECOND + np.add.reduceat(rounded, beads)
        is_slow_first = np.isin(np.arange(len(timed)), beads[excess])
        issues += planned.issue(
            "VERIFY_TIME", is_slow_first, "the times of a bead do not add up to the planned one"
        )
    return issues


def owed(expected: Array) -> Array:
    """(n,) s that moves of `expected` (n,) s may be shorter because others beside them want less than a millisecond."""
    debt = np.zeros((2, len(expected) + 1))
    for row, seconds in zip(debt, (expected, expected[::-1])):
        row[1:] = np.cumsum(MILLISECOND - np.minimum(np.nan_to_num(seconds), TENTH))
        row -= np.minimum.accumulate(row)
    return np.asarray(debt[0, :-1] + debt[1, -2::-1])


def _share_times(
    cell: Cell, planned: Planned, text: ReadMoves, share: Array, expected: Array
) -> tuple[Array, Array, Mask]:
    """(n,) s of moves in which the fastest axis runs at a share of its largest speed, what the digits allow, and which
    may take another time than is wanted, being too short to tell or no longer at the least share there is; from the joint
    values of the text, where it has them."""
    controller_values = cell.machine.to_controller(planned.joints)
    if text.joints is not None:
        controller_values = np.where(np.isnan(text.joints), controller_values, text.joints)
    turned = np.abs(np.diff(controller_values, axis=0, prepend=controller_values[:1]))
    times = (turned / cell.machine.max_speed).max(axis=1) / share
    # a move that begins where the text has no joint values is off by the digits of both its ends
    ends = 2.0 * float((digits(cell, text) / cell.machine.max_speed).max()) / share
    # the share itself was as much as a half digit less: at few percent that is more of the time than of the share
    lowest_share = np.maximum(share - text.share_digits, 0.5 * share)
    slowest = (
        (expected <= SHORTEST_RAPID * (1.0 + 1e-9))
        & (share <= 2.0 * text.share_digits)
        & (times <= expected)
    )
    tame = (turned.max(axis=1) < STILL) | slowest
    return times, times * text.share_digits / lowest_share + ends + COMPUTED_AXIS, tame
