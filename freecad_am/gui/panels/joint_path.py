# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a joint path; it plans a sample of points during input and reports the result."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pivy import coin

from ...core.issues import ERROR, InputError, Issue
from ...core.kinematics import cell as cells
from ...core.kinematics.machines import machine as machines
from ...core.parameters.cell import CellParameters
from ...core.parameters.joints import LEVEL_METHOD
from ...core.planning.joint_path import BeadPath
from ...core.planning.joint_path import JointPath as JointsOfBeads
from ...core.planning.plan import OF_ROBOTS, plan_joints
from ...core.planning.rotation.headroom import Judgement, judge_paths
from ...core.planning.sample_of_beads import Sampled, sample_toolpath
from ...core.types import Array
from ...objects import user_machines
from ...objects.checks import controllers
from ...objects.joint_path import Job, JointPath
from ...objects.stage_parts import Outcome
from ...objects.work import progress
from ..in_language import tr, translated
from ..nodes.lines import Lines, Points
from ..nodes.wall import unpickable
from ..path.colouring import CONDITION, MARGIN, RATIO, UNREACHABLE, by_machine
from ..path.legend import Legend
from ..views.preview import Aside, Draft
from ..widgets import shape_inputs
from .preview import PreviewPanel, stale_lines

# ---- Planned beads in the 3D view, coloured by the margin to the machine's limits, with a legend

_NOTHING = np.zeros((0, 3))


class JointPathNodes:
    """Draws beads as lines, initially nothing. Clicks pass through."""

    def __init__(self) -> None:
        self.lines, self.lost, self.legend = Lines(3.0), Points(7.0, UNREACHABLE), Legend()
        self.switch = coin.SoSwitch()
        for node in (unpickable(), self.lines.node, self.lost.node, self.legend.node):
            self.switch.addChild(node)
        self.switch.whichChild = coin.SO_SWITCH_ALL

    def clear(self) -> None:
        """Draw nothing."""
        self.lines.set(_NOTHING, [])
        self.lines.paint(_NOTHING)
        self.lost.set(_NOTHING)
        self.legend.hide()

    def set(self, paths: Sequence[BeadPath], values: Array, kind: str, unreachable: Array) -> None:
        """Draw beads coloured by the values (n,) of their points, of a kind that `by_machine`
        knows.

        unreachable: (n,) points that are marked with dots.
        """
        points = np.concatenate([path.bead.points for path in paths])
        colours, scale = by_machine(values, kind)
        self.lines.set(points, [len(path.bead) for path in paths])
        self.lines.paint(colours)
        self.lost.set(points[unreachable])
        self.legend.show(((), scale), 0)


MAX_POINTS = 1000  # approximate number of points planned for a preview; takes a second or two
MOST_SHOWN = 3  # maximum number of issues shown
METHOD = "joints_method"
_ENDS = {"joints_rotation_range_low", "joints_rotation_range_high"}
_OF_ROTARY_AXES = ("lock", "lock_at", "max_residual")
_OF_METHODS = {
    "constant": ("rz",),
    "layer-by-layer": ("degree", "given", "parameter", "external_axes"),
}


@dataclass(frozen=True)
class Trial:
    """A plan of some points of a toolpath.

    toolpath: its object, which may be deleted meanwhile. stale: labels of the inputs that were
    stale at the start.
    """

    toolpath: Any
    stale: tuple[str, ...]
    sample: Sampled
    planned: JointsOfBeads
    judgement: Judgement
    size: list[Issue]  # issues about the size of the later program


