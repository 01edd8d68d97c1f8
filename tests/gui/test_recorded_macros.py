# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macros that FreeCAD records while a person clicks run in a new window and without one."""

import os
import re
import shutil
import subprocess
import sys

import FreeCAD as App
import pytest

from freecad_am.gui.tools import commands
from tests.window import ROOT, private_home

TIMEOUT_S = 90  # s
# ends FreeCAD's window with the result of the macro
CHECK = """
import os, FreeCAD
stages = [
    (obj.Name, obj.Status) for obj in FreeCAD.ActiveDocument.Objects if hasattr(obj, "Status")
] if FreeCAD.ActiveDocument else []
with open({result!r}, "w") as file:
    file.write(repr(stages))
if {window}:
    os._exit(0)
"""


class Recorder:
    """FreeCAD's macro recorder, operated by its dialog."""

    def __init__(self, person, folder):
        self.person, self.folder, self.is_on = person, folder, False

    def start(self, name):
        """Start recording into a macro of this name."""
        App.ParamGet("User parameter:BaseApp/Preferences/Macro").SetString(
            "MacroPath", f"{self.folder}/"
        )
        widgets = self.person.widgets
        self.person.watch.awaited = (widgets.QDialog,)

        def fill():
            dialog = widgets.QApplication.activeModalWidget()
            lines = [] if dialog is None else dialog.findChildren(widgets.QLineEdit, "lineEditPath")
            if not lines:  # a busy machine shows it late
                timer.start(100)
                return
            lines[0].setText(name)
            dialog.findChild(widgets.QLineEdit, "lineEditMacroPath").setText(f"{self.folder}/")
            dialog.findChild(widgets.QPushButton, "buttonStart").click()

        timer = self.person.core.QTimer()
        timer.setSingleShot(True)
        timer.timeout.connect(fill)
        timer.start(100)
        self.person.gui.runCommand("Std_DlgMacroRecord")
        self.person.watch.awaited = ()
        self.is_on = True
        self.person.idle(0.2)

    def stop(self):
        """Stop recording and return the written file."""
        self.is_on = False
        self.person.gui.runCommand(
            "Std_MacroStopRecord" if int(App.Version()[0]) < 1 else "Std_DlgMacroRecord"
        )
        self.person.idle(0.2)
        return next(self.folder.glob("*.FCMacro"))


@pytest.fixture
def recorder(person, tmp_path):
    folder = tmp_path / "macros"
    folder.mkdir()
    someone = Recorder(person, folder)
    yield someone
    if someone.is_on:  # the test failed; the next one starts its own recording
        someone.stop()


def _play(macro, tmp_path, window):
    """Run a macro in a separate FreeCAD, and return the stages that it makes and the output."""
    home, result = tmp_path / f"home{window}", tmp_path / f"result{window}"
    home.mkdir()
    played = tmp_path / f"played{window}.FCMacro"
    text = macro.read_text(encoding="utf-8")
    played.write_text(text + CHECK.format(result=str(result), window=window), encoding="utf-8")
    program = shutil.which("freecad" if window else "freecadcmd")
    # end a window that stays open because its macro failed, and read its output
    process = subprocess.run(
        ["timeout", str(TIMEOUT_S), program, str(played)],
        env=private_home(home),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    output = process.stdout + process.stderr
    return (result.read_text() if result.exists() else "the macro did not end"), output


@pytest.mark.parametrize("window", [True, False])
def test_a_recorded_job_runs_again(person, recorder, tmp_path, window):
    recorder.start("job")
    person.gui.activateWorkbench("PartWorkbench")
    person.gui.runCommand("Std_New")
    person.gui.runCommand("Part_Sphere")
    person.open_workbench()
    document = App.ActiveDocument
    person.gui.doCommand("App.ActiveDocument.Sphere.Angle1 = 0")
    person.gui.doCommand("App.ActiveDocument.Sphere.Radius = 30")
    document.recompute()
    person.select(document.Sphere)
    person.click("RoboticAM_NewJob")
    person.as_revolution()
    person.press("Ok")
    person.panel_closed()
    person.double_click(document.Feature)
    person.type(person.panel("RoboticAM_RevolutionFeature"), "LayerHeight", "5 mm")
    person.press("Ok")
    person.panel_closed()
    person.click("RoboticAM_Path")
    macro = recorder.stop()
    text = macro.read_text(encoding="utf-8")
    assert "am.make_all(" in text and "am.change(" in text
    expected = repr([(obj.Name, obj.Status) for obj in document.Objects if hasattr(obj, "Status")])
    stages, output = _play(macro, tmp_path, window)
    assert stages == expected, output[-2000:]


def test_every_command_records_a_module_that_can_be_imported(person, recorder, hemisphere):
    recorder.start("commands")
    for name in [*commands.TOOLS, "Help"]:
        if name in ("OpenPart", "NewMachine"):  # they open a dialog of their own
            continue
        person.gui.runCommand(f"RoboticAM_{name}")
        person.idle(0.05)
        if person.gui.Control.activeDialog():
            person.gui.Control.closeDialog()
    text = recorder.stop().read_text(encoding="utf-8")
    names = set(re.findall(r"^\s*import (\S+)", text, re.MULTILINE))
    assert "freecad_am" in names
    python = (
        "import sys, importlib\n"
        f"sys.path[:0] = [{str(ROOT)!r}]\n"
        f"[importlib.import_module(name) for name in {sorted(names - {'FreeCAD', 'PartGui'})!r}]"
    )
    process = subprocess.run(
        [shutil.which("python3", path="/usr/bin") or sys.executable, "-c", python],
        capture_output=True,
        text=True,
        cwd="/",
        env={"PATH": os.environ["PATH"]},
        check=False,
    )
    assert process.returncode == 0, process.stderr
