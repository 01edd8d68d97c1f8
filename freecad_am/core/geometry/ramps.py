# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps along a path: what rises and falls no faster than something else lets it, such as squares of speeds."""

import numpy as np

from ..types import Array


def below(ceiling: Array, growth: Array) -> Array:
    """The largest values (n,) below a ceiling (n,) that change from one place to the next by no more than `growth` (n,) does
    there: of squares of speeds, with twice the acceleration times the length along the path."""
    rising = np.minimum.accumulate(ceiling - growth) + growth
    falling = np.minimum.accumulate((ceiling + growth)[::-1])[::-1] - growth
    lower: Array = np.minimum(rising, falling)
    return lower
