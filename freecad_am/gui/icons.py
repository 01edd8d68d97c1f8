# SPDX-License-Identifier: LGPL-2.1-or-later
"""Return paths of icons, and icons with a badge for the status of an object."""

from __future__ import annotations

import os
import tempfile
from typing import Any

import FreeCAD as App
from PySide import QtCore, QtGui

import freecad_am

FOLDER = os.path.join(
    os.path.dirname(os.path.dirname(os.path.abspath(freecad_am.__file__))), "resources", "icons"
)
BADGES = {"stale": "#f5a623", "failed": "#e5243b", "infeasible": "#e5243b"}

# player icons: polygons in a square of 16, and bars by left edge and width
_TRIANGLE_ON, _TRIANGLE_BACK = ((0, 2), (6, 8), (0, 14)), ((6, 2), (0, 8), (6, 14))
_MARKS = {
    "play": (((3, 2), (14, 8), (3, 14)),),
    "pause": (((3, 2), (6, 2), (6, 14), (3, 14)), ((10, 2), (13, 2), (13, 14), (10, 14))),
    "point_on": tuple(tuple((x + shift, y) for x, y in _TRIANGLE_ON) for shift in (2, 8)),
    "point_back": tuple(tuple((x + shift, y) for x, y in _TRIANGLE_BACK) for shift in (2, 8)),
    "layer_on": (
        *(tuple((x + shift, y) for x, y in _TRIANGLE_ON) for shift in (1, 7)),
        ((13, 2), (15, 2), (15, 14), (13, 14)),
    ),
    "layer_back": (
        *(tuple((x + shift, y) for x, y in _TRIANGLE_BACK) for shift in (3, 9)),
        ((1, 2), (3, 2), (3, 14), (1, 14)),
    ),
}
_SIZES = (16, 24, 32, 64)  # pixels

_made: dict[tuple[str, str], str] = {}


def path(name: str) -> str:
    """Return the path of one of our icons."""
    return os.path.join(FOLDER, f"{name}.svg")


def player_icon(name: str, colour: Any) -> Any:
    """Return the icon of a player button, such as "play", in a colour."""
    icon = QtGui.QIcon()
    for size in _SIZES:
        pixmap = QtGui.QPixmap(size, size)
        pixmap.fill(QtCore.Qt.transparent)
        painter = QtGui.QPainter(pixmap)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        painter.scale(size / 16.0, size / 16.0)
        painter.setPen(QtCore.Qt.NoPen)
        painter.setBrush(QtGui.QBrush(colour))
        for corners in _MARKS[name]:
            painter.drawPolygon(QtGui.QPolygonF([QtCore.QPointF(x, y) for x, y in corners]))
        painter.end()
        icon.addPixmap(pixmap)
    return icon


def badge_path(name: str, status: str) -> str:
    """Return the path of the icon with a dot in the colour of the status; the plain icon without
    problems.
    """
    colour = BADGES.get(status)
    if colour is None:
        return path(name)
    if (name, colour) not in _made or not os.path.exists(_made[name, colour]):
        with open(path(name), encoding="utf-8") as file:
            text = file.read()
        dot = f'<circle cx="50" cy="50" r="12" fill="{colour}" stroke="#ffffff" stroke-width="4"/>'
        with tempfile.NamedTemporaryFile(
            "w",
            prefix=f"{name}_",
            suffix=".svg",
            dir=App.getTempPath(),
            delete=False,
            encoding="utf-8",
        ) as icon_file:
            icon_file.write(text.replace("</svg>", f"{dot}</svg>"))
        _made[name, colour] = icon_file.name
    return _made[name, colour]
