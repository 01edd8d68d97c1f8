# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in the 3D view, as the part sees it: platform under it, nozzle where the deposit ends, on demand the machine."""

from __future__ import annotations

import contextlib
from typing import Any, ClassVar

import numpy as np
from pivy import coin

from ..core.geometry import frames
from ..core.issues import InputError
from ..core.kinematics import cell as cells
from ..core.kinematics.cell import ROTARY_TABLE, TOOL_ON_ROBOT
from ..core.parameters.cell import CellParameters
from ..core.simulation.placing import at_rest, placing
from ..core.simulation.solids import capsule
from ..objects import user_machines
from ..objects.stage import stage_of
from ..objects.store import Place
from .lines import Array, placed, turned
from .machine_links import MachineNodes, of_solid
from .path import path_view
from .texts import tr
from .view_base import StageView

_LEAST_THICKNESS = 1.0
_BODY = 2.5  # where the body of a nozzle that stands still ends, in lengths of the nozzle
PLATFORM, NOZZLE = ((0.55, 0.58, 0.62), 0.2), ((0.8, 0.82, 0.85), 0.0)


class CellView(StageView):
    """Draws platform and nozzle in part coordinates; without a toolpath the platform lies at the origin.

    The machine is drawn at rest: the part upright, its highest point under the nozzle.
    """

    icon = "cell"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "ShowMachine": ("App::PropertyBool", False, "Show the machine at rest, the nozzle upright on the highest point."),
    }
    machine: MachineNodes | None = None
    stands_on = ""  # the key of the toolpath that platform and nozzle were placed by, "" for none

    def scene(self, root: Any) -> None:
        self.platform, self.nozzle, self.links = coin.SoSeparator(), coin.SoSeparator(), coin.SoSeparator()
        for look, node in ((PLATFORM, self.platform), (NOZZLE, self.nozzle)):
            root.addChild(coloured(look, node))
        root.addChild(self.links)

    def draw(self, obj: Any, value: Any) -> None:
        standing = _standing(obj)
        self.stands_on = "" if standing is None else _key_of_toolpath(obj)
        mount, tip, axis = np.eye(4), np.zeros(3), np.array([0.0, 0.0, 1.0])
        if standing is not None:
            points, tools, frame, family = standing
            tip, axis = points[-1], tools[-1]
            by_part = value.mount == "part" or (value.mount == "auto" and family != "revolution")
            mount = np.eye(4) if by_part else frame
        self.links.removeAllChildren()
        self.machine = None
        if getattr(obj.ViewObject, "ShowMachine", False):
            tip, axis = self._draw_machine(value, _toolpath_of(obj), mount)
        self.platform.removeAllChildren()
        for child in platform_nodes(value, mount):
            self.platform.addChild(child)
        self.nozzle.removeAllChildren()
        self.nozzle.addChild(placed(frames.pose(frames.smallest_rotation([0.0, 0.0, 1.0], axis), tip)))
        self.nozzle.addChild(nozzle_node(value))
        if self.machine is not None:
            self.nozzle.addChild(holder_node(value))

    def follow(self) -> None:
        """Draw anew where the toolpath is another than it was."""
        if self.drawn and self.stands_on != _key_of_toolpath(self.obj):
            self.refresh()

    def _draw_machine(self, value: CellParameters, toolpath: Any, mount: Array) -> tuple[Array, Array]:
        """Draw the machine at rest; where the nozzle's tip is then, and its axis."""
        frame, family = (np.eye(4), "revolution") if toolpath is None else (toolpath.frame, toolpath.family)
        cell = cells.resolve(value, frame, family, user_machines.folders())
        place = placing(cell, at_rest(cell, resting_point(toolpath, mount)))
        self.machine = MachineNodes(cell.machine, value.platform_diameter, value.nozzle.length)
        to_part = frames.inverse(place.part)
        self.machine.pose(to_part @ place.links)
        self.links.addChild(self.machine.node)
        nozzle = to_part @ place.nozzle
        return nozzle[:3, 3], nozzle[:3, 2]

    def onChanged(self, vobj: Any, name: str) -> None:
        """A view property has changed."""
        if name == "ShowMachine" and self.root is not None and not vobj.Object.Document.Restoring:
            self.refresh()

    def preferences_changed(self) -> None:
        if self.machine is not None:
            self.machine.renew_colours()

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Entries of the context menu in the tree."""
        super().setupContextMenu(vobj, menu)
        action = menu.addAction(tr("Hide machine") if vobj.ShowMachine else tr("Show machine"))
        action.setObjectName("RoboticAM_ShowMachine")
        action.triggered.connect(lambda *_: setattr(vobj, "ShowMachine", not vobj.ShowMachine))


def coloured(look: tuple[tuple[float, float, float], float], node: Any) -> Any:
    """A node in a look: its colour and how transparent it is."""
    material, group = coin.SoMaterial(), coin.SoSeparator()
    material.diffuseColor.setValue(*look[0])
    material.transparency = look[1]
    group.addChild(material)
    group.addChild(node)
    return group


def platform_nodes(value: CellParameters, mount: Array) -> list[Any]:
    """The platform of a cell on the frame that sits on it (4, 4), none without a diameter."""
    if value.platform_diameter <= 0.0:
        return []
    radius = 0.5 * value.platform_diameter
    thick = value.platform if isinstance(value.platform, float) else _LEAST_THICKNESS
    low = -max(_LEAST_THICKNESS, thick)
    return [placed(mount), turned([(0.0, low), (radius, low), (radius, 0.0), (0.0, 0.0)])]


def nozzle_node(value: CellParameters) -> Any:
    """The nozzle of a cell: its tip at the origin, Z into it."""
    nozzle = value.nozzle
    tip_radius = 0.5 * nozzle.diameter
    top_radius = tip_radius + nozzle.length * np.tan(nozzle.half_angle)
    return turned([(0.0, 0.0), (tip_radius, 0.0), (top_radius, nozzle.length), (0.0, nozzle.length)])


def holder_node(value: CellParameters) -> Any:
    """What holds the nozzle, seen from its tip: from its end to the flange of a robot that carries it, else a short body."""
    length = value.nozzle.length
    end, flange = np.array([0.0, 0.0, length]), np.array([0.0, 0.0, _BODY * length])
    if value.setup == TOOL_ON_ROBOT:
        tip = frames.bryant(value.nozzle.tool) @ frames.pose(frames.about_x(np.pi), np.zeros(3))
        flange = frames.inverse(tip)[:3, 3]
    radius = 0.5 * value.nozzle.diameter + length * np.tan(value.nozzle.half_angle)
    if value.setup == ROTARY_TABLE or np.linalg.norm(flange - end) < 1.0:  # tables have their head
        return coin.SoSeparator()
    return of_solid(capsule(end, flange, radius, radius))


def resting_point(toolpath: Any, mount: Array) -> Array:
    """(3,) where the nozzle stands at rest: on the highest point of the toolpath, or on the platform without one."""
    if toolpath is None:
        return np.asarray(mount[:3, 3])
    points = np.concatenate([bead.points for _, _, bead in toolpath])
    return np.asarray(points[int(np.argmax(points @ mount[:3, 2]))])


def _toolpath_of(obj: Any) -> Any:
    found = _of_toolpath(obj, ())
    return None if found is None else found[0]


def _standing(obj: Any) -> Any:
    """Points and tool axes of the last bead, frame and family of the toolpath; what else it has is not read."""
    last = ("layers", -1, "beads", -1)
    return _of_toolpath(obj, (*last, "points"), (*last, "tool"), ("frame",), ("family",))


def _of_toolpath(obj: Any, *places: Place) -> Any:
    toolpath = _toolpath_in(obj)
    if toolpath is not None:
        with contextlib.suppress(InputError):  # within undo
            return stage_of(toolpath).picked(toolpath, *places)
    return None


def _key_of_toolpath(obj: Any) -> str:
    toolpath = _toolpath_in(obj)
    return "" if toolpath is None else str(toolpath.Key)


def _toolpath_in(obj: Any) -> Any:
    """The toolpath object that is for a cell, or that a joint path is planned of in it; None without one."""
    for follower in obj.InList:
        kind = getattr(stage_of(follower), "kind", "")
        toolpath = follower if kind == "toolpath" else follower.Toolpath if kind == "joint path" else None
        if toolpath is not None and toolpath.Key:
            return toolpath
    return None


def _path_changed(view: path_view.PathView) -> None:
    """A toolpath or joint path was drawn: the cell it is for goes with it."""
    cell = view.obj.Cell
    if cell is not None and isinstance(cell.ViewObject.Proxy, CellView):
        cell.ViewObject.Proxy.follow()


path_view.listen(_path_changed)
