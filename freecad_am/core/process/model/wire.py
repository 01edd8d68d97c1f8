# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wire feed against bead: the wire fed per second equals the counted section of a bead at its travel speed."""

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
TOLERANCE = 0.1  # of the rate that beads take; a wire within this balances


def model_wire_feed(process: ProcessParameters, model: BeadModel) -> float:
    """Speed of the wire, mm/s, if a bead model sets the travel speed: as given, else the model's nominal feed."""
    feed = process.wire.feed
    return model.wire_feed if isinstance(feed, str) else feed


def set_wire_feed(
    toolpath: Toolpath, process: ProcessParameters, model: BeadModel | None
) -> Toolpath:
    """The toolpath with the speed of its wire, and an issue if the wire does not balance with the beads.

    Balanced is wire section x feed = bead width x layer height x travel speed, or the volume of a filled part: overlapping beads
    may be fed for the room that each has. Beads of a model were measured with their wire; `solids.notes` reports their balance. A
    feed of 0 means no wire. Without a known bead width there is no issue.
    """
    if model is not None:
        return replace(toolpath, wire_feed=model_wire_feed(process, model))
    if toolpath.bead_width is None:
        return toolpath
    width, height, speed = toolpath.bead_width, toolpath.layer_height, process.travel_speed
    bead_rate = width * height * speed
    balanced = bead_rate / process.wire.section
    if isinstance(process.wire.feed, str):
        return _check_classes(_following(replace(toolpath, wire_feed=balanced), process), process)
    fed_path = _following(replace(toolpath, wire_feed=process.wire.feed), process)
    wire_rate = process.wire.feed * process.wire.section
    if (
        wire_rate == 0.0
        or abs(wire_rate - bead_rate) <= TOLERANCE * bead_rate
        or _fills(toolpath, wire_rate)
    ):
        return _check_classes(fed_path, process)
    return replace(
        fed_path,
        issues=(
            *fed_path.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the wire feeds {:.4g} mm3/s, {:.4g} mm/s of {:g} mm wire, but beads of "
                    "{:.4g} x {:.4g} mm at {:.4g} mm/s need {:.4g} mm3/s; set process.wire.feed "
                    "to {:.4g} mm/s or to auto, or correct width, layer height and travel speed",
                    wire_rate,
                    process.wire.feed,
                    process.wire.diameter,
                    width,
                    height,
                    speed,
                    bead_rate,
                    balanced,
                ),
            ),
        ),
    )


def _fills(toolpath: Toolpath, wire_rate: float) -> bool:
    """Whether a wire rate, mm3/s, feeds as much as the beads of a filled part deposit."""
    if toolpath.volumes is None:
        return False
    part_volume, left_out, outside = toolpath.volumes
    deposited = part_volume - left_out + outside
    seconds = sum(
        float((np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum())
        for _, _, bead in toolpath
    )
    return abs(wire_rate * seconds - deposited) <= TOLERANCE * deposited


def _following(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """The toolpath with a wire that follows the travel speed, if the process asks for it and beads have ramps. For stepped speeds
    a schedule gives the feed.
    """
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


def _check_classes(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """The toolpath with an issue if bead classes, starts or ends have travel speeds at which the wire does not balance, and no
    schedule of their own that could feed it otherwise.
    """
    wire_rate = (toolpath.wire_feed or 0.0) * process.wire.section
    if wire_rate == 0.0 or not _at_other_speeds(process) or follows_speed(toolpath):
        return toolpath
    off = [
        taken
        for taken in taken_of(toolpath)
        if by_wire(taken, process) and abs(wire_rate - taken.rate) > TOLERANCE * taken.rate
    ]
    if not off:
        return toolpath
    text = ", ".join(f"{taken.name} {taken.rate:.4g}" for taken in off)
    return replace(
        toolpath,
        issues=(
            *toolpath.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the wire feeds {:.4g} mm3/s, but beads of these classes, at their own "
                    "travel speeds, need {} mm3/s, so they are over- or under-filled; give them "
                    "a schedule with a matching wire feed, or the travel speed of the other "
                    "beads",
                    wire_rate,
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
        settings.travel_speed != process.travel_speed or settings.start.there or settings.end.there
        for settings in named
    )
