# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses as the pendants of controllers show them: X Y Z in mm, and what turns them in the controller's own way.

KUKA's A B C, FANUC's W P R and Yaskawa's Rx Ry Rz turn about Z, Y and X: R = Rz Ry Rx; A and R are about Z, W and Rx
about X. Stäubli's Rx Ry Rz are R = Rx Ry Rz, as poses are here. ABB shows a quaternion whose first number is the cosine,
Universal Robots a rotation vector in rad. Sources: docs/posts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..geometry import frames
from ..issues import InputError, Text, Word
from ..types import Array

# what each shows after X Y Z
SHOWN = {
    "abb": ("q1", "q2", "q3", "q4"), "fanuc": ("W", "P", "R"), "kuka": ("A", "B", "C"), "staubli": ("Rx", "Ry", "Rz"),
    "ur": ("RX", "RY", "RZ"), "yaskawa": ("Rx", "Ry", "Rz"),
}
UNIT = 1e-3  # by which a quaternion that is shown with few digits may be longer or shorter than 1
WHOLE = 2.0 * math.pi + 1e-3  # rad, a rotation vector is no longer


def named(words: Sequence[str]) -> str:
    """The controller that one of the words of a pose names, '' where none does."""
    return next((word.lower() for word in words if word.lower() in SHOWN), "")


def six(words: Sequence[str], where: str) -> tuple[float, float, float, float, float, float]:
    """x y z RX RY RZ, mm and rad (Bryant), of the words of a pose, of which one names the controller: kuka 1 0 3 90 0 0.

    Raises InputError BAD_VALUE, at `where`.
    """
    controller = named(words)
    letters = " ".join(SHOWN[controller])
    form = Text("write such as: {} X Y Z {}", controller, letters)
    try:
        numbers = [float(word) for word in words if word.lower() != controller]
    except ValueError:
        numbers = []
    if len(numbers) != 3 + len(SHOWN[controller]) or not all(map(math.isfinite, numbers)):
        raise InputError("BAD_VALUE", where, "{!r} is not a pose; {}", " ".join(words), Word(form))
    a, b, c = frames.to_bryant(_rotation(controller, numbers[3:], where)).tolist()
    return numbers[0], numbers[1], numbers[2], a, b, c


def shown(controller: str, pose: Sequence[float]) -> tuple[float, ...]:
    """What a pendant shows of a pose x y z RX RY RZ, mm and rad: X Y Z, and degrees, a quaternion, or rad."""
    turn = frames.bryant(pose)[:3, :3]
    if controller == "staubli":
        angles = np.degrees(frames.to_bryant(turn))
    elif controller in ("abb", "ur"):
        angles = _quaternion(turn)
        if controller == "ur":
            size = float(np.linalg.norm(angles[1:]))
            angles = angles[1:] * (2.0 * math.atan2(size, float(angles[0])) / size if size > 0.0 else 0.0)
    else:
        # R = Rz Ry Rx is the reverse of Rx Ry Rz the other way round
        about_x, about_y, about_z = np.degrees(-frames.to_bryant(turn.T))
        angles = np.array([about_z, about_y, about_x] if controller == "kuka" else [about_x, about_y, about_z])
    return *map(float, pose[:3]), *angles.tolist()


def _rotation(controller: str, numbers: Sequence[float], where: str) -> Array:
    """(3, 3) of what a controller shows after X Y Z."""
    size = float(np.linalg.norm(numbers))
    if controller == "abb":
        if abs(size - 1.0) > UNIT:
            raise InputError("BAD_VALUE", where, "q1 to q4 are together {:.4g} long, a quaternion is 1; look at the digits",
                             size)
        w, *vector = (number / size for number in numbers)
        length = float(np.linalg.norm(vector))
        return _about(np.array(vector), 2.0 * math.atan2(length, w))
    if controller == "ur":
        if size > WHOLE:
            raise InputError("BAD_VALUE", where, "the rotation vector is {:.4g} rad long, more than a turn; give RX RY RZ "
                             "in rad, as the pendant shows them", size)
        return _about(np.array(numbers), size)
    first, second, third = np.radians(numbers)
    if controller == "staubli":
        return np.asarray(frames.about_x(first) @ frames.about_y(second) @ frames.about_z(third))
    x, z = (third, first) if controller == "kuka" else (first, third)
    return np.asarray(frames.about_z(z) @ frames.about_y(second) @ frames.about_x(x))


def _about(axis: Array, angle: float) -> Array:
    size = float(np.linalg.norm(axis))
    return np.eye(3) if size == 0.0 else np.asarray(frames.rotation_about(axis / size, angle))


def _quaternion(turn: Array) -> Array:
    """(4,) cosine first and not negative: of the four ways to take it the one that loses no digits (Shepperd 1978)."""
    trace = float(np.trace(turn))
    squares = np.array([trace, *np.diag(turn)])
    k = int(squares.argmax())
    if k == 0:
        found = np.array([1.0 + trace, turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    else:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        found = np.zeros(4)
        found[0] = turn[m, j] - turn[j, m]
        found[1 + i] = 1.0 + 2.0 * turn[i, i] - trace
        found[1 + j], found[1 + m] = turn[j, i] + turn[i, j], turn[m, i] + turn[i, m]
    found = found / np.linalg.norm(found)
    return np.asarray(-found if found[0] < 0.0 else found)
