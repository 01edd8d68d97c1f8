# SPDX-License-Identifier: LGPL-2.1-or-later
"""The files and commands of the page *Headless and batch* work as printed."""

import csv
import io
import math
import os
import re
import shutil
import subprocess

import pytest

from tests.window import private_home

TIMEOUT_S = 300  # s


@pytest.fixture(scope="module")
def page(root):
    return (root / "docs" / "headless.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def folder(page, root, tmp_path_factory):
    """Return a folder with the files of the page, in which the model was made."""
    host = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if host is None:
        pytest.skip("this FreeCAD has no freecadcmd")
    folder = tmp_path_factory.mktemp("headless")
    names = {"make_cup.py", "cup.yaml", "plan_cup.py", "cups.csv"}
    for fence in re.findall(r"```(?:python|yaml|csv)\n(.*?)```", page, re.DOTALL):
        text_before = page[: page.index(fence)]
        name = [word for word in re.findall(r"`([\w-]+\.\w+)`", text_before) if word in names][-1]
        (folder / name).write_text(fence, encoding="utf-8")
    assert {path.name for path in folder.iterdir()} == names
    return folder


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    return private_home(tmp_path_factory.mktemp("home"))


def run(folder, environment, *command):
    return subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )


def freecadcmd(folder, environment, script):
    host = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    return run(folder, environment, host, script)


@pytest.fixture(scope="module")
def model(folder, environment):
    process = freecadcmd(folder, environment, "make_cup.py")
    assert (folder / "cup.FCStd").is_file(), process.stdout + process.stderr
    return folder


def launch(root, folder, *words):
    return run(folder, dict(os.environ), root / "freecad-am", *words)


def test_the_commands_are_those_run_here(page):
    commands = re.findall(r"```sh\n(.*?)\n```", page, re.DOTALL)
    assert commands == [
        "freecadcmd make_cup.py",
        "./freecad-am plan cup.yaml -o out/cup",
        "freecadcmd plan_cup.py",
        "./freecad-am batch cups.csv --job cup.yaml -o out/cups -j 2",
    ]


def test_the_script_has_about_twenty_lines(model):
    assert len((model / "plan_cup.py").read_text(encoding="utf-8").splitlines()) <= 20


def test_the_job_file(root, model):
    process = launch(root, model, "plan", "cup.yaml", "-o", "out/cup")
    assert process.returncode == 0, process.stderr
    assert (model / "out" / "cup" / "program" / "CUP.LS").is_file()


def test_the_script(model, environment):
    process = freecadcmd(model, environment, "plan_cup.py")
    assert "written: " in process.stdout, process.stdout + process.stderr
    assert (model / "out" / "CUP.LS").is_file() and (model / "planned.FCStd").is_file()


def test_the_table(root, model):
    original = (model / "cup.FCStd").read_bytes()
    process = launch(
        root, model, "batch", "cups.csv", "--job", "cup.yaml", "-o", "out/cups", "-j", "2"
    )
    assert process.returncode == 0, process.stderr
    low, wide = csv.DictReader(io.StringIO(process.stdout))
    for row, radius, height in ((low, 45.0, 30.0), (wide, 55.0, 60.0)):
        layers = int(height / 5.0) + 1
        assert int(row["layers"]) == layers
        circumferences = layers * 2.0 * math.pi * radius
        assert float(row["length_mm"]) == pytest.approx(circumferences, rel=1e-3)
    assert (model / "cup.FCStd").read_bytes() == original


@pytest.mark.parametrize(
    ("column", "value", "radius", "height"),
    [
        ("part.set.Sizes.radius", "50", 50.0, 60.0),
        ("part.set.Sizes.A1", "5 cm", 50.0, 60.0),
        ("part.set.Profile.Constraints.radius", "50 mm", 50.0, 60.0),  # an expression sets it
        ("part.set.Profile.Constraints.height", "40", 45.0, 40.0),
    ],
)
def test_other_ways_to_set_a_value(root, model, column, value, radius, height):
    (model / "row.csv").write_text(f"{column}\n{value}\n", encoding="utf-8")
    process = launch(root, model, "batch", "row.csv", "--job", "cup.yaml", "-o", "out/row")
    assert process.returncode == 0, process.stderr
    (row,) = csv.DictReader(io.StringIO(process.stdout))
    expected = (int(height / 5.0) + 1) * 2.0 * math.pi * radius
    assert float(row["length_mm"]) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("part.set.Sizes.radius", "50 kg", "'50 kg' does not fit"),
        ("part.set.Sizes.radius", "5,5 mm", "'5,5 mm' does not fit"),
        ("part.set.Sizes.B7", "5 mm", "cell B7 of Sizes is empty"),
        ("part.set.Sizes.width", "5 mm", "alias or address 'width'"),
        ("part.set.Profile.Constraints.depth", "5 mm", "only radius, height"),
        ("part.set.Profile.Constraints.height", "5 deg", "'5 deg' does not fit"),
    ],
)
def test_values_that_cannot_be_set(root, model, column, value, message):
    (model / "bad.csv").write_text(f'{column}\n"{value}"\n', encoding="utf-8")
    process = launch(root, model, "batch", "bad.csv", "--job", "cup.yaml", "-o", "out/bad")
    assert process.returncode == 2
    assert message in process.stderr and f"{column}: " in process.stderr
