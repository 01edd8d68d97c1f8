# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format text and numbers of a KRL module: axis values, A B C, speeds, percents. Lines end in CR
LF.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ...core.issues import InputError
from ...core.orientation import MOVING_ZYX
from ...core.program import (
    DEPOSIT,
    FIRST_SHARE,
    LINEAR_MOVE,
    SHORTEST_RAPID,
    DepositOff,
    DepositOn,
    Moves,
    Program,
)
from ...core.types import Array, Mask
from ..catalogue import plain
from ..parts import place, switching
from ..refusals import Ahead, speeds_within

CALL = "ArcMainNG("  # start of a line that calls ArcTech
SEAM = "WSEAM"  # seam data, common to all schedules
WELD_DATA, END_DATA = "WDAT", "WDATOFF"  # names of weld data and end data, without their numbers


def after(block: DepositOn | DepositOff) -> str:
    """Return the ArcTech call after a move that switches the arc."""
    if isinstance(block, DepositOn):
        return f"{CALL}#ArcOnAfterMoveStd,{WELD_DATA}{block.schedule},{SEAM})"
    return f"{CALL}#ArcOffAfterMoveStd,{END_DATA}{block.schedule},{SEAM})"


def names(program: Program) -> list[str]:
    """Return the names of the ArcTech data and procedures that a program uses."""
    schedules = {
        block.schedule
        for block in program.blocks
        if isinstance(block, DepositOn) and block.schedule is not None
    }
    arc_names = ["ArcMainNG", "ArcGetPath", "ArcGetDelay", SEAM] if schedules else []
    return arc_names + [
        f"{kind}{number}" for number in sorted(schedules) for kind in (WELD_DATA, END_DATA)
    ]


def refuse_post_flow(program: Program) -> None:
    """Raise InputError SCHEDULE if a bead has a post-flow, because ArcTech keeps it in its weld
    data.
    """
    for block in program.blocks:
        if isinstance(block, DepositOff) and block.schedule is not None and block.lead > 0.0:
            raise InputError(
                "SCHEDULE",
                "process.lead_off",
                "ArcTech ends the arc with the last move of a bead and waits there for the "
                "crater time of its weld data; use lead_off 0 and set the crater time of {}, or "
                "another program.schedule.by",
                f"{END_DATA}{block.schedule}",
            )


def remarks(program: Program) -> Iterator[str]:
    """Yield the weld data and speeds that the controller must have."""
    speeds: dict[int, list[float]] = {}
    number: int | None = None
    for block in program.blocks:
        if isinstance(block, DepositOn):
            number = block.schedule
        elif isinstance(block, Moves) and number is not None:
            speeds.setdefault(number, []).extend(
                (float(np.min(block.speed)), float(np.max(block.speed)))
            )
        elif isinstance(block, DepositOff):
            number = None
    if speeds:
        yield f"ArcTech: {SEAM} and the weld data are of a public data list"
    for number, weld_speeds in sorted(speeds.items()):
        slowest, fastest = 0.001 * min(weld_speeds), 0.001 * max(weld_speeds)
        speed = f"{fastest:.6f}" if fastest - slowest < 5e-7 else f"{slowest:.6f} to {fastest:.6f}"
        yield f"{WELD_DATA}{number}, {END_DATA}{number}: $VEL.CP is {speed} m/s"


def lighting(number: int) -> list[str]:
    """Return the lines before the move that starts the arc."""
    data, seam = f"{WELD_DATA}{number}", SEAM
    on_the_fly = f"TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,{data})"
    return [
        f"TRIGGER WHEN DISTANCE=1 DELAY=ArcGetDelay(#PreDefinition,{data}) DO {CALL}#PreDefinition,{data},{seam}) PRIO=-1",
        f"{on_the_fly} DELAY=ArcGetDelay(#GasPreflow,{data}) DO {CALL}#GasPreflow,{data},{seam}) PRIO=-1",
        f"{on_the_fly} DELAY=0 DO {CALL}#ArcOnMoveStd,{data},{seam}) PRIO=-1",
        f"{CALL}#ArcOnBeforeMoveStd,{data},{seam})",
    ]


def ending(number: int) -> list[str]:
    """Return the lines before the move that ends the arc."""
    data, seam = f"{END_DATA}{number}", SEAM
    return [
        f"TRIGGER WHEN PATH=ArcGetPath(#ArcOffBefore,{data}) DELAY=0 DO {CALL}#ArcOffBeforeOffStd,{data},{seam}) PRIO=-1",
        f"TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOff,{data}) DELAY=0 DO {CALL}#ArcOffMoveStd,{data},{seam}) PRIO=-1",
        f"{CALL}#ArcOffBeforeMoveStd,{data},{seam})",
    ]


TRIGGER = "TRIGGER "  # start of a trigger line


