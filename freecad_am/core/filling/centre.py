# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads in the gaps between other beads: along their middle, until no gap is wider than stated."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.plane_curve import (
    arcs,
    cut_at_length,
    dense,
    divided_by_step,
    doubled_area,
    length,
    nearest,
    shorten_end,
    start_at,
)
from ..geometry.regions.medial import spine
from ..geometry.regions.region import Region, along, simplified
from ..geometry.regions.several import (
    HAIR_SHARE,
    grow_regions,
    intersect_regions,
    select_longer,
    select_wider,
    subtract_regions,
)
from ..geometry.regions.strip import Period, Strip, Window
from ..issues import InfeasibleError
from ..types import Array

NEXT, OVER = (
    0.7548776662,
    0.5698402910,
)  # of a length: starts of the next contour, of the next layer (the sequence R2)
THINNEST = 0.6  # of a bead's width; wider ribs get a bead even if all beads have the usual width
ROUND_END = 0.25 * math.pi  # in radii: length of a rectangle with the area of a round end
LONGEST_ENDS = 0.4995  # maximum share of a bead's length for each of its round ends
SHARES = 0.02  # of a bead's usual width; widths within this step count as equal
SHARE_STEP = 0.05  # of the usual width; maximum change of the width along an edge of a bead
DIGITS = 6  # of coordinates in mm by which a bead begins at one of its ends
FARTHEST_TOLERANCE = 1e-6  # of a ring's extent; points within it count as equally far out


@dataclass(frozen=True, eq=False)
class PlaneCurve:
    """The middle of a bead: points (n, 2) mm; a closed one does not repeat its first point.

    kind: 'contour', 'connected', 'line', 'spiral', 'zigzag', 'centre' or 'closing'. ring: counts from the outermost contour, 0,
    inwards. turns: how often a closed one goes round the hub, so that its last point is followed by the first, moved by as many
    periods. sheet: u (`strip.Period`), mm, about which it is unrolled: on a wide cone it may be more than half a turn of the plane
    from 0. share: (n,) of the usual bead width at each point; None: 1. dot: a short bead in a round place narrower than a bead:
    the fed volume spreads to the size of that place.
    """

    points: Array
    closed: bool
    kind: str
    ring: int
    turns: int = 0
    sheet: float = 0.0
    share: Array | None = None
    dot: bool = False

    def reversed(self) -> PlaneCurve:
        """The same run the other way, a closed one from the same start."""
        points, share = self.points[::-1], None if self.share is None else self.share[::-1]
        if self.closed:
            points, share = np.roll(points, 1, axis=0), None if share is None else np.roll(share, 1)
        return replace(self, points=points, share=share)

    def closed_points(self, period: Period | None = None) -> tuple[Array, Array | None]:
        """Return points and shares, of a closed curve with the first repeated at the end.

        Parameters
        ----------
        period : Period, optional
            Of the hub, to repeat the first point a period on if the curve goes round.

        Returns
        -------
        points : (n, 2) or (n + 1, 2) array
            mm.
        share : (n,) or (n + 1,) array or None
            Shares of the usual width, as `share`.
        """
        if not self.closed:
            return self.points, self.share
        start = self.points[:1]
        if self.turns and period is not None:
            start = period.move_turns(start, self.turns)
        return np.vstack([self.points, start]), None if self.share is None else np.r_[
            self.share, self.share[:1]
        ]

    def deposit(self, inset: float) -> tuple[Array, Array]:
        """Return the line about which the bead spreads, with round ends.

        Parameters
        ----------
        inset : float
            Half the usual width, mm.

        Returns
        -------
        points : (m, 2) array
            Points, mm, of a closed bead with the first repeated at the end. An open one with widths of its own is shortened
            by its round ends, which have no volume of their own; one of the usual width keeps its points.
        share : (m,) array
            Of the usual width.
        """
        points, share = self.closed_points()
        if share is None:
            return points, np.ones(len(points))
        if not self.closed:
            most = LONGEST_ENDS * length(points, False)
            for _ in range(2):
                by = min(ROUND_END * inset * float(share[-1]), most)
                points, share = shorten_end(points, share, by)
                points, share = points[::-1], share[::-1]
        return points, share


