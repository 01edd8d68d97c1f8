# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write FANUC TP listings (.LS) of joint moves by time, or of beads in linear moves with the tool
on the robot.

In both cases rapids are joint moves that stop at every point. Output, controller settings and
confirmations: docs/posts/fanuc.md.
"""

from __future__ import annotations

import dataclasses
import math
import re
import textwrap
import unicodedata
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ...core.controller import Controller
from ...core.issues import InputError, Text, Word
from ...core.orientation import FIXED_XYZ, Pendant
from ...core.program import (
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
    WaitBelow,
    WaitInput,
    Weave,
)
from ...core.types import Array
from ..catalogue import Naming, controller_checks
from ..parts import Piece, Run, continued, grouped, packed, switching
from ..refusals import (
    Ahead,
    refuse_calls_of_own,
    refuse_cooling,
    refuse_external,
    refuse_incomplete,
    refuse_leads,
    refuse_named_track,
    refuse_no_process,
    refuse_schedules,
    refuse_weave,
    refuse_wire,
    switched_ahead,
)
from . import records
from .read import read

DECIMALS = 2  # decimals of the time before the end of a move, s


def at_ends(program: Program) -> dict[int, str]:
    """Return the options of the last moves of runs, with a leading space, by the id of the moves."""
    if program.dry_run:
        return {}
    output = program.deposit_output
    return {
        id(
            moves
        ): f" {_ahead(block.ahead)},DO[{output}]={'ON' if isinstance(block, DepositOn) else 'OFF'}"
        for moves, block in switching(program)
        if block.ahead is not None
    }


def as_written(program: Program) -> list[Ahead]:
    """Return the switches during motion with their leads as the listing rounds them: up to 5 ms
    longer than requested.
    """
    steps = 10**DECIMALS
    return [
        dataclasses.replace(ahead, lead=round(ahead.lead, DECIMALS), steps=steps)
        for ahead in switched_ahead(program)
    ]


def _ahead(seconds: float) -> str:
    """Return the lead, to 0.01 s, at the width that controllers write: TB    .05sec."""
    return f"TB{right_aligned(round(seconds, DECIMALS), DECIMALS, 7)}sec"


__all__ = ["read", "write"]


LAST_ANALOGUE = 25  # number of analogue inputs
CONTROLLER = Controller(point_bytes=205, external=True, positioner="2")
PENDANT = Pendant("FANUC", ("W", "P", "R"), FIXED_XYZ)
NO_WIRE = (
    "FANUC sets AO[] between two moves when the controller reads the line, ahead of the motion"
)
NO_WEAVE = ""  # linear moves can be woven
NO_TRIGGER = ""  # the deposit can be switched on the move itself
refuse_process = refuse_no_process
LAST_WEAVE = 255  # highest number of weave schedules
NO_SCHEDULE: dict[str, str] = {}  # all methods of selecting schedules are supported
LAST_GROUP, LAST_SCHEDULE = 400, 32767  # group outputs
MOVE_LINE = re.compile(rb" *\d+:[JL] P\[")
ON_CONTROLLER = controller_checks(
    "UFRAME and UTOOL with the numbers in the program match the cell",
    "Joint values, above all J3, have the meaning in the machine file",
    "An axis without limits has the Continuous Turn option",
    "Payload is set and the override is 100 %",
    "The deposit output switches the process",
)
AXES = 6
MOST_LINES = 9999

_FIRST_MOVE = f"{100.0 * FIRST_SHARE:.0f}%"

# reserved words of listings
_RESERVED = frozenset(
    (
        "ABORT",
        "CALL",
        "DI",
        "DO",
        "ELSE",
        "END",
        "ENDFOR",
        "ENDIF",
        "FOR",
        "IF",
        "JMP",
        "LBL",
        "MESSAGE",
        "MONITOR",
    )
    + ("PAUSE", "RUN", "SELECT", "THEN", "WAIT", "WHEN")
)
# older controllers allow at most 8 characters in names
NAMING = Naming(
    str.upper, "[A-Z]", "a letter", longest=36, spare=4, prefix="AM_", reserved=_RESERVED
)


def write(program: Program) -> dict[str, bytes]:
    """Write the listings of a program, file name -> content; the same program always gives the same
    bytes.

    If the program fits, write one file. Otherwise NAME.LS calls NAME01.LS and so on. Files are
    split between beads; only an oversized bead is split between its moves. The duration of the
    first move is not used.

    Raises InputError: PROGRAM_NAME, REMOTE_TCP, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, MOVE_TIME,
    MOVE_SPEED, ENDLESS_STEP, TURN_NUMBER, NO_WIRE_OUTPUT, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [
        line for words in (*program.remarks, *_own_remarks(program)) for line in remark(words)
    ]
    head = [f"  UFRAME_NUM={program.user_frame} ;", f"  UTOOL_NUM={program.tool_frame} ;"]
    groups = list(grouped(program, _words(program), lambda block: _instructions(program, block)))
    part_groups = packed(
        groups,
        program.max_points,
        MOST_LINES - len(head) - len(remarks),
        continued(remark, program.woven),
    )
    if len(part_groups) == 1:
        refuse_calls_of_own(program, {name}, program_name)
        return {f"{name}.LS": _file(program, name, "Robotic AM", head + remarks, part_groups[0])}
    names = NAMING.parts(name, len(part_groups))
    calling = head + remarks + [call(part_name) for part_name in names]
    files = {f"{name}.LS": listing(name, "Robotic AM", calling, "", _group(program))}
    for number, (part_name, piece_list) in enumerate(zip(names, part_groups, strict=True), 1):
        comment = f"part {number} of {len(part_groups)}"
        files[f"{part_name}.LS"] = _file(program, part_name, comment, head, piece_list)
    refuse_calls_of_own(program, {*names, name}, program_name)
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
            "Cartesian motion with the part on the robot needs remote TCP, whose position "
            "records (RX RY RZ RW RP RR) are not documented well enough; use `motion: joint`",
        )
    if setup not in ("part-on-robot", "tool-on-robot"):
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post fanuc cannot write {}; use another post",
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
    why = (
        (
            "linear moves over a part on a positioner need coordinated motion (COORD), and the user frame of its positions is not documented"
        )
        if ROTARY in external
        else (
            "the speed of linear moves may include the motion of the track, depending on the setup of the rail"
        )
    )
    raise InputError(
        "COORDINATED_MOTION",
        "program.motion",
        "{}; use `motion: joint`, which keeps the speed by times",
        Word(why),
    )


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    refuse_incomplete(program, "fanuc", AXES + len(program.external_kinds))
    refuse_external(
        program,
        len(program.external_kinds),
        f"[2-{GROUPS}]",
        Text("its motion group, 2 to {}", GROUPS),
    )
    if program.external_kinds:
        _refuse_coordinated(program.motion, program.external_kinds)
    refuse_named_track(program, "E1 of the motion group of the robot")
    refuse_wire(program, NO_WIRE)
    refuse_cooling(program, LAST_ANALOGUE)
    refuse_leads(as_written(program))
    refuse_schedules(program, LAST_GROUP, LAST_SCHEDULE)
    refuse_weave(program, LAST_WEAVE)
    for block in program.blocks:
        if isinstance(block, Call):
            program_name(block.program, block.where)
        if isinstance(block, WaitBelow) and block.below != round(block.below):
            raise InputError(
                "ANALOGUE_INPUT",
                "process.cooling",
                "analogue inputs are whole numbers, not {:.9g}; change below, gain or zero "
                "accordingly",
                block.below,
            )
    _refuse_continuous_steps(program)


