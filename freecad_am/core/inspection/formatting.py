# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small rigid motions in words."""

from __future__ import annotations

import numpy as np

from ..geometry.formatting import place
from ..types import Array

NO_TURN = 1e-6  # rad per mm of shift: no turn


def motion_text(turn: Array, shift: Array, middle: Array) -> str:
    """A motion by its turn (3,) rad and the shift (3,) mm of the point `middle` (3,): a turn about an axis, or a shift."""
    angle, distance = float(np.linalg.norm(turn)), float(np.linalg.norm(shift))
    if angle <= NO_TURN * distance:
        return f"a shift along {place(_upward(shift / distance))}"
    axis = turn / angle
    return f"a turn about the axis through {place(middle + np.cross(axis, shift) / angle)} along {place(_upward(axis))}"


def _upward(direction: Array) -> Array:
    """The direction or its opposite, so that its largest part is positive."""
    return np.asarray(direction * np.sign(direction[np.argmax(np.abs(direction))]))
