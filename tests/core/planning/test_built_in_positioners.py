# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every built-in positioner carries a part that must be tilted: driven in the world by PyKDL chains
built from its file."""

import json

import numpy as np
import pytest

from freecad_am.core.kinematics.external import MECHANISMS, load, positioners
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.motion import assemble
from tests.core.planning import test_external_axes as cells

KNOWN = sorted(
    path.stem for path in MECHANISMS.glob("*.json") if not load(path.stem).chain.sliding.any()
)
STANDS = (1400.0, 120.0, -400.0, 0.0, 0.0, 30.0)


def test_each_names_its_source_and_what_is_not_known():
    assert len(KNOWN) == 4
    for name in KNOWN:
        description = json.loads((MECHANISMS / f"{name}.json").read_text(encoding="utf-8"))
        assert (
            description["sources"]
            and description["limits"]["maker"]["source"]
            and description["payload"]["source"]
        )
        slow = all(joint["max_speed"] for joint in description["joints"])
        assert slow or any("speeds were not found" in remark for remark in description["remarks"])


@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.always("kuka-kp2-hv500")
def test_a_part_is_carried_and_kept_upright(sliced, name):
    toolpath = cells.levelled_to(sliced("sphere", 20.0, chord_error=0.3), 10.0)
    cell = cells.cell_for(toolpath, positioner=name, stands=STANDS)
    planned = cells.feasible(toolpath, cell)
    tip, _, upward = cells.in_the_world(planned.joints, MECHANISMS / f"{name}.json", STANDS)
    tip = tip @ toolpath.frame[:3, :3].T + toolpath.frame[:3, 3]
    assert np.abs(tip - np.concatenate([path.bead.points for path in planned.beads])).max() < 1e-6
    assert np.degrees(np.arccos(np.clip(upward @ cells.UP, -1.0, 1.0))).max() < 10.0 + 1e-6
    limits = np.radians(
        json.loads((MECHANISMS / f"{name}.json").read_text())["limits"]["maker"]["axes"]
    )
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    assert (motion.joints[:, 6:] >= limits[:, 0]).all() and (
        motion.joints[:, 6:] <= limits[:, 1]
    ).all()
    assert np.isfinite(motion.duration).all() and (motion.duration[motion.moves][1:] > 0.0).all()


def test_one_whose_speeds_are_known_is_offered_first():
    """The positioner with known speeds is proposed first."""
    robot = machines.load("kuka-kr8-r2100-2-arc-hw")
    assert [positioner.id for positioner in positioners(robot, 100.0, 50.0)] == [
        "motoman-motopos-d500",
        "kuka-dkp-400",
        "kuka-kp2-hv500",
        "abb-irbp-a250",
    ]
    assert [positioner.id for positioner in positioners(robot, 450.0, 50.0)] == [
        "motoman-motopos-d500",
        "kuka-kp2-hv500",
    ]
