# SPDX-License-Identifier: LGPL-2.1-or-later
"""The 3D path of the report: rows of a motion as columns of small integers, and the HTML that draws
them.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.geometry.obstacles import Body, disc
from ...core.motion import Motion
from ...core.simulation.achievable_feed import from_next, speed_ratios
from ...core.toolpath import Toolpath
from ...core.types import Array, Integers, Mask, NDArray
from ...plots.chart import shade
from .. import units
from ..template import read_part

if TYPE_CHECKING:
    from freecad_am.plots.source import Source  # slow to import, and not every report has a page

MOST_ROWS = 200_000  # of a page; a longer motion is thinned to every second row, every third, ...
STEPS = 65534  # of a column between its least and its largest value
NONE = 65535  # code of a missing value
_UNIT = 32767  # of a component of a direction
_ROUND = 1e-9


@dataclass(frozen=True, eq=False)
class Column:
    """Values (k,) of the selected rows, NaN if missing."""

    name: str
    unit: str
    values: Array


@dataclass(frozen=True, eq=False)
class Shown:
    """Rows of a motion that a page shows. rows: (k,) of the motion, in order; times: (k,) s of
    arrival. columns: quantities for colours; axes: the joints."""

    motion: Motion
    rows: Integers
    times: Array
    columns: Sequence[Column]
    axes: Sequence[Column]

    @property
    def box(self) -> tuple[Array, float]:
        """Lower corner (3,) and step, mm, of the positions stored as integers."""
        positions = self.motion.position[self.rows]
        low = positions.min(axis=0)
        return low, max(float((positions.max(axis=0) - low).max()), 1e-6) / STEPS

    def blocks(self) -> list[list[int]]:
        """Return layer, bead, first selected row and deposit flag of each bead and each run of
        rapids."""
        motion, starts = self.motion, _starts(self.motion)
        first_rows = np.searchsorted(self.rows, starts)
        table = np.column_stack(
            (motion.layer[starts], motion.bead[starts], first_rows, motion.deposit[starts])
        )
        blocks: list[list[int]] = table.astype(int).tolist()
        return blocks

    @cached_property
    def _beads(self) -> dict[tuple[int, int], tuple[int, int]]:
        """First and last row of each bead, by its layer and number."""
        motion, starts = self.motion, _starts(self.motion)
        ends = np.append(starts[1:], len(motion)) - 1
        return {
            (int(motion.layer[start]), int(motion.bead[start])): (int(start), int(end))
            for start, end in zip(starts, ends)
            if motion.deposit[start]
        }

    def row_of(self, layer: int | None, bead: int | None, point: int | None) -> int | None:
        """Return the selected row at a position or the last before it, None for an unknown bead.
        Without a bead: the first bead of the layer; without a point: the first of the bead."""
        if layer is None:
            return None
        if bead is None:
            bead = min((number for above, number in self._beads if above == layer), default=0)
        if (layer, bead) not in self._beads:
            return None
        start, end = self._beads[layer, bead]
        return int(np.searchsorted(self.rows, min(start + (point or 0), end), side="right")) - 1


def select_rows(source: Source, labels: Sequence[str] = (), units: Sequence[str] = ()) -> Shown:
    """Select the rows of a job for a page. labels, units: of the axes, deg or mm."""
    motion = source.motion
    rows = _thinned(motion)
    joints = motion.joints[rows] if labels else np.zeros((len(rows), 0))
    axes = [
        Column(label, unit, values if unit == "mm" else np.degrees(values))
        for label, unit, values in zip(labels, units, joints.T)
    ]
    columns = [Column(column.name, column.unit, column.values[rows]) for column in _columns(source)]
    return Shown(motion, rows, source.times.arrive[rows], columns, axes)


def _columns(source: Source) -> list[Column]:
    """Return the quantities for colours, of all rows (n,)."""
    motion, cell = source.motion, source.cell
    upright = np.degrees(np.arccos(np.clip(motion.tool @ source.toolpath.frame[:3, 2], -1.0, 1.0)))
    columns = [
        Column("layer", "", motion.layer.astype(float)),
        _in_units("speed", "mm/s", from_next(motion.deposit, motion.point, motion.speed)),
        _in_units("width", "mm", motion.width),
        Column("tilt", "deg", upright),
    ]
    if cell is not None:
        ratio = speed_ratios(motion.joints, motion.duration, cell.machine.max_speed).max(axis=1)
        columns += [
            Column("joint margin", "%", 100.0 * cell.limits.smallest_share(motion.joints)),
            Column("joint speed", "%", 100.0 * from_next(motion.deposit, motion.point, ratio)),
        ]
    if source.condition is not None:
        columns.append(Column("condition", "", source.condition))
    return [column for column in columns if np.isfinite(column.values).any()]


def _in_units(name: str, unit: str, values: Array) -> Column:
    """Return a column in the units of the page."""
    finite = values[np.isfinite(values)]
    factor, page_unit = units.scale(float(np.abs(finite).max(initial=0.0)), unit)
    return Column(name, page_unit, factor * values)


def _starts(motion: Motion) -> Integers:
    """Return the first row of each run of rapids and of each bead."""
    changed = np.ones(len(motion), dtype=bool)
    for column in (motion.deposit, motion.layer, motion.bead):
        changed[1:] &= column[1:] == column[:-1]
    return np.flatnonzero(~changed | (np.arange(len(motion)) == 0))


def _thinned(motion: Motion) -> Integers:
    """Return the rows to show: all rows, or every k-th row of each bead with its ends."""
    stride = -(-len(motion) // MOST_ROWS)
    if stride <= 1:
        return np.arange(len(motion))
    starts = _starts(motion)
    ends = np.append(starts[1:], len(motion)) - 1
    within = np.arange(len(motion)) - np.repeat(starts, np.diff(np.append(starts, len(motion))))
    is_kept = within % stride == 0
    is_kept[ends] = True
    return np.flatnonzero(is_kept)


class Bytes:
    """Columns one after the other, with the position of each."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, values: NDArray[Any], kind: str) -> dict[str, Any]:
        """Append values as little-endian numbers of a numpy type; return their position for the
        page.
        """
        data = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<")).tobytes()
        entry = {"at": self._size, "count": int(values.size), "kind": kind}
        data += b"\0" * (-len(data) % 4)
        self._parts.append(data)
        self._size += len(data)
        return entry

    def text(self) -> str:
        """Return all columns in base64."""
        return base64.b64encode(b"".join(self._parts)).decode("ascii")


