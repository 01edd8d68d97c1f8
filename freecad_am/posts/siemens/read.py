# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read SINUMERIK programs back: model the controller from the program text alone.

Shares no code with the writer. Accepts only the blocks that a path needs and rejects everything
else, so that unknown text cannot hide motion.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from ...core.issues import Text, Word
from ...core.read_moves import ReadMoves
from ..nc_read import SLIDES, TIME, TIP, Shape, Track, unreadable
from .words import INSTRUCTIONS

_NUMBER = r"-?\d+(?:\.\d*)?|-?\.\d+"
_WORD = re.compile(rf"([XYZABCF])=?({_NUMBER})$|([ABC]3)=({_NUMBER})$")
_SHORTEST_PATH = re.compile(rf"([ABC])=DC\(({_NUMBER})\)$")
_NUMBERED = re.compile(r"N(\d+)(?: +|$)")
_NAME = re.compile(r"(?:[A-Z]{2}|_[A-Z])[A-Z0-9_]*$")
_OUTPUT = re.compile(r"\$A_OUT\[(\d+)\]=([01])$|H(\d+)=(\d+)$|M(\d+)$")
_WIRE = re.compile(rf"(DO )?\$A_OUTA\[(\d+)\]=({_NUMBER})$")
_OFFSET = re.compile(r"G5(?:0[05-9]|[4-7]|[1-9]\d)$")
_TIP_WORDS = {*"XYZF", "A3", "B3", "C3"}
_FEEDS = {"G93", "G94"}
_UNITS = {"G710", "G90"}
_COMPRESS = {"COMPCAD": True, "COMPCURV": True, "COMPON": True, "COMPOF": False}
_HARMLESS = re.compile(r"(?:G17|G40|G9|ORIVECT|STOPRE|FGROUP\(X,Y,Z\))$")
# corner rounding, with the jerk limit and feed forward that it requires
_CORNERS = re.compile(r"G60|G64\d?|SOFT|BRISK|FFWON|FFWOF")
_SMOOTH, _HARD = {"SOFT", "FFWON"}, {"BRISK", "FFWOF"}
_PAIRED = {"G642": _SMOOTH, "G64": _HARD}
# M words that stop or end a program, change the tool or set the spindle
_TAKEN = {
    *["0", "1", "2", "3", "4", "5", "6", "17", "19", "30", "40", "41", "42", "43", "44", "45", "70"]
}
_TOOL = re.compile(r"D(\d+)$")
_LAYER = re.compile(r"; ?LAYER (\d+)$")
_WAIT = re.compile(r"WHILE \$A_IN\[(\d+)\]==0$")
_COOL = re.compile(rf"WHILE \$A_INA\[(\d+)\]>=({_NUMBER})$")
_DWELL = re.compile(rf"G4 F({_NUMBER})$")


@dataclass
class _State:
    """The modal state while programs are executed. switching: H words and outputs that switch the
    deposit.
    """

    files: dict[str, list[tuple[str, str]]]
    switching: set[str] = field(default_factory=set)
    track: Track = field(default_factory=Track)
    units: set[str] = field(default_factory=set)
    feed: str = "G94"
    linear: bool = False
    offset: str = ""
    tip: bool = False
    workpiece: bool = False
    group: bool = False
    corners: set[str] = field(default_factory=set)
    compress: bool = False
    waiting: bool = False
    shape: Shape | None = None
    output: str = ""
    switched: str = ""  # file and line of the last switch of the output
    on_word: str = ""
    off_word: str = ""


def read(files: dict[str, bytes]) -> ReadMoves:
    """Read all moves in the order of execution, starting with the main program.

    Raises InputError UNREADABLE_PROGRAM, naming file and line.
    """
    main = [name for name in files if name.upper().endswith(".MPF")]
    if len(main) != 1 or any(not name.upper().endswith((".MPF", ".SPF")) for name in files):
        raise unreadable(
            "program", Text("{} main programs, but exactly one with its parts is needed", len(main))
        )
    programs = {
        name.upper().rpartition(".")[0]: _blocks(name, content) for name, content in files.items()
    }
    words = {text for blocks in programs.values() for _, text in blocks}
    # an H word that is 0 somewhere switches the deposit; other H words select schedules, which
    # count from 1
    state = _State(
        programs, switching={text.partition("=")[0] for text in words if text.endswith("=0")}
    )
    start = main[0].upper().rpartition(".")[0]
    _follow(start, state, ())
    if state.track.on:
        raise unreadable("program", "the program ends with the deposit on")
    return state.track.moves()


