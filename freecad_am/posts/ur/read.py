# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read URScript back: model the controller from the program text alone.

Shares no code with the writer and evaluates nothing. Accepts only the lines that a path needs and
rejects everything else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import dataclasses
import re
from array import array
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from ...core.issues import InputError, Text
from ...core.read_moves import Event, ReadMoves
from ...core.types import Array
from ..read_lines import Lines

INSTRUCTIONS = frozenset(
    [
        "ENABLE_EXTERNAL_FT_SENSOR",
        "END_FORCE_MODE",
        "END_FREEDRIVE_MODE",
        "END_SCREW_DRIVING",
        "END_TEACH_MODE",
        "FORCE_MODE_STOP",
        "FREEDRIVE_MODE",
        "FT_RTDE_INPUT_ENABLE",
        "HALT",
        "PATH_OFFSET_DISABLE",
        "PATH_OFFSET_ENABLE",
        "POWERDOWN",
        "RESET_REVOLUTION_COUNTER",
        "RESET_WORLD_MODEL",
        "SOCKET_CLOSE",
        "STOP_CONVEYOR_TRACKING",
        "SYNC",
        "TEACH_MODE",
        "TOOL_CONTACT",
        "ZERO_FTSENSOR",
        "GET_STEPTIME",
        "IS_STEADY",
    ]
)


_N = r"-?\d+\.\d+"
_SIX = rf"\[({_N}), ({_N}), ({_N}), ({_N}), ({_N}), ({_N})\]"
_DEF = re.compile(r"def ([A-Za-z]\w*)\(\):$")
_CALL = re.compile(r"([A-Za-z]\w*)\(\)$")
_BY_JOINTS = re.compile(rf"movej\({_SIX}, a=1\.4, v=1\.05, t=({_N}), r=({_N})\)$")
_BY_POSE = re.compile(
    rf"movej\(get_inverse_kin\(pose_trans\(platform, p{_SIX}\), {_SIX}\), a=1\.4, v=1\.05, t=({_N}), r=({_N})\)$"
)
_LINEAR_MOVE = re.compile(rf"movep\(pose_trans\(platform, p{_SIX}\), a=1\.2, v=({_N}), r=({_N})\)$")
_TCP = re.compile(rf"set_tcp\(p{_SIX}\)$")
_PLATFORM = re.compile(rf"global platform = p{_SIX}$")
_OUTPUT = re.compile(r"set_(standard|configurable)_digital_out\(([0-7]), (True|False)\)$")
_REGISTER = re.compile(r"write_output_integer_register\((\d+), (\d+)\)$")
_SLEEP = re.compile(r"sleep\((\d+\.(\d+))\)$")
_INPUT = re.compile(r"while get_(standard|configurable)_digital_in\(([0-7])\) == False:$")
_BELOW = re.compile(r"while get_standard_analog_in\(([01])\) >= (-?\d+\.(\d+)):$")
_LAYER = re.compile(r"# layer (\d+)$")
_FIRST_PIN = {"standard": 1.0, "configurable": 9.0}  # number of pin 0


@dataclass
class _Line:
    number: int
    text: str


@dataclass
class _Function:
    """A function: its first line number, its lines, and its inner functions by name."""

    begins: int
    lines: list[_Line] = field(default_factory=list)
    inside: dict[str, _Function] = field(default_factory=dict)


# columns of each move: pose, joints, time, speed, radius
_COLUMNS = {
    "pose": slice(0, 6),
    "joints": slice(6, 12),
    "time": slice(12, 13),
    "speed": slice(13, 14),
    "blend": slice(14, 15),
}
_WIDTH = 15
_NONE = ("nan",) * 6


@dataclass
class _Run:
    """The state while functions are executed. decimals: the fewest decimals in each column."""

    file: str
    numbers: array[float] = field(default_factory=lambda: array("d"))
    decimals: dict[str, int] = field(default_factory=lambda: dict.fromkeys(_COLUMNS, 99))
    deposit: bytearray = field(default_factory=bytearray)
    events: list[Event] = field(default_factory=list)
    lines: Lines = field(default_factory=Lines)
    tcp: tuple[str, ...] = ()
    platform: tuple[str, ...] = ()
    output: float | None = None
    on: bool = False

    def happens(self, kind: str, *value: float | str, digits: float = 0.0) -> None:
        """Record an event before the next move."""
        self.events.append(Event(len(self.deposit), kind, value, digits))