def divide_by_share(points: Array, share: Array) -> tuple[Array, Array]:
    """Divide the edges of a line so that the width changes little along each: a bead has one speed an edge.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        mm.
    share : ndarray, shape (n,)
        Of the usual width.
    """
    counts = np.maximum(np.ceil(np.abs(np.diff(share)) / SHARE_STEP - 1e-9), 1.0).astype(np.intp)
    if (counts == 1).all():
        return points, share
    position = np.arange(len(points), dtype=float)
    edge = np.repeat(position[:-1], counts)
    number = np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts)
    places = np.r_[edge + number / np.repeat(counts, counts), position[-1]]
    divided = np.stack([np.interp(places, position, points[:, k]) for k in (0, 1)], axis=1)
    return divided, np.interp(places, position, share)


def split_by_width(points: Array, share: Array) -> tuple[list[tuple[Array, bool]], list[float]]:
    """Split a bead into lines of constant width.

    Parameters
    ----------
    points : (n, 2) array
        The bead, mm.
    share : (n,) array
        Of the usual width.

    Returns
    -------
    lines : list of tuple
        Points (m, 2), mm, and False: no line is closed.
    shares : list of float
        Of the usual width, in steps of `SHARES`; the mean where all are within one step.
    """
    if np.ptp(share) < SHARES:
        return [(points, False)], [float(share.mean())]
    points, share = divide_by_share(points, share)
    level = np.round(0.5 * (share[1:] + share[:-1]) / SHARES)
    starts = np.flatnonzero(np.diff(level, prepend=np.nan))
    ends = np.r_[starts[1:], len(level)]
    lines = [(points[a : b + 1], False) for a, b in zip(starts.tolist(), ends.tolist())]
    return lines, (SHARES * level[starts]).tolist()


def plane_text(point: Array) -> str:
    """A point (2,) as text."""
    return f"({point[0]:.4g}, {point[1]:.4g}) mm"


@dataclass(frozen=True, eq=False)
class Beads:
    """Options for filling a region, shared by all patterns.

    spacing: mm between the middles of neighbouring beads. width: mm of a bead; the outermost is half a width inside the border;
    0: the spacing. gap: the widest (mm) that may stay open between beads. shortest: beads that close gaps are extended to this
    length (mm), others below it are dropped. thin: 'single' deposits one bead in regions, or necks, narrower than a bead;
    'refuse' rejects them. clockwise: sense of closed beads. start: a point (x, y) near which closed beads begin, or the direction
    (rad) in which they begin farthest out. chord_error: mm, of arcs; 0: 0.005 spacings. where: a point (2,) as text. spread: share
    of its length by which the outermost closed bead begins behind `start`, inner ones at further ones; None: none does.
    narrowest: least share of the width of a bead. overlap: share of the width by which the ends of lines reach into the last
    wall; None: as neighbours overlap.
    """

    spacing: float
    gap: float
    shortest: float
    thin: str = "single"
    clockwise: bool = False
    start: tuple[float, float] | float = 0.0
    chord_error: float = 0.0
    where: Callable[[Array], str] = plane_text
    width: float = 0.0
    spread: float | None = None
    narrowest: float = 0.3
    overlap: float | None = None

    @property
    def end_inset(self) -> float:
        """Distance (mm) of the ends of lines from the middle of the last wall."""
        return (
            0.5 * self.spacing if self.overlap is None else self.inset * (1.0 - 2.0 * self.overlap)
        )

    @property
    def inset(self) -> float:
        """Distance (mm) of the middle of the outermost bead from the border."""
        return 0.5 * (self.width or self.spacing)

    @property
    def thinnest(self) -> float:
        """Least width (mm) of ribs and round places that get a bead."""
        return 2.0 * self.inset * min(self.narrowest, THINNEST)

    def __post_init__(self) -> None:
        if (
            not self.spacing > 0.0
            or not self.gap > 0.0
            or self.shortest < 0.0
            or self.thin not in ("single", "refuse")
        ):
            raise ValueError(
                "spacing and gap must be positive, shortest not negative, thin 'single' or 'refuse'"
            )
        if self.chord_error <= 0.0:
            object.__setattr__(self, "chord_error", 0.005 * self.spacing)

    def ring(self, points: Array, number: int = 0) -> Array:
        """Return a ring with the requested sense and start.

        Parameters
        ----------
        points : (n, 2) array
            The ring, mm, its first point not repeated.
        number : int, optional
            Number of contours outside, which moves the start if starts are spread.

        Returns
        -------
        (m, 2) array
            The ring; it may have a new point at its start.
        """
        turned = points[::-1] if (doubled_area(points) < 0.0) != self.clockwise else points
        started = start_at(turned, self.start_of(turned))
        behind = 0.0 if self.spread is None else (self.spread + NEXT * number) % 1.0
        if behind == 0.0:
            return started
        loop = np.vstack([started, started[:1]])
        return start_at(started, cut_at_length(loop, behind * length(started, True))[-1])

    def start_of(self, points: Array) -> Array:
        """Return the place that a ring should begin nearest to.

        Parameters
        ----------
        points : (n, 2) array
            The ring, mm.

        Returns
        -------
        (2,) array
            mm.
        """
        if isinstance(self.start, tuple):
            return np.array(self.start, dtype=float)
        direction = np.array([np.cos(self.start), np.sin(self.start)])
        out, aside = points @ direction, points @ np.array([-direction[1], direction[0]])
        farthest = np.flatnonzero(
            out >= out.max() - FARTHEST_TOLERANCE * max(np.ptp(out), np.ptp(aside))
        )
        point: Array = points[farthest[np.argmax(aside[farthest])]]
        return point


