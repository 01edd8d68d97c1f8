# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field of equidistant cylinders or cones around a hub: cut, unroll, grow by the margin
(Dai 2020, section 2).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...geometry.developable import Developable
from ...geometry.obstacles import Body
from ...geometry.on_hub import Base, middle_azimuth
from ...geometry.regions.region import Region, regions
from ...geometry.regions.several import grow_regions
from ...geometry.regions.strip import Strip, strips
from ...issues import InputError
from ...parameters.filled import DevelopableParameters
from ...slicing.solids.equidistant import Facets, Loop
from ...slicing.solids.unrolled import count, cut, unroll_layers
from ...types import Array
from ..margins import ARCS, regions_of, within_margin
from ..over_and_under import common_regions
from ..surface import Slice
from .layer import RoundLayer

CUT = 0.25  # share of the chord error, of cuts


def slices(base: Base, body: Body, strategy: DevelopableParameters) -> Iterator[Slice]:
    """The layers of a solid from the hub outwards, at 0, d, 2 d ... mm; those without any region are left out. InputError
    APEX_INSIDE, TOO_FAR_ROUND."""
    assert isinstance(base.surface, Developable)
    azimuth = middle_azimuth(base, body.vertices)
    facets = Facets(base.surface, base.inside(body.vertices), body.triangles, body.name)
    error, height = strategy.chord_error, strategy.layer_height
    below: list[list[Loop]] = []
    ahead: list[list[Loop]] = []
    layers, thick = count(facets, height, strategy.margin, error), strategy.thick
    for number in range(layers):
        while len(ahead) <= thick and number + len(ahead) < layers:
            ahead.append(cut(facets, (number + len(ahead)) * height, CUT * error))
        loops = ahead.pop(0)
        where = f"{body.name} layer {number}"
        surface = base.surface.offset(number * height)
        if sum(loop.turns for loop in loops):
            raise InputError(
                "APEX_INSIDE",
                where,
                "the solid crosses the hub axis beyond its end, at {}, where equidistant "
                "surfaces have an apex or an end; end the solid before the axis",
                base.where(_apex(loops, surface)),
            )
        below.append(loops)
        lots = within_margin(below, height, strategy.margin, facets.offset_loops)
        if any(loop.turns for _, loops in lots for loop in loops):
            buried = () if thick > min(number, layers - 1 - number) else None
            layer = Slice(
                number,
                base,
                RoundLayer(surface),
                _all_round(lots, surface, strategy),
                (),
                azimuth,
                buried,
            )
        else:
            neighbours = [
                facets.offset_loops(loops, -k * height)
                for k, loops in _neighbours(below, ahead, thick)
            ]
            flat = unroll_layers(
                surface, [*(loops for _, loops in lots), *neighbours], azimuth, where
            )
            layer = Slice(
                number,
                base,
                RoundLayer(surface, flat.middle),
                *regions_of(
                    [(distance, borders) for (distance, _), borders in zip(lots, flat.borders)],
                    strategy.margin,
                    error,
                    number,
                ),
                azimuth,
            )
            if thick:
                layer = layer._replace(
                    buried=common_regions(
                        [
                            grow_regions(regions(borders), strategy.margin, ARCS * error)
                            for borders in flat.borders[len(lots) :]
                        ]
                    )
                )
        if layer.regions:
            yield layer._replace(share_before=number / layers)


def _neighbours(
    below: Sequence[list[Loop]], ahead: Sequence[list[Loop]], thick: int
) -> list[tuple[int, list[Loop]]]:
    """Return the `thick` layers under and over the last one below: offset in layers, and loops.

    Loops of missing layers and loops around the hub are left out.
    """
    current = len(below) - 1
    neighbours = []
    for k in (k for step in range(1, thick + 1) for k in (-step, step)):
        layer_loops = (
            below[current + k] if -current <= k < 0 else ahead[k - 1] if 0 < k <= len(ahead) else []
        )
        neighbours.append((k, [loop for loop in layer_loops if not loop.turns]))
    return neighbours


def _apex(loops: Sequence[Loop], surface: Developable) -> Array:
    """About where (3,) the axis ends within loops that go round it."""
    round_it = np.vstack([loop.points for loop in loops if loop.turns])
    return np.array(
        [0.0, 0.0, float(round_it[:, 2].mean()) if surface.is_cylinder else surface.height]
    )


def _all_round(
    lots: Sequence[tuple[float, list[Loop]]], surface: Developable, strategy: DevelopableParameters
) -> tuple[Region | Strip, ...]:
    """Return the strips and regions of a layer that goes all around the hub; above a surface
    that ends below it has no margin.
    """
    margin, loops = next((lot for lot in lots if lot[1]), lots[0])
    bands = strips(
        [(surface.unroll(loop.points), loop.turns) for loop in loops], RoundLayer(surface).period
    )
    return bands if margin == 0.0 else grow_regions(bands, margin, ARCS * strategy.chord_error)
