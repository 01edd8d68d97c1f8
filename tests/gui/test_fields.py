# SPDX-License-Identifier: LGPL-2.1-or-later
"""A panel uses or rejects what is typed into it, and stays with the document in which it was
opened."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.parameters import field as parameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.gui.widgets import fields
from freecad_am.gui.widgets.quantity import PlainQuantity, QuantityField
from freecad_am.objects.cell import Cell
from freecad_am.objects.developable_feature import DevelopableFeature
from freecad_am.objects.feature import RevolutionFeature
from freecad_am.objects.fields.rows import MIXED, rows
from freecad_am.objects.inspection import Inspection
from freecad_am.objects.joint_path import JointPath
from freecad_am.objects.program import Program
from freecad_am.objects.surface_feature import SurfaceFeature
from freecad_am.objects.toolpath import Toolpath

STAGES = (
    Cell,
    RevolutionFeature,
    SurfaceFeature,
    DevelopableFeature,
    Toolpath,
    JointPath,
    Program,
    Inspection,
)
# numbers without a unit: shares, values of an input, the limit of an optimiser
UNITLESS_KEYS = {"min_condition", "tolerance", "cooling_zero"}


def typed(person, field, text):
    """Replace the text of the field, key by key, and leave it."""
    field.line.setFocus()
    person.idle(0.05)
    field.line.selectAll()
    for letter in text:
        for kind in (person.core.QEvent.KeyPress, person.core.QEvent.KeyRelease):
            event = person.widgets.QKeyEvent(kind, 0, person.core.Qt.NoModifier, letter)
            person.widgets.QApplication.sendEvent(field.box, event)
    other_field = field.box.window().findChild(person.widgets.QLineEdit, "elsewhere")
    other_field.setFocus()
    person.idle(0.05)
    assert not field.box.hasFocus()


@pytest.fixture
def window(person):
    """Return a dialog with the focus, and a second field."""
    dialog = person.widgets.QDialog(person.window)
    column = person.widgets.QVBoxLayout(dialog)
    elsewhere = person.widgets.QLineEdit()
    elsewhere.setObjectName("elsewhere")
    column.addWidget(elsewhere)
    dialog.show()
    dialog.activateWindow()
    person.until(dialog.isActiveWindow, "the dialog to be active", 5)
    yield column
    dialog.close()
    dialog.deleteLater()
    person.idle()


def test_what_is_typed_is_what_is_read(person, window):
    field = QuantityField(1.0, "mm", "Layer height")
    window.addWidget(field.box)
    assert field.read() == 1.0
    for text, number in (
        ("2", 2.0),
        ("0.5 cm", 5.0),
        ("1+1", 2.0),
        ("0.1234567891234 mm", 0.1234567891234),
        ("2\u202fm", 2000.0),
        ("2", 2.0),
    ):
        typed(person, field, text)
        assert field.read() == pytest.approx(number, rel=1e-14), text
    field.box.setFocus()
    person.idle(0.05)
    field.box.stepUp()
    assert field.read() == 3.0  # stepping starts from the typed value


def test_a_speed_is_typed_in_any_unit(person, window):
    field = QuantityField(6.0, "mm/s", "Travel speed")
    window.addWidget(field.box)
    for text, speed in (
        ("360 mm/min", 6.0),
        ("0.3m/min", 5.0),
        ("12 in/min", 5.08),
        ("9", 9.0),
        ("4 mm/s", 4.0),
    ):
        typed(person, field, text)
        assert field.read() == pytest.approx(speed, rel=1e-14), text


def test_milliseconds_are_read_and_shown_in_the_unit_of_the_field(person, window):
    field = QuantityField(1.0, "s", "Lead on")
    window.addWidget(field.box)
    typed(person, field, "50 ms")
    person.until(lambda: field.line.text() == "0.05 s", "the field's unit", 5)
    assert field.read() == 0.05


def test_another_number_is_shown_in_a_plain_line_and_read_as_it_is(person):
    field = PlainQuantity(6.0, "mm/min", "Travel speed", "=Sheet.speed")
    assert field.read() == "=Sheet.speed"
    field.show(1 / 3)
    assert (field.line.text(), field.read()) == ("0.3333 mm/min", 1 / 3)
    field.line.setText("9")
    assert field.read() == 9.0


def test_every_field_shows_another_value_and_an_expression(person):
    field_rows = {row.key: row for row in rows(CellParameters)}
    field = fields.make(field_rows["platform_diameter"], 120.0)
    field.show(30.5)
    assert (field.value, field.changed) == (30.5, True)
    field.show("=Sheet.height")
    assert field.value == "=Sheet.height"
    text = fields.make(field_rows["platform"], 120.0)
    text.show(30.5)
    assert (text.value, text.changed) == ("30.5 mm", True)


@pytest.mark.parametrize(
    ("unit", "text"), [("mm/s", "7 mm"), ("mm/s", "20 s"), ("mm/s", "7 kg"), ("mm", "3 deg")]
)
def test_a_quantity_of_another_kind_is_refused_as_it_was_typed(person, window, unit, text):
    field = QuantityField(1.0, unit, "Travel speed")
    window.addWidget(field.box)
    typed(person, field, text)
    with pytest.raises(api.InputError, match=f"{text}.* give a quantity in {unit}"):
        field.read()
    assert field.line.text() == text


def test_a_number_too_long_for_its_field_shows_its_first_digits(person, window):
    field = QuantityField(123456.5, "mm", "Length")
    field.box.setFixedWidth(75)
    window.addWidget(field.box)
    person.idle(0.2)
    assert (
        field.line.fontMetrics().boundingRect(field.line.text()).width() > field.line.width() - 30
    )
    assert field.line.cursorPosition() == 0  # the visible end is that of the cursor
    typed(person, field, "654321.5 mm")
    assert field.line.cursorPosition() == 0 and field.read() == 654321.5


@pytest.mark.parametrize(
    "text",
    ["1,5 mm", "1,000", "abc", "1 inch", "2 mm mm", " ", "1\u202f234 mm", "1\u00a0234", "1’234 mm"],
)
def test_what_the_field_would_change_unseen_is_refused_and_stays_to_be_seen(person, window, text):
    field = QuantityField(1.0, "mm", "Layer height")
    window.addWidget(field.box)
    typed(person, field, text)
    with pytest.raises(api.InputError, match="Layer height"):
        field.read()
    assert field.line.text() == text
    typed(person, field, "3")
    assert field.read() == 3.0


def test_what_is_wrong_is_told_while_typing_and_only_as_long_as_it_is_there(person, hemisphere):
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    note = person.field(panel, "PlatformDiameterNote")
    for text, message in (
        ("abc", "'abc' is not understood"),
        ("-5", "-5 mm is out of range"),
        ("1e9", "1e+09 mm is out"),
    ):
        person.type(panel, "PlatformDiameter", text)
        person.until(
            lambda message=message: note.isVisible() and note.text().startswith(message), message, 5
        )
    person.press("Ok")  # rejected
    assert note.isVisible() and not any(
        obj.TypeId.startswith("App::FeatureP") for obj in hemisphere.Document.Objects
    )
    below = person.field(panel, "Mount")
    person.idle(0.5)  # the panel makes room for the message at its top
    height = below.mapTo(panel, person.core.QPoint(0, 0)).y()
    person.type(panel, "PlatformDiameter", "100 mm")
    person.until(lambda: not note.isVisible(), "the error to go with what was wrong", 5)
    assert (
        below.mapTo(panel, person.core.QPoint(0, 0)).y() == height
    )  # a click on the next field hits it
    person.press("Cancel")
    person.panel_closed()


def test_an_error_is_told_with_the_name_in_the_panel_and_its_group_opens(person, hemisphere):
    api.make_feature(hemisphere.Document, hemisphere, layer_height=10)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    assert not person.field(panel, "SeamAngle").isVisible()
    person.type(panel, "SeamAngle", "2 mm")
    person.press("Ok")
    note = person.field(panel, "SeamAngleNote")
    assert note.isVisible() and note.text().startswith("'2 mm' is not understood")
    field = person.field(panel, "SeamAngle")
    assert field.isVisible() and (
        field.hasFocus() or field.isAncestorOf(person.widgets.QApplication.focusWidget())
    )
    assert not person.field(panel, "error").isVisible()
    person.screenshot("panel_error_beside_its_field")
    person.type(panel, "SeamAngle", "0 deg")
    person.type(panel, "TravelSpeed", "-1 mm/s")
    person.press("Ok")
    assert person.field(panel, "TravelSpeedNote").text().startswith("-1 mm/s is out of range")
    assert not note.isVisible()
    person.press("Cancel")
    person.panel_closed()


def test_ramps_at_starts_and_ends_of_beads_are_typed(person, hemisphere):
    """The typed values are those of the planned beads."""
    api.make_feature(hemisphere.Document, hemisphere, layer_height=10)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    for name, text in (
        ("TravelSpeed", "8 mm/s"),
        ("StartLength", "5 mm"),
        ("StartTravelSpeed", "3 mm/s"),
        ("StartRamp", "-1 mm"),
    ):
        person.type(panel, name, text)
    person.press("Ok")
    assert person.field(panel, "StartRampNote").text().startswith("-1 mm is out of range")
    for name, text in (
        ("StartRamp", "4 mm"),
        ("EndLength", "3 mm"),
        ("EndTravelSpeed", "10 mm/s"),
        ("EndRamp", "2 mm"),
    ):
        person.type(panel, name, text)
    person.press("Ok")
    person.until(
        lambda: "take 14 mm with their ramps" in person.panel_error(panel), "what is too long", 10
    )
    for name, text in (
        ("StartLength", "1 mm"),
        ("StartRamp", "1 mm"),
        ("EndLength", "0.5 mm"),
        ("EndRamp", "0.8 mm"),
    ):
        person.type(panel, name, text)
    person.press("Ok")
    person.panel_closed()
    toolpath = hemisphere.Document.Toolpath
    assert (toolpath.StartRamp.Value, toolpath.EndRamp.Value) == (1.0, 0.8)
    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)
    assert (process.start.ramp, process.start.travel_speed, process.end.ramp) == (
        1.0,
        3.0,
        0.8,
    ) and process.ramped


def test_a_panel_stays_with_its_document(person, hemisphere):
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=10)
    other_document = App.newDocument("Other")
    sphere = other_document.addObject("Part::Sphere", "Sphere")
    other_document.recompute()
    assert api.make_feature(other_document, sphere, layer_height=10).Name == feature.Name
    App.setActiveDocument(doc.Name)
    person.double_click(feature)
    App.setActiveDocument(other_document.Name)
    person.type(person.panel("RoboticAM_RevolutionFeature"), "LayerHeight", "5 mm")
    person.press("Ok")
    person.panel_closed()
    assert (feature.LayerHeight.Value, other_document.Feature.LayerHeight.Value) == (5.0, 10.0)

    App.setActiveDocument(doc.Name)
    person.click("RoboticAM_Cell")
    App.setActiveDocument(other_document.Name)
    person.press("Ok")
    person.panel_closed()
    assert doc.getObject("Cell") is not None and other_document.getObject("Cell") is None


@pytest.mark.parametrize("tool", ["NewJob", "Cell", "Feature", "Toolpath", "Inspect"])
@pytest.mark.always("NewJob", "Toolpath", "Inspect")
def test_a_panel_goes_with_its_document_alone(person, hemisphere, tool):
    api.make_feature(hemisphere.Document, hemisphere, layer_height=10)
    other_document = App.newDocument("Other")
    App.setActiveDocument(hemisphere.Document.Name)
    person.select(hemisphere)
    person.click(f"RoboticAM_{tool}")
    assert person.gui.Control.activeDialog()
    App.closeDocument(other_document.Name)
    person.idle(0.3)
    assert person.gui.Control.activeDialog()
    App.newDocument("Third")
    App.closeDocument(hemisphere.Document.Name)
    person.panel_closed()
    # the next document is a different one
    App.newDocument("Fourth")
    App.closeDocument("Third")
    person.click("RoboticAM_Cell")
    assert person.panel("RoboticAM_Cell").isVisible()
    person.press("Cancel")
    person.panel_closed()


def test_a_panel_whose_object_is_gone_says_so(person, hemisphere):
    feature = api.make_feature(hemisphere.Document, hemisphere, layer_height=10)
    person.double_click(feature)
    panel = person.panel("RoboticAM_RevolutionFeature")
    person.type(panel, "LayerHeight", "5 mm")
    hemisphere.Document.removeObject(feature.Name)
    person.press("Ok")
    assert "was deleted" in person.panel_error(panel)
    person.press("Cancel")
    person.panel_closed()


def test_long_names_are_seen_from_their_start(person, hemisphere):
    hemisphere.Label = "A part with a name that is far too long for its field"
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    source = person.field(person.panel("RoboticAM_NewJob"), "Source")
    assert source.cursorPosition() == 0 and source.toolTip() == hemisphere.Label
    person.press("Cancel")
    person.panel_closed()


def test_every_number_has_its_unit(person):
    """A quantity shows its unit in the field, other numbers in the label."""
    quantities = (parameters.LENGTH, parameters.ANGLE, parameters.SPEED, parameters.TIME)
    numbers = (parameters.NUMBER, parameters.RATIO, parameters.TURN_RATE)
    labels, bare = {}, []
    for section in (section for stage in STAGES for section in stage.sections):
        for row in rows(section.cls):
            field = fields.make(row, row.default, section=section.prefix)
            line = (
                field.widget
                if isinstance(field.widget, person.widgets.QLineEdit)
                else field.widget.findChild(person.widgets.QLineEdit)
            )
            labels[row.key] = field.heading
            if row.form in quantities and not line.text().endswith(
                (" mm", " µm", " nm", " m", "°", " deg", " mm/s", " s")
            ):
                bare.append((row.key, line.text()))
            if (
                row.form in numbers
                and row.key not in UNITLESS_KEYS
                and not field.heading.endswith(")")
            ):
                bare.append((row.key, field.heading))
            word = row.form != MIXED or row.default is None or row.default in row.spec.words
            if not word and not line.text().endswith(row.unit):
                bare.append((row.key, line.text()))
    assert bare == [] and len(labels) > 80
    assert (
        labels["density"] == "Density (g/cm³)"
        and labels["band"] == "Band"
        and labels["heights"] == "Heights (mm)"
    )
