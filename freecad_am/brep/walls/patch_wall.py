# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of any connected smooth faces: full tubes and open shells, with openings and slanted ends, on any substrate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import Part

from freecad_am.core.types import Mask

from ...core.geometry.formatting import at_least, count, format_deviation, place
from ...core.geometry.walls import contact
from ...core.geometry.walls.ground import nearest_point
from ...core.geometry.walls.patch_wall import FirstCurve, PatchWall
from ...core.geometry.walls.rims import connected_parts, find_rims, mark_ends, outward_volume
from ...core.issues import NOTE, InputError, Issue, Text
from .checks import refuse_creases, refuse_gaps, refuse_tight, smallest_radii
from .cuts import refuse_crossing, refuse_folded
from .sheet import MAX_TRIANGLES, sheet
from .standing import standing_edges
from .start_edges import curves_along, curves_of
from .substrate import Substrate

EQUILATERAL_AREA = 0.433  # area of a triangle with equal sides of 1
COARSE, SHARE = (
    4.0,
    0.04,
)  # edge lengths of the first mesh, which gives the radii: shares of the layer height and of the wall's size


def find_patch_wall(
    shape: Any,
    named: Sequence[tuple[str, Any]],
    substrate: Substrate | None,
    height: float,
    label: str = "part",
    start_edges: Sequence[str] = (),
) -> PatchWall:
    """The wall of the faces `named` of a shape, for layers of `height` mm, on a substrate, from
    edges of its own, or from its edges on the platform.

    It starts from every curve in which it leaves the substrate; an issue locates them if there are
    several. Raises InputError GAP, CREASE, BRANCHING_FACES, SELF_INTERSECTION, LAYER_HEIGHT,
    ROUGH_WALL, TOO_FINE, NOT_ORIENTABLE, NO_CONTACT, INSIDE, NO_START, UNKNOWN_EDGE.
    """
    _refuse_fine(named, height)
    wall = sheet(named, _edge(named, height, label), label)
    refuse_creases(wall, shape, label)
    refuse_gaps(wall, label)
    refuse_crossing(wall, label)
    wall = _outward(wall, shape)
    rims = find_rims(wall)
    issues: list[Issue] = []
    if start_edges:
        curves = curves_of(shape, start_edges, wall, label)
        behind = np.zeros(len(wall.vertices), dtype=bool)
    elif substrate is None:
        curves, issues = _from_platform(wall, [face for _, face in named], label)
        behind = np.zeros(len(wall.vertices), dtype=bool)
    else:
        curves, behind, issues = from_substrate(wall, substrate, rims, label)
    refuse_tight(wall, ~behind, height, label)
    issues += several_loops(curves, label)
    return replace(
        wall,
        first=tuple(curves),
        behind=behind,
        rims=mark_ends(wall, rims, tuple(curves), behind),
        issues=tuple(issues),
        ground=float(wall.vertices[:, 2].min()) if substrate is None else None,
    )


def _from_platform(
    wall: PatchWall, faces: Sequence[Any], label: str
) -> tuple[list[FirstCurve], list[Issue]]:
    """The edges on the platform, and a note. InputError NO_SUBSTRATE."""
    lowest = wall.vertices[np.argmin(wall.vertices[:, 2])]
    edges = standing_edges(faces, float(lowest[2]))
    if not edges:
        raise InputError(
            "NO_SUBSTRATE",
            label,
            "the wall has no start: none of its edges is on the platform, the plane Z = {:.4g} "
            "mm through its lowest point {}; choose a substrate or start edges",
            lowest[2],
            place(lowest),
        )
    curves = curves_along(edges, wall)
    text = Text(
        "the first layer follows the edge of {} at {}, on the platform",
        label,
        place(curves[0].points.mean(axis=0)),
    )
    return curves, [Issue(NOTE, "FIRST_LAYER", text)]


def several_loops(curves: Sequence[FirstCurve], label: str) -> list[Issue]:
    """A note if a wall has several first curves."""
    if len(curves) < 2:
        return []
    positions = Text.joined(", ", (place(curve.points.mean(axis=0)) for curve in curves))
    return [
        Issue(
            NOTE,
            "SEVERAL_LOOPS",
            Text(
                "{} starts from {} curves, about {}; choose start edges to use only some",
                label,
                len(curves),
                positions,
            ),
        )
    ]


def _refuse_fine(named: Sequence[tuple[str, Any]], height: float) -> None:
    """InputError TOO_FINE where even triangles with sides of a layer height are more than a mesh may have."""
    area = sum(face.Area for _, face in named)
    about, enough = (
        area / (EQUILATERAL_AREA * height) / height,
        at_least(float(np.sqrt(area / (EQUILATERAL_AREA * MAX_TRIANGLES)))),
    )
    if about > MAX_TRIANGLES:
        raise InputError(
            "TOO_FINE",
            "strategy.layer_height",
            "layers of {:g} mm need a mesh of about {} triangles, but the limit is {:,}; use "
            "layers above {:g} mm, or deposit the wall in parts",
            height,
            count(about),
            MAX_TRIANGLES,
            enough,
        )


