# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes aligned with the solids of beads: what they exclude touches nothing, and contacts do not
depend on them."""

import numpy as np
import pytest

from freecad_am.core.collision import obstacles, separation
from freecad_am.core.collision.deposit import build_deposit
from freecad_am.core.collision.frustum import Frustum
from freecad_am.core.collision.tree import BRANCH


def bead(random, count, step, width, height, short):
    """A bead that winds through space, cut as by `build_deposit`."""
    tangents = np.cumsum(random.normal(scale=0.2, size=(count, 3)), axis=0) + [1.0, 0.0, 0.0]
    points = np.cumsum(step * tangents / np.linalg.norm(tangents, axis=1, keepdims=True), axis=0)
    build = np.cross(np.gradient(points, axis=0), random.normal(size=3))
    build /= np.linalg.norm(build, axis=1, keepdims=True)
    return points, build_deposit(
        points, build, width, height, np.array([0, count // 2]), short=short
    )


def nozzles(random, points, count):
    """Tips near points and unit axes in any direction."""
    axis = random.normal(size=(count, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return points[random.integers(len(points), size=count)] + random.normal(
        scale=4.0, size=(count, 3)
    ), axis


@pytest.mark.parametrize("short", [True, False])
@pytest.mark.parametrize(
    ("width", "height", "step"), [(5.0, 0.2, 0.1), (3.0, 3.0, 1.0), (1.0, 4.0, 0.5)]
)
def test_what_is_left_out_meets_no_piece(width, height, step, short):
    """Pairs that the boxes exclude have no contact."""
    random = np.random.default_rng(7)
    points, beads = bead(random, 403, step, width, height, short)
    boxes = obstacles.build_slabs(beads.corners, beads.radius, BRANCH)
    assert (
        np.abs(np.einsum("nij,nkj->nik", boxes.sides, boxes.sides))[:, ~np.eye(3, dtype=bool)].max()
        < 1e-9
    )
    tip, axis = nozzles(random, points, 60)
    solid = Frustum(1.0, 0.4, 0.5, 15.0)
    query, node = (
        column.ravel()
        for column in np.meshgrid(np.arange(60), np.arange(len(boxes.centre)), indexing="ij")
    )
    candidates = obstacles.select_close(boxes, solid, node, tip[query], axis[query])
    excluded = np.setdiff1d(np.arange(len(query)), candidates)
    assert len(excluded) > 0.3 * len(query)
    for member in range(BRANCH):  # of each box
        indices = BRANCH * node[excluded] + member
        real = indices < len(beads.corners)
        rows, indices = query[excluded][real], indices[real]
        offsets = beads.corners[indices] - tip[rows, None]
        assert not separation.find_overlaps(solid, axis[rows], offsets, beads.radius[indices]).any()


def test_a_box_lies_as_its_pieces_do():
    """The box of a flat straight bead that leans is as flat as the bead."""
    along, up = np.array([1.0, 2.0, 2.0]) / 3.0, np.array([2.0, 1.0, -2.0]) / 3.0
    points = np.arange(65)[:, None] * 0.1 * along
    beads = build_deposit(points, np.tile(up, (65, 1)), 6.0, 0.4, np.array([0]), short=True)
    boxes = obstacles.build_slabs(beads.corners, beads.radius, BRANCH)
    sizes = np.sort(2.0 * np.linalg.norm(boxes.sides, axis=2), axis=1)
    assert sizes == pytest.approx(
        np.tile([0.0, 0.8, 5.6], (8, 1)), abs=1e-9
    )  # rounded by 0.2 mm on all sides
    assert boxes.rounding == pytest.approx(0.2)


@pytest.mark.parametrize("seed", range(4))
def test_touches_are_the_same_without(monkeypatch, seed):
    """Contacts are the same with and without the boxes."""
    random = np.random.default_rng(seed)
    points, beads = bead(random, 2000, 0.2, 4.0, 1.0, bool(seed % 2))
    tip, axis = nozzles(random, points, 700)
    solid, moment = Frustum(0.5, 0.3, 1.2, 25.0), random.integers(2000, size=700)
    layer_start = np.minimum(moment, random.integers(2000, size=700))
    pair_counts = []
    select_close = obstacles.select_close
    monkeypatch.setattr(
        obstacles,
        "select_close",
        lambda *args: pair_counts.append(len(args[2])) or select_close(*args),
    )
    contacts = beads.find_touching(solid, tip, axis, moment, layer_start)
    assert sum(pair_counts) and 0.1 < contacts.mean() < 0.95
    monkeypatch.setattr(obstacles, "SLABS", 0)
    pair_counts.clear()
    assert (
        beads.find_touching(solid, tip, axis, moment, layer_start) == contacts
    ).all() and not pair_counts
