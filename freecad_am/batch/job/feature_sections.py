# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert the sections of a feature in a job file to parameters, completed from material files."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import Any

from ...core.families.family import NEEDED, NONE, Family
from ...core.families.registry import AUTO, DEFAULT_KIND, KINDS, family_of, find_family
from ...core.geometry.curves.bead_curves import POINT_FILES
from ...core.geometry.job_files import is_there
from ...core.issues import InputError, Word
from ...core.parameters import bead_classes
from ...core.parameters import field as f
from ...core.parameters import settings as by_place
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.records import NONE as NO_RECORDS
from ...core.parameters.settings import Setting
from ...core.parameters.strategy import LayerParameters
from ...core.process import wire
from ...core.process.wire import BUILT_IN, load
from ...objects.fields import quantities
from ...sections import fields, tree
from ...sections.paths import absolute, folder_of
from .part_source import PartSource, faces_of, part_of


def with_classes(section: dict[str, Any]) -> dict[str, Any]:
    """Return the section `process` with bead classes as records.

    Raises InputError naming class and key.
    """
    if "settings" in section:
        raise InputError(
            "UNKNOWN_KEY",
            "process.settings",
            "settings by place belong to the whole job; write `settings:` beside `process:`",
        )
    classes = section.get("classes")
    if classes in (None, {}, [], NO_RECORDS):
        return {key: value for key, value in section.items() if key != "classes"}
    if not isinstance(classes, dict):
        raise InputError(
            "BAD_VALUE",
            bead_classes.WHERE,
            "{} is not a mapping of bead classes; write, for example, contour: {{travel_speed: 8 "
            "mm/s, schedule: 3}}",
            quantities.quote(classes),
        )
    fields.known_keys(classes, bead_classes.CLASSES, bead_classes.WHERE)
    records = [_bead_class(class_section, name) for name, class_section in classes.items()]
    return {**section, "classes": bead_classes.in_order(records)}


def _bead_class(class_section: Any, name: str) -> bead_classes.BeadClass:
    """Convert the section of a bead class. Raises InputError naming class and key."""
    where = f"{bead_classes.WHERE}.{name}"
    values = fields.mapping(_flat({} if class_section is None else class_section, name), where)
    fields.known_keys(values, bead_classes.SPECS, where)
    return fields.build(bead_classes.BeadClass, {**values, "name": name}, where)


SETTING_KEYS = ("where", *by_place.SECTIONS)
WHERE_KEYS = ("layers", "height", "inside", "faces", "within")


@dataclasses.dataclass(frozen=True)
class PlaceSettings:
    """Settings by place, and the solids that they name, by the name in `Setting.inside`."""

    settings: tuple[Setting, ...] = ()
    solids: tuple[tuple[str, PartSource], ...] = ()


def settings_of(section: Any, part_section: Any) -> PlaceSettings:
    """The settings by place of a job. Raises InputError naming entry, key and what to do."""
    if section in (None, {}, []):
        return PlaceSettings()
    if not isinstance(section, list):
        raise InputError(
            "BAD_VALUE",
            by_place.WHERE,
            "{} is not a list; write settings: [{{where: {{layers: [0, 4]}}, process: "
            "{{travel_speed: 4 mm/s}}}}]",
            quantities.quote(section),
        )
    settings: list[Setting] = []
    solids: dict[PartSource, str] = {}
    for number, entry in enumerate(section):
        where = f"{by_place.WHERE}[{number}]"
        entry = fields.mapping(entry, where)
        fields.known_keys(entry, SETTING_KEYS, where)
        if not entry.get("where"):
            raise InputError(
                "BAD_VALUE",
                f"{where}.where",
                "the place is missing; write where: {{layers: [0, 4]}} or one of {}",
                ", ".join(WHERE_KEYS[1:]),
            )
        values = {
            **_conditions(
                fields.mapping(entry["where"], f"{where}.where"), where, part_section, solids
            ),
            **_place_values(entry, where),
        }
        try:
            settings.append(Setting(**values))
        except InputError as error:
            key = error.where.removeprefix(by_place.WHERE)
            raise InputError(error.code, f"{where}{key}", error.message) from None
    by_place.check_number(settings)
    return PlaceSettings(tuple(settings), tuple((name, source) for source, name in solids.items()))