def _blocks(file: str, content: bytes) -> list[tuple[str, str]]:
    """Return file and line of each block, and its words without comments and block numbers."""
    blocks, last_number = [], 0
    for number, line in enumerate(content.decode("latin-1").upper().split("\n"), 1):
        text = line.partition(";")[0].strip() if not _LAYER.match(line) else line.strip()
        where = f"{file} line {number}"
        if numbered := _NUMBERED.match(text):
            if int(numbered[1]) <= last_number:
                raise unreadable(where, "block numbers do not increase")
            last_number, text = int(numbered[1]), text[numbered.end() :]
        if text:
            tidy = text.isprintable() and "  " not in text
            blocks.append((where, text if tidy else " ".join(text.split())))
    return blocks


def _follow(name: str, state: _State, callers: tuple[str, ...]) -> None:
    """Execute the blocks of a program in order, and the programs that it calls."""
    end = "M17" if callers else "M30"
    blocks = state.files[name]
    if not blocks or blocks[-1][1] != end or name in callers:
        raise unreadable(name, Text("the program does not end with {}, or calls itself", Word(end)))
    for where, text in blocks[:-1]:
        words = None if state.shape is None or state.waiting else state.shape.words(text)
        if state.shape is not None and words is not None:
            state.linear = True
            state.track.shorter |= state.shape.shorter
            _move(where, words, state, text.startswith("G9 "))
        elif state.waiting:
            if text == "ENDWHILE":
                state.waiting = False
            elif not _DWELL.match(text):
                raise unreadable(where, Text("{!r} in a loop that waits for an input", text))
        else:
            _block(where, text, state, (*callers, name))
    if state.waiting:
        raise unreadable(name, "the program ends within a loop")


def _block(where: str, text: str, state: _State, callers: tuple[str, ...]) -> None:
    for form, instruction in _INSTRUCTIONS.items():
        if match := form.match(text):
            instruction(match, where, state)
            return
    _words(where, text, state, callers)


def _wait_input(wait: re.Match[str], where: str, state: _State) -> None:
    state.waiting = True
    state.track.happens("input", float(wait[1]))


def _wait_below(cool: re.Match[str], where: str, state: _State) -> None:
    if state.track.on:
        raise unreadable(where, "the program waits for an analogue input within a bead")
    state.waiting = True
    state.track.happens("below", float(cool[1]), float(cool[2]), digits=1e-6)


def _dwell(dwell: re.Match[str], where: str, state: _State) -> None:
    state.track.waits(dwell[1])


def _layer(layer: re.Match[str], where: str, state: _State) -> None:
    state.track.happens("layer", float(layer[1]))


def _wire(wire: re.Match[str], where: str, state: _State) -> None:
    if state.compress or (not wire[1] and state.track.on):
        raise unreadable(
            where, "the analogue output stops the machine or its compressor within a bead"
        )
    state.track.set_wire(int(wire[2]), wire[3], where)


_INSTRUCTIONS: dict[re.Pattern[str], Callable[[re.Match[str], str, _State], None]] = {
    _WAIT: _wait_input,
    _COOL: _wait_below,
    _DWELL: _dwell,
    _LAYER: _layer,
    _WIRE: _wire,
}


def _words(where: str, text: str, state: _State, callers: tuple[str, ...]) -> None:
    """Execute a block of words: a move, modes, or one other instruction."""
    words: dict[str, str] = {}
    other_tokens = []
    for token in text.split():
        if shorter := _SHORTEST_PATH.match(token):
            state.track.shorter.add(shorter[1])
        if match := _WORD.match(token) or shorter:
            address, value = (group for group in match.groups() if group is not None)
            if address in words:
                raise unreadable(where, Text("{} is duplicated", address))
            words[address] = value
        elif token == "G1":
            state.linear = True
        elif token in ("TRAORI", "TRAFOOF") and state.track.on:
            raise unreadable(where, "the transformation changes while the deposit is on")
        elif not _mode(token, state):
            other_tokens.append(token)
    if words:
        if other_tokens:
            raise unreadable(where, Text("{!r} with a move is not understood", other_tokens[0]))
        _move(where, words, state, "G9" in text.split())
        state.shape = Shape.of(text, "G9")
    elif len(other_tokens) == 1:
        _other(where, other_tokens[0], state, callers)
    elif other_tokens:
        raise unreadable(where, Text("{!r} is not understood", text))


