# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of solids whose faces have small gaps, as other systems' kernels export them."""

import Part
import pytest

from freecad_am.brep.revolution.wall import find_wall


def tube_with_gaps(gap):
    """Return a thick tube whose inner cylinder is a gap wider than its shared edges with the ends,
    as other kernels write it within their tolerance."""
    tube = Part.makeCylinder(50, 30).cut(Part.makeCylinder(40, 30))
    curves, surfaces = tube.exportBrepToString().split("\nSurfaces ")
    old_radius = [
        line for line in surfaces.splitlines() if line.startswith("2 ") and line.endswith(" 40")
    ]
    assert len(old_radius) == 1
    shape = Part.Shape()
    shape.importBrepFromString(
        f"{curves}\nSurfaces {surfaces.replace(old_radius[0], f'{old_radius[0][:-2]}{40 + gap}')}"
    )
    assert len(shape.Solids) == 1 and shape.Shells[0].isClosed()
    return shape


@pytest.mark.parametrize("wall, radius", [("outer", 50.0), ("inner", 40.0), ("middle", 45.0)])
def test_the_contour_of_a_solid_is_closed_across_a_gap_of_its_faces(wall, radius):
    wall_found = find_wall(tube_with_gaps(5e-4), wall=wall)
    assert wall_found.meridian.points[:, 0] == pytest.approx(radius, abs=3e-3)
    assert wall_found.meridian.length == pytest.approx(30.0, abs=3e-3)
    assert [issue.message for issue in wall_found.issues if issue.code == "GAP"] == [
        "a gap of 0.0005 mm between faces of part is bridged"
    ]
