# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was planned on a wall, read from waypoints.csv, against the wall as FreeCAD reads it: nothing of freecad_am."""

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

NEAR = 16  # samples of a line in whose neighbourhood the nearest point is sought
SAMPLING = 0.02  # mm, how far samples of a wall may lie off it
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
        """The beads of each layer."""
        return [
            [one for one in self.passes if one.layer == layer]
            for layer in range(self.passes[-1].layer + 1)
        ]

    @cached_property
    def points(self):
        return np.concatenate([one.points for one in self.passes])


def read(folder: Path) -> Planned:
    """The run whose outputs lie in a folder."""
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    with open(folder / "waypoints.csv", encoding="utf-8", newline="") as stream:
        lines = csv.reader(stream)
        places = {name: place for place, name in enumerate(next(lines))}
        first, last = places["x_mm"], places["tz"]
        assert [name for name, place in places.items() if first <= place <= last] == list(COLUMNS)
        rows = [line for line in lines if line[places["kind"]] == "deposit"]
    bead = np.array([[line[places["layer"]], line[places["bead"]]] for line in rows], dtype=int)
    values = np.array([line[first : last + 1] for line in rows], dtype=float)
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
    """Of points (n, 3): how far they are from some lines, and whether the nearest place is the end of an open one."""

    distance: np.ndarray
    at_end: np.ndarray


def nearest(points: np.ndarray, lines: list[np.ndarray]) -> Foot:
    """The nearest places on polylines: every stretch that begins or ends at one of the nearest samples is tried."""
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
    k = min(NEAR, len(a))
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
    """The polyline with further points on it, so that no stretch is longer."""
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    kept = np.r_[True, np.diff(length) > 0.0]
    line, length = line[kept], length[kept]
    counts = np.ceil(np.diff(length) / longest).astype(int)
    at = np.concatenate(
        [
            length[:1],
            *(np.linspace(s, e, n + 1)[1:] for s, e, n in zip(length[:-1], length[1:], counts)),
        ]
    )
    return np.column_stack([np.interp(at, length, line[:, axis]) for axis in range(3)])


@dataclass(frozen=True)
class Spacing:
    """Distances of the points of all layers but the first from the beads below: `inside`; `at_ends`, to the end of a bead
    that was cut; and of the beads that close a gap between fronts, one array each, which lie nearer everywhere."""

    inside: np.ndarray
    at_ends: np.ndarray
    closing: list[np.ndarray]


def spacing(planned: Planned, height: float, tolerance: float) -> Spacing:
    """From every point of a layer to the polylines of the layer below."""
    feet, closing = [], []
    for below, above in zip(planned.layers, planned.layers[1:], strict=False):
        lines = [one.points for one in below]
        for one in above:
            foot = nearest(one.points, lines)
            if (foot.distance < height - tolerance).mean() > 0.9:
                closing.append(foot.distance)
            else:
                feet.append(foot)
    distance = np.concatenate([foot.distance for foot in feet])
    at_end = np.concatenate([foot.at_end for foot in feet])
    return Spacing(distance[~at_end], distance[at_end], closing)


def support(planned: Planned, depth: Callable[[np.ndarray], np.ndarray]) -> float:
    """How far a point is at most from what was deposited before its bead, or from the substrate."""
    worst = 0.0
    for number, one in enumerate(planned.passes):
        distance = np.abs(depth(one.points))
        before = [other.points for other in planned.passes[:number] if one.layer - other.layer <= 2]
        if before:
            distance = np.minimum(distance, nearest(one.points, before).distance)
        worst = max(worst, float(distance.max()))
    return worst


def turn_rate(planned: Planned) -> float:
    """The largest turn of the build direction, deg/mm, over stretches of 1 mm of a bead."""
    rate = 0.0
    for one in planned.passes:
        cosine = np.clip((one.build[1:] * one.build[:-1]).sum(1), -1.0, 1.0)
        turn = np.degrees(np.arccos(cosine))
        length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(one.points, axis=0), axis=1))]
        total = np.r_[0.0, np.cumsum(turn)]
        if length[-1] > 1.0:
            at = np.arange(0.0, length[-1] - 1.0, 0.25)
            rate = max(
                rate,
                float((np.interp(at + 1.0, length, total) - np.interp(at, length, total)).max()),
            )
    return rate


def seam_steps(planned: Planned) -> np.ndarray:
    """Distances between the starts of beads of consecutive layers that are one closed bead each."""
    pairs = zip(planned.layers, planned.layers[1:], strict=False)
    starts = [
        (low[0], high[0])
        for low, high in pairs
        if len(low) == len(high) == 1 and low[0].closed and high[0].closed
    ]
    return np.array([np.linalg.norm(high.points[0] - low.points[0]) for low, high in starts])


