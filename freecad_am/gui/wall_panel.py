# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a wall on an existing part: wall and substrate are picked, and the first layer is seen while it is open."""

from __future__ import annotations

import contextlib
from time import monotonic
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore

from ..core.issues import AmError, InputError, Issue
from ..objects.surface_feature import SurfaceFeature
from . import picking
from .colours import WRONG
from .pick_field import PickField
from .preview import WallPreview, outcome
from .stage_panel import StagePanel
from .wall_nodes import first_curves

LOOK_EVERY = 250  # ms; what has not changed between two looks is previewed,
LONGEST_WAIT = 1.5  # s; and where that takes long, not before as long has passed, but for this
DRAFT = "Wall"
_NAMES = {"Source": "Wall", "Substrate": "Substrate"}


class WallPanel(StagePanel):
    """Makes a wall on a part of what is selected, or changes one. The document is left alone before OK."""

    icon, function = "wall_on_part", "make_surface_feature"
    is_open = True
    armed: PickField | None = None  # the one that waits for clicks
    changed_at = took = 0.0  # s; when the entries last changed, and how long the last preview took

    def __init__(self, obj: Any = None) -> None:
        self.picks = [
            PickField(link, _label(link), None if obj is None else getattr(obj, link.name), self._arm)
            for link in SurfaceFeature.links
        ]
        unclear = ""
        if obj is None:
            unclear = self._propose()
        super().__init__(SurfaceFeature, "Wall on part" if obj is None else obj.Label, self.picks, obj)
        self.seen: Any = None  # the entries at the last look
        self.shown: Any = None  # those that are previewed
        self.state = self._note("preview", "palette(text)")
        self.column.removeWidget(self.state)
        self.column.insertWidget(2, self.state)
        self.preview = WallPreview(self.document)
        if obj is not None:
            obj.ViewObject.Proxy.wall.show(False)
        Gui.Selection.clearSelection()  # or its colour would hide what is previewed
        Gui.Selection.addObserver(self)
        self.timer = QtCore.QTimer(self.form)
        self.timer.setInterval(LOOK_EVERY)
        self.timer.timeout.connect(self._look)
        self.timer.start()
        self.form.destroyed.connect(self.close)
        self._arm_missing()
        self.say(unclear)

    def _propose(self) -> str:
        """Fill in what the selection tells; what is unclear about it."""
        wall, substrate, unclear = picking.proposal(picking.selected(App.ActiveDocument))
        for name, pick in (("Source", wall), ("Substrate", substrate)):
            if pick is not None:
                self._field(name).take(pick)
        edges = [pick for pick in picking.selected(App.ActiveDocument) if wall is not None and pick.obj == wall.obj]
        for field in self.picks:
            if field.element == picking.EDGE and edges:
                field.take(edges[0])
        return unclear

    def _field(self, name: str) -> PickField:
        return next(field for field in self.picks if field.link.name == name)

    # ---- picking

    def _arm(self, field: PickField, on: bool) -> None:
        """The pick button of a field was pressed or released."""
        for other in self.picks:
            if on and other is not field:
                other.pick.setChecked(False)
        self.armed = field if on else (None if self.armed is field else self.armed)
        field.show()
        if on:
            self._take()  # what is selected already

    def _arm_missing(self) -> None:
        """Wait for the first input that is missing."""
        field = self._lacking()
        if field is not None:
            field.pick.setChecked(True)

    def _lacking(self) -> PickField | None:
        """The first input that is missing: a substrate is none where a wall starts at edges of its own."""
        if not self._field("Source").picks:
            return self._field("Source")
        edges = any(field.picks for field in self.picks if field.element == picking.EDGE)
        return None if edges or self._field("Substrate").picks else self._field("Substrate")

    def addSelection(self, *_: Any) -> None:
        """Something was clicked; called by FreeCAD, which must first be done with it."""
        if self.armed is not None:
            QtCore.QTimer.singleShot(0, self._take)

    setSelection = addSelection

    def _take(self) -> None:
        field = self.armed
        if field is None or not self.is_open:
            return
        picks = picking.selected(self.document)
        for pick in picks:
            following = self._next(field)
            if field.take(pick):
                self._tell(field.label, "")
            elif following is not None and following.take(pick):
                field = following
            else:
                self._tell(field.label, _refusal(field, pick))
        if picks:
            Gui.Selection.clearSelection()
            if field.picks and not field.more:
                for one in self.picks:
                    one.pick.setChecked(False)
                self._arm_missing()

    def _next(self, field: PickField) -> PickField | None:
        """The substrate while a click on another object than the wall's can only mean it."""
        substrate = self._field("Substrate")
        return substrate if field.link.name == "Source" and field.picks and not substrate.picks else None

    # ---- preview

    def _look(self) -> None:
        """Preview what is entered once it no longer changes."""
        try:
            now, time = self._entered(), monotonic()
            if now != self.seen:
                self.seen, self.changed_at = now, time
            elif now != self.shown and time - self.changed_at >= min(self.took, LONGEST_WAIT):
                self.shown = now
                self._renew()
                self.took = monotonic() - time
        except ReferenceError:
            self.close()

    def _entered(self) -> Any:
        texts = []
        for field, _, _ in self.places.values():
            try:
                texts.append((field.row.name, field.value))
            except InputError as error:
                texts.append((field.row.name, error.message))
        return self._inputs(), texts

    def _renew(self) -> None:
        for place in self.notes:
            self._tell(place, "")
        wall, curves = self._field("Source").picks, []
        source, names = (wall[0].obj, wall[0].names) if wall else (None, ())
        lacking = self._lacking()
        if lacking is not None:
            self._say(f"{lacking.label} is missing: click it in the tree or the 3D view.", False)
            self.preview.show(source, names, curves)
            return
        try:
            made = outcome(SurfaceFeature, self.document, DRAFT, self._links(), self._values())
            curves, names = first_curves(made.value), made.value.faces
            self._say(_told(curves, made.issues), False)
        except InputError as error:
            self._place(error)
        except AmError as error:
            self._say(str(error), True)
        except Exception as error:  # of OpenCASCADE; OK would tell it too
            self._say(f"{type(error).__name__}: {error}", True)
        self.preview.show(source, names, curves)

    def _links(self) -> dict[str, Any]:
        return {field.link.name: field.value() for field in self.picks}

    def _values(self) -> dict[str, Any]:
        found = {}
        for place, (field, _, _) in self.places.items():
            try:
                found[field.row.name] = field.value
            except InputError as error:
                raise InputError(error.code, place, error.message) from None
        return found

    def _place(self, error: InputError) -> None:
        """Tell an error under the field it belongs to."""
        self._say("No preview: see the field marked.", False)
        for place, (field, _, fold) in self.places.items():
            if error.where.replace(".", "_") == place or error.where == f"{DRAFT}.{field.row.name}":
                fold.heading.setChecked(True)
                self._tell(place, error.message)
                return
        named = [(pick.obj.Label, field.label) for field in self.picks for pick in field.picks]
        named += [(f"{DRAFT}.{field.link.name}", field.label) for field in self.picks]
        for label, place in sorted(named, key=lambda pair: -len(pair[0])):
            if error.where == label or error.where.startswith(f"{label} "):
                self._tell(place, f"{error.where.removeprefix(label)} {error.message}".strip())
                return
        self._say(str(error), True)

    def _tell(self, place: str, text: str) -> None:
        self.notes[place].setText(text)
        self.notes[place].setVisible(bool(text))

    def _say(self, text: str, wrong: bool) -> None:
        self.state.setStyleSheet(f"QLabel {{ color: {WRONG if wrong else 'palette(text)'}; }}")
        self.state.setText(text)
        self.state.setVisible(bool(text))

    # ---- called by FreeCAD

    def accept(self) -> bool:
        """Make or change the wall; True closes the panel."""
        done = super().accept()
        if done:
            self.close()
        return done

    def reject(self) -> bool:
        """Nothing was done; what was previewed goes."""
        self.close()
        return super().reject()

    def close(self, *_: Any) -> None:
        """Take away the preview, and look at clicks no more; once or more often."""
        if not self.is_open:
            return
        self.is_open = False
        Gui.Selection.removeObserver(self)
        self.preview.remove()
        with contextlib.suppress(RuntimeError):  # the panel is gone, and with it the timer
            self.timer.stop()
        with contextlib.suppress(RuntimeError, ReferenceError, AttributeError):  # the object is gone
            if self.obj is not None:
                self.obj.ViewObject.Proxy.wall.show(True)


def _label(link: Any) -> str:
    words = link.key.replace("_", " ")
    return _NAMES.get(link.name, words[0].upper() + words[1:])


def _refusal(field: PickField, pick: picking.Pick) -> str:
    if field.element == picking.EDGE:
        return "Click edges of one object."
    if picking.is_mesh(pick.obj):
        return f"{pick.obj.Label} is a mesh; a wall is of faces."
    return f"{pick.obj.Label} is another object; faces of a wall are of one object. Clear it first to start again."


def _told(curves: list[Any], issues: tuple[Issue, ...]) -> str:
    lengths = [float(np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()) for curve in curves]
    kinds = ["closed" if np.allclose(curve[0], curve[-1], atol=1e-9) else "open" for curve in curves]
    parts = [f"{kind}, {length:.1f} mm" for kind, length in zip(kinds, lengths, strict=True)]
    findings = (issue.message[:1].upper() + issue.message[1:] for issue in issues)
    return "\n".join([f"First layer: {'; '.join(parts)}", *findings])
