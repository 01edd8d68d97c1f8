# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schema names and versions of stored result dataclasses, so that classes and modules can move.

If a class is renamed or moved, change its entry here only. If a field is renamed, removed, or added
without a default, raise the version of the entry and add a function to UPGRADES that converts the
fields of the previous version.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

Fields = dict[str, Any]


class Schema(NamedTuple):
    """Location of a stored class in the package, as `module:class`, and version of its fields."""

    location: str
    version: int = 1


SCHEMAS: dict[str, Schema] = {
    "bead": Schema("core.toolpath:Bead", 2),
    "bead_curve": Schema("core.geometry.curves.bead_curves:BeadCurve"),
    "bead_ends": Schema("core.toolpath:BeadEnds"),
    "bead_path": Schema("core.planning.joint_path:BeadPath"),
    "bead_role": Schema("core.toolpath:BeadRole"),
    "bead_scarf": Schema("core.toolpath:Scarf"),
    "cell_obstacle": Schema("core.parameters.cell_records:Obstacle"),
    "cell_parameters": Schema("core.parameters.cell:CellParameters", 3),
    "clad_faces": Schema("core.geometry.walls.patch_wall:CladFaces"),
    "coverage": Schema("core.geometry.section:Coverage"),
    "cone_surface": Schema("core.geometry.walls.surface:Cone"),
    "curves": Schema("core.geometry.curves.bead_curves:Curves"),
    "developable_surface": Schema("core.geometry.developable:Developable"),
    "deviation_map": Schema("core.geometry.toolpath_records:DeviationMap"),
    "deviation_spread": Schema("core.inspection.figures:Spread"),
    "external_mechanism": Schema("core.parameters.cell_records:ExternalMechanism"),
    "first_curve": Schema("core.geometry.walls.patch_wall:FirstCurve"),
    "fitted": Schema("core.geometry.toolpath_records:Fitted"),
    "fitted_ball": Schema("core.inspection.figures:Ball"),
    "fitted_circle": Schema("core.inspection.figures:Circle"),
    "guide": Schema("core.geometry.curves.guide:Guide"),
    "hub_base": Schema("core.geometry.on_hub:Base"),
    "inspection": Schema("core.inspection.inspect:Inspected"),
    "issue": Schema("core.issues:Issue"),
    "joint_path": Schema("core.planning.joint_path:JointPath"),
    "layer": Schema("core.toolpath:Layer"),
    "measured_thickness": Schema("core.inspection.figures:Thickness"),
    "meridian": Schema("core.geometry.curves.profile:Meridian"),
    "mesh": Schema("core.geometry.mesh.triangle_mesh:Mesh"),
    "mesh_wall": Schema("core.geometry.walls.mesh_wall:MeshWall"),
    "motion": Schema("core.motion:Motion"),
    "motion_rules": Schema("core.toolpath:MotionRules"),
    "nozzle_parameters": Schema("core.parameters.cell:NozzleParameters", 2),
    "nozzle_shape": Schema("core.parameters.cell_records:NozzleShape"),
    "obstacle": Schema("core.geometry.obstacles:Body"),
    "own_hub": Schema("core.geometry.on_hub:OwnHub"),
    "part_depths": Schema("core.geometry.walls.part_depths:PartDepths"),
    "part_surface": Schema("core.geometry.walls.part_depths:Surface"),
    "patch_wall": Schema("core.geometry.walls.patch_wall:PatchWall"),
    "placed_surface": Schema("core.geometry.walls.surface_wall:Placed"),
    "plane": Schema("core.geometry.developable:Plane"),
    "planned_path": Schema("objects.joint_path:Planned"),
    "predicted_shape": Schema("core.geometry.toolpath_records:PredictedShape"),
    "program": Schema("objects.program:Written"),
    "revolved_wall": Schema("core.geometry.curves.profile:RevolvedWall"),
    "roundness": Schema("core.inspection.figures:Round"),
    "section": Schema("core.geometry.section:Section"),
    "sequenced_feature": Schema("core.toolpath:SequencedFeature"),
    "solid_group": Schema("core.geometry.on_hub:Group"),
    "solid_mesh": Schema("core.geometry.mesh.solid:SolidMesh"),
    "solids_on_hub": Schema("core.geometry.on_hub:SolidsOnHub"),
    "speed_law": Schema("core.toolpath:SpeedLaw"),
    "surface_patch": Schema("core.geometry.walls.patch:Patch"),
    "surface_wall": Schema("core.geometry.walls.surface_wall:SurfaceWall"),
    "toolpath": Schema("core.toolpath:Toolpath", 2),
    "toolpath_checks": Schema("core.toolpath:Checks"),
    "touched_point": Schema("core.parameters.cell_records:TouchedPoint"),
    "torus_surface": Schema("core.geometry.walls.surface:Torus"),
    "verification": Schema("verify:Verification"),
    "wall_rim": Schema("core.geometry.walls.patch_wall:Rim"),
}

