# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options of beads, and beads along the centrelines of gaps and thin regions."""

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
from ..geometry.regions.region import WIDENING, Region, along, simplified
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
from ..types import Array, Mask

# fractions of a bead's length by which the start moves from contour to contour and from layer to
# layer (the R2 low-discrepancy sequence)
NEXT, OVER = 0.7548776662, 0.5698402910
THINNEST = 0.6  # in bead widths; wider ribs get a bead even if all beads have the nominal width
ROUND_END = 0.25 * math.pi  # in radii; length of a rectangle with the area of a round end
LONGEST_ENDS = 0.4995  # maximum fraction of a bead's length for each round end
SHARES = 0.02  # in nominal widths; width resolution of lines of constant width
SHARE_STEP = 0.05  # in nominal widths; maximum width change along an edge of a bead
DIGITS = 6  # decimals of coordinates, mm, that decide at which end a bead begins
FARTHEST_TOLERANCE = 1e-6  # fraction of a ring's extent; points within it count as equally far out


@dataclass(frozen=True, eq=False)
class PlaneCurve:
    """Centreline of a bead.

    Attributes
    ----------
    points : (n, 2) array
        mm; a closed curve does not repeat its first point.
    closed : bool
        Whether the last point connects to the first.
    kind : str
        'contour', 'connected', 'line', 'spiral', 'zigzag', 'centre' or 'closing'.
    ring : int
        Contour index, from 0 for the outermost contour inwards.
    turns : int
        Number of turns of a closed curve around the hub. The last point connects to the first point
        moved by this number of periods.
    sheet : float
        u (`strip.Period`), mm, about which the curve is unrolled. On a wide cone it can be more
        than half a turn of the plane away from 0.
    share : (n,) array or None
        Bead share: width at each point as a fraction of the nominal width; None: 1.
    dot : bool
        Whether this is a short bead in a round region narrower than a bead. The deposited volume
        spreads to fill this region.
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
        """Return the curve in the opposite direction; a closed curve keeps its start."""
        points, share = self.points[::-1], None if self.share is None else self.share[::-1]
        if self.closed:
            points, share = np.roll(points, 1, axis=0), None if share is None else np.roll(share, 1)
        return replace(self, points=points, share=share)

    def closed_points(self, period: Period | None = None) -> tuple[Array, Array | None]:
        """Return points and bead shares; a closed curve repeats its first point at the end.

        Parameters
        ----------
        period : Period, optional
            Period of the hub. If the curve goes around the hub, the repeated point is moved by
            `turns` periods.

        Returns
        -------
        points : (n, 2) or (n + 1, 2) array
            mm.
        share : (n,) or (n + 1,) array or None
            Bead shares; None: 1.
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
        """Return the line whose offset with round ends is the bead.

        Parameters
        ----------
        inset : float
            Half the nominal width, mm.

        Returns
        -------
        points : (m, 2) array
            mm; a closed bead repeats its first point at the end. An open bead with bead shares is
            shortened so that its round ends add no volume. An open bead of nominal width keeps its
            points.
        share : (m,) array
            Bead shares.
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
    """Divide edges of a line until the bead share changes by at most SHARE_STEP along each edge.

    Each edge is deposited at a single speed.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        mm.
    share : ndarray, shape (n,)
        Bead shares.
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
        Bead shares.

    Returns
    -------
    lines : list of tuple
        Points (m, 2), mm, and False, because no line is closed.
    shares : list of float
        Bead share of each line, in steps of `SHARES`; the mean if all bead shares are within one
        step.
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
    """Format a point (2,)."""
    return f"({point[0]:.4g}, {point[1]:.4g}) mm"


