# SPDX-License-Identifier: LGPL-2.1-or-later
"""`kind: auto` chooses family and layers that suit a part, states the reason, and gives a valid
job."""

import csv
import json

import FreeCAD
import Mesh
import MeshPart
import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.objects.families.recognition import SelectedPart
from freecad_am.objects.families.registry import propose_family
from freecad_am.objects.shapes.bodies import Taken

UP = Vector(0, 0, 1)


def proposed_for(*arguments, **options):
    return propose_family(SelectedPart(*arguments, **options))


def tube(outer, inner, height):
    return Part.makeCylinder(outer, height).cut(Part.makeCylinder(inner, height))


def tee():
    return (
        Part.makeBox(20, 20, 40).fuse(Part.makeBox(90, 20, 12, Vector(-35, 0, 40))).removeSplitter()
    )


def propose(shape, substrate=None, *, faces=(), edges=False, width=8.0, tilts=True, **options):
    under = None if substrate is None else Taken("ground", substrate)
    return proposed_for(Taken("part", shape), faces, under, edges, width, tilts, **options)


@pytest.mark.parametrize(
    ("shape", "kind", "layers", "why"),
    [
        (
            lambda: Part.makeSphere(45, Vector(), UP, 0, 90, 360).Faces[0],
            "revolution",
            "",
            "is a surface of revolution",
        ),
        (lambda: tube(40, 32, 50), "revolution", "", "its wall is one bead of 8 mm"),
        (lambda: Part.makeCylinder(30, 20), "solid", "planes", "would leave out"),
        (
            lambda: Part.makeBox(60, 40, 10).fuse(Part.makeBox(10, 40, 40)),
            "solid",
            "planes",
            "a solid, and less than 1% of its surface overhangs",
        ),
        (tee, "solid", "geodesic", "overhangs by more than 45 deg"),
        (
            lambda: Part.makeCompound(
                [Part.makeBox(9, 9, 9), Part.makeBox(9, 9, 9, Vector(20, 0, 0))]
            ),
            "solid",
            "planes",
            "holds 2 solids",
        ),
    ],
)
def test_a_part_alone(shape, kind, layers, why):
    proposal = propose(shape())
    assert (proposal.kind, proposal.layers) == (kind, layers) and why in proposal.text(), proposal


def test_what_would_be_left_out_is_the_middle():
    """A wall of one bead, 8 mm wide, leaves out everything inside."""
    proposal = propose(Part.makeCylinder(30, 20))
    stated_volume = float(proposal.reason.split("leave out ")[1].split()[0])
    assert stated_volume == pytest.approx(np.pi * 22.0**2 * 20.0 / 1000.0, rel=0.03)


def test_without_a_machine_nothing_tilts():
    proposal = propose(tee(), tilts=False)
    assert (proposal.kind, proposal.layers) == (
        "solid",
        "planes",
    ) and "layers: geodesic" in proposal.reason


def test_a_part_on_another():
    hub = Part.makeCylinder(25, 80)
    fin = Part.makeBox(24, 30, 30, Vector(10, -15, 20)).cut(hub)
    assert propose(fin, hub).kind == "developable" and "of ground" in propose(fin, hub).reason
    assert (
        propose(
            Part.makeCylinder(12, 40).Faces[0], Part.makeBox(40, 40, 10, Vector(-20, -20, -10))
        ).kind
        == "surface"
    )
    assert (
        propose(Part.makeBox(9, 9, 9), Part.makeBox(40, 40, 10, Vector(0, 0, -10))).kind == "solid"
    )
    assert propose(Part.makeCylinder(12, 40).Faces[0], edges=True).kind == "surface"
    compound = propose(Part.makeCompound([hub, fin, fin.rotated(Vector(), UP, 180.0)]))
    assert compound.kind == "solid" and "name it as the substrate" in compound.reason
    rooted = Part.makeBox(24, 6, 30, Vector(20, -3, 20))  # 5 mm of it are in the hub
    assert rooted.common(hub).Volume > 0 and propose(rooted, hub).kind == "developable"
    above = Part.makeBox(20, 20, 30, Vector(-10, -10, 75))  # through its end face
    assert above.common(hub).Volume > 0 and propose(above, hub).kind == "solid"


