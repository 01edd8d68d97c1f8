# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes on a wall (Chalvin 2019, section II D): tangent to the wall, normal to the bead."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.surface_wall import Array, SurfaceWall
from ..issues import NOTE, InputError, Issue
from ..parameters.build_direction import BuildDirectionParameters

LEAST = 1e-6  # a direction shorter than this after projection points nowhere
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Along:
    """What is known at the points of a bead, each (n, 3) unit vectors: the way the bead runs, up the wall at right
    angles to it, out of the wall."""

    forward: Array
    up: Array
    out: Array


def refuse(wall: SurfaceWall, build: BuildDirectionParameters) -> None:
    """InputError for a plane of symmetry that the wall does not have."""
    if build.mode == "symmetry-plane" and wall.symmetry_normal is None:
        raise InputError(
            "NO_SYMMETRY_PLANE", "build_direction.mode", f"{wall.label} is no bend of a torus, so its plane of symmetry is "
            "not known; use local, layer or fixed",
        )


def plane(wall: SurfaceWall, build: BuildDirectionParameters) -> Array | None:
    """Unit normal (3,) of the plane that tool axes stay in, None where they may lean any way."""
    return wall.symmetry_normal if build.mode == "symmetry-plane" else None


def directions(wall: SurfaceWall, along: Along, build: BuildDirectionParameters) -> tuple[Array, Array, float]:
    """Build directions and tool axes (n, 3) of a bead, and by how much (rad) max_tilt has turned the furthest back.

    symmetry-plane: both projected onto the plane of the bend, so that the tool turns about one axis alone.
    """
    up = along.up
    if build.mode == "fixed":
        up = np.tile(UP, (len(up), 1))
    elif build.mode == "layer":
        mean = up.mean(axis=0)
        size = np.linalg.norm(mean)
        up = np.tile(mean / size if size > LEAST else UP, (len(up), 1))
    tool = _held(up, along, build.lead, build.tilt)
    normal = wall.symmetry_normal
    if build.mode == "symmetry-plane" and normal is not None:
        up, tool = _projected(up, normal, wall.label), _projected(tool, normal, wall.label)
    up, _ = _capped(up, build.max_tilt)
    tool, back = _capped(tool, build.max_tilt)
    return up, tool, back


def cap_note(back: float, layer: int) -> list[Issue]:
    """Says that max_tilt turned directions back."""
    if back <= 1e-9:
        return []
    return [Issue(
        NOTE, "TILT_CAPPED", f"tool axes are turned back by up to {np.degrees(back):.3g} deg to stay within "
        "build_direction.max_tilt", layer,
    )]


def _held(build: Array, along: Along, lead: float, tilt: float) -> Array:
    """Turned by `lead` forward along the bead, then by `tilt` to the outside of the wall, rad."""
    if lead == 0.0 and tilt == 0.0:
        return build
    forward = _unit(along.forward - np.einsum("ij,ij->i", along.forward, build)[:, None] * build)
    out = np.cross(build, forward)
    out *= np.sign(np.einsum("ij,ij->i", out, along.out))[:, None]
    leaning = np.cos(lead) * build + np.sin(lead) * forward
    return _unit(np.cos(tilt) * leaning + np.sin(tilt) * out)


def _projected(vectors: Array, normal: Array, label: str) -> Array:
    flat = vectors - (vectors @ normal)[:, None] * normal
    if np.linalg.norm(flat, axis=1).min() < LEAST:
        raise InputError(
            "NO_DIRECTION", "build_direction.mode",
            f"a build direction of {label} is normal to its plane of symmetry; use local",
        )
    return _unit(flat)


def _capped(vectors: Array, most: float) -> tuple[Array, float]:
    level = np.hypot(vectors[:, 0], vectors[:, 1])
    angle = np.arctan2(level, vectors[:, 2])
    over = angle > most + 1e-12
    if not over.any():
        return vectors, 0.0
    away = np.divide(vectors[:, :2], level[:, None], out=np.tile([1.0, 0.0], (len(vectors), 1)), where=level[:, None] > 0.0)
    turned = np.column_stack([np.sin(most) * away, np.full(len(vectors), np.cos(most))])
    return np.where(over[:, None], turned, vectors), float((angle - most).max())


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return unit
