# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws window.png, wall-window.png and hub-window.png of the README: FreeCAD's window with the planned hemisphere of the
examples, with the panel of a bend on a pipe, and with the beads of a thruster beside the fit of their bead model.

    python3 docs/images/make_window.py [PICTURE...]

Needs FreeCAD (of Qt 5, as Debian 12 has it) and xvfb-run. A fresh FreeCAD profile is made for it, as the tests of the
window do; the same file is run again inside FreeCAD for each picture, where it opens the parts, clicks what the README
tells, and takes the picture.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

PICTURE = "ROBOTIC_AM_PICTURE"
DOCKS = """<FCParamGroup Name="DockWindows"><FCBool Name="Std_ComboView" Value="1"/>
<FCBool Name="Std_PythonView" Value="0"/><FCBool Name="Std_ReportView" Value="0"/></FCParamGroup>
<FCBool Name="Maximized" Value="1"/>"""
LIGHT = """<FCParamGroup Name="View"><FCUInt Name="BackgroundColor2" Value="4294967295"/>
<FCUInt Name="BackgroundColor3" Value="3705924863"/><FCInt Name="CornerCoordSystemSize" Value="8"/>"""
TIMEOUT = "180"
CLOSER = 0.86  # part of the height that shows all with its margins


def start(name: str) -> int:
    """Run FreeCAD on this file in a window of its own to take a picture; its exit status."""
    here = Path(__file__).resolve()
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(here.parents[2] / "tests"))
    import run

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        env = run.private_home(Path(folder))
        profile = Path(folder) / "user.cfg"
        text = profile.read_text(encoding="utf-8")
        text = text.replace('<FCBool Name="Maximized" Value="1"/>', DOCKS).replace('<FCParamGroup Name="View">', LIGHT)
        profile.write_text(text, encoding="utf-8")
        env[PICTURE] = str(here.parent / name)
        env.pop("VIRTUAL_ENV", None)
        window = ["xvfb-run", "-a", "-s", run.SCREEN, "timeout", "-k", "5", TIMEOUT, "freecad", str(here)]
        return subprocess.run(window, env=env, stdin=subprocess.DEVNULL, check=False).returncode


class Photographer:
    """Does in FreeCAD's window what the README's first part by clicks tells."""

    def __init__(self) -> None:
        import FreeCADGui as Gui
        from PySide import QtCore, QtGui

        self.gui, self.core, self.widgets = Gui, QtCore, QtGui

    def idle(self, seconds: float) -> None:
        """Let the window do its work."""
        loop = self.core.QEventLoop()
        self.core.QTimer.singleShot(int(1000 * seconds), loop.quit)
        loop.exec_()

    def find(self, kind: Any, name: str) -> Any:
        """The visible widget of a kind with a name."""
        return next(one for one in self.gui.getMainWindow().findChildren(kind, name) if one.isVisible())

    def picture(self, path: str) -> None:
        """Make what the picture of this name shows, look at it from the front above and keep what the screen shows."""
        {"window.png": self._hemisphere, "wall-window.png": self._wall, "hub-window.png": self._hub}[Path(path).name]()
        self.idle(1.0)
        if not self.widgets.QApplication.primaryScreen().grabWindow(0).save(path):
            raise RuntimeError(f"{path} is not written")

    def _open(self, title: str, **files: str) -> list[Any]:
        """Example parts by label in a new document."""
        import FreeCAD as App

        from freecad_am import api

        document = App.newDocument(title)
        examples = Path(__file__).resolve().parents[2] / "resources" / "examples"
        parts = []
        for label, file in files.items():
            parts.append(api.open_part(document, str(examples / file)))
            parts[-1].Label = label
        return parts

    def _wall(self) -> None:
        bend, pipe = self._open("Bend", Bend="tube-on-pipe.step", Pipe="pipe.step")
        self.gui.Selection.addSelection("Bend", bend.Name, "Face1")
        self.gui.Selection.addSelection(pipe)
        self.gui.runCommand("RoboticAM_WallOnPart")
        self.idle(0.5)
        panel = self.find(self.widgets.QWidget, "RoboticAM_SurfaceFeature")
        panel.findChild(self.widgets.QWidget, "LayerHeight").findChild(self.widgets.QLineEdit).setText("5 mm")
        self._look()

    def _hub(self) -> None:
        from freecad_am import api
        from freecad_am.gui import stage_panel

        blades, spindle = self._open("Thruster", Blades="thruster/blades.brep", Spindle="thruster/spindle.step")
        document = blades.Document
        feature = api.make_developable_feature(
            document, blades, spindle, layer_height=8, bead_spacing=7, chord_error=0.2
        )
        toolpath = api.make_toolpath(document, feature, bead_model="csw", bead_width=9.5)
        toolpath.ViewObject.Colouring = "speed"
        stage_panel.edit(toolpath)
        self.idle(0.5)
        self._look(wide=400)
        fit = self.find(self.widgets.QLabel, "BeadModelFit")
        for area in self.gui.getMainWindow().findChildren(self.widgets.QScrollArea):
            if area.isVisible() and area.isAncestorOf(fit):
                area.ensureWidgetVisible(fit)

    def _hemisphere(self) -> None:
        from freecad_am import api

        part, = self._open("Hemisphere", hemisphere="hemisphere.step")
        document = part.Document
        self.gui.Selection.addSelection(part)
        self.gui.runCommand("RoboticAM_NewJob")
        self.idle(0.5)
        buttons = self.find(self.widgets.QDialogButtonBox, "")
        buttons.button(self.widgets.QDialogButtonBox.Ok).click()
        self.idle(0.5)
        statuses = [stage.Status for stage in api.stages_of(document)]
        if statuses != ["up to date"] * 5:
            raise RuntimeError(f"the job is not planned: {statuses}")
        self.gui.Selection.clearSelection()
        self.gui.Selection.addSelection(document.Toolpath)
        self._look()

    def _look(self, wide: int = 330) -> None:
        view = self.gui.ActiveDocument.ActiveView
        view.viewIsometric()
        view.fitAll()
        window = self.gui.getMainWindow()
        window.resizeDocks([window.findChild(self.widgets.QDockWidget, "Combo View")], [wide], self.core.Qt.Horizontal)
        for tree in window.findChildren(self.widgets.QTreeWidget):
            tree.expandAll()
        self.idle(0.5)
        view.fitAll()
        camera = view.getCameraNode()
        camera.height = CLOSER * camera.height.getValue()
        window.statusBar().clearMessage()


def take() -> None:
    """Called in FreeCAD's window: take the picture and end with its status."""
    status = 1
    try:
        Photographer().picture(os.environ[PICTURE])
        status = 0
    except BaseException:  # FreeCAD would stay open
        sys.__stderr__.write(traceback.format_exc())
        sys.__stderr__.flush()
    os._exit(status)


if PICTURE in os.environ:
    from PySide import QtCore

    QtCore.QTimer.singleShot(1000, take)
elif __name__ == "__main__":
    sys.exit(max(start(name) for name in sys.argv[1:] or ("window.png", "wall-window.png", "hub-window.png")))
