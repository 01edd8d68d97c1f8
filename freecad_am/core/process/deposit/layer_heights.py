# SPDX-License-Identifier: LGPL-2.1-or-later
"""How high filled layers that are not planes lie over each other: how far the nearest bead below is tells how beads lie by
each other, so the height is taken along its build direction."""

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
    """Per layer but those that nothing of their feature lies below, (n,) mm: the height of each of its points over the
    nearest place of the beads of the layer before, along the build direction there. Beads that close gaps are left out."""
    if toolpath.features:
        return tuple(
            chain.from_iterable(over_layers(part) for part, _ in toolpath.parts if part.layers)
        )
    toolpath = toolpath.deposited
    found = []
    for below, layer in zip(toolpath.layers, toolpath.layers[1:], strict=False):
        points = [bead.points for bead in layer.beads if not bead.closing]
        if layer.first or not points:
            continue
        place, build = _along(below, STEP * toolpath.layer_height)
        above = np.concatenate(points)
        near = cKDTree(place).query(above)[1]
        found.append(dots(above - place[near], build[near]))
    return tuple(found)


def _along(layer: Layer, step: float) -> tuple[Array, Array]:
    """Places (k, 3) on the chords of all beads of a layer, no farther apart than a step, mm, and build directions there."""
    places: list[Array] = []
    directions: list[Array] = []
    for bead in layer.beads:
        count = step_counts(lengths(np.diff(bead.points, axis=0)), step)
        at = np.repeat(np.arange(len(count)), count)
        share = ((np.arange(len(at)) - np.repeat(np.cumsum(count) - count, count)) / count[at])[
            :, None
        ]
        for column, rows in ((places, bead.points), (directions, bead.build)):
            column += [rows[at] + share * (rows[at + 1] - rows[at]), rows[-1:]]
    build = np.concatenate(directions)
    return np.concatenate(places), build / np.maximum(lengths(build), 1e-12)[:, None]
