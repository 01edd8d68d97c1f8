# SPDX-License-Identifier: LGPL-2.1-or-later
"""The New Machine wizard: geometry source, limits, frames and check poses, then a machine file."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics.chain import Chain
from ...core.kinematics.inverse.spherical_wrist import OpwArm
from ...core.kinematics.machines import draft as machine_draft
from ...core.kinematics.machines import pendant
from ...core.kinematics.machines.draft import Draft
from ...core.kinematics.machines.pendant import Shown
from ...core.kinematics.urdf.machine import is_mechanism
from ...objects import user_machines
from ...posts import catalogue
from ...posts.catalogue import plain
from .. import icons
from ..in_language import tr
from .figure_table import FigureTable, Page, axis_names, choice, heading
from .geometry_pages import PosesPage, SourcePage

_POSE = ["X", "Y", "Z", "roll", "pitch", "yaw"]


class FramesPage(Page):
    """Frames in mm and deg (roll, pitch, yaw, as in URDF); signs and zeros of the axes on the
    pendant.
    """

    def __init__(self, wizard: Any) -> None:
        super().__init__(
            wizard,
            "FramesPage",
            tr("Frames and conventions"),
            tr(
                "The next page compares these values with poses of your controller and points "
                "out likely errors; leave unknown values unchanged."
            ),
        )
        self.frames = FigureTable(
            "frames",
            [tr("Base"), tr("Flange")],
            _POSE,
            [
                tr(
                    "Base: the manufacturer's base frame, in which the pendant shows positions, "
                    "relative to the floor plate. FANUC places it at the height of axis 2. "
                    "Flange: in the last link, with Z out of the plate. Rotation: about X, then "
                    "Y, then Z."
                )
            ]
            * 6,
        )
        self.column.addWidget(
            heading(
                tr(
                    "Frames (mm, deg): the manufacturer's base on the floor, the flange in the "
                    "last link"
                )
            )
        )
        self.column.addWidget(self.frames.widget)
        self.axes = FigureTable("axes", [tr("Sign"), tr("Shows at zero")], ["J1"])
        self.column.addWidget(
            heading(tr("Axes on the pendant: -1 if the axis is reversed; the value shown at zero"))
        )
        self.column.addWidget(self.axes.widget)
        self.coupling = choice(
            "coupling",
            [
                (tr("Axis 3 is shown relative to link 2, unchanged"), pendant.NONE),
                (
                    tr("Axis 3 is shown relative to the horizontal (FANUC, some ABB)"),
                    pendant.HORIZONTAL,
                ),
            ],
        )
        self.column.addWidget(self.coupling)
        self.range = FigureTable(
            "horizontal",
            [tr("J3 as shown")],
            [tr("From"), tr("To")],
            [
                tr(
                    "Limits from the data sheet; leave unknown limits empty. The limits on the "
                    "previous page are relative to link 2."
                )
            ]
            * 2,
        )
        self.column.addWidget(self.range.widget)
        self.column.addStretch(1)
        self.coupling.currentIndexChanged.connect(self._follow)
        for table in (self.frames, self.axes, self.range):
            table.widget.setSizePolicy(QtGui.QSizePolicy.Expanding, QtGui.QSizePolicy.Fixed)

    def _follow(self, *_: Any) -> None:
        self.range.widget.setVisible(self.coupling.currentData() == pendant.HORIZONTAL)

    def fill(self) -> None:
        """Show the draft."""
        draft = self.owner.draft
        poses = np.stack((draft.base, draft.chain.flange))
        rpy = np.degrees(-frames.to_bryant(np.swapaxes(poses[:, :3, :3], 1, 2)))
        self.frames.fill(np.round(np.column_stack((poses[:, :3, 3], rpy)), 9) + 0.0)
        self.axes.set_shape([tr("Sign"), tr("Shows at zero")], axis_names(self.owner))
        self.axes.fill([draft.shown.signs, draft.shown.zeros])
        self.coupling.setVisible(draft.chain.axes == 6)
        self.coupling.setCurrentIndex(max(0, self.coupling.findData(draft.shown.coupling)))
        self.range.fill([draft.horizontal or (np.nan, np.nan)])
        self._follow()

    def take(self) -> None:
        """Store the entries in the draft; require the closed form."""
        draft = self.owner.draft
        base, flange = (
            frames.from_rpy(line[:3], np.radians(line[3:])) for line in self.frames.figures()
        )
        signs, zeros = self.axes.figures()
        for column, sign in enumerate(signs.tolist()):
            if sign not in (1.0, -1.0):
                name = self.axes.widget.horizontalHeaderItem(column).text()
                raise InputError("BAD_VALUE", f"{name}, {tr('Sign')}", tr("use 1 or -1"))
        coupling = str(self.coupling.currentData())
        horizontal = None
        if coupling == pendant.HORIZONTAL:
            lower, upper = self.range.row(0, blank=True).tolist()
            if np.isnan(lower) != np.isnan(upper) or lower >= upper:
                raise InputError(
                    "BAD_VALUE",
                    tr("J3 as shown"),
                    tr("enter the lower end first, or leave both empty"),
                )
            horizontal = None if np.isnan(lower) else (lower, upper)
        chain = Chain(draft.chain.origins, draft.chain.directions, flange, draft.chain.sliding)
        draft = replace(
            draft,
            chain=chain,
            base=base,
            horizontal=horizontal,
            shown=Shown(tuple(int(sign) for sign in signs), tuple(zeros.tolist()), coupling),
        )
        machine_draft.closed_form(draft)
        self.owner.draft = draft


class NamePage(Page):
    """The name page, whose Finish writes the file."""

    def __init__(self, wizard: Any) -> None:
        super().__init__(
            wizard,
            "NamePage",
            tr("Name and posts"),
            tr(
                "The machine is saved in the folder of your own machines; cells and jobs refer "
                "to it by this name."
            ),
        )
        form = QtGui.QFormLayout()
        self.title_of = self._line(form, "machineTitle", tr("Manufacturer and model"))
        self.name = self._line(form, "machineName", tr("Name in jobs"))
        self.source = self._line(form, "poseSource", tr("Source of the check poses"))
        self.source.setPlaceholderText(
            tr("such as: pendant of R-30iB, 21 November; or a simulator with its version")
        )
        self.remark = self._line(form, "remark", tr("Remarks"))
        self.posts = {}
        rows = QtGui.QGridLayout()
        for number, name in enumerate(catalogue.NAMES):
            self.posts[name] = QtGui.QCheckBox(name)
            self.posts[name].setObjectName(f"post_{name}")
            rows.addWidget(self.posts[name], number // 4, number % 4)
        rows.setColumnStretch(4, 1)
        form.addRow(tr("Its controller reads"), rows)
        self.column.addLayout(form)
        self.summary = self.add_text("")
        self.summary.setObjectName("summary")
        self.column.addStretch(1)
        self.proposed = ""
        self.title_of.textChanged.connect(self._propose)

    def _line(self, form: Any, name: str, label: str) -> Any:
        line = QtGui.QLineEdit()
        line.setObjectName(name)
        form.addRow(label, line)
        return line

    def _propose(self, *_: Any) -> None:
        """Derive a name from the title, unless the user typed one."""
        if self.name.text() == self.proposed:
            self.proposed = re.sub(r"[^a-z0-9]+", "-", plain(self.title_of.text()).lower()).strip(
                "-"
            )
            self.name.setText(self.proposed)

    def fill(self) -> None:
        """Show the draft."""
        draft = self.owner.draft
        self.name.setText(draft.id)
        self.proposed = draft.id
        self.title_of.setText(draft.title)
        if draft.id:
            self.name.setText(draft.id)
        self.source.setText(draft.sources[0] if self.owner.copied else "")
        for name, box in self.posts.items():
            box.setChecked(name in (draft.posts or ()))

    def initializePage(self) -> None:
        """Called by Qt when the page opens."""
        super().initializePage()
        arm = machine_draft.closed_form(self.owner.draft)
        if arm is None:
            self.summary.setText(
                tr("Equipment next to a robot: a cell uses it as external axes.")
                if is_mechanism(self.owner.draft.chain)
                else tr("Three prismatic and two revolute axes.")
            )
            return
        if not isinstance(arm, OpwArm):
            self.summary.setText(tr("Six revolute axes, without a spherical wrist."))
            return
        lengths = "   ".join(
            f"{name} {getattr(arm, name):.6g}" for name in ("a1", "a2", "b", "c1", "c2", "c3", "c4")
        )
        self.summary.setText(tr("Closed form (mm): {}").format(lengths))

    def take(self) -> None:
        """Write the machine file."""
        draft, source = self.owner.draft, self.source.text().strip()
        title = self.title_of.text().strip()
        if not title:
            raise InputError(
                "BAD_NAME",
                tr("Manufacturer and model"),
                tr("the field is empty; give manufacturer and model"),
            )
        sources = tuple(dict.fromkeys((*self.owner.geometry_sources, f"check poses: {source}")))
        draft = replace(
            draft,
            id=self.name.text().strip(),
            title=title,
            sources=sources,
            remarks=tuple(filter(None, [self.remark.text().strip()])),
            posts=tuple(name for name, box in self.posts.items() if box.isChecked()),
        )
        try:
            text = machine_draft.text(draft)
        except InputError as error:
            raise (
                InputError(error.code, tr("Name in jobs"), error.message)
                if error.where == "id"
                else error
            ) from None
        if not source:
            raise InputError(
                "NO_INPUT",
                tr("Source of the check poses"),
                tr("the field is empty; a machine file is only as reliable as its check poses"),
            )
        self.owner.saved = user_machines.save(draft.id, text)
        self.owner.draft = draft


class LimitsPage(Page):
    """One row per axis. An empty range means a continuous axis; other empty cells are unknown."""

    def __init__(self, wizard: Any) -> None:
        super().__init__(
            wizard,
            "LimitsPage",
            tr("Limits, speeds, accelerations and jerks"),
            tr(
                "For serial angles: each axis relative to the previous link. Revolute axes in "
                "deg, deg/s, deg/s² and deg/s³, prismatic ones in mm, mm/s, mm/s² and mm/s³. "
                "Leave both ends of a range empty for a continuous axis; leave unknown speeds, "
                "accelerations and jerks empty."
            ),
        )
        self.table = FigureTable("limits", ["J1"], _heads())
        self.column.addWidget(self.table.widget)
        self.notes = self.add_text("")
        self.column.addStretch(1)

    def fill(self) -> None:
        """Show the values of the source."""
        draft = self.owner.draft
        names = axis_names(self.owner)
        self.table.set_shape(names, _heads())
        values = np.column_stack(
            (draft.lower, draft.upper, draft.max_speed, draft.max_acceleration, draft.max_jerk)
        )
        # URDF values in rad are rarely whole degrees in their last digits
        self.table.fill(np.round(values / draft.units[:, None], 6))
        self.notes.setText("\n".join(draft.notes))

    def take(self) -> None:
        """Store the limits in the draft."""
        draft = self.owner.draft
        values = self.table.figures(blank=True)
        for row, (lower, upper, *rates) in enumerate(values.tolist()):
            name = self.table.widget.verticalHeaderItem(row).text()
            if np.isnan(lower) != np.isnan(upper):
                raise InputError(
                    "BAD_VALUE",
                    name,
                    tr("enter both ends of the range, or neither for a continuous axis"),
                )
            if lower >= upper:
                raise InputError(
                    "BAD_VALUE",
                    name,
                    tr("{} is not below {}; enter the smaller end first").format(
                        f"{lower:g}", f"{upper:g}"
                    ),
                )
            if draft.chain.sliding[row] and np.isnan(lower):
                raise InputError(
                    "BAD_VALUE", name, tr("a prismatic axis needs a range; enter both ends")
                )
            if any(rate <= 0.0 for rate in rates):
                raise InputError(
                    "BAD_VALUE",
                    name,
                    tr(
                        "enter positive values for speed, acceleration and jerk, or leave the "
                        "fields empty"
                    ),
                )
        values = (
            np.where(np.isnan(values), [-np.inf, np.inf, np.inf, np.inf, np.inf], values)
            * draft.units[:, None]
        )
        self.owner.draft = replace(
            draft,
            lower=values[:, 0],
            upper=values[:, 1],
            max_speed=values[:, 2],
            max_acceleration=values[:, 3],
            max_jerk=values[:, 4],
        )


def _heads() -> list[str]:
    return [tr("From"), tr("To"), tr("Speed"), tr("Acceleration"), tr("Jerk")]


_open: list[Any] = []


class MachineWizard(QtGui.QWizard):
    """The pages, and the draft that they fill. Nothing is written before Finish."""

    def __init__(self) -> None:
        super().__init__(Gui.getMainWindow())
        self.draft: Draft | None = None
        self.origin: object = None  # a new object for each source
        self.geometry_sources: tuple[str, ...] = ()
        self.copied = False  # whether the draft has the check poses of another machine
        self.saved = ""
        self.setObjectName("RoboticAM_NewMachine")
        self.setWindowTitle(tr("New machine"))
        self.setWindowIcon(QtGui.QIcon(icons.path("new_machine")))
        self.setWizardStyle(QtGui.QWizard.ModernStyle)
        self.setOption(QtGui.QWizard.NoBackButtonOnStartPage, True)
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.source_page = SourcePage(self)
        self.limits_page = LimitsPage(self)
        self.frames_page = FramesPage(self)
        self.poses_page = PosesPage(self)
        self.name_page = NamePage(self)
        for page in (
            self.source_page,
            self.limits_page,
            self.frames_page,
            self.poses_page,
            self.name_page,
        ):
            self.addPage(page)
        self.resize(980, 680)
        self.finished.connect(self._closed)

    def begin(self, draft: Draft) -> None:
        """Reset for another source, because earlier entries belong to another machine."""
        self.draft = draft
        self.origin = object()
        self.geometry_sources = draft.sources
        self.copied = draft.values is not None

    def reject(self) -> None:
        """Handle Cancel, Esc and the close button; ask before entries are lost."""
        if not self._entered() or self._confirm_discard():
            super().reject()

    def _entered(self) -> bool:
        """Whether closing would lose entries."""
        return self.draft is not None or self.source_page.has_entries()

    def _confirm_discard(self) -> bool:
        box = QtGui.QMessageBox
        answer = box.question(
            self,
            tr("New machine"),
            tr("Close without saving a machine file? All entries are lost."),
            box.Discard | box.Cancel,
            box.Cancel,
        )
        return bool(answer == box.Discard)

    def keyPressEvent(self, event: Any) -> None:
        """Let Enter in a field finish the field, not the page."""
        if event.key() not in (QtCore.Qt.Key_Return, QtCore.Qt.Key_Enter):
            super().keyPressEvent(event)

    def _closed(self, *_: Any) -> None:
        if self.saved:
            App.Console.PrintMessage(
                tr("Machine {} was saved: {}").format(self.draft.id, self.saved) + "\n"
            )
        if self in _open:
            _open.remove(self)


def show() -> Any:
    """Open the wizard, or raise the open wizard."""
    if not _open:
        _open.append(MachineWizard())
    _open[0].show()
    _open[0].raise_()
    _open[0].activateWindow()
    return _open[0]
