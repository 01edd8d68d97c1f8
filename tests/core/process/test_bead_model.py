# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bead model: the refit of table 1, its inverse, its behaviour outside the data, and speeds
along a bead."""

import math

import numpy as np
import pytest
from scipy.optimize import least_squares

from freecad_am.core.issues import InputError
from freecad_am.core.process import model_notes, wire
from freecad_am.core.process.bead_model import fit

TABLE = [  # Dai 2020, table 1: radius mm, travel speed mm/min, width mm, height mm
    (30, 300, 12.52, 3.40),
    (30, 600, 9.86, 2.68),
    (30, 900, 9.14, 2.52),
    (50, 300, 12.44, 3.26),
    (50, 600, 9.46, 2.50),
    (50, 900, 8.28, 2.44),
    (70, 300, 12.10, 3.12),
    (70, 600, 9.22, 2.52),
    (70, 900, 8.00, 2.34),
    (90, 300, 11.34, 3.34),
    (90, 600, 8.72, 2.42),
    (90, 900, 7.46, 2.14),
]


def test_the_refit_of_the_errata():
    width = wire.load("csw").width
    assert (f"{width.m:.3f}", f"{width.p:.3f}", f"{width.t:.4f}") == ("85.550", "52.742", "-1.7542")
    assert round(width.r_squared, 5) == 0.98023
    assert round(width.rmse, 4) == 0.2775


@pytest.mark.parametrize("column", [2, 3])
def test_a_second_solver_agrees(column):
    """scipy's least squares gives the coefficients of the model."""
    table = np.array(TABLE, float)
    fit = least_squares(
        lambda x: x[0] * table[:, 1] ** (-1 / 3) + x[1] / table[:, 0] + x[2] - table[:, column],
        [50.0, 10.0, 0.0],
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
        x_scale=[100.0, 50.0, 1.0],
    )
    model = wire.load("csw")
    ours = (model.width, model.height)[column - 2]
    np.testing.assert_allclose([ours.m, ours.p, ours.t], fit.x, rtol=1e-6)


def test_speed_and_width_are_inverse():
    model = wire.load("csw")
    rng = np.random.default_rng(1)
    speed, radius = rng.uniform(5.0, 15.0, 500), rng.uniform(30.0, 90.0, 500)
    width = model.widths(speed, radius)
    for v, r, w in zip(speed, radius, width):
        speeds = model.speed_for(w, np.array([r]))
        assert speeds.speed[0] == pytest.approx(v, rel=1e-12)
        assert not (speeds.too_slow[0] or speeds.too_fast[0] or speeds.too_tight[0])


def test_what_the_errata_say_of_9_5_mm():
    """Speeds of a 9.5 mm bead agree with the errata, and a bend tighter than the table is
    flagged."""
    model = wire.load("csw")
    speeds = model.speed_for(9.5, np.array([np.inf, 30.0, 10.0]))
    np.testing.assert_allclose(speeds.speed[:2] * 60.0, [439.0, 731.0], atol=0.6)
    assert speeds.too_tight.tolist() == [False, False, True]
    assert speeds.speed[2] == speeds.speed[1]
    # at constant wire feed a faster bead is lower
    straight, bend = model.heights(speeds.speed[:2], np.array([np.inf, 30.0]))
    assert bend < straight


def test_outside_the_table_the_speed_is_kept_within_and_flagged():
    """Outside the table the speed is clamped and flagged."""
    model = wire.load("csw")
    wide, narrow = model.speed_for(20.0, np.array([50.0])), model.speed_for(3.0, np.array([50.0]))
    assert (wide.speed[0], narrow.speed[0]) == (300.0 / 60.0, 900.0 / 60.0)
    assert (wide.too_slow[0], wide.too_fast[0], narrow.too_slow[0], narrow.too_fast[0]) == (
        True,
        False,
        False,
        True,
    )
    assert model.speed_for(0.1, np.array([40.0])).too_fast[
        0
    ]  # narrower than at any speed of the table


def columns(rows):
    table = np.array(rows, float).reshape(-1, 4)
    return table[:, 0], table[:, 1] / 60.0, table[:, 2], table[:, 3]


