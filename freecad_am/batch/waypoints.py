# SPDX-License-Identifier: LGPL-2.1-or-later
"""waypoints.csv: one row per point in the order of motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from freecad_am.core.motion import Motion
from freecad_am.core.toolpath import Array

HEADER = "layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm"
WIRE = "wire_feed_mm_s"
_LENGTHS, _DIRECTIONS, _ANGLES = 6, 9, 7  # decimals
_ROWS_AT_ONCE = 20_000


def text(motion: Motion, axes: tuple[str, ...] = (), units: tuple[str, ...] = ()) -> Iterator[str]:
    """The file in pieces. `axes` names the columns of `motion.joints`, `units` are what they are written in: 'mm' where an
    axis slides, 'deg' where it turns and where left out. Where the wire follows the travel speed, its own is the last
    column."""
    units = units or ("deg",) * len(axes)
    last = [WIRE] if told_of_wire(motion) else []
    yield ",".join((HEADER, *(f"{axis}_{unit}" for axis, unit in zip(axes, units, strict=True)), *last)) + "\n"
    for start in range(0, len(motion), _ROWS_AT_ONCE):
        yield _rows(motion, units, slice(start, start + _ROWS_AT_ONCE))


def told_of_wire(motion: Motion) -> bool:
    """Whether the wire follows the travel speed anywhere."""
    return bool(np.isfinite(motion.wire).any())


def _rows(motion: Motion, units: tuple[str, ...], rows: slice) -> str:
    counts = [column[rows].tolist() for column in (motion.layer, motion.bead, motion.point)]
    kinds = ["deposit" if deposit else "rapid" for deposit in motion.deposit[rows].tolist()]
    lengths = _columns(motion.position[rows], _LENGTHS)
    directions = _columns(motion.build[rows], _DIRECTIONS) + _columns(motion.tool[rows], _DIRECTIONS)
    process = _columns(np.column_stack((motion.speed[rows], motion.width[rows])), _LENGTHS)
    slides = np.array([unit == "mm" for unit in units])
    angles = _columns(np.where(slides, motion.joints[rows], np.degrees(motion.joints[rows])), _ANGLES)
    decimals = [_LENGTHS] * 3 + [_DIRECTIONS] * 6 + [_LENGTHS] * 2 + [_ANGLES] * len(angles)
    wire: list[list[float]] = []
    if told_of_wire(motion):
        wire, decimals = _columns(motion.wire[rows, None], _LENGTHS), [*decimals, _LENGTHS]
    row = "%d,%d,%d,%s," + ",".join(f"%.{digits}f" for digits in decimals) + "\n"
    # one formatting per row of Python floats is three times as fast as numpy's own writer
    lines = [row % values for values in zip(*counts, kinds, *lengths, *directions, *process, *angles, *wire)]
    return "".join(lines).replace("nan", "")


def _columns(values: Array, decimals: int) -> list[list[float]]:
    """Columns as lists; rounded first, so that no -0.000000 is written."""
    rounded: list[list[float]] = (np.round(values, decimals) + 0.0).T.tolist()
    return rounded
