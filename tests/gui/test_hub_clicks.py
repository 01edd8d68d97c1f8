# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two blades on a cone by mouse and keys: selected, previewed, created, filled, rotated by a
five-axis machine, for a SINUMERIK."""

import dataclasses
import re
import time

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.process import wire
from freecad_am.gui.path import colouring, legend
from freecad_am.gui.views.hub import HubView

ORANGE = (245, 120, 0)  # the colour of first layers
PANEL = "RoboticAM_DevelopableFeature"
BOTTOM_RADIUS, TOP_RADIUS, HEIGHT_MM = 40.0, 25.0, 60.0  # the cone, mm


@pytest.fixture
def rotor(person):
    """Return a document with a truncated cone and two blades."""
    document = App.newDocument("Rotor")
    hub = document.addObject("Part::Cone", "Hub")
    hub.Radius1, hub.Radius2, hub.Height = BOTTOM_RADIUS, TOP_RADIUS, HEIGHT_MM
    blade_objects = []
    for number, turn in enumerate((-45, 75), start=1):
        blade = document.addObject("Part::Box", f"Blade{number}")
        blade.Label = f"Blade {number}"
        blade.Length, blade.Width, blade.Height = 30, 12, 24
        spin = App.Placement(App.Vector(), App.Rotation(App.Vector(0, 0, 1), turn))
        blade.Placement = spin.multiply(App.Placement(App.Vector(25, -6, 14), App.Rotation()))
        blade_objects.append(blade)
    document.recompute()
    return [hub, *blade_objects]


@pytest.fixture
def blades(person, rotor):
    """Return the same, visible next to the tree."""
    for dock in person.present(person.widgets.QDockWidget):
        if dock.objectName() in ("Combo View", "Model", "Tree view"):
            dock.show()
    person.idle(0.4)
    person.look()
    person.gui.Selection.clearSelection()
    return rotor


def cone(hub):
    """Return the name of the cone's face."""
    faces = [
        f"Face{number}"
        for number, face in enumerate(hub.Shape.Faces, start=1)
        if face.Surface.TypeId.endswith("Cone")
    ]
    return faces[0]


def previewed(person, panel):
    def text():
        note = person.field(panel, "preview")
        return note.text() if note.isVisible() and "first layer: " in note.text() else ""

    return person.until(text, "the preview", 30)


def noted_for(person, panel, entry, as_wanted):
    """Type a layer height, and again if the expected note does not appear: the panel may still
    process the hub, and a busy window then ignores the typed value."""
    for attempt in range(4):
        person.type(panel, "LayerHeight", "5 mm" if attempt else entry)
        person.type(panel, "LayerHeight", entry)
        end = time.monotonic() + 15.0
        while time.monotonic() < end:
            if as_wanted():
                return
            person.idle(0.05)
    note = person.field(panel, "LayerHeightNote")
    raise AssertionError(
        f"{entry}: {note.text()!r}, {note.isVisible()}; {person.field(panel, 'preview').text()!r}"
    )


def press_button(person, hand, name="Ok"):
    button_kind = getattr(person.widgets.QDialogButtonBox, name)
    boxes = [box for box in person.present(person.widgets.QDialogButtonBox) if box.isVisible()]
    button = next(box.button(button_kind) for box in boxes if box.button(button_kind) is not None)
    for area in person.present(person.widgets.QScrollArea):
        if area.isVisible() and area.isAncestorOf(button):
            area.ensureWidgetVisible(button)  # a long panel may be scrolled down
    hand.click(button)
    person.panel_closed()


def texts(person, panel):
    return [person.field(panel, name).text() for name in ("Solids", "Hub")]


def make_stage(person, command, **entries):
    """Open a tool, type into its fields, and press OK."""
    person.click(command)
    panel = person.panel(command)
    for field, text in entries.items():
        person.type(panel, field, text)
    person.press("Ok")
    person.panel_closed()


