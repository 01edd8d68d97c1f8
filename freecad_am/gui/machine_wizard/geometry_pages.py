# SPDX-License-Identifier: LGPL-2.1-or-later
"""The geometry pages: the source of the geometry, and check poses that verify it."""

from __future__ import annotations

import contextlib
import math
import os
from dataclasses import replace
from typing import Any

import numpy as np
from PySide import QtGui

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics.chain import Chain
from ...core.kinematics.inverse import opw_recognition
from ...core.kinematics.inverse.spherical_wrist import OpwArm
from ...core.kinematics.machines import denavit_hartenberg, machine, pendant
from ...core.kinematics.machines import draft as machine_draft
from ...core.kinematics.machines.draft import (
    CONVENTIONS,
    QUATERNION,
    Draft,
    figures_of,
    flange_poses,
)
from ...core.kinematics.machines.pendant import Deviation, Suspect
from ...core.kinematics.urdf import machine as urdf_machine
from ...core.kinematics.urdf.cell import UrdfCell
from ...core.kinematics.urdf.read import Urdf
from ...core.kinematics.urdf.reference import reference
from ...core.parameters.cell_records import ROBOT
from ...core.types import Array
from ...objects import user_machines
from ..colours import GOOD, INVALID, PLAIN, set_role
from ..in_language import tr
from ..worker import Later
from .figure_table import FigureTable, Page, axis_names, choice, error_text, format_figure, heading

# ---- The first page: source of the geometry

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
                "tools three prismatic and two revolute axes; the wizard checks the axes when "
                "you continue. Tracks, turntables and positioners next to a robot have one or "
                "two axes."
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
        """Offer the links of the file if it exists."""
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
        """Offer robot, track and positioner of a file with more than a robot; the robot is
        preselected.
        """
        self.mechanisms = []
        if self.robot is not None:
            with contextlib.suppress(InputError):  # not a whole cell: links are selected one by one
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
        """Select the links of the chosen mechanism."""
        if index >= 0:
            _, ends, _ = self.mechanisms[index]
            for box, link in ((self.base, ends.base), (self.tip, ends.tip)):
                box.setCurrentIndex(box.findText(link))

    def _stands(self) -> str:
        """Return the location of the mechanism of the selected links in the file's cell; '' if
        unknown.
        """
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
        """Create the draft. Entries on later pages stay if the source is unchanged."""
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
            if error.where != opw_recognition.FLANGE:  # the flange has its own page
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


# ---- Check poses typed from the pendant: deviations of the machine and likely errors

MIN_POSES, INITIAL_ROWS = 3, 5  # minimum number of poses, initial number of rows


