# SPDX-License-Identifier: LGPL-2.1-or-later
"""Positions of bodies in a cell, against PyKDL and against the positions of the motion."""

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.simulation.table_links import at_rest, placing, standing_link
from freecad_am.kdl import KdlArm

TILTED = frames.bryant((10.0, -20.0, 30.0, 0.2, -0.1, 0.4))
CELLS = {
    "part on robot": CellParameters(),
    "part on robot, any branch": CellParameters(branch="auto"),
    "tool on robot": CellParameters(
        setup="tool-on-robot",
        deposition_point=(900.0, 0.0, -200.0, 0.0, 0.0, 0.3),
        nozzle=NozzleParameters(tool=(10.0, 0.0, 250.0, 0.1, -0.3, 0.0)),
    ),
    "trunnion": CellParameters(machine="table-xyzac", setup="rotary-table"),
    "head and table": CellParameters(machine="head-table-xyzbc", setup="rotary-table"),
    "head": CellParameters(machine="head-xyzab", setup="rotary-table"),
}


@pytest.fixture(params=CELLS)
def cell(request):
    return cells.resolve(CELLS[request.param], TILTED)


def test_nozzle_and_part_are_where_pykdl_puts_them(cell):
    q = np.random.default_rng(4).uniform(-1.0, 1.0, (20, len(cell.machine.axes)))
    flange = KdlArm(cell.machine).forward(q)
    tip, axis = cell.tip_in_part(flange)
    for row, joints in enumerate(q):
        placed = placing(cell, joints)
        nozzle_in_part = frames.inverse(placed.part) @ placed.nozzle
        assert (
            np.abs(nozzle_in_part[:3, 3] - tip[row]).max() < 1e-9
            and np.abs(nozzle_in_part[:3, 2] - axis[row]).max() < 1e-12
        )
        drawn = placed.links[-1] @ cell.machine.chain.flange
        base = placed.links[0]
        assert np.abs(frames.inverse(base) @ drawn - flange[row]).max() < 1e-9
        assert np.abs(placed.links[standing_link(cell.machine.chain)] - np.eye(4)).max() < 1e-12
        assert np.abs(placed.part @ cell.poses.mount - placed.platform).max() < 1e-9


def test_at_rest_the_nozzle_stands_upright_on_the_point(cell):
    point = (cell.poses.mount @ [3.0, -4.0, 25.0, 1.0])[:3]
    joints = at_rest(cell, point)
    assert np.isfinite(joints).all() and (cell.limits.margin(joints) > 0.0).all()
    placed = placing(cell, joints)
    nozzle_in_part = frames.inverse(placed.part) @ placed.nozzle
    assert np.abs(nozzle_in_part[:3, 3] - point).max() < 1e-6
    assert np.abs(nozzle_in_part[:3, 2] - cell.poses.mount[:3, 2]).max() < 1e-9


def test_out_of_reach_all_axes_are_at_zero():
    cell = cells.resolve(CELLS["part on robot"], np.eye(4))
    assert (at_rest(cell, (9e4, 0.0, 0.0)) == 0.0).all()
