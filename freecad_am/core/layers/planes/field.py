# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field of parallel planes: bodies that stand on the lowest of them cut layer by layer, as one or each by itself."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ...geometry.obstacles import Body
from ...geometry.on_hub import Base
from ...geometry.regions.region import Region
from ...geometry.step_count import round_up
from ...issues import InputError, Issue
from ...parameters.filled import SolidParameters
from ...slicing.solids.plane_sections import PlaneCuts
from ...types import Array
from ..margins import sections
from ..surface import Slice
from .layer import PlaneLayer

ASIDE = 0.02  # of the chord error, mm, at least; a plane keeps that far from faces that lie in it
ROUNDING = 4e-7  # of the extent of what is cut: that of vertices kept as 32-bit numbers
EXACT = 1e-6  # of a layer
FLAT = 1e-3  # largest share of a facet's size that it may rise and still lie in a plane


def count(top: float, strategy: SolidParameters) -> int:
    """How many layers a part gets that reaches to `top` mm above the first plane: those that are cut below that, a cut in
    their tops at it too, and what the margin adds."""
    levels = top / strategy.layer_height - strategy.share_of_cut
    whole = (
        math.floor(levels + EXACT) + 1 if strategy.cut_at == "top" else math.ceil(levels - EXACT)
    )
    return whole + max(round_up(strategy.margin / strategy.layer_height) - 1, 0) if whole > 0 else 0


def slices(base: Base, bodies: Sequence[Body], strategy: SolidParameters) -> Iterator[Slice]:
    """The layers of bodies upwards, on the planes 0, h, 2 h ... mm above that of the base; those without any region are left
    out. InputError TOO_LOW where no layer reaches into them."""
    cuts = [PlaneCuts(base.inside(body.vertices), body.triangles) for body in bodies]
    top = max(cut.top for cut in cuts)
    layers = count(top, strategy)
    if not layers:
        points = np.vstack([cut.vertices for cut in cuts])
        raise InputError(
            "TOO_LOW",
            "strategy.layer_height",
            "{:g} mm is too much for {}, {:.4g} mm high along strategy.direction (the "
            "highest place is at {}): no layer is cut in its {}; give at most {:.3g} mm",
            strategy.layer_height,
            ", ".join(body.name for body in bodies),
            top,
            base.where(points[points[:, 2].argmax()]),
            strategy.cut_at,
            0.99 * top / max(strategy.share_of_cut, 0.001),
        )
    for number, regions, issues in cut_together(cuts, layers, strategy):
        yield Slice(
            number,
            base,
            PlaneLayer(number * strategy.layer_height),
            regions,
            issues,
            before=number / layers,
        )


def cut_together(
    cuts: Sequence[PlaneCuts], layers: int, strategy: SolidParameters
) -> Iterator[tuple[int, tuple[Region, ...], tuple[Issue, ...]]]:
    """So many layers of bodies that have any region: number, regions, what was mended."""
    heights: Array = strategy.layer_height * (
        np.arange(layers, dtype=np.float64) + strategy.share_of_cut
    )
    return sections([cut.loops(_off_faces(cut, heights, strategy)) for cut in cuts], strategy)


def _off_faces(cut: PlaneCuts, heights: Array, strategy: SolidParameters) -> Array:
    """The heights, those moved up by a hair, or down where the top of a layer is cut, in whose plane facets lie: what a cut
    through such facets is, rounding decides."""
    aside = max(
        ASIDE * strategy.chord_error, ROUNDING * float(np.abs(cut.vertices).max(initial=0.0))
    )
    corners = cut.vertices[cut.faces]
    low, high = corners[..., 2].min(axis=1), corners[..., 2].max(axis=1)
    size = np.ptp(corners[..., :2], axis=1).max(axis=1)
    lying = np.sort(0.5 * (low + high)[(high - low < aside) & (high - low <= FLAT * size)])
    near = np.searchsorted(lying, heights - aside) < np.searchsorted(
        lying, heights + aside, side="right"
    )
    return np.where(near, heights + (-2.0 if strategy.cut_at == "top" else 2.0) * aside, heights)
