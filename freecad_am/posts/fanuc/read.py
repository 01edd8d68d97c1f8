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

import numpy as np

from freecad_am.core.types import Array, Index

from ...core.issues import Text
from ...core.read_moves import ARC, Configuration, Event, ReadMoves
from .parsed import UNITS, Listing, listing_of, name_of
from .records import unreadable

_FACTORS = np.array([(1.0, np.nan, np.nan), (0.001, np.nan, np.nan), (np.nan, 1.0, np.nan), (np.nan, np.nan, 0.01)])
_SPEED, _SHARE = UNITS.index("mm/sec"), UNITS.index("%")
_MOST_CNT, _OWN = 100.0, 6
_OUTPUT = re.compile(r"DO\[(\d+)(?::[^\]]*)?\]=(ON|OFF)$")
_GROUP = re.compile(r"GO\[(\d+)(?::[^\]]*)?\]=(\d+)$")
_ARC = re.compile(r"Arc (Start|End)\[(\d+)\]$")
_WEAVE = re.compile(r"Weave (?:Sine\[(\d+)\]|End)$")
_CALL = re.compile(r"CALL (\w+)$")
_CALLS = re.compile(r"^ *\d*: *CALL (\w+) *; *\r?$", re.MULTILINE)
_FRAME = re.compile(r"U(FRAME|TOOL)_NUM=(\d+)$")
_COOL = re.compile(r"WAIT AI\[(\d+)(?::[^\]]*)?\]<(-?\d+(?:\.\d*)?)$")
_LAYER = re.compile(r"!layer (\d+)$")
_TRACK = re.compile(r"!E1 is the track e(\d)$")
_WAIT = re.compile(r"WAIT +(\d*\.(\d+))\(sec\)$")
_INPUT = re.compile(r"WAIT DI\[(\d+)(?::[^\]]*)?\]=ON$")
_HARMLESS = re.compile(r"$|!|//|--eg:")


def _floats() -> array[float]:
    return array("d")


@dataclass
class _Run:
    """What happened so far while the programs are followed: packed, for a list of floats takes four times the memory.

    pending: records of the listing at hand that were moved to and are not among `values` yet. recorded, numbers: frames of
    the record that was looked at last, and the numbers of those selected. track: which of the axes beside the robot a remark
    calls the track, 0 for none, and whether positions have one. moved: groups that headers name.
    """

    cartesian: bool = False
    values: list[Array] = field(default_factory=list)
    configuration: list[tuple[str, ...]] = field(default_factory=list)
    moved: frozenset[str] | None = None
    group: str | None = None
    track: tuple[int, bool] = (0, False)
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

    def begin(self, listing: Listing) -> None:
        """Look at the groups of a listing; one without moves may name none."""
        groups = listing.records.moved
        if groups and self.moved not in (None, groups):
            raise unreadable(listing.file, "its header names other motion groups than programs before")
        self.moved = groups or self.moved

    def take(self, listing: Listing) -> None:
        """Take over the records that are pending."""
        if self.pending:
            rows, records = np.concatenate(self.pending), listing.records
            if self.values and (self.group, self.values[0].shape[1]) != (records.group, records.values.shape[1]):
                raise unreadable(listing.file, "it moves other groups than those before")
            self.group, self.track = records.group, (self.track[0], records.track)
            self.values.append(records.values[rows])
            self.digits = max(self.digits, records.digits)
            if self.cartesian:
                self.configuration += [records.configuration[row] for row in rows]
            self.pending = []


