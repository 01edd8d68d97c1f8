# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sample a space curve so that chords keep the chord error and the outline reproduces the curve."""

from __future__ import annotations

import numpy as np

from ..geometry.curves.outline import outline
from ..geometry.curves.space_curve import SpaceCurve
from ..geometry.walls.surface import dot
from ..types import Array, Index

SUBDIVISIONS = 4  # curvature samples per arc of the curve
BETWEEN = np.arange(1, 8) / 8.0  # fractions of a segment at which the chord error is measured
GROWTH = 1.15  # factor on the number of segments if the chord error is exceeded
MIN_SEGMENTS = 24  # minimum number of segments of a complete curve
TOLERANCE_MM = 5e-5  # mm; maximum outline error at TEST_SHARES; elsewhere it is at most twice this
# fractions of a segment; where the curvature jumps, the midpoint may be on the curve by chance
TEST_SHARES = np.array([1.0 / 3.0, 2.0 / 3.0])
HALVINGS = 12


def sample_within_chord(curve: SpaceCurve, low: float, high: float, chord_error: float) -> Array:
    """Sample a curve so that its chords keep the chord error.

    Segments are shorter at higher curvature.

    Parameters
    ----------
    curve : SpaceCurve
        The curve.
    low, high : float
        Parameter range; on a closed curve `high` may be beyond the last node.
    chord_error : float
        Maximum distance of the curve from its chords, mm.

    Returns
    -------
    (n,) array
        Ascending parameters from `low` to `high`, including all corners. The outline through the
        points deviates from the curve by at most 2 TOLERANCE_MM.
    """
    corners = curve.w[curve.corners]
    if curve.closed:
        corners = np.concatenate([corners + turn * curve.period for turn in (-1, 0, 1, 2)])
    inner = np.unique(
        corners[(corners > low + 1e-9 * curve.period) & (corners < high - 1e-9 * curve.period)]
    )
    breaks = np.r_[low, inner, high]
    nodes = curve.refined(SUBDIVISIONS)
    if curve.closed:
        nodes = np.concatenate([nodes[:-1] + turn * curve.period for turn in (-1, 0, 1, 2)])
    stretches = [
        _space_evenly(curve, nodes, a, b, chord_error)[:-1] for a, b in zip(breaks[:-1], breaks[1:])
    ]
    return _refine_outline(
        curve, np.concatenate([*stretches, [high]]), np.cumsum([0, *map(len, stretches)])
    )


def _refine_outline(curve: SpaceCurve, w: Array, ends: Index) -> Array:
    """Add parameters until the outline reproduces the curve between them.

    ends: (m,) indices of the parameters at which smooth stretches begin and end, including the
    first and the last parameter.
    """
    is_open = np.ones(len(w) - 1, dtype=bool)
    for _ in range(HALVINGS):
        points, slope, _ = curve.at(w)
        slope /= np.linalg.norm(slope, axis=1, keepdims=True)
        tangents = np.stack([slope, slope], axis=1)
        # at a corner `curve.at` returns the tangent of the next stretch; evaluate just before the
        # corner
        slope = curve.at(w[ends[1:]] - 1e-9 * (w[ends[1:]] - w[ends[1:] - 1]))[1]
        tangents[ends[1:], 0] = slope / np.linalg.norm(slope, axis=1, keepdims=True)
        segment = np.repeat(np.flatnonzero(is_open), len(TEST_SHARES))
        share = np.tile(TEST_SHARES, int(is_open.sum()))
        added = outline(points, tangents).at(segment, share)[0]
        foot, slope, _ = curve.at(curve.descend(added, w[segment] + share * np.diff(w)[segment]))
        off = np.linalg.norm(np.cross(added - foot, slope), axis=1) / np.linalg.norm(slope, axis=1)
        bad = np.unique(segment[off > TOLERANCE_MM])
        if not len(bad):
            break
        is_open[:] = False
        is_open[bad] = True
        w = np.insert(w, bad + 1, 0.5 * (w[bad] + w[bad + 1]))
        is_open = np.insert(is_open, bad + 1, True)
        ends = ends + np.searchsorted(bad, ends)
    return w


def _space_evenly(
    curve: SpaceCurve, nodes: Array, low: float, high: float, chord_error: float
) -> Array:
    """Sample a stretch without inner corners, with a density that follows its curvature.

    nodes: (n,) ascending parameters; the curvature is sampled halfway between nodes.
    """
    w = np.r_[
        low, nodes[np.searchsorted(nodes, low, side="right") : np.searchsorted(nodes, high)], high
    ]
    _, slope, bend = curve.at(0.5 * (w[1:] + w[:-1]))
    rate = np.linalg.norm(slope, axis=1)
    curvature = np.linalg.norm(np.cross(slope, bend), axis=1) / rate**3
    length = rate * np.diff(w)
    # minimum density, so that nearly straight stretches do not get very long segments
    density = length * np.maximum(
        np.sqrt(curvature / (8.0 * chord_error)), MIN_SEGMENTS / curve.length
    )
    total = np.r_[0.0, np.cumsum(density)]
    count = max(1, int(np.ceil(total[-1])))
    while True:
        spaced: Array = np.interp(np.linspace(0.0, total[-1], count + 1), total, w)
        if _max_chord_error(curve, spaced) <= chord_error:
            return spaced
        count = int(np.ceil(GROWTH * count)) + 1


def _max_chord_error(curve: SpaceCurve, w: Array) -> float:
    """Return the maximum distance, mm, of a curve from its chords between parameters (n,)."""
    ends = curve.at(w)[0]
    chord = np.diff(ends, axis=0)
    between = w[:-1, None] + np.diff(w)[:, None] * BETWEEN
    offset = curve.at(between.ravel())[0].reshape(*between.shape, 3) - ends[:-1, None]
    share = np.clip(
        dot(offset, chord[:, None]) / np.maximum(dot(chord, chord), 1e-300)[:, None], 0.0, 1.0
    )
    return float(np.linalg.norm(offset - share[..., None] * chord[:, None], axis=-1).max())
