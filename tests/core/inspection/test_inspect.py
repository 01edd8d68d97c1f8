# SPDX-License-Identifier: LGPL-2.1-or-later
"""Synthetic scans with a known truth: inspection recovers motions, deviations, roundness and
thickness."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.inspection import bands, figures, point_file, table
from freecad_am.core.inspection.figures import narrowest
from freecad_am.core.inspection.inspect import inspect
from freecad_am.core.inspection.planned import revolution_surface, triangle_surface
from freecad_am.core.issues import AmError, InputError
from freecad_am.core.parameters.inspection import InspectionParameters
from tests.core.inspection_parts import (
    R0,
    apply_motion,
    funnel,
    hemisphere,
    random_motion,
    sampled,
    scan,
)

EXAMPLES = Path(__file__).resolve().parents[3] / "resources" / "examples"


def inspected(points, surface, **parameters):
    return inspect(
        scan(points), surface, InspectionParameters(**parameters), lambda share, text: None
    )


def codes(result):
    return [issue.code for issue in result.issues]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.always("0")
def test_any_attitude_is_found_to_within_the_noise_over_the_root_of_the_points(seed):
    """The fit recovers any attitude to within the noise divided by the root of the number of
    points."""
    rng = np.random.default_rng(seed)
    wall, noise, count = funnel(), 0.03, 4000
    points, normal = sampled(wall, rng, count)
    by = random_motion(rng, rng.uniform(0.5, 3.0), 400.0)
    result = inspected(
        apply_motion(points + normal * rng.normal(0.0, noise, (count, 1)), by),
        revolution_surface(wall),
    )
    residual_motion = result.motion @ by
    axis = residual_motion[:3, :3] @ wall.frame[:3, 2]
    bound = 8.0 * noise / np.sqrt(count)
    assert np.abs(axis - wall.frame[:3, 2]).max() < bound / 20.0
    origin = apply_motion(wall.frame[None, :3, 3], residual_motion)[0]
    assert np.abs(origin - wall.frame[:3, 3]).max() < 3.0 * bound
    assert (
        result.spread.deviation == pytest.approx(noise, rel=0.05)
        and abs(result.spread.mean) < bound
    )
    assert len(result.free) == 1 and "FREE_MOTION" in codes(
        result
    )  # rotation about its axis remains free


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.always("0")
def test_a_few_turns_of_a_dome_tell_where_it_is_with_outliers_and_a_ball(seed):
    """A few turns around a dome determine its position despite outliers and a probe ball."""
    rng = np.random.default_rng(10 + seed)
    wall, noise, count = hemisphere(), 0.02, 3000
    points, normal = sampled(wall, rng, count, 0.1, 0.6)
    outliers = rng.permutation(count)[:150]
    scanned = points + normal * (rng.normal(0.0, noise, count) + 1.5)[:, None]
    scanned[outliers] += rng.uniform(3.0, 12.0, (150, 1)) * normal[outliers]
    by = random_motion(rng, 0.1, 6.0)
    result = inspected(
        apply_motion(scanned, by), revolution_surface(wall), probe_radius=1.5, trim=0.08
    )
    centre = apply_motion(np.zeros((1, 3)), result.motion @ by)[0]
    assert np.abs(centre).max() < 12.0 * noise / np.sqrt(count)
    inliers = np.setdiff1d(np.arange(count), outliers)
    assert (
        np.abs(result.deviation[inliers]).max() < 6.0 * noise
        and result.deviation[outliers].min() > 2.5
    )
    assert not result.fitted[outliers].any() and "LEFT_OUT" in codes(result)
    assert np.abs(np.linalg.norm(result.points[inliers] - centre, axis=1) - R0).max() < 6.0 * noise


def test_what_deviations_do_not_feel_stays_as_it_was_measured():
    """A shift along a free motion keeps the measured attitude."""
    rng = np.random.default_rng(20)
    points, _ = sampled(hemisphere(), rng, 2000, 0.2, 0.7)
    result = inspected(points + [3.0, -2.0, 1.0], revolution_surface(hemisphere()))
    assert np.abs(result.motion[:3, :3] - np.eye(3)).max() < 1e-6
    assert result.motion[:3, 3] == pytest.approx([-3.0, 2.0, -1.0], abs=1e-6)
    assert [
        issue.message.split(" changes")[0] for issue in result.issues if issue.code == "FREE_MOTION"
    ] == ["a rotation about the centre of the sphere"]


def box():
    corners = np.array(
        [[x, y, z] for x in (-30.0, 30.0) for y in (-20.0, 20.0) for z in (0.0, 20.0)]
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    share = np.random.default_rng(0).dirichlet((1.0, 1.0, 1.0), (12, 150))
    points = np.einsum("tkc,tcx->tkx", share, corners[triangles]).reshape(-1, 3)
    return triangle_surface("box", corners, triangles), points


def rotate(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T


def test_a_fit_may_be_held_to_shifts_to_an_axis_or_to_nothing():
    """A fit may be restricted to shifts, to an axis, or omitted."""
    surface, points = box()
    shifted = inspected(points + [1.0, -2.0, 0.5], surface, fit="shift")
    assert (shifted.motion[:3, :3] == np.eye(3)).all()
    assert shifted.motion[:3, 3] == pytest.approx([-1.0, 2.0, -0.5], abs=1e-7)
    tilted = inspected(rotate(points, 0.05), surface, fit="shift")
    assert (tilted.motion[:3, :3] == np.eye(3)).all() and tilted.spread.rms > 0.3
    axis = inspected(rotate(points, 0.05) + [0.0, 0.0, 2.0], surface, fit="axis")
    assert np.abs(axis.points - points).max() < 1e-6
    beside = inspected(rotate(points, 0.05) + [1.0, 0.0, 2.0], surface, fit="axis")
    assert beside.motion[:2, 3] == pytest.approx(0.0, abs=1e-12)
    assert beside.motion[2, :3] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    unfitted = inspected(points + [0.0, 0.0, 0.3], surface, fit="none")
    assert (unfitted.motion == np.eye(4)).all()
    assert unfitted.spread.most == pytest.approx(
        0.3, abs=1e-9
    ) and unfitted.spread.least == pytest.approx(-0.3, abs=1e-9)


def test_pairs_of_points_tell_which_way_round_a_box_is():
    """Pairs of points determine the orientation of a box."""
    surface, points = box()
    rng = np.random.default_rng(21)
    by = random_motion(rng, 3.0, 700.0)
    indices = rng.permutation(len(points))[:4]
    pairs = "; ".join(
        " ".join(f"{v:.2f}" for v in measured) + " > " + " ".join(f"{v:.2f}" for v in planned)
        for measured, planned in zip(
            apply_motion(points[indices], by), points[indices], strict=True
        )
    )
    result = inspected(apply_motion(points, by), surface, pairs=pairs)
    assert np.abs(result.points - points).max() < 1e-6


def test_points_past_the_edge_count_nowhere():
    """Points beyond the edge are excluded from fit and figures."""
    rng = np.random.default_rng(22)
    points, _ = sampled(hemisphere(), rng, 1500)
    angle = rng.uniform(0.0, 2.0 * np.pi, 300)
    plate = np.column_stack([60.0 * np.cos(angle), 60.0 * np.sin(angle), np.full(300, -1.0)])
    result = inspected(np.concatenate([points, plate]), revolution_surface(hemisphere()), trim=0.2)
    assert result.counted[:1500].all() and not result.counted[1500:].any()
    assert result.spread.count == 1500 and np.abs(result.deviation[:1500]).max() < 1e-6
    assert "PAST_EDGES" in codes(result)


def test_circles_of_known_ovality_eccentricity_and_diameter():
    wall = funnel()
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    rows = []
    for height, oval in ((10.0, 0.1), (25.0, 0.0), (40.0, 0.3)):
        radius = wall.meridian.at(wall.meridian.s_at_height([height])[0])[0][0]
        rows.append(wall.points(radius + oval * np.cos(2.0 * angle), np.full(400, height), angle))
    points = np.concatenate(rows) + 0.05 * wall.frame[:3, 0]
    result = inspected(points, revolution_surface(wall), fit="none", heights=("10", "25", "40"))
    assert [circle.zone.zone for circle in result.circles] == pytest.approx(
        [0.2, 0.0, 0.6], abs=2e-3
    )
    assert [circle.eccentricity for circle in result.circles] == pytest.approx([0.05] * 3, abs=1e-3)
    assert [circle.fitted.radius for circle in result.circles] == pytest.approx(
        [wall.meridian.at(wall.meridian.s_at_height([h])[0])[0][0] for h in (10.0, 25.0, 40.0)],
        abs=2e-3,
    )
    assert result.ball is None


@pytest.mark.parametrize("with_wall", [True, False])
def test_points_of_a_band_are_slid_to_its_height(with_wall):
    """A perfect dome has round circles at every height, because points of a band are shifted to its
    height."""
    rng = np.random.default_rng(23)
    points, normal = sampled(hemisphere(), rng, 20000, 0.1, 0.8)
    surface = revolution_surface(hemisphere())
    if not with_wall:
        surface = type(surface)(
            surface.name,
            surface.nearest,
            surface.exact,
            surface.past,
            surface.spread,
            surface.frame,
        )
    for height in (15.0, 25.0, 35.0):
        circle_fit = figures.circle(surface, points, normal, height, 0.5, "scan")
        assert circle_fit.zone.zone < (1e-6 if with_wall else 0.02)
        assert circle_fit.fitted.radius == pytest.approx(
            np.sqrt(R0**2 - height**2), abs=1e-6 if with_wall else 0.01
        )
        assert circle_fit.count > 100


def test_thickness_where_both_sides_were_measured():
    rng = np.random.default_rng(24)
    points, normal = sampled(hemisphere(), rng, 6000, 0.0, 0.9)
    outside = np.arange(6000) % 2 == 0
    scanned = points + np.where(outside, 1.6, -1.45)[:, None] * normal
    result = inspected(
        scanned, revolution_surface(hemisphere()), side="both", thickness=3.0, fit="none"
    )
    assert (
        result.thickness.mean == pytest.approx(3.05, abs=1e-6) and result.thickness.deviation < 1e-6
    )
    assert result.spread.most == pytest.approx(
        0.1, abs=1e-7
    ) and result.spread.least == pytest.approx(-0.05, abs=1e-7)
    assert result.thickness.count > 500


def example():
    spec = importlib.util.spec_from_file_location(
        "inspection_points", EXAMPLES / "inspection_points.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_example_is_what_its_script_makes_in_the_pattern_of_the_paper():
    """The example file equals the output of its script and follows the paper's pattern."""
    script = example()
    path = EXAMPLES / "inspection" / "hemisphere-synthetic.csv"
    assert (
        path.read_text(encoding="utf-8") == script.text()
        and "SYNTHETIC" in script.text().splitlines()[0]
    )
    height, azimuth = script.pattern()
    helix = np.flatnonzero(height == 15.0)[0]
    assert (height[0], azimuth[0]) == (10.0, 0.0) and height[:helix].max() <= 40.0
    assert azimuth[:helix].max() == pytest.approx(20.0 * np.pi, abs=0.05)  # ten turns
    radius = np.sqrt(R0**2 - height**2)
    points = np.column_stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height])
    assert np.linalg.norm(np.diff(points[:helix], axis=0), axis=1) == pytest.approx(0.5, abs=1e-3)