def read(files: dict[str, bytes]) -> ReadMoves:
    """All moves of the files in the order of execution, beginning with the program that no other one calls.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    named = {name_of(file, files[file]): file for file in sorted(files)}
    if len(named) < len(files):
        raise unreadable("program", "two files hold a program of the same name")
    calling = [content.decode("latin-1") for content in files.values() if b"CALL " in content]
    called = {call.upper() for content in calling for call in _CALLS.findall(content)}
    main = [name for name in named if name not in called]
    if len(main) != 1:
        raise unreadable("program", Text("{} programs are called by none of the others, expected one", len(main)))
    run = _Run()
    _follow(main[0], {name: (file, files[file]) for name, file in named.items()}, run, ())
    if not run.duration:
        raise unreadable("program", "there are no moves")
    return _moves(run)


def _moves(run: _Run) -> ReadMoves:
    cartesian, values, digits = run.cartesian, np.concatenate(run.values), run.digits
    joints, half_turn = (None, 0.0) if cartesian else (_joints(run, values), float(np.radians(digits)))
    deposit, linear = (np.array(column, dtype=np.bool_) for column in (run.deposit, run.linear))
    blend = np.array(run.blend)
    found = ReadMoves(
        joints, half_turn, np.array(run.duration), deposit, linear, np.isnan(blend), tuple(run.events),
        speed=np.array(run.speed), share=np.array(run.share), share_digits=0.005, blend=blend,
        user_frame=np.array(run.user_frame), tool_frame=np.array(run.tool_frame), unit=run.group or "",
        linear_digits=digits if run.track[1] else 0.0,
    )
    if not cartesian:
        return found
    words = np.array(run.configuration)
    return dataclasses.replace(
        found, position=values[:, :3], rotation=_rotation(np.radians(values[:, 3:])), position_digits=digits,
        rotation_digits=float(np.radians(digits)),
        configuration=Configuration(
            words[:, 0] == "F", words[:, 1] == "U", words[:, 2] == "T", words[:, 3:].astype(np.float64)
        ),
    )


def _joints(run: _Run, values: Array) -> Array:
    """(n, axes) rad and mm of the values of records, the track where a remark says that it is among the axes beside."""
    number, track = run.track
    if track != bool(number) or number > values.shape[1] - _OWN:
        raise unreadable("program", "positions have a track and no remark says which axis it is, or the other way round")
    if not track:
        return np.asarray(np.radians(values))
    rest = np.radians(np.delete(values, _OWN, axis=1))
    return np.asarray(np.insert(rest, _OWN + number - 1, values[:, _OWN], axis=1))


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


def _follow(name: str, files: dict[str, tuple[str, bytes]], run: _Run, callers: tuple[str, ...]) -> None:
    """Carry out the instructions of a program in order, and of those it calls. A listing is there while it is followed."""
    if name in callers:
        raise unreadable(files[name][0], "it calls itself")
    listing = listing_of(*files[name])
    run.begin(listing)
    for position, (number, statement, first, end) in enumerate(listing.instructions):
        if end > first:
            _move(listing, slice(first, end), run)
        elif output := _OUTPUT.match(statement):
            _switch(output, f"{listing.file} line {number}", run)
        elif group := _GROUP.match(statement):
            run.happens("schedule", float(group[1]), float(group[2]))
        elif arc := _ARC.match(statement):
            _arc(arc, f"{listing.file} line {number}", run)
        elif weave := _WEAVE.match(statement):
            run.happens("weave", float(weave[1] or 0))
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
        elif track := _TRACK.match(statement):
            run.track = int(track[1]), run.track[1]
        elif frame := _FRAME.match(statement):
            _frame(frame, f"{listing.file} line {number}", run)
        elif statement == "END" and position == len(listing.instructions) - 1:
            break
        elif not _HARMLESS.match(statement):
            raise unreadable(f"{listing.file} line {number}", Text("the instruction {!r} is not understood", statement))
    run.take(listing)


def _switch(output: re.Match[str], where: str, run: _Run) -> None:
    """The deposit goes on or off."""
    if run.output not in ("", output[1]):
        raise unreadable(where, "a second output is switched")
    run.output, run.on = output[1], output[2] == "ON"
    run.happens("on" if run.on else "off", float(output[1]), "DO")


def _frame(frame: re.Match[str], where: str, run: _Run) -> None:
    """A user or a tool frame is selected."""
    if run.frame.setdefault(frame[1], frame[2]) != frame[2]:
        raise unreadable(where, Text("a second U{} is selected", frame[1]))
    run.recorded = ("", "")


def _arc(arc: re.Match[str], where: str, run: _Run) -> None:
    """The arc is struck, or ends, by a schedule."""
    if run.output not in ("", ARC) or run.on == (arc[1] == "Start"):
        raise unreadable(where, "an output is switched too, or the arc burns already, or not yet")
    run.output, run.on = ARC, arc[1] == "Start"
    run.happens("on" if run.on else "off", float(arc[2]), ARC)


def _move(listing: Listing, some: slice, run: _Run) -> None:
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
    alike = frames.count(frames[0]) == len(frames)
    selected = frames if alike else [frames[row] for row in rows]
    changes = [0] if alike else [k for k in range(len(rows)) if k == 0 or selected[k] != selected[k - 1]]
    for first, end in zip(changes, [*changes[1:], len(rows)]):
        if selected[first] != run.recorded:
            _select(listing, int(rows[first]), run, int(moves.line[some][first]))
        run.user_frame.extend([run.numbers[0]] * (end - first))
        run.tool_frame.extend([run.numbers[1]] * (end - first))
    run.pending.append(rows)
    value = moves.value[some, None] * _FACTORS[unit]
    for column, numbered in zip((run.duration, run.speed, run.share, run.blend), (*value.T, corner)):
        column.frombytes(numbered.tobytes())
    run.deposit += bytes([run.on]) * len(rows)
    run.linear += straight.tobytes()


def _refuse(listing: Listing, move: int, run: _Run) -> None:
    """InputError for what cannot be understood of a move."""
    moves, records = listing.moves, listing.records
    where, unit, corner = _at(listing, int(moves.line[move])), int(moves.unit[move]), moves.corner[move]
    if moves.point[move] not in records.point:
        raise unreadable(where, Text("P[{}] is not recorded", moves.point[move]))
    if run.cartesian != records.cartesian and run.duration:
        raise unreadable(where, "joint and Cartesian positions are mixed")
    if moves.straight[move] and not records.cartesian:
        raise unreadable(where, "a position is moved to in another way than it is recorded")
    raise unreadable(where, Text("{} or CNT{} is not understood here", UNITS[unit], "" if np.isnan(corner) else int(corner)))


def _select(listing: Listing, row: int, run: _Run, number: int) -> None:
    """Look at the frames that a position is recorded in; those like it need not be looked at until others are selected."""
    recorded = listing.records.frames[row]
    for word, frame in zip(("FRAME", "TOOL"), recorded, strict=True):
        if frame not in ("F", run.frame.get(word)):
            raise unreadable(
                _at(listing, number),
                Text("P[{}] is recorded in another U{} than the one selected", listing.records.point[row], word),
            )
    run.recorded = recorded
    run.numbers = float(run.frame.get("FRAME", "nan")), float(run.frame.get("TOOL", "nan"))


def _at(listing: Listing, number: int) -> str:
    return f"{listing.file} line {number}"
