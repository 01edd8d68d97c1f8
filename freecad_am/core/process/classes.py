# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which class a bead is of, and what a class changes of the direction of the tool."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..issues import InputError
from ..parameters.bead_classes import CLASSES, CLOSING, CONTOUR, FILL, FIRST_LAYER, WALL
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters

LEANS = ("lead", "tilt")
_OF_KIND = {"contour": CONTOUR, "connected": CONTOUR, "closing": CLOSING}  # of a bead of a filling


def of_filled(kind: str, layer: int) -> str:
    """The class of a bead of a filling, by what it is there and its layer: all of the lowest layer is `first_layer`; of the
    rest contours are of a class, what closes gaps of another, and the rest fills."""
    return FIRST_LAYER if layer == 0 else _OF_KIND.get(kind, FILL)


def of_wall(layer: int, closing: bool = False) -> str:
    """The class of a bead that is all of a wall's thickness, or a curve."""
    return FIRST_LAYER if layer == 0 else CLOSING if closing else WALL


def leaning(build: BuildDirectionParameters, process: ProcessParameters, name: str) -> BuildDirectionParameters:
    """The build direction with the lead and tilt of a class."""
    own: dict[str, Any] = {key: value for key, value in process.of_class(name).told().items() if key in LEANS}
    return replace(build, **own) if own else build


def refuse_speeds(process: ProcessParameters) -> None:
    """InputError NOT_FOR_FAMILY where classes have travel speeds and a bead model sets these."""
    named = [name for name in CLASSES if process.of_class(name).travel_speed is not None]
    if named and process.bead_model != "none":
        raise InputError(
            "NOT_FOR_FAMILY", f"process.classes.{named[0]}.travel_speed", "the bead model sets the travel speed of all "
            "beads; leave it out, or use bead_model: none",
        )
