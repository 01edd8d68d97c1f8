# SPDX-License-Identifier: LGPL-2.1-or-later
"""Detect whether the faces and edges named by a feature are still the selected faces and edges.

FreeCAD renumbers faces and edges when a part changes.
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
from ..work import progress
from . import bodies, nested
from .bodies import shape_of
from .nested import EDGE, FACE, LINE, PLANE, TOLERANCE, WHOLE_PART, Mark, marks_of, read, whole_of
from .part_file import file_issues

CODES = {FACE: "FACES_CHANGED", EDGE: "EDGES_CHANGED"}
LOST_PREFIX = "?"  # FreeCAD's prefix of lost names
SOURCE, OF = "Source", "/"  # link whose marks have no name prefix, and separator of the prefix
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
    """Base of feature stages, which link to parts and to faces and edges of parts."""

    _owners: dict[str, Any] | None = None  # names of the linked objects by link, None until known

    def complete(self, obj: Any) -> None:
        """Add missing properties, including the marks of the selected faces and edges."""
        super().complete(obj)
        self._owners = {link: _owner(obj, link) for link in self.chosen}
        if "ChosenFaces" not in obj.PropertiesList:
            help = "The chosen faces and edges."
            obj.addProperty(
                "App::PropertyStringList", "ChosenFaces", "Result", help, HIDDEN | OUTPUT
            )
        self._learn(obj)  # for documents from versions without marks

    def linked(self, obj: Any) -> dict[str, Any]:
        """Return the linked stages, as in the base class.

        Raises InputError BAD_FACES, BAD_EDGES for elements that FreeCAD 1.0 or later marks as lost.
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
        """Return the input key, as in the base class.

        Raises InputError BAD_FACES, BAD_EDGES, BAD_AXIS for a path to a face or edge of an object
        other than the linked object, in which the same names mean other elements.
        """
        for link in self.chosen:
            if linked := getattr(obj, link):
                nested.refuse_paths(*linked, f"{obj.Label}.{link}")
        return super().key(obj)

    @property
    def chosen(self) -> tuple[str, ...]:
        """Return the names of links to faces or edges of a part."""
        return tuple(link.name for link in self.links if link.type_name == "App::PropertyLinkSub")

    def onChanged(self, obj: Any, name: str) -> None:
        """Record newly selected faces and edges.

        FreeCAD 1.0 and later also report a change if only the part changed and the names stay.
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
        """Accept the elements that a link currently names as the selected elements."""
        self._keep(obj, {link: []})

    def renew(self, obj: Any, force: bool = False) -> Any:
        """Compute the stage, as in the base class, also after a warning was confirmed.

        An error also names faces or edges that are no longer the selected ones, a possible cause.
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
        self._learn(obj)  # inputs may match the result again after other inputs were rejected
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
        """Return issues on changed elements of a failed feature; empty for an unreadable part."""
        differences: list[Issue] = []
        with contextlib.suppress(AmError), progress.kernel_faults(obj):
            for link in self.chosen:
                differences += _compared(obj, link, _marks(obj, link))
        return differences

    def _unknown(self, obj: Any) -> list[str]:
        """Return the links whose selected elements have no marks."""
        return [link for link in self.chosen if _named(obj, link) and not _stored(obj, link)]

    def _learn(self, obj: Any) -> None:
        """Record the elements of links without marks as selected, if the result is up to date."""
        if obj.Status == UP_TO_DATE and not is_warned(obj):
            self._keep(obj, {link: _marks(obj, link) for link in self._unknown(obj)})

    def _keep(self, obj: Any, marks: dict[str, list[Mark]]) -> None:
        """Store the marks of links and of their whole parts; remove links without marks."""
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
    """Whether an object is a feature with a warning about changed faces or edges."""
    if not isinstance(getattr(obj, "Proxy", None), FeatureStage):
        return False
    return any(f'"{code}"' in obj.Issues for code in CODES.values())


def _kind(name: str) -> str:
    """Return the element kind of a name, '' for neither a face nor an edge."""
    return next((kind for kind in CODES if name.startswith(kind)), "")


def _named(obj: Any, link: str) -> set[str] | None:
    """Return the face and edge names of a link, whether or not the elements exist.

    None for an empty link, or if FreeCAD marks a name as lost.
    """
    names = names_of(getattr(obj, link, None))
    is_lost = any(name.startswith(LOST_PREFIX) for name in names)
    return (
        None if is_lost or not getattr(obj, link, None) else {name for name in names if _kind(name)}
    )


def _owner(obj: Any, link: str) -> str:
    """Return the name of the linked object, '' for an empty link."""
    return str(getattr(obj, link)[0].Name) if getattr(obj, link, None) else ""


def _link_of(text: str) -> str:
    """Return the link of a stored mark."""
    name = text.partition(" ")[0]
    return name.partition(OF)[0] if OF in name else SOURCE


def _stored(obj: Any, link: str) -> dict[str, Mark]:
    """Return the stored marks of a link's elements and of the whole part, by name."""
    link_texts = [
        text.partition(OF)[2] if OF in text else text
        for text in obj.ChosenFaces
        if _link_of(text) == link
    ]
    return {mark.name: mark for mark in map(read, link_texts) if mark is not None}


def _marks(obj: Any, link: str) -> list[Mark]:
    """Return the current marks of the faces and edges that a link names.

    Empty without names, or if the part has no shape.
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
    """Compare the current elements of a link with the selected elements; return issues.

    Parts grow and move, so a face or edge of the same kind and direction counts as the same
    element. The exceptions are: the selected element exists unchanged under another number, and
    elements were added or removed or only numbers changed; or a plane or straight element exists in
    the same position with another size, and elements were added or removed. A sketch line may be
    dragged by one end.
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
                continue  # only the order of the selected elements changed
            if same and (renumbered or not mark.is_alike(now[mark.name])):
                return (_elsewhere(mark.name, source.Label, same[0]),)
            turned = current_whole.form == was.form and _is_turned(mark, now[mark.name], shape)
            if not mark.is_alike(now[mark.name]) and not turned:
                return (_changed(mark, now[mark.name], source.Label),)
    return ()


def _is_turned(mark: Mark, now: Mark, shape: Any) -> bool:
    """Whether an element with a new direction is certainly the selected element.

    Either it is the only element of its kind, or it is a line dragged by one end, as in sketches.
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
    """Return the element names of a link, without '' and without containers in paths."""
    return tuple(name.rsplit(".", maxsplit=1)[-1] for name in link[1] if name) if link else ()


def source_of(obj: Any) -> tuple[Any, tuple[str, ...]]:
    """Return the Source object of a feature and the names of its selected faces.

    Raises InputError NO_INPUT, BAD_FACES.
    """
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
