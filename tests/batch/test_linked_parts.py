# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of documents that link to other documents, with and without new values: the new shape, or a
clear error."""

import importlib
import os
import re
import sys
import time
import zipfile

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from freecad_am.batch.job.part_source import PartSource
from freecad_am.batch.job.shapes import bring
from freecad_am.brep.kernel.process import SANDBOXED
from freecad_am.core.issues import InputError
from freecad_am.objects.shapes.part_file import file_issues

SECOND = b"2026-11-01T12:00:00"
HOLE = 3.141592653589793 * 4 * 10  # volume of the cylinder in the box, 10 mm high


def close_all():
    for name in list(App.listDocuments()):
        App.closeDocument(name)


def run_and_close(work):
    """Run `work` and close its documents. It computes shapes, after which FreeCAD 1.0 and later
    have threads."""
    try:
        work()
    finally:
        close_all()


@pytest.fixture
def documents(tmp_path):
    """Return a folder in which `hall.FCStd` cuts a hole into a box of `sub/store.FCStd`, at z 50 in
    a rotated part, and sizes a box by its sheet."""
    (tmp_path / "sub").mkdir()

    def build():
        store = App.newDocument("store")
        sheet, box = (
            store.addObject("Spreadsheet::Sheet", "Sheet"),
            store.addObject("Part::Box", "Box"),
        )
        sheet.set("A1", "7")
        sheet.setAlias("A1", "tall")
        sheet.set("A2", "10")
        sheet.setAlias("A2", "broad")
        box.setExpression("Width", "Sheet.broad")
        box.Length = 10
        store.recompute()
        store.saveAs(str(tmp_path / "sub" / "store.FCStd"))
        hall = App.newDocument("hall")
        hall.saveAs(str(tmp_path / "hall.FCStd"))
        link, assembly = hall.addObject("App::Link", "Link"), hall.addObject("App::Part", "Asm")
        link.LinkedObject = box
        assembly.Placement = App.Placement(
            App.Vector(0, 0, 50), App.Rotation(App.Vector(0, 0, 1), 30)
        )
        cylinder = hall.addObject("Part::Cylinder", "Cylinder")
        cylinder.Radius, cylinder.Height, cylinder.Placement.Base = 2, 30, App.Vector(5, 5, 0)
        cut = hall.addObject("Part::Cut", "Cut")
        cut.Base, cut.Tool = link, cylinder
        assembly.addObject(cut)
        sized = hall.addObject("Part::Box", "Sized")
        sized.setExpression("Height", "store#Sheet.tall")
        visible_link = hall.addObject("App::Link", "Shown")
        visible_link.LinkedObject = box
        hall.recompute()
        hall.save()

    run_and_close(build)
    yield tmp_path
    close_all()


def volume(path, name, *settings):
    """Return the volume of a part brought into a document, with the codes of the issues of its
    file."""
    document = App.newDocument("Job")
    try:
        feature = bring(document, PartSource(str(path), name, settings=settings))
        feature.addProperty("App::PropertyLink", "Probe")
        holder = document.addObject("App::FeaturePython", "Holder")
        holder.addProperty("App::PropertyLink", "Of")
        holder.Of = feature
        return (
            feature.Shape.Volume,
            feature.Shape.BoundBox.ZMin,
            [issue.code for issue in file_issues(holder)],
        )
    finally:
        App.closeDocument(document.Name)


def change_store(folder, **cells):
    """Save the linked document with other values; FreeCAD records the time of saving in whole
    seconds."""
    time.sleep(1.1)

    def change():
        store = App.openDocument(str(folder / "sub" / "store.FCStd"))
        for cell, value in cells.items():
            store.Sheet.set(cell, value)
        store.recompute()
        store.save()

    run_and_close(change)


def test_a_value_set_in_a_document_that_links_to_another(documents):
    """The copy was once saved in another folder, where its links lead nowhere; the error NO_OBJECT
    then named a temporary path."""
    hall = documents / "hall.FCStd"
    full_volume = volume(hall, "Cut")
    assert full_volume == (pytest.approx(1000 - HOLE), pytest.approx(50), [])
    wide = volume(hall, "Cut", ("Cylinder", "Radius", "3 mm"))
    assert wide == (pytest.approx(1000 - HOLE * 9 / 4), pytest.approx(50), [])
    assert volume(hall, "Shown", ("Cylinder", "Radius", "3 mm")) == (
        pytest.approx(1000),
        pytest.approx(0),
        ["SET_UNUSED"],
    )
    assert not App.listDocuments()


def test_a_value_set_after_threads_of_the_kernel_started(documents, monkeypatch):
    """A forked copy once waited forever for threads that it did not have; FreeCAD 0.20 starts none
    for booleans."""

    def fork(*_):
        raise AssertionError("a process with threads was forked")

    monkeypatch.setattr(os, "fork", fork)
    wide = volume(documents / "hall.FCStd", "Cut", ("Cylinder", "Radius", "3 mm"))
    assert wide == (pytest.approx(1000 - HOLE * 9 / 4), pytest.approx(50), [])


def test_a_value_set_in_the_linked_document(documents):
    hall = documents / "hall.FCStd"
    for name, key in (("Sheet", "broad"), ("Sheet", "A2"), ("Box", "Width")):
        new_volume, z, codes = volume(hall, "Cut", (name, key, "20 mm" if name == "Box" else "20"))
        assert (new_volume, z, codes) == (pytest.approx(2000 - HOLE), pytest.approx(50), []), name
    assert volume(hall, "Sized", ("Sheet", "tall", "9"))[0] == pytest.approx(900)


def test_a_linked_document_that_changed_later(documents):
    """FreeCAD marks objects that link to it as touched, and keeps their earlier shapes."""
    change_store(documents, A1="9", A2="20")
    hall = documents / "hall.FCStd"
    assert volume(hall, "Cut") == (
        pytest.approx(2000 - HOLE),
        pytest.approx(50),
        ["LINKED_CHANGED"],
    )
    assert volume(hall, "Sized") == (pytest.approx(900), pytest.approx(0), ["LINKED_CHANGED"])
    wide = volume(hall, "Cut", ("Cylinder", "Radius", "3 mm"))
    assert wide[0] == pytest.approx(2000 - HOLE * 9 / 4) and wide[2] == ["LINKED_CHANGED"]


def test_a_linked_document_saved_again_within_the_same_second(documents):
    hall = documents / "hall.FCStd"

    def change(again):
        """Save both documents as if in the same second, the linked one before or after the
        other."""
        for name in ("sub/store.FCStd", "hall.FCStd"):
            with zipfile.ZipFile(documents / name) as archive:
                texts = {member: archive.read(member) for member in archive.namelist()}
            with zipfile.ZipFile(documents / name, "w") as archive:
                for member, text in texts.items():
                    if member == "Document.xml":
                        text = re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?=Z|\+00:00)", SECOND, text)
                    archive.writestr(member, text)
        os.utime(documents / "sub" / "store.FCStd", ns=(10**18 + again, 10**18 + again))
        os.utime(hall, ns=(10**18, 10**18))

    change_store(documents, A2="20")
    change(-1)
    assert volume(hall, "Cut") == (pytest.approx(1000 - HOLE), pytest.approx(50), [])
    change(1000)
    assert volume(hall, "Cut") == (
        pytest.approx(2000 - HOLE),
        pytest.approx(50),
        ["LINKED_CHANGED"],
    )


def test_a_change_two_documents_away(documents):
    def build():
        top = App.newDocument("top")
        top.saveAs(str(documents / "top.FCStd"))
        hall = App.openDocument(str(documents / "hall.FCStd"))
        link, box = top.addObject("App::Link", "Link"), top.addObject("Part::Box", "Cube")
        link.LinkedObject, box.Length = hall.Cut, 1
        common = top.addObject("Part::Fuse", "Fuse")
        box.Placement.Base.x = 100
        common.Base, common.Tool = link, box
        top.recompute()
        top.save()

    run_and_close(build)
    change_store(documents, A2="20")
    assert volume(documents / "top.FCStd", "Fuse")[0] == pytest.approx(2000 - HOLE + 100)


def test_a_missing_linked_file_is_named(documents):
    (documents / "sub" / "store.FCStd").rename(documents / "sub" / "lost.FCStd")
    hall = documents / "hall.FCStd"
    for name in ("Cut", "Link", "Shown", "Sized"):
        for settings in ((), (("Cylinder", "Radius", "3 mm"),)):
            with pytest.raises(InputError) as caught:
                volume(hall, name, *settings)
            assert caught.value.code == "NO_LINKED_FILE", caught.value.line()
            assert "store.FCStd" in caught.value.message and "hall.FCStd" in caught.value.where
    assert volume(hall, "Cylinder", ("Cylinder", "Radius", "1 mm"))[0] == pytest.approx(
        HOLE / 4 * 3
    )


ADD_ON = """
import Part
class Gear:
    def __init__(self, obj):
        obj.Proxy = self
        obj.addProperty("App::PropertyLength", "Teeth").Teeth = 5
    def execute(self, obj):
        obj.Shape = Part.makeBox(3, 3, obj.Teeth.Value)
    def dumps(self): return None
    def loads(self, state): pass
    __getstate__, __setstate__ = dumps, loads
