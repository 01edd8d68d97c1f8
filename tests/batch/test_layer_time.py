# SPDX-License-Identifier: LGPL-2.1-or-later
"""`strategy.min_layer_time` of walls, parts of revolution and curves, from the text of the program and the waypoints."""

import csv
import math
import re
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "resources" / "examples"
LEAST = 45.0  # s
CELL = """
cell: {machine: fanuc-arcmate120ic, setup: part-on-robot, deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0],
       platform: 5 mm, branch: BRANCH, platform_diameter: 0 mm}
process: {travel_speed: 8 mm/s}
program: {post: fanuc}
"""
REVOLUTION = """part: {{file: {0}/hemisphere.step}}
strategy: {{kind: revolution, layer_height: 9 mm, chord_error: 0.5 mm{1}}}"""
WALL = """part: {{file: {0}/tube-on-pipe.step}}
substrate: {{file: {0}/pipe.step}}
strategy: {{kind: surface, layer_height: 8 mm, chord_error: 0.5 mm{1}}}"""
CURVES = "part: {{file: ring.csv}}\nstrategy: {{kind: curves, layer_height: 2 mm, chord_error: 0.1 mm, repeat: 3{1}}}"
KINDS = pytest.mark.parametrize(
    ("part", "branch"),
    [
        (REVOLUTION, "[front, up, flip]"),
        (WALL, "auto"),
        (CURVES, "[front, up, flip]"),
    ],
    ids=["revolution", "wall", "curves"],
)


def planned(workshop, part, branch, more):
    """Rows of the waypoints, lines of the program, and what was told."""
    ring = [
        (30.0 * math.cos(k / 20 * math.tau), 30.0 * math.sin(k / 20 * math.tau), 5.0)
        for k in range(21)
    ]
    table = "x,y,z\n" + "\n".join(",".join(f"{value:.6f}" for value in one) for one in ring) + "\n"
    (workshop.folder / "ring.csv").write_text(table, encoding="utf-8")
    text = part.format(EXAMPLES, more) + CELL.replace("BRANCH", branch)
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    done = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    if done.status:
        return done, [], []
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    files = sorted((workshop.folder / "out" / "program").glob("*.LS"))
    lines = [line for path in files for line in path.read_text(encoding="ascii").splitlines()]
    return done, rows, lines


def times_of_layers(rows, lines):
    """s from the first deposit of each layer to that of the next: ways over speeds of the waypoints, and what the program
    waits at each of its moves, which are as many."""
    waits, move = [0.0] * (len(rows) + 1), 0
    for line in lines:
        if re.match(r"\s*\d+:\s*[LJ] P\[", line):
            move += 1
        elif found := re.match(r"\s*\d+:\s*WAIT\s+([\d.]+)\(sec\)", line):
            waits[move] += float(found[1])
    places = [[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows]
    starts, now, moves = [], 0.0, 1
    for k, row in enumerate(rows):
        # where the approach ends the bead begins: one move of the program, two rows
        if k and not (
            row["kind"] == "deposit" and row["point"] == "0" and places[k] == places[k - 1]
        ):
            now += math.dist(places[k - 1], places[k]) / float(row["speed_mm_s"]) + waits[moves]
            moves += 1
        if row["kind"] == "deposit" and int(row["layer"]) == len(starts):
            starts.append(now)
    assert moves == move
    return [b - a for a, b in zip(starts, starts[1:])]


@KINDS
@pytest.mark.always("revolution", "curves")
def test_no_layer_takes_less(workshop, part, branch):
    done, rows, lines = planned(workshop, part, branch, "")
    assert done.status == 0 and not any("WAIT " in line for line in lines), done.err
    short = times_of_layers(rows, lines)
    assert min(short) < LEAST
    done, rows, lines = planned(workshop, part, branch, f", min_layer_time: {LEAST} s")
    assert done.status == 0, done.err
    long = times_of_layers(rows, lines)
    assert len(long) == len(short) > 1
    # seconds are written with two digits, and rapids do not go straight: they take longer than was counted on
    assert min(long) > LEAST - 0.02
    # the last one is waited before by no layer, and what takes long enough is not waited for
    assert all(b == pytest.approx(max(a, LEAST), rel=0.1) for a, b in zip(short, long))
    assert "WAITS" in done.err and f"every layer takes at least {LEAST:g} s" in done.err


def test_a_spiral_has_no_layers_to_wait_between(workshop):
    done, _, _ = planned(
        workshop, REVOLUTION, "[front, up, flip]", ", path: spiral, min_layer_time: 5 s"
    )
    assert (
        done.status == 2
        and "strategy.min_layer_time: a spiral has no layers to wait between" in done.err
    )
