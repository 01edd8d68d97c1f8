# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several features as one toolpath: each planned by its family, then kept clear of what is deposited of the others by then,
which carries it too."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...brep.shapes.overlap import common_volume, volume
from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ...core.kinematics.cell import mounted
from ...core.parameters.cell import CellParameters
from ...core.process.deposit import balance as deposit_balance
from ...core.strategies import sequence, support
from ...core.strategies.families import NONE, family_of
from ...core.toolpath import Toolpath as CoreToolpath
from ..checks.on_its_part import looked_at
from ..shapes.bodies import Taken, bodies, taken
from ..shapes.platforms import platforms
from ..work import progress
from .toolpaths import (
    CHECKED,
    CLEARING,
    STRATEGY,
    Given,
    above_platform,
    bases_of,
    kept_clear,
    layers_of,
    over_edge,
    with_wire,
)

OVERLAP = 0.01  # of the smaller part
MM3 = 1000.0  # in a cm3
TOLERANCE_MM = 1e-9  # mm


@dataclass(frozen=True)
class Member:
    """A feature of a sequence. given: None of it needs the document. on: the substrate's own objects that are parts of other
    features; neighbours: those that are not, where it has both. whole: it is all of its sources, not faces of one."""

    label: str
    given: Given
    sources: tuple[Taken, ...]
    on: tuple[str, ...] = ()
    neighbours: tuple[Taken, ...] = ()
    whole: bool = True

    def around(self) -> tuple[Body, ...]:
        """What stands around it from the beginning: no parts of other features, which are deposited by and by."""
        if not self.on:
            return tuple(self.given.wall.surroundings)
        return (*bodies(self.neighbours), *self.given.wall.surroundings[1:])


def member(feature: Any, given: Given, all_features: Sequence[Any]) -> Member:
    """A feature object as one of several."""
    own = (feature.Source[0], *getattr(feature, "Further", ()))
    others = [
        source
        for one in all_features
        if one is not feature
        for source in (one.Source[0], *getattr(one, "Further", ()))
    ]
    substrate = getattr(feature, "Substrate", None)
    stands_on = [] if substrate is None else _leaves(substrate)
    on = tuple(one.Name for one in stands_on if one in others)
    neighbours = tuple(taken(one) for one in stands_on if one not in others) if on else ()
    whole = not any(feature.Source[1])
    return Member(feature.Label, given, tuple(taken(one) for one in own), on, neighbours, whole)


def _leaves(obj: Any) -> list[Any]:
    """The objects that a compound is made of, or the object itself."""
    links = getattr(obj, "Links", None) if obj.TypeId == "Part::Compound" else None
    return [obj] if links is None else [leaf for one in links for leaf in _leaves(one)]


def planned_in_sequence(
    members: Sequence[Member], order: str, names: Sequence[tuple[str, ...]]
) -> CoreToolpath:
    """One toolpath of several features. order: `sequence` of the job; names: of the objects that each is made of.

    Raises InputError OVERLAP, FLOATS, and those of the families; what is about one feature names it.
    """
    _refuse_overlaps(members, names)
    cell = members[0].given.cell
    made: list[CoreToolpath] = []
    stands = None
    for number, one in enumerate(members):
        given = dataclasses.replace(one.given, stands=stands if cell is not None else None)
        try:
            with progress.one_of(number, len(members), 0.0, STRATEGY):
                layers = with_wire(layers_of(given), given)
        except InputError as error:
            raise InputError(error.code, f"{one.label}: {error.where}", error.message) from None
        made.append(dataclasses.replace(layers, feature_label=one.label))
        if stands is None:
            stands = mounted(cell or CellParameters(), layers.frame, layers.family)
    assert stands is not None
    around = _distinct([body for one in members for body in one.around()])
    toolpath = sequence.joined(made, order, stands[:3, 2], around)
    plates = platforms(cell, toolpath)
    progress.report(STRATEGY, CLEARING)
    for number, one in enumerate(members):
        if one.given.build.clearance != "none":
            with progress.one_of(number, len(members), STRATEGY, CHECKED):
                toolpath = kept_clear(toolpath, one.given, (*around, *plates), number)
    progress.report(CHECKED, "looking for beads over nothing")
    for number, one in enumerate(members):
        toolpath = _judged(toolpath, number, one, plates, stands)
    parts = toolpath.features
    on_parts = [part.on_part for part in parts if part.on_part is not None]
    worst = max(on_parts, key=lambda one: one[1] / one[2], default=None)
    return dataclasses.replace(
        toolpath,
        unsupported=math.fsum(part.unsupported or 0.0 for part in parts),
        on_part=None if worst is None else (sum(one[0] for one in on_parts), *worst[1:]),
    )


