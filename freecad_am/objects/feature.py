# SPDX-License-Identifier: LGPL-2.1-or-later
"""Revolution feature stage: the wall detected on a shape, and its layer parameters."""

from __future__ import annotations

import dataclasses
from typing import Any

import FreeCAD as App

from ..brep.revolution.wall import find_wall
from ..brep.shapes.part_depths import revolved_depths
from ..core.issues import InputError
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.strategy import RevolutionParameters
from ..core.strategies import estimated_size
from .results.fingerprints import digits, fingerprint, shape_fingerprint
from .shapes.bodies import FIXTURES, bodies, fixtures_of, global_shape
from .shapes.chosen import FeatureStage, names_of, source_of
from .shapes.nested import EDGE
from .shapes.places import global_placement
from .stage_parts import Link, Outcome, Section, Work


class RevolutionFeature(FeatureStage):
    """Result: core.geometry.curves.profile.RevolvedWall, in the coordinates of the document."""

    kind = "feature"
    sections = (
        Section(RevolutionParameters, "strategy", "Layers"),
        Section(BuildDirectionParameters, "build_direction", "Build direction"),
    )
    links = (
        Link(
            "Source",
            "",
            "The shape to deposit, or some of its faces.",
            type_name="App::PropertyLinkSub",
        ),
        Link(
            "Axis",
            "",
            "A straight edge, sketch axis or datum line as the axis of revolution, if the shape "
            "has no axis. A sketch turns about its vertical axis by default.",
            required=False,
            type_name="App::PropertyLinkSub",
        ),
        FIXTURES,
    )
    figures = (
        ("WallFaces", "App::PropertyStringList", "Faces of the wall, from the platform up."),
        ("WallLength", "App::PropertyLength", "Length of the meridian."),
    )

    def prepare(self, obj: Any) -> Work:
        self.linked(obj)
        strategy = self.parameters(obj, RevolutionParameters)
        self.parameters(
            obj, BuildDirectionParameters
        )  # report invalid values here, not in the toolpath
        source, faces = source_of(obj)
        shape, axis, label, fixtures = (
            global_shape(source),
            axis_of(obj),
            source.Label,
            fixtures_of(obj),
        )

        def work() -> Outcome:
            wall = find_wall(shape, faces, strategy.wall, axis, label)
            large = estimated_size.size_issues(
                estimated_size.revolution_size(wall, strategy), strategy
            )
            figures = (("WallFaces", list(wall.faces)), ("WallLength", wall.meridian.length))
            depths = revolved_depths(shape, wall, label)
            completed_wall = dataclasses.replace(wall, surroundings=bodies(fixtures), depths=depths)
            return Outcome(completed_wall, (*wall.issues, *large), figures)

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        source, faces = source_of(obj)
        axis = axis_of(obj)
        return [
            shape_fingerprint(source),
            " ".join(faces),
            "" if axis is None else digits(*axis),
            *(fingerprint(fixture) for fixture in obj.Fixtures),
        ]


_LINES = ("Part::GeomLine", "Part::GeomLineSegment")


def axis_of(obj: Any) -> tuple[Any, Any] | None:
    """Return point and direction of the revolution axis, as vectors in document coordinates.

    Use the feature's Axis, or else the vertical axis of a sketch, as in PartDesign. Return None if
    neither exists.
    """
    link = obj.Axis
    if not link and obj.Source and obj.Source[0].isDerivedFrom("Sketcher::SketchObject"):
        link = (obj.Source[0], ["V_Axis"])
    if not link:
        return None
    target, names = link[0], names_of(link)
    name = names[0] if names else ""
    placement = global_placement(target)
    sketch_axes = {
        "V_Axis": App.Vector(0, 1, 0),
        "H_Axis": App.Vector(1, 0, 0),
        "N_Axis": App.Vector(0, 0, 1),
    }
    if name in sketch_axes:
        return placement.Base, placement.Rotation.multVec(sketch_axes[name])
    edges = _edges_of(target, name)
    if len(edges) == 1 and edges[0].ShapeType == "Edge" and edges[0].Curve.TypeId in _LINES:
        edge = edges[0]
        start, end = edge.valueAt(edge.FirstParameter), edge.valueAt(edge.LastParameter)
        return start, (end - start).normalize()
    if target.TypeId in ("App::Line", "PartDesign::Line"):
        along = App.Vector(1, 0, 0) if target.TypeId == "App::Line" else App.Vector(0, 0, 1)
        return placement.Base, placement.Rotation.multVec(along)
    raise InputError(
        "BAD_AXIS",
        f"{obj.Label}.Axis",
        "{} {} is not a straight line; choose a straight edge or an axis",
        target.Label,
        name,
    )


def _edges_of(target: Any, name: str) -> list[Any]:
    """Return the named edge of an object, or all edges without a name, in document coordinates.

    Empty if the object has no such edge.
    """
    try:
        shape = global_shape(target)
    except InputError as error:
        if error.code != "NO_SHAPE":
            raise
        return []
    return [edge for k, edge in enumerate(shape.Edges, start=1) if name in ("", f"{EDGE}{k}")]
