# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write LinuxCNC programs of linear moves (.ngc) for tables and heads with two rotary axes.

Joint motion is written as axis values with the time of each move (G93) or the speed of the linear
axes (G94), under identity kinematics (M429). Cartesian motion is written as positions on the part
and rotary axis values, under the kinematics of the machine (M428). Rapids between beads always use
axis values. Output, machine configuration and confirmations: docs/posts/linuxcnc.md.
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
from .. import nc_numbers
from ..catalogue import Naming, controller_checks
from ..parts import Piece, Run, grouped, keep_whole, lines_of, packed
from ..refusals import (
    refuse_calls_of_own,
    refuse_cooling,
    refuse_no_process,
    refuse_schedules,
    refuse_triggers,
)
from .read import read

__all__ = ["read", "write"]


NAMING = Naming(str.lower, "[a-z]", "a letter", longest=30, spare=3, prefix="am_")
_NO_END = 10**9
CONTROLLER = Controller(point_bytes=67)
PENDANT = None  # not for robots
NO_WIRE = ""  # the wire feed can follow the travel speed
NO_WEAVE = "programs of five-axis machines have no weave"
NO_TRIGGER = (
    "programs of five-axis machines switch the deposit between blocks only, not ahead of time"
)
refuse_process = refuse_no_process
NO_SCHEDULE = {"arc": "five-axis machines have no arc instructions"}
LAST_SCHEDULE = 65535
MOVE_LINE = re.compile(rb"G[01] ")
ON_CONTROLLER = controller_checks(
    "The tool table has the torch's length, and the kinematics has the machine file's offsets",
    "M428 and M429 switch the kinematics, and the work offset matches the remarks in the program",
    "The digital and analogue pins are connected to the process",
    "The feed override is 100 %",
)
# the pins motion.digital-out, -in and analog-out; HAL counts them from 0
LAST_PIN = 64
# work offset that the program sets to zero for moves in axis values
MACHINE_OFFSET = "G59.3"
OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2")
# the machine stops at the end of every move
EXACT_STOP = "G61.1"
# mm/min or deg/min: the interpreter raises slower moves with a programmed time to 0.1, which would
# be too fast
SLOWEST = 0.2
# s; timeout of an input, after which the program stops for good
LONGEST_WAIT = 10_000_000
# LinuxCNC executes comments of this form
_ACTIVE = re.compile(
    r"(?:abort|debug|error|log\w*|msg|print|probe\w*|py|warning)\s*,", re.IGNORECASE
)
# M words with another meaning
_TAKEN = frozenset(
    {
        f"M{n}"
        for n in (0, 1, 2, 3, 4, 5, 6, 19, 30, *range(48, 54), *range(60, 74), *range(428, 431))
    }
    | {"M98", "M99", "H"}
)


def write(program: Program) -> dict[str, bytes]:
    """Write the files of a program, name -> content; the same program always gives the same bytes.

    If all points fit into one file, write only name.ngc. Otherwise name.ngc calls the subs
    name01.ngc, name02.ngc and so on, each with whole beads. An oversized bead gets its own part.

    Raises InputError: PROGRAM_NAME, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, UNSUPPORTED_FRAME,
    MOVE_TIME, MOVE_SPEED, NO_POSITIONS, NO_TIP_KINEMATICS, DEPOSIT_OUTPUT, DEPOSIT_INPUT,
    DEPOSIT_WORD, WIRE_OUTPUT, UNREACHABLE, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [
        _remark(line)
        for words in (*program.remarks, *_own_remarks(program))
        for line in nc_numbers.wrapped(words)
    ]
    groups = list(
        grouped(
            program, nc_numbers.Feeds(program, SLOWEST), lambda block: _instructions(program, block)
        )
    )
    part_groups = packed(groups, program.max_points, _NO_END, keep_whole)
    if len(part_groups) == 1:
        return {
            f"{name}.ngc": _file(
                [*remarks, *_modes(program), *_lines(program, part_groups[0]), "M2"]
            )
        }
    names = NAMING.parts(name, len(part_groups))
    refuse_calls_of_own(program, {name, *names}, program_name)
    files = {
        f"{name}.ngc": _file(
            [*remarks, *_modes(program), *(f"o<{part_name}> call" for part_name in names), "M2"]
        )
    }
    for number, (part_name, piece_list) in enumerate(zip(names, part_groups, strict=True), 1):
        inside = [
            _remark(f"part {number} of {len(part_groups)}"),
            *_modes(program),
            *_lines(program, piece_list),
        ]
        files[f"{part_name}.ngc"] = _file(
            [f"o<{part_name}> sub", *inside, f"o<{part_name}> endsub", "M2"]
        )
    return files


def program_name(name: str, where: str) -> str:
    """Return the name of file and sub in lower case, which LinuxCNC searches for.

    Raises InputError PROGRAM_NAME with a valid proposal.
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
    nc_numbers.refuse_setup("linuxcnc", motion, setup)
    if carried is not None and motion == "cartesian":
        _refuse_tilt(carried)


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    nc_numbers.refuse_table(program, "linuxcnc")
    nc_numbers.refuse_words(program, _TAKEN)
    nc_numbers.refuse_wire_output(program, LAST_PIN)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, LAST_PIN)
    refuse_schedules(program, LAST_PIN, LAST_SCHEDULE, inside=True)
    scheduled = any(isinstance(block, Schedule) for block in program.blocks)
    fed = any(run.wire is not None for run in program.moves)
    if scheduled and fed and program.schedule_output == program.nc.wire_output:
        raise InputError(
            "SCHEDULE",
            "program.schedule.output",
            "analogue output {} carries the wire feed; use another analogue output for schedules",
            program.schedule_output,
        )
    if not program.nc.deposit_on and not program.dry_run and program.deposit_output > LAST_PIN:
        raise InputError(
            "DEPOSIT_OUTPUT",
            "program.deposit_output",
            "digital outputs are 1 to {} (motion.digital-out-00 is number 1), not {}; choose an "
            "output in this range",
            LAST_PIN,
            program.deposit_output,
        )
    for block in program.blocks:
        if isinstance(block, WaitInput) and block.number > LAST_PIN:
            raise InputError(
                "DEPOSIT_INPUT",
                "process.between_layers.input",
                "digital inputs are 1 to {} (motion.digital-in-00 is number 1), not {}; choose "
                "an input in this range",
                LAST_PIN,
                block.number,
            )
    refuse_calls_of_own(program, {program_name(program.name, "name")}, program_name)
    if program.motion == "cartesian":
        _refuse_cartesian(program)


