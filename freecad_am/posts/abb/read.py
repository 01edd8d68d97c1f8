# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads RAPID modules back: what the controller would do, from the text alone.

Shares nothing with the writer. Understands the plain instructions a path needs and refuses every other one, so
that no motion can hide in what was not understood.
"""

from __future__ import annotations

import dataclasses
import re
from array import array
from dataclasses import dataclass, field

import numpy as np

from freecad_am.core.types import Array

from ...core.issues import Text
from ...core.read_moves import Event, ReadMoves
from .modules import Frames, Module, modules, turned, unreadable

_N = r"-?\d+\.\d+"
_AXES = rf"\[((?:(?:9E9|{_N}),){{5}}(?:9E9|{_N}))\]"
_TAIL = r",(\w+)\\([TV]):=(\d+\.(\d+)),(\w+),(\w+)\\WObj:=(\w+);$"
_JOINT = re.compile(rf"MoveAbsJ \[\[({','.join([_N] * 6)})\],{_AXES}\]\\NoEOffs{_TAIL}")
_PLACE, _TURN = (f"\\[({','.join([_N] * count)})\\]" for count in (3, 4))
_LINEAR = re.compile(rf"MoveL \[{_PLACE},{_TURN},\[0,0,0,0\],{_AXES}\]{_TAIL}")
_DECIMALS = re.compile(r"\.(\d+)")
_OUTPUT = re.compile(r"SetDO do(\d+),([01]);$")
_GROUP = re.compile(r"SetGO go(\d+),(\d+);$")
_WAIT = re.compile(r"WaitTime (\d+\.(\d+));$")
_INPUT = re.compile(r"WaitDI di(\d+),1;$")
_COOL = re.compile(r"WaitAI ai(\d+),\\LT,(-?\d+(?:\.\d+)?);$")
_LAYER = re.compile(r"! layer (\d+)$")
_LOAD = re.compile(r'Load \\Dynamic,"HOME:/(\w+)\.mod";$')
_RUN = re.compile(r'%"(\w+)"%;$')
_ACTIVE = re.compile(r"ActUnit (\w+);$")
_CALL = re.compile(r"([A-Za-z]\w*);$")
_ROUTINE = "main"


def _floats() -> array[float]:
    return array("d")


@dataclass
class _Run:
    """What happened so far while the routines are followed, column by column. beside: axes beside the robot as they stand,
    of which those `used` have values, `unit` theirs, and `slides` those that a remark calls the track; active: the
    mechanical unit that the module has activated.

    time_or_speed: s of joint moves, mm/s of linear ones, half: of its last digit. rounding: mm, NaN of moves that stop.
    joints, places, turns: the numbers of a move as they stand. nearest: ConfL is off, and positions are taken as the arm
    reaches them best.
    """

    found: dict[str, Module]
    linear: bytearray = field(default_factory=bytearray)
    deposit: bytearray = field(default_factory=bytearray)
    time_or_speed: array[float] = field(default_factory=_floats)
    half: array[float] = field(default_factory=_floats)
    rounding: array[float] = field(default_factory=_floats)
    joints: list[str] = field(default_factory=list)
    places: list[str] = field(default_factory=list)
    turns: list[str] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    followed: list[str] = field(default_factory=list)
    frames: Frames | None = None
    external: list[str] = field(default_factory=list)
    used: tuple[int, ...] | None = None
    unit: str = ""
    slides: tuple[int, ...] = ()
    active: str = ""
    output: str = ""
    on: bool = False
    nearest: bool = False

    @property
    def moving(self) -> bool:
        """Whether the last move passes through its end."""
        return bool(self.time_or_speed) and not np.isnan(self.rounding[-1])

    def happens(self, kind: str, *value: float | str, digits: float = 0.0) -> None:
        """Something happens before the next move."""
        self.events.append(Event(len(self.time_or_speed), kind, value, digits))


def read(files: dict[str, bytes]) -> ReadMoves:
    """All moves of the files in the order of execution, beginning with the routine `main`.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    found = modules(files)
    first = [module for module in found.values() if module.routine.lower() == _ROUTINE]
    if len(first) != 1:
        raise unreadable("program", Text("{} modules have a routine main, expected one", len(first)))
    run = _Run(found, slides=first[0].slides)
    _follow(first[0], run)
    if not run.time_or_speed:
        raise unreadable("program", "there are no moves")
    if len(run.followed) != len(found):
        raise unreadable("program", "there are modules that are never run, or run twice")
    if run.moving:
        raise unreadable("program", "it ends before the last move does")
    return _moves(run)


