# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of curved layers: by the way through the part from where it stands (geodesic), or straight from there
(offset)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..geometry.on_hub import Base
from ..geometry.solid_mesh import Search, SolidMesh
from ..geometry.surroundings import Body
from ..issues import NOTE, WARNING, InputError, Issue
from ..parameters.strategy import SolidParameters
from .chart_layer import ChartLayer
from .geodesic import GeodesicField, Piece, field
from .margins import BORDER
from .surface import Array, Slice

FINE, COARSE = 0.4, 0.8  # layer heights from node to node: as a rule, at most
MOST = 2_000_000  # nodes, where that keeps below COARSE
STANDING = 0.05  # layer heights from the plane or the substrate; facets so near to it stand there
LOST = 0.002  # share of a part that no way need lead to: rounding at corners
TOLD = 0.05  # distortion of a piece that is told


def slices(base: Base, bodies: Sequence[Body], ground: Sequence[Body], strategy: SolidParameters) -> Iterator[Slice]:
    """The layers of bodies outwards from the plane of the base and the `ground` that they touch; several of one number where
    a layer is in pieces. InputError TOO_FINE, NOT_STANDING, NOT_CONNECTED."""
    _refuse(strategy)
    solids = [SolidMesh(base.inside(body.vertices), np.asarray(body.triangles, dtype=np.intp)) for body in bodies]
    found = _field(solids, [base.inside(body.vertices)[body.triangles] for body in ground], bodies, strategy)
    worst = 0.0
    height, cut = strategy.layer_height, max(strategy.share_of_cut, 1e-3)
    number = int(np.ceil(found.top / height - cut + 1e-6))
    for layer in range(max(number, 0)):
        for piece in found.pieces((layer + cut) * height):
            issues: tuple[Issue, ...] = ()
            if piece.stretch > max(worst, TOLD):
                worst = piece.stretch
                issues = (_stretched(piece, layer),)
            regions = tuple(region.simple(BORDER * found.grid.step) for region in piece.regions)
            yield Slice(layer, ChartLayer(piece.chart, found, layer * height), regions, issues)


def _refuse(strategy: SolidParameters) -> None:
    """InputError NOT_FOR_FAMILY for what only plane layers have."""
    for key, given, instead in (
        ("margin", strategy.margin != 0.0, "0 mm"), ("solid_layers", strategy.solid_layers != 0, "0"),
    ):
        if given:
            raise InputError(
                "NOT_FOR_FAMILY", f"strategy.{key}", f"it is for plane layers, not for curved ones; use {instead}, or "
                "layers: planes",
            )


def _field(
    solids: Sequence[SolidMesh], ground: Sequence[Array], bodies: Sequence[Body], strategy: SolidParameters
) -> GeodesicField:
    name = bodies[0].name if len(bodies) == 1 else f"{len(bodies)} solids"
    step = _step(sum(one.volume for one in solids), name, strategy)
    start = np.concatenate([_standing(one, ground, STANDING * strategy.layer_height) for one in solids])
    try:
        found = field(solids, start, step, through=strategy.layers == "geodesic")
    except ValueError:
        raise InputError(
            "NOT_STANDING", name, "no face of it lies on the plane through its lowest place along strategy.direction, or "
            "on the substrate, so that there is nothing to begin on; turn the part, set strategy.direction, or give a "
            "substrate that it touches",
        ) from None
    if found.lost > LOST:
        raise InputError(
            "NOT_CONNECTED", name, f"{100.0 * found.lost:.3g} % of it hang together with nothing that stands on the "
            "platform or the substrate; deposit these by themselves, or set strategy.direction",
        )
    return found


def _step(volume: float, name: str, strategy: SolidParameters) -> float:
    """Mm from node to node. InputError TOO_FINE."""
    height = strategy.layer_height
    step = max(FINE * height, float(np.cbrt(volume / MOST)))
    if step > COARSE * height:
        raise InputError(
            "TOO_FINE", "strategy.layer_height", f"{height:g} mm is too fine for curved layers of {name}, "
            f"{volume / 1000.0:.4g} cm3; give at least {step / COARSE:.2g} mm, or layers: planes",
        )
    return step


def _standing(solid: SolidMesh, ground: Sequence[Array], near: float) -> Array:
    """The triangles (k, 3, 3) of a solid that lie on the plane z = 0 facing down, or on triangles of the ground."""
    corners = solid.vertices[solid.triangles]
    chosen = (np.abs(corners[:, :, 2]) < near).all(axis=1) & (solid.units[:, 2] < -0.5)
    for triangles in ground:
        low, high = triangles.min(axis=(0, 1)) - near, triangles.max(axis=(0, 1)) + near
        asked = np.flatnonzero(((corners > low) & (corners < high)).all(axis=(1, 2)))
        if len(asked):
            under = SolidMesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))
            away = np.abs(Search(under, 4.0 * near).signed(corners[asked].reshape(-1, 3))[0]).reshape(-1, 3)
            chosen[asked[(away < near).all(axis=1)]] = True
    found: Array = corners[chosen]
    return found


def _stretched(piece: Piece, layer: int) -> Issue:
    share = 100.0 * piece.stretch
    return Issue(
        NOTE if piece.stretch <= 3.0 * TOLD else WARNING, "DISTORTED", "a curved layer cannot be laid flat without "
        f"distortion: beads are up to {share:.2g} % nearer together or farther apart than the bead spacing", layer,
    )
