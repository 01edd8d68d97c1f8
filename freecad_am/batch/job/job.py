# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read a job file, check it, and convert it to the parameters of every stage before any work
starts.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from ...core.issues import NOTE, WARNING, InputError, Issue, Text
from ...core.kinematics.arrangement import arrangement_of
from ...core.parameters import field as f
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters
from ...core.parameters.joints import JointParameters
from ...core.parameters.place import PlaceParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.parameters.strategy import LayerParameters
from ...core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ...objects.fields import quantities
from ...posts.catalogue import motion_written
from ...sections import cell as job_cell
from ...sections import fields, paths, tree
from .feature_sections import process_of
from .features import JobFeature, one_feature, several
from .part_source import PartSource

SEQUENCES = (BY_FEATURE, BY_HEIGHT)
SECTIONS = (
    "version",
    "name",
    "part",
    "substrate",
    "fixtures",
    "strategy",
    "build_direction",
    "features",
    "sequence",
    "cell",
    "joints",
    "process",
    "settings",
    "program",
    "place",
)
_LONGEST_NAME = 200  # bytes, so that <name>.FCStd fits every file system


@dataclass(frozen=True)
class Job:
    """A checked job.

    features: one or more, in the order of the file. sequence: order of deposition. process: process
    of the program; features may have their own. `cell` or `program` None: the stages that need it
    are omitted. place: poses that the command `place` tries.
    """

    path: str
    name: str
    features: tuple[JobFeature, ...]
    sequence: str
    joints: JointParameters
    process: ProcessParameters
    cell: CellParameters | None
    program: ProgramParameters | None
    tree: tree.Tree = field(repr=False, compare=False)
    place: PlaceParameters = field(default_factory=PlaceParameters)

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
        """The absolute folder of the job file, to which relative paths refer."""
        return paths.folder_of(self.path)


def read_job(path: str) -> Job:
    """Read the job of a file. Raises InputError naming file, key and remedy."""
    return from_tree(tree.read(path), path)


@dataclass(frozen=True)
class WithoutPart:
    """The content of a job file without a part: cell, joints and program."""

    cell: CellParameters
    joints: JointParameters
    program: ProgramParameters | None


def read_without_part(path: str) -> WithoutPart:
    """Read cell, joints and program of a job file without a part.

    Of other sections only the keys are checked. Raises InputError naming file, key and remedy, and
    NO_CELL without a cell.
    """
    saved = tree.read(path, "cell: {machine: ...}", "cell")
    try:
        folder = paths.folder_of(path)
        values = paths.resolve_job(saved.values, folder)
        fields.known_keys(values, SECTIONS, "")
        cell = job_cell.read(values.get("cell"), folder)
        if cell is None:
            raise InputError(
                "NO_CELL", "cell", "the job has no cell to run a program in; add the section `cell`"
            )
        return WithoutPart(
            cell, _joints(values.get("joints") or {}), _program(values.get("program"), cell)
        )
    except InputError as error:
        raise saved.locate(error) from None


def from_tree(job: tree.Tree, path: str) -> Job:
    """Convert the values read from `path` to a job; a row of a batch table may have changed values."""
    try:
        return _checked(job, path)
    except InputError as error:
        raise job.locate(error) from None


def _checked(job: tree.Tree, path: str) -> Job:
    folder = paths.folder_of(path)
    values = paths.resolve_job(job.values, folder)
    fields.known_keys(values, SECTIONS, "")
    version = values.get("version", 1)
    if version != 1 or isinstance(version, bool):
        raise InputError(
            "BAD_VERSION",
            "version",
            "{} is not understood; write version: 1",
            quantities.quote(version),
        )
    name = _name(values.get("name"), path)
    if values.get("features") is None:
        if values.get("sequence") is not None:
            raise InputError(
                "BAD_VALUE",
                "sequence",
                "`sequence` needs `features`; remove `sequence`, or list the features",
            )
        features: tuple[JobFeature, ...] = (one_feature(values, name),)
        process = features[0].process
    else:
        process = process_of(values.get("process") or {})
        features = several(values, job)
    cell = job_cell.read(values.get("cell"), folder)
    program = _program(values.get("program"), cell)
    scan = next((feature.scan for feature in features if feature.scan is not None), None)
    if scan is not None and len(features) > 1:
        raise InputError(
            "NOT_YET",
            "substrate.scan",
            "several features in one job cannot be fitted to a scan yet; remove the scan, or put "
            "each feature in its own job",
        )
    if scan is not None and program is not None:
        program = _resumed(program, scan.parameters.first)
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
        cell=cell,
        program=program,
        tree=job,
        place=fields.build(PlaceParameters, values.get("place") or {}, "place"),
    )


