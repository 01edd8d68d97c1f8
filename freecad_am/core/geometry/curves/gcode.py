# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slicer G-code as curves: each run of extruding moves is a bead.

Layers follow the comments, or Z if there are no layer comments. Modes follow Marlin 2 and Klipper:
G90 keeps M83, and G91 makes the extruder relative unless M82 or M83 was given. A move that the two
firmwares interpret differently (M82, then G91) is rejected. Sources:
https://marlinfw.org/meta/gcode, https://www.klipper3d.org/G-Codes.html,
https://docs.duet3d.com/User_manual/Reference/Gcodes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...issues import NOTE, InputError, Issue, Text
from ...types import Array
from ..step_count import step_count
from . import gcode_roles as roles_of
from .bead_curves import BeadCurve, ReadCurves
from .gcode_words import BadWords, Command, commands_of, split_comments

CODE = "BAD_GCODE"
NOT_READ = roles_of.NOT_READ
LAYER = re.compile(
    r"\s*(?:LAYER\s*:\s*-?\d+|LAYER_CHANGE|CHANGE_LAYER|layer\s+-?\d+\b.*|BEFORE_LAYER_CHANGE)",
    re.IGNORECASE,
)
MIN_STEP_MM = 1e-6  # mm; closer points coincide
MAX_MM = 1e7  # mm; maximum coordinate; larger values are typing errors
ARC_END = (
    0.1  # mm; maximum difference of the radii at the ends of an arc: slicers round to hundredths
)
EXTRUSION_TOLERANCE_MM = 1e-9
SAME_HEIGHT = 1e-3  # mm; slicers write Z to hundredths or thousandths
MAX_TURN_DEG = 1.0  # maximum rotation of a rotary axis between adjacent points
NO_ROTARY, ANY_ROTARY = "none", "any"  # any: for drawings, which do not show directions
ROTARY = (NO_ROTARY, "head-ac", "head-bc", "table-ac", "table-bc")
FORM = "give absolute or relative moves, G0 to G3 with E, as a slicer for filament or pellets writes them"
MOTIONS = frozenset({"G0", "G1", "G2", "G3"})
LINEAR_WORDS, ARC_WORDS = frozenset("XYZEF"), frozenset("XYZEFIJKRP")
LENGTH_WORDS = frozenset("XYZEFIJKR")  # mm, or inches after G20
INCH = 25.4  # mm
# for each arc plane: its two axes, the axis of helices, and the words of the arc centre. Arcs in
# G18 are rejected, because controllers rotate them from Z to X and Klipper from X to Z
PLANES = {"G17": ((0, 1, 2), "IJ"), "G18": ((2, 0, 1), "KI"), "G19": ((1, 2, 0), "JK")}
UNITS = {"G20": INCH, "G21": 1.0}
# codes without effect on the path: dwell, cancelled modes, first work offset, feed modes
NO_MOTION = frozenset(
    {
        "G4",
        "G40",
        "G49",
        "G54",
        "G60",
        "G64",
        "G69",
        "G80",
        "G91.1",
        "G93",
        "G94",
        "G95",
        "G97",
    }
)
# automatic moves (homing, levelling, cleaning, parking); the program must then set positions again
OWN_MOTION = frozenset(
    {"G12", "G27", "G28", "G29", "G29.1", "G29.2", "G30", "G32", "G33", "G34", "G35", "G392"}
)
REFUSED = {
    "G5": "splines are not supported; set the slicer to write lines and arcs",
    "G6": "direct stepper moves are not supported; set the slicer to write G1",
    "G26": "the command prints a built-in pattern of the machine; remove the command",
    "G41": "tool radius compensation is not supported; remove the command",
    "G42": "tool radius compensation and moves to points of a mesh are not supported; remove the command",
    "G43": "tool length offsets are not supported; switch off the offsets in the slicer",
    "G51": "scaled coordinates are not supported; switch off the scaling in the slicer",
    "G61": "the command returns to a stored position; write out the move",
    "G68": "rotated coordinates are not supported; switch off the rotation in the slicer",
    "G90.1": "absolute arc centres are not supported; give I and J from the start of the arc",
    "M28": "the machine stores the following lines without running them; remove the command and its M29",
    "M808": "the command repeats lines of the program; write out the moves",
    "M97": "the command calls a subprogram; write out the moves of the subprogram",
    "M99": "the command returns from a subprogram, or repeats the program; remove the command",
    "M206": "the command shifts the origin; remove the command, or use G92",
    "M428": "the command shifts the origin; remove the command, or use G92",
    "M579": "the command scales axes; remove the command",
    "SET_GCODE_OFFSET": "the command shifts the origin; remove the command, or use G92",
    "SET_KINEMATIC_POSITION": "the command shifts the origin; remove the command, or use G92",
    "FORCE_MOVE": "the command moves a single motor; remove the command",
    "EXCLUDE_OBJECT": "the command cancels an object while the program runs; remove the object in the slicer",
}
# manufacturer-specific codes: probing, levelling, machine states
VENDOR = re.compile(r"G39(?:\.\d+)?|G\d{3,}(?:\.\d+)?")
CANCELLED = re.compile(r"\s*(?:C|P\s*\d+)\s*", re.IGNORECASE)  # words of M486 that cancel an object
WORK_OFFSETS = re.compile(r"G5[5-9](?:\.[123])?")
# M codes and macros that do not change the path
HARMLESS_M = frozenset(
    {
        f"M{k}"
        for k in (
            *range(12),
            *range(16, 32),
            33,
            36,
            37,
            38,
            42,
            48,
            70,
            72,
            73,
            75,
            76,
            77,
            78,
            80,
            81,
            82,
            83,
            84,
        )
    }
    | {
        f"M{k}"
        for k in (
            85,
            92,
            104,
            105,
            106,
            107,
            108,
            109,
            110,
            111,
            112,
            113,
            114,
            115,
            116,
            117,
            118,
            119,
        )
    }
    | {
        f"M{k}"
        for k in (
            125,
            126,
            127,
            140,
            141,
            142,
            143,
            144,
            145,
            150,
            155,
            163,
            164,
            165,
            190,
            191,
            200,
            201,
            201.1,
        )
    }
    | {
        f"M{k}"
        for k in (
            202,
            203,
            204,
            205,
            207,
            208,
            209,
            211,
            220,
            221,
            240,
            250,
            280,
            291,
            292,
            300,
            301,
            302,
            303,
            304,
        )
    }
    | {
        f"M{k}"
        for k in (
            307,
            350,
            355,
            400,
            401,
            402,
            403,
            404,
            405,
            406,
            407,
            412,
            413,
            420,
            486,
            500,
            501,
            502,
            503,
            550,
        )
    }
    | {
        f"M{k}"
        for k in (
            566,
            569,
            572,
            592,
            593,
            600,
            601,
            602,
            603,
            701,
            702,
            710,
            851,
            862.1,
            862.2,
            862.3,
            862.4,
            862.5,
        )
    }
    | {
        f"M{k}"
        for k in (
            862.6,
            871,
            900,
            906,
            907,
            911,
            912,
            913,
            914,
            915,
            928,
            930,
            950,
            960,
            970,
            970.3,
            973,
            974,
            975,
        )
    }
    | {
        f"M{k}"
        for k in (976, 982, 982.2, 982.4, 983, 984, 991, 1002, 1003, 1004, 1006, 17.1, 143.1)
    }
)
HARMLESS_MACROS = frozenset(
    {
        "EXCLUDE_OBJECT_DEFINE",
        "EXCLUDE_OBJECT_START",
        "EXCLUDE_OBJECT_END",
        "DEFINE_OBJECT",
        "SET_VELOCITY_LIMIT",
    }
    | {
        "SET_PRESSURE_ADVANCE",
        "SET_PRINT_STATS_INFO",
        "SET_FAN_SPEED",
        "TIMELAPSE_TAKE_FRAME",
        "TIMELAPSE_RENDER",
    }
    | {
        "SET_HEATER_TEMPERATURE",
        "TEMPERATURE_WAIT",
        "TURN_OFF_HEATERS",
        "SET_LED",
        "RESPOND",
        "ECHO",
    }
)


