# SPDX-License-Identifier: LGPL-2.1-or-later
"""Void and double deposit of layers: by formula, and against areas from shapely."""

import importlib.util
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely import geometry, ops

from freecad_am.core.geometry.regions.raster import Raster, Stroke
from freecad_am.core.geometry.section import Section
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.process.deposit import void_and_double
from freecad_am.core.strategies.solids.plan import plan
from freecad_am.core.toolpath import Bead, Layer, SpeedLaw, Toolpath

_spec = importlib.util.spec_from_file_location(
    "solids_in_planes",
    Path(__file__).parents[1] / "strategies" / "test_solids_in_planes.py",
)
solids = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(solids)

WIDTH, HEIGHT = 4.0, 2.0
# the plane of the layers: its x, y and z are the part's y, z and x
FRAME = np.array([[0, 0, 1, 7], [1, 0, 0, -3], [0, 1, 0, 11], [0, 0, 0, 1]], dtype=float)


def rectangle(long, wide):
    return np.array([(0, 0), (long, 0), (long, wide), (0, wide)], dtype=float)


def line(*flat, width=None, height=None, closed=False):
    flat = np.array(flat, dtype=float)
    points = flat @ FRAME[:3, :2].T + FRAME[:3, 3]
    up = np.tile(FRAME[:3, 2], (len(flat), 1))
    count = len(flat)
    return Bead(
        points,
        up,
        up,
        np.arange(count, dtype=float),
        np.full(count, 6.0),
        closed,
        width=None if width is None else np.broadcast_to(width, count),
        height=None if height is None else np.full(count, height),
    )


SECTION = (rectangle(100, 12),)


def layer(*beads, loops=SECTION, spacing=WIDTH, is_sparse=False):
    return Layer(beads, section=Section(FRAME, loops, spacing, is_sparse))


def toolpath(*layers, **values):
    parameters = {"bead_width": WIDTH, **values}
    return Toolpath(tuple(layers), FRAME, HEIGHT, 0.05, family="solid", **parameters)


def lines(*heights, **values):
    """Lines that extend far beyond both ends of the section."""
    return [line((-50, y), (150, y), **values) for y in heights]


def coverage(path, number=0):
    return void_and_double.measure(path, 1.0).layers[number].coverage


def test_lines_that_touch_leave_nothing_void():
    """Adjacent lines leave no void."""
    shares = coverage(toolpath(layer(*lines(2, 6, 10))))
    assert (shares.void, shares.over) == pytest.approx((0.0, 0.0), abs=2e-3)
    # lines outside are as wide as the section; the nominal bead reaches all but its corners
    reached = 1200.0 - (4.0 - math.pi) * (0.5 * WIDTH) ** 2
    assert shares.outside == pytest.approx((200.0 - 100.0) * 12.0 / reached, rel=2e-3)


def test_a_gap_is_void_and_its_place_is_in_its_middle():
    shares = coverage(toolpath(layer(*lines(2, 10))))
    assert shares.void == pytest.approx(4.0 / 12.0, rel=5e-3)
    assert shares.over == pytest.approx(0.0, abs=2e-3)
    assert shares.void_size == pytest.approx(4.0, abs=0.3)
    assert shares.over_place is None
    along, across = (shares.void_place - FRAME[:3, 3]) @ FRAME[:3, :2]
    assert 0.0 < along < 100.0 and across == pytest.approx(6.0, abs=0.3)
    assert (shares.void_place - FRAME[:3, 3]) @ FRAME[:3, 2] == pytest.approx(0.0, abs=1e-9)


def test_lines_that_overlap_are_double():
    shares = coverage(toolpath(layer(*lines(2, 6, 9), loops=(rectangle(100, 11),))))
    # including both ends, where lines overlap equally
    assert shares.over == pytest.approx(200.0 * 1.0 / 1100.0, rel=0.02)
    assert shares.over_size == pytest.approx(1.0, abs=0.3)
    assert ((shares.over_place - FRAME[:3, 3]) @ FRAME[:3, 1]) == pytest.approx(7.5, abs=0.3)


