# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field of equidistant cylinders or cones about a hub: a solid cut, laid flat, grown by the margin (Dai 2020, section
2)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...geometry.developable import Developable
from ...geometry.formatting import place
from ...geometry.obstacles import Body
from ...geometry.on_hub import Base, middle_azimuth
from ...geometry.regions.region import Region, regions
from ...geometry.regions.strip import Strip, strips
from ...issues import InputError
from ...parameters.filled import DevelopableParameters
from ...slicing.solids.equidistant import Facets, Loop
from ...slicing.solids.unrolled import count, cut, moved, opened
from ..curved.covered import under_and_over
from ..margins import ARCS, grown, within_margin
from ..surface import Slice
from .layer import RoundLayer

CUT = 0.25  # share of the chord error, of cuts


def slices(base: Base, surface: Developable, body: Body, strategy: DevelopableParameters) -> Iterator[Slice]:
    """The layers of a solid from the hub outwards, at 0, d, 2 d ... mm; those without any region are left out.

    InputError APEX_INSIDE, TOO_FAR_ROUND.
    """
    facets = Facets(surface, base.inside(body.vertices), body.triangles, body.name)
    centre = middle_azimuth(base, body.vertices)
    error, height = strategy.chord_error, strategy.layer_height
    below: list[list[Loop]] = []
    ahead: list[list[Loop]] = []
    layers, thick = count(facets, height, strategy.margin, error), strategy.thick
    for layer in range(layers):
        while len(ahead) <= thick and layer + len(ahead) < layers:
            ahead.append(cut(facets, (layer + len(ahead)) * height, CUT * error))
        loops = ahead.pop(0)
        where = f"{body.name} layer {layer}"
        at = surface.offset(layer * height)
        _refuse_apex(loops, at, base, where)
        below.append(loops)
        near = within_margin(below, height, strategy.margin, lambda some, up: [moved(surface, loop, up) for loop in some])
        if any(loop.turns for _, some in near for loop in some):
            covered = () if thick > min(layer, layers - 1 - layer) else None
            one = Slice(layer, RoundLayer(at), _all_round(near, at, strategy), (), covered)
        else:
            adjacent = _adjacent(surface, below, ahead, height, thick)
            flat = opened(at, [loop for _, some in [*near, *adjacent] for loop in some], centre, where)
            loops_flat = iter(flat.loops)
            lots = [(distance, [next(loops_flat) for _ in some]) for distance, some in near]
            one = Slice(layer, RoundLayer(at, flat.middle), *grown(lots, strategy.margin, error, layer))
            if thick:
                there = [regions([next(loops_flat) for _ in some]) for _, some in adjacent]
                one = one._replace(covered=under_and_over([
                    [part for one in found for part in one.grown(strategy.margin, ARCS * error)] for found in there
                ]))
        if one.regions:
            yield one


def _adjacent(
    surface: Developable, below: Sequence[list[Loop]], ahead: Sequence[list[Loop]], height: float, thick: int
) -> list[tuple[int, list[Loop]]]:
    """The loops of so many layers under and over the last one below, moved to it, each lot with its number from there: none
    of those that are not there, or that go round the hub."""
    here = len(below) - 1
    found = []
    for k in (k for step in range(1, thick + 1) for k in (-step, step)):
        there = below[here + k] if -here <= k < 0 else ahead[k - 1] if 0 < k <= len(ahead) else []
        found.append((k, [moved(surface, loop, -k * height) for loop in there if not loop.turns]))
    return found


def _refuse_apex(loops: Sequence[Loop], surface: Developable, base: Base, where: str) -> None:
    if sum(loop.turns for loop in loops):
        round_it = np.vstack([loop.points for loop in loops if loop.turns])
        z = float(round_it[:, 2].mean()) if surface.is_cylinder else surface.height
        at = place(base.placed(np.array([[0.0, 0.0, z]]))[0])
        raise InputError(
            "APEX_INSIDE", where, "the solid reaches over the end of the hub's axis, at {}, where equidistant surfaces have "
            "an apex or an end; let it end beside the axis", at,
        )


def _all_round(
    near: Sequence[tuple[float, list[Loop]]], surface: Developable, strategy: DevelopableParameters
) -> tuple[Region | Strip, ...]:
    """The strips and regions of a layer that runs all the way round the hub; above what ends below there is no margin."""
    margin, loops = next((entry for entry in near if entry[1]), near[0])
    found = strips([(surface.flat(loop.points), loop.turns) for loop in loops], RoundLayer(surface).period)
    if margin == 0.0:
        return found
    return tuple(part for one in found for part in one.grown(margin, ARCS * strategy.chord_error))
