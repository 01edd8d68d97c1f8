# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of solids against PrusaSlicer: same mesh, layer height and bead width, one judge for both.

Rows hold void and double deposit of the median and the worst layer to limits, and processor time per 1,000 points to
PrusaSlicer's. A table of all figures goes to standard error. INFILL_CASES=star,zigzag selects cases by words of their names
and fills.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from statistics import median
from typing import NamedTuple

import numpy as np

import infill_parts
import prusa
from infill_judge import Stroke, Verdict, judge
from infill_parts import BEAD, LAYER, Case, Triangles
from rows import Row
from sizes import choose, is_smallest

CHORD_ERROR = 0.05  # mm
NARROWEST = 0.3  # of the bead
MEDIAN_SHARE, WORST_SHARE = (
    1.0,
    3.0,
)  # per cent of the section, void or over, in the median and the worst layer
MEDIAN_TIMES, WORST_TIMES = 2.0, 4.0  # PrusaSlicer's processor time per 1,000 points
ISLANDS = choose((8, 16), (1, 2))  # along the sides of two squares of islands
LINEAR_TIMES = 1.25  # the time of as many islands in proportion
RESOLUTION = 1e-3  # per cent; the raster shows no smaller share
JOB = Path(__file__).resolve().parent / "infill_job.py"


class Result(NamedTuple):
    """What a slicer does with a case: a verdict of each layer, processor seconds, number of points."""

    verdicts: list[Verdict]
    seconds: float
    points: int

    def shares(self, name: str) -> np.ndarray:
        """(n,) per cent of the section in each layer."""
        return 100.0 * np.array([getattr(verdict, name) for verdict in self.verdicts])

    @property
    def pace(self) -> float:
        """Processor seconds per 1,000 points."""
        return 1e3 * self.seconds / max(self.points, 1)


def run() -> list[Row]:
    """Compare void, double deposit and processor time of each case."""
    cases = selected_cases(os.environ.get("INFILL_CASES", ""))
    with_peer = not is_smallest() and prusa.is_there()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        meshes = [
            infill_parts.write_mesh(case.shape(), folder / f"{number}.stl")
            for number, case in enumerate(cases)
        ]
        ours = our_results(cases, meshes, folder)
        peers = [
            peer_result(case, folder / f"{number}.stl", mesh) if with_peer else None
            for number, (case, mesh) in enumerate(zip(cases, meshes))
        ]
        print(table(cases, ours, peers), file=sys.stderr)
        rows = [
            row
            for case, our, peer in zip(cases, ours, peers)
            for row in (*quality_rows(case, our), time_row(case, our, peer))
        ]
        return [*rows, median_time_row(ours, peers), islands_row(folder)]


def selected_cases(words: str) -> tuple[Case, ...]:
    """The cases of this size of the benchmark with one of the words, parted by commas, in name or fill; all without words."""
    cases = choose(infill_parts.CASES, infill_parts.SMALLEST_CASES)
    return tuple(
        case
        for case in cases
        if any(word in f"{case.name}, {case.fill}" for word in words.split(","))
    )


def our_results(cases: tuple[Case, ...], meshes: list[Triangles], folder: Path) -> list[Result]:
    """What we do with the cases, in one other process."""
    results = []
    for beads, mesh in zip(planned_beads(cases, folder), meshes):
        base = mesh.corners[:, :, 2].min()
        layers = our_layers(beads["points"], beads["widths"], beads["counts"], base)
        results.append(
            Result(verdicts(mesh, layers), float(beads["seconds"]), len(beads["points"]))
        )
    return results


def planned_beads(cases: tuple[Case, ...], folder: Path) -> list[dict[str, np.ndarray]]:
    """The arrays that `infill_job.save_beads` writes of each case; meshes are in the folder by number."""
    jobs = [
        {
            "mesh": str(folder / f"{number}.stl"),
            "beads": str(folder / f"{number}.npz"),
            "strategy": strategy(case),
        }
        for number, case in enumerate(cases)
    ]
    (folder / "jobs.json").write_text(json.dumps(jobs), encoding="utf-8")
    subprocess.run([sys.executable, str(JOB), str(folder / "jobs.json")], check=True)
    return [dict(np.load(job["beads"])) for job in jobs]


def strategy(case: Case) -> dict[str, object]:
    """Our parameters of a case."""
    return {
        "layer_height": LAYER,
        "bead_spacing": BEAD,
        "chord_error": CHORD_ERROR,
        "fill": case.fill,
        "widths": "adaptive",
        "walls": prusa.WALLS,
        "narrowest": f"{100.0 * NARROWEST:g} %",
    }


