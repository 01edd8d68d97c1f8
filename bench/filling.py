# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel curves of a region of 2,000 points, returned as arrays, against the bare library; a
bracket sliced and filled with contours against its bare parallel curves; and the distance field
through a solid whose levels are curved layers."""

from __future__ import annotations

from pathlib import Path
from statistics import median
from time import process_time

import numpy as np

from freecad_am.brep.files.read import read_shape
from freecad_am.brep.hub import bodies_of
from freecad_am.core.filling.centre import Beads
from freecad_am.core.filling.fill import fill
from freecad_am.core.geometry.regions.region import regions, shapely
from freecad_am.core.layers import eikonal
from freecad_am.core.layers.eikonal import voxels
from freecad_am.core.slicing.solids.plane_sections import PlaneCuts

from rows import Row
from sizes import choose

POINTS, OFFSETS, ROUNDS = choose((2000, 100, 15), (100, 4, 1))
MAX_DEPTH_MM, CHORD_ERROR = 20.0, 0.02  # mm
OFFSET_TIME_RATIO = 1.5  # times the bare library
FILL_ROUNDS = choose(3, 1)
BRACKET = Path(__file__).resolve().parent.parent / "resources" / "examples" / "bracket.step"
# of the bracket; mm; multiple of its bare parallel curves, mostly for the centres that they leave
# open
SECTIONS, SPACING, CONTOUR_TIME_RATIO = choose(100, 2), 4.0, 80.0
# A plate with holes (mm), filled with lines; as a multiple of the bare border with clipped lines,
# which leave 428 gaps next to the holes. Closing them takes most of the time.
PLATE, HOLES, LINE_TIME_RATIO = (400.0, 300.0), choose(20, 2), 1300.0
BLOCK, STEPS, FIELD_TIME_S = (
    (100.0, 80.0, 25.0),
    choose((1.0, 0.5848), (8.0, 5.0)),
    5.0,
)  # mm; 200,000 and a million nodes; s


def run() -> list[Row]:
    """Offsets, fills and fields; the fields against the allowed time and against a smaller
    field."""
    return [*compare_offsets(), compare_contours(), compare_lines(), *compare_fields()]


def compare_offsets() -> list[Row]:
    angle = 2.0 * np.pi * np.arange(POINTS) / POINTS
    radius = 100.0 + 10.0 * np.sin(5.0 * angle)
    loop = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    distances = -MAX_DEPTH_MM * np.arange(1, OFFSETS + 1) / OFFSETS
    library = shapely()
    ours, bare = (
        [],
        [],
    )  # CPU time in turns, so that other load affects both sides equally
    for _ in range(ROUNDS):
        start = process_time()
        (region,) = regions([loop])
        for distance in distances:
            for offset_region in region.grown(float(distance), CHORD_ERROR):
                offset_region.borders()
        ours.append(process_time() - start)
        start = process_time()
        polygon = library.geometry.Polygon(loop)
        for distance in distances:
            # segments of a quarter turn as the chord error asks for
            quarter = (
                int(np.ceil(np.pi / 4.0 / np.arccos(1.0 - CHORD_ERROR / -distance)))
                if -distance > CHORD_ERROR
                else 2
            )
            np.asarray(polygon.buffer(distance, **{library.arcs: max(quarter, 2)}).exterior.coords)
        bare.append(process_time() - start)
    name = f"{OFFSETS} offsets of a region of {POINTS} points, against shapely alone"
    return [Row(name, median(ours), median(bare), "s", 1.0 / OFFSET_TIME_RATIO)]


def compare_contours() -> Row:
    """Contours with beads that close gaps, against parallel curves, which leave the gaps open."""
    (body,) = bodies_of(read_shape(BRACKET), "bracket", 0.05, 0.0).bodies
    cuts = PlaneCuts(body.vertices, body.triangles.astype(np.intp))
    low, high = body.vertices[:, 2].min(), body.vertices[:, 2].max()
    layers = [
        regions(loops)
        for loops in cuts.loops(low + (high - low) * (np.arange(SECTIONS) + 0.5) / SECTIONS)
    ]
    beads = Beads(SPACING, 0.2 * SPACING, 2.0, chord_error=CHORD_ERROR)
    library = shapely()
    start = process_time()
    assert all(fill(region, beads) for layer in layers for region in layer)
    ours = process_time() - start
    start = process_time()
    for region in (region for layer in layers for region in layer):
        rings = region.borders()
        polygon = library.geometry.Polygon(rings[0], rings[1:])
        remainder, depth = polygon, 0.5 * SPACING
        while not remainder.is_empty:
            remainder = polygon.buffer(-depth, **{library.arcs: 8})
            depth += SPACING
    bare = process_time() - start
    name = (
        f"{SECTIONS} sections of a bracket filled with contours, against their bare parallel curves"
    )
    return Row(name, ours, bare, "s", 1.0 / CONTOUR_TIME_RATIO)


def compare_lines() -> Row:
    """Lines within a contour, against the library's own border one bead inwards and parallel lines
    clipped there."""
    angle = np.linspace(0.0, 2.0 * np.pi, 120, endpoint=False)
    circle = 12.0 * np.stack([np.cos(angle), -np.sin(angle)], axis=1)
    centres = [(50.0 + 75.0 * (k % 5), 40.0 + 73.0 * (k // 5)) for k in range(HOLES)]
    loops = [
        np.array([(0.0, 0.0), (PLATE[0], 0.0), PLATE, (0.0, PLATE[1])]),
        *(circle + centre for centre in centres),
    ]
    (region,) = regions(loops)
    beads = Beads(SPACING, 0.2 * SPACING, 2.0, chord_error=CHORD_ERROR)
    library = shapely()
    ours, bare = [], []
    for _ in range(FILL_ROUNDS):
        start = process_time()
        assert (
            sum(curve.kind == "line" for curve in fill(region, beads, "lines"))
            > PLATE[1] / SPACING - 5.0
        )
        ours.append(process_time() - start)
        start = process_time()
        inner = library.geometry.Polygon(loops[0], loops[1:]).buffer(
            -1.5 * SPACING, **{library.arcs: 8}
        )
        rows = np.arange(2.0 * SPACING, PLATE[1] - 1.5 * SPACING, SPACING)
        cut = library.geometry.MultiLineString(
            [((0.0, y), (PLATE[0], y)) for y in rows]
        ).intersection(inner)
        assert not cut.is_empty
        bare.append(process_time() - start)
    name = f"lines in a section of {PLATE[0]:g} by {PLATE[1]:g} mm with {HOLES} holes, against its bare border and lines"
    return Row(name, median(ours), median(bare), "s", 1.0 / LINE_TIME_RATIO)


def compare_fields() -> list[Row]:
    corners = np.array(
        [(x, y, z) for x in (0, BLOCK[0]) for y in (0, BLOCK[1]) for z in (0, BLOCK[2])],
        dtype=float,
    )
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = np.array([three for a, b, c, d in sides for three in ((a, c, b), (a, d, c))])
    times, sizes = [], []
    for step in STEPS:
        rounds = []
        for _ in range(FILL_ROUNDS):
            start = process_time()
            grid = voxels(corners, faces.astype(np.intp), step)
            linked = eikonal.links(grid)
            up = grid.places(linked.nodes)[:, 2]
            seeds = np.flatnonzero(up < step)
            distances = eikonal.arrival(linked, step, seeds, up[seeds])
            rounds.append(process_time() - start)
        assert np.abs(distances - up).max() < 1e-6
        times.append(median(rounds))
        sizes.append(len(linked.nodes))
    coarse_count, fine_count = sizes
    return [
        Row(
            f"distance through a solid at {coarse_count:,} nodes, against {FIELD_TIME_S:g} s",
            times[0],
            FIELD_TIME_S,
            "s",
            1.0,
        ),
        Row(
            f"distance through a solid at {fine_count:,} nodes, against {fine_count / coarse_count:.2f} times the time of {coarse_count:,}",
            times[1],
            times[0] * fine_count / coarse_count,
            "s",
            0.5,
        ),
    ]
