# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of solids on hubs: their keys, their refusals, and the thruster to a program for an 840D."""

import csv
import json
import math
import re
import shutil

import FreeCAD
import Mesh
import numpy as np
import Part
import pytest

from freecad_am.batch import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.strategy import DevelopableParameters
from freecad_am.core.process import bead_table
from freecad_am.posts import catalogue

START = """\
part: {file: blades.step}
substrate: {file: hub.step, faces: [Face2]}
strategy:
  kind: developable
"""


@pytest.fixture
def read(tmp_path):
    for name in ("blades.step", "hub.step", "blades.stl"):
        (tmp_path / name).write_text("")
    (tmp_path / "beads.csv").write_text("radius_mm,wire_feed_m_min,travel_speed_mm_min,width_mm,height_mm\n"
                                        "30,6.5,300,12.5,3.4\n30,6.5,600,9.9,2.7\n50,6.5,300,12.4,3.3\n50,6.5,900,8.3,2.4\n")

    def read_text(text):
        path = tmp_path / "job.yaml"
        path.write_text(text, encoding="utf-8")
        return jobs.read_job(str(path))

    return read_text


def test_the_base_in_its_forms(read):
    assert read(START).strategy == DevelopableParameters() == read(START + "  base: auto\n").strategy
    job = read(START + "  base: {radius: 6 cm, height: 200 mm, axis: [[0, 1 cm, 280], [0, 0, 1]]}\n")
    assert (job.strategy.base.radius, job.strategy.base.height) == (60.0, 200.0)
    assert job.strategy.base.line() == ((0.0, 10.0, 280.0), (0.0, 0.0, 1.0))
    assert read(START + "  base: {radius: 60 mm, height: inf}\n").strategy.base.height == "inf"
    assert job.substrate.faces == ("Face2",)
    assert read(START.replace("substrate: {file: hub.step, faces: [Face2]}\n", "")).substrate is None


@pytest.mark.parametrize(("more", "code", "where"), [
    ("  base: {radius: 0 mm}\n", "BAD_VALUE", "strategy.base.radius"),
    ("  base: {radius: -60 mm}\n", "BAD_VALUE", "strategy.base.radius"),
    ("  base: {radius: 60 mm, height: 0}\n", "BAD_VALUE", "strategy.base.height"),
    ("  base: {height: 200 mm}\n", "BAD_VALUE", "strategy.base.radius"),
    ("  base: {radius: 60 mm, axis: [[0, 0, 0], [0, 0, 0]]}\n", "BAD_VALUE", "strategy.base.axis"),
    ("  base: {radius: 60 mm, axis: [[0, 0, 0], [0, 0]]}\n", "BAD_VALUE", "strategy.base.axis"),
    ("  base: {radius: 60 mm, axis: [[0, 0, 1 deg], [0, 0, 1]]}\n", "BAD_UNIT", "strategy.base.axis"),
    ("  base: cone\n", "BAD_VALUE", "strategy.base"),
    ("  bead_spacing: 0 mm\n", "BAD_VALUE", "strategy.bead_spacing"),
    ("  fill: hatch\n", "BAD_VALUE", "strategy.fill"),
    ("  margin: -1 mm\n", "BAD_VALUE", "strategy.margin"),
    ("  order: random\n", "BAD_VALUE", "strategy.order"),
    ("build_direction: {mode: fixed}\n", "NOT_FOR_FAMILY", "build_direction.mode"),
    ("process: {bead_model: mine.csv}\n", "NO_FILE", "mine.csv"),
    ("process: {bead_model: hub.step}\n", "BAD_TABLE", "hub.step"),
    ("process: {acceleration: 0}\n", "BAD_VALUE", "process.acceleration"),
])
def test_what_is_refused(read, more, code, where):
    with pytest.raises(InputError) as caught:
        read(START + more)
    assert caught.value.code == code and where in caught.value.where, caught.value.line()


@pytest.mark.parametrize(("process", "counts"), [
    ("", "auto"), ("process: {bead_width: 8 mm}\n", "bead_width"), ("process: {bead_width: 10 mm}\n", "bead_width"),
    ("process: {bead_width: 8 mm, fill_width: spacing}\n", "spacing"),
])
def test_a_bead_width_that_is_given_is_meant(read, process, counts):
    assert read(START + process).process.fill_width == counts


