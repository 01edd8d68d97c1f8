# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicks on a path in the 3D view: which of the points that are shown is meant.

All points are brought onto the screen at once, which takes some hundredths of a second for 300,000 of them. Of those near
the mouse the foremost ones count, for they hide the others, and of these the nearest.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from pivy import coin

from ..lines import Array

NEAR = 8.0  # px from the mouse
STILL = 3  # px the mouse may move while the button is down
DEEP = 1.5  # widths of a bead, by how much points may lie behind the foremost


class ClickNode:
    """A node in the scene of a path. `wanted` says whether anybody asks; `seen` gives points (n, 3) that are shown and the
    width of beads, mm; `clicked` is called with the number of one of them."""

    def __init__(
        self, wanted: Callable[[], bool], seen: Callable[[], tuple[Array, float]], clicked: Callable[[int], None]
    ) -> None:
        self.wanted, self.seen, self.clicked = wanted, seen, clicked
        self.pressed: tuple[int, int] | None = None
        self.node = coin.SoEventCallback()
        self.node.addEventCallback(coin.SoMouseButtonEvent.getClassTypeId(), self._event, None)

    def _event(self, data: Any, node: Any) -> None:
        event, left = node.getEvent(), coin.SoMouseButtonEvent.BUTTON1
        place = event.getPosition().getValue()
        if coin.SoMouseButtonEvent.isButtonPressEvent(event, left):
            self.pressed = (place[0], place[1])
        elif coin.SoMouseButtonEvent.isButtonReleaseEvent(event, left) and self.pressed is not None:
            before, self.pressed = self.pressed, None
            moved = max(abs(place[0] - before[0]), abs(place[1] - before[1]))
            if moved <= STILL and self.wanted():
                self._click(node.getAction(), np.array([place[0], place[1]], float))

    def _click(self, action: Any, place: Array) -> None:
        points, width = self.seen()
        state = action.getState()
        size = np.array(action.getViewportRegion().getViewportSizePixels().getValue(), float)
        volume, model = coin.SoViewVolumeElement.get(state), coin.SoModelMatrixElement.get(state)
        to_world, to_screen = (np.array(one.getValue()) for one in (model, volume.getMatrix()))
        toward = np.array(volume.getProjectionDirection().getValue())
        found = nearest(points, to_world, to_screen, size, toward, place, width)
        if found is not None:
            self.clicked(found)


def nearest(
    points: Array, to_world: Array, to_screen: Array, size: Array, toward: Array, place: Array, width: float
) -> int | None:
    """The number of the point that is meant by a place on the screen (2,), px; None where none is near.

    points: (n, 3). to_world, to_screen: (4, 4) for row vectors, the latter to -1..1. size: (2,) px of the view. toward: (3,)
    where the camera looks. width: mm by which points may lie behind the foremost one, nearly.
    """
    world = points @ to_world[:3, :3] + to_world[3, :3]
    shown = world @ to_screen[:3] + to_screen[3]
    with np.errstate(divide="ignore", invalid="ignore"):
        flat = 0.5 * (shown[:, :2] / shown[:, 3:] + 1.0) * size
    away = np.linalg.norm(flat - place, axis=1)
    near = np.flatnonzero((away <= NEAR) & (shown[:, 3] > 0.0))
    if not len(near):
        return None
    depth = world[near] @ toward
    front = near[depth <= depth.min() + DEEP * width]
    return int(front[np.argmin(away[front])])
