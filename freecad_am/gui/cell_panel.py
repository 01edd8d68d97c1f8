# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a cell: what has no meaning for the machine that is chosen is greyed."""

from __future__ import annotations

from typing import Any

from ..core.issues import InputError
from ..core.kinematics import machine as machines
from ..core.kinematics.cell import PART_ON_ROBOT, ROTARY_TABLE
from ..objects import user_machines
from ..objects.cell import Cell
from .later import Later
from .stage_panel import StagePanel
from .texts import tr, translated

_OF_ROBOTS = ("cell_setup", "cell_deposition_point", "cell_branch", "cell_nozzle_tool")


class CellPanel(StagePanel):
    """Follows the machine: one with sliding and turning axes carries the part on its table, and has no branches."""

    stage = Cell

    def __init__(self, obj: Any = None) -> None:
        super().__init__(Cell, tr("Cell") if obj is None else obj.Label, [], obj)
        self.tips = {place: self.places[place][0].widget.toolTip() for place in _OF_ROBOTS}
        self.enabled = {place: self.places[place][0].widget.isEnabled() for place in _OF_ROBOTS}
        self.later = Later(self.form, self._follow)
        self._widget("cell_machine").editTextChanged.connect(self.later.ask)
        self._follow()

    def _widget(self, place: str) -> Any:
        return self.places[place][0].widget

    def _follow(self) -> None:
        """Fit the fields to the machine; those of an unknown one stay as they are."""
        note = self.notes["cell_machine"]
        try:
            machine = machines.load(self.places["cell_machine"][0].value, user_machines.folders())
        except InputError as error:
            note.setText(translated(error.message))
            note.show()
            return
        note.hide()
        self._set_setup(machine.is_table)
        for place in _OF_ROBOTS:
            field, _, fold = self.places[place]
            widget = field.widget
            fold.enable(widget, self.enabled[place] and not machine.is_table)
            fixed = tr("No choice for {}: the part lies on its table").format(machine.title)
            widget.setToolTip(fixed if machine.is_table else self.tips[place])
        self._offer_limits(list(machine.limit_sets))

    def _set_setup(self, is_table: bool) -> None:
        setup = self._widget("cell_setup")
        if not self.enabled["cell_setup"] or is_table == (setup.currentData() == ROTARY_TABLE):
            return
        setup.setCurrentIndex(setup.findData(ROTARY_TABLE if is_table else PART_ON_ROBOT))

    def _offer_limits(self, names: list[str]) -> None:
        """Let those limits be chosen that the machine has; what is entered stays."""
        limits = self._widget("cell_limits")
        text = limits.currentText()
        limits.clear()
        limits.addItems(names)
        limits.setEditText(text)

    def _carry_out(self) -> bool:
        """Make or change the cell, after what was typed last is followed."""
        self.later.at_once()
        return super()._carry_out()
