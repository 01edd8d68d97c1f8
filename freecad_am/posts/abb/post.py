# SPDX-License-Identifier: LGPL-2.1-or-later
"""ABB: RAPID modules of joint moves by time, or of linear moves with the speed held at the tip.

With the part on the robot linear moves have a stationary tool, the nozzle, and a work object that the robot holds: points
are where the nozzle is on the part. Rapids are joint moves in either, and stop at every point. What is written, what must
be set on the controller and what was confirmed where: docs/posts/abb.md.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ...core.controller import Controller
from ...core.issues import InputError
from ...core.orientation import QUATERNION, Pendant
from ...core.program import (
    LINEAR_MOVE,
    Block,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Program,
    Schedule,
    Wait,
    WaitBelow,
    WaitInput,
)
from ..names import Naming
from ..on_controller import on_controller
from ..parts import Piece, Run, grouped, packed, size, unbroken, with_retracts
from ..refusals import (
    refuse_calls_of_own,
    refuse_continuous,
    refuse_cooling,
    refuse_external,
    refuse_incomplete,
    refuse_schedules,
    refuse_triggers,
    refuse_wire,
    refuse_without_positions,
)
from . import numbers, text
from .read import read

__all__ = ["read", "write"]

LAST_ANALOGUE = 4096
# why the speed of the wire cannot follow that of the torch
CONTROLLER = Controller(external=True, positioner="STN1", whole_beads=True, straight_in_part=True)
PENDANT = Pendant("ABB", ("q1", "q2", "q3", "q4"), QUATERNION, 7)
NO_WIRE = "an analogue output that RAPID sets between two moves is set ahead of the motion, and TriggSpeed was not tried"
NO_WEAVE = "a weave is an argument of ArcL, which runs at the speed of its welddata while the arc burns, so far as is known"
NO_TRIGGER = "it is not written yet"
NO_SCHEDULE = {
    "arc": "ArcL runs at the speed of its welddata while the arc burns, so far as is known, not at the planned one",
}
LAST_GROUP, LAST_SCHEDULE = 9999, 65535  # group outputs
MOVE_LINE = re.compile(rb" *Move(?:AbsJ|L|J) ")
ON_CONTROLLER = on_controller(
    "The controller's world is the robot's base",
    "Signals do1, di1 and so on have these names",
    "The load of t_am is set, and the speed override is 100 %",
    "Configuration supervision may be off (ConfL), and joint values mean what the machine file says",
    "A stop of the program switches the deposit off",
)
AXES = 6
SETUPS = ("part-on-robot", "tool-on-robot")
FOLDER = "HOME:/"  # where parts are loaded from

_RESERVED = frozenset(
    ("ALIAS", "AND", "BACKWARD", "CASE", "CONNECT", "CONST", "DEFAULT", "DIV", "DO", "ELSE", "ELSEIF", "ENDFOR", "ENDFUNC")
    + ("ENDIF", "ENDMODULE", "ENDPROC", "ENDRECORD", "ENDTEST", "ENDTRAP", "ENDWHILE", "ERROR", "EXIT", "FALSE", "FOR")
    + ("FROM", "FUNC", "GOTO", "IF", "INOUT", "LOCAL", "MOD", "MODULE", "NOSTEPIN", "NOT", "NOVIEW", "OR", "PERS", "PROC")
    + ("RAISE", "READONLY", "RECORD", "RETRY", "RETURN", "STEP", "SYSMODULE", "TASK", "TEST", "THEN", "TO", "TRAP", "TRUE")
    + ("TRYNEXT", "UNDO", "VAR", "VIEWONLY", "WHILE", "WITH", "XOR", "USER", "BASE", text.MAIN.upper())
    + tuple(name.upper() for name in (text.TOOL, text.WORK_OBJECT, text.SPEED))
)
# 16 characters on older controllers, of which the routine of a part takes two more than its name
NAMING = Naming(
    str, "[A-Za-z]", "a letter", longest=14, spare=4, prefix="am_", reserved=_RESERVED, what="a module's name"
)
_NO_END = 10**9  # how many lines a module may have is not known: it is cut by its points


def write(program: Program) -> dict[str, bytes]:
    """The modules of a program, file name -> content; the same bytes for the same program.

    One file NAME.mod where its points fit, else NAME.mod loads NAME01.mod, NAME02.mod and so on one after the other, each
    with whole beads. The duration of the very first move is as the program tells it.

    Raises InputError: PROGRAM_NAME, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, ENDLESS_AXIS, MOVE_TIME, MOVE_SPEED,
    NO_POSITIONS, BEAD_TOO_LONG, ANALOGUE_INPUT, NO_WIRE_OUTPUT, UNREACHABLE, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [line for words in ("Robotic AM", *program.remarks, *_own_remarks(program)) for line in text.remark(words)]
    words = numbers.Words(program, text.SPEED, text.ZONE)
    groups = list(grouped(program, words, lambda block: _instructions(program, block)))
    if size([piece for group in groups for piece in group])[0] <= program.max_points:
        (pieces,) = packed(groups, program.max_points, _NO_END, unbroken)
        refuse_calls_of_own(program, {name}, program_name)
        return {f"{name}.mod": _module(program, words, name, text.MAIN, remarks, pieces)}
    # one place is kept for the withdrawal from the last bead: what follows is loaded away from it
    parts = with_retracts(packed(groups, program.max_points - 1, _NO_END, unbroken))
    names = NAMING.parts(name, len(parts))
    refuse_calls_of_own(program, {name, *names, *map(text.routine_of, names)}, program_name)
    files = {}
    for number, (part, pieces) in enumerate(zip(names, parts, strict=True), 1):
        head = text.remark(f"part {number} of {len(parts)}")
        files[f"{part}.mod"] = _module(program, words, part, text.routine_of(part), head, pieces)
    total = sum(map(len, files.values()))
    remarks += text.remark(f"{len(parts)} parts of {total} bytes in all, loaded from {FOLDER} one after the other")
    load = [line for part in names for line in text.load(FOLDER, part)]
    return {f"{name}.mod": text.module(name, text.MAIN, remarks, (), load), **files}


