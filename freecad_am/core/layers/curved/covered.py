# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a layer is near to a top or a bottom of the part: what layers so near over and under it do not all have."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

from ...geometry.regions.region import Region
from ..surface import Slice


def under_and_over(neighbours: Sequence[Sequence[Region]]) -> tuple[Region, ...]:
    """What regions of all layers so near have in common: neither a top nor a bottom is near to it. A layer that is not there
    is an empty sequence."""
    if not all(neighbours):
        return ()
    common = tuple(neighbours[0])
    for others in neighbours[1:]:
        common = tuple(piece for part in common for piece in part.common(others))
    return common


def with_covered(slices: Iterator[Slice], thick: int) -> Iterator[Slice]:
    """Layers of one plane, each with what so many layers under it and over it all have."""
    if not thick:
        yield from slices
        return
    near: deque[Slice] = deque(maxlen=2 * thick + 1)
    waiting: deque[Slice] = deque()
    for one in slices:
        while waiting and waiting[0].layer + thick < one.layer:
            yield _covered(waiting.popleft(), near, thick)
        near.append(one)
        waiting.append(one)
    for one in waiting:
        yield _covered(one, near, thick)


def _covered(one: Slice, near: Sequence[Slice], thick: int) -> Slice:
    there = {other.layer: [part for part in other.regions if isinstance(part, Region)] for other in near}
    return one._replace(covered=under_and_over(
        [there.get(one.layer + k, []) for step in range(1, thick + 1) for k in (-step, step)]
    ))
