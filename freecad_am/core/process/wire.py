# SPDX-License-Identifier: LGPL-2.1-or-later
"""Balance of wire feed and beads: wire volume per second = bead cross-section x travel speed."""

from __future__ import annotations

import csv
from collections.abc import Sequence
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
    cross-section, mm2. settings: sum of 2^entry. fed: mean length of wire per length of bead if the wire
    feed follows the travel speed, else 0.
    """

    bead_class: str
    phase: int
    rate: float
    layer: int
    bead: int
    section: float
    settings: int = 0
    fed: float = 0.0

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
    deviations = [
        (
            abs(
                (
                    process.wire.section * rate_of_class.fed / rate_of_class.section
                    if rate_of_class.fed
                    else wire_rate / rate_of_class.rate
                )
                - 1.0
            ),
            rate_of_class.layer,
            rate_of_class.bead,
        )
        for rate_of_class in taken_of(toolpath)
        if by_wire(rate_of_class, process)
        and (wire_rate := process.wire.section * _feed_of(rate_of_class, toolpath, process)) > 0.0
    ]
    return max(deviations, key=lambda deviation: deviation[0], default=None)


def _feed_of(rate_of_class: Taken, toolpath: Toolpath, process: ProcessParameters) -> float:
    """Return the wire feed of a class at its place, mm/s; 0 without wire."""
    feed = _place_feed(rate_of_class.bead_class, rate_of_class.settings, toolpath, process)
    return (toolpath.wire_feed or 0.0) if feed is None else feed


def _place_feed(
    name: str, active: int, toolpath: Toolpath, process: ProcessParameters
) -> float | None:
    """Return the wire feed that settings by place give, mm/s; None if they give none."""
    feed = process.values_at_place(active).get("wire_feed")
    if not isinstance(feed, str):
        return feed
    speed = process.at_place(name, active).travel_speed
    section = (toolpath.bead_width or 0.0) * toolpath.layer_height
    return section * speed / process.wire.section


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
            sums[key] = sums.get(key, np.zeros(4)) + sum_
            first_bead.setdefault(key, (layer, number))
    return [
        Taken(
            *key[:2],
            float(volume / time),
            *first_bead[key],
            float(volume / length),
            key[2],
            float(wire / length),
        )
        for key, (volume, time, length, wire) in sums.items()
        if time > 0.0
    ]


def _sums(bead: Bead, usual: float, toolpath: Toolpath) -> dict[tuple[int, int], Array]:
    """Return sums (4,) of a bead by phase and settings by place.

    They are volume, mm3, time, s, length, mm, and length of wire that follows the speed, mm. Before the phase of each segment is planned, they are derived from the lengths of the bead ends.
    """
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    section: Array | float = usual
    if bead.width is not None or bead.height is not None:
        high = toolpath.layer_height if bead.height is None else bead.height
        area = high * (
            np.full(len(bead), toolpath.bead_width) if bead.width is None else bead.width
        )
        section = 0.5 * (area[1:] + area[:-1])
    share = np.zeros(len(length)) if bead.wire_share is None else bead.wire_share[1:]
    amounts = np.stack([section * length, length / bead.speed[1:], length, share * length])
    if bead.phase is not None or bead.settings is not None:
        phases = np.full(len(length), MIDDLE) if bead.phase is None else bead.phase[1:].astype(int)
        kinds = np.stack([phases, settings_of(bead)[1:].astype(int)])
        return {
            (phase, active): amounts[:, (kinds[0] == phase) & (kinds[1] == active)].sum(axis=1)
            for phase, active in np.unique(kinds, axis=1).T.tolist()
        }
    return {(phase, 0): sum_ for phase, sum_ in _sums_before_planning(bead, amounts).items()}


def _sums_before_planning(bead: Bead, amounts: Array) -> dict[int, Array]:
    """Return the sums of `_sums` by phase of a bead without phases. amounts: (4, n) of its segments."""
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
                0.0,
            ]
    for phase, long, speed in (
        (AT_START, ends.start_length, ends.start_speed),
        (AT_END, ends.end_length, ends.end_speed),
    ):
        if long:
            sums[phase] = total * (long / size)
            if speed:
                sums[phase][1] = long / speed
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
    toolpath: Toolpath,
    process: ProcessParameters,
    model: BeadModel | None,
    is_slowed: bool = False,
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
    is_slowed : bool, optional
        Whether layers will be slowed, so that the wire feed has to follow.

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
        fed_path = _following(replace(toolpath, wire_feed=balanced), process, is_slowed)
        return _check_classes(_by_place(fed_path, process), process)
    fed_path = _following(replace(toolpath, wire_feed=process.wire.feed), process, is_slowed)
    fed_path = _by_place(fed_path, process)
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


def _following(toolpath: Toolpath, process: ProcessParameters, is_slowed: bool) -> Toolpath:
    """Return the toolpath with a wire feed that follows the travel speed, if applicable.

    This needs the feed mode `proportional`, and beads with ramps or slowed layers. For stepped speeds a schedule gives
    the feed. Where the width of a bead differs, the feed is nominal at the speed for this width.
    """
    ramped = any(bead.ends is not None and bead.ends.has_ramps for _, _, bead in toolpath)
    if (
        process.wire.feed_mode != "proportional"
        or not toolpath.wire_feed
        or not (ramped or is_slowed)
    ):
        return toolpath
    share = toolpath.wire_feed / process.travel_speed
    return replace(
        toolpath,
        layers=tuple(
            replace(
                layer,
                beads=tuple(
                    replace(bead, wire_share=share * (_usual_speeds(bead, process) / bead.speed))
                    for bead in layer.beads
                ),
            )
            for layer in toolpath.layers
        ),
    )


def _by_place(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with the wire feeds of settings by place, where any of them holds."""
    places = [settings_of(bead).astype(int) for _, _, bead in toolpath]
    combinations = np.unique(np.concatenate(places)).tolist() if places else []
    if not any("wire_feed" in process.values_at_place(active) for active in combinations):
        return toolpath
    nominal = toolpath.wire_feed or 0.0
    feeds_of_class: dict[str, dict[int, float]] = {}
    for _, _, bead in toolpath:
        name = bead.role.bead_class
        if name not in feeds_of_class:
            feeds = {
                active: _place_feed(name, active, toolpath, process) for active in combinations
            }
            feeds_of_class[name] = {
                active: nominal if feed is None else feed for active, feed in feeds.items()
            }
    return replace(
        toolpath,
        layers=tuple(
            replace(
                layer,
                beads=tuple(
                    replace(bead, wire_feeds=feeds_of_class[bead.role.bead_class])
                    for bead in layer.beads
                ),
            )
            for layer in toolpath.layers
        ),
    )


