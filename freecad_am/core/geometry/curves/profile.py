# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of revolution: a generating curve (meridian) rotated about the axis.

The meridian is in the half-plane (radius, height) of the feature frame, whose Z is the axis. It is
a chain of exact samples with exact unit tangents, joined by cubic Hermite arcs in arc length. With
adjacent tangents less than 0.006 rad apart (see `sample_curve`), positions are accurate to 1e-7 mm
and tangents to 1e-8.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from ...issues import Issue
from ...types import Array, ArrayLike, Index, Mask
from ..obstacles import Body
from ..walls.part_depths import PartDepths

KINK = 1e-5  # rad; smaller angles between adjacent pieces are smooth joints
SAME_PLACE = 1e-9  # mm; piece ends closer than this coincide
STEP = 1e-4  # mm; gaps up to this come from rounding in files and count as zero length
ON_AXIS = 1e-6  # mm; a smaller radius is a point on the axis


def arc_lengths(points: Array, tangents: Array) -> Array:
    """Return the length of each arc between adjacent samples.

    Parameters
    ----------
    points : (n, 2) array
        Samples, mm.
    tangents : (n, 2) array
        Tangents at the samples.

    Returns
    -------
    (n - 1,) array
        mm.

    Notes
    -----
    A cubic at angles a and b to the chord at its ends has the length chord (1 + (2 a^2 - a b + 2
    b^2) / 30) to fourth order. The relative error is 1e-12 at 0.006 rad per arc.
    """
    steps = np.diff(points, axis=0)
    chords = np.hypot(steps[:, 0], steps[:, 1])
    a = turning_angle(steps, tangents[:-1])
    b = turning_angle(steps, tangents[1:])
    length: Array = chords * (1.0 + (2.0 * a * a - a * b + 2.0 * b * b) / 30.0)
    return length


def turning_angle(a: Array, b: Array) -> Array:
    """Return the angles from vectors `a` to vectors `b`.

    Parameters
    ----------
    a, b : (..., 2) array
        Vectors.

    Returns
    -------
    (...) array
        Angles, counter-clockwise positive, rad.
    """
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    angle: Array = np.arctan2(cross, (a * b).sum(axis=-1))
    return angle