class PosesPage(Page):
    """A row per pose: joints and position as the controller shows them, then the deviations."""

    def __init__(self, wizard: Any) -> None:
        super().__init__(
            wizard,
            "PosesPage",
            tr("Check poses"),
            tr(
                "Jog the machine to at least three poses in which every axis has moved, and "
                "enter the values on the pendant: the joints, and the pose of the tool frame in "
                "the base frame. The manufacturer's simulator works as well; values computed "
                "from this geometry prove nothing. You can paste a table."
            ),
        )
        self.convention = choice(
            "convention",
            [(f"{figures}   {who}", name) for name, (figures, who) in CONVENTIONS.items()],
        )
        self.column.addWidget(self.convention)
        self.zero = self.add_text("")
        self.table = FigureTable("poses", ["1"], ["J1"])
        self.column.addWidget(self.table.widget)
        buttons = QtGui.QHBoxLayout()
        self.more = QtGui.QPushButton(tr("Add a row"))
        self.more.setObjectName("moreRows")
        self.more.setAutoDefault(False)
        self.more.clicked.connect(self._add_row)
        buttons.addWidget(self.more)
        buttons.addStretch(1)
        self.column.addLayout(buttons)
        self.column.addWidget(
            heading(
                tr("Tool frame of the pendant on the flange (mm, deg); zeros for the flange itself")
            )
        )
        self.tool = FigureTable("tool", [tr("Tool")], ["X", "Y", "Z", "roll", "pitch", "yaw"])
        self.tool.fill(np.zeros((1, 6)))
        self.column.addWidget(self.tool.widget)
        self.verdict = self.add_text("")
        self.verdict.setObjectName("verdict")
        self.suspects: list[Suspect] = []
        self.offers = QtGui.QVBoxLayout()
        self.column.addLayout(self.offers)
        self.column.addStretch(1)
        self.later = Later(self, self.judge)
        for table in (self.table, self.tool):
            table.widget.itemChanged.connect(self.later.ask)
        self.convention.currentIndexChanged.connect(self._convention_changed)

    @property
    def axes(self) -> int:
        """Number of joint columns."""
        return int(self.owner.draft.chain.axes)

    @property
    def width(self) -> int:
        """Number of typed columns."""
        return self.axes + 3 + len(self._angles())

    def _angles(self) -> list[str]:
        return CONVENTIONS[str(self.convention.currentData())][0].split()

    # ---- display

    def fill(self) -> None:
        """Show empty rows, the first at the serial zeros, or the poses of the copied machine."""
        draft = self.owner.draft
        count = INITIAL_ROWS if draft.values is None else len(draft.values)
        self.table.widget.setRowCount(0)
        self._head(count)
        if draft.values is None:
            for column, value in enumerate(draft.shown.zeros):
                self.table.show(0, column, format_figure(value))
        else:
            in_base = frames.inverse(draft.base) @ draft.poses
            figures = figures_of(str(self.convention.currentData()), in_base)
            for row, line in enumerate(np.column_stack((draft.values, figures)).tolist()):
                for column, value in enumerate(line):
                    self.table.show(row, column, format_figure(round(value, 9)))

    def _head(self, rows: int) -> None:
        columns = [*axis_names(self.owner), "X", "Y", "Z", *self._angles(), "Δ mm", "Δ deg"]
        self.table.set_shape([str(number) for number in range(1, rows + 1)], columns)
        if len(self._angles()) == 4:  # quaternions need more decimals than angles
            self.table.widen(range(self.axes + 3, self.axes + 7), "-0.000000")
        self.table.lock(len(columns) - 2, len(columns) - 1)

    def _add_row(self, *_: Any) -> None:
        self._head(self.table.widget.rowCount() + 1)

    def _convention_changed(self, *_: Any) -> None:
        """Show the columns of another angle convention; the typed numbers stay."""
        if self.owner.draft is not None and self.filled_with is not None:
            self.table.widget.blockSignals(True)
            for row in range(self.table.widget.rowCount()):
                for column in range(self.axes + 6, self.table.widget.columnCount()):
                    self.table.widget.takeItem(row, column)
            self._head(self.table.widget.rowCount())
            self.table.widget.blockSignals(False)
            self.later.ask()

    def initializePage(self) -> None:
        """Called by Qt when the page opens; poses stay, and deviations use the current conventions."""
        super().initializePage()
        zeros = ", ".join(format_figure(value) for value in self.owner.draft.shown.zeros)
        self.zero.setText(
            tr("One pose must be at the serial zeros, where the controller shows {}.").format(zeros)
        )
        self.judge()

    # ---- entries

    def _entered(self, require_complete: bool) -> tuple[Array, Array, list[int]]:
        """Return joints (n, axes) as shown, flange poses (n, 4, 4) in base_link, and their rows.

        Incomplete rows are skipped. With `require_complete`, InputError names the missing number
        instead.
        """
        draft, values, figures, rows = self.owner.draft, [], [], []
        for row in range(self.table.widget.rowCount()):
            if not any(self.table.text(row, column) for column in range(self.axes, self.width)):
                continue
            try:
                line = self.table.row(row, self.width)
            except InputError:
                if require_complete:
                    raise
                continue
            if not line[self.axes + 3 :].any() and str(self.convention.currentData()) == QUATERNION:
                raise InputError(
                    "BAD_VALUE",
                    tr("Pose {}").format(row + 1),
                    tr(
                        "a quaternion cannot be all zeros; enter the quaternion shown on the "
                        "controller"
                    ),
                )
            values.append(line[: self.axes])
            figures.append(line[self.axes :])
            rows.append(row)
        tool = self.tool.row(0)
        if not rows:
            return np.zeros((0, self.axes)), np.zeros((0, 4, 4)), rows
        on_flange = frames.from_rpy(tool[:3], np.radians(tool[3:]))
        poses = flange_poses(
            str(self.convention.currentData()), np.stack(figures), draft.base, on_flange
        )
        return np.stack(values), poses, rows

    def take(self) -> None:
        """Store the poses in the draft if the machine reproduces them."""
        draft = self.owner.draft
        values, poses, rows = self._entered(require_complete=True)
        if len(rows) < MIN_POSES:
            raise InputError(
                "NO_POSES",
                tr("Check poses"),
                tr(
                    "only {} poses are entered, but a machine file needs at least {}; enter more "
                    "poses"
                ).format(len(rows), MIN_POSES),
            )
        if not np.isclose(values, draft.shown.zeros, atol=1e-9).all(axis=1).any():
            raise InputError(
                "NO_POSES",
                tr("Check poses"),
                tr("the pose at the serial zeros is missing; enter this pose too"),
            )
        if np.ptp(values, axis=0).min() < 1.0:
            still = axis_names(self.owner)[int(np.argmin(np.ptp(values, axis=0)))]
            raise InputError(
                "NO_POSES",
                still,
                tr("the axis has the same value in all poses; add a pose with another value"),
            )
        if not pendant.fits(pendant.deviations(draft.chain, draft.shown, values, poses)):
            raise InputError(
                "MISSED",
                tr("Check poses"),
                tr("the machine does not reproduce the poses; see the deviations"),
            )
        self.owner.draft = replace(draft, values=values, poses=poses)

    # ---- verdict

    def judge(self) -> None:
        """Show the deviations and likely errors."""
        draft = self.owner.draft
        self._clear_offers()
        self.say("")
        try:
            values, poses, rows = self._entered(require_complete=False)
        except InputError as error:
            self._show_verdict(error_text(error), INVALID)
            return
        self.table.widget.blockSignals(True)
        for row in range(self.table.widget.rowCount()):
            for column in (self.width, self.width + 1):
                self.table.show(row, column, "")
        deviations = pendant.deviations(draft.chain, draft.shown, values, poses) if rows else []
        for row, deviation in zip(rows, deviations, strict=True):
            self._show_deviation(row, deviation)
        self.table.widget.blockSignals(False)
        if not rows:
            self._show_verdict("", None)
        elif pendant.fits(deviations):
            worst = max(deviations, key=lambda deviation: deviation.position)
            text = tr("The machine reproduces all {} poses, within {} mm.").format(
                len(rows), f"{worst.position:.3g}"
            )
            if draft.shown.coupling == pendant.HORIZONTAL and draft.horizontal is None:
                text += " " + tr("The limits of J3 as shown can be entered on the previous page.")
            self._show_verdict(text, GOOD)
        else:
            self.suspects = pendant.suspects(draft.chain, draft.shown, values, poses)
            self._show_verdict(self._reason(len(rows)), INVALID)
            self._offer()

    def _reason(self, count: int) -> str:
        if count < MIN_POSES:
            return tr(
                "The machine does not reproduce these poses; enter at least three poses to "
                "locate the error."
            )
        if self.suspects:
            return tr("The machine does not reproduce these poses. Possible causes:")
        return tr(
            "The machine does not reproduce these poses, and no single sign, zero, coupling or "
            "frame explains the deviation. Check for typing errors, the angle convention, the "
            "tool frame, and lengths."
        )

    def _show_deviation(self, row: int, deviation: Deviation) -> None:
        for column, value, tolerance in (
            (self.width, deviation.position, pendant.TOLERANCE_MM),
            (self.width + 1, deviation.angle, pendant.TOLERANCE_DEG),
        ):
            self.table.show(row, column, f"{value:.3f}", GOOD if value <= tolerance else INVALID)

    def _show_verdict(self, text: str, colour: str | None) -> None:
        self.verdict.setText(text)
        set_role(self.verdict, colour or PLAIN)

    def _clear_offers(self) -> None:
        self.suspects = []
        while self.offers.count():
            widget = self.offers.takeAt(0).widget()
            widget.hide()
            widget.deleteLater()

    def _offer(self) -> None:
        """Add a button per likely error that corrects the error."""
        if len(self._entered(require_complete=False)[2]) < MIN_POSES:
            return
        for number, suspect in enumerate(self.suspects):
            button = QtGui.QPushButton(self._words(suspect))
            button.setObjectName(f"suspect{number}")
            button.setToolTip(tr("Changes the conventions accordingly; the entered poses stay"))
            button.setAutoDefault(False)
            button.clicked.connect(lambda *_, candidate=suspect: self.adopt(candidate))
            self.offers.addWidget(button)

    def _words(self, suspect: Suspect) -> str:
        words = [] if suspect.shown is None else [self._joint_text(suspect)]
        if suspect.pose is not None:
            x, y, z = (round(value, 2) + 0.0 for value in suspect.pose[:3, 3].tolist())
            turn = math.degrees(
                math.acos(float(np.clip(0.5 * (np.trace(suspect.pose[:3, :3]) - 1.0), -1.0, 1.0)))
            )
            what = tr("the flange") if suspect.kind == pendant.FLANGE else tr("the base frame")
            words.append(
                tr("{} is offset by {} mm and rotated by {} deg").format(
                    what, f"{x:g}, {y:g}, {z:g}", f"{turn:.4g}"
                )
            )
        text = tr(", and ").join(words)
        return text[:1].upper() + text[1:]

    def _joint_text(self, suspect: Suspect) -> str:
        names = [axis_names(self.owner)[axis] for axis in suspect.axes]
        axes = " + ".join(names)
        now = suspect.shown
        if suspect.kind == pendant.SIGN and now.coupling == self.owner.draft.shown.coupling:
            return tr("{}: reversed sign").format(axes)
        if suspect.kind == pendant.COUPLED:
            return tr("axis 3 is shown {}").format(
                tr("relative to the horizontal")
                if now.coupling == pendant.HORIZONTAL
                else tr("relative to link 2")
            )
        if suspect.kind == pendant.ZERO and now.coupling == self.owner.draft.shown.coupling:
            axis = suspect.axes[0]
            return tr("{} shows {} at zero").format(names[0], format_figure(now.zeros[axis]))
        return tr("signs and zeros of {} differ").format(axes)

    def adopt(self, suspect: Suspect) -> None:
        """Correct a likely error in the draft and on the conventions page."""
        draft = self.owner.draft
        if suspect.shown is not None:
            draft = replace(draft, shown=suspect.shown)
        if suspect.kind == pendant.FLANGE:
            chain = draft.chain
            flange = chain.flange @ suspect.pose
            draft = replace(
                draft, chain=Chain(chain.origins, chain.directions, flange, chain.sliding)
            )
        elif suspect.pose is not None:
            draft = replace(draft, base=suspect.pose @ draft.base)
        self.owner.draft = draft
        self.owner.frames_page.fill()
        self.initializePage()
