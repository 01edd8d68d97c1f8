# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reach as a volume: wherever PyKDL finds the tip with joints within limits, the volume has a
point next to it, and shares of directions agree with random directions."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.placement import reach
from freecad_am.kdl import KdlArm

CELLS = {
    "tool": CellParameters(
        setup="tool-on-robot", branch="auto", nozzle=NozzleParameters(tool=(100.0, 0.0, 250.0, 0.0, 0.7, 0.0))),
    "part": CellParameters(platform=80.0, branch="auto"),
}  # fmt: skip


@pytest.fixture(scope="module", params=CELLS)
def volume(request):
    """A cell and its reach."""
    cell = cells.resolve(CELLS[request.param], np.eye(4))
    return cell, reach.reach(cell, 350.0)


def test_where_the_tip_can_be_there_is_a_place(volume):
    """Every reachable tip position has a point of the volume next to it."""
    cell, reach = volume
    rng = np.random.default_rng(5)
    low, high = np.maximum(cell.limits.lower, -np.pi), np.minimum(cell.limits.upper, np.pi)
    q = rng.uniform(low, high, (3000, 6))
    q = q[(cell.limits.margin(q) >= 0.0).all(axis=1)]
    tip = (KdlArm(cell.machine).forward(q) @ cell.poses.carried)[:, :3, 3]
    distances, _ = cKDTree(reach.places).query(tip)
    assert (
        len(q) > 500 and (distances <= reach.step * np.sqrt(3.0)).all()
    )  # within its grid cube or the next


def test_shares_are_those_of_directions_at_random(volume):
    """Shares of reachable directions agree with random directions."""
    cell, reach = volume
    rng = np.random.default_rng(6)
    indices = rng.choice(len(reach.places), 8, replace=False)
    axes = rng.normal(size=(40, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    spins = np.linspace(-np.pi, np.pi, 48, endpoint=False)
    lean = np.swapaxes(frames.smallest_rotation(axes, (0.0, 0.0, 1.0)), 1, 2)
    turned = lean[:, None] @ frames.about_z(spins)
    full_turns = 2.0 * np.pi * np.arange(-2, 3)
    differences = []
    for point, share in zip(reach.places[indices], reach.share[indices]):
        flange = frames.pose(turned, point) @ frames.inverse(cell.poses.carried)
        q = cell.machine.arm.inverse(flange.reshape(-1, 4, 4))[:8]
        # all turns of all axes, because some limits are coupled
        served = np.zeros(q.shape[:2], dtype=bool)
        q4 = q[..., 3, None] + full_turns
        q6 = q[..., 5, None] + full_turns
        for a in range(5):
            for b in range(5):
                shifted = q.copy()
                shifted[..., 3], shifted[..., 5] = q4[..., a], q6[..., b]
                served |= np.nan_to_num(cell.limits.margin(shifted).min(axis=-1), nan=-1.0) >= 0.0
        differences.append(served.any(axis=0).reshape(40, 48).any(axis=1).mean() - share)
    assert np.abs(differences).max() <= 0.3 and abs(np.mean(differences)) <= 0.1
    assert np.ptp(reach.share[indices]) > 0.2


def test_progress_is_told_and_cancels():
    class Enough(Exception):
        pass

    def progress(share, text):
        if share > 0.2:
            raise Enough

    with pytest.raises(Enough):
        reach.reach(cells.resolve(CellParameters(), np.eye(4)), 300.0, progress)


def test_machines_with_rotary_axes_have_none():
    cell = cells.resolve(CellParameters(machine="table-xyzac", setup="rotary-table"), np.eye(4))
    assert len(reach.reach(cell, 100.0).places) == 0
