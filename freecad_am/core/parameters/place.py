# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `place` of a job: where part, positioner or deposition point are tried."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..issues import InputError
from ..types import Array
from . import field as f
from .records import Pose

AUTO, POINT, PLATFORM, POSITIONER = "auto", "deposition-point", "platform", "positioner"
MARGIN, TIME, CLEARANCE = "margin", "time", "clearance"
MAX_POSES = 20_000  # poses
SIDES = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True)
class PlaceParameters:
    """A box of poses about the pose of the cell, and how to rate them. mm and rad."""

    moves: str = f.parameter(
        AUTO,
        f.CHOICE,
        "Object to move: the deposition point (with the tool on the robot the fixed platform), "
        "the platform on the flange or the table, or the base of the positioner; auto: the "
        "object that places the part.",
        choices=(AUTO, POINT, PLATFORM, POSITIONER),
    )
    x: float = f.parameter(
        200.0, f.LENGTH, "Largest change of x in either direction.", low=0.0, high=20_000.0
    )
    y: float = f.parameter(
        200.0, f.LENGTH, "Largest change of y in either direction.", low=0.0, high=20_000.0
    )
    z: float = f.parameter(
        200.0, f.LENGTH, "Largest change of z in either direction.", low=0.0, high=20_000.0
    )
    rx: float = f.parameter(
        0.0,
        f.ANGLE,
        "Largest change of RX in either direction.",
        low=0.0,
        high=math.pi,
        advanced=True,
    )
    ry: float = f.parameter(
        0.0,
        f.ANGLE,
        "Largest change of RY in either direction.",
        low=0.0,
        high=math.pi,
        advanced=True,
    )
    rz: float = f.parameter(
        0.0,
        f.ANGLE,
        "Largest change of RZ in either direction.",
        low=0.0,
        high=math.pi,
        advanced=True,
    )
    step: float = f.parameter(100.0, f.LENGTH, "Step of x, y and z.", low=0.0, open_low=True)
    angle_step: float = f.parameter(
        math.radians(45.0),
        f.ANGLE,
        "Step of RX, RY and RZ.",
        low=0.0,
        high=math.pi,
        open_low=True,
        advanced=True,
    )
    points: int = f.parameter(
        300,
        f.COUNT,
        "Approximate number of toolpath points checked per pose.",
        low=20,
        high=100_000,
        advanced=True,
    )
    best: str = f.parameter(
        MARGIN,
        f.CHOICE,
        "Criterion for the best feasible pose: the largest minimum margin, the shortest time, or "
        "the largest clearance of the arm.",
        choices=(MARGIN, TIME, CLEARANCE),
    )
    proven: int = f.parameter(
        5,
        f.COUNT,
        "Largest number of poses that are planned with all points to find a feasible pose, best "
        "poses first.",
        low=1,
        high=100,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, "place")
        count = math.prod(len(values) for values in self._values())
        if count > MAX_POSES:
            raise InputError(
                "BAD_VALUE",
                "place.step",
                "the search has {} poses, more than {}; use a larger step or a smaller box",
                count,
                MAX_POSES,
            )

    def _values(self) -> list[Array]:
        """Return the offsets for each of the six numbers of a pose."""
        found = []
        for number, name in enumerate(SIDES):
            step = self.step if number < 3 else self.angle_step
            most = math.floor(
                min(getattr(self, name) / step, MAX_POSES) + 1e-9
            )  # for larger boxes, only the count matters
            found.append(step * np.arange(-most, most + 1))
        return found

    def changes(self) -> Array:
        """Return the offsets of all poses of the box.

        Returns
        -------
        (P, 6) array
            Offsets of x, y, z, mm, and the three angles, rad; the middle one is zero.
        """
        grids = np.meshgrid(*self._values(), indexing="ij")
        return np.stack([grid.ravel() for grid in grids], axis=1)

    def poses(self, about: Pose) -> Array:
        """Return the poses of the box about a pose.

        Parameters
        ----------
        about : Pose
            x, y, z, mm, and three angles, rad.

        Returns
        -------
        (P, 6) array
            mm and rad.
        """
        return np.asarray(np.array(about) + self.changes())
