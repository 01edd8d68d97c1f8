# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves of VAL 3 applications: what the statements that were carried out take from the arrays of the data."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Array, Integers

from ...core.issues import Text, Word
from ...core.read_moves import ReadMoves
from .files import AXES, POSE, Application, Data, numbers, poses, rotations, unreadable

_UNLIMITED = 99999.0


@dataclass(frozen=True, eq=False)
class Step:
    """Moves of one statement: letter j or l, and the rows of the arrays they take."""

    app: Application
    where: str
    linear: bool
    names: tuple[str, str, str]
    point: Integers
    tool: Integers
    speed: Integers
    deposit: bool
    stops: bool = False


class _Values:
    """What the arrays say, each read once."""

    def __init__(self) -> None:
        self._read: dict[tuple[str, str, tuple[str, ...]], tuple[Array, float]] = {}
        self._fathers: dict[tuple[str, str], set[str]] = {}
        self._half_digits: dict[tuple[str, ...], dict[bool, float]] = {}

    def __call__(self, app: Application, name: str, columns: tuple[str, ...]) -> Array:
        key = (app.folder, name, columns)
        if key not in self._read:
            self._read[key] = numbers(app.data[name], columns, f"{app.folder}: {name}")
            values, half = self._read[key]
            halves = self._half_digits.setdefault(columns, {})
            halves[len(values) > 1] = max(halves.get(len(values) > 1, 0.0), half)
        return self._read[key][0]

    def digits(self, columns: tuple[str, ...]) -> float:
        """Half of the last digit of the values in these columns, 0 where none were read.

        A single value, such as the only frame of a part, is a setting and exact: it counts only if
        no array of several values has these columns.
        """
        halves = self._half_digits.get(columns, {})
        return halves.get(True, halves.get(False, 0.0))

    def six(self, app: Application, name: str) -> Array:
        """(n, 6) x y z rx ry rz, mm and degrees."""
        return np.hstack((self(app, name, _LENGTHS), self(app, name, _ANGLES)))

    def father(self, app: Application, name: str) -> str:
        """The common father of an array's values; '' if they differ."""
        key = (app.folder, name)
        if key not in self._fathers:
            self._fathers[key] = {value.get("fatherId", "") for value in app.data[name].values}
        return next(iter(self._fathers[key])) if len(self._fathers[key]) == 1 else ""

    def frame(self, app: Application, name: str, where: str) -> Array:
        """(4, 4) the frame of the points of an array; it must be fixed in the world, and the arm
        keep its configuration.
        """
        for value in app.data[name].values:
            if any(
                value.get(word, f"{word[0]}same") != f"{word[0]}same"
                for word in ("shoulder", "elbow", "wrist")
            ):
                raise unreadable(where, Text("a point of {} needs another arm configuration", name))
        return self._one(
            app,
            name,
            "frame",
            "world[0]",
            where,
            Text("the points of {} are not all in one frame", name),
        )

    def carrier(self, app: Application, name: str, where: str) -> Array:
        """(4, 4) the father of the tools of an array: the flange, or one other tool on the flange."""
        if self.father(app, name) == _FLANGE:
            return np.eye(4)
        return self._one(
            app, name, "tool", _FLANGE, where, Text("the tools of {} are not all on one tool", name)
        )

    def _one(
        self, app: Application, name: str, kind: str, ground: str, where: str, otherwise: str
    ) -> Array:
        match = re.fullmatch(r"(\w+)\[0\]", self.father(app, name))
        data = app.data.get(match[1], Data("", ())) if match else Data("", ())
        if (
            match is None
            or data.kind != kind
            or len(data.values) != 1
            or self.father(app, match[1]) != ground
        ):
            raise unreadable(
                where,
                Text(
                    "{} placed {}",
                    otherwise,
                    Word("in the world" if kind == "frame" else "on the flange"),
                ),
            )
        matrix: Array = poses(self.six(app, match[1]))[0]
        return matrix


