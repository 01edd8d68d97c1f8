# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a program; it previews the first lines and the totals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
from PySide import QtCore, QtGui

from ...core.issues import NOTE, AmError, Issue
from ...core.parameters.program import ProgramParameters
from ...core.preflight.promise import Place, Promise
from ...core.simulation.timeline import Totals, timeline, totals
from ...objects.checks import preflight
from ...objects.fields import rows
from ...objects.program import Job, Program, Written, posted
from ...objects.stage_parts import Outcome
from ...objects.staleness import UP_TO_DATE
from ...posts import catalogue
from ..colours import FAINT, GOOD, INVALID, of
from ..in_language import sentence, tr, translated
from ..path import dock
from ..program_window import listing
from ..simulation import wording
from ..views.preview import Draft
from ..widgets import shape_inputs, suggestions
from ..widgets.shape_inputs import job_selection
from .preview import PreviewPanel, stale_lines

# ---- The preflight in a panel: every promise with its mark, worst value and location; a click goes there

ROW_HEIGHT = 16  # approximate number of visible lines
PLACE_ROLE = QtCore.Qt.UserRole


class PreflightList:
    """A list of promises. go: called with the location of a clicked promise."""

    def __init__(self, go: Callable[[Place], None]) -> None:
        self.widget = QtGui.QListWidget()
        self.widget.setObjectName("Preflight")
        self.widget.setWordWrap(True)
        self.widget.setResizeMode(QtGui.QListView.Adjust)
        self.widget.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        self.widget.setMinimumHeight(ROW_HEIGHT * self.widget.fontMetrics().lineSpacing())
        help = tr(
            "Checks of the program with method and worst point; click a check to show its worst "
            "point"
        )
        self.widget.setToolTip(help)
        self.widget.setWhatsThis(help)
        self.widget.itemClicked.connect(lambda item: _clicked(item, go))

    def show(self, promises: Sequence[Promise]) -> None:
        """Replace the list by these promises."""
        self.widget.clear()
        for promise in promises:
            self.widget.addItem(_row(promise))

    def clear(self) -> None:
        """Clear the list."""
        self.widget.clear()


def summary(promises: Sequence[Promise]) -> str:
    """Return the numbers of kept, broken and unchecked promises as text."""
    passed, broken = (sum(promise.ok is ok for promise in promises) for ok in (True, False))
    return tr("Preflight: {} passed, {} failed, {} not checked").format(
        passed, broken, len(promises) - passed - broken
    )


def _row(promise: Promise) -> Any:
    """Return an item of two lines: the promise; its value and location. The tooltip explains the
    check.
    """
    mark, colour = {True: ("✓", GOOD), False: ("✗", INVALID), None: ("?", FAINT)}[promise.ok]
    further = [translated(promise.figure), "" if promise.place is None else _where(promise.place)]
    item = QtGui.QListWidgetItem(
        "\n".join(
            filter(
                None,
                (
                    f"{mark} {translated(promise.promise)}",
                    "    ".join(["", *filter(None, further)]) if any(further) else "",
                ),
            )
        )
    )
    item.setForeground(QtGui.QBrush(of(colour)))
    item.setToolTip(sentence(promise.how))
    item.setData(PLACE_ROLE, None if promise.place is None else list(promise.place))
    return item


def _where(position: Place) -> str:
    """Format a location as in issues."""
    return translated(Issue(NOTE, "", "", *position).where)


def _clicked(item: Any, go: Callable[[Place], None]) -> None:
    position = item.data(PLACE_ROLE)
    if position is not None:
        go(Place(*position))


SHOWN_LINES = 40  # number of lines shown; some program headers have twenty lines
HIGH = 14  # approximate number of visible lines
FONT_SCALE, MIN_FONT_PT = (
    0.85,
    6.0,
)  # font size relative to the panel's text, and minimum size in points
NC = "program_nc_"  # prefix of the parameters of five-axis machines
POST, MOTION, START, START_LAYER = (
    "program_post",
    "program_motion",
    "program.start_at",
    "program_start_at_layer",
)


@dataclass(frozen=True)
class Beginning:
    """The start of a program.

    name: main file. text: first lines. lines, files: totals. stale: labels of stale inputs.
    promises: from its preflight.
    """

    name: str
    text: str
    lines: int
    files: int
    sums: Totals
    dry: bool
    stale: tuple[str, ...]
    promises: tuple[Promise, ...]


