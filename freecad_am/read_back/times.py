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


def time_issues(cell: Cell, planned: Planned, read: ReadMoves) -> list[Issue]:
    """Times against the planned speed: each move to what its digits allow, and each bead as a whole.

    The first move of all starts from a place the program does not know: it goes at its own share of the axes' speeds, or
    takes its own time.
    """
    timed = np.arange(len(read.duration)) > 0
    step = np.linalg.norm(np.diff(planned.position, axis=0, prepend=planned.position[:1]), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        wanted = np.where(planned.deposit, step / planned.speed, planned.duration)
    given = np.full(len(timed), np.nan) if read.speed is None else read.speed
    by_speed = np.isfinite(given)
    off = by_speed & ~(np.abs(given - planned.speed) <= read.speed_digits + 1e-9)
    issues = planned.issue("VERIFY_SPEED", off, "the speed in the text is not the planned one")
    timed &= ~by_speed
    allowed = np.where(wanted < LONGEST_MSEC, MILLISECOND, TENTH) + 1e-9
    taken, coarse = read.duration, allowed > TENTH
    if read.duration_digits is not None:
        allowed, coarse = (
            read.duration_digits + 1e-9 * wanted + 1e-12,
            np.ones(len(timed), dtype=bool),
        )
    if cell.arrangement.named_axes:  # rapids at the machine's own speed: the text says no more
        timed &= planned.deposit | np.isfinite(taken)
    # written as 1 ms, the shortest there is
    short = timed & ~planned.deposit & (wanted < MILLISECOND) & (taken <= MILLISECOND + 1e-9)
    if read.share is not None:
        times, times_allowed, tame = _share_times(cell, planned, read, read.share, wanted)
        by_share = np.isfinite(read.share)
        taken, allowed = (
            np.where(by_share, times, taken),
            np.where(by_share, times_allowed, allowed),
        )
        coarse |= by_share
        short |= timed & ~planned.deposit & by_share & tame
    least = allowed + np.where(coarse, 0.0, owed(wanted))
    wrong = timed & ~short & ~((taken - wanted <= allowed) & (wanted - taken <= least))
    issues += planned.issue(
        "VERIFY_TIME", wrong, "the time in the text does not give the planned speed"
    )
    share = np.nan if read.share is None else float(read.share[0])
    first = abs(share - FIRST_SHARE) <= 1e-6 or abs(taken[0] - FIRST_TIME) <= allowed[0] + 1e-6
    message = "the first move, from wherever the machine stands, is not as slow as it has to be"
    issues += planned.issue("VERIFY_TIME", np.arange(len(timed)) == (-1 if first else 0), message)
    beads = np.flatnonzero(np.diff(planned.deposit, prepend=False) & planned.deposit)
    if len(beads) and not issues:
        off = np.where(planned.deposit & timed, taken - wanted, 0.0)
        rounded = np.where(planned.deposit & coarse, allowed, 0.0)
        excess = np.abs(np.add.reduceat(off, beads)) > MILLISECOND + np.add.reduceat(rounded, beads)
        first = np.isin(np.arange(len(timed)), beads[excess])
        issues += planned.issue(
            "VERIFY_TIME", first, "the times of a bead do not add up to the planned one"
        )
    return issues


def owed(wanted: Array) -> Array:
    """(n,) s that moves of `wanted` (n,) s may be shorter because others beside them want less than a millisecond."""
    debt = np.zeros((2, len(wanted) + 1))
    for row, way in zip(debt, (wanted, wanted[::-1])):
        row[1:] = np.cumsum(MILLISECOND - np.minimum(np.nan_to_num(way), TENTH))
        row -= np.minimum.accumulate(row)
    return np.asarray(debt[0, :-1] + debt[1, -2::-1])


def _share_times(
    cell: Cell, planned: Planned, read: ReadMoves, share: Array, wanted: Array
) -> tuple[Array, Array, Mask]:
    """(n,) s of moves in which the fastest axis runs at a share of its largest speed, what the digits allow, and which
    may take another time than is wanted, being too short to tell or no longer at the least share there is; from the joint
    values of the text, where it has them."""
    shown = cell.machine.to_controller(planned.joints)
    if read.joints is not None:
        shown = np.where(np.isnan(read.joints), shown, read.joints)
    turned = np.abs(np.diff(shown, axis=0, prepend=shown[:1]))
    times = (turned / cell.machine.max_speed).max(axis=1) / share
    # a move that begins where the text has no joint values is off by the digits of both its ends
    ends = 2.0 * float((digits(cell, read) / cell.machine.max_speed).max()) / share
    # the share itself was as much as a half digit less: at few percent that is more of the time than of the share
    least = np.maximum(share - read.share_digits, 0.5 * share)
    slowest = (
        (wanted <= SHORTEST_RAPID * (1.0 + 1e-9))
        & (share <= 2.0 * read.share_digits)
        & (times <= wanted)
    )
    tame = (turned.max(axis=1) < STILL) | slowest
    return times, times * read.share_digits / least + ends + COMPUTED_AXIS, tame
