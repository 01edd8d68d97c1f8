# SPDX-License-Identifier: LGPL-2.1-or-later
"""Balance of wire feed and beads: wire volume per second = bead cross-section x travel speed."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..geometry.job_files import read_content
from ..geometry.ramps import ramp
from ..issues import WARNING, InputError, Issue, Text, Word
from ..motion import AT_END, AT_START, MIDDLE
from ..parameters.bead_classes import CLASSES
from ..parameters.process import ProcessParameters
from ..parameters.settings import entries_of
from ..toolpath import Bead, Toolpath, settings_of
from ..types import Array
from .bead_model import MINUTE, BeadModel, fit, row_name

_KEYS = {MIDDLE: "", AT_START: ".start", AT_END: ".end"}


class Taken(NamedTuple):
    """Deposition rate of the beads of one class in one phase, with the same settings by place.

    phase: one of PHASES. rate: mm3/s. layer, bead: indices of the first occurrence. section: mean
    cross-section, mm2. settings: sum of 2^entry.
    """

    bead_class: str
    phase: int
    rate: float
    layer: int
    bead: int
    section: float
    settings: int = 0

    @property
    def name(self) -> str:
        """Name in terms of job keys: contour, contour.start, contour.end, contour settings[0]."""
        suffix = f" settings{entries_of(self.settings)}" if self.settings else ""
        return f"{self.bead_class or 'all'}{_KEYS[self.phase]}{suffix}"


def by_wire(rate_of_class: Taken, process: ProcessParameters) -> bool:
    """Whether process.wire sets the feed of a class and phase, rather than a separate schedule."""
    class_process = process.at_place(rate_of_class.bead_class, rate_of_class.settings)
    phase = {AT_START: class_process.start, AT_END: class_process.end}.get(rate_of_class.phase)
    schedule = class_process.schedule if phase is None or phase.schedule is None else phase.schedule
    return schedule == process.schedule


def by_schedules(toolpath: Toolpath, process: ProcessParameters) -> list[str]:
    """Return the names of classes and phases with a separate schedule, whose feed is unknown."""
    return [
        rate_of_class.name
        for rate_of_class in taken_of(toolpath)
        if not by_wire(rate_of_class, process)
    ]


def off_most(toolpath: Toolpath, process: ProcessParameters) -> tuple[float, int, int] | None:
    """Return the maximum relative deviation of the wire feed from the bead volume.

    Beads with a separate schedule are not included.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    process : ProcessParameters
        Wire and travel speed.

    Returns
    -------
    tuple of (float, int, int) or None
        Deviation, layer and bead; None if wire feed or bead width is unknown.
    """
    wire_rate = (toolpath.wire_feed or 0.0) * process.wire.section
    by_wire_ = [
        rate_of_class for rate_of_class in taken_of(toolpath) if by_wire(rate_of_class, process)
    ]
    if not by_wire_ or wire_rate == 0.0:
        return None
    follows = follows_speed(toolpath)  # mm3 per mm
    return max(
        (
            (
                abs(
                    (
                        wire_rate / process.travel_speed / rate_of_class.section
                        if follows
                        else wire_rate / rate_of_class.rate
                    )
                    - 1.0
                ),
                rate_of_class.layer,
                rate_of_class.bead,
            )
            for rate_of_class in by_wire_
        ),
        key=lambda deviation: deviation[0],
    )


def follows_speed(toolpath: Toolpath) -> bool:
    """Whether the wire feed follows the travel speed along a bead."""
    return any(bead.wire_share is not None for _, _, bead in toolpath)


def taken_of(toolpath: Toolpath) -> list[Taken]:
    """Return the deposition rate of each bead class and phase, in print order.

    The rates follow from width, height and speed of the beads. Empty if the bead width is unknown.
    """
    if toolpath.bead_width is None:
        return []
    sums: dict[tuple[str, int, int], Array] = {}
    first_bead: dict[tuple[str, int, int], tuple[int, int]] = {}
    for layer, number, bead in toolpath:
        for (phase, active), sum_ in _sums(
            bead, toolpath.bead_width * toolpath.layer_height, toolpath
        ).items():
            key = bead.role.bead_class, phase, active
            sums[key] = sums.get(key, np.zeros(3)) + sum_
            first_bead.setdefault(key, (layer, number))
    return [
        Taken(*key[:2], float(volume / time), *first_bead[key], float(volume / length), key[2])
        for key, (volume, time, length) in sums.items()
        if time > 0.0
    ]


def _sums(bead: Bead, usual: float, toolpath: Toolpath) -> dict[tuple[int, int], Array]:
    """Return volume, mm3, time, s, and length, mm, (3,) of a bead by phase and settings by place.

    Before the phase of each segment is planned, they are derived from the lengths of the bead ends.
    """
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    section: Array | float = usual
    if bead.width is not None or bead.height is not None:
        high = toolpath.layer_height if bead.height is None else bead.height
        area = high * (
            np.full(len(bead), toolpath.bead_width) if bead.width is None else bead.width
        )
        section = 0.5 * (area[1:] + area[:-1])
    amounts = np.stack([section * length, length / bead.speed[1:], length])
    if bead.phase is not None or bead.settings is not None:
        phases = np.full(len(length), MIDDLE) if bead.phase is None else bead.phase[1:].astype(int)
        kinds = np.stack([phases, settings_of(bead)[1:].astype(int)])
        return {
            (phase, active): amounts[:, (kinds[0] == phase) & (kinds[1] == active)].sum(axis=1)
            for phase, active in np.unique(kinds, axis=1).T.tolist()
        }
    return {(phase, 0): sum_ for phase, sum_ in _sums_before_planning(bead, amounts).items()}


def _sums_before_planning(bead: Bead, amounts: Array) -> dict[int, Array]:
    """Return the sums of `_sums` by phase of a bead without phases. amounts: (3, n) of its segments."""
    total, length = amounts.sum(axis=1), amounts[2]
    ends = bead.ends
    if ends is None:
        return {MIDDLE: total}
    size = length.sum()
    sums = {MIDDLE: total * (1.0 - (ends.start_length + ends.end_length) / size)}
    for long, from_speed, to_speed in (
        (ends.start_ramp, ends.start_speed, float(bead.speed[1])),
        (ends.end_ramp, float(bead.speed[-1]), ends.end_speed),
    ):
        steps = ramp(long, from_speed, to_speed)
        if len(steps):
            sums[MIDDLE] = sums[MIDDLE] + [
                0.0,
                float((long / len(steps) / steps).sum()) - total[1] * long / size,
                0.0,
            ]
    for phase, long, speed in (
        (AT_START, ends.start_length, ends.start_speed),
        (AT_END, ends.end_length, ends.end_speed),
    ):
        if long:
            sums[phase] = np.array(
                [total[0] * long / size, long / speed if speed else total[1] * long / size, long]
            )
    return sums


AUTO, CODE = "auto", "FEED_BALANCE"
TOLERANCE = 0.1  # fraction of the deposition rate; maximum deviation of a balanced wire feed


def model_wire_feed(process: ProcessParameters, model: BeadModel) -> float:
    """Return the wire feed, mm/s, if a bead model sets the travel speed.

    This is the feed of the process, or the model's nominal feed for `auto`.
    """
    feed = process.wire.feed
    return model.wire_feed if isinstance(feed, str) else feed


def set_wire_feed(
    toolpath: Toolpath, process: ProcessParameters, model: BeadModel | None
) -> Toolpath:
    """Return the toolpath with its wire feed.

    The feed is balanced if wire section x feed = bead width x layer height x travel speed, or if
    it deposits the volume of a filled part, where beads overlap. Beads of a model were measured
    with their wire feed; `solids.notes` reports their balance. A feed of 0 means no wire.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    process : ProcessParameters
        Wire, bead width and travel speed.
    model : BeadModel or None
        Bead model that sets the speeds, if any.

    Returns
    -------
    Toolpath
        The toolpath, with an issue if the wire feed is not balanced. Unchanged if the bead width
        is unknown.
    """
    if model is not None:
        return replace(toolpath, wire_feed=model_wire_feed(process, model))
    if toolpath.bead_width is None:
        return toolpath
    width, height, speed = toolpath.bead_width, toolpath.layer_height, process.travel_speed
    bead_rate = width * height * speed
    balanced = bead_rate / process.wire.section
    if isinstance(process.wire.feed, str):
        return _check_classes(_following(replace(toolpath, wire_feed=balanced), process), process)
    fed_path = _following(replace(toolpath, wire_feed=process.wire.feed), process)
    wire_rate = process.wire.feed * process.wire.section
    if (
        wire_rate == 0.0
        or abs(wire_rate - bead_rate) <= TOLERANCE * bead_rate
        or _fills(toolpath, wire_rate)
    ):
        return _check_classes(fed_path, process)
    return replace(
        fed_path,
        issues=(
            *fed_path.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the wire feeds {:.4g} mm3/s, {:.4g} mm/s of {:g} mm wire, but beads of "
                    "{:.4g} x {:.4g} mm at {:.4g} mm/s need {:.4g} mm3/s; set process.wire.feed "
                    "to {:.4g} mm/s or to auto, or correct width, layer height and travel speed",
                    wire_rate,
                    process.wire.feed,
                    process.wire.diameter,
                    width,
                    height,
                    speed,
                    bead_rate,
                    balanced,
                ),
            ),
        ),
    )


def _fills(toolpath: Toolpath, wire_rate: float) -> bool:
    """Whether a wire rate, mm3/s, deposits the volume of a filled part."""
    if toolpath.checks.volumes is None:
        return False
    part_volume, left_out, outside = toolpath.checks.volumes
    deposited = part_volume - left_out + outside
    seconds = sum(
        float((np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum())
        for _, _, bead in toolpath
    )
    return abs(wire_rate * seconds - deposited) <= TOLERANCE * deposited


def _following(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with a wire feed that follows the travel speed, if applicable.

    This needs the feed mode `proportional` and beads with ramps. For stepped speeds a schedule gives the feed.
    """
    ramped = any(bead.ends is not None and bead.ends.has_ramps for _, _, bead in toolpath)
    if process.wire.feed_mode != "proportional" or not toolpath.wire_feed or not ramped:
        return toolpath
    share = toolpath.wire_feed / process.travel_speed
    return replace(
        toolpath,
        layers=tuple(
            replace(layer, beads=tuple(replace(bead, wire_share=share) for bead in layer.beads))
            for layer in toolpath.layers
        ),
    )


