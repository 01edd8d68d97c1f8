# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes of machines with rotary axes: table, cradle, bearings, head and torch, from the chain only.

The chain starts at the torch: head axes, linear axes, table axes. Machine files do not state which
side the linear axes carry. The drawing shows fixed table bearings and a moving torch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..geometry import frames
from ..kinematics.cell import Cell
from ..kinematics.chain import Chain
from ..kinematics.inverse.five_axis import TURNING, FiveAxis
from ..kinematics.links.solids import BRIGHT, DARK, Solid, box, capsule, cylinder
from ..types import Array, ArrayLike, Index

MIN_HEIGHT_MM = 1e-3  # mm; minimum height of the drawn surface above the path


def heights(deposited: Array, position: Array, layer: Index) -> Array:
    """Return the height of the deposit's surface above points.

    Each point takes the height of the nearest piece in its layer.

    Parameters
    ----------
    deposited : (m, 5) array
        Position of each piece, mm, layer, and height of the surface above the piece, mm.
    position : (n, 3) array
        Points in the frame of the pieces, mm.
    layer : (n,) array of int
        Layers of the points.

    Returns
    -------
    (n,) array
        Heights, mm, at least MIN_HEIGHT_MM; NaN in layers without pieces.
    """
    surface_heights = np.full(len(position), np.nan)
    piece_layers = deposited[:, 3].astype(np.intp)
    for number in np.unique(layer).tolist():
        piece_rows = np.flatnonzero(piece_layers == number)
        point_rows = np.flatnonzero(layer == number)
        if len(piece_rows):
            nearest = np.asarray(cKDTree(deposited[piece_rows, :3]).query(position[point_rows])[1])
            surface_heights[point_rows] = np.maximum(
                deposited[piece_rows[nearest], 4], MIN_HEIGHT_MM
            )
    return surface_heights


# mm; radius of the table without a part, and of the head's joints
RADIUS = 130.0
JOINT = 42.0


def standing_link(chain: Chain) -> int:
    """Return the index of the fixed link: the link after the last prismatic axis, else the base."""
    slides = np.flatnonzero(chain.sliding)
    return int(slides[-1]) + 1 if len(slides) else 0


def solids(chain: Chain, radius: float = RADIUS, torch: float = 60.0) -> list[list[Solid]]:
    """Return the solids of each link, starting at the torch.

    Parameters
    ----------
    chain : Chain
        A chain with linear axes: head axes, linear axes, table axes.
    radius : float, optional
        Radius of the table, mm.
    torch : float, optional
        Distance from the nozzle tip to the head, mm.

    Returns
    -------
    list of list of Solid
        Solids of the axes + 1 links, mm, in the frame of each link.
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
    """Add the torch body up to its pivot, a drum for each head axis, and the ram above."""
    up = np.array([0.0, 0.0, 1.0])
    joint_position = torch * up
    solids_by_link[0].append(cylinder(0.8 * joint_position, joint_position, 0.5 * JOINT, DARK))
    for axis, (direction, origin) in enumerate(zip(directions, origins)):
        pivot = (
            origin + ((joint_position - origin) @ direction) * direction
        )  # nearest point on the axis
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
    """Add the table disc, the bearings of the last axis, and the cradle of a preceding axis."""
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
    """Add the cradle that rotates about `direction` and its two bearings.

    Returns the lowest point of the rotating solids.
    """
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


# number of tool rotations to try for a robot at rest
_ROTATIONS = 24


@dataclass(frozen=True, eq=False)
class Placing:
    """Poses in the world, mm.

    links: (axes + 1, 4, 4) robot links. part: (4, 4) part frame. nozzle: (4, 4) frame at the tip, Z
    pointing into the nozzle. platform: (4, 4) platform below the part. external_links: (k, 4, 4)
    known links of positioner and track.
    """

    links: Array
    part: Array
    nozzle: Array
    platform: Array
    external_links: Array


def placing(cell: Cell, joints: ArrayLike) -> Placing:
    """Return the poses of links, part and nozzle.

    Parameters
    ----------
    cell : Cell
        The cell.
    joints : (axes,) array_like
        Joint values, rad or mm.

    Returns
    -------
    Placing
        Poses in the world, mm. Without external axes the world frame is the fixed link.
    """
    chain, values = cell.robot.chain, np.asarray(joints, float)
    links = cell.links(values)
    flange = links[-1] @ chain.flange
    carried = flange @ cell.poses.carried
    on_robot = not cell.torch_stands
    platform = cell.poses.station if on_robot else carried
    nozzle = (
        carried @ frames.pose(frames.about_x(np.pi), np.zeros(3))
        if on_robot
        else cell.poses.station
    )
    stands = links[standing_link(chain)]
    if cell.external is not None:
        stands = cell.world(values[None])[0] @ frames.inverse(cell.robot.base)
    to_world = frames.inverse(stands)
    return Placing(
        links=to_world @ links,
        part=to_world @ platform @ frames.inverse(cell.poses.mount),
        nozzle=to_world @ nozzle,
        platform=to_world @ platform,
        external_links=to_world @ cell.external_link_frames(values[None])[0],
    )


def at_rest(cell: Cell, point: ArrayLike) -> Array:
    """Return joint values that place the nozzle on a part point, upright relative to the platform.

    Parameters
    ----------
    cell : Cell
        The cell.
    point : (3,) array_like
        The point in the part, mm.

    Returns
    -------
    (axes,) array
        Joint values, rad or mm. A robot takes the tool rotation and branch with the maximum margin
        to its limits, or 0 if the point is out of reach. The rotary axes of a five-axis machine are
        at 0.
    """
    target, chain = np.asarray(point, float), cell.machine.chain
    if not cell.machine.free:
        on_flange, _ = cell.poses.to_flange(target[None], cell.poses.mount[None, :3, 2])
        return np.asarray(
            FiveAxis(chain).place_points(np.zeros((1, TURNING)), on_flange, cell.poses.station)[0]
        )
    arm = cell.robot.arm
    assert arm is not None  # a cell has no other robots
    rotations = np.linspace(0.0, 2.0 * np.pi, _ROTATIONS, endpoint=False)
    external = np.zeros((_ROTATIONS, chain.axes))
    targets, axes = (
        np.tile(target, (_ROTATIONS, 1)),
        np.tile(cell.poses.mount[:3, 2], (_ROTATIONS, 1)),
    )
    flange = cell.flange_poses(targets, axes, rotations, external)
    branches = range(8) if cell.branch is None else (cell.branch,)
    solutions = np.concatenate([arm.inverse_branch(flange, branch) for branch in branches])
    solutions = np.arctan2(np.sin(solutions), np.cos(solutions))
    solutions = np.pad(solutions, ((0, 0), (0, chain.axes - solutions.shape[1])))
    margin = np.nan_to_num(cell.limits.smallest(solutions).margin, nan=-np.inf)
    best = int(np.argmax(margin))
    return np.asarray(solutions[best]) if np.isfinite(margin[best]) else np.zeros(chain.axes)
