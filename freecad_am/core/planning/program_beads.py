# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a program tells the welder or extruder about a bead: its schedule, and when the deposit is on."""

from __future__ import annotations

from ..issues import InputError
from ..parameters.process import ProcessParameters
from ..parameters.program import ProgramParameters
from ..program import Block, Call, DepositOff, DepositOn, Moves, Schedule

OUTPUT, ARC, CALL = "output", "arc", "call"


def deposited(moves: Moves, name: str, process: ProcessParameters, parameters: ProgramParameters) -> list[Block]:
    """The blocks of a bead of the class `name` with these moves. InputError NO_SCHEDULE where it has none and others have,
    or the arc instruction needs one."""
    own, by = process.for_class(name), parameters.schedule.by
    if own.schedule is None and (process.scheduled or by == ARC):
        raise InputError(
            "NO_SCHEDULE", "process.schedule", f"beads of the class {name or 'of an earlier version'} have no schedule, "
            f"{'which arc instructions name' if by == ARC else 'and would be laid by that of the bead before'}; give "
            f"process.schedule, or one in process.classes.{name}",
        )
    told = own.schedule if by == ARC and not parameters.dry_run else None
    on = DepositOn(own.lead_on, None if moves.wire is None else float(moves.wire[0]), told)
    return [*_ahead(own.schedule, parameters), on, moves, DepositOff(own.lead_off, told)]


def _ahead(schedule: int | None, parameters: ProgramParameters) -> list[Block]:
    """What stands before a bead where its schedule is no part of the arc instruction."""
    if schedule is None or parameters.dry_run or parameters.schedule.by == ARC:
        return []
    if parameters.schedule.by == CALL:
        return [Call(f"{parameters.schedule.call}{schedule}", "program.schedule.call")]
    return [Schedule(schedule)]
