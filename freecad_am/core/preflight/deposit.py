# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deposit against the part, by the issues and figures of its planning."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.fitted import REMAINS_CODE
from ..issues import WARNING, Issue, Text
from ..parameters.process import ProcessParameters
from ..process.deposit import balance as deposit_balance
from ..process.deposit import on_part, spacing, support
from ..process.deposit.balance import MM3, Balance
from ..process.model import wire
from ..toolpath import Toolpath
from ..types import Array
from .promise import PERCENT, Place, Promise, issue_place, select_issues

MAX_VOLUME_ERROR = 1e-6  # share of the fed volume by which a predicted deposit may differ


def layers(
    toolpath: Toolpath, issues: Sequence[Issue], known_distances: Sequence[Array] | None = None
) -> Promise:
    """Promise on the distance between layers, (n,) for each except the first; families state themselves
    which distances they allow.
    """
    what = "Layers are one layer height apart"
    how = "distance in space of each point to the layer below, against what the strategy allows"
    if toolpath.traits.is_filled and not spacing.is_plane(toolpath):
        known_distances = on_part.over_layers(toolpath)
        how = "height of each point over the nearest place of the layer below, along the build direction there"
    distances = [
        values
        for values in (
            spacing.between_layers(toolpath) if known_distances is None else known_distances
        )
        if len(values)
    ]
    if not distances:
        return Promise(what, "there is only one layer", None)
    height = toolpath.layer_height
    extremes = [(float(np.nanmin(values)), float(np.nanmax(values))) for values in distances]
    low, high = min(low for low, _ in extremes), max(high for _, high in extremes)
    worst = low if height - low > high - height else high
    wide = select_issues(issues, ("SPACING",), WARNING)
    return Promise(what, how, not wide, worst, "mm", place=issue_place(wide))


def lies_on_part(toolpath: Toolpath, issues: Sequence[Issue]) -> Promise:
    """Promise on the distance between the beads and the faces or solids of the part."""
    what = "The deposit is on the part"
    if toolpath.on_part is None:
        return Promise(what, "not checked: the part has no faces to measure from", None)
    count, worst, allowed = toolpath.on_part
    deviations = select_issues(issues, (on_part.CODE,))
    how = Text(
        "distance of {:.0f} bead points to the original shape, independent of slicing",
        count,
    )
    if toolpath.fitted is not None:
        how = Text(
            "distance of {:.0f} bead points to the original shape, less the layer shift from a "
            "scan",
            count,
        )
    off = worst > allowed or bool(select_issues(issues, (REMAINS_CODE,), WARNING))
    return Promise(what, how, not off, worst, "mm", allowed, issue_place(deviations))


def all_deposited(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Promise on the volume of the part that is not deposited."""
    what = "All of the part is deposited"
    if balance is None or balance.lines:
        return Promise(what, "not checked: the part encloses no volume", None)
    gaps = select_issues(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.LEFT_OUT,), WARNING
    )
    how = "volume of the part deeper than half of a bead's width below the wall, or of its solids aside"
    if balance.filled:
        how = "volume of the part less what beads cover of each layer, as wide as they count, times the layer height"
    worst = None if balance.left_out is None else balance.left_out / MM3
    return Promise(what, how, not gaps, worst, "cm3")


def nothing_outside(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Promise on the volume of beads outside the part."""
    what = "Nothing is deposited outside the part"
    if balance is None or balance.outside is None:
        return Promise(what, "not checked: the part encloses no volume", None)
    excess = select_issues(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.OUTSIDE,), WARNING
    )
    how = "volume of the beads, as wide as they count, that is wider than the part is thick"
    if balance.filled:
        how = (
            "volume of the beads, at their printed width, outside their layers, and of layers "
            "outside the part"
        )
    return Promise(what, how, not excess, balance.outside / MM3, "cm3")


