# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solid feature stage: solids in layers of any kind, with substrate, layers and infill."""

from __future__ import annotations

import dataclasses
from typing import Any

from ..brep.curves import edges_of, triangles_of_faces
from ..brep.hub import bodies_of
from ..core.geometry.obstacles import Body
from ..core.issues import InputError, Issue, Text
from ..core.layers.centre_line import prepare_guided
from ..core.layers.stacking import prepare_stack
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.filled import SolidParameters
from ..core.strategies import estimated_size
from .checks.deposit import gap_issues
from .results.fingerprints import fingerprint, shape_fingerprint
from .shapes.bodies import FIXTURES, bodies, fixtures_of, global_shape, is_mesh, snapshot_of
from .shapes.chosen import FeatureStage, names_of, source_of
from .stage_parts import Link, Outcome, Section, Work


class SolidFeature(FeatureStage):
    """Result: core.geometry.on_hub.SolidsOnHub with a plane base, in document coordinates."""

    kind = "feature"
    sections = (
        Section(SolidParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link(
            "Source",
            "",
            "The solids or closed meshes to deposit.",
            type_name="App::PropertyLinkSub",
        ),
        Link(
            "Further",
            "",
            "Further solids or closed meshes to deposit.",
            required=False,
            type_name="App::PropertyLinkList",
        ),
        Link(
            "Substrate",
            "",
            "Part below the solids; not needed on a platform.",
            required=False,
        ),
        Link(
            "Guide",
            "",
            "Edges, wire or sketch as a guide; layers are normal to it; none: the centre line of "
            "the solid.",
            required=False,
            type_name="App::PropertyLinkSub",
        ),
        Link(
            "StartFaces",
            "",
            "Start faces of geodesic and offset layers; none: the base of the solid.",
            required=False,
            type_name="App::PropertyLinkSub",
        ),
        FIXTURES,
    )
    figures = (
        ("Solids", "App::PropertyInteger", "Number of solids."),
        ("Height", "App::PropertyLength", "Height along the stacking direction."),
    )

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, SolidParameters)
        self.parameters(
            obj, BuildDirectionParameters
        )  # report invalid values here, not in the toolpath
        objects = tuple(snapshot_of(entry) for entry in (source_of(obj)[0], *obj.Further))
        ground = () if obj.Substrate is None else (snapshot_of(obj.Substrate),)
        fixtures, label = fixtures_of(obj), objects[0].label
        guide = _select_elements(
            obj,
            "Guide",
            strategy.follows_guide,
            (
                Text(
                    "layers: {} do not use a guide; use layers: along, or remove the guide",
                    strategy.layers,
                )
            ),
        )
        start = _select_elements(
            obj,
            "StartFaces",
            strategy.has_curved_layers,
            (
                Text(
                    "layers: {} do not use start faces; use layers: geodesic or offset, or "
                    "remove the faces",
                    strategy.layers,
                )
            ),
        )

        def work() -> Outcome:
            solid: list[Body] = []
            issues: tuple[Issue, ...] = ()
            for entry in objects:
                bodies_found = bodies_of(
                    entry.body() if entry.shape is None else entry.shape,
                    entry.label,
                    strategy.chord_error,
                    strategy.mend,
                    True,
                )
                solid += bodies_found.bodies
                issues += bodies_found.issues
            if strategy.follows_guide:
                edges = None if guide is None else edges_of(*guide)
                solids = prepare_guided(solid, edges, strategy, label, issues)
            else:
                solids = prepare_stack(solid, strategy, label, issues)
            if start is not None:
                corners = triangles_of_faces(*start, strategy.chord_error)
                solids = dataclasses.replace(
                    solids,
                    groups=tuple(
                        dataclasses.replace(group, start=corners) for group in solids.groups
                    ),
                )
            large = estimated_size.size_issues(
                estimated_size.solids_size(solids, strategy), strategy
            )
            solids = dataclasses.replace(solids, surroundings=bodies((*ground, *fixtures)))
            base = solids.groups[0].base
            height = max(
                float(base.surface.distance(base.inside(body.vertices)).max()) for body in solid
            )
            gap_notes = gap_issues(label, solid, (), ground, strategy.layer_height)
            solids = dataclasses.replace(solids, issues=(*solids.issues, *gap_notes))
            return Outcome(
                solids, (*solids.issues, *large), (("Solids", len(solid)), ("Height", height))
            )

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        ground = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        guide = (
            [shape_fingerprint(obj.Guide[0]), " ".join(obj.Guide[1])]
            if getattr(obj, "Guide", None)
            else []
        )
        faces = getattr(obj, "StartFaces", None)
        start = [shape_fingerprint(faces[0]), " ".join(faces[1])] if faces else []
        return [
            fingerprint(source_of(obj)[0]),
            *(fingerprint(further) for further in obj.Further),
            "|",
            *ground,
            "|",
            *(fingerprint(fixture) for fixture in obj.Fixtures),
            *guide,
            *start,
        ]


def _select_elements(
    obj: Any, name: str, is_used: bool, refusal: str
) -> tuple[Any, tuple[str, ...], str] | None:
    """Return a linked shape, the names of its faces or edges (empty for all), and its label.

    None if the link is empty. is_used: whether the layer kind uses the link. Raises InputError
    NOT_FOR_FAMILY for an unused link, NO_SHAPE for a mesh.
    """
    if not getattr(obj, name, None):
        return None
    if not is_used:
        raise InputError("NOT_FOR_FAMILY", f"{obj.Label}.{name}", refusal)
    owner = getattr(obj, name)[0]
    if is_mesh(owner):
        raise InputError(
            "NO_SHAPE",
            f"{obj.Label}.{name}",
            "{} is a mesh without edges or faces; choose a shape",
            owner.Label,
        )
    return global_shape(owner), names_of(getattr(obj, name)), owner.Label
