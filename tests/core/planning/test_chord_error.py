# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points added to a bead are on its curve, so that a part of revolution stays one."""

import numpy as np
import pytest

from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.beads import chord_error
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead


def curve_points(bead, share=0.5):
    return bead.outline.at(np.arange(len(bead) - 1), share)[0]


def bead_of(points, closed):
    n = len(points)
    up = np.tile([0.0, 0.0, 1.0], (n, 1))
    return Bead(points, up, up, np.arange(n), np.ones(n), closed)


@pytest.mark.parametrize("closed", [True, False])
def test_the_middle_of_uneven_segments_of_a_circle_is_on_it(closed):
    steps = np.random.default_rng(7).uniform(0.5, 1.5, 120)
    angle = np.concatenate([[0.0], np.cumsum(steps / steps.sum() * 2 * np.pi)])
    angle = angle if closed else angle[:40]
    points = 45.0 * np.c_[np.cos(angle), np.sin(angle), np.zeros(len(angle))]
    points[-1] = points[0] if closed else points[-1]
    middle = curve_points(bead_of(points, closed))
    half = 0.5 * np.diff(angle)
    between = angle[:-1] + half
    assert np.abs(np.linalg.norm(middle, axis=1) - 45.0).max() < 45.0 * half.max() ** 4 / 8 + 1e-9
    assert np.abs(np.linalg.norm(middle, axis=1) - 45.0).max() < 1e-4
    for share in (0.1, 0.3, 0.8):
        assert (
            np.abs(
                np.linalg.norm(curve_points(bead_of(points, closed), share), axis=1) - 45.0
            ).max()
            < 1e-4
        )
    assert (
        np.abs(np.angle(np.exp(1j * (np.arctan2(middle[:, 1], middle[:, 0]) - between)))).max()
        < 1e-9
    )


def test_corners_and_straight_stretches_stay_as_they_are():
    square = np.array(
        [[0, 0, 0], [5, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [0, 0, 0]], dtype=float
    )
    assert (
        np.abs(curve_points(bead_of(square, True)) - 0.5 * (square[1:] + square[:-1])).max() < 1e-12
    )
    assert np.abs(curve_points(bead_of(square[:2], False)) - [2.5, 0, 0]).max() < 1e-12


def test_added_points_are_on_the_sphere_and_in_the_plane_of_their_layer(sliced, cell_of):
    """With axis 6 limited as by the manufacturer, axes 1 to 5 move within a layer and points must
    be added."""
    toolpath = sliced("sphere", 5.0)
    planned = plan_joints(toolpath, cell_of(toolpath, limits="maker"), JointParameters())
    assert planned.feasible
    added = 0
    for (_, _, bead), path in zip(toolpath, planned.beads):
        added += len(path.bead) - len(bead)
        assert np.abs(np.linalg.norm(path.bead.points, axis=1) - 45.0).max() < 1e-3
        assert np.ptp(path.bead.points[:, 2]) < 1e-9
    assert added > 100


def test_beads_that_are_looked_at_together_get_the_points_that_they_get_alone(
    sliced, cell_of, monkeypatch
):
    """The batch size does not change the added points."""
    toolpath, joints_of_batches = sliced("sphere", 5.0), []
    for together in (1, 200, 4096):
        monkeypatch.setattr(chord_error, "POINTS_PER_BATCH", together)
        planned = plan_joints(toolpath, cell_of(toolpath, limits="maker"), JointParameters())
        joints_of_batches.append([path.joints for path in planned.beads])
    for batch_joints in joints_of_batches[1:]:
        assert all(
            np.array_equal(first_joints, again)
            for first_joints, again in zip(joints_of_batches[0], batch_joints, strict=True)
        )


def test_an_overlap_ends_on_the_sphere(sliced, cell_of):
    from freecad_am.core.parameters.process import ProcessParameters

    toolpath = sliced("sphere", 5.0, process=ProcessParameters(overlap=4.3))
    planned = plan_joints(toolpath, cell_of(toolpath), JointParameters())
    for path in planned.beads:
        assert np.abs(np.linalg.norm(path.bead.points, axis=1) - 45.0).max() < 1e-3
