# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary feature stage: solids on cylinders and cones of a hub, with layers and infill."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

from ..brep.hub import SHARE, Bodies, bodies_of, seat_of_numbers, seats
from ..core.geometry.developable import Developable
from ..core.geometry.mesh.solid import SolidMesh
from ..core.geometry.obstacles import Body
from ..core.geometry.on_hub import OwnHub, Seat, SolidsOnHub, volume_beyond
from ..core.issues import InputError
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.filled import DevelopableParameters
from ..core.slicing.solids.standing import group_by_base, hub_among
from ..core.strategies import estimated_size
from .results.fingerprints import fingerprint
from .shapes.bodies import FIXTURES, Taken, bodies, fixtures_of, snapshot_of
from .shapes.chosen import FeatureStage, source_of
from .stage_parts import Link, Outcome, Section, Work


class DevelopableFeature(FeatureStage):
    """Result: core.geometry.on_hub.SolidsOnHub, in document coordinates."""

    kind = "feature"
    sections = (
        Section(DevelopableParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link(
            "Source",
            "",
            "The solids or closed meshes to deposit; or a part and the faces of its hub, where both are one "
            "solid.",
            type_name="App::PropertyLinkSub",
        ),
        Link(
            "Further",
            "",
            "Further solids or closed meshes to deposit on the same hub.",
            required=False,
            type_name="App::PropertyLinkList",
        ),
        Link(
            "Substrate",
            "",
            "The hub; not needed if it is one of the solids, or if numbers define the base.",
            required=False,
        ),
        Link(
            "BaseFaces",
            "",
            "The cylinders and cones of the hub to grow on; detected if empty.",
            required=False,
            type_name="App::PropertyLinkSub",
        ),
        FIXTURES,
    )
    figures = (
        ("Bases", "App::PropertyStringList", "The surfaces below the solids."),
        ("Solids", "App::PropertyInteger", "Number of solids."),
    )

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, DevelopableParameters)
        self.parameters(
            obj, BuildDirectionParameters
        )  # report invalid values here, not in the toolpath
        inputs, fixtures = _Given.of(obj), fixtures_of(obj)

        def work() -> Outcome:
            solids = _solids(inputs, strategy)
            large = estimated_size.size_issues(
                estimated_size.solids_size(solids, strategy), strategy
            )
            substrate = () if inputs.substrate is None else (inputs.substrate.body(),)
            solids = dataclasses.replace(
                solids, surroundings=(*substrate, *solids.surroundings, *bodies(fixtures))
            )
            bases = [group.base.name for group in solids.groups]
            count = sum(len(group.bodies) for group in solids.groups)
            return Outcome(solids, (*solids.issues, *large), (("Bases", bases), ("Solids", count)))

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        source, faces = source_of(obj)
        hub = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        if obj.BaseFaces:
            hub += [fingerprint(obj.BaseFaces[0]), " ".join(obj.BaseFaces[1])]
        return [
            fingerprint(source),
            " ".join(faces),
            *(fingerprint(further) for further in obj.Further),
            *hub,
            "|",
            *(fingerprint(fixture) for fixture in obj.Fixtures),
        ]


@dataclasses.dataclass(frozen=True)
class _Given:
    """Inputs of a feature.

    label: feature name in errors. objects: objects to deposit. faces: face names of the first
    object. substrate: the hub. base_faces: owner and names of the hub faces.
    """

    label: str
    objects: tuple[Taken, ...]
    faces: tuple[str, ...]
    substrate: Taken | None
    base_faces: tuple[Taken, tuple[str, ...]] | None

    @classmethod
    def of(cls, obj: Any) -> _Given:
        """Read the inputs of a feature object. Raises InputError NO_INPUT, BAD_FACES, NO_SHAPE."""
        source, faces = source_of(obj)
        base = (snapshot_of(obj.BaseFaces[0]), tuple(obj.BaseFaces[1])) if obj.BaseFaces else None
        return cls(
            obj.Label,
            tuple(snapshot_of(entry) for entry in (source, *obj.Further)),
            faces,
            None if obj.Substrate is None else snapshot_of(obj.Substrate),
            base,
        )


def found_in(
    objects: Sequence[Taken],
    faces: Sequence[str],
    substrate: Taken | None,
    base_faces: tuple[Taken, tuple[str, ...]] | None,
    strategy: DevelopableParameters,
) -> SolidsOnHub:
    """Return the solids and the hub that a feature with these inputs would have.

    Raises the same InputErrors as the feature.
    """
    return _solids(
        _Given(objects[0].label, tuple(objects), tuple(faces), substrate, base_faces), strategy
    )


