# SPDX-License-Identifier: LGPL-2.1-or-later
"""Volumes between planes against half-space clipping and formulas; overhanging facets against their
slopes."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from freecad_am.core.geometry.curves.guide import fit_guide
from freecad_am.core.geometry.developable import Plane
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.geometry.on_hub import Base
from freecad_am.core.layers.plane_field import group_of, outline, slabs, volumes_below
from freecad_am.core.layers.stacking import find_leaning, prepare_stack
from freecad_am.core.parameters.filled import SolidParameters
from tests.core.strategies.test_solids_in_planes import CONE, box, hull, tube

LEVEL_BASE = Base("the first layer", Plane(), np.eye(4))


def clipped(points, height):
    """Volume of a convex body below a height, from its corners below and the intersections of all
    lines between corners."""
    under, over = points[points[:, 2] <= height], points[points[:, 2] > height]
    if not len(under):
        return 0.0
    share = (height - under[:, None, 2]) / np.maximum(over[None, :, 2] - under[:, None, 2], 1e-300)
    crossed = under[:, None] + share[..., None] * (over[None] - under[:, None])
    corners = np.vstack([under, crossed.reshape(-1, 3)])
    return ConvexHull(corners).volume if np.ptp(corners[:, 2]) > 1e-9 else 0.0


@pytest.mark.parametrize("seed", range(6))
def test_volumes_below_planes_are_those_of_half_spaces(seed):
    random = np.random.default_rng(seed)
    points = random.normal(size=(14, 3)) * [20.0, 12.0, 9.0]
    points[:3, 2] = -25.0  # a face that lies in a plane
    body = hull(points)
    heights = np.concatenate([[-26.0, -25.0], np.linspace(-24.0, 28.0, 17), points[4:8, 2]])
    expected = [clipped(points, height) for height in heights]
    np.testing.assert_allclose(
        volumes_below(body.vertices, body.triangles, heights), expected, rtol=1e-9, atol=1e-8
    )


def test_layers_of_a_cone_and_a_box_have_their_volumes_whichever_way_they_are_stacked():
    cone = tube(CONE)  # by its polygon
    area = 240 / 2 * np.sin(2 * np.pi / 240)
    group = group_of(prepare_stack([cone], SolidParameters(layer_height=4.0), "cone"))
    slab_volumes = slabs(group, 4.0, np.zeros((0, 3)), np.zeros(0))
    planes = np.minimum(4.0 * np.arange(9), 30.0)
    radius = 40.0 - 0.5 * planes
    inner = area * 100.0 * np.diff(planes)
    expected = -area * np.diff(radius**3) * 2.0 / 3.0 - inner
    np.testing.assert_allclose(slab_volumes.part_volume, expected, rtol=1e-9)
    assert len(slab_volumes.deposited) == 8 and not slab_volumes.deposited.any()
    bars = [box((0, 0, 0), (30, 7, 5)), box((0, 20, 0), (10, 27, 5))]
    group = group_of(
        prepare_stack(bars, SolidParameters(layer_height=4.0, direction="-1 0 0"), "bars")
    )
    # 30 mm high along -X, the second box in the lowest 20 mm
    points = np.array([[28.0, 1.0, 1.0], [26.0, 1.0, 1.0], [2.0, 1.0, 1.0]])
    points[:, 0] = 30.0 - 4.0 * np.array([0, 1, 6])
    slab_volumes = slabs(group, 4.0, points, np.array([3.0, 0.0, 5.0]))
    second = 35.0 * np.array([0, 0, 0, 0, 0, 4, 4, 2])
    np.testing.assert_allclose(
        slab_volumes.part_volume, 35.0 * np.array([4, 4, 4, 4, 4, 4, 4, 2]) + second, rtol=1e-9
    )
    assert slab_volumes.deposited.tolist() == [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0]
    assert (
        sorted(len(loop) for loop in outline(group, 25.0)) == [7, 7]
        or len(outline(group, 25.0)) == 2
    )
    assert len(outline(group, 3.0)) == 1


def test_facets_lean_by_their_slope_and_what_stands_does_not():
    """Roofs with slopes from 10 to 80 deg, upside down; vertical walls have no overhang."""
    for slope in np.radians([10.0, 35.0, 60.0, 80.0]):
        rise = 20.0 * np.tan(0.5 * np.pi - slope)
        # widens upwards from 10 to 50: the sides overhang by the slope; the base of 10 x 30 is
        # supported
        points = np.array(
            [
                [x, y, z]
                for z, half in ((0.0, 5.0), (rise, 25.0))
                for x in (-half, half)
                for y in (0.0, 30.0)
            ]
        )
        body = hull(points)
        overhangs = find_leaning([body], LEVEL_BASE, 0.1)
        side = 30.0 * np.hypot(20.0, rise)
        assert overhangs.steeper_than(slope - 0.01)[1] == pytest.approx(2.0 * side, rel=1e-9)
        assert (
            overhangs.steeper_than(slope + 0.01)[1] == 0.0
            and len(overhangs.steeper_than(slope + 0.01)[0]) == 0
        )
        assert overhangs.total_area == pytest.approx(ConvexHull(points).area, rel=1e-9)
        flying = Body("higher", body.vertices + [100.0, 0.0, 50.0], body.triangles)
        overhangs_of_both = find_leaning([body, flying], LEVEL_BASE, 0.1)
        assert overhangs_of_both.steeper_than(np.radians(85.0))[1] == pytest.approx(
            300.0, rel=1e-9
        )  # its underside is a ceiling
        assert (np.diff(overhangs_of_both.lean) >= 0.0).all()


def elbow(widening):
    """A pipe bent by 90 deg about a radius of 40 mm, 5 mm thick at its base and widening by a share
    of the arc length; a base with the arc as its guide."""
    turn, round_ = (
        np.linspace(0.0, np.pi / 2.0, 91),
        np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False),
    )
    tangents = np.stack([np.sin(turn), np.zeros_like(turn), np.cos(turn)], axis=1)
    out = np.stack([-np.cos(turn), np.zeros_like(turn), np.sin(turn)], axis=1)
    middle = np.array([40.0, 0.0, 0.0]) + 40.0 * out
    radius = 5.0 + widening * 40.0 * turn
    ring = np.cos(round_)[None, :, None] * out[:, None] + np.sin(round_)[None, :, None] * np.array(
        [0.0, 1.0, 0.0]
    )
    points = (middle[:, None] + radius[:, None, None] * ring).reshape(-1, 3)
    a = np.arange(90)[:, None] * 72 + np.arange(72)
    b = np.arange(90)[:, None] * 72 + (np.arange(72) + 1) % 72
    sides = np.concatenate(
        [np.stack([a, b, a + 72], axis=-1), np.stack([b, b + 72, a + 72], axis=-1)]
    ).reshape(-1, 3)
    if (
        np.linalg.det(
            np.stack(
                [
                    points[sides[0, 1]] - points[sides[0, 0]],
                    points[sides[0, 2]] - points[sides[0, 0]],
                    points[sides[0, 0]] - middle[0],
                ]
            )
        )
        < 0.0
    ):
        sides = sides[:, ::-1]
    return Body("elbow", points, sides), Base("the guide", fit_guide(middle, tangents), np.eye(4))


@pytest.mark.parametrize("widening", [0.0, 0.05])
def test_facets_lean_from_the_guide_where_they_are(widening):
    """A bent pipe has no overhang relative to the planes across it. One that widens overhangs by
    its widening, more on the inside of the bend, where the path is shorter."""
    body, base = elbow(widening)
    overhangs, upright = find_leaning([body], base, 0.1), find_leaning([body], LEVEL_BASE, 0.1)
    assert upright.steeper_than(np.radians(20.0))[1] > 0.2 * upright.total_area
    min_lean, max_lean = (
        np.arctan(widening * 40.0 / (40.0 + side * (5.0 + widening * 20.0 * np.pi)))
        for side in (1.0, -1.0)
    )
    flat = np.radians(0.5)  # facets are 5 deg wide
    assert overhangs.steeper_than(max_lean + flat)[1] < 1e-6 * overhangs.total_area
    if widening:
        assert (
            overhangs.steeper_than(min_lean - flat)[1] > 0.95 * overhangs.total_area
        )  # except near the first plane
