# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on cylinders and cones of a hub, as triangles, grouped by base surface."""

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
    """A base surface in the part: a cylinder, a cone, or the first plane of a stack or a guide.

    name: name in messages. frame: (4, 4) pose of the base frame in part coordinates; Z is the axis,
    towards the apex of a cone.
    """

    name: str
    surface: Developable | Plane | Guide
    frame: Array

    def inside(self, points: Array) -> Array:
        """Transform points from part coordinates to the base frame.

        Parameters
        ----------
        points : (..., 3) array
            Points in part coordinates, mm.

        Returns
        -------
        (..., 3) array
            Points in the base frame, mm.
        """
        local: Array = (points - self.frame[:3, 3]) @ self.frame[:3, :3]
        return local

    def to_part(self, points: Array) -> Array:
        """Transform points from the base frame to part coordinates.

        Parameters
        ----------
        points : (..., 3) array
            Points in the base frame, mm.

        Returns
        -------
        (..., 3) array
            Points in part coordinates, mm.
        """
        in_part: Array = points @ self.frame[:3, :3].T + self.frame[:3, 3]
        return in_part

    def rotate_to_part(self, vectors: Array) -> Array:
        """Rotate vectors from the base frame to part coordinates.

        Parameters
        ----------
        vectors : (..., 3) array
            Vectors in the base frame.

        Returns
        -------
        (..., 3) array
            Rotated vectors.
        """
        in_part: Array = vectors @ self.frame[:3, :3].T
        return in_part

    def where(self, point: Array) -> str:
        """Format a point of the base frame.

        Parameters
        ----------
        point : (3,) array
            Point in the base frame, mm.

        Returns
        -------
        str
            Part coordinates of the point.
        """
        return place(self.to_part(point[None])[0])


class Stretch(NamedTuple):
    """Extent of a base face.

    low, high: mm along the axis. start, span: first azimuth and angular extent, rad.
    """

    low: float
    high: float
    start: float = 0.0
    span: float = TURN

    def near(self, points: Array, margin: float, all_round: bool = False) -> Mask:
        """Return whether points are on the face, within a margin.

        Parameters
        ----------
        points : (n, 3) array
            Points in the base frame, mm.
        margin : float
            Accepted distance past the ends of the face, mm.
        all_round : bool, optional
            Whether to ignore azimuths.

        Returns
        -------
        (n,) bool array
            True for points within the margin.
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
    """A base and the extents of its faces.

    chosen: whether the user selected the base; the user may then mean the full turn, also where
    there is no face.
    """

    base: Base
    faces: tuple[Stretch, ...]
    chosen: bool = False


@dataclass(frozen=True, eq=False)
class Group:
    """Solids on one base, in order of azimuth.

    start: (k, 3, 3) triangles, in part coordinates, of the faces on which curved layers start;
    None: the faces on the base.
    """

    base: Base
    bodies: tuple[Body, ...]
    start: Array | None = None


@dataclass(frozen=True)
class OwnHub:
    """A hub that belongs to the part.

    volume, hub: volume of the whole part and of the hub, mm3. apart: name and volume (mm3) of the
    hub's solid, if it is a separate solid.
    """

    volume: float
    hub: float
    apart: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class SolidsOnHub:
    """The solids to deposit, in groups.

    surroundings: hub and fixtures. chord_error: maximum distance between triangles and solids, mm.
    own: the hub, if it belongs to the part and is not deposited. depths: None, because beads fill
    the solids.
    """

    depths: ClassVar[None] = None

    label: str
    groups: tuple[Group, ...]
    chord_error: float
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    own: OwnHub | None = None

    def has_plane_layers(self) -> bool:
        """Return whether layers are stacked planes, so that no earlier deposit is above a layer."""
        return not any(isinstance(group.base.surface, Developable) for group in self.groups)

    @property
    def frame(self) -> Array:
        """Return the frame of the feature.

        Z is the axis of the first base, upwards in the part. The origin is at the lowest end of
        the solids. X is the part's X projected along Z. For planes, Z is the stacking direction,
        in whatever direction it points.

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
    """Return the centre azimuth of the sector that points occupy, opposite their widest gap.

    Parameters
    ----------
    base : Base
        Base whose axis defines the azimuth.
    points : (n, 3) array
        Points in part coordinates, mm.

    Returns
    -------
    float
        Azimuth about the axis, rad, from 0 to 2 pi.
    """
    local = base.inside(points)
    start, span = sector(np.arctan2(local[:, 1], local[:, 0]))
    middle = float(np.remainder(start + 0.5 * span, TURN))
    return 0.0 if TURN - middle < 1e-9 else round(middle, 9)


def sector(azimuths: Array) -> tuple[float, float]:
    """Return the sector that azimuths occupy: the full turn without their widest gap.

    Parameters
    ----------
    azimuths : (n,) array
        Azimuths, rad.

    Returns
    -------
    start : float
        Start of the sector, rad, from 0 to 2 pi.
    span : float
        Angular extent of the sector, rad.
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
        Unit vector in the part; if its Z component is zero, X or else Y decides.

    Returns
    -------
    bool
        True if the deciding component is negative.
    """
    for component in (2, 0, 1):
        if abs(z[component]) > 1e-9:
            return bool(z[component] < 0.0)
    return False


def upright(origin: Array, z: Array) -> Array:
    """Return the frame with a given origin and Z axis.

    Parameters
    ----------
    origin : (3,) array
        Origin, mm.
    z : (3,) array
        Unit vector.

    Returns
    -------
    (4, 4) array
        Pose whose X is the part's X projected along Z, or the part's Y if X is parallel to Z.
    """
    x = np.eye(3)[0] - z[0] * z
    if np.linalg.norm(x) < 1e-6:
        x = np.eye(3)[1] - z[1] * z
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    frame[:3, 3] = origin
    return frame


PLACES = 10_000  # surface samples of a solid; they set the maximum triangle side


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
    while len(corner):  # bisect until no side is longer than `longest`
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
    """Return the total volume of solids outside their hubs, mm3; None if solids may overlap."""
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
    """Return whether the bounding boxes of any two bodies overlap."""
    if len(bodies) < 2:
        return False
    low = np.array([body.vertices.min(axis=0) for body in bodies])
    high = np.array([body.vertices.max(axis=0) for body in bodies])
    return any(
        bool(((low[others] < high[number]) & (low[number] < high[others])).all(axis=1).any())
        for number, others in enumerate(meeting_boxes(low, high))
    )


def _field(surface: Developable, points: Array) -> Array:
    """Return a vector field (n, 3) at points (n, 3) with divergence 1 outside the hub."""
    cos = np.cos(surface.taper)
    height = np.maximum(surface.distance(points), 0.0)
    rho = np.maximum(np.hypot(points[:, 0], points[:, 1]), 1e-300)
    foot = rho - height * cos
    field: Array = ((rho * rho - foot * foot) / (2.0 * rho * cos))[:, None] * surface.normals(
        points
    )
    return field
