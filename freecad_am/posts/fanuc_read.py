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
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.program import Configuration, Event, ReadMoves
from . import alike
from .fanuc_records import Records, records_of, unreadable

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

_NO_LISTING = "it is not a listing with /PROG, /MN, /POS and /END in this order"
_TITLE = 1000  # bytes that hold the first line
# what a unit of a move says: duration s, speed mm/s, share
_UNITS = ("sec", "msec", "mm/sec", "%")
_TOLD = np.array([(1.0, np.nan, np.nan), (0.001, np.nan, np.nan), (np.nan, 1.0, np.nan), (np.nan, np.nan, 0.01)])
_SPEED, _SHARE = _UNITS.index("mm/sec"), _UNITS.index("%")
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

class _Instruction(NamedTuple):
    """An instruction and the number of its line; or moves that follow each other, by the first of them and the one after
    the last."""

    number: int
    text: str
    first: int = 0
    end: int = 0


@dataclass
class _Moves:
    """All moves of a file in order (n,): the numbers of their lines, positions, numbers and the units of these, whether they
    are straight, and CNT, NaN of those that stop."""

    line: Index
    point: Index
    value: Array
    unit: Index
    straight: Mask
    corner: Array


@dataclass
class _Listing:
    """One file: its instructions, its moves, and its positions in the order of their numbers."""

    file: str
    instructions: list[_Instruction]
    moves: _Moves
    records: Records

    def rows(self, points: Index) -> Index:
        """Which positions those numbered (k,) are, -1 where there is none."""
        known = self.records.point
        if not len(known):
            return np.full(len(points), -1)
        at = np.minimum(np.searchsorted(known, points), len(known) - 1)
        return np.where(known[at] == points, at, -1)


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
    group: str | None = None
    digits: float = 0.0
    pending: list[Index] = field(default_factory=list)
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
            rows, told = np.concatenate(self.pending), listing.records
            if self.values and (self.group, self.values[0].shape[1]) != (told.group, told.values.shape[1]):
                raise unreadable(listing.file, "it moves other groups than those before")
            self.group = told.group
            self.values.append(told.values[rows])
            self.digits = max(self.digits, told.digits)
            if self.cartesian:
                self.configuration += [told.configuration[row] for row in rows]
            self.pending = []


