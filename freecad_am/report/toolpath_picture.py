# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture of the toolpath: beads seen obliquely from above, coloured by layer, on their platform."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

import numpy as np

from ..core.geometry.mesh.collapsed import doubled_areas
from ..core.toolpath import Toolpath
from ..core.types import Array
from ..plots.look import shade
from . import svg

WIDTH, HEIGHT, MARGIN = 960, 620, 34
_AZIMUTH, _ELEVATION = math.radians(-62.0), math.radians(24.0)
_MOST_POINTS = 60_000
_MOST_OVERLAID = 12_000  # points of one group
_TICKS = 260  # build directions shown
_MOST_TRIANGLES = 6000  # of a body


def picture(toolpath: Toolpath, platform_diameter: float | None = None) -> str:
    """Return the inline SVG of a toolpath, with the feature's axis upright and the substrate behind
    the wall."""
    inverse = np.linalg.inv(toolpath.frame)
    beads = [
        (layer, bead.points @ inverse[:3, :3].T + inverse[:3, 3], bead.build @ inverse[:3, :3].T)
        for layer, _, bead in toolpath
    ]
    platform = _disc(platform_diameter)
    length = 0.07 * float(np.ptp(np.concatenate([points for _, points, _ in beads]), axis=0).max())
    outline = [side for _, points, build in beads for side in (points, points + length * build)]
    if platform.any():
        outline.append(platform)
    scale, shift = _fit(_project(np.concatenate(outline)))
    bodies = [body.corners() @ inverse[:3, :3].T + inverse[:3, 3] for body in toolpath.surroundings]
    elements = [
        _platform(platform, scale, shift),
        *(_body(corners, scale, shift) for corners in bodies),
    ]
    step = max(1, toolpath.point_count // _MOST_POINTS)
    last_layer = max(1, len(toolpath.layers) - 1)
    stride = max(1, toolpath.point_count // _TICKS)
    facing = _facing(beads, toolpath.traits.is_open_wall)
    # painter's algorithm: the far half of each layer is behind the near halves of all layers
    far_halves, near_halves = (
        [
            _half(points, step, scale, shift, shade(layer / last_layer), towards, side)
            for (layer, points, _), towards in zip(beads, facing, strict=True)
        ]
        for side in (False, True)
    )
    elements += [
        *far_halves,
        *near_halves,
        _directions(beads, facing, stride, length, scale, shift),
        _scale_bar(last_layer),
    ]
    return (
        f'<svg class="view" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="the path, coloured by layer">'
        f"{''.join(elements)}</svg>"
    )


def _facing(beads: list[tuple[int, Array, Array]], is_open_wall: bool) -> list[Array]:
    """Per bead, (n,): positive where the wall faces the eye. For parts of revolution this is a side
    of the axis; for walls it is the outside of the bead, away from the middle of its layer."""
    level = math.cos(_ELEVATION)
    eye = np.array([math.cos(_AZIMUTH) * level, math.sin(_AZIMUTH) * level, math.sin(_ELEVATION)])
    if not is_open_wall:
        return [points[:, :2] @ eye[:2] for _, points, _ in beads]
    facing = []
    middles = {
        number: np.concatenate([points for layer, points, _ in beads if layer == number]).mean(
            axis=0
        )
        for number in {layer for layer, _, _ in beads}
    }
    for layer, points, build in beads:
        outside = np.cross(np.gradient(points, axis=0), build)
        outward = float((outside * (points - middles[layer])).sum())
        facing.append(outside @ eye * (1.0 if outward >= 0.0 else -1.0))
    return facing


def _body(corners: Array, scale: float, shift: Array) -> str:
    """The triangles (m, 3, 3) of a body that face the eye, in a few shades."""
    corners = (
        corners[:: max(1, len(corners) // _MOST_TRIANGLES)]
        if len(corners) > _MOST_TRIANGLES
        else corners
    )
    projected = _project(corners.reshape(-1, 3)).reshape(-1, 3, 3)
    normal = doubled_areas(projected)
    slant = -normal[:, 2] / np.maximum(
        np.linalg.norm(normal, axis=1), 1e-12
    )  # the picture's second axis points down
    pixels = projected[:, :, :2] * scale + shift
    inside = ((pixels.max(axis=1) > 0.0) & (pixels.min(axis=1) < [WIDTH, HEIGHT])).all(axis=1) & (
        slant > 0.0
    )
    order = np.argsort(projected[:, :, 2].mean(axis=1), kind="stable")
    elements = []
    for k in order[inside[order]]:
        (a, b), (c, d), (e, f) = pixels[k].tolist()
        shade = round(6.0 * float(slant[k]))
        elements.append(
            f'<path class="body b{shade}" d="M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}L{e:.1f} {f:.1f}Z"/>'
        )
    return "".join(elements)


def overlaid(groups: Sequence[tuple[str, str, Sequence[Array]]]) -> str:
    """Curves (n, 3) in one picture, seen alike: groups of a name, a colour and curves; NaN lifts the pen."""
    points = np.concatenate([curve for _, _, curves in groups for curve in curves])
    scale, shift = _fit(_project(points[np.isfinite(points[:, 0])]))
    elements = []
    for number, (name, stroke, curves) in enumerate(groups):
        step = max(1, sum(map(len, curves)) // _MOST_OVERLAID)
        data = "".join(
            svg.path_data(*(_project(curve[::step])[:, :2] * scale + shift).T) for curve in curves
        )
        elements.append(f'<path class="curve" stroke="{stroke}" stroke-width="1.3" d="{data}"/>')
        y = 20 * number - 22
        elements.append(f'<circle cx="{MARGIN}" cy="{y - 4}" r="4" fill="{stroke}"/>')
        elements.append(f'<text class="key" x="{MARGIN + 12}" y="{y}">{escape(name)}</text>')
    label = escape(" and ".join(name for name, _, _ in groups))
    return f'<svg class="view" viewBox="0 -40 {WIDTH} {HEIGHT + 40}" role="img" aria-label="{label}">{"".join(elements)}</svg>'


def _project(points: Array) -> Array:
    """(n, 3) right, down and depth towards the eye, of points with Z upright."""
    x, y, z = points.T
    right = -x * math.sin(_AZIMUTH) + y * math.cos(_AZIMUTH)
    towards = x * math.cos(_AZIMUTH) + y * math.sin(_AZIMUTH)
    up = z * math.cos(_ELEVATION) - towards * math.sin(_ELEVATION)
    return np.column_stack((right, -up, towards * math.cos(_ELEVATION) + z * math.sin(_ELEVATION)))


def _fit(projected: Array) -> tuple[float, Array]:
    low, high = projected[:, :2].min(axis=0), projected[:, :2].max(axis=0)
    size = np.array([WIDTH - 2 * MARGIN - 70, HEIGHT - 2 * MARGIN], dtype=float)
    scale = float((size / np.maximum(high - low, 1e-9)).min())
    return scale, np.array([MARGIN, MARGIN]) + (size - scale * (high - low)) / 2 - scale * low


def _disc(diameter: float | None) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, 97)
    radius = 0.5 * (diameter or 0.0)
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle), np.zeros_like(angle)))


def _platform(disc: Array, scale: float, shift: Array) -> str:
    if not disc.any():
        return ""
    top = _project(disc)[:, :2] * scale + shift
    below = _project(disc - [0.0, 0.0, 0.035 * float(np.ptp(disc[:, 0]))])[:, :2] * scale + shift
    return f'<path class="platform-side" d="{svg.path_data(*below.T)}Z"/><path class="platform" d="{svg.path_data(*top.T)}Z"/>'


def _half(
    points: Array, step: int, scale: float, shift: Array, stroke: str, towards: Array, is_near: bool
) -> str:
    """The part of a bead that faces the eye or the part that faces away."""
    rows = slice(None) if step == 1 else np.unique(np.r_[0 : len(points) : step, len(points) - 1])
    projected, towards = _project(points[rows]), towards[rows]
    visible = towards >= 0.0 if is_near else towards <= 0.0
    visible |= (
        np.roll(visible, 1) & np.r_[False, np.ones(len(visible) - 1, dtype=bool)]
    )  # joins the halves
    pixels = np.where(visible[:, None], projected[:, :2] * scale + shift, np.nan)
    data = svg.path_data(*pixels.T)
    return (
        f'<path class="{"near" if is_near else "far"}" stroke="{stroke}" d="{data}"/>'
        if data
        else ""
    )


def _directions(
    beads: list[tuple[int, Array, Array]],
    facing: list[Array],
    stride: int,
    length: float,
    scale: float,
    shift: Array,
) -> str:
    points = np.concatenate([points for _, points, _ in beads])[::stride]
    build = np.concatenate([build for _, _, build in beads])[::stride]
    visible = np.concatenate(facing)[::stride] >= 0.0
    start = _project(points[visible])[:, :2] * scale + shift
    end = _project((points + length * build)[visible])[:, :2] * scale + shift
    data = "".join(
        f"M{a:.1f} {b:.1f}L{c:.1f} {d:.1f}" for (a, b), (c, d) in zip(start.tolist(), end.tolist())
    )
    return f'<path class="direction" d="{data}"><title>build directions</title></path>'


def _scale_bar(last_layer: int) -> str:
    x, top, height = WIDTH - MARGIN - 16, 120, HEIGHT - 240
    stops = "".join(
        f'<stop offset="{i * 10}%" stop-color="{shade(1 - i / 10)}"/>' for i in range(11)
    )
    return (
        f'<defs><linearGradient id="layers" x1="0" y1="0" x2="0" y2="1">{stops}</linearGradient></defs>'
        f'<rect x="{x}" y="{top}" width="14" height="{height}" rx="3" fill="url(#layers)"/>'
        f'<text class="tick" x="{x - 6}" y="{top + 10}" text-anchor="end">{last_layer}</text>'
        f'<text class="tick" x="{x - 6}" y="{top + height}" text-anchor="end">0</text>'
        f'<text class="label" x="{x + 14}" y="{top - 10}" text-anchor="end">layer</text>'
    )