def packed(path_rows: Shown, into: Bytes) -> dict[str, Any]:
    """Return the rows as bytes, with their positions and types."""
    low, step = path_rows.box
    rows, motion = path_rows.rows, path_rows.motion
    return {
        "rows": len(rows),
        "low": low.tolist(),
        "step": step,
        "position": into.add(np.rint((motion.position[rows] - low) / step), "u2"),
        "build": into.add(np.rint(motion.build[rows] * _UNIT), "i2"),
        "tool": into.add(np.rint(motion.tool[rows] * _UNIT), "i2"),
        "laid": into.add(_deposited(motion, rows), "u1"),
        "time": into.add(path_rows.times, "f4"),
        "point": into.add(motion.point[rows], "u4"),
        "blocks": path_rows.blocks(),
        "columns": [
            {**_column(column, into), **_coloured(column, _deposited(motion, rows))}
            for column in path_rows.columns
        ],
        "axes": [_column(column, into) for column in path_rows.axes],
    }


def _deposited(motion: Motion, rows: Integers) -> Mask:
    """Return a mask (k,) of the rows whose segment, from the previous selected row, is
    deposited."""
    deposited: Mask = motion.deposit[rows] & (motion.point[rows] > 0)
    return deposited


def _coloured(column: Column, deposited: Mask) -> dict[str, float]:
    """Return the colour range: smallest and largest value of the deposited rows."""
    values = column.values[deposited & np.isfinite(column.values)]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    return {"least": low, "most": high}