def _place_values(entry: dict[str, Any], where: str) -> dict[str, Any]:
    """What an entry sets. Raises InputError for keys that cannot vary by place."""
    values: dict[str, Any] = {}
    for name, allowed in by_place.SECTIONS.items():
        if entry.get(name) in (None, {}):
            continue
        section = fields.mapping(entry[name], f"{where}.{name}")
        for key, value in section.items():
            if key in allowed:
                kind = by_place.SPECS[key].kind
                dotted_key = f"{where}.{name}.{key}"
                # the setting checks numbers
                values[key] = value if kind == f.COUNT else quantities.read(value, kind, dotted_key)
                continue
            raise InputError(
                "NOT_YET" if key in by_place.FUTURE_KEYS[name] else "UNKNOWN_KEY",
                f"{where}.{name}.{key}",
                "{!r} cannot vary by place{}; use one of {}, or set it for the whole job",
                key,
                Word(" yet" if key in by_place.FUTURE_KEYS[name] else ""),
                ", ".join(by_place.VALUE_KEYS),
            )
    return values


def _conditions(
    section: dict[str, Any], where: str, part_section: Any, solids: dict[PartSource, str]
) -> dict[str, Any]:
    """The conditions of `where` as fields of a setting. solids: names of solids, gains new ones."""
    key = f"{where}.where"
    fields.known_keys(section, WHERE_KEYS, key)
    conditions: dict[str, Any] = {}
    for name, kind, ends in (
        ("layers", f.COUNT, ("first_layer", "last_layer")),
        ("height", f.LENGTH, ("low", "high")),
    ):
        if section.get(name) is not None:
            values = _place_range(section[name], kind, f"{key}.{name}")
            conditions |= dict(zip(ends, values))
    if section.get("faces") is not None:
        conditions["faces"] = faces_of(section["faces"], f"{key}.faces")
    if section.get("within") is not None:
        conditions["within"] = quantities.read(section["within"], f.LENGTH, f"{key}.within")
    if section.get("inside") is not None:
        conditions |= _inside(section["inside"], f"{key}.inside", part_section, solids)
    return conditions


def _place_range(value: Any, kind: str, key: str) -> list[Any]:
    """The two ends of a range; None for an open one. Raises InputError BAD_VALUE."""
    is_layers = kind == f.COUNT
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(
            "BAD_VALUE",
            key,
            "{} is not a range; give {}, with null for an open end",
            quantities.quote(value),
            Word("[first, last]" if is_layers else "[lower, upper]"),
        )
    if value == [None, None]:
        raise InputError("BAD_VALUE", key, "both ends are open; give at least one, or remove it")
    if is_layers:
        for end in value:
            if end is not None and (isinstance(end, bool) or not isinstance(end, int) or end < 0):
                raise InputError(
                    "BAD_VALUE",
                    key,
                    "{} is not the number of a layer; give a whole number from 0",
                    quantities.quote(end),
                )
        return value
    return [None if end is None else quantities.read(end, kind, key) for end in value]


