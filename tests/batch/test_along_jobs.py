# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs in layers along a guide, read from waypoints.csv and measured only with OpenCASCADE and the
geometry of arcs."""

import csv
import json
import re
import shutil

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.batch.job.job import read_job
from tests.batch import row_limits

V = FreeCAD.Vector
HEIGHT, RADIUS = 2.5, 40.0
JOB = """\
part: {{file: part.step}}
strategy:
  {{kind: solid, layers: along, guide: {guide}, layer_height: 2.5 mm, band: {band}, chord_error: 0.1 mm,
    bead_spacing: 3 mm{more}}}
process: {{bead_width: 3 mm}}
build_direction: {{clearance: none{mode}}}
"""


def arc(start, direction, normal, angle, radius=RADIUS):
    """Return an arc from a point, turning about a normal by an angle in deg, and its end point and
    direction."""
    side = normal.cross(direction)
    middle, end = (
        start + direction * (radius * np.sin(t)) + side * (radius * (1 - np.cos(t)))
        for t in np.radians([0.5 * angle, angle])
    )
    return (
        Part.Arc(start, middle, end).toShape(),
        end,
        direction * np.cos(np.radians(angle)) + side * np.sin(np.radians(angle)),
    )


def spine(angle=90, straight=15.0):
    """Return a curve that goes up, bends by an angle, and continues straight."""
    begin, up = V(0, 0, straight), V(0, 0, 1)
    bend, end, direction = arc(begin, up, V(0, 1, 0), angle)
    return Part.Wire(
        [Part.makeLine(V(), begin), bend, Part.makeLine(end, end + direction * straight)]
    )


def swept(profile, wire):
    return wire.makePipeShell([profile], True, False)


def elbow(wire=None, radius=9.0):
    return swept(Part.Wire(Part.makeCircle(radius)), wire or spine())


def beam(wire=None):
    """Return an I-beam whose flanges are the inside and the outside of the bend."""
    half = [(9, 9), (9, 3), (3, 3)]
    corner = [(x, y) for x, y in half] + [(x, -y) for x, y in half[::-1]]
    outline = corner + [(-x, -y) for x, y in corner]
    points = [V(x, y, 0) for x, y in outline]
    return swept(Part.makePolygon([*points, points[0]]), wire or spine())


@pytest.fixture
def planned(workshop):
    def run(shape, guide="auto", wire=None, band="30 %", more="", mode="", again=""):
        shape.exportStep(str(workshop.folder / "part.step"))
        if wire is not None:
            wire.exportBrep(str(workshop.folder / "spine.brep"))
        job = workshop.write_job(JOB.format(guide=guide, band=band, more=more, mode=mode))
        out = workshop.folder / f"out{again}"
        command = workshop.run("plan", job.name, "-o", out.name, "--no-page")
        if command.status == 2 or not out.exists():
            return command, None, None
        with open(next(out.rglob("waypoints.csv")), encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
        return command, json.loads(next(out.rglob("report.json")).read_text(encoding="utf-8")), rows

    return run


def column(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def bend_of(points, straight=15.0):
    """Return the angle (n,) in rad of points (n, 3) about the axis of the spine's bend, and their
    distance (n,) in mm from it."""
    off = points - (RADIUS, 0.0, straight)
    return np.arctan2(off[:, 2], -off[:, 0]), np.hypot(off[:, 0], off[:, 2])


def test_beads_of_layers_along_a_guide_have_one_speed_in_planes(workshop, planned):
    """The note on their speeds says so."""
    _, report, rows = planned(elbow(spine(30, 5.0)), band="35 %")
    (message,) = [issue["message"] for issue in report["issues"] if issue["code"] == "SPEED_VARIES"]
    assert "as high as the layer" in message
    assert message.endswith(
        "; for a constant speed set strategy.layers: planes and strategy.narrowest: 100 %"
    )
    assert len(set(column(rows, "speed_mm_s").ravel())) > 1
    text = workshop.job.read_text(encoding="utf-8")
    text = text.replace("layers: along, guide: auto,", "layers: planes, narrowest: 100 %,").replace(
        "band: 35 %, ", ""
    )
    workshop.run("plan", workshop.write_job(text).name, "-o", "again", "--no-page")
    again = workshop.folder / "again"
    issues = json.loads(next(again.rglob("report.json")).read_text(encoding="utf-8"))["issues"]
    assert "SPEED_VARIES" not in [issue["code"] for issue in issues]
    with open(next(again.rglob("waypoints.csv")), encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    assert len(set(column(rows, "speed_mm_s").ravel())) == 1


@pytest.mark.parametrize(
    ("make", "guide", "spare"),
    [
        pytest.param(elbow, "{file: spine.brep}", 1e-4, marks=pytest.mark.long),
        (beam, "auto", 0.15),
    ],
)
def test_a_bent_part_is_filled_by_planes_normal_to_its_spine(planned, make, guide, spare):
    shape_ = make()
    command, report, rows = planned(shape_, guide, spine(), band="35 %")
    assert command.status == 0, command.err
    points, build = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, "bx", "by", "bz")
    layer = np.array([int(row["layer"]) for row in rows])
    solid = shape_.Solids[0]
    off = [
        shape_.distToShape(Part.Vertex(*point))[0]
        for point in points.tolist()
        if not solid.isInside(V(*point), 1e-3, True)
    ]
    assert max(off, default=0.0) < 0.05  # half of the chord error
    assert {"OFF_PART", "UNSUPPORTED", "OPEN_GAP"}.isdisjoint(
        issue["code"] for issue in report["issues"]
    )
    # each layer is in a plane, and the next one a layer height further along the spine
    for number in range(layer.max() + 1):
        in_layer = layer == number
        assert np.ptp(build[in_layer], axis=0).max() < 1e-6
        assert np.ptp(points[in_layer] @ build[in_layer][0]) < 1e-5
    angle, distances = bend_of(points)
    bent = (angle > 0.1) & (angle < 0.5 * np.pi - 0.1)
    # in the bend the plane contains its axis, so all its points have one angle
    for number in np.unique(layer[bent]):
        assert np.ptp(angle[bent & (layer == number)]) * RADIUS < 20.0 * spare + 1e-3
    # heights are in proportion to the distance from the axis; the report states those of the
    # outline
    inside, outside = RADIUS - 9.0, RADIUS + 9.0
    layer_rows = {row["layer"]: row for row in report["layer_heights"]}
    middle = layer_rows[int(np.median(layer[bent]))]
    assert middle["least_mm"] == pytest.approx(HEIGHT * inside / RADIUS, abs=0.01 + spare)
    assert middle["largest_mm"] == pytest.approx(HEIGHT * outside / RADIUS, abs=0.01 + spare)
    assert (
        layer_rows[1]["least_mm"] == pytest.approx(HEIGHT, abs=spare) == layer_rows[1]["largest_mm"]
    )
    # the torch is slower where the layer is higher
    speed = column(rows, "speed_mm_s")[:, 0]
    start = np.array([row["point"] == "0" for row in rows])
    if guide != "auto":
        mean = 0.5 * (distances[1:] + distances[:-1])
        moves_ = bent[1:] & ~start[1:]
        assert np.abs(speed[1:][moves_] * mean[moves_] / (6.0 * RADIUS) - 1.0).max() < 0.02
    assert report["deposit"]["deposited_cm3"] == pytest.approx(shape_.Volume / 1000.0, rel=0.03)
    if make is elbow:
        assert report["totals"]["volume_cm3"] == pytest.approx(shape_.Volume / 1000.0, rel=0.03)


def test_a_plane_that_meets_the_part_twice_cuts_what_belongs_to_it_alone(planned):
    """Planes through one leg of an arch cross the other one too."""
    wire = spine(180)
    arch = elbow(wire, 6.0)
    command, _, rows = planned(arch, "{file: spine.brep}", wire)
    assert command.status == 0, command.err
    points, layer = (
        column(rows, "x_mm", "y_mm", "z_mm"),
        np.array([int(row["layer"]) for row in rows]),
    )
    for number in range(layer.max() + 1):
        assert np.ptp(points[layer == number], axis=0).max() < 12.0
    assert layer.max() + 1 == int((30.0 + np.pi * RADIUS) / HEIGHT)
    middle = np.array(
        [
            0.5 * (points[layer == number].min(axis=0) + points[layer == number].max(axis=0))
            for number in range(layer.max() + 1)
        ]
    )
    assert (np.diff(middle[:, 0]) > -0.05).all() and middle[-1, 0] > 2.0 * RADIUS - 1.0


def test_an_edge_of_the_part_guides_too_and_the_same_job_gives_the_same_bytes(planned, workshop):
    beam().exportStep(str(workshop.folder / "part.step"))
    elbow_shape = Part.read(
        str(workshop.folder / "part.step")
    )  # its edges have other numbers in the file
    number = next(
        k
        for k, edge in enumerate(elbow_shape.Edges)
        if edge.Curve.TypeId == "Part::GeomCircle" and abs(edge.Curve.Radius - RADIUS - 3.0) < 1e-6
    )
    for again in ("", "2"):
        command, report, _ = planned(
            elbow_shape, f"{{edges: [Edge{number + 1}]}}", band="40 %", again=again
        )
        assert command.status == 0, command.err
    first_run, second_run = (
        next((workshop.folder / name).rglob("waypoints.csv")).read_bytes()
        for name in ("out", "out2")
    )
    assert first_run == second_run
    largest = max(row["largest_mm"] for row in report["layer_heights"])
    assert largest == pytest.approx(
        HEIGHT * (RADIUS + 9.0) / (RADIUS + 3.0), abs=0.02
    )  # a layer height on the edge


LINE_OUTSIDE = Part.makeLine(V(30, 0, 0), V(30, 0, 60))
BACK = Part.Wire([Part.makeLine(V(0, 0, 0), V(0, 0, 40)), Part.makeLine(V(0, 0, 40), V(0.5, 0, 0))])
CORNER = Part.Wire([Part.makeLine(V(), V(0, 0, 30)), Part.makeLine(V(0, 0, 30), V(10, 0, 60))])
SEPARATE_LINES = Part.Compound(
    [Part.makeLine(V(), V(0, 0, 20)), Part.makeLine(V(0, 0, 30), V(0, 0, 60))]
)
RING = Part.Wire(Part.makeCircle(20, V(), V(0, 1, 0)))
TIGHT_BEND = Part.Wire(
    [Part.makeLine(V(), V(0, 0, 30)), arc(V(0, 0, 30), V(0, 0, 1), V(0, 1, 0), 90, 6.0)[0]]
)


@pytest.mark.parametrize(
    ("wire", "code", "words"),
    [
        (LINE_OUTSIDE, "GUIDE_OUTSIDE", "(30, 0, "),
        (BACK, "GUIDE_DOUBLES_BACK", "(0, 0, 40)"),
        (CORNER, "GUIDE_CORNER", "18.4 deg"),
        (SEPARATE_LINES, "GUIDE_OPEN", "gap is 10 mm"),
        (RING, "GUIDE_CLOSED", "remove one edge"),
        (TIGHT_BEND, "GUIDE_TIGHT", "larger radius"),
    ],
)
def test_guides_that_cannot_lead_are_told(planned, wire, code, words):
    command, _, _ = planned(Part.makeBox(20, 20, 60, V(-10, -10, 0)), "{file: spine.brep}", wire)
    assert command.status == 2
    assert (
        f"error[{code}]" in command.err
        and words in command.err
        and command.err.count("error[") == 1
    ), command.err


@pytest.mark.parametrize(
    ("shape", "guide", "more", "mode", "code", "words"),
    [
        (Part.makeSphere(20), "auto", "", "", "GUIDE_NOT_FOUND", "edge, a wire or a sketch"),
        (
            Part.Compound([Part.makeBox(9, 9, 9), Part.makeBox(9, 9, 9, V(20, 0, 0))]),
            "auto",
            "",
            "",
            "GUIDE_NOT_FOUND",
            "several solids",
        ),
        (Part.makeBox(20, 20, 60), "{edges: [Edge99]}", "", "", "UNKNOWN_EDGE", "Edge1 to Edge12"),
        (Part.makeBox(20, 20, 60), "{object: Spine}", "", "", "BAD_VALUE", "FCStd"),
        (Part.makeBox(20, 20, 60), "upwards", "", "", "BAD_VALUE", "{edges: [Edge1]}"),
        (Part.makeBox(20, 20, 1), "{edges: [Edge1]}", "", "", "TOO_LOW", "use at most"),
        (Part.makeBox(20, 20, 60), "auto", "", ", mode: fixed", "NOT_FOR_FAMILY", "use local"),
    ],
)
def test_what_cannot_be_cut_is_told(planned, shape, guide, more, mode, code, words):
    command, _, _ = planned(shape, guide, more=more, mode=mode)
    assert command.status == 2
    assert (
        f"error[{code}]" in command.err
        and words in command.err
        and command.err.count("error[") == 1
    ), command.err


def test_layers_beyond_the_band_are_refused_with_layer_and_place(planned):
    command, _, _ = planned(elbow(), "{file: spine.brep}", spine(), band="10 %")
    assert (
        command.status in (2, 3)
        and "LAYER_HEIGHT" in command.err
        and "22.5 % is needed" in command.err
    ), command.err
    assert "layer " in command.err and "strategy.band" in command.err


@pytest.mark.parametrize("layers", ["planes", "geodesic"])
def test_only_layers_along_have_a_guide(workshop, layers):
    Part.makeBox(20, 20, 20).exportStep(str(workshop.folder / "part.step"))
    job = JOB.format(guide="{edges: [Edge1]}", band="20 %", more="", mode="").replace(
        "along", layers
    )
    command = workshop.run("plan", workshop.write_job(job).name, "-o", "out", "--no-page")
    assert (
        command.status == 2
        and "error[NOT_FOR_FAMILY]" in command.err
        and "strategy.guide" in command.err
    ), command.err


def test_the_example_is_planned_and_its_report_shows_layers_in_their_planes(workshop, root):
    """With coarser settings, the section is the ring of the pipe, 28 mm wide less the width of a
    bead, at every position along the bend."""
    for name in ("pipe-bend.step", "pipe-bend.yaml"):
        shutil.copy(root / "resources" / "examples" / name, workshop.folder)
    path = workshop.folder / "pipe-bend.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace("2.5 mm", "8 mm"), encoding="utf-8")
    command = workshop.run("plan", path.name, "-o", "out")
    assert command.status == 0, command.err
    cell = read_job(str(path)).cell
    assert row_limits.over_all(workshop.folder / "out", cell.machine, cell.limits) <= 0.0
    page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
    pictures = [drawing for drawing in page.split("<svg") if ", flattened</" in drawing]
    assert len(pictures) == 2
    for picture in pictures:
        box = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', picture)
        width, height = map(float, box.groups())
        assert 0.9 < height / width < 1.25  # as wide as high, with the frame
