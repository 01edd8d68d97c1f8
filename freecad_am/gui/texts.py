# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of the window in the user's language."""

from __future__ import annotations

import FreeCAD as App

CONTEXT = "RoboticAM"


def tr(text: str) -> str:
    """The text in the language of FreeCAD's window; itself where no translation is there.

    Called with literals, so that a script can collect them; figures are put in afterwards, by `format`.
    """
    return str(App.Qt.translate(CONTEXT, text))
