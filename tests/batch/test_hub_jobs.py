# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of solids on hubs: keys and refusals. test_thruster.py plans the thruster."""

import csv
import math

import FreeCAD
import Mesh
import numpy as np
import Part
import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.filled import DevelopableParameters

START = """\
part: {file: blades.step}
substrate: {file: hub.step, faces: [Face2]}
strategy:
  kind: developable
"""


@pytest.fixture
def read(tmp_path):
    for name in ("blades.step", "hub.step", "blades.stl"):
        (tmp_path / name).write_text("")
    (tmp_path / "beads.csv").write_text(
        "radius_mm,wire_feed_m_min,travel_speed_mm_min,width_mm,height_mm\n"
        "30,6.5,300,12.5,3.4\n30,6.5,600,9.9,2.7\n50,6.5,300,12.4,3.3\n50,6.5,900,8.3,2.4\n"
    )

    def read_text(text):
        path = tmp_path / "job.yaml"
        path.write_text(text, encoding="utf-8")
        return jobs.read_job(str(path))

    return read_text


def test_the_base_in_its_forms(read):
    filled = read(
        START + "  fill: gyroid\n  fill_density: 20 %\n  walls: inf\n  solid_layers: 3\n"
    ).strategy
    assert (filled.fill, filled.fill_density, filled.walls, filled.solid_layers) == (
        "gyroid",
        0.2,
        "inf",
        3,
    )
    with pytest.raises(
        InputError, match="fill_density: 0 % is out of range; give at least 1 % and at most 100 %"
    ):
        read(START + "  fill_density: 0 %\n")
    assert (
        read(START).strategy == DevelopableParameters() == read(START + "  base: auto\n").strategy
    )
    job = read(
        START + "  base: {radius: 6 cm, height: 200 mm, axis: [[0, 1 cm, 280], [0, 0, 1]]}\n"
    )
    assert (job.strategy.base.radius, job.strategy.base.height) == (60.0, 200.0)
    assert job.strategy.base.axis == ((0.0, 10.0, 280.0), (0.0, 0.0, 1.0))
    assert read(START + "  base: {radius: 60 mm, height: inf}\n").strategy.base.height == "inf"
    assert job.substrate.faces == ("Face2",)
    assert (
        read(START.replace("substrate: {file: hub.step, faces: [Face2]}\n", "")).substrate is None
    )


@pytest.mark.parametrize(
    ("more", "code", "where"),
    [
        ("  base: {radius: 0 mm}\n", "BAD_VALUE", "strategy.base.radius"),
        ("  base: {radius: -60 mm}\n", "BAD_VALUE", "strategy.base.radius"),
        ("  base: {radius: 60 mm, height: 0}\n", "BAD_VALUE", "strategy.base.height"),
        ("  base: {height: 200 mm}\n", "BAD_VALUE", "strategy.base.radius"),
        (
            "  base: {radius: 60 mm, axis: [[0, 0, 0], [0, 0, 0]]}\n",
            "BAD_VALUE",
            "strategy.base.axis",
        ),
        ("  base: {radius: 60 mm, axis: [[0, 0, 0], [0, 0]]}\n", "BAD_VALUE", "strategy.base.axis"),
        (
            "  base: {radius: 60 mm, axis: [[0, 0, 1 deg], [0, 0, 1]]}\n",
            "BAD_UNIT",
            "strategy.base.axis",
        ),
        ("  base: cone\n", "BAD_VALUE", "strategy.base"),
        ("  bead_spacing: 0 mm\n", "BAD_VALUE", "strategy.bead_spacing"),
        ("  fill: hatch\n", "BAD_VALUE", "strategy.fill"),
        ("  margin: -1 mm\n", "BAD_VALUE", "strategy.margin"),
        ("  order: random\n", "BAD_VALUE", "strategy.order"),
        ("build_direction: {mode: fixed}\n", "NOT_FOR_FAMILY", "build_direction.mode"),
        ("process: {bead_model: mine.csv}\n", "NO_FILE", "mine.csv"),
        ("process: {bead_model: hub.step}\n", "BAD_TABLE", "hub.step"),
        ("process: {acceleration: 0}\n", "BAD_VALUE", "process.acceleration"),
    ],
)
def test_what_is_refused(read, more, code, where):
    with pytest.raises(InputError) as caught:
        read(START + more)
    assert caught.value.code == code and where in caught.value.where, caught.value.line()


@pytest.mark.parametrize(
    ("process", "counts"),
    [
        ("", "auto"),
        ("process: {bead_width: 8 mm}\n", "bead_width"),
        ("process: {bead_width: 10 mm}\n", "bead_width"),
        ("process: {bead_width: 8 mm, fill_width: spacing}\n", "spacing"),
    ],
)
def test_a_bead_width_that_is_given_is_meant(read, process, counts):
    assert read(START + process).process.fill_width == counts


