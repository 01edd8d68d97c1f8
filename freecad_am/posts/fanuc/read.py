# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read FANUC listings back: model the controller from the program text alone.

Shares no code with the writer. Accepts only the instructions that a path needs and rejects
everything else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import dataclasses
import re
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.issues import Text
from ...core.read_moves import ARC, Configuration, Event, ReadMoves
from ...core.types import Array, Index, Mask
from ..read_lines import Lines, floats
from .records import Records, records_of, unreadable

# ---- Parse listings of FANUC programs: instructions, runs of moves, and position records

_NO_LISTING = "the file is not a listing with /PROG, /MN, /POS and /END in this order"
_TITLE = 1000  # maximum number of bytes searched for the first line
# units of a move: duration in s or ms, speed in mm/s, fraction in percent
UNITS = ("sec", "msec", "mm/sec", "%")
_LINE = re.compile(r" *\d*:(.*?) *; *$")
_MOTION = re.compile(
    r" *\d*: *([JL]) P\[(\d+)(?::[^\]]*)?\] ?(\d*\.?\d+)(%|msec|sec|mm/sec) ?(?:(FINE)|CNT ?(\d+))"
    r"(?: +(TB [^;]*?))? *; *$"
)


class _Instruction(NamedTuple):
    """An instruction with its line number, or a run of moves.

    A run covers the moves `first_move` .. `end` (exclusive); `text` is then the option of its last
    move, if any.
    """

    number: int
    text: str
    first_move: int = 0
    end: int = 0


@dataclass
class _Moves:
    """All n moves of a file in order.

    line: line numbers. point: position numbers. value, unit: speed and index of its unit. straight:
    whether the move is linear. corner: CNT, NaN for moves that stop.
    """

    line: Index
    point: Index
    value: Array
    unit: Index
    straight: Mask
    corner: Array


@dataclass
class Listing:
    """One file: its instructions, its moves, and its position records sorted by number."""

    file: str
    instructions: list[_Instruction]
    moves: _Moves
    records: Records

    @cached_property
    def same_frames(self) -> bool:
        """Whether all positions use the same frames."""
        return len(set(self.records.frames)) == 1

    def rows(self, points: Index) -> Index:
        """Return the record rows of positions.

        Parameters
        ----------
        points : (k,) array of int
            Position numbers in the file.

        Returns
        -------
        (k,) array of int
            Rows of `records`; -1 for missing positions.
        """
        points_recorded = self.records.point
        if not len(points_recorded):
            return np.full(len(points), -1)
        candidates = np.minimum(np.searchsorted(points_recorded, points), len(points_recorded) - 1)
        return np.where(points_recorded[candidates] == points, candidates, -1)


def _text(content: bytes) -> str:
    return content.decode("latin-1").replace("\r\n", "\n")


def name_of(file: str, content: bytes) -> str:
    """Return the name of a program in upper case."""
    title = re.match(r"/PROG +(\w+)\s*$", _text(content[:_TITLE]).partition("\n")[0])
    if title is None:
        raise unreadable(file, _NO_LISTING)
    return title[1].upper()


def listing_of(file: str, content: bytes) -> Listing:
    """Parse a file. Raises InputError UNREADABLE_PROGRAM with file and line."""
    text = f"\n{_text(content)}\n"
    marks = [text.find(f"\n{section}\n") for section in ("/MN", "/POS", "/END")]
    if -1 in marks or marks != sorted(marks):
        raise unreadable(file, _NO_LISTING)
    # records are by far the largest section, so they are not split into lines
    lines = text[1 : marks[1]].split("\n")
    start, positions = lines.index("/MN"), len(lines)
    instructions, moves = _instructions(file, lines[start + 1 :], start + 2)
    records = records_of(file, lines, text[marks[1] + len("\n/POS\n") : marks[2]], positions)
    return Listing(file, instructions, moves, records)


