# SPDX-License-Identifier: LGPL-2.1-or-later
"""The judge of `bench infill`: how well the strokes of a layer fill its section, measured on a raster."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from freecad_am.core.geometry.regions.raster import Raster, Stroke

PIXELS_ACROSS = 40  # of a nominal bead


class Verdict(NamedTuple):
    """Shares of the area of a section.

    void: without deposit, where the narrowest bead could reach. over: deposit beyond the covered area. outside: covered area
    outside of the section.
    """

    void: float
    over: float
    outside: float


def judge(
    section: np.ndarray, strokes: Sequence[Stroke], width: float, narrowest: float = 0.0
) -> Verdict:
    """Judge the strokes of a layer.

    Parameters
    ----------
    section
        (k, 2, 2) mm, edges of the section's border from start to end, in any order, with the material on the same side of all.
    strokes
        Deposit of the layer; may be empty.
    width
        mm of a nominal bead, for the size of pixels.
    narrowest
        mm, the narrowest bead: void only counts where the section is that wide.
    """
    strokes = [stroke.drop_repeats() for stroke in strokes]
    strokes = [stroke for stroke in strokes if len(stroke.widths)]
    points = np.vstack([section.reshape(-1, 2), *(stroke.points for stroke in strokes)])
    reach = max((float(stroke.widths.max()) for stroke in strokes), default=0.0)
    raster = Raster.around(points, reach, width / PIXELS_ACROSS)
    inside = raster.inside(section)
    covered = raster.counts(strokes)[0] > 0
    area = np.count_nonzero(inside)
    if not area:
        raise ValueError("the section has no area")
    reachable = opened(inside, 0.5 * narrowest / raster.pixel)
    deposit = sum(stroke.area for stroke in strokes)
    excess = deposit / raster.pixel**2 - np.count_nonzero(covered)
    return Verdict(
        np.count_nonzero(reachable & ~covered) / area,
        max(excess, 0.0) / area,
        np.count_nonzero(covered & ~inside) / area,
    )


def opened(mask: np.ndarray, radius: float) -> np.ndarray:
    """The part of a mask that discs of a radius, pixels, reach without leaving it."""
    return mask & grown(~grown(~mask, radius), radius)


def grown(mask: np.ndarray, radius: float) -> np.ndarray:
    """A mask with all pixels within a radius, pixels, of its own."""
    result, wide = mask.copy(), mask.copy()
    rows = np.arange(-math.floor(radius), math.floor(radius) + 1)
    half_widths = np.floor(np.sqrt(radius**2 - rows**2)).astype(int)
    for half_width in range(half_widths.max() + 1):
        if half_width > 0:
            narrower = wide.copy()
            wide[:, 1:] |= narrower[:, :-1]
            wide[:, :-1] |= narrower[:, 1:]
        for row in rows[half_widths == half_width]:
            count = len(mask) - abs(row)
            result[max(row, 0) :][:count] |= wide[max(-row, 0) :][:count]
    return result
