# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parse the modules of a RAPID program: data, and the statements of routines, but no motion."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...core.issues import InputError, Text
from ...core.types import Array

_DECLARED = re.compile(
    r"LOCAL (?:PERS (tooldata|wobjdata|welddata)|CONST (speeddata|zonedata)) (\w+):=(\[.*\]);$"
)
_TRIGGER = re.compile(r"LOCAL VAR triggdata (\w+);$")
_TIP = re.compile(r"\[\d+(?:\.(\d+))?,")
_TRACK = re.compile(r"! eax_([a-f]) is the track in mm\b")
_MODULE_LINE, _PROC_LINE = (
    re.compile(r"MODULE ([A-Za-z]\w*)$"),
    re.compile(r"PROC ([A-Za-z]\w*)\(\)$"),
)
# deg/s of the tool, mm/s and deg/s of external axes; minimum speeddata, as in RAPID's v1000, so
# that moves are not slowed down
_FAST = 500.0, 5000.0, 1000.0
_NO_ARC = [0] * 9


@dataclass(frozen=True, eq=False)
class Frames:
    """A tool and a work object, (4, 4) in the world or on the flange.

    part_held: the robot carries the work object, and the tool is fixed. unit: the mechanical unit
    that carries the work object; '' for a fixed work object.
    """

    tool: Array
    work_object: Array
    part_held: bool
    unit: str = ""

    def same(self, module_frames: Frames) -> bool:
        """Whether the frames equal those of another module exactly."""
        alike = np.array_equal(self.tool, module_frames.tool) and np.array_equal(
            self.work_object, module_frames.work_object
        )
        return alike and (self.part_held, self.unit) == (
            module_frames.part_held,
            module_frames.unit,
        )


@dataclass
class Module:
    """A file with one routine.

    statements: lines of the routine with their numbers. slides: numbers of the external axes that a
    remark marks as the track. speeds: tip speeds, mm/s. halves: half of the last digit of each
    speed. welds: speeds in weld data, mm/s.
    """

    file: str
    name: str
    routine: str
    statements: list[tuple[int, str]]
    tools: dict[str, tuple[bool, Array]] = field(default_factory=dict)
    objects: dict[str, tuple[bool, Array]] = field(default_factory=dict)
    speeds: dict[str, float] = field(default_factory=dict)
    halves: dict[str, float] = field(default_factory=dict)
    welds: dict[str, float] = field(default_factory=dict)
    triggers: set[str] = field(default_factory=set)
    zones: dict[str, float] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    slides: tuple[int, ...] = ()
    _paired: dict[tuple[str, str], Frames] = field(default_factory=dict)

    def tool_and_object(self, tool: str, work_object: str, where: str) -> Frames:
        """Return the frames of a tool and a work object.

        Parameters
        ----------
        tool, work_object : str
            Names of the data.
        where : str
            File and line, for messages.

        Returns
        -------
        Frames
            The frames; the robot carries exactly one of the two.

        Raises
        ------
        InputError
            UNREADABLE_PROGRAM for unknown names, or if the robot carries both or neither.
        """
        if (tool, work_object) not in self._paired:
            if tool not in self.tools or work_object not in self.objects:
                raise unreadable(
                    where,
                    Text(
                        "the module does not define the tool {} or the work object {}",
                        tool,
                        work_object,
                    ),
                )
            (on_robot, tool_pose), (object_held, object_pose) = (
                self.tools[tool],
                self.objects[work_object],
            )
            if on_robot == object_held:
                raise unreadable(
                    where,
                    "the robot must carry either the tool or the work object, not both or neither",
                )
            self._paired[tool, work_object] = Frames(
                tool_pose, object_pose, object_held, self.units[work_object]
            )
        return self._paired[tool, work_object]


def modules(files: dict[str, bytes]) -> dict[str, Module]:
    """Parse the modules by lower-case name. Raises InputError UNREADABLE_PROGRAM."""
    by_name: dict[str, Module] = {}
    for file in sorted(files):
        module = _module(file, files[file].decode("latin-1").replace("\r\n", "\n").split("\n"))
        if module.name in by_name or f"{module.name}.mod" != file.lower():
            raise unreadable(
                file,
                Text(
                    "the module is called {}, but the file has another name, or another module "
                    "has the same name",
                    module.name,
                ),
            )
        by_name[module.name] = module
    return by_name


