# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs in curved layers: read from waypoints.csv, measured with OpenCASCADE and by distances between points alone."""

import csv
import json

import FreeCAD
import numpy as np
import Part
import pytest
from scipy.spatial import cKDTree

from freecad_am import api
from freecad_am.core.issues import InputError

HEIGHT, SPACING = 2.5, 4.0
JOB = """\
version: 1
name: part
part: {{file: part.step}}
strategy: {{kind: solid, layers: {layers}, layer_height: {height} mm, chord_error: 0.2 mm, bead_spacing: 4 mm{more}}}
process: {{bead_width: 4 mm}}
build_direction: {{clearance: {clearance}{mode}}}
"""
HALF_ANGLE, TIP, LENGTH = np.radians(30.0), 2.0, 60.0  # of the nozzle
CELL = """\
cell:
  {machine: fanuc-arcmate120ic, mount: feature, branch: auto, nozzle: {diameter: 4 mm, half_angle: 30 deg, length: 60 mm}}
program: {post: fanuc}
"""
UP = FreeCAD.Vector(0, 0, 1)


def tee():
    """A stem under a beam that stands out by 15 mm to either side."""
    return (
        Part.makeBox(12, 12, 16)
        .fuse(Part.makeBox(42, 12, 12, FreeCAD.Vector(-15, 0, 15)))
        .removeSplitter()
    )


def wye():
    arms = [
        Part.makeCylinder(6, 26, FreeCAD.Vector(0, 0, 12), FreeCAD.Vector(way, 0, 1))
        for way in (1, -1)
    ]
    return Part.makeCylinder(7, 18).fuse(arms).removeSplitter()


def mushroom():
    cap = Part.makeSphere(16, FreeCAD.Vector(0, 0, 20), UP, 0, 90, 360)
    return Part.makeCylinder(6, 20.5).fuse(cap).removeSplitter()


def bracket():
    """An upright with an arm that stands out by 28 mm, half way up."""
    return (
        Part.makeBox(14, 12, 38)
        .fuse(Part.makeBox(29, 12, 12, FreeCAD.Vector(13, 0, 16)))
        .removeSplitter()
    )


def struts():
    """A trunk that parts in three, each of which leans by 40 degrees."""
    ways = [
        FreeCAD.Vector(np.cos(turn), np.sin(turn), 1.2) for turn in np.radians([0.0, 120.0, 240.0])
    ]
    arms = [Part.makeCylinder(5, 30, FreeCAD.Vector(0, 0, 12), way) for way in ways]
    return Part.makeCylinder(7, 18).fuse(arms).removeSplitter()


@pytest.fixture
def planned(workshop):
    def run(shape, layers="geodesic", height=HEIGHT, more="", mode="", clearance="none", cell=""):
        shape.exportStep(str(workshop.folder / "part.step"))
        job = JOB.format(layers=layers, height=height, more=more, mode=mode, clearance=clearance)
        job = workshop.write_job(job + cell)
        done = workshop.run("plan", job.name, "-o", "out", "--no-page")
        if done.status:
            return done, None, None
        out = workshop.folder / "out"
        with open(next(out.rglob("waypoints.csv")), encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
        return done, json.loads(next(out.rglob("report.json")).read_text(encoding="utf-8")), rows

    return run


def column(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def places(rows, step=0.5):
    """Places (n, 3) along the beads no more than `step` mm apart, their layers and build directions."""
    points, build = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, "bx", "by", "bz")
    layer = np.array([int(row["layer"]) for row in rows])
    same = np.array([row["bead"] for row in rows])
    found = []
    for k in range(1, len(rows)):
        if layer[k] == layer[k - 1] and same[k] == same[k - 1]:
            count = max(int(np.ceil(np.linalg.norm(points[k] - points[k - 1]) / step)), 1)
            share = np.linspace(0.0, 1.0, count + 1)[:, None]
            way = (1.0 - share) * build[k - 1] + share * build[k]
            found.append(
                np.column_stack(
                    [
                        (1.0 - share) * points[k - 1] + share * points[k],
                        way / np.linalg.norm(way, axis=1)[:, None],
                        np.full(count + 1, layer[k]),
                    ]
                )
            )
    whole = np.vstack(found)
    return whole[:, :3], whole[:, 3:6], whole[:, 6].astype(int)


def deepest(rows, half_angle):
    """Mm that a cone on the tool axis, as wide as the nozzle at its tip, reaches into the core of beads laid before: a round
    bar half a layer height in radius in the middle of each, those beside the tip left out."""
    points, build, tool = (
        column(rows, *(f"{name}{axis}" for axis in axes))
        for name, axes in (("", ("x_mm", "y_mm", "z_mm")), ("b", "xyz"), ("t", "xyz"))
    )
    layer, middle, worst = (
        np.array([int(row["layer"]) for row in rows]),
        points + 0.5 * HEIGHT * build,
        -np.inf,
    )
    for k in range(1, len(rows)):
        off = middle[:k] - points[k]
        up = off @ tool[k]
        aside = np.linalg.norm(off - up[:, None] * tool[k], axis=1)
        beside = (layer[:k] == layer[k]) & (
            np.linalg.norm(points[:k] - points[k], axis=1) < 1.5 * SPACING
        )
        asked = ~beside & (up > 0.5 * HEIGHT) & (up < LENGTH)
        into = 0.5 * HEIGHT - (aside - TIP - up * np.tan(half_angle)) * np.cos(half_angle)
        worst = max(worst, into[asked].max(initial=-np.inf))
    return worst


def turns(rows, *names):
    """How fast (n - 1,) deg/mm directions turn from row to row, 0 from bead to bead."""
    points, ways = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, *names)
    angle = np.arctan2(
        np.linalg.norm(np.cross(ways[1:], ways[:-1]), axis=1), (ways[1:] * ways[:-1]).sum(axis=1)
    )
    one = np.array([(row["layer"], row["bead"]) for row in rows])
    return (
        np.degrees(angle)
        / np.linalg.norm(np.diff(points, axis=0), axis=1)
        * (one[1:] == one[:-1]).all(axis=1)
    )


