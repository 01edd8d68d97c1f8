# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read VAL 3 applications back, file by file: model the controller from the program text alone.

Shares no code with the writer. Accepts only the instructions that a path needs and rejects
everything else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import dataclasses
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...core.issues import InputError, Text, Word
from ...core.read_moves import Event, ReadMoves
from ...core.types import Array, Integers
from ..read_lines import Lines

_NAMESPACE = "{http://www.staubli.com/robotics/VAL3/"
PROJECT, DATA, PROGRAM = (
    _NAMESPACE + space + "}" for space in ("Project/3", "Data/2", "Program/2")
)
AXES = ("j1", "j2", "j3", "j4", "j5", "j6")
POSE = ("x", "y", "z", "rx", "ry", "rz")
_PLAIN = re.compile(r"(?:-?[0-9]+(?:\.[0-9]+)? )*")
_LAYER_LINE = re.compile(r"// layer \d+$")
_DECIMALS = re.compile(r"\.([0-9]+) ")


@dataclass(frozen=True)
class Data:
    """An array of an application: its type, and the attributes of its values by index."""

    kind: str
    values: tuple[dict[str, str], ...]


@dataclass(frozen=True)
class Application:
    """A folder with a project: statements with line numbers by program, data, and paths of
    libraries.
    """

    folder: str
    programs: dict[str, list[tuple[int, str]]]
    data: dict[str, Data]
    libraries: dict[str, str]


def applications(files: dict[str, bytes]) -> dict[str, Application]:
    """Parse the applications by folder. Raises InputError UNREADABLE_PROGRAM."""
    projects = [file for file in sorted(files) if file.endswith(".pjx")]
    by_folder = {_folder(file): _application(file, files) for file in projects}
    listed = sum(1 + len(by_folder[folder].programs) for folder in by_folder) + len(projects)
    if len(by_folder) < len(projects) or listed != len(files):
        raise unreadable("program", "some files belong to no project, or to two projects")
    return by_folder


def _folder(file: str) -> str:
    return file.rpartition("/")[0]


def _application(file: str, files: dict[str, bytes]) -> Application:
    folder, root = _folder(file), _parsed(file, files)
    parameters = root.find(f"{PROJECT}Parameters")
    if (
        root.tag != f"{PROJECT}Project"
        or parameters is None
        or parameters.get("millimeterUnit") != "true"
    ):
        raise unreadable(file, "the file is not a project in millimetres")
    programs = {}
    for element in root.iterfind(f"{PROJECT}Programs/{PROJECT}Program"):
        name = str(element.get("file")).removesuffix(".pgx")
        programs[name] = _statements(name, f"{folder}/{name}.pgx", files)
    data_files = [
        str(element.get("file")) for element in root.iterfind(f"{PROJECT}Database/{PROJECT}Data")
    ]
    if len(data_files) > 1:
        raise unreadable(file, "the project names several data files, but exactly one is expected")
    libraries = {
        str(element.get("alias")): str(element.get("path"))
        for element in root.iterfind(f"{PROJECT}Libraries/{PROJECT}Library")
    }
    return Application(folder, programs, _data(f"{folder}/{''.join(data_files)}", files), libraries)


def _parsed(file: str, files: dict[str, bytes]) -> ElementTree.Element:
    if file not in files:
        raise unreadable(file, "the file is missing")
    if b"\0" in files[file]:  # UTF-16, in which the next check would find nothing
        raise unreadable(file, "the file is not text in UTF-8")
    if b"<!DOCTYPE" in files[file]:
        raise unreadable(file, "the file declares a document type, which controllers never write")
    try:
        return ElementTree.fromstring(files[file])
    except ElementTree.ParseError as error:
        raise unreadable(file, Text("the file is not well-formed XML ({})", error)) from None
    except (LookupError, ValueError):  # the file declares another encoding
        raise unreadable(file, "the file is not text in UTF-8") from None


