# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures of walls on an existing part: local distance, step and paths of every spacing (Chalvin 2019, fig. 6 to 10)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.strategies.walls.comparison import METHODS, NORMAL, Compared
from ..core.toolpath import Toolpath
from ..core.types import Array
from ..plots.look import shade
from . import svg, toolpath_picture

TITLES = {
    "iso-parameter": "Iso-parameter",
    NORMAL: "Normal to the centreline",
    "constant-distance": "Constant distance",
    "smooth": "Smooth",
}
_MOST_LAYERS = 24  # curves in one plot
_COLUMNS = 90
_ANGLE_LABEL, _SPAN = "v around the wall, deg", (-180.0, 180.0)
_BEFORE, _AFTER = "#d9633b", "#3b6fd4"


def distance_plots(compared: Sequence[Compared], layer_height: float) -> list[str]:
    """Local distance around the wall, a plot per method, all on one scale; each curve is a layer (figures 6 and 8)."""
    low = min(wall.smallest for wall in compared)
    high = max(one.largest for one in compared)
    pad = 0.08 * max(high - low, 0.01 * layer_height)
    plots = []
    for one in compared:
        plot = svg.Plot(
            f"{TITLES[one.method]}: {one.smallest:.4g} to {one.largest:.4g} mm",
            _SPAN,
            (low - pad, high + pad),
            _ANGLE_LABEL,
            "local distance, mm",
        )
        _layers(plot, [360.0 * around for around in one.around], one.distance)
        plot.rule(layer_height, f"asked: {layer_height:g} mm")
        plots.append(plot.text())
    return plots


def step_plot(wall: Compared, layer_height: float) -> str:
    """Plot the step from the layer below along the lines up the wall, in % of the layer height
    (figure 9)."""
    steps = [100.0 * step / layer_height for step in wall.step]
    low, high = (
        float(f([f(step[np.isfinite(step)]) for step in steps if np.isfinite(step).any()]))
        for f in (min, max)
    )
    pad = max(0.08 * (high - low), 1.0)
    plot = svg.Plot(
        f"\u0394 up the lines v = const: {low:.0f} to {high:.0f} %",
        _SPAN,
        (low - pad, high + pad),
        _ANGLE_LABEL,
        "% of the layer height",
    )
    _layers(plot, [360.0 * around for around in wall.around], steps)
    return plot.text()


def deposit_plot(toolpath: Toolpath, local: Sequence[Array]) -> str:
    """Local distance along each layer, at the points that are deposited."""
    names, positions, values = [layer for layer, _, _ in toolpath], [], []
    for number, (_, _, bead) in enumerate(toolpath):
        run = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        positions.append(100.0 * run / max(run[-1], 1e-9))
        values.append(local[number])
    finite = np.concatenate(
        [distances[np.isfinite(distances)] for distances in values]
        or [np.array([toolpath.layer_height])]
    )
    if not len(finite):
        finite = np.array([toolpath.layer_height])
    pad = max(0.1 * float(np.ptp(finite)), 0.002 * toolpath.layer_height)
    plot = svg.Plot(
        "As deposited, along each bead",
        (0.0, 100.0),
        (float(finite.min()) - pad, float(finite.max()) + pad),
        "% of the length of the bead",
        "local distance, mm",
    )
    _layers(plot, positions, values, names)
    plot.rule(toolpath.layer_height, f"asked: {toolpath.layer_height:g} mm")
    return plot.text()


def both_paths(compared: Sequence[Compared]) -> str:
    """Draw the layers of iso-parameter and constant distance in one picture (figure 10); empty
    without both methods."""
    by_method = {wall.method: wall for wall in compared}
    if not {METHODS[0], METHODS[2]} <= set(by_method):
        return ""
    groups = []
    for method, stroke in (("iso-parameter", _BEFORE), ("constant-distance", _AFTER)):
        curves = by_method[method].curves
        groups.append(
            (
                f"{method}: {by_method[method].layers} layers",
                stroke,
                [curves[i] for i in _some(len(curves), 40)],
            )
        )
    return toolpath_picture.overlaid(groups)


def _layers(
    plot: svg.Plot, x: Sequence[Array], y: Sequence[Array], layer: Sequence[int] | None = None
) -> None:
    numbers = list(range(1, len(y) + 1)) if layer is None else list(layer)
    highest = max(1, max(numbers))
    indices = set(_some(len(y), _MOST_LAYERS))
    indices |= {int(np.argmax([np.nanmax(values, initial=-np.inf) for values in y]))}
    indices |= {int(np.argmin([np.nanmin(values, initial=np.inf) for values in y]))}
    for i in sorted(indices):
        if np.isfinite(y[i]).any():
            plot.curve(
                *svg.thinned(x[i], y[i], _COLUMNS),
                shade(0.92 * numbers[i] / highest),
                f"layer {numbers[i]}",
                1.2,
            )


def _some(count: int, limit: int) -> list[int]:
    return sorted(set(np.linspace(0, count - 1, min(count, limit)).round().astype(int).tolist()))
