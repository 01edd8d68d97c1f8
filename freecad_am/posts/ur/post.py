# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write URScript of joint moves by time, or of beads in process moves (movep) with the tool on the
robot.

In both cases rapids are joint moves that stop at every point. A script is one file, because
URScript cannot load another; parts are functions in this file. Output, controller settings and
confirmations: docs/posts/ur.md.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from ...core.controller import Controller
from ...core.issues import InputError
from ...core.orientation import MOVING_XYZ, ROTATION_VECTOR, Pendant
from ...core.program import (
    LINEAR_MOVE,
    RAPID,
    Block,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Schedule,
    Six,
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
    refuse_continuous,
    refuse_cooling,
    refuse_incomplete,
    refuse_no_process,
    refuse_schedules,
    refuse_triggers,
    refuse_wire,
    refuse_without_positions,
)
from .read import INSTRUCTIONS, read

DECIMALS = 7  # decimals of rad and m
# maximum blend radius as a fraction of the shorter adjacent move; the controller skips points if
# blends overlap
LARGEST_SHARE = 0.4
MICRON = 1e-6  # m; resolution of a blend radius
# s: controller cycle, and minimum time that is written
CYCLE, MIN_TIME_S = 0.002, 0.001
# mm/s: range of path speeds, which are written to 0.001 mm/s
SLOWEST, FASTEST = 0.01, 1000.0
# mm on the flange: candidate tool points, to which blends of joint moves refer if the robot carries
# the part
TOOL_POINTS = np.array(
    [[0, 0, 0], [200, 0, 0], [-200, 0, 0], [0, 200, 0], [0, -200, 0], [0, 0, 200]], dtype=np.float64
)


class Words:
    """Build time or speed and blend of each move, block by block, and choose the tool point for the
    blends.

    tool_point: mm on the flange if the robot carries the part; None if the tip itself is the tool.
    Raises InputError MOVE_TIME, MOVE_SPEED or BLEND_RADIUS.
    """

    def __init__(self, program: Program) -> None:
        self.tool_point, tip_steps = _ways(program)
        radii = _radii(program, tip_steps)
        counts = np.cumsum([0] + [len(run) for run in program.moves])
        self.radii = {
            id(run): radii[start : start + len(run)]
            for run, start in zip(program.moves, counts.tolist())
        }

    def __call__(self, moves: Moves) -> list[str]:
        """Return `t=..., r=...` for joint moves and `v=..., r=...` for linear moves."""
        if moves.interpolation == LINEAR_MOVE:
            texts = [f"v={speed:.6f}" for speed in (_speeds(moves) * 0.001).tolist()]
        else:
            texts = [f"t={seconds:.6f}" for seconds in _times(moves).tolist()]
        return [
            f"{word}, r={radius:.6f}" for word, radius in zip(texts, self.radii[id(moves)].tolist())
        ]


def _ways(program: Program) -> tuple[Array | None, Array]:
    """Return the tool point and its path length (n,), mm, on each move of a bead."""
    moves = program.moves
    if not program.holds_part:  # the tip is the tool
        return None, np.concatenate([run.speed * run.duration for run in moves])
    flange = np.concatenate([run.flange for run in moves if run.flange is not None])
    tool_positions = flange[:, :3, :3] @ TOOL_POINTS.T + flange[:, :3, 3:]
    tip_steps = np.linalg.norm(np.diff(tool_positions, axis=0, prepend=tool_positions[:1]), axis=1)
    through = ~np.concatenate([run.stops for run in moves])
    shortest = np.minimum(tip_steps, np.vstack([tip_steps[1:], tip_steps[-1:]]))[through].min(
        axis=0, initial=np.inf
    )
    best = int(np.argmax(np.round(shortest, 6)))
    return TOOL_POINTS[best], tip_steps[:, best]


def _radii(program: Program, tip_steps: Array) -> Array:
    """Return the blend radii (n,), m, at the move ends: a fraction of the shorter adjacent move, 0
    at stops.
    """
    moves = program.moves
    stops = np.concatenate([run.stops for run in moves])
    adjacent = np.minimum(tip_steps, np.append(tip_steps[1:], 0.0))
    microns = np.floor(LARGEST_SHARE * 0.01 * program.blend * adjacent * 0.001 / MICRON + 1e-6)
    radii: Array = np.where(stops, 0.0, microns * MICRON)
    short = ~stops & (radii < MICRON)
    if program.blend and short.any():
        shortest_row = int(np.argmax(short))
        run = moves[
            int(np.searchsorted(np.cumsum([len(run) for run in moves]), shortest_row, side="right"))
        ]
        raise InputError(
            "BLEND_RADIUS",
            place(run),
            "the tool passes a point by {:.3g} mm without a stop, too little for a blend radius, "
            "so the robot would stop there with the deposit on; use a larger "
            "strategy.chord_error, or `program.blend: 0` to stop at every point",
            adjacent[shortest_row],
        )
    return radii


