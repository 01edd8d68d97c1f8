# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job file: read, checked and turned into the parameters of every stage, before any work starts."""

from __future__ import annotations

import dataclasses
import os
import re
from dataclasses import dataclass, field
from typing import Any

from freecad_am.core.geometry.file_unit import refuse_scale
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import urdf_reference
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import LayerParameters
from freecad_am.core.strategies.families import KINDS, NEEDED, NONE, family_of

from . import fields, quantity, tree

PLANNED_SETUPS = ("tool-on-robot+positioner",)
SECTIONS = (
    "version", "name", "part", "substrate", "fixtures", "strategy", "build_direction", "cell", "joints", "process",
    "program",
)
_EDGE = re.compile(r"Edge[1-9]\d*", re.ASCII)
_FACE = re.compile(r"Face[1-9]\d*", re.ASCII)
_LONGEST_NAME = 200  # bytes, so that <name>.FCStd fits every file system


@dataclass(frozen=True)
class PartSource:
    """Where a shape comes from. `settings` are (object, property, text) set in an FCStd part before it is used. scale: mm
    of one unit of a mesh file that does not tell it."""

    file: str
    object: str | None = None
    faces: tuple[str, ...] = ()
    settings: tuple[tuple[str, str, str], ...] = ()
    start_edges: tuple[str, ...] = ()
    scale: float = 1.0


@dataclass(frozen=True)
class Job:
    """A checked job. `substrate` is there as the family of the strategy has it (`core.strategies.families`). `cell` or
    `program` None: the stages that need them are left out."""

    path: str
    name: str
    part: PartSource
    substrate: PartSource | None
    fixtures: tuple[PartSource, ...]
    strategy: LayerParameters
    build_direction: BuildDirectionParameters
    joints: JointParameters
    process: ProcessParameters
    cell: CellParameters | None
    program: ProgramParameters | None
    tree: tree.Tree = field(repr=False, compare=False)

    @property
    def folder(self) -> str:
        """The folder of the job file, absolute; where relative paths start."""
        return os.path.dirname(os.path.abspath(self.path))


def read_job(path: str) -> Job:
    """The job of a file. Raises InputError that names file, key and what to do."""
    return from_tree(tree.read(path), path)


def from_tree(job: tree.Tree, path: str) -> Job:
    """The job of the values read from `path`, which may have been changed since (a row of a batch table)."""
    try:
        return _checked(job, path)
    except InputError as error:
        raise job.placed(error) from None


def _checked(job: tree.Tree, path: str) -> Job:
    values = job.values
    fields.known_keys(values, SECTIONS, "")
    version = values.get("version", 1)
    if version != 1 or isinstance(version, bool):
        raise InputError("BAD_VERSION", "version", f"{quantity.shown(version)} is not understood; this program reads 1")
    if values.get("part") is None:
        raise InputError("NO_PART", "part", "there is no part; write part: {file: shape.step}")
    part_section = fields.mapping(values["part"], "part")
    strategy = _strategy(_with_fuse(values.get("strategy") or {}, part_section))
    process = _process(values.get("process") or {}, strategy)
    process = _with_bead_model(process, strategy, path)
    build_direction = fields.build(BuildDirectionParameters, values.get("build_direction") or {}, "build_direction")
    _refuse_direction(strategy, build_direction)
    part = _part({key: value for key, value in part_section.items() if key != "fuse"}, path)
    return Job(
        path=path,
        name=_name(values.get("name"), path),
        part=part,
        substrate=_substrate(values.get("substrate"), strategy, part, path),
        fixtures=_fixtures(values.get("fixtures"), path),
        strategy=strategy,
        build_direction=build_direction,
        joints=_joints(values.get("joints") or {}),
        process=process,
        cell=_cell(values.get("cell"), path),
        program=_program(values.get("program")),
        tree=job,
    )


def _not_yet(key: str, value: str, instead: str) -> InputError:
    return InputError("NOT_YET", key, f"{value!r} is not supported yet; use {instead}")


def _name(value: Any, path: str) -> str:
    if value is None:
        value = os.path.splitext(os.path.basename(path))[0]
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = str(value)
    name = fields.text(value, "name").strip()
    if "/" in name or "\\" in name or name.startswith(".") or not name.isprintable():
        shown = quantity.shown(name)
        raise InputError("BAD_NAME", "name", f"{shown} names files; use no slash, control sign or leading dot")
    if len(name.encode()) > _LONGEST_NAME:
        raise InputError("BAD_NAME", "name", f"the name is too long for a file; use at most {_LONGEST_NAME} letters")
    return name


def _process(section: Any, strategy: LayerParameters) -> ProcessParameters:
    """The process; where solids are filled a bead width that the job gives is meant, whatever it is."""
    given = fields.mapping(section, "process")
    if "bead_width" in given and family_of(strategy).filled:
        given = {"fill_width": "bead_width", **given}
    return fields.build(ProcessParameters, given, "process")


