# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on cylinders and cones of a hub, as triangles, grouped by the surface on which they
start.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ..issues import Issue
from ..types import Array, Integers, Mask
from .columns import columns, dots
from .curves.guide import Guide
from .developable import Developable, Plane
from .formatting import place
from .frames import TURN
from .mesh.coarsen import doubled_areas
from .mesh.solid import SolidMesh
from .obstacles import Body, meeting_boxes


@dataclass(frozen=True, eq=False)
class Base:
    """A cylinder, a cone, or the first plane of a stack or along a guide, in the part: name: what messages call it; frame:
    (4, 4) pose of its own frame in part coordinates, Z its axis, towards the apex of a cone."""

    name: str
    surface: Developable | Plane | Guide
    frame: Array

    def inside(self, points: Array) -> Array:
        """Return points of the part in the base's frame.

        Parameters
        ----------
        points : (..., 3) array
            Points in part coordinates, mm.

        Returns
        -------
        (..., 3) array
            mm.
        """
        local: Array = (points - self.frame[:3, 3]) @ self.frame[:3, :3]
        return local

    def to_part(self, points: Array) -> Array:
        """Return points of the base's frame in part coordinates.

        Parameters
        ----------
        points : (..., 3) array
            Points in the base's frame, mm.

        Returns
        -------
        (..., 3) array
            mm.
        """
        in_part: Array = points @ self.frame[:3, :3].T + self.frame[:3, 3]
        return in_part

    def rotate_to_part(self, vectors: Array) -> Array:
        """Return vectors of the base's frame in part coordinates.

        Parameters
        ----------
        vectors : (..., 3) array
            Vectors in the base's frame.

        Returns
        -------
        (..., 3) array
            The rotated vectors.
        """
        in_part: Array = vectors @ self.frame[:3, :3].T
        return in_part

    def where(self, point: Array) -> str:
        """Return a point of the base's frame as text.

        Parameters
        ----------
        point : (3,) array
            The point in the frame of the base, mm.

        Returns
        -------
        str
            Its coordinates in the part.
        """
        return place(self.to_part(point[None])[0])


class Stretch(NamedTuple):
    """Where a face of a base is: from low to high, mm along its axis, and from the azimuth start, rad, on by span."""

    low: float
    high: float
    start: float = 0.0
    span: float = TURN

    def near(self, points: Array, margin: float, all_round: bool = False) -> Mask:
        """Return which points are on the face, or near it along the axis.

        Parameters
        ----------
        points : (n, 3) array
            Points in the base's frame, mm.
        margin : float
            Distance past its ends that still counts, mm.
        all_round : bool, optional
            Whether azimuths do not matter.

        Returns
        -------
        (n,) bool array
            True for points on the face.
        """
        x, y, z = columns(points)
        along = (z > self.low - margin) & (z < self.high + margin)
        if all_round or self.span >= TURN:
            return np.asarray(along)
        angular = margin / np.maximum(np.hypot(x, y), margin)
        return np.asarray(
            along
            & (
                np.remainder(np.arctan2(y, x) - self.start + angular, TURN)
                < self.span + 2.0 * angular
            )
        )


class Seat(NamedTuple):
    """A base and the positions of its faces.

    chosen: by the user, who may also mean the rest of the turn, where there is no face.
    """

    base: Base
    faces: tuple[Stretch, ...]
    chosen: bool = False


@dataclass(frozen=True, eq=False)
class Group:
    """Solids on one base, in the order of their azimuths.

    start: triangles (k, 3, 3), in part coordinates, of the faces on which curved layers
    start; None: the faces on the base.
    """

    base: Base
    bodies: tuple[Body, ...]
    start: Array | None = None


@dataclass(frozen=True)
class OwnHub:
    """A hub that belongs to the part.

    volume, hub: mm3 of the whole part and of the hub. apart: name and mm3 of the hub's solid,
    if it is a separate solid.
    """

    volume: float
    hub: float
    apart: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class SolidsOnHub:
    """The solids to deposit, group by group.

    surroundings: hub and fixtures. chord_error: mm between the triangles and the solids. own:
    the hub, if it belongs to the part and is not deposited. depths: None, as beads fill them.
    """

    depths: ClassVar[None] = None

    label: str
    groups: tuple[Group, ...]
    chord_error: float
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    own: OwnHub | None = None

    def has_plane_layers(self) -> bool:
        """Return whether layers are planes, one above the other, so that no earlier deposit is above
        a layer.
        """
        return not any(isinstance(group.base.surface, Developable) for group in self.groups)

    @property
    def frame(self) -> Array:
        """Return the frame of the feature.

        Z is the axis of the first base, upwards in the part; the origin is at the lowest
        end of the solids; X is the part's X seen along Z. For planes Z is the stacking
        direction, wherever it points.

        Returns
        -------
        (4, 4) array
            Pose in part coordinates, mm.
        """
        base = self.groups[0].base
        if self.has_plane_layers():
            return base.frame
        z = base.frame[:3, 2]
        z = -z if downwards(z) else z
        vertices = np.vstack([body.vertices for group in self.groups for body in group.bodies])
        low = float(((vertices - base.frame[:3, 3]) @ z).min())
        return upright(base.frame[:3, 3] + low * z, z)


