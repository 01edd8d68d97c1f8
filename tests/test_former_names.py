# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents of earlier versions name classes at their old locations and get the current ones."""

import ast
import importlib
import sys
from pathlib import Path

import pytest

from freecad_am.gui import former_names
from freecad_am.objects.results import schemas
from freecad_am.objects.results.earlier_formats import SCHEMA_NAMES

ROOT = Path(__file__).resolve().parent.parent
# names in `GuiDocument.xml` of documents saved before the window's modules moved into folders
SAVED = {
    "view_cell": {"CellView"},
    "view_cladding": {"CladdingView"},
    "view_curves": {"CurvesView"},
    "view_feature": {"FeatureView"},
    "view_hub": {"HubView", "SolidView"},
    "view_job": {"JobView"},
    "view_joint_path": {"JointPathView"},
    "view_program": {"ProgramView"},
    "view_toolpath": {"ToolpathView"},
    "inspection.view": {"InspectionView"},
}


@pytest.mark.parametrize("name", sorted(SCHEMA_NAMES))
def test_results_that_documents_name_by_module_have_a_schema(name):
    kind = schemas.class_of(SCHEMA_NAMES[name])
    assert kind.__name__ == name.partition(":")[2]


@pytest.mark.parametrize("module", SAVED)
def test_classes_that_documents_name_are_where_they_are_looked_for(module):
    name = f"freecad_am.gui.{module}"
    path = ROOT / (former_names.MOVED.get(name, name).replace(".", "/") + ".py")
    locations = {
        node.name
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    }
    assert locations >= SAVED[module]


def test_a_former_name_has_the_class_itself(monkeypatch):
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path])
    monkeypatch.setitem(former_names.MOVED, "freecad_am.gui.view_old", "fractions")
    former_names.install()
    old = importlib.import_module("freecad_am.gui.view_old")
    monkeypatch.delitem(sys.modules, "freecad_am.gui.view_old")
    assert (
        old.Fraction is importlib.import_module("fractions").Fraction
        and old.__spec__.name == "freecad_am.gui.view_old"
    )
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("freecad_am.gui.view_of_nothing")