@pytest.mark.parametrize(
    "rows, code",
    [
        (TABLE[:3], "TOO_FEW_ROWS"),
        ([], "TOO_FEW_ROWS"),
        (TABLE[::3], "COLLINEAR_TABLE"),
        (TABLE[:3] + TABLE[:3], "COLLINEAR_TABLE"),
        (TABLE[:-1] + [(90, 900, -7.46, 2.14)], "BAD_TABLE"),
        (TABLE[:-1] + [(0, 900, 7.46, 2.14)], "BAD_TABLE"),
        (TABLE[:-1] + [(90, float("nan"), 7.46, 2.14)], "BAD_TABLE"),
        ([(r, 1200 - v, w, h) for r, v, w, h in TABLE], "NO_MODEL"),
        ([(math.inf, 300, w, h) for _, _, w, h in TABLE], "COLLINEAR_TABLE"),
    ],
)
def test_tables_that_are_none(rows, code):
    with pytest.raises(InputError) as caught:
        fit(*columns(rows), 100.0, "table.csv")
    assert caught.value.code == code


@pytest.mark.parametrize(
    "rows, told",
    [
        (TABLE[:1], "the bead table has 1 row; measure at least 4 beads"),
        (
            TABLE[:3] + TABLE[:3],
            "all beads have the radius 30 mm; measure at least two speeds and two radii",
        ),
        (TABLE[1::3], "all beads have the travel speed 600 mm/min; measure"),
        (
            [(30, 300, 12, 3), (30, 300, 12.5, 3), (60, 600, 9, 2.5), (60, 600, 9.5, 2.6)],
            "speeds and radii vary only together;",
        ),
        (
            TABLE[:-1] + [(90, -300, 7.46, 2.14)],
            "travel speed -300 mm/min is not a positive number; correct or remove",
        ),
        (TABLE[:-1] + [(-90, 300, 7.46, 2.14)], "radius -90 mm is not"),
        (TABLE[:-1] + [(90, 300, 7.46, -2.5)], "height -2.5 mm is not"),
    ],
)
def test_tables_that_are_none_are_told_in_the_units_of_the_table(rows, told):
    with pytest.raises(InputError) as caught:
        fit(*columns(rows), 100.0, "table.csv")
    assert caught.value.message.startswith(told) and caught.value.where == (
        "table.csv row 12" if "positive" in caught.value.message else "table.csv"
    )


def test_the_height_of_beads_of_one_section():
    """Height times width is the section of a straight bead wherever the wire feed follows the
    speed: the deposited volume equals the wire volume, whatever the bends."""
    model = wire.load("csw")
    rng = np.random.default_rng(8)
    widths = rng.uniform(7.0, 13.0, 200)
    heights = model.heights_of_section(widths, 9.5)
    straight = model.straight_speed(9.5)
    assert straight * 60.0 == pytest.approx((model.width.m / (9.5 - model.width.t)) ** 3, rel=1e-12)
    section = 9.5 * float(model.height.value_at(np.array([straight]), np.array([np.inf]))[0])
    np.testing.assert_allclose(heights * widths, section, rtol=1e-12)
    # a width outside the table uses the section of the widest straight bead in it
    slow = model.heights_of_section(widths, 50.0) * widths
    slowest = np.array([5.0]), np.array([np.inf])
    np.testing.assert_allclose(
        slow, float(model.heights(*slowest)[0] * model.widths(*slowest)[0]), rtol=1e-12
    )


HEAD = "radius_mm,travel_speed_mm_min,width_mm,height_mm,wire_feed_m_min\n"


