# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format the text of a RAPID module: head, data, routine and lines. Lines end in CR LF."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ...core.issues import InputError
from ...core.orientation import MOVING_XYZ, QUATERNION
from ...core.program import DEPOSIT, LINEAR_MOVE, Moves, Program, Six
from ...core.types import Array, Mask
from ..catalogue import plain
from ..parts import place
from ..refusals import speeds_within

# ---- Numbers in a RAPID module: joint values, quaternions, times, speeds, zones

ANGLE_DECIMALS, LENGTH_DECIMALS, TURN_DECIMALS = 4, 3, 7
# mm/s: minimum speed that three decimals resolve well, and RAPID's highest predefined speed (v7000)
SPEEDS = (0.01, 7000.0)
# s: shortest move within a bead, and shortest rapid
SHORTEST_MOVE_S, SHORTEST_RAPID = 0.0001, 0.001
# mm; maximum zone size; RAPID's largest predefined zone is 200
LARGEST_ZONE = 100.0
STOP = "fine"


class Pose(NamedTuple):
    """Position X Y Z in mm and quaternion w x y z, rounded as in the text."""

    position: tuple[float, ...]
    quaternion: tuple[float, ...]


def controller_values(joints: Array, slides: Mask) -> Array:
    """Convert joint values to the units and decimals of the text.

    Parameters
    ----------
    joints : (n, axes) array
        Joint values, rad or mm.
    slides : (axes,) bool array
        Prismatic axes.

    Returns
    -------
    (n, axes) array
        Degrees, mm for prismatic axes, rounded.
    """
    values = np.where(slides, joints, np.degrees(joints))
    rounded: Array = np.asarray(np.round(values, ANGLE_DECIMALS) + 0.0, dtype=np.float64)
    return rounded


def positions(position: Array) -> Array:
    """Round positions to the decimals of the text.

    Parameters
    ----------
    position : (n, 3) array
        mm.

    Returns
    -------
    (n, 3) array
        mm, rounded.
    """
    rounded: Array = np.asarray(np.round(position, LENGTH_DECIMALS) + 0.0, dtype=np.float64)
    return rounded


def quaternions(rotation: Array) -> Array:
    """Convert rotations to rounded quaternions.

    Parameters
    ----------
    rotation : (n, 3, 3) array
        Rotations.

    Returns
    -------
    (n, 4) array
        w x y z, rounded. Of the two equivalent quaternions, the result is the one whose first
        nonzero component is positive.
    """
    numbers = np.round(QUATERNION.numbers(rotation), TURN_DECIMALS)
    leading = numbers[np.arange(len(numbers)), np.argmax(numbers != 0.0, axis=1)]
    signed: Array = np.where(leading[:, None] < 0.0, -numbers, numbers) + 0.0
    return signed


def pose(six: Six | None) -> Pose:
    """Convert a frame X Y Z mm, RX RY RZ rad, with R = Rx Ry Rz; None gives the identity."""
    x, y, z, rx, ry, rz = (0.0,) * 6 if six is None else six
    rotation = MOVING_XYZ.rotations(np.array([[rx, ry, rz]]))
    return Pose(
        tuple(positions(np.array([x, y, z])).tolist()), tuple(quaternions(rotation)[0].tolist())
    )


class Words:
    """Build speed and zone of a program's moves, block by block in the order of motion."""

    def __init__(self, program: Program, speed: str, zone: str) -> None:
        self._blend, self._speed, self._zone = program.blend, speed, zone
        self.zones: dict[float, str] = {}

    def __call__(self, moves: Moves) -> Sequence[str]:
        """Return `v\\T:=time,zone` or `v\\V:=speed,zone` of each move. Raises InputError MOVE_SPEED
        or MOVE_TIME.
        """
        straight = moves.interpolation == LINEAR_MOVE
        letter, values = (
            ("V", [f"{v:.3f}" for v in speeds_within(moves, *SPEEDS).tolist()])
            if straight
            else ("T", [f"{t:.5f}" for t in _times(moves).tolist()])
        )
        rounded = self._rounded(moves)
        corners = [STOP if stops else rounded for stops in moves.stops.tolist()]
        return [
            f"{self._speed}\\{letter}:={value},{corner}"
            for value, corner in zip(values, corners, strict=True)
        ]

    def _rounded(self, moves: Moves) -> str:
        """Return the name of the corner zone, whose size is at most half the shortest move of the
        bead.
        """
        shortest = (
            float(np.nan_to_num(moves.speed * moves.duration).min())
            if moves.kind == DEPOSIT
            else 0.0
        )
        size = math.floor(1000.0 * min(0.005 * self._blend * shortest, LARGEST_ZONE)) / 1000.0
        if size <= 0.0:
            return STOP
        return self.zones.setdefault(size, f"{self._zone}{len(self.zones) + 1}")


