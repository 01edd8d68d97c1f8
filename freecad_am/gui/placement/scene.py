# SPDX-License-Identifier: LGPL-2.1-or-later
"""A placement in the 3D view: the machine at rest about the part, as it is drawn in the document, and places about it."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from pivy import coin

from ...core.geometry import frames
from ...core.kinematics import cell as cells
from ...core.kinematics.arrangement import arrangement_of
from ...core.parameters.cell import CellParameters
from ...core.parameters.place import PLATFORM, POSITIONER
from ...core.placement.place import Placed, pose_of
from ...core.placement.reach import Reach
from ...core.simulation.table_links import at_rest, placing
from ...core.toolpath import Toolpath
from ...core.types import Array
from ...objects import user_machines
from ..colours import ramp
from ..nodes.cell import CellNodes, machine_scenery, resting_point
from ..nodes.lines import Lines, fill, unshaded
from ..nodes.wall import unpickable
from .figures import Coloured

_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
_SIDES = np.array(
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
)
_EDGES = np.array(
    [(0, 1), (1, 3), (3, 2), (2, 0), (4, 5), (5, 7), (7, 6), (6, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
)
CHOSEN = (0.86, 0.1, 0.12)
DOT = 7.0  # pixels


class Cubes:
    """Cubes of one size, each in its colour; clicks go through them. One may be framed."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        self.colour, binding, hints = (
            coin.SoMaterial(),
            coin.SoMaterialBinding(),
            coin.SoShapeHints(),
        )
        binding.value = coin.SoMaterialBinding.PER_FACE
        hints.vertexOrdering = coin.SoShapeHints.UNKNOWN_ORDERING
        self.coordinates, self.faces = coin.SoCoordinate3(), coin.SoIndexedFaceSet()
        self.frame = Lines(3.0, CHOSEN)
        cubes = coin.SoSeparator()
        for child in (self.colour, binding, hints, self.coordinates, self.faces):
            cubes.addChild(child)
        for child in (unpickable(), cubes, self.frame.node):
            self.node.addChild(child)
        self.set(np.zeros((0, 3)), np.zeros((0, 3)), 1.0)

    def set(self, centres: Array, colours: Array, size: float) -> None:
        """places (n, 3) mm, colours (n, 3) 0..1; size: mm, of an edge."""
        corners = centres[:, None] + 0.5 * size * _CORNERS
        offsets = 8 * np.arange(len(centres))[:, None, None]
        sides = np.concatenate([offsets + _SIDES, np.full((len(centres), 6, 1), -1)], axis=2)
        fill(self.coordinates.point, corners.reshape(-1, 3))
        fill(self.colour.diffuseColor, np.repeat(colours, 6, axis=0))
        fill(self.faces.coordIndex, sides.ravel())
        self.choose(None, size)

    def choose(self, centre: Array | None, size: float) -> None:
        """Frame the cube at a place (3,), or none."""
        if centre is None:
            self.frame.set([], [])
            return
        ends = (np.asarray(centre) + 0.6 * size * _CORNERS)[_EDGES]
        self.frame.set(ends.reshape(-1, 3), [2] * len(_EDGES))


class Cloud:
    """Points, each in its colour; clicks go through them."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        style, binding = coin.SoDrawStyle(), coin.SoMaterialBinding()
        style.pointSize = DOT
        binding.value = coin.SoMaterialBinding.PER_VERTEX
        self.colour, self.coordinates, self.points = (
            coin.SoMaterial(),
            coin.SoCoordinate3(),
            coin.SoPointSet(),
        )
        for child in (
            unpickable(),
            unshaded(),
            style,
            self.colour,
            binding,
            self.coordinates,
            self.points,
        ):
            self.node.addChild(child)
        self.set(np.zeros((0, 3)), np.zeros((0, 3)))

    def set(self, points: Array, colours: Any) -> None:
        """places (n, 3) mm, colours (n, 3) 0..1."""
        fill(self.coordinates.point, points)
        fill(self.colour.diffuseColor, colours)
        self.points.numPoints = len(points)


_MAX_EDGE_MM, _SHARE = 120.0, 0.35  # of a cube: mm, and share of the step between places


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
        joints = at_rest(cell, resting_point(toolpath, cell.poses.mount))
        self.settings, self.cell, self.joints = settings, cell, joints
        self.rest = placing(cell, joints)
        self.to_view = frames.inverse(self.rest.part)
        self.machine.set(machine_scenery(settings, toolpath, folders))

    def positions_of(self, moves: str, poses: Array) -> Array:
        """Return the positions (n, 3) in the view of poses (n, 6) of the moved object."""
        if moves == POSITIONER:
            links = self.cell.links(self.joints)
            base = frames.inverse(links[0]) @ self.cell.world(self.joints[None])[0]
        else:
            nozzle = arrangement_of(self.cell.setup).holds_part and moves != PLATFORM
            stands = self.rest.nozzle if nozzle else self.rest.platform
            base = stands @ frames.inverse(frames.bryant(pose_of(self.settings, moves)))
        positions: Array = (self.to_view @ base @ frames.bryant(poses))[:, :3, 3]
        return positions

    def show(self, placed: Placed | None, coloured: Coloured | None, number: int | None) -> None:
        """Draw a cube at each position in the colour of its best pose."""
        if placed is None or coloured is None:
            self.places = np.zeros((0, 3))
            self.cubes.set(self.places, self.places, 1.0)
            return
        self.places = self.positions_of(placed.moves, placed.poses)
        self.size = _size(placed.poses[:, :3])
        self.cubes.set(self.places[coloured.numbers], coloured.colours, self.size)
        self.cubes.choose(None if number is None else self.places[number], self.size)

    def show_reach(self, reach: Reach | None) -> None:
        """Draw the reach of the robot, or none."""
        if reach is None:
            self.cloud.set(np.zeros((0, 3)), np.zeros((0, 3)))
            return
        points = reach.places @ self.to_view[:3, :3].T + self.to_view[:3, 3]
        self.cloud.set(points, ramp(reach.share))

    def fit(self) -> None:
        """Fit the view to the whole scene."""
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


def _size(positions: Array) -> float:
    """mm, of cubes that leave room between places."""
    steps = [np.diff(np.unique(np.round(column, 6))) for column in positions.T]
    smallest = min((float(step.min()) for step in steps if len(step)), default=_MAX_EDGE_MM)
    return min(_MAX_EDGE_MM, _SHARE * smallest)
