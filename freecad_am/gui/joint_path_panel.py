# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a joint path: some points of it are planned as it is entered, and tell what will come of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.issues import ERROR, Issue
from ..core.kinematics import cell as cells
from ..core.planning.joint_path import JointPath as JointsOfBeads
from ..core.planning.judgement import Judgement, judged
from ..core.planning.plan import plan_joints
from ..core.planning.sampled import Sampled, sampled
from ..objects import progress
from ..objects.joint_path import Job, JointPath
from ..objects.stage import Outcome
from ..objects.staleness import STALE
from . import inputs
from .joint_path_nodes import JointPathNodes
from .path.colouring import CONDITION, MARGIN, RATIO
from .preview import Aside, Draft
from .preview_panel import PreviewPanel
from .texts import tr, translated

MOST = 1000  # points that are planned for a preview, about: a second or two
MOST_TOLD = 3  # findings


@dataclass(frozen=True)
class Trial:
    """A plan of some points of a toolpath."""

    sample: Sampled
    planned: JointsOfBeads
    judgement: Judgement


class JointPathPanel(PreviewPanel):
    """Makes a joint path, or changes one. Its preview knows no rapid moves."""

    stage, draft = JointPath, "Joint path"

    def __init__(self, obj: Any = None) -> None:
        self.aside = Aside()
        super().__init__(
            tr("Joint path") if obj is None else obj.Label, inputs.of(JointPath, obj), obj, JointPathNodes()
        )

    def _lacks(self) -> str:
        return next((choice.missing for choice in self.choices if choice.missing), "")

    def _links(self) -> dict[str, Any]:
        return {choice.link.name: choice.value() for choice in self.choices}

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Trial]]:
        job = draft.stage.job(draft.obj)

        def work() -> tuple[Outcome, Trial]:
            trial = _tried(job)
            return Outcome(trial.planned, trial.planned.issues), trial

        return work

    def _draw(self, made: Outcome, drawing: Trial) -> str:
        judgement = drawing.judgement
        kind = self._colouring(judgement)
        values = {MARGIN: judgement.margin, CONDITION: judgement.condition, RATIO: judgement.ratio}[kind]
        self.nodes.set(drawing.planned.beads, values, kind, np.isnan(judgement.margin))
        self.aside.put(self.obj, self._links()["Toolpath"])
        stale = [linked.Label for linked in self._links().values() if linked.Status == STALE]
        return "\n".join([*_found(drawing), *_figures(judgement), *(
            tr("{} is out of date; this is of what it was.").format(label) for label in stale
        ), _looked_at(drawing.sample)])

    def _colouring(self, judgement: Judgement) -> str:
        """What the object's own view tells by its colours, if that is of the machine and known."""
        kind = MARGIN if self.obj is None else self.obj.ViewObject.Colouring
        known = (MARGIN, RATIO) if judgement.worst_condition is None else (MARGIN, CONDITION, RATIO)
        return kind if kind in known else MARGIN

    def _draw_without(self) -> None:
        self.nodes.clear()
        self.aside.put(self.obj)

    def _show_own(self, visible: bool) -> None:
        self.aside.put(None if visible else self.obj)


def _tried(job: Job) -> Trial:
    """The plan of as many points as are soon planned. Raises what planning raises."""
    sample = sampled(job.toolpath(), MOST)
    toolpath = sample.toolpath
    cell = cells.resolve(job.settings, toolpath.frame, toolpath.family, job.folders)
    planned = plan_joints(toolpath, cell, replace(job.parameters, compare=()), progress.report)
    return Trial(sample, planned, judged(planned.beads, cell.limits, cell.machine.max_speed))


def _found(trial: Trial) -> list[str]:
    """Whether it can be carried out, and where not."""
    errors = [issue for issue in trial.planned.issues if issue.level == ERROR]
    if not errors:
        return [tr("Can be carried out.")]
    told = [tr("Cannot be carried out:"), *(_told(issue, trial.sample.whole) for issue in errors[:MOST_TOLD])]
    if len(errors) > MOST_TOLD:
        told.append(tr("and {} more").format(len(errors) - MOST_TOLD))
    return told


def _told(issue: Issue, whole: bool) -> str:
    """A finding with its place: of some points alone it is the layer, whose beads and points have other numbers."""
    placed = issue if whole else replace(issue, bead=None, point=None)
    return tr("{}: {}").format(translated(placed.where), translated(issue.message)) if placed.where else translated(
        issue.message)


def _figures(judgement: Judgement) -> list[str]:
    """What is least and most; machines with rotary axes have no condition, and what is out of reach nothing."""
    found = (
        (tr("Least joint margin: {:.1f} %, of {} in layer {}"), judgement.worst_margin, 100.0),
        (tr("Least condition: {0:.3f}, in layer {2}"), judgement.worst_condition, 1.0),
        (tr("Largest joint speed: {:.0f} % of what {} can do, in layer {}"), judgement.worst_ratio, 100.0),
    )
    return [
        text.format(factor * worst.value, worst.label, worst.layer) for text, worst, factor in found if worst is not None
    ]


def _looked_at(sample: Sampled) -> str:
    """Of what this is the preview."""
    if sample.whole:
        return tr("Preview of all points, without rapid moves.")
    if sample.beads == 1:
        return tr("Preview of one point in {}, without rapid moves; OK plans all.").format(sample.points)
    if sample.points == 1:
        return tr("Preview of one bead in {}, without rapid moves; OK plans all.").format(sample.beads)
    told = tr("Preview of one point in {} of one bead in {}, without rapid moves; OK plans all.")
    return told.format(sample.points, sample.beads)
