# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall on an existing part in a document: the faces to deposit, the part they grow on, and how layers are cut."""

from __future__ import annotations

import dataclasses
from typing import Any

from ..brep.first_layer import find_wall
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.strategy import SurfaceParameters
from .feature import source_of
from .shapes import FIXTURES, body_of, fingerprint, fixtures_of, global_shape, shape_fingerprint
from .stage import Link, Outcome, Section, Stage


class SurfaceFeature(Stage):
    """Result: core.geometry.surface_wall.SurfaceWall, in the coordinates of the document."""

    kind = "feature"
    sections = (
        Section(SurfaceParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link("Source", "", "The wall to deposit, or its faces.", type_name="App::PropertyLinkSub"),
        Link("Substrate", "", "The solid part that the wall grows on."),
        FIXTURES,
    )
    figures = (
        ("WallFaces", "App::PropertyStringList", "Faces of the wall."),
        ("WallKind", "App::PropertyString", "torus, cone (cylinders too), or table."),
    )

    def compute(self, obj: Any) -> Outcome:
        self.linked(obj)
        self.parameters(obj, SurfaceParameters)  # bad ones are told where they stand, not by the toolpath
        self.parameters(obj, BuildDirectionParameters)
        source, faces = source_of(obj)
        substrate = obj.Substrate
        wall = find_wall(global_shape(source), faces, global_shape(substrate), source.Label, substrate.Label)
        wall = dataclasses.replace(wall, surroundings=(body_of(substrate), *fixtures_of(obj)))
        return Outcome(wall, wall.issues, (("WallFaces", list(wall.faces)), ("WallKind", wall.kind)))

    def further_inputs(self, obj: Any) -> list[str]:
        source, faces = source_of(obj)
        shapes = (global_shape(source), global_shape(obj.Substrate))
        fixtures = [fingerprint(fixture) for fixture in obj.Fixtures]
        return [*(shape_fingerprint(shape) for shape in shapes), " ".join(faces), *fixtures]
