# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reject programs and settings that a controller does not support; common code of all posts."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

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
from ..core.types import Array
from .parts import place, switching

CALL = "process.between_layers.call"


@dataclass(frozen=True)
class Asked:
    """Process features that a program requests, with their context.

    motion: 'joint' or 'cartesian'. part_held, turned: whether the robot holds the part, and whether
    a positioner rotates it. by: how schedules are selected. wire: whether the wire feed follows the
    travel speed. weave: whether beads are woven.
    """

    motion: str
    part_held: bool
    turned: bool
    by: str
    wire: bool
    weave: bool
    dry_run: bool


def refuse_no_process(request: Asked) -> None:
    """Reject nothing; for controllers that can combine all process features that they support."""


def refuse_wire(program: Program, no_wire: str) -> None:
    """Raise InputError NO_WIRE_OUTPUT, with the reason `no_wire`, if the program sets the wire
    feed.
    """
    if any(run.wire is not None for run in program.moves):
        raise wire_refused(no_wire)


def wire_refused(no_wire: str) -> InputError:
    """Return the error for a controller that cannot set the wire feed along a bead."""
    return InputError(
        "NO_WIRE_OUTPUT",
        "process.wire.feed_mode",
        "{}; use constant, or another controller",
        no_wire,
    )


def refuse_cooling(program: Program, last_input: int, why: str = "") -> None:
    """Reject waits for a temperature that the controller cannot express.

    Parameters
    ----------
    program : Program
        The program.
    last_input : int
        Highest number of an analogue input.
    why : str, optional
        Why the controller has no analogue input; empty if it has one.

    Raises
    ------
    InputError
        NO_ANALOGUE_INPUT for the reason `why`, or ANALOGUE_INPUT for an input outside 1 to
        `last_input`.
    """
    waits = [block for block in program.blocks if isinstance(block, WaitBelow)]
    if waits and why:
        raise InputError(
            "NO_ANALOGUE_INPUT",
            "process.cooling.below",
            "{}; use process.between_layers.input, strategy.wait, or another controller",
            why,
        )
    if any(block.number > last_input for block in waits):
        raise InputError(
            "ANALOGUE_INPUT",
            "process.cooling.input",
            "the controller program reads analogue inputs 1 to {}, not {}; choose an input in "
            "this range",
            last_input,
            waits[0].number,
        )


def refuse_schedules(
    program: Program,
    last_output: int,
    max_schedule: int,
    max_arc_schedule: int = 0,
    inside: bool = False,
) -> None:
    """Reject schedules that the controller cannot express.

    Parameters
    ----------
    program : Program
        The program.
    last_output : int
        Highest number of an output.
    max_schedule : int
        Highest number of a schedule.
    max_arc_schedule : int, optional
        Highest number in arc instructions; 0 for `max_schedule`.
    inside : bool, optional
        Whether the schedule can change within a bead.

    Raises
    ------
    InputError
        SCHEDULE.
    """
    if not inside and any(isinstance(block, Schedule) and block.inside for block in program.blocks):
        raise InputError(
            "SCHEDULE",
            "process.schedule",
            "beads change their schedule on the way, but the controller appears to set outputs "
            "before the motion reaches the place; change only the speed at start, end and by "
            "place, or use another controller",
        )
    numbers = [block.number for block in program.blocks if isinstance(block, Schedule)]
    if numbers and not 1 <= program.schedule_output <= last_output:
        raise InputError(
            "SCHEDULE",
            "program.schedule.output",
            "schedule numbers need an output from 1 to {}, not {}; choose an output in this range",
            last_output,
            program.schedule_output,
        )
    named = [
        block.schedule
        for block in program.blocks
        if isinstance(block, DepositOn) and block.schedule is not None
    ]
    largest, max_schedule = (
        (max(named), max_arc_schedule or max_schedule)
        if named
        else (max(numbers, default=0), max_schedule)
    )
    if largest > max_schedule:
        raise InputError(
            "SCHEDULE",
            "process.schedule",
            "the controller supports schedules up to {}, not {}; use a smaller number in "
            "process.schedule and process.classes",
            max_schedule,
            largest,
        )


def refuse_weave(program: Program, max_weave: int) -> None:
    """Raise InputError WEAVE for a weave number above `max_weave`, or for a weave on joint moves."""
    numbers = [block.number for block in program.blocks if isinstance(block, Weave)]
    if numbers and program.motion != "cartesian":
        raise weave_refused(JOINT_WEAVE, "program.motion")
    if max(numbers, default=0) > max_weave:
        raise weave_refused(
            Text("the controller has weaves 1 to {}, not {}", max_weave, max(numbers))
        )


JOINT_WEAVE = "controllers weave on linear moves only, but the program has joint moves"


