# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads FANUC listings back: what the controller would do, from the text alone.

Shares nothing with the writer. Understands the plain instructions a path needs and refuses every other one, so
that no motion can hide in what was not understood.
"""

from __future__ import annotations

import dataclasses
import re
from array import array
from dataclasses import dataclass, field
from itertools import chain, groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.issues import InputError
from ..core.program import Configuration, Event, ReadMoves

Array = NDArray[np.float64]

_NO_LISTING = "it is not a listing with /PROG, /MN, /POS and /END in this order"
_TITLE = 1000  # bytes that hold the first line
# what a unit of a move says: duration s, speed mm/s, share
_TOLD = {
    "sec": (1.0, np.nan, np.nan), "msec": (0.001, np.nan, np.nan), "mm/sec": (np.nan, 1.0, np.nan),
    "%": (np.nan, np.nan, 0.01),
}
_MOST_CNT = 100.0
_LINE = re.compile(r" *\d*:(.*?) *; *$")
_MOTION = re.compile(
    r" *\d*: *([JL]) P\[(\d+)(?::[^\]]*)?\] ?(\d*\.?\d+)(%|msec|sec|mm/sec) ?(?:(FINE)|CNT ?(\d+)) *; *$"
)
_OUTPUT = re.compile(r"DO\[(\d+)(?::[^\]]*)?\]=(ON|OFF)$")
_CALL = re.compile(r"CALL (\w+)$")
_CALLS = re.compile(r"^ *\d*: *CALL (\w+) *; *\r?$", re.MULTILINE)
_FRAME = re.compile(r"U(FRAME|TOOL)_NUM=(\d+)$")
_COOL = re.compile(r"WAIT AI\[(\d+)(?::[^\]]*)?\]<(-?\d+(?:\.\d*)?)$")
_LAYER = re.compile(r"!layer (\d+)$")
_WAIT = re.compile(r"WAIT +(\d*\.(\d+))\(sec\)$")
_INPUT = re.compile(r"WAIT DI\[(\d+)(?::[^\]]*)?\]=ON$")
_HARMLESS = re.compile(r"$|!|//|--eg:")

_RECORD_START = re.compile(r"^P\[(\d+)", re.MULTILINE)
_FRAMES = r"P\[(\d+)[^\]]*\]\{\s*GP1:\s*UF : (\d+|F), UT : (\d+|F),\s*"
_DECIMALS = re.compile(r"\.(\d+)")
_NUMBER = r" *(-?\d*\.\d+) *"


def _values(names: str, units: str) -> str:
    return r",\s*".join(f"{name} ?={_NUMBER}{unit}" for name, unit in zip(names.split(), units.split(), strict=True))


_JOINTS = re.compile(_FRAMES + _values("J1 J2 J3 J4 J5 J6", "deg " * 6) + r"\s*\};")
_CONFIGURATION = r"CONFIG : '([NF]) ([UD]) ([TB]), *(-?\d), *(-?\d), *(-?\d)',\s*"
_POSE = re.compile(_FRAMES + _CONFIGURATION + _values("X Y Z W P R", "mm mm mm deg deg deg") + r"\s*\};")


_Move = tuple[str | Any, ...]  # letter, position, number, unit, FINE, CNT


class _Instruction(NamedTuple):
    """An instruction and the number of its line; or moves that follow each other, and those of theirs."""

    number: int
    text: str
    moves: list[_Move]
    numbers: list[int]


@dataclass
class _Listing:
    """One file: its instructions and its positions."""

    file: str
    instructions: list[_Instruction]
    index: dict[int, int]
    values: Array
    configuration: list[tuple[str, ...]]
    cartesian: bool
    frames: list[tuple[str, str]]
    digits: float


def _floats() -> array[float]:
    return array("d")


@dataclass
class _Run:
    """What happened so far while the programs are followed: packed, for a list of floats takes four times the memory.

    pending: records of the listing at hand that were moved to and are not among `values` yet. recorded, numbers: frames of
    the record that was looked at last, and the numbers of those selected.
    """

    cartesian: bool = False
    values: list[Array] = field(default_factory=list)
    configuration: list[tuple[str, ...]] = field(default_factory=list)
    digits: float = 0.0
    pending: list[int] = field(default_factory=list)
    duration: array[float] = field(default_factory=_floats)
    speed: array[float] = field(default_factory=_floats)
    share: array[float] = field(default_factory=_floats)
    deposit: bytearray = field(default_factory=bytearray)
    linear: bytearray = field(default_factory=bytearray)
    blend: array[float] = field(default_factory=_floats)
    user_frame: array[float] = field(default_factory=_floats)
    tool_frame: array[float] = field(default_factory=_floats)
    events: list[Event] = field(default_factory=list)
    frame: dict[str, str] = field(default_factory=dict)
    recorded: tuple[str, str] = ("", "")
    numbers: tuple[float, float] = (np.nan, np.nan)
    output: str = ""
    on: bool = False

    def happens(self, kind: str, *value: float | str, digits: float = 0.0) -> None:
        """Something happens before the next move."""
        self.events.append(Event(len(self.duration), kind, value, digits))

    def take(self, listing: _Listing) -> None:
        """Take over the records that are pending."""
        if self.pending:
            self.values.append(listing.values[self.pending])
            self.digits = max(self.digits, listing.digits)
            if self.cartesian:
                self.configuration += [listing.configuration[row] for row in self.pending]
            self.pending = []


def read(files: dict[str, bytes]) -> ReadMoves:
    """All moves of the files in the order of execution, beginning with the program that no other one calls.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    named = {_name(file, files[file]): file for file in sorted(files)}
    if len(named) < len(files):
        raise _unreadable("program", "two files hold a program of the same name")
    calling = [content.decode("latin-1") for content in files.values() if b"CALL " in content]
    called = {call.upper() for content in calling for call in _CALLS.findall(content)}
    main = [name for name in named if name not in called]
    if len(main) != 1:
        raise _unreadable("program", f"{len(main)} programs are called by none of the others, expected one")
    run = _Run()
    _follow(main[0], {name: (file, files[file]) for name, file in named.items()}, run, ())
    if not run.duration:
        raise _unreadable("program", "there are no moves")
    return _moves(run)


