# SPDX-License-Identifier: LGPL-2.1-or-later
"""Predicted deposit of a toolpath compared with the part to be machined from the deposit."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...brep.shapes.tessellate import triangles_of
from ...core.geometry.toolpath_records import PredictedShape
from ...core.inspection import figures
from ...core.inspection.inspect import PREDICTED, Inspected
from ...core.issues import WARNING, InputError, Issue, Text
from ...core.parameters.process import ProcessParameters
from ...core.process.deposit.spacing import is_spiral, turns_of
from ...core.process.shape import compare
from ...core.process.shape.compare import (
    BOTH,
    OUTSIDE,
    Compared,
    Faces,
    deviation_map,
    faces,
    join_faces,
    thin_faces,
    uncovered_faces,
)
from ...core.process.shape.laying import PredictedDeposit, feature_parts, predicted_deposit
from ...core.toolpath import Toolpath as CoreToolpath
from ..families.given import Given
from ..families.planner import FeaturePlanner
from ..families.registry import planner_for
from ..shapes.bodies import Taken
from ..work import progress

DEFLECTION = 0.05  # mm; deflection of the face triangles
NOTHING = "NO_PREDICTION"

Report = Callable[[float, str], None]


@dataclass(frozen=True)
class Target:
    """Target of a feature: planning inputs, source objects, and selected faces.

    faces: face names of the first source; empty for the whole object.
    """

    inputs: Given
    sources: tuple[Taken, ...]
    faces: tuple[str, ...] = ()

    @property
    def planner(self) -> FeaturePlanner:
        """Return the planner of the feature's family."""
        return planner_for(self.inputs.strategy)


def add_shape_issues(
    toolpath: CoreToolpath, targets: Sequence[Target], allowance: float
) -> CoreToolpath:
    """Add the predicted deposit to a toolpath, with warnings.

    Warn if the deposit does not enclose the part by the allowance, mm, or if no prediction is
    possible.
    """
    try:
        deposit, comparison = predicted(toolpath, targets, progress.report)
    except InputError as error:
        return dataclasses.replace(
            toolpath, issues=(*toolpath.issues, Issue(WARNING, NOTHING, error.message))
        )
    shape = dataclasses.replace(
        compare.figures(deposit, comparison, allowance),
        deviation=deviation_map(deposit, comparison, len(toolpath.layers)),
    )
    return dataclasses.replace(
        toolpath.add_checks(predicted=shape),
        issues=(*toolpath.issues, *issues(toolpath, targets, shape)),
    )


def issues(
    toolpath: CoreToolpath, targets: Sequence[Target], shape: PredictedShape
) -> tuple[Issue, ...]:
    """Return the issues of a predicted deposit."""
    is_first_layer = np.zeros(len(toolpath.layers), dtype=bool)
    for _, numbers in toolpath.parts:
        is_first_layer[numbers[:1]] = True
    is_first_layer |= [layer.first for layer in toolpath.layers]
    courses = np.ones(len(toolpath.layers))
    for feature_toolpath, numbers in toolpath.parts:
        if is_spiral(feature_toolpath):
            courses[numbers[0]] = turns_of(feature_toolpath.layers[0].beads[0])[-1] + 1
    return compare.issues(shape, toolpath.layer_heights, is_first_layer, remedy(targets), courses)


def predicted(
    toolpath: CoreToolpath, targets: Sequence[Target], report: Report
) -> tuple[PredictedDeposit, Compared]:
    """Predict the deposit of a toolpath and compare the feature faces with the deposit.

    Raises InputError NO_PREDICTION.
    """
    processes: list[ProcessParameters] = [target.inputs.process for target in targets]
    parts = feature_parts(toolpath, processes)
    if any(feature_part.toolpath.bead_width is None for feature_part in parts):
        raise InputError(
            NOTHING, "toolpath", "the effective bead width is unknown; plan the toolpath again"
        )
    target_faces = [_faces(target) for target in targets if target.planner.has_faces]
    if not target_faces:
        raise InputError(
            NOTHING,
            "toolpath",
            "curves have no faces to compare a deposit with; remove process.machining_allowance",
        )
    deposit = predicted_deposit(
        parts, lambda share, text: report(0.8 * share, Text("predicting the deposit, {}", text))
    )
    report(0.8, "comparing the predicted deposit with the part")
    comparison = compare.compare_deposit(deposit, uncovered_faces(target_faces))
    if not len(comparison.faces):
        raise InputError(
            NOTHING,
            "toolpath",
            "the part has no faces above the start of the deposit; choose another part",
        )
    return deposit, comparison


def inspected(
    toolpath: CoreToolpath,
    targets: Sequence[Target],
    allowance: float,
    tolerance: float,
    label: str,
    report: Report,
) -> Inspected:
    """Return the predicted deposit of a toolpath as if measured at points on the part's faces.

    Points are on the deposit surface outside the part, or on the part where the part protrudes.
    Raises InputError NO_PREDICTION.
    """
    deposit, comparison = predicted(toolpath, targets, report)
    shape = compare.figures(deposit, comparison, allowance)
    count, cells = len(comparison.deviation), deposit.pieces
    all_points = np.ones(count, dtype=np.bool_)
    outside = np.maximum(comparison.deviation, 0.0)[:, None] * comparison.faces.normals
    return Inspected(
        comparison.faces.points + outside,
        comparison.deviation,
        all_points,
        all_points,
        np.eye(4),
        (),
        tolerance,
        PREDICTED,
        label,
        figures.summarise(comparison.deviation, tolerance),
        None,
        (),
        None,
        issues(toolpath, targets, shape),
        laid=np.column_stack([cells.middle, cells.layer, deposit.level]),
    )


def remedy(targets: Sequence[Target]) -> str:
    """Return the remedy for a deposit that is too small, with {} for the shortfall."""
    return targets[0].planner.allowance_remedy


def _faces(target: Target) -> Faces:
    """Return the faces that the deposit of a feature must cover. Raises InputError NO_FACES."""
    bodies = target.planner.bodies_to_cover(target.inputs.wall)
    if bodies is not None:
        return thin_faces(join_faces([faces(body.vertices, body.triangles) for body in bodies]))
    names = target.planner.faces_to_cover(target.inputs.wall, target.faces)
    return thin_faces(
        join_faces(
            [
                _source_faces(source, names if k == 0 else ())
                for k, source in enumerate(target.sources)
            ]
        )
    )


def _source_faces(source: Taken, names: Sequence[str]) -> Faces:
    if source.shape is None:
        body = source.body()
        return faces(body.vertices, body.triangles, OUTSIDE if _closed(body.triangles) else BOTH)
    shape = source.shape.copy(False)
    faces_by_name = {f"Face{number}": face for number, face in enumerate(shape.Faces, start=1)}
    selected: list[Any] = [
        faces_by_name[name] for name in dict.fromkeys(names) if name in faces_by_name
    ]
    if not selected and not faces_by_name:
        raise InputError(
            NOTHING,
            "toolpath",
            "{} has no faces to compare a deposit with; choose another object",
            source.label,
        )
    side = OUTSIDE if shape.Solids else BOTH
    return join_faces(
        [
            faces(*triangles_of(face, DEFLECTION), side)
            for face in selected or faces_by_name.values()
        ]
    )


def _closed(triangles: Any) -> bool:
    """Whether triangles (m, 3) form a closed mesh: every edge has an opposite edge."""
    edges = np.concatenate(
        [triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]
    ).astype(np.int64)
    size = int(edges.max(initial=0)) + 1
    return bool(np.array_equal(np.sort(edges @ [size, 1]), np.sort(edges @ [1, size])))
