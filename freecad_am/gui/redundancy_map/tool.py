# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool that opens the map of the free rotation."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from ...core.issues import AmError
from ...objects.stage import stage_of
from ..in_language import error_line, tr, translated_error
from ..widgets.shape_inputs import job_named, job_selection
from .dock import RedundancyMapDock
from .draft import source_of

_open: list[RedundancyMapDock] = []  # Python must keep it as long as it is open; there is one


def show(obj: Any) -> RedundancyMapDock:
    """Open the map of a joint path and close the open one. Raises InputError if the path has no
    map."""
    source_of(obj)
    while _open:
        _open[0].close()
    _open.append(RedundancyMapDock(obj, _open.remove))
    return _open[0]


def redundancy_map() -> None:
    """Open the map of the selected joint path, program or job; without such a selection, of the
    last joint path with a result."""
    selected = [path for path in map(_joint_path, job_selection()) if path is not None]
    if not selected and job_named():
        _say(
            tr("{} has no joint path to map; make one first, or select another job.").format(
                job_named()
            )
        )
        return
    candidates = [obj for obj in App.ActiveDocument.Objects if _joint_path(obj) is obj and obj.Key]
    if not selected and not candidates:
        _say(tr("There is no joint path to map; make one first."))
        return
    try:
        show(selected[0] if selected else candidates[-1])
    except AmError as error:
        App.Console.PrintWarning(error_line(error))
        Gui.getMainWindow().statusBar().showMessage(translated_error(error), 8000)


def _joint_path(obj: Any) -> Any:
    stage = stage_of(obj)
    if stage is not None and stage.kind == "program":
        return obj.JointPath
    return obj if stage is not None and stage.kind == "joint path" else None


def _say(text: str) -> None:
    App.Console.PrintWarning(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
