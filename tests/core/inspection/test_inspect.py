# SPDX-License-Identifier: LGPL-2.1-or-later
"""Synthetic scans with a known truth: motions, deviations, roundness and thickness are found again."""

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
from tests.core.inspection_parts import R0, away, funnel, hemisphere, moved, sampled, scan

EXAMPLES = Path(__file__).resolve().parents[3] / "resources" / "examples"


def inspected(points, of, **parameters):
    return inspect(scan(points), of, InspectionParameters(**parameters), lambda share, text: None)


def codes(found):
    return [issue.code for issue in found.issues]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.always("0")
def test_any_attitude_is_found_to_within_the_noise_over_the_root_of_the_points(seed):
    rng = np.random.default_rng(seed)
    wall, noise, count = funnel(), 0.03, 4000
    points, normal = sampled(wall, rng, count)
    by = away(rng, rng.uniform(0.5, 3.0), 400.0)
    found = inspected(
        moved(points + normal * rng.normal(0.0, noise, (count, 1)), by), revolution_surface(wall)
    )
    whole = found.motion @ by
    axis = whole[:3, :3] @ wall.frame[:3, 2]
    bound = 8.0 * noise / np.sqrt(count)
    assert np.abs(axis - wall.frame[:3, 2]).max() < bound / 20.0
    origin = moved(wall.frame[None, :3, 3], whole)[0]
    assert np.abs(origin - wall.frame[:3, 3]).max() < 3.0 * bound
    assert (
        found.spread.deviation == pytest.approx(noise, rel=0.05) and abs(found.spread.mean) < bound
    )
    assert len(found.free) == 1 and "FREE_MOTION" in codes(found)  # it may turn about its axis


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.always("0")
def test_a_few_turns_of_a_dome_tell_where_it_is_with_outliers_and_a_ball(seed):
    rng = np.random.default_rng(10 + seed)
    wall, noise, count = hemisphere(), 0.02, 3000
    points, normal = sampled(wall, rng, count, 0.1, 0.6)
    far = rng.permutation(count)[:150]
    scanned = points + normal * (rng.normal(0.0, noise, count) + 1.5)[:, None]
    scanned[far] += rng.uniform(3.0, 12.0, (150, 1)) * normal[far]
    by = away(rng, 0.1, 6.0)
    found = inspected(moved(scanned, by), revolution_surface(wall), probe_radius=1.5, trim=0.08)
    centre = moved(np.zeros((1, 3)), found.motion @ by)[0]
    assert np.abs(centre).max() < 12.0 * noise / np.sqrt(count)
    kept = np.setdiff1d(np.arange(count), far)
    assert np.abs(found.deviation[kept]).max() < 6.0 * noise and found.deviation[far].min() > 2.5
    assert not found.fitted[far].any() and "LEFT_OUT" in codes(found)
    assert np.abs(np.linalg.norm(found.points[kept] - centre, axis=1) - R0).max() < 6.0 * noise


def test_what_deviations_do_not_feel_stays_as_it_was_measured():
    rng = np.random.default_rng(20)
    points, _ = sampled(hemisphere(), rng, 2000, 0.2, 0.7)
    found = inspected(points + [3.0, -2.0, 1.0], revolution_surface(hemisphere()))
    assert np.abs(found.motion[:3, :3] - np.eye(3)).max() < 1e-6
    assert found.motion[:3, 3] == pytest.approx([-3.0, 2.0, -1.0], abs=1e-6)
    assert [
        issue.message.split(" changes")[0] for issue in found.issues if issue.code == "FREE_MOTION"
    ] == ["turning it about the centre of the sphere"]