def unreadable(where: str, why: str) -> InputError:
    """Return the error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves of the script in the order of execution.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    if len(files) != 1:
        raise unreadable("program", Text("{} files, but exactly one script is needed", len(files)))
    ((file, content),) = files.items()
    name, main = _parsed(file, content)
    if not re.fullmatch(rf"(?:.*/)?{name}\.script", file):
        raise unreadable(file, Text("the function in the file is called {}", name))
    run = _Run(file)
    _follow(name, main, {}, run, ())
    if not run.deposit:
        raise unreadable("program", "the program has no moves")
    return _moves(run)


def _parsed(file: str, content: bytes) -> tuple[str, _Function]:
    """Return the name of the script's function, and the function."""
    try:
        lines = content.decode("ascii").split("\n")
    except UnicodeDecodeError:
        raise unreadable(file, "the program contains characters other than ASCII") from None
    title = _DEF.match(lines[0])
    if title is None or len(lines) < 2 or lines[-2:] != ["end", ""]:
        raise unreadable(file, "the file is not a single function from its first line to its last")
    main = _Function(1)
    current_function, depth = main, 1
    for number, line in enumerate(lines[1:-2], 2):
        where = f"{file} line {number}"
        text = line[2 * depth :]
        if line[: 2 * depth].strip() or not text:
            if depth == 2 and line == "  end":
                current_function, depth = main, 1
                continue
            raise unreadable(where, Text("{!r} is outside its function", line))
        inner = _DEF.match(text)
        if inner is None:
            current_function.lines.append(_Line(number, text))
            continue
        if depth == 2 or inner[1] in main.inside or inner[1] == title[1]:
            raise unreadable(where, Text("{} is defined again, or within a part", inner[1]))
        current_function = main.inside[inner[1]] = _Function(number)
        depth = 2
    if depth == 2:
        raise unreadable(file, "a part of the program has no end")
    return title[1], main


def _follow(
    name: str,
    function: _Function,
    functions: dict[str, _Function],
    run: _Run,
    callers: tuple[str, ...],
) -> None:
    """Execute the lines of a function in order, and the functions that it calls."""
    lines = iter(function.lines)
    functions = {**functions, **function.inside}
    for line in lines:
        where, text = f"{run.file} line {line.number}", line.text
        if _move(text, run, where):
            continue
        if wait := _INPUT.match(text):
            _loop(lines, where)
            run.happens("input", _FIRST_PIN[wait[1]] + float(wait[2]))
        elif below := _BELOW.match(text):
            _loop(lines, where)
            run.happens(
                "below", 1.0 + float(below[1]), float(below[2]), digits=0.5 * 10.0 ** -len(below[3])
            )
        elif (call := _CALL.match(text)) and call[1].upper() not in INSTRUCTIONS:
            if call[1] in (*callers, name):
                raise unreadable(where, Text("{} calls itself", call[1]))
            if call[1] in functions and line.number < functions[call[1]].begins:
                raise unreadable(where, Text("{} is called before it is defined", call[1]))
            if call[1] in functions:
                _follow(call[1], functions[call[1]], functions, run, (*callers, name))
            else:
                run.happens("call", call[1].upper())
        else:
            _carry_out(text, run, where)


def _carry_out(text: str, run: _Run, where: str) -> None:
    for form, instruction in _INSTRUCTIONS.items():
        if match := form.match(text):
            instruction(match, run, where)
            return
    if not text.startswith("# "):
        raise unreadable(where, Text("the instruction {!r} is not understood", text))


def _switch(output: re.Match[str], run: _Run, where: str) -> None:
    """Switch the deposit by an output."""
    number = _FIRST_PIN[output[1]] + float(output[2])
    if run.output not in (None, number):
        raise unreadable(where, "the program switches a second output")
    run.output, run.on = number, output[3] == "True"
    run.happens("on" if run.on else "off", number, f"{output[1]}_digital_out")


def _schedule(register: re.Match[str], run: _Run, where: str) -> None:
    run.happens("schedule", float(register[1]), float(register[2]))


def _wait(sleep: re.Match[str], run: _Run, where: str) -> None:
    run.happens("wait", float(sleep[1]), digits=0.5 * 10.0 ** -len(sleep[2]))


def _layer(layer: re.Match[str], run: _Run, where: str) -> None:
    run.happens("layer", float(layer[1]))


_INSTRUCTIONS: dict[re.Pattern[str], Callable[[re.Match[str], _Run, str], None]] = {
    _OUTPUT: _switch,
    _REGISTER: _schedule,
    _SLEEP: _wait,
    _LAYER: _layer,
}


