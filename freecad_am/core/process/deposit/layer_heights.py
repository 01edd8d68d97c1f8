# SPDX-License-Identifier: LGPL-2.1-or-later
"""Heights of filled non-planar layers over each other.

The nearest bead below gives the spacing within a layer, so the height is taken along the build direction of that bead.
"""

from __future__ import annotations

from itertools import chain

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots, lengths
from ...geometry.step_count import step_counts
from ...toolpath import Layer, Toolpath
from ...types import Array

STEP = 0.5  # of a layer height, between two places on the beads below that are asked


def over_layers(toolpath: Toolpath) -> tuple[Array, ...]:
    """Per layer, (n,) mm: the height of each point over the nearest position on the beads of the layer before.

    Measured along the build direction there. Layers with nothing of their feature below, and beads that close gaps, are left out.
    """
    if toolpath.features:
        return tuple(
            chain.from_iterable(
                over_layers(feature) for feature, _ in toolpath.parts if feature.layers
            )
        )
    toolpath = toolpath.deposited
    heights = []
    for below, layer in zip(toolpath.layers, toolpath.layers[1:], strict=False):
        points = [bead.points for bead in layer.beads if not bead.closing]
        if layer.first or not points:
            continue
        positions, build = _sample_chords(below, STEP * toolpath.layer_height)
        above = np.concatenate(points)
        nearest = cKDTree(positions).query(above)[1]
        heights.append(dots(above - positions[nearest], build[nearest]))
    return tuple(heights)


def _sample_chords(layer: Layer, step: float) -> tuple[Array, Array]:
    """Positions (k, 3) on the chords of every bead of a layer, at most a step, mm, apart, and build directions there."""
    positions: list[Array] = []
    directions: list[Array] = []
    for bead in layer.beads:
        count = step_counts(lengths(np.diff(bead.points, axis=0)), step)
        segment = np.repeat(np.arange(len(count)), count)
        share = (
            (np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)) / count[segment]
        )[:, None]
        for column, rows in ((positions, bead.points), (directions, bead.build)):
            column += [rows[segment] + share * (rows[segment + 1] - rows[segment]), rows[-1:]]
    build = np.concatenate(directions)
    return np.concatenate(positions), build / np.maximum(lengths(build), 1e-12)[:, None]
