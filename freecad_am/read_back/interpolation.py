# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare the interpolation of a text with the plan: straight motion, times, stops, corner
rounding, frames and arm configurations.
"""

from __future__ import annotations

import numpy as np

from ..core.issues import ERROR, Issue, Text
from ..core.kinematics.cell import Cell
from ..core.kinematics.inverse import spherical_wrist
from ..core.program import FIRST_SHARE, FIRST_TIME, LINEAR_MOVE, SHORTEST_RAPID, Program
from ..core.read_moves import Configuration, ReadMoves
from ..core.types import Array, Mask
from .text_path import COMPUTED_AXIS, Planned, digits, pieces

# s: tolerance of times in milliseconds and of times in tenths of a second; longest time in
# milliseconds
MILLISECOND, TENTH, LONGEST_MSEC = 0.001, 0.05, 32.0
# rad; a rapid that rotates every axis by less has a negligible duration
STILL = 2e-5


def time_issues(cell: Cell, planned: Planned, text: ReadMoves) -> list[Issue]:
    """Compare times with the planned speed: each move within its rounding, and each bead in total.

    The first move starts from an unknown position. It uses a fixed fraction of the axis speeds
    (FIRST_SHARE) or a fixed time (FIRST_TIME).
    """
    timed = np.arange(len(text.duration)) > 0
    step = np.linalg.norm(np.diff(planned.position, axis=0, prepend=planned.position[:1]), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        expected = np.where(planned.deposit, step / planned.speed, planned.duration)
    text_speed = np.full(len(timed), np.nan) if text.speed is None else text.speed
    by_speed = np.isfinite(text_speed)
    off = by_speed & ~(np.abs(text_speed - planned.speed) <= text.speed_digits + 1e-9)
    issues = planned.issue("VERIFY_SPEED", off, "the speed in the program differs from the plan")
    timed &= ~by_speed
    allowed = np.where(expected < LONGEST_MSEC, MILLISECOND, TENTH) + 1e-9
    text_times, coarse = text.duration, allowed > TENTH
    if text.duration_digits is not None:
        allowed, coarse = (
            text.duration_digits + 1e-9 * expected + 1e-12,
            np.ones(len(timed), dtype=bool),
        )
    # the machine tool moves rapids at its own speed, and the text gives no time
    if cell.arrangement.named_axes:
        timed &= planned.deposit | np.isfinite(text_times)
    # rapids below 1 ms are written as 1 ms, the shortest time
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
        "VERIFY_TIME", wrong, "the time in the program does not match the planned speed"
    )
    share = np.nan if text.share is None else float(text.share[0])
    is_slow_first = (
        abs(share - FIRST_SHARE) <= 1e-6 or abs(text_times[0] - FIRST_TIME) <= allowed[0] + 1e-6
    )
    message = "the first move, from an unknown start position, is too fast"
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
            "VERIFY_TIME", is_slow_first, "the times of a bead do not add up to the planned time"
        )
    return issues


def owed(expected: Array) -> Array:
    """Return how much shorter (n,), s, moves of `expected` (n,) s may be because their neighbours
    take less than a millisecond.
    """
    debt = np.zeros((2, len(expected) + 1))
    for row, seconds in zip(debt, (expected, expected[::-1])):
        row[1:] = np.cumsum(MILLISECOND - np.minimum(np.nan_to_num(seconds), TENTH))
        row -= np.minimum.accumulate(row)
    return np.asarray(debt[0, :-1] + debt[1, -2::-1])


def _share_times(
    cell: Cell, planned: Planned, text: ReadMoves, share: Array, expected: Array
) -> tuple[Array, Array, Mask]:
    """Return times (n,) of moves whose fastest axis runs at a fraction of its maximum speed, their
    tolerances, and exceptions.

    Joint values of the text determine the times, if it has any. Exceptions may take another time:
    they are too short to express, or already use the smallest fraction.
    """
    controller_values = cell.machine.to_controller(planned.joints)
    if text.joints is not None:
        controller_values = np.where(np.isnan(text.joints), controller_values, text.joints)
    turned = np.abs(np.diff(controller_values, axis=0, prepend=controller_values[:1]))
    times = (turned / cell.machine.max_speed).max(axis=1) / share
    # a move that starts where the text has no joint values is off by the rounding at both ends
    ends = 2.0 * float((digits(cell, text) / cell.machine.max_speed).max()) / share
    # the true fraction may be lower by half a digit, which at a few percent changes the time more
    # than the fraction
    lowest_share = np.maximum(share - text.share_digits, 0.5 * share)
    slowest = (
        (expected <= SHORTEST_RAPID * (1.0 + 1e-9))
        & (share <= 2.0 * text.share_digits)
        & (times <= expected)
    )
    tame = (turned.max(axis=1) < STILL) | slowest
    return times, times * text.share_digits / lowest_share + ends + COMPUTED_AXIS, tame


# mm; tolerance of a distance that a text rounds to thousandths
THOUSANDTH = 0.0011
# corner-rounding levels of a controller that grades corners
LEVELS = 8
# maximum blend radius at a point, as a fraction of the shorter adjacent segment
BLEND_SHARE = 0.4
# rad; within this angle of half a turn, either turn number is right
HALF_TURN = np.radians(0.001)


def way_issues(cell: Cell, planned: Planned, program: Program, text: ReadMoves) -> list[Issue]:
    """Return VERIFY_INTERPOLATION, VERIFY_BLEND, VERIFY_FRAME and VERIFY_CONFIGURATION issues."""
    linear = np.repeat(
        [run.interpolation == LINEAR_MOVE for run in program.moves],
        [len(run) for run in program.moves],
    )
    return [
        *planned.issue(
            "VERIFY_INTERPOLATION",
            text.linear != linear,
            "the program has a linear move where a joint move is planned, or the reverse",
        ),
        *planned.issue(
            "VERIFY_BLEND",
            _rounded_otherwise(cell, planned, program, text),
            "the program stops at the point or rounds the corner differently than planned",
        ),
        *_frame_issues(cell, planned, program, text, linear),
        *_configuration_issues(cell, planned, program, text.configuration),
        *_near_issues(cell, planned, text),
    ]


def _rounded_otherwise(cell: Cell, planned: Planned, program: Program, text: ReadMoves) -> Mask:
    """Whether moves (n,) differ from the plan in stops or in corner rounding."""
    if text.level is not None:
        level = np.where(planned.stops, 0.0, np.ceil(0.01 * LEVELS * program.blend))
        return np.asarray(text.level != level)
    if text.blend_radius is not None:
        return _blended_otherwise(cell, planned, program, text)
    if text.blend is not None:
        return np.asarray(
            (text.stops != planned.stops) | (~planned.stops & (text.blend != program.blend))
        )
    if text.rounding is None:
        return np.asarray(text.stops != planned.stops)
    # the text names the last corner of a bead although the robot stops there; zero rounding is a
    # stop
    table = bool(program.axis_names)
    rounding = (
        np.full(len(text.stops), program.nc.tolerance)
        if table
        else _share_of_shortest(planned, program.blend)
    )
    rounded = np.where(np.isnan(text.rounding), 0.0, text.rounding)
    # where a stop is planned, a stop without rounding is complete
    rounding = np.where(
        planned.deposit & ~(planned.stops & text.stops & np.isnan(text.rounding)), rounding, 0.0
    )
    rounding = np.where(planned.halt, 0.0, rounding)
    off = ~(np.abs(rounded - rounding) <= (1e-5 if table else THOUSANDTH))
    return np.asarray(
        (planned.stops & ~text.stops) | ~planned.stops & text.stops & (rounded > 0.0) | off
    )


def _blended_otherwise(cell: Cell, planned: Planned, program: Program, text: ReadMoves) -> Mask:
    """Whether moves (n,) of a text with blend radii differ from the plan in stops or in radius.

    The radius is `program.blend` percent of BLEND_SHARE times the shorter adjacent segment, along
    the path of the text's tool. Neighbouring blends therefore never meet.
    """
    assert text.blend_radius is not None and text.tool is not None
    tip = np.empty_like(planned.position)
    for rows in pieces(np.arange(len(tip))):
        flange = cell.machine.chain.forward(planned.joints[rows])
        tip[rows] = (
            np.einsum("nij,nj->ni", flange[:, :3, :3], text.tool[rows, :3, 3]) + flange[:, :3, 3]
        )
    step_lengths = np.linalg.norm(np.diff(tip, axis=0, prepend=tip[:1]), axis=1)
    radius = (
        0.01
        * BLEND_SHARE
        * program.blend
        * np.minimum(step_lengths, np.append(step_lengths[1:], 0.0))
    )
    passed = ~planned.stops & (radius > 0.0)
    off = np.abs(text.blend_radius - np.where(passed, radius, 0.0)) > THOUSANDTH
    return np.asarray((planned.stops & ~text.stops) | passed & text.stops | off)


def _share_of_shortest(planned: Planned, blend: float) -> Array:
    """Return the blend (n,), mm: percent of half the shortest move of each bead, at most 100 mm."""
    starts = np.flatnonzero(np.diff(planned.deposit, prepend=False))
    length = np.where(planned.deposit, planned.speed * planned.duration, np.inf)
    if not len(starts):
        return np.zeros(len(length))
    beads = np.repeat(np.minimum.reduceat(length, starts), np.diff([*starts, len(length)]))
    shortest = np.concatenate([np.full(starts[0], np.inf), beads])
    return np.minimum(0.005 * blend * np.where(np.isfinite(shortest), shortest, 0.0), 100.0)


def _frame_issues(
    cell: Cell, planned: Planned, program: Program, text: ReadMoves, linear: Mask
) -> list[Issue]:
    wrong = np.zeros(len(linear), dtype=bool)
    if text.user_frame is not None:
        checked = linear if program.axis_names else np.ones(len(linear), dtype=bool)
        wrong |= checked & (text.user_frame != program.user_frame)
    if text.tool_frame is not None:
        wrong |= text.tool_frame != program.tool_frame
    message = Text(
        "the program selects a frame or tool that differs from {} and {}",
        program.user_frame,
        program.tool_frame,
    )
    issues = planned.issue("VERIFY_FRAME", wrong, message)
    if program.external_kinds and (text.unit, text.first_external) != (
        program.unit,
        program.first_external,
    ):
        issues.append(
            Issue(
                ERROR,
                "VERIFY_FRAME",
                Text(
                    "the text moves {} from axis {} on, but the plan moves {} from axis {} on",
                    text.unit or "no positioner",
                    text.first_external,
                    program.unit,
                    program.first_external,
                ),
            )
        )
    return issues


def _near_issues(cell: Cell, planned: Planned, text: ReadMoves) -> list[Issue]:
    """Compare the nearby joint values given with positions with the planned joint values."""
    if text.near is None:
        return []
    differences = np.abs(text.near - cell.machine.to_controller(planned.joints))
    wrong = (np.isfinite(differences) & ~(differences <= text.near_digits + COMPUTED_AXIS)).any(
        axis=1
    )
    wrong |= np.isnan(text.near).any(axis=1) & ~text.linear
    return planned.issue(
        "VERIFY_CONFIGURATION", wrong, "the joint values in the program differ from the plan"
    )


def _configuration_issues(
    cell: Cell, planned: Planned, program: Program, named: Configuration | None
) -> list[Issue]:
    """Compare the arm configuration and the turns of the last axis at each position with the plan.

    The other turn numbers must be zero.
    """
    if named is None:
        return []
    arm = cell.machine.arm
    if arm is None:
        return [
            Issue(
                ERROR,
                "VERIFY_CONFIGURATION",
                "the program names arm configurations, but the machine has no configurations",
            )
        ]
    names = np.array([spherical_wrist.branch_name(index) for index in range(8)])[
        arm.branch_of(planned.joints)
    ]
    controller_values = cell.machine.to_controller(planned.joints)
    last_axis = np.where(np.array(program.continuous)[-1], 0.0, controller_values[:, -1])
    turns_low, turns_high = (
        np.rint((np.abs(last_axis) + side) / (2.0 * np.pi)) * np.sign(last_axis)
        for side in (-HALF_TURN, HALF_TURN)
    )
    turned = (named.turns[:, -1] != turns_low) & (named.turns[:, -1] != turns_high) | (
        named.turns[:, :-1] != 0.0
    ).any(axis=1)
    bent = np.abs(controller_values[:, 4]) > COMPUTED_AXIS
    differs = bent & (named.flip != (controller_values[:, 4] > 0.0)) | (
        named.up != (names[:, 1] == "up")
    )
    differs |= named.front != (names[:, 0] == "front")
    message = "the arm configuration or the turns in the program differ from the plan"
    return planned.issue("VERIFY_CONFIGURATION", np.asarray(turned | differs), message)
