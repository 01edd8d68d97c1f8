# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells saved as files: the offered ones, and a job in one."""

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.cell_records import EXTERNAL
from freecad_am.objects.fields import saved_cells

CELL = """\
# the cell in hall 3
machine: kuka-kr16-2
setup: tool-on-robot
deposition_point: [1050, 0, 200, 0, 0, 30]
nozzle: {tool: [0, 0, 150, 0, 0, 0]}
"""
JOB = "version: 1\npart: {file: pot.step}\ncell:\n  machine: kuka-kr16-2\n"


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Return the user's folder of cells."""
    monkeypatch.setattr(App, "getUserAppDataDir", lambda: str(tmp_path / "user"))
    folder = tmp_path / "user" / "RoboticAM" / "cells"
    folder.mkdir(parents=True)
    return folder


def test_cells_of_the_users_folder_and_beside_the_document_are_known(own, tmp_path):
    beside = tmp_path / "jobs"
    beside.mkdir()
    (own / "hall 3.yaml").write_text(CELL, encoding="utf-8")
    (own / "Bay.yml").write_text(CELL, encoding="utf-8")
    (beside / "hall 3.yaml").write_text(CELL, encoding="utf-8")
    (beside / "job.yaml").write_text(JOB, encoding="utf-8")
    (beside / "other.yaml").write_text("colour: red\n", encoding="utf-8")
    (beside / "bytes.yaml").write_bytes(b"machine: \xff\xfe")
    (beside / "notes.txt").write_text(CELL, encoding="utf-8")
    doc = App.newDocument()
    assert saved_cells.known(doc) == [
        (str(own / "Bay.yml"), "Bay"),
        (str(own / "hall 3.yaml"), "hall 3"),
    ]
    doc.saveAs(str(beside / "work.FCStd"))
    assert saved_cells.known(doc) == [
        (str(own / "Bay.yml"), "Bay"),
        (str(beside / "hall 3.yaml"), f"hall 3 ({beside})"),
        (str(own / "hall 3.yaml"), f"hall 3 ({own})"),
    ]
    App.closeDocument(doc.Name)
    assert saved_cells.known(None)[0][1] == "Bay"


def test_without_a_folder_there_are_none(tmp_path, monkeypatch):
    monkeypatch.setattr(App, "getUserAppDataDir", lambda: str(tmp_path / "nowhere"))
    assert saved_cells.known(None) == []


def test_a_job_is_made_in_a_saved_cell(own, tmp_path, root, monkeypatch, no_remedies):
    make = api.make_feature_of
    monkeypatch.setattr(
        api,
        "make_feature_of",
        lambda *args, **options: make(
            *args, **{**options, "values": {"layer_height": 25.0, "chord_error": 0.5}}
        ),
    )
    path = own / "hall.yaml"
    path.write_text(
        CELL
        + "external:\n- {machine: motoman-motopos-d500, pose: [1100, 60, -100, 0, 0, 20], carries: part}\n",
        encoding="utf-8",
    )
    cell = api.read_cell(str(path))
    assert (cell.machine, cell.setup, cell.nozzle.tool[:3]) == (
        "kuka-kr16-2",
        "tool-on-robot",
        (0.0, 0.0, 150.0),
    )
    (positioner,) = EXTERNAL.read(cell.external)
    assert (positioner.machine, positioner.pose[:3]) == (
        "motoman-motopos-d500",
        (1100.0, 60.0, -100.0),
    )
    doc = App.newDocument()
    imported_part = api.open_part(doc, str(root / "resources/examples/hemisphere.step"))
    stages = api.make_all(doc, imported_part, cell=str(path))
    assert api.result(stages[0]) == cell or (
        stages[0].Machine == "kuka-kr16-2" and EXTERNAL.read(stages[0].External) == cell.external
    )
    again = tmp_path / "again.yaml"
    api.export_cell(stages[0], str(again))
    assert api.read_cell(str(again)) == cell
    App.closeDocument(doc.Name)


def test_what_is_wrong_with_a_file_is_told(own):
    path = own / "wrong.yaml"
    path.write_text("machine: kuka-kr16-2\nsetup: by hand\n", encoding="utf-8")
    with pytest.raises(InputError, match="by hand"):
        api.read_cell(str(path))
    with pytest.raises(InputError) as raised:
        api.read_cell(str(own / "none.yaml"))
    assert raised.value.code == "NO_FILE"


def test_poses_of_a_file_and_of_macros_as_pendants_show_them(own):
    path = own / "shown.yaml"
    path.write_text(
        """\
machine: kuka-kr16-2
setup: tool-on-robot
deposition_point: [1050, 0, 200, kuka, 30, 0, 0]
platform: kuka 0 0 5 0 0 0
nozzle: {tool: fanuc 20 0 300 0 35 0}
external: [{machine: motoman-motopos-d500, pose: abb 1100 60 -100 0.9659258 0 0 0.2588190, carries: part}]
""",
        encoding="utf-8",
    )
    plain = own / "plain.yaml"
    plain.write_text(
        """\
machine: kuka-kr16-2
setup: tool-on-robot
deposition_point: [1050, 0, 200, 0, 0, 30]
platform: [0, 0, 5, 0, 0, 0]
nozzle: {tool: [20, 0, 300, 0, 35, 0]}
external: [{machine: motoman-motopos-d500, pose: [1100, 60, -100, 0, 0, 30], carries: part}]
""",
        encoding="utf-8",
    )
    cell_values, expected = api.read_cell(str(path)), api.read_cell(str(plain))
    for frame, expected_frame in (
        (cell_values.deposition_point, expected.deposition_point),
        (cell_values.nozzle.tool, expected.nozzle.tool),
        (cell_values.platform, expected.platform),
        (EXTERNAL.read(cell_values.external)[0].pose, EXTERNAL.read(expected.external)[0].pose),
    ):
        assert frame == pytest.approx(expected_frame, abs=1e-6)
    doc = App.newDocument()
    cell = api.make_cell(
        doc,
        machine="kuka-kr16-2",
        setup="tool-on-robot",
        deposition_point="kuka 1050 0 200 30 0 0",
        platform="kuka 0 0 5 0 0 0",
    )
    assert api.result(cell).deposition_point == pytest.approx(expected.deposition_point, abs=1e-9)
    App.closeDocument(doc.Name)
    path.write_text("machine: kuka-kr16-2\nnozzle: {tool: kuka 20 0 300 0 35}\n", encoding="utf-8")
    with pytest.raises(InputError, match="X Y Z A B C") as raised:
        api.read_cell(str(path))
    assert raised.value.where.endswith("cell.nozzle.tool")
