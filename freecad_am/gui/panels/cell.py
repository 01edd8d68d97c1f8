# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a cell. It shows platform, nozzle and machine while open, and follows the selected
machine.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import numpy as np
from PySide import QtCore, QtGui

from ...core.issues import AmError, InputError
from ...core.kinematics.arrangement import arrangement_of
from ...core.kinematics.machines import machine as machines
from ...core.kinematics.machines.machine import Machine
from ...core.kinematics.proposed_cell import cell_of
from ...core.kinematics.urdf.cell import cell_values_of_machine
from ...core.kinematics.urdf.machine import WHOLE_CELL
from ...core.parameters import cell_records
from ...core.parameters.cell import CellParameters
from ...core.parameters.records import NONE
from ...objects import user_machines
from ...objects.cell import Cell
from ...objects.fields.rows import flat
from ...objects.planned import suited_cell
from ...objects.stage import stage_of
from ...objects.stage_parts import Outcome
from ...objects.work.progress import Cancelled
from ..busy import carry_out
from ..in_language import tr, translated
from ..nodes.cell import CellNodes, Rest, Scenery, at_the_end, machine_scenery
from ..views.cell import toolpath_of
from ..views.preview import Aside, Draft
from ..widgets import suggestions
from ..widgets.shape_inputs import job_selection
from ..worker import Background, Later, Worker
from .preview import PreviewPanel

# ---- Proposals of the cell panel: values that suit the selected machine, then a cell in which the
# toolpath's job is feasible. Entries are kept; the panel notes its proposal next to them


def whole_cell(machine: object, external: object) -> tuple[str, str] | None:
    """Return machine and external axes for a URDF of a whole cell; None unless `external` asks for
    one.

    Raises InputError BAD_URDF if robot, track and positioner cannot be distinguished, and BAD_VALUE
    if the file is not a URDF.
    """
    if not isinstance(external, str) or external.strip() != WHOLE_CELL:
        return None
    name, mechanisms = cell_values_of_machine(machine)
    return name, cell_records.EXTERNAL.text(mechanisms)


MACHINE, SETUP, POINT, BRANCH = "cell_machine", "cell_setup", "cell_deposition_point", "cell_branch"
ARM, OBSTACLES, EXTERNAL = "cell_arm_clearance", "cell_obstacles", "cell_external"
TOOL, TORCH, PLATFORM = "cell_nozzle_tool", "cell_nozzle_shape", "cell_platform"
OF_ROBOTS = (SETUP, POINT, BRANCH, TOOL, TORCH, ARM, OBSTACLES, EXTERNAL)


