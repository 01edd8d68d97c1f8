# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write KUKA KRL modules of beads in linear moves with the tool on the robot, and rapids to axis
values.

KRL joint moves use whole percents of the axis speeds. Beads are therefore linear moves, whose speed
the controller keeps at the tip. Output, controller settings and confirmations: docs/posts/kuka.md.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from ...core.controller import Controller
from ...core.issues import InputError
from ...core.orientation import MOVING_XYZ, MOVING_ZYX, Pendant
from ...core.program import (
    Block,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Program,
    Schedule,
    Wait,
    WaitInput,
)
from ..catalogue import Naming, controller_checks
from ..parts import Piece, Run, grouped, keep_whole, packed
from ..refusals import (
    refuse_calls_of_own,
    refuse_continuous,
    refuse_cooling,
    refuse_external,
    refuse_incomplete,
    refuse_leads,
    refuse_named_track,
    refuse_names_of_data,
    refuse_no_process,
    refuse_schedules,
    refuse_wire,
    refuse_without_positions,
    refuse_without_speeds,
    switched_ahead,
)
from . import text
from .read import read

__all__ = ["read", "write"]

NO_ANALOGUE = "the documentation does not say whether WAIT FOR polls $ANIN"
CONTROLLER = Controller(
    point_bytes=75, memory_mb=4.0, external=True, positioner="2", arc_moves=True
)
PENDANT = Pendant("KUKA", ("A", "B", "C"), MOVING_ZYX)
NO_WIRE = "KRL sets an analogue output between approximated moves ahead of the motion"
NO_WEAVE = "ArcTech keeps the weave in its weld data, which is made on the pendant, so a weave has no number"
NO_TRIGGER = ""  # a trigger on the move itself can switch the deposit
refuse_process = refuse_no_process
NO_SCHEDULE: dict[str, str] = {}  # all methods of selecting schedules are supported
LAST_OUTPUT, LAST_SCHEDULE = 4096, 255
MOVE_LINE = re.compile(rb"(?:PTP|LIN) \{")
ON_CONTROLLER = controller_checks(
    "BASE_DATA and TOOL_DATA with the numbers in the program match the cell, and the load is set",
    "Joint speeds in the machine file equal 100 % on the controller",
    "The deposit output switches the process, and a stop of the program switches it off",
    "The override is 100 %",
)
AXES = 6
LAST_TOOL, LAST_BASE, LAST_EXTERNAL = 16, 32, 6

_RESERVED = frozenset(
    (
        "AND",
        "ANIN",
        "ANOUT",
        "BAS",
        "BOOL",
        "BRAKE",
        "CASE",
        "CHANNEL",
        "CHAR",
        "CIRC",
        "CONFIRM",
        "CONST",
        "CONTINUE",
    )
    + (
        "DECL",
        "DEF",
        "DEFAULT",
        "DEFDAT",
        "DEFFCT",
        "DELAY",
        "DIGIN",
        "DISTANCE",
        "DO",
        "ELSE",
        "END",
        "ENDDAT",
    )
    + (
        "ENDFCT",
        "ENDFOR",
        "ENDIF",
        "ENDLOOP",
        "ENDSPLINE",
        "ENDSWITCH",
        "ENDWHILE",
        "ENUM",
        "EXIT",
        "EXT",
        "EXTFCT",
    )
    + (
        "FALSE",
        "FOR",
        "FRAME",
        "GLOBAL",
        "GOTO",
        "HALT",
        "IF",
        "IMPORT",
        "INT",
        "INTERRUPT",
        "IS",
        "LIN",
        "LOOP",
        "NOT",
    )
    + (
        "OFF",
        "ON",
        "OR",
        "PATH",
        "POS",
        "PTP",
        "PUBLIC",
        "PULSE",
        "REAL",
        "REPEAT",
        "RESUME",
        "RETURN",
        "SEC",
        "SIGNAL",
    )
    + (
        "SLIN",
        "SPLINE",
        "SPTP",
        "STEP",
        "STRUC",
        "SWITCH",
        "THEN",
        "TO",
        "TRIGGER",
        "TRUE",
        "UNTIL",
        "WAIT",
        "WHEN",
    )
    + ("WHILE", "WITH", "CELL", "SPS", "IR_STOPM")
)
# KRL probably allows 24 characters (unconfirmed), so we use fewer
NAMING = Naming(str, "[A-Za-z]", "a letter", longest=20, spare=4, prefix="am_", reserved=_RESERVED)
_NO_END = (
    10**9
)  # the maximum number of lines in a module is unknown, so modules are split by points


