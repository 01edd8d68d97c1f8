# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes the tables of comparison.md from the reports of the jobs in comparison.csv.

    ./freecad-am batch docs/comparison.csv --job resources/examples/hemisphere.yaml -o out/comparison
    python3 docs/make_comparison.py out/comparison

Only what stands between `<!-- table NAME -->` and `<!-- end -->` is replaced.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

PAGE = Path(__file__).resolve().parent / "comparison.md"
METHODS = {
    "constant": "constant RZ",
    "point-by-point": "point by point",
    "layer-by-layer": "layer by layer",
}
SMALLEST = 1e-4  # deg and its derivatives
PER_AXIS = {
    "range_per_layer_max_deg": "range in a layer, deg",
    "speed_max_deg_s": "speed, deg/s",
    "acceleration_max_deg_s2": "acceleration, deg/s²",
    "jerk_max_deg_s3": "jerk, deg/s³",
}


def number(value: float | None) -> str:
    """Three digits; large numbers written out."""
    if value is None:
        return "-"
    text = f"{value:.3g}"
    return f"{float(text):,.0f}" if abs(value) >= 1000 else text


def angle(value: float | None) -> str:
    """A figure of an axis, 0 for what is less than the last digit of a program can hold."""
    return number(0.0 if value is not None and abs(value) < SMALLEST else value)


def outcome(entry: dict[str, Any], report: dict[str, Any]) -> str:
    """Whether a method is feasible, else the first thing that forbids it."""
    if entry["feasible"]:
        return "yes"
    errors = [issue for issue in entry.get("issues", report["issues"]) if issue["level"] == "error"]
    return f"no: {errors[0]['message']} (layer {errors[0]['layer']})" if errors else "no"


def tables(report: dict[str, Any]) -> str:
    """The tables of one part."""
    found = {entry["method"]: entry for entry in [report["joints"], *report["comparison"]]}
    axes = report["machine"]["axes"]
    count = report["counts"]
    lines = [
        f"{count['layers']} layers, {count['points']:,} points, limit set `{report['machine']['limits']}`.",
        "",
        "| method | feasible | objective | smallest condition | planning time, s |",
        "| --- | --- | --- | --- | --- |",
    ]
    for method, name in METHODS.items():
        entry = found[method]
        figures = [number(entry[key]) for key in ("objective_value", "condition_min")]
        lines.append(
            f"| {name} | {outcome(entry, report)} | {' | '.join(figures)} | {entry['planning_time_s']:.1f} |"
        )
    head = f"largest of {axes[0]} to {axes[-2]} / of {axes[-1]}"
    lines += ["", f"| {head} | {' | '.join(METHODS.values())} |", "| --- | --- | --- | --- |"]
    for key, what in PER_AXIS.items():
        cells = []
        for method in METHODS:
            *others, last = found[method][key] or [None, None]
            largest = None if None in others else max(others)
            cells.append(f"{angle(largest)} / {angle(last)}")
        lines.append(f"| {what} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main(folder: Path) -> None:
    """Renew every table of the page."""

    def renewed(match: re.Match[str]) -> str:
        report = json.loads((folder / match[1] / "report.json").read_text(encoding="utf-8"))
        return f"<!-- table {match[1]} -->\n{tables(report)}\n<!-- end -->"

    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(
        re.sub(r"<!-- table (\w+) -->.*?<!-- end -->", renewed, text, flags=re.DOTALL),
        encoding="utf-8",
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_comparison.py FOLDER_OF_THE_BATCH")
    main(Path(sys.argv[1]))
