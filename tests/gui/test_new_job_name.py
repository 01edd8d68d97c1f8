# SPDX-License-Identifier: LGPL-2.1-or-later
"""The name of a new job's program follows the machine until the user types another one. A name that
the controller rejects gives a message under the field before planning."""

from freecad_am import api


def test_the_name_follows_the_machine_until_another_one_is_typed(person, hand, hemisphere):
    doc = hemisphere.Document
    hemisphere.Label = "Nozzle of the second stage"
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    name, note = person.field(panel, "ProgramName"), person.field(panel, "ProgramNameNote")
    person.as_revolution(panel)
    assert name.text() == api.proposed_name(hemisphere.Label) == "NOZZLE_OF_THE_SECOND"
    hand.enter(panel, "Machine", "abb-irb140")
    person.until(lambda: name.text() == "NOZZLE_OF", "a name that the controller takes", 5)
    assert not note.isVisible()
    hand.enter(panel, "Machine", "fanuc-arcmate120ic")
    person.until(lambda: name.text() == "NOZZLE_OF_THE_SECOND", "the longer name", 5)
    person.type(panel, "ProgramName", "SECOND_STAGE_NOZZLE")
    assert not note.isVisible()
    hand.enter(panel, "Machine", "abb-irb140")
    person.until(note.isVisible, "that the controller refuses the name that was typed", 5)
    assert name.text() == "SECOND_STAGE_NOZZLE" and "more than 14 characters" in note.text()
    person.screenshot("new_job_name_refused")
    fold = person.field(panel, "FoldInputs")
    for folded in (False, True):
        if folded:
            fold.click()
            assert not note.isVisible()
        person.press("Ok")
        assert (
            note.isVisible() and fold.isChecked() and api.stages_of(doc) == []
        )  # no planning has started
    person.type(panel, "ProgramName", "STAGE_2")
    person.until(lambda: not note.isVisible(), "the note to go", 5)
    hand.enter(panel, "Machine", "fanuc-arcmate120ic")
    assert name.text() == "STAGE_2"
    hand.enter(panel, "Machine", "no-such-machine")
    fold.click()
    person.press("Ok")
    assert (
        fold.isChecked() and person.field(panel, "MachineNote").isVisible()
    )  # this also holds for errors during planning
    person.press("Cancel")
    person.panel_closed()


def test_a_program_is_called_so_that_the_controller_of_its_machine_takes_it(
    person, hemisphere, coarse, no_remedies
):
    doc = hemisphere.Document
    hemisphere.Label = "Nozzle of the second stage"
    for machine, name in (("", "NOZZLE_OF_THE_SECOND"), ("abb-irb140", "NOZZLE_OF")):
        path = api.make_all(doc, hemisphere, machine=machine, post="none")[3]
        person.select(path)
        person.click("RoboticAM_Program")
        panel = person.panel("RoboticAM_Program")
        assert person.field(panel, "ProgramName").text() == name
        person.until(
            lambda panel=panel: person.field(panel, "FirstLines").isVisible(), "how it begins", 20
        )
        assert not person.field(panel, "ProgramNameNote").isVisible()
        person.press("Cancel")
        person.panel_closed()