def test_what_stands_on_something_bent_gets_layers_of_its_shape():
    """A blade on a hub that is neither cylinder nor cone, and a round boss on a ball. A machine
    that cannot tilt prints them in planes, like a part on the flat end of the hub or one that
    touches it from the side."""
    arc = Part.Arc(Vector(20, 0, 0), Vector(30, 0, 30), Vector(20, 0, 60)).toShape()
    ends = Part.makePolygon(
        [Vector(20, 0, 60), Vector(0, 0, 60), Vector(0, 0, 0), Vector(20, 0, 0)]
    ).Edges
    hub, ball = Part.Face(Part.Wire([arc, *ends])).revolve(Vector(), UP, 360), Part.makeSphere(40)
    blade = Part.makeBox(40, 20, 24, Vector(5, -10, 18)).cut(hub)
    for shape, ground in ((blade, hub), (Part.makeCylinder(12, 60).cut(ball), ball)):
        proposal = propose(shape, ground, width=4.0)
        assert (proposal.kind, proposal.layers) == (
            "solid",
            "geodesic",
        ) and "the bend of ground at its base" in proposal.reason
        assert propose(shape, ground, width=4.0, tilts=False).layers == "planes"
    assert propose(Part.makeCylinder(12, 20, Vector(0, 0, 60)), hub).layers == "planes"
    blades = [blade.rotated(Vector(), UP, angle) for angle in (0, 120, 240)]
    assert propose(Part.makeCompound(blades), hub, width=4.0).layers == "geodesic"
    together = propose(Part.makeCompound([blades[0], hub, *blades[1:]]), width=4.0)
    assert (
        together.layers == "planes"
        and "other solids are on the bend of Solid2: as the substrate" in together.reason
    )
    separate = propose(
        Part.makeCompound([hub, *(blade_.translated(Vector(0, 0, 200)) for blade_ in blades)]),
        width=4.0,
    )
    assert "others are" not in separate.reason
    assert propose(Part.makeBox(20, 20, 20, Vector(30, -10, 20)), hub).layers == "planes"


def test_a_round_boss_is_filled_and_a_shell_is_a_wall():
    """On a substrate: rods at most two beads thick, with no point deeper than one; a cone; half of
    a tube."""
    plate = Part.makeBox(80, 80, 10, Vector(-40, -40, -10))
    for radius in (3.0, 4.0, 5.0):
        proposal = propose(Part.makeCylinder(radius, 40), plate, width=4.0)
        assert proposal.kind == "solid" and proposal.layers == "planes", radius
    assert propose(Part.makeCone(5, 3, 30), plate, width=4.0).kind == "solid"
    cut = Part.makeBox(80, 40, 80, Vector(-40, -40, -20))
    half = tube(20, 16, 40).cut(cut)
    outer = max(
        (face.Surface.Radius, f"Face{k}")
        for k, face in enumerate(half.Faces, 1)
        if face.Surface.TypeId == "Part::GeomCylinder"
    )[1]
    assert propose(half, plate, faces=(outer,), width=4.0).kind == "surface"


