# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on cylinders and cones in a document: what to deposit, the hub, and how layers are cut and filled."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

from ..brep.hub import SHARE, Bodies, bodies_of, given, seats
from ..core.geometry.on_hub import Seat, SolidsOnHub
from ..core.geometry.surroundings import Body
from ..core.issues import InputError
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.strategy import DevelopableParameters
from ..core.slicing.standing import hub_among, on_hub
from .feature import source_of
from .shapes import FIXTURES, body_of, fingerprint, fixtures_of, global_shape
from .stage import Link, Outcome, Section, Stage


class DevelopableFeature(Stage):
    """Result: core.geometry.on_hub.SolidsOnHub, in the coordinates of the document."""

    kind = "feature"
    sections = (
        Section(DevelopableParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link(
            "Source", "", "The solids or closed meshes to deposit; or a part and the faces of its hub, where both are one "
            "solid.", type_name="App::PropertyLinkSub",
        ),
        Link(
            "Further", "", "Further solids or closed meshes to deposit on the same hub.", required=False,
            type_name="App::PropertyLinkList",
        ),
        Link(
            "Substrate", "", "The hub; none is needed where it is one of the solids, or the base is given by numbers.",
            required=False,
        ),
        Link(
            "BaseFaces", "", "The cylinders and cones of the hub to grow on; found when left out.", required=False,
            type_name="App::PropertyLinkSub",
        ),
        FIXTURES,
    )
    figures = (
        ("Bases", "App::PropertyStringList", "The surfaces that solids stand on."),
        ("Solids", "App::PropertyInteger", "Number of solids."),
    )

    def compute(self, obj: Any) -> Outcome:
        self.linked(obj)
        strategy = self.parameters(obj, DevelopableParameters)
        self.parameters(obj, BuildDirectionParameters)  # bad ones are told where they stand, not by the toolpath
        solids = _solids(obj, strategy)
        substrate = () if obj.Substrate is None else (body_of(obj.Substrate),)
        solids = dataclasses.replace(solids, surroundings=(*substrate, *solids.surroundings, *fixtures_of(obj)))
        bases = [group.base.name for group in solids.groups]
        count = sum(len(group.bodies) for group in solids.groups)
        return Outcome(solids, solids.issues, (("Bases", bases), ("Solids", count)))

    def further_inputs(self, obj: Any) -> list[str]:
        source, faces = source_of(obj)
        hub = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        if obj.BaseFaces:
            hub += [fingerprint(obj.BaseFaces[0]), " ".join(obj.BaseFaces[1])]
        return [
            fingerprint(source), " ".join(faces), *(fingerprint(other) for other in obj.Further), *hub, "|",
            *(fingerprint(fixture) for fixture in obj.Fixtures),
        ]


def _solids(obj: Any, strategy: DevelopableParameters) -> SolidsOnHub:
    source, faces = source_of(obj)
    objects = [source, *obj.Further]
    found = [_bodies(one, strategy.chord_error) for one in objects]
    bodies = [body for one in found for body in one.bodies]
    issues = tuple(issue for one in found for issue in one.issues)
    bases, hub = _bases(obj, faces, objects, bodies, strategy)
    rest = [body for body in bodies if body is not hub]
    solids = on_hub(rest, bases, SHARE * strategy.chord_error, source.Label, issues)
    return solids if hub is None else dataclasses.replace(solids, surroundings=(hub,))


def _bases(
    obj: Any, faces: Sequence[str], objects: Sequence[Any], bodies: Sequence[Body], strategy: DevelopableParameters
) -> tuple[list[Seat], Body | None]:
    """The bases that solids may stand on, and the hub where it is one of the solids."""
    base = strategy.base
    if base.radius != "auto":
        height = math.inf if base.height == "inf" else float(base.height)
        return [given(float(base.radius), height, *base.line())], None
    if obj.BaseFaces:
        return seats(_named_faces(*obj.BaseFaces, f"{obj.Label}.BaseFaces"), True), None
    if faces:
        return seats(_named_faces(objects[0], faces, f"{obj.Label}.Source"), True), None
    if obj.Substrate is not None:
        return seats(_faces(obj.Substrate), False), None
    owned = [_faces(one, solid) for one in objects for solid in _parts(one)]
    if len(bodies) < 2 or len(owned) != len(bodies):
        raise InputError(
            "NO_HUB", obj.Label, "the hub is not known; choose it as substrate, choose faces of it, or give strategy.base"
        )
    own = [seats(some, False) for some in owned]
    hub = hub_among(bodies, own, SHARE * strategy.chord_error, obj.Label)
    return own[hub], bodies[hub]


def _bodies(source: Any, chord_error: float) -> Bodies:
    if getattr(source, "Mesh", None) is not None:
        return bodies_of(body_of(source), source.Label, chord_error)
    return bodies_of(global_shape(source), source.Label, chord_error)


def _parts(source: Any) -> list[Any]:
    """The solids of an object; nothing of a mesh."""
    return [] if getattr(source, "Mesh", None) is not None else list(global_shape(source).Solids)


def _faces(source: Any, solid: Any = None) -> list[tuple[str, Any]]:
    """All faces with names. InputError NO_BASE for a mesh, which has no exact ones."""
    if getattr(source, "Mesh", None) is not None:
        raise InputError(
            "NO_BASE", source.Label, "a mesh has no cylinders and cones; give strategy.base, or a solid part as substrate"
        )
    shape = global_shape(source) if solid is None else solid
    return [(f"{source.Label} Face{number + 1}", face) for number, face in enumerate(shape.Faces)]


def _named_faces(owner: Any, names: Sequence[str], where: str) -> list[tuple[str, Any]]:
    known = {f"Face{number + 1}": entry for number, entry in enumerate(_faces(owner))}
    short = [name.rsplit(".", maxsplit=1)[-1] for name in names if name]
    wrong = [name for name in short if name not in known]
    if wrong or not short:
        told = ", ".join(wrong) or owner.Label
        raise InputError("BAD_FACES", where, f"{told} is no face of {owner.Label}; choose faces of the hub")
    return [known[name] for name in short]
