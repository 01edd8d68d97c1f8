# SPDX-License-Identifier: LGPL-2.1-or-later
"""The motion: every point that the machine passes, in order, as columns.

Each bead has rapid rows (retract from the previous bead, travel, approach onto the start) followed
by deposit rows. The first deposit row repeats the position of the last rapid row and takes no time,
so that a bead's rows are complete. After the last bead the tool retracts.

A rapid is straight in joint space and stops at each row. A bead passes through its rows and stops
at its end. The program decides whether bead moves are straight in joint space or in the tip path.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from .types import Array, Integers, Mask

# roles of the move that ends at a row: deposit; away from the previous bead; to the next bead; onto
# the start of that bead
DEPOSIT, RETRACT, TRAVEL, APPROACH = range(4)
UNKNOWN = -1  # unknown class of a bead
MIDDLE, AT_START, AT_END = PHASES = range(3)  # phase of the bead segment that ends at a row


@dataclass(frozen=True, eq=False)
class Motion:
    """Columns of n rows. Points and directions in the part frame, mm; serial joint values, rad.

    deposit: (n,) bool. layer, bead, point: (n,) int from 0; a rapid row has the indices of the bead
    that it leads to. position, build, tool: (n, 3). speed: (n,) mm/s at the deposition point on the
    segment that ends at the row. width: (n,) mm, NaN without a bead model. joints: (n, axes)
    unwrapped along the whole job, NaN where unreachable. duration: (n,) s of the segment that ends
    at the row. wire: (n,) wire speed on that segment, mm/s, if the wire follows the travel speed,
    else NaN (default). role: (n,) DEPOSIT, RETRACT, TRAVEL or APPROACH. By default, as in documents
    of older versions, there is one retract and one approach row between beads, or none with too few
    rows. bead_class: (n,) index in `parameters.bead_classes.CLASSES` for the bead that the row
    belongs or leads to; UNKNOWN by default. phase: (n,) phase, see PHASES. halt: (n,) bool, rows
    within beads at which the machine stops, for example to reverse; none by default. settings: (n,)
    int, settings by place on that segment, as the sum of 2^entry; 0 for rapids and by default. The
    first row of a bead has those of its first segment.
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
    settings: Integers = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        n = len(self.deposit)
        if self.bead_class is None:
            object.__setattr__(self, "bead_class", np.full(n, UNKNOWN))
        if self.phase is None:
            object.__setattr__(self, "phase", np.full(n, MIDDLE))
        if self.halt is None:
            object.__setattr__(self, "halt", np.zeros(n, dtype=bool))
        if self.settings is None:
            object.__setattr__(self, "settings", np.zeros(n, dtype=np.int64))
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
        """Rows that need a move, (n,) bool; the first row of a bead repeats the current position."""
        return np.asarray(~(self.deposit & (self.point == 0)), dtype=np.bool_)

    @cached_property
    def stops(self) -> Mask:
        """Rows at which the machine stops, (n,) bool: rapid rows, bead ends and halts."""
        # cached because the program reads this column once per bead
        last = np.append(~self.deposit[1:] | (self.point[1:] == 0), True)[: len(self)]
        stops: Mask = ~self.deposit | last | self.halt
        stops.setflags(write=False)
        return stops

    @property
    def reachable(self) -> Mask:
        """Rows with joint values, (n,) bool."""
        return np.asarray(np.isfinite(self.joints).all(axis=1), dtype=np.bool_)

    @property
    def total_time(self) -> float:
        """Total time of the moves, s; waits and lead times are not counted."""
        return float(self.duration.sum())


def _roles(deposit: Mask) -> Integers:
    """Return the default roles (n,), derived from the sequence of deposit and rapid rows."""
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
