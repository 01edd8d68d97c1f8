# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers filled: equal pictures once, and what stays open told with its place in the part."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from ...filling.adaptive import fitted, shared
from ...filling.cover import Cover, covered, total
from ...filling.curve import OVER, Beads, PlaneCurve
from ...filling.fill import fill, open_at_slits, open_places
from ...filling.free_width import thinned
from ...filling.sparse import Infill
from ...geometry.curves.plane_curve import nearest, steps
from ...geometry.formatting import place
from ...geometry.on_hub import Base
from ...geometry.regions.region import Region
from ...geometry.regions.strip import Strip
from ...issues import NOTE, WARNING, InfeasibleError, InputError, Issue, Text
from ...layers.margins import ARCS
from ...layers.surface import Slice
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.model.bead_model import BeadModel
from ...types import Array

Same = TypeVar("Same", bound=FilledParameters)

TOLERANCE_MM = 1e-6  # mm; regions whose borders are no farther apart are equal
USUAL = ProcessParameters().bead_width  # mm; a width that is other than that was given
MUCH = 0.03  # of a region, laid over other beads of it
EVERY = (1.0, 1.0)  # widths that all beads have
INSTEAD = {  # round a hub
    "spiral": "contours", "connected": "contours",
    "zigzag": "lines", "grid": "lines", "triangles": "lines", "honeycomb": "lines", "gyroid": "lines",
}


class Filled(NamedTuple):
    """The beads of a layer on the plane, what to know about them, the number of the region that each fills, and how well
    all of them are covered."""

    curves: list[PlaneCurve]
    issues: tuple[Issue, ...]
    islands: list[int]
    cover: Cover


class _Picture(NamedTuple):
    """A region filled: what for and how, its borders, its beads, and places left open with their widths."""

    beads: Beads
    angle: float
    infill: Infill
    rings: tuple[Array, ...]
    curves: tuple[PlaneCurve, ...]
    left: list[tuple[Array, float]]
    cover: Cover


