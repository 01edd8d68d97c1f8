# SPDX-License-Identifier: LGPL-2.1-or-later
"""The columns, cells and curves that a map shows. Independent of window and document."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.geometry.frames import TURN
from ...core.planning import redundancy_map
from ...core.planning import redundancy_map as map
from ...core.planning.joint_path import BeadPath
from ...core.planning.redundancy_curve import Compared, Followed
from ...core.planning.redundancy_map import RZ, Columns, Picture, RedundancyMap
from ...core.types import Array, Integers, Mask
from ..in_language import tr
from .draft import CONSTANT, Draft, Pair, Source, pair_of

MOST_LABELS = 14
ACROSS = 121  # number of columns for the values of an external axis


@dataclass(frozen=True, eq=False)
class Cell:
    """The cell under the mouse. place: (layer, bead, point). joints: (axes,) rad, NaN out of reach.
    nearest: the nearest limit.
    """

    place: tuple[int, int, int]
    rz: float
    phi: float
    joints: Array
    margin: float
    nearest: str
    condition: float
    threshold: float
    touching: bool
    outside: bool
    arm: tuple[str, str] | None  # a link, 'base' or the name of its axis, and the touched object


class Board:
    """The columns of a map with their computed cells.

    Columns are the points of a job or of one layer, or the values of an external axis (`across`) at
    a point (bead, point), by default the midpoint of the bead. up: a second, vertical external
    axis.
    """

    def __init__(
        self,
        source: Source,
        layer: int | None,
        axis: str,
        across: int | None = None,
        position: tuple[int, int | None] | None = None,
        up: int | None = None,
    ) -> None:
        self.source, self.layer, self.axis, self.across, self.up = source, layer, axis, across, up
        self.pair: Pair | None = None
        self.beads = [
            k for k, (number, _) in enumerate(source.places) if layer is None or number == layer
        ]
        self.offsets: Array | None = None
        if across is None or position is None:
            columns = redundancy_map.columns([source.beads[k] for k in self.beads], source.cell)
            self.columns: Columns = dataclasses.replace(
                columns, bead=np.array(self.beads)[columns.bead]
            )
        else:
            bead = source.beads[position[0]]
            point = len(bead) // 2 if position[1] is None else position[1]
            self.offsets = map.span(source.task(source.branch), bead, point, across, ACROSS)
            self.columns = map.across(
                source.beads, source.cell, (position[0], point), across, self.offsets
            )
            if up is not None:
                self.pair = pair_of(source, (position[0], point), (across, up), self.offsets)
        self.map: RedundancyMap | None = None
        self.pictures: dict[int, Picture] = {}
        self.looked: dict[int, int] = {}  # row stride of the link check by branch
        self.curves: dict[int, tuple[tuple[BeadPath, ...], Array]] = {}

    # ---- computation, in another thread

    def compute(self, branch: int) -> tuple[RedundancyMap, Picture]:
        """Compute missing cells of all branches, and the picture of one branch."""
        if self.pair is not None:
            return self.pair.compute(branch, self.map)
        task = self.source.task(branch)
        cells = self.map or redundancy_map.redundancy_map(
            task, self.columns, self.axis, self.source.toolpath.surroundings
        )
        return cells, self.pictures.get(branch) or redundancy_map.picture(task, cells, branch)

    def take(self, result: tuple[RedundancyMap, Picture]) -> None:
        """Store the computed map and picture."""
        self.map = result[0]
        self.pictures[result[1].branch] = result[1]

    @property
    def moment(self) -> Integers:
        """(C,) number of points of the job that are deposited before each column."""
        return np.asarray(self.source.starts[self.columns.bead] + self.columns.point)

    def arm(self, branch: int, stride: int) -> Mask:
        """Return a mask (R, C) of cells in which a robot link touches something.

        Only every `stride`-th row is checked.
        """
        assert self.map is not None
        if self.pair is not None:
            return self.pair.arm(branch, self.map)
        return redundancy_map.arm_touched(
            self.source.task(branch), self.map, branch, self.source.arm, self.moment, stride
        )

    def take_arm(self, branch: int, touched: Mask, stride: int) -> None:
        """Store the link check."""
        self.looked[branch] = stride if self.pair is None else 1
        self.pictures[branch] = dataclasses.replace(self.pictures[branch], arm=touched)

    def shows(self, bead: int) -> bool:
        """Whether a bead is among the columns; False if the columns are values of an axis."""
        return self.offsets is None and bool((self.columns.bead == bead).any())

    @property
    def title(self) -> str:
        """Description of the columns."""
        if self.offsets is not None:
            layer, bead, point = self.place(0)
            if self.pair is not None:
                return tr("{} against {} at layer {} bead {} point {}").format(
                    self._across_name, self.pair.name, layer, bead, point
                )
            return tr("{} at layer {} bead {} point {}").format(
                self._across_name, layer, bead, point
            )
        if self.layer is not None:
            return tr("points of layer {}").format(self.layer)
        count = len(np.unique(self.columns.bead))
        return (
            tr("layers")
            if count == len(self.beads)
            else tr("layers ({} of {} beads)").format(count, len(self.beads))
        )

    def reachable_shares(self) -> Array:
        """Return the fraction (8,) of cells that each branch reaches within its limits."""
        assert self.map is not None
        return np.asarray((self.map.margin >= 0.0).mean(axis=(1, 2)))

    # ---- positions

    @property
    def seams(self) -> Integers:
        """Columns at which beads begin."""
        return np.flatnonzero(np.diff(self.columns.bead, prepend=-1) != 0)

    @property
    def marks(self) -> Integers:
        """Columns with a line before them, except the first column: bead starts, or the planned
        value of the external axis.
        """
        if self.offsets is None:
            return self.seams
        planned = self.source.beads[int(self.columns.bead[0])].external
        assert planned is not None and self.across is not None
        planned_value = float(planned[int(self.columns.point[0]), self.across])
        return np.array([0, int(np.abs(self.offsets - planned_value).argmin())])

    @property
    def _across_name(self) -> str:
        robot_axes = self.source.cell.robot.chain.axes
        return self.source.cell.machine.axes[robot_axes + (self.across or 0)]

    @property
    def labels(self) -> list[tuple[float, str]]:
        """Columns and their labels: layer numbers, or point numbers of a single layer."""
        count = len(self.columns)
        if self.offsets is not None:
            unit = float(
                self.source.cell.machine.unit_values[
                    self.source.cell.robot.chain.axes + (self.across or 0)
                ]
            )
            columns = np.unique(np.round(np.linspace(0, count - 1, MOST_LABELS // 2)).astype(int))
            return [(float(k), f"{self.offsets[k] / unit:.0f}") for k in columns]
        if self.layer is None:
            layer = np.array([self.source.places[k][0] for k in self.columns.bead])
            starts = np.flatnonzero(np.diff(layer, prepend=-1) != 0)
            return [
                (float(k), str(layer[k])) for k in starts[:: max(1, -(-len(starts) // MOST_LABELS))]
            ]
        points = np.unique(np.round(np.linspace(0, count - 1, MOST_LABELS)).astype(int))
        return [(float(k), str(self.columns.point[k])) for k in points]

    def column_of(self, bead: int, parameter: float) -> float:
        """Return the fractional column of a bead's parameter."""
        columns = np.flatnonzero(self.columns.bead == bead)
        parameters = self.columns.points.parameter[columns]
        sign = 1.0 if parameters[-1] >= parameters[0] else -1.0
        return float(np.interp(sign * parameter, sign * parameters, columns))

    def place(self, column: int) -> tuple[int, int, int]:
        """Return layer, bead and point of a column."""
        layer, index = self.source.places[int(self.columns.bead[column])]
        return layer, index, int(self.columns.point[column])

    # ---- curves

    def values(self, phi: Array) -> Array:
        """Return the axis values (C,) of rotations at the columns, unwrapped along each bead, with
        the bead's mean within half a turn of 0.
        """
        value = self._unwrapped(phi)
        return value - self._turns(value)

    def _unwrapped(self, phi: Array) -> Array:
        points = self.columns.points
        value = redundancy_map.value_of(self.source.cell, points.tool, phi, self.axis)
        if self.axis == RZ:
            # RZ follows the rotation, reversed if the tool points down, except for a slow drift
            side = np.where((points.tool @ self.source.cell.poses.mount[:3, 2]) < 0.0, -1.0, 1.0)
            value = side * phi + redundancy_map.in_turns(
                value - side * phi, np.diff(self.columns.bead, prepend=-1) != 0
            )
        return value

    def _turns(self, value: Array) -> Array:
        """Return the whole turns (C,), rad, between the mean of each bead and 0."""
        starts = self.seams
        mean = np.add.reduceat(value, starts) / np.diff(np.append(starts, len(value)))
        # rounded, so that a mean at half a turn does not flip with its last digit
        turns = TURN * np.round(np.round(mean / TURN, 9))
        return np.asarray(np.repeat(turns, np.diff(np.append(starts, len(value)))))

    def draft_values(self, draft: Draft) -> Array:
        """Return the edited curve (C,) in the turns of the plan, so that it does not jump during a
        drag.
        """
        value = self._unwrapped(draft.phi(self.columns.points, self.columns.bead))
        planned = self.source.planned.beads
        like = (
            value
            if draft.kind == CONSTANT
            else self._unwrapped(draft.rotation_at(planned, self.columns))
        )
        return value - self._turns(like)

    def path_values(self, draft: Draft, paths: tuple[BeadPath, ...]) -> Array:
        """Return the values (C,) of a planned curve."""
        cached = self.curves.get(id(paths))
        if cached is None or cached[0] is not paths:
            cached = self.curves[id(paths)] = (
                paths,
                self.values(draft.rotation_at(paths, self.columns)),
            )
        return cached[1]

    def bad(self, draft: Draft, followed: Followed, values: Array) -> Array:
        """Return columns and values (k, 2) of the curve's infeasible points."""
        if self.offsets is not None:
            return np.zeros((0, 2))
        row = draft.live.row[~followed.good]
        rows = draft.starts[self.columns.bead] + self.columns.point
        row = row[np.isin(np.searchsorted(draft.starts, row, side="right") - 1, self.columns.bead)]
        column = np.interp(row, rows, np.arange(len(rows)))
        return np.stack([column, np.interp(column, np.arange(len(rows)), values)], axis=1)

    def change(self, draft: Draft, column: int, old: float, new: float) -> float:
        """Return the change of the draft's variable, rad, when the curve goes from `old` to `new`
        at a column.
        """
        of_rz = draft.kind == CONSTANT or self.source.parameters.parameter == RZ
        if of_rz == (self.axis == RZ):
            return new - old
        tool, cell = self.columns.points.tool[[column]], self.source.cell
        phi = [
            redundancy_map.rotation_of(cell, tool, np.array([value]), self.axis)
            for value in (old, new)
        ]
        old_rotation, new_rotation = (
            float((cell.poses.rz_of_phi(tool, angle) if of_rz else angle)[0]) for angle in phi
        )
        side = -1.0 if float(tool[0] @ cell.poses.mount[:3, 2]) < 0.0 else 1.0
        by = new_rotation - old_rotation
        return by - TURN * round((by - side * (new - old)) / TURN)

    def cell(self, branch: int, column: int, value: float) -> Cell:
        """Return the values of a cell of the map."""
        points, task = self.columns.points, self.source.task(branch)
        sample = points.select_points(np.array([column]))
        phi = redundancy_map.rotation_of(task.cell, sample.tool, np.array([value]), self.axis)
        number, columns = column, self.columns
        if self.pair is not None:
            phi, number, columns = (
                np.array([self.pair.phi]),
                self.pair.number(column, value),
                self.pair.cells,
            )
            sample = columns.points.select_points(np.array([number]))
        joints = redundancy_map.joints_at(task, columns, number, float(phi[0]))[branch]
        offset = np.abs(task.given_rows.offset(joints))
        reached = bool(np.isfinite(joints).all())
        condition = float(task.condition(sample, phi, joints[None])[0]) if reached else 0.0
        redundancy = self.map
        low, high = self.source.parameters.rotation_range
        outside = high - low < TURN - 1e-9 and float((phi[0] - low) % TURN) > high - low
        return Cell(
            self.place(column),
            float(task.cell.poses.rz_of_phi(sample.tool, phi)[0]),
            float(phi[0]),
            joints,
            float(1.0 - offset.max()) if reached else -np.inf,
            task.given_rows.labels[int(offset.argmax())] if reached else "",
            condition,
            float(task.thresholds(sample)[0]),
            redundancy is not None and bool(redundancy.touching[number]),
            outside,
            self._arm_at(branch, column, joints),
        )

    def _arm_at(self, branch: int, column: int, joints: Array) -> tuple[str, str] | None:
        """Return the first touching link at a column and the touched object; None before the link
        check.
        """
        if branch not in self.looked:
            return None
        arm = self.source.arm
        contact = arm.touches(joints[None], self.moment[[column]])
        if not contact.any[0]:
            return None
        return arm.links[contact.link[0]], arm.names[contact.what[0]]


