# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preflight: all promises about a job, in the order in which a process engineer reads them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.toolpath_records import REMAINS_CODE
from ..issues import WARNING, Issue, Text, Word
from ..kinematics.cell import Cell
from ..motion import Motion
from ..parameters.process import ProcessParameters
from ..process import wire
from ..process.deposit import balance as deposit_balance
from ..process.deposit import on_part, spacing, support
from ..process.deposit.balance import MM3, Balance
from ..simulation.payload import CODE, finished
from ..simulation.rapid_contacts import RapidsLooked
from ..simulation.watch import ArmTouches
from ..strategies.clearance.nozzle_check import Looked
from ..toolpath import Toolpath
from ..types import Array
from . import clearance
from .promise import PERCENT, Place, Promise, issue_place, number, select_issues

# ---- Program text compared with the plan, and checks that only the controller can do

TEXT, BETWEEN = (
    "The program moves the tool to the planned points",
    "The program follows the planned path between its points",
)


@dataclass(frozen=True)
class ReadBack:
    """The result of the read-back.

    ok: no error. at_points, between: maximum deviation from the plan, mm. bound: deviation that
    the digits of the text explain, mm. allowed: maximum deviation between points, mm. solvers:
    number of independent kinematics solvers.
    """

    ok: bool
    at_points: float
    between: float
    bound: float
    allowed: float
    solvers: int


def program_promises(read_back: ReadBack | None, on_controller: Sequence[str]) -> list[Promise]:
    """Return the promises about a program text and the checks that only the controller can do."""
    not_checked = "not checked: only the controller can show the result"
    return [*_read_back(read_back), *(Promise(text, not_checked, None) for text in on_controller)]


def _read_back(read_back: ReadBack | None) -> list[Promise]:
    if read_back is None:
        return [
            Promise(what, "not checked: no program was read back", None) for what in (TEXT, BETWEEN)
        ]
    how = "read back by an independent reader and converted to poses by the joint-frame chain"
    method = (
        Text("{} and PyKDL", Word(how))
        if read_back.solvers > 1
        else Text("{}; PyKDL is not installed", Word(how))
    )
    return [
        Promise(
            TEXT,
            method,
            _is_within(read_back, read_back.at_points, read_back.bound),
            *_figure(read_back.at_points, read_back.bound),
        ),
        Promise(
            BETWEEN,
            "path between the points of the program, as the controller interpolates it",
            _is_within(read_back, read_back.between, read_back.allowed),
            *_figure(read_back.between, read_back.allowed),
        ),
    ]


def _is_within(read_back: ReadBack, value: float, bound: float) -> bool:
    return read_back.ok and value <= bound


def _figure(value: float, bound: float) -> tuple[float | None, str, float | None]:
    return (value, "mm", bound) if math.isfinite(value) else (None, "", None)


# ---- Deposit compared with the part, from the issues and statistics of the plan

MAX_VOLUME_ERROR = 1e-6  # tolerance of the predicted deposit volume, fraction of the fed volume


def layers(
    toolpath: Toolpath, issues: Sequence[Issue], known_distances: Sequence[Array] | None = None
) -> Promise:
    """Return the promise about the distance between layers, within the range of the strategy.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    issues : sequence of Issue
        Issues of the plan; SPACING warnings break the promise.
    known_distances : sequence of (n,) array, optional
        Distances to the layer below, mm, for each layer except the first; None to measure them.

    Returns
    -------
    Promise
        With the distance that deviates most from the layer height, mm.
    """
    what = "Layers are one layer height apart"
    how = "distance of each point from the layer below, compared with the range that the strategy allows"
    if toolpath.traits.is_filled and not spacing.is_plane(toolpath):
        known_distances = on_part.over_layers(toolpath)
        how = "height of each point above the nearest point of the layer below, along the build direction there"
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
    """Return the promise about the distance of the beads from the faces or solids of the part."""
    what = "The deposit lies on the part"
    if toolpath.checks.on_part is None:
        return Promise(what, "not checked: the part has no faces to compare with", None)
    count, worst, allowed = toolpath.checks.on_part
    deviations = select_issues(issues, (on_part.CODE,))
    how = Text(
        "distance of {:.0f} bead points from the original shape, independent of slicing",
        count,
    )
    if toolpath.checks.fitted is not None:
        how = Text(
            "distance of {:.0f} bead points from the original shape, without the layer shift due "
            "to a scan",
            count,
        )
    off = worst > allowed or bool(select_issues(issues, (REMAINS_CODE,), WARNING))
    return Promise(what, how, not off, worst, "mm", allowed, issue_place(deviations))


