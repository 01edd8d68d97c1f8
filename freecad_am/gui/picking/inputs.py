# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inputs of a stage in its panel: what is selected, or one of the stages there are."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
from PySide import QtGui

from ...objects.stage import Stage, stage_of
from ...objects.stage_parts import Link
from .. import recorded
from ..texts.translation import tr, translated
from .an_input import Input
from .selection import meant, selected
from .shape_inputs import ObjectChoice, ObjectsChoice, ShapeChoice

INSPECTION = "inspection"


class StageChoice(Input):
    """One of the stages of a kind in the active document; the present one, else the selected one or that of the job that
    is selected, else the last."""

    def __init__(self, link: Link, present: Any) -> None:
        self.link, self.label = link, translated(link.label)
        self.document = App.ActiveDocument
        self.widget = QtGui.QComboBox()
        self.widget.setObjectName(f"Input{link.name}")
        self.widget.setToolTip(translated(link.help))
        names = []
        for obj in self.document.Objects:
            stage = stage_of(obj)
            if stage is not None and stage.kind == link.kind and not _compares_stages(obj):
                names.append(obj.Name)
                self.widget.addItem(obj.Label, obj.Name)
        if not link.required:
            self.widget.addItem(tr("none"), "")
        wished = [obj.Name for obj in meant() if obj.Name in names]
        last = (
            [] if link.kind == INSPECTION else names[-1:]
        )  # what is compared elsewhere is an input only if chosen
        self.proposed = present.Name if present is not None else (wished or last or [""])[0]
        self.widget.setCurrentIndex(max(0, self.widget.findData(self.proposed)))

    def show_stored(self, stored: Any) -> None:
        name = "" if stored is None else stored.Name
        if name and self.widget.findData(name) < 0:  # it was not there when the panel was opened
            self.widget.addItem(stored.Label, name)
        self.widget.setCurrentIndex(self.widget.findData(name))

    def follow(self, toolpath: StageChoice) -> None:
        """Propose the cell that the chosen toolpath was made for, now and for another one, until a cell is chosen; one
        that is selected itself stays."""
        if not any(obj is self.value() for obj in selected()):
            toolpath.widget.currentIndexChanged.connect(lambda *_: self._propose(toolpath))
            self._propose(toolpath)

    def _propose(self, toolpath: StageChoice) -> None:
        cell = getattr(toolpath.value(), "Cell", None)
        if (
            cell is not None
            and self.widget.currentData() == self.proposed
            and self.widget.findData(cell.Name) >= 0
        ):
            self.proposed = cell.Name
            self.widget.setCurrentIndex(self.widget.findData(cell.Name))

    @property
    def missing(self) -> str:
        if not self.link.required or self.widget.count():
            return ""
        return tr(
            "{0} is missing in this document. Create it first: button {0} in the toolbar."
        ).format(self.label)

    def value(self) -> Any:
        """As the link of the stage holds it."""
        name = self.widget.currentData() if self.widget.count() else ""
        return self.document.getObject(name) if name else None

    def arguments(self) -> dict[str, str]:
        chosen = self.value()
        return {self.link.key: "None" if chosen is None else recorded.reference(chosen)}


def _compares_stages(obj: Any) -> bool:
    """Whether an object is an inspection of what was planned, not of a part."""
    return stage_of(getattr(obj, "Planned", None)) is not None


class NameChoice(Input):
    """The name of a program."""

    places = ("name",)

    def __init__(self, name: str) -> None:
        self.label = tr("Name")
        self.widget = QtGui.QLineEdit(name)
        self.widget.setObjectName("ProgramName")
        self.widget.setToolTip(
            tr("Name of the program and of its files; the controller may reject some names")
        )

    def stored(self, obj: Any) -> Any:
        return obj.ProgramName

    def show_stored(self, stored: Any) -> None:
        self.widget.setText(stored)

    def arguments(self) -> dict[str, str]:
        return {"name": repr(self.widget.text().strip())}


def of(proxy: type[Stage], obj: Any = None) -> list[Input]:
    """The inputs of a stage to be made, or of an existing one."""
    found: list[Input] = []
    for link in proxy.links:
        present = None if obj is None else getattr(obj, link.name)
        if link.kind and link.many:
            continue
        if link.kind:
            found.append(StageChoice(link, present))
        elif link.type_name == "App::PropertyLinkList":
            found.append(ObjectsChoice(link, present))
        elif link.type_name == "App::PropertyLink":
            found.append(ObjectChoice(link, present))
        else:
            found.append(ShapeChoice(link, present, take_now=link.required))
    if obj is None:
        _match(found)
    return found


def _match(choices: list[Input]) -> None:
    """A cell is proposed for the toolpath that runs in it."""
    stages = {choice.link.kind: choice for choice in choices if isinstance(choice, StageChoice)}
    if "toolpath" in stages and "cell" in stages:
        stages["cell"].follow(stages["toolpath"])
