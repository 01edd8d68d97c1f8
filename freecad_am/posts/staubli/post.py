# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write Stäubli VAL 3 applications of joint moves, or of linear moves at a constant speed at the
deposition point.

With the part on the robot, linear moves have a fixed target, the deposition point. Each move has
its own tool, the point of the part that moves to the target (Chalvin 2019, III.A, "jauges outil").
Output, controller settings and confirmations: docs/posts/staubli.md.
"""

from __future__ import annotations

import re
import textwrap
import unicodedata
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ...core.controller import Controller
from ...core.issues import InputError
from ...core.orientation import MOVING_XYZ, Pendant
from ...core.program import (
    JOINT_MOVE,
    Block,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Program,
    Six,
    Wait,
    WaitInput,
)
from ...core.types import Array
from ..catalogue import Naming, controller_checks
from ..parts import Piece, Run, grouped, move_retracts, packed, size, unbroken
from ..refusals import (
    refuse_continuous,
    refuse_cooling,
    refuse_incomplete,
    refuse_no_process,
    refuse_triggers,
    refuse_wire,
    refuse_without_positions,
    refuse_without_speeds,
)
from . import numbers
from .numbers import ANGLE_DECIMALS, LENGTH_DECIMALS
from .read import read

# ---- File formats: project (.pjx), data (.dtx) and programs (.pgx), UTF-8 with BOM

_HEAD = '<?xml version="1.0" encoding="utf-8"?>\n'
_XSI = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
_PROJECT = """\
<Project xmlns="http://www.staubli.com/robotics/VAL3/Project/3">
  <Parameters version="s7.7.2" stackSize="5000" millimeterUnit="true" />
  <Programs>
{programs}  </Programs>
  <Database>
    <Data file="{name}.dtx" />
  </Database>
  <Libraries>
{libraries}  </Libraries>
</Project>
"""
_DATA = f"""\
<Database {_XSI} xmlns="http://www.staubli.com/robotics/VAL3/Data/2">
  <Datas>
{{data}}  </Datas>
</Database>
"""
_PROGRAM = f"""\
<Programs {_XSI} xmlns="http://www.staubli.com/robotics/VAL3/Program/2">
  <Program name="{{name}}" access="public">
{{locals}}    <Code><![CDATA[begin
{{code}}end]]></Code>
  </Program>
</Programs>
"""
_LOCALS = """\
    <Locals>
      <Local name="l_nI" type="num" xsi:type="array" size="1" />
    </Locals>
