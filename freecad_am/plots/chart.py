# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chart data before drawing (curves, bars and limits as arrays in display units), and looks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..core.issues import Text
from ..core.number_texts import SPEEDS
from ..core.process.bead_model import MINUTE, BeadModel
from ..core.process.wire import Measured
from ..core.types import Array, Integers, Mask

LINE, STEP, DOTS, MARKED, OUTLINE = "line", "step", "dots", "marked", "outline"
INF = float("inf")
# fraction of a limit that values must reach for the y range to include the limit
SHOWN_FROM = 0.4
PAD = 0.06


class Quantity(NamedTuple):
    """Quantity and unit of an axis. is_whole: whether the values are integers."""

    name: str
    unit: str = ""
    is_whole: bool = False

    @property
    def label(self) -> str:
        """Return the axis label."""
        return f"{self.name}, {self.unit}" if self.unit else self.name


LAYER_NUMBER = Quantity("layer", is_whole=True)


@dataclass(frozen=True, eq=False)
class Curve:
    """Values y over x, (n,) each. NaN interrupts the line.

    colour: palette index, a colour name of `Look`, or #rrggbb. kind: LINE; STEP, where y belongs to
    the segment from the previous x; DOTS; MARKED, a line with dots; OUTLINE, a plane curve with a
    line width of `width` in units of x if `width` is positive. layer: (n,) int, layer of each value
    if known. x never decreases, except for DOTS and OUTLINE.
    """

    name: str
    x: Array
    y: Array
    colour: int | str = 0
    kind: str = LINE
    layer: Integers | None = None
    width: float = 0.0


@dataclass(frozen=True, eq=False)
class Bars:
    """A histogram: heights (n,) of the bins between edges (n + 1,)."""

    name: str
    edges: Array
    heights: Array


@dataclass(frozen=True, eq=False)
class Chart:
    """One chart frame with its axes.

    limits: minimum and maximum allowed y, infinite without a limit; the area beyond is shaded and
    violating values are marked. band: target range of x. marks: named reference values of y.
    upright: named reference values of x. borders: x of layer starts. layers: their layer numbers.
    span: y range, None to derive it from the values. unlimited: reason for missing limits. plane:
    whether x and y are plane coordinates with equal scales. names: x, y and name of named points.
    """

    title: str
    x: Quantity
    y: Quantity
    curves: tuple[Curve, ...] = ()
    bars: Bars | None = None
    limits: tuple[float, float] = (-INF, INF)
    band: tuple[float, float] | None = None
    marks: tuple[tuple[float, str], ...] = ()
    upright: tuple[tuple[float, str], ...] = ()
    borders: Array | None = None
    layers: Integers | None = None
    span: tuple[float, float] | None = None
    unlimited: str = ""
    plane: bool = False
    names: tuple[tuple[float, float, str], ...] = ()

    def wrong(self, values: Array) -> Mask:
        """Return a mask (n,) of values beyond the limits."""
        low, high = self.limits
        slack = 1e-9 * max(1.0, *(abs(end) for end in self.limits if np.isfinite(end)), 1.0)
        with np.errstate(invalid="ignore"):
            return np.asarray((values < low - slack) | (values > high + slack))

    @property
    def wrong_count(self) -> int:
        """Number of values beyond the limits."""
        return int(sum(self.wrong(curve.y).sum() for curve in self.curves))

    def across(self) -> tuple[float, float]:
        """Return the x range of all contents."""
        if self.bars is not None:
            return float(self.bars.edges[0]), float(self.bars.edges[-1])
        low, high = _ends([curve.x for curve in self.curves], [])
        if any(curve.kind in (DOTS, MARKED, OUTLINE) for curve in self.curves):
            low, high = _padded(low, high)
        return (low, high) if high > low else (low - 0.5, low + 0.5)

    def up(self) -> tuple[float, float]:
        """Return the y range of all contents, without limits that no value approaches."""
        if self.span is not None:
            return self.span
        if self.bars is not None:
            return 0.0, 1.08 * float(self.bars.heights.max(initial=0.0)) or 1.0
        values = [curve.y for curve in self.curves]
        low, high = _ends(values, [value for value, _ in self.marks])
        limits = [
            end
            for end in self.limits
            if np.isfinite(end) and max(abs(low), abs(high)) >= SHOWN_FROM * abs(end)
        ]
        return _padded(*_ends(values, [*(value for value, _ in self.marks), *limits]))