BUILD, TOOL = ("bx", "by", "bz"), ("tx", "ty", "tz")


def from_beads(points, below, build):
    """How far (n,) mm points are from beads as wide as they are apart, by places (m, 3) of these and build directions."""
    away = np.full(len(points), np.inf)
    for near in cKDTree(below).query(points, k=24)[1].T:
        step = points - below[near]
        along = (step * build[near]).sum(axis=1)
        aside = np.linalg.norm(step - along[:, None] * build[near], axis=1)
        away = np.minimum(away, np.hypot(np.maximum(aside - 0.5 * SPACING, 0.0), along))
    return away


@pytest.mark.parametrize(
    "shape",
    [
        tee,
        *(pytest.param(one, marks=pytest.mark.long) for one in (wye, mushroom, bracket, struts)),
    ],
)
def test_every_bead_lies_on_what_was_deposited_before_and_the_part_is_filled(planned, shape):
    """To a program: nothing over nothing, and the nozzle is clear of what stands; one of 80 deg would not be, but for the
    mushroom, where nothing ever stands higher than the tip."""
    part = shape()
    done, report, rows = planned(part, clearance="nozzle", cell=CELL)
    assert done.status == 0, done.err
    assert report["programs"] and report["unsupported_mm"] == 0.0
    assert not [
        issue
        for issue in report["issues"]
        if issue["code"] in ("UNSUPPORTED", "OFF_PART", "OPEN_GAP")
    ]
    assert deepest(rows, HALF_ANGLE) < 0.1
    assert (
        max(turns(rows, *BUILD).max(), turns(rows, *TOOL).max()) < 30.03
    )  # deg/mm, beyond which TURN_PASSED were told
    assert shape is mushroom or deepest(rows, np.radians(80.0)) > 0.1
    points, build, layer = places(rows)
    assert np.abs(points[layer == 0][:, 2]).max() < 0.01
    apart = []  # of places of beads that have one of the layer below right under them
    for number in range(1, layer.max() + 1):
        here, low = layer == number, layer == number - 1
        below = cKDTree(points[low])
        away = below.query(points[here] - HEIGHT * build[here])[0]
        assert away.max() < 0.6 * SPACING, (
            number
        )  # beads below lie a spacing apart, half a one beside at most
        apart.append(below.query(points[here][away < 0.5 * HEIGHT])[0] / HEIGHT)
        assert from_beads(points[here], points[low], build[low]).max() < 1.2 * HEIGHT, number
    ratio = np.concatenate(apart)
    assert ratio.min() > 0.6 and ratio.max() < 1.4 and ((ratio > 0.8) & (ratio < 1.2)).mean() > 0.95
    if shape is wye:  # its arms are two islands, and stay so
        parted = [
            number
            for number in range(layer.max() + 1)
            if np.abs(points[layer == number][:, 0]).min() > 2.0
        ]
        assert len(parted) > 3 and parted == list(range(parted[0], layer.max() + 1))
    lifted = points[::7] + 0.5 * HEIGHT * build[::7]
    solid = part.Solids[0]
    outside = [p for p in lifted if not solid.isInside(FreeCAD.Vector(*p), 0.3, True)]
    assert len(outside) == 0
    volume = report["totals"]["volume_cm3"] * 1000.0
    assert volume == pytest.approx(
        part.Volume, rel=0.12
    )  # cut in steps of a whole layer, arms of 12 mm in beads of 4


