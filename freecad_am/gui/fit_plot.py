# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fit of a bead model drawn: width over travel speed for each radius of its table, beside the beads measured."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ..core.process.bead_model import MINUTE, BeadModel
from ..core.process.bead_table import Measured
from .colouring import round_numbers
from .colours import ramp
from .lines import Array

HEIGHT, STEPS, DOT = 190, 60, 2.6
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 8, 8, 34
_FAINT = 70  # of 255, how the grid shows
_ROOM = 0.06  # of the span, left free beyond the values


class FitPlot(QtGui.QWidget):
    """Curves and dots coloured by radius, on the colours of the window; `wanted` is a width drawn across, mm."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("BeadModelPlot")
        self.setMinimumHeight(HEIGHT)
        self.measured: Measured | None = None
        self.model: BeadModel | None = None
        self.wanted: float | None = None

    def set(self, measured: Measured, model: BeadModel, wanted: float | None) -> None:
        """Show another fit."""
        self.measured, self.model, self.wanted = measured, model, wanted
        self.update()

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(240, HEIGHT)

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        if self.measured is None or self.model is None:
            return
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        font = painter.font()
        font.setPointSizeF(max(6.5, 0.85 * font.pointSizeF()))
        painter.setFont(font)
        speed = np.linspace(*self.model.speeds, STEPS)
        radii = np.unique(self.measured.radius)
        curves = [self.model.widths(speed, np.full(STEPS, radius)) for radius in radii]
        x = _spread(MINUTE * speed)
        y = _spread(np.concatenate([*curves, self.measured.width, [] if self.wanted is None else [self.wanted]]))
        self._grid(painter, x, y)
        area = self._area()
        for radius, curve, shade in zip(radii, curves, _shades(len(radii)), strict=True):
            painter.setPen(QtGui.QPen(shade, 1.6))
            painter.setBrush(QtCore.Qt.NoBrush)
            places = zip(_place(MINUTE * speed, x, area.left(), area.width()),
                         _place(curve, y, area.bottom(), -area.height()), strict=True)
            painter.drawPolyline(QtGui.QPolygonF([QtCore.QPointF(*place) for place in places]))
            rows = self.measured.radius == radius
            painter.setBrush(shade)
            for across, down in zip(_place(MINUTE * self.measured.speed[rows], x, area.left(), area.width()),
                                    _place(self.measured.width[rows], y, area.bottom(), -area.height()), strict=True):
                painter.drawEllipse(QtCore.QPointF(across, down), DOT, DOT)
        self._legend(painter, radii)
        painter.end()

    def _area(self) -> Any:
        return QtCore.QRectF(_LEFT, _TOP, self.width() - _LEFT - _RIGHT, self.height() - _TOP - _BOTTOM)

    def _grid(self, painter: Any, x: tuple[float, float], y: tuple[float, float]) -> None:
        area, ink = self._area(), self.palette().color(QtGui.QPalette.WindowText)
        faint = QtGui.QColor(ink)
        faint.setAlpha(_FAINT)
        line = painter.fontMetrics().height()
        for number in round_numbers(*x, 0.0):
            across = float(_place(np.array(number), x, area.left(), area.width()))
            painter.setPen(faint)
            painter.drawLine(QtCore.QPointF(across, area.top()), QtCore.QPointF(across, area.bottom()))
            painter.setPen(ink)
            box = QtCore.QRectF(across - 30.0, area.bottom() + 2.0, 60.0, line)
            painter.drawText(box, QtCore.Qt.AlignHCenter, f"{number:g}")
        for number in round_numbers(*y, 0.0):
            down = float(_place(np.array(number), y, area.bottom(), -area.height()))
            painter.setPen(faint)
            painter.drawLine(QtCore.QPointF(area.left(), down), QtCore.QPointF(area.right(), down))
            painter.setPen(ink)
            box = QtCore.QRectF(0.0, down - 0.5 * line, _LEFT - 4.0, line)
            painter.drawText(box, QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter, f"{number:g}")
        painter.setPen(ink)
        painter.setBrush(QtCore.Qt.NoBrush)
        painter.drawRect(area)
        box = QtCore.QRectF(area.left(), self.height() - line - 1.0, area.width(), line)
        painter.drawText(box, QtCore.Qt.AlignHCenter, "travel speed, mm/min")
        painter.save()
        painter.translate(0.0, area.bottom())
        painter.rotate(-90.0)
        painter.drawText(QtCore.QRectF(0.0, 1.0, area.height(), line), QtCore.Qt.AlignHCenter, "width, mm")
        painter.restore()
        if self.wanted is not None:
            down = float(_place(np.array(self.wanted), y, area.bottom(), -area.height()))
            painter.setPen(QtGui.QPen(ink, 1.2, QtCore.Qt.DashLine))
            painter.drawLine(QtCore.QPointF(area.left(), down), QtCore.QPointF(area.right(), down))

    def _legend(self, painter: Any, radii: Array) -> None:
        line, area = painter.fontMetrics().height(), self._area()
        texts = [f"r {radius:g} mm" for radius in radii]
        wide = max(painter.fontMetrics().boundingRect(text).width() for text in texts) + 6.0
        for row, (text, shade) in enumerate(zip(texts, _shades(len(radii)), strict=True)):
            box = QtCore.QRectF(area.right() - wide, area.top() + 3.0 + row * line, wide, line)
            painter.setPen(self.palette().color(QtGui.QPalette.WindowText))
            painter.drawText(box, QtCore.Qt.AlignLeft, text)
            painter.setPen(shade)
            painter.setBrush(shade)
            painter.drawEllipse(QtCore.QPointF(box.left() - 6.0, box.center().y()), DOT, DOT)


def _shades(count: int) -> list[Any]:
    return [QtGui.QColor.fromRgbF(*(float(part) for part in colour)) for colour in ramp(np.linspace(0.0, 0.8, count))]


def told(measured: Measured, model: BeadModel) -> str:
    """The fits in words."""
    lines = []
    for name, fit in (("Width", model.width), ("Height", model.height)):
        lines.append(
            f"{name} = {fit.m:.4g} v^(-1/3) {_signed(fit.p)}/r {_signed(fit.t)} mm, v in mm/min; "
            f"R² {fit.r_squared:.4f}, RMSE {fit.rmse:.3f} mm"
        )
    slow, fast = (MINUTE * speed for speed in model.speeds)
    lines.append(
        f"{len(measured.width)} beads, {slow:g} to {fast:g} mm/min, r {model.radii[0]:g} to {model.radii[1]:g} mm, wire "
        f"{MINUTE * model.wire_feed / 1000.0:g} m/min"
    )
    return "\n".join(lines)


def speeds_told(model: BeadModel, width: float) -> str:
    """What speeds a width asks for, and whether the table has such."""
    asked = model.speed_for(width, np.array([model.radii[0], np.inf]))
    ends = np.select([asked.too_slow, asked.too_fast], [" (the slowest of the table)", " (the fastest of the table)"], "")
    tight, straight = (f"{MINUTE * speed:.0f} mm/min{end}" for speed, end in zip(asked.speed, ends, strict=True))
    return f"{width:g} mm wide: {straight} where straight, {tight} where r is {model.radii[0]:g} mm"


def _signed(number: float) -> str:
    return f"{'+' if number >= 0.0 else '−'} {abs(number):.4g}"


def _spread(values: Array) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    more = _ROOM * max(high - low, 1e-3)
    return low - more, high + more


def _place(values: Array, reach: tuple[float, float], start: float, length: float) -> Array:
    """Where values lie on the screen along an axis."""
    found: Array = start + (values - reach[0]) / (reach[1] - reach[0]) * length
    return found