def _statements(name: str, file: str, files: dict[str, bytes]) -> list[tuple[int, str]]:
    program = _parsed(file, files).find(f"{PROGRAM}Program")
    code = None if program is None else program.findtext(f"{PROGRAM}Code")
    if program is None or code is None or program.get("name") != name:
        raise unreadable(file, Text("the file does not contain the code of a program {}", name))
    lines = [(number, line.strip()) for number, line in enumerate(code.split("\n"), 1)]
    lines = [
        (number, line)
        for number, line in lines
        if line and (not line.startswith("//") or _LAYER_LINE.match(line))
    ]
    if len(lines) < 2 or lines[0][1] != "begin" or lines[-1][1] != "end":
        raise unreadable(file, "the code does not run from `begin` to `end`")
    return lines[1:-1]


def _data(file: str, files: dict[str, bytes]) -> dict[str, Data]:
    data: dict[str, Data] = {}
    for element in _parsed(file, files).iterfind(f"{DATA}Datas/{DATA}Data"):
        name, values = (
            str(element.get("name")),
            [dict(value.attrib) for value in element.iterfind(f"{DATA}Value")],
        )
        keys = [value.pop("key", "") for value in values]
        if (
            name in data
            or keys != [str(key) for key in range(len(values))]
            or element.get("size") != str(len(values))
        ):
            raise unreadable(
                file, Text("the values of {} must be numbered from 0 to its size, each once", name)
            )
        data[name] = Data(str(element.get("type")), tuple(values))
    return data


def numbers(data: Data, names: Sequence[str], where: str) -> tuple[Array, float]:
    """Parse attributes of values as numbers.

    Parameters
    ----------
    data : Data
        The values.
    names : sequence of str
        Names of the attributes; missing attributes are 0.
    where : str
        Position of the data, for messages.

    Returns
    -------
    values : (n, names) array
        The numbers.
    digits : float
        Half of the last digit.

    Raises
    ------
    InputError
        UNREADABLE_PROGRAM for a value that is not a plain number.
    """
    texts = [value.get(name, "0") for value in data.values for name in names]
    together = " ".join(texts) + " "
    if texts and not _PLAIN.fullmatch(together):
        raise unreadable(where, "a value is not a plain number")
    decimals = max(map(len, _DECIMALS.findall(together)), default=0)
    return np.array(texts, dtype=np.float64).reshape(-1, len(names)), 0.5 * 10.0**-decimals


