# SPDX-License-Identifier: LGPL-2.1-or-later
"""A spiral of many turns on a positioner whose axis has less range: it is split where the axis
rewinds, or rejected with the axis name. The program is driven in the world by PyKDL chains built
from the files."""

import numpy as np
import pytest

from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from tests.core.planning.test_external_axes import levelled_to
from tests.core.planning.test_positioner_stroke import (
    MAX_TILT_DEG,
    cell_with,
    codes,
    in_the_world,
    off_beads,
    read_joints,
)

__all__ = ["cell_with"]  # a fixture


@pytest.fixture(scope="module")
def spiral(sliced):
    return levelled_to(sliced("sphere", 12.0, chord_error=0.2, path="spiral"), MAX_TILT_DEG)


def turns_round(bead):
    """Turns of a bead about the part's axis, from its points."""
    return np.ptp(np.unwrap(np.arctan2(bead.points[:, 1], bead.points[:, 0]))) / (2.0 * np.pi)


@pytest.mark.parametrize(("turn", "pieces"), [(185.0, 5), (400.0, 3), (120.0, 10), (3600.0, 1)])
@pytest.mark.always("185.0-5")
def test_a_spiral_is_cut_where_the_axis_rewinds(spiral, cell_with, turn, pieces):
    """A spiral is split where the axis rewinds."""
    (layer,) = spiral.layers
    (bead,) = layer.beads
    round_ = turns_round(bead)
    assert round_ > 4.0 and not bead.closed
    cell = cell_with(spiral, 134.0, turn)
    planned = plan_joints(spiral, cell, JointParameters())
    assert planned.feasible, [issue.message for issue in planned.issues]
    assert (codes(planned) & {"SEAM_MOVED", "BEAD_SPLIT"}) == (
        set() if pieces == 1 else {"BEAD_SPLIT"}
    )
    split_beads = [path.bead for path in planned.beads]
    rewinds = [issue.message for issue in planned.issues if issue.code == "UNWIND"]
    assert len(split_beads) == pieces
    # the axis reverses only between split beads, by as much as its range allows; rewinds above
    # three quarters of a turn are reported
    back = [
        abs(following.joints[0, -1] - current.joints[-1, -1])
        for current, following in zip(planned.beads, planned.beads[1:])
    ]
    assert min(back, default=np.pi) > np.radians(90.0) and len(back) == pieces - 1, np.degrees(back)
    rewind_count = sum(rewind > 1.5 * np.pi for rewind in back)
    assert rewind_count == (pieces - 1 if turn > 135.0 else 0) and len(rewinds) == (
        rewind_count > 0
    )
    assert not rewind_count or f"rewinds {rewind_count} times between beads" in rewinds[0]
    deposit, moves = read_joints(cell, spiral, planned)
    upper = np.r_[cell.robot.limits("maker").upper, np.radians([134.0, turn])]
    lower = np.r_[cell.robot.limits("maker").lower, -np.radians([134.0, turn])]
    assert ((moves >= lower - 1e-9) & (moves <= upper + 1e-9)).all()
    tips, leans = in_the_world(spiral, deposit)
    assert off_beads(tips, [bead]).max() < spiral.chord_error + 0.01  # the last digits of the text
    assert leans.max() < MAX_TILT_DEG + 0.01
    # everything is deposited in order, without a gap between split beads
    assert off_beads(bead.points, split_beads).max() < 1e-9
    assert sum(current.length for current in split_beads) == pytest.approx(bead.length, rel=2e-3)
    for current, following in zip(split_beads, split_beads[1:]):
        assert np.abs(current.points[-1] - following.points[0]).max() < 1e-9


@pytest.mark.parametrize(("tilt", "turn", "axis"), [(134.0, 20.0, "e2"), (35.0, 200.0, "e1")])
@pytest.mark.long
def test_a_spiral_that_no_cut_helps_is_refused_by_the_axis(spiral, cell_with, tilt, turn, axis):
    planned = plan_joints(spiral, cell_with(spiral, tilt, turn), JointParameters(method="constant"))
    assert not planned.feasible
    assert any(
        issue.code in ("LIMIT", "NOT_LEVEL") and issue.message.startswith(axis)
        for issue in planned.issues
    ), [i.message for i in planned.issues]
