# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's parts planned layer by layer; optima, gradients and limits checked independently."""

import dataclasses

import numpy as np
import pytest

from freecad_am import kdl
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.kinematics.limits import RESERVE
from freecad_am.core.parameters.joints import OBJECTIVES, JointParameters
from freecad_am.core.planning import criteria
from freecad_am.core.planning import plan as planner
from freecad_am.core.planning.methods import constant
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.rotation import global_search, refine_state
from freecad_am.core.planning.task import Task

FLIP = spherical_wrist.branch_index(("front", "up", "flip"))


def ranges(joint_path):
    return np.degrees([np.ptp(path.joints, axis=0) for path in joint_path.beads])


@pytest.mark.parametrize(
    ("part", "layers"), [("sphere", 71), ("laval nozzle", 137), ("intake funnel", 71)]
)
def test_the_papers_parts(sliced, cell_of, part, layers):
    toolpath = sliced(part, 1.0)
    assert len(toolpath.layers) == layers
    cell = cell_of(toolpath)
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert joint_path.feasible
    moved = ranges(joint_path)
    assert moved[:, :5].max() < 0.01
    assert np.abs(moved[:, 5] - 360.0).max() < 0.01
    # a second solver: the joints put the nozzle on the toolpath
    joints = joint_path.joints
    tip, axis = cell.tip_in_part(kdl.KdlArm(cell.machine).forward(joints))
    assert (
        np.abs(tip - np.concatenate([path.bead.points for path in joint_path.beads])).max() < 1e-6
    )
    assert np.abs(axis - np.concatenate([path.bead.tool for path in joint_path.beads])).max() < 1e-9
    assert not cell.limits.exceeded(joints).any()


@pytest.mark.parametrize("part", ["sphere", "laval nozzle", "intake funnel"])
@pytest.mark.always("intake funnel")
def test_no_constant_rz_is_feasible(sliced, cell_of, part):
    """No constant RZ is feasible for the paper's parts."""
    toolpath = sliced(part, 5.0)
    task = Task(cell_of(toolpath), FLIP, JointParameters(method="constant"))
    points = gather([bead for _, _, bead in toolpath], task.cell, 40)
    angles = np.radians(np.arange(-180.0, 180.0, 0.5))
    assert constant.margins(task, points, task.thresholds(points), angles).max() < 0.0
    joint_path = plan_joints(toolpath, task.cell, task.parameters)
    assert not joint_path.feasible
    error = next(issue for issue in joint_path.issues if issue.level == "error")
    assert error.layer is not None and error.point is not None and "q" in error.message


def test_degrees_one_to_three_coincide_on_a_part_of_revolution(sliced, cell_of):
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath)
    linear, *higher_degrees = [
        plan_joints(toolpath, cell, JointParameters(degree=degree)) for degree in (1, 2, 3)
    ]
    for higher_degree in higher_degrees:
        assert higher_degree.feasible
        assert np.abs(ranges(higher_degree) - ranges(linear)).max() < 1e-3
        assert [path.objective for path in higher_degree.beads] == pytest.approx(
            [path.objective for path in linear.beads], abs=1e-9
        )


def test_no_candidate_of_a_much_finer_grid_is_better(sliced, cell_of):
    """A brute-force search on all points, ten times as fine as the planner's, finds no lower
    objective."""
    toolpath = sliced("sphere", 20.0)
    cell = cell_of(toolpath, limits="maker")
    parameters = JointParameters()
    joint_path = plan_joints(toolpath, cell, parameters)
    task = Task(cell, FLIP, parameters)
    for path, (_, _, bead) in zip(joint_path.beads, toolpath):
        if path.iterations == 0:
            continue
        points = gather([bead], cell, 40)
        grid = global_search.everywhere(
            task, points, task.thresholds(points), np.linspace(-2, 2, 161), 90
        )
        best = grid.objective[grid.margin[:, 0] >= 0.0].min()
        planned_objective = global_search.judge(
            task, points, task.thresholds(points), path.coefficients[None, None]
        ).objective[0, 0]
        assert planned_objective <= best * 1.02


