# SPDX-License-Identifier: LGPL-2.1-or-later
"""The curve that a row of points outlines: a cubic over each segment, corners kept.

A circle is met exactly in the middle of a segment and to the sixth order in its turn elsewhere; a curve whose tangents
are known to the fourth order of the segment's length.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...types import Array, Index
from ..columns import lengths

# a row of points that turns by more than this has a corner there, where nothing else is known, rad
CORNER = np.radians(35.0)
# a segment longer than its neighbour by this ratio is not part of the same arc: a circle through both would bend it most
LENGTH_RATIO = 3.0


@dataclass(frozen=True, eq=False)
class Outline:
    """points: (n, 3) mm. leaving, arriving: (n - 1, 3) derivatives at the two ends of each segment, by its share."""

    points: Array
    leaving: Array
    arriving: Array

    def at(self, segment: Index, share: Array | float) -> tuple[Array, Array]:
        """Evaluate the outline.

        Parameters
        ----------
        segment : (k,) int array
            Numbers of the segments.
        share : float or (k,) array
            Shares of their length.

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
        # the chord plus its bow, so that segments without a bow stay exactly straight
        start_bow, toward = leaving - chord, arriving - chord
        point = start + s * chord + s * remaining * (remaining * start_bow - s * toward)
        slope = (
            chord
            + remaining * (remaining - 2.0 * s) * start_bow
            + s * (s - 2.0 * remaining) * toward
        )
        return point, unit(slope)


def outline(points: Array, tangents: Array) -> Outline:
    """Return the outline of points with tangents.

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
    """Return derivatives at the ends of the cubics through points.

    Their size makes the cubic meet the middle of a circular arc.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    leaving, arriving : (n - 1, 3) array
        Unit tangents at the start and end of each segment.

    Returns
    -------
    leaving, arriving : (n - 1, 3) array
        Derivatives by the share of the segment.
    """
    chord = np.diff(points, axis=0)
    length = lengths(chord)
    cosine = 0.5 * ((leaving + arriving) * unit(chord)).sum(axis=1)
    size = (length / np.maximum(0.5 * (1.0 + cosine), 0.5))[:, None]
    return size * leaving, size * arriving


def estimate_outline(points: Array, closed: bool) -> Outline:
    """Estimate the outline of points.

    A tangent is that of the circle through a point and its neighbours. A segment next to a corner
    is straight, and so is one much longer than its neighbour, as where an arc meets a line: points
    of a curve are roughly evenly spaced.

    Parameters
    ----------
    points : (n, 3) array
        mm.
    closed : bool
        Whether the last point is the first.

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
    if not rounded and len(along) > 1:  # at an end, the circle of the point next to it
        tangent[0] = 2.0 * (along[0] @ tangent[1]) * along[0] - tangent[1]
        tangent[-1] = 2.0 * (along[-1] @ tangent[-2]) * along[-1] - tangent[-2]
    corner = (previous_direction * next_direction).sum(axis=1) < np.cos(CORNER)
    long = (length > LENGTH_RATIO * np.minimum(previous_length[:-1], next_length[1:]))[:, 0]
    straight = (corner[:-1] | corner[1:] | long)[:, None]
    leaving = np.where(straight, along, tangent[:-1])
    arriving = np.where(straight, along, tangent[1:])
    return outline(points, at_points(leaving, arriving))


def at_points(leaving: Array, arriving: Array) -> Array:
    """Return the vectors that arrive at and leave each point.

    Parameters
    ----------
    leaving, arriving : (n - 1, 3) array
        Vectors at the start and end of each segment.

    Returns
    -------
    (n, 2, 3) array
        At the ends the only known vector counts twice.
    """
    return np.stack([np.r_[leaving[:1], arriving], np.r_[leaving, arriving[-1:]]], axis=1)


def unit(vectors: Array) -> Array:
    """Return vectors at unit length.

    Parameters
    ----------
    vectors : (..., 3) array
        Vectors; a vector of no length stays.

    Returns
    -------
    (..., 3) array
        Unit vectors.
    """
    result: Array = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return result
