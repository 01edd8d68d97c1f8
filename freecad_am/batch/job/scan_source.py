# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scan of a substrate that a job names, and how layers are fitted to it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from freecad_am.core.geometry.located import is_there
from freecad_am.core.issues import InputError
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.inspection import AUTO, BEST, NONE, UNITS, InspectionParameters
from freecad_am.core.parameters.scan import PREFIX, ScanParameters
from freecad_am.sections import fields as job_fields

FITS = (AUTO, BEST, NONE)
OWN = ("scan", "scan_unit", "scan_fit", "scan_pairs")
KEYS = (*OWN, *(entry.name for entry in fields(ScanParameters)))


@dataclass(frozen=True)
class ScanSource:
    """file: of the points. unit, fit, pairs: as an inspection has them; fit auto takes them as they were measured where they
    lie on the substrate so."""

    file: str
    unit: str
    fit: str
    pairs: str
    parameters: ScanParameters


def split(section: Any) -> tuple[Any, dict[str, Any]]:
    """The section of a substrate without the keys of its scan, and these."""
    if not isinstance(section, dict):
        return section, {}
    return (
        {key: value for key, value in section.items() if key not in KEYS},
        {key: value for key, value in section.items() if key in KEYS and value is not None},
    )


def scan_of(given: dict[str, Any], strategy: Any) -> ScanSource | None:
    """The scan of these keys of a substrate; None without any. InputError naming the key."""
    if not given:
        return None
    if "scan" not in given:
        key = next(iter(given))
        raise InputError(
            "BAD_VALUE",
            f"{PREFIX}.{key}",
            "there is no scan; give its file as {}.scan, or leave it",
            PREFIX,
        )
    file = job_fields.text(given["scan"], f"{PREFIX}.scan")
    if not is_there(file):
        raise InputError(
            "NO_FILE",
            f"{PREFIX}.scan",
            "there is no file {}; check the path, relative to the file with it",
            file,
        )
    for key, choices in (("scan_unit", (AUTO, *UNITS)), ("scan_fit", FITS)):
        if given.get(key, AUTO) not in choices:
            raise f.unknown_choice(f"{PREFIX}.{key}", given[key], choices)
    parameters = job_fields.build(
        ScanParameters, {key: value for key, value in given.items() if key not in OWN}, PREFIX
    )
    fit, pairs = given.get("scan_fit", AUTO), str(given.get("scan_pairs", ""))
    try:
        InspectionParameters(pairs=pairs)
    except InputError as error:
        raise InputError(error.code, f"{PREFIX}.scan_pairs", error.message) from None
    if parameters.after_layer is not None and fit not in (AUTO, NONE):
        raise InputError(
            "BAD_VALUE",
            f"{PREFIX}.scan_fit",
            "{}: only a scan in the part's own coordinates shows how far a part has "
            "grown; give none",
            fit,
        )
    layers = getattr(strategy, "layers", "planes")
    kind = type(strategy).__name__.removesuffix("Parameters").lower()
    if kind not in ("solid", "surface") or layers != "planes":
        raise InputError(
            "NOT_YET",
            f"{PREFIX}.scan",
            "{} is not fitted to a scan yet; solids in plane layers and walls on a substrate "
            "are: leave it out",
            kind if kind != "solid" else f"layers: {layers}",
        )
    return ScanSource(file, given.get("scan_unit", AUTO), fit, pairs, parameters)
