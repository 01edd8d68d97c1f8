# SPDX-License-Identifier: LGPL-2.1-or-later
"""A person at the window, who sees buttons, fields and pictures, clicks and types. Unexpected
dialogs are recorded."""

import importlib
import os
import time
from pathlib import Path

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.macro import features
from tests import plans
from tests.gui.hand import Hand

DIALOG_TIMEOUT_S = 2.0  # s that a dialog may stay open before it counts as unexpected


def pytest_collection_modifyitems(items):
    gui_folder = Path(__file__).parent
    for item in items:
        if gui_folder in Path(str(item.fspath)).parents:
            item.add_marker(pytest.mark.gui)


class ModalWatch:
    """Record and dismiss unexpected message boxes, which would block the run."""

    def __init__(self, qt_core, qt_gui):
        self.application = qt_gui.QApplication
        self.label = qt_gui.QLabel
        self.texts = []
        self.awaited = ()  # kinds of dialogs that the person expects
        self.first_seen = None
        self.timer = qt_core.QTimer()
        self.timer.setInterval(200)
        self.timer.timeout.connect(self.look)
        self.timer.start()

    def look(self):
        dialog = self.application.activeModalWidget()
        # the dialog of long work is expected
        if (
            dialog is None
            or dialog.objectName() == "RoboticAM_Progress"
            or isinstance(dialog, self.awaited)
        ):
            self.first_seen = None
            return
        if self.first_seen is None:
            self.first_seen = time.monotonic()
        if time.monotonic() - self.first_seen > DIALOG_TIMEOUT_S:
            words = [label.text() for label in dialog.findChildren(self.label) if label.text()]
            self.texts.append(" ".join([dialog.windowTitle(), *words]))
            self.first_seen = None
            dialog.close()


