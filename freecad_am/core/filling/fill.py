# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fill regions with any pattern.

All patterns share these steps: inset the bead centrelines, fill thin regions, add walls, close gaps
and drop short beads.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq

from ..geometry.curves.plane_curve import cut_at_length, doubled_area, length, nearest, start_at
from ..geometry.regions.medial import spine_round
from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, halves
from ..geometry.regions.strip import Strip
from ..issues import InfeasibleError, InputError
from ..parameters.filled import FILLS
from ..types import Array
from .centre import (
    FINE,
    Beads,
    PlaneCurve,
    centre_beads,
    closing_beads,
    contours_of,
    dot,
    long_enough,
    open_regions,
    open_windows,
    start_curve,
    strip_closing,
)
from .connected import centres, connect_contours, contours, levels
from .sparse import Infill, frame, lines, sparse
from .strip_lines import lines_along, lines_round

# ---- Contours linked to spirals: the first and the last contour are complete, so that neither end
# leaves an open wedge. Contours in between stop short of a full lap, and a short straight link
# leads to the next contour.

PROBES = 64  # samples per ring in the search for neighbouring rings
# in spacings; tolerance of the distance between two rings that count as parallel neighbours
PARALLEL_GAP = 0.02
LEAST_LENGTH = 4.0  # in spacings; shorter contours are not linked
LINK = 3.0  # in spacings; maximum link length of spirals, and the default for zigzags