def _with_bead_model(process: ProcessParameters, strategy: LayerParameters, path: str) -> ProcessParameters:
    """The process with the path of its calibration table made absolute; the table is read, so that what is wrong with it is
    told at once."""
    if process.bead_model == "none":
        return process
    if not family_of(strategy).filled:
        raise InputError(
            "NOT_FOR_FAMILY", "process.bead_model", "a bead model sets the travel speed of strategy.kind solid and "
            "developable alone; use none",
        )
    from freecad_am.core.process import bead_table

    if process.bead_model not in bead_table.BUILT_IN:
        process = dataclasses.replace(process, bead_model=absolute(process.bead_model, path))
    bead_table.load(process.bead_model)
    return process


def _refuse_direction(strategy: Any, build_direction: BuildDirectionParameters) -> None:
    family = family_of(strategy)
    if build_direction.mode not in family.modes:
        raise InputError("NOT_FOR_FAMILY", "build_direction.mode", family.why.format(build_direction.mode))


def _substrate(section: Any, strategy: Any, part: PartSource, path: str) -> PartSource | None:
    family = family_of(strategy)
    if part.start_edges and not family.edges:
        raise InputError("NOT_FOR_FAMILY", "part.start_edges", "only strategy.kind surface starts from edges; leave "
        "them out")
    if part.faces and not family.faces:
        raise InputError("NOT_FOR_FAMILY", "part.faces", "solids are deposited as a whole; leave the faces out")
    if family.substrate == NEEDED:
        if section is None and part.start_edges:
            return None
        if section is None:
            raise InputError(
                "NO_SUBSTRATE", "substrate", "a wall of the kind surface grows on an existing part; write substrate: {file: "
                "pipe.step}, or name the edges to start from in part.start_edges",
            )
        found = _part(fields.mapping(section, "substrate"), path, "substrate")
        if found.faces:
            raise _not_yet("substrate.faces", ", ".join(found.faces), "the whole solid")
        return found
    if section is not None and family.substrate == NONE:
        raise InputError("NOT_FOR_FAMILY", "substrate", "parts of revolution grow on no substrate; leave it out")
    return None if section is None else _part(fields.mapping(section, "substrate"), path, "substrate")


def _fixtures(section: Any, path: str) -> tuple[PartSource, ...]:
    entries = [] if section is None else section
    if not isinstance(entries, list):
        raise InputError("BAD_VALUE", "fixtures", "fixtures are a list; write fixtures: [{file: clamp.step}]")
    found = []
    for number, entry in enumerate(entries):
        key = f"fixtures[{number}]"
        fixture = _part(fields.mapping(entry, key), path, key)
        if fixture.faces:
            raise InputError("BAD_VALUE", f"{key}.faces", "a fixture counts as a whole; leave out its faces")
        found.append(fixture)
    return tuple(found)


def _part(section: dict[str, Any], path: str, key: str = "part") -> PartSource:
    further = ("start_edges",) if key == "part" else ()
    fields.known_keys(section, ("file", "object", "faces", "set", "scale", *further), key)
    if "file" not in section:
        raise InputError("NO_PART", f"{key}.file", f"there is no file; write {key}: {{file: shape.step}}")
    file = absolute(fields.text(section["file"], f"{key}.file"), path)
    is_document = file.lower().endswith(".fcstd")
    for entry in ("object", "set"):
        if section.get(entry) is not None and not is_document:
            message = f"only an FCStd part has objects, {os.path.basename(file)} has none"
            raise InputError("BAD_VALUE", f"{key}.{entry}", message)
    if not os.path.isfile(file):
        raise InputError("NO_FILE", f"{key}.file", f"there is no file {file}; paths are relative to the job file")
    name = section.get("object")
    return PartSource(
        file=file,
        object=None if name is None else fields.text(name, f"{key}.object"),
        faces=_names(section.get("faces"), f"{key}.faces", _FACE),
        settings=tuple(_settings(section.get("set") or {}, key)),
        start_edges=_names(section.get("start_edges"), f"{key}.start_edges", _EDGE),
        scale=_scale(section.get("scale"), file, f"{key}.scale"),
    )


def _scale(value: Any, file: str, key: str) -> float:
    """mm of one unit of a file."""
    if value is None:
        return 1.0
    scale = quantity.read(value, f.LENGTH, key)
    refuse_scale(scale, file, key)
    return scale


def _names(value: Any, key: str, wanted: re.Pattern[str]) -> tuple[str, ...]:
    """Names of faces or edges."""
    names = [value] if isinstance(value, str) else value or []
    if not isinstance(names, list) or not all(isinstance(name, str) and wanted.fullmatch(name) for name in names):
        kind = wanted.pattern[:4]
        raise InputError(
            "BAD_VALUE", key, f"{quantity.shown(value)} names no {kind.lower()}s; write [{kind}1, {kind}2]"
        )
    return tuple(names)


