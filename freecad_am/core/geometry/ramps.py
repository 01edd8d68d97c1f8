# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps along a path: what rises and falls no faster than something else lets it, such as squares of speeds."""

import numpy as np

from ..types import Array


def below(ceiling: Array, room: Array) -> Array:
    """The largest values (n,) below a ceiling (n,) that change from one place to the next by no more than `room` (n,) grows
    there: of squares of speeds, with twice the acceleration times the length along the path as room."""
    rising = np.minimum.accumulate(ceiling - room) + room
    falling = np.minimum.accumulate((ceiling + room)[::-1])[::-1] - room
    lower: Array = np.minimum(rising, falling)
    return lower