def long_enough(curves: list[PlaneCurve], shortest: float) -> list[PlaneCurve]:
    """The curves without those below a length, mm; those round the hub, which may have a single point, and dots, which have
    been made as long as that, are long enough."""
    return [
        curve
        for curve in curves
        if curve.turns
        or curve.dot
        or (length(curve.points, curve.closed) >= shortest and len(curve.points) > 1)
    ]


def start_curve(curve: PlaneCurve, beads: Beads) -> PlaneCurve:
    """A closed curve with the sense and start asked for; an open one as it is."""
    if not curve.closed or curve.turns:
        return curve
    points = beads.ring(curve.points, curve.ring)
    if curve.share is None:
        return replace(curve, points=points)
    is_turned = (doubled_area(points) < 0.0) != (doubled_area(curve.points) < 0.0)
    turned = curve.reversed() if is_turned else curve
    assert turned.share is not None
    arc = arcs(turned.points, True)
    edge, part = nearest(turned.points, points[:1], True)[1:3]
    start = arc[edge[0]] + part[0] * (arc[edge[0] + 1] - arc[edge[0]])
    along = np.remainder(start + arcs(points), arc[-1])
    return replace(
        curve, points=points, share=np.interp(along, arc, np.r_[turned.share, turned.share[:1]])
    )


def contours_of(regions: Sequence[Strip | Region], beads: Beads, ring: int) -> list[PlaneCurve]:
    """Return the borders of regions and strips as contours.

    Parameters
    ----------
    regions : sequence of Strip or Region
        The regions.
    beads : Beads
        Sense and start of closed beads.
    ring : int
        Number of the contours, 0 for the outermost.

    Returns
    -------
    list of PlaneCurve
        Closed curves of kind 'contour', mm; of strips on the unrolled plane.
    """
    curves = []
    for region in regions:
        if isinstance(region, Region):
            curves += [
                PlaneCurve(border, True, "contour", ring, sheet=region.sheet)
                for border in region.borders()
            ]
            continue
        for border, turns in region.borders():
            against = turns != 0 and (turns < 0) != beads.clockwise
            curves.append(
                PlaneCurve(
                    border[::-1] if against else border,
                    True,
                    "contour",
                    ring,
                    -turns if against else turns,
                )
            )
    return [start_curve(curve, beads) for curve in curves]


ROUNDS = 12  # of beads within one gap
FINE = 0.04  # of the spacing, mm between the places that the middle is found from
MAX_EXTENSIONS = 8  # attempts to make a bead long enough
COARSE = 0.01  # of the gap; resolution at which open regions are found
# squares of half a bead's width; a larger region without room for contours consists of ribs
NETWORK = 12.0
RIB = 0.6  # of a bead's width; a protrusion with a larger mean thickness is a rib
# of the chord error; in narrower places the border replaces the centreline, which is slow to find
SLIVER = 1.0
DOT = 5.0  # of half a bead's width; maximum size of a round region narrower than a bead
LEAST_BARE = 0.01  # of the square of half a bead's width; rounding leaves thousands of smaller places between beads
ENDS = 0.5  # of the gap; a bead in a gap ends where the gap is this narrow


