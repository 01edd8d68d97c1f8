# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads that rapids pass, and the part of the nozzle that is exempt near the ends where a rapid
starts or ends.

Where the nozzle retracts from the end of a bead or approaches the start of one, it touches the
deposit and its support, as while depositing: there its part below a height is exempt, less the
distance of the tip from that point. A cone withdrawn along its axis stays within the volume that
it had above that height, so nothing more needs an exemption, wherever the move leads.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from ..types import Array, Index, Mask
from .deposit import build_deposit
from .frustum import side_height
from .obstacles import Obstacles
from .scene import Nozzle, exempt_height, travelling
from .tolerances import ABOVE_FACES, CHORD


class ByNumbers:
    """A dataclass (frozen, without an == of its own) that is compared by the numbers and names in its fields."""

    @cached_property
    def _numbers(self) -> Hashable:
        return _numbers(self)

    def __eq__(self, other: object) -> bool:
        return (
            type(self) is type(other)
            and isinstance(other, ByNumbers)
            and self._numbers == other._numbers
        )

    def __hash__(self) -> int:
        return hash(self._numbers)


def _numbers(value: object) -> Hashable:
    """All numbers and names in a value, to be compared."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, (list, tuple)):
        return tuple(_numbers(entry) for entry in value)
    if is_dataclass(value):
        return tuple(_numbers(getattr(value, entry.name)) for entry in fields(value))
    assert isinstance(value, Hashable)
    return value


# length of the pieces into which the deposit is divided, mm, near nozzles and near links
GRAIN, LINK_GRAIN = 1.5, 5.0
HALVINGS = 6  # steps for the nozzle's length: accurate to a hundredth
REMEMBERED = 25_000  # maximum points of beads with cached ends: longer ones take too much memory


class Bead(Protocol):
    """The points of a toolpath's bead with unit build directions and tool axes (n, 3), width and
    height (n,) mm.

    Width and height are None if the bead has none.
    """

    @property
    def points(self) -> Array: ...
    @property
    def build(self) -> Array: ...
    @property
    def tool(self) -> Array: ...
    @property
    def width(self) -> Array | None: ...
    @property
    def height(self) -> Array | None: ...


class Beads(NamedTuple):
    """All points of beads in order: points, build directions and tool axes (m, 3), width and height (m,) mm, and whether
    each is the first of a bead (m,)."""

    points: Array
    build: Array
    tool: Array
    width: Array
    height: Array
    first: Mask

    @classmethod
    def of(cls, beads: Sequence[Bead], width: float, height: float) -> Beads:
        """Collect the points of beads.

        Parameters
        ----------
        beads : sequence of Bead
            The beads in print order.
        width, height : float
            Size of beads without their own, mm.

        Returns
        -------
        Beads
            All points in order.
        """
        points = np.concatenate([bead.points for bead in beads])
        counts = np.array([len(bead.points) for bead in beads])
        is_first = np.zeros(len(points), dtype=bool)
        is_first[np.cumsum(counts) - counts] = True
        return cls(
            points,
            np.concatenate([bead.build for bead in beads]),
            np.concatenate([bead.tool for bead in beads]),
            np.concatenate(
                [
                    np.full(len(bead.points), width) if bead.width is None else bead.width
                    for bead in beads
                ]
            ),
            np.concatenate(
                [
                    np.full(len(bead.points), height) if bead.height is None else bead.height
                    for bead in beads
                ]
            ),
            is_first,
        )

    def solid(self, grain: float = GRAIN) -> Obstacles:
        """Return the deposit in pieces of `grain` mm; each exists from the number of its last point
        on.
        """
        return build_deposit(
            self.points, self.build, self.width, self.height, self.first, grain=grain
        )


class Size(NamedTuple):
    """Radius of a nozzle's tip, tangent of its half angle, and its length, mm."""

    radius: float
    slope: float
    length: float


class _Ends(NamedTuple):
    """Bead ends by the number of printed points (m + 1).

    point: (m + 1, 3), NaN without an end. height: (m + 1,) mm of the nozzle that are exempt there.
    """

    point: Array
    height: Array


