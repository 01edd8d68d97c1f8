# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures hold the values of the core, in the units that they name."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.process import bead_model, model_notes, wire
from freecad_am.core.process.deposit import spacing
from freecad_am.core.process.deposit.void_and_double import measure
from freecad_am.core.simulation import timeline
from freecad_am.core.simulation.timeline import totals
from freecad_am.plots import draw, pictures
from freecad_am.plots.chart import LIGHT, together
from freecad_am.plots.pictures import PATH, TIME, rows
from freecad_am.plots.source import Source
from tests.core.strategies.test_solids_in_planes import box, planned


def curve(charts, number=0, total=0):
    return charts[number].curves[total]


def test_angles_are_those_of_the_motion_at_their_times(dome):
    source, _ = dome
    along = rows(source)
    charts, motion, times = pictures.angles(source, along), source.motion, source.times
    assert len(charts) == 6 and charts[0].x[:2] == ("time", "min" if times.total > 180.0 else "s")
    unit = 60.0 if charts[0].x.unit == "min" else 1.0
    moving = ~along.standing
    for axis, chart in enumerate(charts):
        curve_ = chart.curves[0]
        np.testing.assert_allclose(np.radians(curve_.y[moving]), motion.joints[:, axis], atol=1e-13)
        np.testing.assert_allclose(curve_.x[moving] * unit, times.arrive, atol=1e-9)
        assert (np.diff(curve_.x) >= 0.0).all()
        limits = source.cell.limits
        np.testing.assert_allclose(
            np.radians(chart.limits), [limits.lower[axis], limits.upper[axis]]
        )
    # during a wait the axes keep their position until its end
    stays = np.flatnonzero(along.standing)
    assert len(stays) > 4
    np.testing.assert_allclose(along.x[stays] * unit, times.leave[along.index[stays]], atol=1e-9)
    assert np.array_equal(curve(charts).y[stays], curve(charts).y[stays - 1])
    assert np.array_equal(along.layers, np.unique(motion.layer))


def test_rates_reach_what_the_report_tells(dome):
    source, joint_figures = dome
    along = rows(source)
    for build, key in (
        (pictures.speeds, "speed_max_deg_s"),
        (pictures.accelerations, "acceleration_max_deg_s2"),
        (pictures.jerks, "jerk_max_deg_s3"),
    ):
        charts = build(source, along)
        maxima = [np.nanmax(np.abs(chart.curves[0].y)) for chart in charts]
        np.testing.assert_allclose(maxima, joint_figures[key], rtol=1e-6, atol=1e-7)
        combined = together("all", charts)
        assert [curve_.name for curve_ in combined.curves] == list(
            source.cell.machine.axes
        ) and combined.wrong_count == 0
    shares = pictures.shares(source, along)[0]
    largest_shares = [np.nanmax(curve_.y) / 100.0 for curve_ in shares.curves]
    np.testing.assert_allclose(
        largest_shares, joint_figures["speed_ratio_max"], rtol=1e-6, atol=1e-7
    )
    (condition,) = pictures.condition(source, along)
    assert np.nanmin(condition.curves[1].y) == pytest.approx(
        joint_figures["condition_min"], rel=1e-9
    )


def test_limits_that_no_machine_file_tells_are_said_to_be_unknown(dome):
    source, _ = dome
    known_charts = pictures.picture("speeds", source).charts
    assert all(np.isfinite(chart.limits).all() and not chart.unlimited for chart in known_charts)
    for name, word in (("accelerations", "max_acceleration"), ("jerks", "max_jerk")):
        charts = pictures.picture(name, source).charts
        assert all(np.isinf(chart.limits).all() and word in chart.unlimited for chart in charts)
    # once a user's file states some of them, the chart draws these, and a note names the others
    limits = np.array([np.inf, 500.0, np.inf, np.inf, np.inf, 900.0])
    for name, key in (("accelerations", "max_acceleration"), ("jerks", "max_jerk")):
        machine = dataclasses.replace(source.cell.machine, **{key: np.radians(limits)})
        limited_source = dataclasses.replace(
            source, cell=dataclasses.replace(source.cell, machine=machine)
        )
        charts = pictures.picture(name, limited_source).charts
        assert [bool(chart.unlimited) for chart in charts] == np.isinf(limits).tolist()
        np.testing.assert_allclose([chart.limits[1] for chart in charts], limits)
        np.testing.assert_allclose([chart.limits[0] for chart in charts], -limits)


