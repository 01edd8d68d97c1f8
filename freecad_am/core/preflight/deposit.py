# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is deposited against the part, by the issues and figures that planning it has found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..geometry.fitted import REMAINS
from ..issues import WARNING, Issue, Text
from ..parameters.process import ProcessParameters
from ..process.deposit import balance as deposit_balance
from ..process.deposit import layer_heights, on_part, spacing, support
from ..process.deposit.balance import MM3, Balance
from ..process.model import wire, wire_taken
from ..toolpath import Toolpath
from ..types import Array
from .promise import PERCENT, Place, Promise, issue_place, of_codes

HELD = 1e-6  # of what is fed, that a predicted deposit may hold more or less


def layers(
    toolpath: Toolpath, issues: Sequence[Issue], known: Sequence[Array] | None = None
) -> Promise:
    """Of the distance between layers, (n,) for each but the first; what families allow of it they have said themselves."""
    what = "Layers lie one layer height apart"
    how = "distance in space of each point to the layer below, against what the strategy allows"
    if toolpath.filled and not spacing.is_plane(toolpath):
        known = layer_heights.over_layers(toolpath)
        how = "height of each point over the nearest place of the layer below, along the build direction there"
    distances = [
        values
        for values in (spacing.between_layers(toolpath) if known is None else known)
        if len(values)
    ]
    if not distances:
        return Promise(what, "there is only one layer", None)
    height = toolpath.layer_height
    extremes = [(float(np.nanmin(values)), float(np.nanmax(values))) for values in distances]
    low, high = min(low for low, _ in extremes), max(high for _, high in extremes)
    worst = low if height - low > high - height else high
    wide = of_codes(issues, ("SPACING",), WARNING)
    return Promise(what, how, not wide, worst, "mm", place=issue_place(wide))


def lies_on_part(toolpath: Toolpath, issues: Sequence[Issue]) -> Promise:
    """Of the distance between the beads and the faces or solids that they were made of."""
    what = "What is deposited lies on the part"
    if toolpath.on_part is None:
        return Promise(what, "not checked: the part has no faces to measure from", None)
    places, worst, allowed = toolpath.on_part
    found = of_codes(issues, (on_part.CODE,))
    how = Text(
        "distance of {:.0f} places of the beads to the shape itself, which slicing does not use",
        places,
    )
    if toolpath.fitted is not None:
        how = Text(
            "distance of {:.0f} places of the beads to the shape itself, less what a scan moved their layers",
            places,
        )
    off = worst > allowed or bool(of_codes(issues, (REMAINS,), WARNING))
    return Promise(what, how, not off, worst, "mm", allowed, issue_place(found))


def whole(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Of what of the part is left out."""
    what = "All of the part is deposited"
    if balance is None or balance.lines:
        return Promise(what, "not checked: the part encloses no volume", None)
    found = of_codes(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.LEFT_OUT,), WARNING
    )
    how = "volume of the part deeper than half of a bead's width below the wall, or of its solids aside"
    if balance.filled:
        how = "volume of the part less what beads cover of each layer, as wide as they count, times the layer height"
    worst = None if balance.left_out is None else balance.left_out / MM3
    return Promise(what, how, not found, worst, "cm3")


def nothing_outside(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Of what the beads deposit that is not the part."""
    what = "Nothing is deposited outside the part"
    if balance is None or balance.outside is None:
        return Promise(what, "not checked: the part encloses no volume", None)
    found = of_codes(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.OUTSIDE,), WARNING
    )
    how = "volume of the beads, as wide as they count, that is wider than the part is thick"
    if balance.filled:
        how = "volume of the beads, as wide as they are laid, outside of their layers, and of layers outside of the part"
    return Promise(what, how, not found, balance.outside / MM3, "cm3")