class Pictures:
    """Fills layers. Solids alike but for a turn about the hub's axis have equal pictures, but for rounding: the beads of the
    first, within SAME of its own, are those of all."""

    def __init__(self, strategy: FilledParameters, process: ProcessParameters, width: float = 0.0) -> None:
        """width: mm of a bead, 0: the spacing."""
        self._strategy = strategy
        self._process = process
        self._width = width
        self._known: dict[tuple[float, ...], list[_Picture]] = {}

    def filled(self, layer: Slice, centre: float, base: Base) -> Filled:
        """The beads of a layer of a solid whose middle is at the azimuth `centre`, rad. InfeasibleError THIN_REGION."""
        strategy, process = self._strategy, self._process
        seam = process.seam.angle + layer.layer * process.seam.step
        turned = layer.surface.turned(centre)  # the picture, by the cutting line

        def where(point: Array) -> str:
            return place(base.placed(layer.surface.wrap(point[None]).points)[0])

        beads = Beads(
            strategy.bead_spacing, strategy.gap * strategy.bead_spacing, strategy.least_bead, strategy.thin,
            process.direction == "clockwise", seam - turned, ARCS * strategy.chord_error, where,
            self._width, layer.layer * OVER if strategy.starts == "spread" else None,
        )
        angle = strategy.fill_angle + layer.layer * strategy.fill_angle_step - turned
        infill = Infill()
        if strategy.fill_density < 1.0:
            height = layer.layer * strategy.layer_height if strategy.fill == "gyroid" else 0.0
            infill = Infill(strategy.fill_density, height, strategy.fill_angle - turned, layer.covered)
        curves: list[PlaneCurve] = []
        issues: list[Issue] = []
        gaps: list[tuple[Array, float]] = []
        islands: list[int] = []
        covers: list[Cover] = []
        for number, region in enumerate(layer.regions):
            found, left, cover = self._picture(layer, region, beads, angle, infill)
            covers.append(cover)
            found = [_from_other_end(curve) for curve in found] if beads.spread is not None and layer.layer % 2 else found
            curves += [replace(curve, sheet=region.sheet) for curve in found] if isinstance(region, Region) else found
            islands += [number] * len(found)
            gaps += left
        plain = [region for region in layer.regions if isinstance(region, Region)]
        if len(plain) == len(layer.regions) and strategy.fill_density == 1.0:
            gaps = found_at if (found_at := open_at_slits(plain, curves, beads)) is not None else gaps
        if gaps:
            point, width = max(gaps, key=lambda gap: gap[1])
            issues.append(Issue(
                WARNING, "OPEN_GAP", Text("beads leave {} gap(s) open, the widest of {:.3g} mm at {}; strategy.gap allows "
                    "{:.3g} mm", len(gaps), width, where(point), beads.gap), layer.layer,
            ))
        issues += _standing_out(layer, curves, beads)
        if strategy.fill in INSTEAD and any(isinstance(region, Strip) for region in layer.regions):
            issues.append(Issue(
                NOTE, "PATTERN_ROUND_HUB", Text("a layer all the way round the hub is filled with {}; strategy.fill = {} is "
                    "for regions with an end", INSTEAD[strategy.fill], strategy.fill), layer.layer,
            ))
        return Filled(curves, tuple(issues), islands, total(covers))

    def _picture(
        self, layer: Slice, region: Region | Strip, beads: Beads, angle: float, infill: Infill
    ) -> tuple[Sequence[PlaneCurve], list[tuple[Array, float]], Cover]:
        if isinstance(region, Strip):
            if layer.covered == ():
                infill = Infill()
            curves, left = self._made(region, beads, angle, infill)
            return curves, left, covered(region, curves, beads, infill.density)
        known = self._known.setdefault(layer.surface.alike, [])
        for other in known:
            alike = abs(other.angle - angle) < 1e-9 and abs(_number(other.beads) - _number(beads)) < 1e-9
            alike = alike and other.beads.spread == beads.spread
            if alike and _equal(other.rings, region.rings()) and _same(other.infill, infill):
                return other.curves, other.left, other.cover
        curves, left = self._made(region, beads, angle, infill)
        cover = covered(region, curves, beads, infill.density)
        if infill.density == 1.0 and layer.surface.period is None and self._strategy.spacing_range == EVERY:
            curves = self._thinned(curves, beads, angle, cover)
        known.append(_Picture(beads, angle, infill, region.rings(), curves, left, cover))
        return curves, left, cover

    def _made(
        self, region: Region | Strip, beads: Beads, angle: float, infill: Infill
    ) -> tuple[tuple[PlaneCurve, ...], list[tuple[Array, float]]]:
        """The beads of a region and what they leave open, of which nothing is told where room is left on purpose."""
        strategy = self._strategy
        links, (least, most) = strategy.longest_link * beads.spacing, strategy.spacing_range
        share = 1.0
        if isinstance(region, Region) and infill.density == 1.0 and strategy.rounds_alone:
            beads, share = fitted(region, beads, least, most)
        curves = fill(region, beads, strategy.fill, angle, strategy.rounds, links, infill)
        left = open_places(region, curves, beads) if infill.density == 1.0 else []
        if isinstance(region, Region) and infill.density == 1.0:
            curves = tuple(shared(region, curves, beads, share, least, most))
        return curves, left

    def _thinned(
        self, curves: tuple[PlaneCurve, ...], beads: Beads, angle: float, cover: Cover
    ) -> tuple[PlaneCurve, ...]:
        """The beads of a region, no wider than their room where much of them would be laid over others."""
        twice = beads.spacing * math.fsum(_weighed(curve) for curve in curves) - cover.once
        if twice <= MUCH * cover.whole or self._strategy.narrowest == 1.0:
            return curves
        return tuple(thinned(curves, beads, angle, self._strategy.narrowest))


@contextlib.contextmanager
def naming(name: str, layer: int) -> Iterator[None]:
    """What cannot be filled meanwhile is told with the name of the piece and the number of the layer."""
    try:
        yield
    except InfeasibleError as error:
        raise InfeasibleError(
            error.code, f"{name} layer {layer}", error.message,
            issues=(Issue("error", error.code, Text("{}: {}", name, error.message), layer),)
        ) from None


