# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths of icons, and icons with a badge that tells the status of an object."""

from __future__ import annotations

import os
import tempfile

import FreeCAD as App

import freecad_am

FOLDER = os.path.join(
    os.path.dirname(os.path.dirname(os.path.abspath(freecad_am.__file__))), "resources", "icons"
)
BADGES = {"stale": "#f5a623", "failed": "#e5243b", "infeasible": "#e5243b"}

_made: dict[tuple[str, str], str] = {}


def path(name: str) -> str:
    """The path of an icon of ours."""
    return os.path.join(FOLDER, f"{name}.svg")


def with_badge(name: str, status: str) -> str:
    """The path of the icon with a dot in the colour of the status; the plain icon when all is well."""
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
        ) as made:
            made.write(text.replace("</svg>", f"{dot}</svg>"))
        _made[name, colour] = made.name
    return _made[name, colour]
