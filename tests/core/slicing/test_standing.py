# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which base a solid stands on, and its layers when facets coincide with the cutting surface."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.geometry.on_hub import Base, Seat, Stretch, middle_azimuth, upright
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.solids.equidistant import Facets, count, cut, unroll_layers
from freecad_am.core.slicing.solids.standing import group_by_base, hub_among

LOWER = Base("Face1", Developable(50.0), np.eye(4))
UPPER = Base(
    "Face2", Developable(30.0), upright(np.array([0.0, 0.0, 100.0]), np.array([0.0, 0.0, 1.0]))
)
SEATS = [Seat(LOWER, (Stretch(0.0, 100.0),)), Seat(UPPER, (Stretch(0.0, 80.0),))]


def make_sector(inner, outer, low, high, start=-0.3, end=0.3, steps=12, name="blade"):
    """Return a sector of a ring with its foot exactly on the cylinder of radius `inner`."""
    angle = np.linspace(start, end, steps + 1)
    rows = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(steps + 1, z)], axis=1)
        for r, z in ((inner, low), (outer, low), (outer, high), (inner, high))
    ]
    n = steps + 1
    faces = [
        (0, n, 2 * n),
        (0, 2 * n, 3 * n),
        (n - 1, 3 * n - 1, 2 * n - 1),
        (n - 1, 4 * n - 1, 3 * n - 1),
    ]
    for k in range(4):
        for j in range(steps):
            a, b, c, d = k * n + j, k * n + j + 1, (k + 1) % 4 * n + j, (k + 1) % 4 * n + j + 1
            faces += [(a, b, d), (a, d, c)]
    return Body(name, np.vstack(rows), np.array(faces, dtype=np.int64))


def test_a_solid_belongs_to_the_base_of_its_longest_contour():
    lower_body, upper_body = (
        make_sector(50.0, 70.0, 20.0, 60.0, name="low"),
        make_sector(30.0, 60.0, 110.0, 160.0, name="high"),
    )
    both_body = make_sector(
        20.0, 70.0, 90.0, 160.0, 1.0, 1.6, name="both"
    )  # 10 mm on the lower base, 60 mm on the upper, reaching into both
    grouping = group_by_base([upper_body, lower_body, both_body], SEATS, 0.01, "part")
    assert [[body.name for body in group.bodies] for group in grouping.groups] == [
        ["low"],
        ["high", "both"],
    ]
    assert [group.base.name for group in grouping.groups] == ["Face1", "Face2"]


def test_a_foot_on_the_hub_is_cut_completely():
    """Vertices are on the cylinder except for rounding, chords are inside."""
    for lift in (0.0, 1e-9, -1e-9, 0.03):
        body = make_sector(50.0 + lift, 70.0, 20.0, 60.0)
        facets = Facets(LOWER.surface, body.vertices, body.triangles)
        loops = cut(facets, 0.0, 0.01)
        assert len(loops) == 1
        assert np.abs(LOWER.surface.distance(loops[0].points)).max() < 1e-9
        flat = unroll_layers(LOWER.surface, [loops], 0.0, "here").borders[0][0]
        area = (
            0.5
            * (flat[:, 0] * np.roll(flat[:, 1], -1) - np.roll(flat[:, 0], -1) * flat[:, 1]).sum()
        )
        assert area == pytest.approx(50.0 * 0.6 * 40.0, rel=1e-3)


def test_layer_count_fills_the_height():
    body = make_sector(50.0, 70.0, 20.0, 60.0)
    facets = Facets(LOWER.surface, body.vertices, body.triangles)
    assert count(facets, 2.0, 0.0, 0.01) == 10  # the eleventh would coincide with the outer face
    assert count(facets, 3.0, 0.0, 0.01) == 7
    assert count(facets, 2.0, 5.0, 0.01) == 13


def test_solids_off_the_hub_are_rejected():
    for body, words in (
        (make_sector(60.0, 70.0, 20.0, 60.0), "10 mm outside Face1"),
        (make_sector(20.0, 40.0, 20.0, 60.0), "inside the hub"),
        (make_sector(20.0, 40.0, 200.0, 220.0), "off the face"),
    ):
        seats = SEATS[:1] if "inside" in words else SEATS
        with pytest.raises(InputError) as caught:
            group_by_base([body], seats, 0.01, "part")
        assert caught.value.code == "NOT_ON_HUB" and caught.value.where == "blade"
        assert words in caught.value.message
    with pytest.raises(InputError) as caught:
        group_by_base([make_sector(50.0, 70.0, 20.0, 60.0)], [], 0.01, "part")
    assert caught.value.code == "NO_BASE"


