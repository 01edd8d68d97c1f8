# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write Yaskawa INFORM jobs (.JBI) of joint moves, or of beads in linear moves with the tool on the
robot, with positions in pulses.

In both cases rapids are joint moves that stop at every point. Pulses need no controller option and
define the arm's configuration and turns. Pulses per degree depend on the robot and come from the
machine file. Output, controller settings and confirmations: docs/posts/yaskawa.md.
"""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterator, Sequence

import numpy as np

from ...core.controller import Controller
from ...core.issues import InputError, Text, Word
from ...core.orientation import FIXED_XYZ, Pendant
from ...core.program import (
    DEPOSIT,
    FIRST_SHARE,
    LINEAR_MOVE,
    ROTARY,
    Block,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Schedule,
    Wait,
    WaitInput,
    Weave,
)
from ...core.types import Array, Integers
from ..catalogue import Naming, controller_checks, plain
from ..parts import Piece, Run, continued, grouped, packed, place
from ..refusals import (
    refuse_calls_of_own,
    refuse_continuous,
    refuse_cooling,
    refuse_external,
    refuse_incomplete,
    refuse_named_track,
    refuse_no_process,
    refuse_schedules,
    refuse_triggers,
    refuse_weave,
    refuse_wire,
    refuse_without_speeds,
)
from .read import read

AXES, BASE = "SLURBT", "BS1"  # robot axes, and the motion group of the track that carries the robot
END_OF_LINE = "\r\n"


def pulses(program: Program, joints: Array) -> Integers:
    """Convert joint values to whole pulses.

    Parameters
    ----------
    program : Program
        The program, with the pulses per degree, or per mm of a track.
    joints : (n, axes) array
        Controller joint values, rad, and mm of a track.

    Returns
    -------
    (n, axes) array of int
        Pulses.
    """
    values = np.where(program.slides, joints, np.degrees(joints))
    counts: Integers = np.rint(values * np.array(program.pulses_per_degree)).astype(np.int64)
    return counts


def job(program: Program, name: str, head: Sequence[str], entries: Sequence[Piece]) -> bytes:
    """Return a complete file.

    Parameters
    ----------
    program : Program
        The program.
    name : str
        Name of the job.
    head : sequence of str
        Lines before the first instruction.
    entries : sequence of Piece
        Moves and instructions in order.

    Returns
    -------
    bytes
        The content of the file.
    """
    runs = [entry for entry in entries if isinstance(entry, Run)]
    texts = [pulses(program, run.moves.joints[run.start : run.stop]) for run in runs]
    rows = np.concatenate(texts) if texts else np.zeros((0, len(program.slides)), dtype=np.int64)
    turning = ~program.slides[len(AXES) :]
    columns = {
        "C": rows[:, : len(AXES)],
        "BC": rows[:, program.slides],
        "EC": rows[:, len(AXES) :][:, turning],
    }
    columns = {letters: values for letters, values in columns.items() if values.size}
    positions = [f"///TOOL {program.tool_frame}", "///POSTYPE PULSE", "///PULSE"] if columns else []
    positions += [
        f"{letters}{number:05d}={','.join(map(str, row))}"
        for letters, values in columns.items()
        for number, row in enumerate(values.tolist())
    ]
    lines, point = ["NOP", *head], 0
    for entry in entries:
        if isinstance(entry, Run):
            letter = "L" if entry.moves.interpolation == LINEAR_MOVE else "J"
            words = entry.words[entry.start : entry.stop]
            numbers = [f"{point + k:05d}" for k in range(len(words))]
            named = [
                " ".join(f"{letters}{number_text}" for letters in columns)
                for number_text in numbers
            ]
            lines += [f"MOV{letter} {text} {word}" for text, word in zip(named, words, strict=True)]
            point += len(entry)
        else:
            lines += entry
    group = ",".join(
        [
            "///GROUP1 RB1",
            *([BASE] if program.on_track else []),
            *([program.unit] if program.unit else []),
        ]
    )
    count = ",".join(str(len(columns.get(letters, ()))) for letters in ("C", "BC", "EC"))
    text = [
        "/JOB", f"//NAME {name}", "//POS", f"///NPOS {count},0,0,0", *positions, "//INST",
        "///DATE 2000/01/01 00:00", "///COMM Robotic AM", "///ATTR SC,RW", group, *lines, "END",
    ]  # fmt: skip
    return (END_OF_LINE.join(text) + END_OF_LINE).encode("ascii")


__all__ = ["read", "write"]

NO_ANALOGUE = "the instruction that waits for an analogue input depends on options of the controller, which the post yaskawa does not know"
CONTROLLER = Controller(point_bytes=75, external=True, positioner="ST1", pulses=True)
PENDANT = Pendant("Yaskawa", ("Rx", "Ry", "Rz"), FIXED_XYZ)
NO_WIRE = "INFORM sets AOUT between two moves when the controller reaches the line, and rounded corners shift that moment"
NO_WEAVE = ""  # linear moves can be woven
NO_TRIGGER = "INFORM has no confirmed way to switch an output ahead of a point"
refuse_process = refuse_no_process
LAST_WEAVE = 255  # highest number of weaving condition files
NO_SCHEDULE: dict[str, str] = {}  # all methods of selecting schedules are supported
LAST_GROUP, LAST_SCHEDULE, LAST_FILE = (
    512,
    255,
    1000,
)  # groups of eight outputs, schedules, and arc condition files
MOVE_LINE = re.compile(rb"MOV[JL] ")
ON_CONTROLLER = controller_checks(
    "Pulses per degree in the machine file match the controller, and zero pulses are zero degrees",
    "VJ is a share of the maximum speed, in the machine file, of the slowest axis of a move",
    "The tool file with the number in the job holds the nozzle tip, and speeds have the unit in "
    "the remarks",
    "The deposit output switches the process",
)
MOST_EXTERNAL = 6
MOST_LINES = 9999
OUTPUTS = 4096
LONGEST_WAIT = 600.0  # s; longest wait of one TIMER
# percent of the maximum joint speed: resolution, and minimum in a bead (accurate to 10 %)
STEP_PERCENT, LEAST_PERCENT = 0.01, 0.05
LEVELS = 8  # number of corner-rounding levels
# path speed units in mm/s, and their decimals
UNITS = {"mm/s": (1.0, 1), "cm/min": (1.0 / 6.0, 0), "mm/min": (1.0 / 60.0, 0)}
FASTEST = 1500.0  # mm/s
_COMMENT = 32
# older controllers allow at most 8 characters in names
NAMING = Naming(str.upper, "[A-Z]", "a letter", longest=32, spare=4, prefix="AM_")


def write(program: Program) -> dict[str, bytes]:
    """Write the jobs of a program, file name -> content; the same program always gives the same
    bytes.

    If the program fits, write one job. Otherwise NAME.JBI calls NAME01.JBI and so on. Jobs are
    split between beads; only an oversized bead is split between its moves. The duration of the
    first move is not used.

    Raises InputError: PROGRAM_NAME, REMOTE_TCP, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, ENDLESS_AXIS,
    NO_PULSES, NO_SPEED_UNIT, NO_JOINT_SPEED, JOINT_SPEED, MOVE_SPEED, DEPOSIT_OUTPUT,
    NO_WIRE_OUTPUT, NO_ANALOGUE_INPUT, UNREACHABLE, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    words = _Words(program)
    groups = list(grouped(program, words, lambda block: _instructions(program, block)))
    remarks = [
        line
        for text in (*program.remarks, *_own_remarks(program, words.off))
        for line in _remark(text)
    ]
    meaning = [line for text in _meaning(program) for line in _remark(text)]
    max_lines = MOST_LINES - len(remarks) - len(meaning) - 2  # NOP and END
    part_pieces = packed(
        groups, min(program.max_points, max_lines), max_lines, continued(_remark, program.woven)
    )
    if len(part_pieces) == 1:
        refuse_calls_of_own(program, {name}, program_name)
        return {f"{name}.JBI": job(program, name, [*remarks, *meaning], part_pieces[0])}
    names = NAMING.parts(name, len(part_pieces))
    refuse_calls_of_own(program, {name, *names}, program_name)
    header = [
        *remarks,
        *_remark(f"{sum(len(run) for run in program.moves)} moves in {len(names)} parts"),
    ]
    files = {
        f"{name}.JBI": job(
            program, name, [*header, *(f"CALL JOB:{part_name}" for part_name in names)], []
        )
    }
    for number, (part_name, entries) in enumerate(zip(names, part_pieces, strict=True), 1):
        head = [*_remark(f"part {number} of {len(part_pieces)}"), *meaning]
        files[f"{part_name}.JBI"] = job(program, part_name, head, entries)
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
    """Reject a set-up that this controller does not support.

    Raises InputError REMOTE_TCP, UNSUPPORTED_SETUP or COORDINATED_MOTION.
    """
    if motion == "cartesian" and setup == "part-on-robot":
        raise InputError(
            "REMOTE_TCP",
            "program.motion",
            "linear moves at the speed of a fixed nozzle over a part on the robot need the "
            "external reference point of the controller, whose instruction is not documented "
            "well enough; use `motion: joint`",
        )
    if setup not in ("part-on-robot", "tool-on-robot"):
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post yaskawa cannot write {}; use another post",
            setup,
        )
    if external:
        _refuse_coordinated(motion, external)


