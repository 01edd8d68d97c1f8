# SPDX-License-Identifier: LGPL-2.1-or-later
"""waypoints.csv: one row per point in the order of motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .. import digits
from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..types import Array, Index

HEADER = "layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm"
WIRE = "wire_feed_mm_s"
_LENGTHS, _DIRECTIONS, _ANGLES = 6, 9, 7  # decimals
_ROWS_AT_ONCE = 4000
CLASS = "class"
_KINDS = np.frombuffer(b"rapid\0\0deposit", dtype=np.uint8).reshape(2, -1)
_MAX_WIDTH = max(map(len, CLASSES))
_CLASSES = np.array(
    [list(name.encode().ljust(_MAX_WIDTH, b"\0")) for name in (*CLASSES, "")], dtype=np.uint8
)


def text(motion: Motion, axes: tuple[str, ...] = (), units: tuple[str, ...] = ()) -> Iterator[str]:
    """Yield the file in pieces.

    `axes` names the columns of `motion.joints`, `units` their units in the file: 'mm' for prismatic
    axes, 'deg' for revolute ones and if left out. If the wire follows the travel speed, its speed is
    the next column. The last column is the class of the bead, empty if not known.
    """
    units = units or ("deg",) * len(axes)
    wire = has_wire(motion)
    last_columns = [WIRE, CLASS] if wire else [CLASS]
    yield (
        ",".join(
            (
                HEADER,
                *(f"{axis}_{unit}" for axis, unit in zip(axes, units, strict=True)),
                *last_columns,
            )
        )
        + "\n"
    )
    for start in range(0, len(motion), _ROWS_AT_ONCE):
        yield _rows(motion, units, wire, slice(start, start + _ROWS_AT_ONCE))


def has_wire(motion: Motion) -> bool:
    """Whether the wire follows the travel speed anywhere."""
    return bool(np.isfinite(motion.wire).any())


def _rows(motion: Motion, units: tuple[str, ...], wire: bool, rows: slice) -> str:
    """Rows as text, with the wire's own speed or without."""
    slides = np.array([unit == "mm" for unit in units])
    angles = np.where(slides, motion.joints[rows], np.degrees(motion.joints[rows]))
    numbers = _cells((motion.layer[rows], motion.bead[rows], motion.point[rows]), 0)
    x, y, z, speed, width = _cells(
        (*motion.position[rows].T, motion.speed[rows], motion.width[rows]), _LENGTHS
    )
    vectors = _cells((*motion.build[rows].T, *motion.tool[rows].T), _DIRECTIONS)
    texts = [
        *numbers,
        _KINDS[motion.deposit[rows].astype(np.intp)].T,
        x,
        y,
        z,
        *vectors,
        speed,
        width,
    ]
    texts += _cells((*angles.T,), _ANGLES)
    if wire:
        texts += _cells((motion.wire[rows],), _LENGTHS)
    texts.append(_CLASSES[motion.bead_class[rows]].T)  # of none the last one
    ends = [*[b","] * (len(texts) - 1), b"\n"]
    return digits.joined(
        [column for pair in zip(texts, ends, strict=True) for column in pair],
        len(motion.deposit[rows]),
    )


def _cells(columns: Sequence[Array | Index], decimals: int) -> list[digits.Characters]:
    """Characters (w, n) of columns (n,) of numbers with `decimals` decimals, none for NaN. No
    -0.000000.
    """
    if not columns:
        return []
    values = np.concatenate(columns)
    is_known = np.isfinite(values)
    text = digits.plain(digits.whole(np.where(is_known, values, 0.0), decimals), decimals)
    text[:, ~is_known] = 0
    return [*text.reshape(len(text), len(columns), -1).transpose(1, 0, 2)]
