# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions of the arm, and of the platform, with objects in the cell, whether or not
planning kept clearances.

Links as drawn, less `PENETRATION`, show near objects. Links without a manufacturer's
shape are drawn from the kinematics only, and the cylinders around a true shape are wider
than it; so an error needs the core of a link, `CORE` of its radius, inside an object. The
core follows the line that a link has to follow: from the elbow on, where axes meet at
angles; before it, links of parallel axes may be beside that line. A hollow, forked or
bent forearm does not follow all of that line: of 186 built-in robots, the manufacturer's
range of the wrist lets the flanges of 13 pass through the line itself, of 19 through a
third of the drawn width, of 23, including the default robot, through half. Where the
flange passes through the core, the core proves nothing. An object in the inner half of a
link, `DEEP`, may be in the link.
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

PENETRATION = 0.5  # mm; faces are triangles, and a shallower overlap is contact, not collision
CORE = 1.0 / 3.0  # share of the radius of a link
DEEP = 0.5  # share of the radius of a link
CERTAIN = 4  # the first link from the elbow on, which follows its drawn line
PLATFORM_DEPTH = 5.0  # minimum thickness of a fixed platform, mm
FACE = 0.1  # mm, thickness of the face of a flange
WRIST_STEP = np.radians(
    2.0
)  # step of the positions at which a flange is tested against the forearm
NOZZLE_AFTER = 2  # the number of the nozzle in `ArmContact.links`, after the axes

Cylinders = Sequence[Sequence[Cylinder]]


@dataclass(frozen=True)
class Collision:
    """A link, or the platform, inside an object.

    rows: (n,) the joint vectors of the collision, rising, empty for the platform, which is
    inside it all the time. sure: whether the core of the link is inside and the link surely
    is where its core is. deep: whether the inner half of the drawn link is inside.
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
        Cylinders for each link, base first.
    bodies : sequence of Body
        Bodies in part coordinates.
    deposit : Obstacles or None
        The deposit in part coordinates; None without one.
    joints : (k, axes) array
        Joints, rad or mm.
    moment : (k,) int array
        Number of points of the deposit present.
    true_shapes : sequence of bool, optional
        Whether the exact shape of each link is known; by default it is not.

    Returns
    -------
    list of Collision
        One entry for each link and object: certain collisions if there are
        any, else doubtful ones; deep collisions first.
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
    """Return the bodies that reach into the platform: the plate below its plane, down to the
    flange if a robot carries it.

    Deposit below the plane is rejected before beads are planned.
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
    """Return the platform in its own frame, reduced by the allowed penetration; None without
    one.
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
    """Return the contact test for links with a share of their radius."""
    inner = [[_inner(cylinder, share) for cylinder in link] for link in cylinders]
    return ArmContact(cell, inner, bodies, deposit, -PENETRATION, holders=True)


def _inner(cylinder: Cylinder, share: float) -> Cylinder:
    return dataclasses.replace(cylinder, radius=share * cylinder.radius)


def _pairs(touches: Touches, rows: Index) -> list[tuple[int, int, Index]]:
    """Return each pair of touching link and object, by their numbers, with the rows at which
    they touch.
    """
    link, what = touches.link, touches.what
    pairs = sorted({pair for pair in zip(link.tolist(), what.tolist()) if pair[0] != NONE})
    return [
        (link_number, object_number, rows[(link == link_number) & (what == object_number)])
        for link_number, object_number in pairs
    ]


def _is_proof(contact: ArmContact, link: int, true_shapes: Sequence[bool]) -> bool:
    """Return whether a core inside an object proves that the link is.

    Part, torch and external links are known only by cylinders around them; nozzles exactly.
    """
    axes = contact.cell.robot.chain.axes
    if link > axes:
        return link == axes + NOZZLE_AFTER
    if link < CERTAIN and not (link < len(true_shapes) and true_shapes[link]):
        return False
    return link != axes - 2 or not flange_passes(contact.cell.robot, contact.solids[link])


def _is_known(contact: ArmContact, what: int, proofs: Sequence[bool]) -> bool:
    """Return whether a touched object is certainly where it is modelled: links of the robot if
    their cores are proofs.
    """
    link_number = what - len(contact.groups)
    return link_number < 0 or proofs[link_number]


def flange_passes(robot: Machine, forearm: Sequence[Solid]) -> bool:
    """Return whether the manufacturer's range of the last axis but one lets the flange face pass
    through the link before it.

    forearm: the solids of that link in its frame.
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
