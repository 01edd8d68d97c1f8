# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cuts a program into files of bounded size: what posts have in common, whatever they write."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass

from ..core.issues import InputError, Text
from ..core.program import (
    DEPOSIT,
    RAPID,
    RETRACT,
    Block,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
)


@dataclass(frozen=True)
class Run:
    """The moves start .. stop of a block with the words of each about its speed; every word is written as it stands."""

    moves: Moves
    words: Sequence[str]
    start: int
    stop: int

    def __len__(self) -> int:
        return self.stop - self.start


# what a file is made of: runs of moves, and instructions as they stand
Piece = Run | list[str]


def grouped(
    program: Program,
    words: Callable[[Moves], Sequence[str]],
    instructions: Callable[[Block], list[str]],
) -> Iterator[list[Piece]]:
    """The blocks as pieces, in groups that belong to one bead each: what may be cut apart with the deposit off.

    words: of the moves of each block, asked for in the order of motion. instructions: the lines of every other block.
    """
    group: list[Piece] = []
    bead: tuple[int, int] | None = None
    on = False
    for block in program.blocks:
        if isinstance(block, Moves):
            if not len(block):
                continue
            piece: Piece = Run(block, words(block), 0, len(block))
            starts = (
                block.kind == RAPID and not on and bead not in (None, (block.layer, block.bead))
            )
            bead = (block.layer, block.bead)
        else:
            on = isinstance(block, DepositOn) or (on and not isinstance(block, DepositOff))
            piece = instructions(block)
            starts = (
                isinstance(block, LayerStart)
                and not on
                and bead is not None
                and bead[0] != block.layer
            )
            bead = None if starts else bead
        if starts and group:
            yield group
            group = []
        group.append(piece)
    yield group


def packed(
    groups: Sequence[list[Piece]],
    most_points: int,
    most_lines: int,
    cut: Callable[[list[Piece], int, int], Iterator[list[Piece]]],
) -> list[list[Piece]]:
    """The groups in files of at most so many points and lines, in order. cut: what becomes of a group too large."""
    everything = [piece for group in groups for piece in group]
    points, lines = size(everything)
    if points <= most_points and lines <= most_lines:
        return [everything]
    parts: list[list[Piece]] = []
    remaining = (0, 0)
    cuts = {}
    # the largest first: where beads are refused it is the one that is told, and one correction is enough
    for number in sorted(range(len(groups)), key=lambda number: size(groups[number]), reverse=True):
        points, lines = size(groups[number])
        if points > most_points or lines > most_lines:
            cuts[number] = list(cut(groups[number], most_points, most_lines))
    for number, group in enumerate(groups):
        chunks = cuts.get(number, [group])
        for chunk in chunks:
            points, lines = size(chunk)
            if points > remaining[0] or lines > remaining[1] or len(chunks) > 1:
                parts.append([])
                remaining = (most_points, most_lines)
            parts[-1].extend(chunk)
            remaining = (remaining[0] - points, remaining[1] - lines)
    return parts


def with_retracts(parts: list[list[Piece]]) -> list[list[Piece]]:
    """The parts with the first move of a retract in the part of the bead it leads away from: what is loaded after it is
    loaded away from the deposit."""
    for before, part in zip(parts, parts[1:]):
        first = part[0]
        if isinstance(first, Run) and first.moves.role[first.start] == RETRACT:
            before.append(dataclasses.replace(first, stop=first.start + 1))
            part[:1] = [dataclasses.replace(first, start=first.start + 1)] if len(first) > 1 else []
    return parts


def size(pieces: Sequence[Piece]) -> tuple[int, int]:
    """How many points the pieces have, and how many lines a file with one line per move takes for them."""
    return sum(len(piece) for piece in pieces if isinstance(piece, Run)), sum(
        len(piece) for piece in pieces
    )


def continued(
    remark: Callable[[str], list[str]], woven: Collection[tuple[int, int]] = ()
) -> Callable[[list[Piece], int, int], Iterator[list[Piece]]]:
    """How a bead too long for a file is cut inside its moves, with remarks at both sides of the cut that say so. One of the
    `woven` (layer, bead) is not: InputError BEAD_TOO_LONG."""
    going_on, resumed = remark("bead goes on in the next part"), remark("bead goes on here")

    def cut(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
        runs = [piece for piece in group if isinstance(piece, Run)]
        if any(
            run.moves.kind == DEPOSIT and (run.moves.layer, run.moves.bead) in woven for run in runs
        ):
            raise InputError(
                "BEAD_TOO_LONG",
                "program.max_points",
                "{} is woven and has {} points with its approach, and whether a "
                "weave goes on in another program was not confirmed; allow more points in one, or a larger chord error",
                place(runs[-1].moves),
                sum(map(len, runs)),
            )
        events = sum(len(piece) for piece in group if isinstance(piece, list))
        most = min(most_points, most_lines - events - len(going_on) - len(resumed))
        chunk: list[Piece] = []
        remaining = most
        for piece in group:
            if isinstance(piece, list):
                chunk.append(piece)
                continue
            start = piece.start
            while piece.stop - start > remaining:
                if remaining:
                    chunk.append(Run(piece.moves, piece.words, start, start + remaining))
                yield [*chunk, going_on]
                start, chunk, remaining = start + remaining, [resumed], most
            chunk.append(Run(piece.moves, piece.words, start, piece.stop))
            remaining -= piece.stop - start
        yield chunk

    return cut


def whole(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
    """A bead longer than a file is one by itself, where files may have any length: going on in another one within a bead
    would stop the machine while it deposits."""
    yield group


def unbroken(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
    """Raises InputError BEAD_TOO_LONG for a bead longer than a file, where files have to be loaded one after the other."""
    moves = next(
        piece.moves for piece in group if isinstance(piece, Run) and piece.moves.kind == DEPOSIT
    )
    points = size(group)[0]
    raise InputError(
        "BEAD_TOO_LONG",
        "program.max_points",
        "{} has {} points with its approach, and loading another part within a bead would stop the robot while it deposits; "
        "use at least {}",
        place(moves),
        points,
        points + 1,
    )


def switching(program: Program) -> Iterator[tuple[Moves, DepositOn | DepositOff]]:
    """What switches the deposit, in order, with the moves before it."""
    last: Moves | None = None
    for block in program.blocks:
        if isinstance(block, Moves):
            last = block if len(block) else last
        elif isinstance(block, (DepositOn, DepositOff)) and last is not None:
            yield last, block


def lines_of(pieces: Sequence[Piece], motion: Callable[[Run], list[str]]) -> list[str]:
    """The lines of a part; `motion` writes those of a run."""
    return [
        line for piece in pieces for line in (motion(piece) if isinstance(piece, Run) else piece)
    ]


def place(moves: Moves) -> str:
    """Where a run of moves is, for messages."""
    return Text("layer {} bead {}", moves.layer, moves.bead)