def ahead_of_moves(program: Program) -> dict[int, str]:
    """Return the lines before the last moves of runs, by the id of the moves."""
    if program.dry_run:
        return {}
    return {
        id(moves): "\n".join(lines)
        for moves, block in switching(program)
        if (lines := _lines(program, block))
    }


def leads(program: Program) -> dict[int, float]:
    """Return the lead, s, of the last moves of runs that switch an output, by the id of the moves."""
    if program.dry_run:
        return {}
    return {
        id(moves): block.ahead for moves, block in switching(program) if block.ahead is not None
    }


def in_front(lines: str, word: str) -> str:
    """Insert lines before a move, after its settings.

    A trigger comes last. ArcTech calls come first, so that later settings override those of
    ArcTech.
    """
    if CALL in lines:
        return f"{lines}|{word}"
    settings, bar, move = word.rpartition("|")
    return f"{settings}{bar}{lines}|{move}"


def _lines(program: Program, block: DepositOn | DepositOff) -> list[str]:
    if block.schedule is not None:
        return lighting(block.schedule) if isinstance(block, DepositOn) else ending(block.schedule)
    if block.ahead is None:
        return []
    early = -round(1000.0 * block.ahead)
    switched = "TRUE" if isinstance(block, DepositOn) else "FALSE"
    return [f"{TRIGGER}WHEN DISTANCE=1 DELAY={early} DO $OUT[{program.deposit_output}]={switched}"]


END_OF_LINE = "\r\n"
SCHEDULE, BITS = (
    "am_schedule",
    8,
)  # name of the signal that carries the schedule, and its number of outputs
WIDTH = 80  # characters; width of remarks
ANGLE_DECIMALS, LENGTH_DECIMALS = 4, 3
# mm/s: minimum speed that six decimals of m/s resolve well, and maximum speed of arms
SPEEDS = (0.01, 3000.0)
MILLISECOND = 0.001  # s; resolution of a delay
# percent; minimum axis speed; half a percent is rounded up to it
LEAST_PERCENT = 1
_AXES = [f"A{axis} %.{ANGLE_DECIMALS}f" for axis in range(1, 7)]
_PLACE = [f"{axis} %.{LENGTH_DECIMALS}f" for axis in "XYZ"] + [
    f"{axis} %.{ANGLE_DECIMALS}f" for axis in "ABC"
]
# suffixes of a move: exact stop, rounded corner
_STOPS, _ROUNDED = "", " C_DIS"


def module(name: str, lines: Iterable[str]) -> bytes:
    """Return the file of a module with one routine."""
    text = ["&ACCESS RVP", "&REL 1", f"DEF {name}()", *lines, "END"]
    return (END_OF_LINE.join(text) + END_OF_LINE).encode("ascii")


def remark(text: str) -> list[str]:
    """Wrap a comment in ASCII characters to the width of remarks."""
    return [f"; {line}" for line in textwrap.wrap(plain(text), WIDTH)]


def signal(first_output: int) -> list[str]:
    """Return the declaration of the outputs that select a schedule."""
    return [f"SIGNAL {SCHEDULE} $OUT[{first_output}] TO $OUT[{first_output + BITS - 1}]"]


def wait(seconds: float) -> list[str]:
    """Return the line of a wait, to 0.001 s; empty for 0 s."""
    return [f"WAIT SEC {max(seconds, 0.001):.3f}"] if seconds > 0.0 else []


