# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contacts of a robot's links with nozzle, platform, bodies, obstacles and earlier deposit;
and of nozzle or part with obstacles.

Links are cylinders around their drawn shape; bodies are their triangles and, if closed,
their inside; beads have their width and height. So if no contact is reported there is
none, as far as links are as drawn. The load of the flange is not tested against the last
two links, which hold it and can hardly move against it, nor are fixed objects tested
against the base. A moving part is complete from the beginning: cylinders around its
bodies and beads. The nozzle is tested exactly against bodies, without clearance: it
deposits next to them. The holder of the nozzle is tested if `cell.nozzle.shape` shows it.
The links of positioner and track move with their axes: robot, nozzle and torch are tested
against them, and they against obstacles. These pairs are left out:

- objects on the floor against each other, including the base of a robot without a track:
they never move;

- base and link 1 against the carriage, to which the base is fixed and on which link 1
turns; and the base against the rail, along which it slides. Link 1 is tested against the
rail, which it turns and slides past;

- the part against the last two links below it. It is tested against the other links of a
positioner, carriage and rail, if one of both moves;

- links of positioners against each other, which their own stops keep apart.

Links of the robot against each other: `own`. The floor is tested if it is an obstacle,
cables and hoses if the file of the torch has them.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ...collision.obstacles import Obstacles
from ...collision.scene import Scene, build_bodies, depositing
from ...collision.tolerances import ABOUT_FACES
from ...geometry import frames
from ...geometry.columns import dots
from ...geometry.cylinders import Cylinder, enclosing_cylinder, enclosing_row
from ...geometry.obstacles import Body, disc
from ...parameters.cell import NozzleParameters
from ...parameters.cell_records import ROBOT
from ...types import Array, ArrayLike, Index, Mask
from ..cell import Cell
from .external_links import STANDS, ExternalLink
from .self_collision import NONE, OwnLinks, Solid, about_link, ball, round_solid

NOZZLE = "nozzle"
SIDES = 24


def nozzle_body(nozzle: NozzleParameters) -> Body:
    """The nozzle in the frame of its tip, a many-sided cone about the round one."""
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) / np.cos(np.pi / SIDES)
    tip, length = 0.5 * nozzle.diameter, nozzle.length
    back = tip + length * float(np.tan(nozzle.half_angle))
    vertices = np.concatenate(
        [
            np.column_stack([tip * ring, np.zeros(SIDES)]),
            np.column_stack([back * ring, np.full(SIDES, length)]),
            [[0.0, 0.0, 0.0], [0.0, 0.0, length]],
        ]
    )
    index = np.arange(SIDES)
    on = np.roll(index, -1)
    triangles = np.concatenate(
        [
            np.stack([index, on, on + SIDES], axis=1),
            np.stack([index, on + SIDES, index + SIDES], axis=1),
            np.stack([on, index, np.full(SIDES, 2 * SIDES)], axis=1),
            np.stack([index + SIDES, on + SIDES, np.full(SIDES, 2 * SIDES + 1)], axis=1),
        ]
    )
    return Body(NOZZLE, vertices, triangles.astype(np.int64))


BASE, PLATFORM, DEPOSIT, PART, TORCH = "base", "platform", "deposit", "part", "torch"
WORLD = "world"
OWN_PREFIX = "link "  # before the axis of a link, as it is touched
LINKS_MORE = 4  # number of `links` besides the axes, before the external links
PIECE = 4096  # joint vectors in one batch
LINK_PIECE, SHARE = (
    50.0,
    0.01,
)  # longest edge of a triangle against which links are tested, mm, and as a share of the body's size
SLICES = 8  # cylinders about a deposit that moves


@dataclass(frozen=True, eq=False)
class Touches:
    """Contacts for k joint vectors.

    what: (k,) number in `ArmContact.names` of the first object that a link touches. link:
    (k,) number in `ArmContact.links` of the touching link nearest to the base, 0. NONE in
    both without contact.
    """

    link: Index
    what: Index

    @property
    def any(self) -> Mask:
        """Whether there is a contact, (k,)."""
        return np.asarray(self.link != NONE)


@dataclass(frozen=True, eq=False)
class Group:
    """An object tested against links (numbers), within a ball, as seen from the part, the nozzle
    or the world.
    """

    scene: Scene
    links: Sequence[int]
    centre: Array
    radius: float
    seen_from: str = PART


