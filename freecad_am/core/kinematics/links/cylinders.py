# SPDX-License-Identifier: LGPL-2.1-or-later
"""The links of a robot as cylinders around their plain solids, or around attached shapes."""

from __future__ import annotations

from collections.abc import Sequence

from ...geometry.cylinders import Cylinder, drop_redundant, enclosing_cylinder, enclosing_row
from ...types import Array, Integers
from ..chain import Chain
from . import robot as robot_links
from .solids import Solid

Mesh = tuple[Array, Integers]


def robot_cylinders(chain: Chain, shapes: Sequence[Mesh | None] = ()) -> list[list[Cylinder]]:
    """Return the cylinders of each link (axes + 1) of a robot, base first, in the frame of the
    link.

    shapes: points (n, 3) and triangles (m, 3) of links that are not drawn plain, in the same
    frames.
    """
    plain = [solid_cylinders(link) for link in robot_links.solids(chain)]
    return [
        enclosing_row(*shape) if shape is not None else link
        for shape, link in zip(shapes or [None] * len(plain), plain)
    ]


def solid_cylinders(link: Sequence[Solid]) -> list[Cylinder]:
    """The cylinders that hold the solids of a link, in the same frame."""
    points = [solid.points for solid in link]
    return drop_redundant([enclosing_cylinder(solid_points) for solid_points in points], points)
