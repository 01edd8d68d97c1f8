# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map drawn: cells, seams, curves and handles; tells where the mouse is and what it drags."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ..lines import Array
from ..path.colouring import round_numbers
from ..texts import tr
from .picture import Painted, enlarged

LEFT, RIGHT, TOP, BOTTOM = 52, 12, 30, 34
HATCH = 7  # pixels between lines
NEAR_CURVE, NEAR_HANDLE, HANDLE = 7.0, 10.0, 5.0
TURN = 2.0 * np.pi
MOST_TURNS = 3.0  # that are shown at once
MOST_SEAMS = 120
TO_TICKS = 6


@dataclass(frozen=True)
class Curve:
    """A line over the map: values (C,) rad, counted on along each bead; bold: the one that can be dragged."""

    values: Array
    colour: tuple[int, int, int]
    bold: bool = False
    dashed: bool = False


@dataclass(frozen=True)
class Handle:
    """What the curve is taken hold of by: bead, number among its handles, place."""

    bead: int
    number: int
    column: float
    value: float


@dataclass
class Dragged:
    """What is being dragged, and the value it was last dragged to. handle: None for the curve itself."""

    handle: Handle | None
    column: int
    value: float
    moved: bool = False


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
        self.setMinimumSize(360, 200)
        self.setSizePolicy(QtGui.QSizePolicy.Expanding, QtGui.QSizePolicy.Expanding)
        self.painted: Painted | None = None
        self.count = 1
        self.seams: Array = np.zeros(0, dtype=int)  # columns at which beads begin
        self.layers: list[tuple[float, str]] = []  # columns with a text below
        self.curves: list[Curve] = []
        self.handles: list[Handle] = []
        self.bad: Array = np.zeros((0, 2))  # column, value of points that do not serve
        self.title = ""
        self.low, self.high = -np.pi, np.pi
        self.drag: Dragged | None = None
        self.pressed: tuple[float, float] | None = None
        self.mouse: tuple[int, float] | None = None
        self._pixmap: Any = None
        self._made_of: Any = None

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(640, 320)

    # ---- what is shown

    def set_map(self, painted: Painted | None, seams: Array, layers: list[tuple[float, str]]) -> None:
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
            room = 0.04 * (high - low) if high - low > TURN + 1e-9 else 0.0
            if high - low > MOST_TURNS * TURN:
                low, high, room = -np.pi, np.pi, 0.0
            self.low, self.high = low - room, high + room
        self.update()

    # ---- places

    def area(self) -> Any:
        """Where the map is drawn."""
        return QtCore.QRectF(LEFT, TOP, max(self.width() - LEFT - RIGHT, 1), max(self.height() - TOP - BOTTOM, 1))

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
        away = [float(np.hypot(self.x_of(one.column) - x, self.y_of(one.value) - y)) for one in self.handles]
        best = int(np.argmin(away))
        return self.handles[best] if away[best] <= NEAR_HANDLE else None

    def _on_curve(self, x: float, y: float) -> bool:
        own = [curve for curve in self.curves if curve.bold]
        if not own:
            return False
        near = np.abs(self.x_of(np.arange(self.count)) - x) < max(NEAR_CURVE, 1.0 * self.area().width() / self.count)
        down = self.y_of(self._shown(own[0].values))[near]
        return bool(len(down)) and bool(down.min() - NEAR_CURVE <= y <= down.max() + NEAR_CURVE)

    def _shown(self, values: Array) -> Array:
        """Values where they are drawn: as they are, or brought into the turn that is shown."""
        if self.high - self.low > TURN + 1e-9 or (values.min() >= self.low and values.max() <= self.high):
            return values
        return values - TURN * np.round(values / TURN)

    # ---- painting

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        area = self.area()
        if self.painted is None:
            painter.drawText(area, QtCore.Qt.AlignCenter, tr("The map is being computed…"))
            painter.end()
            return
        painter.drawPixmap(area.topLeft(), self._cells())
        painter.setClipRect(area)
        self._draw_seams(painter)
        for curve in self.curves:
            self._draw_curve(painter, curve)
        self._draw_bad(painter)
        self._draw_handles(painter)
        if self.mouse is not None:
            painter.setPen(QtGui.QPen(QtGui.QColor(255, 255, 255, 150), 1.0))
            across = float(self.x_of(self.mouse[0]))
            painter.drawLine(QtCore.QPointF(across, area.top()), QtCore.QPointF(across, area.bottom()))
        painter.setClipping(False)
        self._draw_axes(painter)
        self._draw_legend(painter)
        painter.end()

    def _cells(self) -> Any:
        area = self.area()
        wanted = (id(self.painted), int(area.width()), int(area.height()), self.low, self.high)
        if self._made_of != wanted:
            assert self.painted is not None
            pixels = np.ascontiguousarray(enlarged(self.painted, wanted[1], wanted[2], self.low, self.high, HATCH))
            image = QtGui.QImage(pixels.tobytes(), wanted[1], wanted[2], 4 * wanted[1], QtGui.QImage.Format_RGB32)
            self._pixmap, self._made_of = QtGui.QPixmap.fromImage(image.copy()), wanted
        return self._pixmap

    def _draw_seams(self, painter: Any) -> None:
        area = self.area()
        if len(self.seams) <= MOST_SEAMS:
            painter.setPen(QtGui.QPen(QtGui.QColor(255, 255, 255, 110), 1.0))
            for seam in self.seams[1:]:
                across = float(self.x_of(seam - 0.5))
                painter.drawLine(QtCore.QPointF(across, area.top()), QtCore.QPointF(across, area.bottom()))
        painter.setPen(QtGui.QPen(QtGui.QColor(0, 0, 0, 120), 1.0, QtCore.Qt.DashLine))
        first = int(np.ceil((self.low - np.pi) / TURN))
        for turn in range(first, int(np.floor((self.high - np.pi) / TURN)) + 1):
            down = float(self.y_of(np.pi + turn * TURN))
            if area.top() + 1.0 < down < area.bottom() - 1.0:
                painter.drawLine(QtCore.QPointF(area.left(), down), QtCore.QPointF(area.right(), down))

    def _draw_curve(self, painter: Any, curve: Curve) -> None:
        across, values = self.x_of(np.arange(self.count)), self._shown(curve.values)
        down = self.y_of(values)
        cut = np.union1d(self.seams, np.flatnonzero(np.abs(np.diff(values)) > np.pi) + 1)
        for width, colour in ((4.6, (0, 0, 0)), (2.6, curve.colour)) if curve.bold else ((1.8, curve.colour),):
            pen = QtGui.QPen(QtGui.QColor(*colour), width)
            if curve.dashed:
                pen.setStyle(QtCore.Qt.DashLine)
            painter.setPen(pen)
            for start, end in zip([*cut, self.count], [*cut[1:], self.count], strict=False):
                line = [QtCore.QPointF(across[k], down[k]) for k in range(int(start), int(end))]
                if len(line) > 1:
                    painter.drawPolyline(QtGui.QPolygonF(line))
                elif line:
                    painter.drawPoint(line[0])

    def _draw_bad(self, painter: Any) -> None:
        if not len(self.bad):
            return
        painter.setPen(QtGui.QPen(QtGui.QColor(120, 0, 0), 1.0))
        painter.setBrush(QtGui.QColor(255, 40, 40))
        across, down = self.x_of(self.bad[:, 0]), self.y_of(self._shown(self.bad[:, 1]))
        _, kept = np.unique(np.round(across / 3.0), return_index=True)
        for k in kept:
            painter.drawEllipse(QtCore.QPointF(across[k], down[k]), 2.6, 2.6)

    def _draw_handles(self, painter: Any) -> None:
        painter.setPen(QtGui.QPen(QtGui.QColor(0, 0, 0), 1.6))
        painter.setBrush(QtGui.QColor(255, 255, 255))
        for one in self.handles:
            painter.drawEllipse(QtCore.QPointF(self.x_of(one.column), self.y_of(one.value)), HANDLE, HANDLE)

    def _draw_axes(self, painter: Any) -> None:
        area, ink = self.area(), self.palette().color(QtGui.QPalette.WindowText)
        painter.setPen(ink)
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.drawRect(area)
        line = painter.fontMetrics().height()
        for step in (30, 45, 90, 180, 360):
            if np.degrees(self.high - self.low) / step <= max(3.0, area.height() / (1.6 * line)):
                break
        first = int(np.ceil(np.degrees(self.low) / step - 1e-9))
        for number in range(first, int(np.floor(np.degrees(self.high) / step + 1e-9)) + 1):
            down = float(self.y_of(np.radians(number * step)))
            painter.drawLine(QtCore.QPointF(area.left() - 4.0, down), QtCore.QPointF(area.left(), down))
            box = QtCore.QRectF(0.0, down - 0.5 * line, LEFT - 7.0, line)
            painter.drawText(box, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, f"{number * step}°")
        last = -1e9
        for column, text in self.layers:
            across, wide = float(self.x_of(column)), 8.0 + painter.fontMetrics().boundingRect(text).width()
            if across - 0.5 * wide < last:
                continue
            last = across + 0.5 * wide
            painter.drawLine(QtCore.QPointF(across, area.bottom()), QtCore.QPointF(across, area.bottom() + 3.0))
            box = QtCore.QRectF(across - 0.5 * wide, area.bottom() + 3.0, wide, line)
            painter.drawText(box, QtCore.Qt.AlignCenter, text)
        box = QtCore.QRectF(area.left(), area.bottom() + 2.0 + line, area.width(), line)
        painter.drawText(box, QtCore.Qt.AlignCenter, self.title)

    def _draw_legend(self, painter: Any) -> None:
        """The ramp with round numbers, then the classes, above the map."""
        assert self.painted is not None
        scale, ink = self.painted.scale, self.palette().color(QtGui.QPalette.WindowText)
        line, across = painter.fontMetrics().height(), float(LEFT)
        painter.setPen(ink)
        title = f"{tr(scale.title)} {scale.unit}".strip()
        across = self._word(painter, across, title)
        from ..colours import ramp

        bar = QtCore.QRectF(across, 5.0, 90.0, 9.0)
        fill = QtGui.QLinearGradient(bar.left(), 0.0, bar.right(), 0.0)
        for share in np.linspace(0.0, 1.0, 9):
            fill.setColorAt(float(share), QtGui.QColor.fromRgbF(*(float(part) for part in ramp(np.array([share]))[0])))
        painter.fillRect(bar, fill)
        numbers = round_numbers(scale.low, scale.high, 0.0) if scale.high > scale.low else np.array([scale.low])
        for number in numbers[:: max(1, len(numbers) // TO_TICKS + 1)]:
            at = bar.left() + bar.width() * float(scale.share(np.array([number]))[0])
            box = QtCore.QRectF(at - 20.0, 14.0, 40.0, line)
            painter.drawText(box, QtCore.Qt.AlignHCenter, f"{number:g}")
        across = bar.right() + 14.0
        for text, colour in self.painted.classes:
            painter.fillRect(QtCore.QRectF(across, 5.0, 11.0, 11.0), QtGui.QColor.fromRgbF(*colour))
            across = self._word(painter, across + 15.0, tr(text))
        if self.painted.hatched.any():
            box = QtCore.QRectF(across, 5.0, 11.0, 11.0)
            painter.drawRect(box)
            painter.fillRect(box, QtGui.QBrush(ink, QtCore.Qt.BDiagPattern))
            self._word(painter, across + 15.0, tr("not allowed, or the nozzle touches"))

    def _word(self, painter: Any, across: float, text: str) -> float:
        wide = painter.fontMetrics().boundingRect(text).width() + 4.0
        box = QtCore.QRectF(across, 2.0, wide, painter.fontMetrics().height())
        painter.drawText(box, QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, text)
        return across + wide + 8.0


def _place(event: Any) -> tuple[float, float]:
    """Where a mouse event is, in Qt 5 and 6."""
    place = event.position() if hasattr(event, "position") else event.localPos()
    return float(place.x()), float(place.y())
