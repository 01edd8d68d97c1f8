# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers fitted to a scan in the report: figures, and the first layer before and after."""

from __future__ import annotations

import math
from html import escape
from typing import Any

import numpy as np

from ..core.geometry.fitted import Fitted
from ..core.inspection.bands import band_of, bands, css
from ..core.types import Array
from . import units
from .svg import Plot
from .tables import grid_of


def key_of(tolerance: float) -> str:
    """A coloured square and the range in mm of each band, from the most inside on."""
    return " ".join(
        f'<span style="white-space:nowrap"><span style="color:{css(band.colour)}">&#9632;</span> {escape(band.text)}&ensp;'
        "</span>"
        for band in bands(float(f"{tolerance:.6g}"))
    )


TOLERANCE = 0.1  # mm, of the bands that both pictures are coloured by
MAX_DOTS = 4000  # dots of a picture
DOT = 2.2


def as_dict(fitted: Fitted) -> dict[str, Any]:
    """The key `scan` of a report."""
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
    """The section of the page: both pictures as seen along Z of the feature's frame (4, 4)."""
    factor, unit = units.scale(TOLERANCE, "mm")
    planned = _map(f"Layer {fitted.layer} as planned", fitted.places, fitted.off, frame)
    deposited = _map(f"Layer {fitted.layer} as laid", fitted.laid, fitted.left, frame)
    return (
        f"<h2>Fitted to {escape(fitted.file)}</h2>{grid_of([planned, deposited])}"
        f'<p class="sub">How far the scan lies above the layer, {unit}: {key_of(factor * TOLERANCE)}</p>'
    )


def _map(title: str, points: Array, off: Array, frame: Array) -> str:
    rows = np.unique(np.linspace(0, len(points) - 1, MAX_DOTS).astype(np.intp))
    x, y = ((points[rows] - frame[:3, 3]) @ frame[:3, :2]).T
    plot = Plot(
        f"{title}: {off.min():.3f} to {off.max():.3f} mm",
        (0.0, 1.0),
        (0.0, 1.0),
        "mm",
        "mm",
        height=300,
    )
    wide, high = plot.width - plot.left - plot.right, plot.height - plot.top - plot.bottom
    scale = 1.08 * max(float(np.ptp(x)) / wide, float(np.ptp(y)) / high, 1e-6)
    plot.x, plot.y = (
        (
            0.5 * (float(values.min()) + float(values.max())) - 0.5 * scale * size,
            0.5 * (float(values.min()) + float(values.max())) + 0.5 * scale * size,
        )
        for values, size in ((x, wide), (y, high))
    )
    shades, number = [css(band.colour) for band in bands(TOLERANCE)], band_of(off[rows], TOLERANCE)
    plot.elements += [
        f'<circle cx="{px:.1f}" cy="{py:.1f}" r="{DOT}" fill="{shades[k]}"/>'
        for px, py, k in zip(
            plot.to_x(x).tolist(), plot.to_y(y).tolist(), number.tolist(), strict=True
        )
    ]
    return plot.text()