@pytest.mark.parametrize("min_condition", ["auto", 0.25])
def test_the_best_candidates_are_the_same_where_nothing_else_is_asked_for(
    sliced, cell_of, min_condition
):
    """The best candidates are the same when only they are requested."""
    toolpath = sliced("sphere", 5.0)
    beads, cell, feasible_shares = [bead for _, _, bead in toolpath], cell_of(toolpath), []
    points = gather(beads, cell, global_search.POINTS_PER_BEAD)
    for branch in range(8):
        task = Task(cell, branch, JointParameters(min_condition=min_condition))
        thresholds, bead_indices = task.thresholds(points), np.arange(points.beads)
        all_candidates = global_search.everywhere(task, points, thresholds)
        alone = global_search.everywhere(task, points, thresholds, best_alone=True)
        best = all_candidates.best()
        assert np.array_equal(alone.best(), best)
        assert np.array_equal(
            alone.objective[best, bead_indices], all_candidates.objective[best, bead_indices]
        )
        assert np.allclose(
            alone.margin[best, bead_indices],
            all_candidates.margin[best, bead_indices],
            rtol=0.0,
            atol=1e-12,
        )
        serves = (all_candidates.margin >= 0.0).any(axis=0)
        assert np.array_equal((alone.margin >= 0.0).any(axis=0), serves)
        feasible_shares.append(serves.mean())
    assert max(feasible_shares) == 1.0 if min_condition == "auto" else max(feasible_shares) < 1.0


def test_the_condition_is_kept_at_all_points_and_between(sliced, cell_of):
    """The minimum condition is kept at all points and between them."""
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath)
    joint_path = plan_joints(toolpath, cell, JointParameters(min_condition=0.15))
    assert joint_path.feasible
    task = Task(cell, FLIP, JointParameters())
    for path in joint_path.beads:
        between = 0.5 * (path.joints[1:] + path.joints[:-1])
        assert task.condition_at(cell.machine.chain.forward(between), between).min() > 0.149
        assert path.condition.min() >= 0.15


def test_the_valley_is_settled_where_the_margin_is_largest(sliced, cell_of):
    """In a flat optimum the rotation with the largest margin is taken."""
    toolpath = sliced("sphere", 10.0)
    cell = cell_of(toolpath)
    task = Task(cell, FLIP, JointParameters())
    joint_path = plan_joints(toolpath, cell, task.parameters)
    points = gather([bead for _, _, bead in toolpath], cell)
    candidates = np.repeat(
        np.array([path.coefficients for path in joint_path.beads])[None], 720, axis=0
    )
    candidates[:, :, 0] += np.radians(np.arange(720) * 0.5)[:, None]
    margins = global_search.judge(task, points, task.thresholds(points), candidates).margin
    assert (np.array([path.margin for path in joint_path.beads]) > margins.max(axis=0) - 0.02).all()


@pytest.mark.parametrize("objective", OBJECTIVES)
@pytest.mark.parametrize("parameter", ["rotation", "rz"])
@pytest.mark.always
def test_gradients_against_differences(sliced, cell_of, objective, parameter):
    toolpath = sliced("sphere", 20.0)
    task = Task(
        cell_of(toolpath), FLIP, JointParameters(objective=objective, degree=2, parameter=parameter)
    )
    points = gather([bead for _, _, bead in toolpath][1:2], task.cell)
    threshold = task.thresholds(points)
    rng = np.random.default_rng(7)
    checked = smooth = 0
    for _ in range(40):
        coefficients = np.array(
            [[rng.uniform(-3, 3), rng.uniform(-1.2, -0.8), rng.uniform(-0.02, 0.02)]]
        )
        state = refine_state.state_of(task, points, threshold, coefficients)
        if not np.isfinite(state.objective).all() or state.constraints.min() < 0.001:
            continue
        for k in range(3):
            step = np.zeros((1, 3))
            step[0, k] = 1e-6
            later, earlier = (
                refine_state.state_of(task, points, threshold, coefficients + s * step)
                for s in (1, -1)
            )
            slope = (later.objective - earlier.objective) / 2e-6
            assert state.gradient[0, k] == pytest.approx(
                slope[0], rel=2e-4, abs=1e-6 * max(1.0, abs(state.objective[0]))
            )
            # a maximum over points has a kink where two points tie: any slope between the two sides
            # is right
            sides = (
                np.stack(
                    [later.constraints - state.constraints, state.constraints - earlier.constraints]
                )[:, 0]
                / 1e-6
            )
            room = 1e-3 * max(1.0, np.abs(sides).max())
            assert (state.constraint_rates[0, :, k] > sides.min(axis=0) - room).all()
            assert (state.constraint_rates[0, :, k] < sides.max(axis=0) + room).all()
            smooth += int((np.abs(sides[0] - sides[1]) < room).sum())
        checked += 1
    assert checked >= 3
    assert smooth >= 3 * checked * 5


