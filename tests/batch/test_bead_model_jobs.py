# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs with a bead model: widths, heights and wire feed from the job to the program, and the
messages about them."""

import csv
import json
import math
import re

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.core.process.wire import BUILT_IN, FOLDER
from freecad_am.posts import catalogue

FIN = """\
part: {file: fin.step}
substrate: {file: hub.step}
strategy: {kind: developable, layer_height: LAYER, chord_error: 0.1 mm, bead_spacing: 5 mm}
cell: {machine: table-xyzac, setup: rotary-table}
process: {bead_model: csw, bead_width: 9.5 mm, wire: {feed: 6.5 m/min, feed_mode: proportional}}
program: {post: siemens, motion: cartesian, max_points: 10}
"""


@pytest.fixture
def fin(workshop):
    """Return a function that runs the job of a fin on a cylinder of 60 mm with changes, and returns
    status, messages, report, waypoints and programs."""
    hub = Part.makeCylinder(60.0, 120.0)
    hub.exportStep(str(workshop.folder / "hub.step"))
    Part.makeSphere(60.0).exportStep(str(workshop.folder / "ball.step"))
    bar = Part.makeBox(90.0, 34.5, 64.5, FreeCAD.Vector(0, -17.25, 30)).cut(hub)
    bar.exportStep(str(workshop.folder / "fin.step"))

    def run(layer="10 mm", *changes, page=False):
        text = FIN.replace("LAYER", layer)
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (workshop.folder / "fin.yaml").write_text(text, encoding="utf-8")
        command = workshop.run("plan", "fin.yaml", "-o", "out", *(() if page else ("--no-page",)))
        if command.status:
            return command, {"status": command.err}, [], {}
        out = workshop.folder / "out"
        with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        texts = {
            path.name: path.read_text(encoding="ascii") for path in (out / "program").iterdir()
        }
        return command, json.loads((out / "report.json").read_text(encoding="utf-8")), rows, texts

    return run


def test_wire_in_proportion_from_the_job_to_the_program(fin):
    command, report, rows, texts = fin()
    assert command.status == 0, command.err
    assert list(rows[0])[-2] == "wire_feed_mm_s"
    assert {row["wire_feed_mm_s"] for row in rows if row["kind"] == "rapid"} == {""}
    deposit = [row for row in rows if row["kind"] == "deposit"]
    speed, wire = (
        np.array([float(row[name]) for row in deposit]) for name in ("speed_mm_s", "wire_feed_mm_s")
    )
    assert speed.max() > 1.3 * speed.min()
    straight = (85.55 / (9.5 + 1.7542)) ** 3 / 60.0  # the width at a wire feed of 6.5 m/min
    np.testing.assert_allclose(wire / speed, 6500.0 / 60.0 / straight, rtol=2e-4)
    program_text = "".join(texts[name] for name in sorted(texts) if name.endswith(".SPF"))
    values = np.array([float(value) for value in re.findall(r"A_OUTA\[1\]=(\S+)", program_text)])
    np.testing.assert_allclose(
        [values.min(), values.max()], 0.06 * np.array([wire.min(), wire.max()]), rtol=6e-5
    )
    main = texts["FIN.MPF"]
    low, high = re.search(r"; Travel speed (\S+) to (\S+) mm/s\n", main).groups()
    is_first = [row["point"] == "0" for row in deposit]
    moved = speed[~np.array(is_first)]
    np.testing.assert_allclose([float(low), float(high)], [moved.min(), moved.max()], rtol=5.1e-4)
    assert "; Wire in proportion to it" in main
    assert (
        len(texts) == 1 + report["counts"]["beads"]
    )  # every bead exceeds max_points and is a part of its own
    heights = [issue["message"] for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT"]
    assert "wire feed follows the speed, at" in heights[0]


def test_layers_far_higher_than_beads_are_planned_and_told(fin):
    command, report, rows, texts = fin("20 mm")
    assert command.status == 0, command.err
    assert (
        report["counts"]["layers"] == 2
        and {int(row["layer"]) for row in rows} == {0, 1}
        and len(texts) > 2
    )
    (height_issue,) = [
        candidate for candidate in report["issues"] if candidate["code"] == "BEAD_HEIGHT"
    ]
    assert height_issue["level"] == "warning" and "for layers of 20 mm" in height_issue["message"]


@pytest.mark.parametrize(
    ("post", "motion"), [("siemens", "joint"), ("linuxcnc", "joint"), ("linuxcnc", "cartesian")]
)
@pytest.mark.parametrize("fill", ["contours", "zigzag"])
@pytest.mark.always
def test_feeds_of_a_program_change_no_faster_than_asked_for(fin, post, motion, fill):
    """The text gives times or speeds of blocks and the lengths of their beads. No block is shorter
    than a controller can process, and between blocks the speed changes by at most the requested
    acceleration."""
    command, _, rows, texts = fin(
        "10 mm",
        ("siemens, motion: cartesian, max_points: 10", f"{post}, motion: {motion}"),
        ("chord_error", f"fill: {fill}, chord_error"),
    )
    assert command.status == 0, command.err
    readback = catalogue.load(post).read({name: text.encode() for name, text in texts.items()})
    moved = [k for k, row in enumerate(rows) if row["kind"] == "rapid" or row["point"] != "0"]
    assert len(moved) == len(readback.deposit)
    points = np.array([[float(row[name]) for name in ("x_mm", "y_mm", "z_mm")] for row in rows])
    length = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1)[moved]
    time = readback.duration
    if motion == "cartesian":
        time = np.where(
            readback.deposit, length / np.where(readback.deposit, readback.speed, 1.0), time
        )
    deposit_rows = np.flatnonzero(readback.deposit)
    assert length[deposit_rows].min() > 0.01 and time[deposit_rows].min() > 1e-3
    within = deposit_rows[1:][
        np.diff(deposit_rows) == 1
    ]  # blocks after another block of the same bead
    speed = length / time
    change = np.abs(speed[within] - speed[within - 1]) / (0.5 * (time[within] + time[within - 1]))
    assert speed[deposit_rows].max() > 1.3 * speed[deposit_rows].min() and change.max() <= 20.0 * (
        1.0 + 1e-4
    )


def mean_heights(rows, height):
    """Return the mean height of each layer, height over length, from the model's own numbers and
    the waypoints only."""
    heights = {}
    for previous, row in zip(rows, rows[1:]):
        if row["kind"] == "deposit" and row["point"] != "0":
            distance = math.dist(
                *(
                    [float(end[name]) for name in ("x_mm", "y_mm", "z_mm")]
                    for end in (previous, row)
                )
            )
            pair = [height(end) for end in (previous, row)]
            heights.setdefault(int(row["layer"]), []).append((distance, sum(pair) / 2.0))
    return [
        sum(length * value for length, value in sections) / sum(length for length, _ in sections)
        for _, sections in sorted(heights.items())
    ]


def test_predicted_heights_are_reported_and_drawn(fin, workshop):
    """With wire in proportion, height times width is constant; the drift adds up over the layers of
    the solid."""
    _, report, rows, _ = fin(page=True)
    figures = report["beads"]
    straight = (85.55 / (9.5 + 1.7542)) ** 3 / 60.0
    assert figures["layer_height_mm"] == 10.0 and figures["wire_feed_mm_s"]["mean"] > 6500.0 / 60.0
    section = figures["height_mm"]["max"] * 9.5  # where the bead has the requested width
    expected = mean_heights(rows, lambda row: section / float(row["width_mm"]))
    np.testing.assert_allclose(
        [row["height_mm"]["mean"] for row in figures["layers"]], expected, rtol=1e-5
    )
    np.testing.assert_allclose(
        [row["drift_mm"] for row in figures["layers"]],
        np.cumsum(np.array(expected) - 10.0),
        rtol=1e-5,
    )
    m, _, t = _fitted("height_mm")
    assert figures["height_mm"]["max"] == pytest.approx(
        m * (60.0 * straight) ** (-1.0 / 3.0) + t, rel=1e-4
    )
    page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
    assert (
        page.count("Predicted height by layer</text>") == 1
        and "Predicted height of the bead" in page
    )
    _, plain, rows, _ = fin("30 mm", ("feed_mode: proportional", "feed_mode: constant"))
    constant = plain["beads"]
    assert (
        constant["wire_feed_mm_s"] is None
        and constant["height_mm"]["max"] > constant["height_mm"]["min"] + 0.02
    )
    assert len(constant["layers"]) == plain["counts"]["layers"]
    assert (
        fin("30 mm", ("bead_model: csw, ", ""), (", feed_mode: proportional", ""))[1]["beads"]
        is None
    )


def test_heights_where_axes_cannot_follow_are_those_of_the_speed_as_run(fin):
    """The message states the figures of the report, which belong to the speeds of the waypoints."""
    fast = (
        ("strategy:", "build_direction: {max_turn: inf}\nstrategy:"),
        ("chord_error", "deflection: 20 deg, chord_error"),
    )
    _, report, rows, _ = fin("10 mm", *fast, ("proportional", "constant"))
    assert "SLOWED" in {issue["code"] for issue in report["issues"]}
    (message,) = (issue["message"] for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT")
    low, high, mean = (
        float(value)
        for value in re.search(r"predicted (\S+) to (\S+) mm high, (\S+) mm", message).groups()
    )
    figures = report["beads"]["height_mm"]
    assert (low, high, mean) == tuple(
        pytest.approx(figures[key], rel=6e-3) for key in ("min", "max", "mean")
    )
    speed = min(
        float(row["speed_mm_s"]) for row in rows if row["kind"] == "deposit" and row["point"] != "0"
    )
    m, _, t = _fitted("height_mm")
    assert speed < 4.0 and high > 1.05 * (
        m * (60.0 * 5.0) ** (-1.0 / 3.0) + t
    )  # below the slowest speed of the table
    assert message.startswith("limited to the speed of the axes, ")


def _fitted(column):
    """Return the coefficients of a column of the built-in table, by the normal equations."""
    path = FOLDER / BUILT_IN["csw"]
    lines = [
        line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")
    ]
    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(lines)]
    terms = np.array(
        [[row["travel_speed_mm_min"] ** (-1.0 / 3.0), 1.0 / row["radius_mm"], 1.0] for row in rows]
    )
    return np.linalg.solve(terms.T @ terms, terms.T @ np.array([row[column] for row in rows]))


def test_what_cannot_follow_the_wire(fin):
    plain = ("feed_mode: proportional", "feed_mode: constant")
    command, report, rows, texts = fin(
        "30 mm", plain, ("post: siemens", "post: linuxcnc"), ("setup", "limits: maker, setup")
    )
    assert (
        command.status == 0
        and "wire_feed_mm_s" not in rows[0]
        and not re.search(r"M6[78]", "".join(texts.values()))
    )
    heights = [issue["message"] for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT"]
    assert "process.wire.feed_mode: proportional would keep the cross-section" in heights[0]
    robot = (
        "machine: table-xyzac, setup: rotary-table",
        "machine: fanuc-arcmate120ic, setup: tool-on-robot",
    )
    command, *_ = fin("30 mm", robot, ("siemens, motion: cartesian", "fanuc"))
    assert command.status == 2 and command.err.startswith(
        "error[NO_WIRE_OUTPUT] fin.yaml: process.wire.feed_mode: FANUC sets AO[]"
    ), command.err
    command, *_ = fin("30 mm", ("bead_model: csw, ", ""))
    assert command.status == 2 and command.err.startswith(
        "error[NOT_FOR_FAMILY] fin.yaml: process.wire.feed_mode: "
    ), command.err


def test_messages_name_the_keys_of_the_job(fin):
    for changes, message in (
        (
            (("hub.step}", "hub.step, faces: [Face99]}"),),
            "error[BAD_FACES] fin.yaml: substrate.faces: Face99 is not a face",
        ),
        (
            (("hub.step}", "ball.step}"),),
            "error[NO_BASE] ball: the hub has no outer cylinder or cone",
        ),
        (
            (("substrate: {file: hub.step}\n", ""),),
            "error[NO_HUB] fin.yaml: substrate: the hub, a cylinder or cone",
        ),
    ):
        command, *_ = fin("10 mm", *changes)
        assert command.status == 2 and command.err.startswith(message), command.err


def test_notes_of_single_layers_and_of_what_a_table_does_not_use(fin):
    _, report, *_ = fin(
        "500 mm",
        (
            "cell: {",
            "joints: {method: constant, compare: point-by-point}\ncell: {arm_clearance: 5 mm, ",
        ),
    )
    notes = {
        issue["code"]: issue["message"] for issue in report["issues"] if issue["level"] == "note"
    }
    assert notes["SINGLE_LAYER"].startswith("1 of 1 solids") and "500 mm" in notes["SINGLE_LAYER"]
    assert notes["NOT_USED"].startswith(
        "joints.method, joints.compare, cell.arm_clearance: no effect"
    )
    _, report, *_ = fin("10 mm")
    assert not {"SINGLE_LAYER", "NOT_USED"} & {issue["code"] for issue in report["issues"]}


def test_widths_outside_of_the_table_are_told_with_their_number_and_the_worst(fin):
    lines = ("chord_error", "fill: lines, contour: false, chord_error")
    _, report, rows, _ = fin("20 mm", ("bead_width: 9.5 mm", "bead_width: 12.7 mm"), lines)
    (message,) = (
        issue["message"] for issue in report["issues"] if issue["code"] == "OUTSIDE_TABLE"
    )
    deposit = [row for row in rows if row["kind"] == "deposit" and row["point"] != "0"]
    speed, width = (
        np.array([float(row[name]) for row in deposit]) for name in ("speed_mm_s", "width_mm")
    )
    # beads of the model at 300 mm/min, the slowest speed of the table, are narrower than requested,
    # most of all straight ones
    straight = 85.55 / 300.0 ** (1.0 / 3.0) - 1.7542
    assert straight <= width.min() < straight + 0.1 and speed.min() * 60.0 == pytest.approx(
        300.0, rel=1e-6
    )
    beads, bead_count, segments, worst = re.search(
        r"in (\d+) of (\d+) beads and (\d+) segments.*width is (\S+) mm at", message
    ).groups()
    assert (int(bead_count), float(worst)) == (
        report["counts"]["beads"],
        pytest.approx(width.min(), abs=0.05),
    )
    assert 0 < int(beads) <= int(bead_count) and 0 < int(segments) <= len(deposit)
    # the table's speeds, their bead widths, and the remedy
    narrowest, widest = (
        float(text)
        for text in re.search(
            r"are (\S+) to (\S+) mm wide: set process.bead_width", message
        ).groups()
    )
    slow, fast = (
        float(text) for text in re.search(r"outside the (\S+) to (\S+) mm/min", message).groups()
    )
    assert (slow, "or measure beads at other speeds" in message) == (
        300.0,
        True,
    ) and narrowest < widest < 12.7
    widths = [85.55 / speed_ ** (1.0 / 3.0) - 1.7542 for speed_ in (fast, slow)]
    assert [narrowest, widest] == pytest.approx(widths, abs=5e-3)  # printed with four digits


def test_walls_and_parts_of_revolution_hold_their_width(workshop):
    """A tube of 60 mm, whose rings are curved by that: the speed follows the coefficients of the
    errata, and every row has the width."""
    Part.makeCylinder(60.0, 9.0).exportStep(str(workshop.folder / "tube.step"))
    (workshop.folder / "tube.yaml").write_text(
        "part: {file: tube.step, faces: [Face1]}\nstrategy: {layer_height: 3 mm, chord_error: 0.002 mm}\n"
        "process: {bead_model: csw, bead_width: 9.5 mm}\n",
        encoding="utf-8",
    )
    command = workshop.run("plan", "tube.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    speed = (85.550 / (9.5 - 52.742 / 60.0 + 1.7542)) ** 3 / 60.0
    np.testing.assert_allclose([float(row["speed_mm_s"]) for row in rows], speed, rtol=1e-3)
    np.testing.assert_allclose([float(row["width_mm"]) for row in rows], 9.5, atol=5e-3)
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    m, p, t = _fitted("height_mm")
    height = m * (60.0 * speed) ** (-1.0 / 3.0) + p / 60.0 + t
    assert report["beads"]["height_mm"]["mean"] == pytest.approx(height, rel=1e-3)
    drift = [row["drift_mm"] for row in report["beads"]["layers"]]
    np.testing.assert_allclose(drift, (height - 3.0) * np.arange(1, len(drift) + 1), rtol=5e-3)
    assert {"BEAD_MODEL", "BEAD_HEIGHT"} <= {issue["code"] for issue in report["issues"]}
