# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inputs of a stage in its panel: what is selected, or one of the stages there are."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...objects.stage import Stage, stage_of
from ...objects.stage_parts import Link
from .. import recorded
from ..texts.translation import tr, translated
from . import picking
from .selection import meant, selected

INSPECTION = "inspection"


class Input:
    """A row of the panel that gives arguments of the macro function."""

    label = ""
    widget: Any = None
    places: tuple[str, ...] = ()  # what errors call it, other than by its link

    def tell(self, text: str) -> None:
        """Something about it; the panel shows it under the widget."""

    @property
    def missing(self) -> str:
        """What to do when there is nothing to choose, '' when there is."""
        return ""

    def arguments(self) -> dict[str, str]:
        """Arguments by keyword as Python texts."""
        raise NotImplementedError

    def applied(self) -> None:
        """What is entered is what the document has now."""


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
        last = [] if link.kind == INSPECTION else names[-1:]  # what is compared elsewhere is an input only if chosen
        self.proposed = present.Name if present is not None else (wished or last or [""])[0]
        self.widget.setCurrentIndex(max(0, self.widget.findData(self.proposed)))

    def follow(self, toolpath: StageChoice) -> None:
        """Propose the cell that the chosen toolpath was made for, now and for another one, until a cell is chosen; one
        that is selected itself stays."""
        if not any(obj is self.value() for obj in selected()):
            toolpath.widget.currentIndexChanged.connect(lambda *_: self._propose(toolpath))
            self._propose(toolpath)

    def _propose(self, toolpath: StageChoice) -> None:
        cell = getattr(toolpath.value(), "Cell", None)
        if cell is not None and self.widget.currentData() == self.proposed and self.widget.findData(cell.Name) >= 0:
            self.proposed = cell.Name
            self.widget.setCurrentIndex(self.widget.findData(cell.Name))

    @property
    def missing(self) -> str:
        if not self.link.required or self.widget.count():
            return ""
        return tr("{0} is missing in this document. Make it first: button {0} in the toolbar.").format(self.label)

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


