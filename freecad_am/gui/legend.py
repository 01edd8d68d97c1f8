# SPDX-License-Identifier: LGPL-2.1-or-later
"""Legends in the upper left corner of the 3D views: a bar of colours with numbers for each toolpath to be seen.

They are widgets over the view, so they stay put and sharp whatever the camera does.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from .colouring import DISTANCE, NONE, TOO_FAR, TOO_NEAR, Scale
from .colours import ramp

NAME = "RoboticAM_Legend"
_FINE = 0.01  # mm; distances that differ by less are told to 1e-5 mm
_MARGIN, _PAD, _BAR_WIDTH, _BAR_HEIGHT, _STEPS = 10, 9, 16, 150, 150
_GROUND, _EDGE, _INK = QtGui.QColor(255, 255, 255, 225), QtGui.QColor(150, 155, 165), QtGui.QColor(29, 36, 48)


class Overlay(QtGui.QWidget):
    """The legends of one view, side by side. `host` is the widget of the view, which must be kept as long."""

    def __init__(self, host: Any) -> None:
        super().__init__(host)
        self.host = host
        self.scales: list[tuple[str, Scale]] = []
        self.setObjectName(NAME)
        self.setAttribute(QtCore.Qt.WA_TransparentForMouseEvents)
        self.setFocusPolicy(QtCore.Qt.NoFocus)
        self.move(_MARGIN, _MARGIN)

    def show_scales(self, scales: list[tuple[str, Scale]]) -> None:
        """Show these, each with the name of its toolpath where there are several."""
        if scales == self.scales and self.isVisible() == bool(scales):
            return
        self.scales = scales
        self.setVisible(bool(scales))
        if scales:
            self.resize(sum(self._width(*entry) + _MARGIN for entry in scales), max(map(self._height, scales)))
            self.raise_()
        self.update()

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        left = 0
        for entry in self.scales:
            width = self._width(*entry)
            painter.setPen(_EDGE)
            painter.setBrush(_GROUND)
            painter.drawRoundedRect(left, 0, width - 1, self._height(entry) - 1, 5, 5)
            self._draw(painter, left + _PAD, *entry)
            left += width + _MARGIN
        painter.end()

    # ---- one legend

    def _lines(self, name: str, scale: Scale) -> list[str]:
        title = f"{scale.title}, {scale.unit}" if scale.unit else scale.title
        return [*([name] if len(self.scales) > 1 else []), title]

    def _foot(self, scale: Scale) -> str:
        decimals = 3 if scale.most - scale.least > _FINE else 5
        return f"{scale.least:.{decimals}f} … {scale.most:.{decimals}f}" if scale.title == DISTANCE else ""

    def _line(self) -> int:
        return int(self.fontMetrics().height())

    def _wide(self, text: str) -> int:
        return int(self.fontMetrics().boundingRect(text).width()) + 6

    def _width(self, name: str, scale: Scale) -> int:
        numbers = [f"< {text}" for _, text in scale.ticks] + [scale.without] + [text for text, _ in scale.classes]
        beside = _BAR_WIDTH + 10 + max(map(self._wide, numbers))
        return 2 * _PAD + max(beside, *map(self._wide, [*self._lines(name, scale), self._foot(scale)]))

    def _height(self, entry: tuple[str, Scale]) -> int:
        name, scale = entry
        if scale.classes:
            return 2 * _PAD + (len(self._lines(name, scale)) + len(scale.classes)) * (self._line() + 3)
        rows = len(self._lines(name, scale)) + scale.below + scale.above + bool(scale.without) + bool(self._foot(scale))
        return 2 * _PAD + rows * (self._line() + 3) + _BAR_HEIGHT + self._line()

    def _draw(self, painter: Any, left: int, name: str, scale: Scale) -> None:
        line, top = self._line(), _PAD
        for text in self._lines(name, scale):
            self._text(painter, left, top, text)
            top += line + 3
        for text, colour in scale.classes:
            self._swatch(painter, left, top, colour, text)
            top += line + 3
        if scale.classes:
            return
        if scale.above:
            self._swatch(painter, left, top, TOO_FAR, f"> {scale.ticks[-1][1]}")
            top += line + 3
        top += line // 2
        shares = np.linspace(1.0, 0.0, _STEPS) if scale.high > scale.low else np.full(_STEPS, 0.5)
        painter.setRenderHint(QtGui.QPainter.Antialiasing, False)
        for row, colour in enumerate(ramp(shares)):
            painter.fillRect(left, top + row * _BAR_HEIGHT // _STEPS, _BAR_WIDTH, 1, _colour(colour))
        painter.setPen(_INK)
        for number, text in scale.ticks:
            down = top + round((1.0 - float(scale.share(np.array(number)))) * (_BAR_HEIGHT - 1))
            painter.drawLine(left + _BAR_WIDTH, down, left + _BAR_WIDTH + 4, down)
            self._text(painter, left + _BAR_WIDTH + 8, down - line // 2, text)
        painter.setRenderHint(QtGui.QPainter.Antialiasing, True)
        top += _BAR_HEIGHT + line // 2 + 3
        if scale.below:
            self._swatch(painter, left, top, TOO_NEAR, f"< {scale.ticks[0][1]}")
            top += line + 3
        if scale.without:
            self._swatch(painter, left, top, NONE, scale.without)
            top += line + 3
        self._text(painter, left, top, self._foot(scale))

    def _swatch(self, painter: Any, left: int, top: int, colour: Any, text: str) -> None:
        painter.fillRect(left, top + 2, _BAR_WIDTH, self._line() - 4, _colour(colour))
        self._text(painter, left + _BAR_WIDTH + 8, top, text)

    def _text(self, painter: Any, left: int, top: int, text: str) -> None:
        painter.setPen(_INK)
        painter.drawText(left, top + self.fontMetrics().ascent(), text)


def _colour(colour: Any) -> Any:
    return QtGui.QColor.fromRgbF(*(float(part) for part in colour))


# ---- which views show what

_overlays: list[Overlay] = []
_watching: list[Any] = []
_due = False


def renew_soon() -> None:
    """Bring the legends of all views up to date, once what is going on now is done."""
    global _due
    if not _watching:
        _watch()
    if not _due:
        _due = True
        QtCore.QTimer.singleShot(0, _renew)


def _renew() -> None:
    global _due
    _due = False
    _overlays[:] = [overlay for overlay in _overlays if _alive(overlay)]
    for name in App.listDocuments():
        document = Gui.getDocument(name)
        scales = _scales(document.Document)
        for view in document.mdiViewsOfType("Gui::View3DInventor"):
            host = view.graphicsView()
            overlay = next((one for one in _overlays if one.host is host), None)
            if overlay is None and scales:
                overlay = Overlay(host)
                _overlays.append(overlay)
            if overlay is not None:
                overlay.show_scales(scales)


def _scales(document: Any) -> list[tuple[str, Scale]]:
    """The scales of what is to be seen in a document."""
    found = []
    for obj in document.Objects:
        vobj = obj.ViewObject
        scale = getattr(getattr(vobj, "Proxy", None), "scale", None)
        if scale is not None and vobj.Visibility and vobj.ShowLegend:
            found.append((obj.Label, scale))
    return found


def _alive(overlay: Overlay) -> bool:
    try:
        overlay.isVisible()
    except RuntimeError:  # its view is closed
        return False
    return True


class _Observer:
    """What happens to documents without the view providers being told."""

    def slotDeletedObject(self, obj: Any) -> None:
        """Called by FreeCAD."""
        renew_soon()

    def slotUndoDocument(self, document: Any) -> None:
        """Called by FreeCAD."""
        renew_soon()

    slotRedoDocument = slotUndoDocument


def _watch() -> None:
    observer = _Observer()
    App.addDocumentObserver(observer)
    views = Gui.getMainWindow().findChild(QtGui.QMdiArea)
    views.subWindowActivated.connect(lambda *_: renew_soon())  # also of a view that is new
    _watching.extend([observer, views])
