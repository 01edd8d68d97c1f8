# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curve through a row of points: a cubic on each segment, with corners.

A circle is exact at segment midpoints, and to sixth order in the segment angle elsewhere. A curve
with known tangents is accurate to fourth order in the segment length.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...types import Array, Index
from ..columns import lengths

# rad; a larger turn angle is a corner, unless tangents are known
CORNER = np.radians(35.0)
# maximum length ratio of adjacent segments of an arc; a common circle would bend the longer most
LENGTH_RATIO = 3.0


@dataclass(frozen=True, eq=False)
class Outline:
    """points: (n, 3) mm. leaving, arriving: (n - 1, 3) end derivatives per segment fraction, mm."""

    points: Array
    leaving: Array
    arriving: Array

    def at(self, segment: Index, share: Array | float) -> tuple[Array, Array]:
        """Evaluate the outline.

        Parameters
        ----------
        segment : (k,) int array
            Segment indices.
        share : float or (k,) array
            Fractions of the segments.

        Returns
        -------
        points : (k, 3) array
            Points, mm.
        tangents : (k, 3) array
            Unit tangents.
        """
        s = np.broadcast_to(np.asarray(share, dtype=np.float64), segment.shape)[:, None]
        start, chord = self.points[segment], self.points[segment + 1] - self.points[segment]
        leaving, arriving = self.leaving[segment], self.arriving[segment]
        remaining = 1.0 - s
        # chord plus bow, so that segments without a bow stay exactly straight
        start_bow, toward = leaving - chord, arriving - chord
        point = start + s * chord + s * remaining * (remaining * start_bow - s * toward)
        slope = (
            chord
            + remaining * (remaining - 2.0 * s) * start_bow
            + s * (s - 2.0 * remaining) * toward
        )
        return point, unit(slope)


def outline(points: Array, tangents: Array) -> Outline:
    """Build the outline of points with tangents.

    Parameters
    ----------
    points : (n, 3) array
        mm.
    tangents : (n, 2, 3) array
        Unit vectors at each point: arriving and leaving.

    Returns
    -------
    Outline
        The curve of n - 1 segments.
    """
    return Outline(points, *derivatives(points, tangents[:-1, 1], tangents[1:, 0]))


def derivatives(points: Array, leaving: Array, arriving: Array) -> tuple[Array, Array]:
    """Return end derivatives of the cubics through points.

    With these magnitudes a cubic passes through the midpoint of a circular arc.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    leaving, arriving : (n - 1, 3) array
        Unit tangents at the start and end of each segment.

    Returns
    -------
    leaving, arriving : (n - 1, 3) array
        Derivatives per segment fraction, mm.
    """
    chord = np.diff(points, axis=0)
    length = lengths(chord)
    cosine = 0.5 * ((leaving + arriving) * unit(chord)).sum(axis=1)
    size = (length / np.maximum(0.5 * (1.0 + cosine), 0.5))[:, None]
    return size * leaving, size * arriving


def estimate_outline(points: Array, closed: bool) -> Outline:
    """Estimate the outline of points.

    A tangent is that of the circle through a point and its neighbours. Segments next to a corner
    are straight. Segments much longer than their neighbours are straight too, as where a line meets
    an arc, because points of a curve are roughly evenly spaced.

    Parameters
    ----------
    points : (n, 3) array
        mm.
    closed : bool
        Whether the last point repeats the first.

    Returns
    -------
    Outline
        The curve of n - 1 segments.
    """
    along = np.diff(points, axis=0)
    length = lengths(along)[:, None]
    along = along / np.maximum(length, 1e-12)
    rounded = closed and len(along) > 2
    previous_direction = np.concatenate([along[-1:] if rounded else along[:1], along])
    next_direction = np.concatenate([along, along[:1] if rounded else along[-1:]])
    previous_length = np.concatenate([length[-1:] if rounded else length[:1], length])
    next_length = np.concatenate([length, length[:1] if rounded else length[-1:]])
    tangent = unit(previous_direction * next_length + next_direction * previous_length)
    if not rounded and len(along) > 1:  # at an end, use the circle of the adjacent point
        tangent[0] = 2.0 * (along[0] @ tangent[1]) * along[0] - tangent[1]
        tangent[-1] = 2.0 * (along[-1] @ tangent[-2]) * along[-1] - tangent[-2]
    corner = (previous_direction * next_direction).sum(axis=1) < np.cos(CORNER)
    long = (length > LENGTH_RATIO * np.minimum(previous_length[:-1], next_length[1:]))[:, 0]
    straight = (corner[:-1] | corner[1:] | long)[:, None]
    leaving = np.where(straight, along, tangent[:-1])
    arriving = np.where(straight, along, tangent[1:])
    return outline(points, at_points(leaving, arriving))


def at_points(leaving: Array, arriving: Array) -> Array:
    """Return the arriving and leaving vectors of each point.

    Parameters
    ----------
    leaving, arriving : (n - 1, 3) array
        Vectors at the start and end of each segment.

    Returns
    -------
    (n, 2, 3) array
        Vectors; at the ends, the only known vector appears twice.
    """
    return np.stack([np.r_[leaving[:1], arriving], np.r_[leaving, arriving[-1:]]], axis=1)


def unit(vectors: Array) -> Array:
    """Scale vectors to unit length.

    Parameters
    ----------
    vectors : (..., 3) array
        Vectors; zero vectors stay zero.

    Returns
    -------
    (..., 3) array
        Unit vectors.
    """
    result: Array = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return result
