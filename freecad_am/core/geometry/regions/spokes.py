# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spokes of a region: straight lines from its border, perpendicular to it, to the medial axis.

The end of a spoke is the centre of the largest circle inside the region that touches the border at
the spoke's foot. In order along the border, spokes visit each branch of the medial axis once on
each side, so a function on the axis is a function of the spoke.

The circles come from shrinking balls: J. Ma, S. W. Bae, S. Choi, "3D medial axis point
approximation using nearest neighbors and the normal field", The Visual Computer 28 (2012).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index, Mask
from .region import Region

NEAREST_PIECES = 16  # border pieces with the nearest midpoints to search for the nearest piece
SMOOTH_TURN = 0.3  # rad; a smaller corner is part of a curve, without a branch of the axis
SAME_START = 1e-6  # of the extent; distances from the centroid that differ by less are equal
SAME_PLACE = 1e-9  # of the longest edge; closer points coincide
MAX_SHRINKS = 40
SHRINK_TOLERANCE = 1e-6  # of the radius
MAX_HALVINGS = 8  # maximum bisections of an interval between spokes


@dataclass(frozen=True, eq=False)
class Spokes:
    """Spokes of a region in their order along its borders.

    Parameters
    ----------
    feet : ndarray, shape (n, 2)
        Points on the border, mm.
    directions : ndarray, shape (n, 2)
        Unit vectors into the region.
    radii : ndarray, shape (n,)
        Lengths of the spokes, mm; 0 at convex corners.
    following : ndarray, shape (n,)
        Index of the next spoke along the same border, material to the left.
    positions : ndarray, shape (n,)
        Positions of the feet along all borders: edge index plus fraction of the edge.
    opposite : ndarray, shape (n,)
        Position of the second contact of the circle with the border; nan without a contact.
    touching : ndarray, shape (n, 2)
        Point of the second contact, mm.
    """

    feet: Array
    directions: Array
    radii: Array
    following: Index
    positions: Array
    opposite: Array
    touching: Array

    @property
    def middles(self) -> Array:
        """Return the centres of the circles: points of the medial axis.

        Returns
        -------
        (n, 2) array
            mm.
        """
        return self.feet + self.radii[:, None] * self.directions


class _Border(NamedTuple):
    """Edges of all borders.

    starts, chords: (n, 2) mm. left: (n, 2) unit normals into the region. previous, following: (n,)
    indices of adjacent edges. turns: (n,) turn angle at the start of each edge, rad.
    """

    starts: Array
    chords: Array
    left: Array
    previous: Index
    following: Index
    turns: Array


class _Pieces(NamedTuple):
    """Short pieces of the border, with a search tree of their midpoints.

    edges: (m,) edge indices. shares: (m, 2) ends of each piece as fractions of its edge.
    """

    tree: cKDTree
    edges: Index
    shares: Array


class _Places(NamedTuple):
    """Positions on the border.

    edges, shares: (n,) edge indices and fractions along the edges. fans: (n,) at a reflex corner,
    direction between the normals of the previous edge (0) and of the edge itself (1).
    """

    edges: Index
    shares: Array
    fans: Array

    def select(self, chosen: Index | Mask) -> _Places:
        return _Places(self.edges[chosen], self.shares[chosen], self.fans[chosen])


def find_spokes(region: Region, step: float, tolerance: float, turn: float, cap: float) -> Spokes:
    """Find the spokes of a region.

    Parameters
    ----------
    region : Region
        Plane region with its holes, mm.
    step : float
        Maximum distance between feet on an edge, mm.
    tolerance : float
        Permitted error of linear interpolation of the radius between spokes, mm.
    turn : float
        Maximum angle between adjacent spokes at a reflex corner, rad.
    cap : float
        Maximum length of a spoke, mm; a circle of this radius may touch the border only once.
    """
    border = _border_of(region)
    pieces = _cut_pieces(border, step)
    places = _first_places(border, step, turn)
    radii, opposite = _measure(border, pieces, places, cap)
    places, radii, opposite = _refine(border, pieces, places, radii, opposite, tolerance, cap)
    feet, directions = _locate(border, places)
    return Spokes(
        feet,
        directions,
        radii,
        _following(border, places),
        places.edges + places.shares,
        opposite,
        _points_at(border, opposite),
    )