def _follow(module: Module, run: _Run) -> None:
    """Carry out the statements of a routine in order, and of those of the parts that it loads."""
    run.followed.append(module.name)
    run.nearest, run.active = False, ""  # each says it for itself: it may be run alone
    lines = iter(module.statements)
    for number, line in lines:
        where = f"{module.file} line {number}"
        move = _JOINT.match(line) or _LINEAR.match(line)
        if move:
            _move(module, move, run, where)
        elif layer := _LAYER.match(line):
            run.happens("layer", float(layer[1]))
        elif line == r"ConfL\Off;":
            run.nearest = True
        elif (active := _ACTIVE.match(line)) and not run.moving and not run.active:
            run.active = active[1]
        elif line.startswith("!") or line == r"SingArea\Off;":
            continue
        elif run.moving:
            raise unreadable(where, Text("{!r} is reached before the move before it ends", line))
        elif load := _LOAD.match(line):
            (_, called), (_, gone) = next(lines, (0, "")), next(lines, (0, ""))
            _load(module, load[1], called, gone, run, where)
        else:
            _other(line, run, where)


def _load(module: Module, part: str, called: str, gone: str, run: _Run, where: str) -> None:
    """A part is loaded, run and removed; the robot must not deposit meanwhile."""
    name, loaded = _RUN.match(called), run.found.get(part.lower())
    if name is None or gone != f'UnLoad "HOME:/{part}.mod";':
        raise unreadable(where, Text("{} is loaded without being run and removed", part))
    if loaded is None or loaded.routine.lower() != name[1].lower() or loaded.name in run.followed or run.on:
        raise unreadable(where, Text("{} is not there, has no routine {}, is run already, or loaded while depositing", part,
                                     name[1]))
    _follow(loaded, run)


def _other(line: str, run: _Run, where: str) -> None:
    if output := _OUTPUT.match(line):
        if run.output not in ("", output[1]):
            raise unreadable(where, "a second output is switched")
        run.output, run.on = output[1], output[2] == "1"
        run.happens("on" if run.on else "off", float(output[1]), "do")
    elif group := _GROUP.match(line):
        run.happens("schedule", float(group[1]), float(group[2]))
    elif wait := _WAIT.match(line):
        run.happens("wait", float(wait[1]), digits=0.5 * 10.0 ** -len(wait[2]))
    elif given := _INPUT.match(line):
        run.happens("input", float(given[1]))
    elif cool := _COOL.match(line):
        run.happens("below", float(cool[1]), float(cool[2]), digits=1e-6)
    elif call := _CALL.match(line):
        if any(call[1].lower() in (module.routine.lower(), module.name) for module in run.found.values()):
            raise unreadable(where, Text("{} is a module or a routine of this program and is not loaded", call[1]))
        run.happens("call", call[1].upper())
    else:
        raise unreadable(where, Text("the instruction {!r} is not understood", line))


def _move(module: Module, move: re.Match[str], run: _Run, where: str) -> None:
    linear = move.re is _LINEAR
    *values, speed, letter, amount, decimals, zone, tool, work_object = move.groups()
    if linear and not run.nearest:
        raise unreadable(where, "the configurations that its positions name are supervised, and are none")
    if speed not in module.speeds or (letter == "V") != linear:
        raise unreadable(where, Text("{} is not a speed of the module, or the move is told otherwise than by \\T or \\V",
                                     speed))
    if zone != "fine" and zone not in module.zones:
        raise unreadable(where, Text("{} is not a zone of the module", zone))
    frames = module.tool_and_object(tool, work_object, where)
    if run.frames is None:
        run.frames = frames
    elif frames is not run.frames and not frames.same(run.frames):
        raise unreadable(where, "moves of more than one tool or work object are mixed")
    _external_axes(values.pop().split(","), frames, run, where)
    for column, value in zip((*((run.places, run.turns) if linear else (run.joints,)),), values, strict=True):
        column.append(value)
    run.linear.append(linear)
    run.deposit.append(run.on)
    run.time_or_speed.append(float(amount))
    run.half.append(0.5 * 10.0 ** -len(decimals))
    run.rounding.append(np.nan if zone == "fine" else module.zones[zone])