@pytest.mark.parametrize(
    "text, told",
    [
        ("radius_mm,width_mm\n1,2\n", "travel_speed_mm_min"),
        ("", "radius_mm"),
        (HEAD + '30,300,12,3,6.5\n30,"4,5",12,3,6.5\n', "row 2"),
        (
            HEAD + "# a remark\n\n30,300,12,3,6.5\n30,,12,3,6.5\n",
            r"row 2 \(line 5\): there is no travel_speed_mm_min; correct",
        ),
        (
            HEAD + "30,300,12,3,6.5\n30,300,12,5,3,6.5\n",
            r"row 2 \(line 3\): the row has more values than columns",
        ),
        (
            HEAD + "30,300,12,3,6.5\n30,300,12,3,-6.5\n",
            r"row 2 \(line 3\): wire feed -6.5 m/min is not a positive number",
        ),
        (
            HEAD
            + "\n".join(f"{r},{v},{w},{h},6.5" for r, v, w, h in TABLE).replace(
                "50,600", "50,-600"
            ),
            r"row 5 \(line 6\): travel speed -600 mm/min is not",
        ),
    ],
)
def test_files_that_are_no_table(tmp_path, text, told):
    (tmp_path / "mine.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=told) as caught:
        wire.load("mine.csv", tmp_path)
    assert caught.value.code == "BAD_TABLE"


def test_a_table_of_the_users_own(tmp_path):
    head = "# laid on a Monday\nwidth_mm,radius_mm,height_mm,travel_speed_mm_min,wire_feed_m_min\n"
    (tmp_path / "mine.csv").write_text(
        head + "".join(f"{w},{r},{h},{v},6.5\n" for r, v, w, h in TABLE), encoding="utf-8"
    )
    assert wire.load("mine.csv", tmp_path) == wire.load("csw")
    with pytest.raises(InputError) as caught:
        wire.load("other.csv", tmp_path)
    assert caught.value.code == "NO_FILE"
    (tmp_path / "bin.csv").write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match="not UTF-8 text") as caught:
        wire.load("bin.csv", tmp_path)
    assert caught.value.code == "BAD_TABLE" and caught.value.where == "bin.csv"


def test_beads_that_all_get_the_same_wire_to_a_millimetre_are_no_table(tmp_path):
    rows = "".join(
        f"inf,{100 * feed},{w},{h},{feed}\n" for feed, (_, _, w, h) in enumerate(TABLE, 5)
    )
    (tmp_path / "mine.csv").write_text(HEAD + rows, encoding="utf-8")
    with pytest.raises(InputError, match="the same wire length per millimetre") as caught:
        wire.load("mine.csv", tmp_path)
    assert caught.value.code == "COLLINEAR_TABLE"


@pytest.mark.parametrize("radius", [3.0, 30.0, 90.0])
def test_radius_of_circles(radius):
    angle = np.linspace(0.0, 2.0 * math.pi, 200)
    circle = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    circle[-1] = circle[0]
    np.testing.assert_allclose(model_notes.radii(circle, True, 0.5 * radius), radius, rtol=0.02)
    np.testing.assert_allclose(
        model_notes.radii(circle[:100], False, 0.5 * radius)[10:-10], radius, rtol=0.02
    )


def test_radius_of_a_straight_way_with_a_corner():
    points = np.array(
        [[x, 0.0] for x in np.linspace(-50, 0, 51)] + [[0.0, y] for y in np.linspace(1, 50, 50)]
    )
    radius = model_notes.radii(points, False, 8.0)
    assert np.isinf(radius[:40]).all() and np.isinf(radius[62:]).all()
    assert radius[50] == pytest.approx(8.0 / (math.pi / 2.0), rel=0.02)


def test_speeds_a_machine_can_follow():
    """Speeds respect the acceleration limit and are as high as it allows."""
    rng = np.random.default_rng(3)
    points = np.cumsum(rng.uniform(0.1, 2.0, (300, 2)), axis=0)
    points = np.vstack([points, points[:1]])
    requested = rng.uniform(5.0, 15.0, 301)
    requested[-1] = requested[0]
    for closed in (True, False):
        got = model_notes.limit_acceleration(points, requested, closed, 20.0)
        step = np.linalg.norm(np.diff(points, axis=0), axis=1)
        assert (got <= requested).all()
        assert (np.abs(np.diff(got**2)) <= 2.0 * 20.0 * step + 1e-9).all()
        # none could be higher: each is limited by its request or by a neighbour
        reaches_request = np.isclose(got, requested)
        for k in np.flatnonzero(~reaches_request):
            sides = [j for j in (k - 1, k + 1) if 0 <= j < len(got)]
            by_neighbour = [
                np.isclose(got[k] ** 2 - got[j] ** 2, 40.0 * step[min(j, k)]) for j in sides
            ]
            assert any(by_neighbour) or k in (0, len(got) - 1)
        if closed:
            assert got[0] == pytest.approx(got[-1])


