# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read KRL modules back: model the controller from the program text alone.

Shares no code with the writer. Accepts only the instructions that a path needs and rejects
everything else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...core.issues import InputError, Text
from ...core.read_moves import ARC, Event, ReadMoves
from ...core.types import Array
from ..read_lines import Lines, floats

# ---- ArcTech instructions: a linear move that stops, with calls before and after it

_DATA, _OF = re.compile(r"\b(WDAT(?:OFF)?)(\d+)\b"), r"\1@"
_MOVE = "the move"
# lines of an instruction; @ stands for the number of its data
_ON_LINES = (
    "TRIGGER WHEN DISTANCE=1 DELAY=ArcGetDelay(#PreDefinition,WDAT@) DO ArcMainNG(#PreDefinition,WDAT@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,WDAT@) DELAY=ArcGetDelay(#GasPreflow,WDAT@)"
    " DO ArcMainNG(#GasPreflow,WDAT@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,WDAT@) DELAY=0 DO ArcMainNG(#ArcOnMoveStd,WDAT@,WSEAM) PRIO=-1",
    "ArcMainNG(#ArcOnBeforeMoveStd,WDAT@,WSEAM)",
    _MOVE,
    "ArcMainNG(#ArcOnAfterMoveStd,WDAT@,WSEAM)",
)
_OFF_LINES = (
    "TRIGGER WHEN PATH=ArcGetPath(#ArcOffBefore,WDATOFF@) DELAY=0 DO ArcMainNG(#ArcOffBeforeOffStd,WDATOFF@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOff,WDATOFF@) DELAY=0 DO ArcMainNG(#ArcOffMoveStd,WDATOFF@,WSEAM) PRIO=-1",
    "ArcMainNG(#ArcOffBeforeMoveStd,WDATOFF@,WSEAM)",
    _MOVE,
    "ArcMainNG(#ArcOffAfterMoveStd,WDATOFF@,WSEAM)",
)


@dataclass
class ArcMove:
    """An ArcTech instruction being read: its lines, the number of lines read, and its data number."""

    lines: tuple[str, ...] = ()
    lines_read: int = 0
    number: str = ""

    @property
    def is_open(self) -> bool:
        """Whether more lines of the instruction must follow."""
        return bool(self.lines)

    def accept_move(self, straight: bool, rounded: bool) -> bool:
        """Whether a move is allowed here. An instruction allows only a linear move that stops."""
        if not self.is_open:
            return True
        right = self.lines[self.lines_read] == _MOVE and straight and not rounded
        self.lines_read += 1
        return right

    def called(self, line: str) -> str | None:
        """Return 'on' or 'off' at the last line of an instruction and '' at earlier lines.

        Return None for an unexpected line, or for a line with another data number than the lines
        before.
        """
        numbers, template = {number for _, number in _DATA.findall(line)}, _DATA.sub(_OF, line)
        if not self.is_open:
            self.lines, self.lines_read, self.number = (
                (_ON_LINES if template == _ON_LINES[0] else _OFF_LINES),
                0,
                next(iter(numbers), ""),
            )
        if numbers != {self.number} or template != self.lines[self.lines_read]:
            return None
        self.lines_read += 1
        if self.lines_read < len(self.lines):
            return ""
        switched = "on" if self.lines is _ON_LINES else "off"
        self.lines = ()
        return switched


def is_arc_line(line: str) -> bool:
    """Whether a line belongs to an ArcTech instruction."""
    return "ArcMainNG(" in line


