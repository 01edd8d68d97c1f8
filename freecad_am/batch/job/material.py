# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material files: data of a wire and its beads, which complete the section `process` of a job.

`process.material` names a built-in file, or the path of a YAML file from the job's folder.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ...core.geometry.job_files import is_there
from ...core.issues import InputError
from ...core.parameters import bead_classes
from ...core.parameters import field as f
from ...core.process.wire import BUILT_IN, load
from ...sections import fields, tree
from ...sections.paths import absolute, folder_of

KEY = "process.material"
FOLDER = Path(__file__).resolve().parents[2] / "materials"
ENDING = ".yaml"
CARRIED = ("density", "temperature", "gas", "stand_off", "travel_speed")  # as the process has them
KEYS = ("name", "source", *CARRIED, "wire", "speed_range", "schedules", "beads")
NEEDED = ("source", "density")
WIRE = ("diameter", "feed")
ALL = "all"  # in schedules: beads of any class that is not named


def built_in() -> list[str]:
    """Names of the materials that come with the program."""
    return sorted(path.stem for path in FOLDER.glob(f"*{ENDING}"))


def filled_in(section: Any) -> Any:
    """The section `process` of a job with what its material says and it does not itself; a section without a
    file of one as it is. InputError about a key of the job or of the material file."""
    if not isinstance(section, dict) or not isinstance(section.get("material"), str):
        return section
    file = _file(section["material"].strip())
    saved = tree.read(str(file), "source: and density:", "source and density")
    try:
        stated = _defaults(saved.values, file)
    except InputError as error:
        raise saved.locate(error) from None
    return _over(stated, section)


def _file(name: str) -> Path:
    """The file of a name: an existing one, by its absolute name, else a built-in one."""
    if os.path.isabs(name) and is_there(name):
        return Path(name)
    built_in_file = FOLDER / f"{name.removesuffix(ENDING)}{ENDING}"
    if name.removesuffix(ENDING) in built_in():
        return built_in_file
    raise InputError(
        "NO_FILE",
        KEY,
        "unknown material {}; use one of {}, or the path of a material file",
        fields.quote(name),
        ", ".join(built_in()),
    )


def _defaults(values: dict[str, Any], file: Path) -> dict[str, Any]:
    """What a material file says, as a section `process`. InputError about its keys."""
    fields.known_keys(values, KEYS, "")
    for key in NEEDED:
        if values.get(key) in (None, {}):
            raise InputError(
                "BAD_VALUE",
                key,
                "the material lacks {}; write {}: ...",
                key,
                key,
            )
    source = " ".join(fields.text(values["source"], "source").split())
    slowest, fastest = _range(values.get("speed_range"))
    name = values.get("name")
    stated: dict[str, Any] = {
        "material": {
            "name": file.stem if name in (None, {}) else fields.text(name, "name"),
            "source": source,
            **({} if slowest is None else {"slowest": slowest, "fastest": fastest}),
        },
        **{key: values[key] for key in CARRIED if values.get(key) not in (None, {})},
    }
    stated |= _checked(stated, values, slowest, fastest)
    if values.get("schedules") not in (None, {}):
        stated |= _schedules(values["schedules"])
    if values.get("beads") not in (None, {}):
        stated["bead_model"] = _beads(values, file, slowest, fastest)
    return stated


def _range(value: Any) -> tuple[float | None, float | None]:
    """The slowest and the fastest travel speed, mm/s."""
    if value in (None, {}):
        return None, None
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(
            "BAD_VALUE",
            "speed_range",
            "{} is not a range; give [slowest, fastest]",
            fields.quote(value),
        )
    low, high = (fields.read(end, f.SPEED, "speed_range") for end in value)
    if not 0.0 < low <= high < 1e9:
        raise InputError(
            "BAD_VALUE",
            "speed_range",
            "{:g} to {:g} mm/s is not a range; give the slower speed first, both more than 0",
            low,
            high,
        )
    return low, high


