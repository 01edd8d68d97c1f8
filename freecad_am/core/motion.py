# SPDX-License-Identifier: LGPL-2.1-or-later
"""The motion: every point the machine passes, in order, as columns.

Each bead has its rapid rows (retract from the previous bead, travel, approach onto the start) and
then its deposit rows. The first deposit row repeats the position of the last rapid row and takes no
time, so that a bead's rows are complete. After the last bead the tool is retracted.

A rapid is straight in the joints and stops at each row. A bead passes through its rows and stops at
its end. The program decides whether joints or the tip are straight within a bead.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from .types import Array, Integers, Mask

# purpose of the move that ends at a row: deposit; away from the previous bead; over to the next
# bead; onto its start
DEPOSIT, RETRACT, TRAVEL, APPROACH = range(4)
UNKNOWN = -1  # unknown class of a bead
MIDDLE, AT_START, AT_END = PHASES = range(3)  # phase of the bead segment that ends at a row


@dataclass(frozen=True, eq=False)
class Motion:
    """Columns of n rows. Points and directions in the part's own frame, mm; joints serial, rad.

    deposit: (n,) bool. layer, bead, point: (n,) int from 0; a rapid row carries the bead it leads
    to. position, build, tool: (n, 3). speed: (n,) mm/s at the deposition point on the segment that
    ends at the row. width: (n,) mm, NaN without a bead model. joints: (n, axes) unwrapped along the
    whole job, NaN where unreachable. duration: (n,) s of the segment that ends at the row. wire:
    (n,) mm/s of the wire on that segment if it follows the travel speed, else NaN, the default.
    role: (n,) DEPOSIT, RETRACT, TRAVEL or APPROACH; by default, as in documents of older versions,
    one retract and one approach row between beads, or none with too few rows. bead_class: (n,)
    index in `parameters.bead_classes.CLASSES` for the bead that the row belongs or leads to;
    UNKNOWN by default. phase: (n,) phase, see PHASES. halt: (n,) bool, the rows within beads at
    which the machine stops, for example to reverse; none by default.
    """

    deposit: Mask
    layer: Integers
    bead: Integers
    point: Integers
    position: Array
    build: Array
    tool: Array
    speed: Array
    width: Array
    joints: Array
    duration: Array
    wire: Array = None  # type: ignore[assignment]
    role: Integers = None  # type: ignore[assignment]
    bead_class: Integers = None  # type: ignore[assignment]
    phase: Integers = None  # type: ignore[assignment]
    halt: Mask = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        n = len(self.deposit)
        if self.bead_class is None:
            object.__setattr__(self, "bead_class", np.full(n, UNKNOWN))
        if self.phase is None:
            object.__setattr__(self, "phase", np.full(n, MIDDLE))
        if self.halt is None:
            object.__setattr__(self, "halt", np.zeros(n, dtype=bool))
        if self.role is None:
            object.__setattr__(self, "role", _roles(self.deposit))
        if self.wire is None:
            object.__setattr__(self, "wire", np.full(n, np.nan))
        for field in fields(self):
            column = getattr(self, field.name)
            if len(column) != n:
                raise ValueError(f"the column {field.name} has {len(column)} rows, expected {n}")
            column.setflags(write=False)

    def __len__(self) -> int:
        return len(self.deposit)

    @property
    def moves(self) -> Mask:
        """(n,) bool: the rows a controller moves to; the first row of a bead repeats the present
        position.
        """
        return np.asarray(~(self.deposit & (self.point == 0)), dtype=np.bool_)

    @cached_property
    def stops(self) -> Mask:
        """(n,) bool: the rows at which the machine comes to a stop: all of a rapid, ends of beads, and where it halts."""
        # kept, as every bead of a program asks for its own rows
        last = np.append(~self.deposit[1:] | (self.point[1:] == 0), True)[: len(self)]
        stops: Mask = ~self.deposit | last | self.halt
        stops.setflags(write=False)
        return stops

    @property
    def reachable(self) -> Mask:
        """(n,) bool: rows with joint values."""
        return np.asarray(np.isfinite(self.joints).all(axis=1), dtype=np.bool_)

    @property
    def total_time(self) -> float:
        """Total time of the moves, s; waits and lead times are not counted."""
        return float(self.duration.sum())


def _roles(deposit: Mask) -> Integers:
    """Return the roles (n,) of the rows, derived from the rows before and after them."""
    role = np.where(deposit, DEPOSIT, TRAVEL).astype(np.int64)
    edges = np.concatenate([[0], np.flatnonzero(deposit[1:] != deposit[:-1]) + 1, [len(deposit)]])
    for start, end in zip(edges[:-1].tolist(), edges[1:].tolist()):
        if start == end or deposit[start]:
            continue
        first, last = start == 0, end == len(deposit)
        if last and not first:
            role[start:end] = RETRACT
        elif not last and end - start >= (2 if first else 3):
            role[end - 1] = APPROACH
            role[start] = role[start] if first else RETRACT
    return role