def _usual_speeds(bead: Bead, process: ProcessParameters) -> Array:
    """Return the travel speeds (n,) of the class and the places of a bead, without those for its width."""
    combinations, index = np.unique(settings_of(bead).astype(int), return_inverse=True)
    speeds = [
        process.at_place(bead.role.bead_class, active).travel_speed
        for active in combinations.tolist()
    ]
    return np.asarray(np.array(speeds)[np.ravel(index)])


def _check_classes(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with an issue if the wire feed is unbalanced for some classes or phases.

    Classes and phases with a separate schedule are not checked.
    """
    wire_rate = (toolpath.wire_feed or 0.0) * process.wire.section
    if not _at_other_speeds(process) or follows_speed(toolpath):
        return toolpath
    all_off = [
        (rate_of_class, rate)
        for rate_of_class in taken_of(toolpath)
        if by_wire(rate_of_class, process)
        and (rate := process.wire.section * _feed_of(rate_of_class, toolpath, process)) > 0.0
        and abs(rate - rate_of_class.rate) > TOLERANCE * rate_of_class.rate
    ]
    off_by_place = [entry for entry in all_off if _sets_feed(entry[0], process)]
    toolpath = replace(
        toolpath, issues=(*toolpath.issues, *_place_issues(off_by_place, process.wire.section))
    )
    off = [rate_of_class for rate_of_class, _ in all_off if not _sets_feed(rate_of_class, process)]
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


def _sets_feed(rate_of_class: Taken, process: ProcessParameters) -> bool:
    return "wire_feed" in process.values_at_place(rate_of_class.settings)


def _place_issues(off: Sequence[tuple[Taken, float]], section: float) -> list[Issue]:
    """Return warnings about places whose wire feed is unbalanced. section: of the wire, mm2."""
    return [
        Issue(
            WARNING,
            CODE,
            Text(
                "{}: the wire feeds {:.4g} mm3/s, but the beads need {:.4g} mm3/s at their travel "
                "speed; set the wire feed of the place to {:.4g} mm/s or to auto, or correct its "
                "travel speed",
                rate_of_class.name,
                rate,
                rate_of_class.rate,
                rate_of_class.rate / section,
            ),
            rate_of_class.layer,
            rate_of_class.bead,
        )
        for rate_of_class, rate in off
    ]


def _at_other_speeds(process: ProcessParameters) -> bool:
    """Whether any class, phase or place has a separate travel speed, or a place its own wire feed."""
    named = [process, *(process.for_class(name) for name in CLASSES)]
    keys = {key for setting in process.settings for key in setting.own_values()}
    if keys & {"travel_speed", "wire_feed"}:
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
