# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a picture holds before it is drawn: curves, bars and limits as arrays, in the units they are shown in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from freecad_am.core.types import Array, Integers, Mask

LINE, STEP, DOTS, MARKED, OUTLINE = "line", "step", "dots", "marked", "outline"
INF = float("inf")
# limits are in sight where values come as near as this share of them
SHOWN_FROM = 0.4
PAD = 0.06


class Quantity(NamedTuple):
    """What an axis counts, and in what."""

    name: str
    unit: str = ""

    @property
    def label(self) -> str:
        """As it stands along the axis."""
        return f"{self.name}, {self.unit}" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class Curve:
    """Values y over x, (n,) each; NaN lifts the pen.

    colour: a number of the palette, a word of `Look`, or #rrggbb. kind: LINE; STEP, where y is that of the way from the x
    before; DOTS; MARKED, a line with dots; OUTLINE, a curve of the plane, as wide as `width` in the units of x where that is
    more than 0. layer: (n,) int of each value, where it has one. Of all but DOTS and OUTLINE x never falls.
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
    """A histogram: heights (n,) over the ranges between edges (n + 1,)."""

    name: str
    edges: Array
    heights: Array


@dataclass(frozen=True, eq=False)
class Chart:
    """One frame with its scales.

    limits: least and most value allowed, infinite where there is none; what lies beyond is shaded, values there are marked.
    band: a range of x that is as wanted. marks: values of y with a name to compare with; upright: of x. borders: x of the
    starts of layers, and layers, their numbers. span: of y, where it is not as the values ask for. unlimited: why there are
    no limits, where one would look for them. plane: x and y are places in a plane, drawn to the same scale. names: x and y
    of places that have a name.
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
        """Which values (n,) lie beyond the limits."""
        low, high = self.limits
        slack = 1e-9 * max(1.0, *(abs(end) for end in self.limits if np.isfinite(end)), 1.0)
        with np.errstate(invalid="ignore"):
            return np.asarray((values < low - slack) | (values > high + slack))

    @property
    def wrong_count(self) -> int:
        """How many values lie beyond the limits."""
        return int(sum(self.wrong(curve.y).sum() for curve in self.curves))

    def across(self) -> tuple[float, float]:
        """The range of x of all that is in it."""
        if self.bars is not None:
            return float(self.bars.edges[0]), float(self.bars.edges[-1])
        low, high = _ends([curve.x for curve in self.curves], [])
        if any(curve.kind in (DOTS, MARKED, OUTLINE) for curve in self.curves):
            low, high = _padded(low, high)
        return (low, high) if high > low else (low - 0.5, low + 0.5)

    def up(self) -> tuple[float, float]:
        """The range of y of all that is in it; a limit that no value comes near stays out of sight."""
        if self.span is not None:
            return self.span
        if self.bars is not None:
            return 0.0, 1.08 * float(self.bars.heights.max(initial=0.0)) or 1.0
        values = [curve.y for curve in self.curves]
        low, high = _ends(values, [value for value, _ in self.marks])
        near = [
            end
            for end in self.limits
            if np.isfinite(end) and max(abs(low), abs(high)) >= SHOWN_FROM * abs(end)
        ]
        return _padded(*_ends(values, [*(value for value, _ in self.marks), *near]))


@dataclass(frozen=True)
class Picture:
    """Charts one below the other. name: of the picture in a catalogue. lacking: why there is none."""

    name: str
    title: str
    charts: tuple[Chart, ...]
    lacking: str = ""


def together(title: str, charts: Sequence[Chart]) -> Chart:
    """The curves of several charts in one, without limits: those differ. Where units differ both are named."""
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


def _ends(values: Sequence[Array], more: Sequence[float]) -> tuple[float, float]:
    known = [one[np.isfinite(one)] for one in (*values, np.asarray(more, float))]
    known = [one for one in known if len(one)]
    if not known:
        return 0.0, 1.0
    return float(min(one.min() for one in known)), float(max(one.max() for one in known))


def _padded(low: float, high: float) -> tuple[float, float]:
    more = PAD * (high - low)
    if more <= 1e-9 * max(abs(low), abs(high), 1e-3):  # as good as constant
        more = 0.05 * max(abs(low), abs(high)) or 0.5
    return low - more, high + more
