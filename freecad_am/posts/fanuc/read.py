# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads FANUC listings back: the behaviour of the controller, from nothing but the text.

Shares nothing with the writer. Understands the plain instructions a path needs and refuses every
other one, so that no motion can hide in unknown text.
"""

from __future__ import annotations

import re

import numpy as np

from ...core.issues import Text
from ...core.read_moves import ARC, ReadMoves
from .found import Run, read_moves
from .parsed import UNITS, Listing, listing_of, name_of
from .records import unreadable

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
        raise unreadable(
            "program", Text("{} programs are called by no other program, expected one", len(main))
        )
    run = Run()
    _follow(main[0], {name: (file, files[file]) for name, file in named.items()}, run, ())
    if not run.duration:
        raise unreadable("program", "there are no moves")
    return read_moves(run)


def _follow(
    name: str, files: dict[str, tuple[str, bytes]], run: Run, callers: tuple[str, ...]
) -> None:
    """Carry out the instructions of a program in order, and of programs it calls. A listing is kept
    in memory while it is followed.
    """
    if name in callers:
        raise unreadable(files[name][0], "it calls itself")
    listing = listing_of(*files[name])
    run.begin(listing)
    for position, (number, statement, begin, end) in enumerate(listing.instructions):
        if end > begin:
            _move(listing, slice(begin, end), statement, run)
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
        elif input_wait := _INPUT.match(statement):
            run.happens("input", float(input_wait[1]))
        elif layer := _LAYER.match(statement):
            run.happens("layer", float(layer[1]))
        elif track := _TRACK.match(statement):
            run.track = int(track[1]), run.track[1]
        elif frame := _FRAME.match(statement):
            _frame(frame, f"{listing.file} line {number}", run)
        elif statement == "END" and position == len(listing.instructions) - 1:
            break
        elif not _HARMLESS.match(statement):
            raise unreadable(
                f"{listing.file} line {number}",
                Text("the instruction {!r} is not understood", statement),
            )
    run.take(listing)


def _switch(
    output: re.Match[str], where: str, run: Run, digits: float = 0.0, ahead: float | None = None
) -> None:
    """The deposit goes on or off."""
    if run.output not in ("", output[1]):
        raise unreadable(where, "a second output is switched")
    run.output, run.on = output[1], output[2] == "ON"
    run.happens("on" if run.on else "off", float(output[1]), "DO", digits=digits, ahead=ahead)


def _trigger(option: str, where: str, run: Run) -> None:
    """The last move has switched the deposit, by the time in `option` before its end."""
    trigger = _TRIGGER.match(option)
    output = trigger and _OUTPUT.match(trigger[3])
    if not trigger or not output:
        raise unreadable(where, Text("the instruction {!r} is not understood", option))
    if not np.isnan(run.blend[-1]):
        raise unreadable(where, "a corner has no end from which the time of a trigger counts")
    _switch(output, where, run, 0.5 * 10.0 ** -len(trigger[2]), float(trigger[1]))


def _frame(frame: re.Match[str], where: str, run: Run) -> None:
    """A user or a tool frame is selected."""
    if run.frame.setdefault(frame[1], frame[2]) != frame[2]:
        raise unreadable(where, Text("a second U{} is selected", frame[1]))
    run.recorded = ("", "")


def _arc(arc: re.Match[str], where: str, run: Run) -> None:
    """The arc is struck, or ends, by a schedule."""
    if run.output not in ("", ARC) or run.on == (arc[1] == "Start"):
        raise unreadable(where, "an output is switched too, or the arc burns already, or not yet")
    run.output, run.on = ARC, arc[1] == "Start"
    run.happens("on" if run.on else "off", float(arc[2]), ARC)


def _move(listing: Listing, rows_moved: slice, option: str, run: Run) -> None:
    """Carry out a run of moves, column by column, and the option of the last one."""
    moves, cartesian = listing.moves, listing.records.cartesian
    unit, straight, corner = (
        moves.unit[rows_moved],
        moves.straight[rows_moved],
        moves.corner[rows_moved],
    )
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
    """InputError for what cannot be understood of a move."""
    moves, records = listing.moves, listing.records
    where, unit, corner = (
        _line_name(listing, int(moves.line[move])),
        int(moves.unit[move]),
        moves.corner[move],
    )
    if moves.point[move] not in records.point:
        raise unreadable(where, Text("P[{}] is not recorded", moves.point[move]))
    if run.cartesian != records.cartesian and run.duration:
        raise unreadable(where, "joint and Cartesian positions are mixed")
    if moves.straight[move] and not records.cartesian:
        raise unreadable(where, "a position is moved to in another way than it is recorded")
    raise unreadable(
        where,
        Text(
            "{} or CNT{} is not understood here",
            UNITS[unit],
            "" if np.isnan(corner) else int(corner),
        ),
    )


def _select(listing: Listing, row: int, run: Run, number: int) -> None:
    """Check the frames that a position is recorded in; equal ones need no check until others are
    selected.
    """
    recorded = listing.records.frames[row]
    for word, frame in zip(("FRAME", "TOOL"), recorded, strict=True):
        if frame not in ("F", run.frame.get(word)):
            raise unreadable(
                _line_name(listing, number),
                Text(
                    "P[{}] is recorded in another U{} than the selected one",
                    listing.records.point[row],
                    word,
                ),
            )
    run.recorded = recorded
    run.numbers = float(run.frame.get("FRAME", "nan")), float(run.frame.get("TOOL", "nan"))


def _line_name(listing: Listing, line_number: int) -> str:
    return f"{listing.file} line {line_number}"