def _refuse_continuous_steps(program: Program) -> None:
    """Reject steps of half a turn or more, because a continuous axis would rotate the shorter way."""
    axes = np.flatnonzero(program.continuous)
    joints = np.concatenate([run.joints for run in program.moves])[:, axes]
    run_numbers = np.repeat(np.arange(len(program.moves)), [len(run) for run in program.moves])
    large = np.abs(np.diff(joints, axis=0)) > math.radians(180.0 - 0.001)
    if large.any():
        move, axis = np.argwhere(large)[0]
        run = program.moves[run_numbers[move + 1]]
        turn = math.degrees(joints[move + 1, axis] - joints[move, axis])
        raise InputError(
            "ENDLESS_STEP",
            Text("layer {} bead {}", run.layer, run.bead),
            "axis {} turns {:.1f} deg in one move, but a continuous axis moves less than 180 deg "
            "per move; add points, or limit the axis",
            axes[axis] + 1,
            turn,
        )


def _own_remarks(program: Program) -> Iterator[str]:
    for axis in np.flatnonzero(program.slides).tolist():
        yield f"E1 is the track e{axis - AXES + 1}"
    for axis in np.flatnonzero(program.continuous):
        yield f"axis {axis + 1} turns without end: set it up for Continuous Turn (option)"
    if program.dry_run:
        yield "dry run: no deposit"


