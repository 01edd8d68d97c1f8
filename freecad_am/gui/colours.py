# SPDX-License-Identifier: LGPL-2.1-or-later
"""A perceptual colour ramp: lightness rises evenly and the hue runs from blue to yellow, so that order can be seen."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ..objects.fields import preferences

STEPS = 256
WRONG = "#c0182b"  # of text that tells what is wrong

# first hue and how far it turns, deg, and how strong the colours are
_HUES = dict(
    zip(
        preferences.RAMPS, ((275.0, -170.0, 1.0), (305.0, 125.0, 0.9), (0.0, 0.0, 0.0)), strict=True
    )
)

# Oklab (B. Ottosson, 2020): linear sRGB -> LMS, cube root, -> L a b
_LMS = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def ramp(share: Any) -> Array:
    """(n, 3) colours 0..1 of shares (n,) 0..1: dark blue, teal, green, yellow, or as the preferences say."""
    places = np.clip(np.asarray(share, dtype=np.float64), 0.0, 1.0) * (STEPS - 1)
    return _table(preferences.ramp())[np.rint(places).astype(int)]


@cache
def _table(name: str) -> Array:
    share = np.linspace(0.0, 1.0, STEPS)
    lightness = 0.42 + 0.47 * share
    first, turn, strong = _HUES[name]
    hue = np.radians(first + turn * share)
    chroma = strong * (0.17 - 0.02 * np.sin(np.pi * share))
    lab = np.stack([lightness, chroma * np.cos(hue), chroma * np.sin(hue)], axis=-1)
    linear = (lab @ np.linalg.inv(_LAB).T) ** 3 @ np.linalg.inv(_LMS).T
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
