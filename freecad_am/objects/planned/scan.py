# SPDX-License-Identifier: LGPL-2.1-or-later
"""A scan of what a toolpath is deposited on, taken from an inspection of that, and what it makes of the toolpath."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.inspection import fit_layers, scan_checks, scanned_body
from ...core.inspection.inspect import Inspected
from ...core.inspection.scan_heights import Scan
from ...core.issues import InputError
from ...core.parameters.inspection import NONE, InspectionParameters
from ...core.parameters.scan import ScanParameters
from ...core.toolpath import Toolpath
from ..shapes.bodies import taken
from ..stage import stage_of

UNDERSTANDING = (
    "POINTS_READ",
    "FREE_MOTION",
)  # of what an inspection finds: how the scan was understood
Fit = Callable[[Toolpath], Toolpath]


def fit_of(obj: Any, parameters: ScanParameters) -> Fit | None:
    """What fits the toolpath of a toolpath object to its scan, without the document; None where it has no scan.
    InputError BAD_INPUT, and those of the inspection."""
    scan = obj.Scan
    if scan is None:
        return None
    where = f"{obj.Label}.Scan"
    if stage_of(scan.Planned) is not None:
        raise InputError(
            "BAD_INPUT",
            where,
            "{} compares with {}; choose an inspection of the part that is deposited on",
            scan.Label,
            scan.Planned.Label,
        )
    how = scan.Proxy.parameters(scan, InspectionParameters).fit
    if parameters.after_layer is not None and how != NONE:
        raise InputError(
            "BAD_VALUE",
            f"{scan.Label}.Fit",
            "{}: only a scan in the part's own coordinates shows how far a part has "
            "grown; give none",
            how,
        )
    inspected = scan.Proxy.value(scan)
    ground = getattr(obj.Feature, "Substrate", None)
    substrate = None if ground is None or parameters.after_layer is not None else taken(ground)

    def fit(toolpath: Toolpath) -> Toolpath:
        fit_layers.refuse_family(toolpath, where)
        body = None if substrate is None else substrate.body()
        if body is not None:
            scan_checks.refuse_other(inspected.points, inspected.file, body, parameters.scan_within)
        return fitted(toolpath, inspected, body, parameters)

    return fit


def fitted(
    toolpath: Toolpath, inspected: Inspected, body: Any, parameters: ScanParameters
) -> Toolpath:
    """The toolpath on the surface that was scanned, and kept clear of that in place of the body. InputError."""
    first = toolpath.layers[min(parameters.first, len(toolpath.layers) - 1)]
    ways = np.concatenate([fit_layers.ways_of(toolpath)(bead) for bead in first.beads])
    points = inspected.points
    if body is not None:
        points = points[scanned_body.facing(points, body, ways)]
    scan = Scan(points, inspected.file, parameters.scan_within)
    made = fit_layers.fitted(
        toolpath, scan, parameters, len(inspected.points) - len(points), inspected.motion
    )
    notes = [issue for issue in inspected.issues if issue.code in UNDERSTANDING]
    made = dataclasses.replace(made, issues=(*notes, *made.issues))
    if body is None:
        return made
    around = tuple(
        scanned_body.scanned(one, scan, ways) if one.name == body.name else one
        for one in made.surroundings
    )
    return dataclasses.replace(made, surroundings=around)