@pytest.mark.parametrize("factor, unit", [(25.4, "inches"), (10.0, "cm"), (1000.0, "m")])
def test_solids_in_a_wrong_unit_get_a_hint(factor, unit):
    body = make_sector(49.0, 70.0, 20.0, 60.0)
    small = Body("small", body.vertices / factor, body.triangles)
    with pytest.raises(InputError) as caught:  # a STEP file contains its unit
        group_by_base([small], SEATS, 0.01, "part")
    assert "Multiplied" not in caught.value.message and "file" not in caught.value.message
    with pytest.raises(InputError) as caught:
        group_by_base([small], SEATS, 0.01, "part", unitless=[small])
    assert (
        f"Multiplied by {factor:g} the solid would reach Face1: is its file in {unit}?"
        in caught.value.message
    )
    with pytest.raises(InputError) as caught:
        group_by_base(
            [body := make_sector(60.0, 70.0, 20.0, 60.0)], SEATS, 0.01, "part", unitless=[body]
        )
    assert "Multiplied" not in caught.value.message


def test_the_hub_is_the_body_that_carries_the_blades():
    blades = [
        make_sector(50.0, 70.0, 20.0, 60.0, start, start + 0.4, name=f"{start}")
        for start in (0.0, 1.0, 2.0)
    ]
    shaft = make_sector(10.0, 50.0, 0.0, 100.0, 0.0, 6.0, 60, name="shaft")
    hub_index = hub_among([blades[0], shaft, *blades[1:]], [[], SEATS[:1], [], []], 0.01, "part")
    assert hub_index == 1
    with pytest.raises(InputError) as caught:
        hub_among(blades, [[], [], []], 0.01, "part")
    assert caught.value.code == "NO_HUB"


@pytest.mark.parametrize("turn", [0.0, 0.7, 3.1, -2.0, 5.5])
def test_middle_azimuth_of_a_sector_is_opposite_its_gap(turn):
    body = make_sector(50.0, 60.0, 0.0, 10.0, turn - 0.4, turn + 0.4)
    assert math.remainder(
        middle_azimuth(LOWER, body.vertices) - turn, 2.0 * math.pi
    ) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize(("first_sector", "second_sector"), [
    (((50, 70, 20, 60), (-0.3, 0.3)), ((50, 70, 20, 60), (0.25, 0.9))),  # a corner in the other
    (((50, 70, 20, 60), (-0.3, 0.3)), ((50, 70, 20, 60), (-0.3, 0.3))),  # identical
    (((50, 80, 10, 90), (-0.5, 0.5)), ((50, 70, 40, 60), (-0.1, 0.1))),  # nested
    (((50, 60, 40, 50), (-0.6, 0.6)), ((50, 70, 10, 90), (-0.1, 0.1))),  # crossed, without a vertex inside
    (((50, 60, 40, 50), (-0.6, 0.6)), ((48, 55, 10, 90), (-0.1, 0.1))),
])  # fmt: skip
def test_overlapping_solids_are_rejected_with_a_point(first_sector, second_sector):
    bodies = [
        make_sector(*size, *turn, name=name)
        for (size, turn), name in ((first_sector, "one"), (second_sector, "other"))
    ]
    for pair in (bodies, bodies[::-1]):
        with pytest.raises(InputError) as caught:
            group_by_base(pair, SEATS, 0.01, "part")
        assert caught.value.code == "OVERLAP" and {"one", "other"} <= {
            caught.value.where,
            *caught.value.message.split(),
        }
        x, y, z = (
            float(text)
            for text in caught.value.message.partition("(")[2].partition(")")[0].split(",")
        )
        for (inner, outer, low, high), (start, end) in (first_sector, second_sector):
            assert inner * 0.98 < math.hypot(x, y) < outer + 1e-3 and low - 1e-3 <= z <= high + 1e-3
            assert start - 1e-4 <= math.atan2(y, x) <= end + 1e-4


