# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls from triangle meshes, open or closed: repair, even meshing, smooth surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from ...issues import NOTE, InputError, Issue, Text
from ...types import Array, Index, Mask
from ..formatting import format_deviation, place
from ..mesh.coarsen import SmoothMesh, collapse_edges, doubled_areas
from ..mesh.edge_runs import runs
from ..mesh.near_triangles import find_crossings, remove_crossings
from ..mesh.refine import Edges, boundary, flip_edges, refine_mesh
from ..mesh.repair import WELDS_MM, connected_triangles, mended_issues
from ..mesh.solid import Search, SolidMesh
from ..mesh.triangle_mesh import Mesh
from .patch_wall import CladFaces, FirstCurve, PatchWall, Rim
from .surface import dot

REACHED = 0.75  # fraction of a rim along which layers must approach for the rim to be an end


def find_rims(wall: PatchWall) -> tuple[Rim, ...]:
    """Return all rims of a wall, none of them marked as an end."""
    ends, _ = boundary(wall.triangles)
    if not len(ends):
        return ()
    rims = []
    for members, forward, closed in runs(wall.vertices, ends):
        pairs = np.where(forward[:, None], ends[members], ends[members][:, ::-1])
        if closed:
            pairs = np.vstack([pairs])
        rims.append(Rim(wall.vertices[np.r_[pairs[:, 0], pairs[-1, 1]]], False))
    return tuple(rims)


def mark_ends(
    wall: PatchWall, rims: tuple[Rim, ...], start_curves: tuple[FirstCurve, ...], behind: Mask
) -> tuple[Rim, ...]:
    """Mark the rims at which layers finish.

    A rim is an end unless it is behind the start curves, contains an end of a start curve (a side),
    runs along a start curve, or bounds an opening. Layers close again beyond an opening: on more
    than a quarter of its rim, the distance from the start curves, measured along the wall,
    increases away from the rim.

    Parameters
    ----------
    wall : PatchWall
        Wall with n vertices.
    rims : tuple of Rim
        Rims of the wall.
    start_curves : tuple of FirstCurve
        Curves in which layers start.
    behind : (n,) bool array
        Vertices on the substrate side of the start curves.

    Returns
    -------
    tuple of Rim
        Rims with their `end` flags.
    """
    distance = _distance(wall, start_curves, behind)
    beyond = distance.max(initial=0.0, where=np.isfinite(distance))
    tree = cKDTree(wall.vertices)
    inside = _inner_mean(wall, distance)
    near_distance = 1.5 * wall.mesh.longest_edge
    starts = [
        end
        for curve in start_curves
        if not curve.closed
        for end in (curve.points[0], curve.points[-1])
    ]
    marked = []
    for rim in rims:
        vertex = tree.query(rim.points)[1]
        open_ = ~behind[vertex]
        side = any(
            np.linalg.norm(rim.points - end, axis=1).min() < near_distance
            and _leads_away(rim, end, near_distance)
            for end in starts
        )
        start = open_.any() and float(distance[vertex][open_].mean()) < near_distance
        rises = np.where(
            np.isfinite(inside[vertex]), distance[vertex] > inside[vertex] - 1e-9, True
        )
        end = bool(
            open_.mean() > 0.5
            and not side
            and not start
            and rises[open_].mean() > REACHED
            and beyond > 0.0
        )
        marked.append(replace(rim, end=end))
    return tuple(marked)


def _leads_away(rim: Rim, point: Array, near_distance: float) -> bool:
    """Return whether a rim extends away from a point, rather than being a short piece near it."""
    return bool(np.linalg.norm(rim.points - point, axis=1).max() > 2.0 * near_distance)


def _distance(wall: PatchWall, start_curves: tuple[FirstCurve, ...], behind: Mask) -> Array:
    """Return the shortest distances (n,) along the mesh from the start curves; inf behind them."""
    edges = Edges(wall.triangles).ends
    edges = edges[~behind[edges].any(axis=1)]
    length = np.linalg.norm(wall.vertices[edges[:, 0]] - wall.vertices[edges[:, 1]], axis=1)
    count = len(wall.vertices)
    graph = coo_matrix((length, (edges[:, 0], edges[:, 1])), shape=(count, count)).tocsr()
    ahead = np.flatnonzero(~behind)
    if not start_curves or not len(ahead):
        return np.full(count, np.inf)
    points = np.vstack([curve.points for curve in start_curves])
    sources = np.unique(ahead[cKDTree(wall.vertices[ahead]).query(points)[1]])
    distances: Array = dijkstra(graph, directed=False, indices=sources, min_only=True)
    return distances


