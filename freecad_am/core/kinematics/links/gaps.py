# SPDX-License-Identifier: LGPL-2.1-or-later
"""By how much links clear what they are looked at against, and how that changes while the joints move.

A gap is that between what `ArmContact` says to touch: 0 is where it begins to. Where two solids meet it is less than 0, by
how far they reach into each other along the direction in which something smaller than the link is nearest: exactly that
where a flat face or the side of a link is met, no less where edges are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...collision.cylinders_apart import nearest
from ...collision.frustum import Frustum
from ...geometry import frames
from ...geometry.columns import dots, lengths
from ...types import Array, Index, Mask
from .contact import PART, TORCH, ArmContact, Group
from .nozzle_body import NOZZLE
from .own import placed
from .rounds import Solid

OFF_RADIUS, OFF_END = (
    0.9,
    0.4,
)  # shares that what is smaller than a link may lack of its radius, and of its length at an end
SHARES = (0.2, 1.0)  # of these, one after the other
DEEPEST = 1e-3  # mm that two solids which meet reach into each other, at the least


@dataclass(frozen=True)
class Pair:
    """A link, by its number, and what it is looked at against: a group, or another link, by its number too. moved: by how
    many joints of the robot, from its base on, the link and the other are moved."""

    link: int
    against: Group | int
    moved: tuple[int, int]


@dataclass(frozen=True)
class Gaps:
    """Links of a robot in its cell, looked at as far as `reach` mm."""

    contact: ArmContact
    reach: float

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """All that can touch."""
        of_group = [
            Pair(link, group, (self._moved(link), self._moved_group(group)))
            for group in self.contact.groups
            for link in group.links
            if self.contact.solids[link]
        ]
        return (
            *of_group,
            *(Pair(outer, inner, (outer, inner)) for outer, inner in self.contact.own.pairs),
        )

    def _moved(self, link: int) -> int:
        axes = self.contact.cell.robot.chain.axes
        if link <= axes:
            return link
        carried = (PART,) if self.contact.cell.torch_stands else (NOZZLE, TORCH)
        return axes if self.contact.links[link] in carried else 0

    def _moved_group(self, group: Group) -> int:
        carried = PART if self.contact.cell.torch_stands else NOZZLE
        return self.contact.cell.robot.chain.axes if group.seen_from == carried else 0

    def at(self, joints: Array, rates: Array, moment: Index, wanted: Mask) -> tuple[Array, Array]:
        """With joints (k, axes) that change by rates (k, axes), where so many points (k,) of the deposit are there: the gaps
        of all pairs (p, k), mm, and how these change; `reach` and 0 of those that are not wanted (p, k), or farther off."""
        links, seen_from = self.contact.seen(joints)
        axes = self.contact.cell.machine.chain.frames(joints)
        gap, change = np.full(wanted.shape, self.reach), np.zeros(wanted.shape)
        for row, pair in enumerate(self.pairs):
            some = np.flatnonzero(wanted[row])
            some = some[self._near(pair, links[some], seen_from, some)]
            if not len(some):
                continue
            if isinstance(pair.against, Group):
                found = self._from_group(
                    pair, links[some], seen_from[pair.against.seen_from][some], moment[some]
                )
            else:
                found = self._from_link(pair, links[some])
            gap[row, some], normal, place = found
            motion = sum(
                sign
                * _velocity(
                    axes.directions[some],
                    axes.origins[some],
                    place,
                    rates[some],
                    moved,
                    self._sliding,
                )
                for sign, moved in zip((1.0, -1.0), pair.moved)
                if moved
            )
            change[row, some] = dots(normal, np.broadcast_to(motion, normal.shape))
        return gap, change

    @property
    def _sliding(self) -> Mask:
        return self.contact.cell.machine.chain.sliding

    def _near(self, pair: Pair, links: Array, seen_from: dict[str, Array], some: Index) -> Mask:
        """(k,) whether balls about both are within reach."""
        if isinstance(pair.against, Group):
            frame, other = (
                seen_from[pair.against.seen_from][some],
                (pair.against.centre, pair.against.radius),
            )
            ball, more = self.contact.balls[pair.link], 0.0
        else:
            own = self.contact.own
            frame, other = links[:, pair.against], own.balls[pair.against]
            ball, more = own.balls[pair.link], own.gap
        link = links[:, pair.link]
        away = (
            link[:, :3, :3] @ ball[0]
            + link[:, :3, 3]
            - frame[:, :3, :3] @ other[0]
            - frame[:, :3, 3]
        )
        near: Mask = lengths(away) - ball[1] - other[1] - more < self.reach
        return near

    def _from_group(
        self, pair: Pair, link: Array, frame: Array, moment: Index
    ) -> tuple[Array, Array, Array]:
        """Gaps (k,), directions (k, 3) in which they open and the places (k, 3) of the link where they are."""
        assert isinstance(pair.against, Group)
        seen = frames.inverse(frame) @ link[:, pair.link]
        found = [
            self._of_solid(pair.against, one, seen, moment)
            for one in self.contact.solids[pair.link]
        ]
        gap, normal, place = _least(found)
        turn = frame[:, :3, :3]
        return gap, _turned(turn, normal), _turned(turn, place) + frame[:, :3, 3]

    def _of_solid(
        self, group: Group, one: Solid, seen: Array, moment: Index
    ) -> tuple[Array, Array, Array]:
        turn = seen[:, :3, :3]
        tip, axis = turn @ one.tip + seen[:, :3, 3], turn @ one.axis
        gap, normal, place = group.scene.nearest(one.solid, tip, axis, moment, self.reach)
        for share in SHARES:
            met = np.flatnonzero(gap == 0.0)
            if len(met):
                gap[met], normal[met], place[met] = _reaching(
                    group, one.solid, share, tip[met], axis[met], moment[met]
                )
        gap[gap == 0.0] = -one.solid.reach
        return gap, normal, place

    def _from_link(self, pair: Pair, link: Array) -> tuple[Array, Array, Array]:
        assert isinstance(pair.against, int)
        own, found = self.contact.own, []
        for one in own.solids[pair.link]:
            for other in own.solids[pair.against]:
                there, way = nearest(
                    placed(one, link[:, pair.link]), placed(other, link[:, pair.against])
                )
                size = lengths(way)
                found.append(
                    (size - own.gap, way / np.where(size > 0.0, size, 1.0)[:, None], there + way)
                )
        gap, normal, place = _least(found)
        return np.minimum(gap, self.reach), np.where(gap[:, None] < self.reach, normal, 0.0), place


def _reaching(
    group: Group, solid: Frustum, share: float, tip: Array, axis: Array, moment: Index
) -> tuple[Array, Array, Array]:
    """Of solids (k,) that meet a group, as `Scene.nearest` tells it of what is smaller than they are by a share of what it
    may lack; the gaps those of the solids themselves along these directions. 0 where what is smaller meets the group too."""
    thin = share * OFF_RADIUS * (solid.radius + solid.slope * float(np.min(solid.low)))
    short = share * OFF_END * (solid.high - float(np.min(solid.low)))
    smaller = Frustum(solid.radius - thin, solid.slope, solid.low + short, solid.high - short)
    gap, normal, place = group.scene.nearest(smaller, tip, axis, moment, 2.0 * (thin + short))
    along = dots(normal, axis)
    across = normal - along[:, None] * axis
    size = lengths(across)
    gap = np.where(gap > 0.0, np.minimum(gap - thin * size - short * np.abs(along), -DEEPEST), 0.0)
    place = (
        place
        - thin * across / np.where(size > 0.0, size, 1.0)[:, None]
        - (short * np.sign(along))[:, None] * axis
    )
    return gap, normal, place


def _least(found: Sequence[tuple[Array, Array, Array]]) -> tuple[Array, Array, Array]:
    """Of gaps (k,), directions and places (k, 3) those of the least gap each."""
    which, each = np.argmin([gap for gap, _, _ in found], axis=0), np.arange(len(found[0][0]))
    gap, normal, place = (np.stack(columns)[which, each] for columns in zip(*found))
    return gap, normal, place


def _turned(turn: Array, vectors: Array) -> Array:
    """Vectors (k, 3) turned by matrices (k, 3, 3)."""
    return np.asarray(np.einsum("kij,kj->ki", turn, vectors))


def _velocity(
    directions: Array, origins: Array, place: Array, rates: Array, moved: int, sliding: Mask
) -> Array:
    """(k, 3) at what rate places (k, 3) move with the first `moved` joints, whose axes are at (k, axes, 3)."""
    total = np.zeros_like(place)
    for joint in range(moved):
        direction = directions[:, joint]
        way = direction if sliding[joint] else np.cross(direction, place - origins[:, joint])
        total += rates[:, joint, None] * way
    return total
