# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write ABB RAPID modules of joint moves by time, or of linear moves at a constant tip speed.

With the part on the robot, linear moves use a stationary tool (the nozzle) and a work object that
the robot holds. Points are then nozzle positions relative to the part. In all cases rapids are
joint moves that stop at every point. Output, controller settings and confirmations:
docs/posts/abb.md.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

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
    Moves,
    Program,
    Schedule,
    Wait,
    WaitBelow,
    WaitInput,
    Weave,
)
from ..catalogue import Naming, controller_checks
from ..parts import Piece, Run, grouped, move_retracts, packed, size, unbroken
from ..refusals import (
    Asked,
    refuse_calls_of_own,
    refuse_continuous,
    refuse_cooling,
    refuse_external,
    refuse_incomplete,
    refuse_names_of_data,
    refuse_schedules,
    refuse_triggers,
    refuse_weave,
    refuse_without_positions,
)
from . import process, text
from .read import read
from .read_process import INSTRUCTIONS

__all__ = ["read", "write"]

LAST_ANALOGUE = 4096
CONTROLLER = Controller(
    point_bytes=150,
    external=True,
    positioner="STN1",
    whole_beads=True,
    straight_in_part=True,
    linear_triggers=True,
)
PENDANT = Pendant("ABB", ("q1", "q2", "q3", "q4"), QUATERNION, 7)
NO_WIRE = NO_WEAVE = NO_TRIGGER = ""  # refuse_process rejects unsupported combinations
NO_SCHEDULE: dict[str, str] = {}
refuse_process = process.refuse
LAST_GROUP, LAST_SCHEDULE = 9999, 65535  # group outputs
# an ArcLEnd at the plain speed belongs to the end of the previous move
MOVE_LINE = re.compile(rb" *(?:Move(?:AbsJ|L|J)|Trigg(?:AbsJ|L)|ArcL|ArcLEnd(?! [^v]*v_am,)) ")
ON_CONTROLLER = controller_checks(
    "The world frame of the controller is the robot base",
    "The signals are called do1, di1 and so on",
    "The load of t_am is set, and the speed override is 100 %",
    "Configuration supervision (ConfL) may be off, and joint values have the meaning in the machine file",
    "A stop of the program switches the deposit off",
)
AXES = 6
SETUPS = ("part-on-robot", "tool-on-robot")
FOLDER = "HOME:/"  # folder that parts are loaded from

_RESERVED = INSTRUCTIONS | frozenset(
    (
        "ALIAS",
        "AND",
        "BACKWARD",
        "CASE",
        "CONNECT",
        "CONST",
        "DEFAULT",
        "DIV",
        "DO",
        "ELSE",
        "ELSEIF",
        "ENDFOR",
        "ENDFUNC",
    )
    + (
        "ENDIF",
        "ENDMODULE",
        "ENDPROC",
        "ENDRECORD",
        "ENDTEST",
        "ENDTRAP",
        "ENDWHILE",
        "ERROR",
        "EXIT",
        "FALSE",
        "FOR",
    )
    + (
        "FROM",
        "FUNC",
        "GOTO",
        "IF",
        "INOUT",
        "LOCAL",
        "MOD",
        "MODULE",
        "NOSTEPIN",
        "NOT",
        "NOVIEW",
        "OR",
        "PERS",
        "PROC",
    )
    + (
        "RAISE",
        "READONLY",
        "RECORD",
        "RETRY",
        "RETURN",
        "STEP",
        "SYSMODULE",
        "TASK",
        "TEST",
        "THEN",
        "TO",
        "TRAP",
        "TRUE",
    )
    + (
        "TRYNEXT",
        "UNDO",
        "VAR",
        "VIEWONLY",
        "WHILE",
        "WITH",
        "XOR",
        "USER",
        "BASE",
        text.MAIN.upper(),
    )
    + tuple(
        name.upper() for name in (text.TOOL, text.WORK_OBJECT, text.SPEED, *process.TRIGGER_NAMES)
    )
)
# 16 characters on older controllers; the routine of a part needs two more characters than its
# module
NAMING = Naming(
    str,
    "[A-Za-z]",
    "a letter",
    longest=14,
    spare=4,
    prefix="am_",
    reserved=_RESERVED,
    what="a module's name",
)
_NO_END = (
    10**9
)  # the maximum number of lines in a module is unknown, so modules are split by points


