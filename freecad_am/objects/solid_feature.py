# SPDX-License-Identifier: LGPL-2.1-or-later
"""Any solids in a document, deposited in plane layers: what to deposit, what it stands on, how it is cut and filled."""

from __future__ import annotations

import dataclasses
from typing import Any

from ..brep.hub import bodies_of
from ..core.geometry.surroundings import Body
from ..core.issues import Issue
from ..core.layers.stacking import stacked
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.strategy import SolidParameters
from ..core.strategies import size
from .feature import source_of
from .fingerprints import fingerprint
from .shapes import FIXTURES, bodies, fixtures_of, taken
from .stage import Link, Outcome, Section, Stage, Work


class SolidFeature(Stage):
    """Result: core.geometry.on_hub.SolidsOnHub with a plane as its base, in the coordinates of the document."""

    kind = "feature"
    sections = (
        Section(SolidParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link("Source", "", "The solids or closed meshes to deposit.", type_name="App::PropertyLinkSub"),
        Link(
            "Further", "", "Further solids or closed meshes to deposit.", required=False,
            type_name="App::PropertyLinkList",
        ),
        Link("Substrate", "", "The part that they stand on; none is needed on a platform.", required=False),
        FIXTURES,
    )
    figures = (
        ("Solids", "App::PropertyInteger", "Number of solids."),
        ("Height", "App::PropertyLength", "Height along the stacking direction."),
    )

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, SolidParameters)
        self.parameters(obj, BuildDirectionParameters)  # bad ones are told where they stand, not by the toolpath
        objects = tuple(taken(one) for one in (source_of(obj)[0], *obj.Further))
        ground = () if obj.Substrate is None else (taken(obj.Substrate),)
        fixtures, label = fixtures_of(obj), objects[0].label

        def work() -> Outcome:
            solid: list[Body] = []
            issues: tuple[Issue, ...] = ()
            for one in objects:
                found = bodies_of(one.body() if one.shape is None else one.shape, one.label, strategy.chord_error,
                                  strategy.mend, True)
                solid += found.bodies
                issues += found.issues
            solids = stacked(solid, strategy, label, issues)
            large = size.judged(size.of_solids(solids, strategy), strategy)
            solids = dataclasses.replace(solids, surroundings=bodies((*ground, *fixtures)))
            base = solids.groups[0].base
            height = max(float(base.surface.distance(base.inside(body.vertices)).max()) for body in solid)
            return Outcome(solids, (*solids.issues, *large), (("Solids", len(solid)), ("Height", height)))

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        ground = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        return [
            fingerprint(source_of(obj)[0]), *(fingerprint(other) for other in obj.Further), "|", *ground, "|",
            *(fingerprint(fixture) for fixture in obj.Fixtures),
        ]
