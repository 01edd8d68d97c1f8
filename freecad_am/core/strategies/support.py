# SPDX-License-Identifier: LGPL-2.1-or-later
"""Support of beads besides deposit: the platform or plane under a part, the hub, the substrate, fixtures."""

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

STEPS = 7  # places on the way down at which a body is looked for
CONTACT_HEIGHTS = 0.5  # layer heights; a point no farther from a body is on it, in any direction
FLUSH = 1e-6  # mm
OVER_PLATFORM, ABOVE_PLATFORM = "OVER_PLATFORM", "ABOVE_PLATFORM"
ABOVE_SUBSTRATE = "ABOVE_SUBSTRATE"


def check_support(
    toolpath: Toolpath, planes: Sequence[Array], bodies: Sequence[Body], bases: Sequence[Base]
) -> Toolpath:
    """Return the toolpath with its unsupported length, and issues.

    The first layer of a wall starts on the wall's base by construction, and is supported.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    planes : sequence of (4, 4) array
        Frames in part coordinates; points on or below the plane z = 0 of one are supported.
    bodies : sequence of Body
        Bodies that support, in part coordinates.
    bases : sequence of Base
        Hubs, which count if most of the first layer is on none of the bodies: then only the
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
        Number of the feature.
    planes : sequence of (4, 4) array
        As in `check_support`.
    bodies, bases : sequence of Body
        As in `check_support`.

    Returns
    -------
    lengths : dict of int to float
        Unsupported length by layer, mm.
    issues : list of Issue
        Their issues.
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
    """Mask (l,) of the layers deposited on ground, at most a layer height above it: the first one, layers that begin another solid,
    and all layers of curves, whose curves may be deposited one after the other.
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

    This applies to beads on the plane of the platform, or to solids below it, that are beyond
    its edge by more than half of their width, and on none of the bodies.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    frame : (4, 4) array
        Pose of the platform in part coordinates.
    diameter : float
        Diameter of the platform, mm.
    bodies : sequence of Body
        Bodies that support, in part coordinates.
    feature : (4, 4) array or None, optional
        The alternative frame of `cell.mount: feature`, which is tried for the remedy.

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
                    "centre the part by cell.mount: feature, move it"
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
    """Distance (n,) mm beyond the platform's edge of pieces of the first layer on its plane, or of solids below it; -inf for others.
    The first layers of walls, hubs and curves may be on objects that are not in the file.
    """
    local = (first_pieces.middle - frame[:3, 3]) @ frame[:3, :3]
    on_plane = (
        local[:, 2] if toolpath.traits.stacks_layers else np.abs(local[:, 2])
    ) <= CONTACT_HEIGHTS * toolpath.layer_height
    return np.where(on_plane, np.hypot(local[:, 0], local[:, 1]) - 0.5 * diameter, -np.inf)


def stands_on(toolpath: Toolpath, frame: Array, bodies: Sequence[Body]) -> bool:
    """Return whether deposit and bodies are above a plane that the first layer touches.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    frame : (4, 4) array
        Frame whose plane z = 0 is meant, in part coordinates.
    bodies : sequence of Body
        Bodies in part coordinates.

    Returns
    -------
    bool
        True if so.
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
    """Return a warning if most of the first layer is above the platform and on none of the bodies.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath in part coordinates.
    frame : (4, 4) array
        Pose of the platform in part coordinates.
    bodies : sequence of Body
        Bodies that support, in part coordinates.

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
                "platform; put the part on it by cell.mount: feature, move it in its file, or "
                "set its substrate",
                math.fsum(first_pieces.length[up]),
                height[highest],
            ),
            0,
            int(first_pieces.bead[highest]),
            int(first_pieces.point[highest]),
        )
    ]


def surely_above(solids: SolidsOnHub, layer_height: float) -> bool:
    """Whether `above` warns of the toolpath of solids on the plane z = 0, whatever its layers are: they are based on planes and on no
    body, all too far above that plane.
    """
    if solids.surroundings or not is_on_planes([group.base for group in solids.groups]):
        return False
    low = min(float(body.vertices[:, 2].min()) for group in solids.groups for body in group.bodies)
    return low > support.REACH * layer_height


def is_on_planes(bases: Sequence[Base]) -> bool:
    """Whether every solid is based on a plane, or on a guide's plane."""
    return bool(bases) and all(isinstance(base.surface, (Plane, Guide)) for base in bases)


class _Ground:
    """Whether something other than deposit supports points (n, 3) with build directions (n, 3), in the first layer or, where `first`
    (n,) is false, in later ones.
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
        """Whether there is a body below them, no more than `reach` (n,) mm."""
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
    """Distances (k,) mm of points from a body, negative inside; below a flat one, as a platform is, there is no inside."""
    return search.distance(points) if search.flat else search.signed(points)[0]


def _search(body: Body, height: float) -> Search | None:
    """A body prepared for points a layer height apart; None without triangles that have an area."""
    corner = body.corners()
    area = np.linalg.norm(doubled_areas(corner), axis=1)
    if not (area > 1e-10).any():
        return None
    return SolidMesh(body.vertices, body.triangles).searched(height)
