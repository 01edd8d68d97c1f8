# SPDX-License-Identifier: LGPL-2.1-or-later
"""Voids and over-deposition of planar layers, measured on a raster of section and beads."""

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
PIXELS_ACROSS = 16  # pixels per nominal bead width
MOST_PIXELS = 4e6  # maximum number of pixels of a layer; larger sections get larger pixels
KEPT_PICTURES = 4  # number of cached layer rasters, for equal layers
GRID_MM = 1e-4  # mm; rounding of borders and beads in the comparison of layers
CANDIDATES = 8  # number of largest voids or overlaps in which the largest circle is searched


class Place(NamedTuple):
    """Largest circle in a void or overlap: centre (3,) in part coordinates and diameter, mm."""

    point: Array
    size: float


@dataclass(frozen=True, eq=False)
class Picture:
    """A section and its beads on a raster; masks are (rows, columns).

    inside: pixels in the section. reached: pixels of the section that the narrowest bead can reach. covered: pixels with
    deposit. depth: number of beads over each pixel. deposit: total bead area, mm^2. single: area covered by beads, mm^2.
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
        """Pixels without a bead; none in a sparse section."""
        if self.section.is_sparse:
            return np.zeros_like(self.inside)
        return np.asarray(self.reached & ~self.covered)

    @property
    def double(self) -> Mask:
        """Pixels where beads overlap."""
        return np.asarray(self.depth > 1)

    @cached_property
    def coverage(self) -> Coverage:
        """Area fractions, without locations."""
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
        """Return the area fractions with the worst locations."""
        void, over = self._largest(self.void), self._largest(self.double)
        coverage = self.coverage
        if void is not None:
            coverage = replace(coverage, void_place=void.point, void_size=void.size)
        if over is not None:
            coverage = replace(coverage, over_place=over.point, over_size=over.size)
        return coverage

    def _largest(self, mask: Mask) -> Place | None:
        """Return the largest circle in a mask; None for an empty mask."""
        from scipy import ndimage  # slow to import, and most layers need no locations

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
    """Draw a layer on a raster.

    Parameters
    ----------
    toolpath : Toolpath
        Toolpath whose layers have sections, if known.
    number : int
        Index of the layer, from 0.
    across : float
        Pixels per nominal bead width. A large layer has larger pixels, to limit the raster.

    Returns
    -------
    Picture or None
        The raster; None if the section is unknown or has no area.
    """
    layer = toolpath.layers[number]
    one = toolpath.features[layer.feature].values if toolpath.features else toolpath
    return None if layer.section is None else _picture(layer, layer.section, one, across)


def _picture(layer: Layer, section: Section, toolpath: Toolpath, across: float) -> Picture | None:
    """Draw a layer with the toolpath of its feature; None if the section has no area."""
    width = toolpath.bead_width or section.spacing
    return draw(section, strokes(layer, section, toolpath), width, across)


def draw(
    section: Section, wide: Sequence[Stroke], width: float, across: float = PIXELS_ACROSS
) -> Picture | None:
    """Draw a section and its beads on a raster.

    Parameters
    ----------
    section : Section
        The section. Overlap of adjacent beads planned by its spacing does not count.
    wide : sequence of Stroke
        Beads on the section's plane with effective widths, mm; those without length do not count.
    width : float
        Nominal width of a bead, mm.
    across : float
        Pixels per nominal bead width.

    Returns
    -------
    Picture or None
        The raster; None if the section has no area.
    """
    wide = [stroke for stroke in wide if len(stroke.widths)]
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
    """Return the pixels of a section that a bead of a width, mm, can cover without leaving it.

    If the bead fits nowhere, return the whole section.
    """
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
    """Project the beads of a layer onto the plane of its section.

    Parameters
    ----------
    layer : Layer
        Beads in part coordinates, mm.
    section : Section
        The plane, and the bead width if the toolpath has none.
    toolpath : Toolpath
        Bead width, layer height and bead model of the feature.

    Returns
    -------
    list of Stroke
        Points (n, 2), mm, without repeats, and effective widths (n - 1,), mm: volume / length / layer height. Beads
        without length are omitted.
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
    """Return the effective widths at the points of a bead, (n,) mm.

    Without a bead model, and in a layer of uneven height, beads are assumed to be as high as the layer.
    """
    nominal = toolpath.bead_width or section.spacing
    width = np.full(len(bead), nominal) if bead.width is None else bead.width
    if bead.height is None or toolpath.law is None or toolpath.checks.uneven is not None:
        return width
    return np.asarray(width * bead.height / toolpath.layer_height)


def measure(toolpath: Toolpath, max_void: float) -> Toolpath:
    """Return the toolpath of one feature with the coverage of its layers.

    Layers whose void fraction exceeds `max_void` get an issue. These layers and the layers of maximum void and maximum
    overlap have locations.
    """
    coverages = _measure(toolpath)
    if not coverages:
        return toolpath
    placed = {number for number, coverage in coverages.items() if coverage.void > max_void} | set(
        worst_layers(coverages)
    )
    pictures: dict[bytes, Picture] = {}  # recent rasters, because equal layers often alternate
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
    """Return the coverage of each layer with a section, by index; equal layers are measured once."""
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
    """Return a key that equal layers share."""
    arrays = [
        *section.loops,
        *(array for stroke in strokes(layer, section, toolpath) for array in stroke),
    ]
    counts = np.array([len(array) for array in arrays])
    rounded = [np.rint(array / GRID_MM).astype(np.int64).tobytes() for array in arrays]
    return b"".join([counts.tobytes(), *rounded])


def worst_layers(coverages: dict[int, Coverage]) -> tuple[int, ...]:
    """Return the layers of maximum void and of maximum overlap."""
    return tuple(
        max(coverages, key=lambda number: np.nan_to_num(getattr(coverages[number], name)))
        for name in ("void", "over")
        if coverages
    )


def _issues(layers: Sequence[Layer], max_void: float) -> list[Issue]:
    """Return a warning for each layer with beads whose void fraction exceeds `max_void`."""
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
    """Return the value of the key `infill` in report.json; None if no layer was measured."""
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
    """Return median and maximum fraction over the layers, with the worst layer and its worst location."""
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
