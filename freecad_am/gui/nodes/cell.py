# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw a cell in part coordinates: the platform under the part, the nozzle, and optionally the
machine at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import Any

import FreeCAD as App
import numpy as np
from pivy import coin

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics import cell as cells
from ...core.kinematics.arrangement import arrangement_of
from ...core.kinematics.cell import Cell, CellShapes
from ...core.kinematics.limits import Limits
from ...core.kinematics.links import robot as robot_links
from ...core.kinematics.links.bodies import LinkShape
from ...core.kinematics.links.external_links import ExternalLink, Mesh, external_links
from ...core.kinematics.links.solids import BRIGHT, DARK, Solid, capsule
from ...core.kinematics.machines.machine import Machine
from ...core.kinematics.torch import Torch
from ...core.parameters.cell import CellParameters
from ...core.simulation import table_links
from ...core.simulation.table_links import at_rest, placing
from ...core.toolpath import Toolpath
from ...core.types import Array, Integers, Mask, NDArray
from ...objects.fields import preferences
from ...objects.shapes.cell_obstacles import mesh_of, meshes_of, readable_mesh, torch_of
from ..in_language import error_line
from .lines import fill, revolve, transform_node
from .wall import unpickable

TONES = {DARK: (0.24, 0.27, 0.31), BRIGHT: (0.66, 0.68, 0.71)}
BAD = (0.86, 0.1, 0.12)
_SHAPE = (0.8, 0.81, 0.83)  # colour of a user's file without a colour
_CREASE = 0.6  # rad; flatter edges of a user's mesh look smooth
_MIN_TABLE_RATIO = 1.05  # minimum ratio of table to platform diameter


Look = Sequence[float] | None  # a colour; None for the preferred colour
Links = Sequence[Sequence[Solid]]  # solids of each link


def _rgb(colour: Look) -> Sequence[float]:
    return preferences.machine_colour() if colour is None else colour


def plain_links(machine: Machine, platform: float, torch: float) -> Links:
    """Return the solids of each link (axes + 1), base first.

    platform: mm, platform diameter. torch: mm, nozzle length. Machines with rotary axes are sized
    to fit both.
    """
    if not machine.arrangements[0].links_known:
        return table_links.solids(
            machine.chain, max(table_links.RADIUS, 0.5 * _MIN_TABLE_RATIO * platform), torch
        )
    return robot_links.solids(machine.chain)


class MachineNodes:
    """Nodes of a machine's links, in the frame of the link poses.

    solids: as from `plain_links`. meshes: from the user's link files, if already read. Unreadable
    files are reported once in the report view.
    """

    def __init__(self, machine: Machine, solids: Links, meshes: Sequence[Mesh | None] = ()) -> None:
        self.node = coin.SoSeparator()
        self.transforms: list[Any] = []
        self.matrices: list[
            Any
        ] = []  # matrix fields of the transforms; asking a node for a field takes longer than setting it
        self.materials: list[list[tuple[Any, Look]]] = []
        self.bad = np.zeros(machine.chain.axes + 1, dtype=bool)
        for shape, mesh, plain in zip_longest(machine.shapes, meshes, solids):
            self._add(shape, mesh, plain)

    def _add(self, shape: LinkShape | None, mesh: Mesh | None, plain: Sequence[Solid]) -> None:
        link, transform, materials = coin.SoSeparator(), coin.SoMatrixTransform(), []
        link.addChild(transform)
        mesh = mesh if mesh is not None or shape is None else _drawn_mesh(shape)
        mesh_shape = None if mesh is None else mesh_node(mesh)
        shapes = (
            [(mesh_shape, _SHAPE if shape is None or shape.colour is None else shape.colour)]
            if mesh_shape is not None
            else [(solid_node(solid), TONES.get(solid.tone)) for solid in plain]
        )
        for node, colour in shapes:
            material, separator = coin.SoMaterial(), coin.SoSeparator()
            material.diffuseColor.setValue(*_rgb(colour))
            material.specularColor.setValue(0.25, 0.25, 0.25)
            material.shininess = 0.4
            separator.addChild(material)
            separator.addChild(node)
            link.addChild(separator)
            materials.append((material, colour))
        self.node.addChild(link)
        self.transforms.append(transform)
        self.matrices.append(transform.matrix)
        self.materials.append(materials)

    def pose(self, links: Array) -> None:
        """Move the links to their poses (axes + 1, 4, 4); NaN leaves the links unchanged."""
        if np.isfinite(links).all():
            for matrix, pose in zip(self.matrices, links):
                move(matrix, pose)

    def paint(self, bad: Mask) -> None:
        """Show links (axes + 1,) in red, and the other links in their own colours."""
        for index in np.flatnonzero(bad != self.bad):
            for material, colour in self.materials[index]:
                material.diffuseColor.setValue(*(BAD if bad[index] else _rgb(colour)))
        self.bad = bad.copy()

    def renew_colours(self) -> None:
        """Give plain links the preferred colour."""
        for bad, materials in zip(self.bad, self.materials):
            for material, colour in materials:
                material.diffuseColor.setValue(*(BAD if bad else _rgb(colour)))