def _column(column: Column, into: Bytes) -> dict[str, Any]:
    finite = np.isfinite(column.values)
    low, high = (
        (float(column.values[finite].min()), float(column.values[finite].max()))
        if finite.any()
        else (0.0, 0.0)
    )
    if high - low <= _ROUND * max(1.0, abs(high)):
        high = low
    step = (high - low) / STEPS if high > low else 1.0
    levels = np.where(finite, np.rint((np.where(finite, column.values, low) - low) / step), NONE)
    return {
        "name": column.name,
        "unit": column.unit,
        "low": low,
        "high": high,
        "values": into.add(levels, "u2"),
    }


_SCRIPTS = ("camera.js", "pieces.js", "drawing.js", "viewer.js")
_MOST_TRIANGLES = 30_000  # of the bodies around the path
_SHADES = 32


@dataclass(frozen=True)
class Turned:
    """The pieces of a page: its element, and data and script for the end of the body."""

    element: str
    data: str


def build_viewer(
    path_rows: Shown, toolpath: Toolpath, width: float, platform: float | None
) -> Turned:
    """Build the 3D viewer of a job's path with the obstacles around it. width: mm, of beads without
    a width. platform: its diameter, mm, or None."""
    into = Bytes()
    facts = packed(path_rows, into)
    bodies = [*toolpath.surroundings, *([disc(platform, toolpath.frame)] if platform else [])]
    stride = max(1, -(-sum(len(body.triangles) for body in bodies) // _MOST_TRIANGLES))
    facts["bodies"] = [_body(body, stride, into) for body in bodies]
    facts["box"] = _box(path_rows)
    facts["length"] = units.scale(float(np.abs(facts["box"]).max()), "mm")
    facts["upright"] = toolpath.frame[:3, :3].T.tolist()
    facts["height"] = toolpath.layer_height
    facts["width"] = width
    facts["ramp"] = [shade(k / (_SHADES - 1)) for k in range(_SHADES)]
    left_out = len(path_rows.motion) - len(path_rows.rows)
    note = f"; {left_out:,} intermediate points are omitted" if left_out else ""
    caption = f"<figcaption>The path with its beads{note}. Underlined places in the tables are shown here.</figcaption>"
    data = json.dumps(facts, separators=(",", ":")).replace("<", "\\u003c")
    return Turned(
        f'<figure class="turned" id="path" hidden>{read_part("viewer_3d/controls.html")}{caption}</figure>',
        f'<script type="application/json" id="path-facts">{data}</script>'
        f'<script type="text/plain" id="path-columns">{into.text()}</script><script>{script()}</script>',
    )


@lru_cache(maxsize=1)
def script() -> str:
    """Return the script of the page, in its own scope."""
    text = "".join(read_part(f"viewer_3d/{name}") for name in _SCRIPTS)
    return f"(() => {{\n{text}}})();\n"


def style() -> str:
    """Return the CSS of the element."""
    return read_part("viewer_3d/viewer.css")


def policy() -> str:
    """Return the content security policy of the page: own drawings and this script only, no
    requests.
    """
    digest = base64.b64encode(hashlib.sha256(script().encode()).digest()).decode()
    return f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"


def _body(body: Body, stride: int, into: Bytes) -> dict[str, Any]:
    """Pack a body as bytes, with every `stride`-th triangle."""
    return {
        "name": body.name,
        "vertices": into.add(body.vertices, "f4"),
        "triangles": into.add(body.triangles[::stride], "u4"),
    }


def _box(path_rows: Shown) -> list[list[float]]:
    """Return the lower and upper corner of the deposit, the box that the view turns about."""
    deposited = path_rows.motion.position[path_rows.motion.deposit]
    return np.stack([deposited.min(axis=0), deposited.max(axis=0)]).tolist()
