# SPDX-License-Identifier: LGPL-2.1-or-later
"""A spiral that goes round many times on a positioner whose axis has room for less: it is cut where the axis rewinds, or
refused by the axis' name. What is written is driven in the world by PyKDL chains built of the numbers of the files."""

import numpy as np
import pytest

from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from tests.core.planning.test_external_axes import levelled_to
from tests.core.planning.test_positioner_stroke import (
    MOST,
    cell_with,
    codes,
    in_the_world,
    of_text,
    off_beads,
)

__all__ = ["cell_with"]  # a fixture


@pytest.fixture(scope="module")
def spiral(sliced):
    return levelled_to(sliced("sphere", 12.0, chord_error=0.2, path="spiral"), MOST)


def turns_round(bead):
    """Turns of a bead about the part's axis, by its points."""
    return np.ptp(np.unwrap(np.arctan2(bead.points[:, 1], bead.points[:, 0]))) / (2.0 * np.pi)


@pytest.mark.parametrize(("turn", "pieces"), [(185.0, 5), (400.0, 3), (120.0, 10), (3600.0, 1)])
@pytest.mark.always("185.0-5")
def test_a_spiral_is_cut_where_the_axis_rewinds(spiral, cell_with, turn, pieces):
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
    mine = [path.bead for path in planned.beads]
    rewinds = [issue.message for issue in planned.issues if issue.code == "UNWIND"]
    assert len(mine) == pieces
    # it turns back between pieces alone, by as much as the axis has room for; more than three quarters of a turn are told
    back = [
        abs(after.joints[0, -1] - piece.joints[-1, -1])
        for piece, after in zip(planned.beads, planned.beads[1:])
    ]
    assert min(back, default=np.pi) > np.radians(90.0) and len(back) == pieces - 1, np.degrees(back)
    told = sum(way > 1.5 * np.pi for way in back)
    assert told == (pieces - 1 if turn > 135.0 else 0) and len(rewinds) == (told > 0)
    assert not told or f"rewinds {told} times between beads" in rewinds[0]
    deposit, moves = of_text(cell, spiral, planned)
    most = np.r_[cell.robot.limits("maker").upper, np.radians([134.0, turn])]
    least = np.r_[cell.robot.limits("maker").lower, -np.radians([134.0, turn])]
    assert ((moves >= least - 1e-9) & (moves <= most + 1e-9)).all()
    tips, leans = in_the_world(spiral, deposit)
    assert off_beads(tips, [bead]).max() < spiral.chord_error + 0.01  # the last digits of the text
    assert leans.max() < MOST + 0.01
    # all of it is laid, in its order, without a gap between pieces
    assert off_beads(bead.points, mine).max() < 1e-9
    assert sum(piece.length for piece in mine) == pytest.approx(bead.length, rel=2e-3)
    for piece, after in zip(mine, mine[1:]):
        assert np.abs(piece.points[-1] - after.points[0]).max() < 1e-9


@pytest.mark.parametrize(("tilt", "turn", "axis"), [(134.0, 20.0, "e2"), (35.0, 200.0, "e1")])
@pytest.mark.long
def test_a_spiral_that_no_cut_helps_is_refused_by_the_axis(spiral, cell_with, tilt, turn, axis):
    planned = plan_joints(spiral, cell_with(spiral, tilt, turn), JointParameters(method="constant"))
    assert not planned.feasible
    assert any(
        issue.code in ("LIMIT", "NOT_LEVEL") and issue.message.startswith(axis)
        for issue in planned.issues
    ), [i.message for i in planned.issues]
