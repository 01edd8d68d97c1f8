# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a document lacks for a tool of the toolbar to act, as a text that says what to do first; '' when it can act.

FreeCAD asks for every tool about three times a second: these look at properties alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ...objects.results.findings import message_of
from ...objects.stage import stage_of
from ...objects.staleness import INFEASIBLE
from ..picking.picking import is_mesh, usable
from ..texts.translation import tr, translated

Need = Callable[[Any], str]


def nothing(doc: Any) -> str:
    """Not even a document."""
    return ""


def document(doc: Any) -> str:
    """A document."""
    return tr("First open a part, or create a document.") if doc is None else ""


def part(doc: Any) -> str:
    """Something with a shape or a mesh."""
    return document(doc) or (
        "" if _any(doc, usable) else tr("First open a part, or import one into this document.")
    )


def faces(doc: Any) -> str:
    """Something with a shape, which a mesh has not."""
    if document(doc) or _any(doc, lambda obj: usable(obj) and not is_mesh(obj)):
        return document(doc)
    return (
        tr("First open a part with faces, such as a STEP file; a mesh has none.")
        if _any(doc, usable)
        else part(doc)
    )


def feature(doc: Any) -> str:
    """What is to be deposited."""
    if document(doc) or _some(doc, "feature"):
        return document(doc)
    return tr(
        "First make a feature with Feature…, Wall on Part…, Solid…, Solids on Hub…, Curves… or "
        "Cladding…."
    )


def toolpath_and_cell(doc: Any) -> str:
    """What to run, and where."""
    if document(doc):
        return document(doc)
    if not _some(doc, "toolpath"):
        return tr("First make a toolpath: Toolpath….") if not feature(doc) else feature(doc)
    return "" if _some(doc, "cell") else tr("First make a cell: Cell….")


def path(doc: Any) -> str:
    """A toolpath or joint path that was computed."""
    if document(doc):
        return document(doc)
    some = any(obj.Key for kind in ("toolpath", "joint path") for obj in _stages(doc, kind))
    return "" if some else tr("First make a toolpath: Toolpath….")


def joint_path(doc: Any) -> str:
    """A joint path that was computed."""
    if document(doc):
        return document(doc)
    paths = list(_stages(doc, "joint path"))
    if any(obj.Key for obj in paths):
        return ""
    if paths:
        return tr("{} has no result: {}").format(paths[-1].Label, translated(message_of(paths[-1])))
    return tr("First make a joint path: Joint Path…, or all stages at once: New Job….")


def feasible(doc: Any) -> str:
    """A joint path that can be carried out."""
    lacking = joint_path(doc)
    if lacking or any(obj.Status != INFEASIBLE for obj in _stages(doc, "joint path")):
        return lacking
    last = list(_stages(doc, "joint path"))[-1]
    return tr("{} is infeasible: {}").format(last.Label, translated(message_of(last)))


def _stages(doc: Any, kind: str) -> Iterator[Any]:
    for obj in doc.Objects:
        stage = stage_of(obj)
        if stage is not None and stage.kind == kind:
            yield obj


def _some(doc: Any, kind: str) -> bool:
    return next(_stages(doc, kind), None) is not None


def _any(doc: Any, wanted: Callable[[Any], bool]) -> bool:
    return any(wanted(obj) for obj in doc.Objects)
