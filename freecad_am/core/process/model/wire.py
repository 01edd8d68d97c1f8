# SPDX-License-Identifier: LGPL-2.1-or-later
"""The wire against the bead: what it feeds per second is what a bead of the counted section takes at its travel speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...issues import WARNING, Issue, Text
from ...parameters.bead_classes import CLASSES
from ...parameters.process import ProcessParameters
from ...toolpath import Toolpath
from .bead_model import BeadModel
from .wire_taken import by_wire, follows_speed, taken_of

AUTO, CODE = "auto", "FEED_BALANCE"
TOLERANCE = 0.1  # of what beads take; a wire that feeds more or less by no more than this balances


def with_model(process: ProcessParameters, model: BeadModel) -> float:
    """Speed of the wire, mm/s, where a bead model sets the travel speed: as given, else that of the model's own beads."""
    feed = process.wire.feed
    return model.wire_feed if isinstance(feed, str) else feed


def fed(toolpath: Toolpath, process: ProcessParameters, model: BeadModel | None) -> Toolpath:
    """The toolpath with the speed of its wire, and an issue where that does not balance with its beads.

    Balanced is wire section x feed = bead width x layer height x travel speed, or what fills the part: beads that overlap may
    be fed for the room that each has. Beads of a model were measured with their
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
        return _of_classes(_following(replace(toolpath, wire_feed=balanced), process), process)
    made = _following(replace(toolpath, wire_feed=process.wire.feed), process)
    given = process.wire.feed * process.wire.section
    if given == 0.0 or abs(given - taken) <= TOLERANCE * taken or _fills(toolpath, given):
        return _of_classes(made, process)
    return replace(
        made,
        issues=(
            *made.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the wire feeds {:.4g} mm3/s, {:.4g} mm/s of {:g} mm wire, but beads of {:.4g} x {:.4g} mm at "
                    "{:.4g} mm/s take {:.4g} mm3/s; set process.wire.feed to {:.4g} mm/s, or to auto, or make width, layer height "
                    "and travel speed what they are",
                    given,
                    process.wire.feed,
                    process.wire.diameter,
                    width,
                    height,
                    speed,
                    taken,
                    balanced,
                ),
            ),
        ),
    )


def _fills(toolpath: Toolpath, given: float) -> bool:
    """Whether a wire of so many mm3/s feeds as much as the beads of a filled part deposit."""
    if toolpath.volumes is None:
        return False
    part, left, outside = toolpath.volumes
    deposited = part - left + outside
    seconds = sum(
        float((np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum())
        for _, _, bead in toolpath
    )
    return abs(given * seconds - deposited) <= TOLERANCE * deposited


def _following(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """The toolpath with a wire that follows the travel speed, where that is asked for and beads have ramps. Speeds that
    change in one step are no reason: a schedule tells what is fed there."""
    ramped = any(bead.ends[4:] for _, _, bead in toolpath)
    if process.wire.feed_mode != "proportional" or not toolpath.wire_feed or not ramped:
        return toolpath
    share = toolpath.wire_feed / process.travel_speed
    return replace(
        toolpath,
        layers=tuple(
            replace(layer, beads=tuple(replace(bead, wire_share=share) for bead in layer.beads))
            for layer in toolpath.layers
        ),
    )


def _of_classes(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """The toolpath with an issue where classes of beads, or their starts and ends, have travel speeds of their own at which
    the wire does not balance, and no schedule of their own that could feed it otherwise."""
    given = (toolpath.wire_feed or 0.0) * process.wire.section
    if given == 0.0 or not _at_other_speeds(process) or follows_speed(toolpath):
        return toolpath
    off = [
        one
        for one in taken_of(toolpath)
        if by_wire(one, process) and abs(given - one.rate) > TOLERANCE * one.rate
    ]
    if not off:
        return toolpath
    text = ", ".join(f"{one.name} {one.rate:.4g}" for one in off)
    return replace(
        toolpath,
        issues=(
            *toolpath.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the wire feeds {:.4g} mm3/s, but beads of these classes, at their own travel speeds, take {} "
                    "mm3/s: more or less lies there than there is room for; give them a schedule that feeds the wire so, or the "
                    "travel speed of the others",
                    given,
                    text,
                ),
                off[0].layer,
                off[0].bead,
            ),
        ),
    )


def _at_other_speeds(process: ProcessParameters) -> bool:
    """Whether any class or phase has a travel speed of its own."""
    named = [process, *(process.for_class(name) for name in CLASSES)]
    return any(
        one.travel_speed != process.travel_speed or one.start.there or one.end.there
        for one in named
    )