def all_deposited(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Return the promise about the missed volume of the part."""
    what = "The whole part is deposited"
    if balance is None or balance.lines:
        return Promise(what, "not checked: the part encloses no volume", None)
    gaps = select_issues(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.LEFT_OUT,), WARNING
    )
    how = "volume of the part deeper than half a bead width below the wall, or of further solids"
    if balance.filled:
        how = "volume of the part minus the area that beads cover in each layer, at their effective width, times the layer height"
    worst = None if balance.left_out is None else balance.left_out / MM3
    return Promise(what, how, not gaps, worst, "cm3")


def nothing_outside(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Return the promise about the bead volume outside the part."""
    what = "Nothing is deposited outside the part"
    if balance is None or balance.outside is None:
        return Promise(what, "not checked: the part encloses no volume", None)
    excess = select_issues(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.OUTSIDE,), WARNING
    )
    how = "volume by which the beads, at their effective width, exceed the thickness of the part"
    if balance.filled:
        how = "volume of the beads, at their printed width, outside their layers, plus that of layers outside the part"
    return Promise(what, how, not excess, balance.outside / MM3, "cm3")


def once(balance: Balance | None, issues: Sequence[Issue]) -> Promise:
    """Return the promise about over-deposition within layers."""
    what = "Over-deposition is small"
    if balance is None or balance.twice is None:
        return Promise(
            what,
            "not checked: an earlier version planned the toolpath; plan the toolpath again",
            None,
        )
    overlaps = select_issues(
        [*issues, *deposit_balance.issues(balance)], (deposit_balance.TWICE,), WARNING
    )
    how = "bead volume beyond the bead spacing of the layer, compared with 10 % of the beads"
    if balance.filled:
        how = "volume of the beads at the width of their spacing, minus the volume they cover, compared with 10 % of the part"
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
    """Return the promise about the support of every bead."""
    what = "Every bead is supported from below"
    if toolpath.checks.unsupported is None:
        return Promise(what, "not checked: the effective bead width is unknown", None)
    overhangs = select_issues(issues, (support.CODE,), WARNING)
    how = "earlier deposit, at its actual width, or an existing part below each short piece of a bead, against the build direction"
    is_supported = not overhangs and toolpath.checks.unsupported <= 0.0
    return Promise(
        what, how, is_supported, toolpath.checks.unsupported, "mm", 0.0, issue_place(overhangs)
    )


def predicted(toolpath: Toolpath, issues: Sequence[Issue]) -> tuple[Promise, ...]:
    """Return the promises about the predicted deposit of parts with a machining allowance.

    The prediction uses the requested speeds. Without a prediction the result is empty.
    """
    prediction = toolpath.checks.predicted
    if prediction is None:
        return ()
    from ..process.shape import compare  # few jobs have one

    how = Text(
        "distance by which the predicted deposit (cubes of {:.3g} mm, filled bead by bead from "
        "the wire feed) extends beyond the part at {} points of its faces, along their normals",
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
            "The predicted layers have the planned height",
            "mean surface height of each predicted layer, compared with the planned start of the "
            "next layer",
            not drifts,
            largest_drift,
            "mm",
            place=issue_place(drifts),
        ),
        Promise(
            "The predicted deposit has the volume of the wire fed",
            "volume of the cubes against wire section x feed x time, or against the nominal "
            "volume of the beads if no wire is set",
            off <= MAX_VOLUME_ERROR,
            PERCENT * off,
            "%",
            PERCENT * MAX_VOLUME_ERROR,
        ),
    )


def wire_feed(toolpath: Toolpath, process: ProcessParameters) -> Promise:
    """Return the promise that the wire feed matches bead section and speed."""
    what = "The wire feed matches the volume of the beads"
    features = toolpath.parts
    if process.bead_model != "none" or any(
        feature_toolpath.wire_feed is None or feature_toolpath.bead_width is None
        for feature_toolpath, _ in features
    ):
        return Promise(
            what, "not checked: the bead width is not set, or a bead model varies it", None
        )
    if not any(feature_toolpath.wire_feed for feature_toolpath, _ in features):
        return Promise(what, "not checked: process.wire.feed is 0, so there is no wire", None)
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
            "not checked: schedules of the welder, unknown here, set the wire feed of {}",
            ", ".join(schedule_classes),
        )
        return Promise(what, how, None)
    how = "wire section x feed, compared with width x height x speed of the beads of each class, and of their starts and ends"
    return Promise(
        what, how, off <= wire.TOLERANCE, PERCENT * off, "%", PERCENT * wire.TOLERANCE, where
    )


# ---- Payload of the machine that carries the part

WHAT = "Robot or positioner can carry the part"


