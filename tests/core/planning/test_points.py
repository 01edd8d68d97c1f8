# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints unwrapped along beads."""

import numpy as np
import pytest

from freecad_am.core.geometry.frames import TURN
from freecad_am.core.planning.points import UNPOSED, Points, unwrapped, unwrapped_by_turns


def points_of(counts, sliding=None):
    starts, total = np.cumsum([0, *counts[:-1]]), sum(counts)
    return Points(
        np.zeros((total, 3)),
        np.zeros((total, 3)),
        np.zeros(total),
        starts,
        np.repeat(np.arange(len(counts)), counts),
        np.zeros(len(counts), dtype=bool),
        UNPOSED,
        None,
        sliding,
    )


@pytest.mark.parametrize("counts", [[1], [2, 1, 7], [40, 3, 300, 25]])
@pytest.mark.parametrize("sliding", [None, np.array([False, False, True])])
def test_by_whole_turns_joints_are_those_of_steps(counts, sliding):
    """Unwrapping by whole turns agrees with unwrapping step by step."""
    rng = np.random.default_rng(len(counts))
    points = points_of(counts, sliding)
    unwrapped_joints = np.cumsum(rng.uniform(-2.0, 3.0, (4, len(points), 3)), axis=1)
    unwrapped_joints[..., 1] *= 0.02  # stays within half a turn
    wrapped_joints = unwrapped_joints - TURN * np.round(unwrapped_joints / TURN)
    if sliding is not None:
        wrapped_joints[..., 2] = 100.0 * unwrapped_joints[..., 2]
    for joints in (
        wrapped_joints,
        np.moveaxis(np.ascontiguousarray(np.moveaxis(wrapped_joints, -1, 0)), 0, -1),
    ):
        result = unwrapped_by_turns(joints, points)
        assert np.abs(result - unwrapped(joints, points)).max() < 1e-9
        assert np.array_equal(result[:, points.first], wrapped_joints[:, points.first])
    if len(counts) > 2:
        assert np.abs(result - wrapped_joints).max() > TURN


def test_a_bead_with_points_out_of_reach_takes_no_other_along():
    """Unreachable points of a bead do not affect other beads."""
    rng = np.random.default_rng(3)
    counts = [5, 1, 8, 3, 6]
    points = points_of(counts)
    joints = rng.uniform(-3.0, 3.0, (7, len(points), 2))
    joints[rng.random(joints.shape[:-1]) < 0.1] = np.nan
    result = unwrapped(joints, points)
    assert np.isnan(result).any() and np.isfinite(result[:, -counts[-1] :]).any()
    for start, count in zip(points.first, counts):
        alone = unwrapped(joints[:, start : start + count], points_of([count]))
        assert result[:, start : start + count] == pytest.approx(alone, abs=1e-12, nan_ok=True)
        is_unreachable = np.isnan(joints[:, start : start + count]).any(axis=-1)
        first_unreachable = np.where(
            is_unreachable.any(axis=1), is_unreachable.argmax(axis=1), count
        )
        assert (
            np.isnan(alone).any(axis=-1) == (np.arange(count) >= first_unreachable[:, None])
        ).all()
