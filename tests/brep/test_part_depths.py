# SPDX-License-Identifier: LGPL-2.1-or-later
"""The share of a part that one bead deposits equals the volumes that the geometry kernel computes
from cut and fused solids."""

import math
import tracemalloc

import FreeCAD  # noqa: F401  before Part, which crashes without
import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.revolution.wall import find_wall
from freecad_am.brep.shapes.part_depths import face_depths, revolved_depths
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import InputError
from freecad_am.core.process.deposit import balance as deposit_balance

pytestmark = pytest.mark.any_version

Z = Vector(0, 0, 1)
WIDTH = 8.0


def revolve_profile(*points, angle=360):
    corners = [Vector(r, 0, h) for r, h in points]
    return Part.Face(Part.makePolygon([*corners, corners[0]])).revolve(Vector(), Z, angle)


def tube(outer, inner, height=40.0):
    return Part.makeCylinder(outer, height).cut(Part.makeCylinder(inner, height))


def bowl():
    """Return a bowl with a floor of 4 mm, a wall of 4.7 mm and a rounded outer edge."""
    solid = Part.makeCylinder(40, 40).cut(Part.makeCylinder(35.3, 36, Vector(0, 0, 4)))
    edge = next(e for e in solid.Edges if e.BoundBox.ZMax < 1e-6 and e.Length > 200)
    return solid.makeFillet(6.0, [edge])


def bracket():
    """Return two plates and the bend between them, three solids that touch."""
    bend = Part.makeCylinder(15, 50, Vector(), Z, 90).cut(
        Part.makeCylinder(10, 50, Vector(), Z, 90)
    )
    return Part.Compound(
        [
            Part.makeBox(60, 5, 50, Vector(-60, 10, 0)),
            bend,
            Part.makeBox(5, 60, 50, Vector(10, -60, 0)),
        ]
    )


def balance(shape, wall="outer", width=WIDTH, faces=()):
    wall_found = find_wall(shape, faces, wall)
    return deposit_balance.wall_balance(revolved_depths(shape, wall_found, "Part"), width)


def codes(result):
    return [issue.code for issue in deposit_balance.issues(result)]


SOLID = {
    # shape, and its volume within a bead of the outer wall
    "cylinder": (lambda: Part.makeCylinder(30, 40), lambda: tube(30, 22)),
    "ball": (
        lambda: Part.makeSphere(45, Vector(), Z, 0, 90, 360),
        lambda: Part.makeSphere(45, Vector(), Z, 0, 90, 360).cut(Part.makeSphere(37)),
    ),
    "thick tube": (lambda: tube(60, 40), lambda: tube(60, 52)),
    "quarter": (
        lambda: Part.makeCylinder(30, 40, Vector(), Z, 90),
        lambda: tube(30, 22).common(Part.makeBox(40, 40, 40)),
    ),
    "cone": (
        lambda: Part.makeCone(60, 30, 60),
        lambda: revolve_profile(
            (60, 0), (30, 60), (30 - WIDTH * math.sqrt(1.25), 60), (60 - WIDTH * math.sqrt(1.25), 0)
        ),
    ),
}


@pytest.mark.parametrize("name", SOLID)
def test_a_solid_laid_as_a_skin_is_told_with_what_of_it_is_missing(name):
    shape, within = (make() for make in SOLID[name])
    result = balance(shape)
    assert result.part_volume == pytest.approx(shape.Volume, rel=1e-9)
    assert result.part_volume - result.left_out == pytest.approx(within.Volume, rel=0.04)
    assert codes(result) == ["NOT_DEPOSITED"] and result.outside == 0.0


@pytest.mark.parametrize(
    "wall, shape",
    [
        ("outer", lambda: tube(30, 22)),
        ("inner", lambda: tube(30, 22)),
        ("middle", lambda: tube(30, 22)),
        ("outer", lambda: tube(30, 21)),
        ("outer", lambda: tube(30, 23.2)),
        ("outer", lambda: tube(10, 2)),
        ("outer", lambda: revolve_profile((60, 0), (30, 60), (38, 60), (68, 0), angle=120)),
        ("outer", lambda: Part.makeSphere(45, Vector(), Z, 0, 90, 360).cut(Part.makeSphere(37))),
    ],
)
def test_a_wall_about_as_thick_as_a_bead_is_no_news(wall, shape):
    result = balance(shape(), wall)
    assert codes(result) == [] and result.left_out == result.outside == 0.0 and result.faces == ()


def test_a_sheet_has_no_volume_and_its_other_faces_are_named():
    sheet = Part.makeShell(
        [face for face in bowl().Faces if face.Surface.TypeId != "Part::GeomPlane"][:2]
    )
    names = [f"Face{k + 1}" for k, face in enumerate(sheet.Faces)]
    assert codes(balance(sheet)) == []
    result = balance(sheet, faces=names[:1])
    assert (
        result.part_volume is None
        and result.faces == tuple(names[1:])
        and codes(result) == ["NOT_DEPOSITED"]
    )


