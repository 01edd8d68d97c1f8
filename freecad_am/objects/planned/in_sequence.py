# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan several features as one toolpath.

Each feature is planned by its family. The earlier deposit of other features is then an obstacle
for the nozzle and also supports the feature.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...brep.shapes.chosen import common_volume, volume
from ...core.families.registry import family_of
from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ...core.kinematics.cell import mounted
from ...core.parameters.cell import CellParameters
from ...core.process.deposit import balance as deposit_balance
from ...core.strategies import sequence, support
from ...core.toolpath import Toolpath as CoreToolpath
from ..checks.deposit import check_on_part
from ..families.given import Given
from ..families.planner import CHECKED, CLEARING, STRATEGY
from ..shapes.bodies import Taken, bodies, snapshot_of
from ..shapes.cell_obstacles import platforms
from ..work import progress
from .toolpaths import (
    above_platform,
    add_wire_speed,
    bases_of,
    kept_clear,
    layers_of,
    measure_infill,
    over_edge,
)

OVERLAP = 0.01  # maximum overlap of two parts, fraction of the smaller part
MM3 = 1000.0  # mm3 per cm3
TOLERANCE_MM = 1e-9  # mm


@dataclass(frozen=True)
class Member:
    """A feature of a sequence.

    inputs: planning inputs, independent of the document. on: substrate objects that are parts of
    other features. neighbours: other substrate objects, if the substrate has both kinds.
    is_complete: whether the feature deposits whole sources, not only faces.
    """

    label: str
    inputs: Given
    sources: tuple[Taken, ...]
    on: tuple[str, ...] = ()
    neighbours: tuple[Taken, ...] = ()
    is_complete: bool = True

    def surroundings(self) -> tuple[Body, ...]:
        """Return the bodies around the feature, without parts of other features."""
        if not self.on:
            return tuple(self.inputs.wall.surroundings)
        return (*bodies(self.neighbours), *self.inputs.wall.surroundings[1:])


def member(feature: Any, inputs: Given, all_features: Sequence[Any]) -> Member:
    """Return a feature object as a member of a sequence."""
    own_sources = (feature.Source[0], *getattr(feature, "Further", ()))
    other_sources = [
        source
        for other_feature in all_features
        if other_feature is not feature
        for source in (other_feature.Source[0], *getattr(other_feature, "Further", ()))
    ]
    substrate = getattr(feature, "Substrate", None)
    stands_on = [] if substrate is None else _leaves(substrate)
    on = tuple(other_feature.Name for other_feature in stands_on if other_feature in other_sources)
    neighbours = (
        tuple(
            snapshot_of(other_feature)
            for other_feature in stands_on
            if other_feature not in other_sources
        )
        if on
        else ()
    )
    is_complete = not any(feature.Source[1])
    return Member(
        feature.Label,
        inputs,
        tuple(snapshot_of(other_feature) for other_feature in own_sources),
        on,
        neighbours,
        is_complete,
    )


def _leaves(obj: Any) -> list[Any]:
    """Return the objects in a compound, or the object itself."""
    links = getattr(obj, "Links", None) if obj.TypeId == "Part::Compound" else None
    return [obj] if links is None else [leaf for child in links for leaf in _leaves(child)]


def planned_in_sequence(
    members: Sequence[Member], order: str, names: Sequence[tuple[str, ...]]
) -> CoreToolpath:
    """Plan one toolpath for several features.

    order: `sequence` of the job. names: names of the source objects of each feature. Raises
    InputError OVERLAP, FLOATS, and the errors of the families. An error on one feature names the
    feature.
    """
    _refuse_overlaps(members, names)
    cell = members[0].inputs.cell
    planned_parts: list[CoreToolpath] = []
    stands = None
    for number, entry in enumerate(members):
        inputs = dataclasses.replace(entry.inputs, stands=stands if cell is not None else None)
        try:
            with progress.one_of(number, len(members), 0.0, STRATEGY):
                layers = measure_infill(add_wire_speed(layers_of(inputs), inputs), inputs)
        except InputError as error:
            raise InputError(error.code, f"{entry.label}: {error.where}", error.message) from None
        planned_parts.append(layers)
        if stands is None:
            stands = mounted(cell or CellParameters(), layers.frame, layers.family)
    assert stands is not None
    around = _distinct([body for entry in members for body in entry.surroundings()])
    labels = [entry.label for entry in members]
    toolpath = sequence.join_toolpaths(planned_parts, labels, order, stands[:3, 2], around)
    plates = platforms(cell, toolpath)
    progress.report(STRATEGY, CLEARING)
    for number, entry in enumerate(members):
        if entry.inputs.build.clearance != "none":
            with progress.one_of(number, len(members), STRATEGY, CHECKED):
                toolpath = kept_clear(toolpath, entry.inputs, (*around, *plates), number)
    progress.report(CHECKED, "looking for unsupported beads")
    for number, entry in enumerate(members):
        toolpath = _judge_feature(toolpath, number, entry, plates, stands)
    feature_parts = [feature.values for feature in toolpath.features]
    on_parts = [
        feature_part.checks.on_part
        for feature_part in feature_parts
        if feature_part.checks.on_part is not None
    ]
    worst = max(on_parts, key=lambda entry: entry[1] / entry[2], default=None)
    return toolpath.add_checks(
        unsupported=math.fsum(
            feature_part.checks.unsupported or 0.0 for feature_part in feature_parts
        ),
        on_part=None if worst is None else (sum(entry[0] for entry in on_parts), *worst[1:]),
    )


