# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the links of a mechanism beside a robot are made of: boxes and cylinders of its file, or files of shapes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...types import Array
from ..machines.file import Node
from . import solids
from .shape import BASE, LinkShape, shape_of
from .solids import BODY, BRIGHT, Solid

Pieces = tuple[LinkShape | Solid, ...]


@dataclass(frozen=True, eq=False)
class Primitive(Solid):
    """A box or cylinder (`kind`) with its `size` as a machine file has them, mm, and where its middle is: pose (4, 4)."""

    kind: str = ""
    size: tuple[float, ...] = ()
    pose: Array | None = None

    def moved(self, pose: Array) -> Primitive:
        """The piece moved by a pose (4, 4)."""
        solid = super().moved(pose)
        at = pose if self.pose is None else pose @ self.pose
        return replace(self, points=solid.points, normals=solid.normals, pose=at)


def link_bodies(
    top: Node, joints: tuple[str, ...], shapes: tuple[LinkShape | None, ...]
) -> tuple[Pieces, ...]:
    """The bodies (axes + 1) of a machine file's links, base first, each in the frame of its link: those under `bodies`, else
    the file under `shapes` (axes + 1); none where neither tells.

    Raises InputError 'BAD_MACHINE' for a link or a value that is wrong.
    """
    links = (BASE, *joints)
    if not top.has("bodies"):
        return tuple(() if shape is None else (shape,) for shape in shapes)
    text = top["bodies"].only("source", *links)
    text["source"].text()
    return tuple(
        tuple(_piece(piece, last=name == links[-1]) for piece in text[name].items())
        if text.has(name)
        else ()
        for name in links
    )


def _piece(node: Node, last: bool) -> LinkShape | Solid:
    if node.has("file"):
        return shape_of(node)
    node.only("box", "cylinder", "origin", "rpy")
    kind, count = ("box", 3) if node.has("box") else ("cylinder", 2)
    size = node[kind].numbers(count)
    if (size <= 0.0).any():
        raise node[kind].bad(
            "give sizes larger than 0: of a box along x, y and z, of a cylinder its diameter and length"
        )
    pose = node.pose() if node.has("origin") or node.has("rpy") else np.eye(4)
    tone = BRIGHT if last else BODY
    return (box if kind == "box" else cylinder)(size, tone).moved(pose)


def box(size: Array, tone: str = BODY) -> Primitive:
    """A box of `size` (3,) mm about the origin."""
    x, y, z = size.tolist()
    return _primitive(
        solids.box(np.zeros(3), np.eye(3)[0], np.eye(3)[1], (x, y, z), tone), "box", size
    )


def cylinder(size: Array, tone: str = BODY) -> Primitive:
    """A cylinder of a diameter and a length, `size` (2,) mm, along Z about the origin, as a polygon that holds it."""
    radius, half = 0.5 * float(size[0]) / np.cos(np.pi / solids.SIDES), 0.5 * float(size[1])
    outline = [(0.0, 0.0), (radius, 0.0), (radius, 1.0), (0.0, 1.0)]
    return _primitive(
        solids.turned(outline, [0.0, 0.0, -half], [0.0, 0.0, half], tone), "cylinder", size
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
