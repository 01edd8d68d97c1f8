# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cell is saved by its context menu, and chosen by its name for the next job."""

import numpy as np
from scipy.spatial.transform import Rotation

from freecad_am import api
from freecad_am.gui.tools import context_menu
from freecad_am.objects.fields import saved_cells
from tests.gui.test_flow import entries


def test_a_saved_cell_is_chosen_by_name_in_new_job(
    person, hemisphere, coarse, no_remedies, monkeypatch, tmp_path
):
    doc = hemisphere.Document
    monkeypatch.setattr(saved_cells, "own_folder", lambda: str(tmp_path / "cells"))
    cell = api.make_cell(
        doc,
        machine="kuka-kr16-2",
        setup="tool-on-robot",
        deposition_point=(1000, 0, 300, 0, 0, 30),
        branch="auto",
        nozzle_tool=(0, 0, 150, 0, 0, 0),
    )
    expected = api.result(cell)
    proposed_names = []

    def choose_file(_window, _title, proposed, _kinds):
        proposed_names.append(proposed)
        return str(tmp_path / "cells" / "hall 3"), ""

    monkeypatch.setattr(context_menu.QtGui.QFileDialog, "getSaveFileName", choose_file)
    menu_entries, _menu = entries(person, cell)
    menu_entries["SaveCell"].trigger()
    path = tmp_path / "cells" / "hall 3.yaml"
    assert (
        proposed_names == [str(tmp_path / "cells" / "Cell.yaml")]
        and api.read_cell(str(path)) == expected
    )
    doc.removeObject(cell.Name)

    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    machine = person.field(panel, "Machine")
    assert machine.itemText(0) == "saved cell: hall 3" and machine.itemData(0) == str(path)
    machine.setCurrentIndex(0)
    person.as_revolution()
    person.press("Ok")
    person.panel_closed()
    stages = api.stages_of(doc)
    assert [obj.Proxy.kind for obj in stages][:1] == ["cell"] and api.result(stages[0]) == expected


def test_a_frame_is_typed_as_its_pendant_shows_it(person, hemisphere):
    """The values in the six fields equal a rotation composed here."""
    doc = hemisphere.Document
    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    choice, line = (
        person.field(panel, "DepositionPointPendant"),
        person.field(panel, "DepositionPointShown"),
    )
    assert not line.isVisible()
    choice.setCurrentIndex(choice.findData("kuka"))
    assert line.isVisible() and line.placeholderText() == "X Y Z A B C"
    person.type(panel, "DepositionPointShown", "1000 -20 300 90 30 0")
    line.editingFinished.emit()
    choice.setCurrentIndex(choice.findData("abb"))
    x, y, z, *quaternion_ = map(float, line.text().split())
    # R = Rz(90) Ry(30): half angles of 45 and 15 deg
    expected = Rotation.from_euler("ZY", [90.0, 30.0], degrees=True)
    assert (x, y, z) == (1000.0, -20.0, 300.0) and np.allclose(
        quaternion_, np.roll(expected.as_quat(), 1), atol=1e-6
    )
    person.type(panel, "DepositionPointShown", "1000 -20 300 0.9 0.9 0 0")
    line.editingFinished.emit()
    assert "quaternion" in line.toolTip()  # the fields stay unchanged
    person.press("Ok")
    person.panel_closed()
    pose = api.result(doc.Cell).deposition_point
    assert np.allclose(pose[:3], (1000.0, -20.0, 300.0)) and np.allclose(
        Rotation.from_euler("XYZ", pose[3:]).as_matrix(), expected.as_matrix(), atol=1e-9
    )
