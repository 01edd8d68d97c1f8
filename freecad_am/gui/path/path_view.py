# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common code of the views of toolpaths and joint paths: colours, legend, lines or tubes, and the
visible stretch.
"""

from __future__ import annotations

import contextlib
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from pivy import coin
from PySide import QtCore, QtGui

from ...core.issues import InputError
from ...core.types import Array
from ...objects.fields import preferences
from ...objects.fields.preferences import ORDINARY, scale_of
from ..in_language import marked
from ..views.base import StageView
from . import legend
from .colouring import Scale
from .pieces import PathNodes, Rows

REACH_PX = 8.0  # px; maximum distance of a clicked point from the mouse
STILL = 3  # px; maximum mouse motion during a click
LOOK_EVERY = 15  # ms; interval of checks whether the button is released
DEEP = 1.5  # in bead widths: depth tolerance of points behind the foremost point


@dataclass(frozen=True, eq=False)
class Sight:
    """The projection of a view.

    to_world, to_screen: (4, 4) for row vectors, the latter to -1..1. size: (2,) px of the view.
    toward: (3,) viewing direction of the camera.
    """

    to_world: Array
    to_screen: Array
    size: Array
    toward: Array


class ClickNode:
    """A node in the scene of a path that reports clicked points.

    `is_active` returns whether a listener is active. `visible_points` returns the visible points
    (n, 3), the radius of their drawing and the bead width, mm. `clicked` is called with the index
    of the clicked point.

    The scene receives button presses, but FreeCAD's selection may consume the releases. The caller
    must keep a reference to this object, because the scene does not.
    """

    def __init__(
        self,
        is_active: Callable[[], bool],
        visible_points: Callable[[], tuple[Array, float, float]],
        clicked: Callable[[int], None],
    ) -> None:
        self.wanted, self.seen, self.clicked = is_active, visible_points, clicked
        self.node = coin.SoEventCallback()
        # pivy never releases this object, so pass a weak reference
        self.node.addEventCallback(
            coin.SoMouseButtonEvent.getClassTypeId(), _event, weakref.ref(self)
        )

    def event(self, node: Any) -> None:
        """Handle a mouse button event of the scene."""
        event = node.getEvent()
        if (
            coin.SoMouseButtonEvent.isButtonPressEvent(event, coin.SoMouseButtonEvent.BUTTON1)
            and self.wanted()
        ):
            self._wait(_sight(node.getAction()), _pair(event.getPosition()), QtGui.QCursor.pos())

    def _wait(self, sight: Sight, position: Array, start: Any) -> None:
        """Wait until the button is released. A mouse that has moved by then rotated the view or
        drew a frame.
        """
        if (QtGui.QCursor.pos() - start).manhattanLength() > STILL:
            return
        if QtGui.QApplication.mouseButtons() & QtCore.Qt.LeftButton:
            QtCore.QTimer.singleShot(LOOK_EVERY, lambda: self._wait(sight, position, start))
            return
        number = nearest(*self.seen(), sight, position)
        if number is not None:
            self.clicked(number)


def _event(listener: weakref.ref[ClickNode], node: Any) -> None:
    target = listener()
    if target is not None:
        target.event(node)


def _sight(action: Any) -> Sight:
    """Return the projection of the view at the action's position in the scene graph."""
    region, volume = action.getViewportRegion(), coin.SoViewVolumeElement.get(action.getState())
    placed = coin.SoGetMatrixAction(region)  # an event action knows no transformations
    placed.apply(action.getCurPath())
    # keep references: pivy frees their sources
    model, screen, toward = placed.getMatrix(), volume.getMatrix(), volume.getProjectionDirection()
    model, screen, toward = (
        np.array(matrix.getValue(), float) for matrix in (model, screen, toward)
    )
    return Sight(model, screen, _pair(region.getViewportSizePixels()), toward)


def _pair(short: Any) -> Array:
    """Convert an SbVec2s to (2,), for versions of pivy without direct access to its values."""
    return np.array([short[0], short[1]], float)