def centre_beads(
    gaps: Sequence[Region], beads: Beads, ring: int, inner: Sequence[Region], kind: str = "centre"
) -> list[PlaneCurve]:
    """Return beads along the middle of gaps, until no gap is wider than stated.

    They are closed in gaps that go round, else open. Beads are moved into `inner`, and short ones
    extended in there until they are long enough.

    Parameters
    ----------
    gaps : sequence of Region
        The gaps, mm.
    beads : Beads
        Spacing, allowed gap and shortest length, mm.
    ring : int
        Number that the curves get.
    inner : sequence of Region
        Allowed positions of bead middles; anywhere if empty.
    kind : str, optional
        Kind of the curves.

    Returns
    -------
    list of PlaneCurve
        Those in small rooms may be too short.
    """
    curves: list[PlaneCurve] = []
    for _ in range(ROUNDS):
        gaps = select_wider(gaps, beads.gap, beads.chord_error)
        remaining: list[Region] = []
        for region in gaps:
            points, closed = _spine(region, beads, 0.5 * ENDS * beads.gap)
            points = move_into_regions(points if len(points) > 1 else _dab(region, beads), inner)
            if not closed:
                points = _lengthened(points, beads, inner)
            curves.append(PlaneCurve(points, closed, kind, ring))
            remaining += region.without(
                along([(points, closed)], 0.5 * beads.spacing, beads.chord_error), beads.gap
            )
        gaps = remaining
        if not gaps:
            break
    return curves


def open_regions(
    curves: Sequence[PlaneCurve], inner: Sequence[Region], beads: Beads
) -> list[Region]:
    """Return the regions that curves leave open, wider than the allowed gap.

    Parameters
    ----------
    curves : sequence of PlaneCurve
        Beads.
    inner : sequence of Region
        Allowed positions of bead middles; what these beads cannot reach does not count.
    beads : Beads
        Spacing and allowed gap, mm.

    Returns
    -------
    list of Region
        mm.
    """
    half, error = 0.5 * beads.spacing, max(beads.chord_error, COARSE * beads.gap)
    covered = covered_regions(curves, beads.spacing, error)
    return select_wider(
        subtract_regions(grow_regions(inner, half, error), covered, beads.gap), beads.gap, error
    )


def covered_regions(
    curves: Sequence[PlaneCurve], width: float, chord_error: float
) -> tuple[Region, ...]:
    """Return the regions that beads cover at their widths, with round ends.

    Parameters
    ----------
    curves : sequence of PlaneCurve
        Middles of the beads.
    width : float
        The usual width, mm, that shares are relative to.
    chord_error : float
        Chord error of arcs, mm.

    Returns
    -------
    tuple of Region
        In the order of their leftmost points.
    """
    lines, halves = [], []
    for curve in curves:
        if curve.share is None:
            lines.append((simplified(curve.points, chord_error, curve.closed), curve.closed))
            halves.append(0.5 * width)
            continue
        points, shares = curve.closed_points()
        assert shares is not None
        stretches, means = split_by_width(points, shares)
        lines += stretches
        halves += [0.5 * width * mean for mean in means]
    return along(lines, np.array(halves), chord_error)


def closing_beads(
    inner: Sequence[Region],
    curves: Sequence[PlaneCurve],
    beads: Beads,
    ring: int,
    ends: Sequence[Region] = (),
) -> list[PlaneCurve]:
    """Return beads in the gaps within reach of beads with their middles in `inner`.

    Parameters
    ----------
    inner : sequence of Region
        Allowed positions of bead middles.
    curves : sequence of PlaneCurve
        Beads that leave the gaps.
    beads : Beads
        Spacing, allowed gap and shortest length, mm.
    ring : int
        Number that the curves get.
    ends : sequence of Region, optional
        Regions that lines fill later (`sparse.Frame`); gaps there do not count.

    Returns
    -------
    list of PlaneCurve
        Of kind 'closing'.
    """
    gaps = open_regions(curves, inner, beads)
    if ends:
        gaps = select_wider(subtract_regions(gaps, ends), beads.gap, beads.chord_error)
    return centre_beads(gaps, beads, ring, inner, "closing")


