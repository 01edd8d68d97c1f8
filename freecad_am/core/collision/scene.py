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
from .separation import middles, ways


@dataclass(frozen=True)
class Scene:
    """bodies: always there; deposit: from its moments on, None without any; in parts it tells no
    distances."""

    bodies: Bodies
    deposit: Obstacles | InParts | None = None

    def touched(
        self,
        solid: Nozzle | Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        own: Index | None = None,
    ) -> Mask:
        """(k,) whether solids with the tip (k, 3) and the axis (k, 3), in part coordinates, meet a body, or deposit that
        is there before the moment (k,); without moments, any deposit.

        own: (k,) the moment at which the layer being laid began. Its beads next to the tip, within their width, count as the
        lines they are laid along: they touch the nozzle rightly.
        """
        nozzle = solid if isinstance(solid, Nozzle) else Nozzle(solid, solid)
        found = self.bodies.touched(nozzle.bodies, tip, axis)
        if self.deposit is None:
            return found
        rows = np.flatnonzero(~found)
        when, layer = _all(moment, len(tip))[rows], None if own is None else own[rows]
        found[rows] = self.deposit.touched(
            nozzle.deposit.rows(rows), tip[rows], axis[rows], when, layer
        )
        return found

    def distance(
        self,
        solid: Nozzle | Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = 100.0,
    ) -> Array:
        """(k,) mm between solids and what is nearest to them, as `touched` sees them; 0 where they meet, at most `reach`.
        Never more than it is; less by no more than tolerances.CONVERGED, but where the two graze."""
        nozzle = solid if isinstance(solid, Nozzle) else Nozzle(solid, solid)
        found = self.bodies.distance(nozzle.bodies, tip, axis, reach)
        if self.deposit is None:
            return found
        assert not isinstance(self.deposit, InParts), "made for looks, not for distances"
        return np.minimum(
            found, self.deposit.distance(nozzle.deposit, tip, axis, _all(moment, len(tip)), reach)
        )

    def nearest(
        self, solid: Frustum, tip: Array, axis: Array, moment: Index, reach: float
    ) -> tuple[Array, Array, Array]:
        """Where solids are nearest to what is there before the moment (k,): by how many mm (k,), 0 where they meet, at most
        `reach`; unit vectors (k, 3) from there towards the solids, and the places (k, 3) of these; none where nothing is
        within reach or they meet. A solid within a body counts by the body's triangles."""
        gap, normal, place = (
            np.full(len(tip), reach),
            np.zeros((len(tip), 3)),
            np.zeros((len(tip), 3)),
        )
        assert not isinstance(self.deposit, InParts), "made for looks, not for distances"
        for obstacles in (
            self.bodies.triangles,
            *(() if self.deposit is None else (self.deposit,)),
        ):
            away, which = obstacles.nearest(solid, tip, axis, moment, reach)
            rows = np.flatnonzero(away < gap)
            gap[rows] = away[rows]
            corners = obstacles.corners[which[rows]] - tip[rows, None]
            there, way = ways(solid.rows(rows), axis[rows], corners, middles(corners))
            size = lengths(way)
            normal[rows] = way / np.where(size > 0.0, size, 1.0)[:, None]
            place[rows] = tip[rows] + there + way
        normal[gap == 0.0] = 0.0
        return gap, normal, place


def scene(
    bodies: Sequence[Body], around: Array, reach: float, deposit: Obstacles | InParts | None = None
) -> Scene:
    """The scene of bodies, as far as they are no farther than `reach` mm from the box about the points around (n, 3), and a
    deposit."""
    return Scene(build_bodies(bodies, around, reach), deposit)


def _all(moment: Index | None, count: int) -> Index:
    return np.full(count, np.iinfo(np.intp).max) if moment is None else moment
