# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings by place from a job file to document, waypoints and program; the place of each row told by geometry alone."""

import csv
import json

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.objects.results.findings import issues_of

SIDE, HIGH = 28.0, 8.0
RADIUS, CENTRE = 7.0, (14.0, 14.0)
JOB = """\
version: 1
name: bar
part: {file: bar.step}
strategy: {kind: solid, layer_height: 2 mm, bead_spacing: 4 mm, fill: lines, chord_error: 0.1 mm}
build_direction: {clearance: none}
cell: {setup: tool-on-robot, deposition_point: [1000, 0, -100, 0, 0, 0], nozzle: {tool: [0, 0, 250, 0, 0, 0]},
  limits: maker, branch: auto, platform_diameter: 300 mm}
joints: {method: constant}
process:
  bead_width: 4 mm
  travel_speed: 6 mm/s
  schedule: 9
  classes: {contour: {travel_speed: 8 mm/s, schedule: 3}}
SETTINGS
program: {post: fanuc, schedule: {output: 5}}
"""
SETTINGS = """\
settings:
  - where: {layers: [1, 1]}
    process: {travel_speed: 240 mm/min, schedule: 2}
  - where: {inside: {file: zone.step}, height: [3 mm, null]}
    process: {travel_speed: 5 mm/s}
  - where: {faces: [Face1], within: 3 mm}
    process: {travel_speed: 7 mm/s}
  - where: {inside: {box: [-5, 20 mm, -1, 40, 40, 1]}}
    process: {travel_speed: 3 mm/s, lead_on: 0.5 s}
  - where: {layers: [20, null]}
    process: {travel_speed: 1 mm/s}
"""