def test_all_criteria_are_reported_whatever_was_optimised(sliced, cell_of):
    """Eqs. 1 to 6 (as corrected) and 17 computed again from the joint values, singular values by
    numpy."""
    toolpath = sliced("sphere", 20.0)
    cell = cell_of(toolpath, limits="maker")
    joint_path = plan_joints(toolpath, cell, JointParameters())
    task = Task(cell, FLIP, JointParameters())
    values = criteria.criteria_values(task, joint_path.beads)
    q, stroke = joint_path.joints, cell.limits.upper - cell.limits.lower
    controller_values = np.c_[q, q[:, 2] - q[:, 1]]
    low, high = (
        np.r_[cell.limits.lower, cell.limits.coupled_lower],
        np.r_[cell.limits.upper, cell.limits.coupled_upper],
    )
    off = np.abs(controller_values - (low + high) / 2) / (high - low)
    assert values["limits-klein"] == pytest.approx(off.max())
    assert values["limits-fournier"] == pytest.approx((off**2).sum(axis=1).mean())
    assert values["limits-liegeois"] == pytest.approx(4 * (off**2).sum(axis=1).mean())
    motion = sum((np.diff(path.joints, axis=0) ** 2 / stroke).sum() for path in joint_path.beads)
    assert values["displacement"] == pytest.approx(motion)
    flange = cell.machine.chain.forward(q)
    arm = kdl.KdlArm(cell.machine)
    jacobian = arm.jacobian(q)
    lever = cell.deposition_point(flange) - flange[:, :3, 3]
    jacobian[:, :3] += np.cross(jacobian[:, 3:], lever[:, :, None], axis=1)
    jacobian[:, :3] /= 1000.0
    sigma = np.linalg.svd(jacobian, compute_uv=False)
    assert values["condition"] == pytest.approx((sigma[:, 0] / sigma[:, -1]).mean())
    assert values["manipulability"] == pytest.approx((1 / sigma.prod(axis=1)).mean())


def test_an_unreachable_point_is_named(sliced, cell_of):
    toolpath = sliced("sphere", 10.0)
    joint_path = plan_joints(
        toolpath,
        cell_of(toolpath, deposition_point=(1850.0, 0.0, 300.0, 0, 0, 0)),
        JointParameters(),
    )
    assert not joint_path.feasible
    issue = next(issue for issue in joint_path.issues if issue.code == "UNREACHABLE")
    assert issue.layer is not None and issue.point is not None


def test_a_branch_is_found_where_none_is_given(sliced, cell_of):
    """A configuration is selected where none is given."""
    toolpath = sliced("sphere", 10.0)
    joint_path = plan_joints(toolpath, cell_of(toolpath, branch="auto"), JointParameters())
    assert joint_path.feasible


def test_other_branches_are_planned_whole_where_they_serve_the_beads_that_failed(
    sliced, cell_of, monkeypatch
):
    """Other configurations are planned completely only if they serve the beads that failed."""
    toolpath = sliced("sphere", 10.0)
    cell = cell_of(toolpath, branch="auto")
    lower = np.where(
        np.arange(6) == 4, 0.01, cell.limits.lower
    )  # only one configuration of the wrist
    cell = dataclasses.replace(cell, limits=dataclasses.replace(cell.limits, lower=lower))
    alone = {}
    for branch in range(8):
        monkeypatch.setattr(planner, "best_branches", lambda *arguments_, branch=branch: [branch])
        alone[branch] = plan_joints(toolpath, cell, JointParameters())
    good = [branch for branch, joint_path in alone.items() if joint_path.feasible]
    bad = [branch for branch, joint_path in alone.items() if not joint_path.feasible]
    assert good and len(bad) >= 2
    monkeypatch.setattr(planner, "SCREENED", 3)
    calls, planned = [], planner._planned
    monkeypatch.setattr(
        planner,
        "_planned",
        lambda task, path, beads, *arguments: (
            calls.append((task.branch, len(beads))),
            planned(task, path, beads, *arguments),
        )[1],
    )
    bead_count = toolpath.bead_count
    for order in ([good[0], bad[0]], [bad[0], bad[1], good[0]], [bad[0], bad[1]]):
        calls.clear()
        monkeypatch.setattr(planner, "best_branches", lambda *arguments_, order=order: order)
        joint_path = plan_joints(toolpath, cell, JointParameters())
        served = [branch for branch in order if branch in good]
        expected = alone[served[0] if served else order[0]]
        assert joint_path.branch == expected.branch and joint_path.issues == expected.issues
        np.testing.assert_array_equal(joint_path.joints, expected.joints)
        assert [branch for branch, count in calls if count == bead_count] == list(
            dict.fromkeys([order[0], *served])
        )
        partial_branches = [branch for branch, count in calls if count < bead_count]
        assert partial_branches == ([] if order[0] in good else order[1:])


