# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wall feature stage: the wall faces, the substrate below the wall, and the layer parameters."""

from __future__ import annotations

import dataclasses
from typing import Any

from ..brep.shapes.part_depths import face_depths
from ..brep.walls.wall_on import wall_on
from ..core.issues import InputError
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.strategy import FRONTS, SurfaceParameters
from ..core.strategies import estimated_size
from .results.fingerprints import fingerprint
from .shapes.bodies import FIXTURES, bodies, fixtures_of, snapshot_of
from .shapes.chosen import FeatureStage, names_of, source_of
from .stage_parts import Link, Outcome, Section, Work


class SurfaceFeature(FeatureStage):
    """Result: SurfaceWall or PatchWall of core.geometry, in the coordinates of the document."""

    kind = "feature"
    sections = (
        Section(SurfaceParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link("Source", "", "The wall to deposit, or its faces.", type_name="App::PropertyLinkSub"),
        Link(
            "Substrate",
            "",
            "The solid part or closed mesh that the wall grows on; not needed if start edges are "
            "chosen.",
            required=False,
        ),
        Link(
            "StartEdges",
            "",
            "Edges of the wall from which layers start, instead of its intersection with the "
            "substrate.",
            required=False,
            type_name="App::PropertyLinkSub",
        ),
        FIXTURES,
    )
    figures = (
        ("WallFaces", "App::PropertyStringList", "Faces of the wall."),
        (
            "WallKind",
            "App::PropertyString",
            "torus, cone (cylinders too) or table; patches for a wall of any "
            "connected faces; mesh.",
        ),
    )

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, SurfaceParameters)
        self.parameters(
            obj, BuildDirectionParameters
        )  # report invalid values here, not in the toolpath
        source, faces = source_of(obj)
        substrates = () if obj.Substrate is None else (snapshot_of(obj.Substrate),)
        source_body, label, edges, fixtures = (
            snapshot_of(source),
            source.Label,
            _start_edges(obj),
            fixtures_of(obj),
        )
        if obj.Substrate == source and not edges:
            raise InputError(
                "OWN_SUBSTRATE",
                f"{obj.Label}.Substrate",
                "the wall and its substrate are the same object, {}; choose the part below the "
                "wall, or clear the substrate if the wall starts on the platform or from edges",
                label,
            )
        if source_body.shape is None and faces:
            raise InputError(
                "UNKNOWN_FACE", label, "a mesh has no selectable faces; remove the faces"
            )

        def work() -> Outcome:
            ground = bodies(substrates)
            solid, name = None, ""
            for substrate in substrates:
                solid, name = (
                    (ground[0] if substrate.shape is None else substrate.shape),
                    substrate.label,
                )
            shape = (
                source_body.body() if source_body.shape is None else source_body.shape.copy(False)
            )
            wall = wall_on(
                shape,
                faces,
                solid,
                strategy.layer_height,
                label,
                name,
                edges,
                strategy.mend,
                strategy.method == FRONTS,
            )
            large = estimated_size.size_issues(estimated_size.wall_size(wall, strategy), strategy)
            depths = (
                None
                if source_body.shape is None
                else face_depths(
                    source_body.shape, wall.faces, label, ground[0] if ground else None
                )
            )
            wall = dataclasses.replace(
                wall, surroundings=(*ground, *bodies(fixtures)), depths=depths
            )
            figures = (("WallFaces", list(wall.faces)), ("WallKind", wall.kind))
            return Outcome(wall, (*wall.issues, *large), figures)

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        source, faces = source_of(obj)
        substrate = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        fixtures = [fingerprint(fixture) for fixture in obj.Fixtures]
        return [fingerprint(source), *substrate, " ".join((*faces, *_start_edges(obj))), *fixtures]


def _start_edges(obj: Any) -> tuple[str, ...]:
    """Return the names of the start edges.

    Raises InputError BAD_EDGES for edges of another object or for elements other than edges.
    """
    if not obj.StartEdges:
        return ()
    owner, names = obj.StartEdges[0], names_of(obj.StartEdges)
    wrong = [name for name in names if not name.startswith("Edge")]
    if wrong or not names or owner != obj.Source[0]:
        text = ", ".join(wrong) or owner.Label
        raise InputError(
            "BAD_EDGES",
            f"{obj.Label}.StartEdges",
            "{} is not an edge of {}; choose its edges",
            text,
            obj.Source[0].Label,
        )
    return names
