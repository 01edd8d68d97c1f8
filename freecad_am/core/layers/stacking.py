# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies made ready to be cut by planes: which way these are stacked, and the plane that the bodies stand on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry.on_hub import Base, Group, SolidsOnHub, upright
from ..geometry.plane import Plane
from ..geometry.surroundings import Body
from ..issues import NOTE, Issue
from ..parameters.strategy import SolidParameters

Array = NDArray[np.float64]

AXES = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], dtype=np.float64)
LARGEST = 12  # flat faces that the part may be laid on, beside the axes
ALIKE = np.cos(np.radians(2.0))
STANDING = 0.5  # layer heights above the lowest place; what is no higher stands there
CLOSE = 0.01  # of the area of the part; areas nearer together are the same


class Stacked(NamedTuple):
    """What a direction is judged by: unit vector (3,), area over nothing, mm2, and height, mm."""

    way: Array
    area: float
    height: float


def stacked(bodies: Sequence[Body], strategy: SolidParameters, label: str, issues: tuple[Issue, ...] = ()) -> SolidsOnHub:
    """The bodies standing on the plane through their lowest place, with a frame whose Z is the stacking direction, in the
    middle under them. With the direction `auto` a note says which it is and why."""
    asked = strategy.stacking()
    if asked is None:
        found = best(bodies, strategy)
        way, issues = found[0].way, (*issues, _told(found, label, np.degrees(strategy.max_overhang)))
    else:
        way = np.array(asked) / np.linalg.norm(asked)
    turned = upright(np.zeros(3), way)
    local = np.vstack([body.vertices for body in bodies]) @ turned[:3, :3]
    low, high = local.min(axis=0), local.max(axis=0)
    turned[:3, 3] = turned[:3, :3] @ np.array([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]])
    base = Base("the first layer", Plane(), turned)
    return SolidsOnHub(label, (Group(base, tuple(bodies)),), strategy.chord_error, (), issues)


def best(bodies: Sequence[Body], strategy: SolidParameters) -> list[Stacked]:
    """The axes and the directions out of large flat faces, the best first: the least area over nothing, then the least
    height, then in their order."""
    vertices, normals, areas = _facets(bodies)
    ways = _candidates(normals, areas)
    steep, standing = float(np.sin(strategy.max_overhang)), STANDING * strategy.layer_height
    found = [_judged(way, vertices, normals, areas, steep, standing) for way in ways]
    total = max(float(areas.sum()), 1e-300)
    return sorted(found, key=lambda one: (round(one.area / total / CLOSE), round(one.height, 6)))


def _facets(bodies: Sequence[Body]) -> tuple[Array, Array, Array]:
    """Corners (m, 3, 3), unit normals (m, 3) and areas (m,) of all triangles with an area."""
    corners = np.concatenate([body.corners() for body in bodies])
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normal, axis=1)
    some = doubled > 1e-12
    return corners[some], normal[some] / doubled[some, None], 0.5 * doubled[some]


def _candidates(normals: Array, areas: Array) -> list[Array]:
    """Unit directions to look at: the axes first, then against the normals of the largest flat faces."""
    keys = np.round(normals, 4) + 0.0
    faces, number = np.unique(keys, axis=0, return_inverse=True)
    size = np.bincount(np.ravel(number), weights=areas)
    ways = list(AXES)
    for k in np.argsort(-size, kind="stable")[: 4 * LARGEST]:
        way = -faces[k] / np.linalg.norm(faces[k])
        if size[k] > CLOSE * areas.sum() and max(float(way @ other) for other in ways) < ALIKE:
            ways.append(way)
        if len(ways) >= len(AXES) + LARGEST:
            break
    return ways


def _judged(way: Array, corners: Array, normals: Array, areas: Array, steep: float, standing: float) -> Stacked:
    heights = corners @ way
    low, high = float(heights.min()), float(heights.max())
    over = (normals @ way < -steep - 1e-9) & (heights.max(axis=1) > low + standing)
    return Stacked(way, float(areas[over].sum()), high - low)


def _told(found: Sequence[Stacked], label: str, lean: float) -> Issue:
    chosen = found[0]
    upright_one = next(one for one in found if one.way is AXES[0] or np.array_equal(one.way, AXES[0]))
    other = "" if chosen is upright_one else (
        f"; along (0, 0, 1) it would be {upright_one.area:.4g} mm^2 and {upright_one.height:.4g} mm"
    )
    x, y, z = (round(float(value), 6) + 0.0 for value in chosen.way)
    return Issue(
        NOTE, "DIRECTION", f"{label} is stacked along ({x:g}, {y:g}, {z:g}): {chosen.area:.4g} mm^2 of it lean over nothing "
        f"by more than {lean:.4g} deg, and it is {chosen.height:.4g} mm high{other}",
    )