def _instructions(file: str, lines: list[str], number: int) -> tuple[list[_Instruction], _Moves]:
    """Return the instructions of lines that start at line `number`, and all moves among them."""
    count = len(lines)
    moves = _Moves(
        np.arange(number, number + count),
        np.zeros(count, dtype=np.intp),
        np.zeros(count),
        np.zeros(count, dtype=np.intp),
        np.zeros(count, dtype=bool),
        np.full(count, np.nan),
    )
    moving, other_rows = np.zeros(count, dtype=bool), []
    options: dict[int, str] = {}  # options of moves, by row
    for row, line in enumerate(lines):
        move = _MOTION.match(line)
        if move is None:
            other_rows.append(row)
            continue
        moving[row] = True
        moves.point[row], moves.value[row] = int(move[2]), float(move[3])
        moves.unit[row], moves.straight[row] = UNITS.index(move[4]), move[1] == "L"
        if move[6]:
            moves.corner[row] = float(move[6])
        if move[7]:
            options[row] = move[7]
    moves_before = np.cumsum(moving)  # number of moves up to each line
    instructions, moves_done = [], 0
    for row in [*sorted([*options, *(row for row in other_rows if lines[row].strip())]), count]:
        option = options.get(row, "")
        upto = row + bool(option)
        moved = int(moves_before[upto - 1]) if upto else 0
        if moved > moves_done:
            instructions.append(_Instruction(0, option, moves_done, moved))
            moves_done = moved
        if row < count and not option:
            statement = _LINE.match(lines[row])
            if statement is None:
                raise unreadable(
                    f"{file} line {number + row}",
                    Text("{!r} is not an instruction", lines[row].strip()),
                )
            instructions.append(_Instruction(number + row, statement[1].strip()))
    return instructions, _Moves(
        *(getattr(moves, entry.name)[moving] for entry in dataclasses.fields(moves))
    )


_ROBOT_AXES = 6  # number of robot axes


@dataclass
class Run:
    """The state while programs are executed.

    pending: record rows of the current listing that moves used but `values` lacks. recorded,
    numbers: frames of the last checked record, and numbers of the selected frames. track: the
    external axis that a remark declares as the track (0 for none), and whether positions have a
    track value. moved: motion groups in the headers.
    """

    cartesian: bool = False
    values: list[Array] = field(default_factory=list)
    configuration: list[tuple[str, ...]] = field(default_factory=list)
    moved: frozenset[str] | None = None
    group: str | None = None
    track: tuple[int, bool] = (0, False)
    digits: float = 0.0
    pending: list[Index] = field(default_factory=list)
    duration: array[float] = field(default_factory=floats)
    speed: array[float] = field(default_factory=floats)
    share: array[float] = field(default_factory=floats)
    deposit: bytearray = field(default_factory=bytearray)
    linear: bytearray = field(default_factory=bytearray)
    blend: array[float] = field(default_factory=floats)
    user_frame: array[float] = field(default_factory=floats)
    tool_frame: array[float] = field(default_factory=floats)
    events: list[Event] = field(default_factory=list)
    frame: dict[str, str] = field(default_factory=dict)
    recorded: tuple[str, str] = ("", "")
    numbers: tuple[float, float] = (np.nan, np.nan)
    output: str = ""
    on: bool = False
    lines: Lines = field(default_factory=Lines)

    def happens(
        self, kind: str, *value: float | str, digits: float = 0.0, ahead: float | None = None
    ) -> None:
        """Add an event before the next move, or ahead of the end of the last move.

        Parameters
        ----------
        kind : str
            Kind of the event.
        *value : float or str
            Values of the event.
        digits : float, optional
            Half of the last digit of a number.
        ahead : float or None, optional
            Time before the end of the last move, s; None for an event before the next move.
        """
        self.events.append(Event(len(self.duration), kind, value, digits, ahead))

    def begin(self, listing: Listing) -> None:
        """Check the motion groups of a listing; a listing without moves may name no group."""
        groups = listing.records.moved
        if groups and self.moved not in (None, groups):
            raise unreadable(
                listing.file, "the header names other motion groups than the previous programs"
            )
        self.moved = groups or self.moved

    def take(self, listing: Listing) -> None:
        """Append the pending records to the values."""
        if self.pending:
            rows, records = np.concatenate(self.pending), listing.records
            if self.values and (self.group, self.values[0].shape[1]) != (
                records.group,
                records.values.shape[1],
            ):
                raise unreadable(
                    f"{listing.file} line {listing.moves.line[0]}",
                    "the program moves other motion groups than the previous programs",
                )
            self.group, self.track = records.group, (self.track[0], records.track)
            self.values.append(records.values[rows])
            self.digits = max(self.digits, records.digits)
            if self.cartesian:
                self.configuration += [records.configuration[row] for row in rows]
            self.pending = []


