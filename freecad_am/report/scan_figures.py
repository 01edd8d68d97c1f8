# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report section on layers fitted to a scan: statistics, and the first layer before and after."""

from __future__ import annotations

import math
from html import escape
from typing import Any

import numpy as np

from ..core.geometry.toolpath_records import Fitted
from ..core.inspection.bands import bands, css
from ..core.issues import Text
from ..core.types import Array
from ..plots.chart import Chart, Quantity
from ..plots.deviation import dots_by_band
from . import units
from .pictures import HALF, MAP, draw_charts
from .tables import grid_of


def key_of(tolerance: float) -> str:
    """Return the colour legend: a square and a range in mm per band, from the innermost band."""
    return " ".join(
        f'<span style="white-space:nowrap"><span style="color:{css(band.colour)}">&#9632;</span> {escape(band.text)}&ensp;'
        "</span>"
        for band in bands(float(f"{tolerance:.6g}"))
    )


TOLERANCE = 0.1  # mm; tolerance that defines the colour bands of both charts
MAX_DOTS = 4000  # maximum number of dots in a chart


def as_dict(fitted: Fitted) -> dict[str, Any]:
    """Return the value of the report key `scan`."""
    return {
        "file": fitted.file,
        "points": fitted.points,
        "left_out": fitted.left_out,
        "layer": fitted.layer,
        "layers": fitted.layers,
        "off_mm": {
            "min": float(fitted.off.min()),
            "mean": float(fitted.off.mean()),
            "max": float(fitted.off.max()),
        },
        "left_mm": float(np.abs(fitted.left).max()),
        "slope_deg": math.degrees(math.atan(fitted.slope)),
        "remains_mm": fitted.remains,
        "motion": fitted.motion.tolist(),
    }


def section(fitted: Fitted, frame: Array) -> str:
    """Return the page section with both charts, viewed along Z of the feature frame (4, 4)."""
    factor, unit = units.scale(TOLERANCE, "mm")
    planned = _map(f"Layer {fitted.layer} as planned", fitted.places, fitted.off, frame)
    deposited = _map(f"Layer {fitted.layer} as deposited", fitted.laid, fitted.left, frame)
    return (
        f"<h2>Fitted to {escape(fitted.file)}</h2>{grid_of(draw_charts([planned, deposited], HALF, MAP))}"
        f'<p class="sub">Height of the scan above the layer, {unit}: {key_of(factor * TOLERANCE)}</p>'
    )


def _map(title: str, points: Array, off: Array, frame: Array) -> Chart:
    rows = np.unique(np.linspace(0, len(points) - 1, MAX_DOTS).astype(np.intp))
    x, y = ((points[rows] - frame[:3, 3]) @ frame[:3, :2]).T
    return Chart(
        Text("{}: {:.3f} to {:.3f} mm", title, off.min(), off.max()),
        Quantity("x", "mm"),
        Quantity("y", "mm"),
        dots_by_band(x, y, off[rows], TOLERANCE),
        plane=True,
    )
