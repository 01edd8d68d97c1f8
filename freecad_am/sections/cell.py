# SPDX-License-Identifier: LGPL-2.1-or-later
"""The section `cell` of a job, and saved cells: files of their own that jobs share."""

from __future__ import annotations

import contextlib
from typing import Any

from ..core.geometry.job_files import is_there
from ..core.issues import InputError
from ..core.kinematics import arrangement, proposed_cell
from ..core.kinematics.machines import calibration
from ..core.kinematics.urdf import cell as urdf_cell
from ..core.kinematics.urdf import machine as urdf_machine
from ..core.kinematics.urdf import reference as urdf_reference
from ..core.parameters import field as f
from ..core.parameters.cell import CellParameters
from ..core.parameters.cell_records import (
    EXTERNAL_KEY,
    OBSTACLES_KEY,
    PART,
    SHAPE_KEY,
    TOUCHED_KEY,
    ExternalMechanism,
    NozzleShape,
    Obstacle,
    TouchedPoint,
    usual_name,
)
from ..core.parameters.records import NONE, Point
from ..objects.fields import quantities
from . import fields, paths, tree

PAPERS = "paper"  # limits


def read(section: Any, folder: str) -> CellParameters | None:
    """Read the cell of a job file in `folder`, from its section or the cell file it names.

    Raises InputError about a key of the job or of the cell file.
    """
    section = paths.resolve_cell(section, folder)
    if isinstance(section, str) and section:
        return read_cell_file(section)
    return None if section is None else _parse_section(section)


def read_cell_file(path: str) -> CellParameters:
    """The cell of a file of its own. Raises InputError about a key of it."""
    saved = tree.read(path, "machine: ...", "machine and setup")
    saved.lines = {f"cell.{key}": line for key, line in saved.lines.items()}
    try:
        return _parse_section(paths.resolve_cell(saved.values, paths.folder_of(path)))
    except InputError as error:
        raise saved.locate(error) from None


def _parse_section(section: Any) -> CellParameters:
    """The cell of a section whose files have absolute names."""
    section = dict(fields.mapping(section, "cell"))
    if section.get("machine") is not None:
        section["machine"] = _machine(section["machine"])
    external_axes = section.pop("external", None)
    if external_axes == urdf_machine.WHOLE_CELL:
        section["machine"], section["external"] = urdf_cell.cell_values_of_machine(
            section.get("machine")
        )
    elif external_axes not in (None, []):
        section["external"] = _external(external_axes)
    around = section.pop("obstacles", None)
    if around not in (None, []):
        section["obstacles"] = _obstacles(around)
    if isinstance(section.get("nozzle"), dict) and section["nozzle"].get("shape") not in (
        None,
        {},
        NONE,
    ):
        section["nozzle"] = {**section["nozzle"], "shape": _shape(section["nozzle"]["shape"])}
    if section.get("touched") not in (None, []):
        section["touched"] = _touched(section["touched"])
    cell = fields.build(CellParameters, section, "cell")
    arrangement.planned_of(cell.setup)
    return (
        cell
        if section.get("deposition_point") is not None
        else _proposed(cell, section.get("branch") is not None)
    )


def _proposed(cell: CellParameters, own_branch: bool) -> CellParameters:
    """The cell with the deposition point, or the platform, that suits its machine, and with such a branch but for its own;
    within the limits of the papers their robot works where it did there."""
    if (cell.machine, cell.limits) == (CellParameters().machine, PAPERS):
        return cell
    with contextlib.suppress(InputError):  # errors of the machine are reported when it is planned
        from ..objects import user_machines  # with FreeCAD, which may still be loading

        return proposed_cell.proposed(cell, user_machines.folders(), own_branch)
    return cell


def _machine(value: Any, key: str = "cell.machine") -> Any:
    """What `cell.machine` says as the text that a cell keeps: an id, a machine file, a URDF with the links meant, or one of
    these with the calibration of a robot."""
    if isinstance(value, dict) and value:
        fields.known_keys(value, ("file", "base", "tip", "name", "calibration"), key)
        texts = {
            name: fields.text(text, f"{key}.{name}").strip()
            for name, text in value.items()
            if text is not None
        }
        if "calibration" in texts or "name" in texts:
            if set(texts) != {"name", "calibration"}:
                raise InputError(
                    "BAD_VALUE",
                    "cell.machine",
                    "a calibration needs its machine; write machine: {name: ur-ur10e, "
                    "calibration: my_robot.yaml}",
                )
            return str(calibration.Named(texts["name"], texts["calibration"]))
        if "file" not in texts:
            raise InputError(
                "BAD_VALUE", f"{key}.file", "the file is missing; write machine: {file: robot.urdf}"
            )
        reference = urdf_reference.reference(texts["file"])
        if reference is None or len(texts["file"]) != len(reference.file):
            raise InputError(
                "BAD_VALUE",
                f"{key}.file",
                "{} is not a URDF, the only format with links; write machine: {{file: "
                "robot.urdf, base: base_link, tip: tool0}}, or the path of a machine file "
                "without braces",
                texts["file"],
            )
        return str(urdf_reference.Reference(reference.file, texts.get("base"), texts.get("tip")))
    return value


