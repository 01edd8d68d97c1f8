# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell of a new job changed so that the job can be done in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App

from ..core.issues import ERROR, InputError
from ..core.parameters.filled import SolidParameters
from ..core.strategies.support import ABOVE_PLATFORM, surely_above
from ..objects.fields import properties
from ..objects.planned import suited_cell
from ..objects.results.findings import issues_of
from ..objects.staleness import INFEASIBLE
from .changes import change
from .steps import one_step, renew


def suit(cell: Any, *stages: Any) -> None:
    """Give a cell object the place, branch or positioner in which the job of a toolpath can be done, and renew the toolpath,
    first of the stages, and what follows; all is as it was where that serves, or nothing was found that does."""
    settings = cell.Proxy.value(cell)
    found = suited_cell.of_toolpath(stages[0])(settings)
    if found != settings:
        with one_step(cell.Document, f"Edit {cell.Label}"):
            properties.write(cell, found)
            for stage in (cell, *stages):
                renew(stage)


def on_platform(cell: Any, features: Sequence[Any], make: Callable[[], Any]) -> Any:
    """The toolpath object that is made of features; what reaches below the platform, or begins above it, over nothing, is
    put on it where `mount` does so: before, where that is known beforehand, as layers may take minutes."""
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
    """Whether a feature will surely be told to begin above the platform."""
    settings, proxy = cell.Proxy.value(cell), features[0].Proxy
    solid = any(section.cls is SolidParameters for section in proxy.sections)
    if len(features) > 1 or not solid or settings.platform_diameter <= 0.0:
        return False
    height = proxy.parameters(features[0], SolidParameters).layer_height
    return settings.mount != "feature" and surely_above(proxy.value(features[0]), height)


def refuse_otherwise(kind: str, layers: str) -> None:
    """InputError where a feature of this kind has no layers to choose, or these, '' for none, are none of them."""
    if layers and kind != "solid":
        raise InputError(
            "BAD_VALUE", "layers_otherwise", "it is for kind: solid, not for {}; leave it out", kind
        )
    if layers:
        SolidParameters(layers=layers)


def in_vain(stages: Sequence[Any], otherwise: str) -> bool:
    """Whether the job of stages, a cell, a feature and what follows, is to be made anew with other layers, '' for none: it
    cannot be carried out, which is told, and its objects go."""
    failed = next((stage for stage in stages if stage.Status == INFEASIBLE), None)
    feature = stages[1]
    if failed is None or not otherwise or feature.Layers == otherwise:
        return False
    code = next((issue.code for issue in issues_of(failed) if issue.level == ERROR), "")
    App.Console.PrintWarning(
        f"{feature.Label}: layers: {otherwise}, for {feature.Layers} ones end with {code}\n"
    )
    for stage in reversed(stages):
        stage.Document.removeObject(stage.Name)
    return True
