# SPDX-License-Identifier: LGPL-2.1-or-later
"""A mesh of a Y as a wall in layers, and tilts that keep the nozzle clear along its beads, against the build of 2026-11-28.

That build is taken from the repository's history; where the history is not there, the rows go without. Both run the same
mesh as processes of their own, in turns. Ours must give beads of the same lengths, the same kinds of issues, and tools that
lean and turn no more. Processor's seconds, the better of the rounds.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

if __name__ == "__main__":
    sys.path[:0] = [sys.argv[1], str(Path(__file__).resolve().parent)]

from freecad_am.batch import host

from rows import Row
from sizes import choose

ROOT = Path(__file__).resolve().parent.parent
EARLIER_COMMIT = "9368a6fd0e62f0654f59e8235e864a80e65c8b9c"  # of 2026-11-28
HEIGHT, SIZE, CELL, ROUNDS = choose((3.0, 200.0, 4.0, 2), (5.0, 60.0, 3.0, 1))  # mm
STEM_RADIUS, ARM_RADIUS, FORK_HEIGHT, BLEND_LENGTH = (
    0.09,
    0.08,
    0.4,
    0.06,
)  # radii and fork of a Y of height 1
REQUIRED_RATIO = 10.0
SAME, WORSE = (
    1e-4,
    0.02,
)  # relative differences of lengths, and of leaning and turning, that count as none
CORNERS = ((0, 0), (-1, 0), (-1, -1), (0, -1))  # cells about an edge of the grid, in order


class Took(NamedTuple):
    """What a build takes and gives.

    layers, tilts: processor's seconds. points, tilted: numbers of points and of tilted ones. length: of all beads, mm.
    lean: root of the mean squared angle between requested and tilted axes, rad. turn: of the axes along all beads, rad.
    codes: of all issues.
    """

    layers: float
    tilts: float
    points: int
    tilted: int
    length: float
    lean: float
    turn: float
    codes: str

    def no_worse(self, other: Took) -> bool:
        """Whether beads have the same length and tools lean and turn no more than in another build."""
        return (
            abs(self.length - other.length) < SAME * other.length
            and self.lean < (1.0 + WORSE) * other.lean
            and self.turn < (1.0 + WORSE) * other.turn
            and self.codes == other.codes
        )


def run() -> list[Row]:
    """Layers and tilts, each against the earlier build."""
    with tempfile.TemporaryDirectory() as folder:
        earlier = _unpacked(folder)
        builds = [str(ROOT), *([folder] if earlier else [])]
        rounds = [[_measured(build) for build in builds] for _ in range(ROUNDS)]
    for now, *before in rounds:
        assert all(now.no_worse(took) for took in before), f"worse beads or tools: {now}, {before}"
    ours, peers = rounds[0][0], [before for _, *before in rounds if before]
    name = f"a mesh of a Y of {SIZE:g} mm, layers of {HEIGHT:g} mm, {ours.points:,} points"
    return [
        Row(
            f"{name}: {what}, against the build of 2026-11-28",
            min(getattr(now, key) for now, *_ in rounds),
            min(getattr(before, key) for (before,) in peers) if peers else None,
            "s",
            REQUIRED_RATIO,
        )
        for what, key in (("layers", "layers"), (f"tilts of {ours.tilted:,} of them", "tilts"))
    ]


def _unpacked(folder: str) -> bool:
    """Whether the earlier build could be unpacked from the history."""
    asked = ["git", "archive", EARLIER_COMMIT, "freecad_am", "resources"]
    told = subprocess.run(asked, cwd=ROOT, capture_output=True, check=False)
    if told.returncode:
        return False
    with tarfile.open(fileobj=io.BytesIO(told.stdout)) as archive:
        archive.extractall(folder)
    return True


def _measured(build: str) -> Took:
    """What a build takes, in a process of its own."""
    told = subprocess.run(
        [sys.executable, __file__, build], check=True, capture_output=True, text=True, cwd=build
    )
    *numbers, codes = told.stdout.split()
    layers, tilts, points, tilted, *quality = map(float, numbers)
    return Took(layers, tilts, int(points), int(tilted), *quality, codes)


def wye() -> tuple[np.ndarray, np.ndarray]:
    """Vertices and outward triangles of a smooth Y that is open at its ends: one vertex in each cell of a grid that the
    surface crosses, in the middle of its crossings (surface nets)."""
    x, y, z = np.meshgrid(
        np.arange(-0.75 * SIZE, 0.75 * SIZE + CELL, CELL),
        np.arange(-0.16 * SIZE, 0.16 * SIZE + CELL, CELL),
        np.linspace(0.0, SIZE, round(SIZE / CELL) + 1),
        indexing="ij",
    )
    grid, fork = np.stack([x, y, z], axis=-1), np.array([0.0, 0.0, FORK_HEIGHT * SIZE])
    axes = [
        (way, radius)
        for way, radius in (
            ((0, 0, -1), STEM_RADIUS),
            ((1, 0, 1), ARM_RADIUS),
            ((-1, 0, 1), ARM_RADIUS),
        )
    ]
    near = 0.0
    for way, radius in axes:
        along = np.array(way) / np.linalg.norm(way)
        offset = grid - fork
        share = np.maximum(offset @ along, 0.0)
        distance = np.linalg.norm(offset - share[..., None] * along, axis=-1) - radius * SIZE
        near = near + np.exp(-np.maximum(distance / (BLEND_LENGTH * SIZE), -3.0))
    value = -np.log(near)
    cells = np.array(value.shape) - 1
    total, count, crossed = np.zeros((*cells, 3)), np.zeros(cells), []
    for axis in range(3):
        low = np.moveaxis(np.moveaxis(value, axis, 0)[:-1], 0, axis)
        high = np.moveaxis(np.moveaxis(value, axis, 0)[1:], 0, axis)
        edges = np.argwhere((low < 0.0) != (high < 0.0))
        a, b = low[tuple(edges.T)], high[tuple(edges.T)]
        step = np.eye(3, dtype=int)[axis]
        start, end = grid[tuple(edges.T)], grid[tuple((edges + step).T)]
        points = start + (a / (a - b))[:, None] * (end - start)
        around = np.array([np.roll((0, *corner), axis) for corner in CORNERS])
        quads = edges[:, None] + around
        inside = ((quads >= 0) & (quads < cells)).all(axis=2)
        for k in range(4):
            at = tuple(quads[inside[:, k], k].T)
            np.add.at(total, at, points[inside[:, k]])
            np.add.at(count, at, 1.0)
        quads = quads[inside.all(axis=1)]
        outward = (a < 0.0)[inside.all(axis=1)]
        quads[~outward] = quads[~outward, ::-1]
        crossed.append(quads)
    number = np.cumsum(count.ravel() > 0.0).reshape(count.shape) - 1
    vertices = total[count > 0.0] / count[count > 0.0][:, None]
    layer = np.argwhere(count > 0.0)[:, 2]
    vertices[layer == 0, 2], vertices[layer == cells[2] - 1, 2] = 0.0, SIZE
    quads = number[tuple(np.moveaxis(np.concatenate(crossed), -1, 0))]
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _deposited() -> None:
    """Print what this build takes; its modules may have their earlier names."""
    host.find_freecad()
    from freecad_am.core.geometry.obstacles import Body, disc
    from freecad_am.core.parameters.build_direction import BuildDirectionParameters
    from freecad_am.core.parameters.cell import NozzleParameters
    from freecad_am.core.parameters.process import ProcessParameters
    from freecad_am.core.parameters.strategy import SurfaceParameters
    from freecad_am.core.strategies.walls import fronts

    find_wall, keep_clear = _functions()
    wall = find_wall(Body("Y", *wye()), None, HEIGHT, "Y", (), 5.0)
    start = process_time()
    build = BuildDirectionParameters()
    path = fronts.plan(
        wall,
        SurfaceParameters(layer_height=HEIGHT, chord_error=0.05),
        build,
        ProcessParameters(bead_width=2.0 * HEIGHT),
    )
    layers = process_time() - start
    start = process_time()
    clear = keep_clear(path, [disc(2.0 * SIZE, path.frame)], NozzleParameters(), build)
    tilts = process_time() - start
    lean, turn, length, tilted = 0.0, 0.0, 0.0, 0
    for (_, _, asked), (_, _, found) in zip(path, clear):
        steps = np.linalg.norm(np.diff(found.points, axis=0), axis=1)
        length += steps.sum()
        turn += _angles(found.tool[:-1], found.tool[1:]).sum()
        requested = asked.tool[cKDTree(asked.points).query(found.points)[1]]
        angles = _angles(requested, found.tool)
        lean += (0.5 * (angles[:-1] ** 2 + angles[1:] ** 2) * steps).sum()
        tilted += int((angles > 1e-6).sum())
    codes = ",".join(sorted({issue.code for issue in clear.issues}))
    print(layers, tilts, path.point_count, tilted, length, np.sqrt(lean / length), turn, codes)


def _angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles (n,), rad, between unit vectors (n, 3)."""
    return 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - b, axis=1), 0.0, 1.0))


def _functions() -> tuple[Any, Any]:
    """`find_mesh_wall` and `keep_clear`, under the names of either build."""
    try:
        from freecad_am.brep.walls.wall_on import find_mesh_wall
        from freecad_am.core.strategies.clearance.clear_by_tilt import keep_clear
    except ImportError:
        import importlib

        find_mesh_wall = importlib.import_module("freecad_am.brep.walls.mesh_wall").find_mesh_wall
        module = importlib.import_module("freecad_am.core.strategies.clearance.tilt_back")
        return find_mesh_wall, module.kept_clear
    return find_mesh_wall, keep_clear


if __name__ == "__main__":
    _deposited()
