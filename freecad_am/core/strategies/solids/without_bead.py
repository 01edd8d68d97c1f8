# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of solids in which no bead finds room, named with their place and area."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ...issues import WARNING, Issue, Text
from ...layers.field import Stack
from ...layers.surface import Slice
from ...process.order import Course
from .filling import Bare


class BareLayer(NamedTuple):
    """A layer of a stack in which no bead lies, although the part has places there."""

    stack: Stack
    layer: Slice
    places: Sequence[Bare]


def without_bead(bare: Sequence[BareLayer], course: Course) -> list[Issue]:
    """One issue for the layers of each stack without beads: which they are, the area of each, and the largest place."""
    found = []
    for stack in dict.fromkeys(each.stack for each in bare):
        own = [each for each in bare if each.stack == stack]
        largest, layer = max(
            ((place, each.layer) for each in own for place in each.places),
            key=lambda pair: pair[0].area,
        )
        numbers = [course.number(stack.group, stack.solid, each.layer.number) for each in own]
        shown = [
            each.layer.number if number is None else number for number, each in zip(numbers, own)
        ]
        found.append(
            Issue(
                WARNING,
                "LAYER_WITHOUT_BEAD",
                Text(
                    "{} layer(s) of {} have places too narrow for a bead, and none in them: {}; the largest "
                    "place, {:.3g} mm^2 and {:.3g} mm wide, is at {}; all of them are {:.4g} mm^2; use narrower beads, lower "
                    "strategy.narrowest, or make the part thicker there",
                    len(own),
                    stack.name,
                    ranges(shown),
                    largest.area,
                    largest.width,
                    layer.where(largest.point),
                    math.fsum(place.area for each in own for place in each.places),
                ),
                numbers[0],
            )
        )
    return found


def ranges(numbers: Sequence[int]) -> str:
    """Numbers as a text, those that follow one another as a range: 0-6, 9."""
    runs: list[list[int]] = []
    for number in sorted(set(numbers)):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)
