# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits, speeds, accelerations and jerks of the axes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...core.issues import InputError
from ..texts.translation import tr
from .figure_table import FigureTable
from .page import Page, axis_names


class LimitsPage(Page):
    """One row per axis. A range is left empty for an endless axis, the others where they are not known."""

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
        """Show what the source tells."""
        draft = self.owner.draft
        names = axis_names(self.owner)
        self.table.set_shape(names, _heads())
        values = np.column_stack(
            (draft.lower, draft.upper, draft.max_speed, draft.max_acceleration, draft.max_jerk)
        )
        # what a URDF writes in rad is rarely a whole degree in its last digits
        self.table.fill(np.round(values / draft.units[:, None], 6))
        self.notes.setText("\n".join(draft.notes))

    def take(self) -> None:
        """Into the draft."""
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
                raise InputError("BAD_VALUE", name, tr("a prismatic axis has two ends; enter both"))
            if any(rate <= 0.0 for rate in rates):
                raise InputError(
                    "BAD_VALUE",
                    name,
                    tr(
                        "enter positive values for speed, acceleration and jerk, or leave them "
                        "empty"
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