@dataclass(frozen=True, eq=False)
class Beads:
    """Options for filling a region, shared by all patterns.

    Attributes
    ----------
    spacing : float
        Distance between the centrelines of neighbouring beads, mm.
    gap : float
        Maximum width of a gap that may stay open between beads, mm.
    shortest : float
        Minimum bead length, mm. Shorter gap-closing beads are extended; other shorter beads are
        dropped.
    thin : str
        'single' deposits one bead in regions or necks narrower than a bead; 'refuse' rejects them.
    clockwise : bool
        Sense of closed beads.
    start : tuple of float or float
        Point (x, y), mm, near which closed beads begin, or direction, rad, in which the start is
        the farthest point of the bead.
    chord_error : float
        Chord error of arcs, mm; 0: 0.005 spacings.
    where : callable
        Formats a point (2,).
    width : float
        Bead width, mm; 0: the spacing. The outermost bead is half a width inside the border.
    spread : float or None
        Offset of the start of the outermost closed bead after `start`, as a fraction of the bead
        length. Starts move by NEXT from contour to contour. None: all beads begin at `start`.
    narrowest : float
        Minimum bead share.
    overlap : float or None
        Fraction of the width by which line ends overlap the last wall; None: the overlap of
        neighbours.
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
        """Distance between line ends and the centreline of the last wall, mm."""
        return (
            0.5 * self.spacing if self.overlap is None else self.inset * (1.0 - 2.0 * self.overlap)
        )

    @property
    def inset(self) -> float:
        """Distance between the border and the centreline of the outermost bead, mm."""
        return 0.5 * (self.width or self.spacing)

    @property
    def thinnest(self) -> float:
        """Minimum width of ribs and round regions that get a bead, mm."""
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
            The ring, mm, without repeated first point.
        number : int, optional
            Contour index of the ring, which offsets the start if `spread` is set.

        Returns
        -------
        (m, 2) array
            The ring, mm, possibly with a new start point.
        """
        turned = points[::-1] if (doubled_area(points) < 0.0) != self.clockwise else points
        started = start_at(turned, self.start_of(turned))
        behind = 0.0 if self.spread is None else (self.spread + NEXT * number) % 1.0
        if behind == 0.0:
            return started
        loop = np.vstack([started, started[:1]])
        return start_at(started, cut_at_length(loop, behind * length(started, True))[-1])

    def start_of(self, points: Array) -> Array:
        """Return the point near which a ring should begin.

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
    """Drop curves shorter than `shortest` mm.

    Curves around the hub, which may have a single point, and dots always stay.
    """
    return [
        curve
        for curve in curves
        if curve.turns
        or curve.dot
        or (length(curve.points, curve.closed) >= shortest and len(curve.points) > 1)
    ]


def start_curve(curve: PlaneCurve, beads: Beads) -> PlaneCurve:
    """Give a closed curve the requested sense and start; return an open curve unchanged."""
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
        Contour index, 0 for the outermost.

    Returns
    -------
    list of PlaneCurve
        Closed curves of kind 'contour', mm; those of strips are on the unrolled plane.
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


ROUNDS = 12  # maximum number of passes that place beads in a gap
FINE = 0.04  # in spacings; distance between border samples that determine a centreline
MAX_EXTENSIONS = 8  # maximum number of extensions of a short bead
COARSE = 0.01  # fraction of the gap; resolution of open regions
# in squares of half a bead width; a larger region without space for contours consists of ribs
NETWORK = 12.0
RIB = 0.6  # in bead widths; a protrusion with a larger mean thickness is a rib
# in chord errors; a narrower region uses its border instead of its centreline, which is slow to
# find
SLIVER = 1.0
DOT = 5.0  # in half bead widths; maximum size of a round region narrower than a bead
# in squares of half a bead width; minimum area of a bare piece, because rounding leaves thousands
# of smaller pieces between beads
LEAST_BARE = 0.01
ENDS = 0.5  # fraction of the allowed gap; gap width at which a bead in a gap ends


def centre_beads(
    gaps: Sequence[Region], beads: Beads, ring: int, inner: Sequence[Region], kind: str = "centre"
) -> list[PlaneCurve]:
    """Place beads along the centrelines of gaps until no gap is wider than `beads.gap`.

    Beads in annular gaps are closed. All beads are moved into `inner`, and short open beads are
    extended inside these regions.

    Parameters
    ----------
    gaps : sequence of Region
        The gaps, mm.
    beads : Beads
        Spacing, allowed gap and shortest length, mm.
    ring : int
        Contour index of the curves.
    inner : sequence of Region
        Regions in which bead centrelines stay, mm; no restriction if empty.
    kind : str, optional
        Kind of the curves.

    Returns
    -------
    list of PlaneCurve
        The beads; in small regions they can be shorter than `beads.shortest`.
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
    """Return the open regions between beads that are wider than the allowed gap.

    Parameters
    ----------
    curves : sequence of PlaneCurve
        Beads.
    inner : sequence of Region
        Regions in which bead centrelines stay, mm; area out of reach of such beads does not count.
    beads : Beads
        Spacing and allowed gap, mm.

    Returns
    -------
    list of Region
        mm.
    """
    half, error = 0.5 * beads.spacing, max(beads.chord_error, COARSE * beads.gap)
    reachable = grow_regions(inner, half, error)
    lines, halves = _lines_and_halves(curves, beads.spacing, error)
    wider = WIDENING * error
    narrower = beads.gap - 4.0 * wider
    if lines and narrower > 0.0:
        covered = along(lines, halves + wider, error)
        places = select_wider(subtract_regions(reachable, covered, narrower), narrower, error)
        if not places:
            return []
        halves = halves + wider * ~_near(lines, places, halves + 2.0 * wider, half)
    covered = along(lines, halves, error)
    return select_wider(subtract_regions(reachable, covered, beads.gap), beads.gap, error)


