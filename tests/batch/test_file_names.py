# SPDX-License-Identifier: LGPL-2.1-or-later
"""File names in a job and in a cell become absolute when they are read; the other values stay
unchanged."""

import copy

import pytest

from freecad_am.sections import paths

FOLDER = "/jobs"


def test_names_of_files_of_every_feature_are_absolute():
    feature = {
        "part": {"file": "a.step"},
        "substrate": {"file": "../b.step", "scan": "c.csv"},
        "fixtures": [{"file": "/d.stl"}, {}],
        "strategy": {"guide": {"file": "e.step"}},
        "process": {"bead_model": "own.csv", "material": "nowhere"},
    }
    expected = {
        "part": {"file": "/jobs/a.step"},
        "substrate": {"file": "/b.step", "scan": "/jobs/c.csv"},
        "fixtures": [{"file": "/d.stl"}, {}],
        "strategy": {"guide": {"file": "/jobs/e.step"}},
        "process": {"bead_model": "/jobs/own.csv", "material": "nowhere"},
    }
    values = {**feature, "features": [feature, {"name": "top"}], "name": "cup.step"}
    original = copy.deepcopy(values)
    assert paths.resolve_job(values, FOLDER) == {
        **expected,
        "features": [expected, {"name": "top"}],
        "name": "cup.step",
    }
    assert values == original


@pytest.mark.parametrize(
    "values",
    [
        {"part": "a.step"},
        {"part": {"file": 3}},
        {"part": {"file": " "}},
        {"fixtures": {"file": "a.step"}},
        {"part": None},
        {"process": {"bead_model": "csw", "material": {"name": "wire"}}},
        {"process": {"bead_model": "none"}},
        {"strategy": {"guide": "auto"}},
        {"features": "all"},
        {"features": [1]},
        {"substrate": []},
    ],
)
def test_what_names_no_file_stays(values):
    assert paths.resolve_job(values, FOLDER) == values


def test_a_material_in_the_folder_of_the_job_comes_before_those_built_in(tmp_path):
    (tmp_path / "er70s-6").write_text("")
    resolved = paths.resolve_job({"process": {"material": "er70s-6"}}, str(tmp_path))
    assert resolved == {"process": {"material": str(tmp_path / "er70s-6")}}


@pytest.mark.parametrize(
    "machine, wanted",
    [
        ("fanuc-arcmate120ic", "fanuc-arcmate120ic"),
        ("mine.json", "/jobs/mine.json"),
        ("robots/mine", "/jobs/robots/mine"),
        ("robot.urdf base=base_link", "/jobs/robot.urdf base=base_link"),
        ("ur-ur10e calibration=my.yaml", "ur-ur10e calibration=/jobs/my.yaml"),
        ({"file": "robot.urdf", "tip": "tool0"}, {"file": "/jobs/robot.urdf", "tip": "tool0"}),
        (
            {"file": "robot.urdf base=arm"},
            {"file": "robot.urdf base=arm"},
        ),  # the value is rejected, and the error quotes it as written
        (
            {"name": "mine.json", "calibration": "my.yaml"},
            {"name": "/jobs/mine.json", "calibration": "/jobs/my.yaml"},
        ),
    ],
)
def test_machines_of_a_cell(machine, wanted):
    assert paths.resolve_cell({"machine": machine, "external": [{"machine": machine}]}, FOLDER) == {
        "machine": wanted,
        "external": [{"machine": wanted}],
    }


def test_other_files_of_a_cell():
    assert paths.resolve_cell(" hall.yaml ", FOLDER) == "/jobs/hall.yaml"
    section = {
        "obstacles": [{"file": "table.step"}, {"box": [1, 2, 3]}],
        "nozzle": {"shape": {"file": "torch.stl"}},
    }
    assert paths.resolve_cell(section, FOLDER) == {
        "obstacles": [{"file": "/jobs/table.step"}, {"box": [1, 2, 3]}],
        "nozzle": {"shape": {"file": "/jobs/torch.stl"}},
    }
    for shape in ("none", 3, None):
        assert paths.resolve_cell({"nozzle": {"shape": shape}}, FOLDER) == {
            "nozzle": {"shape": shape}
        }