@dataclass
class Run:
    """The state while modules are executed, column by column.

    state: current settings by name; a module inherits no settings. standing: a wait has stopped the
    robot. signals: first and last output of each signal of the module. external: values of the
    external axes at each move. unit, numbers: mechanism that BASE is coupled to, and its axis
    numbers. slides: numbers of the axes that a remark marks as the track. arc: the ArcTech
    instruction being read. trigger: lead, s, output and state of a switch at the next move.
    """

    files: dict[str, tuple[str, list[str]]]
    values: list[Array] = field(default_factory=list)
    linear: bytearray = field(default_factory=bytearray)
    deposit: bytearray = field(default_factory=bytearray)
    speed: array[float] = field(default_factory=floats)
    share: array[float] = field(default_factory=floats)
    rounding: array[float] = field(default_factory=floats)
    base: array[float] = field(default_factory=floats)
    tool: array[float] = field(default_factory=floats)
    events: list[Event] = field(default_factory=list)
    followed: list[str] = field(default_factory=list)
    state: dict[str, float] = field(default_factory=dict)
    half_digits: dict[str, float] = field(default_factory=dict)
    external: list[Array] = field(default_factory=list)
    signals: dict[str, tuple[int, int]] = field(default_factory=dict)
    unit: str | None = None
    numbers: tuple[int, ...] = ()
    slides: tuple[int, ...] = ()
    output: str = ""
    on: bool = False
    standing: bool = True
    arc: ArcMove = field(default_factory=ArcMove)
    trigger: tuple[float, str, bool] | None = None
    lines: Lines = field(default_factory=Lines)

    def happens(
        self, kind: str, *value: float | str, digits: float = 0.0, ahead: float | None = None
    ) -> None:
        """Add an event before the next move, or ahead of the end of the last move.

        Parameters
        ----------
        kind : str
            Kind of the event.
        *value : float or str
            Values of the event.
        digits : float, optional
            Half of the last digit of a number.
        ahead : float or None, optional
            Time before the end of the last move, s; None for an event before the next move.
        """
        self.events.append(Event(len(self.speed), kind, value, digits, ahead))

    def note_digits(self, what: str, texts: tuple[str, ...]) -> None:
        """Store half of the last digit for a kind of numbers."""
        half = 0.5 * 10.0 ** -min(len(text.partition(".")[2]) for text in texts)
        self.half_digits[what] = max(half, self.half_digits.get(what, 0.0))


def read_moves(run: Run) -> ReadMoves:
    """Convert the moves of the executed modules."""
    linear, deposit = (np.array(column, dtype=np.bool_) for column in (run.linear, run.deposit))
    values, rounding = np.array(run.values), np.array(run.rounding)
    half, is_linear = run.half_digits, linear[:, None]
    a, b, c = np.radians(np.where(is_linear, values[:, 3:], np.nan)).T
    any_line = bool(linear.any())
    external = np.array(run.external)
    joints = np.radians(np.hstack((np.where(is_linear, np.nan, values), external)))
    joints[:, 6:] = np.where(np.isin(run.numbers, run.slides), external, joints[:, 6:])
    return ReadMoves(
        None if np.isnan(joints).all() else joints,
        float(np.radians(half.get("joints", 0.0))),
        np.full(len(linear), np.nan),
        deposit,
        linear,
        np.isnan(rounding),
        tuple(run.events),
        position=np.where(is_linear, values[:, :3], np.nan) if any_line else None,
        rotation=_about(2, a) @ _about(1, b) @ _about(0, c) if any_line else None,
        position_digits=half.get("places", 0.0),
        rotation_digits=float(np.radians(half.get("turns", 0.0))),
        speed=np.array(run.speed),
        speed_digits=half.get("speed", 0.0),
        share=np.array(run.share),
        share_digits=0.005,
        linear_digits=half.get("slides", 0.0),
        rounding=rounding,
        user_frame=np.array(run.base),
        tool_frame=np.array(run.tool),
        unit=run.unit or "",
        first_external=run.numbers[0] if run.numbers else 1,
        lines=run.lines.read(),
    )


def _about(axis: int, angle: Array) -> Array:
    """Return rotations (n, 3, 3) about X, Y or Z."""
    turned = np.zeros((len(angle), 3, 3))
    next_axis, last_axis = (axis + 1) % 3, (axis + 2) % 3
    turned[:, axis, axis] = 1.0
    turned[:, next_axis, next_axis] = turned[:, last_axis, last_axis] = np.cos(angle)
    turned[:, last_axis, next_axis], turned[:, next_axis, last_axis] = np.sin(angle), -np.sin(angle)
    return turned


