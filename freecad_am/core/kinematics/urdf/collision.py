# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the links of a mechanism are made of, from the <collision> elements of a URDF, or its <visual> ones without any."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...issues import Text
from ...types import Array
from ..links import bodies
from ..links.bodies import LinkShape, Pieces
from ..links.solids import Solid
from .elements import Element
from .read import FIXED, Urdf

NOT_LOOKED_AT = "nothing is kept clear of it"


def collision(urdf: Urdf, base: str, tip: str, notes: list[str]) -> tuple[Pieces, ...]:
    """Return the bodies (axes + 1) of the links between a base and a tip, base first, mm.

    Each is in the frame of the joint that moves it and includes all links fixed to it, but
    not the load on the tip, which has its own joints. Unreadable geometry is noted.
    """
    chain = [tip, *urdf.above(tip)]
    chain = chain[: chain.index(base) + 1][::-1]
    groups: list[list[tuple[str, Array]]] = [[(base, np.eye(4))]]
    for link in chain[1:]:
        fixed = urdf.parent[link].text("type") == FIXED
        if not fixed:
            groups.append([(link, np.eye(4))])
        elif link != tip or not _moves_others(urdf, link):
            groups[-1].append((link, groups[-1][-1][1] @ urdf.parent[link].pose()))
    for group in groups[1:]:
        for link, pose in list(group):
            group.extend(_fixed_to(urdf, link, pose, chain))
    return tuple(
        tuple(body for link, pose in group for body in _pieces(urdf, link, pose, notes))
        for group in groups
    )


def _moves_others(urdf: Urdf, link: str) -> bool:
    """Return whether joints move anything mounted on a link."""
    return any(
        urdf.parent[child].text("type") != FIXED or _moves_others(urdf, child)
        for child in urdf.children_of(link)
    )


def _fixed_to(
    urdf: Urdf, link: str, pose: Array, but: Sequence[str]
) -> Iterator[tuple[str, Array]]:
    """Yield the links fixed to a link at a pose, with their poses."""
    for child in urdf.children_of(link):
        joint = urdf.parent[child]
        if child not in but and joint.text("type") == FIXED:
            child_pose = pose @ joint.pose()
            yield child, child_pose
            yield from _fixed_to(urdf, child, child_pose, but)


def _pieces(urdf: Urdf, link: str, pose: Array, notes: list[str]) -> Iterator[LinkShape | Solid]:
    element = urdf.links[link]
    text = list(element.all("collision")) or list(element.all("visual"))
    for geometry in text:
        solid = _solid(geometry)
        if solid is not None:
            yield solid.move(pose @ geometry.pose())
            continue
        shape = urdf.mesh_of(geometry, f"{link}: {NOT_LOOKED_AT}", notes)
        if shape is not None:
            yield LinkShape(shape.path, pose @ shape.pose, shape.scale, shape.colour, shape.where)


def _solid(element: Element) -> Solid | None:
    """The box, cylinder or ball of an element, about its origin; a ball as the cylinder about it."""
    geometry = element.first("geometry")
    if geometry is None:
        return None
    for child in geometry.children:
        if child.tag == "box":
            return bodies.box(1000.0 * _sizes(child, child.numbers("size", 3, "")))
        if child.tag in ("cylinder", "sphere"):
            radius = child.number("radius")
            length = child.number("length") if child.tag == "cylinder" else 2.0 * radius
            return bodies.cylinder(1000.0 * _sizes(child, np.array([2.0 * radius, length])))
    return None


def _sizes(element: Element, sizes: Array) -> Array:
    if (sizes <= 0.0).any():
        raise element.bad(
            Text("<{}> has a size that is not positive; give its sizes in m", element.tag)
        )
    return sizes
