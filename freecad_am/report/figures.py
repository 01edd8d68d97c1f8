# SPDX-License-Identifier: LGPL-2.1-or-later
"""report.json: statistics of the planned job and its quality."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..core.families.registry import family_of
from ..core.issues import Issue, has_errors
from ..core.kinematics.cell import Cell
from ..core.kinematics.inverse import spherical_wrist
from ..core.motion import Motion
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.cell import CellParameters
from ..core.parameters.joints import OPTIMISED, JointParameters
from ..core.parameters.process import ProcessParameters
from ..core.parameters.strategy import LayerParameters
from ..core.planning import criteria
from ..core.planning.external import level, optimised
from ..core.planning.joint_path import JointPath
from ..core.planning.task import Task
from ..core.process import model_notes
from ..core.process.deposit import balance as deposit_balance
from ..core.process.deposit import spacing as layer_spacing
from ..core.process.deposit import void_and_double
from ..core.process.deposit.balance import Balance
from ..core.simulation import timeline as totals
from ..core.simulation.timeline import timeline
from ..core.toolpath import Toolpath
from ..core.types import Array

if TYPE_CHECKING:  # slow to import and not needed for jobs without a cell
    from freecad_am.core.preflight.promise import Promise
    from freecad_am.core.strategies.walls.comparison import Compared, Refused
    from freecad_am.objects.joint_path import Planned


class OfFeature(NamedTuple):
    """Data of a feature.

    name: empty if the job has one feature. spacing: distances (points,) from each layer to the
    surface below, mm. band: tolerance of the distances as a fraction of the layer height. compared,
    rows: spacing comparison of a wall.
    """

    name: str
    toolpath: Toolpath
    spacing: Sequence[Array]
    band: float | None = None
    compared: Sequence[Compared | Refused] = ()
    rows: Sequence[dict[str, Any]] = ()


@dataclass(frozen=True)
class Feature:
    """A feature of the job and its parameters.

    shape: function that returns the feature stage result.
    """

    name: str
    strategy: LayerParameters
    build_direction: BuildDirectionParameters
    process: ProcessParameters
    shape: Callable[[], Any]


@dataclass(frozen=True)
class Job:
    """A job.

    process: job process, which features may override. cell: None for toolpath-only jobs.
    """

    name: str
    features: tuple[Feature, ...]
    process: ProcessParameters
    joints: JointParameters
    cell: CellParameters | None


@dataclass(frozen=True)
class Results:
    """Results of a job.

    toolpath: as sliced. planned: None without a joint path. seconds: planning time of the joint
    path. issues: issues of all stages. programs: file names. distances: function that returns
    layer distances in motion order. preflight: function that returns the preflight promises.
    """

    toolpath: Toolpath
    planned: Planned | None
    seconds: float
    issues: Sequence[Issue]
    programs: Sequence[str]
    distances: Callable[[], Sequence[Array]]
    preflight: Callable[[], tuple[Promise, ...]]


VERSION = 1


def build(
    name: str,
    toolpath: Toolpath,
    motion: Motion,
    process: ProcessParameters,
    issues: Sequence[Issue],
) -> dict[str, Any]:
    """Return the report of a toolpath, which `add_joints` and `make_report` complete.

    Lengths are in mm, times in s. Missing values are None.
    """
    times = timeline(motion, process, [layer.wait for layer in toolpath.layers])
    sums = totals.totals(motion, times, process, toolpath)
    return {
        "version": VERSION,
        "name": name,
        "status": "infeasible" if has_errors(list(issues)) else "ok",
        "issues": [issue.as_dict() for issue in issues],
        "counts": {
            "layers": len(toolpath.layers),
            "beads": toolpath.bead_count,
            "points": int(motion.deposit.sum()),
        },
        "length_mm": toolpath.length,
        "chord_error_mm": toolpath.chord_error,
        "duration_s": sums.time,
        "totals": totals.as_dict(sums),
        "spacing_mm": None,
        "layer_heights": []
        if toolpath.checks.uneven is None
        else [
            {"layer": int(layer), "least_mm": float(smallest), "largest_mm": float(largest)}
            for layer, smallest, largest in toolpath.checks.uneven
        ],
        "unsupported_mm": toolpath.checks.unsupported,
        "on_part": None
        if toolpath.checks.on_part is None
        else dict(
            zip(
                ("places", "worst_mm", "allowed_mm"),
                (int(toolpath.checks.on_part[0]), *toolpath.checks.on_part[1:]),
                strict=True,
            )
        ),
        "infill": void_and_double.as_dict(toolpath),
        "scan": _scan(toolpath),
        "predicted_shape": _predicted_shape(toolpath),
        "joints": None,
        "preflight": [],
        "comparison": [],
        "spacing_comparison": [],
        "process": _process(process, toolpath),
        "beads": model_notes.beads(toolpath),
        "classes": totals.figures_by_class(motion, process),
        "machine": None,
        "timing_s": {},
        "programs": [],
    }


def features(
    of_job: Sequence[Feature],
    toolpath: Toolpath,
    motion: Motion,
    balances: Sequence[Balance | None],
    compared: Sequence[list[dict[str, Any]]],
) -> list[dict[str, Any]]:
    """Return the report key `features`: the statistics of each feature.

    compared: spacing comparison rows of each feature.
    """
    entries = []
    for feature, (path, numbers), balance, rows_of_wall in zip(
        of_job, toolpath.parts, balances, compared, strict=True
    ):
        rows = motion.deposit & np.isin(motion.layer, numbers)
        entries.append(
            {
                "name": feature.name,
                "kind": family_of(feature.strategy).kind,
                "layers": [int(number) for number in numbers],
                "counts": {
                    "layers": len(path.layers),
                    "beads": path.bead_count,
                    "points": int(rows.sum()),
                },
                "length_mm": path.length,
                "layer_height_mm": path.layer_height,
                "bead_width_mm": path.bead_width,
                "chord_error_mm": path.chord_error,
                "deposit_s": float(np.nan_to_num(motion.duration)[rows & motion.moves].sum()),
                "spacing_mm": summarize(layer_spacing.between_layers(path)),
                "unsupported_mm": path.checks.unsupported,
                "deposit": deposit_balance.as_dict(balance),
                "spacing_comparison": rows_of_wall,
                "beads": None
                if feature.process.bead_model == "none"
                else model_notes.beads(path, numbers),
            }
        )
    return entries


def add_joints(
    report: dict[str, Any], planned: JointPath, cell: Cell, joints: JointParameters, seconds: float
) -> None:
    """Add the joint path statistics over the deposit.

    seconds: planning time, including the compared methods.
    """
    compared: list[dict[str, Any]] = [dict(entry) for entry in planned.comparison]
    report["joints"] = {
        "method": planned.method,
        "objective": planned.objective,
        "feasible": planned.feasible,
        **criteria.path_figures(planned, cell, joints),
        "planning_time_s": seconds - sum(float(entry["planning_time_s"]) for entry in compared),
        "branch": list(planned.branch),
        "limits": planned.limits,
        "stopped": _reasons(planned),
        **({} if planned.optimality is None else {"optimality": planned.optimality}),
        **({} if cell.external is None else {"external": _external(cell, planned, joints)}),
    }
    report["comparison"] = compared
    report["machine"] = {
        "id": cell.machine.id,
        "title": cell.machine.title,
        "setup": cell.setup,
        "limits": planned.limits,
        "axes": list(cell.machine.columns),
        "labels": list(cell.machine.axes),
        "units": list(cell.machine.units),
        "controller": cell.machine.controller_remark,
    }


def _external(cell: Cell, planned: JointPath, joints: JointParameters) -> dict[str, object]:
    """Return statistics of the external axes.

    If the axes were optimised, include the statistics of the initial rule for comparison.
    """
    axis_figures = level.figures(cell, planned)
    if planned.of_level is None:
        return axis_figures
    task = Task(cell, spherical_wrist.branch_index(planned.branch), joints)
    return {
        **axis_figures,
        "rule": OPTIMISED,
        **optimised.figures(task, planned.beads),
        "level": planned.of_level,
    }


def text(report: dict[str, Any]) -> str:
    """Return the report as JSON; infinite values and NaN become null."""
    return json.dumps(_finite(report), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def speed_ratio(motion: Motion, cell: Cell) -> Array:
    """Return the axis speeds (n, axes) as fractions of the maximum axis speed.

    Row i is for the segment that ends at row i.
    """
    turned = np.abs(np.diff(motion.joints, axis=0, prepend=motion.joints[:1]))
    ratio: Array = (
        turned
        / np.where(motion.duration > 0.0, motion.duration, np.inf)[:, None]
        / cell.machine.max_speed
    )
    return ratio


def summarize(spacing: Sequence[Array]) -> dict[str, float | None]:
    """Return minimum, mean and maximum of the values; None for each without values."""
    if not spacing:
        return {"min": None, "mean": None, "max": None}
    values = np.concatenate(spacing)
    return {"min": float(values.min()), "mean": float(values.mean()), "max": float(values.max())}


def _scan(toolpath: Toolpath) -> dict[str, Any] | None:
    """Return statistics of the scan to which layers were fitted, None without a scan."""
    if toolpath.checks.fitted is None:
        return None
    from . import scan_figures

    return scan_figures.as_dict(toolpath.checks.fitted)


def _predicted_shape(toolpath: Toolpath) -> dict[str, Any] | None:
    """Return statistics of the predicted deposit, None without a machining allowance."""
    if toolpath.checks.predicted is None:
        return None
    from . import predicted_figures

    return predicted_figures.as_dict(toolpath.checks.predicted)


def _process(process: ProcessParameters, toolpath: Toolpath) -> dict[str, Any]:
    return {
        "travel_speed_mm_s": process.travel_speed,
        "bead_width_mm": process.bead_width,
        "bead_width_counted_mm": toolpath.bead_width,
        "wire": {
            "diameter_mm": process.wire.diameter,
            "feed_mm_s": toolpath.wire_feed,
            "feed_mode": process.wire.feed_mode,
            "feed": "auto" if process.wire.feed == "auto" else "given",
        },
        "density_g_cm3": process.density,
        "material": None
        if process.material.name is None
        else {
            "name": process.material.name,
            "source": process.material.source,
            "slowest_mm_s": process.material.slowest,
            "fastest_mm_s": process.material.fastest,
        },
        "temperature": process.temperature,
        "gas": process.gas,
        "stand_off_mm": process.stand_off,
    }


def _reasons(planned: JointPath) -> dict[str, int]:
    """Return the number of beads per stop reason of the optimiser."""
    reasons = [path.reason for path in planned.beads if path.reason]
    return {reason: reasons.count(reason) for reason in dict.fromkeys(reasons)}


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(entry) for entry in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, np.generic):
        return _finite(value.item())
    return value