def _judge_feature(
    toolpath: CoreToolpath, number: int, entry: Member, plates: Sequence[Body], stands: Any
) -> CoreToolpath:
    """Check support, distance from the part and omissions of one feature of a toolpath."""
    feature_part, numbers = toolpath.parts[number]
    planes: tuple[Any, ...] = ()
    bases = bases_of(entry.inputs)
    if feature_part.traits.has_axis and (plates or _lowest(toolpath, feature_part)):
        planes = (stands if plates else feature_part.frame,)
    if feature_part.traits.stacks_layers and not _lowest(toolpath, feature_part):
        bases = []
    ground = (*entry.inputs.wall.surroundings, *plates)
    lengths, support_issues = support.feature_support(toolpath, number, planes, ground, bases)
    sequence.refuse_floating(toolpath, number, lengths)
    inputs = dataclasses.replace(entry.inputs, stands=stands)
    checked = check_on_part(
        feature_part if planes else over_edge(feature_part, inputs), entry.inputs, entry.sources
    )
    balance = deposit_balance.toolpath_balance(
        entry.inputs.wall, feature_part, entry.inputs.process.bead_width
    )
    checked = checked.add_checks(unsupported=math.fsum(lengths.values()))
    feature_issues = (*(above_platform(feature_part, inputs) if bases else ()), *checked.issues)
    further_issues = (
        *deposit_balance.issues(balance),
        *support_issues,
        *sequence.renumbered(feature_issues, numbers),
    )
    return sequence.update_feature(toolpath, number, checked, further_issues)


def _lowest(toolpath: CoreToolpath, feature_part: CoreToolpath) -> bool:
    """Whether no other feature reaches lower along the feature's vertical."""
    up = feature_part.frame[:3, 2]
    low, lowest = (
        min(float((bead.points @ up).min()) for _, _, bead in candidate)
        for candidate in (feature_part, toolpath)
    )
    return low <= lowest + feature_part.layer_height


def _refuse_overlaps(members: Sequence[Member], names: Sequence[tuple[str, ...]]) -> None:
    """Raise InputError OVERLAP if parts overlap, except a part that may cut into its substrate."""
    for k, entry in enumerate(members):
        cut = family_of(entry.inputs.strategy).cuts_into_substrate
        for j, other_entry in enumerate(members[:k]):
            if not (entry.is_complete and other_entry.is_complete) or (
                cut and set(names[j]) & set(entry.on)
            ):
                continue
            pairs = [
                (a.shape, b.shape)
                for a in entry.sources
                for b in other_entry.sources
                if a.shape and b.shape
            ]
            shared = sum(common_volume(a, b) for a, b in pairs)
            smaller = min(
                (volume(shape) for pair in pairs for shape in pair if shape.Solids), default=0.0
            )
            if shared > OVERLAP * smaller > 0.0:
                raise InputError(
                    "OVERLAP",
                    entry.label,
                    "{:.4g} cm3 overlap {} and would be deposited twice; cut one solid from the "
                    "other",
                    shared / MM3,
                    other_entry.label,
                )


def _distinct(all_bodies: Sequence[Body]) -> tuple[Body, ...]:
    """Return the bodies without duplicates."""
    distinct: list[Body] = []
    for body in all_bodies:
        if not any(
            body.vertices.shape == known_body.vertices.shape
            and np.abs(body.vertices - known_body.vertices).max() <= TOLERANCE_MM
            for known_body in distinct
        ):
            distinct.append(body)
    return tuple(distinct)
