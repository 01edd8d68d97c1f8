# SPDX-License-Identifier: LGPL-2.1-or-later
"""Support of beads other than deposit: platform or plane below the part, hub, substrate, fixtures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..families.family import Family
from ..geometry.curves.guide import Guide
from ..geometry.developable import Plane
from ..geometry.mesh.coarsen import doubled_areas
from ..geometry.mesh.solid import Search, SolidMesh
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, SolidsOnHub
from ..issues import WARNING, Issue, Text, Word
from ..process.deposit import support
from ..process.deposit.pieces import Pieces, cut_beads
from ..toolpath import Toolpath
from ..types import Array, Mask

STEPS = 7  # number of positions below a point at which bodies are searched
CONTACT_HEIGHTS = 0.5  # layer heights; maximum distance, in any direction, of a point on a body
FLUSH = 1e-6  # relative rounding error of the reach
OVER_PLATFORM, ABOVE_PLATFORM = "OVER_PLATFORM", "ABOVE_PLATFORM"
ABOVE_SUBSTRATE = "ABOVE_SUBSTRATE"


def check_support(
    toolpath: Toolpath, planes: Sequence[Array], bodies: Sequence[Body], bases: Sequence[Base]
) -> Toolpath:
    """Return the toolpath with its unsupported length and issues.

    The first layer of a wall starts on the wall's base by construction, so it is supported.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    planes : sequence of (4, 4) array
        Frames in part coordinates. Points on or below the plane z = 0 of a frame are supported.
    bodies : sequence of Body
        Supporting bodies in part coordinates.
    bases : sequence of Base
        Hubs. They count only if most of the first layer is not on a body, because then only the
        hub's surface is known.

    Returns
    -------
    Toolpath
        The toolpath with checks and issues.
    """
    ground = _Ground(toolpath, planes, bodies, bases)
    open_, issues = support.find_unsupported(
        toolpath, ground, toolpath.traits.starts_on_base, _lowest(toolpath, toolpath.traits, 0)
    )
    checked = toolpath.add_checks(unsupported=math.fsum(open_.values()))
    return replace(checked, issues=(*toolpath.issues, *issues))


def feature_support(
    toolpath: Toolpath,
    number: int,
    planes: Sequence[Array],
    bodies: Sequence[Body],
    bases: Sequence[Base],
) -> tuple[dict[int, float], list[Issue]]:
    """Return the unsupported length of one feature's layers.

    Deposit of other features supports later layers.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath of all features.
    number : int
        Index of the feature.
    planes : sequence of (4, 4) array
        As in `check_support`.
    bodies, bases : sequence of Body
        As in `check_support`.

    Returns
    -------
    lengths : dict of int to float
        Unsupported length by layer, mm.
    issues : list of Issue
        Issues of the unsupported layers.
    """
    feature, numbers = toolpath.parts[number]
    ground = _Ground(feature, planes, bodies, bases)
    scaled = replace(toolpath, layer_height=feature.layer_height)
    return support.find_unsupported(
        scaled,
        ground,
        feature.traits.starts_on_base,
        _lowest(scaled, feature.traits, int(numbers[0])),
        numbers,
    )


def _lowest(toolpath: Toolpath, family: Family, first_layer: int) -> Mask:
    """Return the mask (l,) of layers that may start on the ground, at most a layer height above it.

    These are the first layer, layers that begin another solid, and all layers of curves, because curves may be
    deposited one after the other.
    """
    mask = np.array(
        [layer.first or family.starts_anywhere for layer in toolpath.layers], dtype=bool
    )
    mask[first_layer] = True
    return mask


def over_edge(
    toolpath: Toolpath,
    frame: Array,
    diameter: float,
    bodies: Sequence[Body],
    feature: Array | None = None,
) -> list[Issue]:
    """Return a warning if the first layer overhangs the edge of the platform.

    The warning applies to beads on the platform plane, or of solids below it, that are more than
    half their width beyond the edge and not on a body.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    frame : (4, 4) array
        Pose of the platform in part coordinates.
    diameter : float
        Diameter of the platform, mm.
    bodies : sequence of Body
        Supporting bodies in part coordinates.
    feature : (4, 4) array or None, optional
        Alternative frame of `cell.mount: feature`, tried as a remedy.

    Returns
    -------
    list of Issue
        One warning, or none.
    """
    first_pieces = cut_beads(replace(toolpath, layers=toolpath.layers[:1]), support.PIECE)
    beyond = _beyond_edge(toolpath, first_pieces, frame, diameter)
    out = np.flatnonzero(beyond > 0.5 * first_pieces.width)
    out = out[~_Ground(toolpath, (), bodies, ())(first_pieces.middle[out], first_pieces.build[out])]
    if not len(out):
        return []
    worst = out[beyond[out].argmax()]
    mounted = (
        feature is not None
        and stands_on(toolpath, feature, bodies)
        and bool(
            (
                _beyond_edge(toolpath, first_pieces, feature, diameter) <= 0.5 * first_pieces.width
            ).all()
        )
    )
    return [
        Issue(
            WARNING,
            OVER_PLATFORM,
            Text(
                "{:.4g} mm of the first layer overhang the platform edge, by up to {:.4g} mm; "
                "{}, or correct cell.platform_diameter (0 for none)",
                math.fsum(first_pieces.length[out]),
                beyond[worst],
                Word(
                    "centre the part by cell.mount: feature, move the part"
                    if mounted
                    else "move the part"
                ),
            ),
            0,
            int(first_pieces.bead[worst]),
            int(first_pieces.point[worst]),
        )
    ]


def _beyond_edge(toolpath: Toolpath, first_pieces: Pieces, frame: Array, diameter: float) -> Array:
    """Return the distances (n,) of first-layer pieces beyond the platform's edge, mm.

    Pieces above the platform plane have -inf. For walls, hubs and curves, pieces below the plane have -inf too, because
    their first layer may be on objects that are not in the file.
    """
    local = (first_pieces.middle - frame[:3, 3]) @ frame[:3, :3]
    on_plane = (
        local[:, 2] if toolpath.traits.stacks_layers else np.abs(local[:, 2])
    ) <= CONTACT_HEIGHTS * toolpath.layer_height
    return np.where(on_plane, np.hypot(local[:, 0], local[:, 1]) - 0.5 * diameter, -np.inf)


def stands_on(toolpath: Toolpath, frame: Array, bodies: Sequence[Body]) -> bool:
    """Whether deposit and bodies are above a plane that the first layer touches.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    frame : (4, 4) array
        Frame of the plane z = 0, in part coordinates.
    bodies : sequence of Body
        Bodies in part coordinates.

    Returns
    -------
    bool
        True if nothing is below the plane and the first layer touches it.
    """
    points = [bead.points for _, _, bead in toolpath]
    heights = [
        (points_ - frame[:3, 3]) @ frame[:3, 2]
        for points_ in (*points, *(body.vertices for body in bodies))
    ]
    first_heights = np.concatenate(heights[: len(toolpath.layers[0].beads)])
    return min(map(np.min, heights)) >= -CONTACT_HEIGHTS * toolpath.layer_height and bool(
        (first_heights <= CONTACT_HEIGHTS * toolpath.layer_height).any()
    )


def above(toolpath: Toolpath, frame: Array, bodies: Sequence[Body]) -> list[Issue]:
    """Return a warning if most of the first layer is above the platform and not on a body.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    frame : (4, 4) array
        Pose of the platform in part coordinates.
    bodies : sequence of Body
        Supporting bodies in part coordinates.

    Returns
    -------
    list of Issue
        One warning, or none.
    """
    first_pieces = cut_beads(replace(toolpath, layers=toolpath.layers[:1]), support.PIECE)
    height = (first_pieces.middle - frame[:3, 3]) @ frame[:3, 2]
    up = np.flatnonzero(height > support.REACH * toolpath.layer_height)
    up = up[~_Ground(toolpath, (), bodies, ())(first_pieces.middle[up], first_pieces.build[up])]
    if 2.0 * first_pieces.length[up].sum() <= first_pieces.length.sum():
        return []
    highest = up[height[up].argmax()]
    return [
        Issue(
            WARNING,
            ABOVE_PLATFORM,
            Text(
                "{:.4g} mm of the first layer are unsupported, up to {:.4g} mm above the "
                "platform; use cell.mount: feature, move the part onto the platform in its file, "
                "or set its substrate",
                math.fsum(first_pieces.length[up]),
                height[highest],
            ),
            0,
            int(first_pieces.bead[highest]),
            int(first_pieces.point[highest]),
        )
    ]


def surely_above(solids: SolidsOnHub, layer_height: float) -> bool:
    """Whether `above` will warn for solids on the plane z = 0, independent of their layers.

    This is so if all bases are planes, there are no bodies, and the solids are too far above the plane.
    """
    if solids.surroundings or not is_on_planes([group.base for group in solids.groups]):
        return False
    low = min(float(body.vertices[:, 2].min()) for group in solids.groups for body in group.bodies)
    return low > support.REACH * layer_height


def is_on_planes(bases: Sequence[Base]) -> bool:
    """Whether every solid is based on a plane, or on a guide's plane."""
    return bool(bases) and all(isinstance(base.surface, (Plane, Guide)) for base in bases)


