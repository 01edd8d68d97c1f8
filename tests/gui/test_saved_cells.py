# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cell saved by its context menu, and chosen by its name for the next job."""

from freecad_am import api
from freecad_am.gui.tools import context_menu
from freecad_am.objects.fields import saved_cells
from tests.gui.test_flow import entries


def test_a_saved_cell_is_chosen_by_name_in_new_job(person, hemisphere, coarse, no_remedies, monkeypatch, tmp_path):
    doc = hemisphere.Document
    monkeypatch.setattr(saved_cells, "own_folder", lambda: str(tmp_path / "cells"))
    cell = api.make_cell(doc, machine="kuka-kr16-2", setup="tool-on-robot", deposition_point=(1000, 0, 300, 0, 0, 30),
                         branch="auto", nozzle_tool=(0, 0, 150, 0, 0, 0))
    wanted = api.result(cell)
    asked = []

    def chosen(_window, _title, first, _kinds):
        asked.append(first)
        return str(tmp_path / "cells" / "hall 3"), ""

    monkeypatch.setattr(context_menu.QtGui.QFileDialog, "getSaveFileName", chosen)
    found, _menu = entries(person, cell)
    found["SaveCell"].trigger()
    path = tmp_path / "cells" / "hall 3.yaml"
    assert asked == [str(tmp_path / "cells" / "Cell.yaml")] and api.read_cell(str(path)) == wanted
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
    made = api.stages_of(doc)
    assert [obj.Proxy.kind for obj in made][:1] == ["cell"] and api.result(made[0]) == wanted
