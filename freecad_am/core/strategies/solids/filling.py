# SPDX-License-Identifier: LGPL-2.1-or-later
"""Filling of layers: equal regions are filled once, and open gaps reported with their location in the part."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple, TypeVar

import numpy as np

from ...filling.adaptive_widths import BeadLaw, adapt_contours
from ...filling.centre import OVER, Beads, PlaneCurve, bare_parts
from ...filling.cover import Cover, measure_cover, total
from ...filling.even_widths import fit_beads, narrow_beads, share_widths
from ...filling.fill import LINK, Gaps, fill, open_places
from ...filling.sparse import Infill
from ...filling.zigzag import adapt_lines
from ...geometry.curves.plane_curve import nearest_among
from ...geometry.regions.raster import Stroke
from ...geometry.regions.region import Region, join
from ...geometry.regions.several import grow_regions
from ...geometry.regions.strip import Period, Strip
from ...geometry.section import Section
from ...issues import NOTE, WARNING, InfeasibleError, InputError, Issue, Text, Word
from ...layers.margins import ARCS
from ...layers.surface import Slice
from ...parameters.filled import FILLS, FilledParameters
from ...parameters.process import ProcessParameters
from ...process.bead_model import BeadModel
from ...process.deposit.void_and_double import draw
from ...process.wire import model_wire_feed
from ...types import Array

Same = TypeVar("Same", bound=FilledParameters)

TOLERANCE_MM = 1e-6  # mm; maximum distance between the borders of equal regions
DEFAULT_WIDTH_MM = ProcessParameters().bead_width  # mm; any other width was set by the user
AREA_STEP = 0.01  # mm^2; more than the area difference of regions equal within TOLERANCE_MM
PLACES = 7  # decimals of translations, mm, that are compared without rounding errors
SIZE_STEP = 0.001  # mm; more than the width difference of equal regions
MOST_FED = (
    1.5  # maximum ratio of fed volume to layer volume; 1.5 corresponds to an overlap of one third
)
USUAL_SPACING = (
    0.738  # bead widths; spacing with a flat surface between beads (Ding, Pan, Cuiuri, Li 2015)
)
WELL_FILLED = 0.01  # fraction of a region; maximum fault at which beads of nominal width stay
BETTER = 0.8  # maximum ratio of the fault of adaptive beads to the fault of beads of nominal width
OVERLAP_SHARE = (
    0.03  # fraction of a region; maximum over-deposition at which beads are not narrowed
)
FULL_RANGE = (1.0, 1.0)  # width range of beads of nominal width
WALL_KINDS = ("contour", "centre")  # kinds of beads that are not part of a sparse pattern


class Bare(NamedTuple):
    """An area without a bead: area, mm^2, width, mm, and a point (2,) in it."""

    area: float
    width: float
    point: Array


class Filled(NamedTuple):
    """A filled layer.

    curves: beads on the plane. islands: bead indices of each region, from inside out. cover: coverage. bare: areas
    without a bead.
    """

    curves: list[PlaneCurve]
    issues: tuple[Issue, ...]
    islands: list[list[int]]
    cover: Cover
    bare: list[Bare]


class _Filling(NamedTuple):
    """Fill settings of a layer, with the fill angle on its plane, rad."""

    beads: Beads
    angle: float
    infill: Infill


class _Picture(NamedTuple):
    """A region with its filling, beads, open gaps with their widths, and coverage."""

    region: Region | Strip
    filling: _Filling
    curves: Sequence[PlaneCurve]
    gaps: Gaps
    cover: Cover
    bare: list[Bare]
    unfilled: list[Bare]  # areas inside the walls without a line of the sparse pattern

    def move(self, by: Array) -> _Picture:
        """Return the picture translated by (2,) mm."""
        return self._replace(
            curves=[replace(curve, points=curve.points + by) for curve in self.curves],
            gaps=[(point + by, width) for point, width in self.gaps],
            bare=[place._replace(point=place.point + by) for place in self.bare],
            unfilled=[room._replace(point=room.point + by) for room in self.unfilled],
        )


class _Outline(NamedTuple):
    """Translation-invariant key of a region.

    point_counts: number of points of each border. area_steps: area in steps of AREA_STEP. size_steps: width and height
    in steps of SIZE_STEP.
    """

    point_counts: tuple[int, ...]
    area_steps: int
    size_steps: tuple[int, int]

    def similar(self) -> Iterator[_Outline]:
        """Yield the keys of regions equal within TOLERANCE_MM; a size may be on either side of a step."""
        for by, wider, higher in product((0, -1, 1), repeat=3):
            wide, high = self.size_steps
            yield _Outline(self.point_counts, self.area_steps + by, (wide + wider, high + higher))


def _outline(region: Region) -> _Outline:
    counts = tuple(sorted(len(border) for border in region.borders()))
    wide, high = np.ptp(region.borders()[0], axis=0).tolist()
    steps = round(wide / SIZE_STEP), round(high / SIZE_STEP)
    return _Outline(counts, round(region.area / AREA_STEP), steps)


class Pictures:
    """Fill layers, reusing the beads of regions equal within TOLERANCE_MM.

    Solids that differ by a rotation about the hub's axis have equal regions, except for rounding.
    """

    def __init__(
        self, strategy: FilledParameters, process: ProcessParameters, width: float = 0.0
    ) -> None:
        """Create the cache; `width` is the bead width, mm, 0 for the bead spacing."""
        self._strategy = strategy
        self._process = process
        self._width = width
        self._pictures: defaultdict[tuple[Period | None, _Outline], list[_Picture]] = defaultdict(
            list
        )
        self._moved: dict[tuple[int, tuple[float, ...]], _Picture] = {}
        self._turned: dict[PlaneCurve, PlaneCurve] = {}

    def filled(self, layer: Slice, name: str) -> Filled:
        """Return the filled layer; `name` is for messages.

        Every other curve is reversed if closed curves alternate their direction or open curves spread their starts.
        Raises InfeasibleError THIN_REGION.
        """
        strategy, filling = self._strategy, self._filling(layer)
        curves: list[PlaneCurve] = []
        gaps: Gaps = []
        islands: list[list[int]] = []
        covers: list[Cover] = []
        bare: list[Bare] = []
        unfilled: list[Bare] = []
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
                    curve = self._reversed(curve)
                if isinstance(region, Region) and curve.sheet != region.sheet:
                    curve = replace(curve, sheet=region.sheet)
                curves.append(curve)
            if island:
                islands.append(sorted(island, key=lambda number: -curves[number].ring))
            gaps += picture.gaps
            covers.append(picture.cover)
            bare += picture.bare
            unfilled += picture.unfilled
        issues = self._issues(layer, curves, gaps, filling)
        if curves and bare:  # layers without beads share one issue
            issues = (*issues, _no_bead(layer, bare))
        if unfilled:
            issues = (*issues, _no_infill(layer, unfilled, strategy.fill_density))
        return Filled(curves, issues, islands, total(covers), bare)

    def _reversed(self, curve: PlaneCurve) -> PlaneCurve:
        """Return the reversed curve, always the same object so that its bead is made once."""
        if curve not in self._turned:
            self._turned[curve] = curve.reversed()
        return self._turned[curve]

    def _issues(
        self, layer: Slice, curves: Sequence[PlaneCurve], gaps: Gaps, filling: _Filling
    ) -> tuple[Issue, ...]:
        """Return the issues of a layer: open gaps, protruding single beads, a replaced pattern."""
        strategy, beads, issues = self._strategy, filling.beads, []
        regions = tuple(region for region in layer.regions if isinstance(region, Region))
        all_round = len(regions) < len(layer.regions)
        if not all_round and strategy.fill_density == 1.0:
            regions = join(regions, beads.gap)
            if regions != layer.regions:  # openings on both sides of a slit are one gap
                gaps = [gap for region in regions for gap in open_places(region, curves, beads)]
        if gaps:
            point, width = max(gaps, key=lambda gap: gap[1])
            issues.append(
                Issue(
                    WARNING,
                    "OPEN_GAP",
                    Text(
                        "beads leave {} gap(s), the widest {:.3g} mm at {}; strategy.gap allows "
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
        replacement = FILLS[strategy.fill].all_round
        if replacement and all_round:
            issues.append(
                Issue(
                    NOTE,
                    "PATTERN_ROUND_HUB",
                    Text(
                        "the layer closes around the hub, where strategy.fill = {1} is "
                        "impossible, and is filled with {0}",
                        replacement,
                        strategy.fill,
                    ),
                    layer.number,
                )
            )
        return tuple(issues)

    def _filling(self, layer: Slice) -> _Filling:
        """Return the fill settings of a layer.

        They do not depend on the azimuth of the solid on the hub. The fill angle rotates from layer to layer.
        """
        strategy, process = self._strategy, self._process
        turned = layer.surface.plane_rotation(
            layer.azimuth
        )  # rotation of the plane by the cutting line
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
            strategy.overlap_share,
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
        """Fill a region, or reuse the picture of an equal region."""
        flat = layer.surface.period is None
        if isinstance(region, Strip):
            return self._fill_region(
                region, filling._replace(infill=Infill()) if layer.buried == () else filling, flat
            )
        period, outline = layer.surface.period, _outline(region)
        has_direction = self._strategy.has_direction
        may_move = flat and filling.infill.density == 1.0  # sparse patterns have a fixed position
        for similar in outline.similar():
            for picture in self._pictures.get((period, similar), ()):
                assert isinstance(picture.region, Region)
                if not _same(picture.filling, filling, has_direction):
                    continue
                by = region.middle - picture.region.middle
                if np.abs(by).max() <= TOLERANCE_MM:
                    by = np.zeros(2)
                elif not may_move:
                    continue
                if _equal([border + by for border in picture.region.borders()], region.borders()):
                    return self._move(picture, by) if by.any() else picture
        picture = self._fill_region(region, filling, flat)
        self._pictures[period, outline].append(picture)
        return picture

    def _move(self, picture: _Picture, by: Array) -> _Picture:
        """Translate a picture by (2,) mm; equal translations return the same object."""
        place = (
            id(picture),
            tuple(np.round(by, PLACES).tolist()),
        )  # pictures stay alive, so ids are not reused
        if place not in self._moved:
            self._moved[place] = picture.move(by)
        return self._moved[place]

    def _fill_region(self, region: Region | Strip, filling: _Filling, flat: bool) -> _Picture:
        """Fill a region; intentional gaps are not reported. flat: no curve closes around the surface."""
        strategy, (beads, angle, infill) = self._strategy, filling
        sparse, (min_share, max_share) = infill.density < 1.0, strategy.spacing_range
        share = 1.0
        if isinstance(region, Region) and not sparse and strategy.rounds_alone:
            beads, share = fit_beads(region, beads, min_share, max_share)
        curves: Sequence[PlaneCurve] = fill(
            region,
            beads,
            strategy.fill,
            angle,
            strategy.rounds,
            strategy.longest_link * filling.beads.spacing,
            infill,
        )
        usual_curves = curves
        if isinstance(region, Region) and not sparse:
            curves = [*share_widths(region, curves, beads, share, min_share, max_share)]
        cover = measure_cover(region, curves, filling.beads, infill.density)
        narrowing = (
            not sparse
            and flat
            and strategy.spacing_range == FULL_RANGE
            and strategy.narrowest < 1.0
        )
        if (
            narrowing
            and cover.over(filling.beads.spacing * math.fsum(map(_weighed, curves)))
            > OVERLAP_SHARE * cover.area
        ):
            curves = narrow_beads(
                curves, filling.beads, angle, strategy.narrowest
            )  # limits the width to the available space and centres the curves in it
            cover = measure_cover(region, curves, filling.beads)
        adapted = None
        if strategy.adapts_widths and flat and isinstance(region, Region):
            adapted = _adapt_widths(region, curves, filling.beads, strategy, angle)
        if adapted:
            curves, cover, gaps = adapted
        else:
            gaps = [] if sparse else open_places(region, usual_curves, beads)
        bare = [] if sparse or not isinstance(region, Region) else bare_parts(region, curves, beads)
        bare_places = [
            Bare(bare_part.area, bare_part.width, bare_part.inside()) for bare_part, _ in bare
        ]
        unfilled = []
        if sparse and isinstance(region, Region):
            unfilled = _unfilled(region, curves, beads, strategy.rounds)
        return _Picture(region, filling, curves, gaps, cover, bare_places, unfilled)


def _adapt_widths(
    region: Region,
    curves: Sequence[PlaneCurve],
    beads: Beads,
    strategy: FilledParameters,
    angle: float,
) -> tuple[Sequence[PlaneCurve], Cover, Gaps] | None:
    """Return beads of adaptive width with cover and gaps; None if they do not fill the region better.

    angle: direction of lines, rad.
    """
    fault = _fault(region, curves, beads)
    if fault < WELL_FILLED:
        return None
    law = BeadLaw(2.0 * beads.inset, beads.spacing, strategy.narrowest, strategy.widest)
    if strategy.rounds_alone:
        adapted = adapt_contours(region, beads, law)
    else:
        link = (strategy.longest_link or LINK) * beads.spacing
        longest_link = link if FILLS[strategy.fill].is_linked else None
        adapted = adapt_lines(region, beads, law, angle, int(strategy.rounds), longest_link)
    if not adapted or _fault(region, adapted, beads) > BETTER * fault:
        return None
    return adapted, measure_cover(region, adapted, beads), open_places(region, adapted, beads)


def _fault(region: Region, curves: Sequence[PlaneCurve], beads: Beads) -> float:
    """Return the fraction of a region with missed, over-deposited or stray area, as in reports."""
    section = Section(np.eye(4), tuple(region.borders()), beads.spacing, narrowest=beads.narrowest)
    width = 2.0 * beads.inset
    picture = draw(section, [_stroke(curve, width) for curve in curves], width)
    if picture is None:
        return 0.0
    return picture.coverage.void + picture.coverage.over + picture.coverage.outside


def _stroke(curve: PlaneCurve, width: float) -> Stroke:
    """Return the deposit of a curve; `width` is the nominal width, mm."""
    points, share = curve.closed_points()
    widths = np.full(len(points), width) if share is None else width * share
    return Stroke(points, 0.5 * (widths[1:] + widths[:-1])).drop_repeats()


def _unfilled(
    region: Region, curves: Sequence[PlaneCurve], beads: Beads, rounds: float
) -> list[Bare]:
    """Return the areas inside a region's walls that could hold a bead, if the sparse pattern has no line in the region."""
    is_pattern = [curve.kind not in WALL_KINDS or curve.ring >= rounds for curve in curves]
    if math.isinf(rounds) or any(is_pattern):
        return []
    depth = 2.0 * beads.inset + (rounds - 1.0) * beads.spacing if rounds else 0.0
    rooms = grow_regions((region,), -depth, beads.chord_error)
    return [
        Bare(room.area, room.width, room.inside())
        for room in rooms
        if room.width > 2.0 * beads.inset
    ]


