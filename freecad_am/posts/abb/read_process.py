# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read RAPID moves with process data: arc welding instructions, and moves with triggers."""

from __future__ import annotations

import re

import numpy as np

from ...core.issues import Text
from ...core.read_moves import ARC
from .columns import Move, Run
from .modules import Feed, Module, Switch, Weld, unreadable

INSTRUCTIONS = frozenset(
    [
        "ACTEVENTBUFFER",
        "ARCKILL",
        "ARCREFRESH",
        "BREAK",
        "CLEARPATH",
        "CORNERPATH",
        "CORRCLEAR",
        "DEACTEVENTBUFFER",
        "DITHERDEACT",
        "EOFFSOFF",
        "EXIT",
        "EXITCYCLE",
        "HOLLOWWRISTRESET",
        "IDISABLE",
        "IENABLE",
        "MTOOLROTCALIB",
        "PATHRECSTOP",
        "PDISPOFF",
        "PFRESTART",
        "RAISE",
        "RAISETOUSER",
        "RESETRETRYCOUNT",
        "RESTOPATH",
        "RETRY",
        "RETURN",
        "SAVECFGDATA",
        "SOFTDEACT",
        "SPYSTOP",
        "STARTMOVE",
        "STARTMOVERETRY",
        "STOP",
        "STOPMOVE",
        "STOPMOVERESET",
        "STOREPATH",
        "SYNCMOVERESUME",
        "SYNCMOVESUSPEND",
        "SYNCMOVEUNDO",
        "TESTSIGNRESET",
        "TPERASE",
        "TRYNEXT",
        "WAITROB",
        "WARMSTART",
    ]
)


_N = r"-?\d+\.\d+"
AXES = rf"\[((?:(?:9E9|{_N}),){{5}}(?:9E9|{_N}))\]"
JOINTS = rf"\[\[({','.join([_N] * 6)})\],{AXES}\]\\NoEOffs"
_PLACE, _TURN = (f"\\[({','.join([_N] * count)})\\]" for count in (3, 4))
POSITION = rf"\[{_PLACE},{_TURN},\[0,0,0,0\],{AXES}\]"
_TAIL = r",(\w+),(\w+)\\WObj:=(\w+);$"
_TRIGGERS = r",(\w+)((?:\\T[2-8]:=\w+)*)"
_TRIGG_J = re.compile(rf"TriggAbsJ {JOINTS},(\w+)\\T:=(\d+\.(\d+)){_TRIGGERS}{_TAIL}")
_TRIGG_L = re.compile(rf"TriggL {POSITION},(\w+){_TRIGGERS}{_TAIL}")
_ARC = re.compile(
    rf"ArcL(Start|End|) {POSITION},(\w+),seam([1-9]\d*),(\w+)(?:\\Weave:=weave([1-9]\d*))?{_TAIL}"
)
_EXTRA_TRIGGER = re.compile(r"\\T(\d):=(\w+)")


def process_move(line: str, module: Module, run: Run, where: str) -> bool:
    """Execute a move with process data.

    Parameters
    ----------
    line : str
        The line.
    module : Module
        Module that contains the line.
    run : Run
        The state, which is updated.
    where : str
        File and line, for messages.

    Returns
    -------
    bool
        Whether the line is a move with process data.

    Raises
    ------
    InputError
        UNREADABLE_PROGRAM for a move that cannot be understood.
    """
    if arc := _ARC.match(line):
        _arc_move(arc, module, run, where)
    elif trigg := _TRIGG_J.match(line):
        *values, axes, speed, amount, decimals, first_trigger, further, zone, tool, work_object = (
            trigg.groups()
        )
        _speed_of(module, speed, where)
        frames = module.tool_and_object(tool, work_object, where)
        move = Move(
            False, tuple(values), axes, float(amount), 0.5 * 10.0 ** -len(decimals), zone, frames
        )
        _triggered(move, _trigger_names(first_trigger, further, where), module, run, where)
    elif trigg := _TRIGG_L.match(line):
        position, turn, axes, speed, first_trigger, further, zone, tool, work_object = (
            trigg.groups()
        )
        frames = module.tool_and_object(tool, work_object, where)
        amount = _speed_of(module, speed, where)
        move = Move(True, (position, turn), axes, amount, module.halves[speed], zone, frames)
        _triggered(move, _trigger_names(first_trigger, further, where), module, run, where)
    else:
        return False
    return True


def _speed_of(module: Module, name: str, where: str) -> float:
    if name not in module.speeds:
        raise unreadable(where, Text("the module does not define the speed {}", name))
    return module.speeds[name]


def _trigger_names(first_trigger: str, further: str, where: str) -> list[str]:
    """Return the triggers of a move; further triggers count from \\T2 without gaps."""
    numbered = _EXTRA_TRIGGER.findall(further)
    if [int(number) for number, _ in numbered] != list(range(2, 2 + len(numbered))):
        raise unreadable(where, "the triggers of the move are not numbered consecutively")
    return [first_trigger, *(name for _, name in numbered)]


