# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a RAPID module says of the process before it moves: weld data of the controller's with a speed of its own, and
triggers - outputs that are switched ahead of a place, analogue ones that follow the speed of the tip."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from .modules import Module, unreadable

_TAKEN = re.compile(r"(\w+):=weld([1-9]\d*);$")
_SPEED = re.compile(r"(\w+)\.(org_)?weld_speed:=(\d+\.(\d+));$")
_SWITCH = re.compile(r"TriggIO (\w+),(\d+(?:\.(\d+))?)\\DOp:=do(\d+),([01]);$")
_FEED = re.compile(r"TriggSpeed (\w+),0\\Start,0,ao(\d+),(\d+(?:\.(\d+))?)(?:E([-+]\d+))?;$")
_FEED_END = re.compile(r"TriggSpeed (\w+),0,0,ao(\d+),0;$")


@dataclass
class Weld:
    """Weld data of a module: the controller's that it is taken of, and its speed, mm/s, with half of its last digit."""

    schedule: int
    speed: float | None = None
    half: float = 0.0
    original: float | None = None


@dataclass(frozen=True)
class Switch:
    """A digital output that is set `distance` mm of the tip's path before the end of a move; digits:
    half of the last one.
    """

    output: str
    on: bool
    distance: float
    digits: float


@dataclass(frozen=True)
class Feed:
    """An analogue output that follows the speed of the tip, mm/s, from the start of a move on;
    scale 0 ends it.
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
        """Keep the process data of a line; return whether it had any. Raises InputError
        UNREADABLE_PROGRAM.
        """
        if taken_weld := _TAKEN.match(line):
            if taken_weld[1] not in module.welds or taken_weld[1] in self.welds:
                raise unreadable(
                    where,
                    "the data taken from the controller is not weld data of the module, or is "
                    "taken twice",
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
                "weld data is not taken of the controller yet, has two speeds or another than declared",
            )
        if speed[2]:
            weld.original = value
        else:
            weld.speed, weld.half = value, 0.5 * 10.0 ** -len(speed[4])

    def _keep_trigger(self, name: str, trigger: Switch | Feed, module: Module, where: str) -> None:
        if name not in module.triggers or name in self.triggers:
            raise unreadable(where, "a trigger is not of the module, or set twice")
        self.triggers[name] = trigger
