# SPDX-License-Identifier: LGPL-2.1-or-later
"""The edited curve: one polynomial per bead, or one RZ for all. Independent of window and document."""

from __future__ import annotations

import contextlib
import copy
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...core.collision.bead_ends import LINK_GRAIN, Beads
from ...core.geometry.frames import TURN
from ...core.issues import InputError
from ...core.kinematics.cell import Cell
from ...core.kinematics.inverse import spherical_wrist
from ...core.kinematics.links import external_links
from ...core.kinematics.links.contact import ArmContact
from ...core.kinematics.links.external_links import Mesh
from ...core.parameters.joints import BRANCHES as BRANCH_WORDS
from ...core.parameters.joints import OF_CELL, GivenPolynomial, JointParameters
from ...core.parameters.process import ProcessParameters
from ...core.planning import redundancy_curve as rotation_curve
from ...core.planning import redundancy_map
from ...core.planning import redundancy_map as map
from ...core.planning.joint_path import BeadPath, JointPath
from ...core.planning.points import Points
from ...core.planning.redundancy_curve import Followed
from ...core.planning.redundancy_map import Columns, Picture, RedundancyMap, in_turns
from ...core.planning.rotation.given import METHOD
from ...core.planning.rotation.planned import rotation_along
from ...core.planning.task import Task
from ...core.toolpath import Bead, Toolpath
from ...core.types import Array, Integers, Mask
from ...objects import user_machines
from ...objects.joint_path import planned_of
from ...objects.results.findings import first_message, issues_of
from ...objects.shapes.cell_obstacles import meshes_of, resolved
from ...objects.stage import stage_of
from ...objects.staleness import UP_TO_DATE
from ..in_language import tr, translated


@dataclass(frozen=True)
class Source:
    """Inputs read from the document.

    objects: names of the objects read. beads: beads of the toolpath with their keys (layer, index),
    starting at the seams of the plan. width: mm; for beads without a width. shapes: user's meshes
    of the robot's links.
    """

    document: str
    name: str
    title: str
    objects: tuple[str, ...]
    cell: Cell
    parameters: JointParameters
    toolpath: Toolpath
    planned: JointPath
    beads: tuple[Bead, ...]
    places: tuple[tuple[int, int], ...]
    width: float
    shapes: tuple[Mesh | None, ...]

    @cached_property
    def starts(self) -> Array:
        """(beads + 1,) number of points before each bead, and in total."""
        return np.concatenate([[0], np.cumsum([len(bead) for bead in self.beads])])

    @cached_property
    def arm(self) -> ArmContact:
        """The robot with its obstacles and the deposit in the order of the beads; built in the
        background.
        """
        deposited = Beads.of(self.beads, self.width, self.toolpath.layer_height).solid(LINK_GRAIN)
        cylinders = external_links.robot_cylinders(self.cell.robot.chain, self.shapes)
        return ArmContact(self.cell, cylinders, self.toolpath.surroundings, deposited)

    @property
    def branch(self) -> int:
        """The planned branch."""
        return spherical_wrist.branch_index(self.planned.branch)

    def task(self, branch: int) -> Task:
        """Return the planning task for a branch."""
        return Task(self.cell, branch, self.parameters, not self.toolpath.traits.has_axis)


def source_of(obj: Any) -> Source:
    """Read the inputs for a joint path. Raises InputError with the remedy if the path has no map."""
    stage = stage_of(obj)
    if stage is None or stage.kind != "joint path":
        raise InputError(
            "NO_MAP",
            getattr(obj, "Label", "?"),
            "the object is not a joint path; select a joint path",
        )
    value, toolpath, looks = planned_of(obj, obj.Label)
    cell = resolved(looks, toolpath, user_machines.folders())
    if not cell.machine.free or not value.joint_path.branch:
        raise InputError(
            "NO_MAP",
            obj.Label,
            "the machine has two rotary axes and no tool redundancy; open the map of a robot",
        )
    return Source(
        document=obj.Document.Name,
        name=obj.Name,
        title=obj.Label,
        objects=tuple(dict.fromkeys((obj.Name, obj.Toolpath.Name, obj.Cell.Name))),
        cell=cell,
        parameters=obj.Proxy.parameters(obj, JointParameters),
        toolpath=toolpath,
        planned=value.joint_path,
        beads=_as_run(toolpath, value.joint_path, cell),
        places=_places(toolpath, value.joint_path, cell),
        width=obj.Toolpath.Proxy.parameters(obj.Toolpath, ProcessParameters).bead_width,
        shapes=meshes_of(cell.robot),
    )


