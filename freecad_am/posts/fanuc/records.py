# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format numbers of FANUC listings, and read position records: joint values, or poses with their
configuration.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import NamedTuple

import numpy as np

from ...core.issues import InputError, Text
from ...core.orientation import FIXED_XYZ
from ...core.program import RAPID, Moves
from ...core.types import Array, Index
from ..parts import place
from ..refusals import speeds_within

# ---- Numbers of a FANUC listing: times, speeds, angles within half a turn, positions, CONFIG

# Ranges of the FANUC operator's manual (motion instruction, feed rate): 1 to 32000 msec, 0.1 to
# 3200 sec, up to 2000 mm/sec.
LONGEST_MSEC = 32_000
LONGEST_SEC = 3_200.0
SPEEDS = (0.1, 2000.0)

# deg; the controller counts 180 deg as the next turn, with a tolerance between 0.0004 and 0.0007
# deg (CrossArm's measurements on ROBOGUIDE)
_TURN_TOLERANCE = 0.00055


def speed_words(moves: Moves) -> list[str]:
    """Return the path speed of each move, to 0.1 mm/s. Raises InputError MOVE_SPEED."""
    return [f"{speed:.1f}mm/sec" for speed in speeds_within(moves, *SPEEDS).tolist()]


def time_words(moves: Moves) -> list[str]:
    """Return the time of each move in whole milliseconds, at least 1 ms, that add up to the run's
    time.

    Moves of more than 32 s are written to 0.1 s. Raises InputError MOVE_TIME.
    """
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
    # accumulated time beyond the minimum of 1 ms per move; monotonic, at most the total
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
    """Wrap angles to the range of position records.

    Parameters
    ----------
    degrees : (...) array
        Angles in degrees.

    Returns
    -------
    (...) array
        Angles in (-180, 180], to 3 decimals.
    """
    wrapped: Array = np.round(degrees - 360.0 * np.ceil((degrees - 180.0) / 360.0), 3)
    return wrapped


def poses(position: Array, rotation: Array) -> Array:
    """Convert poses to record values; the rotation is Rz(R) Ry(P) Rx(W).

    Parameters
    ----------
    position : (n, 3) array
        mm.
    rotation : (n, 3, 3) array
        Rotations.

    Returns
    -------
    (n, 6) array
        X Y Z in mm and W P R in degrees, 3 decimals.
    """
    angles = within_half_turn(np.round(np.degrees(FIXED_XYZ.numbers(rotation)), 3))
    return np.hstack((np.round(position, 3), angles)) + 0.0


