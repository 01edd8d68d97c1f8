# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibration tables of bead models: comma separated values with one measured bead per row.

Columns by name, in any order: radius_mm (inf of a straight bead), travel_speed_mm_min, width_mm, height_mm and
wire_feed_m_min; separated by commas, or by semicolons, with decimal points. Lines that begin with # are remarks. An unknown
or repeated column is rejected, because its values would be lost.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...geometry.file_content import read_content
from ...issues import InputError, Text, Word
from ...parameters.process import ProcessParameters
from ...types import Array
from .bead_model import MINUTE, BeadModel, fit, row_name
from .wire import model_wire_feed

BUILT_IN = {"csw": "dai-2020.csv", "li-2025": "li-2025.csv"}
MAX_FILE_MB = 16  # MB
FOLDER = Path(__file__).resolve().parents[3] / "beads"
COLUMNS = ("radius_mm", "travel_speed_mm_min", "width_mm", "height_mm", "wire_feed_m_min")


class Measured(NamedTuple):
    """Beads of a calibration table: columns (n,) in mm and mm/s, and their wire feed, or its mean, mm/s. label: the file's name;
    lines: line number of each row, from 1. feeds: (n,) mm/s where they differ.
    """

    radius: Array
    speed: Array
    width: Array
    height: Array
    wire_feed: float
    label: str
    lines: tuple[int, ...]
    feeds: Array | None = None


def process_model(process: ProcessParameters) -> BeadModel | None:
    """The bead model of a process at its wire feed; None without one. Raises the InputErrors of `load`."""
    if process.bead_model == "none":
        return None
    model = load(process.bead_model)
    return model.at_feed(model_wire_feed(process, model))


def load(name: str, folder: Path | None = None) -> BeadModel:
    """The bead model of a table by name or path, as in `read_table`. Raises the InputErrors of `read_table` and `bead_model.fit`."""
    return fit(*read_table(name, folder))


def read_table(name: str, folder: Path | None = None) -> Measured:
    """Read a built-in table ('csw': table 1 of Dai 2020; 'li-2025': from table 5 of Li 2025) or the table at a path, relative to
    `folder`.

    InputError 'NO_FILE', 'BAD_TABLE' (naming row and column, or that it is not a text).
    """
    path = FOLDER / BUILT_IN[name] if name in BUILT_IN else Path(folder or ".", name)
    try:
        text = read_content(path, MAX_FILE_MB, "BAD_TABLE", name).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        if isinstance(error, UnicodeError):
            raise InputError(
                "BAD_TABLE",
                name,
                "it is not a table: it contains bytes that are not UTF-8 text; save it as CSV in "
                "UTF-8",
            ) from None
        why = (getattr(error, "strerror", None) or str(error) or "no access").lower()
        raise InputError(
            "NO_FILE",
            name,
            "the calibration table cannot be read ({}); use none, csw or the path of a table",
            why,
        ) from None
    numbered = enumerate(text.splitlines(), 1)
    filled = [
        (number, line)
        for number, line in numbered
        if line.strip() and not line.lstrip().startswith("#")
    ]
    lines, numbers = [line for _, line in filled], tuple(number for number, _ in filled[1:])
    separator = ";" if lines and ";" in lines[0] else ","
    cells = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
    header = cells[0] if cells else []
    _check_columns(header, f"{path.name} line {filled[0][0]}" if filled else path.name)
    rows = [_row(header, row) for row in cells[1:]]
    missing = [column for column in COLUMNS if column not in header]
    if missing:
        raise InputError(
            "BAD_TABLE",
            path.name,
            "the column {} is missing; name in its first line {}",
            missing[0],
            ", ".join(COLUMNS),
        )
    table = np.array(
        [
            [_number(row, column, row_name(path.name, number, numbers)) for column in COLUMNS]
            for number, row in enumerate(rows)
        ]
    )
    if not len(rows):
        table = np.empty((0, len(COLUMNS)))
    radius, speed, width, height, feed = table.T
    wrong = np.flatnonzero(~(np.isfinite(feed) & (feed > 0.0)))
    if len(wrong):
        where = row_name(path.name, int(wrong[0]), numbers)
        raise InputError(
            "BAD_TABLE",
            where,
            "wire feed {:g} m/min is not a positive number; correct or remove the row",
            feed[wrong[0]],
        )
    several = len(feed) > 0 and np.ptp(feed) > 1e-9 * feed.max()
    feeds = feed * 1000.0 / MINUTE
    nominal = (
        0.0
        if not len(feed)
        else float(feeds.mean())
        if several
        else float(feed[0]) * 1000.0 / MINUTE
    )
    return Measured(
        radius,
        speed / MINUTE,
        width,
        height,
        nominal,
        path.name,
        numbers,
        feeds if several else None,
    )


def _check_columns(header: list[str], where: str) -> None:
    """InputError BAD_TABLE for unknown or repeated columns."""
    for column in header:
        if header.count(column) > 1:
            raise InputError(
                "BAD_TABLE", where, "the column {!r} appears twice; remove one", column
            )
        if column not in COLUMNS and any(name in COLUMNS for name in header):
            raise InputError(
                "BAD_TABLE",
                where,
                "unknown column {!r}; remove it, or rename it to one of {}",
                column,
                ", ".join(COLUMNS),
            )


def _row(header: list[str], cells: list[str]) -> dict[str | None, str | None]:
    """The cells of a row by column; None for a missing cell, and surplus cells under the key None."""
    row: dict[str | None, str | None] = dict.fromkeys(header)
    row.update(zip(header, cells))
    if len(cells) > len(header):
        row[None] = "".join(cells[len(header) :])
    return row


def _number(row: dict[str | None, str | None], column: str, where: str) -> float:
    if None in row:
        raise InputError(
            "BAD_TABLE",
            where,
            "the row has more values than columns; write decimals with a point",
        )
    text = (row[column] or "").strip()
    try:
        if "_" in text:
            raise ValueError
        return float(text)
    except ValueError:
        what = (
            Text("{} {!r} is not a number", column, text)
            if text
            else Text("there is no {}", column)
        )
        raise InputError("BAD_TABLE", where, "{}; correct or remove the row", Word(what)) from None
