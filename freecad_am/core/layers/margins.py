# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions of a layer from its loops and those of the layers below it, grown by the margin that is machined off."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from ..geometry.regions.region import Region, joined, mended, regions
from ..geometry.regions.several import grow_regions
from ..issues import Issue
from ..parameters.filled import SolidParameters
from ..types import Array

BORDER, ARCS = (
    0.05,
    0.2,
)  # shares of the chord error: of borders without needless points, of fillings

Loops = TypeVar("Loops")


def within_margin(
    below: Sequence[Loops], height: float, margin: float, moved: Callable[[Loops, float], Loops]
) -> list[tuple[float, Loops]]:
    """Loops of the last layer, and of those below it within the margin moved up to it, with how far each has to grow.

    Growing within a layer covers the margin beside the part; what ends below has the margin above itself.
    """
    last = len(below) - 1
    lots = [(margin, below[last])]
    for number in range(last - 1, -1, -1):
        up = (last - number) * height
        if up >= margin:
            break
        lots.append((math.sqrt(margin * margin - up * up), moved(below[number], up)))
    return lots


def sections(
    cuts: Sequence[Iterator[list[Array]]], strategy: SolidParameters
) -> Iterator[tuple[int, tuple[Region, ...], tuple[Issue, ...]]]:
    """The layers that have any region, by the loops (n, 2) of several bodies layer by layer: number, regions, what was
    mended."""
    below: list[list[Array]] = []
    for number, loops in enumerate(zip(*cuts)):
        below.append([loop for of_body in loops for loop in of_body])
        lots = within_margin(below, strategy.layer_height, strategy.margin, lambda loops, _: loops)
        found, issues = regions_of(lots, strategy.margin, strategy.chord_error, number)
        if found:
            yield number, found, issues


def regions_of(
    lots: Sequence[tuple[float, Sequence[Array]]], margin: float, chord_error: float, number: int
) -> tuple[tuple[Region, ...], tuple[Issue, ...]]:
    """The regions of a layer from loops (n, 2) and how far (mm) each lot of them grows, without slits thinner than the chord
    error; and what was mended."""
    issues: tuple[Issue, ...] = ()
    borders: list[Array] = []
    whole: tuple[Region, ...] = ()
    for distance, loops in lots:
        read = mended(loops)
        issues += read.issues(number)
        whole = grow_regions(read.regions, distance, ARCS * chord_error)
        borders += [border for region in whole for border in region.borders()]
    if margin > 0.0:
        whole = regions(borders)
    whole = joined(whole, chord_error)
    return tuple(region.simple(BORDER * chord_error) for region in whole), issues
