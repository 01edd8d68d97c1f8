# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's three parts from shipped STEP files to layers (Chalvin 2020, eqs. 20 to 22, 1 mm
layers)."""

import numpy as np
import pytest

from freecad_am.brep.files.read import read_shape
from freecad_am.brep.revolution.wall import find_wall
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies.revolution import plan as revolution


def sphere(z):
    return np.sqrt(45.0**2 - z**2)


def laval(z):
    low = z <= 96.5
    return np.where(
        low,
        np.sqrt(20.0 * (100.0 - np.minimum(z, 96.5))),
        np.sqrt(6.0 * (np.maximum(z, 96.5) - 85.0)),
    )


def funnel(z):
    return 90.0 - np.sqrt(45.0**2 - z**2)


@pytest.mark.parametrize(
    ("name", "equation", "layers", "top"),
    [
        ("hemisphere", sphere, 71, 45.0),
        ("laval-nozzle", laval, 137, 128.0),
        ("intake-funnel", funnel, 71, 45.0),
    ],
)
def test_the_papers_parts_have_the_papers_layers(root, name, equation, layers, top):
    wall = find_wall(read_shape(root / "resources" / "examples" / f"{name}.step"))
    assert wall.full
    assert wall.frame == pytest.approx(
        np.eye(4), abs=1e-10
    )  # the file gives angles with twelve digits
    assert wall.meridian.points[-1, 1] == pytest.approx(top, abs=1e-9)
    toolpath = revolution.plan(
        wall,
        RevolutionParameters(),
        BuildDirectionParameters(),
        ProcessParameters(),
        NozzleParameters(),
        113.0,
    )
    assert len(toolpath.layers) == layers
    assert toolpath.bead_count == layers
    assert not [issue for issue in toolpath.issues if issue.level == "error"]
    for _, _, bead in toolpath:
        radius = np.hypot(bead.points[:, 0], bead.points[:, 1])
        # measured across the wall, because a nearly level wall makes the radius at a height
        # uncertain
        slope = np.abs(
            np.gradient(
                equation(np.clip(bead.points[0, 2] + np.array([-1e-4, 0.0, 1e-4]), 0.0, top)), 1e-4
            )[1]
        )
        off = np.abs(radius - equation(np.minimum(bead.points[:, 2], top))) / np.hypot(1.0, slope)
        assert off.max() < 1e-6


def test_the_throat_of_the_laval_nozzle_is_told(root):
    wall = find_wall(read_shape(root / "resources" / "examples" / "laval-nozzle.step"))
    assert [issue.code for issue in wall.issues] == ["STEP"]
    assert "0.06" in wall.issues[0].message
    below, above = wall.meridian.kinks
    assert above - below == pytest.approx(np.sqrt(70.0) - np.sqrt(69.0), abs=1e-7)
    _, height, tangent = wall.meridian.at([below, above + 1e-3])
    assert height == pytest.approx([96.5, 96.501], abs=1e-3)
    turn = np.degrees(np.arccos((tangent[0] * tangent[1]).sum()))
    assert turn == pytest.approx(
        np.degrees(np.arctan(10.0 / np.sqrt(70.0)) + np.arctan(3.0 / np.sqrt(69.0))), abs=0.05
    )
