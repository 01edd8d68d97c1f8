# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads whose best rotation, seen at few points, does not serve at all of them, or between them; and beads that are searched
together but have nothing to do with each other."""

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

INSIDE = np.linspace(0.0, 1.0, 9)[1:-1]


def test_a_rotation_that_loses_a_bead_is_looked_at_for_all_others(sliced, cell_of):
    toolpath = sliced("sphere", 10.0)
    beads = [bead for _, _, bead in toolpath]
    cell = cell_of(toolpath, deposition_point=(1530.0, -630.0, 650.0, 0.0, 0.0, 0.0))
    task = Task(cell, 0, JointParameters())
    points = gather(beads, cell, global_search.POINTS_PER_BEAD)
    together = global_search.everywhere(task, points, np.full(len(points), 0.02))
    lost = np.isinf(together.objective)
    assert (lost.any(axis=1) & ~lost.all(axis=1)).any()
    for k, bead in enumerate(beads):
        own = gather([bead], cell, global_search.POINTS_PER_BEAD)
        alone = global_search.everywhere(task, own, np.full(len(own), 0.02))
        assert np.array_equal(lost[:, k], np.isinf(alone.objective[:, 0]))
        assert np.allclose(
            together.margin[~lost[:, k], k], alone.margin[~lost[:, k], 0], rtol=0.0, atol=1e-9
        )
        assert np.allclose(
            together.objective[~lost[:, k], k],
            alone.objective[~lost[:, k], 0],
            rtol=1e-9,
            atol=1e-12,
        )


# with as many points as are looked at by default, and so few that the search is wrong about several beads
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
    toolpath = sliced(part, 10.0)
    cell = with_axis_6(cell_of(toolpath, branch=branch), 200.0)
    asked = []
    monkeypatch.setattr(global_search, "POINTS_PER_BEAD", looked)
    others = global_search.find_rotations
    monkeypatch.setattr(
        global_search,
        "find_rotations",
        lambda task, some, *at: asked.append(len(some)) or others(task, some, *at),
    )
    found = plan_joints(toolpath, cell, JointParameters())
    assert sum(asked) > 0 and found.feasible, found.issues
    task, arm = Task(cell, 0, JointParameters()), kdl.KdlArm(cell.machine)
    for path in found.beads:
        way = path.joints[1:] - path.joints[:-1]
        between = (path.joints[:-1, None] + INSIDE[:, None] * way[:, None]).reshape(-1, 6)
        assert not cell.limits.exceeded(between).any()
        flange = arm.forward(between)
        assert (task.condition_at(flange, between) >= 0.99 * path.threshold.min()).all()
        on = (
            path.bead.points[:-1, None]
            + INSIDE[:, None] * np.diff(path.bead.points, axis=0)[:, None]
        )
        tip, _ = cell.tip_in_part(flange)
        assert (
            np.linalg.norm(tip - on.reshape(-1, 3), axis=1).max()
            < 2.0 * toolpath.chord_error + 1e-6
        )


def test_another_rotation_is_taken_before_a_seam_is_moved(
    sliced, cell_of, with_axis_6, monkeypatch
):
    toolpath = sliced("sphere", 10.0)
    cell = with_axis_6(cell_of(toolpath, branch=("front", "up", "noflip")), 200.0)
    asked = plan_joints(toolpath, cell, JointParameters())
    monkeypatch.setattr(global_search, "POINTS_PER_BEAD", 4)
    few = plan_joints(toolpath, cell, JointParameters())
    moved = [
        [issue.message for issue in found.issues if issue.code == "SEAM_MOVED"]
        for found in (asked, few)
    ]
    assert asked.feasible and few.feasible and moved[0] == moved[1]
    assert [path.objective for path in few.beads] == pytest.approx(
        [path.objective for path in asked.beads], rel=0.05
    )


def test_what_falls_short_between_points_alone_is_seen(sliced, cell_of):
    toolpath, branch = sliced("sphere", 10.0, chord_error=0.3), ("front", "down", "noflip")
    cell, place = cell_of(toolpath, branch=branch), (0, 0)
    task = Task(cell, spherical_wrist.branch_index(branch), JointParameters())
    wrong = 0
    for _, _, bead in list(toolpath)[2::4]:
        points, finer = gather([bead], cell), bead
        for _ in range(5):
            finer = finer.halved(np.arange(len(finer) - 1))
        found = global_search.everywhere(task, points, task.thresholds(points))
        dense = gather([finer], cell)
        between = global_search.judge(
            task, dense, task.thresholds(dense), found.coefficients
        ).margin[:, 0]
        for k in np.flatnonzero(
            (found.margin[:, 0] >= 0.0) & ((between < -0.02) | (between > 0.0))
        ):
            refined = local_optimisation.Refined(found.coefficients[k], np.zeros(1), ("",), (0,))
            path = evaluate_paths(
                task,
                [bead],
                [place],
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
