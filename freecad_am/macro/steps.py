# SPDX-License-Identifier: LGPL-2.1-or-later
"""What each function of the macro interface does with a document: one step of undo, stages made, renewed and in order."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import FreeCAD as App

from ..core.issues import InputError
from ..objects import stage as stages
from ..objects.fields.settings import set_parameters
from ..objects.shapes import chord_error
from .arguments import checked_document, checked_names, checked_text, is_gone, named
from .links import checked_links


def make_stage(
    doc: Any,
    proxy: type[stages.Stage],
    name: str,
    label: str,
    links: dict[str, Any],
    parameters: Sequence[Any],
    values: dict[str, Any],
) -> Any:
    """A stage with its links and parameters, computed; nothing is left of one that fails."""
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
            chord_error.fill_in(obj, parameters, values)
            for other in in_order(obj.OutListRecursive):
                other.Proxy.renew(other)
            renew(obj)
        except BaseException:
            doc.removeObject(obj.Name)
            raise
    return obj


def with_faces(source: Any, faces: Any) -> Any:
    """A link to an object, or to faces of it; None for no object."""
    return None if source is None else (source, checked_names(faces, "faces"))


def owned(owner: Any, names: Any, key: str) -> Any:
    """A link to faces or edges of an object; None for none. InputError BAD_INPUT for those of nothing."""
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
    """Compute a stage where its inputs have changed, or by force."""
    obj.Proxy.renew(obj, force)
    obj.purgeTouched()


def checked_stage(obj: Any) -> stages.Stage:
    """The proxy of a stage. InputError BAD_INPUT for any other object."""
    proxy = None if is_gone(obj) else stages.stage_of(obj)
    if proxy is None:
        raise InputError("BAD_INPUT", named(obj), "it is not a stage of the workbench; choose one")
    return proxy


def in_order(objects: Sequence[Any]) -> list[Any]:
    """The stages among objects, inputs first."""
    return sorted(
        (obj for obj in objects if stages.stage_of(obj)), key=lambda obj: len(obj.OutListRecursive)
    )


@contextlib.contextmanager
def one_step(doc: Any, name: str) -> Iterator[None]:
    """One step of undo, taken back whole when it fails; part of the step that is open, if there is one. In a document that
    keeps no undo steps, as those without a window, objects that were made in it go.

    InputError BAD_INPUT for what is not a document.
    """
    checked_document(doc)
    if App.getActiveTransaction():
        yield
        return
    if not doc.UndoMode:
        with _without_new_ones(doc):
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
def _without_new_ones(doc: Any) -> Iterator[None]:
    """Remove objects that were made within it where it fails, the last ones first."""
    before = {obj.Name for obj in doc.Objects}
    try:
        yield
    except BaseException:
        for name in [obj.Name for obj in doc.Objects if obj.Name not in before][::-1]:
            if doc.getObject(name) is not None:  # it may have gone with another one
                doc.removeObject(name)
        raise


def _end_step(end: Callable[[], None], abort: bool) -> None:
    """End a step of one's own. FreeCAD leaves one open in which nothing was changed, and counts what comes next to it."""
    end()
    if App.getActiveTransaction():
        App.closeActiveTransaction(abort)
