# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts from files: damaged files that crash the kernel are rejected, and FreeCAD's window
continues."""

import os
import subprocess
import sys
import time
from pathlib import Path

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.brep.files import sandbox
from freecad_am.brep.files.read import read_shape
from freecad_am.brep.kernel import process as kernel_process
from freecad_am.core.issues import InputError
from freecad_am.objects.work.progress import Cancelled
from tests.brep.test_read import in_unit
from tests.robust import damage

pytestmark = pytest.mark.gui

EXAMPLES = Path(__file__).resolve().parents[2] / "resources" / "examples"


# ---- functions that the other process runs; it imports this file


def waiting(path, *_):
    Path(path).with_suffix(".pid").write_text(str(os.getpid()), encoding="utf-8")
    time.sleep(3600)


def crashing(path):
    os.abort()


def ending(path):
    os._exit(0)


def endless(path):
    while True:
        pass


def growing(path):
    chunks = []
    while True:
        chunks.append(bytearray(10_000_000))


@pytest.fixture(autouse=True)
def processes():
    yield
    kernel_process.file_workers.end()


@pytest.fixture
def chosen(person, monkeypatch):
    """Return a function that selects a file in the dialog of the tool."""

    def choose(path):
        monkeypatch.setattr(
            person.widgets.QFileDialog, "getOpenFileName", lambda *_: (str(path), "")
        )
        person.click("RoboticAM_OpenPart")

    return choose


@pytest.fixture
def crash(tmp_path):
    """Return a STEP file that crashes its reader, as a separate FreeCAD shows."""
    content = (EXAMPLES / "hemisphere.step").read_bytes()
    path = tmp_path / "damaged.step"
    text = f"import sys; sys.path[:] = {sys.path!r}; import FreeCAD, Part; Part.Shape().read({str(path)!r}); print('whole')"
    for seed in range(20):
        path.write_bytes(damage.damaged(content, "references", seed))
        python = kernel_process._pythons()[0]
        process = subprocess.run([python, "-c", text], capture_output=True, timeout=60, check=False)
        if (
            process.returncode
            and b"whole" not in process.stdout
            and b"Traceback" not in process.stderr
        ):
            return path
    pytest.skip("this kernel crashes on none of them")


def test_a_file_that_crashes_the_kernel_is_refused_and_the_window_goes_on(
    person, chosen, crash, monkeypatch
):
    warnings_ = []
    monkeypatch.setattr(
        person.widgets.QMessageBox, "warning", lambda *arguments: warnings_.append(arguments[-1])
    )
    chosen(crash)
    assert len(warnings_) == 1 and warnings_[0].startswith(
        "damaged.step: the file is damaged: FreeCAD crashes while reading it"
    ), warnings_
    assert not App.listDocuments()  # the document created for it is closed
    chosen(EXAMPLES / "hemisphere.step")  # FreeCAD still works
    imported_part = App.ActiveDocument.Objects[0]
    assert (
        len(warnings_) == 1
        and imported_part.Label == "hemisphere"
        and imported_part.Shape.isValid()
    )
    assert [obj.Name for obj in person.gui.Selection.getSelection()] == [imported_part.Name]
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(
        lambda: person.field(panel, "Source").text() == "hemisphere", "the part to be taken", 10
    )
    person.press("Cancel")
    person.panel_closed()


def test_a_table_of_points_is_opened_and_laid_as_beads(person, chosen, tmp_path):
    # not at the top: the other process imports this file, and the test measures its memory
    from freecad_am.gui.tools import commands

    (tmp_path / "beads.csv").write_text("x,y,z\n0,0,0\n40,0,0\n40,30,0\n", encoding="utf-8")
    chosen(tmp_path / "beads.csv")
    assert ".csv" in commands.ENDINGS  # one of the endings in the dialog
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(
        lambda: "deposited as beads" in person.field(panel, "reason").text(), "the proposal", 20
    )
    assert person.field(panel, "Kind").currentText() == "Curves as beads"
    assert person.field(panel, "Source").text() == "beads"
    person.press("Ok")
    person.until(lambda: not person.gui.Control.activeDialog(), "the job to be made", 60)
    toolpath = api.stages_of(App.ActiveDocument, "toolpath")[0]
    assert toolpath.Status == "up to date" and api.result(toolpath).layers[0].beads[
        0
    ].length == pytest.approx(70.0)


def test_what_is_opened_in_the_window_is_what_the_commands_read(person, tmp_path):
    import MeshPart
    import Part

    local_shape = Part.Shape()
    local_shape.read(str(EXAMPLES / "hemisphere.step"))
    document = App.newDocument("Files")
    assert (
        read_shape(EXAMPLES / "hemisphere.step").exportBrepToString()
        == local_shape.exportBrepToString()
    )  # to the last digit
    assert (
        api.open_part(document, str(EXAMPLES / "hemisphere.step")).Shape.Volume
        == local_shape.Volume
    )
    in_unit(tmp_path / "inches.step", Part.makeCone(20, 10, 30), 25.4, "INCH")
    assert api.open_part(
        document, str(tmp_path / "inches.step")
    ).Shape.BoundBox.ZLength == pytest.approx(762.0)
    MeshPart.meshFromShape(local_shape, 1.0).write(str(tmp_path / "bowl.stl"))
    assert api.open_part(document, str(tmp_path / "bowl.stl"), scale=2.0).Mesh.CountFacets > 10
    document.saveAs(str(tmp_path / "both.FCStd"))
    App.closeDocument(document.Name)
    document = App.newDocument("Files")
    again = api.open_part(document, str(tmp_path / "both.FCStd"), "hemisphere")
    assert (
        again.Shape.Volume == pytest.approx(local_shape.Volume, rel=1e-12)
        and len(App.listDocuments()) == 1
    )


@pytest.mark.parametrize(("read", "says"), [
    (crashing, "crashes"), (ending, "crashes"), (endless, "more than 1 s of processor time"),
    (growing, "more than 100 MB of memory"), (waiting, "more than 1 s of processor time"),
])  # fmt: skip
def test_limits_are_told_in_the_window_too(person, monkeypatch, tmp_path, read, says):
    monkeypatch.setattr(sandbox, "SECONDS", 1.0)
    monkeypatch.setattr(sandbox, "MEMORY", 100.0)
    monkeypatch.setattr(sandbox, "WALL_CLOCK_FACTOR", 2.0 if read is waiting else 100.0)
    with pytest.raises(InputError) as error_info:
        sandbox.read_in_sandbox(read, tmp_path / "part.step")
    assert (error_info.value.code, error_info.value.where) == (
        "BAD_FILE",
        "part.step",
    ) and says in error_info.value.message


def test_reading_that_takes_long_can_be_cancelled_and_leaves_no_process(
    person, monkeypatch, tmp_path
):
    from freecad_am.brep.files import read

    monkeypatch.setattr(read, "_shape", waiting)
    path = tmp_path / "long.step"
    path.write_text("x", encoding="utf-8")
    document = App.newDocument("Files")

    def cancel():
        box = person.window.findChild(person.widgets.QProgressDialog, "RoboticAM_Progress")
        if box is not None and path.with_suffix(".pid").exists():
            box.findChild(person.widgets.QPushButton, "cancel").click()
            timer.stop()

    timer = person.core.QTimer()
    timer.timeout.connect(cancel)
    timer.start(50)
    person.watch.awaited = (person.widgets.QProgressDialog,)
    with pytest.raises(Cancelled):
        api.open_part(document, str(path))
    person.watch.awaited = ()
    pid = int(path.with_suffix(".pid").read_text())
    person.until(lambda: not Path(f"/proc/{pid}").exists(), "the process to end", 10)
    assert not document.Objects
