# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collision scene of a nozzle or a link: bodies, including the platform, and deposit at a moment.

A moment is an index that rises in print order: the index of a point or of a motion row. At moment
m, a bead piece exists if the index of its last point is less than m.

Check rapids as follows. Build the deposit with `deposit.build_deposit` from the deposit rows of
the motion; pass the row indices as `moments`, and a `grain`. Add the platform as a body
(`geometry.obstacles.disc`). Check tips and axes along the moves in part coordinates; their moment
is the row at the end of the move. The solid is `travelling(...)`. Its `exempt` is 0 on travels. On
retract and approach it is (k,) `max(exempt_height(radius, slope, height) - d, 0)`, where d is the
distance between the tip and the deposit point that the tip leaves or approaches. `distance` returns
the clearance, mm.
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

PIECE = 8.0  # mm; maximum edge after subdivision: slender triangles have large bounding balls
REMEMBERED = 1_000  # maximum number of body triangles whose subdivision is cached
MOST_PIECES = 60_000  # maximum number of triangles after subdivision, or twice the input if larger


@dataclass(frozen=True)
class Bodies:
    """Body triangles and closed bodies near the checked solids; both exist at every moment."""

    triangles: Obstacles
    solids: tuple[Inside, ...]

    def find_touching(self, solid: Frustum, tip: Array, axis: Array) -> Mask:
        """Return whether solids meet a triangle or are inside a closed body.

        A solid that meets no triangle of a closed body is entirely inside or outside the body,
        so one point of the solid's axis decides.

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
            Maximum distance of interest, mm.

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
    """Build the triangles and closed bodies near points.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies in part coordinates; an open body contributes only its triangles.
    around : (n, 3) array
        The points, mm.
    reach : float
        Margin about the bounding box of the points, mm.
    max_edge : float, optional
        Maximum triangle edge after subdivision, mm.

    Returns
    -------
    Bodies
        Triangles and closed bodies that meet the enlarged box.
    """
    if not bodies:
        return Bodies(Obstacles(np.zeros((0, 3, 3))), ())
    low, high = around.min(axis=0) - reach, around.max(axis=0) + reach
    corners = np.concatenate([body.corners() for body in bodies])
    if len(corners) <= REMEMBERED and (corners >= low).all() and (corners <= high).all():
        triangles = _build_all(corners.tobytes(), max_edge)
    else:
        triangles = Obstacles(_cut_up(corners, low, high, max_edge))
    # a nozzle at one of the points can be inside a body only if the boxes meet
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
    """Subdivide all body triangles.

    The result is cached because most jobs check only a platform, several times.
    """
    triangles = np.frombuffer(corners).reshape(-1, 3, 3)
    return Obstacles(_cut_up(triangles, np.full(3, -np.inf), np.full(3, np.inf), max_edge))


def _cut_up(corners: Array, low: Array, high: Array, max_edge: float) -> Array:
    """Subdivide triangles (m, 3, 3) and return the pieces that meet a box."""
    count = len(corners)
    while True:
        corners = corners[_in_box(corners, low, high)]
        edges = sides(corners)
        # halve the longest edges first: MOST_PIECES then limits only the smaller triangles
        longest = np.maximum(np.maximum(edges[:, 0], edges[:, 1]), edges[:, 2])
        long = longest > max(max_edge, 0.5 * float(longest.max(initial=0.0)))
        if not long.any() or len(corners) + int(long.sum()) > max(MOST_PIECES, 2 * count):
            return corners
        corners = np.concatenate(
            [corners[~long], _halves(corners[long], edges[long].argmax(axis=1))]
        )


def _in_box(corners: Array, low: Array, high: Array) -> Mask:
    """Return whether the bounding boxes of triangles (m, 3, 3) meet the box from `low` to `high`.

    Axis by axis, this takes a fifth of the time of numpy reductions.
    """
    hits = np.ones(len(corners), dtype=bool)
    for axis in range(3):
        a, b, c = (corners[:, k, axis] for k in range(3))
        hits &= (np.minimum(np.minimum(a, b), c) <= high[axis]) & (
            np.maximum(np.maximum(a, b), c) >= low[axis]
        )
    return hits


def _halves(corners: Array, edge: Index) -> Array:
    """Bisect each triangle at the midpoint of one of its edges."""
    row = np.arange(len(corners))
    a, b, c = (corners[row, (edge + k) % 3] for k in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


LEAST_UPRIGHT = 0.25  # mm per mm of tool axis; minimum rise of a leaning nozzle's lower side


@dataclass(frozen=True)
class Nozzle:
    """Solids of one nozzle: `bodies` to check against bodies, `deposit` to check against deposit.

    Both omit the intended contact near the tip and allow for model deviations (`tolerances`).
    """

    bodies: Frustum
    deposit: Frustum

    @property
    def reach(self) -> float:
        """Maximum distance between the tip and a point of the nozzle, mm."""
        return max(self.bodies.reach, self.deposit.reach)

    @property
    def foot(self) -> float:
        """Diameter of the lower end of `deposit`, mm; the current bead surrounds this end."""
        return float(np.max(2.0 * (self.deposit.radius + self.deposit.slope * self.deposit.low)))

    def rows(self, index: Index) -> Nozzle:
        """Return the nozzles of rows `index`, as `Frustum.rows` does."""
        return Nozzle(self.bodies.rows(index), self.deposit.rows(index))

    def halfway(self) -> Nozzle:
        """Return the nozzle to check at midpoints between points where the nozzle is clear."""
        return self.larger(-HALFWAY)

    def larger(self, by: float) -> Nozzle:
        """Return the nozzle with its side and upper end offset outwards by `by` mm."""
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

    The tip is inside the bead that it prints, and adjacent beads overlap this bead by design. Up
    to the bead's height, deposit may therefore surround the nozzle, also under the lower side of a
    leaning nozzle. The minimum is the height at which the nozzle's side is one tip diameter from
    the tip.

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
        Height above the tip plane, mm.
    """
    upright = max(float(np.cos(lean) - slope * np.sin(lean)), LEAST_UPRIGHT)
    return max(side_height(radius, slope), (bead_height + radius * float(np.sin(lean))) / upright)


