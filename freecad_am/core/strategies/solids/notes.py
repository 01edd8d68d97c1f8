# SPDX-License-Identifier: LGPL-2.1-or-later
"""Issues about the beads of solids.

Speeds, widths, heights against the layer height, waits and repairs; and torch rotation: spread at corners, reduced lean,
fast normals.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...issues import NOTE, WARNING, Issue, Text, Word
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.bead_model import BeadModel
from ...process.model_notes import model_issues
from ...toolpath import Layer
from ...types import Array
from .beads import MadeBead
from .filling import FULL_RANGE
from .flattened_bead import LEAST_DEPARTURE
from .torch_tilt import Turned

SLIGHTLY = 0.01  # fraction of the travel speed; minimum difference that is reported
WIDTH_TEXT = "as wide as the available space, {} mm"
HIGH = "as high as the layer there, {} mm"


def notes(
    made_beads: Sequence[MadeBead],
    layers: Sequence[Layer],
    strategy: FilledParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    model: BeadModel | None,
) -> list[Issue]:
    """Return all issues about the beads of solids.

    Parameters
    ----------
    made_beads : sequence of MadeBead
        The beads with their reports.
    layers : sequence of Layer
        The layers in print order.
    strategy : FilledParameters
        Layer height, spacing and waits.
    build : BuildDirectionParameters
        Build direction with the maximum turn rate.
    process : ProcessParameters
        Speeds and wire.
    model : BeadModel or None
        Bead model that sets the speeds, if any.

    Returns
    -------
    list of Issue
        Issues about speeds or model, single layers, waits and torch rotation.
    """
    height = strategy.layer_height
    issues = (
        _speeds(layers, strategy, process)
        if model is None
        else model_issues(made_beads, height, process, model)
    )
    issues += _single_layers(layers, strategy)
    waits = [layer.wait for layer in layers if layer.wait > 0.0]
    if waits and strategy.min_layer_time > 0.0:
        issues.append(
            Issue(
                NOTE,
                "WAITS",
                Text(
                    "the machine waits before {} of {} layers, up to {:.4g} s and {:.5g} s in "
                    "total, so that every layer takes at least {:g} s and at least {:g} s pass "
                    "between two layers of a solid",
                    len(waits),
                    len(layers),
                    max(waits),
                    sum(waits),
                    strategy.min_layer_time,
                    strategy.wait,
                ),
            )
        )
    elif waits:
        issues.append(
            Issue(
                NOTE,
                "WAITS",
                Text(
                    "the machine waits before {} of {} layers, up to {:.4g} s and {:.5g} s in "
                    "total, so that at least {:g} s pass between two layers of a solid",
                    len(waits),
                    len(layers),
                    max(waits),
                    sum(waits),
                    strategy.wait,
                ),
            )
        )
    return issues + _leans(made_beads, layers, build)


def _speeds(
    layers: Sequence[Layer], strategy: FilledParameters, process: ProcessParameters
) -> list[Issue]:
    """Report the speeds at which a constant wire feed gives beads of varying width or height.

    The issue is at the bead that deviates most from its travel speed.
    """
    classes = {bead.role.bead_class for layer in layers for bead in layer.beads}
    usual = {name: process.for_class(name).travel_speed for name in classes}
    deviations = [
        (float(np.abs(bead.speed[1:] / usual[bead.role.bead_class] - 1.0).max()), i, j)
        for i, layer in enumerate(layers)
        for j, bead in enumerate(layer.beads)
    ]
    varied = [deviation for deviation in deviations if deviation[0] > SLIGHTLY]
    if not varied:
        return []
    beads = [layers[i].beads[j] for _, i, j in varied]
    speed = np.concatenate([bead.speed[1:] for bead in beads])
    usual_speeds = {usual[bead.role.bead_class] for bead in beads}
    instead = Text(" instead of {:.4g} mm/s", usual_speeds.pop()) if len(usual_speeds) == 1 else ""
    wide = [bead.width for bead in beads if bead.width is not None]
    high = [bead.height for bead in beads if bead.height is not None]
    sizes = [
        Text(text, _range(*_ends(columns), "{:.3g}"))
        for text, columns in ((WIDTH_TEXT, wide), (HIGH, high))
        if columns
    ]
    _, layer, number = max(varied, key=lambda deviation: deviation[0])
    text = Text(
        "{} of {} beads are deposited at {} mm/s{}, so that a constant wire feed makes the beads "
        "{}",
        len(varied),
        len(deviations),
        _range(speed.min(), speed.max(), "{:.4g}"),
        Word(instead),
        Text.joined(" and ", sizes),
    )
    remedy = _for_one_speed(strategy, bool(high))
    message = Text("{}; for a constant speed set {}", text, remedy) if remedy else text
    return [Issue(NOTE, "SPEED_VARIES", message, layer, number)]


def _for_one_speed(strategy: FilledParameters, high: bool) -> str:
    """Return the settings that give all beads the same width and height, and so the same speed; '' if none.

    high: whether heights differ, as in layers along a guide.
    """
    settings = [
        *(["strategy.layers: planes"] if high else []),
        *(["strategy.fill: contours"] if strategy.fill == "connected" else []),
        *(
            [Text("a spacing range of {0} to {0}", "100 %")]
            if strategy.spacing_range != FULL_RANGE
            else []
        ),
        *(["strategy.narrowest: 100 %"] if strategy.narrowest < 1.0 else []),
    ]
    return Text.joined(" and ", settings)


def _range(low: float, high: float, form: str) -> Text | str:
    """Return two numbers as a range; as one number if they read the same."""
    start, end = form.format(low), form.format(high)
    return start if start == end else Text("{} to {}", start, end)


def _ends(columns: Sequence[Array]) -> tuple[float, float]:
    """Return the minimum and the maximum of several columns."""
    return min(float(column.min()) for column in columns), max(
        float(column.max()) for column in columns
    )


def _single_layers(layers: Sequence[Layer], strategy: FilledParameters) -> list[Issue]:
    """Report solids, or groups of solids deposited together, with a single layer."""
    starts = [*(index for index, layer in enumerate(layers) if layer.first), len(layers)]
    single = [start for start, end in zip(starts, starts[1:]) if end - start == 1]
    if not single:
        return []
    return [
        Issue(
            NOTE,
            "SINGLE_LAYER",
            Text(
                "{} of {} solids or groups of solids get only one layer, on the hub, because "
                "they are no higher than strategy.layer_height, {:g} mm",
                len(single),
                len(starts) - 1,
                strategy.layer_height,
            ),
            single[0],
        )
    ]


def _leans(
    made_beads: Sequence[MadeBead], layers: Sequence[Layer], build: BuildDirectionParameters
) -> list[Issue]:
    """Report torch rotation with at most one issue of each kind, at the worst bead."""
    turned = {
        id(made_bead.bead): made_bead.turned
        for made_bead in made_beads
        if made_bead.turned is not None
    }
    keyed_beads = [
        (bead, i, j) for i, layer in enumerate(layers) for j, bead in enumerate(layer.beads)
    ]
    beads = [(turned[id(bead)], i, j) for bead, i, j in keyed_beads if id(bead) in turned]
    turn_text = (
        "" if build.max_turn == "auto" else Text(" ({:.3g} deg/mm)", math.degrees(build.turn()))
    )
    limit = Text("build_direction.max_turn{}", Word(turn_text))
    return _turn_issues(beads, limit) + _less(beads, limit) + _normals(beads, limit)


def _turn_issues(beads: Sequence[tuple[Turned, int, int]], limit: str) -> list[Issue]:
    spread_beads = [entry for entry in beads if entry[0].departure > LEAST_DEPARTURE]
    if not spread_beads:
        return []
    worst, layer, bead = max(spread_beads, key=lambda entry: entry[0].departure)
    length = sum(entry[0].length for entry in spread_beads)
    return [
        Issue(
            NOTE,
            "TURN_LIMITED",
            Text(
                "on {} of {} beads, {:.4g} mm in total, the torch starts to turn before corners, "
                "deviating by up to {:.3g} deg, to turn no faster than {}",
                len(spread_beads),
                len(beads),
                length,
                math.degrees(worst.departure),
                limit,
            ),
            layer,
            bead,
        )
    ]


def _less(beads: Sequence[tuple[Turned, int, int]], limit: str) -> list[Issue]:
    reduced = [entry for entry in beads if entry[0].requested > 0.0 and entry[0].share < 1.0]
    if not reduced:
        return []
    worst, layer, bead = min(reduced, key=lambda entry: entry[0].share)
    layers = sorted({entry[1] for entry in reduced})
    where = (
        Text("layer {}", layers[0])
        if len(layers) == 1
        else Text("{} layers from {} to {}", len(layers), layers[0], layers[-1])
    )
    return [
        Issue(
            WARNING,
            "LEAN_REDUCED",
            Text(
                "on {} of {} beads in {}, bends are too close together to turn the torch around "
                "each bend at {}: the tilt of the torch is {:.3g} to {:.3g} deg there instead of "
                "{:.3g} deg; tilt less, or allow a faster turn",
                len(reduced),
                len(beads),
                Word(where),
                limit,
                math.degrees(worst.share * worst.requested),
                math.degrees(max(entry[0].share * entry[0].requested for entry in reduced)),
                math.degrees(worst.requested),
            ),
            layer,
            bead,
        )
    ]


def _normals(beads: Sequence[tuple[Turned, int, int]], limit: str) -> list[Issue]:
    fast = [entry for entry in beads if entry[0].normals > 0.0]
    if not fast:
        return []
    worst, layer, bead = max(fast, key=lambda entry: entry[0].normals)
    return [
        Issue(
            WARNING,
            "TURN_OF_NORMALS",
            Text(
                "on {} of {} beads the hub normals themselves turn by up to {:.3g} deg/mm, "
                "faster than {}; the torch still follows the normals",
                len(fast),
                len(beads),
                math.degrees(worst.normals),
                limit,
            ),
            layer,
            bead,
        )
    ]