def _near(
    lines: Sequence[tuple[Array, bool]], regions: Sequence[Region], reach: Array, step: float
) -> Mask:
    """Return whether each line (k,) comes within its reach (k,), mm, of regions; so do some lines up to a step farther away."""
    borders = [dense(border, step) for region in regions for border in region.borders()]
    samples = [
        divided_by_step(np.vstack([points, points[:1]]) if closed else points, step)[0]
        for points, closed in lines
    ]
    distances = cKDTree(np.vstack(borders)).query(np.vstack(samples))[0]
    starts = np.cumsum([0, *map(len, samples[:-1])])
    return np.asarray(np.minimum.reduceat(distances, starts) <= reach + step)


def covered_regions(
    curves: Sequence[PlaneCurve], width: float, chord_error: float
) -> tuple[Region, ...]:
    """Return the regions that beads cover, with variable widths and round ends.

    Parameters
    ----------
    curves : sequence of PlaneCurve
        Centrelines of the beads.
    width : float
        Nominal width, mm.
    chord_error : float
        Chord error of arcs, mm.

    Returns
    -------
    tuple of Region
        Regions, mm, ordered by their leftmost points.
    """
    return along(*_lines_and_halves(curves, width, chord_error), chord_error)


def _lines_and_halves(
    curves: Sequence[PlaneCurve], width: float, chord_error: float
) -> tuple[list[tuple[Array, bool]], Array]:
    """Return beads as lines of constant width, and half the width of each line, mm."""
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
    return lines, np.array(halves)


def closing_beads(
    inner: Sequence[Region],
    curves: Sequence[PlaneCurve],
    beads: Beads,
    ring: int,
    ends: Sequence[Region] = (),
) -> list[PlaneCurve]:
    """Place beads in the gaps that beads with centrelines in `inner` can reach.

    Parameters
    ----------
    inner : sequence of Region
        Regions in which bead centrelines stay, mm.
    curves : sequence of PlaneCurve
        Existing beads.
    beads : Beads
        Spacing, allowed gap and shortest length, mm.
    ring : int
        Contour index of the new curves.
    ends : sequence of Region, optional
        Regions that lines fill later (`sparse.Frame`); gaps in these regions do not count.

    Returns
    -------
    list of PlaneCurve
        New beads of kind 'closing'.
    """
    gaps = open_regions(curves, inner, beads)
    if ends:
        gaps = select_wider(subtract_regions(gaps, ends), beads.gap, beads.chord_error)
    return centre_beads(gaps, beads, ring, inner, "closing")


