# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether faces and edges that a feature names are still those that were chosen: FreeCAD numbers them anew when a part
changes."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...core.issues import WARNING, AmError, InputError, Issue, Text
from ..fields.properties import HIDDEN, OUTPUT
from ..stage import Stage
from ..stage_parts import Outcome
from ..staleness import UP_TO_DATE
from ..work import faults
from . import chord_error, nested
from .bodies import shape_of
from .file_issues import file_issues
from .marks import EDGE, FACE, LINE, PLANE, TOLERANCE, WHOLE, Mark, marks_of, read, whole_of

CODES = {FACE: "FACES_CHANGED", EDGE: "EDGES_CHANGED"}
LOST = "?"  # what the names of those that FreeCAD has lost begin with
SOURCE, OF = "Source", "/"  # the link whose marks are stored without its name and this
FORMS = {
    PLANE: Text("a plane"),
    "Part::GeomCylinder": Text("a cylinder"),
    "Part::GeomCone": Text("a cone"),
    "Part::GeomSphere": Text("a sphere"),
    "Part::GeomToroid": Text("a torus"),
    LINE: Text("a straight line"),
    "Part::GeomCircle": Text("a circle"),
    "Part::GeomEllipse": Text("an ellipse"),
}
FREE_FORM = {FACE: Text("a free-form surface"), EDGE: Text("a free-form curve")}


class FeatureStage(Stage):
    """Base of the features: what is deposited, and the faces and edges that say where and how, as links to parts."""

    _owners: dict[str, Any] | None = (
        None  # the names of the objects that links have, by link, once that is known
    )

    def complete(self, obj: Any) -> None:
        """With the marks of the faces and edges as they were when they were chosen."""
        super().complete(obj)
        self._owners = {link: _owner(obj, link) for link in self.chosen}
        if "ChosenFaces" not in obj.PropertiesList:
            help = "The faces and edges as they were chosen."
            obj.addProperty(
                "App::PropertyStringList", "ChosenFaces", "Result", help, HIDDEN | OUTPUT
            )
        self._learn(obj)  # in a document from before these were kept

    def linked(self, obj: Any) -> dict[str, Any]:
        """As of any stage. InputError BAD_FACES, BAD_EDGES for what FreeCAD, 1.0 or later, knows to be lost."""
        for link in self.chosen:
            lost = [
                name.lstrip(LOST) for name in names_of(getattr(obj, link)) if name.startswith(LOST)
            ]
            place, names = f"{obj.Label}.{link}", ", ".join(lost)
            if any(_kind(name) == EDGE for name in lost):
                raise InputError(
                    "BAD_EDGES",
                    place,
                    "{} is not there any more since the part changed; choose the edges again",
                    names,
                )
            if lost:
                raise InputError(
                    "BAD_FACES",
                    place,
                    "{} is not there any more since the part changed; choose the faces again",
                    names,
                )
        return super().linked(obj)

    def key(self, obj: Any) -> str:
        """As of any stage. InputError BAD_FACES, BAD_EDGES, BAD_AXIS for a path to a face or edge of another object than
        the one that is linked, which has others of these names."""
        for link in self.chosen:
            if linked := getattr(obj, link):
                nested.refuse_paths(*linked, f"{obj.Label}.{link}")
        return super().key(obj)

    @property
    def chosen(self) -> tuple[str, ...]:
        """The links to some faces or edges of a part."""
        return tuple(link.name for link in self.links if link.type_name == "App::PropertyLinkSub")

    def onChanged(self, obj: Any, name: str) -> None:
        """Other faces and edges, and those of another part, are what they are when they are chosen. FreeCAD 1.0 and later
        tell of a change also where the part was changed and the names stay."""
        document = obj.Document
        by_hand = not (
            document is None or document.Restoring or document.Transacting or document.Recomputing
        )
        if name in self.chosen and by_hand and "ChosenFaces" in obj.PropertiesList:
            named = _named(obj, name)
            others = named is not None and named != _stored(obj, name).keys() - {WHOLE}
            if others or (self._owners is not None and _owner(obj, name) != self._owners.get(name)):
                self.confirm(obj, name)
        if name in self.chosen and self._owners is not None:
            self._owners[name] = _owner(obj, name)
        super().onChanged(obj, name)

    def confirm(self, obj: Any, link: str) -> None:
        """What a link names is meant, as it is now."""
        self._keep(obj, {link: []})

    def renew(self, obj: Any, force: bool = False) -> Any:
        """As any stage; anew where what it warned about was confirmed. What fails says besides where a face or an edge is
        not the one that was chosen: that may be why."""
        try:
            found = super().renew(obj, force or (is_warned(obj) and bool(self._unknown(obj))))
        except InputError as error:
            issues = self._others(obj)
            if not issues:
                raise
            both = InputError(
                error.code,
                error.where,
                "{}. Besides, {}",
                error.message,
                issues[0].message,
                mended_by=error.mended_by,
            )
            self.say_failed(obj, both)
            raise both from None
        self._learn(
            obj
        )  # where it fits once more what it was made from, after something else was refused
        return found

    def _store(self, obj: Any, outcome: Outcome, *packed: Any) -> None:
        found: list[Issue] = []
        for link in self.chosen:
            marks = _marks(obj, link)
            issues = _compared(obj, link, marks)
            found += issues
            if not issues:
                self._keep(obj, {link: marks})
        known = set(outcome.issues)
        found += [issue for issue in file_issues(obj) if issue not in known]
        found += chord_error.notes(obj)
        super()._store(obj, dataclasses.replace(outcome, issues=(*found, *outcome.issues)), *packed)

    def _others(self, obj: Any) -> list[Issue]:
        """What is not what was chosen, of a feature that failed; nothing where the part cannot be looked at."""
        found: list[Issue] = []
        with contextlib.suppress(AmError), faults.kernel(obj):
            for link in self.chosen:
                found += _compared(obj, link, _marks(obj, link))
        return found

    def _unknown(self, obj: Any) -> list[str]:
        """The links of which nobody knows what they named when that was chosen."""
        return [link for link in self.chosen if _named(obj, link) and not _stored(obj, link)]

    def _learn(self, obj: Any) -> None:
        """What links name is what was chosen, where the result fits it and nothing is known."""
        if obj.Status == UP_TO_DATE and not is_warned(obj):
            self._keep(obj, {link: _marks(obj, link) for link in self._unknown(obj)})

    def _keep(self, obj: Any, marks: dict[str, list[Mark]]) -> None:
        """Store the marks of links, with those of the wholes; nothing of a link that has none."""
        texts = [text for text in obj.ChosenFaces if _link_of(text) not in marks]
        for link, own in marks.items():
            whole = (
                [whole_of(shape_of(getattr(obj, link)[0]), {_kind(mark.name) for mark in own})]
                if own
                else []
            )
            texts += [
                ("" if link == SOURCE else f"{link}{OF}") + mark.text() for mark in (*own, *whole)
            ]
        if texts != obj.ChosenFaces:
            obj.ChosenFaces = texts