def _moves(run: _Run) -> ReadMoves:
    cartesian, values, digits = run.cartesian, np.concatenate(run.values), run.digits
    joints, half_turn = (None, 0.0) if cartesian else (np.radians(values), float(np.radians(digits)))
    deposit, linear = (np.array(column, dtype=np.bool_) for column in (run.deposit, run.linear))
    blend = np.array(run.blend)
    told = ReadMoves(
        joints, half_turn, np.array(run.duration), deposit, linear, np.isnan(blend), tuple(run.events),
        speed=np.array(run.speed), share=np.array(run.share), share_digits=0.005, blend=blend,
        user_frame=np.array(run.user_frame), tool_frame=np.array(run.tool_frame),
    )
    if not cartesian:
        return told
    words = np.array(run.configuration)
    return dataclasses.replace(
        told, position=values[:, :3], rotation=_rotation(np.radians(values[:, 3:])), position_digits=digits,
        rotation_digits=float(np.radians(digits)),
        configuration=Configuration(
            words[:, 0] == "F", words[:, 1] == "U", words[:, 2] == "T", words[:, 3:].astype(np.float64)
        ),
    )


def _rotation(wpr: Array) -> Array:
    """(n, 3, 3) rotations Rz(R) Ry(P) Rx(W) of W, P, R (n, 3) in rad."""
    cw, cp, cr = np.cos(wpr).T
    sw, sp, sr = np.sin(wpr).T
    rows = (
        (cr * cp, cr * sp * sw - sr * cw, cr * sp * cw + sr * sw),
        (sr * cp, sr * sp * sw + cr * cw, sr * sp * cw - cr * sw),
        (-sp, cp * sw, cp * cw),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def _lines(content: bytes) -> list[str]:
    return content.decode("latin-1").replace("\r\n", "\n").split("\n")


def _name(file: str, content: bytes) -> str:
    """The name of a program, upper case."""
    title = re.match(r"/PROG +(\w+)\s*$", _lines(content[:_TITLE])[0])
    if title is None:
        raise _unreadable(file, _NO_LISTING)
    return title[1].upper()


def _listing(file: str, content: bytes) -> _Listing:
    lines = _lines(content)
    marks = [lines.index(section) if section in lines else -1 for section in ("/MN", "/POS", "/END")]
    if -1 in marks or marks != sorted(marks):
        raise _unreadable(file, _NO_LISTING)
    start, positions, end = marks
    instructions: list[_Instruction] = []
    moves: list[_Move] = []
    for number, line in enumerate(lines[start + 1 : positions], start + 2):
        if move := _MOTION.match(line):
            if not moves:
                instructions.append(_Instruction(number, "", moves, []))
            instructions[-1].numbers.append(number)
            moves.append(move.groups())
            continue
        if not line.strip():
            continue
        moves = []
        statement = _LINE.match(line)
        if statement is None:
            raise _unreadable(f"{file} line {number}", f"{line.strip()!r} is no instruction")
        instructions.append(_Instruction(number, statement[1].strip(), [], []))
    records = "\n".join(lines[positions + 1 : end])
    starts = _RECORD_START.findall(records)
    found = _JOINTS.findall(records)
    cartesian = not found
    found = found or _POSE.findall(records)
    if [record[0] for record in found] != starts:
        understood = {record[0] for record in found}
        bad = next((point for point in starts if point not in understood), starts[-1])
        number = next(n for n, line in enumerate(lines, 1) if n > positions and re.match(rf"P\[{bad}\b", line))
        raise _unreadable(f"{file} line {number}", f"the record of P[{bad}] is not understood")
    index = {int(record[0]): row for row, record in enumerate(found)}
    if len(index) < len(found):
        raise _unreadable(file, "a position is recorded twice")
    texts = " ".join(chain.from_iterable([record[-6:] for record in found]))
    decimals = min(map(len, _DECIMALS.findall(texts)), default=0)
    return _Listing(
        file, instructions, index, np.fromstring(texts, sep=" ").reshape(-1, 6),
        [record[3:-6] for record in found], cartesian, [(record[1], record[2]) for record in found], 0.5 * 10.0**-decimals,
    )


def _follow(name: str, files: dict[str, tuple[str, bytes]], run: _Run, callers: tuple[str, ...]) -> None:
    """Carry out the instructions of a program in order, and of those it calls. A listing is there while it is followed."""
    if name in callers:
        raise _unreadable(files[name][0], "it calls itself")
    listing = _listing(*files[name])
    for position, (number, statement, moves, numbers) in enumerate(listing.instructions):
        if numbers:
            _move(listing, numbers, moves, run)
        elif output := _OUTPUT.match(statement):
            if run.output not in ("", output[1]):
                raise _unreadable(f"{listing.file} line {number}", "a second output is switched")
            run.output, run.on = output[1], output[2] == "ON"
            run.happens("on" if run.on else "off", float(output[1]), "DO")
        elif call := _CALL.match(statement):
            if call[1].upper() in files:
                run.take(listing)
                _follow(call[1].upper(), files, run, (*callers, name))
            else:
                run.happens("call", call[1].upper())
        elif cool := _COOL.match(statement):
            run.happens("below", float(cool[1]), float(cool[2]), digits=1e-6)
        elif wait := _WAIT.match(statement):
            run.happens("wait", float(wait[1]), digits=0.5 * 10.0 ** -len(wait[2]))
        elif given := _INPUT.match(statement):
            run.happens("input", float(given[1]))
        elif layer := _LAYER.match(statement):
            run.happens("layer", float(layer[1]))
        elif frame := _FRAME.match(statement):
            if run.frame.setdefault(frame[1], frame[2]) != frame[2]:
                raise _unreadable(f"{listing.file} line {number}", f"a second U{frame[1]} is selected")
            run.recorded = ("", "")
        elif statement == "END" and position == len(listing.instructions) - 1:
            break
        elif not _HARMLESS.match(statement):
            raise _unreadable(f"{listing.file} line {number}", f"the instruction {statement!r} is not understood")
    run.take(listing)


def _move(listing: _Listing, numbers: list[int], moves: list[_Move], run: _Run) -> None:
    """Carry out moves that follow each other, on the lines of these numbers, all of them column by column."""
    letters, points, values, units, fine, corners = zip(*moves)
    rows = [listing.index.get(int(point), -1) for point in points]
    sound = {("J", unit) for unit in _TOLD if unit != "mm/sec"} | {("L", unit) for unit in _TOLD if unit != "%"}
    if (
        -1 in rows or not {*zip(letters, units)} <= sound or ("L" in letters and not listing.cartesian)
        or (run.cartesian != listing.cartesian and run.duration)
        or any(float(corner) > _MOST_CNT for corner in {*corners} - {None})
    ):
        for number, move in zip(numbers, moves):
            _refuse(listing, move, run, number)
    run.cartesian = listing.cartesian
    done = 0
    for frames, same in groupby([listing.frames[row] for row in rows]):
        count = sum(1 for _ in same)
        if frames != run.recorded:
            _select(listing, rows[done], run, numbers[done])
        run.user_frame.extend([run.numbers[0]] * count)
        run.tool_frame.extend([run.numbers[1]] * count)
        done += count
    run.pending += rows
    told = np.array([float(value) for value in values])[:, None] * np.array([_TOLD[unit] for unit in units])
    for column, numbered in zip((run.duration, run.speed, run.share), told.T):
        column.frombytes(numbered.tobytes())
    run.deposit += bytes([run.on]) * len(moves)
    run.linear += bytes([letter == "L" for letter in letters])
    run.blend.extend([np.nan if stops else float(corner) for stops, corner in zip(fine, corners)])


def _refuse(listing: _Listing, move: _Move, run: _Run, number: int) -> None:
    """InputError for what cannot be understood of a move."""
    letter, point, _, unit, _, corner = move
    straight = letter == "L"
    if int(point) not in listing.index:
        raise _unreadable(_at(listing, number), f"P[{point}] is not recorded")
    if run.cartesian != listing.cartesian and run.duration:
        raise _unreadable(_at(listing, number), "joint and Cartesian positions are mixed")
    if straight and not listing.cartesian:
        raise _unreadable(_at(listing, number), "a position is moved to in another way than it is recorded")
    if (unit == ("%" if straight else "mm/sec")) or (corner and float(corner) > _MOST_CNT):
        raise _unreadable(_at(listing, number), f"{unit} or CNT{corner} is not understood here")


def _select(listing: _Listing, row: int, run: _Run, number: int) -> None:
    """Look at the frames that a position is recorded in; those like it need not be looked at until others are selected."""
    for word, recorded in zip(("FRAME", "TOOL"), listing.frames[row], strict=True):
        if recorded not in ("F", run.frame.get(word)):
            point = next(point for point, found in listing.index.items() if found == row)
            raise _unreadable(
                _at(listing, number), f"P[{point}] is recorded in another U{word} than the one selected"
            )
    run.recorded = listing.frames[row]
    run.numbers = float(run.frame.get("FRAME", "nan")), float(run.frame.get("TOOL", "nan"))


def _at(listing: _Listing, number: int) -> str:
    return f"{listing.file} line {number}"


def _unreadable(where: str, why: str) -> InputError:
    return InputError("UNREADABLE_PROGRAM", where, f"{why}; write the program anew")
