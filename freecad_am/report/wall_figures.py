# SPDX-License-Identifier: LGPL-2.1-or-later
"""The charts of walls on an existing part: local distance, step and paths of every spacing (Chalvin 2019, fig. 6 to 10)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..core.issues import Text
from ..core.strategies.walls.comparison import METHODS, NORMAL, Compared
from ..core.toolpath import Toolpath
from ..core.types import Array
from ..plots.chart import OUTLINE, Chart, Curve, Quantity, shade

TITLES = {
    "iso-parameter": "Iso-parameter",
    NORMAL: "Normal to the centreline",
    "constant-distance": "Constant distance",
    "smooth": "Smooth",
}
MAX_LAYERS = 24  # curves of a chart
MAX_PATH_LAYERS, MAX_PATH_POINTS = 40, 12_000  # of a method in the chart of both paths
AROUND = Quantity("v around the wall", "deg")
ALONG = Quantity("length of the bead", "%")
DISTANCE = Quantity("local distance", "mm")
METHOD_COLOURS = {"iso-parameter": 1, "constant-distance": 0}
# the view of both paths: obliquely from above
AZIMUTH, ELEVATION = math.radians(-62.0), math.radians(24.0)
ACROSS = np.array([-math.sin(AZIMUTH), math.cos(AZIMUTH), 0.0])
TO_EYE = np.array(
    [
        math.cos(AZIMUTH) * math.cos(ELEVATION),
        math.sin(AZIMUTH) * math.cos(ELEVATION),
        math.sin(ELEVATION),
    ]
)
PEN_UP = np.full((1, 3), np.nan)


def distance_charts(compared: Sequence[Compared], layer_height: float) -> list[Chart]:
    """Return the local distance around the wall, a chart per method (figures 6 and 8).

    Parameters
    ----------
    compared : sequence of Compared
        The wall cut by each method.
    layer_height : float
        Asked for, mm.

    Returns
    -------
    list of Chart
        All on one scale; each curve is a layer.
    """
    low = min(wall.smallest for wall in compared)
    high = max(wall.largest for wall in compared)
    margin = 0.08 * max(high - low, 0.01 * layer_height)
    return [
        Chart(
            Text("{}: {:.4g} to {:.4g} mm", TITLES[wall.method], wall.smallest, wall.largest),
            AROUND,
            DISTANCE,
            _layer_curves([360.0 * around for around in wall.around], wall.distance),
            marks=((layer_height, Text("asked: {:g} mm", layer_height)),),
            span=(low - margin, high + margin),
        )
        for wall in compared
    ]


def step_chart(wall: Compared, layer_height: float) -> Chart:
    """Return the step from the layer below along the lines up the wall, in % of the layer height
    (figure 9)."""
    steps = [100.0 * step / layer_height for step in wall.step]
    values = np.concatenate(steps)
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = max(0.08 * (high - low), 1.0)
    return Chart(
        f"\u0394 up the lines v = const: {low:.0f} to {high:.0f} %",
        AROUND,
        Quantity("share of the layer height", "%"),
        _layer_curves([360.0 * around for around in wall.around], steps),
        span=(low - margin, high + margin),
    )


def deposit_chart(toolpath: Toolpath, local: Sequence[Array]) -> Chart:
    """Return the local distance along each layer, at the points that are deposited."""
    height = toolpath.layer_height
    layers, positions = [], []
    for layer, _, bead in toolpath:
        arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        layers.append(layer)
        positions.append(100.0 * arc / max(arc[-1], 1e-9))
    values = np.concatenate([*local, [height]])
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = max(0.1 * (high - low), 0.002 * height)
    return Chart(
        "As deposited, along each bead",
        ALONG,
        DISTANCE,
        _layer_curves(positions, local, layers),
        marks=((height, Text("asked: {:g} mm", height)),),
        span=(low - margin, high + margin),
    )


def path_charts(compared: Sequence[Compared]) -> list[Chart]:
    """Return the layers of iso-parameter and constant distance in one chart (figure 10); empty
    without both methods."""
    by_method = {wall.method: wall for wall in compared}
    if not {METHODS[0], METHODS[2]} <= set(by_method):
        return []
    to_picture = np.column_stack((ACROSS, np.cross(TO_EYE, ACROSS)))
    curves = []
    for method, colour in METHOD_COLOURS.items():
        layers = by_method[method].curves
        shown = [layers[number] for number in _spread(len(layers), MAX_PATH_LAYERS)]
        stride = max(1, sum(map(len, shown)) // MAX_PATH_POINTS)
        points = np.vstack([line for layer in shown for line in (layer[::stride], PEN_UP)])
        name = f"{method}: {by_method[method].layers} layers"
        curves.append(Curve(name, *(points @ to_picture).T, colour, OUTLINE))
    axes = Quantity("across", "mm"), Quantity("up in the picture", "mm")
    return [Chart("Both paths", *axes, tuple(curves), plane=True)]


def _layer_curves(
    x: Sequence[Array], y: Sequence[Array], layers: Sequence[int] | None = None
) -> tuple[Curve, ...]:
    """Return a curve for some layers, those with the least and the largest value among them."""
    numbers = list(range(1, len(y) + 1)) if layers is None else list(layers)
    highest = max(1, max(numbers))
    indices = set(_spread(len(y), MAX_LAYERS))
    indices.add(int(np.argmax([np.nanmax(values, initial=-np.inf) for values in y])))
    indices.add(int(np.argmin([np.nanmin(values, initial=np.inf) for values in y])))
    return tuple(
        Curve("", x[index], y[index], shade(0.92 * numbers[index] / highest), OUTLINE)
        for index in sorted(indices)
        if np.isfinite(y[index]).any()
    )


def _spread(count: int, limit: int) -> list[int]:
    """Return at most `limit` of the numbers below `count`, evenly spread."""
    return sorted(set(np.linspace(0, count - 1, min(count, limit)).round().astype(int).tolist()))
