# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw a map: cells, seams, curves and handles, axes, legend."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.geometry.frames import TURN, shortest
from ...core.planning.redundancy_map import Picture
from ...core.types import Array, Mask, NDArray
from .. import colours
from ..colours import ramp
from ..in_language import marked, tr
from ..path.colouring import ABOVE_COLOUR, BELOW_COLOUR, NONE, Scale, automatic, round_numbers
from .board import Curve, Dragged, Handle

MARGIN, CONDITION = marked("joint margin"), marked("condition")
KINDS = (MARGIN, CONDITION)
Pixels = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Painted:
    """Colours (R, C, 3) 0..255 and hatching (R, C) of cells, the scale of the ramp, and the classes
    present.
    """

    colours: Pixels
    hatched: Mask
    scale: Scale
    classes: tuple[tuple[str, tuple[float, float, float]], ...]


def painted(picture: Picture, kind: str) -> Painted:
    """Colour a picture by margin (percent of half a range) or by condition; infeasible cells have
    their own colours.
    """
    reachable, beyond = picture.reachable, picture.past_limit
    singular = picture.singular & ~beyond
    good = reachable & ~beyond & ~singular
    values = np.where(
        reachable, 100.0 * picture.margin if kind == MARGIN else picture.condition, 0.0
    )
    valid = values[good] if good.any() else np.zeros(1)
    scale = automatic(valid, kind, "%" if kind == MARGIN else "")
    colours = ramp(scale.share(np.where(good, values, scale.low)).ravel()).reshape(*values.shape, 3)
    classes = []
    for text, cells, colour in (
        (marked("unreachable"), ~reachable, NONE),
        (marked("beyond a limit"), beyond, BELOW_COLOUR),
        (marked("near a singularity"), singular, ABOVE_COLOUR),
    ):
        if cells.any():
            colours[cells] = colour
            classes.append((text, colour))
    return Painted(
        np.round(255.0 * colours).astype(np.uint8), picture.hatched, scale, tuple(classes)
    )


