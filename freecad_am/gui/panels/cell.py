# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a cell: platform, nozzle and machine are seen while it is open, and it follows the machine that is chosen."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import numpy as np
from PySide import QtCore, QtGui

from ...core.issues import AmError, InputError
from ...core.kinematics.arrangement import of_setup
from ...core.kinematics.machines import machine as machines
from ...core.kinematics.machines.machine import Machine
from ...core.kinematics.proposed_cell import cell_of
from ...core.parameters.cell import CellParameters
from ...core.parameters.external import NONE
from ...objects import user_machines
from ...objects.cell import Cell
from ...objects.stage import stage_of
from ...objects.stage_parts import Outcome
from ...objects.work.progress import Cancelled
from ..background.busy import carry_out
from ..background.later import Background, Later
from ..background.worker import Worker
from ..nodes.cell import CellNodes, Scenery, at_the_end, with_machine
from ..picking.selection import meant
from ..texts.translation import tr, translated
from ..views.cell import toolpath_of
from ..views.preview import Aside, Draft
from ..widgets import suggestions
from . import at_rest
from .preview import PreviewPanel
from .whole_cell import whole_cell

MACHINE, SETUP, POINT, BRANCH = "cell_machine", "cell_setup", "cell_deposition_point", "cell_branch"
ARM, OBSTACLES, EXTERNAL = "cell_arm_clearance", "cell_obstacles", "cell_external"
TOOL, TORCH, PLATFORM = "cell_nozzle_tool", "cell_nozzle_shape", "cell_platform"
_OF_ROBOTS = (SETUP, POINT, BRANCH, TOOL, TORCH, ARM, OBSTACLES, EXTERNAL)
_OF_TOOLS = (TOOL, EXTERNAL)  # that a robot carries


