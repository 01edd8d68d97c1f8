# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scan of a substrate that a job names, and how layers are fitted to it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from ...core.families.registry import family_of
from ...core.geometry.job_files import is_there
from ...core.issues import InputError
from ...core.parameters import field as f
from ...core.parameters.filled import PLANES
from ...core.parameters.inspection import AUTO, BEST, NONE, UNITS, InspectionParameters
from ...core.parameters.scan import PREFIX, ScanParameters
from ...sections import fields as job_fields

FIT_CHOICES = (AUTO, BEST, NONE)
SOURCE_KEYS = ("scan", "scan_unit", "scan_fit", "scan_pairs")
KEYS = (*SOURCE_KEYS, *(entry.name for entry in fields(ScanParameters)))


@dataclass(frozen=True)
class ScanSource:
    """file: of the points. unit, fit, pairs: as in an inspection; fit auto takes the points as
    measured if they match the substrate.
    """

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


def scan_of(scan_keys: dict[str, Any], strategy: Any) -> ScanSource | None:
    """The scan from keys of a substrate; None without any. Raises InputError naming the key."""
    if not scan_keys:
        return None
    if "scan" not in scan_keys:
        key = next(iter(scan_keys))
        raise InputError(
            "BAD_VALUE",
            f"{PREFIX}.{key}",
            "the scan is missing; give its file as {}.scan, or remove the section",
            PREFIX,
        )
    file = job_fields.text(scan_keys["scan"], f"{PREFIX}.scan")
    if not is_there(file):
        raise InputError(
            "NO_FILE",
            f"{PREFIX}.scan",
            "file {} does not exist; check the path, which is relative to the file that names it",
            file,
        )
    for key, choices in (("scan_unit", (AUTO, *UNITS)), ("scan_fit", FIT_CHOICES)):
        if scan_keys.get(key, AUTO) not in choices:
            raise f.unknown_choice(f"{PREFIX}.{key}", scan_keys[key], choices)
    parameters = job_fields.build(
        ScanParameters,
        {key: value for key, value in scan_keys.items() if key not in SOURCE_KEYS},
        PREFIX,
    )
    fit, pairs = scan_keys.get("scan_fit", AUTO), str(scan_keys.get("scan_pairs", ""))
    try:
        InspectionParameters(pairs=pairs)
    except InputError as error:
        raise InputError(error.code, f"{PREFIX}.scan_pairs", error.message) from None
    if parameters.after_layer is not None and fit not in (AUTO, NONE):
        raise InputError(
            "BAD_VALUE",
            f"{PREFIX}.scan_fit",
            "{}: only a scan in the coordinates of the part shows how far it has grown; remove it",
            fit,
        )
    family, layers = family_of(strategy), getattr(strategy, "layers", PLANES)
    if not family.fits_scans(layers):
        raise InputError(
            "NOT_YET",
            f"{PREFIX}.scan",
            "{} cannot be fitted to a scan yet; only solids in planar layers and walls on a "
            "substrate can: remove it",
            family.describe_layers(layers),
        )
    return ScanSource(file, scan_keys.get("scan_unit", AUTO), fit, pairs, parameters)