def test_solids_that_touch_or_overlap_inside_the_hub_are_accepted():
    body = make_sector(50.0, 70.0, 20.0, 60.0)
    adjacent, above = (
        make_sector(50.0, 70.0, 20.0, 60.0, 0.3, 0.9, name="beside"),
        make_sector(50.0, 80.0, 60.0, 70.0, name="above"),
    )
    below = [make_sector(30.0, 49.9, 10.0, 90.0, -2.0, 2.0, 60, name="b")]
    assert (
        len(group_by_base([body, adjacent, above], SEATS[:1], 0.01, "part").groups[0].bodies) == 3
    )
    with pytest.raises(InputError, match="inside the hub"):
        group_by_base([body, *below], SEATS[:1], 0.01, "part")
    deep = [
        make_sector(10.0, 70.0, 20.0, 60.0, *turn, name=str(turn))
        for turn in ((-1.0, 0.0), (0.05, 1.0))
    ]
    assert len(group_by_base(deep, SEATS[:1], 0.01, "part").groups[0].bodies) == 2


@pytest.mark.parametrize("turn", [0.0, 1.0, 3.0, -2.0])
def test_a_solid_next_to_a_partial_cylinder_is_off_its_face(turn):
    """Half of the hub has a radius of 50 mm, the other half 49.5 mm; solids reach into both, with
    equally long contours."""
    half = Seat(LOWER, (Stretch(0.0, 100.0, turn % (2.0 * math.pi), math.pi),))
    inner_base = Base("inner", Developable(49.5), np.eye(4))
    other_half = Seat(
        inner_base, (Stretch(0.0, 100.0, (turn + math.pi) % (2.0 * math.pi), math.pi),)
    )
    on_half = [
        make_sector(40.0, 70.0, 10.0, 60.0, turn + a, turn + a + 0.5, name=f"half {a}")
        for a in (0.0, 1.3, math.pi - 0.5)
    ]
    on_other_half = [
        make_sector(40.0, 70.0, 10.0, 60.0, turn - a, turn - a + 0.5, name=f"rest {a}")
        for a in (0.6, 1.8, 3.0)
    ]
    for seats in ([half, other_half], [other_half, half]):
        grouping = group_by_base([*on_half, *on_other_half], seats, 0.01, "part")
        assert {
            group.base.name: {body.name for body in group.bodies} for group in grouping.groups
        } == {
            "Face1": {body.name for body in on_half},
            "inner": {body.name for body in on_other_half},
        }
    with pytest.raises(InputError, match="off the face") as caught:
        group_by_base(on_other_half[1:2], [half], 0.01, "part")
    assert caught.value.code == "NOT_ON_HUB"
    # a face chosen by the user covers its full turn unless another base is there
    assert (
        len(group_by_base(on_other_half[1:2], [half._replace(chosen=True)], 0.01, "part").groups)
        == 1
    )
    chosen_seats = [half._replace(chosen=True), other_half._replace(chosen=True)]
    assert len(group_by_base([*on_half, *on_other_half], chosen_seats, 0.01, "part").groups) == 2


def test_faces_of_one_cylinder_keep_their_ranges():
    """The cylinder is complete at the bottom and a quarter above; a solid above, next to the
    quarter, has no base."""
    seat = Seat(LOWER, (Stretch(0.0, 30.0), Stretch(30.0, 100.0, 0.0, 0.5 * math.pi)))
    for low, high, start, is_on_base in (
        (5.0, 25.0, 2.0, True),
        (40.0, 90.0, 0.2, True),
        (40.0, 90.0, 2.0, False),
    ):
        body = make_sector(40.0, 70.0, low, high, start, start + 0.5)
        if is_on_base:
            assert group_by_base([body], [seat], 0.01, "part").groups[0].base.name == "Face1"
        else:
            with pytest.raises(InputError, match="off the face"):
                group_by_base([body], [seat], 0.01, "part")


def test_overlapping_axis_aligned_boxes_are_rejected():
    def make_box(name, low_corner):
        corners = (
            np.array([[x, y, z] for x in (0, 30) for y in (0, 20) for z in (0, 20)], dtype=float)
            + low_corner
        )
        sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        faces = [corner for a, b, c, d in sides for corner in ((a, b, c), (a, c, d))]
        return Body(name, corners, np.array(faces, dtype=np.int64))

    seats = [Seat(Base("hub", Developable(60.0), np.eye(4)), (Stretch(-math.inf, math.inf),))]
    with pytest.raises(InputError, match="overlap, as at") as caught:
        group_by_base(
            [make_box("one", [50.0, -10.0, -10.0]), make_box("two", [55.0, -5.0, -5.0])],
            seats,
            0.02,
            "part",
        )
    assert caught.value.code == "OVERLAP"
    adjacent = [
        make_box("one", [50.0, -10.0, -10.0]),
        make_box("two", [55.0, 10.0, -5.0]),
    ]  # sharing a side is not an overlap
    assert len(group_by_base(adjacent, seats, 0.02, "part").groups[0].bodies) == 2
