# SPDX-License-Identifier: LGPL-2.1-or-later
"""Helical beads on shafts and bores, measured by formulas of cylinders, cones and arcs."""

import math

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError

SPACING, HEIGHT, CHORD = 4.0, 2.0, 0.02  # mm
RADIUS, LENGTH = 20.0, 50.0  # mm, of the shaft


def add_shape(doc, shape):
    source = doc.addObject("Part::Feature", "Source")
    source.Shape = shape
    return source


def face_names(shape, chosen):
    return [f"Face{k}" for k, face in enumerate(shape.Faces, 1) if chosen(face)]


def is_round(face):
    return face.Surface.TypeId != "Part::GeomPlane"


def clad(doc, shape, faces, **settings):
    """Return the toolpath of a helix on faces of a shape, and its object."""
    settings = {"layers": 1, "clearance": "none", **settings}
    feature = api.make_cladding_feature(
        doc,
        add_shape(doc, shape),
        faces,
        pattern="helix",
        layer_height=HEIGHT,
        bead_spacing=SPACING,
        chord_error=CHORD,
        **settings,
    )
    toolpath = api.make_toolpath(doc, feature)
    return api.result(toolpath), toolpath


def cylindrical(points):
    """Return radius, unwrapped azimuth and height of points (n, 3) about Z."""
    azimuth = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    return np.hypot(points[:, 0], points[:, 1]), azimuth, points[:, 2]


def test_a_shaft_gets_one_bead_a_layer_with_whole_turns(doc):
    shape = Part.makeCylinder(RADIUS, LENGTH)
    path, _ = clad(doc, shape, face_names(shape, is_round), layers=3)
    turns = math.ceil((LENGTH - SPACING) / SPACING)
    for number, layer in enumerate(path.layers):
        (bead,) = layer.beads
        radius, azimuth, height = cylindrical(bead.points)
        np.testing.assert_allclose(radius, RADIUS + number * HEIGHT, atol=1e-9)
        np.testing.assert_allclose(bead.tool[:, 2], 0.0, atol=1e-9)
        assert azimuth[-1] - azimuth[0] == pytest.approx(2.0 * math.pi * (2 + turns), abs=1e-9)
        low, high = 0.5 * SPACING, LENGTH - 0.5 * SPACING
        passed = (azimuth - azimuth[0]) / (2.0 * math.pi)
        due = np.interp(passed, [0.0, 1.0, 1.0 + turns, 2.0 + turns], [low, low, high, high])
        np.testing.assert_allclose(height, LENGTH - due if number % 2 else due, atol=1e-9)


def test_chords_keep_the_chord_error(doc):
    shape = Part.makeCylinder(RADIUS, LENGTH)
    path, _ = clad(doc, shape, face_names(shape, is_round))
    points = path.layers[0].beads[0].points
    middle = 0.5 * (points[1:] + points[:-1])
    assert RADIUS - np.hypot(middle[:, 0], middle[:, 1]).min() <= CHORD


def test_layers_in_a_bore_grow_towards_its_axis(doc):
    shape = Part.makeCylinder(40, LENGTH).cut(Part.makeCylinder(25, LENGTH))
    bore = face_names(shape, lambda face: is_round(face) and face.Surface.Radius == 25)
    path, _ = clad(doc, shape, bore, layers=2)
    for number, layer in enumerate(path.layers):
        radius, _, _ = cylindrical(layer.beads[0].points)
        np.testing.assert_allclose(radius, 25.0 - number * HEIGHT, atol=1e-9)
        assert (layer.beads[0].tool * layer.beads[0].points)[:, :2].sum(axis=1).max() < 0.0
    with pytest.raises(InputError) as caught:
        clad(doc, shape, bore, layers=14)
    assert (caught.value.code, caught.value.where) == ("FOLDED", "strategy.layers")


def turned_shaft():
    """A cylinder that runs smoothly into a flange by a quarter of a circle."""
    profile = Part.Wire(
        [
            Part.makeLine(App.Vector(20, 0, 0), App.Vector(20, 0, 30)),
            Part.Arc(
                App.Vector(20, 0, 30),
                App.Vector(30 - math.sqrt(50), 0, 30 + math.sqrt(50)),
                App.Vector(30, 0, 40),
            ).toShape(),
        ]
    )
    return profile.revolve(App.Vector(), App.Vector(0, 0, 1), 360)


def meridian_arc(radius, height):
    """Return the arc length (n,) along the profile of the turned shaft."""
    angle = np.arctan2(height - 30.0, 30.0 - radius)
    return np.where(height <= 30.0, height, 30.0 + 10.0 * angle)