def _mode(token: str, state: _State) -> bool:
    """Set a mode; return whether the word is a mode."""
    if token in _FEEDS:
        state.feed = token
    elif token in _UNITS:
        state.units.add(token)
    elif _OFFSET.match(token):
        state.offset = token
        state.track.frame = float(token[1:]) - (53.0 if len(token) == 3 else 500.0)
    elif tool := _TOOL.match(token):
        state.track.tool = float(tool[1])
    elif _CORNERS.fullmatch(token):
        if token.startswith("G6"):
            state.corners -= {word for word in state.corners if word.startswith("G6")}
            state.track.exact = token == "G60"
        else:
            state.corners -= {"SOFT", "BRISK"} if token in ("SOFT", "BRISK") else {"FFWON", "FFWOF"}
        state.corners.add(token)
    elif token in _COMPRESS:
        state.compress = _COMPRESS[token]
    elif token in ("TRAORI", "TRAFOOF"):
        state.tip, state.workpiece = token == "TRAORI", False
    elif token == "ORIWKS":
        state.workpiece = True
    else:
        state.group |= token.startswith("FGROUP")
        return _HARMLESS.match(token) is not None
    return True


def _move(where: str, words: dict[str, str], state: _State, stops: bool) -> None:
    if not state.linear or state.units != _UNITS:
        raise unreadable(where, "the program moves before G1, G90 and G710 are set")
    if state.corners and not any(
        state.corners == {word, *paired} for word, paired in _PAIRED.items()
    ):
        raise unreadable(
            where, Text("{} must not be used together", " ".join(sorted(state.corners)))
        )
    if state.tip:
        is_set = state.workpiece and state.group and state.offset
        if state.feed != "G94" or not is_set or words.keys() != _TIP_WORDS:
            raise unreadable(
                where,
                "with TRAORI a move needs X Y Z A3 B3 C3 F, G94, FGROUP, ORIWKS and a work offset",
            )
        state.track.add(TIP, words, where, stops)
        return
    if state.offset != "G500":
        raise unreadable(where, "axes move in a frame other than the machine frame")
    if state.feed == "G94":
        if not state.group:
            raise unreadable(
                where, "the program does not set the axes to which the feed applies (FGROUP)"
            )
        state.track.add(SLIDES, words, where, stops)
        return
    if state.compress:
        raise unreadable(
            where,
            "the compressor would merge blocks that each state a time, and only the last time "
            "would count",
        )
    state.track.add(TIME, words, where, stops)


def _other(where: str, token: str, state: _State, callers: tuple[str, ...]) -> None:
    output = _OUTPUT.match(token)
    if output and output[3] and token.partition("=")[0] not in state.switching:
        if state.compress or state.track.on:
            raise unreadable(where, "the program sends a schedule within a bead")
        state.track.happens("schedule", float(output[3]), float(output[4]))
    elif output:
        if output[5] in _TAKEN:
            raise unreadable(where, Text("{!r} is not understood", token))
        _switch(where, token, output, state)
    elif token in state.files:
        if state.track.on or state.tip:
            raise unreadable(where, "the program calls another program within a bead")
        _follow(token, state, callers)
    elif (
        token in INSTRUCTIONS
        or not _NAME.match(token)
        or state.track.on
        or state.tip
        or state.compress
    ):
        raise unreadable(where, Text("{!r} is not understood", token))
    else:
        # a program on the controller leaves unknown settings
        state.units, state.offset, state.group, state.linear, state.corners = (
            set(),
            "",
            False,
            False,
            set(),
        )
        state.track.happens("call", token)
        state.track.frame = state.track.tool = float("nan")


def _switch(where: str, token: str, output: re.Match[str], state: _State) -> None:
    """Switch the deposit.

    An output or H word switches by its value. Of two M words, the first switches on.
    """
    if output[5]:
        state.on_word = state.on_word or token
        on = token == state.on_word
        if not on:
            state.off_word = state.off_word or token
        wrong = token not in (state.on_word, state.off_word)
        name = "M"
    else:
        name, on, wrong = token.partition("=")[0], (output[2] or output[4]) != "0", False
    number = float(output[1] or output[3] or 0)
    if wrong or state.output not in ("", name):
        raise unreadable(
            where, Text("{!r} switches a second output; the first is {}", token, state.switched)
        )
    state.switched = where
    state.output, state.track.on = name, on
    state.track.happens("on" if on else "off", number, token)
