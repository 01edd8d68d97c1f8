# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inspect: the user selects object and file, the panel shows figures, and the points have the
colours of their deviations."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.inspection.bands import bands
from freecad_am.gui.path import legend
from freecad_am.gui.simulation.dock import _beads
from freecad_am.gui.simulation.player import run_of

PANEL = "RoboticAM_Inspection"


@pytest.fixture
def part(person, root):
    document = App.newDocument("Measured")
    imported_part = api.open_part(
        document, str(root / "resources" / "examples" / "hemisphere.step")
    )
    api.make_feature(document, imported_part, layer_height=3)
    imported_part.ViewObject.Visibility = False
    return imported_part


@pytest.fixture
def points(root):
    return str(root / "resources" / "examples" / "inspection" / "hemisphere-synthetic.csv")


def figures(panel, person):
    """Return the figures of the table under their completely visible names; those of a position
    have its name before."""
    table, values, prefix = person.field(panel, "Figures"), {}, ""
    for row in range(table.rowCount()):
        name = table.item(row, 0)
        room = table.viewport().width() if table.columnSpan(row, 0) > 1 else table.columnWidth(0)
        assert table.fontMetrics().boundingRect(name.text()).width() < room, name.text()
        if table.columnSpan(row, 0) > 1:
            prefix = f"{name.text()} "
        else:
            prefix = prefix if name.text().startswith("\u2003") else ""
            values[prefix + name.text().strip()] = table.item(row, 1).text()
    return values


def green_and_red(person):
    """Return how many pixels have the colours of points within tolerance, and of the largest
    deviation."""
    colours = {band.text: 255.0 * np.array(band.colour) for band in bands(0.05)}
    pixels = person.picture()
    return [
        int((np.abs(pixels - colours[name]).max(axis=1) < 12).sum())
        for name in ("within ±0.05", "0.05 … 0.1")
    ]


def test_inspected_by_clicks_undone_saved_and_opened_again(person, hand, part, points, tmp_path):
    document, steps = part.Document, part.Document.UndoCount
    hand.click(person.button("RoboticAM_Inspect"))
    panel = person.panel(PANEL)
    assert person.field(panel, "Planned").currentText() == "Feature"
    person.type(panel, "File", points)
    hand.enter(panel, "Tolerance", "0.05 mm")
    hand.enter(panel, "ProbeRadius", "1.5 mm")
    person.type(panel, "Heights", "15 25 35")
    person.press("Apply")
    inspection = document.getObject("Inspection")
    assert inspection is not None, person.panel_error(panel)
    assert (inspection.Status, document.UndoCount) == ("up to date", steps + 1)
    shown_figures = figures(panel, person)
    assert float(shown_figures["Sphericity"]) == pytest.approx(0.275, abs=0.01)
    assert float(shown_figures["At height 35 mm Circularity"]) > float(
        shown_figures["At height 15 mm Circularity"]
    )
    assert person.field(panel, "DeviationHistogram").isVisible()
    green, yellow = green_and_red(person)
    assert green > 500 and yellow > 100
    assert [legend._lines((), scale) for scale in legend.visible_scales(document)] == [
        ["deviation, mm"]
    ]
    person.screenshot("inspection")
    person.press("Ok")
    person.panel_closed()
    person.gui.runCommand("Std_Undo")
    person.idle(0.3)
    assert document.getObject("Inspection") is None and legend.visible_scales(document) == []
    person.gui.runCommand("Std_Redo")
    person.idle(0.3)
    assert min(green_and_red(person)) > 100

    path = str(tmp_path / "measured.FCStd")
    document.saveAs(path)
    App.closeDocument(document.Name)
    opened = App.openDocument(path)
    person.idle(0.5)
    again = opened.Inspection
    assert again.Status == "up to date" and min(green_and_red(person)) > 100
    person.double_click(again)
    assert figures(person.panel(PANEL), person) == shown_figures
    person.press("Cancel")
    person.panel_closed()


def test_a_long_message_is_seen_whole_in_a_narrow_panel(person, part, tmp_path):
    person.select(part)
    person.click("RoboticAM_Inspect")
    panel = person.panel(PANEL)
    panel.setFixedWidth(220)
    (tmp_path / "commas.csv").write_text("1,5,2,5,3,5\n2,5,3,5,4,5\n")
    (tmp_path / "words.csv").write_text("a;b;c\n")
    note = person.field(panel, "FileNote")
    for name in (
        str(tmp_path / "commas.csv"),
        "nowhere.csv",
        str(tmp_path / "words.csv"),
        str(tmp_path / "commas.csv"),
    ):
        person.type(panel, "File", name)
        person.press("Ok")
        person.until(
            lambda: note.isVisible() and note.height() >= note.heightForWidth(note.width()),
            f"all about {name}",
            5,
        )
        assert note.height() > 2 * note.fontMetrics().lineSpacing()
        assert note.parentWidget().height() >= note.geometry().bottom()
    person.press("Cancel")
    person.panel_closed()


