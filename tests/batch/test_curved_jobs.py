# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs in curved layers, read from waypoints.csv and measured only with OpenCASCADE and distances
between points."""

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
HALF_ANGLE, TIP, LENGTH = np.radians(30.0), 2.0, 60.0  # the nozzle
CELL = """\
cell:
  {machine: fanuc-arcmate120ic, mount: feature, branch: auto, nozzle: {diameter: 4 mm, half_angle: 30 deg, length: 60 mm}}
program: {post: fanuc}
"""
UP = FreeCAD.Vector(0, 0, 1)


def tee():
    """Return a stem under a beam that extends by 15 mm to either side."""
    return (
        Part.makeBox(12, 12, 16)
        .fuse(Part.makeBox(42, 12, 12, FreeCAD.Vector(-15, 0, 15)))
        .removeSplitter()
    )


def wye():
    arms = [
        Part.makeCylinder(6, 26, FreeCAD.Vector(0, 0, 12), FreeCAD.Vector(side, 0, 1))
        for side in (1, -1)
    ]
    return Part.makeCylinder(7, 18).fuse(arms).removeSplitter()


def mushroom():
    cap = Part.makeSphere(16, FreeCAD.Vector(0, 0, 20), UP, 0, 90, 360)
    return Part.makeCylinder(6, 20.5).fuse(cap).removeSplitter()


def bracket():
    """Return a post with an arm that extends by 28 mm at half height."""
    return (
        Part.makeBox(14, 12, 38)
        .fuse(Part.makeBox(29, 12, 12, FreeCAD.Vector(13, 0, 16)))
        .removeSplitter()
    )


def struts():
    """Return a trunk that splits into three branches, each leaning by 40 degrees."""
    directions = [
        FreeCAD.Vector(np.cos(turn), np.sin(turn), 1.2) for turn in np.radians([0.0, 120.0, 240.0])
    ]
    arms = [
        Part.makeCylinder(5, 30, FreeCAD.Vector(0, 0, 12), direction) for direction in directions
    ]
    return Part.makeCylinder(7, 18).fuse(arms).removeSplitter()


@pytest.fixture
def planned(workshop):
    def run(shape, layers="geodesic", height=HEIGHT, more="", mode="", clearance="none", cell=""):
        shape.exportStep(str(workshop.folder / "part.step"))
        job = JOB.format(layers=layers, height=height, more=more, mode=mode, clearance=clearance)
        job = workshop.write_job(job + cell)
        command = workshop.run("plan", job.name, "-o", "out", "--no-page")
        if command.status:
            return command, None, None
        out = workshop.folder / "out"
        with open(next(out.rglob("waypoints.csv")), encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
        return command, json.loads(next(out.rglob("report.json")).read_text(encoding="utf-8")), rows

    return run


def column(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def sample_beads(rows, step=0.5):
    """Return positions (n, 3) along the beads, at most `step` mm apart, their layers and build
    directions."""
    points, build = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, "bx", "by", "bz")
    layer = np.array([int(row["layer"]) for row in rows])
    same = np.array([row["bead"] for row in rows])
    samples = []
    for k in range(1, len(rows)):
        if layer[k] == layer[k - 1] and same[k] == same[k - 1]:
            count = max(int(np.ceil(np.linalg.norm(points[k] - points[k - 1]) / step)), 1)
            share = np.linspace(0.0, 1.0, count + 1)[:, None]
            direction = (1.0 - share) * build[k - 1] + share * build[k]
            samples.append(
                np.column_stack(
                    [
                        (1.0 - share) * points[k - 1] + share * points[k],
                        direction / np.linalg.norm(direction, axis=1)[:, None],
                        np.full(count + 1, layer[k]),
                    ]
                )
            )
    points_ = np.vstack(samples)
    return points_[:, :3], points_[:, 3:6], points_[:, 6].astype(int)


def nozzle_depth(rows, half_angle):
    """Return how far in mm a cone on the tool axis, as wide as the nozzle at its tip, reaches into
    the core of earlier beads: a round bar of half a layer height in radius in the middle of each,
    without beads next to the tip."""
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
        candidates = ~beside & (up > 0.5 * HEIGHT) & (up < LENGTH)
        into = 0.5 * HEIGHT - (aside - TIP - up * np.tan(half_angle)) * np.cos(half_angle)
        worst = max(worst, into[candidates].max(initial=-np.inf))
    return worst


def turn_rates(rows, *names):
    """Return how fast (n - 1,) deg/mm directions turn from row to row; 0 between beads."""
    points, directions = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, *names)
    angle = np.arctan2(
        np.linalg.norm(np.cross(directions[1:], directions[:-1]), axis=1),
        (directions[1:] * directions[:-1]).sum(axis=1),
    )
    bead_ids = np.array([(row["layer"], row["bead"]) for row in rows])
    return (
        np.degrees(angle)
        / np.linalg.norm(np.diff(points, axis=0), axis=1)
        * (bead_ids[1:] == bead_ids[:-1]).all(axis=1)
    )


BUILD, TOOL = ("bx", "by", "bz"), ("tx", "ty", "tz")


def distance_to_beads(points, below, build):
    """Return the distance (n,) in mm of points from beads as wide as their spacing, given positions
    (m, 3) and build directions."""
    distances = np.full(len(points), np.inf)
    for neighbours in cKDTree(below).query(points, k=24)[1].T:
        step = points - below[neighbours]
        along = (step * build[neighbours]).sum(axis=1)
        aside = np.linalg.norm(step - along[:, None] * build[neighbours], axis=1)
        distances = np.minimum(distances, np.hypot(np.maximum(aside - 0.5 * SPACING, 0.0), along))
    return distances


@pytest.mark.parametrize(
    "shape",
    [
        tee,
        *(
            pytest.param(shape, marks=pytest.mark.long)
            for shape in (wye, mushroom, bracket, struts)
        ),
    ],
)
def test_every_bead_lies_on_what_was_deposited_before_and_the_part_is_filled(planned, shape):
    """The job leads to a program: every bead is supported, and the nozzle is clear of the
    deposit. A nozzle of 80 deg would collide, except on the mushroom, where nothing is higher
    than the tip."""
    shape_ = shape()
    command, report, rows = planned(shape_, clearance="nozzle", cell=CELL)
    assert command.status == 0, command.err
    assert report["programs"] and report["unsupported_mm"] == 0.0
    assert not [
        issue
        for issue in report["issues"]
        if issue["code"] in ("UNSUPPORTED", "OFF_PART", "OPEN_GAP")
    ]
    assert nozzle_depth(rows, HALF_ANGLE) < 0.1
    assert (
        max(turn_rates(rows, *BUILD).max(), turn_rates(rows, *TOOL).max()) < 30.03
    )  # deg/mm, the limit above which the job reports TURN_PASSED
    assert shape is mushroom or nozzle_depth(rows, np.radians(80.0)) > 0.1
    points, build, layer = sample_beads(rows)
    assert np.abs(points[layer == 0][:, 2]).max() < 0.01
    spacings = []  # positions of beads with a bead of the layer below directly under them
    for number in range(1, layer.max() + 1):
        in_layer, low = layer == number, layer == number - 1
        below = cKDTree(points[low])
        distances = below.query(points[in_layer] - HEIGHT * build[in_layer])[0]
        assert distances.max() < 0.6 * SPACING, (
            number
        )  # beads below are a spacing apart, so half a spacing to the side at most
        spacings.append(below.query(points[in_layer][distances < 0.5 * HEIGHT])[0] / HEIGHT)
        assert distance_to_beads(points[in_layer], points[low], build[low]).max() < 1.2 * HEIGHT, (
            number
        )
    ratio = np.concatenate(spacings)
    assert ratio.min() > 0.6 and ratio.max() < 1.4 and ((ratio > 0.8) & (ratio < 1.2)).mean() > 0.95
    if shape is wye:  # its arms are two islands and stay separate
        parted = [
            number
            for number in range(layer.max() + 1)
            if np.abs(points[layer == number][:, 0]).min() > 2.0
        ]
        assert len(parted) > 3 and parted == list(range(parted[0], layer.max() + 1))
    lifted = points[::7] + 0.5 * HEIGHT * build[::7]
    solid = shape_.Solids[0]
    outside = [p for p in lifted if not solid.isInside(FreeCAD.Vector(*p), 0.3, True)]
    assert len(outside) == 0
    volume = report["totals"]["volume_cm3"] * 1000.0
    assert volume == pytest.approx(
        shape_.Volume, rel=0.12
    )  # cut in steps of a whole layer: arms of 12 mm in beads of 4 mm


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
    """Directions of the field turn by a radian per layer height next to a corner; beads below the
    limit stay unchanged."""
    free = [] if set(asked) == {LEADING} else planned(shape(), mode=", max_turn: inf")[2]
    beads = np.array([(row["layer"], row["bead"]) for row in free])
    for mode, max_turn in asked.items():
        command, report, rows = planned(shape(), mode=mode)
        assert command.status == 0, command.err
        assert (
            max(turn_rates(rows, *BUILD).max(), turn_rates(rows, *TOOL).max()) < max_turn + 0.03
        ), mode  # rows have six decimals
        if mode == LEADING:
            cosines = (column(rows, *BUILD) * column(rows, *TOOL)).sum(axis=1)
            assert np.median(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))) == pytest.approx(
                10.0, abs=0.1
            )
            continue
        assert (column(rows, "x_mm", "y_mm", "z_mm") == column(free, "x_mm", "y_mm", "z_mm")).all()
        fast = np.unique(beads[1:][turn_rates(free, *BUILD) > max_turn], axis=0)
        assert 0 < len(fast) < len(np.unique(beads, axis=0))
        slower = (beads[:, None] == fast).all(axis=2).any(axis=1)
        assert [row for row, is_slower in zip(rows, slower) if not is_slower] == [
            row for row, is_slower in zip(free, slower) if not is_slower
        ]
        now, original = column(rows, *BUILD), column(free, *BUILD)
        angles = np.arctan2(
            np.linalg.norm(np.cross(now, original), axis=1), (now * original).sum(axis=1)
        ).max()
        (message,) = [
            issue["message"] for issue in report["issues"] if issue["code"] == "TURN_LIMITED"
        ]
        assert float(message.split("by up to ")[1].split(" deg")[0]) == pytest.approx(
            np.degrees(angles), rel=0.01
        )


def test_layers_are_as_far_apart_everywhere_as_asked_for(planned):
    """Where a bead of the tee runs over a bead of the layer below, it is offset by at most half a
    layer height."""
    _, _, rows = planned(tee(), height=2.0)
    points, build, layer = sample_beads(rows, 0.3)
    ratio = []
    for number in range(1, layer.max() + 1):
        in_layer, below = layer == number, layer == number - 1
        tree = cKDTree(points[below])
        distances = tree.query(points[in_layer] - 2.0 * build[in_layer], k=1)
        step = points[in_layer] - points[below][distances[1]]
        along = (step * build[below][distances[1]]).sum(axis=1)
        ratio.append(along[distances[0] < 1.0] / 2.0)
    ratio = np.concatenate(ratio)
    assert ratio.min() > 0.6 and ratio.max() < 1.4
    assert ((ratio > 0.8) & (ratio < 1.2)).mean() > 0.95


def test_offset_layers_have_the_shape_of_what_they_stand_on(planned, workshop):
    dome = Part.makeSphere(40)
    boss = Part.makeCylinder(12, 60).cut(dome)
    dome.exportStep(str(workshop.folder / "dome.step"))
    command, _, rows = planned(boss, "offset", 2.0, more="}\nsubstrate: {file: dome.step")
    assert command.status == 0, command.err
    points, layer = (
        column(rows, "x_mm", "y_mm", "z_mm"),
        np.array([int(row["layer"]) for row in rows]),
    )
    assert layer.max() >= 8
    height = np.linalg.norm(points, axis=1) - 40.0
    # the error of the distance grid is proportional to the distance from the dome
    assert (np.abs(height - 2.0 * layer) < 0.05 + 0.0105 * height).all()
    lean = (column(rows, "bx", "by", "bz") * points).sum(axis=1) / np.linalg.norm(points, axis=1)
    assert np.degrees(np.arccos(np.clip(lean, -1.0, 1.0))).max() < 5.0


def barrel():
    """Return a hub that is neither cylinder nor cone: an arc of 50 mm about (-20, 30) rotated about
    Z, 20 to 30 mm from it."""
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
    """The blade touches the hub only: its flat underside at 18 mm has nothing below."""
    hub = barrel()
    hub.exportStep(str(workshop.folder / "hub.step"))
    blade = Part.makeBox(40, 8, 24, FreeCAD.Vector(5, -4, 18)).cut(hub)
    command, report, rows = planned(blade, layers, 2.0, more="}\nsubstrate: {file: hub.step")
    assert command.status == 0, command.err
    points, layer = (
        column(rows, "x_mm", "y_mm", "z_mm"),
        np.array([int(row["layer"]) for row in rows]),
    )
    off = np.hypot(np.hypot(points[:, 0], points[:, 1]) + 20.0, points[:, 2] - 30.0) - 50.0
    assert np.abs(off - 2.0 * layer).max() < 0.25 and layer.max() >= 7
    assert report["deposit"]["left_out_cm3"] < 5e-5 * blade.Volume
    assert report["unsupported_mm"] == 0.0


def test_layers_on_a_plate_that_is_not_flat_are_as_far_from_it_as_they_are_many(planned, workshop):
    """The geometry kernel measures the distances of the written points from a saddle of splines."""
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
    command, report, rows = planned(block, "offset", 2.0, more="}\nsubstrate: {file: plate.step")
    assert command.status == 0, command.err
    points, _, layer = sample_beads(rows)
    assert layer.max() >= 8 and report["unsupported_mm"] == 0.0
    distances = [face.distToShape(Part.Vertex(*point))[0] for point in points]
    off = np.abs(distances - 2.0 * layer)
    # the layers are triangles, coarsest where they bend most; the maximum at a few points next to
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
    command, report, _ = planned(make(), height=height, mode=mode)
    if code:
        assert command.status == 2 and report is None
        assert (
            f"error[{code}]" in command.err
            and word in command.err
            and command.err.count("error[") == 1
        ), command.err
    else:
        assert command.status in (0, 2) and "INTERNAL" not in command.err, command.err


@pytest.mark.parametrize("key", ["margin: 1 mm", "solid_layers: 2"])
def test_what_only_plane_layers_have_is_refused(planned, key):
    command, _, _ = planned(tee(), more=f", {key}")
    assert (
        command.status == 2
        and "error[NOT_FOR_FAMILY]" in command.err
        and key.split(":")[0] in command.err
    ), command.err


def shell_on_a_dome():
    """Return a cap between spheres of 40 and 50 mm with a slanted rim, and the name of its face on
    the inner sphere."""
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
    """Every point lies on the sphere of its layer, although the part touches the plane below with
    its rim."""
    cap, inner = shell_on_a_dome()
    command, _, rows = planned(cap, layers, more=f", start_faces: [{inner}]")
    assert command.status == 0, command.err
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
        command, report, _ = planned(cap, layers, 2.0, more=f", start_faces: {named}")
        assert (
            command.status == 2 and report is None and command.err.count(f"error[{code}]") == 1
        ), command.err


def test_start_faces_of_another_object_must_be_touched():
    cap, _ = shell_on_a_dome()
    document = FreeCAD.newDocument("Dome")
    try:
        feature, dome, distant = (
            document.addObject("Part::Feature", name) for name in ("Cap", "Dome", "Away")
        )
        feature.Shape, dome.Shape = cap, Part.makeSphere(40)
        distant.Shape = Part.makeBox(10, 10, 10, FreeCAD.Vector(80, 0, 0))
        values = {
            "layers": "offset",
            "layer_height": HEIGHT,
            "chord_error": 0.2,
            "bead_spacing": SPACING,
        }
        toolpath = api.result(
            api.make_toolpath(
                document,
                api.make_solid_feature(document, feature, start_faces=(dome, ["Face1"]), **values),
            )
        )
        for index, _, bead in toolpath:
            assert np.abs(np.linalg.norm(bead.points, axis=1) - 40.0 - HEIGHT * index).max() < 0.3
        with pytest.raises(InputError) as caught:
            api.make_toolpath(
                document,
                api.make_solid_feature(
                    document, feature, start_faces=(distant, ["Face1"]), **values
                ),
            )
        assert caught.value.code == "NOT_STANDING" and "mm away" in caught.value.message
    finally:
        FreeCAD.closeDocument(document.Name)