def _module(file: str, lines: list[str]) -> Module:
    numbered = [(number, line.strip()) for number, line in enumerate(lines, 1) if line.strip()]
    routines = [k for k, (_, line) in enumerate(numbered) if _PROC_LINE.match(line)]
    title = _MODULE_LINE.match(numbered[0][1]) if numbered else None
    if (
        title is None
        or len(routines) != 1
        or [line for _, line in numbered[-2:]] != ["ENDPROC", "ENDMODULE"]
    ):
        raise unreadable(file, "the file is not a module with one routine")
    routine = _PROC_LINE.match(numbered[routines[0]][1])
    assert routine is not None
    module = Module(file, title[1].lower(), routine[1], numbered[routines[0] + 1 : -2])
    for number, line in numbered[1 : routines[0]]:
        if track := _TRACK.match(line):
            module.slides += ("abcdef".index(track[1]) + 1,)
        elif not line.startswith("!"):
            _declare(module, line, f"{file} line {number}")
    return module


def _declare(module: Module, line: str, where: str) -> None:
    declared, trigger = _DECLARED.match(line), _TRIGGER.match(line)
    names = {
        *module.tools,
        *module.objects,
        *module.speeds,
        *module.zones,
        *module.welds,
        *module.triggers,
    }
    if trigger and trigger[1] not in names:
        module.triggers.add(trigger[1])
        return
    if declared is None or declared[3] in names:
        raise unreadable(where, Text("{!r} is not understood, or declares a name twice", line))
    try:
        value = json.loads(declared[4].replace("TRUE", "true").replace("FALSE", "false"))
        _keep(module, declared[1] or declared[2], declared[3], value)
        if tip := _TIP.match(declared[4]):
            module.halves[declared[3]] = 0.5 * 10.0 ** -len(tip[1] or "")
    except (ValueError, TypeError):
        raise unreadable(where, Text("the value of {} is not understood", declared[3])) from None


def _keep(module: Module, kind: str, name: str, value: Any) -> None:
    """Store a value under its name. Raises ValueError or TypeError if the value cannot be read."""
    if kind == "tooldata":
        is_held, pose, (_mass, _centre, _axes, _x, _y, _z) = value
        module.tools[name] = _truth(is_held), _pose(pose)
    elif kind == "wobjdata":
        is_held, fixed, unit, user, inside = value
        moved = (
            _truth(fixed) is False
        )  # carried by the mechanical unit, whose frame takes precedence over the user frame
        written = moved and not np.array_equal(_pose(user), np.eye(4))
        if moved != bool(unit) or not isinstance(unit, str) or written:
            raise ValueError
        module.objects[name], module.units[name] = (
            (_truth(is_held), _pose(user) @ _pose(inside)),
            unit,
        )
    elif kind == "speeddata":
        tip, *speeds = map(float, value)
        if any(speed_value < lowest for speed_value, lowest in zip(speeds, _FAST, strict=True)):
            raise ValueError
        module.speeds[name] = tip
    elif kind == "welddata":
        speed, original, *arcs = value
        if speed != original or arcs != [_NO_ARC, _NO_ARC]:
            raise ValueError
        module.welds[name] = float(speed)
    else:
        stops, tip, orientation, axes, turn, along, about = value
        if (
            stops is not False
            or not tip == orientation == axes == along > 0.0
            or not 0.0 < turn == about <= 0.2 * tip
        ):
            raise ValueError
        module.zones[name] = float(tip)


