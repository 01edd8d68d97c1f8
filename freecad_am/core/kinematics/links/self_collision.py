# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions between links of a robot.

Three kinds of pairs are omitted:

- links that a joint connects;

- base and upper arm, and flange and the link two before it, because the stops of one axis keep them
apart however thick they are drawn;

- links that are too close in more than half of all positions within the limits, such as wrist links
with a clearance larger than the wrist.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...collision.bead_ends import ByNumbers
from ...collision.frustum import Frustum
from ...collision.separation import PlacedCylinders, axes_apart, nearer
from ...collision.tolerances import ABOUT_FACES
from ...geometry import frames
from ...geometry.columns import lengths
from ...geometry.cylinders import Cylinder
from ...geometry.step_count import spread_points
from ...types import Array, Index, Mask
from ..chain import Chain
from ..limits import Limits

NONE = -1  # no link


@dataclass(frozen=True, eq=False)
class Solid:
    """A solid of revolution that models a link or a piece of it.

    tip, axis: (3,) point and unit axis in the link frame. centre, radius: enclosing ball.
    """

    solid: Frustum
    tip: Array
    axis: Array
    centre: Array
    radius: float


def round_solid(cylinder: Cylinder, growth: float) -> Solid:
    """Return a cylinder enlarged by `growth` mm on all sides."""
    centre = 0.5 * (cylinder.start + cylinder.end)
    axis = (cylinder.end - cylinder.start) / cylinder.length
    solid = Frustum(cylinder.radius + growth, 0.0, -growth, cylinder.length + growth)
    return Solid(
        solid,
        cylinder.start,
        axis,
        centre,
        float(np.hypot(0.5 * cylinder.length + growth, cylinder.radius + growth)),
    )


def about_link(link: Sequence[Solid]) -> tuple[Array, float]:
    """Return a ball around the solids of a link.

    Parameters
    ----------
    link : sequence of Solid
        The solids.

    Returns
    -------
    centre : (3,) array
        Centre in the link frame, mm.
    radius : float
        Radius, mm; 0 without solids.
    """
    if not link:
        return np.zeros(3), 0.0
    centre, _ = ball(np.array([solid.centre for solid in link]))
    return centre, max(
        float(np.linalg.norm(solid.centre - centre)) + solid.radius for solid in link
    )


def ball(points: Array) -> tuple[Array, float]:
    """Return a ball around points, centred in their bounding box.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.

    Returns
    -------
    centre : (3,) array
        Centre, mm.
    radius : float
        Radius, mm.
    """
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return centre, float(np.linalg.norm(points - centre, axis=1).max())


POSITIONS, LEFT_OUT = (
    128,
    0.5,
)  # positions that decide which pairs to omit, and the maximum contact fraction of a tested pair
SAMPLE_STRIDE = 4  # stride of the positions to test first
REMEMBERED = 8  # robots with cached pairs: planning, rapids and final check of a job need them


@dataclass(frozen=True, eq=False)
class OwnLinks:
    """The robot links for tests against each other.

    solids: of each link in its frame, base first. balls: centre and radius of a ball around each
    link. gap: mm; closer links count as touching. pairs: tested links (outer, inner).
    """

    solids: tuple[tuple[Solid, ...], ...]
    balls: tuple[tuple[Array, float], ...]
    gap: float
    pairs: tuple[tuple[int, int], ...]

    @classmethod
    def of(
        cls, chain: Chain, limits: Limits, cylinders: Sequence[Sequence[Cylinder]], clearance: float
    ) -> OwnLinks:
        """Return the links of a robot, with the pairs to test.

        Parameters
        ----------
        chain : Chain
            The chain of the robot.
        limits : Limits
            Limits; those of the robot come first.
        cylinders : sequence of sequence of Cylinder
            Cylinders (axes + 1) in the link frames.
        clearance : float
            Required distance between links, mm.

        Returns
        -------
        OwnLinks
            The links and the pairs to test.
        """
        return _find_pairs(_Asked(chain, limits, cylinders, clearance))

    def touches(self, links: Array) -> tuple[Index, Index]:
        """Return the touching link pair nearest to the base.

        Parameters
        ----------
        links : (k, links, 4, 4) array
            Link frames, robot links first, starting at the base.

        Returns
        -------
        outer, inner : (k,) int array
            Indices of both links; NONE without contact.
        """
        outer, inner = np.full((2, len(links)), NONE, dtype=np.int64)
        middles = self._middles(links)
        for outer_link, inner_link in self.pairs:
            nearby = self._near(outer_link, inner_link, middles)
            nearby = nearby[outer[nearby] == NONE]
            if len(nearby):
                met = nearby[
                    self._touch(
                        outer_link, inner_link, links[nearby, outer_link], links[nearby, inner_link]
                    )
                ]
                outer[met], inner[met] = outer_link, inner_link
        return outer, inner

    def often(
        self, pair: tuple[int, int], links: Array, middles: Sequence[Array], share: float
    ) -> bool:
        """Whether two links touch in more than a fraction of the frames.

        For most pairs, the balls or the cylinder axes are close in fewer frames, so no exact test
        is needed.

        Parameters
        ----------
        pair : tuple[int, int]
            Indices of both links.
        links : (k, links, 4, 4) array
            Link frames.
        middles : sequence of (k, 3) array
            Ball centres of each link.
        share : float
            Fraction of the frames.

        Returns
        -------
        bool
            True if they touch more often.
        """
        max_count, rows = share * len(links), self._near(*pair, middles)
        for look in (self._close, self._touch):
            if len(rows) <= max_count:
                return False
            rows = rows[look(*pair, *(links[rows, number] for number in pair))]
        return len(rows) > max_count

    def _middles(self, links: Array) -> list[Array]:
        """Return the ball centres (k, 3) of each link."""
        return [
            frames.transform_point(links[:, k], middle) for k, (middle, _) in enumerate(self.balls)
        ]

    def _near(self, outer: int, inner: int, middles: Sequence[Array]) -> Index:
        """Return the frames in which the balls of two links are closer than `gap`."""
        separation = lengths(middles[outer] - middles[inner])
        return np.flatnonzero(separation - self.balls[outer][1] - self.balls[inner][1] < self.gap)

    def _close(self, outer: int, inner: int, a: Array, b: Array) -> Mask:
        """Return in which frames (k,) cylinder axes of two links are closer than radii and gap.

        a, b: (k, 4, 4) link frames.
        """
        close = np.zeros(len(a), dtype=bool)
        inner_cylinders = [
            place_cylinder(inner_cylinder, b) for inner_cylinder in self.solids[inner]
        ]
        for outer_cylinder in (
            place_cylinder(outer_cylinder, a) for outer_cylinder in self.solids[outer]
        ):
            for inner_cylinder in inner_cylinders:
                close |= (
                    axes_apart(outer_cylinder, inner_cylinder)
                    < self.gap + outer_cylinder.radius + inner_cylinder.radius
                )
        return close

    def _touch(self, outer: int, inner: int, a: Array, b: Array) -> Mask:
        """Return in which frames (k,) two links touch; a, b: (k, 4, 4) link frames."""
        touch = np.zeros(len(a), dtype=bool)
        inner_cylinders = [
            place_cylinder(inner_cylinder, b) for inner_cylinder in self.solids[inner]
        ]
        for outer_cylinder in (
            place_cylinder(outer_cylinder, a) for outer_cylinder in self.solids[outer]
        ):
            for inner_cylinder in inner_cylinders:
                rows = np.flatnonzero(~touch)
                if len(rows) == len(touch):
                    touch = nearer(outer_cylinder, inner_cylinder, self.gap)
                else:
                    touch[rows] = nearer(outer_cylinder.of(rows), inner_cylinder.of(rows), self.gap)
        return touch