def configurations(moves: Moves, continuous: tuple[bool, ...]) -> list[str]:
    """Return the CONFIG of each point, such as 'N U T, 0, 0, 0'.

    F means J5 > 0, D means elbow down; the last number counts the turns of J6. Sources differ on
    whether the other two numbers belong to J1 and J4 or to J4 and J5. Those axes must stay within
    half a turn, where both readings agree. The meaning of U and D for an arm that bends over
    backwards (B) is unconfirmed.

    Raises InputError NO_POSITIONS, ARM_BACKWARDS or TURN_NUMBER.
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


_RECORD_START = re.compile(r"^P\[(\d+)", re.MULTILINE)
_FRAMES = r"P\[(\d+)[^\]]*\]\{\s*GP1:\s*UF : (\d+|F), UT : (\d+|F),\s*"
_DECIMALS = re.compile(r"\.(\d+)")
_NUMBER = r" *(-?\d*\.\d+) *"


def _values(names: str, units: str) -> str:
    return r",\s*".join(
        f"{name} ?={_NUMBER}{unit}" for name, unit in zip(names.split(), units.split(), strict=True)
    )


_JOINTS = re.compile(_FRAMES + _values("J1 J2 J3 J4 J5 J6", "deg " * 6) + r"\s*\};")
# joint record with a track and the axes of another motion group, in the same frames
_FULL_RECORD = re.compile(
    _FRAMES + _values("J1 J2 J3 J4 J5 J6", "deg " * 6) + r"(?:,\s*E1 ?= *(-?\d*\.\d+) *mm)?"
    r"(?:\s*GP([2-8]):\s*UF : (\d+|F), UT : (\d+|F),((?:\s*J\d ?= *-?\d*\.\d+ *deg,?)+))?\s*\};"
)
_AXIS = re.compile(r"J(\d) ?= *(-?\d*\.\d+) *deg(,?)")
_CONFIGURATION = r"CONFIG : '([NF]) ([UD]) ([TB]), *(-?\d), *(-?\d), *(-?\d)',\s*"
_POSE = re.compile(
    _FRAMES + _CONFIGURATION + _values("X Y Z W P R", "mm mm mm deg deg deg") + r"\s*\};"
)


class Records(NamedTuple):
    """The n position records of a file.

    point: (n,) position numbers. values: (n, 6 + track + other group). frames: user and tool frame
    of each record. digits: half of the last digit. group: number of the other motion group. track:
    whether records have a track value. moved: numbers of the groups in the header.
    """

    point: Index
    values: Array
    configuration: list[tuple[str, ...]]
    frames: list[tuple[str, str]]
    digits: float
    cartesian: bool
    group: str = ""
    track: bool = False
    moved: frozenset[str] = frozenset()


def records_of(file: str, lines: list[str], text: str, positions: int) -> Records:
    """Return the position records of a file.

    Parameters
    ----------
    file : str
        Name of the file, for messages.
    lines : list of str
        Lines of the header and the instructions.
    text : str
        Text of the position section.
    positions : int
        Line number of the start of that section, from 0.

    Returns
    -------
    Records
        The positions, sorted by number.

    Raises
    ------
    InputError
        UNREADABLE_PROGRAM for text that is not understood, or for duplicate records.
    """
    # counting is much faster than checking every line
    several = text.count("GP") > text.count("GP1:") and re.search(
        r"^ *GP[2-8]:", text, re.MULTILINE
    )
    has_more = several or "E1" in text
    records = (
        _joint_records_of_groups(file, text, positions)
        if has_more
        else _any_records(file, text, positions)
    )
    _check_groups(file, lines, records)
    if (np.diff(records.point) > 0).all():
        return records._replace(moved=_groups_of(lines))
    order = np.argsort(records.point, kind="stable")
    twice = np.flatnonzero(np.diff(records.point[order]) == 0)
    if len(twice):
        point = int(records.point[order][twice[0]])
        line = _line(text, positions, point, 1)
        raise unreadable(
            file, Text("P[{}] is recorded twice, the second time in line {}", point, line)
        )
    row_order = order.tolist()
    return records._replace(
        point=records.point[order],
        values=records.values[order],
        frames=[records.frames[row] for row in row_order],
        configuration=[records.configuration[row] for row in row_order],
        moved=_groups_of(lines),
    )


def _groups_of(lines: list[str]) -> frozenset[str]:
    """Return the motion groups that a program moves, from its header."""
    group_lists = (
        line.partition("=")[2].strip(" ;").split(",")
        for line in lines
        if line.startswith("DEFAULT_GROUP")
    )
    flags = next(group_lists, ["1"])
    return frozenset(str(number) for number, word in enumerate(flags, 1) if word == "1")


def _check_groups(file: str, lines: list[str], records: Records) -> None:
    """Check that the header and the positions name the same motion groups."""
    moved = _groups_of(lines)
    if len(records.point) and moved != {"1", records.group or "1"}:
        number = next((k for k, line in enumerate(lines, 1) if line.startswith("DEFAULT_GROUP")), 1)
        raise unreadable(
            f"{file} line {number}",
            Text(
                "the header moves groups {}, but the positions have groups {}",
                ", ".join(sorted(moved)),
                ", ".join(sorted({"1", records.group or "1"})),
            ),
        )


def _line(text: str, positions: int, point: int, again: int = 0) -> int:
    """Return the line of the record of a position, or of its duplicate."""
    starts = [match.start() for match in re.finditer(rf"^P\[{point}\b", text, re.MULTILINE)]
    lines_before = text.count("\n", 0, starts[min(again, len(starts) - 1)])
    return lines_before + positions + 2


def _place(file: str, text: str, positions: int, point: int) -> str:
    """Return file and line of the record of a position."""
    return f"{file} line {_line(text, positions, point)}"


def _joint_records_of_groups(file: str, text: str, positions: int) -> Records:
    """Return joint records with a track or two motion groups; all records must have the same form."""
    values, frames, decimals, points = [], [], 99, []
    groups: set[tuple[str, int, bool]] = set()
    for record in _FULL_RECORD.finditer(text):
        point, user, tool, *robot_values, track, group, other_user, other_tool, external_text = (
            record.groups()
        )
        external = _AXIS.findall(external_text or "")
        count = len(external)
        due = [(str(axis), "," if axis < count else "") for axis in range(1, count + 1)]
        if [(axis, comma) for axis, _, comma in external] != due or (
            group and (user, tool) != (other_user, other_tool)
        ):
            raise unreadable(
                _place(file, text, positions, int(point)),
                Text("the second group of P[{}] is not understood", point),
            )
        texts = [*robot_values, *([track] if track else []), *(value for _, value, _ in external)]
        points.append(int(point))
        values.append([float(value) for value in texts])
        frames.append((user, tool))
        kind = (group or "", count, bool(track))
        if groups and kind not in groups:
            raise unreadable(
                _place(file, text, positions, int(point)),
                Text(
                    "P[{}] and P[{}] have different motion groups or axes; record all positions "
                    "alike",
                    point,
                    points[0],
                ),
            )
        groups.add(kind)
        decimals = min(decimals, *(len(value.partition(".")[2]) for value in texts))
    starts = [int(point) for point in _RECORD_START.findall(text)]
    if points != starts or not points:
        bad = next((point for point in starts if point not in points), starts[-1] if starts else 0)
        raise unreadable(
            _place(file, text, positions, bad) if starts else file,
            Text("the record of P[{}] is not understood", bad),
        )
    (number, _, track_values), half = groups.pop(), 0.5 * 10.0**-decimals
    return Records(
        np.array(points, dtype=np.intp),
        np.array(values),
        [()] * len(points),
        frames,
        half,
        False,
        number,
        track_values,
    )


def _any_records(file: str, text: str, positions: int) -> Records:
    """Return the records of a text that begins after line `positions`. Other text may stand between
    them.
    """
    starts = _RECORD_START.findall(text)
    matches = _JOINTS.findall(text)
    cartesian = not matches
    matches = matches or _POSE.findall(text)
    if [record[0] for record in matches] != starts:
        understood = {record[0] for record in matches}
        bad = next((point for point in starts if point not in understood), starts[-1])
        number = next(
            n
            for n, line in enumerate(text.split("\n"), positions + 2)
            if re.match(rf"P\[{bad}\b", line)
        )
        raise unreadable(
            f"{file} line {number}", Text("the record of P[{}] is not understood", bad)
        )
    texts = " ".join(chain.from_iterable([record[-6:] for record in matches]))
    decimals = min(map(len, _DECIMALS.findall(texts)), default=0)
    return Records(
        np.array([int(record[0]) for record in matches], dtype=np.intp),
        np.fromstring(texts, sep=" ").reshape(-1, 6),
        [record[3:-6] for record in matches],
        [(record[1], record[2]) for record in matches],
        0.5 * 10.0**-decimals,
        cartesian,
    )


def unreadable(where: str, why: str) -> InputError:
    """Return the error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)