def _truth(value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError
    return value


def _pose(value: Any) -> Array:
    """Convert [[x,y,z],[q1,q2,q3,q4]] to a pose (4, 4)."""
    position, turn = (np.array(numbers, dtype=np.float64) for numbers in value)
    if position.shape != (3,) or turn.shape != (4,) or abs(np.linalg.norm(turn) - 1.0) > 1e-5:
        raise ValueError
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = (
        rotation_of_quaternions(turn[None] / np.linalg.norm(turn))[0],
        position,
    )
    return pose


def rotation_of_quaternions(quaternion: Array) -> Array:
    """Convert unit quaternions to rotations.

    Parameters
    ----------
    quaternion : (n, 4) array
        w x y z.

    Returns
    -------
    (n, 3, 3) array
        Rotations.
    """
    w, v = quaternion[:, 0], quaternion[:, 1:]
    across = np.zeros((len(v), 3, 3))
    across[:, 0, 1], across[:, 0, 2], across[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    across -= np.swapaxes(across, 1, 2)
    # v' = v + 2 w (u x v) + 2 u x (u x v)
    rotations: Array = np.eye(3) + 2.0 * w[:, None, None] * across + 2.0 * across @ across
    return rotations


def unreadable(where: str, why: str) -> InputError:
    """Return the error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)


_TAKEN = re.compile(r"(\w+):=weld([1-9]\d*);$")
_SPEED = re.compile(r"(\w+)\.(org_)?weld_speed:=(\d+\.(\d+));$")
_SWITCH = re.compile(r"TriggIO (\w+),(\d+(?:\.(\d+))?)\\DOp:=do(\d+),([01]);$")
_FEED = re.compile(r"TriggSpeed (\w+),0\\Start,0,ao(\d+),(\d+(?:\.(\d+))?)(?:E([-+]\d+))?;$")
_FEED_END = re.compile(r"TriggSpeed (\w+),0,0,ao(\d+),0;$")


@dataclass
class Weld:
    """Weld data of a module: the controller's weld data that it copies, and its speed, mm/s, with
    half of the last digit.
    """

    schedule: int
    speed: float | None = None
    half: float = 0.0
    original: float | None = None


@dataclass(frozen=True)
class Switch:
    """A digital output that switches `distance` mm of tip path before the end of a move.

    digits: half of the last digit of the distance.
    """

    output: str
    on: bool
    distance: float
    digits: float


@dataclass(frozen=True)
class Feed:
    """An analogue output that follows the tip speed, mm/s, from the start of a move on; scale 0
    ends it.
    """

    output: int
    scale: float
    digits: float


@dataclass
class ProcessData:
    """The process data of a module read so far, by name."""

    welds: dict[str, Weld] = field(default_factory=dict)
    triggers: dict[str, Switch | Feed] = field(default_factory=dict)

    def understood(self, line: str, module: Module, where: str) -> bool:
        """Read the process data of a line.

        Parameters
        ----------
        line : str
            The line.
        module : Module
            Module that contains the line.
        where : str
            File and line, for messages.

        Returns
        -------
        bool
            Whether the line has process data.

        Raises
        ------
        InputError
            UNREADABLE_PROGRAM for wrong data.
        """
        if taken_weld := _TAKEN.match(line):
            if taken_weld[1] not in module.welds or taken_weld[1] in self.welds:
                raise unreadable(
                    where,
                    "the weld data copied from the controller is not declared in the module, or "
                    "is copied twice",
                )
            self.welds[taken_weld[1]] = Weld(int(taken_weld[2]))
        elif speed := _SPEED.match(line):
            self._keep_speed(speed, module, where)
        elif switch := _SWITCH.match(line):
            digits = 0.5 * 10.0 ** -len(switch[3]) if switch[3] else 0.0
            trigger = Switch(switch[4], switch[5] == "1", float(switch[2]), digits)
            self._keep_trigger(switch[1], trigger, module, where)
        elif feed := _FEED.match(line):
            power = 10.0 ** int(feed[5] or 0)
            digits = 0.5 * 10.0 ** -len(feed[4] or "") * power
            self._keep_trigger(
                feed[1], Feed(int(feed[2]), float(feed[3]) * power, digits), module, where
            )
        elif end := _FEED_END.match(line):
            self._keep_trigger(end[1], Feed(int(end[2]), 0.0, 0.0), module, where)
        else:
            return False
        return True

    def _keep_speed(self, speed: re.Match[str], module: Module, where: str) -> None:
        weld, value = self.welds.get(speed[1]), float(speed[3])
        if (
            weld is None
            or value != module.welds[speed[1]]
            or (weld.original if speed[2] else weld.speed) is not None
        ):
            raise unreadable(
                where,
                "weld data is not copied from the controller yet, or its speed is set twice or "
                "differs from its declaration",
            )
        if speed[2]:
            weld.original = value
        else:
            weld.speed, weld.half = value, 0.5 * 10.0 ** -len(speed[4])

    def _keep_trigger(self, name: str, trigger: Switch | Feed, module: Module, where: str) -> None:
        if name not in module.triggers or name in self.triggers:
            raise unreadable(where, "a trigger is not declared in the module, or is set twice")
        self.triggers[name] = trigger
