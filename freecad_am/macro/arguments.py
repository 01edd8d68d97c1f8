# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks of macro arguments, made before a function changes the document."""

from __future__ import annotations

import contextlib
import math
import numbers
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import FreeCAD as App

from ..core.issues import InputError
from ..core.parameters.field import unknown_choice
from ..core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ..objects import stage as stages
from ..objects.fields import properties, rows
from ..objects.fields.quantities import safe_repr
from ..objects.fields.rows import is_text
from ..objects.shapes import bodies
from ..objects.shapes.nested import resolved
from ..objects.stage import Stage
from ..objects.stage_parts import Link

# ---- Stage parameters as keywords or dataclasses


def set_parameters(
    obj: Any, stage: Stage, dataclasses: Sequence[Any], values: dict[str, Any]
) -> None:
    """Set the parameters of a stage: first whole dataclasses, then individual values.

    A dataclass of None leaves its properties unchanged. values: by row key, in outer units, or
    expressions (`=Spreadsheet.height`) that the property follows from now on. All values are
    checked before the first is set. InputError names the bad value.
    """
    rows_by_key = {row.key: row for section in stage.sections for row in rows.rows(section.cls)}
    unknown = sorted(set(values) - set(rows_by_key))
    if unknown:
        raise InputError(
            "UNKNOWN_PARAMETER",
            obj.Label,
            "{} is not known; use one of {}",
            ", ".join(unknown),
            ", ".join(sorted(rows_by_key)),
        )
    by_class = {type(entry): entry for entry in dataclasses if entry is not None}
    for cls in by_class.keys() - {section.cls for section in stage.sections}:
        expected = ", ".join(section.cls.__name__ for section in stage.sections)
        raise InputError(
            "BAD_INPUT",
            obj.Label,
            "{} is not a valid parameter; use {}",
            cls.__name__,
            expected,
        )
    try:
        checked = _checked_parameters(obj, stage, by_class, values)
    except ReferenceError:  # reading the name of a deleted object fails
        raise InputError(
            "BAD_INPUT", obj.Label, "the value is a deleted object; give a number or a text"
        ) from None
    for parameters in checked:
        properties.write(obj, parameters)
    for key, value in values.items():
        rows.follow(obj, rows_by_key[key], value if rows.is_expression(value) else None)


def _checked_parameters(
    obj: Any, stage: Stage, by_class: dict[type, Any], values: dict[str, Any]
) -> list[Any]:
    """Build the dataclasses from the given dataclasses and the values by key."""
    checked = []
    for section in stage.sections:
        own_rows = {row.key: row for row in rows.rows(section.cls) if row.key in values}
        if section.cls not in by_class and not own_rows:
            continue
        base = by_class.get(section.cls)
        inner = rows.flat(base if base is not None else stage.parameters(obj, section.cls))
        for key, row in own_rows.items():
            inner[key] = row.inner(
                _plain(obj, row, values[key], f"{section.prefix}.{key}"), f"{section.prefix}.{key}"
            )
        checked.append(rows.build(section.cls, inner))
    return checked


def _plain(obj: Any, row: rows.Row, value: Any, where: str) -> Any:
    """Return the value, or the current result if the value is an expression."""
    if not rows.is_expression(value):
        return value
    if row.form not in rows.FOLLOW:
        raise InputError(
            "BAD_EXPRESSION", where, "the value cannot follow an expression; enter a plain value"
        )
    return rows.evaluated(value, obj, where)


def checked_document(doc: Any, where: str = "doc") -> Any:
    """Return the document. Raises InputError BAD_INPUT, naming the argument, for anything else."""
    if not isinstance(doc, App.Document) or is_gone(doc):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not a document; pass a document, such as FreeCAD.ActiveDocument",
            named(doc),
        )
    return doc


def checked_object(value: Any, where: str, doc: Any = None) -> Any:
    """Return the object, which must belong to `doc` unless `doc` is None.

    Raises InputError BAD_INPUT, naming the argument, for anything else.
    """
    if isinstance(value, (tuple, list)) and value and isinstance(value[0], App.DocumentObject):
        raise InputError(
            "BAD_INPUT",
            where,
            "the argument takes a single object; pass the object, and the names of its faces "
            "separately",
        )
    if not isinstance(value, App.DocumentObject) or is_gone(value):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not an object of a document; pass an object, such as doc.Body",
            named(value),
        )
    if doc is not None and value.Document != doc:
        raise InputError(
            "BAD_INPUT",
            where,
            "{} belongs to another document, {}; pass an object of {}, such as a copy",
            value.Label,
            value.Document.Label,
            doc.Label,
        )
    return value


