# SPDX-License-Identifier: LGPL-2.1-or-later
"""waypoints.csv: one row per point in the order of motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..types import Array

HEADER = "layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm"
WIRE = "wire_feed_mm_s"
_LENGTHS, _DIRECTIONS, _ANGLES = 6, 9, 7  # decimals
_ROWS_AT_ONCE = 20_000
CLASS = "class"
_KINDS = np.frombuffer(b"rapid\0\0deposit", dtype=np.uint8).reshape(2, -1)
_WIDEST = max(map(len, CLASSES))
_CLASSES = np.array([list(name.encode().ljust(_WIDEST, b"\0")) for name in (*CLASSES, "")], dtype=np.uint8)

Bytes = NDArray[np.uint8]


def text(motion: Motion, axes: tuple[str, ...] = (), units: tuple[str, ...] = ()) -> Iterator[str]:
    """The file in pieces. `axes` names the columns of `motion.joints`, `units` are what they are written in: 'mm' where an
    axis slides, 'deg' where it turns and where left out. Where the wire follows the travel speed, its own comes
    next. The last column is the class of the bead, empty where it is not known."""
    units = units or ("deg",) * len(axes)
    last = [WIRE, CLASS] if has_wire(motion) else [CLASS]
    yield ",".join((HEADER, *(f"{axis}_{unit}" for axis, unit in zip(axes, units, strict=True)), *last)) + "\n"
    for start in range(0, len(motion), _ROWS_AT_ONCE):
        yield _rows(motion, units, slice(start, start + _ROWS_AT_ONCE))


def has_wire(motion: Motion) -> bool:
    """Whether the wire follows the travel speed anywhere."""
    return bool(np.isfinite(motion.wire).any())


def _rows(motion: Motion, units: tuple[str, ...], rows: slice) -> str:
    """Rows as text, digit by digit for all at once: three times as fast as a formatting per row of Python's floats."""
    slides = np.array([unit == "mm" for unit in units])
    angles = np.where(slides, motion.joints[rows], np.degrees(motion.joints[rows]))
    cells = [
        *((column[rows], 0) for column in (motion.layer, motion.bead, motion.point)), None,
        *((column, _LENGTHS) for column in motion.position[rows].T),
        *((column, _DIRECTIONS) for vectors in (motion.build, motion.tool) for column in vectors[rows].T),
        *((column[rows], _LENGTHS) for column in (motion.speed, motion.width)), *((column, _ANGLES) for column in angles.T),
    ]
    if has_wire(motion):
        cells.append((motion.wire[rows], _LENGTHS))
    texts = [_KINDS[motion.deposit[rows].astype(np.intp)].T if entry is None else _digits(*entry) for entry in cells]
    texts.append(_CLASSES[motion.bead_class[rows]].T)  # of none the last one
    count = len(motion.deposit[rows])
    parts = [part for text in texts for part in (text, np.full((1, count), ord(","), dtype=np.uint8))]
    parts[-1][:] = ord("\n")
    everything = np.concatenate(parts).T.ravel()
    text: str = everything[everything > 0].tobytes().decode("ascii")
    return text


def _digits(values: Array, decimals: int) -> Bytes:
    """(w, n) characters of numbers (n,) with so many decimals, 0 where there is none: all of a NaN. No -0.000000."""
    known = np.isfinite(values)
    whole = np.rint(np.where(known, values, 0.0) * 10.0**decimals).astype(np.int64)
    left = np.abs(whole)
    size = max(len(str(int(left.max(initial=0)))), decimals + 1)
    text = np.zeros((size + 2, len(left)), dtype=np.uint8)
    text[0] = np.where(whole < 0, ord("-"), 0)
    for place in range(size):
        rest = left // 10
        shown = left - 10 * rest + ord("0")
        # to the left of the decimals and one digit more, only what is not 0
        text[size + (place < decimals) - place] = shown if place <= decimals else np.where(left > 0, shown, 0)
        left = rest
    if decimals:
        text[size + 1 - decimals] = ord(".")
    text[:, ~known] = 0
    return text
