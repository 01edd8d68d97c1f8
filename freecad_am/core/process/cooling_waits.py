# SPDX-License-Identifier: LGPL-2.1-or-later
"""Waits before layers, and slow layers, for the deposit below to cool.

They enforce a minimum time between visits to a solid and a minimum layer time.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from ..issues import NOTE, WARNING, InputError, Issue, Text
from ..parameters.process import ProcessParameters
from ..parameters.strategy import BOTH, LayerTimeParameters
from ..toolpath import Bead, Layer, Toolpath
from ..types import Array
from .bead_model import BeadModel
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


# ---- Layers deposited more slowly

SLOWED, SHORT = "LAYERS_SLOWED", "LAYERS_SHORT"
SLOW_BY = "strategy.layer_time.by"
PRECISION = 1e-9  # s; a layer that lacks less takes long enough


def slowest_speed(
    timing: LayerTimeParameters, process: ProcessParameters, model: BeadModel | None
) -> float:
    """Return the speed below which no layer is slowed, after checks of the minimum layer time.

    Parameters
    ----------
    timing : LayerTimeParameters
        Minimum time of layers.
    process : ProcessParameters
        Speeds, wire and material.
    model : BeadModel or None
        Bead model that sets the speeds, if any.

    Returns
    -------
    float
        Speed, mm/s; 0 if no layer is slowed.

    Raises
    ------
    InputError
        BAD_VALUE for a slowest speed above the usual one, for a wire feed that cannot follow the
        speed, and without a slowest speed.
    """
    usual = process.travel_speed if model is None else model.straight_speed(process.bead_width)
    if timing.slowest is not None and timing.slowest > usual:
        raise InputError(
            "BAD_VALUE",
            "strategy.layer_time.slowest",
            "{:.4g} mm/s is above the usual travel speed, {:.4g} mm/s; give a slower speed",
            timing.slowest,
            usual,
        )
    if not timing.slows:
        return 0.0
    if process.wire.feed_mode == "constant":
        raise InputError(
            "BAD_VALUE",
            SLOW_BY,
            "{} would make beads larger, because the wire feed is constant; use "
            "process.wire.feed_mode: proportional, or strategy.layer_time.by: wait",
            timing.by,
        )
    if process.wire.feed == 0.0:
        raise InputError(
            "BAD_VALUE",
            SLOW_BY,
            "{} needs a wire feed that follows the travel speed, but process.wire.feed is 0; give "
            "the wire feed, or use strategy.layer_time.by: wait",
            timing.by,
        )
    limits = (timing.slowest, process.material.slowest, None if model is None else model.speeds[0])
    given_limits = [limit for limit in limits if limit is not None]
    if not given_limits:
        raise InputError(
            "BAD_VALUE",
            SLOW_BY,
            "{} needs a slowest travel speed; give strategy.layer_time.slowest or "
            "process.material.slowest",
            timing.by,
        )
    return max(given_limits)


def _stretches(bead: Bead, overlap: float, retreat: float) -> tuple[Array, Array]:
    """Return lengths (k,), mm, and speeds (k,), mm/s, of all stretches of a bead as it is run.

    Stretches are not in order. Ramps count with the mean of their speeds.
    """
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    total = float(length.sum())
    extra_length = min(bead.overlap_of(overlap) if bead.closed else retreat, total)
    stretches = [(extra_length, float(bead.speed[1] if bead.closed else bead.speed[-1]))]
    ends = bead.ends
    if ends is not None:
        length = length * (1.0 - ends.length / total)
        for long, ramp, speed, beside in (
            (ends.start_length, ends.start_ramp, ends.start_speed, float(bead.speed[1])),
            (ends.end_length, ends.end_ramp, ends.end_speed, float(bead.speed[-1])),
        ):
            stretches += [(long, speed or beside), (ramp, 0.5 * ((speed or beside) + beside))]
    lengths, speeds = np.array(stretches).T
    return np.r_[length, lengths], np.r_[bead.speed[1:], speeds]


def _speed_share(length: Array, speed: Array, time: float, slowest: float) -> float:
    """Return the share of its speed at which a layer is deposited in a time, as far as possible.

    Stretches that would fall below the slowest speed keep it, or their own speed if that is below.

    Parameters
    ----------
    length, speed : (n,) array
        Stretches, mm and mm/s.
    time : float
        Time, s.
    slowest : float
        Slowest speed, mm/s.

    Returns
    -------
    float
        Share, at most 1; 0 if all stretches are at the slowest speed.
    """
    usual = length / speed
    is_slowest = speed <= slowest
    slowest_time = np.maximum(usual, length / slowest)
    slowest_time[is_slowest] = usual[is_slowest]
    while not is_slowest.all():
        remaining = time - slowest_time[is_slowest].sum()
        share = float(usual[~is_slowest].sum() / remaining) if remaining > 0.0 else np.inf
        too_slow = ~is_slowest & (share * speed < slowest)
        if not too_slow.any():
            return min(share, 1.0)
        is_slowest |= too_slow
    return 0.0


def _slow_bead(bead: Bead, share: float, slowest: float) -> Bead:
    """Return a bead at a share of its speed, but not below the slowest speed."""

    def slowed(speed: Array) -> Array:
        return np.minimum(speed, np.maximum(share * speed, slowest))

    ends = bead.ends
    if ends is not None:
        start, end = slowed(np.array([ends.start_speed, ends.end_speed])).tolist()
        ends = dataclasses.replace(ends, start_speed=start, end_speed=end)
    return dataclasses.replace(bead, speed=slowed(bead.speed), ends=ends)


def slow_layers(
    toolpath: Toolpath, timing: LayerTimeParameters, process: ProcessParameters, slowest: float
) -> Toolpath:
    """Return the toolpath with short layers slowed, and with waits for what is still missing.

    The wire follows the speed, so every bead keeps its volume per length. The time of a layer
    includes the rapid to the next one. Rapids are assumed to be straight moves.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath, with beads that have a wire share.
    timing : LayerTimeParameters
        Minimum time of layers; waits only for `both`.
    process : ProcessParameters
        Speed of rapids, and the wait between layers.
    slowest : float
        Slowest speed, mm/s.

    Returns
    -------
    Toolpath
        The toolpath with a note about slowed layers and a warning about layers that remain short.
    """
    layers = list(toolpath.layers)
    filled = [number for number, layer in enumerate(layers) if layer.beads]
    missing = {}
    for number, following in zip(filled, [*filled[1:], None], strict=True):
        layer = layers[number]
        stretches_of_beads = [
            _stretches(bead, toolpath.rules.overlap, toolpath.rules.retreat) for bead in layer.beads
        ]
        length, speed = (
            np.concatenate(columns) for columns in zip(*stretches_of_beads, strict=True)
        )
        starts = [bead.points[0] for bead in layer.beads[1:]]
        starts += [] if following is None else [layers[following].beads[0].points[0]]
        rapid = sum(
            float(np.linalg.norm(start - bead.points[-1]))
            for bead, start in zip(layer.beads, starts, strict=False)
        )
        between = 0.0 if following is None else process.between_layers.wait
        usual = float((length / speed).sum())
        time = timing.least - rapid / process.rapid_speed - between
        if time <= usual + PRECISION:
            continue
        share = _speed_share(length, speed, time, slowest)
        new_speed = np.minimum(speed, np.maximum(share * speed, slowest))
        slow = float((length / new_speed).sum())
        if slow > usual:
            beads = tuple(_slow_bead(bead, share, slowest) for bead in layer.beads)
            layers[number] = dataclasses.replace(layer, beads=beads, slowing=slow / usual)
        if time > slow + PRECISION:
            missing[number] = time - slow
            if timing.by == BOTH and following is not None:
                wait = time - slow + between
                layers[following] = dataclasses.replace(layers[following], wait=wait)
    notes = _timing_issues(layers, missing, timing, slowest)
    return dataclasses.replace(toolpath, layers=tuple(layers), issues=(*toolpath.issues, *notes))


def _timing_issues(
    layers: list[Layer],
    missing: dict[int, float],
    timing: LayerTimeParameters,
    slowest: float,
) -> list[Issue]:
    """Return issues about slowed layers, and about those that lack time. missing: s, by layer."""
    issues = []
    slowed = [number for number, layer in enumerate(layers) if layer.slowing > 1.0]
    if slowed:
        slowest_layer = max(slowed, key=lambda number: layers[number].slowing)
        issues.append(
            Issue(
                NOTE,
                SLOWED,
                Text(
                    "{} of {} layers are slowed, to {:.3g} % of their speed and {:.4g} mm/s at the "
                    "least, for a minimum time of {:g} s; the wire feed follows",
                    len(slowed),
                    len(layers),
                    100.0 / layers[slowest_layer].slowing,
                    min(float(bead.speed[1:].min()) for k in slowed for bead in layers[k].beads),
                    timing.least,
                ),
                slowest_layer,
            )
        )
    waits = [layer.wait for layer in layers if layer.wait > 0.0]
    if waits:
        issues.append(
            Issue(
                NOTE,
                WAITS,
                Text(
                    "the machine waits before {} of {} layers, up to {:.4g} s and {:.5g} s in "
                    "total, because the layers below cannot be slowed below {:.4g} mm/s",
                    len(waits),
                    len(layers),
                    max(waits),
                    sum(waits),
                    slowest,
                ),
            )
        )
    elif missing:
        worst = max(missing, key=lambda number: missing[number])
        issues.append(
            Issue(
                WARNING,
                SHORT,
                Text(
                    "{} of {} layers take up to {:.4g} s less than strategy.layer_time.least, "
                    "{:g} s, because they cannot be slowed below {:.4g} mm/s; use "
                    "strategy.layer_time.by: both to wait for the rest",
                    len(missing),
                    len(layers),
                    missing[worst],
                    timing.least,
                    slowest,
                ),
                worst,
            )
        )
    return issues


# ---- Waits in a toolpath


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
