# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a RAPID module says in numbers: joint values, quaternions, times, speeds, zones.

RAPID keeps a num in single precision, of seven digits: more are not written.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...core.issues import InputError
from ...core.orientation import MOVING_XYZ, QUATERNION
from ...core.program import DEPOSIT, LINEAR_MOVE, Moves, Program, Six
from ...core.types import Array, Mask
from ..parts import place
from ..refusals import speeds_within

ANGLE_DECIMALS, LENGTH_DECIMALS, TURN_DECIMALS = 4, 3, 7
# mm/s: the lowest speed that three decimals resolve well, and the largest of RAPID's own speeds
# (v7000)
SPEEDS = (0.01, 7000.0)
# s: the shortest move within a bead, and the shortest rapid
SHORTEST_MOVE_S, SHORTEST_RAPID = 0.0001, 0.001
# mm: RAPID's own largest zone is 200
LARGEST_ZONE = 100.0
STOP = "fine"


class Pose(NamedTuple):
    """X Y Z in mm and w x y z, as the text has them."""

    position: tuple[float, ...]
    quaternion: tuple[float, ...]


def controller_values(joints: Array, slides: Mask) -> Array:
    """Joint values (n, axes) as in the text: degrees, mm for prismatic axes `slides` (axes,)."""
    values = np.where(slides, joints, np.degrees(joints))
    rounded: Array = np.asarray(np.round(values, ANGLE_DECIMALS) + 0.0, dtype=np.float64)
    return rounded


def positions(position: Array) -> Array:
    """Positions (n, 3) as the text has them."""
    rounded: Array = np.asarray(np.round(position, LENGTH_DECIMALS) + 0.0, dtype=np.float64)
    return rounded


def quaternions(rotation: Array) -> Array:
    """(n, 4) w x y z of rotations (n, 3, 3), as in the text: of the two equivalent quaternions the
    one whose first nonzero number is positive.
    """
    numbers = np.round(QUATERNION.numbers(rotation), TURN_DECIMALS)
    leading = numbers[np.arange(len(numbers)), np.argmax(numbers != 0.0, axis=1)]
    signed: Array = np.where(leading[:, None] < 0.0, -numbers, numbers) + 0.0
    return signed


def pose(six: Six | None) -> Pose:
    """A frame given as X Y Z mm, RX RY RZ rad, with R = Rx Ry Rz; None gives the identity."""
    x, y, z, rx, ry, rz = (0.0,) * 6 if six is None else six
    rotation = MOVING_XYZ.rotations(np.array([[rx, ry, rz]]))
    return Pose(
        tuple(positions(np.array([x, y, z])).tolist()), tuple(quaternions(rotation)[0].tolist())
    )


class Words:
    """Speed and zone of the moves of a program, asked for block by block in the order of motion."""

    def __init__(self, program: Program, speed: str, zone: str) -> None:
        self._blend, self._speed, self._zone = program.blend, speed, zone
        self.zones: dict[float, str] = {}

    def __call__(self, moves: Moves) -> Sequence[str]:
        """`v\\T:=time,zone`, or `v\\V:=speed,zone`, of each move. Raises InputError MOVE_SPEED or MOVE_TIME."""
        straight = moves.interpolation == LINEAR_MOVE
        letter, values = (
            ("V", [f"{v:.3f}" for v in speeds_within(moves, *SPEEDS).tolist()])
            if straight
            else ("T", [f"{t:.5f}" for t in _times(moves).tolist()])
        )
        rounded = self._rounded(moves)
        corners = [STOP if stops else rounded for stops in moves.stops.tolist()]
        return [
            f"{self._speed}\\{letter}:={value},{corner}"
            for value, corner in zip(values, corners, strict=True)
        ]

    def _rounded(self, moves: Moves) -> str:
        """How corners are passed: never farther from one than half the shortest move of the bead."""
        shortest = (
            float(np.nan_to_num(moves.speed * moves.duration).min())
            if moves.kind == DEPOSIT
            else 0.0
        )
        size = math.floor(1000.0 * min(0.005 * self._blend * shortest, LARGEST_ZONE)) / 1000.0
        if size <= 0.0:
            return STOP
        return self.zones.setdefault(size, f"{self._zone}{len(self.zones) + 1}")


def _times(moves: Moves) -> Array:
    seconds = np.where(np.isfinite(moves.duration), moves.duration, 0.0)
    if moves.kind == DEPOSIT and seconds.min() < SHORTEST_MOVE_S:
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "a move takes {:.3g} s, below the minimum of {:g} s; use a larger chord error or a "
            "lower speed",
            seconds.min(),
            SHORTEST_MOVE_S,
        )
    return np.maximum(seconds, SHORTEST_MOVE_S if moves.kind == DEPOSIT else SHORTEST_RAPID)