def _inner_mean(wall: PatchWall, distance: Array) -> Array:
    """Return the mean `distance` (n,) of each vertex's neighbours that are not on a boundary."""
    rim = np.zeros(len(distance), dtype=bool)
    rim[boundary(wall.triangles)[0]] = True
    ends = Edges(wall.triangles).ends
    ends = np.concatenate([ends, ends[:, ::-1]])
    ends = ends[~rim[ends[:, 1]] & np.isfinite(distance[ends[:, 1]])]
    total = np.bincount(ends[:, 0], weights=distance[ends[:, 1]], minlength=len(distance))
    count = np.bincount(ends[:, 0], minlength=len(distance))
    return np.where(count > 0, total / np.maximum(count, 1), np.inf)


def connected_parts(wall: PatchWall, members: Mask) -> tuple[int, Index]:
    """Return the connected parts of a set of vertices along mesh edges.

    Parameters
    ----------
    wall : PatchWall
        Wall with n vertices.
    members : (n,) bool array
        The vertices.

    Returns
    -------
    count : int
        Number of parts.
    part : (n,) int array
        Part index of each vertex; -1 for vertices that are not members.
    """
    edges = Edges(wall.triangles).ends
    edges = edges[members[edges].all(axis=1)]
    count = len(members)
    graph = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    labels = np.full(count, -1, dtype=np.intp)
    _, labels[members] = np.unique(label[members], return_inverse=True)
    return int(labels.max(initial=-1)) + 1, labels


def outward_volume(wall: PatchWall) -> float:
    """Return the enclosed volume (mm3) after closing each boundary with a fan about its centroid.

    The volume is negative if the wall's outer side faces inwards, and zero if the wall encloses
    nothing.
    """
    corners = wall.vertices[wall.triangles]
    origin = wall.vertices[0]
    total = _cones(corners - origin)
    ends, _ = boundary(wall.triangles)
    if len(ends):
        count = len(wall.vertices)
        graph = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
        loop = connected_components(graph, directed=False)[1][ends[:, 0]]
        for rim_number in np.unique(loop):
            pair = wall.vertices[ends[loop == rim_number]]
            middle = np.broadcast_to(pair.mean(axis=(0, 1)), (len(pair), 3))
            total += _cones(np.stack([pair[:, 1], pair[:, 0], middle], axis=1) - origin)
    return total