def once(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Promise on the volume of beads that overlap in a layer."""
    what = "Little is deposited twice"
    if balance is None or balance.twice is None:
        return Promise(what, "not checked: planned by an earlier version", None)
    overlaps = select_issues(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.TWICE,), WARNING
    )
    how = "bead volume beyond the bead spacing of the layer, compared with 10 % of the beads"
    if balance.filled:
        how = (
            "volume of the beads, as wide as their spacing, less the covered volume, compared "
            "with 10 % of the part"
        )
    reference_volume = (
        (balance.part_volume or 0.0) - balance.hub if balance.filled else balance.beads or 0.0
    )
    return Promise(
        what,
        how,
        not overlaps,
        balance.twice / MM3,
        "cm3",
        deposit_balance.TWICE_WARNING_SHARE * reference_volume / MM3,
    )


def beads_supported(toolpath: Toolpath, issues: Sequence[Issue]) -> Promise:
    """Promise on unsupported beads."""
    what = "Every bead is supported from below"
    if toolpath.unsupported is None:
        return Promise(what, "not checked: it is not known how wide the beads count", None)
    overhangs = select_issues(issues, (support.CODE,), WARNING)
    how = (
        "each short piece of a bead, against its build direction, above earlier deposit with "
        "its actual width and existing parts"
    )
    is_supported = not overhangs and toolpath.unsupported <= 0.0
    return Promise(what, how, is_supported, toolpath.unsupported, "mm", 0.0, issue_place(overhangs))


def predicted(toolpath: Toolpath, issues: Sequence[Issue]) -> tuple[Promise, ...]:
    """Promises on the predicted deposit, at the requested speeds, for parts with a machining allowance;
    empty without a prediction.
    """
    prediction = toolpath.predicted
    if prediction is None:
        return ()
    from ..process.shape import compare  # few jobs have one

    how = Text(
        "distance by which the predicted deposit, in cubes of {:.3g} mm filled bead by bead from "
        "the wire feed, extends beyond {} points on the part faces, along their normals",
        prediction.edge,
        prediction.places,
    )
    inside = Promise(
        "The predicted deposit covers the part and its machining allowance",
        how,
        prediction.short <= 0.0,
        prediction.least,
        "mm",
        prediction.allowance,
        Place(prediction.layer, prediction.bead, prediction.point),
        at_least=True,
    )
    off = abs(prediction.laid - prediction.fed) / max(prediction.fed, 1e-300)
    drifts = select_issues(issues, (compare.DRIFT,), WARNING)
    drifts_known = prediction.drift[np.isfinite(prediction.drift)]
    largest_drift = float(drifts_known[np.abs(drifts_known).argmax()]) if len(drifts_known) else 0.0
    return (
        inside,
        Promise(
            "Layers come out as high as they are planned",
            "surface of each layer of the predicted deposit, in the mean, "
            "against where the next one should begin",
            not drifts,
            largest_drift,
            "mm",
            place=issue_place(drifts),
        ),
        Promise(
            "The predicted deposit holds what the wire feeds",
            "cubes of the deposit against wire section x feed x time, or "
            "what beads count where no wire is known",
            off <= MAX_VOLUME_ERROR,
            PERCENT * off,
            "%",
            PERCENT * MAX_VOLUME_ERROR,
        ),
    )


def wire_feed(toolpath: Toolpath, process: ProcessParameters) -> Promise:
    """Promise on the wire against the section of the beads, at the speeds at which they are run."""
    what = "The wire feeds what the beads take"
    features = toolpath.parts
    if process.bead_model != "none" or any(
        feature_toolpath.wire_feed is None or feature_toolpath.bead_width is None
        for feature_toolpath, _ in features
    ):
        return Promise(
            what, "not checked: a bead model, or nothing, says how wide the beads are", None
        )
    if not any(feature_toolpath.wire_feed for feature_toolpath, _ in features):
        return Promise(what, "not checked: there is no wire, process.wire.feed is 0", None)
    mismatches = [
        (off, Place(int(numbers[layer]), bead, None))
        for feature_toolpath, numbers in features
        if (largest_mismatch := wire.off_most(feature_toolpath, process))
        for off, layer, bead in [largest_mismatch]
    ]
    schedule_classes = sorted(
        {
            name
            for feature_toolpath, _ in features
            for name in wire.by_schedules(feature_toolpath, process)
        }
    )
    off, where = max(mismatches, key=lambda mismatch: mismatch[0], default=(0.0, None))
    if schedule_classes and off <= wire.TOLERANCE:
        how: str = Text(
            "not checked: the welder schedules, unknown here, set the feed of {}",
            ", ".join(schedule_classes),
        )
        return Promise(what, how, None)
    how = "section of the wire times its feed, against width x height x speed of beads of each class, their starts and ends"
    return Promise(
        what, how, off <= wire.TOLERANCE, PERCENT * off, "%", PERCENT * wire.TOLERANCE, where
    )