def _edge(named: Sequence[tuple[str, Any]], height: float, label: str) -> float:
    """Longest edge of the mesh: the layer height, a quarter of the wall's smallest radius if that is less."""
    # checked early: where a surface is bent that tightly, a finer mesh takes long
    radius = float(smallest_radii(sound(named, label, COARSE * height))[0].min())
    return float(np.clip(0.25 * radius, 0.25 * height, height))


def sound(named: Sequence[tuple[str, Any]], label: str, edge: float = 0.0) -> PatchWall:
    """A coarse mesh of the faces, edges not longer than `edge` mm or a share of their size, without
    self-intersection. InputError SELF_INTERSECTION, and the errors of `sheet`.
    """
    size = Part.Compound([face for _, face in named]).BoundBox.DiagonalLength
    coarse = sheet(named, max(edge, SHARE * size), label)
    refuse_folded(coarse, label)
    refuse_crossing(coarse, label)
    return coarse


def _outward(wall: PatchWall, shape: Any) -> PatchWall:
    """The wall with its outer side outwards: as the faces of a solid look, or away from what the wall surrounds."""
    if shape.Solids:
        return wall
    if outward_volume(wall) >= 0.0:
        return wall
    return replace(
        wall,
        triangles=wall.triangles[:, ::-1].copy(),
        uv=wall.uv[:, ::-1].copy(),
        patches=tuple(replace(patch, sign=-patch.sign) for patch in wall.patches),
    )


def from_substrate(
    wall: PatchWall, substrate: Substrate, rims: Any, label: str
) -> tuple[list[FirstCurve], Mask, list[Issue]]:
    """The curves where a wall leaves its substrate, its vertices (n,) behind them, and notes.
    InputError NO_CONTACT, INSIDE, OWN_SUBSTRATE.
    """
    ground = substrate.ground(wall.mesh.typical_edge)
    value = contact.ground_distances(wall, ground)
    if np.abs(value).max() < contact.TOUCH_MM + getattr(
        wall, "smoothing", 0.0
    ):  # a mesh's smooth surface is off it
        raise InputError(
            "OWN_SUBSTRATE",
            label,
            "the wall coincides with the surface of {}; choose the part below the wall, or clear "
            "the substrate if the wall starts on the platform or from edges",
            substrate.label,
        )
    outside = value >= 0.0
    if outside.all():
        vertex, gap = nearest_point(wall.vertices, ground, value)
        raise InputError(
            "NO_CONTACT",
            label,
            "the wall does not touch {}: its nearest point is {}, {:.4g} mm away; extend it to "
            "within {:g} mm of the substrate",
            substrate.label,
            place(wall.vertices[vertex]),
            gap,
            contact.TOUCH_MM,
        )
    if not outside.any():
        vertex, depth = nearest_point(wall.vertices, ground, value)
        raise InputError(
            "INSIDE",
            label,
            "the wall is entirely inside {} (at {} it is {:.4g} mm deep, the least depth); "
            "extend one end outside the substrate",
            substrate.label,
            place(wall.vertices[vertex]),
            depth,
        )
    dropped = _stays_in(wall, outside, substrate)
    value[dropped] = np.minimum(value[dropped], -1e-6)
    curves, off = contact.first_curves(wall, ground, value, rims)
    if not curves:
        raise InputError(
            "NO_CONTACT",
            label,
            "the wall meets {} in no curve long enough to start a layer (all shorter than a few "
            "{:.2g} mm); extend it into the substrate all around, or choose start edges",
            substrate.label,
            wall.mesh.typical_edge,
        )
    message = Text("the first layer follows the intersection of the wall and {}", substrate.label)
    if ground.facets:
        message += (
            Text(
                "; between the mesh edges it is smoothed, by up to {} mm, about the error of the "
                "mesh itself",
                format_deviation(off),
            )
            if off > 0.0
            else ""
        )
    else:
        message += Text(" within {} mm", format_deviation(off))
    return curves, value < 0.0, [Issue(NOTE, "FIRST_LAYER", message)]


def _stays_in(wall: PatchWall, outside: Mask, substrate: Substrate) -> Mask:
    """Vertices of the parts of the wall that are out of the substrate but never leave its box (a stub in the bore of a
    pipe), while another part does."""
    low, high = substrate.solid.vertices.min(axis=0), substrate.solid.vertices.max(axis=0)
    leaves = ((wall.vertices < low - 1e-3) | (wall.vertices > high + 1e-3)).any(axis=1)
    count, component = connected_parts(wall, outside)
    goes = np.zeros(count, dtype=bool)
    goes[component[outside & leaves]] = True
    dropped = outside.copy()
    dropped[outside] = not_kept = ~goes[component[outside]]
    return dropped if goes.any() and not_kept.any() else np.zeros(len(outside), dtype=bool)
