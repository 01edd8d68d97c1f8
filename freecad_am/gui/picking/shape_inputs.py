# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inputs that are shapes, faces of them or whole objects: what is selected."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...objects.stage_parts import Link
from .. import recorded
from ..texts.translation import tr, translated
from . import picking
from .an_input import Input
from .pick_button import NextClick, pick_button


class ShapeChoice(Input):
    """A shape with some of its faces, or an axis: what is selected, renewed by a button; what is not required is none again
    where nothing is selected. `present`: as the link holds it. note: what a panel that opens tells about it."""

    note = ""

    def __init__(self, link: Link, present: Any, take_now: bool) -> None:
        self.link, self.label, self.present = link, translated(link.label), present
        self.explicit = link.required or bool(
            present
        )  # whether a macro must say that there is none
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
        self.empty = pick_button("×", f"Clear{link.name}", tr("Clears it"))
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
        """Take what was selected before the panel was opened, where a click on one face stands for all of it."""
        found = self._selected()
        pick = found if found is None or self.link.name == "Axis" else picking.whole(found)
        self._take(pick)
        if found is not None and pick is not None and found.names and not pick.names:
            self.note = tr("The whole of {} is used; Pick uses the selected faces only.").format(
                pick.obj.Label
            )

    def _pressed(self, on: bool) -> None:
        """The pick button was pressed: take what is selected, or wait for a click."""
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
        """Whether anything is selected; a document that is closed is told when it is taken from."""
        try:
            return bool(Gui.Selection.getSelection(self.document.Name))
        except (ReferenceError, RuntimeError, NameError):
            return True

    def _clicked(self) -> None:
        """Something was clicked that the input waits for."""
        self.pick.setChecked(False)
        self._take_selected()

    def clear(self, *_: Any) -> None:
        """Nothing is picked."""
        self.present = None
        self._show()
        self.tell("")

    def _take_selected(self, *_: Any) -> None:
        """Take what is selected, perhaps after the document was closed."""
        try:
            self.take()
        except ReferenceError:
            self.tell(
                tr(
                    "The document or object in this panel was deleted; cancel and open the panel "
                    "again."
                )
            )

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
        return next(
            (picking.with_faces(pick) for pick in picks if not picking.is_mesh(pick.obj)), None
        )

    def value(self) -> Any:
        """As the link of the stage holds it."""
        return self.present

    def _refusal(self) -> str:
        """Why nothing is taken."""
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

    def _show_state(self, held: bool) -> None:
        """Tell what to click while a click is awaited."""
        idle = tr("select") if self.link.required else self.nothing
        self.text.setPlaceholderText(tr("click an object") if self.pick.isChecked() else idle)
        self.empty.setEnabled(held)

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
    """A whole object with a shape: what is selected, renewed by a button."""

    def __init__(self, link: Link, present: Any) -> None:
        super().__init__(link, None if present is None else (present, []), take_now=False)

    def show_stored(self, stored: Any) -> None:
        super().show_stored(None if stored is None else (stored, []))

    @property
    def missing(self) -> str:
        text = tr("{} is missing: select it and press its Pick.")
        return "" if self.present is not None else text.format(self.label)

    def value(self) -> Any:
        return None if self.present is None else self.present[0]

    def arguments(self) -> dict[str, str]:
        return {
            self.link.key: "None" if self.present is None else recorded.reference(self.present[0])
        }


class ObjectsChoice(ShapeChoice):
    """Several whole objects with a shape or a mesh: what is selected, renewed by a button; nothing selected, none."""

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
        """Take what is selected now."""
        self.objects = [pick.obj for pick in picking.selected(self.document)]
        self._show()
        self.tell("" if self.objects else picking.refused(self.document))

    def _show(self) -> None:
        text = ", ".join(obj.Label for obj in self.objects)
        self.text.setText(text)
        self.text.setToolTip(text)
        self._show_state(bool(text))

    def clear(self, *_: Any) -> None:
        """Nothing is picked."""
        self.objects = []
        self._show()
        self.tell("")

    def value(self) -> Any:
        return self.objects

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.objects)

    def arguments(self) -> dict[str, str]:
        if not self.objects and not self.explicit:
            return {}
        return {self.link.key: f"[{', '.join(recorded.reference(obj) for obj in self.objects)}]"}
