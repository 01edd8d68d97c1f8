# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of a feature in a job file, as the parameters that they mean."""

from __future__ import annotations

import dataclasses
import os
from typing import Any

from ...core.families.family import NEEDED, NONE, Family
from ...core.families.registry import AUTO, DEFAULT_KIND, KINDS, family_of, find_family
from ...core.geometry.curves.bead_curves import POINT_FILES
from ...core.issues import InputError
from ...core.parameters import bead_classes
from ...core.parameters import field as f
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.records import NONE as NO_RECORDS
from ...core.parameters.strategy import LayerParameters
from ...core.process import wire
from ...sections import fields
from . import material
from .part_source import PartSource, part_of


def with_classes(section: dict[str, Any]) -> dict[str, Any]:
    """The section `process` with its classes as records. Raises InputError naming class and key."""
    classes = section.get("classes")
    if classes in (None, {}, [], NO_RECORDS):
        return {key: value for key, value in section.items() if key != "classes"}
    if not isinstance(classes, dict):
        raise InputError(
            "BAD_VALUE",
            bead_classes.WHERE,
            "{} is not understood; write classes below it such as contour: {{travel_speed: "
            "8 mm/s, schedule: 3}}",
            fields.quote(classes),
        )
    fields.known_keys(classes, bead_classes.CLASSES, bead_classes.WHERE)
    records = [_bead_class(class_section, name) for name, class_section in classes.items()]
    return {**section, "classes": bead_classes.in_order(records)}


def _bead_class(class_section: Any, name: str) -> bead_classes.BeadClass:
    """A class of its section. Raises InputError naming class and key."""
    where = f"{bead_classes.WHERE}.{name}"
    values = fields.mapping(_flat({} if class_section is None else class_section, name), where)
    fields.known_keys(values, bead_classes.SPECS, where)
    return fields.build(bead_classes.BeadClass, {**values, "name": name}, where)


def _flat(class_section: Any, name: str) -> Any:
    """What a class says, with `start: {length: ...}` as start_length and so on."""
    if not isinstance(class_section, dict):
        return class_section
    flat: dict[str, Any] = {}
    for key, value in class_section.items():
        if key in (bead_classes.START, bead_classes.END):
            where = f"{bead_classes.WHERE}.{name}.{key}"
            phase_keys = [field.name for field in dataclasses.fields(bead_classes.PhaseParameters)]
            section = fields.mapping(value, where)
            fields.known_keys(section, phase_keys, where)
            flat |= {f"{key}_{inner}": entry for inner, entry in section.items()}
        else:
            flat[key] = value
    return flat


def kept_clear(family: Family) -> tuple[str, ...]:
    """The keys of `strategy` that are not parameters of the family: its kind, and selections on the
    part.
    """
    return ("kind", *family.selections)


def process_of(section: Any, strategy: LayerParameters | None = None) -> ProcessParameters:
    """The process, completed from its material; for filled solids the job's bead width counts, at
    any value. strategy: None for a program of several features, which may differ, or if not chosen
    yet. InputError, also from its bead table.
    """
    process_section = with_classes(material.filled_in(fields.mapping(section, "process")))
    if strategy is not None and "bead_width" in process_section and family_of(strategy).is_filled:
        process_section = {"fill_width": "bead_width", **process_section}
    process = fields.build(ProcessParameters, process_section, "process")
    if process.bead_model != "none":
        wire.load(process.bead_model)
    return process


def refuse_direction(strategy: Any, build_direction: BuildDirectionParameters) -> None:
    """InputError for a build direction that the family of layers does not know."""
    family = family_of(strategy)
    if build_direction.mode not in family.modes:
        raise InputError(
            "NOT_FOR_FAMILY", "build_direction.mode", family.mode_refusal, build_direction.mode
        )


def substrate_of(section: Any, strategy: Any, source: PartSource) -> PartSource | None:
    """The source of a feature's substrate; None for the platform."""
    family = family_of(strategy)
    if source.start_edges and not family.takes_start_edges:
        raise InputError(
            "NOT_FOR_FAMILY",
            "part.start_edges",
            "only strategy.kind surface starts from edges; remove them",
        )
    table = source.file.lower().endswith(tuple(POINT_FILES))
    if not family.takes_curves and (source.edges or table):
        where, what = ("part.edges", "edges") if source.edges else ("part.file", "tables of points")
        raise InputError(
            "NOT_FOR_FAMILY", where, "only strategy.kind curves deposits {} as beads; use it", what
        )
    if table and (source.edges or source.faces):
        raise InputError(
            "NOT_FOR_FAMILY",
            "part.edges" if source.edges else "part.faces",
            "a table of points has no edges or faces; remove them",
        )
    if source.faces and not family.takes_faces:
        raise InputError(
            "NOT_FOR_FAMILY", "part.faces", "solids are deposited whole; remove the faces"
        )
    if family.substrate == NEEDED:
        if section is None:
            return None
        substrate = part_of(fields.mapping(section, "substrate"), "substrate")
        if substrate.faces:
            raise InputError(
                "NOT_YET",
                "substrate.faces",
                "{!r} is not supported yet; use the whole solid",
                ", ".join(substrate.faces),
            )
        if not source.start_edges and _alike(source, substrate):
            raise InputError(
                "OWN_SUBSTRATE",
                "substrate",
                "the wall and its substrate are the same object, {}; choose the part below the "
                "wall, or remove the substrate if the wall starts on the platform or from "
                "part.start_edges",
                os.path.basename(substrate.file),
            )
        return substrate
    if section is not None and family.substrate == NONE:
        raise InputError(
            "NOT_FOR_FAMILY", "substrate", "parts of revolution do not use a substrate; remove it"
        )
    return None if section is None else part_of(fields.mapping(section, "substrate"), "substrate")


def _alike(source: PartSource, other_source: PartSource) -> bool:
    """Whether two sources are the same, whichever faces are meant."""
    return os.path.realpath(source.file) == os.path.realpath(other_source.file) and (
        (source.object, source.solids, source.settings, source.scale)
        == (other_source.object, other_source.solids, other_source.settings, other_source.scale)
    )


def strategy_of(section: Any) -> LayerParameters:
    """Layers of the kind that a section names."""
    kind = fields.mapping(section, "strategy").get("kind", DEFAULT_KIND)
    family = find_family(kind, section.get("layers"))
    if family is None:
        raise f.unknown_choice("strategy.kind", kind, (*KINDS, AUTO.kind))
    if family.kind != kind:  # the name of its layers, which has said all
        section = {key: value for key, value in section.items() if key != "layers"}
    names = {field.name for field in dataclasses.fields(family.parameters)}
    for name, write in _WRITTEN.items():
        if name in names:
            section = write(section)
    return fields.build(family.parameters, section, "strategy", also=kept_clear(family))


def _roles_as_text(section: dict[str, Any]) -> dict[str, Any]:
    """The section with roles, a list of names, as their text."""
    roles = section.get("roles")
    if not isinstance(roles, list):
        return section
    return {
        **section,
        "roles": ", ".join(fields.text(role, "strategy.roles") for role in roles) or " ",
    }


def _without_auto_base(section: dict[str, Any]) -> dict[str, Any]:
    """Return the section without `base: auto`."""
    return {key: value for key, value in section.items() if (key, value) != ("base", "auto")}


# keys that a job writes in another way than parameters
_WRITTEN = {"base": _without_auto_base, "roles": _roles_as_text}
