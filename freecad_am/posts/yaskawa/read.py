# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read INFORM jobs back: model the controller from the program text alone.

Shares no code with the writer. Pulses per degree and the unit of V come from remarks in the text.
Accepts only the instructions that a path needs and rejects everything else, so that unknown text
cannot hide motion.
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
from ..read_lines import Lines

_NAME = re.compile(r"//NAME ([A-Z][A-Z0-9_]{0,31})$")
_COUNT = re.compile(r"///NPOS (\d+),(\d+),(\d+),0,0,0$")
_TOOL = re.compile(r"///TOOL (\d+)$")
_POINT = re.compile(r"C(\d{5})=" + ",".join([r"(-?\d+)"] * 6) + "$")
_EXTERNAL = {
    "BC": re.compile(r"BC(\d{5})=(-?\d+)$"),
    "EC": re.compile(r"EC(\d{5})=(-?\d+(?:,-?\d+){0,5})$"),
}
_GROUP = re.compile(r"///GROUP1 RB1(,BS1)?(?:,(ST\d+))?$")
_INST: tuple[str | re.Pattern[str], ...] = (
    r"//INST",
    r"///DATE \d{4}/\d\d/\d\d \d\d:\d\d",
    r"///COMM [ -~]{0,32}",
    r"///ATTR SC,RW",
    _GROUP,
    r"NOP",
)
_MOVJ = re.compile(r"MOVJ C(\d{5})(?: BC(\d{5}))?(?: EC(\d{5}))? VJ=(\d+\.(\d+)) PL=([0-8])$")
_MOVL = re.compile(r"MOVL C(\d{5})()() V=(\d+(?:\.(\d+))?) PL=([0-8])$")
_OUTPUT = re.compile(r"DOUT OT#\((\d+)\) (ON|OFF)$")
_OUTPUTS = re.compile(r"DOUT OG#\((\d+)\) (\d+)$")
_ARC = re.compile(r"ARC(ON ASF|OF AEF)#\((\d+)\)$")
_WEAVE = re.compile(r"WV(?:ON WEV#\((\d+)\)|OF)$")
_TIMER = re.compile(r"TIMER T=(\d+\.(\d+))$")
_INPUT = re.compile(r"WAIT IN#\((\d+)\)=ON$")
_CALL = re.compile(r"CALL JOB:([A-Z][A-Z0-9_]{0,31})$")
_LAYER = re.compile(r"'layer (\d+)$")
_PER_UNIT = re.compile(r"'pulses/(deg [SLURBT]|(?:deg|mm) E[1-7]) (-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)$")
_UNIT = re.compile(r"'V in (mm/s|cm/min|mm/min)$")
_MM_PER_S = {"mm/s": 1.0, "cm/min": 10.0 / 60.0, "mm/min": 1.0 / 60.0}
_ROBOT_AXES = 6  # number of robot axes
_LINE = 34  # maximum characters of a remark including its sign, plus one


@dataclass
class _Job:
    """A job: its tool, its positions (n, 6 + track + station) in pulses, and its lines from NOP to
    END.

    first_line: number of the first line. track: whether the motion group has a track. station: ''
    for none.
    """

    file: str
    tool: float
    points: Array
    lines: list[str]
    first_line: int
    track: bool
    station: str


@dataclass
class _Run:
    """The state while jobs are executed.

    moves: fraction, V, corner level, tool and pulses of each move. external: track and station of
    all moves; None before the first move. per_unit: pulses per degree or mm of each axis. slides:
    axes in mm.
    """

    moves: array[float] = field(default_factory=lambda: array("d"))
    deposit: bytearray = field(default_factory=bytearray)
    events: list[Event] = field(default_factory=list)
    lines: Lines = field(default_factory=Lines)
    per_unit: dict[str, float] = field(default_factory=dict)
    slides: set[str] = field(default_factory=set)
    unit: str = ""
    axes: int = 0
    decimals: list[int] = field(
        default_factory=lambda: [99, 99]
    )  # the fewest decimals of VJ and of V
    external: tuple[bool, str] | None = None
    output: str = ""
    on: bool = False
    weaves: str = ""  # file and line where the current weave starts

    def happens(self, kind: str, *value: float | str, digits: float = 0.0) -> None:
        """Record an event before the next move."""
        self.events.append(Event(len(self.deposit), kind, value, digits))


