# SPDX-License-Identifier: LGPL-2.1-or-later
"""The group of a job in the tree. Its class path is part of the file format."""

from __future__ import annotations

import contextlib
from typing import Any

from PySide import QtCore

from ...objects.job_group import stages_in
from ...objects.stage import stage_of
from ...objects.staleness import FAILED, INFEASIBLE, STALE
from .. import icons, registry


class JobView:
    """Shows the worst status of its stages. Deleting the group deletes its stages; other members
    stay.
    """

    obj: Any = None

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Called when the view provider is set, and when a document opens."""
        self.obj = vobj.Object
        # FreeCAD 1.1 asks for the icon before the proxy exists
        QtCore.QTimer.singleShot(0, self._renew_icon)

    def _renew_icon(self) -> None:
        with contextlib.suppress(ReferenceError, RuntimeError, AttributeError):  # deleted
            self.obj.ViewObject.signalChangeIcon()

    def getIcon(self) -> str:
        """Return the job icon, with a badge for problems."""
        statuses = set() if self.obj is None else {stage.Status for stage in stages_in(self.obj)}
        worst = next((status for status in (FAILED, INFEASIBLE, STALE) if status in statuses), "")
        return icons.badge_path("job", worst)

    def canDropObject(self, obj: Any) -> bool:
        """Accept only stages."""
        return stage_of(obj) is not None

    def replaceObject(self, old: Any, new: Any) -> bool:
        """Keep a stage that another stage is dropped onto.

        FreeCAD would replace it in the job, although later stages still need it.
        """
        return False

    def onDelete(self, vobj: Any, names: Any) -> bool:
        """Delete the stages too, last stages first, within the undo step that deletes the group."""
        document = vobj.Object.Document
        stages = sorted(stages_in(vobj.Object), key=lambda obj: -len(obj.OutListRecursive))
        for name in [stage.Name for stage in stages]:
            document.removeObject(name)
        return True

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add entries to the context menu in the tree."""
        registry.fill_menu_of_job(menu, vobj.Object)

    def dumps(self) -> None:
        """Store nothing."""

    def loads(self, state: Any) -> None:
        """Restore nothing."""

    __getstate__ = dumps
    __setstate__ = loads


def attach(obj: Any) -> None:
    """Give a group a view provider if it has none."""
    if not getattr(obj.ViewObject, "Proxy", None):
        JobView(obj.ViewObject)
