# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contours linked to spirals: once quite round at the border, then almost round and over to the next contour by a short
line, and at last quite round again, so that neither end leaves a wedge open."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.curves.plane_curve import cut_at_length, doubled_area, length, nearest, start_at
from ..geometry.regions.region import Region
from ..types import Array
from .centre import Beads, PlaneCurve, closing_beads, long_enough
from .connected import centres, levels

PROBES = 64  # samples of a ring in the search for its neighbours
PARALLEL_GAP = (
    0.02  # relative to the spacing; a ring follows another that it is that close to parallel to
)
LEAST_LENGTH = 4.0  # spacings; contours shorter than that are not linked
LINK = 3.0  # spacings; longest link


def spiral(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """Return spirals from each outer contour and each hole.

    A spiral goes on while contours follow one another singly. Where contours split or join, new
    curves begin. A contour without neighbours stays closed. Gaps of contours are filled as in
    `contours`.

    Parameters
    ----------
    region : Region
        The region to fill, mm.
    inner : tuple of Region
        Allowed positions of bead middles: the region shrunk by `beads.inset`.
    beads : Beads
        Spacing, width, gap and chord error, mm.

    Returns
    -------
    list of PlaneCurve
        Spirals from outside in, then middle beads and beads that close gaps.

    Raises
    ------
    InfeasibleError
        THIN_REGION if `beads.thin` is 'refuse' and a place is narrower than a bead.
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
    """Pairs of consecutive rings of two levels, where each ring has a single neighbour on the other level."""
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
    """The rings up to the last link, each begun where the link arrives and ended where the next leaves: the first where it began, the
    others a spacing before, so that links are side by side. A ring without an outgoing link is whole.
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
