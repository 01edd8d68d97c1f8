# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies of the links of a mechanism: boxes and cylinders from its machine file, or shape files."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...issues import Text
from ...types import Array
from ..machines.file import Node
from . import solids
from .solids import BODY, BRIGHT, Solid

BASE = "base"
FORMATS = (".step", ".stp", ".iges", ".igs", ".brep", ".stl", ".obj")


@dataclass(frozen=True, eq=False)
class LinkShape:
    """A shape file of a link.

    pose: (4, 4) of the content in the link frame, mm. scale: size of a file unit, mm. colour: red,
    green and blue from 0 to 1. where: file and key, for messages.
    """

    path: Path
    pose: Array
    scale: float
    colour: tuple[float, float, float] | None
    where: str


def link_shapes(top: Node, joints: tuple[str, ...]) -> tuple[LinkShape | None, ...]:
    """Return the shape files of the links of a machine.

    Planning does not need the files, so drawing checks whether they exist.

    Parameters
    ----------
    top : Node
        Content of the machine file.
    joints : tuple of str
        Joint names.

    Returns
    -------
    tuple[LinkShape or None, ...]
        Shapes (axes + 1), base first; None for a link without a shape.

    Raises
    ------
    InputError
        BAD_MACHINE for an invalid link, format or value.
    """
    links = (BASE, *joints)
    if not top.has("shapes"):
        return (None,) * len(links)
    entries = top["shapes"].only(*links)
    return tuple(shape_of(entries[name]) if entries.has(name) else None for name in links)


def shape_of(node: Node) -> LinkShape:
    """Return the shape of a machine file entry. Raises InputError BAD_MACHINE as `link_shapes`."""
    node.only("file", "origin", "rpy", "scale", "colour")
    path = Path(node["file"].text())
    if path.suffix.lower() not in FORMATS:
        raise node["file"].bad(
            Text("{} is not a supported shape format; use {}", path.name, ", ".join(FORMATS))
        )
    pose = np.eye(4)
    if node.has("origin") or node.has("rpy"):
        pose = node.pose()
    scale = node["scale"].number() if node.has("scale") else 1.0
    if scale <= 0.0:
        raise node["scale"].bad(Text("{:g} is not a scale; give 1 for mm, 1000 for m", scale))
    colour = None
    if node.has("colour"):
        values = node["colour"].numbers(3)
        if ((values < 0.0) | (values > 1.0)).any():
            raise node["colour"].bad(
                Text(
                    "{} is not a colour; use red, green and blue from 0 to 1", node["colour"].value
                )
            )
        colour = (float(values[0]), float(values[1]), float(values[2]))
    file = path if path.is_absolute() else node.path.parent / path
    return LinkShape(file, pose, scale, colour, f"{node.path}: {node.key}.file")


Pieces = tuple[LinkShape | Solid, ...]


@dataclass(frozen=True, eq=False)
class Primitive(Solid):
    """A box or cylinder (`kind`) of a machine file.

    size: mm. pose: (4, 4) of its centre.
    """

    kind: str = ""
    size: tuple[float, ...] = ()
    pose: Array | None = None

    def move(self, pose: Array) -> Primitive:
        """Return the primitive moved by a pose (4, 4)."""
        solid = super().move(pose)
        new_pose = pose if self.pose is None else pose @ self.pose
        return replace(self, points=solid.points, normals=solid.normals, pose=new_pose)


def link_bodies(
    top: Node, joints: tuple[str, ...], shapes: tuple[LinkShape | None, ...]
) -> tuple[Pieces, ...]:
    """Return the bodies of the links of a machine.

    Parameters
    ----------
    top : Node
        Content of the machine file.
    joints : tuple of str
        Joint names.
    shapes : tuple[LinkShape or None, ...]
        Shape files (axes + 1), used if the machine file has no `bodies`.

    Returns
    -------
    tuple of Pieces
        Bodies (axes + 1) in their link frames, base first; empty for a link without a body.

    Raises
    ------
    InputError
        BAD_MACHINE for an invalid link or value.
    """
    links = (BASE, *joints)
    if not top.has("bodies"):
        return tuple(() if shape is None else (shape,) for shape in shapes)
    text = top["bodies"].only("source", *links)
    text["source"].text()
    bodies: list[Pieces] = []
    for name in links:
        nodes = text[name].items() if text.has(name) else []
        bodies.append(tuple(_piece(node, is_last=name == links[-1]) for node in nodes))
    return tuple(bodies)


def _piece(node: Node, is_last: bool) -> LinkShape | Solid:
    if node.has("file"):
        return shape_of(node)
    node.only("box", "cylinder", "origin", "rpy")
    kind, count = ("box", 3) if node.has("box") else ("cylinder", 2)
    size = node[kind].numbers(count)
    if (size <= 0.0).any():
        raise node[kind].bad(
            "give sizes larger than 0: for a box along x, y and z, for a cylinder the diameter "
            "and the length"
        )
    pose = node.pose() if node.has("origin") or node.has("rpy") else np.eye(4)
    tone = BRIGHT if is_last else BODY
    return (box if kind == "box" else cylinder)(size, tone).move(pose)


def box(size: Array, tone: str = BODY) -> Primitive:
    """Return a box centred at the origin.

    Parameters
    ----------
    size : (3,) array
        Lengths along x, y and z, mm.
    tone : str, optional
        Surface tone.

    Returns
    -------
    Primitive
        The box.
    """
    x, y, z = size.tolist()
    return _primitive(
        solids.box(np.zeros(3), np.eye(3)[0], np.eye(3)[1], (x, y, z), tone), "box", size
    )


def cylinder(size: Array, tone: str = BODY) -> Primitive:
    """Return a cylinder along Z centred at the origin, as a prism that contains it.

    Parameters
    ----------
    size : (2,) array
        Diameter and length, mm.
    tone : str, optional
        Surface tone.

    Returns
    -------
    Primitive
        The cylinder.
    """
    radius, half = 0.5 * float(size[0]) / np.cos(np.pi / solids.SIDES), 0.5 * float(size[1])
    outline = [(0.0, 0.0), (radius, 0.0), (radius, 1.0), (0.0, 1.0)]
    return _primitive(
        solids.revolve(outline, [0.0, 0.0, -half], [0.0, 0.0, half], tone), "cylinder", size
    )


def _primitive(solid: Solid, kind: str, size: Array) -> Primitive:
    return Primitive(
        solid.points,
        solid.normals,
        solid.triangles,
        solid.tone,
        kind,
        tuple(size.tolist()),
        np.eye(4),
    )
