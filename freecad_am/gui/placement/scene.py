# SPDX-License-Identifier: LGPL-2.1-or-later
"""A placement in the 3D view: the machine at rest about the part, as it is drawn in the document, and places about it."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from pivy import coin

from freecad_am.core.types import Array

from ...core.geometry import frames
from ...core.kinematics import cell as cells
from ...core.kinematics.arrangement import arrangement_of
from ...core.parameters.cell import CellParameters
from ...core.parameters.place import PLATFORM, POSITIONER
from ...core.placement.moved import pose_of
from ...core.placement.place import Placed
from ...core.placement.reach import Reach
from ...core.simulation.placing import at_rest, placing
from ...core.toolpath import Toolpath
from ...objects import user_machines
from ..colours import ramp
from ..nodes.cell import CellNodes, resting_point, with_machine
from .figures import Coloured
from .marks import Cloud, Cubes

_LARGEST, _SHARE = 120.0, 0.35  # of a cube: mm, and share of the step between places


class Scene:
    """Nodes in a 3D view from when it is made until `remove`."""

    def __init__(self, view: Any) -> None:
        self.view, self.machine, self.cubes, self.cloud = (
            view,
            CellNodes(ghost=True),
            Cubes(),
            Cloud(),
        )
        self.places, self.size = np.zeros((0, 3)), 1.0
        self.root = coin.SoSeparator()
        for node in (self.machine.switch, self.cubes.node, self.cloud.node):
            self.root.addChild(node)
        self.camera, self.camera_text = view.getCameraNode().copy(), view.getCamera()
        self.graph = view.getSceneGraph()
        self.graph.addChild(self.root)

    def stand(self, settings: CellParameters, toolpath: Toolpath) -> None:
        """Draw the machine of a cell about the part; places are seen from it."""
        folders = user_machines.folders()
        cell = cells.resolve(settings, toolpath.frame, toolpath.family, folders)
        joints = at_rest(cell, resting_point(toolpath, cell.mount))
        self.settings, self.cell, self.joints = settings, cell, joints
        self.rest = placing(cell, joints)
        self.to_view = frames.inverse(self.rest.part)
        self.machine.set(with_machine(settings, toolpath, folders))

    def seen(self, moves: str, poses: Array) -> Array:
        """(n, 3) where poses (n, 6) of what is moved are in the view."""
        if moves == POSITIONER:
            links = self.cell.links(self.joints)
            base = frames.inverse(links[0]) @ self.cell.world(self.joints[None])[0]
        else:
            nozzle = arrangement_of(self.cell.setup).holds_part and moves != PLATFORM
            stands = self.rest.nozzle if nozzle else self.rest.platform
            base = stands @ frames.inverse(frames.bryant(pose_of(self.settings, moves)))
        places: Array = (self.to_view @ base @ frames.bryant(poses))[:, :3, 3]
        return places

    def show(self, found: Placed | None, coloured: Coloured | None, chosen: int | None) -> None:
        """Draw a cube at each place, the best pose of those there, in its colour."""
        if found is None or coloured is None:
            self.places = np.zeros((0, 3))
            self.cubes.set(self.places, self.places, 1.0)
            return
        self.places = self.seen(found.moves, found.poses)
        self.size = _size(found.poses[:, :3])
        self.cubes.set(self.places[coloured.shown], coloured.colours, self.size)
        self.cubes.choose(None if chosen is None else self.places[chosen], self.size)

    def show_reach(self, found: Reach | None) -> None:
        """Draw the reach of the robot, or none."""
        if found is None:
            self.cloud.set(np.zeros((0, 3)), np.zeros((0, 3)))
            return
        places = found.places @ self.to_view[:3, :3].T + self.to_view[:3, 3]
        self.cloud.set(places, ramp(found.share))

    def fit(self) -> None:
        """Bring all of it into sight."""
        self.view.fitAll()

    def remove(self, document_goes: bool = False) -> None:
        """Leave the view as it was, camera included; it may be gone, as in a document that goes."""
        with contextlib.suppress(RuntimeError, ReferenceError):
            if self.graph.findChild(self.root) >= 0:
                self.graph.removeChild(self.root)
        if document_goes:
            return
        with contextlib.suppress(RuntimeError, ReferenceError):
            camera = self.view.getCameraNode()
            if camera.getTypeId() == self.camera.getTypeId():
                camera.copyFieldValues(self.camera)
            else:  # from perspective to orthographic meanwhile, or the other way
                self.view.setCamera(self.camera_text)


def _size(places: Array) -> float:
    """mm, of cubes that leave room between places."""
    steps = [np.diff(np.unique(np.round(column, 6))) for column in places.T]
    least = min((float(step.min()) for step in steps if len(step)), default=_LARGEST)
    return min(_LARGEST, _SHARE * least)
