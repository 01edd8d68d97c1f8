# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation bands and their colours.

Green is within tolerance. Excess goes to red and missing material to blue, symmetrically.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.formatting import round_step
from ..types import Array, Integers, Mask

STEPS = 3  # number of band limits on each side, at multiples of the tolerance
NICE = (1.0, 2.0, 5.0, 10.0)  # round band widths, times powers of ten
IN_BANDS = 0.95  # fraction of deviations within the outermost limit if no tolerance is given
_COLOURS = (
    (0.19, 0.21, 0.58),
    (0.10, 0.45, 0.82),
    (0.35, 0.75, 0.93),
    (0.25, 0.68, 0.30),
    (0.98, 0.83, 0.22),
    (0.96, 0.53, 0.12),
    (0.80, 0.09, 0.13),
)
PAST_EDGES = (0.55, 0.55, 0.57)


@dataclass(frozen=True)
class Band:
    """A deviation band with its legend text and colour (red, green, blue from 0 to 1)."""

    text: str
    colour: tuple[float, float, float]


def bands(tolerance: float) -> tuple[Band, ...]:
    """Return the bands from most negative to most positive deviation."""
    limits = [f"{step * tolerance:g}" for step in range(1, STEPS + 1)]
    inside = [
        f"< -{limits[-1]}",
        *(f"-{limits[k]} … -{limits[k - 1]}" for k in range(STEPS - 1, 0, -1)),
    ]
    outside = [*(f"{limits[k - 1]} … {limits[k]}" for k in range(1, STEPS)), f"> {limits[-1]}"]
    texts = [*inside, f"within ±{limits[0]}", *outside]
    return tuple(Band(text, colour) for text, colour in zip(texts, _COLOURS, strict=True))


def band_of(deviation: Array, tolerance: float) -> Integers:
    """Return the band of each deviation.

    Parameters
    ----------
    deviation : (n,) array
        Deviations, mm.
    tolerance : float
        Width of a band, mm.

    Returns
    -------
    (n,) array of int
        Indices in `bands`.
    """
    step = np.clip(np.ceil(np.abs(deviation) / tolerance - 1e-12) - 1.0, 0.0, STEPS)
    band: Integers = (STEPS + np.sign(deviation) * step).astype(np.int64)
    return band


def css(colour: tuple[float, float, float]) -> str:
    """Format a colour as #rrggbb."""
    return "#" + "".join(f"{round(255 * component):02x}" for component in colour)


def colours(deviation: Array, within: Mask, tolerance: float) -> Array:
    """Return the colour of each deviation.

    Parameters
    ----------
    deviation : (n,) array
        Deviations, mm.
    within : (n,) bool array
        Deviations that count; uncounted deviations are grey.
    tolerance : float
        Width of a band, mm.

    Returns
    -------
    (n, 3) array
        Red, green and blue from 0 to 1.
    """
    colours_ = np.array(_COLOURS)[band_of(deviation, tolerance)]
    colours_[~within] = PAST_EDGES
    return colours_


def step_of(deviation: Array) -> float:
    """Choose a band width if no tolerance is given, so that STEPS bands cover most deviations.

    Parameters
    ----------
    deviation : (n,) array
        Deviations, mm.

    Returns
    -------
    float
        Band width, a round number, mm.
    """
    return round_step(max(float(np.quantile(np.abs(deviation), IN_BANDS)), 1e-3) / STEPS, NICE)
