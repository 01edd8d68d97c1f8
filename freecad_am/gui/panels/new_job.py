# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a new job: selection, its interpretation, machine and name. Everything else has
defaults.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ... import api
from ...brep.kernel import limits as kernel
from ...core.families.family import NONE
from ...core.families.registry import DEFAULT_KIND, KINDS
from ...core.issues import AmError, InputError, Issue
from ...core.parameters.cell import CellParameters
from ...core.parameters.filled import GEODESIC, PLANES
from ...core.process.deposit import balance as deposit_balance
from ...objects.fields import preferences, saved_cells
from ...objects.shapes.bodies import snapshot_of
from ...objects.work.progress import Cancelled
from .. import icons, picking, recorded
from ..busy import carry_out
from ..colours import INVALID, PLAIN, set_role
from ..families.registry import feature_windows, window_of
from ..families.window import JobProposal
from ..in_language import sentence, tr, translated, translated_error
from ..picking import Pick
from ..signals import connect
from ..widgets import choices, suggestions
from ..widgets.fold import Fold
from ..widgets.upright import scrolls, upright
from ..worker import Background, Worker
from . import proposed_job
from .proposed_job import HowItStands, JobName, Sizes, label, machines, pick_line
from .stage import CLOSED


def left_out(job: JobProposal, width: float) -> Callable[[], tuple[Issue, ...]]:
    """Return a function that finds the regions that beads of a width, mm, miss; it touches no
    document.

    Errors of the job are reported when the job is created.
    """
    snapshots, ground = [snapshot_of(pick.obj) for pick in job.parts], job.ground
    is_same_object = ground is not None and ground.obj == job.parts[0].obj
    under = None if ground is None or is_same_object else snapshot_of(ground.obj)

    def work() -> tuple[Issue, ...]:
        try:
            balance = window_of(KINDS[job.kind]).balance(job, snapshots, under, width)
            return deposit_balance.issues(balance)
        except (InputError, *kernel.FAULTS):
            return ()

    return work


def arguments(job: JobProposal, machine: str, is_chosen: bool) -> dict[str, str]:
    """Return keywords and values as text for a proposed or chosen job, with a machine or a saved
    cell.

    If proposed curved layers are infeasible, planes are used, as in jobs with `kind: auto`.
    """
    keywords = {"source": recorded.reference(job.parts[0].obj)}
    if job.kind != DEFAULT_KIND:
        keywords["kind"] = repr(job.kind)
    if job.layers == GEODESIC:
        keywords["layers"] = repr(job.layers)
        if not is_chosen:
            keywords["layers_otherwise"] = repr(PLANES)
    if job.mend:
        keywords["mend"] = repr(job.mend)
    keywords.update(window_of(KINDS[job.kind]).arguments(job))
    if saved_cells.is_file_of_cell(machine):
        keywords["cell"] = repr(machine)
    elif machine != CellParameters().machine:
        keywords["machine"] = repr(machine)
    if preferences.post():
        keywords["post"] = repr(preferences.post())
    if preferences.process():
        keywords["process"] = repr(preferences.process())
    return keywords


def machine(document: Any) -> str:
    """Return the machine of the last cell of a document, or the default machine."""
    cells = api.stages_of(document, "cell")
    return str(cells[-1].Machine) if cells else preferences.machine()


def setup(document: Any, name: str) -> str:
    """Return the set-up of the last cell of a document if that cell has the machine, otherwise ''."""
    with contextlib.suppress(ReferenceError, RuntimeError, NameError):  # the document is closed
        cells = api.stages_of(document, "cell")
        return str(cells[-1].Setup) if cells and cells[-1].Machine == name else ""
    return ""


WIDEST_LABEL = 70  # pixels; with a wider label, the setup box exceeds the panel


