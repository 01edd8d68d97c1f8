# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads whose gap to the optimum is closed with a free rotation at each point: the joints in the
waypoints give their objective."""

import csv
import json

import numpy as np
import pytest

# strokes of the axes, whose inverses are the weights of eq. 17: from the manufacturer, and from the
# paper, whose last axis is continuous
MAKER_DEG, PAPER_DEG = (
    [340.0, 260.0, 310.0, 400.0, 280.0, 540.0],
    [370.0, 320.0, 546.0, 400.0, 270.0, 360e6],
)


def _planned(workshop, text, strokes, close):
    """Return `joints.optimality` of the report of the planned job; its objective equals that of its
    waypoints."""
    workshop.write_job(f"{text}joints: {{certificate: true, close_gap: {close}}}\n")
    assert workshop.run("plan", "cup.yaml", "--no-page", "-o", close).status == 0
    folder = workshop.folder / close
    proved = json.loads((folder / "report.json").read_text(encoding="utf-8"))["joints"][
        "optimality"
    ]
    with (folder / "waypoints.csv").open(encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    joints = np.radians([[float(row[f"q{k}_deg"]) for k in range(1, 7)] for row in rows])
    bead_ids = [(row["layer"], row["bead"]) for row in rows]
    moved = [
        following - previous
        for previous, following, a, b in zip(joints, joints[1:], bead_ids, bead_ids[1:])
        if a == b
    ]
    objective = float((np.square(moved) @ (1.0 / np.radians(strokes))).sum())
    assert proved["objective"] == pytest.approx(objective, rel=1e-4)
    return proved


def _assert_none_below(lines, free):
    """Assert, bead by bead, that the lower bound of the linear path also holds for paths that are
    free at every point."""
    for linear_bead, free_bead in zip(lines["beads"], free["beads"], strict=True):
        assert free_bead["objective"] >= linear_bead["bound"] * (1.0 - 1e-6), (
            linear_bead,
            free_bead,
        )


@pytest.mark.long
def test_the_bend_of_the_examples(workshop, root):
    """With linear rotation, in layers of 8 mm, a gap of 12 % remains; with free points less than 1
    %."""
    example = root / "resources" / "examples" / "pipe-bend.yaml"
    text = example.read_text(encoding="utf-8").replace("layer_height: 2.5 mm", "layer_height: 8 mm")
    text = text.replace("file: pipe-bend.step", f"file: {example.with_suffix('.step')}")
    lines, free = (_planned(workshop, text, MAKER_DEG, close) for close in ("false", "true"))
    assert 0.08 < lines["gap"] < 0.16
    assert 0.0 <= free["gap"] < 0.01 and free["worst"]["gap"] < 0.05
    _assert_none_below(lines, free)


@pytest.mark.long
def test_the_rotor_of_the_examples(workshop, root):
    """Linear rotation cannot follow the blades and leaves most of the gap; with free points less
    than 5 % remains."""
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
