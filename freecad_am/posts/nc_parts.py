# SPDX-License-Identifier: LGPL-2.1-or-later
"""What programs of five-axis machines have in common whatever the controller: parts, remarks, names, what is refused."""

from __future__ import annotations

import re
import textwrap
import unicodedata
from collections.abc import Iterator

from ..core.issues import InputError
from ..core.program import DEPOSIT, LINEAR, ROTARY, Program
from . import nc_numbers as numbers
from .parts import Piece, Run, size
from .refusals import refuse_incomplete

CALL = "process.between_layers.call"


def plain(text: str) -> str:
    """The text in ASCII characters that can be printed."""
    apart = unicodedata.normalize("NFKD", text.replace("ß", "ss")).encode("ascii", "ignore").decode("ascii")
    return re.sub(r"[^ -~]+", " ", apart)


def wrapped(text: str) -> list[str]:
    """A remark on as many lines as it needs, in plain characters."""
    return textwrap.wrap(plain(text), 80)


def refuse_table(program: Program, post: str) -> None:
    """Raises InputError UNSUPPORTED_AXES, NOTHING_TO_WRITE, UNREACHABLE, NO_POSITIONS: what no such program can say."""
    refuse_incomplete(program, post, len(program.axis_names))
    linear = [name for name, kind in zip(program.axis_names, program.axis_kinds, strict=True) if kind == LINEAR]
    rotary = [name for name, kind in zip(program.axis_names, program.axis_kinds, strict=True) if kind == ROTARY]
    if sorted(linear) != ["X", "Y", "Z"] or not set(rotary) <= set("ABC") or len(set(rotary)) != len(rotary):
        raise InputError(
            "UNSUPPORTED_AXES", "cell.machine",
            f"the post {post} writes linear axes X Y Z and rotary axes of A B C, one each; the machine has"
            f" {' '.join(program.axis_names)}: name its joints mx my mz and a, b or c",
        )
    if program.motion == "cartesian" and any(
        run.position is None or run.direction is None for run in program.moves if run.kind == DEPOSIT
    ):
        raise InputError("NO_POSITIONS", "program.motion", "the program has no positions; use `motion: joint`")


def refuse_words(program: Program, taken: frozenset[str]) -> None:
    """Raises InputError DEPOSIT_WORD for what cannot switch the deposit: no M or H words, the same one twice, or words with
    another meaning (`taken`; H for all of these)."""
    words = {"program.nc.deposit_on": program.nc.deposit_on, "program.nc.deposit_off": program.nc.deposit_off}
    if not any(words.values()):
        return
    for key, word in words.items():
        if not re.fullmatch(r"M\d{1,3}|H\d{1,2}=\d{1,5}", word):
            raise InputError("DEPOSIT_WORD", key, f"{word!r} is no word such as M7 or H2=1; give one for on and one for off")
        if re.sub(r"^([MH])0+(?=\d)", r"\1", word) in taken or (word.startswith("H") and "H" in taken):
            raise InputError("DEPOSIT_WORD", key, f"{word} means something else to the controller; use another word")
    if program.nc.deposit_on == program.nc.deposit_off:
        raise InputError("DEPOSIT_WORD", key, f"{word} cannot switch both on and off; give two different words")


def refuse_bead(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
    """A bead that no part can hold. Raises InputError BEAD_TOO_LONG."""
    moves = next(piece.moves for piece in group if isinstance(piece, Run))
    points = size(group)[0]
    raise InputError(
        "BEAD_TOO_LONG", "program.max_points",
        f"{numbers.place(moves)} has {points} points with its approach, and going on in another file within a bead would"
        f" stop the machine while it deposits; use at least {points}",
    )


def part_names(name: str, count: int, longest: int) -> list[str]:
    """Names of so many parts. Raises InputError PROGRAM_NAME where there is no room for their digits."""
    digits = max(2, len(str(count)))
    names = [f"{name}{number:0{digits}d}" for number in range(1, count + 1)]
    if len(names[0]) > longest:
        raise InputError(
            "PROGRAM_NAME", "name",
            f"{name!r} has more than {longest} characters with the {digits} digits of its parts; use"
            f" {name[: longest - digits]!r}, or a larger program.max_points",
        )
    return names


def bad_name(name: str, where: str, why: str, proposal: str) -> InputError:
    """The error for a name a controller refuses."""
    message = f"{name!r} cannot be a program's name on the controller: {why}; use {proposal!r}"
    return InputError("PROGRAM_NAME", where, message)