@dataclass(frozen=True, eq=False)
class ArmContact:
    """A robot in its cell.

    cylinders: of each link of the robot (axes + 1), in the frame of the link, base first.
    bodies, deposit: in part coordinates. clearance: mm, nearer links touch; negative allows
    that penetration. holders: the last two links are also tested against the part they carry,
    except its platform.

    names: the objects that can be touched, at the end the links of the robot. links: the
    touching links: base, axes, then part, nozzle and torch, and the external links. groups:
    the objects; solids: of each of `links`, in its frame; balls: centre and radius of a ball
    around these.
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
            around.append(disc(self.cell.platform_diameter, self.cell.poses.mount, PLATFORM))
        torch, holder = self.cell.shapes.torch, self._links(not self._carries_part)
        part_links = [
            *self._links(self._carries_part),
            *self._torch,
            *self._track(self.cell.part_moves),
        ]
        held_part = [*part_links, *self._holders]
        about_nozzle = [nozzle_body(self.cell.nozzle)]
        about_nozzle += [] if torch is None else [dataclasses.replace(torch.body, name=TORCH)]
        groups = [
            *(_group_of_body(body, holder, NOZZLE) for body in about_nozzle),
            *(
                _group_of_body(body, part_links if body.name == PLATFORM else held_part)
                for body in around
            ),
        ]
        names = [body.name for body in (*about_nozzle, *around)]
        growth = ABOUT_FACES + self.clearance
        solids = [[round_solid(cylinder, growth) for cylinder in link] for link in self.cylinders]
        solids += [
            [round_solid(cylinder, growth) for cylinder in self._part_cylinders(around)],
            [_nozzle_solid(self.cell)],
        ]
        solids += [
            [
                round_solid(cylinder, growth)
                for cylinder in (() if torch is None else torch.cylinders)
            ]
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
        groups += [_group_of_body(body, self._movers, WORLD) for body in self.cell.shapes.obstacles]
        names += [body.name for body in self.cell.shapes.obstacles]
        groups += [
            _group_of_body(external_link.body, self._against(external_link), external_link.name)
            for external_link in self.cell.shapes.external_links
        ]
        names += [external_link.name for external_link in self.cell.shapes.external_links]
        for external_link in self.cell.shapes.external_links:
            is_tested = self.cell.shapes.obstacles or external_link.carries == ROBOT
            cylinders = external_link.cylinders if is_tested else ()
            solids.append([round_solid(cylinder, growth) for cylinder in cylinders])
        object.__setattr__(
            self,
            "links",
            (
                BASE,
                *self.cell.robot.axes,
                PART,
                NOZZLE,
                TORCH,
                *(external_link.name for external_link in self.cell.shapes.external_links),
            ),
        )
        object.__setattr__(
            self, "names", (*names, BASE, *(OWN_PREFIX + axis for axis in self.cell.robot.axes))
        )
        object.__setattr__(self, "groups", tuple(groups))
        object.__setattr__(self, "solids", tuple(map(tuple, solids)))
        object.__setattr__(self, "balls", tuple(about_link(link) for link in solids))

    @cached_property
    def own_links(self) -> OwnLinks:
        """The links against each other."""
        return OwnLinks.of(self.cell.robot.chain, self.cell.limits, self.cylinders, self.clearance)

    @property
    def _carries_part(self) -> bool:
        return self.cell.torch_stands

    def _links(self, carried: bool) -> range:
        """Return the links tested against carried objects, or against fixed ones."""
        axes = self.cell.robot.chain.axes
        return range(axes - 1) if carried else range(1, axes + 1)

    @property
    def _holders(self) -> list[int]:
        """The links that carry the part, if they are tested against it."""
        axes = self.cell.robot.chain.axes
        return [axes - 1, axes] if self.holders and self._carries_part else []

    @property
    def _torch(self) -> list[int]:
        """The number of the torch, if there is one."""
        return [] if self.cell.shapes.torch is None else [self.cell.robot.chain.axes + 3]

    @property
    def _movers(self) -> list[int]:
        """The links that move in the world: with a track the base too, and part or nozzle with its
        torch.
        """
        axes, cell = self.cell.robot.chain.axes, self.cell
        on_track = cell.external is not None and cell.external.slides is not None
        moving_links = list(range(0 if on_track else 1, axes + 1))
        adjacent = [
            axes + LINKS_MORE + k
            for k, external_link in enumerate(cell.shapes.external_links)
            if external_link.axis != STANDS
        ]
        return [
            *moving_links,
            *([axes + 1] if cell.part_moves else []),
            *([] if cell.torch_stands else [axes + 2, *self._torch]),
            *adjacent,
        ]

    def _against(self, external_link: ExternalLink) -> list[int]:
        """Return the links tested against an external link.

        The robot's links at least two joints away if it carries these, or that move relative to
        it; nozzle and torch; and the part, except against the last two links below it.
        """
        axes, on_robot = self.cell.robot.chain.axes, external_link.carries == ROBOT
        on_track = self.cell.external is not None and self.cell.external.slides is not None
        if on_robot:
            first_link = 2 - external_link.axes_after
        else:
            first_link = 0 if on_track or external_link.axis != STANDS else 1
        part_links = [] if on_robot or external_link.axes_after <= 1 else [axes + 1]
        track = [] if on_robot else self._track(external_link.axis != STANDS)
        return [*range(first_link, axes + 1), *part_links, axes + 2, *self._torch, *track]

    def _track(self, moves: bool) -> list[int]:
        """Return the links of a track that move against moving, or against fixed, objects of the
        world.
        """
        first_external = self.cell.robot.chain.axes + LINKS_MORE
        return [
            first_external + k
            for k, external_link in enumerate(self.cell.shapes.external_links)
            if external_link.carries == ROBOT and (external_link.axis != STANDS or moves)
        ]

    def _part_cylinders(self, around: Sequence[Body]) -> list[Cylinder]:
        """Return cylinders around the part and its platform, if it may meet obstacles."""
        if (
            not (self.cell.shapes.obstacles or self.cell.shapes.external_links)
            or not self.cell.part_moves
        ):
            return []
        part_cylinders = [
            cylinder for body in around for cylinder in enclosing_row(body.vertices, body.triangles)
        ]
        if self.deposit is not None:
            wide = 0.0 if self.deposit.radius is None else float(self.deposit.radius.max())
            part_cylinders += [
                Cylinder(slice_cylinder.start, slice_cylinder.end, slice_cylinder.radius + wide)
                for slice_cylinder in _slices(self.deposit.corners)
            ]
        return part_cylinders

    def touches(self, joints: ArrayLike, moment: Index | None = None) -> Touches:
        """Return the contacts of the links with joints (k, axes); NaN touches nothing.

        moment: (k,) number of points of the deposit present, by default all.
        """
        values = np.asarray(joints, float)
        count = len(values)
        link, what = np.full(count, NONE, dtype=np.int64), np.full(count, NONE, dtype=np.int64)
        when = np.full(count, np.iinfo(np.int64).max) if moment is None else moment
        finite = np.flatnonzero(np.isfinite(values).all(axis=1))
        for rows in np.split(finite, np.arange(PIECE, len(finite), PIECE)):
            if len(rows):
                link[rows], what[rows] = self._find_contacts(values[rows], when[rows])
        return Touches(link, what)

    def link_frames(self, joints: Array) -> tuple[Array, dict[str, Array]]:
        """Return the frames of links and objects, seen from the start of the machine's chain.

        Parameters
        ----------
        joints : (k, axes) array
            Joints, rad or mm.

        Returns
        -------
        links : (k, links, 4, 4) array
            Frames of `links`.
        seen_from : dict
            Frames (k, 4, 4) of part, nozzle, world and external links, by name.
        """
        links = self.cell.links(joints)
        carried = links[:, -1] @ (self.cell.robot.chain.flange @ self.cell.poses.carried)
        still = np.broadcast_to(self.cell.poses.station, carried.shape)
        platform, nozzle = (carried, still) if self._carries_part else (still, carried @ _TURNED)
        part_frame = platform @ frames.inverse(self.cell.poses.mount)
        seen_from = {
            PART: part_frame,
            NOZZLE: nozzle,
            WORLD: self.cell.world(joints) if self.cell.shapes.obstacles else part_frame,
        }
        adjacent = self.cell.external_link_frames(joints)
        seen_from |= {
            external_link.name: adjacent[:, k]
            for k, external_link in enumerate(self.cell.shapes.external_links)
        }
        return np.concatenate(
            [links, part_frame[:, None], nozzle[:, None], nozzle[:, None], adjacent], axis=1
        ), seen_from

    def _find_contacts(self, joints: Array, moment: Index) -> tuple[Index, Index]:
        links, seen_from = self.link_frames(joints)
        link = np.full(len(joints), NONE, dtype=np.int64)
        what = np.full(len(joints), NONE, dtype=np.int64)
        looked_at = sorted({number for group in self.groups for number in group.links})
        middles = {k: frames.transform_point(links[:, k], self.balls[k][0]) for k in looked_at}
        for object_number, group in enumerate(self.groups):
            frame = seen_from[group.seen_from]
            centre = frames.transform_point(frame, group.centre)
            back = frames.inverse(frame)
            for number in group.links:
                offset = middles[number] - centre
                within = self.balls[number][1] + group.radius + ABOUT_FACES
                rows = np.flatnonzero((link == NONE) & (dots(offset, offset) < within**2))
                if len(rows):
                    met = rows[
                        _meets(
                            group,
                            self.solids[number],
                            back[rows] @ links[rows, number],
                            moment[rows],
                        )
                    ]
                    link[met], what[met] = number, object_number
        untouched = np.flatnonzero(link == NONE)
        outer, inner = self.own_links.touches(links[untouched])
        link[untouched], what[untouched] = (
            outer,
            np.where(inner == NONE, NONE, len(self.groups) + inner),
        )
        return link, what


def _meets(group: Group, solids: Sequence[Solid], link_frame: Array, moment: Index) -> Mask:
    """Return whether (k,) solids of a link, with its frames (k, 4, 4), meet a group."""
    met = np.zeros(len(link_frame), dtype=bool)
    for solid in solids:
        tip = frames.transform_point(link_frame, solid.tip)
        axis = frames.rotate_vector(link_frame, solid.axis)
        # only solids near the ball are tested exactly
        low, high = float(np.min(solid.solid.low)), solid.solid.high
        off = tip - group.centre
        along = np.minimum(np.maximum(-dots(off, axis), low), high)
        off += along[:, None] * axis
        within = group.radius + solid.solid.radius + solid.solid.slope * high + ABOUT_FACES
        nearby = np.flatnonzero(~met & (dots(off, off) < within**2))
        met[nearby] = group.scene.find_touching(
            solid.solid, tip[nearby], axis[nearby], moment[nearby]
        )
    return met


def _nozzle_solid(cell: Cell) -> Solid:
    """Return the nozzle in the frame of its tip, as tested against bodies next to its deposit."""
    nozzle = cell.nozzle
    solid = depositing(
        0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0
    ).bodies
    return Solid(solid, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.zeros(3), solid.reach)


def _slices(corners: Array) -> list[Cylinder]:
    """Return cylinders around the hulls of corners (m, c, 3), grouped along their longest
    extent.
    """
    middle = corners.mean(axis=1)
    order = np.argsort(middle[:, int(np.ptp(middle, axis=0).argmax())], kind="stable")
    return [
        enclosing_cylinder(corners[slice_rows].reshape(-1, 3))
        for slice_rows in np.array_split(order, min(SLICES, len(order)))
    ]


# the tip's Z points out of a carried nozzle, the Z of the deposition point into a fixed one
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


def _group_of_body(body: Body, links: Sequence[int], seen_from: str = PART) -> Group:
    centre, radius = ball(body.vertices)
    scene = Scene(build_bodies([body], body.vertices, 0.0, max(LINK_PIECE, SHARE * 2.0 * radius)))
    return Group(scene, links, centre, radius, seen_from)


FIRST_ROWS = 8  # joint vectors tested first: their result excludes most of the others


def min_distance(contact: ArmContact, joints: ArrayLike, moment: Index, reach: float) -> float:
    """Return the smallest distance between links, or a carried part, and the tested objects.

    The nozzle, which deposits next to bodies, does not count; the contact's own clearance is
    subtracted.

    Parameters
    ----------
    contact : ArmContact
        The contact check.
    joints : (k, axes) array
        Joints, rad or mm; rows with NaN do not count.
    moment : (k,) int array
        Number of points of the deposit present.
    reach : float
        Largest distance of interest, mm.

    Returns
    -------
    float
        A lower bound of the distance, mm, at most `reach`; 0 on contact, also of links with
        each other.
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
