# SPDX-License-Identifier: LGPL-2.1-or-later
"""Many points, segments or triangles in a tree of balls, and which nozzles they reach into or enclose."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .frustum import Array, Frustum, Mask
from .inside import Inside, inside_of
from .surroundings import Body

Index = NDArray[np.intp]

BRANCH = 8
QUERIES, PAIRS = 16384, 200_000  # worked on at once
PIECE = 8.0  # mm, longest edge of a triangle once it is cut up: slender triangles have large balls
MOST_PIECES = 60_000  # of all bodies; where there would be more, the pieces are longer


class Obstacles:
    """Points (m, 1, 3), segments (m, 2, 3) or triangles (m, 3, 3), kept in an order of their own.

    since: (m,) the moment from which each is there; none, then always. solids: closed bodies, always there, whose
    triangles are among the obstacles as far as nozzles reach.
    """

    def __init__(self, corners: Array, since: Index | None = None, solids: Sequence[Inside] = ()) -> None:
        order = _packed(corners.mean(axis=1))
        self.corners = corners = corners[order]
        self.solids = tuple(solids)
        self.since = np.full(len(corners), -1, dtype=np.intp) if since is None else since[order]
        self._levels = [self._balls(1)]
        if corners.shape[1] == 3:
            normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            size = np.linalg.norm(normal, axis=1)
            self._normal = normal / np.where(size > 0.0, size, 1.0)[:, None]
        while len(self._levels[-1][1]) > 2 * BRANCH:
            self._levels.append(self._balls(BRANCH ** len(self._levels)))

    def _balls(self, size: int) -> tuple[Array, Array, Index]:
        """Centres, radii and earliest moments of the balls about so many obstacles each."""
        starts = np.arange(0, len(self.corners), size)
        if not len(starts):
            return np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.intp)
        low = np.minimum.reduceat(self.corners.min(axis=1), starts)
        high = np.maximum.reduceat(self.corners.max(axis=1), starts)
        centre = 0.5 * (low + high)
        away = np.linalg.norm(self.corners - np.repeat(centre, size, axis=0)[: len(self.corners), None], axis=2).max(axis=1)
        return centre, np.maximum.reduceat(away, starts), np.minimum.reduceat(self.since, starts)

    def touched(self, nozzle: Frustum, tip: Array, axis: Array, moment: Index | None = None) -> Mask:
        """Whether nozzles with the tip (k, 3) and the unit axis (k, 3) meet an obstacle there before the moment (k,).

        A nozzle that meets no triangle of a closed body is inside it as a whole or not at all: a point of its axis says.
        """
        found = np.zeros(len(tip), dtype=bool)
        if nozzle.high <= nozzle.low:
            return found
        if len(self.corners):
            found = self._all_touched(nozzle, tip, axis, moment)
        for solid in self.solids:
            ends = [tip + height * axis for height in (nozzle.low, nozzle.high)]
            boxed = [((end > solid.low) & (end < solid.high)).all(axis=1) for end in ends]
            rows = np.flatnonzero(~found & boxed[0] & boxed[1])
            found[rows] = solid.holds(0.5 * (ends[0][rows] + ends[1][rows]))
        return found

    def _all_touched(self, nozzle: Frustum, tip: Array, axis: Array, moment: Index | None) -> Mask:
        found = np.zeros(len(tip), dtype=bool)
        if moment is None:
            moment = np.zeros(len(tip), dtype=np.intp)
        for first in range(0, len(tip), QUERIES):
            some = slice(first, first + QUERIES)
            found[some] = self._touched(nozzle, tip[some], axis[some], moment[some])
        return found

    def _touched(self, nozzle: Frustum, tip: Array, axis: Array, moment: Index) -> Mask:
        found = np.zeros(len(tip), dtype=bool)
        top = len(self._levels[-1][1])
        query, node = np.repeat(np.arange(len(tip)), top), np.tile(np.arange(top), len(tip))
        for depth in range(len(self._levels) - 1, -1, -1):
            centre, radius, since = self._levels[depth]
            near = (since[node] < moment[query])
            query, node = query[near], node[near]
            near = nozzle.near(centre[node] - tip[query], axis[query], radius[node])
            query, node = query[near], node[near]
            # one corner inside settles the matter without looking at all the rest
            sample = node * BRANCH**depth
            inside = nozzle.holds(self.corners[sample, 0] - tip[query], axis[query]) & (self.since[sample] < moment[query])
            found[query[inside]] = True
            left = ~found[query]
            query, node = query[left], node[left]
            if depth:
                child = (node[:, None] * BRANCH + np.arange(BRANCH)).ravel()
                query, node = np.repeat(query, BRANCH), child
                real = node < len(self._levels[depth - 1][1])
                query, node = query[real], node[real]
        for first in range(0, len(query), PAIRS):
            q, n = query[first : first + PAIRS], node[first : first + PAIRS]
            left = ~found[q]
            q, n = q[left], n[left]
            if self.corners.shape[1] == 3:
                normal = self._normal[n]
                level = np.einsum("ij,ij->i", normal, self.corners[n, 0] - tip[q])
                cut = nozzle.crossed(normal, level, axis[q])
                q, n = q[cut], n[cut]
            offset = self.corners[n] - tip[q, None]
            if self.corners.shape[1] == 1:
                meets = nozzle.holds(offset[:, 0], axis[q])
            elif self.corners.shape[1] == 2:
                meets = nozzle.meets_segments(offset[:, 0], offset[:, 1], axis[q])
            else:
                meets = nozzle.meets_triangles(offset, axis[q])
            found[q[meets]] = True
        return found


def _packed(points: Array) -> Index:
    """An order of points (n, 3) in which every ball of the tree holds neighbours: halves along the longest side of their
    box again and again, cut between whole balls."""
    order = np.arange(len(points))
    waiting = [(0, len(points), BRANCH ** int(np.log(max(len(points), 1)) / np.log(BRANCH) + 1))]
    while waiting:
        low, high, ball = waiting.pop()
        if high - low <= BRANCH:
            continue
        while ball >= high - low:
            ball //= BRANCH
        mine = order[low:high]
        some = points[mine]
        cut = -(-(high - low) // ball) // 2 * ball
        order[low:high] = mine[np.argpartition(some[:, np.argmax(np.ptp(some, axis=0))], cut)]
        waiting += [(low, low + cut, ball), (low + cut, high, ball)]
    return order


def of_bodies(bodies: Sequence[Body], around: Array, reach: float) -> Obstacles:
    """The triangles of bodies no farther than `reach` (mm) from the box about the points `around` (n, 3), and the inside of
    those that are closed; a body with an opening counts by its triangles alone."""
    low, high = around.min(axis=0) - reach, around.max(axis=0) + reach
    corners = np.concatenate([np.zeros((0, 3, 3)), *(body.corners() for body in bodies)])
    whole = len(corners)
    while True:
        corners = corners[((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)]
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        # halves of the longest edges first, so that where there is no room for more the largest are cut
        longest = edges.max(axis=1, initial=0.0)
        long = longest > max(PIECE, 0.5 * float(longest.max(initial=0.0)))
        if not long.any() or len(corners) + int(long.sum()) > max(MOST_PIECES, 2 * whole):
            break
        corners = np.concatenate([corners[~long], _halves(corners[long], edges[long].argmax(axis=1))])
    # only a body whose box reaches as far has room for a whole nozzle about one of the points
    near = [body for body in bodies if len(body.vertices) and (body.vertices.min(axis=0) <= high).all()
            and (body.vertices.max(axis=0) >= low).all()]
    return Obstacles(corners, solids=[solid for solid in map(inside_of, near) if solid is not None])


def _halves(corners: Array, edge: Index) -> Array:
    """Triangles cut in two through the middle of an edge each."""
    row = np.arange(len(corners))
    a, b, c = (corners[row, (edge + k) % 3] for k in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
