# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a FANUC listing says in numbers: times, speeds, angles within half a turn, positions, CONFIG."""

from __future__ import annotations

import numpy as np

from ...core.issues import InputError
from ...core.orientation import FIXED_XYZ
from ...core.program import RAPID, Moves
from ...core.types import Array
from ..parts import place
from ..refusals import speeds_within

# Ranges of the FANUC operator's manual (motion instruction, feed rate): 1 to 32000 msec, 0.1 to 3200 sec,
# up to 2000 mm/sec.
LONGEST_MSEC = 32_000
LONGEST_SEC = 3_200.0
SPEEDS = (0.1, 2000.0)

# The controller counts 180 deg as the next turn, with a tolerance between 0.0004 and 0.0007 deg (CrossArm's
# measurements on ROBOGUIDE).
_TURN_TOLERANCE = 0.00055


def speed_words(moves: Moves) -> list[str]:
    """The path speed of each move, to 0.1 mm/s. Raises InputError MOVE_SPEED."""
    return [f"{speed:.1f}mm/sec" for speed in speeds_within(moves, *SPEEDS).tolist()]


def time_words(moves: Moves) -> list[str]:
    """The time of each move. Whole milliseconds add up to the time of the run, none is 0; moves of more than 32 s
    are in 0.1 s. Raises InputError MOVE_TIME."""
    seconds = np.where(np.isfinite(moves.duration), np.maximum(moves.duration, 0.0), 0.0)
    if seconds.max() > LONGEST_SEC:
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "a move of {:.0f} s is longer than {:.0f} s; raise the speed or add points",
            seconds.max(),
            LONGEST_SEC,
        )
    long = np.rint(seconds * 1000.0) > LONGEST_MSEC
    n = len(seconds)
    ends = np.rint(np.cumsum(np.where(long, 0.001, seconds)) * 1000.0).astype(np.int64)
    if ends[-1] < n and moves.kind != RAPID:
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "{} moves take {:.4g} s in total, but each needs at least 1 ms; use a larger chord "
            "error or a lower speed",
            n,
            seconds.sum(),
        )
    # time beyond the minimum of 1 ms per move: accumulated, monotonic, at most the total
    spare = np.minimum(
        np.maximum.accumulate(np.maximum(ends - np.arange(1, n + 1), 0)), max(int(ends[-1]) - n, 0)
    )
    milliseconds = 1 + spare
    milliseconds[1:] -= spare[:-1]
    return [
        f"{second:.1f}sec" if is_long else f"{milliseconds_of_move}msec"
        for second, is_long, milliseconds_of_move in zip(
            seconds.tolist(), long.tolist(), milliseconds.tolist(), strict=True
        )
    ]


def within_half_turn(degrees: Array) -> Array:
    """The same angles in (-180, 180], to 3 decimals."""
    wrapped: Array = np.round(degrees - 360.0 * np.ceil((degrees - 180.0) / 360.0), 3)
    return wrapped


def poses(position: Array, rotation: Array) -> Array:
    """X Y Z in mm and W P R in degrees, 3 decimals, (n, 6). The rotation (n, 3, 3) is Rz(R) Ry(P) Rx(W)."""
    angles = within_half_turn(np.round(np.degrees(FIXED_XYZ.numbers(rotation)), 3))
    return np.hstack((np.round(position, 3), angles)) + 0.0


def configurations(moves: Moves, continuous: tuple[bool, ...]) -> list[str]:
    """CONFIG of each point, such as 'N U T, 0, 0, 0'. Raises InputError
    NO_POSITIONS, ARM_BACKWARDS, TURN_NUMBER.

    F where J5 > 0, D where the elbow is down; the last number counts the turns of J6. Whether the
    other two belong to J1 and J4 or to J4 and J5 differs between sources, so those axes must stay
    within half a turn, where both readings agree. What U and D mean of an arm bent over backwards
    (B) was not confirmed.
    """
    if moves.configuration is None:
        raise InputError(
            "NO_POSITIONS",
            place(moves),
            "the program has no arm configurations; use `motion: joint`",
        )
    if any(shoulder != "front" for shoulder, _, _ in moves.configuration):
        raise InputError(
            "ARM_BACKWARDS",
            place(moves),
            "Cartesian positions need an arm that reaches forwards; use `branch: [front, ...]` "
            "or `motion: joint`",
        )
    degrees = np.degrees(moves.joints)
    turns = np.sign(degrees) * np.floor((np.abs(degrees) + 180.0 + _TURN_TOLERANCE) / 360.0)
    turns[:, np.array(continuous)] = 0.0
    untold = (turns != 0.0) & np.array([True, False, False, True, True, False]) | (
        np.abs(turns) > 9.0
    )
    if untold.any():
        point, axis = np.argwhere(untold)[0]
        raise InputError(
            "TURN_NUMBER",
            place(moves),
            "axis {} is at {:.1f} deg, where a Cartesian position has no reliable turn number; "
            "use `motion: joint`",
            axis + 1,
            degrees[point, axis],
        )
    wrists = np.where(moves.joints[:, 4] > 0.0, "F", "N").tolist()
    elbows = ["D" if elbow == "down" else "U" for _, elbow, _ in moves.configuration]
    last_turns = (turns[:, 5] + 0.0).tolist()
    return [
        f"{wrist} {elbow} T, 0, 0, {turn:.0f}"
        for wrist, elbow, turn in zip(wrists, elbows, last_turns, strict=True)
    ]