def status_of(obj: Any) -> tuple[str, bool]:
    """Return the state of a joint path in the window's language, and whether it is an error; '' if
    deleted.
    """
    with contextlib.suppress(ReferenceError, RuntimeError):
        message = first_message(issues_of(obj))
        wrong, status = obj.Status != UP_TO_DATE, translated(obj.Status)
        return tr("{}: {}").format(
            status, translated(message)
        ) if message and wrong else status, wrong
    return "", False


def _places(toolpath: Toolpath, planned: JointPath, cell: Cell) -> tuple[tuple[int, int], ...]:
    if cell.external is not None:
        return tuple((path.layer, path.index) for path in planned.beads)
    return tuple((layer, index) for layer, index, _ in toolpath)


def _as_run(toolpath: Toolpath, planned: JointPath, cell: Cell) -> tuple[Bead, ...]:
    """Return the beads of a toolpath, starting at the seams of the plan.

    The plan may move the seam of a closed bead to keep an axis within its limits. Layers with split
    beads stay unchanged. With external axes, return the beads of the plan, which hold their
    positions.
    """
    if cell.external is not None:
        return tuple(path.bead for path in planned.beads)
    run = {(path.layer, path.index): path.bead for path in planned.beads}
    piece_counts, beads = (
        Counter(path.layer for path in planned.beads),
        Counter(layer for layer, _, _ in toolpath),
    )
    run_beads = []
    for layer, index, bead in toolpath:
        run_bead = run.get((layer, index))
        if run_bead is not None and bead.closed and piece_counts[layer] == beads[layer]:
            distance = np.linalg.norm(bead.points[:-1] - run_bead.points[0], axis=1)
            bead = bead.started_at(int(distance.argmin()))
        run_beads.append(bead)
    return tuple(run_beads)


ROWS = 61  # number of values of the vertical axis
LABELS = 6


@dataclass(frozen=True, eq=False)
class Pair:
    """The map of one external axis against another at a point.

    cells: all pairs, row by row. values: (R,) rad or mm of the axis `up`, whose planned value is
    `here`. phi: planned rotation, rad. count: number of columns.
    """

    source: Source
    up: int
    cells: Columns
    values: Array
    here: float
    phi: float
    count: int

    def compute(self, branch: int, existing: RedundancyMap | None) -> tuple[RedundancyMap, Picture]:
        """Compute missing cells of all branches in one row, and the picture (R, C) of one branch."""
        task = self.source.task(branch)
        result = existing or redundancy_map.redundancy_map(
            task,
            self.cells,
            redundancy_map.ROTATION,
            self.source.toolpath.surroundings,
            np.array([self.phi]),
        )
        return result, map.in_rows(redundancy_map.picture(task, result, branch), len(self.values))

    def arm(self, branch: int, redundancy: RedundancyMap) -> Mask:
        """Return a mask (R, C) of cells in which a robot link touches something."""
        source = self.source
        moment = source.starts[self.cells.bead] + self.cells.point
        touched = redundancy_map.arm_touched(
            source.task(branch), redundancy, branch, source.arm, moment
        )
        return touched.reshape(len(self.values), self.count)

    def number(self, column: int, value: float) -> int:
        """Return the index in `cells` of a column and a height on the map, from -pi to pi."""
        row = round((value + np.pi) / TURN * (len(self.values) - 1))
        return int(np.clip(row, 0, len(self.values) - 1)) * self.count + column

    @property
    def name(self) -> str:
        """Name of the vertical axis."""
        return self.source.cell.machine.axes[self.source.cell.robot.chain.axes + self.up]

    @property
    def labels(self) -> list[tuple[float, str]]:
        """Heights and their labels, deg or mm."""
        machine = self.source.cell.machine
        unit = float(machine.unit_values[self.source.cell.robot.chain.axes + self.up])
        sign = " mm" if machine.chain.sliding[self.source.cell.robot.chain.axes + self.up] else "°"
        rows = np.unique(np.round(np.linspace(0, len(self.values) - 1, LABELS)).astype(int))
        return [
            (float(TURN * k / (len(self.values) - 1) - np.pi), f"{self.values[k] / unit:.0f}{sign}")
            for k in rows
        ]

    @property
    def planned(self) -> float:
        """Height of the planned axis value."""
        return float(
            np.interp(self.here, self.values, np.linspace(-np.pi, np.pi, len(self.values)))
        )


