# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conversion between Denavit-Hartenberg tables, standard or modified, and chains of joint frames.

Standard (Denavit, Hartenberg 1955; Spong): link = Rot(z, theta) Trans(z, d) Trans(x, a)
Rot(x, alpha). Modified (Craig): link = Rot(x, alpha) Trans(x, a) Rot(z, theta) Trans(z, d). Both
need a pose before the first row and a pose after the last row, which the rows cannot express.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry import frames
from ...issues import InputError, Text
from ...types import Array
from ..chain import Chain

# rad; axes closer to parallel count as parallel, because their common normal would be undefined
PARALLEL = 1e-10


@dataclass(frozen=True)
class Row:
    """A link: `theta` and `alpha` in rad, `d` and `a` in mm.

    The joint value times `sign` is added to theta, or to d if the joint is `sliding`.
    """

    theta: float
    d: float
    a: float
    alpha: float
    sign: int = 1
    sliding: bool = False


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of a table, with the poses (4, 4) before the first and after the last row, mm.

    modified: Craig's convention.
    """

    rows: tuple[Row, ...]
    before: Array
    after: Array
    modified: bool = False


def chain_of(table: Table) -> Chain:
    """Return the chain of joint frames of a table.

    Raises InputError BAD_TABLE for an empty table, signs other than 1 and -1, and values that are
    not finite.
    """
    _check(table)
    origins, since_joint = [], table.before
    for row in table.rows:
        before_joint, after_joint = _row(row, table.modified)
        origins.append(since_joint @ before_joint)
        since_joint = after_joint
    return Chain(
        np.stack(origins),
        np.array([[0.0, 0.0, float(row.sign)] for row in table.rows]),
        since_joint @ table.after,
        np.array([row.sliding for row in table.rows]),
    )


def table_of(chain: Chain, modified: bool = False) -> Table:
    """Return the table of a chain, with all signs 1, because each z is along its axis.

    The position of a table frame along parallel axes is free. There d is 0 in a standard table, and
    before the axis in a modified table.
    """
    at_rest = chain.frames(np.zeros(chain.axes))
    axes = list(zip(at_rest.directions, at_rest.origins, strict=True))
    placed = _modified_frames(axes) if modified else _standard_frames(axes)
    rows = tuple(
        _parameters(frames.inverse(start) @ end, modified, bool(slides))
        for start, end, slides in zip(placed[:-1], placed[1:], chain.sliding, strict=True)
    )
    return Table(rows, placed[0], frames.inverse(placed[-1]) @ at_rest.flange, modified)


def _check(table: Table) -> None:
    if not table.rows:
        raise InputError("BAD_TABLE", "table", "the table is empty; give one row per joint")
    for number, row in enumerate(table.rows, 1):
        where = Text("table, row {}", number)
        if not np.isfinite([row.theta, row.d, row.a, row.alpha]).all():
            raise InputError(
                "BAD_TABLE", where, "theta, d, a and alpha must be numbers; give all four numbers"
            )
        if row.sign not in (1, -1):
            raise InputError("BAD_TABLE", where, "{} is not a sign; use 1 or -1", row.sign)


def _row(row: Row, modified: bool) -> tuple[Array, Array]:
    """Return the poses before and after the joint motion of a row."""
    about_z = frames.pose(frames.about_z(row.theta), (0.0, 0.0, row.d))
    about_x = frames.pose(frames.about_x(row.alpha), (row.a, 0.0, 0.0))
    return (about_x, about_z) if modified else (np.eye(4), about_z @ about_x)


Axis = tuple[Array, Array]


def _standard_frames(axes: Sequence[Axis]) -> list[Array]:
    """Return frames with z of frame i along axis i + 1 and x along the common normal from axis i.

    The last frame repeats the previous one.
    """
    direction, origin = axes[0]
    placed = [_frame(direction, _any_normal(direction), origin)]
    for index, (direction, origin) in enumerate(axes[1:]):
        foot, normal = _normal(axes[index], (direction, origin), placed[-1])
        placed.append(_frame(direction, normal, foot[1]))
    return [*placed, placed[-1]]


def _modified_frames(axes: Sequence[Axis]) -> list[Array]:
    """Return frames with z along each axis and x along the common normal to the next axis.

    The first frame appears twice.
    """
    placed: list[Array] = []
    for index, (direction, origin) in enumerate(axes):
        if index + 1 < len(axes):
            reference = placed[-1] if placed else _frame(direction, _any_normal(direction), origin)
            foot, normal = _normal((direction, origin), axes[index + 1], reference)
            placed.append(_frame(direction, normal, foot[0]))
        else:
            foot, normal = (
                _normal(axes[index - 1], (direction, origin), placed[-1])
                if placed
                else ((origin, origin), _any_normal(direction))
            )
            placed.append(_frame(direction, normal, foot[1]))
    return [placed[0], *placed]


def _parameters(link: Array, modified: bool, sliding: bool) -> Row:
    """Return the four parameters of a pose that has the form of a link."""
    if modified:
        alpha = np.arctan2(-link[1, 2], link[2, 2])
        theta = np.arctan2(-link[0, 1], link[0, 0])
        d = -np.sin(alpha) * link[1, 3] + np.cos(alpha) * link[2, 3]
        return Row(float(theta), float(d), float(link[0, 3]), float(alpha), 1, sliding)
    theta, alpha = np.arctan2(link[1, 0], link[0, 0]), np.arctan2(link[2, 1], link[2, 2])
    a = np.cos(theta) * link[0, 3] + np.sin(theta) * link[1, 3]
    return Row(float(theta), float(link[2, 3]), float(a), float(alpha), 1, sliding)


def _normal(axis_a: Axis, axis_b: Axis, previous: Array) -> tuple[tuple[Array, Array], Array]:
    """Return the feet of the common normal on both axes, and its direction.

    For parallel axes, the normal passes through the origin of the frame `previous`. For
    intersecting axes, it is the normal to both, in the sense of the previous x.
    """
    (z1, p1), (z2, p2) = axis_a, axis_b
    cross = np.cross(z1, z2)
    size = float(np.linalg.norm(cross))
    if size < PARALLEL:
        start: Array = p1 + z1 * float(z1 @ (previous[:3, 3] - p1))
        between = (p2 - start) - z1 * float(z1 @ (p2 - start))
        length = float(np.linalg.norm(between))
        # parallel axes without distance coincide: any normal is valid, preferably the previous x
        normal: Array = (
            between / length
            if length > 1e-9
            else previous[:3, 0] - z1 * float(z1 @ previous[:3, 0])
        )
        return (start, start + between), np.asarray(normal / np.linalg.norm(normal))
    across = p2 - p1
    t1 = float(np.cross(across, z2) @ cross) / size**2
    t2 = float(np.cross(across, z1) @ cross) / size**2
    foot1, foot2 = p1 + t1 * z1, p2 + t2 * z2
    normal = cross / size
    along = float(normal @ (foot2 - foot1))
    if abs(along) > 1e-9:
        return (foot1, foot2), normal * np.sign(along)
    return (foot1, foot2), normal * (1.0 if float(normal @ previous[:3, 0]) >= -1e-9 else -1.0)


def _any_normal(direction: Array) -> Array:
    smallest_axis = np.eye(3)[int(np.argmin(np.abs(direction)))]
    normal: Array = smallest_axis - direction * float(direction @ smallest_axis)
    return normal / np.linalg.norm(normal)


def _frame(z: Array, x: Array, origin: Array) -> Array:
    x = x - z * float(z @ x)
    x = x / np.linalg.norm(x)
    return frames.pose(np.stack((x, np.cross(z, x), z), axis=1), origin)
