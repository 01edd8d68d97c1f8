# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is kept of a predicted deposit against the part to draw it: places with their deviations, the worst of them by name,
how the deviations are spread over the area, and over the layers."""

from __future__ import annotations

import numpy as np

from ...geometry.fitted import DeviationMap
from ...geometry.formatting import round_step
from ...types import Array, Index
from .compare import Compared
from .laying import PredictedDeposit

MOST_PLACES = 3000  # that are kept
NAMED = 5  # worst places
APART = 0.1  # of the part's size, between two of these at least
STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)  # widths of a histogram's bars, times powers of ten
BARS = 40  # of a histogram, about


def deviation_map(of: PredictedDeposit, found: Compared, layers: int) -> DeviationMap:
    """What is kept, of a path of so many layers. Of the places every so many-th, and the worst ones first."""
    named = _worst(found.faces.points, found.deviation)
    count = len(found.deviation)
    every = np.arange(0, count, -(-count // MOST_PLACES))
    kept = np.concatenate([named, every[~np.isin(every, named)]])
    pieces, piece = of.pieces, found.piece[named]
    edges, shares = _spread(found.deviation, found.faces.areas)
    return DeviationMap(
        found.faces.points[kept],
        found.faces.normals[kept],
        found.deviation[kept],
        np.column_stack([pieces.layer[piece], of.bead_in_layer[piece], pieces.point[piece]]).astype(
            np.int64
        ),
        edges,
        shares,
        _by_layer(
            found.deviation,
            found.faces.areas,
            np.asarray(pieces.layer[found.piece], dtype=np.intp),
            layers,
        ),
    )


def name_of(number: int) -> str:
    """What the worst place of this number is called."""
    return "ABCDEFGHIJ"[number]


def _worst(points: Array, deviation: Array) -> Index:
    """Rows of the places with the least, each away from those before."""
    apart = APART * float(np.linalg.norm(np.ptp(points, axis=0)))
    left: Index = np.argsort(deviation, kind="stable")
    rows: list[int] = []
    while len(left) and len(rows) < NAMED:
        rows.append(int(left[0]))
        left = left[np.linalg.norm(points[left] - points[left[0]], axis=1) > apart]
    return np.array(rows, dtype=np.intp)


def _spread(deviation: Array, areas: Array) -> tuple[Array, Array]:
    """Edges (k + 1,) mm of bars, and the share (k,) of the area in each; 0 is an edge."""
    low, high = float(deviation.min()), float(deviation.max())
    width = round_step(max(high - low, 1e-6) / BARS, STEPS)
    edges = width * np.arange(np.floor(low / width), np.floor(high / width) + 2)
    return edges, np.histogram(deviation, edges, weights=areas)[0] / areas.sum()


def _by_layer(deviation: Array, areas: Array, layer: Index, layers: int) -> Array:
    """Least and mean (layers, 2) mm at the places that are nearest to each layer, NaN where there are none."""
    least, area = np.full(layers, np.inf), np.bincount(layer, areas, layers)
    np.minimum.at(least, layer, deviation)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.bincount(layer, areas * deviation, layers) / area
    return np.column_stack(
        [np.where(area > 0.0, least, np.nan), np.where(area > 0.0, mean, np.nan)]
    )
