# SPDX-License-Identifier: LGPL-2.1-or-later
"""Propose the role of each selected object in a new job, and its family and layers, as `kind: auto`
does.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ... import api
from ...core.families.family import NEEDED
from ...core.families.registry import KINDS
from ...core.families.solid import Solid
from ...core.families.surface import Surface
from ...core.issues import NOTE, WARNING, InputError
from ...core.kinematics.arrangement import OF_ROBOTS
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters
from ...core.parameters.cell_records import EXTERNAL
from ...core.parameters.filled import GEODESIC, PLANES, FilledParameters
from ...core.parameters.process import ProcessParameters
from ...objects.checks import deposit
from ...objects.checks.collisions import ARM_NEAR, LOW_MARGIN
from ...objects.families.developable import stands_on_hub
from ...objects.families.recognition import Proposal, SelectedPart
from ...objects.families.registry import propose_family
from ...objects.fields import preferences, saved_cells
from ...objects.fields.rows import Row, is_expression, name_for, refusal, rows
from ...objects.results.findings import issues_of
from ...objects.shapes.bodies import Taken, snapshot_of
from ...objects.staleness import FAILED, INFEASIBLE, STALE, UP_TO_DATE
from .. import picking
from ..families.registry import feature_windows, window_of
from ..families.window import JobProposal, ground_missing, several_elements
from ..in_language import sentence, tr, translated
from ..picking import Pick
from ..widgets import choices, fields, shape_inputs, suggestions
from ..widgets.fold import WrappedLabel
from ..widgets.quantity import QuantityField

LEANING = "max_from_vertical"


def label(name: str) -> Any:
    """Create a label that is hidden until it has a text."""
    text = WrappedLabel()
    text.setObjectName(name)
    text.hide()
    return text


def pick_line(name: str, help: str) -> Any:
    """Create a read-only line for the names of clicked objects."""
    line = QtGui.QLineEdit()
    line.setObjectName(name)
    line.setReadOnly(True)
    line.setToolTip(help)
    line.setWhatsThis(help)
    line.setPlaceholderText(
        tr("click the object") if name == "Source" else tr("Ctrl+click the object")
    )
    return line


def machines(selected: str, doc: Any) -> Any:
    """Create the list of saved cells and machines, with one selected."""
    machine = QtGui.QComboBox()
    machine.setObjectName("Machine")
    machine.setToolTip(
        tr("The machine that deposits, or a saved cell; the program matches its controller")
    )
    machine.setEditable(True)
    cells = [(path, tr("saved cell: {}").format(name)) for path, name in saved_cells.known(doc)]
    choices.offer(machine, [*cells, *choices.machines()])
    choices.enter(machine, selected)
    return machine


class JobName:
    """The program name, derived from the deposited part and the controller until the user types a
    name.
    """

    where = "name"  # location in errors

    def __init__(self) -> None:
        self.choice = shape_inputs.NameChoice("")
        self.widget = self.choice.widget
        self.label = self.post = self.proposed = ""
        self.asked: tuple[str, str] | None = None  # machine and set-up that determine the post

    def of(self, label: str) -> None:
        """Derive the name from a label."""
        self.label = label
        self._propose()

    def follow(self, machine: str, setup: str) -> str:
        """Propose a name for a machine or saved cell.

        Return why its controller rejects the entry; '' if it accepts the entry.
        """
        if self.asked != (machine, setup):
            self.asked, self.post = (machine, setup), suggestions.post_of_job(machine, setup)
            self._propose()
        text = self.widget.text().strip()
        return refusal(text, self.post) if text else ""

    def _propose(self) -> None:
        if self.label and self.widget.text() in ("", self.proposed):
            self.proposed = name_for(self.label, self.post)
            self.widget.setText(self.proposed)


class HowItStands:
    """The set-up of a robot, `setup`, and the maximum lean of a carried tool, `leaning`."""

    def __init__(self) -> None:
        self.setup = QtGui.QComboBox()
        self.setup.setObjectName("Setup")
        self.setup.setToolTip(
            tr(
                "The robot carries the tool or the part. If the job is infeasible in the "
                "proposed cell, another position, another branch or a positioner is proposed and "
                "shown."
            )
        )
        for arrangement in OF_ROBOTS:
            if arrangement.planned:
                self.setup.addItem(choices.worded(arrangement.setup), arrangement.setup)
        self.proposed = str(self.setup.currentData())
        row = _row(BuildDirectionParameters, LEANING)
        self.leaning = fields.make(row, row.default)

    def follow(self, is_robot: bool) -> None:
        """Disable the fields for a machine other than a robot, or for a saved cell."""
        self.setup.setEnabled(is_robot)
        self.leaning.widget.setEnabled(bool(self.chosen()))

    def propose(self, setup: str) -> None:
        """Select a suitable set-up for the machine, unless the user changed the last proposal."""
        index = self.setup.findData(setup)
        if index >= 0 and self.setup.currentData() == self.proposed:
            self.proposed = setup
            self.setup.setCurrentIndex(index)

    def chosen(self) -> str:
        """Return the chosen set-up, '' for the default or without a choice."""
        return (
            str(self.setup.currentData())
            if self.setup.isEnabled() and self.setup.currentIndex()
            else ""
        )

    def arguments(self) -> dict[str, str]:
        """Return keywords of `make_all` with values as text; none for the default set-up.

        Raises InputError for unreadable entries.
        """
        if not self.chosen():
            return {}
        keywords, value = {"setup": repr(self.chosen())}, self.leaning.value
        return keywords if value == self.leaning.shown else {**keywords, LEANING: repr(value)}


class FittedLength:
    """A length that may be left empty; an empty length is determined when the job is created."""

    def __init__(self, row: Row, placeholder: str, extra_help: str) -> None:
        self.quantity = QuantityField(row.outer(row.default), row.unit, row.label)
        self.widget = self.quantity.box
        self.widget.setObjectName(row.name)
        self.label = self.heading = translated(row.label)
        self.widget.setToolTip(f"{translated(row.spec.help)} {extra_help}")
        self.widget.setWhatsThis(fields.whats_this(row, "cell"))
        self.quantity.known_text = ""
        self.quantity.line.clear()
        self.quantity.make_room()
        self.quantity.line.setPlaceholderText(placeholder)

    @property
    def value(self) -> Any:
        """Return the entry in outer units or as an expression; None for an empty field. Raises
        InputError.
        """
        return self.quantity.read() if self.quantity.line.text().strip() else None


class Sizes:
    """Layer height, width or spacing of beads, and the platform of a new job."""

    def __init__(self) -> None:
        layer, spacing = (_row(FilledParameters, key) for key in ("layer_height", "bead_spacing"))
        width = _row(ProcessParameters, "bead_width")
        self.layer = fields.make(layer, layer.default, section="strategy")
        self.width = fields.make(width, deposit.bead_width(), section="process")
        self.spacing = fields.make(spacing, spacing.default, section="strategy")
        self.platform = FittedLength(
            _row(CellParameters, "platform_diameter"),
            tr("auto"),
            tr("If empty, the platform is sized for the first layer."),
        )
        self.of_job = {
            "strategy.layer_height": self.layer,
            "process.bead_width": self.width,
            "strategy.bead_spacing": self.spacing,
            "cell.platform_diameter": self.platform,
        }

    def bead_width(self) -> float:
        """Return the bead width for interpreting parts, mm; the default for an expression or an
        unreadable entry.
        """
        try:
            value = self.width.value
        except InputError:
            return deposit.bead_width()
        return deposit.bead_width() if is_expression(value) or value <= 0.0 else float(value)

    def arguments(self, filled: bool, saved: bool) -> dict[str, str]:
        """Return the entries as keywords of `make_all` with values as text.

        filled: beads have a spacing. saved: the cell has its own platform. Raises InputError for
        unreadable entries.
        """
        keywords = {}
        for field in (self.layer, *((self.spacing,) if filled else ())):
            if field.changed:
                keywords[field.row.key] = repr(field.value)
        if not filled and self.width.changed:
            values = {**preferences.process(), self.width.row.key: self.width.value}
            keywords["process"] = repr(values)
        if not saved and self.platform.value is not None:
            keywords["platform_diameter"] = repr(self.platform.value)
        return keywords


def _row(section: type, key: str) -> Row:
    return next(row for row in rows(section) if row.key == key)


LOOK_AT = (ARM_NEAR, LOW_MARGIN)  # codes of notes that are shown with the result
SHOWN_MS = 15000  # ms; how long the status bar shows the next step


def report_next_steps(stages: list[Any], proposed: str = "") -> None:
    """Show the result with its status and the next steps. proposed: proposed layers, if any."""
    wrong = next((obj for obj in stages if obj.Status != UP_TO_DATE), None)
    if wrong is not None:
        # the report view already shows the reason
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
    notes = [
        sentence(issue.message)
        for obj in stages
        for issue in issues_of(obj)
        if issue.code in LOOK_AT and issue.level == NOTE
    ]
    if wrong is None and notes:
        text = " ".join([text, *(f"{note}." for note in notes)])
    if proposed == GEODESIC and any(
        obj.Proxy.kind == "feature" and obj.Layers != GEODESIC for obj in stages
    ):
        text = tr("Planar layers are used, as curved layers were infeasible. {}").format(text)
    Gui.getMainWindow().statusBar().showMessage(text, SHOWN_MS)
    App.Console.PrintMessage(text + "\n")
    _show_whole()


def show_alone(stages: list[Any]) -> None:
    """Hide cells and paths of earlier jobs, which would overlap those of the new job."""
    for obj in api.stages_of(stages[0].Document) if stages else []:
        if obj not in stages and obj.ViewObject.Visibility:
            obj.ViewObject.Visibility = False


def show_machine(stages: list[Any], is_setup_chosen: bool) -> None:
    """Show the robot if its set-up was chosen, and report the proposed positioner."""
    cell = next((obj for obj in stages if obj.Proxy.kind == "cell"), None)
    if cell is None or not is_setup_chosen:
        return
    cell.ViewObject.ShowMachine = True
    mechanisms = cell.Proxy.parameters(cell, CellParameters).external
    if mechanisms:
        App.Console.PrintWarning(
            tr("{}: proposed for this job: {}; enter the values of your cell.").format(
                cell.Label, EXTERNAL.text(mechanisms)
            )
            + "\n"
        )


def _show_whole() -> None:
    """Fit the view. A view still in FreeCAD's initial top view becomes isometric, so that heights
    are visible.
    """
    view = Gui.activeDocument().activeView()
    if hasattr(view, "getCameraOrientation") and view.getCameraOrientation().isIdentity():
        view.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")


def proposal(picks: Sequence[Pick], width: float) -> Callable[[], JobProposal]:
    """Return a function that interprets picks for beads of a width, mm, without touching the
    document.

    Raises InputError NO_SHAPE; the function raises FAULTY or NO_FACES.
    """
    pairs = [(pick, _copy_shape(pick)) for pick in picks]
    if len(pairs) == 1:
        return lambda: _propose_for_one(*pairs[0], width)
    return lambda: _propose_for_several(pairs, width)


def as_kind(choice: str, picks: Sequence[Pick], reason: str) -> JobProposal:
    """Return the roles of picks for a chosen family or kind of layers."""
    for window in feature_windows():
        entries = tuple(window.entries())
        if choice in entries:
            layers = "" if choice == entries[0] else choice
            return window.assign_roles(picks, reason, layers)
    raise KeyError(choice)


def taken_whole(job: JobProposal, picks: Sequence[Pick]) -> str:
    """Return a note that a single clicked face selects the whole object; '' if it does not apply."""
    if job.family is not None and window_of(job.family).face_is_base:
        return ""
    clicked = {pick.obj.Name for pick in picks if len(picking.pick_of_faces(pick).names) == 1}
    for target in job.parts:
        if not target.names and target.obj.Name in clicked:
            return tr(
                "The whole of {} is used. Ctrl+click several faces to use only these faces; for "
                "a single face, use the panel of Feature or Wall on Part."
            ).format(target.obj.Label)
    return ""


def _propose_for_one(pick: Pick, snapshot: Taken, width: float) -> JobProposal:
    target = _deposit_pick(pick, snapshot)
    clicked = picking.pick_of_faces(pick).names
    result = propose_family(
        SelectedPart(
            snapshot,
            target.names,
            None,
            False,
            width,
            True,
            clicked=() if target.names else clicked,
        )
    )
    if window_of(KINDS[result.kind]).face_is_base:  # hubs and solids belong to one object
        ground = (
            Pick(pick.obj, clicked)
            if clicked and snapshot.shape is not None and len(snapshot.shape.Solids) < 2
            else None
        )
        return _as_proposed(result, (Pick(pick.obj),), ground)
    return _as_proposed(result, (target,), None)


def _propose_for_several(pairs: Sequence[tuple[Pick, Taken]], width: float) -> JobProposal:
    """Propose a job from the contacts between the objects, their number and the picked faces."""
    picks = [pick for pick, _ in pairs]
    faced = [pair for pair in pairs if picking.pick_of_faces(pair[0]).names]
    for ground, hub in (*faced, *(pair for pair in reversed(pairs) if pair not in faced)):
        solids = [pair for pair in pairs if pair[0] is not ground]
        base = picking.pick_of_faces(ground).names
        if all(
            not picking.pick_of_faces(pick).names and stands_on_hub(snapshot, hub, base)
            for pick, snapshot in solids
        ):
            result = propose_family(
                SelectedPart(solids[0][1], (), hub, False, width, True, base=base)
            )
            return _as_proposed(
                result, tuple(Pick(pick.obj) for pick, _ in solids), picking.pick_of_faces(ground)
            )
    if len(pairs) > 2:
        if all(snapshot.shape is None or snapshot.shape.Solids for _, snapshot in pairs):
            reason = tr("{} solids are selected, to be filled").format(len(pairs))
            return JobProposal(
                Solid.kind, reason, tuple(Pick(pick.obj) for pick in picks), layers=PLANES
            )
        return as_kind(
            Surface.kind, picks, tr("the selection includes an object that is not a solid")
        )
    wall, ground, _ = picking.proposal(picks)
    if wall is None or ground is None:  # both are meshes
        wall, ground = picks
    snapshot, under = (
        next(look for pick, look in pairs if pick.obj == role.obj) for role in (wall, ground)
    )
    target = _deposit_pick(next(pick for pick in picks if pick.obj == wall.obj), snapshot)
    result = propose_family(SelectedPart(snapshot, target.names, under, False, width, True))
    return _as_proposed(result, (target,), Pick(ground.obj))


def _as_proposed(result: Proposal, picks: tuple[Pick, ...], ground: Pick | None) -> JobProposal:
    starts = result.stands and picking.is_alone(picks[0].obj)
    needs_ground = KINDS[result.kind].substrate == NEEDED and not starts
    missing = ground_missing(picks[0], ground) if needs_ground else ""
    return JobProposal(
        result.kind, translated(result.reason), picks, ground, missing, result.layers, result.mend
    )


def _deposit_pick(pick: Pick, snapshot: Taken) -> Pick:
    """Return the clicked geometry to deposit: several edges, several faces or the whole object."""
    if snapshot.shape is None:
        return Pick(pick.obj)
    if not snapshot.shape.Faces or sum(name.startswith(picking.EDGE) for name in pick.names) > 1:
        return several_elements(pick)
    faces = picking.pick_of_faces(pick)
    return Pick(pick.obj) if len(faces.names) == 1 and len(snapshot.shape.Faces) > 1 else faces


def _copy_shape(pick: Pick) -> Taken:
    """Return a copy of an object's shape, because the window may draw the original at the same
    time.
    """
    snapshot = snapshot_of(pick.obj)
    return snapshot if snapshot.shape is None else Taken(snapshot.label, snapshot.shape.copy(False))