def _points_at(border: _Border, positions: Array) -> Array:
    """Return border points (n, 2) at positions (n,); nan where the position is nan."""
    edges = np.minimum(np.nan_to_num(positions).astype(np.intp), len(border.starts) - 1)
    return np.asarray(border.starts[edges] + (positions - edges)[:, None] * border.chords[edges])


def _border_of(region: Region) -> _Border:
    rings = _ordered_rings(region)
    counts = np.array([len(ring) for ring in rings])
    firsts = np.cumsum(counts) - counts
    starts = np.vstack(rings)
    number = np.arange(len(starts))
    ring = np.repeat(np.arange(len(rings)), counts)
    following = firsts[ring] + (number - firsts[ring] + 1) % counts[ring]
    previous = firsts[ring] + (number - firsts[ring] - 1) % counts[ring]
    chords = starts[following] - starts
    unit = chords / np.maximum(np.hypot(*chords.T), 1e-300)[:, None]
    before = unit[previous]
    turns = np.arctan2(
        before[:, 0] * unit[:, 1] - before[:, 1] * unit[:, 0], (before * unit).sum(axis=1)
    )
    return _Border(
        starts, chords, np.stack([-unit[:, 1], unit[:, 0]], axis=1), previous, following, turns
    )


def _ordered_rings(region: Region) -> list[Array]:
    """Return the borders (n, 2), mm, with an order and starts that rotate with the region.

    Holes are sorted by the distance of their mean points from the region's centroid. A border
    starts at the corner farthest from the centroid; among several, with the longest next edge.
    """
    middle = region.middle
    rings = []
    for ring in region.borders():
        away = np.hypot(*(ring - middle).T)
        ahead = np.hypot(*(np.roll(ring, -1, axis=0) - ring).T)
        grid = SAME_START * away.max()
        start = int(np.lexsort((np.rint(ahead / grid), np.rint(away / grid)))[-1])
        rings.append(np.roll(ring, -start, axis=0))
    outer, *holes = rings
    return [outer, *sorted(holes, key=lambda hole: float(np.hypot(*(hole.mean(axis=0) - middle))))]


def _cut_pieces(border: _Border, step: float) -> _Pieces:
    lengths = np.hypot(*border.chords.T)
    counts = np.maximum(np.ceil(lengths / step - 1e-9), 1.0).astype(np.intp)
    edges = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(edges)) - np.repeat(np.cumsum(counts) - counts, counts)
    shares = np.stack([number, number + 1], axis=1) / counts[edges][:, None]
    middles = border.starts[edges] + shares.mean(axis=1)[:, None] * border.chords[edges]
    return _Pieces(cKDTree(middles), edges, shares)


