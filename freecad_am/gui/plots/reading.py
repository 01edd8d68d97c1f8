# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text for the pointed position of a picture, and ranges after zooming and moving."""

from __future__ import annotations

import numpy as np

from ...plots.chart import DOTS, OUTLINE, STEP, Chart, Curve
from ..texts.in_language import tr

Range = tuple[float, float]
MIN_SHARE = 1e-6  # of the full range


def text_at(chart: Chart, x: float) -> str:
    """Return x and the values at x: of the nearest point of a curve, of the segment of a step
    curve."""
    texts = [f"{chart.x.name} {x:.5g} {chart.x.unit}".rstrip()]
    if chart.bars is not None:
        bin = int(np.searchsorted(chart.bars.edges, x, side="right")) - 1
        if 0 <= bin < len(chart.bars.heights):
            low, high = chart.bars.edges[bin : bin + 2].tolist()
            texts = [f"{chart.x.name} {low:.5g} – {high:.5g} {chart.x.unit}"]
            texts.append(f"{chart.bars.heights[bin]:.4g} {chart.y.unit}")
    curves = [curve for curve in chart.curves if len(curve.x) and curve.kind not in (DOTS, OUTLINE)]
    if curves and curves[0].layer is not None:
        texts.insert(0, tr("layer {}").format(curves[0].layer[_nearest(curves[0], x)]))
    for curve in curves:
        value = float(curve.y[_nearest(curve, x)])
        if np.isfinite(value):
            texts.append(f"{curve.name} {value:.6g} {chart.y.unit}".rstrip())
    return " · ".join(texts)


def _nearest(curve: Curve, x: float) -> int:
    """The value of a curve at x."""
    index = min(int(np.searchsorted(curve.x, x)), len(curve.x) - 1)
    if curve.kind == STEP or index == 0:
        return index
    return index if curve.x[index] - x < x - curve.x[index - 1] else index - 1


def zoomed(limits: Range, factor: float, share: float, full: Range | None) -> Range:
    """Return a range 1 / factor as wide, with the position at `share` fixed; no wider than
    `full`."""
    low, high = limits
    width = (high - low) / factor
    if full is not None:
        width = min(max(width, MIN_SHARE * (full[1] - full[0])), full[1] - full[0])
    centre = low + share * (high - low)
    return shift_range((centre - share * width, centre + (1.0 - share) * width), 0.0, full)


def shift_range(limits: Range, by: float, full: Range | None) -> Range:
    """A range moved, as far as `full` goes."""
    low, high = limits[0] + by, limits[1] + by
    if full is not None:
        back = max(full[0] - low, 0.0) - max(high - full[1], 0.0)
        low, high = low + back, high + back
    return low, high