def write(program: Program) -> dict[str, bytes]:
    """Write the modules of a program, file name -> content; the same program always gives the same
    bytes.

    If all points fit into one file, write only NAME.mod. Otherwise NAME.mod loads NAME01.mod,
    NAME02.mod and so on in turn, each with whole beads. The first move takes its duration from the
    program.

    Raises InputError: PROGRAM_NAME, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, ENDLESS_AXIS, MOVE_TIME,
    MOVE_SPEED, NO_POSITIONS, BEAD_TOO_LONG, ANALOGUE_INPUT, NO_WIRE_OUTPUT, UNREACHABLE,
    NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [
        line
        for words_of_remark in ("Robotic AM", *program.remarks, *_own_remarks(program))
        for line in text.remark(words_of_remark)
    ]
    zones = text.Words(program, text.SPEED, text.ZONE)
    words = process.Process(program, zones)
    groups = list(grouped(program, words, lambda block: _instructions(program, words, block)))
    remarks += (
        text.remark(f"declare on the controller {' '.join(words.declared)}")
        if words.declared
        else []
    )
    refuse_names_of_data(program, {name}, _names_used(program, words, zones))
    module = _Module(program, words, zones)
    if size([entry for group in groups for entry in group])[0] <= program.max_points:
        (piece_list,) = packed(groups, program.max_points, _NO_END, unbroken)
        refuse_calls_of_own(program, {name}, program_name)
        return {f"{name}.mod": module.as_bytes(name, text.MAIN, remarks, piece_list)}
    # one point is reserved for the retract from the last bead, so that the next part is loaded
    # there
    part_groups = move_retracts(packed(groups, program.max_points - 1, _NO_END, unbroken))
    names = NAMING.parts(name, len(part_groups))
    refuse_calls_of_own(program, {name, *names, *map(text.routine_of, names)}, program_name)
    refuse_names_of_data(program, names, _names_used(program, words, zones))
    files = {}
    for number, (part_name, piece_list) in enumerate(zip(names, part_groups, strict=True), 1):
        head = text.remark(f"part {number} of {len(part_groups)}")
        files[f"{part_name}.mod"] = module.as_bytes(
            part_name, text.routine_of(part_name), head, piece_list
        )
    total = sum(map(len, files.values()))
    remarks += text.remark(
        f"{len(part_groups)} parts of {total} bytes in all, loaded from {FOLDER} one after the other"
    )
    load = [line for part_name in names for line in text.load(FOLDER, part_name)]
    return {f"{name}.mod": text.module(name, text.MAIN, remarks, (), load), **files}


def program_name(name: str, where: str) -> str:
    """Return the name on the controller.

    Raises InputError PROGRAM_NAME with the reason and a valid proposal.
    """
    return NAMING.checked(name, where)


def refuse_setup(
    motion: str,
    setup: str,
    external: tuple[str, ...] = (),
    carried: tuple[float, ...] | None = None,
) -> None:
    """Reject unsupported set-ups; both motions are supported.

    Raises InputError UNSUPPORTED_SETUP.
    """
    if setup not in SETUPS:
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post abb cannot write {} ({} motion); use another post",
            setup,
            motion,
        )


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    refuse_incomplete(program, "abb", AXES + len(program.external_kinds))
    refuse_external(
        program,
        text.MOST_AXES,
        r"[A-Za-z]\w{0,31}",
        "the name of its mechanical unit, such as STN1",
    )
    refuse_process(_asked(program))
    refuse_weave(program, process.LAST_WEAVE)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, LAST_ANALOGUE)
    refuse_schedules(program, LAST_GROUP, LAST_SCHEDULE, process.LAST_SEAM)
    refuse_continuous(program)
    refuse_without_positions(program, straight=True)
    for block in program.blocks:
        if isinstance(block, Call):
            program_name(block.program, block.where)


def _asked(program: Program) -> Asked:
    arc = any(
        isinstance(block, DepositOn) and block.schedule is not None for block in program.blocks
    )
    return Asked(
        program.motion,
        program.holds_part,
        program.on_positioner,
        process.ARC if arc else "",
        any(run.wire is not None for run in program.moves),
        bool(program.woven),
        program.dry_run,
    )


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


def _instructions(program: Program, words: process.Process, block: Block) -> list[str]:
    if isinstance(block, DepositOn):
        return (
            []
            if program.dry_run
            else [*_switched(program, words, block, True), *text.wait(block.lead)]
        )
    if isinstance(block, DepositOff):
        return (
            []
            if program.dry_run
            else [*text.wait(block.lead), *_switched(program, words, block, False)]
        )
    if isinstance(block, Weave):
        return []  # the weave is an argument of the moves
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


def _switched(
    program: Program, words: process.Process, block: DepositOn | DepositOff, on: bool
) -> list[str]:
    """Return statements that switch the deposit at the robot's position; empty if a move switches
    it.
    """
    if block.schedule is not None:
        if not on and not block.lead:
            return []
        moves = words.before
        word = words.arc_start(block.schedule) if on else words.arc_end(block.schedule)
        return _motion(moves, slice(len(moves) - 1, None), [word], program, straight=True)
    return [] if block.ahead is not None else [f"    SetDO do{program.deposit_output},{int(on)};"]


def _names_used(program: Program, words: process.Process, zones: text.Words) -> list[str]:
    """Return the names of data and signals in the text, except names that no program can have."""
    kinds = {WaitInput: "di", WaitBelow: "ai"}
    inputs = [
        f"{kinds[type(block)]}{block.number}"
        for block in program.blocks
        if isinstance(block, (WaitInput, WaitBelow))
    ]
    return [
        *words.names,
        *words.declared,
        *zones.zones.values(),
        f"do{program.deposit_output}",
        *inputs,
    ]


@dataclass(frozen=True)
class _Module:
    """Write the modules of a program; words and zones of all its moves must be complete."""

    program: Program
    words: process.Process
    zones: text.Words

    def as_bytes(
        self, name: str, routine: str, remarks: list[str], piece_list: Sequence[Piece]
    ) -> bytes:
        """Return a module with the data that its moves use."""
        program, part_held = self.program, self.program.holds_part
        station, carried = text.pose(program.station), text.pose(program.carried)
        lines: list[str] = []
        used: set[str] = set()
        for entry in piece_list:
            if isinstance(entry, Run):
                rows = slice(entry.start, entry.stop)
                lines += _motion(entry.moves, rows, entry.words[rows], program)
                for word in entry.words[rows]:
                    used.update(
                        re.findall(r"\w+", word) if " " in word else (word.rpartition(",")[2],)
                    )
            else:
                lines += entry
        zones = [(zone, size_mm) for size_mm, zone in self.zones.zones.items() if zone in used]
        tool, work_object = (station, carried) if part_held else (carried, station)
        moved_by = program.unit if program.on_positioner else ""
        data = [*text.data(tool, work_object, part_held, zones, moved_by), *self.words.data(used)]
        setup = [
            "    ConfL\\Off;",
            "    SingArea\\Off;",
            *text.activated(program.unit),
            *self.words.setup(used),
        ]
        return text.module(name, routine, remarks, data, [*setup, *lines])


def _motion(
    moves: Moves, rows: slice, words: Sequence[str], program: Program, straight: bool = False
) -> list[str]:
    """Return the lines through some points of moves. straight: write positions even for joint
    moves.
    """
    first_external, slides = program.first_external, program.slides
    if moves.interpolation != LINEAR_MOVE and not straight:
        return text.joint_moves(
            text.controller_values(moves.joints[rows], slides), words, first_external
        )
    if moves.position is None or moves.rotation is None:
        raise InputError(
            "NO_POSITIONS", "program.motion", "the program has no positions; use `motion: joint`"
        )
    return text.linear_moves(
        text.positions(moves.position[rows]),
        text.quaternions(moves.rotation[rows]),
        text.controller_values(moves.joints[rows, AXES:], slides[AXES:]),
        words,
        first_external,
    )
