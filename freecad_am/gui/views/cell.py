# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in the 3D view, in part coordinates: platform, nozzle at the end of the deposit, and
optionally the machine.
"""

from __future__ import annotations

import contextlib
from typing import Any, ClassVar

import numpy as np

from ...core.issues import InputError
from ...core.kinematics.cell import mounted
from ...objects import user_machines
from ...objects.results.store import Place
from ...objects.stage import stage_of
from ..in_language import tr
from ..nodes.cell import CellNodes, at_end, machine_scenery, nozzle_scenery
from ..path import path_view
from .base import StageView


class CellView(StageView):
    """Draws platform and nozzle in part coordinates; without a toolpath the platform is at the
    origin.

    The machine is drawn at rest: the part upright, its highest point under the nozzle.
    """

    icon = "cell"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "ShowMachine": (
            "App::PropertyBool",
            False,
            "Show the machine at rest, the nozzle upright on the highest point.",
        ),
    }
    end = (
        np.zeros(3),
        np.array([0.0, 0.0, 1.0]),
    )  # the last point of the deposit and its tool axis
    # key of the toolpath that determines the poses of platform and nozzle, "" for none
    stands_on = ""

    def scene(self, root: Any) -> None:
        self.nodes = CellNodes()
        root.addChild(self.nodes.switch)

    def draw(self, obj: Any, value: Any) -> None:
        standing = _standing(obj)
        self.stands_on = "" if standing is None else _key_of(toolpath_of(obj))
        if getattr(obj.ViewObject, "ShowMachine", False):
            contents = _toolpath_contents(obj, ())
            self.nodes.set(
                machine_scenery(
                    value, None if contents is None else contents[0], user_machines.folders()
                )
            )
            return
        tip, axis, mount = np.zeros(3), np.array([0.0, 0.0, 1.0]), np.eye(4)
        if standing is not None:
            points, tools, frame, family = standing
            tip, axis = points[-1], tools[-1]
            mount = mounted(value, frame, family)
        self.end = tip, axis
        self.nodes.set(nozzle_scenery(value, *(_end_of_shown_path(obj) or self.end), mount))

    def follow_stretch(self, view: path_view.PathView) -> None:
        """Move the nozzle to the end of the visible path stretch; the machine at rest stays."""
        if self.drawn and self.nodes.machine is None and view.obj.ViewObject.Visibility:
            self.nodes.move_nozzle(at_end(*(view.last_point() or self.end)))

    def follow(self) -> None:
        """Redraw if the toolpath changed."""
        if self.drawn and self.stands_on != _key_of(toolpath_of(self.obj)):
            self.refresh()

    def onChanged(self, vobj: Any, name: str) -> None:
        """Handle a changed view property."""
        if name == "ShowMachine" and self.root is not None and not vobj.Object.Document.Restoring:
            self.refresh()

    def preferences_changed(self) -> None:
        if self.nodes.machine is not None:
            self.nodes.machine.renew_colours()

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add entries to the context menu in the tree."""
        super().setupContextMenu(vobj, menu)
        action = menu.addAction(tr("Hide machine") if vobj.ShowMachine else tr("Show machine"))
        action.setObjectName("RoboticAM_ShowMachine")
        action.triggered.connect(lambda *_: setattr(vobj, "ShowMachine", not vobj.ShowMachine))


def toolpath_of(obj: Any) -> Any:
    """Return the toolpath of a cell, or of a joint path planned in the cell; None without one."""
    for follower in obj.InList:
        kind = getattr(stage_of(follower), "kind", "")
        toolpath = (
            follower if kind == "toolpath" else follower.Toolpath if kind == "joint path" else None
        )
        if toolpath is not None and toolpath.Key:
            return toolpath
    return None


def _standing(obj: Any) -> Any:
    """Return points and tool axes of the last bead, frame and family of the toolpath; read nothing
    else.
    """
    last_bead = ("layers", -1, "beads", -1)
    return _toolpath_contents(
        obj, (*last_bead, "points"), (*last_bead, "tool"), ("frame",), ("family",)
    )


def _end_of_shown_path(obj: Any) -> Any:
    """Return the end of the visible stretch of the cell's path, None without one."""
    for follower in obj.InList:
        view = getattr(follower.ViewObject, "Proxy", None)
        if (
            isinstance(view, path_view.PathView)
            and follower.ViewObject.Visibility
            and view.shown is not None
        ):
            return view.last_point()
    return None


def _toolpath_contents(obj: Any, *locations: Place) -> Any:
    toolpath = toolpath_of(obj)
    if toolpath is not None:
        with contextlib.suppress(InputError):  # during undo
            return stage_of(toolpath).parts(toolpath, *locations)
    return None


def _key_of(toolpath: Any) -> str:
    return "" if toolpath is None else str(toolpath.Key)


def _path_changed(view: path_view.PathView) -> None:
    """Redraw the cell of a toolpath or joint path that was drawn."""
    cell = view.obj.Cell
    if cell is not None and isinstance(cell.ViewObject.Proxy, CellView):
        cell.ViewObject.Proxy.follow()


def _stretch_changed(view: path_view.PathView) -> None:
    cell = view.obj.Cell
    if cell is not None and isinstance(cell.ViewObject.Proxy, CellView):
        cell.ViewObject.Proxy.follow_stretch(view)


path_view.listen(_path_changed)
path_view.listen_to_stretches(_stretch_changed)