def test_a_notch_that_the_nominal_bead_does_not_reach_is_not_void():
    notched = np.array(
        [(0, 0), (100, 0), (100, 12), (60, 12), (60, 20), (57, 20), (57, 12), (0, 12)], dtype=float
    )
    shares = coverage(toolpath(layer(*lines(2, 6, 10), loops=(notched,))))
    assert shares.void == pytest.approx(0.0, abs=3e-3)
    wide = notched.copy()
    wide[4:6, 0] = (66.0, 57.0)
    wide[3, 0] = 66.0
    shares = coverage(toolpath(layer(*lines(2, 6, 10), loops=(wide,))))
    assert shares.void == pytest.approx(72.0 / 1272.0, rel=0.05)


def test_a_section_narrower_than_the_nominal_bead_counts_as_a_whole():
    shares = coverage(
        toolpath(layer(line((-50, 1), (150, 1), width=1.0), loops=(rectangle(100, 2),)))
    )
    assert shares.void == pytest.approx(0.5, rel=0.02)


def test_the_width_of_a_bead_is_its_volume_by_length_and_layer_height():
    """A bead model predicts beads that are wider and lower, or only lower."""
    law = SpeedLaw(1.0, 1.0, 1.0, 100.0)
    beads = lines(2, 6, 10, width=1.25 * WIDTH, height=0.8 * HEIGHT)
    assert coverage(toolpath(layer(*beads), law=law)).void == pytest.approx(0.0, abs=2e-3)
    low = lines(2, 6, 10, width=WIDTH, height=0.75 * HEIGHT)
    assert coverage(toolpath(layer(*low), law=law)).void == pytest.approx(0.25, rel=0.02)


@pytest.mark.parametrize("ends", [(6.0, 2.0), (2.0, 6.0), (5.0, 5.0)])
def test_round_ends_add_no_volume_to_tapering_strokes(ends):
    """The area of a stroke by trapezoids equals the covered area."""
    points = np.stack([np.linspace(0.0, 30.0, 61), np.zeros(61)], axis=1)
    wide = np.linspace(*ends, 61)
    stroke = Stroke(points, 0.5 * (wide[1:] + wide[:-1]))
    raster = Raster.around(points, 6.0, 0.02)
    covered = np.count_nonzero(raster.counts([stroke])[0]) * raster.pixel**2
    assert covered == pytest.approx(30.0 * 0.5 * sum(ends), rel=2e-3)


def test_the_planned_overlap_of_beads_is_neither_void_nor_double():
    shares = coverage(
        toolpath(layer(*lines(2, 5, 8, 11), loops=(rectangle(100, 13),), spacing=3.0))
    )
    assert (shares.void, shares.over) == pytest.approx((0.0, 0.0), abs=2e-3)


@pytest.mark.parametrize(
    ("long", "wide", "spacing", "width"),
    [(30, 20, 4, 4), (30, 20, 3.5, 4), (30, 20, 3.2, 4), (10, 10, 3.5, 4), (50, 5.5, 4, 5)],
)
def test_blocks_of_any_width_have_neither_void_nor_double_deposit(long, wide, spacing, width):
    """With beads of one width a block of 20 mm has 2.7 % void, or 2.1 % double deposit."""
    block = solids.box((0, 0, 0), (long, wide, 4))
    values = {"bead_spacing": spacing, "process": ProcessParameters(bead_width=float(width))}
    shares = coverage(solids.planned(block, **values))
    assert shares.void <= 0.01 and shares.over <= 0.01 and shares.outside <= 0.01
    assert coverage(solids.planned(block, widths="fixed", **values)).void >= shares.void


def test_a_bead_without_length_covers_nothing():
    section = Section(np.eye(4), SECTION, WIDTH)
    line_ = Stroke(np.array([(-50.0, 6.0), (150.0, 6.0)]), np.array([WIDTH]))
    point = Stroke(np.array([(5.0, 2.0), (5.0, 2.0)]), np.array([WIDTH])).drop_repeats()
    line_only, with_point = (
        void_and_double.draw(section, strokes, WIDTH).coverage
        for strokes in ([line_], [point, line_])
    )
    assert line_only.void == with_point.void == pytest.approx(2.0 / 3.0, abs=5e-3)