"""

_JOINTS = " ".join(f'j{axis}="%.{ANGLE_DECIMALS}f"' for axis in range(1, 7))
_FRAME = " ".join(
    [f'{axis}="%.{LENGTH_DECIMALS}f"' for axis in ("x", "y", "z")]
    + [f'{axis}="%.{ANGLE_DECIMALS}f"' for axis in ("rx", "ry", "rz")]
)


def _project_file(name: str, programs: Sequence[str], libraries: dict[str, str]) -> bytes:
    """Return the project file of an application.

    Parameters
    ----------
    name : str
        Name of the application.
    programs : sequence of str
        Names of the application's programs.
    libraries : dict[str, str]
        Path of each library by alias.

    Returns
    -------
    bytes
        The content of the file.
    """
    files = "".join(f'    <Program file="{program}.pgx" />\n' for program in programs)
    library_files = "".join(
        f'    <Library alias="{alias}" path="{path}" />\n' for alias, path in libraries.items()
    )
    return _file(_PROJECT.format(programs=files, name=name, libraries=library_files))


def _data_file(arrays: dict[str, tuple[str, list[str]]]) -> bytes:
    """Return the data file of an application. arrays: type and value attributes of each array, by
    name.
    """
    return _file(
        _DATA.format(data="".join(_data_element(name, *arrays[name]) for name in sorted(arrays)))
    )


def _data_element(name: str, kind: str, values: list[str]) -> str:
    head = f'    <Data name="{name}" access="private" xsi:type="array" type="{kind}" size="{len(values)}">\n'
    return (
        head
        + "".join(f'      <Value key="{key}" {value} />\n' for key, value in enumerate(values))
        + "    </Data>\n"
    )


def _program_file(name: str, lines: Iterable[str]) -> bytes:
    """Return the file of a program with the given lines."""
    lines = [f"  {line}\n" for line in lines]
    variables = _LOCALS if any("l_nI" in line for line in lines) else ""
    return _file(_PROGRAM.format(name=name, locals=variables, code="".join(lines)))


def _file(body: str) -> bytes:
    return (_HEAD + body).encode("utf-8-sig")


def _joint_rows(values: Array) -> list[str]:
    """Format joint values as attributes.

    Parameters
    ----------
    values : (n, 6) array
        Joint values, degrees.

    Returns
    -------
    list of str
        n strings.
    """
    return _rows(_JOINTS, values)


def _frame_rows(values: Array, attributes: str) -> list[str]:
    """Format points, frames or tools as attributes.

    Parameters
    ----------
    values : (n, 6) array
        Coordinates, mm, and angles, degrees.
    attributes : str
        Further attributes to append to each.

    Returns
    -------
    list of str
        n strings.
    """
    return _rows(f"{_FRAME} {attributes}", values)


def _rows(template: str, values: Array) -> list[str]:
    return [template % row for row in zip(*values.T.tolist())]


def _remark(text: str) -> list[str]:
    """Wrap a comment in ASCII characters to lines of at most 80 characters."""
    decomposed = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    plain = decomposed.encode("ascii", "ignore").decode("ascii").replace("]]>", "")
    return [f"// {line}" for line in textwrap.wrap(plain, 80)]


def _delay(seconds: float) -> list[str]:
    """Return the line of a wait, to 0.001 s; empty for 0 s."""
    return [f"delay({max(seconds, 0.001):.3f})"] if seconds > 0.0 else []


# ---- The application

__all__ = ["read", "write"]


NO_ANALOGUE = "links of analogue inputs differ between controllers, and the post staubli does not know these links"
CONTROLLER = Controller(point_bytes=250, whole_beads=True)
PENDANT = Pendant("Stäubli", ("Rx", "Ry", "Rz"), MOVING_XYZ)
NO_WIRE = "VAL 3 sets outputs while earlier moves are still in the queue"
NO_WEAVE = "VAL 3 has no documented weave"
NO_TRIGGER = "VAL 3 has no documented way to switch an output ahead of a point"
refuse_process = refuse_no_process
NO_SCHEDULE = {
    "output": "VAL 3 has no documented way to set several outputs to one number",
    "arc": "VAL 3 has no arc instructions",
}
MOVE_LINE = re.compile(rb" *move[jl]\(")
ON_CONTROLLER = controller_checks(
    "The world frame of the controller is the robot base, and joint speeds are the nominal ones",
    "The outputs and inputs are linked to the process",
    "A dry run has tried loading parts, and tools that are attached to other tools",
    "Payload is set and the monitor speed is 100 %",
)
AXES = 6
SETUPS = ("part-on-robot", "tool-on-robot")
PART = "prog"  # alias of the loaded part

# reserved words that cannot be library aliases; file names are case-insensitive
_RESERVED = frozenset(
    (
        "AND",
        "BEGIN",
        "BREAK",
        "CALL",
        "CASE",
        "DEFAULT",
        "DO",
        "ELSE",
        "ELSEIF",
        "END",
        "ENDFOR",
        "ENDIF",
        "ENDSWITCH",
    )
    + (
        "ENDWHILE",
        "FALSE",
        "FLANGE",
        "FOR",
        "IF",
        "NOT",
        "OR",
        "RETURN",
        "START",
        "STEP",
        "STOP",
        "SWITCH",
        "THEN",
        "TO",
    )
    + ("TRUE", "UNTIL", "WHILE", "WORLD", "XOR", PART.upper())
)
NAMING = Naming(
    str,
    "[A-Za-z]",
    "a letter",
    longest=15,
    spare=3,
    prefix="am_",
    reserved=_RESERVED,
    what="an application's name",
)
_LOAD = """\
if {alias}:libLoad("./{part}")!=0
  popUpMsg("{part} cannot be loaded")
  return
