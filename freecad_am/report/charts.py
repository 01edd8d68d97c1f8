# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report charts: unrolled layers of solids on a hub, and layer distances of walls on a part."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..core.geometry.curves.guide import Guide
from ..core.geometry.developable import Plane
from ..core.geometry.on_hub import Group, SolidsOnHub, middle_azimuth
from ..core.issues import Text
from ..core.layers.guide_field import between
from ..core.process.bead_model import MINUTE
from ..core.strategies.walls.comparison import METHODS, NORMAL, Compared
from ..core.toolpath import Layer, Toolpath
from ..core.types import Array
from ..plots.chart import OUTLINE, Chart, Curve, Quantity, shade
from .pictures import TALLEST

TITLES = {
    "iso-parameter": "Iso-parameter",
    NORMAL: "Normal to the centreline",
    "constant-distance": "Constant distance",
    "smooth": "Smooth",
}
MAX_LAYERS = 24  # maximum number of curves in a chart
MAX_PATH_LAYERS, MAX_PATH_POINTS = 40, 12_000  # maximum per method in the chart of both paths
ANGLE_AROUND_WALL = Quantity("v around the wall", "deg")
ALONG = Quantity("length of the bead", "%")
DISTANCE = Quantity("local distance", "mm")
METHOD_COLOURS = {"iso-parameter": 1, "constant-distance": 0}
# viewing direction of the chart of both paths
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
    """Chart the local layer distance around the wall, one chart per method (figures 6 and 8).

    Parameters
    ----------
    compared : sequence of Compared
        The wall sliced by each method.
    layer_height : float
        Requested layer height, mm.

    Returns
    -------
    list of Chart
        Charts with equal scales; each curve is a layer.
    """
    low = min(wall.smallest for wall in compared)
    high = max(wall.largest for wall in compared)
    margin = 0.08 * max(high - low, 0.01 * layer_height)
    return [
        Chart(
            Text("{}: {:.4g} to {:.4g} mm", TITLES[wall.method], wall.smallest, wall.largest),
            ANGLE_AROUND_WALL,
            DISTANCE,
            _layer_curves([360.0 * around for around in wall.around], wall.distance),
            marks=((layer_height, Text("requested: {:g} mm", layer_height)),),
            span=(low - margin, high + margin),
        )
        for wall in compared
    ]


def step_chart(wall: Compared, layer_height: float) -> Chart:
    """Chart the step from the layer below along the lines v = const (figure 9).

    Steps are in % of the layer height.
    """
    steps = [100.0 * step / layer_height for step in wall.step]
    values = np.concatenate(steps)
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = max(0.08 * (high - low), 1.0)
    return Chart(
        f"\u0394 up the lines v = const: {low:.0f} to {high:.0f} %",
        ANGLE_AROUND_WALL,
        Quantity("share of the layer height", "%"),
        _layer_curves([360.0 * around for around in wall.around], steps),
        span=(low - margin, high + margin),
    )


def deposit_chart(toolpath: Toolpath, local: Sequence[Array]) -> Chart:
    """Chart the local layer distance along each layer, at the deposited points."""
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
        marks=((height, Text("requested: {:g} mm", height)),),
        span=(low - margin, high + margin),
    )


def path_charts(compared: Sequence[Compared]) -> list[Chart]:
    """Chart the layers of the iso-parameter and constant-distance methods together (figure 10).

    Empty unless both methods were compared.
    """
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
    axes = Quantity("across", "mm"), Quantity("upwards in the view", "mm")
    return [Chart("Both paths", *axes, tuple(curves), plane=True)]


def _layer_curves(
    x: Sequence[Array], y: Sequence[Array], layers: Sequence[int] | None = None
) -> tuple[Curve, ...]:
    """Return curves of at most about MAX_LAYERS layers, including those with extreme values."""
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
    """Return at most `limit` evenly spaced indices below `count`."""
    return sorted(set(np.linspace(0, count - 1, min(count, limit)).round().astype(int).tolist()))


FRAME_WIDTH, MARGINS = 380.0, 61.0  # px; frame width, and sum of the margins above and below
AXES = (
    (Quantity("around the hub", "mm"), Quantity("along it", "mm")),
    (Quantity("x", "mm"), Quantity("y", "mm")),
)
LEVELS = 6  # number of speed levels, each with a colour
PEN_UP_FLAT = np.full((1, 2), np.nan)


