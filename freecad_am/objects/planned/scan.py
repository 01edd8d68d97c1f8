# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit a toolpath to a scan of the surface below, taken from an inspection."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.inspection import fit_layers, scan_heights
from ...core.inspection.inspect import Inspected
from ...core.inspection.scan_heights import Scan
from ...core.issues import InputError
from ...core.parameters.inspection import NONE, InspectionParameters
from ...core.parameters.scan import ScanParameters
from ...core.toolpath import Toolpath
from ..shapes.bodies import snapshot_of
from ..stage import stage_of

UNDERSTANDING = (
    "POINTS_READ",
    "FREE_MOTION",
)  # codes of inspection issues on the interpretation of the scan
Fit = Callable[[Toolpath], Toolpath]


def fit_of(obj: Any, parameters: ScanParameters) -> Fit | None:
    """Return a function that fits the toolpath of a toolpath object to its scan.

    The function does not use the document. None without a scan. Raises InputError BAD_INPUT, and
    the errors of the inspection.
    """
    scan = obj.Scan
    if scan is None:
        return None
    where = f"{obj.Label}.Scan"
    if stage_of(scan.Planned) is not None:
        raise InputError(
            "BAD_INPUT",
            where,
            "{} compares with {}; choose an inspection of the deposited part",
            scan.Label,
            scan.Planned.Label,
        )
    how = scan.Proxy.parameters(scan, InspectionParameters).fit
    if parameters.after_layer is not None and how != NONE:
        raise InputError(
            "BAD_VALUE",
            f"{scan.Label}.Fit",
            "{}: only a scan in part coordinates shows how far the part has grown; use none",
            how,
        )
    inspected = scan.Proxy.value(scan)
    ground = getattr(obj.Feature, "Substrate", None)
    substrate = (
        None if ground is None or parameters.after_layer is not None else snapshot_of(ground)
    )

    def fit(toolpath: Toolpath) -> Toolpath:
        fit_layers.refuse_family(toolpath, where)
        body = None if substrate is None else substrate.body()
        if body is not None:
            scan_heights.refuse_other(
                inspected.points, inspected.file, body, parameters.scan_within
            )
        return fitted(toolpath, inspected, body, parameters)

    return fit


def fitted(
    toolpath: Toolpath, inspected: Inspected, body: Any, parameters: ScanParameters
) -> Toolpath:
    """Fit the toolpath to the scanned surface and keep the nozzle clear of the scan.

    The scan replaces `body`. Raises InputError.
    """
    first_layer = toolpath.layers[min(parameters.first, len(toolpath.layers) - 1)]
    directions = np.concatenate([fit_layers.ways_of(toolpath)(bead) for bead in first_layer.beads])
    points = inspected.points
    if body is not None:
        points = points[scan_heights.facing(points, body, directions)]
    scan = Scan(points, inspected.file, parameters.scan_within)
    fitted_toolpath = fit_layers.fit_layers(
        toolpath, scan, parameters, len(inspected.points) - len(points), inspected.motion
    )
    notes = [issue for issue in inspected.issues if issue.code in UNDERSTANDING]
    fitted_toolpath = dataclasses.replace(fitted_toolpath, issues=(*notes, *fitted_toolpath.issues))
    if body is None:
        return fitted_toolpath
    around = tuple(
        scan_heights.scanned(surrounding, scan, directions)
        if surrounding.name == body.name
        else surrounding
        for surrounding in fitted_toolpath.surroundings
    )
    return dataclasses.replace(fitted_toolpath, surroundings=around)