LEADING = ", max_turn: 9 deg/mm, lead: 10 deg"


@pytest.mark.parametrize(
    ("shape", "asked"),
    [
        pytest.param(tee, {LEADING: 9.0}, marks=pytest.mark.long),
        pytest.param(tee, {"": 30.0, ", max_turn: 5 deg/mm": 5.0}, marks=pytest.mark.long),
        (mushroom, {", max_turn: 5 deg/mm": 5.0}),
    ],
)
def test_directions_turn_no_faster_than_asked_and_depart_no_farther_than_told(
    planned, shape, asked
):
    """Those of the field turn by a radian per layer height next to a corner; beads that turn slower are as they were."""
    free = [] if set(asked) == {LEADING} else planned(shape(), mode=", max_turn: inf")[2]
    beads = np.array([(row["layer"], row["bead"]) for row in free])
    for mode, most in asked.items():
        done, report, rows = planned(shape(), mode=mode)
        assert done.status == 0, done.err
        assert max(turns(rows, *BUILD).max(), turns(rows, *TOOL).max()) < most + 0.03, (
            mode
        )  # rows have six decimals
        if mode == LEADING:
            away = (column(rows, *BUILD) * column(rows, *TOOL)).sum(axis=1)
            assert np.median(np.degrees(np.arccos(np.clip(away, -1.0, 1.0)))) == pytest.approx(
                10.0, abs=0.1
            )
            continue
        assert (column(rows, "x_mm", "y_mm", "z_mm") == column(free, "x_mm", "y_mm", "z_mm")).all()
        fast = np.unique(beads[1:][turns(free, *BUILD) > most], axis=0)
        assert 0 < len(fast) < len(np.unique(beads, axis=0))
        slower = (beads[:, None] == fast).all(axis=2).any(axis=1)
        assert [row for row, one in zip(rows, slower) if not one] == [
            row for row, one in zip(free, slower) if not one
        ]
        now, before = column(rows, *BUILD), column(free, *BUILD)
        apart = np.arctan2(
            np.linalg.norm(np.cross(now, before), axis=1), (now * before).sum(axis=1)
        ).max()
        (told,) = [
            issue["message"] for issue in report["issues"] if issue["code"] == "TURN_LIMITED"
        ]
        assert float(told.split("by up to ")[1].split(" deg")[0]) == pytest.approx(
            np.degrees(apart), rel=0.01
        )


def test_layers_are_as_far_apart_everywhere_as_asked_for(planned):
    """Where a bead of the tee runs over one of the layer below, no farther to a side than half a layer height."""
    _, _, rows = planned(tee(), height=2.0)
    points, build, layer = places(rows, 0.3)
    ratio = []
    for number in range(1, layer.max() + 1):
        here, below = layer == number, layer == number - 1
        tree = cKDTree(points[below])
        near = tree.query(points[here] - 2.0 * build[here], k=1)
        step = points[here] - points[below][near[1]]
        along = (step * build[below][near[1]]).sum(axis=1)
        ratio.append(along[near[0] < 1.0] / 2.0)
    ratio = np.concatenate(ratio)
    assert ratio.min() > 0.6 and ratio.max() < 1.4
    assert ((ratio > 0.8) & (ratio < 1.2)).mean() > 0.95


