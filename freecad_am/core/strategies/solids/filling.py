# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers filled: equal pictures once, and what stays open told with its place in the part."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from ...filling.centre import bare_parts
from ...filling.cover import Cover, covered, total
from ...filling.curve import OVER, Beads, PlaneCurve
from ...filling.fill import Gaps, fill, open_places
from ...filling.free_width import fitted, narrowed, shared
from ...filling.sparse import Infill
from ...geometry.curves.plane_curve import nearest_among
from ...geometry.regions.region import Region, joined
from ...geometry.regions.strip import Period, Strip
from ...issues import NOTE, WARNING, InfeasibleError, InputError, Issue, Text, Word
from ...layers.margins import ARCS
from ...layers.surface import Slice
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.model.bead_model import BeadModel
from ...process.model.wire import model_wire_feed
from ...types import Array

Same = TypeVar("Same", bound=FilledParameters)

TOLERANCE_MM = 1e-6  # mm; regions whose borders are no farther apart are equal
USUAL = ProcessParameters().bead_width  # mm; a width that is other than that was given
MOST_FED = 1.5  # of the room in a layer; beads that overlap by a third
USUAL_SPACING = (
    0.738  # of a width, at which the surface between beads is flat (Ding, Pan, Cuiuri, Li 2015)
)
MUCH = 0.03  # of a region, laid over other beads of it
EVERY = (1.0, 1.0)  # widths that all beads have
INSTEAD = {  # round a hub
    "spiral": "contours",
    "connected": "contours",
    "zigzag": "lines",
    "grid": "lines",
    "triangles": "lines",
    "honeycomb": "lines",
    "gyroid": "lines",
}


class Bare(NamedTuple):
    """A place in which no bead lies: its area, mm^2, its width, mm, and a point (2,) in it."""

    area: float
    width: float
    point: Array


class Filled(NamedTuple):
    """The beads of a layer on the plane, what to know about them, the numbers of those that fill each region, from inside
    out, how well all of them are covered, and where no bead lies."""

    curves: list[PlaneCurve]
    issues: tuple[Issue, ...]
    islands: list[list[int]]
    cover: Cover
    bare: list[Bare]


class _Filling(NamedTuple):
    """What a layer is filled with, and at what angle, rad, on its plane."""

    beads: Beads
    angle: float
    infill: Infill


class _Picture(NamedTuple):
    """A region, what it is filled with, its beads, places left open with their widths, and how well it is covered."""

    region: Region | Strip
    filling: _Filling
    curves: Sequence[PlaneCurve]
    gaps: Gaps
    cover: Cover
    bare: list[Bare]


