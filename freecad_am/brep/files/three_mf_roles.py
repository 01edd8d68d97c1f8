# SPDX-License-Identifier: LGPL-2.1-or-later
"""Roles that slicers give to the pieces of a 3MF file: part, negative, modifier, blocker, enforcer, support.

PrusaSlicer and SuperSlicer store them in `Metadata/Slic3r_PE_model.config` by ranges of triangles
of an object; Bambu Studio, OrcaSlicer and programs made from them in
`Metadata/model_settings.config` by components of an object; Cura as metadata of an object in the
model, together with settings that change its shape; Slic3r as `slic3r:volume` elements in the mesh.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import FreeCAD
import numpy as np
import Part

from ...core.geometry.mesh.refine import Edges
from ...core.geometry.mesh.solid import SolidMesh
from ...core.issues import Text
from ...core.types import Array, Index

MAX_TRIANGLES = 2000  # of both cut meshes together; they take about 2 s of CPU time
SEWN = 1e-4  # mm; closer points of a file count as one
EXACT = 1e-6  # of a volume


def difference(
    points: Array, corners: Index, tool_points: Array, tool_corners: Index
) -> tuple[Array, Index] | None:
    """Return points (n, 3) and corners (m, 3) of a closed mesh minus a closed tool.

    There are no triangles if the tool removes the whole mesh. None if the kernel finds a solid
    invalid (it may then return too small an intersection and a matching difference), if its result
    is not closed, or if the volumes of difference and intersection do not add up to the volume of
    the mesh.
    """
    try:
        solid, tool = _solid(points, corners), _solid(tool_points, tool_corners)
        if solid.Volume <= 0.0 or tool.Volume <= 0.0 or not (solid.isValid() and tool.isValid()):
            return None
        remainder, common = solid.cut(tool), solid.common(tool)
        volume = SolidMesh(points, corners).volume
        if abs(remainder.Volume + common.Volume - volume) > EXACT * volume:
            return None
        if remainder.Volume <= EXACT * volume:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.intp)
        if not remainder.isValid():
            return None
        return _triangles(remainder, volume)
    except (RuntimeError, ValueError, Part.OCCError):
        return None


def _solid(points: Array, corners: Index) -> Any:
    shape = Part.Shape()
    facets = [tuple(row) for row in corners.tolist()]
    shape.makeShapeFromMesh(([FreeCAD.Vector(*point) for point in points.tolist()], facets), SEWN)
    return Part.makeSolid(shape)


def _triangles(shape: Any, full_volume: float) -> tuple[Array, Index] | None:
    """Return the triangles of the solids of a shape with flat faces.

    None if the triangles are not closed or enclose another volume.
    """
    points: list[Array] = []
    corners: list[Index] = []
    count = 0
    for solid in shape.Solids:
        vertices, faces = solid.tessellate(1.0)
        vertex_array, face_array = (
            np.array([tuple(v) for v in vertices]),
            np.array(faces, dtype=np.intp),
        )
        if (Edges(face_array).count != 2).any():
            return None
        if abs(SolidMesh(vertex_array, face_array).volume - solid.Volume) > EXACT * full_volume:
            return None
        points.append(vertex_array)
        corners.append(face_array + count)
        count += len(vertex_array)
    return np.vstack(points), np.vstack(corners)


PART = "part"
NEGATIVE = "negative volume"
MODIFIER = "modifier"
BLOCKER = "support blocker"
ENFORCER = "support enforcer"
SUPPORT = "support"
INFILL = "infill mesh"
CUTTING = "cutting mesh"
NAMES = {
    NEGATIVE: Text("negative volume"),
    MODIFIER: Text("modifier"),
    BLOCKER: Text("support blocker"),
    ENFORCER: Text("support enforcer"),
    SUPPORT: Text("support"),
    INFILL: Text("infill mesh"),
    CUTTING: Text("cutting mesh"),
    "other": Text("object of type 'other'"),
    "not printable": Text("not printable"),
}
# by what the files call them, in lower case
ROLES = {
    "modelpart": PART,
    "negativevolume": NEGATIVE,
    "parametermodifier": MODIFIER,
    "supportblocker": BLOCKER,
    "supportenforcer": ENFORCER,
    "normal_part": PART,
    "negative_part": NEGATIVE,
    "modifier_part": MODIFIER,
    "support_blocker": BLOCKER,
    "support_enforcer": ENFORCER,
}
CURA_ROLES = {
    "infill_mesh": INFILL,
    "anti_overhang_mesh": BLOCKER,
    "support_mesh": SUPPORT,
    "cutting_mesh": CUTTING,
}
# settings of Cura by which it deposits another solid than the mesh encloses
CURA_SHAPES = (
    "mold_enabled",
    "conical_overhang_enabled",
    "meshfix_union_all_remove_holes",
)
# settings of Cura by which it deposits the same solid otherwise: offset, as a skin, in one turn, with rough sides
CURA_LAID = (
    "xy_offset",
    "xy_offset_layer_0",
    "hole_xy_offset",
    "magic_mesh_surface_mode",
    "magic_spiralize",
    "magic_fuzzy_skin_enabled",
    "wireframe_enabled",
)
# the same of PrusaSlicer, SuperSlicer, Bambu Studio and OrcaSlicer
SHAPES = ("make_overhang_printable",)
LAID = (
    "xy_size_compensation",
    "xy_inner_size_compensation",
    "hole_size_compensation",
    "xy_hole_compensation",
    "xy_contour_compensation",
    "hole_to_polyhole",
    "spiral_vase",
    "spiral_mode",
    "fuzzy_skin",
)
CURA_PROFILE = re.compile(r"cura/.*\.cfg", re.IGNORECASE)
CURA_VALUES = re.compile(
    rf"^\s*({'|'.join((*CURA_SHAPES, *CURA_LAID))})\s*=[ \t]*(.*?)[ \t]*\r?$", re.MULTILINE
)
PROFILE = re.compile(
    r"metadata/((slic3r(_pe)?|prusaslicer|superslicer)|project_settings)\.config", re.IGNORECASE
)
# `; key = value` of PrusaSlicer, `"key": "value"` of Bambu Studio, where a list has a value for each extruder
PROFILE_VALUES = re.compile(
    rf"""(?:^[\s;]*|")({"|".join((*SHAPES, *LAID))})"?\s*[=:]\s*(?:\[\s*)?"?([^"\]\r\n,]*)""",
    re.MULTILINE,
)
CONFIG = re.compile(r"metadata/(?:\w+_model|model_settings)\.config", re.IGNORECASE)
DRAIN_HOLES = "metadata/slic3r_pe_sla_drain_holes.txt"
TRUE = ("1", "true", "yes")
# values of settings that change nothing
UNUSED = ("", "false", "no", "none", "normal", "nil", "disabled_fuzzy")
END_OF_TRIANGLES = 1 << 62  # of triangles, where a range has no end


def is_config(name: str) -> bool:
    """Whether a file of the zip is a slicer's file of roles; programs derived from PrusaSlicer use
    the ending `_model.config`.
    """
    return CONFIG.fullmatch(name) is not None


def is_used(value: str) -> bool:
    """Whether a slicer setting with this value has an effect."""
    text = value.strip().lower()
    try:
        return float(text) != 0.0
    except ValueError:
        return text not in UNUSED


@dataclass
class Volume:
    """A piece of an object: its triangles from `start` to `end`, or the component or object
    `component`.
    """

    role: str = PART
    name: str = ""
    start: int | None = None
    end: int = END_OF_TRIANGLES
    component: int | None = None


@dataclass
class ConfigReader:
    """Handler of the elements of a slicer's file of roles: the volumes of each object, by its id.

    `unknown` lists role values that are not in ROLES. `settings` lists active settings in SHAPES
    and LAID, by object. `plates` counts the plates with objects.
    """

    volumes: dict[int, list[Volume]] = field(default_factory=dict)
    unknown: list[str] = field(default_factory=list)
    settings: dict[int, dict[str, str]] = field(default_factory=dict)
    plates: int = 0
    _object: int | None = None
    _volume: Volume | None = None
    _plate_is_empty: bool = True

    def start(self, element: str, values: dict[str, str]) -> None:
        """Read the beginning of an element. Raises ValueError for ids and ranges that are not numbers."""
        name = element.rpartition(" ")[2]
        if name == "object" and "id" in values:
            self._object, self._volume = int(values["id"]), None
        elif name in ("volume", "part") and self._object is not None:
            self._volume = self._begin(values)
            self.volumes.setdefault(self._object, []).append(self._volume)
        elif name == "plate":
            self._plate_is_empty = True
        elif name == "model_instance" and self._plate_is_empty:
            self.plates, self._plate_is_empty = self.plates + 1, False
        elif name == "metadata" and self._object is not None:
            key, value = values.get("key", ""), values.get("value", "")
            if key in (*SHAPES, *LAID) and is_used(value):
                self.settings.setdefault(self._object, {})[key] = value
            if self._volume is not None:
                self._metadata(self._volume, key, value)

    def end(self, element: str) -> None:
        """Read the end of an element."""
        name = element.rpartition(" ")[2]
        if name in ("volume", "part"):
            self._volume = None
        elif name == "object":
            self._object = None

    def _begin(self, values: dict[str, str]) -> Volume:
        volume = Volume()
        if "firstid" in values:
            volume.start = int(values["firstid"])
            volume.end = int(values.get("lastid", END_OF_TRIANGLES))
        if "id" in values:
            volume.component = int(values["id"])
        if "subtype" in values:
            volume.role = self._role(values["subtype"])
        return volume

    def _metadata(self, volume: Volume, key: str, value: str) -> None:
        if key == "name":
            volume.name = value
        elif key == "volume_type":
            volume.role = self._role(value)
        elif key == "modifier" and value.lower() in TRUE and volume.role == PART:
            volume.role = (
                MODIFIER  # PrusaSlicer writes both this and the type, older versions only this
            )

    def _role(self, value: str) -> str:
        role = ROLES.get(value.strip().lower())
        if role is None:
            self.unknown.append(value)
        return role or PART
