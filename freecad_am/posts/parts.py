# SPDX-License-Identifier: LGPL-2.1-or-later
"""Split a program into files of limited size; common code of all posts."""

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
    """The moves start .. stop of a block, with the speed word of each move; words are written
    unchanged.
    """

    moves: Moves
    words: Sequence[str]
    start: int
    stop: int

    def __len__(self) -> int:
        return self.stop - self.start


# content of a file: runs of moves, and finished instructions
Piece = Run | list[str]


def grouped(
    program: Program,
    words: Callable[[Moves], Sequence[str]],
    instructions: Callable[[Block], list[str]],
) -> Iterator[list[Piece]]:
    """Yield the blocks of a program in groups that each belong to one bead.

    Files are split between groups, with the deposit off.

    Parameters
    ----------
    program : Program
        The program.
    words : callable
        Returns the words of a block of moves; called in the order of motion.
    instructions : callable
        Returns the lines of any other block.

    Yields
    ------
    list of Piece
        A group.
    """
    group: list[Piece] = []
    bead: tuple[int, int] | None = None
    on = False
    for block in program.blocks:
        if isinstance(block, Moves):
            if not len(block):
                continue
            block_piece: Piece = Run(block, words(block), 0, len(block))
            starts = (
                block.kind == RAPID and not on and bead not in (None, (block.layer, block.bead))
            )
            bead = (block.layer, block.bead)
        else:
            on = isinstance(block, DepositOn) or (on and not isinstance(block, DepositOff))
            block_piece = instructions(block)
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
        group.append(block_piece)
    yield group


def packed(
    groups: Sequence[list[Piece]],
    most_points: int,
    most_lines: int,
    cut: Callable[[list[Piece], int, int], Iterator[list[Piece]]],
) -> list[list[Piece]]:
    """Distribute groups over files with limits on points and lines, in order.

    Parameters
    ----------
    groups : Sequence[list[Piece]]
        The groups.
    most_points : int
        Maximum number of points in a file.
    most_lines : int
        Maximum number of lines in a file.
    cut : callable
        Splits a group that exceeds a limit.

    Returns
    -------
    list[list[Piece]]
        The content of each file.
    """
    everything = [entry for group in groups for entry in group]
    points, lines = size(everything)
    if points <= most_points and lines <= most_lines:
        return [everything]
    files: list[list[Piece]] = []
    remaining = (0, 0)
    cuts = {}
    # start with the largest bead: the error names it, so one correction is enough
    for number in sorted(range(len(groups)), key=lambda number: size(groups[number]), reverse=True):
        points, lines = size(groups[number])
        if points > most_points or lines > most_lines:
            cuts[number] = list(cut(groups[number], most_points, most_lines))
    for number, group in enumerate(groups):
        chunks = cuts.get(number, [group])
        for chunk in chunks:
            points, lines = size(chunk)
            if points > remaining[0] or lines > remaining[1] or len(chunks) > 1:
                files.append([])
                remaining = (most_points, most_lines)
            files[-1].extend(chunk)
            remaining = (remaining[0] - points, remaining[1] - lines)
    return files


def move_retracts(files: list[list[Piece]]) -> list[list[Piece]]:
    """Move the first retract move of a file into the previous file, which contains its bead. The
    next file is then loaded away from the deposit.
    """
    for previous, file_pieces in zip(files, files[1:]):
        first_run = file_pieces[0]
        if isinstance(first_run, Run) and first_run.moves.role[first_run.start] == RETRACT:
            previous.append(dataclasses.replace(first_run, stop=first_run.start + 1))
            file_pieces[:1] = (
                [dataclasses.replace(first_run, start=first_run.start + 1)]
                if len(first_run) > 1
                else []
            )
    return files


def size(entries: Sequence[Piece]) -> tuple[int, int]:
    """Return the numbers of points and lines of pieces.

    Parameters
    ----------
    entries : sequence of Piece
        The pieces.

    Returns
    -------
    points : int
        Number of points.
    lines : int
        Number of lines, with one line per move.
    """
    return sum(len(entry) for entry in entries if isinstance(entry, Run)), sum(
        len(entry) for entry in entries
    )


