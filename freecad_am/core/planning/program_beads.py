# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program blocks of a bead: schedule and deposit switching."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ..issues import InputError, Word
from ..motion import AT_END, AT_START, MIDDLE
from ..parameters.process import ProcessParameters
from ..parameters.program import ProgramParameters
from ..program import Block, Call, DepositOff, DepositOn, Moves, Schedule, Weave
from ..types import Array, Integers

OUTPUT, ARC, CALL = "output", "arc", "call"
# rad, or mm for prismatic axes; moves of at most this size are too short for a switch ahead of a
# position
STILL = 2e-5


def deposited(
    runs: Sequence[tuple[Moves, int | None]],
    name: str,
    process: ProcessParameters,
    parameters: ProgramParameters,
) -> list[Block]:
    """Return the program blocks of a bead.

    Parameters
    ----------
    runs : Sequence[tuple[Moves, int or None]]
        Moves and schedule number of each section; None without a schedule.
    name : str
        Bead class.
    process : ProcessParameters
        The process of the job.
    parameters : ProgramParameters
        Program settings.

    Returns
    -------
    list of Block
        Schedule, deposit on, moves and deposit off.

    Raises
    ------
    InputError
        NO_SCHEDULE if the bead has no schedule, but other beads have one or the arc instruction
        needs one. SCHEDULE if the schedule changes within the bead and no output sets it.
    """
    bead_process, by = process.for_class(name), parameters.schedule.by
    moves, numbers = zip(*runs, strict=True)
    if None in numbers and (process.scheduled or by == ARC):
        raise InputError(
            "NO_SCHEDULE",
            "process.schedule",
            "beads of the class {} have no schedule, {}; set process.schedule, or a schedule in "
            "process.classes.{}",
            name or "from an earlier version",
            Word(
                "which arc instructions need"
                if by == ARC
                else "and would use the schedule of the previous bead"
            ),
            name,
        )
    if len(set(numbers)) > 1 and by != OUTPUT and not parameters.dry_run:
        raise InputError(
            "SCHEDULE",
            "program.schedule.by",
            "only an output can change the schedule within a bead, because calls stop the "
            "machine, and arc instructions may stop it too; use output, or remove the schedules "
            "of start and end",
        )
    schedule = numbers[0] if by == ARC and not parameters.dry_run else None
    schedule_before, lead = _ahead(numbers[0], parameters), parameters.trigger.lead
    # waits and instructions at standstill exclude a switch ahead of a position
    on = DepositOn(
        bead_process.lead_on,
        None if moves[0].wire is None else float(moves[0].wire[0]),
        schedule,
        None if bead_process.lead_on or schedule_before else lead,
    )
    weave = (
        [Weave(bead_process.weave)] if bead_process.weave else []
    )  # also in a dry run, because weaving is motion
    blocks: list[Block] = [*schedule_before, on, *weave, moves[0]]
    for run, number in runs[
        1:
    ]:  # posts may stop between sections, so use only one section per schedule
        blocks += [*([] if number is None or parameters.dry_run else [Schedule(number, True)]), run]
    off = DepositOff(bead_process.lead_off, schedule, None if bead_process.lead_off else lead)
    still = [Weave(0)] if weave else []
    # a switch ahead of a position comes while the last move still weaves
    return [*blocks, *still, off] if off.ahead is None else [*blocks, off, *still]


def split_by_schedule(
    phase: Integers, bead_process: ProcessParameters
) -> list[tuple[slice, int | None]]:
    """Divide the moves of a bead into sections with one schedule each.

    Parameters
    ----------
    phase : (n,) int array
        Phase of each move.
    bead_process : ProcessParameters
        Process of the bead class.

    Returns
    -------
    list of (slice, int or None)
        Moves and schedule number of each section.
    """
    of_phase = {
        MIDDLE: bead_process.schedule,
        AT_START: bead_process.start.schedule,
        AT_END: bead_process.end.schedule,
    }
    numbers = [
        bead_process.schedule if of_phase[point_phase] is None else of_phase[point_phase]
        for point_phase in phase.tolist()
    ]
    cuts = [0, *(k for k in range(1, len(numbers)) if numbers[k] != numbers[k - 1]), len(numbers)]
    return [(slice(begin, end), numbers[begin]) for begin, end in zip(cuts, cuts[1:])]


def _ahead(schedule: int | None, parameters: ProgramParameters) -> list[Block]:
    """Return the blocks that set the schedule before a bead; none if the arc instruction does."""
    if schedule is None or parameters.dry_run or parameters.schedule.by == ARC:
        return []
    if parameters.schedule.by == CALL:
        return [Call(f"{parameters.schedule.call}{schedule}", "program.schedule.call")]
    return [Schedule(schedule)]


def standing(blocks: Sequence[Block]) -> tuple[Block, ...]:
    """Switch the deposit on at standstill for beads without a preceding move.

    This includes the bead at which a program begins, because the length of its first move is
    unknown.

    Parameters
    ----------
    blocks : sequence of Block
        The blocks of a program.

    Returns
    -------
    tuple of Block
        The blocks, with no switch ahead of a position at these beads.
    """
    result: list[Block] = []
    positions: list[Array] = []  # the last two positions
    for block in blocks:
        if isinstance(block, Moves) and len(block):
            positions = [*positions, *block.joints[-2:]][-2:]
        stands = len(positions) < 2 or bool(np.abs(positions[1] - positions[0]).max() <= STILL)
        result.append(
            dataclasses.replace(block, ahead=None)
            if isinstance(block, DepositOn) and stands
            else block
        )
    return tuple(result)
