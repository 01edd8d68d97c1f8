# SPDX-License-Identifier: LGPL-2.1-or-later
"""A lesson: a page of docs/tutorials, done step by step as its reader does it, and the pictures that the page shows.

Every click and key goes through the X server. Headings of the page are the steps; a picture is taken within the step that
shows it. At its end a lesson fails when the page has a step or a picture that was not done.
"""

import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api

ROOT = Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs" / "tutorials"
DIALOG = 30  # s until a dialog has come and gone
AGAIN = 3  # s without effect until a path is typed into a dialog once more
NOISY = ("Report view", "Python console", "Selection view")
SIDES = ("Combo View", "Model", "Tasks", "Tree view", "Property view")
TREES = ("Combo View", "Model", "Tree view")
PLAIN = {"Simple": True, "Gradient": False, "RadialGradient": False}
GROUND = 0xEEF2F7FF  # plain and light: what gets lighter and darker takes room in pictures
SIDE = 330  # pixels that the tree and the panels get


class Lesson:
    """A page, how far it is done, and the hand that does it."""

    def __init__(self, person, hand, name):
        self.person, self.hand, self.name = person, hand, name
        text = (PAGES / f"{name}.md").read_text(encoding="utf-8")
        parts = re.split(r"^## ", text, flags=re.MULTILINE)[1:]
        told = {
            part.splitlines()[0].strip(): re.findall(r"!\[[^\]]*\]\(images/([\w-]+)\.png\)", part)
            for part in parts
        }
        self.told = {
            heading: pictures for heading, pictures in told.items() if re.match(r"\d+\. ", heading)
        }
        self.done, self.taken = [], []
        kept = os.environ.get("ROBOTIC_AM_PICTURES")
        self.folder = Path(kept) / "tutorials" if kept else None
        if self.folder:
            self.folder.mkdir(parents=True, exist_ok=True)

    # ---- the page

    def step(self, heading):
        """Begin with a step of the page; it is the next one."""
        wanted = list(self.told)[len(self.done)]
        assert heading == wanted, f"{self.name}.md goes on with '{wanted}', not with '{heading}'"
        self._whole_step()
        self.done.append(heading)

    def _whole_step(self):
        """Every picture of the step before was taken."""
        if self.done:
            assert self.taken == self.told[self.done[-1]], f"pictures of '{self.done[-1]}'"
        self.taken = []

    def finish(self):
        """All of the page was done."""
        self._whole_step()
        assert self.done == list(self.told)

    def picture(self, name, path=False, legend=False, machine=False, dialog=False):
        """What the screen shows now, as the page has it, with what has to be seen on it."""
        from freecad_am.gui.path import legend as legends

        self.taken.append(name)
        if not dialog:
            assert self.person.widgets.QApplication.activeModalWidget() is None
        self.hand.do("mousemove", 700, 893)  # nothing is lit up, and no tooltip is open
        self.person.idle(0.5)
        if self.folder:
            self._keep(name)
        seen = self.pixels()
        if path:
            assert colourful(seen) > 250, f"{name}: no path is to be seen"
        if legend:
            assert legends.visible_scales(App.ActiveDocument), f"{name}: there is no legend"
            corner = seen[:220, :60]
            assert colourful(corner) > 200, f"{name}: the legend is not to be seen"
        if machine:
            assert of_machine(seen) > 15000, f"{name}: the machine is not to be seen"

    def _keep(self, name):
        """The window as the screen shows it, in a file for the page."""
        screen = self.person.widgets.QApplication.primaryScreen()
        grabbed = (
            screen.grabWindow(0)
            if self.person.core.qVersion().startswith("5")
            else screen.grabWindow()
        )
        window = self.person.window
        corner = window.mapToGlobal(self.person.core.QPoint(0, 0))
        shown = grabbed.copy(self.person.core.QRect(corner, window.size()))
        assert shown.save(str(self.folder / f"{name}.png"))

    def pixels(self):
        """The 3D view as the screen shows it, (height, width, 3) colours 0..255."""
        screen = self.person.widgets.QApplication.primaryScreen()
        view = self.person.gui.activeDocument().activeView()
        grabbed = (
            screen.grabWindow(0)
            if self.person.core.qVersion().startswith("5")
            else screen.grabWindow()
        )
        cut = grabbed.toImage().copy(
            self.person.core.QRect(self.hand.corner(view), self.person.core.QSize(*view.getSize()))
        )
        image = cut.convertToFormat(self.person.widgets.QImage.Format_RGB32)
        rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(
            image.height(), -1, 4
        )
        return rows[:, : image.width(), 2::-1].astype(int)

    # ---- what a hand does

    def keys(self, *keys):
        """Keys pressed with the main window in front."""
        self.person.window.activateWindow()
        self.hand.do(
            "windowfocus", int(self.person.window.winId())
        )  # as a window manager does, of which there is none
        self.hand.do("key", *keys)
        self.person.idle(0.2)

    def in_file_dialog(self, path, trigger):
        """Do what brings up FreeCAD's dialog for files, type a path there and press Enter."""
        core, widgets, watch = self.person.core, self.person.widgets, self.person.watch
        state = {"typing": None, "since": time.monotonic(), "entered": False, "asked": False}
        end = time.monotonic() + 2 * DIALOG

        def now(**changed):
            state.update(changed, since=time.monotonic())

        def look():
            dialog = widgets.QApplication.activeModalWidget()
            if (
                isinstance(dialog, widgets.QDialog)
                and dialog.windowTitle().startswith("STEP")
                and not state["asked"]
            ):
                state["asked"] = True  # FreeCAD 1.0 and later ask how to read a STEP file
                button = dialog.findChild(widgets.QDialogButtonBox).button(
                    widgets.QDialogButtonBox.Ok
                )
                middle = button.mapToGlobal(button.rect().center())
                subprocess.Popen(
                    ["xdotool", "mousemove", str(middle.x()), str(middle.y()), "click", "1"]
                )
            if not isinstance(dialog, widgets.QFileDialog):
                return
            if time.monotonic() > end:  # nobody but this timer runs while the dialog is open
                state["entered"] = False
                dialog.reject()
                return
            line = dialog.findChild(widgets.QLineEdit, "fileNameEdit")
            waited = time.monotonic() - state["since"]
            if state["typing"] is None:
                if line.hasFocus():
                    now(
                        typing=subprocess.Popen(
                            ["xdotool", "key", "ctrl+a", "type", "--delay", "5", str(path)]
                        )
                    )
            elif state["typing"].poll() is None:
                now()
            elif line.text() == str(path) and not state["entered"]:
                now(entered=True)
                subprocess.Popen(["xdotool", "key", "Return"])
            elif (
                waited > AGAIN
            ):  # where the machine is busy, the list of proposals may have taken letters, or Enter
                now(typing=None, entered=False)

        timer = core.QTimer()
        timer.timeout.connect(look)
        watch.awaited = (widgets.QDialog,)
        timer.start(100)
        try:
            trigger()
            self.person.until(lambda: state["entered"], "the file dialog", DIALOG)
            self.person.until(
                lambda: widgets.QApplication.activeModalWidget() is None,
                "the file dialog to close",
                DIALOG,
            )
        finally:
            timer.stop()
            watch.awaited = ()
        self.person.idle(0.3)

    def open(self, path):
        """File, Open."""
        self.in_file_dialog(path, lambda: self.keys("ctrl+o"))

    def add(self, path):
        """File, Import: into the same document."""
        self.in_file_dialog(path, lambda: self.menu("File", "Import"))

    def parts(self, *files):
        """Open one of the examples and add others, and see them all; the document, and its objects."""
        first, *others = (ROOT / "resources" / "examples" / file for file in files)
        self.open(first)
        for file in others:
            self.add(file)
        self.see_all()
        return App.ActiveDocument, *App.ActiveDocument.Objects

    def save_as(self, path):
        """File, Save, of a document that has no file yet."""
        self.in_file_dialog(path, lambda: self.keys("ctrl+s"))
        assert path.is_file()

    def keep(self, path):
        """Keep a document beside the pictures, where these are kept: the samples are what tutorials end with."""
        if self.folder:
            shutil.copyfile(path, self.folder / path.name)

    def save_and_open_again(self, path):
        """Save to a new file, close, and open it: nothing is lost, and nothing is to be computed."""
        self.save_as(path)
        self.keep(path)
        self.menu("File", "Close")
        assert not App.listDocuments()
        self.open(path)
        assert [stage.Status for stage in api.stages_of(App.ActiveDocument)] == ["up to date"] * 5

    def menu(self, title, entry):
        """An entry of a menu, as 'File', 'Close'."""
        bar = self.person.window.menuBar()
        opener = self._click_entry(bar, title)
        self._click_entry(opener.menu(), entry)

    def _click_entry(self, shown, wanted):
        """Click an entry of the menu bar or of an open menu; the entry."""
        titles = {
            action.text().replace("&", "").split("\t")[0].rstrip(".…"): action
            for action in shown.actions()
        }
        assert wanted in titles, f"no '{wanted}' among {list(titles)}"
        middle = shown.mapToGlobal(shown.actionGeometry(titles[wanted]).center())
        self.hand.at((middle.x(), middle.y()))
        self.person.idle(0.3)
        return titles[wanted]

    def see_all(self):
        """Isometric, then fit all."""
        self.hand.click(self.person.button("Std_ViewIsometric"))
        self.hand.click(self.person.button("Std_ViewFitAll"))
        self.person.idle(0.3)

    def from_below(self):
        """The view turned until undersides are seen, as by the middle button of the mouse, and all of the part in it."""
        view = self.person.gui.activeDocument().activeView()
        view.setCameraOrientation(
            App.Rotation(App.Vector(1, 0, 0), 120) * App.Rotation(App.Vector(0, 1, 0), 25)
        )
        self.hand.click(self.person.button("Std_ViewFitAll"))
        self.person.idle(0.3)

    def plotted(self):
        """Wait for a plot that was asked for."""
        from freecad_am.gui.plots import dock

        self.person.until(
            lambda: dock.only.dock.building.worker is None and dock.only.dock.canvas.ready,
            "the plot",
            30,
        )
        self.person.idle(0.5)

    def play(self, factor, notches):
        """Play for a while with the simulation, then come closer to the nozzle."""
        self.tool("Simulate")
        dock = self.person.panel("RoboticAM_Simulation")
        self.choose(dock, "factor", factor)
        clock = self.person.field(dock, "clock").text()
        self.hand.click(self.person.field(dock, "play"))
        self.person.idle(2.0)
        self.hand.click(self.person.field(dock, "play"))
        assert self.person.field(dock, "clock").text() != clock
        self.zoom_to_nozzle(notches)

    def zoom_to_nozzle(self, notches):
        """Turn the wheel with the pointer on the nozzle of the simulation."""
        from freecad_am.gui.simulation import dock

        tip = np.array(dock._open[0].scene.nozzle.matrix.getValue().getValue())[3, :3]
        view = self.person.gui.activeDocument().activeView()
        x, y = (getattr(view, "getPointOnViewport", None) or view.getPointOnScreen)(
            App.Vector(*tip)
        )
        corner = self.hand.corner(view)
        self.hand.do("mousemove", corner.x() + x, corner.y() + view.getSize()[1] - 1 - y)
        for _ in range(notches):
            self.hand.do("click", 4)
        self.person.idle(0.3)

    def tool(self, name):
        """A tool of our toolbar, once it is no longer grey."""
        button = self.person.button(f"RoboticAM_{name}")
        self.person.until(button.isEnabled, f"{name} to be enabled", 5)
        self.hand.click(button)

    def ok(self, name="Ok"):
        """A button at the top of a task panel."""
        wanted = getattr(self.person.widgets.QDialogButtonBox, name)
        boxes = self.person.present(self.person.widgets.QDialogButtonBox)
        button = next(
            box.button(wanted)
            for box in boxes
            if box.isVisible() and box.button(wanted) is not None
        )
        self.hand.click(button)
        for box in (
            boxes
        ):  # what Python keeps of them would stand for whatever comes to be at their place later
            self.person.qt.invalidate(box)
        self.person.panel_closed()
        self.person.idle(0.3)

    def choose(self, panel, name, text):
        """An entry of a list: a click opens it, its first letters find the entry, Enter takes it."""
        box = self.person.field(panel, name)
        self.hand.click(box)
        if not box.view().isVisible():  # the panel has moved under the pointer: a hand clicks again
            self.person.idle(0.5)
            self.hand.click(box)
        self.person.until(box.view().isVisible, f"the list of {name}", 5)
        self.hand.do("type", "--delay", 20, text)
        self.hand.do("key", "Return")
        self.person.until(lambda: box.currentText() == text, f"{name} to be {text}", 5)

    def close(self, name):
        """A dock, by the cross in its corner."""
        dock = self.person.panel(name)
        self.hand.click(
            dock.findChild(self.person.widgets.QAbstractButton, "qt_dockwidget_closebutton")
        )

        def gone():
            docks = self.person.present(self.person.widgets.QDockWidget, name)
            return not any(one.isVisible() for one in docks)

        self.person.until(gone, f"{name} to close", 5)

    def unfold(self, label):
        """The arrow before a line of the tree, by keys."""
        self.hand.click_tree(label)
        self.hand.do("key", "Right")

    def unfold_in(self, panel, title):
        """The heading of a part of a panel that is folded away."""
        heading = self.person.field(panel, f"Fold{title.replace(' ', '')}")
        for _ in range(
            3
        ):  # what a preview tells may move it away from under the pointer: a hand clicks again
            self.hand.click(heading)
            self.person.idle(0.5)
            if heading.isChecked():
                return
        raise AssertionError(f"{title} does not unfold")

    def double_click(self, label):
        """A line of the tree, some time after the click that brings it in sight: three clicks in a row are another thing."""
        self.hand.click_tree(label)
        self.person.idle(0.6)
        self.hand.do("click", "--repeat", 2, "--delay", 60, 1)
        self.person.idle(0.3)

    def drag(self, start, end):
        """Press at a place of the screen, move in steps as a hand does, let go at another."""
        self.hand.do("mousemove", *start)
        self.hand.do("mousedown", 1)
        for share in (0.15, 0.4, 0.7, 1.0):
            self.hand.do(
                "mousemove", *(round(a + share * (b - a)) for a, b in zip(start, end, strict=True))
            )
        self.hand.do("mouseup", 1)
        self.person.idle(0.3)