_WORDS = 4  # number of values of a move before its pulses


def unreadable(where: str, why: str) -> InputError:
    """Return the error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with the job that no other job calls.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    jobs = {}
    for file in sorted(files):
        name, job = _job(file, files[file])
        if not re.fullmatch(rf"(?:.*/)?{name}\.JBI", file):
            raise unreadable(file, Text("the job in the file is called {}", name))
        jobs[name] = job
    called = {call[1] for job in jobs.values() for line in job.lines if (call := _CALL.match(line))}
    main = [name for name in jobs if name not in called]
    if len(main) != 1:
        raise unreadable(
            "program",
            Text(
                "{} jobs are called by no other job, but exactly one must be the main job",
                len(main),
            ),
        )
    run = _Run()
    _follow(main[0], jobs, run, ())
    if not run.deposit:
        raise unreadable("program", "the program has no moves")
    if run.weaves:
        raise unreadable(run.weaves, "the weave that begins here has no end")
    return _moves(run)


def _moves(run: _Run) -> ReadMoves:
    table = np.array(run.moves).reshape(-1, _WORDS + run.axes)
    names = _axes(run.axes)
    per_unit = np.array([run.per_unit[axis] for axis in names])
    slides = np.array([axis in run.slides for axis in names])
    pulses = table[:, _WORDS:]
    if slides.any():  # in a job, the track precedes the station, whatever its axis number
        track, column = pulses[:, _ROBOT_AXES], int(np.argmax(slides))
        pulses = np.insert(np.delete(pulses, _ROBOT_AXES, axis=1), column, track, axis=1)
    values, per_mm = pulses / per_unit, float(np.abs(per_unit[slides]).min(initial=np.inf))
    share, path, level, tool = table[:, :_WORDS].T
    linear = np.isfinite(path)
    unit = _MM_PER_S.get(run.unit, np.nan)
    half = [0.5 * 10.0**-decimals for decimals in run.decimals]
    return ReadMoves(
        np.where(slides, values, np.radians(values)),
        np.radians(0.5 / np.abs(per_unit)),
        np.full(len(table), np.nan),
        np.array(run.deposit, dtype=np.bool_),
        linear,
        level == 0.0,
        tuple(run.events),
        speed=path * unit,
        speed_digits=half[1] * unit if linear.any() else 0.0,
        share=0.01 * share,
        share_digits=0.01 * half[0],
        level=level,
        tool_frame=tool,
        unit=run.external[1] if run.external else "",
        linear_digits=0.5 / per_mm,
        lines=run.lines.read(),
    )


def _job(file: str, content: bytes) -> tuple[str, _Job]:
    """Return name and content of a job."""
    try:
        lines = content.decode("ascii").split("\r\n")
    except UnicodeDecodeError:
        raise unreadable(file, "the program contains characters other than ASCII") from None
    name, count = (
        (_NAME.match(lines[1]), _COUNT.match(lines[3])) if len(lines) > 3 else (None, None)
    )
    if (
        name is None
        or count is None
        or (lines[0], lines[2]) != ("/JOB", "//POS")
        or lines[-2:] != ["END", ""]
    ):
        raise unreadable(file, "the file is not a job from /JOB to END")
    points, line_index, tool = int(count[1]), 4, float("nan")
    values = np.zeros((points, 6))
    if points:
        tool_match = _TOOL.match(lines[4])
        if tool_match is None or lines[5:7] != ["///POSTYPE PULSE", "///PULSE"]:
            raise unreadable(
                f"{file} line 5", "the positions of the job are not pulses of one tool"
            )
        tool, line_index = float(tool_match[1]), 7
        for number, line in enumerate(lines[line_index : line_index + points]):
            point = _POINT.match(line)
            if point is None or int(point[1]) != number:
                raise unreadable(
                    f"{file} line {line_index + number + 1}",
                    Text("{!r} is not position {}", line, number),
                )
            values[number] = [float(value) for value in point.groups()[1:]]
        line_index += points
    counts = {letters: int(number) for letters, number in zip(_EXTERNAL, count.groups()[1:])}
    for letters, external in counts.items():
        if external not in (0, points):
            raise unreadable(
                f"{file} line 4",
                "some positions lack the external axes, or have only external axes",
            )
        values = (
            np.hstack(
                [
                    values,
                    _external_pulses(
                        file, letters, lines[line_index : line_index + external], line_index
                    ),
                ]
            )
            if external
            else values
        )
        line_index += external
    for number, pattern in enumerate(_INST):
        if line_index + number >= len(lines) or not re.fullmatch(
            pattern, lines[line_index + number]
        ):
            raise unreadable(
                f"{file} line {line_index + number + 1}",
                "the instructions do not begin like those of a robot job",
            )
    first_index = line_index + len(_INST)
    group = _GROUP.match(lines[first_index - 2])
    track, station = (bool(group[1]), group[2] or "") if group else (False, "")
    if points and (track, bool(station)) != (counts["BC"] > 0, counts["EC"] > 0):
        raise unreadable(
            f"{file} line {first_index - 1}",
            "the group of the instructions differs from the group of the positions",
        )
    return name[1], _Job(file, tool, values, lines[first_index:-2], first_index + 1, track, station)


def _external_pulses(file: str, letters: str, lines: list[str], line_index: int) -> Array:
    """Return the pulses (n, k) of a track or station on the lines after `line_index`."""
    rows: list[list[float]] = []
    for number, line in enumerate(lines):
        point = _EXTERNAL[letters].match(line)
        if (
            point is None
            or int(point[1]) != number
            or (rows and len(rows[0]) != point[2].count(",") + 1)
        ):
            raise unreadable(
                f"{file} line {line_index + number + 1}",
                Text("{!r} is not position {} of {}", line, number, letters),
            )
        rows.append([float(value) for value in point[2].split(",")])
    return np.array(rows)


def _axes(count: int) -> list[str]:
    """Return the axis names of robot and station."""
    return [*"SLURBT", *(f"E{number + 1}" for number in range(count - _ROBOT_AXES))]


def _follow(name: str, jobs: dict[str, _Job], run: _Run, callers: tuple[str, ...]) -> None:
    """Execute the lines of a job in order, and the jobs that it calls."""
    job = jobs[name]
    if name in callers:
        raise unreadable(job.file, "the program calls itself")
    _check_units(job)
    for number, text in enumerate(job.lines, job.first_line):
        where = f"{job.file} line {number}"
        if text.startswith("MOV"):
            _move(job, text, run, where)
        elif call := _CALL.match(text):
            if call[1] in jobs:
                _follow(call[1], jobs, run, (*callers, name))
            else:
                run.happens("call", call[1])
        elif text.startswith("'") and len(text) < _LINE:
            _remark(text, run, where)
        else:
            _carry_out(text, run, where)


def _check_units(job: _Job) -> None:
    """Check that a job states its units. Raises InputError UNREADABLE_PROGRAM."""
    units = [ratio[1].split() for line in job.lines if (ratio := _PER_UNIT.match(line))]
    named = sorted(axis for _, axis in units)
    slides = [axis for unit, axis in units if unit == "mm"]
    if len(job.points) and (
        named != sorted(_axes(job.points.shape[1])) or len(slides) != job.track
    ):
        raise unreadable(
            job.file,
            "the pulses per degree of each axis, or per mm of a track, are missing or given twice",
        )
    if any(_MOVL.match(line) for line in job.lines) and not any(
        _UNIT.match(line) for line in job.lines
    ):
        raise unreadable(job.file, "the unit of V is missing or unknown")


def _carry_out(text: str, run: _Run, where: str) -> None:
    for form, instruction in _INSTRUCTIONS.items():
        if match := form.match(text):
            instruction(match, run, where)
            return
    raise unreadable(where, Text("the instruction {!r} is not understood", text))


def _switch(output: re.Match[str], run: _Run, where: str) -> None:
    """Switch the deposit by an output."""
    if run.output not in ("", output[1]):
        raise unreadable(where, "the program switches a second output")
    run.output, run.on = output[1], output[2] == "ON"
    run.happens("on" if run.on else "off", float(output[1]), "OT")


def _schedule(group: re.Match[str], run: _Run, where: str) -> None:
    run.happens("schedule", float(group[1]), float(group[2]))


def _wait(timer: re.Match[str], run: _Run, where: str) -> None:
    run.happens("wait", float(timer[1]), digits=0.5 * 10.0 ** -len(timer[2]))


def _wait_input(wait: re.Match[str], run: _Run, where: str) -> None:
    run.happens("input", float(wait[1]))


def _arc(arc: re.Match[str], run: _Run, where: str) -> None:
    """Start or end the arc with a file of conditions."""
    if run.output not in ("", ARC) or run.on == arc[1].startswith("ON"):
        raise unreadable(
            where, "an output switches the deposit too, or the arc is already on or still off"
        )
    run.output, run.on = ARC, arc[1].startswith("ON")
    run.happens("on" if run.on else "off", float(arc[2]), ARC)


def _weave(weave: re.Match[str], run: _Run, where: str) -> None:
    """Start or end weaving."""
    if bool(weave[1]) == bool(run.weaves):
        raise unreadable(where, "weaving is already on, or still off")
    run.weaves = where if weave[1] else ""
    run.happens("weave", float(weave[1] or 0))


_INSTRUCTIONS: dict[re.Pattern[str], Callable[[re.Match[str], _Run, str], None]] = {
    _OUTPUT: _switch,
    _OUTPUTS: _schedule,
    _ARC: _arc,
    _WEAVE: _weave,
    _TIMER: _wait,
    _INPUT: _wait_input,
}


def _remark(text: str, run: _Run, where: str) -> None:
    """Read a remark: units, which must be equal in all jobs, or the start of a layer."""
    if layer := _LAYER.match(text):
        run.happens("layer", float(layer[1]))
    elif ratio := _PER_UNIT.match(text):
        unit_name, axis = ratio[1].split()
        if (
            run.per_unit.setdefault(axis, float(ratio[2])) != float(ratio[2])
            or float(ratio[2]) == 0.0
        ):
            raise unreadable(
                where, Text("the pulses per {} of {} differ, or are missing", unit_name, axis)
            )
        run.slides |= {axis} if unit_name == "mm" else set()
    elif unit := _UNIT.match(text):
        if run.unit not in ("", unit[1]):
            raise unreadable(where, "V is used with two units")
        run.unit = unit[1]


def _numbers(move: re.Match[str]) -> tuple[str | None, str | None]:
    """Return the numbers of the track and station positions in a move."""
    return move[2] or None, move[3] or None


def _move(job: _Job, text: str, run: _Run, where: str) -> None:
    joint, line = _MOVJ.match(text), _MOVL.match(text)
    move = joint or line
    if (
        move is None
        or int(move[1]) >= len(job.points)
        or _numbers(move) != (move[1] if job.track else None, move[1] if job.station else None)
    ):
        raise unreadable(
            where, Text("the move {!r} is not understood, or its position is missing", text)
        )
    value = float(move[4])
    if value <= 0.0 or (joint and value > 100.0):
        raise unreadable(where, Text("the speed {} is not valid", move[4]))
    external = job.track, job.station
    if run.external not in (None, external) or run.axes not in (0, job.points.shape[1]):
        raise unreadable(where, "the moves of the job use more than one track or station")
    run.external, run.axes = external, job.points.shape[1]
    kind = 0 if joint else 1
    run.decimals[kind] = min(run.decimals[kind], len(move[5] or ""))
    run.moves.extend((value, np.nan) if joint else (np.nan, value))
    run.moves.extend((float(move[6]), job.tool))
    run.moves.extend(job.points[int(move[1])].tolist())
    run.deposit.append(run.on)
    run.lines.add(where)