def _refuse_cartesian(program: Program) -> None:
    if not program.nc.switch_kinematics:
        raise InputError(
            "NO_TIP_KINEMATICS",
            "program.nc.switch_kinematics",
            "positions on the part need the kinematics that M428 selects; set "
            "program.nc.switch_kinematics to true, or use `motion: joint`",
        )
    if not 1 <= program.user_frame <= len(OFFSETS):
        raise InputError(
            "UNSUPPORTED_FRAME",
            "program.user_frame",
            "work offset {} is not available for the part; use 1 to {} (G54 to G59.2; the ninth, "
            "{}, is set to zero for moves of the axes)",
            program.user_frame,
            len(OFFSETS),
            MACHINE_OFFSET,
        )
    if program.carried is not None:
        _refuse_tilt(program.carried)


def _refuse_tilt(carried: tuple[float, ...]) -> None:
    """Raise InputError UNSUPPORTED_FRAME if the program origin, X Y Z RX RY RZ (mm, rad), is tilted
    relative to the table.
    """
    if max(abs(angle) for angle in carried[3:5]) > 1e-9:
        x, y, z, rx, ry, rz = (*carried[:3], *(math.degrees(angle) for angle in carried[3:]))
        raise InputError(
            "UNSUPPORTED_FRAME",
            "program.origin",
            "a work offset of LinuxCNC rotates only about Z, but the part is tilted on the table "
            "by RX {:.4g} and RY {:.4g} deg; enter an upright origin, as cell.platform: [{:.6g}, "
            "{:.6g}, {:.6g}, 0, 0, {:.6g}], or use `motion: joint`",
            rx,
            ry,
            x,
            y,
            z,
            rz + 0.0,
        )


def _own_remarks(program: Program) -> Iterator[str]:
    yield f"tool length of tool {program.tool_frame}; {MACHINE_OFFSET} is set to zero"
    if program.motion == "cartesian":
        yield f"{OFFSETS[program.user_frame - 1]}: the program origin on the table's face with the rotary axes at zero"
        if program.carried is not None:
            x, y, z, _, _, turned = program.carried
            yield f"X {x:.4f} Y {y:.4f} Z {z:.4f} R {math.degrees(turned) + 0.0:.4f}"
    for name, continuous in zip(program.axis_names, program.continuous, strict=True):
        if continuous:
            yield f"axis {name} turns without end: not WRAPPED_ROTARY, limits wide enough for all turns"
    if program.dry_run:
        yield "dry run: no deposit"


def _remark(text: str) -> str:
    """Return a one-line comment that LinuxCNC does not execute."""
    inside = text.replace("(", "[").replace(")", "]")
    return f"(remark: {inside})" if _ACTIVE.match(inside) else f"({inside})"


