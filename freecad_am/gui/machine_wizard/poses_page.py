# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check poses typed from the pendant: the machine's deviations and the likely errors."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from PySide import QtGui

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics.chain import Chain
from ...core.kinematics.machines import pendant
from ...core.kinematics.machines.draft import (
    CONVENTIONS,
    QUATERNION,
    figures_of,
    flange_poses,
)
from ...core.kinematics.machines.pendant import Deviation, Suspect
from ...core.types import Array
from ..colours import GOOD, INVALID, PLAIN, set_role
from ..in_language import tr
from ..worker import Later
from .figure_table import FigureTable, Page, axis_names, choice, error_text, format_figure, heading

MIN_POSES, INITIAL_ROWS = 3, 5  # poses that a machine needs, rows that are there at first


class PosesPage(Page):
    """A row per pose: joints and place as the controller shows them, then the deviations."""

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
        self.more = QtGui.QPushButton(tr("One more row"))
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
        """How many columns are joints."""
        return int(self.owner.draft.chain.axes)

    @property
    def width(self) -> int:
        """How many columns are typed."""
        return self.axes + 3 + len(self._angles())

    def _angles(self) -> list[str]:
        return CONVENTIONS[str(self.convention.currentData())][0].split()

    # ---- display

    def fill(self) -> None:
        """Empty rows, the first at the serial zeros; or the poses of the machine that is copied."""
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
        if len(self._angles()) == 4:  # a quaternion has more decimals than an angle
            self.table.widen(range(self.axes + 3, self.axes + 7), "-0.000000")
        self.table.lock(len(columns) - 2, len(columns) - 1)

    def _add_row(self, *_: Any) -> None:
        self._head(self.table.widget.rowCount() + 1)

    def _convention_changed(self, *_: Any) -> None:
        """Columns of another way to write angles; the figures stay, for they were typed."""
        if self.owner.draft is not None and self.filled_with is not None:
            self.table.widget.blockSignals(True)
            for row in range(self.table.widget.rowCount()):
                for column in range(self.axes + 6, self.table.widget.columnCount()):
                    self.table.widget.takeItem(row, column)
            self._head(self.table.widget.rowCount())
            self.table.widget.blockSignals(False)
            self.later.ask()

    def initializePage(self) -> None:
        """Called by Qt when the page opens: poses stay, deviations use the current conventions."""
        super().initializePage()
        zeros = ", ".join(format_figure(value) for value in self.owner.draft.shown.zeros)
        self.zero.setText(
            tr("One pose must be at the serial zeros, where the controller shows {}.").format(zeros)
        )
        self.judge()

    # ---- entries

    def _entered(self, require_complete: bool) -> tuple[Array, Array, list[int]]:
        """Joints (n, axes) as shown, flange poses (n, 4, 4) in base_link and their rows.

        Incomplete rows are skipped unless `require_complete`; then InputError names the missing figure.
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
                    tr("a quaternion cannot be all zeros; enter the one shown on the controller"),
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
        """Into the draft, if the machine gives them."""
        draft = self.owner.draft
        values, poses, rows = self._entered(require_complete=True)
        if len(rows) < MIN_POSES:
            raise InputError(
                "NO_POSES",
                tr("Check poses"),
                tr(
                    "only {} are entered, but at least {} are needed, as a machine without them "
                    "is not loaded; enter more"
                ).format(len(rows), MIN_POSES),
            )
        if not np.isclose(values, draft.shown.zeros, atol=1e-9).all(axis=1).any():
            raise InputError(
                "NO_POSES",
                tr("Check poses"),
                tr("the pose at the serial zeros is missing; enter it too"),
            )
        if np.ptp(values, axis=0).min() < 1.0:
            still = axis_names(self.owner)[int(np.argmin(np.ptp(values, axis=0)))]
            raise InputError(
                "NO_POSES",
                still,
                tr("it is the same in all poses, which proves nothing; add another pose"),
            )
        if not pendant.fits(pendant.deviations(draft.chain, draft.shown, values, poses)):
            raise InputError(
                "MISSED",
                tr("Check poses"),
                tr("the machine does not reproduce them; see the deviations"),
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
                "The machine does not reproduce these poses; enter at least three to locate the "
                "error."
            )
        if self.suspects:
            return tr("The machine does not reproduce these poses. It would if:")
        return tr(
            "The machine does not reproduce these poses, and no single sign, zero, coupling or "
            "frame explains it. Check for typing errors, the angle convention, the tool frame, "
            "and lengths."
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
        """Add a button per likely error that corrects it."""
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
        """Correct a likely error in the draft and on the page of conventions."""
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
