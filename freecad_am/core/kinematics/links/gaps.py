# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gaps between links and the objects tested against them, and their rates during joint motion.

A gap is 0 where contact begins as defined by `ArmContact`. Where two solids overlap it is negative:
the penetration along the direction in which a reduced link is nearest. This is exact for contact at
a flat face or the side of a link, and an upper bound at edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...collision.frustum import Frustum
from ...collision.separation import nearest
from ...geometry import frames
from ...geometry.columns import dots, lengths
from ...types import Array, Index, Mask
from .contact import NOZZLE, PART, TORCH, ArmContact, Group
from .self_collision import Solid, place_cylinder

OFF_RADIUS, OFF_END = (
    0.9,
    0.4,
)  # relative reduction of the radius, and of the length at each end, of a reduced link
SHARES = (0.2, 1.0)  # fractions of these reductions to try in turn
MIN_DEPTH = 1e-3  # mm; minimum penetration of two touching solids


@dataclass(frozen=True)
class Pair:
    """A link and its counterpart.

    link: index. against: a group, or the index of another link. moved: number of robot joints,
    starting at the base, that move the link and the counterpart.
    """

    link: int
    against: Group | int
    moved: tuple[int, int]


@dataclass(frozen=True)
class Gaps:
    """The gaps of the links of a robot in its cell, up to `reach` mm."""

    contact: ArmContact
    reach: float

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """Return all pairs of links and objects that may touch.

        Returns
        -------
        tuple of Pair
            Links against groups, then links against links.
        """
        of_group = [
            Pair(link, group, (self._moving_joints(link), self._moved_group(group)))
            for group in self.contact.groups
            for link in group.links
            if self.contact.solids[link]
        ]
        return (
            *of_group,
            *(Pair(outer, inner, (outer, inner)) for outer, inner in self.contact.own_links.pairs),
        )

    def _moving_joints(self, link: int) -> int:
        axes = self.contact.cell.robot.chain.axes
        if link <= axes:
            return link
        carried = (PART,) if self.contact.cell.torch_stands else (NOZZLE, TORCH)
        return axes if self.contact.links[link] in carried else 0

    def _moved_group(self, group: Group) -> int:
        carried = PART if self.contact.cell.torch_stands else NOZZLE
        return self.contact.cell.robot.chain.axes if group.seen_from == carried else 0

    def gaps_and_rates(
        self, joints: Array, rates: Array, moment: Index, is_requested: Mask
    ) -> tuple[Array, Array]:
        """Return the gaps of pairs and their rates during joint motion.

        Parameters
        ----------
        joints : (k, axes) array
            Joints, rad or mm.
        rates : (k, axes) array
            Joint rates, per unit of a parameter.
        moment : (k,) int array
            Number of deposit points printed.
        is_requested : (p, k) bool array
            Pairs to compute.

        Returns
        -------
        gap : (p, k) array
            Gaps, mm; `reach` for pairs that are not requested or farther apart.
        rate : (p, k) array
            Rates, mm per unit; 0 for these pairs.
        """
        links, seen_from = self.contact.link_frames(joints)
        axes = self.contact.cell.machine.chain.frames(joints)
        gap, change = np.full(is_requested.shape, self.reach), np.zeros(is_requested.shape)
        for row, pair in enumerate(self.pairs):
            rows = np.flatnonzero(is_requested[row])
            rows = rows[self._near(pair, links[rows], seen_from, rows)]
            if not len(rows):
                continue
            if isinstance(pair.against, Group):
                pair_gaps = self._from_group(
                    pair, links[rows], seen_from[pair.against.seen_from][rows], moment[rows]
                )
            else:
                pair_gaps = self._from_link(pair, links[rows])
            gap[row, rows], normal, position = pair_gaps
            motion = sum(
                sign
                * _velocity(
                    axes.directions[rows],
                    axes.origins[rows],
                    position,
                    rates[rows],
                    moved,
                    self._sliding,
                )
                for sign, moved in zip((1.0, -1.0), pair.moved)
                if moved
            )
            change[row, rows] = dots(normal, np.broadcast_to(motion, normal.shape))
        return gap, change

    @property
    def _sliding(self) -> Mask:
        return self.contact.cell.machine.chain.sliding

    def _near(self, pair: Pair, links: Array, seen_from: dict[str, Array], rows: Index) -> Mask:
        """Return in which frames (k,) the enclosing balls are within reach."""
        if isinstance(pair.against, Group):
            frame = seen_from[pair.against.seen_from][rows]
            other_ball = (pair.against.centre, pair.against.radius)
            ball, extra = self.contact.balls[pair.link], 0.0
        else:
            own_links = self.contact.own_links
            frame, other_ball = links[:, pair.against], own_links.balls[pair.against]
            ball, extra = own_links.balls[pair.link], own_links.gap
        link = links[:, pair.link]
        offset = (
            link[:, :3, :3] @ ball[0]
            + link[:, :3, 3]
            - frame[:, :3, :3] @ other_ball[0]
            - frame[:, :3, 3]
        )
        is_near: Mask = lengths(offset) - ball[1] - other_ball[1] - extra < self.reach
        return is_near

    def _from_group(
        self, pair: Pair, link: Array, frame: Array, moment: Index
    ) -> tuple[Array, Array, Array]:
        """Return gaps (k,), and their opening directions and positions on the link (k, 3)."""
        assert isinstance(pair.against, Group)
        link_frame = frames.inverse(frame) @ link[:, pair.link]
        solid_gaps = [
            self._solid_gap(pair.against, solid, link_frame, moment)
            for solid in self.contact.solids[pair.link]
        ]
        gap, normal, position = _smallest_gap(solid_gaps)
        turn = frame[:, :3, :3]
        return gap, _rotate(turn, normal), _rotate(turn, position) + frame[:, :3, 3]

    def _solid_gap(
        self, group: Group, solid: Solid, link_frame: Array, moment: Index
    ) -> tuple[Array, Array, Array]:
        turn = link_frame[:, :3, :3]
        tip, axis = turn @ solid.tip + link_frame[:, :3, 3], turn @ solid.axis
        gap, normal, position = group.scene.nearest(solid.solid, tip, axis, moment, self.reach)
        for share in SHARES:
            met = np.flatnonzero(gap == 0.0)
            if len(met):
                gap[met], normal[met], position[met] = _penetration_gap(
                    group, solid.solid, share, tip[met], axis[met], moment[met]
                )
        gap[gap == 0.0] = -solid.solid.reach
        return gap, normal, position

    def _from_link(self, pair: Pair, link: Array) -> tuple[Array, Array, Array]:
        assert isinstance(pair.against, int)
        own_links, solid_gaps = self.contact.own_links, []
        for solid_a in own_links.solids[pair.link]:
            for solid_b in own_links.solids[pair.against]:
                foot, separation = nearest(
                    place_cylinder(solid_a, link[:, pair.link]),
                    place_cylinder(solid_b, link[:, pair.against]),
                )
                size = lengths(separation)
                solid_gaps.append(
                    (
                        size - own_links.gap,
                        separation / np.where(size > 0.0, size, 1.0)[:, None],
                        foot + separation,
                    )
                )
        gap, normal, position = _smallest_gap(solid_gaps)
        return (
            np.minimum(gap, self.reach),
            np.where(gap[:, None] < self.reach, normal, 0.0),
            position,
        )


