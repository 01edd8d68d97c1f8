# SPDX-License-Identifier: LGPL-2.1-or-later
"""A lesson performs a page of docs/tutorials step by step like its reader, and takes the pictures
of the page. Every click and key goes through the X server. The page's headings are the steps; each
picture is taken in its step. At the end, a lesson fails if the page has a step or a picture that
was not performed."""

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
DIALOG_TIMEOUT_S = 30  # s until a dialog has opened and closed
RETRY_AFTER_S = 3  # s before a path is typed into a dialog again
NOISY = ("Report view", "Python console", "Selection view")
SIDES = ("Combo View", "Model", "Tasks", "Tree view", "Property view")
TREES = ("Combo View", "Model", "Tree view")
PLAIN = {"Simple": True, "Gradient": False, "RadialGradient": False}
GROUND = 0xEEF2F7FF  # a plain light colour, because gradients make pictures larger
SIDE_WIDTH_PX = 330  # width of tree and panels in pixels


class Lesson:
    """A page, its progress, and the hand that performs it."""

    def __init__(self, person, hand, name):
        self.person, self.hand, self.name = person, hand, name
        text = (PAGES / f"{name}.md").read_text(encoding="utf-8")
        sections = re.split(r"^## ", text, flags=re.MULTILINE)[1:]
        steps = {
            section.splitlines()[0].strip(): re.findall(
                r"!\[[^\]]*\]\(images/([\w-]+)\.png\)", section
            )
            for section in sections
        }
        self.told = {
            heading: pictures for heading, pictures in steps.items() if re.match(r"\d+\. ", heading)
        }
        self.done, self.taken = [], []
        pictures_folder = os.environ.get("ROBOTIC_AM_PICTURES")
        self.folder = Path(pictures_folder) / "tutorials" if pictures_folder else None
        if self.folder:
            self.folder.mkdir(parents=True, exist_ok=True)

    # ---- the page

    def step(self, heading):
        """Begin a step of the page, which must be the next one."""
        next_step = list(self.told)[len(self.done)]
        assert heading == next_step, (
            f"{self.name}.md goes on with '{next_step}', not with '{heading}'"
        )
        self._whole_step()
        self.done.append(heading)

    def _whole_step(self):
        """Assert that every picture of the last step was taken."""
        if self.done:
            assert self.taken == self.told[self.done[-1]], f"pictures of '{self.done[-1]}'"
        self.taken = []

    def finish(self):
        """Assert that the whole page was performed."""
        self._whole_step()
        assert self.done == list(self.told)

    def picture(self, name, path=False, legend=False, machine=False, dialog=False):
        """Take the current screen as a picture of the page, and check that it shows the expected
        contents."""
        from freecad_am.gui.path import legend as legends

        self.taken.append(name)
        if not dialog:
            assert self.person.widgets.QApplication.activeModalWidget() is None
        self.hand.do("mousemove", 700, 893)  # with no highlight and no tooltip
        self.person.idle(0.5)
        if self.folder:
            self._keep(name)
        view_pixels = self.pixels()
        if path:
            assert colourful(view_pixels) > 250, f"{name}: no path is to be seen"
        if legend:
            assert legends.visible_scales(App.ActiveDocument), f"{name}: there is no legend"
            corner = view_pixels[:220, :60]
            assert colourful(corner) > 200, f"{name}: the legend is not to be seen"
        if machine:
            assert machine_pixels(view_pixels) > 15000, f"{name}: the machine is not to be seen"

    def _keep(self, name):
        """Save the window, as the screen shows it, in a file for the page."""
        screen = self.person.widgets.QApplication.primaryScreen()
        grabbed = (
            screen.grabWindow(0)
            if self.person.core.qVersion().startswith("5")
            else screen.grabWindow()
        )
        window = self.person.window
        corner = window.mapToGlobal(self.person.core.QPoint(0, 0))
        window_image = grabbed.copy(self.person.core.QRect(corner, window.size()))
        assert window_image.save(str(self.folder / f"{name}.png"))

    def pixels(self):
        """Return the 3D view as the screen shows it, (height, width, 3) colours 0..255."""
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

    # ---- actions of a hand

    def keys(self, *keys):
        """Press keys with the main window in front."""
        self.person.window.activateWindow()
        self.hand.do(
            "windowfocus", int(self.person.window.winId())
        )  # there is no window manager to do this
        self.hand.do("key", *keys)
        self.person.idle(0.2)

    def in_file_dialog(self, path, trigger):
        """Open FreeCAD's file dialog by an action, type a path there and press Enter."""
        core, widgets, watch = self.person.core, self.person.widgets, self.person.watch
        state = {"typing": None, "since": time.monotonic(), "entered": False, "asked": False}
        end = time.monotonic() + 2 * DIALOG_TIMEOUT_S

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
            if time.monotonic() > end:  # only this timer runs while the dialog is open
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
                waited > RETRY_AFTER_S
            ):  # on a busy machine, the list of proposals may have taken letters, or Enter
                now(typing=None, entered=False)

        timer = core.QTimer()
        timer.timeout.connect(look)
        watch.awaited = (widgets.QDialog,)
        timer.start(100)
        try:
            trigger()
            self.person.until(lambda: state["entered"], "the file dialog", DIALOG_TIMEOUT_S)
            self.person.until(
                lambda: widgets.QApplication.activeModalWidget() is None,
                "the file dialog to close",
                DIALOG_TIMEOUT_S,
            )
        finally:
            timer.stop()
            watch.awaited = ()
        self.person.idle(0.3)

    def open(self, path):
        """Use File, Open."""
        self.in_file_dialog(path, lambda: self.keys("ctrl+o"))

    def add(self, path):
        """Use File, Import, into the same document."""
        self.in_file_dialog(path, lambda: self.menu("File", "Import"))

    def parts(self, *files):
        """Open one of the examples, add others, and fit the view; return the document and its
        objects."""
        first_file, *other_files = (ROOT / "resources" / "examples" / file for file in files)
        self.open(first_file)
        for file in other_files:
            self.add(file)
        self.see_all()
        return App.ActiveDocument, *App.ActiveDocument.Objects

    def save_as(self, path):
        """Use File, Save, for a document without a file."""
        self.in_file_dialog(path, lambda: self.keys("ctrl+s"))
        assert path.is_file()

    def keep(self, path):
        """Save a document next to the pictures, if these are saved: the samples are the results of
        tutorials."""
        if self.folder:
            shutil.copyfile(path, self.folder / path.name)

    def save_and_open_again(self, path):
        """Save to a new file, close it and open it: nothing is lost, and nothing needs a
        recompute."""
        self.save_as(path)
        self.keep(path)
        self.menu("File", "Close")
        assert not App.listDocuments()
        self.open(path)
        assert [stage.Status for stage in api.stages_of(App.ActiveDocument)] == ["up to date"] * 5

    def menu(self, title, entry):
        """Click an entry of a menu, such as 'File', 'Close'."""
        bar = self.person.window.menuBar()
        opener = self._click_entry(bar, title)
        self._click_entry(opener.menu(), entry)

    def _click_entry(self, menu_widget, text):
        """Click an entry of the menu bar or of an open menu, and return it."""
        titles = {
            action.text().replace("&", "").split("\t")[0].rstrip(".…"): action
            for action in menu_widget.actions()
        }
        assert text in titles, f"no '{text}' among {list(titles)}"
        middle = menu_widget.mapToGlobal(menu_widget.actionGeometry(titles[text]).center())
        self.hand.at((middle.x(), middle.y()))
        self.person.idle(0.3)
        return titles[text]

    def see_all(self):
        """Use the isometric view and fit all."""
        self.hand.click(self.person.button("Std_ViewIsometric"))
        self.hand.click(self.person.button("Std_ViewFitAll"))
        self.person.idle(0.3)

    def from_below(self):
        """Rotate the view until undersides are visible, like the middle button of the mouse, with
        the whole part in it."""
        view = self.person.gui.activeDocument().activeView()
        view.setCameraOrientation(
            App.Rotation(App.Vector(1, 0, 0), 120) * App.Rotation(App.Vector(0, 1, 0), 25)
        )
        self.hand.click(self.person.button("Std_ViewFitAll"))
        self.person.idle(0.3)

    def plotted(self):
        """Wait for a requested plot."""
        from freecad_am.gui.plots import dock

        self.person.until(
            lambda: dock.only.dock.building.worker is None and dock.only.dock.canvas.ready,
            "the plot",
            30,
        )
        self.person.idle(0.5)

    def play(self, factor, notches):
        """Play the simulation for a while, then move closer to the nozzle."""
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
        """Click a tool of the workbench's toolbar when it is enabled."""
        button = self.person.button(f"RoboticAM_{name}")
        self.person.until(button.isEnabled, f"{name} to be enabled", 5)
        self.hand.click(button)

    def ok(self, name="Ok"):
        """Press a button at the top of a task panel."""
        button_kind = getattr(self.person.widgets.QDialogButtonBox, name)
        boxes = self.person.present(self.person.widgets.QDialogButtonBox)
        button = next(
            box.button(button_kind)
            for box in boxes
            if box.isVisible() and box.button(button_kind) is not None
        )
        self.hand.click(button)
        for box in boxes:  # Python's wrappers would stand for later widgets at the same address
            self.person.qt.invalidate(box)
        self.person.panel_closed()
        self.person.idle(0.3)

    def choose(self, panel, name, text):
        """Choose an entry of a list: a click opens it, its first letters find the entry, Enter
        takes it."""
        box = self.person.field(panel, name)
        self.hand.click(box)
        # the panel has moved under the pointer, so a hand clicks again
        if not box.view().isVisible():
            self.person.idle(0.5)
            self.hand.click(box)
        self.person.until(box.view().isVisible, f"the list of {name}", 5)
        self.hand.do("type", "--delay", 20, text)
        self.hand.do("key", "Return")
        self.person.until(lambda: box.currentText() == text, f"{name} to be {text}", 5)

    def close(self, name):
        """Close a dock by the cross in its corner."""
        dock = self.person.panel(name)
        self.hand.click(
            dock.findChild(self.person.widgets.QAbstractButton, "qt_dockwidget_closebutton")
        )

        def is_closed():
            docks = self.person.present(self.person.widgets.QDockWidget, name)
            return not any(dock.isVisible() for dock in docks)

        self.person.until(is_closed, f"{name} to close", 5)

    def unfold(self, label):
        """Expand a line of the tree, by keys."""
        self.hand.click_tree(label)
        self.hand.do("key", "Right")

    def unfold_in(self, panel, title):
        """Open a closed group of a panel by its heading."""
        heading = self.person.field(panel, f"Fold{title.replace(' ', '')}")
        for _ in range(
            3
        ):  # a preview's message may move it away from the pointer, so a hand clicks again
            self.hand.click(heading)
            self.person.idle(0.5)
            if heading.isChecked():
                return
        raise AssertionError(f"{title} does not unfold")

    def double_click(self, label):
        """Double-click a line of the tree, some time after the click that scrolls to it: three
        clicks in a row mean something else."""
        self.hand.click_tree(label)
        self.person.idle(0.6)
        self.hand.do("click", "--repeat", 2, "--delay", 60, 1)
        self.person.idle(0.3)

    def drag(self, start, end):
        """Press at a position on the screen, move in steps like a hand, and release at another."""
        self.hand.do("mousemove", *start)
        self.hand.do("mousedown", 1)
        for share in (0.15, 0.4, 0.7, 1.0):
            self.hand.do(
                "mousemove", *(round(a + share * (b - a)) for a, b in zip(start, end, strict=True))
            )
        self.hand.do("mouseup", 1)
        self.person.idle(0.3)


def colourful(pixels):
    """Return how many pixels have the strong colours that only paths and legends have."""
    return int((pixels.max(axis=2) - pixels.min(axis=2) > 110).sum())


def machine_pixels(pixels):
    """Return how many pixels have the greys of machine links in any light; the background is
    lighter, and bluish."""
    greatest, smallest = pixels.max(axis=2), pixels.min(axis=2)
    return int(((greatest - smallest < 16) & (greatest < 215) & (smallest > 40)).sum())


@pytest.fixture
def lesson(person, hand, request):
    """Run the lesson of the test's page, in a window like in the pictures: tree and panels at the
    left, light background."""
    view = App.ParamGet("User parameter:BaseApp/Preferences/View")
    original_state, ground = (
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
        if dock.objectName() in SIDES and dock.isVisible() and dock.width() < SIDE_WIDTH_PX:
            person.window.resizeDocks([dock], [SIDE_WIDTH_PX], person.core.Qt.Horizontal)
            person.idle(0.2)
    lesson_ = Lesson(person, hand, request.module.PAGE)
    yield lesson_
    for dock in hidden:
        dock.show()
    view.SetUnsigned("BackgroundColor", ground)
    for name, value in original_state.items():
        view.SetBool(name, value)
