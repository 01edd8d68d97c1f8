# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads on a cone, closed and open, executed by a robot that holds the part or the torch, up to the
program."""

import math

import numpy as np
import pytest

from freecad_am import verify as verification
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.posts.fanuc import post as fanuc
from tests.programs import build

CHORD_ERROR = 0.05
CONE = Developable(60.0, 200.0)
CELLS = {
    "part-on-robot": CellParameters(
        platform=20.0, mount="part", branch=("front", "down", "noflip")
    ),
    "tool-on-robot": CellParameters(
        setup="tool-on-robot",
        deposition_point=(1150.0, 0.0, 250.0, 0.0, 0.0, math.pi),
        mount="part",
        branch=("front", "down", "flip"),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0)),
    ),
}


def bead(surface, flat, closed):
    """A bead of plane points (n, 2) wrapped onto the surface, along its normals."""
    points = surface.wrap(flat)
    if closed:
        points[-1] = points[0]
    up = surface.normals(points)
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(
        points, up, up, 2.0 * math.pi * length / length[-1], np.full(len(points), 8.0), closed
    )


def blade(layers=2, half=12.0, width=5.0):
    """Two nested rings and a bead along the middle in each layer, on the X side."""
    blade_layers = []
    for k in range(layers):
        surface = CONE.offset(2.5 * k)
        rho = surface.radius * (1.0 - 40.0 / surface.height)
        middle = surface.unroll(np.array([[rho, 0.0, 40.0]]))[0]
        angle = np.linspace(0.0, 2.0 * math.pi, 61)
        ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        across = np.linspace(-1.0, 1.0, 21)[:, None] * [half - 2.0 * width, 0.0]
        beads = [
            bead(surface, middle + (half - share * width) * ring, True) for share in (0.0, 1.0)
        ]
        blade_layers.append(Layer((*beads, bead(surface, middle + across, False))))
    return Toolpath(tuple(blade_layers), np.eye(4), 2.5, CHORD_ERROR, family="developable")


@pytest.fixture(scope="module", params=list(CELLS))
def planned(request):
    cell = cells.resolve(CELLS[request.param], np.eye(4), "developable")
    path = plan_joints(blade(), cell, JointParameters(degree=1))
    assert path.feasible, [issue.message for issue in path.issues]
    motion, issues = assemble(path, cell, ProcessParameters(travel_speed=8.0))
    assert not [issue for issue in issues if issue.level == "error"], issues
    return cell, motion, [bead_path.bead for bead_path in path.beads]


def test_the_torch_is_where_the_beads_are(planned):
    """The torch follows the beads."""
    cell, motion, beads = planned
    tip, tool = cell.tip_in_part(cell.machine.chain.forward(motion.joints[motion.deposit]))
    np.testing.assert_allclose(tip, np.concatenate([bead.points for bead in beads]), atol=1e-6)
    np.testing.assert_allclose(tool, np.concatenate([bead.tool for bead in beads]), atol=1e-9)
    # along the cone's normals, also at points added by planning
    surface = [CONE.offset(2.5 * (k // 3)) for k in range(len(beads))]
    for bead, cone in zip(beads, surface):
        assert (
            np.degrees(
                np.arccos(np.clip((bead.tool * cone.normals(bead.points)).sum(axis=1), -1, 1))
            ).max()
            < 0.3
        )


def read_back(cell, motion, kind):
    parameters = ProgramParameters(post="fanuc", motion=kind)
    program = build(motion, cell, ProcessParameters(travel_speed=8.0), parameters, "blade")
    return verification.verify(cell, motion, program, fanuc.write(program), fanuc, CHORD_ERROR)


def test_programs_are_read_back_to_the_plan(planned):
    cell, motion, _ = planned
    # FANUC accepts no positions with a fixed torch
    for kind in ("joint",) if cell.setup == "part-on-robot" else ("joint", "cartesian"):
        result = read_back(cell, motion, kind)
        assert (
            result.issues == ()
            and result.solvers == ("chain", "pykdl")
            and result.at_points_mm <= result.bound_mm
        )