def _modes(program: Program) -> list[str]:
    """Return the header: mm, absolute, tool length, exact stop, axes in the machine frame."""
    zeros = " ".join(f"{name}0" for name in program.axis_names)
    return [
        "G21 G17 G90 G94 G40 G49 G80", "G92.2", EXACT_STOP, f"G43 H{program.tool_frame}",
        f"G10 L2 P9 {zeros} R0", *_axes_again(program),
    ]  # fmt: skip


def _axes_again(program: Program) -> list[str]:
    return [*(["M429"] if program.nc.switch_kinematics else []), MACHINE_OFFSET]


def _instructions(program: Program, block: Block) -> list[str]:
    cartesian = program.motion == "cartesian"
    if isinstance(block, DepositOn):
        enter = [
            *(["M428", OFFSETS[program.user_frame - 1]] if cartesian else []),
            _through(program),
        ]
        # M68 acts immediately, while the machine stands still
        wire = (
            []
            if block.wire is None
            else [f"M68 {_wire(program).format(*nc_numbers.wire(program, [block.wire]))}"]
        )
        return [
            *enter,
            *(
                ["G4 P0"]
                if program.dry_run
                else [*wire, _output(program, True), *_dwell(block.lead)]
            ),
        ]
    if isinstance(block, DepositOff):
        leave = [EXACT_STOP, *(_axes_again(program) if cartesian else [])]
        return [
            *(["G4 P0"] if program.dry_run else [*_dwell(block.lead), _output(program, False)]),
            *leave,
        ]
    if isinstance(
        block, Schedule
    ):  # immediate at standstill; within a bead queued until the next move starts
        return [f"M6{7 if block.inside else 8} E{program.schedule_output - 1} Q{block.number}"]
    if isinstance(block, LayerStart):
        return [_remark(f"layer {block.layer}")]
    if isinstance(block, Wait):
        return _dwell(block.seconds)
    if isinstance(block, WaitInput):
        return [f"M66 P{block.number - 1} L3 Q{LONGEST_WAIT}"]
    if isinstance(block, WaitBelow):  # M66 only reads an analogue input into #5399
        sample, loop = f"M66 E{block.number - 1} L0", f"o<cool{block.layer}_{block.bead}>"
        return [
            sample,
            f"{loop} while [#5399 GE {nc_numbers.level(block.below)}]",
            *_dwell(0.1),
            sample,
            f"{loop} endwhile",
        ]
    if isinstance(block, Call):
        return [f"o<{program_name(block.program, block.where)}> call", *_modes(program)]
    raise TypeError(f"no instruction for {block!r}")


def _output(program: Program, on: bool) -> str:
    """Return the command that switches the deposit immediately.

    The command is not queued: it waits for the end of the motion, so the machine stops before the
    deposit switches.
    """
    if program.nc.deposit_on:
        return program.nc.deposit_on if on else program.nc.deposit_off
    return f"M{64 if on else 65} P{program.deposit_output - 1}"


def _through(program: Program) -> str:
    """Return the command that starts corner rounding within the tolerance."""
    return f"G64 P{program.nc.tolerance:.5f} Q{program.nc.tolerance:.5f}"


def _wire(program: Program) -> str:
    """Return the format string of the statement that sets the analogue output."""
    return f"E{program.nc.wire_output - 1} Q{{}}"


def _dwell(seconds: float) -> list[str]:
    return nc_numbers.dwell("P", seconds)


def _lines(program: Program, piece_list: Sequence[Piece]) -> list[str]:
    return lines_of(piece_list, lambda run: _motion(program, run))


def _motion(program: Program, run: Run) -> list[str]:
    """Return the moves through all points of a run. The line after a run waits for its end."""
    moves, rows = run.moves, slice(run.start, run.stop)
    names = list(program.axis_names)
    values = nc_numbers.controller_values(moves.joints[rows], program.axis_kinds)
    if moves.interpolation == LINEAR_MOVE:
        assert moves.position is not None
        rotary = np.array([kind == ROTARY for kind in program.axis_kinds])
        values = np.hstack(
            [np.round(moves.position[rows], nc_numbers.DECIMALS) + 0.0, values[:, rotary]]
        )
        names = [
            *"XYZ",
            *(name for name, turns in zip(names, rotary.tolist(), strict=True) if turns),
        ]
    blocks = nc_numbers.blocks(nc_numbers.rows(nc_numbers.template(names), values), run.words[rows])
    ahead = len(blocks) - len(values)
    for row in np.flatnonzero(moves.halt[rows]).tolist():
        blocks[ahead + row] = f"{EXACT_STOP}\n{blocks[ahead + row]}\n{_through(program)}"
    # M67 is queued until the next move starts, so corners stay rounded
    text = nc_numbers.insert_wire_statements(program, moves, blocks, f"M67 {_wire(program)}")
    return [line for block in text for line in block.split("\n")]


def _file(lines: list[str]) -> bytes:
    return ("\n".join(lines) + "\n").encode("ascii")
