# SPDX-License-Identifier: LGPL-2.1-or-later
"""The elements of a filling, and helpers shared by its patterns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry.curves.plane_curve import cut_at_length, doubled_area, length, start_at
from ..geometry.regions.region import Region
from ..geometry.regions.strip import Period, Strip
from ..types import Array

NEXT, OVER = (
    0.7548776662,
    0.5698402910,
)  # of a length: starts of the next contour, of the next layer (the sequence R2)
THINNEST = (
    0.6  # of a bead's width; ribs that wide get a bead even if all beads have the usual width
)
FARTHEST_TOLERANCE = 1e-9  # of a ring's extent; points less apart are equally far out


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
        """Points and shares; of a closed curve with the first repeated at the end, a period on if it goes round."""
        if not self.closed:
            return self.points, self.share
        start = self.points[:1]
        if self.turns and period is not None:
            start = period.move_turns(start, self.turns)
        return np.vstack([self.points, start]), None if self.share is None else np.r_[
            self.share, self.share[:1]
        ]


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
    narrowest: least share of the width of a bead.
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
        """A ring (n, 2) with the requested sense and start; number: of contours outside."""
        turned = points[::-1] if (doubled_area(points) < 0.0) != self.clockwise else points
        started = start_at(turned, self.start_of(turned))
        behind = 0.0 if self.spread is None else (self.spread + NEXT * number) % 1.0
        if behind == 0.0:
            return started
        loop = np.vstack([started, started[:1]])
        return start_at(started, cut_at_length(loop, behind * length(started, True))[-1])

    def start_of(self, points: Array) -> Array:
        """The place (2,) that a ring should begin nearest to."""
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
    return (
        replace(curve, points=beads.ring(curve.points, curve.ring))
        if curve.closed and not curve.turns
        else curve
    )


def contours_of(regions: Sequence[Strip | Region], beads: Beads, ring: int) -> list[PlaneCurve]:
    """The borders of regions and strips as contours."""
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