@dataclass(frozen=True, eq=False)
class _Asked(ByNumbers):
    """The inputs that determine the link pairs of a robot, as a cache key."""

    chain: Chain
    limits: Limits
    cylinders: Sequence[Sequence[Cylinder]]
    clearance: float


@lru_cache(REMEMBERED)
def _find_pairs(query: _Asked) -> OwnLinks:
    solids = tuple(
        tuple(round_solid(cylinder, 0.0) for cylinder in link) for link in query.cylinders
    )
    last_link = len(solids) - 1
    stopped = {(2, 0), (last_link, last_link - 2)}
    all_pairs = [
        (outer, inner)
        for outer in range(2, last_link + 1)
        for inner in range(outer - 1)
        if (outer, inner) not in stopped
    ]
    gap = query.clearance + 2.0 * ABOUT_FACES
    untested = OwnLinks(solids, tuple(about_link(link) for link in solids), gap, ())
    links = query.chain.links(positions(query.limits, query.chain.axes))
    if not len(links):
        return OwnLinks(solids, untested.balls, gap, tuple(all_pairs))
    # for most pairs, a few positions show that they are far below this fraction
    middles = untested._middles(links)
    sampled_middles = [middle[::SAMPLE_STRIDE] for middle in middles]
    usual = {
        pair
        for pair in all_pairs
        if untested.often(pair, links[::SAMPLE_STRIDE], sampled_middles, 0.5 * LEFT_OUT)
        and untested.often(pair, links, middles, LEFT_OUT)
    }
    return OwnLinks(
        solids, untested.balls, gap, tuple(pair for pair in all_pairs if pair not in usual)
    )


def positions(limits: Limits, axes: int) -> Array:
    """Return joints spread evenly and deterministically over the limits of the first axes.

    Parameters
    ----------
    limits : Limits
        Limits; continuous axes cover one turn.
    axes : int
        Number of axes.

    Returns
    -------
    (k, axes) array
        Joints within the coupled limits, rad.
    """
    continuous = limits.continuous[:axes]
    low = np.where(continuous, -np.pi, limits.lower[:axes])
    high = np.where(continuous, np.pi, limits.upper[:axes])
    samples = low + spread_points(POSITIONS, axes) * (high - low)
    coupled = samples @ limits.coefficients[:, :axes].T
    return np.asarray(
        samples[((coupled >= limits.coupled_lower) & (coupled <= limits.coupled_upper)).all(axis=1)]
    )


def place_cylinder(solid: Solid, frame: Array) -> PlacedCylinders:
    """Place the cylinder of a solid at link poses.

    Parameters
    ----------
    solid : Solid
        The solid in its link frame.
    frame : (k, 4, 4) array
        Link poses, mm.

    Returns
    -------
    PlacedCylinders
        The cylinder at each pose.
    """
    turn = frame[:, :3, :3]
    return PlacedCylinders(
        turn @ solid.tip + frame[:, :3, 3], turn @ solid.axis, solid.solid.high, solid.solid.radius
    )