@dataclass(frozen=True, eq=False)
class _Run:
    """A run of extruding moves.

    points: (n, 3) mm. directions: (n, 3), None without rotary words. comments: number of layer
    comments before the run. role: the slicer's type.
    """

    points: Array
    directions: Array | None
    comments: int
    role: str | None

    @property
    def length(self) -> float:
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    @property
    def heights(self) -> tuple[float, float]:
        return float(self.points[:, 2].min()), float(self.points[:, 2].max())


@dataclass
class _State:
    """Modes and positions of a program.

    coordinates: program coordinates. extruders: extruder positions in Klipper and in Marlin.
    """

    coordinates: dict[str, float] = field(default_factory=lambda: dict.fromkeys("XYZABC", 0.0))
    extruders: list[float] = field(default_factory=lambda: [0.0, 0.0])
    shift: Array = field(default_factory=lambda: np.zeros(3))
    absolute: bool = True
    extruder_mode: str = ""  # M82 or M83; '' before the first of them

    def copied(self) -> _State:
        """Return an independent copy."""
        return _State(
            dict(self.coordinates),
            list(self.extruders),
            self.shift.copy(),
            self.absolute,
            self.extruder_mode,
        )

    def extruder_is_relative(self) -> tuple[bool, bool]:
        """Return whether E is relative, for Klipper and for Marlin."""
        relative = self.extruder_mode == "M83"
        return (
            relative or not self.absolute,
            relative or (not self.absolute and self.extruder_mode != "M82"),
        )

    @property
    def modes(self) -> tuple[bool, str]:
        """Whether moves are absolute, and the extruder mode."""
        return self.absolute, self.extruder_mode

    @property
    def place(self) -> Array:
        return np.array([self.coordinates[axis] for axis in "XYZ"]) + self.shift


