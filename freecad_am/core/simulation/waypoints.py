# SPDX-License-Identifier: LGPL-2.1-or-later
"""waypoints.csv: one row per point in the order of the motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..parameters.settings import deciding_entry
from ..types import Integers, NDArray

HEADER = "layer,bead,point,kind,x_mm,y_mm,z_mm,bx,by,bz,tx,ty,tz,speed_mm_s,width_mm"
WIRE = "wire_feed_mm_s"
_LENGTH, _DIRECTION, _ANGLE = 6, 9, 7  # decimals
_ROWS_AT_ONCE = 4000
CLASS, SETTING = "class", "setting"
_CLASS_NAMES = np.array([*CLASSES, ""])  # the last entry is for index -1, an unknown class


def text(
    motion: Motion,
    axes: tuple[str, ...] = (),
    units: tuple[str, ...] = (),
    by_place: bool = False,
) -> Iterator[str]:
    """Yield the file in pieces.

    If the wire follows the travel speed, the wire speed is the column after the axes. The next
    column is the bead class, empty if unknown. With settings by place, the last column is the
    number of the setting that decided, empty for none.

    Parameters
    ----------
    motion : Motion
        The motion, positions in the part.
    axes : tuple of str, optional
        Names of the columns of `motion.joints`; none if empty.
    units : tuple of str, optional
        Units of these columns: 'mm' for prismatic axes, 'deg' for revolute axes; 'deg' by default.
    by_place : bool, optional
        Whether the job has settings by place.

    Yields
    ------
    str
        Whole lines; the first piece is the header.

    Raises
    ------
    ValueError
        If axes and units differ in number.
    """
    units = units or ("deg",) * len(axes)
    wire = has_wire(motion)
    last_columns = [*([WIRE] if wire else []), CLASS, *([SETTING] if by_place else [])]
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
        yield _rows(motion, units, wire, by_place, slice(start, start + _ROWS_AT_ONCE))


def has_wire(motion: Motion) -> bool:
    """Whether the wire follows the travel speed in any segment."""
    return bool(np.isfinite(motion.wire).any())


def _rows(motion: Motion, units: tuple[str, ...], wire: bool, by_place: bool, rows: slice) -> str:
    """Format rows as text; `wire` adds the wire speed, `by_place` the number of the setting."""
    slides = np.array([unit == "mm" for unit in units])
    angles = np.where(slides, motion.joints[rows], np.degrees(motion.joints[rows]))
    columns: list[tuple[NDArray[Any], int | None]] = [
        (motion.layer[rows], None),
        (motion.bead[rows], None),
        (motion.point[rows], None),
        (np.where(motion.deposit[rows], "deposit", "rapid"), None),
        *((column, _LENGTH) for column in motion.position[rows].T),
        *((column, _DIRECTION) for column in motion.build[rows].T),
        *((column, _DIRECTION) for column in motion.tool[rows].T),
        (motion.speed[rows], _LENGTH),
        (motion.width[rows], _LENGTH),
        *((column, _ANGLE) for column in angles.T),
        *([(motion.wire[rows], _LENGTH)] if wire else []),
        (_CLASS_NAMES[motion.bead_class[rows]], None),
        *([(_setting_numbers(motion.settings[rows]), None)] if by_place else []),
    ]
    forms = ["%s" if decimals is None else f"%.{decimals}f" for _, decimals in columns]
    template = ",".join(forms) + "\n"
    texts = [template % row for row in zip(*(_values(*column) for column in columns), strict=True)]
    return "".join(texts).replace("nan", "")  # unknown values are empty cells


def _setting_numbers(settings: Integers) -> NDArray[Any]:
    """Return the number of the deciding setting of each row as text, empty for none."""
    combinations, index = np.unique(settings, return_inverse=True)
    numbers = [deciding_entry(combination) for combination in combinations.tolist()]
    texts = np.array(["" if number is None else str(number) for number in numbers])
    return np.asarray(texts[np.ravel(index)])


def _values(column: NDArray[Any], decimals: int | None) -> list[Any]:
    """Return values to print; rounding avoids -0.000000, and infinite values become NaN."""
    if decimals is not None:
        column = np.round(np.where(np.isfinite(column), column, np.nan), decimals) + 0.0
    values: list[Any] = column.tolist()
    return values
