# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions of a layer near the top or the bottom of the part, and regions that overhang the
layer below.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator, Sequence

from ..geometry.regions.region import Region
from ..geometry.regions.several import grow_regions, intersect_regions, subtract_regions
from ..issues import WARNING, Issue, Text
from ..parameters.filled import SolidParameters
from .surface import Slice

CODE = "OVERHANG"
ARC = 0.1  # of the allowed overhang, or of the chord error if larger: accuracy of the compared borders
NEVER = math.radians(89.9)  # nothing leans out by more
MIN_SIDE_SHARE = 0.25  # of the bead spacing: side of a square too small to report


def report_overhangs(slices: Iterable[Slice], strategy: SolidParameters) -> Iterator[Slice]:
    """Yield the layers of a stack of planes, with an issue for each that overhangs by more than
    `max_overhang`.

    The angle is from the stacking direction; the issue has the area and the position of the
    largest region.
    """
    reach = strategy.layer_height * math.tan(strategy.max_overhang) + strategy.chord_error
    min_area = (MIN_SIDE_SHARE * strategy.bead_spacing) ** 2
    previous: Slice | None = None
    for layer in slices:
        issues = layer.issues
        if previous is not None and strategy.max_overhang < NEVER:
            over = _overhanging_regions(
                layer,
                previous if previous.number == layer.number - 1 else None,
                reach,
                strategy.chord_error,
                min_area,
            )
            if over:
                largest = max(over, key=lambda region: region.area)
                issues = (
                    *issues,
                    Issue(
                        WARNING,
                        CODE,
                        Text(
                            "{:.4g} mm^2 overhang the layer below by more than {:.4g} deg, the "
                            "largest piece at {}; deposit a support first, choose another "
                            "strategy.direction, or raise strategy.max_overhang",
                            math.fsum(region.area for region in over),
                            math.degrees(strategy.max_overhang),
                            layer.where(largest.inside()),
                        ),
                        layer.number,
                    ),
                )
        previous = layer
        yield layer._replace(issues=issues)


def _overhanging_regions(
    layer: Slice, below: Slice | None, reach: float, chord_error: float, min_area: float
) -> list[Region]:
    """Return the regions of a layer more than `reach` mm beyond the layer below."""
    own_regions, under = (
        [region for region in regions if isinstance(region, Region)]
        for regions in (layer.regions, () if below is None else below.regions)
    )
    carried = grow_regions(under, reach, max(ARC * reach, chord_error))
    return [
        remainder
        for remainder in subtract_regions(own_regions, carried)
        if remainder.area > min_area
    ]


def common_regions(neighbours: Sequence[Sequence[Region]]) -> tuple[Region, ...]:
    """Return the common regions of all near layers, away from tops and bottoms. A missing layer
    is an empty sequence.
    """
    if not all(neighbours):
        return ()
    common = tuple(neighbours[0])
    for neighbour in neighbours[1:]:
        common = intersect_regions(common, neighbour)
    return common


def mark_buried(slices: Iterator[Slice], thick: int) -> Iterator[Slice]:
    """Yield the layers of one plane stack, each with the common regions of `thick` layers under
    it and over it.
    """
    if not thick:
        yield from slices
        return
    nearby: deque[Slice] = deque(maxlen=2 * thick + 1)
    waiting: deque[Slice] = deque()
    for layer in slices:
        while waiting and waiting[0].number + thick < layer.number:
            yield _buried(waiting.popleft(), nearby, thick)
        nearby.append(layer)
        waiting.append(layer)
    for layer in waiting:
        yield _buried(layer, nearby, thick)


def _buried(layer: Slice, nearby: Sequence[Slice], thick: int) -> Slice:
    regions_by_number = {
        neighbour.number: [region for region in neighbour.regions if isinstance(region, Region)]
        for neighbour in nearby
    }
    return layer._replace(
        buried=common_regions(
            [
                regions_by_number.get(layer.number + k, [])
                for step in range(1, thick + 1)
                for k in (-step, step)
            ]
        )
    )