def test_the_example_gives_back_the_deviations_that_were_put_in():
    """The inspection of the example recovers the deviations of the script."""
    script = example()
    height, azimuth = script.pattern()
    deviations = script.deviations(height, azimuth, np.random.default_rng(script.SEED))
    result = inspect(
        point_file.read(EXAMPLES / "inspection" / "hemisphere-synthetic.csv"),
        revolution_surface(hemisphere()),
        InspectionParameters(probe_radius=1.5, tolerance=0.1, heights=("15", "25", "35")),
        lambda *_: None,
    )
    radius = np.sqrt(R0**2 - height**2)
    normal = np.column_stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height]) / R0
    truth = normal * (R0 + deviations)[:, None]
    # the fit removes the share that a shift of the sphere explains
    shift = np.linalg.lstsq(normal, deviations, rcond=None)[0]
    assert np.abs(result.deviation - (deviations - normal @ shift)).max() < 2e-3
    assert result.ball.zone.zone == pytest.approx(figures.zone_of(truth, "truth").zone, abs=1e-3)
    for circle in result.circles:
        ring = height == circle.height
        ring_points = (
            truth[ring][:, :2]
            * ((radius[ring] + deviations[ring]) / np.linalg.norm(truth[ring][:, :2], axis=1))[
                :, None
            ]
        )
        assert circle.zone.zone >= narrowest(ring_points, "ring").zone - 0.02 and circle.gap < 0.1
        assert circle.count >= ring.sum()


