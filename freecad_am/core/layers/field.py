# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which field of layers a group of solids is cut by, and what of it is cut together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ..geometry.curves.guide import Guide
from ..geometry.developable import Developable
from ..geometry.obstacles import Body
from ..geometry.on_hub import Group
from ..parameters.filled import DevelopableParameters, FilledParameters, SolidParameters
from ..slicing.solids.equidistant import Facets
from ..slicing.solids.plane_sections import PlaneCuts
from ..slicing.solids.unrolled import cut
from ..types import Array
from .along import field as along
from .along.field import AlongCuts
from .curved import field as curved
from .over_and_under import with_buried, with_overhangs
from .planes import field as planes
from .planes.layer import PlaneLayer
from .rotary import field as rotary
from .surface import Slice


class Stack(NamedTuple):
    """Solids that are filled as one: what messages call them, and their layers."""

    name: str
    slices: Iterator[Slice]


def stacks(group: Group, substrate: Sequence[Body], strategy: FilledParameters) -> list[Stack]:
    """All solids of a group: on a cylinder or cone each by itself, on a plane those that are fused as one."""
    surface = group.base.surface
    if isinstance(surface, Developable):
        assert isinstance(strategy, DevelopableParameters)
        return [Stack(body.name, rotary.slices(group.base, body, strategy)) for body in group.bodies]
    assert isinstance(strategy, SolidParameters)
    if strategy.layers in ("geodesic", "offset"):
        return [Stack(group.bodies[0].name, curved.slices(group, substrate, strategy))]
    lots = [group.bodies] if strategy.fuse == "auto" else [(body,) for body in group.bodies]
    found: list[Stack] = []
    for lot in lots:
        layers: Iterable[Slice]
        if isinstance(surface, Guide):
            layers = along.slices(group.base, lot, strategy)
        else:
            layers = planes.slices(group.base, lot, strategy)
        layers = with_overhangs(layers, strategy)
        name = lot[0].name if len(lot) == 1 else f"{len(lot)} solids"
        found.append(Stack(name, with_buried(layers, strategy.thick)))
    return found


def footprints(group: Group, chord_error: float) -> list[list[Array]]:
    """Where each solid of a group leaves its base: closed curves (k, 3) in part coordinates, the first point not repeated;
    on planes cut a chord error above it. InputError OPEN_MESH, GUIDE_TIGHT."""
    base, surface = group.base, group.base.surface
    if isinstance(surface, Developable):
        made = [Facets(surface, base.inside(body.vertices), body.triangles, body.name) for body in group.bodies]
        return [[base.placed(loop.points) for loop in cut(facets, 0.0, chord_error)] for facets in made]
    cuts = [
        AlongCuts(base, body) if isinstance(surface, Guide) else PlaneCuts(base.inside(body.vertices), body.triangles)
        for body in group.bodies
    ]
    return [[base.placed(PlaneLayer(0.0).wrap(loop).points) for loop in next(one.loops([chord_error]))] for one in cuts]
