# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read RAPID modules back: model the controller from the program text alone.

Shares no code with the writer. Accepts only the instructions that a path needs and rejects
everything else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...core.issues import Text
from ...core.read_moves import ARC, ReadMoves
from .columns import Move, Run, all_moves
from .modules import Module, ProcessData, modules, unreadable
from .read_process import INSTRUCTIONS, JOINTS, POSITION, process_move, straight

_TAIL = r",(\w+)\\([TV]):=(\d+\.(\d+)),(\w+),(\w+)\\WObj:=(\w+);$"
_JOINT = re.compile(rf"MoveAbsJ {JOINTS}{_TAIL}")
_LINEAR = re.compile(rf"MoveL {POSITION}{_TAIL}")
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


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with the routine `main`.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    by_name = modules(files)
    main_modules = [module for module in by_name.values() if module.routine.lower() == _ROUTINE]
    if len(main_modules) != 1:
        raise unreadable(
            "program",
            Text("{} modules have a routine main, but exactly one module must", len(main_modules)),
        )
    run = Run(by_name, slides=main_modules[0].slides)
    _follow(main_modules[0], run)
    if not run.time_or_speed:
        raise unreadable("program", "the program has no moves")
    if len(run.followed) != len(by_name):
        raise unreadable("program", "some modules never run, or run twice")
    if run.moving:
        raise unreadable("program", "the program ends before its last move")
    return all_moves(run)


def _follow(module: Module, run: Run) -> None:
    """Execute the statements of a routine in order, and the parts that it loads."""
    run.followed.append(module.name)
    run.nearest, run.active, run.process_data = (
        False,
        "",
        ProcessData(),
    )  # each part sets this itself because it may run separately
    activated = ("", -1)
    lines = iter(module.statements)
    for number, line in lines:
        where = f"{module.file} line {number}"
        move = _JOINT.match(line) or _LINEAR.match(line)
        if move:
            _move(module, move, run, where)
        elif process_move(line, module, run, where):
            continue
        elif layer := _LAYER.match(line):
            run.happens("layer", float(layer[1]))
        elif line == r"ConfL\Off;":
            run.nearest = True
        elif (active := _ACTIVE.match(line)) and not run.moving and not run.active:
            run.active, activated = active[1], (where, len(run.time_or_speed))
        elif line.startswith("!") or line == r"SingArea\Off;":
            continue
        elif run.moving:
            raise unreadable(where, Text("{!r} runs before the previous move ends", line))
        elif load := _LOAD.match(line):
            _load(module, load[1], lines, run, where)
        elif not run.process_data.understood(line, module, where):
            _other(line, run, where)
    if activated[1] == len(run.time_or_speed):
        raise unreadable(activated[0], Text("{} is activated, but no move follows", run.active))


def _load(
    module: Module, part_name: str, lines: Iterator[tuple[int, str]], run: Run, where: str
) -> None:
    """Read the lines that load, run and unload a part; the robot must not deposit meanwhile."""
    number, called = next(lines, (0, ""))
    name, loaded = _RUN.match(called), run.modules.get(part_name.lower())
    if name is None:
        place_of_line = f"{module.file} line {number}"
        raise unreadable(
            place_of_line,
            Text("{!r} follows, but the loaded {} must run first", called, part_name),
        )
    number, gone = next(lines, (0, ""))
    if gone != f'UnLoad "HOME:/{part_name}.mod";':
        place_of_line = f"{module.file} line {number}"
        raise unreadable(
            place_of_line, Text("{!r} follows, but {} must be unloaded first", gone, part_name)
        )
    if (
        loaded is None
        or loaded.routine.lower() != name[1].lower()
        or loaded.name in run.followed
        or run.on
    ):
        raise unreadable(
            where,
            Text(
                "{} is missing, has no routine {}, has already run, or is loaded during the "
                "deposit",
                part_name,
                name[1],
            ),
        )
    _follow(loaded, run)


def _other(line: str, run: Run, where: str) -> None:
    if output := _OUTPUT.match(line):
        run.keep_switch(output[1], output[2] == "1", "do", where)
    elif group := _GROUP.match(line):
        run.happens("schedule", float(group[1]), float(group[2]))
    elif wait := _WAIT.match(line):
        straight(run)
        run.happens("wait", float(wait[1]), digits=0.5 * 10.0 ** -len(wait[2]))
    elif input_wait := _INPUT.match(line):
        run.happens("input", float(input_wait[1]))
    elif cool := _COOL.match(line):
        run.happens("below", float(cool[1]), float(cool[2]), digits=1e-6)
    elif (call := _CALL.match(line)) and call[1].upper() not in INSTRUCTIONS:
        if any(
            call[1].lower() in (module.routine.lower(), module.name)
            for module in run.modules.values()
        ):
            raise unreadable(
                where,
                Text("{} names a module or routine of the program that is not loaded", call[1]),
            )
        run.happens("call", call[1].upper())
    else:
        raise unreadable(where, Text("the instruction {!r} is not understood", line))


def _move(module: Module, move: re.Match[str], run: Run, where: str) -> None:
    linear = move.re is _LINEAR
    *values, axes, speed, letter, amount, decimals, zone, tool, work_object = move.groups()
    if speed not in module.speeds or (letter == "V") != linear:
        raise unreadable(
            where,
            Text(
                "the module does not define the speed {}, or the speed is set by an argument "
                "other than \\T or \\V",
                speed,
            ),
        )
    if run.on and run.output == ARC:
        raise unreadable(
            where, "the arc is on during a move that is not an arc welding instruction"
        )
    frames = module.tool_and_object(tool, work_object, where)
    half = 0.5 * 10.0 ** -len(decimals)
    run.keep_move(
        module, Move(linear, tuple(values), axes, float(amount), half, zone, frames), where
    )
