# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the benchmarks of `cell.arm_clearance` share: jobs carried out, places along what they write, and shapes of fcl."""

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
CLEARANCE = 10.0  # mm that are kept
BETWEEN = 10  # places looked at from one row to the next, the row's own among them


def carried_out(folder: Path, job: str) -> subprocess.CompletedProcess[str]:
    """What `plan` says of a job, which writes into the folder's `out`."""
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


def places(folder: Path) -> Array:
    """(k, axes) rad along a saved path, external axes after those of the robot: every row, and between it and the next."""
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
    shares = np.linspace(0.0, 1.0, BETWEEN, endpoint=False)[:, None, None]
    return np.asarray((joints[:-1] + shares * np.diff(joints, axis=0)).reshape(-1, joints.shape[1]))


def cylinder(fcl: Any, rod: Cylinder) -> tuple[Any, Array, Array]:
    """A rod as a cylinder of the library, and where it is in the frame of its link: its turn and its middle."""
    axis = (rod.end - rod.start) / rod.length
    one = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    one /= np.linalg.norm(one)
    turned = np.column_stack([one, np.cross(axis, one), axis])
    return fcl.Cylinder(rod.radius, rod.length), turned, 0.5 * (rod.start + rod.end)


def box_text(low: Sequence[float], size: Sequence[float]) -> str:
    """A box, its lower corner and its edges mm, as a text of STL."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size + low
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["solid box"]
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            points = [f"vertex {x:g} {y:g} {z:g}" for x, y, z in corners[list(triangle)]]
            lines += ["facet normal 0 0 0", "outer loop", *points, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid box", ""])


def is_path(done: subprocess.CompletedProcess[str], clearance: str) -> bool:
    """Whether a job gave the path asked for; one without a clearance may be infeasible because the arm is in something."""
    if not clearance and done.returncode == 3:
        return "error[ARM_COLLISION]" in done.stderr
    return done.returncode == 0
