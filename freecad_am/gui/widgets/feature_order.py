# SPDX-License-Identifier: LGPL-2.1-or-later
"""The order of several features in the panel of a toolpath: which come after the first, and in what sequence of layers."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ...core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ...objects.stage import stage_of
from ...objects.stage_parts import Link
from .. import recorded
from ..picking.pick_field import Input
from ..picking.shape_inputs import StageChoice, selected
from ..texts.in_language import marked, tr, translated

SHOWN = 3  # rows
PADDING = 14  # px about the word of a button
NAMES = {BY_FEATURE: marked("one after the other"), BY_HEIGHT: marked("lowest layer first")}


class FeatureOrder(Input):
    """The features after the first, which `first` chooses; those selected are added when the panel opens for a new toolpath,
    and by a button. Up on the topmost one makes it the first."""

    def __init__(self, link: Link, first_choice: StageChoice, present: Any, sequence: str) -> None:
        self.link, self.label, self.first = link, translated(link.label), first_choice
        self.explicit = bool(present)
        self.document = first_choice.document
        self.widget = QtGui.QWidget()
        self.widget.setToolTip(translated(link.help))
        column = QtGui.QVBoxLayout(self.widget)
        column.setContentsMargins(0, 0, 0, 0)
        self.list = QtGui.QListWidget()
        self.list.setObjectName("FeatureOrder")
        self.list.setMaximumHeight(int((SHOWN + 0.5) * self.list.fontMetrics().lineSpacing()) + 8)
        column.addWidget(self.list)
        row = QtGui.QHBoxLayout()
        buttons = (
            (
                "AddFeature",
                tr("Add"),
                tr("Adds the selected features, or the next one in the document"),
                self.add,
            ),
            (
                "FeatureUp",
                tr("Up"),
                tr("Deposits the chosen feature earlier"),
                lambda: self.move(-1),
            ),
            (
                "FeatureDown",
                tr("Down"),
                tr("Deposits the chosen feature later"),
                lambda: self.move(1),
            ),
            (
                "RemoveFeature",
                tr("Remove"),
                tr("Removes the selected feature from this toolpath"),
                self.remove,
            ),
        )
        for name, text, tip, act in buttons:
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.setToolTip(tip)
            button.setAutoDefault(False)
            # as narrow as its word: four as wide as a style likes them make the panel wider than it is
            button.setMinimumWidth(button.fontMetrics().horizontalAdvance(text) + PADDING)
            button.clicked.connect(lambda *_, act=act: act())
            row.addWidget(button)
        column.addLayout(row)
        self.sequence = QtGui.QComboBox()
        self.sequence.setObjectName("Sequence")
        self.sequence.setToolTip(
            tr(
                "Order of several features: one after the other, or the lowest layer of any "
                "feature first"
            )
        )
        for value, name in NAMES.items():
            self.sequence.addItem(translated(name), value)
        self.sequence.setCurrentIndex(self.sequence.findData(sequence))
        column.addWidget(self.sequence)
        for obj in self._selected() if present is None else present:
            self._put(obj)
        self._show()

    def names(self) -> list[str]:
        """The names of the features after the first, in their order."""
        return [self.list.item(row).data(QtCore.Qt.UserRole) for row in range(self.list.count())]

    def add(self) -> None:
        """Add the features selected, else the next of the document that is not in the list."""
        all_names = [self.first.widget.itemData(k) for k in range(self.first.widget.count())]
        remaining = [
            name
            for name in all_names
            if name not in (*self.names(), self.first.widget.currentData())
        ]
        features = self._selected() or [self.document.getObject(name) for name in remaining[:1]]
        for obj in features:
            self._put(obj)
        self.show_note(
            "" if features else tr("This document has no other feature; create it first.")
        )
        self._show()

    def move(self, by: int) -> None:
        """Move the chosen feature up or down by one."""
        row, names = self.list.currentRow(), self.names()
        if row < 0:
            return
        if row + by < 0:  # it becomes the first, and that the topmost
            former = self.first.widget.currentData()
            self.first.widget.setCurrentIndex(self.first.widget.findData(names[0]))
            names[0] = former
        elif row + by < len(names):
            names[row], names[row + by] = names[row + by], names[row]
        self.list.clear()
        for name in names:
            self._put(self.document.getObject(name))
        self.list.setCurrentRow(min(max(row + by, 0), len(names) - 1))

    def remove(self) -> None:
        """Take the chosen feature out."""
        self.list.takeItem(self.list.currentRow())
        self._show()

    def stored(self, obj: Any) -> Any:
        return list(getattr(obj, self.link.name)), obj.Sequence

    def show_stored(self, stored: Any) -> None:
        objects, sequence = stored
        self.list.clear()
        for obj in objects:
            self._put(obj)
        self.sequence.setCurrentIndex(self.sequence.findData(sequence))
        self._show()

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.names())

    def arguments(self) -> dict[str, str]:
        names = [name for name in self.names() if name != self.first.widget.currentData()]
        if not names and not self.explicit:
            return {}
        references = ", ".join(recorded.reference(self.document.getObject(name)) for name in names)
        return {self.link.key: f"[{references}]", "sequence": repr(self.sequence.currentData())}

    def _selected(self) -> list[Any]:
        """Return the selected features except the first one."""
        features = [
            obj
            for obj in selected(self.document.Name)
            if getattr(stage_of(obj), "kind", "") == "feature"
        ]
        return [obj for obj in features if obj.Name != self.first.widget.currentData()]

    def _put(self, obj: Any) -> None:
        if obj is None or obj.Name in self.names():
            return
        item = QtGui.QListWidgetItem(obj.Label)
        item.setData(QtCore.Qt.UserRole, obj.Name)
        self.list.addItem(item)

    def _show(self) -> None:
        self.sequence.setEnabled(self.list.count() > 0)
