# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rotation that a joint path has along the beads of its toolpath, which it may run from other seams or in pieces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from ...geometry.angles import TURN
from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath

PARTED = 0.75  # of a turn, from where a step is one between pieces
END_MM = 1e-6  # mm, of a piece's ends to points of the bead it was cut from


def rotation_along(
    paths: Sequence[BeadPath],
    beads: Sequence[Bead],
    places: Sequence[tuple[int, int]],
    parameters: Mapping[int, Array],
) -> dict[int, Array]:
    """The rotation phi (rad, counted on) at parameters of beads, by their numbers among the beads of a toolpath with their
    places (layer, index): interpolated between the points of the path, 0 where the path has nothing of a bead."""
    pieces: dict[int, list[BeadPath]] = {}
    for piece in paths:
        pieces.setdefault(piece.layer, []).append(piece)
    count = Counter(layer for layer, _ in places)
    found = {}
    for number, parameter in parameters.items():
        (layer, index), bead = places[number], beads[number]
        own = pieces.get(layer, [])
        if len(own) == count[layer]:
            own = [piece for piece in own if piece.index == index]
        else:
            own = [piece for piece in own if _cut_from(bead, piece.bead)]
        found[number] = _along(own, bead, parameter)
    return found


def _cut_from(bead: Bead, piece: Bead) -> bool:
    return all(
        np.linalg.norm(bead.points - piece.points[end], axis=1).min() < END_MM for end in (0, -1)
    )


def _along(pieces: Sequence[BeadPath], bead: Bead, parameter: Array) -> Array:
    span = float(bead.parameter[-1] - bead.parameter[0])
    way = np.sign(span)
    found = np.full(len(parameter), np.nan)
    for piece in pieces:
        known = way * piece.bead.parameter
        # the parameter of a bead that starts elsewhere goes on across the old seam
        for turn in (0.0, span, -span):
            at = way * (parameter + turn)
            inside = np.isnan(found) & (at >= known[0] - 1e-9) & (at <= known[-1] + 1e-9)
            found[inside] = np.interp(at[inside], known, piece.phi)
    there = np.isfinite(found)
    if not there.any():
        return np.zeros(len(parameter))
    rows = np.arange(len(found))
    found = np.asarray(np.interp(rows, rows[there], found[there]))
    if len(pieces) == 1 and abs(float(pieces[0].bead.parameter[0] - bead.parameter[0])) < 1e-9:
        return found
    # pieces and moved seams part the rotation by whole turns, within them it goes on
    step = np.diff(found, prepend=found[:1])
    whole = np.where(np.abs(step) > PARTED * TURN, TURN * np.round(step / TURN), 0.0)
    return np.asarray(found - np.cumsum(whole))