def test_the_calibration_table_is_beside_the_job(read, tmp_path):
    assert read(START + "process: {bead_model: beads.csv}\n").process.bead_model == str(tmp_path / "beads.csv")
    assert read(START + "process: {bead_model: csw}\n").process.bead_model == "csw"


MESH = """\
part: {file: blade.stl}
strategy:
  kind: developable
  base: {radius: 30 mm, height: 120 mm, axis: [[0, 0, 50], [0, 0, 1]]}
  layer_height: 5 mm
  chord_error: 0.1 mm
"""


def test_a_mesh_on_a_base_given_by_numbers(workshop):
    bar = Part.makeBox(60.0, 14.0, 30.0, FreeCAD.Vector(0, -7, 60))
    points, facets = bar.tessellate(0.1)
    Mesh.Mesh([[points[k] for k in facet] for facet in facets]).write(str(workshop.folder / "blade.stl"))
    (workshop.folder / "blade.yaml").write_text(MESH, encoding="utf-8")
    done = workshop.run("plan", "blade.yaml", "-o", "out")
    assert done.status == 0, done.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    x, y, z, layer = (np.array([float(row[name]) for row in rows]) for name in ("x_mm", "y_mm", "z_mm", "layer"))
    a = math.atan2(30.0, 120.0)
    assert np.abs((np.hypot(x, y) - 30.0) * math.cos(a) + (z - 50.0) * math.sin(a) - 5.0 * layer).max() < 1e-5
    assert np.abs(y).max() < 7.0 and z.min() > 60.0 and z.max() < 90.0
    other = MESH.replace("developable", "revolution").split("  base")[0]
    (workshop.folder / "blade.yaml").write_text(other, encoding="utf-8")
    refused = workshop.run("plan", "blade.yaml")
    assert (refused.status, refused.err.count("error[UNSUPPORTED_FILE]")) == (2, 1), refused.err


@pytest.mark.parametrize(("ending", "scale", "factor"), [("stl", "1 in", 25.4), ("obj", "10", 10.0), ("stl", "1 m", 1000.0)])
def test_a_mesh_in_another_unit_is_scaled(workshop, ending, scale, factor):
    bar = Part.makeBox(60.0, 14.0, 30.0, FreeCAD.Vector(0, -7, 60))
    points, facets = bar.tessellate(0.1)

    def deposited(unit, told):
        mesh = Mesh.Mesh([[points[k] for k in facet] for facet in facets])
        mesh.transform(FreeCAD.Matrix(*(np.diag([1.0, 1.0, 1.0, unit]) / unit).ravel()))
        mesh.write(str(workshop.folder / f"blade.{ending}"))
        (workshop.folder / "blade.yaml").write_text(MESH.replace("blade.stl", f"blade.{ending}{told}"), encoding="utf-8")
        done = workshop.run("plan", "blade.yaml", "-o", "out")
        assert done.status == 0, done.err
        with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
            return np.array([[float(row[name]) for name in ("x_mm", "y_mm", "z_mm")] for row in csv.DictReader(stream)])

    np.testing.assert_allclose(deposited(factor, f", scale: {scale}"), deposited(1.0, ""), atol=2e-3)
    deposited(factor, f", scale: {scale}")
    document = FreeCAD.openDocument(str(workshop.folder / "out" / "blade.FCStd"))
    try:
        (part,) = document.findObjects("Mesh::Feature")
        assert part.FileScale.Value == factor and part.Mesh.BoundBox.XMax == pytest.approx(60.0, rel=1e-6)
    finally:
        FreeCAD.closeDocument(document.Name)