def colourful(pixels):
    """How many pixels have the strong colours that only paths and legends have."""
    return int((pixels.max(axis=2) - pixels.min(axis=2) > 110).sum())


def of_machine(pixels):
    """How many pixels have the greys that links of machines have in any light; the ground is lighter, and bluish."""
    greatest, least = pixels.max(axis=2), pixels.min(axis=2)
    return int(((greatest - least < 16) & (greatest < 215) & (least > 40)).sum())


@pytest.fixture
def lesson(person, hand, request):
    """The lesson of the test's page, in a window as the pictures show it: tree and panels at the left, light ground."""
    view = App.ParamGet("User parameter:BaseApp/Preferences/View")
    before, ground = (
        {name: view.GetBool(name, name == "Gradient") for name in PLAIN},
        view.GetUnsigned("BackgroundColor"),
    )
    view.SetUnsigned("BackgroundColor", GROUND)
    for name, value in PLAIN.items():
        view.SetBool(name, value)
    docks = person.present(person.widgets.QDockWidget)
    hidden = [dock for dock in docks if dock.objectName() in NOISY and dock.isVisible()]
    for dock in hidden:
        dock.hide()
    for dock in docks:
        if dock.objectName() in TREES:
            dock.show()
    person.idle(0.2)
    for dock in docks:
        if dock.objectName() in SIDES and dock.isVisible() and dock.width() < SIDE:
            person.window.resizeDocks([dock], [SIDE], person.core.Qt.Horizontal)
            person.idle(0.2)
    made = Lesson(person, hand, request.module.PAGE)
    yield made
    for dock in hidden:
        dock.show()
    view.SetUnsigned("BackgroundColor", ground)
    for name, value in before.items():
        view.SetBool(name, value)