def _loop(lines: Iterator[_Line], where: str) -> None:
    """Consume a waiting loop, whose only line must take time."""
    inside, end = (next(lines, _Line(0, "")).text for _ in range(2))
    if not re.fullmatch(r"  sleep\(0\.\d*[1-9]\d*\)", inside) or end != "end":
        raise unreadable(where, "only a loop that waits is understood")


def _move(text: str, run: _Run, where: str) -> bool:
    """Execute a move, or a setting that must precede moves; return whether the line is either."""
    columns_read: tuple[str, ...]
    if move := _BY_JOINTS.match(text):
        columns_read = (*_NONE, *move.groups()[:6], move[7], "nan", move[8])
    elif move := _BY_POSE.match(text):
        columns_read = (*move.groups()[:13], "nan", move[14])
    elif move := _LINEAR_MOVE.match(text):
        columns_read = (*move.groups()[:6], *_NONE, "nan", move[7], move[8])
    else:
        frame = _TCP.match(text) or _PLATFORM.match(text)
        if frame is None:
            return False
        if run.deposit or (run.tcp if text.startswith("set_tcp") else run.platform):
            raise unreadable(where, "the program sets tool or platform a second time")
        if text.startswith("set_tcp"):
            run.tcp = frame.groups()
        else:
            run.platform = frame.groups()
        return True
    if not run.tcp or (columns_read[0] == "nan") is bool(run.platform):
        raise unreadable(
            where,
            "the program moves without a tool or platform, or in joint values where positions "
            "are given",
        )
    values = [float(number) for number in columns_read]
    if values[12] <= 0.0 or values[13] <= 0.0 or values[14] < 0.0:
        raise unreadable(where, "the robot cannot keep the time, speed or blend of the move")
    run.numbers.extend(values)
    run.deposit.append(run.on)
    run.lines.add(where)
    for name, columns in _COLUMNS.items():
        run.decimals[name] = min(run.decimals[name], _decimals(columns_read[columns]))
    return True


def _moves(run: _Run) -> ReadMoves:
    values = np.array(run.numbers).reshape(-1, _WIDTH)
    half = {name: 0.5 * 10.0**-decimals for name, decimals in run.decimals.items()}
    pose, joints, (duration, speed, radius) = values[:, :6], values[:, 6:12], values[:, 12:].T
    tool = np.broadcast_to(_poses(np.array([run.tcp], dtype=np.float64))[0], (len(values), 4, 4))
    moves = ReadMoves(
        joints,
        half["joints"],
        duration,
        np.array(run.deposit, dtype=np.bool_),
        np.isfinite(speed),
        radius == 0.0,
        tuple(run.events),
        speed=1000.0 * speed,
        speed_digits=1000.0 * half["speed"],
        duration_digits=np.full(len(values), half["time"]),
        blend_radius=1000.0 * radius,
        tool=tool,
        lines=run.lines.read(),
    )
    if not run.platform:
        return moves
    poses = _poses(pose)
    digits = max(half["pose"], 0.5 * 10.0 ** -_decimals((*run.tcp, *run.platform)))
    return dataclasses.replace(
        moves,
        joints=None,
        digits=0.0,
        near=joints,
        near_digits=half["joints"],
        position=poses[:, :3, 3],
        rotation=poses[:, :3, :3],
        position_digits=1000.0 * digits,
        rotation_digits=digits,
        frame=_poses(np.array([run.platform], dtype=np.float64))[0],
    )


def _decimals(texts: tuple[str, ...]) -> int:
    """Return the fewest decimals of any number; a large value without numbers."""
    return 99 if texts[0] == "nan" else min(len(text) - text.index(".") - 1 for text in texts)


def _poses(values: Array) -> Array:
    """Convert positions, m, and rotation vectors (n, 6) to poses (n, 4, 4), mm, by Rodrigues' formula."""
    angle = np.linalg.norm(values[:, 3:], axis=1)
    x, y, z = (values[:, 3:] / np.where(angle > 0.0, angle, 1.0)[:, None]).T
    none = np.zeros(len(values))
    cross = np.stack([none, -z, y, z, none, -x, -y, x, none], axis=1).reshape(-1, 3, 3)
    sine, versine = np.sin(angle)[:, None, None], (1.0 - np.cos(angle))[:, None, None]
    matrices = np.tile(np.eye(4), (len(values), 1, 1))
    matrices[:, :3, :3] += sine * cross + versine * (cross @ cross)
    matrices[:, :3, 3] = 1000.0 * values[:, :3]
    return matrices
