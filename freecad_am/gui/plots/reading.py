# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is told of the place of a picture that is pointed at, and the ranges that zooming and moving lead to."""

from __future__ import annotations

import numpy as np

from ...plots.chart import DOTS, OUTLINE, STEP, Chart, Curve
from ..texts.in_language import tr

Range = tuple[float, float]
NARROWEST = 1e-6  # of all there is


def text_at(chart: Chart, x: float) -> str:
    """The place x and the values there: of curves those of the point that is nearest, of steps that of the way."""
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
    after = min(int(np.searchsorted(curve.x, x)), len(curve.x) - 1)
    if curve.kind == STEP or after == 0:
        return after
    return after if curve.x[after] - x < x - curve.x[after - 1] else after - 1


def zoomed(shown: Range, factor: float, share: float, most: Range | None) -> Range:
    """A range 1 / factor as wide, the place at `share` of it staying where it is; no wider than `most`."""
    low, high = shown
    width = (high - low) / factor
    if most is not None:
        width = min(max(width, NARROWEST * (most[1] - most[0])), most[1] - most[0])
    at = low + share * (high - low)
    return moved((at - share * width, at + (1.0 - share) * width), 0.0, most)


def moved(shown: Range, by: float, most: Range | None) -> Range:
    """A range moved, as far as `most` goes."""
    low, high = shown[0] + by, shown[1] + by
    if most is not None:
        back = max(most[0] - low, 0.0) - max(high - most[1], 0.0)
        low, high = low + back, high + back
    return low, high