def test_what_breaks_a_limit_is_counted(dome):
    source, _ = dome
    machine = source.cell.machine
    slow = dataclasses.replace(machine, max_speed=np.full(6, np.radians(1.0)))
    charts = pictures.speeds(
        dataclasses.replace(source, cell=dataclasses.replace(source.cell, machine=slow)),
        rows(source),
    )
    with np.errstate(invalid="ignore"):
        over = (np.abs(np.degrees(source.rates.speed)) > 1.0).sum(axis=0)
    assert [chart.wrong_count for chart in charts] == over.tolist() and over.max() > 3
    low, high = charts[int(over.argmax())].up()
    assert low < -1.0 and high > 1.0  # both limits are visible
    assert charts[int(over.argmin())].wrong_count == 0


def test_path_counts_every_move(dome):
    source, _ = dome
    along = rows(source, PATH)
    length = np.linalg.norm(np.diff(source.motion.position, axis=0), axis=1).sum()
    unit = 1000.0 if along.quantity.unit == "m" else 1.0
    assert along.x[-1] * unit == pytest.approx(length, rel=1e-12) and along.x[0] == 0.0


def test_layers_are_chosen(dome):
    source, _ = dome
    all_rows, selected_rows = rows(source, TIME), rows(source, TIME, (1, 2))
    is_selected = (all_rows.layer >= 1) & (all_rows.layer <= 2)
    for name in ("index", "x", "standing", "layer"):
        assert np.array_equal(getattr(selected_rows, name), getattr(all_rows, name)[is_selected]), (
            name
        )
    assert (
        selected_rows.layers.tolist() == [1, 2]
        and 0.0 < selected_rows.borders[0] < selected_rows.borders[1]
    )


def test_deposit_rate_over_its_time_is_the_mass_of_the_job(dome):
    source, _ = dome
    along = rows(source)
    rate, mass = pictures.deposit(source, along)
    sums = totals(source.motion, source.times, source.process, source.toolpath)
    assert mass.curves[0].y[-1] == pytest.approx(sums.mass, rel=1e-12)
    unit = {"min": 60.0, "s": 1.0}[rate.x.unit]
    hours = np.diff(rate.curves[0].x, prepend=0.0) * unit / 3600.0
    assert 1000.0 * (rate.curves[0].y * hours).sum() == pytest.approx(sums.mass, rel=1e-9)
    np.testing.assert_allclose(
        np.diff(mass.curves[0].y), (1000.0 * rate.curves[0].y * hours)[1:], rtol=1e-6, atol=1e-9
    )


def test_travel_speed_is_told_apart_and_where_it_is_not_kept(dome):
    source, _ = dome
    (chart,) = pictures.travel(source, rows(source))
    by_name = {curve_.name: curve_.y for curve_ in chart.curves}
    assert np.nanmin(by_name["deposit"]) == np.nanmax(by_name["deposit"]) == 8.0
    assert (
        np.isfinite(by_name["rapid"]) & np.isfinite(by_name["deposit"])
    ).sum() == 0 and "limited by the axes" not in by_name
    machine = dataclasses.replace(source.cell.machine, max_speed=np.full(6, np.radians(2.0)))
    slow = dataclasses.replace(source, cell=dataclasses.replace(source.cell, machine=machine))
    (chart,) = pictures.travel(slow, rows(slow))
    limited_speed = {curve_.name: curve_.y for curve_ in chart.curves}["limited by the axes"]
    assert 0.0 < np.nanmin(limited_speed) < np.nanmax(limited_speed) < 8.0


def test_spacing_is_that_of_the_layers(dome):
    source, _ = dome
    values = np.concatenate(spacing.between_layers(source.toolpath))
    (chart,) = pictures.spacing(source, (0, len(source.toolpath.layers) - 1))
    bars = chart.bars
    np.testing.assert_allclose(
        bars.heights, 100.0 * np.histogram(values, bars.edges)[0] / len(values), rtol=1e-9
    )
    assert bars.heights.sum() == pytest.approx(100.0) and bars.edges[0] < 9.0 < bars.edges[-1]
    assert chart.band == pytest.approx((8.1, 9.9)) and chart.upright[0][0] == 9.0
    assert pictures.spacing(source, (0, 0)) == ()
    (selected,) = pictures.spacing(source, (1, 1))
    spacing_ = spacing.between_layers(source.toolpath)[0]
    np.testing.assert_allclose(
        selected.bars.heights,
        100.0 * np.histogram(spacing_, selected.bars.edges)[0] / len(spacing_),
        rtol=1e-9,
    )