def nearest(points: Array, reach: float, width: float, sight: Sight, position: Array) -> int | None:
    """Return the index of the point at a screen position (2,), px from the lower left; None without
    a point nearby.

    points: (n, 3). reach: mm, radius of their drawing. width: mm, bead width, for the depth
    tolerance behind the foremost point.
    """
    world = points @ sight.to_world[:3, :3] + sight.to_world[3, :3]
    projected = world @ sight.to_screen[:3] + sight.to_screen[3]
    with np.errstate(divide="ignore", invalid="ignore"):
        flat = 0.5 * (projected[:, :2] / projected[:, 3:] + 1.0) * sight.size
    distance = np.linalg.norm(flat - position, axis=1)
    with np.errstate(divide="ignore"):
        size = (
            reach * 0.5 * sight.size[1] * np.linalg.norm(sight.to_screen[:3, 1]) / projected[:, 3]
        )
    candidates = np.flatnonzero((distance <= np.maximum(REACH_PX, size)) & (projected[:, 3] > 0.0))
    if not len(candidates):
        return None
    depth = world[candidates] @ sight.toward
    front = candidates[depth <= depth.min() + DEEP * width]
    return int(front[np.argmin(distance[front])])


LINES, TUBES = marked("lines"), marked("tubes")
OPTIONS: dict[str, tuple[str, Any, str]] = {
    "Look": (
        "App::PropertyEnumeration",
        (LINES, TUBES),
        "Draw beads as lines, or as tubes of their width and height.",
    ),
    "ShowLegend": (
        "App::PropertyBool",
        True,
        "Show the legend of the colours in the corner of the view.",
    ),
    "ShowDirections": ("App::PropertyBool", False, "Show the build directions as short lines."),
    "DirectionStep": (
        "App::PropertyInteger",
        8,
        "Show the build direction at every n-th point.",
    ),
    "DirectionLength": (
        "App::PropertyLength",
        4.0,
        "Length of the lines that show build directions.",
    ),
    "LineWidth": ("App::PropertyFloat", 2.0, "Width of the beads' lines in pixels."),
}


