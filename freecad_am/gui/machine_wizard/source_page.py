# SPDX-License-Identifier: LGPL-2.1-or-later
"""The first page: where the geometry comes from."""

from __future__ import annotations

import contextlib
import os
from dataclasses import replace
from typing import Any

import numpy as np
from PySide import QtGui

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics.inverse import opw_recognition
from ...core.kinematics.inverse.opw import OpwArm
from ...core.kinematics.machines import denavit_hartenberg, machine
from ...core.kinematics.machines import draft as machine_draft
from ...core.kinematics.machines.draft import Draft
from ...core.kinematics.urdf import machine as urdf_machine
from ...core.kinematics.urdf.cell import UrdfCell
from ...core.kinematics.urdf.read import Urdf
from ...core.kinematics.urdf.reference import reference
from ...core.parameters.cell_records import ROBOT
from ...objects import user_machines
from ..in_language import tr
from .figure_table import FigureTable, Page, choice, error_text

LENGTHS = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
MOST_AXES = 6


class SourcePage(Page):
    """Page that creates the draft again if the source changes."""

    def __init__(self, wizard: Any) -> None:
        super().__init__(
            wizard,
            "SourcePage",
            tr("Source of the geometry"),
            tr(
                "Lengths are in mm, angles in degrees. Robots need six revolute axes, machine "
                "tools three prismatic and two revolute axes; the wizard checks this when you "
                "continue. Tracks, turntables and positioners next to a robot have one axis or "
                "two."
            ),
        )
        self.kind = choice(
            "source",
            [
                (tr("A URDF file"), "urdf"),
                (tr("A table of Denavit and Hartenberg"), "table"),
                (tr("Dimensions of an arm with a spherical wrist (OPW)"), "opw"),
                (tr("A copy of another machine"), "copy"),
            ],
        )
        self.column.addWidget(self.kind)
        self.stack = QtGui.QStackedWidget()
        for make in (self._urdf_form, self._table_form, self._opw_form, self._copy_form):
            self.stack.addWidget(make())
        self.column.addWidget(self.stack, 1)
        self.kind.currentIndexChanged.connect(self._turn)
        self.robot: Urdf | None = None
        self.taken: str | None = None
        self.first = self._entered()

    def has_entries(self) -> bool:
        """Whether anything was entered."""
        return self._entered() != self.first

    def _turn(self, index: int) -> None:
        self.stack.setCurrentIndex(index)
        self.say("")

    # ---- forms

    def _urdf_form(self) -> Any:
        form = QtGui.QWidget()
        rows = QtGui.QFormLayout(form)
        line = QtGui.QHBoxLayout()
        self.file = QtGui.QLineEdit()
        self.file.setObjectName("file")
        browse = QtGui.QPushButton(tr("Browse…"))
        browse.setObjectName("browse")
        browse.setAutoDefault(False)
        browse.clicked.connect(self._browse)
        line.addWidget(self.file, 1)
        line.addWidget(browse)
        rows.addRow(tr("File"), line)
        self.mechanism, self.mechanism_row = (
            choice("mechanism", []),
            QtGui.QLabel(tr("Part of the cell")),
        )
        self.mechanism.setToolTip(tr("Mechanisms in the file; each gets its own machine file"))
        rows.addRow(self.mechanism_row, self.mechanism)
        self.mechanism.currentIndexChanged.connect(self._choose_mechanism)
        self.mechanisms: list[tuple[str, Any, str]] = []
        self.base, self.tip = choice("baseLink", []), choice("tipLink", [])
        self.base.setToolTip(tr("The fixed link"))
        self.tip.setToolTip(
            tr("The flange link, with Z out of the flange: tool0 in ROS-Industrial files")
        )
        rows.addRow(tr("From link"), self.base)
        rows.addRow(tr("To link"), self.tip)
        self.file.textChanged.connect(self._look)
        self.base.currentIndexChanged.connect(self._offer_tips)
        for widget in (self.mechanism, self.mechanism_row):
            widget.hide()
        return form

    def _table_form(self) -> Any:
        form = QtGui.QWidget()
        column = QtGui.QVBoxLayout(form)
        column.setContentsMargins(0, 0, 0, 0)
        self.craig = choice(
            "tableKind",
            [
                (tr("Standard: Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha)"), False),
                (tr("Modified (Craig): Rot(x, alpha) Trans(x, a) Rot(z, theta) Trans(z, d)"), True),
            ],
        )
        self.rows = FigureTable(
            "dhTable",
            [f"J{number}" for number in range(1, MOST_AXES + 1)],
            ["theta", "d", "a", "alpha", tr("sign"), tr("slides")],
            [
                tr("Angle added to the joint angle, deg"),
                tr("Offset along z, mm"),
                tr("Length along x, mm"),
                tr("Twist about x, deg"),
                tr("1, or -1 if the joint moves the other way"),
                tr(
                    "0, or 1 if the joint slides along z: a five-axis machine has three such joints"
                ),
            ],
        )
        self.rows.fill([[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]] * MOST_AXES)
        self.ends = FigureTable(
            "dhEnds",
            [tr("Before"), tr("After")],
            ["X", "Y", "Z", "roll", "pitch", "yaw"],
            [
                tr(
                    "Frame of the first row in the base, and flange in the frame of the last "
                    "row. mm and deg; about X first, then Y, then Z of the outer frame."
                )
            ]
            * 6,
        )
        self.ends.fill(np.zeros((2, 6)))
        column.addWidget(self.craig)
        column.addWidget(self.rows.widget)
        column.addWidget(
            QtGui.QLabel(
                tr("Poses before the first row and after the last row, if the table has them")
            )
        )
        column.addWidget(self.ends.widget)
        column.addStretch(1)
        return form

    def _opw_form(self) -> Any:
        form = QtGui.QWidget()
        column = QtGui.QVBoxLayout(form)
        column.setContentsMargins(0, 0, 0, 0)
        note = QtGui.QLabel(
            tr(
                "Axis 2 is a1 ahead of axis 1 and c1 above the base; c2 to axis 3; axis 4 is a2 from axis 3 (negative: above "
                "it), b to the side; c3 to the wrist centre, c4 to the flange. The angle of the arm is q · sign - offset; at "
                "zero it stretches straight up."
            )
        )
        note.setWordWrap(True)
        self.lengths = FigureTable("opwLengths", ["mm"], LENGTHS)
        self.lengths.fill(np.zeros((1, 7)))
        self.turns = FigureTable(
            "opwTurns", [tr("Offset (deg)"), tr("Sign")], [f"J{number}" for number in range(1, 7)]
        )
        self.turns.fill([[0, 0, -90, 0, 0, 0], [1] * 6])
        for widget in (note, self.lengths.widget, self.turns.widget):
            column.addWidget(widget)
        column.addStretch(1)
        return form

    def _copy_form(self) -> Any:
        form = QtGui.QWidget()
        rows = QtGui.QFormLayout(form)
        entries = machine.known(user_machines.folders())
        self.original = choice(
            "original", [(f"{title}  ({name})", name) for name, title in entries]
        )
        self.original.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.original.setMinimumContentsLength(30)
        rows.addRow(tr("Machine"), self.original)
        return form

    # ---- URDF

    def _browse(self, *_: Any) -> None:
        answer = QtGui.QFileDialog.getOpenFileName(
            self, tr("URDF file"), self.file.text(), "URDF (*.urdf *.xml)"
        )
        if answer and answer[0]:
            self.file.setText(answer[0])

    def _look(self, *_: Any) -> None:
        """Offer the links of the file, once there is one."""
        self.robot = None
        self.base.clear()
        self.say("")
        path = self.file.text().strip()
        if os.path.isfile(path):
            try:
                self.robot = Urdf(path)
                self.base.addItems(self.robot.bases())
            except InputError as error:
                self.say(error_text(error))
        self._offer_mechanisms()

    def _offer_mechanisms(self) -> None:
        """Robot, track and positioner of a file that has more than a robot; the robot is proposed."""
        self.mechanisms = []
        if self.robot is not None:
            with contextlib.suppress(InputError):  # no whole cell: links are chosen one by one
                cell = UrdfCell(self.robot.path)
                self.mechanisms = [(tr("Robot"), cell.machine(), "")] + [
                    (
                        tr("Track") if mechanism.carries == ROBOT else tr("Positioner"),
                        reference(mechanism.machine),
                        f"{mechanism.where()} carries {mechanism.carries}",
                    )
                    for mechanism in cell.external()
                ]
        several = len(self.mechanisms) > 1
        self.mechanism.clear()
        self.mechanism.addItems([name for name, _, _ in self.mechanisms] if several else [])
        for widget in (self.mechanism, self.mechanism_row):
            widget.setVisible(several)

    def _choose_mechanism(self, index: int) -> None:
        """The links of the mechanism that is chosen."""
        if index >= 0:
            _, ends, _ = self.mechanisms[index]
            for box, link in ((self.base, ends.base), (self.tip, ends.tip)):
                box.setCurrentIndex(box.findText(link))

    def _stands(self) -> str:
        """Return the location of the mechanism of these links in the file's cell; '' if unknown."""
        links = self.base.currentText(), self.tip.currentText()
        return next(
            (where for _, ends, where in self.mechanisms if (ends.base, ends.tip) == links), ""
        )

    def _offer_tips(self, *_: Any) -> None:
        self.tip.clear()
        if self.robot is not None and self.base.count():
            with contextlib.suppress(InputError):  # Next reports a chain that carries itself
                self.tip.addItems(self.robot.tips(self.base.currentText()))

    # ---- the draft

    def take(self) -> None:
        """Make the draft. Entries on later pages stay if the source is unchanged."""
        entered = self._entered()
        if entered == self.taken and self.owner.draft is not None:
            return
        draft = {
            "urdf": self._draft_of_urdf,
            "table": self._draft_of_table,
            "opw": self._draft_of_opw,
            "copy": self._draft_of_copy,
        }[self.kind.currentData()]()
        try:
            machine_draft.closed_form(draft)
        except InputError as error:
            if error.where != opw_recognition.FLANGE:  # which has a page of its own
                raise
        self.taken = entered
        self.owner.begin(draft)

    def _entered(self) -> str:
        """Return all entries that identify the source."""
        tables = [
            [
                table.text(row, column)
                for row in range(table.widget.rowCount())
                for column in range(table.widget.columnCount())
            ]
            for table in (self.rows, self.ends, self.lengths, self.turns)
        ]
        file = self.file.text().strip()
        stamp = os.path.getmtime(file) if os.path.isfile(file) else 0.0
        return repr(
            [
                self.kind.currentData(),
                file,
                stamp,
                self.base.currentText(),
                self.tip.currentText(),
                self.craig.currentData(),
                self.original.currentData(),
                tables,
            ]
        )

    def _draft_of_urdf(self) -> Draft:
        path = self.file.text().strip()
        if not path:
            raise InputError("NO_INPUT", tr("File"), tr("choose a URDF file"))
        self.robot = self.robot or Urdf(path)
        if not self.tip.count():
            reason = tr("no link is carried by {}").format(self.base.currentText())
            raise InputError("BAD_URDF", os.path.basename(path), reason)
        ends = self.robot, self.base.currentText(), self.tip.currentText()
        described = self.robot.between(*ends[1:])
        if urdf_machine.is_mechanism(described.chain):
            described = urdf_machine.external_chain(*ends)
        draft = machine_draft.draft_of_description(
            described,
            f"URDF {os.path.basename(path)}, {self.base.currentText()} to {self.tip.currentText()}",
        )
        if not self._stands():
            return draft
        stands = tr(
            "External axes of the robot in this file, in its base frame, as named in a cell: "
            "NAME {}"
        ).format(self._stands())
        return replace(draft, notes=(*draft.notes, stands))

    def _draft_of_table(self) -> Draft:
        count = max(
            (row + 1 for row in range(MOST_AXES) if self.rows.has_entries(row, 4)), default=0
        )
        rows = []
        for number in range(count):
            theta, d, a, alpha, sign, slides = self.rows.row(number).tolist()
            if sign not in (1.0, -1.0):
                raise InputError("BAD_VALUE", f"J{number + 1}, {tr('sign')}", tr("use 1 or -1"))
            if slides not in (0.0, 1.0):
                raise InputError("BAD_VALUE", f"J{number + 1}, {tr('slides')}", tr("use 0 or 1"))
            rows.append(
                denavit_hartenberg.Row(
                    np.radians(theta), d, a, np.radians(alpha), int(sign), bool(slides)
                )
            )
        base_pose, flange_pose = (
            frames.from_rpy(line[:3], np.radians(line[3:])) for line in self.ends.figures()
        )
        craig = bool(self.craig.currentData())
        chain = denavit_hartenberg.chain_of(
            denavit_hartenberg.Table(tuple(rows), base_pose, flange_pose, craig)
        )
        return machine_draft.draft_of_chain(
            chain, f"{'modified' if craig else 'standard'} Denavit-Hartenberg table, as entered"
        )

    def _draft_of_opw(self) -> Draft:
        lengths = dict(zip(LENGTHS, self.lengths.row(0).tolist(), strict=True))
        offsets, signs = self.turns.figures()
        for number, sign in enumerate(signs.tolist(), 1):
            if sign not in (1.0, -1.0):
                raise InputError("BAD_VALUE", f"J{number}, {tr('Sign')}", tr("use 1 or -1"))
        arm = OpwArm(
            **lengths,
            offsets=tuple(np.radians(offsets).tolist()),
            signs=tuple(int(sign) for sign in signs),
        )
        return machine_draft.draft_of_chain(
            opw_recognition.chain_of(arm), "closed-form figures, as entered"
        )

    def _draft_of_copy(self) -> Draft:
        return machine_draft.draft_of_machine(
            str(self.original.currentData()), user_machines.folders()
        )
