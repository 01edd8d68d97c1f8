# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deviations of an inspection as bars, in the colours of its points."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.inspection.bands import band_of, bands
from ...core.inspection.figures import Spread
from ...objects.fields.shown_units import scale_of
from .. import colours
from ..path.colouring import round_numbers
from ..texts.translation import tr

HEIGHT = 130
_SIDE, _TOP, _FOOT, _FAINT = 12, 6, 34, 90


class Histogram(QtGui.QWidget):
    """How many points have what deviation, and where the tolerance ends."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("DeviationHistogram")
        self.setMinimumHeight(HEIGHT)
        self.spread: Spread | None = None
        self.tolerance = 1.0

    def set(self, spread: Spread, tolerance: float) -> None:
        """Show other deviations."""
        self.spread, self.tolerance = spread, tolerance
        self.update()

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(240, HEIGHT)

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        if self.spread is None:
            return
        painter = QtGui.QPainter(self)
        edges, counts = self.spread.edges, self.spread.counts
        low, high = min(float(edges[0]), -self.tolerance), max(float(edges[-1]), self.tolerance)
        area = QtCore.QRectF(_SIDE, _TOP, self.width() - 2 * _SIDE, self.height() - _TOP - _FOOT)

        def across(value: float) -> float:
            return float(area.left() + (value - low) / (high - low) * area.width())

        shades = [QtGui.QColor.fromRgbF(*one.colour) for one in bands(self.tolerance)]
        which = band_of(0.5 * (edges[:-1] + edges[1:]), self.tolerance)
        most = max(int(counts.max()), 1)
        for start, end, count, band in zip(edges[:-1], edges[1:], counts, which, strict=True):
            tall = area.height() * int(count) / most
            left = across(float(start))
            bar = QtCore.QRectF(
                left, area.bottom() - tall, max(across(float(end)) - left - 0.5, 0.5), tall
            )
            painter.fillRect(bar, shades[int(band)])
        self._axis(painter, area, across, low, high)
        painter.end()

    def _axis(self, painter: Any, area: Any, across: Any, low: float, high: float) -> None:
        ink = colours.ink()
        faint = QtGui.QColor(ink)
        faint.setAlpha(_FAINT)
        painter.setPen(QtGui.QPen(faint, 1.0, QtCore.Qt.DashLine))
        for limit in (-self.tolerance, self.tolerance):
            painter.drawLine(
                QtCore.QPointF(across(limit), area.top()),
                QtCore.QPointF(across(limit), area.bottom()),
            )
        painter.setPen(ink)
        painter.drawLine(area.bottomLeft(), area.bottomRight())
        line = painter.fontMetrics().height()
        factor, unit = scale_of(high, "mm")
        for number in np.asarray(round_numbers(factor * low, factor * high, 0.0)).tolist():
            box = QtCore.QRectF(across(number / factor) - 30.0, area.bottom() + 2.0, 60.0, line)
            painter.drawText(box, QtCore.Qt.AlignHCenter, f"{number:g}")
        most = int(self.spread.counts.max())
        text = (
            tr("deviation, {} (most: 1 point)").format(unit)
            if most == 1
            else tr("deviation, {} (most: {} points)").format(unit, most)
        )
        box = QtCore.QRectF(0.0, self.height() - line - 1.0, self.width(), line)
        painter.drawText(box, QtCore.Qt.AlignHCenter, text)
