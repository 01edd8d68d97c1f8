# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a finished toolpath lies on the shapes that it was made for, by their distance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...brep.shapes.off_part import off_edges, off_faces, off_facets, off_mesh, off_solids
from ...core.process.deposit import on_part
from ...core.strategies.families import family_of
from ...core.toolpath import Toolpath as CoreToolpath
from ..planned.toolpaths import Given
from ..shapes.bodies import Taken
from ..work import progress

LOOKED = 0.95  # of the time, after planning


def looked_at(toolpath: CoreToolpath, of: Given, sources: Sequence[Taken]) -> CoreToolpath:
    """The toolpath with whether it lies on the shapes that it was made for; nobody looks where these have no faces."""
    kind = family_of(of.strategy).kind
    if kind == "curves" and of.wall.edges is None:  # the table itself is the part
        return toolpath
    progress.report(LOOKED, "looking whether the deposit lies on the part")
    places = on_part.sample_places(toolpath)
    if kind == "curves":
        return _on_edges(toolpath, of, sources[0], places)
    if kind == "cladding":
        return _on_faces(toolpath, of, sources[0], places)
    if hasattr(
        of.strategy, "share_of_cut"
    ):  # where the part was cut, above the surface that beads of the layer lie on
        up = of.strategy.share_of_cut * of.strategy.layer_height * places.build
        places = places._replace(points=places.points + up)
    limit = on_part.allowed_distance(toolpath, getattr(of.strategy, "margin", 0.0))
    middle = getattr(of.strategy, "wall", "") == "middle"  # between two faces, on neither
    if middle and not sources[0].shape.Solids:
        return toolpath
    if middle or family_of(of.strategy).filled:
        off = np.min([_off_solid(source, places.points, limit) for source in sources], axis=0)
    elif sources[0].shape is None:
        body = sources[0].body()
        off = np.maximum(
            off_facets(body.vertices, body.triangles, places.points) - of.wall.smoothing, 0.0
        )
    else:
        off = off_faces(sources[0].shape, of.wall.faces, places.points, limit)
    if (
        toolpath.fitted is not None
    ):  # those layers lie on what was scanned, no farther off than they were moved
        from ...core.inspection.fit_layers import moved_most  # jobs without a scan need none of it

        off = np.maximum(off - moved_most(toolpath.fitted, places.layer), 0.0)
    return on_part.check_on_part(toolpath, places, off, limit)


def _on_faces(
    toolpath: CoreToolpath, of: Given, source: Taken, places: on_part.Places
) -> CoreToolpath:
    """The toolpath with whether its layers lie as many layer heights above the faces as they should."""
    up = (places.layer % of.strategy.layers) * of.strategy.layer_height
    limit = toolpath.chord_error + on_part.ROUNDED
    feet = places.points - up[:, None] * places.build
    if source.shape is not None:
        off = off_faces(source.shape, of.wall.faces, feet, limit)
    else:
        body = source.body()
        off = np.maximum(off_facets(body.vertices, body.triangles, feet) - of.wall.smoothing, 0.0)
    return on_part.check_on_part(toolpath, places, off, limit)


def _on_edges(
    toolpath: CoreToolpath, of: Given, source: Taken, places: on_part.Places
) -> CoreToolpath:
    """The toolpath with whether its layers lie as many layer heights above the edges as they should."""
    up = places.layer // (len(toolpath.layers) // of.strategy.repeat) * of.strategy.layer_height
    limit = toolpath.chord_error + on_part.ROUNDED
    off = off_edges(source.shape, of.wall.edges, places.points - up[:, None] * places.build)
    return on_part.check_on_part(toolpath, places, off, limit)


def _off_solid(source: Taken, points: Any, limit: float) -> Any:
    if source.shape is not None:
        return off_solids(source.shape, points, limit)
    body = source.body()
    return off_mesh(body.vertices, body.triangles, points)