def _inside(
    value: Any, key: str, part_section: Any, solids: dict[PartSource, str]
) -> dict[str, Any]:
    """The condition `inside`: a box, or a solid of a file or of the part's document."""
    section = fields.mapping(value, key)
    fields.known_keys(section, ("box", "file", "object", "scale"), key)
    if "box" in section:
        if len(section) > 1:
            raise InputError(
                "BAD_VALUE",
                key,
                "it has a box and a solid; give one of them, in two entries if both",
            )
        box = section["box"]
        if not isinstance(box, list) or len(box) != 6:
            raise InputError(
                "BAD_VALUE",
                f"{key}.box",
                "{} is not a box; give [x0, y0, z0, x1, y1, z1]",
                quantities.quote(box),
            )
        return {"box": tuple(quantities.read(end, f.LENGTH, f"{key}.box") for end in box)}
    source_section = dict(section)
    if "file" not in section:
        part_values = part_section if isinstance(part_section, dict) else {}
        source_section["file"] = part_values.get("file", "")
        if part_values.get("set"):
            source_section["set"] = part_values["set"]
        if not str(source_section["file"]).lower().endswith(".fcstd"):
            raise InputError(
                "BAD_VALUE",
                f"{key}.object",
                "only an FCStd part has objects; give a file or a box",
            )
    source = part_of(source_section, key)
    return {"inside": solids.setdefault(source, f"zone {len(solids)}")}


def _flat(class_section: Any, name: str) -> Any:
    """Flatten the keys of a class: `start: {length: ...}` becomes start_length."""
    if not isinstance(class_section, dict):
        return class_section
    flat: dict[str, Any] = {}
    for key, value in class_section.items():
        if key in (bead_classes.START, bead_classes.END):
            where = f"{bead_classes.WHERE}.{name}.{key}"
            phase_keys = [field.name for field in dataclasses.fields(bead_classes.PhaseParameters)]
            section = fields.mapping(value, where)
            fields.known_keys(section, phase_keys, where)
            flat |= {f"{key}_{inner}": entry for inner, entry in section.items()}
        else:
            flat[key] = value
    return flat


def kept_clear(family: Family) -> tuple[str, ...]:
    """Return the keys of `strategy` that are no family parameters: its kind and selections on the
    part.
    """
    return ("kind", *family.selections)


def process_of(section: Any, strategy: LayerParameters | None = None) -> ProcessParameters:
    """Return the process parameters, completed from the material.

    For filled solids the bead width of the job counts, at any value. strategy: None for a program
    of several features, which may differ, or if not chosen yet. Raises InputError, also from the
    bead table.
    """
    process_section = with_classes(filled_in(fields.mapping(section, "process")))
    if strategy is not None and "bead_width" in process_section and family_of(strategy).is_filled:
        process_section = {"fill_width": "bead_width", **process_section}
    process = fields.build(ProcessParameters, process_section, "process")
    if process.bead_model != "none":
        wire.load(process.bead_model)
    return process


def refuse_direction(strategy: Any, build_direction: BuildDirectionParameters) -> None:
    """Raise InputError for a build direction that the family does not support."""
    family = family_of(strategy)
    if build_direction.mode not in family.modes:
        raise InputError(
            "NOT_FOR_FAMILY", "build_direction.mode", family.mode_refusal, build_direction.mode
        )


def substrate_of(section: Any, strategy: Any, source: PartSource) -> PartSource | None:
    """Return the source of the substrate of a feature, None for the platform."""
    family = family_of(strategy)
    if source.start_edges and not family.takes_start_edges:
        raise InputError(
            "NOT_FOR_FAMILY",
            "part.start_edges",
            "only strategy.kind surface starts from edges; remove the edges",
        )
    table = source.file.lower().endswith(tuple(POINT_FILES))
    if not family.takes_curves and (source.edges or table):
        where, what = ("part.edges", "edges") if source.edges else ("part.file", "tables of points")
        raise InputError(
            "NOT_FOR_FAMILY",
            where,
            "only strategy.kind curves deposits {} as beads; set kind: curves",
            what,
        )
    if table and (source.edges or source.faces):
        raise InputError(
            "NOT_FOR_FAMILY",
            "part.edges" if source.edges else "part.faces",
            "a table of points has no edges or faces; remove `edges` and `faces`",
        )
    if source.faces and not family.takes_faces:
        raise InputError(
            "NOT_FOR_FAMILY", "part.faces", "solids are deposited whole; remove the faces"
        )
    if family.substrate == NEEDED:
        if section is None:
            return None
        substrate = part_of(fields.mapping(section, "substrate"), "substrate")
        if substrate.faces:
            raise InputError(
                "NOT_YET",
                "substrate.faces",
                "{!r} is not supported yet; use the whole solid",
                ", ".join(substrate.faces),
            )
        if not source.start_edges and _alike(source, substrate):
            raise InputError(
                "OWN_SUBSTRATE",
                "substrate",
                "the wall and its substrate are the same object, {}; choose the part below the "
                "wall, or remove the substrate if the wall starts on the platform or from "
                "part.start_edges",
                os.path.basename(substrate.file),
            )
        return substrate
    if section is not None and family.substrate == NONE:
        raise InputError(
            "NOT_FOR_FAMILY",
            "substrate",
            "parts of revolution do not use a substrate; remove the substrate",
        )
    return None if section is None else part_of(fields.mapping(section, "substrate"), "substrate")


