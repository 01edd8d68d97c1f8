# SPDX-License-Identifier: LGPL-2.1-or-later
"""What ways off the ends of beads are, and in what order they are tried where the machine cannot go the one asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...types import Array, Index
from ..joint_path import BeadPath

LIMIT, UNREACHABLE, SINGULAR = "LIMIT", "UNREACHABLE", "SINGULAR"

_HEIGHTS = (0.75, 0.5, 0.25, 0.1, 1.5, 2.0, 3.0)
DIRECTIONS = tuple(range(1, 10))
_TURNS = tuple(
    math.radians(sign * turn)
    for turn in (5, 15, 30, 60, 90, 120, 180, 240, 360)
    for sign in (1, -1)
)
# by how much the tool axis leans at the far end, rad, and towards how many sides
LEANS_RAD = (0.0, math.radians(5.0), math.radians(15.0))
SIDES = 8
_LEANS = tuple(range(1, 1 + SIDES * (len(LEANS_RAD) - 1)))


class Choice(NamedTuple):
    """A way off a bead: its height as a share of that asked for, the index of its direction, the turn about the tool axis on
    the way, rad, and the index of what the tool axis leans by (SIDES to each angle, after none)."""

    share: float = 1.0
    direction: int = 0
    turn: float = 0.0
    lean: int = 0


DEFAULT_CHOICE = Choice()


def groups(direction: int, thorough: bool) -> tuple[tuple[Choice, ...], ...]:
    """Return the retracts in their order of preference; the retracts of a group are checked together."""
    if not thorough:
        return (
            (Choice(1.0, direction),),
            tuple(Choice(1.0, direction, turn) for turn in _TURNS),
            tuple(Choice(1.0, direction, 0.0, lean) for lean in _LEANS),
        )
    other_directions = tuple(k for k in DIRECTIONS if k != direction)
    return (
        (Choice(1.0, direction),),
        tuple(Choice(share, direction) for share in _HEIGHTS),
        tuple(
            Choice(share, alternative)
            for alternative in other_directions
            for share in (1.0, *_HEIGHTS)
        ),
        tuple(Choice(share, direction, turn) for share in (1.0, 0.5, 0.1, 2.0) for turn in _TURNS),
        tuple(
            Choice(share, direction, 0.0, lean) for share in (1.0, 0.5, 0.1, 2.0) for lean in _LEANS
        ),
        tuple(
            Choice(share, alternative, turn)
            for alternative in other_directions
            for share in (1.0, 0.25)
            for turn in _TURNS
        ),
        tuple(
            Choice(share, direction, turn, lean)
            for share in (1.0, 0.25)
            for turn in _TURNS
            for lean in _LEANS
        ),
    )


class Ways(NamedTuple):
    """Ways off ends of beads: the numbers (k,) of the ends, heights (k,) mm, directions (k, 3), turns (k,) rad, and what is
    added to the tool axes at the far end (k, 3)."""

    end: Index
    height: Array
    direction: Array
    turn: Array
    lean: Array

    def of(self, rows: Index) -> Ways:
        """Return the retracts of the rows."""
        return Ways(*(column[rows] for column in self))  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Leg:
    """A way off a bead that the machine can go.

    joints: (m, axes) at the ends of its moves, outwards, counted on from the bead. position: (m, 3) mm, the tip there.
    height: mm. choice: how it differs from the way asked for.
    """

    joints: Array
    position: Array
    height: float
    choice: Choice


@dataclass(frozen=True)
class Failure:
    """Why the way asked for cannot be gone: LIMIT, UNREACHABLE or SINGULAR, the index of the limit among the labels of the
    limits, the value there and the bound, rad or mm, or the condition and the least allowed."""

    kind: str
    label: int = 0
    value: float = 0.0
    bound: float = 0.0


@dataclass(frozen=True, eq=False)
class Ends:
    """The first (even) and last (odd) points of all beads, n = twice their number: rows of points, directions, rotations
    (n,) rad and joints (n, axes)."""

    point: Array
    tool: Array
    build: Array
    phi: Array
    joints: Array

    @classmethod
    def of(cls, beads: Sequence[BeadPath]) -> Ends:
        """The ends of the beads of a joint path."""
        both_ends = [0, -1]
        return cls(
            np.concatenate([path.bead.points[both_ends] for path in beads]),
            np.concatenate([path.bead.tool[both_ends] for path in beads]),
            np.concatenate([path.bead.build[both_ends] for path in beads]),
            np.concatenate([path.phi[both_ends] for path in beads]),
            np.concatenate([path.joints[both_ends] for path in beads]),
        )
