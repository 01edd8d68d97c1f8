# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps along a path: what rises and falls no faster than something else lets it, such as squares of speeds."""

import numpy as np

from ..types import Array


def limit_growth(ceiling: Array, growth: Array) -> Array:
    """Return the largest values (n,) below a ceiling (n,) that change between neighbours by no
    more than `growth` (n,).

    For squares of speeds, the growth is twice the acceleration times the length along the
    path.
    """
    rising = np.minimum.accumulate(ceiling - growth) + growth
    falling = np.minimum.accumulate((ceiling + growth)[::-1])[::-1] - growth
    lower: Array = np.minimum(rising, falling)
    return lower
