# SPDX-License-Identifier: LGPL-2.1-or-later
"""Void and double deposit of plane layers: their sections and beads on a raster, as shares, places and issues."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...geometry.formatting import place
from ...geometry.regions.raster import Raster, Stroke
from ...geometry.regions.region import regions
from ...geometry.regions.several import grow_regions
from ...geometry.section import Coverage, Section
from ...issues import WARNING, Issue, Text
from ...toolpath import Bead, Layer, Toolpath
from ...types import Array, Integers, Mask

CODE = "VOIDS"
PIXELS_ACROSS = 16  # of a nominal bead
MOST_PIXELS = 4e6  # of a layer; larger sections get larger pixels
KEPT_PICTURES = 4  # of layers, for equal ones
GRID_MM = 1e-4  # mm; layers whose borders and beads differ by less are equal
CANDIDATES = 8  # the largest pieces of void or double deposit, one of which has the largest circle


class Place(NamedTuple):
    """The largest circle in void or double deposit: its middle (3,) in part coordinates and diameter, mm."""

    point: Array
    size: float


@dataclass(frozen=True, eq=False)
class Picture:
    """A section and its beads on a raster; masks are (rows, columns).

    inside: the section. reached: its part that the narrowest bead reaches. covered: with deposit. depth: how many
    times deposit is there. deposit: mm^2, and single: mm^2 that this covers.
    """

    section: Section
    raster: Raster
    inside: Mask
    reached: Mask
    covered: Mask
    depth: Integers
    deposit: float
    single: float

    @property
    def void(self) -> Mask:
        """Where a bead is missing."""
        if self.section.is_sparse:
            return np.zeros_like(self.inside)
        return np.asarray(self.reached & ~self.covered)

    @property
    def double(self) -> Mask:
        """Return the pixels where deposit overlaps."""
        return np.asarray(self.depth > 1)

    @cached_property
    def coverage(self) -> Coverage:
        """The shares, without places."""
        area = self.raster.pixel**2 * np.count_nonzero(self.reached)
        void, outside = (
            self.raster.pixel**2 * np.count_nonzero(mask)
            for mask in (self.void, self.covered & ~self.inside)
        )
        return Coverage(
            math.nan if self.section.is_sparse else void / area,
            max(self.deposit - self.single, 0.0) / area,
            outside / area,
        )

    def find_places(self) -> Coverage:
        """The shares and the worst places."""
        void, over = self._largest(self.void), self._largest(self.double)
        coverage = self.coverage
        if void is not None:
            coverage = replace(coverage, void_place=void.point, void_size=void.size)
        if over is not None:
            coverage = replace(coverage, over_place=over.point, over_size=over.size)
        return coverage

    def _largest(self, mask: Mask) -> Place | None:
        """The largest circle in a mask; None in an empty one."""
        from scipy import ndimage  # slow to import, and most layers need no places

        labels, count = ndimage.label(mask)
        if not count:
            return None
        pieces = ndimage.find_objects(labels)
        largest = np.argsort(-np.bincount(labels.ravel())[1:], kind="stable")[:CANDIDATES]
        best, size = np.zeros(2), 0.0
        for number in largest.tolist():
            rows, columns = pieces[number]
            away = ndimage.distance_transform_edt(np.pad(labels[rows, columns] == number + 1, 1))
            if away.max() > size:
                size = float(away.max())
                row, column = np.unravel_index(int(away.argmax()), away.shape)
                best = np.array([row - 1 + rows.start, column - 1 + columns.start], dtype=float)
        flat = self.raster.to_plane(best[:1], best[1:])
        diameter = (2.0 * size - 1.0) * self.raster.pixel  # half a pixel less on each side
        return Place(self.section.to_part(flat)[0], diameter)


def picture(toolpath: Toolpath, number: int, across: float = PIXELS_ACROSS) -> Picture | None:
    """A layer on a raster of pixels.

    Parameters
    ----------
    toolpath : Toolpath
        Its layers have sections where these are known.
    number : int
        Number of the layer, from 0.
    across : float
        Pixels to a nominal bead width. A large layer has larger pixels, to keep the raster below a limit.

    Returns
    -------
    Picture or None
        What is inside, reached and covered; None where the section is not known or has no area.
    """
    layer = toolpath.layers[number]
    one = toolpath.features[layer.feature].values if toolpath.features else toolpath
    return None if layer.section is None else _picture(layer, layer.section, one, across)


def _picture(layer: Layer, section: Section, toolpath: Toolpath, across: float) -> Picture | None:
    """The same with the data of its feature; None too where the section has no area."""
    width = toolpath.bead_width or section.spacing
    return draw(section, strokes(layer, section, toolpath), width, across)


def draw(
    section: Section, wide: Sequence[Stroke], width: float, across: float = PIXELS_ACROSS
) -> Picture | None:
    """Draw a section and its beads on a raster.

    Parameters
    ----------
    section : Section
        The section; where neighbours overlap as its spacing plans, nothing is double.
    wide : sequence of Stroke
        Beads on its plane with their effective widths, mm.
    width : float
        Nominal width of a bead, mm.
    across : float
        Pixels to a nominal bead width.

    Returns
    -------
    Picture or None
        None where the section has no area.
    """
    share = min(section.spacing / width, 1.0)
    narrow = [stroke._replace(widths=share * stroke.widths) for stroke in wide]
    points = np.vstack([*section.loops, *(stroke.points for stroke in wide), np.zeros((0, 2))])
    if not len(points):
        return None
    reach = max([width, *(float(stroke.widths.max()) for stroke in wide)])
    room = float(np.prod(np.ptp(points, axis=0) + 2.0 * reach))
    raster = Raster.around(points, reach, max(width / across, math.sqrt(room / MOST_PIXELS)))
    inside = raster.inside(section.edges)
    if not inside.any():
        return None
    shapes, depth = raster.counts(narrow)
    covered = shapes > 0
    single = raster.pixel**2 * np.count_nonzero(covered)
    if share < 1.0:
        covered = raster.counts(wide)[0] > 0
    deposit = math.fsum(stroke.area for stroke in narrow)
    reached = _reached(section, raster, inside, section.narrowest * width)
    return Picture(section, raster, inside, reached, covered, depth, deposit, single)


def _reached(section: Section, raster: Raster, inside: Mask, width: float) -> Mask:
    """What of a section a bead of a width, mm, covers without leaving it; all of it where it covers nothing."""
    half, error = 0.5 * width, 0.25 * raster.pixel
    middles = grow_regions(regions(section.loops), -half, error)
    opened = Section(
        section.frame,
        tuple(
            border for region in grow_regions(middles, half, error) for border in region.borders()
        ),
        section.spacing,
    )
    reached = inside & raster.inside(opened.edges) if opened.loops else inside
    return reached if reached.any() else inside


def strokes(layer: Layer, section: Section, toolpath: Toolpath) -> list[Stroke]:
    """The beads of a layer on the plane of its section.

    Parameters
    ----------
    layer : Layer
        Beads in part coordinates, mm.
    section : Section
        The plane, and the bead width where the toolpath has none.
    toolpath : Toolpath
        Bead width, layer height and bead model of the feature.

    Returns
    -------
    list of Stroke
        Points (n, 2) mm without repeats, and effective widths (n - 1,) mm: volume / length / layer height. Beads without
        length are left out.
    """
    result = []
    for bead in layer.beads:
        widths = _effective_widths(bead, toolpath, section)
        stroke = Stroke(section.flat(bead.points), 0.5 * (widths[1:] + widths[:-1]))
        stroke = stroke.drop_repeats()
        if len(stroke.widths):
            result.append(stroke)
    return result


def _effective_widths(bead: Bead, toolpath: Toolpath, section: Section) -> Array:
    """(n,) mm at the points of a bead. Without a bead model, and in a layer of uneven height, beads are as high as the layer."""
    nominal = toolpath.bead_width or section.spacing
    width = np.full(len(bead), nominal) if bead.width is None else bead.width
    if bead.height is None or toolpath.law is None or toolpath.checks.uneven is not None:
        return width
    return np.asarray(width * bead.height / toolpath.layer_height)


def measure(toolpath: Toolpath, max_void: float) -> Toolpath:
    """The toolpath of one feature with the infill of its layers, and issues for those with more void than a share. The layers
    with most void and most double deposit, and those with an issue, have places."""
    coverages = _measure(toolpath)
    if not coverages:
        return toolpath
    placed = {number for number, coverage in coverages.items() if coverage.void > max_void} | set(
        worst_layers(coverages)
    )
    pictures: dict[bytes, Picture] = {}  # the last few: of equal layers in turn
    for number in sorted(placed):
        section = toolpath.layers[number].section
        assert section is not None
        key = _key(toolpath.layers[number], section, toolpath)
        exact = pictures.pop(key, None) or picture(toolpath, number)
        assert exact is not None
        exact = replace(exact, section=section)
        pictures[key] = exact
        if len(pictures) > KEPT_PICTURES:
            del pictures[next(iter(pictures))]
        coverages[number] = exact.find_places()
    layers = tuple(
        replace(layer, coverage=coverages.get(number))
        for number, layer in enumerate(toolpath.layers)
    )
    return replace(toolpath, layers=layers, issues=(*toolpath.issues, *_issues(layers, max_void)))


def _measure(toolpath: Toolpath) -> dict[int, Coverage]:
    """The infill of each layer with a section, by its number; equal layers are measured once."""
    coverages: dict[int, Coverage] = {}
    measured: dict[bytes, Coverage | None] = {}
    for number, layer in enumerate(toolpath.layers):
        if layer.section is None:
            continue
        key = _key(layer, layer.section, toolpath)
        if key not in measured:
            drawn = _picture(layer, layer.section, toolpath, PIXELS_ACROSS)
            measured[key] = None if drawn is None else drawn.coverage
        coverage = measured[key]
        if coverage is not None:
            coverages[number] = coverage
    return coverages


def _key(layer: Layer, section: Section, toolpath: Toolpath) -> bytes:
    """What equal layers have in common."""
    arrays = [
        *section.loops,
        *(array for stroke in strokes(layer, section, toolpath) for array in stroke),
    ]
    counts = np.array([len(array) for array in arrays])
    rounded = [np.rint(array / GRID_MM).astype(np.int64).tobytes() for array in arrays]
    return b"".join([counts.tobytes(), *rounded])


def worst_layers(coverages: dict[int, Coverage]) -> tuple[int, ...]:
    """The layers with most void and with most double deposit."""
    return tuple(
        max(coverages, key=lambda number: np.nan_to_num(getattr(coverages[number], name)))
        for name in ("void", "over")
        if coverages
    )


def _issues(layers: Sequence[Layer], max_void: float) -> list[Issue]:
    """A warning for each layer with beads and more void than a share: its largest place, and what helps."""
    issues = []
    for number, layer in enumerate(layers):
        coverage = layer.coverage
        if coverage is None or not layer.beads or not coverage.void > max_void:
            continue
        assert coverage.void_place is not None
        text = Text(
            "beads leave {:.3g} % of the section void, the largest place {:.3g} mm wide at {}; "
            "strategy.max_void allows {:.3g} %; set strategy.widths to adaptive, use fill: "
            "contours, narrower beads, or another fill_angle",
            100.0 * coverage.void,
            coverage.void_size,
            place(coverage.void_place),
            100.0 * max_void,
        )
        issues.append(Issue(WARNING, CODE, text, number))
    return issues


def as_dict(toolpath: Toolpath) -> dict[str, Any] | None:
    """The key `infill` of report.json; None where no layer was measured."""
    coverages = {
        number: layer.coverage
        for number, layer in enumerate(toolpath.layers)
        if layer.coverage is not None
    }
    if not coverages:
        return None
    names = ("void", "over", "outside")
    return {
        "layers": [
            {"layer": number, **{name: getattr(coverage, name) for name in names}}
            for number, coverage in coverages.items()
        ],
        **{name: _summary(coverages, name) for name in names[:2]},
    }


def _summary(coverages: dict[int, Coverage], name: str) -> dict[str, Any]:
    """Median and worst share of the layers, with the worst layer, and its largest place."""
    shares = {
        number: share
        for number, coverage in coverages.items()
        if not math.isnan(share := getattr(coverage, name))
    }
    if not shares:
        return {"median": None, "worst": None, "layer": None, "place": None}
    layer = max(shares, key=lambda number: shares[number])
    worst_place = getattr(coverages[layer], f"{name}_place")
    return {
        "median": float(np.median(list(shares.values()))),
        "worst": shares[layer],
        "layer": layer,
        "place": None if worst_place is None else worst_place.tolist(),
    }
