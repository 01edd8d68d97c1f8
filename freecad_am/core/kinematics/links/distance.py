# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distance of the links of a robot, and of a part that it carries, from everything they may
meet.
"""

from __future__ import annotations

import numpy as np

from ...geometry import frames
from ...types import Array, ArrayLike, Index
from .contact import ArmContact, Group
from .nozzle_body import NOZZLE
from .rounds import NONE, Solid

FIRST_ROWS = 8  # joint vectors tested first: their result excludes most of the others


def min_distance(contact: ArmContact, joints: ArrayLike, moment: Index, reach: float) -> float:
    """Return the smallest distance, mm, between links, or a carried part, and the objects tested
    against them.

    With joints (k, axes); a lower bound, at most `reach`, and 0 on contact, including own
    links. NaN joints do not count. moment: (k,) number of points of the deposit present. The
    nozzle, which deposits next to bodies, does not count; the contact's own clearance is
    subtracted.
    """
    values = np.asarray(joints, float)
    finite = np.isfinite(values).all(axis=1)
    values, when = values[finite], moment[finite]
    if not len(values):
        return reach
    links, seen_from = contact.link_frames(values)
    if (contact.own_links.touches(links)[0] != NONE).any():
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
        for rows in (order[:FIRST_ROWS], order[FIRST_ROWS:]):
            nearer = rows[bounds[k][rows] < best]
            if len(nearer):
                link_frame = (
                    frames.inverse(seen_from[group.seen_from][nearer]) @ links[nearer, number]
                )
                best = min(best, _distance(group, solid, link_frame, when[nearer], best))
    return best


def _bound(group: Group, solid: Solid, frame: Array, link: Array) -> Array:
    """Return lower bounds (k,) mm of the distance of a solid of a link, with frames `link` (k,
    4, 4), from a group.

    Computed from balls around both.
    """
    centre = frame[:, :3, :3] @ group.centre + frame[:, :3, 3]
    offset = link[:, :3, :3] @ solid.centre + link[:, :3, 3] - centre
    return np.asarray(np.linalg.norm(offset, axis=1) - solid.radius - group.radius)


def _distance(group: Group, solid: Solid, link_frame: Array, moment: Index, reach: float) -> float:
    """Return the smallest distance, mm, of a solid whose link has the frames (k, 4, 4)."""
    turn = link_frame[:, :3, :3]
    tip, axis = turn @ solid.tip + link_frame[:, :3, 3], turn @ solid.axis
    return float(group.scene.distance(solid.solid, tip, axis, moment, reach).min())