def _name(name: Any, path: str) -> str:
    if name is None:
        name = os.path.splitext(os.path.basename(path))[0]
    if isinstance(name, (int, float)) and not isinstance(name, bool):
        name = str(name)
    name = fields.text(name, "name").strip()
    if "/" in name or "\\" in name or name.startswith(".") or not name.isprintable():
        raise InputError(
            "BAD_NAME",
            "name",
            "{} is used in file names; use no slash, control character or leading dot",
            quantities.quote(name),
        )
    if len(name.encode()) > _LONGEST_NAME:
        raise InputError(
            "BAD_NAME",
            "name",
            "the name is too long for a file; use at most {} letters",
            _LONGEST_NAME,
        )
    return name


def _joints(section: Any) -> JointParameters:
    comparison = fields.mapping(section, "joints").get("compare")
    return fields.build(
        JointParameters,
        {**section, "compare": [comparison]} if isinstance(comparison, str) else section,
        "joints",
    )


def _resumed(program: ProgramParameters, layer: int) -> ProgramParameters:
    """Return the program with its start at the given layer, unless the program sets a start itself.

    The layers below exist already.
    """
    if program.start_at.layer or program.start_at.bead:
        return program
    return replace(program, start_at=replace(program.start_at, layer=layer))


def _program(section: Any, cell: CellParameters | None) -> ProgramParameters | None:
    """Convert the section `program`; without a motion, choose one that the post supports for the
    setup.
    """
    if section is None:
        return None
    program = fields.build(ProgramParameters, section, "program")
    if program.post == "none":
        return None
    if cell is None or fields.mapping(section, "program").get("motion") is not None:
        return program
    return replace(program, motion=motion_written(program.post, cell.setup))


NO_EFFECT = "NO_EFFECT"


def unused_key_issues(job: Job) -> list[Issue]:
    """Return notes on keys that the job file gives but that have no effect."""
    if job.cell is None:
        return list(_issues_without_cell(job))
    return list(_issues_of_cell(job))


def _issues_without_cell(job: Job) -> Iterator[Issue]:
    if job.program is not None:
        message = Text(
            "program: the job has no cell, so no program is written; add the section `cell`, or "
            "remove `program`"
        )
        yield Issue(WARNING, NO_EFFECT, message)
    if job.tree.values.get("joints"):
        message = Text(
            "joints: the job has no cell, so no joint path is planned; add the section `cell`, "
            "or remove `joints`"
        )
        yield Issue(NOTE, NO_EFFECT, message)


def _issues_of_cell(job: Job) -> Iterator[Issue]:
    assert job.cell is not None
    arrangement = arrangement_of(job.cell.setup)
    joints, cell = (job.tree.values.get(section) for section in ("joints", "cell"))
    if _gives(joints, "rz") and "constant" not in (job.joints.method, *job.joints.compare):
        message = Text(
            "joints.rz has no effect with joints.method: {}; remove joints.rz, or use the method "
            "constant",
            job.joints.method,
        )
        yield Issue(WARNING, NO_EFFECT, message)
    fixed_part = not arrangement.carries_part and not job.cell.external
    if fixed_part and _gives(cell, "platform"):
        message = Text(
            "cell.platform has no effect with cell.setup: {}: cell.deposition_point is the pose "
            "of the platform; remove cell.platform",
            job.cell.setup,
        )
        yield Issue(WARNING, NO_EFFECT, message)
    nozzle = cell.get("nozzle") if isinstance(cell, dict) else None
    if arrangement.holds_part and _gives(nozzle, "tool"):
        message = Text(
            "cell.nozzle.tool has no effect with cell.setup: {}: cell.deposition_point is the "
            "pose of the nozzle; remove cell.nozzle.tool",
            job.cell.setup,
        )
        yield Issue(WARNING, NO_EFFECT, message)


def _gives(section: Any, key: str) -> bool:
    """Whether a section of the file gives a value for a key."""
    return isinstance(section, dict) and section.get(key) is not None
