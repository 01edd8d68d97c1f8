# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colours of the window: text colours for light and dark themes, and a perceptual ramp.

The lightness of the ramp rises evenly and its hue runs from blue to yellow, so that order is
visible.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from ..core.types import Array
from ..objects.fields import preferences
from .widgets.upright import present

STEPS = 256
# roles of texts; PLAIN is the theme's own text colour
PLAIN, INVALID, GOOD, FAINT = "plain", "wrong", "good", "faint"
# contrast of at least 4.5:1 on the backgrounds of FreeCAD's themes
_ON_LIGHT = {INVALID: "#b3121f", GOOD: "#14693d", FAINT: "#5c6370"}
_ON_DARK = {INVALID: "#ff8a80", GOOD: "#5fd39b", FAINT: "#aab3c0"}
_ROLE = "RoboticAM_colour"  # property of widgets whose text has a role
_PROBE = "RoboticAM_ThemeProbe"
_MIDDLE = 128  # of 255; lightness that separates light and dark

# first hue, hue range, deg, and saturation
_HUES = dict(
    zip(
        preferences.RAMPS, ((275.0, -170.0, 1.0), (305.0, 125.0, 0.9), (0.0, 0.0, 0.0)), strict=True
    )
)

# Oklab (B. Ottosson, 2020): linear sRGB -> LMS, cube root, -> L a b
_LMS = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def ramp(share: Any) -> Array:
    """Return colours (n, 3) in 0..1 of fractions (n,) in 0..1, from the preferred ramp.

    The default runs through dark blue, teal, green and yellow.
    """
    positions = np.clip(np.asarray(share, dtype=np.float64), 0.0, 1.0) * (STEPS - 1)
    return _table(preferences.ramp())[np.rint(positions).astype(int)]


@cache
def _table(name: str) -> Array:
    share = np.linspace(0.0, 1.0, STEPS)
    lightness = 0.42 + 0.47 * share
    start_hue, turn, strong = _HUES[name]
    hue = np.radians(start_hue + turn * share)
    chroma = strong * (0.17 - 0.02 * np.sin(np.pi * share))
    lab = np.stack([lightness, chroma * np.cos(hue), chroma * np.sin(hue)], axis=-1)
    linear = (lab @ np.linalg.inv(_LAB).T) ** 3 @ np.linalg.inv(_LMS).T
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


# ---- the theme of the window


class _Probe(QtGui.QLabel):
    """A hidden label that receives the theme's text colour, by palette or by stylesheet."""

    def __init__(self) -> None:
        super().__init__(Gui.getMainWindow())
        self.setObjectName(_PROBE)
        self.hide()
        self.ensurePolished()
        self.dark: bool | None = None

    def changeEvent(self, event: Any) -> None:
        """Called by Qt, among others when the theme changes."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange):
            QtCore.QTimer.singleShot(0, _renew)


_probe: list[_Probe] = []
_listeners: list[Callable[[], None]] = []


def ink() -> Any:
    """Return the theme's plain text colour."""
    if not _probe:
        _probe.append(_Probe())
        _probe[0].dark = is_dark()
    return _probe[0].palette().color(QtGui.QPalette.WindowText)


def is_dark() -> bool:
    """Whether the theme has light texts on a dark background."""
    return bool(ink().lightness() > _MIDDLE)


def of(role: str) -> Any:
    """Return the text colour of a role in the current theme."""
    table = _ON_DARK if is_dark() else _ON_LIGHT
    return QtGui.QColor(table[role]) if role in table else ink()


def set_role(widget: Any, role: str) -> None:
    """Give the text of a widget the colour of a role; the colour follows the theme."""
    widget.setProperty(_ROLE, role)
    kind = "QLabel" if isinstance(widget, QtGui.QLabel) else widget.metaObject().className()
    sheet = "" if role == PLAIN else f"{kind} {{ color: {of(role).name()}; }}"
    if widget.styleSheet() != sheet:
        widget.setStyleSheet(sheet)


def listen(listener: Callable[[], None]) -> None:
    """Call `listener` whenever the window changes between light and dark."""
    _listeners.append(listener)


def forget(listener: Callable[[], None]) -> None:
    """Stop calling `listener`."""
    if listener in _listeners:
        _listeners.remove(listener)


def _renew() -> None:
    """Recolour all texts with a role for the current theme."""
    if not _probe or _probe[0].dark == is_dark():
        return
    _probe[0].dark = is_dark()
    for widget in present(Gui.getMainWindow(), QtGui.QWidget):
        role = widget.property(_ROLE)
        if role:
            set_role(widget, role)
    for listener in _listeners:
        listener()