def weave_refused(why: str, where: str = "process.weave") -> InputError:
    """Return the error for an unsupported weave."""
    return InputError(
        "WEAVE",
        where,
        "{}; set program.motion to cartesian with the tool on the robot (fanuc, yaskawa; abb with "
        "program.schedule.by: arc too), or process.weave, also in process.classes, to 0",
        why,
    )


def schedule_refused(by: str, why: str) -> InputError:
    """Return the error for a controller that cannot select schedules by `by`."""
    return InputError(
        "SCHEDULE",
        "program.schedule.by",
        "{}: {}; use another method, or another controller",
        by,
        why,
    )


def trigger_refused(why: str) -> InputError:
    """Return the error for a controller or program that cannot switch the deposit ahead of a point."""
    return InputError(
        "TRIGGER", "program.trigger.lead", "{}; remove the setting, or use another controller", why
    )


@dataclass(frozen=True)
class Ahead:
    """A switch of the deposit `lead` s before the end of the last of `moves`.

    seconds: duration of that move, or its remaining time after the rounded corner before it. slack:
    s; resolution of the controller, by which a lead may exceed `seconds`. steps: steps per second;
    messages give the maximum lead as a whole number of steps.
    """

    moves: Moves
    lead: float
    seconds: float
    corner: bool = False
    slack: float = 0.0
    steps: int = 1000


def refuse_triggers(program: Program, no_trigger: str) -> None:
    """Reject unsupported switches of the deposit ahead of a position.

    Raises InputError TRIGGER, with the reason `no_trigger` if not empty, for any such switch, and
    TRIGGER_LEAD for a switch before the start of its move.
    """
    switches = [block for block in program.blocks if isinstance(block, (DepositOn, DepositOff))]
    if no_trigger and not program.dry_run and any(block.ahead is not None for block in switches):
        raise trigger_refused(no_trigger)
    refuse_leads(switched_ahead(program))


def switched_ahead(program: Program) -> list[Ahead]:
    """Return all switches of the deposit ahead of the end of a move."""
    pairs = [] if program.dry_run else switching(program)
    return [
        Ahead(moves, block.ahead, float(moves.duration[-1]))
        for moves, block in pairs
        if block.ahead is not None
    ]


def refuse_leads(ahead: Sequence[Ahead]) -> None:
    """Raise InputError TRIGGER_LEAD if a lead is too long, naming the shortest move so that one
    correction is enough.
    """
    shortest = min(
        ahead, key=lambda ahead_switch: ahead_switch.seconds + ahead_switch.slack, default=None
    )
    if shortest is None or shortest.lead <= shortest.seconds + shortest.slack:
        return
    max_lead = _whole_steps(shortest.seconds + shortest.slack, shortest.steps)
    if shortest.corner:
        raise InputError(
            "TRIGGER_LEAD",
            place(shortest.moves),
            "the corner before the switching point is rounded, which leaves {:.4g} s, less than "
            "the lead of {:.4g} s; use a program.trigger.lead of at most {:g} s, a smaller "
            "program.blend, or a larger strategy.chord_error",
            shortest.seconds,
            shortest.lead,
            max_lead,
        )
    raise InputError(
        "TRIGGER_LEAD",
        place(shortest.moves),
        "the move before the switching point takes {:.4g} s, less than the lead of {:.4g} s; use "
        "a program.trigger.lead of at most {:g} s, a larger retract distance before switching "
        "on, or a larger strategy.chord_error before switching off",
        shortest.seconds,
        shortest.lead,
        max_lead,
    )


def _whole_steps(seconds: float, steps: int) -> float:
    """Round seconds down to a whole number of steps, `steps` per second."""
    nearest = round(steps * seconds)
    return (nearest if nearest / steps <= seconds else nearest - 1) / steps


def refuse_incomplete(program: Program, post: str, axes: int) -> None:
    """Reject a program without moves, or with the wrong axes.

    Parameters
    ----------
    program : Program
        The program.
    post : str
        Name of the post, for messages.
    axes : int
        Number of axes that the post writes.

    Raises
    ------
    InputError
        NOTHING_TO_WRITE, UNSUPPORTED_AXES or UNREACHABLE.
    """
    moves = program.moves
    if not sum(len(run) for run in moves):
        raise InputError("NOTHING_TO_WRITE", "program", "the program has no moves; check its start")
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
            "some points have no joint values; plan a joint path that reaches all points",
        )


