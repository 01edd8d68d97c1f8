# SPDX-License-Identifier: LGPL-2.1-or-later
"""The links of the mechanisms beside a robot, positioner and track, as bodies that move with their axes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...collision.bodies import Bodies, build_bodies
from ...geometry.cylinders import Cylinder, enclosing_row
from ...geometry.obstacles import Body
from ..external import ExternalAxes
from .bodies import Pieces
from .cylinders import Mesh
from .shape import LinkShape
from .solids import Solid

Read = Callable[[LinkShape], Mesh | None]
EDGE = 50.0  # mm, longest edge of a triangle that nozzles are looked at against
STANDS = -1  # in place of the axis of a link that stands on the floor


@dataclass(frozen=True, eq=False)
class ExternalLink:
    """A link of a mechanism: `body`, by the name that messages call it, and the cylinders that hold it, in its frame.

    machine: the id of the mechanism; mechanism, link: its place among all, and which of its links it is, 0 its base.
    axis: of those beside the robot the one that moves it last, STANDS where none does. carries: `part` or `robot`; after:
    how many axes are between it and what it carries.
    """

    machine: str
    mechanism: int
    link: int
    axis: int
    carries: str
    after: int
    body: Body
    cylinders: tuple[Cylinder, ...]

    @cached_property
    def solid(self) -> Bodies:
        """The body as nozzles are looked at against it."""
        return build_bodies([self.body], self.body.vertices, 0.0, EDGE)

    @property
    def name(self) -> str:
        """What messages call it."""
        return self.body.name


def external_links(
    external: ExternalAxes | None, read: Read | None = None, known: Sequence[ExternalLink] = ()
) -> tuple[ExternalLink, ...]:
    """The links of all mechanisms whose files tell what they are made of. read: of a file of shapes its triangles in the
    frame of the link, None where there are none; those of mechanisms that are `known` are not read again."""
    if external is None:
        return ()
    found = []
    for number, one in enumerate(external.mechanisms):
        pieces = one.machine.bodies or ((),) * (one.machine.chain.axes + 1)
        for link, parts in enumerate(pieces):
            before = next(
                (each for each in known if (each.machine, each.link) == (one.machine.id, link)),
                None,
            )
            made = (before.body, before.cylinders) if before is not None else _made(parts, read)
            if made is None:
                continue
            name = f"{one.machine.title} {'base' if link == 0 else f'e{one.values[link - 1] + 1}'}"
            found.append(
                ExternalLink(
                    one.machine.id,
                    number,
                    link,
                    _axis(external, number, link),
                    one.carries,
                    _after(external, number, link),
                    dataclasses.replace(made[0], name=name),
                    made[1],
                )
            )
    return tuple(found)


def of_unknown_shape(external: ExternalAxes, links: Sequence[ExternalLink]) -> list[str]:
    """Titles of the mechanisms of which nothing is known to be kept clear; links: those that are known."""
    known = {one.mechanism for one in links}
    return [
        one.machine.title for number, one in enumerate(external.mechanisms) if number not in known
    ]


def _axis(external: ExternalAxes, number: int, link: int) -> int:
    """Which of the external axes moves a link of a mechanism last."""
    one = external.mechanisms[number]
    if link:
        return int(one.values[link - 1])
    return STANDS if one.under is None else int(external.mechanisms[one.under].values[-1])


def _after(external: ExternalAxes, number: int, link: int) -> int:
    """How many axes are between a link of a mechanism and what it carries in the end."""
    above = [one for one in external.mechanisms if one.under == number]
    count = external.mechanisms[number].machine.chain.axes - link
    return count + sum(one.machine.chain.axes for one in above)


def _made(pieces: Pieces, read: Read | None) -> tuple[Body, tuple[Cylinder, ...]] | None:
    """The pieces of a link as one body, without a name, and the cylinders that hold them; None without any."""
    meshes = [mesh for mesh in (_mesh(piece, read) for piece in pieces) if mesh is not None]
    if not meshes:
        return None
    first = np.cumsum([0, *(len(points) for points, _ in meshes)])
    triangles = [triangles + start for (_, triangles), start in zip(meshes, first, strict=False)]
    body = Body("", np.concatenate([points for points, _ in meshes]), np.concatenate(triangles))
    return body, tuple(cylinder for mesh in meshes for cylinder in enclosing_row(*mesh))


def _mesh(piece: LinkShape | Solid, read: Read | None) -> Mesh | None:
    if isinstance(piece, Solid):
        return piece.points, piece.triangles
    return None if read is None else read(piece)
