# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preflight of document stages: promises derived from the stage results."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from ...core.issues import Issue, has_errors
from ...core.kinematics.cell import Cell
from ...core.kinematics.links.external_links import Mesh
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.preflight.checks import Evidence, ReadBack, promises
from ...core.preflight.promise import Promise
from ...core.process.deposit import balance as deposit_balance
from ...core.process.deposit import spacing
from ...core.process.deposit.balance import Balance
from ...core.simulation import rapid_contacts
from ...core.simulation.rapid_contacts import RapidsLooked
from ...core.simulation.watch import ArmTouches
from ...core.strategies.clearance import nozzle_check
from ...core.strategies.clearance.nozzle_check import Looked
from ...core.toolpath import Toolpath
from ...core.types import Array
from ...posts import catalogue
from ...verify import Verification
from .. import user_machines
from ..joint_path import Planned
from ..results.as_run import AsRun, as_run
from ..results.findings import issues_of
from ..shapes.cell_obstacles import meshes_of, platforms, resolved
from ..toolpath import features_of
from .placed import arm_of

# maximum numbers of samples for the arm, the depositing nozzle and the nozzle on rapids; together
# these checks take at most a tenth of the planning time
ARM_PLACES, NOZZLE_PLACES, RAPID_PLACES = 6_000, 4_000, 12_000

Work = Callable[[], tuple[Promise, ...]]


@dataclass(frozen=True, eq=False)
class Surveyed:
    """Slow part of the `Evidence` on a toolpath and, if given, its joint path."""

    distances: tuple[Array, ...]
    balance: Balance | None
    nozzle_check: Looked | None
    rapids: RapidsLooked | None = None
    arm: ArmTouches | None = None


Survey = Callable[[], Surveyed]
What = tuple[Toolpath, Planned, Cell, tuple[Mesh | None, ...]]


def stage_preflight(
    toolpath: Any, path: Any = None, program: Any = None, surveyed: Survey | None = None
) -> tuple[Promise, ...]:
    """Return the preflight promises of a toolpath, its joint path and its program.

    toolpath, path, program: document objects or None. surveyed: function from `survey_of`, if
    already started. Raises InputError NO_RESULT if a stage has no result.
    """
    if program is None:
        return prepared(toolpath, path, surveyed=surveyed)()
    settings = program.Proxy.parameters(program, ProgramParameters)
    return prepared(
        toolpath, path, settings, read_back_of(program), tuple(issues_of(program)), surveyed
    )()


def read_back_of(program: Any) -> Verification | None:
    """Return the verification of a program object, None without a read-back."""
    verification: Verification | None = (
        program.Proxy.value(program).verification if program.Key else None
    )
    return verification


def prepared(
    toolpath: Any,
    path: Any = None,
    settings: ProgramParameters | None = None,
    verification: Verification | None = None,
    further_issues: tuple[Issue, ...] = (),
    surveyed: Survey | None = None,
) -> Work:
    """Return a function that makes the preflight of a toolpath and its joint path.

    The document is read now; the function does not use it. toolpath, path: document objects.
    settings: program parameters. verification: read-back of the program. further_issues: issues of
    the program. surveyed: function from `survey_of`. Raises InputError NO_RESULT if a stage has no
    result.
    """
    stages = [stage for stage in (*features_of(toolpath), toolpath, path) if stage is not None]
    issues = tuple(
        dict.fromkeys(
            [issue for stage in stages for issue in issues_of(stage)] + list(further_issues)
        )
    )
    planned, process = (
        toolpath.Proxy.reader(toolpath),
        toolpath.Proxy.parameters(toolpath, ProcessParameters),
    )
    run = None if path is None else _Run(path, settings)
    survey = surveyed or _survey(toolpath, run)

    def preflight() -> tuple[Promise, ...]:
        as_it_runs = None if run is None else run.how(issues)
        survey_result = survey()  # call last, because it may block
        evidence = Evidence(
            planned(),
            process,
            issues,
            distances=survey_result.distances,
            balance=survey_result.balance,
            looked=survey_result.nozzle_check,
            rapids=survey_result.rapids,
            arm=survey_result.arm,
        )
        return promises(
            evidence
            if run is None or as_it_runs is None
            else _add_motion_evidence(evidence, run, as_it_runs, verification)
        )

    return preflight


def survey_of(toolpath: Any, path: Any, settings: ProgramParameters | None) -> Survey:
    """Return a function that computes the slow part of the preflight.

    The document is read now; the function does not use it. settings: parameters of the joint path's
    program. Raises InputError NO_RESULT if a stage has no result.
    """
    return _survey(toolpath, None if path is None else _Run(path, settings))


