# SPDX-License-Identifier: LGPL-2.1-or-later
"""A guide curve normal to the layers: points, twist-free frames, and the plane of any point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index

if TYPE_CHECKING:
    from scipy.interpolate import CubicHermiteSpline


SEARCHED = 4  # samples per node interval for the search of the nearest position
STEPS = 40  # maximum number of steps of a foot search
TOLERANCE_MM = 1e-9  # mm along the guide
TIGHTEST = 0.95  # of the radius of curvature; maximum offset of a point towards the centre
MAX_JUMP_RATIO = 20.0  # mm along the guide per mm of edge length
DIFFERENCE_SHARE = (
    1e-3  # of the shortest node interval; step of the difference quotient of the tangent
)


@dataclass(frozen=True, eq=False)
class Guide:
    """A curve without corners, in the frame of the body to slice, extended straight at both ends.

    points, tangents: (n, 3) nodes, mm, and unit tangents. way: (n,) arc length, mm, rising; the
    first layer is at 0. across: (n, 3) twist-free unit vectors normal to the curve (Wang 2008).
    """

    points: Array
    tangents: Array
    way: Array
    across: Array

    def at(self, s: Array) -> tuple[Array, Array]:
        """Evaluate the guide.

        Parameters
        ----------
        s : (k,) array
            Arc lengths, mm; the guide continues straight beyond its ends.

        Returns
        -------
        points : (k, 3) array
            Points, mm.
        tangents : (k, 3) array
            Unit tangents.
        """
        clipped = np.clip(s, self.way[0], self.way[-1])
        points = self._curve(clipped)
        tangents = self._curve(clipped, 1)
        tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
        return points + (s - clipped)[:, None] * tangents, tangents

    def frame(self, s: float) -> Array:
        """Return the pose of the plane normal to the guide.

        Parameters
        ----------
        s : float
            Arc length, mm.

        Returns
        -------
        (4, 4) array
            Pose whose Z is along the guide.
        """
        points, tangents = self.at(np.array([s]))
        z = tangents[0]
        x = np.array([np.interp(s, self.way, column) for column in self.across.T])
        x -= (x @ z) * z
        x /= np.linalg.norm(x)
        pose = np.eye(4)
        pose[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
        pose[:3, 3] = points[0]
        return pose

    def reaches(self, s: float) -> bool:
        """Return whether an arc length, mm, is between the ends of the guide."""
        return bool(self.way[0] <= s <= self.way[-1])

    def distance(self, points: Array) -> Array:
        """Return the arc length of the normal plane through each point.

        Parameters
        ----------
        points : (..., 3) array
            Points, mm.

        Returns
        -------
        (...) array
            Arc lengths, mm; among several planes, that of the nearest foot.
        """
        flat = points.reshape(-1, 3)
        nearest_node = np.asarray(self._tree.query(flat)[1], dtype=np.intp)
        node_positions = self._places
        low = np.where(nearest_node == 0, -np.inf, node_positions[np.maximum(nearest_node - 1, 0)])
        high = np.where(
            nearest_node == len(node_positions) - 1,
            np.inf,
            node_positions[np.minimum(nearest_node + 1, len(node_positions) - 1)],
        )
        s = node_positions[nearest_node]
        for _ in range(STEPS):
            foot, along = self.at(s)
            ahead = ((flat - foot) * along).sum(axis=1)
            low, high = np.where(ahead > 0.0, s, low), np.where(ahead < 0.0, s, high)
            following = s + ahead / np.maximum(1.0 - self.curvature_share(flat, s), 0.05)
            outside = (following < low) | (following > high)
            middle = np.where(np.isfinite(low) & np.isfinite(high), 0.5 * (low + high), following)
            following = np.where(outside, middle, following)
            has_converged = float(np.abs(following - s).max(initial=0.0)) < TOLERANCE_MM
            s = following
            if has_converged:
                break
        return np.asarray(s.reshape(points.shape[:-1]))

    def curvature_share(self, points: Array, s: Array) -> Array:
        """Return the relative loss of layer height off the guide.

        Parameters
        ----------
        points : (k, 3) array
            Points on the planes, mm.
        s : (k,) array
            Arc lengths of the planes, mm.

        Returns
        -------
        (k,) array
            Relative loss: 1 at the centre of curvature, negative on the opposite side.
        """
        foot = self.at(s)[0]
        step = DIFFERENCE_SHARE * float(np.diff(self.way).min())
        turn = (self.at(s + step)[1] - self.at(s - step)[1]) / (2.0 * step)
        share: Array = ((points - foot) * turn).sum(axis=1)
        return share

    def crossing(self, points: Array, triangles: Index, distances: Array) -> Array | None:
        """Return a point where normal planes of the guide intersect within a mesh.

        Planes intersect near the centre of curvature, or where the ends of an edge belong to
        distant planes.

        Parameters
        ----------
        points : (n, 3) array
            Vertices of the mesh, mm.
        triangles : (m, 3) int array
            Triangles.
        distances : (n,) array
            Arc lengths of the planes of the vertices, mm.

        Returns
        -------
        (3,) array or None
            A point, mm; None if the planes do not intersect.
        """
        bent = self.curvature_share(points, distances)
        if bent.max() > TIGHTEST:
            return np.asarray(points[bent.argmax()])
        start, end = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).T
        edges = np.linalg.norm(points[start] - points[end], axis=1)
        leaps = np.abs(distances[start] - distances[end]) > MAX_JUMP_RATIO * edges + 1e-6
        return np.asarray(points[start[leaps.argmax()]]) if leaps.any() else None

    def bend(self, distance: float, extent: float) -> float:
        """Return the approximate bend radius of beads, mm: the `extent` of the part, mm."""
        return extent

    @cached_property
    def _curve(self) -> CubicHermiteSpline:
        from scipy.interpolate import (
            CubicHermiteSpline,  # slow to import, and most jobs have no guide
        )

        return CubicHermiteSpline(self.way, self.points, self.tangents)

    @cached_property
    def _places(self) -> Array:
        share = np.arange(SEARCHED) / SEARCHED
        inner = (self.way[:-1, None] + np.diff(self.way)[:, None] * share).ravel()
        return np.asarray(np.r_[inner, self.way[-1:]])

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.at(self._places)[0])


def fit_guide(
    points: Array, tangents: Array, first_across: Array | None = None, start: float = 0.0
) -> Guide:
    """Build the guide through nodes.

    Parameters
    ----------
    points : (n, 3) array
        Nodes, mm.
    tangents : (n, 3) array
        Unit tangents.
    first_across : (3,) array or None, optional
        Direction that the first vector across the guide approaches; None for any.
    start : float, optional
        Length from the first node to the origin of arc length, mm.

    Returns
    -------
    Guide
        The guide.
    """
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    half = 0.5 * np.arccos(np.clip((tangents[1:] * tangents[:-1]).sum(axis=1), -1.0, 1.0))
    arc = chord * np.where(half > 1e-6, half / np.maximum(np.sin(half), 1e-12), 1.0)
    s = np.r_[0.0, np.cumsum(arc)] - start
    curve = Guide(points, tangents, s, _across(points, tangents))
    if first_across is None:
        return curve
    x, y = curve.frame(0.0)[:3, :2].T
    angle = np.arctan2(first_across @ y, first_across @ x)
    side = np.cross(tangents, curve.across)
    return Guide(points, tangents, s, np.cos(angle) * curve.across + np.sin(angle) * side)


def _across(points: Array, tangents: Array) -> Array:
    """Return twist-free unit vectors (n, 3) normal to a curve, by double reflection."""
    across = np.empty_like(points)
    lying = np.eye(3)[np.argmin(np.abs(tangents[0]))]
    across[0] = lying - (lying @ tangents[0]) * tangents[0]
    across[0] /= np.linalg.norm(across[0])
    for k in range(len(points) - 1):
        step = points[k + 1] - points[k]
        size = step @ step
        x = across[k] - 2.0 * (step @ across[k]) / size * step
        along = tangents[k] - 2.0 * (step @ tangents[k]) / size * step
        turn = tangents[k + 1] - along
        size = turn @ turn
        across[k + 1] = x - 2.0 * (turn @ x) / size * turn if size > 1e-24 else x
    return across
