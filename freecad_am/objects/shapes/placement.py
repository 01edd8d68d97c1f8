# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD placements and the poses of six numbers of the job file (x y z RX RY RZ, mm and rad, R = Rx Ry Rz)."""

from __future__ import annotations

import math
from typing import Any

import FreeCAD as App

_X, _Y, _Z = App.Vector(1, 0, 0), App.Vector(0, 1, 0), App.Vector(0, 0, 1)


def placement_of(pose: Any) -> App.Placement:
    """The placement of a pose."""
    x, y, z, rx, ry, rz = (float(number) for number in pose)
    turns = [
        App.Rotation(axis, math.degrees(angle))
        for axis, angle in ((_X, rx), (_Y, ry), (_Z, rz))
        if angle
    ]
    rotation = App.Rotation()
    for turn in turns:
        rotation = rotation.multiply(turn)
    return App.Placement(App.Vector(x, y, z), rotation)


def pose_of(placement: App.Placement) -> tuple[float, ...]:
    """The pose of a placement, RY in [-90, 90] deg; at RY = +-90 deg RX is 0."""
    m = placement.toMatrix()
    cosine = math.hypot(m.A23, m.A33)
    ry = math.atan2(m.A13, cosine)
    if cosine > 1e-9:
        rx, rz = math.atan2(-m.A23, m.A33), math.atan2(-m.A12, m.A11)
    else:
        rx, rz = 0.0, math.atan2(m.A21, m.A22)
    base = placement.Base
    return (base.x, base.y, base.z, rx + 0.0, ry + 0.0, rz + 0.0)
