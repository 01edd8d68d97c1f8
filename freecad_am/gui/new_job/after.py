# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the window does once a job is made: its result alone is seen whole, and the next step is told."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from ... import api
from ...core.issues import NOTE, WARNING
from ...core.parameters.external import externals
from ...core.parameters.filled import GEODESIC
from ...objects.checks.collisions import ARM_NEAR, LOW_MARGIN
from ...objects.results.findings import issues_of
from ...objects.staleness import FAILED, INFEASIBLE, STALE, UP_TO_DATE
from ..texts.translation import sentence, tr

LOOK_AT = (ARM_NEAR, LOW_MARGIN)  # notes that are told with the result
SHOWN_MS = 15000  # ms that the next step is told on the status bar


def tell_next(stages: list[Any], proposed: str = "") -> None:
    """Show the whole result, and tell what came of it and what can be done next. proposed: layers, where some were."""
    wrong = next((obj for obj in stages if obj.Status != UP_TO_DATE), None)
    if wrong is not None:
        # why is in the report view already
        state = {
            FAILED: tr("{} failed."),
            INFEASIBLE: tr("{} is infeasible."),
            STALE: tr("{} is stale."),
        }[wrong.Status]
        text = tr("{} Double-click a stage in the tree to change it.").format(
            state.format(wrong.Label)
        )
    elif stages[-1].Proxy.kind == "program":
        text = tr(
            "The job is ready. Simulate… plays it; double-click Program to read it, Cell to "
            "configure your machine."
        )
    else:
        text = tr(
            "The joint path is ready, but no post writes a program for this machine and setup "
            "yet. Simulate… plays it, Export Path… writes its points as a table."
        )
    warned = [
        obj.Label for obj in stages if any(issue.level == WARNING for issue in issues_of(obj))
    ]
    if wrong is None and warned:
        text = tr("{} Read the warnings first: double-click {}.").format(text, ", ".join(warned))
    near = [
        sentence(issue.message)
        for obj in stages
        for issue in issues_of(obj)
        if issue.code in LOOK_AT and issue.level == NOTE
    ]
    if wrong is None and near:
        text = " ".join([text, *(f"{note}." for note in near)])
    if proposed == GEODESIC and any(
        obj.Proxy.kind == "feature" and obj.Layers != GEODESIC for obj in stages
    ):
        text = tr("In planar layers, as curved ones were infeasible. {}").format(text)
    Gui.getMainWindow().statusBar().showMessage(text, SHOWN_MS)
    App.Console.PrintMessage(text + "\n")
    _show_whole()


def show_alone(stages: list[Any]) -> None:
    """Hide what earlier jobs of the document have drawn: their cells and paths would lie across those of this one."""
    for obj in api.stages_of(stages[0].Document) if stages else []:
        if obj not in stages and obj.ViewObject.Visibility:
            obj.ViewObject.Visibility = False


def show_machine(stages: list[Any], asked: bool) -> None:
    """Show the robot at the job where its set-up was asked for, and tell which positioner was put there."""
    cell = next((obj for obj in stages if obj.Proxy.kind == "cell"), None)
    if cell is None or not asked:
        return
    cell.ViewObject.ShowMachine = True
    if externals(cell.External):
        App.Console.PrintWarning(
            tr("{}: proposed for this job: {}; enter the values of your cell.").format(
                cell.Label, cell.External
            )
            + "\n"
        )


def _show_whole() -> None:
    """Fit the view; one that is still as FreeCAD opens it, straight from above, is turned so that heights are seen."""
    view = Gui.activeDocument().activeView()
    if hasattr(view, "getCameraOrientation") and view.getCameraOrientation().isIdentity():
        view.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
