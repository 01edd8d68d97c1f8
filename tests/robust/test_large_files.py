# SPDX-License-Identifier: LGPL-2.1-or-later
"""Huge files, devices and pipes in place of every file that jobs and documents name are rejected in
seconds, without using their size in memory."""

import os

import FreeCAD
import pytest

from freecad_am import api
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.objects import table_part
from freecad_am.objects.shapes import cell_obstacles
from tests.robust.test_damaged import assert_refused, refused

HUGE_FILE_BYTES = 5 << 30  # bytes of a sparse file: more than the commands may use of memory
ROBOT = "cell: {machine: abb-irb4600-40-255, setup: tool-on-robot"


def huge(path):
    with path.open("wb") as stream:
        stream.truncate(HUGE_FILE_BYTES)
    return path


@pytest.mark.parametrize("ending", ["step", "stl", "obj"])
def test_parts(workshop, ending):
    huge(workshop.folder / f"huge.{ending}")
    workshop.write_job(f"part: {{file: huge.{ending}}}\nstrategy: {{kind: solid}}\n")
    assert_refused(workshop, "plan", "cup.yaml", says="larger than 2000 MB")


@pytest.mark.parametrize("text", [
    "cell: {machine: huge.json}\n", ROBOT + ", obstacles: [{file: huge.step}]}\n",
    ROBOT + ", obstacles: [{file: huge.obj}]}\n",
    "cell: huge.yaml\n", "process: {material: ./huge.yaml}\n", "process: {bead_model: ./huge.csv}\n",
    "cell: {machine: {name: ur-ur10e, calibration: huge.yaml}}\n",
    "substrate: {file: cup.step, scan: huge.csv}\n",
], ids=["machine", "obstacle", "mesh as obstacle", "cell", "material", "beads", "calibration", "scan"])  # fmt: skip
def test_what_a_job_names(workshop, text):
    for ending in ("json", "step", "obj", "yaml", "csv"):
        huge(workshop.folder / f"huge.{ending}")
    workshop.write_job(
        f"part: {{file: cup.step}}\nstrategy: {{kind: solid, layer_height: 8 mm}}\n{text}"
    )
    assert_refused(workshop, "plan", "cup.yaml", says="larger than")


@pytest.mark.parametrize("ending", ["csv", "gcode", "ada3dp"])
def test_tables_of_points(tmp_path, ending):
    """The window and macros reject the file themselves, because they skip the check of names."""
    document = FreeCAD.newDocument("Table")
    try:
        os.mkfifo(tmp_path / f"pipe.{ending}")
        (tmp_path / f"zero.{ending}").symlink_to("/dev/zero")
        for path in (
            huge(tmp_path / f"huge.{ending}"),
            tmp_path / f"pipe.{ending}",
            tmp_path / f"zero.{ending}",
        ):
            assert refused(table_part.open_points, document, str(path)).code == "BAD_FILE"
    finally:
        FreeCAD.closeDocument(document.Name)


@pytest.mark.parametrize("name", ["huge.step", "pipe.step", "zero.step"])
def test_obstacles_of_a_document(tmp_path, name):
    """A foreign document may name any file, so the check for changes reads no more than its
    limit."""
    huge(tmp_path / "huge.step")
    os.mkfifo(tmp_path / "pipe.step")
    (tmp_path / "zero.step").symlink_to("/dev/zero")
    text = f"post = {tmp_path / name} at 0 0 0 0 0 0"
    settings = CellParameters(obstacles=text)
    assert refused(cell_obstacles.bodies_of, settings).where == "cell.obstacles post"
    if name == "huge.step":
        assert refused(cell_obstacles.hashes_of, settings).code == "BAD_FILE"
    else:
        assert cell_obstacles.hashes_of(settings) == []


@pytest.mark.parametrize("name", ["huge.json", "pipe.json", "zero.json"])
def test_machines_of_a_document(tmp_path, name):
    huge(tmp_path / "huge.json")
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "zero.json").symlink_to("/dev/zero")
    document = FreeCAD.newDocument("Cell")
    try:
        cell = api.make_cell(document)
        cell.Machine = str(tmp_path / name)
        error = refused(api.recompute, cell)
        assert name in f"{error.where} {error.message}" or error.where.endswith("Machine")
    finally:
        FreeCAD.closeDocument(document.Name)


def test_measured_points_of_a_document(tmp_path):
    document = FreeCAD.newDocument("Inspection")
    try:
        sphere = document.addObject("Part::Sphere", "Sphere")
        document.recompute()
        error = refused(api.inspect, document, sphere, str(huge(tmp_path / "huge.csv")))
        assert "larger than 1000 MB" in error.message
    finally:
        FreeCAD.closeDocument(document.Name)
