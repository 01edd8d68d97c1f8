# SPDX-License-Identifier: LGPL-2.1-or-later
"""The curves over a map, and what they are taken hold of by."""

from __future__ import annotations

from dataclasses import dataclass

from ..nodes.lines import Array

OWN, PLANNED = "own", "planned"
COLOURS = {
    OWN: (255, 140, 0), PLANNED: (255, 255, 255), "constant": (0, 215, 255), "point-by-point": (255, 70, 220),
    "layer-by-layer": (140, 255, 120),
}


@dataclass(frozen=True)
class Curve:
    """A line over the map: values (C,) rad, counted on along each bead; bold: the one that can be dragged."""

    values: Array
    colour: tuple[int, int, int]
    bold: bool = False
    dashed: bool = False


@dataclass(frozen=True)
class Handle:
    """What the curve is taken hold of by: bead, number among its handles, place."""

    bead: int
    number: int
    column: float
    value: float


@dataclass
class Dragged:
    """What is being dragged, and the value it was last dragged to. handle: None for the curve itself."""

    handle: Handle | None
    column: int
    value: float
    moved: bool = False
