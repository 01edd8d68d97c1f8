# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids bounded by triangles: validity checks, signed distances, division and orientation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components
from scipy.spatial import cKDTree

from ...issues import InputError, Text
from ...types import Array, Index, Mask
from ..columns import sides
from ..formatting import place
from ..walls.surface import dot
from .near_triangles import find_crossings
from .refine import Edges
from .triangle_mesh import closest

NEIGHBOUR_COUNT = 12
SHARP_EDGE_RAD = np.radians(20.0)  # facets at a larger angle do not approximate a round surface
PARALLEL = 1e-6  # 1 - cosine of the angle between the normals of parallel triangles


@dataclass(frozen=True, eq=False)
class SolidMesh:
    """A solid: vertices (n, 3) mm, triangles (m, 3) counter-clockwise seen from outside."""

    vertices: Array
    triangles: Index

    @property
    def volume(self) -> float:
        """Volume, mm3; negative if the mesh is inside out."""
        a, b, c = (
            self.vertices[self.triangles[:, k]] - self.vertices[self.triangles[0, 0]]
            for k in range(3)
        )
        return float(dot(a, np.cross(b, c)).sum() / 6.0)

    def refuse_unsound(self, label: str, of_shape: bool = False, touching: bool = False) -> None:
        """Reject a mesh that does not bound a solid.

        Parameters
        ----------
        label : str
            Name of the part, for messages.
        of_shape : bool, optional
            Whether the mesh comes from a solid with exact faces, so that the user cannot repair
            a mesh.
        touching : bool, optional
            Whether to accept a solid that touches itself along edges.

        Raises
        ------
        InputError
            OPEN_MESH, NON_MANIFOLD or INSIDE_OUT with a position.
        """
        edges = Edges(self.triangles)
        several = (edges.count > 2) & ~(touching & (edges.count % 2 == 0))
        for wrong, code, what, cure in (
            (
                (edges.count == 1) & of_shape,
                "OPEN_MESH",
                "faces of the solid do not meet along their edges",
                "check the solid in the CAD system or by Part, Check geometry, and redraw or sew those faces",
            ),
            (
                edges.count == 1,
                "OPEN_MESH",
                "the mesh has a hole",
                "fill holes (Mesh, Close holes) or export it again",
            ),
            (
                several & of_shape,
                "NON_MANIFOLD",
                "the solid touches itself along an edge, so its inside is undefined",
                "separate the faces there, or let them overlap and fuse the solid (Part, Boolean)",
            ),
            (
                several,
                "NON_MANIFOLD",
                "three or more triangles share an edge",
                "repair the mesh (Mesh, Analyze)",
            ),
        ):
            if wrong.any():
                where = place(self.vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
                raise InputError(
                    code,
                    label,
                    "{}: {} edges, the first at {}; {}",
                    what,
                    int(wrong.sum()),
                    where,
                    cure,
                )
        half = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2)
        sense = np.where(half[..., 0] < half[..., 1], 1, -1)
        total = np.bincount(
            edges.of_triangle.ravel(), weights=sense.ravel(), minlength=len(edges.ends)
        )
        if (total != 0).any():
            where = place(self.vertices[edges.ends[np.argmax(total != 0)]].mean(axis=0))
            raise InputError(
                "INSIDE_OUT",
                label,
                "neighbouring triangles face opposite ways, for instance at {}; make their "
                "orientation consistent (Mesh, Harmonize normals)",
                where,
            )
        if self.volume <= 0.0:
            raise InputError(
                "INSIDE_OUT",
                label,
                "the solid is inside out (volume {:.4g} mm3, near {}); flip its normals (Mesh, "
                "Flip normals)",
                self.volume,
                place(self.vertices.mean(axis=0)),
            )

    def refuse_crossing(self, label: str, min_length: float) -> None:
        """Reject a mesh that intersects itself over more than `min_length` mm.

        Raises InputError SELF_CROSSING with a position.
        """
        pairs = find_crossings(self.vertices, self.triangles, min_length)
        if len(pairs.pairs):
            where = place(pairs.positions[pairs.length.argmax()])
            raise InputError(
                "SELF_CROSSING",
                label,
                "the mesh intersects itself: {} pairs of triangles cross, for instance at {}, so "
                "its inside is undefined; fuse the overlapping solids in the CAD system, or "
                "repair the mesh (Mesh, Analyze, Self-intersections)",
                len(pairs.pairs),
                where,
            )

    def searched(self, edge: float) -> Search:
        """Return a search for nearest points, suited to query points about `edge` mm apart."""
        area = 0.5 * np.linalg.norm(self.normals, axis=1).sum()
        return Search(self, max(2.0 * edge, float(np.sqrt(area / 20000.0))))

    @cached_property
    def normals(self) -> Array:
        """Return the outer normals of the triangles, with twice the area as length.

        Returns
        -------
        (m, 3) array
            mm2.
        """
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        normals: Array = np.cross(b - a, c - a)
        return normals

    @cached_property
    def sagitta(self) -> Array:
        """Estimate the deviation of each triangle from the round surface that it approximates.

        Returns
        -------
        (m,) array
            Maximum over the edges of an eighth of the triangle's width across the edge times the
            dihedral angle, mm. Angles above SHARP_EDGE_RAD are real edges and count as 0.
        """
        edges = Edges(self.triangles)
        two = edges.count == 2
        turn = np.zeros(len(edges.ends))
        normal_a, normal_b = (self.units[edges.faces[two, side]] for side in (0, 1))
        turn[two] = np.arctan2(
            np.linalg.norm(np.cross(normal_a, normal_b), axis=1), dot(normal_a, normal_b)
        )
        turn[turn > SHARP_EDGE_RAD] = 0.0
        length = np.linalg.norm(
            self.vertices[edges.ends[:, 1]] - self.vertices[edges.ends[:, 0]], axis=1
        )
        width = np.linalg.norm(self.normals, axis=1)[:, None] / np.maximum(
            length[edges.of_triangle], 1e-300
        )
        sagitta: Array = (0.125 * width * turn[edges.of_triangle]).max(axis=1)
        return sagitta

    @cached_property
    def units(self) -> Array:
        """Return the outer unit normals of the triangles.

        Returns
        -------
        (m, 3) array
            Unit normals; zero for triangles without area.
        """
        length = np.linalg.norm(self.normals, axis=1, keepdims=True)
        units: Array = np.where(length > 1e-10, self.normals / np.maximum(length, 1e-300), 0.0)
        return units


