# SPDX-License-Identifier: LGPL-2.1-or-later
"""The torch as a solid: what holds the nozzle, as a file shows it. `cell.nozzle.shape`.

Next to the deposit, up to `cell.nozzle.length`, the nozzle is the cone that build directions are kept clear with; the torch
lies within it there, or is refused. Beyond, it is cylinders as links are, which keep `cell.arm_clearance`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..collision.inside import inside_of
from ..geometry.cylinders import Cylinder, enclosing_cylinder
from ..geometry.obstacles import Body
from ..issues import InputError, Text, Word
from ..parameters.cell import NozzleParameters
from ..types import Array, Integers

Piece = tuple[Array, Integers]

CODE, WHERE = "TORCH", "cell.nozzle.shape"
FARTHEST = 50.0  # mm from the tip to the torch, which a wire is not longer; a file that is farther off has another origin
BEYOND = 0.5  # mm that it may reach beyond its tip: what stands there would be in the deposit
WIDER = 0.05  # mm that it may stand out of the cone, which is what triangles of round sides are off them
MAX_CYLINDERS, SAVED = (
    16,
    0.02,
)  # cylinders, and the share of their volume that one more has to save
# files have Z out of the nozzle, we have the tip's Z into it
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True)
class Torch:
    """body: all of it; cylinders: that hold what of it is beyond the nozzle's cone. In the frame of the tip, Z into it."""

    body: Body
    cylinders: tuple[Cylinder, ...]


def torch(body: Body, nozzle: NozzleParameters) -> Torch:
    """The torch of a file's body. Raises InputError TORCH where it is open, far from its tip, beyond it or wider than the
    nozzle."""
    if inside_of(body) is None:
        raise InputError(
            CODE, WHERE, "it is open, so that nobody knows what is inside of it; give closed solids"
        )
    found = body.move(_TURNED)
    corners = found.corners()
    away = float(np.sqrt(_from_origin(corners).min()))
    if away > FARTHEST:
        raise InputError(
            CODE,
            WHERE,
            "it is {:.4g} mm from its origin, which is where the deposit comes out; put the tip "
            "of the wire or nozzle at the origin of the file, Z out of the nozzle, in mm",
            away,
        )
    low = float(found.vertices[:, 2].min())
    if low < -BEYOND:
        raise InputError(
            CODE,
            WHERE,
            "it reaches {:.4g} mm beyond its origin along Z, where the deposit is; let Z of the "
            "file point out of the nozzle, away from the torch, and put the origin at its tip",
            -low,
        )
    _refuse_wider(found, nozzle)
    return Torch(
        found, tuple(_cylinders(cut(found.vertices, found.triangles, nozzle.length, above=True)))
    )


def _cylinders(whole: Piece) -> list[Cylinder]:
    """Cylinders that hold triangles: these are cut in two, again and again, where that saves most of their volume."""
    pieces = [_Cut(whole)] if len(whole[1]) else []
    while 0 < len(pieces) < MAX_CYLINDERS:
        k = int(np.argmax([one.saved for one in pieces]))
        if pieces[k].saved < SAVED * sum(_volume(one.cylinder) for one in pieces):
            break
        pieces[k : k + 1] = [_Cut(part) for part in pieces[k].parts]
    return [one.cylinder for one in pieces]


class _Cut:
    """A piece with its cylinder, and how it is best cut in two: the parts, and what of the cylinder's volume that saves."""

    def __init__(self, piece: Piece) -> None:
        self.cylinder, self.saved = _about(piece), 0.0
        self.parts: tuple[Piece, ...] = ()
        for parts in _halves(piece):
            saved = _volume(self.cylinder) - sum(_volume(_about(part)) for part in parts)
            if saved > self.saved:
                self.saved, self.parts = saved, parts


def _about(piece: Piece) -> Cylinder:
    return enclosing_cylinder(piece[0][np.unique(piece[1])])


def _volume(cylinder: Cylinder) -> float:
    return cylinder.length * cylinder.radius**2


