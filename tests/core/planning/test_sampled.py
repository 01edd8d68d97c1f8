# SPDX-License-Identifier: LGPL-2.1-or-later
"""Some points of a toolpath stand for all, and what is told of planned beads is what their joints say."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics.jacobian import condition, jacobian
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.judgement import judged
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.sampled import sampled


@pytest.fixture(scope="module")
def dome(sliced):
    return sliced("sphere", 1.5)


@pytest.mark.parametrize("most", [150, 400, 1000, 2500])
def test_a_sample_is_about_as_large_as_asked_and_spread_over_all_layers(dome, most):
    sample = sampled(dome, most)
    points, beads = sample.toolpath.point_count, sample.toolpath.bead_count
    assert 0.3 * most <= points <= 1.3 * most and not sample.whole
    assert beads == -(-(dome.bead_count - 1) // sample.beads) + 1 or beads == -(-dome.bead_count // sample.beads)
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
    sample = sampled(dome, dome.point_count)
    assert sample.whole and sample.toolpath is dome


def test_points_leave_the_curve_by_no_more_than_the_chord_error_of_the_sample(dome):
    sample = sampled(dome, 400)
    for number, _, bead in sample.toolpath:
        radius = np.linalg.norm(dome.layers[number].beads[0].points[:, :2], axis=1).mean()
        middle = 0.5 * (bead.points[1:] + bead.points[:-1])
        assert (radius - np.linalg.norm(middle[:, :2], axis=1)).max() <= sample.toolpath.chord_error * 1.3


def test_a_sample_is_feasible_where_the_whole_is_and_nearly_as_near_to_limits(dome, cell_of):
    for limits, feasible in (("paper", True), ("maker", True)):
        cell = cell_of(dome, limits=limits)
        found = []
        for toolpath in (dome, sampled(dome, 400).toolpath):
            planned = plan_joints(toolpath, cell, JointParameters())
            assert has_errors(planned.issues) != feasible
            found.append(judged(planned.beads, cell.limits, cell.machine.max_speed))
        whole, some = found
        assert some.worst_margin.value == pytest.approx(whole.worst_margin.value, abs=0.05)
        assert some.worst_condition.value == pytest.approx(whole.worst_condition.value, rel=0.1)
        assert abs(some.worst_condition.layer - whole.worst_condition.layer) <= 2 * sampled(dome, 400).beads


def test_what_is_told_of_planned_beads_is_what_their_joints_say(sliced, cell_of):
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="maker")
    planned = plan_joints(toolpath, cell, JointParameters())
    found = judged(planned.beads, cell.limits, cell.machine.max_speed)
    row = 0
    for path in planned.beads:
        for k, q in enumerate(path.joints):
            half = 0.5 * (cell.limits.upper - cell.limits.lower)
            share = np.minimum(q - cell.limits.lower, cell.limits.upper - q) / half
            low, high, coupled = cell.limits.coupled_lower, cell.limits.coupled_upper, cell.limits.coefficients @ q
            both = np.append(share, np.minimum(coupled - low, high - coupled) / (0.5 * (high - low)))
            assert found.margin[row] == pytest.approx(np.nanmin(both[np.isfinite(both)]), abs=1e-12)
            if k:
                way = np.linalg.norm(path.bead.points[k] - path.bead.points[k - 1])
                speed = np.abs(q - path.joints[k - 1]) / (way / path.bead.speed[k])
                assert found.ratio[row] == pytest.approx((speed / cell.machine.max_speed).max(), rel=1e-9)
            row += 1
    assert row == len(found.margin)
    worst = int(np.argmin(found.condition))
    q = planned.joints[worst][None]
    flange = cell.machine.chain.forward(q)
    own = condition(jacobian(cell.machine.chain, q, cell.deposition_point(flange)), JointParameters().characteristic_length)
    assert found.worst_condition.value == pytest.approx(float(own[0]), abs=1e-11)
    assert found.worst_margin.label in cell.limits.labels and found.worst_ratio.label in cell.limits.labels


def test_points_out_of_reach_have_no_figures_and_do_not_hide_the_others(sliced, cell_of):
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="paper")
    planned = plan_joints(toolpath, cell, JointParameters())
    first, *rest = planned.beads
    joints = first.joints.copy()
    joints[3] = np.nan
    found = judged([dataclasses.replace(first, joints=joints), *rest], cell.limits, cell.machine.max_speed)
    assert np.isnan(found.margin[3]) and np.isnan(found.condition[3]) and np.isnan(found.ratio[3])
    assert np.isfinite(found.margin[5:]).all() and found.worst_margin is not None
    lost = dataclasses.replace(first, joints=np.full_like(first.joints, np.nan))
    nothing = judged([lost], cell.limits, cell.machine.max_speed)
    assert nothing.worst_margin is None and nothing.worst_condition is None and nothing.worst_ratio is None
