# SPDX-License-Identifier: LGPL-2.1-or-later
"""`layer_height: auto` and `bead_spacing: auto` of a job: what its bead model says of straight beads."""

from __future__ import annotations

from typing import Any

import numpy as np

from freecad_am.core.issues import InputError
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.process.model import bead_table
from freecad_am.core.process.model.wire import model_wire_feed
from freecad_am.sections import quantity

WORD = "auto"
HEIGHT, SPACING = "layer_height", "bead_spacing"


def asked(section: Any) -> bool:
    """Whether a section `strategy` leaves layer height or spacing to the model."""
    return isinstance(section, dict) and WORD in (section.get(HEIGHT), section.get(SPACING))


def resolved(section: dict[str, Any], process: ProcessParameters) -> dict[str, Any]:
    """The section with numbers in place of the words. The layer height is the height of a straight
    bead. The spacing is chosen so that spacing times layer height equals the wire volume per
    millimetre of bead: then the fed wire fills the layer. InputError BAD_VALUE without a bead
    model, or if the spacing would exceed the bead width.
    """
    key = HEIGHT if section.get(HEIGHT) == WORD else SPACING
    model = bead_table.process_model(process)
    if model is None:
        raise InputError(
            "BAD_VALUE",
            f"strategy.{key}",
            "auto needs a bead model, and the job has none; give a length, a process.bead_model "
            "or a process.material with one",
        )
    speed = model.straight_speed(process.bead_width)
    section_with_numbers = dict(section)
    if section_with_numbers.get(HEIGHT) == WORD:
        height = float(model.heights(np.array([speed]), np.array([np.inf]))[0])
        section_with_numbers[HEIGHT] = f"{height!r} mm"
    if section_with_numbers.get(SPACING) == WORD:
        height = quantity.read(
            section_with_numbers.get(HEIGHT, 1.0), f.LENGTH, f"strategy.{HEIGHT}"
        )
        if not height > 0.0:
            raise InputError(
                "BAD_VALUE",
                f"strategy.{HEIGHT}",
                "{:g} mm is out of range; give more than 0 mm",
                height,
            )
        spacing = process.wire.section * model_wire_feed(process, model) / speed / height
        if spacing > process.bead_width:
            raise InputError(
                "BAD_VALUE",
                f"strategy.{SPACING}",
                "layers of {:.4g} mm need beads {:.4g} mm apart to hold the wire fed, but beads "
                "are {:g} mm wide; use higher layers or wider beads",
                height,
                spacing,
                process.bead_width,
            )
        section_with_numbers[SPACING] = f"{spacing!r} mm"
    return section_with_numbers