def _weighed(curve: PlaneCurve) -> float:
    """mm of usual bead that lays as much as a curve."""
    way = np.hypot(*steps(curve.points, curve.closed).T)
    if curve.share is None:
        return float(way.sum())
    share = np.r_[curve.share, curve.share[:1]] if curve.closed else curve.share
    return float(0.5 * (share[1:] + share[:-1]) @ way)


def spaced(strategy: Same, process: ProcessParameters) -> Same:
    """The same with the bead spacing that the overlap asks for, if one is given."""
    if strategy.bead_overlap is None:
        return strategy
    return replace(strategy, bead_spacing=process.bead_width * (1.0 - strategy.bead_overlap))


def bead_width(strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None) -> float:
    """How wide (mm) beads count: as `process.fill_width` says.

    InputError BEAD_SPACING where the spacing is larger, so that stripes would stay open."""
    spacing, width = strategy.bead_spacing, process.bead_width
    known = model is not None or strategy.bead_overlap is not None or width != USUAL
    if process.fill_width == "spacing" or (process.fill_width == "auto" and not known):
        return spacing
    if spacing > width * (1.0 + 1e-9):
        raise InputError(
            "BEAD_SPACING", "strategy.bead_spacing", "beads {:g} mm wide (process.bead_width), {:g} mm apart, leave stripes "
            "of {:.3g} mm open between them; use {:g} mm or less, or wider beads", width, spacing, spacing - width, width,
        )
    return width


def _standing_out(layer: Slice, curves: Sequence[PlaneCurve], beads: Beads) -> list[Issue]:
    """What is told of single beads in regions narrower than they are."""
    rings = [ring for region in layer.regions if isinstance(region, Region) for ring in region.rings()]
    rings += [ring for region in layer.regions if isinstance(region, Strip) for ring, _ in region.rings()]
    single = [curve for curve in curves if curve.kind == "centre" and curve.ring == 0]
    if not single:
        return []
    points = np.vstack([curve.points for curve in single])
    share = np.concatenate([np.ones(len(curve.points)) if curve.share is None else curve.share for curve in single])
    out = share * beads.inset - np.min([nearest(ring, points, closed=True).distance for ring in rings], axis=0)
    worst = int(np.argmax(out))
    if (share < 1.0).any() and out[worst] < 0.02 * beads.inset:
        return []
    return [Issue(
        NOTE, "THIN_SINGLE", Text("{} bead(s) alone in regions narrower than a bead of {:.3g} mm stand out of them, by up "
            "to {:.3g} mm at {}", len(single), 2.0 * beads.inset, out[worst], beads.where(points[worst])), layer.layer,
    )]


def _from_other_end(curve: PlaneCurve) -> PlaneCurve:
    """An open curve the other way round; a closed one as it is."""
    if curve.closed:
        return curve
    return replace(curve, points=curve.points[::-1], share=None if curve.share is None else curve.share[::-1])


def _same(one: Infill, other: Infill) -> bool:
    """Whether two layers are filled in part in the same way."""
    if one.density == other.density == 1.0:
        return True
    if one.height != other.height or abs(one.angle - other.angle) > 1e-9 or (one.covered is None) != (other.covered is None):
        return False
    rings, others = (tuple(ring for part in infill.covered or () for ring in part.rings()) for infill in (one, other))
    return _equal(rings, others)


def _number(beads: Beads) -> float:
    return float(beads.start) if not isinstance(beads.start, tuple) else math.nan


def _equal(rings: Sequence[Array], others: Sequence[Array]) -> bool:
    """Whether borders (n, 2) are the same within SAME, wherever they begin."""
    if [len(ring) for ring in rings] != [len(ring) for ring in others]:
        return False
    for ring, other in zip(rings, others):
        first = int(np.argmin(((other - ring[0]) ** 2).sum(axis=1)))
        if np.abs(np.roll(other, -first, axis=0) - ring).max() > TOLERANCE_MM:
            return False
    return True
