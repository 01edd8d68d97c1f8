# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inputs of a stage in its panel: what is selected, or one of the stages there are."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ..objects.stage import stage_of
from . import recorded


class Input:
    """A row of the panel that gives one argument of the macro function."""

    label = ""
    widget: Any = None

    @property
    def missing(self) -> str:
        """What to do when there is nothing to choose, '' when there is."""
        return ""

    def argument(self) -> str:
        """The argument as Python text, '' for none."""
        raise NotImplementedError


class StageChoice(Input):
    """One of the stages of a kind in the active document; the selected one first, else the last."""

    def __init__(self, kind: str, label: str, keyword: str = "", required: bool = True) -> None:
        self.kind, self.label, self.keyword, self.required = kind, label, keyword, required
        self.widget = QtGui.QComboBox()
        self.widget.setObjectName(f"Input{label.replace(' ', '')}")
        names = []
        for obj in App.ActiveDocument.Objects:
            stage = stage_of(obj)
            if stage is not None and stage.kind == kind:
                names.append(obj.Name)
                self.widget.addItem(obj.Label, obj.Name)
        if not required:
            self.widget.addItem("none", "")
        selected = [obj.Name for obj in Gui.Selection.getSelection() if obj.Name in names]
        wanted = selected[0] if selected else (names[-1] if names else "")
        self.widget.setCurrentIndex(max(0, self.widget.findData(wanted)))

    @property
    def missing(self) -> str:
        if not self.required or self.widget.count():
            return ""
        return f"There is no {self.kind} in this document yet. Make one first: button {self.label} in the toolbar."

    def argument(self) -> str:
        if not self.widget.count():
            text = "None"
        else:
            name = self.widget.currentData()
            text = recorded.reference(App.ActiveDocument.getObject(name)) if name else "None"
        return f"{self.keyword}={text}" if self.keyword else text


class SourceChoice(Input):
    """The shape or faces to deposit: what is selected, renewed by a button."""

    label = "Shape"

    def __init__(self) -> None:
        self.widget = QtGui.QWidget()
        row = QtGui.QHBoxLayout(self.widget)
        row.setContentsMargins(0, 0, 0, 0)
        self.text = QtGui.QLineEdit()
        self.text.setObjectName("Source")
        self.text.setReadOnly(True)
        self.text.setPlaceholderText("select a shape or faces")
        button = QtGui.QPushButton("Use selection")
        button.setObjectName("UseSelection")
        button.setToolTip("Take the shape or the faces that are selected now")
        button.clicked.connect(self.take)
        row.addWidget(self.text)
        row.addWidget(button)
        self.object: Any = None
        self.faces: list[str] = []
        self.take()

    def take(self, *_: Any) -> None:
        """Take what is selected now."""
        found = selected_shape()
        if found is not None:
            self.object, self.faces = found
            self.text.setText(" ".join([self.object.Label, *self.faces]))

    @property
    def missing(self) -> str:
        return "" if self.object is not None else "Select the shape to deposit, or its faces, and press Use selection."

    def argument(self) -> str:
        if self.object is None:
            return "None"
        return f"{recorded.reference(self.object)}, {self.faces!r}"


class NameChoice(Input):
    """The name of a program."""

    label = "Name"

    def __init__(self, name: str) -> None:
        self.widget = QtGui.QLineEdit(name)
        self.widget.setObjectName("ProgramName")
        self.widget.setToolTip("Name of the program and of its files; the controller may refuse some")

    def argument(self) -> str:
        return f"name={self.widget.text().strip()!r}"


def selected_shape() -> tuple[Any, list[str]] | None:
    """The selected object with a shape and its selected faces, None when nothing of that kind is selected."""
    for entry in Gui.Selection.getSelectionEx():
        obj = entry.Object
        if getattr(obj, "Shape", None) is not None and not obj.Shape.isNull():
            return obj, [name for name in entry.SubElementNames if name.startswith("Face")]
    return None