def write(program: Program) -> dict[str, bytes]:
    """Write the modules of a program, file name -> content; the same program always gives the same
    bytes.

    If all points fit into one file, write only NAME.src. Otherwise NAME.src calls NAME01.src,
    NAME02.src and so on. An oversized bead gets its own file. The duration of the first move is not
    used.

    Raises InputError: PROGRAM_NAME, JOINT_DEPOSIT, REMOTE_TCP, UNSUPPORTED_SETUP, UNSUPPORTED_AXES,
    UNSUPPORTED_FRAME, ENDLESS_AXIS, NO_JOINT_SPEED, JOINT_SPEED, MOVE_SPEED, NO_POSITIONS,
    NO_ANALOGUE_INPUT, NO_WIRE_OUTPUT, UNREACHABLE, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [
        line
        for words in ("Robotic AM", *program.remarks, *_own_remarks(program))
        for line in text.remark(words)
    ]
    moved = text.Lines(program)
    groups = list(grouped(program, moved, lambda block: _instructions(program, block)))
    refuse_leads([*switched_ahead(program), *moved.ahead])
    part_groups = packed(groups, program.max_points, _NO_END, keep_whole)
    used = [*([text.SCHEDULE] if _scheduled(program) else []), *text.names(program)]
    refuse_names_of_data(program, {name}, used)
    if len(part_groups) == 1:
        refuse_calls_of_own(program, {name}, program_name)
        return {f"{name}.src": text.module(name, [*remarks, *_body(program, part_groups[0])])}
    names = NAMING.parts(name, len(part_groups))
    refuse_calls_of_own(program, {name, *names}, program_name)
    refuse_names_of_data(program, names, used)
    files = {}
    for number, (part_name, piece_list) in enumerate(zip(names, part_groups, strict=True), 1):
        head = text.remark(f"part {number} of {len(part_groups)}")
        files[f"{part_name}.src"] = text.module(part_name, [*head, *_body(program, piece_list)])
    remarks += text.remark(
        f"{len(part_groups)} parts of {sum(map(len, files.values()))} bytes in all"
    )
    return {
        f"{name}.src": text.module(name, [*remarks, *(f"{part_name}()" for part_name in names)]),
        **files,
    }


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
    """Reject a motion or set-up that this controller does not support.

    Raises InputError UNSUPPORTED_SETUP, REMOTE_TCP or JOINT_DEPOSIT.
    """
    if setup not in ("part-on-robot", "tool-on-robot"):
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post kuka cannot write {}; use another post",
            setup,
        )
    if setup == "part-on-robot":
        raise InputError(
            "REMOTE_TCP",
            "cell.setup",
            "with the part on the robot KRL needs a fixed tool ($IPO_MODE #TCP) for linear "
            "moves, and the documentation does not say whether their points refer to nozzle or "
            "part; use `setup: tool-on-robot`",
        )
    if motion == "joint":
        raise InputError(
            "JOINT_DEPOSIT",
            "program.motion",
            "joint moves of KRL use whole percents of the axis speeds, which changes the speed "
            "along a bead; use `motion: cartesian`",
        )


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    axes = AXES + len(program.external_kinds)
    refuse_incomplete(program, "kuka", axes)
    refuse_external(
        program, LAST_EXTERNAL, "[2-9]|1[0-6]", "the number of its MACHINE_DEF, 2 to 16"
    )
    refuse_named_track(program, "the carrier of the robot base, which has no MACHINE_DEF")
    refuse_wire(program, NO_WIRE)
    refuse_cooling(program, 0, NO_ANALOGUE)
    _refuse_schedules(program)
    for what, number, highest in (
        ("tool_frame", program.tool_frame, LAST_TOOL),
        ("user_frame", program.user_frame, LAST_BASE),
    ):
        if number > highest:
            raise InputError(
                "UNSUPPORTED_FRAME",
                f"program.{what}",
                "the number must be at most {}, not {}; use a smaller number",
                highest,
                number,
            )
    refuse_continuous(program)
    refuse_without_speeds(program, axes)
    refuse_without_positions(program, straight=True)
    for block in program.blocks:
        if isinstance(block, Call):
            program_name(block.program, block.where)


def _refuse_schedules(program: Program) -> None:
    refuse_schedules(program, LAST_OUTPUT - text.BITS + 1, LAST_SCHEDULE)
    text.refuse_post_flow(program)
    schedule_outputs = range(program.schedule_output, program.schedule_output + text.BITS)
    if _scheduled(program) and program.deposit_output in schedule_outputs:
        raise InputError(
            "SCHEDULE",
            "program.schedule.output",
            "$OUT[{}] to $OUT[{}] carry the schedule, but the range includes the output of the "
            "deposit; use other outputs, or another program.deposit_output",
            schedule_outputs[0],
            schedule_outputs[-1],
        )


def _scheduled(program: Program) -> bool:
    return any(isinstance(block, Schedule) for block in program.blocks)


def _own_remarks(program: Program) -> Iterator[str]:
    reference = (
        f", seen from the face of MACHINE_DEF[{program.unit}]" if program.on_positioner else ""
    )
    yield (
        f"BASE_DATA[{program.user_frame}] is the program origin{reference}, TOOL_DATA[{program.tool_frame}] the tip of the"
        " nozzle:"
    )
    for what, six in (("BASE", program.station), ("TOOL", program.carried)):
        if six is not None:
            values = text.frames(np.array([six[:3]]), MOVING_XYZ.rotations(np.array([six[3:]])))[0]
            yield what + "".join(
                f" {axis} {value:.3f}"
                for axis, value in zip("XYZABC", values.tolist(), strict=True)
            )
    for axis in np.flatnonzero(program.slides).tolist():
        stands = (
            f"the base of MACHINE_DEF[{program.unit}]" if program.on_positioner else "BASE_DATA"
        )
        yield (
            f"E{program.first_external + axis - AXES} is the track in mm, which carries $ROBROOT; {stands} stands in the"
            " world"
        )
    yield from text.remarks(program)
    if program.dry_run:
        yield "dry run: no deposit"


def _instructions(program: Program, block: Block) -> list[str]:
    # a wait of 0 s holds the advance run until the robot stops
    output = f"$OUT[{program.deposit_output}]="
    if isinstance(block, (DepositOn, DepositOff)) and block.schedule is not None:
        return [text.after(block), *text.wait(block.lead)]
    if isinstance(block, (DepositOn, DepositOff)) and block.ahead is not None:
        return []  # the previous move switches the deposit
    if isinstance(block, DepositOn):
        return [] if program.dry_run else [_STAND, f"{output}TRUE", *text.wait(block.lead)]
    if isinstance(block, DepositOff):
        return [] if program.dry_run else [_STAND, *text.wait(block.lead), f"{output}FALSE"]
    if isinstance(block, Schedule):
        return [_STAND, f"{text.SCHEDULE}={block.number}"]
    if isinstance(block, LayerStart):
        return [f"; layer {block.layer}"]
    if isinstance(block, Wait):
        return text.wait(block.seconds)
    if isinstance(block, WaitInput):
        return [f"WAIT FOR $IN[{block.number}]==TRUE"]
    if isinstance(block, Call):
        return [_STAND, f"{block.program}()"]
    raise TypeError(f"no instruction for {block!r}")


_STAND = "WAIT SEC 0"


def _body(program: Program, piece_list: Sequence[Piece]) -> list[str]:
    unit, base = f"MACHINE_DEF[{program.unit}]", f"BASE_DATA[{program.user_frame}]"
    coupled = [f"$BASE=EK({unit}.ROOT,{unit}.MECH_TYPE,{base})"] if program.on_positioner else []
    lines = [
        *(text.signal(program.schedule_output) if _scheduled(program) else []),
        "BAS(#INITMOV,0)",
        f"BAS(#BASE,{program.user_frame})",
        *coupled,
        f"BAS(#TOOL,{program.tool_frame})",
        "$IPO_MODE=#BASE",
        "$ORI_TYPE=#VAR",
    ]
    settings: dict[str, str] = {}
    for entry in piece_list:
        lines += (
            text.spoken(entry.words[entry.start : entry.stop], settings)
            if isinstance(entry, Run)
            else entry
        )
        if isinstance(entry, list) and any(line.startswith(text.CALL) for line in entry):
            settings.clear()  # ArcTech leaves unknown settings
    return [*lines, _STAND]
