# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common code of five-axis posts: parts, remarks, names, rejected settings."""

from __future__ import annotations

import re
import textwrap

from ...core.issues import InputError
from ...core.program import DEPOSIT, LINEAR, ROTARY, Program
from ..names import plain
from ..refusals import refuse_incomplete


def wrapped(text: str) -> list[str]:
    """A remark on as many lines as it needs, in plain characters."""
    return textwrap.wrap(plain(text), 80)


def refuse_table(program: Program, post: str) -> None:
    """Raises InputError UNSUPPORTED_AXES, NOTHING_TO_WRITE, UNREACHABLE, NO_POSITIONS: what no such program can say."""
    refuse_incomplete(program, post, len(program.axis_names))
    linear = [
        name
        for name, kind in zip(program.axis_names, program.axis_kinds, strict=True)
        if kind == LINEAR
    ]
    rotary = [
        name
        for name, kind in zip(program.axis_names, program.axis_kinds, strict=True)
        if kind == ROTARY
    ]
    if (
        sorted(linear) != ["X", "Y", "Z"]
        or not set(rotary) <= set("ABC")
        or len(set(rotary)) != len(rotary)
    ):
        raise InputError(
            "UNSUPPORTED_AXES",
            "cell.machine",
            "the post {} writes linear axes X Y Z and rotary axes of A B C, one each; the machine has {}: name its joints "
            "mx my mz and a, b or c",
            post,
            " ".join(program.axis_names),
        )
    if program.motion == "cartesian" and any(
        run.position is None or run.direction is None
        for run in program.moves
        if run.kind == DEPOSIT
    ):
        raise InputError(
            "NO_POSITIONS", "program.motion", "the program has no positions; use `motion: joint`"
        )


def refuse_words(program: Program, reserved: frozenset[str]) -> None:
    """Raises InputError DEPOSIT_WORD for words that cannot switch the deposit: other than M or H
    words, the same one twice, or words with another meaning (`reserved`; H for every such word).
    """
    words = {
        "program.nc.deposit_on": program.nc.deposit_on,
        "program.nc.deposit_off": program.nc.deposit_off,
    }
    if not any(words.values()):
        return
    for key, word in words.items():
        if not re.fullmatch(r"M\d{1,3}|H\d{1,2}=\d{1,5}", word):
            raise InputError(
                "DEPOSIT_WORD",
                key,
                "{!r} is not a word such as M7 or H2=1; give one for on and one for off",
                word,
            )
        if re.sub(r"^([MH])0+(?=\d)", r"\1", word) in reserved or (
            word.startswith("H") and "H" in reserved
        ):
            raise InputError(
                "DEPOSIT_WORD",
                key,
                "{} has another meaning on the controller; use another word",
                word,
            )
    if program.nc.deposit_on == program.nc.deposit_off:
        raise InputError(
            "DEPOSIT_WORD", key, "{} cannot switch both on and off; give two different words", word
        )


def refuse_wire_output(program: Program, highest: int) -> None:
    """Raises InputError WIRE_OUTPUT where the program sets the speed of the wire by an analogue
    output beyond `highest`.
    """
    if any(run.wire is not None for run in program.moves) and program.nc.wire_output > highest:
        raise InputError(
            "WIRE_OUTPUT",
            "program.nc.wire_output",
            "the controller program sets analogue outputs 1 to {}, not {}; choose one in this "
            "range",
            highest,
            program.nc.wire_output,
        )


def refuse_setup(post: str, motion: str, setup: str) -> None:
    """Raises InputError UNSUPPORTED_SETUP for other machines than ones with rotary axes; both
    motions are supported.
    """
    if setup != "rotary-table":
        raise InputError(
            "UNSUPPORTED_SETUP",
            "cell.setup",
            "the post {} cannot write {} ({} motion); use rotary-table",
            post,
            setup,
            motion,
        )


def dwell(address: str, seconds: float) -> list[str]:
    """Standing still for a time, to 0.001 s; nothing for no time."""
    return [f"G4 {address}{max(seconds, 0.001):.3f}"] if seconds > 0.0 else []
