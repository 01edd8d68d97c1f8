# SPDX-License-Identifier: LGPL-2.1-or-later
"""The seam in the panel of a toolpath: what a position uses, a place clicked on the part, the view."""

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
import pytest

from freecad_am import api

PANEL = "RoboticAM_Toolpath"


@pytest.fixture
def block(person):
    document = App.newDocument("Block")
    part = document.addObject("Part::Box", "Block")
    part.Length, part.Width, part.Height = 60, 40, 6
    part.Placement.Base = App.Vector(100, 0, 0)
    document.recompute()
    feature = api.make_solid_feature(document, part, layer_height=2, bead_spacing=4)
    person.idle()
    return feature


def visible(person, panel, *names):
    return [name for name in names if person.field(panel, name).isVisible()]


def open_seam(person, panel):
    """Unfold the section with the seam."""
    for heading in panel.findChildren(person.widgets.QAbstractButton):
        if heading.isCheckable() and not heading.isChecked() and heading.text() == "Seam":
            heading.setChecked(True)
    person.idle()


def choose_position(person, panel, key):
    combo = person.field(panel, "SeamPosition")
    combo.setCurrentIndex(combo.findData(key))
    person.idle()


def outer_starts(toolpath):
    return np.array(
        [
            bead.points[0]
            for _, _, bead in api.result(toolpath)
            if bead.closed and not bead.role.ring
        ]
    )


def test_seam_point_and_viewer_are_taken_from_the_view(person, hand, block):
    document, part = block.Document, block.Document.Block
    person.select(block)
    person.click(PANEL)
    panel = person.panel(PANEL)
    open_seam(person, panel)
    fields = ("SeamAngle", "SeamPoint", "SeamAwayFrom", "TakeSeamPoint")
    assert visible(person, panel, *fields) == ["SeamAngle"]
    choose_position(person, panel, "point")
    assert visible(person, panel, *fields) == ["SeamPoint", "TakeSeamPoint"]

    Gui.Selection.clearSelection()
    hand.click(person.field(panel, "TakeSeamPoint"))
    assert person.field(panel, "SeamPoint").text() == "none"
    Gui.Selection.addSelection(document.Name, part.Name, "Face2", 160.0, 30.0, 3.0)
    hand.click(person.field(panel, "TakeSeamPoint"))
    assert person.field(panel, "SeamPoint").text() == "160 30 3"
    person.screenshot("seam_panel")
    person.press("Ok")
    toolpath = document.Toolpath
    assert toolpath.SeamPosition == "point" and toolpath.SeamPoint == "160 30 3"
    starts = outer_starts(toolpath)
    assert len(starts) == 3
    assert starts[:, :2] == pytest.approx(np.tile([158.0, 30.0], (3, 1)), abs=0.02)

    Gui.activeDocument().activeView().viewRear()
    person.idle()
    person.double_click(toolpath)
    panel = person.panel(PANEL)
    open_seam(person, panel)
    choose_position(person, panel, "spread")
    names = ("SeamAngle", "SeamDistance", "SeamScarf", "SeamAwayFrom")
    assert visible(person, panel, *names) == ["SeamAngle", "SeamDistance", "SeamScarf"]
    assert person.field(panel, "SeamDistance").text() == "15 mm"
    person.type(panel, "SeamScarf", "12 mm")
    person.screenshot("seam_spread")
    choose_position(person, panel, "hidden")
    hand.click(person.field(panel, "TakeSeamDirection"))
    assert person.field(panel, "SeamAwayFrom").text() == "0 1 0"
    person.press("Ok")
    starts = outer_starts(toolpath)
    assert starts[:, :2] == pytest.approx(np.tile([130.0, 2.0], (3, 1)), abs=0.1)
    issues = {issue.code for issue in api.result(toolpath).issues}
    assert "NO_EFFECT" in issues  # the point is still set
    assert all(
        bead.scarf for _, _, bead in api.result(toolpath) if bead.length > 24.0 and bead.closed
    )