def rotations(degrees: Array) -> Array:
    """Compute the rotations Rx Ry Rz.

    Parameters
    ----------
    degrees : (n, 3) array
        RX, RY, RZ in degrees.

    Returns
    -------
    (n, 3, 3) array
        Rotations.
    """
    cx, cy, cz = np.cos(np.radians(degrees)).T
    sx, sy, sz = np.sin(np.radians(degrees)).T
    rows = (
        (cy * cz, -cy * sz, sy),
        (cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy),
        (sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def poses(values: Array) -> Array:
    """Convert coordinates and angles to poses.

    Parameters
    ----------
    values : (n, 6) array
        x y z in mm, rx ry rz in degrees.

    Returns
    -------
    (n, 4, 4) array
        Poses, mm.
    """
    result = np.zeros((len(values), 4, 4))
    result[:, :3, :3], result[:, :3, 3], result[:, 3, 3] = (
        rotations(values[:, 3:]),
        values[:, :3],
        1.0,
    )
    return result


def unreadable(where: str, why: str) -> InputError:
    """Return the error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)


_UNLIMITED = 99999.0


@dataclass(frozen=True, eq=False)
class Step:
    """The moves of one statement: letter j or l, and the array rows that they use."""

    app: Application
    where: str
    linear: bool
    names: tuple[str, str, str]
    point: Integers
    tool: Integers
    speed: Integers
    deposit: bool
    stops: bool = False


class _Values:
    """The parsed values of arrays; each array is parsed once."""

    def __init__(self) -> None:
        self._read: dict[tuple[str, str, tuple[str, ...]], tuple[Array, float]] = {}
        self._fathers: dict[tuple[str, str], set[str]] = {}
        self._half_digits: dict[tuple[str, ...], dict[bool, float]] = {}

    def __call__(self, app: Application, name: str, columns: tuple[str, ...]) -> Array:
        key = (app.folder, name, columns)
        if key not in self._read:
            self._read[key] = numbers(app.data[name], columns, f"{app.folder}: {name}")
            values, half = self._read[key]
            halves = self._half_digits.setdefault(columns, {})
            halves[len(values) > 1] = max(halves.get(len(values) > 1, 0.0), half)
        return self._read[key][0]

    def digits(self, columns: tuple[str, ...]) -> float:
        """Return half of the last digit of the values in these columns; 0 if none were read.

        A single value, such as the only frame of a part, is an exact setting. It counts only if no
        array of several values has these columns.
        """
        halves = self._half_digits.get(columns, {})
        return halves.get(True, halves.get(False, 0.0))

    def six(self, app: Application, name: str) -> Array:
        """Return x y z rx ry rz (n, 6), mm and degrees."""
        return np.hstack((self(app, name, _LENGTHS), self(app, name, _ANGLES)))

    def father(self, app: Application, name: str) -> str:
        """Return the common father of an array's values; '' if the fathers differ."""
        key = (app.folder, name)
        if key not in self._fathers:
            self._fathers[key] = {value.get("fatherId", "") for value in app.data[name].values}
        return next(iter(self._fathers[key])) if len(self._fathers[key]) == 1 else ""

    def frame(self, app: Application, name: str, where: str) -> Array:
        """Return the frame (4, 4) of the points of an array.

        The frame must be fixed in the world, and the arm must keep its configuration.
        """
        for value in app.data[name].values:
            if any(
                value.get(word, f"{word[0]}same") != f"{word[0]}same"
                for word in ("shoulder", "elbow", "wrist")
            ):
                raise unreadable(where, Text("a point of {} needs another arm configuration", name))
        return self._one(
            app,
            name,
            "frame",
            "world[0]",
            where,
            Text("the points of {} are in more than one frame", name),
        )

    def carrier(self, app: Application, name: str, where: str) -> Array:
        """Return the father (4, 4) of the tools of an array: the flange, or one tool on the flange."""
        if self.father(app, name) == _FLANGE:
            return np.eye(4)
        return self._one(
            app,
            name,
            "tool",
            _FLANGE,
            where,
            Text("the tools of {} are attached to more than one tool", name),
        )

    def _one(
        self, app: Application, name: str, kind: str, ground: str, where: str, otherwise: str
    ) -> Array:
        match = re.fullmatch(r"(\w+)\[0\]", self.father(app, name))
        data = app.data.get(match[1], Data("", ())) if match else Data("", ())
        if (
            match is None
            or data.kind != kind
            or len(data.values) != 1
            or self.father(app, match[1]) != ground
        ):
            raise unreadable(
                where,
                Text(
                    "{} placed {}",
                    otherwise,
                    Word("in the world" if kind == "frame" else "on the flange"),
                ),
            )
        matrix: Array = poses(self.six(app, match[1]))[0]
        return matrix


def _corners(values: _Values, app: Application, descriptor: str, step: Step) -> Array:
    """Return the distances (n,), mm, from the move ends within which corners may be rounded; 0 at
    stops.
    """
    leave, reach = values(app, descriptor, _CORNERS)[step.speed].T
    words = np.array([value.get("blend", "") for value in app.data[descriptor].values])[step.speed]
    full = values(app, descriptor, _ACCELERATION)[step.speed]
    kinds = ("off", "Cartesian") if step.linear else ("off", "joint", "Cartesian")
    if not np.isin(words, kinds).all() or (leave != reach).any() or (full != 100.0).any():
        raise unreadable(
            step.where, "the corner rounding or acceleration of the move is not understood"
        )
    rounded: Array = np.where(words == "off", 0.0, np.maximum(leave, 1e-9))
    return rounded


_CORNERS, _ACCELERATION = ("leave", "reach"), ("accel", "decel")
_LENGTHS, _ANGLES = POSE[:3], POSE[3:]
_FLANGE = "flange[0]"


def moves_of(steps: list[Step]) -> ReadMoves:
    """Convert the moves of all steps, in order, without events."""
    total = sum(len(step.point) for step in steps)
    values = _Values()
    joints, point = np.full((total, 6), np.nan), np.full((total, 6), np.nan)
    tools, lever = np.tile(np.eye(4), (total, 1, 1)), np.zeros(total)
    share = np.full(total, np.nan)
    speed = np.full(total, np.nan)
    deposit = np.zeros(total, dtype=bool)
    stops = np.zeros(total, dtype=bool)
    rounding = np.full(total, np.nan)
    straight = np.zeros(total, dtype=bool)
    frame: Array | None = None
    row = 0
    for step in steps:
        rows = slice(row, row + len(step.point))
        row = rows.stop
        app, (target, tool, descriptor) = step.app, step.names
        deposit[rows], straight[rows] = step.deposit, step.linear
        rounding[rows] = _corners(values, app, descriptor, step)
        stops[rows] = rounding[rows] == 0.0
        stops[rows.stop - 1] |= step.stops
        percent = values(app, descriptor, _SHARE)[step.speed, 0]
        max_speed, most_turn = values(app, descriptor, _SPEEDS)[step.speed].T
        if step.linear:
            own_frame = values.frame(app, target, step.where)
            if frame is not None and not np.array_equal(own_frame, frame):
                raise unreadable(step.where, "the program mixes positions in more than one frame")
            frame = own_frame
            point[rows] = values.six(app, target)[step.point]
            tool_values = values.six(app, tool)[step.tool]
            tools[rows] = values.carrier(app, tool, step.where) @ poses(tool_values)
            if values.father(app, tool) != _FLANGE:
                lever[rows] = np.linalg.norm(tool_values[:, :3], axis=1)
            speed[rows] = max_speed
            is_supported = (percent == 100.0) & (max_speed > 0.0) & (most_turn >= _UNLIMITED)
        else:
            joints[rows], share[rows] = values(app, target, AXES)[step.point], percent / 100.0
            is_supported = (
                (percent > 0.0)
                & (percent <= 100.0)
                & (max_speed >= _UNLIMITED)
                & (most_turn >= _UNLIMITED)
            )
        if not is_supported.all() or (not step.linear and values.father(app, tool) != _FLANGE):
            raise unreadable(
                step.where,
                "the speed limit of the move or the fixture of its tool is not understood",
            )
    linear = bool(np.isfinite(speed).any())
    return ReadMoves(
        np.radians(joints) if np.isfinite(share).any() else None,
        float(np.radians(values.digits(AXES))),
        np.full(total, np.nan),
        deposit,
        straight,
        stops,
        (),
        rounding=rounding,
        position=point[:, :3] if linear else None,
        rotation=rotations(point[:, 3:]) if linear else None,
        position_digits=values.digits(_LENGTHS),
        rotation_digits=float(np.radians(values.digits(_ANGLES))),
        speed=speed,
        speed_digits=values.digits(_SPEEDS),
        share=share,
        share_digits=values.digits(_SHARE) / 100.0,
        frame=frame,
        tool=tools if linear else None,
        lever=lever if linear else None,
    )


_SHARE, _SPEEDS = ("vel",), ("tmax", "rmax")


_INDEX = r"(?:\[(\d+|l_nI(?:[+-]\d+)?)\])?"
_MOVE = re.compile(rf"move([jl])\((\w+){_INDEX},(\w+){_INDEX},(\w+){_INDEX}\)$")
_FOR = re.compile(r"for l_nI=(\d+) to (\d+)$")
_OUTPUT = re.compile(r"(\w+)=(true|false)$")
_CALL = re.compile(r"call (?:(\w+):)?(\w+)\(\)$")
_LOAD = re.compile(r'if (\w+):libLoad\("\./(\w+)"\)!=0$')
_DELAY = re.compile(r"delay\((\d+(?:\.(\d*))?)\)$")
_WAIT = re.compile(r"wait\((\w+)==true\)$")
_LAYER = re.compile(r"// layer (\d+)$")
_NUMBER = re.compile(r".*%[IQ](\d+)$")


@dataclass
class _Run:
    """The state while programs are executed."""

    applications: dict[str, Application]
    steps: list[Step] = field(default_factory=list)
    loaded: dict[tuple[str, str], str] = field(default_factory=dict)
    output: str = ""
    on: bool = False
    moving: bool = False
    moves: int = 0
    events: list[Event] = field(default_factory=list)

    def happens(self, kind: str, *value: float | str, digits: float = 0.0) -> None:
        """Record an event before the next move."""
        self.events.append(Event(self.moves, kind, value, digits))


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with `start` of the outermost application.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    by_folder = applications(files)
    outer = [
        folder
        for folder in by_folder
        if not any(folder.startswith(f"{other_folder}/") for other_folder in by_folder)
    ]
    if len(outer) != 1:
        raise unreadable(
            "program", Text("{} applications, but exactly one with its parts is needed", len(outer))
        )
    run = _Run(by_folder)
    _follow(by_folder[outer[0]], "start", run, ())
    if not run.steps:
        raise unreadable("program", "the program has no moves")
    if run.moving:
        raise unreadable("program", "the program ends before its last move")
    lines = Lines()
    for step in run.steps:
        lines.add(step.where, len(step.point))
    read_moves = dataclasses.replace(
        moves_of(run.steps), events=tuple(run.events), lines=lines.read()
    )
    for app in by_folder.values():
        _check_stop(app, run.output)
    return read_moves


def _check_stop(app: Application, output: str) -> None:
    """Check that stopping an application ends its motion and switches off its outputs."""
    lines = [line for _, line in app.programs.get("stop", [])]
    named = [
        name
        for name, data in app.data.items()
        if data.kind == "dio" and "%Q" in data.values[0].get("link", "")
    ]
    links = {app.data[name].values[0]["link"] for name in named}
    if lines != ["resetMotion()", *(f"{name}=false" for name in named)] or links != (
        {output} if output else set()
    ):
        raise unreadable(
            f"{app.folder}/stop.pgx",
            "the program does not end the motion and switch the deposit off",
        )


def _follow(app: Application, name: str, run: _Run, callers: tuple[tuple[str, str], ...]) -> None:
    """Execute the statements of a program in order, and the programs that it calls."""
    caller = (app.folder, name)
    if name not in app.programs or caller in callers:
        raise unreadable(
            app.folder, Text("{} is not a program of the application, or calls itself", name)
        )
    statements = iter(app.programs[name])
    for number, line in statements:
        where = Text("{}/{}.pgx line {}", app.folder, name, number)
        if loop := _FOR.match(line):
            (_, inside), (_, end) = next(statements, (0, "")), next(statements, (0, ""))
            if not _MOVE.match(inside) or end != "endFor" or int(loop[1]) > int(loop[2]):
                raise unreadable(where, "only a loop over a single move is understood")
            _move(app, inside, np.arange(int(loop[1]), int(loop[2]) + 1), run, where)
        elif _MOVE.match(line):
            _move(app, line, np.zeros(0, np.int64), run, where)
        elif line == "waitEndMove()":
            _wait_for_moves(run)
        elif layer := _LAYER.match(line):
            run.happens("layer", float(layer[1]))
        elif not any(form.match(line) for form in (_LOAD, _CALL, _OUTPUT, _DELAY, _WAIT)):
            raise unreadable(where, Text("the instruction {!r} is not understood", line))
        elif run.moving:
            raise unreadable(where, Text("{!r} does not wait for the previous moves", line))
        elif load := _LOAD.match(line):
            _load(app, load[1], load[2], statements, run, where)
        elif call := _CALL.match(line):
            _call(app, call[1], call[2], run, where, (*callers, caller))
        else:
            _other(app, line, run, where)


def _call(
    app: Application,
    alias: str | None,
    name: str,
    run: _Run,
    where: str,
    callers: tuple[tuple[str, str], ...],
) -> None:
    """Execute a program of the application or of a library; record a call of any other program."""
    called = app if alias is None else _library(app, alias, run, where)
    if called is not None:
        _follow(called, name, run, callers)
    else:
        run.happens("call", str(alias).upper() if name == "start" else f"{alias}:{name}")


def _wait_for_moves(run: _Run) -> None:
    run.moving = False
    if run.steps:
        run.steps[-1] = dataclasses.replace(run.steps[-1], stops=True)


def _load(
    app: Application,
    alias: str,
    part_name: str,
    statements: Iterator[tuple[int, str]],
    run: _Run,
    where: str,
) -> None:
    """Load a part; the program must stop on failure, and the robot must not deposit meanwhile."""
    next_statements = [next(statements, (0, ""))[1] for _ in range(3)]
    if not next_statements[0].startswith("popUpMsg(") or next_statements[1:] != ["return", "endIf"]:
        raise unreadable(where, "the program does not stop if a part cannot be loaded")
    if run.on or f"{app.folder}/{part_name}" not in run.applications or alias not in app.libraries:
        raise unreadable(
            where,
            Text(
                "{} is loaded during the deposit or is missing, or {} is not a library",
                part_name,
                alias,
            ),
        )
    run.loaded[app.folder, alias] = f"{app.folder}/{part_name}"


def _library(app: Application, alias: str, run: _Run, where: str) -> Application | None:
    """Return the application of an alias; None if it is elsewhere on the controller."""
    if alias not in app.libraries:
        raise unreadable(where, Text("{} is not a library of the project", alias))
    if (app.folder, alias) in run.loaded:
        return run.applications[run.loaded[app.folder, alias]]
    if not app.libraries[alias].startswith("Disk://"):
        raise unreadable(where, Text("{} is called before it is loaded", alias))
    return None


def _other(app: Application, line: str, run: _Run, where: str) -> None:
    if output := _OUTPUT.match(line):
        link = _link(app, output[1], "Q", where)
        if run.output not in ("", link):
            raise unreadable(where, "the program switches a second output")
        run.output, run.on = link, output[2] == "true"
        run.happens("on" if run.on else "off", _number(link, where), output[1])
    elif delay := _DELAY.match(line):
        run.happens("wait", float(delay[1]), digits=0.5 * 10.0 ** -len(delay[2] or ""))
    elif wait := _WAIT.match(line):
        run.happens("input", _number(_link(app, wait[1], "I", where), where))


def _link(app: Application, name: str, letter: str, where: str) -> str:
    data = app.data.get(name, Data("", ()))
    if (
        data.kind != "dio"
        or len(data.values) != 1
        or f"%{letter}" not in data.values[0].get("link", "")
    ):
        raise unreadable(
            where,
            Text(
                "{} is not a digital {} of the project",
                name,
                Word("output" if letter == "Q" else "input"),
            ),
        )
    return data.values[0]["link"]


def _number(link: str, where: str) -> float:
    """Return the number of an input or output, from 1."""
    number = _NUMBER.match(link)
    if number is None:
        raise unreadable(where, Text("{!r} has no number", link))
    return float(number[1]) + 1.0


def _move(app: Application, line: str, counter: Integers, run: _Run, where: str) -> None:
    match = _MOVE.match(line)
    assert match is not None
    letter, *arguments = match.groups()
    names, kinds = arguments[0::2], ("pointRx" if letter == "l" else "jointRx", "tool", "mdesc")
    rows = []
    for name, kind, index in zip(names, kinds, arguments[1::2], strict=True):
        data = app.data.get(name, Data("", ()))
        indices = _indices(index, counter)
        if (
            data.kind != kind
            or indices is None
            or indices.min() < 0
            or indices.max() >= len(data.values)
        ):
            raise unreadable(
                where,
                Text("{} is not {} data of the project, or has too few values", name, kind),
            )
        rows.append(indices)
    run.moving = True
    run.moves += len(rows[0])
    run.steps.append(
        Step(
            app,
            where,
            letter == "l",
            (names[0], names[1], names[2]),
            rows[0],
            rows[1],
            rows[2],
            run.on,
        )
    )


def _indices(index: str | None, counter: Integers) -> Integers | None:
    """Return the rows that an index selects for each counter value; None for a counter outside its
    loop.
    """
    if index is None or index.isdigit():
        return np.full(max(len(counter), 1), int(index or 0))
    return counter + int(index[4:] or 0) if len(counter) else None