def nozzle_depth(
    one: Pass,
    depth: Callable[[np.ndarray], np.ndarray],
    tip: float,
    length: float,
    half_angle: float,
) -> float:
    """How far the nozzle, a cone (mm, rad) around the tool axes of a bead, stays away from the substrate; less than
    nothing inside of it."""
    across = np.cross(one.tool, np.eye(3)[np.argmin(np.abs(one.tool), axis=1)])
    across /= np.linalg.norm(across, axis=1)[:, None]
    sideways, least = np.cross(one.tool, across), np.inf
    for height in np.r_[0.0, 0.5, 1.0, 2.0, np.arange(3.0, length + 1.0, 3.0)]:
        radius = tip + height * np.tan(half_angle)
        for turn in np.arange(24) * np.pi / 12.0:
            skin = height * one.tool + radius * (np.cos(turn) * across + np.sin(turn) * sideways)
            least = min(least, float(depth(one.points + skin).min()))
    return least


def _distance(shape: Part.Shape, point: FreeCAD.Vector) -> float:
    """From the nearest place that is found: OCC's extrema miss it at some points of a torus, where a projection has it."""
    found = [shape.distToShape(Part.Vertex(point))[0]]
    if found[0] > 1e-6:
        for face in shape.Faces:
            u, v = face.Surface.parameter(point)
            if face.isPartOfDomain(u, v):
                found.append((face.Surface.value(u, v) - point).Length)
    return min(found)


@dataclass(frozen=True)
class Wall:
    """A wall from its STEP file. `depth`: distance (n,) of points (n, 3) from the substrate's skin, positive outside."""

    shape: Part.Shape
    depth: Callable[[np.ndarray], np.ndarray]

    def off(self, points: np.ndarray) -> float:
        """How far points are at most from the faces."""
        return max(_distance(self.shape, FreeCAD.Vector(*point)) for point in points)

    def samples(self, step: float) -> np.ndarray:
        """Points all over the faces, about `step` apart, that are not in the substrate."""
        points = np.concatenate([_face_samples(face, step) for face in self.shape.Faces])
        # slivers of a tessellation have hundreds of times as many: one in each cube of a fifth of the step
        points = points[
            np.unique(np.floor(points / (0.2 * step)).astype(np.int64), axis=0, return_index=True)[
                1
            ]
        ]
        return points[self.depth(points) > 0.0]

    def end_edges(self, step: float) -> np.ndarray:
        """Points of the edges at which the wall ends; edges along its sides reach into the substrate and are left out."""
        shared = Counter(edge.hashCode() for face in self.shape.Faces for edge in face.Edges)
        found = []
        for face in self.shape.Faces:
            for edge in face.Edges:
                if shared[edge.hashCode()] > 1 or edge.isSeam(face) or edge.Length < 1e-6:
                    continue
                points = _array(edge.discretize(Number=max(3, math.ceil(edge.Length / step))))
                if (self.depth(points) > 0.0).all():
                    found.append(points)
        return np.concatenate(found) if found else np.empty((0, 3))


def bounds(path: Path) -> np.ndarray:
    """(2, 3) mm, the least and the largest coordinates of the shape of a STEP file."""
    shape = Part.Shape()
    shape.read(str(path))
    box = shape.BoundBox
    return np.array([[box.XMin, box.YMin, box.ZMin], [box.XMax, box.YMax, box.ZMax]])


def read_wall(path: Path, depth: Callable[[np.ndarray], np.ndarray]) -> Wall:
    """The wall of a STEP file."""
    shape = Part.Shape()
    shape.read(str(path))
    return Wall(shape, depth)


def coverage(planned: Planned, wall: Wall, step: float, near_end: float) -> tuple[float, float]:
    """The farthest that a point of the wall is from a bead: (anywhere else, within `near_end` of its end)."""
    samples = wall.samples(step)
    distance = nearest(samples, [one.points for one in planned.passes]).distance
    edge = wall.end_edges(0.5 * step)
    at_end = cKDTree(edge).query(samples)[0] <= near_end
    return float(distance[~at_end].max()), float(distance[at_end].max())


def _face_samples(face: Part.Face, step: float) -> np.ndarray:
    """Points within SAMPLING of a face: its triangles, divided until they are small."""
    vertices, triangles = face.tessellate(SAMPLING)
    corners = _array(vertices)[np.array(triangles)]
    found = []
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    for count in np.unique(np.ceil(longest / step).astype(int)):
        some = corners[np.ceil(longest / step).astype(int) == count]
        i, j = np.nonzero(np.add.outer(np.arange(count + 1), np.arange(count + 1)) <= count)
        share = np.column_stack([i, j, count - i - j]) / count
        found.append(np.einsum("sk,mkc->msc", share, some).reshape(-1, 3))
    return np.unique(np.round(np.concatenate(found), 3), axis=0)


def _array(vectors: list) -> np.ndarray:
    return np.array([tuple(vector) for vector in vectors])