class CellPanel(PreviewPanel):
    """Follows machine and set-up: a machine with sliding and turning axes carries the part on its table, and has no
    branches; a robot gets a deposition point, or a place of the platform, and a branch that suit, unless others were
    entered."""

    stage, draft = Cell, "Cell"
    lines = 4

    def __init__(self, obj: Any = None) -> None:
        # what is proposed, by machine and set-up as the fields hold them, and which of these were followed last
        self.of_machine: dict[tuple[str, str], CellParameters] = {}
        self.before: tuple[str, str] | None = None
        self.unknown = ""  # what was wrong with its name
        self.put: dict[str, Any] = {}  # what the panel itself has entered
        self.noted: dict[str, Any] = {}  # what fields held when something was told of a proposal
        self.aside = Aside()
        super().__init__(tr("Cell") if obj is None else obj.Label, [], obj, CellNodes(ghost=True))
        self._add_machine_box()
        self.enabled = {place: self.places[place][0].widget.isEnabled() for place in _OF_ROBOTS}
        if obj is None:
            self.put.update((place, self._holds(place)) for place in (POINT, BRANCH))
        self.proposing = Background(self.form)
        self.later = Later(self.form, self._follow)
        self._widget(MACHINE).editTextChanged.connect(self.later.ask)
        self._widget(SETUP).currentIndexChanged.connect(self._follow)
        self._widget(EXTERNAL).textChanged.connect(self.later.ask)
        self._follow()

    def _add_machine_box(self) -> None:
        self.machine_box = QtGui.QCheckBox(tr("Show the machine"))
        self.machine_box.setObjectName("PreviewMachine")
        help = tr("Shows the machine at rest while the panel is open, the nozzle upright on the highest point of the path")
        self.machine_box.setToolTip(help)
        self.machine_box.setWhatsThis(help)
        self.machine_box.setChecked(True)
        self.column.insertWidget(self.column.indexOf(self.messages) + 1, self.machine_box, 0, QtCore.Qt.AlignLeft)

    def _widget(self, place: str) -> Any:
        return self.places[place][0].widget

    # ---- what the machine asks for

    def _follow(self) -> None:
        """Fit the fields to the machine; those of an unknown one stay as they are."""
        with contextlib.suppress(InputError):  # which the preview tells
            found = whole_cell(self._holds(MACHINE), self._holds(EXTERNAL))
            if found is not None:
                self._widget(MACHINE).setEditText(found[0])
                self._widget(EXTERNAL).setText(found[1])
        name = self.places[MACHINE][0].value
        try:
            machine = machines.load(name, user_machines.folders())
        except InputError as error:
            self._tell_of_machine(translated(error.message))
            return
        if self.unknown and self.unknown == self.notes[MACHINE].text():
            self.tell(MACHINE, "")
        self._set_setup([one.setup for one in machine.arrangements])
        self._fit(machine)
        self._offer_limits(list(machine.limit_sets))
        self._ask_proposal(name, machine)

    def _fit(self, machine: Machine) -> None:
        """Leave out what has no meaning for the machine, or with what the robot carries: beside it a part stands on its
        deposition point, or on the platform of a positioner."""
        if not machine.free:
            without: tuple[str, ...] = _OF_ROBOTS
        elif of_setup(self._widget(SETUP).currentData()).carries_part:
            without = _OF_TOOLS
        else:
            without = (PLATFORM,) if self._holds(EXTERNAL) in (NONE, "") else ()
        self.leave_out(without, also_entered=True)

    def _tell_of_machine(self, text: str) -> None:
        """What is wrong with the machine, until another one is followed."""
        self.unknown = text
        self.tell(MACHINE, text)

    def _set_setup(self, possible: list[str]) -> None:
        setup = self._widget(SETUP)
        if self.enabled[SETUP] and setup.currentData() not in possible:
            setup.setCurrentIndex(setup.findData(possible[0]))

    def _offer_limits(self, names: list[str]) -> None:
        """Let those limits be chosen that the machine has; what is entered stays."""
        limits = self._widget("cell_limits")
        text = limits.currentText()
        limits.clear()
        limits.addItems(names)
        limits.setEditText(text)

    def _ask_proposal(self, name: str, machine: Machine) -> None:
        """Find out, beside the window, what suits the machine; nothing for one that was not chosen here."""
        setup = self._widget(SETUP).currentData()
        before, self.before = self.before, (name, setup)
        if before == self.before or (before is None and self.obj is not None):
            return
        self.proposing.cancel()
        for place in self.noted:
            self.tell(place, "")
        self.noted.clear()
        if not machine.free or not (of_setup(setup).free and of_setup(setup).planned):
            return
        folders, known, wanted, tool = user_machines.folders(), dict(self.of_machine), self.before, self._tool()

        def work() -> dict[tuple[str, str], CellParameters]:
            for one in filter(None, (before, wanted)):
                with contextlib.suppress(InputError):  # the one before is gone
                    known[one] = known.get(one) or cell_of(one[0], folders, one[1], tool)
            return known

        self.proposing.start(work, lambda worker: self._propose(worker, before, wanted, machine.title))

    def _tool(self) -> Any:
        """The pose of the tip on the flange as it is entered, None where that cannot be read as numbers."""
        row, held = self.places[TOOL][0].row, self._holds(TOOL)
        with contextlib.suppress(AmError):
            return None if held is None else row.inner(held, row.label)
        return None

    def _propose(
        self, worker: Worker, before: tuple[str, str] | None, wanted: tuple[str, str], title: str
    ) -> None:
        """Enter what suits the machine where nobody has entered anything else than what suited the one before."""
        try:
            self.of_machine = worker.result()
        except AmError as error:
            self._tell_of_machine(translated(error.message))
            return
        except Exception as error:  # of nobody's making
            self._tell_of_machine(f"{type(error).__name__}: {error}")
            return
        proposal = self.of_machine.get(wanted)
        default = CellParameters()
        usual = (None if before is None else self.of_machine.get(before)) or default
        if proposal is None:  # no cell can have it, which the preview tells
            return
        for place, value, *was in (
            (POINT, proposal.deposition_point, usual.deposition_point, default.deposition_point),
            (BRANCH, proposal.branch, usual.branch, default.branch),
        ):
            field = self.places[place][0]
            shown, holds = field.row.outer(value), self._holds(place)
            if _alike(holds, shown):
                continue
            if self.enabled[place] and any(_alike(holds, one) for one in (self.put.get(place), *map(field.row.outer, was))):
                field.show(shown)
                self.put[place] = shown
                text = tr("Proposed for {}; enter what yours really has.").format(title)
            else:
                text = tr("Left as it was entered; for {} it would be {}.").format(title, _value_text(shown))
            self.noted[place] = self._holds(place)
            self.tell(place, text, wrong=False)

    def _holds(self, place: str) -> Any:
        """What a field holds, None where that cannot be read."""
        with contextlib.suppress(InputError):
            return self.places[place][0].value
        return None

    def judge_entries(self) -> None:
        """What was told of a proposal goes once something else is entered."""
        super().judge_entries()
        for place, held in list(self.noted.items()):
            if not _alike(self._holds(place), held):
                del self.noted[place]
                self.tell(place, "")

    def _carry_out(self) -> bool:
        """Make or change the cell, after what was typed last is followed. What that entered nobody has seen: it is told."""
        before = dict(self.put)
        self.later.at_once()
        worker = self.proposing.worker
        if worker is not None:
            try:
                carry_out(worker.ended.wait, self.form.windowTitle())
            except Cancelled:
                self.say(tr("Cancelled: the document is as it was."))
                return False
            self.proposing.at_once()
        unseen = [self._line(place) for place, value in self.put.items() if value != before.get(place)]
        done = super()._carry_out()
        for line in unseen if done else []:
            App.Console.PrintWarning(line)
        return done

    def _line(self, place: str) -> str:
        """A line of the report view about what the panel itself has entered at a place."""
        label, value = self.places[place][0].label, _value_text(self.put[place])
        text = tr("{}: {} is now {}. {}").format(self.form.windowTitle(), label, value, self.notes[place].text())
        return f"{text}\n"

    def close(self, *_: Any) -> None:
        """Take away the preview; once or more often."""
        if self.is_open:
            self.proposing.cancel()
        super().close()

    # ---- preview

    def _entered(self) -> Any:
        toolpath = self._toolpath()
        return *super()._entered(), self.machine_box.isChecked(), None if toolpath is None else toolpath.Key

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Scenery]]:
        draft.check()
        work, folders = draft.prepare(), user_machines.folders()
        drawn = with_machine if self.machine_box.isChecked() else at_the_end
        toolpath = self._toolpath()
        read = None if toolpath is None else toolpath.Proxy.reader(toolpath)

        def both() -> tuple[Outcome, Scenery]:
            made = work()
            return made, drawn(made.value, None if read is None else read(), folders)

        return both

    def _toolpath(self) -> Any:
        """The toolpath that is for the cell; for a new one the selected toolpath, or the only one there is."""
        if self.obj is not None:
            return toolpath_of(self.obj)
        known = [obj for obj in self.document.Objects if getattr(stage_of(obj), "kind", "") == "toolpath" and obj.Key]
        if len(known) > 1:
            known = [obj for obj in meant(self.document.Name) if obj in known]
        return known[0] if len(known) == 1 else None

    def _draw(self, made: Outcome, drawing: Scenery) -> str:
        self.nodes.set(drawing)
        without = suggestions.no_post(self.places[MACHINE][0].value)
        return "\n".join(filter(None, ("" if drawing.rest is None else at_rest.stands(drawing.rest), without)))

    def _placed(self, error: AmError) -> tuple[str, str]:
        """What is wrong with the file of a machine is told under its name."""
        return (MACHINE, translated(error.message)) if error.code == "BAD_MACHINE" else super()._placed(error)

    def _draw_without(self) -> None:
        self.nodes.clear()

    def _show_own(self, visible: bool) -> None:
        self.aside.put(None if visible else self.obj)


def _alike(one: Any, other: Any) -> bool:
    """Whether two poses, or two texts, are the same to whoever reads them."""
    if isinstance(one, tuple) and isinstance(other, tuple):
        if any(isinstance(number, str) for number in (*one, *other)):  # an expression
            return one == other
        return bool(np.allclose(one, other, rtol=0.0, atol=1e-6))
    return isinstance(one, str) and isinstance(other, str) and one.replace(",", " ").split() == other.split()


def _value_text(value: Any) -> str:
    return value if isinstance(value, str) else " ".join(f"{number:g}" for number in value)