def controller_values(joints: Array, slides: Mask) -> Array:
    """Convert axis values to the units and decimals of the text.

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


def frames(position: Array, rotation: Array) -> Array:
    """Convert poses to rounded KRL values; the rotation is Rz(A) Ry(B) Rx(C).

    Parameters
    ----------
    position : (n, 3) array
        mm.
    rotation : (n, 3, 3) array
        Rotations.

    Returns
    -------
    (n, 6) array
        X Y Z in mm and A B C in degrees, rounded.
    """
    angles = np.round(np.degrees(MOVING_ZYX.numbers(rotation)), ANGLE_DECIMALS)
    values: Array = np.hstack((np.round(position, LENGTH_DECIMALS), angles)) + 0.0
    return values


class Lines:
    """Build the lines of a program's moves, block by block in the order of motion.

    Each move follows its required settings, separated by |. ahead: the time in the last moves that
    is available for switching the deposit ahead of their ends.
    """

    def __init__(self, program: Program) -> None:
        self._blend = program.blend
        self._slides = program.slides
        self._nominal = np.where(
            self._slides, program.max_speed, np.degrees(np.array(program.max_speed))
        )
        self._before: Array | None = None
        self.ahead: list[Ahead] = []
        self._own = program.own_axes
        self._switching, self._leads = ahead_of_moves(program), leads(program)
        numbers = [program.first_external + k for k in range(len(program.external_kinds))]
        external = [f"E{number} %.{ANGLE_DECIMALS}f" for number in numbers]
        self._ptp, self._lin = (
            f"{word} {{{','.join([*values, *external])}}}"
            for word, values in (("PTP", _AXES), ("LIN", _PLACE))
        )
        # speed percentages of external axes also limit linear moves, which must not become slower
        self._shares = "".join(f"$VEL_EXTAX[{number}]=%d|" for number in numbers)
        self._unhindered = self._external_speeds(100)

    def __call__(self, moves: Moves) -> Sequence[str]:
        """Return `settings|move` of each move. Raises InputError MOVE_SPEED or JOINT_SPEED."""
        values = controller_values(moves.joints, self._slides)
        if moves.interpolation == LINEAR_MOVE:
            assert moves.position is not None and moves.rotation is not None
            size = self._rounding(moves)
            corners = [
                _STOPS if stops or size <= 0.0 else _ROUNDED for stops in moves.stops.tolist()
            ]
            if _ROUNDED in corners[-2:-1]:
                # a lead must not reach back past the end of the corner
                self._switched(
                    moves, float(moves.duration[-1] - size / moves.speed[-1]), corner=True
                )
            speeds = [
                f"$VEL.CP={0.001 * speed:.6f}" for speed in speeds_within(moves, *SPEEDS).tolist()
            ]
            rows = np.hstack(
                (frames(moves.position, moves.rotation), values[:, self._own :])
            ).tolist()
            lines = [
                f"{self._unhindered}{speed}|{self._lin % tuple(row)}{corner}"
                for speed, row, corner in zip(speeds, rows, corners, strict=True)
            ]
            marked = [
                f"$APO.CDIS={size:.3f}|{line}" if corner else line
                for line, corner in zip(lines, corners, strict=True)
            ]
        else:
            percent = self._percent(moves, values)
            rows = values.tolist()
            marked = [
                f"BAS(#VEL_PTP,{share:d})|{self._external_speeds(share)}{self._ptp % tuple(row)}"
                for share, row in zip(percent, rows, strict=True)
            ]
        self._before = values[-1]
        if id(moves) in self._switching:
            marked[-1] = in_front(self._switching[id(moves)], marked[-1])
        return marked

    def _external_speeds(self, share: int) -> str:
        """Return the settings of the external axis speeds, percent; empty without external axes."""
        return self._shares % ((share,) * self._shares.count("%"))

    def _percent(self, moves: Moves, values: Array) -> list[int]:
        """Return the whole percents of the maximum joint speeds that give the moves their planned
        times.
        """
        previous = values[:1] if self._before is None else self._before[None]
        share = (np.abs(np.diff(values, axis=0, prepend=previous)) / self._nominal).max(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            percent = 100.0 * share / moves.duration
        percent = np.where(share > 0.0, percent, 100.0)
        if self._before is None:
            percent[0] = 100.0 * FIRST_SHARE
        # a rapid that is slow only because it is short has a minimum planned time; it runs at the
        # lowest percentage
        tame = moves.duration <= SHORTEST_RAPID * (1.0 + 1e-9)
        wrong = ~((percent <= 100.5) & (tame | (percent >= 0.5 * LEAST_PERCENT)))
        if wrong.any():
            raise InputError(
                "JOINT_SPEED",
                place(moves),
                "a rapid would need {:.3g} % of the largest joint speed, but KRL uses whole "
                "percentages from {} to 100; use another rapid speed",
                percent[wrong][0],
                LEAST_PERCENT,
            )
        percents = np.clip(np.rint(percent), LEAST_PERCENT, 100)
        if self._before is not None or len(moves) > 1:
            # rounding to whole percents may speed a move up and shorten its time
            self._switched(moves, float(100.0 * share[-1] / percents[-1]))
        return [int(value) for value in percents]

    def _switched(self, moves: Moves, seconds: float, corner: bool = False) -> None:
        """Store the time left in the last move if this move switches the deposit."""
        if id(moves) in self._leads:
            self.ahead.append(Ahead(moves, self._leads[id(moves)], seconds, corner, MILLISECOND))

    def _rounding(self, moves: Moves) -> float:
        """Return the corner rounding distance, mm: at most half the shortest move of the bead."""
        shortest = (
            float(np.nan_to_num(moves.speed * moves.duration).min())
            if moves.kind == DEPOSIT
            else 0.0
        )
        return math.floor(1000.0 * min(0.005 * self._blend * shortest, 100.0)) / 1000.0


def spoken(words: Sequence[str], current_settings: dict[str, str]) -> list[str]:
    """Return the lines of moves, preceded by the settings that differ from `current_settings`.

    Updates `current_settings`.
    """
    lines: list[str] = []
    for word in words:
        *settings, move = word.split("|")
        for setting in settings:
            if setting.startswith(TRIGGER):
                lines += setting.splitlines()
                if CALL in setting:
                    current_settings.clear()  # ArcTech leaves unknown settings
                continue
            key = setting[: max(setting.find("="), 8)]
            if current_settings.get(key) != setting:
                current_settings[key] = setting
                lines.append(setting)
        lines.append(move)
    return lines
