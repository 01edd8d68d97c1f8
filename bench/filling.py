# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel curves of a region of 2,000 points, as arrays, against the bare library doing the same."""

from __future__ import annotations

from statistics import median
from time import process_time

import numpy as np

from freecad_am.core.geometry.region import regions, shapely

from rows import Row

POINTS, OFFSETS, ROUNDS, DEEPEST, CHORD_ERROR = 2000, 100, 15, 20.0, 0.02
WITHIN = 1.5  # times the bare library


def run() -> list[Row]:
    """The only comparison of this file."""
    angle = 2.0 * np.pi * np.arange(POINTS) / POINTS
    radius = 100.0 + 10.0 * np.sin(5.0 * angle)
    loop = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    distances = -DEEPEST * np.arange(1, OFFSETS + 1) / OFFSETS
    library = shapely()
    ours, bare = [], []  # CPU time of either in turn, so that what else the machine does counts for neither
    for _ in range(ROUNDS):
        start = process_time()
        region, = regions([loop])
        for distance in distances:
            for part in region.grown(float(distance), CHORD_ERROR):
                part.rings()
        ours.append(process_time() - start)
        start = process_time()
        polygon = library.geometry.Polygon(loop)
        for distance in distances:
            # segments of a quarter turn as the chord error asks for
            quarter = int(np.ceil(np.pi / 4.0 / np.arccos(1.0 - CHORD_ERROR / -distance))) if -distance > CHORD_ERROR else 2
            np.asarray(polygon.buffer(distance, **{library.arcs: max(quarter, 2)}).exterior.coords)
        bare.append(process_time() - start)
    name = f"{OFFSETS} offsets of a region of {POINTS} points, against shapely alone"
    return [Row(name, median(ours), median(bare), "s", 1.0 / WITHIN)]