def _solids(inputs: _Given, strategy: DevelopableParameters) -> SolidsOnHub:
    bodies_of_objects = [_bodies(entry, strategy) for entry in inputs.objects]
    solid = [body for entry in bodies_of_objects for body in entry.bodies]
    issues = tuple(issue for entry in bodies_of_objects for issue in entry.issues)
    bases, hub = _bases(inputs, solid, strategy)
    solids_on_hub = [body for body in solid if body is not hub]
    named = "" if inputs.substrate is None else inputs.substrate.label
    meshes = [
        body
        for entry, object_bodies in zip(inputs.objects, bodies_of_objects, strict=True)
        if entry.shape is None
        for body in object_bodies.bodies
    ]
    solids = group_by_base(
        solids_on_hub,
        bases,
        SHARE * strategy.chord_error,
        inputs.objects[0].label,
        issues,
        named,
        meshes,
    )
    if hub is not None:
        return dataclasses.replace(solids, surroundings=(hub,), own=_separate_hub(solid, hub))
    return (
        dataclasses.replace(solids, own=_hub_of_faces(solids))
        if inputs.faces and inputs.base_faces is None
        else solids
    )


def _separate_hub(solids: Sequence[Body], hub: Body) -> OwnHub:
    """Return the hub if it is one of the solids."""
    volume = [SolidMesh(body.vertices, body.triangles).volume for body in solids]
    hub_volume = next(
        solid_volume for solid_volume, body in zip(volume, solids, strict=True) if body is hub
    )
    return OwnHub(sum(volume), hub_volume, ((hub.name, hub_volume),))


def _hub_of_faces(solids: SolidsOnHub) -> OwnHub:
    """Return the hub if it forms one solid with the bodies on it: all material within its faces."""
    total = within = 0.0
    for group in solids.groups:
        for body in group.bodies:
            volume, surface = SolidMesh(body.vertices, body.triangles).volume, group.base.surface
            total += volume
            if isinstance(surface, Developable):
                within += max(
                    volume
                    - volume_beyond(surface, group.base.inside(body.vertices), body.triangles),
                    0.0,
                )
    return OwnHub(total, within)


def _bases(
    inputs: _Given, solids: Sequence[Body], strategy: DevelopableParameters
) -> tuple[list[Seat], Body | None]:
    """Return the possible bases of the solids, and the hub if the hub is one of the solids."""
    base = strategy.base
    if base.radius != "auto":
        height = math.inf if base.height == "inf" else float(base.height)
        return [seat_of_numbers(float(base.radius), height, *base.axis)], None
    if inputs.base_faces is not None:
        return seats(_named_faces(*inputs.base_faces, f"{inputs.label}.BaseFaces"), True), None
    if inputs.faces:
        return seats(
            _named_faces(inputs.objects[0], inputs.faces, f"{inputs.label}.Source"), True
        ), None
    if inputs.substrate is not None:
        return seats(_faces(inputs.substrate), False), None
    owned = [_faces(entry, solid) for entry in inputs.objects for solid in _parts(entry)]
    if len(solids) < 2 or len(owned) != len(solids):
        raise InputError(
            "NO_HUB",
            inputs.label,
            "the hub, a cylinder or cone below the solids, is unknown; choose the hub as "
            "substrate, choose its faces, or set strategy.base; for a flat base use kind: solid",
        )
    seats_of_solids = [seats(solid_faces, False) for solid_faces in owned]
    hub = hub_among(solids, seats_of_solids, SHARE * strategy.chord_error, inputs.label)
    return seats_of_solids[hub], solids[hub]


def _bodies(source: Taken, strategy: DevelopableParameters) -> Bodies:
    shape_or_body = source.body() if source.shape is None else source.shape
    return bodies_of(shape_or_body, source.label, strategy.chord_error, strategy.mend)


def _parts(source: Taken) -> list[Any]:
    """Return the solids of an object; empty for a mesh."""
    return [] if source.shape is None else list(source.shape.Solids)


def _faces(source: Taken, solid: Any = None) -> list[tuple[str, Any]]:
    """Return all faces with names. Raises InputError NO_BASE for a mesh (no exact faces)."""
    if source.shape is None:
        raise InputError(
            "NO_BASE",
            source.label,
            "a mesh has no cylinders or cones; set strategy.base, or choose a solid part as "
            "substrate",
        )
    shape = source.shape if solid is None else solid
    return [(f"{source.label} Face{number + 1}", face) for number, face in enumerate(shape.Faces)]


def _named_faces(owner: Taken, names: Sequence[str], where: str) -> list[tuple[str, Any]]:
    faces_by_name = {f"Face{number + 1}": entry for number, entry in enumerate(_faces(owner))}
    short = [name.rsplit(".", maxsplit=1)[-1] for name in names if name]
    wrong = [name for name in short if name not in faces_by_name]
    if wrong or not short:
        text = ", ".join(wrong) or owner.label
        raise InputError(
            "BAD_FACES", where, "{} is not a face of {}; choose faces of the hub", text, owner.label
        )
    return [faces_by_name[name] for name in short]
