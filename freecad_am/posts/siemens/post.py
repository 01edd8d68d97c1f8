# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write SINUMERIK 840D programs of linear blocks for tables and heads with two rotary axes.

Joint motion is written as axis values with the time of each move (G93) or the speed of the linear
axes (G94). Cartesian motion is written as positions and direction vectors of the torch with the
transformation TRAORI. Rapids between beads always use axis values, so that every bead begins with
known turns. Output, controller settings and confirmations: docs/posts/siemens.md.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

import numpy as np

from ...core.controller import Controller
from ...core.issues import InputError
from ...core.program import (
    LINEAR_MOVE,
    ROTARY,
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
from ...core.types import Array
from .. import nc_numbers
from ..catalogue import Naming, controller_checks
from ..parts import Piece, Run, grouped, keep_whole, lines_of, packed, place
from ..refusals import (
    refuse_calls_of_own,
    refuse_cooling,
    refuse_no_process,
    refuse_schedules,
    refuse_triggers,
)
from .read import read
from .words import INSTRUCTIONS

__all__ = ["read", "write"]


_NO_END = 10**9
CONTROLLER = Controller(point_bytes=80)
PENDANT = None  # not for robots
NO_WIRE = ""  # the wire feed can follow the travel speed
NO_WEAVE = "programs of five-axis machines have no weave"
NO_TRIGGER = (
    "programs of five-axis machines switch the deposit between blocks only, not ahead of time"
)
refuse_process = refuse_no_process
NO_SCHEDULE = {"arc": "five-axis machines have no arc instructions"}
LAST_SCHEDULE = 65535
MOVE_LINE = re.compile(rb"N\d+ (?:G9 )?G[01] ")
ON_CONTROLLER = controller_checks(
    "The tool offset has the torch's length, and G500 is the machine's zero",
    "TRAORI matches the machine file, and the work offset matches the remarks in the program",
    "The PLC handles the words that switch the deposit, and the inputs",
    "The feed override is 100 %",
)
# deg; maximum step of a continuous axis, which rotates the shorter way
LARGEST_TURN = 180.0 - 0.001
# highest address extension of H words, highest digital input that the controller reads itself, and
# highest analogue input and output
LAST_OUTPUT, LAST_INPUT, LAST_ANALOGUE = 99, 32, 8

# M words that stop or end a program, change the tool or set the spindle
_TAKEN = frozenset(f"M{n}" for n in (0, 1, 2, 3, 4, 5, 6, 17, 19, 30, 40, 41, 42, 43, 44, 45, 70))
# reserved words that look like names; trials on the controller reveal further words
_RESERVED = INSTRUCTIONS | frozenset(
    (
        "AND",
        "ATRANS",
        "AROT",
        "BRISK",
        "CASE",
        "COMPCAD",
        "COMPCURV",
        "COMPOF",
        "COMPON",
        "DEF",
        "DIV",
        "ELSE",
        "ENDFOR",
    )
    + (
        "ENDIF",
        "ENDLOOP",
        "ENDWHILE",
        "EXTERN",
        "FALSE",
        "FFWOF",
        "FFWON",
        "FGROUP",
        "FOR",
        "GOTO",
        "GOTOB",
        "GOTOF",
        "IF",
    )
    + (
        "LOOP",
        "MCALL",
        "MOD",
        "MSG",
        "NOT",
        "OR",
        "ORIMKS",
        "ORIVECT",
        "ORIWKS",
        "PROC",
        "REPEAT",
        "RET",
        "ROT",
        "SET",
    )
    + (
        "SETMS",
        "SOFT",
        "STOPRE",
        "SUPA",
        "TO",
        "TRAFOOF",
        "TRANS",
        "TRAORI",
        "TRUE",
        "UNTIL",
        "WHILE",
        "XOR",
    )
)
NAMING = Naming(
    str.upper,
    "[A-Z]{2}|_[A-Z]",
    "two letters, or an underscore and a letter",
    longest=24,
    spare=3,
    prefix="AM_",
    reserved=_RESERVED,
)


def write(program: Program) -> dict[str, bytes]:
    """Write the files of a program, name -> content; the same program always gives the same bytes.

    If all points fit into one file, write only the main program NAME.MPF. Otherwise NAME.MPF calls
    NAME01.SPF, NAME02.SPF and so on, each with whole beads. An oversized bead gets its own part.

    Raises InputError: PROGRAM_NAME, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, ENDLESS_STEP, MOVE_TIME,
    MOVE_SPEED, NO_POSITIONS, DEPOSIT_OUTPUT, DEPOSIT_INPUT, WIRE_OUTPUT, UNREACHABLE,
    NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [
        f"; {line}"
        for words in (*program.remarks, *_own_remarks(program))
        for line in nc_numbers.wrapped(words)
    ]
    groups = list(
        grouped(program, nc_numbers.Feeds(program), lambda block: _instructions(program, block))
    )
    part_pieces = packed(groups, program.max_points, _NO_END, keep_whole)
    if len(part_pieces) == 1:
        return {
            f"{name}.MPF": _file(
                [*remarks, *_HEAD, *_modes(program), *_lines(program, part_pieces[0]), "M30"]
            )
        }
    names = NAMING.parts(name, len(part_pieces))
    refuse_calls_of_own(program, {name, *names}, program_name)
    files = {f"{name}.MPF": _file([*remarks, *_HEAD, *names, "M30"])}
    for number, (part_name, entries) in enumerate(zip(names, part_pieces, strict=True), 1):
        lines = [
            f"; part {number} of {len(part_pieces)}",
            *_HEAD,
            *_modes(program),
            *_lines(program, entries),
            "M17",
        ]
        files[f"{part_name}.SPF"] = _file(lines)
    return files


def program_name(name: str, where: str) -> str:
    """Return the name on the controller in upper case.

    Raises InputError PROGRAM_NAME with the reason and a valid proposal.
    """
    return NAMING.checked(name, where)


def refuse_setup(
    motion: str,
    setup: str,
    external: tuple[str, ...] = (),
    carried: tuple[float, ...] | None = None,
) -> None:
    """Reject unsupported set-ups; both motions of five-axis machines are supported.

    Raises InputError UNSUPPORTED_SETUP.
    """
    nc_numbers.refuse_setup("siemens", motion, setup)


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    nc_numbers.refuse_table(program, "siemens")
    nc_numbers.refuse_wire_output(program, LAST_ANALOGUE)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, LAST_ANALOGUE)
    _refuse_schedules(program)
    if not program.nc.deposit_on and not program.dry_run and program.deposit_output > LAST_OUTPUT:
        raise InputError(
            "DEPOSIT_OUTPUT",
            "program.deposit_output",
            "H words have address extensions to {}, not {}; use another output, or "
            "program.nc.deposit_on and deposit_off",
            LAST_OUTPUT,
            program.deposit_output,
        )
    nc_numbers.refuse_words(program, _TAKEN)
    for block in program.blocks:
        if isinstance(block, WaitInput) and block.number > LAST_INPUT:
            raise InputError(
                "DEPOSIT_INPUT",
                "process.between_layers.input",
                "the controller program reads inputs 1 to {}, not {}; choose an input in this "
                "range",
                LAST_INPUT,
                block.number,
            )
    refuse_calls_of_own(program, {program_name(program.name, "name")}, program_name)
    _refuse_continuous_steps(program)


def _refuse_schedules(program: Program) -> None:
    refuse_schedules(program, LAST_OUTPUT, LAST_SCHEDULE)
    switch_word = program.nc.deposit_on or f"H{program.deposit_output}="
    if any(isinstance(block, Schedule) for block in program.blocks) and switch_word.startswith(
        f"H{program.schedule_output}="
    ):
        raise InputError(
            "SCHEDULE",
            "program.schedule.output",
            "H{} switches the deposit; use another H word for schedules",
            program.schedule_output,
        )


def _refuse_continuous_steps(program: Program) -> None:
    """Reject steps of half a turn or more of a continuous axis, because C=DC(...) takes the shorter
    way.
    """
    axes = np.flatnonzero(program.continuous)
    degrees = np.degrees(np.concatenate([run.joints for run in program.moves])[:, axes])
    steps = np.abs(np.diff(degrees, axis=0))
    if (steps > LARGEST_TURN).any():
        move, axis = np.argwhere(steps > LARGEST_TURN)[0]
        run_numbers = np.repeat(np.arange(len(program.moves)), [len(run) for run in program.moves])
        raise InputError(
            "ENDLESS_STEP",
            place(program.moves[run_numbers[move + 1]]),
            "axis {} turns {:.1f} deg in one move, but a continuous axis moves less than 180 deg "
            "per move; add points, or limit the axis",
            program.axis_names[axes[axis]],
            steps[move, axis],
        )


def _own_remarks(program: Program) -> Iterator[str]:
    if program.motion == "cartesian":
        yield f"{_offset(program.user_frame)}: the program origin with the rotary axes at zero, from the table's face"
        if program.carried is not None:
            x, y, z, *angles = program.carried
            yield f"X {x:.4f} Y {y:.4f} Z {z:.4f}, then Z {{}} Y {{}} X {{}} deg (RPY)".format(
                *_rpy(angles)
            )
    for name, continuous in zip(program.axis_names, program.continuous, strict=True):
        if continuous:
            yield f"axis {name} turns without end: a modulo rotary axis"
    if program.dry_run:
        yield "dry run: no deposit"


def _rpy(bryant: Sequence[float]) -> tuple[str, ...]:
    """Convert the rotation Rx Ry Rz to angles, degrees, about Z, the new Y and the new X, as in
    work offsets.
    """
    (sa, sb, sc), (ca, cb, cc) = np.sin(bryant).tolist(), np.cos(bryant).tolist()
    across = math.hypot(cb * cc, ca * sc + sa * sb * cc)
    z, y = math.atan2(ca * sc + sa * sb * cc, cb * cc), math.atan2(ca * sb * cc - sa * sc, across)
    x = math.atan2(sa * cc + ca * sb * sc, ca * cb)
    if across < 1e-9:
        z, x = math.atan2(cb * sc, ca * cc - sa * sb * sc), 0.0
    return tuple(f"{math.degrees(angle) + 0.0:.4f}" for angle in (z, y, x))


_HEAD = ["G17 G710 G40 G90"]
_WIRE = "$A_OUTA[{}]={}"


def _modes(program: Program) -> list[str]:
    """Return the header: zero frame, tool length, smoothing, and the axes of the feed."""
    smooth = ["SOFT FFWON", "G642"] if program.nc.smooth else ["BRISK FFWOF", "G64"]
    path = ["FGROUP(X,Y,Z)"] if program.nc.path_feed or program.motion == "cartesian" else []
    return [f"G500 D{program.tool_frame}", *smooth, *path]


def _instructions(program: Program, block: Block) -> list[str]:
    cartesian = program.motion == "cartesian"
    if isinstance(block, DepositOn):
        wire = (
            []
            if block.wire is None
            else [_WIRE.format(program.nc.wire_output, *nc_numbers.wire(program, [block.wire]))]
        )
        on = [] if program.dry_run else [*wire, _output(program, True), *_dwell(block.lead)]
        return [
            *([_offset(program.user_frame), "TRAORI", "ORIWKS ORIVECT"] if cartesian else []),
            *on,
        ]
    if isinstance(block, DepositOff):
        off = [] if program.dry_run else [*_dwell(block.lead), _output(program, False)]
        return [*off, *(["TRAFOOF", "G500"] if cartesian else [])]
    if isinstance(block, Schedule):
        return [f"H{program.schedule_output}={block.number}"]
    if isinstance(block, LayerStart):
        return [f"; layer {block.layer}"]
    if isinstance(block, Wait):
        return _dwell(block.seconds)
    if isinstance(block, WaitInput):
        return [f"WHILE $A_IN[{block.number}]==0", *_dwell(0.1), "ENDWHILE"]
    if isinstance(block, WaitBelow):
        return [
            f"WHILE $A_INA[{block.number}]>={nc_numbers.level(block.below)}",
            *_dwell(0.1),
            "ENDWHILE",
        ]
    if isinstance(block, Call):
        return [program_name(block.program, block.where), *_HEAD, *_modes(program)]
    raise TypeError(f"no instruction for {block!r}")


def _output(program: Program, on: bool) -> str:
    if program.nc.deposit_on:
        return program.nc.deposit_on if on else program.nc.deposit_off
    return f"H{program.deposit_output}={int(on)}"


def _offset(number: int) -> str:
    """Return the settable work offset: G500 for none, G54 to G57, G505 and higher."""
    return "G500" if number == 0 else f"G{53 + number}" if number <= 4 else f"G{500 + number}"


def _dwell(seconds: float) -> list[str]:
    return nc_numbers.dwell("F", seconds)


def _lines(program: Program, entries: Sequence[Piece]) -> list[str]:
    return lines_of(entries, lambda run: _motion(program, run))


def _motion(program: Program, run: Run) -> list[str]:
    """Return the blocks through all points of a run, with an exact stop where the machine halts."""
    moves, rows = run.moves, slice(run.start, run.stop)
    if moves.interpolation == LINEAR_MOVE:
        assert moves.position is not None and moves.direction is not None
        vector = " ".join(f"{name}=%.{nc_numbers.VECTOR_DECIMALS}f" for name in ("A3", "B3", "C3"))
        values = np.hstack([
            np.round(moves.position[rows], nc_numbers.DECIMALS), np.round(moves.direction[rows], nc_numbers.VECTOR_DECIMALS),
        ])  # fmt: skip
        words = nc_numbers.rows(f"{nc_numbers.template('XYZ')} {vector}", values + 0.0)
    else:
        words = nc_numbers.rows(*_axis_words(program, moves.joints[rows]))
    blocks = nc_numbers.blocks(words, run.words[rows])
    ahead = len(blocks) - len(words)
    for row in np.flatnonzero(moves.stops[rows]).tolist():
        blocks[ahead + row] = f"G9 {blocks[ahead + row]}"
    # a synchronized action of one block takes effect when the block starts, without a stop
    worded = nc_numbers.insert_wire_statements(
        program, moves, blocks, "DO " + _WIRE.format(program.nc.wire_output, "{}")
    )
    # COMPCAD would apply the time and wire feed of one block to all blocks that it merges
    by_speed = all(feed.startswith(nc_numbers.PATH) for feed in run.words[rows])
    if program.nc.compress and by_speed and len(worded) == len(blocks):
        return [blocks[0], "COMPCAD", *blocks[1:], "COMPOF"]
    return worded


def _axis_words(program: Program, joints: Array) -> tuple[str, Array]:
    """Return the format string and the axis values, with continuous axes in [0, 360).

    The controller rotates continuous axes the shorter way.
    """
    values = nc_numbers.controller_values(joints, program.axis_kinds)
    continuous = np.array(program.continuous)
    values[:, continuous] = np.round(values[:, continuous] % 360.0, nc_numbers.DECIMALS) % 360.0
    words = [
        f"{name}=DC(%.{nc_numbers.DECIMALS}f)"
        if end and kind == ROTARY
        else nc_numbers.template([name])
        for name, kind, end in zip(
            program.axis_names, program.axis_kinds, program.continuous, strict=True
        )
    ]
    return " ".join(words), values


def _file(lines: list[str]) -> bytes:
    """Number all lines except remarks."""
    numbered, number = [], 0
    for line in lines:
        if line.startswith(";"):
            numbered.append(line)
            continue
        number += 10
        numbered.append(f"N{number} {line}")
    return ("\n".join(numbered) + "\n").encode("ascii")