def test_blades_by_the_mouse_from_the_hub_to_the_program(person, hand, blades, tmp_path):
    hub, first_blade, second_blade = blades
    document, steps = hub.Document, hub.Document.UndoCount
    hand.click_face(first_blade, "Face2")
    hand.click_tree("Blade 2", "ctrl")
    hand.click_face(hub, cone(hub), "ctrl")
    hand.click(person.button("RoboticAM_SolidsOnHub"))
    panel = person.panel(PANEL)
    assert texts(person, panel) == ["Blade 1, Blade 2", f"Hub {cone(hub)}"]
    preview_text = previewed(person, panel)
    half = np.degrees(np.arctan((BOTTOM_RADIUS - TOP_RADIUS) / HEIGHT_MM))
    assert (
        "2 solids on Hub" in preview_text
        and f"half angle {half:.4g}°" in preview_text
        and "2 contours" in preview_text
    )
    assert person.screen_pixels(ORANGE) > 150
    assert (set(document.Objects), document.UndoCount) == (
        set(blades),
        steps,
    )  # nothing exists yet
    assert not person.field(panel, "Mode").isEnabled() and person.field(panel, "Lead").isEnabled()
    hand.enter(panel, "LayerHeight", "5 mm")
    person.type(panel, "BeadSpacing", "4 mm")
    previewed(person, panel)
    person.screenshot("panel_solids_on_hub")
    press_button(person, hand)
    feature = document.getObject("Feature")
    assert (feature.Status, feature.Solids, document.UndoCount) == ("up to date", 2, steps + 1)
    assert (feature.Source, feature.Further, feature.Substrate) == (
        (first_blade, []),
        [second_blade],
        hub,
    )
    assert feature.BaseFaces == (hub, [cone(hub)]) and isinstance(feature.ViewObject.Proxy, HubView)
    key = feature.Key

    hand.undo()
    assert set(document.Objects) == set(blades) and person.screen_pixels(ORANGE) == 0
    hand.redo()
    assert document.Feature.Key == key and person.screen_pixels(ORANGE) > 150
    console = person.window.findChild(person.widgets.QPlainTextEdit, "Python console").toPlainText()
    call = (
        console[console.rindex("am.make_developable_feature(") :]
        .split("\n>>>")[0]
        .replace("\n", " ")
    )
    again = eval(call, {"App": App, "am": api})
    assert again.Key == key  # the recorded call gives the same
    document.removeObject(again.Name)

    make_stage(person, "RoboticAM_Cell", Machine="table-xyzac")
    assert (document.Cell.Setup, document.Cell.Status) == ("rotary-table", "up to date")
    hand.click(person.button("RoboticAM_Toolpath"))
    panel = person.panel("RoboticAM_Toolpath")
    person.choose(panel, "BeadModel", "csw")
    plot = person.field(panel, "BeadModelPlot")
    person.until(lambda: plot.isVisible() and plot.ready, "the plot", 10)
    person.until(
        lambda: not person.field(panel, "BeadModelFit").visibleRegion().isEmpty(),
        "the fit to be scrolled to",
        5,
    )
    person.screenshot("panel_bead_model")
    press_button(person, hand)
    toolpath = document.Toolpath
    assert toolpath.Status == "up to date" and not (
        first_blade.ViewObject.Visibility or second_blade.ViewObject.Visibility
    )
    toolpath.ViewObject.Colouring = "width"
    person.idle()
    widths = np.concatenate([bead.width for _, _, bead in api.result(toolpath)])
    scale = toolpath.ViewObject.Proxy.scale
    assert (scale.title, scale.lowest, scale.highest) == ("width", widths.min(), widths.max())
    person.look()
    person.screenshot("hub_width")

    make_stage(person, "RoboticAM_JointPath")
    assert document.JointPath.Status == "up to date", document.JointPath.Message
    make_stage(person, "RoboticAM_Program", ProgramName="ROTOR")
    assert (document.Program.Post, document.Program.Status) == ("siemens", "up to date"), (
        document.Program.Message
    )
    text = "".join(
        content.decode("latin-1") for content in api.result(document.Program).files.values()
    )
    assert re.search(r"X=?-?[\d.]+.* A=?-?[\d.]+ C=?", text)

    keys = [stage.Key for stage in api.stages_of(document)]
    document.saveAs(str(tmp_path / "rotor.FCStd"))
    App.closeDocument(document.Name)
    opened = App.openDocument(str(tmp_path / "rotor.FCStd"))
    person.idle(0.4)
    stages = api.stages_of(opened)
    assert [stage.Key for stage in stages] == keys and {stage.Status for stage in stages} == {
        "up to date"
    }
    assert opened.Toolpath.ViewObject.Colouring == "width"
    person.until(
        lambda: [scale.title for scale in legend.visible_scales(opened)] == ["joint margin"],
        "the legend of the joint path",
    )


