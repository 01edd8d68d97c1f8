# SPDX-License-Identifier: LGPL-2.1-or-later
"""A bent pipe to be filled in layers along its centre line, and a table of points to be laid as beads: a rosette."""

from __future__ import annotations

from typing import Any

import numpy as np
import step_files
from FreeCAD import Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

RADIUS, BORE, BEND, STRAIGHT = 14.0, 8.0, 45.0, 12.0  # mm: outside, inside, of the bend, before it
TURN = 60.0  # deg
ROSE, DEPTH, LEAVES, RING, POINTS = 34.0, 5.0, 6, 18.0, 144  # mm, and how many


def pipe_bend() -> Any:
    """A pipe that goes up, and round by 60 deg."""
    found = []
    for radius in (RADIUS, BORE):
        circle = Part.Face(Part.Wire(Part.makeCircle(radius)))
        straight = circle.extrude(Vector(0, 0, STRAIGHT))
        circle.translate(Vector(0, 0, STRAIGHT))
        found.append(
            straight.fuse(
                circle.revolve(Vector(BEND, 0, STRAIGHT), Vector(0, 1, 0), TURN)
            ).removeSplitter()
        )
    return found[0].cut(found[1]).Solids[0]


def rosette() -> str:
    """Two closed beads, a rose and the ring inside of it, as a table of points with the bead of each."""
    angle = np.linspace(0.0, 2.0 * np.pi, POINTS + 1)
    angle[-1] = 0.0
    lines = ["x,y,z,bead"]
    for bead, radius in (
        (1, ROSE + DEPTH * np.cos(LEAVES * angle)),
        (2, np.full(POINTS + 1, RING)),
    ):
        for x, y in np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1) + 0.0:
            lines.append(f"{x:.4f},{y:.4f},0,{bead}")
    return "\n".join(lines) + "\n"


def write_rosette() -> None:
    """The table beside the jobs."""
    (step_files.HERE / "rosette.csv").write_text(rosette(), encoding="utf-8")
