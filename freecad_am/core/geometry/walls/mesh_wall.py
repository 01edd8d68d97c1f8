# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall that comes as triangles, open or closed: mended, meshed evenly, with a smooth surface through its facets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...issues import NOTE, InputError, Issue, Text
from ...types import Array, Index, Mask
from ..formatting import format_deviation, place
from ..mesh.collapsed import collapse_edges
from ..mesh.crossing import find_crossings
from ..mesh.facets import doubled_areas
from ..mesh.refined import Edges, flip_edges, refine_mesh
from ..mesh.repair import WELDS_MM, connected_triangles, mended_issues
from ..mesh.smooth import SmoothMesh
from ..mesh.solid import Search, SolidMesh
from ..mesh.triangle_mesh import Mesh
from ..mesh.uncrossed import remove_crossings
from .patch_wall import PatchWall
from .rims import outward_volume
from .surface import dot

MAX_TRIANGLES = 1_500_000  # triangles
COLLAPSE = 0.55  # of the longest edge; shorter ones are drawn together
CREASE = np.cos(
    np.radians(20.0)
)  # facets that meet at more are areas of their own, whose edges stay where they are
PLANE = np.cos(
    np.radians(3.0)
)  # and for facets larger than the mesh's edges where it would run across such meetings
MAX_BETWEEN_SHARE = 0.05  # of the length of an edge: distance from the facets beyond which areas are divided further
FOLD = 0.25  # rad between facets: a bend whose radius is less than four edges, which they cannot follow
BLOCK_SIZE = 1000  # places done together; bounds the memory
REPORTED_FROM_MM = 0.02  # mm between mesh and smooth surface beyond which this is reported


@dataclass(frozen=True, eq=False)
class MeshWall(PatchWall):
    """A wall whose one piece is the smooth surface through a mesh. samples (n, 3): where the vertices were on its facets.
    between: mm that the surface is off these, at most, in the middles of triangles."""

    samples: Array | None = None
    between: float = 0.0

    @cached_property
    def smooth(self) -> SmoothMesh:
        """The surface."""
        samples = self.vertices if self.samples is None else self.samples
        return SmoothMesh(samples, self.triangles, self.mesh.typical_edge)

    @property
    def smoothing(self) -> float:
        """How far, mm, the smooth surface is off the mesh, at most."""
        at_vertices = (
            0.0
            if self.samples is None
            else float(np.linalg.norm(self.vertices - self.samples, axis=1).max())
        )
        return max(at_vertices, self.between)

    @property
    def mesh_vertices(self) -> int:
        """How many vertices the mesh has."""
        return len(self.vertices)

    @property
    def folds(self) -> float:
        """Length of the sharp edges in the deposited part."""
        ahead = self.triangles[~self.behind[self.triangles].any(axis=1)]
        return Mesh(self.vertices, ahead).folded(FOLD)

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """On the smooth surface, which goes on a little beyond the edges of the wall."""
        points, normals = self.smooth.project(points)
        return points, normals, np.zeros(len(points), dtype=np.intp)


class _Read(NamedTuple):
    vertices: Array
    triangles: Index
    issues: tuple[Issue, ...]


def mesh_wall(points: Array, triangles: Index, edge: float, label: str, mend: float) -> MeshWall:
    """Build the wall of points (n, 3) and triangles (m, 3), with edges of `edge` mm, that starts
    nowhere yet.

    mend: mm, size of the largest hole that is closed; see `repair.connected_triangles`.

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
    ):  # edges of the mesh cut across a valley or a ridge of large facets
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
    """Build the smooth wall through facets that belong to the areas `owner` (m,).

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
                "repair the mesh (Mesh, Analyze, Self-intersections), or deposit it as a solid "
                "with holes up to strategy.mend closed",
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
    """Return the smooth area (m,) of each triangle.

    edge: mm; triangles larger than that share an area only if they are nearly coplanar.
    """
    corner = vertices[triangles]
    normal = doubled_areas(corner)
    size = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(size, 1e-300)[:, None]
    large = size > edge * np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(
        axis=1
    )  # its smallest height
    edges = Edges(triangles)
    a, b = edges.faces[edges.count == 2].T
    smooth: Mask = dot(normal[a], normal[b]) > np.where(large[a] & large[b], PLANE, CREASE)
    count = len(triangles)
    links = coo_matrix((np.ones(int(smooth.sum())), (a[smooth], b[smooth])), shape=(count, count))
    areas: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return areas
