# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels propose and show values of the preferences page; documents, jobs and macros do not depend
on it."""

import subprocess
import sys

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.objects import user_machines
from freecad_am.objects.fields import preferences

GROUP = "User parameter:BaseApp/Preferences"


@pytest.fixture
def clean():
    yield
    App.ParamGet(GROUP + "/Mod").RemGroup("RoboticAM")


@pytest.fixture
def page(person, clean):
    from freecad_am.gui.preferences_page import PreferencesPage

    preferences_page = PreferencesPage()
    preferences_page.loadSettings()
    preferences_page.form.show()
    person.idle()
    yield preferences_page
    preferences_page.form.close()


def entries():
    return sorted(entry[1] for entry in App.ParamGet(preferences.GROUP).GetContents() or ())


def test_without_entries_all_is_as_built_in_and_saving_the_page_adds_none(person, page):
    assert (
        preferences.machine() == "fanuc-arcmate120ic"
        and preferences.process() == {}
        and preferences.post() == ""
    )
    assert preferences.speed_unit() == "mm/s" and preferences.ramp() == "blue to yellow"
    original_entries = entries()  # folders that other tools remember
    page.saveSettings()
    assert entries() == original_entries and not {"Machine", "Post", "SpeedUnit", "Ramp"} & set(
        original_entries
    )


def test_the_page_is_in_freecads_dialog_and_what_is_typed_there_is_proposed(
    person, hand, clean, hemisphere, tmp_path
):
    """The dialog is modal, so timers operate it."""
    finished = []

    def act():
        dialog = person.widgets.QApplication.activeModalWidget()
        if dialog is None:
            person.core.QTimer.singleShot(200, act)
            return
        try:
            form = dialog.findChild(person.widgets.QWidget, "RoboticAM_Preferences")
            finished.append(form is not None)
            form.findChild(person.widgets.QComboBox, "machine").setEditText("kuka-kr16-2")
            unit = form.findChild(person.widgets.QComboBox, "speedUnit")
            unit.setCurrentIndex(unit.findText("m/min"))
            field = form.findChild(person.widgets.QWidget, "TravelSpeed")
            field.findChild(person.widgets.QLineEdit).setText("12 mm/s")
            form.findChild(person.widgets.QLineEdit, "programsFolder").setText(str(tmp_path))
            person.screenshot("preferences")
        finally:
            dialog.findChild(person.widgets.QDialogButtonBox).button(
                person.widgets.QDialogButtonBox.Ok
            ).click()

    person.core.QTimer.singleShot(300, act)
    person.watch.awaited = (person.widgets.QDialog,)
    person.gui.showPreferences("Robotic AM", 0)
    person.watch.awaited = ()
    person.idle(0.3)
    assert finished == [True]
    assert preferences.machine() == "kuka-kr16-2" and preferences.process() == {
        "travel_speed": 12.0
    }
    assert preferences.programs_folder() == str(tmp_path)
    # a cell, and a toolpath with its speed in m/min
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    assert person.field(panel, "Machine").currentText() == "KUKA KR 16-2"
    person.press("Ok")
    person.panel_closed()
    cell = api.stages_of(hemisphere.Document, "cell")[0]
    assert cell.Machine == "kuka-kr16-2"
    api.make_feature(hemisphere.Document, hemisphere, layer_height=9)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    assert person.field(panel, "TravelSpeed").text() == "0.72 m/min"
    assert person.field(panel, "RapidSpeed").text() == "6 m/min"
    person.screenshot("preferences_toolpath")
    person.type(panel, "RapidSpeed", "9")  # m/min, as the field shows
    person.press("Ok")
    person.panel_closed()
    toolpath = api.stages_of(hemisphere.Document, "toolpath")[0]
    assert toolpath.TravelSpeed.getValueAs("mm/s").Value == pytest.approx(12.0)
    assert toolpath.RapidSpeed.getValueAs("mm/s").Value == pytest.approx(150.0)
    # macros ignore the preferences
    plain = api.make_toolpath(hemisphere.Document, hemisphere.Document.Feature)
    assert plain.TravelSpeed.getValueAs("mm/s").Value == pytest.approx(6.0)
    assert api.make_cell(hemisphere.Document).Machine == "fanuc-arcmate120ic"


def test_a_new_job_takes_machine_process_and_post(person, clean, hemisphere, coarse):
    preferences.keep("Machine", "fanuc-arcmate120ic-10l")
    preferences.keep_process({"travel_speed": 9.0, "wire_diameter": 1.0})
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    assert person.field(panel, "Machine").currentText().startswith("FANUC ARC Mate 120iC/10L")
    person.as_revolution(panel)
    person.until(
        lambda: (
            person.field(panel, "Name").text()
            if panel.findChild(person.widgets.QLineEdit, "Name")
            else True
        ),
        "a name",
    )
    person.press("Ok")
    person.until(lambda: api.stages_of(hemisphere.Document, "joint path"), "the job", 60)
    person.panel_closed()
    toolpath = api.stages_of(hemisphere.Document, "toolpath")[0]
    assert toolpath.TravelSpeed.getValueAs("mm/s").Value == pytest.approx(9.0)
    assert toolpath.WireDiameter.getValueAs("mm").Value == pytest.approx(1.0)


def test_units_of_read_outs_and_colours(person, page, tmp_path):
    from freecad_am.gui.colours import ramp

    usual = ramp(np.array([0.0, 1.0]))
    page.unit.setCurrentIndex(page.unit.findText("mm/min"))
    page.ramp.setCurrentIndex(page.ramp.findData("grey"))
    page.colour.setProperty("color", person.widgets.QColor("#3366cc"))
    page.machines.setText(str(tmp_path))
    page.saveSettings()
    assert preferences.speed(6.0) == pytest.approx(360.0) and preferences.speed_unit() == "mm/min"
    grey = ramp(np.array([0.0, 1.0]))
    np.testing.assert_allclose(grey, grey[:, :1].repeat(3, axis=1), atol=0.01)
    assert np.abs(grey - usual).max() > 0.2 and grey[1, 0] > grey[0, 0] + 0.3
    np.testing.assert_allclose(preferences.machine_colour(), (0.2, 0.4, 0.8), atol=1e-9)
    assert str(tmp_path) in user_machines.folders()


def _simulated(person, path):
    """Return the simulation of a joint path at its first bead."""
    from freecad_am.gui.simulation import dock as simulations

    person.select(path)
    person.click("RoboticAM_Simulate")
    person.idle(0.2)
    simulation = simulations._open[0]
    simulation.player.go_to_row(int(np.flatnonzero(simulation.run.motion.deposit)[5]))
    simulation.show()
    return simulation


def test_what_is_drawn_and_told_follows_at_once(person, page, hemisphere):
    from freecad_am.gui.colours import ramp
    from freecad_am.gui.path import dock as path_dock
    from freecad_am.gui.plots import dock as plots
    from freecad_am.gui.redundancy_map import dock as maps
    from freecad_am.gui.simulation import dock as simulations

    doc = hemisphere.Document
    cell = api.make_cell(doc, limits="paper")
    toolpath = api.make_toolpath(doc, api.make_feature(doc, hemisphere, layer_height=15), cell)
    path = api.make_joint_path(doc, toolpath, cell)
    cell.ViewObject.ShowMachine = True
    view = path.ViewObject.Proxy
    person.look()
    person.select(path)
    for name in ("RoboticAM_Path", "RoboticAM_Plots"):
        person.click(name)
        person.idle(0.2)
    facts = person.field(person.panel(path_dock.NAME), "facts")
    panel = person.panel(plots.NAME)
    box = person.field(panel, "picture")
    box.setCurrentIndex(box.findData("travel"))

    def current_view():
        dock = plots.only.dock
        person.until(
            lambda: (
                dock.building.worker is None
                and dock.picture is not None
                and dock.picture.name == "travel"
            ),
            "the picture",
            20,
        )
        return dock.picture.charts[0]

    simulation = _simulated(person, path)
    old_view, colours = current_view(), view.path.colours.copy()

    def coloured():
        """Return how many pixels of the legend's corner are not grey."""
        file = str(person.folder / "legend.png")
        person.gui.activeDocument().activeView().saveImage(file, 600, 450, "White")
        image = person.widgets.QImage(file).convertToFormat(person.widgets.QImage.Format_RGB32)
        corner = (
            np.frombuffer(bytes(image.constBits()), dtype=np.uint8)
            .reshape(450, -1, 4)[:220, :60, :3]
            .astype(int)
        )
        return int((np.ptp(corner, axis=2) > 40).sum())

    simulation.close()  # the simulation hides the path and its legend
    assert coloured() > 1000
    simulation = _simulated(person, path)
    assert old_view.y.unit == "mm/s" and " 6 mm/s" in facts.text()
    page.unit.setCurrentIndex(page.unit.findText("mm/min"))
    page.ramp.setCurrentIndex(page.ramp.findData("grey"))
    page.colour.setProperty("color", person.widgets.QColor("#3366cc"))
    page.saveSettings()
    person.until(lambda: " 360 mm/min" in facts.text(), "the path's dock to follow")
    person.until(lambda: current_view().y.unit == "mm/min", "the plots to follow")
    new_view = current_view()
    for old_curve, new_curve in zip(old_view.curves, new_view.curves):
        np.testing.assert_allclose(new_curve.y, 60.0 * old_curve.y)
        np.testing.assert_allclose(new_curve.x, old_curve.x)
    assert new_view.span == pytest.approx((0.0, 60.0 * old_view.span[1]))
    assert person.field(person.panel(simulations.NAME), "speed").text() == "360 mm/min"
    share = view.scale.share(view.scale.values)
    expected = np.rint(255.0 * ramp(share)).astype(int)
    shown_colours = np.stack([view.path.colours >> shift & 255 for shift in (24, 16, 8)], axis=1)
    assert (shown_colours == expected).all() and (view.path.colours != colours).mean() > 0.9
    for links in (simulation.scene.machine, cell.ViewObject.Proxy.nodes.machine):
        plain = [
            material for link in links.materials for material, colour in link if colour is None
        ]
        assert plain and all(
            np.allclose(material.diffuseColor[0].getValue(), (0.2, 0.4, 0.8), atol=1e-6)
            for material in plain
        )
    person.screenshot("preferences_at_once")
    simulation.close()
    assert coloured() < 20
    person.select(path)
    person.click("RoboticAM_SpinMap")
    spin = maps._open[0]
    person.until(lambda: spin.canvas.painted is not None, "the map", 30)
    cells = spin.canvas.painted.colours.copy()
    preferences.keep("Ramp", "violet to orange")  # a change outside the page
    person.until(lambda: (spin.canvas.painted.colours != cells).any(), "the map to follow")
    spin.close()


