# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cells of a map as colours, and how to read them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Mask, NDArray

from ....core.planning.redundancy.map import Picture
from ...colours import ramp
from ...path.colouring import NONE, TOO_FAR, TOO_NEAR, Scale, automatic
from ...texts.translation import marked

MARGIN, CONDITION = marked("joint margin"), marked("condition")
KINDS = (MARGIN, CONDITION)
Pixels = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Painted:
    """Colours (R, C, 3) 0..255 of cells, hatched (R, C) ones, the scale of the ramp, and classes that there are."""

    colours: Pixels
    hatched: Mask
    scale: Scale
    classes: tuple[tuple[str, tuple[float, float, float]], ...]


def painted(of: Picture, kind: str) -> Painted:
    """A picture by margin (percent of half a range) or by condition; what cannot be is in colours of its own."""
    reachable, beyond = of.reachable, of.past_limit
    singular = of.singular & ~beyond
    good = reachable & ~beyond & ~singular
    values = np.where(reachable, 100.0 * of.margin if kind == MARGIN else of.condition, 0.0)
    found = values[good] if good.any() else np.zeros(1)
    scale = automatic(found, kind, "%" if kind == MARGIN else "")
    colours = ramp(scale.share(np.where(good, values, scale.low)).ravel()).reshape(*values.shape, 3)
    classes = []
    for text, cells, colour in (
        (marked("unreachable"), ~reachable, NONE),
        (marked("beyond a limit"), beyond, TOO_NEAR),
        (marked("near a singularity"), singular, TOO_FAR),
    ):
        if cells.any():
            colours[cells] = colour
            classes.append((text, colour))
    return Painted(np.round(255.0 * colours).astype(np.uint8), of.hatched, scale, tuple(classes))


def enlarged(of: Painted, width: int, height: int, low: float, high: float, lines: int) -> Pixels:
    """The picture (height, width, 4) as Qt has it, blue first, from the value `high` at the top to `low`, which may be more
    than a turn apart; hatched by lines that many pixels apart."""
    rows, columns = of.hatched.shape
    value = high - (np.arange(height) + 0.5) / height * (high - low)
    row = np.round((value + np.pi) % (2.0 * np.pi) / (2.0 * np.pi) * (rows - 1)).astype(int)
    column = np.minimum((np.arange(width) + 0.5) / width * columns, columns - 1).astype(int)
    cells = row[:, None], column[None, :]
    pixels = np.full((height, width, 4), 255, dtype=np.uint8)
    pixels[:, :, :3] = of.colours[cells][:, :, ::-1]
    stripe = (np.arange(height)[:, None] + np.arange(width)) % lines < max(2, lines // 5)
    pixels[of.hatched[cells] & stripe, :3] = 20
    return pixels