def single_beads(thin: Sequence[Region], beads: Beads) -> list[PlaneCurve]:
    """Return beads along the centrelines of regions narrower than a bead, longest first.

    No bead starts inside another. Raises InfeasibleError THIN_REGION if thin regions are not
    allowed.
    """
    curves: list[PlaneCurve] = []
    for region in thin:
        if beads.thin == "refuse":
            raise InfeasibleError(
                "THIN_REGION",
                "filling",
                "the region at {} is {:.3g} mm wide, narrower than a bead ({:.3g} mm); use thin "
                "= single, a narrower bead or a margin",
                beads.where(region.inside()),
                region.width,
                2.0 * beads.inset,
            )
        start = len(curves)
        remaining: Sequence[Region] = (region,)
        if region.width >= beads.thinnest and region.extent < DOT * beads.inset:
            points, closed = _spine(region, beads, 0.15 * region.width)
            if len(points) < 2 or length(points, closed) < beads.shortest:
                curves.append(dot(region, beads))
                continue
        for _ in range(ROUNDS):
            pieces, remaining = remaining, []
            for piece in pieces:
                sliver = piece.width < SLIVER * beads.chord_error
                points, closed = (
                    _along_border(piece) if sliver else _spine(piece, beads, 0.15 * piece.width)
                )
                if len(points) > 1 and (
                    len(curves) == start or length(points, closed) >= beads.shortest
                ):
                    curves.append(PlaneCurve(points, closed, "centre", 0))
                    remaining += piece.without(
                        along([(points, closed)], beads.inset, beads.chord_error), beads.gap
                    )
            # the narrowing rest at the end of a bead is far narrower than the narrowest bead; a
            # threshold near its width would give equal sections different beads
            remaining = select_wider(remaining, max(beads.gap, beads.thinnest), beads.chord_error)
    return curves


def dot(region: Region, beads: Beads) -> PlaneCurve:
    """A short bead in the middle of a region narrower than a bead and about as long as wide: its length, and its width where
    it would be too short, are such that the region is filled."""
    long = max(region.area / (2.0 * beads.inset), beads.shortest)
    share = region.area / (2.0 * beads.inset * long)
    share = min(max(share, beads.narrowest), 1.0)
    middle = region.middle if region.contains(region.middle[None])[0] else region.inside()
    reach = 0.5 * long * region.axis()
    points = np.stack([middle - reach, middle + reach])
    return PlaneCurve(
        points, False, "centre", 0, share=None if share == 1.0 else np.full(2, share), dot=True
    )


def bare_parts(
    region: Region, curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Region, float]]:
    """Return the pieces of a region too narrow for any bead.

    Parameters
    ----------
    region : Region
        The region, mm.
    curves : sequence of PlaneCurve
        Its beads; without any the region is one piece.
    beads : Beads
        Width and chord error, mm.

    Returns
    -------
    list of tuple of Region and float
        Pieces, and the distance that each reaches from the beads, mm: more than a bead is wide.
    """
    if not curves:
        return [(region, region.extent)]
    lines = [(curve.points, curve.closed) for curve in curves]
    if region.extent < 2.0 * beads.inset or curves[0].dot:
        return []
    error = max(beads.chord_error, COARSE * beads.inset)
    places = np.vstack([_places(curve, beads.inset) for curve in curves])
    border_places = np.vstack([dense(border, beads.inset) for border in region.borders()])
    if cKDTree(places).query(border_places)[0].max() < 3.0 * beads.inset - error:
        return []  # a bare piece would reach to a place of the border that is farther out
    reached = along(lines, beads.inset, error)
    bare = []
    for piece in region.without(reached, least_area=LEAST_BARE * beads.inset**2):
        if piece.extent <= 2.0 * beads.inset:
            continue
        border = dense(piece.borders()[0], beads.inset)
        out = float(
            np.min([covered_region.nearest(border)[1] for covered_region in reached], axis=0).max()
        )
        if out > 2.0 * beads.inset:
            bare.append((piece, out))
    return bare


def _places(curve: PlaneCurve, step: float) -> Array:
    """Places (n, 2) along a curve, at most `step` mm apart."""
    return divided_by_step(curve.closed_points()[0], step)[0]