def test_without_a_selection_solids_and_hub_are_waited_for(person, hand, blades):
    hub, first_blade, second_blade = blades
    document, steps = hub.Document, hub.Document.UndoCount
    hand.click(person.button("RoboticAM_SolidsOnHub"))
    panel = person.panel(PANEL)
    person.until(
        lambda: "Solids are missing" in person.field(panel, "preview").text(), "what is missing", 5
    )
    hand.click_face(first_blade, "Face2")
    hand.click_face(second_blade, "Face6")  # its upper side
    assert texts(person, panel) == ["Blade 1, Blade 2", ""]
    note = person.field(panel, "InputHubNote")
    person.until(
        lambda: note.isVisible() and "name the hub" in note.text(), "that a hub is needed", 10
    )
    hand.click(person.field(panel, "PickHub"))
    hand.click_face(hub, cone(hub))
    assert texts(person, panel) == ["Blade 1, Blade 2", f"Hub {cone(hub)}"]
    hand.click_face(hub, cone(hub))  # a second click removes it
    person.gui.Selection.addSelection(hub)
    person.until(lambda: texts(person, panel) == ["Blade 1, Blade 2", "Hub"], "the hub", 10)
    assert f"2 solids on Hub {cone(hub)}" in previewed(person, panel)
    person.type(panel, "LayerHeight", "-3 mm")
    wrong = person.field(panel, "LayerHeightNote")
    person.until(lambda: wrong.isVisible() and "more than 0 mm" in wrong.text(), "the note", 5)
    person.until(lambda: person.screen_pixels(ORANGE) == 0, "that nothing is previewed", 5)
    for entry, why in (
        ("0.000001 mm", "above the limit of 20,000"),
        ("4 mm", ""),
    ):  # the panel already has the solids
        noted_for(
            person,
            panel,
            entry,
            lambda why=why: why in wrong.text() and wrong.isVisible() == bool(why),
        )
    previewed(person, panel)
    person.type(panel, "BeadSpacing", "0.00001 mm")
    wrong = person.field(panel, "BeadSpacingNote")
    person.until(
        lambda: "points, above the limit of 50,000,000" in wrong.text(),
        "the note",
        30,
    )
    press_button(person, hand, "Cancel")
    assert (set(document.Objects), document.UndoCount) == (set(blades), steps)
    person.gui.Selection.addSelection(first_blade)  # the panel no longer observes the selection
    person.idle()


def test_a_field_that_is_typed_into_stays_in_place_while_nothing_can_be_previewed(
    person, hand, blades
):
    hub, first_blade, second_blade = blades
    person.gui.Selection.addSelection(hub.Document.Name, first_blade.Name)
    person.gui.Selection.addSelection(hub.Document.Name, second_blade.Name)
    person.gui.Selection.addSelection(hub.Document.Name, hub.Name, cone(hub))
    hand.click(person.button("RoboticAM_SolidsOnHub"))
    panel = person.panel(PANEL)
    previewed(person, panel)
    preview_note, field = person.field(panel, "preview"), person.field(panel, "LayerHeight")

    def place():
        return field.mapTo(panel, person.core.QPoint(0, 0)).y()

    original_place = place()
    several = 1.5 * preview_note.fontMetrics().lineSpacing()
    person.until(
        lambda: preview_note.height() > several,
        f"a text of several lines: {preview_note.text()}",
        5,
    )
    person.type(panel, "LayerHeight", "0 mm")
    person.until(lambda: preview_note.text().startswith("No preview"), "that there is none", 5)
    person.idle(0.2)
    assert place() == original_place
    person.type(panel, "LayerHeight", "2 mm")
    previewed(person, panel)
    person.idle(0.2)
    assert place() == original_place and preview_note.minimumHeight() == 0
    press_button(person, hand, "Cancel")


