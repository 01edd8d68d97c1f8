# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job with the torch on a robot, by clicks: New Job proposes a positioner if the torch
would lean too far, and the view shows the robot there; machines without a choice have no fields
for it."""

import math

import numpy as np

from freecad_am import api
from freecad_am.core.parameters.cell_records import EXTERNAL

ROBOT = "kuka-kr8-r2100-2-arc-hw"


def test_a_positioner_is_proposed_in_new_job_and_the_robot_is_shown_there(
    person, hand, hemisphere, monkeypatch
):
    doc = hemisphere.Document
    steps, make = doc.UndoCount, api.make_feature_of
    monkeypatch.setattr(
        api,
        "make_feature_of",
        lambda *arguments, values, **named: make(
            *arguments, values={"layer_height": 15.0, "chord_error": 0.3, **values}, **named
        ),
    )
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    setup, leaning = person.field(panel, "Setup"), person.field(panel, "MaxFromVertical")
    assert setup.isEnabled() and not leaning.isEnabled() and setup.count() == 2
    hand.enter(panel, "Machine", "table-xyzac")
    person.until(lambda: not setup.isEnabled(), "no set-up of a machine with five axes", 5)
    hand.enter(panel, "Machine", ROBOT)
    person.until(setup.isEnabled, "the set-ups of a robot", 5)
    person.choose(panel, "Setup", "tool-on-robot")
    person.until(leaning.isEnabled, "how far a torch may lean", 5)
    hand.enter(panel, "MaxFromVertical", "10 deg")
    person.as_revolution()
    console_length = len(person.console())
    person.press("Ok")
    person.panel_closed()
    cell, feature, _, path = api.stages_of(doc)[:4]
    assert (path.Status, doc.UndoCount) == ("up to date", steps + 1), api.issues(path)
    assert math.isclose(feature.MaxFromVertical.Value, 10.0) and cell.Setup == "tool-on-robot"
    (positioner,) = EXTERNAL.read(cell.External)
    assert positioner.carries == "part"
    assert (
        f"proposed for this job: {EXTERNAL.text([positioner])}" in person.console()[console_length:]
    )
    # the robot is drawn there with its torch on the part
    assert cell.ViewObject.ShowMachine and cell.ViewObject.Proxy.nodes.machine is not None
    person.look()
    person.screenshot("new_job_positioner")
    joints = np.concatenate([bead.joints for bead in api.result(path).joint_path.beads])
    assert joints.shape[1] == 8 and np.ptp(joints[:, 6:], axis=0).max() > math.radians(20.0)


def test_a_set_up_is_proposed_in_which_a_program_is_written_and_that_of_the_last_cell_is_kept(
    person, hand, hemisphere
):
    doc = hemisphere.Document
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    setup, without = person.field(panel, "Setup"), person.field(panel, "no_post")
    assert setup.currentData() == "part-on-robot"
    hand.enter(panel, "Machine", "kuka-kr16-2")
    person.until(
        lambda: setup.currentData() == "tool-on-robot", "a set-up that programs are written in", 5
    )
    assert not without.isVisible()
    hand.enter(panel, "Machine", "abb-irb140")
    person.until(
        lambda: setup.currentData() == "part-on-robot",
        "the usual one of a robot that has programs of it",
        5,
    )
    hand.enter(panel, "Machine", "kuka-kr16-2")
    person.choose(panel, "Setup", "part-on-robot")
    person.until(without.isVisible, "that no program is written", 5)  # the user's own choice stays
    assert setup.currentData() == "part-on-robot" and "need the tool on the robot" in without.text()
    person.press("Cancel")
    person.panel_closed()
    for last_setup in ("tool-on-robot", "part-on-robot"):
        api.make_cell(doc, machine="fanuc-m710ic-12l", setup=last_setup, branch="auto")
        person.click("RoboticAM_NewJob")
        panel = person.panel("RoboticAM_NewJob")
        assert person.field(panel, "Setup").currentData() == last_setup
        person.press("Cancel")
        person.panel_closed()
