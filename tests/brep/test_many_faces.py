# SPDX-License-Identifier: LGPL-2.1-or-later
"""For parts of hundreds of faces, memory and kernel calls grow no faster than the number of
faces."""

import math
import tracemalloc

import FreeCAD  # noqa: F401  before Part, which crashes without
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.revolution import axis
from freecad_am.brep.revolution import wall as revolution
from freecad_am.brep.revolution.wall import find_wall
from freecad_am.core.issues import InputError

TEETH, RINGS = 250, 300


def gear():
    corners = [
        Vector(radius * math.cos(angle), radius * math.sin(angle), 0)
        for tooth in range(TEETH)
        for quarter, radius in enumerate((50, 50, 54, 54))
        for angle in [2.0 * math.pi * (tooth + quarter / 4) / TEETH]
    ]
    outline = Part.makePolygon([*corners, corners[0]])
    return Part.Face(outline).extrude(Vector(0, 0, 10)).cut(Part.makeCylinder(10, 10))


def ribbed():
    profile = [Vector(40 + 3 * math.sin(0.3 * k), 0, 0.5 * k) for k in range(RINGS + 1)]
    return Part.makePolygon(profile).revolve(Vector(), Vector(0, 0, 1), 360)


def perforated():
    holes = [
        Part.makeCylinder(3, 5, Vector(10 + 10 * k, 10 + 10 * j, 0))
        for k in range(12)
        for j in range(12)
    ]
    return Part.makeBox(130, 130, 5).cut(Part.Compound(holes))


@pytest.fixture
def looks(monkeypatch):
    """Record the faces that the search examines closely."""
    faces_seen = []
    real = revolution.patch_of
    monkeypatch.setattr(
        revolution,
        "patch_of",
        lambda face, *arguments: (faces_seen.append(face), real(face, *arguments))[1],
    )
    return faces_seen


def peak_of(work):
    """Return the peak of bytes in arrays and objects."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("make", [gear, perforated])
@pytest.mark.always("perforated")
def test_a_thousand_faces_that_are_not_of_revolution_are_soon_refused(make, looks):
    shape = make()

    def refused():
        with pytest.raises(InputError) as caught:
            find_wall(shape)
        assert caught.value.code == "NOT_REVOLUTION"

    assert peak_of(refused) < 100e6
    assert len(looks) < len(shape.Faces)


@pytest.mark.any_version
def test_hundreds_of_rings_are_one_wall(looks):
    wall = find_wall(ribbed())
    steps = [
        math.hypot(3 * (math.sin(0.3 * k + 0.3) - math.sin(0.3 * k)), 0.5) for k in range(RINGS)
    ]
    assert len(wall.faces) == RINGS == len(looks)
    assert wall.meridian.length == pytest.approx(math.fsum(steps), rel=1e-9)


def test_the_axis_of_each_hole_is_found_once():
    axes = axis._weighed(list(perforated().Faces))
    axis_positions = {(round(point[0]), round(point[1])) for (point, _), _ in axes}
    assert len(axes) == 144 and axis_positions == {
        (10 + 10 * k, 10 + 10 * j) for k in range(12) for j in range(12)
    }
