# SPDX-License-Identifier: LGPL-2.1-or-later
"""The curves over a map, and what they are taken hold of by."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ....core.planning.redundancy.curve import Compared, Followed
from ..draft import CONSTANT, Draft
from .board import Board

OWN, PLANNED = "own", "planned"
COLOURS = {
    OWN: (255, 140, 0),
    PLANNED: (255, 255, 255),
    "constant": (0, 215, 255),
    "point-by-point": (255, 70, 220),
    "layer-by-layer": (140, 255, 120),
}


@dataclass(frozen=True, eq=False)
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


def drawn(
    board: Board,
    draft: Draft,
    bead: int,
    planned: Sequence[Any],
    compared: Sequence[Compared],
    followed: Followed,
    shows: Callable[[str], bool],
) -> tuple[list[Curve], list[Handle], Array]:
    """Curves, handles of the user's own at a bead, and places (n, 2) of it that are bad, column and value.

    planned: beads of the joint path; compared: other methods; followed: what the user's own asks of the machine; shows:
    whether the curve of a name is to be seen.
    """
    if board.pair is not None:
        return [], [], np.zeros((0, 2))  # the rotation is what is planned there
    curves = [
        Curve(board.path_values(draft, paths), COLOURS[name], dashed=name == PLANNED)
        for name, paths in [(PLANNED, planned), *((one.name, one.paths) for one in compared)]
        if shows(name)
    ]
    if not shows(OWN):
        return curves, [], np.zeros((0, 2))
    values = board.draft_values(draft)
    curves.append(Curve(values, COLOURS[OWN], bold=True))
    return curves, _handles(board, draft, bead, values), board.bad(draft, followed, values)


def _handles(board: Board, draft: Draft, bead: int, values: Array) -> list[Handle]:
    if draft.kind == CONSTANT or not board.shows(bead):
        return []
    columns = [board.column_of(bead, float(parameter)) for parameter in draft.handles(bead)]
    return [
        Handle(bead, number, column, float(np.interp(column, np.arange(len(values)), values)))
        for number, column in enumerate(columns)
    ]