def single_beads(thin: Sequence[Region], beads: Beads) -> list[PlaneCurve]:
    """Return beads along the centrelines of regions narrower than a bead, longest first.

    Later beads fill only the area that earlier beads leave open. Raises InfeasibleError THIN_REGION
    if `beads.thin` is 'refuse'.
    """
    curves: list[PlaneCurve] = []
    for region in thin:
        if beads.thin == "refuse":
            raise InfeasibleError(
                "THIN_REGION",
                "filling",
                "the region at {} is {:.3g} mm wide, narrower than a bead ({:.3g} mm); use "
                "strategy.thin: single, a narrower bead or a margin",
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
            # the tapered remainder at the end of a bead is far narrower than the narrowest bead;
            # with a threshold near the width of the remainder, equal sections would get different
            # beads
            remaining = select_wider(remaining, max(beads.gap, beads.thinnest), beads.chord_error)
    return curves


def dot(region: Region, beads: Beads) -> PlaneCurve:
    """Return a short bead at the centre of a compact region narrower than a bead.

    The deposited area equals the region area: the bead gets the required length at nominal width.
    If this length is below `beads.shortest`, the bead gets that length and a smaller width.
    """
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
    """Return the pieces of a region that stay bare because they are too narrow for a bead.

    Parameters
    ----------
    region : Region
        The region, mm.
    curves : sequence of PlaneCurve
        Beads of the region; without beads the whole region is one piece.
    beads : Beads
        Width and chord error, mm.

    Returns
    -------
    list of tuple of Region and float
        Pieces, and the maximum distance of each piece from the beads, mm. This distance exceeds a
        bead width.
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
        return []  # the border of a bare piece would have a point farther from the beads
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
    """Sample points (n, 2) along a curve, at most `step` mm apart."""
    return divided_by_step(curve.closed_points()[0], step)[0]


def outermost(
    region: Region, inner: tuple[Region, ...], beads: Beads
) -> tuple[tuple[Region, ...], list[PlaneCurve]]:
    """Select the regions bounded by the outermost beads, and fill thin regions with single beads.

    Spots hardly wider than a bead, such as rib junctions, get no contour; beads along the
    centrelines of the ribs fill them.

    Parameters
    ----------
    region : Region
        The region, mm.
    inner : tuple of Region
        The region shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Width, shortest length and treatment of thin regions.

    Returns
    -------
    inner : tuple of Region
        Regions of `inner` whose borders are long enough for a bead.
    thin : list of PlaneCurve
        Beads in thin regions.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    if beads.thin != "refuse":
        long = select_longer(inner, beads.shortest)
        inner = long if long or region.area > NETWORK * beads.inset**2 else inner
    if not inner:
        return (), single_beads((region,), beads)
    reached = grow_regions(inner, beads.inset, beads.chord_error)
    # within a single part, a neck is a protrusion longer than a bead width; among several, any
    # sliver may join them
    shortest = beads.inset if len(reached) == 1 else 0.0
    uncovered = region.without(reached, least_extent=shortest)
    hair = HAIR_SHARE * beads.chord_error
    if any(piece.extent > beads.inset and len(piece.grown(-hair, hair)) > 1 for piece in uncovered):
        # beads touch the border there; rounding can leave slits that join corners in one section
        # but not in an equal section
        reached = grow_regions(inner, beads.inset + hair, beads.chord_error)
        uncovered = region.without(reached, least_extent=shortest)
    return inner, single_beads(
        [piece for piece in uncovered if _is_neck(piece, reached, beads)], beads
    )


def _is_neck(piece: Region, reached: Sequence[Region], beads: Beads) -> bool:
    """Whether a piece without beads is a neck between two filled regions, or a rib or blade.

    A rib or blade protrudes farther than a bead width. In addition, the mean thickness is close to
    the bead width, or the far part is wider than the narrowest bead. A corner protrudes less.
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
    """Return the border (n, 2) of a sliver from end to end, and whether the path is closed.

    A sliver with a hole is annular; its path is the closed outer border.
    """
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
    """Smooth the ripple of a sampled path."""
    line = np.vstack([points, points[:1]]) if closed else points
    if len(line) > 4:
        inner = (line[:-2] + 2.0 * line[1:-1] + line[2:]) / 4.0
        line = np.vstack([line[:1], inner, line[-1:]])
    line = simplified(line, tolerance)
    return line[:-1] if closed else line


def _dab(region: Region, beads: Beads) -> Array:
    """Return two points (2, 2) along the long axis at the centre of a region too round for a path."""
    core = max(region.grown(-0.5 * beads.gap, beads.chord_error), key=lambda region_: region_.area)
    border = region.borders()[0]
    direction = np.linalg.svd(border - border.mean(axis=0), full_matrices=False)[2][0]
    reach = 0.5 * ENDS * beads.gap * direction
    ends: Array = core.inside() + np.stack([-reach, reach])
    return ends


def _lengthened(points: Array, beads: Beads, inner: Sequence[Region]) -> Array:
    """Extend an open bead at both ends until its length is `beads.shortest`.

    Extensions run straight ahead, then along the border of `inner`. In a region that is too small
    the bead stays shorter.
    """
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
    """Move points that are outside all regions to the nearest region.

    Parameters
    ----------
    points : (n, 2) array
        mm.
    inner : sequence of Region
        The regions, mm; if empty the points stay.

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


REACH = 3.0  # in spacings; beads within this distance of a window determine its open regions


def strip_closing(
    strip: Strip, curves: Sequence[PlaneCurve], beads: Beads, ring: int, kind: str
) -> list[PlaneCurve]:
    """Place beads in the open regions of a strip; the beads are cut where windows meet.

    Parameters
    ----------
    strip : Strip
        The strip.
    curves : sequence of PlaneCurve
        Existing beads of the strip, on the unrolled plane.
    beads : Beads
        Spacing, allowed gap and shortest length, mm.
    ring : int
        Contour index of the new curves.
    kind : str
        Kind of the new curves.

    Returns
    -------
    list of PlaneCurve
        New beads on the unrolled plane, mm.
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
        Beads of the strip, on the unrolled plane.
    beads : Beads
        Spacing and allowed gap, mm.

    Returns
    -------
    list of tuple of Window, list of Region and tuple of Region
        Windows with space for beads, their open regions, and the regions in which bead centrelines
        stay. The regions are unrolled about the centre of the window.
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
    """Yield the windows of a strip with the nearby sections of curves.

    Parameters
    ----------
    strip : Strip
        The strip.
    curves : sequence of PlaneCurve
        Beads on the unrolled plane.
    reach : float
        Maximum distance of sections from a window, mm.

    Yields
    ------
    window : Window
        The window.
    curves : list of PlaneCurve
        Sections unrolled about the centre of the window, mm, without bead shares.
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
