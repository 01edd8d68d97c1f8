# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers that adapt their heights: cusps against shapely and the exact profile, wire against sections."""

from dataclasses import replace

import numpy as np
import pytest
from shapely.geometry import LineString, Point, Polygon

from freecad_am.core.issues import InputError
from freecad_am.core.layers.plane_field import CHANGE, find_levels, group_of
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.process.wire import set_wire_feed
from freecad_am.core.strategies.support import check_support
from tests.core.strategies.test_solids_in_planes import planned, tube

RADIUS = 40.0
ARC = np.linspace(0.0, np.pi / 2.0, 400)
# outer profiles (r, z) of parts that narrow upwards
DOME = RADIUS * np.column_stack([np.cos(ARC), np.sin(ARC)])
SLOPED = np.array([(40.0, 0.0), (38.0, 40.0), (20.0, 50.0)])
HEIGHTS = {"layer_height": 3.0, "least_height": 1.0, "chord_error": 0.05}
CENTRE = 1e-3  # mm; radius of the axis, where facets must not vanish


def part(profile, sides=240):
    """Return the solid of an outer profile, with a hole along its axis as thin as a hair."""
    outer = np.maximum(profile, [CENTRE * 2.0, 0.0])
    inner = [(CENTRE, profile[-1, 1]), (CENTRE, 0.0)]
    return tube([*map(tuple, outer), *inner], sides)


def levels_of(profile, **values):
    strategy = SolidParameters(**{**HEIGHTS, **values})
    return find_levels(group_of(prepare_stack([part(profile)], strategy, "part")), strategy)


def steps(profile, planes, heights):
    """Return the distance of the outer corner of each step from the profile, mm, by shapely.

    A step goes straight up from the profile at the bottom of a layer to the top of this layer.
    """
    line = LineString(profile)
    radius = np.interp(planes, profile[:, 1], profile[:, 0])
    return np.array(
        [line.distance(Point(r, z)) for r, z in zip(radius, planes + heights, strict=True)]
    )


def constant_count(profile, cusp):
    """Return the smallest number of equal layers whose steps are not above a cusp."""
    top = profile[-1, 1]
    for count in range(2, 1000):
        heights = np.full(count, top / count)
        if steps(profile, heights[0] * np.arange(count), heights).max() <= cusp:
            return count
    raise AssertionError("no number of layers has such low steps")


@pytest.mark.parametrize(("profile", "cusp"), [(DOME, 1.0), (SLOPED, 0.9)], ids=["dome", "sloped"])
def test_a_quarter_of_the_layers_is_saved_at_the_same_cusp(profile, cusp):
    levels = levels_of(profile, cusp=cusp)
    measured = steps(profile, levels.planes, levels.heights)
    assert measured.max() <= cusp  # facets are flatter than the arcs that they cut
    assert measured.max() > 0.9 * cusp  # and layers are not lower than needed
    assert len(levels.planes) <= 0.75 * constant_count(profile, measured.max())
    assert levels.cusp == pytest.approx(measured.max(), rel=0.05)


@pytest.mark.parametrize("cut_at", ["bottom", "middle", "top"])
@pytest.mark.parametrize(("profile", "cusp"), [(DOME, 1.0), (SLOPED, 0.9)], ids=["dome", "sloped"])
def test_heights_change_gradually_within_their_range_up_to_the_top(profile, cusp, cut_at):
    levels = levels_of(profile, cusp=cusp, cut_at=cut_at)
    assert levels.planes == pytest.approx(np.r_[0.0, np.cumsum(levels.heights)[:-1]], abs=1e-9)
    assert levels.heights.min() >= 1.0 and levels.heights.max() <= 3.0
    # a hundredth of the least height is the resolution of levels
    assert (np.abs(np.diff(levels.heights)) <= CHANGE * (levels.heights[:-1] + 0.01)).all()
    assert levels.planes[-1] + levels.heights[-1] == pytest.approx(profile[-1, 1], abs=1e-6)


def test_walls_without_slope_have_the_highest_layers_and_others_the_lowest():
    upright = np.array([(20.0, 0.0), (20.0, 30.0)])
    assert levels_of(upright, cusp=0.2).heights == pytest.approx(np.full(10, 3.0), abs=1e-6)
    steep = np.array([(40.0, 0.0), (10.0, 30.0)])  # 45 deg
    assert levels_of(steep, cusp=np.sqrt(0.5) * 1.001).heights == pytest.approx(
        np.full(30, 1.0), abs=1e-6
    )


