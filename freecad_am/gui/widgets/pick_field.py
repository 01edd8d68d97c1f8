# SPDX-License-Identifier: LGPL-2.1-or-later
"""A panel input that is picked in the tree or the 3D view. One button waits for clicks, another
clears it.
"""

from __future__ import annotations

import contextlib
import weakref
from collections.abc import Callable
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...objects.stage_parts import Link
from .. import recorded
from ..in_language import tr, translated
from ..picking import EDGE, FACE, Pick, is_mesh


def pick_button(text: str, name: str, help: str) -> Any:
    """Create a narrow button next to the field of an input."""
    button = QtGui.QToolButton()
    button.setText(text)
    button.setObjectName(name)
    button.setToolTip(help)
    button.setFocusPolicy(QtCore.Qt.TabFocus)
    return button


class NextClick:
    """Calls the method `act` when something is selected after `wait`; stops when `widget` is
    deleted.

    The method is held weakly. Its object holds this object, and a reference cycle would keep the
    fields of a closed panel.
    """

    def __init__(self, widget: Any, act: Callable[[], None]) -> None:
        self.act, self.waits = weakref.WeakMethod(act), False
        widget.destroyed.connect(self.stop)

    def wait(self) -> None:
        """Wait for the next click."""
        if not self.waits:
            self.waits = True
            Gui.Selection.addObserver(self)

    def stop(self, *_: Any) -> None:
        """Stop waiting; may be called repeatedly."""
        if self.waits:
            self.waits = False
            Gui.Selection.removeObserver(self)

    def addSelection(self, *_: Any) -> None:
        """Handle a click after FreeCAD has finished it; called by FreeCAD."""
        QtCore.QTimer.singleShot(0, self._clicked)

    setSelection = addSelection

    def _clicked(self) -> None:
        if self.waits:
            self.stop()
            act = self.act()
            with contextlib.suppress(RuntimeError):  # the panel is closed
                if act is not None:
                    act()


class Input:
    """A row of the panel that supplies arguments to the macro function."""

    label = ""
    link: Link
    widget: Any = None
    places: tuple[str, ...] = ()  # names of the row in errors, other than its link

    def show_note(self, text: str) -> None:
        """Show a note under the widget; the panel replaces this method."""

    @property
    def missing(self) -> str:
        """Return what the user should do if there is nothing to choose, otherwise ''."""
        return ""

    def arguments(self) -> dict[str, str]:
        """Return the arguments by keyword as Python source text."""
        raise NotImplementedError

    def applied(self) -> None:
        """Store the entry as the state of the document."""

    def stored(self, obj: Any) -> Any:
        """Return the input's value of a stage in the document."""
        return getattr(obj, self.link.name)

    def show_stored(self, stored: Any) -> None:
        """Replace the entry by the value of a stage in the document."""
        raise NotImplementedError


_LIST = "App::PropertyLinkList"


