# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions of arm and platform with objects in the cell, with or without planned clearances.

Links as drawn, reduced by `PENETRATION`, show which objects are near. Links without a
manufacturer's shape are drawn from the kinematics only, and the cylinders around a true shape are
wider than the shape. An error therefore requires the core of a link, `CORE` of its radius, to be
inside an object. The core follows the line that the link must follow. This holds from the elbow on,
where axes meet at angles; links of parallel axes before the elbow may be beside their line. A
hollow, forked or bent forearm does not follow all of its line. The manufacturer's wrist range lets
the flange pass through the line itself on 13 of 186 built-in robots, through a third of the drawn
width on 19, and through half of this width on 23, including the default robot. If the flange passes
through the core, the core proves nothing. An object in the inner half of a link, `DEEP`, may be
inside the link.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.obstacles import Obstacles
from ...collision.scene import Scene, build_bodies
from ...collision.separation import nearer
from ...geometry import frames
from ...geometry.cylinders import Cylinder
from ...geometry.obstacles import Body
from ...types import Array, Index
from ..cell import Cell
from ..machines.machine import MAKER, Machine
from .contact import PLATFORM, ArmContact, Touches
from .robot import flange_radius
from .self_collision import NONE, Solid, place_cylinder, round_solid

PENETRATION = 0.5  # mm; shallower overlap of triangulated faces is contact, not collision
CORE = 1.0 / 3.0  # fraction of the link radius
DEEP = 0.5  # fraction of the link radius
CERTAIN = 4  # first link that follows its drawn line, from the elbow on
PLATFORM_DEPTH = 5.0  # mm; minimum thickness of a fixed platform
FACE = 0.1  # mm; thickness of a flange face
WRIST_STEP = np.radians(
    2.0
)  # step of the wrist positions at which the flange is tested against the forearm
NOZZLE_AFTER = 2  # index of the nozzle in `ArmContact.links`, relative to the last axis

Cylinders = Sequence[Sequence[Cylinder]]


@dataclass(frozen=True)
class Collision:
    """A link, or the platform, inside an object.

    rows: (n,) joint vectors of the collision, ascending; empty for the platform, which is always
    inside. sure: whether the core of the link is inside and surely belongs to the link. deep:
    whether the inner half of the drawn link is inside.
    """

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
    true_shapes: Sequence[bool] = (),
) -> list[Collision]:
    """Return the objects that the links of the arm penetrate.

    Parameters
    ----------
    cell : Cell
        The cell.
    cylinders : Cylinders
        Cylinders of each link, base first.
    bodies : sequence of Body
        Bodies in part coordinates.
    deposit : Obstacles or None
        Deposit in part coordinates; None without a deposit.
    joints : (k, axes) array
        Joints, rad or mm.
    moment : (k,) int array
        Number of deposit points printed.
    true_shapes : sequence of bool, optional
        Whether the exact shape of each link is known; False by default.

    Returns
    -------
    list of Collision
        One entry per link and object: the certain collisions, or the doubtful ones if there are
        none; deep collisions first.
    """
    drawn = _contact(cell, cylinders, bodies, deposit, 1.0)
    touching = drawn.touches(joints, moment)
    rows = np.flatnonzero(touching.any)
    if not len(rows):
        return []
    contact = _contact(cell, cylinders, bodies, deposit, CORE)
    core = contact.touches(joints[rows], moment[rows])
    proofs = [_is_proof(contact, number, true_shapes) for number in range(len(contact.links))]
    collisions = [
        Collision(contact.links[link], contact.names[what], hit_rows, True, True)
        for link, what, hit_rows in _pairs(core, rows)
        if proofs[link] and _is_known(contact, what, proofs)
    ]
    if not collisions:
        inner = _contact(cell, cylinders, bodies, deposit, DEEP).touches(joints[rows], moment[rows])
        deep = {(link, what): hit_rows for link, what, hit_rows in _pairs(inner, rows)}
        collisions = [
            Collision(
                drawn.links[link],
                drawn.names[what],
                deep.get((link, what), hit_rows),
                False,
                (link, what) in deep,
            )
            for link, what, hit_rows in _pairs(
                Touches(touching.link[rows], touching.what[rows]), rows
            )
        ]
    return sorted(
        collisions,
        key=lambda collision: (
            not collision.deep,
            -len(collision.rows),
            collision.link,
            collision.what,
        ),
    )


