# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the links of a robot, and a part that it carries, stay from all that they may meet."""

from __future__ import annotations

import numpy as np

from ...geometry import frames
from ...types import Array, ArrayLike, Index
from .contact import ArmContact, Group
from .nozzle_body import NOZZLE
from .rounds import NONE, Solid

FIRST = 8  # joint vectors looked at before the others: what is known of these leaves most of the rest out


def least_distance(contact: ArmContact, joints: ArrayLike, moment: Index, reach: float) -> float:
    """mm between links, or a part that is carried, and the nearest of what they are looked at against, the least with joints
    (k, axes): no more than it is, at most `reach`, and 0 where they touch, each other too. Joints that are NaN do not count.

    moment: (k,) how many points of the deposit are there. The nozzle, which deposits next to bodies, does not count; the
    contact's own clearance is taken off.
    """
    values = np.asarray(joints, float)
    known = np.isfinite(values).all(axis=1)
    values, when = values[known], moment[known]
    if not len(values):
        return reach
    links, seen_from = contact.seen(values)
    if (contact.own.touches(links)[0] != NONE).any():
        return 0.0
    best, nozzle = reach, contact.links.index(NOZZLE)
    pairs = [
        (group, number, solid)
        for group in contact.groups
        for number in group.links
        if number != nozzle
        for solid in contact.solids[number]
    ]
    bounds = [
        _bound(group, solid, seen_from[group.seen_from], links[:, number])
        for group, number, solid in pairs
    ]
    for k in np.argsort([bound.min() for bound in bounds], kind="stable"):
        group, number, solid = pairs[k]
        order = np.argsort(bounds[k], kind="stable")
        for rows in (order[:FIRST], order[FIRST:]):
            near = rows[bounds[k][rows] < best]
            if len(near):
                seen = frames.inverse(seen_from[group.seen_from][near]) @ links[near, number]
                best = min(best, _distance(group, solid, seen, when[near], best))
    return best


def _bound(group: Group, solid: Solid, frame: Array, link: Array) -> Array:
    """(k,) mm, no more than how far a solid of a link, whose frame is `link` (k, 4, 4), is from a group: by balls about
    both."""
    centre = frame[:, :3, :3] @ group.centre + frame[:, :3, 3]
    away = link[:, :3, :3] @ solid.centre + link[:, :3, 3] - centre
    return np.asarray(np.linalg.norm(away, axis=1) - solid.radius - group.radius)


def _distance(group: Group, solid: Solid, seen: Array, moment: Index, reach: float) -> float:
    """mm, the least of those of a solid, the frame of whose link is seen as (k, 4, 4)."""
    turn = seen[:, :3, :3]
    tip, axis = turn @ solid.tip + seen[:, :3, 3], turn @ solid.axis
    return float(group.scene.distance(solid.solid, tip, axis, moment, reach).min())