def _words(program: Program) -> Callable[[Moves], Sequence[str]]:
    """Return a function that builds the words after the positions of moves; call it in the order of
    motion.
    """
    is_first, options = True, at_ends(program)

    def words(moves: Moves) -> Sequence[str]:
        nonlocal is_first
        speeds = (
            records.speed_words(moves)
            if moves.interpolation == LINEAR_MOVE
            else records.time_words(moves)
        )
        if is_first:
            speeds[0], is_first = _FIRST_MOVE, False
        corners = ["FINE" if stops else f"CNT{program.blend}" for stops in moves.stops.tolist()]
        words = [f"{speed} {corner}" for speed, corner in zip(speeds, corners, strict=True)]
        words[-1] += options.get(id(moves), "")
        return words

    return words


def _instructions(program: Program, block: Block) -> list[str]:
    output = f"  DO[{program.deposit_output}]="
    if isinstance(block, (DepositOn, DepositOff)) and block.ahead is not None:
        return []  # an option of the previous move switches the deposit: at_ends
    if isinstance(block, DepositOn):
        on = output + "ON ;" if block.schedule is None else arc("Start", block.schedule)
        return [] if program.dry_run else [on, *wait(block.lead)]
    if isinstance(block, DepositOff):
        off = output + "OFF ;" if block.schedule is None else arc("End", block.schedule)
        return [] if program.dry_run else [*wait(block.lead), off]
    if isinstance(block, Schedule):
        return [f"  GO[{program.schedule_output}]={block.number} ;"]
    if isinstance(block, Weave):
        return [weave(block.number)]
    if isinstance(block, LayerStart):
        return remark(f"layer {block.layer}")
    if isinstance(block, Wait):
        return wait(block.seconds)
    if isinstance(block, WaitInput):
        return [f"  WAIT DI[{block.number}]=ON    ;"]
    if isinstance(block, WaitBelow):
        return [f"  WAIT AI[{block.number}]<{block.below:.0f}    ;"]
    if isinstance(block, Call):
        return [call(block.program.upper())]
    raise TypeError(f"no instruction for {block!r}")


def _file(
    program: Program, name: str, comment: str, head: list[str], piece_list: Sequence[Piece]
) -> bytes:
    lines, point = list(head), 0
    runs = [entry for entry in piece_list if isinstance(entry, Run)]
    for entry in piece_list:
        if isinstance(entry, Run):
            lines += _motion_lines(entry, point)
            point += len(entry)
        else:
            lines += entry
    return listing(name, comment, lines, _record_text(program, runs), _group(program))


def _group(program: Program) -> int:
    """Return the motion group of the axes that carry the part, or of the robot without such axes."""
    return int(program.unit) if program.on_positioner else 1


def _motion_lines(run: Run, points_before: int) -> list[str]:
    """Return the lines through all points of a run."""
    letter = "L" if run.moves.interpolation == LINEAR_MOVE else "J"
    words = run.words[run.start : run.stop]
    return [f"{letter} P[{n}] {word}    ;" for n, word in enumerate(words, points_before + 1)]


