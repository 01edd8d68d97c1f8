# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare the waypoints.csv of a planned wall with the wall as FreeCAD reads it, without
freecad_am."""

import csv
import json
import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

SAMPLE_NEIGHBOURS = 16  # the nearest point is searched for near this many samples of a line
SAMPLING = 0.02  # mm, the largest distance of samples from their wall
COLUMNS = ("x_mm", "y_mm", "z_mm", "bx", "by", "bz", "tx", "ty", "tz")


@dataclass(frozen=True)
class Pass:
    """One bead: points, build directions and tool axes (n, 3)."""

    layer: int
    points: np.ndarray
    build: np.ndarray
    tool: np.ndarray

    @cached_property
    def closed(self):
        return bool(np.array_equal(self.points[0], self.points[-1]))


@dataclass(frozen=True)
class Planned:
    """The report and the beads of a run, in the order of deposit."""

    report: dict
    passes: list[Pass]

    @cached_property
    def layers(self):
        """Return the beads of each layer."""
        return [
            [bead for bead in self.passes if bead.layer == layer]
            for layer in range(self.passes[-1].layer + 1)
        ]

    @cached_property
    def points(self):
        return np.concatenate([bead.points for bead in self.passes])


def read(folder: Path) -> Planned:
    """Read the run whose outputs are in a folder."""
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    with open(folder / "waypoints.csv", encoding="utf-8", newline="") as stream:
        lines = csv.reader(stream)
        column_numbers = {name: number for number, name in enumerate(next(lines))}
        first_column, last_column = column_numbers["x_mm"], column_numbers["tz"]
        assert [
            name for name, number in column_numbers.items() if first_column <= number <= last_column
        ] == list(COLUMNS)
        rows = [line for line in lines if line[column_numbers["kind"]] == "deposit"]
    bead = np.array(
        [[line[column_numbers["layer"]], line[column_numbers["bead"]]] for line in rows], dtype=int
    )
    values = np.array([line[first_column : last_column + 1] for line in rows], dtype=float)
    starts = np.flatnonzero(np.any(np.diff(bead, axis=0, prepend=-1), axis=1))
    passes = [
        Pass(
            int(bead[start, 0]),
            values[start:end, :3],
            values[start:end, 3:6],
            values[start:end, 6:],
        )
        for start, end in zip(starts, [*starts[1:], len(rows)], strict=True)
    ]
    return Planned(report, passes)


@dataclass(frozen=True)
class Foot:
    """For points (n, 3): the distance from some lines, and whether the nearest position is the end
    of an open line."""

    distance: np.ndarray
    at_end: np.ndarray


def nearest(points: np.ndarray, lines: list[np.ndarray]) -> Foot:
    """Return the nearest positions on polylines, from every segment that starts or ends at one of
    the nearest samples."""
    a, b, begins, ends = [], [], [], []
    for line in lines:
        open_ = not np.array_equal(line[0], line[-1])
        step = np.linalg.norm(np.diff(line, axis=0), axis=1)
        dense = _dense(line, max(0.25, 2.0 * np.median(step)))
        a.append(dense[:-1])
        b.append(dense[1:])
        marks = np.zeros((2, len(dense) - 1), dtype=bool)
        marks[0, 0] = marks[1, -1] = open_
        begins.append(marks[0])
        ends.append(marks[1])
    a, b, begins, ends = map(np.concatenate, (a, b, begins, ends))
    tree = cKDTree(0.5 * (a + b))
    k = min(SAMPLE_NEIGHBOURS, len(a))
    best, at_end = np.full(len(points), np.inf), np.zeros(len(points), dtype=bool)
    for stretch in tree.query(points, k=k)[1].reshape(len(points), k).T:
        along = b[stretch] - a[stretch]
        t = ((points - a[stretch]) * along).sum(1) / np.maximum((along * along).sum(1), 1e-300)
        t = np.clip(t, 0.0, 1.0)
        distance = np.linalg.norm(points - a[stretch] - t[:, None] * along, axis=1)
        better = distance < best
        best = np.where(better, distance, best)
        end = (begins[stretch] & (t == 0.0)) | (ends[stretch] & (t == 1.0))
        at_end = np.where(better, end, at_end)
    return Foot(best, at_end)


def _dense(line: np.ndarray, longest: float) -> np.ndarray:
    """Return the polyline with more points, so that no segment is longer than the limit."""
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    is_new = np.r_[True, np.diff(length) > 0.0]
    line, length = line[is_new], length[is_new]
    counts = np.ceil(np.diff(length) / longest).astype(int)
    sample_lengths = np.concatenate(
        [
            length[:1],
            *(np.linspace(s, e, n + 1)[1:] for s, e, n in zip(length[:-1], length[1:], counts)),
        ]
    )
    return np.column_stack([np.interp(sample_lengths, length, line[:, axis]) for axis in range(3)])


@dataclass(frozen=True)
class Spacing:
    """Distances of points from the beads of the layer below, for all layers but the first:
    `inside`; `at_ends`, to the end of a bead that was cut; and one array for each bead that closes
    a gap between fronts, which is nearer everywhere."""

    inside: np.ndarray
    at_ends: np.ndarray
    closing: list[np.ndarray]


def spacing(planned: Planned, height: float, tolerance: float) -> Spacing:
    """Return the distances from every point of a layer to the polylines of the layer below."""
    feet, closing = [], []
    for below, above in zip(planned.layers, planned.layers[1:], strict=False):
        lines = [bead.points for bead in below]
        for bead in above:
            foot = nearest(bead.points, lines)
            if (foot.distance < height - tolerance).mean() > 0.9:
                closing.append(foot.distance)
            else:
                feet.append(foot)
    distance = np.concatenate([foot.distance for foot in feet])
    at_end = np.concatenate([foot.at_end for foot in feet])
    return Spacing(distance[~at_end], distance[at_end], closing)


def support(planned: Planned, depth: Callable[[np.ndarray], np.ndarray]) -> float:
    """Return the largest distance of a point from the deposit before its bead, or from the
    substrate."""
    worst = 0.0
    for number, bead in enumerate(planned.passes):
        distance = np.abs(depth(bead.points))
        earlier = [
            earlier_bead.points
            for earlier_bead in planned.passes[:number]
            if bead.layer - earlier_bead.layer <= 2
        ]
        if earlier:
            distance = np.minimum(distance, nearest(bead.points, earlier).distance)
        worst = max(worst, float(distance.max()))
    return worst


def turn_rate(planned: Planned) -> float:
    """Return the largest turn of the build direction, in deg/mm, over 1 mm of a bead."""
    rate = 0.0
    for bead in planned.passes:
        cosine = np.clip((bead.build[1:] * bead.build[:-1]).sum(1), -1.0, 1.0)
        turn = np.degrees(np.arccos(cosine))
        length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        total = np.r_[0.0, np.cumsum(turn)]
        if length[-1] > 1.0:
            sample_lengths = np.arange(0.0, length[-1] - 1.0, 0.25)
            rate = max(
                rate,
                float(
                    (
                        np.interp(sample_lengths + 1.0, length, total)
                        - np.interp(sample_lengths, length, total)
                    ).max()
                ),
            )
    return rate


def seam_steps(planned: Planned) -> np.ndarray:
    """Return the distances between the starts of consecutive layers that are one closed bead
    each."""
    pairs = zip(planned.layers, planned.layers[1:], strict=False)
    starts = [
        (low[0], high[0])
        for low, high in pairs
        if len(low) == len(high) == 1 and low[0].closed and high[0].closed
    ]
    return np.array([np.linalg.norm(high.points[0] - low.points[0]) for low, high in starts])


def nozzle_depth(
    bead: Pass,
    depth: Callable[[np.ndarray], np.ndarray],
    tip: float,
    length: float,
    half_angle: float,
) -> float:
    """Return the smallest distance of the nozzle, a cone (mm, rad) around the tool axes of a bead,
    from the substrate; negative inside."""
    across = np.cross(bead.tool, np.eye(3)[np.argmin(np.abs(bead.tool), axis=1)])
    across /= np.linalg.norm(across, axis=1)[:, None]
    sideways, smallest = np.cross(bead.tool, across), np.inf
    for height in np.r_[0.0, 0.5, 1.0, 2.0, np.arange(3.0, length + 1.0, 3.0)]:
        radius = tip + height * np.tan(half_angle)
        for turn in np.arange(24) * np.pi / 12.0:
            skin = height * bead.tool + radius * (np.cos(turn) * across + np.sin(turn) * sideways)
            smallest = min(smallest, float(depth(bead.points + skin).min()))
    return smallest


def _distance(shape: Part.Shape, point: FreeCAD.Vector) -> float:
    """Return the smaller distance of two methods, because OCC's extrema miss some points of a torus
    that a projection has."""
    distances = [shape.distToShape(Part.Vertex(point))[0]]
    if distances[0] > 1e-6:
        for face in shape.Faces:
            u, v = face.Surface.parameter(point)
            if face.isPartOfDomain(u, v):
                distances.append((face.Surface.value(u, v) - point).Length)
    return min(distances)


@dataclass(frozen=True)
class Wall:
    """A wall from its STEP file. `depth`: distance (n,) of points (n, 3) from the substrate's skin,
    positive outside."""

    shape: Part.Shape
    depth: Callable[[np.ndarray], np.ndarray]

    def off(self, points: np.ndarray) -> float:
        """Return the largest distance of points from the faces."""
        return max(_distance(self.shape, FreeCAD.Vector(*point)) for point in points)

    def samples(self, step: float) -> np.ndarray:
        """Return points all over the faces outside the substrate, about `step` apart."""
        points = np.concatenate([_face_samples(face, step) for face in self.shape.Faces])
        # slivers of a tessellation have hundreds of times as many points, so keep one in each cube
        # of a fifth of the step
        points = points[
            np.unique(np.floor(points / (0.2 * step)).astype(np.int64), axis=0, return_index=True)[
                1
            ]
        ]
        return points[self.depth(points) > 0.0]

    def end_edges(self, step: float) -> np.ndarray:
        """Return points of the edges at which the wall ends; edges along its sides reach into the
        substrate and are left out."""
        shared = Counter(edge.hashCode() for face in self.shape.Faces for edge in face.Edges)
        edges = []
        for face in self.shape.Faces:
            for edge in face.Edges:
                if shared[edge.hashCode()] > 1 or edge.isSeam(face) or edge.Length < 1e-6:
                    continue
                points = _array(edge.discretize(Number=max(3, math.ceil(edge.Length / step))))
                if (self.depth(points) > 0.0).all():
                    edges.append(points)
        return np.concatenate(edges) if edges else np.empty((0, 3))


def bounds(path: Path) -> np.ndarray:
    """Return (2, 3) mm, the smallest and largest coordinates of the shape of a STEP file."""
    shape = Part.Shape()
    shape.read(str(path))
    box = shape.BoundBox
    return np.array([[box.XMin, box.YMin, box.ZMin], [box.XMax, box.YMax, box.ZMax]])


def read_wall(path: Path, depth: Callable[[np.ndarray], np.ndarray]) -> Wall:
    """Return the wall of a STEP file."""
    shape = Part.Shape()
    shape.read(str(path))
    return Wall(shape, depth)


def coverage(planned: Planned, wall: Wall, step: float, near_end: float) -> tuple[float, float]:
    """Return the largest distance of a point of the wall from a bead: (elsewhere, within `near_end`
    of its end)."""
    samples = wall.samples(step)
    distance = nearest(samples, [bead.points for bead in planned.passes]).distance
    edge = wall.end_edges(0.5 * step)
    at_end = cKDTree(edge).query(samples)[0] <= near_end
    return float(distance[~at_end].max()), float(distance[at_end].max())


def _face_samples(face: Part.Face, step: float) -> np.ndarray:
    """Return points within SAMPLING of a face: its triangles, divided until they are small."""
    vertices, triangles = face.tessellate(SAMPLING)
    corners = _array(vertices)[np.array(triangles)]
    points = []
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    for count in np.unique(np.ceil(longest / step).astype(int)):
        subset = corners[np.ceil(longest / step).astype(int) == count]
        i, j = np.nonzero(np.add.outer(np.arange(count + 1), np.arange(count + 1)) <= count)
        share = np.column_stack([i, j, count - i - j]) / count
        points.append(np.einsum("sk,mkc->msc", share, subset).reshape(-1, 3))
    return np.unique(np.round(np.concatenate(points), 3), axis=0)


def _array(vectors: list) -> np.ndarray:
    return np.array([tuple(vector) for vector in vectors])
