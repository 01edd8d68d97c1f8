# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare the events between moves of a text (deposit, waits, inputs, calls, layers) with the
planned events.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np

from ..core.issues import ERROR, Issue, Text
from ..core.program import (
    Block,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Schedule,
    Wait,
    WaitBelow,
    WaitInput,
    Weave,
)
from ..core.read_moves import ARC, Event, ReadMoves
from ..core.types import Array
from .text_path import COMPUTED_AXIS, Planned

# s; maximum rounding error when a path length becomes a time. If the text has too few digits or the
# tip hardly moves, the event does not match the plan
MOST_DIGITS = 0.0005


def timed(events: Sequence[Event], speed: Array) -> tuple[Event, ...]:
    """Convert path lengths before events to times, given the tip speed (n,), mm/s, of each move.

    The time is NaN on a move without a speed.
    """
    return tuple(
        event if event.before is None else _timed(event, event.before, speed) for event in events
    )


def speeds_of(planned: Planned, text: ReadMoves) -> Array:
    """Return the tip speed (n,) of each move, mm/s.

    It is the speed in the text, or without one the speed from the planned points and times.
    """
    step_lengths = np.linalg.norm(
        np.diff(planned.position, axis=0, prepend=planned.position[:1]), axis=1
    )
    speed: Array = np.divide(
        step_lengths,
        planned.duration,
        out=np.zeros(len(step_lengths)),
        where=planned.duration > 0.0,
    )
    if text.speed is None:
        return speed
    return np.asarray(np.where(np.isfinite(text.speed), text.speed, speed))


def _timed(event: Event, distance_before: float, speed: Array) -> Event:
    along = float(speed[event.row - 1])
    if not distance_before:
        return dataclasses.replace(event, ahead=0.0, digits=0.0, before=None)
    if not along > 0.0:
        return dataclasses.replace(event, ahead=np.nan, digits=0.0, before=None)
    return dataclasses.replace(
        event,
        ahead=distance_before / along,
        digits=min(event.digits / along, MOST_DIGITS),
        before=None,
    )


# error code and message, and the event kinds that they cover
_FAMILIES = (
    ("VERIFY_DEPOSIT", "the program switches the deposit differently than planned", ("on", "off")),
    ("VERIFY_SCHEDULE", "the schedule in the program differs from the plan", ("schedule",)),
    ("VERIFY_WEAVE", "the program weaves beads differently than planned", ("weave",)),
    ("VERIFY_WAIT", "the program waits differently than planned", ("wait", "input")),
    ("VERIFY_COOLING", "the temperature in the program differs from the plan", ("below",)),
    ("VERIFY_CALL", "the programs called by the program differ from the plan", ("call",)),
    ("VERIFY_LAYER", "layers do not begin where planned", ("layer",)),
)


def event_issues(planned: Planned, program: Program, text: ReadMoves) -> list[Issue]:
    """Check the deposit state and the wire feed of each move, and all events."""
    expected = planned.deposit & (not program.dry_run)
    wire = np.where(
        expected, planned.motion.wire[planned.rows] * (0.06 * program.nc.wire_gain), np.nan
    )
    feed = np.where(text.deposit, np.nan if text.wire is None else text.wire, np.nan)
    wrong = (np.abs(feed - wire) > text.wire_digits + COMPUTED_AXIS * wire) | (
        np.isnan(feed) != np.isnan(wire)
    )
    if text.wire_output not in (None, program.nc.wire_output):
        wrong |= expected
    issues = planned.issue(
        "VERIFY_DEPOSIT",
        text.deposit != expected,
        "the program switches the deposit differently than planned",
    )
    issues += planned.issue(
        "VERIFY_WIRE", wrong, "the wire feed in the program differs from the plan"
    )
    codes = {issue.code for issue in issues}
    events, due = (
        _merge_waits(timed(text.events, speeds_of(planned, text))),
        _merge_waits(_due(program)),
    )
    for code, message, kinds in _FAMILIES:
        if code not in codes:
            issues += _compared(
                planned, program, code, message, _of(events, kinds), _of(due, kinds)
            )
    if not issues and [(event.row, event.kind) for event in events] != [
        (event.row, event.kind) for event in due
    ]:
        issues.append(
            Issue(
                ERROR,
                "VERIFY_ORDER",
                "events between moves are out of order compared with the plan",
            )
        )
    return issues


