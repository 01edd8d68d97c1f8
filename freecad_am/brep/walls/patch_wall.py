# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of any connected smooth faces, on any substrate, on the platform or from start edges.

Full tubes and open shells are supported, with openings and slanted ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import Part

from ...core.geometry.formatting import at_least, count, format_deviation, place
from ...core.geometry.mesh.coarsen import doubled_areas
from ...core.geometry.mesh.polygon import near_pairs
from ...core.geometry.mesh.triangle_mesh import closest
from ...core.geometry.step_count import step_count
from ...core.geometry.walls import contact
from ...core.geometry.walls.contact import TOUCH_MM, nearest_point
from ...core.geometry.walls.mesh_wall import connected_parts, find_rims, mark_ends, outward_volume
from ...core.geometry.walls.patch import SPLINE
from ...core.geometry.walls.patch_wall import FirstCurve, PatchWall
from ...core.geometry.walls.surface import dot
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array, Index, Mask
from ..shapes.tessellate import DEFLECTION, triangles_of
from .checks import refuse_creases, refuse_gaps, refuse_tight, smallest_radii
from .sheet import MAX_TRIANGLES, Substrate, sheet

SAMPLES = 9
DIGITS = 3  # decimals of mm; coincident edges of unsewn faces agree to this precision


def standing_edges(faces: Sequence[Any], lowest: float) -> list[Any]:
    """Return the free edges of faces that lie within TOUCH_MM of the platform.

    A free edge bounds only one face. lowest: Z of the platform, the lowest point of the faces, mm.
    """
    edges_by_key: dict[tuple[float, ...], list[Any]] = {}
    for face in faces:
        for edge in face.Edges:
            if edge.Degenerated or edge.isSeam(face):
                continue
            points = np.array(
                [tuple(edge.valueAt(t)) for t in np.linspace(*edge.ParameterRange, SAMPLES)]
            )
            if points[:, 2].max() < lowest + TOUCH_MM:
                key = np.round([*points[SAMPLES // 2], edge.Length], DIGITS) + 0.0
                edges_by_key.setdefault(tuple(key.tolist()), []).append(edge)
    return [edges[0] for edges in edges_by_key.values() if len(edges) == 1]


def stand(faces: Sequence[Any]) -> bool:
    """Whether faces have free edges on the platform."""
    vertices, _ = triangles_of(Part.Compound([face.copy(False) for face in faces]), DEFLECTION)
    return len(vertices) > 0 and bool(standing_edges(faces, float(vertices[:, 2].min())))


BENT, FOLDED = (
    0.3,
    -0.7,
)  # maximum cosines between the normals at the ends of an edge, and of a short section of it
STEPS, CLOSER = (
    np.linspace(0.0, 1.0, 33),
    4,
)  # samples of the normal along an edge (fractions), and number of refinements between samples
MAX_TESTED_CUTS, CLOSING_STEPS = (
    12,
    20,
)  # maximum number of triangle cuts to test, and of iterations to the crossing of the exact faces
CROSSING = 0.05  # rad; minimum angle of crossing faces; below, the faces are tangent or the same


def refuse_folded(wall: PatchWall, label: str) -> None:
    """Raise InputError SELF_INTERSECTION if a face folds back, flipping its normal abruptly."""
    for k, patch in enumerate(wall.patches):
        uv = wall.uv[wall.patch == k]
        if patch.kind != SPLINE or not len(uv):
            continue
        normal = patch.at(uv.reshape(-1, 2))[1].reshape(-1, 3, 3)
        start, end = uv, np.roll(uv, -1, axis=1)
        bent = dot(normal, np.roll(normal, -1, axis=1)) < BENT
        if not bent.any():
            continue
        start, end = start[bent], end[bent]
        # at a sharp nose the normal turns gradually under refinement; at a fold it always flips
        for _ in range(CLOSER):
            line = start[:, None] + STEPS[None, :, None] * (end - start)[:, None]
            normal = patch.at(line.reshape(-1, 2))[1].reshape(line.shape[:2] + (3,))
            plain = (patch.area(line.reshape(-1, 2)) > 1e-6).reshape(line.shape[:2])
            turn = np.where(plain[:, 1:] & plain[:, :-1], dot(normal[:, 1:], normal[:, :-1]), 1.0)
            sharpest = np.argmin(turn, axis=1)
            row = np.flatnonzero(turn.min(axis=1) < FOLDED)
            start, end = line[row, sharpest[row]], line[row, sharpest[row] + 1]
            if not len(row):
                break
        if len(row):
            raise InputError(
                "SELF_INTERSECTION",
                f"{label} {wall.faces[k]}",
                "the face folds back and intersects itself at {}; {}",
                place(patch.at(start[:1])[0][0]),
                FOLDS_TUBE if any(patch.periods) else FOLDS,
            )


FOLDS_TUBE = Text("use a bend radius larger than the tube radius")
FOLDS = Text(
    "redraw the face with a larger radius there, or divide it and deposit its parts in turn"
)
MIN_BEND_SHARE = (
    0.02  # minimum distance along the tube of crossing triangles in a bend, fraction of tube length
)


def _remedy(wall: PatchWall, triangles: tuple[int, int]) -> str:
    """Return the remedy for triangles of a wall that intersect."""
    patch, other_patch = (int(wall.patch[k]) for k in triangles)
    if patch != other_patch:
        return Text(
            "trim the faces at their intersection, or deposit the intersecting faces as separate "
            "features"
        )
    if _is_bend(wall, patch, triangles):
        return Text("use bend radii larger than the tube radius")
    return Text(
        "redraw the face without self-intersection, or divide it and deposit its parts in turn"
    )


def _is_bend(wall: PatchWall, patch: int, triangles: tuple[int, int]) -> bool:
    """Whether two crossing triangles are at different positions along a tube.

    A tube is a patch that is closed in one direction.
    """
    closed = np.array(wall.patches[patch].periods) > 0.0
    if closed.sum() != 1:
        return bool(closed.all())
    along = wall.uv[..., int(np.argmin(closed))]
    # triangles of a self-crossing skin overlap along the tube; triangles in a bend are far apart
    low, high = along[list(triangles)].min(axis=1), along[list(triangles)].max(axis=1)
    gap = low.max() - high.min()
    return bool(gap > MIN_BEND_SHARE * np.ptp(along[wall.patch == patch]))


def refuse_crossing(wall: PatchWall, label: str) -> None:
    """Raise InputError SELF_INTERSECTION if the wall intersects itself.

    Triangles that are not neighbours must cut each other, and the exact faces too.
    """
    corner = wall.vertices[wall.triangles]
    normal = doubled_areas(corner)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    middle = corner.mean(axis=1)
    reach = np.linalg.norm(corner - middle[:, None], axis=2).max(axis=1)
    for pairs in near_pairs(middle, reach):
        chord = middle[pairs[:, 1]] - middle[pairs[:, 0]]
        length = np.maximum(np.linalg.norm(chord, axis=1), 1e-300)
        # neighbours on a smooth wall are nearly coplanar
        odd = np.abs(dot(chord, normal[pairs[:, 0]])) > 0.3 * length
        odd |= dot(normal[pairs[:, 0]], normal[pairs[:, 1]]) < 0.7
        pairs = pairs[odd]
        shared = (
            wall.triangles[pairs[:, 0]][:, :, None] == wall.triangles[pairs[:, 1]][:, None, :]
        ).any(axis=(1, 2))
        pairs = pairs[~shared]
        for edge_triangles, cut_triangles in (pairs.T, pairs.T[::-1]):
            _refuse_cuts(wall, corner, normal, edge_triangles, cut_triangles, label)


def _refuse_cuts(
    wall: PatchWall,
    corner: Array,
    normal: Array,
    edge_triangles: Index,
    cut_triangles: Index,
    label: str,
) -> None:
    """Raise InputError SELF_INTERSECTION if edges of triangles cut the paired triangles.

    edge_triangles, cut_triangles: paired triangle indices (k,). The exact faces must cut too.
    """
    for k in range(3):
        start, end = corner[edge_triangles, k], corner[edge_triangles, (k + 1) % 3]
        a, b, c = (corner[cut_triangles, j] for j in range(3))
        low, high = dot(start - a, normal[cut_triangles]), dot(end - a, normal[cut_triangles])
        across = np.flatnonzero(low * high < 0.0)
        t = (low[across] / (low[across] - high[across]))[:, None]
        point = start[across] + t * (end[across] - start[across])
        cut = (
            closest(a[across], b[across], c[across], point)[0]
            < 1e-9 + 1e-9 * wall.mesh.longest_edge
        )
        for candidate in np.flatnonzero(cut)[:: max(1, int(cut.sum()) // MAX_TESTED_CUTS)]:
            faces = edge_triangles[across[candidate]], cut_triangles[across[candidate]]
            crossing = _crossing(wall, faces, point[candidate])
            if crossing is None:
                continue
            names = sorted({wall.faces[wall.patch[face]] for face in faces})
            raise InputError(
                "SELF_INTERSECTION",
                label,
                "the wall intersects itself at {} ({}); {}",
                place(crossing),
                Text.joined(" and ", names),
                _remedy(wall, faces),
            )


def _crossing(wall: PatchWall, triangles: tuple[int, int], point: Array) -> Array | None:
    """Return the point where the exact faces cross near the cut of two triangles at `point`.

    None if the exact faces do not cross there.
    """
    estimate = point[None]
    patches = [wall.patches[wall.patch[k]] for k in triangles]
    uv = [wall.uv[k].mean(axis=0)[None] for k in triangles]
    for _ in range(CLOSING_STEPS):
        uv = [patch.inverse(estimate, start) for patch, start in zip(patches, uv)]
        (foot, foot_normal), (other_foot, other_normal) = (
            patch.at(uv_point) for patch, uv_point in zip(patches, uv)
        )
        separation = float(np.linalg.norm(foot - other_foot))
        if separation < 1e-6 or np.linalg.norm(foot[0] - point) > 2.0 * wall.mesh.longest_edge:
            break
        # move to the intersection line of the two tangent planes, nearest to the estimate
        planes = np.stack([foot_normal[0], other_normal[0]])
        gap = np.array(
            [
                foot_normal[0] @ (foot[0] - estimate[0]),
                other_normal[0] @ (other_foot[0] - estimate[0]),
            ]
        )
        estimate = estimate + (np.linalg.pinv(planes, rcond=1e-3) @ gap)[None]
    steep = float(np.linalg.norm(np.cross(foot_normal[0], other_normal[0]))) > CROSSING
    return foot[0] if separation < 1e-6 and steep else None


EQUILATERAL_AREA = 0.433  # area of an equilateral triangle with side length 1
COARSE, SHARE = (
    4.0,
    0.04,
)  # edge length of the first mesh, for radii: fractions of layer height and wall size


def find_patch_wall(
    shape: Any,
    named: Sequence[tuple[str, Any]],
    substrate: Substrate | None,
    height: float,
    label: str = "part",
    start_edges: Sequence[str] = (),
) -> PatchWall:
    """Build the wall of the faces `named` of a shape, for layers of `height` mm.

    The wall starts from `start_edges`, or else from every curve in which it leaves the substrate,
    or without a substrate from its edges on the platform. An issue locates several start curves.

    Raises InputError GAP, CREASE, BRANCHING_FACES, SELF_INTERSECTION, LAYER_HEIGHT, ROUGH_WALL,
    TOO_FINE, NOT_ORIENTABLE, NO_CONTACT, INSIDE, NO_START, UNKNOWN_EDGE.
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
    """Return the first curves along edges on the platform, and a note.

    Raises InputError NO_SUBSTRATE if no edge is on the platform.
    """
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
    """Return a note if a wall has several first curves."""
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
    """Raise InputError TOO_FINE if a mesh with edges of a layer height exceeds MAX_TRIANGLES."""
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
    """Return the maximum mesh edge length, mm: a quarter of the minimum radius of the wall.

    The length is limited to between 0.25 and 1 layer heights.
    """
    # take radii from a coarse mesh, because a fine mesh of a tightly bent surface takes long
    radius = float(smallest_radii(sound(named, label, COARSE * height))[0].min())
    return float(np.clip(0.25 * radius, 0.25 * height, height))


def sound(named: Sequence[tuple[str, Any]], label: str, edge: float = 0.0) -> PatchWall:
    """Return a coarse mesh of the faces, checked for self-intersection.

    Mesh edges are at most `edge` mm or a fraction of the faces' size. Raises InputError
    SELF_INTERSECTION, and the errors of `sheet`.
    """
    size = Part.Compound([face for _, face in named]).BoundBox.DiagonalLength
    coarse = sheet(named, max(edge, SHARE * size), label)
    refuse_folded(coarse, label)
    refuse_crossing(coarse, label)
    return coarse


def _outward(wall: PatchWall, shape: Any) -> PatchWall:
    """Orient the wall outwards: as the faces of a solid, or away from the enclosed volume."""
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
    """Return the curves where a wall leaves its substrate, vertices behind them, and notes.

    The vertices are given as a mask (n,). Raises InputError NO_CONTACT, INSIDE, OWN_SUBSTRATE.
    """
    ground = substrate.ground(wall.mesh.typical_edge)
    value = contact.ground_distances(wall, ground)
    if np.abs(value).max() < contact.TOUCH_MM + getattr(
        wall, "smoothing", 0.0
    ):  # the smooth surface of a mesh wall deviates from the mesh by `smoothing`
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
            "the wall does not touch {}: the nearest point of the wall is {}, {:.4g} mm away; "
            "extend the wall to within {:g} mm of the substrate",
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
            "the wall is entirely inside {} (smallest depth at {}: {:.4g} mm); extend one end "
            "outside the substrate",
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
            "{:.2g} mm); extend the wall into the substrate all around, or choose start edges",
            substrate.label,
            wall.mesh.typical_edge,
        )
    message = Text("the first layer follows the intersection of the wall and {}", substrate.label)
    if ground.facets:
        message += (
            Text(
                "; between the mesh edges the curve is smoothed by up to {} mm, about the error "
                "of the mesh",
                format_deviation(off),
            )
            if off > 0.0
            else ""
        )
    else:
        message += Text(" within {} mm", format_deviation(off))
    return curves, value < 0.0, [Issue(NOTE, "FIRST_LAYER", message)]


def _stays_in(wall: PatchWall, outside: Mask, substrate: Substrate) -> Mask:
    """Return a mask of vertices in wall parts to drop, such as a stub in the bore of a pipe.

    Such a part is outside the substrate but never leaves the substrate's bounding box. Nothing is
    dropped unless another part leaves the box.
    """
    low, high = substrate.solid.vertices.min(axis=0), substrate.solid.vertices.max(axis=0)
    leaves = ((wall.vertices < low - 1e-3) | (wall.vertices > high + 1e-3)).any(axis=1)
    count, component = connected_parts(wall, outside)
    goes = np.zeros(count, dtype=bool)
    goes[component[outside & leaves]] = True
    dropped = outside.copy()
    dropped[outside] = not_kept = ~goes[component[outside]]
    return dropped if goes.any() and not_kept.any() else np.zeros(len(outside), dtype=bool)


# ---- Part edges selected as the first layer

ON_WALL = 1e-3  # mm; maximum distance of a start edge from the wall
NODE_TOLERANCE_MM = 1e-5  # mm; maximum deviation between nodes, tested at THIRDS of each arc
THIRDS = np.array([1.0 / 3.0, 2.0 / 3.0])
ROUNDS = 12
SMOOTH = np.radians(1.0)  # minimum angle of a corner between edges


def curves_of(shape: Any, names: Sequence[str], wall: PatchWall, label: str) -> list[FirstCurve]:
    """Return the chains and loops of the named edges, projected onto the wall.

    Raises InputError UNKNOWN_EDGE; NO_START for an edge off the wall.
    """
    edges = []
    for name in dict.fromkeys(names):
        number = int(name.removeprefix("Edge")) if name.removeprefix("Edge").isdigit() else 0
        if not 1 <= number <= len(shape.Edges):
            raise InputError(
                "UNKNOWN_EDGE",
                label,
                "the shape has no {}; choose an edge from Edge1 to Edge{}",
                name,
                len(shape.Edges),
            )
        edge = shape.Edges[number - 1]
        points = np.array([tuple(edge.valueAt(t)) for t in np.linspace(*edge.ParameterRange, 9)])
        off = np.linalg.norm(wall.project(points)[0] - points, axis=1)
        if off.max() > ON_WALL:
            raise InputError(
                "NO_START",
                f"{label} {name}",
                "the edge is {:.4g} mm off the wall at {}; choose edges of the wall faces",
                off.max(),
                place(points[np.argmax(off)]),
            )
        edges.append(edge)
    return curves_along(edges, wall)


def curves_along(edges: Sequence[Any], wall: PatchWall) -> list[FirstCurve]:
    """Return the chains and loops of edges of the wall faces."""
    return [_curve(chain, wall) for chain in Part.sortEdges(list(edges))]


def _curve(chain: list[Any], wall: PatchWall) -> FirstCurve:
    wire = Part.Wire(chain)
    closed = bool(wire.isClosed())
    rows = [sampled(edge, wall.mesh.typical_edge) for edge in wire.OrderedEdges]
    nodes = np.vstack([points[:-1] for points, _ in rows])
    departures = np.vstack([along[:-1] for _, along in rows])
    arrivals = [along[-1:] for _, along in rows]
    starts = [arrivals[-1] if closed else rows[0][1][:1], *arrivals[:-1]]
    incoming = np.vstack(
        [np.vstack([start, along[1:-1]]) for start, (_, along) in zip(starts, rows)]
    )
    if not closed:
        nodes = np.vstack([nodes, rows[-1][0][-1:]])
        incoming, departures = (
            np.vstack([incoming, arrivals[-1]]),
            np.vstack([departures, arrivals[-1]]),
        )
    smooth = np.einsum("ij,ij->i", incoming, departures) > np.cos(SMOOTH)
    incoming[smooth] = departures[smooth]
    return FirstCurve(wall.project(nodes)[0], incoming, departures, closed)


def sampled(edge: Any, step: float) -> tuple[Array, Array]:
    """Sample points and unit tangents (n, 3) along an edge, in the direction of the edge.

    The spacing is at most about `step` mm. The arcs between points deviate from the edge by at most
    NODE_TOLERANCE_MM.
    """
    low, high = edge.ParameterRange
    count = step_count(edge.Length, step, 8) + 1
    t = np.linspace(low, high, count)
    if edge.Orientation == "Reversed":
        t = t[::-1]
    for _ in range(ROUNDS):
        points, along = _nodes(edge, t)
        between = (t[:-1, None] + np.diff(t)[:, None] * THIRDS).ravel()
        inner = np.array([tuple(edge.valueAt(parameter)) for parameter in between.tolist()])
        off = (
            FirstCurve(points, along, along, False)
            .curve()
            .nearest(inner)[0]
            .reshape(-1, len(THIRDS))
            .max(axis=1)
        )
        bad = np.flatnonzero(off > NODE_TOLERANCE_MM)
        if not len(bad):
            break
        t = np.insert(t, bad + 1, 0.5 * (t[bad] + t[bad + 1]))
    return _nodes(edge, t)


def _nodes(edge: Any, t: Array) -> tuple[Array, Array]:
    """Return points and unit tangents (n, 3) at parameters (n,), tangents in parameter order."""
    points = np.array([tuple(edge.valueAt(parameter)) for parameter in t.tolist()])
    along = np.array([tuple(edge.Curve.tangent(parameter)[0]) for parameter in t.tolist()])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return points, -along if (points[1] - points[0]) @ along[0] < 0.0 else along