def _times(moves: Moves) -> Array:
    seconds = np.where(np.isfinite(moves.duration), moves.duration, 0.0)
    if moves.kind == DEPOSIT and seconds.min() < SHORTEST_MOVE_S:
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "a move takes {:.3g} s, below the minimum of {:g} s; use a larger chord error or a "
            "lower speed",
            seconds.min(),
            SHORTEST_MOVE_S,
        )
    return np.maximum(seconds, SHORTEST_MOVE_S if moves.kind == DEPOSIT else SHORTEST_RAPID)


END_OF_LINE = "\r\n"
WIDTH = 80  # width of remarks

# data names in the modules of a program and its parts; declared LOCAL in each module
TOOL, WORK_OBJECT, SPEED, ZONE = "t_am", "w_am", "v_am", "z_am"
MAIN = "main"
# placeholder for absent external axes, and number of external axes
_NO_AXIS, MOST_AXES = "9E9", 6
# tip speed in mm/s, which every move overrides by its speed or time; deg/s and external axes as in
# RAPID's v1000
_SPEEDS = "500,5000,1000"
# identity frame; load of RAPID's tool0 in kg and mm
_NOWHERE = "[[0,0,0],[1,0,0,0]]"
_LOAD = "[0.001,[0,0,0.001],[1,0,0,0],0,0,0]"
_ANGLES = ",".join([f"%.{ANGLE_DECIMALS}f"] * 6)
_JOINTS = f"    %s [[{_ANGLES}],<axes>]\\NoEOffs,%s,{TOOL}\\WObj:={WORK_OBJECT};"
_POSE = f"[{','.join([f'%.{LENGTH_DECIMALS}f'] * 3)}],[{','.join([f'%.{TURN_DECIMALS}f'] * 4)}]"
# ConfL is off, so the controller takes the nearest configuration and ignores these values
_POSITION = f"    %s [{_POSE},[0,0,0,0],<axes>],%s,{TOOL}\\WObj:={WORK_OBJECT};"


def module(
    name: str, routine: str, remarks: Iterable[str], data: Iterable[str], lines: Iterable[str]
) -> bytes:
    """Return the file of a module with one routine.

    Parameters
    ----------
    name : str
        Name of the module.
    routine : str
        Name of the routine.
    remarks : iterable of str
        Description of the module.
    data : iterable of str
        Declarations.
    lines : iterable of str
        Indented lines of the routine.

    Returns
    -------
    bytes
        The content of the file.
    """
    text = [
        f"MODULE {name}",
        *(f"  {line}" for line in remarks),
        *(f"  {line}" for line in data),
        f"  PROC {routine}()",
        *lines,
        "  ENDPROC",
        "ENDMODULE",
    ]
    return (END_OF_LINE.join(text) + END_OF_LINE).encode("ascii")


def data(
    tool: Pose,
    work_object: Pose,
    part_held: bool,
    zones: Sequence[tuple[str, float]],
    unit: str = "",
) -> list[str]:
    """Return the declarations of tool, work object, speed and zones.

    Parameters
    ----------
    tool, work_object : Pose
        Tool frame and work object frame.
    part_held : bool
        Whether the robot carries the work object and the tool is fixed.
    zones : Sequence[tuple[str, float]]
        Names and sizes of the zones, mm.
    unit : str, optional
        The mechanical unit that carries the work object; '' for a fixed work object.

    Returns
    -------
    list of str
        The lines.
    """
    tool_held, object_held = ("FALSE", "TRUE") if part_held else ("TRUE", "FALSE")
    tool_pose, object_pose = (
        _POSE % (*pose.position, *pose.quaternion) for pose in (tool, work_object)
    )
    # a work object on a mechanical unit takes the unit's frame as user frame and ignores the text,
    # so the object frame is relative to the unit
    fixed, user, inside = (
        ("FALSE", _NOWHERE, f"[{object_pose}]") if unit else ("TRUE", f"[{object_pose}]", _NOWHERE)
    )
    return [
        f"LOCAL PERS tooldata {TOOL}:=[{tool_held},[{tool_pose}],{_LOAD}];",
        f'LOCAL PERS wobjdata {WORK_OBJECT}:=[{object_held},{fixed},"{unit}",{user},{inside}];',
        f"LOCAL CONST speeddata {SPEED}:={speed('1000')};",
        *(f"LOCAL CONST zonedata {zone}:={_zone(size)};" for zone, size in zones),
    ]


