# SPDX-License-Identifier: LGPL-2.1-or-later
"""`strategy.min_layer_time` and `strategy.layer_time`, from the text of the program and the waypoints."""

import csv
import json
import math
import re
from pathlib import Path

import FreeCAD
import Part
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


# ---- Slowed layers

LEAST_S, SLOWEST = 40.0, 2.5  # s, mm/s
LIFTS_S = 0.8  # s; up and down between two beads, 20 mm each at the speed of rapids
NC = "cell: {machine: table-xyzac, setup: rotary-table, limits: maker}\n"
ROBOT = """\
cell: {machine: abb-irb4600-40-255, setup: tool-on-robot, mount: feature, platform_diameter: 150 mm,
       nozzle: {diameter: 12 mm, half_angle: 70, length: 60 mm}}
"""
CELLS = {"siemens": NC, "linuxcnc": NC, "abb": ROBOT, "none": ""}
TIP = """\
part: {file: tip.step}
strategy: {kind: solid, layer_height: 2.5 mm, chord_error: 0.1 mm, bead_spacing: 5 mm, layer_time: {BY}}
process: {travel_speed: 8 mm/s, bead_width: 6 mm, rapid_speed: 50 mm/s, wire: {feed_mode: proportional}}
"""
BOTH = f"least: {LEAST_S} s, by: both, slowest: {SLOWEST} mm/s"


def tip_job(workshop, post, by, *changes):
    """Return the command of a tapering part that is thin at one end, with widths that vary."""
    corners = [[(0, 0, 0), (60, 0, 0), (60, 13, 0), (0, 24, 0)]]
    corners.append([(4, 2, 20), (20, 2, 20), (20, 9, 20), (4, 9, 20)])
    wires = [
        Part.makePolygon([FreeCAD.Vector(*corner) for corner in [*ring, ring[0]]])
        for ring in corners
    ]
    Part.makeLoft(wires, True).exportStep(str(workshop.folder / "tip.step"))
    text = TIP.replace("BY", by) + CELLS[post]
    text += "" if post == "none" else f"program: {{post: {post}, motion: cartesian}}\n"
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    return workshop.run("plan", "job.yaml", "-o", "out", "--no-page")


def rows_of_tip(workshop):
    """Return the deposit rows of the waypoints."""
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        return [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]


def report_of_tip(workshop):
    return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))


def clock_of_nc(lines, _):
    """Yield time, deposit and layer after each line of a program of siemens or linuxcnc."""
    now, place, lit, layer, per_minute = 0.0, None, False, -1, False
    for line in lines:
        if match := re.search(r"layer (\d+)", line):
            layer = int(match[1])
        if match := re.search(r"\bG4 [PF]([\d.]+)", line):
            now += float(match[1])
        if re.search(r"\bG9[34]\b", line):
            per_minute = "G94" in line
        lit = (
            "M64 P0" in line
            or "H1=1" in line
            or (lit and "M65 P0" not in line and "H1=0" not in line)
        )
        if match := re.search(r"G1 X(\S+) Y(\S+) .*F([\d.]+)", line):
            goal, feed = (float(match[1]), float(match[2])), float(match[3])
            now += 60.0 / feed * (math.dist(place, goal) if per_minute else 1.0)
            place = goal
            yield now, lit, layer, feed / 60.0 if per_minute else None
        else:
            yield now, lit, layer, None


