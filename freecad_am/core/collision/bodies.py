# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies as obstacles: their triangles, large ones divided, and the inside of closed bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..geometry.columns import sides
from ..geometry.obstacles import Body
from ..types import Array, Index, Mask
from .frustum import Frustum
from .inside import Inside, inside_of
from .obstacles import Obstacles

PIECE = 8.0  # mm, longest edge of a triangle once it is cut up: slender triangles have large balls
REMEMBERED = 1_000  # triangles of bodies that are kept as they are cut up
MOST_PIECES = 60_000  # of all bodies; where there would be more, the pieces are longer


@dataclass(frozen=True)
class Bodies:
    """Triangles, and closed bodies within the reach of the solids to check; present at any moment."""

    triangles: Obstacles
    solids: tuple[Inside, ...]

    def find_touching(self, solid: Frustum, tip: Array, axis: Array) -> Mask:
        """Return whether (k,) solids with the tip (k, 3) and the unit axis (k, 3) meet a triangle or are
        inside a closed body.

        A solid that meets no triangle of a closed body is entirely inside or outside: one point of its
        axis decides.
        """
        hits = self.triangles.find_touching(solid, tip, axis)
        rows = np.flatnonzero(~hits)
        hits[rows] = self._inside(solid.rows(rows), tip[rows], axis[rows])
        return hits

    def distance(self, solid: Frustum, tip: Array, axis: Array, reach: float) -> Array:
        """(k,) mm from solids to the nearest body, 0 where they meet one or are inside it, at most `reach`."""
        distances = self.triangles.distance(solid, tip, axis, reach=reach)
        rows = np.flatnonzero(distances > 0.0)
        distances[rows[self._inside(solid.rows(rows), tip[rows], axis[rows])]] = 0.0
        return distances

    def _inside(self, solid: Frustum, tip: Array, axis: Array) -> Mask:
        hits = np.zeros(len(tip), dtype=bool)
        if not self.solids or not np.any(solid.high > solid.low):
            return hits
        low = np.broadcast_to(solid.low, len(tip))[:, None]
        ends = [tip + height * axis for height in (low, solid.high)]
        for body in self.solids:
            rows = np.flatnonzero(~hits & body.may_hold(ends[0]) & body.may_hold(ends[1]))
            if len(rows):
                hits[rows] = body.holds(0.5 * (ends[0][rows] + ends[1][rows]))
        return hits


def build_bodies(
    bodies: Sequence[Body], around: Array, reach: float, max_edge: float = PIECE
) -> Bodies:
    """The triangles of bodies no farther than `reach` (mm) from the box about the points `around` (n, 3), and the inside of
    those that are closed; a body with an opening counts by its triangles alone. max_edge: mm, the longest edge of a triangle
    once it is cut up."""
    if not bodies:
        return Bodies(Obstacles(np.zeros((0, 3, 3))), ())
    low, high = around.min(axis=0) - reach, around.max(axis=0) + reach
    corners = np.concatenate([body.corners() for body in bodies])
    if len(corners) <= REMEMBERED and (corners >= low).all() and (corners <= high).all():
        triangles = _build_all(corners.tobytes(), max_edge)
    else:
        triangles = Obstacles(_cut_up(corners, low, high, max_edge))
    # only a body whose box reaches as far has room for a whole nozzle about one of the points
    nearby = [
        body
        for body in bodies
        if len(body.vertices)
        and (body.vertices.min(axis=0) <= high).all()
        and (body.vertices.max(axis=0) >= low).all()
    ]
    return Bodies(triangles, tuple(solid for solid in map(inside_of, nearby) if solid is not None))


@lru_cache(maxsize=1)
def _build_all(corners: bytes, max_edge: float) -> Obstacles:
    """All triangles of bodies, cut up, once for the same ones: most jobs have their platform alone, and plan and look at
    it several times."""
    triangles = np.frombuffer(corners).reshape(-1, 3, 3)
    return Obstacles(_cut_up(triangles, np.full(3, -np.inf), np.full(3, np.inf), max_edge))


def _cut_up(corners: Array, low: Array, high: Array, max_edge: float) -> Array:
    """Triangles (m, 3, 3) in pieces, as far as these meet a box."""
    count = len(corners)
    while True:
        corners = corners[_in_box(corners, low, high)]
        edges = sides(corners)
        # halves of the longest edges first, so that where there is no room for more the largest are cut
        longest = np.maximum(np.maximum(edges[:, 0], edges[:, 1]), edges[:, 2])
        long = longest > max(max_edge, 0.5 * float(longest.max(initial=0.0)))
        if not long.any() or len(corners) + int(long.sum()) > max(MOST_PIECES, 2 * count):
            return corners
        corners = np.concatenate(
            [corners[~long], _halves(corners[long], edges[long].argmax(axis=1))]
        )


def _in_box(corners: Array, low: Array, high: Array) -> Mask:
    """(m,) whether the boxes of triangles (m, 3, 3) meet another one; axis by axis, in a fifth of the time of reductions."""
    hits = np.ones(len(corners), dtype=bool)
    for axis in range(3):
        a, b, c = (corners[:, k, axis] for k in range(3))
        hits &= (np.minimum(np.minimum(a, b), c) <= high[axis]) & (
            np.maximum(np.maximum(a, b), c) >= low[axis]
        )
    return hits


def _halves(corners: Array, edge: Index) -> Array:
    """Triangles cut in two through the middle of an edge each."""
    row = np.arange(len(corners))
    a, b, c = (corners[row, (edge + k) % 3] for k in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