@dataclass(frozen=True, eq=False)
class Meridian:
    """The generating curve from the platform upwards.

    Node i has the arc length s[i], mm, (radius, height) points[i], mm, and unit tangent tangents[i]
    towards rising s. Kinks have two nodes with equal s and different tangents.
    """

    s: Array
    points: Array
    tangents: Array

    def __post_init__(self) -> None:
        for name in ("s", "points", "tangents"):
            values = np.array(getattr(self, name), dtype=np.float64)
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        n = len(self.s)
        if n < 2 or self.points.shape != (n, 2) or self.tangents.shape != (n, 2):
            raise ValueError("a meridian needs at least two nodes, each with a point and a tangent")
        if (np.diff(self.s) < 0.0).any() or not self.s[-1] > 0.0:
            raise ValueError("the arc length of a meridian must rise")
        if self.points[:, 0].min() < 0.0:
            raise ValueError("the radius of a meridian is never negative")

    @classmethod
    def chained(cls, segments: Sequence[tuple[Array, Array]]) -> Meridian:
        """Chain segments to a meridian.

        A straight line bridges a gap between two segments and counts in the arc length. Gaps up to
        STEP are skipped.

        Parameters
        ----------
        segments : sequence of tuple of (n, 2) array and (n, 2) array
            Points (radius, height), mm, and unit tangents of each segment.

        Returns
        -------
        Meridian
            The chain; radii below ON_AXIS become 0.
        """
        points: list[Array] = []
        tangents: list[Array] = []
        lengths = [0.0]
        for piece_points, piece_tangents in segments:
            if points:
                _bridge(points, tangents, lengths, piece_points[0], piece_tangents[0])
                piece_points, piece_tangents = piece_points[1:], piece_tangents[1:]
                joined = (
                    np.vstack([points[-1][-1:], piece_points]),
                    np.vstack([tangents[-1][-1:], piece_tangents]),
                )
            else:
                joined = piece_points, piece_tangents
            lengths.extend(arc_lengths(*joined))
            points.append(piece_points)
            tangents.append(piece_tangents)
        stacked = np.vstack(points)
        stacked[:, 0] = np.where(np.abs(stacked[:, 0]) < ON_AXIS, 0.0, stacked[:, 0])
        return cls(np.cumsum(lengths), stacked, np.vstack(tangents))

    @property
    def length(self) -> float:
        """Total length of the curve, mm."""
        return float(self.s[-1])

    @property
    def kinks(self) -> Array:
        """Return the arc lengths at which the tangent jumps.

        Returns
        -------
        (k,) array
            mm.
        """
        node = np.flatnonzero(np.diff(self.s) == 0.0)
        kinks: Array = self.s[
            node[np.abs(turning_angle(self.tangents[node], self.tangents[node + 1])) > KINK]
        ]
        return kinks

    @property
    def closed_top(self) -> bool:
        """Whether the curve ends on the axis."""
        return bool(self.points[-1, 0] == 0.0)

    def at(self, s: ArrayLike) -> tuple[Array, Array, Array]:
        """Evaluate the meridian.

        At a kink, the tangent is that of the lower piece, which carries the deposit.

        Parameters
        ----------
        s : (n,) array
            Arc lengths, clipped to the curve, mm.

        Returns
        -------
        radius : (n,) array
            mm.
        height : (n,) array
            mm.
        tangent : (n, 2) array
            Unit tangents, radius and height.
        """
        i, u, h = self._locate(np.clip(np.asarray(s, dtype=np.float64), 0.0, self.length))
        u, h = u[:, None], h[:, None]
        p, q = self.points[i], self.points[i + 1]
        a, b = self.tangents[i] * h, self.tangents[i + 1] * h
        d = q - p
        point = p + u * (a + u * (3.0 * d - 2.0 * a - b + u * (a + b - 2.0 * d)))
        slope = a + u * (2.0 * (3.0 * d - 2.0 * a - b) + 3.0 * u * (a + b - 2.0 * d))
        tangent = slope / np.linalg.norm(slope, axis=1, keepdims=True)
        return np.maximum(point[:, 0], 0.0), point[:, 1], tangent

    def _locate(self, s: Array) -> tuple[Index, Array, Array]:
        # a layer at a kink, up to rounding, belongs below it; side='left' skips the second node
        i = np.clip(np.searchsorted(self.s, s - 1e-9, side="left") - 1, 0, len(self.s) - 2)
        i = np.where(self.s[i + 1] > self.s[i], i, np.minimum(i + 1, len(self.s) - 2))
        h = self.s[i + 1] - self.s[i]
        return i, (s - self.s[i]) / h, h

    def s_at_height(self, heights: ArrayLike) -> list[Array]:
        """Return all arc lengths at which the curve crosses or touches given heights.

        Parameters
        ----------
        heights : (n,) array
            Heights, mm.

        Returns
        -------
        list of array
            Rising arc lengths for each height, mm.
        """
        levels = np.atleast_1d(np.asarray(heights, dtype=np.float64))
        z = self.points[None, :, 1] - levels[:, None]
        z = np.where(np.abs(z) < 1e-9, 0.0, z)
        level_number, segment = np.nonzero(z[:, 1:] * z[:, :-1] < 0.0)
        low, high = self.s[segment].copy(), self.s[segment + 1].copy()
        rising = z[level_number, segment + 1] > 0.0
        for _ in range(50):
            middle = 0.5 * (low + high)
            over = (self.at(middle)[1] >= levels[level_number]) == rising
            low, high = np.where(over, low, middle), np.where(over, middle, high)
        on, node = np.nonzero(z == 0.0)
        level_number, arc_lengths = np.r_[level_number, on], np.r_[0.5 * (low + high), self.s[node]]
        order = np.lexsort((arc_lengths, level_number))
        level_number, arc_lengths = level_number[order], arc_lengths[order]
        distinct = np.r_[True, (np.diff(arc_lengths) > 1e-6) | (np.diff(level_number) > 0)][
            : len(arc_lengths)
        ]
        return np.split(
            arc_lengths[distinct],
            np.searchsorted(level_number[distinct], np.arange(1, len(levels))),
        )