def middle_azimuth(base: Base, points: Array) -> float:
    """Return the azimuth of the middle of the sector of points, opposite their widest gap.

    Parameters
    ----------
    base : Base
        The base whose axis counts.
    points : (n, 3) array
        Points of the part, mm.

    Returns
    -------
    float
        rad about the axis, from 0 to a turn.
    """
    local = base.inside(points)
    start, span = sector(np.arctan2(local[:, 1], local[:, 0]))
    middle = float(np.remainder(start + 0.5 * span, TURN))
    return 0.0 if TURN - middle < 1e-9 else round(middle, 9)


def sector(azimuths: Array) -> tuple[float, float]:
    """Return the sector of azimuths: all but their widest gap.

    Parameters
    ----------
    azimuths : (n,) array
        Azimuths, rad.

    Returns
    -------
    start : float
        Where it begins, from 0 to a turn, rad.
    span : float
        Its width, rad.
    """
    angle = np.sort(np.remainder(azimuths, TURN))
    gaps = np.diff(angle, append=angle[0] + TURN)
    k = int(np.argmax(gaps))
    start = float(angle[(k + 1) % len(angle)])
    return 0.0 if TURN - start < 1e-9 else start, TURN - float(gaps[k])


def downwards(z: Array) -> bool:
    """Return whether an axis points against the part's Z.

    Parameters
    ----------
    z : (3,) array
        Unit vector in the part; without a component along Z, its X or else Y counts.

    Returns
    -------
    bool
        True if that component is negative.
    """
    for component in (2, 0, 1):
        if abs(z[component]) > 1e-9:
            return bool(z[component] < 0.0)
    return False


def upright(origin: Array, z: Array) -> Array:
    """Return the frame with an origin and Z.

    Parameters
    ----------
    origin : (3,) array
        Origin, mm.
    z : (3,) array
        Unit vector.

    Returns
    -------
    (4, 4) array
        Its X is the part's X seen along Z, or Y where X is along it.
    """
    x = np.eye(3)[0] - z[0] * z
    if np.linalg.norm(x) < 1e-6:
        x = np.eye(3)[1] - z[1] * z
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    frame[:3, 3] = origin
    return frame


PLACES = 10_000  # of the solid's surface, if its triangles were squares


def volume_beyond(surface: Developable, vertices: Array, triangles: Integers) -> float:
    """Return the volume of a closed mesh outside a hub.

    Parameters
    ----------
    surface : Developable
        The hub.
    vertices : (n, 3) array
        Vertices in the hub's frame, mm.
    triangles : (m, 3) int array
        Triangles.

    Returns
    -------
    float
        mm3, accurate to about 1e-4.
    """
    corner = vertices[triangles]
    area = doubled_areas(corner) / 2.0
    longest = float(np.sqrt(np.linalg.norm(area, axis=1).sum() / PLACES))
    volume = 0.0
    while len(corner):  # halve until no side is longer
        side = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
        top = np.argmax(side, axis=1)
        small = side[np.arange(len(top)), top] <= longest
        volume += float(dots(_field(surface, corner[small].mean(axis=1)), area[small]).sum())
        corner, area, top = corner[~small], area[~small], top[~small]
        a, b, c = (corner[np.arange(len(top)), (top + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corner = np.concatenate(
            [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        )
        area = np.concatenate([area, area]) / 2.0
    return max(volume, 0.0)


def solids_beyond(solids: SolidsOnHub) -> float | None:
    """Return the volume, mm3, of all solids outside their hubs; None if they may overlap."""
    volume = 0.0
    for group in solids.groups:
        surface = group.base.surface
        if isinstance(surface, Developable):  # overlapping solids are rejected earlier
            volume += sum(
                volume_beyond(surface, group.base.inside(body.vertices), body.triangles)
                for body in group.bodies
            )
        elif _may_meet(group.bodies):
            return None
        else:
            volume += sum(
                abs(SolidMesh(body.vertices, body.triangles).volume) for body in group.bodies
            )
    return volume


def _may_meet(bodies: Sequence[Body]) -> bool:
    """Whether the boxes of any two bodies overlap."""
    if len(bodies) < 2:
        return False
    low = np.array([body.vertices.min(axis=0) for body in bodies])
    high = np.array([body.vertices.max(axis=0) for body in bodies])
    return any(
        bool(((low[others] < high[number]) & (low[number] < high[others])).all(axis=1).any())
        for number, others in enumerate(meeting_boxes(low, high))
    )


def _field(surface: Developable, points: Array) -> Array:
    """Return the field (n, 3) at points (n, 3)."""
    cos = np.cos(surface.taper)
    height = np.maximum(surface.distance(points), 0.0)
    rho = np.maximum(np.hypot(points[:, 0], points[:, 1]), 1e-300)
    foot = rho - height * cos
    field: Array = ((rho * rho - foot * foot) / (2.0 * rho * cos))[:, None] * surface.normals(
        points
    )
    return field
