# SPDX-License-Identifier: LGPL-2.1-or-later
"""The obstacles of a nozzle or a link: bodies, including the platform, and the deposit at a moment.

A moment is a number that rises in print order: of a point, or of a row of a motion. A piece of a
bead exists before the moment m if the number of its last point is less than m.

To check rapids, the scene contains `deposit.build_deposit` of the deposit rows of the motion, with
the numbers of these rows as `moments` and a `grain`, and the platform as a body
(`geometry.obstacles.disc`). The checked positions along the moves are tips and axes in part
coordinates; their moment is the row at the end of the move. The solid is `nozzle.travelling(...)`.
On retract and approach, which run like travels, its `exempt` is (k,) `max(exempt_height(radius,
slope, height) - d, 0)`, with the distance d of each tip from the deposit point that it leaves or
approaches; on travels it is 0. `distance` gives the clearance in mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..geometry.columns import lengths, sides
from ..geometry.obstacles import Body
from ..types import Array, Index, Mask
from .deposit import InParts
from .frustum import Frustum, side_height
from .inside import Inside, inside_of
from .obstacles import Obstacles
from .separation import middles, shortest_vectors
from .tolerances import ABOVE_FACES, CHORD, FACES, HALFWAY

PIECE = 8.0  # mm, longest edge of a triangle once it is cut up: slender triangles have large balls
REMEMBERED = 1_000  # triangles of bodies that are kept as they are cut up
MOST_PIECES = 60_000  # of all bodies; beyond this number the pieces are longer


@dataclass(frozen=True)
class Bodies:
    """Triangles, and closed bodies within the reach of the solids to check; present at any moment."""

    triangles: Obstacles
    solids: tuple[Inside, ...]

    def find_touching(self, solid: Frustum, tip: Array, axis: Array) -> Mask:
        """Return whether solids meet a triangle or are inside a closed body.

        A solid that meets no triangle of a closed body is entirely inside or outside: one
        point of its axis decides.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips, mm.
        axis : (k, 3) array
            Unit axes.

        Returns
        -------
        (k,) bool array
            True on contact.
        """
        hits = self.triangles.find_touching(solid, tip, axis)
        rows = np.flatnonzero(~hits)
        hits[rows] = self._inside(solid.rows(rows), tip[rows], axis[rows])
        return hits

    def distance(self, solid: Frustum, tip: Array, axis: Array, reach: float) -> Array:
        """Return the distances from solids to the nearest body.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips, mm.
        axis : (k, 3) array
            Unit axes.
        reach : float
            Largest distance of interest, mm.

        Returns
        -------
        (k,) array
            Distances, mm; 0 on contact or inside a body, at most `reach`.
        """
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
    """Return the triangles and insides of bodies near some points.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies in part coordinates; an open body only has its triangles.
    around : (n, 3) array
        The points, mm.
    reach : float
        Distance from the box about the points, mm.
    max_edge : float, optional
        Longest edge of a triangle after subdivision, mm.

    Returns
    -------
    Bodies
        The bodies within reach.
    """
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
    """Subdivide all triangles of bodies, cached: most jobs only have their platform, and check it
    several times.
    """
    triangles = np.frombuffer(corners).reshape(-1, 3, 3)
    return Obstacles(_cut_up(triangles, np.full(3, -np.inf), np.full(3, np.inf), max_edge))


def _cut_up(corners: Array, low: Array, high: Array, max_edge: float) -> Array:
    """Triangles (m, 3, 3) in pieces, as far as these meet a box."""
    count = len(corners)
    while True:
        corners = corners[_in_box(corners, low, high)]
        edges = sides(corners)
        # halve the longest edges first, so that the largest triangles are divided if space runs out
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


LEAST_UPRIGHT = 0.25  # minimum rise of the lower side of a leaning nozzle per mm along its axis


@dataclass(frozen=True)
class Nozzle:
    """The same nozzle less what touches where it deposits, and less what bodies and beads are off their true places."""

    bodies: Frustum
    deposit: Frustum

    @property
    def reach(self) -> float:
        """Largest distance of a point of the nozzle from the tip, mm."""
        return max(self.bodies.reach, self.deposit.reach)

    @property
    def foot(self) -> float:
        """Diameter of the lower end to check against deposit, mm: around it is the current bead."""
        return float(np.max(2.0 * (self.deposit.radius + self.deposit.slope * self.deposit.low)))

    def rows(self, index: Index) -> Nozzle:
        """The nozzles of some of the rows, where they differ."""
        return Nozzle(self.bodies.rows(index), self.deposit.rows(index))

    def halfway(self) -> Nozzle:
        """The nozzle to check halfway between points where it is clear."""
        return self.larger(-HALFWAY)

    def larger(self, by: float) -> Nozzle:
        """The nozzle with its side and its upper end `by` mm farther out."""
        return Nozzle(
            *(
                replace(
                    solid,
                    radius=solid.radius + by * np.hypot(1.0, solid.slope),
                    high=solid.high + by,
                )
                for solid in (self.bodies, self.deposit)
            )
        )


def exempt_height(radius: float, slope: float, bead_height: float, lean: float = 0.0) -> float:
    """Return the height below which contact with deposit is exempt.

    The tip is in the bead that it prints, and adjacent beads overlap that bead by intention: up
    to the bead's height they may be around the nozzle, also below the lower side of a leaning
    one. The minimum is the height at which the nozzle's side is one tip diameter from the tip.

    Parameters
    ----------
    radius : float
        Radius of the tip, mm.
    slope : float
        Tangent of the nozzle's half angle.
    bead_height : float
        Height of the bead, mm.
    lean : float, optional
        Angle between tool axis and build direction, rad.

    Returns
    -------
    float
        Height over the tip plane, mm.
    """
    upright = max(float(np.cos(lean) - slope * np.sin(lean)), LEAST_UPRIGHT)
    return max(side_height(radius, slope), (bead_height + radius * float(np.sin(lean))) / upright)


def depositing(
    radius: float, slope: float, length: float, bead_height: float, lean: float = 0.0
) -> Nozzle:
    """Return the nozzle while it deposits.

    Bodies are exempt only as far as the nozzle touches its support.

    Parameters
    ----------
    radius : float
        Radius of the tip, mm.
    slope : float
        Tangent of the nozzle's half angle.
    length : float
        Length of the nozzle, mm.
    bead_height : float
        Height of the highest bead, mm.
    lean : float, optional
        Intended angle between tool axis and build direction, rad.

    Returns
    -------
    Nozzle
        The nozzle as tested against bodies and deposit.
    """
    return Nozzle(
        Frustum(radius, slope, side_height(radius, slope) + ABOVE_FACES, length),
        Frustum(radius, slope, exempt_height(radius, slope, bead_height, lean), length),
    )


def travelling(radius: float, slope: float, length: float, exempt: float | Array = 0.0) -> Nozzle:
    """Return the nozzle on a rapid.

    Parameters
    ----------
    radius : float
        Radius of the tip, mm.
    slope : float
        Tangent of the nozzle's half angle.
    length : float
        Length of the nozzle, mm.
    exempt : float or (k,) array, optional
        Height above the tip that is exempt, mm. On retract and approach it is
        `exempt_height` at the deposit point less the distance of the tip from it, at least
        0.

    Returns
    -------
    Nozzle
        The nozzle as tested against bodies and deposit.
    """
    return Nozzle(
        Frustum(max(radius - FACES, 0.0), slope, np.maximum(exempt, FACES), length),
        Frustum(max(radius - CHORD, 0.0), slope, np.maximum(exempt, CHORD), length),
    )


@dataclass(frozen=True)
class Scene:
    """bodies: present at any moment; deposit: from its moments on, None without any; as `InParts` it
    gives no distances.
    """

    bodies: Bodies
    deposit: Obstacles | InParts | None = None

    def find_touching(
        self,
        solid: Nozzle | Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        layer_start: Index | None = None,
    ) -> Mask:
        """Return whether solids meet a body or the deposit.

        Parameters
        ----------
        solid : Nozzle or Frustum
            The k solids; a nozzle has different ones for bodies and deposit.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Unit axes in part coordinates.
        moment : (k,) int array or None, optional
            Moments before which deposit counts; None for all deposit.
        layer_start : (k,) int array or None, optional
            Moments at which the current layers began. Their beads next to the tip,
            within their width, count as the lines of their points: they may touch the
            nozzle.

        Returns
        -------
        (k,) bool array
            True on contact.
        """
        nozzle = solid if isinstance(solid, Nozzle) else Nozzle(solid, solid)
        hits = self.bodies.find_touching(nozzle.bodies, tip, axis)
        if self.deposit is None:
            return hits
        rows = np.flatnonzero(~hits)
        when = _all(moment, len(tip))[rows]
        layer = None if layer_start is None else layer_start[rows]
        hits[rows] = self.deposit.find_touching(
            nozzle.deposit.rows(rows), tip[rows], axis[rows], when, layer
        )
        return hits

    def distance(
        self,
        solid: Nozzle | Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = 100.0,
    ) -> Array:
        """Return the distances between solids and the nearest body or deposit.

        Parameters
        ----------
        solid : Nozzle or Frustum
            The k solids; a nozzle has different ones for bodies and deposit.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Unit axes in part coordinates.
        moment : (k,) int array or None, optional
            Moments before which deposit counts; None for all deposit.
        reach : float, optional
            Largest distance of interest, mm.

        Returns
        -------
        (k,) array
            Distances, mm; 0 on contact, at most `reach`. Never too large; too small by
            at most tolerances.CONVERGED, except where both graze.
        """
        nozzle = solid if isinstance(solid, Nozzle) else Nozzle(solid, solid)
        distances = self.bodies.distance(nozzle.bodies, tip, axis, reach)
        if self.deposit is None:
            return distances
        assert not isinstance(self.deposit, InParts), "made for looks, not for distances"
        return np.minimum(
            distances,
            self.deposit.distance(nozzle.deposit, tip, axis, _all(moment, len(tip)), reach),
        )

    def nearest(
        self, solid: Frustum, tip: Array, axis: Array, moment: Index, reach: float
    ) -> tuple[Array, Array, Array]:
        """Find the nearest obstacle of each solid.

        A solid within a body counts by the body's triangles.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Unit axes in part coordinates.
        moment : (k,) int array
            Moments before which deposit counts.
        reach : float
            Largest distance of interest, mm.

        Returns
        -------
        distance : (k,) array
            Distances, mm; 0 on contact, at most `reach`.
        normal : (k, 3) array
            Unit vectors from the obstacle towards the solid; zero on contact or beyond
            reach.
        position : (k, 3) array
            The nearest points of the solids, mm.
        """
        gap = np.full(len(tip), reach)
        normal = np.zeros((len(tip), 3))
        position = np.zeros((len(tip), 3))
        assert not isinstance(self.deposit, InParts), "made for looks, not for distances"
        for obstacles in (
            self.bodies.triangles,
            *(() if self.deposit is None else (self.deposit,)),
        ):
            distances, nearest_ids = obstacles.nearest(solid, tip, axis, moment, reach)
            rows = np.flatnonzero(distances < gap)
            gap[rows] = distances[rows]
            corners = obstacles.corners[nearest_ids[rows]] - tip[rows, None]
            nearest_points, vectors = shortest_vectors(
                solid.rows(rows), axis[rows], corners, middles(corners)
            )
            size = lengths(vectors)
            normal[rows] = vectors / np.where(size > 0.0, size, 1.0)[:, None]
            position[rows] = tip[rows] + nearest_points + vectors
        normal[gap == 0.0] = 0.0
        return gap, normal, position


def scene(
    bodies: Sequence[Body], around: Array, reach: float, deposit: Obstacles | InParts | None = None
) -> Scene:
    """Return the scene of bodies near some points, and a deposit.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies in part coordinates.
    around : (n, 3) array
        The points, mm.
    reach : float
        Distance from the box about the points, mm.
    deposit : Obstacles or InParts or None, optional
        The deposit; None without one.

    Returns
    -------
    Scene
        The scene.
    """
    return Scene(build_bodies(bodies, around, reach), deposit)


def _all(moment: Index | None, count: int) -> Index:
    return np.full(count, np.iinfo(np.intp).max) if moment is None else moment
