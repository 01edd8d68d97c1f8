# SPDX-License-Identifier: LGPL-2.1-or-later
"""Features of the macro interface, one function per family."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.filled import CladdingParameters, DevelopableParameters, SolidParameters
from ..core.parameters.strategy import CurvesParameters, RevolutionParameters, SurfaceParameters
from ..objects.planned.feature_kinds import proxy_of
from .arguments import (
    checked_document,
    checked_keywords,
    checked_list,
    checked_text,
    make_stage,
    owned,
    with_faces,
)


def make_feature(
    doc: Any,
    source: Any,
    faces: Sequence[str] = (),
    label: str = "Feature",
    *,
    axis: Any = None,
    fixtures: Sequence[Any] = (),
    strategy: RevolutionParameters | None = None,
    build_direction: BuildDirectionParameters | None = None,
    **values: Any,
) -> Any:
    """A feature of revolution of an object with a shape, or of some of its faces.

    `am.make_feature(doc, doc.Revolve, ["Face1"], layer_height=1.5)`; axis: (object, "Edge1") where the shape has none.
    fixtures: objects, solids or meshes, that the nozzle must not touch.
    """
    links = {"Axis": axis, "Fixtures": fixtures}
    return make_feature_of(
        doc,
        "revolution",
        source,
        faces,
        label=label,
        links=links,
        parameters=[strategy, build_direction],
        values=values,
    )


def make_feature_of(
    doc: Any,
    kind: str,
    source: Any,
    faces: Sequence[str] = (),
    *,
    label: str = "Feature",
    links: Mapping[str, Any] | None = None,
    parameters: Sequence[Any] = (),
    values: Mapping[str, Any] | None = None,
) -> Any:
    """Make a feature of any family, by its kind.

    links: by property name; the feature uses those of its family. `StartEdges` and `BaseFaces` only
    contain names. parameters: dataclasses of its sections; values: single parameters by key.
    """
    checked_document(doc)
    proxy = proxy_of(checked_text(kind, "kind"))
    keys = {link.name: link.key for link in proxy.links}
    given_links = {"Source": with_faces(source, faces), **checked_keywords(links, "links")}
    family_links = {name: value for name, value in given_links.items() if name in keys}
    for name, owner in (
        ("StartEdges", source),
        ("BaseFaces", given_links.get("Substrate")),
        ("StartFaces", source),
    ):
        if name in family_links and not _is_owned(family_links[name]):
            family_links[name] = owned(owner, family_links[name], keys[name])
    return make_stage(
        doc,
        proxy,
        "Feature",
        label,
        family_links,
        checked_list(parameters, "parameters"),
        checked_keywords(values, "values"),
    )


def _is_owned(names: Any) -> bool:
    """Whether names of faces or edges come with their object."""
    return isinstance(names, tuple) and len(names) == 2 and not isinstance(names[0], str)


def make_surface_feature(
    doc: Any,
    source: Any,
    faces: Sequence[str] = (),
    substrate: Any = None,
    label: str = "Feature",
    *,
    start_edges: Sequence[str] = (),
    fixtures: Sequence[Any] = (),
    strategy: SurfaceParameters | None = None,
    build_direction: BuildDirectionParameters | None = None,
    **values: Any,
) -> Any:
    """A wall, of an object's faces, that grows on a solid or closed mesh, or from edges of its own (start_edges).

    `am.make_surface_feature(doc, doc.Bend, ["Face1"], doc.Pipe, layer_height=1.5)`; fixtures: objects, solids or meshes,
    that the nozzle must not touch either.
    """
    links = {"Substrate": substrate, "Fixtures": fixtures, "StartEdges": start_edges}
    return make_feature_of(
        doc,
        "surface",
        source,
        faces,
        label=label,
        links=links,
        parameters=[strategy, build_direction],
        values=values,
    )


def make_developable_feature(
    doc: Any,
    source: Any,
    substrate: Any = None,
    base_faces: Sequence[str] = (),
    label: str = "Feature",
    *,
    faces: Sequence[str] = (),
    further: Sequence[Any] = (),
    fixtures: Sequence[Any] = (),
    strategy: DevelopableParameters | None = None,
    build_direction: BuildDirectionParameters | None = None,
    **values: Any,
) -> Any:
    """Make a feature of solids, or closed meshes, on cylinders and cones of a hub (substrate).

    The solids grow on the hub's base_faces, by default on the faces that they touch.
    `am.make_developable_feature(doc, doc.Blades, doc.Spindle, layer_height=2.5)`

    faces: of the source itself, if hub and solids are one object. further: more objects to print;
    fixtures: objects, solids or meshes, that the nozzle must not touch either.
    `base_radius=60, base_height=200` gives the base by numbers.
    """
    links = {
        "Substrate": substrate,
        "Further": further,
        "Fixtures": fixtures,
        "BaseFaces": base_faces,
    }
    return make_feature_of(
        doc,
        "developable",
        source,
        faces,
        label=label,
        links=links,
        parameters=[strategy, build_direction],
        values=values,
    )


def make_solid_feature(
    doc: Any,
    source: Any,
    substrate: Any = None,
    label: str = "Feature",
    *,
    further: Sequence[Any] = (),
    guide: Any = None,
    start_faces: Any = (),
    fixtures: Sequence[Any] = (),
    strategy: SolidParameters | None = None,
    build_direction: BuildDirectionParameters | None = None,
    **values: Any,
) -> Any:
    """Make a feature of any solids, or closed meshes, in plane layers.

    `am.make_solid_feature(doc, doc.Bracket, layer_height=2)`

    further: more objects to print; substrate: the object below them, if it is not a platform;
    guide: for layers="along", an object or (object, ["Edge1"]); start_faces: for layers="geodesic"
    and "offset", names of the source's faces, or (object, ["Face1"]), below the first layer;
    fixtures: objects, solids or meshes, that the nozzle must not touch either.
    """
    links = {
        "Substrate": substrate,
        "Further": further,
        "Fixtures": fixtures,
        "Guide": guide if guide is None or isinstance(guide, tuple) else (guide, [""]),
        "StartFaces": start_faces,
    }
    return make_feature_of(
        doc,
        "solid",
        source,
        label=label,
        links=links,
        parameters=[strategy, build_direction],
        values=values,
    )


def make_curves_feature(
    doc: Any,
    source: Any,
    faces: Sequence[str] = (),
    substrate: Any = None,
    label: str = "Feature",
    *,
    fixtures: Sequence[Any] = (),
    strategy: CurvesParameters | None = None,
    build_direction: BuildDirectionParameters | None = None,
    **values: Any,
) -> Any:
    """Make a feature of curves: edges, a wire, a sketch, or a table of points from `open_part`,
    printed as beads.

    `am.make_curves_feature(doc, doc.Sketch, repeat=3, layer_height=2)`; faces: names of faces whose
    normals are the directions, and of the edges to print if not all; substrate: the object below
    the curves.
    """
    return make_feature_of(
        doc,
        "curves",
        source,
        faces,
        label=label,
        parameters=[strategy, build_direction],
        links={"Substrate": substrate, "Fixtures": fixtures},
        values=values,
    )


def make_cladding_feature(
    doc: Any,
    source: Any,
    faces: Sequence[str] = (),
    substrate: Any = None,
    label: str = "Feature",
    *,
    fixtures: Sequence[Any] = (),
    strategy: CladdingParameters | None = None,
    build_direction: BuildDirectionParameters | None = None,
    **values: Any,
) -> Any:
    """Faces of an object, all of one that is not a solid, covered with layers of beads along their normals.

    `am.make_cladding_feature(doc, doc.Die, ["Face3"], layers=2, layer_height=2, bead_spacing=4)`; substrate, fixtures: what
    else the nozzle must not touch.
    """
    return make_feature_of(
        doc,
        "cladding",
        source,
        faces,
        label=label,
        parameters=[strategy, build_direction],
        links={"Substrate": substrate, "Fixtures": fixtures},
        values=values,
    )
