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
    """A layer of a stack without a bead, although the part has places there."""

    stack: Stack
    layer: Slice
    bare_places: Sequence[Bare]


def empty_layer_issues(bare: Sequence[BareLayer], course: Course) -> list[Issue]:
    """One issue for the layers of each stack without beads: which they are, the area of each, and the largest place."""
    issues = []
    for stack in dict.fromkeys(bare_layer.stack for bare_layer in bare):
        stack_layers = [bare_layer for bare_layer in bare if bare_layer.stack == stack]
        largest, layer = max(
            (
                (bare_place, bare_layer.layer)
                for bare_layer in stack_layers
                for bare_place in bare_layer.bare_places
            ),
            key=lambda pair: pair[0].area,
        )
        numbers = [
            course.number(stack.group, stack.solid, bare_layer.layer.number)
            for bare_layer in stack_layers
        ]
        layer_numbers = [
            bare_layer.layer.number if number is None else number
            for number, bare_layer in zip(numbers, stack_layers)
        ]
        issues.append(
            Issue(
                WARNING,
                "LAYER_WITHOUT_BEAD",
                Text(
                    "{} layer(s) of {} get no bead, as all regions are too narrow: {}; the "
                    "largest, {:.3g} mm^2 and {:.3g} mm wide, is at {}; the total is {:.4g} "
                    "mm^2; use narrower beads, lower strategy.narrowest, or make the part "
                    "thicker there",
                    len(stack_layers),
                    stack.name,
                    ranges(layer_numbers),
                    largest.area,
                    largest.width,
                    layer.where(largest.point),
                    math.fsum(
                        bare_place.area
                        for bare_layer in stack_layers
                        for bare_place in bare_layer.bare_places
                    ),
                ),
                numbers[0],
            )
        )
    return issues


def ranges(numbers: Sequence[int]) -> str:
    """Numbers as a text, consecutive ones as a range: 0-6, 9."""
    runs: list[list[int]] = []
    for number in sorted(set(numbers)):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)
