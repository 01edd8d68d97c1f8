# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read LinuxCNC programs back: model the controller from the program text alone.

Shares no code with the writer. Accepts only the lines that a path needs and rejects everything
else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from ...core.issues import Text
from ...core.read_moves import ReadMoves
from ..nc_read import AXES, TIME, TIP, Shape, Track, unreadable

_NUMBER = r"-?\d+(?:\.\d*)?|-?\.\d+"
_WORD = re.compile(rf"([XYZABCF])({_NUMBER})$")
_SUB = re.compile(r"O<(\w+)> (SUB|ENDSUB|CALL)$")
_COMMENT = re.compile(
    r"\((?!\s*(?:ABORT|DEBUG|ERROR|LOG\w*|MSG|PRINT|PROBE\w*|PY|WARNING)\s*,)[^()]*\)"
)
_HARMLESS = re.compile(r"G92\.2$")
_CORNERS = re.compile(rf"G61(\.1)?$|G64(?: P({_NUMBER}))?(?: Q({_NUMBER}))?$")
_TOOL = re.compile(r"G43 H(\d+)$")
_INPUT = re.compile(r"M66 P(\d+) L3 Q(\d+)$")
_LAYER = re.compile(r"\(LAYER (\d+)\)$")
_SAMPLE = re.compile(r"M66 E(\d+) L0$")
_LOOP = re.compile(rf"O<(\w+)> (?:WHILE \[#5399 GE ({_NUMBER})\]|ENDWHILE)$")
_DWELL = re.compile(rf"G4 P({_NUMBER})$")
_ZERO = re.compile(r"G10 L2 P9( [XYZABCR]0)+$")
_OUTPUT = re.compile(r"M(6[2-5]) P(\d+)$|M(\d+)$")
_WIRE = re.compile(rf"M6([78]) E(\d+) Q({_NUMBER})$")
_SCHEDULE = re.compile(r"M6([78]) E(\d+) Q(\d+)$")
_OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
_FEEDS, _UNITS = {"G93", "G94"}, {"G21", "G90"}
_PLAIN = {"G17", "G40", "G80"}
# M words that stop or end a program, change tools or modes, or orient a spindle
_TAKEN = {
    *[
        "0",
        "1",
        "2",
        "6",
        "19",
        "30",
        "47",
        "48",
        "49",
        "50",
        "51",
        "52",
        "53",
        "60",
        "61",
        "70",
        "71",
        "72",
        "73",
        "98",
        "99",
    ]
}
_TIP_ON, _TIP_OFF = "M428", "M429"


@dataclass
class _State:
    """The modal state while programs are executed."""

    files: dict[str, list[tuple[str, str]]]
    track: Track = field(default_factory=Track)
    schedules: set[str] = field(default_factory=set)
    units: set[str] = field(default_factory=set)
    feed: str = "G94"
    linear: bool = False
    offset: str = ""
    kinematics: str = ""
    zeroed: set[str] = field(default_factory=set)
    output: str = ""
    switched: str = ""  # file and line of the last switch of the output
    on_word: str = ""
    off_word: str = ""
    sampled: str = ""
    shape: Shape | None = None
    loop: tuple[str, str] = ("", "")


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with the program that is not a sub.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    programs: dict[str, list[tuple[str, str]]] = {}
    main = []
    for file, content in files.items():
        name, lines = file.rpartition(".")[0].upper(), _lines(file, content)
        if not file.lower().endswith(".ngc") or not lines or lines[-1][1] != "M2":
            raise unreadable(file, "the file is not a program that ends with M2")
        programs[name] = lines[:-1]
        if not _is_sub(name, lines[:-1]):
            main.append(name)
    if len(main) != 1:
        raise unreadable(
            "program",
            Text("{} programs are not subs, but exactly one must be the main program", len(main)),
        )
    state = _State(programs)
    _follow(main[0], programs[main[0]], state, ())
    if state.track.on or state.loop[0]:
        raise unreadable("program", "the program ends with the deposit on, or within a loop")
    return state.track.moves()


def _is_sub(name: str, lines: list[tuple[str, str]]) -> bool:
    """Whether the lines of a program form a single sub with the program's name."""
    begin, end = f"O<{name}> SUB", f"O<{name}> ENDSUB"
    if not any(text == begin for _, text in lines):
        return False
    for (where, text), expected in ((lines[0], begin), (lines[-1], end)):
        if text != expected:
            raise unreadable(where, Text("{!r} is outside the sub {}", text, name))
    return True


