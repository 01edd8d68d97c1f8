# SPDX-License-Identifier: LGPL-2.1-or-later
"""A machine in the 3D view: one node per link, moved by its joints, red where something is wrong with one."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest
from typing import Any

import FreeCAD as App
import numpy as np
from pivy import coin

from freecad_am.core.types import Array, Integers, Mask, NDArray

from ...core.issues import InputError
from ...core.kinematics.links import robot as robot_links
from ...core.kinematics.links.cylinders import Mesh
from ...core.kinematics.links.shape import LinkShape
from ...core.kinematics.links.solids import BRIGHT, DARK, Solid
from ...core.kinematics.machines.machine import Machine
from ...core.simulation import table_links
from ...objects.fields import preferences
from ...objects.shapes.link_meshes import mesh_of
from ..texts.translation import error_line
from .lines import fill

TONES = {DARK: (0.24, 0.27, 0.31), BRIGHT: (0.66, 0.68, 0.71)}
BAD = (0.86, 0.1, 0.12)
_SHAPE = (0.8, 0.81, 0.83)  # of a user's file without a colour
_CREASE = 0.6  # rad; flatter edges of a user's mesh look round
_SMALLEST = 1.05  # a table is a little wider than the platform on it


Look = Sequence[float] | None  # a colour, None for the one that is preferred
Links = Sequence[Sequence[Solid]]  # solids of each link


def _rgb(colour: Look) -> Sequence[float]:
    return preferences.machine_colour() if colour is None else colour


def plain_links(machine: Machine, platform: float, torch: float) -> Links:
    """The solids of each link (axes + 1), base first. platform: diameter of the platform on a table, torch: length of the
    nozzle, mm; machines with rotary axes are drawn to fit them."""
    if not machine.arrangements[0].links_known:
        return table_links.solids(
            machine.chain, max(table_links.RADIUS, 0.5 * _SMALLEST * platform), torch
        )
    return robot_links.solids(machine.chain)


class MachineNodes:
    """The links of a machine, in the frame of what they are posed in.

    solids: as of `plain_links`. meshes: of the files a user gave the links, where they are read already. One that cannot be
    read is told on the report view, once.
    """

    def __init__(self, machine: Machine, solids: Links, meshes: Sequence[Mesh | None] = ()) -> None:
        self.node = coin.SoSeparator()
        self.transforms: list[Any] = []
        self.matrices: list[
            Any
        ] = []  # of the transforms; to ask a node for its field takes longer than to set it
        self.materials: list[list[tuple[Any, Look]]] = []
        self.bad = np.zeros(machine.chain.axes + 1, dtype=bool)
        for shape, mesh, plain in zip_longest(machine.shapes, meshes, solids):
            self._add(shape, mesh, plain)

    def _add(self, shape: LinkShape | None, mesh: Mesh | None, plain: Sequence[Solid]) -> None:
        link, transform, materials = coin.SoSeparator(), coin.SoMatrixTransform(), []
        link.addChild(transform)
        mesh = mesh if mesh is not None or shape is None else _drawn_mesh(shape)
        own = None if mesh is None else of_mesh(mesh)
        parts = (
            [(own, _SHAPE if shape is None or shape.colour is None else shape.colour)]
            if own is not None
            else [(of_solid(solid), TONES.get(solid.tone)) for solid in plain]
        )
        for node, colour in parts:
            material, part = coin.SoMaterial(), coin.SoSeparator()
            material.diffuseColor.setValue(*_rgb(colour))
            material.specularColor.setValue(0.25, 0.25, 0.25)
            material.shininess = 0.4
            part.addChild(material)
            part.addChild(node)
            link.addChild(part)
            materials.append((material, colour))
        self.node.addChild(link)
        self.transforms.append(transform)
        self.matrices.append(transform.matrix)
        self.materials.append(materials)

    def pose(self, links: Array) -> None:
        """Move the links to their poses (axes + 1, 4, 4); NaN leaves them where they are."""
        if np.isfinite(links).all():
            for matrix, pose in zip(self.matrices, links):
                move(matrix, pose)

    def paint(self, bad: Mask) -> None:
        """Links (axes + 1,) to be red; the others get their own colours back."""
        for index in np.flatnonzero(bad != self.bad):
            for material, colour in self.materials[index]:
                material.diffuseColor.setValue(*(BAD if bad[index] else _rgb(colour)))
        self.bad = bad.copy()

    def renew_colours(self) -> None:
        """Plain links get the colour that is preferred now."""
        for bad, materials in zip(self.bad, self.materials):
            for material, colour in materials:
                material.diffuseColor.setValue(*(BAD if bad else _rgb(colour)))


def move(matrix: Any, pose: Array) -> None:
    """Give the matrix field of a SoMatrixTransform a pose (4, 4)."""
    matrix.setValue(coin.SbMatrix(*pose.T.ravel().tolist()))


def of_solid(solid: Solid) -> Any:
    """The node of a solid, without a colour."""
    values, shape = coin.SoVertexProperty(), coin.SoIndexedFaceSet()
    fill(values.vertex, solid.points.astype(np.float32))
    fill(values.normal, solid.normals.astype(np.float32))
    values.normalBinding = coin.SoVertexProperty.PER_VERTEX_INDEXED
    fill(shape.coordIndex, _corners(solid.triangles))
    shape.vertexProperty = values
    return shape


def _drawn_mesh(shape: LinkShape) -> Mesh | None:
    """The mesh of a user's file that is to be drawn; None when it cannot be read, which is told on the report view."""
    try:
        return mesh_of(shape)
    except InputError as error:
        reported = InputError(
            error.code, shape.where, "{}; the link is shown as a plain solid for now", error.message
        )
        App.Console.PrintError(error_line(reported))
        return None


def of_mesh(mesh: Mesh) -> Any:
    """The node of a user's file."""
    group, hints = coin.SoGroup(), coin.SoShapeHints()
    hints.vertexOrdering, hints.shapeType = (
        coin.SoShapeHints.COUNTERCLOCKWISE,
        coin.SoShapeHints.UNKNOWN_SHAPE_TYPE,
    )
    hints.creaseAngle = _CREASE
    coordinates, faces = coin.SoCoordinate3(), coin.SoIndexedFaceSet()
    fill(coordinates.point, mesh[0].astype(np.float32))
    fill(faces.coordIndex, _corners(mesh[1]))
    for child in (hints, coordinates, faces):
        group.addChild(child)
    return group


def _corners(triangles: Integers) -> NDArray[np.int32]:
    """Corners as Coin wants them, each triangle with its end."""
    corners = np.full((len(triangles), 4), -1, dtype=np.int32)
    corners[:, :3] = triangles
    return corners.ravel()
