# SPDX-License-Identifier: LGPL-2.1-or-later
"""In what order ways off the end of a bead are tried where the machine cannot go the one asked for."""

from __future__ import annotations

import math
from typing import NamedTuple

_HEIGHTS = (0.75, 0.5, 0.25, 0.1, 1.5, 2.0, 3.0)
DIRECTIONS = tuple(range(1, 10))
_TURNS = tuple(math.radians(sign * turn) for turn in (5, 15, 30, 60, 90, 120, 180, 240, 360) for sign in (1, -1))
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


ASKED = Choice()


def groups(direction: int, thorough: bool) -> tuple[tuple[Choice, ...], ...]:
    """The ways in their order of preference; those of a group are looked at together."""
    if not thorough:
        return (
            (Choice(1.0, direction),), tuple(Choice(1.0, direction, turn) for turn in _TURNS),
            tuple(Choice(1.0, direction, 0.0, lean) for lean in _LEANS),
        )
    others = tuple(k for k in DIRECTIONS if k != direction)
    return (
        (Choice(1.0, direction),),
        tuple(Choice(share, direction) for share in _HEIGHTS),
        tuple(Choice(share, other) for other in others for share in (1.0, *_HEIGHTS)),
        tuple(Choice(share, direction, turn) for share in (1.0, 0.5, 0.1, 2.0) for turn in _TURNS),
        tuple(Choice(share, direction, 0.0, lean) for share in (1.0, 0.5, 0.1, 2.0) for lean in _LEANS),
        tuple(Choice(share, other, turn) for other in others for share in (1.0, 0.25) for turn in _TURNS),
        tuple(Choice(share, direction, turn, lean) for share in (1.0, 0.25) for turn in _TURNS for lean in _LEANS),
    )