def _record_text(program: Program, runs: Sequence[Run]) -> str:
    if not runs:
        return ""
    if program.motion == "joint":
        joints = np.concatenate([run.moves.joints[run.start : run.stop] for run in runs])
        slides, continuous = program.slides, np.array(program.continuous)
        values = np.round(np.where(slides, joints, np.degrees(joints)), 3)
        values[:, continuous] = records.within_half_turn(values[:, continuous])
        values += 0.0
        return joint_records(
            values[:, :AXES],
            values[:, slides],
            values[:, AXES:][:, ~slides[AXES:]],
            program.user_frame,
            program.tool_frame,
            _group(program),
        )
    poses, configuration = [], []
    for run in runs:
        moves, rows = run.moves, slice(run.start, run.stop)
        if moves.position is None or moves.rotation is None:
            raise InputError(
                "NO_POSITIONS",
                "program.motion",
                "the program has no positions; use `motion: joint`",
            )
        poses.append(records.poses(moves.position[rows], moves.rotation[rows]))
        configuration += records.configurations(moves, program.continuous)[rows]
    return pose_records(
        np.concatenate(poses), configuration, program.user_frame, program.tool_frame
    )


# ---- Listing text (.LS): header, instructions, position records, as a controller exports them
#
# Field widths and line ends follow listings that controllers wrote; docs/posts/fanuc.md says which
# rules were confirmed where.

END_OF_LINE = "\r\n"
REMARK_WIDTH = 32
COMMENT_WIDTH = 16
GROUPS = 5  # number of motion groups in the header

# A fixed date gives the same bytes for the same job; the controller sets the true date when it
# loads the file. This day is valid as a two-digit year and on the controller's memory card, whose
# dates begin in 1980.
_DATE = "DATE 00-01-01  TIME 00:00:00"

_HEADER = """\
/PROG  {name}
/ATTR
OWNER\t\t= MNEDITOR;
COMMENT\t\t= "{comment}";
PROG_SIZE\t= 0;
CREATE\t\t= {date};
MODIFIED\t= {date};
FILE_NAME\t= ;
VERSION\t\t= 0;
LINE_COUNT\t= {lines};
MEMORY_SIZE\t= 0;
PROTECT\t\t= READ_WRITE;
TCD:  STACK_SIZE\t= 0,
      TASK_PRIORITY\t= 50,
      TIME_SLICE\t= 0,
      BUSY_LAMP_OFF\t= 0,
      ABORT_REQUEST\t= 0,
      PAUSE_REQUEST\t= 0;
DEFAULT_GROUP\t= {groups};
CONTROL_CODE\t= 00000000 00000000;
/MN
"""

# s; longest wait in one line; longer waits take several lines
_LONGEST_WAIT = 300.0

_JOINT_RECORD = (
    "P[%d]{\r\n   GP1:\r\n\t<frame>\t\r\n"
    "\tJ1=%s deg,\tJ2=%s deg,\tJ3=%s deg,\r\n"
    "\tJ4=%s deg,\tJ5=%s deg,\tJ6=%s deg\r\n};\r\n"
)
_POSE_RECORD = (
    "P[%d]{\r\n   GP1:\r\n\t<frame>\t\tCONFIG : '%s',\r\n"
    "\tX =%s  mm,\tY =%s  mm,\tZ =%s  mm,\r\n"
    "\tW =%s deg,\tP =%s deg,\tR =%s deg\r\n};\r\n"
)


def listing(
    name: str, comment: str, instructions: Sequence[str], records: str, group: int = 1
) -> bytes:
    """Return a complete file.

    Parameters
    ----------
    name : str
        Name of the program.
    comment : str
        Comment of the program.
    instructions : sequence of str
        Text after the colon of each line, with its semicolon.
    records : str
        Text of joint_records or pose_records, or ''.
    group : int, optional
        The motion group that moves together with the first group.

    Returns
    -------
    bytes
        The content of the file.
    """
    groups = ",".join("1" if number in (1, group) else "*" for number in range(1, GROUPS + 1))
    comment = plain(comment)[:COMMENT_WIDTH]
    head = _HEADER.format(
        name=name, comment=comment, date=_DATE, lines=len(instructions), groups=groups
    )
    numbered = [f"{number:4d}:{line}" for number, line in enumerate(instructions, 1)]
    text = head.replace("\n", END_OF_LINE) + END_OF_LINE.join(numbered) + END_OF_LINE
    return (text + "/POS" + END_OF_LINE + records + "/END" + END_OF_LINE).encode("ascii")