def _lines(file: str, content: bytes) -> list[tuple[str, str]]:
    """Return file and line number of each line, and its words without comments."""
    located_lines = []
    for number, line in enumerate(content.decode("latin-1").upper().split("\n"), 1):
        layer = _LAYER.match(line.strip())
        text = line.strip() if layer else " ".join(_COMMENT.sub(" ", line).split())
        if len(line) > 250 or (not layer and "(" in text) or ";" in text:
            raise unreadable(
                f"{file} line {number}",
                "the comment may be executed, or the line is too long",
            )
        if text:
            located_lines.append((f"{file} line {number}", text))
    return located_lines


def _follow(
    name: str, lines: list[tuple[str, str]], state: _State, callers: tuple[str, ...]
) -> None:
    """Execute the lines of a program in order, and the subs that it calls."""
    if name in callers:
        raise unreadable(name, "the program calls itself")
    for where, text in lines:
        words = None if state.shape is None or state.loop[0] else state.shape.words(text)
        if words is not None:
            state.linear, state.sampled = True, ""
            _move(where, words, state)
            continue
        if _cooled(where, text, state):
            continue
        if sub := _SUB.match(text):
            if sub[2] != "CALL":
                raise unreadable(where, Text("{!r} is not understood here", text))
            _call(where, sub[1], state, (*callers, name))
        else:
            _carry_out(where, text, state)


def _tells_schedule(schedule: re.Match[str], state: _State) -> bool:
    """Whether an analogue output selects a schedule.

    Unlike the wire output, a schedule output is set at standstill before corners are rounded.
    Within a bead, the outputs for schedules are already known.
    """
    if schedule[1] == "8" and state.track.exact:
        state.schedules.add(schedule[2])
        state.track.rests()
        return True
    return schedule[1] == "7" and state.track.on and schedule[2] in state.schedules


def _carry_out(where: str, text: str, state: _State) -> None:
    for form, instruction in _INSTRUCTIONS.items():
        if match := form.match(text):
            instruction(match, where, state)
            return
    if not _HARMLESS.match(text):
        _line(where, text, state)


def _zero(zero: re.Match[str], where: str, state: _State) -> None:
    """Set the axis offsets to zero."""
    state.zeroed = {word[0] for word in zero.string.split()[3:]}


def _analogue(output: re.Match[str], where: str, state: _State) -> None:
    """Set an analogue output, which selects a schedule or sets the wire feed."""
    schedule = _SCHEDULE.match(output.string)
    if schedule and _tells_schedule(schedule, state):
        state.track.happens("schedule", float(schedule[2]) + 1.0, float(schedule[3]))
        return
    if output[1] == "8" and state.track.on:
        raise unreadable(where, "the analogue output stops the machine within a bead")
    state.track.set_wire(int(output[2]) + 1, output[3], where)
    if output[1] == "8":
        state.track.rests()


def _layer(layer: re.Match[str], where: str, state: _State) -> None:
    state.track.happens("layer", float(layer[1]))


def _corners(corners: re.Match[str], where: str, state: _State) -> None:
    """Set the corner rounding."""
    state.track.exact = corners[0] == "G61.1"
    # G61 stops only where needed; our programs use the same tolerance for corners and points
    is_known = corners[2] and corners[2] == corners[3]
    state.track.rounding = float(corners[2]) if is_known else 0.0 if corners[1] else float("inf")


def _tool(tool: re.Match[str], where: str, state: _State) -> None:
    state.track.tool = float(tool[1])


def _wait_input(wait: re.Match[str], where: str, state: _State) -> None:
    state.track.rests()
    state.track.happens("input", float(wait[1]) + 1.0)


def _dwell(dwell: re.Match[str], where: str, state: _State) -> None:
    state.track.rests()
    state.track.waits(dwell[1])


def _cooled(where: str, text: str, state: _State) -> bool:
    """Whether a line belongs to a loop that waits until an analogue input is below a value."""
    sampled, state.sampled = state.sampled, ""
    loop = _LOOP.match(text)
    if sample := _SAMPLE.match(text):
        if state.loop[1] not in ("", sample[1]):
            raise unreadable(
                where,
                "the loop reads another analogue input than the one that the program waits for",
            )
        state.sampled = sample[1]
    elif loop and loop[2] and sampled and not state.loop[0]:
        state.loop = loop[1], sampled
        if state.track.on:
            raise unreadable(where, "the program waits for an analogue input within a bead")
        state.track.happens("below", float(sampled) + 1.0, float(loop[2]), digits=1e-6)
    elif loop and not loop[2] and sampled and state.loop[0] == loop[1]:
        state.loop = "", ""
    elif loop or (state.loop[0] and not _DWELL.match(text)):
        raise unreadable(
            where, Text("{!r} is in or around a loop that waits for an analogue input", text)
        )
    else:
        return bool(state.loop[0])
    return True


