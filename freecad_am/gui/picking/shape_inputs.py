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

    def show_stored(self, stored: Any) -> None:
        self.present = stored
        self._show()

    def _propose_selected(self) -> None:
        """Take what was selected before the panel was opened, where a click on one face stands for all of it."""
        found = self._selected()
        pick = found if found is None or self.link.name == "Axis" else picking.whole(found)
        self._take(pick)
        if found is not None and pick is not None and found.names and not pick.names:
            self.note = tr(
                "The whole of {} is taken; Use selection takes the selected faces only."
            ).format(pick.obj.Label)

    def _take_selected(self, *_: Any) -> None:
        """The button was pressed, perhaps after the document was closed."""
        try:
            self.take()
        except ReferenceError:
            self.tell(
                tr("The document or object of this panel is gone; cancel and open the panel again.")
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
                "{} is a mesh, which has no exact faces; select a part such as of a STEP file."
            ).format(meshes[0])
        return picking.refused(self.document) or tr(
            "Nothing is selected: click in the tree or the 3D view first."
        )

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

    def show_stored(self, stored: Any) -> None:
        super().show_stored(None if stored is None else (stored, []))

    @property
    def missing(self) -> str:
        text = tr("{} is missing: select it and press its Use selection.")
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
        self.text.setPlaceholderText(tr("none"))

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

    def value(self) -> Any:
        return self.objects

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.objects)

    def arguments(self) -> dict[str, str]:
        if not self.objects and not self.explicit:
            return {}
        return {self.link.key: f"[{', '.join(recorded.reference(obj) for obj in self.objects)}]"}
