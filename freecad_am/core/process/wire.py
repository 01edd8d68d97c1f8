# SPDX-License-Identifier: LGPL-2.1-or-later
"""The wire against the bead: what it feeds per second is what a bead of the counted section takes at its travel speed."""

from __future__ import annotations

from dataclasses import replace

from ..issues import WARNING, Issue
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from .bead_model import BeadModel

AUTO = "auto"
TOLERANCE = 0.1  # of what beads take; a wire that feeds more or less by no more than this balances


def with_model(process: ProcessParameters, model: BeadModel) -> float:
    """Speed of the wire, mm/s, where a bead model sets the travel speed: as given, else that of the model's own beads."""
    feed = process.wire.feed
    return model.wire_feed if isinstance(feed, str) else feed


def fed(toolpath: Toolpath, process: ProcessParameters, model: BeadModel | None) -> Toolpath:
    """The toolpath with the speed of its wire, and an issue where that does not balance with its beads.

    Balanced is wire section x feed = bead width x layer height x travel speed. Beads of a model were measured with their
    wire, and are told apart from that by `solids.notes`; a feed of 0 stands for no wire. Where nothing tells the width of
    beads nothing is said.
    """
    if model is not None:
        return replace(toolpath, wire_feed=with_model(process, model))
    if toolpath.bead_width is None:
        return toolpath
    width, height, speed = toolpath.bead_width, toolpath.layer_height, process.travel_speed
    taken = width * height * speed
    balanced = taken / process.wire.section
    if isinstance(process.wire.feed, str):
        return replace(toolpath, wire_feed=balanced)
    made = replace(toolpath, wire_feed=process.wire.feed)
    given = process.wire.feed * process.wire.section
    if given == 0.0 or abs(given - taken) <= TOLERANCE * taken:
        return made
    return replace(made, issues=(*made.issues, Issue(
        WARNING, "FEED_BALANCE", f"the wire feeds {given:.4g} mm3/s, {process.wire.feed:.4g} mm/s of "
        f"{process.wire.diameter:g} mm wire, but beads of {width:.4g} x {height:.4g} mm at {speed:.4g} mm/s take "
        f"{taken:.4g} mm3/s; set process.wire.feed to {balanced:.4g} mm/s, or to auto, or make width, layer "
        "height and travel speed what they are",
    )))