def _cones(corners: Array) -> float:
    return float(dot(corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0)


MAX_TRIANGLES = 1_500_000  # maximum number of triangles of a wall
COLLAPSE = 0.55  # of the maximum edge; shorter edges are collapsed
CREASE = np.cos(
    np.radians(20.0)
)  # facets at a larger angle belong to separate areas, whose edges do not move
PLANE = np.cos(
    np.radians(3.0)
)  # stricter limit for facets larger than mesh edges, used if edges cut across creases
MAX_BETWEEN_SHARE = 0.05  # of the edge length; larger deviations from the facets need finer areas
FOLD = 0.25  # rad between facets; a bend radius below four edges, too sharp for the mesh
BLOCK_SIZE = 1000  # points per batch; bounds the memory
REPORTED_FROM_MM = 0.02  # mm; larger deviations between mesh and smooth surface are reported


@dataclass(frozen=True, eq=False)
class MeshWall(PatchWall):
    """A wall whose only piece is the smooth surface through a mesh.

    samples: (n, 3) original positions of the vertices on the facets, mm. between: maximum deviation
    of the surface from the facets at triangle centroids, mm.
    """

    kind: ClassVar[str] = "mesh"

    samples: Array | None = None
    between: float = 0.0

    @cached_property
    def smooth(self) -> SmoothMesh:
        """The smooth surface."""
        samples = self.vertices if self.samples is None else self.samples
        return SmoothMesh(samples, self.triangles, self.mesh.typical_edge)

    @property
    def smoothing(self) -> float:
        """Return the maximum deviation of the smooth surface from the mesh, mm."""
        at_vertices = (
            0.0
            if self.samples is None
            else float(np.linalg.norm(self.vertices - self.samples, axis=1).max())
        )
        return max(at_vertices, self.between)

    @property
    def mesh_vertices(self) -> int:
        """Return the number of vertices."""
        return len(self.vertices)

    @property
    def folds(self) -> float:
        """Total length of sharp edges in the deposited part of the wall, mm."""
        ahead = self.triangles[~self.behind[self.triangles].any(axis=1)]
        return Mesh(self.vertices, ahead).folded(FOLD)

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Project points onto the smooth surface, which extends slightly beyond the wall."""
        points, normals = self.smooth.project(points)
        return points, normals, np.zeros(len(points), dtype=np.intp)


class _Read(NamedTuple):
    vertices: Array
    triangles: Index
    issues: tuple[Issue, ...]


def mesh_wall(points: Array, triangles: Index, edge: float, label: str, mend: float) -> MeshWall:
    """Build the smooth wall through a mesh, without start curves.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    triangles : (m, 3) int array
        Triangles.
    edge : float
        Edge length of the new mesh, mm.
    label : str
        Name of the wall, for messages.
    mend : float
        Maximum size of a hole to close, mm; see `repair.connected_triangles`.

    Returns
    -------
    MeshWall
        The wall.

    Raises
    ------
    InputError
        BAD_FILE, NO_SOLID, SELF_INTERSECTION, TOO_FINE.
    """
    source = _read(points, triangles, label, mend)
    facets = SolidMesh(source.vertices, source.triangles).searched(edge)
    wall = _mesh_wall(source, _areas(source.vertices, source.triangles), facets, edge, label)
    if (
        wall.between > MAX_BETWEEN_SHARE * edge
    ):  # mesh edges cut across a valley or a ridge of large facets
        finer_areas = _mesh_wall(
            source, _areas(source.vertices, source.triangles, edge), facets, edge, label
        )
        wall = finer_areas if finer_areas.between < wall.between else wall
    max_offset = wall.smoothing
    if max_offset <= REPORTED_FROM_MM or wall.samples is None:
        return wall
    farthest = wall.samples[np.argmax(np.linalg.norm(wall.vertices - wall.samples, axis=1))]
    return replace(
        wall,
        issues=(
            *wall.issues,
            Issue(
                NOTE,
                "SMOOTHED",
                Text(
                    "{}: the wall is smoothed across facets, by up to {} mm, at {}",
                    label,
                    format_deviation(max_offset),
                    place(farthest),
                ),
            ),
        ),
    )


def _mesh_wall(source: _Read, owner: Index, facets: Search, edge: float, label: str) -> MeshWall:
    """Build the smooth wall through facets with the area indices `owner` (m,).

    Raises InputError TOO_FINE.
    """
    mesh = refine_mesh(
        source.vertices,
        source.triangles,
        owner,
        edge,
        lambda middles, adjacent, ends: middles,
        MAX_TRIANGLES,
    )
    if mesh is None:
        mesh = refine_mesh(
            source.vertices,
            source.triangles,
            owner,
            edge,
            lambda middles, adjacent, ends: middles,
            MAX_TRIANGLES,
            flip=False,
        )
    if mesh is None:
        raise InputError(
            "TOO_FINE",
            label,
            "with edges of {:.3g} mm, the layer height, the wall mesh needs more than {} "
            "triangles; use a larger layer height, or deposit the wall in parts",
            edge,
            MAX_TRIANGLES,
        )
    vertices, corners, owner = mesh
    corners, owner = collapse_edges(vertices, corners, owner, COLLAPSE * edge, edge)
    corners = flip_edges(vertices, corners, owner)
    used, index = np.unique(corners, return_inverse=True)
    samples, corners = vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)
    wall = _bare(samples, corners, label, source.issues)
    if outward_volume(wall) < 0.0:
        wall = _bare(samples, corners[:, ::-1].copy(), label, source.issues)
    smooth, _ = wall.smooth.project(samples)
    middles = wall.smooth.project(samples[wall.triangles].mean(axis=1))[0]
    blocks = np.array_split(middles, max(1, len(middles) // BLOCK_SIZE))
    between = max(float(facets.distance(block).max()) for block in blocks)
    return MeshWall(
        smooth,
        wall.triangles,
        wall.patch,
        wall.uv,
        (),
        (),
        wall.behind,
        (),
        label,
        (),
        source.issues,
        samples=samples,
        between=between,
    )


def _bare(samples: Array, corners: Index, label: str, issues: tuple[Issue, ...]) -> MeshWall:
    count = len(corners)
    return MeshWall(
        samples,
        corners,
        np.zeros(count, dtype=np.intp),
        np.zeros((count, 3, 2)),
        (),
        (),
        np.zeros(len(samples), dtype=bool),
        (),
        label,
        (),
        issues,
    )


def _read(points: Array, triangles: Index, label: str, mend: float) -> _Read:
    if not len(triangles) or not np.isfinite(points).all():
        raise InputError(
            "BAD_FILE",
            label,
            "the mesh has no triangles, or points with invalid coordinates; export it again",
        )
    surface = connected_triangles(points, triangles, label, mend)
    mended = list(surface.mended)
    crossed = find_crossings(surface.vertices, surface.triangles, WELDS_MM[-1])
    if len(crossed.pairs):
        position = place(crossed.positions[crossed.length.argmax()])
        plain = remove_crossings(
            surface.vertices, surface.triangles, crossed.pairs, mend, WELDS_MM[-1]
        )
        if plain is None:
            raise InputError(
                "SELF_INTERSECTION",
                label,
                "the wall intersects itself: {} pairs of triangles cross, for instance at {}; "
                "repair the mesh (Mesh, Analyze, Self-intersections), or deposit the mesh as a "
                "solid with holes up to strategy.mend closed",
                len(crossed.pairs),
                position,
            )
        size = max((hole.size for hole in plain.closed), default=0.0)
        mended.append(
            Text(
                "{} intersecting triangles were removed, as at {}, leaving holes up to {:.3g} mm "
                "across",
                plain.cut_out,
                position,
                size,
            )
        )
        surface = surface._replace(vertices=plain.vertices, triangles=plain.triangles)
    return _Read(
        surface.vertices, surface.triangles, (*surface.issues, *mended_issues(label, mended))
    )


def _areas(vertices: Array, triangles: Index, edge: float = np.inf) -> Index:
    """Return the index (m,) of the smooth area of each triangle.

    edge: mm; triangles larger than this share an area only if they are nearly coplanar.
    """
    corner = vertices[triangles]
    normal = doubled_areas(corner)
    size = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(size, 1e-300)[:, None]
    large = size > edge * np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(
        axis=1
    )  # the smallest height of a triangle
    edges = Edges(triangles)
    a, b = edges.faces[edges.count == 2].T
    smooth: Mask = dot(normal[a], normal[b]) > np.where(large[a] & large[b], PLANE, CREASE)
    count = len(triangles)
    links = coo_matrix((np.ones(int(smooth.sum())), (a[smooth], b[smooth])), shape=(count, count))
    areas: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return areas


EDGE_SPACING_SHARE = 0.5  # of the bead spacing; edge length of the mesh


def clad_mesh(points: Array, triangles: Index, spacing: float, back: bool, label: str) -> CladFaces:
    """Build a sheet to be clad from a mesh.

    The sheet is the smooth surface through the facets. Layers grow on the side from which triangles
    are counter-clockwise.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    triangles : (m, 3) int array
        Triangles.
    spacing : float
        Distance between beads, mm.
    back : bool
        Whether layers grow on the opposite side.
    label : str
        Name of the part, for messages.

    Returns
    -------
    CladFaces
        Faces to be clad.

    Raises
    ------
    InputError
        NO_FACES for a closed mesh, and the errors of `mesh_wall`.
    """
    wall = mesh_wall(points, triangles, EDGE_SPACING_SHARE * spacing, label, 0.0)
    if not len(wall.mesh.border_edges):
        raise InputError(
            "NO_FACES",
            label,
            "the object is a closed mesh without selectable faces; cut out the surface to cover "
            "(Mesh, Cutting), or use the original CAD file",
        )
    front = _faces_as(points, triangles, wall)
    sheet = wall if front != back else replace(wall, triangles=wall.triangles[:, ::-1].copy())
    return CladFaces(label, (), (sheet,), (), wall.issues)


def _faces_as(points: Array, triangles: Index, wall: MeshWall) -> bool:
    """Return whether a wall faces the same way as most of its source mesh."""
    source, smooth = Mesh(points, triangles), wall.mesh
    nearest = cKDTree(points[triangles].mean(axis=1)).query(
        wall.vertices[wall.triangles].mean(axis=1)
    )[1]
    units = source.area_vectors[nearest] / np.maximum(source.areas[nearest], 1e-300)[:, None]
    return float(dot(smooth.area_vectors, units).sum()) > 0.0