def test_what_nothing_serves_gets_the_nearest():
    bent = Part.makeSphere(30).Faces[0].toNurbs().Faces[0].Surface.toShape(0.1, 2.0, 0.1, 0.9)
    bent = bent.transformGeometry(
        FreeCAD.Matrix(1, 0.3, 0, 0, 0, 0.7, 0.2, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    )
    # otherwise it starts on its lower edge
    proposal = propose(bent.rotated(Vector(), Vector(1, 0, 0), 20.0))
    assert proposal.kind == "surface" and "choose a substrate or start edges" in proposal.reason


def test_overhang_counts_along_the_stacking_direction():
    """A T of 20 mm width has two overhanging strips of 35 mm along Z, and none along Y, its
    extrusion direction."""
    share = 2 * 35 * 20 / (2 * (20 * 40 + 90 * 12) + 20 * (2 * 40 + 2 * 12 + 2 * 90))
    upright = propose(tee())
    assert f"and {share:.0%} of its surface" in upright.reason
    assert "; stacked along (0, 1, 0) the share would be 0%" in upright.reason
    for direction in ((0, 1, 0), (0.0, -3.0, 0.0), None):
        lying = propose(tee(), direction=direction)
        assert (lying.kind, lying.layers) == (
            "solid",
            "planes",
        ) and "less than 1% of its surface overhangs" in lying.reason
    assert (
        propose(tee().rotated(Vector(), Vector(1, 0, 0), 90.0), direction=(0, -1, 0)).layers
        == "geodesic"
    )


def test_what_stands_within_half_a_layer_is_that_of_the_layers_of_the_job(workshop):
    """A pin of 2 mm is within the lowest half of a layer of 4 mm, but unsupported with layers of
    0.25 mm."""
    pin = Part.makeCylinder(1, 8, Vector(), Vector(0.6, 0.8, 0))
    assert "stacked along" in propose(pin, direction=None, width=0.6, layer_height=0.25).reason
    standing = propose(Part.makeCylinder(1, 8), direction=None, width=0.6, layer_height=0.25)
    assert standing.layers == "planes" and "stacked along" not in standing.reason
    assert (
        "stacked along"
        in propose(Part.makeCylinder(1, 8), direction=None, width=0.6, layer_height=4.0).reason
    )
    Part.makeCylinder(1, 8).exportStep(str(workshop.folder / "part.step"))
    job = AUTO.replace("kind: auto", "kind: auto, direction: auto, bead_spacing: 0.6 mm").replace(
        "5 mm", "0.25 mm"
    )
    job += "process: {bead_width: 0.6 mm}\n"
    messages = {issue["code"]: issue["message"] for issue in planned(workshop, job)[0]["issues"]}
    assert "stacked along (0, 0, 1)" in messages["DIRECTION"] and messages["PROPOSED"].startswith(
        "kind: solid, layers: planes: "
    )


def test_what_stands_on_no_face_gets_planes():
    """The overhang of a ball is its surface steeper than 45 deg, a share of (1 - cos 45 deg) / 2; a
    ball with a flat cut has a base."""
    ball = Part.makeSphere(20)
    proposal = propose(ball, direction=None)
    assert (proposal.kind, proposal.layers) == ("solid", "planes")
    assert "a flat base face, which the part lacks" in proposal.text()
    cut = propose(ball.cut(Part.makeBox(40, 40, 0.5, Vector(-20, -20, -20))))
    assert cut.layers == "geodesic", cut


def test_edges_and_what_has_no_faces_are_curves():
    box, bent = (
        Part.makeBox(9, 9, 9),
        Part.makePolygon([Vector(0, 0, 0), Vector(9, 0, 0), Vector(9, 9, 0)]),
    )
    assert (propose(bent).kind, propose(box, faces=("Edge1", "Edge2")).kind, propose(box).kind) == (
        "curves",
        "curves",
        "solid",
    )


def test_faces_that_are_chosen_are_not_the_whole():
    """For a solid that a bead would not fill, its revolved side has one axis, and two sides of a
    box are a wall. A single clicked face means the whole part, except the cylinder under a fin,
    which is its hub."""
    hub = Part.makeCylinder(25, 80)
    fin = Part.makeBox(24, 30, 30, Vector(10, -15, 20))
    fused = hub.fuse(fin)
    side = next(
        f"Face{k}"
        for k, face in enumerate(fused.Faces, 1)
        if face.Surface.TypeId == "Part::GeomCylinder"
    )
    assert propose(Part.makeCylinder(30, 20), faces=("Face1",)).kind == "revolution"
    assert propose(Part.makeBox(9, 9, 9), faces=("Face1", "Face2")).kind == "surface", (
        "a wall that is about one bead"
    )
    assert propose(Part.makeBox(30, 30, 30), faces=("Face1", "Face2")).kind == "cladding"
    assert (
        propose(
            Part.makeBox(9, 9, 9), Part.makeBox(40, 40, 10, Vector(0, 0, -10)), faces=("Face1",)
        ).kind
        == "surface"
    )
    flat = next(
        f"Face{k}"
        for k, face in enumerate(fused.Faces, 1)
        if face.Surface.TypeId == "Part::GeomPlane"
    )
    kinds = [propose(fused, clicked=clicked).kind for clicked in ((), (flat,), (side,))]
    assert (
        kinds == ["solid", "solid", "developable"]
        and propose(fused, faces=(side,)).kind == "revolution"
    )
    drilled = Part.makeBox(60, 40, 10).cut(Part.makeCylinder(6, 10, Vector(20, 20, 0)))
    bore = next(
        f"Face{k}"
        for k, face in enumerate(drilled.Faces, 1)
        if face.Surface.TypeId == "Part::GeomCylinder"
    )
    assert propose(drilled, clicked=(bore,)).kind == "solid"


@pytest.mark.parametrize("turned", [False, True], ids=["as it is", "with facets turned"])
def test_an_open_mesh_is_a_wall_and_one_with_a_small_hole_is_filled(turned):
    full_mesh = MeshPart.meshFromShape(
        Shape=Part.makeCylinder(20, 60), LinearDeflection=0.2, AngularDeflection=0.2
    )
    points, facets = (np.array(table) for table in full_mesh.Topology)
    high = points[facets][..., 2]
    vase, nick = (
        facets[(high < 59.9).any(axis=1)],
        np.delete(facets, np.flatnonzero((high > 59.9).all(axis=1))[5], axis=0),
    )
    for facets_, kind in ((vase, "surface"), (nick, "solid")):
        if turned:
            facets_ = facets_.copy()
            facets_[: len(facets_) // 3] = facets_[: len(facets_) // 3, ::-1]
        proposal = proposed_for(
            Taken("scan", None, Mesh.Mesh(points[facets_].tolist()), np.eye(4)),
            (),
            None,
            False,
            8.0,
            True,
        )
        assert proposal.kind == kind, proposal
    assert (
        "open mesh" in mesh_of(points[vase]).reason
        and "starts on the platform" in mesh_of(points[vase]).reason
    )


def test_an_open_mesh_that_lies_is_covered_and_one_that_stands_is_a_wall():
    """A shallow cap, and a cup of 30 deg from upright, both without a bottom."""
    cap, cup = (
        Part.makeSphere(60, Vector(), UP, 60, 90, 360).Faces[0],
        Part.makeCone(20, 40, 35).Faces[0],
    )
    kinds = []
    for face in (cap, cup):
        mesh = Mesh.Mesh(face.tessellate(0.2))
        kinds.append(
            [
                proposed_for(Taken("scan", None, mesh, np.eye(4)), (), under, edges, 8.0, True).kind
                for under, edges in (
                    (None, False),
                    (None, True),
                    (Taken("ground", Part.makeBox(9, 9, 9)), False),
                )
            ]
        )
    assert kinds == [["cladding", "surface", "surface"], ["surface", "surface", "surface"]]


def test_an_open_skin_lies_or_stands_as_a_mesh_does(workshop):
    """A cup that is not of revolution starts on its edge without a substrate, the lid above is
    covered, and a rotated cup has no support."""
    lid = Part.makeSphere(60, Vector(), UP, 60, 90, 360).Faces[0].toNurbs()
    squeezed = FreeCAD.Matrix(1, 0, 0, 0, 0, 0.7, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    cup = Part.makeCone(20, 30, 25).Faces[0].toNurbs().transformGeometry(squeezed)
    turned = cup.rotated(Vector(), Vector(1, 0, 0), 20.0)
    proposals = [propose(shape) for shape in (lid.transformGeometry(squeezed), cup, turned)]
    assert [proposal_.kind for proposal_ in proposals] == ["cladding", "surface", "surface"]
    assert [proposal_.stands for proposal_ in proposals] == [
        False,
        True,
        False,
    ] and "starts on the platform" in proposals[1].reason
    cup.exportStep(str(workshop.folder / "part.step"))
    report, rows = planned(workshop, AUTO.replace("0.1 mm", "0.1 mm, end: whole"))
    messages = {issue["code"]: issue["message"] for issue in report["issues"]}
    assert (
        messages["PROPOSED"].startswith("kind: surface: ")
        and "on the platform" in messages["FIRST_LAYER"]
    )
    laid = [dict(zip(rows[0], row)) for row in rows[1:]]
    points = np.array(
        [
            [float(row[key]) for key in ("x_mm", "y_mm", "z_mm")]
            for row in laid
            if row["kind"] == "deposit"
        ]
    )
    assert np.hypot(points[:, 0], points[:, 1] / 0.7) == pytest.approx(
        20.0 + 0.4 * points[:, 2], abs=0.1
    )
    assert (
        points[0, 2] == pytest.approx(0.0, abs=1e-6)
        and len({row["layer"] for row in laid if row["layer"]}) == 6
    )


def open_tube(radius, start, end, sides=24):
    """Return corners (m, 3, 3) of a tube between two points, open at both ends."""
    axis = (end - start) / np.linalg.norm(end - start)
    across = np.linalg.svd(axis[None])[2][1:]
    turn = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[:, None]
    ring = radius * (np.cos(turn) * across[0] + np.sin(turn) * across[1])
    low, high = start + ring, end + ring
    following = np.roll(np.arange(sides), -1)
    return np.concatenate(
        [
            np.stack([low, low[following], high[following]], axis=1),
            np.stack([low, high[following], high], axis=1),
        ]
    )


def test_an_open_mesh_that_cuts_itself_is_filled(workshop):
    """A pot without a lid whose spout crosses its side is no wall: the planner fills the volume
    that the two enclose. Volume and outline equal those of a drum and a rod that OCC fuses."""
    pot = open_tube(25.0, np.zeros(3), np.array([0.0, 0.0, 40.0]))
    spout = open_tube(9.0, np.array([10.0, 0.0, 20.0]), np.array([50.0, 0.0, 30.0]))
    Mesh.Mesh(np.concatenate([pot, spout]).tolist()).write(str(workshop.folder / "part.stl"))
    text = AUTO.replace("part.step", "part.stl")
    report, rows = planned(workshop, text)
    messages = {issue["code"]: issue["message"] for issue in report["issues"]}
    assert (
        messages["PROPOSED"].startswith("kind: solid, layers: planes: ")
        and "with its 4 holes of up to 7" in messages["PROPOSED"]
    )
    assert "4 holes were closed, the largest 70.7 mm across" in messages["MENDED"]
    spout_axis = Vector(40, 0, 10)
    fused = Part.makeCylinder(25, 40).fuse(
        Part.makeCylinder(9, spout_axis.Length, Vector(10, 0, 20), spout_axis)
    )
    assert report["deposit"]["deposited_cm3"] == pytest.approx(fused.Volume / 1000.0, rel=0.04)
    laid = [dict(zip(rows[0], row)) for row in rows[1:]]
    points = np.array(
        [
            [float(row[key]) for key in ("x_mm", "y_mm", "z_mm")]
            for row in laid
            if row["kind"] == "deposit"
        ]
    )
    assert points[:, 0].max() > 45.0 and np.hypot(*points[points[:, 2] > 34.0, :2].T).min() < 4.0, (
        "the spout, the lid"
    )
    outside = [
        fused.distToShape(Part.Vertex(Vector(*point)))[0]
        for point in points[::20]
        if not fused.isInside(Vector(*point), 0.3, True)
    ]
    assert max(outside, default=0.0) < 2.6, (
        "half a layer, by which the ends of a leaning spout differ"
    )
    small = text.replace("chord_error: 0.1 mm", "chord_error: 0.1 mm, mend: 20 mm")
    (workshop.folder / "job.yaml").write_text(small, encoding="utf-8")
    refused = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert refused.status == 2 and "OPEN_MESH" in refused.err, "what the job says of holes counts"


def mesh_of(corners):
    return proposed_for(
        Taken("scan", None, Mesh.Mesh(corners.tolist()), np.eye(4)), (), None, False, 8.0, True
    )


def test_a_mesh_is_filled():
    mesh = MeshPart.meshFromShape(
        Shape=Part.makeBox(20, 20, 20), LinearDeflection=1, AngularDeflection=1
    )
    proposal = proposed_for(Taken("scan", None, mesh, np.eye(4)), (), None, False, 8.0, True)
    assert (proposal.kind, proposal.layers) == (
        "solid",
        "planes",
    ) and "is a mesh" in proposal.reason
    assert isinstance(mesh, Mesh.Mesh)


AUTO = "part: {file: part.step}\nstrategy: {kind: auto, layer_height: 5 mm, chord_error: 0.1 mm}\n"


def planned(workshop, text):
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))
    return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8")), rows


def test_the_job_is_that_of_what_is_proposed(workshop):
    Part.makeCylinder(30, 20).exportStep(str(workshop.folder / "part.step"))
    report, rows = planned(workshop, AUTO)
    (issue,) = [issue for issue in report["issues"] if issue["code"] == "PROPOSED"]
    assert issue["level"] == "note" and issue["message"].startswith("kind: solid, layers: planes: ")
    assert planned(workshop, AUTO.replace("auto", "solid"))[1] == rows
    several = AUTO.replace("part:", "features:\n  - {name: a, part:").replace(
        "part.step}", "part.step}}"
    )
    assert planned(workshop, several)[1] == rows


def test_keys_that_no_family_has_are_refused(tmp_path):
    (tmp_path / "part.step").write_text("")
    path = tmp_path / "job.yaml"
    path.write_text(AUTO.replace("chord_error", "bananas"), encoding="utf-8")
    with pytest.raises(InputError, match="the key 'bananas' is unknown"):
        jobs.read_job(str(path))


def test_where_curved_layers_cannot_be_carried_out_there_are_planes(workshop):
    """Curved layers of a T turn the tool through the robot's singularity; the note says so, and the
    deposit is that of planes. Layers that the job requests stay."""
    tee().exportStep(str(workshop.folder / "part.step"))
    cell = (
        "cell: {machine: abb-irb4600-40-255, setup: tool-on-robot, mount: feature, platform_diameter: 150 mm, "
        "nozzle: {diameter: 12 mm, half_angle: 70, length: 60 mm}}\nprogram: {post: abb}\n"
    )
    coarse = AUTO.replace(
        "layer_height: 5 mm, chord_error: 0.1 mm", "layer_height: 8 mm, chord_error: 0.4 mm"
    )
    text = (
        coarse.replace("auto,", "auto, bead_spacing: 6 mm,")
        + "process: {bead_width: 6 mm}\n"
        + cell
    )
    report, rows = planned(workshop, text)
    (message,) = [issue["message"] for issue in report["issues"] if issue["code"] == "PROPOSED"]
    assert (
        message.startswith("kind: solid, layers: planes: ")
        and "curved layers end with SINGULAR, so planar layers are used" in message
    )
    assert (
        not [issue for issue in report["issues"] if issue["level"] == "error"]
        and report["programs"]
    )
    assert rows == planned(workshop, text.replace("auto,", "solid, layers: planes,"))[1]
    (workshop.folder / "job.yaml").write_text(
        text.replace("auto,", "auto, layers: geodesic,"), encoding="utf-8"
    )
    refused = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert refused.status == 3 and "SINGULAR" in refused.err
