# SPDX-License-Identifier: LGPL-2.1-or-later
"""The torch, which holds the nozzle, as a solid from a file (`cell.nozzle.shape`).

Up to `cell.nozzle.length` from the tip, the nozzle is the cone that build directions keep clear. A
torch that extends outside this cone there is rejected. Beyond this length, cylinders enclose the
torch and keep `cell.arm_clearance`, like robot links.
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
# mm; maximum distance from the tip to the torch: no wire is longer, so the file has a wrong origin
MAX_TIP_DISTANCE_MM = 50.0
MAX_BEYOND_TIP_MM = (
    0.5  # mm; maximum extent beyond the tip, where the torch would be inside the deposit
)
MAX_EXCESS_MM = 0.05  # mm; maximum excess over the cone, the error of triangles on round surfaces
MAX_CYLINDERS, MIN_SAVED_SHARE = (
    16,
    0.02,
)  # maximum number of cylinders, and minimum fraction of their volume that another cylinder saves
# in files Z points out of the nozzle, in our tip frame into the nozzle
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True)
class Torch:
    """The torch in the tip frame, with Z into the torch.

    body: the whole torch. cylinders: around its part beyond the nozzle cone.
    """

    body: Body
    cylinders: tuple[Cylinder, ...]


def torch(body: Body, nozzle: NozzleParameters) -> Torch:
    """Return the torch of a file body.

    Raises InputError TORCH if the body is open, too far from its origin, extends beyond the tip or
    is wider than the nozzle.
    """
    if inside_of(body) is None:
        raise InputError(
            CODE, WHERE, "the shape is open, so its inside is undefined; give closed solids"
        )
    turned_body = body.move(_TURNED)
    corners = turned_body.corners()
    distance = float(np.sqrt(_from_origin(corners).min()))
    if distance > MAX_TIP_DISTANCE_MM:
        raise InputError(
            CODE,
            WHERE,
            "the torch is {:.4g} mm away from its origin, the point where the material exits; "
            "put the tip of the wire or nozzle at the origin of the file, with Z pointing out of "
            "the nozzle, in mm",
            distance,
        )
    low = float(turned_body.vertices[:, 2].min())
    if low < -MAX_BEYOND_TIP_MM:
        raise InputError(
            CODE,
            WHERE,
            "the torch extends {:.4g} mm beyond its origin along Z, into the deposit; point Z of "
            "the file out of the nozzle, away from the torch, with the origin at the tip",
            -low,
        )
    _refuse_wider(turned_body, nozzle)
    return Torch(
        turned_body,
        tuple(
            _cylinders(cut(turned_body.vertices, turned_body.triangles, nozzle.length, above=True))
        ),
    )


def _cylinders(all_triangles: Piece) -> list[Cylinder]:
    """Return cylinders that enclose triangles.

    Pieces are cut in two repeatedly, each time where the cut saves the most volume.
    """
    cut_pieces = [_Cut(all_triangles)] if len(all_triangles[1]) else []
    while 0 < len(cut_pieces) < MAX_CYLINDERS:
        k = int(np.argmax([cut_piece.saved for cut_piece in cut_pieces]))
        if cut_pieces[k].saved < MIN_SAVED_SHARE * sum(
            _volume(cut_piece.cylinder) for cut_piece in cut_pieces
        ):
            break
        cut_pieces[k : k + 1] = [_Cut(half) for half in cut_pieces[k].parts]
    return [cut_piece.cylinder for cut_piece in cut_pieces]


class _Cut:
    """A piece with its enclosing cylinder and its best cut in two.

    parts: the halves. saved: cylinder volume that the cut saves.
    """

    def __init__(self, mesh: Piece) -> None:
        self.cylinder, self.saved = _about(mesh), 0.0
        self.parts: tuple[Piece, ...] = ()
        for halves in _halves(mesh):
            saved = _volume(self.cylinder) - sum(_volume(_about(half)) for half in halves)
            if saved > self.saved:
                self.saved, self.parts = saved, halves


def _about(mesh: Piece) -> Cylinder:
    return enclosing_cylinder(mesh[0][np.unique(mesh[1])])


def _volume(cylinder: Cylinder) -> float:
    return cylinder.length * cylinder.radius**2


def _halves(mesh: Piece) -> list[tuple[Piece, Piece]]:
    """Return the cuts of a piece in two at 1/4, 1/2 and 3/4 of its extent along each axis."""
    points, cuts = mesh[0][np.unique(mesh[1])], []
    for axis in range(3):
        low, high = float(points[:, axis].min()), float(points[:, axis].max())
        for share in (0.25, 0.5, 0.75):
            above, below = (
                cut(*mesh, low + share * (high - low), side, axis) for side in (True, False)
            )
            if len(above[1]) and len(below[1]):
                cuts.append((above, below))
    return cuts


def cut(points: Array, triangles: Integers, height: float, above: bool, axis: int = 2) -> Piece:
    """Cut triangles at a height and return the part above or below.

    Parameters
    ----------
    points : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Vertex indices.
    height : float
        Height of the cut, mm.
    above : bool
        Whether to keep the part above.
    axis : int, optional
        Axis of the height, 0 to 2.

    Returns
    -------
    points : (k, 3) array
        Vertices, and intersections of edges with the height.
    triangles : (l, 3) int array
        Remaining triangles.
    """
    side = (points[:, axis] - height) * (1.0 if above else -1.0)
    inside = side[triangles] >= 0.0
    count = inside.sum(axis=1)
    triangle_blocks, point_blocks = [triangles[count == 3]], [points]
    start = len(points)
    for number in (1, 2):  # number of vertices to keep
        crossing = triangles[count == number]
        if not len(crossing):
            continue
        lone = np.argmax(
            inside[count == number] if number == 1 else ~inside[count == number], axis=1
        )
        a, b, c = (crossing[np.arange(len(crossing)), (lone + k) % 3] for k in range(3))
        new = [_crossing(points, side, a, end) for end in (b, c)]
        ab, ac = start + np.arange(len(crossing)), start + len(crossing) + np.arange(len(crossing))
        start += 2 * len(crossing)
        point_blocks += new
        triangle_blocks += (
            [np.stack([a, ab, ac], axis=1)]
            if number == 1
            else [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
        )
    return np.concatenate(point_blocks), np.concatenate(triangle_blocks)


def _crossing(points: Array, side: Array, inner: Integers, outer: Integers) -> Array:
    share = (side[inner] / (side[inner] - side[outer]))[:, None]
    return np.asarray(points[inner] + share * (points[outer] - points[inner]))


def _refuse_wider(torch_body: Body, nozzle: NozzleParameters) -> None:
    """Reject a torch that extends outside the nozzle cone.

    The cone is convex, so testing the vertices of the triangles is enough.
    """
    points, triangles = cut(torch_body.vertices, torch_body.triangles, nozzle.length, above=False)
    corners = points[np.unique(triangles)]
    if not len(corners):
        return
    tip, radii = 0.5 * nozzle.diameter, np.hypot(corners[:, 0], corners[:, 1])
    allowed = tip + np.maximum(corners[:, 2], 0.0) * np.tan(nozzle.half_angle)
    worst = int(np.argmax(radii - allowed))
    if radii[worst] - allowed[worst] <= MAX_EXCESS_MM:
        return
    high = np.maximum(corners[:, 2], 1e-3)
    min_angle = float(np.degrees(np.arctan(np.maximum((radii - tip) / high, 0.0).max())))
    remedy = (
        Text(
            "cell.nozzle.half_angle of at least {:.4g} deg", np.ceil(min_angle * 10.0 + 0.1) / 10.0
        )
        if min_angle < 89.0
        else ("a larger cell.nozzle.diameter")
    )
    raise InputError(
        CODE,
        WHERE,
        "{:.4g} mm above its tip the torch extends {:.4g} mm from its axis, but the nozzle cone "
        "only {:.4g} mm, and only the cone is checked against the deposit; set {}, or a smaller "
        "cell.nozzle.length",
        corners[worst, 2],
        radii[worst],
        allowed[worst],
        Word(remedy),
    )


def _from_origin(corners: Array) -> Array:
    """Return squared distances (m,), mm^2, of triangles (m, 3, 3) from the origin."""
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
    edges = np.minimum.reduce([_edge_distance(p, q) for p, q in ((a, b), (b, c), (c, a))])
    return np.where(over, np.einsum("ij,ij->i", foot, foot), edges)


def _edge_distance(start: Array, end: Array) -> Array:
    along = end - start
    square = np.einsum("ij,ij->i", along, along)
    share = np.clip(
        -np.einsum("ij,ij->i", start, along) / np.where(square > 0.0, square, 1.0), 0.0, 1.0
    )
    nearest = start + share[:, None] * along
    return np.asarray(np.einsum("ij,ij->i", nearest, nearest))
