# SPDX-License-Identifier: LGPL-2.1-or-later
"""The path that was looked at is the path that a text drives: every post, motion and set-up, from the text alone, rapids
included, through PyKDL, against a hub, the deposit laid so far and the platform."""

import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.driven import Drive, depth_in_deposit, depth_in_hub
from tests.posts.planned_jobs import CHORD_ERROR, SETUPS, WAYS, written

# mm: how deep a travel may touch what its looks, 5 deg apart, did not see; and how far digits and chords lead away
DEEP, APART = 0.5, 0.15
CARTESIAN = ("fanuc", "cartesian", "time", "fanuc tool-on-robot")


def contacts(way, files):
    """(row, mm) of the travels of a text that get into hub, deposit or platform, and the drive."""
    cell, motion, _, _ = written(way)
    setup, rows = SETUPS[way[3]], np.flatnonzero(motion.moves)
    drive = Drive(cell, catalogue.load(way[0]).read(files), motion.joints[rows[0]])
    found, laid = [], np.zeros((0, 3))
    for row in range(1, len(rows)):
        tips, axes = drive.way(row)
        if drive.read.deposit[row]:
            laid = np.vstack([laid, tips[:: max(1, len(tips) // 3)]])
            continue
        if motion.role[rows[row]] != 2:  # retract and approach begin and end in what they touch
            continue
        height = (tips - cell.mount[:3, 3]) @ cell.mount[:3, 2]
        beside = np.linalg.norm((tips - cell.mount[:3, 3]) @ cell.mount[:3, :2], axis=1) > 0.5 * cell.platform_diameter
        deep = max(
            depth_in_hub(tips, axes, cell.nozzle, setup.hub, setup.top), depth_in_deposit(tips, axes, cell.nozzle, laid),
            float(np.where(beside, 0.0, -height).max()),
        )
        found += [(row, deep)] if deep > DEEP else []
    return found, drive


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_the_text_drives_the_way_that_was_looked_at(way):
    cell, motion, _, files = written(way)
    found, drive = contacts(way, files)
    assert found == []
    rows = np.flatnonzero(motion.moves)
    read, joints = drive.read, motion.joints[rows]
    # what stops and what runs straight, by the plan: rapids joint by joint and stopping, beads to their ends
    assert read.stops.tolist() == motion.stops[rows].tolist()
    assert read.linear.tolist() == (motion.deposit[rows] & (way[1] == "cartesian")).tolist()
    furthest = 0.0
    for row in np.flatnonzero(~motion.deposit[rows])[1:]:
        tips, axes = drive.way(row)
        planned = joints[row - 1] + np.linspace(0.0, 1.0, len(tips))[:, None] * (joints[row] - joints[row - 1])
        tip, axis = cell.tip_in_part(drive.arm.forward(planned))
        furthest = max(furthest, np.linalg.norm(tips - tip, axis=1).max(), 100.0 * np.linalg.norm(axes - axis, axis=1).max())
    assert 0.0 < furthest < APART


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_travels_have_something_to_pass(way):
    """The straight way of the tip would lead through the hub on most sides: what is driven is not free by chance."""
    _, motion, _, _ = written(way)
    rows = np.flatnonzero(motion.moves)
    lifted = np.flatnonzero(motion.role[rows] == 2)
    assert len(lifted) >= 5 and np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)[lifted[1:] - 1].min() > 60.0


def old_text(files):
    """As it was written before: rapids of Cartesian programs straight in space, without a stop on retract and travel."""
    (name, content), = files.items()
    text = re.sub(r"(?m)^( *\d+:)J(?= P\[\d+\] \d+msec)", r"\1L", content.decode())
    text = re.sub(r"FINE(?=    ;\r\n *\d+:[JL] P\[\d+\] \d+msec FINE)", "CNT100", text)
    return {name: text.encode()}


def test_straight_rapids_with_rounded_corners_are_found_by_the_drive_and_refused():
    cell, motion, program, files = written(CARTESIAN)
    old = old_text(files)
    found, drive = contacts(CARTESIAN, old)
    assert (~drive.read.stops).sum() > motion.deposit.sum() - 20 and drive.read.linear.sum() > motion.deposit.sum()
    assert found and max(deep for _, deep in found) > 5.0
    result = verify(cell, motion, program, old, catalogue.load("fanuc"), CHORD_ERROR)
    assert {"VERIFY_INTERPOLATION", "VERIFY_BLEND", "VERIFY_BETWEEN"} <= {i.code for i in result.issues if i.level == ERROR}