def test_wire_of_each_layer_fills_its_section_at_a_constant_feed():
    values = {**HEIGHTS, "cusp": 0.9, "bead_spacing": 4.0, "fill": "contours"}
    process = ProcessParameters(bead_width=4.0, travel_speed=6.0)
    toolpath = set_wire_feed(planned(part(SLOPED, 60), process=process, **values), process, None)
    levels = levels_of(SLOPED, cusp=0.9)
    rate = toolpath.wire_feed * process.wire.section
    planes = np.r_[0.0, np.cumsum(toolpath.layer_heights)[:-1]]
    assert toolpath.layer_heights == pytest.approx(levels.heights, rel=1e-6)
    middle = planes + 0.5 * toolpath.layer_heights
    radius = np.interp(middle, SLOPED[:, 1], SLOPED[:, 0])
    angle = 2.0 * np.pi * np.arange(60) / 60
    sections = [
        Polygon(np.column_stack([r * np.cos(angle), r * np.sin(angle)])).area for r in radius
    ]
    volumes = [rate * layer.deposit_time for layer in toolpath.layers]
    # beads at corners and gaps in the middle take a few per cent
    assert volumes == pytest.approx(np.array(sections) * toolpath.layer_heights, rel=0.03)
    for number, _, bead in toolpath:
        assert bead.points[:, 2] == pytest.approx(np.full(len(bead), planes[number]), abs=1e-9)
        assert bead.height == pytest.approx(np.full(len(bead), toolpath.layer_heights[number]))
    part_volume, missed, outside = toolpath.checks.volumes
    assert missed < 0.01 * part_volume and outside < 0.02 * part_volume
    note = next(issue for issue in toolpath.issues if issue.code == "ADAPTED_HEIGHTS")
    assert f"{len(toolpath.layers)} layers are" in note.message


def test_saved_time_is_that_of_the_job_with_one_height():
    values = {**HEIGHTS, "cusp": 0.9, "bead_spacing": 6.0, "widths": "fixed", "narrowest": 1.0}
    _, height, count, seconds = planned(part(SLOPED, 40), **values).checks.adapted
    single = {**values, "layer_height": height, "least_height": None, "cusp": None}
    toolpath = planned(part(SLOPED, 40), **single)
    assert len(toolpath.layers) == count
    assert sum(layer.deposit_time for layer in toolpath.layers) == pytest.approx(seconds, rel=0.03)


def test_a_missing_layer_among_low_layers_is_unsupported():
    """Twice a low layer is less than 1.5 of the highest layers."""
    toolpath = planned(part(SLOPED, 40), **HEIGHTS, cusp=0.9, bead_spacing=6.0)
    assert unsupported_of(toolpath) == ([], 0.0)
    number = len(toolpath.layers) - 4
    assert 2.0 * toolpath.layer_heights[number - 1 : number + 1].max() < 1.5 * 3.0
    layers = (*toolpath.layers[:number], *toolpath.layers[number + 1 :])
    found, length = unsupported_of(replace(toolpath, layers=layers))
    assert found == [number] and length > 0.9 * sum(b.length for b in layers[number].beads)


def unsupported_of(toolpath):
    """Return the numbers of the layers that lack support, and their unsupported length, mm."""
    checked = check_support(toolpath, [np.eye(4)], [], [])
    numbers = [issue.layer for issue in checked.issues if issue.code == "UNSUPPORTED"]
    return numbers, checked.checks.unsupported


def test_a_cusp_that_no_height_meets_names_layer_place_and_remedies_that_work():
    with pytest.raises(InputError) as caught:
        levels_of(SLOPED, cusp=0.5)
    assert caught.value.code == "CUSP" and caught.value.where == "strategy.cusp"
    words = caught.value.message.split()
    cusp = float(words[words.index("strategy.cusp") + 2])
    assert 0.5 < cusp <= 0.88
    levels_of(SLOPED, cusp=cusp)
    lower = float(words[-2])
    assert levels_of(SLOPED, cusp=0.5, least_height=lower).cusp <= 0.5
    number = int(words[words.index("layer") + 1].rstrip(","))
    place = caught.value.message.split("surface at (")[1].split(")")[0]
    height = float(place.split(",")[2])
    planes = np.r_[0.0, np.cumsum(levels_of(SLOPED, cusp=cusp).heights)]
    assert 40.0 <= height <= 50.0 and 10 < number < len(planes) + 5


@pytest.mark.parametrize(
    ("values", "code", "where", "words"),
    [
        ({"least_height": 4.0, "cusp": 0.2}, "BAD_VALUE", "strategy.layer_height", "4 mm"),
        ({"least_height": 1.0}, "BAD_VALUE", "strategy.layer_height", "strategy.cusp"),
        ({"cusp": 0.2}, "BAD_VALUE", "strategy.cusp", "least and most"),
        ({"least_height": 1.0, "cusp": 0.0}, "BAD_VALUE", "strategy.cusp", "more than 0 mm"),
        (
            {"least_height": 1.0, "cusp": 0.2, "layers": "along"},
            "NOT_FOR_FAMILY",
            "strategy.cusp",
            "planes",
        ),
        (
            {"least_height": 1.0, "cusp": 0.2, "margin": 2.0},
            "NOT_YET",
            "strategy.margin",
            "one strategy.layer_height",
        ),
    ],
)
def test_what_is_refused(values, code, where, words):
    with pytest.raises(InputError) as caught:
        SolidParameters(layer_height=3.0, **values)
    assert (caught.value.code, caught.value.where) == (code, where)
    assert words in caught.value.message
