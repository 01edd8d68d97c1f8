# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scan of a substrate: measured points laid onto it, or left where they are."""

from __future__ import annotations

from typing import Any

from ..core.issues import InputError
from ..core.parameters.inspection import AUTO, BEST, NONE, InspectionParameters
from .arguments import (
    checked_document,
    checked_number,
    checked_object,
    checked_target,
    checked_text,
)
from .steps import make_stage, one_step


def make_scan(
    doc: Any,
    substrate: Any,
    file: str,
    label: str = "Scan",
    *,
    fit: str = AUTO,
    unit: str = AUTO,
    pairs: str = "",
    within: float = 5.0,
) -> Any:
    """The points of a file (CSV, TXT, XYZ, ASC; vertices of STL, OBJ, PLY) as an inspection of an object with a shape or
    mesh, for `make_toolpath(..., scan=...)`. `am.make_scan(doc, doc.Plate, "plate.ply")`

    fit: best lays them onto the object, none takes them to be in its coordinates; auto does that where they lie within
    `within` mm of it as they are. pairs: three or more measured points and where they are on the object, as an inspection
    has them; with them nothing else is fitted. Raises InputError SCAN_UNIT, SCAN_OTHER, SCAN_AMBIGUOUS.
    """
    from ..core.inspection import point_file, scan_checks, scan_motion  # what few jobs need
    from ..objects.inspection import Inspection
    from ..objects.shapes.bodies import snapshot_of

    checked_document(doc)
    checked_text(label, "label")
    file = checked_target(file, "file")
    for text, where in ((fit, "fit"), (unit, "unit"), (pairs, "pairs")):
        checked_text(text, where)
    within = checked_number(within, "within")
    InspectionParameters(unit=unit)
    body = snapshot_of(checked_object(substrate, "substrate", doc)).body()
    measured = point_file.read(file, unit)
    scan_checks.refuse_size(measured.points, measured.label, body)
    asked = fit == BEST or (
        fit == AUTO
        and scan_checks.share_near(measured.points, body, within) < scan_checks.LEAST_ON_PART
    )
    if asked and not pairs:
        motion = scan_motion.align_scan(measured.points, body, measured.label)
        pairs = scan_motion.as_pairs(motion, scan_checks.extent(body.vertices))
    values = {"fit": NONE, "unit": unit, "pairs": pairs}
    with one_step(doc, f"Make {label}"):
        found = make_stage(
            doc, Inspection, "Inspection", label, {"Planned": substrate, "File": file}, [], values
        )
        try:
            scan_checks.refuse_other(found.Proxy.value(found).points, measured.label, body, within)
        except InputError:
            doc.removeObject(found.Name)
            raise
    return found