@pytest.mark.parametrize(("narrowest", "missing"), [(1.0, 0.0), (0.3, 20 * 2 / (1200 + 20 * 2))])
def test_a_rib_without_a_bead_is_void_where_a_narrow_bead_would_fit(narrowest, missing):
    """A rib half a bead wide on the long side of a rectangle could be filled by beads of adaptive
    width."""
    outline = [(0, 0), (100, 0), (100, 12), (60, 12), (60, 32), (58, 32), (58, 12), (0, 12)]
    section = Section(FRAME, (np.array(outline, dtype=float),), WIDTH, narrowest=narrowest)
    shares = coverage(toolpath(Layer(tuple(lines(2, 6, 10)), section=section)))
    assert shares.void == pytest.approx(missing, abs=3e-3)


def test_sparse_layers_have_no_void_and_curved_layers_are_not_measured():
    path = toolpath(layer(*lines(2, 6, 7), is_sparse=True), Layer(tuple(lines(2))))
    measured = void_and_double.measure(path, 0.0)
    assert measured.issues == () and measured.layers[1].coverage is None
    (row,) = void_and_double.as_dict(measured)["layers"]
    assert row["layer"] == 0 and math.isnan(row["void"]) and row["over"] > 0.2
    assert void_and_double.as_dict(measured)["void"]["worst"] is None
    assert void_and_double.as_dict(toolpath(Layer(tuple(lines(2))))) is None


def test_issues_name_layer_place_share_and_remedy():
    path = toolpath(
        layer(*lines(2, 6, 10)), layer(*lines(2, 10)), layer(), layer(*lines(2, 6, 9.5))
    )
    issues = void_and_double.measure(path, 0.03).issues
    assert [(issue.code, issue.level, issue.layer) for issue in issues] == [
        ("VOIDS", "warning", 1),
        ("VOIDS", "warning", 3),
    ]  # a layer without a bead has its own issue
    assert "33.4 %" in issues[0].message and "at (7, " in issues[0].message
    assert "strategy.max_void allows 3 %" in issues[0].message
    assert [issue.layer for issue in void_and_double.measure(path, 0.05).issues] == [1]


def test_the_report_has_median_and_worst():
    path = toolpath(layer(*lines(2, 6, 10)), layer(*lines(2, 10)), layer(*lines(2, 6, 9)))
    figures = void_and_double.as_dict(void_and_double.measure(path, 0.03))
    void, over = ([row[name] for row in figures["layers"]] for name in ("void", "over"))
    assert figures["void"]["median"] == sorted(void)[1]
    assert (figures["void"]["worst"], figures["void"]["layer"]) == (void[1], 1)
    assert (figures["over"]["worst"], figures["over"]["layer"]) == (over[2], 2)
    assert len(figures["over"]["place"]) == 3
    assert figures["over"]["place"][0] == pytest.approx(7.0)


def shapely_shares(path, number):
    """void, over and outside of a layer as shares of the area that the nominal bead reaches, by
    polygon areas: mitred corners, and round ends that keep the volume."""
    measured_layer, nominal = path.layers[number], path.bead_width
    shells = [geometry.Polygon(loop) for loop in measured_layer.section.loops]
    section = ops.unary_union([shell for shell, sign in signed(shells, measured_layer) if sign > 0])
    section = section.difference(
        ops.unary_union([shell for shell, sign in signed(shells, measured_layer) if sign < 0])
    )
    reached = section.buffer(-0.5 * nominal, 64).buffer(0.5 * nominal, 64)
    covers, deposit = [], 0.0
    for bead in measured_layer.beads:
        flat = (bead.points - measured_layer.section.frame[:3, 3]) @ measured_layer.section.frame[
            :3, :2
        ]
        widths = np.full(len(flat), nominal) if bead.width is None else bead.width
        widths = 0.5 * (widths[1:] + widths[:-1])
        length = np.hypot(*np.diff(flat, axis=0).T)
        deposit += float(length @ widths)
        covers += cover_of(flat, widths, bead.closed)
    covered = ops.unary_union(covers)
    return (
        reached.difference(covered).area / reached.area,
        (deposit - covered.area) / reached.area,
        covered.difference(section).area / reached.area,
    )


def signed(shells, measured_layer):
    areas = [
        float(np.sum(loop[:, 0] * np.roll(loop[:, 1], -1) - loop[:, 1] * np.roll(loop[:, 0], -1)))
        for loop in measured_layer.section.loops
    ]
    return zip(shells, areas)


