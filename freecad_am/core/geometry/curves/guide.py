# SPDX-License-Identifier: LGPL-2.1-or-later
"""A guide curve that layers stand normal to: its points, frames that do not turn about it, and which of its planes a point
of a part belongs to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index

if TYPE_CHECKING:
    from scipy.interpolate import CubicHermiteSpline


SEARCHED = 4  # places between two nodes at which the nearest one is looked for
STEPS = 40  # of the search for a foot at most
EXACT = 1e-9  # mm along the guide
TIGHTEST = 0.95  # of the way to the centre of curvature
JUMP = 20.0  # mm along the guide to a mm of an edge, at most
SLOPE = 1e-3  # of a node's distance to the next, over which the turn of the tangent is taken


@dataclass(frozen=True, eq=False)
class Guide:
    """A curve without corners in the frame of what is cut along it, going on straight beyond both ends.

    points, tangents: (n, 3) nodes, mm, and unit directions in which it runs there. way: (n,) mm along it, rising; at 0 lies
    the first layer. across: (n, 3) unit vectors normal to it that do not turn about it (Wang 2008).
    """

    points: Array
    tangents: Array
    way: Array
    across: Array

    def at(self, way: Array) -> tuple[Array, Array]:
        """Points and unit tangents (k, 3) at places (k,) mm along it."""
        held = np.clip(way, self.way[0], self.way[-1])
        points = self._curve(held)
        tangents = self._curve(held, 1)
        tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
        return points + (way - held)[:, None] * tangents, tangents

    def frame(self, way: float) -> Array:
        """The pose (4, 4) of the plane normal to it at a place: Z along the guide."""
        points, tangents = self.at(np.array([way]))
        z = tangents[0]
        x = np.array([np.interp(way, self.way, column) for column in self.across.T])
        x -= (x @ z) * z
        x /= np.linalg.norm(x)
        pose = np.eye(4)
        pose[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
        pose[:3, 3] = points[0]
        return pose

    def reaches(self, way: float) -> bool:
        """Whether a place, mm along it, is between its ends."""
        return bool(self.way[0] <= way <= self.way[-1])

    def distance(self, points: Array) -> Array:
        """How far (...,) mm along the guide the plane normal to it is that each of the points (..., 3) lies in: the one
        whose foot is nearest."""
        flat = points.reshape(-1, 3)
        near = np.asarray(self._tree.query(flat)[1], dtype=np.intp)
        places = self._places
        low = np.where(near == 0, -np.inf, places[np.maximum(near - 1, 0)])
        high = np.where(
            near == len(places) - 1, np.inf, places[np.minimum(near + 1, len(places) - 1)]
        )
        found = places[near]
        for _ in range(STEPS):
            foot, along = self.at(found)
            ahead = ((flat - foot) * along).sum(axis=1)
            low, high = np.where(ahead > 0.0, found, low), np.where(ahead < 0.0, found, high)
            following = found + ahead / np.maximum(1.0 - self.bent(flat, found), 0.05)
            outside = (following < low) | (following > high)
            middle = np.where(np.isfinite(low) & np.isfinite(high), 0.5 * (low + high), following)
            following = np.where(outside, middle, following)
            done = float(np.abs(following - found).max(initial=0.0)) < EXACT
            found = following
            if done:
                break
        return np.asarray(found.reshape(points.shape[:-1]))

    def bent(self, points: Array, way: Array) -> Array:
        """By what share (k,) of what they are on the guide layers are lower at points (k, 3) of the planes at places (k,):
        1 where its centre of curvature is, below 0 on the other side."""
        foot = self.at(way)[0]
        step = SLOPE * float(np.diff(self.way).min())
        turn = (self.at(way + step)[1] - self.at(way - step)[1]) / (2.0 * step)
        found: Array = ((points - foot) * turn).sum(axis=1)
        return found

    def crossing(self, points: Array, triangles: Index, distances: Array) -> Array | None:
        """Where (3,) its planes cross one another within a mesh, whose points (n, 3) lie in those at distances (n,) mm along
        it: close to its centre of curvature, or where ends of an edge belong to planes far apart; None where none do."""
        bent = self.bent(points, distances)
        if bent.max() > TIGHTEST:
            return np.asarray(points[bent.argmax()])
        start, end = np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).T
        edges = np.linalg.norm(points[start] - points[end], axis=1)
        leaps = np.abs(distances[start] - distances[end]) > JUMP * edges + 1e-6
        return np.asarray(points[start[leaps.argmax()]]) if leaps.any() else None

    def bend(self, distance: float, extent: float) -> float:
        """The radius, mm, that beads of a part of an extent, mm, are about bent by."""
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


def guide(points: Array, tangents: Array, first: Array | None = None, start: float = 0.0) -> Guide:
    """The guide through nodes (n, 3) with unit tangents. start: mm along it from its first node to where 0 is counted from.
    first: (3,) what the first direction across it is there, or as near to that as is normal to it."""
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    half = 0.5 * np.arccos(np.clip((tangents[1:] * tangents[:-1]).sum(axis=1), -1.0, 1.0))
    arc = chord * np.where(half > 1e-6, half / np.maximum(np.sin(half), 1e-12), 1.0)
    way = np.r_[0.0, np.cumsum(arc)] - start
    made = Guide(points, tangents, way, _across(points, tangents))
    if first is None:
        return made
    x, y = made.frame(0.0)[:3, :2].T
    angle = np.arctan2(first @ y, first @ x)
    side = np.cross(tangents, made.across)
    return Guide(points, tangents, way, np.cos(angle) * made.across + np.sin(angle) * side)


def _across(points: Array, tangents: Array) -> Array:
    """Unit vectors (n, 3) normal to a curve that do not turn about it, by double reflection."""
    found = np.empty_like(points)
    lying = np.eye(3)[np.argmin(np.abs(tangents[0]))]
    found[0] = lying - (lying @ tangents[0]) * tangents[0]
    found[0] /= np.linalg.norm(found[0])
    for k in range(len(points) - 1):
        step = points[k + 1] - points[k]
        size = step @ step
        x = found[k] - 2.0 * (step @ found[k]) / size * step
        along = tangents[k] - 2.0 * (step @ tangents[k]) / size * step
        turn = tangents[k + 1] - along
        size = turn @ turn
        found[k + 1] = x - 2.0 * (turn @ x) / size * turn if size > 1e-24 else x
    return found
