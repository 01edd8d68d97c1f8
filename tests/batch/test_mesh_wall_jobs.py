# SPDX-License-Identifier: LGPL-2.1-or-later
"""A vase from an STL file, open at both ends, becomes a toolpath and a document."""

import csv
import json

import Mesh
import numpy as np
import pytest

from freecad_am.batch.job import job as jobs

JOB = """\
part: {file: vase.stl}
strategy: {kind: surface, layer_height: 5 mm, chord_error: 0.1 mm}
process: {bead_width: 6 mm}
"""


def test_an_open_mesh_is_a_wall_on_the_platform(workshop):
    side = Mesh.createCone(20.0, 35.0, 40.0, 0, 4.0, 60)  # along X
    side.rotate(0.0, -np.pi / 2.0, 0.0)
    side.write(str(workshop.folder / "vase.stl"))
    (workshop.folder / "vase.yaml").write_text(JOB, encoding="utf-8")
    assert jobs.read_job(str(workshop.folder / "vase.yaml")).substrate is None
    command = workshop.run("plan", "vase.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "ok" and {"FIRST_LAYER"} <= {
        issue["code"] for issue in report["issues"]
    }
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    layer = np.array([int(row["layer"]) for row in rows])
    x, y, z = (np.array([float(row[f"{axis}_mm"]) for row in rows]) for axis in "xyz")
    low = float(side.BoundBox.ZMin)
    assert (z - low) / 40.0 * np.hypot(40.0, 15.0) == pytest.approx(5.0 * layer, abs=0.1)
    wide = (
        20.0 + 15.0 * (z - low) / 40.0
        if np.hypot(x, y)[layer == 0].mean() < 25.0
        else 35.0 - 15.0 * (z - low) / 40.0
    )
    assert np.hypot(x, y) == pytest.approx(wide, abs=0.5)
    assert layer.max() == 8
    (workshop.folder / "vase.yaml").write_text(
        JOB.replace("vase.stl}", "vase.stl, faces: [Face1]}"), encoding="utf-8"
    )
    refused = workshop.run("plan", "vase.yaml")
    assert (refused.status, refused.err.count("error[UNKNOWN_FACE]")) == (2, 1), refused.err
    (workshop.folder / "vase.yaml").write_text(
        JOB.replace("vase.stl}", "vase.stl, start_edges: [Edge9]}"), encoding="utf-8"
    )
    refused = workshop.run("plan", "vase.yaml")
    assert (refused.status, refused.err.count("error[UNKNOWN_EDGE]")) == (2, 1), refused.err


CELL = """\
cell: {machine: abb-irb4600-40-255, setup: tool-on-robot, deposition_point: [1500, 0, 700, 0, 0, 0],
  platform_diameter: 200 mm, branch: auto, mount: %s}
program: {post: none}
"""


def planned_at(workshop, low, mount):
    """Return status, messages, and for the deposit Z in the part (n,) and axes (n, 6), of a vase
    whose lower end is at Z = low."""
    side = Mesh.createCylinder(30.0, 60.0, 0, 4.0, 60)  # along X
    side.rotate(0.0, -np.pi / 2.0, 0.0)
    side.translate(0.0, 0.0, low - side.BoundBox.ZMin)
    side.write(str(workshop.folder / "vase.stl"))
    job = JOB.replace("height: 5 mm", "height: 30 mm") + CELL % mount
    (workshop.folder / "vase.yaml").write_text(job, encoding="utf-8")
    command = workshop.run("plan", "vase.yaml", "-o", "out", "--no-page")
    if command.status:
        return command.status, command.err, None, None
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    axes = np.array(
        [[float(row[key]) for key in row if key[0] == "q" and key.endswith("_deg")] for row in rows]
    )
    return command.status, command.err, np.array([float(row["z_mm"]) for row in rows]), axes


def test_an_open_mesh_drawn_at_another_height_than_the_platform_is_put_onto_it(workshop):
    """The planner puts the mesh onto the platform, because many open meshes are modelled about
    their middle or in the air. The robot moves as for a mesh that starts at zero."""
    status, messages, _, _ = planned_at(workshop, -90.8, "auto")
    assert (status, messages.count("error[OFF_PLATFORM]")) == (
        2,
        1,
    ) and "use mount: feature" in messages, messages
    _, _, height, axes = planned_at(workshop, 0.0, "auto")
    assert axes.shape[1] == 6 and height.min() == pytest.approx(0.0, abs=0.01)
    for low in (-90.8, 35.0):
        status, messages, z, q = planned_at(workshop, low, "feature")
        assert status == 0, messages
        assert z == pytest.approx(height + low, abs=1e-3) and q == pytest.approx(axes, abs=0.01)