def test_what_is_wrong_is_told_beside_its_field_and_nothing_is_left(person, part, points, tmp_path):
    document = part.Document
    person.select(part)
    person.click("RoboticAM_Inspect")
    panel = person.panel(PANEL)
    assert person.field(panel, "Planned").currentText() == part.Label
    person.press("Ok")
    assert "choose a file" in person.panel_error(panel)
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "scan.docx").write_text("1 2 3")
    (tmp_path / "words.csv").write_text("a;b;c\n")
    note = person.field(panel, "FileNote")
    for name, message in (
        ("nowhere.csv", "cannot be read"),
        ("empty.csv", "empty"),
        ("scan.docx", "not a supported point format"),
        ("words.csv", "three numbers"),
    ):
        person.type(panel, "File", str(tmp_path / name))
        person.press("Ok")
        assert note.isVisible() and message in note.text(), (
            name,
            note.text(),
            person.panel_error(panel),
        )
        assert document.getObject("Inspection") is None
    person.type(panel, "File", points)
    person.type(panel, "Heights", "high")
    person.press("Ok")
    note = person.field(panel, "HeightsNote")
    assert note.isVisible() and "not a height" in note.text()
    person.press("Cancel")
    person.panel_closed()
    assert document.getObject("Inspection") is None


def test_what_was_to_be_compared_is_deleted_while_the_panel_is_open(person, part, points):
    document = part.Document
    person.click("RoboticAM_Inspect")
    panel = person.panel(PANEL)
    person.type(panel, "File", points)
    document.removeObject("Feature")
    person.press("Ok")
    assert "deleted" in person.panel_error(panel) and document.getObject("Inspection") is None
    person.choose(panel, "Planned", part.Label)
    person.type(panel, "ProbeRadius", "1.5 mm")
    person.press("Ok")
    person.panel_closed()
    inspection = document.Inspection
    assert inspection.Status == "up to date" and abs(inspection.Mean.Value) < 0.01
    document.removeObject(part.Name)
    document.recompute()
    person.idle(0.3)
    assert inspection.Status == "failed" and "missing" in inspection.Message
    person.double_click(inspection)
    assert person.field(person.panel(PANEL), "Figures").rowCount() > 5
    person.press("Cancel")
    person.panel_closed()


def test_panel_survives_its_document(person, part, points):
    person.click("RoboticAM_Inspect")
    panel = person.panel(PANEL)
    person.type(panel, "File", points)
    App.closeDocument(part.Document.Name)
    App.newDocument("Other")
    person.press("Ok")
    if person.gui.Control.activeDialog():
        person.press("Cancel")
    person.panel_closed()


def test_a_predicted_deposit_is_shown_by_a_click_and_grows_as_high(person, hand, part):
    """No file is needed: the predicted deposit of the toolpath appears in the colours of its
    deviations, with histogram and figures. A simulation then draws beads as high as their predicted
    ends."""
    document = part.Document
    cell = api.make_cell(document, limits="paper")
    path = api.make_toolpath(document, document.Feature, cell, bead_width=6)
    joints = api.make_joint_path(document, path, cell)
    for drawn in (cell, path, joints, document.Feature):
        drawn.ViewObject.Visibility = False
    hand.click(person.button("RoboticAM_Inspect"))
    panel = person.panel(PANEL)
    hand.click(person.field(panel, "PredictedDeposit"))
    assert person.field(panel, "Planned").currentText() == path.Label
    hand.enter(panel, "Tolerance", "1 mm")
    person.press("Apply")
    inspection = document.getObject("Inspection")
    assert inspection is not None, person.panel_error(panel)
    result = api.result(inspection)
    assert person.field(panel, "DeviationHistogram").isVisible()
    assert int(figures(panel, person)["Points"]) == len(result.deviation)
    assert [legend._lines((), scale) for scale in legend.visible_scales(document)] == [
        ["deviation, mm"]
    ]
    person.look()
    shades = {band.text: 255.0 * np.array(band.colour) for band in bands(1.0)}
    pixels = person.picture()
    assert (
        max(int((np.abs(pixels - shade).max(axis=1) < 12).sum()) for shade in shades.values()) > 500
    )
    person.screenshot("predicted-deposit")
    person.press("Ok")
    person.panel_closed()
    run = run_of(joints)
    assert run.deposit is not None and len(run.deposit) == len(result.laid)
    beads = _beads(run)
    low = result.laid[result.laid[:, 3] == 0]
    assert float(beads[0].height.mean()) == pytest.approx(
        float(np.maximum(low[:, 4], 1e-3).mean()), rel=0.02
    )
    path.BeadWidth = 5  # another deposit, without a prediction
    assert run_of(joints).deposit is None


def test_what_is_asked_about_a_scan_is_shown_with_a_scan_alone(person, part, points):
    document = part.Document
    scan = api.inspect(document, part, points)
    api.make_cell(document)
    person.select(document.Feature)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    choice, fold = person.field(panel, "InputScan"), person.field(panel, "FoldScan:advanced")
    assert choice.currentText() == "none" and not fold.isVisible()
    choice.setCurrentIndex(choice.findData(scan.Name))
    person.until(fold.isVisible, "what is asked about a scan", 5)
    choice.setCurrentIndex(choice.findData(""))
    person.until(lambda: not fold.isVisible(), "it to go", 5)
    person.press("Cancel")
