# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which way planes are stacked is a matter of the part, not of the triangles that it comes in."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.layers.planes.stacking import best
from freecad_am.core.parameters.filled import SolidParameters

CORNERS = np.array([[x, y, z] for x in (0, 40) for y in (0, 40) for z in (0, 10)], dtype=float)
SIDES = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)
PLATE = CORNERS[np.vstack([SIDES[:, [0, 1, 2]], SIDES[:, [0, 2, 3]]])]


def quartered(corners, times):
    """Triangles (m, 3, 3), each in four parts, so many times."""
    for _ in range(times):
        a, b, c = np.moveaxis(corners, 1, 0)
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        corners = np.concatenate(
            [np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
    return corners


def body(corners, rng):
    """In another order and with the digits that files of meshes have."""
    points = corners[rng.permutation(len(corners))].astype(np.float32).astype(float)
    points, number = np.unique(points.reshape(-1, 3), axis=0, return_inverse=True)
    return Body("plate", points, np.reshape(number, (-1, 3)))


@pytest.mark.parametrize("seed", range(12))
def test_meshes_of_one_part_are_stacked_alike(seed):
    """A plate lies on either of its large faces just as well; which one it is stays the same, and it lies."""
    rng = np.random.default_rng(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    for part in (PLATE, PLATE @ turn.T):
        few, many = (
            best([body(quartered(part, times), rng)], SolidParameters())[0] for times in (0, 3)
        )
        assert few.way == pytest.approx(many.way, abs=2e-4) and few.height == pytest.approx(
            10.0, abs=0.02
        )