def continued(
    remark: Callable[[str], list[str]], woven: Collection[tuple[int, int]] = ()
) -> Callable[[list[Piece], int, int], Iterator[list[Piece]]]:
    """Return a function that splits an oversized bead between moves, with remarks on both sides of
    the split. It raises InputError BEAD_TOO_LONG for a bead in `woven` (layer, bead).
    """
    going_on, resumed = remark("bead goes on in the next part"), remark("bead goes on here")

    def cut(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
        runs = [entry for entry in group if isinstance(entry, Run)]
        if any(
            run.moves.kind == DEPOSIT and (run.moves.layer, run.moves.bead) in woven for run in runs
        ):
            raise InputError(
                "BEAD_TOO_LONG",
                "program.max_points",
                "{} is woven and has {} points with its approach, but the weave may not continue "
                "in another program; allow more points per program, or a larger chord error",
                place(runs[-1].moves),
                sum(map(len, runs)),
            )
        events = sum(len(entry) for entry in group if isinstance(entry, list))
        max_moves = min(most_points, most_lines - events - len(going_on) - len(resumed))
        chunk: list[Piece] = []
        remaining = max_moves
        for entry in group:
            if isinstance(entry, list):
                chunk.append(entry)
                continue
            start = entry.start
            while entry.stop - start > remaining:
                if remaining:
                    chunk.append(Run(entry.moves, entry.words, start, start + remaining))
                yield [*chunk, going_on]
                start, chunk, remaining = start + remaining, [resumed], max_moves
            chunk.append(Run(entry.moves, entry.words, start, entry.stop))
            remaining -= entry.stop - start
        yield chunk

    return cut


def keep_whole(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
    """Keep an oversized bead in one file.

    For controllers that accept files of any length: changing files within a bead would stop the
    machine while it deposits.

    Parameters
    ----------
    group : list of Piece
        The bead.
    most_points, most_lines : int
        Limits of a file; not used.

    Yields
    ------
    list of Piece
        The unchanged group.
    """
    yield group


def unbroken(group: list[Piece], most_points: int, most_lines: int) -> Iterator[list[Piece]]:
    """Reject an oversized bead if the controller loads files one after another.

    Parameters
    ----------
    group : list of Piece
        The bead.
    most_points, most_lines : int
        Limits of a file; not used.

    Raises
    ------
    InputError
        BEAD_TOO_LONG.
    """
    moves = next(
        entry.moves for entry in group if isinstance(entry, Run) and entry.moves.kind == DEPOSIT
    )
    points = size(group)[0]
    raise InputError(
        "BEAD_TOO_LONG",
        "program.max_points",
        "{} has {} points with its approach, and loading another part within a bead would stop "
        "the robot while it deposits; use at least {}",
        place(moves),
        points,
        points + 1,
    )


def switching(program: Program) -> Iterator[tuple[Moves, DepositOn | DepositOff]]:
    """Yield the blocks that switch the deposit, in order.

    Parameters
    ----------
    program : Program
        The program.

    Yields
    ------
    moves : Moves
        The moves before the switch.
    block : DepositOn or DepositOff
        The switch.
    """
    moves_before: Moves | None = None
    for block in program.blocks:
        if isinstance(block, Moves):
            moves_before = block if len(block) else moves_before
        elif isinstance(block, (DepositOn, DepositOff)) and moves_before is not None:
            yield moves_before, block


def lines_of(entries: Sequence[Piece], motion: Callable[[Run], list[str]]) -> list[str]:
    """Return the lines of a file; `motion` writes the lines of a run."""
    return [
        line for entry in entries for line in (motion(entry) if isinstance(entry, Run) else entry)
    ]


def place(moves: Moves) -> str:
    """Return layer and bead of a run of moves, for messages."""
    return Text("layer {} bead {}", moves.layer, moves.bead)