def write(workshop, settings, job=JOB):
    if not (workshop.folder / "bar.step").exists():
        Part.makeBox(SIDE, SIDE, HIGH).exportStep(str(workshop.folder / "bar.step"))
        zone = Part.makeCylinder(RADIUS, 20.0, FreeCAD.Vector(*CENTRE, -5.0))
        zone.exportStep(str(workshop.folder / "zone.step"))
        Part.makePlane(5.0, 5.0).exportStep(str(workshop.folder / "plane.step"))
    (workshop.folder / "bar.yaml").write_text(job.replace("SETTINGS\n", settings))
    return workshop.folder / "bar.yaml"


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def numbers(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def test_rows_have_the_settings_of_their_place(workshop):
    write(workshop, SETTINGS)
    done = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.err
    assert "settings[4] has no effect" in done.err and "SETTING_UNUSED" in done.err
    out = workshop.folder / "out"
    rows = rows_of(out / "waypoints.csv")
    assert list(rows[0])[-2:] == ["class", "setting"]
    assert all(row["setting"] == "" for row in rows if row["kind"] == "rapid")
    follows = [
        k for k in range(1, len(rows)) if rows[k]["kind"] == "deposit" and rows[k]["point"] != "0"
    ]
    place = numbers(rows, "x_mm", "y_mm", "z_mm")
    ends = [k - 1 for k in follows]
    size = np.linalg.norm(place[follows] - place[ends], axis=1)
    layer = numbers([rows[k] for k in follows], "layer")[:, 0]
    # the cylinder's triangles are up to 0.01 mm off, so that cuts are too
    for share in (0.5, 0.02, 0.98):
        points = place[ends] + share * (place[follows] - place[ends])
        from_axis = np.hypot(*(points[:, :2] - CENTRE).T)
        held = [
            layer == 1,
            (from_axis <= RADIUS) & (points[:, 2] >= 3.0 - 1e-6),
            points[:, 0] <= 3.0,
            (points[:, 1] >= 20.0) & (points[:, 2] <= 1.0),
        ]
        last = np.max([np.where(one, k, -1) for k, one in enumerate(held)], axis=0)
        clear = (
            (size > 1.0) & (np.abs(from_axis - RADIUS) > 0.02) & (np.abs(points[:, 0] - 3.0) > 1e-3)
        )
        told = np.array([int(rows[k]["setting"] or -1) for k in follows])
        np.testing.assert_array_equal(told[clear], last[clear])
    assert set(last[clear]) == {-1, 0, 1, 2, 3}
    speed = numbers([rows[k] for k in follows], "speed_mm_s")[:, 0]
    classes = np.array([rows[k]["class"] for k in follows])
    usual = np.where(classes == "contour", 8.0, 6.0)
    wanted = np.where(last < 0, usual, np.array([4.0, 5.0, 7.0, 3.0, np.nan])[last])
    is_even = classes != "closing"
    np.testing.assert_allclose(speed[clear & is_even], wanted[clear & is_even], rtol=1e-6)
    plain = write(workshop, "").read_text()
    assert "settings" not in plain
    assert workshop.run("plan", "bar.yaml", "-o", "plain", "--no-page").status == 0
    before = rows_of(workshop.folder / "plain" / "waypoints.csv")
    assert list(before[0])[-1] == "class"

    def length(some):
        points = numbers(some, "x_mm", "y_mm", "z_mm")
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        laid = [one["kind"] == "deposit" and one["point"] != "0" for one in some[1:]]
        return steps[laid].sum()

    # rows have six decimals, so that each may be a millionth off
    assert abs(length(rows) - length(before)) < 2e-6 * len(rows)
    program = (out / "program" / "BAR.LS").read_bytes().decode()
    # beads of the class have a schedule of their own and the middle layer that of its place
    assert program.count("GO[5]=2") and program.count("GO[5]=3") and program.count("GO[5]=9")
    assert program.count("DO[1]=ON") == len({(row["layer"], row["bead"]) for row in rows})
    report = json.loads((out / "report.json").read_text())
    assert report["status"] == "ok"


def test_a_saved_document_keeps_places_and_follows_their_solid(workshop):
    write(workshop, SETTINGS)
    assert workshop.run("plan", "bar.yaml", "-o", "out", "--no-page").status == 0
    document = FreeCAD.openDocument(str(workshop.folder / "out" / "bar.FCStd"))
    try:
        proxies = {one: getattr(one, "Proxy", None) for one in document.Objects}
        (path,) = [
            one for one, proxy in proxies.items() if getattr(proxy, "kind", "") == "toolpath"
        ]
        (zone,) = path.Zones
        assert json.loads(path.Settings)[1]["inside"] == zone.Name
        key = path.Key
        assert path.Proxy.key(path) == key
        zone.Placement.Base.x += 100.0
        assert path.Proxy.key(path) != key
        document.recompute()
        unused = [issue.message for issue in issues_of(path) if issue.code == "SETTING_UNUSED"]
        assert len(unused) == 2 and "settings[1]" in unused[0]
        path.Zones = []
        document.recompute()
        assert path.Status == "failed" and "not among the zones" in path.Message
    finally:
        FreeCAD.closeDocument(document.Name)


@pytest.mark.parametrize(
    "entry, place, told",
    [
        ("{where: {layers: [4, 2]}, process: {travel_speed: 4}}", "settings[0].where.layers", "lower"),
        ("{where: {layers: [1.5, 2]}, process: {travel_speed: 4}}", "settings[0].where.layers", "whole"),
        ("{where: {layers: [-1, 2]}, process: {travel_speed: 4}}", "settings[0].where.layers", "whole"),
        ("{where: {layers: [null, null]}, process: {travel_speed: 4}}", "settings[0].where.layers", "open"),
        ("{where: {layers: 3}, process: {travel_speed: 4}}", "settings[0].where.layers", "range"),
        ("{where: {height: [9 mm, 1 mm]}, process: {travel_speed: 4}}", "settings[0].where.height", "lower"),
        ("{where: {height: [1 kg, 9 mm]}, process: {travel_speed: 4}}", "settings[0].where.height", "kg"),
        ("{where: {faces: [Face1]}, process: {travel_speed: 4}}", "settings[0].where.within", "both"),
        ("{where: {within: 3 mm}, process: {travel_speed: 4}}", "settings[0].where.faces", "both"),
        ("{where: {faces: [Edge1], within: 1}, process: {travel_speed: 4}}", "settings[0].where.faces", "face"),
        ("{where: {faces: [Face1], within: 0}, process: {travel_speed: 4}}", "settings[0].where.within", "more"),
        ("{where: {inside: {box: [0, 0, 0, 1, 1]}}, process: {travel_speed: 4}}", "settings[0].where.inside.box", "box"),
        ("{where: {inside: {box: [0, 0, 5, 1, 1, 1]}}, process: {travel_speed: 4}}", "settings[0].where.inside.box", "lower"),
        ("{where: {inside: {file: no.step}}, process: {travel_speed: 4}}", "settings[0].where.inside.file", "exist"),
        ("{where: {inside: {object: Zone}}, process: {travel_speed: 4}}", "settings[0].where.inside.object", "FCStd"),
        ("{where: {inside: {file: zone.step, box: [0, 0, 0, 1, 1, 1]}}, process: {travel_speed: 4}}", "settings[0].where.inside", "one of"),
        ("{where: {inside: zone.step}, process: {travel_speed: 4}}", "settings[0].where.inside", "section"),
        ("{where: {layer: [0, 1]}, process: {travel_speed: 4}}", "settings[0].where.layer", "layers"),
        ("{process: {travel_speed: 4}}", "settings[0].where", "missing"),
        ("{where: {layers: [0, 1]}}", "settings[0].process", "nothing"),
        ("{where: {layers: [0, 1]}, process: {bead_width: 4}}", "settings[0].process.bead_width", "vary"),
        ("{where: {layers: [0, 1]}, process: {seam: {angle: 4}}}", "settings[0].process.seam", "yet"),
        ("{where: {layers: [0, 1]}, strategy: {layer_height: 4}}", "settings[0].strategy.layer_height", "vary"),
        ("{where: {layers: [0, 1]}, process: {travel_speed: -4}}", "settings[0].process.travel_speed", "range"),
        ("{where: {layers: [0, 1]}, process: {schedule: 1.5}}", "settings[0].process.schedule", "whole"),
        ("{where: {layers: [0, 1]}, program: {post: none}}", "settings[0].program", "where"),
    ],
)  # fmt: skip
def test_a_wrong_place_or_value_is_named(workshop, entry, place, told):
    path = write(workshop, f"settings: [{entry}]\n")
    with pytest.raises(InputError) as error:
        jobs.read_job(str(path))
    assert error.value.where.endswith(place) and told in error.value.message


def test_other_wrong_settings_are_named(workshop):
    for settings, place, told in (
        ("settings: {where: 3}\n", "settings", "list"),
        (f"settings: [{', '.join(['{where: {layers: [0, 1]}, process: {schedule: 1}}'] * 53)}]\n", "settings", "52"),
    ):  # fmt: skip
        with pytest.raises(InputError) as error:
            jobs.read_job(str(write(workshop, settings)))
        assert error.value.where.endswith(place) and told in error.value.message
    inner = JOB.replace("  schedule: 9\n", "  schedule: 9\n  settings: none\n")
    with pytest.raises(InputError) as error:
        jobs.read_job(str(write(workshop, "", inner)))
    assert error.value.where.endswith("process.settings")
    modelled = JOB.replace("  schedule: 9\n", "  bead_model: csw\n")
    write(workshop, SETTINGS, modelled.replace("  classes:", "  #"))
    assert "bead model" in refusal(workshop)
    write(workshop, SETTINGS.replace("zone.step", "plane.step"))
    assert "is not a solid, so it has no inside" in refusal(workshop)
    write(workshop, SETTINGS.replace("Face1", "Face99"))
    assert "has no Face99; it has Face1 to Face6" in refusal(workshop)


def refusal(workshop):
    done = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert done.status == 2
    return done.err
