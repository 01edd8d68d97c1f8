# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes of machines with rotary axes: table, cradle and bearings, head and torch, from the chain
only.

The chain is seen from the torch: head axes, linear axes, table axes. No machine file states which
side the linear axes really carry; the drawing shows fixed table bearings and a moving torch.
"""

from __future__ import annotations

import numpy as np

from ..geometry import frames
from ..kinematics.chain import Chain
from ..kinematics.links.solids import BRIGHT, DARK, Solid, box, capsule, cylinder
from ..types import Array

# mm: radius of the table where nothing lies on it, and of the head's joints
RADIUS = 130.0
JOINT = 42.0


def standing_link(chain: Chain) -> int:
    """The link that stands still: the base, or the one after the last axis that slides."""
    slides = np.flatnonzero(chain.sliding)
    return int(slides[-1]) + 1 if len(slides) else 0


def solids(chain: Chain, radius: float = RADIUS, torch: float = 60.0) -> list[list[Solid]]:
    """The solids of each link (axes + 1), the torch's first, in the frame of the link.

    radius: of the table, mm. torch: mm from the tip of the nozzle to where the head begins.
    """
    solids_of_links: list[list[Solid]] = [[] for _ in range(chain.axes + 1)]
    first_slide, stands = int(np.flatnonzero(chain.sliding)[0]), standing_link(chain)
    at_zero = chain.frames(np.zeros(chain.axes))
    _head(at_zero.directions[:first_slide], at_zero.origins[:first_slide], torch, solids_of_links)
    _table(
        at_zero.directions[stands:],
        at_zero.origins[stands:],
        at_zero.flange,
        radius,
        solids_of_links[stands:],
    )
    back = frames.inverse(chain.links(np.zeros(chain.axes)))
    return [[solid.move(pose) for solid in link] for pose, link in zip(back, solids_of_links)]


def _head(
    directions: Array, origins: Array, torch: float, solids_by_link: list[list[Solid]]
) -> None:
    """The torch's body up to its pivot, a drum for each head axis, and the ram above."""
    up = np.array([0.0, 0.0, 1.0])
    joint_position = torch * up
    solids_by_link[0].append(cylinder(0.8 * joint_position, joint_position, 0.5 * JOINT, DARK))
    for axis, (direction, origin) in enumerate(zip(directions, origins)):
        pivot = origin + ((joint_position - origin) @ direction) * direction  # where it is nearest
        if np.linalg.norm(pivot - joint_position) > 1.0:
            solids_by_link[axis].append(capsule(joint_position, pivot, 0.6 * JOINT, 0.8 * JOINT))
        half = JOINT * direction
        solids_by_link[axis].append(cylinder(pivot - half, pivot + half, 0.9 * JOINT))
        solids_by_link[axis + 1].append(
            cylinder(pivot - 1.15 * half, pivot + 1.15 * half, 0.65 * JOINT, DARK)
        )
        joint_position = pivot
    ram = solids_by_link[len(directions)]
    ram.append(cylinder(joint_position, joint_position + 1.6 * JOINT * up, 0.85 * JOINT))
    x, y = np.eye(3)[:2]
    ram.append(
        box(joint_position + 5.5 * JOINT * up, x, y, (2.2 * JOINT, 2.2 * JOINT, 8.0 * JOINT))
    )


def _table(
    directions: Array,
    origins: Array,
    flange: Array,
    radius: float,
    solids_by_link: list[list[Solid]],
) -> None:
    """The table's disc, and what carries it: bearings of its last axis, the cradle of one before."""
    face, up = flange[:3, 3], flange[:3, 2]
    thick = 0.16 * radius
    solids_by_link[-1].append(cylinder(face - thick * up, face - 0.2 * up, radius, BRIGHT, 0.03))
    solids_by_link[-1].append(
        cylinder(face - 1.7 * thick * up, face - thick * up, 0.55 * radius, DARK)
    )
    below, carried = face - 1.7 * thick * up, len(directions)
    if carried >= 2:
        below = _cradle(directions[-2], origins[-2], below, up, radius, solids_by_link)
    floor, stands = below - 0.5 * radius * up, solids_by_link[0]
    side = np.eye(3)[int(np.argmin(np.abs(up)))]
    x = np.cross(side, up) / np.linalg.norm(np.cross(side, up))
    if carried < 2:
        stands.append(cylinder(floor, below, 0.62 * radius))
    stands.append(
        box(
            floor - 0.1 * radius * up,
            x,
            np.cross(up, x),
            (2.9 * radius, 2.9 * radius, 0.2 * radius),
            DARK,
        )
    )


def _cradle(
    direction: Array,
    origin: Array,
    below: Array,
    up: Array,
    radius: float,
    solids_by_link: list[list[Solid]],
) -> Array:
    """The cradle that turns about `direction` and its two bearings; the lowest point of what turns."""
    axis = origin + ((below - origin) @ direction) * direction
    across = np.cross(up, direction)
    reach = 1.22 * radius
    cradle, stands = solids_by_link[-2], solids_by_link[0]
    bottom = below - 0.14 * radius * up
    cradle.append(
        box(0.5 * (bottom + below), direction, across, (2.0 * reach, 1.1 * radius, 0.14 * radius))
    )
    depth = float((axis - bottom) @ up)
    lowest = axis - (np.hypot(1.05 * radius, max(abs(depth), 0.3 * radius)) + 0.1 * radius) * up
    for sign in (-1.0, 1.0):
        end = axis + sign * reach * direction
        height = abs(depth) + 0.28 * radius
        middle = (
            bottom
            + sign * reach * direction
            + 0.5 * (height - 0.28 * radius) * np.sign(depth or 1.0) * up
        )
        cradle.append(box(middle, direction, across, (0.14 * radius, 0.55 * radius, height)))
        cradle.append(cylinder(end, end + sign * 0.3 * radius * direction, 0.16 * radius, DARK))
        outside = end + sign * 0.22 * radius * direction
        stands.append(cylinder(outside, outside + sign * 0.22 * radius * direction, 0.34 * radius))
        tall = float((axis - lowest) @ up) + 0.5 * radius
        stands.append(
            box(
                outside + sign * 0.11 * radius * direction - 0.5 * tall * up,
                direction,
                across,
                (0.22 * radius, 0.6 * radius, tall),
            )
        )
    return np.asarray(lowest)
