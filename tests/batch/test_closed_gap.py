# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads whose gap to what is possible is closed, each point free: what they take is summed up from the joints that are
written."""

import csv
import json

import numpy as np
import pytest

# strokes of the axes, one over each of which is its weight in eq. 17: of the maker, and of the paper, whose last has no end
MAKER_DEG, PAPER_DEG = (
    [340.0, 260.0, 310.0, 400.0, 280.0, 540.0],
    [370.0, 320.0, 546.0, 400.0, 270.0, 360e6],
)


def _planned(workshop, text, strokes, close):
    """The job planned: `joints.optimality` of its report, whose objective is that of its waypoints."""
    workshop.write_job(f"{text}joints: {{certificate: true, close_gap: {close}}}\n")
    assert workshop.run("plan", "cup.yaml", "--no-page", "-o", close).status == 0
    folder = workshop.folder / close
    proved = json.loads((folder / "report.json").read_text(encoding="utf-8"))["joints"][
        "optimality"
    ]
    with (folder / "waypoints.csv").open(encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    joints = np.radians([[float(row[f"q{k}_deg"]) for k in range(1, 7)] for row in rows])
    places = [(row["layer"], row["bead"]) for row in rows]
    moved = [
        after - before
        for before, after, a, b in zip(joints, joints[1:], places, places[1:])
        if a == b
    ]
    taken = float((np.square(moved) @ (1.0 / np.radians(strokes))).sum())
    assert proved["objective"] == pytest.approx(taken, rel=1e-4)
    return proved


def _assert_none_below(lines, free):
    """What is proved of the path of lines holds for courses that are free at every point too, bead by bead."""
    for bound, found in zip(lines["beads"], free["beads"], strict=True):
        assert found["objective"] >= bound["bound"] * (1.0 - 1e-6), (bound, found)


@pytest.mark.long
def test_the_bend_of_the_examples(workshop, root):
    """With lines, in layers of 8 mm, a gap of 12 % is left; with each point free less than 1 %."""
    example = root / "resources" / "examples" / "pipe-bend.yaml"
    text = example.read_text(encoding="utf-8").replace("layer_height: 2.5 mm", "layer_height: 8 mm")
    text = text.replace("file: pipe-bend.step", f"file: {example.with_suffix('.step')}")
    lines, free = (_planned(workshop, text, MAKER_DEG, close) for close in ("false", "true"))
    assert 0.08 < lines["gap"] < 0.16
    assert 0.0 <= free["gap"] < 0.01 and free["worst"]["gap"] < 0.05
    _assert_none_below(lines, free)


@pytest.mark.long
def test_the_rotor_of_the_examples(workshop, root):
    """Lines cannot follow its blades and leave nearly all of what they take; with each point free less than 5 %."""
    folder = root / "resources" / "examples" / "rotor"
    text = f"""version: 1
name: rotor
part: {{file: {folder / "blades.brep"}}}
substrate: {{file: {folder / "hub.step"}}}
strategy: {{kind: developable, layer_height: 4 mm, bead_spacing: 6.5 mm}}
cell: {{machine: fanuc-arcmate120ic, limits: paper, platform: 20 mm, branch: [front, up, flip]}}
process: {{travel_speed: 6 mm/s}}
"""
    lines, free = (_planned(workshop, text, PAPER_DEG, close) for close in ("false", "true"))
    assert lines["gap"] > 0.5
    assert 0.0 <= free["gap"] < 0.05
    _assert_none_below(lines, free)