def move(matrix: Any, pose: Array) -> None:
    """Set the matrix field of a SoMatrixTransform to a pose (4, 4)."""
    matrix.setValue(coin.SbMatrix(*pose.T.ravel().tolist()))


def solid_node(solid: Solid) -> Any:
    """Return the node of a solid, without a colour."""
    values, shape = coin.SoVertexProperty(), coin.SoIndexedFaceSet()
    fill(values.vertex, solid.points.astype(np.float32))
    fill(values.normal, solid.normals.astype(np.float32))
    values.normalBinding = coin.SoVertexProperty.PER_VERTEX_INDEXED
    fill(shape.coordIndex, _corners(solid.triangles))
    shape.vertexProperty = values
    return shape


def _drawn_mesh(shape: LinkShape) -> Mesh | None:
    """Return the mesh of a user's file; report an unreadable file in the report view and return
    None.
    """
    try:
        return mesh_of(shape)
    except InputError as error:
        reported = InputError(
            error.code, shape.where, "{}; the link is shown as a plain solid for now", error.message
        )
        App.Console.PrintError(error_line(reported))
        return None


def mesh_node(mesh: Mesh) -> Any:
    """Return the node of a user's mesh."""
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
    """Return triangle corners in Coin's form, with an end marker after each triangle."""
    corners = np.full((len(triangles), 4), -1, dtype=np.int32)
    corners[:, :3] = triangles
    return corners.ravel()


STANDING, CARRYING, MOVING = (0.36, 0.39, 0.43), (0.66, 0.68, 0.71), (0.5, 0.53, 0.57)


class ExternalLinkNodes:
    """Nodes of external links, in the frame of the link poses."""

    def __init__(self, links: Sequence[ExternalLink]) -> None:
        self.node = coin.SoSeparator()
        self.links = tuple(links)
        self.matrices: list[Any] = []
        self.materials: list[Any] = []
        self.bad = np.zeros(len(links), dtype=bool)
        for link in links:
            group, transform, material = (
                coin.SoSeparator(),
                coin.SoMatrixTransform(),
                coin.SoMaterial(),
            )
            material.diffuseColor.setValue(*_colour(link))
            for child in (
                transform,
                material,
                mesh_node((link.body.vertices, link.body.triangles)),
            ):
                group.addChild(child)
            self.node.addChild(group)
            self.matrices.append(transform.matrix)
            self.materials.append(material)

    def pose(self, frames: Array) -> None:
        """Move the links to their poses (links, 4, 4)."""
        for matrix, frame in zip(self.matrices, frames):
            move(matrix, frame)

    def paint(self, bad: Mask) -> None:
        """Show the links of bad external axes (k,) in red, and the other links in their own
        colours.
        """
        red = np.array([link.link > 0 and bool(bad[link.axis]) for link in self.links], dtype=bool)
        for index in np.flatnonzero(red != self.bad):
            self.materials[index].diffuseColor.setValue(
                *(BAD if red[index] else _colour(self.links[index]))
            )
        self.bad = red


