# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the links of a robot meet what is in its cell: nozzle, platform, bodies, obstacles, and what has been deposited
before; and whether nozzle or part meet the obstacles.

Links are cylinders that hold what is drawn of them; bodies are their triangles and, where closed, their inside; beads are as
wide and high as they are. So what is not told to touch does not touch, as far as links are what is drawn. What the flange
carries is not looked at against the last two links, which hold it and can hardly move against it, nor what stands still
against the base. A part that moves is all there from the beginning: cylinders about its bodies and beads. The nozzle is
looked at as it is against bodies, without clearance: it deposits next to them. What holds the nozzle is looked at where
`cell.nozzle.shape` shows it. The links of positioner and track (`beside`) move with their axes: robot, nozzle and torch
are looked at against them, and they against obstacles. Of these pairs are left out

- what stands on the floor against what does too, the base of a robot without a track among it: it never moves;
- base and link 1 against the carriage, which the base is one with and link 1 turns on; and the base against the rail, along
  which it slides. Link 1 is looked at against the rail, which it turns and slides past;
- the part against the last two links of what it stands on. It is looked at against the other links of a positioner, carriage
  and rail, if one of both moves;
- links of positioners against each other, which their own stops keep apart.

Links of the robot against each other: `own`. The floor is looked at where it is an obstacle, cables and hoses where the file
of the torch has them.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...collision.bodies import build_bodies
from ...collision.nozzle import depositing
from ...collision.obstacles import Obstacles
from ...collision.scene import Scene
from ...collision.tolerances import ABOUT_FACES
from ...geometry import frames
from ...geometry.columns import dots
from ...geometry.cylinders import Cylinder, enclosing_cylinder, enclosing_row
from ...geometry.obstacles import Body, disc
from ...parameters.external import ROBOT
from ...types import Array, ArrayLike, Index, Mask
from ..cell import Cell
from .external_links import STANDS, ExternalLink
from .nozzle_body import NOZZLE, nozzle_body
from .own import OwnLinks
from .rounds import NONE, Solid, about_link, ball, of_cylinder

BASE, PLATFORM, DEPOSIT, PART, TORCH = "base", "platform", "deposit", "part", "torch"
WORLD = "world"
OWN = "link "  # before the axis of a link, as it is touched
LINKS_MORE = 4  # of `links` besides the axes, before those of what stands beside the robot
PIECE = 4096  # joint vectors done together
LINK_PIECE, SHARE = (
    50.0,
    0.01,
)  # longest edge of a triangle that links are looked at against, mm, and of the body's size
SLICES = 8  # cylinders about a deposit that moves


@dataclass(frozen=True, eq=False)
class Touches:
    """With k joint vectors. what: (k,) number in `ArmContact.names` of the first of those that a link touches; link: (k,)
    number in `ArmContact.links` of the link nearest to the base, 0, that touches it; NONE in both where nothing touches."""

    link: Index
    what: Index

    @property
    def any(self) -> Mask:
        """(k,) whether there is one."""
        return np.asarray(self.link != NONE)


@dataclass(frozen=True, eq=False)
class Group:
    """What links (numbers) are looked at against, within a ball, as it is seen from the part, the nozzle or the world."""

    scene: Scene
    links: Sequence[int]
    centre: Array
    radius: float
    seen_from: str = PART