@dataclass(frozen=True)
class Picture:
    """Charts stacked vertically. name: key in PICTURES. lacking: reason why there are no charts."""

    name: str
    title: str
    charts: tuple[Chart, ...]
    lacking: str = ""


def together(title: str, charts: Sequence[Chart]) -> Chart:
    """Combine the curves of several charts in one chart.

    The limits are dropped because they differ. The y label lists all units.
    """
    units = list(dict.fromkeys(chart.y.unit for chart in charts))
    curves = tuple(
        replace(curve, colour=number)
        for number, chart in enumerate(charts)
        for curve in chart.curves
    )
    y = Quantity(charts[0].y.name, " or ".join(units))
    return replace(
        charts[0], title=title, y=y, curves=curves, limits=(-INF, INF), span=None, unlimited=""
    )


def _ends(values: Sequence[Array], extra: Sequence[float]) -> tuple[float, float]:
    finite = [series[np.isfinite(series)] for series in (*values, np.asarray(extra, float))]
    finite = [series for series in finite if len(series)]
    if not finite:
        return 0.0, 1.0
    return float(min(series.min() for series in finite)), float(
        max(series.max() for series in finite)
    )


def _padded(low: float, high: float) -> tuple[float, float]:
    padding = PAD * (high - low)
    if padding <= 1e-9 * max(abs(low), abs(high), 1e-3):  # practically constant values
        padding = 0.05 * max(abs(low), abs(high)) or 0.5
    return low - padding, high + padding


STEPS = 60


def fit(measured: Measured, model: BeadModel, target: float | None = None) -> Chart:
    """Chart measured and fitted bead widths over travel speed, coloured by radius.

    target: requested width, mm, drawn as a horizontal line.
    """
    speed = np.linspace(*model.speeds, STEPS)
    radii = np.unique(measured.radius)
    curves = []
    for number, radius in enumerate(radii.tolist()):
        rows = measured.radius == radius
        widths = model.widths(speed, np.full(STEPS, radius))
        curves.append(Curve(f"r {radius:g} mm", MINUTE * speed, widths, number))
        curves.append(
            Curve(
                Text("r {:g} mm, measured", radius),
                MINUTE * measured.speed[rows],
                measured.width[rows],
                number,
                DOTS,
            )
        )
    marks = () if target is None else ((target, f"requested: {target:g}"),)
    return Chart(
        "Width of beads",
        Quantity("travel speed", "mm/min"),
        Quantity("width", "mm"),
        tuple(curves),
        marks=marks,
    )


Scale = Callable[[float, str], tuple[float, str]]
TRAVEL = (
    "travel",
    "spread",
    "fit",
)  # pictures whose speeds are speeds of the deposition point
JOINTS = ("place", "angle", "speed", "acceleration", "jerk")  # axis quantities


def in_units(picture: Picture, scale: Scale) -> Picture:
    """Convert a picture to other units.

    scale: function of the maximum value and the unit that returns the conversion factor and the
    name of the new unit.
    """
    travel = picture.name in TRAVEL
    return replace(
        picture, charts=tuple(convert_chart(chart, scale, travel) for chart in picture.charts)
    )