def box():
    corners = np.array(
        [[x, y, z] for x in (-30.0, 30.0) for y in (-20.0, 20.0) for z in (0.0, 20.0)]
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    share = np.random.default_rng(0).dirichlet((1.0, 1.0, 1.0), (12, 150))
    points = np.einsum("tkc,tcx->tkx", share, corners[triangles]).reshape(-1, 3)
    return triangle_surface("box", corners, triangles), points


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T


def test_a_fit_may_be_held_to_shifts_to_an_axis_or_to_nothing():
    of, points = box()
    shifted = inspected(points + [1.0, -2.0, 0.5], of, fit="shift")
    assert (shifted.motion[:3, :3] == np.eye(3)).all()
    assert shifted.motion[:3, 3] == pytest.approx([-1.0, 2.0, -0.5], abs=1e-7)
    tilted = inspected(turned(points, 0.05), of, fit="shift")
    assert (tilted.motion[:3, :3] == np.eye(3)).all() and tilted.spread.rms > 0.3
    axis = inspected(turned(points, 0.05) + [0.0, 0.0, 2.0], of, fit="axis")
    assert np.abs(axis.points - points).max() < 1e-6
    beside = inspected(turned(points, 0.05) + [1.0, 0.0, 2.0], of, fit="axis")
    assert beside.motion[:2, 3] == pytest.approx(0.0, abs=1e-12)
    assert beside.motion[2, :3] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    held = inspected(points + [0.0, 0.0, 0.3], of, fit="none")
    assert (held.motion == np.eye(4)).all()
    assert held.spread.most == pytest.approx(0.3, abs=1e-9) and held.spread.least == pytest.approx(
        -0.3, abs=1e-9
    )


def test_pairs_of_points_tell_which_way_round_a_box_is():
    of, points = box()
    rng = np.random.default_rng(21)
    by = away(rng, 3.0, 700.0)
    chosen = rng.permutation(len(points))[:4]
    pairs = "; ".join(
        " ".join(f"{v:.2f}" for v in one) + " > " + " ".join(f"{v:.2f}" for v in other)
        for one, other in zip(moved(points[chosen], by), points[chosen], strict=True)
    )
    found = inspected(moved(points, by), of, pairs=pairs)
    assert np.abs(found.points - points).max() < 1e-6


def test_points_past_the_edge_count_nowhere():
    rng = np.random.default_rng(22)
    points, _ = sampled(hemisphere(), rng, 1500)
    angle = rng.uniform(0.0, 2.0 * np.pi, 300)
    plate = np.column_stack([60.0 * np.cos(angle), 60.0 * np.sin(angle), np.full(300, -1.0)])
    found = inspected(np.concatenate([points, plate]), revolution_surface(hemisphere()), trim=0.2)
    assert found.counted[:1500].all() and not found.counted[1500:].any()
    assert found.spread.count == 1500 and np.abs(found.deviation[:1500]).max() < 1e-6
    assert "PAST_EDGES" in codes(found)


def test_circles_of_known_ovality_eccentricity_and_diameter():
    wall = funnel()
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    rows = []
    for height, oval in ((10.0, 0.1), (25.0, 0.0), (40.0, 0.3)):
        radius = wall.meridian.at(wall.meridian.s_at_height([height])[0])[0][0]
        rows.append(wall.points(radius + oval * np.cos(2.0 * angle), np.full(400, height), angle))
    points = np.concatenate(rows) + 0.05 * wall.frame[:3, 0]
    found = inspected(points, revolution_surface(wall), fit="none", heights=("10", "25", "40"))
    assert [one.zone.zone for one in found.circles] == pytest.approx([0.2, 0.0, 0.6], abs=2e-3)
    assert [one.eccentricity for one in found.circles] == pytest.approx([0.05] * 3, abs=1e-3)
    assert [one.fitted.radius for one in found.circles] == pytest.approx(
        [wall.meridian.at(wall.meridian.s_at_height([h])[0])[0][0] for h in (10.0, 25.0, 40.0)],
        abs=2e-3,
    )
    assert found.ball is None


@pytest.mark.parametrize("with_wall", [True, False])
def test_points_of_a_band_are_slid_to_its_height(with_wall):
    """A perfect dome scanned all over has round circles at every height, whatever the band."""
    rng = np.random.default_rng(23)
    points, normal = sampled(hemisphere(), rng, 20000, 0.1, 0.8)
    of = revolution_surface(hemisphere())
    if not with_wall:
        of = type(of)(of.name, of.nearest, of.exact, of.past, of.spread, of.frame)
    for height in (15.0, 25.0, 35.0):
        found = figures.circle(of, points, normal, height, 0.5, "scan")
        assert found.zone.zone < (1e-6 if with_wall else 0.02)
        assert found.fitted.radius == pytest.approx(
            np.sqrt(R0**2 - height**2), abs=1e-6 if with_wall else 0.01
        )
        assert found.count > 100


def test_thickness_where_both_sides_were_measured():
    rng = np.random.default_rng(24)
    points, normal = sampled(hemisphere(), rng, 6000, 0.0, 0.9)
    outside = np.arange(6000) % 2 == 0
    scanned = points + np.where(outside, 1.6, -1.45)[:, None] * normal
    found = inspected(
        scanned, revolution_surface(hemisphere()), side="both", thickness=3.0, fit="none"
    )
    assert (
        found.thickness.mean == pytest.approx(3.05, abs=1e-6) and found.thickness.deviation < 1e-6
    )
    assert found.spread.most == pytest.approx(
        0.1, abs=1e-7
    ) and found.spread.least == pytest.approx(-0.05, abs=1e-7)
    assert found.thickness.count > 500


def example():
    spec = importlib.util.spec_from_file_location(
        "inspection_points", EXAMPLES / "inspection_points.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_example_is_what_its_script_makes_in_the_pattern_of_the_paper():
    made = example()
    path = EXAMPLES / "inspection" / "hemisphere-synthetic.csv"
    assert (
        path.read_text(encoding="utf-8") == made.text()
        and "SYNTHETIC" in made.text().splitlines()[0]
    )
    height, azimuth = made.pattern()
    helix = np.flatnonzero(height == 15.0)[0]
    assert (height[0], azimuth[0]) == (10.0, 0.0) and height[:helix].max() <= 40.0
    assert azimuth[:helix].max() == pytest.approx(20.0 * np.pi, abs=0.05)  # ten turns
    radius = np.sqrt(R0**2 - height**2)
    points = np.column_stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height])
    assert np.linalg.norm(np.diff(points[:helix], axis=0), axis=1) == pytest.approx(0.5, abs=1e-3)


