# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contacts of robot links with nozzle, platform, bodies, obstacles and earlier deposit.

Contacts of nozzle or part with obstacles are included.

Links are cylinders around their drawn shape. Bodies are their triangles and, if closed, their
inside. Beads have their width and height. So no contact is missed, as far as the links are as
drawn. The flange load is not tested against the last two links, which hold it and hardly move
relative to it. Fixed objects are not tested against the base. A moving part counts as complete from
the start: cylinders around its bodies and beads. The nozzle is tested exactly against bodies,
without clearance, because it deposits next to them. The nozzle holder is tested if
`cell.nozzle.shape` describes it. Links of positioner and track move with their axes. They are
tested against robot, nozzle, torch and obstacles. These pairs are omitted:

- objects on the floor against each other, including the base of a robot without a track, because
they never move;

- base and link 1 against the carriage, which the base is fixed to and link 1 rotates on; and the
base against the rail, which it slides along. Link 1 is tested against the rail;

- the part against the last two links below it. It is tested against the other links of a
positioner, carriage and rail, if either moves;

- links of positioners against each other, which their own stops keep apart.

Robot links against each other: `own_links`. The floor is tested if it is an obstacle, cables and
hoses if the torch file includes them.
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
    """Return the nozzle in its tip frame, as a polygonal cone around the round one."""
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
OWN_PREFIX = "link "  # precedes the axis name of a touched link
LINKS_MORE = 4  # number of entries of `links` besides the axes and before the external links
PIECE = 4096  # joint vectors per batch
LINK_PIECE, SHARE = (
    50.0,
    0.01,
)  # maximum triangle edge in link tests: mm, or fraction of the body size if larger
SLICES = 8  # number of cylinders around a moving deposit


@dataclass(frozen=True, eq=False)
class Touches:
    """Contacts for k joint vectors.

    what: (k,) index in `ArmContact.names` of the first object touched. link: (k,) index in
    `ArmContact.links` of the touching link nearest to the base. Both are NONE without contact.
    """

    link: Index
    what: Index

    @property
    def any(self) -> Mask:
        """Whether each joint vector has a contact, (k,)."""
        return np.asarray(self.link != NONE)


@dataclass(frozen=True, eq=False)
class Group:
    """An object and the indices of the links tested against it.

    centre, radius: enclosing ball. seen_from: frame of the object: part, nozzle, world or an
    external link.
    """

    scene: Scene
    links: Sequence[int]
    centre: Array
    radius: float
    seen_from: str = PART


