# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines of G-code as commands: words by a grammar of numbers, comments, line numbers and checksums.

A line may hold several commands, as RepRapFirmware takes them; every character of a command belongs to a word, or the line
is rejected. Words after M codes are arguments of the machine (temperatures, texts), which nobody reads here.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ...issues import Text

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)"
_WORD = re.compile(rf"\s*([A-Za-z])[ \t]*({NUMBER})?")
_EXPONENT = re.compile(r"([eE])([-+]?\d+)(?![.\d])")
_NAME = re.compile(r"\s*([A-Za-z_][A-Za-z0-9_]*[A-Za-z_][A-Za-z0-9_]*)")
_COMMAND = re.compile(
    r"(?<![A-Za-z0-9_.])([GMT])[ \t]*(\d+(?:\.\d+)?)(?![\dA-Za-z_])|([GM])(\d+)", re.I
)
_PLAIN_MOVE = re.compile(rf"G[0-3](?:[ \t]+[XYZEFIJ]{NUMBER})+")
_CHECKSUM = re.compile(r"\*\s*(\d+)\s*$")
_LINE_NUMBER = re.compile(r"\s*[Nn]\s*\d+(?![.\d])")
# M codes whose rest of the line is a text: messages and names of files
TEXT_CODES = frozenset(
    {
        "M16",
        "M20",
        "M21",
        "M22",
        "M23",
        "M28",
        "M29",
        "M30",
        "M32",
        "M33",
        "M36",
        "M38",
        "M70",
        "M98",
        "M117",
    }
    | {
        "M118",
        "M145",
        "M291",
        "M471",
        "M486",
        "M550",
        "M551",
        "M552",
        "M587",
        "M588",
        "M589",
        "M862.3",
    }
    | {"M1002", "M1003", "M1006"}
)
# the first words of conditions, loops and variables of RepRapFirmware
META = frozenset(
    {"if", "elif", "else", "while", "break", "continue", "abort", "var", "set", "global", "skip"}
)


_TEXT_CODE = re.compile(
    rf"\s*(?:[Nn]\s*\d+\s*)?(?:{'|'.join(sorted(TEXT_CODES, reverse=True))})(?![\d.])", re.I
)


