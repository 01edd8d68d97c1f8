# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which field of layers a group of solids is cut by, and what of it is cut together."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..geometry.developable import Developable
from ..geometry.on_hub import Group, middle_azimuth
from ..parameters.strategy import DevelopableParameters, FilledParameters, SolidParameters
from . import planes, rotary
from .surface import Slice


class Piece(NamedTuple):
    """Solids that are filled as one: what messages call them, the azimuth (rad) of their middle about the base's axis, and
    their layers."""

    name: str
    centre: float
    slices: Iterator[Slice]


def pieces(group: Group, strategy: FilledParameters) -> list[Piece]:
    """All solids of a group: on a cylinder or cone each by itself, on a plane those that are fused as one."""
    surface = group.base.surface
    if isinstance(surface, Developable):
        assert isinstance(strategy, DevelopableParameters)
        return [
            Piece(body.name, middle_azimuth(group.base, body.vertices), rotary.slices(group.base, surface, body, strategy))
            for body in group.bodies
        ]
    assert isinstance(strategy, SolidParameters)
    lots = [group.bodies] if strategy.fuse == "auto" else [(body,) for body in group.bodies]
    return [
        Piece(lot[0].name if len(lot) == 1 else f"{len(lot)} solids", 0.0, planes.slices(group.base, lot, strategy))
        for lot in lots
    ]


def upwards(group: Group) -> bool:
    """Whether layers of the group lie flat one above the other, so that nothing deposited before stands above a layer."""
    return not isinstance(group.base.surface, Developable)