def program_name(name: str, where: str) -> str:
    """The name on the controller. Raises InputError PROGRAM_NAME saying why not, and proposing one."""
    return NAMING.checked(name, where)


def refuse_setup(
    motion: str, setup: str, external: tuple[str, ...] = (), carried: tuple[float, ...] | None = None
) -> None:
    """Raises InputError UNSUPPORTED_SETUP for what cannot be said to this controller; both motions can."""
    if setup not in SETUPS:
        raise InputError("UNSUPPORTED_SETUP", "cell.setup", "the post abb cannot write {} ({} motion); use another post",
                         setup, motion)


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    refuse_incomplete(program, "abb", AXES + len(program.external_kinds))
    refuse_external(program, text.MOST_AXES, r"[A-Za-z]\w{0,31}", "the name of its mechanical unit, such as STN1")
    refuse_wire(program, NO_WIRE)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, LAST_ANALOGUE)
    refuse_schedules(program, LAST_GROUP, LAST_SCHEDULE)
    refuse_continuous(program)
    refuse_without_positions(program, straight=True)
    for block in program.blocks:
        if isinstance(block, Call):
            program_name(block.program, block.where)


def _own_remarks(program: Program) -> Iterator[str]:
    for axis in np.flatnonzero(program.slides).tolist():
        letter = "abcdef"[program.first_external + axis - AXES - 1]
        yield f"eax_{letter} is the track in mm, which moves the base frame of the robot"
    if program.on_positioner:
        yield f"{text.WORK_OBJECT} is on the face of {program.unit}, and seen from its user frame"
    if program.holds_part:
        yield f"{text.TOOL} is the nozzle, which stands; {text.WORK_OBJECT} is what the robot holds"
    yield f"set the load of {text.TOOL}: mass and centre of gravity of what the robot carries"
    if program.dry_run:
        yield "dry run: no deposit"


def _instructions(program: Program, block: Block) -> list[str]:
    output = f"    SetDO do{program.deposit_output},"
    if isinstance(block, DepositOn):
        return [] if program.dry_run else [f"{output}1;", *text.wait(block.lead)]
    if isinstance(block, DepositOff):
        return [] if program.dry_run else [*text.wait(block.lead), f"{output}0;"]
    if isinstance(block, Schedule):
        return [f"    SetGO go{program.schedule_output},{block.number};"]
    if isinstance(block, LayerStart):
        return [f"    ! layer {block.layer}"]
    if isinstance(block, Wait):
        return text.wait(block.seconds)
    if isinstance(block, WaitInput):
        return [f"    WaitDI di{block.number},1;"]
    if isinstance(block, WaitBelow):
        return [f"    WaitAI ai{block.number},\\LT,{block.below:.6f};"]
    if isinstance(block, Call):
        return [f"    {block.program};"]
    raise TypeError(f"no instruction for {block!r}")


def _module(
    program: Program, words: numbers.Words, name: str, routine: str, remarks: list[str], pieces: Sequence[Piece]
) -> bytes:
    held = program.holds_part
    station, carried = numbers.pose(program.station), numbers.pose(program.carried)
    lines = ["    ConfL\\Off;", "    SingArea\\Off;", *text.activated(program.unit)]
    used: set[str] = set()
    for piece in pieces:
        if isinstance(piece, Run):
            lines += _motion(piece, program.first_external, program.slides)
            used.update(word.rpartition(",")[2] for word in piece.words[piece.start : piece.stop])
        else:
            lines += piece
    zones = [(zone, size_mm) for size_mm, zone in words.zones.items() if zone in used]
    tool, work_object = (station, carried) if held else (carried, station)
    moved_by = program.unit if program.on_positioner else ""
    return text.module(name, routine, remarks, text.data(tool, work_object, held, zones, moved_by), lines)


def _motion(run: Run, first: int, slides: NDArray[np.bool_]) -> list[str]:
    """Lines through all points of a run. first: the number of the first axis beside the robot; slides: (axes,) the track."""
    moves, rows = run.moves, slice(run.start, run.stop)
    if moves.interpolation != LINEAR_MOVE:
        return text.joint_moves(numbers.shown(moves.joints[rows], slides), run.words[rows], first)
    assert moves.position is not None and moves.rotation is not None
    return text.linear_moves(
        numbers.positions(moves.position[rows]), numbers.quaternions(moves.rotation[rows]),
        numbers.shown(moves.joints[rows, AXES:], slides[AXES:]), run.words[rows], first,
    )
