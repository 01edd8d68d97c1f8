# SPDX-License-Identifier: LGPL-2.1-or-later
"""The obstacles of a cell (`cell.obstacles`) and the torch (`cell.nozzle.shape`) as bodies."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np

from ...brep.files import read
from ...brep.files.read import read_mesh, read_shape
from ...brep.files.sandbox import MAX_FILE_MB
from ...brep.shapes.tessellate import body
from ...core.collision.scene import depositing, scene
from ...core.geometry import frames
from ...core.geometry.job_files import digest, is_there, locate
from ...core.geometry.mesh.file_unit import MESHES
from ...core.geometry.obstacles import Body, box, disc
from ...core.issues import InputError
from ...core.kinematics import cell as cells
from ...core.kinematics import torch
from ...core.kinematics.cell import Cell, CellShapes, mounted
from ...core.kinematics.links.bodies import LinkShape
from ...core.kinematics.links.external_links import Mesh, external_links
from ...core.kinematics.machines.machine import Machine
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.cell_records import OBSTACLES_KEY, Obstacle
from ...core.toolpath import Toolpath


def meshes_of(machine: Machine) -> tuple[Mesh | None, ...]:
    """Return (axes + 1) points and triangles of the file of each link, base first.

    None without a readable file: drawing the link reports the reason.
    """
    return tuple(None if shape is None else readable_mesh(shape) for shape in machine.shapes)


def readable_mesh(shape: LinkShape) -> Mesh | None:
    """Return the result of `mesh_of`, or None if the file cannot be read."""
    try:
        return mesh_of(shape)
    except InputError:
        return None


def mesh_of(shape: LinkShape) -> Mesh:
    """Return points (n, 3) mm in the frame of the link and triangles (m, 3) of a user's file.

    Raises InputError naming the file.
    """
    points, triangles = read.triangles(shape.path)
    return shape.scale * points @ shape.pose[:3, :3].T + shape.pose[:3, 3], triangles


CODE = "OBSTACLE"
MOST_TORCHES = 4  # kept
_torches: list[tuple[Body, NozzleParameters, torch.Torch]] = []  # with their inputs


def resolved(settings: CellParameters, toolpath: Toolpath, folders: Sequence[str]) -> Cell:
    """Resolve the cell of a toolpath, with its obstacles.

    Raises the InputErrors of `cells.resolve` and of obstacle files, and OBSTACLE if an obstacle
    touches the nozzle at the first point of the job.
    """
    cell = cells.resolve(settings, toolpath.frame, toolpath.family, folders)
    bodies = bodies_of(settings)
    if not cell.arrangement.links_known:
        return cell
    shapes = CellShapes(bodies, torch_of(settings), external_links(cell.external, readable_mesh))
    cell = dataclasses.replace(cell, shapes=shapes)
    if bodies:
        _refuse_at_start(cell, toolpath)
    return cell


def bodies_of(settings: CellParameters) -> tuple[Body, ...]:
    """Return the obstacles of a cell in world coordinates, mm.

    Raises InputError naming the obstacle and its file.
    """
    return tuple(_body(obstacle) for obstacle in settings.obstacles)


def torch_of(settings: CellParameters) -> torch.Torch | None:
    """Return the torch of a cell, None without a torch.

    Raises InputError TORCH and the errors of its file.
    """
    shape = settings.nozzle.shape
    if shape is None:
        return None
    try:
        return _torch(_read(locate(shape.file)), settings.nozzle)
    except InputError as error:
        raise InputError(error.code, torch.WHERE, error.message) from None


def hashes_of(settings: CellParameters) -> list[str]:
    """Return hashes of the existing files of obstacles and torch. Raises InputError for a file that
    is too large.
    """
    files = [
        (Path(obstacle.file), f"{OBSTACLES_KEY} {obstacle.name}")
        for obstacle in settings.obstacles
        if obstacle.file
    ]
    if settings.nozzle.shape is not None:
        files.append((Path(settings.nozzle.shape.file), torch.WHERE))
    return [digest(file, MAX_FILE_MB, "BAD_FILE", where) for file, where in files if is_there(file)]


def _body(obstacle: Obstacle) -> Body:
    pose = frames.bryant(obstacle.pose)
    if obstacle.box is not None:
        return box(obstacle.box, pose, obstacle.name)
    try:
        body = _read(locate(obstacle.file))
    except InputError as error:
        raise InputError(error.code, f"{OBSTACLES_KEY} {obstacle.name}", error.message) from None
    return dataclasses.replace(body, name=obstacle.name).move(pose)


def _read(file: Path) -> Body:
    """Return the triangles of a file; read it again only if it has changed."""
    try:
        now = file.stat()
    except OSError:
        return _triangles(file)  # raises the reason
    return _known(file, now.st_mtime_ns, now.st_size)


def _torch(body: Body, nozzle: NozzleParameters) -> torch.Torch:
    """Return the torch of a body, cached by the body, which is the same object while its file is
    unchanged.
    """
    for cached_body, cached_nozzle, cached_torch in _torches:
        if cached_body is body and cached_nozzle == nozzle:
            return cached_torch
    cached_torch = torch.torch(body, nozzle)
    _torches.append((body, nozzle, cached_torch))
    del _torches[:-MOST_TORCHES]
    return cached_torch


@lru_cache(maxsize=16)
def _known(file: Path, changed: int, size: int) -> Body:
    return _triangles(file)


def _triangles(file: Path) -> Body:
    source = read_mesh(file) if file.suffix.lower() in MESHES else read_shape(file)
    return body(source, file.name)


def _refuse_at_start(cell: Cell, toolpath: Toolpath) -> None:
    """Raise InputError OBSTACLE if an obstacle touches the nozzle at the first point, on any
    machine.
    """
    bead = next(bead for _, _, bead in toolpath)
    point, axis = bead.points[:1], bead.tool[:1]
    if cell.torch_stands:
        to_world = frames.inverse(cell.machine.base) @ cell.poses.station
        point, axis, bodies = to_world[None, :3, 3], to_world[None, :3, 2], cell.shapes.obstacles
    else:
        bodies = cell.in_part()
    nozzle = depositing(
        0.5 * cell.nozzle.diameter, float(np.tan(cell.nozzle.half_angle)), cell.nozzle.length, 0.0
    )
    for obstacle in bodies:
        if scene((obstacle,), point, nozzle.reach).find_touching(nozzle, point, axis).any():
            raise InputError(
                CODE,
                f"{OBSTACLES_KEY} {obstacle.name}",
                "the obstacle touches the nozzle at the first point of the job in every arm "
                "configuration; move the obstacle or the deposition point, and check that the "
                "pose is in the manufacturer's base frame and the file in mm",
            )


# ---- The platform that a cell has, as a body in part coordinates


def platforms(cell: CellParameters | None, toolpath: Toolpath) -> tuple[Body, ...]:
    """Return the platform under a toolpath; empty without a cell or platform."""
    if cell is None or cell.platform_diameter <= 0.0:
        return ()
    return (disc(cell.platform_diameter, mounted(cell, toolpath.frame, toolpath.family)),)
