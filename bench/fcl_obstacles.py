# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Flexible Collision Library in place of our tree of obstacles: the peer of `bench collision`.

It stands here and not in the workbench: a job has the same bytes on every machine, so that a library which is there on some
and answers a little otherwise has no place in planning. A scene takes what answers `find_touching` and `distance` as `Obstacles`
does, such as this. The library knows no frusta: a nozzle is a pyramid of SIDES sides within the round one, up to `off`
smaller than it.
"""

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
    """Answers `find_touching` and `distance` as `Obstacles` does of which it is made, but for beads of the layer being laid, which
    count in full."""

    def __init__(self, obstacles: Obstacles) -> None:
        count = len(obstacles.corners)
        self._rounding = np.zeros(count) if obstacles.radius is None else obstacles.radius
        self._since = obstacles.since
        self._all_round = float(self._rounding.max(initial=0.0))
        self._plain = bool(np.ptp(self._rounding) == 0.0 if count else True) and bool(
            (self._since == ALWAYS).all()
        )
        # the library gives its objects back as others: what tells them apart is where each has its origin
        places = obstacles.corners.mean(axis=1) + 1e-9 * np.arange(count)[:, None]
        self._numbers = {place.tobytes(): k for k, place in enumerate(places)}
        self._objects = [
            fcl.CollisionObject(_geometry(corners - place), fcl.Transform(place))
            for corners, place in zip(obstacles.corners, places)
        ]
        self._manager = fcl.DynamicAABBTreeCollisionManager()
        self._manager.registerObjects(self._objects)
        self._manager.setup()

    @staticmethod
    def off(solid: Frustum) -> float:
        """How much smaller than the round solid the one that is looked at is at most, mm."""
        return float((solid.radius + solid.slope * solid.high) * (1.0 - np.cos(np.pi / SIDES)))

    def find_touching(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        layer_start: Index | None = None,
    ) -> Mask:
        """(k,) whether solids with the tip (k, 3) and the unit axis (k, 3) meet an obstacle there before the moment (k,)."""
        if not self._plain or self._all_round > 0.0:
            near: Mask = self.distance(solid, tip, axis, moment) <= 0.0
            return near
        found = np.zeros(len(tip), dtype=bool)
        for k, moving in enumerate(self._moving(solid, tip, axis)):
            data = fcl.CollisionData()
            self._manager.collide(moving, data, fcl.defaultCollisionCallback)
            found[k] = data.result.is_collision
        return found

    def distance(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        reach: float = np.inf,
    ) -> Array:
        """(k,) mm from solids to the nearest obstacle there before the moment (k,), 0 where they meet, at most `reach`."""
        found = np.full(len(tip), reach)
        for k, moving in enumerate(self._moving(solid, tip, axis)):
            found[k] = min(self._least(moving, None if moment is None else int(moment[k])), reach)
        return np.maximum(found, 0.0)

    @staticmethod
    def _moving(solid: Frustum, tip: Array, axis: Array) -> Iterator[Any]:
        nozzle = _pyramid(solid)
        turned = smallest_rotation(np.array([0.0, 0.0, 1.0]), axis)
        for place, turn in zip(tip, turned):
            yield fcl.CollisionObject(nozzle, fcl.Transform(turn, place))

    def _least(self, moving: Any, moment: int | None) -> float:
        if self._plain:
            data = fcl.DistanceData(request=fcl.DistanceRequest(enable_signed_distance=False))
            self._manager.distance(moving, data, fcl.defaultDistanceCallback)
            return float(data.result.min_distance) - self._all_round
        least = np.inf

        def look(one: Any, other: Any, _: Any) -> tuple[bool, float]:
            nonlocal least
            number = self._number(one, other)
            if moment is None or self._since[number] < moment:
                away = fcl.distance(one, other, fcl.DistanceRequest(), fcl.DistanceResult())
                least = min(least, max(away, 0.0) - self._rounding[number])
            return least <= 0.0, least + self._all_round

        self._manager.distance(moving, None, look)
        return float(least)

    def _number(self, one: Any, other: Any) -> int:
        """Which of the obstacles is one of two objects."""
        number = self._numbers.get(np.asarray(one.getTranslation()).tobytes())
        return (
            self._numbers[np.asarray(other.getTranslation()).tobytes()]
            if number is None
            else number
        )


def _geometry(corners: Array) -> Any:
    if len(corners) == 3:
        return fcl.Convex(
            corners, 2, np.array([3, 0, 1, 2, 3, 0, 2, 1])
        )  # its triangles meet no convex solids
    if len(corners) == 4:
        return fcl.Convex(corners, 4, np.array([3, 0, 1, 3, 3, 0, 3, 2, 3, 0, 2, 1, 3, 1, 2, 3]))
    raise ValueError(
        f"obstacles of {len(corners)} points are not for fcl; use triangles or pieces of beads"
    )


def _pyramid(solid: Frustum) -> Any:
    """The solid, its axis along Z and its tip in the origin."""
    if np.ndim(solid.low):
        raise ValueError("fcl takes one nozzle for all looks; use one height that is left out")
    turn = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    rings = [
        np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(SIDES, height)])
        for height in (float(solid.low), solid.high)
        for radius in (solid.radius + solid.slope * height,)
    ]
    here = np.arange(SIDES)
    on = np.roll(here, -1)
    sides = np.column_stack([np.full(SIDES, 4), here, on, on + SIDES, here + SIDES]).ravel()
    ends = np.concatenate([[SIDES], here[::-1], [SIDES], here + SIDES])
    return fcl.Convex(np.concatenate(rings), SIDES + 2, np.concatenate([sides, ends]))