class _Ground:
    """Predicate: whether anything other than deposit supports points (n, 3) with build directions (n, 3).

    `is_first` (n,) is true in the first layer, which has a larger reach than later layers.
    """

    def __init__(
        self,
        toolpath: Toolpath,
        planes: Sequence[Array],
        bodies: Sequence[Body],
        bases: Sequence[Base],
    ) -> None:
        self._height, self._planes, self._bases = toolpath.layer_height, planes, bases
        self._searches = [
            search
            for body in bodies
            if (search := _search(body, toolpath.layer_height)) is not None
        ]
        if bases and self._searches:
            first_beads = toolpath.layers[0].beads
            points, build = (
                np.vstack([getattr(bead, name) for bead in first_beads])
                for name in ("points", "build")
            )
            sample = slice(None, None, max(1, len(points) // 1000))
            reach = np.full(len(points), support.REACH * self._height)
            if self._is_on_bodies(points[sample], build[sample], reach[sample]).mean() > 0.5:
                self._bases = ()

    def __call__(self, points: Array, build: Array, is_first: Mask | None = None) -> Mask:
        is_first = np.ones(len(points), dtype=bool) if is_first is None else is_first
        down = np.where(is_first, support.REACH, support.DOWN) * self._height
        reach = down * (1.0 + FLUSH)
        is_supported = np.zeros(len(points), dtype=bool)
        for frame in self._planes:
            is_supported |= (points - frame[:3, 3]) @ frame[:3, 2] <= reach
        for base in self._bases:
            is_supported |= base.surface.distance(base.inside(points)) <= reach
        rows = np.flatnonzero(~is_supported)
        is_supported[rows] = self._is_on_bodies(points[rows], build[rows], down[rows])
        return is_supported

    def _is_on_bodies(self, points: Array, build: Array, reach: Array) -> Mask:
        """Whether a body is at most `reach` (n,) mm below the points."""
        is_supported = np.zeros(len(points), dtype=bool)
        if not len(points):
            return is_supported
        stride = reach / (STEPS - 1)
        for search in self._searches:
            rows = np.flatnonzero(~is_supported)
            distance = _body_distances(search, points[rows])
            is_supported[rows[distance <= CONTACT_HEIGHTS * self._height]] = True
            rows = rows[
                (distance > CONTACT_HEIGHTS * self._height) & (distance <= (reach + stride)[rows])
            ]
            for step in range(1, STEPS):
                rows = rows[~is_supported[rows]]
                if len(rows):
                    below = points[rows] - step * stride[rows, None] * build[rows]
                    is_supported[rows] = _body_distances(search, below) <= 0.5 * stride[rows]
        return is_supported


def _body_distances(search: Search, points: Array) -> Array:
    """Return the distances (k,) of points from a body, mm, negative inside; a flat body has no inside."""
    return search.distance(points) if search.flat else search.signed(points)[0]


def _search(body: Body, height: float) -> Search | None:
    """Prepare a body for distance queries; None if all triangles are degenerate."""
    corner = body.corners()
    area = np.linalg.norm(doubled_areas(corner), axis=1)
    if not (area > 1e-10).any():
        return None
    return SolidMesh(body.vertices, body.triangles).searched(height)