@pytest.mark.parametrize(("part", "code", "told"), [
    ("{file: blades.step, scale: 25.4}", "BAD_VALUE", "tells its unit itself"),
    ("{file: blades.stl, scale: 0 mm}", "BAD_VALUE", "0 mm is no unit"),
    ("{file: blades.stl, scale: inf}", "BAD_VALUE", "inf mm is no unit"),
    ("{file: blades.stl, scale: 90 deg}", "BAD_UNIT", "an angle"),
    ("{file: blades.stl, scale: inch}", "BAD_UNIT", "inch"),
])
def test_scales_that_are_refused(read, part, code, told):
    with pytest.raises(InputError) as caught:
        read(START.replace("{file: blades.step}", part))
    assert (caught.value.code, "part.scale" in caught.value.where) == (code, True) and told in caught.value.message
    assert read(START.replace("{file: blades.step}", "{file: blades.stl, scale: 1/2 in}")).part.scale == 12.7


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
    """A fin on a cylinder of 60 mm, and its job, run with changes: status, messages, report, waypoints and programs."""
    hub = Part.makeCylinder(60.0, 120.0)
    hub.exportStep(str(workshop.folder / "hub.step"))
    Part.makeSphere(60.0).exportStep(str(workshop.folder / "ball.step"))
    bar = Part.makeBox(90.0, 34.5, 64.5, FreeCAD.Vector(0, -17.25, 30)).cut(hub)
    bar.exportStep(str(workshop.folder / "fin.step"))

    def run(layer="10 mm", *changes):
        text = FIN.replace("LAYER", layer)
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (workshop.folder / "fin.yaml").write_text(text, encoding="utf-8")
        done = workshop.run("plan", "fin.yaml", "-o", "out")
        if done.status:
            return done, {"status": done.err}, [], {}
        out = workshop.folder / "out"
        with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        texts = {path.name: path.read_text(encoding="ascii") for path in (out / "program").iterdir()}
        return done, json.loads((out / "report.json").read_text(encoding="utf-8")), rows, texts

    return run