def test_the_calibration_table_is_beside_the_job(read, tmp_path):
    assert read(START + "process: {bead_model: beads.csv}\n").process.bead_model == str(
        tmp_path / "beads.csv"
    )
    assert read(START + "process: {bead_model: csw}\n").process.bead_model == "csw"


MESH = """\
part: {file: blade.stl}
strategy:
  kind: developable
  base: {radius: 30 mm, height: 120 mm, axis: [[0, 0, 50], [0, 0, 1]]}
  layer_height: 5 mm
  chord_error: 0.1 mm
"""


def test_a_mesh_on_a_base_given_by_numbers(workshop):
    bar = Part.makeBox(60.0, 14.0, 30.0, FreeCAD.Vector(0, -7, 60))
    points, facets = bar.tessellate(0.1)
    Mesh.Mesh([[points[k] for k in facet] for facet in facets]).write(
        str(workshop.folder / "blade.stl")
    )
    (workshop.folder / "blade.yaml").write_text(MESH, encoding="utf-8")
    command = workshop.run("plan", "blade.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    x, y, z, layer = (
        np.array([float(row[name]) for row in rows]) for name in ("x_mm", "y_mm", "z_mm", "layer")
    )
    a = math.atan2(30.0, 120.0)
    assert (
        np.abs((np.hypot(x, y) - 30.0) * math.cos(a) + (z - 50.0) * math.sin(a) - 5.0 * layer).max()
        < 1e-5
    )
    assert np.abs(y).max() < 7.0 and z.min() > 60.0 and z.max() < 90.0
    revolution_job = MESH.replace("developable", "revolution").split("  base")[0]
    (workshop.folder / "blade.yaml").write_text(revolution_job, encoding="utf-8")
    refused = workshop.run("plan", "blade.yaml")
    assert (refused.status, refused.err.count("error[UNSUPPORTED_FILE]")) == (2, 1), refused.err


@pytest.mark.parametrize(
    ("ending", "scale", "factor"),
    [("stl", "1 in", 25.4), ("obj", "10", 10.0), ("stl", "1 m", 1000.0)],
)
@pytest.mark.always("obj-10-10.0")
def test_a_mesh_in_another_unit_is_scaled(workshop, ending, scale, factor):
    bar = Part.makeBox(60.0, 14.0, 30.0, FreeCAD.Vector(0, -7, 60))
    points, facets = bar.tessellate(0.1)

    def deposited(unit, expected_note):
        mesh = Mesh.Mesh([[points[k] for k in facet] for facet in facets])
        mesh.transform(FreeCAD.Matrix(*(np.diag([1.0, 1.0, 1.0, unit]) / unit).ravel()))
        mesh.write(str(workshop.folder / f"blade.{ending}"))
        (workshop.folder / "blade.yaml").write_text(
            MESH.replace("blade.stl", f"blade.{ending}{expected_note}"), encoding="utf-8"
        )
        command = workshop.run("plan", "blade.yaml", "-o", "out", "--no-page")
        assert command.status == 0, command.err
        with open(
            workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline=""
        ) as stream:
            return np.array(
                [
                    [float(row[name]) for name in ("x_mm", "y_mm", "z_mm")]
                    for row in csv.DictReader(stream)
                ]
            )

    np.testing.assert_allclose(
        deposited(factor, f", scale: {scale}"), deposited(1.0, ""), atol=2e-3
    )
    deposited(factor, f", scale: {scale}")
    document = FreeCAD.openDocument(str(workshop.folder / "out" / "blade.FCStd"))
    try:
        (mesh_object,) = document.findObjects("Mesh::Feature")
        assert (
            mesh_object.FileScale.Value == factor
            and mesh_object.Mesh.BoundBox.XMax == pytest.approx(60.0, rel=1e-6)
        )
    finally:
        FreeCAD.closeDocument(document.Name)


@pytest.mark.parametrize(
    ("part", "code", "told"),
    [
        ("{file: blades.step, scale: 25.4}", "BAD_VALUE", "states a unit"),
        ("{file: blades.stl, scale: 0 mm}", "BAD_VALUE", "0 mm is not a unit"),
        ("{file: blades.stl, scale: inf}", "BAD_VALUE", "inf mm is not a unit"),
        ("{file: blades.stl, scale: 90 deg}", "BAD_UNIT", "an angle"),
        ("{file: blades.stl, scale: inch}", "BAD_UNIT", "inch"),
    ],
)
def test_scales_that_are_refused(read, part, code, told):
    with pytest.raises(InputError) as caught:
        read(START.replace("{file: blades.step}", part))
    assert (caught.value.code, "part.scale" in caught.value.where) == (
        code,
        True,
    ) and told in caught.value.message
    assert (
        read(START.replace("{file: blades.step}", "{file: blades.stl, scale: 1/2 in}")).part.scale
        == 12.7
    )
