# SPDX-License-Identifier: LGPL-2.1-or-later
"""The behaviour of a FANUC listing as read."""

from __future__ import annotations

import dataclasses
from array import array
from dataclasses import dataclass, field

import numpy as np

from freecad_am.core.types import Array, Index

from ...core.read_moves import Configuration, Event, ReadMoves
from ..packed import Lines, floats
from .parsed import Listing
from .records import unreadable

_ROBOT_AXES = 6  # axes of the robot


@dataclass
class Run:
    """The state while the programs are followed.

    pending: records of the current listing that were moved to and are not among `values` yet.
    recorded, numbers: frames of the last checked record, and the numbers of the selected ones.
    track: the external axis that a remark calls the track, 0 for none, and whether positions have
    one. moved: groups that headers name.
    """

    cartesian: bool = False
    values: list[Array] = field(default_factory=list)
    configuration: list[tuple[str, ...]] = field(default_factory=list)
    moved: frozenset[str] | None = None
    group: str | None = None
    track: tuple[int, bool] = (0, False)
    digits: float = 0.0
    pending: list[Index] = field(default_factory=list)
    duration: array[float] = field(default_factory=floats)
    speed: array[float] = field(default_factory=floats)
    share: array[float] = field(default_factory=floats)
    deposit: bytearray = field(default_factory=bytearray)
    linear: bytearray = field(default_factory=bytearray)
    blend: array[float] = field(default_factory=floats)
    user_frame: array[float] = field(default_factory=floats)
    tool_frame: array[float] = field(default_factory=floats)
    events: list[Event] = field(default_factory=list)
    frame: dict[str, str] = field(default_factory=dict)
    recorded: tuple[str, str] = ("", "")
    numbers: tuple[float, float] = (np.nan, np.nan)
    output: str = ""
    on: bool = False
    lines: Lines = field(default_factory=Lines)

    def happens(
        self, kind: str, *value: float | str, digits: float = 0.0, ahead: float | None = None
    ) -> None:
        """Something happens before the next move, or ahead of the end of the last one."""
        self.events.append(Event(len(self.duration), kind, value, digits, ahead))

    def begin(self, listing: Listing) -> None:
        """Check the groups of a listing; one without moves may name none."""
        groups = listing.records.moved
        if groups and self.moved not in (None, groups):
            raise unreadable(
                listing.file, "its header names other motion groups than programs before"
            )
        self.moved = groups or self.moved

    def take(self, listing: Listing) -> None:
        """Take over the records that are pending."""
        if self.pending:
            rows, records = np.concatenate(self.pending), listing.records
            if self.values and (self.group, self.values[0].shape[1]) != (
                records.group,
                records.values.shape[1],
            ):
                raise unreadable(
                    f"{listing.file} line {listing.moves.line[0]}",
                    "it moves other groups than the programs before",
                )
            self.group, self.track = records.group, (self.track[0], records.track)
            self.values.append(records.values[rows])
            self.digits = max(self.digits, records.digits)
            if self.cartesian:
                self.configuration += [records.configuration[row] for row in rows]
            self.pending = []


def read_moves(run: Run) -> ReadMoves:
    """All moves in the form of a reader. InputError UNREADABLE_PROGRAM if a track is not declared
    as one.
    """
    cartesian, values, digits = run.cartesian, np.concatenate(run.values), run.digits
    joints, half_turn = (
        (None, 0.0) if cartesian else (_joints(run, values), float(np.radians(digits)))
    )
    deposit, linear = (np.array(column, dtype=np.bool_) for column in (run.deposit, run.linear))
    blend = np.array(run.blend)
    moves = ReadMoves(
        joints,
        half_turn,
        np.array(run.duration),
        deposit,
        linear,
        np.isnan(blend),
        tuple(run.events),
        speed=np.array(run.speed),
        share=np.array(run.share),
        share_digits=0.005,
        blend=blend,
        user_frame=np.array(run.user_frame),
        tool_frame=np.array(run.tool_frame),
        unit=run.group or "",
        linear_digits=digits if run.track[1] else 0.0,
        lines=run.lines.read(),
    )
    if not cartesian:
        return moves
    words = np.array(run.configuration)
    return dataclasses.replace(
        moves,
        position=values[:, :3],
        rotation=_rotation(np.radians(values[:, 3:])),
        position_digits=digits,
        rotation_digits=float(np.radians(digits)),
        configuration=Configuration(
            words[:, 0] == "F",
            words[:, 1] == "U",
            words[:, 2] == "T",
            words[:, 3:].astype(np.float64),
        ),
    )


def _joints(run: Run, values: Array) -> Array:
    """(n, axes) rad and mm of the values of records, the track where a remark says that it is among the external axes."""
    number, track = run.track
    if track != bool(number) or number > values.shape[1] - _ROBOT_AXES:
        raise unreadable(
            "program",
            "positions have a track and no remark says which axis it is, or the other way round",
        )
    if not track:
        return np.asarray(np.radians(values))
    angles = np.radians(np.delete(values, _ROBOT_AXES, axis=1))
    return np.asarray(np.insert(angles, _ROBOT_AXES + number - 1, values[:, _ROBOT_AXES], axis=1))


def _rotation(wpr: Array) -> Array:
    """(n, 3, 3) rotations Rz(R) Ry(P) Rx(W) of W, P, R (n, 3) in rad."""
    cw, cp, cr = np.cos(wpr).T
    sw, sp, sr = np.sin(wpr).T
    rows = (
        (cr * cp, cr * sp * sw - sr * cw, cr * sp * cw + sr * sw),
        (sr * cp, sr * sp * sw + cr * cw, sr * sp * cw - cr * sw),
        (-sp, cp * sw, cp * cw),
    )
    return np.moveaxis(np.array(rows), -1, 0)