def _halves(piece: Piece) -> list[tuple[Piece, Piece]]:
    """The ways to cut a piece in two through its middle and its quarters, across each axis."""
    points, found = piece[0][np.unique(piece[1])], []
    for axis in range(3):
        low, high = float(points[:, axis].min()), float(points[:, axis].max())
        for share in (0.25, 0.5, 0.75):
            above, below = (
                cut(*piece, low + share * (high - low), side, axis) for side in (True, False)
            )
            if len(above[1]) and len(below[1]):
                found.append((above, below))
    return found


def cut(points: Array, triangles: Integers, height: float, above: bool, axis: int = 2) -> Piece:
    """What of triangles (m, 3) of points (n, 3) is above, or below, a height along an axis: points and triangles."""
    side = (points[:, axis] - height) * (1.0 if above else -1.0)
    inside = side[triangles] >= 0.0
    count = inside.sum(axis=1)
    kept, more = [triangles[count == 3]], [points]
    start = len(points)
    for number in (1, 2):  # corners that stay
        some = triangles[count == number]
        if not len(some):
            continue
        lone = np.argmax(
            inside[count == number] if number == 1 else ~inside[count == number], axis=1
        )
        a, b, c = (some[np.arange(len(some)), (lone + k) % 3] for k in range(3))
        new = [_crossing(points, side, a, other) for other in (b, c)]
        ab, ac = start + np.arange(len(some)), start + len(some) + np.arange(len(some))
        start += 2 * len(some)
        more += new
        kept += (
            [np.stack([a, ab, ac], axis=1)]
            if number == 1
            else [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
        )
    return np.concatenate(more), np.concatenate(kept)


def _crossing(points: Array, side: Array, one: Integers, other: Integers) -> Array:
    share = (side[one] / (side[one] - side[other]))[:, None]
    return np.asarray(points[one] + share * (points[other] - points[one]))


def _refuse_wider(found: Body, nozzle: NozzleParameters) -> None:
    """The cone is convex: what is within it at the corners of the triangles is so everywhere."""
    points, triangles = cut(found.vertices, found.triangles, nozzle.length, above=False)
    seen = points[np.unique(triangles)]
    if not len(seen):
        return
    tip, away = 0.5 * nozzle.diameter, np.hypot(seen[:, 0], seen[:, 1])
    allowed = tip + np.maximum(seen[:, 2], 0.0) * np.tan(nozzle.half_angle)
    worst = int(np.argmax(away - allowed))
    if away[worst] - allowed[worst] <= WIDER:
        return
    high = np.maximum(seen[:, 2], 1e-3)
    least = float(np.degrees(np.arctan(np.maximum((away - tip) / high, 0.0).max())))
    remedy = (
        Text("cell.nozzle.half_angle of {:.4g} deg at least", np.ceil(least * 10.0 + 0.1) / 10.0)
        if least < 89.0
        else ("a larger cell.nozzle.diameter")
    )
    raise InputError(
        CODE,
        WHERE,
        "{:.4g} mm over its tip it reaches {:.4g} mm from its axis, the nozzle as a cone {:.4g} mm, and it is "
        "the cone that is kept clear of the deposit; give {}, or a smaller cell.nozzle.length",
        seen[worst, 2],
        away[worst],
        allowed[worst],
        Word(remedy),
    )


def _from_origin(corners: Array) -> Array:
    """(m,) squares of the distances of triangles (m, 3, 3) from the origin, mm2."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    square = np.einsum("ij,ij->i", normal, normal)
    foot = (np.einsum("ij,ij->i", a, normal) / np.where(square > 0.0, square, 1.0))[
        :, None
    ] * normal
    sides = [
        np.einsum("ij,ij->i", np.cross(q - p, foot - p), normal)
        for p, q in ((a, b), (b, c), (c, a))
    ]
    over = (np.minimum.reduce(sides) >= 0.0) & (square > 0.0)
    edges = np.minimum.reduce([_of_edge(p, q) for p, q in ((a, b), (b, c), (c, a))])
    return np.where(over, np.einsum("ij,ij->i", foot, foot), edges)


def _of_edge(start: Array, end: Array) -> Array:
    along = end - start
    square = np.einsum("ij,ij->i", along, along)
    share = np.clip(
        -np.einsum("ij,ij->i", start, along) / np.where(square > 0.0, square, 1.0), 0.0, 1.0
    )
    nearest = start + share[:, None] * along
    return np.asarray(np.einsum("ij,ij->i", nearest, nearest))