def _colour(link: ExternalLink) -> tuple[float, float, float]:
    return STANDING if link.link == 0 else CARRYING if link.axes_after == 0 else MOVING


_LEAST_THICKNESS = 1.0
_BODY = 2.5  # end of a fixed nozzle's body, in nozzle lengths
_REACHED = 1.0  # mm; maximum position error of the nozzle; check poses of machine files may be rounded by half of it
_GHOST = 0.55  # transparency of a machine that only previews entries
PLATFORM, NOZZLE = ((0.55, 0.58, 0.62), 0.2), ((0.8, 0.82, 0.85), 0.0)


@dataclass(frozen=True, eq=False)
class Rest:
    """A machine at rest, in part coordinates.

    links: (axes + 1, 4, 4), with their solids and the meshes from the user's files. reached:
    whether the nozzle reaches its pose; otherwise all axes are at 0. joints: (axes,) current
    position. external_links: known links of positioner and track, with poses `stands` (k, 4, 4).
    """

    machine: Machine
    links: Array
    solids: Links
    meshes: tuple[Mesh | None, ...]
    reached: bool
    limits: Limits
    joints: Array
    external_links: tuple[ExternalLink, ...] = ()
    stands: Array = field(default_factory=lambda: np.zeros((0, 4, 4)))


@dataclass(frozen=True, eq=False)
class Scenery:
    """The drawing of a cell, with poses (4, 4) in part coordinates.

    mount: the part on the platform. nozzle: its tip, with Z into the nozzle. rest: the machine;
    None if hidden.
    """

    parameters: CellParameters
    mount: Array
    nozzle: Array
    rest: Rest | None = None


def nozzle_scenery(parameters: CellParameters, tip: Array, tool: Array, mount: Array) -> Scenery:
    """Return the nozzle at the end of the deposit: the last point (3,) and its tool axis (3,)."""
    return Scenery(parameters, mount, at_end(tip, tool))


def at_end(tip: Array, tool: Array) -> Array:
    """Return the pose (4, 4) of a nozzle with its tip at a point (3,) and its axis along the tool
    axis (3,).
    """
    return frames.pose(frames.smallest_rotation([0.0, 0.0, 1.0], tool), tip)


def at_the_end(
    parameters: CellParameters, toolpath: Toolpath | None, folders: Sequence[str]
) -> Scenery:
    """Return the nozzle at the end of a toolpath, or upright on the platform without a toolpath.

    Raises the errors of `cell.resolve`.
    """
    if toolpath is None:
        return nozzle_scenery(parameters, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.eye(4))
    mount, last_bead = (
        cells.resolve(parameters, toolpath.frame, toolpath.family, folders).poses.mount,
        toolpath.layers[-1].beads[-1],
    )
    return nozzle_scenery(parameters, last_bead.points[-1], last_bead.tool[-1], mount)


def machine_scenery(
    parameters: CellParameters, toolpath: Toolpath | None, folders: Sequence[str]
) -> Scenery:
    """Return the machine at rest, with the part upright and its highest point under the nozzle.

    Without a toolpath, the platform is under the nozzle. Raises the errors of `cell.resolve`.
    """
    frame, family = (
        (np.eye(4), "revolution") if toolpath is None else (toolpath.frame, toolpath.family)
    )
    cell = cells.resolve(parameters, frame, family, folders)
    cell = replace(
        cell, shapes=CellShapes(external_links=external_links(cell.external, readable_mesh))
    )
    point = resting_point(toolpath, cell.poses.mount)
    joints = at_rest(cell, point)
    solids = plain_links(cell.robot, parameters.platform_diameter, parameters.nozzle.length)
    return Scenery(parameters, cell.poses.mount, *_standing(cell, joints, point, solids))