@dataclass(frozen=True, eq=False)
class ArmContact:
    """A robot in its cell. cylinders: of each link of the robot (axes + 1), in the frame of the link, base first. bodies,
    deposit: in part coordinates. clearance: mm, links that are nearer touch; below 0 those that are less deep do not.
    holders: the last two links are looked at against a part that they carry too, all but its platform.

    names: what can be touched, in the end links of the robot; links: what touches it: base, axes, then part, nozzle and
    torch, and the links of what stands beside the robot.
    groups: what can be touched; solids: of each of `links`, in its frame; balls: centre and radius of one about these.
    """

    cell: Cell
    cylinders: Sequence[Sequence[Cylinder]]
    bodies: Sequence[Body] = ()
    deposit: Obstacles | None = None
    clearance: float = 0.0
    holders: bool = False
    names: tuple[str, ...] = field(init=False)
    links: tuple[str, ...] = field(init=False)
    solids: tuple[tuple[Solid, ...], ...] = field(init=False, repr=False)
    groups: tuple[Group, ...] = field(init=False, repr=False)
    balls: tuple[tuple[Array, float], ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        around = [body for body in self.bodies if len(body.triangles)]
        if self.cell.platform_diameter > 0.0:
            around.append(disc(self.cell.platform_diameter, self.cell.mount, PLATFORM))
        held, holder = self.cell.torch, self._links(not self._carries_part)
        part = [*self._links(self._carries_part), *self._torch, *self._track(self.cell.part_moves)]
        held_part = [*part, *self._holders]
        about_nozzle = [nozzle_body(self.cell.nozzle)]
        about_nozzle += [] if held is None else [dataclasses.replace(held.body, name=TORCH)]
        groups = [
            *(_of_body(body, holder, NOZZLE) for body in about_nozzle),
            *(_of_body(body, part if body.name == PLATFORM else held_part) for body in around),
        ]
        names = [body.name for body in (*about_nozzle, *around)]
        more = ABOUT_FACES + self.clearance
        solids = [[of_cylinder(cylinder, more) for cylinder in link] for link in self.cylinders]
        solids += [
            [of_cylinder(cylinder, more) for cylinder in self._part_cylinders(around)],
            [_of_nozzle(self.cell)],
        ]
        solids += [
            [of_cylinder(cylinder, more) for cylinder in (() if held is None else held.cylinders)]
        ]
        if self.deposit is not None:
            names.append(DEPOSIT)
            points = self.deposit.corners.reshape(-1, 3)
            centre, radius = ball(points)
            wide = 0.0 if self.deposit.radius is None else float(self.deposit.radius.max())
            groups.append(
                Group(
                    Scene(build_bodies([], points, 0.0), self.deposit),
                    held_part,
                    centre,
                    radius + wide,
                )
            )
        groups += [_of_body(body, self._movers, WORLD) for body in self.cell.obstacles]
        names += [body.name for body in self.cell.obstacles]
        groups += [
            _of_body(one.body, self._against(one), one.name) for one in self.cell.external_links
        ]
        names += [one.name for one in self.cell.external_links]
        solids += [
            [
                of_cylinder(cylinder, more)
                for cylinder in (
                    one.cylinders if self.cell.obstacles or one.carries == ROBOT else ()
                )
            ]
            for one in self.cell.external_links
        ]
        object.__setattr__(
            self,
            "links",
            (
                BASE,
                *self.cell.robot.axes,
                PART,
                NOZZLE,
                TORCH,
                *(one.name for one in self.cell.external_links),
            ),
        )
        object.__setattr__(
            self, "names", (*names, BASE, *(OWN + axis for axis in self.cell.robot.axes))
        )
        object.__setattr__(self, "groups", tuple(groups))
        object.__setattr__(self, "solids", tuple(map(tuple, solids)))
        object.__setattr__(self, "balls", tuple(about_link(link) for link in solids))

    @cached_property
    def own(self) -> OwnLinks:
        """The links against each other."""
        return OwnLinks.of(self.cell.robot.chain, self.cell.limits, self.cylinders, self.clearance)

    @property
    def _carries_part(self) -> bool:
        return self.cell.torch_stands

    def _links(self, carried: bool) -> range:
        """The links that are looked at against what is carried, or what stands still."""
        axes = self.cell.robot.chain.axes
        return range(axes - 1) if carried else range(1, axes + 1)

    @property
    def _holders(self) -> list[int]:
        """The links that carry the part, where they are looked at against it."""
        axes = self.cell.robot.chain.axes
        return [axes - 1, axes] if self.holders and self._carries_part else []

    @property
    def _torch(self) -> list[int]:
        """The number of the torch, if there is one."""
        return [] if self.cell.torch is None else [self.cell.robot.chain.axes + 3]

    @property
    def _movers(self) -> list[int]:
        """What moves in the world: links, with a track the base too, and part or nozzle with its torch."""
        axes, cell = self.cell.robot.chain.axes, self.cell
        on_track = cell.external is not None and cell.external.slides is not None
        found = list(range(0 if on_track else 1, axes + 1))
        adjacent = [
            axes + LINKS_MORE + k for k, one in enumerate(cell.external_links) if one.axis != STANDS
        ]
        return [
            *found,
            *([axes + 1] if cell.part_moves else []),
            *([] if cell.torch_stands else [axes + 2, *self._torch]),
            *adjacent,
        ]

    def _against(self, one: ExternalLink) -> list[int]:
        """What is looked at against a link beside the robot: the robot's links two joints away or more where it carries
        these, or that move against it; nozzle and torch; and the part but for the last two links of what it stands on."""
        axes, on_robot = self.cell.robot.chain.axes, one.carries == ROBOT
        on_track = self.cell.external is not None and self.cell.external.slides is not None
        first = 2 - one.after if on_robot else 0 if on_track or one.axis != STANDS else 1
        part = [] if on_robot or one.after <= 1 else [axes + 1]
        track = [] if on_robot else self._track(one.axis != STANDS)
        return [*range(first, axes + 1), *part, axes + 2, *self._torch, *track]

    def _track(self, moves: bool) -> list[int]:
        """The links of a track that move against what moves in the world, or else stands."""
        first = self.cell.robot.chain.axes + LINKS_MORE
        return [
            first + k
            for k, one in enumerate(self.cell.external_links)
            if one.carries == ROBOT and (one.axis != STANDS or moves)
        ]

    def _part_cylinders(self, around: Sequence[Body]) -> list[Cylinder]:
        """Cylinders that hold the part with what it stands on, where it may meet obstacles."""
        if not (self.cell.obstacles or self.cell.external_links) or not self.cell.part_moves:
            return []
        found = [
            cylinder for body in around for cylinder in enclosing_row(body.vertices, body.triangles)
        ]
        if self.deposit is not None:
            wide = 0.0 if self.deposit.radius is None else float(self.deposit.radius.max())
            found += [
                Cylinder(one.start, one.end, one.radius + wide)
                for one in _slices(self.deposit.corners)
            ]
        return found

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

    def seen(self, joints: Array) -> tuple[Array, dict[str, Array]]:
        """With joints (k, axes): the frames (k, links, 4, 4) of `links`, and those (k, 4, 4) of part, nozzle and world, all
        seen from where the machine's chain begins."""
        links = self.cell.links(joints)
        carried = links[:, -1] @ (self.cell.robot.chain.flange @ self.cell.carried)
        still = np.broadcast_to(self.cell.station, carried.shape)
        platform, nozzle = (carried, still) if self._carries_part else (still, carried @ _TURNED)
        part = platform @ frames.inverse(self.cell.mount)
        seen_from = {
            PART: part,
            NOZZLE: nozzle,
            WORLD: self.cell.world(joints) if self.cell.obstacles else part,
        }
        adjacent = self.cell.external_link_frames(joints)
        seen_from |= {one.name: adjacent[:, k] for k, one in enumerate(self.cell.external_links)}
        return np.concatenate(
            [links, part[:, None], nozzle[:, None], nozzle[:, None], adjacent], axis=1
        ), seen_from

    def _touched(self, joints: Array, moment: Index) -> tuple[Index, Index]:
        links, seen_from = self.seen(joints)
        link, what = (
            np.full(len(joints), NONE, dtype=np.int64),
            np.full(len(joints), NONE, dtype=np.int64),
        )
        looked_at = sorted({number for group in self.groups for number in group.links})
        middles = {k: frames.transform_point(links[:, k], self.balls[k][0]) for k in looked_at}
        for place, group in enumerate(self.groups):
            frame = seen_from[group.seen_from]
            centre = frames.transform_point(frame, group.centre)
            back = frames.inverse(frame)
            for number in group.links:
                away = middles[number] - centre
                within = self.balls[number][1] + group.radius + ABOUT_FACES
                rows = np.flatnonzero((link == NONE) & (dots(away, away) < within**2))
                if len(rows):
                    met = rows[
                        _meets(
                            group,
                            self.solids[number],
                            back[rows] @ links[rows, number],
                            moment[rows],
                        )
                    ]
                    link[met], what[met] = number, place
        left = np.flatnonzero(link == NONE)
        outer, inner = self.own.touches(links[left])
        link[left], what[left] = outer, np.where(inner == NONE, NONE, len(self.groups) + inner)
        return link, what


def _meets(group: Group, solids: Sequence[Solid], seen: Array, moment: Index) -> Mask:
    """(k,) whether solids of a link, whose frame is seen as (k, 4, 4), meet a group."""
    met = np.zeros(len(seen), dtype=bool)
    for one in solids:
        tip, axis = frames.transform_point(seen, one.tip), frames.rotate_vector(seen, one.axis)
        # only those that come near the ball are looked at closely
        low, high = float(np.min(one.solid.low)), one.solid.high
        off = tip - group.centre
        along = np.minimum(np.maximum(-dots(off, axis), low), high)
        off += along[:, None] * axis
        within = group.radius + one.solid.radius + one.solid.slope * high + ABOUT_FACES
        near = np.flatnonzero(~met & (dots(off, off) < within**2))
        met[near] = group.scene.touched(one.solid, tip[near], axis[near], moment[near])
    return met


def _of_nozzle(cell: Cell) -> Solid:
    """The nozzle in the frame of its tip, as it is looked at against bodies it deposits next to."""
    nozzle = cell.nozzle
    solid = depositing(
        0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0
    ).bodies
    return Solid(solid, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.zeros(3), solid.reach)


def _slices(corners: Array) -> list[Cylinder]:
    """Cylinders that hold the hulls of corners (m, c, 3), of those next to each other along the longest side of all."""
    middle = corners.mean(axis=1)
    order = np.argsort(middle[:, int(np.ptp(middle, axis=0).argmax())], kind="stable")
    return [
        enclosing_cylinder(corners[some].reshape(-1, 3))
        for some in np.array_split(order, min(SLICES, len(order)))
    ]


# the tip's Z points out of the nozzle that is carried, that of the deposition point into the one that stands
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


def _of_body(body: Body, links: Sequence[int], seen_from: str = PART) -> Group:
    centre, radius = ball(body.vertices)
    scene = Scene(build_bodies([body], body.vertices, 0.0, max(LINK_PIECE, SHARE * 2.0 * radius)))
    return Group(scene, links, centre, radius, seen_from)