def clock_of_abb(lines, starts):
    """Yield the same of a program of abb. starts: of the beads in the part, mm; a layer is a plane."""
    speeds = {
        match[1]: float(match[2])
        for line in lines
        if (match := re.search(r"speeddata (v_am\d+):=\[([\d.]+),", line))
    }
    first = re.search(r"TriggL \[\[([-\d.]+),([-\d.]+)", "\n".join(lines))
    shift = [float(first[k]) - starts[0][1][k - 1] for k in (1, 2)]
    now, place, lit, layer, bead = 0.0, None, False, -1, 0
    for line in lines:
        speed = None
        if match := re.search(r"! layer (\d+)", line):
            layer = int(match[1])
        if match := re.search(r"WaitTime ([\d.]+);", line):
            now += float(match[1])
        if "SetDO do1," in line:
            lit = "do1,1" in line
            if lit:
                place = [starts[bead][0][k] + shift[k] for k in (0, 1)]
                bead += 1
        if match := re.search(r"MoveAbsJ .*\\T:=([\d.]+)", line):
            now += float(match[1])
        if match := re.search(r"TriggL \[\[([-\d.]+),([-\d.]+),.*,(v_am\d+),s_am", line):
            goal, speed = [float(match[1]), float(match[2])], speeds[match[3]]
            now += math.dist(place, goal) / speed
            place = goal
        yield now, lit, layer, speed


CLOCKS = {"siemens": clock_of_nc, "linuxcnc": clock_of_nc, "abb": clock_of_abb}


@pytest.mark.parametrize("post", CLOCKS)
@pytest.mark.always("siemens", "abb")
def test_programs_take_the_time_of_slowed_layers(workshop, post):
    command = tip_job(workshop, post, BOTH)
    assert command.status == 0, command.err
    assert "LAYERS_SLOWED" in command.err and "WAITS" in command.err
    rows = rows_of_tip(workshop)
    points = [[float(row["x_mm"]), float(row["y_mm"])] for row in rows]
    starts = [(points[k], points[k + 1]) for k, row in enumerate(rows) if row["point"] == "0"]
    (path,) = (workshop.folder / "out" / "program").iterdir()
    begun, lengths, seen = [], [], []
    for now, lit, layer, speed in CLOCKS[post](path.read_text().splitlines(), starts):
        if lit and layer == len(begun):
            begun.append(now)
        if lit and speed is not None:
            seen.append(speed)
    lengths = [b - a for a, b in zip(begun, begun[1:])]
    beads = [len({row["bead"] for row in rows if row["layer"] == str(k)}) for k in range(8)]
    assert len(lengths) == 7
    # rapids count as straight moves, but lift; waits and speeds have three digits
    assert min(lengths) > LEAST_S - 0.02
    assert all(length < LEAST_S + LIFTS_S * count + 0.1 for length, count in zip(lengths, beads)), (
        lengths
    )
    assert min(seen) == pytest.approx(SLOWEST, abs=1e-3) and max(seen) > 2.0 * SLOWEST
    told = report_of_tip(workshop)["layer_times"]
    assert [row["time_s"] for row in told[:-1]] == pytest.approx(lengths, abs=0.15)
    waits = [row["wait_s"] for row in told]
    assert waits[:4] == [0.0] * 4 and min(waits[4:7]) > 1.0 and waits[7] == 0.0


def test_slowed_beads_keep_their_volume_per_length(workshop):
    """The wire per length is that of a constant feed at the usual speeds, at every point."""
    plain = (", layer_time: {" + BOTH + "}", ""), ("proportional", "constant")
    assert tip_job(workshop, "none", BOTH, *plain).status == 0
    usual, report = rows_of_tip(workshop), report_of_tip(workshop)
    assert report["layer_times"] is None
    feed = report["process"]["wire"]["feed_mm_s"]
    assert tip_job(workshop, "none", BOTH).status == 0
    slow, report = rows_of_tip(workshop), report_of_tip(workshop)
    axes = ("layer", "bead", "point", "x_mm", "y_mm", "z_mm")
    assert [[row[axis] for axis in axes] for row in slow] == [
        [row[axis] for axis in axes] for row in usual
    ]
    speeds, fed = set(), []
    for row, other in zip(slow, usual):
        speed = float(row["speed_mm_s"])
        fed.append((float(row["wire_feed_mm_s"]) / speed) / (feed / float(other["speed_mm_s"])))
        # never below the slowest speed, unless usually so, and never faster
        assert min(SLOWEST, float(other["speed_mm_s"])) - 1e-6 <= speed
        assert speed <= float(other["speed_mm_s"]) + 1e-6
        speeds.add(other["speed_mm_s"])
    assert len(speeds) > 20  # beads of varied width
    assert max(abs(ratio - 1.0) for ratio in fed) < 1e-6
    for told in report["layer_times"]:
        moves = [k for k, row in enumerate(slow) if int(row["layer"]) == told["layer"]]
        moves = [k for k in moves if slow[k]["point"] != "0"]
        steps = [
            math.dist(*([float(slow[j][f"{axis}_mm"]) for axis in "xyz"] for j in (k - 1, k)))
            for k in moves
        ]
        for key, table in (("speed_mm_s", slow), ("usual_mm_s", usual)):
            seconds = sum(step / float(table[k]["speed_mm_s"]) for k, step in zip(moves, steps))
            assert told[key] == pytest.approx(sum(steps) / seconds, rel=1e-5)


