# SPDX-License-Identifier: LGPL-2.1-or-later
"""Robot links drawn from the kinematic chain only, as plain solids along its axes.

The run of an axis lies between the common perpendiculars with the previous and the next axis. Long
runs become tubes, such as column and forearm. Axes without a run become drums, such as shoulder and
elbow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry import frames
from ...types import Array
from ..chain import Chain
from .solids import BRIGHT, DARK, Solid, capsule, cylinder, revolve, strut

# radii of the first and last joint as fractions of the arm length, with a taper between; THIN makes
# the flanges of robots from 0.7 to 3 m about as wide as ISO 9409-1 plates (40 to 125 mm)
THICK, THIN = 0.068, 0.016
FLANGE = 1.045  # radius of the flange, relative to the last joint
# half the length of a drum, relative to its radius
DRUM = 0.85
# fraction of the arm length below which a run is ignored
LEAST_SHARE = 0.03
# fraction of a run that belongs to the previous link
STILL = 0.45
_NONE = 1e-6  # fraction of the arm length below which a link is not drawn
# rad; tolerance for parallel axes
_PARALLEL = 1e-6


@dataclass(frozen=True, eq=False)
class Skeleton:
    """The axes of a chain at zero, in base_link, mm.

    directions: (axes, 3) unit vectors. enter: (axes, 3) points where the previous link meets each
    axis. leave: (axes, 3) points where the link of each axis leaves it. flange: (3,) flange point.
    size: total length of the arm.
    """

    directions: Array
    enter: Array
    leave: Array
    flange: Array
    size: float

    def radius(self, axis: int) -> float:
        """Return the joint radius of an axis, mm."""
        share = axis / max(1, len(self.directions) - 1)
        return float(self.size * THICK * (THIN / THICK) ** share)

    def run(self, axis: int) -> float:
        """Return the length of the run along an axis, mm.

        A short run counts as 0, except for the last one, which ends at the flange.
        """
        length = float(np.linalg.norm(self.leave[axis] - self.enter[axis]))
        short = LEAST_SHARE if axis + 1 < len(self.directions) else _NONE
        return length if length > short * self.size else 0.0


def skeleton(chain: Chain) -> Skeleton:
    """Return the skeleton of a chain of revolute joints."""
    at_zero = chain.frames(np.zeros(chain.axes))
    directions, origins, flange = at_zero.directions, at_zero.origins, at_zero.flange[:3, 3]
    enter, leave = np.empty((chain.axes, 3)), np.empty((chain.axes, 3))
    enter[0] = _project_onto_axis(np.zeros(3), origins[0], directions[0])
    for axis in range(chain.axes - 1):
        leave[axis], enter[axis + 1] = _feet(
            origins[axis], directions[axis], origins[axis + 1], directions[axis + 1], enter[axis]
        )
    leave[-1] = _project_onto_axis(flange, origins[-1], directions[-1])
    runs = (
        np.linalg.norm(leave - enter, axis=1).sum()
        + np.linalg.norm(enter[1:] - leave[:-1], axis=1).sum()
    )
    return Skeleton(directions, enter, leave, flange, float(max(runs, 1.0)))


def solids(chain: Chain) -> list[list[Solid]]:
    """Return the solids of each link (axes + 1), base first.

    They are given in the link frames, which move with the joints.
    """
    bones = skeleton(chain)
    solids_of_links: list[list[Solid]] = [[] for _ in range(chain.axes + 1)]
    _base(bones, solids_of_links[0])
    for axis in range(chain.axes):
        _joint(bones, axis, solids_of_links[axis], solids_of_links[axis + 1])
        if axis + 1 < chain.axes:
            _between(bones, axis, solids_of_links[axis + 1])
    _flange(bones, solids_of_links[-1])
    back = frames.inverse(chain.links(np.zeros(chain.axes)))
    return [[solid.move(pose) for solid in link] for pose, link in zip(back, solids_of_links)]


def _base(bones: Skeleton, base: list[Solid]) -> None:
    foot, radius = np.zeros(3), bones.radius(0)
    up = np.array([0.0, 0.0, 1.0])
    plate = 0.22 * radius
    base.append(cylinder(foot, foot + plate * up, 1.75 * radius, DARK, 0.05))
    if np.linalg.norm(bones.enter[0] - foot) > LEAST_SHARE * bones.size:
        base.append(capsule(foot, bones.enter[0], 1.2 * radius, radius))


def _joint(bones: Skeleton, axis: int, previous_link: list[Solid], link: list[Solid]) -> None:
    """Add the joint of an axis: its housing to the previous link, its rotor to the axis's link."""
    start, direction, radius = bones.enter[axis], bones.directions[axis], bones.radius(axis)
    run = bones.run(axis)
    if not run and axis + 1 == len(bones.directions):
        return
    if not run:
        half = DRUM * radius * direction
        previous_link.append(cylinder(start - half, start + half, radius))
        link.append(cylinder(start - 1.14 * half, start + 1.14 * half, 0.72 * radius, DARK))
        return
    along = (bones.leave[axis] - start) / run
    middle, end = start + STILL * run * along, bones.leave[axis]
    slim = radius * (0.8 if axis else 1.0)
    end_radius = bones.radius(min(axis + 1, len(bones.directions) - 1)) if axis else slim
    # the housing of a forearm begins behind its elbow
    back = start - 0.9 * slim * along if axis and axis + 1 < len(bones.directions) else start
    previous_link.append(
        cylinder(back, middle, 1.08 * slim)
        if axis
        else revolve(
            [
                (0.0, 0.0),
                (1.45 * slim, 0.0),
                (1.45 * slim, 0.12),
                (1.12 * slim, 0.45),
                (1.12 * slim, 1.0),
                (0.0, 1.0),
            ],
            start,
            middle,
        )
    )
    seam = min(0.06 * run, 0.2 * slim)
    link.append(cylinder(middle, middle + seam * along, 0.98 * slim, DARK, 0.02))
    link.append(
        revolve(
            [(0.0, 0.0), (slim, 0.0), (0.92 * end_radius, 1.0), (0.0, 1.0)],
            middle + seam * along,
            end,
        )
    )