def checked_objects(values: Any, where: str, doc: Any = None) -> list[Any]:
    """Return a list of objects; [] for None. Raises InputError BAD_INPUT as `checked_object`."""
    if values is None:
        return []
    if not isinstance(values, Iterable) or isinstance(values, (str, bytes, Mapping)):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not a list of objects; pass a list, such as [doc.Clamp]",
            named(values),
        )
    return [checked_object(value, where, doc) for value in values]


def checked_names(names: Any, where: str) -> list[str]:
    """Return names of faces and edges as a list; a string is one name, None gives [].

    Raises InputError BAD_INPUT for anything else.
    """
    texts = [names] if isinstance(names, str) else [] if names is None else names
    if not isinstance(texts, (list, tuple, set, frozenset)) or not all(map(is_text, texts)):
        raise InputError(
            "BAD_INPUT",
            where,
            '{} are not names of faces or edges; pass a list of texts, such as ["Face1"]',
            named(names),
        )
    return list(texts)


def checked_text(value: Any, where: str) -> str:
    """Return the string. Raises InputError BAD_INPUT, naming the argument, for anything else."""
    if not is_text(value):
        raise InputError(
            "BAD_INPUT", where, "{} is not a text; write the text in quotes", named(value)
        )
    return value


def checked_number(value: Any, where: str) -> float:
    """Return the number as a float. Raises InputError BAD_INPUT, naming the argument, otherwise."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or math.isnan(value):
        raise InputError(
            "BAD_INPUT", where, "{} is not a number; pass a number such as 2", named(value)
        )
    return float(value)


def checked_keywords(values: Any, where: str) -> dict[str, Any]:
    """Return the mapping as a dict; {} for None.

    Raises InputError BAD_INPUT, naming the argument, for anything else.
    """
    if values is None:
        return {}
    if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not a mapping of keys to values; pass a dictionary",
            named(values),
        )
    return dict(values)


def checked_list(values: Any, where: str) -> list[Any]:
    """Return the sequence as a list; [] for None.

    Raises InputError BAD_INPUT, naming the argument, for anything else.
    """
    if values is None:
        return []
    if not isinstance(values, (list, tuple)):
        raise InputError(
            "BAD_INPUT", where, "{} is not a list; pass a list, such as []", named(values)
        )
    return list(values)


def checked_target(path: Any, where: str) -> str:
    """Return a path as `checked_path` does, but reject an empty path."""
    text = checked_path(path, where)
    if not text.strip():
        raise InputError(
            "BAD_INPUT",
            where,
            '{} is not a path; pass a path as a text, such as "cup.step"',
            named(path),
        )
    return text


def checked_path(path: Any, where: str) -> str:
    """Return the path of a file or folder as a string.

    Raises InputError BAD_INPUT, naming the argument, for anything else.
    """
    text = os.fspath(path) if isinstance(path, os.PathLike) else path
    if not is_text(text):
        raise InputError(
            "BAD_INPUT",
            where,
            '{} is not a path; pass a path as a text, such as "cup.step"',
            named(path),
        )
    return text


def checked_job(
    doc: Any, source: Any, process: Any, then: Any, mend: Any, **texts: Any
) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Check the types of the arguments of `make_all`; return `process` and `then`.

    Raises InputError BAD_INPUT, naming the argument of the wrong type.
    """
    checked_document(doc)
    for key, text in texts.items():
        checked_text(text, key)
    checked_number(mend, "mend")
    if source is not None:
        checked_object(source, "source", doc)
    return checked_keywords(process, "process"), [
        checked_keywords(feature, "then") for feature in checked_list(then, "then")
    ]


def is_gone(value: Any) -> bool:
    """Whether a document has been closed or an object deleted."""
    try:
        return getattr(value, "Name", None) == ""
    except ReferenceError:
        return True


def named(value: Any) -> str:
    """Return the name of a value for a message: the label of an object or document, else repr."""
    return (
        safe_repr(value)
        if is_gone(value)
        else str(getattr(value, "Label", None) or safe_repr(value))
    )


TEXTS = {
    "ProgramName": "name",
    "File": "file",
}  # text properties and their macro argument names


def checked_links(
    doc: Any, links: Sequence[Link], values: dict[str, Any], stage: Any = None
) -> dict[str, Any]:
    """Check the values of links and of related properties; return them in property form, by name.

    None stays None. stage: the stage that has the links, if it exists. Raises InputError BAD_INPUT
    with the key of the link, or for a path to a missing face or edge.
    """
    by_name = {link.name: link for link in links}
    checked = dict(values)
    for name, value in values.items():
        if name in by_name and value is not None:
            checked[name] = _checked(doc, by_name[name], value)
        elif name in TEXTS:
            checked_text(value, TEXTS[name])
        elif name == "Sequence" and checked_text(value, "sequence") not in (BY_FEATURE, BY_HEIGHT):
            raise unknown_choice("sequence", value, (BY_FEATURE, BY_HEIGHT))
    dependents = [] if stage is None else [stage, *stage.InListRecursive]
    for name in checked.keys() & by_name.keys():
        for target in _objects(checked[name]):
            if target in dependents:  # FreeCAD accepts the cycle, then fails to recompute
                raise InputError(
                    "BAD_INPUT",
                    by_name[name].key,
                    "{} is made from {} itself; choose another object",
                    target.Label,
                    stage.Label,
                )
    return checked


