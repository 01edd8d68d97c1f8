# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of cladding: OpenCASCADE and formulas of the surfaces measure waypoints.csv and the
program."""

import csv
import json
import re

import FreeCAD
import Mesh
import numpy as np
import Part
import pytest

V = FreeCAD.Vector
HEIGHT, SPACING = 2.0, 6.0
JOB = """\
version: 1
name: clad
part: {{file: part.step{faces}}}
strategy: {{kind: cladding, layer_height: 2 mm, chord_error: 0.1 mm, bead_spacing: 6 mm{more}}}
process: {{bead_width: 6 mm}}
build_direction: {{clearance: {clearance}}}
"""
CELL = """\
cell: {machine: table-xyzac, setup: rotary-table, platform: 60 mm, platform_diameter: 0 mm}
program: {post: siemens, motion: cartesian}
"""


@pytest.fixture
def planned(workshop):
    def run(shape, faces="", more="", cell="", clearance="none"):
        shape.exportStep(str(workshop.folder / "part.step"))
        job = workshop.write_job(JOB.format(faces=faces, more=more, clearance=clearance) + cell)
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


def named(shape, faces_wanted):
    return f", faces: [{', '.join(f'Face{k}' for k, face in enumerate(shape.Faces, 1) if faces_wanted(face))}]"


def die():
    """Return a block with a doubly curved top and a bore through it."""
    poles = [
        [V(x, y, 20 + 4 * np.cos(x / 20) * np.cos(y / 25)) for y in range(-10, 61, 10)]
        for x in range(-10, 81, 10)
    ]
    top = Part.BSplineSurface()
    top.interpolate(poles)
    block = Part.makeBox(70, 50, 40).cut(Part.makeCylinder(8, 60, V(45, 25, -5)))
    over = top.toShape().extrude(V(0, 0, 60))
    return block.cut(over).removeSplitter()


def covered(rows, points, layer, half):
    """Return the share of points (n, 3) within `half` of the beads of a layer."""
    layer_rows = [row for row in rows if int(row["layer"]) == layer]
    bead, xyz = column(layer_rows, "bead")[:, 0], column(layer_rows, "x_mm", "y_mm", "z_mm")
    steps = np.flatnonzero(np.diff(bead) == 0.0)
    start, segments = xyz[steps], xyz[steps + 1] - xyz[steps]
    distances = np.full(len(points), np.inf)
    for a, b in zip(start, segments):
        t = np.clip((points - a) @ b / max(b @ b, 1e-12), 0.0, 1.0)
        distances = np.minimum(distances, np.linalg.norm(points - a - t[:, None] * b, axis=1))
    return (distances <= half).mean()


def test_a_scan_of_a_top_gets_layers_on_the_side_it_looks_to(workshop):
    """An open mesh of a curved top with downward triangles: two layers hang below the exact face,
    their heights off it. A closed mesh has no faces to cover."""
    poles = [
        [V(x, y, 20 + 4 * np.cos(x / 20) * np.cos(y / 25)) for y in range(0, 41, 10)]
        for x in range(0, 41, 10)
    ]
    top = Part.BSplineSurface()
    top.interpolate(poles)
    face = top.toShape()
    corners = np.array(
        [
            [tuple(point) for point in facet.Points]
            for facet in Mesh.Mesh(face.tessellate(0.02)).Facets
        ]
    )
    down = np.where(
        (np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0.0)[
            :, None, None
        ],
        corners[:, ::-1],
        corners,
    )
    Mesh.Mesh(down.tolist()).write(str(workshop.folder / "scan.stl"))
    text = JOB.format(faces="", more=", layers: 2", clearance="none").replace(
        "part.step", "scan.stl"
    )
    command = workshop.run("plan", workshop.write_job(text).name, "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(
        next((workshop.folder / "out").rglob("waypoints.csv")), encoding="utf-8", newline=""
    ) as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    xyz, layer = column(rows, "x_mm", "y_mm", "z_mm")[::5], column(rows, "layer")[::5, 0]
    assert set(layer) == {0.0, 1.0} and (column(rows, "bz") < -0.8).all()
    distances = np.array([face.distToShape(Part.Vertex(V(*point)))[0] for point in xyz])
    np.testing.assert_allclose(distances, HEIGHT * layer, atol=0.1 + 0.02)
    inner = top.toShape(0.1, 0.9, 0.1, 0.9).tessellate(0.02)[0]
    assert covered(rows, np.array([tuple(point) for point in inner]), 0, 0.6 * SPACING) > 0.98
    Mesh.Mesh(Part.makeBox(20, 20, 20).tessellate(0.5)).write(str(workshop.folder / "scan.stl"))
    command = workshop.run("plan", workshop.write_job(text).name, "-o", "out", "--no-page")
    assert command.status == 2 and "NO_FACES" in command.err and "closed mesh" in command.err


def test_chosen_faces_of_a_solid_are_covered_by_themselves(workshop):
    """With kind: auto on a face of a thick block, at x = 30, the job gets the one requested layer,
    not those of a low part."""
    job = JOB.replace("kind: cladding", "kind: auto").format(
        faces=", faces: [Face2]", more="", clearance="none"
    )
    Part.makeBox(30, 20, 25).exportStep(str(workshop.folder / "part.step"))
    command = workshop.run("plan", workshop.write_job(job).name, "-o", "out", "--no-page")
    assert (
        command.status == 0
        and "kind: cladding: the selected faces of part" in command.err
        and "SINGLE_LAYER" not in command.err
    )
    with open(
        next((workshop.folder / "out").rglob("waypoints.csv")), encoding="utf-8", newline=""
    ) as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    xyz = column(rows, "x_mm", "y_mm", "z_mm")
    np.testing.assert_allclose(xyz[:, 0], 30.0, atol=1e-6)
    assert np.ptp(xyz[:, 1]) > 13.0 and np.ptp(xyz[:, 2]) > 18.0


def test_a_bent_top_gets_layers_above_it_and_the_program_has_them(planned, workshop):
    shape = die()
    is_top = lambda face: face.Surface.TypeId == "Part::GeomBSplineSurface"  # noqa: E731
    top = next(face for face in shape.Faces if is_top(face))
    command, report, rows = planned(
        shape, named(shape, is_top), ", layers: 2, fill: zigzag", CELL, "nozzle"
    )
    assert command.status == 0, command.err
    assert report["counts"]["layers"] == 2 and report["unsupported_mm"] == 0.0
    points, layer = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, "layer")[:, 0]
    distances = np.array([top.distToShape(Part.Vertex(*point))[0] for point in points[::7]])
    np.testing.assert_allclose(
        distances, HEIGHT * layer[::7], atol=0.1
    )  # the chord error, because planning adds points between
    # beads stay half of their width inside the face, up to the chord error
    lowest = [Part.Vertex(*point) for point in points[layer == 0][::11]]
    rim = np.array([min(edge.distToShape(point)[0] for edge in top.Edges) for point in lowest])
    assert rim.min() > 0.5 * SPACING - 0.25
    low_u, high_u, low_v, high_v = top.ParameterRange
    parameters_ = [
        (u, v) for u in np.linspace(low_u, high_u, 60) for v in np.linspace(low_v, high_v, 45)
    ]
    grid = [uv for uv in parameters_ if top.isPartOfDomain(*uv)]
    for number in (0, 1):
        above = np.array(
            [tuple(top.valueAt(u, v) + HEIGHT * number * top.normalAt(u, v)) for u, v in grid]
        )
        assert covered(rows, above, number, 0.5 * SPACING * 1.03) > 0.985
    deposit = report["deposit"]
    assert deposit["part_cm3"] == pytest.approx(2 * HEIGHT * top.Area / 1000.0, rel=0.01)
    # beads that link lines are narrower; the regions that they and their round ends leave bare
    # count
    assert deposit["left_out_cm3"] < 0.03 * deposit["part_cm3"]
    covers = deposit["deposited_cm3"] + deposit["beside_cm3"]
    twice = max(report["totals"]["volume_cm3"] - covers, 0.0)
    assert deposit["twice_cm3"] == pytest.approx(twice, abs=0.01 * covers)
    text = "".join(path.read_text() for path in sorted(workshop.folder.glob("out/program/*.MPF")))
    number = r"(-?[\d.]+)"
    form = re.compile(f"G1 X{number} Y{number} Z{number} A3={number} B3={number} C3={number}")
    laid = [form.findall(deposit_text.split("H1=0")[0]) for deposit_text in text.split("H1=1")[1:]]
    numbers_ = np.array([[float(cell) for cell in hit] for hits in laid for hit in hits])
    assert (
        len(numbers_) == len(rows) - report["counts"]["beads"]
    )  # a bead begins at the current position of the torch
    above = np.array([top.distToShape(Part.Vertex(*point))[0] for point in numbers_[::9, :3]])
    assert (np.minimum(above, np.abs(above - HEIGHT)) < 0.1).all() and above.max() > 1.9
    foot = (
        numbers_[::9, :3] - above[:, None] * numbers_[::9, 3:]
    )  # down the tool, along the normal if nothing is in its way
    assert max(top.distToShape(Part.Vertex(*point))[0] for point in foot) < 0.1


def test_layers_on_a_shaft_and_in_a_bore_keep_their_spacing_where_they_lie(planned):
    """The second layer has an 8 % larger circumference than the shaft, and a smaller one than the
    bore: bead spacing in both directions is that of the first layer. Beads start and end half a
    bead from the single seam."""
    for shape, radius, sign, angle in (
        (Part.makeCylinder(25, 40), 25.0, 1.0, 90),
        (Part.makeCylinder(30, 40).cut(Part.makeCylinder(22, 40)), 22.0, -1.0, 0),
    ):
        faces = named(shape, lambda face, r=radius: getattr(face.Surface, "Radius", 0.0) == r)
        options = f", layers: 2, fill: lines, fill_angle: {angle} deg, fill_angle_step: 0 deg, contour: false"
        command, report, rows = planned(shape, faces, options)
        assert command.status == 0, command.err
        points, build = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, "bx", "by", "bz")
        layer = column(rows, "layer")[:, 0]
        reach = np.hypot(points[:, 0], points[:, 1])
        np.testing.assert_allclose(reach, radius + sign * HEIGHT * layer, atol=1e-5)
        out = sign * np.column_stack([points[:, :2] / reach[:, None], np.zeros(len(points))])
        np.testing.assert_allclose(build, out, atol=1e-5)
        assert report["unsupported_mm"] == 0.0
        for number in (0, 1):
            layer_rows = [row for row in rows if int(row["layer"]) == number]
            bead, round_ = column(layer_rows, "bead")[:, 0], radius + sign * HEIGHT * number
            azimuth, z = (
                np.arctan2(column(layer_rows, "y_mm")[:, 0], column(layer_rows, "x_mm")[:, 0]),
                column(layer_rows, "z_mm")[:, 0],
            )
            size = {
                k: np.hypot(round_ * np.ptp(np.unwrap(azimuth[bead == k])), np.ptp(z[bead == k]))
                for k in set(bead)
            }
            long = [
                k for k in size if size[k] > 0.9 * max(size.values())
            ]  # other beads close gaps at their ends
            if angle == 90:
                along = [np.exp(1j * azimuth[bead == k]) for k in long]
                assert (
                    max(np.ptp(np.angle(bead_points / bead_points[0])) for bead_points in along)
                    < 0.02
                )
                angles = np.sort([np.angle(bead_points.mean()) for bead_points in along])
                spacings = round_ * np.diff(np.r_[angles, angles[0] + 2.0 * np.pi])
                assert len(along) * SPACING > 2.0 * np.pi * round_ - SPACING
            else:
                assert (
                    sorted(np.ptp(z[bead == k]) for k in long)[-3] < 0.02
                )  # two of them close the remaining gap
                spacings = np.diff(np.sort([z[bead == k].mean() for k in long]))
            usual = np.sort(
                np.abs(spacings - SPACING)
            )  # except for the remaining gap, and next to the seam
            assert usual[: len(usual) - (5 if angle == 90 else 4)].max() < 0.01 * SPACING, spacings
            assert spacings.max() < 1.03 * SPACING


def test_a_shaft_is_laid_flat_as_it_is_wherever_the_vertices_of_its_mesh_lie_beside_the_seam(
    planned,
):
    """Two vertices on either side of the seam, joined by an edge, were once both moved onto it and
    merged."""
    shape = Part.makeCylinder(36, 60)
    faces = named(shape, lambda face: getattr(face.Surface, "Radius", 0.0) == 36.0)
    command, report, rows = planned(shape, faces, ", fill: zigzag")
    assert command.status == 0, command.err
    assert [
        issue["message"]
        for issue in report["issues"]
        if issue["code"] in ("DISTORTED", "DEPOSITED_TWICE")
    ] == []
    points = column(rows, "x_mm", "y_mm", "z_mm")
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 36.0, atol=1e-5)
    assert report["length_mm"] == pytest.approx(2.0 * np.pi * 36.0 * 60.0 / SPACING, rel=0.1)


def test_a_ball_is_covered_in_pieces_within_the_distortion_told(planned):
    command, report, rows = planned(
        Part.makeSphere(20), ", faces: [Face1]", ", fill: contours, distortion: 8 %"
    )
    assert command.status == 0, command.err
    messages = [issue["message"] for issue in report["issues"] if issue["code"] == "DISTORTED"]
    assert len(messages) == 1 and float(re.search(r"up to ([\d.]+) %", messages[0])[1]) <= 8.0
    np.testing.assert_allclose(
        np.linalg.norm(column(rows, "x_mm", "y_mm", "z_mm"), axis=1), 20.0, atol=1e-5
    )
    turn, up = (
        2.0 * np.pi * ((np.arange(4000) / 1.618033988749895) % 1.0),
        1.0 - 2.0 * (np.arange(4000) + 0.5) / 4000,
    )
    grid = 20.0 * np.column_stack(
        [np.sqrt(1.0 - up**2) * np.cos(turn), np.sqrt(1.0 - up**2) * np.sin(turn), up]
    )
    assert covered(rows, grid, 0, 0.5 * SPACING * 1.08) > 0.98


def test_faces_that_are_no_neighbours_are_regions_and_creases_are_told(planned):
    box = Part.makeBox(60, 40, 30)
    ends = lambda face: abs(face.CenterOfMass.x - 30.0) > 29.0  # noqa: E731
    command, report, rows = planned(box, named(box, ends), ", layers: 2, fill: spiral")
    assert command.status == 0 and "CREASE" not in command.err, command.err
    build, x, layer = (
        column(rows, "bx")[:, 0],
        column(rows, "x_mm")[:, 0],
        column(rows, "layer")[:, 0],
    )
    np.testing.assert_allclose(
        x, np.where(build > 0.0, 60.0 + HEIGHT * layer, -HEIGHT * layer), atol=1e-9
    )
    assert report["counts"]["layers"] == 2 and (build > 0.0).mean() == 0.5
    beside = named(box, lambda face: face.CenterOfMass.x + face.CenterOfMass.z > 50.0)
    command, report, rows = planned(box, beside, ", layers: 2")
    assert (
        command.status == 0
        and "warning[CREASE]" in command.err
        and "90 deg" in command.err
        and "2 mm" in command.err
    ), command.err


def test_the_other_side_of_a_skin(planned):
    skin = Part.makeCylinder(25, 40).Faces[0]
    for side, radius in (("front", 27.0), ("back", 23.0)):
        command, _, rows = planned(skin, "", f", layers: 2, side: {side}")
        assert command.status == 0, command.err
        outer_layer = column([row for row in rows if row["layer"] == "1"], "x_mm", "y_mm")
        np.testing.assert_allclose(np.hypot(*outer_layer.T), radius, atol=1e-5)


def two_boxes():
    return Part.makeCompound([Part.makeBox(20, 20, 20), Part.makeBox(20, 20, 20, V(40, 0, 0))])


@pytest.mark.parametrize(
    ("shape", "faces", "more", "code", "words"),
    [
        (Part.makeBox(20, 20, 20), ", edges: [Edge1]", "", "NOT_FOR_FAMILY", "part.edges"),
        (Part.makeBox(20, 20, 20), "", "", "NO_FACES", "no face is selected"),
        (Part.makeBox(20, 20, 20), ", faces: [Face7]", "", "UNKNOWN_FACE", "no Face7"),
        (two_boxes(), ", faces: [Face1, Face8]", "", "SEVERAL_BODIES", "Face1 and Face8"),
        (
            Part.makeBox(20, 20, 20),
            ", faces: [Face1]",
            ", side: back",
            "BACK_OF_SOLID",
            "strategy.side",
        ),
        (
            Part.makeBox(20, 20, 20),
            ", faces: [Face1]",
            ", layers: 0",
            "BAD_VALUE",
            "strategy.layers",
        ),
        (
            Part.makeBox(20, 20, 20),
            ", faces: [Face1]",
            ", margin: 1 mm",
            "NOT_FOR_FAMILY",
            "strategy.margin",
        ),
        (
            Part.makeBox(40, 40, 10).cut(Part.makeCylinder(6, 40, V(-1, 20, 10), V(1, 0, 0))),
            ", faces: [Face5]",
            ", layers: 4",
            "FOLDED",
            "most 3 layer",
        ),
    ],
)
def test_what_cannot_be_covered_is_told(planned, shape, faces, more, code, words):
    if code == "FOLDED":
        faces = named(shape, lambda face: face.Surface.TypeId == "Part::GeomCylinder")
    command, _, _ = planned(shape, faces, more)
    assert command.status == 2 and f"error[{code}]" in command.err and words in command.err, (
        command.err
    )
    assert command.err.count("error[") == 1


def test_a_worn_die_in_joint_motion_is_read_back_on_its_beads(workshop, root):
    """Between two points the largest bend of the axes may be at any position, so planning adds
    points wherever the deviation is too large."""
    examples = root / "resources" / "examples"
    job = (
        (examples / "die.yaml")
        .read_text(encoding="utf-8")
        .replace("motion: cartesian", "motion: joint")
    )
    job = workshop.write_job(job.replace("die.step", str(examples / "die.step")))
    command = workshop.run("plan", job.name, "-o", "out", "--no-page")
    assert command.status == 0, command.err
    assert list((workshop.folder / "out" / "program").iterdir())
