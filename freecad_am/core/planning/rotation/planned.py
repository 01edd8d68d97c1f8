# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rotation of a joint path along its toolpath beads, also after seam moves and splits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from ...geometry.frames import TURN
from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath

PARTED = 0.75  # turns; a larger step of the rotation is a jump between pieces
END_MM = 1e-6  # mm; maximum distance of a piece's ends from points of the original bead


def rotation_along(
    paths: Sequence[BeadPath],
    beads: Sequence[Bead],
    bead_ids: Sequence[tuple[int, int]],
    parameters: Mapping[int, Array],
) -> dict[int, Array]:
    """Return the rotation of a joint path along beads of its toolpath.

    Parameters
    ----------
    paths : sequence of BeadPath
        The paths; their seams may have moved, and they may be pieces.
    beads : sequence of Bead
        The beads of the toolpath.
    bead_ids : Sequence[tuple[int, int]]
        Layer and index of each bead.
    parameters : mapping of int to Array
        Bead parameters (n,) by bead index.

    Returns
    -------
    dict of int to (n,) array
        Rotation phi, rad, interpolated between path points; 0 for a bead that the path does not
        contain.
    """
    paths_by_layer: dict[int, list[BeadPath]] = {}
    for path in paths:
        paths_by_layer.setdefault(path.layer, []).append(path)
    count = Counter(layer for layer, _ in bead_ids)
    rotations = {}
    for number, parameter in parameters.items():
        (layer, index), bead = bead_ids[number], beads[number]
        bead_paths = paths_by_layer.get(layer, [])
        if len(bead_paths) == count[layer]:
            bead_paths = [path for path in bead_paths if path.index == index]
        else:
            bead_paths = [path for path in bead_paths if _cut_from(bead, path.bead)]
        rotations[number] = _rotation_along(bead_paths, bead, parameter)
    return rotations


def _cut_from(bead: Bead, section: Bead) -> bool:
    return all(
        np.linalg.norm(bead.points - section.points[end], axis=1).min() < END_MM for end in (0, -1)
    )


def _rotation_along(bead_paths: Sequence[BeadPath], bead: Bead, parameter: Array) -> Array:
    span = float(bead.parameter[-1] - bead.parameter[0])
    sense = np.sign(span)
    rotation = np.full(len(parameter), np.nan)
    for path in bead_paths:
        path_parameter = sense * path.bead.parameter
        # the parameter of a bead with a moved seam continues across the original seam
        for turn in (0.0, span, -span):
            position = sense * (parameter + turn)
            inside = (
                np.isnan(rotation)
                & (position >= path_parameter[0] - 1e-9)
                & (position <= path_parameter[-1] + 1e-9)
            )
            rotation[inside] = np.interp(position[inside], path_parameter, path.phi)
    known_rows = np.isfinite(rotation)
    if not known_rows.any():
        return np.zeros(len(parameter))
    rows = np.arange(len(rotation))
    rotation = np.asarray(np.interp(rows, rows[known_rows], rotation[known_rows]))
    if (
        len(bead_paths) == 1
        and abs(float(bead_paths[0].bead.parameter[0] - bead.parameter[0])) < 1e-9
    ):
        return rotation
    # the rotation jumps by whole turns at pieces and moved seams; elsewhere it is continuous
    step = np.diff(rotation, prepend=rotation[:1])
    whole_turns = np.where(np.abs(step) > PARTED * TURN, TURN * np.round(step / TURN), 0.0)
    return np.asarray(rotation - np.cumsum(whole_turns))
