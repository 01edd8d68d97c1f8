# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sources of the shapes of a job: files, selections in files, and scans of the substrate."""

from __future__ import annotations

import dataclasses
import os
import re
from dataclasses import dataclass, replace
from typing import Any

from ...core.families.registry import family_of
from ...core.geometry.job_files import is_there
from ...core.geometry.mesh.file_unit import MESHES, refuse_scale
from ...core.issues import InputError, Text
from ...core.parameters import field as f
from ...core.parameters.filled import PLANES
from ...core.parameters.inspection import AUTO, BEST, NONE, UNITS, InspectionParameters
from ...core.parameters.scan import PREFIX, ScanParameters
from ...objects.fields import quantities
from ...sections import fields

_EDGE = re.compile(r"Edge[1-9]\d*", re.ASCII)
_FACE = re.compile(r"Face[1-9]\d*", re.ASCII)
_SOLID = re.compile(r"Solid[1-9]\d*", re.ASCII)


@dataclass(frozen=True)
class PartSource:
    """The source of a shape.

    `settings` are (object, property, text) to set in an FCStd part before use. scale: mm of one
    unit of a mesh file that does not state its unit. solids: selected solids of the shape, empty
    for all. edges: selected edges of a guide, empty for all.
    """

    file: str
    object: str | None = None
    faces: tuple[str, ...] = ()
    settings: tuple[tuple[str, str, str], ...] = ()
    start_edges: tuple[str, ...] = ()
    scale: float = 1.0
    solids: tuple[str, ...] = ()
    edges: tuple[str, ...] = ()


def fixtures_of(section: Any) -> tuple[PartSource, ...]:
    """Convert the section `fixtures` to sources. Raises InputError naming key and remedy."""
    entries = [] if section is None else section
    if not isinstance(entries, list):
        raise InputError(
            "BAD_VALUE", "fixtures", "fixtures must be a list; write fixtures: [{file: clamp.step}]"
        )
    fixtures = []
    for number, entry in enumerate(entries):
        key = f"fixtures[{number}]"
        fixture = part_of(fields.mapping(entry, key), key)
        if fixture.faces:
            raise InputError(
                "BAD_VALUE", f"{key}.faces", "a fixture is used whole; remove its faces"
            )
        fixtures.append(fixture)
    return tuple(fixtures)


def part_of(section: dict[str, Any], key: str = "part") -> PartSource:
    """Convert a section such as `part`, whose file has an absolute name, to a source.

    Raises InputError naming key and remedy.
    """
    further = ("start_edges", "edges") if key == "part" else ()
    fields.known_keys(section, ("file", "object", "solids", "faces", "set", "scale", *further), key)
    if "file" not in section:
        raise InputError(
            "NO_PART", f"{key}.file", "the file is missing; write {}: {{file: shape.step}}", key
        )
    file = fields.text(section["file"], f"{key}.file")
    is_document = file.lower().endswith(".fcstd")
    for entry in ("object", "set"):
        if section.get(entry) is not None and not is_document:
            message = Text(
                "only FCStd files contain objects, and {} is not an FCStd file; remove the key",
                os.path.basename(file),
            )
            raise InputError("BAD_VALUE", f"{key}.{entry}", message)
    if not is_there(file):
        raise InputError(
            "NO_FILE",
            f"{key}.file",
            "file {} does not exist; check the path, which is relative to the file that names it",
            file,
        )
    name, solids = section.get("object"), _names(section.get("solids"), f"{key}.solids", _SOLID)
    if solids and (section.get("faces") or section.get("start_edges")):
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "`faces` and `edges` refer to the whole file; remove `solids`, or remove `faces` and "
            "`edges`",
        )
    if solids and file.lower().endswith(MESHES):
        message = Text("{} is a mesh without solids; remove `solids`", os.path.basename(file))
        raise InputError("BAD_VALUE", f"{key}.solids", message)
    return PartSource(
        file=file,
        object=None if name is None else fields.text(name, f"{key}.object"),
        faces=_names(section.get("faces"), f"{key}.faces", _FACE),
        settings=tuple(_settings(section.get("set") or {}, key)),
        start_edges=_names(section.get("start_edges"), f"{key}.start_edges", _EDGE),
        scale=_scale(section.get("scale"), file, f"{key}.scale"),
        solids=solids,
        edges=_names(section.get("edges"), f"{key}.edges", _EDGE),
    )


def guide_of(value: Any, part_section: dict[str, Any]) -> PartSource | None:
    """Return the source of the guide of a strategy, None for auto.

    File and object default to those of the section `part_section`. Raises InputError naming key and
    remedy.
    """
    key = "strategy.guide"
    if value is None or value == "auto":
        return None
    if not isinstance(value, dict):
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not a guide; write {{edges: [Edge1]}}, {{object: Spine}}, {{file: spine.step}}, or "
            "auto",
            quantities.quote(value),
        )
    fields.known_keys(value, ("file", "object", "edges", "set"), key)
    guide_section = {name: value[name] for name in ("file", "object", "set") if name in value}
    if "file" not in guide_section:
        guide_section = {
            **{
                name: part_section[name]
                for name in ("file", "object", "set")
                if name in part_section
            },
            **guide_section,
        }
    return replace(
        part_of(guide_section, key), edges=_names(value.get("edges"), f"{key}.edges", _EDGE)
    )