class Person:
    """The actions of a person; each fails if its widget is not visible."""

    def __init__(self, folder):
        import FreeCADGui
        from PySide import QtCore, QtGui

        self.gui, self.core, self.widgets = FreeCADGui, QtCore, QtGui
        self.window = FreeCADGui.getMainWindow()
        self.qt = importlib.import_module(
            "shiboken2" if QtCore.qVersion().startswith("5") else "shiboken6"
        )
        deferred = QtCore.QEvent.DeferredDelete
        self.deferred = int(getattr(deferred, "value", deferred))  # Qt 6, Qt 5
        self.folder = folder

    # ---- time

    def idle(self, seconds=0.15):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.widgets.QApplication.processEvents(self.core.QEventLoop.AllEvents, 20)
            # to Qt a test is one event, and deferred deletions happen between events
            self.core.QCoreApplication.sendPostedEvents(None, self.deferred)
            time.sleep(0.008)
        self.give_focus_back()

    def give_focus_back(self):
        """Give the focus to the main window after a dialog closes, such as that of long work: there
        is no window manager to do it."""
        application = self.widgets.QApplication
        if not (
            application.activeWindow()
            or application.activeModalWidget()
            or application.activePopupWidget()
        ):
            self.window.activateWindow()

    def until(self, condition, what, seconds=20):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            self.idle(0.05)
        value = condition()  # the window's own work since then may have taken all of the time
        if value:
            return value
        raise AssertionError(f"waited {seconds} s for {what}")

    # ---- widgets

    def present(self, kind, *name, below=None):
        """Return widgets of a kind below another one or the main window. Widgets that PySide takes
        for deleted ones at the same address are left out (docs/versions.md)."""
        widgets = (self.window if below is None else below).findChildren(kind, *name)
        return [widget for widget in widgets if self.qt.isValid(widget)]

    # ---- toolbar, panels, tree

    def open_workbench(self):
        self.gui.activateWorkbench("RoboticAMWorkbench")
        self.idle()

    def button(self, command):
        for bar in self.present(self.widgets.QToolBar):
            for action in bar.actions():
                widget = bar.widgetForAction(action)
                if (
                    command in (action.objectName(), action.data())
                    and widget is not None
                    and widget.isVisible()
                ):
                    return widget
        raise AssertionError(f"no button {command} is to be seen")

    def click(self, command):
        """Click the tool's button, or its menu entry if the window is too narrow for all
        buttons."""
        try:
            button = self.button(command)
        except AssertionError:
            button = self.entry(command)
        self.until(button.isEnabled, f"{command} to be enabled", 5)
        button.click() if hasattr(button, "click") else button.trigger()
        self.idle()

    def entry(self, command):
        """Return the entry of a tool in the menu of the workbench."""
        for menu in self.window.menuBar().findChildren(self.widgets.QMenu):
            for action in menu.actions():
                if command in (action.objectName(), action.data()):
                    return action
        raise AssertionError(f"no entry {command} is in a menu")

    def panel(self, name):
        def visible():
            return [
                widget for widget in self.present(self.widgets.QWidget, name) if widget.isVisible()
            ]

        return self.until(visible, f"the panel {name}", 5)[0]

    def field(self, panel, name):
        fields = panel.findChildren(
            self.widgets.QWidget, name
        )  # the others may be boxes that `press` has released
        assert len(fields) == 1, f"{len(fields)} fields are called {name}"
        return fields[0]

    def type(self, panel, name, text):
        widget = self.field(panel, name)
        line = (
            widget
            if isinstance(widget, self.widgets.QLineEdit)
            else widget.findChild(self.widgets.QLineEdit)
        )
        line.setText(text)
        self.idle(0.05)

    def choose(self, panel, name, text):
        box = self.field(panel, name)
        index = max(box.findText(text), box.findData(text))  # the shown text, or its key
        assert index >= 0, f"{name} does not offer {text}"
        box.setCurrentIndex(index)
        self.idle(0.05)

    def as_revolution(self, panel=None):
        """Choose parts of revolution in New Job, whatever it proposes: one bead in place of a
        filled solid."""
        panel = panel or self.panel("RoboticAM_NewJob")
        box = self.field(panel, "Kind")
        index = box.findText("Part of revolution")
        box.setCurrentIndex(index)  # a later proposal would overwrite the choice
        box.activated.emit(index)
        self.idle(0.05)

    def press(self, standard_button):
        button_kind = getattr(self.widgets.QDialogButtonBox, standard_button)
        boxes = self.present(self.widgets.QDialogButtonBox)
        try:
            for box in boxes:
                # a box found earlier may be deleted, with another one at its address
                if self.qt.isValid(box) and box.isVisible() and box.button(button_kind) is not None:
                    box.button(button_kind).click()
                    self.idle()
                    return
        finally:
            # Python keeps wrappers of found widgets, and would use them for later widgets at the
            # same address
            for box in boxes:
                self.qt.invalidate(box)
        raise AssertionError(f"no button {standard_button} is to be seen")

    def will_answer(self, standard_button):
        """Answer the question of the next step; the returned list then holds the question."""
        questions, end = [], time.monotonic() + DIALOG_TIMEOUT_S

        def answer():
            dialog = self.widgets.QApplication.activeModalWidget()
            if isinstance(dialog, self.widgets.QMessageBox):
                questions.append(dialog.text())
                dialog.button(getattr(self.widgets.QMessageBox, standard_button)).click()
            elif time.monotonic() < end:  # on a busy machine the question takes its time
                self.core.QTimer.singleShot(100, answer)

        self.core.QTimer.singleShot(500, answer)
        return questions

    def panel_closed(self):
        self.until(lambda: not self.gui.Control.activeDialog(), "the panel to close")

    def panel_error(self, panel):
        """Return the errors at the top of the panel and under its fields."""
        labels = [self.field(panel, "error"), *panel.findChildren(self.widgets.QLabel)]
        notes = [
            label
            for label in labels
            if label.isVisible() and label.objectName().endswith(("error", "Note"))
        ]
        return "\n".join(dict.fromkeys(label.text() for label in notes if label.text()))

    def double_click(self, obj):
        obj.ViewObject.Proxy.doubleClicked(obj.ViewObject)
        self.idle()

    def select(self, obj, *faces):
        self.gui.Selection.clearSelection()
        for face in faces or ("",):
            self.gui.Selection.addSelection(obj.Document.Name, obj.Name, face)
        self.idle(0.05)

    # ---- eyes

    def look(self):
        view = self.gui.activeDocument().activeView()
        view.viewIsometric()
        self.gui.SendMsgToActiveView("ViewFit")
        self.idle(0.4)
        return view

    def picture(self, width=600, height=450):
        """Return the 3D view as (pixels, 3) colours 0..255."""
        import numpy as np

        path = str(self.folder / "view.bmp")  # packing a PNG takes longer than drawing
        self.look().saveImage(path, width, height, "White")
        image = self.widgets.QImage(path).convertToFormat(self.widgets.QImage.Format_RGB32)
        rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(
            image.height(), -1, 4
        )
        return rows[:, : image.width(), 2::-1].reshape(-1, 3).astype(int)

    def path_pixels(self):
        """Return how many pixels have the colours of the first layers (blue) and of the last
        (yellow)."""
        red, green, blue = self.picture().T
        return int(((blue > red + 60) & (blue > green + 30)).sum()), int(
            ((red > blue + 60) & (green > blue + 60)).sum()
        )

    def path_is_seen(self):
        """Wait until the first and the last layers are visible, which takes time on a busy
        machine."""

        def both():
            counts.append(self.path_pixels())
            return counts[-1][0] > 200 and counts[-1][1] > 100

        counts = []
        self.until(both, "a path in blue and yellow", 10)

    def screenshot(self, name):
        """Save the whole screen in the folder ROBOTIC_AM_PICTURES; do nothing if it is not set."""
        folder = os.environ.get("ROBOTIC_AM_PICTURES")
        self.idle(0.3)
        if folder:
            screen = self.widgets.QApplication.primaryScreen()
            grabbed = (
                screen.grabWindow(0)
                if self.core.qVersion().startswith("5")
                else screen.grabWindow()
            )
            assert grabbed.save(os.path.join(folder, name + ".png"))

    def screen_pixels(self, colour, within=24):
        """Return how many pixels of the 3D view, as the screen shows it, have a colour 0..255."""
        import numpy as np

        self.idle(0.15)
        screen = self.widgets.QApplication.primaryScreen()
        view = self.gui.activeDocument().activeView()
        corner = view.graphicsView().mapToGlobal(self.core.QPoint(0, 0))
        grabbed = (
            screen.grabWindow(0) if self.core.qVersion().startswith("5") else screen.grabWindow()
        )
        cut = grabbed.toImage().copy(self.core.QRect(corner, self.core.QSize(*view.getSize())))
        image = cut.convertToFormat(self.widgets.QImage.Format_RGB32)
        rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(
            image.height(), -1, 4
        )
        return int(
            (
                np.abs(rows[:, : image.width(), 2::-1].astype(int) - colour).max(axis=2) < within
            ).sum()
        )

    def console(self):
        """Return the text of the report view."""
        view = self.window.findChild(self.widgets.QTextEdit, "Report view")
        assert view is not None, "there is no report view to watch"
        return view.toPlainText()