class Search:
    """Search for the nearest triangles of a solid, by midpoints of parts up to `longest` mm long.

    Pseudo-normals determine the side (Baerentzen 2005).
    """

    def __init__(self, solid: SolidMesh, longest: float) -> None:
        self.vertices, self.longest = solid.vertices, longest
        vertices = solid.vertices
        sound = np.flatnonzero(np.linalg.norm(solid.normals, axis=1) > 1e-10)
        self.triangles, self.owner, self.units = solid.triangles[sound], sound, solid.units[sound]
        middles, self.of = _divide_triangles(vertices[self.triangles], longest)
        self.tree = cKDTree(middles)

    @cached_property
    def flat(self) -> bool:
        """Whether all triangles are parallel, so that there is no inside."""
        return bool((np.abs(self.units @ self.units[0]) > 1.0 - PARALLEL).all())

    def distance(self, points: Array) -> Array:
        """Return the distances of points from the triangles.

        Parameters
        ----------
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        (k,) array
            mm.
        """
        return self._nearest(points)[0]

    def signed(self, points: Array) -> tuple[Array, Array, Index]:
        """Return the signed distances of points from the solid.

        Parameters
        ----------
        points : (k, 3) array
            Points, mm.

        Returns
        -------
        distance : (k,) array
            Distances, negative inside, mm.
        foot : (k, 3) array
            Nearest points, mm.
        triangle : (k,) int array
            Indices of the nearest triangles of the solid.

        References
        ----------
        Baerentzen 2005, for the sign by pseudo-normals.
        """
        distance, triangle, share = self._nearest(points)
        foot = np.einsum("nk,nkc->nc", share, self.vertices[self.triangles[triangle]])
        at_vertex, at_edge, edge_of = self._pseudo_normals
        small = share < 1e-9
        normal = self.units[triangle].copy()
        on_edge = np.flatnonzero(small.sum(axis=1) == 1)
        normal[on_edge] = at_edge[
            edge_of[triangle[on_edge], (np.argmax(small[on_edge], axis=1) + 1) % 3]
        ]
        on_vertex = np.flatnonzero(small.sum(axis=1) == 2)
        normal[on_vertex] = at_vertex[
            self.triangles[triangle[on_vertex], np.argmin(small[on_vertex], axis=1)]
        ]
        side = np.where(dot(points - foot, normal) < 0.0, -1.0, 1.0)
        return side * distance, foot, self.owner[triangle]

    def _nearest(self, points: Array) -> tuple[Array, Index, Array]:
        """Return distances (k,) of points (k, 3), the nearest sound triangles (k,) and barycentric
        coordinates (k, 3) of the nearest points.
        """
        count = min(NEIGHBOUR_COUNT, len(self.of))
        # near the centre of a round solid all triangles are equally near: allow a tolerance
        far_points = np.flatnonzero(self.tree.query(points, eps=0.3)[0] > 4.0 * self.longest)
        close = np.setdiff1d(np.arange(len(points)), far_points)
        nearest_triangles = np.zeros((len(points), count), dtype=np.intp)
        for selected, slack in ((far_points, 0.3), (close, 0.0)):
            if len(selected):
                nearest_triangles[selected] = self.of[
                    np.asarray(self.tree.query(points[selected], k=count, eps=slack)[1]).reshape(
                        -1, count
                    )
                ]
        fresh = np.ones(
            nearest_triangles.shape, dtype=bool
        )  # most parts near a point belong to a few triangles
        for k in range(1, count):
            fresh[:, k] = (nearest_triangles[:, :k] != nearest_triangles[:, k : k + 1]).all(axis=1)
        corner = self.vertices[self.triangles[nearest_triangles[fresh]]]
        owner = np.nonzero(fresh)[0]
        part_distance, shares = closest(corner[:, 0], corner[:, 1], corner[:, 2], points[owner])
        distance = np.full(nearest_triangles.shape, np.inf)
        row_of_part = np.zeros(nearest_triangles.shape, dtype=np.intp)
        distance[fresh], row_of_part[fresh] = part_distance, np.arange(len(part_distance))
        row, best = np.arange(len(points)), np.argmin(distance, axis=1)
        return distance[row, best], nearest_triangles[row, best], shares[row_of_part[row, best]]

    @cached_property
    def _pseudo_normals(self) -> tuple[Array, Array, Index]:
        """Return pseudo-normals of vertices (n, 3) and edges (e, 3), and the edge indices (m, 3) of
        sound triangles.
        """
        corner = self.vertices[self.triangles]
        at_vertex = np.zeros_like(self.vertices)
        for k in range(3):
            edge_a = corner[:, (k + 1) % 3] - corner[:, k]
            edge_b = corner[:, (k + 2) % 3] - corner[:, k]
            angle = np.arctan2(
                np.linalg.norm(np.cross(edge_a, edge_b), axis=1), dot(edge_a, edge_b)
            )
            np.add.at(at_vertex, self.triangles[:, k], angle[:, None] * self.units)
        edges = Edges(self.triangles)
        at_edge = np.zeros((len(edges.ends), 3))
        for k in range(3):
            np.add.at(at_edge, edges.of_triangle[:, k], self.units)
        return at_vertex, at_edge, edges.of_triangle