def _no_infill(layer: Slice, unfilled: Sequence[Bare], density: float) -> Issue:
    """Report the areas of a layer without a line of the sparse pattern."""
    largest = max(unfilled, key=lambda room: room.area)
    return Issue(
        NOTE,
        "NO_INFILL",
        Text(
            "{} region(s) have no line of the fill: strategy.fill_density of {:.3g} % is too low for "
            "their size; the largest, {:.3g} mm^2, is at {}; use a higher fill_density, or another "
            "fill_angle",
            len(unfilled),
            100.0 * density,
            largest.area,
            layer.where(largest.point),
        ),
        layer.number,
    )


def _no_bead(layer: Slice, bare: Sequence[Bare]) -> Issue:
    """Report the areas of a layer without a bead."""
    largest = max(bare, key=lambda bare_place: bare_place.area)
    return Issue(
        WARNING,
        "NO_BEAD",
        Text(
            "{} place(s) are too narrow for a bead, {:.3g} mm^2 in total; the largest, {:.3g} "
            "mm^2 and {:.3g} mm wide, is at {}; use narrower beads, lower strategy.narrowest, or "
            "make the part thicker there",
            len(bare),
            math.fsum(bare_place.area for bare_place in bare),
            largest.area,
            largest.width,
            layer.where(largest.point),
        ),
        layer.number,
    )