def _corners(values: _Values, app: Application, descriptor: str, step: Step) -> Array:
    """(n,) mm before and after their ends that moves may leave their lines to round corners, 0 where they stop."""
    leave, reach = values(app, descriptor, _CORNERS)[step.speed].T
    words = np.array([value.get("blend", "") for value in app.data[descriptor].values])[step.speed]
    full = values(app, descriptor, _ACCELERATION)[step.speed]
    kinds = ("off", "Cartesian") if step.linear else ("off", "joint", "Cartesian")
    if not np.isin(words, kinds).all() or (leave != reach).any() or (full != 100.0).any():
        raise unreadable(
            step.where, "it rounds corners or accelerates in a way that is not understood"
        )
    rounded: Array = np.where(words == "off", 0.0, np.maximum(leave, 1e-9))
    return rounded


_CORNERS, _ACCELERATION = ("leave", "reach"), ("accel", "decel")
_LENGTHS, _ANGLES = POSE[:3], POSE[3:]
_FLANGE = "flange[0]"


def moves_of(steps: list[Step]) -> ReadMoves:
    """The moves of all steps, in order; without events between them."""
    total = sum(len(step.point) for step in steps)
    values = _Values()
    joints, point = np.full((total, 6), np.nan), np.full((total, 6), np.nan)
    tools, lever = np.tile(np.eye(4), (total, 1, 1)), np.zeros(total)
    share, speed, deposit = (
        np.full(total, np.nan),
        np.full(total, np.nan),
        np.zeros(total, dtype=bool),
    )
    stops, rounding, straight = (
        np.zeros(total, dtype=bool),
        np.full(total, np.nan),
        np.zeros(total, dtype=bool),
    )
    frame: Array | None = None
    row = 0
    for step in steps:
        rows = slice(row, row + len(step.point))
        row = rows.stop
        app, (target, tool, descriptor) = step.app, step.names
        deposit[rows], straight[rows] = step.deposit, step.linear
        rounding[rows] = _corners(values, app, descriptor, step)
        stops[rows] = rounding[rows] == 0.0
        stops[rows.stop - 1] |= step.stops
        percent = values(app, descriptor, _SHARE)[step.speed, 0]
        max_speed, most_turn = values(app, descriptor, _SPEEDS)[step.speed].T
        if step.linear:
            own_frame = values.frame(app, target, step.where)
            if frame is not None and not np.array_equal(own_frame, frame):
                raise unreadable(step.where, "positions of more than one frame are mixed")
            frame = own_frame
            point[rows] = values.six(app, target)[step.point]
            tool_values = values.six(app, tool)[step.tool]
            tools[rows] = values.carrier(app, tool, step.where) @ poses(tool_values)
            if values.father(app, tool) != _FLANGE:
                lever[rows] = np.linalg.norm(tool_values[:, :3], axis=1)
            speed[rows] = max_speed
            is_supported = (percent == 100.0) & (max_speed > 0.0) & (most_turn >= _UNLIMITED)
        else:
            joints[rows], share[rows] = values(app, target, AXES)[step.point], percent / 100.0
            is_supported = (
                (percent > 0.0)
                & (percent <= 100.0)
                & (max_speed >= _UNLIMITED)
                & (most_turn >= _UNLIMITED)
            )
        if not is_supported.all() or (not step.linear and values.father(app, tool) != _FLANGE):
            raise unreadable(
                step.where,
                "its speed is limited, or its tool fixed, in a way that is not understood",
            )
    linear = bool(np.isfinite(speed).any())
    return ReadMoves(
        np.radians(joints) if np.isfinite(share).any() else None,
        float(np.radians(values.digits(AXES))),
        np.full(total, np.nan),
        deposit,
        straight,
        stops,
        (),
        rounding=rounding,
        position=point[:, :3] if linear else None,
        rotation=rotations(point[:, 3:]) if linear else None,
        position_digits=values.digits(_LENGTHS),
        rotation_digits=float(np.radians(values.digits(_ANGLES))),
        speed=speed,
        speed_digits=values.digits(_SPEEDS),
        share=share,
        share_digits=values.digits(_SHARE) / 100.0,
        frame=frame,
        tool=tools if linear else None,
        lever=lever if linear else None,
    )


_SHARE, _SPEEDS = ("vel",), ("tmax", "rmax")
