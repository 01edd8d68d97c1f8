# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of solids on a hub: unrolled layers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.geometry.curves.guide import Guide
from ..core.geometry.developable import Plane
from ..core.geometry.on_hub import Group, SolidsOnHub, middle_azimuth
from ..core.issues import Text
from ..core.layers.guide_field import between
from ..core.process.bead_model import MINUTE
from ..core.toolpath import Layer, Toolpath
from ..core.types import Array
from ..plots.chart import OUTLINE, Chart, Curve, Quantity, shade
from .pictures import TALLEST

FRAME_WIDTH, MARGINS = 380.0, 61.0  # px: width of the frame, and of the margins above and below
AXES = (
    (Quantity("around the hub", "mm"), Quantity("along it", "mm")),
    (Quantity("x", "mm"), Quantity("y", "mm")),
)
LEVELS = 6  # of speed, with a colour each
PEN_UP = np.full((1, 2), np.nan)


def layer_charts(solids: SolidsOnHub, toolpath: Toolpath) -> list[tuple[Chart, int]]:
    """Return the first and middle layer of each group unrolled, with the height of each picture.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids and their groups.
    toolpath : Toolpath
        Their toolpath; a layer that is too narrow for a bead has no picture.

    Returns
    -------
    list of (Chart, int)
        Lines coloured by speed if a bead model sets it, else by order; heights in pixels.
    """
    charts = []
    runs = _runs(toolpath.layers)
    by_group = np.array_split(np.arange(len(runs)), len(solids.groups))
    if len(runs) != len(solids.groups):  # solid by solid: the first of each group
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
    """Return the stacks of layers, each from hub to tip."""
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
    title = f"{group.base.name}, layer {index}, laid flat"
    chart = Chart(title, *axes, _curves(layer, lines), plane=True)
    return chart, int(np.clip(MARGINS + ratio * FRAME_WIDTH, 140.0, TALLEST))


def _curves(layer: Layer, lines: Sequence[Array]) -> tuple[Curve, ...]:
    """Return the lines of a layer's beads, coloured by speed where it varies, else by order."""
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
            pieces[level[start]] += [line[start : end + 1], PEN_UP]
    names = {
        0: Text("{:.0f} mm/min", MINUTE * slow),
        LEVELS: Text("{:.0f} mm/min", MINUTE * fast),
    }
    return tuple(
        Curve(names.get(number, ""), *np.vstack(piece).T, shade(number / LEVELS), OUTLINE)
        for number, piece in enumerate(pieces)
        if piece
    )