def _standing(cell: Cell, joints: Array, point: Array, solids: Links) -> tuple[Array, Rest]:
    placement = placing(cell, joints)
    to_part = frames.inverse(placement.part)
    nozzle = to_part @ placement.nozzle
    reached = bool(np.linalg.norm(nozzle[:3, 3] - point) < _REACHED)
    machine = cell.robot
    return nozzle, Rest(
        machine,
        to_part @ placement.links,
        solids,
        meshes_of(machine),
        reached,
        cell.limits,
        joints,
        cell.shapes.external_links,
        to_part @ placement.external_links,
    )


def resting_point(toolpath: Toolpath | None, mount: Array) -> Array:
    """Return the nozzle position (3,) at rest: the highest point of the toolpath, or the platform."""
    if toolpath is None:
        return np.asarray(mount[:3, 3])
    points = np.concatenate([bead.points for _, _, bead in toolpath])
    return np.asarray(points[int(np.argmax(points @ mount[:3, 2]))])


class CellNodes:
    """Draws a cell, initially nothing. As a `ghost`, its machine is translucent and clicks pass
    through.
    """

    def __init__(self, ghost: bool = False) -> None:
        self.machine: MachineNodes | None = None
        self.external_links: ExternalLinkNodes | None = None
        self.standing: Any = None  # the transform of the nozzle
        self.looks: tuple[Any, ...] = ()  # inputs of the machine's nodes
        self.platform, self.nozzle, self.links = (
            coin.SoSeparator(),
            coin.SoSeparator(),
            coin.SoSeparator(),
        )
        self.switch, root = coin.SoSwitch(), coin.SoSeparator()
        if ghost:
            root.addChild(unpickable())
        for look, node in ((PLATFORM, self.platform), (NOZZLE, self.nozzle)):
            root.addChild(coloured(look, node))
        if ghost:
            root.addChild(_seen_through())
        root.addChild(self.links)
        self.switch.addChild(root)
        self.switch.whichChild = coin.SO_SWITCH_ALL

    def clear(self) -> None:
        """Draw nothing."""
        for node in (self.platform, self.nozzle, self.links):
            node.removeAllChildren()
        self.machine, self.looks, self.standing = None, (), None

    def set(self, scenery: Scenery) -> None:
        """Draw a cell."""
        value = scenery.parameters
        self._set_machine(value, scenery.rest)
        self.platform.removeAllChildren()
        for child in platform_nodes(value, scenery.mount):
            self.platform.addChild(child)
        self.nozzle.removeAllChildren()
        self.standing = transform_node(scenery.nozzle)
        self.nozzle.addChild(self.standing)
        self.nozzle.addChild(nozzle_node(value))
        if self.machine is not None:
            self.nozzle.addChild(holder_node(value))

    def move_nozzle(self, pose: Array) -> None:
        """Move the drawn nozzle to a pose (4, 4)."""
        if self.standing is not None:
            move(self.standing.matrix, pose)

    def _set_machine(self, value: CellParameters, rest_pose: Rest | None) -> None:
        """Pose the machine; rebuild its nodes only if its appearance changed."""
        looks = () if rest_pose is None else _appearance(value, rest_pose)
        if rest_pose is None or looks != self.looks:
            self.links.removeAllChildren()
            self.machine = None
        self.looks = looks
        if rest_pose is None:
            return
        if self.machine is None:
            self.machine = MachineNodes(rest_pose.machine, rest_pose.solids, rest_pose.meshes)
            self.external_links = ExternalLinkNodes(rest_pose.external_links)
            self.links.addChild(self.machine.node)
            self.links.addChild(self.external_links.node)
        self.machine.pose(rest_pose.links)
        if self.external_links is not None:
            self.external_links.pose(rest_pose.stands)