def _triggered(move: Move, names: list[str], module: Module, run: Run, where: str) -> None:
    triggers = [run.process_data.triggers.get(name) for name in names]
    feeds = [trigger for trigger in triggers if isinstance(trigger, Feed)]
    if None in triggers or len({*names}) != len(names) or (run.on and run.output == ARC):
        raise unreadable(where, "a trigger is not set or is named twice, or the arc is still on")
    for feed in feeds:
        if run.analogue not in (None, feed.output) or not move.linear or not run.on:
            raise unreadable(
                where,
                "a second analogue output follows the speed, or an analogue output follows the "
                "speed of a joint move or without deposit",
            )
        run.analogue = feed.output
    starts = [feed for feed in feeds if feed.scale]
    ends = [feed for feed in feeds if not feed.scale]
    if len(starts) > 1 or len(ends) > 1 or (ends and not starts) or (starts and run.fed):
        raise unreadable(
            where,
            "two analogue scales set the wire feed at once, or the wire feed ends before it "
            "begins or within a bead",
        )
    for feed in starts:
        digits = feed.scale * move.half + feed.digits * (move.amount + move.half)
        move = Move(
            move.linear,
            move.values,
            move.axes,
            move.amount,
            move.half,
            move.zone,
            move.frames,
            feed.scale * move.amount,
            digits,
        )
    run.keep_move(module, move, where)
    run.feeding, run.fed = bool(starts) and not ends, bool(ends)
    for trigger in triggers:
        if isinstance(trigger, Switch):
            if run.moving:
                raise unreadable(
                    where,
                    "a trigger needs a move that ends at its point, but the corner is rounded",
                )
            run.keep_switch(
                trigger.output, trigger.on, "do", where, trigger.digits, trigger.distance
            )


def _arc_move(arc: re.Match[str], module: Module, run: Run, where: str) -> None:
    """Start the arc at the robot's position, continue it along a move, or end it.

    The arc ends with a move, or at the robot's position after a move.
    """
    kind, position, turn, axes, speed, seam, weld_name, weave, zone, tool, work_object = (
        arc.groups()
    )
    weld, woven = run.process_data.welds.get(weld_name), int(weave or 0)
    if (
        weld is None
        or weld.speed is None
        or weld.original != weld.speed
        or weld.schedule != int(seam)
    ):
        raise unreadable(
            where, "the weld data of the move has no speed, or belongs to another seam"
        )
    frames = module.tool_and_object(tool, work_object, where)
    dry = _speed_of(module, speed, where)
    move = Move(True, (position, turn), axes, weld.speed, weld.half, zone, frames)
    if kind == "Start":
        if run.on or not run.nearest or not run.stands_at(move, where):
            raise unreadable(where, "the arc is already on, or is started while the robot moves")
        run.keep_switch(seam, True, ARC, where)
        run.seam, run.weave, run.struck, run.last_weld = int(seam), 0, woven, (weld_name, woven)
        return
    if not run.on or run.output != ARC or run.seam != int(seam):
        raise unreadable(where, "the arc is off, or was started with another seam")
    if kind == "End" and run.struck is None and run.stands_at(move, where):
        if run.last_weld != (weld_name, woven):
            raise unreadable(
                where, "the arc was started with weld data that differ from those at its end"
            )
        _ends(run, where)
        return
    _burns(move, weld, weld_name, dry, woven, run, where)
    run.keep_move(module, move, where)
    run.last_weld = weld_name, woven
    if kind == "End":
        if not np.isnan(run.rounding[-1]):
            raise unreadable(where, "the arc ends at a point where the robot does not stop")
        _ends(run, where)


def _burns(move: Move, weld: Weld, name: str, dry: float, woven: int, run: Run, where: str) -> None:
    """Check a move with the arc on, and start its weave.

    The weave starts with the first move and applies to all moves with the weld data `name`. The
    speed must be the same if the arc is blocked.
    """
    if dry != weld.speed:
        raise unreadable(where, "the move has another speed when the arc is blocked")
    if run.struck is not None:
        if run.last_weld != (name, woven):
            raise unreadable(where, "the arc was started with other weld data or another weave")
        run.struck, run.weave = None, woven
        if woven:
            run.happens("weave", float(woven))
    elif run.weave != woven:
        raise unreadable(where, "the weave changes within a bead")


def straight(run: Run) -> None:
    """End the weave when the torch stops."""
    if run.weave and run.struck is None:
        run.happens("weave", 0.0)
        run.weave = 0


def _ends(run: Run, where: str) -> None:
    straight(run)
    run.keep_switch(str(run.seam), False, ARC, where)
