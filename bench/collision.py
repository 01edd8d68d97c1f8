# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collision queries against python-fcl (Flexible Collision Library) on the same scene, and the cost
of clearance along a bead of 40,000 points: peak memory, and time against a bead with a quarter of
the points. The scene is a wall of 40 layers of beads 8 mm wide; the queries imitate a tilt-back,
with tips along a neighbouring bead and axes tilted by up to 45 deg. A pipe of triangles replaces
the wall in a second scene. Both libraries must agree wherever the nozzle is farther from contact
than the library's pyramid differs from the cone. Times are processor seconds for all queries, the
better of two rounds in turns."""

from __future__ import annotations

import resource
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).resolve().parent.parent)]

from freecad_am.core.collision import deposit
from freecad_am.core.collision.frustum import Frustum
from freecad_am.core.collision.obstacles import Obstacles
from freecad_am.core.collision.scene import Scene, scene
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.strategies.clearance.clear_by_tilt import keep_clear
from freecad_am.core.toolpath import Bead, Layer, Toolpath

from rows import Row
from sizes import choose

LAYERS, QUERY_COUNT, ROUNDS = choose((40, 100, 2), (20, 20, 1))
NOZZLE = Frustum(0.5, float(np.tan(np.radians(20.0))), 1.0, 60.0)
LONG_BEAD_POINTS, SHORT_BEAD_POINTS = choose((40_000, 10_000), (800, 400))
BEAD_SPAN_MM, MAX_MEMORY_MB, MAX_TIME_RATIO = 1500.0, 500.0, 4.5
Array = np.ndarray


def run() -> list[Row]:
    """Return all comparisons."""
    return [*compare_with_fcl(), *compare_bead_lengths()]


def build_wall() -> tuple[Scene, Array]:
    """Build a finished wall along y; return its scene and the points of its beads (n, 3)."""
    y = np.linspace(-60.0, 60.0, 61)
    points = np.concatenate(
        [np.stack([np.zeros(61), y, np.full(61, float(z))], axis=1) for z in range(LAYERS)]
    )
    build = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    laid = deposit.build_deposit(points, build, 8.0, 1.0, np.arange(0, len(points), 61))
    return scene([], points, 100.0, laid), points


def compare_with_fcl() -> list[Row]:
    scene, _ = build_wall()
    rng = np.random.default_rng(11)
    tip = np.stack(
        [
            rng.uniform(8.0, 45.0, QUERY_COUNT),
            rng.uniform(-55.0, 55.0, QUERY_COUNT),
            rng.uniform(0.0, 20.0, QUERY_COUNT),
        ],
        axis=1,
    )
    lean, turn = (
        rng.uniform(0.0, np.pi / 4, QUERY_COUNT),
        rng.uniform(0.0, 2.0 * np.pi, QUERY_COUNT),
    )
    axis = np.stack(
        [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)], axis=1
    )
    try:
        from fcl_obstacles import FclObstacles
    except ImportError:
        return [
            Row(
                f"touched and distance at {QUERY_COUNT} looks, against python-fcl",
                0.0,
                None,
                "s",
                1.0,
            )
        ]
    wall, pipe = timeless_obstacles(scene), build_pipe()
    return [
        compare_queries(
            "find_touching",
            pipe,
            FclObstacles(pipe),
            tip,
            axis,
            f"a pipe of {len(pipe.corners):,} triangles",
        ),
        compare_queries(
            "distance", wall, FclObstacles(wall), tip, axis, f"a wall of {LAYERS} layers of beads"
        ),
    ]


def compare_queries(
    name: str, obstacles: Obstacles, peer: Any, tip: Array, axis: Array, what: str
) -> Row:
    ours, theirs = [], []
    for _ in range(ROUNDS):
        start = process_time()
        answers = getattr(obstacles, name)(NOZZLE, tip, axis)
        ours.append(process_time() - start)
        start = process_time()
        peer_answers = getattr(peer, name)(NOZZLE, tip, axis)
        theirs.append(process_time() - start)
    tolerance = peer.max_difference(NOZZLE)
    if name == "distance":
        assert np.abs(answers - peer_answers).max() < tolerance + 1e-3, "they say other distances"
    else:
        distance = obstacles.distance(NOZZLE, tip, axis)
        smaller = obstacles.find_touching(
            replace(NOZZLE, radius=NOZZLE.radius - tolerance * np.hypot(1.0, NOZZLE.slope)),
            tip,
            axis,
        )
        assert 0.1 < answers.mean() < 0.9, f"looks that say nothing: {answers.mean()}"
        assert (peer_answers == answers)[(distance > 1e-3) | smaller].all(), (
            "they do not touch the same"
        )
    return Row(
        f"{name} at {QUERY_COUNT} looks at {what}, against python-fcl",
        min(ours),
        min(theirs),
        "s",
        1.0,
    )


def build_pipe(sides: int = 400, rings: int = 25) -> Obstacles:
    """Build the triangles of a pipe about y."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    x, z = 16.0 * np.cos(turn), 16.0 * np.sin(turn) + 22.0
    points = np.stack(
        [np.stack([x, np.full(sides, y), z], axis=1) for y in np.linspace(-60, 60, rings)]
    )
    a, b, c, d = (
        points[:-1],
        np.roll(points, -1, axis=1)[:-1],
        points[1:],
        np.roll(points, -1, axis=1)[1:],
    )
    return Obstacles(
        np.concatenate([np.stack([a, b, c], axis=2), np.stack([b, d, c], axis=2)]).reshape(-1, 3, 3)
    )


