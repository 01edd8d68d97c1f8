# SPDX-License-Identifier: LGPL-2.1-or-later
"""The last page: name, maker, posts, and the machine file itself."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from PySide import QtGui

from ...core.issues import InputError
from ...core.kinematics.inverse.opw import OpwArm
from ...core.kinematics.machines import draft as machine_draft
from ...core.kinematics.urdf.machine import is_mechanism
from ...objects import user_machines
from ...posts import catalogue
from ...posts.names import plain
from ..texts.translation import tr
from .page import Page


class NamePage(Page):
    """Finish writes the file."""

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
        """A name from the title, unless one was typed."""
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
        """Called by Qt when the page comes."""
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