def _compared(
    planned: Planned,
    program: Program,
    code: str,
    message: str,
    events: Sequence[Event],
    due: Sequence[Event],
) -> list[Issue]:
    """Return an error if the events of a text differ from the planned events."""
    alike = [_alike(program, event, due_event) for event, due_event in zip(events, due)]
    off = alike.count(False) + abs(len(events) - len(due))
    if not off:
        return []
    first_mismatch = alike.index(False) if False in alike else len(alike)
    row = min(
        (events[first_mismatch].row for events in (events, due) if first_mismatch < len(events)),
        default=0,
    )
    return [
        Issue(
            ERROR,
            code,
            Text("{}; {} of {} events", message, off, max(len(events), len(due))),
            *planned.place(row),
        )
    ]


def _alike(program: Program, event: Event, due: Event) -> bool:
    """Whether an event of a text matches the planned event."""
    if (event.row, event.kind) != (due.row, due.kind) or not _as_early(event, due):
        return False
    if ARC in (*event.value, *due.value):
        return event.value == due.value
    if due.kind in ("on", "off") and program.nc.deposit_on and program.axis_names:
        return (
            event.value[1]
            == (program.nc.deposit_on if due.kind == "on" else program.nc.deposit_off).upper()
        )
    if due.kind in ("on", "off"):
        return event.value[0] == due.value[0]
    if due.kind == "call":
        return event.value == due.value
    *names, value = (float(word) for word in event.value)
    *due_names, due_value = (float(word) for word in due.value)
    # a wait below the resolution of the text is written as one unit of its last digit
    due_value = max(due_value, 2.0 * event.digits) if due.kind == "wait" else due_value
    return names == due_names and abs(value - due_value) <= event.digits + 1e-9


def _as_early(event: Event, due: Event) -> bool:
    """Whether two events have the same lead, or both happen at standstill."""
    if event.ahead is None or due.ahead is None:
        return event.ahead is due.ahead
    return abs(event.ahead - due.ahead) <= event.digits + 1e-9


def _of(events: Sequence[Event], kinds: Sequence[str]) -> list[Event]:
    return [event for event in events if event.kind in kinds]


def _merge_waits(events: Sequence[Event] | Iterator[Event]) -> list[Event]:
    """Merge consecutive waits and drop waits of 0 s."""
    joined: list[Event] = []
    for event in events:
        previous = joined[-1] if joined else None
        if event.kind == "wait" and event.value == (0.0,):
            continue
        if previous and (previous.row, previous.kind, event.kind) == (event.row, "wait", "wait"):
            joined[-1] = Event(
                event.row, "wait", (float(previous.value[0]) + float(event.value[0]),), event.digits
            )
        else:
            joined.append(event)
    return joined


def _due(program: Program) -> Iterator[Event]:
    """Yield the planned events between moves."""
    row = 0
    for block in program.blocks:
        if isinstance(block, Moves):
            row += len(block)
            continue
        for kind, *value in _happening(program, block):
            ahead = (
                block.ahead
                if isinstance(block, (DepositOn, DepositOff)) and kind != "wait"
                else None
            )
            yield Event(row, str(kind), tuple(value), ahead=ahead)


def _happening(program: Program, block: Block) -> list[tuple[float | str, ...]]:
    if isinstance(block, DepositOn):
        return (
            []
            if program.dry_run
            else [("on", *_switched(program, block.schedule)), ("wait", float(block.lead))]
        )
    if isinstance(block, DepositOff):
        return (
            []
            if program.dry_run
            else [("wait", float(block.lead)), ("off", *_switched(program, block.schedule))]
        )
    if isinstance(block, Schedule):
        return [("schedule", float(program.schedule_output), float(block.number))]
    if isinstance(block, Weave):
        return [("weave", float(block.number))]
    if isinstance(block, LayerStart):
        return [("layer", float(block.layer))]
    if isinstance(block, Wait):
        return [("wait", float(block.seconds))]
    if isinstance(block, WaitInput):
        return [("input", float(block.number))]
    if isinstance(block, WaitBelow):
        return [("below", float(block.number), block.below)]
    if isinstance(block, Call):
        return [("call", block.program.upper())]
    return []


def _switched(program: Program, schedule: int | None) -> tuple[float | str, ...]:
    """Return the switching command: an output, or an arc instruction with its schedule."""
    return (float(program.deposit_output),) if schedule is None else (float(schedule), ARC)