def _weighed(curve: PlaneCurve) -> float:
    """Return the length of a bead of nominal width with the same volume as a curve, mm."""
    points, share = curve.closed_points()
    segment_lengths = np.hypot(*np.diff(points, axis=0).T)
    return float(
        segment_lengths.sum() if share is None else 0.5 * (share[1:] + share[:-1]) @ segment_lengths
    )


def spaced(strategy: Same, process: ProcessParameters) -> Same:
    """Return the parameters with the bead spacing that follows from the overlap, if one is given."""
    if strategy.bead_overlap is None:
        return strategy
    return replace(strategy, bead_spacing=process.bead_width * (1.0 - strategy.bead_overlap))


def bead_width(
    strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None
) -> float:
    """Return the effective bead width, as selected by `process.fill_width`.

    Parameters
    ----------
    strategy : FilledParameters
        Bead spacing, mm, and overlap.
    process : ProcessParameters
        Bead width, mm, and the choice between width and spacing.
    model : BeadModel or None
        The bead model.

    Returns
    -------
    float
        Width, mm.

    Raises
    ------
    InputError
        BEAD_SPACING if the spacing exceeds the width, so that stripes would stay open.
    """
    spacing, width = strategy.bead_spacing, process.bead_width
    is_known = model is not None or strategy.bead_overlap is not None or width != DEFAULT_WIDTH_MM
    if process.fill_width == "spacing" or (process.fill_width == "auto" and not is_known):
        return spacing
    if spacing > width * (1.0 + 1e-9):
        raise InputError(
            "BEAD_SPACING",
            "strategy.bead_spacing",
            "beads {:g} mm wide (process.bead_width), {:g} mm apart, leave stripes of {:.3g} mm "
            "between them; use {:g} mm or less, or wider beads",
            width,
            spacing,
            spacing - width,
            width,
        )
    return width