class Pictures:
    """Fills layers. Solids alike but for a turn about the hub's axis have equal pictures, but for rounding: the beads of the
    first, within TOLERANCE_MM of its own, are those of all."""

    def __init__(
        self, strategy: FilledParameters, process: ProcessParameters, width: float = 0.0
    ) -> None:
        """width: mm of a bead, 0: the spacing."""
        self._strategy = strategy
        self._process = process
        self._width = width
        self._pictures: defaultdict[Period | None, list[_Picture]] = defaultdict(list)

    def filled(self, layer: Slice, name: str) -> Filled:
        """The beads of a layer of what messages call by a name; every other curve the other way round where directions of
        closed ones alternate, or starts of open ones are spread. InfeasibleError THIN_REGION."""
        strategy, filling = self._strategy, self._filling(layer)
        curves: list[PlaneCurve] = []
        gaps: Gaps = []
        islands: list[list[int]] = []
        covers: list[Cover] = []
        bare: list[Bare] = []
        for region in layer.regions:
            try:
                picture = self._picture(layer, region, filling)
            except InfeasibleError as error:
                raise InfeasibleError(
                    error.code,
                    f"{name} layer {layer.number}",
                    error.message,
                    issues=(
                        Issue(
                            "error", error.code, Text("{}: {}", name, error.message), layer.number
                        ),
                    ),
                ) from None
            island = range(len(curves), len(curves) + len(picture.curves))
            for curve in picture.curves:
                alternating = self._process.direction == "alternate" or (
                    not curve.closed and strategy.starts == "spread"
                )
                if (
                    alternating
                    and (layer.number + curve.ring if curve.closed else layer.number) % 2
                ):
                    curve = curve.reversed()
                curves.append(
                    replace(curve, sheet=region.sheet) if isinstance(region, Region) else curve
                )
            if island:
                islands.append(sorted(island, key=lambda number: -curves[number].ring))
            gaps += picture.gaps
            covers.append(picture.cover)
            bare += picture.bare
        issues = self._issues(layer, curves, gaps, filling)
        if curves and bare:  # layers without any bead are named together
            issues = (*issues, _no_bead(layer, bare))
        return Filled(curves, issues, islands, total(covers), bare)

    def _issues(
        self, layer: Slice, curves: Sequence[PlaneCurve], gaps: Gaps, filling: _Filling
    ) -> tuple[Issue, ...]:
        """What is told of a layer: what beads leave open, single ones that stand out, a pattern that is another there."""
        strategy, beads, issues = self._strategy, filling.beads, []
        regions = tuple(region for region in layer.regions if isinstance(region, Region))
        all_round = len(regions) < len(layer.regions)
        if not all_round and strategy.fill_density == 1.0:
            regions = joined(regions, beads.gap)
            if regions != layer.regions:  # what beads leave open on both sides of a slit is one gap
                gaps = [gap for region in regions for gap in open_places(region, curves, beads)]
        if gaps:
            point, width = max(gaps, key=lambda gap: gap[1])
            issues.append(
                Issue(
                    WARNING,
                    "OPEN_GAP",
                    Text(
                        "beads leave {} gap(s) open, the widest of {:.3g} mm at {}; strategy.gap allows "
                        "{:.3g} mm",
                        len(gaps),
                        width,
                        layer.where(point),
                        beads.gap,
                    ),
                    layer.number,
                )
            )
        issues += _standing_out(layer, curves, beads)
        if strategy.fill in INSTEAD and all_round:
            issues.append(
                Issue(
                    NOTE,
                    "PATTERN_ROUND_HUB",
                    Text(
                        "a layer all the way round the hub is filled with {}; strategy.fill = {} is "
                        "for regions with an end",
                        INSTEAD[strategy.fill],
                        strategy.fill,
                    ),
                    layer.number,
                )
            )
        return tuple(issues)

    def _filling(self, layer: Slice) -> _Filling:
        """What a layer is filled with: the same picture wherever round the hub its solid is, turned from layer to layer."""
        strategy, process = self._strategy, self._process
        turned = layer.surface.plane_rotation(layer.azimuth)  # the picture, by the cutting line
        beads = Beads(
            strategy.bead_spacing,
            strategy.gap * strategy.bead_spacing,
            strategy.least_bead,
            strategy.thin,
            process.direction == "clockwise",
            process.seam.angle + layer.number * process.seam.step - turned,
            ARCS * strategy.chord_error,
            layer.where,
            self._width,
            layer.number * OVER if strategy.starts == "spread" else None,
            strategy.narrowest,
        )
        infill = Infill()
        if strategy.fill_density < 1.0:
            height = layer.number * strategy.layer_height if strategy.fill == "gyroid" else 0.0
            infill = Infill(
                strategy.fill_density, height, strategy.fill_angle - turned, layer.buried
            )
        return _Filling(
            beads, strategy.fill_angle + layer.number * strategy.fill_angle_step - turned, infill
        )

    def _picture(self, layer: Slice, region: Region | Strip, filling: _Filling) -> _Picture:
        """A region filled, as one before it where that was the same."""
        flat = layer.surface.period is None
        if isinstance(region, Strip):
            return self._made(
                region, filling._replace(infill=Infill()) if layer.buried == () else filling, flat
            )
        for picture in self._pictures[layer.surface.period]:
            assert isinstance(picture.region, Region)
            if _same(picture.filling, filling) and _equal(
                picture.region.borders(), region.borders()
            ):
                return picture
        self._pictures[layer.surface.period].append(self._made(region, filling, flat))
        return self._pictures[layer.surface.period][-1]

    def _made(self, region: Region | Strip, filling: _Filling, flat: bool) -> _Picture:
        """A region filled; of what its beads leave open nothing is told where room is left on purpose. flat: nothing goes
        round the surface."""
        strategy, (beads, angle, infill) = self._strategy, filling
        sparse, (least, most) = infill.density < 1.0, strategy.spacing_range
        share = 1.0
        if isinstance(region, Region) and not sparse and strategy.rounds_alone:
            beads, share = fitted(region, beads, least, most)
        curves: Sequence[PlaneCurve] = fill(
            region,
            beads,
            strategy.fill,
            angle,
            strategy.rounds,
            strategy.longest_link * filling.beads.spacing,
            infill,
        )
        gaps = [] if sparse else open_places(region, curves, beads)
        if isinstance(region, Region) and not sparse:
            curves = [*shared(region, curves, beads, share, least, most)]
        cover = covered(region, curves, filling.beads, infill.density)
        narrowing = (
            not sparse and flat and strategy.spacing_range == EVERY and strategy.narrowest < 1.0
        )
        if (
            narrowing
            and cover.over(filling.beads.spacing * math.fsum(map(_weighed, curves)))
            > MUCH * cover.area
        ):
            curves = narrowed(
                curves, filling.beads, angle, strategy.narrowest
            )  # no wider than their room, and in the middle of it
            cover = covered(region, curves, filling.beads)
        bare = [] if sparse or not isinstance(region, Region) else bare_parts(region, curves, beads)
        places = [Bare(part.area, part.width, part.inside()) for part, _ in bare]
        return _Picture(region, filling, curves, gaps, cover, places)