def test_the_example_gives_back_the_deviations_that_were_put_in():
    made = example()
    height, azimuth = made.pattern()
    put_in = made.deviations(height, azimuth, np.random.default_rng(made.SEED))
    found = inspect(
        point_file.read(EXAMPLES / "inspection" / "hemisphere-synthetic.csv"),
        revolution_surface(hemisphere()),
        InspectionParameters(probe_radius=1.5, tolerance=0.1, heights=("15", "25", "35")),
        lambda *_: None,
    )
    radius = np.sqrt(R0**2 - height**2)
    normal = np.column_stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height]) / R0
    truth = normal * (R0 + put_in)[:, None]
    # the fit takes out of them what a shift of the sphere is
    shift = np.linalg.lstsq(normal, put_in, rcond=None)[0]
    assert np.abs(found.deviation - (put_in - normal @ shift)).max() < 2e-3
    assert found.ball.zone.zone == pytest.approx(figures.zone_of(truth, "truth").zone, abs=1e-3)
    for one in found.circles:
        ring = height == one.height
        own = (
            truth[ring][:, :2]
            * ((radius[ring] + put_in[ring]) / np.linalg.norm(truth[ring][:, :2], axis=1))[:, None]
        )
        assert one.zone.zone >= narrowest(own, "ring").zone - 0.02 and one.gap < 0.1
        assert one.count >= ring.sum()


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
    deviation = np.random.default_rng(26).normal(0.02, 0.1, 5000)
    found = figures.summarise(deviation, 0.1)
    assert (found.mean, found.deviation) == pytest.approx((deviation.mean(), deviation.std()))
    assert found.rms**2 == pytest.approx(found.mean**2 + found.deviation**2)
    amount = np.sort(np.abs(deviation))
    assert amount[4749] <= found.within_95 <= amount[4750]
    assert found.within == (np.abs(deviation) <= 0.1).mean()
    assert found.counts.sum() == 5000 and (np.diff(found.edges) > 0.0).all()
    assert figures.summarise(np.full(7, 0.3), 0.1).counts.sum() == 7
    for far in (1e6, -1e6, 1e12):  # a scan in another place altogether, as far everywhere
        alike = figures.summarise(np.full(7, far), 0.1)
        assert (
            alike.counts.sum() == 7
            and (np.diff(alike.edges) > 0.0).all()
            and alike.edges[0] <= far <= alike.edges[-1]
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
    rng = np.random.default_rng(27)
    points, normal = sampled(hemisphere(), rng, 1500, 0.1, 0.7)
    dome = revolution_surface(hemisphere())
    each = [
        inspected(points + normal * rng.normal(0.0, noise, (1500, 1)), dome) for noise in (0.1, 0.2)
    ]
    by_name = {
        name: (values, mean, deviation) for name, _, values, mean, deviation in table.compared(each)
    }
    values, mean, deviation = by_name["Spherical defect"]
    assert values == [one.ball.zone.zone for one in each]
    assert mean == pytest.approx(np.mean(values)) and deviation == pytest.approx(
        abs(values[1] - values[0]) / np.sqrt(2.0)
    )
    data = table.as_data(each[0])
    assert (
        data["sphericity_mm"]["minimum_zone"] == values[0]
        and sum(data["histogram"]["counts"]) == data["counted"]
    )
    lines = list(table.deviations(each[0]))
    assert len(lines) == 1501 and float(lines[7].split(",")[3]) == pytest.approx(
        each[0].deviation[6], abs=1e-6
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
    far = np.random.default_rng(28).uniform(-1.0, 1.0, (200, 3)) + [0.0, 0.0, -500.0]
    with pytest.raises(AmError) as caught:
        inspected(far, revolution_surface(hemisphere()), fit="none")
    assert caught.value.code == "NOT_ON_PART" and "hemisphere" in caught.value.message
    with pytest.raises(InputError) as caught:
        inspected(np.zeros((3, 3)), revolution_surface(hemisphere()))
    assert caught.value.code in ("TOO_FEW_POINTS", "NOT_ON_PART")
    points, _ = sampled(hemisphere(), np.random.default_rng(29), 500, 0.3, 0.5)
    found = inspected(points, revolution_surface(hemisphere()), heights=("44",))
    assert "FEW_POINTS" in codes(found) and found.circles == ()


@pytest.mark.parametrize("unit", [1.0, 10.0, 25.4, 1000.0])
@pytest.mark.always("25.4", "1.0")
def test_points_in_another_unit_fit_anywhere_which_is_told(unit):
    """A cap of millimetres lies well on a dome of centimetres: the figures alone would look good."""
    wall = hemisphere()
    points, _ = sampled(wall, np.random.default_rng(3), 500)
    found = inspected(points / unit, revolution_surface(wall))
    assert ("SMALL" in codes(found)) == (unit > 1.0)
    told = [issue.message for issue in found.issues if issue.code == "SMALL"]
    assert all("check the unit of the file" in text for text in told)


def test_three_points_are_told_to_be_too_few():
    with pytest.raises(InputError, match="3 points cannot locate a part") as caught:
        inspected(np.eye(3) * R0, revolution_surface(hemisphere()))
    assert caught.value.code == "TOO_FEW_POINTS"
