# SPDX-License-Identifier: LGPL-2.1-or-later
"""3MF files as part, hub and fixture of a job."""

import csv
import math

import FreeCAD
import Mesh
import numpy as np
import Part

JOB = """\
part: {file: blades.3mf}
substrate: {file: hub.3mf}
strategy:
  kind: developable
  base: {radius: 30 mm, height: inf, axis: [[0, 0, 0], [0, 0, 1]]}
  layer_height: 10 mm
  chord_error: 0.1 mm
"""


def mesh(shape):
    points, facets = shape.tessellate(0.05)
    return Mesh.Mesh([[points[k] for k in facet] for facet in facets])


def test_blades_and_hub_of_3mf_files(workshop):
    blades = mesh(Part.makeBox(59.0, 14.0, 30.0, FreeCAD.Vector(0, -7, 60)))
    blades.addMesh(mesh(Part.makeBox(59.0, 14.0, 30.0, FreeCAD.Vector(-59, -7, 20))))
    blades.write(Filename=str(workshop.folder / "blades.3mf"), Format="3MF")
    mesh(Part.makeCylinder(30.0, 120.0)).write(
        Filename=str(workshop.folder / "hub.3mf"), Format="3MF"
    )
    (workshop.folder / "hub.yaml").write_text(JOB, encoding="utf-8")
    command = workshop.run("plan", "hub.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    x, y, z = (np.array([float(row[name]) for row in rows]) for name in ("x_mm", "y_mm", "z_mm"))
    heights = np.hypot(x, y) - 30.0
    assert np.abs(heights - 10.0 * np.rint(heights / 10.0)).max() < 1e-5
    assert set(np.rint(heights / 10.0).astype(int)) == {0, 1, 2} and np.abs(y).max() < 7.0
    assert (
        60.0 < z[x > 0].min() < z[x > 0].max() < 90.0
        and 20.0 < z[x < 0].min() < z[x < 0].max() < 50.0
    )
    assert math.isclose(x.max(), -x.min(), abs_tol=0.5)
    (workshop.folder / "blades.3mf").write_bytes(b"PK")
    command = workshop.run("plan", "hub.yaml", "-o", "out")
    assert (
        command.status == 2
        and command.err.count("error[BAD_FILE]") == 1
        and "blades.3mf" in command.err
    )