def is_warned(obj: Any) -> bool:
    """Whether an object is a feature whose faces or edges are no longer those that were chosen."""
    if not isinstance(getattr(obj, "Proxy", None), FeatureStage):
        return False
    return any(f'"{code}"' in obj.Issues for code in CODES.values())


def _kind(name: str) -> str:
    """What a name is one of, '' for what is neither a face nor an edge."""
    return next((kind for kind in CODES if name.startswith(kind)), "")


def _named(obj: Any, link: str) -> set[str] | None:
    """The names of the faces and edges of a link, whether these are there or not; None where FreeCAD knows that one is lost,
    or there is nothing linked."""
    names = names_of(getattr(obj, link, None))
    lost = any(name.startswith(LOST) for name in names)
    return None if lost or not getattr(obj, link, None) else {name for name in names if _kind(name)}


def _owner(obj: Any, link: str) -> str:
    """The name of the object that a link has, '' for none."""
    return str(getattr(obj, link)[0].Name) if getattr(obj, link, None) else ""


def _link_of(text: str) -> str:
    """The link that a stored mark is of."""
    name = text.partition(" ")[0]
    return name.partition(OF)[0] if OF in name else SOURCE


def _stored(obj: Any, link: str) -> dict[str, Mark]:
    """What is stored of the faces and edges of a link, and of the whole, by name."""
    own = [
        text.partition(OF)[2] if OF in text else text
        for text in obj.ChosenFaces
        if _link_of(text) == link
    ]
    return {mark.name: mark for mark in map(read, own) if mark is not None}


def _marks(obj: Any, link: str) -> list[Mark]:
    """Of the faces and edges that a link names, as they are; none where it names none, or the part has no shape."""
    names = _named(obj, link)
    try:
        shape = shape_of(getattr(obj, link)[0]) if names else None
    except AmError:
        return []
    kinds = {_kind(name) for name in names or ()}
    return (
        []
        if shape is None
        else [mark for kind in sorted(kinds) for mark in marks_of(shape, kind, names or ())]
    )


