# SPDX-License-Identifier: LGPL-2.1-or-later
"""Print order of the beads of several solids, and start of beads about an axis.

The order around the axis (Dai 2020, section 5) spreads the heat. It deposits a layer of all solids on a base before the
next layer, ring by ring from inside out. The alternative order is solid by solid. A planar layer is deposited island by
island, nearest next, each from inside out.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..parameters.process import ProcessParameters
from ..toolpath import Bead, Layer
from ..types import Array, Index

NEIGHBOUR_COUNT = 8  # number of neighbours looked up first
DISTANCE_MARGIN = 1.0 - 1e-12  # ratio of distances beyond rounding errors


class RankedBead(NamedTuple):
    """A bead with its group, solid (numbered around the axis), layer and ring (counted from outside)."""

    group: int
    solid: int
    layer: int
    ring: int
    bead: Bead


class Course(NamedTuple):
    """Layers in print order.

    solids: (group, solid) of each bead, by layer. numbers: index in `layers`, by group, solid (0 if several solids are
    deposited together) and layer of that stack.
    """

    layers: tuple[Layer, ...]
    solids: tuple[tuple[tuple[int, int], ...], ...]
    numbers: Mapping[tuple[int, int, int], int] = MappingProxyType({})

    def number(self, group: int, solid: int, layer: int) -> int | None:
        """Return the index in `layers` of a layer of a stack.

        Parameters
        ----------
        group : int
            Index of the group.
        solid : int
            Index of the solid in its group.
        layer : int
            Index of the layer in the stack.

        Returns
        -------
        int or None
            The index; None if neither this layer nor a layer above it has beads.
        """
        return self.numbers.get((group, solid, layer), self.numbers.get((group, 0, layer)))


@dataclasses.dataclass
class IslandOrder:
    """Order of the islands of consecutive layers: nearest next, or as in the layer below.

    as_below: whether to repeat the order of the layer below, so that each island cools for the time of a layer. point:
    (3,) torch position, mm; None starts with the first island. below: centres (k, 3) of the islands of the previous
    layer, in print order; None if there is no layer below.
    """

    as_below: bool = False
    point: Array | None = None
    below: Array | None = None

    def order_islands(self, beads: Sequence[Bead], islands: Sequence[Sequence[int]]) -> list[Bead]:
        """Return the beads of a layer in print order; `islands` are the bead indices of each island, from inside out."""
        if self.as_below and islands:
            middle = np.array(
                [
                    np.vstack([beads[number].points for number in sorted(island)]).mean(axis=0)
                    for island in islands
                ]
            )
            order = list(range(len(islands)))
            if self.below is not None:
                order = np.argsort(_nearest(self.below, middle), kind="stable").tolist()
            self.below = middle[order]
            return [beads[number] for island in order for number in islands[island]]
        if not islands:
            return []
        starts = StartPoints(np.array([beads[island[0]].points[0] for island in islands]))
        ordered: list[Bead] = []
        for _ in islands:
            island = islands[starts.take(self.point)]
            ordered += [beads[number] for number in island]
            self.point = ordered[-1].points[-1]
        return ordered


def _nearest(points: Array, places: Array) -> Index:
    """Return for each place (n, 3) the index of the nearest point (k, 3), mm; of equally near ones the first."""
    neighbours = (
        cKDTree(points).query(places, min(NEIGHBOUR_COUNT, len(points)))[1].reshape(len(places), -1)
    )
    neighbours = np.sort(neighbours, axis=1)
    distances = np.linalg.norm(points[neighbours] - places[:, None], axis=2)
    return np.asarray(neighbours[np.arange(len(places)), np.argmin(distances, axis=1)])


class StartPoints:
    """Points taken one by one, without comparing all pairs."""

    def __init__(self, points: Array) -> None:
        """Create from points (n, 3), mm."""
        self._points = points
        self._is_left = np.ones(len(points), dtype=bool)
        self._left = np.arange(len(points))  # points of the tree, some of them taken
        self._tree = cKDTree(points)
        self._count = len(points)

    def take(self, place: Array | None) -> int:
        """Take the point nearest to a place (3,), mm, of equally near ones the first; None: the first point.

        Parameters
        ----------
        place : (3,) array or None
            Position of the torch, mm.

        Returns
        -------
        int
            Index of the point.
        """
        number = int(np.argmax(self._is_left)) if place is None else self._find(place)
        self._is_left[number] = False
        self._count -= 1
        return number

    def _find(self, place: Array) -> int:
        """Return the nearest point that is left."""
        if 2 * self._count < len(self._left):
            self._left = np.flatnonzero(self._is_left)
            self._tree = cKDTree(self._points[self._left])
        wanted = NEIGHBOUR_COUNT
        while True:
            distances, neighbours = self._tree.query(place, min(wanted, len(self._left)))
            numbers = self._left[np.atleast_1d(neighbours)]
            numbers = np.sort(numbers[self._is_left[numbers]])
            away = np.linalg.norm(self._points[numbers] - place, axis=1)
            all_known = wanted >= len(self._left)
            if all_known or (len(away) and away.min() < DISTANCE_MARGIN * np.max(distances)):
                return int(numbers[np.argmin(away)])
            wanted *= 4


def order_beads(beads: Sequence[RankedBead], order: str) -> Course:
    """Arrange beads in layers, group by group.

    Within a group, the order is layer by layer around the axis, or solid by solid ('feature'). A layer without beads
    stays as an empty layer, so that layers keep their indices.
    """

    def rank(ranked: RankedBead) -> tuple[int, ...]:
        if order == "feature":
            return ranked.group, ranked.solid, ranked.layer, -ranked.ring
        return ranked.group, ranked.layer, -ranked.ring, ranked.solid

    def layer_of(ranked: RankedBead) -> tuple[int, ...]:
        return (ranked.group, ranked.solid if order == "feature" else 0, ranked.layer)

    layers: list[list[RankedBead]] = []
    reached: dict[tuple[int, int], int] = {}  # current layer of each solid
    for ranked in sorted(beads, key=rank):
        solid = ranked.group, ranked.solid
        if reached.get(solid, ranked.layer) != ranked.layer:
            role = dataclasses.replace(ranked.bead.role, returns=True)
            ranked = ranked._replace(bead=dataclasses.replace(ranked.bead, role=role))
        reached[solid] = ranked.layer
        if not layers or layer_of(layers[-1][0]) != layer_of(ranked):
            layers.append([])
        layers[-1].append(ranked)
    layers_: list[Layer] = []
    solids: list[tuple[tuple[int, int], ...]] = []
    numbers: dict[tuple[int, int, int], int] = {}
    previous_stack, expected = None, 0
    for layer in layers:
        *stack, number = layer_of(layer[0])
        expected = expected if stack == previous_stack else 0
        for missing in range(expected, number):
            numbers[stack[0], stack[1], missing] = len(layers_)
            layers_.append(Layer(()))
            solids.append(())
        numbers[stack[0], stack[1], number] = len(layers_)
        layers_.append(Layer(tuple(ranked.bead for ranked in layer), first=stack != previous_stack))
        solids.append(tuple((ranked.group, ranked.solid) for ranked in layer))
        previous_stack, expected = stack, number + 1
    return Course(tuple(layers_), tuple(solids), numbers)


# ---- Start and direction of beads about an axis


def rising(process: ProcessParameters, index: int, closed: bool) -> bool:
    """Whether a bead runs with rising azimuth, counter-clockwise as seen from the tool.

    Open beads always do, unless the direction is alternate.

    Parameters
    ----------
    process : ProcessParameters
        Process with the direction.
    index : int
        Index of the bead.
    closed : bool
        Whether the bead is closed.

    Returns
    -------
    bool
        True for rising azimuth.
    """
    if process.direction == "alternate":
        return index % 2 == 0
    return not closed or process.direction != "clockwise"


def closed_azimuths(process: ProcessParameters, layer: int, segments: int, rising: bool) -> Array:
    """Return the azimuths of a full turn from the layer's seam.

    Parameters
    ----------
    process : ProcessParameters
        Process with the seam.
    layer : int
        Index of the layer.
    segments : int
        Number of segments.
    rising : bool
        Whether azimuths rise.

    Returns
    -------
    (segments + 1,) array
        Unwrapped azimuths, rad, over one full turn.
    """
    start = process.seam.angle + layer * process.seam.step
    turn = 2.0 * np.pi if rising else -2.0 * np.pi
    return np.asarray(start + turn * np.arange(segments + 1) / segments)


def open_azimuths(start: float, end: float, segments: int, rising: bool) -> Array:
    """Return the azimuths of a partial turn, in the direction of the bead.

    Parameters
    ----------
    start, end : float
        Limits of the azimuth, rad.
    segments : int
        Number of segments.
    rising : bool
        Whether the bead runs from start to end.

    Returns
    -------
    (segments + 1,) array
        Azimuths, rad.
    """
    azimuths = np.linspace(start, end, segments + 1)
    return azimuths if rising else azimuths[::-1]
