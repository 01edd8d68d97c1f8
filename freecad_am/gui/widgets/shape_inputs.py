# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inputs from the selection: shapes, their faces or whole objects."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...objects.job_group import is_group, stages_in
from ...objects.stage import Stage, stage_of
from ...objects.stage_parts import Link
from .. import picking, recorded
from ..in_language import tr, translated
from .pick_field import Input, NextClick, pick_button

# tools prefer the joint path of a job
_ORDER = ("joint path", "cell", "feature", "toolpath", "program")


def job_selection(document: str = "") -> list[Any]:
    """Return the selected objects of a document (by name, '' for the active document), then the
    other stages of their jobs.

    Joint paths come first among the stages, then the other kinds in creation order.
    """
    selection = selected(document)
    objects = [obj for obj in selection if not is_group(obj)]
    for obj in selection:
        objects += [stage for stage in _job(obj) if stage not in objects]
    return objects


def selected(document: str = "") -> list[Any]:
    """Return the selected objects of a document, by name, or of the active document."""
    return list(Gui.Selection.getSelection(document) if document else Gui.Selection.getSelection())


def job_named() -> str:
    """Return the label of the selected job, or of the selected stage if it belongs to no job.

    '' if neither is selected.
    """
    for obj in selected():
        if _job(obj) or is_group(obj):
            return str((obj if is_group(obj) else _group_of(obj) or obj).Label)
    return ""


def _job(obj: Any) -> list[Any]:
    """Return the stages of a job or of a stage's job.

    These are the stages in its group, linked stages first, then their sources elsewhere. Without a
    group, they are the linked stages, latest first.
    """
    if is_group(obj):
        linked, group = [], obj
    elif stage_of(obj) is not None:
        linked, group = _line(obj), _group_of(obj)
    else:
        return []
    if group is None:
        return sorted(linked, key=lambda stage: (_rank(stage), -stage.ID))
    members = sorted(
        stages_in(group), key=lambda stage: (_rank(stage), bool(linked) and stage not in linked)
    )
    return [
        *members,
        *(origin for stage in members for origin in _leading_to(stage) if origin not in members),
    ]


def _group_of(stage: Any) -> Any:
    return next((obj for obj in stage.InList if is_group(obj)), None)


def _line(stage: Any) -> list[Any]:
    """Return the sources of a stage, its dependents and their sources.

    For an inspection, start from the inspected stage.
    """
    planned = getattr(stage, "Planned", None)
    origin = stage if planned is None or stage_of(planned) is None else planned
    lines = [_leading_to(obj) for obj in stage.Document.Objects if stage_of(obj) is not None]
    return list(dict.fromkeys(member for line in lines if origin in line for member in line))


def _leading_to(stage: Any) -> list[Any]:
    """Return a stage and its sources. Expressions are ignored, because jobs may share values."""
    stages = [stage]
    for obj in stages:
        inputs = [getattr(obj, link.name) for link in obj.Proxy.links]
        sources = [
            source for value in inputs for source in (value if isinstance(value, list) else [value])
        ]
        stages += [
            source for source in sources if stage_of(source) is not None and source not in stages
        ]
    return stages


def _rank(stage: Any) -> int:
    kind = stage.Proxy.kind
    return _ORDER.index(kind) if kind in _ORDER else len(_ORDER)


