# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contours whose bead widths adapt to the thickness of a region, so that they fill it without gaps.

After T. Kuipers, E. Doubrovski, J. Wu, C. Wang, "A Framework for Adaptive Width Control of Dense
Contour-Parallel Toolpaths in Fused Deposition Modeling", Computer-Aided Design 128 (2020): the
thickness at each point of the medial axis determines the number of beads across and their widths.
Where a branch of the axis runs into a corner, the corner takes over the beads of the thicker part.
Where the paper uses trapezoids between the border and a Voronoi diagram, this module assigns bead
counts and widths to spokes, the segments from the border to the medial axis.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..geometry.curves.plane_curve import arcs, length, shorten_end
from ..geometry.regions.region import Region, select_significant, select_simplified
from ..geometry.regions.several import grow_regions
from ..geometry.regions.spokes import Spokes, find_spokes
from ..types import Array, Index, Mask
from .centre import (
    ROUND_END,
    Beads,
    PlaneCurve,
    covered_regions,
    long_enough,
    start_curve,
)

MAX_WEDGE = math.radians(70.0)  # opening angle of a wedge; the sides of a wider wedge form a corner
GAP_WEDGE = math.radians(120.0)  # opening angle limit of wedges in a gap between beads
STEP = 0.5  # in spacings; distance between spokes
RADIUS_TOLERANCE = 0.01  # in spacings; tolerance of the radii of spokes
# in spacings; minimum length of the axis in a thick part for a centreline bead, otherwise pairs
# fill it
SHORTEST_CENTRE = 1.0
# minimum jump of the touching point at a fork: FORK_RATIO times the distance along the axis plus
# FORK spacings
FORK_RATIO, FORK = 4.0, 0.5
SUMMIT = 0.1  # in spacings; closer summits are merged
BRIDGE = 0.99  # fraction of the radius at the ends; a stretch that narrows more ends in a corner
JUNCTION = 0.5  # in spacings; summits this close to a bridge belong to its junction
# in spacings; a shorter arm with two beads gets one bead if a neighbouring arm has one
SHORT_FORK = 1.0
SHORT_CHANGE = 2.0  # in spacings; shorter changes of the bead count are ignored
RAMP = 1.5  # in spacings; length along a bead over which a change of the bead count takes effect
MOUTH = 0.35  # in spacings; distance by which beads of a thick part turn back before a thin part
SHARE_TOLERANCE = 0.02  # tolerance of bead shares in the linear interpolation between points
FRONT = 1e-6  # relative tolerance of the space at which a pair begins
# fraction of the minimum space of a pair; range of space before the pair begins over which the
# outer beads return to their own width
TIP = 0.5
LENGTH_TOLERANCE = 1e-9  # in spacings; tolerance of equal lengths
SHORTEST_PIECE = 0.1  # in spacings; shorter pieces of the axis are ends of branches into corners
# fraction of the end radius; clearance between a round end, which has no extra volume, and the bead
# at which it ends
CAP = 0.25
HAIR = 0.5  # fraction of the minimum bead width; narrower parts of gaps come from rounding
MEET = 0.8  # in spacings; approximate width of beads at which other beads end
JOINT = 1.3  # in steps between spokes; closer ends of centreline beads are joined