def timeless_obstacles(scene: Scene) -> Obstacles:
    """Return the solids of a scene's beads as obstacles without a time of deposit."""
    deposit = scene.deposit
    assert deposit is not None
    return Obstacles(deposit.corners, None, deposit.radius, deposit.line, deposit.foot)


def compare_bead_lengths() -> list[Row]:
    """Measure memory and time of beads of both lengths, each in its own process."""
    results = {}
    for count in (SHORT_BEAD_POINTS, LONG_BEAD_POINTS):
        command = [sys.executable, __file__, str(count)]
        process = subprocess.run(
            command,
            check=True,
            capture_output=True,
            text=True,
            cwd=Path(__file__).resolve().parent.parent,
        )
        results[count] = [float(word) for word in process.stdout.split()]
    return [
        Row(
            f"nozzle kept clear along {LONG_BEAD_POINTS:,} points, {results[LONG_BEAD_POINTS][2]:.0f} of them tilted: peak memory, against what is "
            "allowed",
            results[LONG_BEAD_POINTS][1],
            MAX_MEMORY_MB,
            "MB",
            1.0,
        ),
        Row(
            f"nozzle kept clear along {LONG_BEAD_POINTS:,} points, against {MAX_TIME_RATIO:g} times what {SHORT_BEAD_POINTS:,} take",
            results[LONG_BEAD_POINTS][0],
            MAX_TIME_RATIO * results[SHORT_BEAD_POINTS][0],
            "s",
            1.0,
        ),
    ]


def measure_clearance(count: int) -> tuple[float, float, int]:
    """Return processor seconds, peak memory (MB) and tilted points of a bead that meanders past a
    wall at one end."""
    s = np.linspace(0.0, BEAD_SPAN_MM, count)
    points = np.stack(
        [
            16.0 + 60.0 * (1.0 - np.cos(2.0 * np.pi * s / BEAD_SPAN_MM)),
            120.0 * s / BEAD_SPAN_MM - 60.0,
            0.0 * s,
        ],
        axis=1,
    )
    y = np.linspace(-60.0, 60.0, 31)
    wall = [np.stack([np.zeros(31), y, np.full(31, float(z))], axis=1) for z in range(LAYERS)]
    path = Toolpath(
        tuple(Layer((_bead(points_of_bead),)) for points_of_bead in (*wall, points)),
        np.eye(4),
        1.0,
        0.01,
        family="surface",
        bead_width=8.0,
    )
    start = process_time()
    cleared = keep_clear(path, [], NozzleParameters(), BuildDirectionParameters())
    took = process_time() - start
    tilted = int((cleared.layers[-1].beads[0].tool[:, 2] < 1.0 - 1e-9).sum())
    return took, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0, tilted


def _bead(points: Array) -> Bead:
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    return Bead(points, up, up, 2.0 * np.pi * length / length[-1], np.full(len(points), 6.0), False)


if __name__ == "__main__":
    print(*measure_clearance(int(sys.argv[1])))