def spiral(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """Return spirals from each outer contour and each hole.

    A spiral continues inwards while each contour has exactly one neighbour on the next level. A new
    curve begins where contours split or join. A contour without neighbours stays closed. Gaps
    between contours are filled as in `contours`.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        The region shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        Spirals from outside in, then centreline beads and gap-closing beads.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    contour_levels = levels(region, inner, beads)
    rings = [
        [border for region in regions for border in region.borders()]
        for regions in contour_levels.regions
    ]
    follower = [
        _followers(outer, inner_rings, beads.spacing)
        for outer, inner_rings in zip(rings, rings[1:])
    ] + [{}]
    led: set[tuple[int, int]] = set()
    curves = []
    for k, level in enumerate(rings):
        for number in range(len(level)):
            if (k, number) in led:
                continue
            chain = [(k, number)]
            while (following := follower[chain[-1][0]].get(chain[-1][1])) is not None:
                chain.append((chain[-1][0] + 1, following))
            sections = _linked([rings[j][n] for j, n in chain], contour_levels.regions[k:], beads)
            led.update(chain[: len(sections)])
            curves.append(_curve(sections, beads, k))
    curves = long_enough(curves + centres(contour_levels, beads), beads.shortest)
    return curves + closing_beads(inner, curves, beads, 0)


def _followers(
    outer_rings: Sequence[Array], inner_rings: Sequence[Array], spacing: float
) -> dict[int, int]:
    """Map outer rings to inner rings, where both have only each other as neighbour."""
    adjacent = np.zeros((len(outer_rings), len(inner_rings)), dtype=bool)
    for j, ring in enumerate(inner_rings):
        probes = ring[np.unique(np.linspace(0, len(ring) - 1, PROBES).astype(int))]
        probes = np.vstack(
            [probes, 0.5 * (probes + np.roll(ring, -1, axis=0)[nearest(ring, probes, True).edge])]
        )
        distance = np.stack([nearest(outer, probes, True).distance for outer in outer_rings])
        close = np.abs(distance - spacing) < PARALLEL_GAP * spacing
        adjacent[:, j] = close.mean(axis=1) > 0.05
    single = adjacent & (adjacent.sum(axis=1) == 1)[:, None] & (adjacent.sum(axis=0) == 1)
    return {int(i): int(j) for i, j in zip(*np.nonzero(single))}


def _linked(
    chain: Sequence[Array], regions: Sequence[Sequence[Region]], beads: Beads
) -> list[Array]:
    """Cut the rings of a chain at their links, up to the last possible link.

    A ring starts where the incoming link arrives. The first ring ends at its start point; later
    rings end one spacing before theirs, so that links run side by side. A ring without an outgoing
    link stays complete.
    """
    ring = beads.ring(chain[0])
    sections: list[Array] = []
    for following, inside in zip(chain[1:], regions):
        ring_length = length(ring, True)
        if ring_length < LEAST_LENGTH * beads.spacing:
            break
        loop = np.vstack([ring, ring[:1]])
        cut = cut_at_length(loop, ring_length - beads.spacing) if sections else loop
        turned = (
            following[::-1] if (doubled_area(following) < 0.0) != beads.clockwise else following
        )
        ahead = ring[:1] if sections else cut_at_length(loop, beads.spacing)[-1:]
        arrives = nearest(turned, ahead, True).points[0]
        link = cut[-1] + np.linspace(0.0, 1.0, 17)[1:-1, None] * (arrives - cut[-1])
        if np.hypot(*(arrives - cut[-1])) > LINK * beads.spacing or not _inside(link, inside):
            break
        sections.append(cut)
        ring = start_at(turned, arrives)
    sections.append(ring)
    return sections


def _curve(sections: Sequence[Array], beads: Beads, ring: int) -> PlaneCurve:
    if len(sections) == 1:
        return PlaneCurve(sections[0], True, "spiral", ring)
    return PlaneCurve(np.vstack([*sections, sections[-1][:1]]), False, "spiral", ring)


def _inside(points: Array, regions: Sequence[Region]) -> bool:
    return bool(np.any([region.contains(points) for region in regions], axis=0).all())


# ---- All patterns

# contours offset from the same borders; more would make the windows too narrow, while the error of
# a restart after this many is still small
AFRESH = 4


def strip_contours(
    strip: Strip, inner: tuple[Strip | Region, ...], beads: Beads
) -> list[PlaneCurve]:
    """Fill a strip with contours, from its borders and holes inwards, then with beads in the gaps.

    A strip narrower than a bead gets a single bead along its centreline.

    Parameters
    ----------
    strip : Strip
        The region around the hub.
    inner : tuple of Strip or Region
        The strip shrunk by `beads.inset`, mm; bead centrelines stay inside.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        Beads on the unrolled plane.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the strip is narrower than a bead everywhere.
    """
    if not inner and beads.thin == "refuse":
        raise InfeasibleError(
            "THIN_REGION",
            "filling",
            "a region around the hub is narrower than a bead ({:.3g} mm) everywhere; use "
            "strategy.thin: single, a narrower bead or a margin",
            2.0 * beads.inset,
        )
    if not inner:
        return _centre(strip, beads, 0)
    half, error = 0.5 * beads.spacing, beads.chord_error
    curves: list[PlaneCurve] = []
    start: tuple[Strip | Region, ...] = (strip,)
    k = first_ring = 0
    while inner:
        curves += contours_of(inner, beads, k)
        if k - first_ring == AFRESH:
            start, first_ring = grow_regions(inner, -half, error), k + 1
        k += 1
        last_inner, inner = (
            inner,
            grow_regions(
                start, -(half if first_ring else beads.inset) - 2 * (k - first_ring) * half, error
            ),
        )
    for region in grow_regions(last_inner, -half, error):
        if isinstance(region, Strip) and region.grown(-0.5 * beads.gap, error):
            curves += _centre(region, beads, k)
    curves = long_enough(curves, beads.shortest)
    return curves + [
        start_curve(curve, beads) for curve in strip_closing(strip, curves, beads, k, "centre")
    ]


def _centre(strip: Strip, beads: Beads, ring: int) -> list[PlaneCurve]:
    """Return a bead around the hub along the centreline of a thin strip."""
    points = spine_round(
        strip, 0.25 * beads.gap, FINE * beads.spacing, beads.chord_error, beads.spacing
    )
    if points is None:  # the strip is locally too narrow for a bead
        return centre_beads(halves(strip), beads, ring, ())
    return [
        PlaneCurve(
            points[:: -1 if beads.clockwise else 1],
            True,
            "centre",
            ring,
            -1 if beads.clockwise else 1,
        )
    ]


LESS = 0.98  # fraction of the region area; beads with less deposited area do not fill the region
EXACT = 1e-4  # in half bead widths; tolerance of the depth of a ring


def balanced(region: Region, curves: Sequence[PlaneCurve], beads: Beads) -> list[PlaneCurve]:
    """Replace a single curve that underfills a small region by a ring or a dot.

    Only regions without holes qualify, up to the area of a circle whose radius is the bead width.

    Parameters
    ----------
    region : Region
        The filled region, mm.
    curves : sequence of PlaneCurve
        Beads that fill the region.
    beads : Beads
        Width and shortest length of beads, mm.

    Returns
    -------
    list of PlaneCurve
        The curves, or one ring whose deposited area equals the region area; a dot if this ring is
        shorter than `beads.shortest`.
    """
    if len(curves) > 1 or any(curve.dot for curve in curves) or len(region.borders()) > 1:
        return list(curves)
    fed = sum(2.0 * beads.inset * length(curve.points, curve.closed) for curve in curves)
    if region.area > math.pi * (2.0 * beads.inset) ** 2 or fed >= LESS * region.area:
        return list(curves)
    if not region.grown(-beads.inset, beads.chord_error):
        return list(curves)  # `single_beads` fills regions narrower than a bead
    ring = _ring(region, beads)
    if ring is None:
        return list(curves)
    if length(ring, True) < beads.shortest:
        return [dot(region, beads)]
    return [start_curve(PlaneCurve(ring, True, "contour", 0, dot=True), beads)]


def _ring(region: Region, beads: Beads) -> Array | None:
    """Return the offset curve (n, 2) of the border whose deposited area equals the region area.

    Returns None unless the curve is a single piece.
    """

    def inside(depth: float) -> Array | None:
        regions = region.grown(-depth, beads.chord_error)
        return regions[0].borders()[0] if len(regions) == 1 else None

    def lacking(depth: float) -> float:
        border = inside(depth)
        return 0.0 if border is None else region.area - 2.0 * beads.inset * length(border, True)

    if not lacking(0.0) < 0.0 < lacking(beads.inset):
        return None
    return inside(float(brentq(lacking, 0.0, beads.inset, xtol=EXACT * beads.inset)))


PATTERNS = tuple(FILLS)
# patterns that follow the border: (region, inner regions, bead options) -> beads
ON_BORDERS = {"contours": contours, "connected": connect_contours, "spiral": spiral}
# patterns inside contours at 100 % density: (frame, bead options, angle, walls, longest link) ->
# beads
IN_FRAMES = {
    "lines": lines,
    "zigzag": lines,
    "grid": lines,
    "triangles": lines,
    "honeycomb": lines,
    "gyroid": lines,
}
SOLID = Infill()
Gaps = list[tuple[Array, float]]  # a point (2,) in each gap and the gap width, mm


def fill(
    region: Region | Strip,
    beads: Beads,
    pattern: str = "contours",
    angle: float = 0.0,
    walls: float = 0,
    longest_link: float = 0.0,
    infill: Infill = SOLID,
) -> tuple[PlaneCurve, ...]:
    """Fill a region with beads in one of PATTERNS, from outside in.

    At density 1, grid, triangles, honeycomb and gyroid become lines. In a strip around a hub, lines
    run around the hub or along it, whichever is closer to `angle`. There, patterns that follow the
    border become contours, and all other patterns become lines.

    Parameters
    ----------
    region : Region or Strip
        The region to fill, mm; a strip runs around a hub.
    beads : Beads
        Spacing, width and gap of beads, mm, and the start of closed beads.
    pattern : str, optional
        One of PATTERNS.
    angle : float, optional
        Direction of lines and zigzags from x of the plane, rad.
    walls : float, optional
        Number of contours around the pattern; infinity for contours only.
    longest_link : float, optional
        Maximum link length of zigzags, mm; 0: 3 spacings.
    infill : Infill, optional
        Density inside the walls; solid by default.

    Returns
    -------
    tuple of PlaneCurve
        Beads in the plane of the region, or on the unrolled plane of a strip.

    Raises
    ------
    InputError
        PATTERN if the pattern is unknown, MISSING_LIBRARY.
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and the region is locally narrower than a bead.
    """
    if pattern not in PATTERNS:
        raise InputError(
            "PATTERN",
            "filling",
            "unknown pattern {!r}; use one of {}",
            pattern,
            ", ".join(PATTERNS),
        )
    if not FILLS[pattern].follows_border and math.isinf(walls):
        pattern, infill = "contours", SOLID
    if isinstance(region, Strip):
        inner = region.grown(-beads.inset, beads.chord_error)
        if FILLS[pattern].follows_border or not inner:
            curves = strip_contours(region, inner, beads)
        else:
            upright = abs(math.sin(angle)) > abs(math.cos(angle))
            curves = (lines_along if upright else lines_round)(
                region, inner, beads, int(walls), infill.density
            )
        return tuple(long_enough(curves, beads.shortest))
    inner = region.grown(-beads.inset, beads.chord_error)
    if FILLS[pattern].follows_border and infill.density == 1.0:
        curves = ON_BORDERS[pattern](region, inner, beads)
    else:
        link = (longest_link or LINK * beads.spacing) if FILLS[pattern].is_linked else None
        rounds = 0 if math.isinf(walls) else int(walls)
        framed = frame(region, inner, beads, rounds)
        curves = framed.thin + framed.curves
        if infill.density == 1.0:
            curves += IN_FRAMES[pattern](framed, beads, angle, rounds, link)
            curves += closing_beads(inner, curves, beads, rounds)
        else:
            curves += sparse(framed, inner, beads, pattern, angle, rounds, link, infill)
    curves = long_enough(curves, beads.shortest)
    return tuple(balanced(region, curves, beads) if infill.density == 1.0 else curves)


def open_places(region: Region | Strip, curves: Sequence[PlaneCurve], beads: Beads) -> Gaps:
    """Find the gaps within reach of beads that are wider than `beads.gap`.

    Parameters
    ----------
    region : Region or Strip
        The filled region, mm.
    curves : sequence of PlaneCurve
        Beads that fill the region.
    beads : Beads
        Spacing, width and allowed gap, mm.

    Returns
    -------
    list of tuple of (2,) array and float
        A point in each gap and the gap width, mm. Points of a strip are unrolled about 0.
    """
    if isinstance(region, Strip):
        return [
            (region.moved_back(window, gap.inside()[None])[0][0], gap.width)
            for window, gaps, _ in open_windows(region, curves, beads)
            for gap in gaps
        ]
    inner = region.grown(-beads.inset, beads.chord_error)
    return (
        [(gap.inside(), gap.width) for gap in open_regions(curves, inner, beads)] if inner else []
    )