class ProposingPanel(PreviewPanel):
    """Proposes field values of a cell. A subclass reports problems of a machine and provides the
    toolpath.
    """

    later: Later

    def __init__(self, title: str, obj: Any, nodes: Any) -> None:
        # proposals by machine and set-up in the fields, and the last such pair
        self.of_machine: dict[tuple[str, str], CellParameters] = {}
        self.before: tuple[str, str] | None = None
        self.put: dict[str, Any] = {}  # values entered by the panel itself
        # field value and text when a proposal was reported
        self.noted: dict[str, tuple[Any, str]] = {}
        super().__init__(title, [], obj, nodes)
        self.enabled = {key: self.places[key][0].widget.isEnabled() for key in OF_ROBOTS}
        if obj is None:
            self.put.update((key, self._holds(key)) for key in (POINT, BRANCH))
        self.proposing, self.suiting = Background(self.form), Background(self.form)

    def follow_undo(self) -> None:
        """Show restored entries without proposals, because they belong to the user."""
        super().follow_undo()
        self.proposing.cancel()
        self.suiting.cancel()
        self.before = (self.places[MACHINE][0].value, self._widget(SETUP).currentData())

    def _widget(self, key: str) -> Any:
        return self.places[key][0].widget

    def _show_machine_problem(self, text: str) -> None:
        """Show a problem of the machine."""
        raise NotImplementedError

    def _toolpath(self) -> Any:
        """Return the current toolpath; None without one."""
        raise NotImplementedError

    # ---- proposals for a machine

    def _ask_proposal(self, name: str, machine: Machine) -> None:
        """Compute a proposal for the machine in the background, unless the machine is unchanged."""
        setup = self._widget(SETUP).currentData()
        previous, self.before = self.before, (name, setup)
        if previous == self.before or (previous is None and self.obj is not None):
            return
        self.proposing.cancel()
        self.suiting.cancel()
        for key in list(self.noted):
            self._clear_note(key)
        if not machine.free or not (arrangement_of(setup).free and arrangement_of(setup).planned):
            return
        folders, proposals, current, tool = (
            user_machines.folders(),
            dict(self.of_machine),
            self.before,
            self._tool(),
        )

        def work() -> dict[tuple[str, str], CellParameters]:
            for pair in filter(None, (previous, current)):
                with contextlib.suppress(InputError):  # the previous machine is deleted
                    proposals[pair] = proposals.get(pair) or cell_of(
                        pair[0], folders, pair[1], tool
                    )
            return proposals

        self.proposing.start(
            work, lambda worker: self._propose(worker, previous, current, machine.title)
        )

    def _tool(self) -> Any:
        """Return the entered pose of the tip on the flange, None if it is not numeric."""
        row, entry = self.places[TOOL][0].row, self._holds(TOOL)
        with contextlib.suppress(AmError):
            return None if entry is None else row.inner(entry, row.label)
        return None

    def _propose(
        self, worker: Worker, previous: tuple[str, str] | None, current: tuple[str, str], title: str
    ) -> None:
        """Enter the proposal where the field still has the proposal of the previous machine."""
        try:
            self.of_machine = worker.result()
        except AmError as error:
            self._show_machine_problem(translated(error.message))
            return
        except Exception as error:  # unexpected
            self._show_machine_problem(f"{type(error).__name__}: {error}")
            return
        proposal = self.of_machine.get(current)
        default = CellParameters()
        usual = (None if previous is None else self.of_machine.get(previous)) or default
        if proposal is None:  # no cell can have this machine; the preview reports it
            return
        no_axes = self.places[EXTERNAL][0].row.outer(default.external)
        if EXTERNAL in self.put and self._may_put(EXTERNAL, no_axes):  # of the old machine
            self.places[EXTERNAL][0].show(no_axes)
        for key, value, *was in (
            (POINT, proposal.deposition_point, usual.deposition_point, default.deposition_point),
            (BRANCH, proposal.branch, usual.branch, default.branch),
        ):
            field = self.places[key][0]
            proposed, holds = field.row.outer(value), self._holds(key)
            if holds is None or _alike(holds, proposed):  # the note tells what is unreadable
                continue
            if self._may_put(key, *map(field.row.outer, was)):
                self._put(
                    key,
                    proposed,
                    tr("Proposed for {}; enter the values of your cell.").format(title),
                )
            else:
                self._note(
                    key,
                    tr("Kept as entered; the proposal for {} is {}.").format(
                        title, _value_text(proposed)
                    ),
                )
        self._ask_for_job()

    def _may_put(self, key: str, *usual: Any) -> bool:
        """Whether the field contains only a value from the panel or a default."""
        return self.enabled[key] and any(
            _alike(self._holds(key), value) for value in (self.put.get(key), *usual)
        )

    def _put(self, key: str, value: Any, text: str) -> None:
        """Enter a proposal and note it."""
        self.places[key][0].show(value)
        self.put[key] = value
        self._note(key, text)

    def _note(self, key: str, text: str) -> None:
        """Show a note on a proposal while the field keeps its value."""
        self.noted[key] = self._holds(key), text
        self.show_note(key, text, wrong=False)

    def _clear_note(self, key: str) -> None:
        """Clear the note on a proposal, but no error in its place."""
        _, text = self.noted.pop(key)
        if self.notes[key].text() == text:
            self.show_note(key, "")

    # ---- proposals for the current job

    def _ask_for_job(self) -> None:
        """Search for a feasible cell for the toolpath's job in the background, starting from the
        entries.

        The preview reports invalid cells.
        """
        toolpath = self._toolpath()
        if toolpath is None:
            return
        with contextlib.suppress(AmError):
            draft = Draft(self.proxy, self.document, self.draft, self._links(), self._values())
            compute, suited, label = (
                draft.prepare(),
                suited_cell.suit_to_toolpath(toolpath),
                toolpath.Label,
            )
            entered = self._all_held()

            def work() -> tuple[dict[str, Any], dict[str, Any]]:
                settings = compute().value
                return flat(settings), flat(suited(settings))

            self.suiting.start(
                draft.reporting(work), lambda worker: self._suit(worker, entered, label)
            )

    def _suit(self, worker: Worker, entered: dict[str, Any], label: str) -> None:
        """Enter the job's cell if all its fields are unedited; otherwise note it at the fields."""
        try:
            entered_values, suited_values = worker.result()
        except AmError:  # the preview reports it
            return
        except Exception as error:  # unexpected
            self._show_machine_problem(f"{type(error).__name__}: {error}")
            return
        if self._all_held() != entered:  # an entry changed meanwhile
            self._ask_for_job()
            return
        default, changes = flat(CellParameters()), {}
        for name, (field, _, _) in self.places.items():
            key = field.row.key
            if suited_values[key] != entered_values[key]:
                changes[name] = field.row.outer(suited_values[key]), field.row.outer(default[key])
        free = all(
            name in self.enabled and self._may_put(name, usual)
            for name, (_, usual) in changes.items()
        )
        for name, (value, _) in changes.items():
            self._unfolded(name)
            if free:
                self._put(
                    name,
                    value,
                    tr("Proposed for the job of {}; enter the values of your cell.").format(label),
                )
            else:
                text = tr("Kept as entered; the job of {} is feasible with {}.")
                self._note(name, text.format(label, _value_text(value)))

    def _all_held(self) -> dict[str, Any]:
        return {key: self._holds(key) for key in self.places}

    # ---- entries

    def _holds(self, key: str) -> Any:
        """Return the value of a field, None if it cannot be read."""
        with contextlib.suppress(InputError):
            return self.places[key][0].value
        return None

    def judge_entries(self) -> None:
        """Clear the note on a proposal once the entry changes."""
        super().judge_entries()
        for key, (value, _) in list(self.noted.items()):
            if not _alike(self._holds(key), value):
                self._clear_note(key)

    def _carry_out(self) -> bool:
        """Create or change the cell after following the last entry. Report values that the user has
        not seen.
        """
        previous = dict(self.put)
        self.later.at_once()
        for background in (self.proposing, self.suiting):
            worker = background.worker
            if worker is None:
                continue
            try:
                carry_out(worker.ended.wait, self.form.windowTitle())
            except Cancelled:
                self.suiting.cancel()
                self.say(tr("Cancelled: the document is unchanged."))
                return False
            background.at_once()
        unseen = [self._line(key) for key, value in self.put.items() if value != previous.get(key)]
        succeeded = super()._carry_out()
        for line in unseen if succeeded else []:
            App.Console.PrintWarning(line)
        return succeeded

    def _line(self, key: str) -> str:
        """Return a report view line about a value that the panel entered."""
        label, value = self.places[key][0].label, _value_text(self.put[key])
        text = tr("{}: {} is now {}. {}").format(
            self.form.windowTitle(), label, value, self.notes[key].text()
        )
        return f"{text}\n"

    def close(self, *_: Any) -> None:
        """Remove the preview; may be called repeatedly."""
        if self.is_open:
            self.proposing.cancel()
            self.suiting.cancel()
        super().close()