def test_layers_that_stay_short_are_told(workshop):
    command = tip_job(workshop, "none", BOTH.replace("both", "slow"))
    assert command.status == 0 and "warning[LAYERS_SHORT]" in command.err, command.err
    assert "WAITS" not in command.err and "by: both" in command.err
    # the slowest speed of the material is a limit too
    slow = ("wire:", "material: {name: ER70, slowest: 5 mm/s}, wire:")
    command = tip_job(workshop, "none", BOTH.replace("both", "slow"), slow)
    assert command.status == 0 and "below 5 mm/s" in command.err, command.err
    speeds = [float(row["speed_mm_s"]) for row in rows_of_tip(workshop)]
    assert min(speeds) == pytest.approx(5.0)


def test_waiting_writes_the_program_of_min_layer_time(workshop):
    texts = []
    for key in ("layer_time: {least: 40 s}", "min_layer_time: 40 s"):
        change = ("layer_time: {" + BOTH + "}", key), ("proportional", "constant")
        assert tip_job(workshop, "linuxcnc", BOTH, *change).status == 0
        texts.append((workshop.folder / "out" / "program" / "job.ngc").read_bytes())
    assert texts[0] == texts[1] and texts[0].count(b"G4 P") == 7


@pytest.mark.parametrize(
    ("by", "change", "message"),
    [
        ("least: 40 s, by: slowly", None, "strategy.layer_time.by: 'slowly' is not known"),
        ("least: -4 s", None, "strategy.layer_time.least: -4 s is out of range"),
        ("by: slow", None, "strategy.layer_time.by: slow has no effect"),
        ("least: 40 s, by: slow", None, "strategy.layer_time.by: slow needs a slowest travel"),
        (BOTH, ("proportional", "constant"), "by: both would make beads larger"),
        (BOTH, ("wire: {", "wire: {feed: 0 mm/s, "), "process.wire.feed is 0"),
        (BOTH.replace("2.5", "9"), None, "9 mm/s is above the usual travel speed, 8 mm/s"),
        (BOTH, ("bead_spacing", "min_layer_time: 5 s, bead_spacing"), "strategy.min_layer_time: "),
        (BOTH, ("bead_spacing", "wait: 5 s, bead_spacing"), "error[NOT_YET] "),
        ("40 s", None, "strategy.layer_time: "),
    ],
)
def test_wrong_layer_times_are_refused(workshop, by, change, message):
    post = "none"
    changes = () if change is None else (change,)
    if by == "40 s":
        changes = (("{40 s}", "40 s"),)
    command = tip_job(workshop, post, by, *changes)
    assert command.status == 2 and message in command.err, command.err


def test_a_post_without_a_wire_output_refuses_slowed_layers(workshop):
    command = tip_job(
        workshop,
        "abb",
        BOTH,
        ("abb-irb4600-40-255", "fanuc-arcmate120ic"),
        ("post: abb, motion: cartesian", "post: fanuc"),
    )
    assert command.status == 2 and "error[NO_WIRE_OUTPUT]" in command.err, command.err
