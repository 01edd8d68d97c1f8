# SPDX-License-Identifier: LGPL-2.1-or-later
"""Turns the part by the axes of a positioner so that the tool stands upright where it deposits.

Where one position of the positioner keeps all tool axes of the job, or of a bead, near enough to the vertical, it stands
still there: no axis moves that need not. Where none does, the positioner follows the bead and keeps the tool axis vertical
at every point, through the pole by going straight on.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from ...geometry.angles import TURN
from ...issues import ERROR, Issue
from ...kinematics.cell import Cell
from ...kinematics.external import ExternalAxes, tilt_from
from ...kinematics.inverse import rotary_pair
from ...toolpath import Bead, Toolpath
from ...types import Array
from ..joint_path import BeadPath, JointPath
from ..reserve import RESERVE
from ..turns.rotary_courses import continuous, kept

ROUNDING = 1e-9
# rad; a direction this near to the turning axis counts as on it, or the axis would race round to meet it
AT_POLE = math.radians(0.1)
STEPS = 200  # of the search for the middle of directions


def levelled(cell: Cell, toolpath: Toolpath) -> tuple[list[Bead], list[Issue]]:
    """The beads of a toolpath with the values of the external axes at their points, and where the tool axis is farther from
    the vertical than `max_from_vertical` allows."""
    external = cell.external
    assert external is not None
    beads = [bead for _, _, bead in toolpath]
    places = [(layer, index) for layer, index, _ in toolpath]
    allowed = _allowed(toolpath)
    seen = [on_face(cell, bead.tool) for bead in beads]
    one = _middle(np.concatenate(seen))
    done: list[Bead] = []
    issues: list[Issue] = []
    before = np.zeros(external.axes)
    hold = not external.turning or (one is not None and float(tilt_from(np.concatenate(seen), one).max()) <= min(allowed))
    if external.turning and hold and one is not None:
        before = _standing(external, cell, one, before)
    for bead, directions, most, place in zip(beads, seen, allowed, places, strict=True):
        values = np.tile(before, (len(bead), 1)) if hold else _followed(external, cell, directions, most, before)
        tilt = tilt_from(external.upright(directions, values), external.up)
        worst = int(tilt.argmax())
        if tilt[worst] > most + ROUNDING:
            issues.append(_not_level(bool(external.turning), float(tilt[worst]), most, *place, worst))
        before = values[-1]
        done.append(dataclasses.replace(bead, external=values))
    return done, issues


def standing(cell: Cell, toolpath: Toolpath) -> list[Issue]:
    """What leans more than allowed where no axis beside the robot turns the part: at most one issue of a bead."""
    up, issues = cell.machine.base[:3, :3] @ cell.up, []
    for (layer, index, bead), most in zip(toolpath, _allowed(toolpath), strict=True):
        if most >= math.pi:
            continue
        axes = cell.station[None, :3, 2] if cell.arrangement.carries_part else on_face(cell, bead.tool)
        tilt = tilt_from(axes, up)
        worst = int(tilt.argmax())
        if tilt[worst] > most + ROUNDING:
            issues.append(_not_level(False, float(tilt[worst]), most, layer, index, worst))
    return issues


def _not_level(turning: bool, tilt: float, most: float, *place: int) -> Issue:
    leans, allowed = math.degrees(tilt), math.degrees(most)
    if not turning:
        return Issue(ERROR, "NOT_LEVEL", f"the tool axis would be {leans:.3g} deg from the vertical, "
                     f"build_direction.max_from_vertical allows {allowed:.3g} deg, and nothing turns the part; put it on a "
                     "positioner, or allow more", *place)
    return Issue(
        ERROR, "NOT_LEVEL", f"the tool axis would be {leans:.3g} deg from the vertical, "
        f"build_direction.max_from_vertical allows {allowed:.3g} deg; the positioner cannot turn the "
        "part so far: mount the part otherwise, or allow more", *place,
    )


def figures(cell: Cell, path: JointPath) -> dict[str, object]:
    """What the external axes do along the deposit: how far the tool axis is from the vertical at most, in degrees, and how
    far each of them turns in all, and slides in all, in mm."""
    farthest = math.degrees(farthest_from_vertical(cell, path.beads))
    return {"from_vertical_max_deg": farthest, **axes_figures(cell, path.beads)}


def farthest_from_vertical(cell: Cell, paths: Sequence[BeadPath]) -> float:
    """rad, how far the tool axis is from the vertical at most."""
    external, farthest = cell.external, 0.0
    assert external is not None
    for one in paths:
        values = cell.external_of(one.joints)
        if values is None or not one.reachable:
            continue
        upright = external.upright(on_face(cell, one.bead.tool), values)
        farthest = max(farthest, float(tilt_from(upright, external.up).max()))
    return farthest


def axes_figures(cell: Cell, paths: Sequence[BeadPath]) -> dict[str, object]:
    """How far each external axis turns in all along the deposit, deg, or slides, mm."""
    external = cell.external
    assert external is not None
    turned = np.zeros(external.axes)
    for one in paths:
        values = cell.external_of(one.joints)
        if values is not None and one.reachable:
            turned += np.abs(np.diff(values, axis=0)).sum(axis=0)
    names, slides = cell.machine.axes[-len(turned) :], external.slides
    return {
        "turned_deg": {names[k]: math.degrees(way) for k, way in enumerate(turned.tolist()) if k != slides},
        **({} if slides is None else {"moved_mm": {names[slides]: float(turned[slides])}}),
    }


def _allowed(toolpath: Toolpath) -> list[float]:
    """The largest angle to the vertical, rad, of each bead."""
    most = allowed_by_layer(toolpath)
    return [most[layer] for layer, _, _ in toolpath]


def allowed_by_layer(toolpath: Toolpath) -> dict[int, float]:
    """The largest angle to the vertical, rad, of each layer."""
    return {int(number): part.max_from_vertical for part, numbers in toolpath.parts for number in numbers}


def on_face(cell: Cell, tool: Array) -> Array:
    """Tool axes (n, 3) of the part as seen from the face that carries it."""
    turned = cell.station[:3, :3] @ cell.mount[:3, :3].T
    return np.asarray(tool @ turned.T)


def _middle(directions: Array) -> Array | None:
    """The direction (3,) whose largest angle to the directions (n, 3) is least, None where they point all ways."""
    mean = directions.mean(axis=0)
    if np.linalg.norm(mean) < 1e-6:
        return None
    mean = mean / np.linalg.norm(mean)
    middle = mean
    for step in range(1, STEPS):  # Badoiu and Clarkson 2003: towards what is farthest, ever less
        farthest = directions[int((directions @ middle).argmin())]
        middle = middle + (farthest - middle) / (step + 1)
        middle /= np.linalg.norm(middle)
    nearer = float((directions @ middle).min()) > float((directions @ mean).min())
    return np.asarray(middle if nearer else mean)


def _standing(external: ExternalAxes, cell: Cell, direction: Array, before: Array) -> Array:
    """Values (k,) with a direction (3,) upright, the nearest to those before."""
    return np.asarray(_chosen(cell, _courses(external, direction[None]), before)[0])


def _followed(external: ExternalAxes, cell: Cell, directions: Array, most: float, before: Array) -> Array:
    """Values (n, k) along a bead: one and the same where that is near enough, else each direction upright."""
    middle = _middle(directions)
    if middle is not None and float(tilt_from(directions, middle).max()) <= most:
        stays = external.upright(directions, np.tile(before, (len(directions), 1)))
        if float(tilt_from(stays, external.up).max()) <= most:
            return np.tile(before, (len(directions), 1))
        return np.tile(_standing(external, cell, middle, before), (len(directions), 1))
    return _chosen(cell, _courses(external, directions), before)


def _courses(external: ExternalAxes, directions: Array) -> list[Array]:
    """All ways (n, k) to turn the directions (n, 3) of the face upright, up to whole turns."""
    source = directions @ external.at_zero.T
    if len(external.turning) == 1:
        return [np.unwrap(rotary_pair.nearest(external.turning[0], source, external.up).angle)[:, None]]
    first, second = external.turning
    pole = _pole(second, source)
    found = rotary_pair.between(first, second, pole, external.up)
    turned = np.stack([found.first, found.second], axis=-1)
    if not np.isfinite(turned).all():  # axes that are not at right angles reach no farther
        angle = rotary_pair.nearest(second, source, external.up).angle
        return [np.unwrap(np.stack([np.zeros(len(angle)), angle], axis=-1), axis=0)]
    for axis, free in enumerate((found.first_free, found.second_free)):
        turned[:, :, axis] = kept(turned[:, :, axis], free)
    return continuous(turned)


def _pole(axis: Array, directions: Array) -> Array:
    """Directions (n, 3), those nearly along an axis or against it brought onto it."""
    near = np.linalg.norm(np.cross(directions, axis), axis=1) < math.sin(AT_POLE)
    return np.where(near[:, None], np.sign(directions @ axis)[:, None] * axis, directions)


def _chosen(cell: Cell, courses: Sequence[Array], before: Array) -> Array:
    """Of all courses and whole turns the one within the limits that moves least, then the one that starts nearest to the
    values before (k,)."""
    own = cell.robot.chain.axes
    assert cell.external is not None
    turned = own + cell.external.turned
    lower, upper = cell.limits.lower[turned] + RESERVE, cell.limits.upper[turned] - RESERVE
    speed, start = cell.machine.max_speed[turned], before
    before = start[cell.external.turned]
    ranked = []
    for course in courses:
        low, high = course.min(axis=0), course.max(axis=0)
        fewest, most = np.ceil((lower - low) / TURN - 1e-12), np.floor((upper - high) / TURN + 1e-12)
        wanted = np.round((before - course[0]) / TURN)
        centred = np.round(np.nan_to_num(0.5 * (lower + upper) - 0.5 * (low + high)) / TURN)
        moved = course + TURN * np.where(fewest <= most, np.clip(wanted, fewest, most), centred)
        over = float(np.maximum(lower - moved, moved - upper).max())
        motion = float(np.abs(np.diff(moved, axis=0)).sum())
        ranked.append((max(over, 0.0), round(motion, 6), float((np.abs(moved[0] - before) / speed).max()), moved))
    best = min(range(len(ranked)), key=lambda k: ranked[k][:3])
    values = np.tile(start, (len(ranked[best][3]), 1))
    values[:, cell.external.turned] = ranked[best][3]
    return values
