# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of one INFORM job: header, positions in pulses, instructions. Lines end in CR LF."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from freecad_am.core.types import Array, Integers

from ...core.program import LINEAR_MOVE, Program
from ..parts import Piece, Run

AXES, BASE = "SLURBT", "BS1"  # of a robot, and the group of the track that carries it
END_OF_LINE = "\r\n"


def pulses(program: Program, joints: Array) -> Integers:
    """(n, axes) whole pulses of controller joint values (n, axes), rad, and mm of a track."""
    values = np.where(program.slides, joints, np.degrees(joints))
    counts: Integers = np.rint(values * np.array(program.pulses_per_degree)).astype(np.int64)
    return counts


def job(program: Program, name: str, head: Sequence[str], entries: Sequence[Piece]) -> bytes:
    """A whole file. head: lines before the first instruction."""
    runs = [entry for entry in entries if isinstance(entry, Run)]
    texts = [pulses(program, run.moves.joints[run.start : run.stop]) for run in runs]
    rows = np.concatenate(texts) if texts else np.zeros((0, len(program.slides)), dtype=np.int64)
    turning = ~program.slides[len(AXES) :]
    columns = {
        "C": rows[:, : len(AXES)],
        "BC": rows[:, program.slides],
        "EC": rows[:, len(AXES) :][:, turning],
    }
    columns = {letters: values for letters, values in columns.items() if values.size}
    positions = [f"///TOOL {program.tool_frame}", "///POSTYPE PULSE", "///PULSE"] if columns else []
    positions += [
        f"{letters}{number:05d}={','.join(map(str, row))}"
        for letters, values in columns.items()
        for number, row in enumerate(values.tolist())
    ]
    lines, point = ["NOP", *head], 0
    for entry in entries:
        if isinstance(entry, Run):
            letter = "L" if entry.moves.interpolation == LINEAR_MOVE else "J"
            words = entry.words[entry.start : entry.stop]
            numbers = [f"{point + k:05d}" for k in range(len(words))]
            named = [
                " ".join(f"{letters}{number_text}" for letters in columns)
                for number_text in numbers
            ]
            lines += [f"MOV{letter} {text} {word}" for text, word in zip(named, words, strict=True)]
            point += len(entry)
        else:
            lines += entry
    group = ",".join(
        [
            "///GROUP1 RB1",
            *([BASE] if program.on_track else []),
            *([program.unit] if program.unit else []),
        ]
    )
    count = ",".join(str(len(columns.get(letters, ()))) for letters in ("C", "BC", "EC"))
    text = [
        "/JOB", f"//NAME {name}", "//POS", f"///NPOS {count},0,0,0", *positions, "//INST",
        "///DATE 2000/01/01 00:00", "///COMM Robotic AM", "///ATTR SC,RW", group, *lines, "END",
    ]  # fmt: skip
    return (END_OF_LINE.join(text) + END_OF_LINE).encode("ascii")
