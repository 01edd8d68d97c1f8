# SPDX-License-Identifier: LGPL-2.1-or-later
"""The maker's base frame, the flange, and how the controller shows the axes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from PySide import QtGui

from ...core.geometry import frames
from ...core.issues import InputError
from ...core.kinematics.chain import Chain
from ...core.kinematics.machines import draft as machine_draft
from ...core.kinematics.machines import pendant
from ...core.kinematics.machines.pendant import Shown
from ..texts.translation import tr
from .figure_table import FigureTable
from .page import Page, axis_names, choice, heading

_POSE = ["X", "Y", "Z", "roll", "pitch", "yaw"]


class FramesPage(Page):
    """Frames in mm and deg, roll, pitch and yaw as URDF has them; signs and zeros of the axes on the pendant."""

    def __init__(self, wizard: Any) -> None:
        super().__init__(
            wizard,
            "FramesPage",
            tr("Frames and conventions"),
            tr(
                "The next page compares these values with poses of your controller and points "
                "out likely errors: leave unknown values as they are."
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
            heading(
                tr(
                    "Axes on the pendant: -1 if the axis counts the other way; the value shown at "
                    "zero"
                )
            )
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
                    "Limits from the data sheet; leave them empty if unknown. The limits on the "
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
        """Into the draft; the closed form must be there now."""
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