@pytest.fixture(autouse=True)
def planned_once(request):
    """Plan jobs that several tests use once, except in tests of the planning itself."""
    if request.node.get_closest_marker("planned_anew"):
        yield
    else:
        with plans.share_plans():
            yield


@pytest.fixture
def hand(person):
    return Hand(person)


@pytest.fixture
def hemisphere():
    """Return a new document with a hemisphere of 45 mm radius, whose label has a blank and
    accents."""
    document = App.newDocument("Window")
    sphere = document.addObject("Part::Sphere", "Sphere")
    sphere.Label = "Hémisphère n° 1"
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45, 0, 90
    document.recompute()
    return sphere


@pytest.fixture
def coarse(monkeypatch):
    """Give features layers of 5 mm, and walls 10 mm without clearance, unless the test sets other
    values: a new job then takes a fifth of the time."""
    make, low = api.make_feature_of, {"layer_height": 5.0, "chord_error": 0.1}
    of_kind = {
        "revolution": low,
        "surface": {**low, "layer_height": 10.0, "clearance": "none"},
        "developable": low,
        "solid": low,
    }

    def make_coarse(doc, kind, *arguments, values=None, **named):
        return make(
            doc, kind, *arguments, values={**of_kind.get(kind, {}), **(values or {})}, **named
        )

    monkeypatch.setattr(api, "make_feature_of", make_coarse)
    monkeypatch.setattr(features, "make_feature_of", make_coarse)


@pytest.fixture
def rough_map(monkeypatch):
    """Check the arm in only one of six rows of the redundancy map, if there are neighbours on both
    sides."""
    from freecad_am.gui.redundancy_map import dock as cells

    monkeypatch.setattr(cells, "FINE_STRIDE", cells.ROUGH_STRIDE)


@pytest.fixture
def joint_path(person, hemisphere):
    """Return a joint path of the hemisphere with only its beads visible."""
    document = hemisphere.Document
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=5), cell
    )
    path = api.make_joint_path(document, toolpath, cell)
    cell.ViewObject.Visibility = document.Feature.ViewObject.Visibility = False
    person.idle()
    return path


def _forget_places(window):
    """Forget the positions of our docks, as in a new session."""
    from freecad_am.gui import dock_area

    for dock in dock_area._docks.values():
        window.removeDockWidget(dock)
    dock_area._areas.clear()


@pytest.fixture
def person(tmp_path, capfd, request):
    someone = Person(tmp_path)
    watch = someone.watch = ModalWatch(someone.core, someone.widgets)
    someone.open_workbench()
    geometry, layout = someone.window.geometry(), someone.window.saveState()
    mark = f"watching {request.node.name}"
    App.Console.PrintError(mark + "\n")
    someone.until(lambda: mark in someone.console(), "the report view to show errors", 5)
    yield someone
    watch.timer.stop()
    captured = capfd.readouterr()
    text = someone.console().rpartition(mark)[2] + captured.out + captured.err
    if someone.gui.Control.activeDialog():
        someone.gui.Control.closeDialog()
    for name in list(App.listDocuments()):
        App.closeDocument(name)
    for page in someone.present(someone.widgets.QDialog, "RoboticAM_Help"):
        page.hide()  # the window for help covers the 3D view
    for dock in someone.present(someone.widgets.QDockWidget):  # an open dock keeps observing
        if dock.objectName().startswith("RoboticAM"):
            if dock.isFloating():
                dock.show()  # in Qt 6, a dock that is redocked while hidden stays a separate window
                dock.setFloating(False)
            dock.close()
    someone.idle()
    someone.window.setGeometry(
        geometry
    )  # docks that needed more room have made the window wider, and panels and tree lower
    someone.window.restoreState(layout)
    _forget_places(someone.window)
    someone.idle(0.1)
    assert not watch.texts, f"dialogs nobody asked for: {watch.texts}"
    assert "Traceback" not in text, text[-3000:]