class PathView(StageView):
    """Draws beads coloured from blue (lowest value) to yellow (highest value).

    A hidden path is drawn when first shown, so that opening a document reads no unneeded result.
    shown: first and last layer, and the number of visible points of the last layer (None for all);
    None for the whole path.
    """

    options: ClassVar[dict[str, tuple[str, Any, str]]] = OPTIONS
    rows: Rows | None = None
    scale: Scale | None = None  # scale of the visible colours
    shown: tuple[int, int, int | None] | None = None
    coloured_by: tuple[Any, ...] | None = None  # inputs of the current colours
    waiting = False

    def __init__(self, vobj: Any) -> None:
        super().__init__(vobj)
        # selection highlighting would give tubes other colours than the legend
        vobj.SelectionStyle = "BoundBox"

    # ---- to be defined by a view

    def rows_of(self, obj: Any, value: Any) -> Rows:
        """Return the path to draw."""
        raise NotImplementedError

    def coloured(self, obj: Any, kind: str) -> tuple[Array, Scale]:
        """Return the colours of all points. Raises InputError while undo restores a result in
        parts.
        """
        raise NotImplementedError

    def limited(self, start: int, end: int) -> None:
        """Adapt other drawings to the visible rows from `start` to before `end`."""

    # ---- overrides of the stage's view

    def scene(self, root: Any) -> None:
        self.path, self.legend = PathNodes(), legend.Legend()
        self.clicks = ClickNode(
            lambda: any(is_active() for is_active, _ in _choosers),
            self._visible_points,
            self._clicked,
        )
        root.addChild(self.clicks.node)
        root.addChild(self.path.node)
        root.addChild(self.legend.node)

    def refresh(self) -> None:
        """Draw the stored result.

        While a document opens, wait until it is open and the path is visible.
        """
        if self.obj is None:
            return
        opening = self.obj.Document.Restoring
        self.waiting = opening or not self.obj.ViewObject.Visibility
        if opening:
            QtCore.QTimer.singleShot(0, self._opened)
        elif not self.waiting:
            super().refresh()

    def _opened(self) -> None:
        with contextlib.suppress(ReferenceError, RuntimeError):  # the document is closed again
            if self.waiting:
                self.refresh()

    def draw(self, obj: Any, value: Any) -> None:
        self.rows, self.coloured_by = self.rows_of(obj, value), None
        self.path.set(self.rows)
        self.show(self.shown)

    def style(self, vobj: Any) -> None:
        if self.rows is None:
            return
        self._colour(vobj)
        legend.renew_soon()
        self.path.style.lineWidth = max(1.0, vobj.LineWidth)
        self.path.look(vobj.Look == TUBES)
        setting = (
            (max(1, vobj.DirectionStep), vobj.DirectionLength.Value)
            if vobj.ShowDirections
            else None
        )
        if setting is None:
            self.path.hide_directions()
        elif setting != self.path.drawn_directions:
            self.path.draw_directions(*setting)
        notify(self)

    def onChanged(self, vobj: Any, name: str) -> None:
        """Handle a changed view property."""
        super().onChanged(vobj, name)
        if name == "Visibility":
            if self.waiting and vobj.Visibility and not vobj.Object.Document.Restoring:
                self.refresh()
            legend.renew_soon()
            notify(self)

    def _colour(self, vobj: Any) -> None:
        """Recolour the beads if their colours changed."""
        preferred = preferences.ramp(), preferences.speed_unit(), scale_of(ORDINARY["mm"], "mm")
        key = (self.drawn, vobj.Colouring, *preferred, *self.colours_depend_on(vobj.Object))
        if self.rows is not None and len(self.rows) and key != self.coloured_by:
            try:
                colours, self.scale = self.coloured(vobj.Object, vobj.Colouring)
            except InputError:  # during undo; drawn when the undo is complete
                return
            self.path.paint(colours)
            self.coloured_by = key

    def preferences_changed(self) -> None:
        self.style(self.obj.ViewObject)

    def colours_depend_on(self, obj: Any) -> tuple[Any, ...]:
        """Return inputs of the colours in addition to the result."""
        return ()

    # ---- visible stretch

    def stretch(self) -> tuple[int, int]:
        """Return the first visible row, and the row after the last visible row."""
        if self.rows is None:
            return 0, 0
        if self.shown is None:
            return 0, len(self.rows)
        start, end = self.rows.layer_rows(*self.shown[:2])
        if self.shown[2] is not None:
            end = min(end, self.rows.layer_rows(self.shown[1], self.shown[1])[0] + self.shown[2])
        return start, end

    def show(self, stretch: tuple[int, int, int | None] | None) -> None:
        """Show some layers, with only some points of the last layer; None for all."""
        rows = self.rows
        if rows is None:
            return
        if stretch is not None:
            last_layer = min(stretch[1], rows.layer_count - 1)
            stretch = (min(stretch[0], last_layer), last_layer, stretch[2])
        self.shown = stretch
        start, end = self.stretch()
        self.path.show(start, end)
        self.limited(start, end)
        for listener in _followers:
            listener(self)

    def last_point(self) -> tuple[Array, Array] | None:
        """Return the last visible point (3,) of a stretch and its tool axis (3,); None if the whole
        path or nothing is visible.
        """
        start, end = self.stretch()
        if self.rows is None or self.shown is None or end <= start:
            return None
        index = self.rows.bead_of(end - 1)
        bead, row = self.rows.bead(index), end - 1 - int(self.rows.starts[index])
        return bead.points[row], bead.tool[row]

    # ---- clicks

    def _visible_points(self) -> tuple[Array, float, float]:
        """Return the visible points (for tubes, their centrelines), the radius of their drawing and
        the bead width.
        """
        start, end = self.stretch()
        if self.rows is None or end <= start:
            return np.zeros((0, 3)), 0.0, 0.0
        rows, width = slice(start, end), float(self.rows.width[start:end].max())
        if not self.path.as_tubes:
            return self.rows.points[rows], 0.0, width
        height = self.rows.height[rows]
        middle = self.rows.points[rows] + 0.5 * height[:, None] * self.rows.build[rows]
        return middle, 0.5 * max(width, float(height.max())), width

    def _clicked(self, number: int) -> None:
        for is_active, choose in _choosers:
            if is_active():
                choose(self, self.stretch()[0] + number)


# ---- listeners for clicks and changes

_choosers: list[tuple[Callable[[], bool], Callable[[PathView, int], None]]] = []

_listeners: list[Callable[[PathView], None]] = []

_followers: list[Callable[[PathView], None]] = []


def listen_to_clicks(
    is_active: Callable[[], bool], choose: Callable[[PathView, int], None]
) -> None:
    """Call `choose` with the row of a clicked path point while `is_active`."""
    _choosers.append((is_active, choose))


def listen(listener: Callable[[PathView], None]) -> None:
    """Call `listener` whenever a path is drawn, changed, shown or hidden."""
    _listeners.append(listener)


def listen_to_stretches(follower: Callable[[PathView], None]) -> None:
    """Call `follower` whenever the visible stretch of a path changes."""
    _followers.append(follower)


def notify(view: PathView) -> None:
    """Report that a path was drawn, changed, shown or hidden."""
    for listener in _listeners:
        listener(view)
