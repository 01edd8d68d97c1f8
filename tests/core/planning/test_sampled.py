# SPDX-License-Identifier: LGPL-2.1-or-later
"""A sample of the toolpath represents all of it, and the figures of planned beads follow from their
joints."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics.jacobian import condition, jacobian
from freecad_am.core.parameters.joints import GIVEN, JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.rotation.given import coefficients
from freecad_am.core.planning.rotation.headroom import judge_paths
from freecad_am.core.planning.sample_of_beads import sample_toolpath
from freecad_am.core.toolpath import Bead, Layer, Toolpath


@pytest.fixture(scope="module")
def dome(sliced):
    return sliced("sphere", 1.5)


@pytest.mark.parametrize("most", [150, 400, 1000, 2500])
def test_a_sample_is_about_as_large_as_asked_and_spread_over_all_layers(dome, most):
    sample = sample_toolpath(dome, most)
    points, beads = sample.toolpath.point_count, sample.toolpath.bead_count
    assert 0.3 * most <= points <= 1.3 * most and not sample.is_complete
    assert beads == -(-(dome.bead_count - 1) // sample.beads) + 1 or beads == -(
        -dome.bead_count // sample.beads
    )
    assert len(sample.toolpath.layers) == len(dome.layers)
    sampled_layers = [number for number, layer in enumerate(sample.toolpath.layers) if layer.beads]
    assert (sampled_layers[0], sampled_layers[-1]) == (0, len(dome.layers) - 1) and max(
        np.diff(sampled_layers)
    ) == sample.beads
    for number, _, bead in sample.toolpath:
        full_points = {tuple(point) for point in dome.layers[number].beads[0].points}
        full = dome.layers[number].beads[0]
        assert {tuple(point) for point in bead.points} <= full_points and bead.closed == full.closed
        assert (bead.points[[0, -1]] == full.points[[0, -1]]).all()
        assert len(bead) >= min(len(full), 9)


def test_a_small_toolpath_is_looked_at_whole(dome):
    """A small toolpath is not sampled."""
    sample = sample_toolpath(dome, dome.point_count)
    assert sample.is_complete and sample.toolpath is dome


def rings(layers, beads):
    """A toolpath whose layers have several closed beads, each identified by its radius and
    height."""
    turn = np.linspace(0.0, 2.0 * np.pi, 101)
    up, speed = np.tile([0.0, 0.0, 1.0], (101, 1)), np.full(101, 10.0)

    def ring(layer, k):
        points = np.column_stack(
            [(10 + 2 * k) * np.cos(turn), (10 + 2 * k) * np.sin(turn), np.full(101, float(layer))]
        )
        points[-1] = points[0]
        return Bead(points, up, up, turn, speed, True)

    ring_layers = tuple(
        Layer(tuple(ring(layer, k) for k in range(beads))) for layer in range(layers)
    )
    return Toolpath(ring_layers, np.eye(4), 1.0, 0.05)


@pytest.mark.parametrize("most", [700, 1000, 3000, 20_000])
def test_polynomials_that_are_given_stay_with_their_beads(most):
    """Given polynomials stay with their beads."""
    full_toolpath = rings(100, 5)
    sample = sample_toolpath(full_toolpath, most)
    beads = [bead for _, _, bead in sample.toolpath]
    assert not sample.is_complete and len(beads) == len(sample.places) == len(set(sample.places))
    for bead, (layer, index) in zip(beads, sample.places):
        assert (bead.points[0] == full_toolpath.layers[layer].beads[index].points[0]).all()
    named = [(layer, index) for layer in (0, 30, 31, 99) for index in range(5)]
    texts = tuple(f"{layer}/{index}:{layer}.5:{index}" for layer, index in named)
    selected = sample.select_given(GIVEN.read((*texts, "*:7")))
    sampled_places = [(layer, index) for layer, index, _ in sample.toolpath]
    result = coefficients(JointParameters(given=selected), sampled_places)
    expected = coefficients(JointParameters(given=(*texts, "*:7")), sample.places)
    assert result == expected and len(result) == len(beads)
    kept_places = [bead_place for bead_place in named if bead_place in set(sample.places)]
    assert (
        len(selected) == len(kept_places) + 1 and (0, 0) in kept_places and (99, 4) in kept_places
    )


def test_a_polynomial_for_a_bead_that_is_left_out_falls_on_no_other():
    """A polynomial for an omitted bead applies to no other."""
    sample = sample_toolpath(rings(100, 5), 1000)
    omitted_place = next(
        (layer, k) for layer in range(100) for k in range(5) if (layer, k) not in sample.places
    )
    assert (
        sample.select_given(GIVEN.read((f"{omitted_place[0]}/{omitted_place[1]}:1.0", "200/0:3")))
        == ()
    )
    complete_sample = sample_toolpath(rings(2, 2), 10_000)
    selected = complete_sample.select_given(GIVEN.read(("1/1:2:3", "0:4", "*:5")))
    assert complete_sample.is_complete and GIVEN.text(selected) == ("1/1:2:3", "0/0:4", "*:5")


@pytest.mark.parametrize("layer_height", [3.0, 1.0, 0.5])
@pytest.mark.always("1.0", "3.0")
def test_of_a_single_bead_of_many_turns_points_alone_are_left_out(sliced, layer_height):
    """For a single bead of many turns only points are omitted."""
    spiral = sliced("sphere", layer_height, path="spiral")
    assert spiral.bead_count == 1
    bead = spiral.layers[0].beads[0]
    turns = abs(bead.parameter[-1] - bead.parameter[0]) / (2.0 * np.pi)
    sample = sample_toolpath(spiral, 400)
    sampled_bead = sample.toolpath.layers[0].beads[0]
    assert (sample.beads, sample.places, sample.toolpath.bead_count) == (1, ((0, 0),), 1)
    assert 0.5 * 400 <= len(sampled_bead) <= max(1.1 * 400, 8.0 * turns)
    assert len(sampled_bead) == pytest.approx(len(bead) / sample.points, rel=0.15)
    assert (
        np.abs(np.diff(sampled_bead.parameter)).max() < 0.6 * np.pi
    )  # all sides are represented, also where turns have few points
    assert (sampled_bead.points[[0, -1]] == bead.points[[0, -1]]).all()


def test_of_two_spirals_both_are_kept_and_as_few_points_as_of_one(sliced):
    """For several spirals all needed ones are kept, with as few points each as for one."""
    single_spiral = sliced("sphere", 0.5, path="spiral")
    two_spirals = dataclasses.replace(single_spiral, layers=single_spiral.layers * 2)
    three_spirals = dataclasses.replace(single_spiral, layers=single_spiral.layers * 3)
    alone = sample_toolpath(single_spiral, 150).toolpath.point_count
    for toolpath, beads, expected_places in (
        (two_spirals, 1, ((0, 0), (1, 0))),
        (three_spirals, 2, ((0, 0), (2, 0))),
    ):
        sample = sample_toolpath(toolpath, 150)
        assert (sample.beads, sample.places) == (beads, expected_places)
        assert sample.toolpath.point_count == pytest.approx(2 * alone, rel=0.01)


def test_points_leave_the_curve_by_no_more_than_the_chord_error_of_the_sample(dome):
    sample = sample_toolpath(dome, 400)
    for number, _, bead in sample.toolpath:
        radius = np.linalg.norm(dome.layers[number].beads[0].points[:, :2], axis=1).mean()
        middle = 0.5 * (bead.points[1:] + bead.points[:-1])
        assert (
            radius - np.linalg.norm(middle[:, :2], axis=1)
        ).max() <= sample.toolpath.chord_error * 1.3


def test_a_sample_is_feasible_where_the_whole_is_and_nearly_as_near_to_limits(dome, cell_of):
    """A sample is feasible where the whole toolpath is, with almost the same margin."""
    for limits, method, feasible in (
        ("paper", "layer-by-layer", True),
        ("maker", "layer-by-layer", True),
        ("maker", "constant", False),
    ):
        cell = cell_of(dome, limits=limits)
        figures = []
        for toolpath in (dome, sample_toolpath(dome, 400).toolpath):
            planned = plan_joints(toolpath, cell, JointParameters(method=method))
            assert has_errors(planned.issues) != feasible
            figures.append(judge_paths(planned.beads, cell.limits, cell.machine.max_speed))
        full_figures, sample_figures = figures
        assert sample_figures.worst_margin.value == pytest.approx(
            full_figures.worst_margin.value, abs=0.05
        )
        if not feasible:  # the violation of limits and singularities depends on the points
            assert (
                sample_figures.worst_margin.value < 0.0
                and sample_figures.worst_margin.label == full_figures.worst_margin.label
            )
            continue
        assert sample_figures.worst_condition.value == pytest.approx(
            full_figures.worst_condition.value, rel=0.1
        )
        assert (
            abs(sample_figures.worst_condition.layer - full_figures.worst_condition.layer)
            <= 2 * sample_toolpath(dome, 400).beads
        )


def test_what_is_told_of_planned_beads_is_what_their_joints_say(sliced, cell_of):
    """Figures of planned beads agree with their joints."""
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="maker")
    planned = plan_joints(toolpath, cell, JointParameters())
    figures = judge_paths(planned.beads, cell.limits, cell.machine.max_speed)
    row = 0
    for path in planned.beads:
        for k, q in enumerate(path.joints):
            half = 0.5 * (cell.limits.upper - cell.limits.lower)
            share = np.minimum(q - cell.limits.lower, cell.limits.upper - q) / half
            low, high, coupled = (
                cell.limits.coupled_lower,
                cell.limits.coupled_upper,
                cell.limits.coefficients @ q,
            )
            margins = np.append(
                share, np.minimum(coupled - low, high - coupled) / (0.5 * (high - low))
            )
            assert figures.margin[row] == pytest.approx(
                np.nanmin(margins[np.isfinite(margins)]), abs=1e-12
            )
            if k:
                length = np.linalg.norm(path.bead.points[k] - path.bead.points[k - 1])
                speed = np.abs(q - path.joints[k - 1]) / (length / path.bead.speed[k])
                assert figures.ratio[row] == pytest.approx(
                    (speed / cell.machine.max_speed).max(), rel=1e-9
                )
            row += 1
    assert row == len(figures.margin)
    worst = int(np.argmin(figures.condition))
    q = planned.joints[worst][None]
    flange = cell.machine.chain.forward(q)
    expected_condition = condition(
        jacobian(cell.machine.chain, q, cell.deposition_point(flange)),
        JointParameters().characteristic_length,
    )
    assert figures.worst_condition.value == pytest.approx(float(expected_condition[0]), abs=1e-11)
    assert (
        figures.worst_margin.label in cell.limits.labels
        and figures.worst_ratio.label in cell.limits.labels
    )


def test_points_out_of_reach_have_no_figures_and_do_not_hide_the_others(sliced, cell_of):
    """Unreachable points have no figures and do not hide others."""
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="paper")
    planned = plan_joints(toolpath, cell, JointParameters())
    first_path, *other_paths = planned.beads
    joints = first_path.joints.copy()
    joints[3] = np.nan
    figures = judge_paths(
        [dataclasses.replace(first_path, joints=joints), *other_paths],
        cell.limits,
        cell.machine.max_speed,
    )
    assert (
        np.isnan(figures.margin[3])
        and np.isnan(figures.condition[3])
        and np.isnan(figures.ratio[3])
    )
    assert np.isfinite(figures.margin[5:]).all() and figures.worst_margin is not None
    unreachable_bead = dataclasses.replace(
        first_path, joints=np.full_like(first_path.joints, np.nan)
    )
    nothing = judge_paths([unreachable_bead], cell.limits, cell.machine.max_speed)
    assert (
        nothing.worst_margin is None
        and nothing.worst_condition is None
        and nothing.worst_ratio is None
    )
