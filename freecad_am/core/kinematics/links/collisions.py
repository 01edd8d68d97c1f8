# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions of the arm, and of the platform, with what stands in the cell, whether or not planning kept clearances.

Links are looked at twice. As they are drawn, less `PENETRATION`, they tell what comes near. Links that no manufacturer's
shape is known of are drawn from the kinematics alone, and the cylinders about a true shape are wider than it is; so an
error needs the core of a link, `CORE` of its radius, in something. The core lies about the line that a link has to follow:
from the elbow on, where axes meet at angles, that line is certain; before it, links of parallel axes may stand aside of it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.bodies import of_bodies
from ...collision.obstacles import Obstacles
from ...collision.scene import Scene
from ...geometry import frames
from ...geometry.cylinders import Cylinder
from ...geometry.obstacles import Body
from ...types import Array, Index
from ..cell import Cell
from .contact import PLATFORM, ArmContact
from .rounds import NONE, Solid, of_cylinder

PENETRATION = 0.5  # mm; faces are triangles, and what is no deeper rests on one another
CORE = 0.5  # of the radius of a link
CERTAIN = 4  # the first link from the elbow on, which runs along the line drawn of it
PLATFORM_DEPTH = 5.0  # mm below its plane that a platform which stands is made of, at the least
NOZZLE_AFTER = 2  # the number of the nozzle in `ArmContact.links`, after the axes

Cylinders = Sequence[Sequence[Cylinder]]


@dataclass(frozen=True)
class Collision:
    """A link, or the platform, in something. rows: (n,) the joint vectors at which, rising, empty of the platform, which is in
    it all the time. sure: whether the core of the link is in it; else only what is drawn of the link."""

    link: str
    what: str
    rows: Index
    sure: bool


def arm_collisions(
    cell: Cell,
    cylinders: Cylinders,
    bodies: Sequence[Body],
    deposit: Obstacles | None,
    joints: Array,
    moment: Index,
    known: Sequence[bool] = (),
) -> list[Collision]:
    """What the links are in with joints (k, axes), when `moment` (k,) points of the deposit are there: one entry for each
    link and thing, sure ones first. cylinders: of each link, base first. known: whether a link has its true shape, none
    where this is not given."""
    drawn = ArmContact(cell, cylinders, bodies, deposit, -PENETRATION, holders=True)
    near = drawn.touches(joints, moment)
    rows = np.flatnonzero(near.any)
    if not len(rows):
        return []
    cores = [[_core(one) for one in link] for link in cylinders]
    contact = ArmContact(cell, cores, bodies, deposit, -PENETRATION, holders=True)
    sure = contact.touches(joints[rows], moment[rows])
    found = _pairs(contact, sure.link, sure.what, rows, True, known)
    if not found:
        found = _pairs(drawn, near.link[rows], near.what[rows], rows, False, known)
    return sorted(found, key=lambda one: (not one.sure, -len(one.rows), one.link, one.what))


def platform_collisions(cell: Cell, bodies: Sequence[Body]) -> list[Collision]:
    """The bodies that reach into the platform: the plate below its plane, down to the flange where a robot carries it. What is
    deposited below it is rejected before beads are planned."""
    plate = plate_of(cell)
    if plate is None:
        return []
    tip, axis = frames.at(cell.mount[None], plate.tip), frames.turned(cell.mount[None], plate.axis)
    return [
        Collision(PLATFORM, body.name, np.zeros(0, dtype=np.intp), True)
        for body in bodies
        if len(body.triangles)
        and Scene(of_bodies([body], body.vertices, 0.0)).touched(plate.solid, tip, axis).any()
    ]


def plate_of(cell: Cell) -> Solid | None:
    """The platform in the frame that sits on it, smaller by what may be in it; None without one."""
    radius = 0.5 * cell.platform_diameter - PENETRATION
    if radius <= 0.0:
        return None
    depth = float(cell.carried[2, 3]) if cell.arrangement.carries_part else PLATFORM_DEPTH
    below = max(depth, 2.0 * PENETRATION)
    plate = Cylinder(np.array([0.0, 0.0, -below]), np.array([0.0, 0.0, -PENETRATION]), radius)
    return of_cylinder(plate, 0.0)


def _core(cylinder: Cylinder) -> Cylinder:
    return dataclasses.replace(cylinder, radius=CORE * cylinder.radius)


def _pairs(
    contact: ArmContact,
    link: Index,
    what: Index,
    rows: Index,
    cores: bool,
    known: Sequence[bool],
) -> list[Collision]:
    """A collision for each pair of link and thing in `rows`; with `cores` the sure ones alone."""
    found = []
    for one, other in sorted(
        {pair for pair in zip(link.tolist(), what.tolist()) if pair[0] != NONE}
    ):
        sure = cores and _is_sure(contact, one, other, known)
        if sure or not cores:
            here = rows[(link == one) & (what == other)]
            found.append(Collision(contact.links[one], contact.names[other], here, sure))
    return found


def _is_sure(contact: ArmContact, link: int, what: int, known: Sequence[bool]) -> bool:
    """Whether a core that is in something tells that the link is. Part, torch and what stands beside the robot are known by
    cylinders about them alone; nozzles by themselves."""
    axes, groups = contact.cell.robot.chain.axes, len(contact.groups)
    if link > axes:
        return link == axes + NOZZLE_AFTER
    certain = link >= CERTAIN or (link < len(known) and known[link])
    other = what - groups
    return certain and (what < groups or other >= CERTAIN or (other < len(known) and known[other]))
