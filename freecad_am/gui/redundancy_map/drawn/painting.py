# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a map is drawn: cells, seams, curves and handles, axes, legend."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from freecad_am.core.geometry.angles import TURN

from ... import colours
from ...colours import ramp
from ...path.colouring import round_numbers
from ...texts.translation import tr
from .curves import Curve
from .picture import enlarged

LEFT, RIGHT, TOP, BOTTOM = 52, 12, 30, 34  # pixels about the map
HATCH = 7  # pixels between lines
HANDLE = 5.0
MOST_SEAMS = 120
TO_TICKS, LEAST_TICKS = 6, 2
ROW = 14.0  # pixels from one row of the legend to the next


class Painting:
    """Draws what a canvas shows, where the canvas says."""

    def __init__(self, canvas: Any) -> None:
        self.canvas = canvas
        self._pixmap: Any = None
        self._made_of: Any = None
        self._size: Any = None

    def paint(self, painter: Any) -> None:
        """All of it."""
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
        """The cells as large as they are shown, made once for each picture and size."""
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
        first = int(np.ceil((self.canvas.low - np.pi) / TURN))
        for turn in range(first, int(np.floor((self.canvas.high - np.pi) / TURN)) + 1):
            down = float(self.canvas.y_of(np.pi + turn * TURN))
            if area.top() + 1.0 < down < area.bottom() - 1.0:
                painter.drawLine(
                    QtCore.QPointF(area.left(), down), QtCore.QPointF(area.right(), down)
                )

    def _draw_curve(self, painter: Any, curve: Curve) -> None:
        across, values = (
            self.canvas.x_of(np.arange(self.canvas.count)),
            self.canvas.shown(curve.values),
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
            self.canvas.y_of(self.canvas.shown(self.canvas.bad[:, 1])),
        )
        _, kept = np.unique(np.round(across / 3.0), return_index=True)
        for k in kept:
            painter.drawEllipse(QtCore.QPointF(across[k], down[k]), 2.6, 2.6)

    def _draw_handles(self, painter: Any) -> None:
        painter.setPen(QtGui.QPen(QtGui.QColor(0, 0, 0), 1.6))
        painter.setBrush(QtGui.QColor(255, 255, 255))
        for one in self.canvas.handles:
            painter.drawEllipse(
                QtCore.QPointF(self.canvas.x_of(one.column), self.canvas.y_of(one.value)),
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
            box = QtCore.QRectF(0.0, down - 0.5 * line, LEFT - 7.0, line)
            painter.drawText(box, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, text)
        last = -1e9
        for column, text in self.canvas.layers:
            across, wide = (
                float(self.canvas.x_of(column)),
                8.0 + painter.fontMetrics().boundingRect(text).width(),
            )
            if across - 0.5 * wide < last:
                continue
            last = across + 0.5 * wide
            painter.drawLine(
                QtCore.QPointF(across, area.bottom()), QtCore.QPointF(across, area.bottom() + 3.0)
            )
            box = QtCore.QRectF(across - 0.5 * wide, area.bottom() + 3.0, wide, line)
            painter.drawText(box, QtCore.Qt.AlignCenter, text)
        box = QtCore.QRectF(area.left(), area.bottom() + 2.0 + line, area.width(), line)
        painter.drawText(box, QtCore.Qt.AlignCenter, self.canvas.title)

    def _heights(self, most: float) -> list[tuple[float, str]]:
        """Heights that are marked beside the map, and their texts; about so many at most."""
        if self.canvas.heights is not None:
            return list(self.canvas.heights[0])
        low, high = np.degrees(self.canvas.low), np.degrees(self.canvas.high)
        for step in (30, 45, 90, 180, 360):
            if (high - low) / step <= max(3.0, most):
                break
        numbers = range(int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9)) + 1)
        return [(float(np.radians(number * step)), f"{number * step}°") for number in numbers]

    def _draw_legend(self, painter: Any) -> None:
        """The ramp with round numbers, then the classes, above the map."""
        assert self.canvas.painted is not None
        scale, ink = (
            self.canvas.painted.scale,
            colours.ink(),
        )
        line, across = painter.fontMetrics().height(), float(LEFT)
        painter.setPen(ink)
        title = f"{tr(scale.title)} {scale.unit}".strip()
        across = self._word(painter, across, title)
        bar = QtCore.QRectF(across, 5.0, 90.0, 9.0)
        fill = QtGui.QLinearGradient(bar.left(), 0.0, bar.right(), 0.0)
        for share in np.linspace(0.0, 1.0, 9):
            fill.setColorAt(
                float(share),
                QtGui.QColor.fromRgbF(*(float(part) for part in ramp(np.array([share]))[0])),
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
            at = bar.left() + bar.width() * float(scale.share(np.array([number]))[0])
            box = QtCore.QRectF(at - 20.0, 14.0, 40.0, line)
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
        """Swatches with their words, in two rows beside the ramp and its numbers where one has no room for them."""
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