class JointPathPanel(PreviewPanel):
    """Creates or changes a joint path. The preview does not include rapids."""

    stage, draft = JointPath, "Joint path"
    lines = 7

    def __init__(self, obj: Any = None) -> None:
        self.aside = Aside()
        super().__init__(
            tr("Joint path") if obj is None else obj.Label,
            shape_inputs.of(JointPath, obj),
            obj,
            JointPathNodes(),
        )
        self.places[METHOD][0].widget.currentIndexChanged.connect(self._fit)
        self._cell().widget.currentIndexChanged.connect(self._fit)
        self._fit()

    def _cell(self) -> Any:
        return next(
            choice
            for choice in self.choices
            if isinstance(choice, shape_inputs.StageChoice) and choice.link.kind == "cell"
        )

    def _fit(self, *_: Any) -> None:
        """Hide fields without meaning for the cell's machine or the method."""
        with contextlib.suppress(InputError, ReferenceError):  # the preview reports it
            cell = self._cell().value()
            if cell is None:
                return
            if not machines.load(cell.Machine, user_machines.folders()).free:
                self.leave_out({_place(name) for name in OF_ROBOTS} | _ENDS)
                return
            method = self.places[METHOD][0].value
            unused = {name for key, names in _OF_METHODS.items() if key != method for name in names}
            if not cell.Proxy.parameters(cell, CellParameters).external:
                unused.add("external_axes")
            self.leave_out({_place(name) for name in (*_OF_ROTARY_AXES, *unused)})

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Trial]]:
        job = draft.stage.job(draft.obj)
        toolpath, stale = draft.obj.Toolpath, self._stale_inputs()

        def work() -> tuple[Outcome, Trial]:
            trial = Trial(toolpath, stale, *_plan_sample(job))
            return Outcome(trial.planned, trial.planned.issues), trial

        return work

    def _draw(self, outcome: Outcome, drawing: Trial) -> str:
        judgement = drawing.judgement
        kind = self._colouring(judgement)
        values = {MARGIN: judgement.margin, CONDITION: judgement.condition, RATIO: judgement.ratio}[
            kind
        ]
        self.nodes.set(drawing.planned.beads, values, kind, np.isnan(judgement.margin))
        self.aside.put(self.obj, drawing.toolpath)
        return "\n".join(
            [
                *_feasibility_lines(drawing),
                *_figures(judgement),
                *(translated(issue.message) for issue in drawing.size),
                *stale_lines(drawing.stale),
                _preview_extent(drawing.sample),
            ]
        )

    def _colouring(self, judgement: Judgement) -> str:
        """Return the colouring of the object's view if it is a known machine quantity."""
        kind = MARGIN if self.obj is None else self.obj.ViewObject.Colouring
        kinds = (MARGIN, RATIO) if judgement.worst_condition is None else (MARGIN, CONDITION, RATIO)
        return kind if kind in kinds else MARGIN

    def _draw_without(self) -> None:
        self.nodes.clear()
        self.aside.put(self.obj)

    def _show_own(self, visible: bool) -> None:
        """Show or hide the object; other objects hidden for the preview stay hidden until the panel closes."""
        hidden_objects = (
            [] if visible else [obj for obj in self.aside.objects if obj is not self.obj]
        )
        self.aside.put(*hidden_objects, None if visible else self.obj)


def _place(name: str) -> str:
    return f"joints_{name}"


def _plan_sample(job: Job) -> tuple[Sampled, JointsOfBeads, Judgement, list[Issue]]:
    """Plan as many points as can be planned quickly.

    External axes stay at the initial values of their optimisation, which takes long. Raises the
    errors of planning.
    """
    sample = sample_toolpath(job.toolpath(), MAX_POINTS)
    toolpath = sample.toolpath
    cell = cells.resolve(job.settings, toolpath.frame, toolpath.family, job.folders)
    parameters = replace(
        job.parameters,
        compare=(),
        given=sample.select_given(job.parameters.given),
        external_axes=LEVEL_METHOD,
    )
    planned = plan_joints(toolpath, cell, parameters, progress.report)
    judgement = judge_paths(planned.beads, cell.limits, cell.machine.max_speed)
    return sample, planned, judgement, controllers.likely_size_issues(job.toolpath(), cell)


def _feasibility_lines(trial: Trial) -> list[str]:
    """Return whether the path is feasible, as far as known, and the locations of issues."""
    errors = [issue for issue in trial.planned.issues if issue.level == ERROR]
    if not errors:
        return [
            tr("All deposit points are feasible.")
            if trial.sample.is_complete
            else tr("No problem found so far.")
        ]
    lines = [
        tr("Infeasible:"),
        *(_issue_text(issue, trial.sample.is_complete) for issue in errors[:MOST_SHOWN]),
    ]
    if len(errors) > MOST_SHOWN:
        lines.append(tr("and {} more").format(len(errors) - MOST_SHOWN))
    return lines


def _issue_text(issue: Issue, is_complete: bool) -> str:
    """Return an issue with its location.

    For a sample this is only the layer, because sampled beads and points have other numbers.
    """
    placed = issue if is_complete else replace(issue, bead=None, point=None)
    return (
        tr("{}: {}").format(translated(placed.where), translated(issue.message))
        if placed.where
        else translated(issue.message)
    )


def _figures(judgement: Judgement) -> list[str]:
    """Return the extreme values as text. Machines with rotary axes have no condition, unreachable
    points no values.
    """
    figures = (
        (tr("Smallest joint margin: {:.1f} %, of {} in layer {}"), judgement.worst_margin, 100.0),
        (tr("Smallest condition: {0:.3f}, in layer {2}"), judgement.worst_condition, 1.0),
        (
            tr("Largest joint speed: {:.0f} % of the maximum of {}, in layer {}"),
            judgement.worst_ratio,
            100.0,
        ),
    )
    return [
        text.format(factor * worst.value, worst.label, worst.layer)
        for text, worst, factor in figures
        if worst is not None
    ]


def _preview_extent(sample: Sampled) -> str:
    """Return how many points the preview covers and that OK plans the rest."""
    if sample.is_complete:
        return tr("Preview of all points; OK also checks the rapids.")
    if sample.beads == 1:
        return tr(
            "Preview of one point in {}; OK checks the points between and the rapids too."
        ).format(sample.points)
    if sample.points == 1:
        return tr(
            "Preview of one bead in {}; OK checks the beads between and the rapids too."
        ).format(sample.beads)
    text = tr(
        "Preview of one point in {} of one bead in {}; OK checks the points and beads between "
        "and the rapids too."
    )
    return text.format(sample.points, sample.beads)