def _no_bead(layer: Slice, bare: Sequence[Bare]) -> Issue:
    """What is told of places of a layer in which no bead lies."""
    largest = max(bare, key=lambda place: place.area)
    return Issue(
        WARNING,
        "NO_BEAD",
        Text(
            "{} place(s) too narrow for a bead get none, {:.3g} mm^2 in all; the largest, {:.3g} mm^2 and "
            "{:.3g} mm wide, is at {}; use narrower beads, lower strategy.narrowest, or make the part thicker there",
            len(bare),
            math.fsum(place.area for place in bare),
            largest.area,
            largest.width,
            layer.where(largest.point),
        ),
        layer.number,
    )


def _weighed(curve: PlaneCurve) -> float:
    """mm of usual bead that lays as much as a curve."""
    points, share = curve.whole()
    way = np.hypot(*np.diff(points, axis=0).T)
    return float(way.sum() if share is None else 0.5 * (share[1:] + share[:-1]) @ way)


def spaced(strategy: Same, process: ProcessParameters) -> Same:
    """The same with the bead spacing that the overlap asks for, if one is given."""
    if strategy.bead_overlap is None:
        return strategy
    return replace(strategy, bead_spacing=process.bead_width * (1.0 - strategy.bead_overlap))


def bead_width(
    strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None
) -> float:
    """How wide (mm) beads count: as `process.fill_width` says.

    InputError BEAD_SPACING where the spacing is larger, so that stripes would stay open."""
    spacing, width = strategy.bead_spacing, process.bead_width
    known = model is not None or strategy.bead_overlap is not None or width != USUAL
    if process.fill_width == "spacing" or (process.fill_width == "auto" and not known):
        return spacing
    if spacing > width * (1.0 + 1e-9):
        raise InputError(
            "BEAD_SPACING",
            "strategy.bead_spacing",
            "beads {:g} mm wide (process.bead_width), {:g} mm apart, leave stripes "
            "of {:.3g} mm open between them; use {:g} mm or less, or wider beads",
            width,
            spacing,
            spacing - width,
            width,
        )
    return width


def over_fed(
    strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None, width: float
) -> list[Issue]:
    """A warning where beads that count as `width` mm wide lie so close that what the wire feeds along them fills a layer more
    than MOST_FED times: fed for their width, as the bead model has it, or as it is given. Where beads are not much wider than
    they are apart a feed that is given is looked at by `wire.fed` alone."""
    spacing, height = strategy.bead_spacing, strategy.layer_height
    section = _fed_section(process, model, width * height)
    fed = section / (spacing * height)
    given = model is None and not isinstance(process.wire.feed, str)
    if fed <= MOST_FED or (given and width <= MOST_FED * spacing):
        return []
    overlap = strategy.bead_overlap is not None
    text = Text(
        "beads {:g} mm wide (process.bead_width) lie {:.4g} mm apart ({}): the wire feeds {:.4g} mm3 "
        "for each mm of bead, {:.3g} times the {:.4g} mm3 that it has room for; {}",
        process.bead_width,
        spacing,
        Word("strategy.bead_overlap" if overlap else "strategy.bead_spacing"),
        section,
        fed,
        spacing * height,
        _wider_apart(strategy, process, model, section),
    )
    return [Issue(WARNING, "BEAD_SPACING", text)]