def test_a_feature_is_changed_and_its_hub_may_be_a_face_of_its_only_solid(person, rotor):
    hub, first_blade, second_blade = rotor
    document = hub.Document
    fused = document.addObject("Part::MultiFuse", "Rotor")
    fused.Shapes = rotor
    document.recompute()
    feature = api.make_developable_feature(
        document, first_blade, hub, further=[second_blade], layer_height=5
    )
    key, steps = feature.Key, document.UndoCount
    person.double_click(feature)
    panel = person.panel(PANEL)
    assert texts(person, panel) == ["Blade 1, Blade 2", "Hub"]
    previewed(person, panel)
    person.press("Cancel")
    person.panel_closed()
    assert (feature.Key, document.UndoCount) == (key, steps)
    person.double_click(feature)
    panel = person.panel(PANEL)
    for name in ("Solids", "Hub"):
        person.field(panel, f"Clear{name}").click()
    person.field(panel, "PickSolids").click()
    person.gui.Selection.addSelection(fused)
    person.idle()
    person.field(panel, "PickHub").click()
    person.gui.Selection.addSelection(document.Name, fused.Name, cone(fused))
    person.idle()
    assert texts(person, panel) == ["Rotor", f"Rotor {cone(fused)}"]
    previewed(person, panel)
    person.press("Ok")
    person.panel_closed()
    assert (feature.Status, document.UndoCount) == ("up to date", steps + 1)
    assert (feature.Source, feature.Further, feature.Substrate) == (
        (fused, [cone(fused)]),
        [],
        None,
    )


