# SPDX-License-Identifier: LGPL-2.1-or-later
"""Macro functions that change a stage and recompute all dependent stages."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

from ..core.issues import AmError
from ..objects import stage as stages
from ..objects.program import Program
from ..objects.shapes.chosen import FeatureStage
from ..objects.staleness import UP_TO_DATE
from .arguments import (
    checked_document,
    checked_links,
    checked_stage,
    in_order,
    is_gone,
    one_step,
    owned,
    renew,
    set_parameters,
    with_faces,
)


def change(obj: Any, **values: Any) -> Any:
    """Change parameters or inputs of a stage, then recompute the stage and its dependent stages.

    An error of a dependent stage appears in the Status of that stage. An error of the changed stage
    is raised. In documents with undo (documents with a window), the error also reverts the change.

    Parameters
    ----------
    obj : App.DocumentObject
        The stage.
    **values : Any
        Parameters or inputs by key, as in the `make_...` function of the stage.

    Returns
    -------
    App.DocumentObject
        The stage.

    Raises
    ------
    InputError
        If a value is invalid.

    Examples
    --------
    >>> am.change(doc.Feature, layer_height=2)
    """
    proxy = checked_stage(obj)
    with _unmarked_where_refused(obj), one_step(obj.Document, f"Edit {obj.Label}"):
        links = {link.key: link.name for link in proxy.links}
        if isinstance(proxy, Program):
            links["name"] = "ProgramName"
        if proxy.kind == "inspection":
            links["file"] = "File"
        if proxy.kind == "toolpath":
            links["sequence"] = "Sequence"
        if "source" in values:
            values["source"] = with_faces(values["source"], values.pop("faces", ()))
        if "start_edges" in values:
            wall = values.get("source") or obj.Source
            values["start_edges"] = owned(wall and wall[0], values["start_edges"], "start_edges")
        if "base_faces" in values:
            hub = values.get("substrate") or obj.Substrate
            values["base_faces"] = owned(hub, values["base_faces"], "base_faces")
        link_values = {links[key]: values.pop(key) for key in links if key in values}
        checked = checked_links(obj.Document, proxy.links, link_values, obj)
        set_parameters(obj, proxy, [], values)
        for property_name, value in checked.items():
            setattr(obj, property_name, value)
        for link in proxy.chosen if isinstance(proxy, FeatureStage) else ():
            if link in checked:
                proxy.confirm(obj, link)
        renew(obj)
        for follower in in_order(obj.InListRecursive):
            with contextlib.suppress(AmError):
                renew(follower)
    return obj


@contextlib.contextmanager
def _unmarked_where_refused(obj: Any) -> Iterator[None]:
    """If the block fails, clear the recompute mark that FreeCAD sets when it undoes a step."""
    marked = "Touched" in obj.State
    try:
        yield
    except AmError:
        if not marked and obj.Status == UP_TO_DATE:
            obj.purgeTouched()
        raise


def recompute(target: Any, force: bool = False) -> None:
    """Recompute a document, or a stage and its inputs, including shapes and expressions.

    Parameters
    ----------
    target : App.Document or App.DocumentObject
        The document or stage.
    force : bool, optional
        Whether to compute stages that are up to date too.

    Raises
    ------
    AmError
        The first error, raised after all stages have been tried.

    Examples
    --------
    >>> am.recompute(doc)
    """
    document = checked_document(
        target if is_gone(target) else getattr(target, "Document", target), "target"
    )
    with one_step(document, "Recompute"):
        with stages.deferred():
            document.recompute()
        objects = document.Objects if document is target else [target, *target.OutListRecursive]
        errors = []
        for obj in in_order(objects):
            try:
                renew(obj, force)
            except AmError as error:
                errors.append(error)
    if errors:
        raise errors[0]
