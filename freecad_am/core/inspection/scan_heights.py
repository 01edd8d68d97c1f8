# SPDX-License-Identifier: LGPL-2.1-or-later
"""How high a scanned surface lies, along given directions: a smooth patch through the points around each place.

Patches are of second order and fitted with weights that fall with the distance (Cleveland 1979) and with Tukey's biweight,
so that points which lie off their neighbours, as spatter and reflections do, count nowhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..types import Array, Mask

AROUND = 64  # points that tell a patch
LEAST = 12  # of them that have to count
BIWEIGHT = (
    4.685  # times the spread of points about their patch beyond which they do not count (Tukey)
)
SPREAD = 1.4826  # of the standard deviation to the median of amounts
ROUNDS = 4
OFF_CENTRE = 0.5  # of a patch's radius that the middle of its points may be off the place: more, and it lies past an edge
WIDE = 3.0  # times wider than patches are as a rule: a hole in the scan
PIECE = 4000  # places that are looked at together
TINY_MM = 1e-6  # mm


@dataclass(frozen=True, eq=False)
class Heights:
    """Of m places: how far (m,) mm along its direction the scan lies from each, how much it rises there per mm (m,), and
    whether the scan covers the place (m,). What is not covered has the height nan."""

    off: Array
    slope: Array
    covered: Mask


@dataclass(frozen=True, eq=False)
class _Patches(Heights):
    """wide: (m,) over a hole in the scan."""

    wide: Mask


@dataclass(frozen=True, eq=False)
class Scan:
    """points: (n, 3) mm in part coordinates. label: of the file. within: mm from what was planned beyond which points are
    something else."""

    points: Array
    label: str
    within: float

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.points)

    @cached_property
    def _radius(self) -> float:
        """mm, of the patches of this scan as a rule."""
        some = self.points[np.unique(np.linspace(0, len(self.points) - 1, 400).astype(np.intp))]
        return float(
            np.median(np.asarray(self._tree.query(some, k=min(AROUND, len(self.points)))[0])[:, -1])
        )

    def heights(self, places: Array, ways: Array) -> Heights:
        """Heights above places (m, 3), m >= 1, along unit vectors (m, 3)."""
        if len(self.points) < LEAST:
            nothing = np.full(len(places), np.nan)
            return Heights(nothing, nothing, np.zeros(len(places), dtype=np.bool_))
        found = []
        for begin in range(0, len(places), PIECE):
            piece = slice(begin, begin + PIECE)
            first = self._patches(places[piece], ways[piece], rough=True)
            # again from where the surface is: what is nearest to that lies around it
            start = np.where(first.covered, first.off, 0.0)
            then = self._patches(places[piece] + start[:, None] * ways[piece], ways[piece])
            found.append(
                Heights(start + then.off, then.slope, first.covered & then.covered & ~then.wide)
            )
        off, slope, covered = (
            np.concatenate([getattr(one, name) for one in found])
            for name in ("off", "slope", "covered")
        )
        return Heights(np.where(covered, off, np.nan), slope, covered)

    def _patches(self, places: Array, ways: Array, rough: bool = False) -> _Patches:
        """rough: by planes alone."""
        _, near = self._tree.query(places, k=min(AROUND, len(self.points)))
        arm = self.points[near] - places[:, None]
        along, across = _sideways(ways)
        u, v, high = (np.einsum("mkc,mc->mk", arm, axis) for axis in (along, across, ways))
        radius = np.maximum(np.hypot(u, v).max(axis=1), TINY_MM)[:, None]
        u, v = u / radius, v / radius
        close = np.maximum(1.0 - np.hypot(u, v) ** 3, 0.0) ** 3 * (
            np.abs(high) <= 2.0 * self.within
        )
        flat = np.stack([np.ones_like(u), u, v], axis=2)
        bent = np.concatenate([flat, np.stack([u * u, u * v, v * v], axis=2)], axis=2)
        weight = close
        for columns in (flat,) if rough else (flat, bent):
            for _ in range(ROUNDS):
                solved = _solved(columns, high, weight)
                rest = np.abs(high - np.einsum("mkc,mc->mk", columns, solved))
                limit = BIWEIGHT * np.maximum(SPREAD * _median(rest, close > 0.0), TINY_MM)[:, None]
                weight = close * np.maximum(1.0 - (rest / limit) ** 2, 0.0) ** 2
        total = np.maximum(weight.sum(axis=1), TINY_MM)
        off_centre = np.hypot((weight * u).sum(axis=1), (weight * v).sum(axis=1)) / total
        covered = ((weight > 0.0).sum(axis=1) >= min(LEAST, near.shape[1])) & (
            off_centre <= OFF_CENTRE
        )
        slope = np.hypot(solved[:, 1], solved[:, 2]) / radius[:, 0]
        wide = radius[:, 0] > max(WIDE * self._radius, TINY_MM)
        return _Patches(np.where(covered, solved[:, 0], 0.0), slope, covered, wide)


def _sideways(ways: Array) -> tuple[Array, Array]:
    """Two unit vectors (m, 3) each that are square to unit vectors (m, 3) and to one another."""
    least = np.eye(3)[np.argmin(np.abs(ways), axis=1)]
    along = np.cross(ways, least)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return along, np.cross(ways, along)


def _solved(columns: Array, high: Array, weight: Array) -> Array:
    """Coefficients (m, c) of the weighted least squares of heights (m, k) in columns (m, k, c)."""
    weighted = columns * weight[:, :, None]
    system = np.einsum("mkc,mkd->mcd", weighted, columns)
    system += (
        1e-9 * np.maximum(weight.sum(axis=1), 1e-300)[:, None, None] * np.eye(columns.shape[2])
    )
    return np.asarray(
        np.linalg.solve(system, np.einsum("mkc,mk->mc", weighted, high)[:, :, None])[:, :, 0]
    )


def _median(values: Array, valid: Mask) -> Array:
    """Medians (m,) of those of values (m, k) that count; 0 of none."""
    ordered = np.sort(np.where(valid, values, np.inf), axis=1)
    count = valid.sum(axis=1)
    middle = ordered[np.arange(len(values)), np.maximum(count - 1, 0) // 2]
    return np.where(count > 0, middle, 0.0)
