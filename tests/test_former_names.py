# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents of earlier versions name classes where these no longer are, and get those of now."""

import ast
import importlib
import sys
from pathlib import Path

import pytest

from freecad_am.gui import former_names
from freecad_am.objects.results import store

ROOT = Path(__file__).resolve().parent.parent
SAVED = {  # in `GuiDocument.xml` of documents saved before modules of the window moved into folders
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


RESULTS = {  # in results of documents saved before modules of the geometry moved into folders
    "clad_faces:CladFaces",
    "curves:BeadCurve",
    "curves:Curves",
    "mesh:Mesh",
    "mesh_wall:MeshWall",
    "part_depths:PartDepths",
    "part_depths:Surface",
    "patch:Patch",
    "patch_wall:FirstCurve",
    "patch_wall:PatchWall",
    "patch_wall:Rim",
    "profile:Meridian",
    "profile:RevolvedWall",
    "solid_mesh:SolidMesh",
    "surface:Cone",
    "surface:Torus",
    "surface_wall:Placed",
    "surface_wall:SurfaceWall",
    "on_hub:SolidsOnHub",
    "guide:Guide",
    "surroundings:Body",
}


@pytest.mark.parametrize("name", sorted(RESULTS))
def test_results_that_documents_hold_are_of_the_classes_of_now(name):
    kind = store._class(f".core.geometry.{name}")
    assert kind.__name__ == name.split(":")[1] and kind.__module__.startswith(
        "freecad_am.core.geometry."
    )


# in results of documents saved before the other rooms of core and objects: these never moved, and are not to
HELD = (
    ".core.geometry.curves.bead_curves:BeadCurve",
    ".core.geometry.fitted:Fitted",
    ".core.geometry.on_hub:Base",
    ".core.geometry.on_hub:Group",
    ".core.geometry.plane:Plane",
    ".core.inspection.figures:Ball",
    ".core.inspection.figures:Spread",
    ".core.inspection.inspect:Inspected",
    ".core.inspection.roundness:Round",
    ".core.issues:Issue",
    ".core.motion:Motion",
    ".core.parameters.cell:CellParameters",
    ".core.parameters.cell:NozzleParameters",
    ".core.planning.joint_path:BeadPath",
    ".core.planning.joint_path:JointPath",
    ".core.toolpath:Bead",
    ".core.toolpath:Layer",
    ".core.toolpath:SpeedLaw",
    ".core.toolpath:Toolpath",
    ".objects.joint_path:Planned",
    ".objects.program:Written",
    ".verify:Verification",
)


@pytest.mark.parametrize("name", HELD)
def test_results_name_classes_where_they_stay(name):
    kind = store._class(name)
    assert f"{kind.__module__}:{kind.__name__}" == f"freecad_am{name}"


@pytest.mark.parametrize("module", SAVED)
def test_classes_that_documents_name_are_where_they_are_looked_for(module):
    name = f"freecad_am.gui.{module}"
    path = ROOT / (former_names.MOVED.get(name, name).replace(".", "/") + ".py")
    there = {
        node.name
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    }
    assert there >= SAVED[module]


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