class JobPanel:
    """Follows the selection while open; OK creates all stages in one step."""

    is_open = True

    def __init__(self) -> None:
        self.document = App.ActiveDocument
        windows = sorted(feature_windows(), key=lambda window: window.job_rank)
        self.kinds = {key: text for window in windows for key, text in window.entries().items()}
        self.picks: list[Pick] = []
        self.found = JobProposal("", "")
        self.asked = ""  # family that the user chose, '' for the proposed family
        self.width = 0.0  # mm; bead width that the interpretation used
        self.followed = ""  # machine of the last proposed set-up
        self._lay_out()
        self.background = Background(self.form)
        self.form.destroyed.connect(self.close)
        Gui.Selection.addObserver(self)
        self._take()

    def _lay_out(self) -> None:
        self.form = QtGui.QWidget()
        self.form.setObjectName("RoboticAM_NewJob")
        self.form.setWindowTitle(tr("New job"))
        self.form.setWindowIcon(QtGui.QIcon(icons.path("new_job")))
        self.error, self.reason, self.left_out, self.no_post = (
            label(name) for name in ("error", "reason", "left_out", "no_post")
        )
        set_role(self.error, INVALID)
        self.kind = self._kinds()
        self.part = pick_line(
            "Source", tr("Object to deposit: click it in the tree or the 3D view")
        )
        self.ground = pick_line(
            "Ground", tr("Substrate: click it with Ctrl in the tree or the 3D view")
        )
        self.machine = machines(machine(self.document), self.document)
        self.stands = HowItStands()
        self.name = JobName()
        self.sizes = Sizes()
        self.fold = Fold(tr("Inputs"), True, WIDEST_LABEL)
        rows = (
            (tr("Deposit"), self.part),
            (tr("Grows on"), self.ground),
            (tr("Kind"), self.kind),
            (tr("Machine"), self.machine),
            (tr("Setup"), self.stands.setup),
            (self.stands.leaning.heading, self.stands.leaning.widget),
            (tr("Name"), self.name.widget),
            *((size.heading, size.widget) for size in self.sizes.of_job.values()),
        )
        notes = {widget: self.fold.add(text, widget) for text, widget in rows}
        # notes under the fields, by the location of errors
        self.notes = {
            "cell.machine": notes[self.machine],
            self.name.where: notes[self.name.widget],
            self.stands.leaning.label: notes[self.stands.leaning.widget],
        }
        for key, size in self.sizes.of_job.items():
            self.notes[key] = self.notes[size.label] = notes[size.widget]
            connect(size.widget.lineEdit(), "textChanged(QString)", self._entered_anew)
        connect(self.sizes.width.widget, "editingFinished()", self._judge_anew)
        connect(self.machine, "editTextChanged(QString)", self._entered_anew)
        self.stands.setup.currentIndexChanged.connect(self._entered_anew)
        connect(self.name.widget, "textChanged(QString)", self._entered_anew)
        hint = QtGui.QLabel(
            tr(
                "Cell, feature, toolpath, joint path and program are created with their "
                "defaults; double-click a stage in the tree to change it."
            )
        )
        hint.setWordWrap(True)
        column = QtGui.QVBoxLayout(self.form)
        for widget in (
            self.fold.widget,
            self.error,
            self.reason,
            self.left_out,
            self.no_post,
            hint,
        ):
            column.addWidget(widget)
        column.addStretch(1)
        scrolls(self.form)
        upright(self.form)
        self._entered_anew()

    def _kinds(self) -> Any:
        kind = QtGui.QComboBox()
        kind.setObjectName("Kind")
        kind.setToolTip(tr("Method of cutting the part into layers; proposed from the selection"))
        kind.setSizeAdjustPolicy(
            QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon
        )  # keeps a narrow panel complete
        for key, text in self.kinds.items():
            kind.addItem(text, key)
        kind.activated.connect(self._choose)
        return kind

    # ---- the selection

    def addSelection(self, *_: Any) -> None:
        """Handle a changed selection after FreeCAD has finished it; called by FreeCAD."""
        QtCore.QTimer.singleShot(0, self._take)

    setSelection = removeSelection = clearSelection = addSelection

    def _take(self) -> None:
        """Take the selection; an empty selection changes nothing."""
        if not self.is_open:
            return
        try:
            picks, wrong = picking.selected(self.document), picking.refused(self.document)
        except (ReferenceError, RuntimeError, NameError):  # the document is closed
            self.close()
            with contextlib.suppress(RuntimeError):  # so is the panel
                self.say(tr(CLOSED))
            return
        if picks and picks != self.picks:
            self.picks, self.asked = picks, ""
            self._understand()
        elif not self.picks:
            self._show()
        self.say(wrong if not picks else "")

    def _choose(self, *_: Any) -> None:
        """Apply the chosen family."""
        self.asked = self.kind.currentData()
        if self.picks:
            try:
                self._understand()
            except ReferenceError:
                self.say(tr(CLOSED))

    def _judge_anew(self, *_: Any) -> None:
        """Reinterpret the selection for another bead width, which may change the family and the
        missed regions.
        """
        if self.is_open and self.picks and self.sizes.bead_width() != self.width:
            with contextlib.suppress(ReferenceError):  # reported when the job is created
                self._understand()

    def _understand(self) -> None:
        """Interpret the picks, in the background if it may take long."""
        self.background.cancel()
        self.width = self.sizes.bead_width()
        try:
            if self.asked:
                self._understood(proposed_job.as_kind(self.asked, self.picks, tr("as you chose")))
                return
            work = proposed_job.proposal(self.picks, self.sizes.bead_width())
        except AmError as error:
            self.found = JobProposal(self.asked, "", missing=translated_error(error))
            self._show()
            return
        self.found = JobProposal(
            "", tr("Analysing the shape."), (picking.expand_pick(self.picks[0]),)
        )
        self._show()
        self.background.start(work, self._look)

    def _look(self, worker: Worker) -> None:
        try:
            self._understood(worker.result())
        except AmError as error:
            self._understood(JobProposal("", "", missing=translated_error(error)))
        except Cancelled:
            pass

    def _understood(self, job: JobProposal) -> None:
        """Show the interpretation and find the missed regions."""
        self.found = job
        self._show()
        if job.parts and not job.missing:
            with contextlib.suppress(AmError):  # reported when the job is created
                self.background.start(
                    left_out(job, self.sizes.bead_width()), self._receive_left_out
                )

    def _receive_left_out(self, worker: Worker) -> None:
        # errors are reported when the job is created; RuntimeError if the panel is closed
        with contextlib.suppress(AmError, Cancelled, RuntimeError):
            self._show_left_out(worker.result())

    def _show_left_out(self, issues: Sequence[Issue]) -> None:
        self.left_out.setText("\n".join(sentence(issue.message) for issue in issues))
        self.left_out.setVisible(bool(issues))

    def _show(self) -> None:
        """Show the interpretation of the selection and missing inputs."""
        self._show_left_out(())
        job = self.found
        if job.kind:
            self.kind.setCurrentIndex(self.kind.findData(job.choice))
        for widget, picks in (
            (self.part, job.parts),
            (self.ground, () if job.ground is None else (job.ground,)),
        ):
            text = ", ".join(" ".join([pick.obj.Label, *pick.names]) for pick in picks)
            widget.setText(text)
            widget.setCursorPosition(0)
            widget.setToolTip(text or widget.whatsThis())
        family = job.family
        is_filled = family is not None and family.is_filled
        self.fold.enable(self.ground, family is None or family.substrate != NONE)
        self.fold.enable(self.sizes.width.widget, not is_filled)
        self.fold.enable(self.sizes.spacing.widget, is_filled)
        missing = (
            job.missing
            if self.picks
            else tr(
                "Click the object to deposit in the tree or the 3D view, then Ctrl+click its "
                "substrate, if any."
            )
        )
        reason = job.reason
        if job.kind and job.reason:
            reason = tr("{}: {}.").format(self.kinds[job.choice], job.reason)
        whole_note = proposed_job.taken_whole(job, self.picks)
        self.reason.setText("\n".join(filter(None, (reason, whole_note, missing))))
        set_role(self.reason, INVALID if missing and self.picks else PLAIN)
        self.reason.setVisible(bool(self.reason.text()))
        if job.parts:
            self.name.of(job.parts[0].obj.Label)

    def say(self, text: str) -> None:
        """Show an error."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    def _show_note(self, key: str, text: str) -> None:
        """Show a problem under its field."""
        self.notes[key].setText(text)
        self.notes[key].setVisible(bool(text))

    def _entered_anew(self, *_: Any) -> None:
        """Clear the notes; report a machine without a post now, not after planning."""
        for key in self.notes:
            self._show_note(key, "")
        name = choices.entered(self.machine)
        self.stands.follow(suggestions.is_robot(name))
        self.sizes.platform.widget.setEnabled(not saved_cells.is_file_of_cell(name))
        if name != self.followed:
            self.followed = name
            self.stands.propose(setup(self.document, name) or suggestions.setup_for(name))
        without = suggestions.no_post(name, self.stands.chosen())
        self.no_post.setText(without)
        self.no_post.setVisible(bool(without))
        refusal = self.name.follow(name, self.stands.chosen())
        self._show_note(self.name.where, translated(refusal))

    # ---- called by FreeCAD

    def accept(self) -> bool:
        """Create all stages; return True to close the panel, or show an error in it."""
        self.say("")
        self._entered_anew()
        if self.notes[self.name.where].text():
            self.fold.heading.setChecked(True)  # the section contains the note
            return False
        try:
            self._wait()
            if self.found.missing or not self.found.parts or not self.found.kind:
                self.say(self.found.missing or self.reason.text())
                return False
            old_names = {obj.Name for obj in self.document.Objects}
            recorded.make(self.document, "make_all", self._arguments())
        except AmError as error:
            if error.where in self.notes:
                self._show_note(error.where, translated(error.message))
                self.fold.heading.setChecked(True)
            else:
                self.say(translated_error(error))
        except Cancelled:
            self.say(tr("Cancelled: the document is unchanged."))
        except ReferenceError:
            self.say(tr(CLOSED))
        else:
            self.close()
            stages = [obj for obj in api.stages_of(self.document) if obj.Name not in old_names]
            proposed_job.show_alone(stages)
            proposed_job.show_machine(stages, bool(self.stands.chosen()))
            proposed_job.report_next_steps(stages, self.found.layers)
            return True
        return False

    def _wait(self) -> None:
        """Wait until the selection is interpreted."""
        worker = self.background.worker
        if worker is not None:
            carry_out(worker.ended.wait, tr("New job"))
            self.background.at_once()

    def _arguments(self) -> dict[str, str]:
        keywords = arguments(self.found, choices.entered(self.machine), bool(self.asked))
        saved = saved_cells.is_file_of_cell(choices.entered(self.machine))
        sizes = self.sizes.arguments(KINDS[self.found.kind].is_filled, saved)
        return {**keywords, **self.stands.arguments(), **self.name.choice.arguments(), **sizes}

    def reject(self) -> Any:
        """Close the panel; the document is unchanged."""
        self.close()
        return True

    def close(self, *_: Any) -> None:
        """Stop observing the selection; may be called repeatedly."""
        if self.is_open:
            self.is_open = False
            Gui.Selection.removeObserver(self)
            self.background.cancel()