def our_layers(
    points: np.ndarray, widths: np.ndarray, counts: np.ndarray, base: float
) -> dict[int, list[Stroke]]:
    """Strokes by number of the layer. points: (n, 3) and widths: (n,) mm at the points of all beads; base: mm."""
    layers: dict[int, list[Stroke]] = {}
    ends = np.cumsum(counts)
    for start, end in zip(ends - counts, ends):
        number = round(float(points[start, 2] - base) / LAYER)
        wide = widths[start:end]
        stroke = Stroke(points[start:end, :2], 0.5 * (wide[1:] + wide[:-1]))
        layers.setdefault(number, []).append(stroke)
    return layers


def peer_result(case: Case, file: Path, mesh: Triangles) -> Result:
    """What PrusaSlicer does with a case."""
    sliced = prusa.slice_mesh(file, case.fill, BEAD, LAYER, CHORD_ERROR, NARROWEST)
    return Result(verdicts(mesh, sliced.layers), sliced.seconds, sliced.points)


def verdicts(mesh: Triangles, layers: dict[int, list[Stroke]]) -> list[Verdict]:
    """Judge each layer of a mesh, equal ones once; one without strokes is void."""
    judged: dict[bytes, Verdict] = {}
    result = []
    for number in range(mesh.layer_count):
        section, strokes = mesh.section(number), layers.get(number, [])
        arrays = [section, *(array for stroke in strokes for array in stroke)]
        key = b"".join(array.tobytes() for array in arrays)
        if key not in judged:
            judged[key] = judge(section, strokes, BEAD, NARROWEST * BEAD)
        result.append(judged[key])
    return result


def quality_rows(case: Case, our: Result) -> list[Row]:
    """Void and over of a case in the median and the worst layer."""
    return [
        Row(
            f"{case.name}, {case.fill}: {name} in the {which} layer against the limit",
            max(float(figure(our.shares(name))), RESOLUTION),
            limit,
            "%",
            1.0,
        )
        for name in ("void", "over")
        for which, figure, limit in (
            ("median", np.median, MEDIAN_SHARE),
            ("worst", np.max, WORST_SHARE),
        )
    ]


def time_row(case: Case, our: Result, peer: Result | None) -> Row:
    """Processor time of a case."""
    name = f"{case.name}, {case.fill}: processor time per 1,000 points against PrusaSlicer's"
    return Row(name, our.pace, peer and peer.pace, "s", 1.0 / WORST_TIMES)


def median_time_row(ours: list[Result], peers: list[Result | None]) -> Row:
    """Processor time in the median of the cases: our times PrusaSlicer's, against what they may be."""
    ratios = [our.pace / peer.pace for our, peer in zip(ours, peers) if peer is not None]
    name = (
        "median of these: our processor time per 1,000 points in PrusaSlicer's, against the limit"
    )
    if not ratios:
        return Row(name, 0.0, None, "times", 1.0)
    return Row(name, median(ratios), MEDIAN_TIMES, "times", 1.0)


def islands_row(folder: Path) -> Row:
    """Processor time of many islands, against fewer in proportion."""
    cases = tuple(
        Case(f"{side**2} islands", partial(infill_parts.square_islands, side)) for side in ISLANDS
    )
    for number, case in enumerate(cases):
        infill_parts.write_mesh(case.shape(), folder / f"{number}.stl")
    few, many = (float(beads["seconds"]) for beads in planned_beads(cases, folder))
    times = ISLANDS[1] ** 2 / ISLANDS[0] ** 2
    name = f"{ISLANDS[1] ** 2} islands against {times:g} times the time of {ISLANDS[0] ** 2}"
    return Row(name, many, times * few, "s", 1.0 / LINEAR_TIMES)


def table(cases: tuple[Case, ...], ours: list[Result], peers: list[Result | None]) -> str:
    """All figures as a table of Markdown: median / worst layer in per cent of the section, and processor seconds."""
    lines = [
        "| solid, fill | slicer | void | over | outside | points | s | s per 1,000 | ratio |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for case, our, peer in zip(cases, ours, peers):
        for slicer, result in (("ours", our), ("PrusaSlicer", peer)):
            if result is None:
                continue
            shares = " | ".join(
                f"{np.median(result.shares(name)):.2f} / {result.shares(name).max():.2f}"
                for name in Verdict._fields
            )
            ratio = f"{our.pace / peer.pace:.1f}" if peer is not None and slicer == "ours" else ""
            lines.append(
                f"| {case.name}, {case.fill} | {slicer} | {shares} | {result.points:,} "
                f"| {result.seconds:.2f} | {result.pace:.2f} | {ratio} |"
            )
    return "\n".join(lines)
