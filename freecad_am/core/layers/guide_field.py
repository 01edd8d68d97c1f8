# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cut bodies by planes normal to a guide curve, each plane only through the nearest part of a body.

A vertex belongs to the plane at the nearest position on the guide. This position, mm along the
guide, replaces the height in sections by parallel planes. It decides which edges a plane cuts and
how loops close. A plane that intersects a bent part twice therefore cuts it only once. The
intersection point is computed from edge and plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry.curves.guide import Guide
from ..geometry.mesh.refine import split_edges
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base
from ..issues import ERROR, InfeasibleError, InputError, Issue, Text
from ..parameters.filled import SolidParameters
from ..slicing.solids.plane_sections import PlaneCuts
from ..types import Array, Index, Mask
from . import plane_field as planes
from .plane_field import Flat
from .surface import Slice, Wrapped


@dataclass(frozen=True, eq=False)
class AlongLayer(Flat):
    """Plane normal to a guide, a `LayerSurface`.

    pose: (4, 4) of the plane in the frame of the field, Z along the guide. The layer height, mm, at
    a point (x, y) of the plane is height + slope . (x, y).
    """

    pose: Array
    height: float
    slope: Array

    def unroll(self, points: Array) -> Array:
        """Project points onto the plane, (n, 2), mm."""
        unrolled: Array = (points - self.pose[:3, 3]) @ self.pose[:3, :2]
        return unrolled

    def wrap(self, flat: Array) -> Wrapped:
        """Transform points of the plane to the frame of the field."""
        points = flat @ self.pose[:3, :2].T + self.pose[:3, 3]
        return Wrapped(points, np.tile(self.pose[:3, 2], (len(flat), 1)), np.zeros(len(flat)))

    def heights(self, flat: Array) -> Array:
        """Return the distance from this plane to the next plane.

        Parameters
        ----------
        flat : (n, 2) array
            Points of the plane, mm.

        Returns
        -------
        (n,) array
            Distances, mm.
        """
        heights: Array = self.height + flat @ self.slope
        return heights

    def for_sheet(self, flat: Array, sheet: float) -> AlongLayer:
        """Return this plane."""
        return self

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Return the x and y axes of the plane."""
        count = len(normals)
        return np.tile(self.pose[:3, 0], (count, 1)), np.tile(self.pose[:3, 1], (count, 1))


def between(guide: Guide, low: float, high: float, share: float = 0.5) -> AlongLayer:
    """Return the layer between two planes along a guide.

    Parameters
    ----------
    guide : Guide
        The guide.
    low, high : float
        Positions of the planes along the guide, mm.
    share : float, optional
        Fraction of the distance at which the layer is cut. The layer height is measured along the
        normal at this position.

    Returns
    -------
    AlongLayer
        The layer on the lower plane.
    """
    start, middle, top = (guide.frame(s) for s in (low, low + share * (high - low), high))
    height, slope = 0.0, np.zeros(2)
    for pose, sense in ((top, 1.0), (start, -1.0)):
        normal = pose[:3, 2]
        height += (
            sense * float((pose[:3, 3] - middle[:3, 3]) @ normal) / float(middle[:3, 2] @ normal)
        )
        slope -= sense * (normal @ middle[:3, :2]) / float(middle[:3, 2] @ normal)
    return AlongLayer(start, height, slope)


# cosine of the maximum angle between the planes at the ends of an edge; other edges are split
BENDS = np.cos(np.radians(10.0))
# fraction of the extent of a section; maximum distance of the guide from the convex hull of the
# section
MAX_OUTSIDE_SHARE = 0.02
HEIGHT = "LAYER_HEIGHT"


class AlongCuts(PlaneCuts):
    """Body prepared for sections by planes normal to the guide.

    `loops` returns points (m, 2) in the frames of the planes. The height of a vertex is the
    position of its plane along the guide, mm. Edges are split until planes change little along each
    edge. Raises InputError GUIDE_TIGHT.
    """

    def __init__(self, base: Base, body: Body) -> None:
        guide = base.surface
        assert isinstance(guide, Guide)
        points, triangles = base.inside(body.vertices), np.asarray(body.triangles, dtype=np.intp)
        was_split = True
        while was_split:
            distances = guide.distance(points)
            if (point := guide.crossing(points, triangles, distances)) is not None:
                raise InputError(
                    "GUIDE_TIGHT",
                    body.name,
                    "the guide bends more tightly at {} than the part is wide there: planes "
                    "normal to it intersect within the part, at {}; choose a guide nearer to the "
                    "inside of the bend or with a larger radius, or strategy.layers: geodesic",
                    base.where(guide.at(guide.distance(point[None]))[0][0]),
                    base.where(point),
                )
            normals = guide.at(distances)[1]

            def bends(ends: Index, normals: Array = normals) -> Mask:
                return np.asarray((normals[ends[0]] * normals[ends[1]]).sum(axis=1) < BENDS)

            points, triangles, was_split = split_edges(points, triangles, bends)
        super().__init__(np.column_stack([points[:, :2], distances]), triangles)
        self.guide, self.points = guide, points

    def _places(self, edge: Index, height: Array) -> Array:
        levels, level_index = np.unique(height, return_inverse=True)
        poses = np.stack([self.guide.frame(s) for s in levels.tolist()])[np.ravel(level_index)]
        below, above = (
            self.points[ends[edge]] - poses[:, :3, 3] for ends in (self._lower, self._upper)
        )
        height_below, height_above = (
            (offset * poses[:, :3, 2]).sum(axis=1) for offset in (below, above)
        )
        difference = np.where(
            np.abs(height_above - height_below) > 1e-12, height_above - height_below, 1.0
        )
        point = below + np.clip(-height_below / difference, 0.0, 1.0)[:, None] * (above - below)
        return np.asarray(np.stack([(point * poses[:, :3, k]).sum(axis=1) for k in (0, 1)], axis=1))


def slices(base: Base, bodies: Sequence[Body], strategy: SolidParameters) -> list[Slice]:
    """Return the layers of bodies on planes normal to a guide.

    The planes are at 0, h, 2 h ... mm along the guide.

    Parameters
    ----------
    base : Base
        The base with the guide.
    bodies : sequence of Body
        The bodies.
    strategy : SolidParameters
        Layer height, cut, margin and band.

    Returns
    -------
    list of Slice
        The layers in order.

    Raises
    ------
    InputError
        TOO_LOW, GUIDE_TIGHT, GUIDE_OUTSIDE.
    InfeasibleError
        LAYER_HEIGHT if a layer is higher or lower than `band` allows.
    """
    guide, height = base.surface, strategy.layer_height
    assert isinstance(guide, Guide)
    cuts = [AlongCuts(base, body) for body in bodies]
    top = max(cut.top for cut in cuts)
    layers = planes.count(top, strategy)
    if not layers:
        raise InputError(
            "TOO_LOW",
            "strategy.layer_height",
            "{:g} mm is too high for {}, {:.4g} mm long along the guide: no layer is cut in its "
            "{}; use at most {:.3g} mm",
            height,
            ", ".join(body.name for body in bodies),
            top,
            strategy.cut_at,
            0.99 * top / max(strategy.share_of_cut, 0.001),
        )
    layers_cut: list[Slice] = []
    for number, regions, issues in planes.cut_together(cuts, layers, strategy):
        surface = between(guide, number * height, (number + 1) * height, strategy.share_of_cut)
        layer = Slice(number, base, surface, regions, issues)
        # beyond the ends of the guide, slanted ends of the part may be beside the guide
        if guide.reaches((number + strategy.share_of_cut) * height):
            _refuse_outside(layer)
        layers_cut.append(layer._replace(heights=_heights(layer), share_before=number / layers))
    _refuse_uneven(layers_cut, strategy)
    return layers_cut


def _heights(layer: Slice) -> tuple[float, float, float]:
    """Return the minimum, mean and maximum height of a layer within its borders, mm."""
    surface, borders = layer.surface, [border for border, _ in layer.borders]
    assert isinstance(surface, AlongLayer)
    high = np.concatenate([surface.heights(border) for border in borders])
    area, moment = 0.0, np.zeros(2)
    for border in borders:
        following = np.roll(border, -1, axis=0)
        cross = border[:, 0] * following[:, 1] - border[:, 1] * following[:, 0]
        area += 0.5 * float(cross.sum())
        moment += (cross[:, None] * (border + following)).sum(axis=0) / 6.0
    mean = (
        float(surface.heights((moment / area)[None])[0]) if abs(area) > 0.0 else float(high.mean())
    )
    return float(high.min()), mean, float(high.max())


def _refuse_uneven(layers: Sequence[Slice], strategy: SolidParameters) -> None:
    """Raise InfeasibleError LAYER_HEIGHT at the maximum deviation if it exceeds `band`."""
    height, max_difference = (
        strategy.layer_height,
        strategy.band * strategy.layer_height + strategy.chord_error * 1e-3,
    )
    uneven = [
        layer
        for layer in layers
        if layer.heights
        and max(height - layer.heights[0], layer.heights[2] - height) > max_difference
    ]
    if not uneven:
        return
    worst = max(
        uneven,
        key=lambda layer: (
            max(height - layer.heights[0], layer.heights[2] - height) if layer.heights else 0.0
        ),
    )
    assert isinstance(worst.surface, AlongLayer) and worst.heights
    points = np.vstack([border for border, _ in worst.borders])
    off = worst.surface.heights(points) - height
    point = points[int(np.abs(off).argmax())]
    need = float(np.abs(off).max()) / height
    message = Text(
        "{} of {} layers deviate from the layer height: layer {} is {:.3g} to {:.3g} mm high, "
        "farthest off the {:g} mm at {}; strategy.band allows {:.3g} %, but {:.3g} % is needed; "
        "raise strategy.band, or choose a guide in the middle of the part or with a gentler bend",
        len(uneven),
        len(layers),
        worst.number,
        worst.heights[0],
        worst.heights[2],
        height,
        worst.where(point),
        100.0 * strategy.band,
        100.0 * need,
    )
    raise InfeasibleError(
        HEIGHT,
        f"{worst.base.name} layer {worst.number}",
        message,
        issues=(Issue(ERROR, HEIGHT, message, worst.number),),
    )


def _refuse_outside(layer: Slice) -> None:
    """Raise InputError GUIDE_OUTSIDE if the guide is outside the convex hull of the section.

    The guide intersects the plane at the origin of the plane.
    """
    from scipy.spatial import ConvexHull

    points = np.vstack([border for border, _ in layer.borders])
    hull = ConvexHull(points)
    distance = float(hull.equations[:, 2].max())
    if distance > MAX_OUTSIDE_SHARE * float(np.ptp(points, axis=0).max()):
        raise InputError(
            "GUIDE_OUTSIDE",
            "strategy.guide",
            "the guide leaves the part: at layer {} the guide is {:.3g} mm outside, at {}; "
            "choose a guide in the part or along one of its edges, or guide: auto",
            layer.number,
            distance,
            layer.where(np.zeros(2)),
        )
