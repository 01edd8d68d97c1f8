# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bead classes, and their effect on tool direction and bead ends."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..issues import InputError, Word
from ..parameters.bead_classes import (
    CLASSES,
    CLOSING,
    CONTOUR,
    END,
    FILL,
    FIRST_LAYER,
    START,
    WALL,
    PhaseParameters,
)
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..toolpath import BeadEnds, Toolpath

LEANS = ("lead", "tilt")
_OF_KIND = {"contour": CONTOUR, "connected": CONTOUR, "closing": CLOSING}  # class by filling role


def fill_bead_class(kind: str, layer: int) -> str:
    """Return the class of a bead of a filling; every bead of the lowest layer is `first_layer`."""
    return FIRST_LAYER if layer == 0 else _OF_KIND.get(kind, FILL)


def wall_bead_class(layer: int, closing: bool = False) -> str:
    """Return the class of a single-bead wall or of a curve."""
    if layer == 0:
        return FIRST_LAYER
    return CLOSING if closing else WALL


def leaning(
    build: BuildDirectionParameters, process: ProcessParameters, name: str
) -> BuildDirectionParameters:
    """Return the build direction with the lead and tilt of a class.

    Parameters
    ----------
    build : BuildDirectionParameters
        Build direction of the feature.
    process : ProcessParameters
        Process with the classes.
    name : str
        Name of the class.

    Returns
    -------
    BuildDirectionParameters
        The build direction; unchanged if the class has no lead or tilt.
    """
    lean_values: dict[str, Any] = {
        key: value for key, value in process.of_class(name).own_values().items() if key in LEANS
    }
    return replace(build, **lean_values) if lean_values else build


def refuse_speeds(process: ProcessParameters) -> None:
    """Raise InputError NOT_FOR_FAMILY if classes or places set speeds although a bead model does."""
    speed_keys = ("travel_speed", "start_travel_speed", "end_travel_speed")
    named = [
        f"process.classes.{name}"
        for name in CLASSES
        if any(process.of_class(name).own_values().get(key) for key in speed_keys)
    ]
    named += [
        f"process.{end}" for end in (START, END) if getattr(process, end).travel_speed is not None
    ]
    named += [
        f"settings[{number}].process"
        for number, setting in enumerate(process.settings)
        if setting.travel_speed is not None
    ]
    if named and process.bead_model != "none":
        raise InputError(
            "NOT_FOR_FAMILY",
            f"{named[0]}.travel_speed",
            "the bead model sets the travel speed of every bead; remove the travel speed, or use "
            "bead_model: none",
        )


def set_bead_ends(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with lengths, speeds and ramps of the bead ends.

    Raises InputError PHASE_LENGTH if the ends are longer than a bead, BAD_VALUE for a ramp without a travel speed.
    """
    of_class = {name: _ends(process.for_class(name), name) for name in (*CLASSES, "")}
    if not any(of_class.values()):
        return toolpath
    layers = list(toolpath.layers)
    for number, layer in enumerate(toolpath.layers):
        for bead in layer.beads:
            ends = of_class[bead.role.bead_class]
            if ends is not None and ends.length > bead.length:
                raise InputError(
                    "PHASE_LENGTH",
                    f"process.classes.{bead.role.bead_class}",
                    "start and end take {:.4g} mm{}, but a bead of the class in layer {} is "
                    "{:.4g} mm long; shorten start and end of the class, or avoid such short "
                    "beads",
                    ends.length,
                    Word(" with their ramps" if ends.has_ramps else ""),
                    number,
                    bead.length,
                )
        layers[number] = replace(
            layer,
            beads=tuple(replace(bead, ends=of_class[bead.role.bead_class]) for bead in layer.beads),
        )
    return replace(toolpath, layers=tuple(layers))


def _ends(process: ProcessParameters, name: str) -> BeadEnds | None:
    """Return `Bead.ends` of a class; None if neither end differs from the bead."""
    for end, phase in ((START, process.start), (END, process.end)):
        if phase.ramp > 0.0 and phase.travel_speed is None:
            where = (
                f"process.{end}"
                if getattr(process.of_class(name), f"{end}_ramp") is None
                else (f"process.classes.{name}.{end}")
            )
            raise InputError(
                "BAD_VALUE",
                f"{where}.ramp",
                "a ramp of {:g} mm connects to a travel_speed that is not set; set travel_speed, "
                "or remove the ramp",
                phase.ramp,
            )
    if not process.start.there and not process.end.there:
        return None
    at_start, at_end = (
        phase if phase.there else PhaseParameters() for phase in (process.start, process.end)
    )
    return BeadEnds(
        at_start.length,
        at_start.travel_speed or 0.0,
        at_end.length,
        at_end.travel_speed or 0.0,
        at_start.ramp,
        at_end.ramp,
    )