class ShapeChoice(Input):
    """A selected shape with some of its faces, or an axis; a button updates it.

    An empty selection clears an optional input. present: the value of the link. The panel
    shows `note` when it opens.
    """

    note = ""

    def __init__(self, link: Link, present: Any, take_now: bool) -> None:
        self.link, self.label, self.present = link, translated(link.label), present
        self.explicit = link.required or bool(present)  # whether a macro must pass None explicitly
        self.document = App.ActiveDocument
        self.widget = QtGui.QWidget()
        self.widget.setToolTip(translated(link.help))
        row = QtGui.QHBoxLayout(self.widget)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(2)
        self.text = QtGui.QLineEdit()
        self.text.setObjectName(link.name)
        self.text.setReadOnly(True)
        self.nothing = tr("auto")
        self.text.setMinimumWidth(40)
        self.pick = pick_button(
            tr("Pick"),
            f"Use{link.name}",
            tr("Uses the current selection, or the next click. {}").format(translated(link.help)),
        )
        self.pick.setCheckable(True)
        self.pick.clicked.connect(self._pressed)
        self.empty = pick_button("×", f"Clear{link.name}", tr("Clears the field"))
        self.empty.clicked.connect(self.clear)
        row.addWidget(self.text, 1)
        for button in (self.pick, self.empty):
            row.addWidget(button)
        self.click = NextClick(self.widget, self._clicked)
        if take_now and present is None:
            self._propose_selected()
        self._show()

    def show_stored(self, stored: Any) -> None:
        self.present = stored
        self._show()

    def _propose_selected(self) -> None:
        """Take the selection from before the panel opened; one face selects the whole object."""
        selection = self._selected()
        pick = (
            selection
            if selection is None or self.link.name == "Axis"
            else picking.expand_pick(selection)
        )
        self._take(pick)
        if selection is not None and pick is not None and selection.names and not pick.names:
            self.note = tr("The whole of {} is used; Pick uses the selected faces only.").format(
                pick.obj.Label
            )

    def _pressed(self, on: bool) -> None:
        """Take the selection when the pick button is pressed, or wait for a click."""
        if on and not self._is_selected():
            self.click.wait()
            self._show()
        else:
            self.click.stop()
            self.pick.setChecked(False)
            if on:
                self._take_selected()
            self._show()

    def _is_selected(self) -> bool:
        """Whether anything is selected. True for a closed document, because taking its selection
        reports the error.
        """
        try:
            return bool(Gui.Selection.getSelection(self.document.Name))
        except (ReferenceError, RuntimeError, NameError):
            return True

    def _clicked(self) -> None:
        """Take the selection after an awaited click."""
        self.pick.setChecked(False)
        self._take_selected()

    def clear(self, *_: Any) -> None:
        """Remove the pick."""
        self.present = None
        self._show()
        self.show_note("")

    def _take_selected(self, *_: Any) -> None:
        """Take the selection; the document may be closed."""
        try:
            self.take()
        except ReferenceError:
            self.show_note(
                tr(
                    "The document or object in this panel was deleted; cancel and open the panel "
                    "again."
                )
            )

    def take(self, *_: Any) -> None:
        """Take the selection; report a rejected selection and keep the previous input."""
        self._take(self._selected())

    def _take(self, pick: picking.Pick | None) -> None:
        wrong = "" if pick is not None else self._refusal()
        if pick is not None:
            self.present = (pick.obj, list(pick.names))
        elif not self.link.required and not Gui.Selection.getSelection(self.document.Name):
            self.present, wrong = None, ""
        self._show()
        self.show_note(wrong)

    def _selected(self) -> picking.Pick | None:
        if self.link.name == "Axis":
            return picking.selected_line(self.document)
        picks = picking.selected(self.document)
        return next(
            (picking.pick_of_faces(pick) for pick in picks if not picking.is_mesh(pick.obj)), None
        )

    def value(self) -> Any:
        """Return the input in the form of the stage's link."""
        return self.present

    def _refusal(self) -> str:
        """Return why the selection is rejected."""
        meshes = [pick.obj.Label for pick in picking.selected(self.document)]
        if meshes:
            return tr(
                "{} is a mesh without exact faces; select a part such as from a STEP file."
            ).format(meshes[0])
        return picking.refused(self.document) or tr(
            "Nothing is selected: click in the tree or the 3D view first."
        )

    def _show(self) -> None:
        text = "" if self.present is None else " ".join([self.present[0].Label, *self.present[1]])
        self.text.setText(text)
        self.text.setCursorPosition(0)
        self.text.setToolTip(text)
        self._show_state(bool(text))

    def _show_state(self, is_set: bool) -> None:
        """Show what to click while waiting for a click."""
        idle = tr("select") if self.link.required else self.nothing
        self.text.setPlaceholderText(tr("click an object") if self.pick.isChecked() else idle)
        self.empty.setEnabled(is_set)

    @property
    def missing(self) -> str:
        if not self.link.required or self.present is not None:
            return ""
        return tr("Select the shape to deposit, or its faces, and press Pick.")

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
    """Input for a whole selected object with a shape; a button updates it."""

    def __init__(self, link: Link, present: Any) -> None:
        super().__init__(link, None if present is None else (present, []), take_now=False)

    def show_stored(self, stored: Any) -> None:
        super().show_stored(None if stored is None else (stored, []))

    @property
    def missing(self) -> str:
        text = tr("{} is missing: select the object and press Pick.")
        return "" if self.present is not None else text.format(self.label)

    def value(self) -> Any:
        return None if self.present is None else self.present[0]

    def arguments(self) -> dict[str, str]:
        return {
            self.link.key: "None" if self.present is None else recorded.reference(self.present[0])
        }