endIf
call {alias}:start()"""


def write(program: Program) -> dict[str, bytes]:
    """Write the files of a program, path with slashes -> content; the same program always gives the
    same bytes.

    If all points fit into one application, write only NAME/. Otherwise NAME/ loads NAME/NAME01/,
    NAME/NAME02/ and so on in turn, each with whole beads. The duration of the first move is not
    used.

    Raises InputError: PROGRAM_NAME, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, ENDLESS_AXIS,
    NO_JOINT_SPEED, JOINT_SPEED, MOVE_SPEED, NO_POSITIONS, BEAD_TOO_LONG, NO_WIRE_OUTPUT,
    UNREACHABLE, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    remarks = [
        line for words in (*program.remarks, *_own_remarks(program)) for line in _remark(words)
    ]
    groups = list(
        grouped(program, numbers.Descriptors(program), lambda block: _instructions(program, block))
    )
    if size([entry for group in groups for entry in group])[0] <= program.max_points:
        (entries,) = packed(groups, program.max_points, _NO_END, unbroken)
        return _application(program, name, name, remarks, entries)
    # one point is reserved for the retract from the last bead, so that the next part is loaded
    # there
    part_pieces = move_retracts(packed(groups, program.max_points - 1, _NO_END, unbroken))
    names = NAMING.parts(name, len(part_pieces))
    load = [
        line for part_name in names for line in _LOAD.format(alias=PART, part=part_name).split("\n")
    ]
    files = _files(
        program, name, name, [*remarks, *load], {}, {PART: f"./{names[0]}/{names[0]}.pjx"}
    )
    for number, (part_name, entries) in enumerate(zip(names, part_pieces, strict=True), 1):
        head = _remark(f"part {number} of {len(part_pieces)}")
        files |= _application(program, f"{name}/{part_name}", part_name, head, entries)
    return files


_NO_END = 10**9  # no line limit: moves are in the data, so programs are short


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
            "the post staubli cannot write {} ({} motion); use another post",
            setup,
            motion,
        )


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    refuse_incomplete(program, "staubli", AXES)
    refuse_wire(program, NO_WIRE)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, 0, NO_ANALOGUE)
    refuse_continuous(program)
    refuse_without_speeds(program, AXES)
    refuse_without_positions(program)
    for block in program.blocks:
        if isinstance(block, Call) and re.fullmatch(
            rf"{program.name}\d*", program_name(block.program, block.where), re.I
        ):
            raise InputError(
                "PROGRAM_NAME",
                block.where,
                "{!r} may be a program of the job; use another name",
                block.program,
            )


_CALL = "process.between_layers.call"


def _own_remarks(program: Program) -> Iterator[str]:
    if program.motion == "cartesian" and program.holds_part:
        yield "pTarget is the deposition point, tCarried the program origin on the flange"
        yield "each tPath is the point of the part that comes to pTarget, seen from the program origin"
    if program.dry_run:
        yield "dry run: no deposit"


def _instructions(program: Program, block: Block) -> list[str]:
    if isinstance(block, DepositOn):
        return [] if program.dry_run else ["doDeposit=true", *_delay(block.lead)]
    if isinstance(block, DepositOff):
        return [] if program.dry_run else [*_delay(block.lead), "doDeposit=false"]
    if isinstance(block, LayerStart):
        return _remark(f"layer {block.layer}")
    if isinstance(block, Wait):
        return _delay(block.seconds)
    if isinstance(block, WaitInput):
        return [f"wait(diInput{block.number}==true)"]
    if isinstance(block, Call):
        return [f"call {block.program}:start()"]
    raise TypeError(f"no instruction for {block!r}")