class BeadEnds:
    """The nozzle of a size on rapids between beads, and the deposit that these are."""

    def __init__(self, beads: Beads, size: Size) -> None:
        self._size = size
        self.deposit = deposit = beads.solid()
        starts = np.flatnonzero(beads.first)
        ends = np.append(starts[1:], len(beads.points)) - 1
        rows, when = np.concatenate([ends, starts]), np.concatenate([ends + 1, starts])
        heights = standing_heights(
            deposit, size, beads.points[rows], beads.tool[rows], beads.height[rows], when
        )
        ends_found = []
        for side in np.split(np.arange(len(rows)), 2):
            point = np.full((len(beads.points) + 1, 3), np.nan)
            height = np.zeros(len(beads.points) + 1)
            point[when[side]], height[when[side]] = beads.points[rows[side]], heights[side]
            ends_found.append(_Ends(point, height))
        self._ends = ends_found

    @classmethod
    def of(cls, beads: Beads, size: Size) -> BeadEnds:
        """Return the ends of the beads, computed once for planning the rapids and for checking them."""
        build = (
            _build_bead_ends if len(beads.points) <= REMEMBERED else _build_bead_ends.__wrapped__
        )
        return build(_Asked(beads, size))

    def nozzle(self, tip: Array, deposited: Index) -> Nozzle:
        """Return the nozzle on rapids, which leaves the last printed point and approaches the next.

        Against deposit the part that stays in it is exempt there; against bodies the part below the
        height at which the nozzle's side is one tip diameter from the point.

        Parameters
        ----------
        tip : (k, 3) array
            Tips of the nozzle in the part, mm.
        deposited : (k,) array of int
            How many points are printed at each.

        Returns
        -------
        Nozzle
            The nozzle of each row, against bodies and against deposit.
        """
        radius, slope, _ = self._size
        about = side_height(radius, slope) + ABOVE_FACES
        bodies, deposit = np.zeros(len(tip)), np.zeros(len(tip))
        for end in self._ends:
            distances = np.linalg.norm(tip - end.point[deposited], axis=1)
            bodies = np.fmax(bodies, about - distances)
            deposit = np.fmax(deposit, end.height[deposited] - distances)
        return Nozzle(
            travelling(*self._size, bodies).bodies, travelling(*self._size, deposit).deposit
        )


@dataclass(frozen=True, eq=False)
class _Asked(ByNumbers):
    """The inputs that determine the ends of beads, as a cache key."""

    beads: Beads
    size: Size


@lru_cache(maxsize=1)
def _build_bead_ends(question: _Asked) -> BeadEnds:
    return BeadEnds(question.beads, question.size)


def standing_heights(
    deposit: Obstacles, size: Size, tip: Array, axis: Array, height: Array, moment: Index
) -> Array:
    """Return the heights below which nozzles on points of beads are exempt from contact.

    The tip is in the bead whose end it is: up to the bead's height the nozzle may have deposit
    around. Where more of the nozzle is in the deposit (a nozzle that leans over its own bead,
    or a job that asks for no clearance) the height is as much: no move off the point avoids
    that, and the check of the depositing nozzle covers it. CHORD is added, as for any nozzle on
    rapids.

    Parameters
    ----------
    deposit : Obstacles
        The deposit.
    size : Size
        Radius, slope and length of the nozzle.
    tip : (k, 3) array
        Tips in part coordinates, mm.
    axis : (k, 3) array
        Tool axes, unit vectors.
    height : (k,) array
        Heights of the beads, mm.
    moment : (k,) int array
        Moments before which deposit counts.

    Returns
    -------
    (k,) array
        Heights over the tips, mm, at most the length of the nozzle.
    """
    distinct, distinct_rows = np.unique(height, return_inverse=True)
    exempt = np.array([exempt_height(size.radius, size.slope, float(value)) for value in distinct])
    heights = np.minimum(exempt[distinct_rows.ravel()], size.length)
    rows = np.flatnonzero(
        deposit.find_touching(travelling(*size, heights).deposit, tip, axis, moment)
    )
    low, high = heights[rows], np.full(len(rows), size.length)
    for _ in range(HALVINGS if len(rows) else 0):
        middle = 0.5 * (low + high)
        touched = deposit.find_touching(
            travelling(*size, middle).deposit, tip[rows], axis[rows], moment[rows]
        )
        low, high = np.where(touched, middle, low), np.where(touched, high, middle)
    heights[rows] = high
    standing: Array = np.minimum(heights + CHORD, size.length)
    return standing
