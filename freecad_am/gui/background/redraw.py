# SPDX-License-Identifier: LGPL-2.1-or-later
"""A picture that changes together with fields of the window: both in one turn of the window.

Coin has a changed view drawn a turn after Qt has painted changed fields, and in each of the two Qt puts the whole window
together, fields and picture. That costs as much as a small picture does, so a moving one asks for its turn with the fields.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui


def schedule_redraw(view: Any) -> None:
    """Redraw a 3D view together with the fields that change now. Raises RuntimeError if it is closed."""
    # not view.redraw(): in FreeCAD 0.20 that may draw at once, and it leaves out what Coin still has to do before
    view.graphicsView().viewport().update()


def views_with_fields(document: str) -> None:
    """Schedule a redraw of all 3D views of a document."""
    if document in App.listDocuments():
        for view in Gui.getDocument(document).mdiViewsOfType("Gui::View3DInventor"):
            schedule_redraw(view)