class BadWords(ValueError):
    """A line that is not understood; `text` says why."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.text = text


@dataclass(frozen=True)
class Command:
    """A command with its words. name: `G1`, `M104`, `T0`; the name of a macro; '' of words without a command. words: letters
    with their numbers, None of a letter alone. rest: what follows a macro or an M code, as it stands."""

    name: str
    words: tuple[tuple[str, float | None], ...] = ()
    rest: str = ""

    @property
    def is_macro(self) -> bool:
        """Whether it is a command of words, such as a macro of Klipper."""
        return len(self.name) > 1 and not self.name[1].isdigit()


def split_comments(line: str) -> tuple[str, list[str]]:
    """The code of a line without its comments, and these. BadWords for a bracket that does not close."""
    if "(" not in line and '"' not in line:  # most lines
        plain, mark, comment = line.partition(";")
        return plain.strip(), [comment] if mark else []
    code, comments, quoted, at = "", [], False, 0
    is_text = _TEXT_CODE.match(line) is not None  # brackets of a message are no comments
    closed = line.count('"') % 2 == 0  # an inch sign in a message does not begin a text
    while at < len(line):
        sign = line[at]
        if sign == '"' and closed:
            quoted = not quoted
        if quoted or sign not in ";(" or (sign == "(" and is_text):
            code, at = code + sign, at + 1
        elif sign == ";":
            comments.append(line[at + 1 :])
            break
        else:
            end = line.find(")", at)
            if end < 0:
                raise BadWords(
                    Text("{!r} is a comment that does not end; close it with )", line[at:][:40])
                )
            comments.append(line[at + 1 : end])
            code, at = code + " ", end + 1
    return code.strip(), comments


def commands_of(code: str) -> list[Command]:
    """The commands of a line without comments, in their order. BadWords names what of it is not understood."""
    if _PLAIN_MOVE.fullmatch(code):  # most lines; the rest of this function gives the same
        words = code.split()
        values = tuple((word[0], float(word[1:])) for word in words[1:])
        if len({letter for letter, _ in values}) == len(values):
            return [Command(words[0], values)]
    code = _without_checksum(code)
    number = _LINE_NUMBER.match(code)
    if number is not None:
        code = code[number.end() :]
    code = code.strip()
    if not code:
        return []
    name = _NAME.match(code)
    if name is not None and _COMMAND.match(code) is None and not _is_words(code):
        if name[1].lower() in META:
            raise BadWords(
                Text("{!r} is a condition, a loop or a variable; write the moves out", code[:60])
            )
        return [Command(name[1].upper(), rest=code[name.end() :].strip())]
    return _split(code)


def _is_words(code: str) -> bool:
    """Whether a line begins with a word of one letter and a number, such as X10Y20."""
    return re.match(rf"[A-Za-z]\s*{NUMBER}", code) is not None


def _without_checksum(code: str) -> str:
    """The line without its checksum, the exclusive or of the bytes before the star. BadWords where it does not fit."""
    found = _CHECKSUM.search(code)
    if found is None:
        return code
    before = code[: found.start()]
    value = 0
    for byte in before.encode("utf-8", "replace"):
        value ^= byte
    if value != int(found[1]):
        raise BadWords(Text("its checksum is {}, not {}; the line is damaged", value, found[1]))
    return before


def _split(code: str) -> list[Command]:
    commands: list[Command] = []
    at = 0
    while at < len(code):
        head = _WORD.match(code, at)
        if head is None:
            raise _left(code, at)
        letter = head[1].upper()
        if letter == "T":
            return [*commands, _tool(code[at:])]
        if letter == "M":
            command, at = _machine_code(code, head)
        elif letter == "G":
            if head[2] is None:
                raise _left(code, at)
            words, at_next = _words(code, head.end())
            command, at = Command(_code_name(head), words), at_next
        else:
            words, at = _words(code, at)
            command = Command("", words)
        commands.append(command)
    return commands


def _tool(code: str) -> Command:
    return Command("T", rest=code.strip()[1:].strip())


def _code_name(head: re.Match[str]) -> str:
    return f"{head[1].upper()}{float(head[2]):g}"


def _machine_code(code: str, head: re.Match[str]) -> tuple[Command, int]:
    """An M code with what follows it up to the next G or M code, and where that begins."""
    if head[2] is None:
        raise _left(code, head.start())
    name, end = _code_name(head), head.end()
    if name in TEXT_CODES:
        return Command(name, rest=code[end:].strip()), len(code)
    quoted = False
    for at in range(end, len(code)):
        quoted ^= code[at] == '"'
        starts = code[at] in "GMgm" and not (code[at - 1].isalnum() or code[at - 1] in "_.\"'")
        if not quoted and starts and re.match(r"[GMgm]\s*\d", code[at:]):
            return Command(name, _flags(code[end:at]), code[end:at].strip()), at
    return Command(name, _flags(code[end:]), code[end:].strip()), len(code)


def _flags(text: str) -> tuple[tuple[str, float | None], ...]:
    """Letters with numbers of the arguments of an M code, whatever stands between them."""
    found = re.findall(rf"(?<![A-Za-z])([A-Za-z])\s*({NUMBER})", re.sub(r'"[^"]*"', " ", text))
    return tuple((letter.upper(), float(value)) for letter, value in found)


def _words(code: str, at: int) -> tuple[tuple[tuple[str, float | None], ...], int]:
    """Words up to the next G or M code, and where that begins."""
    words: list[tuple[str, float | None]] = []
    while at < len(code):
        found = _WORD.match(code, at)
        if found is None:
            if not code[at:].strip():
                return tuple(words), len(code)
            raise _left(code, at)
        letter = found[1].upper()
        if letter in "GM" and found[2] is not None:
            break
        value, at = _value(code, found, letter)
        if letter in (name for name, _ in words):
            raise BadWords(Text("{} stands twice in {!r}; leave one out", letter, code[:60]))
        words.append((letter, value))
    return tuple(words), at


def _value(code: str, found: re.Match[str], letter: str) -> tuple[float | None, int]:
    """The number of a word, with its exponent, and where the next word begins."""
    if found[2] is None:
        return None, found.end()
    end = found.end()
    exponent = _EXPONENT.match(code, end)
    if exponent is not None and _is_exponent(code, found, exponent, letter):
        end = exponent.end()
        value = float(f"{found[2]}e{exponent[2]}")
    else:
        value = float(found[2])
    following = code[end : end + 1]
    if following and not (following.isspace() or following.isalpha()):
        raise _left(code, found.start(1), found.start(1) + 24)
    if not math.isfinite(value):
        raise _left(code, found.start(1))
    return value, end


def _is_exponent(code: str, found: re.Match[str], exponent: re.Match[str], letter: str) -> bool:
    """Whether an E after a number is its exponent, not the extruder of a line without spaces. BadWords where it may be both."""
    rest = code[: found.start(1)] + " " + code[exponent.end() :]
    if letter == "E" or re.search(rf"[Ee]\s*{NUMBER}", rest) is not None:
        return True
    if exponent[1] == "e" and found[1].isupper():
        return True
    spaced = re.search(r"[\d.]\s+[A-Za-z]", code) is not None
    if spaced and re.fullmatch(r"[-+]\d\d+", exponent[2]):
        return True
    if not spaced:
        return False
    raise BadWords(
        Text(
            "{!r} may be a number with an exponent, or two words; write the number without exponent, or a space before E",
            code[found.start(1) : exponent.end()],
        )
    )


def _left(code: str, at: int, end: int | None = None) -> BadWords:
    text = code[at:end].strip()[:40]
    if re.match(r"[A-Za-z]\s*[-+]?\d+,\d", text):
        return BadWords(Text("{!r} has a decimal comma; write numbers with a point", text))
    return BadWords(Text("{!r} is not understood; give letters with numbers such as X-1.5", text))