def test_offset_layers_have_the_shape_of_what_they_stand_on(planned, workshop):
    dome = Part.makeSphere(40)
    boss = Part.makeCylinder(12, 60).cut(dome)
    dome.exportStep(str(workshop.folder / "dome.step"))
    done, _, rows = planned(boss, "offset", 2.0, more="}\nsubstrate: {file: dome.step")
    assert done.status == 0, done.err
    points, layer = (
        column(rows, "x_mm", "y_mm", "z_mm"),
        np.array([int(row["layer"]) for row in rows]),
    )
    assert layer.max() >= 8
    height = np.linalg.norm(points, axis=1) - 40.0
    # the grid of the distances errs in proportion to the distance from the dome
    assert (np.abs(height - 2.0 * layer) < 0.05 + 0.0105 * height).all()
    lean = (column(rows, "bx", "by", "bz") * points).sum(axis=1) / np.linalg.norm(points, axis=1)
    assert np.degrees(np.arccos(np.clip(lean, -1.0, 1.0))).max() < 5.0


def barrel():
    """A hub that is neither cylinder nor cone: an arc of 50 mm about (-20, 30) turned about Z, 20 to 30 mm from it."""
    arc = Part.Arc(
        FreeCAD.Vector(20, 0, 0), FreeCAD.Vector(30, 0, 30), FreeCAD.Vector(20, 0, 60)
    ).toShape()
    ends = [
        FreeCAD.Vector(20, 0, 60),
        FreeCAD.Vector(0, 0, 60),
        FreeCAD.Vector(0, 0, 0),
        FreeCAD.Vector(20, 0, 0),
    ]
    return Part.Face(Part.Wire([arc, *Part.makePolygon(ends).Edges])).revolve(
        FreeCAD.Vector(), UP, 360
    )


@pytest.mark.parametrize("layers", ["offset", "geodesic"])
def test_layers_of_a_blade_have_the_shape_of_its_hub(planned, workshop, layers):
    """It stands on the hub alone: its flat underside, 18 mm up, lies on nothing."""
    hub = barrel()
    hub.exportStep(str(workshop.folder / "hub.step"))
    blade = Part.makeBox(40, 8, 24, FreeCAD.Vector(5, -4, 18)).cut(hub)
    done, report, rows = planned(blade, layers, 2.0, more="}\nsubstrate: {file: hub.step")
    assert done.status == 0, done.err
    points, layer = (
        column(rows, "x_mm", "y_mm", "z_mm"),
        np.array([int(row["layer"]) for row in rows]),
    )
    off = np.hypot(np.hypot(points[:, 0], points[:, 1]) + 20.0, points[:, 2] - 30.0) - 50.0
    assert np.abs(off - 2.0 * layer).max() < 0.25 and layer.max() >= 7
    assert report["deposit"]["left_out_cm3"] < 5e-5 * blade.Volume
    assert report["unsupported_mm"] == 0.0


def test_layers_on_a_plate_that_is_not_flat_are_as_far_from_it_as_they_are_many(planned, workshop):
    """A saddle of splines: distances of the written points from it, by the geometry kernel."""
    side = np.linspace(-40.0, 40.0, 9)
    saddle = Part.BSplineSurface()
    saddle.interpolate(
        [
            [FreeCAD.Vector(x, y, 0.004 * (x * x - y * y) + 2.0 * np.sin(x / 15.0)) for y in side]
            for x in side
        ]
    )
    face = saddle.toShape()
    plate = face.extrude(FreeCAD.Vector(0, 0, -12))
    plate.exportStep(str(workshop.folder / "plate.step"))
    block = Part.makeBox(26, 22, 40, FreeCAD.Vector(-10, -14, -15)).cut(
        face.extrude(FreeCAD.Vector(0, 0, -60))
    )
    done, report, rows = planned(block, "offset", 2.0, more="}\nsubstrate: {file: plate.step")
    assert done.status == 0, done.err
    points, _, layer = places(rows)
    assert layer.max() >= 8 and report["unsupported_mm"] == 0.0
    away = [face.distToShape(Part.Vertex(*point))[0] for point in points]
    off = np.abs(away - 2.0 * layer)
    # the layers are triangles, coarsest where they bend most; the largest of a few points beside
    # the border depends on the processor's last bits (0.28 to 0.35 mm)
    assert off.max() < 0.4 and np.percentile(off, 99.0) < 0.2 and off.mean() < 0.05


