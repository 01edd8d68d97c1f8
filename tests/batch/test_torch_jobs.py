# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.nozzle.shape` in a job file: the torch from the file keeps clear, invalid files are
rejected, and a document notices changes of the file."""

import json

import FreeCAD
import Mesh
import Part
import pytest

from freecad_am import api, interop
from freecad_am.sections import cell as job_cell

CELL = """\
cell:
  setup: tool-on-robot
  deposition_point: [1000, 0, -100, 0, 0, 0]
  nozzle: {shape: {file: torch.step}, half_angle: 30 deg, diameter: 10 mm, length: 60 mm, tool: [120, 0, 200, 0, 45, 0]}
  platform_diameter: 100 mm
  branch: [front, down, noflip]
"""


def torch(*boxes):
    """Return boxes (low corner, size) as one shape."""
    return Part.Compound([Part.makeBox(*size, FreeCAD.Vector(*low)) for low, size in boxes])


NECK = ((-6.0, -6.0, -100.0), (12.0, 12.0, 85.0))
CAMERA = ((0.0, -15.0, -100.0), (120.0, 30.0, 25.0))


@pytest.fixture
def shop(workshop):
    workshop.write_job(
        workshop.text.replace("cell:\n  limits: paper\n  platform_diameter: 100 mm\n", CELL)
        .replace("layer_height: 4 mm", "layer_height: 15 mm")
        .replace("cell:", "build_direction: {mode: fixed}\ncell:")
    )
    torch(NECK, CAMERA).exportStep(str(workshop.folder / "torch.step"))
    return workshop


def test_a_job_with_a_torch(shop):
    command = shop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    shop.write_job(shop.job.read_text().replace("  branch:", "  arm_clearance: 10 mm\n  branch:"))
    command = shop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    # a wide shield is always near the platform on which it deposits
    torch(
        NECK,
        ((-400.0, -400.0, -95.0), (800.0, 800.0, 20.0)),
        ((-400.0, -400.0, -95.0), (20.0, 800.0, 100.0)),
    ).exportStep(str(shop.folder / "torch.step"))
    command = shop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 2 and "extends 5 mm beyond its origin" in command.err, command.err
    torch(
        NECK,
        ((-400.0, -400.0, -95.0), (800.0, 800.0, 20.0)),
        ((-400.0, -400.0, -75.0), (20.0, 800.0, 20.0)),
    ).exportStep(str(shop.folder / "torch.step"))
    shop.write_job(shop.job.read_text().replace("60 mm", "40 mm"))
    command = shop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 3, command.err
    issues = json.loads((shop.folder / "out" / "report.json").read_text())["issues"]
    messages = [issue["message"] for issue in issues if issue["code"] == "ARM_CLEARANCE"]
    assert any(
        message.startswith("the torch comes closer than 10 mm to ") or " to torch" in message
        for message in messages
    )


@pytest.mark.parametrize(
    ("shape", "says"),
    [
        ("none.step", "error[NO_FILE] cup.yaml: cell.nozzle.shape: file "),
        ("{file: none.step}", "error[NO_FILE] cup.yaml: cell.nozzle.shape.file: file "),
        ("{path: torch.step}", "error[UNKNOWN_KEY] cup.yaml: cell.nozzle.shape.path"),
        ("cup.yaml", "error[UNSUPPORTED_FILE] cup.yaml: cell.nozzle.shape"),
        ("open.stl", "error[TORCH] cup.yaml: cell.nozzle.shape: the shape is open"),
        (
            "far.step",
            "error[TORCH] cup.yaml: cell.nozzle.shape: the torch is 200 mm away from its origin",
        ),
        ("[1]", "error[BAD_VALUE] cup.yaml: cell.nozzle.shape"),
    ],
)
def test_what_is_refused(shop, shape, says):
    sides = Mesh.createBox(10.0, 10.0, 40.0)
    sides.removeFacets([0])
    sides.translate(0.0, 0.0, -40.0)
    sides.write(str(shop.folder / "open.stl"))
    torch(((-6.0, -6.0, -300.0), (12.0, 12.0, 100.0))).exportStep(str(shop.folder / "far.step"))
    shop.write_job(shop.job.read_text().replace("shape: {file: torch.step}", f"shape: {shape}"))
    command = shop.run("plan", "cup.yaml", "-o", "out")
    assert command.status == 2 and command.err.startswith(says), command.err
    assert not (shop.folder / "out").exists()


def test_a_document_notices_and_a_saved_cell_keeps_it(shop, doc):
    cell = api.make_cell(
        doc, nozzle_shape=str(shop.folder / "torch.step"), nozzle_half_angle=30, nozzle_diameter=10
    )
    assert cell.Status == "up to date", cell.Message
    torch(((-6.0, -6.0, -300.0), (12.0, 12.0, 100.0))).exportStep(str(shop.folder / "torch.step"))
    cell.touch()
    doc.recompute()
    assert cell.Status == "failed" and "200 mm away from its origin" in cell.Message
    torch(NECK).exportStep(str(shop.folder / "torch.step"))
    cell.touch()
    doc.recompute()
    assert cell.Status == "up to date", cell.Message
    path = api.export_cell(cell, str(shop.folder / "hall.yaml"))
    written = (shop.folder / "hall.yaml").read_text(encoding="utf-8")
    assert path == str(shop.folder / "hall.yaml") and 'shape: "torch.step"' in written
    read_cell = job_cell.read("hall.yaml", str(shop.folder))
    assert read_cell.nozzle.shape.file == str(shop.folder / "torch.step")
    assert interop.cell_text(read_cell, str(shop.folder)) == written
