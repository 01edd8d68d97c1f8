# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program blocks of a bead: schedule and deposit switching."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..issues import InputError, Word
from ..motion import AT_END, AT_START
from ..parameters.process import ProcessParameters
from ..parameters.program import ProgramParameters
from ..program import Block, Call, DepositOff, DepositOn, Moves, Schedule, Weave
from ..types import Array, Integers

OUTPUT, ARC, CALL = "output", "arc", "call"
# rad, or mm for prismatic axes; moves of at most this size are too short for a switch ahead of a
# position
STILL = 2e-5


class Section(NamedTuple):
    """Moves of a bead with the same schedule and weave.

    rows: the moves. schedule: None without a schedule. process: process of the first move.
    """

    rows: slice
    schedule: int | None
    process: ProcessParameters

    @property
    def weave(self) -> int:
        """Weave number, 0 for none."""
        return self.process.weave or 0


def deposited(
    runs: Sequence[tuple[Moves, Section]],
    name: str,
    process: ProcessParameters,
    parameters: ProgramParameters,
) -> list[Block]:
    """Return the program blocks of a bead.

    Parameters
    ----------
    runs : Sequence[tuple[Moves, Section]]
        Moves of each section.
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
    numbers = [section.schedule for _, section in runs]
    _refuse_numbers(numbers, name, process, parameters)
    by = parameters.schedule.by
    (moves, first_section), last_section = runs[0], runs[-1][1]
    schedule = first_section.schedule if by == ARC and not parameters.dry_run else None
    schedule_before, lead = _ahead(first_section.schedule, parameters), parameters.trigger.lead
    lead_on, lead_off = first_section.process.lead_on, last_section.process.lead_off
    # waits and instructions at standstill exclude a switch ahead of a position
    on = DepositOn(
        lead_on,
        None if moves.wire is None else float(moves.wire[0]),
        schedule,
        None if lead_on or schedule_before else lead,
    )
    # also in a dry run, because weaving is motion
    weave = [Weave(first_section.weave)] if first_section.weave else []
    blocks: list[Block] = [*schedule_before, on, *weave, moves]
    # posts may stop between sections, so there is a section only where something changes
    for (_, previous), (run, section) in zip(runs, runs[1:]):
        blocks += [*_changes(previous, section, parameters), run]
    off = DepositOff(lead_off, schedule, None if lead_off else lead)
    end_weave = [Weave(0)] if last_section.weave else []
    # a switch ahead of a position comes while the last move still weaves
    return [*blocks, *end_weave, off] if off.ahead is None else [*blocks, off, *end_weave]


def _changes(previous: Section, section: Section, parameters: ProgramParameters) -> list[Block]:
    """Return the blocks between two sections of a bead."""
    blocks: list[Block] = []
    changed = section.schedule is not None and section.schedule != previous.schedule
    if changed and section.schedule is not None and not parameters.dry_run:
        blocks.append(Schedule(section.schedule, True))
    if section.weave != previous.weave:
        blocks += [Weave(0)] if previous.weave else []
        blocks += [Weave(section.weave)] if section.weave else []
    return blocks


def _refuse_numbers(
    numbers: Sequence[int | None],
    name: str,
    process: ProcessParameters,
    parameters: ProgramParameters,
) -> None:
    """Raise InputError NO_SCHEDULE or SCHEDULE for the schedules of a bead, as `deposited`."""
    by = parameters.schedule.by
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
            "of start, end and settings",
        )


def divide(
    phase: Integers, settings: Integers, name: str, process: ProcessParameters
) -> list[Section]:
    """Divide the moves of a bead into sections with one schedule and one weave each.

    Parameters
    ----------
    phase : (n,) int array
        Phase of each move.
    settings : (n,) int array
        Settings by place of each move, as the sum of 2^entry.
    name : str
        Bead class.
    process : ProcessParameters
        The process of the job.

    Returns
    -------
    list of Section
        The sections, in order.
    """
    changes = np.flatnonzero((np.diff(phase) != 0) | (np.diff(settings) != 0)) + 1
    cuts = [0, *changes.tolist(), len(phase)]
    sections: list[Section] = []
    for begin, end in zip(cuts, cuts[1:]):
        place_process = process.at_place(name, int(settings[begin]))
        of_phase = {AT_START: place_process.start.schedule, AT_END: place_process.end.schedule}
        number = of_phase.get(int(phase[begin]))
        section = Section(
            slice(begin, end), place_process.schedule if number is None else number, place_process
        )
        previous = sections[-1] if sections else None
        if previous and (previous.schedule, previous.weave) == (section.schedule, section.weave):
            section = section._replace(rows=slice(previous.rows.start, end))
            sections.pop()
        sections.append(section)
    return sections


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