def pair_of(
    source: Source, position: tuple[int, int], axes: tuple[int, int], offsets: Array
) -> Pair:
    """Build the map at a point (bead, point): values (C,) of the first of two external axes against
    the range of the second axis.
    """
    bead, point = position
    values = map.span(source.task(source.branch), source.beads[bead], point, axes[1], ROWS)
    cells = map.across_two_axes(source.beads, source.cell, position, axes, (offsets, values))
    planned = float(redundancy_map.planned_external(source.beads[bead])[point, axes[1]])
    return Pair(
        source,
        axes[1],
        cells,
        values,
        planned,
        float(source.planned.beads[bead].phi[point]),
        len(offsets),
    )


POLYNOMIALS, CONSTANT = "polynomials", "constant"
LIVE = 4000  # approximate number of sample points during a drag
TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class Sampled:
    """Points of all beads at which curves are evaluated.

    kept: point indices of each bead. lasts: (T,) s. planned: (T,) planned rotation. row: (T,)
    indices of the points among all points.
    """

    points: Points
    kept: tuple[Integers, ...]
    lasts: Array
    planned: Array
    row: Integers


class Draft:
    """The edited curve, which starts as the planned curve.

    coefficients: (B, degree + 1), of the job's variable, constant first, rad.
    """

    def __init__(self, source: Source) -> None:
        self.source, self.branch = source, source.branch
        self.starts = np.concatenate([[0], np.cumsum([len(bead) for bead in source.beads])])
        self.live = self._sampled(LIVE)
        self.thinned = len(self.live.points) < self.starts[-1]
        self.thresholds: dict[tuple[int, bool], Array] = {}
        self.reset()

    @cached_property
    def full(self) -> Sampled:
        """All points; slow for many points."""
        return self._sampled(int(self.starts[-1])) if self.thinned else self.live

    def copied(self) -> Draft:
        """Return a copy of the current curve for another thread."""
        duplicate = copy.copy(self)
        duplicate.coefficients, duplicate.thresholds = (
            self.coefficients.copy(),
            dict(self.thresholds),
        )
        return duplicate

    def learn(self, duplicate: Draft) -> None:
        """Store the results of a copy about the points."""
        self.__dict__["full"] = duplicate.full
        self.thresholds.update(duplicate.thresholds)

    def reset(self) -> None:
        """Reset to the plan."""
        source = self.source
        self.branch = source.branch
        by_place = {(path.layer, path.index): path.coefficients for path in source.planned.beads}
        planned = [by_place.get(key) for key in source.places]
        points = self.live.points
        width = max(
            [source.parameters.degree + 1, *(len(row) for row in planned if row is not None)]
        )
        if all(row is not None for row in planned) and len(source.planned.beads) == len(
            source.places
        ):
            self.coefficients = np.array([np.pad(row, (0, width - len(row))) for row in planned])
        else:
            self.coefficients = rotation_curve.fitted(
                points, self._variable(points, self.live.planned), width - 1
            )
            is_complete = len(source.planned.beads) == len(source.places)
            for row, known_row in zip(self.coefficients, planned):
                if known_row is not None and is_complete:
                    row[:] = 0.0
                    row[: len(known_row)] = known_row
        self.first = self.coefficients.copy()
        self.kind = CONSTANT if source.planned.method == CONSTANT else POLYNOMIALS
        rz = source.parameters.rz
        self.rz = self.first_rz = float(rz) if not isinstance(rz, str) else self._mean_rz()

    @property
    def degree(self) -> int:
        """Degree of the polynomials."""
        return int(self.coefficients.shape[1]) - 1

    @property
    def changed(self) -> list[int]:
        """Beads whose polynomial differs from the plan."""
        planned = np.zeros_like(self.coefficients)
        width = min(planned.shape[1], self.first.shape[1])
        planned[:, :width] = self.first[:, :width]
        is_truncated = np.abs(self.first[:, width:]).max(axis=1, initial=0.0) > TOLERANCE
        return [
            int(k)
            for k in np.flatnonzero(
                (np.abs(self.coefficients - planned).max(axis=1) > TOLERANCE) | is_truncated
            )
        ]

    @property
    def edited(self) -> bool:
        """Whether the curve differs from the plan."""
        method = self.source.planned.method
        if self.branch != self.source.branch:
            return True
        if self.kind == CONSTANT:
            return method != CONSTANT or abs(self.rz - self.first_rz) > TOLERANCE
        return method != METHOD or bool(self.changed)

    # ---- the curve

    def phi(self, points: Points, bead: Integers) -> Array:
        """Return the rotation (T,) of the curve at points of beads (T,)."""
        task = self.source.task(self.branch)
        if self.kind == CONSTANT:
            phi, _ = self.source.cell.poses.phi_of_rz(points.tool, np.full(len(points), self.rz))
            return in_turns(phi, np.diff(bead, prepend=-1) != 0)
        value = np.zeros(len(points))
        for column in self.coefficients.T[::-1]:
            value = value * points.parameter + column[bead]
        return task.rotation(points, value)[0]

    def evaluate(self, live: bool = True) -> Followed:
        """Evaluate the curve on the machine."""
        sampled = self.live if live else self.full
        return self.follow(self.phi(sampled.points, sampled.points.bead), live)

    def follow(self, phi: Array, live: bool = True) -> Followed:
        """Evaluate rotations at the sample points on the branch of the curve."""
        sampled, task = self.live if live else self.full, self.source.task(self.branch)
        key = self.branch, live and self.thinned
        if key not in self.thresholds:
            self.thresholds[key] = task.thresholds(sampled.points)
        return rotation_curve.follow(task, sampled.points, self.thresholds[key], sampled.lasts, phi)

    def rotation_at(self, paths: Sequence[BeadPath], columns: Columns) -> Array:
        """Return the rotation (C,) of planned paths at columns of a map."""
        parameters = {
            int(k): columns.points.parameter[columns.bead == k] for k in np.unique(columns.bead)
        }
        return np.concatenate(
            list(rotation_along(paths, self.source.beads, self.source.places, parameters).values())
        )

    # ---- editing

    def shift(self, by: float, beads: list[int]) -> None:
        """Shift the polynomials of beads, or the constant RZ, by an angle."""
        if self.kind == CONSTANT:
            self.rz = float((self.rz + by + np.pi) % (2.0 * np.pi) - np.pi)
        else:
            self.coefficients[beads, 0] += by

    def enter(self, number: int, value: float, bead: int, beads: list[int]) -> None:
        """Set a coefficient of a bead, rad and rad per turn to its power, or the constant RZ.

        The same coefficient of the other beads shifts by the same amount.
        """
        if self.kind == CONSTANT:
            self.rz = float(value)
        else:
            self.coefficients[beads, number] += (
                value / TURN**number - self.coefficients[bead, number]
            )

    def handles(self, bead: int) -> Array:
        """Return the parameters (n,) of the handles of a bead's polynomial."""
        return rotation_curve.handles(
            self.source.task(self.branch), self.live.points, bead, self.degree
        )

    def pull(self, bead: int, handle: int, by: float, beads: list[int]) -> None:
        """Move a handle of a bead, and the same handle of further beads, by an angle."""
        task, points = self.source.task(self.branch), self.live.points
        low, high = points.ends
        changes: dict[
            tuple[float, float, bool], Array
        ] = {}  # beads that overlap change in the same way
        for k in beads:
            key = float(low[k]), float(high[k]), bool(points.closed[k])
            if key not in changes:
                number = min(handle, len(self.handles(k)) - 1)
                changes[key] = rotation_curve.pull(task, points, k, self.degree, number)
            self.coefficients[k] += by * changes[key]

    def set_degree(self, degree: int) -> None:
        """Change the degree of the polynomials. A higher degree keeps the curve, a lower degree
        approximates it.
        """
        if degree > self.degree:
            zeros = np.zeros((len(self.coefficients), degree - self.degree))
            self.coefficients = np.concatenate([self.coefficients, zeros], axis=1)
        elif degree < self.degree:
            points = self.live.points
            self.coefficients = rotation_curve.fitted(
                points, points.polynomial(self.coefficients), degree
            )

    # ---- applying the curve

    def arguments(self) -> dict[str, str]:
        """Return the arguments of `api.change`, as Python source, that make the planner use this
        curve.
        """
        branch = OF_CELL if self.source.cell.branch == self.branch else BRANCH_WORDS[self.branch]
        shared = {"own_branch": repr(branch)}
        if self.kind == CONSTANT:
            return {
                "method": repr(CONSTANT),
                "rz": repr(round(float(np.degrees(self.rz)), 9)),
                "given": "()",
                **shared,
            }
        return {"method": repr(METHOD), "given": repr(self.polynomial_texts()), **shared}

    def polynomial_texts(self) -> tuple[str, ...]:
        """Return the polynomials of the beads in job file form; a single one if all are equal."""
        same = np.abs(self.coefficients - self.coefficients[0]).max() <= TOLERANCE
        rows = (
            [(None, self.coefficients[0])]
            if same
            else list(zip(self.source.places, self.coefficients))
        )
        return tuple(
            str(GivenPolynomial(bead, tuple(float(value) for value in row))) for bead, row in rows
        )

    # ----

    def _sampled(self, limit: int) -> Sampled:
        source, indices = self.source, []
        total = int(self.starts[-1])
        for bead in source.beads:
            turns = abs(float(bead.parameter[-1] - bead.parameter[0])) / (2.0 * np.pi)
            minimum = max(10, int(np.ceil(12 * turns)))
            count = (
                len(bead)
                if limit >= total
                else min(len(bead), max(minimum, len(bead) * limit // total))
            )
            indices.append(
                np.unique(np.round(np.linspace(0, len(bead) - 1, count)).astype(np.int64))
            )
        row = np.concatenate([start + index for start, index in zip(self.starts, indices)])
        counts = np.array([len(index) for index in indices])
        position, tool, parameter = (
            np.concatenate(
                [getattr(bead, name)[index] for bead, index in zip(source.beads, indices)]
            )
            for name in ("points", "tool", "parameter")
        )
        external, slides = (
            redundancy_map.external_of(source.cell, source.beads, indices),
            source.cell.machine.chain.sliding,
        )
        points = Points(
            position,
            tool,
            parameter,
            np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.int64),
            np.repeat(np.arange(len(indices)), counts),
            np.array([bead.closed for bead in source.beads], dtype=bool),
            source.cell.pose_frames(position, tool, external),
            external,
            slides if slides.any() else None,
        )
        parameters = {
            k: bead.parameter[index] for k, (bead, index) in enumerate(zip(source.beads, indices))
        }
        planned = list(
            rotation_along(source.planned.beads, source.beads, source.places, parameters).values()
        )
        return Sampled(
            points,
            tuple(indices),
            rotation_curve.durations(source.beads, indices),
            np.concatenate(planned),
            row.astype(np.int64),
        )

    def _variable(self, points: Points, phi: Array) -> Array:
        """Return the job's variable at rotations phi (T,), unwrapped along the beads."""
        if self.source.parameters.parameter == "rotation":
            return phi
        return in_turns(self.source.cell.poses.rz_of_phi(points.tool, phi), points.starts)

    def _mean_rz(self) -> float:
        rz = self.source.cell.poses.rz_of_phi(self.live.points.tool, self.live.planned)
        return float(np.angle(np.exp(1j * rz).mean()))