@pytest.mark.parametrize(
    ("head", "words"),
    [
        (HEAD.replace("\n", ",posture_deg\n"), "unknown column 'posture_deg'"),
        (HEAD.replace("\n", ",width_mm\n"), "'width_mm' appears twice"),
        (HEAD.replace("radius_mm", "radius_in"), "unknown column 'radius_in'"),
    ],
)
def test_columns_that_would_be_lost_are_rejected(tmp_path, head, words):
    rows = "".join(f"{r},{v},{w},{h},6.5,9\n" for r, v, w, h in TABLE)
    (tmp_path / "mine.csv").write_text(head + rows, encoding="utf-8")
    with pytest.raises(InputError, match=words) as caught:
        wire.load("mine.csv", tmp_path)
    assert caught.value.code == "BAD_TABLE" and caught.value.where == "mine.csv line 1"


def test_semicolons_and_a_byte_order_mark_are_read_and_decimal_commas_are_not(tmp_path):
    rows = "".join(f"{r},{v},{w},{h},6.5\n" for r, v, w, h in TABLE)
    (tmp_path / "mine.csv").write_text("\ufeff" + (HEAD + rows).replace(",", ";"), encoding="utf-8")
    assert wire.load("mine.csv", tmp_path) == wire.load("csw")
    text = (HEAD + rows).replace(",", ";").replace("12.52", "12,52")
    (tmp_path / "mine.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="'12,52' is not a number"):
        wire.load("mine.csv", tmp_path)


def straight_table(tmp_path, extra_rows):
    rows = [
        "inf,300,9,3,6.5",
        "inf,600,7,2.5,6.5",
        "inf,900,6,2,6.5",
        "inf,1200,5.4,1.8,6.5",
        *extra_rows,
    ]
    (tmp_path / "mine.csv").write_text(HEAD + "\n".join(rows) + "\n", encoding="utf-8")
    return wire.load("mine.csv", tmp_path)


def test_rows_that_contradict_each_other_are_named(tmp_path):
    assert straight_table(tmp_path, ["inf,600,7.4,2.6,6.5"]).contradictions == ()
    assert straight_table(tmp_path, ["40,600,4,1,6.5", "60,600,9,2.5,6.5"]).contradictions == ()
    (pair,) = straight_table(tmp_path, ["inf,600,4,2.4,6.5"]).contradictions
    assert "row 5 (line 6)" in pair and "row 2 (line 3)" in pair and "width 4 and 7 mm" in pair


def test_a_table_of_straight_beads_says_nothing_of_bends(tmp_path):
    model = straight_table(tmp_path, [])
    assert not model.speed_for(7.0, np.array([3.0, 50.0, np.inf])).too_tight.any()
    assert wire.load("csw").speed_for(9.0, np.array([3.0, 50.0])).too_tight.tolist() == [
        True,
        False,
    ]


def refused_table(tmp_path, rows):
    (tmp_path / "mine.csv").write_text(HEAD + "\n".join(rows) + "\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        wire.load("mine.csv", tmp_path)
    return caught.value.code, str(caught.value.message)


def test_a_table_that_contradicting_rows_spoil_is_refused_for_these(tmp_path):
    """The message names the contradicting rows instead of claiming that beads get wider with
    speed."""
    rows = ["inf,300,4,3,6.5", "inf,300,10,3,6.5", "inf,600,7.5,2.5,6.5", "inf,900,7.2,2,6.5"]
    code, message = refused_table(tmp_path, rows)
    assert code == "TABLE_CONTRADICTS"
    assert "row 1 (line 2) and row 2 (line 3) (width 4 and 10 mm)" in message
    wider = ["inf,300,6,3,6.5", "inf,300,6.1,3,6.5", "inf,600,7.5,2.5,6.5", "inf,900,8,2,6.5"]
    code, message = refused_table(tmp_path, wider)
    assert code == "NO_MODEL" and "increases with speed" in message


def test_a_table_of_one_speed_names_its_contradicting_rows_too(tmp_path):
    rows = ["inf,300,4,3,6.5", "inf,300,10,3,6.5", "inf,300,7,3,6.5", "inf,300,7.1,3,6.5"]
    code, message = refused_table(tmp_path, rows)
    assert code == "COLLINEAR_TABLE" and "all beads have the travel speed 300 mm/min" in message
    assert "row 1 (line 2) and row 2 (line 3) (width 4 and 10 mm)" in message
