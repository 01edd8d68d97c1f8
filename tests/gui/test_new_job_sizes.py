# SPDX-License-Identifier: LGPL-2.1-or-later
"""New Job has fields for layer height, width or spacing of beads and the platform, with units and
expressions."""

import math

import numpy as np
import pytest

from freecad_am import api


@pytest.fixture
def rough(monkeypatch):
    make = api.make_feature_of
    monkeypatch.setattr(
        api,
        "make_feature_of",
        lambda *arguments, values, **named: make(
            *arguments, values={"chord_error": 0.3, **values}, **named
        ),
    )


def test_sizes_of_a_wall_are_entered_with_units_and_follow_expressions(person, hemisphere, rough):
    doc = hemisphere.Document
    sheet = doc.addObject("Spreadsheet::Sheet", "Sizes")
    sheet.set("A1", "=12 mm")
    sheet.setAlias("A1", "layer")
    doc.recompute()
    steps = doc.UndoCount
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(lambda: person.field(panel, "reason").text(), "the proposal", 20)
    person.as_revolution()
    fields = {
        name: person.field(panel, name)
        for name in ("LayerHeight", "BeadWidth", "BeadSpacing", "PlatformDiameter")
    }
    assert all(field.toolTip() and field.whatsThis() for field in fields.values())
    assert fields["BeadWidth"].isEnabled() and not fields["BeadSpacing"].isEnabled()
    person.type(panel, "BeadWidth", "0.6 s")
    person.press("Ok")
    assert "'0.6 s' is not understood" in person.panel_error(panel) and doc.UndoCount == steps
    person.type(panel, "LayerHeight", "=Sizes.layer")
    person.type(panel, "BeadWidth", "0.6 cm")
    person.type(panel, "PlatformDiameter", "160")  # in the unit of the scheme, mm
    person.press("Ok")
    person.panel_closed()
    cell, feature, toolpath = api.stages_of(doc)[:3]
    assert doc.UndoCount == steps + 1
    assert dict(feature.ExpressionEngine) == {"LayerHeight": "Sizes.layer"}
    assert math.isclose(feature.LayerHeight.Value, 12.0)
    assert math.isclose(toolpath.BeadWidth.Value, 6.0)
    assert math.isclose(cell.PlatformDiameter.Value, 160.0)


def test_solids_have_a_spacing_and_a_platform_left_empty_is_sized_from_the_part(person, doc, rough):
    box = doc.addObject("Part::Box", "Block")
    box.Length, box.Width, box.Height = 150, 40, 16
    doc.recompute()
    person.select(box)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    spacing, width = person.field(panel, "BeadSpacing"), person.field(panel, "BeadWidth")
    person.until(spacing.isEnabled, "the spacing of a solid", 20)
    assert not width.isEnabled()
    person.type(panel, "LayerHeight", "8 mm")
    person.type(panel, "BeadSpacing", "8 mm")
    assert not person.field(panel, "PlatformDiameter").lineEdit().text()
    person.press("Ok")
    person.panel_closed()
    cell, feature, toolpath = api.stages_of(doc)[:3]
    assert math.isclose(feature.LayerHeight.Value, 8.0)
    assert math.isclose(feature.BeadSpacing.Value, 8.0)
    first_layer = np.vstack([bead.points for bead in api.result(toolpath).layers[0].beads])
    across = np.hypot(*np.ptp(first_layer[:, :2], axis=0))  # from corner to corner
    assert 140.0 < across < cell.PlatformDiameter.Value < across + 20.0


def test_a_width_that_is_entered_is_what_the_kind_is_proposed_by(person, doc):
    cup = doc.addObject("Part::Feature", "Cup")
    import Part

    cup.Shape = Part.makeCylinder(40, 30).cut(Part.makeCylinder(36, 30))
    doc.recompute()
    person.select(cup)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    left_out = person.field(panel, "left_out")
    person.until(lambda: "beads are 8 mm wide" in left_out.text(), "that beads are too wide", 20)
    person.type(panel, "BeadWidth", "4 mm")
    person.field(panel, "BeadWidth").editingFinished.emit()
    person.until(
        lambda: not left_out.text() and "one bead of 4 mm" in person.field(panel, "reason").text(),
        "that nothing is wrong with beads as wide as the wall",
        20,
    )
    person.press("Cancel")
    person.panel_closed()
