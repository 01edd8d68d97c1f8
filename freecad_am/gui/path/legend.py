# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw legends in the upper left corner of 3D views and of images saved from them: a colour bar
with numbers for each visible path.

A legend is an image in the scene of its path, drawn last and through its own camera. It therefore
stays fixed and sharp under camera moves, and appears and disappears with its path. Several visible
legends are placed side by side.
"""

from __future__ import annotations

import weakref
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from pivy import coin
from PySide import QtCore, QtGui

from ...objects.fields import preferences
from .. import colours, preferences_watch
from ..colours import ramp
from ..in_language import tr, translated
from ..nodes.lines import unshaded
from .colouring import ABOVE_COLOUR, BELOW_COLOUR, DISTANCE, Scale

_FINE = 0.01  # mm; smaller differences of distances are shown to 1e-5 mm
_MARGIN, _PAD, _BAR_WIDTH, _BAR_HEIGHT, _STEPS = 10, 9, 16, 150, 150
# background, edge and text colours, by whether the theme is dark
_COLOURS = {
    False: (
        QtGui.QColor(255, 255, 255, 225),
        QtGui.QColor(150, 155, 165),
        QtGui.QColor(29, 36, 48),
    ),
    True: (QtGui.QColor(26, 32, 43, 235), QtGui.QColor(98, 106, 122), QtGui.QColor(230, 233, 239)),
}
Entry = tuple[tuple[str, ...], Scale]  # lines above the scale, and the scale


class Legend:
    """The legend of a path, hidden until `show`."""

    def __init__(self) -> None:
        self.entry: Entry | None = None
        self.left = 0  # px from the edge
        self.look = ("", "", False)  # ramp, language, and whether the theme is dark
        # the view ranges from -1 to 1
        self.camera = coin.SoOrthographicCamera()
        self.camera.viewportMapping = coin.SoCamera.LEAVE_ALONE
        self.camera.height, self.camera.position = 2.0, (0.0, 0.0, 1.0)
        self.camera.nearDistance, self.camera.farDistance = 0.5, 1.5
        self.switch, self.image = coin.SoSwitch(), coin.SoImage()
        self.image.horAlignment, self.image.vertAlignment = coin.SoImage.LEFT, coin.SoImage.TOP
        corner, pick, callback = coin.SoTranslation(), coin.SoPickStyle(), coin.SoCallback()
        corner.translation = (-1.0, 1.0, 0.0)
        pick.style = coin.SoPickStyle.UNPICKABLE
        callback.setCallback(_look, weakref.ref(self))  # pivy never releases the object passed here
        bounds = coin.SoResetTransform()  # excludes the legend from bounding boxes
        bounds.whatToReset = coin.SoResetTransform.BBOX
        on_top = coin.SoAnnotation()
        for child in (
            pick,
            unshaded(),
            coin.SoResetTransform(),
            callback,
            corner,
            self.image,
            bounds,
        ):
            on_top.addChild(child)
        self.switch.addChild(on_top)

    @property
    def node(self) -> Any:
        """The node to add to a scene."""
        return self.switch

    def show(self, entry: Entry, left: int) -> int:
        """Show an entry `left` px from the edge; return its width including the margin, px."""
        width = _width(*entry)
        look = preferences.ramp(), tr("en"), colours.is_dark()
        if (entry, left, look) != (self.entry, self.left, self.look):
            self.entry, self.left, self.look = entry, left, look
            pixels = _picture(entry, left)
            self.image.image.setValue(
                coin.SbVec2s(pixels.shape[1], pixels.shape[0]), 4, pixels.tobytes()
            )
        self.switch.whichChild = coin.SO_SWITCH_ALL
        return width + _MARGIN

    def hide(self) -> None:
        """Hide the legend."""
        self.entry = None
        self.switch.whichChild = coin.SO_SWITCH_NONE


def _look(legend: weakref.ref[Legend], action: Any) -> None:
    target = legend()
    # the camera is not a node of the scene, because mouse rays must not use it
    if target is not None and action.isOfType(coin.SoGLRenderAction.getClassTypeId()):
        target.camera.doAction(action)


def _picture(entry: Entry, left: int) -> Any:
    """Return the pixels (rows from below, columns, 4) of a legend `left` px from the corner of the
    view.
    """
    ratio = float(Gui.getMainWindow().devicePixelRatio())
    wide, high = left + _MARGIN + _width(*entry), _MARGIN + _height(*entry)
    image = QtGui.QImage(round(ratio * wide), round(ratio * high), QtGui.QImage.Format_RGBA8888)
    image.setDevicePixelRatio(ratio)
    image.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(image)
    painter.setFont(QtGui.QApplication.font())
    painter.setRenderHint(QtGui.QPainter.Antialiasing)
    painter.translate(left + _MARGIN, _MARGIN)
    ground, edge, _ = _COLOURS[colours.is_dark()]
    painter.setPen(edge)
    painter.setBrush(ground)
    painter.drawRoundedRect(0, 0, _width(*entry) - 1, _height(*entry) - 1, 5, 5)
    _draw(painter, *entry)
    painter.end()
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(image.height(), -1, 4)
    return np.ascontiguousarray(rows[::-1, : image.width()])


# ---- contents of a legend


def _lines(names: tuple[str, ...], scale: Scale) -> list[str]:
    title = translated(scale.title)
    return [*names, f"{title}, {scale.unit}" if scale.unit else title]


def _foot(scale: Scale) -> str:
    decimals = 3 if scale.highest - scale.lowest > _FINE else 5
    return (
        f"{scale.lowest:.{decimals}f} … {scale.highest:.{decimals}f}"
        if scale.title == DISTANCE
        else ""
    )


def _metrics() -> Any:
    return QtGui.QFontMetrics(QtGui.QApplication.font())


def _line() -> int:
    return int(_metrics().height())


def _wide(text: str) -> int:
    return int(_metrics().boundingRect(text).width()) + 6


def _width(names: tuple[str, ...], scale: Scale) -> int:
    texts = [text for _, text in scale.ticks]
    texts += map(
        translated, [*(text for text, _ in scale.classes), scale.below, scale.above, scale.without]
    )
    side = _BAR_WIDTH + 10 + max(map(_wide, texts))
    return 2 * _PAD + max(side, *map(_wide, [*_lines(names, scale), _foot(scale)]))


def _height(names: tuple[str, ...], scale: Scale) -> int:
    if scale.classes:
        return 2 * _PAD + (len(_lines(names, scale)) + len(scale.classes)) * (_line() + 3)
    notes = [scale.below, scale.above, scale.without, _foot(scale)]
    return (
        2 * _PAD
        + (len(_lines(names, scale)) + sum(map(bool, notes))) * (_line() + 3)
        + _BAR_HEIGHT
        + _line()
    )


def _draw(painter: Any, names: tuple[str, ...], scale: Scale) -> None:
    line, left, top = _line(), _PAD, _PAD
    for text in _lines(names, scale):
        _text(painter, left, top, text)
        top += line + 3
    for text, colour in scale.classes:
        _swatch(painter, left, top, colour, text)
        top += line + 3
    if scale.classes:
        return
    if scale.above:
        _swatch(painter, left, top, ABOVE_COLOUR, scale.above)
        top += line + 3
    top += line // 2
    shares = np.linspace(1.0, 0.0, _STEPS) if scale.high > scale.low else np.full(_STEPS, 0.5)
    painter.setRenderHint(QtGui.QPainter.Antialiasing, False)
    for row, colour in enumerate(ramp(shares)):
        painter.fillRect(left, top + row * _BAR_HEIGHT // _STEPS, _BAR_WIDTH, 1, _colour(colour))
    painter.setPen(_COLOURS[colours.is_dark()][2])
    for number, text in scale.ticks:
        down = top + round((1.0 - float(scale.share(np.array(number)))) * (_BAR_HEIGHT - 1))
        painter.drawLine(left + _BAR_WIDTH, down, left + _BAR_WIDTH + 4, down)
        _text(painter, left + _BAR_WIDTH + 8, down - line // 2, text)
    painter.setRenderHint(QtGui.QPainter.Antialiasing, True)
    top += _BAR_HEIGHT + line // 2 + 3
    for text, colour in ((scale.below, BELOW_COLOUR), (scale.without, scale.without_colour)):
        if text:
            _swatch(painter, left, top, colour, text)
            top += line + 3
    _text(painter, left, top, _foot(scale))


def _swatch(painter: Any, left: int, top: int, colour: Any, text: str) -> None:
    painter.fillRect(left, top + 2, _BAR_WIDTH, _line() - 4, _colour(colour))
    _text(painter, left + _BAR_WIDTH + 8, top, translated(text))


def _text(painter: Any, left: int, top: int, text: str) -> None:
    painter.setPen(_COLOURS[colours.is_dark()][2])
    painter.drawText(left, top + painter.fontMetrics().ascent(), text)


def _colour(colour: Any) -> Any:
    return QtGui.QColor.fromRgbF(*(float(channel) for channel in colour))


# ---- visible legends


class _Renewal:
    """Updates all legends once after an event that requests it, and watches for changes."""

    def __init__(self) -> None:
        self.observer: _Observer | None = None
        self.is_due = False

    def ask(self) -> None:
        """Update all legends after the current event."""
        if self.observer is None:
            self.observer = _Observer()
            App.addDocumentObserver(self.observer)
            preferences_watch.listen_to_language(self.ask)
            colours.listen(self.ask)
        if not self.is_due:
            self.is_due = True
            QtCore.QTimer.singleShot(0, self._renew)

    def _renew(self) -> None:
        self.is_due = False
        for document in App.listDocuments().values():
            _arrange(document)


_renewal = _Renewal()
renew_soon = _renewal.ask


def _arrange(document: Any) -> None:
    """Show the legends of the visible paths side by side, with names if several."""
    visible = []
    for obj in document.Objects:
        view = getattr(obj.ViewObject, "Proxy", None)
        if isinstance(getattr(view, "legend", None), Legend):
            if view.scale is not None and obj.ViewObject.Visibility and obj.ViewObject.ShowLegend:
                visible.append((obj.Label, view))
            else:
                view.legend.hide()
    left = 0
    for label, view in visible:
        left += view.legend.show(((label,) if len(visible) > 1 else (), view.scale), left)


def visible_scales(document: Any) -> list[Scale]:
    """Return the scales whose legends are visible in a document."""
    legends = [
        getattr(getattr(obj.ViewObject, "Proxy", None), "legend", None) for obj in document.Objects
    ]
    return [
        legend.entry[1]
        for legend in legends
        if isinstance(legend, Legend) and legend.entry is not None
    ]


class _Observer:
    """Document events that do not reach the view providers."""

    def slotDeletedObject(self, obj: Any) -> None:
        """Called by FreeCAD."""
        renew_soon()

    def slotUndoDocument(self, document: Any) -> None:
        """Called by FreeCAD."""
        renew_soon()

    slotRedoDocument = slotUndoDocument
