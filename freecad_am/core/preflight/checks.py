# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preflight: every promise of a job in the order in which a process engineer reads them."""

from __future__ import annotations

from dataclasses import dataclass

from ..issues import Issue
from ..kinematics.cell import Cell
from ..motion import Motion
from ..parameters.process import ProcessParameters
from ..process.deposit.balance import Balance
from ..simulation.rapid_look import RapidsLooked
from ..simulation.watch import ArmTouches
from ..strategies.clearance.look import Looked
from ..toolpath import Toolpath
from ..types import Array
from . import clearance, deposit, payload, written
from .promise import Promise
from .written import ReadBack

OF_MOTION = (
    "Every axis stays within its limits",
    "The joints bring the tool to every point",
    "No axis is asked for more than its largest speed",
    "The tool keeps away from singularities while it deposits",
    clearance.ON_RAPIDS,
    "The arm stays clear of part, deposit, platform, nozzle and itself",
)


@dataclass(frozen=True, eq=False)
class Evidence:
    """The data of a preflight.

    toolpath: as printed. issues: of all stages. motion: as the program runs it, None without a
    cell; condition, threshold: (n,) of its rows. arm: contacts of the links, None if not checked;
    true_shapes: whether every link has a given shape. read: the result of the read-back, None
    without one. on_controller: checks that only the controller can do. distances: between its
    layers, see `spacing`, if known. balance: of part and beads, None if unknown. looked: contacts
    of the nozzle while depositing, None if the job asks for no clearance. rapids: contacts of the
    nozzle on rapids.
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
    """All promises, those about the deposit first."""
    issues = evidence.issues
    return (
        deposit.lies_on_part(evidence.toolpath, issues),
        deposit.all_deposited(evidence.balance, issues),
        deposit.nothing_outside(evidence.balance, issues),
        deposit.once(evidence.balance, issues),
        deposit.beads_supported(evidence.toolpath, issues),
        deposit.layers(evidence.toolpath, issues, evidence.distances),
        deposit.wire_feed(evidence.toolpath, evidence.process),
        *deposit.predicted(evidence.toolpath, issues),
        clearance.nozzle(issues, evidence.looked),
        *_motion_promises(evidence),
        *written.promises(evidence.read, evidence.on_controller),
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
        *payload.payload_promises(
            motion, cell, evidence.toolpath, evidence.process, evidence.issues
        ),
    ]