def speed(tip: str) -> str:
    """Return the speeddata for a TCP speed, mm/s, with the other speeds of RAPID's v1000."""
    return f"[{tip},{_SPEEDS}]"


def _zone(size: float) -> str:
    """Return the zonedata for `size` mm in the proportions of RAPID's z1: the same size for the
    orientation, and 0.1 deg per mm.
    """
    mm, degrees = f"{size:.3f}", f"{0.1 * size:.4f}"
    return f"[FALSE,{mm},{mm},{mm},{degrees},{mm},{degrees}]"


def joint_moves(degrees: Array, words: Sequence[str], first_external: int = 1) -> list[str]:
    """Return the lines of joint moves.

    Parameters
    ----------
    degrees : (n, 6 + k) array
        Values of the robot and k external axes, rounded.
    words : sequence of str
        Speed and zone of each move.
    first_external : int, optional
        Number of the first external axis, from 1.

    Returns
    -------
    list of str
        One line per move.
    """
    line = _JOINTS.replace("<axes>", _axes(degrees.shape[1] - 6, first_external))
    return _move_lines(line, "MoveAbsJ", degrees, words)


def linear_moves(
    position: Array,
    quaternion: Array,
    external: Array,
    words: Sequence[str],
    first_external: int = 1,
) -> list[str]:
    """Return the lines of linear moves.

    Parameters
    ----------
    position : (n, 3) array
        Positions, mm, rounded.
    quaternion : (n, 4) array
        Orientations w x y z, rounded.
    external : (n, k) array
        Values of external axes, rounded.
    words : sequence of str
        Speed and zone of each move.
    first_external : int, optional
        Number of the first external axis, from 1.

    Returns
    -------
    list of str
        One line per move.
    """
    line = _POSITION.replace("<axes>", _axes(external.shape[1], first_external))
    return _move_lines(line, "MoveL", np.hstack((position, quaternion, external)), words)


def _move_lines(line: str, instruction: str, values: Array, words: Sequence[str]) -> list[str]:
    """Return a line for each row of values (n, k) with its word; a word with process data contains
    the instruction.
    """
    split = [word.rpartition(" ") for word in words]
    rows = zip(values.tolist(), split, strict=True)
    return [
        line % (own_instruction or instruction, *row, word)
        for row, (own_instruction, _, word) in rows
    ]


def _axes(count: int, first_external: int) -> str:
    """Format `count` external axes, starting at number `first_external`."""
    formats = [_NO_AXIS] * (first_external - 1) + [f"%.{ANGLE_DECIMALS}f"] * count if count else []
    return f"[{','.join(formats + [_NO_AXIS] * (MOST_AXES - len(formats)))}]"


def activated(unit: str) -> list[str]:
    """Return the line that activates a mechanical unit; empty without a unit."""
    return [f"    ActUnit {unit};"] if unit else []


def remark(text: str) -> list[str]:
    """Wrap a comment in ASCII characters to the width of remarks."""
    return [f"! {line}" for line in textwrap.wrap(plain(text), WIDTH)]


def wait(seconds: float) -> list[str]:
    """Return the line of a wait, to 0.001 s; empty for 0 s."""
    return [f"    WaitTime {max(seconds, 0.001):.3f};"] if seconds > 0.0 else []


def load(folder: str, part_name: str) -> list[str]:
    """Return the lines that load the module of a part, run it and unload it."""
    path = f'"{folder}{part_name}.mod"'
    return [
        f"    Load \\Dynamic,{path};",
        f'    %"{routine_of(part_name)}"%;',
        f"    UnLoad {path};",
    ]


def routine_of(part_name: str) -> str:
    """Return the routine name of a part, which differs from the module name because routines of all
    modules share one scope.
    """
    return f"{part_name}_p"
