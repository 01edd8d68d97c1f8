# SPDX-License-Identifier: LGPL-2.1-or-later
"""The links of a robot as cylinders, by what is drawn of them: its plain solids, or the shapes a user attached."""

from __future__ import annotations

from collections.abc import Sequence

from ...geometry.cylinders import Cylinder, drop_redundant, enclosing_cylinder, enclosing_row
from ...types import Array, Integers
from ..chain import Chain
from . import robot as robot_links
from .solids import Solid

Mesh = tuple[Array, Integers]


def of_robot(chain: Chain, shapes: Sequence[Mesh | None] = ()) -> list[list[Cylinder]]:
    """The rods of each link (axes + 1) of a robot, base first, in the frame of the link.

    shapes: points (n, 3) and triangles (m, 3) of links that are not drawn plain, in the same frames.
    """
    plain = [of_solids(link) for link in robot_links.solids(chain)]
    return [
        enclosing_row(*shape) if shape is not None else link
        for shape, link in zip(shapes or [None] * len(plain), plain)
    ]


def of_solids(link: Sequence[Solid]) -> list[Cylinder]:
    """The cylinders that hold the solids of a link, in the same frame."""
    points = [solid.points for solid in link]
    return drop_redundant([enclosing_cylinder(each) for each in points], points)
