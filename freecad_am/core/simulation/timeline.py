# SPDX-License-Identifier: LGPL-2.1-or-later
"""When a motion is where: the time of every row with the waits between, and the state at any time.

The machine arrives at each row at the end of its segment, and may stand there: while the deposit starts or ends (lead
times), and between layers. Within a segment joints run straight.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..parameters.process import ProcessParameters
from ..types import Array, ArrayLike, Integers, Mask

# rapid rows between beads that begin with the withdrawal from the bead before; fewer begin on it
WITH_WITHDRAWAL = 3


@dataclass(frozen=True, eq=False)
class State:
    """Where the machine is at times (...,). All arrays have the shape of the times.

    row: int, the row it runs to or stands at. share: 0..1 of the segment that ends there; 1 while it stands. joints:
    (..., axes) rad or mm, NaN where unreachable. position: (..., 3) mm in the part, straight between rows; in rapid moves
    the tip goes where the joints take it, which may be wide of that. deposit: bool, whether it is on.
    standing: bool. speed: mm/s at the deposition point, as asked; 0 while it stands.
    """

    row: Integers
    share: Array
    joints: Array
    position: Array
    deposit: Mask
    standing: Mask
    speed: Array


@dataclass(frozen=True, eq=False)
class Timeline:
    """The times of a motion of n rows, s from its first row.

    arrive, leave: (n,) when each row is reached and left. lit: (n,) s of the stay with the deposit on, which come first.
    layer_rows: (layers,) the first row of each layer that is run, its rapids included, and layers their numbers.
    """

    motion: Motion
    arrive: Array
    leave: Array
    lit: Array
    layers: Integers
    layer_rows: Integers

    @property
    def total(self) -> float:
        """Time of moves and waits, s."""
        return float(self.leave[-1]) if len(self.leave) else 0.0

    @property
    def waits(self) -> Array:
        """(n,) s of waiting at each row."""
        return np.asarray(self.leave - self.arrive)

    def state_at(self, time: ArrayLike) -> State:
        """Return the state at times (...,) s; before the start and after the end the state of the first and
        last row.
        """
        motion, when = self.motion, np.clip(np.asarray(time, float), 0.0, self.total)
        row = np.minimum(np.searchsorted(self.leave, when, side="left"), len(self.leave) - 1)
        previous = np.maximum(row - 1, 0)
        went = self.arrive[row] - self.leave[previous]
        running = (when < self.arrive[row]) & (row > 0)
        share = np.where(
            running, (when - self.leave[previous]) / np.where(went > 0.0, went, 1.0), 1.0
        )
        start, end = (1.0 - share)[..., None], share[..., None]
        joints = np.where(
            end < 1.0,
            start * motion.joints[previous] + end * motion.joints[row],
            motion.joints[row],
        )
        position = start * motion.position[previous] + end * motion.position[row]
        stayed_lit = (when - self.arrive[row] < self.lit[row]) & (self.lit[row] > 0.0)
        at_start = motion.deposit[row] & (motion.point[row] == 0)
        deposit = np.where(running, motion.deposit[row] & ~at_start, stayed_lit)
        return State(
            row=row,
            share=share,
            joints=joints,
            position=position,
            deposit=deposit,
            standing=np.asarray(~running),
            speed=np.where(running, motion.speed[row], 0.0),
        )


def timeline(motion: Motion, process: ProcessParameters, waits: Sequence[float] = ()) -> Timeline:
    """The times of a motion, run as a program does: with lead times at the ends of beads and waits
    between layers.

    waits: s of waiting before each layer, by its number, none if left out; `between_layers.wait`
    counts towards them. The time to the first row is not included: the start position of the machine
    is unknown. Waits for inputs have no length.
    """
    n = len(motion)
    lit, dark = np.zeros(n), np.zeros(n)
    if n:
        is_start = motion.deposit & (motion.point == 0)
        is_end = motion.deposit & np.append(~motion.deposit[1:] | is_start[1:], True)
        of_class = [process.for_class(name) for name in (*CLASSES, "")]  # of none the last one
        lit[is_start] += np.array([parameters.lead_on for parameters in of_class])[
            motion.bead_class[is_start]
        ]
        lit[is_end] += np.array([parameters.lead_off for parameters in of_class])[
            motion.bead_class[is_end]
        ]
        dark = _between_layers(motion, process, waits)
    steps = np.nan_to_num(motion.duration)
    stay = lit + dark
    arrive = np.cumsum(steps) + np.cumsum(stay) - stay
    starts = np.flatnonzero(np.diff(motion.layer, prepend=-1)) if n else np.zeros(0, dtype=np.int64)
    return Timeline(motion, arrive, arrive + stay, lit, motion.layer[starts], starts)


def _between_layers(motion: Motion, process: ProcessParameters, waits: Sequence[float]) -> Array:
    """(n,) s of waiting at each row for the next layer: retracted from the last bead if there is a
    retract.
    """
    result = np.zeros(len(motion))
    starts = np.flatnonzero(np.diff(motion.layer)) + 1
    of_layer = (
        np.asarray(waits, float)[motion.layer[starts]] if len(waits) else np.zeros(len(starts))
    )
    seconds = np.maximum(of_layer, process.between_layers.wait)
    deposits = np.flatnonzero(motion.deposit)
    # rapid rows that lead to the layer: up to its first deposit row
    rapids = (
        deposits[np.minimum(np.searchsorted(deposits, starts), len(deposits) - 1)] - starts
        if len(deposits)
        else starts
    )
    result[np.where(rapids >= WITH_WITHDRAWAL, starts, starts - 1)] = seconds
    return result