_FIELDS_OF_CHECKS = (
    "unsupported",
    "on_part",
    "volumes",
    "uneven",
    "twice",
    "fitted",
    "predicted",
)


_FIELDS_OF_ROLE = ("kind", "ring", "closing", "returns", "bead_class")
_FIELDS_OF_RULES = ("overlap", "retreat", "max_from_vertical")


def _gather(fields: Fields, names: Sequence[str], schema: str) -> Any:
    """Move fields to a record of version 1 of a schema, and return the record."""
    return record(schema, 1, {name: fields.pop(name) for name in names if name in fields})


def _divide_bead(fields: Fields) -> Fields:
    """Convert the fields of a bead to version 2."""
    fields = dict(fields)
    ends = fields.pop("ends", ())
    if ends:
        fields["ends"] = class_of("bead_ends")(*ends)
    fields["role"] = _gather(fields, _FIELDS_OF_ROLE, "bead_role")
    return fields


def _divide_toolpath(fields: Fields) -> Any:
    """Convert the fields of a toolpath to version 2; without layers, it is a sequence feature."""
    fields = dict(fields)
    label = fields.pop("feature_label", "")
    fields["checks"] = _gather(fields, _FIELDS_OF_CHECKS, "toolpath_checks")
    fields["rules"] = _gather(fields, _FIELDS_OF_RULES, "motion_rules")
    if fields["layers"]:
        return fields
    feature = {"label": label, "values": record("toolpath", 2, fields)}
    return record("sequenced_feature", 1, feature)


# by name and version: function that converts fields to the next version, or to a record
UPGRADES: dict[tuple[str, int], Callable[[Fields], Any]] = {
    ("bead", 1): _divide_bead,
    ("cell_parameters", 1): lambda fields: fields,  # strings, which the class converts to records
    ("cell_parameters", 2): lambda fields: fields,
    ("nozzle_parameters", 1): lambda fields: fields,
    ("toolpath", 1): _divide_toolpath,
}

_PACKAGE = __name__.split(".", maxsplit=1)[0]


@functools.cache
def _names() -> Mapping[str, str]:
    """Return the schema names by class location."""
    return {schema.location: name for name, schema in SCHEMAS.items()}


@functools.cache
def schema_of_class(kind: type[Any]) -> tuple[str, Schema]:
    """Return name and schema of a dataclass. Raises TypeError for a class without a schema."""
    location = f"{kind.__module__.removeprefix(f'{_PACKAGE}.')}:{kind.__qualname__}"
    name = _names().get(location)
    if name is None:
        raise TypeError(f"{kind.__name__} cannot be stored: it has no schema")
    return name, SCHEMAS[name]


@functools.cache
def class_of(name: str) -> type[Any]:
    """Return the class of a schema. Raises ValueError for an unknown name.

    Documents name schemas, not modules, so opening a document cannot load other classes.
    """
    if name not in SCHEMAS:
        raise ValueError(f"{name!r} is not a result that this version knows")
    module, _, qualified = SCHEMAS[name].location.partition(":")
    kind: type[Any] = getattr(importlib.import_module(f"{_PACKAGE}.{module}"), qualified)
    return kind


def record(name: str, version: int, fields: Fields) -> Any:
    """Build the dataclass from stored fields, upgraded to the current version.

    Raises
    ------
    ValueError
        If the name is unknown or the version is later than the current version.
    """
    kind = class_of(name)
    if version > SCHEMAS[name].version:
        raise ValueError(f"{name} has version {version}, which is later than this one")
    for earlier in range(version, SCHEMAS[name].version):
        fields = UPGRADES[name, earlier](fields)
        if not isinstance(fields, dict):
            return fields
    return kind(**fields)