class ObjectsChoice(ShapeChoice):
    """Input for several whole selected objects with a shape or mesh; a button updates it."""

    def __init__(self, link: Link, present: Any) -> None:
        self.objects = list(present or ())
        super().__init__(link, None, take_now=False)
        self.explicit = bool(present)
        self.nothing = tr("none")
        self._show()

    def show_stored(self, stored: Any) -> None:
        self.objects = list(stored)
        self._show()

    def take(self, *_: Any) -> None:
        """Take the selection."""
        self.objects = [pick.obj for pick in picking.selected(self.document)]
        self._show()
        self.show_note("" if self.objects else picking.refused(self.document))

    def _show(self) -> None:
        text = ", ".join(obj.Label for obj in self.objects)
        self.text.setText(text)
        self.text.setToolTip(text)
        self._show_state(bool(text))

    def clear(self, *_: Any) -> None:
        """Remove all picks."""
        self.objects = []
        self._show()
        self.show_note("")

    def value(self) -> Any:
        return self.objects

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.objects)

    def arguments(self) -> dict[str, str]:
        if not self.objects and not self.explicit:
            return {}
        return {self.link.key: f"[{', '.join(recorded.reference(obj) for obj in self.objects)}]"}


INSPECTION = "inspection"


class StageChoice(Input):
    """Choice of a stage of a kind in the active document.

    The default is the present stage, then the selected stage or the stage of the selected job, then
    the last stage.
    """

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
        wished = [obj.Name for obj in job_selection() if obj.Name in names]
        fallback = (
            [] if link.kind == INSPECTION else names[-1:]
        )  # a compared stage is an input only if chosen
        self.proposed = present.Name if present is not None else (wished or fallback or [""])[0]
        self.widget.setCurrentIndex(max(0, self.widget.findData(self.proposed)))

    def show_stored(self, stored: Any) -> None:
        name = "" if stored is None else stored.Name
        if name and self.widget.findData(name) < 0:  # created after the panel opened
            self.widget.addItem(stored.Label, name)
        self.widget.setCurrentIndex(self.widget.findData(name))

    def follow(self, toolpath: StageChoice) -> None:
        """Propose the cell of the chosen toolpath, until the user chooses a cell.

        Another toolpath changes the proposal. A cell that is itself selected stays.
        """
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
            "{0} is missing in this document; create it with the button {0} in the toolbar."
        ).format(self.label)

    def value(self) -> Any:
        """Return the input in the form of the stage's link."""
        name = self.widget.currentData() if self.widget.count() else ""
        return self.document.getObject(name) if name else None

    def arguments(self) -> dict[str, str]:
        stage = self.value()
        return {self.link.key: "None" if stage is None else recorded.reference(stage)}


def _compares_stages(obj: Any) -> bool:
    """Whether an object is an inspection of a stage, not of a part."""
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
    """Return the inputs of a new or existing stage."""
    inputs: list[Input] = []
    for link in proxy.links:
        present = None if obj is None else getattr(obj, link.name)
        if link.kind and link.many:
            continue
        if link.kind:
            inputs.append(StageChoice(link, present))
        elif link.type_name == "App::PropertyLinkList":
            inputs.append(ObjectsChoice(link, present))
        elif link.type_name == "App::PropertyLink":
            inputs.append(ObjectChoice(link, present))
        else:
            inputs.append(ShapeChoice(link, present, take_now=link.required))
    if obj is None:
        _match(inputs)
    return inputs


def _match(choices: list[Input]) -> None:
    """Let the cell follow the toolpath."""
    stages = {choice.link.kind: choice for choice in choices if isinstance(choice, StageChoice)}
    if "toolpath" in stages and "cell" in stages:
        stages["cell"].follow(stages["toolpath"])
