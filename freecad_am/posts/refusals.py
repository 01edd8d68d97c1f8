# SPDX-License-Identifier: LGPL-2.1-or-later
"""What no post can write, whatever the controller."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Array

from ..core.issues import InputError, Text
from ..core.program import (
    LINEAR_MOVE,
    Call,
    DepositOff,
    DepositOn,
    Moves,
    Program,
    Schedule,
    WaitBelow,
    Weave,
)
from .parts import place, switching

CALL = "process.between_layers.call"


@dataclass(frozen=True)
class Asked:
    """What a program is to tell of the process, with what else counts for that: motion, whether the robot holds the part or
    external axes turn it, by which way schedules are told; whether the wire follows the travel speed and beads are woven."""

    motion: str
    held: bool
    turned: bool
    by: str
    wire: bool
    weave: bool
    dry_run: bool


def refuse_no_process(asked: Asked) -> None:
    """Of controllers that tell each thing of the process with every other one, or not at all."""


def refuse_wire(program: Program, no_wire: str) -> None:
    """Raises InputError NO_WIRE_OUTPUT, for the reason `no_wire`, where the program tells the speed of the wire."""
    if any(run.wire is not None for run in program.moves):
        raise wire_refused(no_wire)


def wire_refused(no_wire: str) -> InputError:
    """The error for a controller that cannot be told the speed of the wire along a bead."""
    return InputError(
        "NO_WIRE_OUTPUT",
        "process.wire.feed_mode",
        "{}; use constant, or another controller",
        no_wire,
    )


def refuse_cooling(program: Program, last: int, why: str = "") -> None:
    """Raises InputError where the program waits for a temperature: NO_ANALOGUE_INPUT for the reason `why`, or ANALOGUE_INPUT
    for an input that is none of 1 to `last`."""
    waits = [block for block in program.blocks if isinstance(block, WaitBelow)]
    if waits and why:
        raise InputError(
            "NO_ANALOGUE_INPUT",
            "process.cooling.below",
            "{}; use process.between_layers.input, strategy.wait, or another controller",
            why,
        )
    if any(block.number > last for block in waits):
        raise InputError(
            "ANALOGUE_INPUT",
            "process.cooling.input",
            "the controller's program reads analogue inputs 1 to {}, not {}; use one of these",
            last,
            waits[0].number,
        )


def refuse_schedules(
    program: Program, last: int, most: int, most_of_arc: int = 0, inside: bool = False
) -> None:
    """Raises InputError SCHEDULE for a schedule beyond `most`, or beyond `most_of_arc` where arc instructions name it, or
    one set on an output that is none of 1 to `last`. inside: another one can be
    told within a bead."""
    if not inside and any(isinstance(block, Schedule) and block.inside for block in program.blocks):
        raise InputError(
            "SCHEDULE",
            "process.start.schedule",
            "beads change their schedule, and as far as is known this controller sets outputs between moves ahead of the"
            " motion; give start and end nothing but other speeds, or use another controller",
        )
    numbers = [block.number for block in program.blocks if isinstance(block, Schedule)]
    if numbers and not 1 <= program.schedule_output <= last:
        raise InputError(
            "SCHEDULE",
            "program.schedule.output",
            "the number of a schedule is set on one of 1 to {}, not {}; use one of these",
            last,
            program.schedule_output,
        )
    named = [
        block.schedule
        for block in program.blocks
        if isinstance(block, DepositOn) and block.schedule is not None
    ]
    largest, most = (max(named), most_of_arc or most) if named else (max(numbers, default=0), most)
    if largest > most:
        raise InputError(
            "SCHEDULE",
            "process.schedule",
            "the controller takes schedules up to {}, not {}; use another number, there "
            "or in process.classes",
            most,
            largest,
        )


def refuse_weave(program: Program, most: int) -> None:
    """Raises InputError WEAVE for a weave of a number beyond `most`, or of moves that do not run straight."""
    numbers = [block.number for block in program.blocks if isinstance(block, Weave)]
    if numbers and program.motion != "cartesian":
        raise weave_refused(JOINT_WEAVE, "program.motion")
    if max(numbers, default=0) > most:
        raise weave_refused(Text("the controller has weaves 1 to {}, not {}", most, max(numbers)))


JOINT_WEAVE = "as far as is known controllers weave on linear moves, and these are joint moves"


def weave_refused(why: str, where: str = "process.weave") -> InputError:
    """The error for a weave that cannot be told."""
    return InputError(
        "WEAVE",
        where,
        "{}; set program.motion to cartesian with the tool on the robot (fanuc, yaskawa; abb with "
        "program.schedule.by: arc too), or process.weave, also in process.classes, to 0",
        why,
    )


def schedule_refused(by: str, why: str) -> InputError:
    """The error for a controller that cannot be told schedules in this way."""
    return InputError(
        "SCHEDULE", "program.schedule.by", "{}: {}; use another way, or another controller", by, why
    )


def trigger_refused(why: str) -> InputError:
    """The error for a controller, or a program, in which the deposit cannot be switched ahead of a place."""
    return InputError(
        "TRIGGER", "program.trigger.lead", "{}; leave it out, or use another controller", why
    )


@dataclass(frozen=True)
class Ahead:
    """A deposit that is switched `lead` s before the end of the last of moves, which takes `seconds`, or of which the corner
    that is rounded before it leaves them; a lead may be longer by `slack` s, which the controller's numbers cannot tell.
    steps: in a second, whole numbers of which are told as the largest lead."""

    moves: Moves
    lead: float
    seconds: float
    corner: bool = False
    slack: float = 0.0
    steps: int = 1000


def refuse_triggers(program: Program, no_trigger: str) -> None:
    """Raises InputError TRIGGER, for the reason `no_trigger` where there is one, where the deposit is switched ahead of a
    place; TRIGGER_LEAD where that is earlier than the move that leads there begins."""
    switches = [block for block in program.blocks if isinstance(block, (DepositOn, DepositOff))]
    if no_trigger and not program.dry_run and any(block.ahead is not None for block in switches):
        raise trigger_refused(no_trigger)
    refuse_leads(switched_ahead(program))


def switched_ahead(program: Program) -> list[Ahead]:
    """All that is switched ahead of the end of a move."""
    pairs = [] if program.dry_run else switching(program)
    return [
        Ahead(moves, block.ahead, float(moves.duration[-1]))
        for moves, block in pairs
        if block.ahead is not None
    ]


def refuse_leads(ahead: Sequence[Ahead]) -> None:
    """Raises InputError TRIGGER_LEAD where the least of them, so that one correction is enough, has too long a lead."""
    least = min(ahead, key=lambda one: one.seconds + one.slack, default=None)
    if least is None or least.lead <= least.seconds + least.slack:
        return
    most = _whole_steps(least.seconds + least.slack, least.steps)
    if least.corner:
        raise InputError(
            "TRIGGER_LEAD",
            place(least.moves),
            "the corner before the move at the end of which the deposit is switched is rounded, and leaves {:.4g} s of it, "
            "less than the {:.4g} s that it would be switched ahead; use a program.trigger.lead of {:g} s at most, a "
            "smaller program.blend, or a larger strategy.chord_error",
            least.seconds,
            least.lead,
            most,
        )
    raise InputError(
        "TRIGGER_LEAD",
        place(least.moves),
        "the move at the end of which the deposit is switched takes {:.4g} s, less than the {:.4g} s that it would be "
        "switched ahead; use a program.trigger.lead of {:g} s at most, a larger retract distance where it is switched on, "
        "or a larger strategy.chord_error where it is switched off",
        least.seconds,
        least.lead,
        most,
    )


def _whole_steps(seconds: float, steps: int) -> float:
    """The largest number of s that is no larger, of whole steps of which a second has so many."""
    nearest = round(steps * seconds)
    return (nearest if nearest / steps <= seconds else nearest - 1) / steps


def refuse_incomplete(program: Program, post: str, axes: int) -> None:
    """Raises InputError NOTHING_TO_WRITE, UNSUPPORTED_AXES (other than `axes` of them) or UNREACHABLE."""
    moves = program.moves
    if not sum(len(run) for run in moves):
        raise InputError(
            "NOTHING_TO_WRITE", "program", "the program holds no moves; check where it starts"
        )
    if any(run.joints.shape[1] != axes for run in moves) or len(program.continuous) != axes:
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.post",
            "the post {} writes {} axes; use another post",
            post,
            axes,
        )
    if not all(np.isfinite(run.joints).all() for run in moves):
        raise InputError(
            "UNREACHABLE",
            "program",
            "some points have no joint values; plan a joint path that reaches them all",
        )


def refuse_external(program: Program, last: int, unit: str, form: str) -> None:
    """Raises InputError UNSUPPORTED_AXES where a controller has no external axes beyond the `last` one, or no
    positioner is called so: the pattern `unit` says how they are, in words `form`."""
    if not program.external_kinds:
        return
    end = program.first_external + len(program.external_kinds) - 1
    if end > last:
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.axes.first",
            "the external axes would end with number {}, and the controller has {}; use a smaller first one",
            end,
            last,
        )
    if not re.fullmatch(unit, program.unit) and (program.on_positioner or program.unit):
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.axes.unit",
            "{!r} is not a positioner of this controller; give {}",
            program.unit,
            form,
        )


def refuse_named_track(program: Program, what: str) -> None:
    """Raises InputError UNSUPPORTED_AXES where a track that has no name is given one: it is `what`."""
    if program.unit and program.on_track and not program.on_positioner:
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.axes.unit",
            "a track has no name of its own here, it is {}; leave unit out",
            what,
        )


def refuse_continuous(program: Program) -> None:
    """Raises InputError ENDLESS_AXIS where an axis has no limits, for controllers that count every turn of all axes."""
    if any(program.continuous):
        axis = program.continuous.index(True) + 1
        raise InputError(
            "ENDLESS_AXIS",
            "cell.limits",
            "axis {} has no limits, but joint values of this controller count every turn up to a limit; use limits that "
            "have one for axis {}",
            axis,
            axis,
        )


def refuse_without_speeds(program: Program, axes: int) -> None:
    """Raises InputError NO_JOINT_SPEED where a machine file, the robot's or that of external axes, does not tell what
    percents of joint speeds are of."""
    known = np.isfinite(program.max_speed)
    if len(known) == axes and known.all():
        return
    first = int(known.argmin()) if len(known) == axes else 0
    in_urdf = Text("`velocity` to the `<limit>` of each of its joints")
    raise InputError(
        "NO_JOINT_SPEED",
        "cell.machine" if first < program.own_axes else "cell.external",
        "on this controller the speed of joint moves is programmed in percent of the axes' largest speeds, and the "
        "machine file of {} does not give them; add {}",
        (program.axis_machines or (program.machine,) * axes)[first],
        in_urdf
        if program.of_urdf and program.of_urdf[first]
        else Text("`max_speed` to its joints"),
    )


def refuse_without_positions(program: Program, straight: bool = False) -> None:
    """Raises InputError NO_POSITIONS where Cartesian motion has moves, or straight ones, without a pose."""
    if program.motion != "cartesian":
        return
    runs = [run for run in program.moves if run.interpolation == LINEAR_MOVE or not straight]
    if program.station is None or any(run.position is None or run.rotation is None for run in runs):
        raise InputError(
            "NO_POSITIONS", "program.motion", "the program has no positions; use `motion: joint`"
        )


def refuse_calls_of_own(
    program: Program, names: set[str], program_name: Callable[[str, str], str]
) -> None:
    """Raises InputError PROGRAM_NAME where a program called between layers has the name of a part of this one."""
    own = {
        name.upper() for name in names
    }  # controllers and disks that know no case would take one for the other
    for block in program.blocks:
        if isinstance(block, Call) and program_name(block.program, block.where).upper() in own:
            raise InputError(
                "PROGRAM_NAME",
                block.where,
                "{!r} is a program of this very job; call another one, or rename the job",
                block.program,
            )


def refuse_names_of_data(program: Program, names: Collection[str], data: Collection[str]) -> None:
    """Raises InputError PROGRAM_NAME where the files of a program, or one that is called, have the name of `data` of the
    controller that it uses: it would name two things."""
    taken = {name.upper() for name in data}
    called = {block.program: block.where for block in program.blocks if isinstance(block, Call)}
    for name, where in {**called, **dict.fromkeys(sorted(names), "name")}.items():
        if name.upper() in taken:
            raise InputError(
                "PROGRAM_NAME",
                where,
                "{!r} is also the name of data or a signal that the program uses; call it otherwise",
                name,
            )


def speeds_within(moves: Moves, least: float, most: float) -> Array:
    """(n,) mm/s of the moves. Raises InputError MOVE_SPEED for one that is not between the two."""
    fits = (moves.speed >= least) & (moves.speed <= most)
    if not fits.all():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written; use a speed between {} and {:.0f} mm/s",
            moves.speed[~fits][0],
            least,
            most,
        )
    return moves.speed
