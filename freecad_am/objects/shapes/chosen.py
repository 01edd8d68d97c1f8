# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether faces and edges that a feature names are still the chosen ones: FreeCAD renumbers them
when a part changes.
"""

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
from . import bodies, nested
from .bodies import shape_of
from .nested import EDGE, FACE, LINE, PLANE, TOLERANCE, WHOLE_PART, Mark, marks_of, read, whole_of
from .part_file import file_issues

CODES = {FACE: "FACES_CHANGED", EDGE: "EDGES_CHANGED"}
LOST_PREFIX = "?"  # prefix of names that FreeCAD has lost
SOURCE, OF = "Source", "/"  # the link whose marks are stored without its name and this separator
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
    """Base of the features: sources of the deposit, with faces and edges that determine its
    position and kind, as links to parts.
    """

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
        """As for any stage. Raises InputError BAD_FACES, BAD_EDGES for elements that FreeCAD, 1.0 or
        later, knows to be lost.
        """
        for link in self.chosen:
            lost_names = [
                name.lstrip(LOST_PREFIX)
                for name in names_of(getattr(obj, link))
                if name.startswith(LOST_PREFIX)
            ]
            where, names = f"{obj.Label}.{link}", ", ".join(lost_names)
            if any(_kind(name) == EDGE for name in lost_names):
                raise InputError(
                    "BAD_EDGES",
                    where,
                    "{} no longer exists after a change of the part; choose the edges again",
                    names,
                )
            if lost_names:
                raise InputError(
                    "BAD_FACES",
                    where,
                    "{} no longer exists after a change of the part; choose the faces again",
                    names,
                )
        return super().linked(obj)

    def key(self, obj: Any) -> str:
        """As for any stage. Raises InputError BAD_FACES, BAD_EDGES, BAD_AXIS for a path to a face or edge
        of another object than the linked one, which has other elements of the same names.
        """
        for link in self.chosen:
            if linked := getattr(obj, link):
                nested.refuse_paths(*linked, f"{obj.Label}.{link}")
        return super().key(obj)

    @property
    def chosen(self) -> tuple[str, ...]:
        """The links to some faces or edges of a part."""
        return tuple(link.name for link in self.links if link.type_name == "App::PropertyLinkSub")

    def onChanged(self, obj: Any, name: str) -> None:
        """New faces and edges, or elements of another part, are recorded when they are chosen.
        FreeCAD 1.0 and later report a change also if only the part changed and the names stay.
        """
        document = obj.Document
        by_hand = not (
            document is None or document.Restoring or document.Transacting or document.Recomputing
        )
        if name in self.chosen and by_hand and "ChosenFaces" in obj.PropertiesList:
            named = _named(obj, name)
            names_changed = named is not None and named != _stored(obj, name).keys() - {WHOLE_PART}
            if names_changed or (
                self._owners is not None and _owner(obj, name) != self._owners.get(name)
            ):
                self.confirm(obj, name)
        if name in self.chosen and self._owners is not None:
            self._owners[name] = _owner(obj, name)
        super().onChanged(obj, name)

    def confirm(self, obj: Any, link: str) -> None:
        """What a link names is meant, as it is now."""
        self._keep(obj, {link: []})

    def renew(self, obj: Any, force: bool = False) -> Any:
        """As any stage; computed again after a warning was confirmed. An error also names faces or
        edges that are not the chosen ones: they may be the cause.
        """
        try:
            result = super().renew(obj, force or (is_warned(obj) and bool(self._unknown(obj))))
        except InputError as error:
            issues = self._others(obj)
            if not issues:
                raise
            combined_error = InputError(
                error.code,
                error.where,
                "{}. Besides, {}",
                error.message,
                issues[0].message,
                mended_by=error.mended_by,
            )
            self.say_failed(obj, combined_error)
            raise combined_error from None
        self._learn(obj)  # for inputs that fit the result again, after others were refused
        return result

    def _store(self, obj: Any, outcome: Outcome, *packed: Any) -> None:
        issues_found: list[Issue] = []
        for link in self.chosen:
            marks = _marks(obj, link)
            issues = _compared(obj, link, marks)
            issues_found += issues
            if not issues:
                self._keep(obj, {link: marks})
        outcome_issues = set(outcome.issues)
        issues_found += [issue for issue in file_issues(obj) if issue not in outcome_issues]
        issues_found += bodies.notes(obj)
        super()._store(
            obj, dataclasses.replace(outcome, issues=(*issues_found, *outcome.issues)), *packed
        )

    def _others(self, obj: Any) -> list[Issue]:
        """The elements of a failed feature that are not the chosen ones; empty if the part cannot
        be read.
        """
        differences: list[Issue] = []
        with contextlib.suppress(AmError), faults.kernel(obj):
            for link in self.chosen:
                differences += _compared(obj, link, _marks(obj, link))
        return differences

    def _unknown(self, obj: Any) -> list[str]:
        """The links without marks of the elements that were chosen."""
        return [link for link in self.chosen if _named(obj, link) and not _stored(obj, link)]

    def _learn(self, obj: Any) -> None:
        """Record the elements of links without marks as the chosen ones if the result fits them."""
        if obj.Status == UP_TO_DATE and not is_warned(obj):
            self._keep(obj, {link: _marks(obj, link) for link in self._unknown(obj)})

    def _keep(self, obj: Any, marks: dict[str, list[Mark]]) -> None:
        """Store the marks of links and of their whole parts; nothing for a link without marks."""
        texts = [text for text in obj.ChosenFaces if _link_of(text) not in marks]
        for link, link_marks in marks.items():
            whole_marks = (
                [
                    whole_of(
                        shape_of(getattr(obj, link)[0]), {_kind(mark.name) for mark in link_marks}
                    )
                ]
                if link_marks
                else []
            )
            texts += [
                ("" if link == SOURCE else f"{link}{OF}") + mark.text()
                for mark in (*link_marks, *whole_marks)
            ]
        if texts != obj.ChosenFaces:
            obj.ChosenFaces = texts


def is_warned(obj: Any) -> bool:
    """Whether an object is a feature whose faces or edges are no longer the chosen ones."""
    if not isinstance(getattr(obj, "Proxy", None), FeatureStage):
        return False
    return any(f'"{code}"' in obj.Issues for code in CODES.values())


def _kind(name: str) -> str:
    """The kind of a name, '' for neither a face nor an edge."""
    return next((kind for kind in CODES if name.startswith(kind)), "")


def _named(obj: Any, link: str) -> set[str] | None:
    """The names of the faces and edges of a link, existing or not; None if FreeCAD knows that one
    is lost, or nothing is linked.
    """
    names = names_of(getattr(obj, link, None))
    is_lost = any(name.startswith(LOST_PREFIX) for name in names)
    return (
        None if is_lost or not getattr(obj, link, None) else {name for name in names if _kind(name)}
    )


def _owner(obj: Any, link: str) -> str:
    """The name of the object that a link has, '' for none."""
    return str(getattr(obj, link)[0].Name) if getattr(obj, link, None) else ""


def _link_of(text: str) -> str:
    """The link that a stored mark is of."""
    name = text.partition(" ")[0]
    return name.partition(OF)[0] if OF in name else SOURCE


def _stored(obj: Any, link: str) -> dict[str, Mark]:
    """The stored marks of the faces and edges of a link, and of the whole, by name."""
    link_texts = [
        text.partition(OF)[2] if OF in text else text
        for text in obj.ChosenFaces
        if _link_of(text) == link
    ]
    return {mark.name: mark for mark in map(read, link_texts) if mark is not None}


def _marks(obj: Any, link: str) -> list[Mark]:
    """The current marks of the faces and edges that a link names; empty without names, or if the
    part has no shape.
    """
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
    """The issues with the current elements of a link, compared with the chosen ones.

    Parts grow and move: a face or an edge of the same kind and direction is the same one, unless
    the chosen one exists unchanged under another number, and others came or went, or nothing but
    numbers changed; or a straight or plane one exists, larger or smaller, where others came or
    went. Lines of sketches are turned by an end.
    """
    stored, now = _stored(obj, link), {mark.name: mark for mark in marks}
    was = stored.pop(WHOLE_PART, None)
    if was is None or stored.keys() != now.keys():
        return ()
    source = getattr(obj, link)[0]
    shape = shape_of(source)
    size = shape.BoundBox.DiagonalLength
    current_whole = whole_of(shape, kinds := {_kind(name) for name in now})
    renumbered = current_whole.form != was.form or was.is_same(current_whole, size, FACE in kinds)
    for kind in sorted(kinds):
        flat, kind_marks = (
            kind == FACE,
            [mark for mark in stored.values() if _kind(mark.name) == kind],
        )
        moved = [mark for mark in kind_marks if not mark.is_same(now[mark.name], size, flat)]
        all_marks = marks_of(shape, kind) if moved else []
        middles = np.array([mark.middle for mark in all_marks])
        for mark in moved:
            near_indices = np.flatnonzero(
                np.abs(middles - mark.middle).max(axis=1) <= TOLERANCE * size
            ).tolist()
            same = [
                candidate.name
                for candidate in (all_marks[k] for k in near_indices)
                if mark.is_same(candidate, size, flat)
            ]
            if (
                not same
                and current_whole.form != was.form
                and not mark.is_along(now[mark.name], size)
            ):
                same = [candidate.name for candidate in all_marks if mark.is_along(candidate, size)]
            if any(name in now for name in same):
                continue  # in another order
            if same and (renumbered or not mark.is_alike(now[mark.name])):
                return (_elsewhere(mark.name, source.Label, same[0]),)
            turned = current_whole.form == was.form and _is_turned(mark, now[mark.name], shape)
            if not mark.is_alike(now[mark.name]) and not turned:
                return (_changed(mark, now[mark.name], source.Label),)
    return ()


def _is_turned(mark: Mark, now: Mark, shape: Any) -> bool:
    """Whether an element with a new direction, in a shape with an unchanged number of faces or
    edges, is surely the same: it is the only one, or a line that was dragged by an end, as in
    sketches.
    """
    alone = len(shape.Faces if _kind(mark.name) == FACE else shape.Edges) == 1
    by_end = not shape.Faces and now.is_turned_about(mark, shape.BoundBox.DiagonalLength)
    return mark.form == now.form and (alone or by_end)


def _elsewhere(name: str, label: str, new_name: str) -> Issue:
    return _issue(
        name,
        Text(
            "{} of {} is not the selected face: that face is {} now, as FreeCAD renumbers faces "
            "when a part changes; choose the faces again, or confirm them: OK in the panel "
            "without other changes",
            name,
            label,
            new_name,
        )
        if _kind(name) == FACE
        else Text(
            "{} of {} is not the selected edge: that edge is {} now, as FreeCAD renumbers edges "
            "when a part changes; choose the edges again, or confirm them: OK in the panel "
            "without other changes",
            name,
            label,
            new_name,
        ),
    )


def _changed(mark: Mark, now: Mark, label: str) -> Issue:
    if mark.form == now.form:
        return _issue(
            mark.name,
            Text(
                "{} of {} has changed its position since its selection and may be another face, "
                "as FreeCAD renumbers faces when a part changes; choose the faces again, or "
                "confirm them: OK in the panel without other changes",
                mark.name,
                label,
            )
            if _kind(mark.name) == FACE
            else Text(
                "{} of {} has changed its position since its selection and may be another edge, "
                "as FreeCAD renumbers edges when a part changes; choose the edges again, or "
                "confirm them: OK in the panel without other changes",
                mark.name,
                label,
            ),
        )
    kind = _kind(mark.name)
    was, is_ = (FORMS.get(state.form, FREE_FORM[kind]) for state in (mark, now))
    return _issue(
        mark.name,
        Text(
            "{} of {} was {} when selected and is {} now, so it may be another face, as FreeCAD "
            "renumbers faces when a part changes; choose the faces again, or confirm them: OK in "
            "the panel without other changes",
            mark.name,
            label,
            was,
            is_,
        )
        if kind == FACE
        else Text(
            "{} of {} was {} when selected and is {} now, so it may be another edge, as FreeCAD "
            "renumbers edges when a part changes; choose the edges again, or confirm them: OK in "
            "the panel without other changes",
            mark.name,
            label,
            was,
            is_,
        ),
    )


def _issue(name: str, message: str) -> Issue:
    return Issue(WARNING, CODES[_kind(name)], message)


def names_of(link: Any) -> tuple[str, ...]:
    """The names of a link on an object, without '' for the complete object and without the
    containers in paths.
    """
    return tuple(name.rsplit(".", maxsplit=1)[-1] for name in link[1] if name) if link else ()


def source_of(obj: Any) -> tuple[Any, tuple[str, ...]]:
    """The object of a feature's Source and the names of the faces chosen. Raises InputError 'NO_INPUT', 'BAD_FACES'."""
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