def faces_of(value: Any, key: str) -> tuple[str, ...]:
    """Return the names of faces. Raises InputError BAD_VALUE."""
    return _names(value, key, _FACE)


def _scale(value: Any, file: str, key: str) -> float:
    """Return the length of one unit of a file, mm."""
    if value is None:
        return 1.0
    scale = quantities.read(value, f.LENGTH, key)
    refuse_scale(scale, file, key)
    return scale


def _names(value: Any, key: str, pattern: re.Pattern[str]) -> tuple[str, ...]:
    """Return the names of faces, edges or solids."""
    names = [value] if isinstance(value, str) else value or []
    if not isinstance(names, list) or not all(
        isinstance(name, str) and pattern.fullmatch(name) for name in names
    ):
        kind = pattern.pattern.partition("[")[0]
        raise InputError(
            "BAD_VALUE",
            key,
            "{} names no {}s; write [{}1, {}2]",
            quantities.quote(value),
            kind.lower(),
            kind,
            kind,
        )
    return tuple(names)


def _settings(section: Any, key_of_part: str) -> list[tuple[str, str, str]]:
    settings = []
    for name, properties in fields.mapping(section, f"{key_of_part}.set").items():
        for key, value in fields.mapping(properties, f"{key_of_part}.set.{name}").items():
            if isinstance(value, (dict, list)) or value is None:
                raise InputError(
                    "BAD_VALUE", f"{key_of_part}.set.{name}.{key}", "give one value such as 45 mm"
                )
            settings.append(
                (name, key, quantities.quote(value) if isinstance(value, bool) else str(value))
            )
    return settings


# ---- The scan of a substrate that a job names, and how layers are fitted to it

FIT_CHOICES = (AUTO, BEST, NONE)
SOURCE_KEYS = ("scan", "scan_unit", "scan_fit", "scan_pairs")
KEYS = (*SOURCE_KEYS, *(entry.name for entry in dataclasses.fields(ScanParameters)))


@dataclass(frozen=True)
class ScanSource:
    """The source of a scan of the substrate.

    file: file of the points. unit, fit, pairs: as in an inspection; fit auto takes the points as
    measured if they match the substrate.
    """

    file: str
    unit: str
    fit: str
    pairs: str
    parameters: ScanParameters


def split(section: Any) -> tuple[Any, dict[str, Any]]:
    """Split the section of a substrate into the keys without its scan, and the keys of the scan."""
    if not isinstance(section, dict):
        return section, {}
    return (
        {key: value for key, value in section.items() if key not in KEYS},
        {key: value for key, value in section.items() if key in KEYS and value is not None},
    )


def scan_of(scan_keys: dict[str, Any], strategy: Any) -> ScanSource | None:
    """Convert the scan keys of a substrate to a source, None without a scan.

    Raises InputError naming the key.
    """
    if not scan_keys:
        return None
    if "scan" not in scan_keys:
        key = next(iter(scan_keys))
        raise InputError(
            "BAD_VALUE",
            f"{PREFIX}.{key}",
            "the scan is missing; give its file as {}.scan, or remove the section",
            PREFIX,
        )
    file = fields.text(scan_keys["scan"], f"{PREFIX}.scan")
    if not is_there(file):
        raise InputError(
            "NO_FILE",
            f"{PREFIX}.scan",
            "file {} does not exist; check the path, which is relative to the file that names it",
            file,
        )
    for key, choices in (("scan_unit", (AUTO, *UNITS)), ("scan_fit", FIT_CHOICES)):
        if scan_keys.get(key, AUTO) not in choices:
            raise f.unknown_choice(f"{PREFIX}.{key}", scan_keys[key], choices)
    parameters = fields.build(
        ScanParameters,
        {key: value for key, value in scan_keys.items() if key not in SOURCE_KEYS},
        PREFIX,
    )
    fit, pairs = scan_keys.get("scan_fit", AUTO), str(scan_keys.get("scan_pairs", ""))
    try:
        InspectionParameters(pairs=pairs)
    except InputError as error:
        raise InputError(error.code, f"{PREFIX}.scan_pairs", error.message) from None
    if parameters.after_layer is not None and fit not in (AUTO, NONE):
        raise InputError(
            "BAD_VALUE",
            f"{PREFIX}.scan_fit",
            "{}: only a scan in part coordinates shows how far the part has grown; use none",
            fit,
        )
    family, layers = family_of(strategy), getattr(strategy, "layers", PLANES)
    if not family.fits_scans(layers):
        raise InputError(
            "NOT_YET",
            f"{PREFIX}.scan",
            "{} cannot be fitted to a scan yet, only solids in planar layers and walls on a "
            "substrate; remove the scan",
            family.describe_layers(layers),
        )
    return ScanSource(file, scan_keys.get("scan_unit", AUTO), fit, pairs, parameters)