def _external(value: Any) -> tuple[ExternalMechanism, ...]:
    """The mechanisms of `cell.external`."""
    if not isinstance(value, list):
        raise InputError(
            "BAD_VALUE",
            EXTERNAL_KEY,
            "give a list such as - {machine: motoman-motopos-d500, pose: "
            "[1500, 0, 0, 0, 0, 0], carries: part}",
        )
    return tuple(_one_external(entry, f"{EXTERNAL_KEY}[{k}]") for k, entry in enumerate(value))


def _one_external(value: Any, key: str) -> ExternalMechanism:
    section = fields.mapping(value, key)
    fields.known_keys(section, ("machine", "pose", "carries"), key)
    pose = fields.pose(section.get("pose"), f"{key}.pose")
    machine_text = section.get("machine")
    if not isinstance(machine_text, dict):
        machine_text = fields.text(machine_text, f"{key}.machine").strip()
    machine = _machine(machine_text, f"{key}.machine")
    return ExternalMechanism(machine, pose, section.get("carries") or PART)


def _shape(value: Any) -> NozzleShape:
    """The file of `cell.nozzle.shape`."""
    key = SHAPE_KEY
    if isinstance(value, dict):
        fields.known_keys(value, ("file",), key)
        value, key = value.get("file"), f"{key}.file"
    file = fields.text(value, key)
    if not is_there(file):
        raise InputError(
            "NO_FILE",
            key,
            "file {} does not exist; check the path, which is relative to the file that names it",
            file,
        )
    return NozzleShape(file.strip())


def _touched(value: Any) -> str | tuple[TouchedPoint, ...]:
    """The points of `cell.touched`, or its text."""
    if isinstance(value, str):
        return value
    if not isinstance(value, list):
        raise InputError(
            "BAD_VALUE",
            TOUCHED_KEY,
            "give a list such as - {part: [0, 0, 0], robot: [900.4, 2.1, -99.7]}",
        )
    points = []
    for number, entry in enumerate(value):
        key = f"{TOUCHED_KEY}[{number}]"
        section = fields.mapping(entry, key)
        fields.known_keys(section, ("part", "robot"), key)
        points.append(
            TouchedPoint(
                *(_point(section.get(name), f"{key}.{name}") for name in ("part", "robot"))
            )
        )
    return tuple(points)


def _point(value: Any, key: str) -> Point:
    """Three lengths of a job file."""
    if not isinstance(value, list) or len(value) != 3:
        raise InputError(
            "BAD_VALUE", key, "{} is not a point; give [x, y, z]", quantities.quote(value)
        )
    x, y, z = (quantities.read(number, f.LENGTH, key) for number in value)
    return x, y, z


def _obstacles(value: Any) -> tuple[Obstacle, ...]:
    """The obstacles of `cell.obstacles`."""
    if not isinstance(value, list):
        raise InputError(
            "BAD_VALUE",
            OBSTACLES_KEY,
            "give a list such as - {file: table.step, pose: [0, 0, -200, 0, 0, 0]}",
        )
    return tuple(_obstacle(entry, f"{OBSTACLES_KEY}[{k}]", k + 1) for k, entry in enumerate(value))


def _obstacle(value: Any, key: str, number: int) -> Obstacle:
    section = fields.mapping(value, key)
    fields.known_keys(section, ("name", "file", "box", "pose"), key)
    file, size = "", None
    if section.get("file") is not None:
        file = fields.text(section["file"], f"{key}.file")
        if not is_there(file):
            raise InputError(
                "NO_FILE",
                f"{key}.file",
                "file {} does not exist; check the path, which is relative to the file that "
                "names it",
                file,
            )
    edges = section.get("box")
    if edges is not None:
        if not isinstance(edges, list) or len(edges) != 3:
            raise InputError(
                "BAD_VALUE",
                f"{key}.box",
                "{} is not a box; give its edges along x, y and z such as [1200, 800, 30]",
                quantities.quote(edges),
            )
        width, depth, height = (quantities.read(edge, f.LENGTH, f"{key}.box") for edge in edges)
        size = (width, depth, height)
    name = section.get("name")
    called = usual_name(file, number) if name is None else fields.text(name, f"{key}.name").strip()
    pose = (
        fields.pose(section["pose"], f"{key}.pose")
        if section.get("pose") is not None
        else (0.0,) * 6
    )
    return Obstacle(called, pose, file, size)