def _alike(source: PartSource, other_source: PartSource) -> bool:
    """Whether two sources are the same, apart from selected faces."""
    return os.path.realpath(source.file) == os.path.realpath(other_source.file) and (
        (source.object, source.solids, source.settings, source.scale)
        == (other_source.object, other_source.solids, other_source.settings, other_source.scale)
    )


def strategy_of(section: Any) -> LayerParameters:
    """Return the strategy parameters of the kind that a section names."""
    kind = fields.mapping(section, "strategy").get("kind", DEFAULT_KIND)
    family = find_family(kind, section.get("layers"))
    if family is None:
        raise f.unknown_choice("strategy.kind", kind, (*KINDS, AUTO.kind))
    if family.kind != kind:  # the name of its layers, which has said all
        section = {key: value for key, value in section.items() if key != "layers"}
    names = {field.name for field in dataclasses.fields(family.parameters)}
    for name, write in _WRITTEN.items():
        if name in names:
            section = write(section)
    return fields.build(family.parameters, section, "strategy", also=kept_clear(family))


def _roles_as_text(section: dict[str, Any]) -> dict[str, Any]:
    """Return the section with the list `roles` as text."""
    roles = section.get("roles")
    if not isinstance(roles, list):
        return section
    return {
        **section,
        "roles": ", ".join(fields.text(role, "strategy.roles") for role in roles) or " ",
    }


def _without_auto_base(section: dict[str, Any]) -> dict[str, Any]:
    """Return the section without `base: auto`."""
    return {key: value for key, value in section.items() if (key, value) != ("base", "auto")}


# keys that a job writes in another way than parameters
_WRITTEN = {"base": _without_auto_base, "roles": _roles_as_text}


# ---- Material files: data of a wire and its beads, which complete the section `process` of a job
#
# `process.material` names a built-in file, or the path of a YAML file from the job's folder.

KEY = "process.material"
FOLDER = Path(__file__).resolve().parents[2] / "materials"
ENDING = ".yaml"
CARRIED = ("density", "temperature", "gas", "stand_off", "travel_speed")  # as the process has them
KEYS = ("name", "source", *CARRIED, "wire", "speed_range", "schedules", "beads")
NEEDED_KEYS = ("source", "density")
WIRE = ("diameter", "feed")
ALL = "all"  # in schedules: beads of any class that is not named


def built_in() -> list[str]:
    """Return the names of the built-in materials."""
    return sorted(path.stem for path in FOLDER.glob(f"*{ENDING}"))


def filled_in(section: Any) -> Any:
    """Return the section `process` with missing values taken from its material file.

    A section without a material file is returned unchanged. Raises InputError about a key of the
    job or of the material file.
    """
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
    """Return the file of a material: an existing path, made absolute, or else a built-in file."""
    if os.path.isabs(name) and is_there(name):
        return Path(name)
    built_in_file = FOLDER / f"{name.removesuffix(ENDING)}{ENDING}"
    if name.removesuffix(ENDING) in built_in():
        return built_in_file
    raise InputError(
        "NO_FILE",
        KEY,
        "unknown material {}; use one of {}, or the path of a material file",
        quantities.quote(name),
        ", ".join(built_in()),
    )