def read_moves(run: Run) -> ReadMoves:
    """Convert the recorded moves to ReadMoves.

    Raises InputError UNREADABLE_PROGRAM if no remark declares the track.
    """
    cartesian, values, digits = run.cartesian, np.concatenate(run.values), run.digits
    joints, half_turn = (
        (None, 0.0) if cartesian else (_joints(run, values), float(np.radians(digits)))
    )
    deposit, linear = (np.array(column, dtype=np.bool_) for column in (run.deposit, run.linear))
    blend = np.array(run.blend)
    moves = ReadMoves(
        joints,
        half_turn,
        np.array(run.duration),
        deposit,
        linear,
        np.isnan(blend),
        tuple(run.events),
        speed=np.array(run.speed),
        share=np.array(run.share),
        share_digits=0.005,
        blend=blend,
        user_frame=np.array(run.user_frame),
        tool_frame=np.array(run.tool_frame),
        unit=run.group or "",
        linear_digits=digits if run.track[1] else 0.0,
        lines=run.lines.read(),
    )
    if not cartesian:
        return moves
    words = np.array(run.configuration)
    return dataclasses.replace(
        moves,
        position=values[:, :3],
        rotation=_rotation(np.radians(values[:, 3:])),
        position_digits=digits,
        rotation_digits=float(np.radians(digits)),
        configuration=Configuration(
            words[:, 0] == "F",
            words[:, 1] == "U",
            words[:, 2] == "T",
            words[:, 3:].astype(np.float64),
        ),
    )


def _joints(run: Run, values: Array) -> Array:
    """Return joint values (n, axes) of records, rad and mm. A remark gives the position of the
    track among the external axes.
    """
    number, track = run.track
    if track != bool(number) or number > values.shape[1] - _ROBOT_AXES:
        raise unreadable(
            "program",
            "positions have a value for a track but no remark names its axis, or the reverse",
        )
    if not track:
        return np.asarray(np.radians(values))
    angles = np.radians(np.delete(values, _ROBOT_AXES, axis=1))
    return np.asarray(np.insert(angles, _ROBOT_AXES + number - 1, values[:, _ROBOT_AXES], axis=1))


def _rotation(wpr: Array) -> Array:
    """Return rotations (n, 3, 3), Rz(R) Ry(P) Rx(W), of angles W, P, R (n, 3) in rad."""
    cw, cp, cr = np.cos(wpr).T
    sw, sp, sr = np.sin(wpr).T
    rows = (
        (cr * cp, cr * sp * sw - sr * cw, cr * sp * cw + sr * sw),
        (sr * cp, sr * sp * sw + cr * cw, sr * sp * cw - cr * sw),
        (-sp, cp * sw, cp * cw),
    )
    return np.moveaxis(np.array(rows), -1, 0)


_FACTORS = np.array(
    [(1.0, np.nan, np.nan), (0.001, np.nan, np.nan), (np.nan, 1.0, np.nan), (np.nan, np.nan, 0.01)]
)
_SPEED, _SHARE = UNITS.index("mm/sec"), UNITS.index("%")
_MOST_CNT = 100.0
_OUTPUT = re.compile(r"DO\[(\d+)(?::[^\]]*)?\]=(ON|OFF)$")
_TRIGGER = re.compile(r"TB +(\d*\.(\d+))sec,(DO\[\d+(?::[^\]]*)?\]=(?:ON|OFF))$")
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


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with the program that no other program
    calls.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    named = {name_of(file, files[file]): file for file in sorted(files)}
    if len(named) < len(files):
        raise unreadable("program", "two files hold a program of the same name")
    calling = [content.decode("latin-1") for content in files.values() if b"CALL " in content]
    called = {call.upper() for content in calling for call in _CALLS.findall(content)}
    main = [name for name in named if name not in called]
    if len(main) != 1:
        raise unreadable(
            "program",
            Text(
                "{} programs are called by no other program, but exactly one must be the main "
                "program",
                len(main),
            ),
        )
    run = Run()
    _follow(main[0], {name: (file, files[file]) for name, file in named.items()}, run, ())
    if not run.duration:
        raise unreadable("program", "the program has no moves")
    return read_moves(run)