def not_read(where: str, why: str) -> InputError:
    """Return the error for a line that is not understood or is out of place."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)


_N = r"(-?\d+\.\d+)"
_AXES, _PLACES = (
    ",".join(f"{name} {_N}" for name in names.split())
    for names in ("A1 A2 A3 A4 A5 A6", "X Y Z A B C")
)
_EXTERNAL_WORDS = rf"((?:,E[1-6] {_N[1:-1]})*)"  # external axes
_TO_AXES = re.compile(rf"PTP \{{{_AXES}{_EXTERNAL_WORDS}\}}$")
_LINEAR_MOVE = re.compile(rf"LIN \{{{_PLACES}{_EXTERNAL_WORDS}\}}( C_DIS)?$")
_EXTERNAL, _SHARED = re.compile(rf",E(\d) {_N}"), re.compile(r"\$VEL_EXTAX\[([1-6])\]=(\d+)$")
_COUPLED = re.compile(
    r"\$BASE=EK\(MACHINE_DEF\[(\d+)\]\.ROOT,MACHINE_DEF\[(\d+)\]\.MECH_TYPE,BASE_DATA\[(\d+)\]\)$"
)
_PERCENT = re.compile(r"BAS\(#VEL_PTP,(\d+)\)$")
_METRES, _ROUNDING = re.compile(r"\$VEL\.CP=(\d+\.(\d+))$"), re.compile(r"\$APO\.CDIS=(\d+\.\d+)$")
_SELECTED = re.compile(r"BAS\(#(BASE|TOOL),(\d+)\)$")
_SWITCHED, _PAUSE = (
    re.compile(r"\$OUT\[(\d+)\]=(TRUE|FALSE)$"),
    re.compile(r"WAIT SEC (\d+(?:\.(\d+))?)$"),
)
_DECLARED, _NUMBERED = (
    re.compile(r"SIGNAL (\w+) \$OUT\[(\d+)\] TO \$OUT\[(\d+)\]$"),
    re.compile(r"(\w+)=(\d+)$"),
)
_AWAITED, _LAYERED = re.compile(r"WAIT FOR \$IN\[(\d+)\]==TRUE$"), re.compile(r"; layer (\d+)$")
_CALLED, _HEADED = re.compile(r"([A-Za-z]\w*)\(\)$"), re.compile(r"DEF ([A-Za-z]\w*)\(\)$")
_ANY_HEAD = re.compile(
    r"\s*((?:GLOBAL\s+)?DEF(?:FCT)?\s[^;]*[^;\s])", re.IGNORECASE
)  # also in the form of other programs
# delay in whole milliseconds, relative to the end of the next move
_TRIGGER = re.compile(
    r"TRIGGER WHEN DISTANCE=1 DELAY=(0|-[1-9]\d*) DO \$OUT\[(\d+)\]=(TRUE|FALSE)$"
)
_TRACK = re.compile(r"; E([1-6]) is the track in mm\b")
_INITIAL, _ON_FLANGE, _TURNING = "BAS(#INITMOV,0)", "$IPO_MODE=#BASE", "$ORI_TYPE=#VAR"


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with the module that no other module
    calls.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    by_name = {}
    for file in sorted(files):
        lines = files[file].decode("latin-1").replace("\r\n", "\n").rstrip("\n").split("\n")
        by_name[_routine(file, lines).lower()] = (file, lines)
    called = {
        call[1].lower()
        for _, lines in by_name.values()
        for line in lines
        if (call := _CALLED.match(line))
    }
    main = [name for name in by_name if name not in called]
    if len(main) != 1:
        raise not_read(
            "program",
            Text(
                "{} programs are called by no other program, but exactly one must be the main "
                "program",
                len(main),
            ),
        )
    run = Run(by_name)
    _go(main[0], run)
    if not run.speed:
        raise not_read("program", "the program has no moves")
    if len(run.followed) != len(by_name):
        raise not_read("program", "some modules never run, or run twice")
    return read_moves(run)


def _routine(file: str, lines: list[str]) -> str:
    """Return the name of a module's only routine, which must equal the file name."""
    title = (
        _HEADED.match(lines[2])
        if len(lines) > 3 and lines[:2] == ["&ACCESS RVP", "&REL 1"]
        else None
    )
    heads = [head[1] for line in lines if (head := _ANY_HEAD.match(line))]
    if title is None or lines[-1] != "END" or len(heads) != 1:
        had = Text("the file has {}", ", ".join(heads)) if heads else "the file has no DEF"
        raise not_read(
            file,
            Text(
                "the file is not a module with one routine of the same name that begins with "
                "&ACCESS RVP, &REL 1 and DEF and ends with END: {}",
                had,
            ),
        )
    if f"{title[1]}.src".lower() != file.lower():
        raise not_read(
            file,
            Text("the routine {} and the file have different names; rename one of them", heads[0]),
        )
    return title[1]


