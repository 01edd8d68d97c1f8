# SPDX-License-Identifier: LGPL-2.1-or-later
"""The curve that the user works on: one polynomial per bead, or one RZ for all. Knows neither window nor document."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from freecad_am.core.geometry.angles import TURN
from freecad_am.core.types import Array, Integers

from ...core.parameters.joints import BRANCHES as BRANCH_WORDS
from ...core.parameters.joints import OF_CELL, given_text
from ...core.planning.joint_path import BeadPath
from ...core.planning.points import Points
from ...core.planning.redundancy import curve as rotation_curve
from ...core.planning.redundancy import map as redundancy_map
from ...core.planning.redundancy.curve import Followed
from ...core.planning.redundancy.map import Columns, in_turns
from ...core.planning.rotation.given import METHOD
from ...core.planning.rotation.planned import rotation_along
from .source import Source

POLYNOMIALS, CONSTANT = "polynomials", "constant"
LIVE = 4000  # points that are looked at while the curve is dragged, about
TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class Sampled:
    """Points of all beads at which curves are followed. kept: of each bead. lasts: (T,) s. planned: (T,) rotation of the
    plan. row: (T,) numbers of the points among all."""

    points: Points
    kept: tuple[Integers, ...]
    lasts: Array
    planned: Array
    row: Integers


class Draft:
    """Starts as what was planned. coefficients: (B, degree + 1) of the variable of the job, the constant first, rad."""

    def __init__(self, source: Source) -> None:
        self.source, self.branch = source, source.branch
        self.starts = np.concatenate([[0], np.cumsum([len(bead) for bead in source.beads])])
        self.live = self._sampled(LIVE)
        self.thinned = len(self.live.points) < self.starts[-1]
        self.thresholds: dict[tuple[int, bool], Array] = {}
        self.reset()

    @cached_property
    def full(self) -> Sampled:
        """All points; making them takes time where there are many."""
        return self._sampled(int(self.starts[-1])) if self.thinned else self.live

    def copied(self) -> Draft:
        """The curve as it is now, for another thread."""
        other = copy.copy(self)
        other.coefficients, other.thresholds = self.coefficients.copy(), dict(self.thresholds)
        return other

    def learn(self, other: Draft) -> None:
        """Keep what a copy had to compute of the points."""
        self.__dict__["full"] = other.full
        self.thresholds.update(other.thresholds)

    def reset(self) -> None:
        """Back to what was planned."""
        source = self.source
        self.branch = source.branch
        by_place = {(path.layer, path.index): path.coefficients for path in source.planned.beads}
        known = [by_place.get(place) for place in source.places]
        points = self.live.points
        width = max([source.parameters.degree + 1, *(len(row) for row in known if row is not None)])
        if all(row is not None for row in known) and len(source.planned.beads) == len(
            source.places
        ):
            self.coefficients = np.array([np.pad(row, (0, width - len(row))) for row in known])
        else:
            self.coefficients = rotation_curve.fitted(
                points, self._variable(points, self.live.planned), width - 1
            )
            whole = len(source.planned.beads) == len(source.places)
            for row, known_row in zip(self.coefficients, known):
                if known_row is not None and whole:
                    row[:] = 0.0
                    row[: len(known_row)] = known_row
        self.first = self.coefficients.copy()
        self.kind = CONSTANT if source.planned.method == CONSTANT else POLYNOMIALS
        rz = source.parameters.rz
        self.rz = self.first_rz = float(rz) if not isinstance(rz, str) else self._mean_rz()

    @property
    def degree(self) -> int:
        """Of the polynomials."""
        return int(self.coefficients.shape[1]) - 1

    @property
    def changed(self) -> list[int]:
        """Beads whose polynomial is no longer the planned one."""
        first = np.zeros_like(self.coefficients)
        width = min(first.shape[1], self.first.shape[1])
        first[:, :width] = self.first[:, :width]
        lost = np.abs(self.first[:, width:]).max(axis=1, initial=0.0) > TOLERANCE
        return [
            int(k)
            for k in np.flatnonzero(
                (np.abs(self.coefficients - first).max(axis=1) > TOLERANCE) | lost
            )
        ]

    @property
    def edited(self) -> bool:
        """Whether it is another curve than that of the plan."""
        method = self.source.planned.method
        if self.branch != self.source.branch:
            return True
        if self.kind == CONSTANT:
            return method != CONSTANT or abs(self.rz - self.first_rz) > TOLERANCE
        return method != METHOD or bool(self.changed)

    # ---- the curve

    def phi(self, points: Points, bead: Integers) -> Array:
        """The rotation (T,) of the curve at points of beads (T,)."""
        task = self.source.task(self.branch)
        if self.kind == CONSTANT:
            phi, _ = self.source.cell.phi_of_rz(points.tool, np.full(len(points), self.rz))
            return in_turns(phi, np.diff(bead, prepend=-1) != 0)
        value = np.zeros(len(points))
        for column in self.coefficients.T[::-1]:
            value = value * points.parameter + column[bead]
        return task.rotation(points, value)[0]

    def followed(self, live: bool = True) -> Followed:
        """What the curve asks of the machine."""
        sampled = self.live if live else self.full
        return self.follow(self.phi(sampled.points, sampled.points.bead), live)

    def follow(self, phi: Array, live: bool = True) -> Followed:
        """What rotations at the points looked at ask of the machine, on the branch of the curve."""
        sampled, task = self.live if live else self.full, self.source.task(self.branch)
        key = self.branch, live and self.thinned
        if key not in self.thresholds:
            self.thresholds[key] = task.thresholds(sampled.points)
        return rotation_curve.follow(task, sampled.points, self.thresholds[key], sampled.lasts, phi)

    def along(self, paths: Sequence[BeadPath], at: Columns) -> Array:
        """(C,) the rotation of planned paths, at columns of a map."""
        wanted = {int(k): at.points.parameter[at.bead == k] for k in np.unique(at.bead)}
        return np.concatenate(
            list(rotation_along(paths, self.source.beads, self.source.places, wanted).values())
        )

    # ---- changing it

    def shift(self, by: float, beads: list[int]) -> None:
        """Move the polynomials of beads, or the one RZ, by an angle."""
        if self.kind == CONSTANT:
            self.rz = float((self.rz + by + np.pi) % (2.0 * np.pi) - np.pi)
        else:
            self.coefficients[beads, 0] += by

    def enter(self, number: int, value: float, bead: int, beads: list[int]) -> None:
        """Coefficient of a bead, rad and rad per turn to its power, by which others move along; the RZ of a constant one."""
        if self.kind == CONSTANT:
            self.rz = float(value)
        else:
            self.coefficients[beads, number] += (
                value / TURN**number - self.coefficients[bead, number]
            )

    def handles(self, bead: int) -> Array:
        """(n,) parameters at which the polynomial of a bead is taken hold of."""
        return rotation_curve.handles(
            self.source.task(self.branch), self.live.points, bead, self.degree
        )

    def pull(self, bead: int, handle: int, by: float, beads: list[int]) -> None:
        """Move one handle of a bead by an angle, and the same of further beads."""
        task, points = self.source.task(self.branch), self.live.points
        low, high = points.ends
        known: dict[
            tuple[float, float, bool], Array
        ] = {}  # beads that run over the same change alike
        for k in beads:
            key = float(low[k]), float(high[k]), bool(points.closed[k])
            if key not in known:
                number = min(handle, len(self.handles(k)) - 1)
                known[key] = rotation_curve.pull(task, points, k, self.degree, number)
            self.coefficients[k] += by * known[key]

    def set_degree(self, degree: int) -> None:
        """Polynomials of another degree: of a higher one they are as they were, of a lower one as near as they can be."""
        if degree > self.degree:
            more = np.zeros((len(self.coefficients), degree - self.degree))
            self.coefficients = np.concatenate([self.coefficients, more], axis=1)
        elif degree < self.degree:
            points = self.live.points
            self.coefficients = rotation_curve.fitted(
                points, points.polynomial(self.coefficients), degree
            )

    # ---- making it the choice

    def arguments(self) -> dict[str, str]:
        """What `api.change` is to be called with, as Python texts, so that the planner plans this curve."""
        own = OF_CELL if self.source.cell.branch == self.branch else BRANCH_WORDS[self.branch]
        found = {"own_branch": repr(own)}
        if self.kind == CONSTANT:
            return {
                "method": repr(CONSTANT),
                "rz": repr(round(float(np.degrees(self.rz)), 9)),
                "given": "()",
                **found,
            }
        return {"method": repr(METHOD), "given": repr(self.given()), **found}

    def given(self) -> tuple[str, ...]:
        """The polynomials of the beads, as the job file has them; one for all where they are alike."""
        same = np.abs(self.coefficients - self.coefficients[0]).max() <= TOLERANCE
        rows = (
            [(None, self.coefficients[0])]
            if same
            else list(zip(self.source.places, self.coefficients))
        )
        return tuple(given_text(place, tuple(float(value) for value in row)) for place, row in rows)

    # ----

    def _sampled(self, most: int) -> Sampled:
        source, kept = self.source, []
        total = int(self.starts[-1])
        for bead in source.beads:
            turns = abs(float(bead.parameter[-1] - bead.parameter[0])) / (2.0 * np.pi)
            least = max(10, int(np.ceil(12 * turns)))
            count = (
                len(bead)
                if most >= total
                else min(len(bead), max(least, len(bead) * most // total))
            )
            kept.append(np.unique(np.round(np.linspace(0, len(bead) - 1, count)).astype(np.int64)))
        row = np.concatenate([start + index for start, index in zip(self.starts, kept)])
        counts = np.array([len(index) for index in kept])
        position, tool, parameter = (
            np.concatenate([getattr(bead, name)[index] for bead, index in zip(source.beads, kept)])
            for name in ("points", "tool", "parameter")
        )
        external, slides = (
            redundancy_map.external_of(source.cell, source.beads, kept),
            source.cell.machine.chain.sliding,
        )
        points = Points(
            position,
            tool,
            parameter,
            np.concatenate([[0], np.cumsum(counts)[:-1]]).astype(np.int64),
            np.repeat(np.arange(len(kept)), counts),
            np.array([bead.closed for bead in source.beads], dtype=bool),
            source.cell.pose_frames(position, tool, external),
            external,
            slides if slides.any() else None,
        )
        wanted = {
            k: bead.parameter[index] for k, (bead, index) in enumerate(zip(source.beads, kept))
        }
        planned = list(
            rotation_along(source.planned.beads, source.beads, source.places, wanted).values()
        )
        return Sampled(
            points,
            tuple(kept),
            rotation_curve.durations(source.beads, kept),
            np.concatenate(planned),
            row.astype(np.int64),
        )

    def _variable(self, points: Points, phi: Array) -> Array:
        """The variable of the job's polynomials at rotations phi (T,), counted on along the beads."""
        if self.source.parameters.parameter == "rotation":
            return phi
        return in_turns(self.source.cell.rz_of_phi(points.tool, phi), points.starts)

    def _mean_rz(self) -> float:
        rz = self.source.cell.rz_of_phi(self.live.points.tool, self.live.planned)
        return float(np.angle(np.exp(1j * rz).mean()))
