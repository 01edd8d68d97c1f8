# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads whose best rotation at few points fails at all of them or between them, and beads that are
searched together but are independent."""

import numpy as np
import pytest

from freecad_am import kdl
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.rotation import global_search, local_optimisation
from freecad_am.core.planning.rotation.local_optimisation import evaluate_paths
from freecad_am.core.planning.task import Task

INNER_SHARES = np.linspace(0.0, 1.0, 9)[1:-1]


def test_a_rotation_that_loses_a_bead_is_looked_at_for_all_others(sliced, cell_of):
    """A rotation that fails for one bead is still evaluated for all others."""
    toolpath = sliced("sphere", 10.0)
    beads = [bead for _, _, bead in toolpath]
    cell = cell_of(toolpath, deposition_point=(1530.0, -630.0, 650.0, 0.0, 0.0, 0.0))
    task = Task(cell, 0, JointParameters())
    points = gather(beads, cell, global_search.POINTS_PER_BEAD)
    together = global_search.everywhere(task, points, np.full(len(points), 0.02))
    is_infeasible = np.isinf(together.objective)
    assert (is_infeasible.any(axis=1) & ~is_infeasible.all(axis=1)).any()
    for k, bead in enumerate(beads):
        bead_points = gather([bead], cell, global_search.POINTS_PER_BEAD)
        alone = global_search.everywhere(task, bead_points, np.full(len(bead_points), 0.02))
        assert np.array_equal(is_infeasible[:, k], np.isinf(alone.objective[:, 0]))
        assert np.allclose(
            together.margin[~is_infeasible[:, k], k],
            alone.margin[~is_infeasible[:, k], 0],
            rtol=0.0,
            atol=1e-9,
        )
        assert np.allclose(
            together.objective[~is_infeasible[:, k], k],
            alone.objective[~is_infeasible[:, k], 0],
            rtol=1e-9,
            atol=1e-12,
        )


# with the default number of points, and so few that the search is wrong about several beads
@pytest.mark.parametrize(
    ("part", "branch", "looked"),
    [
        ("laval nozzle", ("front", "down", "noflip"), 10),
        ("sphere", ("front", "up", "noflip"), 4),
        ("intake funnel", ("back", "up", "flip"), 4),
    ],
)
@pytest.mark.always
def test_limits_are_kept_at_all_points_and_between_however_few_are_searched(
    sliced, cell_of, with_axis_6, monkeypatch, part, branch, looked
):
    """Limits are kept at all points and between them, however few are searched."""
    toolpath = sliced(part, 10.0)
    cell = with_axis_6(cell_of(toolpath, branch=branch), 200.0)
    retry_counts = []
    monkeypatch.setattr(global_search, "POINTS_PER_BEAD", looked)
    find_rotations = global_search.find_rotations
    monkeypatch.setattr(
        global_search,
        "find_rotations",
        lambda task, beads, *arguments: (
            retry_counts.append(len(beads)) or find_rotations(task, beads, *arguments)
        ),
    )
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert sum(retry_counts) > 0 and joint_path.feasible, joint_path.issues
    task, arm = Task(cell, 0, JointParameters()), kdl.KdlArm(cell.machine)
    for path in joint_path.beads:
        steps = path.joints[1:] - path.joints[:-1]
        between = (path.joints[:-1, None] + INNER_SHARES[:, None] * steps[:, None]).reshape(-1, 6)
        assert not cell.limits.exceeded(between).any()
        flange = arm.forward(between)
        assert (task.condition_at(flange, between) >= 0.99 * path.threshold.min()).all()
        points_between = (
            path.bead.points[:-1, None]
            + INNER_SHARES[:, None] * np.diff(path.bead.points, axis=0)[:, None]
        )
        tip, _ = cell.tip_in_part(flange)
        assert (
            np.linalg.norm(tip - points_between.reshape(-1, 3), axis=1).max()
            < 2.0 * toolpath.chord_error + 1e-6
        )


def test_another_rotation_is_taken_before_a_seam_is_moved(
    sliced, cell_of, with_axis_6, monkeypatch
):
    """A different rotation is tried before a seam is moved."""
    toolpath = sliced("sphere", 10.0)
    cell = with_axis_6(cell_of(toolpath, branch=("front", "up", "noflip")), 200.0)
    default_path = plan_joints(toolpath, cell, JointParameters())
    monkeypatch.setattr(global_search, "POINTS_PER_BEAD", 4)
    coarse_path = plan_joints(toolpath, cell, JointParameters())
    moved = [
        [issue.message for issue in path_.issues if issue.code == "SEAM_MOVED"]
        for path_ in (default_path, coarse_path)
    ]
    assert default_path.feasible and coarse_path.feasible and moved[0] == moved[1]
    assert [path.objective for path in coarse_path.beads] == pytest.approx(
        [path.objective for path in default_path.beads], rel=0.05
    )


def test_what_falls_short_between_points_alone_is_seen(sliced, cell_of):
    """A violation only between points is detected."""
    toolpath, branch = sliced("sphere", 10.0, chord_error=0.3), ("front", "down", "noflip")
    cell, bead_place = cell_of(toolpath, branch=branch), (0, 0)
    task = Task(cell, spherical_wrist.branch_index(branch), JointParameters())
    wrong = 0
    for _, _, bead in list(toolpath)[2::4]:
        points, finer = gather([bead], cell), bead
        for _ in range(5):
            finer = finer.halved(np.arange(len(finer) - 1))
        candidates = global_search.everywhere(task, points, task.thresholds(points))
        dense = gather([finer], cell)
        between = global_search.judge(
            task, dense, task.thresholds(dense), candidates.coefficients
        ).margin[:, 0]
        for k in np.flatnonzero(
            (candidates.margin[:, 0] >= 0.0) & ((between < -0.02) | (between > 0.0))
        ):
            refined = local_optimisation.Refined(
                candidates.coefficients[k], np.zeros(1), ("",), (0,)
            )
            path = evaluate_paths(
                task,
                [bead],
                [bead_place],
                points,
                task.thresholds(points),
                refined.coefficients,
                refined,
            )
            assert path[0].margin >= 0.0
            assert global_search.find_infeasible(task, [bead], path) == (
                [0] if between[k] < 0.0 else []
            )
            wrong += between[k] < 0.0
    assert wrong > 0
