# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map drawn: cells, seams, curves and handles; tells where the mouse is and what it drags."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from freecad_am.core.geometry.angles import TURN, shortest
from freecad_am.core.types import Array

from ...texts.translation import tr
from .curves import Curve, Dragged, Handle
from .painting import BOTTOM, LEFT, RIGHT, TOP, Painting
from .picture import Painted

NEAR_CURVE, NEAR_HANDLE = 7.0, 10.0
MOST_TURNS = 3.0  # that are shown at once


class Canvas(QtGui.QWidget):
    """Columns from left to right, values upwards. The functions are called with what the user does."""

    hovered: Callable[[int, float], None]
    clicked: Callable[[int, float], None]
    dragged: Callable[[Dragged, float], None]
    dropped: Callable[[], None]

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("map")
        self.setMouseTracking(True)
        self.setMinimumSize(260, 110)
        self.setSizePolicy(QtGui.QSizePolicy.Expanding, QtGui.QSizePolicy.Expanding)
        self.painted: Painted | None = None
        self.count = 1
        self.seams: Array = np.zeros(0, dtype=int)  # columns at which beads begin
        self.layers: list[tuple[float, str]] = []  # columns with a text below
        self.curves: list[Curve] = []
        self.handles: list[Handle] = []
        self.bad: Array = np.zeros((0, 2))  # column, value of points that do not serve
        self.title = ""
        # where the heights of the map are no angles: texts beside them, and that of the plan
        self.heights: tuple[list[tuple[float, str]], float] | None = None
        self.low, self.high = -np.pi, np.pi
        self.drag: Dragged | None = None
        self.pressed: tuple[float, float] | None = None
        self.mouse: tuple[int, float] | None = None
        self.painting = Painting(self)

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(640, 320)

    # ---- what is shown

    def set_map(
        self, painted: Painted | None, seams: Array, layers: list[tuple[float, str]]
    ) -> None:
        """Other cells; None while they are computed."""
        self.painted, self.seams, self.layers = painted, seams, layers
        if painted is not None:
            self.count = painted.hatched.shape[1]
        self.update()

    def set_curves(self, curves: list[Curve], handles: list[Handle], bad: Array) -> None:
        """Other curves; the range shown follows them unless one is being dragged."""
        self.curves, self.handles, self.bad = curves, handles, bad
        if self.drag is None:
            values = np.concatenate([curve.values for curve in curves]) if curves else np.zeros(1)
            low, high = min(-np.pi, float(values.min())), max(np.pi, float(values.max()))
            margin = 0.04 * (high - low) if high - low > TURN + 1e-9 else 0.0
            if high - low > MOST_TURNS * TURN:
                low, high, margin = -np.pi, np.pi, 0.0
            self.low, self.high = low - margin, high + margin
        self.update()

    # ---- places

    def area(self) -> Any:
        """Where the map is drawn."""
        return QtCore.QRectF(
            LEFT, TOP, max(self.width() - LEFT - RIGHT, 1), max(self.height() - TOP - BOTTOM, 1)
        )

    def x_of(self, column: Any) -> Any:
        """Pixels from the left of columns."""
        area = self.area()
        return area.left() + (np.asarray(column) + 0.5) / self.count * area.width()

    def y_of(self, value: Any) -> Any:
        """Pixels from the top of values."""
        area = self.area()
        return area.top() + (self.high - np.asarray(value)) / (self.high - self.low) * area.height()

    def cell_at(self, x: float, y: float) -> tuple[int, float]:
        """Column and value at a place."""
        area = self.area()
        column = int(np.clip((x - area.left()) / area.width() * self.count, 0, self.count - 1))
        return column, float(self.high - (y - area.top()) / area.height() * (self.high - self.low))

    # ---- the mouse

    def mousePressEvent(self, event: Any) -> None:
        """Called by Qt."""
        if event.button() != QtCore.Qt.LeftButton or self.painted is None:
            return
        x, y = _place(event)
        column, value = self.cell_at(x, y)
        self.pressed = x, y
        handle = self._handle_at(x, y)
        if handle is not None or self._on_curve(x, y):
            self.drag = Dragged(handle, column, value)

    def mouseMoveEvent(self, event: Any) -> None:
        """Called by Qt."""
        x, y = _place(event)
        if self.painted is None:
            return
        column, value = self.cell_at(x, y)
        self.mouse = column, value
        if self.drag is not None:
            by = value - self.drag.value
            far = self.pressed is None or abs(y - self.pressed[1]) > 2.0
            if by and (self.drag.moved or far):
                self.drag.value, self.drag.moved = value, True
                self.dragged(self.drag, by)
        else:
            over = self._handle_at(x, y) is not None or self._on_curve(x, y)
            self.setCursor(QtCore.Qt.SizeVerCursor if over else QtCore.Qt.CrossCursor)
        self.hovered(column, value)
        self.update()

    def mouseReleaseEvent(self, event: Any) -> None:
        """Called by Qt."""
        if event.button() != QtCore.Qt.LeftButton or self.pressed is None:
            return
        drag, self.drag, self.pressed = self.drag, None, None
        if drag is not None and drag.moved:
            self.dropped()
        elif self.painted is not None:
            self.clicked(*self.cell_at(*_place(event)))

    def leaveEvent(self, event: Any) -> None:
        """Called by Qt."""
        self.mouse = None
        self.update()

    def _handle_at(self, x: float, y: float) -> Handle | None:
        if not self.handles:
            return None
        away = [
            float(np.hypot(self.x_of(one.column) - x, self.y_of(one.value) - y))
            for one in self.handles
        ]
        best = int(np.argmin(away))
        return self.handles[best] if away[best] <= NEAR_HANDLE else None

    def _on_curve(self, x: float, y: float) -> bool:
        own = [curve for curve in self.curves if curve.bold]
        if not own:
            return False
        near = np.abs(self.x_of(np.arange(self.count)) - x) < max(
            NEAR_CURVE, 1.0 * self.area().width() / self.count
        )
        down = self.y_of(self.shown(own[0].values))[near]
        return bool(len(down)) and bool(down.min() - NEAR_CURVE <= y <= down.max() + NEAR_CURVE)

    def shown(self, values: Array) -> Array:
        """Values where they are drawn: as they are, or brought into the turn that is shown."""
        if self.high - self.low > TURN + 1e-9 or (
            values.min() >= self.low and values.max() <= self.high
        ):
            return values
        return shortest(values)

    # ---- painting

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        if self.painted is None:
            painter.drawText(self.area(), QtCore.Qt.AlignCenter, tr("The map is being computed…"))
        else:
            self.painting.paint(painter)
        painter.end()


def _place(event: Any) -> tuple[float, float]:
    """Where a mouse event is, in Qt 5 and 6."""
    place = event.position() if hasattr(event, "position") else event.localPos()
    return float(place.x()), float(place.y())