def test_beads_are_told_by_kind_and_layers_by_solid(person, rotor):
    hub, first_blade, second_blade = rotor
    feature = api.make_developable_feature(
        hub.Document,
        first_blade,
        hub,
        further=[second_blade],
        layer_height=5,
        bead_spacing=4,
        fill="lines",
        order="feature",
    )
    toolpath = api.make_toolpath(hub.Document, feature)
    path = api.result(toolpath)
    numbers = colouring.numbered(path)
    # both blades have the same numbers, counted from the hub
    assert numbers == [*range(len(numbers) // 2)] * 2
    colours, scale = colouring.coloured(path, "kind of bead", 0.2)
    closed = np.concatenate([np.full(len(bead), bead.closed) for _, _, bead in path])
    assert (
        closed.any()
        and not closed.all()
        and [colour_class for colour_class, _ in scale.classes]
        == [colouring.CLOSED_BEAD[0], colouring.OPEN_BEAD[0]]
    )
    assert (colours[closed] == colouring.CLOSED_BEAD[1]).all() and (
        colours[~closed] == colouring.OPEN_BEAD[1]
    ).all()
    toolpath.ViewObject.Colouring = "kind of bead"
    person.idle()
    person.look()
    person.screenshot("hub_kinds")
    assert (
        person.screen_pixels(tuple(round(255 * channel) for channel in colouring.OPEN_BEAD[1]), 6)
        > 100
    )
    _, scale = colouring.coloured(path, "width", 0.2)
    assert scale.classes == (colouring.NO_WIDTH,)


def test_a_bead_model_is_seen_by_its_fit(person, rotor, tmp_path, monkeypatch):
    hub, first_blade, _ = rotor
    feature = api.make_developable_feature(hub.Document, first_blade, hub, layer_height=5)
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    plot, fit = person.field(panel, "BeadModelPlot"), person.field(panel, "BeadModelFit")
    assert not plot.isVisible()
    person.choose(panel, "BeadModel", "csw")
    person.until(lambda: plot.isVisible() and plot.ready, "the plot", 10)
    model = wire.load("csw")
    for number in (
        f"{model.width.m:.4g}",
        f"{model.width.r_squared:.4f}",
        f"{model.height.rmse:.3f}",
    ):
        assert number in fit.text()
    assert "12 beads, 300 to 900 mm/min" in fit.text()
    original_pixels = pixels(person, plot)
    assert len(original_pixels) > 50  # more than an empty frame
    person.type(panel, "BeadModel", str(tmp_path / "none.csv"))
    person.until(lambda: not plot.isVisible(), "the plot to go", 5)
    assert "cannot be read" in person.field(panel, "BeadModelNote").text()
    rows = ["radius_mm,wire_feed_m_min,travel_speed_mm_min,width_mm,height_mm"]
    rows += [
        f"{r},5,{v},{40 / v ** (1 / 3) + 20 / r + 1},2.5" for r in (20, 40) for v in (200, 400, 800)
    ]
    (tmp_path / "own.csv").write_text("\n".join(rows))
    monkeypatch.setattr(
        person.widgets.QFileDialog,
        "getOpenFileName",
        staticmethod(lambda *_: (str(tmp_path / "own.csv"), "")),
    )
    person.field(panel, "ChooseBeadTable").click()
    person.until(plot.isVisible, "the plot", 5)
    assert "Width = 40 v^(-1/3) + 20/r + 1 mm" in fit.text() and "R² 1.0000" in fit.text()
    assert not person.field(panel, "BeadModelNote").isVisible()
    person.press("Cancel")
    person.panel_closed()
    assert feature.Status == "up to date"


def pixels(person, widget):
    """Return the colours of a widget as drawn."""
    image = widget.grab().toImage().convertToFormat(person.widgets.QImage.Format_RGB32)
    return np.unique(np.frombuffer(bytes(image.constBits()), dtype=np.uint32))


def test_a_cell_follows_its_machine(person, rotor):
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    fields = {
        name: person.field(panel, name)
        for name in ("Setup", "Branch", "DepositionPoint", "Machine", "MachineNote")
    }
    fields["ArmClearance"] = person.field(panel, "ArmClearance")
    assert fields["Branch"].isVisible() and fields["ArmClearance"].isVisible()
    assert fields["Setup"].currentData() == "part-on-robot"
    person.type(panel, "Machine", "table-xyzbc")
    person.until(lambda: fields["Setup"].currentData() == "rotary-table", "the set-up to follow", 5)
    of_robots = [fields[name] for name in ("Setup", "Branch", "DepositionPoint", "ArmClearance")]
    person.until(
        lambda: not any(field.isVisible() for field in of_robots), "the fields of robots to go", 5
    )
    person.screenshot("panel_cell_table")
    person.type(panel, "Machine", "table-xyz")
    person.until(fields["MachineNote"].isVisible, "what is wrong with the machine", 5)
    assert "did you mean table-xyz" in fields["MachineNote"].text()
    person.type(panel, "Machine", "kuka-kr16-2")
    person.until(fields["Branch"].isVisible, "the branch to be there again", 5)
    assert fields["Setup"].currentData() == "part-on-robot"
    person.until(
        lambda: not fields["MachineNote"].isVisible(),
        "the preview to find nothing wrong any more",
        10,
    )
    person.type(panel, "Machine", "table-xyzac")
    person.press("Ok")  # before the panel has updated
    person.panel_closed()
    cell = person.gui.activeDocument().Document.Cell
    assert (cell.Machine, cell.Setup, cell.Status) == ("table-xyzac", "rotary-table", "up to date")


def test_many_points_are_coloured_at_once(person, rotor):
    """A hundred thousand points are one node, and another colouring gives the same number of
    colours."""
    hub, first_blade, _ = rotor
    feature = api.make_developable_feature(hub.Document, first_blade, hub, layer_height=5)
    toolpath = api.make_toolpath(hub.Document, feature)
    path = api.result(toolpath)
    count = -(-100_000 // path.point_count)
    large_path = dataclasses.replace(path, layers=path.layers * count)
    view = toolpath.ViewObject.Proxy
    view.draw(toolpath, large_path)
    assert len(view.rows) >= 100_000
    for kind in colouring.KINDS:
        if kind != "local distance":
            assert len(colouring.coloured(large_path, kind, 0.2)[0]) == len(view.rows)