@pytest.mark.parametrize(
    ("make", "height", "mode", "code", "word"),
    [
        (lambda: Part.makeCone(0, 15, 30), 2.0, "", "NOT_STANDING", "turn the part"),
        (
            lambda: Part.Compound(
                [Part.makeBox(20, 20, 10), Part.makeBox(20, 20, 10, FreeCAD.Vector(0, 0, 30))]
            ),
            2.0,
            "",
            "NOT_CONNECTED",
            " % of the solid",
        ),
        (lambda: Part.makeBox(400, 400, 400), 1.0, "", "TOO_FINE", "use at least"),
        (tee, 2.0, ", mode: fixed", "NOT_FOR_FAMILY", "use local"),
        (lambda: Part.makeBox(30, 30, 0.1), 2.0, "", "", ""),
    ],
)
def test_what_cannot_be_cut_is_told(planned, make, height, mode, code, word):
    done, report, _ = planned(make(), height=height, mode=mode)
    if code:
        assert done.status == 2 and report is None
        assert (
            f"error[{code}]" in done.err and word in done.err and done.err.count("error[") == 1
        ), done.err
    else:
        assert done.status in (0, 2) and "INTERNAL" not in done.err, done.err


@pytest.mark.parametrize("key", ["margin: 1 mm", "solid_layers: 2"])
def test_what_only_plane_layers_have_is_refused(planned, key):
    done, _, _ = planned(tee(), more=f", {key}")
    assert (
        done.status == 2 and "error[NOT_FOR_FAMILY]" in done.err and key.split(":")[0] in done.err
    ), done.err


def shell_on_a_dome():
    """A cap between balls of 40 and 50 mm, whose rim slants, and the name of its face on the inner ball."""
    cap = Part.makeSphere(50).cut(Part.makeSphere(40)).common(Part.makeCylinder(25, 60))
    (inner,) = [
        k
        for k, face in enumerate(cap.Faces, start=1)
        if face.Surface.TypeId == "Part::GeomSphere"
        and face.Surface.Radius < 45.0
        and face.CenterOfMass.z > 0.0
    ]
    return cap, f"Face{inner}"


@pytest.mark.parametrize("layers", ["offset", "geodesic"])
@pytest.mark.always("offset")
def test_layers_start_on_the_faces_that_are_named(planned, layers):
    """Every point lies on the ball its layer says, though the part touches the plane under it with its rim alone."""
    cap, inner = shell_on_a_dome()
    done, _, rows = planned(cap, layers, more=f", start_faces: [{inner}]")
    assert done.status == 0, done.err
    points, layer = (
        column(rows, "x_mm", "y_mm", "z_mm"),
        np.array([int(row["layer"]) for row in rows]),
    )
    assert set(layer) == set(range(4))
    assert np.abs(np.linalg.norm(points, axis=1) - 40.0 - HEIGHT * layer).max() < 0.3
    assert (points[:, 2] > 25.0).all()


def test_start_faces_that_are_none_are_refused(planned):
    cap, inner = shell_on_a_dome()
    for layers, named, code in (
        ("planes", f"[{inner}]", "NOT_FOR_FAMILY"),
        ("offset", "[Face99]", "UNKNOWN_FACE"),
        ("offset", "[Edge1]", "BAD_VALUE"),
    ):
        done, report, _ = planned(cap, layers, 2.0, more=f", start_faces: {named}")
        assert done.status == 2 and report is None and done.err.count(f"error[{code}]") == 1, (
            done.err
        )


def test_start_faces_of_another_object_must_be_touched():
    cap, _ = shell_on_a_dome()
    document = FreeCAD.newDocument("Dome")
    try:
        part, dome, away = (
            document.addObject("Part::Feature", name) for name in ("Cap", "Dome", "Away")
        )
        part.Shape, dome.Shape = cap, Part.makeSphere(40)
        away.Shape = Part.makeBox(10, 10, 10, FreeCAD.Vector(80, 0, 0))
        values = {
            "layers": "offset",
            "layer_height": HEIGHT,
            "chord_error": 0.2,
            "bead_spacing": SPACING,
        }
        made = api.result(
            api.make_toolpath(
                document,
                api.make_solid_feature(document, part, start_faces=(dome, ["Face1"]), **values),
            )
        )
        for index, _, bead in made:
            assert np.abs(np.linalg.norm(bead.points, axis=1) - 40.0 - HEIGHT * index).max() < 0.3
        with pytest.raises(InputError) as caught:
            api.make_toolpath(
                document,
                api.make_solid_feature(document, part, start_faces=(away, ["Face1"]), **values),
            )
        assert caught.value.code == "NOT_STANDING" and "mm away" in caught.value.message
    finally:
        FreeCAD.closeDocument(document.Name)