def _penetration_gap(
    group: Group, solid: Frustum, share: float, tip: Array, axis: Array, moment: Index
) -> tuple[Array, Array, Array]:
    """Return the penetration of solids (k,) that touch a group, as negative gaps.

    The directions are those of `Scene.nearest` for solids reduced by a fraction `share` of the
    allowed reduction. The gap is 0 where the reduced solid also touches the group.
    """
    thin = share * OFF_RADIUS * (solid.radius + solid.slope * float(np.min(solid.low)))
    short = share * OFF_END * (solid.high - float(np.min(solid.low)))
    smaller = Frustum(solid.radius - thin, solid.slope, solid.low + short, solid.high - short)
    gap, normal, position = group.scene.nearest(smaller, tip, axis, moment, 2.0 * (thin + short))
    along = dots(normal, axis)
    across = normal - along[:, None] * axis
    size = lengths(across)
    gap = np.where(
        gap > 0.0, np.minimum(gap - thin * size - short * np.abs(along), -MIN_DEPTH), 0.0
    )
    position = (
        position
        - thin * across / np.where(size > 0.0, size, 1.0)[:, None]
        - (short * np.sign(along))[:, None] * axis
    )
    return gap, normal, position


def _smallest_gap(candidates: Sequence[tuple[Array, Array, Array]]) -> tuple[Array, Array, Array]:
    """Return the smallest of several gaps (k,), with its direction and position (k, 3)."""
    best = np.argmin([gap for gap, _, _ in candidates], axis=0)
    row = np.arange(len(candidates[0][0]))
    gap, normal, position = (np.stack(columns)[best, row] for columns in zip(*candidates))
    return gap, normal, position


def _rotate(turn: Array, vectors: Array) -> Array:
    """Rotate vectors (k, 3) by matrices (k, 3, 3)."""
    return np.asarray(np.einsum("kij,kj->ki", turn, vectors))


def _velocity(
    directions: Array, origins: Array, position: Array, rates: Array, moved: int, sliding: Mask
) -> Array:
    """Return velocities (k, 3) of positions (k, 3) that the first `moved` joints move.

    directions, origins: (k, axes, 3) of the joint axes.
    """
    total = np.zeros_like(position)
    for joint in range(moved):
        direction = directions[:, joint]
        velocity = (
            direction if sliding[joint] else np.cross(direction, position - origins[:, joint])
        )
        total += rates[:, joint, None] * velocity
    return total