def plain(text: str) -> str:
    """Convert text to the characters that a listing allows: no accents, semicolons or quotes."""
    ascii_text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode("ascii")
    return " ".join(ascii_text.translate(str.maketrans(';"', ",'")).split())


def remark(text: str) -> list[str]:
    """Wrap a remark to the width of a listing."""
    return [f"  !{line} ;" for line in textwrap.wrap(plain(text), REMARK_WIDTH)]


def wait(seconds: float) -> list[str]:
    """Return the lines of a wait, to 0.01 s; empty for 0 s."""
    lines = []
    hundredths = max(round(seconds * 100.0), int(seconds > 0.0))
    while hundredths > 0:
        step = min(hundredths, round(_LONGEST_WAIT * 100.0))
        lines.append(f"  WAIT{right_aligned(step / 100.0, 2, 7)}(sec) ;")
        hundredths -= step
    return lines


def call(name: str) -> str:
    """Return the call of another program."""
    return f"  CALL {name}    ;"


def arc(word: str, schedule: int) -> str:
    """Return the arc instruction Start or End with a schedule."""
    return f"  Arc {word}[{schedule}]    ;"


def weave(number: int) -> str:
    """Return the start of a sine weave with the schedule `number`, or the end of weaving for 0."""
    return f"  Weave Sine[{number}] ;" if number else "  Weave End ;"


def joint_records(
    degrees: Array, track: Array, external: Array, user_frame: int, tool_frame: int, group: int = 1
) -> str:
    """Return position records with joint values.

    Parameters
    ----------
    degrees : (n, 6) array
        Robot joint values, degrees, rounded to 3 decimals.
    track : (n, 0) or (n, 1) array
        Track values, mm, rounded.
    external : (n, k) array
        Axis values of another motion group, degrees, rounded.
    user_frame, tool_frame : int
        Numbers of the frames.
    group : int, optional
        Number of the other motion group.

    Returns
    -------
    str
        Records P[1], P[2] and so on.
    """
    values = ",".join(f"\tJ{axis}=%s deg" for axis in range(1, external.shape[1] + 1))
    second_group = f"   GP{group}:\r\n\t<frame>\t\r\n{values}\r\n}};" if values else "};"
    extended = "deg,\r\n\tE1=%s  mm\r\n};" if track.shape[1] else "deg\r\n};"
    record = _JOINT_RECORD.replace("deg\r\n};", extended).replace("};", second_group)
    return _records(record, user_frame, tool_frame, [], np.hstack([degrees, track, external]))


def pose_records(
    pose: Array, configuration: Sequence[str], user_frame: int, tool_frame: int
) -> str:
    """Return position records with poses.

    Parameters
    ----------
    pose : (n, 6) array
        X Y Z mm, W P R degrees, rounded to 3 decimals.
    configuration : sequence of str
        CONFIG of each position.
    user_frame, tool_frame : int
        Numbers of the frames.

    Returns
    -------
    str
        Records P[1], P[2] and so on.
    """
    return _records(_POSE_RECORD, user_frame, tool_frame, [configuration], pose)


def _records(
    template: str, user_frame: int, tool_frame: int, words: Sequence[Sequence[str]], values: Array
) -> str:
    """Fill a record template for each position, numbered from 1.

    The fields are the number, words (columns (n,)) and values (n, k).
    """
    record = template.replace("<frame>", f"UF : {user_frame}, UT : {tool_frame},")
    texts = [[right_aligned(value, 3, 10) for value in row] for row in values.tolist()]
    return "".join(
        record % (number, *row_words, *row)
        for number, (row, *row_words) in enumerate(zip(texts, *words, strict=True), 1)
    )


def right_aligned(value: float, decimals: int, width: int) -> str:
    """Format a number as the controller lists it.

    There is no 0 before the point except in 0.000: .250, -.250. -0.0 keeps its sign: -.000.

    Parameters
    ----------
    value : float
        The number.
    decimals : int
        Number of decimals.
    width : int
        Minimum number of characters.

    Returns
    -------
    str
        The padded text.
    """
    text = f"{value:.{decimals}f}"
    if float(text) != 0.0 or text.startswith("-"):
        text = re.sub(r"^(-?)0\.", r"\1.", text)
    return text.rjust(width)