def _compared(obj: Any, link: str, marks: Sequence[Mark]) -> tuple[Issue, ...]:
    """What is wrong with what a link names, as it is, by what it was when it was chosen.

    Parts grow and move: a face or an edge that is of the same kind, and lies the same way, is the same one, unless the one
    that was chosen is there unchanged under another number, and others came or went, or nothing but numbers changed; or a
    straight or plane one is there, larger or smaller, where others came or went. Lines of sketches are turned by an end.
    """
    before, now = _stored(obj, link), {mark.name: mark for mark in marks}
    was = before.pop(WHOLE, None)
    if was is None or before.keys() != now.keys():
        return ()
    source = getattr(obj, link)[0]
    shape = shape_of(source)
    size = shape.BoundBox.DiagonalLength
    whole = whole_of(shape, kinds := {_kind(name) for name in now})
    renumbered = whole.form != was.form or was.is_same(whole, size, FACE in kinds)
    for kind in sorted(kinds):
        flat, own = kind == FACE, [mark for mark in before.values() if _kind(mark.name) == kind]
        moved = [mark for mark in own if not mark.is_same(now[mark.name], size, flat)]
        every = marks_of(shape, kind) if moved else []
        middles = np.array([mark.middle for mark in every])
        for mark in moved:
            near = np.flatnonzero(
                np.abs(middles - mark.middle).max(axis=1) <= TOLERANCE * size
            ).tolist()
            same = [one.name for one in (every[k] for k in near) if mark.is_same(one, size, flat)]
            if not same and whole.form != was.form and not mark.is_along(now[mark.name], size):
                same = [one.name for one in every if mark.is_along(one, size)]
            if any(name in now for name in same):
                continue  # in another order
            if same and (renumbered or not mark.is_alike(now[mark.name])):
                return (_elsewhere(mark.name, source.Label, same[0]),)
            turned = whole.form == was.form and _is_turned(mark, now[mark.name], shape)
            if not mark.is_alike(now[mark.name]) and not turned:
                return (_changed(mark, now[mark.name], source.Label),)
    return ()


def _is_turned(mark: Mark, now: Mark, shape: Any) -> bool:
    """Whether what lies another way, in a shape of as many faces or edges as before, is surely the same: there is no other
    one, or it is a line that was drawn by an end of it, as those of sketches are."""
    alone = len(shape.Faces if _kind(mark.name) == FACE else shape.Edges) == 1
    by_end = not shape.Faces and now.is_turned_about(mark, shape.BoundBox.DiagonalLength)
    return mark.form == now.form and (alone or by_end)


def _elsewhere(name: str, label: str, there: str) -> Issue:
    return _issue(
        name,
        Text(
            "{} of {} is not the face that was chosen: that face is {} now, as FreeCAD renumbers faces when a part changes; "
            "choose the faces again, or confirm them: OK in the panel with nothing else entered",
            name,
            label,
            there,
        )
        if _kind(name) == FACE
        else Text(
            "{} of {} is not the edge that was chosen: that edge is {} now, as FreeCAD renumbers edges when a part changes; "
            "choose the edges again, or confirm them: OK in the panel with nothing else entered",
            name,
            label,
            there,
        ),
    )


def _changed(mark: Mark, now: Mark, label: str) -> Issue:
    if mark.form == now.form:
        return _issue(
            mark.name,
            Text(
                "{} of {} lies another way than when it was chosen, so it may be another face, as FreeCAD renumbers faces "
                "when a part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered",
                mark.name,
                label,
            )
            if _kind(mark.name) == FACE
            else Text(
                "{} of {} lies another way than when it was chosen, so it may be another edge, as FreeCAD renumbers edges "
                "when a part changes; choose the edges again, or confirm them: OK in the panel with nothing else entered",
                mark.name,
                label,
            ),
        )
    kind = _kind(mark.name)
    was, is_ = (FORMS.get(one.form, FREE_FORM[kind]) for one in (mark, now))
    return _issue(
        mark.name,
        Text(
            "{} of {} was {} when it was chosen and is {} now, so it may be another face, as FreeCAD renumbers faces when a "
            "part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered",
            mark.name,
            label,
            was,
            is_,
        )
        if kind == FACE
        else Text(
            "{} of {} was {} when it was chosen and is {} now, so it may be another edge, as FreeCAD renumbers edges when a "
            "part changes; choose the edges again, or confirm them: OK in the panel with nothing else entered",
            mark.name,
            label,
            was,
            is_,
        ),
    )


def _issue(name: str, message: str) -> Issue:
    return Issue(WARNING, CODES[_kind(name)], message)


def names_of(link: Any) -> tuple[str, ...]:
    """What a link names of an object, '' for all of it left out, without the objects that this is nested in."""
    return tuple(name.rsplit(".", maxsplit=1)[-1] for name in link[1] if name) if link else ()


def source_of(obj: Any) -> tuple[Any, tuple[str, ...]]:
    """The object of a feature's Source and the names of the faces chosen. InputError 'NO_INPUT', 'BAD_FACES'."""
    if not obj.Source:
        raise InputError(
            "NO_INPUT",
            obj.Label,
            "Source is missing; choose the shape to deposit, or some of its faces",
        )
    source, names = obj.Source
    wrong = ", ".join(
        name for name in names if name and not name.rsplit(".", maxsplit=1)[-1].startswith(FACE)
    )
    if wrong:
        raise InputError(
            "BAD_FACES",
            f"{obj.Label}.Source",
            "{} is not a face; choose faces or the whole shape",
            wrong,
        )
    return source, names_of(obj.Source)
