# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels stay open after Apply, accept expressions, have help for every field, and compute previews
next to a responsive window."""

import gc
import threading
import time

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.gui.views import attach
from freecad_am.objects.surface_feature import SurfaceFeature

PANEL = "RoboticAM_RevolutionFeature"


def test_apply_makes_then_changes_in_a_step_each_and_cancel_leaves_it(person, hemisphere):
    document, steps = hemisphere.Document, hemisphere.Document.UndoCount
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel(PANEL)
    person.type(panel, "LayerHeight", "9 mm")
    person.press("Apply")
    feature = document.getObject("Feature")
    assert panel.isVisible() and (feature.LayerHeight.Value, document.UndoCount) == (9.0, steps + 1)
    assert "up to date" in person.field(panel, "findings").text()
    person.press("Apply")  # no value has changed since
    assert document.UndoCount == steps + 1
    person.type(panel, "LayerHeight", "-1 mm")
    person.press("Apply")
    note = person.field(panel, "LayerHeightNote")
    assert note.isVisible() and "more than 0 mm" in note.text() and document.UndoCount == steps + 1
    person.type(panel, "LayerHeight", "6 mm")
    person.press("Apply")
    assert (feature.LayerHeight.Value, document.UndoCount, note.isVisible()) == (
        6.0,
        steps + 2,
        False,
    )
    person.type(panel, "LayerHeight", "3 mm")
    person.screenshot("panel_apply")
    person.press("Cancel")
    person.panel_closed()
    assert (feature.LayerHeight.Value, document.UndoCount) == (6.0, steps + 2)
    assert len(api.stages_of(document)) == 1
    person.gui.runCommand("Std_Undo")
    assert feature.LayerHeight.Value == 9.0


def test_after_undo_and_redo_the_fields_show_what_the_document_has(person, hand, hemisphere):
    document = hemisphere.Document
    cell = api.make_cell(document, deposition_point="1000 50 900")
    person.double_click(cell)
    panel, steps = person.panel("RoboticAM_Cell"), document.UndoCount
    y, branch, diameter = (
        person.field(panel, name) for name in ("DepositionPointY", "Branch", "PlatformDiameter")
    )
    first_branch = branch.currentText()
    hand.enter(panel, "DepositionPointY", "60 mm")
    person.type(panel, "Branch", "front up flip")
    hand.click(applies(person))  # the button then has the focus
    person.until(lambda: document.UndoCount == steps + 1, "what is applied", 10)
    assert (cell.DepositionPoint.Base.y, cell.Branch, document.UndoCount) == (
        60.0,
        "front up flip",
        steps + 1,
    )
    person.type(panel, "PlatformDiameter", "410 mm")  # not applied yet
    hand.undo()
    person.until(lambda: y.property("rawValue") == 50.0, "what the document has", 5)
    assert (branch.currentText(), diameter.property("rawValue")) == (first_branch, 410.0)
    hand.redo()
    person.until(lambda: y.property("rawValue") == 60.0, "what is done again", 5)
    hand.undo()
    person.until(lambda: y.property("rawValue") == 50.0, "what is undone again", 5)
    hand.enter(panel, "DepositionPointY", "60 mm")
    person.press("Ok")
    person.panel_closed()
    assert (cell.DepositionPoint.Base.y, cell.Branch, cell.PlatformDiameter.Value) == (
        60.0,
        first_branch,
        410.0,
    )


def test_undo_shows_every_kind_of_field_and_input_as_a_panel_that_is_opened_then_does(
    person, hemisphere
):
    """Undo restores expressions, flags, counts, choices, lists, links and names."""
    document = hemisphere.Document
    first_feature, second_feature = (
        api.make_feature(document, hemisphere, layer_height=15, chord_error=0.5) for _ in range(2)
    )
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(document, first_feature, cell)
    path = api.make_joint_path(document, toolpath, cell)
    program = api.make_program(document, path)
    second_toolpath = api.make_toolpath(document, second_feature, cell)
    for obj, values in (
        (second_feature, {"layer_height": "=7 mm + 8 mm", "path": "spiral"}),
        (second_toolpath, {"feature": first_feature, "travel_speed": "=5 mm/s"}),
        (
            path,
            {"toolpath": second_toolpath, "method": "point-by-point", "rotation_range_low": -90},
        ),
        (program, {"name": "other", "dry_run": True, "max_points": 1000}),
    ):
        name = f"RoboticAM_{type(obj.Proxy).__name__}"
        attach.edit(obj)
        person.idle()
        panel = person.panel(name)
        old_values = field_values(person, panel)
        api.change(obj, **values)
        person.press("Cancel")
        person.panel_closed()
        attach.edit(obj)
        person.idle()
        panel = person.panel(name)
        new_values = field_values(person, panel)
        assert (
            len({key for key in new_values if new_values[key] != old_values[key]})
            >= len(values) - 1
        ), name
        for command, expected in (("Undo", old_values), ("Redo", new_values), ("Undo", old_values)):
            person.gui.runCommand(f"Std_{command}")
            person.idle(0.2)
            assert field_values(person, panel) == expected, f"{name}, {command}"
        steps = document.UndoCount
        person.press("Ok")
        person.panel_closed()
        assert document.UndoCount == steps, f"{name}: nothing is left to be changed"


def test_undo_shows_what_solids_claddings_and_curves_are_made_of(person):
    document = App.newDocument("Features")
    boxes = [document.addObject("Part::Box", f"Box{k}") for k in range(2)]
    boxes[1].Placement.Base = App.Vector(40, 0, 0)
    document.recompute()
    coarse = {"layer_height": 5}
    for make, source, fixtures in (
        (api.make_solid_feature, (boxes[0],), [boxes[1]]),
        (api.make_cladding_feature, (boxes[0], ["Face6"]), [boxes[1]]),
        (api.make_curves_feature, (boxes[0], ["Edge1"]), [boxes[1]]),
    ):
        obj = make(document, *source, **({} if make is api.make_curves_feature else coarse))
        attach.edit(obj)
        person.idle()
        panel = person.panel(f"RoboticAM_{type(obj.Proxy).__name__}")
        original_text = person.field(panel, "Fixtures").text()
        api.change(obj, fixtures=fixtures)
        person.gui.runCommand("Std_Undo")
        person.gui.runCommand("Std_Redo")
        person.until(
            lambda panel=panel: person.field(panel, "Fixtures").text() == "Box1",
            "what is done again",
            5,
        )
        person.gui.runCommand("Std_Undo")
        person.until(
            lambda panel=panel, original_text=original_text: (
                person.field(panel, "Fixtures").text() == original_text
            ),
            "undone",
            5,
        )
        steps = document.UndoCount
        person.press("Ok")
        person.panel_closed()
        assert document.UndoCount == steps


def applies(person):
    """Return the button Apply of the open panel."""
    boxes = [box for box in person.present(person.widgets.QDialogButtonBox) if box.isVisible()]
    return next(
        filter(
            None, (button_box.button(person.widgets.QDialogButtonBox.Apply) for button_box in boxes)
        )
    )


def field_values(person, panel):
    """Return the texts in the fields of a panel."""
    w = person.widgets
    kinds = {
        w.QLineEdit: "text",
        w.QComboBox: "currentText",
        w.QCheckBox: "isChecked",
        w.QSpinBox: "value",
    }
    values = {}
    for kind, reader in kinds.items():
        for widget in panel.findChildren(kind):
            name = (
                widget.objectName()
                if not widget.objectName().startswith("qt_")
                else widget.parent().objectName()
            )
            if name and not name.startswith("qt_") and not name.endswith("Shown"):
                values[name, reader] = getattr(widget, reader)()
    for list_widget in panel.findChildren(w.QListWidget, "FeatureOrder"):
        values["FeatureOrder", ""] = [
            list_widget.item(row).text() for row in range(list_widget.count())
        ]
    return values


def test_apply_tells_in_the_panel_which_of_the_stages_that_follow_failed_and_why(
    person, hand, hemisphere
):
    document = hemisphere.Document
    feature = api.make_feature(document, hemisphere, layer_height=15, chord_error=0.5)
    api.make_joint_path(document, api.make_toolpath(document, feature), api.make_cell(document))
    person.double_click(feature)
    panel = person.panel(PANEL)
    following, findings = person.field(panel, "following"), person.field(panel, "findings")
    assert not following.isVisible()
    hand.enter(panel, "LayerHeight", "1e9 mm")
    person.press("Apply")
    assert following.isVisible() and following.text().startswith("Toolpath failed: "), (
        following.text()
    )
    assert (
        "exceeds the length of the wall" in following.text() and "\n" not in following.text()
    )  # the joint path depends on it
    assert findings.text() == "Status: up to date"  # the feature is up to date
    hand.enter(panel, "LayerHeight", "15 mm")
    person.press("Apply")
    assert not following.isVisible() and document.JointPath.Status == "up to date"
    person.press("Cancel")
    person.panel_closed()


def test_an_expression_is_typed_into_a_field_and_given_up_again(person, hand, hemisphere):
    document = hemisphere.Document
    sheet = document.addObject("App::FeaturePython", "Sheet")
    sheet.addProperty("App::PropertyLength", "height")
    sheet.height = 16
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel(PANEL)
    hand.enter(panel, "LayerHeight", "=Sheet.height/2")
    note = person.field(panel, "LayerHeightNote")
    person.until(
        lambda: note.isVisible() and note.text() == "= 8.00 mm", "what the expression gives", 5
    )
    hand.enter(panel, "ChordError", "=Sheet.hieght")
    wrong = person.field(panel, "ChordErrorNote")
    person.until(lambda: wrong.isVisible() and "not understood" in wrong.text(), "what is wrong", 5)
    person.screenshot("panel_expression")
    person.press("Ok")
    assert document.getObject("Feature") is None and wrong.isVisible()
    hand.enter(panel, "ChordError", "0.02 mm")
    person.until(lambda: not wrong.isVisible(), "the note to go", 5)
    person.press("Ok")
    person.panel_closed()
    feature = document.Feature
    assert (feature.LayerHeight.Value, dict(feature.ExpressionEngine)) == (
        8.0,
        {"LayerHeight": "Sheet.height / 2"},
    )
    sheet.height = 20
    person.gui.runCommand("Std_Refresh")
    assert (feature.LayerHeight.Value, feature.Status) == (10.0, "up to date")
    person.double_click(feature)
    panel = person.panel(PANEL)
    assert (
        person.field(panel, "LayerHeight").findChild(person.widgets.QLineEdit).text()
        == "=Sheet.height / 2"
    )
    person.press("Ok")
    person.panel_closed()
    assert dict(feature.ExpressionEngine) == {"LayerHeight": "Sheet.height / 2"}
    person.double_click(feature)
    hand.enter(person.panel(PANEL), "LayerHeight", "5 mm")
    person.press("Ok")
    person.panel_closed()
    assert (feature.LayerHeight.Value, feature.ExpressionEngine) == (5.0, [])


@pytest.mark.parametrize(
    "command",
    [
        "Cell",
        "Feature",
        "WallOnPart",
        "Solid",
        "SolidsOnHub",
        "Toolpath",
        "JointPath",
        "Program",
        "Inspect",
    ],
)
def test_every_field_has_help(person, hemisphere, command):
    if command in ("Toolpath", "JointPath", "Program"):  # tools that need earlier stages
        feature = api.make_feature(hemisphere.Document, hemisphere, layer_height=15)
        cell = api.make_cell(hemisphere.Document)
        api.make_joint_path(
            hemisphere.Document, api.make_toolpath(hemisphere.Document, feature, cell), cell
        )
    person.click(f"RoboticAM_{command}")
    panel = next(
        widget
        for widget in person.present(person.widgets.QWidget)
        if widget.objectName().startswith("RoboticAM_") and widget.isVisible()
    )
    kinds = (
        person.widgets.QLineEdit,
        person.widgets.QComboBox,
        person.widgets.QCheckBox,
        person.widgets.QAbstractSpinBox,
    )
    fields = [field for kind in kinds for field in panel.findChildren(kind)]
    bare = [
        field.objectName()
        for field in fields
        if not field.objectName().startswith("qt_")
        and not (field.toolTip() or field.parent().toolTip())
    ]
    mute = [
        field.objectName()
        for field in fields
        if not field.objectName().startswith("qt_")
        and not (field.whatsThis() or field.parent().whatsThis())
    ]
    assert len(fields) > 3
    assert (bare, mute) == ([], [])
    person.press("Cancel")
    person.panel_closed()


def test_a_newer_entry_ends_the_preview_of_an_older_one_and_the_window_goes_on(
    person, root, monkeypatch
):
    document = App.newDocument("Bend")
    pipe = document.addObject("Part::Cylinder", "Pipe")
    pipe.Radius, pipe.Height = 32, 160
    pipe.Placement = App.Placement(App.Vector(0, -80, 0), App.Rotation(App.Vector(1, 0, 0), -90))
    document.recompute()
    imported_part = api.open_part(
        document, str(root / "resources" / "examples" / "tube-on-pipe.step")
    )
    started, stopped = [], []
    prepare = SurfaceFeature.prepare

    def slow(self, obj):
        height, work = float(obj.LayerHeight), prepare(self, obj)

        def slowly():
            started.append(height)
            try:
                while height == 2.0:  # without end
                    time.sleep(0.01)
                return work()
            finally:
                stopped.append(height)

        return slowly

    monkeypatch.setattr(SurfaceFeature, "prepare", slow)
    person.select(imported_part, "Face1")
    person.gui.Selection.addSelection(pipe)
    person.click("RoboticAM_WallOnPart")
    panel = person.panel("RoboticAM_SurfaceFeature")
    state = person.field(panel, "preview")
    person.until(lambda: state.text().startswith("First layer"), "the preview", 60)
    person.type(panel, "LayerHeight", "2 mm")
    person.until(
        lambda: "Computing the preview" in state.text() and 2.0 in started,
        "the preview that goes on",
        10,
    )
    person.type(panel, "LayerHeight", "3 mm")
    person.until(lambda: state.text().startswith("First layer"), "the newer preview", 60)
    assert stopped[-2:] == [2.0, 3.0]
    person.type(panel, "LayerHeight", "2 mm")
    person.until(lambda: started[-1] == 2.0, "another that goes on", 10)
    person.press("Cancel")  # during the computation
    person.panel_closed()
    person.until(lambda: stopped[-1] == 2.0, "its end", 10)
    person.until(
        lambda: not [thread for thread in threading.enumerate() if thread.name == "Robotic AM"],
        "the threads to end",
        10,
    )


@pytest.mark.parametrize(
    ("command", "entries"),
    [
        (
            "Cell",
            (
                ("Machine", "kuka-kr16-2"),
                ("Machine", "nothing"),
                ("Machine", "table-xyzac"),
                ("Limits", "paper"),
            ),
        ),
        ("JointPath", (("MinCondition", "2"), ("MinCondition", "0.1"))),
        ("Program", (("ProgramName", "1CUP"), ("ProgramName", "MUG"), ("Post", "none"))),
    ],
)
@pytest.mark.always("JointPath-entries1")
def test_a_closed_panel_that_has_previewed_leaves_nothing_behind(
    person, joint_path, command, entries
):
    """The panel leaves no widgets that later ones could be mistaken for, no threads and no undo
    steps."""
    document, steps = joint_path.Document, joint_path.Document.UndoCount

    def visible_widgets(kind):
        """Return visible widgets without asking the main window, which would keep them."""
        return [
            widget
            for widget in person.widgets.QApplication.allWidgets()
            if isinstance(widget, kind) and widget.isVisible()
        ]

    def dead():
        wrappers = [
            wrapper for wrapper in gc.get_objects() if isinstance(wrapper, person.core.QObject)
        ]
        return [wrapper for wrapper in wrappers if not person.qt.isValid(wrapper)]

    def enter(name, text):
        line = next(
            widget
            for kind in (person.widgets.QComboBox, person.widgets.QLineEdit)
            for widget in visible_widgets(kind)
            if widget.objectName() == name
        )
        (line.setEditText if hasattr(line, "setEditText") else line.setText)(text)

    def cancel():
        button_kind = person.widgets.QDialogButtonBox.Cancel
        next(
            box.button(button_kind)
            for box in visible_widgets(person.widgets.QDialogButtonBox)
            if box.button(button_kind) is not None
        ).click()

    person.idle(0.5)
    gc.collect()
    gc.disable()
    try:
        dead_count = len(dead())
        person.select(joint_path)
        person.click(f"RoboticAM_{command}")
        for name, text in entries:
            person.idle(1.0)  # the panel updates and previews it
            enter(name, text)
        person.idle(0.4)  # the last preview is being computed
        cancel()
        person.panel_closed()
        person.until(lambda: len(dead()) <= dead_count, "widgets to go with their panel", 10)
        person.until(
            lambda: "Robotic AM" not in [thread.name for thread in threading.enumerate()],
            "the threads to end",
            10,
        )
    finally:
        gc.enable()
    assert document.UndoCount == steps and len(api.stages_of(document)) == 4


def test_the_wheel_scrolls_a_panel_and_changes_no_field(person, hand, hemisphere):
    feature = api.make_feature(hemisphere.Document, hemisphere, layer_height=10)
    person.idle()
    person.select(feature)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    combo, spin = person.field(panel, "Direction"), person.field(panel, "TravelSpeed")
    for field in (combo, spin):
        hand.reveal(field)
        original = (
            combo.currentText(),
            spin.property("rawValue"),
            field.mapToGlobal(person.core.QPoint(0, 0)),
        )
        position = field.mapToGlobal(field.rect().center())
        for button in (5, 4, 4, 5):
            hand.do("mousemove", position.x(), position.y(), "click", button)
            assert (combo.currentText(), spin.property("rawValue")) == original[:2]
        assert not field.hasFocus()
    hand.do("mousemove", position.x(), position.y(), "click", 5)
    hand.do("mousemove", position.x(), position.y(), "click", 5)
    assert field.mapToGlobal(person.core.QPoint(0, 0)).y() < original[2].y(), (
        "the panel has not scrolled"
    )


def test_a_tooltip_begins_with_the_name_of_its_tool(person, hemisphere):
    for command, name in (
        ("NewJob", "New Job"),
        ("WallOnPart", "Wall on Part"),
        ("Simulate", "Simulate"),
    ):
        button = person.button(f"RoboticAM_{command}")
        person.until(lambda: f"<b>{name}</b>" in button.toolTip(), f"the name of {command}", 5)  # noqa: B023
        assert not button.statusTip().startswith("<")


def test_fields_stay_in_place_while_messages_grow_and_go(person, hand, hemisphere):
    """A long message scrolls, and an error has reserved room."""
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    field, state = person.field(panel, "LayerHeight"), person.field(panel, "preview")

    def place():
        person.idle(0.2)
        return field.mapTo(panel, person.core.QPoint(0, 0)).y()

    original_place = place()
    person.until(lambda: state.text().startswith("Layers"), "the preview", 20)
    assert place() == original_place
    hand.enter(panel, "LayerHeight", "0 mm")
    person.until(lambda: state.text().startswith("No preview"), "that there is none", 5)
    assert place() == original_place
    state.setText("a line\n" * 20)
    assert place() == original_place
    bar = person.field(panel, "messages").verticalScrollBar()
    assert bar.maximum() > 0  # the rest is reached by scrolling
    person.press("Cancel")
    person.panel_closed()


def test_what_changes_the_deposit_is_read_as_a_panel_opens(person, hemisphere):
    """The messages are above all fields, without scrolling: regions that are left out, and
    directions that are tilted back."""
    document = hemisphere.Document
    toolpath = api.make_toolpath(document, api.make_feature(document, hemisphere, layer_height=2))
    person.open_workbench()
    person.double_click(toolpath)
    panel = person.panel("RoboticAM_Toolpath")
    findings, box = person.field(panel, "findings"), person.field(panel, "messages")
    assert (
        "directions are tilted back" in findings.text() and "are not deposited" in findings.text()
    )
    assert (
        box.verticalScrollBar().maximum() == 0
        and findings.visibleRegion().boundingRect().height() == findings.height()
    )
    person.screenshot("toolpath_panel_told")
    below = person.field(panel, "TravelSpeed").mapTo(panel, person.core.QPoint(0, 0)).y()
    assert box.mapTo(panel, person.core.QPoint(0, box.height())).y() <= below
    person.press("Cancel")
    person.panel_closed()


@pytest.mark.parametrize(
    "command", ["Cell", "Feature", "Solid", "WallOnPart", "Toolpath", "JointPath", "Program"]
)
@pytest.mark.always("JointPath", "Feature", "WallOnPart")
def test_what_an_empty_field_wants_is_read_whole_in_a_narrow_panel(
    person, hemisphere, coarse, command
):
    if command in ("JointPath", "Program"):
        api.make_all(hemisphere.Document, hemisphere)
    elif command == "Toolpath":
        api.make_feature(hemisphere.Document, hemisphere)
    person.open_workbench()
    if command in ("Feature", "Solid", "WallOnPart"):
        person.select(hemisphere)
    person.click(f"RoboticAM_{command}")
    person.idle(0.5)
    for fold in person.window.findChild(person.widgets.QDockWidget, "Combo View").findChildren(
        person.widgets.QToolButton
    ):
        if fold.isVisible() and fold.isCheckable() and not fold.isChecked() and fold.text():
            fold.click()
    person.idle(0.3)
    cut, count = [], 0
    for edit in person.present(person.widgets.QLineEdit):
        text = edit.placeholderText()
        if edit.isVisible() and text and not edit.text():
            count += 1
            room = edit.width() - 10  # frame and margins
            if edit.fontMetrics().boundingRect(text).width() > room:
                cut.append((text, room))
    assert cut == [] and (count or command not in ("Toolpath", "WallOnPart"))
    person.press("Cancel")
    person.panel_closed()
