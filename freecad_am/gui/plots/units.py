# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speeds of the deposition point in the unit that the user prefers; those of axes keep the units of the axes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from freecad_am.core.types import Array

from ...objects.fields import preferences
from ...plots.chart import Bars, Chart, Picture, Quantity

TRAVEL = ("travel", "spread")  # pictures by name whose speeds are those of the deposition point


def in_units(picture: Picture) -> Picture:
    """A picture with its speeds in that unit."""
    return (
        replace(picture, charts=tuple(map(_of_chart, picture.charts)))
        if picture.name in TRAVEL
        else picture
    )


def _of_chart(chart: Chart) -> Chart:
    across, up = _factor(chart.x), _factor(chart.y)
    bars = chart.bars
    return replace(
        chart,
        x=_named(chart.x),
        y=_named(chart.y),
        curves=tuple(replace(curve, x=across * curve.x, y=up * curve.y) for curve in chart.curves),
        bars=None if bars is None else Bars(bars.name, across * bars.edges, up * bars.heights),
        limits=_scaled(chart.limits, up),
        band=None if chart.band is None else _scaled(chart.band, across),
        marks=tuple((up * value, name) for value, name in chart.marks),
        upright=tuple((across * value, name) for value, name in chart.upright),
        borders=_array(chart.borders, across),
        span=None if chart.span is None else _scaled(chart.span, up),
    )


def _factor(quantity: Quantity) -> float:
    if quantity.unit not in preferences.SPEED_UNITS:
        return 1.0
    return preferences.speed(1.0) / preferences.SPEED_UNITS[quantity.unit]


def _named(quantity: Quantity) -> Quantity:
    return (
        quantity._replace(unit=preferences.speed_unit())
        if quantity.unit in preferences.SPEED_UNITS
        else quantity
    )


def _scaled(ends: tuple[float, float], factor: float) -> tuple[float, float]:
    return factor * ends[0], factor * ends[1]


def _array(values: Array | None, factor: float) -> Array | None:
    return None if values is None else np.asarray(factor * values)