def curves_of(
    text: str, where: str, chord_error: float, roles: str = roles_of.PART, rotary: str = NO_ROTARY
) -> tuple[BeadCurve, ...]:
    """Read the beads of a program, in program coordinates.

    Parameters
    ----------
    text : str
        The program.
    where : str
        Name of the file, for messages.
    chord_error : float
        Chord error of arcs, mm.
    roles : str, optional
        Slicer roles to deposit.
    rotary : str, optional
        How the words A, B and C rotate the tool, one of `ROTARY`.

    Returns
    -------
    tuple of BeadCurve
        Beads in order.

    Raises
    ------
    InputError
        BAD_GCODE with the line.
    """
    return read(text, where, chord_error, roles, rotary).curves


def read(
    text: str, where: str, chord_error: float, roles: str = roles_of.PART, rotary: str = NO_ROTARY
) -> ReadCurves:
    """Read the beads of a program, and report unread content.

    Parameters
    ----------
    text
        The program.
    where
        Name of the program, for messages.
    chord_error
        Maximum distance between an arc and its chords, mm.
    roles
        ``part``, ``all``, or slicer groups and types separated by commas; a note reports omitted
        moves.
    rotary
        How the words A, B and C rotate the tool, one of `ROTARY`; ``none`` rejects these words.

    Raises
    ------
    InputError
        BAD_GCODE with the line; BAD_VALUE for roles that the file does not have.
    """
    if text.startswith("GCDE"):
        raise InputError(
            CODE, where, "the file is binary G-code; export G-code as text from the slicer"
        )
    reader = _Reader(where, chord_error, rotary)
    for number, line in enumerate(text.lstrip("\ufeff").splitlines(), 1):
        reader.take(line, number)
    return reader.finish(roles)


def _leaves_the_path(command: Command) -> bool:
    """Return whether a machine code or macro is known not to change the path."""
    name = command.name
    if name == "M92":  # steps per mm scale an axis
        return not {letter for letter, _ in command.words} & set("XYZ")
    return name in HARMLESS_M or name in HARMLESS_MACROS or name.startswith("BED_MESH_")