def test_a_bowl_has_its_floor_left_out_and_a_bead_thicker_than_its_wall():
    shape = bowl()
    result = balance(shape)
    floor = {
        f"Face{k + 1}"
        for k, face in enumerate(shape.Faces)
        if face.Surface.TypeId == "Part::GeomPlane"
        and face.BoundBox.ZMax < 5
        and face.BoundBox.XMax > 30
    }
    assert set(result.faces) == floor and codes(result) == ["NOT_DEPOSITED", "DEPOSITED_BESIDE"]
    # all within 8 mm of the outer wall: the wall, and a ring of the floor
    ring = Part.makeCylinder(40, 40).cut(Part.makeCylinder(32, 40))
    low = revolve_profile(
        (28, 0), (34, 0), (40, 6), (40, 8), (28, 8)
    )  # under the rounded edge the bead reaches further in
    at_most, at_least = shape.common(ring.fuse(low)).Volume, shape.common(ring).Volume
    assert 0.98 * at_least < result.part_volume - result.left_out < 1.02 * at_most
    assert result.outside == pytest.approx(result.beads * (1 - 4.7 / WIDTH), rel=0.1)
    texts = [issue.message for issue in deposit_balance.issues(result)]
    assert all(name in texts[0] for name in floor) and "4.7 mm thick" in texts[1]


@pytest.mark.parametrize(
    "radius, height, width",
    [(6000.0, 2.0, 8.0), (5000.0, 10000.0, 8.0), (0.05, 0.1, 0.02), (1.0, 3000.0, 8.0)],
)
def test_parts_of_any_size_take_little_memory(radius, height, width):
    shape = Part.makeCylinder(radius, height)
    wall_found = find_wall(shape)
    tracemalloc.start()
    try:
        depths = revolved_depths(shape, wall_found, "Part")
        assert tracemalloc.get_traced_memory()[1] < 100e6
    finally:
        tracemalloc.stop()
    missing_share = deposit_balance.wall_balance(depths, width).left_out / shape.Volume
    assert missing_share == pytest.approx(max(1.0 - width / radius, 0.0) ** 2, abs=0.02)


def test_what_lies_in_the_substrate_does_not_count():
    shape = Part.makeCylinder(30, 40)
    skin = [
        f"Face{k + 1}"
        for k, face in enumerate(shape.Faces)
        if face.Surface.TypeId == "Part::GeomCylinder"
    ]
    points, corners = Part.makeBox(100, 100, 10, Vector(-50, -50, 0)).tessellate(0.1)
    ground = Body("Plate", np.array([tuple(p) for p in points]), np.array(corners, dtype=np.int64))
    result = deposit_balance.wall_balance(face_depths(shape, skin, "Part", ground), WIDTH)
    assert result.part_volume == pytest.approx(0.75 * shape.Volume, rel=0.03)
    assert result.part_volume - result.left_out == pytest.approx(
        tube(30, 22, 30.0).Volume, rel=0.05
    )


def test_of_solids_that_touch_the_one_of_revolution_is_not_taken_for_all():
    shape = bracket()
    with pytest.raises(InputError) as caught:
        find_wall(shape)
    assert caught.value.code == "NOT_OF_REVOLUTION" and "Solid2" in caught.value.message
    bend = [
        f"Face{k + 1}"
        for k, face in enumerate(shape.Faces)
        if any(face.isSame(bend_face) for bend_face in shape.Solids[1].Faces)
    ]
    result = balance(shape, faces=bend)  # on purpose
    assert [name for name, _ in result.solids] == ["Solid1", "Solid3"]
    assert result.left_out == pytest.approx(30_000.0, rel=0.05)
    assert "2 solid(s) (Solid1, Solid3)" in deposit_balance.issues(result)[0].message


def test_the_one_solid_of_revolution_that_is_most_of_a_part_is_taken_and_the_rest_told():
    shape = Part.Compound([tube(30, 22), Part.makeBox(10, 10, 10, Vector(40, 0, 0))])
    result = balance(shape)
    assert [name for name, _ in result.solids] == ["Solid2"] and result.left_out == pytest.approx(
        1000.0, rel=0.3
    )
    assert codes(result) == ["NOT_DEPOSITED"]


def test_a_solid_left_aside_is_told_however_small():
    shape = Part.Compound([tube(30, 22), Part.makeBox(5, 5, 5, Vector(40, 0, 0))])
    result = balance(shape)
    assert result.left_out < deposit_balance.NEGLIGIBLE * result.part_volume
    assert "1 solid(s) (Solid2)" in deposit_balance.issues(result)[0].message and codes(result) == [
        "NOT_DEPOSITED"
    ]


@pytest.mark.parametrize("thick", [2.0, 5.09])
def test_the_thickness_of_a_wall_is_that_of_its_shape_not_of_its_triangles(thick):
    """Triangles are inside of a curved outer face and inside of the hole, which once made walls
    0.05 mm too thick."""
    shell = Part.makeSphere(40, Vector(), Z, 0, 90, 360).cut(Part.makeSphere(40 - thick))
    for shape in (tube(30, 30 - thick), shell):
        result = balance(shape)
        assert abs(result.thick - thick) < 0.01
        (thickness_issue,) = [
            issue for issue in deposit_balance.issues(result) if "mm thick" in issue.message
        ]
        assert f"which is {thick:.2g} mm thick" in thickness_issue.message