def _settings(section: Any, part: str) -> list[tuple[str, str, str]]:
    settings = []
    for name, properties in fields.mapping(section, f"{part}.set").items():
        for key, value in fields.mapping(properties, f"{part}.set.{name}").items():
            if isinstance(value, (dict, list)) or value is None:
                raise InputError("BAD_VALUE", f"{part}.set.{name}.{key}", "give one value such as 45 mm")
            settings.append((name, key, quantity.shown(value) if isinstance(value, bool) else str(value)))
    return settings


def _strategy(section: Any) -> LayerParameters:
    kind = fields.mapping(section, "strategy").get("kind", "revolution")
    if not isinstance(kind, str) or kind not in KINDS:
        raise f.unknown_choice("strategy.kind", kind, tuple(KINDS))
    if kind == "solid" and section.get("layers") == "developable":  # which has a name of its own
        kind, section = "developable", {key: value for key, value in section.items() if key != "layers"}
    if kind == "developable":
        section = _with_base(section)
    if kind == "solid":
        section = _with_direction(section)
    factory: type[LayerParameters] = KINDS[kind].parameters
    return fields.build(factory, section, "strategy", also=("kind",))


def _with_fuse(section: Any, part: dict[str, Any]) -> Any:
    """The section of the strategy with what the part says about solids that touch."""
    if "fuse" not in part:
        return section
    if fields.mapping(section, "strategy").get("kind") != "solid":
        raise InputError("NOT_FOR_FAMILY", "part.fuse", "only strategy.kind solid fuses solids; leave it out")
    return {**section, "fuse": part["fuse"]}


def _with_direction(section: dict[str, Any]) -> dict[str, Any]:
    """The section with a direction, a list of three numbers, as their text."""
    direction = section.get("direction")
    if not isinstance(direction, list):
        return section
    numbers = [quantity.read(number, f.NUMBER, "strategy.direction") for number in direction]
    return {**section, "direction": " ".join(f"{number:.15g}" for number in numbers)}


def _with_base(section: dict[str, Any]) -> dict[str, Any]:
    """The section with a base of `auto` left out, and the axis, a point and a direction, as the text of six numbers."""
    base = section.get("base")
    if base == "auto":
        return {key: value for key, value in section.items() if key != "base"}
    if not isinstance(base, dict) or not isinstance(base.get("axis"), list):
        return section
    rows = base["axis"] if all(isinstance(row, list) for row in base["axis"]) else [base["axis"]]
    numbers = [
        quantity.read(number, f.LENGTH if k == 0 and len(rows) == 2 else f.NUMBER, "strategy.base.axis")
        for k, row in enumerate(rows) for number in row
    ]
    return {**section, "base": {**base, "axis": " ".join(f"{number:.15g}" for number in numbers)}}


def _joints(section: Any) -> JointParameters:
    one = fields.mapping(section, "joints").get("compare")
    return fields.build(JointParameters, {**section, "compare": [one]} if isinstance(one, str) else section, "joints")


def _cell(section: Any, path: str) -> CellParameters | None:
    if section is None:
        return None
    section = dict(fields.mapping(section, "cell"))
    if section.get("machine") is not None:
        section["machine"] = _machine(section["machine"], path)
    cell = fields.build(CellParameters, section, "cell")
    if cell.setup in PLANNED_SETUPS:
        raise _not_yet("cell.setup", cell.setup, "part-on-robot, tool-on-robot or rotary-table")
    return cell


def _machine(value: Any, path: str) -> Any:
    """What `cell.machine` says, the path of a file made absolute: of a machine file, or of a URDF with the links meant."""
    key = "cell.machine"
    if isinstance(value, dict) and value:
        fields.known_keys(value, ("file", "base", "tip"), key)
        texts = {name: fields.text(one, f"{key}.{name}").strip() for name, one in value.items() if one is not None}
        if "file" not in texts:
            raise InputError("BAD_VALUE", f"{key}.file", "there is no file; write machine: {file: robot.urdf}")
        meant = urdf_reference.reference(texts["file"])
        if meant is None or len(texts["file"]) != len(meant.file):
            raise InputError(
                "BAD_VALUE", f"{key}.file", f"{texts['file']} is no URDF, which alone has links; write machine: "
                "{file: robot.urdf, base: base_link, tip: tool0}, or the path of a machine file without braces",
            )
        return str(urdf_reference.Reference(absolute(meant.file, path), texts.get("base"), texts.get("tip")))
    if not isinstance(value, str):
        return value
    meant = urdf_reference.reference(value)
    if meant is not None:
        return str(dataclasses.replace(meant, file=absolute(meant.file, path)))
    return absolute(value, path) if os.sep in value or value.lower().endswith(".json") else value


def _program(section: Any) -> ProgramParameters | None:
    if section is None:
        return None
    program = fields.build(ProgramParameters, section, "program")
    return None if program.post == "none" else program


def absolute(file: str, path: str) -> str:
    """`file` as an absolute path; relative ones start at the folder of the job file `path`."""
    return os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(path)), os.path.expanduser(file)))
