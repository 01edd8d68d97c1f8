# SPDX-License-Identifier: LGPL-2.1-or-later
"""A predicted deposit against the part: how far it reaches beyond each place of the faces, and whether that is enough."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.columns import dots
from ...geometry.fitted import PredictedShape
from ...geometry.formatting import place
from ...issues import WARNING, Issue, Text, Word
from ...types import Array, Index, Mask
from .faces import Faces
from .grid import Grid
from .laying import PredictedDeposit

CODE, DRIFT = "ALLOWANCE", "LAYER_DRIFT"
MUCH = 0.5  # of a layer height: layers that end farther off than this are told
KNOWN = 0.25  # of a cube's edge, to which a surface is known
HALF = 0.5  # of a cube: the surface runs where it is half full
STEP = 0.5  # of a cube's edge, between places that are asked along a normal
REACH = 2.0  # widths and layer heights that the deposit is looked for, outwards and inwards
STANDS = 0.25  # layer heights above where a first layer begins, up to which a face that looks down stands there
DOWN = 0.5  # cosine against the build direction of such a face
KNOWN_WIDTHS = (
    1.5  # widths from a first layer's bead, beyond which nothing is known of what it stands on
)
AT_ONCE = 4_000


@dataclass(frozen=True, eq=False)
class Compared:
    """faces: the places that are to be covered. deviation: (n,) mm that the deposit reaches beyond them along their normals,
    less than 0 where the part sticks out; of open faces on the side where it is less. bare: (n,) where there is none within
    `reach` mm, which deviations are cut off at. piece: (n,) of the deposit's pieces the nearest one."""

    faces: Faces
    deviation: Array
    bare: Mask
    reach: float
    piece: Index

    @property
    def surface(self) -> Array:
        """(n, 3) mm, the places of the deposit's surface that were met."""
        found: Array = self.faces.points + self.deviation[:, None] * self.faces.normals
        return found


def compared(of: PredictedDeposit, faces: Faces) -> Compared:
    """The deposit from all faces, but those on which the part stands and what lies below where it begins."""
    pieces = of.pieces
    kept = faces.rows(_to_be_covered(of, faces))
    reach = REACH * (float(pieces.width.max()) + float(pieces.height.max()))
    out, bare = _reached(of.grid, kept.points, kept.normals, reach)
    if kept.open.any():
        other, other_bare = _reached(of.grid, kept.points, -kept.normals, reach)
        less = kept.open & (other < out)
        turned = np.where(less[:, None], -kept.normals, kept.normals)
        kept = Faces(kept.points, turned, kept.areas, kept.open)
        out, bare = np.where(less, other, out), np.where(less, other_bare, bare)
    piece = (
        np.asarray(cKDTree(pieces.middle).query(kept.points)[1])
        if len(kept)
        else np.zeros(0, dtype=np.intp)
    )
    return Compared(kept, out, bare, reach, piece)


def _to_be_covered(of: PredictedDeposit, faces: Faces) -> Mask:
    """Which places are not below a first layer, nor on faces that stand on what that lies on."""
    begins = of.pieces.rows(np.flatnonzero(of.pieces.first))
    away, near = cKDTree(begins.middle).query(faces.points)
    build, height = begins.build[near], begins.height[near]
    up = dots(faces.points - begins.middle[near], build)
    adjacent = np.sqrt(np.maximum(away * away - up * up, 0.0)) < KNOWN_WIDTHS * begins.width[near]
    down = dots(faces.normals, build) < -DOWN
    below = adjacent & ((up < -STANDS * height) | ((up < STANDS * height) & down))
    found: Mask = ~below
    return found


def _reached(grid: Grid, points: Array, normals: Array, reach: float) -> tuple[Array, Mask]:
    """How far (n,) mm the deposit reaches from points (n, 3) along unit normals, to where it first ends; where there is none
    at a point, less than 0, by how far it is away, inwards along the normal or nearer aside. And where there is none within
    `reach` mm."""
    count = int(np.ceil(reach / (STEP * grid.edge)))
    steps = np.linspace(0.0, reach, count + 1)
    found, bare = np.empty(len(points)), np.zeros(len(points), dtype=bool)
    full = cKDTree(grid.centres(np.flatnonzero(grid.filled >= HALF)))
    for start in range(0, len(points), AT_ONCE):
        rows = slice(start, start + AT_ONCE)
        inside = grid.at(points[rows]) >= HALF
        way = np.where(inside, 1.0, -1.0)
        length = _first_change(grid, points[rows], way[:, None] * normals[rows], steps, inside)
        away = np.minimum(
            np.asarray(full.query(points[rows], distance_upper_bound=reach + grid.edge)[0]),
            reach + grid.edge,
        )
        length = np.where(
            inside, length, np.minimum(length, np.maximum(away - 0.5 * grid.edge, 0.0))
        )
        found[rows], bare[rows] = way * length, ~inside & (length >= reach)
    return found, bare