def _checked(
    stated: dict[str, Any], values: dict[str, Any], slowest: float | None, fastest: float | None
) -> dict[str, Any]:
    """The wire; its numbers are checked here, so that errors name the line of the material file."""
    for key, kind in (
        ("density", f.NUMBER),
        ("temperature", f.NUMBER),
        ("stand_off", f.LENGTH),
        ("travel_speed", f.SPEED),
    ):
        number = fields.read(stated[key], kind, key) if key in stated else 1.0
        if key in ("density", "travel_speed") and not 0.0 < number < 1e9:
            raise InputError(
                "BAD_VALUE",
                key,
                "{} is out of range; give more than 0",
                fields.quote(stated[key]),
            )
        if (
            key == "travel_speed"
            and key in stated
            and slowest is not None
            and not slowest <= number <= (fastest or 0.0)
        ):
            raise InputError(
                "BAD_VALUE",
                key,
                "{} is outside speed_range; change one of the two",
                fields.quote(stated[key]),
            )
    if values.get("wire") in (None, {}):
        return {}
    wire = fields.mapping(values["wire"], "wire")
    fields.known_keys(wire, WIRE, "wire")
    for key, kind in zip(WIRE, (f.LENGTH, f.SPEED), strict=True):
        if key in wire and not 0.0 < fields.read(wire[key], kind, f"wire.{key}") < 1e9:
            raise InputError(
                "BAD_VALUE",
                f"wire.{key}",
                "{} is out of range; give more than 0",
                fields.quote(wire[key]),
            )
    return {"wire": dict(wire)}


def _schedules(value: Any) -> dict[str, Any]:
    """The table of schedules, by classes of beads."""
    table = fields.mapping(value, "schedules")
    fields.known_keys(table, (ALL, *bead_classes.CLASSES), "schedules")
    for name, number in table.items():
        if (
            isinstance(number, bool)
            or not isinstance(number, int)
            or not 1 <= number <= bead_classes.LARGEST_SCHEDULE
        ):
            raise InputError(
                "BAD_VALUE",
                f"schedules.{name}",
                "{} is not a number of a schedule; give a whole number from 1 to {}",
                fields.quote(number),
                bead_classes.LARGEST_SCHEDULE,
            )
    classes = {name: {"schedule": number} for name, number in table.items() if name != ALL}
    return {
        **({"schedule": table[ALL]} if ALL in table else {}),
        **({"classes": classes} if classes else {}),
    }


def _beads(values: dict[str, Any], file: Path, slowest: float | None, fastest: float | None) -> str:
    """The bead table, which fits the wire feed and the speeds of the file."""
    name = fields.text(values["beads"], "beads").strip()
    if name not in BUILT_IN:
        name = absolute(name, folder_of(str(file)))
    model = load(name)
    low, high = model.speeds
    if slowest is not None and fastest is not None and (fastest < low or slowest > high):
        raise InputError(
            "BAD_VALUE",
            "beads",
            "the beads of {} were measured at {:.4g} to {:.4g} mm/s, but speed_range is {:.4g} "
            "to {:.4g} mm/s; correct one of the two",
            os.path.basename(name),
            low,
            high,
            slowest,
            fastest,
        )
    feed = (values.get("wire") or {}).get("feed")
    if feed not in (None, "auto"):
        wire_feed = fields.read(feed, f.SPEED, "wire.feed")
        min_feed, max_feed = model.feeds or (model.wire_feed, model.wire_feed)
        if not 0.99 * min_feed <= wire_feed <= 1.01 * max_feed:
            raise InputError(
                "BAD_VALUE",
                "wire.feed",
                "{:.4g} mm/s is not a wire feed of {}, whose beads were measured at {:.4g} to "
                "{:.4g} mm/s; remove it, or use a measured feed",
                wire_feed,
                os.path.basename(name),
                min_feed,
                max_feed,
            )
    return name


def _over(stated: dict[str, Any], section: dict[str, Any]) -> dict[str, Any]:
    """The job's values over its material's, key by key; classes given as a text in the job replace
    the material's.
    """
    merged = {**stated, **{key: value for key, value in section.items() if key != "material"}}
    for key in ("wire", "classes"):
        job_section = section.get(key)
        if isinstance(job_section, dict) and key in stated:
            merged[key] = {**stated[key], **job_section}
            if key == "classes":
                merged[key] |= {
                    name: {**stated[key][name], **(class_values or {})}
                    for name, class_values in job_section.items()
                    if name in stated[key]
                    and (class_values is None or isinstance(class_values, dict))
                }
    return merged
