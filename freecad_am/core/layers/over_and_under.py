# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a layer has no others over or under it: what is near to a top or a bottom of the part, what leans out by more than
is asked for over the layer below."""

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
ARC = 0.1  # of how far layers may lean out, or of the chord error if that is more: of the borders that are compared
NEVER = math.radians(89.9)  # nothing leans out by more
LEAST = 0.25  # of the bead spacing: sides of a square that is not worth telling of


def with_overhangs(slices: Iterable[Slice], strategy: SolidParameters) -> Iterator[Slice]:
    """Layers of one stack of planes with an issue for each that leans out by more than `max_overhang` from the direction in
    which they are stacked, with the area and where the largest piece of it is."""
    reach = strategy.layer_height * math.tan(strategy.max_overhang) + strategy.chord_error
    least = (LEAST * strategy.bead_spacing) ** 2
    before: Slice | None = None
    for layer in slices:
        issues = layer.issues
        if before is not None and strategy.max_overhang < NEVER:
            over = _over(
                layer,
                before if before.number == layer.number - 1 else None,
                reach,
                strategy.chord_error,
                least,
            )
            if over:
                largest = max(over, key=lambda part: part.area)
                issues = (
                    *issues,
                    Issue(
                        WARNING,
                        CODE,
                        Text(
                            "{:.4g} mm^2 lean out over the layer below by more than {:.4g} deg, the largest "
                            "piece at {}; deposit what carries it first, choose another strategy.direction, or raise "
                            "strategy.max_overhang",
                            math.fsum(part.area for part in over),
                            math.degrees(strategy.max_overhang),
                            layer.where(largest.inside()),
                        ),
                        layer.number,
                    ),
                )
        before = layer
        yield layer._replace(issues=issues)


def _over(
    layer: Slice, below: Slice | None, reach: float, chord_error: float, least: float
) -> list[Region]:
    """The pieces of a layer farther than `reach` mm beside the one below it."""
    here, under = (
        [region for region in regions if isinstance(region, Region)]
        for regions in (layer.regions, () if below is None else below.regions)
    )
    carried = grow_regions(under, reach, max(ARC * reach, chord_error))
    return [part for part in subtract_regions(here, carried) if part.area > least]


def under_and_over(neighbours: Sequence[Sequence[Region]]) -> tuple[Region, ...]:
    """What regions of all layers so near have in common: neither a top nor a bottom is near to it. A layer that is not there
    is an empty sequence."""
    if not all(neighbours):
        return ()
    found = tuple(neighbours[0])
    for others in neighbours[1:]:
        found = intersect_regions(found, others)
    return found


def with_buried(slices: Iterator[Slice], thick: int) -> Iterator[Slice]:
    """Layers of one plane, each with what so many layers under it and over it all have."""
    if not thick:
        yield from slices
        return
    near: deque[Slice] = deque(maxlen=2 * thick + 1)
    waiting: deque[Slice] = deque()
    for layer in slices:
        while waiting and waiting[0].number + thick < layer.number:
            yield _buried(waiting.popleft(), near, thick)
        near.append(layer)
        waiting.append(layer)
    for layer in waiting:
        yield _buried(layer, near, thick)


def _buried(layer: Slice, near: Sequence[Slice], thick: int) -> Slice:
    there = {
        other.number: [region for region in other.regions if isinstance(region, Region)]
        for other in near
    }
    return layer._replace(
        buried=under_and_over(
            [there.get(layer.number + k, []) for step in range(1, thick + 1) for k in (-step, step)]
        )
    )