def _first_change(grid: Grid, points: Array, ways: Array, steps: Array, inside: Mask) -> Array:
    """Distance (n,) mm along ways at which the deposit begins or ends; the last step where it does neither."""
    length = np.full(len(points), steps[-1])
    left = np.arange(len(points))
    before = grid.at(points)
    for near, far in zip(steps[:-1], steps[1:], strict=True):
        now = grid.at(points[left] + far * ways[left])
        changed = (now >= HALF) != inside[left]
        rows = left[changed]
        share = (HALF - before[changed]) / (now[changed] - before[changed])
        length[rows] = near + share * (far - near)
        left, before = left[~changed], now[~changed]
        if not len(left):
            break
    return length


def figures(of: PredictedDeposit, found: Compared, allowance: float) -> PredictedShape:
    """What it comes to, for an allowance of so many mm on all faces. ValueError without faces to be covered."""
    if not len(found.faces):
        raise ValueError("there are no faces to be covered")
    area, worst = found.faces.areas, int(found.deviation.argmin())
    whole, known = float(area.sum()), KNOWN * of.grid.edge
    pieces, piece = of.pieces, found.piece[worst]

    def share(some: Mask) -> float:
        return float(area[some].sum()) / whole

    return PredictedShape(
        of.fed,
        of.deposited,
        of.grid.edge,
        of.drift,
        allowance,
        len(area),
        float(found.deviation[worst]),
        float(found.deviation @ area) / whole,
        float(found.deviation.max()),
        share(found.deviation < allowance - known),
        share(found.deviation < -known),
        share(found.bare),
        found.reach,
        found.faces.points[worst],
        int(pieces.layer[piece]),
        int(of.bead_in_layer[piece]),
        int(pieces.point[piece]),
    )


def issues(
    found: PredictedShape,
    layer_heights: Array,
    first: Mask,
    remedy: str,
    courses: Array | None = None,
) -> tuple[Issue, ...]:
    """That layers come out higher or lower than they are planned, and that the part is not inside the predicted deposit by
    the allowance. layer_heights: (layers,) mm; first: (layers,) of those that nothing of their feature lies below. remedy:
    what to do where the deposit is too small, with {} for by how much. courses: (layers,) turns that lie one over the other
    within a layer, 1 of all but spirals."""
    courses = np.ones(len(layer_heights)) if courses is None else courses
    drifts, low = _drift(found.drift, layer_heights, first, courses)
    if found.short <= 0.0:
        return drifts
    lacks = found.allowance - found.least
    if found.least <= -found.reach:
        text = Text("there is none within {:.3g} mm", found.reach)
    elif found.least < 0.0:
        text = Text("the part sticks out by {:.3g} mm", -found.least)
    else:
        text = Text("{:.3g} mm are left to machine", found.least)
    # where layers come out low more would be needed everywhere
    remedy = "Lay layers as high as they come out first" if low else Text(remedy, f"{lacks:.3g}")
    return (
        *drifts,
        Issue(
            WARNING,
            CODE,
            Text(
                "on {:.3g} % of the faces the predicted deposit does not reach {:g} mm beyond the part, on "
                "{:.3g} % it ends within the part: at {} {}. {}",
                100.0 * found.short,
                found.allowance,
                100.0 * found.outside,
                place(found.worst),
                Word(text),
                remedy,
            ),
            found.layer,
            found.bead,
            found.point,
        ),
    )


def _drift(
    drift: Array, layer_heights: Array, first: Mask, courses: Array
) -> tuple[tuple[Issue, ...], bool]:
    """That layers end farther above or below where the next should begin than MUCH of their height, at the worst one, and
    whether it is below."""
    off = np.nan_to_num(drift) / layer_heights
    worst = int(np.abs(off).argmax()) if len(off) else 0
    if not len(off) or abs(off[worst]) <= MUCH:
        return (), False
    lowest = int(np.flatnonzero(first[: worst + 1])[-1]) if first[: worst + 1].any() else 0
    made = layer_heights[worst] + drift[worst] / courses[lowest : worst + 1].sum()
    way = "below" if drift[worst] < 0.0 else "above"
    return (
        Issue(
            WARNING,
            DRIFT,
            Text(
                "this layer is predicted to end {:.3g} mm {} where the next one should begin: up to here "
                "layers come out {:.3g} mm high in the mean, and {:g} mm are planned; set strategy.layer_height to {:.3g} mm, "
                "or change what the wire feeds",
                abs(drift[worst]),
                Word(way),
                made,
                layer_heights[worst],
                made,
            ),
            worst,
        ),
    ), bool(drift[worst] < 0.0)
