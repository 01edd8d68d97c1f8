# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joints as bars: where each axis is in its range, with figures, red at the end of it or where it is too fast."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from freecad_am.core.types import Array, Mask

from .. import colours
from ..texts.translation import tr

GROOVE = 60  # of 255, how strong the ground of a bar is
GOOD, BAD = QtGui.QColor(59, 111, 212), QtGui.QColor(206, 34, 44)
_PAD, _GAP = 4, 6


class JointBars(QtGui.QWidget):
    """lower, upper: (axes,) in the units shown, infinite of endless axes, which have no bar but a turning mark."""

    def __init__(
        self, names: Sequence[str], units: Sequence[str], lower: Array, upper: Array
    ) -> None:
        super().__init__()
        self.setObjectName("joints")
        self.names, self.units, self.lower, self.upper = names, units, lower, upper
        self.values = np.zeros(len(names))
        self.margins = np.full(len(names), np.inf)
        self.ratios = np.zeros(len(names))
        self.bad = np.zeros(len(names), dtype=bool)
        self.row = self.fontMetrics().height() + 6
        self.setMinimumHeight(self.row * (len(names) + 1) + 2)
        self.setToolTip(
            tr(
                "Range of each joint, its distance to the nearer limit, and its speed as a share "
                "of the maximum"
            )
        )

    def set(self, values: Array, margins: Array, ratios: Array, bad: Mask) -> None:
        """(axes,) values and margins in the units shown, shares of the largest speeds, and which are to be red."""
        self.values, self.margins, self.ratios, self.bad = values, margins, ratios, bad
        self.update()

    def texts(self, axis: int) -> tuple[str, str, str]:
        """Value, margin and share of speed of an axis as they are told."""
        unit = "°" if self.units[axis] == "deg" else " mm"
        if not np.isfinite(self.values[axis]):
            return "–", "–", "–"
        margin = f"{self.margins[axis]:.1f}{unit}" if np.isfinite(self.margins[axis]) else "∞"
        return (
            f"{round(float(self.values[axis]), 1) + 0.0:.1f}{unit}",
            margin,
            f"{100.0 * self.ratios[axis]:.0f} %",
        )

    def paintEvent(self, event: Any) -> None:
        """Draw all rows."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        wide = self.fontMetrics().boundingRect
        most = "8888.8 mm" if "mm" in self.units else "8888.8°"
        name, value, margin, speed = (
            wide(text).width() + _GAP
            for text in (max(self.names, key=len), f"-{most}", most, "88888 %")
        )
        name = max(name, 22)
        left, right = _PAD + name + value, self.width() - _PAD - margin - speed
        heads = (
            (left, right - left, tr("range")),
            (right, margin, tr("margin")),
            (right + margin, speed, tr("speed")),
        )
        ink, faint = colours.ink(), QtGui.QColor(colours.ink())
        faint.setAlpha(GROOVE)
        painter.setPen(colours.of(colours.FAINT))
        for at, width, text in heads:
            flags = QtCore.Qt.AlignVCenter | (
                QtCore.Qt.AlignHCenter if text == heads[0][2] else QtCore.Qt.AlignRight
            )
            painter.drawText(QtCore.QRect(at, 0, width, self.row), int(flags), text)
        for axis, label in enumerate(self.names):
            top = (axis + 1) * self.row
            colour = colours.of(colours.WRONG) if self.bad[axis] else ink
            painter.setPen(colour)
            shown = self.texts(axis)
            self._text(painter, _PAD, top, name, label, False)
            self._text(painter, _PAD + name, top, value - _GAP, shown[0], True)
            self._text(painter, right, top, margin, shown[1], True)
            self._text(painter, right + margin, top, speed, shown[2], True)
            self._bar(painter, left, top, right - left, axis, faint)
        painter.end()

    def _bar(self, painter: Any, left: int, top: int, width: int, axis: int, faint: Any) -> None:
        high = self.row
        groove = QtCore.QRectF(
            left + _GAP, top + 0.36 * high, max(width - 2 * _GAP, 8), 0.28 * high
        )
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(faint)
        painter.drawRoundedRect(groove, 2, 2)
        value = self.values[axis]
        if not np.isfinite(value):
            return
        lower, upper = self.lower[axis], self.upper[axis]
        if not np.isfinite(upper - lower):
            lower, upper, value = 0.0, 360.0, value % 360.0
        share = float(np.clip((value - lower) / (upper - lower), 0.0, 1.0))
        colour = BAD if self.bad[axis] else GOOD
        middle = groove.left() + 0.5 * groove.width()
        at = groove.left() + share * groove.width()
        painter.setBrush(colour.lighter(150))
        painter.drawRect(
            QtCore.QRectF(min(middle, at), groove.top(), abs(at - middle), groove.height())
        )
        painter.setBrush(colour)
        painter.drawRoundedRect(QtCore.QRectF(at - 2.5, top + 0.18 * high, 5.0, 0.64 * high), 2, 2)

    def _text(
        self, painter: Any, left: int, top: int, width: int, text: str, to_right: bool
    ) -> None:
        side = QtCore.Qt.AlignRight if to_right else QtCore.Qt.AlignLeft
        painter.drawText(
            QtCore.QRect(left, top, width, self.row), int(side | QtCore.Qt.AlignVCenter), text
        )
