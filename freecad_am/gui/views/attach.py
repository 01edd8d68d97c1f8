# SPDX-License-Identifier: LGPL-2.1-or-later
"""Attach view providers to our objects and open their panels.

InitGui registers this module with `objects.hooks`.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore

from ...objects.families.registry import stage_family
from ...objects.job_group import is_group
from ...objects.stage import Stage
from .. import preferences_watch, registry
from ..busy import carry_out
from ..families.registry import window_of
from ..inspection.panel import InspectionPanel
from ..inspection.view import InspectionView
from ..panels.cell import CellPanel
from ..panels.joint_path import JointPathPanel
from ..panels.program import ProgramPanel
from ..panels.stage import show
from ..panels.toolpath import ToolpathPanel
from . import job
from .base import MODE, StageView
from .cell import CellView
from .joint_path import JointPathView
from .program import ProgramView
from .toolpath import ToolpathView

__all__ = ("attach", "carry_out", "view_of")  # called by `objects.hooks` and by tests

VIEWS: dict[str, type[StageView]] = {
    "cell": CellView,
    "toolpath": ToolpathView,
    "joint path": JointPathView,
    "program": ProgramView,
    "inspection": InspectionView,
}

_to_be_seen: set[str] = set()


# ---- functions that views call, imported at first use: panels and menus import more slowly than a
# document opens


def _edit(obj: Any) -> None:

    edit(obj)


def _fill_menu_of_stage(menu: Any, obj: Any) -> None:
    from ..tools import context_menu

    context_menu.add_stage_entries(menu, obj)


def _fill_menu_of_job(menu: Any, group: Any) -> None:
    from ..tools import context_menu

    context_menu.add_job_entries(menu, group)


registry.register(
    edit=_edit, fill_menu_of_stage=_fill_menu_of_stage, fill_menu_of_job=_fill_menu_of_job
)


# ---- display


def _preferences_changed() -> None:
    """Redraw everything with the current preferences."""
    for document in App.listDocuments().values():
        for obj in document.Objects:
            view = getattr(obj.ViewObject, "Proxy", None)
            if isinstance(view, StageView) and view.obj is not None:
                view.preferences_changed()


preferences_watch.listen(_preferences_changed)


def view_of(stage: Stage) -> type[StageView]:
    """Return the view provider of a stage."""
    family = stage_family(stage)
    return VIEWS[stage.kind] if family is None else window_of(family).view()


def attach(obj: Any) -> None:
    """Show an object: redraw it, or give it a view provider if it has none (new, or created without
    a window).
    """
    vobj = obj.ViewObject
    if is_group(obj):
        job.attach(obj)
        return
    if not getattr(vobj, "Proxy", None):
        if obj.Document.Restoring and obj.Document.Name not in _to_be_seen:
            _to_be_seen.add(obj.Document.Name)
            QtCore.QTimer.singleShot(0, lambda name=obj.Document.Name: _show_all(name))
        view_of(obj.Proxy)(vobj)
        vobj.DisplayMode = MODE
        vobj.Visibility = True
    else:
        vobj.Proxy.complete(vobj)
    vobj.Proxy.refresh()


def _show_all(name: str) -> None:
    """Fit the camera to a document that was created without a window, and therefore has no camera."""
    document = Gui.getDocument(name) if name in App.listDocuments() else None
    if document is not None and document.Document.Restoring:
        QtCore.QTimer.singleShot(100, lambda: _show_all(name))
        return
    _to_be_seen.discard(name)
    for view in [] if document is None else document.mdiViewsOfType("Gui::View3DInventor"):
        view.viewIsometric()
        view.fitAll()


# ---- The panel of every kind of stage; families define the panels of their features

PANELS: dict[type, Any] = {
    panel.stage: panel
    for panel in (
        CellPanel,
        ToolpathPanel,
        JointPathPanel,
        ProgramPanel,
        InspectionPanel,
    )
}


def edit(obj: Any) -> None:
    """Open the panel of an existing stage."""
    family = stage_family(obj.Proxy)
    panel = PANELS[type(obj.Proxy)] if family is None else window_of(family).panel()
    show(panel(obj))
