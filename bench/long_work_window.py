# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measure long work inside FreeCAD's window; run by `long_work`, which sets FRAMES_TO to the file
for the results."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

from in_window import begin, settle
from sizes import choose

TICK = 10  # ms
WAIT = 0.3  # s from the dialog to Cancel
COARSE = {"layer_height": 15.0, "chord_error": 0.5}  # for a joint path at the smallest size
MAX_PREVIEW_S = 60.0  # s, maximum time to watch a preview


class Pauses:
    """The longest time (s) between two ticks of a timer that is always due."""

    def __init__(self) -> None:
        from PySide import QtCore

        self.longest, self.last = 0.0, time.perf_counter()
        self.timer = QtCore.QTimer()
        self.timer.setInterval(TICK)
        self.timer.timeout.connect(self.tick)
        self.timer.start()

    def tick(self) -> None:
        now = time.perf_counter()
        self.longest, self.last = max(self.longest, now - self.last), now


def measure_cancel(job) -> dict[str, float]:
    """Seconds until Cancel has ended the work, and the longest pause of the window until then."""
    import FreeCADGui as Gui
    from PySide import QtCore, QtGui

    from freecad_am import api
    from freecad_am.gui import busy
    from freecad_am.objects.work.progress import Cancelled

    pressed: list[float] = []

    def visible_dialogs():
        return [
            dialog
            for dialog in Gui.getMainWindow().findChildren(QtGui.QDialog, busy.NAME)
            if dialog.isVisible()
        ]

    def press() -> None:
        pressed.append(time.perf_counter())
        visible_dialogs()[0].findChild(QtGui.QAbstractButton, "cancel").click()

    def look() -> None:
        if visible_dialogs():
            timer.stop()
            QtCore.QTimer.singleShot(int(1e3 * WAIT), press)

    timer = QtCore.QTimer()
    timer.setInterval(TICK)
    timer.timeout.connect(look)
    timer.start()
    pauses = Pauses()
    try:
        getattr(api, job.function)(job.document, **job.inputs)
        raise AssertionError("seen to the end")
    except Cancelled:
        took = time.perf_counter() - pressed[0]
    pauses.timer.stop()
    while any(thread.name == "Robotic AM" for thread in threading.enumerate()):
        settle(0.1)
    return {"cancel": took, "pause": pauses.longest}


def measure_preview(open_panel, words: str) -> float:
    """The longest pause (s) while an opened panel computes its preview, until it shows these words,
    and again after another entry."""
    import FreeCADGui as Gui
    from PySide import QtGui

    open_panel()
    settle(0.1)  # the panel itself is open
    pauses = Pauses()
    for entered in (False, True):
        state = Gui.getMainWindow().findChild(QtGui.QLabel, "preview")
        if entered:
            enter_another()
            settle(1.0)
        end = time.perf_counter() + MAX_PREVIEW_S
        while words not in state.text() and time.perf_counter() < end:
            settle(0.05)
        assert words in state.text(), state.text()
    pauses.timer.stop()
    Gui.Control.closeDialog()
    settle(0.5)
    return pauses.longest


def enter_another() -> None:
    """Change the first known value in the open panel."""
    import FreeCADGui as Gui
    from PySide import QtGui

    for name, text in (
        ("LayerHeight", "0.7 mm"),
        ("PlatformDiameter", "90 mm"),
        ("MinCondition", "0.03"),
        ("ProgramName", "OTHER"),
    ):
        fields = [
            widget
            for widget in Gui.getMainWindow().findChildren(QtGui.QWidget, name)
            if widget.isVisible()
        ]
        if fields:
            line = (
                fields[0]
                if isinstance(fields[0], QtGui.QLineEdit)
                else fields[0].findChild(QtGui.QLineEdit)
            )
            line.setText(text)
            return
    raise AssertionError("no field is known")


def measure_panels() -> list[dict[str, object]]:
    """Measure the panels of a cell and a joint path with 120,000 points, and of a program with
    25,000."""
    import FreeCAD as App

    from freecad_am import api
    from freecad_am.gui.panels.cell import CellPanel
    from freecad_am.gui.panels.joint_path import JointPathPanel
    from freecad_am.gui.panels.program import ProgramPanel
    from freecad_am.gui.panels.stage import show
    from tests.gui.long_jobs import joints, sphere

    job = joints(Path(os.environ["FRAMES_OF"]), **choose({}, COARSE))
    settle(1.0)
    results = [
        {
            "job": "cell",
            "preview": measure_preview(
                lambda: show(CellPanel(job.inputs["cell"])), "nozzle upright"
            ),
        },
        {
            "job": "joint path",
            "preview": measure_preview(lambda: show(JointPathPanel()), "rapids"),
        },
    ]
    App.closeDocument(job.document.Name)
    document = App.newDocument("Program")
    cell = api.make_cell(document, limits="paper")
    toolpath = api.make_toolpath(
        document, api.make_feature(document, sphere(document), layer_height=choose(0.4, 15.0)), cell
    )
    api.make_joint_path(document, toolpath, cell)
    settle(1.0)
    results.append(
        {"job": "program", "preview": measure_preview(lambda: show(ProgramPanel()), "Begins with")}
    )
    App.closeDocument(document.Name)
    return results


def measure_all() -> list[dict[str, object]]:
    """Measure every job."""
    import FreeCAD as App

    from freecad_am.gui import registry
    from tests.gui.long_jobs import JOBS, PREVIEWED

    results = []
    jobs, previewed_jobs = choose((JOBS, PREVIEWED), (JOBS[:1], PREVIEWED[1:2]))
    for make in dict.fromkeys((*jobs, *previewed_jobs)):
        job = make(Path(os.environ["FRAMES_OF"]))
        settle(1.0)
        result: dict[str, object] = {
            "job": make.__name__,
            **(measure_cancel(job) if make in jobs else {}),
        }
        if make in previewed_jobs:
            result["preview"] = measure_preview(
                lambda feature=job.inputs["feature"]: registry.edit(feature), "irst layer"
            )
        results.append(result)
        App.closeDocument(job.document.Name)
    return results + measure_panels()


begin(measure_all)
