# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines as a path of the CAM workbench (Path in FreeCAD 0.20), to be looked at, measured and animated there.

Positions are those of the nozzle's tip in part coordinates. Directions are left out: CAM takes A, B and C for rotary axes
and would wind the path about them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import neighbour
from .lines import Line

ON, OFF = "(deposit on)", "(deposit off)"


def add(document: Any, lines: Sequence[Line], label: str) -> Any:
    """A Path::Feature of the document; InputError NO_MODULE where this FreeCAD has no CAM."""
    try:
        import Path
    except ImportError:
        raise neighbour.lacking("CAM path", "CAM (Path)", "write STEP or DXF") from None
    obj = neighbour.added(document, "Path::Feature", "AmPath", label)
    obj.Path = Path.Path([Path.Command(name, words) for name, words in commands(lines)])
    obj.purgeTouched()  # nothing is left to recompute, which the tree would ask for
    return obj


def commands(lines: Sequence[Line]) -> list[tuple[str, dict[str, float]]]:
    """Names and words: G0 to the first point and along rapid moves, G1 along beads; F in mm/s as FreeCAD keeps it."""
    found: list[tuple[str, dict[str, float]]] = []
    place: list[float] | None = None
    for line in lines:
        points = line.points.tolist()
        if points[0] != place:
            found.append(("G0", _xyz(points[0])))
        place = points[-1]
        if line.deposit:
            found.append((f"({line.name})", {}))
            found.append((ON, {}))
            speeds = line.speed[1:].tolist()
            found += [
                ("G1", {**_xyz(at), "F": speed})
                for at, speed in zip(points[1:], speeds, strict=True)
            ]
            found.append((OFF, {}))
        else:
            found += [("G0", _xyz(at)) for at in points[1:]]
    return found


def _xyz(point: list[float]) -> dict[str, float]:
    return {"X": point[0], "Y": point[1], "Z": point[2]}
