# SPDX-License-Identifier: LGPL-2.1-or-later
"""Some points of a toolpath stand for all, and what is told of planned beads is what their joints say."""

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
    kept = [number for number, layer in enumerate(sample.toolpath.layers) if layer.beads]
    assert (kept[0], kept[-1]) == (0, len(dome.layers) - 1) and max(np.diff(kept)) == sample.beads
    for number, _, bead in sample.toolpath:
        known = {tuple(point) for point in dome.layers[number].beads[0].points}
        full = dome.layers[number].beads[0]
        assert {tuple(point) for point in bead.points} <= known and bead.closed == full.closed
        assert (bead.points[[0, -1]] == full.points[[0, -1]]).all()
        assert len(bead) >= min(len(full), 9)


def test_a_small_toolpath_is_looked_at_whole(dome):
    sample = sample_toolpath(dome, dome.point_count)
    assert sample.is_complete and sample.toolpath is dome


def rings(layers, beads):
    """A toolpath whose layers have several closed beads, each told by its radius and height alone."""
    turn = np.linspace(0.0, 2.0 * np.pi, 101)
    up, speed = np.tile([0.0, 0.0, 1.0], (101, 1)), np.full(101, 10.0)

    def ring(layer, k):
        points = np.column_stack(
            [(10 + 2 * k) * np.cos(turn), (10 + 2 * k) * np.sin(turn), np.full(101, float(layer))]
        )
        points[-1] = points[0]
        return Bead(points, up, up, turn, speed, True)

    made = tuple(Layer(tuple(ring(layer, k) for k in range(beads))) for layer in range(layers))
    return Toolpath(made, np.eye(4), 1.0, 0.05)


@pytest.mark.parametrize("most", [700, 1000, 3000, 20_000])
def test_polynomials_that_are_given_stay_with_their_beads(most):
    whole = rings(100, 5)
    sample = sample_toolpath(whole, most)
    beads = [bead for _, _, bead in sample.toolpath]
    assert not sample.is_complete and len(beads) == len(sample.places) == len(set(sample.places))
    for bead, (layer, index) in zip(beads, sample.places):
        assert (bead.points[0] == whole.layers[layer].beads[index].points[0]).all()
    named = [(layer, index) for layer in (0, 30, 31, 99) for index in range(5)]
    given = tuple(f"{layer}/{index}:{layer}.5:{index}" for layer, index in named)
    told = sample.select_given(GIVEN.read((*given, "*:7")))
    places = [(layer, index) for layer, index, _ in sample.toolpath]
    found = coefficients(JointParameters(given=told), places)
    wanted = coefficients(JointParameters(given=(*given, "*:7")), sample.places)
    assert found == wanted and len(found) == len(beads)
    kept = [place for place in named if place in set(sample.places)]
    assert len(told) == len(kept) + 1 and (0, 0) in kept and (99, 4) in kept


def test_a_polynomial_for_a_bead_that_is_left_out_falls_on_no_other():
    sample = sample_toolpath(rings(100, 5), 1000)
    lost = next(
        (layer, k) for layer in range(100) for k in range(5) if (layer, k) not in sample.places
    )
    assert sample.select_given(GIVEN.read((f"{lost[0]}/{lost[1]}:1.0", "200/0:3"))) == ()
    whole = sample_toolpath(rings(2, 2), 10_000)
    selected = whole.select_given(GIVEN.read(("1/1:2:3", "0:4", "*:5")))
    assert whole.is_complete and GIVEN.text(selected) == ("1/1:2:3", "0/0:4", "*:5")


@pytest.mark.parametrize("layer_height", [3.0, 1.0, 0.5])
@pytest.mark.always("1.0", "3.0")
def test_of_a_single_bead_of_many_turns_points_alone_are_left_out(sliced, layer_height):
    spiral = sliced("sphere", layer_height, path="spiral")
    assert spiral.bead_count == 1
    bead = spiral.layers[0].beads[0]
    turns = abs(bead.parameter[-1] - bead.parameter[0]) / (2.0 * np.pi)
    sample = sample_toolpath(spiral, 400)
    kept = sample.toolpath.layers[0].beads[0]
    assert (sample.beads, sample.places, sample.toolpath.bead_count) == (1, ((0, 0),), 1)
    assert 0.5 * 400 <= len(kept) <= max(1.1 * 400, 8.0 * turns)
    assert len(kept) == pytest.approx(len(bead) / sample.points, rel=0.15)
    assert (
        np.abs(np.diff(kept.parameter)).max() < 0.6 * np.pi
    )  # all sides are seen, also where turns have few points
    assert (kept.points[[0, -1]] == bead.points[[0, -1]]).all()


