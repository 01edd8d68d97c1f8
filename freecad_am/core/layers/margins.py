# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build the regions of a layer from loops of this layer and the layers below, grown by the margin."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from ..geometry.regions.region import Region, join, mended, regions
from ..geometry.regions.several import grow_regions
from ..issues import Issue
from ..parameters.filled import SolidParameters
from ..types import Array

# fractions of the chord error: tolerance of simplified borders, and error of arcs of grown regions
BORDER, ARCS = 0.05, 0.2

Loops = TypeVar("Loops")


def within_margin(
    below: Sequence[Loops], height: float, margin: float, moved: Callable[[Loops, float], Loops]
) -> list[tuple[float, Loops]]:
    """Return the loops from which a layer with margin is grown, and their growths.

    Growing the loops of the layer adds the margin beside the part. Growing the loops of layers
    below adds the margin above surfaces that end below this layer.

    Parameters
    ----------
    below : sequence of Loops
        Loops of the layers up to and including this layer.
    height : float
        Layer height, mm.
    margin : float
        Machining margin, mm.
    moved : callable
        Returns loops moved up by a distance, mm.

    Returns
    -------
    list of (float, Loops)
        Growths, mm, and loops; those of this layer come first.
    """
    last_layer = len(below) - 1
    lots = [(margin, below[last_layer])]
    for number in range(last_layer - 1, -1, -1):
        up = (last_layer - number) * height
        if up >= margin:
            break
        lots.append((math.sqrt(margin * margin - up * up), moved(below[number], up)))
    return lots


def sections(
    cuts: Sequence[Iterator[list[Array]]], strategy: SolidParameters
) -> Iterator[tuple[int, tuple[Region, ...], tuple[Issue, ...]]]:
    """Yield the regions of each layer of several bodies; empty layers are skipped.

    Parameters
    ----------
    cuts : Sequence[Iterator[list[Array]]]
        Loops (n, 2) of each layer, for each body.
    strategy : SolidParameters
        Layer height, margin and chord error.

    Yields
    ------
    number : int
        Layer number.
    regions : tuple of Region
        Regions of the layer, mm.
    issues : tuple of Issue
        Repairs.
    """
    below: list[list[Array]] = []
    for number, loops in enumerate(zip(*cuts)):
        below.append([loop for of_body in loops for loop in of_body])
        lots = within_margin(below, strategy.layer_height, strategy.margin, lambda loops, _: loops)
        grown_regions, issues = regions_of(lots, strategy.margin, strategy.chord_error, number)
        if grown_regions:
            yield number, grown_regions, issues


def regions_of(
    lots: Sequence[tuple[float, Sequence[Array]]], margin: float, chord_error: float, number: int
) -> tuple[tuple[Region, ...], tuple[Issue, ...]]:
    """Return the regions of a layer from loops and their growth.

    Slits thinner than the chord error are closed.

    Parameters
    ----------
    lots : Sequence[tuple[float, Sequence[Array]]]
        Growths, mm, and loops (n, 2), mm.
    margin : float
        Machining margin, mm.
    chord_error : float
        Chord error, mm.
    number : int
        Layer number, for issues.

    Returns
    -------
    regions : tuple of Region
        The regions.
    issues : tuple of Issue
        Repairs.
    """
    issues: tuple[Issue, ...] = ()
    borders: list[Array] = []
    all_regions: tuple[Region, ...] = ()
    for distance, loops in lots:
        repaired = mended(loops)
        issues += repaired.issues(number)
        all_regions = grow_regions(repaired.regions, distance, ARCS * chord_error)
        borders += [border for region in all_regions for border in region.borders()]
    if margin > 0.0:
        all_regions = regions(borders)
    all_regions = join(all_regions, chord_error)
    return tuple(region.simple(BORDER * chord_error) for region in all_regions), issues
