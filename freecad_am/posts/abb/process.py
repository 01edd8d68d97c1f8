# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write process data on the moves of a RAPID program: arc welding instructions, an output that
switches ahead of a point, and an analogue output in proportion to the actual tip speed.

Such moves use other instructions than MoveL or MoveAbsJ, so their words begin with the instruction
and a space. The controller declares the data of the welder (seam3, weld3, weave2). The program
copies weld3 and sets the speed of its beads.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from ...core.issues import InputError
from ...core.program import Block, DepositOff, DepositOn, Moves, Program, Weave
from ..parts import place
from ..refusals import Asked, schedule_refused, weave_refused, wire_refused
from . import text

# names of data that a module declares, numbered except FEED_END: speeds, weld data, wire triggers,
# switching on and off
SPEED, WELD, FEED, FEED_END, SWITCH_ON, SWITCH_OFF = (
    "v_am",
    "d_am",
    "s_am",
    "s_off",
    "g_on",
    "g_off",
)
TRIGGER_NAMES = (FEED_END, SWITCH_ON, SWITCH_OFF)
# maximum number of data items of one kind in a module, such as speeds; each item takes a line
MOST_NAMES = 500
ARC, CARTESIAN = "arc", "cartesian"
LAST_WEAVE, LAST_SEAM = 255, 9999
WAY_DECIMALS = 4  # decimals of the distance, mm, from a switching point to the end of its move
SLOWEST = 0.1  # mm/s; minimum tip speed at which these decimals resolve half a millisecond
_Key = TypeVar("_Key")
_NO_ARC = "[0,0,0,0,0,0,0,0,0]"


def refuse(request: Asked) -> None:
    """Reject process settings that conflict with each other.

    Raises InputError SCHEDULE, WEAVE or NO_WIRE_OUTPUT.
    """
    arc = request.by == ARC
    if arc and request.motion != CARTESIAN:
        raise schedule_refused(
            ARC,
            "ArcL is a linear move, but the program has joint moves; use motion: cartesian for "
            "linear moves",
        )
    if request.weave and request.dry_run:
        raise weave_refused(
            "ArcL carries the weave, and a dry run has no ArcL; block weld and weave on the "
            "controller instead"
        )
    if request.weave and not arc:
        raise weave_refused("ArcL carries the weave, and only program.schedule.by: arc writes ArcL")
    if request.weave and request.part_held:
        raise weave_refused("ArcL may not weave when the robot moves the part below a fixed torch")
    if not request.wire:
        return
    if arc:
        raise wire_refused("welddata sets the wire feed of ArcL")
    if request.motion != CARTESIAN:
        raise wire_refused(
            "TriggSpeed follows the speed of linear moves, but the program has joint moves"
        )
    if request.part_held or request.turned:
        raise wire_refused("TriggSpeed may not follow the speed relative to a moving part")


@dataclass(frozen=True)
class Aboard:
    """Process data of a run of moves.

    arc: schedule of the arc. weave: weave number, 0 for none. on, off: s before the end of the last
    move at which the deposit switches. ends: whether the bead ends with the run. stands: whether
    the torch then stops while still depositing.
    """

    moves: Moves
    arc: int | None = None
    weave: int = 0
    on: float | None = None
    off: float | None = None
    ends: bool = False
    stands: bool = False

    @property
    def lead(self) -> float | None:
        """The time before its end at which the run switches the deposit, s, or None."""
        return self.off if self.on is None else self.on


def aboard(blocks: Iterable[Block]) -> list[Aboard]:
    """Return the process data of each run of moves, in order."""
    runs: list[Aboard] = []
    arc, weave = None, 0
    for block in blocks:
        if isinstance(block, Moves) and len(block):
            runs.append(Aboard(block, arc, weave))
        elif isinstance(block, Weave):
            weave = block.number
        elif isinstance(block, DepositOn):
            arc = block.schedule
            runs[-1:] = [dataclasses.replace(run, on=block.ahead) for run in runs[-1:]]
        elif isinstance(block, DepositOff):
            arc = None
            runs[-1:] = [
                dataclasses.replace(run, off=block.ahead, ends=True, stands=block.lead > 0.0)
                for run in runs[-1:]
            ]
    return runs