"""


def test_a_value_of_an_object_whose_add_on_is_missing(tmp_path, monkeypatch):
    """The shape once stayed as saved, without a message."""
    monkeypatch.setenv(SANDBOXED, "1")  # only this process loads the add-on
    (tmp_path / "gear_add_on.py").write_text(ADD_ON)
    monkeypatch.syspath_prepend(str(tmp_path))
    module = importlib.import_module("gear_add_on")
    doc = App.newDocument("gears")
    gear, sheet = (
        doc.addObject("Part::FeaturePython", "Gear"),
        doc.addObject("Spreadsheet::Sheet", "Sheet"),
    )
    module.Gear(gear)
    sheet.set("A1", "6")
    gear.setExpression("Teeth", "Sheet.A1")
    plain = doc.addObject("Part::Box", "Plain")
    doc.recompute()
    path = tmp_path / "gears.FCStd"
    doc.saveAs(str(path))
    close_all()
    assert plain is not None and volume(path, "Gear", ("Gear", "Teeth", "7 mm"))[
        0
    ] == pytest.approx(63)
    (tmp_path / "gear_add_on.py").unlink()
    del sys.modules["gear_add_on"]
    importlib.invalidate_caches()
    for setting in (("Gear", "Teeth", "7 mm"), ("Sheet", "A1", "7")):
        with pytest.raises(InputError) as caught:
            volume(path, "Gear", setting)
        assert caught.value.code == "NO_ADD_ON" and caught.value.where == "part.set"
        assert "Gear" in caught.value.message
    assert volume(path, "Gear")[0] == pytest.approx(54)
    assert volume(path, "Plain", ("Plain", "Length", "2 mm"))[0] == pytest.approx(200)


def test_a_constraint_with_an_expression(tmp_path):
    """A set value overrides its expression; the expression once won, without a message."""
    import Sketcher

    doc = App.newDocument("sketched")
    sketch = doc.addObject("Sketcher::SketchObject", "Sketch")
    sketch.addGeometry(Part.Circle(App.Vector(), App.Vector(0, 0, 1), 5))
    sketch.addConstraint(Sketcher.Constraint("Radius", 0, 5))
    sketch.renameConstraint(0, "Round")
    sketch.setExpression("Constraints.Round", "4 mm")
    body = doc.addObject("Part::Extrusion", "Body")
    body.Base, body.LengthFwd, body.Solid, body.Dir = sketch, 10, True, App.Vector(0, 0, 1)
    doc.recompute()
    doc.saveAs(str(tmp_path / "sketched.FCStd"))
    close_all()
    new_volume = volume(
        tmp_path / "sketched.FCStd", "Body", ("Sketch.Constraints", "Round", "2 mm")
    )
    assert new_volume[0] == pytest.approx(HOLE)


def test_the_place_in_an_opened_file(documents):
    """`am.open_part` reads containers, links and array elements of a file as a document shows
    them."""

    def build():
        doc = App.openDocument(str(documents / "hall.FCStd"))
        array = doc.addObject("App::Link", "Array")
        array.LinkedObject, array.ElementCount = doc.Cylinder, 3
        doc.recompute()
        for k, element in enumerate(array.ElementList):
            element.Placement.Base.x = 100 * k
        array.ShowElement = False
        array.Label = "Row"
        doc.Asm.addObject(array)
        doc.recompute()
        doc.save()

    run_and_close(build)
    job = App.newDocument("Job")
    for name in ("Array.2", "Row.2"):
        feature = api.open_part(job, str(documents / "hall.FCStd"), name)
        centre = feature.Shape.CenterOfMass
        assert (centre.x, centre.y, centre.z) == pytest.approx((173.2050808, 100, 65))
    assert len(api.open_part(job, str(documents / "hall.FCStd"), "Row").Shape.Solids) == 3
    with pytest.raises(InputError, match=r"Array\.3"):
        api.open_part(job, str(documents / "hall.FCStd"), "Array.3")


def test_export_of_a_document_that_links_to_another(documents):
    """The export uses the current linked document, and names a missing one."""
    from freecad_am.batch.measured import export
    from tests import plans

    def build():
        hall = App.openDocument(str(documents / "hall.FCStd"))
        with plans.share_plans():
            cell = api.make_cell(hall, limits="paper")
            feature = api.make_solid_feature(hall, hall.Shown, layer_height=5, chord_error=0.5)
            api.make_toolpath(hall, feature, cell)
        hall.save()

    class Session:
        issues = progress = check = lambda self, *_: None

    def wires():
        (path,) = export(
            str(documents / "hall.FCStd"), str(documents / "out"), ("Toolpath",), Session(), "dxf"
        )
        with open(path, encoding="ascii") as stream:
            lines = [line.strip() for line in stream]
        return max(float(y) for code, y in zip(lines, lines[1:]) if code == "20")

    run_and_close(build)
    original_wires = wires()
    change_store(documents, A2="30")
    assert wires() == pytest.approx(original_wires + 20, abs=1.0)
    (documents / "sub" / "store.FCStd").unlink()
    with pytest.raises(InputError) as caught:
        wires()
    assert caught.value.code == "NO_LINKED_FILE" and "store.FCStd" in caught.value.message
    doc = App.openDocument(str(documents / "hall.FCStd"))
    assert "store.FCStd, which does not exist" in doc.Feature.Message
