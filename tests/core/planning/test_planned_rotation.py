# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rotation of a plan along the beads of its toolpath, whatever their seams and splits."""

import numpy as np
import pytest

from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import TURN
from freecad_am.core.planning.rotation.planned import PARTED, rotation_along


def beads_of(toolpath):
    return [bead for _, _, bead in toolpath], [(layer, index) for layer, index, _ in toolpath]


@pytest.mark.parametrize(
    "half", [None, 200.0, 185.0, 150.0], ids=["endless", "as they are", "seams moved", "cut"]
)
def test_it_is_that_of_the_path_at_the_same_places(sliced, cell_of, with_axis_6, half):
    """The rotation agrees with the path at the same positions."""
    toolpath = sliced("sphere", 15.0)
    cell = cell_of(toolpath) if half is None else with_axis_6(cell_of(toolpath), half)
    path = plan_joints(toolpath, cell, JointParameters())
    assert path.feasible
    beads, bead_places = beads_of(toolpath)
    if half == 150.0:
        assert len(path.beads) > len(beads)
    rotations = rotation_along(
        path.beads, beads, bead_places, {k: bead.parameter for k, bead in enumerate(beads)}
    )
    for k, (bead, (layer, _)) in enumerate(zip(beads, bead_places)):
        paths_of_layer = [bead_path for bead_path in path.beads if bead_path.layer == layer]
        points = np.concatenate([bead_path.bead.points for bead_path in paths_of_layer])
        phi = np.concatenate([bead_path.phi for bead_path in paths_of_layer])
        for point, turned in zip(bead.points[::5], rotations[k][::5]):
            distances = np.linalg.norm(points - point, axis=1)
            matches = np.flatnonzero(distances < 1e-6)
            assert len(matches)
            assert min(abs(np.exp(1j * phi[matches]) - np.exp(1j * turned))) < 1e-6
        assert (
            np.abs(np.diff(rotations[k])).max() < PARTED * TURN + 1e-9
        )  # parts of a bead may differ, but not by whole turns
    middle = {1: 0.5 * (beads[1].parameter[1:] + beads[1].parameter[:-1])}
    assert list(rotation_along(path.beads, beads, bead_places, middle)) == [1]


def test_what_the_path_does_not_have_is_zero(sliced, cell_of):
    toolpath = sliced("sphere", 15.0)
    beads, bead_places = beads_of(toolpath)
    assert not rotation_along((), beads, bead_places, {0: beads[0].parameter})[0].any()
