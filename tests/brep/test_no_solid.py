# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes without solids, and damaged ones: the message states where they are open and the
remedy."""

import Part
import pytest

from freecad_am.brep.files.read import read_shape
from freecad_am.brep.hub import bodies_of
from freecad_am.brep.kernel import limits
from freecad_am.brep.walls.sheet import substrate_of
from freecad_am.core.issues import InputError


def loose_faces():
    """Return the six faces of a box at (10, 20, 30), none of which shares an edge with another."""
    box = Part.makeBox(4, 6, 8)
    box.translate((10, 20, 30))
    return Part.makeCompound([face.copy() for face in box.Faces])


def refused(shape):
    with pytest.raises(InputError) as caught:
        bodies_of(shape, "Box", 0.05, 0.0)
    with pytest.raises(InputError) as of_substrate:
        substrate_of(shape, "Box")
    assert caught.value.code == of_substrate.value.code == "NO_SOLID"
    messages = [str(error.value.message).rsplit("choose", 1)[0] for error in (caught, of_substrate)]
    assert messages[0] == messages[1]
    return messages[0]


def test_faces_of_an_iges_file_that_are_not_joined_are_to_be_sewn(tmp_path):
    path = tmp_path / "loose.igs"
    loose_faces().exportIges(str(path))
    shape = read_shape(path)
    assert len(shape.Faces) == 6 and not shape.Solids
    message = refused(shape)
    assert "6 open face(s)" in message and "Shell from faces, then Solid from shell" in message
    sewn = Part.Solid(Part.Shell(shape.Faces))  # the remedy of the message
    (body,) = bodies_of(sewn, "Box", 0.05, 0.0).bodies
    assert len(body.triangles) == 12


def test_a_shell_with_a_hole_is_told_with_the_place_of_an_open_edge():
    box = Part.makeBox(4, 6, 8)
    message = refused(Part.Shell(box.Faces[:5]))  # without the face on top
    assert "5 open face(s)" in message and ", 8) of Face" in message


def test_a_closed_shell_is_to_be_converted():
    assert "Part, Convert to solid" in refused(Part.makeBox(4, 6, 8).Shells[0])
    assert "closed shell" not in refused(Part.makePlane(10, 10))


def test_what_the_kernel_cannot_do_is_told_with_its_place():
    box = Part.makeBox(4, 6, 8)
    with pytest.raises(InputError) as caught, limits.reported("Box", box):
        Part.makeCircle(-1.0)
    assert caught.value.code == "BAD_SHAPE"
    assert "all 6 face(s), about (2, 3, 4), are valid" in caught.value.message


def test_a_damaged_face_is_named_with_its_place():
    bow_tie = Part.makePolygon([(0, 0, 5), (8, 0, 5), (0, 8, 5), (8, 8, 5), (0, 0, 5)])
    damaged = Part.Face(Part.makePlane(9, 9).Surface, bow_tie)
    shape = Part.makeCompound([Part.makePlane(2, 2), damaged])
    with pytest.raises(InputError) as caught, limits.reported("Bow", shape):
        Part.makeCircle(-1.0)
    assert "Face2 at (4, 4, 5) is damaged" in caught.value.message