def test_wire_in_proportion_from_the_job_to_the_program(fin):
    done, report, rows, texts = fin()
    assert done.status == 0, done.err
    assert list(rows[0])[-1] == "wire_feed_mm_s"
    assert {row["wire_feed_mm_s"] for row in rows if row["kind"] == "rapid"} == {""}
    deposit = [row for row in rows if row["kind"] == "deposit"]
    speed, wire = (np.array([float(row[name]) for row in deposit]) for name in ("speed_mm_s", "wire_feed_mm_s"))
    assert speed.max() > 1.3 * speed.min()
    straight = (85.55 / (9.5 + 1.7542)) ** 3 / 60.0  # where the wire runs at 6.5 m/min
    np.testing.assert_allclose(wire / speed, 6500.0 / 60.0 / straight, rtol=2e-4)
    told = "".join(texts[name] for name in sorted(texts) if name.endswith(".SPF"))
    values = np.array([float(value) for value in re.findall(r"A_OUTA\[1\]=(\S+)", told)])
    np.testing.assert_allclose([values.min(), values.max()], 0.06 * np.array([wire.min(), wire.max()]), rtol=6e-5)
    main = texts["FIN.MPF"]
    low, high = re.search(r"; Travel speed (\S+) to (\S+) mm/s\n", main).groups()
    first = [row["point"] == "0" for row in deposit]
    moved = speed[~np.array(first)]
    np.testing.assert_allclose([float(low), float(high)], [moved.min(), moved.max()], rtol=5.1e-4)
    assert "; Wire in proportion to it" in main
    assert len(texts) == 1 + report["counts"]["beads"]  # every bead is longer than max_points: a part of its own
    heights = [issue["message"] for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT"]
    assert "in proportion to the speed, at" in heights[0]


def test_layers_far_higher_than_beads_are_planned_and_told(fin):
    done, report, rows, texts = fin("20 mm")
    assert done.status == 0, done.err
    assert report["counts"]["layers"] == 2 and {int(row["layer"]) for row in rows} == {0, 1} and len(texts) > 2
    (told,) = [issue for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT"]
    assert told["level"] == "warning" and "at layers of 20 mm" in told["message"]


@pytest.mark.parametrize(("post", "motion"), [("siemens", "joint"), ("linuxcnc", "joint"), ("linuxcnc", "cartesian")])
@pytest.mark.parametrize("fill", ["contours", "zigzag"])
def test_feeds_of_a_program_change_no_faster_than_asked_for(fin, post, motion, fill):
    """From the text: times of blocks, or their speeds, over the lengths of the beads that they run. No block is so short
    that a controller could not take it in time, and from block to block the speed changes by no more than the
    acceleration asked for."""
    done, _, rows, texts = fin(
        "10 mm", ("siemens, motion: cartesian, max_points: 10", f"{post}, motion: {motion}"),
        ("chord_error", f"fill: {fill}, chord_error"),
    )
    assert done.status == 0, done.err
    read = catalogue.load(post).read({name: text.encode() for name, text in texts.items()})
    moved = [k for k, row in enumerate(rows) if row["kind"] == "rapid" or row["point"] != "0"]
    assert len(moved) == len(read.deposit)
    at = np.array([[float(row[name]) for name in ("x_mm", "y_mm", "z_mm")] for row in rows])
    length = np.linalg.norm(np.diff(at, axis=0, prepend=at[:1]), axis=1)[moved]
    time = read.duration
    if motion == "cartesian":
        time = np.where(read.deposit, length / np.where(read.deposit, read.speed, 1.0), time)
    told = np.flatnonzero(read.deposit)
    assert length[told].min() > 0.01 and time[told].min() > 1e-3
    within = told[1:][np.diff(told) == 1]  # blocks that follow another of the same bead
    speed = length / time
    change = np.abs(speed[within] - speed[within - 1]) / (0.5 * (time[within] + time[within - 1]))
    assert speed[told].max() > 1.3 * speed[told].min() and change.max() <= 20.0 * (1.0 + 1e-4)


def mean_heights(rows, height):
    """Of each layer, by the model's own numbers and the waypoints alone: the height over the length."""
    found = {}
    for before, row in zip(rows, rows[1:]):
        if row["kind"] == "deposit" and row["point"] != "0":
            way = math.dist(*([float(one[name]) for name in ("x_mm", "y_mm", "z_mm")] for one in (before, row)))
            pair = [height(one) for one in (before, row)]
            found.setdefault(int(row["layer"]), []).append((way, sum(pair) / 2.0))
    return [sum(way * value for way, value in some) / sum(way for way, _ in some) for _, some in sorted(found.items())]


def test_predicted_heights_are_reported_and_drawn(fin, workshop):
    """With the wire in proportion, height times width is one number; the drift adds up over the layers of the solid."""
    _, report, rows, _ = fin()
    told = report["beads"]
    straight = (85.55 / (9.5 + 1.7542)) ** 3 / 60.0
    assert told["layer_height_mm"] == 10.0 and told["wire_feed_mm_s"]["mean"] > 6500.0 / 60.0
    section = told["height_mm"]["max"] * 9.5  # where it is as narrow as asked for
    wanted = mean_heights(rows, lambda row: section / float(row["width_mm"]))
    np.testing.assert_allclose([row["height_mm"]["mean"] for row in told["layers"]], wanted, rtol=1e-5)
    np.testing.assert_allclose([row["drift_mm"] for row in told["layers"]], np.cumsum(np.array(wanted) - 10.0), rtol=1e-5)
    m, _, t = _fitted("height_mm")
    assert told["height_mm"]["max"] == pytest.approx(m * (60.0 * straight) ** (-1.0 / 3.0) + t, rel=1e-4)
    page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count("Predicted height by layer</text>") == 1 and "Predicted height of the bead" in page
    _, plain, rows, _ = fin("30 mm", ("feed_mode: proportional", "feed_mode: constant"))
    constant = plain["beads"]
    assert constant["wire_feed_mm_s"] is None and constant["height_mm"]["max"] > constant["height_mm"]["min"] + 0.02
    assert len(constant["layers"]) == plain["counts"]["layers"]
    assert fin("30 mm", ("bead_model: csw, ", ""), (", feed_mode: proportional", ""))[1]["beads"] is None


def test_heights_where_axes_cannot_follow_are_those_of_the_speed_as_run(fin):
    """The message tells what the report's figures do, which are of the waypoints' speeds."""
    fast = ("strategy:", "build_direction: {max_turn: inf}\nstrategy:"), ("chord_error", "deflection: 20 deg, chord_error")
    _, report, rows, _ = fin("10 mm", *fast, ("proportional", "constant"))
    assert "SLOWED" in {issue["code"] for issue in report["issues"]}
    (told,) = (issue["message"] for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT")
    low, high, mean = (float(value) for value in re.search(r"predicted (\S+) to (\S+) mm high, (\S+) mm", told).groups())
    figures = report["beads"]["height_mm"]
    assert (low, high, mean) == tuple(pytest.approx(figures[key], rel=6e-3) for key in ("min", "max", "mean"))
    speed = min(float(row["speed_mm_s"]) for row in rows if row["kind"] == "deposit" and row["point"] != "0")
    m, _, t = _fitted("height_mm")
    assert speed < 4.0 and high > 1.05 * (m * (60.0 * 5.0) ** (-1.0 / 3.0) + t)  # slower than the table knows
    assert told.startswith("run as fast as the axes can follow, ")


def _fitted(column):
    """Coefficients of a column of the built-in table, by the normal equations."""
    path = bead_table.FOLDER / bead_table.BUILT_IN["csw"]
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(lines)]
    terms = np.array([[row["travel_speed_mm_min"] ** (-1.0 / 3.0), 1.0 / row["radius_mm"], 1.0] for row in rows])
    return np.linalg.solve(terms.T @ terms, terms.T @ np.array([row[column] for row in rows]))


def test_what_cannot_follow_the_wire(fin):
    plain = ("feed_mode: proportional", "feed_mode: constant")
    done, report, rows, texts = fin("30 mm", plain, ("post: siemens", "post: linuxcnc"), ("setup", "limits: maker, setup"))
    assert done.status == 0 and "wire_feed_mm_s" not in rows[0] and not re.search(r"M6[78]", "".join(texts.values()))
    heights = [issue["message"] for issue in report["issues"] if issue["code"] == "BEAD_HEIGHT"]
    assert "process.wire.feed_mode: proportional would keep the section" in heights[0]
    robot = ("machine: table-xyzac, setup: rotary-table", "machine: fanuc-arcmate120ic, setup: tool-on-robot")
    done, *_ = fin("30 mm", robot, ("siemens, motion: cartesian", "fanuc"))
    assert done.status == 2 and done.err.startswith("error[NO_WIRE_OUTPUT] fin.yaml: process.wire.feed_mode: AO[]"), done.err
    done, *_ = fin("30 mm", ("bead_model: csw, ", ""))
    assert done.status == 2 and done.err.startswith("error[NOT_FOR_FAMILY] fin.yaml: process.wire.feed_mode: "), done.err


def test_messages_name_the_keys_of_the_job(fin):
    for changes, told in (
        ((("hub.step}", "hub.step, faces: [Face99]}"),), "error[BAD_FACES] fin.yaml: substrate.faces: Face99 is no face of"),
        ((("hub.step}", "ball.step}"),), "error[NO_BASE] ball: the hub has no cylinder and no cone"),
        ((("substrate: {file: hub.step}\n", ""),), "error[NO_HUB] fin.yaml: substrate: the hub is not known;"),
    ):
        done, *_ = fin("10 mm", *changes)
        assert done.status == 2 and done.err.startswith(told), done.err


def test_notes_of_single_layers_and_of_what_a_table_does_not_use(fin):
    _, report, *_ = fin("500 mm", ("cell:", "joints: {method: constant, compare: point-by-point}\ncell:"))
    notes = {issue["code"]: issue["message"] for issue in report["issues"] if issue["level"] == "note"}
    assert notes["SINGLE_LAYER"].startswith("1 of 1 solids") and "500 mm" in notes["SINGLE_LAYER"]
    assert notes["NOT_USED"].startswith("joints.method, joints.compare: of no effect")
    _, report, *_ = fin("10 mm")
    assert not {"SINGLE_LAYER", "NOT_USED"} & {issue["code"] for issue in report["issues"]}


def test_widths_outside_of_the_table_are_told_with_their_number_and_the_worst(fin):
    lines = ("chord_error", "fill: lines, contour: false, chord_error")
    _, report, rows, _ = fin("20 mm", ("bead_width: 9.5 mm", "bead_width: 12.7 mm"), lines)
    (told,) = (issue["message"] for issue in report["issues"] if issue["code"] == "OUTSIDE_TABLE")
    deposit = [row for row in rows if row["kind"] == "deposit" and row["point"] != "0"]
    speed, width = (np.array([float(row[name]) for row in deposit]) for name in ("speed_mm_s", "width_mm"))
    # beads of the model at 300 mm/min, the slowest of the table: narrower than asked for, straight ones most
    straight = 85.55 / 300.0 ** (1.0 / 3.0) - 1.7542
    assert straight <= width.min() < straight + 0.1 and speed.min() * 60.0 == pytest.approx(300.0, rel=1e-6)
    beads, of, segments, worst = re.search(r"in (\d+) of (\d+) beads and (\d+) segments.*it is (\S+) mm at", told).groups()
    assert (int(of), float(worst)) == (report["counts"]["beads"], pytest.approx(width.min(), abs=0.05))
    assert 0 < int(beads) <= int(of) and 0 < int(segments) <= len(deposit)


def thruster(workshop, root, height):
    """Report and deposit rows of the thruster at another layer height, and the text of its programs."""
    for file in (root / "resources" / "examples" / "thruster").iterdir():
        shutil.copy(file, workshop.folder)
    text = (workshop.folder / "thruster.yaml").read_text(encoding="utf-8")
    changed = text.replace("layer_height: 2.5 mm", f"layer_height: {height} mm").replace("0.05 mm", "0.1 mm")
    assert changed.count(f"{height} mm") == 1 and "0.1 mm" in changed
    (workshop.folder / "thruster.yaml").write_text(changed, encoding="utf-8")
    done = workshop.run("plan", "thruster.yaml", "-o", "out")
    assert done.status == 0, done.err
    out = workshop.folder / "out"
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("laid flat</text>") == 6 and "Predicted width of the bead" in page
    return report, rows, {path.name: path.read_text(encoding="ascii") for path in (out / "program").iterdir()}


def test_the_thruster_goes_to_an_840d_around_the_axis(workshop, root):
    height = 40.0
    report, rows, programs = thruster(workshop, root, height)
    assert report["joints"]["feasible"] is True and "THRUSTER.MPF" in programs
    assert any("TRAORI" in text for text in programs.values())
    x, y, z, speed, width = (np.array([float(row[name]) for row in rows])
                             for name in ("x_mm", "y_mm", "z_mm", "speed_mm_s", "width_mm"))
    layer, bead, point = (np.array([int(row[name]) for row in rows]) for name in ("layer", "bead", "point"))
    rho = np.hypot(x, y)
    cone = (rho - 60.0) * 200.0 / math.hypot(60.0, 200.0) + (z - 280.0) * 60.0 / math.hypot(60.0, 200.0)
    groups = np.split(np.arange(len(rows)), np.flatnonzero(np.diff(z * 0.0 + layer) > 0) + 1)
    tips = []
    for base, diameter in ((rho - 75.0, 466.5), (rho - 60.0, 399.9), (cone, 384.3)):
        mine = [group for group in groups if np.abs(np.round(base[group] / height) * height - base[group]).max() < 1e-5]
        levels = [int(np.round(base[group].mean() / height)) for group in mine]
        assert levels == list(range(len(levels))) and len(levels) >= 3  # on the hub, then further out by the layer height
        tips.append(max(rho[group].max() for group in mine) <= 0.5 * diameter)
        for group in mine[:2]:  # the outermost contours of six blades come last, and in turn
            last = bead[group].max()
            turn = [math.atan2(y[one].mean(), x[one].mean()) for one in (group[bead[group] == last - k] for k in range(6))]
            np.testing.assert_allclose(np.remainder(-np.diff(turn), 2.0 * math.pi), math.pi / 3.0, atol=0.1)
    assert all(tips)
    moving = point > 0
    assert speed[moving].min() * 60.0 > 410.0 and speed[moving].max() * 60.0 < 830.0
    assert width.min() > 9.5 - 1e-6
    assert {"BEAD_MODEL", "BEAD_HEIGHT"} <= {issue["code"] for issue in report["issues"]}
    assert report["counts"]["beads"] == len(set(zip(layer.tolist(), bead.tolist())))
