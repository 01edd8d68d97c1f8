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
    given = section.get("classes")
    if given in (None, {}) or given == bead_classes.NONE:
        return {key: value for key, value in section.items() if key != "classes"}
    if not isinstance(given, dict):
        raise InputError(
            "BAD_VALUE",
            bead_classes.WHERE,
            "{} is not understood; write classes below it such as contour: {{travel_speed: "
            "8 mm/s, schedule: 3}}",
            quantity.shown(given),
        )
    fields.known_keys(given, bead_classes.CLASSES, bead_classes.WHERE)
    found = {
        name: fields.build(
            bead_classes.BeadClass,
            _flat({} if own is None else own, name),
            f"{bead_classes.WHERE}.{name}",
        )
        for name, own in given.items()
    }
    for name, one in found.items():
        bead_classes.made(name, one.own_values())
    return {**section, "classes": bead_classes.text_of(found)}


def _flat(own: Any, name: str) -> Any:
    """What a class says, with `start: {length: ...}` as start_length and so on."""
    if not isinstance(own, dict):
        return own
    flat: dict[str, Any] = {}
    for key, value in own.items():
        if key in (bead_classes.START, bead_classes.END):
            where = f"{bead_classes.WHERE}.{name}.{key}"
            known = [one.name for one in dataclasses.fields(bead_classes.PhaseParameters)]
            section = fields.mapping(value, where)
            fields.known_keys(section, known, where)
            flat |= {f"{key}_{inner}": entry for inner, entry in section.items()}
        else:
            flat[key] = value
    return flat