def _follow(
    name: str, files: dict[str, tuple[str, bytes]], run: Run, callers: tuple[str, ...]
) -> None:
    """Execute the instructions of a program in order, and the programs that it calls.

    Only listings being executed stay in memory.
    """
    if name in callers:
        raise unreadable(files[name][0], "the program calls itself")
    listing = listing_of(*files[name])
    run.begin(listing)
    for position, (number, statement, begin, end) in enumerate(listing.instructions):
        if end > begin:
            _move(listing, slice(begin, end), statement, run)
        elif call := _CALL.match(statement):
            if call[1].upper() in files:
                run.take(listing)
                _follow(call[1].upper(), files, run, (*callers, name))
            else:
                run.happens("call", call[1].upper())
        elif statement == "END" and position == len(listing.instructions) - 1:
            break
        else:
            _carry_out(statement, f"{listing.file} line {number}", run)
    run.take(listing)


def _carry_out(statement: str, where: str, run: Run) -> None:
    for form, instruction in _INSTRUCTIONS.items():
        if match := form.match(statement):
            instruction(match, where, run)
            return
    if not _HARMLESS.match(statement):
        raise unreadable(where, Text("the instruction {!r} is not understood", statement))


def _switch(
    output: re.Match[str], where: str, run: Run, digits: float = 0.0, ahead: float | None = None
) -> None:
    """Switch the deposit by an output."""
    if run.output not in ("", output[1]):
        raise unreadable(where, "the program switches a second output")
    run.output, run.on = output[1], output[2] == "ON"
    run.happens("on" if run.on else "off", float(output[1]), "DO", digits=digits, ahead=ahead)


def _trigger(option: str, where: str, run: Run) -> None:
    """Record that the last move switches the deposit ahead of its end, by the time in `option`."""
    trigger = _TRIGGER.match(option)
    output = trigger and _OUTPUT.match(trigger[3])
    if not trigger or not output:
        raise unreadable(where, Text("the instruction {!r} is not understood", option))
    if not np.isnan(run.blend[-1]):
        raise unreadable(
            where, "a trigger needs a move that ends at its point, but the corner is rounded"
        )
    _switch(output, where, run, 0.5 * 10.0 ** -len(trigger[2]), float(trigger[1]))


def _frame(frame: re.Match[str], where: str, run: Run) -> None:
    """Select a user or tool frame."""
    if run.frame.setdefault(frame[1], frame[2]) != frame[2]:
        raise unreadable(where, Text("a second U{} is selected", frame[1]))
    run.recorded = ("", "")


def _arc(arc: re.Match[str], where: str, run: Run) -> None:
    """Start or end the arc with a schedule."""
    if run.output not in ("", ARC) or run.on == (arc[1] == "Start"):
        raise unreadable(
            where, "an output switches the deposit too, or the arc is already on or still off"
        )
    run.output, run.on = ARC, arc[1] == "Start"
    run.happens("on" if run.on else "off", float(arc[2]), ARC)


def _weave(weave: re.Match[str], where: str, run: Run) -> None:
    run.happens("weave", float(weave[1] or 0))


def _schedule(group: re.Match[str], where: str, run: Run) -> None:
    run.happens("schedule", float(group[1]), float(group[2]))


def _wait_below(cool: re.Match[str], where: str, run: Run) -> None:
    run.happens("below", float(cool[1]), float(cool[2]), digits=1e-6)


def _wait(wait: re.Match[str], where: str, run: Run) -> None:
    run.happens("wait", float(wait[1]), digits=0.5 * 10.0 ** -len(wait[2]))


def _wait_input(wait: re.Match[str], where: str, run: Run) -> None:
    run.happens("input", float(wait[1]))


def _layer(layer: re.Match[str], where: str, run: Run) -> None:
    run.happens("layer", float(layer[1]))