def refuse_external(program: Program, last_axis: int, unit: str, form: str) -> None:
    """Reject external axes that the controller cannot address.

    Parameters
    ----------
    program : Program
        The program.
    last_axis : int
        Highest number of an external axis.
    unit : str
        Pattern of a positioner's name.
    form : str
        Description of this pattern, for messages.

    Raises
    ------
    InputError
        UNSUPPORTED_AXES.
    """
    if not program.external_kinds:
        return
    end = program.first_external + len(program.external_kinds) - 1
    if end > last_axis:
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.axes.first",
            "external axes would be numbered up to {}, but the controller has only {}; use a "
            "smaller first number",
            end,
            last_axis,
        )
    if not re.fullmatch(unit, program.unit) and (program.on_positioner or program.unit):
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.axes.unit",
            "{!r} is not a valid positioner for the controller; use {}",
            program.unit,
            form,
        )


def refuse_named_track(program: Program, what: str) -> None:
    """Raise InputError UNSUPPORTED_AXES if the job names a track but the controller has no track
    names.

    what: describes the track on this controller.
    """
    if program.unit and program.on_track and not program.on_positioner:
        raise InputError(
            "UNSUPPORTED_AXES",
            "program.axes.unit",
            "the controller does not name tracks, and {} is a track; remove program.axes.unit",
            what,
        )


def refuse_continuous(program: Program) -> None:
    """Raise InputError ENDLESS_AXIS if an axis is continuous; for controllers that count the turns
    of every axis.
    """
    if any(program.continuous):
        axis = program.continuous.index(True) + 1
        raise InputError(
            "ENDLESS_AXIS",
            "cell.limits",
            "axis {} has no limits, but the controller needs limits to count the turns of its "
            "joint values; use a limit set that limits axis {}",
            axis,
            axis,
        )


def refuse_without_speeds(program: Program, axes: int) -> None:
    """Raise InputError NO_JOINT_SPEED if a machine file lacks maximum joint speeds, which
    percentages refer to.
    """
    is_known = np.isfinite(program.max_speed)
    if len(is_known) == axes and is_known.all():
        return
    axis = int(is_known.argmin()) if len(is_known) == axes else 0
    in_urdf = Text("`velocity` to the `<limit>` of each of its joints")
    raise InputError(
        "NO_JOINT_SPEED",
        "cell.machine" if axis < program.own_axes else "cell.external",
        "the controller programs joint moves in percent of the maximum axis speeds, which the "
        "machine file of {} lacks; add {}",
        (program.axis_machines or (program.machine,) * axes)[axis],
        in_urdf if program.of_urdf and program.of_urdf[axis] else Text("`max_speed` to its joints"),
    )


def refuse_without_positions(program: Program, straight: bool = False) -> None:
    """Raise InputError NO_POSITIONS if moves of a Cartesian program lack a pose.

    straight: check linear moves only.
    """
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
    """Reject calls of programs whose name is also a program of the job.

    Parameters
    ----------
    program : Program
        The program.
    names : set[str]
        Names of the job's programs.
    program_name : callable
        Returns the controller's name of a program.

    Raises
    ------
    InputError
        PROGRAM_NAME.
    """
    own_names = {
        name.upper() for name in names
    }  # case-insensitive controllers and disks would confuse the names
    for block in program.blocks:
        if (
            isinstance(block, Call)
            and program_name(block.program, block.where).upper() in own_names
        ):
            raise InputError(
                "PROGRAM_NAME",
                block.where,
                "{!r} is also a program of the job; use another name, or rename the job",
                block.program,
            )


def refuse_names_of_data(program: Program, names: Collection[str], data: Collection[str]) -> None:
    """Reject files or called programs with the name of data on the controller.

    Parameters
    ----------
    program : Program
        The program.
    names : iterable of str
        Names of the program's files.
    data : iterable of str
        Names of data that the program uses.

    Raises
    ------
    InputError
        PROGRAM_NAME.
    """
    reserved = {name.upper() for name in data}
    called = {block.program: block.where for block in program.blocks if isinstance(block, Call)}
    for name, where in {**called, **dict.fromkeys(sorted(names), "name")}.items():
        if name.upper() in reserved:
            raise InputError(
                "PROGRAM_NAME",
                where,
                "{!r} clashes with a variable or signal of the program; choose another name",
                name,
            )


def speeds_within(moves: Moves, min_speed: float, max_speed: float) -> Array:
    """Return the speeds of moves after checking that the controller supports them.

    Parameters
    ----------
    moves : Moves
        The n moves.
    min_speed, max_speed : float
        Range of speeds, mm/s.

    Returns
    -------
    (n,) array
        mm/s.

    Raises
    ------
    InputError
        MOVE_SPEED for a speed outside the range.
    """
    fits = (moves.speed >= min_speed) & (moves.speed <= max_speed)
    if not fits.all():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written; use a speed between {} and {:.0f} mm/s",
            moves.speed[~fits][0],
            min_speed,
            max_speed,
        )
    return moves.speed
