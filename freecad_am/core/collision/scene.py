# SPDX-License-Identifier: LGPL-2.1-or-later
"""All that a nozzle or a link may meet: bodies, the platform as one of them, and the deposit as it is at a moment.

A moment is a number that rises in the order of deposition: of a point, or of a row of a motion. A piece of a bead is there
before the moment m where the number of its last point is less than m.

How rapids are asked: the scene has `deposit.build_deposit` of the deposit rows of the motion, with the numbers of these rows
as `moments` and a `grain`, and the platform as a body (`geometry.obstacles.disc`). The looks along the moves are tips
and axes in part coordinates, their moment is the row that the move goes to; the solid is `nozzle.travelling(...)`. On
retract and approach, which are driven like travels, its `exempt` is (k,) `max(exempt_height(radius, slope, height) - d, 0)`,
d being how far the tip of each look is from the deposit point that it leaves or goes to; on travels it is 0. `distance`
tells by how many mm a way is clear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.columns import lengths
from ..geometry.obstacles import Body
from ..types import Array, Index, Mask
from .bodies import Bodies, build_bodies
from .deposit import InParts
from .frustum import Frustum
from .nozzle import Nozzle
from .obstacles import Obstacles
from .separation import middles, shortest_vectors


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
        """Return whether (k,) solids with the tip (k, 3) and the axis (k, 3), in part coordinates, meet a
        body, or deposit that exists before the moment (k,); without moments, any deposit.

        layer_start: (k,) the moment at which the current layer began. Its beads next to the tip, within
        their width, count as the lines of their points: they may touch the nozzle.
        """
        nozzle = solid if isinstance(solid, Nozzle) else Nozzle(solid, solid)
        hits = self.bodies.find_touching(nozzle.bodies, tip, axis)
        if self.deposit is None:
            return hits
        rows = np.flatnonzero(~hits)
        when, layer = (
            _all(moment, len(tip))[rows],
            None if layer_start is None else layer_start[rows],
        )
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
        """Return the distances (k,) mm between solids and the nearest body or deposit, as `find_touching`
        has them; 0 if they meet, at most `reach`.

        The value is never too large; it is too small by at most tolerances.CONVERGED, except where both
        graze.
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
        """Find the nearest obstacle present before the moment (k,) for each solid.

        Returns the distances (k,) mm, 0 for contact and at most `reach`; unit vectors (k, 3) from the
        obstacle towards the solid; and the points (k, 3) of the solids. Vectors are zero if nothing is
        within reach or they meet. A solid within a body counts by the body's triangles.
        """
        gap, normal, position = (
            np.full(len(tip), reach),
            np.zeros((len(tip), 3)),
            np.zeros((len(tip), 3)),
        )
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
    """The scene of bodies, as far as they are no farther than `reach` mm from the box about the points around (n, 3), and a
    deposit."""
    return Scene(build_bodies(bodies, around, reach), deposit)


def _all(moment: Index | None, count: int) -> Index:
    return np.full(count, np.iinfo(np.intp).max) if moment is None else moment
