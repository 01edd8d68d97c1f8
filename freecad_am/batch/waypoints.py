# SPDX-License-Identifier: LGPL-2.1-or-later
"""waypoints.csv: one row per point in the order of motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from freecad_am.core.motion import Motion
from freecad_am.core.toolpath import Array, Toolpath

HEADER = "layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm"
_LENGTHS, _DIRECTIONS, _ANGLES = 6, 9, 7  # decimals
_ROWS_AT_ONCE = 20_000


def text(motion: Motion, axes: tuple[str, ...] = (), units: tuple[str, ...] = ()) -> Iterator[str]:
    """The file in pieces. `axes` names the columns of `motion.joints`, `units` are what they are written in: 'mm' where an
    axis slides, 'deg' where it turns and where left out."""
    units = units or ("deg",) * len(axes)
    yield ",".join((HEADER, *(f"{axis}_{unit}" for axis, unit in zip(axes, units, strict=True)))) + "\n"
    for start in range(0, len(motion), _ROWS_AT_ONCE):
        yield _rows(motion, units, slice(start, start + _ROWS_AT_ONCE))


def from_toolpath(toolpath: Toolpath, axes: int = 0) -> Motion:
    """The deposit alone, for a job that has no joint path: no rapid rows, durations from length and speed.

    `axes` columns of joints that no point has.
    """
    beads = list(toolpath)
    sizes = [len(bead) for _, _, bead in beads]
    position = np.concatenate([bead.points for _, _, bead in beads])
    speed = np.concatenate([bead.speed for _, _, bead in beads])
    point = np.concatenate([np.arange(size) for size in sizes])
    step = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    return Motion(
        deposit=np.ones(len(position), dtype=bool),
        layer=np.repeat([layer for layer, _, _ in beads], sizes),
        bead=np.repeat([number for _, number, _ in beads], sizes),
        point=point,
        position=position,
        build=np.concatenate([bead.build for _, _, bead in beads]),
        tool=np.concatenate([bead.tool for _, _, bead in beads]),
        speed=speed,
        width=np.concatenate([np.full(len(b), np.nan) if b.width is None else b.width for _, _, b in beads]),
        joints=np.full((len(position), axes), np.nan),
        duration=np.where(point > 0, step / speed, 0.0),
    )


def _rows(motion: Motion, units: tuple[str, ...], rows: slice) -> str:
    counts = [column[rows].tolist() for column in (motion.layer, motion.bead, motion.point)]
    kinds = ["deposit" if deposit else "rapid" for deposit in motion.deposit[rows].tolist()]
    lengths = _columns(motion.position[rows], _LENGTHS)
    directions = _columns(motion.build[rows], _DIRECTIONS) + _columns(motion.tool[rows], _DIRECTIONS)
    process = _columns(np.column_stack((motion.speed[rows], motion.width[rows])), _LENGTHS)
    slides = np.array([unit == "mm" for unit in units])
    angles = _columns(np.where(slides, motion.joints[rows], np.degrees(motion.joints[rows])), _ANGLES)
    decimals = [_LENGTHS] * 3 + [_DIRECTIONS] * 6 + [_LENGTHS] * 2 + [_ANGLES] * len(angles)
    row = "%d,%d,%d,%s," + ",".join(f"%.{digits}f" for digits in decimals) + "\n"
    # one formatting per row of Python floats is three times as fast as numpy's own writer
    lines = [row % values for values in zip(*counts, kinds, *lengths, *directions, *process, *angles)]
    return "".join(lines).replace("nan", "")


def _columns(values: Array, decimals: int) -> list[list[float]]:
    """Columns as lists; rounded first, so that no -0.000000 is written."""
    rounded: list[list[float]] = (np.round(values, decimals) + 0.0).T.tolist()
    return rounded
