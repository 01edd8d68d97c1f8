# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes that a user gave the links of a machine, as triangles in the frames of the links."""

from __future__ import annotations

from ...brep.files import looks
from ...core.issues import InputError
from ...core.kinematics.links.cylinders import Mesh
from ...core.kinematics.links.shape import LinkShape
from ...core.kinematics.machines.machine import Machine


def meshes_of(machine: Machine) -> tuple[Mesh | None, ...]:
    """(axes + 1) points and triangles of each link's file, base first; None without a readable
    file: drawing the link reports the reason.
    """
    return tuple(None if shape is None else readable_mesh(shape) for shape in machine.shapes)


def readable_mesh(shape: LinkShape) -> Mesh | None:
    """As `mesh_of`, or None if the file cannot be read."""
    try:
        return mesh_of(shape)
    except InputError:
        return None


def mesh_of(shape: LinkShape) -> Mesh:
    """Points (n, 3) mm in the frame of the link and triangles (m, 3) of a user's file. Raises InputError naming it."""
    points, triangles = looks.triangles(shape.path)
    return shape.scale * points @ shape.pose[:3, :3].T + shape.pose[:3, 3], triangles
