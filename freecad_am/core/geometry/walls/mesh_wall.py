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
from ..formatting import deviation, place
from ..mesh.collapsed import collapsed
from ..mesh.crossing import crossings
from ..mesh.facets import doubled_areas
from ..mesh.refined import Edges, flipped, refined
from ..mesh.repair import WELDS, connected_triangles, mended_issues
from ..mesh.smooth import SmoothMesh
from ..mesh.solid import Search, SolidMesh
from ..mesh.triangle_mesh import Mesh
from ..mesh.uncrossed import uncrossed
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
ACROSS = 0.05  # of the length of an edge, mm off the facets from which on this is looked at
FOLD = 0.25  # rad between facets: a bend whose radius is less than four edges, which they cannot follow
PIECE = 1000  # places done together; bounds the memory
REPORTED_FROM_MM = 0.02  # mm off the mesh that the smooth surface may be before it is told


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
        """Of what is deposited."""
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
    """The wall of points (n, 3) and triangles (m, 3), with edges of `edge` mm, that starts nowhere yet. mend: the largest
    hole that is closed, mm; see `mesh_repair.connected_triangles`.

    InputError BAD_FILE, NO_SOLID, SELF_INTERSECTION, TOO_FINE.
    """
    read = _read(points, triangles, label, mend)
    facets = SolidMesh(read.vertices, read.triangles).searched(edge)
    wall = _meshed(read, _areas(read.vertices, read.triangles), facets, edge, label)
    if (
        wall.between > ACROSS * edge
    ):  # edges of the mesh run across a valley or a ridge of large facets
        other = _meshed(read, _areas(read.vertices, read.triangles, edge), facets, edge, label)
        wall = other if other.between < wall.between else wall
    off = wall.smoothing
    if off <= REPORTED_FROM_MM or wall.samples is None:
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
                    "{}: where facets meet at an angle the wall runs smoothly, up to {} mm off them, at {}",
                    label,
                    deviation(off),
                    place(farthest),
                ),
            ),
        ),
    )


def _meshed(read: _Read, owner: Index, facets: Search, edge: float, label: str) -> MeshWall:
    """The smooth wall through facets, whose areas `owner` (m,) tells apart. InputError TOO_FINE."""
    made = refined(
        read.vertices,
        read.triangles,
        owner,
        edge,
        lambda middles, adjacent, ends: middles,
        MAX_TRIANGLES,
    )
    if made is None:
        made = refined(
            read.vertices,
            read.triangles,
            owner,
            edge,
            lambda middles, adjacent, ends: middles,
            MAX_TRIANGLES,
            turned=False,
        )
    if made is None:
        raise InputError(
            "TOO_FINE",
            label,
            "with edges of {:.3g} mm, a layer height, the mesh of the wall has more than {} triangles; "
            "use a larger layer height, or deposit the wall in parts",
            edge,
            MAX_TRIANGLES,
        )
    vertices, corners, owner = made
    corners, owner = collapsed(vertices, corners, owner, COLLAPSE * edge, edge)
    corners = flipped(vertices, corners, owner)
    used, index = np.unique(corners, return_inverse=True)
    samples, corners = vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)
    wall = _bare(samples, corners, label, read.issues)
    if outward_volume(wall) < 0.0:
        wall = _bare(samples, corners[:, ::-1].copy(), label, read.issues)
    smooth, _ = wall.smooth.project(samples)
    middles = wall.smooth.project(samples[wall.triangles].mean(axis=1))[0]
    pieces = np.array_split(middles, max(1, len(middles) // PIECE))
    between = max(float(facets.away(some).max()) for some in pieces)
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
        read.issues,
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
            "the mesh has no triangles, or points that are not numbers; export it again",
        )
    found = connected_triangles(points, triangles, label, mend)
    mended = list(found.mended)
    crossed = crossings(found.vertices, found.triangles, WELDS[-1])
    if len(crossed.pairs):
        at = place(crossed.places[crossed.length.argmax()])
        plain = uncrossed(found.vertices, found.triangles, crossed.pairs, mend, WELDS[-1])
        if plain is None:
            raise InputError(
                "SELF_INTERSECTION",
                label,
                "the wall cuts itself: {} pairs of its triangles cross, for instance at {}; "
                "repair the mesh (Mesh, Analyze, Self-intersections), or deposit it as a solid, with holes of up to "
                "strategy.mend closed",
                len(crossed.pairs),
                at,
            )
        size = max((hole.size for hole in plain.closed), default=0.0)
        mended.append(
            Text(
                "{} triangles that cross were cut out, as at {}, which left holes of up to {:.3g} mm across",
                plain.cut_out,
                at,
                size,
            )
        )
        found = found._replace(vertices=plain.vertices, triangles=plain.triangles)
    return _Read(found.vertices, found.triangles, (*found.issues, *mended_issues(label, mended)))


def _areas(vertices: Array, triangles: Index, edge: float = np.inf) -> Index:
    """The smooth area (m,) that each triangle belongs to. edge: mm; triangles larger than that are one area only where they
    are nearly of one plane."""
    corner = vertices[triangles]
    normal = doubled_areas(corner)
    size = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(size, 1e-300)[:, None]
    large = size > edge * np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(
        axis=1
    )  # the least of its heights
    edges = Edges(triangles)
    one, other = edges.faces[edges.count == 2].T
    smooth: Mask = dot(normal[one], normal[other]) > np.where(
        large[one] & large[other], PLANE, CREASE
    )
    count = len(triangles)
    links = coo_matrix(
        (np.ones(int(smooth.sum())), (one[smooth], other[smooth])), shape=(count, count)
    )
    areas: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return areas