def _defaults(values: dict[str, Any], file: Path) -> dict[str, Any]:
    """Convert a material file to a section `process`. Raises InputError about its keys."""
    fields.known_keys(values, KEYS, "")
    for key in NEEDED_KEYS:
        if values.get(key) in (None, {}):
            raise InputError(
                "BAD_VALUE",
                key,
                "the material has no {}; add {}: ...",
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
    """Return the slowest and the fastest travel speed, mm/s."""
    if value in (None, {}):
        return None, None
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(
            "BAD_VALUE",
            "speed_range",
            "{} is not a range; give [slowest, fastest]",
            quantities.quote(value),
        )
    low, high = (quantities.read(end, f.SPEED, "speed_range") for end in value)
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
    """Return the wire settings. Check their numbers here, so that errors name the line of the
    material file.
    """
    for key, kind in (
        ("density", f.NUMBER),
        ("temperature", f.NUMBER),
        ("stand_off", f.LENGTH),
        ("travel_speed", f.SPEED),
    ):
        number = quantities.read(stated[key], kind, key) if key in stated else 1.0
        if key in ("density", "travel_speed") and not 0.0 < number < 1e9:
            raise InputError(
                "BAD_VALUE",
                key,
                "{} is out of range; give more than 0",
                quantities.quote(stated[key]),
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
                "{} is outside speed_range; change the travel speed or the range",
                quantities.quote(stated[key]),
            )
    if values.get("wire") in (None, {}):
        return {}
    wire = fields.mapping(values["wire"], "wire")
    fields.known_keys(wire, WIRE, "wire")
    for key, kind in zip(WIRE, (f.LENGTH, f.SPEED), strict=True):
        if key in wire and not 0.0 < quantities.read(wire[key], kind, f"wire.{key}") < 1e9:
            raise InputError(
                "BAD_VALUE",
                f"wire.{key}",
                "{} is out of range; give more than 0",
                quantities.quote(wire[key]),
            )
    return {"wire": dict(wire)}


def _schedules(value: Any) -> dict[str, Any]:
    """Return the table of schedules by bead class."""
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
                "{} is not a schedule number; give a whole number from 1 to {}",
                quantities.quote(number),
                bead_classes.LARGEST_SCHEDULE,
            )
    classes = {name: {"schedule": number} for name, number in table.items() if name != ALL}
    return {
        **({"schedule": table[ALL]} if ALL in table else {}),
        **({"classes": classes} if classes else {}),
    }


def _beads(values: dict[str, Any], file: Path, slowest: float | None, fastest: float | None) -> str:
    """Return the bead table, checked against the wire feed and the speeds of the file."""
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
            "to {:.4g} mm/s; correct the range or the bead model",
            os.path.basename(name),
            low,
            high,
            slowest,
            fastest,
        )
    feed = (values.get("wire") or {}).get("feed")
    if feed not in (None, "auto"):
        wire_feed = quantities.read(feed, f.SPEED, "wire.feed")
        min_feed, max_feed = model.feeds or (model.wire_feed, model.wire_feed)
        if not 0.99 * min_feed <= wire_feed <= 1.01 * max_feed:
            raise InputError(
                "BAD_VALUE",
                "wire.feed",
                "{:.4g} mm/s is not a wire feed of {}, whose beads were measured at {:.4g} to "
                "{:.4g} mm/s; remove the wire feed, or use a measured one",
                wire_feed,
                os.path.basename(name),
                min_feed,
                max_feed,
            )
    return name


def _over(stated: dict[str, Any], section: dict[str, Any]) -> dict[str, Any]:
    """Merge the values of the job over those of the material, key by key.

    Classes given as text in the job replace the classes of the material.
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