def _go(name: str, run: Run) -> None:
    """Execute the lines of a module in order, and the modules that it calls."""
    file, lines = run.files[name]
    run.followed.append(name)
    run.state, run.signals = {}, {}
    for number, line in enumerate(lines[3:-1], 4):
        where = f"{file} line {number}"
        if _TO_AXES.match(line) or _LINEAR_MOVE.match(line):
            _follow_move(line, run, where)
        elif is_arc_line(line):
            _arc(line, run, where)
        elif declared := _DECLARED.match(line):
            _declare(declared, lines[3 : number - 1], run, where)
        elif (set_to := _NUMBERED.match(line)) and set_to[1] in run.signals:
            _set(run.signals[set_to[1]], int(set_to[2]), run, where)
        elif not _setting(line, run):
            _carry_out(line, run, where)
    if not run.standing or run.arc.is_open or run.trigger:
        raise not_read(file, "the program ends before its last move")


def _carry_out(line: str, run: Run, where: str) -> None:
    for form, instruction in _INSTRUCTIONS.items():
        if match := form.match(line):
            instruction(match, run, where)
            return
    if not line.startswith(";"):
        _follow_instruction(line, run, where)


def _setting(line: str, run: Run) -> bool:
    """Store a setting for later moves; return whether the line is a setting."""
    if setting := _PERCENT.match(line):
        run.state["percent"] = float(setting[1])
    elif setting := _METRES.match(line):
        run.state["speed"] = 1000.0 * float(setting[1])
        run.half_digits["speed"] = max(
            run.half_digits.get("speed", 0.0), 500.0 * 10.0 ** -len(setting[2])
        )
    elif setting := _ROUNDING.match(line):
        run.state["rounding"] = float(setting[1])
    elif setting := _SELECTED.match(line):
        run.state[setting[1]] = float(setting[2])
        if setting[1] == "BASE":
            run.state.pop("EK", None)
    elif setting := _SHARED.match(line):
        run.state[f"E{setting[1]}"] = float(setting[2])
    elif line in (_INITIAL, _ON_FLANGE, _TURNING):
        if line == _INITIAL:
            run.state = {}  # earlier settings no longer apply
        run.state[line] = 1.0
    else:
        return False
    return True


def _couple(coupled: re.Match[str], run: Run, where: str) -> None:
    """Couple the base to the mechanism that carries it."""
    if coupled[1] != coupled[2] or run.state.get("BASE") != float(coupled[3]):
        raise not_read(
            where,
            "root and type belong to different mechanisms, or the base is not the selected one",
        )
    run.state["EK"] = float(coupled[1])


def _declare(declared: re.Match[str], earlier_lines: list[str], run: Run, where: str) -> None:
    """Declare a signal of several outputs; declarations precede the instructions of a module."""
    if any(not line.startswith(";") for line in earlier_lines):
        raise not_read(
            where, "the signal is declared after an instruction, but declarations come first"
        )
    run.signals[declared[1]] = int(declared[2]), int(declared[3])