def platform_collisions(cell: Cell, bodies: Sequence[Body]) -> list[Collision]:
    """Return the bodies that extend into the platform.

    The platform is the plate below its plane, down to the flange if a robot carries it. Deposit
    below the plane is rejected before beads are planned.
    """
    plate = plate_of(cell)
    if plate is None:
        return []
    tip = frames.transform_point(cell.poses.mount[None], plate.tip)
    axis = frames.rotate_vector(cell.poses.mount[None], plate.axis)
    return [
        Collision(PLATFORM, body.name, np.zeros(0, dtype=np.intp), True, True)
        for body in bodies
        if len(body.triangles)
        and Scene(build_bodies([body], body.vertices, 0.0))
        .find_touching(plate.solid, tip, axis)
        .any()
    ]


def plate_of(cell: Cell) -> Solid | None:
    """Return the platform in its own frame, reduced by the allowed penetration.

    None if there is no platform.
    """
    radius = 0.5 * cell.platform_diameter - PENETRATION
    if radius <= 0.0:
        return None
    depth = float(cell.poses.carried[2, 3]) if cell.arrangement.carries_part else PLATFORM_DEPTH
    below = max(depth, 2.0 * PENETRATION)
    plate = Cylinder(np.array([0.0, 0.0, -below]), np.array([0.0, 0.0, -PENETRATION]), radius)
    return round_solid(plate, 0.0)


def _contact(
    cell: Cell,
    cylinders: Cylinders,
    bodies: Sequence[Body],
    deposit: Obstacles | None,
    share: float,
) -> ArmContact:
    """Return the contact test for links with a fraction of their radius."""
    inner = [[_inner(cylinder, share) for cylinder in link] for link in cylinders]
    return ArmContact(cell, inner, bodies, deposit, -PENETRATION, holders=True)


def _inner(cylinder: Cylinder, share: float) -> Cylinder:
    return dataclasses.replace(cylinder, radius=share * cylinder.radius)


def _pairs(touches: Touches, rows: Index) -> list[tuple[int, int, Index]]:
    """Return each touching pair as link index, object index and the rows of contact."""
    link, what = touches.link, touches.what
    pairs = sorted({pair for pair in zip(link.tolist(), what.tolist()) if pair[0] != NONE})
    return [
        (link_number, object_number, rows[(link == link_number) & (what == object_number)])
        for link_number, object_number in pairs
    ]


def _is_proof(contact: ArmContact, link: int, true_shapes: Sequence[bool]) -> bool:
    """Whether a core inside an object proves that its link is inside.

    Part, torch and external links are known only by enclosing cylinders; nozzles are known exactly.
    """
    axes = contact.cell.robot.chain.axes
    if link > axes:
        return link == axes + NOZZLE_AFTER
    if link < CERTAIN and not (link < len(true_shapes) and true_shapes[link]):
        return False
    return link != axes - 2 or not flange_passes(contact.cell.robot, contact.solids[link])


def _is_known(contact: ArmContact, what: int, proofs: Sequence[bool]) -> bool:
    """Whether a touched object is certainly where it is modelled.

    A robot link is, if its core is a proof.
    """
    link_number = what - len(contact.groups)
    return link_number < 0 or proofs[link_number]


def flange_passes(robot: Machine, forearm: Sequence[Solid]) -> bool:
    """Whether the flange face can pass through the link before the last axis but one, within the
    manufacturer's range of this axis.

    forearm: solids of that link in its frame.
    """
    chain, wrist = robot.chain, robot.chain.axes - 2
    limits = robot.limit_sets.get(MAKER, next(iter(robot.limit_sets.values())))
    low, high = limits.lower[wrist], limits.upper[wrist]
    low, high = (low, high) if np.isfinite(high - low) else (-np.pi, np.pi)
    joints = np.zeros((2 + int((high - low) / WRIST_STEP), chain.axes))
    joints[:, wrist] = np.linspace(low, high, len(joints))
    links = chain.links(joints)
    point, out = chain.flange[:3, 3], chain.flange[:3, 2]
    disc = round_solid(Cylinder(point - FACE * out, point, flange_radius(chain)), 0.0)
    face = place_cylinder(disc, links[:, -1])
    return any(
        bool(nearer(face, place_cylinder(solid, links[:, wrist]), FACE).any()) for solid in forearm
    )
