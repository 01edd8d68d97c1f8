# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which base a solid stands on, and its layers where facets lie in the surface that cuts."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.on_hub import Base, Seat, middle_azimuth, upright
from freecad_am.core.geometry.surroundings import Body
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.equidistant import Facets
from freecad_am.core.slicing.laid_flat import count, cut, opened
from freecad_am.core.slicing.standing import hub_among, on_hub

LOWER = Base("Face1", Developable(50.0), np.eye(4))
UPPER = Base("Face2", Developable(30.0), upright(np.array([0.0, 0.0, 100.0]), np.array([0.0, 0.0, 1.0])))
SEATS = [Seat(LOWER, 0.0, 100.0), Seat(UPPER, 0.0, 80.0)]


def sector(inner, outer, low, high, start=-0.3, end=0.3, steps=12, name="blade"):
    """A piece of a ring, its foot exactly on the cylinder of radius `inner`."""
    angle = np.linspace(start, end, steps + 1)
    rows = [np.stack([r * np.cos(angle), r * np.sin(angle), np.full(steps + 1, z)], axis=1)
            for r, z in ((inner, low), (outer, low), (outer, high), (inner, high))]
    n = steps + 1
    faces = [(0, n, 2 * n), (0, 2 * n, 3 * n), (n - 1, 3 * n - 1, 2 * n - 1), (n - 1, 4 * n - 1, 3 * n - 1)]
    for k in range(4):
        for j in range(steps):
            a, b, c, d = k * n + j, k * n + j + 1, (k + 1) % 4 * n + j, (k + 1) % 4 * n + j + 1
            faces += [(a, b, d), (a, d, c)]
    return Body(name, np.vstack(rows), np.array(faces, dtype=np.int64))


def test_a_solid_stands_where_its_contour_is_longest():
    low, high = sector(50.0, 70.0, 20.0, 60.0, name="low"), sector(30.0, 60.0, 110.0, 160.0, name="high")
    through = sector(20.0, 70.0, 90.0, 160.0, 1.0, 1.6, name="both")  # 10 mm of the lower, 60 of the upper, reaching in
    found = on_hub([high, low, through], SEATS, 0.01, "part")
    assert [[body.name for body in group.bodies] for group in found.groups] == [["low"], ["high", "both"]]
    assert [group.base.name for group in found.groups] == ["Face1", "Face2"]


def test_a_foot_that_lies_on_the_hub_is_cut_whole():
    """Its vertices are on the cylinder but for their last digits, its chords inside."""
    for lift in (0.0, 1e-9, -1e-9, 0.03):
        body = sector(50.0 + lift, 70.0, 20.0, 60.0)
        facets = Facets(LOWER.surface, body.vertices, body.triangles)
        loops = cut(facets, 0.0, 0.01)
        assert len(loops) == 1
        assert np.abs(LOWER.surface.distance(loops[0].points)).max() < 1e-9
        flat = opened(LOWER.surface, loops, 0.0, "here").loops[0]
        area = 0.5 * (flat[:, 0] * np.roll(flat[:, 1], -1) - np.roll(flat[:, 0], -1) * flat[:, 1]).sum()
        assert area == pytest.approx(50.0 * 0.6 * 40.0, rel=1e-3)


def test_there_are_as_many_layers_as_fit():
    body = sector(50.0, 70.0, 20.0, 60.0)
    facets = Facets(LOWER.surface, body.vertices, body.triangles)
    assert count(facets, 2.0, 0.0, 0.01) == 10  # the eleventh would lie on the outer face, with nothing above it
    assert count(facets, 3.0, 0.0, 0.01) == 7
    assert count(facets, 2.0, 5.0, 0.01) == 13


def test_solids_beside_the_hub_are_refused():
    for body, words in (
        (sector(60.0, 70.0, 20.0, 60.0), "10 mm outside of Face1"), (sector(20.0, 40.0, 20.0, 60.0), "inside of the hub"),
        (sector(20.0, 40.0, 200.0, 220.0), "beside the face"),
    ):
        seats = SEATS[:1] if "inside" in words else SEATS
        with pytest.raises(InputError) as caught:
            on_hub([body], seats, 0.01, "part")
        assert caught.value.code == "NOT_ON_HUB" and caught.value.where == "blade"
        assert words in caught.value.message
    with pytest.raises(InputError) as caught:
        on_hub([sector(50.0, 70.0, 20.0, 60.0)], [], 0.01, "part")
    assert caught.value.code == "NO_BASE"


def test_the_hub_is_what_others_stand_on():
    blades = [sector(50.0, 70.0, 20.0, 60.0, start, start + 0.4, name=f"{start}") for start in (0.0, 1.0, 2.0)]
    shaft = sector(10.0, 50.0, 0.0, 100.0, 0.0, 6.0, 60, name="shaft")
    found = hub_among([blades[0], shaft, *blades[1:]], [[], SEATS[:1], [], []], 0.01, "part")
    assert found == 1
    with pytest.raises(InputError) as caught:
        hub_among(blades, [[], [], []], 0.01, "part")
    assert caught.value.code == "NO_HUB"


@pytest.mark.parametrize("turn", [0.0, 0.7, 3.1, -2.0, 5.5])
def test_the_middle_of_a_sector_is_opposite_to_its_gap(turn):
    body = sector(50.0, 60.0, 0.0, 10.0, turn - 0.4, turn + 0.4)
    assert math.remainder(middle_azimuth(LOWER, body.vertices) - turn, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-8)