OWN_CURVE, PLANNED_CURVE = "own", "planned"
COLOURS = {
    OWN_CURVE: (255, 140, 0),
    PLANNED_CURVE: (255, 255, 255),
    "constant": (0, 215, 255),
    "point-by-point": (255, 70, 220),
    "layer-by-layer": (140, 255, 120),
}


@dataclass(frozen=True, eq=False)
class Curve:
    """A line over the map. values: (C,) rad, unwrapped along each bead. bold: whether it can be
    dragged.
    """

    values: Array
    colour: tuple[int, int, int]
    bold: bool = False
    dashed: bool = False


@dataclass(frozen=True)
class Handle:
    """A handle of the curve: bead, index among the bead's handles, position."""

    bead: int
    number: int
    column: float
    value: float


@dataclass
class Dragged:
    """The dragged handle and its last value. handle: None for the whole curve."""

    handle: Handle | None
    column: int
    value: float
    moved: bool = False


def build_curves(
    board: Board,
    draft: Draft,
    bead: int,
    planned: Sequence[Any],
    compared: Sequence[Compared],
    followed: Followed,
    shows: Callable[[str], bool],
) -> tuple[list[Curve], list[Handle], Array]:
    """Build the curves, the handles of the edited curve at a bead, and its infeasible points (n,
    2).

    planned: beads of the joint path. compared: other methods. followed: the evaluated edited curve.
    shows: whether the curve of a name is visible. Infeasible points are column and value.
    """
    if board.pair is not None:
        return [], [], np.zeros((0, 2))  # the rotation is the planned one
    curves = [
        Curve(board.path_values(draft, paths), COLOURS[name], dashed=name == PLANNED_CURVE)
        for name, paths in [
            (PLANNED_CURVE, planned),
            *((method.name, method.paths) for method in compared),
        ]
        if shows(name)
    ]
    if not shows(OWN_CURVE):
        return curves, [], np.zeros((0, 2))
    values = board.draft_values(draft)
    curves.append(Curve(values, COLOURS[OWN_CURVE], bold=True))
    return curves, _handles(board, draft, bead, values), board.bad(draft, followed, values)


def _handles(board: Board, draft: Draft, bead: int, values: Array) -> list[Handle]:
    if draft.kind == CONSTANT or not board.shows(bead):
        return []
    columns = [board.column_of(bead, float(parameter)) for parameter in draft.handles(bead)]
    return [
        Handle(bead, number, column, float(np.interp(column, np.arange(len(values)), values)))
        for number, column in enumerate(columns)
    ]
