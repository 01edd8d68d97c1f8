# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shared by the benchmarks of `cell.arm_clearance`: run a job, sample its saved path, and build
shapes for python-fcl."""

from __future__ import annotations

import csv
import os
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from freecad_am.core.geometry.cylinders import Cylinder
from freecad_am.core.types import Array

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "resources" / "examples" / "hemisphere.step"
CLEARANCE = 10.0  # mm of clearance
SAMPLES_PER_ROW = 10  # samples from one row to the next, including the row


def run_plan(folder: Path, job: str) -> subprocess.CompletedProcess[str]:
    """Run `plan` on a job that writes into the folder's `out`."""
    (folder / "arm.yaml").write_text(job, encoding="utf-8")
    command = [
        str(ROOT / "freecad-am"),
        "plan",
        str(folder / "arm.yaml"),
        "-o",
        str(folder / "out"),
        "--no-page",
    ]
    environment = {
        name: value
        for name, value in os.environ.items()
        if name not in ("BENCH_INSIDE", "VIRTUAL_ENV")
    }
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def sample_joints(folder: Path) -> Array:
    """Return joint positions (k, axes) in rad along a saved path, external axes after the robot's:
    every row and samples between rows."""
    with open(folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as file:
        rows = [
            [
                float(value)
                for name, value in row.items()
                if name[0] in "qe" and name.endswith("_deg")
            ]
            for row in csv.DictReader(file)
        ]
    joints = np.radians(rows)
    shares = np.linspace(0.0, 1.0, SAMPLES_PER_ROW, endpoint=False)[:, None, None]
    return np.asarray((joints[:-1] + shares * np.diff(joints, axis=0)).reshape(-1, joints.shape[1]))


def cylinder(fcl: Any, rod: Cylinder) -> tuple[Any, Array, Array]:
    """Convert a capsule to a cylinder of the library with its rotation and centre in the frame of
    its link."""
    axis = (rod.end - rod.start) / rod.length
    normal = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    normal /= np.linalg.norm(normal)
    rotation = np.column_stack([normal, np.cross(axis, normal), axis])
    return fcl.Cylinder(rod.radius, rod.length), rotation, 0.5 * (rod.start + rod.end)


def box_text(low: Sequence[float], size: Sequence[float]) -> str:
    """Return a box, given by its lower corner and edge lengths (mm), as STL text."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size + low
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["solid box"]
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            points = [f"vertex {x:g} {y:g} {z:g}" for x, y, z in corners[list(triangle)]]
            lines += ["facet normal 0 0 0", "outer loop", *points, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid box", ""])


def is_path(process: subprocess.CompletedProcess[str], clearance: str) -> bool:
    """Return whether a job gave the requested path; without a clearance an arm collision may make
    it infeasible."""
    if not clearance and process.returncode == 3:
        return "error[ARM_COLLISION]" in process.stderr
    return process.returncode == 0