def _times(moves: Moves) -> Array:
    """Return the times (n,), s. Raises InputError MOVE_TIME."""
    seconds = np.where(np.isfinite(moves.duration), moves.duration, 0.0)
    if moves.kind != RAPID and seconds.min() < CYCLE:
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "a move takes {:.3g} ms, less than the {:.0f} ms cycle of the controller; use a "
            "larger strategy.chord_error or a lower process.travel_speed",
            1000.0 * seconds.min(),
            1000.0 * CYCLE,
        )
    times: Array = np.maximum(seconds, MIN_TIME_S)
    return times


def _speeds(moves: Moves) -> Array:
    fits = (moves.speed >= SLOWEST) & (moves.speed <= FASTEST)
    if not fits.all():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written; use {} to {:.0f} mm/s",
            moves.speed[~fits][0],
            SLOWEST,
            FASTEST,
        )
    return moves.speed


def poses(position: Array, rotation: Array) -> Array:
    """Convert poses to URScript values.

    Parameters
    ----------
    position : (n, 3) array
        mm.
    rotation : (n, 3, 3) array
        Rotations.

    Returns
    -------
    (n, 6) array
        Positions in m and rotation vectors in rad, rounded.
    """
    values: Array = (
        np.round(np.hstack([0.001 * position, ROTATION_VECTOR.numbers(rotation)]), DECIMALS) + 0.0
    )
    return values


__all__ = ["read", "write"]


AXES = 6
CONTROLLER = Controller(
    point_bytes=140, configurations=False, flange=True, least_step=2.0001e-3, least_blend=2.6e-3
)
PENDANT = Pendant("Universal Robots", ("RX", "RY", "RZ"), ROTATION_VECTOR, 6)
NO_WIRE = (
    "URScript sets an output when the robot enters the blend before the point, not at the point"
)
NO_WEAVE = "URScript has no documented weave"
NO_TRIGGER = "URScript has no documented way to switch an output ahead of a point"
refuse_process = refuse_no_process
NO_SCHEDULE = {"arc": "URScript has no arc instructions"}
LAST_REGISTER, LAST_SCHEDULE = 47, 65535
MOVE_LINE = re.compile(rb" *move[jlp]\(")
ON_CONTROLLER = controller_checks(
    "Joint programs assume the nominal arm; the calibrated arm deviates by up to a few millimetres",
    "The robot keeps the time of every move through its blends",
    "Payload is set, safety limits allow the speeds, and the speed slider is at 100 %",
    "The deposit output switches the process",
)
LAST_PIN = 16  # digital inputs and outputs: 1 to 8 are the standard pins 0 to 7, 9 to 16 the configurable pins
LAST_ANALOGUE = 2

# reserved words, and library functions that programs on the controller use
_RESERVED = INSTRUCTIONS | frozenset(
    (
        "AND",
        "BREAK",
        "CASE",
        "CONTINUE",
        "DEF",
        "DEFAULT",
        "ELIF",
        "ELSE",
        "END",
        "ENTER_CRITICAL",
        "EXIT_CRITICAL",
        "FALSE",
    )
    + (
        "GLOBAL",
        "HALT",
        "IF",
        "JOIN",
        "KILL",
        "LOCAL",
        "MOD",
        "NOT",
        "OR",
        "RETURN",
        "RUN",
        "SEC",
        "STRUCT",
        "SWITCH",
    )
    + (
        "THREAD",
        "TRUE",
        "WHILE",
        "XOR",
        "P",
        "PLATFORM",
        "SLEEP",
        "SYNC",
        "MOVEJ",
        "MOVEL",
        "MOVEP",
        "MOVEC",
        "SERVOJ",
    )
    + (
        "SERVOC",
        "SPEEDJ",
        "SPEEDL",
        "STOPJ",
        "STOPL",
        "SET_TCP",
        "SET_PAYLOAD",
        "POSE_TRANS",
        "POSE_INV",
        "POSE_ADD",
    )
    + (
        "GET_INVERSE_KIN",
        "GET_FORWARD_KIN",
        "POPUP",
        "TEXTMSG",
        "FREEDRIVE_MODE",
        "FORCE_MODE",
        "POWERDOWN",
    )
    + (
        "SIN",
        "COS",
        "TAN",
        "ASIN",
        "ACOS",
        "ATAN",
        "ATAN2",
        "SQRT",
        "POW",
        "LOG",
        "FLOOR",
        "CEIL",
        "NORM",
        "RANDOM",
    )
)
NAMING = Naming(str, "[A-Za-z]", "a letter", longest=30, spare=4, prefix="am_", reserved=_RESERVED)
_NO_END = 10**9
_JOINTS = "[" + ", ".join([f"%.{DECIMALS}f"] * 6) + "]"
_INDENT = "  "