@dataclass(frozen=True)
class BeadLaw:
    """Bead count and bead widths as a function of thickness.

    Parameters
    ----------
    width, spacing : float
        Width and spacing of beads of nominal width, mm.
    narrowest, widest : float
        Minimum and maximum bead share.
    """

    width: float
    spacing: float
    narrowest: float
    widest: float

    def usual_radius(self, counts: Array | Index | int) -> Array:
        """Return half the thickness that beads of nominal width fill.

        Parameters
        ----------
        counts : (n,) array of int or int
            Bead counts across the thickness.

        Returns
        -------
        (n,) array
            Half thicknesses, mm.
        """
        return np.asarray(0.5 * (self.width + (np.asarray(counts) - 1.0) * self.spacing))

    def count_beads(self, radii: Array, in_pairs: Mask) -> Index:
        """Return the bead counts for given thicknesses.

        Parameters
        ----------
        radii : (n,) array
            Half thicknesses, mm.
        in_pairs : (n,) array of bool
            Whether a bead along the centreline is excluded.

        Returns
        -------
        (n,) array of int
            Bead counts; even if `in_pairs` is set, 0 where not even the narrowest bead fits.
        """
        highest = int(np.max(radii, initial=0.0) / (0.5 * self.spacing)) + 3
        counts = np.searchsorted(self._limits(np.arange(highest), 1), radii, side="right")
        pairs = np.arange(2, highest + 2, 2)
        even = 2 + 2 * np.searchsorted(self._limits(pairs, 2), radii, side="right")
        return np.where(in_pairs & (counts > 1), even, counts).astype(np.intp)

    def pair_room(self, pair: int) -> float:
        """Return half the thickness, mm, that a pair of beads of nominal width fills; pair 0 is outermost."""
        return 0.5 * (self.width + self.spacing) if pair == 0 else self.spacing

    def least_radius(self, count: int) -> float:
        """Return the minimum half thickness, mm, for a bead count."""
        return float(self._limits(np.array([count - 1]), 1)[0])

    def _limits(self, counts: Index, step: int) -> Array:
        """Return the half thicknesses (n,), mm, at which bead counts rise from `counts` by `step`."""
        few, many = self.usual_radius(counts), self.usual_radius(counts + step)
        limits = np.where(counts <= 4, np.sqrt(np.maximum(few, 0.0) * many), 0.5 * (few + many))
        limits = np.minimum(limits, self._radius_at(counts, self.widest))
        return np.where(
            counts == 0,
            0.5 * self.width * self.narrowest,
            np.maximum(limits, self._radius_at(counts + step, self.narrowest)),
        )

    def _radius_at(self, counts: Index, share: float) -> Array:
        """Return the half thicknesses (n,), mm, filled if `share` is the bead share of inner beads."""
        usual = self.usual_radius(counts)
        return usual + (share - 1.0) * self._variable_radius(counts)

    def _variable_radius(self, counts: Index) -> Array:
        """Return the part of the half thicknesses (n,), mm, that beads of variable width fill.

        With up to five beads all widths vary; otherwise only those of the inner four or five beads.
        """
        inner = np.where(np.asarray(counts) % 2 == 0, 2.0, 2.5) * self.spacing
        return np.where(np.asarray(counts) <= 5, self.usual_radius(counts), inner)

    def shares(self, counts: Index, radii: Array) -> Array:
        """Return the bead shares (n,) of the inner beads."""
        room = np.maximum(self._variable_radius(counts), LENGTH_TOLERANCE)
        share = 1.0 + (radii - self.usual_radius(counts)) / room
        return np.asarray(np.clip(share, self.narrowest, self.widest))

    def depths(self, pair: int, counts: Index, radii: Array) -> tuple[Array, Array]:
        """Return the depths and widths of a pair of beads.

        Parameters
        ----------
        pair : int
            Index of the pair, 0 for the outermost.
        counts : (n,) array of int
            Bead counts.
        radii : (n,) array
            Half thicknesses, mm.

        Returns
        -------
        depths : (n,) array
            Distances of the bead centrelines from the border, mm.
        shares : (n,) array
            Bead shares.
        """
        share = self.shares(counts, radii)
        usual_pairs = np.where(counts <= 5, 0, counts // 2 - 2)
        outermost = np.where(usual_pairs > 0, 1.0, share)
        variable = np.maximum(pair - usual_pairs, 0)  # beads of variable width outside this pair
        depth = 0.5 * self.width * outermost + self.spacing * (pair - variable + share * variable)
        # at the boundary one neighbour has nominal width; its half of the spacing does not vary
        between = (pair >= usual_pairs) & (usual_pairs > 0)
        depth += np.where(between, 0.5 * self.spacing * (share - 1.0), 0.0)
        return depth, np.where(pair < usual_pairs, 1.0, share)


class _Transition(NamedTuple):
    """Change of the bead count along the axis.

    spokes: (m,) spokes at which depths and widths change gradually. low, high: spokes on either
    side of the change. weights: (m,) fraction of the change from `low` to `high` at each spoke, up
    to 1; at most 0 at the first spoke beyond the ramp.
    """

    spokes: Index
    low: int
    high: int
    weights: Array


class _Thickness(NamedTuple):
    """Thickness and bead count at each spoke.

    radii: (n,) half the thickness that determines the bead count, mm. counts: (n,) bead counts.
    is_central: (n,) whether the axis runs between two sides there. transitions: changes of the bead
    count.
    """

    radii: Array
    counts: Index
    is_central: Mask
    transitions: list[_Transition]

    def depths(self, law: BeadLaw, pair: int) -> tuple[Array, Array]:
        """Return `BeadLaw.depths` of all spokes (n,), smoothed at changes of the bead count."""
        depths, shares = law.depths(pair, self.counts, self.radii)
        ramped_depths, ramped_shares = depths.copy(), shares.copy()
        total = np.zeros(len(depths))
        for spokes, _, _, weights in self.transitions:
            np.add.at(total, spokes, np.maximum(weights, 0.0))
        for spokes, low, high, weights in self.transitions:
            weights = np.maximum(weights, 0.0) / np.maximum(total[spokes], 1.0)
            if min(self.counts[low], self.counts[high]) >= 2 * pair + 2:
                ramped_depths[spokes] += weights * (depths[high] - depths[low])
                ramped_shares[spokes] += weights * (shares[high] - shares[low])
        return ramped_depths, ramped_shares


class _Pair(NamedTuple):
    """Pair of beads.

    number: index, 0 for the outermost. is_there: (n,) spokes at which the pair exists. is_early:
    (n,) spokes at which the pair exists before the bead count changes. depths: (n,) depths of the
    centrelines, mm. shares: (n,) bead shares. room: (n,) half the space that outer pairs leave, mm.
    least: (n,) minimum half space for the pair, mm.
    """

    number: int
    is_there: Mask
    is_early: Mask
    depths: Array
    shares: Array
    room: Array
    least: Array

    def free(self, radii: Array, spacing: float) -> Array:
        """Return half the space (n,), mm, inside this pair for half thicknesses (n,), mm."""
        return radii - self.depths - 0.5 * spacing * self.shares


class _Crossing(NamedTuple):
    """End of a bead between two spokes.

    middle: (2,) point on the axis, mm. foot, direction: (2,) of the interpolated spoke. depth: of
    the bead along this spoke, mm. share: bead share.
    """

    middle: Array
    foot: Array
    direction: Array
    depth: float
    share: float


def adapt_contours(region: Region, beads: Beads, law: BeadLaw) -> list[PlaneCurve]:
    """Fill a region with contours, centreline beads, and beads in the remaining gaps.

    Parameters
    ----------
    region : Region
        Plane region, mm.
    beads : Beads
        Options; spacing and width are taken from `law`.
    law : BeadLaw
        Bead count and bead widths.

    Returns
    -------
    list of PlaneCurve
        Beads with bead shares; empty if no bead fits.
    """
    curves = _adapt(region, beads, law, MAX_WEDGE, SHORTEST_CENTRE * law.spacing)
    return curves + fill_gaps(region, curves, beads, law) if curves else []


def adapt_walls(region: Region, beads: Beads, law: BeadLaw, walls: int) -> list[PlaneCurve]:
    """Place the outermost contours of `adapt_contours`, and all beads where no more beads fit.

    Parameters
    ----------
    region : Region
        Plane region, mm.
    beads : Beads
        Options; spacing and width are taken from `law`.
    law : BeadLaw
        Bead count and bead widths.
    walls : int
        Number of contours. The space inside them stays open where more than twice this number of
        beads and a centreline bead fit across.

    Returns
    -------
    list of PlaneCurve
        Beads with bead shares; empty if no bead fits.
    """
    return _adapt(region, beads, law, MAX_WEDGE, SHORTEST_CENTRE * law.spacing, walls)


def fill_gaps(
    region: Region, curves: Sequence[PlaneCurve], beads: Beads, law: BeadLaw
) -> list[PlaneCurve]:
    """Place beads of adaptive width in the gaps that beads leave in a region.

    Parameters
    ----------
    region : Region
        Plane region, mm.
    curves : sequence of PlaneCurve
        Beads of the region, at least one.
    beads : Beads
        Options; spacing and width are taken from `law`.
    law : BeadLaw
        Bead count and bead widths.

    Returns
    -------
    list of PlaneCurve
        Beads of kind 'closing' with bead shares.
    """
    least = law.narrowest * law.width
    covered = covered_regions(curves, law.width, beads.chord_error)
    closing: list[PlaneCurve] = []
    gaps = region.without(covered, wide=least, least_area=least * beads.shortest)
    for gap in drop_hairs(gaps, least, beads.chord_error):
        middles = _adapt(gap, beads, law, GAP_WEDGE, SHORTEST_CENTRE * law.spacing)
        closing += [replace(curve, kind="closing", ring=0) for curve in middles]
    return closing


def drop_hairs(gaps: Sequence[Region], least: float, chord_error: float) -> list[Region]:
    """Drop hairs from gaps: narrow parts along the sides of beads, which come from rounding.

    The medial axis of a hair is not sound.

    Parameters
    ----------
    gaps : sequence of Region
        Gaps between beads, mm.
    least : float
        Minimum bead width, mm. Parts narrower than half of it, and farther than twice of it from
        wider parts, are hairs.
    chord_error : float
        Chord error of arcs, mm.

    Returns
    -------
    list of Region
        The gaps without hairs, mm; a gap without hairs is unchanged.
    """
    parts: list[Region] = []
    for gap in gaps:
        cores = gap.grown(-0.5 * HAIR * least, chord_error)
        if not cores:
            continue
        corners = np.concatenate(gap.borders())
        away = np.min([core.nearest(corners)[1] for core in cores], axis=0)
        if away.max() <= 2.0 * least:
            parts.append(gap)
        else:
            parts += gap.common(grow_regions(cores, least, chord_error))
    return parts


def _adapt(
    region: Region,
    beads: Beads,
    law: BeadLaw,
    max_wedge: float,
    shortest_centre: float,
    walls: int | None = None,
) -> list[PlaneCurve]:
    """Fill a region with contours and centreline beads.

    max_wedge: opening angle of a wedge, rad; the sides of a wider wedge form a corner.
    shortest_centre: minimum length of the axis for a centreline bead, mm. walls: as in
    `adapt_walls`; None: all contours.
    """
    reach = 2.0 * float(np.hypot(*(region.borders()[0] - region.middle).T).max())
    turn = 2.0 * math.acos(max(1.0 - beads.chord_error / max(reach, beads.chord_error), 0.0))
    spokes = find_spokes(
        region,
        STEP * law.spacing,
        RADIUS_TOLERANCE * law.spacing,
        min(max(turn, 0.02), 0.5),
        reach,
    )
    thickness = _thickness(spokes, law, max_wedge, shortest_centre)
    spokes, thickness, pairs = _pairs(spokes, thickness, law)
    curves: list[PlaneCurve] = []
    for pair in pairs[:walls]:
        curves += _rings(spokes, thickness, pair, beads, law)
    curves += _centres(spokes, thickness, pairs, law, beads, walls)
    return [start_curve(curve, beads) for curve in long_enough(curves, beads.shortest)]


def _pairs(
    spokes: Spokes, thickness: _Thickness, law: BeadLaw
) -> tuple[Spokes, _Thickness, list[_Pair]]:
    """Determine the pairs of beads, add spokes where pairs begin, and update the bead counts.

    Before the bead count changes, outer pairs become narrower. The next pair begins where they
    leave enough space for two beads of minimum width. Up to this point the outer pair fills the
    space, unless there is a centreline bead.
    """
    pairs: list[_Pair] = []
    number, numbers = 0, thickness.counts // 2
    divided = 0  # index of the last pair with spokes at its starts
    while number < int(numbers.max(initial=0)):
        counts = thickness.counts
        depths, shares = thickness.depths(law, number)
        is_there = counts >= 2 * number + 2
        is_early = np.zeros(len(counts), dtype=bool)
        usual_room = law.pair_room(number)
        room, least = thickness.radii, np.full(len(counts), law.narrowest * usual_room)
        if number > 0:
            room = pairs[-1].free(thickness.radii, law.spacing)
            phase = np.where(counts // 2 == number, _phase(thickness, 2 * number + 2), -np.inf)
            changes = phase > -np.inf
            after, share = _fronts(
                spokes.following,
                changes,
                ((room / least, 1.0), (room / least, 1.0 - TIP), (phase, 0.0)),
            )
            if len(after) and number > divided:
                divided = number
                spokes, thickness = _divided(spokes, thickness, after, share)
                pairs, number, numbers = [], 0, thickness.counts // 2
                continue
            is_early = (phase >= -FRONT) & (room >= (1.0 - FRONT) * least)
            is_kept = changes & (room < (1.0 - FRONT) * least) & (counts % 2 == 0)
            left = np.maximum(least - (least - room) / TIP, 0.0)
            pairs[-1] = _widened(pairs[-1], np.where(is_kept, room - left, 0.0), law)
            shares = np.where(is_early, np.minimum(room / usual_room, law.widest), shares)
            depths = np.where(is_early, thickness.radii - 0.5 * room, depths)
            is_there |= is_early
            numbers = np.where(is_early, number + 1, numbers)
        pairs.append(_Pair(number, is_there, is_early, depths, shares, room, least))
        number += 1
    counts = np.where(numbers > thickness.counts // 2, 2 * numbers, thickness.counts)
    return spokes, thickness._replace(counts=counts), pairs


def _fronts(
    following: Index, is_before: Mask, limits: Sequence[tuple[Array, float]]
) -> tuple[Index, Array]:
    """Find where values (n,) cross a level between two spokes before a change of the bead count.

    limits: pairs of values and level. is_before: (n,) spokes before a change. Returns the spokes
    (k,) before the crossings and the positions (k,) of the crossings as fractions of the distance
    to the following spoke. Crossings at a spoke do not count.
    """
    first = np.flatnonzero(is_before & is_before[following])
    after, share = [], []
    for values, level in limits:
        start, end = values[first], values[following[first]]
        is_between = np.minimum(start, end) < level - FRONT
        is_between &= np.maximum(start, end) > level + FRONT
        after.append(first[is_between])
        share.append((level - start[is_between]) / (end - start)[is_between])
    places, shares = np.concatenate(after), np.concatenate(share)
    order = np.lexsort((shares, places))
    return places[order], shares[order]


def _divided(
    spokes: Spokes, thickness: _Thickness, after: Index, share: Array
) -> tuple[Spokes, _Thickness]:
    """Insert interpolated spokes, with their thickness and bead counts.

    after: (k,) spokes, ascending, after which a spoke is inserted. share: (k,) position of the new
    spoke as a fraction of the distance to the following spoke.
    """
    ends = spokes.following[after]

    def column(values: Array) -> Array:
        part = share if values.ndim == 1 else share[:, None]
        return np.insert(
            values, after + 1, (1.0 - part) * values[after] + part * values[ends], axis=0
        )

    places = np.arange(len(spokes.radii))
    moved = places + np.searchsorted(after, places)
    following = np.arange(1, len(places) + len(after) + 1)
    is_last = spokes.following != places + 1
    following[np.append(moved[1:], len(following))[is_last] - 1] = moved[spokes.following[is_last]]
    directions = column(spokes.directions)
    is_jump = np.abs(spokes.opposite[ends] - spokes.opposite[after]) > 1.0
    positions = column(spokes.positions)
    opposite, touching = column(spokes.opposite), column(spokes.touching)
    new = after + 1 + np.arange(len(after))
    is_end = (
        spokes.positions[ends] < spokes.positions[after]
    )  # positions begin anew at the start of a border
    positions[new[is_end]] = spokes.positions[after[is_end]]
    opposite[new[is_jump]] = spokes.opposite[after[is_jump]]
    touching[new[is_jump]] = spokes.touching[after[is_jump]]
    transitions = []
    for members, low, high, weights in thickness.transitions:
        everywhere = np.zeros(len(places))
        everywhere[members] = weights
        is_member = np.zeros(len(places), dtype=bool)
        is_member[members] = True
        is_inside = is_member[after] & is_member[ends]
        transitions.append(
            _Transition(
                np.r_[moved[members], new[is_inside]],
                int(moved[low]),
                int(moved[high]),
                np.r_[weights, column(everywhere)[new[is_inside]]],
            )
        )
    return (
        Spokes(
            column(spokes.feet),
            directions / np.hypot(*directions.T)[:, None],
            column(spokes.radii),
            following,
            positions,
            opposite,
            touching,
        ),
        _Thickness(
            column(thickness.radii),
            np.insert(thickness.counts, after + 1, thickness.counts[after]),
            np.insert(thickness.is_central, after + 1, thickness.is_central[after]),
            transitions,
        ),
    )


def _phase(thickness: _Thickness, count: int) -> Array:
    """Return the weight (n,) of changes to at least `count` beads, as in `_Transition`.

    The weight is minus infinity at spokes outside such changes.
    """
    phase = np.full(len(thickness.counts), -np.inf)
    for spokes, low, high, weights in thickness.transitions:
        if thickness.counts[low] < count <= thickness.counts[high]:
            phase[spokes] = np.maximum(phase[spokes], weights)
    return phase


def _widened(pair: _Pair, added: Array, law: BeadLaw) -> _Pair:
    """Widen the beads of a pair by `added` (n,) mm, up to the maximum width."""
    shares = np.maximum(np.minimum(pair.shares + added / law.spacing, law.widest), pair.shares)
    depths = pair.depths + 0.5 * law.spacing * (shares - pair.shares)
    return pair._replace(depths=depths, shares=shares)


def _thickness(
    spokes: Spokes, law: BeadLaw, max_wedge: float, shortest_centre: float
) -> _Thickness:
    """Determine the thickness at each spoke; corners take the thickness of the part they adjoin."""
    radii, following = spokes.radii, spokes.following
    middles = spokes.middles
    rise = radii[following] - radii
    distance = np.hypot(*(middles[following] - middles).T)
    tiny = LENGTH_TOLERANCE * law.spacing
    is_steep = np.abs(rise) > np.maximum(math.sin(0.5 * max_wedge) * distance, tiny)
    is_level = ~is_steep & (distance > tiny)
    forks = _forks(spokes, distance, law.spacing)
    is_level &= ~forks
    is_level &= ~_in_short_runs(is_level, distance, following, shortest_centre)
    is_central = np.zeros(len(radii), dtype=bool)
    is_central[is_level] = True
    is_central[following[is_level]] = True
    deciding, in_pairs, summit = _carry_uphill(spokes, is_central, SUMMIT * law.spacing)
    counts = law.count_beads(deciding, in_pairs)
    even = law.count_beads(deciding, np.ones(len(radii), dtype=bool))
    levelled = _Thickness(deciding, counts, is_central, [])
    _level_short_changes(levelled, even, forks, distance, following, law)
    bridges = _bridge(radii, counts, distance, following, is_central, SHORT_CHANGE * law.spacing)
    _level_junctions(counts, middles, summit, is_central, bridges, JUNCTION * law.spacing)
    follows = ~is_central & is_central[summit]
    counts[follows], deciding[follows] = counts[summit[follows]], deciding[summit[follows]]
    thickness = _Thickness(deciding, counts, is_central, [])
    return thickness._replace(transitions=_transitions(spokes, thickness, distance, summit, law))


def _transitions(
    spokes: Spokes, thickness: _Thickness, distance: Array, summit: Index, law: BeadLaw
) -> list[_Transition]:
    """Find changes of the bead count, and of the width where a thin part opens into a thick part.

    A change extends over `RAMP` along the axis on the side with fewer beads, and into the corners
    that belong to this side. If the thin part has less space than the beads of the thick part need,
    the change extends into the mouth instead, see `_mouth`.
    """
    counts, deciding, is_central = thickness.counts, thickness.radii, thickness.is_central
    transitions = []
    for cycle in _cycles(spokes.following):
        for run in _runs(is_central[cycle]):
            if len(run) < len(cycle):
                run = np.r_[run[0] - 1, run, (run[-1] + 1) % len(cycle)]
            members = cycle[run]
            arc = np.r_[0.0, np.cumsum(distance[members[:-1]])]
            jumps = np.diff(counts[members]) != 0
            jumps |= ~is_central[members[1:]] | ~is_central[members[:-1]]
            for k in np.flatnonzero(jumps).tolist():
                here, ahead_ = ((counts[j], deciding[j]) for j in members[k : k + 2])
                falls = here > ahead_
                low, high = members[[k + 1, k] if falls else [k, k + 1]].tolist()
                if is_central[low] and not is_central[high]:
                    mouth = _mouth(spokes, thickness, cycle, low, high, -1 if falls else 1, law)
                    if mouth is not None:
                        transitions.append(mouth)
                        continue
                ahead = arc - arc[k + 1] if falls else arc[k] - arc
                length_of_few = _stretch_length(counts[members], arc, k if not falls else k + 1)
                ramp = min(RAMP * law.spacing, 0.5 * length_of_few)
                near = _reaches(is_central[members], ahead, ramp)
                ramped, weights = members[near], 1.0 - ahead[near] / max(ramp, 1e-300)
                corner = np.flatnonzero(~is_central & np.isin(summit, ramped))
                order = np.argsort(ramped)
                source = order[np.searchsorted(ramped[order], summit[corner])]
                transitions.append(
                    _Transition(np.r_[ramped, corner], low, high, np.r_[weights, weights[source]])
                )
    return transitions


def _reaches(is_central: Mask, ahead: Array, ramp: float) -> Mask:
    """Return a mask of the spokes within `ramp` mm of a change along the axis, plus the next spoke.

    ahead: (n,) distances from the change, mm, negative on the side with more beads.
    """
    near = is_central & (ahead >= 0.0) & (ahead < ramp)
    beyond = is_central & (ahead >= ramp)
    if near.any() and beyond.any():
        near[np.flatnonzero(beyond)[np.argmin(ahead[beyond])]] = True
    return near


def _mouth(
    spokes: Spokes,
    thickness: _Thickness,
    cycle: Index,
    low: int,
    high: int,
    step: int,
    law: BeadLaw,
) -> _Transition | None:
    """Return the change from a thin to a thick part along the spokes of the mouth.

    The spokes of the mouth get longer towards the thick part. Along the mouth, beads of the thin
    part widen to the width of the beads of the thick part. Returns None if the thin part has enough
    space for that width.

    low, high: adjacent spokes of the thin and the thick part. step: 1 if `high` follows `low`, else
    -1.
    """
    pairs = int(thickness.counts[low]) // 2
    if not pairs or pairs > int(thickness.counts[high]) // 2:
        return None
    depths, shares = law.depths(
        pairs - 1, thickness.counts[[low, high]], thickness.radii[[low, high]]
    )
    needed = float(depths[1] + 0.5 * law.spacing * shares[1])
    room = float(spokes.radii[low])
    order = np.roll(cycle, -int(high - cycle[0]))
    order = order if step > 0 else np.roll(order[::-1], 1)
    radii = spokes.radii[order]
    is_out = thickness.is_central[order] | (radii >= needed)
    is_out[1:] |= radii[1:] < radii[:-1]
    count = int(np.argmax(is_out)) if is_out.any() else 0
    if needed <= room or not count:
        return None
    weights = np.clip((needed - radii[:count]) / (needed - room), 0.0, 1.0)
    return _Transition(order[:count], high, low, weights)


def _level_short_changes(
    thickness: _Thickness,
    even: Index,
    forks: Mask,
    distance: Array,
    following: Index,
    law: BeadLaw,
) -> None:
    """Remove short changes of the bead count, in place.

    A short stretch of the axis takes the bead count of its neighbours. An odd count between a lower
    and a higher count is replaced by the count in `even`.
    """
    for cycle in _cycles(following):
        for run in _runs(thickness.is_central[cycle]):
            members = cycle[run]
            for branch in np.split(members, np.flatnonzero(forks[members]) + 1):
                _level_branch(thickness, even, distance, branch, law)


def _level_branch(
    thickness: _Thickness, even: Index, distance: Array, branch: Index, law: BeadLaw
) -> None:
    """Apply `_level_short_changes` to a branch of the axis between two forks."""
    counts = thickness.counts
    cuts = [0, *(np.flatnonzero(np.diff(counts[branch])) + 1).tolist(), len(branch)]
    stretches = [branch[a:b] for a, b in zip(cuts, cuts[1:]) if b > a]
    lengths = [
        float(distance[branch[a : b - 1]].sum())
        + sum(
            _share_of_number(thickness, branch[inside], branch[outside], law)
            * float(distance[branch[min(inside, outside)]])
            for inside, outside in ((a, a - 1), (b - 1, b))
            if 0 <= outside < len(branch)
        )
        for a, b in zip(cuts, cuts[1:])
        if b > a
    ]
    # Judge every stretch by the original counts: the two sides of the axis are walked in opposite
    # directions and must get the same numbers of beads.
    before = [int(counts[stretch[0]]) for stretch in stretches]
    for number, (stretch, stretch_length) in enumerate(zip(stretches, lengths)):
        if stretch_length >= SHORT_CHANGE * law.spacing:
            continue
        here = before[number]
        low, high = (
            before[beside] if 0 <= beside < len(stretches) else here
            for beside in (number - 1, number + 1)
        )
        if (here - low) * (here - high) > 0:
            counts[stretch] = min(low, high) if here < low else max(low, high)
        elif here % 2 == 1 and here > 1 and len(stretches) > 1:
            counts[stretch] = even[stretch]
        elif here == 2 and min(low, high) == 1:
            longest = max(lengths[max(number - 1, 0) : number + 2])
            if stretch_length < SHORT_FORK * law.spacing and longest >= SHORT_CHANGE * law.spacing:
                counts[stretch] = 1
        elif here == 1 < max(low, high):
            counts[stretch[thickness.radii[stretch] >= law.narrowest * law.width]] = 2


def _share_of_number(thickness: _Thickness, inside: int, outside: int, law: BeadLaw) -> float:
    """Return the fraction of the way between two spokes at which the bead count changes."""
    most = int(max(thickness.counts[inside], thickness.counts[outside]))
    return _share_to_limit(thickness, inside, outside, law.least_radius(most), 0.5)


def _share_to_limit(
    thickness: _Thickness, inside: int, outside: int, limit: float, level: float
) -> float:
    """Return the fraction of the way between two spokes at which half the thickness is `limit` mm.

    Returns `level` if the thickness is equal at both spokes.
    """
    start, end = float(thickness.radii[inside]), float(thickness.radii[outside])
    if start == end:
        return level
    return min(max((limit - start) / (end - start), 0.0), 1.0)


def _stretch_length(counts: Index, arc: Array, member: int) -> float:
    """Return the length, mm, of the stretch around `member` with a constant bead count."""
    changes = np.flatnonzero(counts != counts[member])
    before, after = changes[changes < member], changes[changes > member]
    start = before[-1] + 1 if len(before) else 0
    end = after[0] - 1 if len(after) else len(counts) - 1
    return float(arc[end] - arc[start])


def _bridge(
    radii: Array, counts: Index, distance: Array, following: Index, is_central: Mask, longest: float
) -> Index:
    """Mark short stretches between two central stretches as central, and return their spokes.

    Such stretches occur where ribs cross. Stretches that run into a corner do not count.
    """
    bridges = [np.zeros(0, dtype=np.intp)]
    for cycle in _cycles(following):
        for run in _runs(~is_central[cycle]):
            if len(run) == len(cycle):
                continue
            ends = cycle[[run[0] - 1, (run[-1] + 1) % len(cycle)]]
            members = cycle[run]
            is_corner = radii[members].min() < BRIDGE * radii[ends].min()
            is_short = distance[np.r_[ends[0], members]].sum() < longest
            if is_short and not is_corner and counts[ends[0]] == counts[ends[1]] < 3:
                is_central[members] = True
                counts[members] = counts[ends[0]]
                bridges.append(members)
    return np.concatenate(bridges)


def _level_junctions(
    counts: Index, middles: Array, summit: Index, is_central: Mask, bridges: Index, reach: float
) -> None:
    """Give corners whose summit is within `reach` mm of a bridge the bead count of the bridge.

    The beads of the bridge occupy the space there.
    """
    corner = np.flatnonzero(~is_central)
    if not len(bridges) or not len(corner):
        return
    tree = cKDTree(middles[bridges])
    distances, nearest_bridges = tree.query(middles[summit[corner]])
    near = distances <= reach
    counts[corner[near]] = counts[bridges[nearest_bridges[near]]]


def _forks(spokes: Spokes, distance: Array, spacing: float) -> Mask:
    """Return a mask (n,) of the spokes after which the axis forks.

    At a fork the touching point of the inscribed circle jumps.
    """
    jump = np.hypot(*(spokes.touching[spokes.following] - spokes.touching).T)
    return np.asarray(np.nan_to_num(jump) > FORK_RATIO * distance + FORK * spacing)


def _in_short_runs(is_level: Mask, distance: Array, following: Index, shortest: float) -> Mask:
    """Return a mask (n,) of level stretches of the axis that are shorter than `shortest` mm."""
    short = np.zeros(len(is_level), dtype=bool)
    for cycle in _cycles(following):
        for run in _runs(is_level[cycle]):
            if distance[cycle[run]].sum() < shortest:
                short[cycle[run]] = True
    return short


def _cycles(following: Index) -> list[Index]:
    """Return the spoke indices of each border, which are consecutive."""
    last = np.flatnonzero(following != np.arange(1, len(following) + 1))
    firsts = np.r_[0, last[:-1] + 1]
    return [np.arange(first, end + 1) for first, end in zip(firsts.tolist(), last.tolist())]


def _runs(mask: Mask) -> list[Index]:
    """Return the runs of True in a cyclic mask, each as indices in cyclic order.

    If all values are True, there is a single run.
    """
    if mask.all():
        return [np.arange(len(mask))]
    if not mask.any():
        return []
    first = int(np.flatnonzero(~mask)[0])
    order = np.roll(np.arange(len(mask)), -first)
    turned = mask[order].astype(np.int8)
    starts = np.flatnonzero(np.diff(turned, prepend=0) == 1)
    ends = np.flatnonzero(np.diff(turned, append=0) == -1) + 1
    return [order[a:b] for a, b in zip(starts.tolist(), ends.tolist())]


def _carry_uphill(spokes: Spokes, is_central: Mask, reach: float) -> tuple[Array, Mask, Index]:
    """Find the radius (n,) that determines the bead count at each spoke, and the summit spoke (n,).

    Also returns whether (n,) beads come in pairs only. Uphill means towards larger inscribed
    circles along the axis. A spoke in a corner takes the radius of its summit, the largest circle
    uphill. Small facets cause several summits in a row; a summit between two higher summits takes
    the radius of the lower one. Summits within `reach` mm of each other are merged.
    """
    radii = spokes.radii
    deciding, summit = radii.copy(), np.arange(len(radii))
    in_pairs = np.zeros(len(radii), dtype=bool)
    for cycle in _cycles(spokes.following):
        for run in _runs(~is_central[cycle]):
            whole = len(run) == len(cycle)
            span = run if whole else np.r_[run[0] - 1, run, (run[-1] + 1) % len(cycle)]
            if whole:
                span = np.roll(span, -int(np.argmax(radii[cycle[span]])))
                span = np.r_[span, span[:1]]
            values = radii[cycle[span]]
            level, uphill = _summits(values)
            ends_high = max(values[0], values[-1]) >= (1.0 - RADIUS_TOLERANCE) * level.max()
            inner = cycle[span[:-1] if whole else span[1:-1]]
            used = slice(0, -1) if whole else slice(1, -1)
            deciding[inner] = level[uphill[used]]
            summit[inner] = cycle[span[uphill[used]]]
            in_pairs[inner] = whole or not ends_high
    corner = np.flatnonzero(~is_central)
    if len(corner):
        summit = _join_summits(spokes, deciding, summit, corner, reach)
        highest, number = np.unique(summit[corner], return_inverse=True)
        has_odd = np.zeros(len(highest), dtype=bool)
        np.logical_or.at(has_odd, number, ~in_pairs[corner])
        deciding[corner], in_pairs[corner] = deciding[summit[corner]], ~has_odd[number]
    return deciding, in_pairs, summit


def _join_summits(
    spokes: Spokes, deciding: Array, summit: Index, corner: Index, reach: float
) -> Index:
    """Merge summits and return the summit (n,) of each spoke.

    Summits within `reach` mm are merged. If another stretch of the axis passes a summit on its way
    to a higher summit, the higher summit replaces the passed one.
    """
    middles, following = spokes.middles, spokes.following
    tops, number = np.unique(summit[corner], return_inverse=True)
    group = _groups(middles[tops], reach)
    order = np.lexsort((deciding[tops], group))
    last = np.flatnonzero(np.diff(group[order], append=-1))
    joined = summit.copy()
    joined[corner] = tops[order[last]][group][number]
    lengths = np.hypot(*(middles[following] - middles).T)
    counts = np.ceil(lengths / reach).astype(np.intp) + 1
    owners = np.repeat(np.arange(len(counts)), counts)
    shares = (np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[
        owners
    ]
    points = middles[owners] + shares[:, None] * (middles[following] - middles)[owners]
    parent = np.arange(len(summit))
    tops = tops[order[last]]
    for top, near in zip(tops.tolist(), cKDTree(points).query_ball_point(middles[tops], reach)):
        passing = np.unique(np.r_[owners[near], following[owners[near]]])
        is_own = joined[passing] == passing  # between two sides
        heights = deciding[joined[passing]] + np.where(is_own, 1e-3 * reach, 0.0)
        highest = joined[passing[np.argmax(heights)]]
        if heights.max() > deciding[top] * (1.0 + LENGTH_TOLERANCE) and highest != top:
            parent[top] = highest
    for _ in range(16):
        parent = parent[parent]
    return np.asarray(parent[joined])


def _groups(points: Array, reach: float) -> Index:
    """Group points (n, 2) that are within `reach` mm of each other; return group indices (n,)."""
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(points), len(points)))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.intp)


def _summits(values: Array) -> tuple[Array, Index]:
    """Fill the dips of values (n,) between higher values, and find the summit uphill of each value.

    Returns the filled values (n,) and the indices (n,) of the summits.
    """
    level = np.minimum(np.maximum.accumulate(values), np.maximum.accumulate(values[::-1])[::-1])
    number = np.arange(len(values))
    right = _walk_up(values)
    left = number[::-1][_walk_up(values[::-1])][::-1]
    is_right = (level[right] > level[left]) | (
        (level[right] == level[left]) & (values[right] >= values[left])
    )
    return level, np.where(is_right, right, left)


def _walk_up(values: Array) -> Index:
    """Return the index (n,) at which a climb to the right from each value ends."""
    rising = np.r_[values[1:] >= values[:-1], False]
    ends = np.where(rising, len(values), np.arange(len(values)))
    return np.asarray(np.minimum.accumulate(ends[::-1])[::-1])


def _rings(
    spokes: Spokes, thickness: _Thickness, pair: _Pair, beads: Beads, law: BeadLaw
) -> list[PlaneCurve]:
    """Return the closed beads of a pair.

    Each bead follows one side of the axis as far as the pair extends and returns along the other
    side.
    """
    is_valid = pair.is_there & (pair.depths <= spokes.radii + LENGTH_TOLERANCE * law.spacing)
    runs: list[tuple[_Crossing | None, Index, _Crossing | None]] = []
    for cycle in _cycles(spokes.following):
        for run in _runs(is_valid[cycle]):
            members = cycle[run]
            if len(run) == len(cycle):
                runs.append((None, members, None))
                continue
            before, after = cycle[run[0] - 1], cycle[(run[-1] + 1) % len(cycle)]
            entry = _crossing(spokes, thickness, members[0], before, pair, law)
            leave = _crossing(spokes, thickness, members[-1], after, pair, law)
            runs.append((entry, members, leave))
    curves = []
    for chain in _chains([(entry, leave) for entry, _, leave in runs], law.spacing):
        points, chain_shares = _trace(
            spokes, [runs[number] for number in chain], pair.depths, pair.shares, beads, law
        )
        if len(points) > 2:
            curves.append(PlaneCurve(points, True, "contour", pair.number, share=chain_shares))
    return curves


def _crossing(
    spokes: Spokes, thickness: _Thickness, inside: int, outside: int, pair: _Pair, law: BeadLaw
) -> _Crossing:
    """Return the end of a bead that reaches the spoke `inside` but not the spoke `outside`."""
    radii = spokes.radii[[inside, outside]]
    depth, share, wide = float(pair.depths[inside]), 1.0, float(pair.shares[inside])
    if pair.is_there[outside]:
        room = radii - pair.depths[[inside, outside]]
        share = room[0] / max(room[0] - room[1], 1e-300)
        depth += share * float(pair.depths[outside] - pair.depths[inside])
    elif thickness.is_central[inside] and thickness.is_central[outside]:
        share = _share_of_change(thickness, inside, outside, pair, law)
        if _narrows_away(inside, outside, pair):
            radius = float((1.0 - share) * radii[0] + share * radii[1])
            wide = min(float(pair.least[inside]) / law.pair_room(pair.number), law.widest)
            depth = radius - 0.5 * law.spacing * wide
    else:
        limit = min(depth + MOUTH * law.spacing, radii[0])
        if radii[1] < limit:
            share = (radii[0] - limit) / max(radii[0] - radii[1], 1e-300)
    share = min(max(share, 0.0), 1.0)
    places = spokes.feet[[inside, outside]], spokes.directions[[inside, outside]]
    foot, direction = ((1.0 - share) * place[0] + share * place[1] for place in places)
    direction = direction / max(float(np.hypot(*direction)), 1e-300)
    middles = spokes.feet[[inside, outside]] + radii[:, None] * places[1]
    middle = (1.0 - share) * middles[0] + share * middles[1]
    radius = float((1.0 - share) * radii[0] + share * radii[1])
    return _Crossing(middle, foot, direction, min(depth, radius), wide)


def _narrows_away(inside: int, outside: int, pair: _Pair) -> bool:
    """Whether a pair ends between two spokes because outer pairs leave too little space."""
    return bool(pair.room[inside] >= pair.least[inside] > pair.room[outside])


def _share_of_change(
    thickness: _Thickness, inside: int, outside: int, pair: _Pair, law: BeadLaw
) -> float:
    """Return the fraction of the way from spoke `inside` to `outside` at which a pair ends."""
    if _narrows_away(inside, outside, pair):
        start, end = float(pair.room[inside]), float(pair.room[outside])
        return (start - float(pair.least[inside])) / (start - end)
    if pair.is_early[inside]:
        return 0.0
    limit = law.least_radius(int(thickness.counts[inside]) // 2 * 2)
    return _share_to_limit(thickness, inside, outside, limit, 1.0)


def _chains(
    ends: Sequence[tuple[_Crossing | None, _Crossing | None]], spacing: float
) -> list[list[int]]:
    """Chain runs of spokes into rings.

    Where a run ends, the next run begins on the other side of the axis.
    """
    open_runs = [number for number, (entry, leave) in enumerate(ends) if leave is not None]
    closed = [[number] for number, (_, leave) in enumerate(ends) if leave is None]
    if not open_runs:
        return closed
    leaves = np.array([ends[number][1].middle for number in open_runs])  # type: ignore[union-attr]
    entries = np.array([ends[number][0].middle for number in open_runs])  # type: ignore[union-attr]
    successor = _match(leaves, entries, spacing)
    chains, is_left = closed, np.ones(len(open_runs), dtype=bool)
    for first in range(len(open_runs)):
        chain = []
        number = first
        while is_left[number]:
            is_left[number] = False
            chain.append(open_runs[number])
            number = int(successor[number])
        if chain:
            chains.append(chain)
    return chains


def _match(leaves: Array, entries: Array, spacing: float) -> Index:
    """Assign an entry (n, 2) to each leave (n, 2), one to one, with minimum total distance.

    Returns the entry indices (n,).
    """
    count = len(leaves)
    successor = np.full(count, -1)
    following = np.roll(np.arange(count), -1)  # most gaps are corners, where the next run begins
    is_near = np.hypot(*(leaves - entries[following]).T) < 1e-3 * spacing
    successor[is_near] = following[is_near]
    left_leaves = np.flatnonzero(successor < 0)
    left_entries = np.setdiff1d(np.arange(count), successor)
    if len(left_leaves):
        distances = np.hypot(
            *(leaves[left_leaves][:, None] - entries[left_entries]).transpose(2, 0, 1)
        )
        rows, columns = linear_sum_assignment(distances)
        successor[left_leaves[rows]] = left_entries[columns]
    return successor


def _trace(
    spokes: Spokes,
    runs: Sequence[tuple[_Crossing | None, Index, _Crossing | None]],
    depths: Array,
    shares: Array,
    beads: Beads,
    law: BeadLaw,
) -> tuple[Array, Array | None]:
    """Return the points (n, 2) of a ring through runs of spokes, and their bead shares (n,)."""
    parts: list[tuple[Array, Array]] = []
    for entry, members, leave in runs:
        feet, directions = spokes.feet[members], spokes.directions[members]
        depth, share = depths[members], shares[members]
        for end, at in ((entry, 0), (leave, len(members) + (entry is not None))):
            if end is not None:
                feet, directions, depth, share = (
                    np.insert(values, at, value, axis=0)
                    for values, value in (
                        (feet, end.foot),
                        (directions, end.direction),
                        (depth, end.depth),
                        (share, end.share),
                    )
                )
        line = feet + depth[:, None] * directions
        slanted = share * measure_obliquity(line, directions, entry is None)
        parts.append((line, np.maximum(slanted, np.minimum(share, law.narrowest))))
    points, share = (np.concatenate(columns) for columns in zip(*parts))
    chord = points - np.roll(points, 1, axis=0)
    is_kept = np.hypot(*chord.T) > 1e-6 * law.spacing
    points, share = points[is_kept], share[is_kept]
    if len(points) < 3:
        return points, None
    return thin_out(points, share, True, beads)


def measure_obliquity(points: Array, directions: Array, closed: bool) -> Array:
    """Return the ratio of the width across a bead to its width in given directions.

    Parameters
    ----------
    points : (n, 2) array
        The bead, mm.
    directions : (n, 2) array
        Unit vectors, such as those of the spokes.
    closed : bool
        Whether the bead is closed.

    Returns
    -------
    (n,) array
        Ratios, at most 1.
    """
    if closed:
        points = np.vstack([points, points[:1]])
        directions = np.vstack([directions, directions[:1]])
    if len(points) < 2:
        return np.ones(len(points))
    edge = np.diff(points, axis=0)
    long = np.hypot(*edge.T)
    ends = [
        np.abs(edge[:, 0] * direction[:, 1] - edge[:, 1] * direction[:, 0])
        for direction in (directions[:-1], directions[1:])
    ]
    across, weight = np.zeros(len(points)), np.zeros(len(points))
    across[:-1] += ends[0]
    across[1:] += ends[1]
    weight[:-1] += long
    weight[1:] += long
    if closed:
        across[0] += across[-1]
        weight[0] += weight[-1]
        across, weight = across[:-1], weight[:-1]
    return np.where(weight > 0.0, across / np.maximum(weight, 1e-300), 1.0)


def thin_out(points: Array, share: Array, closed: bool, beads: Beads) -> tuple[Array, Array | None]:
    """Reduce points and bead shares to the tolerances.

    Parameters
    ----------
    points : (n, 2) array
        The bead, mm.
    share : (n,) array
        Bead shares.
    closed : bool
        Whether the bead is closed.
    beads : Beads
        Chord error, mm.

    Returns
    -------
    points : (m, 2) array
        Remaining points, mm.
    share : (m,) array or None
        Their bead shares; None if a closed bead has nominal width throughout.
    """
    if closed:
        points = np.vstack([points, points[:1]])
        share = np.r_[share, share[:1]]
    kept = np.zeros(len(points), dtype=bool)
    kept[select_simplified(points, 0.5 * beads.chord_error)] = True
    if np.ptp(share) > SHARE_TOLERANCE:
        kept |= select_significant(arcs(points), share, SHARE_TOLERANCE)
    if closed:
        kept[-1] = False
    points, share = points[kept], share[kept]
    is_usual = closed and np.abs(share - 1.0).max(initial=0.0) < 1e-3
    return points, None if is_usual else share


class _Middle(NamedTuple):
    """Piece of the axis for a centreline bead.

    points: (n, 2). shares: (n,) bead shares. meets: whether each end meets beads that begin there.
    in_pairs: whether each end is between the beads of a pair.
    """

    points: Array
    shares: Array
    meets: tuple[bool, bool]
    in_pairs: tuple[bool, bool]


def _centres(
    spokes: Spokes,
    thickness: _Thickness,
    pairs: Sequence[_Pair],
    law: BeadLaw,
    beads: Beads,
    walls: int | None,
) -> list[PlaneCurve]:
    """Return the centreline beads, along the axis where pairs leave enough space.

    walls: maximum number of pairs beside a centreline bead; None: any number.
    """
    free = spokes.radii - 0.5 * (law.width - law.spacing)
    for pair in pairs:
        free = np.where(pair.is_there, pair.free(thickness.radii, law.spacing), free)
    width = np.where(thickness.counts == 1, law.width, law.spacing)
    room = np.where(thickness.counts == 1, spokes.radii, free)
    shares = np.minimum(2.0 * room / width, law.widest)
    if walls is not None:
        shares = np.where(thickness.counts > 2 * walls + 1, 0.0, shares)
    pieces, closed = _middle_pieces(spokes, thickness, pairs, law, shares)
    curves = []
    for points, closed_shares in closed:
        thin_points, thin_shares = thin_out(points, closed_shares, True, beads)
        curves.append(PlaneCurve(thin_points, True, "centre", 0, share=thin_shares))
    for piece in _join_middles(pieces, JOINT * STEP * law.spacing, law, beads.shortest):
        if len(piece.points) < 2 or length(piece.points, False) < LENGTH_TOLERANCE * law.spacing:
            continue
        thin_points, thin_shares = thin_out(piece.points, piece.shares, False, beads)
        curves.append(PlaneCurve(thin_points, False, "centre", 0, share=thin_shares))
    return curves


def _middle_pieces(
    spokes: Spokes, thickness: _Thickness, pairs: Sequence[_Pair], law: BeadLaw, shares: Array
) -> tuple[list[_Middle], list[tuple[Array, Array]]]:
    """Find the open and closed pieces of the axis with space for a bead.

    Both sides of the axis yield each open piece; the shorter version is kept.
    """
    pieces, closed = _pieces_of_side(
        spokes, thickness, pairs, law, shares, spokes.positions < spokes.opposite
    )
    if not pieces:
        return pieces, closed
    others, _ = _pieces_of_side(
        spokes, thickness, pairs, law, shares, spokes.positions > spokes.opposite
    )
    ends = np.array([[piece.points[at] for at in (0, -1)] for piece in pieces])
    for other in others:
        away = np.hypot(*(ends - other.points[[-1, 0]]).transpose(2, 0, 1)).max(axis=1)
        number = int(np.argmin(away))
        shorter = length(pieces[number].points, False) - length(other.points, False)
        if away[number] < 0.5 * law.spacing and shorter > LENGTH_TOLERANCE * law.spacing:
            pieces[number] = other
    return pieces, closed


def _pieces_of_side(
    spokes: Spokes,
    thickness: _Thickness,
    pairs: Sequence[_Pair],
    law: BeadLaw,
    shares: Array,
    is_side: Mask,
) -> tuple[list[_Middle], list[tuple[Array, Array]]]:
    """Find the open and closed pieces of the axis with space for a bead, from one side of the axis.

    is_side: (n,) spokes of this side.
    """
    following, middles, counts = spokes.following, spokes.middles, thickness.counts
    has_room = thickness.is_central & (shares >= law.narrowest) & (counts > 0)
    pieces, closed = [], []
    for cycle in _cycles(following):
        for run in _runs((has_room & is_side)[cycle]):
            members = cycle[run]
            if len(run) == len(cycle):
                closed.append((middles[members], shares[members]))
                continue
            before, after = cycle[run[0] - 1], cycle[(run[-1] + 1) % len(cycle)]
            points, widths = middles[members], shares[members]
            meets = []
            for neighbour, member, last in (
                (before, members[0], False),
                (after, members[-1], True),
            ):
                goes_on = bool(thickness.is_central[neighbour] and is_side[neighbour])
                has_more = bool(counts[neighbour] // 2 > counts[member] // 2)
                meets.append(has_more)
                if goes_on:
                    share = _share_of_end(thickness, member, neighbour, pairs, law, shares)
                    end = middles[member] + share * (middles[neighbour] - middles[member])
                    width = max(float(shares[member]), law.narrowest)
                    if not has_more:
                        width += share * (float(shares[neighbour]) - width)
                    points = np.vstack([points, end] if last else [end, points])
                    widths = np.r_[widths, width] if last else np.r_[width, widths]
            in_pairs = bool(counts[members[0]] > 1), bool(counts[members[-1]] > 1)
            pieces.append(_Middle(points, widths, (meets[0], meets[1]), in_pairs))
    return pieces, closed


def _share_of_end(
    thickness: _Thickness,
    inside: int,
    outside: int,
    pairs: Sequence[_Pair],
    law: BeadLaw,
    shares: Array,
) -> float:
    """Return the fraction of the way between two spokes at which a centreline bead ends.

    The bead ends where another pair begins or where the bead would become too narrow.
    """
    if thickness.counts[outside] // 2 > thickness.counts[inside] // 2:
        pair = pairs[int(thickness.counts[inside]) // 2]
        return 1.0 - _share_of_change(thickness, outside, inside, pair, law)
    fall = float(shares[inside] - shares[outside])
    return min(max((float(shares[inside]) - law.narrowest) / max(fall, 1e-300), 0.0), 1.0)


def _join_middles(
    pieces: list[_Middle], reach: float, law: BeadLaw, shortest: float
) -> list[_Middle]:
    """Join pieces where they meet, the straightest pair first, and cut back overlapping ends."""
    least = SHORTEST_PIECE * law.spacing
    joined = [piece for piece in pieces if length(piece.points, False) > least]
    ends = np.array([piece.points[at] for piece in joined for at in (0, -1)]).reshape(-1, 2)
    if not len(ends):
        return []
    pairs = cKDTree(ends).query_pairs(reach, output_type="ndarray")
    outward = np.array([_outward(piece.points, at) for piece in joined for at in (0, -1)])
    turn = np.einsum("ni,ni->n", outward[pairs[:, 0]], outward[pairs[:, 1]])
    begins = np.array([flag for piece in joined for flag in piece.meets])
    pairs, turn = (values[~begins[pairs].all(axis=1)] for values in (pairs, turn))
    partner = np.full(len(ends), -1)
    for a, b in pairs[np.argsort(turn, kind="stable")].tolist():
        if partner[a] < 0 and partner[b] < 0 and (a // 2 != b // 2):
            partner[a], partner[b] = b, a
    meets = begins.copy()
    for a, b in pairs.tolist():
        meets[a] |= partner[a] < 0 and partner[b] >= 0
        meets[b] |= partner[b] < 0 and partner[a] >= 0
    meets |= (partner < 0) & _on_others(joined, reach)
    return _walk(joined, partner, meets, law, shortest)


def _on_others(pieces: list[_Middle], reach: float) -> Mask:
    """Return a mask of the ends, two per piece, within `reach` mm of the interior of another piece."""
    points = np.vstack([piece.points[1:-1] for piece in pieces])
    owner = np.repeat(np.arange(len(pieces)), [len(piece.points) - 2 for piece in pieces])
    ends = np.array([piece.points[at] for piece in pieces for at in (0, -1)])
    if not len(points):
        return np.zeros(len(ends), dtype=bool)
    near = cKDTree(points).query_ball_point(ends, reach)
    return np.array([bool((owner[numbers] != end // 2).any()) for end, numbers in enumerate(near)])


def _outward(points: Array, at: int) -> Array:
    """Return the outward unit direction (2,) of a line (n, 2) at one of its ends."""
    if len(points) < 2:
        return np.zeros(2)
    out = points[0] - points[1] if at == 0 else points[-1] - points[-2]
    return np.asarray(out / max(float(np.hypot(*out)), 1e-300))


def _walk(
    pieces: list[_Middle], partner: Index, meets: Mask, law: BeadLaw, shortest: float
) -> list[_Middle]:
    """Chain pieces from open end to open end, then into closed chains."""
    is_left = np.ones(len(pieces), dtype=bool)
    starts = [end for end in range(2 * len(pieces)) if partner[end] < 0]
    starts += list(range(0, 2 * len(pieces), 2))
    chains = []
    for start in starts:
        if not is_left[start // 2]:
            continue
        points, shares, end = [], [], start
        while True:
            number = end // 2
            is_left[number] = False
            piece = pieces[number]
            step = 1 if end % 2 == 0 else -1
            points.append(piece.points[::step])
            shares.append(piece.shares[::step])
            far = end ^ 1
            if partner[far] < 0 or not is_left[partner[far] // 2]:
                break
            end = int(partner[far])
        chain = _Middle(
            np.vstack(points),
            np.concatenate(shares),
            (bool(meets[start]), bool(meets[far])),
            (pieces[start // 2].in_pairs[start % 2], pieces[far // 2].in_pairs[far % 2]),
        )
        chains.append(_cut_back(chain, law, shortest))
    return chains


def _cut_back(piece: _Middle, law: BeadLaw, shortest: float) -> _Middle:
    """Cut back the ends of a piece that meet other beads, and extend its free ends.

    A cut leaves at least `shortest` mm. Between the beads of a pair, a free end extends to the end
    of the space between them. Elsewhere it extends until a round end with the volume of the bead
    touches the border.
    """
    points, shares = piece.points, piece.shares
    # extend before cutting, so that the length does not depend on the direction
    for is_cut in (False, True):
        for meets, in_pairs in zip(piece.meets, piece.in_pairs):
            points, shares = points[::-1], shares[::-1]  # the current end is the last point
            if meets != is_cut:
                continue
            radius = 0.5 * (law.spacing if in_pairs else law.width) * float(shares[-1])
            if meets:
                excess = length(points, False) - 1.01 * shortest
                back = min(CAP * radius + 0.5 * law.spacing * MEET, max(excess, 0.0))
                points, shares = shorten_end(points, shares, back)
            else:
                reach = radius if in_pairs else ROUND_END * radius
                end = points[-1] + reach * _outward(points, -1)
                points, shares = np.vstack([points, end]), np.r_[shares, shares[-1:]]
    return piece._replace(points=points, shares=shares)