def convert_chart(chart: Chart, scale: Scale, travel: bool = False) -> Chart:
    """Convert a chart to other units. travel: whether speeds are deposition point speeds."""
    x = _in_unit(chart.x, chart.across(), travel, scale)
    y = (
        x
        if chart.plane and chart.x.unit == chart.y.unit
        else _in_unit(chart.y, chart.up(), travel, scale)
    )
    across, up = x[0], y[0]
    bars = chart.bars
    return replace(
        chart,
        x=chart.x._replace(unit=x[1]),
        y=chart.y._replace(unit=y[1]),
        curves=tuple(
            replace(
                curve,
                x=across * curve.x,
                y=up * curve.y,
                width=across * curve.width,
            )
            for curve in chart.curves
        ),
        bars=None if bars is None else Bars(bars.name, across * bars.edges, up * bars.heights),
        limits=_scaled(chart.limits, up),
        band=None if chart.band is None else _scaled(chart.band, across),
        marks=tuple((up * value, name) for value, name in chart.marks),
        upright=tuple((across * value, name) for value, name in chart.upright),
        borders=_array(chart.borders, across),
        span=None if chart.span is None else _scaled(chart.span, up),
        names=tuple((across * x, up * y, name) for x, y, name in chart.names),
    )


def _in_unit(
    quantity: Quantity, ends: tuple[float, float], travel: bool, scale: Scale
) -> tuple[float, str]:
    """Return the conversion factor and the new unit of a chart axis."""
    if quantity.unit in SPEEDS and not travel:
        return 1.0, quantity.unit
    if quantity.unit == "mm" and quantity.name in JOINTS:
        return 1.0, quantity.unit
    return scale(max(map(abs, ends)), quantity.unit)


def _scaled(ends: tuple[float, float], factor: float) -> tuple[float, float]:
    return factor * ends[0], factor * ends[1]


def _array(values: Array | None, factor: float) -> Array | None:
    return None if values is None else np.asarray(factor * values)


# ---- Chart colours for light and dark backgrounds and for pages, and colour scales

# colours of axes and other curves, legible on light and dark backgrounds
PALETTE = ("#3b6fd4", "#d9633b", "#2f9e6e", "#9a5bd0", "#c79a1e", "#cf3f74", "#3aa5b8", "#7a7f87")
BAR = PALETTE[0]

# anchors of a perceptually uniform scale from dark blue through green to yellow
_SCALE = np.array(
    [
        (68, 1, 84),
        (72, 40, 120),
        (62, 74, 137),
        (49, 104, 142),
        (38, 130, 142),
        (31, 158, 137),
        (53, 183, 121),
        (109, 205, 89),
        (180, 222, 44),
        (253, 231, 37),
    ],
    dtype=float,
)


@dataclass(frozen=True)
class Words:
    """Format strings of a frame, in addition to the texts of its chart."""

    layer: str = "layer {}"
    beyond: str = "{}: {} points beyond the limit"
    limits: str = "limits {} to {} {}"
    limit: str = "limits up to {} {}"


@dataclass(frozen=True)
class Look:
    """Chart colours as #rrggbb.

    ink: titles. soft: other text. grid: grid lines. bad: limits and violations. good: target bands.
    paper: background, "none" for the page background.
    """

    ink: str
    soft: str
    grid: str
    bad: str
    good: str
    paper: str
    words: Words = Words()

    def colour(self, colour: int | str) -> str:
        """Return a curve colour as #rrggbb."""
        if isinstance(colour, int):
            return PALETTE[colour % len(PALETTE)]
        return colour if colour.startswith("#") else str(getattr(self, colour))


LIGHT = Look("#1d2430", "#667085", "#dfe3ea", "#b8322a", "#1a7f4b", "#ffffff")
DARK = Look("#e6e9ef", "#98a2b3", "#323a47", "#ff7a70", "#4cc38a", "#1a202b")
# placeholder colours, replaced by the page's style variables
PAGE = Look("#010203", "#010204", "#010205", "#010206", "#010207", "none")
VARIABLES = {
    PAGE.ink: "--ink",
    PAGE.soft: "--soft",
    PAGE.grid: "--line",
    PAGE.bad: "--bad",
    PAGE.good: "--good",
}


def shade(share: float) -> str:
    """Return the colour at a fraction (0 to 1) of the colour scale, as #rrggbb."""
    level = min(max(share, 0.0), 1.0) * (len(_SCALE) - 1)
    low = min(int(level), len(_SCALE) - 2)
    red, green, blue = (
        (_SCALE[low] + (level - low) * (_SCALE[low + 1] - _SCALE[low])).round().astype(int)
    )
    return f"#{red:02x}{green:02x}{blue:02x}"