def _judged(
    toolpath: CoreToolpath, number: int, one: Member, plates: Sequence[Body], stands: Any
) -> CoreToolpath:
    """The toolpath with what carries a feature of it, whether that lies on its part, and what is left out of it."""
    part, numbers = toolpath.parts[number]
    planes: tuple[Any, ...] = ()
    bases = bases_of(one.given)
    if part.family == "revolution" and (plates or _lowest(toolpath, part)):
        planes = (stands if plates else part.frame,)
    if part.family == "solid" and not _lowest(toolpath, part):
        bases = []
    ground = (*one.given.wall.surroundings, *plates)
    lengths, found = support.of_feature(toolpath, number, planes, ground, bases)
    sequence.refuse_floating(toolpath, number, lengths)
    given = dataclasses.replace(one.given, stands=stands)
    seen = looked_at(part if planes else over_edge(part, given), one.given, one.sources)
    balance = deposit_balance.toolpath_balance(one.given.wall, part, one.given.process.bead_width)
    seen = dataclasses.replace(seen, unsupported=math.fsum(lengths.values()))
    own = (*(above_platform(part, given) if bases else ()), *seen.issues)
    more = (*deposit_balance.issues(balance), *found, *sequence.renumbered(own, numbers))
    return sequence.with_feature(toolpath, number, seen, more)


def _lowest(toolpath: CoreToolpath, part: CoreToolpath) -> bool:
    """Whether nothing of the other features lies lower along the feature's own vertical."""
    up = part.frame[:3, 2]
    low, lowest = (
        min(float((bead.points @ up).min()) for _, _, bead in one) for one in (part, toolpath)
    )
    return low <= lowest + part.layer_height


def _refuse_overlaps(members: Sequence[Member], names: Sequence[tuple[str, ...]]) -> None:
    """InputError OVERLAP for parts that are within one another; what grows on another begins at its surface."""
    for k, one in enumerate(members):
        cut = (
            family_of(one.given.strategy).substrate != NONE
            and family_of(one.given.strategy).kind != "solid"
        )
        for j, other in enumerate(members[:k]):
            if not (one.whole and other.whole) or (cut and set(names[j]) & set(one.on)):
                continue
            pairs = [
                (a.shape, b.shape)
                for a in one.sources
                for b in other.sources
                if a.shape and b.shape
            ]
            shared = sum(common_volume(a, b) for a, b in pairs)
            smaller = min(
                (volume(shape) for pair in pairs for shape in pair if shape.Solids), default=0.0
            )
            if shared > OVERLAP * smaller > 0.0:
                raise InputError(
                    "OVERLAP",
                    one.label,
                    "{:.4g} cm3 of it are within {} and would be deposited twice; cut one from the "
                    "other",
                    shared / MM3,
                    other.label,
                )


def _distinct(all_bodies: Sequence[Body]) -> tuple[Body, ...]:
    """Bodies without those that are there before."""
    kept: list[Body] = []
    for body in all_bodies:
        if not any(
            body.vertices.shape == other.vertices.shape
            and np.abs(body.vertices - other.vertices).max() <= TOLERANCE_MM
            for other in kept
        ):
            kept.append(body)
    return tuple(kept)