def enlarged(
    picture: Painted, width: int, height: int, low: float, high: float, lines: int
) -> Pixels:
    """Scale the picture to pixels (height, width, 4) in Qt order (blue first).

    The value goes from `high` at the top to `low`; they may differ by more than a turn. Hatching
    lines are `lines` pixels apart.
    """
    rows, columns = picture.hatched.shape
    value = high - (np.arange(height) + 0.5) / height * (high - low)
    row = np.round((value + np.pi) % (2.0 * np.pi) / (2.0 * np.pi) * (rows - 1)).astype(int)
    column = np.minimum((np.arange(width) + 0.5) / width * columns, columns - 1).astype(int)
    cells = row[:, None], column[None, :]
    pixels = np.full((height, width, 4), 255, dtype=np.uint8)
    pixels[:, :, :3] = picture.colours[cells][:, :, ::-1]
    stripe = (np.arange(height)[:, None] + np.arange(width)) % lines < max(2, lines // 5)
    pixels[picture.hatched[cells] & stripe, :3] = 20
    return pixels


# pixels; margins around the map
LEFT_MARGIN, RIGHT_MARGIN, TOP_MARGIN, BOTTOM_MARGIN = 52, 12, 30, 34
HATCH = 7  # pixels; spacing of hatching lines
HANDLE = 5.0
MOST_SEAMS = 120
TO_TICKS, LEAST_TICKS = 6, 2
ROW = 14.0  # pixels; spacing of legend rows


class Painting:
    """Draws the content of a canvas."""

    def __init__(self, canvas: Any) -> None:
        self.canvas = canvas
        self._pixmap: Any = None
        self._made_of: Any = None
        self._size: Any = None

    def paint(self, painter: Any) -> None:
        """Draw everything."""
        area = self.canvas.area()
        painter.drawPixmap(area.topLeft(), self._cells())
        painter.setClipRect(area)
        self._draw_seams(painter)
        for curve in self.canvas.curves:
            self._draw_curve(painter, curve)
        self._draw_bad(painter)
        self._draw_handles(painter)
        if self.canvas.mouse is not None:
            painter.setPen(QtGui.QPen(QtGui.QColor(255, 255, 255, 150), 1.0))
            across = float(self.canvas.x_of(self.canvas.mouse[0]))
            painter.drawLine(
                QtCore.QPointF(across, area.top()), QtCore.QPointF(across, area.bottom())
            )
        painter.setClipping(False)
        self._draw_axes(painter)
        self._draw_legend(painter)

    def _cells(self) -> Any:
        """Return the cells at display size, computed once per picture and size."""
        canvas, area = self.canvas, self.canvas.area()
        size = int(area.width()), int(area.height()), canvas.low, canvas.high
        if self._made_of is not canvas.painted or self._size != size:
            pixels = np.ascontiguousarray(enlarged(canvas.painted, *size, HATCH))
            image = QtGui.QImage(
                pixels.tobytes(), size[0], size[1], 4 * size[0], QtGui.QImage.Format_RGB32
            )
            self._pixmap = QtGui.QPixmap.fromImage(image.copy())
            self._made_of, self._size = canvas.painted, size
        return self._pixmap

    def _draw_seams(self, painter: Any) -> None:
        area = self.canvas.area()
        if len(self.canvas.seams) <= MOST_SEAMS:
            painter.setPen(QtGui.QPen(QtGui.QColor(255, 255, 255, 110), 1.0))
            for seam in self.canvas.seams[1:]:
                across = float(self.canvas.x_of(seam - 0.5))
                painter.drawLine(
                    QtCore.QPointF(across, area.top()), QtCore.QPointF(across, area.bottom())
                )
        if self.canvas.heights is not None:
            down = float(self.canvas.y_of(self.canvas.heights[1]))
            painter.drawLine(QtCore.QPointF(area.left(), down), QtCore.QPointF(area.right(), down))
        painter.setPen(QtGui.QPen(QtGui.QColor(0, 0, 0, 120), 1.0, QtCore.Qt.DashLine))
        start = int(np.ceil((self.canvas.low - np.pi) / TURN))
        for turn in range(start, int(np.floor((self.canvas.high - np.pi) / TURN)) + 1):
            down = float(self.canvas.y_of(np.pi + turn * TURN))
            if area.top() + 1.0 < down < area.bottom() - 1.0:
                painter.drawLine(
                    QtCore.QPointF(area.left(), down), QtCore.QPointF(area.right(), down)
                )

    def _draw_curve(self, painter: Any, curve: Curve) -> None:
        across, values = (
            self.canvas.x_of(np.arange(self.canvas.count)),
            self.canvas.wrap_values(curve.values),
        )
        down = self.canvas.y_of(values)
        cut = np.union1d(self.canvas.seams, np.flatnonzero(np.abs(np.diff(values)) > np.pi) + 1)
        for width, colour in (
            ((4.6, (0, 0, 0)), (2.6, curve.colour)) if curve.bold else ((1.8, curve.colour),)
        ):
            pen = QtGui.QPen(QtGui.QColor(*colour), width)
            if curve.dashed:
                pen.setStyle(QtCore.Qt.DashLine)
            painter.setPen(pen)
            for start, end in zip(
                [*cut, self.canvas.count], [*cut[1:], self.canvas.count], strict=False
            ):
                line = [QtCore.QPointF(across[k], down[k]) for k in range(int(start), int(end))]
                if len(line) > 1:
                    painter.drawPolyline(QtGui.QPolygonF(line))
                elif line:
                    painter.drawPoint(line[0])

    def _draw_bad(self, painter: Any) -> None:
        if not len(self.canvas.bad):
            return
        painter.setPen(QtGui.QPen(QtGui.QColor(120, 0, 0), 1.0))
        painter.setBrush(QtGui.QColor(255, 40, 40))
        across, down = (
            self.canvas.x_of(self.canvas.bad[:, 0]),
            self.canvas.y_of(self.canvas.wrap_values(self.canvas.bad[:, 1])),
        )
        _, rows = np.unique(np.round(across / 3.0), return_index=True)
        for k in rows:
            painter.drawEllipse(QtCore.QPointF(across[k], down[k]), 2.6, 2.6)

    def _draw_handles(self, painter: Any) -> None:
        painter.setPen(QtGui.QPen(QtGui.QColor(0, 0, 0), 1.6))
        painter.setBrush(QtGui.QColor(255, 255, 255))
        for handle in self.canvas.handles:
            painter.drawEllipse(
                QtCore.QPointF(self.canvas.x_of(handle.column), self.canvas.y_of(handle.value)),
                HANDLE,
                HANDLE,
            )

    def _draw_axes(self, painter: Any) -> None:
        area, ink = self.canvas.area(), colours.ink()
        painter.setPen(ink)
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.drawRect(area)
        line = painter.fontMetrics().height()
        for height, text in self._heights(area.height() / (1.6 * line)):
            down = float(self.canvas.y_of(height))
            painter.drawLine(
                QtCore.QPointF(area.left() - 4.0, down), QtCore.QPointF(area.left(), down)
            )
            box = QtCore.QRectF(0.0, down - 0.5 * line, LEFT_MARGIN - 7.0, line)
            painter.drawText(box, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, text)
        end = -1e9
        for column, text in self.canvas.layers:
            across, wide = (
                float(self.canvas.x_of(column)),
                8.0 + painter.fontMetrics().boundingRect(text).width(),
            )
            if across - 0.5 * wide < end:
                continue
            end = across + 0.5 * wide
            painter.drawLine(
                QtCore.QPointF(across, area.bottom()), QtCore.QPointF(across, area.bottom() + 3.0)
            )
            box = QtCore.QRectF(across - 0.5 * wide, area.bottom() + 3.0, wide, line)
            painter.drawText(box, QtCore.Qt.AlignCenter, text)
        box = QtCore.QRectF(area.left(), area.bottom() + 2.0 + line, area.width(), line)
        painter.drawText(box, QtCore.Qt.AlignCenter, self.canvas.title)

    def _heights(self, count: float) -> list[tuple[float, str]]:
        """Return at most about `count` tick heights of the map with their labels."""
        if self.canvas.heights is not None:
            return list(self.canvas.heights[0])
        low, high = np.degrees(self.canvas.low), np.degrees(self.canvas.high)
        for step in (30, 45, 90, 180, 360):
            if (high - low) / step <= max(3.0, count):
                break
        numbers = range(int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9)) + 1)
        return [(float(np.radians(number * step)), f"{number * step}°") for number in numbers]

    def _draw_legend(self, painter: Any) -> None:
        """Draw the ramp with round numbers, then the classes, above the map."""
        assert self.canvas.painted is not None
        scale, ink = (
            self.canvas.painted.scale,
            colours.ink(),
        )
        line, across = painter.fontMetrics().height(), float(LEFT_MARGIN)
        painter.setPen(ink)
        title = f"{tr(scale.title)} {scale.unit}".strip()
        across = self._word(painter, across, title)
        bar = QtCore.QRectF(across, 5.0, 90.0, 9.0)
        fill = QtGui.QLinearGradient(bar.left(), 0.0, bar.right(), 0.0)
        for share in np.linspace(0.0, 1.0, 9):
            fill.setColorAt(
                float(share),
                QtGui.QColor.fromRgbF(*(float(channel) for channel in ramp(np.array([share]))[0])),
            )
        painter.fillRect(bar, fill)
        numbers = (
            round_numbers(scale.low, scale.high, 0.0)
            if scale.high > scale.low
            else np.array([scale.low])
        )
        numbers = numbers[:: max(1, len(numbers) // TO_TICKS + 1)]
        if len(numbers) < LEAST_TICKS and scale.high > scale.low:
            numbers = np.array([scale.low, scale.high])
        for number in numbers:
            middle = bar.left() + bar.width() * float(scale.share(np.array([number]))[0])
            box = QtCore.QRectF(middle - 20.0, 14.0, 40.0, line)
            painter.drawText(box, QtCore.Qt.AlignHCenter, f"{number:.3g}")
        classes: list[tuple[str, Any]] = [
            (tr(text), QtGui.QColor.fromRgbF(*colour))
            for text, colour in self.canvas.painted.classes
        ]
        if self.canvas.painted.hatched.any():
            classes.append(
                (tr("not allowed, or touching"), QtGui.QBrush(ink, QtCore.Qt.BDiagPattern))
            )
        self._draw_classes(painter, classes, bar.right() + 14.0)

    def _draw_classes(self, painter: Any, classes: list[tuple[str, Any]], left: float) -> None:
        """Draw swatches with their names; use two rows next to the ramp if one row is too narrow."""
        across, down = left, 0.0
        for text, fill in classes:
            if (
                down == 0.0
                and across > left
                and across + 15.0 + self._wide(painter, text) > self.canvas.width()
            ):
                across, down = left, ROW
            box = QtCore.QRectF(across, down + 5.0, 11.0, 11.0)
            painter.fillRect(box, fill)
            if isinstance(fill, QtGui.QBrush):
                painter.drawRect(box)
            across = self._word(painter, across + 15.0, text, down)

    def _wide(self, painter: Any, text: str) -> float:
        return float(painter.fontMetrics().boundingRect(text).width()) + 4.0

    def _word(self, painter: Any, across: float, text: str, down: float = 0.0) -> float:
        wide = self._wide(painter, text)
        box = QtCore.QRectF(across, down + 2.0, wide, painter.fontMetrics().height())
        painter.drawText(box, QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter, text)
        return across + wide + 8.0


NEAR_CURVE, NEAR_HANDLE = 7.0, 10.0
MOST_TURNS = 3.0  # maximum number of turns shown at once


class Canvas(QtGui.QWidget):
    """Shows columns from left to right and values upwards. Calls the functions for user actions."""

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
        self.layers: list[tuple[float, str]] = []  # columns with a label below
        self.curves: list[Curve] = []
        self.handles: list[Handle] = []
        self.bad: Array = np.zeros((0, 2))  # column and value of infeasible points
        self.title = ""
        # for heights other than angles: labels and planned height
        self.heights: tuple[list[tuple[float, str]], float] | None = None
        self.low, self.high = -np.pi, np.pi
        self.drag: Dragged | None = None
        self.pressed: tuple[float, float] | None = None
        self.mouse: tuple[int, float] | None = None
        self.painting = Painting(self)

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(640, 320)

    # ---- display

    def set_map(
        self, painted: Painted | None, seams: Array, layers: list[tuple[float, str]]
    ) -> None:
        """Show other cells; None while they are computed."""
        self.painted, self.seams, self.layers = painted, seams, layers
        if painted is not None:
            self.count = painted.hatched.shape[1]
        self.update()

    def set_curves(self, curves: list[Curve], handles: list[Handle], bad: Array) -> None:
        """Show other curves; the visible range follows them unless a curve is being dragged."""
        self.curves, self.handles, self.bad = curves, handles, bad
        if self.drag is None:
            values = np.concatenate([curve.values for curve in curves]) if curves else np.zeros(1)
            low, high = min(-np.pi, float(values.min())), max(np.pi, float(values.max()))
            margin = 0.04 * (high - low) if high - low > TURN + 1e-9 else 0.0
            if high - low > MOST_TURNS * TURN:
                low, high, margin = -np.pi, np.pi, 0.0
            self.low, self.high = low - margin, high + margin
        self.update()

    # ---- positions

    def area(self) -> Any:
        """Return the area of the map."""
        return QtCore.QRectF(
            LEFT_MARGIN,
            TOP_MARGIN,
            max(self.width() - LEFT_MARGIN - RIGHT_MARGIN, 1),
            max(self.height() - TOP_MARGIN - BOTTOM_MARGIN, 1),
        )

    def x_of(self, column: Any) -> Any:
        """Return the pixels from the left of columns."""
        area = self.area()
        return area.left() + (np.asarray(column) + 0.5) / self.count * area.width()

    def y_of(self, value: Any) -> Any:
        """Return the pixels from the top of values."""
        area = self.area()
        return area.top() + (self.high - np.asarray(value)) / (self.high - self.low) * area.height()

    def cell_at(self, x: float, y: float) -> tuple[int, float]:
        """Return column and value at a position in pixels."""
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
        if handle is not None or self._is_on_curve(x, y):
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
            is_far = self.pressed is None or abs(y - self.pressed[1]) > 2.0
            if by and (self.drag.moved or is_far):
                self.drag.value, self.drag.moved = value, True
                self.dragged(self.drag, by)
        else:
            over = self._handle_at(x, y) is not None or self._is_on_curve(x, y)
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
        distances = [
            float(np.hypot(self.x_of(handle.column) - x, self.y_of(handle.value) - y))
            for handle in self.handles
        ]
        best = int(np.argmin(distances))
        return self.handles[best] if distances[best] <= NEAR_HANDLE else None

    def _is_on_curve(self, x: float, y: float) -> bool:
        bold = [curve for curve in self.curves if curve.bold]
        if not bold:
            return False
        is_near = np.abs(self.x_of(np.arange(self.count)) - x) < max(
            NEAR_CURVE, 1.0 * self.area().width() / self.count
        )
        down = self.y_of(self.wrap_values(bold[0].values))[is_near]
        return bool(len(down)) and bool(down.min() - NEAR_CURVE <= y <= down.max() + NEAR_CURVE)

    def wrap_values(self, values: Array) -> Array:
        """Wrap values into the visible turn, if needed."""
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
    """Return the position of a mouse event, in Qt 5 and 6."""
    position = event.position() if hasattr(event, "position") else event.localPos()
    return float(position.x()), float(position.y())
