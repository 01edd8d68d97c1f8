# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points on a curve in space so that straight segments between them stay within a chord error, and what the points outline
is the curve."""

from __future__ import annotations

import numpy as np

from ..geometry.curves.outline import outline
from ..geometry.curves.space_curve import SpaceCurve
from ..geometry.walls.surface import dot
from ..types import Array, Index

CLOSER = 4  # places per arc of the curve at which its curvature is taken
BETWEEN = (
    np.arange(1, 8) / 8.0
)  # places of a segment at which its distance from the curve is measured
MORE = 1.15  # times as many segments where the chord error is not met
FEWEST = 24  # segments of a whole curve
WITHIN = 5e-5  # mm; how far the outline of the points may be off the curve at INSIDE, half of what it is anywhere
# of each segment; where the curvature jumps within it, its middle may be right by chance
INSIDE = np.array([1.0 / 3.0, 2.0 / 3.0])
HALVINGS = 12


def within_chord(curve: SpaceCurve, low: float, high: float, chord_error: float) -> Array:
    """Parameters (n,) from low to high, rising, with every corner between; the chords are off by `chord_error` mm at most,
    the outline of the points by 2 WITHIN.

    Segments are shorter where the curve bends more. On a closed curve high may lie beyond the last node.
    """
    corners = curve.w[curve.corners]
    if curve.closed:
        corners = np.concatenate([corners + turn * curve.period for turn in (-1, 0, 1, 2)])
    inner = np.unique(
        corners[(corners > low + 1e-9 * curve.period) & (corners < high - 1e-9 * curve.period)]
    )
    breaks = np.r_[low, inner, high]
    nodes = curve.refined(CLOSER)
    if curve.closed:
        nodes = np.concatenate([nodes[:-1] + turn * curve.period for turn in (-1, 0, 1, 2)])
    stretches = [
        _spaced(curve, nodes, a, b, chord_error)[:-1] for a, b in zip(breaks[:-1], breaks[1:])
    ]
    return _outlining(
        curve, np.concatenate([*stretches, [high]]), np.cumsum([0, *map(len, stretches)])
    )


def _outlining(curve: SpaceCurve, w: Array, ends: Index) -> Array:
    """The parameters (n,), and more, so that points added between them later by their outline lie on the curve. ends: (m,)
    numbers of those where smooth stretches begin and end, the first and the last of all too."""
    asked = np.ones(len(w) - 1, dtype=bool)
    for _ in range(HALVINGS):
        points, slope, _ = curve.at(w)
        slope /= np.linalg.norm(slope, axis=1, keepdims=True)
        tangents = np.stack([slope, slope], axis=1)
        # at the end of a stretch the curve may have a corner, where it is that of the next
        slope = curve.at(w[ends[1:]] - 1e-9 * (w[ends[1:]] - w[ends[1:] - 1]))[1]
        tangents[ends[1:], 0] = slope / np.linalg.norm(slope, axis=1, keepdims=True)
        some = np.repeat(np.flatnonzero(asked), len(INSIDE))
        share = np.tile(INSIDE, int(asked.sum()))
        added = outline(points, tangents).at(some, share)[0]
        foot, slope, _ = curve.at(curve.descend(added, w[some] + share * np.diff(w)[some]))
        off = np.linalg.norm(np.cross(added - foot, slope), axis=1) / np.linalg.norm(slope, axis=1)
        bad = np.unique(some[off > WITHIN])
        if not len(bad):
            break
        asked[:] = False
        asked[bad] = True
        w = np.insert(w, bad + 1, 0.5 * (w[bad] + w[bad + 1]))
        asked = np.insert(asked, bad + 1, True)
        ends = ends + np.searchsorted(bad, ends)
    return w


def _spaced(curve: SpaceCurve, nodes: Array, low: float, high: float, chord_error: float) -> Array:
    """Parameters of a stretch without corners inside, equally spread by what the curvature asks for. nodes: (n,), rising,
    between which that is taken."""
    w = np.r_[
        low, nodes[np.searchsorted(nodes, low, side="right") : np.searchsorted(nodes, high)], high
    ]
    _, slope, bend = curve.at(0.5 * (w[1:] + w[:-1]))
    rate = np.linalg.norm(slope, axis=1)
    curvature = np.linalg.norm(np.cross(slope, bend), axis=1) / rate**3
    length = rate * np.diff(w)
    # where it hardly bends a share of the length still counts, so that segments do not get much longer than others
    wanted = length * np.maximum(np.sqrt(curvature / (8.0 * chord_error)), FEWEST / curve.length)
    total = np.r_[0.0, np.cumsum(wanted)]
    count = max(1, int(np.ceil(total[-1])))
    while True:
        spaced: Array = np.interp(np.linspace(0.0, total[-1], count + 1), total, w)
        if _off_chords(curve, spaced) <= chord_error:
            return spaced
        count = int(np.ceil(MORE * count)) + 1


def _off_chords(curve: SpaceCurve, w: Array) -> float:
    """Largest distance, mm, of the curve from the chords between the parameters (n,)."""
    ends = curve.at(w)[0]
    chord = np.diff(ends, axis=0)
    between = w[:-1, None] + np.diff(w)[:, None] * BETWEEN
    away = curve.at(between.ravel())[0].reshape(*between.shape, 3) - ends[:-1, None]
    share = np.clip(
        dot(away, chord[:, None]) / np.maximum(dot(chord, chord), 1e-300)[:, None], 0.0, 1.0
    )
    return float(np.linalg.norm(away - share[..., None] * chord[:, None], axis=-1).max())
