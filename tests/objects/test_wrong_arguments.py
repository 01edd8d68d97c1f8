# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wrong arguments of macro functions, each instead of a right one, give an error of the package and
leave the document unchanged."""

import inspect
import math
import random
from types import SimpleNamespace

import FreeCAD as App
import Mesh
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import AmError
from freecad_am.core.parameters.filled import SolidParameters
from tests import plans
from tests.objects.conftest import sphere

# number of wrong values for each argument in a normal run; --long tries all
SEED, SAMPLE_SIZE = 20261128, 5
NOT_COMPARED = {"Proxy", "ResultData", "Shape", "Mesh", "ShapeMaterial"}  # attributes of objects


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    """Return a job in coarse layers, parts for all families, and objects outside of that
    document."""
    folder = tmp_path_factory.mktemp("wrong")
    doc, other_document, closed = (
        App.newDocument(name) for name in ("Wrong", "Elsewhere", "Closed")
    )
    doc.UndoMode = 1
    foreign_box, gone = (
        other_document.addObject("Part::Box", "There"),
        doc.addObject("Part::Box", "Gone"),
    )
    doc.removeObject("Gone")
    App.closeDocument("Closed")
    box, pipe = doc.addObject("Part::Box", "Box"), doc.addObject("Part::Feature", "Pipe")
    pipe.Shape = Part.makeCylinder(20, 40)
    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(20, 20, 20)
    fin = doc.addObject("Part::Feature", "Fin")
    fin.Shape = Part.makeBox(20, 4, 20, App.Vector(15, -2, 10)).cut(pipe.Shape)
    tube = doc.addObject("Part::Feature", "Tube")
    tube.Shape = Part.makeCylinder(15, 20, App.Vector(0, 0, 40)).Faces[0]
    dome = sphere(doc)
    array = doc.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount, array.ShowElement = box, 3, False
    doc.recompute()
    Part.makeBox(20, 20, 20).exportStep(str(folder / "cup.step"))
    corners = [f"{x} {y} 10" for x in (0, 5, 10) for y in (0, 5, 10)]
    (folder / "points.xyz").write_text("\n".join(corners * 4) + "\n")
    with plans.share_plans():
        cell = api.make_cell(doc, limits="paper")
        feature = api.make_feature(doc, dome, layer_height=15, chord_error=0.5)
        toolpath = api.make_toolpath(doc, feature, cell)
        path = api.make_joint_path(doc, toolpath, cell)
        program = api.make_program(doc, path, name="CUP")
    api.export_cell(cell, str(folder / "cell.yaml"))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)  # the folder of relative paths
        yield SimpleNamespace(**locals())
    for name in (doc.Name, other_document.Name):
        App.closeDocument(name)


COARSE = {"layer_height": 10, "chord_error": 0.5}
RIGHT_ARGUMENTS = {  # valid arguments of each function, by name
    "array_element": lambda w: {"array": w.array, "index": 1},
    "change": lambda w: {
        "obj": w.feature,
        "source": w.dome,
        "axis": None,
        "faces": [],
        "fixtures": [],
        "layer_height": 12,
    },
    "export": lambda w: {"program": w.program, "folder": str(w.folder / "out")},
    "export_cell": lambda w: {"cell": w.cell, "path": str(w.folder / "made.yaml")},
    "export_joint_trajectory": lambda w: {"obj": w.path, "path": str(w.folder / "made.json")},
    "export_report": lambda w: {"obj": w.program, "path": str(w.folder / "made.html")},
    "export_waypoints": lambda w: {"obj": w.path, "path": str(w.folder / "made.csv")},
    "export_wires": lambda w: {"obj": w.path, "path": str(w.folder / "made.dxf"), "rapids": True},
    "inspect": lambda w: {
        "doc": w.doc,
        "planned": w.box,
        "file": str(w.folder / "points.xyz"),
        "label": "Look",
        "inspection": None,
        "tolerance": 1,
    },
    "issues": lambda w: {"obj": w.path},
    "make_all": lambda w: {
        "doc": w.doc,
        "source": w.box,
        "faces": (),
        "kind": "solid",
        "layers": "",
        "substrate": None,
        "further": (),
        "base_faces": (),
        "name": "",
        "machine": "",
        "cell": "",
        "post": "",
        "layer_height": "3 mm",
        "bead_spacing": "4 mm",
        "platform_diameter": "80 mm",
        "process": {"travel_speed": 10},
        "then": (),
        "mend": 0.0,
        "setup": "",
        "max_from_vertical": None,
        "layers_otherwise": "",
    },
    "make_cam_path": lambda w: {"obj": w.path},
    "make_cell": lambda w: {
        "doc": w.doc,
        "label": "Cell",
        "parameters": None,
        "machine": "kuka-kr16-2",
        "nozzle_length": 80,
        "deposition_point": (1000, 0, 700, 0, 90, 0),
        "branch": "front up noflip",
        "platform": 10,
        "external": "",
        "limits": "maker",
    },
    "make_cladding_feature": lambda w: {
        "doc": w.doc,
        "source": w.box,
        "faces": ["Face6"],
        "substrate": None,
        "label": "Feature",
        "fixtures": [],
        "strategy": None,
        "build_direction": None,
        "bead_spacing": 4,
        "layers": 1,
    },
    "make_curves_feature": lambda w: {
        "doc": w.doc,
        "source": w.box,
        "faces": ["Edge1"],
        "substrate": None,
        "label": "Feature",
        "fixtures": [],
        "strategy": None,
        "build_direction": None,
        "repeat": 2,
    },
    "make_developable_feature": lambda w: {
        "doc": w.doc,
        "source": w.fin,
        "substrate": w.pipe,
        "base_faces": ["Face1"],
        "label": "Feature",
        "faces": [],
        "further": [],
        "fixtures": [],
        "strategy": None,
        "build_direction": None,
        **COARSE,
    },
    "make_feature": lambda w: {
        "doc": w.doc,
        "source": w.dome,
        "faces": [],
        "label": "Feature",
        "axis": None,
        "fixtures": [],
        "strategy": None,
        "build_direction": None,
        "spacing": "arc-length",
        **COARSE,
    },
    "make_feature_of": lambda w: {
        "doc": w.doc,
        "kind": "revolution",
        "source": w.dome,
        "faces": [],
        "label": "Feature",
        "links": {"Fixtures": [w.box]},
        "parameters": [],
        "values": COARSE,
    },
    "make_joint_path": lambda w: {
        "doc": w.doc,
        "toolpath": w.toolpath,
        "cell": w.cell,
        "label": "Joint path",
        "joints": None,
        "method": "constant",
    },
    "make_program": lambda w: {
        "doc": w.doc,
        "joint_path": w.path,
        "label": "Program",
        "name": "CUP",
        "program": None,
        "post": "fanuc",
    },
    "make_scan": lambda w: {
        "doc": w.doc,
        "substrate": w.box,
        "file": str(w.folder / "points.xyz"),
        "label": "Scan",
        "fit": "auto",
        "unit": "auto",
        "pairs": "",
        "within": 5.0,
    },
    "make_solid_feature": lambda w: {
        "doc": w.doc,
        "source": w.box,
        "substrate": None,
        "label": "Feature",
        "further": [],
        "guide": None,
        "start_faces": (),
        "fixtures": [],
        "strategy": None,
        "build_direction": None,
        "layers": "planes",
        **COARSE,
    },
    "make_surface_feature": lambda w: {
        "doc": w.doc,
        "source": w.tube,
        "faces": ["Face1"],
        "substrate": w.pipe,
        "label": "Feature",
        "start_edges": [],
        "fixtures": [],
        "strategy": None,
        "build_direction": None,
        **COARSE,
    },
    "make_toolpath": lambda w: {
        "zones": [w.pipe],
        "doc": w.doc,
        "feature": w.feature,
        "cell": w.cell,
        "label": "Toolpath",
        "further": (),
        "sequence": "feature",
        "processes": (),
        "scan": None,
        "process": None,
        "fitting": None,
        "bead_width": 5,
    },
    "make_trajectory": lambda w: {"obj": w.path, "tolerance": 0.5, "turn": 2.0},
    "open_part": lambda w: {
        "doc": w.doc,
        "path": str(w.folder / "cup.step"),
        "object": "",
        "scale": 1.0,
    },
    "place": lambda w: {"path": w.toolpath, "cell": w.cell, "parameters": None, "x": 0},
    "proposed_name": lambda w: {"text": "A part"},
    "read_cell": lambda w: {"file": str(w.folder / "cell.yaml")},
    "recompute": lambda w: {"target": w.path, "force": False},
    "result": lambda w: {"obj": w.path},
    "stages_of": lambda w: {"doc": w.doc, "kind": "program"},
    "told_to": lambda w: {"listener": print, "findings": None},
}
WRONG_VALUES = {
    "none": lambda w: None,
    "text": lambda w: "Body",
    "empty": lambda w: "",
    "number": lambda w: 7,
    "below 0": lambda w: -1.5,
    "nan": lambda w: math.nan,
    "no list": lambda w: [],
    "numbers": lambda w: [1, 2],
    "texts": lambda w: ["Foo", "Face999"],
    "edge": lambda w: ["Edge999"],
    "mapping": lambda w: {"a": 1},
    "box": lambda w: w.box,
    "mesh": lambda w: w.mesh,
    "cell": lambda w: w.cell,
    "program": lambda w: w.program,
    "deleted": lambda w: w.gone,
    "elsewhere": lambda w: w.foreign_box,
    "document": lambda w: w.doc,
    "closed": lambda w: w.closed,
    "element": lambda w: (w.box, "Foo"),
    "vertex": lambda w: (w.box, ["Vertex1"]),
    "line": lambda w: (w.box, "Edge999"),
    "list of objects": lambda w: [w.box, w.gone],
    "class": lambda w: object,
    "bytes": lambda w: b"x",
    "true": lambda w: True,
    "path": lambda w: "/no/such/file.xyz",
    "huge": lambda w: 1e300,
    "nested": lambda w: [[w.box]],
    "surrogate": lambda w: "\ud800",
    "nul": lambda w: "a\0b",
}


def snapshot(doc):
    """Return all objects of a document with their properties, and its undo steps."""
    objects = [
        (
            obj.Name,
            [
                (name, repr(getattr(obj, name)))
                for name in sorted(obj.PropertiesList)
                if name not in NOT_COMPARED
            ],
        )
        for obj in doc.Objects
    ]
    return objects, doc.UndoCount, doc.HasPendingTransaction, App.getActiveTransaction()


def call(world, function, arguments):
    """Return the error that a function raises, of any kind. Return None if it succeeds, and undo
    its effect."""
    doc, original = world.doc, snapshot(world.doc)
    try:
        created = getattr(api, function)(**arguments)
        if function == "told_to":
            with created:
                pass
    except Exception as error:
        assert snapshot(doc) == original, f"something is left of what failed: {error!r}"
        return error
    while doc.UndoCount > original[1]:
        doc.undo()
    assert not doc.HasPendingTransaction and App.getActiveTransaction() is None
    assert [name for name, _ in snapshot(doc)[0]] == [name for name, _ in original[0]]
    return None


def test_every_function_is_tried(world):
    assert sorted(RIGHT_ARGUMENTS) == sorted(api.__all__)
    for function, right in RIGHT_ARGUMENTS.items():
        signature = inspect.signature(getattr(api, function)).parameters.values()
        assert {
            parameter.name for parameter in signature if parameter.kind != parameter.VAR_KEYWORD
        } <= right(world).keys(), function


@pytest.mark.parametrize("function", sorted(RIGHT_ARGUMENTS))
def test_right_arguments_serve(world, function):
    if function == "array_element" and App.Version()[:2] == ["1", "0"]:
        pytest.skip("FreeCAD 1.0 does not take back a new App::Link; see docs/compatibility.md")
    assert call(world, function, RIGHT_ARGUMENTS[function](world)) is None


@pytest.mark.parametrize(("axis", "code"), [
    (("pipe", "RootPoint"), "BAD_AXIS"), (("box", "Edge999"), "BAD_AXIS"), (("box", "Foo"), "BAD_AXIS"),
    (("box", "Face1"), "BAD_AXIS"), (("box", 7), "BAD_INPUT"), ("Body", "BAD_INPUT"),
])  # fmt: skip
def test_an_axis_that_is_not_there(world, axis, code):
    link = (getattr(world, axis[0]), axis[1]) if isinstance(axis, tuple) else axis
    error = call(world, "make_feature", {"doc": world.doc, "source": world.dome, "axis": link})
    assert (error.code, "xis" in error.where) == (code, True), error


def test_a_stage_is_not_made_from_what_follows_it(world):
    """FreeCAD accepted such a link and crashed."""
    for later in (world.toolpath, world.path, world.program, world.feature):
        for links in (
            {"source": later},
            {"fixtures": [world.box, later]},
            {"axis": (later, "Edge1")},
        ):
            error = call(world, "change", {"obj": world.feature, **links})
            assert error.code == "BAD_INPUT" and "is made from" in error.message


@pytest.mark.parametrize(
    "wrong",
    [{"kind": "revolve"}, {"process": {"travel_speed": -1}}, {"post": 7}, {"source": "Box"}],
)
def test_a_job_that_is_refused_leaves_nothing_where_no_undo_is_kept(world, wrong):
    """In documents of macros without a window, the cell once remained."""
    world.doc.UndoMode = 0
    try:
        assert call(world, "make_all", {**RIGHT_ARGUMENTS["make_all"](world), **wrong}) is not None
    finally:
        world.doc.UndoMode = 1


def test_parameters_of_another_family_are_not_passed_over(world):
    wrong = SolidParameters(layer_height=2)
    error = call(world, "make_feature", {"doc": world.doc, "source": world.dome, "strategy": wrong})
    assert error.code == "BAD_INPUT" and "RevolutionParameters" in error.message


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize(("key", "most"), [
    ("bead_width", "1e+09 mm"), ("travel_speed", "10000 mm/s"), ("overlap", "1e+09 mm"),
])  # fmt: skip
@pytest.mark.parametrize("number", [1e300, 2e9])
def test_an_absurd_number_is_refused_before_anything_is_computed_with_it(world, key, most, number):
    """The squares of a width of 1e300 mm overflowed in the collision search, and numpy warned."""
    error = call(world, "make_toolpath", {**RIGHT_ARGUMENTS["make_toolpath"](world), key: number})
    assert (error.code, error.where) == ("BAD_VALUE", f"process.{key}") and error.message.endswith(
        f"at most {most}"
    )


@pytest.mark.parametrize("function", sorted(RIGHT_ARGUMENTS))
def test_wrong_arguments_are_refused_by_an_error_of_ours(world, function, pytestconfig):
    random_source, bad = random.Random(f"{SEED} {function}"), []
    right = RIGHT_ARGUMENTS[function](world)
    for argument in right:
        kinds = sorted(WRONG_VALUES)
        for kind in kinds if pytestconfig.option.long else random_source.sample(kinds, SAMPLE_SIZE):
            value = WRONG_VALUES[kind](world)
            try:
                error = call(world, function, {**right, argument: value})
            except AssertionError as left:
                bad.append(f"{argument}={kind}: {left}"[:300])
                continue
            if error is not None and not isinstance(error, AmError):
                bad.append(f"{argument}={kind}: {type(error).__name__}: {error}"[:300])
            elif error is not None and not (error.code and error.where and error.message):
                bad.append(f"{argument}={kind}: nothing is told by {error!r}")
    assert bad == []
