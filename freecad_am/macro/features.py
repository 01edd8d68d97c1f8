# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macro functions that make features, one per family."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import Any

from ..core.families.registry import KINDS
from ..core.issues import InputError, Text
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.filled import CladdingParameters, DevelopableParameters, SolidParameters
from ..core.parameters.strategy import CurvesParameters, RevolutionParameters, SurfaceParameters
from ..objects.families.registry import planner_of
from .arguments import (
    checked_document,
    checked_keywords,
    checked_list,
    checked_text,
    make_stage,
    owned,
    with_faces,
)

# ---- The feature class of each family, imported on first use


def proxy_of(kind: str) -> type[Any]:
    """Return the feature class of a family. Raises InputError BAD_VALUE for an unknown kind."""
    if kind not in KINDS:
        raise InputError(
            "BAD_VALUE",
            "kind",
            "{!r} is not a valid choice; choose one of {}",
            kind,
            Text.joined(", ", KINDS),
        )
    module, name = planner_of(KINDS[kind]).proxy
    proxy_class: type[Any] = getattr(importlib.import_module(f"freecad_am.objects.{module}"), name)
    return proxy_class


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
    """Make a feature of revolution from an object with a shape, or from some of its faces.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        The object.
    faces : sequence of str, optional
        Names of the object's faces; empty for the complete object.
    label : str, optional
        Label of the feature.
    axis : tuple, optional
        (object, "Edge1") if the shape has no axis.
    fixtures : sequence of Any, optional
        Solids or meshes that the nozzle must not touch.
    strategy : RevolutionParameters or None, optional
        Complete layer parameters; None for the defaults.
    build_direction : BuildDirectionParameters or None, optional
        Complete build direction parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_feature(doc, doc.Revolve, ["Face1"], layer_height=1.5)
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
    """Make a feature of the given kind.

    Parameters
    ----------
    doc : App.Document
        The document.
    kind : str
        Family kind, such as "solid".
    source : App.DocumentObject
        The object.
    faces : sequence of str, optional
        Names of the object's faces or edges; empty for all.
    label : str, optional
        Label of the feature.
    links : Mapping[str, Any] or None, optional
        Links by property name; links of other families are ignored. `StartEdges` and
        `BaseFaces` may contain names only.
    parameters : sequence of Any, optional
        Parameter dataclasses of the feature's sections.
    values : Mapping[str, Any] or None, optional
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.
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
    """Whether the value is a pair of an object and the names of its faces or edges."""
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
    """Make a wall feature from faces of an object.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        The object.
    faces : sequence of str, optional
        Names of the wall faces.
    substrate : App.DocumentObject, optional
        The solid or closed mesh on which the wall grows.
    label : str, optional
        Label of the feature.
    start_edges : sequence of str, optional
        Names of source edges on which the wall starts.
    fixtures : sequence of Any, optional
        Further solids or meshes that the nozzle must not touch.
    strategy : SurfaceParameters or None, optional
        Complete layer parameters; None for the defaults.
    build_direction : BuildDirectionParameters or None, optional
        Complete build direction parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_surface_feature(doc, doc.Bend, ["Face1"], doc.Pipe, layer_height=1.5)
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
    """Make a feature of solids or closed meshes that grow on cylinders and cones of a hub.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        The solids.
    substrate : App.DocumentObject, optional
        The hub.
    base_faces : sequence of str, optional
        Hub faces on which the solids grow; empty for the faces that the solids touch.
    label : str, optional
        Label of the feature.
    faces : sequence of str, optional
        Faces of the source, if hub and solids are one object.
    further : sequence of Any, optional
        More objects to print.
    fixtures : sequence of Any, optional
        Further solids or meshes that the nozzle must not touch.
    strategy : DevelopableParameters or None, optional
        Complete layer parameters; None for the defaults.
    build_direction : BuildDirectionParameters or None, optional
        Complete build direction parameters; None for the defaults.
    **values : Any
        Individual parameters by key; `base_radius=60, base_height=200` defines the base
        numerically.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_developable_feature(doc, doc.Blades, doc.Spindle, layer_height=2.5)
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
    """Make a feature of solids or closed meshes, sliced into plane layers by default.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        The solids.
    substrate : App.DocumentObject, optional
        The object below the solids, if they do not stand on a platform.
    label : str, optional
        Label of the feature.
    further : sequence of Any, optional
        More objects to print.
    guide : App.DocumentObject or tuple, optional
        Guide curve for layers="along": an object or (object, ["Edge1"]).
    start_faces : sequence of str or tuple, optional
        Faces below the first layer, for layers="geodesic" and "offset": names of the source's
        faces, or (object, ["Face1"]).
    fixtures : sequence of Any, optional
        Further solids or meshes that the nozzle must not touch.
    strategy : SolidParameters or None, optional
        Complete layer parameters; None for the defaults.
    build_direction : BuildDirectionParameters or None, optional
        Complete build direction parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_solid_feature(doc, doc.Bracket, layer_height=2)
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
    """Make a feature of curves to print as beads.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        Edges, a wire, a sketch, or a table of points from `open_part`.
    faces : sequence of str, optional
        Names of faces whose normals give the tool directions, and of the edges to print;
        without edge names, all edges are printed.
    substrate : App.DocumentObject, optional
        The object below the curves.
    label : str, optional
        Label of the feature.
    fixtures : sequence of Any, optional
        Further solids or meshes that the nozzle must not touch.
    strategy : CurvesParameters or None, optional
        Complete layer parameters; None for the defaults.
    build_direction : BuildDirectionParameters or None, optional
        Complete build direction parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_curves_feature(doc, doc.Sketch, repeat=3, layer_height=2)
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
    """Make a cladding feature: cover faces with layers of beads along the face normals.

    Parameters
    ----------
    doc : App.Document
        The document.
    source : App.DocumentObject
        The object.
    faces : sequence of str, optional
        Names of the object's faces; empty for all faces, if the object is not a solid.
    substrate : App.DocumentObject, optional
        Another object that the nozzle must not touch.
    label : str, optional
        Label of the feature.
    fixtures : sequence of Any, optional
        Further solids or meshes that the nozzle must not touch.
    strategy : CladdingParameters or None, optional
        Complete layer parameters; None for the defaults.
    build_direction : BuildDirectionParameters or None, optional
        Complete build direction parameters; None for the defaults.
    **values : Any
        Individual parameters by key.

    Returns
    -------
    App.DocumentObject
        The feature.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.make_cladding_feature(
    ...     doc, doc.Die, ["Face3"], layers=2, layer_height=2, bead_spacing=4
    ... )
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
