# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses as pendants of controllers show them, X Y Z in mm first; each post defines its angles."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import cache
from typing import Any

import FreeCAD as App
import numpy as np

from ...core.geometry import frames
from ...core.issues import InputError, Text, Word
from ...core.orientation import QUATERNION, ROTATION_VECTOR, Pendant
from ...core.types import Array
from ...posts import catalogue

UNIT = 1e-3  # by which a quaternion that is shown with few digits may be longer or shorter than 1
MAX_ROTATION_RAD = 2.0 * math.pi + 1e-3  # rad, a rotation vector is no longer
_AT = re.compile(r"(?<=\sat\s)(.+?)(?=\s+carries\s)")  # position of a thing in a text

Pose = tuple[float, float, float, float, float, float]


@cache
def pendants() -> dict[str, Pendant]:
    """The pendants that show frames in a different convention, by controller, ordered by
    manufacturer.
    """
    by_name = {name: catalogue.load(name).PENDANT for name in catalogue.NAMES}
    return dict(
        sorted(
            ((name, pendant) for name, pendant in by_name.items() if pendant),
            key=lambda pair: pair[1].maker,
        )
    )


def named(words: Sequence[str]) -> str:
    """Return the controller named by a word of a pose, '' without a controller."""
    controller = next((word.lower() for word in words if word.lower() in catalogue.NAMES), "")
    return (
        controller if controller and catalogue.load(controller).PENDANT else ""
    )  # importing every post takes long


def six(words: Sequence[str], where: str) -> Pose:
    """Convert a pose with the name of a controller to x y z RX RY RZ, mm and rad (Bryant).

    For example: kuka 1 0 3 90 0 0. Raises InputError BAD_VALUE, at `where`.
    """
    controller = named(words)
    pendant = catalogue.load(controller).PENDANT
    assert pendant is not None
    form = Text("use the form: {} X Y Z {}", controller, " ".join(pendant.letters))
    try:
        numbers = [float(word) for word in words if word.lower() != controller]
    except ValueError:
        numbers = []
    if len(numbers) != 3 + len(pendant.letters) or not all(map(math.isfinite, numbers)):
        raise InputError("BAD_VALUE", where, "{!r} is not a pose; {}", " ".join(words), Word(form))
    a, b, c = frames.to_bryant(_rotation(pendant, np.array(numbers[3:]), where)).tolist()
    return numbers[0], numbers[1], numbers[2], a, b, c


def _rotation(pendant: Pendant, numbers: Array, where: str) -> Array:
    """Return the rotation (3, 3) of the values that a pendant shows after X Y Z."""
    size = float(np.linalg.norm(numbers))
    if pendant.orientation is QUATERNION and abs(size - 1.0) > UNIT:
        raise InputError(
            "BAD_VALUE",
            where,
            "the quaternion q1 to q4 has length {:.4g} instead of 1; check the digits",
            size,
        )
    if pendant.orientation is ROTATION_VECTOR and size > MAX_ROTATION_RAD:
        raise InputError(
            "BAD_VALUE",
            where,
            "the rotation vector has a length of {:.4g} rad, more than a turn; enter RX RY RZ in "
            "rad, as shown on the pendant",
            size,
        )
    numbers = np.radians(numbers) if pendant.orientation.degrees else numbers
    return np.asarray(pendant.orientation.rotations(numbers[None])[0])


def pendant_values(controller: str, pose: Sequence[float]) -> tuple[float, ...]:
    """Return the values that a pendant shows for a pose x y z RX RY RZ, mm and rad.

    The values are X Y Z, and degrees, a quaternion, or rad.
    """
    orientation = pendants()[controller].orientation
    numbers = orientation.numbers(frames.bryant(pose)[None, :3, :3])[0]
    return *map(float, pose[:3]), *(
        np.degrees(numbers) if orientation.degrees else numbers
    ).tolist()


def plain(text: str, where: str) -> str:
    """Rewrite poses that name a controller in a text such as External as x y z RX RY RZ, mm and
    deg.

    Raises InputError BAD_VALUE, at `where`.
    """
    return _AT.sub(lambda match: _plain(match[0], where), text)


def _plain(pose: str, where: str) -> str:
    words = pose.replace(",", " ").split()
    if not named(words):
        return pose
    pose_values = six(words, where)
    numbers = (*pose_values[:3], *(math.degrees(angle) for angle in pose_values[3:]))
    return " ".join(f"{number:.14g}" for number in numbers)


# ---- FreeCAD placements and the poses of six numbers of the job file (x y z RX RY RZ, mm and rad,
# R = Rx Ry Rz)

_X, _Y, _Z = App.Vector(1, 0, 0), App.Vector(0, 1, 0), App.Vector(0, 0, 1)


def placement_of(pose: Any) -> App.Placement:
    """Return the placement of a pose."""
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
    """Return the pose of a placement, RY in [-90, 90] deg; at RY = +-90 deg RX is 0."""
    m = placement.toMatrix()
    cosine = math.hypot(m.A23, m.A33)
    ry = math.atan2(m.A13, cosine)
    if cosine > 1e-9:
        rx, rz = math.atan2(-m.A23, m.A33), math.atan2(-m.A12, m.A11)
    else:
        rx, rz = 0.0, math.atan2(m.A21, m.A22)
    base = placement.Base
    return (base.x, base.y, base.z, rx + 0.0, ry + 0.0, rz + 0.0)