def _between(bones: Skeleton, axis: int, link: list[Solid]) -> None:
    """Add the link from an axis to the next one."""
    start, end = bones.leave[axis], bones.enter[axis + 1]
    start_radius, end_radius = bones.radius(axis), bones.radius(axis + 1)
    length = float(np.linalg.norm(end - start))
    if length < _NONE * bones.size:
        return
    if (
        np.linalg.norm(np.cross(bones.directions[axis], bones.directions[axis + 1])) < _PARALLEL
        and length > start_radius - end_radius
    ):
        link.append(
            strut(
                start,
                end,
                bones.directions[axis],
                0.9 * start_radius,
                0.9 * end_radius,
                1.1 * end_radius,
            )
        )
    else:
        link.append(
            capsule(start, end, 0.82 * min(start_radius, 1.3 * end_radius), 0.82 * end_radius)
        )


def _flange(bones: Skeleton, last_link: list[Solid]) -> None:
    radius = bones.radius(len(bones.directions) - 1)
    direction = (
        bones.directions[-1]
        if bones.run(len(bones.directions) - 1) == 0.0
        else (
            (bones.leave[-1] - bones.enter[-1]) / np.linalg.norm(bones.leave[-1] - bones.enter[-1])
        )
    )
    last_link.append(
        cylinder(
            bones.flange - 0.285 * radius * direction, bones.flange, FLANGE * radius, BRIGHT, 0.05
        )
    )


def flange_radius(chain: Chain) -> float:
    """Return the radius of the drawn flange, mm."""
    return FLANGE * skeleton(chain).radius(chain.axes - 1)


def _project_onto_axis(point: Array, origin: Array, direction: Array) -> Array:
    """Return the point of an axis nearest to a given point."""
    return np.asarray(origin + ((point - origin) @ direction) * direction)


def _feet(
    origin_a: Array, direction_a: Array, origin_b: Array, direction_b: Array, through: Array
) -> tuple[Array, Array]:
    """Return the feet of the common perpendicular of two axes.

    For parallel axes, use the perpendicular through the point `through`.
    """
    normal = np.cross(direction_a, direction_b)
    square = float(normal @ normal)
    if square < _PARALLEL**2:
        return through, _project_onto_axis(through, origin_b, direction_b)
    between = origin_b - origin_a
    s = float(np.cross(between, direction_b) @ normal) / square
    t = float(np.cross(between, direction_a) @ normal) / square
    return np.asarray(origin_a + s * direction_a), np.asarray(origin_b + t * direction_b)
