# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links of a robot against each other.

Left out are links that a joint connects; base and upper arm, and the flange and the link two before it, which the stops of
one axis keep apart, however plump both are drawn; and pairs that come too near in more than half of all positions that the
limits allow, as the links of a wrist do to a clearance wider than the wrist. Nothing else is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...collision.by_numbers import ByNumbers
from ...collision.cylinders_apart import PlacedCylinders, axes_apart, nearer
from ...collision.tolerances import ABOUT_FACES
from ...geometry import frames
from ...geometry.columns import lengths
from ...geometry.cylinders import Cylinder
from ...geometry.spread import spread_points
from ...types import Array, Index, Mask
from ..chain import Chain
from ..limits import Limits
from .rounds import NONE, Solid, about_link, of_cylinder

POSITIONS, LEFT_OUT = (
    128,
    0.5,
)  # looked at to see which pairs are left out, and the share at which they are not yet
EVERY = 4  # one position in so many is looked at first
REMEMBERED = 8  # robots whose pairs are known: a job asks while planning, for its rapids, and when all is looked at again


@dataclass(frozen=True, eq=False)
class OwnLinks:
    """solids: of each link, base first, in its frame; balls: centre and radius of one about these; gap: mm, links that are
    nearer to each other touch; pairs: of links (outer, inner) that are looked at."""

    solids: tuple[tuple[Solid, ...], ...]
    balls: tuple[tuple[Array, float], ...]
    gap: float
    pairs: tuple[tuple[int, int], ...]

    @classmethod
    def of(
        cls, chain: Chain, limits: Limits, cylinders: Sequence[Sequence[Cylinder]], clearance: float
    ) -> OwnLinks:
        """The links of a robot of these cylinders, each (axes + 1) in the frame of the link, that are to be kept clearance
        mm apart; of the limits the first ones are its own."""
        return _found(_Asked(chain, limits, cylinders, clearance))

    def touches(self, links: Array) -> tuple[Index, Index]:
        """Of frames (k, links, 4, 4), the first of them the robot's own from the base on: the outer (k,) and the inner (k,)
        of two links that touch, the pair nearest to the base; NONE in both where none does."""
        outer, inner = np.full((2, len(links)), NONE, dtype=np.int64)
        middles = self._middles(links)
        for one, other in self.pairs:
            near = self._near(one, other, middles)
            near = near[outer[near] == NONE]
            if len(near):
                met = near[self._touch(one, other, links[near, one], links[near, other])]
                outer[met], inner[met] = one, other
        return outer, inner

    def often(
        self, pair: tuple[int, int], links: Array, middles: Sequence[Array], share: float
    ) -> bool:
        """Whether two links touch with more than a share of frames. Most are near each other with fewer, by their balls or
        the axes of their cylinders: then that is known without a closer look."""
        most, rows = share * len(links), self._near(*pair, middles)
        for look in (self._close, self._touch):
            if len(rows) <= most:
                return False
            rows = rows[look(*pair, *(links[rows, number] for number in pair))]
        return len(rows) > most

    def _middles(self, links: Array) -> list[Array]:
        """(k, 3) where the middles of the balls are, of each link."""
        return [
            frames.transform_point(links[:, k], middle) for k, (middle, _) in enumerate(self.balls)
        ]

    def _near(self, outer: int, inner: int, middles: Sequence[Array]) -> Index:
        """With which frames the balls of two links are nearer than the links may be."""
        away = lengths(middles[outer] - middles[inner])
        return np.flatnonzero(away - self.balls[outer][1] - self.balls[inner][1] < self.gap)

    def _close(self, outer: int, inner: int, a: Array, b: Array) -> Mask:
        """(k,) whether axes of cylinders of two links, with frames (k, 4, 4) of each, are as near as these are wide."""
        close = np.zeros(len(a), dtype=bool)
        others = [placed(other, b) for other in self.solids[inner]]
        for one in (placed(one, a) for one in self.solids[outer]):
            for other in others:
                close |= axes_apart(one, other) < self.gap + one.radius + other.radius
        return close

    def _touch(self, outer: int, inner: int, a: Array, b: Array) -> Mask:
        """(k,) whether two links touch, with frames (k, 4, 4) of each."""
        touch = np.zeros(len(a), dtype=bool)
        others = [placed(other, b) for other in self.solids[inner]]
        for one in (placed(one, a) for one in self.solids[outer]):
            for other in others:
                rows = np.flatnonzero(~touch)
                if len(rows) == len(touch):
                    touch = nearer(one, other, self.gap)
                else:
                    touch[rows] = nearer(one.of(rows), other.of(rows), self.gap)
        return touch


@dataclass(frozen=True, eq=False)
class _Asked(ByNumbers):
    """What the links of a robot follow from; the same numbers are the same question."""

    chain: Chain
    limits: Limits
    cylinders: Sequence[Sequence[Cylinder]]
    clearance: float


@lru_cache(REMEMBERED)
def _found(asked: _Asked) -> OwnLinks:
    solids = tuple(
        tuple(of_cylinder(cylinder, 0.0) for cylinder in link) for link in asked.cylinders
    )
    last = len(solids) - 1
    stopped = {(2, 0), (last, last - 2)}
    every = [
        (one, other)
        for one in range(2, last + 1)
        for other in range(one - 1)
        if (one, other) not in stopped
    ]
    gap = asked.clearance + 2.0 * ABOUT_FACES
    found = OwnLinks(solids, tuple(about_link(link) for link in solids), gap, ())
    links = asked.chain.links(positions(asked.limits, asked.chain.axes))
    if not len(links):
        return OwnLinks(solids, found.balls, gap, tuple(every))
    # most pairs are seen by a few positions to be far below that share
    middles = found._middles(links)
    some = [middle[::EVERY] for middle in middles]
    usual = {
        pair
        for pair in every
        if found.often(pair, links[::EVERY], some, 0.5 * LEFT_OUT)
        and found.often(pair, links, middles, LEFT_OUT)
    }
    return OwnLinks(solids, found.balls, gap, tuple(pair for pair in every if pair not in usual))


def positions(limits: Limits, axes: int) -> Array:
    """(k, axes) joints spread evenly over all that the limits of so many axes allow, the same each time; of axes without end
    over one turn."""
    continuous = limits.continuous[:axes]
    low = np.where(continuous, -np.pi, limits.lower[:axes])
    high = np.where(continuous, np.pi, limits.upper[:axes])
    found = low + spread_points(POSITIONS, axes) * (high - low)
    coupled = found @ limits.coefficients[:, :axes].T
    return np.asarray(
        found[((coupled >= limits.coupled_lower) & (coupled <= limits.coupled_upper)).all(axis=1)]
    )


def placed(solid: Solid, frame: Array) -> PlacedCylinders:
    """The cylinder that a solid is, with frames (k, 4, 4) of its link."""
    turn = frame[:, :3, :3]
    return PlacedCylinders(
        turn @ solid.tip + frame[:, :3, 3], turn @ solid.axis, solid.solid.high, solid.solid.radius
    )