def _appearance(value: CellParameters, rest_pose: Rest) -> tuple[Any, ...]:
    """Return the inputs of a machine's nodes: its links at zero, the sizes that machines with
    rotary axes are fitted to, and the user's link files.
    """
    chain = rest_pose.machine.chain
    return (
        rest_pose.machine.id,
        chain.links(np.zeros(chain.axes)).tobytes(),
        ()
        if arrangement_of(value.setup).links_known
        else (value.platform_diameter, value.nozzle.length),
        *(None if mesh is None else hash(mesh[0].tobytes()) for mesh in rest_pose.meshes),
        *((link.name, hash(link.body.vertices.tobytes())) for link in rest_pose.external_links),
    )


def _seen_through() -> Any:
    """Create a node that makes the following nodes transparent and keeps their colours."""
    material = coin.SoMaterial()
    for channel in (
        material.ambientColor,
        material.diffuseColor,
        material.specularColor,
        material.emissiveColor,
        material.shininess,
    ):
        channel.setIgnored(True)
    material.transparency = _GHOST
    material.setOverride(True)
    return material


def coloured(look: tuple[tuple[float, float, float], float], node: Any) -> Any:
    """Wrap a node with a colour and a transparency."""
    material, group = coin.SoMaterial(), coin.SoSeparator()
    material.diffuseColor.setValue(*look[0])
    material.transparency = look[1]
    group.addChild(material)
    group.addChild(node)
    return group


def platform_nodes(value: CellParameters, mount: Array) -> list[Any]:
    """Return the nodes of the platform below its frame (4, 4); none if the diameter is 0."""
    if value.platform_diameter <= 0.0:
        return []
    radius = 0.5 * value.platform_diameter
    thick = value.platform if isinstance(value.platform, float) else _LEAST_THICKNESS
    low = -max(_LEAST_THICKNESS, thick)
    return [transform_node(mount), revolve([(0.0, low), (radius, low), (radius, 0.0), (0.0, 0.0)])]


def nozzle_node(value: CellParameters) -> Any:
    """Return the node of a cell's nozzle or torch, with the tip at the origin and Z into the
    nozzle.
    """
    torch = torch_seen(value)
    if torch is not None:
        return mesh_node((torch.body.vertices, torch.body.triangles))
    nozzle = value.nozzle
    tip_radius = 0.5 * nozzle.diameter
    top_radius = tip_radius + nozzle.length * np.tan(nozzle.half_angle)
    return revolve(
        [(0.0, 0.0), (tip_radius, 0.0), (top_radius, nozzle.length), (0.0, nozzle.length)]
    )


def torch_seen(value: CellParameters) -> Torch | None:
    """Return the torch in the frame of its tip; None without a torch, or if its field reports it as
    invalid.
    """
    try:
        return torch_of(value)
    except InputError:
        return None


def holder_node(value: CellParameters) -> Any:
    """Return the nozzle holder in the frame of the tip: from the nozzle's end to the flange of a
    robot that carries the nozzle, otherwise a short body.
    """
    arrangement, length = arrangement_of(value.setup), value.nozzle.length
    end, flange = np.array([0.0, 0.0, length]), np.array([0.0, 0.0, _BODY * length])
    if not arrangement.carries_part:
        tip = frames.bryant(value.nozzle.tool) @ frames.pose(frames.about_x(np.pi), np.zeros(3))
        flange = frames.inverse(tip)[:3, 3]
    radius = 0.5 * value.nozzle.diameter + length * np.tan(value.nozzle.half_angle)
    if (
        not arrangement.links_known
        or np.linalg.norm(flange - end) < 1.0
        or torch_seen(value) is not None
    ):
        return coin.SoSeparator()  # drawn with the machine's head, or with the nozzle
    return solid_node(capsule(end, flange, radius, radius))
