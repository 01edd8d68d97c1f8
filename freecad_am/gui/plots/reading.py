# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts and colours of charts in the window: at the pointer, and in frames."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...plots.chart import DARK, DOTS, LIGHT, OUTLINE, STEP, Chart, Curve, Look, Words
from .. import colours
from ..in_language import tr


def text_at(chart: Chart, x: float) -> str:
    """Return x and the values at x: of the nearest point of a curve, or of the segment of a step
    curve.
    """
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
    """Return the index of a curve's point for x."""
    index = min(int(np.searchsorted(curve.x, x)), len(curve.x) - 1)
    if curve.kind == STEP or index == 0:
        return index
    return index if curve.x[index] - x < x - curve.x[index - 1] else index - 1


def frame_words() -> Words:
    """Return the texts of frames."""
    return Words(
        layer=tr("layer {}"),
        beyond=tr("{}: {} points beyond the limit"),
        limits=tr("limits {} to {} {}"),
        limit=tr("limits up to {} {}"),
    )


def look_of() -> Look:
    """Return the look of plots in the current theme and language of the window."""
    return replace(DARK if colours.is_dark() else LIGHT, words=frame_words())
