# SPDX-License-Identifier: LGPL-2.1-or-later
"""The links of positioner and track as bodies that move with their axes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...collision.scene import Bodies, build_bodies
from ...geometry.cylinders import Cylinder, drop_redundant, enclosing_cylinder, enclosing_row
from ...geometry.obstacles import Body
from ...types import Array, Integers
from ..chain import Chain
from ..external import ExternalAxes
from . import robot as robot_links
from .bodies import LinkShape, Pieces
from .solids import Solid

Mesh = tuple[Array, Integers]


def robot_cylinders(chain: Chain, shapes: Sequence[Mesh | None] = ()) -> list[list[Cylinder]]:
    """Return the cylinders of each robot link (axes + 1) in the link frame, base first.

    shapes: points (n, 3) and triangles (m, 3) of links with a known shape, in the link frames.
    """
    plain = [solid_cylinders(link) for link in robot_links.solids(chain)]
    return [
        enclosing_row(*shape) if shape is not None else link
        for shape, link in zip(shapes or [None] * len(plain), plain)
    ]


def solid_cylinders(link: Sequence[Solid]) -> list[Cylinder]:
    """Return cylinders that enclose the solids of a link, in the same frame."""
    points = [solid.points for solid in link]
    return drop_redundant([enclosing_cylinder(solid_points) for solid_points in points], points)


Read = Callable[[LinkShape], Mesh | None]
EDGE = 50.0  # mm; maximum triangle edge in nozzle tests
STANDS = -1  # value of `axis` for a link fixed to the floor


@dataclass(frozen=True, eq=False)
class ExternalLink:
    """A link of a mechanism.

    machine: id of the mechanism. mechanism: its index. link: index of the link, 0 for the base.
    axis: the last external axis that moves the link; STANDS if none does. carries: `part` or
    `robot`. axes_after: number of axes between the link and the load. body: named as in messages.
    cylinders: enclose the body, in its frame.
    """

    machine: str
    mechanism: int
    link: int
    axis: int
    carries: str
    axes_after: int
    body: Body
    cylinders: tuple[Cylinder, ...]

    @cached_property
    def solid(self) -> Bodies:
        """The body for tests against nozzles."""
        return build_bodies([self.body], self.body.vertices, 0.0, EDGE)

    @property
    def name(self) -> str:
        """The name in messages."""
        return self.body.name


def external_links(
    external: ExternalAxes | None,
    read_shape: Read | None = None,
    known_links: Sequence[ExternalLink] = (),
) -> tuple[ExternalLink, ...]:
    """Return the links of all mechanisms whose files describe them.

    Parameters
    ----------
    external : ExternalAxes or None
        The external axes; None without external axes.
    read_shape : Read or None, optional
        Returns the triangles of a shape file in the link frame; None if there are none.
    known_links : sequence of ExternalLink, optional
        Links that are already loaded.

    Returns
    -------
    tuple of ExternalLink
        The links, grouped by mechanism.
    """
    if external is None:
        return ()
    links = []
    for number, mechanism in enumerate(external.mechanisms):
        pieces_of_links = mechanism.machine.bodies or ((),) * (mechanism.machine.chain.axes + 1)
        for link, link_pieces in enumerate(pieces_of_links):
            known_link = next(
                (
                    candidate
                    for candidate in known_links
                    if (candidate.machine, candidate.link) == (mechanism.machine.id, link)
                ),
                None,
            )
            body_and_cylinders = (
                (known_link.body, known_link.cylinders)
                if known_link is not None
                else _merge_pieces(link_pieces, read_shape)
            )
            if body_and_cylinders is None:
                continue
            name = f"{mechanism.machine.title} {'base' if link == 0 else f'e{mechanism.values[link - 1] + 1}'}"
            links.append(
                ExternalLink(
                    mechanism.machine.id,
                    number,
                    link,
                    _axis(external, number, link),
                    mechanism.carries,
                    _after(external, number, link),
                    dataclasses.replace(body_and_cylinders[0], name=name),
                    body_and_cylinders[1],
                )
            )
    return tuple(links)


def titles_without_shape(external: ExternalAxes, links: Sequence[ExternalLink]) -> list[str]:
    """Return the titles of mechanisms without known shape; links: the known links."""
    described = {link.mechanism for link in links}
    return [
        link.machine.title
        for number, link in enumerate(external.mechanisms)
        if number not in described
    ]


def _axis(external: ExternalAxes, number: int, link: int) -> int:
    """Return the index of the last external axis that moves a link."""
    mechanism = external.mechanisms[number]
    if link:
        return int(mechanism.values[link - 1])
    return (
        STANDS if mechanism.under is None else int(external.mechanisms[mechanism.under].values[-1])
    )


def _after(external: ExternalAxes, number: int, link: int) -> int:
    """Return the number of axes between a link and the load."""
    above = [mechanism for mechanism in external.mechanisms if mechanism.under == number]
    count = external.mechanisms[number].machine.chain.axes - link
    return count + sum(mechanism.machine.chain.axes for mechanism in above)


def _merge_pieces(
    shapes: Pieces, read_shape: Read | None
) -> tuple[Body, tuple[Cylinder, ...]] | None:
    """Return the shapes of a link as one unnamed body, and the enclosing cylinders.

    None if there are no shapes.
    """
    meshes = [mesh for mesh in (_mesh(shape, read_shape) for shape in shapes) if mesh is not None]
    if not meshes:
        return None
    first_point = np.cumsum([0, *(len(points) for points, _ in meshes)])
    triangles = [
        triangles + start for (_, triangles), start in zip(meshes, first_point, strict=False)
    ]
    body = Body("", np.concatenate([points for points, _ in meshes]), np.concatenate(triangles))
    return body, tuple(cylinder for mesh in meshes for cylinder in enclosing_row(*mesh))


def _mesh(shape: LinkShape | Solid, read_shape: Read | None) -> Mesh | None:
    if isinstance(shape, Solid):
        return shape.points, shape.triangles
    return None if read_shape is None else read_shape(shape)
