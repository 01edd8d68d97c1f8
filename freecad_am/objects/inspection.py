# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inspection stage: measured points compared with the nominal shape."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Callable
from typing import Any

from ..brep.shapes.tessellate import skin
from ..core.geometry.job_files import digest, is_there
from ..core.inspection import inspect, point_file, table
from ..core.inspection import planned as surfaces
from ..core.inspection.planned import Planned, triangle_surface
from ..core.issues import InputError, Text
from ..core.parameters.inspection import InspectionParameters
from ..core.parameters.process import ProcessParameters
from .current import check_current
from .families.registry import planner_of, stage_family
from .fields.properties import HIDDEN, OUTPUT
from .results.fingerprints import fingerprint
from .shapes.bodies import snapshot_of
from .stage import Stage, checked, stage_of
from .stage_parts import Link, Outcome, Section, Work
from .work import progress

KINDS = ("feature", "toolpath")
FACES_FITTED = 3000  # maximum number of points for a fit to exact faces


class Inspection(Stage):
    """Result: core.inspection.inspect.Inspected, including the points; the file may be deleted."""

    kind = "inspection"
    sections = (Section(InspectionParameters, "inspection", "Inspection"),)
    links = (
        Link(
            "Planned",
            "",
            "The feature, toolpath, or object with a shape or mesh that was measured.",
        ),
    )
    figures = (
        ("Points", "App::PropertyInteger", "Number of points used."),
        ("Mean", "App::PropertyDistance", "Mean deviation; positive is outside."),
        ("Deviation", "App::PropertyDistance", "Standard deviation of the deviations."),
        ("Least", "App::PropertyDistance", "Smallest deviation."),
        ("Most", "App::PropertyDistance", "Largest deviation."),
        ("WithinTolerance", "App::PropertyFloat", "Share of the points within tolerance (%)."),
        (
            "Sphericity",
            "App::PropertyString",
            "Width of the narrowest zone between two spheres that holds all points.",
        ),
        (
            "Circularity",
            "App::PropertyStringList",
            "Width of the narrowest zone between two circles, by height.",
        ),
    )

    def complete(self, obj: Any) -> None:
        if "File" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyString",
                "File",
                "Inputs",
                "The file of measured points or of a scanned mesh.",
            )
        if "FileDigest" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyString",
                "FileDigest",
                "Inputs",
                "Content of the file.",
                HIDDEN | OUTPUT,
            )
        super().complete(obj)

    def prepare(self, obj: Any) -> Work:
        linked = self.linked(obj)
        parameters, path, where = (
            self.parameters(obj, InspectionParameters),
            file_of(obj),
            f"{obj.Label}.File",
        )
        if not path:
            raise InputError(
                "NO_FILE", where, "the file of measured points is missing; choose a file"
            )
        if is_predicted(obj):
            return self._predicted(obj, linked, parameters)
        obj.FileDigest = _digest(path, where)
        planned = _stage_surface(linked["Planned"]) if linked else _shape_surface(obj.Planned)

        def work() -> Outcome:
            progress.report(0.0, "reading the points")
            measured = point_file.read(path, parameters.unit)
            result = inspect.inspect(measured, planned(), parameters, progress.report)
            return Outcome(result, result.issues, _figures(result))

        return work

    def _predicted(
        self, obj: Any, linked: dict[str, Any], parameters: InspectionParameters
    ) -> Work:
        """Return the work that inspects the predicted deposit of a toolpath."""
        from .checks import predicted_shape  # only inspections of a prediction need this import

        toolpath = linked.get("Planned")
        if toolpath is None or toolpath.Proxy.kind != "toolpath":
            raise InputError(
                "NO_INPUT",
                f"{obj.Label}.Planned",
                "only the deposit of a toolpath can be predicted; choose a "
                "toolpath under Planned, or a file of measured points",
            )
        obj.FileDigest = ""
        value, targets, label = (
            toolpath.Proxy.value(toolpath),
            toolpath.Proxy.targets(toolpath),
            toolpath.Label,
        )
        allowance = (
            toolpath.Proxy.parameters(toolpath, ProcessParameters).machining_allowance or 0.0
        )

        def work() -> Outcome:
            result = predicted_shape.inspected(
                value, targets, allowance, parameters.tolerance, label, progress.report
            )
            return Outcome(result, result.issues, _figures(result))

        return work

    def linked(self, obj: Any) -> dict[str, Any]:
        missing = self.missing(obj)
        if missing:
            raise InputError("NO_INPUT", obj.Label, missing)
        stage = stage_of(obj.Planned)
        if stage is None:
            return {}
        kind = stage.kind if stage.kind in KINDS else Text.joined(" or ", KINDS)
        return {"Planned": checked(obj, Link("Planned", kind, self.links[0].help))}

    def _linked_stages(self, obj: Any) -> list[Any]:
        return [] if stage_of(obj.Planned) is None else [obj.Planned]

    def further_inputs(self, obj: Any) -> list[str]:
        if is_predicted(obj):
            return [inspect.PREDICTED]
        path = file_of(obj)
        # a missing file counts as unchanged, because the result stores its points
        digest = _digest(path, f"{obj.Label}.File") if is_there(path) else obj.FileDigest
        shape = [] if stage_of(obj.Planned) is not None else [fingerprint(obj.Planned)]
        return [os.path.basename(path), digest, *shape]