class Process:
    """Build the words of a program's moves, block by block in the order of motion.

    A word comes from `plain`, or contains the instruction with process data.
    """

    def __init__(self, program: Program, plain: Callable[[Moves], Sequence[str]]) -> None:
        self._program, self._plain = program, plain
        self._aboard = [] if program.dry_run else aboard(program.blocks)
        self._at = 0
        self._speeds: dict[str, str] = {}
        self._welds: dict[tuple[int, str], str] = {}
        self._feeds: dict[str, str] = {}
        self._switches: dict[str, dict[str, str]] = {SWITCH_ON: {}, SWITCH_OFF: {}}

    def __call__(self, moves: Moves) -> Sequence[str]:
        """Return speed, process data and zone of each move."""
        words = self._plain(moves)
        if not self._aboard:
            return words
        aboard_run = self._aboard[self._at]
        self._at += 1
        if aboard_run.arc is not None:
            return self._welded(words, aboard_run, aboard_run.arc)
        fed = (
            []
            if moves.wire is None
            else [self._feed(ratio) for ratio in (moves.wire / moves.speed).tolist()]
        )
        if not fed and aboard_run.lead is None:
            return words
        last_row = len(words) - 1
        at_end = [
            *([FEED_END] if fed and aboard_run.ends else []),
            *self._switched(aboard_run, words[last_row]),
        ]
        rows = range(len(words)) if fed else (last_row,)
        words = list(words)
        for row in rows:
            words[row] = self._triggered(
                words[row], [*fed[row : row + 1], *(at_end if row == last_row else [])]
            )
        return words

    def _triggered(self, word: str, triggers: Sequence[str]) -> str:
        speed, _, corner = word.partition(",")
        further = "".join(f"\\T{number}:={name}" for number, name in enumerate(triggers[1:], 2))
        if "\\V:=" not in speed:
            return f"TriggAbsJ {speed},{triggers[0]}{further},{corner}"
        return f"TriggL {self._speed(speed)},{triggers[0]}{further},{corner}"

    def _welded(self, words: Sequence[str], aboard_run: Aboard, schedule: int) -> list[str]:
        welded = []
        for row, word in enumerate(words, 1):
            speed, _, corner = word.partition(",")
            name = (
                "ArcLEnd"
                if aboard_run.ends and not aboard_run.stands and row == len(words)
                else "ArcL"
            )
            welded.append(
                f"{name} {self._speed(speed)},{self._arc(aboard_run, schedule, _speed_in(speed))},{corner}"
            )
        return welded

    def _arc(self, aboard_run: Aboard, schedule: int, speed: str) -> str:
        """Return seam, weld data at a speed, and weave."""
        weld = _numbered(self._welds, WELD, (schedule, speed))
        return f"seam{schedule},{weld}" + (
            f"\\Weave:=weave{aboard_run.weave}" if aboard_run.weave else ""
        )

    def _speed(self, word: str) -> str:
        return _numbered(self._speeds, SPEED, _speed_in(word))

    def _feed(self, ratio: float) -> str:
        """Return the trigger that makes the output follow the tip speed.

        ratio: wire feed per tip speed.
        """
        return _numbered(self._feeds, FEED, f"{0.06 * self._program.nc.wire_gain * ratio:#.7G}")

    def _switched(self, aboard_run: Aboard, word: str) -> list[str]:
        """Return the triggers that switch the deposit before the end of a run with the last word
        `word`.

        RAPID limits a time before the stop to the braking phase, but not a distance.
        """
        if aboard_run.lead is None:
            return []
        kind = SWITCH_OFF if aboard_run.on is None else SWITCH_ON
        if aboard_run.lead <= 0.0:
            return [self._switches[kind].setdefault("0", kind)]
        speed_word = word.partition(",")[0]
        speed = (
            float(_speed_in(speed_word))
            if "\\V:=" in speed_word
            else float(aboard_run.moves.speed[-1])
        )
        if not speed >= SLOWEST:
            raise InputError(
                "TRIGGER",
                place(aboard_run.moves),
                "at the switching point the tip moves at {:.2g} mm/s, too slowly to program the "
                "lead as a distance; set a retract distance, or remove program.trigger.lead",
                speed,
            )
        return [
            _numbered(self._switches[kind], kind, f"{aboard_run.lead * speed:.{WAY_DECIMALS}f}")
        ]

    def arc_start(self, schedule: int) -> str:
        """Return the instruction that starts the arc at the start of the next bead."""
        aboard_run = self._aboard[self._at]
        return f"ArcLStart {text.SPEED},{self._arc(aboard_run, schedule, f'{aboard_run.moves.speed[0]:.3f}')},fine"

    def arc_end(self, schedule: int) -> str:
        """Return the instruction that ends the arc at the end of the last bead."""
        aboard_run = self._aboard[self._at - 1]
        return f"ArcLEnd {text.SPEED},{self._arc(aboard_run, schedule, f'{aboard_run.moves.speed[-1]:.3f}')},fine"

    @property
    def before(self) -> Moves:
        """The last run of moves that received words."""
        return self._aboard[self._at - 1].moves

    def data(self, used: Collection[str]) -> list[str]:
        """Declare the data whose names are used.

        Raises InputError MOVE_SPEED if a module would have too many data items of one kind.
        """
        for all_names in self._all_names:
            if len(set(all_names) & set(used)) > MOST_NAMES:
                raise InputError(
                    "MOVE_SPEED",
                    "program.max_points",
                    "a module would need more than {} speeddata items; use fewer speeds, or a "
                    "smaller program.max_points",
                    MOST_NAMES,
                )
        speeds = [
            f"LOCAL CONST speeddata {name}:={text.speed(speed)};"
            for speed, name in self._speeds.items()
            if name in used
        ]
        welds = [
            f"LOCAL PERS welddata {name}:=[{speed},{speed},{_NO_ARC},{_NO_ARC}];"
            for (_, speed), name in self._welds.items()
            if name in used
        ]
        switches = [name for names in self._switches.values() for name in names.values()]
        names = [name for name in (*self._feeds.values(), FEED_END, *switches) if name in used]
        return [*speeds, *welds, *(f"LOCAL VAR triggdata {name};" for name in names)]

    def setup(self, used: Collection[str]) -> list[str]:
        """Return the statements that set the data at the beginning of a routine."""
        lines = []
        for (schedule, speed), name in self._welds.items():
            if name in used:
                lines += [
                    f"    {name}:=weld{schedule};",
                    f"    {name}.weld_speed:={speed};",
                    f"    {name}.org_weld_speed:={speed};",
                ]
        analogue = f"ao{self._program.nc.wire_output}"
        lines += [
            f"    TriggSpeed {name},0\\Start,0,{analogue},{scale};"
            for scale, name in self._feeds.items()
            if name in used
        ]
        lines += [f"    TriggSpeed {FEED_END},0,0,{analogue},0;"] if FEED_END in used else []
        output = f"do{self._program.deposit_output}"
        switches = [
            f"    TriggIO {name},{lead}\\DOp:={output},{int(kind == SWITCH_ON)};"
            for kind, names in self._switches.items()
            for lead, name in names.items()
            if name in used
        ]
        return lines + switches

    @property
    def names(self) -> list[str]:
        """Names of the data that the program declares."""
        return [name for names in self._all_names for name in names]

    @property
    def _all_names(self) -> list[list[str]]:
        """Names of the data that the program declares, by kind."""
        kinds = [self._speeds.values(), self._welds.values(), self._feeds.values()]
        return [
            list(names)
            for names in (*kinds, *(switches.values() for switches in self._switches.values()))
        ]

    @property
    def declared(self) -> list[str]:
        """Names of data that the controller must declare for the words so far."""
        schedules = sorted({schedule for schedule, _ in self._welds})
        weaves = sorted({run.weave for run in self._aboard if run.weave and run.arc is not None})
        return [f"{kind}{number}" for number in schedules for kind in ("seam", "weld")] + [
            f"weave{n}" for n in weaves
        ]


def _speed_in(word: str) -> str:
    """Return the speed in a word."""
    return word.rpartition("=")[2]


def _numbered(names: dict[_Key, str], kind: str, key: _Key) -> str:
    """Return the name of an item; a new item gets the next name of its kind."""
    return names.setdefault(key, f"{kind}{len(names) + 1}")
