# SPDX-License-Identifier: LGPL-2.1-or-later
"""`process.classes` of a job file, as the text that a process keeps."""

from __future__ import annotations

import dataclasses
from typing import Any

from freecad_am.core.issues import InputError
from freecad_am.core.parameters import bead_classes
from freecad_am.sections import fields, quantity


def as_text(section: dict[str, Any]) -> dict[str, Any]:
    """The section `process` with its classes as their text. InputError naming class and key."""
    classes = section.get("classes")
    if classes in (None, {}) or classes == bead_classes.NONE:
        return {key: value for key, value in section.items() if key != "classes"}
    if not isinstance(classes, dict):
        raise InputError(
            "BAD_VALUE",
            bead_classes.WHERE,
            "{} is not understood; write classes below it such as contour: {{travel_speed: "
            "8 mm/s, schedule: 3}}",
            quantity.shown(classes),
        )
    fields.known_keys(classes, bead_classes.CLASSES, bead_classes.WHERE)
    parameters_by_name = {
        name: fields.build(
            bead_classes.BeadClass,
            _flat({} if class_section is None else class_section, name),
            f"{bead_classes.WHERE}.{name}",
        )
        for name, class_section in classes.items()
    }
    for name, parameters in parameters_by_name.items():
        bead_classes.made(name, parameters.own_values())
    return {**section, "classes": bead_classes.text_of(parameters_by_name)}


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