def _refuse_coordinated(motion: str, external: tuple[str, ...]) -> None:
    """Raise InputError COORDINATED_MOTION for Cartesian motion with external axes of the given
    kinds.
    """
    if motion != "cartesian":
        return
    why = "of a robot on a track also move the base axis, and their speed may include this motion"
    if ROTARY in external:
        why = "over a part on a positioner need coordinated motion (SMOVL), whose speed is not documented"
    raise InputError(
        "COORDINATED_MOTION",
        "program.motion",
        "linear moves {}; use `motion: joint`, which keeps the speed by shares of the joint speeds",
        Word(why),
    )


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    axes = len(AXES) + len(program.external_kinds)
    refuse_incomplete(program, "yaskawa", axes)
    if program.external_kinds:
        _refuse_coordinated(program.motion, program.external_kinds)
        refuse_external(
            program, MOST_EXTERNAL, r"ST[1-9]\d?", "the name of its station, such as ST1"
        )
        refuse_named_track(program, Text("the base axis {} of the robot", BASE))
        if program.first_external != 1:
            raise InputError(
                "UNSUPPORTED_AXES",
                "program.axes.first",
                "positions of a station or of base axes begin with the first axis; use 1, not {}",
                program.first_external,
            )
    refuse_wire(program, NO_WIRE)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, 0, NO_ANALOGUE)
    refuse_schedules(program, LAST_GROUP, LAST_SCHEDULE, LAST_FILE)
    refuse_weave(program, LAST_WEAVE)
    refuse_continuous(program)
    if len(program.pulses_per_degree) != axes:
        raise InputError(
            "NO_PULSES",
            "cell.machine",
            "the machine file has no controller.pulses_per_degree; add the pulses per degree",
        )
    if program.motion == "cartesian" and program.speed_unit not in UNITS:
        raise InputError(
            "NO_SPEED_UNIT",
            "cell.machine",
            "the machine file has no controller.speed_unit; add the unit",
        )
    refuse_without_speeds(program, axes)
    if not program.dry_run and program.deposit_output > OUTPUTS:
        raise InputError(
            "DEPOSIT_OUTPUT",
            "program.deposit_output",
            "digital outputs are 1 to {}, not {}; choose an output in this range",
            OUTPUTS,
            program.deposit_output,
        )


