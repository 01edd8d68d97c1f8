# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job file: read, checked and turned into the parameters of every stage, before any work starts."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass, field
from typing import Any

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import calibration, urdf_reference
from freecad_am.core.parameters import external
from freecad_am.core.parameters import field as f
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import LayerParameters
from freecad_am.core.strategies.sequence import BY_FEATURE, BY_HEIGHT

from . import fields, quantity, tree
from .job_features import JobFeature, one_feature, process_of_all, several
from .part_source import PartSource, absolute

SEQUENCES = (BY_FEATURE, BY_HEIGHT)
PLANNED_SETUPS = ("tool-on-robot+positioner",)
SECTIONS = (
    "version", "name", "part", "substrate", "fixtures", "strategy", "build_direction", "features", "sequence", "cell",
    "joints", "process", "program",
)
_LONGEST_NAME = 200  # bytes, so that <name>.FCStd fits every file system


@dataclass(frozen=True)
class Job:
    """A checked job. features: one or more, in the order of the file; sequence: in which they are deposited. process: of the
    program; features may differ from it. `cell` or `program` None: the stages that need them are left out."""

    path: str
    name: str
    features: tuple[JobFeature, ...]
    sequence: str
    joints: JointParameters
    process: ProcessParameters
    cell: CellParameters | None
    program: ProgramParameters | None
    tree: tree.Tree = field(repr=False, compare=False)

    @property
    def part(self) -> PartSource:
        """The part of the first feature."""
        return self.features[0].part

    @property
    def substrate(self) -> PartSource | None:
        """The substrate of the first feature."""
        return self.features[0].substrate

    @property
    def fixtures(self) -> tuple[PartSource, ...]:
        """The fixtures of the first feature."""
        return self.features[0].fixtures

    @property
    def strategy(self) -> LayerParameters:
        """The strategy of the first feature."""
        return self.features[0].strategy

    @property
    def build_direction(self) -> BuildDirectionParameters:
        """The build direction of the first feature."""
        return self.features[0].build_direction

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
    name = _name(values.get("name"), path)
    if values.get("features") is None:
        if values.get("sequence") is not None:
            raise InputError("BAD_VALUE", "sequence", "there is one feature alone; leave it out, or list features")
        features: tuple[JobFeature, ...] = (one_feature(values, name, path),)
        process = features[0].process
    else:
        process = process_of_all(values.get("process") or {}, path)
        features = several(values, path, job)
    sequence = values.get("sequence") or SEQUENCES[0]
    if sequence not in SEQUENCES:
        raise f.unknown_choice("sequence", sequence, SEQUENCES)
    return Job(
        path=path,
        name=name,
        features=features,
        sequence=sequence,
        joints=_joints(values.get("joints") or {}),
        process=process,
        cell=_cell(values.get("cell"), path),
        program=_program(values.get("program")),
        tree=job,
    )


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


def _joints(section: Any) -> JointParameters:
    one = fields.mapping(section, "joints").get("compare")
    return fields.build(JointParameters, {**section, "compare": [one]} if isinstance(one, str) else section, "joints")


def _cell(section: Any, path: str) -> CellParameters | None:
    if section is None:
        return None
    section = dict(fields.mapping(section, "cell"))
    if section.get("machine") is not None:
        section["machine"] = _machine(section["machine"], path)
    external_axes = section.pop("external", None)
    if external_axes not in (None, []):
        section["external"] = _external(external_axes, path)
    if isinstance(section.get("world_up"), list):
        numbers = [quantity.read(number, f.NUMBER, "cell.world_up") for number in section["world_up"]]
        section["world_up"] = " ".join(f"{number:.15g}" for number in numbers)
    cell = fields.build(CellParameters, section, "cell")
    if cell.setup in PLANNED_SETUPS:
        raise InputError(
            "NOT_YET", "cell.setup", f"{cell.setup!r} is not supported yet; use part-on-robot, tool-on-robot or rotary-table"
        )
    return cell


def _machine(value: Any, path: str) -> Any:
    """What `cell.machine` says, the path of a file made absolute: of a machine file, or of a URDF with the links meant."""
    key = "cell.machine"
    if isinstance(value, dict) and value:
        fields.known_keys(value, ("file", "base", "tip", "name", "calibration"), key)
        texts = {name: fields.text(one, f"{key}.{name}").strip() for name, one in value.items() if one is not None}
        if "calibration" in texts or "name" in texts:
            return _calibrated(texts, path)
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
    measured = calibration.named(value)
    if measured is not None:
        return _calibrated({"name": measured.machine, "calibration": measured.file}, path)
    meant = urdf_reference.reference(value)
    if meant is not None:
        return str(dataclasses.replace(meant, file=absolute(meant.file, path)))
    return absolute(value, path) if os.sep in value or value.lower().endswith(".json") else value


def _calibrated(texts: dict[str, str], path: str) -> str:
    """A machine with the calibration of one robot as the text that a cell keeps."""
    if set(texts) != {"name", "calibration"}:
        raise InputError("BAD_VALUE", "cell.machine", "a calibration is that of a machine; write machine: {name: ur-ur10e, "
                         "calibration: my_robot.yaml}")
    return str(calibration.Named(_machine(texts["name"], path), absolute(texts["calibration"], path)))


def _external(value: Any, path: str) -> str:
    """What `cell.external` says as the text that a cell keeps, paths of files made absolute."""
    if not isinstance(value, list):
        raise InputError("BAD_VALUE", external.WHERE, "give a list such as - {machine: motoman-motopos-d500, pose: "
                         "[1500, 0, 0, 0, 0, 0], carries: part}")
    return f"{external.MORE} ".join(str(_one_external(one, f"{external.WHERE}[{k}]", path)) for k, one in enumerate(value))


def _one_external(value: Any, key: str, path: str) -> external.External:
    section = fields.mapping(value, key)
    fields.known_keys(section, ("machine", "pose", "carries"), key)
    pose = section.get("pose")
    if not isinstance(pose, list) or len(pose) != 6:
        raise InputError("BAD_VALUE", f"{key}.pose", f"{quantity.shown(pose)} is not a pose; give [x, y, z, RX, RY, RZ]")
    kinds = (f.LENGTH,) * 3 + (f.ANGLE,) * 3
    numbers = [quantity.read(number, kind, f"{key}.pose") for number, kind in zip(pose, kinds, strict=True)]
    x, y, z, *angles = numbers
    machine = fields.text(section.get("machine"), f"{key}.machine").strip()
    if os.sep in machine or machine.lower().endswith(".json"):
        machine = absolute(machine, path)
    return external.External(machine, (x, y, z, *angles), section.get("carries") or external.PART)


def _program(section: Any) -> ProgramParameters | None:
    if section is None:
        return None
    program = fields.build(ProgramParameters, section, "program")
    return None if program.post == "none" else program
