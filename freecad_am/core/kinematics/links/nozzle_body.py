# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle as triangles, for tests of links against it."""

from __future__ import annotations

import numpy as np

from ...geometry.obstacles import Body
from ...parameters.cell import NozzleParameters

NOZZLE = "nozzle"
SIDES = 24


def nozzle_body(nozzle: NozzleParameters) -> Body:
    """The nozzle in the frame of its tip, a many-sided cone about the round one."""
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1) / np.cos(np.pi / SIDES)
    tip, length = 0.5 * nozzle.diameter, nozzle.length
    back = tip + length * float(np.tan(nozzle.half_angle))
    vertices = np.concatenate(
        [
            np.column_stack([tip * ring, np.zeros(SIDES)]),
            np.column_stack([back * ring, np.full(SIDES, length)]),
            [[0.0, 0.0, 0.0], [0.0, 0.0, length]],
        ]
    )
    index = np.arange(SIDES)
    on = np.roll(index, -1)
    triangles = np.concatenate(
        [
            np.stack([index, on, on + SIDES], axis=1),
            np.stack([index, on + SIDES, index + SIDES], axis=1),
            np.stack([on, index, np.full(SIDES, 2 * SIDES)], axis=1),
            np.stack([index + SIDES, on + SIDES, np.full(SIDES, 2 * SIDES + 1)], axis=1),
        ]
    )
    return Body(NOZZLE, vertices, triangles.astype(np.int64))