def _own_remarks(program: Program, off: float) -> Iterator[str]:
    if off > 0.0:
        yield f"VJ has steps of {STEP_PERCENT} %: speed of beads is right to {100.0 * off:.1f} %"
    if program.dry_run:
        yield "dry run: no deposit"


def _meaning(program: Program) -> Iterator[str]:
    """Yield the units of pulses and speeds, which the job's words do not state."""
    external = [f"E{number + 1}" for number in range(len(program.external_kinds))]
    for axis, slides, count in zip(
        [*AXES, *external], program.slides.tolist(), program.pulses_per_degree, strict=True
    ):
        yield f"pulses/{'mm' if slides else 'deg'} {axis} {count!r}"
    if program.motion == "cartesian":
        yield f"V in {program.speed_unit}"


def _remark(text: str) -> list[str]:
    """Wrap a comment to the width of comment lines."""
    return [f"'{line}" for line in textwrap.wrap(plain(text), _COMMENT)]


class _Words:
    """Build the words after the position of each move, in the order of motion.

    off: maximum relative speed error of joint moves in beads, due to the resolution of VJ.
    """

    def __init__(self, program: Program) -> None:
        self.program, self.off = program, 0.0
        self.before: Array | None = None
        self.level = math.ceil(0.01 * LEVELS * program.blend)

    def __call__(self, moves: Moves) -> Sequence[str]:
        values = pulses(self.program, moves.joints) / np.array(self.program.pulses_per_degree)
        displayed = np.where(self.program.slides, values, np.radians(values))
        start = displayed[:1] if self.before is None else self.before
        if moves.interpolation == LINEAR_MOVE:
            speeds = _path_speeds(self.program, moves)
        else:
            percent = _percent(
                self.program, moves, np.diff(displayed, axis=0, prepend=start), self.before is None
            )
            speeds = [f"VJ={share:.2f}" for share in percent.tolist()]
            if moves.kind == DEPOSIT:
                self.off = max(self.off, float(np.abs(np.round(percent, 2) / percent - 1.0).max()))
        self.before = displayed[-1:]
        levels = np.where(moves.stops, 0, self.level).tolist()
        return [f"{speed} PL={level}" for speed, level in zip(speeds, levels, strict=True)]


