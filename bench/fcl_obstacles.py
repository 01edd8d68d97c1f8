# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Flexible Collision Library as a replacement for our obstacle tree: the peer of `bench
collision`. It belongs to the benchmark only. A job must give the same bytes on every machine, so
planning cannot use a library that only some machines have and whose answers differ slightly. A
scene accepts any object that answers `find_touching` and `distance` like `Obstacles`. The library
has no frusta: a nozzle becomes an inscribed pyramid of SIDES sides, up to `max_difference` smaller."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import fcl
import numpy as np

from freecad_am.core.collision.frustum import Frustum
from freecad_am.core.collision.obstacles import ALWAYS, Obstacles
from freecad_am.core.geometry.frames import smallest_rotation
from freecad_am.core.types import Array, Index, Mask

SIDES = 64


class FclObstacles:
    """Answer `find_touching` and `distance` like the `Obstacles` it is built from, except that
    beads of the current layer count in full."""

    def __init__(self, obstacles: Obstacles) -> None:
        count = len(obstacles.corners)
        self._rounding = np.zeros(count) if obstacles.radius is None else obstacles.radius
        self._since = obstacles.since
        self._all_round = float(self._rounding.max(initial=0.0))
        self._plain = bool(np.ptp(self._rounding) == 0.0 if count else True) and bool(
            (self._since == ALWAYS).all()
        )
        # the library returns its objects as new wrappers; their origins identify them
        centres = obstacles.corners.mean(axis=1) + 1e-9 * np.arange(count)[:, None]
        self._numbers = {centre.tobytes(): k for k, centre in enumerate(centres)}
        self._objects = [
            fcl.CollisionObject(_geometry(corners - centre), fcl.Transform(centre))
            for corners, centre in zip(obstacles.corners, centres)
        ]
        self._manager = fcl.DynamicAABBTreeCollisionManager()
        self._manager.registerObjects(self._objects)
        self._manager.setup()

    @staticmethod
    def max_difference(solid: Frustum) -> float:
        """Maximum difference (mm) between the round solid and the pyramid that replaces it."""
        return float((solid.radius + solid.slope * solid.high) * (1.0 - np.cos(np.pi / SIDES)))

    def find_touching(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        layer_start: Index | None = None,
    ) -> Mask:
        """Return (k,) whether solids with tip (k, 3) and unit axis (k, 3) touch an obstacle
        deposited before the moment (k,)."""
        if not self._plain or self._all_round > 0.0:
            touching: Mask = self.distance(solid, tip, axis, moment) <= 0.0
            return touching
        contacts = np.zeros(len(tip), dtype=bool)
        for k, moving in enumerate(self._moving(solid, tip, axis)):
            data = fcl.CollisionData()
            self._manager.collide(moving, data, fcl.defaultCollisionCallback)
            contacts[k] = data.result.is_collision
        return contacts

    def distance(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = np.inf,
    ) -> Array:
        """Return (k,) mm from solids to the nearest obstacle deposited before the moment (k,): 0 in
        contact, at most `reach`."""
        distances = np.full(len(tip), reach)
        for k, moving in enumerate(self._moving(solid, tip, axis)):
            distances[k] = min(
                self._least(moving, None if moment is None else int(moment[k])), reach
            )
        return np.maximum(distances, 0.0)

    @staticmethod
    def _moving(solid: Frustum, tip: Array, axis: Array) -> Iterator[Any]:
        nozzle = _pyramid(solid)
        turned = smallest_rotation(np.array([0.0, 0.0, 1.0]), axis)
        for point, turn in zip(tip, turned):
            yield fcl.CollisionObject(nozzle, fcl.Transform(turn, point))

    def _least(self, moving: Any, moment: int | None) -> float:
        if self._plain:
            data = fcl.DistanceData(request=fcl.DistanceRequest(enable_signed_distance=False))
            self._manager.distance(moving, data, fcl.defaultDistanceCallback)
            return float(data.result.min_distance) - self._all_round
        minimum = np.inf

        def look(first: Any, second: Any, _: Any) -> tuple[bool, float]:
            nonlocal minimum
            number = self._number(first, second)
            if moment is None or self._since[number] < moment:
                gap = fcl.distance(first, second, fcl.DistanceRequest(), fcl.DistanceResult())
                minimum = min(minimum, max(gap, 0.0) - self._rounding[number])
            return minimum <= 0.0, minimum + self._all_round

        self._manager.distance(moving, None, look)
        return float(minimum)

    def _number(self, first: Any, second: Any) -> int:
        """Return the index of the obstacle among two objects."""
        number = self._numbers.get(np.asarray(first.getTranslation()).tobytes())
        return (
            self._numbers[np.asarray(second.getTranslation()).tobytes()]
            if number is None
            else number
        )


def _geometry(corners: Array) -> Any:
    if len(corners) == 3:
        return fcl.Convex(
            corners, 2, np.array([3, 0, 1, 2, 3, 0, 2, 1])
        )  # its triangles do not touch convex solids
    if len(corners) == 4:
        return fcl.Convex(corners, 4, np.array([3, 0, 1, 3, 3, 0, 3, 2, 3, 0, 2, 1, 3, 1, 2, 3]))
    raise ValueError(
        f"obstacles of {len(corners)} points are not for fcl; use triangles or pieces of beads"
    )


def _pyramid(solid: Frustum) -> Any:
    """Build the solid with its axis along Z and its tip at the origin."""
    if np.ndim(solid.low):
        raise ValueError("fcl takes one nozzle for all looks; use one height that is left out")
    turn = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    rings = [
        np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(SIDES, height)])
        for height in (float(solid.low), solid.high)
        for radius in (solid.radius + solid.slope * height,)
    ]
    corners = np.arange(SIDES)
    next_corners = np.roll(corners, -1)
    sides = np.column_stack(
        [np.full(SIDES, 4), corners, next_corners, next_corners + SIDES, corners + SIDES]
    ).ravel()
    ends = np.concatenate([[SIDES], corners[::-1], [SIDES], corners + SIDES])
    return fcl.Convex(np.concatenate(rings), SIDES + 2, np.concatenate([sides, ends]))