def _objects(value: Any) -> list[Any]:
    """Return the linked objects of a link value in property form."""
    if value is None:
        return []
    return value if isinstance(value, list) else [value[0] if isinstance(value, tuple) else value]


def _checked(doc: Any, link: Link, value: Any) -> Any:
    if link.many:
        return checked_objects(value, link.key, doc)
    if link.type_name != "App::PropertyLinkSub":
        return checked_object(value, link.key, doc)
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        return checked_object(value, link.key, doc), []
    owner = checked_object(value[0], link.key, doc)
    return resolved(owner, checked_names(value[1], link.key), link.key)


def make_stage(
    doc: Any,
    proxy: type[stages.Stage],
    name: str,
    label: str,
    links: dict[str, Any],
    parameters: Sequence[Any],
    values: dict[str, Any],
) -> Any:
    """Make a stage, set its links and parameters, and compute it. On failure, remove the stage."""
    checked_document(doc)
    checked_text(label, "label")
    links = checked_links(doc, proxy.links, links)
    with one_step(doc, f"Make {label}"):
        obj = doc.addObject("App::FeaturePython", name)
        try:
            stage = proxy(obj)
            obj.Label = label
            for property_name, value in links.items():
                if value is not None:
                    setattr(obj, property_name, value)
            set_parameters(obj, stage, parameters, values)
            bodies.fill_in(obj, parameters, values)
            for dependency in in_order(obj.OutListRecursive):
                dependency.Proxy.renew(dependency)
            renew(obj)
        except BaseException:
            doc.removeObject(obj.Name)
            raise
    return obj


def with_faces(source: Any, faces: Any) -> Any:
    """Return a link to an object and its faces; None without an object."""
    return None if source is None else (source, checked_names(faces, "faces"))


def owned(owner: Any, names: Any, key: str) -> Any:
    """Return a link to faces or edges of an object; None without names.

    Raises InputError BAD_INPUT for names without an object.
    """
    names = checked_names(names, key)
    if names and owner is None:
        raise InputError(
            "BAD_INPUT",
            key,
            "{} are names without an object; pass the object too",
            ", ".join(names),
        )
    return (owner, names) if names else None


def renew(obj: Any, force: bool = False) -> None:
    """Compute a stage if its inputs have changed or `force` is set."""
    obj.Proxy.renew(obj, force)
    obj.purgeTouched()


def checked_stage(obj: Any) -> stages.Stage:
    """Return the proxy of a stage. Raises InputError BAD_INPUT for any other object."""
    proxy = None if is_gone(obj) else stages.stage_of(obj)
    if proxy is None:
        raise InputError(
            "BAD_INPUT", named(obj), "the object is not a stage of the workbench; choose a stage"
        )
    return proxy


def in_order(objects: Sequence[Any]) -> list[Any]:
    """Return the stages among the objects, inputs before dependent stages."""
    return sorted(
        (obj for obj in objects if stages.stage_of(obj)), key=lambda obj: len(obj.OutListRecursive)
    )


@contextlib.contextmanager
def one_step(doc: Any, name: str) -> Iterator[None]:
    """Run the block as one undo step and undo the step on failure. Join an open step.

    In a document without undo, such as a document without a window, a failure removes the new
    objects. Raises InputError BAD_INPUT if `doc` is not a document.
    """
    checked_document(doc)
    if App.getActiveTransaction():
        yield
        return
    if not doc.UndoMode:
        with _remove_new_objects(doc):
            yield
        return
    doc.openTransaction(name)
    try:
        yield
    except BaseException:
        _end_step(doc.abortTransaction, abort=True)
        raise
    _end_step(doc.commitTransaction, abort=False)


@contextlib.contextmanager
def _remove_new_objects(doc: Any) -> Iterator[None]:
    """If the block fails, remove the objects that it made, newest first."""
    names = {obj.Name for obj in doc.Objects}
    try:
        yield
    except BaseException:
        for name in [obj.Name for obj in doc.Objects if obj.Name not in names][::-1]:
            if doc.getObject(name) is not None:  # removing an object may remove others
                doc.removeObject(name)
        raise


def _end_step(end: Callable[[], None], abort: bool) -> None:
    """End an undo step.

    FreeCAD leaves a step without changes open and adds the next change to this step.
    """
    end()
    if App.getActiveTransaction():
        App.closeActiveTransaction(abort)
