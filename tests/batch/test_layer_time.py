# SPDX-License-Identifier: LGPL-2.1-or-later
"""`strategy.min_layer_time` of walls, parts of revolution and curves, from the text of the program
and the waypoints."""

import csv
import math
import re
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "resources" / "examples"
MIN_LAYER_TIME_S = 45.0  # s
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


def planned(workshop, kind, branch, options):
    """Return the rows of the waypoints, the lines of the program and the messages."""
    ring = [
        (30.0 * math.cos(k / 20 * math.tau), 30.0 * math.sin(k / 20 * math.tau), 5.0)
        for k in range(21)
    ]
    table = (
        "x,y,z\n" + "\n".join(",".join(f"{value:.6f}" for value in point) for point in ring) + "\n"
    )
    (workshop.folder / "ring.csv").write_text(table, encoding="utf-8")
    text = kind.format(EXAMPLES, options) + CELL.replace("BRANCH", branch)
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    if command.status:
        return command, [], []
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    files = sorted((workshop.folder / "out" / "program").glob("*.LS"))
    lines = [line for path in files for line in path.read_text(encoding="ascii").splitlines()]
    return command, rows, lines


def times_of_layers(rows, lines):
    """Return the time in s from the first deposit of each layer to that of the next: distances
    over speeds of the waypoints, and the waits of the program at its moves, which have the same
    number."""
    waits, move = [0.0] * (len(rows) + 1), 0
    for line in lines:
        if re.match(r"\s*\d+:\s*[LJ] P\[", line):
            move += 1
        elif match := re.match(r"\s*\d+:\s*WAIT\s+([\d.]+)\(sec\)", line):
            waits[move] += float(match[1])
    positions = [[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows]
    starts, now, moves = [], 0.0, 1
    for k, row in enumerate(rows):
        # the approach ends where the bead begins: one move of the program, two rows
        if k and not (
            row["kind"] == "deposit" and row["point"] == "0" and positions[k] == positions[k - 1]
        ):
            now += (
                math.dist(positions[k - 1], positions[k]) / float(row["speed_mm_s"]) + waits[moves]
            )
            moves += 1
        if row["kind"] == "deposit" and int(row["layer"]) == len(starts):
            starts.append(now)
    assert moves == move
    return [b - a for a, b in zip(starts, starts[1:])]


@KINDS
@pytest.mark.always("revolution", "curves")
def test_no_layer_takes_less(workshop, part, branch):
    command, rows, lines = planned(workshop, part, branch, "")
    assert command.status == 0 and not any("WAIT " in line for line in lines), command.err
    short = times_of_layers(rows, lines)
    assert min(short) < MIN_LAYER_TIME_S
    command, rows, lines = planned(
        workshop, part, branch, f", min_layer_time: {MIN_LAYER_TIME_S} s"
    )
    assert command.status == 0, command.err
    long = times_of_layers(rows, lines)
    assert len(long) == len(short) > 1
    # seconds have two digits, and rapids are not straight, so they take longer than estimated
    assert min(long) > MIN_LAYER_TIME_S - 0.02
    # no layer waits after the last one, and layers that take long enough do not wait
    assert all(b == pytest.approx(max(a, MIN_LAYER_TIME_S), rel=0.1) for a, b in zip(short, long))
    assert (
        "WAITS" in command.err
        and f"every layer takes at least {MIN_LAYER_TIME_S:g} s" in command.err
    )


def test_a_spiral_has_no_layers_to_wait_between(workshop):
    command, _, _ = planned(
        workshop, REVOLUTION, "[front, up, flip]", ", path: spiral, min_layer_time: 5 s"
    )
    assert (
        command.status == 2
        and "strategy.min_layer_time: a spiral has no layers to wait between" in command.err
    )