def _bridge(
    points: list[Array], tangents: list[Array], lengths: list[float], to: Array, tangent: Array
) -> None:
    """Append the nodes between the end of the chain and the start of the next piece."""
    end = points[-1][-1]
    gap = to - end
    distance = float(np.hypot(*gap))
    if distance > STEP:
        along = gap / distance
        points.append(np.array([end, to]))
        tangents.append(np.array([along, along]))
        lengths.extend([0.0, distance])
    if SAME_PLACE < distance <= STEP or abs(turning_angle(tangents[-1][-1], tangent)) > KINK:
        points.append(np.array([to]))
        tangents.append(np.array([tangent]))
        lengths.append(0.0)


@dataclass(frozen=True, eq=False)
class RevolvedWall:
    """A meridian rotated about the Z axis of the feature frame.

    frame: (4, 4) pose of the feature frame in part coordinates (interface.md, `mount`). start, end:
    azimuths about the axis, rad, end > start. full: whether the wall closes around the axis.
    issues: issues from building the wall. label: the user's name of the part. faces: names of the
    wall's faces, from the platform upwards. surroundings: fixtures. depths: distribution of the
    part about the wall, if the wall has faces. own: None, because a wall has no hub.
    """

    own: ClassVar[None] = None

    meridian: Meridian
    frame: Array
    start: float = 0.0
    end: float = 2.0 * np.pi
    full: bool = True
    issues: tuple[Issue, ...] = ()
    label: str = "part"
    faces: tuple[str, ...] = ()
    surroundings: tuple[Body, ...] = ()
    depths: PartDepths | None = None

    def __post_init__(self) -> None:
        frame = np.array(self.frame, dtype=np.float64)
        frame.setflags(write=False)
        object.__setattr__(self, "frame", frame)
        if frame.shape != (4, 4) or not self.end > self.start:
            raise ValueError("a wall needs a (4, 4) frame and a turn of positive angle")

    def points(self, radius: Array, height: Array, azimuth: Array) -> Array:
        """Convert cylindrical coordinates of the feature frame to points in part coordinates.

        Parameters
        ----------
        radius, height : (n,) array
            mm.
        azimuth : (n,) array
            rad.

        Returns
        -------
        (n, 3) array
            mm.
        """
        local = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height], axis=-1)
        moved: Array = local @ self.frame[:3, :3].T + self.frame[:3, 3]
        return moved

    def directions(self, vectors: Array, azimuth: Array) -> Array:
        """Convert cylindrical components in the feature frame to vectors in part coordinates.

        Parameters
        ----------
        vectors : (n, 3) array
            Components along radius, azimuth and axis.
        azimuth : (n,) array
            Azimuths of the vectors, rad.

        Returns
        -------
        (n, 3) array
            Vectors in part coordinates.
        """
        c, s = np.cos(azimuth), np.sin(azimuth)
        r, t, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
        turned: Array = (
            np.stack([r * c - t * s, r * s + t * c, z + 0.0 * c], axis=-1) @ self.frame[:3, :3].T
        )
        return turned


Curve = Callable[[Array], tuple[Array, Array]]

TANGENT_TOLERANCE = 8e-9  # before the last bisection, which reduces it to 1e-9
POINT_TOLERANCE = 1e-8  # mm
ROUNDS = 14  # bisections; a curve that needs more has a corner that is missing in `breaks`


