# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colour the points of a path by quantity, with scales: layer, local distance, tilt, speed, bead
width, kind of bead, and machine margins of a joint path.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...core.geometry.formatting import round_step
from ...core.process.deposit.spacing import local_distances
from ...core.toolpath import Bead, Toolpath
from ...core.types import Array
from ...objects.fields import preferences
from ...objects.fields.preferences import scale_of
from ..colours import ramp
from ..in_language import marked, translated

Colour = tuple[float, float, float]

# in English, because documents store these choices; the display translates the texts of a scale
LAYER, DISTANCE, TILT = marked("layer"), marked("local distance"), marked("tilt")
SPEED, WIDTH, KIND = marked("speed"), marked("width"), marked("kind of bead")
KINDS = (LAYER, DISTANCE, TILT, SPEED, WIDTH, KIND)
MARGIN, RATIO, CONDITION = marked("joint margin"), marked("joint speed"), marked("condition")
JOINT_KINDS = (MARGIN, RATIO, CONDITION, *KINDS)
UNREACHABLE = (0.90, 0.10, 0.20)
BELOW_COLOUR, ABOVE_COLOUR, NONE = (0.89, 0.10, 0.16), (0.90, 0.24, 0.84), (0.55, 0.55, 0.57)
CLOSED_BEAD, OPEN_BEAD = (
    (marked("contour or closed bead"), (0.13, 0.40, 0.80)),
    (marked("fill or open bead"), (0.93, 0.55, 0.10)),
)
CENTRE, CLOSING = (
    (marked("centre bead"), (0.20, 0.62, 0.35)),
    (marked("closing bead"), (0.80, 0.20, 0.55)),
)
_CLASSES = {
    "contour": CLOSED_BEAD,
    "line": OPEN_BEAD,
    "zigzag": OPEN_BEAD,
    "spiral": OPEN_BEAD,
    "centre": CENTRE,
    "closing": CLOSING,
}
NO_WIDTH = (marked("no bead model"), NONE)
FIRST_LAYER = marked("first layer")
TICKS = 5
_TOLERANCE = 1e-9
_ROUNDED = 1e-9  # fractions that differ by less are equal


@dataclass(frozen=True, eq=False)
class Scale:
    """A colour scale; the ramp goes from low to high, and `ticks` are its numbers with labels.

    below, above: texts for values outside, '' without such values. without: text for points without
    a value, '' if all have one, and its colour. lowest, highest: range of all values. classes:
    names with colours, instead of a ramp. values: (n,) of all points, in the unit, NaN for points
    without a value; None without values to show.
    """

    title: str
    unit: str
    low: float
    high: float
    ticks: tuple[tuple[float, str], ...]
    lowest: float
    highest: float
    below: str = ""
    above: str = ""
    without: str = ""
    without_colour: Colour = NONE
    classes: tuple[tuple[str, Colour], ...] = ()
    values: Array | None = field(default=None, compare=False, repr=False)

    def text_at(self, row: int) -> str:
        """Return the value of a point as text; '' without a value."""
        if self.values is None:
            return ""
        value = float(self.values[row])
        text = f"{value:.3g} {self.unit}" if np.isfinite(value) else translated(self.without)
        return f"{translated(self.title)} {text}".rstrip()

    def share(self, values: Array) -> Array:
        """Return positions of values on the ramp, 0..1; 0.5 if the ramp has no range."""
        span = self.high - self.low
        return (values - self.low) / span if span > 0.0 else np.full(values.shape, 0.5)


def coloured(toolpath: Toolpath, kind: str, band: float) -> tuple[Array, Scale]:
    """Return colours (n, 3) of the points in the order of deposit, and their scale.

    band: fraction of the layer height.
    """
    if kind == DISTANCE:
        return _by_distance(toolpath, band)
    beads = [bead for _, _, bead in toolpath]
    if kind == KIND:
        return _classed(beads, [class_of(bead) for bead in beads], KIND)
    if kind == WIDTH and any(bead.width is None for bead in beads):
        return _classed(beads, [NO_WIDTH] * len(beads), WIDTH)
    if kind == WIDTH:
        values, title = np.concatenate([bead.width for bead in beads]), WIDTH
        factor, unit = scale_of(float(values.max()), "mm")
        values = factor * values
    elif kind == TILT:
        upright = np.concatenate([bead.tool for bead in beads]) @ toolpath.frame[:3, 2]
        values, title, unit = np.degrees(np.arccos(np.clip(upright, -1.0, 1.0))), TILT, "deg"
    elif kind == SPEED:
        speeds = preferences.speed(1.0) * np.concatenate([bead.speed for bead in beads])
        values, title, unit = speeds, SPEED, preferences.speed_unit()
    elif len(beads) == 1:
        values, title, unit = np.linspace(0.0, 100.0, len(beads[0])), marked("way"), "%"
    else:
        number = numbered(toolpath)
        values = np.repeat(
            [number[layer] for layer, _, _ in toolpath], [len(bead) for bead in beads]
        ).astype(float)
        title, unit = LAYER, ""
    scale = automatic(values, title, unit)
    return ramp(scale.share(values)), replace(scale, values=values)


def class_of(bead: Bead) -> tuple[str, Colour]:
    """Return the class of a bead and its colour: its kind in a fill, otherwise open or closed."""
    if bead.role.closing:
        return CLOSING
    return _CLASSES.get(bead.role.kind, CLOSED_BEAD if bead.closed else OPEN_BEAD)


def numbered(toolpath: Toolpath) -> list[int]:
    """Return the number of each layer above its substrate; a new solid restarts the count."""
    numbers: list[int] = []
    for layer in toolpath.layers:
        numbers.append(0 if layer.first or not numbers else numbers[-1] + 1)
    return numbers


