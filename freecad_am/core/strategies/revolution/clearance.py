# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clearance of the nozzle from earlier deposit and from the platform, for parts of revolution.

Chalvin 2020, section 6.1, tilts the build directions near a closing top back by the nozzle's angle. Here, as on walls,
`core/collision` decides against beads with their width and height. A bead extends along its build direction, so a
tilt-back changes the obstacle for later beads.

A full circle looks the same from each of its points. An arc, seen from all its points, extends equally far to both sides.
One tip position therefore represents a whole bead.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ...collision import deposit
from ...collision.obstacles import Obstacles
from ...collision.scene import Bodies, Nozzle, Scene, build_bodies, depositing
from ...geometry.columns import columns
from ...geometry.curves.profile import RevolvedWall
from ...geometry.formatting import place
from ...geometry.mesh.solid import divide_triangles
from ...geometry.obstacles import disc
from ...geometry.on_hub import SolidsOnHub
from ...geometry.step_count import turn_segments
from ...issues import WARNING, InputError, Issue, Text, Word
from ...parameters.cell import NozzleParameters
from ...types import Array, Index, Mask

UPRIGHT = 1e-6  # rad; maximum angle between the wall axis and the platform normal
TOUCH = 1e-6  # mm
DEEP = 0.05  # mm; maximum depth below the platform that chords explain
MOVE = (
    "move the part up in its file, or set cell.platform_diameter to the real diameter (0 for none)"
)
MOUNT = "use mount: feature, which puts the lowest end of the part on the platform, move the part up in its file, or set cell.platform_diameter to the real diameter (0 for none)"
GRAIN = 0.05  # fraction of the platform radius; distance between sampled points of solids


@dataclass(frozen=True)
class Platform:
    """A disc about the axis of the wall: radius, mm, 0 without a platform, and height in the feature frame, mm.

    off: distance from the axis to the centre of the true disc, mm, included in `radius`.
    """

    radius: float
    height: float = 0.0
    off: float = 0.0


def under(wall: RevolvedWall, diameter: float, frame: Array | None) -> Platform:
    """Return the platform as seen from a wall of revolution.

    A disc whose centre is off the axis counts as a larger disc about the axis, which is
    conservative.

    Parameters
    ----------
    wall : RevolvedWall
        The wall.
    diameter : float
        Diameter of the platform, mm; 0 for none.
    frame : (4, 4) array or None
        Pose of the platform in part coordinates; None if the feature frame is on the platform.

    Returns
    -------
    Platform
        The platform in the feature frame.

    Raises
    ------
    InputError
        OFF_PLATFORM if the wall axis misses the platform or is not along its normal, or if the
        wall starts below the platform.
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
                "the axis of {} is {:.4g} mm off the middle of the platform and misses the "
                "platform",
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
    """Return a warning if the base of the wall overhangs the edge of the platform."""
    base, edge = float(wall.meridian.points[0, 0]), platform.radius - 2.0 * platform.off
    if platform.radius == 0.0 or base <= edge + TOUCH:
        return []
    mounted = (
        platform.off > 0.0 and base <= platform.radius - platform.off + TOUCH
    )  # would fit with the axis at the platform's centre
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
    """Reject deposit below the platform.

    Outside the disc, deposit may be below its plane.

    Parameters
    ----------
    label : str
        Name of the part.
    points : (n, 3) array
        Deposit points in part coordinates, mm.
    frame : (4, 4) array
        Pose of the platform in part coordinates.
    diameter : float
        Diameter of the platform, mm; 0 for none.
    remedy : str, optional
        Advice for the message.

    Raises
    ------
    InputError
        OFF_PLATFORM at the deepest point.
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
    """Reject solids on a hub that extend below the platform, outside their base surfaces.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids.
    frame : (4, 4) array
        Pose of the platform in part coordinates.
    diameter : float
        Diameter of the platform, mm; 0 for none.

    Raises
    ------
    InputError
        OFF_PLATFORM at the deepest point.
    """

    def over(corners: Array) -> Mask:
        """Return which triangles (n, 3, 3) may be above or below the disc."""
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


CHORD = 0.01  # mm; minimum chord error of the beads in the check
# mm; maximum nozzle movement that an incompletely converged direction may cause
CONVERGED = 0.01


@dataclass(frozen=True, eq=False)
class Deposit:
    """Points (k,) of all beads in print order, in the feature frame: radius and height, mm, azimuth, rad.

    build: (k, 3) requested build directions along radius, azimuth and axis. moment: (k,) time index at which the point
    is deposited. starts: (k,) whether a bead begins. case: (k,) index of the case whose tilt-back applies, fractional
    between two cases. size: width and height of the beads, mm.
    """

    radius: Array
    height: Array
    azimuth: Array
    build: Array
    moment: Index
    starts: Mask
    case: Array
    size: tuple[float, float]

    @property
    def points(self) -> Array:
        """Return the points in the feature frame.

        Returns
        -------
        (k, 3) array
            Points, mm.
        """
        return _place(self.radius, self.azimuth, self.height)


@dataclass(frozen=True, eq=False)
class Tips:
    """Tip positions of c cases: radius and height, mm, azimuth, rad, (c,).

    moment: (c,) time index before which deposit exists. own_moment: (c,) time index from which deposit belongs to the
    current layer.
    """

    radius: Array
    height: Array
    azimuth: Array
    moment: Index
    own_moment: Index

    def rows(self, index: Index) -> Tips:
        """Return the selected tips."""
        return Tips(*(getattr(self, entry.name)[index] for entry in dataclasses.fields(self)))


