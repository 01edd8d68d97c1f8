# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a cell: platform, nozzle and machine are seen while it is open, and it follows the machine that is chosen."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

from PySide import QtCore, QtGui

from ...core.issues import AmError, InputError
from ...core.kinematics.arrangement import arrangement_of
from ...core.kinematics.machines import machine as machines
from ...core.kinematics.machines.machine import Machine
from ...core.parameters.records import NONE
from ...objects import user_machines
from ...objects.cell import Cell
from ...objects.stage import stage_of
from ...objects.stage_parts import Outcome
from ..background.worker import Later
from ..cell.proposing import (
    EXTERNAL,
    MACHINE,
    OF_ROBOTS,
    PLATFORM,
    SETUP,
    TOOL,
    ProposingPanel,
    whole_cell,
)
from ..nodes.cell import CellNodes, Scenery, at_the_end, machine_scenery
from ..picking.shape_inputs import job_selection
from ..texts.in_language import tr, translated
from ..views.cell import toolpath_of
from ..views.preview import Aside, Draft
from ..widgets import suggestions
from . import at_rest

_OF_TOOLS = (TOOL, EXTERNAL)  # that a robot carries


class CellPanel(ProposingPanel):
    """Follows machine and set-up: a machine with sliding and turning axes carries the part on its table, and has no
    branches; a robot gets a deposition point, or a place of the platform, and a branch that suit, unless others were
    entered."""

    stage, draft = Cell, "Cell"
    lines = 4

    def __init__(self, obj: Any = None) -> None:
        self.unknown = ""  # the message about its name
        self.aside = Aside()
        super().__init__(tr("Cell") if obj is None else obj.Label, obj, CellNodes(ghost=True))
        self._add_machine_box()
        self.later = Later(self.form, self._follow)
        self._widget(MACHINE).editTextChanged.connect(self.later.ask)
        self._widget(SETUP).currentIndexChanged.connect(self._follow)
        self._widget(EXTERNAL).textChanged.connect(self.later.ask)
        self._follow()

    def _add_machine_box(self) -> None:
        self.machine_box = QtGui.QCheckBox(tr("Show the machine"))
        self.machine_box.setObjectName("PreviewMachine")
        help = tr(
            "Shows the machine at rest while the panel is open, with the nozzle upright on the "
            "highest point of the path"
        )
        self.machine_box.setToolTip(help)
        self.machine_box.setWhatsThis(help)
        self.machine_box.setChecked(True)
        self.column.insertWidget(
            self.column.indexOf(self.messages) + 1, self.machine_box, 0, QtCore.Qt.AlignLeft
        )

    # ---- what the machine asks for

    def _follow(self) -> None:
        """Fit the fields to the machine; leave them unchanged for an unknown one."""
        with contextlib.suppress(InputError):  # the preview reports it
            names = whole_cell(self._holds(MACHINE), self._holds(EXTERNAL))
            if names is not None:
                self._widget(MACHINE).setEditText(names[0])
                self._widget(EXTERNAL).setText(names[1])
        name = self.places[MACHINE][0].value
        try:
            machine = machines.load(name, user_machines.folders())
        except InputError as error:
            self._show_machine_problem(translated(error.message))
            return
        if self.unknown and self.unknown == self.notes[MACHINE].text():
            self.show_note(MACHINE, "")
        self._set_setup([arrangement.setup for arrangement in machine.arrangements])
        self._fit(machine)
        self._offer_limits(list(machine.limit_sets))
        self._ask_proposal(name, machine)

    def _fit(self, machine: Machine) -> None:
        """Hide fields without meaning for the machine or its setup: a part the robot does not carry is at the
        deposition point or on a positioner's platform."""
        if not machine.free:
            without: tuple[str, ...] = OF_ROBOTS
        elif arrangement_of(self._widget(SETUP).currentData()).carries_part:
            without = _OF_TOOLS
        else:
            without = (PLATFORM,) if self._holds(EXTERNAL) in (NONE, "") else ()
        self.leave_out(without, also_entered=True)

    def _show_machine_problem(self, text: str) -> None:
        """Show a problem of the machine until the panel follows another one."""
        self.unknown = text
        self.show_note(MACHINE, text)

    def _set_setup(self, possible: list[str]) -> None:
        setup = self._widget(SETUP)
        if self.enabled[SETUP] and setup.currentData() not in possible:
            setup.setCurrentIndex(setup.findData(possible[0]))

    def _offer_limits(self, names: list[str]) -> None:
        """Offer the limit sets of the machine; keep the entry."""
        limits = self._widget("cell_limits")
        text = limits.currentText()
        limits.clear()
        limits.addItems(names)
        limits.setEditText(text)

    # ---- preview

    def _entered(self) -> Any:
        toolpath = self._toolpath()
        return (
            *super()._entered(),
            self.machine_box.isChecked(),
            None if toolpath is None else toolpath.Key,
        )

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Scenery]]:
        draft.check()
        work, folders = draft.prepare(), user_machines.folders()
        drawn = machine_scenery if self.machine_box.isChecked() else at_the_end
        toolpath = self._toolpath()
        reader = None if toolpath is None else toolpath.Proxy.reader(toolpath)

        def compute() -> tuple[Outcome, Scenery]:
            outcome = work()
            return outcome, drawn(outcome.value, None if reader is None else reader(), folders)

        return compute

    def _toolpath(self) -> Any:
        """The toolpath that is for the cell; for a new one the selected toolpath, or the only one there is."""
        if self.obj is not None:
            return toolpath_of(self.obj)
        candidates = [
            obj
            for obj in self.document.Objects
            if getattr(stage_of(obj), "kind", "") == "toolpath" and obj.Key
        ]
        if len(candidates) > 1:
            candidates = [obj for obj in job_selection(self.document.Name) if obj in candidates]
        return candidates[0] if len(candidates) == 1 else None

    def _draw(self, outcome: Outcome, drawing: Scenery) -> str:
        self.nodes.set(drawing)
        without = suggestions.no_post(
            self.places[MACHINE][0].value, str(self._widget(SETUP).currentData())
        )
        return "\n".join(
            filter(None, ("" if drawing.rest is None else at_rest.stands(drawing.rest), without))
        )

    def _locate(self, error: AmError) -> tuple[str, str]:
        """Show a problem of a machine file under the machine's name."""
        return (
            (MACHINE, translated(error.message))
            if error.code == "BAD_MACHINE"
            else super()._locate(error)
        )

    def _draw_without(self) -> None:
        self.nodes.clear()

    def _show_own(self, visible: bool) -> None:
        self.aside.put(None if visible else self.obj)
