# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves feature stage: edges, wires, sketches or a point file, deposited as beads."""

from __future__ import annotations

from typing import Any

from ..brep.curves import curves_of
from ..core.geometry.curves.bead_curves import Curves
from ..core.issues import InputError, Issue
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.strategy import CurvesParameters
from .checks.deposit import gap_issues
from .results.fingerprints import fingerprint, shape_fingerprint
from .shapes.bodies import FIXTURES, bodies, fixtures_of, global_shape, snapshot_of
from .shapes.chosen import FeatureStage, names_of
from .stage_parts import Link, Outcome, Section, Work
from .table_part import points_of, refuse_gcode_keys


class CurvesFeature(FeatureStage):
    """Result: core.geometry.curves.bead_curves.Curves, in document coordinates."""

    kind = "feature"
    sections = (
        Section(CurvesParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link(
            "Source",
            "",
            "The edges, wire, sketch or table of points to deposit as beads; faces next to edges "
            "set the directions.",
            type_name="App::PropertyLinkSub",
        ),
        Link(
            "Substrate",
            "",
            "Part below the curves; not needed on a platform.",
            required=False,
        ),
        FIXTURES,
    )
    figures = (("Curves", "App::PropertyInteger", "Number of curves."),)

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, CurvesParameters)
        self.parameters(
            obj, BuildDirectionParameters
        )  # report invalid values here, not in the toolpath
        source, names = _source(obj)
        edges = tuple(name for name in names if name.startswith("Edge"))
        faces = tuple(name for name in names if name.startswith("Face"))
        label, table = source.Label, points_of(source)
        shape = None if table is not None else global_shape(source)
        ground = () if obj.Substrate is None else (snapshot_of(obj.Substrate),)
        fixtures = fixtures_of(obj)

        def work() -> Outcome:
            issues: tuple[Issue, ...] = ()
            if table is not None:
                bead_curves, issues = table.read(
                    label, strategy.chord_error, strategy.roles, strategy.rotary
                )
            else:
                refuse_gcode_keys(label, strategy.roles, strategy.rotary)
                bead_curves = tuple(curves_of(shape, edges, faces, strategy.chord_error, label))
            issues = (
                *issues,
                *gap_issues(
                    label,
                    (),
                    [curve.points for curve in bead_curves],
                    ground,
                    strategy.layer_height,
                ),
            )
            curves = Curves(
                label,
                bead_curves,
                bodies((*ground, *fixtures)),
                issues,
                edges=None if shape is None else edges,
            )
            return Outcome(curves, issues, (("Curves", len(bead_curves)),))

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        source, names = _source(obj)
        table = points_of(source)
        ground = [] if obj.Substrate is None else [fingerprint(obj.Substrate)]
        return [
            shape_fingerprint(source) if table is None else table.text,
            " ".join(names),
            *ground,
            "|",
            *(fingerprint(fixture) for fixture in obj.Fixtures),
        ]


def _source(obj: Any) -> tuple[Any, tuple[str, ...]]:
    """Return the Source object and the names of the selected edges and faces.

    Raises InputError NO_INPUT without a source.
    """
    if not obj.Source:
        raise InputError(
            "NO_INPUT",
            obj.Label,
            "Source is missing; choose edges, a wire, a sketch or a table of points",
        )
    return obj.Source[0], names_of(obj.Source)
