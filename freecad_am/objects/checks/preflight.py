# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preflight of a document's stages: what is promised of them, read from their results."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from freecad_am.core.types import Array

from ...core.issues import Issue, has_errors
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.preflight.checks import Evidence, promises
from ...core.preflight.promise import Promise
from ...core.preflight.written import ReadBack
from ...core.process.deposit import balance as deposit_balance
from ...core.simulation import rapid_look
from ...core.strategies.clearance import look as clearance_look
from ...posts import catalogue
from ...verify import Verification
from .. import user_machines
from ..joint_path import Planned
from ..results.as_run import as_run
from ..results.findings import issues_of
from ..shapes.cell_obstacles import resolved
from ..shapes.link_meshes import meshes_of
from ..shapes.platforms import platforms
from ..toolpath import features_of
from .links_clear import arm_of

# at which the arm is looked at, and the nozzle depositing and on rapids: together a tenth of the time that planning takes,
# at most
ARM_PLACES, NOZZLE_PLACES, RAPID_PLACES = 6_000, 4_000, 12_000

Work = Callable[[], tuple[Promise, ...]]


def of_stages(
    toolpath: Any, path: Any = None, program: Any = None, distances: tuple[Array, ...] | None = None
) -> tuple[Promise, ...]:
    """The preflight of a toolpath, its joint path and its program (document objects, None where there is none). distances:
    between the layers as they are run, where they are known. Raises InputError 'NO_RESULT' where one has no result."""
    if program is None:
        return prepared(toolpath, path, distances=distances)()
    settings = program.Proxy.parameters(program, ProgramParameters)
    return prepared(toolpath, path, settings, read_back_of(program), tuple(issues_of(program)), distances)()


def read_back_of(program: Any) -> Verification | None:
    """How a program object was read back, None where it was not."""
    found: Verification | None = program.Proxy.value(program).verification if program.Key else None
    return found


def prepared(
    toolpath: Any, path: Any = None, settings: ProgramParameters | None = None, read: Verification | None = None,
    more: tuple[Issue, ...] = (), distances: tuple[Array, ...] | None = None,
) -> Work:
    """What makes the preflight of a toolpath and of its joint path (document objects), without the document, from which all
    is read now. settings: of the program that is written of it; read: how that was read back; more: its findings. Raises
    InputError 'NO_RESULT' where one has no result."""
    features = features_of(toolpath)
    builds = [feature.Proxy.parameters(feature, BuildDirectionParameters) for feature in features]
    stages = [stage for stage in (*features, toolpath, path) if stage is not None]
    issues = tuple(dict.fromkeys([issue for stage in stages for issue in issues_of(stage)] + list(more)))
    planned, shapes = toolpath.Proxy.reader(toolpath), [feature.Proxy.reader(feature) for feature in features]
    widths = [one.bead_width for one in toolpath.Proxy.processes(toolpath)]
    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)

    looks = None if toolpath.Cell is None else toolpath.Cell.Proxy.value(toolpath.Cell)
    nozzle = NozzleParameters() if looks is None else looks.nozzle

    def known() -> Evidence:
        made = planned()
        return Evidence(
            made, process, issues, distances=distances,
            balance=deposit_balance.together([
                deposit_balance.of_toolpath(shape(), part, width)
                for shape, width, (part, _) in zip(shapes, widths, made.parts, strict=True)
            ]),
            looked=clearance_look.together([
                clearance_look.looked_at(
                    made, (*made.surroundings, *platforms(looks, made)), nozzle, NOZZLE_PLACES // len(builds), number
                )
                for number, build in enumerate(builds) if build.clearance != "none"
            ]),
        )

    if path is None:
        return lambda: promises(known())
    joints, cell = path.Proxy.reader(path), path.Cell.Proxy.value(path.Cell)
    folders = tuple(user_machines.folders())
    return lambda: of_motion(known(), joints(), cell, folders, settings, read)


def of_motion(
    known: Evidence, planned: Planned, looks: CellParameters, folders: tuple[str, ...], settings: ProgramParameters | None,
    read: Verification | None,
) -> tuple[Promise, ...]:
    """The preflight of a joint path, or of the program that is written of it with `settings`; known: of its toolpath. read:
    None where that was not read back."""
    toolpath = known.toolpath
    cell = resolved(looks, toolpath, folders)
    settings = None if settings is None or settings.post == "none" else settings
    shapes = meshes_of(cell.machine)
    run = as_run(planned, cell, toolpath.chord_error, settings, known.issues)
    return promises(replace(
        known, toolpath=planned.joint_path.toolpath(toolpath), issues=run.issues, cell=cell, motion=run.motion,
        rapids=rapid_look.looked_at(
            planned.motion, [one.bead for one in planned.joint_path.beads], cell, toolpath.surroundings,
            toolpath.bead_width or known.process.bead_width, toolpath.layer_height, RAPID_PLACES,
        ), condition=run.condition, threshold=run.threshold,
        arm=arm_of(run.motion, cell, toolpath, known.process, shapes, ARM_PLACES, cell.arm_clearance or 0.0),
        true_shapes=bool(shapes) and None not in shapes,
        read=None if read is None else _read_back(read, toolpath.chord_error),
        on_controller=() if settings is None else catalogue.load(settings.post).ON_CONTROLLER,
    ))


def _read_back(read: Verification, chord_error: float) -> ReadBack:
    return ReadBack(
        not has_errors(read.issues), read.at_points_mm, read.between_mm, read.bound_mm,
        chord_error + read.bound_mm if math.isfinite(read.bound_mm) else math.inf, len(read.solvers),
    )