def outermost(
    region: Region, inner: tuple[Region, ...], beads: Beads
) -> tuple[tuple[Region, ...], list[PlaneCurve]]:
    """Return the regions inside the outermost bead, and beads in regions too thin for it.

    These are necks, or the whole region. Places hardly wider than a bead, as where ribs meet, are
    left to the beads along the middle of the ribs.

    Parameters
    ----------
    region : Region
        The region, mm.
    inner : tuple of Region
        Allowed positions of bead middles: the region shrunk by `beads.inset`.
    beads : Beads
        Width, shortest length and what to do in thin places.

    Returns
    -------
    inner : tuple of Region
        Those with borders that are long enough for a bead.
    thin : list of PlaneCurve
        Beads in thin places.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and a place is narrower than a bead.
    """
    if beads.thin != "refuse":
        long = select_longer(inner, beads.shortest)
        inner = long if long or region.area > NETWORK * beads.inset**2 else inner
    if not inner:
        return (), single_beads((region,), beads)
    reached = grow_regions(inner, beads.inset, beads.chord_error)
    uncovered, hair = region.without(reached), HAIR_SHARE * beads.chord_error
    if any(piece.extent > beads.inset and len(piece.grown(-hair, hair)) > 1 for piece in uncovered):
        # beads touch the border, where rounding leaves slits that join corners in one section and not
        # in an equal one
        reached = grow_regions(inner, beads.inset + hair, beads.chord_error)
        uncovered = region.without(reached)
    return inner, single_beads(
        [piece for piece in uncovered if _is_neck(piece, reached, beads)], beads
    )


def _is_neck(piece: Region, reached: Sequence[Region], beads: Beads) -> bool:
    """Whether a piece without beads joins two places with beads, or protrudes like ribs and blades: longer than a bead is wide, it is
    wider than the narrowest bead, or nearly as thick as a bead all along. A corner is shorter.
    """
    adjacent = [region for region in reached if region.distance(piece) < 2.0 * beads.chord_error]
    width = 2.0 * beads.inset
    if len(adjacent) != 1:
        return len(adjacent) > 1
    if piece.extent <= width:
        return False
    out = float(adjacent[0].nearest(piece.borders()[0])[1].max())
    if out <= width:
        return False
    if piece.area > RIB * width * max(out, width):
        return True
    wide = piece.grown(-0.5 * beads.thinnest, beads.chord_error)
    return any(float(adjacent[0].nearest(core.borders()[0])[1].max()) > width for core in wide)


def _along_border(region: Region) -> tuple[Array, bool]:
    """The border (n, 2) of a sliver from one of its ends to the other, and whether it is closed: the way round a hole."""
    border, *holes = region.borders()
    if holes:
        return border, True
    end = 0
    for _ in range(2):
        start, end = end, int(np.argmax(np.hypot(*(border - border[end]).T)))
    paths = [
        np.roll(border, -a, axis=0)[: (b - a) % len(border) + 1]
        for a, b in ((start, end), (end, start))
    ]
    return min(paths, key=lambda path: length(path, False)), False


def _spine(region: Region, beads: Beads, min_width: float) -> tuple[Array, bool]:
    step = min(FINE * beads.spacing, 0.4 * min_width)
    points, closed = spine(region, min_width, step)
    if len(points) > 1:
        points = _smooth(points, closed, 0.2 * beads.chord_error)
        first, last = np.round(points[[0, -1]], DIGITS).tolist()
        if not closed and last < first:
            points = points[::-1]
    return points, closed


def _smooth(points: Array, closed: bool, tolerance: float) -> Array:
    """The path without the ripple that it has from single places."""
    line = np.vstack([points, points[:1]]) if closed else points
    if len(line) > 4:
        inner = (line[:-2] + 2.0 * line[1:-1] + line[2:]) / 4.0
        line = np.vstack([line[:1], inner, line[-1:]])
    line = simplified(line, tolerance)
    return line[:-1] if closed else line


def _dab(region: Region, beads: Beads) -> Array:
    """Two places (2, 2) in the middle of a region too round for a path, along it."""
    core = max(region.grown(-0.5 * beads.gap, beads.chord_error), key=lambda region_: region_.area)
    border = region.borders()[0]
    direction = np.linalg.svd(border - border.mean(axis=0), full_matrices=False)[2][0]
    reach = 0.5 * ENDS * beads.gap * direction
    ends: Array = core.inside() + np.stack([-reach, reach])
    return ends