def test_of_two_spirals_both_are_kept_and_as_few_points_as_of_one(sliced):
    one = sliced("sphere", 0.5, path="spiral")
    two = dataclasses.replace(one, layers=one.layers * 2)
    three = dataclasses.replace(one, layers=one.layers * 3)
    alone = sample_toolpath(one, 150).toolpath.point_count
    for toolpath, beads, places in ((two, 1, ((0, 0), (1, 0))), (three, 2, ((0, 0), (2, 0)))):
        sample = sample_toolpath(toolpath, 150)
        assert (sample.beads, sample.places) == (beads, places)
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
    for limits, method, feasible in (
        ("paper", "layer-by-layer", True),
        ("maker", "layer-by-layer", True),
        ("maker", "constant", False),
    ):
        cell = cell_of(dome, limits=limits)
        found = []
        for toolpath in (dome, sample_toolpath(dome, 400).toolpath):
            planned = plan_joints(toolpath, cell, JointParameters(method=method))
            assert has_errors(planned.issues) != feasible
            found.append(judge_paths(planned.beads, cell.limits, cell.machine.max_speed))
        whole, some = found
        assert some.worst_margin.value == pytest.approx(whole.worst_margin.value, abs=0.05)
        if (
            not feasible
        ):  # beyond limits and through a singularity by how much depends on the points
            assert (
                some.worst_margin.value < 0.0
                and some.worst_margin.label == whole.worst_margin.label
            )
            continue
        assert some.worst_condition.value == pytest.approx(whole.worst_condition.value, rel=0.1)
        assert (
            abs(some.worst_condition.layer - whole.worst_condition.layer)
            <= 2 * sample_toolpath(dome, 400).beads
        )


def test_what_is_told_of_planned_beads_is_what_their_joints_say(sliced, cell_of):
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="maker")
    planned = plan_joints(toolpath, cell, JointParameters())
    found = judge_paths(planned.beads, cell.limits, cell.machine.max_speed)
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
            both = np.append(
                share, np.minimum(coupled - low, high - coupled) / (0.5 * (high - low))
            )
            assert found.margin[row] == pytest.approx(np.nanmin(both[np.isfinite(both)]), abs=1e-12)
            if k:
                way = np.linalg.norm(path.bead.points[k] - path.bead.points[k - 1])
                speed = np.abs(q - path.joints[k - 1]) / (way / path.bead.speed[k])
                assert found.ratio[row] == pytest.approx(
                    (speed / cell.machine.max_speed).max(), rel=1e-9
                )
            row += 1
    assert row == len(found.margin)
    worst = int(np.argmin(found.condition))
    q = planned.joints[worst][None]
    flange = cell.machine.chain.forward(q)
    own = condition(
        jacobian(cell.machine.chain, q, cell.deposition_point(flange)),
        JointParameters().characteristic_length,
    )
    assert found.worst_condition.value == pytest.approx(float(own[0]), abs=1e-11)
    assert (
        found.worst_margin.label in cell.limits.labels
        and found.worst_ratio.label in cell.limits.labels
    )


def test_points_out_of_reach_have_no_figures_and_do_not_hide_the_others(sliced, cell_of):
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="paper")
    planned = plan_joints(toolpath, cell, JointParameters())
    first, *rest = planned.beads
    joints = first.joints.copy()
    joints[3] = np.nan
    found = judge_paths(
        [dataclasses.replace(first, joints=joints), *rest], cell.limits, cell.machine.max_speed
    )
    assert np.isnan(found.margin[3]) and np.isnan(found.condition[3]) and np.isnan(found.ratio[3])
    assert np.isfinite(found.margin[5:]).all() and found.worst_margin is not None
    lost = dataclasses.replace(first, joints=np.full_like(first.joints, np.nan))
    nothing = judge_paths([lost], cell.limits, cell.machine.max_speed)
    assert (
        nothing.worst_margin is None
        and nothing.worst_condition is None
        and nothing.worst_ratio is None
    )