def depositing(
    radius: float, slope: float, length: float, bead_height: float, lean: float = 0.0
) -> Nozzle:
    """Return the nozzle solids to check on deposit moves.

    Contact with bodies is exempt only near the tip, where the nozzle touches its support.

    Parameters
    ----------
    radius : float
        Radius of the tip, mm.
    slope : float
        Tangent of the nozzle's half angle.
    length : float
        Length of the nozzle, mm.
    bead_height : float
        Maximum bead height, mm.
    lean : float, optional
        Planned angle between tool axis and build direction, rad.

    Returns
    -------
    Nozzle
        Solids to check against bodies and deposit.
    """
    return Nozzle(
        Frustum(radius, slope, side_height(radius, slope) + ABOVE_FACES, length),
        Frustum(radius, slope, exempt_height(radius, slope, bead_height, lean), length),
    )


def travelling(radius: float, slope: float, length: float, exempt: float | Array = 0.0) -> Nozzle:
    """Return the nozzle solids to check on a rapid.

    Parameters
    ----------
    radius : float
        Radius of the tip, mm.
    slope : float
        Tangent of the nozzle's half angle.
    length : float
        Length of the nozzle, mm.
    exempt : float or (k,) array, optional
        Exempt height above the tip, mm. On retract and approach: `exempt_height` minus the
        distance between the tip and the deposit point, at least 0.

    Returns
    -------
    Nozzle
        Solids to check against bodies and deposit.
    """
    return Nozzle(
        Frustum(max(radius - FACES, 0.0), slope, np.maximum(exempt, FACES), length),
        Frustum(max(radius - CHORD, 0.0), slope, np.maximum(exempt, CHORD), length),
    )


@dataclass(frozen=True)
class Scene:
    """Bodies, which exist at every moment, and deposit, whose pieces exist from their moments on.

    deposit: None without deposit; `InParts` supports contact tests but no distances.
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
            The k solids; a nozzle has separate solids for bodies and deposit.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Unit axes in part coordinates.
        moment : (k,) int array or None, optional
            Moment of each solid; only earlier deposit counts. None for all deposit.
        layer_start : (k,) int array or None, optional
            Moment at which the current layer of each solid began. Beads of this layer may
            touch the nozzle near the tip: within their width, only their path lines count.

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
            The k solids; a nozzle has separate solids for bodies and deposit.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Unit axes in part coordinates.
        moment : (k,) int array or None, optional
            Moment of each solid; only earlier deposit counts. None for all deposit.
        reach : float, optional
            Maximum distance of interest, mm.

        Returns
        -------
        (k,) array
            Distances, mm; 0 on contact, at most `reach`. Never above the true distance; below
            by at most tolerances.CONVERGED, except for grazing pairs.
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

        Inside a body, the distance to the body's triangles counts.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Unit axes in part coordinates.
        moment : (k,) int array
            Moment of each solid; only earlier deposit counts.
        reach : float
            Maximum distance of interest, mm.

        Returns
        -------
        distance : (k,) array
            Distances, mm; 0 on contact, at most `reach`.
        normal : (k, 3) array
            Unit vectors from the obstacle towards the solid; zero on contact or beyond
            reach.
        position : (k, 3) array
            Nearest points of the solids, mm.
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
    """Build the scene of a deposit and the bodies near points.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies in part coordinates.
    around : (n, 3) array
        The points, mm.
    reach : float
        Margin about the bounding box of the points, mm.
    deposit : Obstacles or InParts or None, optional
        The deposit, if any.

    Returns
    -------
    Scene
        The scene.
    """
    return Scene(build_bodies(bodies, around, reach), deposit)


def _all(moment: Index | None, count: int) -> Index:
    return np.full(count, np.iinfo(np.intp).max) if moment is None else moment
