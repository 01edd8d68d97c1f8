# SPDX-License-Identifier: LGPL-2.1-or-later
"""Select the field of layers for each group of solids, and the solids that are cut together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple, cast

from ..geometry.curves.guide import Guide
from ..geometry.developable import Developable
from ..geometry.on_hub import Group, SolidsOnHub
from ..parameters.filled import FilledParameters, SolidParameters
from ..slicing.solids.equidistant import Facets, cut
from ..slicing.solids.plane_sections import PlaneCuts
from ..types import Array
from . import curved_field as curved
from . import guide_field as along
from . import plane_field as planes
from . import rotary_field as rotary
from .guide_field import AlongCuts
from .plane_field import PlaneLayer
from .surface import Slice, mark_buried, report_overhangs


class Stack(NamedTuple):
    """Solids that are filled together.

    name: name in messages. layers: the layers of the solids. group: index of the group. solid:
    index within the group.
    """

    name: str
    layers: Iterable[Slice]
    group: int
    solid: int


def stacks(solids: SolidsOnHub, strategy: FilledParameters) -> Iterator[Stack]:
    """Yield the stacks of all solids, group by group.

    On a cylinder or cone each solid is a separate stack. On a plane fused solids form one stack.
    """
    for number, group in enumerate(solids.groups):
        if isinstance(group.base.surface, Developable):
            for solid, body in enumerate(group.bodies):
                yield Stack(body.name, rotary.slices(group.base, body, strategy), number, solid)
        else:  # only solids have other bases
            yield from _stacks_of_group(solids, number, group, cast(SolidParameters, strategy))


def _stacks_of_group(
    solids: SolidsOnHub, number: int, group: Group, strategy: SolidParameters
) -> Iterator[Stack]:
    """Yield the stacks of a group on a plane or along a guide; `number` is the group index."""
    if strategy.has_curved_layers:
        yield Stack(group.bodies[0].name, curved.slices(solids, group, strategy), number, 0)
        return
    for solid, bodies in enumerate(
        [group.bodies] if strategy.fuse == "auto" else [(body,) for body in group.bodies]
    ):
        layers: Iterable[Slice]
        if isinstance(group.base.surface, Guide):
            layers = along.slices(group.base, bodies, strategy)
        else:
            layers = planes.slices(group.base, bodies, strategy)
        name = bodies[0].name if len(bodies) == 1 else f"{len(bodies)} solids"
        yield Stack(
            name, mark_buried(report_overhangs(layers, strategy), strategy.thick), number, solid
        )


def footprints(group: Group, chord_error: float) -> list[list[Array]]:
    """Return the footprint of each solid of a group on its base.

    On planes the solids are cut one chord error above the base.

    Parameters
    ----------
    group : Group
        The group.
    chord_error : float
        Chord error, mm.

    Returns
    -------
    list of list of (k, 3) array
        Closed curves of each solid in part coordinates, mm, without repeated first point.

    Raises
    ------
    InputError
        OPEN_MESH, GUIDE_TIGHT.
    """
    base, surface = group.base, group.base.surface
    if isinstance(surface, Developable):
        all_facets = [
            Facets(surface, base.inside(body.vertices), body.triangles, body.name)
            for body in group.bodies
        ]
        return [
            [base.to_part(loop.points) for loop in cut(facets, 0.0, chord_error)]
            for facets in all_facets
        ]
    footprints_of_bodies = []
    for body in group.bodies:
        if isinstance(surface, Guide):
            cut_body: PlaneCuts = AlongCuts(base, body)
        else:
            cut_body = PlaneCuts(base.inside(body.vertices), body.triangles)
        curves = [PlaneLayer(0.0).wrap(loop).points for loop in next(cut_body.loops([chord_error]))]
        footprints_of_bodies.append([base.to_part(points) for points in curves])
    return footprints_of_bodies
