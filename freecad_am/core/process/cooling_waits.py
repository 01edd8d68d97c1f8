# SPDX-License-Identifier: LGPL-2.1-or-later
"""Waits before layers for the deposit below to cool.

They enforce a minimum time between visits to a solid and a minimum layer time.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from ..issues import NOTE, Issue, Text
from ..toolpath import Layer, Toolpath
from ..types import Array
from .bead_order import Course

WAITS = "WAITS"


def add_waits(
    course: Course, wait: float, rapid_speed: float, min_layer_time: float = 0.0
) -> tuple[Layer, ...]:
    """Return the layers with waits before them.

    Rapids are assumed to be straight moves between beads, so waits tend to be too long.

    Parameters
    ----------
    course : Course
        Layers in print order.
    wait : float
        Minimum time before the return to a solid, s.
    rapid_speed : float
        Speed of rapids, mm/s.
    min_layer_time : float, optional
        Minimum time of a layer, s.

    Returns
    -------
    tuple of Layer
        The layers.
    """
    now, layers = 0.0, []
    end_times: dict[tuple[int, int], float] = {}
    position: Array | None = None
    time = min_layer_time
    for layer, solids in zip(course.layers, course.solids, strict=True):
        starts: dict[tuple[int, int], float] = {}
        ends: dict[tuple[int, int], float] = {}
        short = 0.0 if layer.first else min_layer_time - time  # missing time of the previous layer
        time = 0.0
        for bead, solid in zip(layer.beads, solids, strict=True):
            if position is not None:
                time += float(np.linalg.norm(bead.points[0] - position)) / rapid_speed
            starts.setdefault(solid, time)
            time += float(
                (np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum()
            )
            ends[solid], position = time, bead.points[-1]
        pause = max(
            (
                end_times[solid] + wait - now - start
                for solid, start in starts.items()
                if solid in end_times
            ),
            default=0.0,
        )
        pause = max(pause, short, 0.0)
        layers.append(dataclasses.replace(layer, wait=pause))
        end_times.update({solid: now + pause + end for solid, end in ends.items()})
        now += pause + time
    return tuple(layers)


def enforce_layer_time(toolpath: Toolpath, min_layer_time: float, rapid_speed: float) -> Toolpath:
    """Return the toolpath with waits that enforce a minimum layer time.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    min_layer_time : float
        Minimum time of a layer, s; 0 for no minimum.
    rapid_speed : float
        Speed of rapids, mm/s.

    Returns
    -------
    Toolpath
        The toolpath with a note about the waits.
    """
    if min_layer_time <= 0.0:
        return toolpath
    solids = tuple(((0, 0),) * len(layer.beads) for layer in toolpath.layers)
    layers = add_waits(Course(toolpath.layers, solids), 0.0, rapid_speed, min_layer_time)
    waits = [layer.wait for layer in layers if layer.wait > 0.0]
    text = (
        [
            Issue(
                NOTE,
                WAITS,
                Text(
                    "the machine waits before {} of {} layers, up to {:.4g} s and {:.5g} s in "
                    "total, so that every layer takes at least {:g} s",
                    len(waits),
                    len(layers),
                    max(waits),
                    sum(waits),
                    min_layer_time,
                ),
            )
        ]
        if waits
        else []
    )
    return dataclasses.replace(toolpath, layers=layers, issues=(*toolpath.issues, *text))


def remove_waits(toolpath: Toolpath) -> Toolpath:
    """Return the toolpath without waits before layers, and without notes about them."""
    if not any(layer.wait for layer in toolpath.layers):
        return toolpath
    return dataclasses.replace(
        toolpath,
        layers=tuple(dataclasses.replace(layer, wait=0.0) for layer in toolpath.layers),
        issues=tuple(issue for issue in toolpath.issues if issue.code != WAITS),
    )
