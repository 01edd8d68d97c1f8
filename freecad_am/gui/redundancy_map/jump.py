# SPDX-License-Identifier: LGPL-2.1-or-later
"""Takes an open simulation, and the path in the 3D view, to a point of the map."""

from __future__ import annotations

from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ..path import dock as path_dock
from ..path.path_view import PathView
from ..simulation import dock as simulation_dock


def jump(obj: Any, layer: int, position: Array) -> bool:
    """To the point of a layer of a joint path that is nearest to a position (3,), mm; whether anything followed."""
    simulated, shown = _simulation(obj, layer, position), _path(obj, layer, position)
    return simulated or shown


def _simulation(obj: Any, layer: int, position: Array) -> bool:
    for running in list(simulation_dock._open):
        motion = running.run.motion
        if running.run.document != obj.Document.Name or obj.Name not in running.run.objects:
            continue
        rows = np.flatnonzero(motion.deposit & (motion.layer == layer))
        if len(rows):
            away = np.linalg.norm(motion.position[rows] - position, axis=1)
            running.player.go_to_row(int(rows[int(away.argmin())]))
            running.play(False)
            return True
    return False


def _path(obj: Any, layer: int, position: Array) -> bool:
    """The view of the joint path shows the layer up to the point, where the path dock is open."""
    opened, view = path_dock._dock, obj.ViewObject.Proxy
    if (
        opened is None
        or not opened.dock.isVisible()
        or not isinstance(view, PathView)
        or view.rows is None
    ):
        return False
    first, end = view.rows.of_layers(layer, layer)
    if end <= first:
        return False
    away = np.linalg.norm(view.rows.points[first:end] - position, axis=1)
    begin = 0 if view.shown is None else min(view.shown[0], layer)
    view.show((begin, layer, int(away.argmin()) + 1))
    opened.follow(obj)
    return True
