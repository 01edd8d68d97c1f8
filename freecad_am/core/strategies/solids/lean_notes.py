# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said about how the torch is turned along beads on a hub: spread at corners, leaning less, fast normals."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...issues import NOTE, WARNING, Issue
from ...parameters.build_direction import BuildDirectionParameters
from ...toolpath import Layer
from .beads import Wrapped
from .course import LEAST_DEPARTURE
from .lean import Turned


def lean_notes(made: Sequence[Wrapped], layers: Sequence[Layer], build: BuildDirectionParameters) -> list[Issue]:
    """At most one issue of a kind, at the bead where it is worst."""
    turned = {id(one.bead): one.turned for one in made if one.turned is not None}
    places = [(bead, i, j) for i, layer in enumerate(layers) for j, bead in enumerate(layer.beads)]
    beads = [(turned[id(bead)], i, j) for bead, i, j in places if id(bead) in turned]
    asked = "" if build.max_turn == "auto" else f" ({math.degrees(build.turn()):.3g} deg/mm)"
    limit = f"build_direction.max_turn{asked}"
    return _spread(beads, limit) + _less(beads, limit) + _normals(beads, limit)


def _spread(beads: Sequence[tuple[Turned, int, int]], limit: str) -> list[Issue]:
    some = [entry for entry in beads if entry[0].departure > LEAST_DEPARTURE]
    if not some:
        return []
    worst, layer, bead = max(some, key=lambda entry: entry[0].departure)
    length = sum(entry[0].length for entry in some)
    return [Issue(
        NOTE, "TURN_LIMITED", f"on {len(some)} of {len(beads)} beads, {length:.4g} mm in all, the torch begins to turn "
        f"ahead of corners, by up to {math.degrees(worst.departure):.3g} deg from what is asked, to turn no faster than "
        f"{limit}", layer, bead,
    )]


def _less(beads: Sequence[tuple[Turned, int, int]], limit: str) -> list[Issue]:
    some = [entry for entry in beads if entry[0].asked > 0.0 and entry[0].share < 1.0]
    if not some:
        return []
    worst, layer, bead = min(some, key=lambda entry: entry[0].share)
    layers = sorted({entry[1] for entry in some})
    where = f"layer {layers[0]}" if len(layers) == 1 else f"{len(layers)} layers from {layers[0]} to {layers[-1]}"
    return [Issue(
        WARNING, "LEAN_REDUCED", f"on {len(some)} of {len(beads)} beads in {where} bends follow one another too closely to "
        f"turn the torch round them at {limit}: it leans by {math.degrees(worst.share * worst.asked):.3g} to "
        f"{math.degrees(max(entry[0].share * entry[0].asked for entry in some)):.3g} deg there instead of "
        f"{math.degrees(worst.asked):.3g} deg; lean less, or allow a faster turn", layer, bead,
    )]


def _normals(beads: Sequence[tuple[Turned, int, int]], limit: str) -> list[Issue]:
    some = [entry for entry in beads if entry[0].normals > 0.0]
    if not some:
        return []
    worst, layer, bead = max(some, key=lambda entry: entry[0].normals)
    return [Issue(
        WARNING, "TURN_OF_NORMALS", f"on {len(some)} of {len(beads)} beads the hub's normals alone turn by up to "
        f"{math.degrees(worst.normals):.3g} deg/mm, faster than {limit}; the torch follows them all the same", layer, bead,
    )]
