# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rotation of a plan along the beads of its toolpath, wherever their seams were put and however they were cut."""

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
    toolpath = sliced("sphere", 15.0)
    cell = cell_of(toolpath) if half is None else with_axis_6(cell_of(toolpath), half)
    path = plan_joints(toolpath, cell, JointParameters())
    assert path.feasible
    beads, places = beads_of(toolpath)
    if half == 150.0:
        assert len(path.beads) > len(beads)
    found = rotation_along(
        path.beads, beads, places, {k: bead.parameter for k, bead in enumerate(beads)}
    )
    for k, (bead, (layer, _)) in enumerate(zip(beads, places)):
        pieces = [piece for piece in path.beads if piece.layer == layer]
        there = np.concatenate([piece.bead.points for piece in pieces])
        phi = np.concatenate([piece.phi for piece in pieces])
        for point, turned in zip(bead.points[::5], found[k][::5]):
            away = np.linalg.norm(there - point, axis=1)
            at = np.flatnonzero(away < 1e-6)
            assert len(at)
            assert min(abs(np.exp(1j * phi[at]) - np.exp(1j * turned))) < 1e-6
        assert (
            np.abs(np.diff(found[k])).max() < PARTED * TURN + 1e-9
        )  # pieces may lie apart, but not by turns
    middle = {1: 0.5 * (beads[1].parameter[1:] + beads[1].parameter[:-1])}
    assert list(rotation_along(path.beads, beads, places, middle)) == [1]


def test_what_the_path_does_not_have_is_zero(sliced, cell_of):
    toolpath = sliced("sphere", 15.0)
    beads, places = beads_of(toolpath)
    assert not rotation_along((), beads, places, {0: beads[0].parameter})[0].any()
