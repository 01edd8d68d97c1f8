# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes that a machine file attaches to its links, drawn in place of plain solids."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...issues import Text
from ...types import Array
from ..machines.file import Node

BASE = "base"
FORMATS = (".step", ".stp", ".iges", ".igs", ".brep", ".stl", ".obj")


@dataclass(frozen=True, eq=False)
class LinkShape:
    """A file of a link. `pose` (4, 4) places its content in the frame of the link's joint, mm; `scale` is what one of the
    file's units amounts to in mm; `colour` 0..1 each. `where` names file and key in messages."""

    path: Path
    pose: Array
    scale: float
    colour: tuple[float, float, float] | None
    where: str


def link_shapes(top: Node, joints: tuple[str, ...]) -> tuple[LinkShape | None, ...]:
    """Return the shapes (axes + 1) of a machine file's links, base first, None for links without
    a shape.

    Raises InputError 'BAD_MACHINE' for a wrong link, format or value. Whether the files exist
    is checked when they are drawn: planning does not need them.
    """
    links = (BASE, *joints)
    if not top.has("shapes"):
        return (None,) * len(links)
    entries = top["shapes"].only(*links)
    return tuple(shape_of(entries[name]) if entries.has(name) else None for name in links)


def shape_of(node: Node) -> LinkShape:
    """The shape that an entry of a machine file names. Raises InputError 'BAD_MACHINE' as `link_shapes` does."""
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