def test_many_points_have_the_narrowest_zone_of_all():
    rng = np.random.default_rng(25)
    direction = rng.normal(size=(20000, 2))
    points = direction * ((30.0 + rng.normal(0.0, 0.1, 20000)) / np.linalg.norm(direction, axis=1))[
        :, None
    ] + [4.0, 5.0]
    fast = figures.zone_of(points, "scan")
    distance = np.linalg.norm(points - fast.centre, axis=1)
    assert (fast.inner, fast.outer) == pytest.approx((distance.min(), distance.max()), abs=1e-12)
    assert fast.zone == pytest.approx(narrowest(points, "scan").zone, abs=1e-9)


def test_figures_of_deviations_are_those_of_their_definitions():
    """Figures of deviations agree with their definitions."""
    deviation = np.random.default_rng(26).normal(0.02, 0.1, 5000)
    summary = figures.summarise(deviation, 0.1)
    assert (summary.mean, summary.deviation) == pytest.approx((deviation.mean(), deviation.std()))
    assert summary.rms**2 == pytest.approx(summary.mean**2 + summary.deviation**2)
    amount = np.sort(np.abs(deviation))
    assert amount[4749] <= summary.within_95 <= amount[4750]
    assert summary.within == (np.abs(deviation) <= 0.1).mean()
    assert summary.counts.sum() == 5000 and (np.diff(summary.edges) > 0.0).all()
    assert figures.summarise(np.full(7, 0.3), 0.1).counts.sum() == 7
    for offset in (1e6, -1e6, 1e12):  # a scan in a different place, all points equally far away
        uniform = figures.summarise(np.full(7, offset), 0.1)
        assert (
            uniform.counts.sum() == 7
            and (np.diff(uniform.edges) > 0.0).all()
            and uniform.edges[0] <= offset <= uniform.edges[-1]
        )


