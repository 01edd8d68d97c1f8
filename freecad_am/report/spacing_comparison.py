# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare the layer spacing methods of a wall for the report, with robot motion on request."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..core.issues import AmError
from ..core.kinematics import cell as cells
from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from ..core.parameters.joints import JointParameters
from ..core.parameters.strategy import FRONTS, ISO
from ..core.planning import criteria
from ..core.planning.joint_path import JointPath
from ..core.planning.motion import assemble
from ..core.planning.plan import plan_joints
from ..core.process.deposit.spacing import SMOOTH
from ..core.strategies.walls import comparison as wall_comparison
from ..core.strategies.walls.comparison import METHODS, NORMAL, Compared, Refused
from ..core.toolpath import Toolpath
from ..core.types import Array
from ..objects import user_machines
from ..objects.families.given import Given
from ..objects.planned.toolpaths import planned
from . import figures as of_report
from .figures import Job

_MOTION = (
    "condition_min",
    "range_per_layer_max_deg",
    "speed_max_deg_s",
    "acceleration_max_deg_s2",
    "jerk_max_deg_s3",
    "speed_ratio_max",
)
_LINES = "the wall has several surfaces, or no closed parameter for layers along its lines"
_FRONTS = "fronts do not follow surface lines; remove strategy.method to compare with iso-parameter layers"
_NOT_PLANNED = "not planned; set strategy.spacing to compare"
_REASONS = {  # why a method does not apply to open, trimmed or multi-face walls
    "iso-parameter": _LINES,
    NORMAL: "the wall is not a closed tube of a single surface, so its sections have no centreline",
    "constant-distance": _NOT_PLANNED,
    "smooth": _NOT_PLANNED,
}


def compare(wall: Any, strategy: Any) -> tuple[Compared | Refused, ...]:
    """Slice a wall by every method; refuse all methods for a wall that is not closed around."""
    if wall.closes_around:
        return wall_comparison.compare(wall, strategy)
    reasons = _REASONS if strategy.method != FRONTS else _REASONS | {ISO: _FRONTS, NORMAL: _FRONTS}
    return tuple(
        Refused(method, reasons[method]) for method in METHODS if method != strategy.spacing
    )


def rows(
    compared: Sequence[Compared | Refused],
    strategy: Any,
    toolpath: Toolpath,
    distances: Sequence[Array],
) -> list[dict[str, Any]]:
    """Return the rows of report.json without motion, the planned method first."""
    if not compared:
        return []
    by_method = {result.method: _row(result) for result in compared}
    planned = strategy.spacing
    if planned not in by_method:  # a wall that was sliced only by the planned method
        spread = of_report.summarize(distances)
        by_method[planned] = _empty(planned) | {
            "layers": len(toolpath.layers),
            "min_mm": spread["min"],
            "mean_mm": spread["mean"],
            "max_mm": spread["max"],
            "length_mm": toolpath.length,
            **_corners(toolpath),
        }
    return [
        row | {"planned": method == planned}
        for method, row in sorted(by_method.items(), key=lambda item: item[0] != planned)
    ]


def _corners(toolpath: Toolpath) -> dict[str, Any]:
    """Return the number of layers with corners and the sharpest corner, from bead tangents.

    Empty without tangents.
    """
    sharpest: dict[int, float] = {}
    for layer, _, bead in toolpath:
        if bead.tangents is None:
            return {}
        turn = np.arccos(
            np.clip((bead.tangents[:, 0] * bead.tangents[:, 1]).sum(axis=1), -1.0, 1.0)
        )
        inner = turn if bead.closed else turn[1:-1]
        sharpest[layer] = max(sharpest.get(layer, 0.0), float(inner.max(initial=0.0)))
    cornered = sum(
        turn > SMOOTH for layer, turn in sharpest.items() if layer
    )  # the first layer follows the substrate
    largest = max((turn for layer, turn in sharpest.items() if layer), default=0.0)
    return {
        "cornered_layers": int(cornered),
        "corner_max_deg": float(np.degrees(largest)) if largest > SMOOTH else 0.0,
    }


def motion_of(
    path: JointPath, motion: Motion, cell: Cell, joints: JointParameters
) -> dict[str, Any]:
    """Return statistics of the robot motion while depositing.

    axis_limited_s: deposit time if every step takes as long as its slowest axis needs, s.
    """
    figures = criteria.path_figures(path, cell, joints)
    deposit = motion.deposit & (motion.point > 0)
    share = np.nanmax(of_report.speed_ratio(motion, cell)[deposit], axis=1, initial=0.0)
    time = motion.duration[deposit]
    return {
        "feasible": path.feasible,
        "duration_s": motion.total_time,
        "deposit_s": float(time.sum()),
        "axis_limited_s": float((time * np.maximum(share, 1.0)).sum()),
        **{key: figures[key] for key in _MOTION},
    }


def motions(job: Job, tell: Callable[[str], None]) -> dict[str, dict[str, Any] | str]:
    """Plan the motion of each further spacing in `strategy.compare`, for a job with one wall.

    Return motion statistics, or the error message, by spacing.
    """
    results: dict[str, dict[str, Any] | str] = {}
    for spacing in dict.fromkeys(job.features[0].strategy.compare):
        if spacing == job.features[0].strategy.spacing:
            continue
        tell(f"spacing comparison: {spacing} ...")
        try:
            results[spacing] = _planned(job, spacing)
        except AmError as error:
            results[spacing] = error.message
    return results


def _planned(job: Job, spacing: str) -> dict[str, Any]:
    wall, looks = job.features[0], job.cell
    assert looks is not None
    strategy = replace(wall.strategy, spacing=spacing, compare=())
    toolpath = planned(Given(wall.shape(), strategy, wall.build_direction, job.process, looks))
    cell = cells.resolve(looks, toolpath.frame, toolpath.family, user_machines.folders())
    path = plan_joints(toolpath, cell, replace(job.joints, compare=()))
    motion, _ = assemble(
        path, cell, job.process, toolpath.surroundings, job.joints, toolpath.layer_height
    )
    return motion_of(path, motion, cell, job.joints)


def _row(wall: Compared | Refused) -> dict[str, Any]:
    if isinstance(wall, Refused):
        return _empty(wall.method) | {"reason": wall.reason}
    return _empty(wall.method) | {
        "layers": wall.layers,
        "min_mm": wall.smallest,
        "mean_mm": wall.mean,
        "max_mm": wall.largest,
        "length_mm": wall.length,
        "turn_max_deg_mm": float(np.degrees(wall.turn)),
        "cornered_layers": wall.corners,
        "corner_max_deg": float(np.degrees(wall.corner)),
    }


def _empty(method: str) -> dict[str, Any]:
    keys = (
        "layers",
        "min_mm",
        "mean_mm",
        "max_mm",
        "length_mm",
        "turn_max_deg_mm",
        "cornered_layers",
        "corner_max_deg",
        "reason",
        "motion",
    )
    return {"method": method, **dict.fromkeys(keys)}
