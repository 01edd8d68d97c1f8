# SPDX-License-Identifier: LGPL-2.1-or-later
"""Charts in other units; axes of machines keep the units of their controllers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from freecad_am.core.quantities import SPEEDS
from freecad_am.core.types import Array

from .chart import Bars, Chart, Picture, Quantity

Scale = Callable[[float, str], tuple[float, str]]
TRAVEL = (
    "travel",
    "spread",
    "fit",
)  # pictures by name whose speeds are those of the deposition point
JOINTS = ("place", "angle", "speed", "acceleration", "jerk")  # quantities of axes


def in_units(picture: Picture, scale: Scale) -> Picture:
    """A picture in other units. scale: for values of up to a number, how many of the other unit make one, and its name."""
    travel = picture.name in TRAVEL
    return replace(
        picture, charts=tuple(of_chart(chart, scale, travel) for chart in picture.charts)
    )


def of_chart(chart: Chart, scale: Scale, travel: bool = False) -> Chart:
    """A chart in other units. travel: its speeds are those of the deposition point."""
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
    """The factor and the unit of an axis of a chart."""
    if quantity.unit in SPEEDS and not travel:
        return 1.0, quantity.unit
    if quantity.unit == "mm" and quantity.name in JOINTS:
        return 1.0, quantity.unit
    return scale(max(map(abs, ends)), quantity.unit)


def _scaled(ends: tuple[float, float], factor: float) -> tuple[float, float]:
    return factor * ends[0], factor * ends[1]


def _array(values: Array | None, factor: float) -> Array | None:
    return None if values is None else np.asarray(factor * values)
