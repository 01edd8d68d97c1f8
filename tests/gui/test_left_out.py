# SPDX-License-Identifier: LGPL-2.1-or-later
"""A click on one face selects the part, and the panel states which regions of it would not be
deposited."""

import FreeCAD as App
import Part
import pytest

from freecad_am import api


@pytest.fixture
def rod(person):
    """Return a solid cylinder, of which a bead would print only a skin."""
    doc = App.newDocument("Rod")
    rod_object = doc.addObject("Part::Feature", "Rod")
    rod_object.Shape = Part.makeCylinder(30, 40)
    doc.recompute()
    person.gui.Selection.clearSelection()
    yield rod_object
    App.closeDocument(doc.Name)


def test_one_face_clicked_is_the_whole_part_for_a_new_job_and_several_are_faces(person, rod):
    select = person.gui.Selection.addSelection
    select(rod.Document.Name, rod.Name, "Face1")
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    field = {name: person.field(panel, name) for name in ("Source", "reason", "left_out")}
    person.until(
        lambda: "would leave out" in field["reason"].text(),
        "that a wall of one bead is not proposed",
        30,
    )
    assert person.field(panel, "Kind").currentText() == "Solids in plane layers"
    person.as_revolution(panel)
    person.until(lambda: field["left_out"].text(), "what would be left out", 30)
    assert field["Source"].text() == "Rod" and "The whole of Rod is used" in field["reason"].text()
    assert "of the 113 cm3 of Rod are not deposited" in field["left_out"].text()
    select(rod.Document.Name, rod.Name, "Face2")
    person.until(lambda: field["Source"].text() == "Rod Face1 Face2", "faces to be taken", 10)
    person.until(
        lambda: "Looking" not in field["reason"].text(), "the selection to be understood", 20
    )
    assert "The whole of" not in field["reason"].text()
    person.press("Cancel")


def test_a_feature_tells_what_it_leaves_out_and_takes_one_face_when_asked_for(person, rod):
    person.gui.Selection.addSelection(rod.Document.Name, rod.Name, "Face1")
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    source, state = (person.field(panel, name) for name in ("Source", "preview"))
    person.until(lambda: "not deposited" in state.text(), "the preview", 30)
    assert source.text() == "Rod" and "of the 113 cm3 of Rod are not deposited" in state.text()
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection(rod.Document.Name, rod.Name, "Face1")
    person.field(panel, "UseSource").click()
    assert source.text() == "Rod Face1"
    person.press("Ok")
    person.until(lambda: not person.gui.Control.activeDialog(), "the feature to be made", 30)
    assert rod.Document.Feature.Source[1] == ["Face1"]
    toolpath = api.make_toolpath(rod.Document, rod.Document.Feature)
    assert [issue.code for issue in api.issues(toolpath)][:1] == ["NOT_DEPOSITED"]
