# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours of the points of a toolpath by what they tell - layer, local distance, tilt, speed, width of the bead, kind of
bead - and how to read them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.process.spacing import local_distances
from ..core.toolpath import Bead, Toolpath
from .colours import ramp
from .lines import Array

Colour = tuple[float, float, float]

LAYER, DISTANCE, TILT, SPEED, WIDTH, KIND = "layer", "local distance", "tilt", "speed", "width", "kind of bead"
KINDS = (LAYER, DISTANCE, TILT, SPEED, WIDTH, KIND)
TOO_NEAR, TOO_FAR, NONE = (0.89, 0.10, 0.16), (0.90, 0.24, 0.84), (0.55, 0.55, 0.57)
CLOSED, OPEN, CLOSING = ("closed, a contour", (0.13, 0.40, 0.80)), ("open, a fill", (0.93, 0.55, 0.10)), (
    "closes a gap", (0.80, 0.20, 0.55))
NO_WIDTH = ("no bead model", NONE)
TICKS = 5
_ALIKE = 1e-9


@dataclass(frozen=True)
class Scale:
    """How to read colours: the ramp goes from low to high; `ticks` are numbers beside it with their texts.

    `below` and `above`: some values are outside. `without`: what has no value, '' when all have one. least, most: of
    all values. `classes`: names with their colours, where there is no ramp.
    """

    title: str
    unit: str
    low: float
    high: float
    ticks: tuple[tuple[float, str], ...]
    least: float
    most: float
    below: bool = False
    above: bool = False
    without: str = ""
    classes: tuple[tuple[str, Colour], ...] = ()

    def share(self, values: Array) -> Array:
        """Places of values on the ramp, 0..1; the middle where low is high."""
        span = self.high - self.low
        return (values - self.low) / span if span > 0.0 else np.full(values.shape, 0.5)


def coloured(toolpath: Toolpath, kind: str, band: float) -> tuple[Array, Scale]:
    """Colours (n, 3) of all points in the order of deposit, and their scale. band: share of the layer height."""
    if kind == DISTANCE:
        return _by_distance(toolpath, band)
    beads = [bead for _, _, bead in toolpath]
    if kind == KIND:
        return _classed(beads, [CLOSING if bead.closing else CLOSED if bead.closed else OPEN for bead in beads], KIND)
    if kind == WIDTH and any(bead.width is None for bead in beads):
        return _classed(beads, [NO_WIDTH] * len(beads), WIDTH)
    if kind == WIDTH:
        values, title, unit = np.concatenate([bead.width for bead in beads]), WIDTH, "mm"
    elif kind == TILT:
        upright = np.concatenate([bead.tool for bead in beads]) @ toolpath.frame[:3, 2]
        values, title, unit = np.degrees(np.arccos(np.clip(upright, -1.0, 1.0))), "tilt", "deg"
    elif kind == SPEED:
        values, title, unit = np.concatenate([bead.speed for bead in beads]), "speed", "mm/s"
    elif len(beads) == 1:
        values, title, unit = np.linspace(0.0, 100.0, len(beads[0])), "way", "%"
    else:
        number = numbered(toolpath)
        values = np.repeat([number[layer] for layer, _, _ in toolpath], [len(bead) for bead in beads]).astype(float)
        title, unit = "layer", ""
    scale = automatic(values, title, unit)
    return ramp(scale.share(values)), scale


def numbered(toolpath: Toolpath) -> list[int]:
    """The number of each layer, counted from what it stands on: anew where another solid is begun."""
    found: list[int] = []
    for layer in toolpath.layers:
        found.append(0 if layer.first or not found else found[-1] + 1)
    return found


def _classed(beads: list[Bead], classes: list[tuple[str, Colour]], title: str) -> tuple[Array, Scale]:
    """Each bead in the colour of its class."""
    colours = np.repeat(np.array([colour for _, colour in classes]), [len(bead) for bead in beads], axis=0)
    present = tuple(one for one in (CLOSED, OPEN, CLOSING, NO_WIDTH) if one in classes)
    return colours, Scale(title, "", 0.0, 0.0, (), 0.0, 0.0, classes=present)


def automatic(values: Array, title: str, unit: str) -> Scale:
    """A scale from the least to the most value, with round numbers beside it."""
    low, high = float(values.min()), float(values.max())
    if high - low <= _ALIKE * max(1.0, abs(high)):
        return Scale(title, unit, low, low, ((low, f"{low:.4g}"),), low, high)
    return Scale(title, unit, low, high, _texts(round_numbers(low, high, least=1.0 if title == LAYER else 0.0)), low, high)


def _by_distance(toolpath: Toolpath, band: float) -> tuple[Array, Scale]:
    values = np.concatenate(local_distances(toolpath))
    known = np.isfinite(values)
    height, title = toolpath.layer_height, "local distance"
    if not known.any():
        scale = Scale(title, "mm", height, height, ((height, f"{height:.4g}"),), height, height, without="first layer")
        return np.tile(np.array(NONE), (len(values), 1)), scale
    low, high = height * (1.0 - band), height * (1.0 + band)
    found = values[known]
    within = 1e-9 * height  # of rounding
    below, above = known & (values < low - within), known & (values > high + within)
    scale = Scale(
        title, "mm", low, high, _texts(np.linspace(low, high, TICKS if high > low else 1)), float(found.min()),
        float(found.max()), bool(below.any()), bool(above.any()), "" if known.all() else "first layer",
    )
    colours = ramp(scale.share(np.where(known, values, height)))
    for chosen, colour in ((below, TOO_NEAR), (above, TOO_FAR), (~known, NONE)):
        colours[chosen] = colour
    return colours, scale


def round_numbers(low: float, high: float, least: float) -> Array:
    """About TICKS round numbers from low to high, apart by one, two or five times a power of ten, `least` or more."""
    apart = (high - low) / TICKS
    power = 10.0 ** np.floor(np.log10(apart))
    step = max(least, next(power * nice for nice in (1.0, 2.0, 5.0, 10.0) if power * nice >= apart * (1.0 - _ALIKE)))
    numbers = np.arange(np.ceil(low / step - _ALIKE), np.floor(high / step + _ALIKE) + 1.0)
    found: Array = numbers * step + 0.0  # no minus before zero
    return found


def _texts(ticks: Array) -> tuple[tuple[float, str], ...]:
    """Numbers with as many decimals as tell them apart."""
    step = float(ticks[1] - ticks[0]) if len(ticks) > 1 else 0.0
    decimals = max(0, -int(np.floor(np.log10(step) + _ALIKE))) if step > 0.0 else 3
    while not np.allclose(ticks, np.round(ticks, decimals), rtol=0.0, atol=1e-3 * step + _ALIKE):
        decimals += 1
    return tuple((float(tick), f"{tick:.{decimals}f}") for tick in ticks)