def _fed_section(process: ProcessParameters, model: BeadModel | None, usual: float) -> float:
    """What the wire feeds for each mm of a straight bead, mm2; usual: where nothing else says how much."""
    if model is not None:
        speed = model.straight_speed(process.bead_width)
        return process.wire.section * model_wire_feed(process, model) / speed
    if isinstance(process.wire.feed, str):
        return usual
    return process.wire.section * process.wire.feed / process.travel_speed


def _wider_apart(
    strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None, section: float
) -> str:
    """What to do about beads that are too close for their section, mm2."""
    width, spacing, overlap = process.bead_width, strategy.bead_spacing, strategy.bead_overlap
    if model is None and isinstance(process.wire.feed, str):
        if overlap is not None:
            return Text(
                "set strategy.bead_overlap to {:.3g} %, or leave it out and set process.fill_width to spacing",
                100.0 * (1.0 - USUAL_SPACING),
            )
        return Text(
            "set strategy.bead_spacing to {:.3g} mm, process.bead_width to {:.3g} mm, or process.fill_width to spacing",
            USUAL_SPACING * width,
            spacing / USUAL_SPACING,
        )
    balanced = section / strategy.layer_height  # mm apart
    if balanced > width:
        return Text(
            "set strategy.layer_height to {:.3g} mm, or feed less wire",
            section / (USUAL_SPACING * width),
        )
    if overlap is not None:
        return Text(
            "set strategy.bead_overlap to {:.3g} %, or feed less wire",
            100.0 * (1.0 - balanced / width),
        )
    return Text("set strategy.bead_spacing to {:.3g} mm, or feed less wire", balanced)


def _standing_out(layer: Slice, curves: Sequence[PlaneCurve], beads: Beads) -> list[Issue]:
    """What is told of single beads in regions narrower than they are."""
    curves = [
        curve for curve in curves if curve.kind == "centre" and curve.ring == 0 and not curve.dot
    ]
    if not curves:
        return []
    points = np.vstack([curve.points for curve in curves])
    share = np.concatenate(
        [np.ones(len(curve.points)) if curve.share is None else curve.share for curve in curves]
    )
    out = share * beads.inset - nearest_among(layer.borders, points)[1]
    worst = int(np.argmax(out))
    if out[worst] <= TOLERANCE_MM or ((share < 1.0).any() and out[worst] < 0.02 * beads.inset):
        return []
    return [
        Issue(
            NOTE,
            "THIN_SINGLE",
            Text(
                "{} bead(s) alone in regions narrower than a bead of {:.3g} mm stand out of them, by up "
                "to {:.3g} mm at {}",
                len(curves),
                2.0 * beads.inset,
                out[worst],
                layer.where(points[worst]),
            ),
            layer.number,
        )
    ]


def _same(one: _Filling, other: _Filling) -> bool:
    """Whether equal regions are filled in the same way."""
    turned = max(
        abs(one.angle - other.angle), np.abs(np.subtract(one.beads.start, other.beads.start)).max()
    )
    if turned >= 1e-9 or one.beads.spread != other.beads.spread:
        return False
    a, b = one.infill, other.infill
    if a.density == b.density == 1.0:
        return True
    if (
        a.height != b.height
        or abs(a.angle - b.angle) > 1e-9
        or (a.buried is None) != (b.buried is None)
    ):
        return False
    borders, others = (
        tuple(border for region in infill.buried or () for border in region.borders())
        for infill in (a, b)
    )
    return _equal(borders, others)


def _equal(borders: Sequence[Array], others: Sequence[Array]) -> bool:
    """Whether borders (n, 2) are the same within TOLERANCE_MM, wherever they begin."""
    if [len(border) for border in borders] != [len(other) for other in others]:
        return False
    for border, other in zip(borders, others):
        first = int(np.argmin(((other - border[0]) ** 2).sum(axis=1)))
        if np.abs(np.roll(other, -first, axis=0) - border).max() > TOLERANCE_MM:
            return False
    return True