def cover_of(flat, widths, closed):
    """Flat bands along each segment, mitred corners between them, and round ends."""
    if not closed:
        for _ in range(2):
            flat, widths = cut(flat, widths)
            flat, widths = flat[::-1], widths[::-1]
    polygons = [
        geometry.LineString(flat[k : k + 2]).buffer(0.5 * widths[k], cap_style=2)
        for k in range(len(widths))
    ]
    joints = [(k, k + 1) for k in range(len(widths) - 1)]
    if closed:
        joints.append((len(widths) - 1, 0))
    else:
        polygons += [
            geometry.Point(flat[0]).buffer(0.5 * widths[0], 64),
            geometry.Point(flat[-1]).buffer(0.5 * widths[-1], 64),
        ]
    for a, b in joints:
        short = 1e-3
        joint = flat[a + 1]
        incoming, outgoing = (flat[a] - joint), (flat[b + 1] - joint)
        incoming, outgoing = (
            short * direction / np.hypot(*direction) for direction in (incoming, outgoing)
        )
        turn = math.pi - math.acos(np.clip(incoming @ outgoing / short**2, -1.0, 1.0))
        around = geometry.LineString([joint + incoming, joint, joint + outgoing])
        style = 2 if turn <= math.radians(95.0) else 1
        polygons.append(
            around.buffer(0.25 * (widths[a] + widths[b]), 64, cap_style=2, join_style=style)
        )
    return polygons


def cut(flat, widths):
    """Cut off the start of a line: the area of a half circle as wide as the rest."""
    removed = 0.0
    while True:
        segment = flat[1] - flat[0]
        length = float(np.hypot(*segment))
        by = max(math.pi / 8.0 * widths[0] - removed / widths[0], 0.0)
        if length > by or len(widths) == 1:
            return np.vstack([flat[0] + by * segment / length, flat[1:]]), widths
        removed += length * widths[0]
        flat, widths = flat[1:], widths[1:]


FILLS = [
    {"fill": "contours"},
    {"fill": "contours", "widths": "adaptive"},
    {"fill": "lines", "fill_angle": 0.4},
    {"fill": "zigzag"},
]


@pytest.mark.parametrize("values", FILLS, ids=str)
def test_planned_layers_against_areas(values):
    """A ring and a T, also cut across axes other than Z; neither has symmetric layers."""
    strategy = SolidParameters(
        layer_height=4.0, chord_error=0.05, bead_spacing=4.0, direction="1 0 0", **values
    )
    shape = solids.tube([(12.0, 0.0), (40.0, 0.0), (33.0, 47.0), (12.0, 47.0)], 60)
    stack = prepare_stack([shape], strategy, "part")
    path = plan(stack, strategy, BuildDirectionParameters(), ProcessParameters(), None)
    measured = void_and_double.measure(path, 0.03)
    numbers = [2, len(path.layers) // 2, len(path.layers) - 3]
    for number in numbers:
        shares = measured.layers[number].coverage
        expected = shapely_shares(path, number)
        assert (shares.void, shares.over, shares.outside) == pytest.approx(expected, abs=2.5e-3)
    worst = max(
        (number for number, shares in enumerate(measured.layers)),
        key=lambda number: measured.layers[number].coverage.void,
    )
    position, section = measured.layers[worst].coverage.void_place, path.layers[worst].section
    assert (position - section.frame[:3, 3]) @ section.frame[:3, 2] == pytest.approx(0.0, abs=1e-6)
    picture = void_and_double.picture(path, worst)
    assert picture.inside[picture.void].all()


def test_equal_layers_are_measured_once(monkeypatch):
    calls = []
    draw = void_and_double._picture
    monkeypatch.setattr(void_and_double, "_picture", lambda *args: calls.append(1) or draw(*args))
    repeated_layer = layer(*lines(2, 6, 9))
    moved = replace(repeated_layer, section=replace(repeated_layer.section, frame=FRAME + 0.0))
    measured = void_and_double.measure(toolpath(*[repeated_layer] * 5, moved), 1.0)
    assert len(calls) == 2  # once for all layers, and once for the position of the worst
    assert len({measured_layer.coverage.over for measured_layer in measured.layers}) == 1
