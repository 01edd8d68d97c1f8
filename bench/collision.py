# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collision queries against python-fcl, the Flexible Collision Library, on the same scene; and the nozzle kept clear along a
bead of 40,000 points: memory, and time against one of a quarter of the points.

The scene is a wall of 40 layers of beads 8 mm wide, the looks those of a tilt-back: tips along a bead beside it, axes
turned by up to half a right angle; a pipe of triangles stands where the wall does. Both must say the same wherever the
nozzle is farther from grazing than the library's pyramid is from the cone. Processor's seconds for all looks, the better of
two, ours and the library's in turns.
"""

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

LAYERS, LOOKS, ROUNDS = choose((40, 100, 2), (20, 20, 1))
NOZZLE = Frustum(0.5, float(np.tan(np.radians(20.0))), 1.0, 60.0)
MANY, FEW = choose((40_000, 10_000), (800, 400))
BESIDE, MEMORY, LINEAR = 1500.0, 500.0, 4.5
Array = np.ndarray


def run() -> list[Row]:
    """All comparisons of this file."""
    return [*_queries(), *_long_bead()]


def _wall() -> tuple[Scene, Array]:
    """A finished wall along y, and the points of its beads (n, 3)."""
    y = np.linspace(-60.0, 60.0, 61)
    points = np.concatenate(
        [np.stack([np.zeros(61), y, np.full(61, float(z))], axis=1) for z in range(LAYERS)]
    )
    build = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    laid = deposit.build_deposit(points, build, 8.0, 1.0, np.arange(0, len(points), 61))
    return scene([], points, 100.0, laid), points


def _queries() -> list[Row]:
    there, _ = _wall()
    rng = np.random.default_rng(11)
    tip = np.stack(
        [
            rng.uniform(8.0, 45.0, LOOKS),
            rng.uniform(-55.0, 55.0, LOOKS),
            rng.uniform(0.0, 20.0, LOOKS),
        ],
        axis=1,
    )
    lean, turn = rng.uniform(0.0, np.pi / 4, LOOKS), rng.uniform(0.0, 2.0 * np.pi, LOOKS)
    axis = np.stack(
        [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)], axis=1
    )
    try:
        from fcl_obstacles import FclObstacles
    except ImportError:
        return [
            Row(f"touched and distance at {LOOKS} looks, against python-fcl", 0.0, None, "s", 1.0)
        ]
    wall, pipe = _always(there), _pipe()
    return [
        _compared(
            "find_touching",
            pipe,
            FclObstacles(pipe),
            tip,
            axis,
            f"a pipe of {len(pipe.corners):,} triangles",
        ),
        _compared(
            "distance", wall, FclObstacles(wall), tip, axis, f"a wall of {LAYERS} layers of beads"
        ),
    ]


def _compared(name: str, own: Obstacles, peer: Any, tip: Array, axis: Array, what: str) -> Row:
    ours, theirs = [], []
    for _ in range(ROUNDS):
        start = process_time()
        found = getattr(own, name)(NOZZLE, tip, axis)
        ours.append(process_time() - start)
        start = process_time()
        other = getattr(peer, name)(NOZZLE, tip, axis)
        theirs.append(process_time() - start)
    off = peer.off(NOZZLE)
    if name == "distance":
        assert np.abs(found - other).max() < off + 1e-3, "they say other distances"
    else:
        away = own.distance(NOZZLE, tip, axis)
        smaller = own.find_touching(
            replace(NOZZLE, radius=NOZZLE.radius - off * np.hypot(1.0, NOZZLE.slope)), tip, axis
        )
        assert 0.1 < found.mean() < 0.9, f"looks that say nothing: {found.mean()}"
        assert (other == found)[(away > 1e-3) | smaller].all(), "they do not touch the same"
    return Row(
        f"{name} at {LOOKS} looks at {what}, against python-fcl", min(ours), min(theirs), "s", 1.0
    )


def _pipe(sides: int = 400, rings: int = 25) -> Obstacles:
    """The triangles of a pipe about y."""
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


def _always(there: Scene) -> Obstacles:
    """The pieces of a scene's beads, there from the start."""
    known = there.deposit
    assert known is not None
    return Obstacles(known.corners, None, known.radius, known.line, known.foot)


def _long_bead() -> list[Row]:
    """Memory and time of a bead of MANY points, each in a process of its own."""
    found = {}
    for count in (FEW, MANY):
        asked = [sys.executable, __file__, str(count)]
        told = subprocess.run(
            asked,
            check=True,
            capture_output=True,
            text=True,
            cwd=Path(__file__).resolve().parent.parent,
        )
        found[count] = [float(each) for each in told.stdout.split()]
    return [
        Row(
            f"nozzle kept clear along {MANY:,} points, {found[MANY][2]:.0f} of them tilted: peak memory, against what is "
            "allowed",
            found[MANY][1],
            MEMORY,
            "MB",
            1.0,
        ),
        Row(
            f"nozzle kept clear along {MANY:,} points, against {LINEAR:g} times what {FEW:,} take",
            found[MANY][0],
            LINEAR * found[FEW][0],
            "s",
            1.0,
        ),
    ]


def _kept_clear(count: int) -> tuple[float, float, int]:
    """Processor's seconds, peak MB and tilted points of a bead that meanders past a wall at one of its ends."""
    s = np.linspace(0.0, BESIDE, count)
    points = np.stack(
        [
            16.0 + 60.0 * (1.0 - np.cos(2.0 * np.pi * s / BESIDE)),
            120.0 * s / BESIDE - 60.0,
            0.0 * s,
        ],
        axis=1,
    )
    y = np.linspace(-60.0, 60.0, 31)
    wall = [np.stack([np.zeros(31), y, np.full(31, float(z))], axis=1) for z in range(LAYERS)]
    path = Toolpath(
        tuple(Layer((_bead(each),)) for each in (*wall, points)),
        np.eye(4),
        1.0,
        0.01,
        family="surface",
        bead_width=8.0,
    )
    start = process_time()
    found = keep_clear(path, [], NozzleParameters(), BuildDirectionParameters())
    took = process_time() - start
    tilted = int((found.layers[-1].beads[0].tool[:, 2] < 1.0 - 1e-9).sum())
    return took, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0, tilted


def _bead(points: Array) -> Bead:
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    return Bead(points, up, up, 2.0 * np.pi * length / length[-1], np.full(len(points), 6.0), False)


if __name__ == "__main__":
    print(*_kept_clear(int(sys.argv[1])))