def _classed(
    beads: list[Bead], classes: list[tuple[str, Colour]], title: str
) -> tuple[Array, Scale]:
    """Colour each bead by its class."""
    colours = np.repeat(
        np.array([colour for _, colour in classes]), [len(bead) for bead in beads], axis=0
    )
    present = tuple(
        entry for entry in (CLOSED_BEAD, OPEN_BEAD, CENTRE, CLOSING, NO_WIDTH) if entry in classes
    )
    return colours, Scale(title, "", 0.0, 0.0, (), 0.0, 0.0, classes=present)


def automatic(values: Array, title: str, unit: str) -> Scale:
    """Return a scale from the lowest to the highest value, with round numbers."""
    low, high = float(values.min()), float(values.max())
    if high - low <= _TOLERANCE * max(1.0, abs(high)):
        return Scale(title, unit, low, low, ((low, f"{low:.4g}"),), low, high)
    return Scale(
        title,
        unit,
        low,
        high,
        _texts(round_numbers(low, high, min_step=1.0 if title == LAYER else 0.0)),
        low,
        high,
    )


def _by_distance(toolpath: Toolpath, band: float) -> tuple[Array, Scale]:
    factor, unit = scale_of(toolpath.layer_height, "mm")
    values = factor * np.concatenate(local_distances(toolpath))
    finite = np.isfinite(values)
    height, title = factor * toolpath.layer_height, DISTANCE
    if not finite.any():
        scale = Scale(
            title,
            unit,
            height,
            height,
            ((height, f"{height:.4g}"),),
            height,
            height,
            without=FIRST_LAYER,
        )
        return np.tile(np.array(NONE), (len(values), 1)), scale
    low, high = height * (1.0 - band), height * (1.0 + band)
    finite_values = values[finite]
    within = 1e-9 * height  # tolerance for rounding
    below, above = finite & (values < low - within), finite & (values > high + within)
    ticks = _texts(np.linspace(low, high, TICKS if high > low else 1))
    scale = Scale(
        title,
        unit,
        low,
        high,
        ticks,
        float(finite_values.min()),
        float(finite_values.max()),
        f"< {ticks[0][1]}" if below.any() else "",
        f"> {ticks[-1][1]}" if above.any() else "",
        "" if finite.all() else FIRST_LAYER,
        values=values,
    )
    colours = ramp(scale.share(np.where(finite, values, height)))
    for rows, colour in ((below, BELOW_COLOUR), (above, ABOVE_COLOUR), (~finite, NONE)):
        colours[rows] = colour
    return colours, scale


def by_machine(values: Array, kind: str) -> tuple[Array, Scale]:
    """Return colours (n, 3) of a machine quantity (MARGIN, RATIO or CONDITION) and their scale.

    values: (n,) fractions, NaN where the machine does not reach the point. Margins and speeds are
    in percent; violated limits and speeds have separate colours. Without any valid value, the scale
    has no ramp.
    """
    finite = np.isfinite(values)
    without = "" if finite.all() else marked("unreachable")
    unit, factor = ("", 1.0) if kind == CONDITION else ("%", 100.0)
    scaled = factor * values
    below = finite & (values < -_ROUNDED) & (kind == MARGIN)
    above = finite & (values > 1.0 + _ROUNDED) & (kind == RATIO)
    within = finite & ~below & ~above
    beyond, faster = (
        marked("beyond a limit") if below.any() else "",
        marked("above its maximum") if above.any() else "",
    )
    if within.any():
        scale = automatic(scaled[within], kind, unit)
    else:
        only = ((faster, ABOVE_COLOUR), (beyond, BELOW_COLOUR), (without, UNREACHABLE))
        scale = Scale(
            kind, unit, 0.0, 0.0, (), 0.0, 0.0, classes=tuple(entry for entry in only if entry[0])
        )
    scale = replace(
        scale,
        below=beyond,
        above=faster,
        without=without,
        without_colour=UNREACHABLE,
        values=scaled,
    )
    colours = ramp(scale.share(np.where(within, scaled, scale.low)))
    for rows, colour in ((below, BELOW_COLOUR), (above, ABOVE_COLOUR), (~finite, UNREACHABLE)):
        colours[rows] = colour
    return colours, scale


def unknown(count: int, kind: str, why: str) -> tuple[Array, Scale]:
    """Return grey (count, 3), and a scale with the reason."""
    return np.tile(np.array(NONE), (count, 1)), Scale(
        kind, "", 0.0, 0.0, (), 0.0, 0.0, classes=((why, NONE),)
    )


def round_numbers(low: float, high: float, min_step: float) -> Array:
    """Return about TICKS round numbers from low to high.

    The step is one, two or five times a power of ten, and at least `min_step`.
    """
    step = max(min_step, round_step((high - low) / TICKS, (1.0, 2.0, 5.0, 10.0)))
    numbers = np.arange(np.ceil(low / step - _TOLERANCE), np.floor(high / step + _TOLERANCE) + 1.0)
    rounded: Array = numbers * step + 0.0  # avoids -0
    return rounded


def _texts(ticks: Array) -> tuple[tuple[float, str], ...]:
    """Format numbers with enough decimals to distinguish them."""
    step = float(ticks[1] - ticks[0]) if len(ticks) > 1 else 0.0
    decimals = max(0, -int(np.floor(np.log10(step) + _TOLERANCE))) if step > 0.0 else 3
    while not np.allclose(
        ticks, np.round(ticks, decimals), rtol=0.0, atol=1e-3 * step + _TOLERANCE
    ):
        decimals += 1
    return tuple((float(tick), f"{tick:.{decimals}f}") for tick in ticks)
