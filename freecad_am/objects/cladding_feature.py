# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cladding feature stage: faces covered with layers of beads."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from ..brep.clad_faces import clad_faces
from ..core.geometry.walls.mesh_wall import clad_mesh
from ..core.issues import InputError
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.filled import CladdingParameters
from ..core.strategies import estimated_size
from .checks.deposit import gap_issues
from .results.fingerprints import fingerprint
from .shapes.bodies import FIXTURES, bodies, fixtures_of, snapshot_of
from .shapes.chosen import FeatureStage, source_of
from .stage_parts import Link, Outcome, Section, Work


class CladdingFeature(FeatureStage):
    """Result: core.geometry.walls.clad_faces.CladFaces, in document coordinates."""

    kind = "feature"
    sections = (
        Section(CladdingParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link("Source", "", "The faces to cover.", type_name="App::PropertyLinkSub"),
        Link("Substrate", "", "Another part that the nozzle must clear.", required=False),
        FIXTURES,
    )
    figures = (
        ("CladFaces", "App::PropertyStringList", "Faces that are covered."),
        ("CladArea", "App::PropertyArea", "Area of the faces."),
    )

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, CladdingParameters)
        self.parameters(
            obj, BuildDirectionParameters
        )  # report invalid values here, not in the toolpath
        source, faces = source_of(obj)
        source_body, fixtures = snapshot_of(source), fixtures_of(obj)
        if source_body.shape is None and faces:
            raise InputError(
                "UNKNOWN_FACE", source.Label, "a mesh has no selectable faces; remove the faces"
            )
        ground = () if obj.Substrate is None else (snapshot_of(obj.Substrate),)
        own_body = (
            (source_body,) if source_body.shape is not None and source_body.shape.Solids else ()
        )

        def work() -> Outcome:
            high = (strategy.layers - 1) * strategy.layer_height
            spacing = strategy.bead_spacing
            back = strategy.side == "back"
            if source_body.shape is None:
                body = source_body.body()
                clad = clad_mesh(
                    body.vertices, body.triangles.astype(np.intp), spacing, back, source_body.label
                )
            else:
                clad = clad_faces(
                    source_body.shape.copy(False), faces, spacing, back, high, source_body.label
                )
            large = estimated_size.size_issues(
                estimated_size.cladding_size(clad, strategy), strategy
            )
            feature = dataclasses.replace(
                clad, surroundings=bodies((*own_body, *ground, *fixtures))
            )
            if ground and not own_body:
                corners = source_body.body().vertices
                gap_notes = gap_issues(
                    source_body.label, (), [corners], ground, strategy.layer_height
                )
                feature = dataclasses.replace(feature, issues=(*feature.issues, *gap_notes))
            return Outcome(
                feature,
                (*feature.issues, *large),
                (("CladFaces", list(feature.faces)), ("CladArea", feature.area)),
            )

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        source, faces = source_of(obj)
        ground = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        return [
            fingerprint(source),
            " ".join(faces),
            *ground,
            "|",
            *(fingerprint(fixture) for fixture in obj.Fixtures),
        ]
