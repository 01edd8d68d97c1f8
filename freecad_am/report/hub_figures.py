# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of solids on a hub: unrolled layers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.geometry.curves.guide import Guide
from ..core.geometry.on_hub import Group, SolidsOnHub, middle_azimuth
from ..core.geometry.plane import Plane
from ..core.layers.guide_field import between
from ..core.process.model.bead_model import MINUTE
from ..core.toolpath import Bead, Layer, Toolpath
from ..core.types import Array
from ..plots.look import shade
from . import svg

FRAME_WIDTH, EDGES = 388.0, 68.0  # px: width of the frame, and of both margins
AXES = (("around the hub, mm", "along it, mm"), ("x, mm", "y, mm"))
PIECES = 6  # colours along a bead


def layer_plots(solids: SolidsOnHub, toolpath: Toolpath) -> list[str]:
    """Draw the first and middle layer of each group unrolled, coloured by speed if a bead model
    sets it, else by order.

    A layer that is too narrow for a bead has no picture.
    """
    plots = []
    runs = _runs(toolpath.layers)
    by_group = np.array_split(np.arange(len(runs)), len(solids.groups))
    if len(runs) != len(solids.groups):  # solid by solid: the first of each group
        counts = np.cumsum([0, *(len(group.bodies) for group in solids.groups)])
        by_group = [np.array([start]) for start in counts[:-1] if start < len(runs)]
    for group, indices in zip(solids.groups, by_group):
        run = runs[int(indices[0])]
        numbers = dict.fromkeys((0, len(run) // 2))
        plots += [
            _flat(group, toolpath.layers[run[number]], number, toolpath.layer_height)
            for number in numbers
            if toolpath.layers[run[number]].beads
        ]
    return plots


def _runs(layers: Sequence[Layer]) -> list[range]:
    """Return the stacks of layers, each from hub to tip."""
    starts = [index for index, layer in enumerate(layers) if layer.first]
    return [range(start, end) for start, end in zip(starts, [*starts[1:], len(layers)])]


def _flat(group: Group, layer: Layer, index: int, height: float) -> str:
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
    plot = svg.Plot(
        f"{group.base.name}, layer {index}, laid flat",
        (low[0] - pad, high[0] + pad),
        (low[1] - pad, high[1] + pad),
        *AXES[isinstance(base.surface, (Plane, Guide))],
        height=int(np.clip(EDGES + ratio * FRAME_WIDTH, 140.0, 620.0)),
    )
    speeds = np.concatenate([bead.speed[1:] for bead in layer.beads])
    slow, fast = float(speeds.min()), float(speeds.max())
    for number, (bead, line) in enumerate(zip(layer.beads, lines)):
        if fast - slow > 1e-6 * fast:
            _coloured(plot, bead, line, slow, fast)
        else:
            plot.curve(
                line[:, 0],
                line[:, 1],
                shade(number / max(len(lines) - 1, 1)),
                f"bead {number}",
                1.2,
            )
    if fast - slow > 1e-6 * fast:
        plot.legend(
            [
                (f"{MINUTE * slow:.0f} mm/min", shade(0.0)),
                (f"{MINUTE * fast:.0f} mm/min", shade(1.0)),
            ]
        )
    return plot.text()


def _coloured(plot: svg.Plot, bead: Bead, line: Array, slow: float, fast: float) -> None:
    """A bead in runs of like speed."""
    level = np.round(PIECES * (bead.speed[1:] - slow) / (fast - slow)).astype(int)
    cuts = [0, *(np.flatnonzero(np.diff(level)) + 1).tolist(), len(level)]
    for start, end in zip(cuts, cuts[1:]):
        stretch = line[start : end + 1]
        plot.curve(stretch[:, 0], stretch[:, 1], shade(level[start] / PIECES), "", 1.4)