def _external_axes(texts: list[str], frames: Frames, run: _Run, where: str) -> None:
    """Keep the values of the axes beside the robot: of the same ones in all moves, those of the unit that the work object is
    on, which is active, and the track. Where the work object stands, the track is the only one."""
    used = tuple(number for number, text in enumerate(texts, 1) if text != "9E9")
    if used != tuple(range(used[0], used[0] + len(used)) if used else ()) or run.used not in (None, used):
        raise unreadable(where, "other axes beside the robot have values than in moves before, or not all in a row")
    if len(run.slides) > 1 or not {*run.slides} <= {*used}:
        raise unreadable(where, "more than one axis is called the track, or it has no value")
    moved = set(used) - set(run.slides)
    if bool(moved) != bool(frames.unit) or (run.active != frames.unit and (moved or not used)):
        raise unreadable(where, "axes beside the robot have no value, or their unit is not active, or not the object's")
    if run.used is not None and run.unit != run.active:
        raise unreadable(where, "another unit is active than in moves before")
    run.used, run.unit = used, run.active
    run.external += [",".join(texts[number - 1] for number in used)] if used else []


def _moves(run: _Run) -> ReadMoves:
    linear, deposit = (np.array(column, dtype=np.bool_) for column in (run.linear, run.deposit))
    time_or_speed, half, rounding = np.array(run.time_or_speed), np.array(run.half), np.array(run.rounding)
    used = run.used or ()
    joints = np.full((len(time_or_speed), 6 + len(used)), np.nan)
    joints[~linear, :6] = np.radians(_numbers(run.joints, 6))
    if used:
        external = _numbers(run.external, len(used))
        joints[:, 6:] = np.where(np.isin(used, run.slides), external, np.radians(external))
    turning = run.joints if used == run.slides else run.joints + run.external
    read_moves = ReadMoves(
        None if np.isnan(joints).all() else joints, float(np.radians(_half_digit(turning))),
        np.where(linear, np.nan, time_or_speed),
        deposit, linear, np.isnan(rounding), tuple(run.events), speed=np.where(linear, time_or_speed, np.nan),
        speed_digits=float(half[linear].max(initial=0.0)), duration_digits=half, rounding=rounding,
        unit=run.unit if used else "", first_external=used[0] if used else 1,
        linear_digits=_half_digit(run.external) if run.slides else 0.0,
    )
    return _seen(read_moves, run) if linear.any() else read_moves


def _seen(read_moves: ReadMoves, run: _Run) -> ReadMoves:
    """With the positions of the tool in the work object. A work object that the robot holds is what it takes to the tool:
    its position seen from there is that of the tool in it, turned about."""
    used, linear = run.frames, read_moves.linear
    assert used is not None
    turns = _numbers(run.turns, 4)
    length = np.linalg.norm(turns, axis=1)
    if (np.abs(length - 1.0) > 1e-5).any():
        raise unreadable("program", "the four numbers of an orientation are not those of a unit quaternion")
    place, rotation = np.full((len(linear), 3), np.nan), np.full((len(linear), 3, 3), np.nan)
    place[linear], rotation[linear] = _numbers(run.places, 3), turned(turns / length[:, None])
    if used.held:
        rotation = np.swapaxes(rotation, 1, 2)
        place = -np.einsum("nij,nj->ni", rotation, place)
    stands, carried = (used.tool, used.work_object) if used.held else (used.work_object, used.tool)
    return dataclasses.replace(
        read_moves, position=place, rotation=rotation, position_digits=_half_digit(run.places),
        # four numbers, each off by half a digit, turn by at most four of these: as much as three angles of so much
        rotation_digits=4.0 / 3.0 * _half_digit(run.turns), frame=stands,
        tool=np.broadcast_to(carried, (len(linear), 4, 4)), held=used.held,
    )


def _numbers(texts: list[str], columns: int) -> Array:
    """(n, columns) of the numbers of texts."""
    return np.array(",".join(texts).split(",") if texts else [], dtype=np.float64).reshape(-1, columns)


def _half_digit(texts: list[str]) -> float:
    """Half of the last digit of numbers, 0 where there are none."""
    return 0.5 * 10.0 ** -min(map(len, _DECIMALS.findall(" ".join(texts))), default=99)