class ShapeChoice(Input):
    """A shape with some of its faces, or an axis: what is selected, renewed by a button; what is not required is none again
    where nothing is selected. `present`: as the link holds it. note: what a panel that opens tells about it."""

    note = ""

    def __init__(self, link: Link, present: Any, take_now: bool) -> None:
        self.link, self.label, self.present = link, translated(link.label), present
        self.explicit = link.required or bool(present)  # whether a macro must say that there is none
        self.document = App.ActiveDocument
        self.widget = QtGui.QWidget()
        self.widget.setToolTip(translated(link.help))
        row = QtGui.QHBoxLayout(self.widget)
        row.setContentsMargins(0, 0, 0, 0)
        self.text = QtGui.QLineEdit()
        self.text.setObjectName(link.name)
        self.text.setReadOnly(True)
        self.text.setPlaceholderText(tr("select") if link.required else tr("auto"))
        button = QtGui.QPushButton(tr("Use selection"))
        button.setObjectName(f"Use{link.name}")
        button.setToolTip(tr("Takes what is selected now. {}").format(translated(link.help)))
        button.clicked.connect(self._take_selected)
        row.addWidget(self.text)
        row.addWidget(button)
        if take_now and present is None:
            self._propose_selected()
        self._show()

    def _propose_selected(self) -> None:
        """Take what was selected before the panel was opened, where a click on one face stands for all of it."""
        found = self._selected()
        pick = found if found is None or self.link.name == "Axis" else picking.whole(found)
        self._take(pick)
        if found is not None and pick is not None and found.names and not pick.names:
            self.note = tr("The whole of {} is taken; Use selection takes faces alone.").format(pick.obj.Label)

    def _take_selected(self, *_: Any) -> None:
        """The button was pressed, perhaps after the document was closed."""
        try:
            self.take()
        except ReferenceError:
            self.tell(tr("The document or object of this panel is gone; cancel and open the panel again."))

    def take(self, *_: Any) -> None:
        """Take what is selected now; what cannot be taken is told, and what was taken before stays."""
        self._take(self._selected())

    def _take(self, found: picking.Pick | None) -> None:
        wrong = "" if found is not None else self._refusal()
        if found is not None:
            self.present = (found.obj, list(found.names))
        elif not self.link.required and not Gui.Selection.getSelection(self.document.Name):
            self.present, wrong = None, ""
        self._show()
        self.tell(wrong)

    def _selected(self) -> picking.Pick | None:
        if self.link.name == "Axis":
            return picking.selected_line(self.document)
        picks = picking.selected(self.document)
        return next((picking.with_faces(pick) for pick in picks if not picking.is_mesh(pick.obj)), None)

    def value(self) -> Any:
        """As the link of the stage holds it."""
        return self.present

    def _refusal(self) -> str:
        """Why nothing is taken."""
        meshes = [pick.obj.Label for pick in picking.selected(self.document)]
        if meshes:
            return tr("{} is a mesh, which has no exact faces; select a part such as of a STEP file.").format(meshes[0])
        return picking.refused(self.document) or tr("Nothing is selected: click in the tree or the 3D view first.")

    def _show(self) -> None:
        text = "" if self.present is None else " ".join([self.present[0].Label, *self.present[1]])
        self.text.setText(text)
        self.text.setCursorPosition(0)
        self.text.setToolTip(text)

    @property
    def missing(self) -> str:
        if not self.link.required or self.present is not None:
            return ""
        return tr("Select the shape to deposit, or its faces, and press Use selection.")

    def applied(self) -> None:
        self.explicit = self.explicit or self.present is not None

    def arguments(self) -> dict[str, str]:
        if self.present is None:
            return {self.link.key: "None"} if self.explicit else {}
        obj, names = self.present
        if self.link.name == "Axis":
            return {"axis": f"({recorded.reference(obj)}, {(names or [''])[0]!r})"}
        return {"source": recorded.reference(obj), "faces": repr([name for name in names if name])}


class ObjectChoice(ShapeChoice):
    """A whole object with a shape: what is selected, renewed by a button."""

    def __init__(self, link: Link, present: Any) -> None:
        super().__init__(link, None if present is None else (present, []), take_now=False)

    @property
    def missing(self) -> str:
        text = tr("{} is missing: select it and press its Use selection.")
        return "" if self.present is not None else text.format(self.label)

    def value(self) -> Any:
        return None if self.present is None else self.present[0]

    def arguments(self) -> dict[str, str]:
        return {self.link.key: "None" if self.present is None else recorded.reference(self.present[0])}


class ObjectsChoice(ShapeChoice):
    """Several whole objects with a shape or a mesh: what is selected, renewed by a button; nothing selected, none."""

    def __init__(self, link: Link, present: Any) -> None:
        self.objects = list(present or ())
        super().__init__(link, None, take_now=False)
        self.explicit = bool(present)
        self.text.setPlaceholderText(tr("none"))

    def take(self, *_: Any) -> None:
        """Take what is selected now."""
        self.objects = [pick.obj for pick in picking.selected(self.document)]
        self._show()
        self.tell("" if self.objects else picking.refused(self.document))

    def _show(self) -> None:
        text = ", ".join(obj.Label for obj in self.objects)
        self.text.setText(text)
        self.text.setToolTip(text)

    def value(self) -> Any:
        return self.objects

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.objects)

    def arguments(self) -> dict[str, str]:
        if not self.objects and not self.explicit:
            return {}
        return {self.link.key: f"[{', '.join(recorded.reference(obj) for obj in self.objects)}]"}


class NameChoice(Input):
    """The name of a program."""

    places = ("name",)

    def __init__(self, name: str) -> None:
        self.label = tr("Name")
        self.widget = QtGui.QLineEdit(name)
        self.widget.setObjectName("ProgramName")
        self.widget.setToolTip(tr("Name of the program and of its files; the controller may refuse some"))

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
