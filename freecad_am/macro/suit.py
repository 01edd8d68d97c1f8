# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adapt the cell of a new job until the job is feasible."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import FreeCAD as App

from ..core.families.registry import find_family
from ..core.issues import ERROR, InfeasibleError, InputError
from ..core.kinematics import cell as cells
from ..core.kinematics.arrangement import arrangement_of
from ..core.kinematics.proposed_cell import proposed
from ..core.parameters.cell import CellParameters
from ..core.parameters.filled import SolidParameters
from ..core.strategies.support import ABOVE_PLATFORM, OVER_PLATFORM, surely_above
from ..objects import user_machines
from ..objects.checks.collisions import in_platform
from ..objects.families.registry import stage_family
from ..objects.fields import properties
from ..objects.fields.rows import rows
from ..objects.planned import suited_cell
from ..objects.results.findings import issues_of
from ..objects.staleness import INFEASIBLE
from .arguments import one_step, renew
from .changes import change

SEARCHES = 3  # maximum number of cell searches for a new job with an infeasible joint path


def suit_path(cell: Any, toolpath: Any, path: Any) -> None:
    """Search for another cell while the joint path is infeasible.

    A search plans some layers only, so each search adds the layers that failed in the previous
    cell.
    """
    failed: set[int] = set()
    for _ in range(SEARCHES):
        failed |= {
            issue.layer
            for issue in issues_of(path)
            if issue.level == ERROR and issue.layer is not None
        }
        changed = suit(cell, toolpath, path, failed_layers=failed)
        if path.Status != INFEASIBLE or not changed:
            return


def suit(cell: Any, *stages: Any, failed_layers: Collection[int] = ()) -> bool:
    """Change the pose, branch or positioner of a cell object so that a toolpath is feasible.

    Recompute `stages`: the toolpath first, then its dependent stages. Return whether the cell has
    changed. The cell stays unchanged if it is feasible or if the search finds no better cell.
    failed_layers: indices of additional layers to check.
    """
    settings = cell.Proxy.value(cell)
    suited = suited_cell.suit_to_toolpath(stages[0], failed_layers)(settings)
    if suited != settings:
        _write(cell, suited, stages)
        different = {
            field.name
            for field in dataclasses.fields(suited)
            if getattr(suited, field.name) != getattr(settings, field.name)
        }
        labels = [
            row.label
            for row in rows(CellParameters)
            if row.path[0] in different and len(row.path) == 1
        ]
        changed = ", ".join(labels)
        App.Console.PrintWarning(
            f"{cell.Label}: {changed}: proposed for this job; enter the values of your cell\n"
        )
    return bool(suited != settings)


def _write(cell: Any, settings: CellParameters, stages: Sequence[Any]) -> None:
    with one_step(cell.Document, f"Edit {cell.Label}"):
        properties.write(cell, settings)
        for stage in (cell, *stages):
            renew(stage)


def proposed_place(cell: Any, values: Mapping[str, Any]) -> None:
    """Set the deposition point and branch of a new job's robot cell, unless `values` sets them.

    The default robot keeps its default deposition point and branch, because macros depend on them.
    """
    settings = cell.Proxy.value(cell)
    keys = ("deposition_point", "touched", "external")
    if settings.machine == CellParameters().machine or any(values.get(key) for key in keys):
        return
    suited = proposed(settings, user_machines.folders(), own_branch="branch" in values)
    if suited != settings:
        _write(cell, suited, ())


def is_held_apart(cell: Any, toolpath: Any) -> bool:
    """Whether the substrate and the fixtures of a toolpath stay out of the cell's platform."""
    result, folders = toolpath.Proxy.value(toolpath), tuple(user_machines.folders())
    settings = cell.Proxy.value(cell)
    if not arrangement_of(settings.setup).planned:
        return True
    return not in_platform(cells.resolve(settings, result.frame, result.family, folders), result)


def fit_platform(cell: Any, toolpath: Any) -> None:
    """Give a cell object a platform that supports the whole first layer of a toolpath.

    With `mount` "auto", the platform may be centred on the part. Nothing changes if the first layer
    is on the platform already, or if the toolpath cannot be planned with the new platform.
    """
    if not any(issue.code == OVER_PLATFORM for issue in issues_of(toolpath)):
        return
    settings = cell.Proxy.value(cell)
    fitted = suited_cell.fitted(toolpath.Proxy.value(toolpath), settings)
    planned, key = toolpath.Status != INFEASIBLE, toolpath.Key
    try:
        _write(cell, fitted, [toolpath])
    except (InputError, InfeasibleError):
        planned, key = True, ""
    if planned and (toolpath.Status == INFEASIBLE or not key):
        _write(cell, settings, [toolpath])


def on_platform(
    cell: Any, features: Sequence[Any], make: Callable[[], Any], sized: bool = False
) -> Any:
    """Make the toolpath object of features, and put the part on the platform where `mount` can.

    The part moves if it reaches below the platform or begins above it, unsupported. Where this is
    certain in advance, `mount` changes before planning, because layers may take minutes. sized:
    whether to fit the platform to the first layer.
    """
    toolpath = _mounted(cell, features, make)
    if sized:
        fit_platform(cell, toolpath)
    return toolpath


def _mounted(cell: Any, features: Sequence[Any], make: Callable[[], Any]) -> Any:
    """Make the toolpath object; change `mount` if this puts the part on the platform."""
    if _is_above(cell, features):
        change(cell, mount="feature")
    try:
        toolpath = make()
        if any(issue.code == ABOVE_PLATFORM for issue in issues_of(toolpath)):
            change(cell, mount="feature")
    except InputError as error:
        if error.code != "OFF_PLATFORM" or not error.mended_by:
            raise
        change(cell, **error.mended_by)
        toolpath = make()
    return toolpath


def _is_above(cell: Any, features: Sequence[Any]) -> bool:
    """Whether the check will certainly report that the feature begins above the platform."""
    settings, proxy = cell.Proxy.value(cell), features[0].Proxy
    family = stage_family(proxy)
    if (
        len(features) > 1
        or family is None
        or not family.stacks_layers
        or settings.platform_diameter <= 0.0
    ):
        return False
    height = proxy.parameters(features[0], family.parameters).layer_height
    return settings.mount != "feature" and surely_above(proxy.value(features[0]), height)


def refuse_otherwise(kind: str, layers: str) -> None:
    """Raise InputError if features of this kind cannot have these layers; '' passes."""
    family = find_family(kind)
    if layers and (family is None or not family.chooses_layers):
        raise InputError(
            "BAD_VALUE",
            "layers_otherwise",
            "the parameter is for kind: solid, not for {}; remove the parameter",
            kind,
        )
    if layers:
        SolidParameters(layers=layers)


def in_vain(stages: Sequence[Any], otherwise: str) -> bool:
    """Whether to rebuild an infeasible job with the layer kind `otherwise` ('' for none).

    stages: a cell, a feature and the dependent stages. If so, print a warning and remove the
    job's objects.
    """
    failed = next((stage for stage in stages if stage.Status == INFEASIBLE), None)
    feature = stages[1]
    if failed is None or not otherwise or feature.Layers == otherwise:
        return False
    code = next((issue.code for issue in issues_of(failed) if issue.level == ERROR), "")
    App.Console.PrintWarning(
        f"{feature.Label}: layers: {otherwise}, because {feature.Layers} layers end with {code}\n"
    )
    for stage in reversed(stages):
        stage.Document.removeObject(stage.Name)
    return True
