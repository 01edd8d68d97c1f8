# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves to deposit as beads without slicing, with tool directions, and tables of such curves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ...issues import InputError, Issue, Text, Word
from ...types import Array
from ..obstacles import Body

# endings and formats of files whose curves become beads
POINT_FILES = {
    ".csv": "csv",
    ".gcode": "gcode",
    ".gco": "gcode",
    ".g": "gcode",
    ".ada3dp": "ada3dp",
}
MEETING = 1e-6  # mm; maximum distance between the ends of a closed curve


@dataclass(frozen=True, eq=False)
class BeadCurve:
    """A curve deposited as one bead.

    points: (n, 3) mm; a closed curve repeats its first point at the end. directions: (n, 3) unit
    vectors from the deposit towards the tool; None if the source has no directions. layer: layer
    index, from 0.
    """

    points: Array
    directions: Array | None = None
    layer: int = 0

    @property
    def closed(self) -> bool:
        """Whether the curve ends at its first point."""
        return (
            len(self.points) > 3
            and float(np.linalg.norm(self.points[-1] - self.points[0])) < MEETING
        )


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves in deposition order.

    surroundings: substrate and fixtures, as bodies. depths: None, because curves have no volume.
    edges: names of the selected edges of a shape, empty if all are used; None for curves that do
    not come from a shape. own: None, because curves have no hub.
    """

    own: ClassVar[None] = None

    label: str
    curves: tuple[BeadCurve, ...]
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()
    depths: None = None
    edges: tuple[str, ...] | None = None


class ReadCurves(NamedTuple):
    """Beads of a file, and issues about content that does not become beads."""

    curves: tuple[BeadCurve, ...]
    issues: tuple[Issue, ...] = ()


# ---- Curves from a text table of points: x, y, z in mm, optionally direction i, j, k and bead
# number

COLUMNS = ("x", "y", "z", "i", "j", "k", "bead")
BY_COUNT = {3: COLUMNS[:3], 4: (*COLUMNS[:3], "bead"), 6: COLUMNS[:6], 7: COLUMNS}
CODE = "BAD_TABLE"
MIN_STEP_MM = 1e-6  # mm; closer points coincide
MAX_MM = 1e7  # mm; maximum coordinate; larger values are typing errors
FORM = "give a table with the columns x,y,z, then i,j,k for directions, then bead for several beads"


def curves_of(text: str, where: str) -> tuple[BeadCurve, ...]:
    """Read the curves of a table, one per bead number, in the order of the lines.

    Cells are separated by commas or semicolons; the first line holds column names or numbers.

    Parameters
    ----------
    text : str
        The table.
    where : str
        Name of the file, for messages.

    Returns
    -------
    tuple of BeadCurve
        The curves.

    Raises
    ------
    InputError
        BAD_TABLE with the line.
    """
    lines = text.lstrip("\ufeff").splitlines()
    while lines and not lines[-1].strip():
        lines.pop()
    if not lines:
        raise InputError(CODE, where, "the table has no points; {}", FORM)
    separator = ";" if ";" in lines[0] else ","
    columns, header_lines = _columns(_cells(lines[0], separator), where)
    numbers = [
        _numbers(_cells(line, separator), columns, f"{where} line {k}")
        for k, line in enumerate(lines[header_lines:], header_lines + 1)
    ]
    if not numbers:
        raise InputError(CODE, where, "the table has no points; {}", FORM)
    rows = np.array(numbers)
    bead = rows[:, columns.index("bead")] if "bead" in columns else np.zeros(len(rows))
    starts = np.flatnonzero(np.r_[True, np.diff(bead) != 0.0])
    curves, beads_read = [], set()
    for start, end in zip(starts, [*starts[1:], len(rows)]):
        location = f"{where} line {header_lines + 1 + int(start)}"
        if bead[start] in beads_read:
            raise InputError(
                CODE,
                location,
                "bead {:g} starts a second time; keep all lines of a bead together",
                bead[start],
            )
        beads_read.add(float(bead[start]))
        curves.append(
            _curve(rows[start:end], columns, location, header_lines + 1 + int(start), where)
        )
    return tuple(curves)


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip() for cell in line.split(separator)]


def _columns(cells: Sequence[str], where: str) -> tuple[tuple[str, ...], int]:
    """Return the column names, and the number of header lines."""
    names = tuple(cell.lower().removesuffix("_mm") for cell in cells)
    if any(name in COLUMNS for name in names):
        expected = BY_COUNT.get(len(names))
        if set(names) != set(expected or ()):
            raise InputError(
                CODE,
                f"{where} line 1",
                "the columns of the table are {}; {}",
                ", ".join(cells),
                FORM,
            )
        return names, 1
    if len(cells) not in BY_COUNT:
        raise InputError(CODE, f"{where} line 1", "the table has {} columns; {}", len(cells), FORM)
    return BY_COUNT[len(cells)], 0


def _numbers(cells: Sequence[str], columns: Sequence[str], where: str) -> list[float]:
    if len(cells) != len(columns) or not all(cells):
        lacking = (
            "the line is empty"
            if not any(cells)
            else Text("the line has {} numbers instead of {}", sum(map(bool, cells)), len(columns))
        )
        raise InputError(CODE, where, "{}; fill the gap, or remove the line", Word(lacking))
    values = []
    for cell, name in zip(cells, columns):
        try:
            if "_" in cell:
                raise ValueError
            number = float(cell)
        except ValueError:
            raise InputError(
                CODE,
                where,
                "{!r} is not a number; give {} as a number with a decimal point",
                cell[:40],
                name,
            ) from None
        if not math.isfinite(number) or abs(number) > MAX_MM:
            raise InputError(
                CODE, where, "{} is {:g}; give a number of at most {:g}", name, number, MAX_MM
            )
        values.append(number)
    return values


def _curve(rows: Array, columns: Sequence[str], location: str, line: int, where: str) -> BeadCurve:
    points = rows[:, [columns.index(name) for name in COLUMNS[:3]]]
    if len(points) < 2:
        raise InputError(CODE, location, "the bead has only one point; give at least two points")
    repeated = np.flatnonzero(np.linalg.norm(np.diff(points, axis=0), axis=1) < MIN_STEP_MM)
    if len(repeated):
        location = f"{where} line {line + int(repeated[0]) + 1}"
        raise InputError(CODE, location, "the point repeats the previous line; remove the line")
    if "i" not in columns:
        return BeadCurve(points)
    directions = rows[:, [columns.index(name) for name in COLUMNS[3:6]]]
    size = np.linalg.norm(directions, axis=1)
    none = np.flatnonzero(size < 1e-9)
    if len(none):
        raise InputError(
            CODE,
            f"{where} line {line + int(none[0])}",
            "i, j, k are 0; give a direction, such as 0, 0, 1",
        )
    return BeadCurve(points, directions / size[:, None])