def _survey(toolpath: Any, run: _Run | None) -> Survey:
    features, process = (
        features_of(toolpath),
        toolpath.Proxy.parameters(toolpath, ProcessParameters),
    )
    builds = [feature.Proxy.parameters(feature, BuildDirectionParameters) for feature in features]
    planned, shapes = (
        toolpath.Proxy.reader(toolpath),
        [feature.Proxy.reader(feature) for feature in features],
    )
    widths = [feature_process.bead_width for feature_process in toolpath.Proxy.processes(toolpath)]
    cell = None if toolpath.Cell is None else toolpath.Cell.Proxy.value(toolpath.Cell)

    def survey() -> Surveyed:
        toolpath_now = planned()
        balance = deposit_balance.sum_balances(
            [
                deposit_balance.toolpath_balance(shape(), feature_part, width)
                for shape, width, (feature_part, _) in zip(
                    shapes, widths, toolpath_now.parts, strict=True
                )
            ]
        )
        nozzle_check = _nozzle_looked(
            toolpath_now, cell, [build.clearance != "none" for build in builds]
        )
        if run is None:
            return Surveyed(tuple(spacing.between_layers(toolpath_now)), balance, nozzle_check)
        return _survey_motion(Surveyed((), balance, nozzle_check), process, *run.what, run.how(()))

    return survey


def _nozzle_looked(
    toolpath: Toolpath, cell: CellParameters | None, clearance_asked: list[bool]
) -> Looked | None:
    """Check the nozzle for contacts on features that require clearance."""
    bodies = (*toolpath.surroundings, *platforms(cell, toolpath)) if any(clearance_asked) else ()
    nozzle = NozzleParameters() if cell is None else cell.nozzle
    return nozzle_check.join_checks(
        [
            nozzle_check.check_nozzle(
                toolpath, bodies, nozzle, NOZZLE_PLACES // len(clearance_asked), number
            )
            for number, clear in enumerate(clearance_asked)
            if clear
        ]
    )


def _survey_motion(
    of_deposit: Surveyed,
    process: ProcessParameters,
    toolpath: Toolpath,
    planned: Planned,
    cell: Cell,
    shapes: tuple[Mesh | None, ...],
    as_it_runs: AsRun,
) -> Surveyed:
    """Add the survey of the motion to the survey of the deposit.

    Layer distances are replaced by those of the executed motion.
    """
    path = planned.joint_path
    rapids = rapid_contacts.looked_at(
        planned.motion,
        [entry.bead for entry in path.beads],
        cell,
        toolpath.surroundings,
        toolpath.bead_width or process.bead_width,
        toolpath.layer_height,
        RAPID_PLACES,
    )
    arm = arm_of(
        as_it_runs.motion, cell, toolpath, process, shapes, ARM_PLACES, cell.arm_clearance or 0.0
    )
    return replace(
        of_deposit,
        distances=tuple(spacing.between_layers(path.toolpath(toolpath))),
        rapids=rapids,
        arm=arm,
    )


class _Run:
    """Execution of a joint path object, by a program with `settings` if given.

    The document is read in the constructor only.
    """

    def __init__(self, path: Any, settings: ProgramParameters | None) -> None:
        self._toolpath, self._planned = (
            path.Toolpath.Proxy.reader(path.Toolpath),
            path.Proxy.reader(path),
        )
        self._looks, self._folders = (
            path.Cell.Proxy.value(path.Cell),
            tuple(user_machines.folders()),
        )
        self.settings = None if settings is None or settings.post == "none" else settings

    @functools.cached_property
    def what(self) -> What:
        """Return the toolpath, the planned joint path, its cell, and the machine's link shapes."""
        toolpath = self._toolpath()
        cell = resolved(self._looks, toolpath, self._folders)
        return toolpath, self._planned(), cell, meshes_of(cell.machine)

    def how(self, issues: tuple[Issue, ...]) -> AsRun:
        """Return the executed motion, with issues located at its points."""
        toolpath, planned, cell, _ = self.what
        return as_run(planned, cell, toolpath.chord_error, self.settings, issues)


def _add_motion_evidence(
    evidence: Evidence, run: _Run, as_it_runs: AsRun, verification: Verification | None
) -> Evidence:
    """Add evidence on a joint path or its program.

    evidence: evidence on the toolpath, with the survey. verification: None without a read-back.
    """
    toolpath, planned, cell, shapes = run.what
    return replace(
        evidence,
        toolpath=planned.joint_path.toolpath(toolpath),
        issues=as_it_runs.issues,
        cell=cell,
        motion=as_it_runs.motion,
        condition=as_it_runs.condition,
        threshold=as_it_runs.threshold,
        true_shapes=bool(shapes) and None not in shapes,
        read=None if verification is None else _read_back(verification, toolpath.chord_error),
        on_controller=()
        if run.settings is None
        else catalogue.load(run.settings.post).ON_CONTROLLER,
    )


def _read_back(verification: Verification, chord_error: float) -> ReadBack:
    return ReadBack(
        not has_errors(verification.issues),
        verification.at_points_mm,
        verification.between_mm,
        verification.bound_mm,
        chord_error + verification.bound_mm if math.isfinite(verification.bound_mm) else math.inf,
        len(verification.solvers),
    )
