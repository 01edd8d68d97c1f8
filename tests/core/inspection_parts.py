# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planned walls given by formulas, and synthetic scans of them."""

import numpy as np

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall
from freecad_am.core.geometry.frames import pose, rotation_about
from freecad_am.core.inspection.point_file import Measured

R0 = 45.0


def hemisphere(start=0.0, end=2.0 * np.pi, full=True):
    angle = np.linspace(0.0, 0.5 * np.pi, 700)
    points, tangents = (
        R0 * np.column_stack([np.cos(angle), np.sin(angle)]),
        np.column_stack([-np.sin(angle), np.cos(angle)]),
    )
    return RevolvedWall(
        Meridian.chained([(points, tangents)]), np.eye(4), start, end, full, label="hemisphere"
    )


def funnel():
    """A quarter circle that bends outwards: deviations depend on every tilt and shift, but not on a
    rotation about its axis."""
    angle = np.linspace(0.0, 0.5 * np.pi, 700)
    points = np.column_stack([90.0 - R0 * np.cos(angle), R0 * np.sin(angle)])
    tangents = np.column_stack([np.sin(angle), np.cos(angle)])
    frame = pose(rotation_about((0.0, 0.6, 0.8), 0.7), (30.0, -20.0, 10.0))
    return RevolvedWall(Meridian.chained([(points, tangents)]), frame, label="funnel")


def sampled(wall, rng, count, low=0.0, high=1.0):
    """Points (n, 3) spread over a stretch of a wall, with its normals."""
    s = rng.uniform(low, high, count) * wall.meridian.length
    azimuth = rng.uniform(wall.start, wall.end, count)
    radius, height, tangent = wall.meridian.at(s)
    normal = np.column_stack([tangent[:, 1], np.zeros(count), -tangent[:, 0]])
    return wall.points(radius, height, azimuth), wall.directions(normal, azimuth)


def apply_motion(points, by):
    return points @ by[:3, :3].T + by[:3, 3]


def random_motion(rng, angle, shift):
    axis = rng.normal(size=3)
    return pose(rotation_about(axis / np.linalg.norm(axis), angle), rng.uniform(-shift, shift, 3))


def scan(points, label="scan.csv"):
    return Measured(points, label, ())
