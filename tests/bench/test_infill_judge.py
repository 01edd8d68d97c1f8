# SPDX-License-Identifier: LGPL-2.1-or-later
"""The judge of `bench infill`, on layers whose void, over and outside follow from a formula, and
its inputs: sections of meshes and strokes of G-code."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "bench"))

from infill_judge import Stroke, judge
from infill_parts import LAYER, Triangles
from prusa import read_program

WIDTH = 4.0  # mm
# rasterisation: pixels of a fortieth of the width cross the 100 to 400 mm of borders of these
# layers at random positions, so that their errors add up to less than 1 mm2
PIXELS_MM2 = 1.0


def polygon(*corners):
    """Return the edges of a section with these corners."""
    points = np.array(corners, dtype=float)
    return np.stack([points, np.roll(points, -1, axis=0)], axis=1)


def rectangle(long, wide):
    return polygon((0, 0), (long, 0), (long, wide), (0, wide))


def stroke(*points, width=WIDTH):
    return Stroke(np.array(points, dtype=float), np.full(len(points) - 1, width))


def ring(inset, long=60.0, wide=40.0):
    width_end, high = long - inset, wide - inset
    return stroke(
        (inset, inset), (width_end, inset), (width_end, high), (inset, high), (inset, inset)
    )


def areas(section, strokes, area, narrowest=0.0):
    """Return void, over and outside in mm2."""
    return area * np.array(judge(section, strokes, WIDTH, narrowest))


def test_rings_that_touch_fill_a_rectangle_with_sharp_corners():
    rings = [ring(2.0 + WIDTH * k) for k in range(5)]
    assert areas(rectangle(60, 40), rings, 2400.0) == pytest.approx([0, 0, 0], abs=0.05)


@pytest.mark.parametrize("spacing", [1.1, 0.9])
def test_lines_with_a_gap_and_lines_that_overlap(spacing):
    """The check is across the section only: strokes extend beyond both of its ends."""
    wide = WIDTH * (1.0 + spacing)
    lines = [stroke((-50, y), (150, y)) for y in (2.0, 2.0 + spacing * WIDTH)]
    void, over, _ = areas(rectangle(100, wide), lines, 100.0 * wide)
    gap = 100.0 * (spacing - 1.0) * WIDTH
    assert void == pytest.approx(max(gap, 0.0), abs=PIXELS_MM2)
    # deposit overlaps over the full length except for the round ends
    assert over == pytest.approx(max(-2.0 * gap, 0.0), abs=0.03 * WIDTH**2 + PIXELS_MM2)


def test_a_stroke_that_crosses_itself_deposits_the_crossing_twice():
    loop = stroke((10, 50), (90, 50), (90, 90), (50, 90), (50, 10))
    void, over, outside = areas(rectangle(100, 100), [loop], 1e4)
    assert over == pytest.approx(WIDTH**2, abs=PIXELS_MM2)
    assert void == pytest.approx(1e4 - 240.0 * WIDTH + over, abs=0.05)
    assert outside == 0.0


def test_zigzag_turns_back_without_double_deposit():
    zigzag = stroke((10, 2), (90, 2), (90, 6), (10, 6), (10, 10), (90, 10))
    void, over, outside = areas(rectangle(100, 12), [zigzag], 1200.0)
    assert over == pytest.approx(0.0, abs=PIXELS_MM2)
    assert void - outside == pytest.approx(1200.0 - 248.0 * WIDTH, abs=PIXELS_MM2)


def test_a_sharp_corner_counts_the_overlap_of_its_legs():
    """Legs of half a width on either side overlap in a kite inside, and cover a sector more
    outside."""
    turn = math.radians(150.0)
    legs = stroke((30, 0), (0, 0), (30 * math.cos(math.pi - turn), 30 * math.sin(math.pi - turn)))
    kite, sector = 0.25 * WIDTH**2 * math.tan(0.5 * turn), 0.125 * WIDTH**2 * turn
    square = rectangle(200, 200) - 100.0
    _, over, _ = areas(square, [legs], 4e4)
    assert over == pytest.approx(kite - sector, abs=PIXELS_MM2)


def test_right_angles_and_smooth_bends_do_not_count():
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    circle = stroke(*(50.0 + 20.0 * np.column_stack([np.cos(angle), np.sin(angle)])))
    void, over, outside = areas(rectangle(100, 100), [circle, ring(2.0, 100, 100)], 1e4)
    deposit = WIDTH * (40.0 * np.pi + 384.0)
    assert over == pytest.approx(0.0, abs=PIXELS_MM2)
    assert void == pytest.approx(1e4 - deposit, abs=PIXELS_MM2)
    assert outside == 0.0


def test_ends_are_round_and_add_no_volume():
    line = stroke((20, 20), (60, 20))
    void, over, _ = areas(rectangle(100, 40), [line], 4000.0)
    assert void == pytest.approx(4000.0 - 40.0 * WIDTH, abs=PIXELS_MM2)
    assert over == pytest.approx(0.0, abs=PIXELS_MM2)


def test_a_short_stroke_is_a_disc_of_its_volume():
    radius = math.sqrt(2.0 * WIDTH / math.pi)
    angle = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    disc = polygon(*(radius * np.column_stack([np.cos(angle), np.sin(angle)])))
    dot = stroke((-1, 0), (1, 0))
    assert areas(disc, [dot], math.pi * radius**2) == pytest.approx([0, 0, 0], abs=0.2)


def test_a_loop_may_have_the_gap_of_a_seam():
    seam = 0.15 * WIDTH
    loop = stroke((2, 20), (2, 2), (58, 2), (58, 38), (2, 38), (2, 20 + seam))
    void, over, _ = areas(rectangle(60, 40), [loop, *map(ring, (6.0, 10.0, 14.0, 18.0))], 2400.0)
    assert void == pytest.approx(seam * WIDTH, abs=0.2)
    assert over == pytest.approx(0.0, abs=0.2)


def test_widths_change_along_a_stroke():
    wedge = polygon((0, -1), (40, -2), (40, 2), (0, 1))
    x = np.linspace(0.0, 40.0, 81)
    widths = 2.0 + 0.05 * 0.5 * (x[1:] + x[:-1])
    tapered = Stroke(np.column_stack([x, np.zeros(81)]), widths)
    void, over, outside = areas(wedge, [tapered], 120.0)
    assert over == pytest.approx(0.0, abs=0.3)
    assert max(void, outside) < 0.1 * WIDTH**2  # only the round ends


def test_deposit_outside():
    line = stroke((10, 0), (90, 0))
    void, _, outside = areas(rectangle(100, 20), [line], 2000.0)
    assert outside == pytest.approx(40.0 * WIDTH, abs=PIXELS_MM2)
    assert void == pytest.approx(2000.0 - 40.0 * WIDTH, abs=PIXELS_MM2)


def test_void_counts_where_the_narrowest_bead_reaches():
    section = np.concatenate([rectangle(50, 1.0), rectangle(50, 2.0) + [0.0, 10.0]])
    bare = areas(section, [], 150.0, narrowest=1.5)
    assert bare == pytest.approx([100.0, 0.0, 0.0], abs=0.02 * 150.0)
    assert areas(section, [], 150.0) == pytest.approx([150.0, 0.0, 0.0], abs=1e-9)


def test_holes_and_islands_of_a_section():
    hole = polygon((10, 10), (10, 30), (30, 30), (30, 10))
    island = rectangle(10, 10) + [15.0, 15.0]
    section = np.concatenate([rectangle(40, 40), hole, island])
    line = stroke((15, 20), (25, 20))
    void, _, outside = areas(section, [line], 1300.0)
    assert void == pytest.approx(1300.0 - 10.0 * WIDTH + outside, abs=PIXELS_MM2)
    assert outside < 2.0


def test_section_of_a_mesh():
    """A pyramid with a square base is half as wide in the middle of its height."""
    base = np.array([(-10, -10, 0), (10, -10, 0), (10, 10, 0), (-10, 10, 0)], dtype=float)
    tip = np.array([0.0, 0.0, LAYER])
    sides = [np.array([base[k], base[(k + 1) % 4], tip]) for k in range(4)]
    bottom = [base[[0, 2, 1]], base[[0, 3, 2]]]
    pyramid = Triangles(np.array([*sides, *bottom]))
    assert pyramid.layer_count == 1
    start, end = pyramid.section(0).transpose(1, 0, 2)
    area = 0.5 * float(np.sum(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]))
    assert area == pytest.approx(100.0)


def test_strokes_of_a_program():
    program = """
M82 ; G1 in a remark
G92 E0
G1 Z2 F7800
G1 X0 Y0
;TYPE:Perimeter
G1 F1800
G1 X10 Y0 E80
G1 X10 Y5 E140
G92 E0
G1 X0 Y20 F7800
G1 X10 Y20 E40
G1 E-5
G1 Z4
G1 X-5.5 Y0
G1 X4.5 Y0 E45 ; ends here
"""
    layers, points = read_program(program, 2.0)
    assert sorted(layers) == [0, 1] and points == 7
    corner, line = layers[0]
    assert corner.points.tolist() == [[0, 0], [10, 0], [10, 5]]
    assert corner.widths == pytest.approx([4.0, 6.0])
    assert line.points.tolist() == [[0, 20], [10, 20]] and line.widths == pytest.approx([2.0])
    (later,) = layers[1]
    assert later.points.tolist() == [[-5.5, 0], [4.5, 0]] and later.widths == pytest.approx([2.5])
