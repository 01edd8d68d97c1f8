# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contours linked to spirals: once quite round at the border, then almost round and over to the next contour by a short
line, and at last quite round again, so that neither end leaves a wedge open."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.curves.plane_curve import cut_at_length, doubled_area, length, nearest, start_at
from ..geometry.regions.region import Region
from ..types import Array
from .centre import closing
from .contours import centres, levels
from .curve import Beads, PlaneCurve, long_enough

PROBES = 64  # places of a ring that tell which ring it follows
PARALLEL_GAP = (
    0.02  # relative to the spacing; a ring follows another that it is that close to parallel to
)
LEAST_LENGTH = 4.0  # spacings; contours shorter than that are not linked
LINK = 3.0  # spacings; longest link


def spiral(region: Region, inner: tuple[Region, ...], beads: Beads) -> list[PlaneCurve]:
    """One curve from each outer contour and from each hole as far as contours follow one another singly; where they split or
    join, new ones begin. A contour of its own stays closed. What contours leave open is filled as theirs is."""
    found = levels(region, inner, beads)
    rings = [
        [border for region in regions for border in region.borders()] for regions in found.regions
    ]
    follower = [_followers(here, there, beads.spacing) for here, there in zip(rings, rings[1:])] + [
        {}
    ]
    led: set[tuple[int, int]] = set()
    curves = []
    for k, level in enumerate(rings):
        for number in range(len(level)):
            if (k, number) in led:
                continue
            chain = [(k, number)]
            while (following := follower[chain[-1][0]].get(chain[-1][1])) is not None:
                chain.append((chain[-1][0] + 1, following))
            pieces = _linked([rings[j][n] for j, n in chain], found.regions[k:], beads)
            led.update(chain[: len(pieces)])
            curves.append(_curve(pieces, beads, k))
    curves = long_enough(curves + centres(found, beads), beads.shortest)
    return curves + closing(inner, curves, beads, 0)


def _followers(here: Sequence[Array], there: Sequence[Array], spacing: float) -> dict[int, int]:
    """Which ring of the next level follows each of this one, where no other does and it follows no other."""
    adjacent = np.zeros((len(here), len(there)), dtype=bool)
    for j, ring in enumerate(there):
        probes = ring[np.unique(np.linspace(0, len(ring) - 1, PROBES).astype(int))]
        probes = np.vstack(
            [probes, 0.5 * (probes + np.roll(ring, -1, axis=0)[nearest(ring, probes, True).edge])]
        )
        away = np.stack([nearest(outer, probes, True).distance for outer in here])
        close = np.abs(away - spacing) < PARALLEL_GAP * spacing
        adjacent[:, j] = close.mean(axis=1) > 0.05
    single = adjacent & (adjacent.sum(axis=1) == 1)[:, None] & (adjacent.sum(axis=0) == 1)
    return {int(i): int(j) for i, j in zip(*np.nonzero(single))}


def _linked(
    chain: Sequence[Array], regions: Sequence[Sequence[Region]], beads: Beads
) -> list[Array]:
    """The rings as far as links lead, each begun where the link arrives and ended where the next leaves: the first where it
    began, the others a spacing before, so that links lie side by side. A ring that no link leads from is whole."""
    ring = beads.ring(chain[0])
    pieces: list[Array] = []
    for following, inside in zip(chain[1:], regions):
        way = length(ring, True)
        if way < LEAST_LENGTH * beads.spacing:
            break
        whole = np.vstack([ring, ring[:1]])
        cut = cut_at_length(whole, way - beads.spacing) if pieces else whole
        turned = (
            following[::-1] if (doubled_area(following) < 0.0) != beads.clockwise else following
        )
        ahead = ring[:1] if pieces else cut_at_length(whole, beads.spacing)[-1:]
        arrives = nearest(turned, ahead, True).points[0]
        link = cut[-1] + np.linspace(0.0, 1.0, 17)[1:-1, None] * (arrives - cut[-1])
        if np.hypot(*(arrives - cut[-1])) > LINK * beads.spacing or not _inside(link, inside):
            break
        pieces.append(cut)
        ring = start_at(turned, arrives)
    pieces.append(ring)
    return pieces


def _curve(pieces: Sequence[Array], beads: Beads, ring: int) -> PlaneCurve:
    if len(pieces) == 1:
        return PlaneCurve(pieces[0], True, "spiral", ring)
    return PlaneCurve(np.vstack([*pieces, pieces[-1][:1]]), False, "spiral", ring)


def _inside(points: Array, regions: Sequence[Region]) -> bool:
    return bool(np.any([region.contains(points) for region in regions], axis=0).all())