def test_too_high_a_travel_speed_is_refused_with_the_speed_that_would_do(sliced, cell_of):
    """Too high a travel speed is rejected with the highest feasible one."""
    from freecad_am.core.parameters.process import ProcessParameters

    toolpath = sliced("sphere", 1.0, process=ProcessParameters(travel_speed=20.0))
    joint_path = plan_joints(toolpath, cell_of(toolpath), JointParameters())
    issue = next(issue for issue in joint_path.issues if issue.code == "SPEED")
    # axis 6 rotates at 550 deg/s, once per ring: the ring below the last has a radius of 1.69 mm
    assert issue.layer == 69 and float(issue.message.split()[-2]) == pytest.approx(16.18, rel=0.003)


def test_a_reserve_is_kept_beside_limits_the_optimum_leans_on(sliced, cell_of):
    """A reserve remains at limits that the optimum reaches."""
    toolpath = sliced("sphere", 10.0)
    cell = cell_of(toolpath, limits="maker")
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert joint_path.feasible
    margin = np.min([cell.limits.margin(path.joints).min() for path in joint_path.beads])
    assert margin > 0.9 * RESERVE


def test_progress_may_cancel(sliced, cell_of):
    toolpath = sliced("sphere", 20.0)

    def cancel(fraction, text):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        plan_joints(toolpath, cell_of(toolpath), JointParameters(), cancel)


def test_progress_goes_on_layer_by_layer_and_may_cancel_between_them(sliced, cell_of):
    """Progress advances layer by layer and may cancel between layers."""
    toolpath, reports = sliced("sphere", 10.0), []
    cell, parameters = cell_of(toolpath, limits="maker"), JointParameters()
    plan_joints(toolpath, cell, parameters, lambda fraction, text: reports.append((fraction, text)))
    fractions = [fraction for fraction, text in reports if text == "refining layers"]
    assert len(set(fractions)) >= 3 and fractions == sorted(fractions)  # one for each refined layer

    def cancel(fraction, text):
        if fraction == fractions[-1]:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        plan_joints(toolpath, cell, parameters, cancel)


def test_a_narrow_rotation_range_is_kept_or_refused(sliced, cell_of):
    toolpath = sliced("sphere", 20.0)
    cell = cell_of(toolpath)
    parameters = JointParameters(rotation_range=(-2.0, 2.0))
    joint_path = plan_joints(toolpath, cell, parameters)
    for path in joint_path.beads:
        named = any(
            issue.level == "error" and issue.layer == path.layer for issue in joint_path.issues
        )
        assert named or (np.abs(path.phi) <= 2.0 + 1e-9).all()
    assert dataclasses.asdict(parameters)["rotation_range"] == (-2.0, 2.0)


def test_beads_after_one_that_is_out_of_reach_are_told_as_they_are(sliced, cell_of):
    """Beads after an unreachable one are still evaluated."""
    toolpath = sliced("sphere", 12.0)
    planned = plan_joints(toolpath, cell_of(toolpath), JointParameters())
    (bead,), later_layers = toolpath.layers[1].beads, toolpath.layers[2:]
    shifted_bead = dataclasses.replace(bead, points=bead.points + np.array([0.0, 0.0, 1e4]))
    unreachable_layer = dataclasses.replace(toolpath.layers[1], beads=(shifted_bead,))
    torn, cell = (
        dataclasses.replace(
            toolpath, layers=(toolpath.layers[0], unreachable_layer, *later_layers)
        ),
        cell_of(toolpath),
    )
    joint_path = plan_joints(torn, cell, JointParameters())
    assert planned.feasible and not joint_path.feasible
    assert [path.reachable for path in joint_path.beads] == [
        k != 1 for k in range(len(joint_path.beads))
    ]
    for path in joint_path.beads[2:]:
        tip, _ = cell.tip_in_part(cell.machine.chain.forward(path.joints))
        assert np.abs(tip - path.bead.points).max() < 1e-6