def once(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Of beads laid over others of their layer."""
    what = "Little is deposited twice"
    if balance is None or balance.twice is None:
        return Promise(what, "not checked: planned by an earlier version", None)
    found = of_codes([*issues, *deposit_balance.issues(balance)], (deposit_balance.TWICE,), WARNING)
    how = "what of beads of one layer is wider than they are apart, against 10 % of the beads"
    if balance.filled:
        how = "volume of the beads, as wide as they are apart, less what they cover, against 10 % of the part"
    whole = (balance.part_volume or 0.0) - balance.hub if balance.filled else balance.beads or 0.0
    return Promise(
        what,
        how,
        not found,
        balance.twice / MM3,
        "cm3",
        deposit_balance.TWICE_WARNING_SHARE * whole / MM3,
    )


def carried(toolpath: Toolpath, issues: Sequence[Issue]) -> Promise:
    """Of beads over nothing."""
    what = "Every bead is carried by what lies below it"
    if toolpath.unsupported is None:
        return Promise(what, "not checked: it is not known how wide the beads count", None)
    found = of_codes(issues, (support.CODE,), WARNING)
    how = "each short piece of a bead, against its build direction, over earlier deposit as wide as it is and what is there"
    kept = not found and toolpath.unsupported <= 0.0
    return Promise(what, how, kept, toolpath.unsupported, "mm", 0.0, issue_place(found))


def predicted(toolpath: Toolpath, issues: Sequence[Issue]) -> tuple[Promise, ...]:
    """Of the deposit that is predicted, at the speeds asked for, where an allowance is; nothing elsewhere."""
    found = toolpath.predicted
    if found is None:
        return ()
    from ..process.shape import compare  # few jobs have one

    how = Text(
        "how far a deposit of cubes of {:.3g} mm, filled bead by bead with what the wire feeds, reaches beyond {} "
        "places of the part's faces, along their normals",
        found.edge,
        found.places,
    )
    inside = Promise(
        "The part lies inside the predicted deposit, by its machining allowance",
        how,
        found.short <= 0.0,
        found.least,
        "mm",
        found.allowance,
        Place(found.layer, found.bead, found.point),
        at_least=True,
    )
    off = abs(found.laid - found.fed) / max(found.fed, 1e-300)
    drifts = of_codes(issues, (compare.DRIFT,), WARNING)
    known = found.drift[np.isfinite(found.drift)]
    most = float(known[np.abs(known).argmax()]) if len(known) else 0.0
    return (
        inside,
        Promise(
            "Layers come out as high as they are planned",
            "surface of each layer of the predicted deposit, in the mean, "
            "against where the next one should begin",
            not drifts,
            most,
            "mm",
            place=issue_place(drifts),
        ),
        Promise(
            "The predicted deposit holds what the wire feeds",
            "cubes of the deposit against wire section x feed x time, or "
            "what beads count where no wire is known",
            off <= HELD,
            PERCENT * off,
            "%",
            PERCENT * HELD,
        ),
    )


def fed(toolpath: Toolpath, process: ProcessParameters) -> Promise:
    """Of the wire against the section of the beads, at the speeds at which they are run."""
    what = "The wire feeds what the beads take"
    parts = toolpath.parts
    if process.bead_model != "none" or any(
        part.wire_feed is None or part.bead_width is None for part, _ in parts
    ):
        return Promise(
            what, "not checked: a bead model, or nothing, says how wide the beads are", None
        )
    if not any(part.wire_feed for part, _ in parts):
        return Promise(what, "not checked: there is no wire, process.wire.feed is 0", None)
    found = [
        (off, Place(int(numbers[layer]), bead, None))
        for part, numbers in parts
        if (most := wire_taken.off_most(part, process))
        for off, layer, bead in [most]
    ]
    others = sorted({name for part, _ in parts for name in wire_taken.by_schedules(part, process)})
    off, where = max(found, key=lambda one: one[0], default=(0.0, None))
    if others and off <= wire.TOLERANCE:
        how: str = Text(
            "not checked: the welder's own schedules, which are not known here, set the feed of {}",
            ", ".join(others),
        )
        return Promise(what, how, None)
    how = "section of the wire times its feed, against width x height x speed of beads of each class, their starts and ends"
    return Promise(
        what, how, off <= wire.TOLERANCE, PERCENT * off, "%", PERCENT * wire.TOLERANCE, where
    )
