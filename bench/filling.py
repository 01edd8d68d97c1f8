# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel curves of a region of 2,000 points, as arrays, against the bare library doing the same."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from freecad_am.core.geometry.region import regions, shapely

from rows import Row

POINTS, OFFSETS, ROUNDS, DEEPEST, CHORD_ERROR = 2000, 100, 5, 20.0, 0.02
WITHIN = 1.5  # times the bare library


def run() -> list[Row]:
    """The only comparison of this file."""
    angle = 2.0 * np.pi * np.arange(POINTS) / POINTS
    radius = 100.0 + 10.0 * np.sin(5.0 * angle)
    loop = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    distances = -DEEPEST * np.arange(1, OFFSETS + 1) / OFFSETS
    library = shapely()
    ours, bare = [], []
    for _ in range(ROUNDS):
        start = perf_counter()
        region, = regions([loop])
        for distance in distances:
            for part in region.grown(float(distance), CHORD_ERROR):
                part.rings()
        ours.append(perf_counter() - start)
        start = perf_counter()
        polygon = library.geometry.Polygon(loop)
        for distance in distances:
            # segments of a quarter turn as the chord error asks for
            quarter = int(np.ceil(np.pi / 4.0 / np.arccos(1.0 - CHORD_ERROR / -distance))) if -distance > CHORD_ERROR else 2
            np.asarray(polygon.buffer(distance, **{library.arcs: max(quarter, 2)}).exterior.coords)
        bare.append(perf_counter() - start)
    name = f"{OFFSETS} offsets of a region of {POINTS} points, against shapely alone"
    return [Row(name, float(np.median(ours)), float(np.median(bare)), "s", 1.0 / WITHIN)]