def payload_promises(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    issues: Sequence[Issue],
) -> list[Promise]:
    """Return the promise about the payload of robot or positioner.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell, including the machines that carry the part.
    toolpath : Toolpath
        The beads and the substrate.
    process : ProcessParameters
        The process, for the density.
    issues : sequence of Issue
        Issues of the plan; PAYLOAD errors break the promise.

    Returns
    -------
    list of Promise
        One promise with the mass of the part, kg. Empty if no machine carries the part, and for
        five-axis machines.
    """
    if not cell.carriers or not cell.machine.free:
        return []
    mass, text = finished(motion, cell, toolpath, process), select_issues(issues, (CODE,))
    weakest = min(cell.carriers, key=lambda carrier: carrier.payload.kg)
    weighed = Text(
        "deposit and closed substrate, at {} g/cm3 (process.density)",
        number(process.density),
    )
    untold = [carrier.title for carrier in cell.carriers if math.isinf(carrier.payload.kg)]
    if untold and not text:
        return [
            Promise(
                WHAT,
                Text(
                    "not checked: the machine file of {} has no payload; {}",
                    untold[0],
                    Word(weighed),
                ),
                None,
                mass,
                "kg",
            )
        ]
    how = Text("{}, compared with the payload of {}", Word(weighed), weakest.title)
    if not math.isinf(weakest.payload.from_axis):
        how = Text(
            "{}, compared with the payload of {}, and its moment about the last axis as the "
            "deposit grows",
            Word(weighed),
            weakest.title,
        )
    return [Promise(WHAT, how, not text, mass, "kg", weakest.payload.kg, issue_place(text))]


OF_MOTION = (
    "Every axis stays within its limits",
    "The joint values reach every planned point",
    "No axis exceeds its maximum speed",
    "The tool stays away from singularities while depositing",
    clearance.ON_RAPIDS,
    "The arm stays clear of part, deposit, platform, nozzle and itself",
)


@dataclass(frozen=True, eq=False)
class Evidence:
    """The data of a preflight.

    toolpath: as printed. issues: from all stages. motion: as the program runs it; None without a
    cell. condition, threshold: (n,) inverse condition number and its minimum per motion row. arm:
    link contacts; None if not checked. true_shapes: whether every link has a given shape. read:
    read-back result; None if no program was read back. on_controller: checks that only the
    controller can do. distances: layer distances, see `spacing`; None if unknown. balance: volumes
    of part and beads; None if unknown. looked: nozzle contacts while depositing; None if the job
    requests no clearance. rapids: nozzle contacts on rapids.
    """

    toolpath: Toolpath
    process: ProcessParameters
    issues: tuple[Issue, ...]
    cell: Cell | None = None
    motion: Motion | None = None
    condition: Array | None = None
    threshold: Array | None = None
    arm: ArmTouches | None = None
    true_shapes: bool = False
    read: ReadBack | None = None
    on_controller: tuple[str, ...] = ()
    distances: tuple[Array, ...] | None = None
    balance: Balance | None = None
    looked: Looked | None = None
    rapids: RapidsLooked | None = None


def promises(evidence: Evidence) -> tuple[Promise, ...]:
    """Return all promises, starting with the deposit."""
    issues = evidence.issues
    return (
        lies_on_part(evidence.toolpath, issues),
        all_deposited(evidence.balance, issues),
        nothing_outside(evidence.balance, issues),
        once(evidence.balance, issues),
        beads_supported(evidence.toolpath, issues),
        layers(evidence.toolpath, issues, evidence.distances),
        wire_feed(evidence.toolpath, evidence.process),
        *predicted(evidence.toolpath, issues),
        clearance.nozzle(issues, evidence.looked),
        *_motion_promises(evidence),
        *program_promises(evidence.read, evidence.on_controller),
    )


def _motion_promises(evidence: Evidence) -> list[Promise]:
    cell, motion = evidence.cell, evidence.motion
    rapids = evidence.rapids
    if (
        cell is None
        or motion is None
        or rapids is None
        or evidence.condition is None
        or evidence.threshold is None
    ):
        return [Promise(what, "not checked: there is no joint path", None) for what in OF_MOTION]
    return [
        *clearance.promises(motion, cell, evidence.condition, evidence.threshold),
        clearance.rapids(evidence.issues, rapids),
        clearance.arm(motion, cell, evidence.arm, evidence.true_shapes),
        *clearance.external_links(
            motion, cell, evidence.arm, evidence.true_shapes, evidence.issues
        ),
        *payload_promises(motion, cell, evidence.toolpath, evidence.process, evidence.issues),
    ]