def test_what_cannot_be_is_told_and_not_kept(person, page):
    page.machines.setText("/nowhere/at all")
    line = page.process["travel_speed"].widget.findChild(person.widgets.QLineEdit)
    line.setText("-3 mm/s")
    page.machine.setEditText("kuka-kr99")
    page.saveSettings()
    assert preferences.machine_folder() == "" and preferences.process() == {}
    assert preferences.machine() == preferences.builtin_machine()
    person.until(
        lambda: "the folder /nowhere/at all does not exist" in person.console(), "the warning"
    )
    assert "Travel speed: -3 mm/s is out of range" in person.console()
    assert "Machine: unknown name 'kuka-kr99'; did you mean kuka-kr16-2" in person.console()


def test_without_a_window_preferences_count_for_nothing(person, clean, root, tmp_path):
    """A separate Python reads the same parameters after FreeCAD has written them."""
    preferences.keep("Machine", "kuka-kr16-2")
    App.saveParameter()
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from freecad_am.batch import host; host.find_freecad();"
        "import FreeCAD; from freecad_am.objects.fields import preferences as p;"
        "print(FreeCAD.ParamGet(p.GROUP).GetString('Machine', ''), p.machine(), p.process())"
    )
    python = "/usr/bin/python3" if "freecad" in sys.executable.lower() else sys.executable
    process = subprocess.run(
        [python, "-c", code, str(root)], capture_output=True, text=True, timeout=60
    )
    assert process.stdout.split() == ["kuka-kr16-2", "fanuc-arcmate120ic", "{}"], process.stderr
