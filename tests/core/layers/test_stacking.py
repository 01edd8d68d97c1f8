# SPDX-License-Identifier: LGPL-2.1-or-later
"""The build direction depends on the part, not on its triangles."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.layers.stacking import rank_directions
from freecad_am.core.parameters.filled import SolidParameters

CORNERS = np.array([[x, y, z] for x in (0, 40) for y in (0, 40) for z in (0, 10)], dtype=float)
SIDES = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)
PLATE = CORNERS[np.vstack([SIDES[:, [0, 1, 2]], SIDES[:, [0, 2, 3]]])]


def quartered(corners, times):
    """Triangles (m, 3, 3), each split into four, several times."""
    for _ in range(times):
        a, b, c = np.moveaxis(corners, 1, 0)
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        corners = np.concatenate(
            [
                np.stack(corner_points, axis=1)
                for corner_points in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
            ]
        )
    return corners


def body(corners, rng):
    """The corners in random order with the digits of mesh files."""
    points = corners[rng.permutation(len(corners))].astype(np.float32).astype(float)
    points, number = np.unique(points.reshape(-1, 3), axis=0, return_inverse=True)
    return Body("plate", points, np.reshape(number, (-1, 3)))


@pytest.mark.parametrize("seed", range(12))
def test_meshes_of_one_part_are_stacked_alike(seed):
    """A plate fits either of its large faces equally well; the choice must not depend on the mesh,
    and the plate lies flat."""
    rng = np.random.default_rng(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    for corners in (PLATE, PLATE @ turn.T):
        coarse, fine = (
            rank_directions([body(quartered(corners, times), rng)], SolidParameters())[0]
            for times in (0, 3)
        )
        assert coarse.direction == pytest.approx(
            fine.direction, abs=2e-4
        ) and coarse.height == pytest.approx(10.0, abs=0.02)


def square_tube(outer, inner, length):
    """Triangles of a tube along X whose square sections stand on a corner."""

    def ring(half):
        turn = np.sqrt(2.0) * half * np.array([[0, 1], [-1, 0], [0, -1], [1, 0]])
        return [np.column_stack([np.full(4, x), turn]) for x in (0.0, length)]

    (low, high), (inner_low, inner_high) = ring(0.5 * outer), ring(0.5 * inner)
    sheets = []
    for k in range(4):
        n = (k + 1) % 4
        sheets += [
            (low[k], low[n], high[n], high[k]),
            (inner_low[n], inner_low[k], inner_high[k], inner_high[n]),
            (low[n], low[k], inner_low[k], inner_low[n]),
            (high[k], high[n], inner_high[n], inner_high[k]),
        ]
    corners = np.array([tri for a, b, c, d in sheets for tri in ((a, b, c), (a, c, d))])
    inwards = np.einsum("mk,mk->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) < 0.0
    return corners[:, ::-1] if inwards else corners


def test_a_part_is_not_balanced_on_an_edge():
    """On an edge no facet overhangs by more than 45 deg and the part is lower than on its end, but
    it would fall over."""
    for angle in (0.0, 30.0):
        turn = Rotation.from_euler("z", angle, degrees=True).as_matrix()
        corners = square_tube(40.0, 30.0, 80.0) @ turn.T
        tube = Body("tube", corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
        directions = rank_directions([tube], SolidParameters())
        direction = directions[0].direction
        assert (
            abs(direction @ turn[:, 0]) == pytest.approx(1.0, abs=1e-3)
            and directions[0].area == 0.0
        )
        # the face on the platform has an area, and the centre of the part is above it
        heights = corners @ direction
        standing = corners[(heights < heights.min() + 0.1).all(axis=1)]
        area = 0.5 * np.linalg.norm(
            np.cross(standing[:, 1] - standing[:, 0], standing[:, 2] - standing[:, 0]), axis=1
        )
        assert area.sum() == pytest.approx(40.0**2 - 30.0**2, rel=1e-3)
        on_edge = next(candidate for candidate in directions if abs(candidate.direction[2]) > 0.999)
        assert (
            on_edge.area == 0.0 and on_edge.height < directions[0].height and on_edge.stable < 0.05
        )
