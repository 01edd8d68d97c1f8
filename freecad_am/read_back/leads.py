# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long ahead of its place a text switches, where it says how far: as long as the tip takes for that on that move."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from freecad_am.core.types import Array

from ..core.read_moves import Event, ReadMoves
from .planned import Planned

# s that the digits of a way may amount to: a text that tells it to fewer, or where the tip hardly moves, is not the planned
# one
MOST_DIGITS = 0.0005


def timed(events: Sequence[Event], speed: Array) -> tuple[Event, ...]:
    """The events, each with a time in place of a way: of the tip, which has such a speed (n,), mm/s, on each move. NaN where
    it has none."""
    return tuple(
        event if event.before is None else _timed(event, event.before, speed) for event in events
    )


def speeds_of(planned: Planned, text: ReadMoves) -> Array:
    """(n,) mm/s of the tip on each move: as the text says it, else by the planned points and times, against which its own
    are held."""
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