@dataclass(frozen=True)
class Clearance:
    """The nozzle, enlarged by the tolerance of the deposit, at tips above bodies.

    foot: tolerance about the current bead, mm.
    """

    tips: Tips
    deposit: Deposit
    nozzle: Nozzle
    foot: float
    bodies: Bodies
    between: Tips | None = None  # points of the deposit, if the tips do not represent them

    def standing(self, build: Array, like: Scene | None = None) -> Scene:
        """Return the scene with the deposit for given build directions.

        Parameters
        ----------
        build : (k, 3) array
            Build directions at the points of the deposit, along radius, azimuth and axis.
        like : Scene, optional
            A scene with other directions, whose order is reused.

        Returns
        -------
        Scene
            Bodies and deposit, mm.
        """
        deposit_ = self.deposit
        width, tall = deposit_.size
        directions = _in_space(build, deposit_.azimuth)
        beads = deposit.build_deposit(
            deposit_.points,
            directions,
            width,
            tall,
            deposit_.starts,
            deposit_.moment,
            foot=self.foot,
            like=like.deposit if like is not None and isinstance(like.deposit, Obstacles) else None,
        )
        return Scene(self.bodies, beads)

    def clear(self, among: Scene, case: Index, tool: Array) -> Mask:
        """Return whether the nozzle is clear.

        Parameters
        ----------
        among : Scene
            The scene with tilted beads.
        case : (n,) int array
            Indices of the cases.
        tool : (n, 3) array
            Tool axes along radius, azimuth and axis.

        Returns
        -------
        (n,) bool array
            True where clear.
        """
        return self._clear(among, self.tips, case, tool)

    def clear_between(self, among: Scene, tool: Array) -> Mask:
        """Return where the nozzle is clear at the points `between`.

        Parameters
        ----------
        among : Scene
            Bodies and deposit.
        tool : (k, 3) array
            Unit tool axes along radius, azimuth and axis.

        Returns
        -------
        (k,) array of bool
            True where clear.
        """
        assert self.between is not None
        return self._clear(among, self.between, np.arange(len(tool)), tool)

    def _clear(self, among: Scene, tips: Tips, rows: Index, tool: Array) -> Mask:
        azimuth = tips.azimuth[rows]
        tip = _place(tips.radius[rows], azimuth, tips.height[rows])
        return ~among.find_touching(
            self.nozzle, tip, _in_space(tool, azimuth), tips.moment[rows], tips.own_moment[rows]
        )


def nozzle_clearance(
    nozzle: NozzleParameters,
    lean: float,
    platform: Platform,
    tips: Tips,
    deposit: Deposit,
    chord_error: float,
    between: Tips | None = None,
) -> Clearance:
    """Build the clearance check of a nozzle against a platform and a deposit.

    Parameters
    ----------
    nozzle : NozzleParameters
        The nozzle.
    lean : float
        Angle between tool axis and build direction, rad.
    platform : Platform
        The platform.
    tips : Tips
        Tip positions, case by case.
    deposit : Deposit
        The deposit.
    chord_error : float
        Chord error of the deposit, mm.
    between : Tips or None, optional
        Points of the deposit, if the tips do not represent them; None otherwise.

    Returns
    -------
    Clearance
        The clearance check.
    """
    nozzle_ = depositing(
        0.5 * nozzle.diameter,
        float(np.tan(nozzle.half_angle)),
        nozzle.length,
        deposit.size[1],
        lean,
    )
    frame = np.eye(4)
    frame[2, 3] = platform.height
    plates = [disc(2.0 * platform.radius, frame)] if platform.radius > 0.0 else []
    bodies = build_bodies(plates, deposit.points, nozzle_.reach)
    return Clearance(
        tips, deposit, nozzle_.larger(chord_error + CONVERGED), nozzle_.foot, bodies, between
    )


def arc_points(
    radius: Array, turn: float, chord_error: float, min_points: int, one_side: bool
) -> tuple[Index, Array]:
    """Return the points of arcs seen from a point at azimuth 0.

    The points are on both sides, or only on one side; of a full circle, on one half. They have
    the point spacing of a bead, so that the arc has the same segments.

    Parameters
    ----------
    radius : (m,) array
        Radii of the arcs, mm.
    turn : float
        Extent of the arcs, rad.
    chord_error : float
        Chord error of the bead, mm.
    min_points : int
        Minimum number of points of a full turn.
    one_side : bool
        Whether only one side is needed.

    Returns
    -------
    bead : (k,) int array
        Arc of each point.
    azimuth : (k,) array
        Azimuth of each point, rad.
    """
    full = turn >= 2.0 * np.pi
    counts = np.array(
        [turn_segments(float(radius_), chord_error, turn, min_points) for radius_ in radius]
    )
    end = -(-counts // 2) if full and one_side else counts
    start = np.zeros_like(end) if full or one_side else -end
    sizes = end - start + 1
    bead = np.repeat(np.arange(len(radius)), sizes)
    position = np.arange(len(bead)) - np.repeat(np.cumsum(sizes) - sizes - start, sizes)
    return bead, turn * position / counts[bead]


def _place(radius: Array, azimuth: Array, height: Array) -> Array:
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height], axis=1)


def _in_space(direction: Array, azimuth: Array) -> Array:
    """Convert directions (n, 3) from components along radius, azimuth and axis to the feature frame."""
    c, s = np.cos(azimuth), np.sin(azimuth)
    along, across, up = columns(direction)
    return np.stack([along * c - across * s, along * s + across * c, up], axis=1)