def test_the_pitch_is_measured_along_the_profile(doc):
    shape = turned_shaft()
    path, _ = clad(doc, shape, [f"Face{k}" for k in range(1, len(shape.Faces) + 1)])
    radius, azimuth, height = cylindrical(path.layers[0].beads[0].points)
    length = 30.0 + 10.0 * math.pi / 2.0
    turns = math.ceil((length - SPACING) / SPACING)
    passed = (azimuth - azimuth[0]) / (2.0 * math.pi)
    due = np.interp(
        passed,
        [0.0, 1.0, 1.0 + turns, 2.0 + turns],
        [2.0, 2.0, length - 2.0, length - 2.0],
    )
    np.testing.assert_allclose(meridian_arc(radius, height), due, atol=2e-3)
    on_arc = height > 30.0
    np.testing.assert_allclose(np.hypot(radius - 30, height - 30)[on_arc], 10.0, atol=1e-6)


def test_a_moved_shaft_has_the_same_bead(doc):
    placement = App.Placement(App.Vector(100, -40, 30), App.Rotation(App.Vector(1, 2, 0.5), 70))
    moved = turned_shaft()
    moved.Placement = placement
    names = [f"Face{k}" for k in range(1, len(moved.Faces) + 1)]
    path, _ = clad(doc, turned_shaft(), names)
    moved_path, _ = clad(doc, moved, names)
    back = np.array(placement.inverse().Matrix.A).reshape(4, 4)
    points = moved_path.layers[0].beads[0].points @ back[:3, :3].T + back[:3, 3]
    radius, azimuth, height = cylindrical(points)
    expected_radius, expected_azimuth, expected_height = cylindrical(path.layers[0].beads[0].points)
    if height[0] > 20.0:  # the axis may point the other way, and the bead starts at the other end
        radius, azimuth, height = (column[::-1] for column in (radius, azimuth, height))
    passed = np.abs(azimuth - azimuth[0])
    expected = np.abs(expected_azimuth - expected_azimuth[0])
    np.testing.assert_allclose(passed[-1], expected[-1], atol=1e-6)
    np.testing.assert_allclose(np.interp(expected, passed, height), expected_height, atol=CHORD)
    np.testing.assert_allclose(np.interp(expected, passed, radius), expected_radius, atol=CHORD)


def test_the_cover_of_a_shaft_is_its_area(doc):
    shape = Part.makeCylinder(RADIUS, LENGTH)
    path, toolpath = clad(doc, shape, face_names(shape, is_round))
    volume, missed, stray = path.checks.volumes
    assert volume == pytest.approx(2.0 * math.pi * RADIUS * LENGTH * HEIGHT, rel=1e-6)
    assert missed == pytest.approx(0.0, abs=1e-6 * volume)
    assert stray == pytest.approx(0.0, abs=1e-6 * volume)
    length = path.layers[0].beads[0].length
    (note,) = [issue for issue in api.issues(toolpath) if issue.code == "DEPOSITED_TWICE"]
    twice = HEIGHT * (SPACING * length - 2.0 * math.pi * RADIUS * LENGTH)
    assert f"about {1e-3 * twice:.3g} cm3" in note.message


def test_a_collar_narrower_than_a_bead_gets_one_turn(doc):
    shape = Part.makeCylinder(RADIUS, 3.0)
    path, _ = clad(doc, shape, face_names(shape, is_round))
    _, azimuth, height = cylindrical(path.layers[0].beads[0].points)
    assert azimuth[-1] - azimuth[0] == pytest.approx(2.0 * math.pi)
    np.testing.assert_allclose(height, 1.5, atol=1e-9)


@pytest.mark.parametrize(
    ("shape", "text"),
    [
        (Part.makeBox(20, 20, 20), "1 border loop(s)"),
        (Part.makeCylinder(20, 30, App.Vector(), App.Vector(0, 0, 1), 180), "1 border loop(s)"),
        (
            Part.makeCylinder(20, 60).cut(
                Part.makeBox(100, 100, 50, App.Vector(-50, -50, 40), App.Vector(1, 0, 2))
            ),
            "rims that are not circles",
        ),
        (Part.makeBox(20, 20, 20).Shells[0], "1 border loop(s)"),
    ],
    ids=["plane", "half cylinder", "oblique end", "shell"],
)
def test_faces_without_a_round_axis_are_rejected(doc, shape, text):
    with pytest.raises(InputError) as caught:
        clad(doc, shape, face_names(shape, is_round)[:1] or ["Face1"])
    assert caught.value.code == "NOT_REVOLVED" and text in caught.value.message


@pytest.mark.parametrize("setting", [{"deflection": 10.0}, {"fill_density": 50.0}])
def test_settings_of_fills_are_rejected(doc, setting):
    shape = Part.makeCylinder(RADIUS, LENGTH)
    with pytest.raises(InputError) as caught:
        clad(doc, shape, face_names(shape, is_round), **setting)
    assert caught.value.code == "NOT_FOR_FAMILY"
    assert caught.value.where == f"strategy.{next(iter(setting))}"