def _set(outputs: tuple[int, int], number: int, run: Run, where: str) -> None:
    """Set the outputs from the first to the last to a number."""
    if not run.standing or number >= 2 ** (outputs[1] - outputs[0] + 1):
        raise not_read(
            where, "the schedule is set ahead of the motion, or has too few outputs for the number"
        )
    if run.output and outputs[0] <= int(run.output) <= outputs[1]:
        raise not_read(where, "one output of the schedule switches the deposit")
    run.happens("schedule", float(outputs[0]), float(number))


def _arc(line: str, run: Run, where: str) -> None:
    """Read an ArcTech line, which may change the settings of moves."""
    if run.trigger:
        raise not_read(where, "the line interrupts the lines of another instruction")
    switched = run.arc.called(line)
    if switched is None:
        raise not_read(
            where,
            "ArcTech has no such line here, or the line names other data than the previous lines",
        )
    for name in ("speed", "rounding", "percent", *(f"E{number}" for number in range(1, 7))):
        run.state.pop(name, None)
    if switched:
        if run.output or run.on == (switched == "on"):
            raise not_read(
                where, "an output switches the deposit too, or the arc is started or ended twice"
            )
        run.on = switched == "on"
        run.happens(switched, float(run.arc.number), ARC)


def _trigger(trigger: re.Match[str], run: Run, where: str) -> None:
    """Let the next move switch an output."""
    if run.trigger or run.arc.is_open:
        raise not_read(where, "the line interrupts the lines of another instruction")
    _one_output(trigger[2], run, where)
    run.trigger = -0.001 * int(trigger[1]), trigger[2], trigger[3] == "TRUE"


def _one_output(number: str, run: Run, where: str) -> None:
    """Check that a single output, and not also ArcTech, switches the deposit."""
    if run.output not in ("", number) or any(ARC in event.value for event in run.events):
        raise not_read(where, "the program switches a second output")
    run.output = number


def _layer(layer: re.Match[str], run: Run, where: str) -> None:
    run.happens("layer", float(layer[1]))


def _track(track: re.Match[str], run: Run, where: str) -> None:
    run.slides += (int(track[1]),)


_INSTRUCTIONS: dict[re.Pattern[str], Callable[[re.Match[str], Run, str], None]] = {
    _TRIGGER: _trigger,
    _COUPLED: _couple,
    _LAYERED: _layer,
    _TRACK: _track,
}


def _follow_instruction(line: str, run: Run, where: str) -> None:
    """Execute an instruction that is neither a move nor a setting.

    The advance run stops only at waits, so outputs and calls must follow a wait.
    """
    if not any(form.match(line) for form in (_PAUSE, _AWAITED, _SWITCHED, _CALLED)):
        if line.startswith("TRIGGER") and not run.standing:
            raise not_read(
                where,
                Text(
                    "the instruction {!r} is not understood: a TRIGGER, which is read ahead of "
                    "the motion, is only supported with DISTANCE=1 and a DELAY of at most 0",
                    line,
                ),
            )
        raise not_read(where, Text("the instruction {!r} is not understood", line))
    if run.arc.is_open or run.trigger:
        raise not_read(where, Text("{!r} interrupts the lines of another instruction", line))
    if pause := _PAUSE.match(line):
        run.standing = _stopped(run, where)
        run.happens(
            "wait", float(pause[1]), digits=0.5 * 10.0 ** -len(pause[2] or "") if pause[2] else 0.0
        )
    elif awaited := _AWAITED.match(line):
        run.standing = _stopped(run, where)
        run.happens("input", float(awaited[1]))
    elif not run.standing:
        raise not_read(
            where, Text("{!r} is read ahead of the motion because no wait precedes it", line)
        )
    elif switched := _SWITCHED.match(line):
        _one_output(switched[1], run, where)
        run.on = switched[2] == "TRUE"
        run.happens("on" if run.on else "off", float(switched[1]), "$OUT")
    elif call := _CALLED.match(line):
        if call[1].lower() not in run.files:
            run.happens("call", call[1].upper())
        elif call[1].lower() in run.followed or run.on:
            raise not_read(
                where, Text("{} has already run, or is called during the deposit", call[1])
            )
        else:
            _go(call[1].lower(), run)