def _percent(program: Program, moves: Moves, steps: Array, is_first: bool) -> Array:
    """Return the percent (n,) of the maximum joint speeds that give the moves their planned times."""
    share = (np.abs(steps) / np.array(program.max_speed)).max(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        percent = 100.0 * share / moves.duration
    wrong = (share > 0.0) & ~(percent <= 100.0 + 0.5 * STEP_PERCENT)
    if moves.kind == DEPOSIT:
        wrong |= percent < LEAST_PERCENT
    if is_first:
        wrong[0] = False
    if wrong.any():
        raise InputError(
            "JOINT_SPEED",
            place(moves),
            "a move would need {:.4g} % of the largest joint speed, which is programmed in steps "
            "of {} %; use a speed that gives {} to 100 %",
            percent[wrong][0],
            STEP_PERCENT,
            LEAST_PERCENT,
        )
    percent = np.where(share > 0.0, np.clip(percent, STEP_PERCENT, 100.0), 100.0)
    if is_first:
        percent[0] = 100.0 * FIRST_SHARE
    return np.asarray(percent, dtype=np.float64)


def _path_speeds(program: Program, moves: Moves) -> list[str]:
    unit, decimals = UNITS[program.speed_unit]
    min_speed = 10.0**-decimals * unit
    fits = (moves.speed >= min_speed) & (moves.speed <= FASTEST)
    if not fits.all():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written in {}; use {:.3g} to {:.0f} mm/s",
            moves.speed[~fits][0],
            program.speed_unit,
            min_speed,
            FASTEST,
        )
    return [f"V={speed:.{decimals}f}" for speed in (moves.speed / unit).tolist()]


def _instructions(program: Program, block: Block) -> list[str]:
    output = f"DOUT OT#({program.deposit_output})"
    if isinstance(block, (DepositOn, DepositOff)):
        word, arc = ("ON", "ARCON ASF") if isinstance(block, DepositOn) else ("OFF", "ARCOF AEF")
        lines = [
            f"{output} {word}" if block.schedule is None else f"{arc}#({block.schedule})",
            *_timer(block.lead),
        ]
        return [] if program.dry_run else lines if word == "ON" else [*lines[1:], lines[0]]
    if isinstance(block, Schedule):
        return [f"DOUT OG#({program.schedule_output}) {block.number}"]
    if isinstance(block, Weave):
        return [f"WVON WEV#({block.number})" if block.number else "WVOF"]
    if isinstance(block, LayerStart):
        return _remark(f"layer {block.layer}")
    if isinstance(block, Wait):
        return _timer(block.seconds)
    if isinstance(block, WaitInput):
        return [f"WAIT IN#({block.number})=ON"]
    if isinstance(block, Call):
        return [f"CALL JOB:{program_name(block.program, block.where)}"]
    raise TypeError(f"no instruction for {block!r}")


def _timer(seconds: float) -> list[str]:
    """Return the lines of a wait, to 0.01 s; empty for 0 s."""
    hundredths = max(round(100.0 * seconds), int(seconds > 0.0))
    max_hundredths = round(100.0 * LONGEST_WAIT)
    full_waits, remainder = divmod(hundredths, max_hundredths)
    return [
        f"TIMER T={step / 100.0:.2f}"
        for step in (*(max_hundredths,) * full_waits, remainder)
        if step
    ]
