# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool that opens a simulation."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from ...core.issues import AmError
from ...objects.stage import stage_of
from ...objects.work import hooks
from ...objects.work.progress import Cancelled
from ..in_language import error_line, tr, translated_error
from ..widgets.shape_inputs import job_named, job_selection
from . import dock
from .player import prepared

KINDS = ("program", "joint path")


def simulate() -> None:
    """Simulate the selected joint path, program or job; without such a selection, the document's
    last joint path with a result."""
    selected = [obj for obj in job_selection() if _kind(obj) in KINDS]
    if not selected and job_named():
        _say(
            tr("{} has no joint path to simulate; make one first, or select another job.").format(
                job_named()
            )
        )
        return
    candidates = [
        obj for obj in App.ActiveDocument.Objects if _kind(obj) == "joint path" and obj.Key
    ]
    if selected or candidates:
        show(selected[0] if selected else candidates[-1])
    else:
        _say(tr("There is no joint path to simulate; make one first."))


def show(obj: Any) -> None:
    """Simulate a joint path or a program in a 3D view of its document; errors go to the status bar.

    A long run is prepared in the background and can be cancelled.
    """
    name = obj.Document.Name
    document = Gui.getDocument(obj.Document.Name)
    views = document.mdiViewsOfType("Gui::View3DInventor")
    active = document.activeView()
    view = active if hasattr(active, "getSceneGraph") else views[0] if views else None
    if view is None:
        _say(tr("There is no 3D view to simulate in; open one."))
        return
    try:
        run = hooks.carry_out(prepared(obj), tr("Simulation"))
    except AmError as error:
        App.Console.PrintError(error_line(error))
        Gui.getMainWindow().statusBar().showMessage(translated_error(error), 8000)
        return
    except Cancelled:
        return
    # events were handled meanwhile
    if name in App.listDocuments() and all(map(App.getDocument(name).getObject, run.objects)):
        dock.show(run, view)


def _kind(obj: Any) -> str:
    stage = stage_of(obj)
    return "" if stage is None else stage.kind


def _say(text: str) -> None:
    App.Console.PrintWarning(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