def test_bands_are_alike_on_both_sides_and_green_within():
    deviation = np.array([-1.0, -0.25, -0.15, -0.1, 0.0, 0.1, 0.15, 0.25, 1.0])
    number = bands.band_of(deviation, 0.1)
    assert list(number) == [0, 1, 2, 3, 3, 3, 4, 5, 6] and (number + number[::-1] == 6).all()
    texts = [band.text for band in bands.bands(0.1)]
    assert texts[3] == "within ±0.1" and texts[0] == "< -0.3" and texts[6] == "> 0.3"
    colours = bands.colours(deviation, np.arange(9) != 8, 0.1)
    assert (colours[8] == bands.PAST_EDGES).all() and colours[4][1] > colours[4][[0, 2]].max()


def test_the_table_has_a_column_for_each_part_and_their_spread():
    """The table has a column for each part, and the spread over the parts."""
    rng = np.random.default_rng(27)
    points, normal = sampled(hemisphere(), rng, 1500, 0.1, 0.7)
    dome = revolution_surface(hemisphere())
    results = [
        inspected(points + normal * rng.normal(0.0, noise, (1500, 1)), dome) for noise in (0.1, 0.2)
    ]
    by_name = {
        name: (values, mean, deviation)
        for name, _, values, mean, deviation in table.compared(results)
    }
    values, mean, deviation = by_name["Spherical defect"]
    assert values == [result.ball.zone.zone for result in results]
    assert mean == pytest.approx(np.mean(values)) and deviation == pytest.approx(
        abs(values[1] - values[0]) / np.sqrt(2.0)
    )
    data = table.as_data(results[0])
    assert (
        data["sphericity_mm"]["minimum_zone"] == values[0]
        and sum(data["histogram"]["counts"]) == data["counted"]
    )
    lines = list(table.deviations(results[0]))
    assert len(lines) == 1501 and float(lines[7].split(",")[3]) == pytest.approx(
        results[0].deviation[6], abs=1e-6
    )


