# SPDX-License-Identifier: LGPL-2.1-or-later
"""The line shown for a move is the one that states it: a change of that line changes that move
only."""

import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.posts import catalogue
from freecad_am.posts.catalogue import lines_of
from tests.posts.planned_jobs import SPANNING, WAYS, write_program

pytestmark = pytest.mark.any_version

NUMBER = re.compile(rb"-?\d+\.\d+")
INDEX = re.compile(rb"(?<=P\[)\d+|(?<=MOV[JL] C)\d+")


def targets_of(readback):
    """Return (n, k) all that a text states about the targets of its moves."""
    target_arrays = (readback.joints, readback.position, readback.direction)
    columns = [column.reshape(len(column), -1) for column in target_arrays if column is not None]
    return np.nan_to_num(np.concatenate(columns, axis=1), nan=-1.0)


def another_end(post, files, name, number, k):
    """Return the files with another target in that line: its first coordinate, or the number of the
    previous point."""
    lines = files[name].split(b"\n")
    if post in ("fanuc", "yaskawa"):
        long = 5 if post == "yaskawa" else 1
        changed = INDEX.sub(
            lambda match: b"%0*d" % (long, int(match[0]) - 1), lines[number], count=1
        )
    else:
        body = re.sub(
            rb"^\s*(?:N\d+ )?(?:G9 )?\w+", lambda match: b"#" * len(match[0]), lines[number]
        )
        match = NUMBER.search(body)
        value = float(match[0]) + 0.25
        digits = len(match[0].split(b".")[1])
        changed = (
            lines[number][: match.start()]
            + f"{value:.{digits}f}".encode()
            + lines[number][match.end() :]
        )
    assert changed != lines[number]
    return {**files, name: b"\n".join([*lines[:number], changed, *lines[number + 1 :]])}


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_the_line_of_a_move_tells_that_move_and_no_other(way):
    _, motion, _, files = write_program(way)
    post = catalogue.load(way[0])
    readback, lines = post.read(files), lines_of(way[0], files)
    assert len(lines) == len(readback.deposit) == motion.moves.sum() > 20
    for row in range(len(lines)):
        (name, number), (file, file_line) = lines.of(row), readback.lines.at(row)
        if way[0] == "staubli":  # counted within the code; for a loop, the line on which it begins
            head, code = files[name].split(b"<Code>")
            number -= head.count(b"\n") + code.split(b"\n")[
                number - head.count(b"\n") - 1
            ].startswith(b"  for ")
        assert (file, file_line) == (name, number + 1)
    targets = targets_of(readback)
    for row in np.linspace(1, len(lines) - 1, 9).astype(int).tolist():
        name, number = lines.of(row)
        assert lines.move_at(name, number) == (
            row
            if way[0] != "staubli"
            else np.flatnonzero((lines.file == lines.file[row]) & (lines.line == number))[0]
        )
        if way[0] == "staubli":
            continue  # its lines state the number in a list
        try:
            new_targets = targets_of(post.read(another_end(way[0], files, name, number, row)))
        except (
            InputError
        ) as error:  # for example two positions for one point, and the error names this line
            assert f"{name} line {number + 1}" in str(error)
            continue
        changed_rows = np.flatnonzero(np.abs(new_targets - targets).max(axis=1) > 1e-9)
        assert changed_rows.tolist() in ([row], []) and (
            len(changed_rows) or np.allclose(targets[row], targets[row - 1])
        )


def test_lines_between_moves_lead_to_the_next_one():
    text = b"DEF JOB()\n; layer 0\nPTP {A1 1.0}\n$OUT[3]=TRUE\nLIN {X 1.0}\nLIN {X 2.0}\nEND\n"
    files = {"JOB.src": text, "SUB.dat": b"DEFDAT\n"}
    lines = lines_of("kuka", files)
    assert [lines.move_at("JOB.src", number) for number in range(8)] == [0, 0, 0, 1, 1, 2, 2, 2]
    assert lines.move_at("SUB.dat", 0) is None and lines.move_at("OTHER.src", 0) is None


def test_a_loop_tells_as_many_moves_as_it_runs():
    text = (
        b"  movej(jPath[0],tTool,mPath[0])\n  for l_nI=1 to 3\n    movej(jPath[l_nI],tTool,mPath[l_nI])\n  endFor\n"
        b"  movel(pEnd,tTool,mEnd)\n"
    )
    lines = lines_of("staubli", {"a/a01/start.pgx": text, "a/start.pgx": b"call a01:start()\n"})
    assert [lines.of(row) for row in range(5)] == [
        ("a/a01/start.pgx", number) for number in (0, 2, 2, 2, 4)
    ]
    assert lines.move_at("a/a01/start.pgx", 2) == 1 and lines.move_at("a/a01/start.pgx", 3) == 4


def test_parts_are_in_the_order_of_their_numbers_beyond_a_hundred():
    files = {
        f"JOB{number:02d}.LS": b"   1:J P[1] 0.5sec FINE ;\n" for number in (1, 2, 11, 99, 100, 101)
    }
    names = [lines_of("fanuc", files).of(row)[0] for row in range(6)]
    assert names == ["JOB01.LS", "JOB02.LS", "JOB11.LS", "JOB99.LS", "JOB100.LS", "JOB101.LS"]
