# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distance of a finished toolpath from the shapes that it was made for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...brep.shapes.off_part import off_edges, off_faces, off_facets, off_mesh, off_solids
from ...core.families.registry import family_of
from ...core.process.deposit import on_part
from ...core.toolpath import Toolpath as CoreToolpath
from ..planned.toolpaths import Given
from ..shapes.bodies import Taken
from ..work import progress

LOOKED = 0.95  # of the time, after planning


def check_on_part(toolpath: CoreToolpath, inputs: Given, sources: Sequence[Taken]) -> CoreToolpath:
    """The toolpath with a judgement of its distance from the shapes that it was made for; unchanged
    if these have no faces.
    """
    kind = family_of(inputs.strategy).kind
    if kind == "curves" and inputs.wall.edges is None:  # the table itself is the part
        return toolpath
    progress.report(LOOKED, "checking whether the deposit is on the part")
    positions = on_part.sample_places(toolpath)
    if kind == "curves":
        return _check_on_edges(toolpath, inputs, sources[0], positions)
    if kind == "cladding":
        return _check_on_faces(toolpath, inputs, sources[0], positions)
    if hasattr(
        inputs.strategy, "share_of_cut"
    ):  # where the part was cut, above the surface below the beads of the layer
        up = inputs.strategy.share_of_cut * inputs.strategy.layer_height * positions.build
        positions = positions._replace(points=positions.points + up)
    limit = on_part.allowed_distance(toolpath, getattr(inputs.strategy, "margin", 0.0))
    middle = getattr(inputs.strategy, "wall", "") == "middle"  # between two faces, on neither
    if middle and not sources[0].shape.Solids:
        return toolpath
    if middle or family_of(inputs.strategy).is_filled:
        off = np.min([_off_solid(source, positions.points, limit) for source in sources], axis=0)
    elif sources[0].shape is None:
        body = sources[0].body()
        off = np.maximum(
            off_facets(body.vertices, body.triangles, positions.points) - inputs.wall.smoothing, 0.0
        )
    else:
        off = off_faces(sources[0].shape, inputs.wall.faces, positions.points, limit)
    if (
        toolpath.fitted is not None
    ):  # these layers follow the scan and are no farther off than they were moved
        from ...core.inspection.fit_layers import max_moves  # jobs without a scan need none of it

        off = np.maximum(off - max_moves(toolpath.fitted, positions.layer), 0.0)
    return on_part.check_on_part(toolpath, positions, off, limit)


def _check_on_faces(
    toolpath: CoreToolpath, inputs: Given, source: Taken, positions: on_part.Places
) -> CoreToolpath:
    """The toolpath with a judgement of its layers' heights above the faces."""
    up = (positions.layer % inputs.strategy.layers) * inputs.strategy.layer_height
    limit = toolpath.chord_error + on_part.ROUNDED
    feet = positions.points - up[:, None] * positions.build
    if source.shape is not None:
        off = off_faces(source.shape, inputs.wall.faces, feet, limit)
    else:
        body = source.body()
        off = np.maximum(
            off_facets(body.vertices, body.triangles, feet) - inputs.wall.smoothing, 0.0
        )
    return on_part.check_on_part(toolpath, positions, off, limit)


def _check_on_edges(
    toolpath: CoreToolpath, inputs: Given, source: Taken, positions: on_part.Places
) -> CoreToolpath:
    """The toolpath with a judgement of its layers' heights above the edges."""
    up = (
        positions.layer
        // (len(toolpath.layers) // inputs.strategy.repeat)
        * inputs.strategy.layer_height
    )
    limit = toolpath.chord_error + on_part.ROUNDED
    off = off_edges(
        source.shape, inputs.wall.edges, positions.points - up[:, None] * positions.build
    )
    return on_part.check_on_part(toolpath, positions, off, limit)


def _off_solid(source: Taken, points: Any, limit: float) -> Any:
    if source.shape is not None:
        return off_solids(source.shape, points, limit)
    body = source.body()
    return off_mesh(body.vertices, body.triangles, points)