@pytest.mark.parametrize(
    ("values", "where"),
    [
        ({"heights": ("high",)}, "inspection.heights"),
        ({"pairs": "1 2 3"}, "inspection.pairs"),
        ({"side": "both"}, "inspection.thickness"),
        ({"tolerance": 0.0}, "inspection.tolerance"),
        ({"trim": 0.6}, "inspection.trim"),
    ],
)
def test_parameters_that_make_no_sense_are_refused_by_name(values, where):
    with pytest.raises(InputError) as caught:
        InspectionParameters(**values)
    assert caught.value.where == where


def test_points_of_something_else_are_refused_or_told():
    """Points of another object are rejected or reported."""
    points_off_part = np.random.default_rng(28).uniform(-1.0, 1.0, (200, 3)) + [0.0, 0.0, -500.0]
    with pytest.raises(AmError) as caught:
        inspected(points_off_part, revolution_surface(hemisphere()), fit="none")
    assert caught.value.code == "NOT_ON_PART" and "hemisphere" in caught.value.message
    with pytest.raises(InputError) as caught:
        inspected(np.zeros((3, 3)), revolution_surface(hemisphere()))
    assert caught.value.code in ("TOO_FEW_POINTS", "NOT_ON_PART")
    points, _ = sampled(hemisphere(), np.random.default_rng(29), 500, 0.3, 0.5)
    result = inspected(points, revolution_surface(hemisphere()), heights=("44",))
    assert "FEW_POINTS" in codes(result) and result.circles == ()


@pytest.mark.parametrize("unit", [1.0, 10.0, 25.4, 1000.0])
@pytest.mark.always("25.4", "1.0")
def test_points_in_another_unit_fit_anywhere_which_is_told(unit):
    """A cap in millimetres fits a dome in centimetres, so the deviations alone would look good; the
    unit is questioned."""
    wall = hemisphere()
    points, _ = sampled(wall, np.random.default_rng(3), 500)
    result = inspected(points / unit, revolution_surface(wall))
    assert ("SMALL" in codes(result)) == (unit > 1.0)
    messages = [issue.message for issue in result.issues if issue.code == "SMALL"]
    assert all("check the unit of the file" in text for text in messages)


def test_three_points_are_told_to_be_too_few():
    with pytest.raises(InputError, match="3 points cannot locate a part") as caught:
        inspected(np.eye(3) * R0, revolution_surface(hemisphere()))
    assert caught.value.code == "TOO_FEW_POINTS"
