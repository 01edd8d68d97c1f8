# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where closed fronts begin: at an angle about the middle line of the wall, so that seams follow each other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.walls.surface import dot
from ...types import Array
from .front_tree import Piece

FINER = 4  # places per arc of a front at which its angle is taken
HALVINGS = 40
ACROSS = 0.1  # of unit length; an axis whose X is shorter is seen from Y


class Middle(NamedTuple):
    """The middle of a closed front: its centre (3,), unit axis (3,) about which it turns counter-clockwise, the direction
    (3,) from which angles are taken, and where the front begins (3,)."""

    centre: Array
    axis: Array
    reference: Array
    start: Array


def seam(piece: Piece, angle: float, middles: dict[int, Middle]) -> float:
    """The parameter at which a closed front begins, at `angle` (rad) about its middle.

    The angle's zero is X of the part, or Y where X is along the axis, at the first front; from there on it is carried with
    the smallest rotation that takes one axis to the next. Of several positions at that angle the one nearest to the seam
    below is taken. middles: of the fronts below by id; the new one is added.
    """
    curve = piece.curve
    w = curve.refined(FINER)[:-1]
    points = curve.at(w)[0]
    ahead = np.roll(points, -1, axis=0)
    length = np.linalg.norm(ahead - points, axis=1)
    centre = (length[:, None] * 0.5 * (points + ahead)).sum(axis=0) / length.sum()
    axis = np.cross(points - centre, ahead - centre).sum(axis=0)
    axis /= np.linalg.norm(axis)
    below = next((middles[id(parent)] for parent in piece.parents if id(parent) in middles), None)
    reference = _carry_reference(below, axis) if below is not None else _reference(axis)
    # the front relative to a frame that is turned by the angle: the seam crosses its X from below
    x = np.cos(angle) * reference + np.sin(angle) * np.cross(axis, reference)
    y = np.cross(axis, x)
    sideways = (points - centre) @ y
    next_sideways = np.roll(sideways, -1)
    out = (points - centre) @ x
    crossing = np.flatnonzero((sideways <= 0.0) & (next_sideways > 0.0) & (out > 0.0))
    if not len(crossing):
        crossing = np.array(
            [int(np.argmax(out / np.maximum(np.linalg.norm(points - centre, axis=1), 1e-300)))]
        )
    if below is not None:
        crossing = crossing[
            [int(np.argmin(np.linalg.norm(points[crossing] - below.start, axis=1)))]
        ]
    k = int(crossing[0])
    low, high = w[k], w[k + 1] if k + 1 < len(w) else curve.w[-1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        side = float((curve.at(np.array([middle]))[0][0] - centre) @ y)
        low, high = (middle, high) if side <= 0.0 else (low, middle)
    start = 0.5 * (low + high)
    middles[id(piece)] = Middle(centre, axis, reference, curve.at(np.array([start]))[0][0])
    return float(start)


def _reference(axis: Array) -> Array:
    for direction in np.eye(3)[:2]:
        flat = direction - (direction @ axis) * axis
        length = np.linalg.norm(flat)
        if length > ACROSS:
            return np.asarray(flat / length)
    raise AssertionError("an axis is along X or along Y, not both")


def _carry_reference(below: Middle, axis: Array) -> Array:
    """The reference of the front below, turned with the axis."""
    cosine = float(below.axis @ axis)
    if cosine < -1.0 + ACROSS:
        return _reference(axis)
    turn = np.cross(below.axis, axis)
    carried = (
        cosine * below.reference
        + np.cross(turn, below.reference)
        + turn * (turn @ below.reference) / (1.0 + cosine)
    )
    flat = carried - (carried @ axis) * axis
    return np.asarray(flat / np.sqrt(dot(flat, flat)))
