# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cell as a file of its own, which jobs name: `cell: my-cell.yaml`."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from typing import Any

from ..core.kinematics.arrangement import arrangement_of
from ..core.kinematics.machines import calibration
from ..core.kinematics.urdf import reference as urdf_reference
from ..core.parameters import field as f
from ..core.parameters.cell import CellParameters

SHOWN_APART = ("machine", "nozzle", "external", "world_up", "obstacles", "touched")
PROPOSED = ("deposition_point", "branch")  # where a job file leaves them out


def text(cell: CellParameters, folder: str) -> str:
    """The YAML of a cell, of what is not at its default alone, and of where a robot deposits, each key on a line; lengths in
    mm, angles in degrees. Files within `folder`, where the cell file will be, are named from there."""
    lines = [f"machine: {_machine(cell.machine, folder)}"]
    usual = CellParameters()
    for field in dataclasses.fields(cell):
        value = getattr(cell, field.name)
        is_proposed = field.name in PROPOSED and arrangement_of(cell.setup).free > 0
        if field.name in SHOWN_APART or (value == getattr(usual, field.name) and not is_proposed):
            continue
        lines.append(f"{field.name}: {_format(value, f.spec_of(field).kind)}")
    if cell.nozzle != usual.nozzle:
        entries = [
            f"{field.name}: "
            + (
                _file(str(cell.nozzle.shape), folder)
                if field.name == "shape"
                else _format(getattr(cell.nozzle, field.name), f.spec_of(field).kind)
            )
            for field in dataclasses.fields(cell.nozzle)
            if getattr(cell.nozzle, field.name) != getattr(usual.nozzle, field.name)
        ]
        lines.append(f"nozzle: {{{', '.join(entries)}}}")
    if cell.external:
        lines.append("external:")
        lines += [
            f"- {{machine: {_machine(mechanism.machine, folder)}, pose: {_format(mechanism.pose, f.POSE)}, carries: {mechanism.carries}}}"
            for mechanism in cell.external
        ]
    lines += ["obstacles:"] if cell.obstacles else []
    for body in cell.obstacles:
        what = (
            f"file: {_file(body.file, folder)}"
            if body.box is None
            else f"box: {_format(body.box, f.LENGTH)}"
        )
        name = json.dumps(body.name, ensure_ascii=False)
        lines.append(f"- {{name: {name}, {what}, pose: {_format(body.pose, f.POSE)}}}")
    lines += ["touched:"] if cell.touched else []
    lines += [
        f"- {{part: {_format(point.part, f.LENGTH)}, robot: {_format(point.robot, f.LENGTH)}}}"
        for point in cell.touched
    ]
    if cell.world_up != usual.world_up:
        lines.append(f"world_up: {_format(cell.upward(), f.NUMBER)}")
    return "\n".join(lines) + "\n"


def _format(value: Any, kind: str) -> str:
    """A value in the units of a job file; numbers to what a float holds of them in degrees."""
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (tuple, list)):
        if value and isinstance(value[0], str):
            return f"[{', '.join(value)}]"
        kinds = [kind] * len(value) if len(value) != 6 else [f.LENGTH] * 3 + [f.ANGLE] * 3
        return f"[{', '.join(_format(number, number_kind) for number, number_kind in zip(value, kinds, strict=True))}]"
    return f"{math.degrees(value) if kind == f.ANGLE else value:.15g}"


def _machine(name: str, folder: str) -> str:
    """What names a machine, as a job file says it."""
    measured = calibration.named(name)
    if measured is not None:
        return f"{{name: {_machine(measured.machine, folder)}, calibration: {_file(measured.file, folder)}}}"
    reference = urdf_reference.reference(name)
    if reference is not None:
        links = [
            f", {key}: {json.dumps(link)}"
            for key, link in (("base", reference.base), ("tip", reference.tip))
            if link
        ]
        return f"{{file: {_file(reference.file, folder)}{''.join(links)}}}"
    return _file(name, folder) if os.sep in name or name.lower().endswith(".json") else name


def _file(path: str, folder: str) -> str:
    inside = os.path.relpath(path, folder)
    return json.dumps(path if inside.startswith(os.pardir) else inside, ensure_ascii=False)