def test_what_a_bead_model_predicts(modelled):
    note = model_notes.beads(modelled.toolpath)
    height, drift = pictures.heights(modelled, (1, 3))
    for number, kind in enumerate(("min", "mean", "max")):
        assert curve([height], 0, number).y.tolist() == [
            row["height_mm"][kind] for row in note["layers"][1:]
        ]
    assert drift.curves[0].y.tolist() == [row["drift_mm"] for row in note["layers"][1:]]
    assert height.curves[0].x.tolist() == [1.0, 2.0, 3.0] and height.marks[0][0] == 2.0
    speed, width, _ = pictures.distributions(modelled, (0, 3))
    assert (
        speed.bars.heights.sum() == pytest.approx(100.0)
        and width.across()[0] < 4.8
        and width.across()[1] > 5.2
    )
    measured = wire.read_table("csw")
    model = bead_model.fit(*measured)
    (fit,) = pictures.picture("fit", modelled).charts
    for radius, line, dots in zip(np.unique(measured.radius), fit.curves[::2], fit.curves[1::2]):
        expected = model.width.m * line.x ** (-1.0 / 3.0) + model.width.p / radius + model.width.t
        np.testing.assert_allclose(line.y, expected, rtol=1e-12)
        assert sorted(dots.y.tolist()) == sorted(measured.width[measured.radius == radius].tolist())


def test_every_picture_is_there_or_says_why(dome, modelled):
    source, _ = dome
    for name, entry in pictures.PICTURES.items():
        of_dome, of_path = pictures.picture(name, source), pictures.picture(name, modelled)
        assert bool(of_dome.charts) != bool(of_dome.lacking) and bool(of_path.charts) != bool(
            of_path.lacking
        )
        filled = name in ("volumes", "section", "infill")
        assert bool(of_dome.charts) == (name not in ("heights", "spread", "fit") and not filled), (
            name
        )
        assert bool(of_path.charts) == (not entry.machine and not filled), name


def test_the_limit_of_void_is_a_line_in_its_chart(modelled):
    toolpath = measure(planned(box((0, 0, 0), (21, 30, 8), "block"), fill="lines"), 0.02)
    motion = timeline.deposit_motion(toolpath)
    source = Source(toolpath, motion, ProcessParameters(), max_void=0.02)
    (chart,) = pictures.picture("infill", source).charts
    assert chart.marks == ((2.0, "limit of void 2 %"),)
    (unlimited,) = pictures.picture("infill", dataclasses.replace(source, max_void=1.0)).charts
    assert unlimited.marks == ()


def test_volumes_and_sections_of_plane_layers(modelled):
    block = box((-20, -15, 0), (20, 15, 13), "block")
    solids = prepare_stack([block], SolidParameters(), "block")
    toolpath = planned(block, fill="lines", contour=True)
    source = Source(toolpath, timeline.deposit_motion(toolpath), ProcessParameters(), solids=solids)
    volume, share = pictures.picture("volumes", source).charts
    of_part, laid = (curve_.y for curve_ in volume.curves)
    np.testing.assert_allclose(
        of_part, [4.8, 4.8, 4.8, 1.2], rtol=1e-9
    )  # cm3; 1 mm at the top is less than half a layer
    assert laid[3] == 0.0 and laid.sum() == pytest.approx(source.volumes.sum() / 1000.0, rel=1e-12)
    np.testing.assert_allclose(share.curves[0].y, 100.0 * laid / of_part)
    assert f"{100 * laid.sum() / 15.6:.4g} %" in share.title
    (selected, _) = pictures.picture("volumes", source, layers=(1, 1)).charts
    assert selected.curves[1].y.tolist() == laid[1:2].tolist() and selected.curves[
        1
    ].x.tolist() == [1.0]
    (flat,) = pictures.picture("section", source, layers=(0, 1)).charts
    outline = next(curve_ for curve_ in flat.curves if curve_.name == "part")
    assert {tuple(np.round(np.abs(corner), 9)) for corner in zip(outline.x, outline.y)} <= {
        (20.0, 15.0)
    } | {(20.0, round(float(abs(y)), 9)) for y in outline.y} | {
        (round(float(abs(x)), 9), 15.0) for x in outline.x
    }
    beads = [curve_ for curve_ in flat.curves if curve_ is not outline]
    assert len(beads) == len(toolpath.layers[1].beads) and all(
        curve_.width > 0.0 for curve_ in beads
    )
    edge = 20.0 - 0.5 * beads[0].width
    assert max(np.abs(curve_.x).max() for curve_ in beads) == pytest.approx(edge, abs=0.06)
    figure, (corner,) = draw.figure((flat,), LIGHT, 900, 400)
    across, up = np.diff(corner.across)[0] / corner.width, np.diff(corner.up)[0] / corner.height
    assert across == pytest.approx(up)  # to scale
    line = next(curve_ for curve_ in figure.axes[0].get_lines() if curve_.get_linewidth() > 5)
    assert line.get_linewidth() / 72.0 * draw.DPI * across == pytest.approx(beads[0].width)
    for name in ("volumes", "section"):
        assert "planar layers" in pictures.picture(name, modelled).lacking
