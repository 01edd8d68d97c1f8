# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parse lines of G-code into commands, with numbers, comments, line numbers and checksums.

A line may contain several commands, as RepRapFirmware accepts. Every character of a command must
belong to a word, or the line is rejected. Words after M codes are machine arguments (temperatures,
texts) that are not interpreted here.
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
# M codes followed by a text to the end of the line: messages and file names
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
# keywords of conditions, loops and variables in RepRapFirmware
META = frozenset(
    {"if", "elif", "else", "while", "break", "continue", "abort", "var", "set", "global", "skip"}
)


_TEXT_CODE = re.compile(
    rf"\s*(?:[Nn]\s*\d+\s*)?(?:{'|'.join(sorted(TEXT_CODES, reverse=True))})(?![\d.])", re.I
)


class BadWords(ValueError):
    """Raised for a line that cannot be parsed; `text` gives the reason."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.text = text


@dataclass(frozen=True)
class Command:
    """A command with its words.

    name: `G1`, `M104`, `T0`, a macro name, or '' for words without a command. words: letters with
    their numbers, None for a letter without a number. arguments: unparsed text after a macro or an
    M code.
    """

    name: str
    words: tuple[tuple[str, float | None], ...] = ()
    arguments: str = ""

    @property
    def is_macro(self) -> bool:
        """Whether the command has a word as name, such as a Klipper macro."""
        return len(self.name) > 1 and not self.name[1].isdigit()


def split_comments(line: str) -> tuple[str, list[str]]:
    """Split a line into its code and its comments.

    Parameters
    ----------
    line : str
        The line.

    Returns
    -------
    code : str
        The line without comments.
    comments : list of str
        The comments.

    Raises
    ------
    BadWords
        For an unclosed bracket.
    """
    if "(" not in line and '"' not in line:  # true for most lines
        plain, mark, comment = line.partition(";")
        return plain.strip(), [comment] if mark else []
    code, comments, quoted, position = "", [], False, 0
    is_text = _TEXT_CODE.match(line) is not None  # brackets in a message are not comments
    closed = line.count('"') % 2 == 0  # an inch sign in a message does not start a quoted text
    while position < len(line):
        sign = line[position]
        if sign == '"' and closed:
            quoted = not quoted
        if quoted or sign not in ";(" or (sign == "(" and is_text):
            code, position = code + sign, position + 1
        elif sign == ";":
            comments.append(line[position + 1 :])
            break
        else:
            end = line.find(")", position)
            if end < 0:
                raise BadWords(
                    Text(
                        "the comment {!r} has no end; close the comment with )",
                        line[position:][:40],
                    )
                )
            comments.append(line[position + 1 : end])
            code, position = code + " ", end + 1
    return code.strip(), comments


def commands_of(code: str) -> list[Command]:
    """Return the commands of a line without comments, in order.

    Raises BadWords with the text that cannot be parsed.
    """
    if _PLAIN_MOVE.fullmatch(code):  # shortcut for most lines
        words = code.split()
        values = tuple((word[0], float(word[1:])) for word in words[1:])
        if len({letter for letter, _ in values}) == len(values):
            return [Command(words[0], values)]
    code = _strip_checksum(code)
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
                Text("{!r} is a condition, a loop or a variable; write out the moves", code[:60])
            )
        return [Command(name[1].upper(), arguments=code[name.end() :].strip())]
    return _split_commands(code)


def _is_words(code: str) -> bool:
    """Return whether a line begins with a letter and a number, such as X10Y20."""
    return re.match(rf"[A-Za-z]\s*{NUMBER}", code) is not None


def _strip_checksum(code: str) -> str:
    """Remove the checksum of a line: the exclusive or of the bytes before the star.

    Raises BadWords for a wrong checksum.
    """
    match = _CHECKSUM.search(code)
    if match is None:
        return code
    content = code[: match.start()]
    value = 0
    for byte in content.encode("utf-8", "replace"):
        value ^= byte
    if value != int(match[1]):
        raise BadWords(
            Text(
                "the checksum of the line is {}, not {}, so the line is damaged; export the file "
                "again",
                value,
                match[1],
            )
        )
    return content


def _split_commands(code: str) -> list[Command]:
    commands: list[Command] = []
    position = 0
    while position < len(code):
        head = _WORD.match(code, position)
        if head is None:
            raise _bad_words(code, position)
        letter = head[1].upper()
        if letter == "T":
            return [*commands, _tool(code[position:])]
        if letter == "M":
            command, position = _machine_code(code, head)
        elif letter == "G":
            if head[2] is None:
                raise _bad_words(code, position)
            words, at_next = _read_words(code, head.end())
            command, position = Command(_code_name(head), words), at_next
        else:
            words, position = _read_words(code, position)
            command = Command("", words)
        commands.append(command)
    return commands


def _tool(code: str) -> Command:
    return Command("T", arguments=code.strip()[1:].strip())


def _code_name(head: re.Match[str]) -> str:
    return f"{head[1].upper()}{float(head[2]):g}"


def _machine_code(code: str, head: re.Match[str]) -> tuple[Command, int]:
    """Return an M code with its arguments, and the position of the next G or M code."""
    if head[2] is None:
        raise _bad_words(code, head.start())
    name, end = _code_name(head), head.end()
    if name in TEXT_CODES:
        return Command(name, arguments=code[end:].strip()), len(code)
    quoted = False
    for position in range(end, len(code)):
        quoted ^= code[position] == '"'
        starts = code[position] in "GMgm" and not (
            code[position - 1].isalnum() or code[position - 1] in "_.\"'"
        )
        if not quoted and starts and re.match(r"[GMgm]\s*\d", code[position:]):
            return Command(
                name, _find_flags(code[end:position]), code[end:position].strip()
            ), position
    return Command(name, _find_flags(code[end:]), code[end:].strip()), len(code)


def _find_flags(text: str) -> tuple[tuple[str, float | None], ...]:
    """Return the letters with numbers in the arguments of an M code."""
    matches = re.findall(rf"(?<![A-Za-z])([A-Za-z])\s*({NUMBER})", re.sub(r'"[^"]*"', " ", text))
    return tuple((letter.upper(), float(value)) for letter, value in matches)


def _read_words(code: str, position: int) -> tuple[tuple[tuple[str, float | None], ...], int]:
    """Return the words up to the next G or M code, and the position of this code."""
    words: list[tuple[str, float | None]] = []
    while position < len(code):
        match = _WORD.match(code, position)
        if match is None:
            if not code[position:].strip():
                return tuple(words), len(code)
            raise _bad_words(code, position)
        letter = match[1].upper()
        if letter in "GM" and match[2] is not None:
            break
        value, position = _read_value(code, match, letter)
        if letter in (name for name, _ in words):
            raise BadWords(Text("{} appears twice in {!r}; remove one of them", letter, code[:60]))
        words.append((letter, value))
    return tuple(words), position


def _read_value(code: str, match: re.Match[str], letter: str) -> tuple[float | None, int]:
    """Return the number of a word, including an exponent, and the position of the next word."""
    if match[2] is None:
        return None, match.end()
    end = match.end()
    exponent = _EXPONENT.match(code, end)
    if exponent is not None and _is_exponent(code, match, exponent, letter):
        end = exponent.end()
        value = float(f"{match[2]}e{exponent[2]}")
    else:
        value = float(match[2])
    following = code[end : end + 1]
    if following and not (following.isspace() or following.isalpha()):
        raise _bad_words(code, match.start(1), match.start(1) + 24)
    if not math.isfinite(value):
        raise _bad_words(code, match.start(1))
    return value, end


def _is_exponent(code: str, match: re.Match[str], exponent: re.Match[str], letter: str) -> bool:
    """Return whether E after a number is an exponent, not the extruder in a line without spaces.

    Raises BadWords if E is ambiguous.
    """
    other_code = code[: match.start(1)] + " " + code[exponent.end() :]
    if letter == "E" or re.search(rf"[Ee]\s*{NUMBER}", other_code) is not None:
        return True
    if exponent[1] == "e" and match[1].isupper():
        return True
    spaced = re.search(r"[\d.]\s+[A-Za-z]", code) is not None
    if spaced and re.fullmatch(r"[-+]\d\d+", exponent[2]):
        return True
    if not spaced:
        return False
    raise BadWords(
        Text(
            "{!r} is ambiguous: a number with an exponent, or two words; write the number "
            "without exponent, or a space before E",
            code[match.start(1) : exponent.end()],
        )
    )


def _bad_words(code: str, position: int, end: int | None = None) -> BadWords:
    text = code[position:end].strip()[:40]
    if re.match(r"[A-Za-z]\s*[-+]?\d+,\d", text):
        return BadWords(Text("{!r} has a decimal comma; use a decimal point", text))
    return BadWords(Text("{!r} is not understood; use letters with numbers, such as X-1.5", text))
