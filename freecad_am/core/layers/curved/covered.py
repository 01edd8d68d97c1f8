# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a layer is near to a top or a bottom of the part: what layers so near over and under it do not all have."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

from ...geometry.regions.region import Region
from ...geometry.regions.several import common
from ..surface import Slice


def under_and_over(neighbours: Sequence[Sequence[Region]]) -> tuple[Region, ...]:
    """What regions of all layers so near have in common: neither a top nor a bottom is near to it. A layer that is not there
    is an empty sequence."""
    if not all(neighbours):
        return ()
    found = tuple(neighbours[0])
    for others in neighbours[1:]:
        found = common(found, others)
    return found


def with_covered(slices: Iterator[Slice], thick: int) -> Iterator[Slice]:
    """Layers of one plane, each with what so many layers under it and over it all have."""
    if not thick:
        yield from slices
        return
    near: deque[Slice] = deque(maxlen=2 * thick + 1)
    waiting: deque[Slice] = deque()
    for layer in slices:
        while waiting and waiting[0].number + thick < layer.number:
            yield _covered(waiting.popleft(), near, thick)
        near.append(layer)
        waiting.append(layer)
    for layer in waiting:
        yield _covered(layer, near, thick)


def _covered(layer: Slice, near: Sequence[Slice], thick: int) -> Slice:
    there = {other.number: [region for region in other.regions if isinstance(region, Region)] for other in near}
    return layer._replace(covered=under_and_over(
        [there.get(layer.number + k, []) for step in range(1, thick + 1) for k in (-step, step)]
    ))