def over_fed(
    strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None, width: float
) -> list[Issue]:
    """Warn if the wire feeds more than MOST_FED times the layer volume because beads are too close.

    The feed is that for the bead width, from the bead model or as given. If beads are not much wider
    than their spacing, `wire.set_wire_feed` checks a given feed.

    Parameters
    ----------
    strategy : FilledParameters
        Bead spacing and layer height, mm.
    process : ProcessParameters
        Wire, speed and bead width.
    model : BeadModel or None
        The bead model.
    width : float
        Effective bead width, mm.

    Returns
    -------
    list of Issue
        A warning BEAD_SPACING, or none.
    """
    spacing, height = strategy.bead_spacing, strategy.layer_height
    section = _fed_section(process, model, width * height)
    fed = section / (spacing * height)
    is_given = model is None and not isinstance(process.wire.feed, str)
    if fed <= MOST_FED or (is_given and width <= MOST_FED * spacing):
        return []
    overlap = strategy.bead_overlap is not None
    text = Text(
        "beads {:g} mm wide (process.bead_width) are {:.4g} mm apart ({}): the wire feeds {:.4g} "
        "mm3 per mm of bead, {:.3g} times the available {:.4g} mm3; {}",
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
    """Return the wire volume per mm of a straight bead, mm2; `usual` if the feed is automatic."""
    if model is not None:
        speed = model.straight_speed(process.bead_width)
        return process.wire.section * model_wire_feed(process, model) / speed
    if isinstance(process.wire.feed, str):
        return usual
    return process.wire.section * process.wire.feed / process.travel_speed


def _wider_apart(
    strategy: FilledParameters, process: ProcessParameters, model: BeadModel | None, section: float
) -> str:
    """Return the remedy for beads that are too close for their section, mm2."""
    width, spacing, overlap = process.bead_width, strategy.bead_spacing, strategy.bead_overlap
    if model is None and isinstance(process.wire.feed, str):
        if overlap is not None:
            return Text(
                "set strategy.bead_overlap to {:.3g} %, or remove strategy.bead_overlap and set "
                "process.fill_width to spacing",
                100.0 * (1.0 - USUAL_SPACING),
            )
        return Text(
            "set strategy.bead_spacing to {:.3g} mm, process.bead_width to {:.3g} mm, or "
            "process.fill_width to spacing",
            USUAL_SPACING * width,
            spacing / USUAL_SPACING,
        )
    balanced = section / strategy.layer_height  # mm; bead spacing that balances the feed
    if balanced > width:
        return Text(
            "set strategy.layer_height to {:.3g} mm, or reduce the wire feed",
            section / (USUAL_SPACING * width),
        )
    if overlap is not None:
        return Text(
            "set strategy.bead_overlap to {:.3g} %, or reduce the wire feed",
            100.0 * (1.0 - balanced / width),
        )
    return Text("set strategy.bead_spacing to {:.3g} mm, or reduce the wire feed", balanced)


def _standing_out(layer: Slice, curves: Sequence[PlaneCurve], beads: Beads) -> list[Issue]:
    """Report single beads in regions narrower than the bead."""
    curves = [
        curve for curve in curves if curve.kind == "centre" and curve.ring == 0 and not curve.dot
    ]
    if not curves:
        return []
    deposits = [curve.deposit(beads.inset) for curve in curves]
    points, share = (np.concatenate(column) for column in zip(*deposits))
    out = share * beads.inset - nearest_among(layer.borders, points)[1]
    worst = int(np.argmax(out))
    if out[worst] <= TOLERANCE_MM or ((share < 1.0).any() and out[worst] < 0.02 * beads.inset):
        return []
    return [
        Issue(
            NOTE,
            "THIN_SINGLE",
            Text(
                "{} single bead(s) exceed regions narrower than a bead of {:.3g} mm, by up to "
                "{:.3g} mm at {}",
                len(curves),
                2.0 * beads.inset,
                out[worst],
                layer.where(points[worst]),
            ),
            layer.number,
        )
    ]


def _same(filling: _Filling, other_filling: _Filling, has_direction: bool) -> bool:
    """Whether two fillings of equal regions are the same; has_direction: whether the angle matters."""
    between = filling.angle - other_filling.angle if has_direction else 0.0
    turned = max(
        abs(math.remainder(between, 2.0 * math.pi)),
        np.abs(np.subtract(filling.beads.start, other_filling.beads.start)).max(),
    )
    if turned >= 1e-9 or filling.beads.spread != other_filling.beads.spread:
        return False
    a, b = filling.infill, other_filling.infill
    if a.density == b.density == 1.0:
        return True
    if (
        a.height != b.height
        or abs(a.angle - b.angle) > 1e-9
        or (a.buried is None) != (b.buried is None)
    ):
        return False
    borders, other_borders = (
        tuple(border for region in infill.buried or () for border in region.borders())
        for infill in (a, b)
    )
    return _equal(borders, other_borders)


def _equal(borders: Sequence[Array], other_borders: Sequence[Array]) -> bool:
    """Whether borders (n, 2) are equal within TOLERANCE_MM, for any start point."""
    if [len(border) for border in borders] != [len(other_border) for other_border in other_borders]:
        return False
    for border, other_border in zip(borders, other_borders):
        start = int(np.argmin(((other_border - border[0]) ** 2).sum(axis=1)))
        if np.abs(np.roll(other_border, -start, axis=0) - border).max() > TOLERANCE_MM:
            return False
    return True