def layer_charts(solids: SolidsOnHub, toolpath: Toolpath) -> list[tuple[Chart, int]]:
    """Chart the first and the middle layer of each group, unrolled, with chart heights.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids and their groups.
    toolpath : Toolpath
        Toolpath of the solids; a layer that is too narrow for a bead has no chart.

    Returns
    -------
    list of (Chart, int)
        Charts with lines coloured by speed if a bead model sets the speed, else by order; chart
        heights in pixels.
    """
    charts = []
    runs = _runs(toolpath.layers)
    by_group = np.array_split(np.arange(len(runs)), len(solids.groups))
    if len(runs) != len(solids.groups):  # solids printed one by one: use the first of each group
        counts = np.cumsum([0, *(len(group.bodies) for group in solids.groups)])
        by_group = [np.array([start]) for start in counts[:-1] if start < len(runs)]
    for group, indices in zip(solids.groups, by_group):
        run = runs[int(indices[0])]
        numbers = dict.fromkeys((0, len(run) // 2))
        charts += [
            _flat(group, toolpath.layers[run[number]], number, toolpath.layer_height)
            for number in numbers
            if toolpath.layers[run[number]].beads
        ]
    return charts


def _runs(layers: Sequence[Layer]) -> list[range]:
    """Return the layer index ranges of the stacks, each from hub to tip."""
    starts = [index for index, layer in enumerate(layers) if layer.first]
    return [range(start, end) for start, end in zip(starts, [*starts[1:], len(layers)])]


def _flat(group: Group, layer: Layer, index: int, height: float) -> tuple[Chart, int]:
    base, lines = group.base, [group.base.inside(bead.points) for bead in layer.beads]
    if isinstance(base.surface, Guide):
        plane = between(base.surface, index * height, (index + 1) * height, 0.0)
        lines = [plane.unroll(line) for line in lines]
    else:
        surface = base.surface.offset(index * height)
        middle = middle_azimuth(base, np.vstack([bead.points for bead in layer.beads]))
        lines = [surface.unroll(line, middle) for line in lines]
    low, high = np.vstack(lines).min(axis=0), np.vstack(lines).max(axis=0)
    pad = 0.03 * float((high - low).max())
    ratio = float((high[1] - low[1] + 2.0 * pad) / (high[0] - low[0] + 2.0 * pad))
    axes = AXES[isinstance(base.surface, (Plane, Guide))]
    title = f"{group.base.name}, layer {index}, flattened"
    chart = Chart(title, *axes, _curves(layer, lines), plane=True)
    return chart, int(np.clip(MARGINS + ratio * FRAME_WIDTH, 140.0, TALLEST))


def _curves(layer: Layer, lines: Sequence[Array]) -> tuple[Curve, ...]:
    """Return the bead lines of a layer, coloured by speed if the speed varies, else by order."""
    speeds = np.concatenate([bead.speed[1:] for bead in layer.beads])
    slow, fast = float(speeds.min()), float(speeds.max())
    if fast - slow <= 1e-6 * fast:
        last = max(len(lines) - 1, 1)
        return tuple(
            Curve("", *line.T, shade(number / last), OUTLINE) for number, line in enumerate(lines)
        )
    pieces: list[list[Array]] = [[] for _ in range(LEVELS + 1)]
    for bead, line in zip(layer.beads, lines):
        level = np.round(LEVELS * (bead.speed[1:] - slow) / (fast - slow)).astype(int)
        cuts = [0, *(np.flatnonzero(np.diff(level)) + 1).tolist(), len(level)]
        for start, end in zip(cuts, cuts[1:]):
            pieces[level[start]] += [line[start : end + 1], PEN_UP_FLAT]
    names = {
        0: Text("{:.0f} mm/min", MINUTE * slow),
        LEVELS: Text("{:.0f} mm/min", MINUTE * fast),
    }
    return tuple(
        Curve(names.get(number, ""), *np.vstack(piece).T, shade(number / LEVELS), OUTLINE)
        for number, piece in enumerate(pieces)
        if piece
    )
