# SPDX-License-Identifier: LGPL-2.1-or-later
"""The platform under a wall of revolution, and whether the deposit is on it or reaches below it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.curves.profile import RevolvedWall
from ...geometry.formatting import place
from ...geometry.mesh.solid import divide_triangles
from ...geometry.on_hub import SolidsOnHub
from ...issues import WARNING, InputError, Issue, Text, Word
from ...types import Array, Mask

UPRIGHT = 1e-6  # rad between the axis of the wall and the normal of the platform
TOUCH = 1e-6  # mm
DEEP = 0.05  # mm; a depth below the platform that chords explain
MOVE = "move the part up in its file, or set cell.platform_diameter to what there is (0 for none)"
MOUNT = (
    "use mount: feature, which puts its lowest end on the platform, move the part up in its file, or set "
    "cell.platform_diameter to what there is (0 for none)"
)
GRAIN = 0.05  # of the radius of the platform, between the sampled points of solids


@dataclass(frozen=True)
class Platform:
    """A disc about the axis of the wall: radius mm, 0 without a platform, and height mm in the feature frame.

    off: mm from the axis to the middle of the true disc, which `radius` includes.
    """

    radius: float
    height: float = 0.0
    off: float = 0.0


def under(wall: RevolvedWall, diameter: float, frame: Array | None) -> Platform:
    """The platform as seen from the wall.

    diameter: mm, 0 for none. frame: (4, 4) pose of the platform in part coordinates; None when the feature frame sits on
    it. A disc whose middle is off the axis counts as a larger one about the axis, which is on the safe side. Raises
    InputError 'OFF_PLATFORM' when the axis of the wall misses the platform, or the wall starts below it.
    """
    centre, normal = np.zeros(3), np.array([0.0, 0.0, 1.0])
    if frame is not None:
        turn, offset = wall.frame[:3, :3].T, frame[:3, 3] - wall.frame[:3, 3]
        centre, normal = turn @ offset, turn @ frame[:3, 2]
    if diameter <= 0.0:
        return Platform(0.0)
    off, height, radius = float(np.hypot(centre[0], centre[1])), float(centre[2]), 0.5 * diameter
    if normal[2] < 0.0 or np.hypot(normal[0], normal[1]) > UPRIGHT:
        angle = np.degrees(np.arctan2(np.hypot(normal[0], normal[1]), normal[2]))
        raise _off_platform(
            Text("the axis of {} is {:.4g} deg off the normal of the platform", wall.label, angle),
            "use mount: feature",
        )
    if off > radius:
        raise _off_platform(
            Text(
                "the axis of {} is {:.4g} mm off the middle of the platform and misses it",
                wall.label,
                off,
            ),
            "use mount: feature, or move the part",
        )
    if height > TOUCH:
        raise _off_platform(
            Text("the base of {} is {:.4g} mm below the platform", wall.label, height),
            "use mount: feature, or move the part",
        )
    return Platform(radius + off, height, off)


def overhanging(wall: RevolvedWall, platform: Platform) -> list[Issue]:
    """A warning when the base of the wall reaches over the edge of the platform."""
    base, edge = float(wall.meridian.points[0, 0]), platform.radius - 2.0 * platform.off
    if platform.radius == 0.0 or base <= edge + TOUCH:
        return []
    mounted = (
        platform.off > 0.0 and base <= platform.radius - platform.off + TOUCH
    )  # its axis in the middle
    return [
        Issue(
            WARNING,
            "OVER_PLATFORM",
            Text(
                "the base of {} has a diameter of {:.4g} mm and exceeds the platform; {}check "
                "cell.platform_diameter (0 for none)",
                wall.label,
                2.0 * base,
                Word("use cell.mount: feature, move the part, or " if mounted else ""),
            ),
            0,
        )
    ]


def refuse_below(
    label: str, points: Array, frame: Array, diameter: float, remedy: str = MOVE
) -> None:
    """InputError OFF_PLATFORM for deposit points (n, 3) below the platform, a disc about the origin of a frame (4, 4) in part
    coordinates; diameter: mm, 0 for none. Outside the disc there is room below its plane.
    """
    local = (points - frame[:3, 3]) @ frame[:3, :3]
    depth = np.where(np.hypot(local[:, 0], local[:, 1]) < 0.5 * diameter, -local[:, 2], 0.0)
    if depth.max(initial=0.0) > DEEP:
        worst = int(depth.argmax())
        raise _off_platform(
            Text(
                "{} extends {:.4g} mm below the platform, at {}",
                label,
                depth[worst],
                place(points[worst]),
            ),
            remedy,
        )


def refuse_solids_below(solids: SolidsOnHub, frame: Array, diameter: float) -> None:
    """The same check for solids on a hub, outside of the surfaces under them."""

    def over(corners: Array) -> Mask:
        """Which triangles (n, 3, 3) may come over the disc, or below it."""
        flat = (corners - frame[:3, 3]) @ frame[:3, :2]
        middle = flat.mean(axis=1)
        reach = np.linalg.norm(flat - middle[:, None], axis=2).max(axis=1)
        return np.asarray(np.linalg.norm(middle, axis=1) - reach < 0.5 * diameter)

    for group in solids.groups:
        for body in group.bodies:
            corners = body.corners()
            low = ((corners - frame[:3, 3]) @ frame[:3, 2]).min(axis=1) < -DEEP
            middles, _ = divide_triangles(
                corners[low], max(GRAIN * 0.5 * diameter, 1.0), over
            )  # most of a large part is outside the disc
            points = np.vstack([corners[low].reshape(-1, 3), middles])
            outside = group.base.surface.distance(group.base.inside(points)) > DEEP
            refuse_below(body.name, points[outside], frame, diameter, MOUNT)


def _off_platform(what: str, remedy: str) -> InputError:
    mended_by = {"mount": "feature"} if remedy == MOUNT else None
    return InputError(
        "OFF_PLATFORM", "cell.platform_diameter", "{}; {}", what, remedy, mended_by=mended_by
    )
