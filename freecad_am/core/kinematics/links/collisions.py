# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions of the arm, and of the platform, with what stands in the cell, whether or not planning kept clearances.

As links are drawn, less `PENETRATION`, they tell what comes near. Links that no manufacturer's shape is known of are drawn
from the kinematics alone, and the cylinders about a true shape are wider than it is; so an error needs the core of a link,
`CORE` of its radius, in something. The core lies about the line that a link has to follow: from the elbow on, where axes
meet at angles; before it, links of parallel axes may stand aside of it. A forearm that is hollow, forked or bent aside is
not along all of that line: of 186 robots built in, the maker's range of the wrist lets the flanges of 13 pass through the line
itself, those of 19 through a third of what is drawn about it, those of 23, the default robot's among them, through half.
Where the flange passes through the core, the core proves nothing. What is in the inner half of a link, `DEEP`, may be in the link.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.bodies import build_bodies
from ...collision.cylinders_apart import nearer
from ...collision.obstacles import Obstacles
from ...collision.scene import Scene
from ...geometry import frames
from ...geometry.cylinders import Cylinder
from ...geometry.obstacles import Body
from ...types import Array, Index
from ..cell import Cell
from ..machines.machine import MAKER, Machine
from .contact import PLATFORM, ArmContact, Touches
from .own import placed
from .robot import flange_radius
from .rounds import NONE, Solid, of_cylinder

PENETRATION = 0.5  # mm; faces are triangles, and what is no deeper rests on one another
CORE = 1.0 / 3.0  # of the radius of a link
DEEP = 0.5  # of the radius of a link
CERTAIN = 4  # the first link from the elbow on, which runs along the line drawn of it
PLATFORM_DEPTH = 5.0  # mm below its plane that a platform which stands is made of, at the least
FACE = 0.1  # mm, how thick the face of a flange is
WRIST_STEP = np.radians(2.0)  # of the positions at which a flange is looked at against the forearm
NOZZLE_AFTER = 2  # the number of the nozzle in `ArmContact.links`, after the axes

Cylinders = Sequence[Sequence[Cylinder]]


@dataclass(frozen=True)
class Collision:
    """A link, or the platform, in something. rows: (n,) the joint vectors at which, rising, empty of the platform, which is in
    it all the time. sure: whether the core of the link is in it, and the link surely is where its core is; deep: whether the
    inner half of what is drawn of the link is."""

    link: str
    what: str
    rows: Index
    sure: bool
    deep: bool


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
    drawn = _contact(cell, cylinders, bodies, deposit, 1.0)
    near = drawn.touches(joints, moment)
    rows = np.flatnonzero(near.any)
    if not len(rows):
        return []
    contact = _contact(cell, cylinders, bodies, deposit, CORE)
    core = contact.touches(joints[rows], moment[rows])
    proofs = [_proves(contact, number, known) for number in range(len(contact.links))]
    found = [
        Collision(contact.links[link], contact.names[what], here, True, True)
        for link, what, here in _pairs(core, rows)
        if proofs[link] and _is_known(contact, what, proofs)
    ]
    if not found:
        inner = _contact(cell, cylinders, bodies, deposit, DEEP).touches(joints[rows], moment[rows])
        deep = {(link, what): here for link, what, here in _pairs(inner, rows)}
        found = [
            Collision(
                drawn.links[link],
                drawn.names[what],
                deep.get((link, what), here),
                False,
                (link, what) in deep,
            )
            for link, what, here in _pairs(Touches(near.link[rows], near.what[rows]), rows)
        ]
    return sorted(found, key=lambda one: (not one.deep, -len(one.rows), one.link, one.what))


def platform_collisions(cell: Cell, bodies: Sequence[Body]) -> list[Collision]:
    """The bodies that reach into the platform: the plate below its plane, down to the flange where a robot carries it. What is
    deposited below it is rejected before beads are planned."""
    plate = plate_of(cell)
    if plate is None:
        return []
    tip, axis = (
        frames.transform_point(cell.mount[None], plate.tip),
        frames.rotate_vector(cell.mount[None], plate.axis),
    )
    return [
        Collision(PLATFORM, body.name, np.zeros(0, dtype=np.intp), True, True)
        for body in bodies
        if len(body.triangles)
        and Scene(build_bodies([body], body.vertices, 0.0)).touched(plate.solid, tip, axis).any()
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


def _contact(
    cell: Cell,
    cylinders: Cylinders,
    bodies: Sequence[Body],
    deposit: Obstacles | None,
    share: float,
) -> ArmContact:
    """What the links touch, of a share of their radius."""
    inner = [[_inner(one, share) for one in link] for link in cylinders]
    return ArmContact(cell, inner, bodies, deposit, -PENETRATION, holders=True)


def _inner(cylinder: Cylinder, share: float) -> Cylinder:
    return dataclasses.replace(cylinder, radius=share * cylinder.radius)


def _pairs(touches: Touches, rows: Index) -> list[tuple[int, int, Index]]:
    """Each pair of link and thing that touch, by their numbers, with those of the rows at which they do."""
    link, what = touches.link, touches.what
    pairs = sorted({pair for pair in zip(link.tolist(), what.tolist()) if pair[0] != NONE})
    return [(one, other, rows[(link == one) & (what == other)]) for one, other in pairs]


def _proves(contact: ArmContact, link: int, known: Sequence[bool]) -> bool:
    """Whether a core that is in something tells that the link is. Part, torch and what stands beside the robot are known by
    cylinders about them alone; nozzles by themselves."""
    axes = contact.cell.robot.chain.axes
    if link > axes:
        return link == axes + NOZZLE_AFTER
    if link < CERTAIN and not (link < len(known) and known[link]):
        return False
    return link != axes - 2 or not flange_passes(contact.cell.robot, contact.solids[link])


def _is_known(contact: ArmContact, what: int, proofs: Sequence[bool]) -> bool:
    """Whether a thing that is touched is where it is looked at: links of the robot where their cores are proofs."""
    other = what - len(contact.groups)
    return other < 0 or proofs[other]


def flange_passes(robot: Machine, forearm: Sequence[Solid]) -> bool:
    """Whether the maker's range of the last axis but one lets the face of the flange pass through the link before that axis,
    as these solids in its frame show it."""
    chain, wrist = robot.chain, robot.chain.axes - 2
    limits = robot.limit_sets.get(MAKER, next(iter(robot.limit_sets.values())))
    low, high = limits.lower[wrist], limits.upper[wrist]
    low, high = (low, high) if np.isfinite(high - low) else (-np.pi, np.pi)
    joints = np.zeros((2 + int((high - low) / WRIST_STEP), chain.axes))
    joints[:, wrist] = np.linspace(low, high, len(joints))
    links = chain.links(joints)
    point, out = chain.flange[:3, 3], chain.flange[:3, 2]
    disc = of_cylinder(Cylinder(point - FACE * out, point, flange_radius(chain)), 0.0)
    face = placed(disc, links[:, -1])
    return any(bool(nearer(face, placed(one, links[:, wrist]), FACE).any()) for one in forearm)
