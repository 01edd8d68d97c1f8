# SPDX-License-Identifier: LGPL-2.1-or-later
"""The volume of parts with several solids, against sums and inclusion-exclusion."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.obstacles import Body, box
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.strategies.solids.plan import part_volume, plan


def block(low, high):
    pose = np.eye(4)
    pose[:3, 3] = 0.5 * np.add(low, high)
    return box(tuple(np.subtract(high, low).astype(float)), pose, "block")


def cylinder(radius, high, sides):
    angle = np.linspace(0.0, 2.0 * math.pi, sides, endpoint=False)
    ring = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.vstack(
        [np.c_[ring, np.zeros(sides)], np.c_[ring, np.full(sides, high)], [[0, 0, 0], [0, 0, high]]]
    )
    k, following = np.arange(sides), np.roll(np.arange(sides), -1)
    faces = [(k, following, following + sides), (k, following + sides, k + sides)]
    faces += [(following, k, np.full(sides, 2 * sides))]
    faces += [(k + sides, following + sides, np.full(sides, 2 * sides + 1))]
    return Body("cylinder", points, np.vstack([np.stack(face, axis=1) for face in faces]))


CASES = {
    "touching": (
        [block((0, 0, 0), (40, 40, 40)), block((40, 10, 10), (80, 30, 30))],
        80_000.0,
        0.0,
    ),
    "microns apart": (
        [block((0, 0, 0), (40, 40, 40)), block((40.003, 0, 0), (60.003, 40, 40))],
        96_000.0,
        1e-12,
    ),
    "flush": ([block((0, 0, 0), (40, 40, 40)), block((20, 0, 0), (60, 40, 40))], 96_000.0, 2e-3),
    "there twice": ([block((0, 0, 0), (40, 40, 40))] * 2, 64_000.0, 2e-3),
    "inside": ([block((0, 0, 0), (40, 40, 40)), block((9, 9, 9), (21, 21, 21))], 64_000.0, 2e-3),
    "three crossing": (
        [
            block((-30, -10, -10), (30, 10, 10)),
            block((-10, -30, -10), (10, 30, 10)),
            block((-10, -10, -30), (10, 10, 30)),
        ],
        7 * 8000.0,
        2e-3,
    ),
    "round in a block": (
        [cylinder(20.0, 40.0, 180), block((0, -30, 0), (30, 30, 40))],
        40.0 * (180 * 200.0 * math.sin(2.0 * math.pi / 180) / 2.0 + 30 * 60),
        2e-3,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_solids_share_counts_once(name):
    bodies, volume, tolerance = CASES[name]
    solids = prepare_stack(bodies, SolidParameters(layer_height=4.0, chord_error=0.01), "part")
    assert part_volume(solids) == pytest.approx(volume, rel=max(tolerance, 1e-9))


def test_the_balance_of_a_toolpath_has_it():
    """Layers of 3 mm on a part 40 mm high reach 39 or 42 mm."""
    bodies, volume, _ = CASES["touching"]
    strategy = SolidParameters(layer_height=3.0, bead_spacing=10.0, chord_error=0.01)
    solids = prepare_stack(bodies, strategy, "part")
    path = plan(solids, strategy, BuildDirectionParameters(), ProcessParameters(), None)
    assert path.checks.volumes[0] == pytest.approx(volume, rel=1e-9)
