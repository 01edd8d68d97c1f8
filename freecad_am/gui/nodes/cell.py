# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cell as the part sees it: the platform under it, the nozzle, and on demand the machine at rest; and its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from pivy import coin

from freecad_am.core.types import Array

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics import cell as cells
from ...core.kinematics.arrangement import arrangement_of
from ...core.kinematics.cell import Cell
from ...core.kinematics.limits import Limits
from ...core.kinematics.links.cylinders import Mesh
from ...core.kinematics.links.external_links import ExternalLink, external_links
from ...core.kinematics.links.solids import capsule
from ...core.kinematics.machines.machine import Machine
from ...core.kinematics.torch import Torch
from ...core.parameters.cell import CellParameters
from ...core.simulation.placing import at_rest, placing
from ...core.toolpath import Toolpath
from ...objects.shapes.cell_obstacles import torch_of
from ...objects.shapes.link_meshes import meshes_of, readable_mesh
from .external_links import ExternalLinkNodes
from .lines import placed, turned
from .machine_links import Links, MachineNodes, move, of_mesh, of_solid, plain_links
from .wall import unpickable

_LEAST_THICKNESS = 1.0
_BODY = 2.5  # where the body of a nozzle that stands still ends, in lengths of the nozzle
_REACHED = 1.0  # mm from where the nozzle should be; check poses of machine files may be rounded by half of it
_GHOST = 0.55  # how transparent a machine is that nothing but shows what is entered
PLATFORM, NOZZLE = ((0.55, 0.58, 0.62), 0.2), ((0.8, 0.82, 0.85), 0.0)


@dataclass(frozen=True, eq=False)
class Rest:
    """A machine at rest, in part coordinates: links (axes + 1, 4, 4), what they look like, and the meshes of files a user
    gave them. reached: whether it gets there; else all axes are at 0. limits, joints (axes,): as it stands. external_links: the
    links of positioner and track that are known, at `stands` (k, 4, 4)."""

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
    """What is drawn of a cell, poses (4, 4) in part coordinates. mount: what sits on the platform. nozzle: its tip, Z into
    it. rest: the machine, None where it is not to be seen."""

    parameters: CellParameters
    mount: Array
    nozzle: Array
    rest: Rest | None = None


def without_machine(parameters: CellParameters, tip: Array, tool: Array, mount: Array) -> Scenery:
    """The nozzle where the deposit ends: its last point (3,) and the tool axis there (3,)."""
    return Scenery(parameters, mount, at_end(tip, tool))


def at_end(tip: Array, tool: Array) -> Array:
    """(4, 4) pose of a nozzle whose tip is at a point (3,), its axis along the tool's (3,)."""
    return frames.pose(frames.smallest_rotation([0.0, 0.0, 1.0], tool), tip)


def at_the_end(
    parameters: CellParameters, toolpath: Toolpath | None, folders: Sequence[str]
) -> Scenery:
    """The nozzle where a toolpath ends, upright on the platform without one. Errors as `cell.resolve`."""
    if toolpath is None:
        return without_machine(parameters, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.eye(4))
    mount, last = (
        cells.resolve(parameters, toolpath.frame, toolpath.family, folders).mount,
        toolpath.layers[-1].beads[-1],
    )
    return without_machine(parameters, last.points[-1], last.tool[-1], mount)


def with_machine(
    parameters: CellParameters, toolpath: Toolpath | None, folders: Sequence[str]
) -> Scenery:
    """The machine at rest: the part upright, its highest point under the nozzle; the platform without a toolpath. Errors as
    `cell.resolve`."""
    frame, family = (
        (np.eye(4), "revolution") if toolpath is None else (toolpath.frame, toolpath.family)
    )
    cell = cells.resolve(parameters, frame, family, folders)
    cell = replace(cell, external_links=external_links(cell.external, readable_mesh))
    point = resting_point(toolpath, cell.mount)
    joints = at_rest(cell, point)
    solids = plain_links(cell.robot, parameters.platform_diameter, parameters.nozzle.length)
    return Scenery(parameters, cell.mount, *_standing(cell, joints, point, solids))