def _check_classes(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with an issue if the wire feed is unbalanced for some classes or phases.

    Classes and phases with a separate schedule are not checked.
    """
    wire_rate = (toolpath.wire_feed or 0.0) * process.wire.section
    if wire_rate == 0.0 or not _at_other_speeds(process) or follows_speed(toolpath):
        return toolpath
    off = [
        rate_of_class
        for rate_of_class in taken_of(toolpath)
        if by_wire(rate_of_class, process)
        and abs(wire_rate - rate_of_class.rate) > TOLERANCE * rate_of_class.rate
    ]
    if not off:
        return toolpath
    text = ", ".join(f"{rate_of_class.name} {rate_of_class.rate:.4g}" for rate_of_class in off)
    return replace(
        toolpath,
        issues=(
            *toolpath.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the wire feeds {:.4g} mm3/s, but beads of these classes need {} mm3/s at "
                    "their own travel speeds, so they are over- or under-filled; give the "
                    "classes a schedule with a matching wire feed, or the travel speed of the "
                    "other beads",
                    wire_rate,
                    text,
                ),
                off[0].layer,
                off[0].bead,
            ),
        ),
    )


def _at_other_speeds(process: ProcessParameters) -> bool:
    """Whether any class or phase has a separate travel speed."""
    named = [process, *(process.for_class(name) for name in CLASSES)]
    if any(setting.travel_speed is not None for setting in process.settings):
        return True
    return any(
        settings.travel_speed != process.travel_speed or settings.start.there or settings.end.there
        for settings in named
    )


BUILT_IN = {"csw": "dai-2020.csv", "li-2025": "li-2025.csv"}
MAX_FILE_MB = 16  # MB
FOLDER = Path(__file__).resolve().parents[2] / "beads"
COLUMNS = ("radius_mm", "travel_speed_mm_min", "width_mm", "height_mm", "wire_feed_m_min")


class Measured(NamedTuple):
    """Measured beads of a calibration table.

    Columns (n,) in mm and mm/s. wire_feed: mm/s, the mean if the feeds differ. label: file name. lines: line number of
    each row, from 1. feeds: (n,) mm/s, None if all feeds are equal.
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
    """Return the bead model of a process at its wire feed, or None. Raises the InputErrors of `load`."""
    if process.bead_model == "none":
        return None
    model = load(process.bead_model)
    return model.at_feed(model_wire_feed(process, model))


def load(name: str, folder: Path | None = None) -> BeadModel:
    """Return the bead model of a table given by name or path, as in `read_table`.

    Raises the InputErrors of `read_table` and `bead_model.fit`.
    """
    return fit(*read_table(name, folder))


def read_table(name: str, folder: Path | None = None) -> Measured:
    """Read a calibration table, built-in or at a path relative to `folder`.

    Built-in tables: 'csw' (table 1 of Dai 2020) and 'li-2025' (from table 5 of Li 2025).

    Raises InputError NO_FILE, or BAD_TABLE (with row and column, or because the file is not text).
    """
    path = FOLDER / BUILT_IN[name] if name in BUILT_IN else Path(folder or ".", name)
    try:
        text = read_content(path, MAX_FILE_MB, "BAD_TABLE", name).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        if isinstance(error, UnicodeError):
            raise InputError(
                "BAD_TABLE",
                name,
                "the file is not a table: it contains bytes that are not UTF-8 text; save the "
                "table as CSV in UTF-8",
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
    nominal = 0.0
    if len(feed):
        nominal = float(feeds.mean()) if several else float(feed[0]) * 1000.0 / MINUTE
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
    """Raise InputError BAD_TABLE for unknown or repeated columns."""
    for column in header:
        if header.count(column) > 1:
            raise InputError(
                "BAD_TABLE", where, "the column {!r} appears twice; remove one column", column
            )
        if column not in COLUMNS and any(name in COLUMNS for name in header):
            raise InputError(
                "BAD_TABLE",
                where,
                "unknown column {!r}; remove the column, or rename it to one of {}",
                column,
                ", ".join(COLUMNS),
            )


def _row(header: list[str], cells: list[str]) -> dict[str | None, str | None]:
    """Return the cells of a row by column: None for missing cells, surplus cells under the key None."""
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
