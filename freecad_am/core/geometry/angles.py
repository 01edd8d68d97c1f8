# SPDX-License-Identifier: LGPL-2.1-or-later
"""Angles in radians, and the whole turn that they may be counted on by."""

import math

import numpy as np

from ..types import Array

TURN = 2.0 * math.pi


def shortest(angles: Array) -> Array:
    """Angles brought within half a turn, rad, as short ways round are."""
    brought: Array = angles - TURN * np.round(angles / TURN)
    return brought