def read(files: dict[str, bytes]) -> ReadMoves:
    """All moves of the files in the order of execution, beginning with the program that no other one calls.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    named = {_name(file, files[file]): file for file in sorted(files)}
    if len(named) < len(files):
        raise unreadable("program", "two files hold a program of the same name")
    calling = [content.decode("latin-1") for content in files.values() if b"CALL " in content]
    called = {call.upper() for content in calling for call in _CALLS.findall(content)}
    main = [name for name in named if name not in called]
    if len(main) != 1:
        raise unreadable("program", f"{len(main)} programs are called by none of the others, expected one")
    run = _Run()
    _follow(main[0], {name: (file, files[file]) for name, file in named.items()}, run, ())
    if not run.duration:
        raise unreadable("program", "there are no moves")
    return _moves(run)


def _moves(run: _Run) -> ReadMoves:
    cartesian, values, digits = run.cartesian, np.concatenate(run.values), run.digits
    joints, half_turn = (None, 0.0) if cartesian else (np.radians(values), float(np.radians(digits)))
    deposit, linear = (np.array(column, dtype=np.bool_) for column in (run.deposit, run.linear))
    blend = np.array(run.blend)
    told = ReadMoves(
        joints, half_turn, np.array(run.duration), deposit, linear, np.isnan(blend), tuple(run.events),
        speed=np.array(run.speed), share=np.array(run.share), share_digits=0.005, blend=blend,
        user_frame=np.array(run.user_frame), tool_frame=np.array(run.tool_frame), unit=run.group or "",
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


def _text(content: bytes) -> str:
    return content.decode("latin-1").replace("\r\n", "\n")


def _name(file: str, content: bytes) -> str:
    """The name of a program, upper case."""
    title = re.match(r"/PROG +(\w+)\s*$", _text(content[:_TITLE]).partition("\n")[0])
    if title is None:
        raise unreadable(file, _NO_LISTING)
    return title[1].upper()


def _listing(file: str, content: bytes) -> _Listing:
    text = f"\n{_text(content)}\n"
    marks = [text.find(f"\n{section}\n") for section in ("/MN", "/POS", "/END")]
    if -1 in marks or marks != sorted(marks):
        raise unreadable(file, _NO_LISTING)
    # the records, by far the most of it, are not taken apart by lines
    lines = text[1 : marks[1]].split("\n")
    start, positions = lines.index("/MN"), len(lines)
    instructions, moves = _instructions(file, lines[start + 1 :], start + 2)
    records = records_of(file, lines, text[marks[1] + len("\n/POS\n") : marks[2]], positions)
    return _Listing(file, instructions, moves, records)


def _instructions(file: str, lines: list[str], number: int) -> tuple[list[_Instruction], _Moves]:
    """The instructions of lines, of which the first has a number, and all moves among them."""
    count = len(lines)
    moves = _Moves(
        np.arange(number, number + count), np.zeros(count, dtype=np.intp), np.zeros(count), np.zeros(count, dtype=np.intp),
        np.zeros(count, dtype=bool), np.full(count, np.nan),
    )
    moving, others = np.zeros(count, dtype=bool), []
    for shape, some in alike.shapes(lines).items():
        move = _MOTION.match(shape)
        if move is None:
            others += some
            continue
        moving[some] = True
        spans = [move.span(group) for group in (2, 3, 6) if move[group]]
        told = alike.numbers([lines[row] for row in some], shape, spans)
        moves.point[some], moves.value[some] = told[:, 0], told[:, 1]
        moves.unit[some], moves.straight[some] = _UNITS.index(move[4]), move[1] == "L"
        if move[6]:
            moves.corner[some] = told[:, 2]
    before = np.cumsum(moving)  # how many moves there are up to a line
    instructions, done = [], 0
    for row in [*sorted(row for row in others if lines[row].strip()), count]:
        moved = int(before[row - 1]) if row else 0
        if moved > done:
            instructions.append(_Instruction(0, "", done, moved))
            done = moved
        if row < count:
            statement = _LINE.match(lines[row])
            if statement is None:
                raise unreadable(f"{file} line {number + row}", f"{lines[row].strip()!r} is no instruction")
            instructions.append(_Instruction(number + row, statement[1].strip()))
    return instructions, _Moves(*(getattr(moves, entry.name)[moving] for entry in dataclasses.fields(moves)))


def _follow(name: str, files: dict[str, tuple[str, bytes]], run: _Run, callers: tuple[str, ...]) -> None:
    """Carry out the instructions of a program in order, and of those it calls. A listing is there while it is followed."""
    if name in callers:
        raise unreadable(files[name][0], "it calls itself")
    listing = _listing(*files[name])
    for position, (number, statement, first, end) in enumerate(listing.instructions):
        if end > first:
            _move(listing, slice(first, end), run)
        elif output := _OUTPUT.match(statement):
            if run.output not in ("", output[1]):
                raise unreadable(f"{listing.file} line {number}", "a second output is switched")
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
                raise unreadable(f"{listing.file} line {number}", f"a second U{frame[1]} is selected")
            run.recorded = ("", "")
        elif statement == "END" and position == len(listing.instructions) - 1:
            break
        elif not _HARMLESS.match(statement):
            raise unreadable(f"{listing.file} line {number}", f"the instruction {statement!r} is not understood")
    run.take(listing)


def _move(listing: _Listing, some: slice, run: _Run) -> None:
    """Carry out moves that follow each other, all of them column by column."""
    moves, cartesian = listing.moves, listing.records.cartesian
    unit, straight, corner = moves.unit[some], moves.straight[some], moves.corner[some]
    rows = listing.rows(moves.point[some])
    wrong = (rows < 0) | (straight & (not cartesian)) | (unit == np.where(straight, _SHARE, _SPEED)) | (corner > _MOST_CNT)
    if run.cartesian != cartesian and run.duration:
        wrong[:] = True
    if wrong.any():
        _refuse(listing, some.start + int(np.argmax(wrong)), run)
    run.cartesian = cartesian
    frames = listing.records.frames
    selected = [frames[row] for row in rows]
    changes = [k for k in range(len(rows)) if k == 0 or selected[k] != selected[k - 1]]
    for first, end in zip(changes, [*changes[1:], len(rows)]):
        if selected[first] != run.recorded:
            _select(listing, int(rows[first]), run, int(moves.line[some][first]))
        run.user_frame.extend([run.numbers[0]] * (end - first))
        run.tool_frame.extend([run.numbers[1]] * (end - first))
    run.pending.append(rows)
    told = moves.value[some, None] * _TOLD[unit]
    for column, numbered in zip((run.duration, run.speed, run.share, run.blend), (*told.T, corner)):
        column.frombytes(numbered.tobytes())
    run.deposit += bytes([run.on]) * len(rows)
    run.linear += straight.tobytes()


def _refuse(listing: _Listing, move: int, run: _Run) -> None:
    """InputError for what cannot be understood of a move."""
    moves, records = listing.moves, listing.records
    where, unit, corner = _at(listing, int(moves.line[move])), int(moves.unit[move]), moves.corner[move]
    if moves.point[move] not in records.point:
        raise unreadable(where, f"P[{moves.point[move]}] is not recorded")
    if run.cartesian != records.cartesian and run.duration:
        raise unreadable(where, "joint and Cartesian positions are mixed")
    if moves.straight[move] and not records.cartesian:
        raise unreadable(where, "a position is moved to in another way than it is recorded")
    raise unreadable(where, f"{_UNITS[unit]} or CNT{'' if np.isnan(corner) else int(corner)} is not understood here")


def _select(listing: _Listing, row: int, run: _Run, number: int) -> None:
    """Look at the frames that a position is recorded in; those like it need not be looked at until others are selected."""
    recorded = listing.records.frames[row]
    for word, frame in zip(("FRAME", "TOOL"), recorded, strict=True):
        if frame not in ("F", run.frame.get(word)):
            raise unreadable(
                _at(listing, number),
                f"P[{listing.records.point[row]}] is recorded in another U{word} than the one selected",
            )
    run.recorded = recorded
    run.numbers = float(run.frame.get("FRAME", "nan")), float(run.frame.get("TOOL", "nan"))


def _at(listing: _Listing, number: int) -> str:
    return f"{listing.file} line {number}"