def _call(where: str, name: str, state: _State, callers: tuple[str, ...]) -> None:
    if state.track.on or state.kinematics == _TIP_ON:
        raise unreadable(where, "the program calls another program within a bead")
    if name in state.files:
        _follow(name, state.files[name][1:-1], state, callers)
    else:
        # a program on the controller leaves unknown settings
        state.units, state.offset, state.zeroed, state.linear, state.kinematics = (
            set(),
            "",
            set(),
            False,
            "",
        )
        state.track.happens("call", name)
        state.track.rests()
        state.track.tool, state.track.exact, state.track.rounding = (
            float("nan"),
            False,
            float("inf"),
        )


def _line(where: str, text: str, state: _State) -> None:
    words: dict[str, str] = {}
    for token in text.split():
        if word := _WORD.match(token):
            if word[1] in words:
                raise unreadable(where, Text("{} is duplicated", word[1]))
            words[word[1]] = word[2]
        elif token == "G1":
            state.linear = True
        elif token in _FEEDS:
            state.feed = token
        elif token in _UNITS:
            state.units.add(token)
        elif token in _OFFSETS:
            state.offset = token
            state.track.frame = _OFFSETS.index(token) + 1.0
        elif token == "G49":
            state.track.tool = 0.0  # none
        elif token not in _PLAIN:
            raise unreadable(where, Text("{!r} is not understood", token))
    if words:
        _move(where, words, state)
        state.shape = Shape.of(text)


def _move(where: str, words: dict[str, str], state: _State) -> None:
    if not state.linear or state.units != _UNITS or not state.offset:
        raise unreadable(where, "the program moves before G1, G21, G90 and a work offset are set")
    if state.kinematics == _TIP_ON:
        if state.feed != "G94" or state.offset == "G59.3":
            raise unreadable(
                where, "a position on the part needs G94 and a work offset for the part"
            )
        if {*words} != {*state.track.axes, *"XYZF"}:
            raise unreadable(where, "a position on the part needs X Y Z and all rotary axes")
        state.track.add(TIP, words, where)
        return
    if state.offset != "G59.3" or not set(words) - {"F"} <= state.zeroed:
        raise unreadable(where, "axes move in a frame other than the machine frame")
    state.track.add(TIME if state.feed == "G93" else AXES, words, where)


def _switch(output: re.Match[str], where: str, state: _State) -> None:
    """Switch the kinematics or the deposit.

    The deposit is switched by an output, or by two M words of which the first switches on.
    """
    text = output.string
    if text in (_TIP_ON, _TIP_OFF):
        if state.track.on:
            raise unreadable(where, "the kinematics changes while the deposit is on")
        state.kinematics = text
        state.track.rests()
        return
    if output[1]:
        name, on, wrong = f"P{output[2]}", output[1] in ("62", "64"), False
    else:
        state.on_word = state.on_word or text
        on = text == state.on_word
        if not on:
            state.off_word = state.off_word or text
        name, wrong = "M", text not in (state.on_word, state.off_word) or output[3] in _TAKEN
    if wrong:
        raise unreadable(where, Text("{!r} is not understood", text))
    if state.output not in ("", name):
        raise unreadable(
            where, Text("{!r} switches a second output; the first is {}", text, state.switched)
        )
    state.switched = where
    state.output, state.track.on = name, on
    if output[1] not in ("62", "63"):  # M62 and M63 take effect with the next move instead
        state.track.rests()
    state.track.happens("on" if on else "off", float(output[2]) + 1.0 if output[1] else 0.0, text)


_INSTRUCTIONS: dict[re.Pattern[str], Callable[[re.Match[str], str, _State], None]] = {
    _ZERO: _zero,
    _WIRE: _analogue,
    _LAYER: _layer,
    _CORNERS: _corners,
    _TOOL: _tool,
    _INPUT: _wait_input,
    _DWELL: _dwell,
    _OUTPUT: _switch,
}
