# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the links of a robot meet what is in its cell: nozzle, platform, bodies, and what has been deposited before.

Links are rods that hold what is drawn of them; bodies are their triangles and, where closed, their inside; beads are as
wide and high as they are. So what is not told to touch does not touch, as far as links are what is drawn. What the flange
carries is not looked at against the last two links, which hold it and can hardly move against it, nor what stands still
against the base. Links against each other, the floor, cables and what holds the nozzle are not looked at at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..collision.bodies import of_bodies
from ..collision.frustum import Frustum
from ..collision.obstacles import Obstacles
from ..collision.scene import Scene
from ..collision.tolerances import ABOUT_FACES
from ..geometry import frames
from ..geometry.rods import Rod
from ..geometry.surroundings import Body, disc
from .cell import PART_ON_ROBOT, Cell

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]

NOZZLE, PLATFORM, DEPOSIT = "nozzle", "platform", "deposit"
NONE = -1
PIECE = 4096  # joint vectors done together
SIDES = 24  # of a nozzle


@dataclass(frozen=True)
class Touches:
    """With k joint vectors. what: (k,) number in `ArmContact.names` of the first of those that a link touches; link: (k,)
    number of the link nearest to the base, 0, that touches it; NONE in both where nothing touches."""

    link: Index
    what: Index

    @property
    def any(self) -> Mask:
        """(k,) whether there is one."""
        return np.asarray(self.link != NONE)


@dataclass(frozen=True)
class _Group:
    """What links (numbers) are looked at against, within a ball, seen from the part or from the nozzle."""

    scene: Scene
    links: range
    centre: Array
    radius: float
    by_nozzle: bool = False


