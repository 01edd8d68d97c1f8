# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far layers really are apart: from each deposit point to the nearest point of the layer before.

The curve of a layer is the polyline through its points, straight between them. Distances to it are exact; against
the true curve, whose chords the segments are, they are off by at most the chord error of the toolpath.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..toolpath import Array, Layer, Toolpath

_CHUNK = 400_000  # point-segment pairs handled at once; bounds the memory


def between_layers(toolpath: Toolpath) -> tuple[Array, ...]:
    """Per layer but the first, (n,) mm: the distance of each of its points to the layer before, in order of deposit."""
    return tuple(
        to_curve(_points(layer), *_segments(below)) for below, layer in zip(toolpath.layers, toolpath.layers[1:])
    )


def to_curve(points: Array, start: Array, end: Array) -> Array:
    """(n,) distance from points (n, 3) to the nearest of the segments start, end (m, 3), m >= 1; in their unit.

    The nearest vertex bounds the distance from above, so only segments whose middle is nearer than this bound plus
    half the longest segment can be nearer still; all of those are tried.
    """
    half = np.linalg.norm(end - start, axis=1) * 0.5
    bound, _ = cKDTree(np.concatenate((start, end[-1:]))).query(points)
    middles = cKDTree(0.5 * (start + end))
    radius = (bound + half.max()) * (1.0 + 1e-12)
    nearest = bound * bound
    for index in np.array_split(np.arange(len(points)), _parts(middles, points, radius)):
        _try_segments(nearest, index, _within(middles, points[index], radius[index]), points, start, end)
    distance: Array = np.sqrt(nearest)
    return distance


def _parts(middles: cKDTree, points: Array, radius: Array) -> int:
    sample = slice(None, None, max(1, len(points) // 16))
    per_point = float(np.mean(middles.query_ball_point(points[sample], radius[sample], return_length=True)))
    return min(len(points), 1 + int(per_point * len(points) / _CHUNK))


def _within(middles: cKDTree, points: Array, radius: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Which point goes with which candidate segment, as two equally long arrays ordered by point."""
    found = middles.query_ball_point(points, radius, return_sorted=False)
    count = np.fromiter(map(len, found), dtype=np.intp, count=len(found))
    segment = np.fromiter((i for some in found for i in some), dtype=np.intp, count=int(count.sum()))
    return np.repeat(np.arange(len(points)), count), segment


def _try_segments(
    nearest: Array, index: NDArray[np.intp], pairs: tuple[NDArray[np.intp], NDArray[np.intp]],
    points: Array, start: Array, end: Array,
) -> None:
    """Lower the squared distances `nearest[index]` to those of the paired segments."""
    which, segment = pairs
    along = end[segment] - start[segment]
    offset = points[index[which]] - start[segment]
    length = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", offset, along) / np.where(length > 0.0, length, 1.0)
    offset -= np.clip(share, 0.0, 1.0)[:, None] * along
    np.minimum.at(nearest, index[which], np.einsum("ij,ij->i", offset, offset))


def _points(layer: Layer) -> Array:
    points: Array = np.concatenate([bead.points for bead in layer.beads])
    return points


def _segments(layer: Layer) -> tuple[Array, Array]:
    beads = layer.beads
    return np.concatenate([b.points[:-1] for b in beads]), np.concatenate([b.points[1:] for b in beads])
