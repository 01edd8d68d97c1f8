# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check that the deposit is on the part: sample points, tolerance and issue."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots, lengths
from ...geometry.formatting import place
from ...geometry.step_count import step_counts
from ...issues import ERROR, Issue, Text
from ...toolpath import Layer, Toolpath
from ...types import Array, Index

STEP = 0.5  # layer heights; distance between samples on the beads below


def over_layers(toolpath: Toolpath) -> tuple[Array, ...]:
    """Return the heights of points above the beads of the previous layer, by layer.

    Heights are measured along the local build direction. Layers without a layer of their feature
    below, and beads that close gaps, are left out.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.

    Returns
    -------
    tuple of (n,) array
        Heights, mm.
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
        points = [bead.points for bead in layer.beads if not bead.role.closing]
        if layer.first or not points:
            continue
        positions, build = _sample_chords(below, STEP * toolpath.layer_height)
        above = np.concatenate(points)
        nearest = cKDTree(positions).query(above)[1]
        heights.append(dots(above - positions[nearest], build[nearest]))
    return tuple(heights)


def _sample_chords(layer: Layer, step: float) -> tuple[Array, Array]:
    """Sample the chords of all beads of a layer at most `step`, mm, apart.

    Returns positions (k, 3) and build directions (k, 3).
    """
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


CODE = "OFF_PART"
MAX_PLACES = 20_000  # approximate maximum number of checked points, besides three per bead
# mm; allowed deviation of a wall from its faces in addition to the chord error, for tables, fits
# and imported surfaces
ROUNDED = 0.02


class Places(NamedTuple):
    """Points (n, 3), mm, with unit build directions (n, 3), and their layer, bead and point index (n,)."""

    points: Array
    build: Array
    layer: Index
    bead: Index
    point: Index


def sample_places(toolpath: Toolpath) -> Places:
    """Sample both ends and the midpoint of every bead, and evenly as many more points as MAX_PLACES allows."""
    beads = list(toolpath)
    size = np.array([len(bead) for _, _, bead in beads])
    start = np.cumsum(size) - size
    step = max(1, int(np.ceil(size.sum() / MAX_PLACES)))
    sample = np.unique(
        np.concatenate([start, start + size // 2, start + size - 1, np.arange(0, size.sum(), step)])
    )
    bead_row = np.searchsorted(start, sample, side="right") - 1
    points, build = (
        np.concatenate(columns)[sample]
        for columns in zip(*((bead.points, bead.build) for _, _, bead in beads))
    )
    layer, bead = (np.array([entry[k] for entry in beads])[bead_row] for k in (0, 1))
    return Places(points, build, layer, bead, sample - start[bead_row])


def allowed_distance(toolpath: Toolpath, margin: float = 0.0) -> float:
    """Return the allowed distance of points from the part, mm.

    On walls this is the chord error plus ROUNDED. In filled solids, beads in narrow regions or in a margin may exceed
    the part by half their width.
    """
    if not toolpath.traits.is_filled:
        return toolpath.chord_error + ROUNDED
    return 0.5 * (toolpath.bead_width or 0.0) + abs(margin) + toolpath.chord_error


def check_on_part(toolpath: Toolpath, places_: Places, off: Array, limit: float) -> Toolpath:
    """Return the toolpath with the result of the check that its points are on the part.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    places_ : Places
        The checked points.
    off : (n,) array
        Distances of the points from the part, mm; NaN if unknown.
    limit : float
        Allowed distance, mm.

    Returns
    -------
    Toolpath
        The toolpath with count, maximum and allowed distance, and an error if the limit is
        exceeded.
    """
    measured = np.flatnonzero(np.isfinite(off))
    if not len(measured):
        return toolpath
    worst = int(measured[off[measured].argmax()])
    checked = toolpath.add_checks(on_part=(float(len(measured)), float(off[worst]), limit))
    if off[worst] <= limit:
        return checked
    where = tuple(int(column[worst]) for column in (places_.layer, places_.bead, places_.point))
    return replace(
        checked,
        issues=(
            *checked.issues,
            Issue(
                ERROR,
                CODE,
                Text(
                    "{} of {} checked points are off the part, the point at {} by {:.4g} mm, "
                    "with {:.3g} mm allowed, so the toolpath is wrong; choose another strategy "
                    "or other faces, and report the part",
                    int((off[measured] > limit).sum()),
                    len(measured),
                    place(places_.points[worst]),
                    off[worst],
                    limit,
                ),
                *where,
            ),
        ),
    )
