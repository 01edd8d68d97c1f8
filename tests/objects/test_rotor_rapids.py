# SPDX-License-Identifier: LGPL-2.1-or-later
"""No travel in the listings of the example rotor on an ARC Mate 120iC, Cartesian, leads through the
hub. Its small sibling for every post, motion and set-up is tests/posts/test_contract.py."""

import re

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.motion import TRAVEL
from freecad_am.objects import program as programs
from freecad_am.posts.fanuc import post as fanuc
from tests.posts.driven import Drive, depth_in_hub

pytestmark = pytest.mark.any_version

HUB, TOP = Developable(60.0, 270.0), 90.0
# mm: checks 5 deg apart may miss this much
TOLERANCE_MM = 0.5


def travels_through_the_hub(cell, motion, files):
    """Return how deep, in mm, each travel of a text gets into the hub."""
    rows = np.flatnonzero(motion.moves)
    drive = Drive(cell, fanuc.read(files), motion.joints[rows[0]])
    travels = np.flatnonzero(motion.role[rows] == TRAVEL)
    return np.array(
        [depth_in_hub(*drive.way(row), cell.nozzle, HUB, TOP) for row in travels if row]
    )


@pytest.mark.long
def test_no_travel_of_the_rotor_leads_through_its_hub(doc, root, monkeypatch):
    verified = []
    real = programs.verification.verify
    monkeypatch.setattr(
        programs.verification,
        "verify",
        lambda *arguments: verified.append(arguments) or real(*arguments),
    )
    folder = root / "resources" / "examples" / "rotor"
    hub, blades = (api.open_part(doc, str(folder / name)) for name in ("hub.step", "blades.brep"))
    cell = api.make_cell(
        doc,
        machine="fanuc-arcmate120ic",
        setup="tool-on-robot",
        deposition_point=(1000.0, 0.0, -100.0, 0.0, 0.0, 0.0),
        branch=("front", "up", "flip"),
        nozzle_tool=(0.0, 0.0, 250.0, 0.0, 0.0, 0.0),
    )
    feature = api.make_developable_feature(doc, blades, hub, layer_height=3)
    toolpath = api.make_toolpath(doc, feature, cell)
    program = api.make_program(
        doc, api.make_joint_path(doc, toolpath, cell), name="rotor", motion="cartesian"
    )
    assert program.Status == "up to date"
    resolved, motion, _, files = verified[0][:4]
    depths = travels_through_the_hub(resolved, motion, files)
    assert len(depths) > 100 and depths.max() <= TOLERANCE_MM
    # in their earlier form, straight in space and rounded, some of the same travels lead through
    # the hub
    old_texts = {
        name: re.sub(rb"(?m)^( *\d+:)J(?= P\[\d+\] \d+msec)", rb"\1L", content).replace(
            b"msec FINE", b"msec CNT100"
        )
        for name, content in files.items()
    }
    through = travels_through_the_hub(resolved, motion, old_texts)
    assert (through > TOLERANCE_MM).sum() > 5