def _first_places(border: _Border, step: float, turn: float) -> _Places:
    """Return corners, fans at reflex corners, and edge positions at most `step` mm apart."""
    number = np.arange(len(border.starts))
    lengths = np.hypot(*border.chords.T)
    counts = np.maximum(np.ceil(lengths / step - 1e-9), 1.0).astype(np.intp)
    edges = np.repeat(number, counts)
    shares = (np.arange(len(edges)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[
        edges
    ]
    is_reflex = border.turns < -SMOOTH_TURN
    fan_counts = np.where(is_reflex, np.ceil(-border.turns / turn).astype(np.intp) + 1, 1)
    corners = np.repeat(number, fan_counts)
    ranks = np.arange(len(corners)) - np.repeat(np.cumsum(fan_counts) - fan_counts, fan_counts)
    fans = np.where(is_reflex[corners], ranks / np.maximum(fan_counts[corners] - 1, 1), 0.5)
    return _ordered(
        _Places(
            np.r_[edges, corners],
            np.r_[shares, np.zeros(len(corners))],
            np.r_[0.5 + 0 * shares, fans],
        )
    )


def _ordered(places: _Places) -> _Places:
    return places.select(np.lexsort((places.fans, places.shares, places.edges)))


def _locate(border: _Border, places: _Places) -> tuple[Array, Array]:
    """Return the feet (n, 2) and directions (n, 2) of spokes.

    Near a corner of a curve, directions rotate evenly over half the shorter edge on either side.
    """
    edges, shares = places.edges, places.shares
    feet = border.starts[edges] + shares[:, None] * border.chords[edges]
    lengths = np.hypot(*border.chords.T)
    blend = 0.5 * np.minimum(lengths, lengths[border.previous])  # mm, at the start of each edge
    half_turns = np.where(np.abs(border.turns) < SMOOTH_TURN, 0.5 * border.turns, 0.0)
    ends = border.following[edges]
    from_start = 1.0 - shares * lengths[edges] / blend[edges]
    from_end = 1.0 - (1.0 - shares) * lengths[edges] / blend[ends]
    angle = half_turns[ends] * np.maximum(from_end, 0.0) - half_turns[edges] * np.maximum(
        from_start, 0.0
    )
    at_corner = (shares == 0.0) & (half_turns[edges] == 0.0)
    angle = np.where(at_corner, (places.fans - 1.0) * border.turns[edges], angle)
    return feet, _rotated(border.left[edges], angle)


def _rotated(vectors: Array, angles: Array) -> Array:
    cos, sin = np.cos(angles), np.sin(angles)
    return np.stack(
        [
            vectors[:, 0] * cos - vectors[:, 1] * sin,
            vectors[:, 0] * sin + vectors[:, 1] * cos,
        ],
        axis=1,
    )


def _measure(border: _Border, pieces: _Pieces, places: _Places, cap: float) -> tuple[Array, Array]:
    """Return circle radii (n,), mm, and positions (n,) of the second contacts with the border."""
    feet, directions = _locate(border, places)
    radii = np.full(len(feet), float(cap))
    same_place = SAME_PLACE * float(np.abs(border.chords).max())
    opposite = np.full(len(feet), np.nan)
    convex = (places.shares == 0.0) & (border.turns[places.edges] > SMOOTH_TURN)
    radii[convex] = 0.0
    open_ = np.flatnonzero(~convex)
    for _ in range(MAX_SHRINKS):
        if not len(open_):
            break
        foot, direction, radius = feet[open_], directions[open_], radii[open_]
        middles = foot + radius[:, None] * direction
        points, positions, numbers = _nearest_border(border, pieces, middles)
        chord = points - foot[:, None]
        ahead = (chord * direction[:, None]).sum(axis=2)
        square = (chord * chord).sum(axis=2)
        facing = (border.left[numbers] * direction[:, None]).sum(axis=2)
        is_opposite = facing < math.cos(SMOOTH_TURN)
        is_opposite |= ahead > math.sin(0.5 * SMOOTH_TURN) * np.sqrt(square)
        is_opposite &= (ahead > 0.0) & (square > same_place**2)
        shrunk = np.where(is_opposite, square / np.maximum(2.0 * ahead, 1e-300), np.inf)
        best = np.argmin(shrunk, axis=1)
        row = np.arange(len(best))
        smaller = shrunk[row, best] < radius * (1.0 - SHRINK_TOLERANCE)
        open_ = open_[smaller]
        radii[open_] = shrunk[row, best][smaller]
        opposite[open_] = positions[row, best][smaller]
    return radii, opposite


def _nearest_border(border: _Border, pieces: _Pieces, points: Array) -> tuple[Array, Array, Index]:
    """Return the nearest points (n, k, 2) on the border pieces near points (n, 2).

    Also return their positions (n, k) and edges (n, k).
    """
    count = min(NEAREST_PIECES, len(pieces.edges))
    _, numbers = pieces.tree.query(points, k=[*range(1, count + 1)])
    edges, limits = pieces.edges[numbers], pieces.shares[numbers]
    starts, chords = border.starts[edges], border.chords[edges]
    gaps = points[:, None] - starts
    shares = (gaps * chords).sum(axis=2) / np.maximum((chords * chords).sum(axis=2), 1e-300)
    shares = np.clip(shares, limits[..., 0], limits[..., 1])
    positions = np.where(shares < 1.0, edges + shares, border.following[edges])
    return starts + shares[..., None] * chords, positions, edges


def _refine(
    border: _Border,
    pieces: _Pieces,
    places: _Places,
    radii: Array,
    opposite: Array,
    tolerance: float,
    cap: float,
) -> tuple[_Places, Array, Array]:
    """Add spokes where the radius between two spokes is not linear."""
    open_ = np.ones(len(radii), dtype=bool)
    for _ in range(MAX_HALVINGS):
        intervals = np.flatnonzero(open_)
        if not len(intervals):
            break
        following = _following(border, places)[intervals]
        added = _between(places, intervals, following)
        is_new = added.edges >= 0
        intervals, following, added = intervals[is_new], following[is_new], added.select(is_new)
        added_radii, added_opposite = _measure(border, pieces, added, cap)
        first, second = radii[intervals], radii[following]
        bent = np.abs(added_radii - 0.5 * (first + second)) > tolerance
        bent |= (added_radii > np.maximum(first, second)) | (
            _near_summit(border, places, radii)[intervals] & (np.abs(first - second) > tolerance)
        )
        added = added.select(bent)
        still_open = np.zeros(len(radii), dtype=bool)
        still_open[intervals[bent]] = True
        edges = np.concatenate([places.edges, added.edges])
        shares = np.concatenate([places.shares, added.shares])
        fans = np.concatenate([places.fans, added.fans])
        order = np.lexsort((fans, shares, edges))
        places = _Places(edges[order], shares[order], fans[order])
        radii = np.concatenate([radii, added_radii[bent]])[order]
        opposite = np.concatenate([opposite, added_opposite[bent]])[order]
        open_ = np.concatenate([still_open, np.ones(len(added.edges), dtype=bool)])[order]
    return places, radii, opposite


def _near_summit(border: _Border, places: _Places, radii: Array) -> Mask:
    """Return whether the interval after each spoke has a local radius maximum at either end."""
    following = _following(border, places)
    previous = np.empty_like(following)
    previous[following] = np.arange(len(following))
    is_summit = (radii >= radii[previous]) & (radii >= radii[following])
    return is_summit | is_summit[following]


def _following(border: _Border, places: _Places) -> Index:
    """Return the index of the next spoke along the border."""
    counts = np.bincount(places.edges, minlength=len(border.starts))
    firsts = np.cumsum(counts) - counts
    number = np.arange(len(places.edges))
    is_last = number == firsts[places.edges] + counts[places.edges] - 1
    return np.where(is_last, firsts[border.following[places.edges]], number + 1)


def _between(places: _Places, first: Index, second: Index) -> _Places:
    """Return positions midway between consecutive positions; edge -1 where none is between."""
    a, b = places.select(first), places.select(second)
    same_corner = (a.edges == b.edges) & (a.shares == 0.0) & (b.shares == 0.0)
    ends = np.where(a.edges == b.edges, b.shares, 1.0)
    edges = np.where(same_corner & (a.fans == b.fans), -1, a.edges)
    shares = np.where(same_corner, 0.0, 0.5 * (a.shares + ends))
    fans = np.where(same_corner, 0.5 * (a.fans + b.fans), 0.5)
    return _Places(edges, shares, fans)