class _Reader:
    """Interpreter of a program: head position, modes, and beads up to the current line."""

    def __init__(self, where: str, chord_error: float, rotary: str) -> None:
        self.where, self.chord_error, self.rotary = where, chord_error, rotary
        self.state, self.stored = _State(), dict[str, _State]()
        self.pushed: list[tuple[bool, str]] = []  # modes at each M120 that has no M121 yet
        self.known: set[str] = set()  # axes with a defined position
        self.motion = ""
        self.plane, self.unit = "G17", 1.0
        self.points: list[Array] = []
        self.directions: list[Array] = []
        self.runs: list[_Run] = []
        self.comments, self.line = 0, 0
        self.role: str | None = None
        self.tool, self.tools = "T0", set[str]()
        self.ended = ""  # code that ended the program
        self.not_read: dict[str, list[int]] = {}  # names of macros and codes, and their lines

    def take(self, line: str, number: int) -> None:
        """Read one line."""
        self.line = number
        try:
            code, comments = split_comments(line)
            for comment in comments:
                self._take_comment(comment)
            if not code or code[0] in "%:":
                return
            if code[0] == "/":
                raise BadWords(
                    Text(
                        "a switch of the machine decides whether a line with a slash runs; remove "
                        "the line, or the slash"
                    )
                )
            commands = commands_of(code)
        except BadWords as error:
            raise self._error(error.text) from None
        machine_frame, moved = False, False
        for command in commands:
            if command.name == "G53":
                machine_frame = True
                if not command.words:
                    continue
                command = Command("", command.words)
            if command.name == "" and command is not commands[-1]:
                raise self._error(
                    Text("{} comes before a command; write the command first", command.words[0][0])
                )
            if moved and command.name in ("G90", "G91", "G53", "M82", "M83", *PLANES, *UNITS):
                raise self._error(
                    Text("{} follows a move on the same line; begin a new line there", command.name)
                )
            moved |= command.name in (*MOTIONS, "")
            self._run(command, machine_frame)

    def _take_comment(self, comment: str) -> None:
        if LAYER.match(comment):
            self._end()
            self.comments += 1
        role = roles_of.read_role(comment)
        if role is not None and role != self.role:
            self._end()
            self.role = role

    def _run(self, command: Command, machine_frame: bool) -> None:
        name = command.name
        if name == "":
            name = self._modal(command)
            if not name:
                return
        if name in MOTIONS:
            self.motion = name
            self._move(name, self._numbers(command), machine_frame)
        elif name == "T":
            self._end()
            self.tool = f"T{command.arguments or '0'}"
        elif self._is_refused(command):
            return
        elif name in ("G90", "G91", "M82", "M83", *PLANES, *UNITS):
            self._set_mode(command)
        elif name in ("G92", "G92.1"):
            self._reset_origin(command)
        elif name in OWN_MOTION or VENDOR.fullmatch(name):
            self._home(command)
        elif name in ("G10", "G11", "G22", "G23"):
            self._retract(command)
        elif name not in NO_MOTION:
            self._other(command)

    def _modal(self, command: Command) -> str:
        """Return the modal motion of words without a command; '' for a program number."""
        letter = command.words[0][0]
        if letter == "O" and len(command.words) == 1 and command.words[0][1] is not None:
            return ""
        if letter in "OPNDHLQ" or not self.motion:
            raise self._error(
                Text("{} has no command before it; begin the line with G, M or T", letter)
            )
        return self.motion

    def _is_refused(self, command: Command) -> bool:
        """Return True for codes that are harmless with these words.

        Raises InputError for codes that would be misinterpreted.
        """
        name = command.name
        reason = REFUSED.get(name) or (
            REFUSED.get(name.split(".")[0])
            if name[0] == "G" and "." in name and name != "G64.1"
            else None
        )
        values = dict(command.words)
        if name == "SET_GCODE_OFFSET" and not re.search(
            r"\b[XYZ]\w*\s*=\s*[-+]?0*\.?0*[1-9]", command.arguments, re.IGNORECASE
        ):
            return True
        if name == "M206" and not any(values.get(axis) for axis in "XYZ"):
            return True
        if name == "M98" and re.match(r"[Pp]\s*\d", command.arguments):
            reason = REFUSED["M97"]
        if name == "M486" and CANCELLED.fullmatch(command.arguments):
            reason = REFUSED["EXCLUDE_OBJECT"]
        if name == "M605" and values.get("S", 0.0) not in (0.0, 1.0):
            reason = "the command prints copies side by side; export a single copy"
        if WORK_OFFSETS.fullmatch(name):
            reason = "the origin of another work offset is unknown; remove the command"
        if name.startswith("G43.4") and self.rotary != NO_ROTARY:
            return True
        if reason is not None:
            raise self._error(Text("{}: {}", name, Text(reason)))
        return False

    def _set_mode(self, command: Command) -> None:
        if command.words:
            raise self._error(
                Text(
                    "{} is followed by the word {} on the same line; begin a new line there",
                    command.name,
                    command.words[0][0],
                )
            )
        if command.name in ("G90", "G91"):
            self.state.absolute = command.name == "G90"
        elif command.name in PLANES:
            self.plane = command.name
        elif command.name in UNITS:
            self.unit = UNITS[command.name]
        else:
            self.state.extruder_mode = command.name

    def _home(self, command: Command) -> None:
        """Handle an automatic move; homed axes use the machine origin."""
        self._end()
        axes = {letter for letter, _ in command.words if letter in "XYZ"} or set("XYZ")
        self.known -= axes
        if VENDOR.fullmatch(command.name):
            self.not_read.setdefault(command.name, []).append(self.line)
        if command.name == "G28":
            for k, axis in enumerate("XYZ"):
                if axis in axes:
                    self.state.coordinates[axis], self.state.shift[k] = 0.0, 0.0

    def _retract(self, command: Command) -> None:
        """Handle retract, recover and tool temperatures; reject offsets."""
        self._end()
        letters = {letter for letter, _ in command.words}
        if letters & set("XYZABCL"):
            raise self._error(Text("{} sets unknown offsets; remove the command", command.name))

    def _other(self, command: Command) -> None:
        """Handle machine codes and macros that do not change the path; record unknown codes."""
        name = command.name
        if name in ("M2", "M30", "M112") and not command.arguments:
            self._end()
            self.ended = name
        elif name == "SAVE_GCODE_STATE":
            self.stored[self._state_name(command)] = self.state.copied()
        elif name == "RESTORE_GCODE_STATE":
            self._restore(command)
        elif name in ("M120", "M121"):
            self._push_or_pop(name)
        elif name[0] == "G" and name[1:2].isdigit():
            raise self._error(Text("unknown command {}; {}", name, Text(FORM)))
        elif name in ("M98", "M32"):  # another file of the machine
            self._end()
            self.not_read.setdefault(f"{name} {command.arguments}".strip(), []).append(self.line)
        elif not _leaves_the_path(command):
            self._end()
            self.not_read.setdefault(name, []).append(self.line)

    def _state_name(self, command: Command) -> str:
        match = re.search(r"NAME\s*=\s*(\S+)", command.arguments, re.IGNORECASE)
        return match[1] if match else "default"

    def _restore(self, command: Command) -> None:
        """Handle RESTORE_GCODE_STATE of Klipper: restore modes and origins.

        The head does not move unless MOVE is 1.
        """
        stored = self.stored.get(self._state_name(command))
        if stored is None:
            raise self._error(
                Text(
                    "{} restores a state that was never stored; store the state first", command.name
                )
            )
        self._end()
        position, state = self.state.place, stored.copied()
        if not re.search(r"MOVE\s*=\s*1", command.arguments, re.IGNORECASE):
            for k, axis in enumerate("XYZ"):
                state.coordinates[axis] = float(position[k] - state.shift[k])
        self.state = state

    def _push_or_pop(self, name: str) -> None:
        """Handle M120 and M121, which store and restore modes in RepRapFirmware only."""
        if name == "M120":
            self.pushed.append(self.state.modes)
            return
        stored = self.pushed.pop() if self.pushed else self.state.modes
        if stored != self.state.modes:
            raise self._error(
                "M121 restores the modes before M120 on RepRapFirmware, but keeps the current "
                "modes on Marlin; write G90 or G91, and M82 or M83 instead"
            )

    def _numbers(self, command: Command) -> dict[str, float]:
        """Return the words of a motion, mm. Raises InputError for wrong words or no numbers."""
        allowed = LINEAR_WORDS if self.motion in ("G0", "G1") else ARC_WORDS
        numbers: dict[str, float] = {}
        for letter, value in command.words:
            if letter in "ABC":
                self._check_rotary(letter, value)
            elif letter not in allowed:
                raise self._error(
                    Text(
                        "{} does not take the word {}; remove the word, or use one of {}",
                        self.motion,
                        letter,
                        " ".join(sorted(allowed)),
                    )
                )
            if value is None:
                raise self._error(Text("{} has no number; add a number", letter))
            if letter in LENGTH_WORDS:
                value *= self.unit
            if letter != "F" and abs(value) > MAX_MM:
                raise self._error(
                    Text("{} is {:g}; give a number of at most {:g}", letter, value, MAX_MM)
                )
            numbers[letter] = value
        return numbers

    def _check_rotary(self, letter: str, value: float | None) -> None:
        if self.rotary == ANY_ROTARY:
            return
        axes = "" if self.rotary == NO_ROTARY else self.rotary[-2:].upper()
        if letter not in axes and value != 0.0:
            raise self._error(
                Text(
                    "{} rotates an axis, but strategy.rotary is {}; set how A, B and C turn the "
                    "tool ({}), or remove these words",
                    letter,
                    self.rotary,
                    ", ".join(ROTARY[1:]),
                )
            )

    def _reset_origin(self, command: Command) -> None:
        """Handle G92: set the coordinates of the program without moving the head."""
        state, position = self.state, self.state.place
        if command.name == "G92.1":
            state.shift = np.zeros(3)
            state.coordinates.update(zip("XYZ", position.tolist()))
            return
        for letter, value in command.words:
            if letter not in "XYZEABC" or value is None:
                raise self._error(
                    Text("G92 does not take {} here; give X, Y, Z or E with a number", letter)
                )
            if letter in "ABC":
                self._check_rotary(letter, value - self.state.coordinates[letter])
        words = {
            letter: float(value or 0.0) * (self.unit if letter in LENGTH_WORDS else 1.0)
            for letter, value in command.words
        }
        for axis in "XYZ":
            if axis in words or not words:
                state.coordinates[axis] = words.get(axis, 0.0)
        if "E" in words or not words:
            state.extruders = [words.get("E", 0.0)] * 2
        state.shift = position - np.array([state.coordinates[axis] for axis in "XYZ"])

    def _extrude(self, words: dict[str, float]) -> bool:
        """Return whether a move extrudes. Raises InputError if Klipper and Marlin disagree."""
        if "E" not in words:
            return False
        value, extrudes = words["E"], []
        for k, relative in enumerate(self.state.extruder_is_relative()):
            previous = self.state.extruders[k]
            self.state.extruders[k] = previous + value if relative else value
            extrudes.append(self.state.extruders[k] - previous > EXTRUSION_TOLERANCE_MM)
        if extrudes[0] != extrudes[1]:
            raise self._error(
                "M82 and G91 are both on: Klipper counts E from the previous position, Marlin "
                "from zero; write M83, or G90"
            )
        return extrudes[0]

    def _target(self, words: dict[str, float], machine_frame: bool) -> None:
        state = self.state
        if machine_frame and not state.absolute:
            raise self._error(
                "G53 with relative moves (G91) is not supported; write G90 before G53"
            )
        for k, axis in enumerate("XYZ"):
            if axis in words:
                self.known.add(axis)
                value = words[axis] - (state.shift[k] if machine_frame else 0.0)
                state.coordinates[axis] = float(
                    value if state.absolute else state.coordinates[axis] + value
                )
        for axis in "ABC":
            if axis in words:
                value = words[axis]
                state.coordinates[axis] = (
                    value if state.absolute else state.coordinates[axis] + value
                )

    def _move(self, name: str, words: dict[str, float], machine_frame: bool) -> None:
        start, angles_before = self.state.place, [self.state.coordinates[axis] for axis in "ABC"]
        extrudes = self._extrude(words)
        self._target(words, machine_frame)
        end = self.state.place
        if name in ("G2", "G3"):
            points = self._arc(name, start, end, words, extrudes)
        else:
            points = [end]
        still = len(points) == 1 and math.dist(start.tolist(), end.tolist()) < MIN_STEP_MM
        if not extrudes or still:
            self._end()
            return
        self._check_extruding()
        if self.rotary in (NO_ROTARY, ANY_ROTARY):
            self.points += points if self.points else [start, *points]
            return
        angles_after = [self.state.coordinates[axis] for axis in "ABC"]
        angles = np.array([angles_before, angles_after])
        if len(points) == 1:
            count = max(1, math.ceil(float(np.abs(angles[1] - angles[0]).max()) / MAX_TURN_DEG))
            points = [start + k / count * (end - start) for k in range(1, count)] + [end]
        if not self.points:
            self.points, self.directions = [start], [self._direction(angles[0])]
        share = np.arange(1, len(points) + 1) / len(points)
        self.points += points
        self.directions += [self._direction(angles[0] + s * (angles[1] - angles[0])) for s in share]

    def _check_extruding(self) -> None:
        if self.ended:
            raise self._error(
                Text(
                    "a move extrudes after {}, the end of the program; remove the lines that "
                    "follow",
                    self.ended,
                )
            )
        if len(self.known) < 3:
            raise self._error(
                Text(
                    "a move extrudes before its position is defined; set X, Y and Z first; {}",
                    FORM,
                )
            )
        self.tools.add(self.tool)

    def _direction(self, angles: Array) -> Array:
        """Return the unit vector from deposit to tool for the angles A, B and C, deg."""
        a, b, c = np.radians(angles)
        if self.rotary.startswith("table"):  # the part rotates, hence negative tool angles
            a, b, c = -a, -b, -c
        if self.rotary.endswith("ac"):
            tilted = (0.0, -math.sin(a), math.cos(a))
        else:
            tilted = (math.sin(b), 0.0, math.cos(b))
        x, y, z = tilted
        return np.array([x * math.cos(c) - y * math.sin(c), x * math.sin(c) + y * math.cos(c), z])

    def _arc(
        self, name: str, start: Array, end: Array, words: dict[str, float], extrudes: bool
    ) -> list[Array]:
        """Return the points (3,) of an arc without the first point."""
        if extrudes and words.get("P", 0.0) > 1.0:
            raise self._error(
                "P requests several turns, which are not supported; write out each turn"
            )
        if self.plane == "G18":
            raise self._error(
                "arcs are in the plane of X and Z (G18), which Klipper and other controllers "
                "turn in opposite ways; set the slicer to write arcs in another plane, or lines "
                "only"
            )
        axes, letters = PLANES[self.plane]
        start, end = start[list(axes)], end[list(axes)]
        for letter in {"I", "J", "K"} - {*letters}:
            if letter in words:
                raise self._error(
                    Text(
                        "{} does not belong to an arc in {}; use {} and {}",
                        letter,
                        self.plane,
                        letters[0],
                        letters[1],
                    )
                )
        middle = self._middle(name, start, end, words, letters)
        start_radius, end_radius = start[:2] - middle, end[:2] - middle
        radius = float(np.hypot(*start_radius))
        if radius < MIN_STEP_MM or abs(radius - float(np.hypot(*end_radius))) > max(
            ARC_END, 1e-3 * radius
        ):
            raise self._error(
                Text(
                    "the ends of the arc are {:.4g} and {:.4g} mm from its centre; give {} and "
                    "{} from its start to its centre",
                    radius,
                    np.hypot(*end_radius),
                    letters[0],
                    letters[1],
                )
            )
        turn = math.atan2(end_radius[1], end_radius[0]) - math.atan2(
            start_radius[1], start_radius[0]
        )
        turn = -(-turn % (2.0 * math.pi)) if name == "G2" else turn % (2.0 * math.pi)
        if abs(turn) < 1e-9:
            turn = -2.0 * math.pi if name == "G2" else 2.0 * math.pi
        step = 2.0 * math.acos(max(1.0 - self.chord_error / radius, 0.0))
        count = step_count(abs(turn), max(step, 1e-3))
        share = np.arange(1, count + 1) / count
        angle = math.atan2(start_radius[1], start_radius[0]) + share * turn
        reach = radius + share * (float(np.hypot(*end_radius)) - radius)
        rows = np.column_stack(
            [
                middle[0] + reach * np.cos(angle),
                middle[1] + reach * np.sin(angle),
                start[2] + share * (end[2] - start[2]),
            ]
        )
        rows[-1] = end
        return list(rows[:, np.argsort(axes)])

    def _middle(
        self, name: str, start: Array, end: Array, words: dict[str, float], letters: str
    ) -> Array:
        """Return the centre (2,) of an arc in its plane, from the words `letters` or from R."""
        if words.keys() & {*letters}:
            if "R" in words:
                raise self._error(
                    Text(
                        "the arc has both {} or {} and R; use one of these forms",
                        letters[0],
                        letters[1],
                    )
                )
            return np.asarray(start[:2] + np.array([words.get(letter, 0.0) for letter in letters]))
        if "R" not in words:
            raise self._error(
                Text(
                    "{} has neither {} and {} nor R; give the centre of the arc or its radius",
                    name,
                    letters[0],
                    letters[1],
                )
            )
        radius, chord = words["R"], end[:2] - start[:2]
        length = float(np.hypot(*chord))
        if length < MIN_STEP_MM or abs(2.0 * radius) < length * (1.0 - 1e-6):
            raise self._error(
                Text(
                    "a radius of {:g} mm cannot join points {:.4g} mm apart; use {} and {}",
                    radius,
                    length,
                    letters[0],
                    letters[1],
                )
            )
        middle_distance = math.sqrt(max(radius * radius - 0.25 * length * length, 0.0))
        left_normal = np.array([-chord[1], chord[0]]) / length
        side = (1.0 if name == "G3" else -1.0) * (1.0 if radius > 0.0 else -1.0)
        middle: Array = start[:2] + 0.5 * chord + side * middle_distance * left_normal
        return middle

    def _end(self) -> None:
        """End the current bead."""
        if self.points:
            points = np.array(self.points)
            directions = np.array(self.directions) if self.directions else None
            distinct = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > MIN_STEP_MM]
            if distinct.sum() > 1:
                kept_directions = None if directions is None else directions[distinct]
                self.runs.append(_Run(points[distinct], kept_directions, self.comments, self.role))
        self.points, self.directions = [], []

    def _error(self, message: str) -> InputError:
        return InputError(CODE, f"{self.where} line {self.line}", message)

    def finish(self, roles: str) -> ReadCurves:
        """Return the beads of given roles with their layers, and issues about omitted content."""
        self._end()
        if not self.runs:
            raise InputError(
                CODE, self.where, "none of the moves extrudes, so there is no bead; {}", FORM
            )
        if any(run.role is not None for run in self.runs):
            self.runs = [
                _Run(run.points, run.directions, run.comments, run.role or roles_of.BEFORE)
                for run in self.runs
            ]
        runs, issues = roles_of.choose_runs(self.runs, roles, self.where, CODE)
        curves = tuple(
            BeadCurve(run.points, run.directions, layer)
            for run, layer in zip(runs, _layers(runs, self.comments > 0))
        )
        return ReadCurves(curves, (*issues, *self._notes()))

    def _notes(self) -> list[Issue]:
        issues = []
        if self.not_read:
            names = Text.joined(
                ", ",
                (
                    Text("{} (line {}, {} in all)", name, lines[0], len(lines))
                    if len(lines) > 1
                    else Text("{} (line {})", name, lines[0])
                    for name, lines in self.not_read.items()
                ),
            )
            message = Text(
                "{}: {} ignored: machine codes and macros, assumed to cause no motion and no "
                "deposit",
                self.where,
                names,
            )
            issues.append(Issue(NOTE, NOT_READ, message))
        if len(self.tools) > 1:
            message = Text(
                "{}: tools {} all deposit, and are replaced by the tool of the cell",
                self.where,
                ", ".join(sorted(self.tools)),
            )
            issues.append(Issue(NOTE, NOT_READ, message))
        return issues


