# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make the report of a job: the content of report.json and the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any

from ..core.families.registry import family_of
from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from ..core.process.deposit import balance as deposit_balance
from ..core.process.deposit import spacing
from ..core.simulation import timeline
from ..core.simulation.achievable_feed import spread_to_deposit_rows
from ..core.toolpath import Toolpath
from ..core.types import Array
from ..objects.families.registry import planner_for
from . import figures
from .figures import Job, OfFeature, Results

Timed = Callable[[str], AbstractContextManager[None]]
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Made:
    """A report and the data of its page. content: content of report.json."""

    content: dict[str, Any]
    job: Job
    toolpath: Toolpath
    motion: Motion
    results: Results
    features: Sequence[OfFeature]
    cell: Cell | None

    def page(self) -> str:
        """Return report.html."""
        from freecad_am.plots.source import (
            Source,  # slow to import and not needed without a page
        )

        from . import page

        planned, process = self.results.planned, self.job.process
        limits = [getattr(feature.strategy, "max_void", 1.0) for feature in self.job.features]
        source = Source(self.toolpath, self.motion, process, max_void=min(limits))
        if planned is not None:
            judged = planned.joint_path.conditions(self.motion)
            condition, threshold = (
                spread_to_deposit_rows(self.motion.deposit, column) for column in judged
            )
            source = replace(source, cell=self.cell, condition=condition, threshold=threshold)
        platform = self.job.cell.platform_diameter if self.job.cell else None
        solids = None
        if len(self.job.features) == 1:
            shape = self.job.features[0].shape()
            planner = planner_for(self.job.features[0].strategy)
            solids = None if planner.bodies_to_cover(shape) is None else shape
        return page.render(page.Content(self.content, source, self.features, platform, solids))


def as_run(results: Results, cell: Cell | None) -> tuple[Toolpath, Motion]:
    """Return the executed toolpath and its motion; without a joint path, the bead motion."""
    if results.planned is None:
        return results.toolpath, timeline.deposit_motion(
            results.toolpath, 0 if cell is None else len(cell.machine.columns)
        )
    return results.planned.joint_path.toolpath(results.toolpath), results.planned.motion


def make_report(job: Job, results: Results, cell: Cell | None, timed: Timed, tell: Tell) -> Made:
    """Make the report of a job; `timing_s` stays empty.

    timed: context manager that measures a named step. tell: reports progress.
    """
    toolpath, motion = as_run(results, cell)
    with timed("report"):
        content = figures.build(job.name, toolpath, motion, job.process, results.issues)
        if results.planned is not None and cell is not None:
            figures.add_joints(
                content, results.planned.joint_path, cell, job.joints, results.seconds
            )
        balances = [
            deposit_balance.toolpath_balance(feature.shape(), path, feature.process.bead_width)
            for feature, (path, _) in zip(job.features, toolpath.parts, strict=True)
        ]
        content["deposit"] = deposit_balance.as_dict(deposit_balance.sum_balances(balances))
    with timed("preflight"):  # last step, because the second solver may still be running
        content["preflight"] = [promise.as_dict() for promise in results.preflight()]
    distances = results.distances()
    content["spacing_mm"] = figures.summarize(distances)
    with timed("spacing_comparison"):
        walls = compared_walls(job, toolpath, distances)
        if not toolpath.features:
            content["spacing_comparison"] = add_motion(job, walls[0], results, cell, tell)
    if toolpath.features:
        content["features"] = figures.features(
            job.features, toolpath, motion, balances, [list(wall.rows) for wall in walls]
        )
    content["programs"] = sorted(results.programs)
    return Made(content, job, toolpath, motion, results, walls, cell)


def compared_walls(job: Job, toolpath: Toolpath, distances: Sequence[Array]) -> list[OfFeature]:
    """Return the page data of each feature; walls include the spacing comparison.

    distances: distances between layers, used for a single feature, mm.
    """
    walls = []
    for feature, (path, _) in zip(job.features, toolpath.parts, strict=True):
        gaps = spacing.between_layers(path) if toolpath.features else distances
        wall = OfFeature(
            feature.name if toolpath.features else "",
            path,
            gaps,
            getattr(feature.strategy, "band", None),
        )
        if family_of(feature.strategy).compares_spacings:
            from . import spacing_comparison  # slow to import and only needed for walls

            compared = spacing_comparison.compare(feature.shape(), feature.strategy)
            wall = wall._replace(
                compared=compared,
                rows=spacing_comparison.rows(compared, feature.strategy, path, gaps),
            )
        walls.append(wall)
    return walls


def add_motion(
    job: Job, wall: OfFeature, results: Results, cell: Cell | None, tell: Tell
) -> list[dict[str, Any]]:
    """Return the spacing comparison rows of a single wall, with robot motion on request."""
    rows: list[dict[str, Any]] = list(wall.rows)
    if rows and results.planned is not None and cell is not None:
        from . import spacing_comparison

        planned = results.planned
        rows[0]["motion"] = spacing_comparison.motion_of(
            planned.joint_path, planned.motion, cell, job.joints
        )
        motions = spacing_comparison.motions(job, tell)
        for row in rows[1:]:
            motion = motions.get(row["method"])
            row["reason" if isinstance(motion, str) else "motion"] = motion or row["motion"]
    return rows