def _application(
    program: Program, folder: str, name: str, remarks: list[str], entries: Sequence[Piece]
) -> dict[str, bytes]:
    arrays: dict[str, tuple[str, list[str]]] = {}
    lines = list(remarks)
    for entry in entries:
        lines += _motion(program, entry, arrays) if isinstance(entry, Run) else entry
    libraries = {}
    for block in program.blocks:
        if isinstance(block, WaitInput) and f"wait(diInput{block.number}==true)" in lines:
            arrays[f"diInput{block.number}"] = ("dio", [f'link="BasicIO-1\\%I{block.number - 1}"'])
        if isinstance(block, Call) and f"call {block.program}:start()" in lines:
            libraries[block.program] = f"Disk://{block.program}/{block.program}.pjx"
    if program.motion == "cartesian":
        arrays["fStation"] = ("frame", _single(program.station, 'fatherId="world[0]"'))
    if program.motion == "cartesian" and program.holds_part:
        arrays["pTarget"] = ("pointRx", _single(None, _POINT))
    arrays["tCarried"] = ("tool", _single(program.carried, _TOOL))
    return _files(program, folder, name, lines, arrays, libraries)


_POINT = 'shoulder="ssame" elbow="esame" wrist="wsame" fatherId="fStation[0]"'
_TOOL = 'fatherId="flange[0]"'
_GAUGE = 'fatherId="tCarried[0]"'


def _single(six: Six | None, attributes: str) -> list[str]:
    values = np.zeros(6) if six is None else np.array([*six[:3], *np.degrees(six[3:])])
    return _frame_rows(values[None] + 0.0, attributes)


def _files(
    program: Program,
    folder: str,
    name: str,
    lines: list[str],
    arrays: dict[str, tuple[str, list[str]]],
    libraries: dict[str, str],
) -> dict[str, bytes]:
    off = [] if program.dry_run else ["doDeposit=false"]
    if off:
        arrays = {
            **arrays,
            "doDeposit": ("dio", [f'link="BasicIO-1\\%Q{program.deposit_output - 1}"']),
        }
    return {
        f"{folder}/{name}.pjx": _project_file(name, ("start", "stop"), libraries),
        f"{folder}/{name}.dtx": _data_file(arrays),
        f"{folder}/start.pgx": _program_file("start", lines),
        f"{folder}/stop.pgx": _program_file("stop", ["resetMotion()", *off]),
    }


def _motion(program: Program, run: Run, arrays: dict[str, tuple[str, list[str]]]) -> list[str]:
    """Return the lines through all points of a run, with a stop at the last point.

    Appends points and motion descriptors to the arrays.
    """
    moves, rows = run.moves, slice(run.start, run.stop)
    if moves.interpolation == JOINT_MOVE:
        pattern, array, kind = "movej(jPath[{point}],tCarried,mPath[{speed}])", "jPath", "jointRx"
        values = _joint_rows(numbers.degrees(moves.joints[rows]))
    else:
        assert moves.position is not None and moves.rotation is not None
        frames = numbers.frames(moves.position[rows], moves.rotation[rows])
        if program.holds_part:
            pattern, array, kind = "movel(pTarget,tPath[{point}],mPath[{speed}])", "tPath", "tool"
            values = _frame_rows(frames, _GAUGE)
        else:
            pattern = "movel(pPath[{point}],tCarried,mPath[{speed}])"
            array = "pPath"
            kind = "pointRx"
            values = _frame_rows(frames, _POINT)
    first_index = _appended(arrays, array, kind, values)
    words = list(run.words[rows])
    alike = len(set(words)) == 1
    previous_words = arrays["mPath"][1] if "mPath" in arrays else []
    same = alike and previous_words[-1:] == words[:1]
    speed = (
        len(previous_words) - 1
        if same
        else _appended(arrays, "mPath", "mdesc", words[:1] if alike else words)
    )
    if len(run) == 1:
        return [pattern.format(point=first_index, speed=speed), "waitEndMove()"]
    index = (
        str(speed) if alike else "l_nI" if speed == first_index else f"l_nI{speed - first_index:+d}"
    )
    return [
        f"for l_nI={first_index} to {first_index + len(run) - 1}",
        f"  {pattern.format(point='l_nI', speed=index)}",
        "endFor",
        "waitEndMove()",
    ]


def _appended(
    arrays: dict[str, tuple[str, list[str]]], name: str, kind: str, values: list[str]
) -> int:
    """Append values to an array and return the index of the first appended value."""
    array_values = arrays.setdefault(name, (kind, []))[1]
    array_values += values
    return len(array_values) - len(values)