def sample_curve(curve: Curve, breaks: ArrayLike) -> tuple[Array, Array]:
    """Sample a curve finely enough for Hermite arcs.

    Intervals are bisected until the midpoint of the Hermite arc over the full interval meets the
    curve. The errors of the halves are smaller by a factor of 8 in the tangent and 16 in the point.

    Parameters
    ----------
    curve : Curve
        Function of parameters (n,) that returns points (n, 2) and tangents (n, 2) of any length.
    breaks : (k,) array
        Rising parameters between which the curve is smooth.

    Returns
    -------
    points : (n, 2) array
        Points from the first break to the last, mm.
    tangents : (n, 2) array
        Unit tangents.

    Raises
    ------
    ValueError
        If a tangent is zero.
    """
    t = _initial(np.asarray(breaks, dtype=np.float64))
    points, tangents = _evaluate(curve, t)
    rough = np.ones(len(t) - 1, dtype=bool)
    for _ in range(ROUNDS):
        middle = 0.5 * (t[:-1] + t[1:])[rough]
        new_points, new_tangents = _evaluate(curve, middle)
        i = np.flatnonzero(rough)
        fine = _agrees(
            points[i], tangents[i], points[i + 1], tangents[i + 1], new_points, new_tangents
        )
        t, points, tangents = (
            np.insert(have, i + 1, new, axis=0)
            for have, new in ((t, middle), (points, new_points), (tangents, new_tangents))
        )
        rough = np.repeat(rough, np.where(rough, 2, 1))
        rough[rough] = ~np.repeat(fine, 2)
        if not rough.any():
            break
    return points, tangents


def _initial(breaks: Array) -> Array:
    inner = [np.linspace(a, b, 5)[:-1] for a, b in pairwise(breaks)]
    start: Array = np.concatenate([*inner, breaks[-1:]])
    return start


def _evaluate(curve: Curve, t: Array) -> tuple[Array, Array]:
    points, tangents = curve(t)
    size = np.linalg.norm(tangents, axis=1, keepdims=True)
    if not size.min() > 0.0:
        raise ValueError("the curve has no direction at one of its points")
    return points, tangents / size


def _agrees(p: Array, a: Array, q: Array, b: Array, middle: Array, tangent: Array) -> Mask:
    start_length = _lengths(p, a, middle, tangent)
    length = start_length + _lengths(middle, tangent, q, b)
    u = (start_length / length)[:, None]
    a, b, d = a * length[:, None], b * length[:, None], q - p
    point = p + u * (a + u * (3.0 * d - 2.0 * a - b + u * (a + b - 2.0 * d)))
    off = np.linalg.norm(point - middle, axis=1)
    # maximum slope error of a cubic, not at the midpoint: 3.1 maximum position error / length
    good: Mask = (off < POINT_TOLERANCE) & (3.1 * off < TANGENT_TOLERANCE * length + 1e-12)
    return good


def _lengths(p: Array, a: Array, q: Array, b: Array) -> Array:
    pairs = np.stack([p, q], axis=1).reshape(-1, 2)
    return arc_lengths(pairs, np.stack([a, b], axis=1).reshape(-1, 2))[::2]


def line(start: ArrayLike, end: ArrayLike) -> tuple[Array, Array]:
    """Return samples of a straight segment.

    Parameters
    ----------
    start, end : (2,) array
        Ends of the segment, mm.

    Returns
    -------
    points : (2, 2) array
        The ends.
    tangents : (2, 2) array
        The common unit tangent, twice.
    """
    points = np.array([start, end], dtype=np.float64)
    along = points[1] - points[0]
    return points, np.tile(along / np.linalg.norm(along), (2, 1))


def arc(centre: ArrayLike, radius: float, start: float, end: float) -> tuple[Array, Array]:
    """Return samples of a circular arc.

    Parameters
    ----------
    centre : (2,) array
        Centre, mm.
    radius : float
        Radius, mm.
    start, end : float
        Angles of the ends, rad; the arc runs clockwise if `end` is smaller.

    Returns
    -------
    points : (n, 2) array
        Points, mm.
    tangents : (n, 2) array
        Unit tangents.
    """
    middle = np.asarray(centre, dtype=np.float64)
    sign = 1.0 if end > start else -1.0

    def circle(t: Array) -> tuple[Array, Array]:
        around = np.stack([np.cos(t), np.sin(t)], axis=1)
        return middle + radius * around, sign * np.stack([-around[:, 1], around[:, 0]], axis=1)

    low, high = sorted((start, end))
    points, tangents = sample_curve(circle, [low, high])
    return (points, tangents) if sign > 0.0 else (points[::-1], tangents[::-1])
