# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deposit near rapids, and the exempt part of the nozzle near the bead ends that rapids connect.

Where the nozzle retracts from the end of a bead or approaches the start of a bead, it touches the
deposit and its support, as on deposit moves. There the nozzle is exempt below a height, which
decreases by the distance between the tip and the bead end. A cone retracted along its axis stays
within the volume that it occupied above that height. No further exemption is needed, wherever the
move leads.
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
    """Base of frozen dataclasses (eq=False) that compare and hash the contents of their fields."""

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
    """Return all numbers and names in a value as a hashable key."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, (list, tuple)):
        return tuple(_numbers(entry) for entry in value)
    if is_dataclass(value):
        return tuple(_numbers(getattr(value, entry.name)) for entry in fields(value))
    assert isinstance(value, Hashable)
    return value


# mm; maximum length of deposit pieces for checks of nozzles and of links
GRAIN, LINK_GRAIN = 1.5, 5.0
HALVINGS = 6  # bisection steps for the exempt height; resolution 1/64 of the nozzle length
REMEMBERED = 25_000  # maximum number of points whose bead ends are cached, to limit memory


class Bead(Protocol):
    """A toolpath bead: points, build directions, tool axes (n, 3); width, height (n,); mm.

    Width and height are None if the bead has the default size.
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
    """All points of beads in print order.

    points: (m, 3) mm. build, tool: (m, 3) build directions and tool axes. width, height: (m,) mm.
    first: (m,) whether a point is the first of its bead.
    """

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
            Default bead size, mm.

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
        """Build the deposit in pieces of `grain` mm, whose moments are indices of end points."""
        return build_deposit(
            self.points, self.build, self.width, self.height, self.first, grain=grain
        )


class Size(NamedTuple):
    """Nozzle size: tip radius, mm; tangent of the half angle; length, mm."""

    radius: float
    slope: float
    length: float


class _Ends(NamedTuple):
    """Bead ends, indexed by the number of printed points.

    point: (m + 1, 3) mm, NaN without an end. height: (m + 1,) exempt height of the nozzle, mm.
    """

    point: Array
    height: Array


class BeadEnds:
    """Exempt heights of a nozzle at bead ends, and the deposit of the beads."""

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
        """Return the bead ends, cached so that planning and checking of rapids share the result."""
        build = (
            _build_bead_ends if len(beads.points) <= REMEMBERED else _build_bead_ends.__wrapped__
        )
        return build(_Asked(beads, size))

    def nozzle(self, tip: Array, deposited: Index) -> Nozzle:
        """Return the nozzle on rapids between the last printed point and the next point.

        Near both points part of the nozzle is exempt: for deposit, the part that stays in the
        deposit; for bodies, the part whose side is less than one tip diameter from the point.

        Parameters
        ----------
        tip : (k, 3) array
            Nozzle tips in part coordinates, mm.
        deposited : (k,) array of int
            Number of points printed before each tip position.

        Returns
        -------
        Nozzle
            Solids of each row to check against bodies and deposit.
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
    """Cache key: the inputs that determine the bead ends."""

    beads: Beads
    size: Size


@lru_cache(maxsize=1)
def _build_bead_ends(question: _Asked) -> BeadEnds:
    return BeadEnds(question.beads, question.size)


def standing_heights(
    deposit: Obstacles, size: Size, tip: Array, axis: Array, height: Array, moment: Index
) -> Array:
    """Return the heights below which nozzles at bead points are exempt from contact.

    The tip is inside the bead, so deposit may surround the nozzle up to the bead's height. The
    exempt height is greater if more of the nozzle is in the deposit, because the nozzle leans over
    its own bead or the job requires no clearance. No move away from the point avoids this contact,
    and the check of deposit moves covers it. CHORD is added, as for every nozzle on rapids.

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
        Moment of each tip; only earlier deposit counts.

    Returns
    -------
    (k,) array
        Heights above the tips, mm, at most the nozzle length.
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
