# SPDX-License-Identifier: LGPL-2.1-or-later
"""A predicted deposit against the part, reduced for drawing: places with their deviations, the worst named, and the spread of
the deviations over the area and over the layers.
"""

from __future__ import annotations

import numpy as np

from ...geometry.fitted import DeviationMap
from ...geometry.formatting import round_step
from ...types import Array, Index
from .compare import Compared
from .laying import PredictedDeposit

MOST_PLACES = 3000  # that are kept
NAMED = 5  # worst places
MIN_SEPARATION_SHARE = 0.1  # of the part's size, the least distance between two named places
STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)  # widths of a histogram's bars, times powers of ten
BARS = 40  # of a histogram, about


def deviation_map(deposit: PredictedDeposit, comparison: Compared, layers: int) -> DeviationMap:
    """The map of a comparison for a path with a number of layers: regularly sampled places, the worst first."""
    named = _worst(comparison.faces.points, comparison.deviation)
    count = len(comparison.deviation)
    sample = np.arange(0, count, -(-count // MOST_PLACES))
    rows = np.concatenate([named, sample[~np.isin(sample, named)]])
    pieces, worst_pieces = deposit.pieces, comparison.piece_rows[named]
    edges, shares = _histogram(comparison.deviation, comparison.faces.areas)
    return DeviationMap(
        comparison.faces.points[rows],
        comparison.faces.normals[rows],
        comparison.deviation[rows],
        np.column_stack(
            [
                pieces.layer[worst_pieces],
                deposit.bead_in_layer[worst_pieces],
                pieces.point[worst_pieces],
            ]
        ).astype(np.int64),
        edges,
        shares,
        _by_layer(
            comparison.deviation,
            comparison.faces.areas,
            np.asarray(pieces.layer[comparison.piece_rows], dtype=np.intp),
            layers,
        ),
    )


def name_of(number: int) -> str:
    """The name of the worst place of this number."""
    return "ABCDEFGHIJ"[number]


def _worst(points: Array, deviation: Array) -> Index:
    """Rows of the places with the least, each away from those before."""
    separation = MIN_SEPARATION_SHARE * float(np.linalg.norm(np.ptp(points, axis=0)))
    remaining: Index = np.argsort(deviation, kind="stable")
    rows: list[int] = []
    while len(remaining) and len(rows) < NAMED:
        rows.append(int(remaining[0]))
        remaining = remaining[
            np.linalg.norm(points[remaining] - points[remaining[0]], axis=1) > separation
        ]
    return np.array(rows, dtype=np.intp)


def _histogram(deviation: Array, areas: Array) -> tuple[Array, Array]:
    """Edges (k + 1,) mm of bars, and the share (k,) of the area in each; 0 is an edge."""
    low, high = float(deviation.min()), float(deviation.max())
    width = round_step(max(high - low, 1e-6) / BARS, STEPS)
    edges = width * np.arange(np.floor(low / width), np.floor(high / width) + 2)
    return edges, np.histogram(deviation, edges, weights=areas)[0] / areas.sum()


def _by_layer(deviation: Array, areas: Array, layer: Index, layers: int) -> Array:
    """Least and mean (layers, 2) mm at the places nearest to each layer, NaN without any."""
    lowest, area = np.full(layers, np.inf), np.bincount(layer, areas, layers)
    np.minimum.at(lowest, layer, deviation)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.bincount(layer, areas * deviation, layers) / area
    return np.column_stack(
        [np.where(area > 0.0, lowest, np.nan), np.where(area > 0.0, mean, np.nan)]
    )
