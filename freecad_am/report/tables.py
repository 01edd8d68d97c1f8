# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables, picture grids and formatted numbers of the page, as HTML."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Any

from . import units


def clock(seconds: float) -> str:
    """Format seconds as hours and minutes, or minutes and seconds."""
    minutes, remainder = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {remainder:02d} s"


def grid_of(plots: Iterable[str]) -> str:
    """Return pictures side by side; empty without pictures."""
    figures = "".join(f"<figure>{plot}</figure>" for plot in plots)
    return f'<div class="grid">{figures}</div>' if figures else ""


def axis_names(report: dict[str, Any]) -> list[str]:
    """Return the axis names, with units if units differ."""
    axes, units = report["machine"]["labels"], report["machine"]["units"]
    return [f"{axis}, {unit}" for axis, unit in zip(axes, units)] if "mm" in units else axes


def in_units(word: str, report: dict[str, Any]) -> str:
    """Return the label of a per-axis row, with mm after degrees if some axes are prismatic."""
    name, _, unit = word.rpartition(", ")
    mixed = unit.startswith("deg") and "mm" in report["machine"]["units"]
    return f"{name}, {unit} or {unit.replace('deg', 'mm')}" if mixed else word


_NAMES = ("material",)  # rows with user-defined names


def pairs_of(title: str, values: dict[str, str]) -> str:
    """Return a titled table of names and values."""
    rows = [
        (word, [value if word in _NAMES else units.text(value)]) for word, value in values.items()
    ]
    return f"<h2>{title}</h2>{table_of(rows)}"


def material_row(report: dict[str, Any]) -> dict[str, str]:
    """Return the material and the source of its data; empty if the job names no material."""
    material = report["process"]["material"]
    if material is None:
        return {}
    return {
        "material": material["name"] + (f" ({material['source']})" if material["source"] else "")
    }


def table_of(rows: Iterable[tuple[str, Iterable[str]]]) -> str:
    """Return a table of named rows."""
    rows = [units.row(word, [str(value) for value in values], figure_text) for word, values in rows]
    lines = "".join(
        f"<tr><td>{escape(word)}</td>{''.join(f'<td>{escape(value)}</td>' for value in values)}</tr>"
        for word, values in rows
    )
    return f'<div class="table" style="margin-top:10px"><table>{lines}</table></div>'


def figure_text(value: Any) -> str:
    """Format a value with its significant digits."""
    if value is None:
        return "\u2013"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        if abs(value) >= 1e4:
            return f"{value:,.0f}"
        if abs(value) < 1e-8:
            return "0"  # rounding residue
        return f"{value:.4g}" if abs(value) >= 1e-3 else f"{value:.1e}"
    return str(value)


def classes_of(rows: list[dict[str, Any]]) -> str:
    """Return the table of totals per bead class."""
    if not rows:
        return ""
    woven = ["weave"] if any("weave" in row for row in rows) else []
    length_head, per_mm = units.label("length, mm", max(row["length_mm"] for row in rows))
    speed_head, per_mm_s = units.label("travel speed, mm/s", 1.0)
    lines = [("", ["beads", length_head, "deposit", speed_head, "schedule", *woven])]
    for row in rows:
        low, high = (
            figure_text(per_mm_s * row["travel_speed_mm_s"][end]) for end in ("min", "max")
        )
        speed = low if low == high else f"{low} to {high}"
        length = f"{per_mm * row['length_mm']:,.0f}"
        numbers = [
            str(row["beads"]),
            length,
            clock(row["deposit_s"]),
            speed,
            figure_text(row["schedule"]),
        ]
        numbers += [figure_text(row["weave"]) for _ in woven]
        lines.append((row["class"].replace("_", " "), numbers))
    return f"<h2>Classes of beads</h2>{table_of(lines)}"