def divide_triangles(
    corners: Array, longest: float, is_kept: Callable[[Array], Mask] | None = None
) -> tuple[Array, Index]:
    """Divide triangles until all sides are within a limit.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Triangles, mm.
    longest : float
        Maximum side, mm.
    is_kept : callable, optional
        Returns which triangles or parts (n, 3, 3) to keep; the remaining triangles are dropped.
        None keeps all.

    Returns
    -------
    middles : (k, 3) array
        Centroids of the parts, mm.
    triangle : (k,) int array
        Triangle index of each part.
    """
    return (
        _divide_triangles(corners, longest, is_kept)
        if len(corners)
        else (np.zeros((0, 3)), np.zeros(0, dtype=np.intp))
    )


def _divide_triangles(
    corner: Array, longest: float, is_kept: Callable[[Array], Mask] | None = None
) -> tuple[Array, Index]:
    """Divide triangles (m, 3, 3) for `divide_triangles`, by bisecting the longest side."""
    triangle, blocks = np.arange(len(corner)), []
    while len(corner):
        if is_kept is not None:
            keep = is_kept(corner)
            corner, triangle = corner[keep], triangle[keep]
        side = sides(corner)
        top = np.argmax(side, axis=1)
        small = side[np.arange(len(top)), top] <= longest
        a, b, c = (corner[small, k] for k in range(3))
        blocks.append(((a + b + c) / 3.0, triangle[small]))
        corner, triangle, top = corner[~small], triangle[~small], top[~small]
        a, b, c = (corner[np.arange(len(top)), (top + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corner = np.concatenate(
            [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        )
        triangle = np.r_[triangle, triangle]
    return np.concatenate([block for block, _ in blocks]), np.concatenate(
        [block for _, block in blocks]
    )


MIN_VOLUME_SHARE = 1e-9  # of the cubed box diagonal; minimum volume of a closed piece


def connected_pieces(corners: Index) -> Index:
    """Return the connected component of each triangle.

    Parameters
    ----------
    corners : (m, 3) array of int
        Vertex indices of the triangles.

    Returns
    -------
    (m,) array of int
        Component indices from 0; edges with exactly two triangles connect.
    """
    edges = Edges(corners)
    a, b = edges.faces[edges.count == 2].T
    links = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(corners), len(corners)))
    components: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return components


def orient_triangles(
    vertices: Array, corners: Index, edges: Edges, label: str, messages: list[str]
) -> Index:
    """Orient triangles consistently with their neighbours.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    corners : (m, 3) int array
        Triangles.
    edges : Edges
        Edges of the triangles.
    label : str
        Name of the part, for errors.
    messages : list of str
        Receives a message about flipped triangles.

    Returns
    -------
    (m, 3) int array
        Oriented triangles.

    Raises
    ------
    InputError
        NOT_ORIENTABLE if no consistent orientation exists.
    """
    turned = orient_across(corners, edges, np.arange(len(edges.ends)), messages)
    forward = turned < np.roll(turned, -1, axis=1)
    face_a, face_b = edges.faces.T
    number = Edges(turned)
    senses = [
        forward[
            face, np.argmax(number.of_triangle[face] == np.arange(len(face_a))[:, None], axis=1)
        ]
        for face in (face_a, face_b)
    ]
    wrong = senses[0] == senses[1]
    if wrong.any():
        where = place(vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
        raise InputError(
            "NOT_ORIENTABLE",
            label,
            "the mesh has no consistent inside, as at {}; model the solid again",
            where,
        )
    return turned


def orient_across(corners: Index, edges: Edges, two: Index, messages: list[str]) -> Index:
    """Orient triangles consistently with their neighbours as far as possible.

    Parameters
    ----------
    corners : (m, 3) int array
        Triangles.
    edges : Edges
        Edges of the triangles.
    two : (k,) int array
        Indices of edges with two triangles, across which orientations should agree.
    messages : list of str
        Receives a message about flipped triangles.

    Returns
    -------
    (m, 3) int array
        Oriented triangles.
    """
    forward = corners < np.roll(corners, -1, axis=1)
    face_a, face_b = edges.faces[two].T
    senses = [
        forward[face, np.argmax(edges.of_triangle[face] == two[:, None], axis=1)]
        for face in (face_a, face_b)
    ]
    against = senses[0] == senses[1]
    if not against.any():
        return corners
    flip = _flips(len(corners), face_a, face_b, against)
    messages.append(
        Text(
            "{} triangles were flipped to match their neighbours",
            int(min(flip.sum(), (~flip).sum())),
        )
    )
    return np.where(flip[:, None], corners[:, ::-1], corners)


def _flips(count: int, face_a: Index, face_b: Index, against: Mask) -> Mask:
    """Return which triangles to flip, propagated from neighbour to neighbour."""
    links = coo_matrix((np.ones(len(face_a)), (face_a, face_b)), shape=(count, count)).tocsr()
    crossed = {(int(a), int(b)) for a, b in zip(face_a[against], face_b[against])}
    crossed |= {(b, a) for a, b in crossed}
    _, component = connected_components(links, directed=False)
    flip = np.zeros(count, dtype=bool)
    for start in np.unique(component, return_index=True)[1]:
        order, predecessor = breadth_first_order(links, start, directed=False)
        for face in order[1:].tolist():
            parent = int(predecessor[face])
            flip[face] = flip[parent] ^ ((parent, face) in crossed)
    is_minority = np.bincount(component, weights=flip) > 0.5 * np.bincount(
        component
    )  # the minority is reversed
    turned: Mask = flip ^ is_minority[component]
    return turned


def split_solids(vertices: Array, corners: Index, messages: list[str]) -> tuple[SolidMesh, ...]:
    """Return the connected components as solids.

    Inside-out outer components are reversed. A cavity belongs to the solid around it.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    corners : (m, 3) int array
        Oriented triangles.
    messages : list of str
        Receives messages about removed and reversed components.

    Returns
    -------
    tuple of SolidMesh
        The solids, without components that enclose no volume.
    """
    component = connected_pieces(corners)
    components = np.split(
        corners[np.argsort(component, kind="stable")], np.cumsum(np.bincount(component))[:-1]
    )
    low = np.array([vertices[shell].min(axis=(0, 1)) for shell in components])
    high = np.array([vertices[shell].max(axis=(0, 1)) for shell in components])
    volume = np.array([SolidMesh(vertices, shell).volume for shell in components])
    bulky = np.abs(volume) > MIN_VOLUME_SHARE * np.linalg.norm(high - low, axis=1) ** 3
    if not bulky.all():
        messages.append(Text("{} pieces that enclose no volume were removed", int((~bulky).sum())))
    about = {}
    for k in np.flatnonzero(bulky & (volume < 0.0)).tolist():
        wider = np.flatnonzero(
            (low < low[k]).all(axis=1) & (high > high[k]).all(axis=1) & bulky & (volume > 0.0)
        )
        inside = [
            j
            for j in wider.tolist()
            if _winding(vertices[components[j]], vertices[components[k][0, 0]]) > 0.5
        ]
        if inside:
            about[k] = min(inside, key=lambda j: volume[j])
    outer = [k for k in np.flatnonzero(bulky).tolist() if k not in about]
    turned = [k for k in outer if volume[k] < 0.0]
    if turned:
        message = Text("{} inside-out solids were reversed", len(turned))
        messages.append("an inside-out solid was reversed" if len(turned) == 1 else message)
    solids = []
    for k in outer:
        shells = [components[k][:, ::-1] if volume[k] < 0.0 else components[k]]
        shells += [components[j] for j, around in about.items() if around == k]
        used, index = np.unique(np.vstack(shells), return_inverse=True)
        solids.append(SolidMesh(vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)))
    return tuple(solids)


def _winding(corners: Array, point: Array) -> float:
    """Return the winding number of triangles (m, 3, 3) about a point (Van Oosterom and Strackee
    1983).
    """
    a, b, c = ((corners - point)[:, k] for k in range(3))
    u, v, w = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    below = u * v * w + dot(a, b) * w + dot(b, c) * u + dot(c, a) * v
    return float(np.arctan2(dot(a, np.cross(b, c)), below).sum() / (2.0 * np.pi))