def _stopped(run: Run, where: str) -> bool:
    """Return True: a wait holds the program until the robot stops. The last corner must not be
    rounded.
    """
    if run.speed and not np.isnan(run.rounding[-1]):
        raise not_read(where, "the line stops the robot, but the previous move is approximated")
    return True


def _follow_move(line: str, run: Run, where: str) -> None:
    straight, state = _LINEAR_MOVE.match(line), run.state
    if not run.arc.accept_move(straight is not None, bool(straight and straight[8])):
        raise not_read(
            where,
            "a move of ArcTech must be linear, stop, and follow all lines of its instruction",
        )
    needed = {_INITIAL, _ON_FLANGE, _TURNING, "BASE", "TOOL"} | (
        {"speed"} if straight else {"percent"}
    )
    if straight and straight[8]:
        needed |= {"rounding"}
    if not needed <= set(state):
        raise not_read(
            where, "the module does not set base, tool, speed and rounding before the move"
        )
    if not straight and not 1.0 <= state["percent"] <= 100.0:
        raise not_read(
            where, Text("{:.0f} % of the joint speeds is not in 1 to 100", state["percent"])
        )
    match = straight or _TO_AXES.match(line)
    assert match is not None
    texts = match.groups()[:6]
    run.values.append(np.array(texts, dtype=np.float64))
    external = _EXTERNAL.findall(match[7])
    _external_axes(
        tuple(int(number) for number, _ in external),
        100.0 if straight else state["percent"],
        run,
        where,
    )
    run.external.append(np.array([value for _, value in external], dtype=np.float64))
    for number, value in external:
        run.note_digits("slides" if int(number) in run.slides else "joints", (value,))
    if straight:
        run.note_digits("places", texts[:3])
        run.note_digits("turns", texts[3:])
    else:
        run.note_digits("joints", texts)
    run.linear.append(straight is not None)
    run.lines.add(where)
    run.deposit.append(run.on)
    run.speed.append(state["speed"] if straight else np.nan)
    run.share.append(np.nan if straight else 0.01 * state["percent"])
    run.rounding.append(state["rounding"] if straight and straight[8] else np.nan)
    run.base.append(state["BASE"])
    run.tool.append(state["TOOL"])
    run.standing = False
    if run.trigger:
        _triggered(*run.trigger, run, where)


def _triggered(ahead: float, output: str, on: bool, run: Run, where: str) -> None:
    """Record that the last move switches an output `ahead` s before its end."""
    if not np.isnan(run.rounding[-1]):
        raise not_read(
            where, "a trigger needs a move that ends at its point, but the corner is rounded"
        )
    run.on, run.trigger = on, None
    run.happens("on" if on else "off", float(output), "$OUT", digits=0.0005, ahead=ahead)


def _external_axes(numbers: tuple[int, ...], share: float, run: Run, where: str) -> None:
    """Check the external axes of a move.

    All moves must use the same axes, coupled and with enough speed, percent. A linear move keeps
    its speed only if external axes may run at full speed.
    """
    unit = f"{run.state['EK']:.0f}" if "EK" in run.state else ""
    if run.unit is not None and (run.unit, run.numbers) != (unit, numbers):
        raise not_read(where, "the moves of the program use different external axes")
    moved = set(numbers) - set(run.slides)
    in_order = numbers == tuple(range(numbers[0], numbers[0] + len(numbers)) if numbers else ())
    if (
        not in_order
        or bool(moved) != bool(unit)
        or len(run.slides) > 1
        or not {*run.slides} <= {*numbers}
    ):
        raise not_read(
            where,
            "the external axes are out of order, or BASE is not coupled to the part on these axes",
        )
    if any(run.state.get(f"E{number}") != share for number in numbers):
        raise not_read(where, Text("external axes are not set to {:.0f} % of their speeds", share))
    run.unit, run.numbers = unit, numbers