def _standing(cell: Cell, joints: Array, point: Array, solids: Links) -> tuple[Array, Rest]:
    place = placing(cell, joints)
    to_part = frames.inverse(place.part)
    nozzle = to_part @ place.nozzle
    reached = bool(np.linalg.norm(nozzle[:3, 3] - point) < _REACHED)
    machine = cell.robot
    return nozzle, Rest(
        machine,
        to_part @ place.links,
        solids,
        meshes_of(machine),
        reached,
        cell.limits,
        joints,
        cell.external_links,
        to_part @ place.external_links,
    )


def resting_point(toolpath: Toolpath | None, mount: Array) -> Array:
    """(3,) where the nozzle stands at rest: on the highest point of the toolpath, or on the platform without one."""
    if toolpath is None:
        return np.asarray(mount[:3, 3])
    points = np.concatenate([bead.points for _, _, bead in toolpath])
    return np.asarray(points[int(np.argmax(points @ mount[:3, 2]))])


class CellNodes:
    """Draws a cell, nothing at first. As a `ghost` its machine shows what is behind, and clicks go through all of it."""

    def __init__(self, ghost: bool = False) -> None:
        self.machine: MachineNodes | None = None
        self.external_links: ExternalLinkNodes | None = None
        self.standing: Any = None  # the transformation of the nozzle
        self.looks: tuple[Any, ...] = ()  # what the machine's nodes were made of
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
        self.standing = placed(scenery.nozzle)
        self.nozzle.addChild(self.standing)
        self.nozzle.addChild(nozzle_node(value))
        if self.machine is not None:
            self.nozzle.addChild(holder_node(value))

    def move_nozzle(self, pose: Array) -> None:
        """Move the nozzle that is drawn to a pose (4, 4)."""
        if self.standing is not None:
            move(self.standing.matrix, pose)

    def _set_machine(self, value: CellParameters, rest: Rest | None) -> None:
        """Pose the machine; its nodes are made anew only where it is to look otherwise."""
        looks = () if rest is None else _looks(value, rest)
        if rest is None or looks != self.looks:
            self.links.removeAllChildren()
            self.machine = None
        self.looks = looks
        if rest is None:
            return
        if self.machine is None:
            self.machine = MachineNodes(rest.machine, rest.solids, rest.meshes)
            self.external_links = ExternalLinkNodes(rest.external_links)
            self.links.addChild(self.machine.node)
            self.links.addChild(self.external_links.node)
        self.machine.pose(rest.links)
        if self.external_links is not None:
            self.external_links.pose(rest.stands)


def _looks(value: CellParameters, rest: Rest) -> tuple[Any, ...]:
    """What the nodes of a machine are made of: its links as they are at zero, of machines with rotary axes the sizes that
    they are drawn to fit, and the files a user gave the links."""
    chain = rest.machine.chain
    return (
        rest.machine.id,
        chain.links(np.zeros(chain.axes)).tobytes(),
        ()
        if arrangement_of(value.setup).links_known
        else (value.platform_diameter, value.nozzle.length),
        *(None if mesh is None else hash(mesh[0].tobytes()) for mesh in rest.meshes),
        *((link.name, hash(link.body.vertices.tobytes())) for link in rest.external_links),
    )


def _seen_through() -> Any:
    """The node that makes what follows transparent, and leaves its colours."""
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
    """The nozzle of a cell: its tip at the origin, Z into it; with a torch this."""
    held = torch_seen(value)
    if held is not None:
        return of_mesh((held.body.vertices, held.body.triangles))
    nozzle = value.nozzle
    tip_radius = 0.5 * nozzle.diameter
    top_radius = tip_radius + nozzle.length * np.tan(nozzle.half_angle)
    return turned(
        [(0.0, 0.0), (tip_radius, 0.0), (top_radius, nozzle.length), (0.0, nozzle.length)]
    )


def torch_seen(value: CellParameters) -> Torch | None:
    """The torch, in the frame of its tip; None without one, or where it is refused, which is told at its field."""
    try:
        return torch_of(value)
    except InputError:
        return None


def holder_node(value: CellParameters) -> Any:
    """What holds the nozzle, seen from its tip: from its end to the flange of a robot that carries it, else a short body."""
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
    return of_solid(capsule(end, flange, radius, radius))