def is_predicted(obj: Any) -> bool:
    """Whether an inspection uses a predicted deposit instead of a file."""
    return bool(obj.File.strip() == inspect.PREDICTED)


def file_of(obj: Any) -> str:
    """Return the path of the measured points; a relative path is relative to the document."""
    path = os.path.expanduser(obj.File.strip())
    folder = os.path.dirname(obj.Document.FileName or "")
    return os.path.join(folder, path) if path and folder else path


def _digest(path: str, where: str) -> str:
    try:
        return digest(path, point_file.MAX_FILE_MB, "BAD_FILE", where)
    except (OSError, ValueError) as error:
        why = (getattr(error, "strerror", None) or str(error)).lower()
        raise InputError(
            "NO_FILE", where, "{} cannot be read ({}); choose the file again", path, why
        ) from None


def _stage_surface(target: Any) -> Callable[[], Planned]:
    value, label = target.Proxy.value(target), target.Label
    own_family = stage_family(target.Proxy)
    if own_family is not None:
        return lambda: planner_of(own_family).planned_surface(value, label)
    feature = getattr(target, "Feature", None)
    family = None if feature is None else stage_family(feature.Proxy)
    if family is not None and family.has_axis:  # bead circles are located along the meridian
        wall = feature.Proxy.value(feature)
        return lambda: dataclasses.replace(surfaces.toolpath_surface(value, label), wall=wall)
    return lambda: surfaces.toolpath_surface(value, label)


def _shape_surface(target: Any) -> Callable[[], Planned]:
    """Return a function that reads the exact faces of a shape or the triangles of a mesh."""
    source = snapshot_of(target)

    def mesh_surface() -> Planned:
        body = source.body()
        return triangle_surface(source.label, body.vertices, body.triangles)

    def shape_surface() -> Planned:
        faces = skin(source.shape.copy(False), source.label)
        return triangle_surface(
            source.label,
            faces.vertices,
            faces.triangles,
            exact=faces.exact,
            chord=faces.deflection,
            max_points=FACES_FITTED,
        )

    return mesh_surface if source.shape is None else shape_surface


def _figures(result: inspect.Inspected) -> tuple[tuple[str, Any], ...]:
    spread = result.spread
    return (
        ("Points", spread.count),
        ("Mean", spread.mean),
        ("Deviation", spread.deviation),
        ("Least", spread.least),
        ("Most", spread.most),
        ("WithinTolerance", 100.0 * spread.within),
        ("Sphericity", "" if result.ball is None else f"{result.ball.zone.zone:.4f} mm"),
        (
            "Circularity",
            [
                Text("{:g} mm: {:.4f} mm", circle.height, circle.zone.zone)
                for circle in result.circles
            ],
        ),
    )


def files_of_figures(obj: Any) -> dict[str, bytes]:
    """Return the files of an inspection: the results as CSV and JSON, and the deviation per point.

    Raises InputError NO_RESULT if the result is missing or out of date.
    """
    if obj.Key:
        check_current(obj)
    result, name = obj.Proxy.value(obj), obj.Label
    figures = "figure,value,unit\n" + "".join(
        f'"{row.name}",{row.value:.6f},{row.unit}\n' for row in table.rows(result)
    )
    files = {
        f"{name}.csv": figures,
        f"{name}-deviations.csv": "".join(table.deviations(result)),
        f"{name}.json": json.dumps(table.as_data(result), indent=1, ensure_ascii=False) + "\n",
    }
    return {
        "".join("_" if sign in "/\\:" else sign for sign in key): text.encode()
        for key, text in files.items()
    }