def write(program: Program) -> dict[str, bytes]:
    """Write the script of a program, file name -> content; the same program always gives the same
    bytes.

    The file contains one function with the program's name. If the program exceeds max_points, this
    function calls inner functions NAME01, NAME02 and so on. The first move has no planned duration
    and takes `FIRST_TIME`.

    Raises InputError: PROGRAM_NAME, REMOTE_TCP, UNSUPPORTED_SETUP, UNSUPPORTED_AXES, ENDLESS_AXIS,
    MOVE_TIME, MOVE_SPEED, BLEND_RADIUS, NO_POSITIONS, DEPOSIT_OUTPUT, DEPOSIT_INPUT,
    NO_WIRE_OUTPUT, ANALOGUE_INPUT, UNREACHABLE, NOTHING_TO_WRITE.
    """
    name = program_name(program.name, "name")
    _refuse(program)
    words = Words(program)
    groups = list(grouped(program, words, lambda block: _instructions(program, block)))
    part_pieces = packed(groups, program.max_points, _NO_END, keep_whole)
    names = NAMING.parts(name, len(part_pieces)) if len(part_pieces) > 1 else []
    refuse_calls_of_own(program, {name, *names}, program_name)
    remarks = [
        f"# {line}"
        for text in (*program.remarks, *_own_remarks(program, names))
        for line in nc_numbers.wrapped(text)
    ]
    lines = [*remarks, *_frames(program, words.tool_point)]
    if not names:
        lines += _lines(part_pieces[0])
    for part_name, entries in zip(names, part_pieces):
        lines += [f"def {part_name}():", *(_INDENT + line for line in _lines(entries)), "end"]
    lines += [f"{part_name}()" for part_name in names]
    text = "\n".join([f"def {name}():", *(_INDENT + line for line in lines), "end", ""])
    return {f"{name}.script": text.encode("ascii")}


def program_name(name: str, where: str) -> str:
    """Return the name of file and function.

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

    Raises InputError REMOTE_TCP or UNSUPPORTED_SETUP.
    """
    if motion == "cartesian" and setup == "part-on-robot":
        raise InputError(
            "REMOTE_TCP",
            "program.motion",
            "URScript programs the speed of a tool on the flange; with the part on the robot the "
            "tool is fixed and the speed at the deposition point varies from point to point, "
            "which no documented instruction controls; use `motion: joint`",
        )
    if setup not in ("part-on-robot", "tool-on-robot"):
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post ur cannot write {}; use another post",
            setup,
        )


def _refuse(program: Program) -> None:
    refuse_setup(program.motion, program.setup)
    refuse_incomplete(program, "ur", AXES)
    refuse_wire(program, NO_WIRE)
    refuse_triggers(program, NO_TRIGGER)
    refuse_cooling(program, LAST_ANALOGUE)
    refuse_schedules(program, LAST_REGISTER, LAST_SCHEDULE)
    refuse_continuous(program)
    refuse_without_positions(program)
    if program.holds_part and any(run.flange is None for run in program.moves):
        raise InputError(
            "NO_POSITIONS",
            "program",
            "the program lacks the flange poses, which blends depend on; plan the joint path again",
        )
    if not program.dry_run and program.deposit_output > LAST_PIN:
        raise InputError(
            "DEPOSIT_OUTPUT",
            "program.deposit_output",
            "digital outputs are 1 to {} (1 to 8 are digital_out[0] to [7], 9 to {} the "
            "configurable outputs), not {}; choose an output in this range",
            LAST_PIN,
            LAST_PIN,
            program.deposit_output,
        )
    for block in program.blocks:
        if isinstance(block, WaitInput) and block.number > LAST_PIN:
            raise InputError(
                "DEPOSIT_INPUT",
                "process.between_layers.input",
                "digital inputs are 1 to {} (1 to 8 are digital_in[0] to [7], 9 to {} the "
                "configurable inputs), not {}; choose an input in this range",
                LAST_PIN,
                LAST_PIN,
                block.number,
            )