@dataclass(frozen=True, eq=False)
class ArmContact:
    """A robot in its cell.

    cylinders: of each robot link (axes + 1) in the link frame, base first. bodies, deposit: in part
    coordinates. clearance: mm; closer links count as touching; a negative value allows this
    penetration. holders: whether to test the last two links also against the part that they carry,
    except its platform.

    names: objects that can be touched, ending with the robot links. links: touching links: base,
    axes, part, nozzle, torch and external links. groups: the objects. solids: of each of `links` in
    its frame. balls: centre and radius of a ball around the solids of each link.
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
        """The robot links, tested against each other."""
        return OwnLinks.of(self.cell.robot.chain, self.cell.limits, self.cylinders, self.clearance)

    @property
    def _carries_part(self) -> bool:
        return self.cell.torch_stands

    def _links(self, carried: bool) -> range:
        """Return the links tested against carried or against fixed objects."""
        axes = self.cell.robot.chain.axes
        return range(axes - 1) if carried else range(1, axes + 1)

    @property
    def _holders(self) -> list[int]:
        """The links that carry the part, if they are tested against the part."""
        axes = self.cell.robot.chain.axes
        return [axes - 1, axes] if self.holders and self._carries_part else []

    @property
    def _torch(self) -> list[int]:
        """The link index of the torch, if there is one."""
        return [] if self.cell.shapes.torch is None else [self.cell.robot.chain.axes + 3]

    @property
    def _movers(self) -> list[int]:
        """The links that move in the world.

        These include the base on a track, and the part, or the nozzle and its torch.
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

        If the external link carries the robot, these include robot links at least two joints away;
        otherwise robot links that move relative to the external link. Nozzle and torch are
        included, and the part except against the last two links below the part.
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
        """Return the track links tested against moving or against fixed objects of the world."""
        first_external = self.cell.robot.chain.axes + LINKS_MORE
        return [
            first_external + k
            for k, external_link in enumerate(self.cell.shapes.external_links)
            if external_link.carries == ROBOT and (external_link.axis != STANDS or moves)
        ]

    def _part_cylinders(self, around: Sequence[Body]) -> list[Cylinder]:
        """Return cylinders around the part and its platform, if they may touch obstacles."""
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
        """Return the link contacts for joints (k, axes); NaN joints have no contact.

        moment: (k,) number of deposit points printed; all by default.
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
        """Return the frames of links and objects in the first frame of the machine chain.

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
    """Return which link frames (k, 4, 4) make the solids of a link touch a group, (k,)."""
    met = np.zeros(len(link_frame), dtype=bool)
    for solid in solids:
        tip = frames.transform_point(link_frame, solid.tip)
        axis = frames.rotate_vector(link_frame, solid.axis)
        # test only solids near the ball exactly
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
    """Return the nozzle in its tip frame, as tested against bodies next to its deposit."""
    nozzle = cell.nozzle
    solid = depositing(
        0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0
    ).bodies
    return Solid(solid, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.zeros(3), solid.reach)


def _slices(corners: Array) -> list[Cylinder]:
    """Return cylinders around the hulls of corners (m, c, 3), grouped along the longest extent."""
    middle = corners.mean(axis=1)
    order = np.argsort(middle[:, int(np.ptp(middle, axis=0).argmax())], kind="stable")
    return [
        enclosing_cylinder(corners[slice_rows].reshape(-1, 3))
        for slice_rows in np.array_split(order, min(SLICES, len(order)))
    ]


# the tip Z points out of a carried nozzle; the Z of the deposition point points into a fixed one
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


def _group_of_body(body: Body, links: Sequence[int], seen_from: str = PART) -> Group:
    centre, radius = ball(body.vertices)
    scene = Scene(build_bodies([body], body.vertices, 0.0, max(LINK_PIECE, SHARE * 2.0 * radius)))
    return Group(scene, links, centre, radius, seen_from)


FIRST_ROWS = 8  # joint vectors to test first; the result excludes most others


def min_distance(contact: ArmContact, joints: ArrayLike, moment: Index, reach: float) -> float:
    """Return the minimum distance of links, or of a carried part, from the tested objects.

    The nozzle is excluded, because it deposits next to bodies. The clearance of `contact` is
    subtracted.

    Parameters
    ----------
    contact : ArmContact
        The contact check.
    joints : (k, axes) array
        Joints, rad or mm; rows with NaN are ignored.
    moment : (k,) int array
        Number of deposit points printed.
    reach : float
        Maximum distance of interest, mm.

    Returns
    -------
    float
        Lower bound of the distance, mm, at most `reach`; 0 on contact, including contact between
        links.
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
    """Return lower bounds (k,) of the distance of a solid from a group, mm.

    They follow from the balls around both. frame, link: (k, 4, 4) of group and link.
    """
    centre = frame[:, :3, :3] @ group.centre + frame[:, :3, 3]
    offset = link[:, :3, :3] @ solid.centre + link[:, :3, 3] - centre
    return np.asarray(np.linalg.norm(offset, axis=1) - solid.radius - group.radius)


def _distance(group: Group, solid: Solid, link_frame: Array, moment: Index, reach: float) -> float:
    """Return the minimum distance of a solid over link frames (k, 4, 4), mm."""
    turn = link_frame[:, :3, :3]
    tip, axis = turn @ solid.tip + link_frame[:, :3, 3], turn @ solid.axis
    return float(group.scene.distance(solid.solid, tip, axis, moment, reach).min())
