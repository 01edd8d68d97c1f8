# SPDX-License-Identifier: LGPL-2.1-or-later
"""What carries beads besides deposit: the platform or plane that a part stands on, the hub, the substrate, fixtures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.curves.guide import Guide
from ..geometry.mesh.facets import doubled_areas
from ..geometry.mesh.solid import Search, SolidMesh
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, SolidsOnHub
from ..geometry.plane import Plane
from ..issues import WARNING, Issue, Text, Word
from ..process.deposit import support
from ..process.deposit.pieces import Pieces, cut_beads
from ..toolpath import Toolpath
from ..types import Array, Mask

STEPS = 7  # places on the way down at which a body is looked for
ON = 0.5  # layer heights; what is no farther from a body lies on it, whichever way it is
FLUSH = 1e-6  # mm
OVER_PLATFORM, ABOVE_PLATFORM = "OVER_PLATFORM", "ABOVE_PLATFORM"
ABOVE_SUBSTRATE = "ABOVE_SUBSTRATE"
CURVES = "curves"
BY_ITSELF = (
    "surface",
    CURVES,
    "cladding",
)  # families whose first layer lies where it begins by its making


def with_support(
    toolpath: Toolpath, planes: Sequence[Array], bodies: Sequence[Body], bases: Sequence[Base]
) -> Toolpath:
    """The toolpath with how much of it lies over nothing, and issues where.

    planes: frames (4, 4) in part coordinates, what lies on the plane z = 0 of
    one, or below it, is carried. bases: hubs, which count where most of the first layer is on none of the bodies: then the
    hub is known by its surface alone. The first layer of a wall lies by its making where the wall begins, and is carried.
    """
    ground = _Ground(toolpath, planes, bodies, bases)
    open_, issues = support.find_unsupported(
        toolpath, ground, toolpath.family in BY_ITSELF, _lowest(toolpath, toolpath.family, 0)
    )
    return replace(
        toolpath, unsupported=math.fsum(open_.values()), issues=(*toolpath.issues, *issues)
    )


def of_feature(
    toolpath: Toolpath,
    number: int,
    planes: Sequence[Array],
    bodies: Sequence[Body],
    bases: Sequence[Base],
) -> tuple[dict[int, float], list[Issue]]:
    """How much of the layers of one of the features of a toolpath lies over nothing, mm by layer, and issues where; deposit
    of the other features carries what comes after it. planes, bodies, bases: as of `with_support`."""
    part, numbers = toolpath.parts[number]
    ground = _Ground(part, planes, bodies, bases)
    whole = replace(toolpath, layer_height=part.layer_height)
    return support.find_unsupported(
        whole,
        ground,
        part.family in BY_ITSELF,
        _lowest(whole, part.family, int(numbers[0])),
        numbers,
    )


def _lowest(toolpath: Toolpath, family: str, first: int) -> Mask:
    """Which layers (l,) are laid on ground, a layer height above it at most: the first one, those that begin another solid,
    and of curves, several of which may be laid one after the other, all."""
    found = np.array([layer.first or family == CURVES for layer in toolpath.layers], dtype=bool)
    found[first] = True
    return found


def over_edge(
    toolpath: Toolpath,
    frame: Array,
    diameter: float,
    bodies: Sequence[Body],
    feature: Array | None = None,
) -> list[Issue]:
    """A warning where beads of the first layer lie on the plane of the platform, a disc of `diameter` mm about the origin of
    the frame (4, 4) in part coordinates, or of solids below it, and beyond its edge by more than half of their width, on
    none of the bodies. feature: the frame that `cell.mount: feature` would have instead, which is tried."""
    first = cut_beads(replace(toolpath, layers=toolpath.layers[:1]), support.PIECE)
    beyond = _beyond(toolpath, first, frame, diameter)
    out = np.flatnonzero(beyond > 0.5 * first.width)
    out = out[~_Ground(toolpath, (), bodies, ())(first.middle[out], first.build[out])]
    if not len(out):
        return []
    worst = out[beyond[out].argmax()]
    mounted = (
        feature is not None
        and stands_on(toolpath, feature, bodies)
        and bool((_beyond(toolpath, first, feature, diameter) <= 0.5 * first.width).all())
    )
    return [
        Issue(
            WARNING,
            OVER_PLATFORM,
            Text(
                "{:.4g} mm of the first layer lie over the edge of the platform, up to {:.4g} mm "
                "beyond it; {}, or set cell.platform_diameter to what there is (0 for none)",
                math.fsum(first.length[out]),
                beyond[worst],
                Word(
                    "put the part on its middle by cell.mount: feature, move it"
                    if mounted
                    else "move the part"
                ),
            ),
            0,
            int(first.bead[worst]),
            int(first.point[worst]),
        )
    ]


def _beyond(toolpath: Toolpath, first: Pieces, frame: Array, diameter: float) -> Array:
    """How far (n,) mm pieces of the first layer on the plane of a platform, or of solids below it, are beyond its edge; -inf
    of all others. The first layers of walls, hubs and curves may lie on what is not in the file."""
    local = (first.middle - frame[:3, 3]) @ frame[:3, :3]
    on_plane = (
        np.abs(local[:, 2]) if toolpath.family != "solid" else local[:, 2]
    ) <= ON * toolpath.layer_height
    return np.where(on_plane, np.hypot(local[:, 0], local[:, 1]) - 0.5 * diameter, -np.inf)


def stands_on(toolpath: Toolpath, frame: Array, bodies: Sequence[Body]) -> bool:
    """Whether all that is deposited, and bodies, are above a plane, z = 0 of a frame (4, 4), onto which the first layer
    comes."""
    points = [bead.points for _, _, bead in toolpath]
    heights = [
        (some - frame[:3, 3]) @ frame[:3, 2]
        for some in (*points, *(body.vertices for body in bodies))
    ]
    first = np.concatenate(heights[: len(toolpath.layers[0].beads)])
    return min(map(np.min, heights)) >= -ON * toolpath.layer_height and bool(
        (first <= ON * toolpath.layer_height).any()
    )


def above(toolpath: Toolpath, frame: Array, bodies: Sequence[Body]) -> list[Issue]:
    """A warning where most of the first layer lies above the plane of the platform, z = 0 of the frame (4, 4) in part
    coordinates, and on none of the bodies."""
    first = cut_beads(replace(toolpath, layers=toolpath.layers[:1]), support.PIECE)
    height = (first.middle - frame[:3, 3]) @ frame[:3, 2]
    up = np.flatnonzero(height > support.REACH * toolpath.layer_height)
    up = up[~_Ground(toolpath, (), bodies, ())(first.middle[up], first.build[up])]
    if 2.0 * first.length[up].sum() <= first.length.sum():
        return []
    highest = up[height[up].argmax()]
    return [
        Issue(
            WARNING,
            ABOVE_PLATFORM,
            Text(
                "{:.4g} mm of the first layer lie up to {:.4g} mm above the platform, over nothing; "
                "put the part on it by cell.mount: feature, move it in its file, or name what it grows on as its substrate",
                math.fsum(first.length[up]),
                height[highest],
            ),
            0,
            int(first.bead[highest]),
            int(first.point[highest]),
        )
    ]


def surely_above(solids: SolidsOnHub, layer_height: float) -> bool:
    """Whether `above` warns of the toolpath of solids on the plane z = 0, whatever its layers are: they stand on planes and
    on no body, and all of them lies too far above that one."""
    if solids.surroundings or not on_planes([group.base for group in solids.groups]):
        return False
    low = min(float(body.vertices[:, 2].min()) for group in solids.groups for body in group.bodies)
    return low > support.REACH * layer_height


def on_planes(bases: Sequence[Base]) -> bool:
    """Whether solids stand on planes alone, those of guides among them."""
    return bool(bases) and all(isinstance(base.surface, (Plane, Guide)) for base in bases)


class _Ground:
    """Whether something other than deposit carries points (n, 3) with build directions (n, 3), of the first layer or, where
    `first` (n,) is not true, of those after it."""

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
            first = toolpath.layers[0].beads
            points, build = (
                np.vstack([getattr(bead, name) for bead in first]) for name in ("points", "build")
            )
            some = slice(None, None, max(1, len(points) // 1000))
            reach = np.full(len(points), support.REACH * self._height)
            if self._on_bodies(points[some], build[some], reach[some]).mean() > 0.5:
                self._bases = ()

    def __call__(self, points: Array, build: Array, first: Mask | None = None) -> Mask:
        first = np.ones(len(points), dtype=bool) if first is None else first
        down = np.where(first, support.REACH, support.DOWN) * self._height
        reach = down * (1.0 + FLUSH)
        found = np.zeros(len(points), dtype=bool)
        for frame in self._planes:
            found |= (points - frame[:3, 3]) @ frame[:3, 2] <= reach
        for base in self._bases:
            found |= base.surface.distance(base.inside(points)) <= reach
        rest = np.flatnonzero(~found)
        found[rest] = self._on_bodies(points[rest], build[rest], down[rest])
        return found

    def _on_bodies(self, points: Array, build: Array, reach: Array) -> Mask:
        """Whether there is a body below them, no more than `reach` (n,) mm."""
        found = np.zeros(len(points), dtype=bool)
        if not len(points):
            return found
        stride = reach / (STEPS - 1)
        for search in self._searches:
            left = np.flatnonzero(~found)
            away = _away(search, points[left])
            found[left[away <= ON * self._height]] = True
            left = left[(away > ON * self._height) & (away <= (reach + stride)[left])]
            for step in range(1, STEPS):
                left = left[~found[left]]
                if len(left):
                    below = points[left] - step * stride[left, None] * build[left]
                    found[left] = _away(search, below) <= 0.5 * stride[left]
        return found


def _away(search: Search, points: Array) -> Array:
    """Distances (k,) mm of points from a body, negative inside; below a flat one, as a platform is, there is no inside."""
    return search.distance(points) if search.flat else search.signed(points)[0]


def _search(body: Body, height: float) -> Search | None:
    """A body prepared for points a layer height apart; None without triangles that have an area."""
    corner = body.corners()
    area = np.linalg.norm(doubled_areas(corner), axis=1)
    if not (area > 1e-10).any():
        return None
    return SolidMesh(body.vertices, body.triangles).searched(height)
