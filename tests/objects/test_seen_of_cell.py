# SPDX-License-Identifier: LGPL-2.1-or-later
"""A toolpath depends only on nozzle, platform and mount of its cell, because its layers may take
minutes."""

import dataclasses

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.strategies.solids import plan as solids_plan
from freecad_am.objects.planned.toolpaths import seen_of
from freecad_am.objects.results import fingerprints
from freecad_am.objects.stage import Stage
from freecad_am.objects.toolpath import Toolpath

RELEVANT_VALUES = {"nozzle_diameter": 3.0, "platform_diameter": 50.0, "mount": "feature"}


@pytest.fixture
def stages(doc, monkeypatch):
    """Return feature, cell and toolpath of a small box, and the list of its planned layers."""
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 16, 12, 4
    doc.recompute()
    planned, plan = [], solids_plan.plan
    monkeypatch.setattr(
        solids_plan, "plan", lambda *arguments: planned.append(arguments) or plan(*arguments)
    )
    cell = api.make_cell(doc)
    toolpath = api.make_toolpath(doc, api.make_solid_feature(doc, box), cell)
    return cell, toolpath, planned


def test_all_but_nozzle_platform_and_mount_leave_it_as_it_is(stages):
    cell, toolpath, planned = stages
    key, data = toolpath.Key, list(toolpath.ResultData)
    for values in (
        {"deposition_point": [900, 50, 600, 0, 5, 0]},
        {"platform": 12.0},
        {"machine": "ur-ur10e"},
    ):
        api.change(cell, **values)
        assert (toolpath.Status, toolpath.Key, len(planned)) == ("up to date", key, 1), values
    api.recompute(cell.Document, force=True)
    assert (toolpath.Key, list(toolpath.ResultData)) == (key, data) and len(planned) == 2


@pytest.mark.parametrize("name", RELEVANT_VALUES)
def test_each_of_these_renews_it(stages, name):
    cell, toolpath, planned = stages
    key = toolpath.Key
    api.change(cell, **{name: RELEVANT_VALUES[name]})
    assert toolpath.Status == "up to date" and toolpath.Key != key and len(planned) == 2


def test_what_is_planned_sees_nothing_else_of_the_cell(stages):
    cell = stages[0]
    api.change(cell, deposition_point=[900, 50, 600, 0, 5, 0], nozzle_length=44.0)
    cell_result = api.result(cell)
    relevant, usual = seen_of(cell_result), CellParameters()
    relevant_values = {
        field.name
        for field in dataclasses.fields(usual)
        if getattr(relevant, field.name) == getattr(cell_result, field.name)
        and getattr(cell_result, field.name) != getattr(usual, field.name)
    }
    assert (
        relevant_values == {"nozzle"}
        and relevant.deposition_point == usual.deposition_point != cell_result.deposition_point
    )


def test_a_document_from_before_fits_until_its_cell_changes(stages, tmp_path, monkeypatch):
    _, toolpath, planned = stages
    with monkeypatch.context() as patch:
        patch.setattr(Toolpath, "key", Stage.key)
        api.recompute(toolpath.Document, force=True)
    assert toolpath.Key == fingerprints.key_of_inputs(
        toolpath.Proxy, toolpath, fingerprints.key_of_stage
    )
    toolpath.Document.saveAs(str(tmp_path / "before.FCStd"))
    App.closeDocument(toolpath.Document.Name)
    again = App.openDocument(str(tmp_path / "before.FCStd"))
    try:
        api.recompute(again)
        assert again.Toolpath.Status == "up to date" and len(planned) == 2
        for x, times in ((900, 3), (901, 3)):
            api.change(again.Cell, deposition_point=[x, 50, 600, 0, 5, 0])
            assert again.Toolpath.Status == "up to date" and len(planned) == times
    finally:
        App.closeDocument(again.Name)