class ProgramPanel(PreviewPanel):
    """Creates or changes a program. The preview is the text of the later program.

    OK reads the program back; until then the preflight marks this check as not done.
    """

    stage, draft = Program, "Program"

    def __init__(self, obj: Any = None) -> None:
        self.name = shape_inputs.NameChoice("" if obj is None else obj.ProgramName)
        super().__init__(
            tr("Program") if obj is None else obj.Label,
            [*shape_inputs.of(Program, obj), self.name],
            obj,
            None,
        )
        if obj is None:
            post_and_motion = suggestions.post_for(self._links()["JointPath"])
            for name, text in zip((POST, MOTION), post_and_motion, strict=True):
                if text:
                    self.places[name][0].show(text)
            self.name.widget.setText(
                rows.name_for(_part_label(), post_and_motion[0] or suggestions.usual_post())
            )
        self._add_text()
        self.places[POST][0].widget.editTextChanged.connect(self._fit_post)
        self._fit_post()

    def _fit_post(self, *_: Any) -> None:
        """Hide the parameters that the chosen post does not read, unless they have an entry."""
        post = str(self.places[POST][0].value)
        self.leave_out(
            [
                key
                for key in self.places
                if key.startswith(NC) and not catalogue.reads_nc(post, key.removeprefix(NC))
            ]
        )

    def _add_text(self) -> None:
        self.text = listing("FirstLines")
        font = self.text.font()
        font.setPointSizeF(max(MIN_FONT_PT, FONT_SCALE * self.form.font().pointSizeF()))
        self.text.setFont(font)
        self.text.setFixedHeight(HIGH * self.text.fontMetrics().lineSpacing())
        help = tr("First lines of the program to be written")
        self.text.setToolTip(help)
        self.text.setWhatsThis(help)
        self.text.hide()
        self.column.insertWidget(
            self.column.indexOf(self.messages) + (1 if self.heading is None else 2), self.text
        )
        self.preflight = PreflightList(self._go)
        self.preflight.widget.hide()
        self.column.insertWidget(self.column.indexOf(self.text) + 1, self.preflight.widget)

    def _go(self, location: Place) -> None:
        """Show the path up to the worst point of a clicked promise."""
        path = self._links()["JointPath"]
        if path is not None:
            dock.go_to(path, *location)

    def _links(self) -> dict[str, Any]:
        path = next(choice for choice in self.choices if choice is not self.name)
        return {path.link.name: path.value(), "ProgramName": self.name.widget.text().strip()}

    def _work(self, draft: Draft) -> Callable[[], tuple[Outcome, Beginning | None]]:
        job, stale = draft.stage.job(draft.obj), self._stale_inputs()
        path = draft.obj.JointPath
        read_back = self._read_back(job, path)
        promised = preflight.prepared(path.Toolpath, path, job.parameters, read_back)

        def work() -> tuple[Outcome, Beginning | None]:
            return Outcome(
                Written({}, None)
            ), None if job.parameters.post == "none" else _write_beginning(job, stale, promised)

        return work

    def _read_back(self, job: Job, path: Any) -> Any:
        """Return the `Verification` of the program if it is up to date with the entries."""
        obj = self.obj
        if (
            obj is None
            or obj.Status != UP_TO_DATE
            or obj.JointPath is not path
            or obj.ProgramName != job.name
        ):
            return None
        same = obj.Proxy.parameters(obj, ProgramParameters) == job.parameters
        return preflight.read_back_of(obj) if same else None

    def _draw(self, outcome: Outcome, drawing: Beginning | None) -> str:
        if drawing is None:
            self._draw_without()
            return tr("Without a post no file is written.")
        self.text.show()
        if self.text.toPlainText() != drawing.text:
            self.text.setPlainText(drawing.text)
        self.preflight.widget.show()
        self.preflight.show(drawing.promises)
        return "\n".join([*_lines(drawing), summary(drawing.promises), *stale_lines(drawing.stale)])

    def _draw_without(self) -> None:
        self.preflight.clear()
        self.text.clear()  # keeps its space once visible, so that fields do not move

    def _show_own(self, visible: bool) -> None:
        """Do nothing, because a program draws nothing."""

    def _locate(self, error: AmError) -> tuple[str, str]:
        """Show an error of the start under the first of its two fields."""
        return (
            (START_LAYER, translated(error.message))
            if error.where == START
            else super()._locate(error)
        )


def _write_beginning(job: Job, stale: tuple[str, ...], promised: preflight.Work) -> Beginning:
    """Write the program of a joint path and return its start. Raises the errors of writing."""
    written = posted(job)
    main = catalogue.main_file(written.files)
    lines = written.files[main].decode("latin-1").splitlines()[:SHOWN_LINES]
    times = timeline(written.motion, job.process, [layer.wait for layer in written.toolpath.layers])
    return Beginning(
        main,
        "\n".join(lines),
        sum(content.count(b"\n") for content in written.files.values()),
        len(written.files),
        totals(written.motion, times, job.process, written.toolpath),
        job.parameters.dry_run,
        stale,
        promised(),
    )


def _lines(beginning: Beginning) -> list[str]:
    sums = beginning.sums
    deposits = (
        tr("dry run without deposit") if beginning.dry else tr("mass: {:.1f} g").format(sums.mass)
    )
    return [
        tr("Begins with {}. Lines: {}, files: {}").format(
            beginning.name, beginning.lines, beginning.files
        ),
        tr("Time: {}, {}").format(wording.clock(sums.time), deposits),
    ]


def _part_label() -> str:
    """Return the label of the deposited part, preferably of the selected job."""
    for obj in [*job_selection(), *App.ActiveDocument.Objects]:
        if getattr(getattr(obj, "Proxy", None), "kind", "") == "feature" and obj.Source:
            return str(obj.Source[0].Label)
    return str(App.ActiveDocument.Label)
