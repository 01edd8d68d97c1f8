# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls, parts of revolution and curves at the travel speeds by which a bead model holds the width of their beads."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...parameters.process import ProcessParameters
from ...toolpath import Bead, Toolpath
from ...types import Array, Mask
from .bead_model import BeadModel
from .bead_speed import limit_acceleration, side_radii
from .notes import model_issues
from .wire import model_wire_feed


class AtSpeed(NamedTuple):
    """A bead at the speeds of a model, where (n,) the speed is not what the width asks for, and where it bends more than the
    table's beads."""

    bead: Bead
    clamped: Mask
    tight: Mask


def at_speed(
    bead: Bead,
    radius: Array,
    course: Array,
    closed: bool,
    process: ProcessParameters,
    model: BeadModel,
    share: Array | float = 1.0,
) -> AtSpeed:
    """The bead at the speeds that keep its width, or a share (n,) of its width, with radii of curvature (n,) mm.

    Speeds change along its course, points (n, k), by no more than the acceleration of the process.
    """
    speeds = model.speed_for(process.bead_width * share, radius)
    speed = limit_acceleration(course, speeds.speed, closed, process.acceleration)
    widths, heights, wire_share = model.widths(speed, radius), model.heights(speed, radius), None
    if process.wire.feed_mode == "proportional":
        heights = model.heights_of_section(widths, process.bead_width)
        wire_share = model_wire_feed(process, model) / model.straight_speed(process.bead_width)
    sized_bead = replace(
        bead, speed=segment_speeds(speed), width=widths, height=heights, wire_share=wire_share
    )
    return AtSpeed(sized_bead, speeds.too_slow | speeds.too_fast, speeds.too_tight)


def segment_speeds(speed: Array) -> Array:
    """Speeds (n,) of the segments that end at points, from those at points (n,)."""
    return np.concatenate([speed[:1], 0.5 * (speed[:-1] + speed[1:])])


def hold_widths(toolpath: Toolpath, process: ProcessParameters, model: BeadModel) -> Toolpath:
    """The toolpath of beads that fill nothing, each as wide as asked for where it bends about its build directions, with
    what the model says of widths and heights."""
    sized: list[AtSpeed] = []
    layers = []
    for layer in toolpath.layers:
        layer_beads = [_hold_bead(bead, process, model) for bead in layer.beads]
        sized += layer_beads
        layers.append(replace(layer, beads=tuple(sized_bead.bead for sized_bead in layer_beads)))
    widened = model_issues(sized, toolpath.layer_height, process, model)
    return replace(
        toolpath,
        layers=tuple(layers),
        law=model.law(process.acceleration),
        issues=(*toolpath.issues, *widened),
    )


def _hold_bead(bead: Bead, process: ProcessParameters, model: BeadModel) -> AtSpeed:
    radius = side_radii(bead.points, bead.build, bead.closed, process.bead_width)
    return at_speed(bead, radius, bead.points, bead.closed, process, model)