def _alike(a: Any, b: Any) -> bool:
    """Whether two poses or two texts are equal as displayed."""
    if isinstance(a, tuple) and isinstance(b, tuple):
        return bool(np.allclose(a, b, rtol=0.0, atol=1e-6))
    return isinstance(a, str) and isinstance(b, str) and a.replace(",", " ").split() == b.split()


def _value_text(value: Any) -> str:
    return value if isinstance(value, str) else " ".join(f"{number:g}" for number in value)


# ---- Description of a machine at rest for the cell panel


def stands(rest_pose: Rest) -> str:
    """Return the text for a machine at rest: its title and the axis nearest to its limit."""
    if not rest_pose.machine.free:
        return tr("{} at rest, revolute axes at 0").format(rest_pose.machine.title)
    if not rest_pose.reached:
        text = tr("{} does not reach the part with the nozzle upright: all its axes are drawn at 0")
        return text.format(rest_pose.machine.title)
    margin, label = rest_pose.limits.smallest(rest_pose.joints)
    margin_deg, axis = float(np.degrees(margin)), rest_pose.limits.labels[int(label)]
    text = (
        tr("{} with the nozzle upright: {} is {:.0f}° from its limit")
        if margin_deg >= 0.0
        else tr("{} with the nozzle upright: {} is {:.0f}° past its limit")
    )
    return text.format(rest_pose.machine.title, axis, abs(margin_deg))


_OF_TOOLS = (TOOL, EXTERNAL)  # fields of tools that a robot carries


class CellPanel(ProposingPanel):
    """Adapts the fields to machine and set-up.

    A machine with prismatic and revolute axes carries the part on its table and has no branches.
    For a robot, the panel proposes a suitable deposition point or platform pose and a branch,
    unless the user has entered them.
    """

    stage, draft = Cell, "Cell"
    lines = 4

    def __init__(self, obj: Any = None) -> None:
        self.unknown = ""  # the message about an unknown machine name
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

    # ---- fields for the machine

    def _follow(self) -> None:
        """Adapt the fields to the machine; leave them unchanged for an unknown machine."""
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
        """Hide fields without meaning for the machine or set-up.

        A part that the robot does not carry is at the deposition point or on a positioner's
        platform.
        """
        if not machine.free:
            without: tuple[str, ...] = OF_ROBOTS
        elif arrangement_of(self._widget(SETUP).currentData()).carries_part:
            without = _OF_TOOLS
        else:
            without = (PLATFORM,) if self._holds(EXTERNAL) in (NONE, "") else ()
        self.leave_out(without, also_entered=True)

    def _show_machine_problem(self, text: str) -> None:
        """Show a problem of the machine until the panel follows another machine."""
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

    def _renew(self) -> None:
        """Follow the last entry before the preview, which would reject the other fields."""
        self.later.at_once()
        self.shown = self._entered()
        super()._renew()

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
        """Return the toolpath of the cell; for a new cell, the selected toolpath or the only one."""
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
            filter(None, ("" if drawing.rest is None else stands(drawing.rest), without))
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