class PickField(Input):
    """Input for a link of a stage: faces or edges of an object, a whole object, or several objects."""

    def __init__(
        self,
        link: Link,
        label: str,
        present: Any,
        toggled: Callable[[PickField, bool], None],
        element: str = "",
        meshes: bool = False,
        allow_whole: bool = False,
    ) -> None:
        """Create the input.

        element: type of picked elements, '' for whole objects. meshes: accept meshes although
        elements are picked. allow_whole: accept a whole object instead of its edges.
        """
        self.link, self.label, self.element = link, label, element
        self.several = link.type_name == _LIST
        self.meshes = meshes or not element
        self.whole = allow_whole or element != EDGE
        self.picks = self._present(present)
        self.explicit = link.required or bool(
            self.picks
        )  # whether a macro must pass an empty input explicitly
        self.widget = QtGui.QWidget()
        self.widget.setObjectName(f"Input{link.name}")
        self.widget.setToolTip(translated(link.help))
        self.text = QtGui.QLineEdit()
        self.text.setObjectName(link.name)
        self.text.setReadOnly(True)
        self.text.setMinimumWidth(40)
        self.pick = pick_button(
            tr("Pick"),
            f"Pick{link.name}",
            tr("Then click in the tree or the 3D view. {}").format(translated(link.help)),
        )
        self.pick.setCheckable(True)
        self.pick.toggled.connect(lambda on: toggled(self, on))
        self.empty = pick_button("×", f"Clear{link.name}", tr("Clears the field"))
        self.empty.clicked.connect(self.clear)
        row = QtGui.QHBoxLayout(self.widget)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(2)
        row.addWidget(self.text, 1)
        for button in (self.pick, self.empty):
            row.addWidget(button)
        self.show()

    def _present(self, present: Any) -> list[Pick]:
        if not present:
            return []
        if self.element:
            return [Pick(present[0], tuple(name for name in present[1] if name))]
        return [Pick(obj) for obj in (present if self.several else [present])]

    # ---- picking

    def take(self, pick: Pick) -> bool:
        """Add a click, or remove it if already picked; return False if it is rejected."""
        names = tuple(name for name in pick.names if self.element and name.startswith(self.element))
        if (not self.whole and not names) or (is_mesh(pick.obj) and not self.meshes):
            return False
        current = self.picks[0] if self.picks else None
        if self.several:
            remaining = [entry for entry in self.picks if entry.obj != pick.obj]
            self.picks = (
                remaining if len(remaining) < len(self.picks) else [*remaining, Pick(pick.obj)]
            )
        elif current is not None and current.names and names:
            if current.obj != pick.obj:
                return False
            kept_names = tuple(name for name in current.names if name not in names)
            new = tuple(name for name in names if name not in current.names)
            self.picks = [Pick(current.obj, kept_names + new)] if kept_names + new else []
        else:
            self.picks = [Pick(pick.obj, names)]
        self.show()
        return True

    @property
    def more(self) -> bool:
        """Whether further clicks add to the picks."""
        return self.several or bool(self.element and self.picks and self.picks[0].names)

    def clear(self, *_: Any) -> None:
        """Remove all picks."""
        self.picks = []
        self.show()

    def show(self) -> None:
        """Show the picks, or a hint to click."""
        text = ", ".join(" ".join([pick.obj.Label, *pick.names]) for pick in self.picks)
        self.text.setText(text)
        self.text.setCursorPosition(0)
        self.text.setToolTip(text or translated(self.link.help))
        if self.pick.isChecked():
            several = tr("click objects") if self.several else tr("click an object")
            prompt = {FACE: tr("click faces or an object"), EDGE: tr("click edges")}.get(
                self.element, several
            )
        else:
            prompt = tr("pick") if self.link.required else tr("none")
        self.text.setPlaceholderText(prompt)
        self.empty.setEnabled(bool(self.picks))

    # ---- for the panel

    @property
    def missing(self) -> str:
        if not self.link.required or self.picks:
            return ""
        return tr("{} is missing: click it in the tree or the 3D view.").format(self.label)

    def value(self) -> Any:
        """Return the picks in the form of the link's property."""
        if self.several:
            return [pick.obj for pick in self.picks]
        if not self.picks:
            return None
        return (self.picks[0].obj, list(self.picks[0].names)) if self.element else self.picks[0].obj

    def show_stored(self, stored: Any) -> None:
        self.picks = self._present(stored)
        self.show()

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.picks)

    def arguments(self) -> dict[str, str]:
        references = [recorded.reference(pick.obj) for pick in self.picks]
        if not references and not self.explicit:
            return {}
        if self.several:
            return {self.link.key: f"[{', '.join(references)}]"}
        if not self.picks:
            return {self.link.key: "None"}
        names = list(self.picks[0].names)
        if self.link.name == "Source":
            return {"source": references[0], "faces": repr(names)}
        return {
            self.link.key: repr(names) if self.element else references[0]
        }  # edges belong to the wall's own object
