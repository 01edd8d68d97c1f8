# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of solids whose faces miss each other a little, as those of other makers' kernels do."""

import Part
import pytest

from freecad_am.brep.revolution.wall import find_wall


def tube_with_gaps(gap):
    """A thick tube whose inner cylinder is a gap wider than the edges that it shares with the ends, as kernels of other
    makers write it within their tolerance."""
    tube = Part.makeCylinder(50, 30).cut(Part.makeCylinder(40, 30))
    curves, surfaces = tube.exportBrepToString().split("\nSurfaces ")
    before = [
        line for line in surfaces.splitlines() if line.startswith("2 ") and line.endswith(" 40")
    ]
    assert len(before) == 1
    made = Part.Shape()
    made.importBrepFromString(
        f"{curves}\nSurfaces {surfaces.replace(before[0], f'{before[0][:-2]}{40 + gap}')}"
    )
    assert len(made.Solids) == 1 and made.Shells[0].isClosed()
    return made


@pytest.mark.parametrize("wall, radius", [("outer", 50.0), ("inner", 40.0), ("middle", 45.0)])
def test_the_contour_of_a_solid_is_closed_across_a_gap_of_its_faces(wall, radius):
    found = find_wall(tube_with_gaps(5e-4), wall=wall)
    assert found.meridian.points[:, 0] == pytest.approx(radius, abs=3e-3)
    assert found.meridian.length == pytest.approx(30.0, abs=3e-3)
    assert [issue.message for issue in found.issues if issue.code == "GAP"] == [
        "a gap of 0.0005 mm between faces of part is bridged"
    ]
