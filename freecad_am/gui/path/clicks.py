# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicks on a path in the 3D view: which of the points that are shown is meant.

All points are brought onto the screen at once, which takes some hundredths of a second for 300,000 of them. Of those near
the mouse the foremost ones count, for they hide the others, and of these the nearest.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from pivy import coin
from PySide import QtCore, QtGui

from freecad_am.core.types import Array

REACH_PX = 8.0  # px from the mouse
STILL = 3  # px the mouse may move while the button is down
LOOK_EVERY = 15  # ms, whether the button has been let go
DEEP = 1.5  # widths of a bead, by how much points may lie behind the foremost


@dataclass(frozen=True, eq=False)
class Sight:
    """How a view shows a path. to_world, to_screen: (4, 4) for row vectors, the latter to -1..1. size: (2,) px of the view.
    toward: (3,) where its camera looks."""

    to_world: Array
    to_screen: Array
    size: Array
    toward: Array


class ClickNode:
    """A node in the scene of a path. `wanted` says whether anybody asks; `seen` gives points (n, 3) that are shown, how far
    what is drawn about them reaches, and the width of beads, mm; `clicked` is called with the number of one of them.

    The scene hears of a button that goes down; when it comes up again FreeCAD's selection may keep that to itself.
    Whoever wants to hear of clicks must hold this: the scene does not.
    """

    def __init__(
        self,
        wanted: Callable[[], bool],
        seen: Callable[[], tuple[Array, float, float]],
        clicked: Callable[[int], None],
    ) -> None:
        self.wanted, self.seen, self.clicked = wanted, seen, clicked
        self.node = coin.SoEventCallback()
        # pivy never gives back what it is handed here, so that is no more than a weak reference
        self.node.addEventCallback(
            coin.SoMouseButtonEvent.getClassTypeId(), _event, weakref.ref(self)
        )

    def event(self, node: Any) -> None:
        """The scene has heard of a button of the mouse."""
        event = node.getEvent()
        if (
            coin.SoMouseButtonEvent.isButtonPressEvent(event, coin.SoMouseButtonEvent.BUTTON1)
            and self.wanted()
        ):
            self._wait(_sight(node.getAction()), _pair(event.getPosition()), QtGui.QCursor.pos())

    def _wait(self, sight: Sight, place: Array, start: Any) -> None:
        """Until the button is let go; a mouse that has moved by then has turned the view, or drawn a frame."""
        if (QtGui.QCursor.pos() - start).manhattanLength() > STILL:
            return
        if QtGui.QApplication.mouseButtons() & QtCore.Qt.LeftButton:
            QtCore.QTimer.singleShot(LOOK_EVERY, lambda: self._wait(sight, place, start))
            return
        found = nearest(*self.seen(), sight, place)
        if found is not None:
            self.clicked(found)


def _event(listener: weakref.ref[ClickNode], node: Any) -> None:
    there = listener()
    if there is not None:
        there.event(node)


def _sight(action: Any) -> Sight:
    """How the view that an action goes through shows what is at its place in the scene."""
    region, volume = action.getViewportRegion(), coin.SoViewVolumeElement.get(action.getState())
    placed = coin.SoGetMatrixAction(region)  # an action for events knows no transformations
    placed.apply(action.getCurPath())
    # held by names: pivy frees what they are read from
    model, screen, toward = placed.getMatrix(), volume.getMatrix(), volume.getProjectionDirection()
    model, screen, toward = (np.array(one.getValue(), float) for one in (model, screen, toward))
    return Sight(model, screen, _pair(region.getViewportSizePixels()), toward)


def _pair(short: Any) -> Array:
    """(2,) of an SbVec2s, of which some versions of pivy give no values at once."""
    return np.array([short[0], short[1]], float)


def nearest(points: Array, reach: float, width: float, sight: Sight, place: Array) -> int | None:
    """The number of the point that is meant by a place on the screen (2,), px from its lower left; None where none is near.

    points: (n, 3). reach: mm about them that belongs to them. width: mm by which points may lie behind the foremost one,
    nearly.
    """
    world = points @ sight.to_world[:3, :3] + sight.to_world[3, :3]
    shown = world @ sight.to_screen[:3] + sight.to_screen[3]
    with np.errstate(divide="ignore", invalid="ignore"):
        flat = 0.5 * (shown[:, :2] / shown[:, 3:] + 1.0) * sight.size
    away = np.linalg.norm(flat - place, axis=1)
    with np.errstate(divide="ignore"):
        size = reach * 0.5 * sight.size[1] * np.linalg.norm(sight.to_screen[:3, 1]) / shown[:, 3]
    near = np.flatnonzero((away <= np.maximum(REACH_PX, size)) & (shown[:, 3] > 0.0))
    if not len(near):
        return None
    depth = world[near] @ sight.toward
    front = near[depth <= depth.min() + DEEP * width]
    return int(front[np.argmin(away[front])])