def _layers(runs: Sequence[_Run], has_comments: bool) -> list[int]:
    """Return the layer of each run, from 0: by comments if the file has them, otherwise by Z.

    Runs before the first comment at a common height, such as a purge line, belong to the first
    layer. Consecutive runs at a common height share a layer.
    """
    keys: list[float] = [
        float(run.comments) if has_comments else round(float(run.points[0, 2]), 3) for run in runs
    ]
    if has_comments:
        first_key = next((key for key in keys if key > 0.0), 0.0)
        preliminary = [run for run, key in zip(runs, keys) if key == 0.0]
        if preliminary and _span(preliminary) <= SAME_HEIGHT:
            keys = [key or first_key for key in keys]
    groups: list[list[int]] = []
    for k, key in enumerate(keys):
        if groups and keys[groups[-1][0]] == key:
            groups[-1].append(k)
        else:
            groups.append([k])
    layers, layer = [0] * len(runs), -1
    previous: list[_Run] = []
    for group in groups:
        members = [runs[k] for k in group]
        layer += not (previous and _span([*previous, *members]) <= SAME_HEIGHT)
        previous = members
        for k in group:
            layers[k] = layer
    return layers


def _span(runs: Sequence[_Run]) -> float:
    """Return the height between the lowest and the highest point of runs, mm."""
    low, high = zip(*(run.heights for run in runs))
    return float(max(high) - min(low))
