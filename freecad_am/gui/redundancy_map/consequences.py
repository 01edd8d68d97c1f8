# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the curve that is worked on means: told at once of some of its points, and of all of them a little later."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...core.planning.redundancy import curve as rotation_curve
from ...core.planning.redundancy.curve import Followed, Sums
from ..background.later import Background
from ..background.worker import Worker
from ..texts.translation import tr
from .draft import Draft
from .drawn.curves import COLOURS, OWN, PLANNED
from .form import Form
from .readout import certified, joint_ranges


class Consequences:
    """`status` says how the joint path itself stands, and whether that is wrong. followed: what the curve asks of the
    machine at the points that are looked at while it is dragged."""

    followed: Followed

    def __init__(self, owner: Any, form: Form, status: Callable[[], tuple[str, bool]]) -> None:
        self.form, self.status = form, status
        self.background = Background(owner)

    def take(self, draft: Draft) -> None:
        """Look at another draft, which is as it was planned."""
        self.draft = draft
        self.planned = rotation_curve.sums(draft.follow(draft.live.planned))
        self.planned_exact: Sums | None = None

    def of_plan(self) -> Sums:
        """The figures of what was planned, of all points where they are known."""
        return self.planned_exact or self.planned

    def cancel(self) -> None:
        """End what is being computed."""
        self.background.cancel()

    def now(self) -> None:
        """Tell at once what the curve as it is now means."""
        draft = self.draft
        self.followed = draft.followed()
        self._tell(rotation_curve.sums(self.followed), self.planned, draft.thinned)
        self.form.show_joints(joint_ranges(self.followed.joints, draft.source.cell))

    def exactly(self) -> None:
        """The same of all points, where only some have been looked at."""
        draft, known = self.draft, self.planned_exact
        if not draft.thinned:
            return
        own = draft.copied()

        def work() -> tuple[Sums, Sums]:
            full = own.full
            mine = rotation_curve.sums(own.follow(own.phi(full.points, full.points.bead), False))
            if known is not None:
                return mine, known
            of_plan = own.copied()
            of_plan.branch = own.source.branch
            return mine, rotation_curve.sums(of_plan.follow(full.planned, False))

        def show(worker: Worker) -> None:
            found = worker.result()
            if draft is self.draft:
                draft.learn(own)
                self.planned_exact = found[1]
                self._tell(*found, False)

        self.background.start(work, show)

    def _tell(self, sums: Sums, planned: Sums, about: bool) -> None:
        self.form.figures.set(OWN, tr("This curve"), COLOURS[OWN], sums, planned, about)
        self.form.figures.set(PLANNED, tr("As planned"), COLOURS[PLANNED], planned, None, about)
        edited = self.draft.edited
        self.form.buttons["use"].setEnabled(edited)
        if sums.lost:
            text, wrong = (
                tr("{} of the tested points fail: they are red").format(sums.lost),
                True,
            )
        elif edited and sums.ratio > 1.0:
            asked = tr(
                "A joint would need {:.0f} % of its speed: the planner will slow it down, or "
                "reject the curve"
            )
            text, wrong = asked.format(100.0 * sums.ratio), True
        else:
            text, wrong = self.status() if not edited else (tr("All points are feasible"), False)
        certificate = certified(self.draft.source.planned.optimality)
        self.form.tell("\n".join(filter(None, (text, certificate if not edited else ""))), wrong)