def _track(track: re.Match[str], where: str, run: Run) -> None:
    run.track = int(track[1]), run.track[1]


_INSTRUCTIONS: dict[re.Pattern[str], Callable[[re.Match[str], str, Run], None]] = {
    _OUTPUT: _switch,
    _GROUP: _schedule,
    _ARC: _arc,
    _WEAVE: _weave,
    _COOL: _wait_below,
    _WAIT: _wait,
    _INPUT: _wait_input,
    _LAYER: _layer,
    _TRACK: _track,
    _FRAME: _frame,
}


def _move(listing: Listing, rows_moved: slice, option: str, run: Run) -> None:
    """Execute a run of moves column by column, and the option of its last move."""
    moves, cartesian = listing.moves, listing.records.cartesian
    unit = moves.unit[rows_moved]
    straight = moves.straight[rows_moved]
    corner = moves.corner[rows_moved]
    rows = listing.rows(moves.point[rows_moved])
    wrong = (
        (rows < 0)
        | (straight & (not cartesian))
        | (unit == np.where(straight, _SHARE, _SPEED))
        | (corner > _MOST_CNT)
    )
    if run.cartesian != cartesian and run.duration:
        wrong[:] = True
    if wrong.any():
        _refuse(listing, rows_moved.start + int(np.argmax(wrong)), run)
    run.cartesian = cartesian
    frames = listing.records.frames
    alike = listing.same_frames
    selected = frames if alike else [frames[row] for row in rows]
    changes = (
        [0] if alike else [k for k in range(len(rows)) if k == 0 or selected[k] != selected[k - 1]]
    )
    for begin, end in zip(changes, [*changes[1:], len(rows)]):
        if selected[begin] != run.recorded:
            _select(listing, int(rows[begin]), run, int(moves.line[rows_moved][begin]))
        run.user_frame.extend([run.numbers[0]] * (end - begin))
        run.tool_frame.extend([run.numbers[1]] * (end - begin))
    run.pending.append(rows)
    run.lines.extend(listing.file, moves.line[rows_moved])
    value = moves.value[rows_moved, None] * _FACTORS[unit]
    for column, numbered in zip(
        (run.duration, run.speed, run.share, run.blend), (*value.T, corner)
    ):
        column.frombytes(numbered.tobytes())
    run.deposit += bytes([run.on]) * len(rows)
    run.linear += straight.tobytes()
    if option:
        _trigger(option, _line_name(listing, int(moves.line[rows_moved][-1])), run)


def _refuse(listing: Listing, move: int, run: Run) -> None:
    """Raise InputError for the reason why a move is not understood."""
    moves, records = listing.moves, listing.records
    where = _line_name(listing, int(moves.line[move]))
    unit = int(moves.unit[move])
    corner = moves.corner[move]
    if moves.point[move] not in records.point:
        raise unreadable(where, Text("P[{}] is not recorded", moves.point[move]))
    if run.cartesian != records.cartesian and run.duration:
        raise unreadable(where, "the program mixes joint and Cartesian positions")
    if moves.straight[move] and not records.cartesian:
        raise unreadable(
            where,
            "a move does not fit the form in which its position is recorded (joint or Cartesian)",
        )
    raise unreadable(
        where,
        Text(
            "{} or CNT{} is not understood here",
            UNITS[unit],
            "" if np.isnan(corner) else int(corner),
        ),
    )


def _select(listing: Listing, row: int, run: Run, number: int) -> None:
    """Check that a position's frames are selected. Positions in the same frames need no further
    check until the selection changes.
    """
    recorded = listing.records.frames[row]
    for word, frame in zip(("FRAME", "TOOL"), recorded, strict=True):
        if frame not in ("F", run.frame.get(word)):
            raise unreadable(
                _line_name(listing, number),
                Text(
                    "P[{}] is recorded in a U{} that is not selected",
                    listing.records.point[row],
                    word,
                ),
            )
    run.recorded = recorded
    run.numbers = float(run.frame.get("FRAME", "nan")), float(run.frame.get("TOOL", "nan"))


def _line_name(listing: Listing, line_number: int) -> str:
    return f"{listing.file} line {line_number}"
