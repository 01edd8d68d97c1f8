# SPDX-License-Identifier: LGPL-2.1-or-later
"""A mesh of 200,000 triangles cut by 50 equidistant cones, and by 1,000 planes with closed loops,
against trimesh."""

from __future__ import annotations

import contextlib
import io
from statistics import median
from time import process_time

import numpy as np

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.slicing.solids.equidistant import Facets
from freecad_am.core.slicing.solids.plane_sections import PlaneCuts

from rows import Row
from sizes import choose

AROUND_COUNT, UP_COUNT = choose((400, 250), (40, 24))  # triangles round and up
CUTS, ROUNDS = choose((50, 5), (3, 1))
CHORD_ERROR = 0.05
SECTIONS, SECTION_ROUNDS = choose((1000, 3), (5, 1))  # planes, and their rounds
SMALL_ROWS, PLANES = choose(
    (10, 20), (4, 3)
)  # rows of triangles and planes for a slicer that would take minutes for more


def run() -> list[Row]:
    """Compare with trimesh, and with half the triangles and half the layers: the cost is linear in
    both."""
    vertices, faces = wavy_ball()
    half = wavy_ball(UP_COUNT // 2)
    # medians of CPU time in turns, so that other load affects both sides equally
    rounds = [
        (
            _ours(vertices, faces, CUTS),
            _peer(vertices, faces),
            _ours(*half, CUTS),
            _ours(vertices, faces, 2 * CUTS),
        )
        for _ in range(ROUNDS)
    ]
    full, _, halved, doubled = (median(times[k] or 0.0 for times in rounds) for k in range(4))
    peers = [peer for _, peer, _, _ in rounds if peer is not None]
    name = f"{len(faces):,} triangles cut by {CUTS} cones, loops included, against trimesh and {CUTS} planes"
    halves = f"{len(faces):,} triangles against twice the time of {len(half[1]):,}"
    return [
        Row(name, full, median(peers) if peers else None, "s", 1.5),
        Row(halves, full, 2.0 * halved, "s", 0.6),
        Row(f"{2 * CUTS} cones against twice the time of {CUTS}", doubled, 2.0 * full, "s", 0.6),
        _sections(vertices, faces),
        _slicer(),
    ]


def _sections(vertices: np.ndarray, faces: np.ndarray) -> Row:
    """Plane sections with their loops, against trimesh's sections as paths."""
    heights = np.linspace(vertices[:, 2].min(), vertices[:, 2].max(), SECTIONS + 2)[1:-1]
    ours, peers = [], []
    for _ in range(SECTION_ROUNDS):
        start = process_time()
        assert all(PlaneCuts(vertices, faces).loops(heights))
        ours.append(process_time() - start)
        peer = _peer_sections(vertices, faces, heights)
        peers += [] if peer is None else [peer]
    name = f"{len(faces):,} triangles cut by {SECTIONS:,} planes, loops included, against trimesh's sections"
    return Row(name, median(ours), median(peers) if peers else None, "s", 3.0)


def _peer_sections(vertices: np.ndarray, faces: np.ndarray, heights: np.ndarray) -> float | None:
    try:
        import trimesh
    except ImportError:
        return None
    start = process_time()
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.section_multiplane(np.zeros(3), np.array([0.0, 0.0, 1.0]), heights)
    return process_time() - start


def _slicer() -> Row:
    """Plane sections with their loops, against the planar slicer of compas_slicer on a small mesh,
    once because it is slow."""
    vertices, faces = wavy_ball(SMALL_ROWS)
    bottom, height = float(vertices[:, 2].min()), float(np.ptp(vertices[:, 2])) / PLANES
    start = process_time()
    assert all(PlaneCuts(vertices, faces).loops(bottom + height * (np.arange(PLANES) + 0.5)))
    ours = process_time() - start
    name = f"{len(faces):,} triangles cut by {PLANES} planes, loops included, against compas_slicer's planar slicer"
    return Row(name, ours, _peer_slicer(vertices, faces, height), "s", 20.0)


def _peer_slicer(vertices: np.ndarray, faces: np.ndarray, height: float) -> float | None:
    with contextlib.redirect_stderr(
        io.StringIO()
    ):  # the progress bar keeps the stream that exists at its import
        try:
            from compas.datastructures import Mesh
            from compas_slicer.slicers import PlanarSlicer
        except ImportError:
            return None
        start = process_time()
        slicer = PlanarSlicer(
            Mesh.from_vertices_and_faces(vertices.tolist(), faces.tolist()), layer_height=height
        )
        slicer.slice_model()
        assert len(slicer.layers) >= PLANES - 1
        return process_time() - start


def _ours(vertices: np.ndarray, faces: np.ndarray, cuts: int) -> float:
    start = process_time()
    facets = Facets(Developable(60.0, 200.0), vertices, faces)
    distances = np.linspace(facets.distances.min(), facets.distances.max(), cuts + 2)[1:-1]
    loops = [facets.cut(float(distance), CHORD_ERROR) for distance in distances]
    spent = process_time() - start
    assert all(loops)
    return spent


def wavy_ball(up: int = UP_COUNT) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and outward triangles of a wavy body next to the cone's axis; `up` rings of
    triangles."""
    turn = 2.0 * np.pi * np.arange(AROUND_COUNT) / AROUND_COUNT
    height = np.pi * (np.arange(up) + 0.5) / up
    height, turn = (grid.ravel() for grid in np.meshgrid(height, turn, indexing="ij"))
    radius = 60.0 + 4.0 * np.sin(7.0 * turn) * np.sin(9.0 * height)
    ball = np.stack(
        [np.sin(height) * np.cos(turn), np.sin(height) * np.sin(turn), np.cos(height)], axis=1
    )
    vertices = np.vstack([radius[:, None] * ball, [[0.0, 0.0, 62.0], [0.0, 0.0, -62.0]]]) + [
        140.0,
        0.0,
        60.0,
    ]
    number = np.arange(up * AROUND_COUNT).reshape(up, AROUND_COUNT)
    a, b = number[:-1].ravel(), number[1:].ravel()
    c, d = np.roll(number, -1, axis=1)[1:].ravel(), np.roll(number, -1, axis=1)[:-1].ravel()
    top = np.stack(
        [np.full(AROUND_COUNT, up * AROUND_COUNT), number[0], np.roll(number[0], -1)], axis=1
    )
    bottom = np.stack(
        [np.full(AROUND_COUNT, up * AROUND_COUNT + 1), np.roll(number[-1], -1), number[-1]], axis=1
    )
    faces = np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1), top, bottom])
    return vertices, faces.astype(np.intp)


def _peer(vertices: np.ndarray, faces: np.ndarray) -> float | None:
    """trimesh's cut by many parallel planes, which leaves the segments unordered."""
    try:
        import trimesh
    except ImportError:
        return None
    heights = np.linspace(vertices[:, 2].min(), vertices[:, 2].max(), CUTS + 2)[1:-1]
    start = process_time()
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    trimesh.intersections.mesh_multiplane(mesh, np.zeros(3), np.array([0.0, 0.0, 1.0]), heights)
    return process_time() - start
