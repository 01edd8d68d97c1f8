# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls whose curvature jumps between faces: all points satisfy their equations, and a moved wall
gives the same beads."""

import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from freecad_am.brep.walls.wall_on import wall_on
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.strategies.walls import fronts as wall_fronts

pytestmark = pytest.mark.any_version

LENGTH_MM, WIDTH_MM, ROUNDING_MM, HEIGHT_MM = 26.0, 20.0, 6.0, 3.0


def off_rounded_box(points):
    """Return distances (n,) from the sides of the box with rounded edges."""
    out = np.abs(points[:, :2]) - np.array(
        [0.5 * LENGTH_MM - ROUNDING_MM, 0.5 * WIDTH_MM - ROUNDING_MM]
    )
    return np.abs(
        np.where(
            (out > 0.0).all(axis=1),
            np.linalg.norm(out, axis=1) - ROUNDING_MM,
            out.max(axis=1) - ROUNDING_MM,
        )
    )


@pytest.fixture(scope="module")
def rounded_box():
    box = Part.makeBox(LENGTH_MM, WIDTH_MM, 12, Vector(-0.5 * LENGTH_MM, -0.5 * WIDTH_MM, -2))
    box = box.makeFillet(
        ROUNDING_MM, [edge for edge in box.Edges if abs(edge.tangentAt(0).z) > 0.99]
    )
    sides = [f"Face{k}" for k, face in enumerate(box.Faces, 1) if abs(face.normalAt(0, 0).z) < 0.5]
    assert len(sides) == 8
    return wall_on(box, sides, Part.makeBox(60, 60, 10, Vector(-30, -30, -10)), HEIGHT_MM)


def test_first_curve_and_fronts_lie_on_flats_and_roundings_between_their_nodes_too(rounded_box):
    wall = rounded_box
    first_curve = wall.first[0].curve()
    points = first_curve.at(first_curve.refined(11))[0]
    assert off_rounded_box(points).max() < 2e-5 and np.abs(points[:, 2]).max() < 1e-9
    note = next(issue for issue in wall.issues if issue.code == "FIRST_LAYER")
    assert off_rounded_box(points).max() < 2e-5 and note.message.endswith(" within 0.001 mm")
    layers = fronts.slice_layers(wall, HEIGHT_MM).fronts
    assert len(layers) == 4
    for index, layer in enumerate(layers):
        for front in layer:
            points = front.at(front.refined(11))[0]
            assert off_rounded_box(points).max() < 1e-4
            assert points[:, 2] == pytest.approx(index * HEIGHT_MM, abs=1e-4)


def test_beads_and_what_they_outline_lie_on_the_wall(rounded_box):
    plan = wall_fronts.plan(
        rounded_box,
        SurfaceParameters(layer_height=HEIGHT_MM),
        BuildDirectionParameters(),
        ProcessParameters(),
    )
    for layer, _, bead in plan:
        assert off_rounded_box(bead.points).max() < 1e-9
        assert bead.points[:, 2] == pytest.approx(layer * HEIGHT_MM, abs=1e-4)
        segment = np.repeat(np.arange(len(bead.points) - 1), 7)  # where programs add points
        drawn, _ = bead.outline.at(segment, np.tile(np.arange(1, 8) / 8.0, len(bead.points) - 1))
        assert off_rounded_box(drawn).max() < 1e-4


def test_a_wall_moved_and_turned_gives_the_same_beads():
    """The fronts of an elbow meet: their gaps are closed by depth, wherever the wall is."""
    low = Part.makeCylinder(12, 8, Vector(0, 0, -5)).Faces[0]
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius, torus.Center, torus.Axis = (
        24,
        12,
        Vector(-24, 0, 3),
        Vector(0, -1, 0),
    )
    elbow = torus.toShape(0.0, np.radians(70.0), 0.0, 2.0 * np.pi).Faces[0]
    compound = Part.Compound([low, elbow])
    block = Part.makeBox(60, 60, 20, Vector(-30, -30, -20))
    plans = []
    for move in (Placement(), Placement(Vector(50, -30, 20), Rotation(Vector(1, 2, 3), 137))):
        wall, ground = compound.copy(), block.copy()
        wall.Placement, ground.Placement = move, move
        sliced = fronts.slice_layers(wall_on(wall, [], ground, 4.0), 4.0)
        plans.append(sliced)
    assert any(plans[0].closing)
    for kind in ("fronts", "closing"):
        lengths = [
            [sorted(curve.length for curve in layer) for layer in getattr(plan, kind)]
            for plan in plans
        ]
        assert list(map(len, lengths[0])) == list(map(len, lengths[1]))
        for length, moved_length in zip(*lengths, strict=True):
            assert length == pytest.approx(moved_length, rel=0.02, abs=0.02)