def _lengthened(points: Array, beads: Beads, inner: Sequence[Region]) -> Array:
    """An open bead gone on at both ends, along itself and then along the border of its room, until it is long enough; as it
    is where the room is too small."""
    for _ in range(MAX_EXTENSIONS):
        lack = beads.shortest - length(points, False)
        if lack <= 0.0:
            break
        share = np.linspace(0.0, 0.6 * lack, 5)[1:, None]
        directions = [
            out / max(float(np.hypot(*out)), 1e-300)
            for out in (points[0] - points[1], points[-1] - points[-2])
        ]
        ends = [
            move_into_regions(end + share * direction, inner)
            for end, direction in zip((points[0], points[-1]), directions)
        ]
        longer = simplified(np.vstack([ends[0][::-1], points, ends[1]]), 0.2 * beads.chord_error)
        if length(longer, False) <= length(points, False):
            break
        points = longer
    return points


def move_into_regions(points: Array, inner: Sequence[Region]) -> Array:
    """Move points outside of all regions to the nearest of them.

    Parameters
    ----------
    points : (n, 2) array
        mm.
    inner : sequence of Region
        The regions; without any the points stay.

    Returns
    -------
    (n, 2) array
        mm.
    """
    if not inner:
        return points
    outside = np.flatnonzero(~np.any([region.contains(points) for region in inner], axis=0))
    if not len(outside):
        return points
    near = [region.nearest(points[outside]) for region in inner]
    best = np.argmin([away for _, away in near], axis=0)
    moved = points.copy()
    moved[outside] = np.stack([place for place, _ in near])[best, np.arange(len(outside))]
    return moved


REACH = 3.0  # spacings around a window that decide about its open regions


def strip_closing(
    strip: Strip, curves: Sequence[PlaneCurve], beads: Beads, ring: int, kind: str
) -> list[PlaneCurve]:
    """Return beads in what curves leave open in a strip, cut where windows meet.

    Parameters
    ----------
    strip : Strip
        The strip.
    curves : sequence of PlaneCurve
        Its beads, on the unrolled plane.
    beads : Beads
        Spacing, allowed gap and shortest length, mm.
    ring : int
        Number that the curves get.
    kind : str
        Kind of the curves.

    Returns
    -------
    list of PlaneCurve
        On the unrolled plane, mm.
    """
    return [
        replace(curve, points=points, sheet=sheet)
        for window, gaps, inner in open_windows(strip, curves, beads)
        for curve in centre_beads(gaps, beads, ring, inner, kind)
        for points, sheet in (strip.moved_back(window, curve.points),)
    ]


def open_windows(
    strip: Strip, curves: Sequence[PlaneCurve], beads: Beads
) -> list[tuple[Window, list[Region], tuple[Region, ...]]]:
    """Return the open regions of a strip, window by window.

    Parameters
    ----------
    strip : Strip
        The strip.
    curves : sequence of PlaneCurve
        Its beads, on the unrolled plane.
    beads : Beads
        Spacing and allowed gap, mm.

    Returns
    -------
    list of tuple of Window, list of Region and tuple of Region
        Windows with room for beads, their open regions, and the allowed positions of bead
        centrelines, both unrolled about the middle of the window.
    """
    windows = []
    for window, adjacent in near_windows(strip, curves, REACH * beads.spacing):
        inner = grow_regions(strip.flat(window, with_margin=True), -beads.inset, beads.chord_error)
        if inner:
            windows.append(
                (
                    window,
                    list(
                        intersect_regions(open_regions(adjacent, inner, beads), strip.pane(window))
                    ),
                    inner,
                )
            )
    return windows


def near_windows(
    strip: Strip, curves: Sequence[PlaneCurve], reach: float
) -> Iterator[tuple[Window, list[PlaneCurve]]]:
    """Yield the windows of a strip with the sections of curves near each.

    Parameters
    ----------
    strip : Strip
        The strip.
    curves : sequence of PlaneCurve
        Beads on the unrolled plane.
    reach : float
        Distance from a window within which sections count, mm.

    Yields
    ------
    window : Window
        The window.
    curves : list of PlaneCurve
        Sections unrolled about its middle, mm, without shares.
    """
    curves = [
        replace(curve, points=strip.period.unwrap_curve(curve.points, curve.sheet, curve.turns))
        for curve in curves
    ]
    for window in strip.windows(reach):
        yield (
            window,
            [
                PlaneCurve(points, closed, curve.kind, curve.ring)
                for curve in curves
                for points, closed in strip.near(
                    window, curve.points, curve.closed and not curve.turns
                )
            ],
        )
