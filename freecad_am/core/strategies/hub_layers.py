# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of one solid on a hub: cut, laid flat, grown by the margin (Dai 2020, section 2)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.developable import TURN, Array, Developable
from ..geometry.on_hub import Base, middle_azimuth
from ..geometry.region import Region, joined, mended, regions
from ..geometry.strip import Period, Strip, strips
from ..geometry.surroundings import Body
from ..geometry.told import place
from ..issues import InputError, Issue
from ..parameters.strategy import DevelopableParameters
from ..slicing.equidistant import Facets, Loop
from ..slicing.laid_flat import count, cut, moved, opened

CUT, BORDER, ARCS = 0.25, 0.05, 0.2  # shares of the chord error: of cuts, of borders without needless points, of fillings


class Slice(NamedTuple):
    """One layer of one solid: its surface, the azimuth (rad) of x = 0 on the plane, and its regions there."""

    layer: int
    surface: Developable
    middle: float
    regions: tuple[Region | Strip, ...]
    issues: tuple[Issue, ...]


def slices(base: Base, body: Body, strategy: DevelopableParameters) -> Iterator[Slice]:
    """The layers of a solid from the hub outwards, at 0, d, 2 d ... mm; those without any region are left out.

    InputError APEX_INSIDE, TOO_FAR_ROUND.
    """
    facets = Facets(base.surface, base.inside(body.vertices), body.triangles, body.name)
    centre = middle_azimuth(base, body.vertices)
    error, height = strategy.chord_error, strategy.layer_height
    below: list[list[Loop]] = []
    for layer in range(count(facets, height, strategy.margin, error)):
        loops = cut(facets, layer * height, CUT * error)
        where = f"{body.name} layer {layer}"
        surface = base.surface.offset(layer * height)
        _refuse_apex(loops, surface, base, where)
        below.append(loops)
        near = _within_margin(base.surface, below, height, strategy.margin)
        if any(loop.turns for _, some in near for loop in some):
            one = Slice(layer, surface, 0.0, _all_round(near, surface, strategy), ())
        else:
            flat = opened(surface, [loop for _, some in near for loop in some], centre, where)
            one = Slice(layer, surface, flat.middle, *_grown(near, flat.loops, strategy, layer))
        if one.regions:
            yield one


def period(surface: Developable) -> Period:
    """What a turn round the hub is on the plane."""
    if surface.is_cylinder:
        return Period(TURN * surface.radius)
    return Period(surface.flat_turn, surface.slant)


def _refuse_apex(loops: Sequence[Loop], surface: Developable, base: Base, where: str) -> None:
    if sum(loop.turns for loop in loops):
        round_it = np.vstack([loop.points for loop in loops if loop.turns])
        z = float(round_it[:, 2].mean()) if surface.is_cylinder else surface.height
        at = place(base.placed(np.array([[0.0, 0.0, z]]))[0])
        raise InputError(
            "APEX_INSIDE", where, f"the solid reaches over the end of the hub's axis, at {at}, where equidistant surfaces "
            "have an apex or an end; let it end beside the axis",
        )


def _within_margin(
    base: Developable, below: Sequence[list[Loop]], height: float, margin: float
) -> list[tuple[float, list[Loop]]]:
    """Loops of the last layer, and of those below it within the margin moved up to it, with how far each has to grow.

    Growing within a layer covers the margin beside the part; what ends below has the margin above itself.
    """
    last = len(below) - 1
    found = [(margin, below[last])]
    for layer in range(last - 1, -1, -1):
        up = (last - layer) * height
        if up >= margin:
            break
        lifted = [moved(base, loop, up) for loop in below[layer]]
        found.append((math.sqrt(margin * margin - up * up), lifted))
    return found


def _grown(
    near: Sequence[tuple[float, list[Loop]]], flat: Sequence[Array], strategy: DevelopableParameters, layer: int
) -> tuple[tuple[Region, ...], tuple[Issue, ...]]:
    """The regions of a layer, without slits thinner than the chord error, and what was mended."""
    first = 0
    issues: tuple[Issue, ...] = ()
    rings: list[Array] = []
    whole: tuple[Region, ...] = ()
    for margin, loops in near:
        read = mended(flat[first : first + len(loops)])
        first += len(loops)
        issues += read.issues(layer)
        whole = tuple(part for region in read.regions for part in region.grown(margin, ARCS * strategy.chord_error))
        rings += [ring for region in whole for ring in region.rings()]
    if strategy.margin > 0.0:
        whole = regions(rings)
    whole = joined(whole, strategy.chord_error)
    return tuple(region.simple(BORDER * strategy.chord_error) for region in whole), issues


def _all_round(
    near: Sequence[tuple[float, list[Loop]]], surface: Developable, strategy: DevelopableParameters
) -> tuple[Region | Strip, ...]:
    """The strips and regions of a layer that runs all the way round the hub; above what ends below there is no margin."""
    margin, loops = next((entry for entry in near if entry[1]), near[0])
    found = strips([(surface.flat(loop.points), loop.turns) for loop in loops], period(surface))
    if margin == 0.0:
        return found
    return tuple(part for one in found for part in one.grown(margin, ARCS * strategy.chord_error))
