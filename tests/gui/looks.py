# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's window runs this script. It opens every panel and dock in a light and a dark theme and
measures their visibility. LOOKS_FOLDER names the folder for the pictures and for `looks.json`, a
list of faults."""

import importlib
import json
import os
import sys
import time
import traceback
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

shiboken = importlib.import_module(
    "shiboken2" if QtCore.qVersion().startswith("5") else "shiboken6"
)

FOLDER = Path(os.environ["LOOKS_FOLDER"])
sys.path.insert(0, os.environ["LOOKS_ROOT"])
LEAST_CONTRAST = 4.5
TIMEOUT_S = 10  # s that a panel may take to open
MAX_PICTURES = 6  # maximum number of pictures of the same panel
MAX_PAGES = int(os.environ.get("LOOKS_PAGES", "6"))  # maximum number of pages of a panel
MARGIN_PX = 6  # pixels around a panel, which FreeCAD keeps at 250 if its view is narrower
DARK = ("Behave-dark.qss", "FreeCAD Dark.qss")
PANELS = (
    "NewJob",
    "Cell",
    "Feature",
    "WallOnPart",
    "Solid",
    "SolidsOnHub",
    "Curves",
    "Cladding",
    "Toolpath",
    "JointPath",
    "Program",
    "Inspect",
    "ExportPath",
)
PARTS = os.environ.get("LOOKS_PARTS", "panels docks")
DOCKS = ("Path", "Simulate", "Plots", "SpinMap", "Placement")


def idle(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QtGui.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 20)
        QtCore.QCoreApplication.sendPostedEvents(None, QtCore.QEvent.DeferredDelete)
        time.sleep(0.005)


def present(kind, below):
    from freecad_am.gui.widgets.upright import present as there

    return there(below, kind)


def screen():
    primary_screen = QtGui.QApplication.primaryScreen()
    grabbed = (
        primary_screen.grabWindow(0)
        if QtCore.qVersion().startswith("5")
        else primary_screen.grabWindow()
    )
    return grabbed.toImage().convertToFormat(QtGui.QImage.Format_RGB32)


def pixels(image):
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(image.height(), -1, 4)
    return rows[:, : image.width(), 2::-1].astype(float) / 255.0


def luminance(colours):
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


def contrast(area):
    """Return the largest contrast of a pixel with the most frequent colour of an area."""
    light = luminance(area).ravel()
    values, counts = np.unique(np.round(light, 3), return_counts=True)
    ground = values[counts.argmax()]
    return float(
        max((light.max() + 0.05) / (ground + 0.05), (ground + 0.05) / (light.min() + 0.05))
    )


def text_of(widget):
    if isinstance(widget, (QtGui.QLabel, QtGui.QAbstractButton)):
        return widget.text()
    if isinstance(widget, QtGui.QComboBox):
        return widget.currentText()
    return ""


def is_seen(widget):
    """Return whether the whole widget is on the screen with nothing over it."""
    return (
        widget.isVisible()
        and widget.isEnabled()
        and widget.width() > 8
        and widget.visibleRegion().boundingRect() == widget.rect()
    )


def judge(top, name, wrong):
    """Return the faults in contrast and room of every text below a widget, as the screen shows it
    when previews and layouts are at rest, which takes longer on a busy machine. A fault must appear
    in several pictures."""
    for _ in range(MAX_PICTURES):
        idle(0.3)
        faults = wrong_with(top, name)
        if not faults:
            return
    wrong.extend(faults)


def part_of(screen_pixels, widget, rect):
    """Return the pixels of a rectangle of a widget on the screen."""
    corner, ratio = widget.mapToGlobal(rect.topLeft()), widget.devicePixelRatioF()
    x, y, wide, high = (
        round(ratio * length) for length in (corner.x(), corner.y(), rect.width(), rect.height())
    )
    return screen_pixels[y : y + high, x : x + wide]


def wrong_with(top, name):
    """Return the faults of the texts below a widget in one picture of the screen."""
    wrong = []
    image = screen()
    image.save(str(FOLDER / f"{name}.png"))
    screen_pixels = pixels(image)
    for widget in present(QtGui.QWidget, top):
        icon = isinstance(widget, QtGui.QToolButton) and not widget.icon().isNull()
        text = text_of(widget)
        if widget.objectName() == "canvas" and widget.isVisible():
            area = part_of(screen_pixels, widget, widget.visibleRegion().boundingRect())
            if not area.size or contrast(area) < LEAST_CONTRAST:
                wrong.append(f"{name}: the plot is empty")
        if not (text.strip() or icon) or not widget.isVisible():
            continue
        what = f"{name}: {widget.objectName() or type(widget).__name__} {text[:40]!r}"
        if isinstance(widget, QtGui.QLabel) and not widget.pixmap():
            if widget.wordWrap():
                needed = widget.heightForWidth(widget.width())
                if needed > widget.height() + 1:
                    wrong.append(f"{what} is cut off: {widget.height()} of {needed} pixels high")
            elif widget.sizeHint().width() > widget.width() + 1 and (
                widget.sizePolicy().horizontalPolicy() != QtGui.QSizePolicy.Ignored
            ):
                wrong.append(f"{what} is cut off: {widget.width()} of {widget.sizeHint().width()}")
        elif isinstance(widget, QtGui.QAbstractButton) and text:
            needed = widget.fontMetrics().boundingRect(text).width()
            if needed > widget.width() + 1:
                wrong.append(f"{what} is cut off: {widget.width()} of {needed}")
        if is_seen(widget):
            area = part_of(screen_pixels, widget, widget.rect())
            # push buttons follow the theme, and two letters have too few full pixels for a
            # measurement
            is_measured = not isinstance(widget, QtGui.QPushButton) and (
                icon or len(text.strip()) > 2
            )
            if is_measured and area.size and contrast(area) < LEAST_CONTRAST:
                wrong.append(f"{what} has a contrast of {contrast(area):.1f}")
    return wrong


def upright(panel, name, wrong):
    for area in present(QtGui.QScrollArea, Gui.getMainWindow()):
        if area.isAncestorOf(panel) and area.horizontalScrollBar().maximum() > 0:
            over = area.horizontalScrollBar().maximum()
            if over > MARGIN_PX:
                wrong.append(f"{name}: is {over} pixels wider than what is seen of it")


def room(name, wrong, minimum):
    """Check that the window stays on the screen and the 3D view keeps its room."""
    window = Gui.getMainWindow()
    screen_area = QtGui.QApplication.primaryScreen().geometry()
    needed = window.minimumSizeHint()
    if needed.width() > screen_area.width() or needed.height() > screen_area.height():
        wrong.append(f"{name}: the window needs {needed.width()} x {needed.height()}")
    if window.width() > screen_area.width() or window.height() > screen_area.height():
        wrong.append(f"{name}: the window is {window.width()} x {window.height()}")
    wide, high = view_size()
    # FreeCAD's own bars and docks may leave less from the start
    least_wide, least_high = (
        min(0.25 * limit, 0.9 * now)
        for limit, now in zip((screen_area.width(), screen_area.height()), minimum, strict=True)
    )
    if wide < least_wide or high < least_high:
        wrong.append(f"{name}: the 3D view has {wide:.0f} x {high:.0f}, before {minimum}")


def view_size():
    """Return the size of the 3D view in device-independent pixels, like those of widgets."""
    ratio = Gui.getMainWindow().devicePixelRatioF()
    return tuple(length / ratio for length in Gui.activeDocument().activeView().getSize())


def scrolled(panel):
    """Return the scroll offsets that together show the whole panel, page by page."""
    areas = [a for a in present(QtGui.QScrollArea, Gui.getMainWindow()) if a.isAncestorOf(panel)]
    bars = [area.verticalScrollBar() for area in areas if area.verticalScrollBar().maximum() > 0]
    if not bars:
        yield 0
        return
    bar, page = bars[-1], max(bars[-1].pageStep() - 40, 100)
    for number, value in enumerate(range(0, bar.maximum() + page, page)):
        bar.setValue(min(value, bar.maximum()))
        idle(0.1)
        yield number


def cancel():
    """Close the task panel by its button, so that it removes its preview.

    Python keeps wrappers of found widgets and would use them for later widgets at the same address.
    """
    boxes = present(QtGui.QDialogButtonBox, Gui.getMainWindow())
    buttons = [box.button(QtGui.QDialogButtonBox.Cancel) for box in boxes if box.isVisible()]
    buttons = [button for button in buttons if button is not None]
    if buttons:
        buttons[0].click()
    for widget in (*buttons, *boxes):
        shiboken.invalidate(widget)


def panels():
    """Return the panel that was just opened, once it exists."""
    end = time.monotonic() + TIMEOUT_S
    while True:
        idle(0.5)
        names = [
            widget
            for widget in present(QtGui.QWidget, Gui.getMainWindow())
            if widget.isVisible()
            and widget.objectName().startswith("RoboticAM_")
            and not isinstance(widget, (QtGui.QDockWidget, QtGui.QAction))
            and widget.layout() is not None
        ]
        if (names and Gui.Control.activeDialog()) or time.monotonic() > end:
            return names


def look_at_panels(theme, wrong, page_limit):
    for command in PANELS:
        Gui.runCommand(f"RoboticAM_{command}")
        names = panels()
        if not Gui.Control.activeDialog() or not names:
            wrong.append(f"{theme}: {command} opens no panel")
            continue
        panel = names[-1]
        for page in scrolled(panel):
            judge(panel, f"{theme}-{command}-{page}", wrong)
            if page + 1 >= page_limit:
                break
        upright(panel, f"{theme}-{command}", wrong)
        cancel()
        idle(0.1)


def look_at_docks(theme, wrong):
    original_size = view_size()
    for command in DOCKS:
        Gui.runCommand(f"RoboticAM_{command}")
        idle(1.2)
        docks = [
            dock
            for dock in present(QtGui.QDockWidget, Gui.getMainWindow())
            if dock.isVisible() and dock.objectName().startswith("RoboticAM_")
        ]
        if not docks:
            wrong.append(f"{theme}: {command} opens no dock")
            continue
        for dock in docks:
            judge(dock, f"{theme}-{command}", wrong)
        room(f"{theme}-{command}", wrong, original_size)
        for dock in docks:
            dock.close()
        idle(0.3)


def themes():
    yield "light", ""
    folder = Path(App.getResourceDir()) / "Gui" / "Stylesheets"
    yield "dark", next((folder / name).read_text() for name in DARK if (folder / name).exists())


def job():
    from freecad_am import api

    document = App.newDocument("Looks")
    sphere = document.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45, 0, 90
    document.recompute()
    cell = api.make_cell(document, limits="paper")
    toolpath = api.make_toolpath(
        document, api.make_feature(document, sphere, layer_height=15), cell
    )
    path = api.make_joint_path(document, toolpath, cell)
    api.make_program(document, path)
    Gui.Selection.addSelection(document.Name, sphere.Name)
    idle(0.3)


def run():
    wrong = []
    try:
        Gui.activateWorkbench("RoboticAMWorkbench")
        window = Gui.getMainWindow()
        screen_area = QtGui.QApplication.primaryScreen().geometry()
        window.showNormal()
        window.setGeometry(screen_area)
        job()
        for theme, sheet in themes():
            QtGui.QApplication.instance().setStyleSheet(sheet)
            idle(0.5)
            window.setGeometry(
                screen_area
            )  # bars grow while a style sheet is set, and a window keeps such a height
            idle(0.2)
            if "docks" in PARTS:
                look_at_docks(theme, wrong)
            if "panels" in PARTS:
                look_at_panels(theme, wrong, MAX_PAGES)
    except BaseException:
        wrong.append(traceback.format_exc())
    (FOLDER / "looks.json").write_text(json.dumps(wrong, indent=1), encoding="utf-8")
    os._exit(0)


QtCore.QTimer.singleShot(500, run)
