# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parallel curves of a region of 2,000 points, as arrays, against the bare library doing the same; a bracket cut and filled
with contours against its bare parallel curves; the distance through a solid that curved layers are levels of."""

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
DEEPEST, CHORD_ERROR = 20.0, 0.02  # mm
WITHIN = 1.5  # times the bare library
FEWER = choose(3, 1)
BRACKET = Path(__file__).resolve().parent.parent / "resources" / "examples" / "bracket.step"
# of the bracket; mm; times its bare parallel curves, most of it for the middles that these leave open
SECTIONS, SPACING, SEVERAL = choose(100, 2), 4.0, 80.0
# a plate with holes, mm; lines in it, times its bare border and lines cut off there, which leave 428 gaps beside the holes:
# closing them is most of it
PLATE, HOLES, LINES = (400.0, 300.0), choose(20, 2), 1300.0
BLOCK, STEPS, FIELD = (
    (100.0, 80.0, 25.0),
    choose((1.0, 0.5848), (8.0, 5.0)),
    5.0,
)  # mm; 200,000 and a million nodes; s


def run() -> list[Row]:
    """Offsets, and fields, the latter against the time asked for and against themselves."""
    return [*_offsets(), _filled(), _lines(), *_fields()]


def _offsets() -> list[Row]:
    angle = 2.0 * np.pi * np.arange(POINTS) / POINTS
    radius = 100.0 + 10.0 * np.sin(5.0 * angle)
    loop = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    distances = -DEEPEST * np.arange(1, OFFSETS + 1) / OFFSETS
    library = shapely()
    ours, bare = (
        [],
        [],
    )  # CPU time of either in turn, so that what else the machine does counts for neither
    for _ in range(ROUNDS):
        start = process_time()
        (region,) = regions([loop])
        for distance in distances:
            for part in region.grown(float(distance), CHORD_ERROR):
                part.borders()
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
    return [Row(name, median(ours), median(bare), "s", 1.0 / WITHIN)]


def _filled() -> Row:
    """Contours with the beads between them that close gaps, against the parallel curves alone, which leave these open."""
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
        whole = library.geometry.Polygon(rings[0], rings[1:])
        left, depth = whole, 0.5 * SPACING
        while not left.is_empty:
            left = whole.buffer(-depth, **{library.arcs: 8})
            depth += SPACING
    bare = process_time() - start
    name = (
        f"{SECTIONS} sections of a bracket filled with contours, against their bare parallel curves"
    )
    return Row(name, ours, bare, "s", 1.0 / SEVERAL)


def _lines() -> Row:
    """Lines within a contour, against the library's own border, one bead in, and parallel lines cut off there."""
    angle = np.linspace(0.0, 2.0 * np.pi, 120, endpoint=False)
    circle = 12.0 * np.stack([np.cos(angle), -np.sin(angle)], axis=1)
    places = [(50.0 + 75.0 * (k % 5), 40.0 + 73.0 * (k // 5)) for k in range(HOLES)]
    loops = [
        np.array([(0.0, 0.0), (PLATE[0], 0.0), PLATE, (0.0, PLATE[1])]),
        *(circle + place for place in places),
    ]
    (region,) = regions(loops)
    beads = Beads(SPACING, 0.2 * SPACING, 2.0, chord_error=CHORD_ERROR)
    library = shapely()
    ours, bare = [], []
    for _ in range(FEWER):
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
    return Row(name, median(ours), median(bare), "s", 1.0 / LINES)


def _fields() -> list[Row]:
    corners = np.array(
        [(x, y, z) for x in (0, BLOCK[0]) for y in (0, BLOCK[1]) for z in (0, BLOCK[2])],
        dtype=float,
    )
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = np.array([three for a, b, c, d in sides for three in ((a, c, b), (a, d, c))])
    times, sizes = [], []
    for step in STEPS:
        rounds = []
        for _ in range(FEWER):
            start = process_time()
            grid = voxels(corners, faces.astype(np.intp), step)
            linked = eikonal.links(grid)
            up = grid.places(linked.nodes)[:, 2]
            seeds = np.flatnonzero(up < step)
            found = eikonal.arrival(linked, step, seeds, up[seeds])
            rounds.append(process_time() - start)
        assert np.abs(found - up).max() < 1e-6
        times.append(median(rounds))
        sizes.append(len(linked.nodes))
    few, many = sizes
    return [
        Row(
            f"distance through a solid at {few:,} nodes, against {FIELD:g} s",
            times[0],
            FIELD,
            "s",
            1.0,
        ),
        Row(
            f"distance through a solid at {many:,} nodes, against {many / few:.2f} times the time of {few:,}",
            times[1],
            times[0] * many / few,
            "s",
            0.5,
        ),
    ]