@dataclass(frozen=True)
class ArmContact:
    """A robot in its cell. rods: of each link of the robot (axes + 1), in the frame of the link, base first. bodies,
    deposit: in part coordinates. clearance: mm, links that are nearer touch.

    names: what can be touched, as messages call it.
    """

    cell: Cell
    rods: Sequence[Sequence[Rod]]
    bodies: Sequence[Body] = ()
    deposit: Obstacles | None = None
    clearance: float = 0.0
    names: tuple[str, ...] = field(init=False)
    _groups: tuple[_Group, ...] = field(init=False, repr=False)
    _balls: tuple[tuple[Array, float], ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        around = [body for body in self.bodies if len(body.triangles)]
        if self.cell.platform_diameter > 0.0:
            around.append(disc(self.cell.platform_diameter, self.cell.mount, PLATFORM))
        part, holder = self._links(self._carries_part), self._links(not self._carries_part)
        groups = [_of_body(_nozzle(self.cell), holder, by_nozzle=True), *(_of_body(body, part) for body in around)]
        names = [NOZZLE, *(body.name for body in around)]
        if self.deposit is not None:
            names.append(DEPOSIT)
            points = self.deposit.corners.reshape(-1, 3)
            centre, radius = _ball(points)
            about = 0.0 if self.deposit.radius is None else float(self.deposit.radius.max())
            groups.append(_Group(Scene(of_bodies([], points, 0.0), self.deposit), part, centre, radius + about))
        object.__setattr__(self, "names", tuple(names))
        object.__setattr__(self, "_groups", tuple(groups))
        object.__setattr__(self, "_balls", tuple(_about(link) for link in self.rods))

    @property
    def _carries_part(self) -> bool:
        return self.cell.setup == PART_ON_ROBOT

    def _links(self, carried: bool) -> range:
        """The links that are looked at against what is carried, or what stands still."""
        axes = self.cell.robot.chain.axes
        return range(axes - 1) if carried else range(1, axes + 1)

    def touches(self, joints: ArrayLike, moment: Index | None = None) -> Touches:
        """What the links meet with joints (k, axes); NaN meets nothing. moment: (k,) how many points of the deposit are
        there, all of them where it is not given."""
        values = np.asarray(joints, float)
        count = len(values)
        link, what = np.full(count, NONE, dtype=np.int64), np.full(count, NONE, dtype=np.int64)
        when = np.full(count, np.iinfo(np.int64).max) if moment is None else moment
        known = np.flatnonzero(np.isfinite(values).all(axis=1))
        for rows in np.split(known, np.arange(PIECE, len(known), PIECE)):
            if len(rows):
                link[rows], what[rows] = self._touched(values[rows], when[rows])
        return Touches(link, what)

    def _touched(self, joints: Array, moment: Index) -> tuple[Index, Index]:
        links = self.cell.links(joints)
        carried = links[:, -1] @ (self.cell.robot.chain.flange @ self.cell.carried)
        still = np.broadcast_to(self.cell.station, carried.shape)
        platform, nozzle = (carried, still) if self._carries_part else (still, carried @ _TURNED)
        part = platform @ frames.inverse(self.cell.mount)
        link, what = np.full(len(joints), NONE, dtype=np.int64), np.full(len(joints), NONE, dtype=np.int64)
        for place, group in enumerate(self._groups):
            frame = nozzle if group.by_nozzle else part
            centre = frame[:, :3, :3] @ group.centre + frame[:, :3, 3]
            for number in group.links:
                middle, size = self._balls[number]
                away = links[:, number, :3, :3] @ middle + links[:, number, :3, 3] - centre
                within = size + group.radius + self.clearance + 2.0 * ABOUT_FACES
                rows = np.flatnonzero((link == NONE) & (np.einsum("ij,ij->i", away, away) < within**2))
                if len(rows):
                    seen = frames.inverse(frame[rows]) @ links[rows, number]
                    met = rows[_meets(group, self.rods[number], seen, moment[rows], self.clearance)]
                    link[met], what[met] = number, place
        return link, what


def _meets(group: _Group, rods: Sequence[Rod], seen: Array, moment: Index, clearance: float) -> Mask:
    """(k,) whether rods of a link, whose frame is seen as (k, 4, 4), meet a group, or come nearer."""
    met = np.zeros(len(seen), dtype=bool)
    more = ABOUT_FACES + clearance
    for rod in rods:
        left = np.flatnonzero(~met)
        turn = seen[left, :3, :3]
        start = turn @ rod.start + seen[left, :3, 3]
        axis = turn @ ((rod.end - rod.start) / rod.length)
        # only rods that come near the ball are looked at closely
        along = np.clip(np.einsum("ij,ij->i", group.centre - start, axis), 0.0, rod.length)
        off = start + along[:, None] * axis - group.centre
        within = group.radius + rod.radius + ABOUT_FACES + more
        near = np.flatnonzero(np.einsum("ij,ij->i", off, off) < within**2)
        solid = Frustum(rod.radius + more, 0.0, -more, rod.length + more)
        met[left[near]] = group.scene.touched(solid, start[near], axis[near], moment[left[near]])
    return met


# the tip's Z points out of the nozzle that is carried, that of the deposition point into the one that stands
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


def _nozzle(cell: Cell) -> Body:
    """The nozzle in the frame of its tip, a many-sided cone about the round one."""
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) / np.cos(np.pi / SIDES)
    tip, length = 0.5 * cell.nozzle.diameter, cell.nozzle.length
    back = tip + length * float(np.tan(cell.nozzle.half_angle))
    vertices = np.concatenate([
        np.column_stack([tip * ring, np.zeros(SIDES)]), np.column_stack([back * ring, np.full(SIDES, length)]),
        [[0.0, 0.0, 0.0], [0.0, 0.0, length]],
    ])
    here = np.arange(SIDES)
    on = np.roll(here, -1)
    triangles = np.concatenate([
        np.stack([here, on, on + SIDES], axis=1), np.stack([here, on + SIDES, here + SIDES], axis=1),
        np.stack([on, here, np.full(SIDES, 2 * SIDES)], axis=1),
        np.stack([here + SIDES, on + SIDES, np.full(SIDES, 2 * SIDES + 1)], axis=1),
    ])
    return Body(NOZZLE, vertices, triangles.astype(np.int64))


def _of_body(body: Body, links: range, by_nozzle: bool = False) -> _Group:
    return _Group(Scene(of_bodies([body], body.vertices, 0.0)), links, *_ball(body.vertices), by_nozzle)


def _about(link: Sequence[Rod]) -> tuple[Array, float]:
    """Centre and radius of a ball about the rods of a link."""
    if not link:
        return np.zeros(3), 0.0
    centre, radius = _ball(np.concatenate([[rod.start, rod.end] for rod in link]))
    return centre, radius + max(rod.radius for rod in link)


def _ball(points: Array) -> tuple[Array, float]:
    """Centre and radius of a ball about points (n, 3)."""
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return centre, float(np.linalg.norm(points - centre, axis=1).max())