def _own_remarks(program: Program, names: Sequence[str]) -> Iterator[str]:
    if program.holds_part:
        yield "the tool centre point is one that the part carries: blend radii count on its way, nothing else does"
    if names:
        yield f"{sum(len(run) for run in program.moves)} moves in {len(names)} parts"
    if program.dry_run:
        yield "dry run: no deposit"


def _frames(program: Program, tool_point: Array | None) -> list[str]:
    """Return the lines that set the tool, and in Cartesian programs the frame of the positions."""
    tool = program.carried if tool_point is None else (*tool_point.tolist(), 0.0, 0.0, 0.0)
    lines = [f"set_tcp({_pose(tool)})"]
    if program.motion == "cartesian":
        lines.append(f"global platform = {_pose(program.station)}")
    return lines


def _pose(six: Six | None) -> str:
    """Convert X Y Z mm, RX RY RZ rad (Rx Ry Rz) to a URScript pose."""
    x, y, z, rx, ry, rz = six or (0.0,) * 6
    rotation = MOVING_XYZ.rotations(np.array([[rx, ry, rz]]))
    return "p" + _JOINTS % tuple(poses(np.array([[x, y, z]]), rotation)[0].tolist())


def _instructions(program: Program, block: Block) -> list[str]:
    if isinstance(block, DepositOn):
        return (
            [] if program.dry_run else [_output(program.deposit_output, True), *_sleep(block.lead)]
        )
    if isinstance(block, DepositOff):
        return (
            [] if program.dry_run else [*_sleep(block.lead), _output(program.deposit_output, False)]
        )
    if isinstance(block, Schedule):
        return [f"write_output_integer_register({program.schedule_output}, {block.number})"]
    if isinstance(block, LayerStart):
        return [f"# layer {block.layer}"]
    if isinstance(block, Wait):
        return _sleep(block.seconds)
    if isinstance(block, WaitInput):
        kind, pin = _pin(block.number)
        return [f"while get_{kind}_digital_in({pin}) == False:", f"{_INDENT}sleep(0.010)", "end"]
    if isinstance(block, WaitBelow):
        level = f"while get_standard_analog_in({block.number - 1}) >= {block.below:.6f}:"
        return [level, f"{_INDENT}sleep(0.100)", "end"]
    if isinstance(block, Call):
        return [f"{program_name(block.program, block.where)}()"]
    raise TypeError(f"no instruction for {block!r}")


def _output(number: int, on: bool) -> str:
    kind, pin = _pin(number)
    return f"set_{kind}_digital_out({pin}, {on})"


def _pin(number: int) -> tuple[str, int]:
    return ("standard", number - 1) if number <= 8 else ("configurable", number - 9)


def _sleep(seconds: float) -> list[str]:
    return [f"sleep({max(seconds, 0.001):.3f})"] if seconds > 0.0 else []


def _lines(entries: Sequence[Piece]) -> list[str]:
    return lines_of(entries, _motion)


def _motion(run: Run) -> list[str]:
    """Return the moves through all points of a run."""
    moves, rows = run.moves, slice(run.start, run.stop)
    if moves.interpolation == LINEAR_MOVE:
        pattern, values = f"movep({_POSE_ON_PLATFORM}, a=1.2, %s)", _poses(moves, rows)
    elif moves.position is None:
        pattern, values = f"movej({_JOINTS}, a=1.4, v=1.05, %s)", _joints(moves, rows)
    else:  # the controller solves the position for its calibrated arm, near the planned joints
        pattern = f"movej(get_inverse_kin({_POSE_ON_PLATFORM}, {_JOINTS}), a=1.4, v=1.05, %s)"
        values = np.hstack([_poses(moves, rows), _joints(moves, rows)])
    return [
        pattern % (*row, word) for row, word in zip(values.tolist(), run.words[rows], strict=True)
    ]


_POSE_ON_PLATFORM = f"pose_trans(platform, p{_JOINTS})"


def _joints(moves: Moves, rows: slice) -> Array:
    values: Array = np.round(moves.joints[rows], DECIMALS) + 0.0
    return values


def _poses(moves: Moves, rows: slice) -> Array:
    assert moves.position is not None and moves.rotation is not None
    return poses(moves.position[rows], moves.rotation[rows])
