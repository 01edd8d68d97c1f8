# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read the part in a file as a shape for the document."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App
import Part

from ...brep.files.read import READABLE, mesh_content, placed_mesh, shape_content
from ...brep.files.sandbox import read_in_sandbox
from ...core.geometry.curves.bead_curves import POINT_FILES
from ...core.geometry.job_files import is_there, locate
from ...core.geometry.mesh.file_unit import MESHES, refuse_scale
from ...core.issues import NOTE, InputError, Issue, Text
from ..results.findings import parts_of, text_of
from ..work import hooks
from . import linked_files
from .bodies import global_shape, is_mesh, mesh_of, refuse_mixed, renumbers
from .file_links import missing_files
from .places import GROUPS, ArrayElement, Dependencies, dependencies_of, element_count, elements_of

PROPERTY = "FileIssues"


def keep_file_issues(obj: Any, issues: Sequence[Issue]) -> None:
    """Store the notes on a file with the object that has its shape; store nothing without notes."""
    if not issues:
        return
    if PROPERTY not in obj.PropertiesList:
        obj.addProperty(
            "App::PropertyString", PROPERTY, "Part", "Notes on the content of the file.", 4
        )
    rows = [[issue.level, issue.code, parts_of(issue.message)] for issue in issues]
    setattr(obj, PROPERTY, json.dumps(rows))


def file_issues(obj: Any) -> list[Issue]:
    """Return the notes on the files of an object's sources, each once."""
    issues: dict[Issue, None] = {}
    for source in obj.OutListRecursive:
        for level, code, text_parts in json.loads(getattr(source, PROPERTY, "") or "[]"):
            issues[Issue(level, code, text_of(text_parts))] = None
    return list(issues)


# what the origin of an assembly or a body is made of: since FreeCAD 1.0 with shapes
ORIGIN = ("App::Line", "App::Plane", "App::Point")
READING = "reading the file"
PART_FILES = (*READABLE, *MESHES, ".FCStd", *POINT_FILES)  # endings


def part_shape(path: str, object_name: str = "", scale: float = 1.0) -> tuple[Any, str]:
    """Return the shape or mesh of a part file and a label, as `part_content`."""
    return part_content(path, object_name, scale)[:2]


def part_content(
    path: str, object_name: str = "", scale: float = 1.0
) -> tuple[Any, str, tuple[Issue, ...]]:
    """Return the shape or mesh of a part file, a label, and notes on ignored content.

    STL, OBJ and 3MF files, and mesh objects, give a mesh. `object_name`: Name or Label of an object
    of an FCStd file. scale: mm of one unit of an STL or OBJ file. Raises the InputErrors of
    `brep.read`, NO_OBJECT, and BAD_VALUE for a scale of 0 or less, or for another file type.
    """
    stem, extension = os.path.splitext(os.path.basename(path))
    refuse_scale(scale, path, "scale")
    if extension.lower() in MESHES:
        mesh, issues = hooks.carry_out(lambda: mesh_content(path, scale), stem, READING)
        return mesh, stem, issues
    if extension.lower() != ".fcstd":
        _refuse_other(path, extension)
        shape, issues = hooks.carry_out(lambda: shape_content(path), stem, READING)
        return shape, stem, issues
    return _document_content(path, object_name, stem)


def _refuse_other(path: str, extension: str) -> None:
    """Raise InputError UNSUPPORTED_FILE, with all supported extensions, for another file type."""
    if extension.lower() not in READABLE and is_there(path):
        raise InputError(
            "UNSUPPORTED_FILE",
            os.path.basename(path),
            "{} files are not supported; use {}",
            extension or "no extension",
            ", ".join(PART_FILES),
        )


def _document_content(path: str, object_name: str, stem: str) -> tuple[Any, str, tuple[Issue, ...]]:
    if not is_there(path):
        raise InputError("NO_FILE", path, "the file does not exist; check the path")
    for document in App.listDocuments().values():
        if document.FileName and os.path.realpath(document.FileName) == os.path.realpath(path):
            return _shape_in(
                document, path, object_name
            )  # open already: it is the user's, and stays open
    return _decoded(
        hooks.carry_out(
            lambda: read_in_sandbox(_shape_of_file, str(locate(path)), object_name), stem, READING
        )
    )


def changed_part(
    path: str, object_name: str, change: Callable[[Any], list[Any]], where: str, patience: float
) -> tuple[Any, str, tuple[Issue, ...]]:
    """Return the content of an FCStd file, as `part_content`, after `change(document)`.

    change: a function of a module, or a `functools.partial` of one, because another process may
    call it; it returns the changed objects. where: where errors about the change are reported.
    patience: factor on the time limit of reading a file. The file stays unchanged. Raises also
    InputError NO_ADD_ON.
    """
    resolved_path = str(locate(path))
    return _decoded(
        read_in_sandbox(
            _shape_of_file, resolved_path, object_name, change, where, patience=patience
        )
    )


def add_part(document: Any, shape: Any, label: str, issues: tuple[Issue, ...] = ()) -> Any:
    """Add an object with a shape or a mesh to a document, and store the notes on its file."""
    is_triangles = hasattr(shape, "Topology")
    added = document.addObject("Mesh::Feature" if is_triangles else "Part::Feature", "Part")
    added.Label = label
    setattr(added, "Mesh" if is_triangles else "Shape", shape)
    keep_file_issues(added, issues)
    added.purgeTouched()
    return added


def _shape_of_file(
    path: str,
    object_name: str,
    change: Callable[[Any], list[Any]] | None = None,
    where: str = "",
) -> tuple[Any, str, tuple[Issue, ...]]:
    active, open_before = App.ActiveDocument, set(App.listDocuments())
    document = linked_files.open_here(path, path)
    try:
        renewed = linked_files.renew_changed(document)
        changed = [] if change is None else change(document)
        source = _object_in(document, path, object_name)
        needs = dependencies_of(source)
        for obj in changed:
            _refuse_without_add_on(obj, needs, where)
        content, label = _content_of(source, path)
        if (renewed or changed) and isinstance(content, Part.Shape):
            # as text, so that the calling process never recomputes it: FreeCAD 1.0 starts threads
            # to recompute, and a later fork of a process with threads would hang
            content = content.exportBrepToString()
        return content, label, _notes(source, needs, renewed, changed)
    finally:
        # linked documents were opened with it
        for name in set(App.listDocuments()) - open_before:
            App.closeDocument(name)
        if active is not None:
            App.setActiveDocument(active.Name)


def _decoded(content: tuple[Any, str, tuple[Issue, ...]]) -> tuple[Any, str, tuple[Issue, ...]]:
    """Return the result of `_shape_of_file` with its shape decoded from text."""
    shape, label, issues = content
    if isinstance(shape, str):
        text, shape = shape, Part.Shape()
        shape.importBrepFromString(text)
    return shape, label, issues


def _refuse_without_add_on(changed: Any, needs: Dependencies, where: str) -> None:
    """Reject a change of an object that a missing add-on computes, because its shape would not
    change.
    """
    for obj in (changed, *changed.InListRecursive):
        is_scripted = obj.TypeId.endswith("Python") and "Proxy" in obj.PropertiesList
        if is_scripted and obj.Proxy is None and obj in needs.objects:
            raise InputError(
                "NO_ADD_ON",
                where,
                "{} cannot be computed: the add-on that created the object is missing; install "
                "the add-on, or remove the value",
                obj.Label,
            )


def _notes(
    source: Any, needs: Dependencies, renewed: list[Any], changed: list[Any]
) -> tuple[Issue, ...]:
    notes = []
    decisive = (*needs.objects, *needs.containers)
    labels = ", ".join(dict.fromkeys(obj.Label for obj in renewed if obj in decisive))
    if labels:
        text = Text(
            "{} was recomputed for {}, because a linked document is newer than the file",
            labels,
            source.Label,
        )
        notes.append(Issue(NOTE, "LINKED_CHANGED", text))
    for obj in dict.fromkeys(changed):
        if obj not in decisive:
            text = Text(
                "a value of {} is set, but {} does not depend on this value; check the names",
                obj.Label,
                source.Label,
            )
            notes.append(Issue(NOTE, "SET_UNUSED", text))
    return tuple(notes)


def _shape_in(document: Any, path: str, object_name: str) -> tuple[Any, str, tuple[Issue, ...]]:
    return (*_content_of(_object_in(document, path, object_name), path), ())


def _object_in(document: Any, path: str, object_name: str) -> Any:
    """Return the named object or the only object; a mesh only by name or in a document of meshes."""
    placed = [obj for obj in document.Objects if obj.TypeId not in ORIGIN]
    shapes = [
        obj for obj in placed if getattr(obj, "Shape", None) is not None and not obj.Shape.isNull()
    ]
    meshes = [obj for obj in placed if obj not in shapes and is_mesh(obj)]
    if not object_name:  # a container of one mesh is called as the mesh is
        meshes = [obj for obj in meshes if not any(obj.isDerivedFrom(kind) for kind in GROUPS)]
    available = [*shapes, *meshes]
    if object_name:
        available += [*_elements(document, object_name)]
        candidates = [obj for obj in available if object_name in (obj.Name, obj.Label)]
    else:
        candidates = [
            obj
            for obj in shapes or meshes
            if not any(child_of in available for child_of in obj.InListRecursive)
        ]
    if not candidates and (missing := missing_files(document)):
        name, file = next(iter(missing.items()))
        raise linked_files.no_linked_file(path, document.getObject(name).Label, file)
    if len(candidates) != 1:
        raise _no_single_object(path, object_name, available, candidates)
    return candidates[0]


def _no_single_object(
    path: str, object_name: str, available: list[Any], candidates: list[Any]
) -> InputError:
    """Return the error for a document without a unique object."""
    if not available:
        message = "no object in the document has a shape; recompute and save the document in FreeCAD, or use another file"
        return InputError("NO_OBJECT", path, message)
    names = ", ".join(obj.Label for obj in candidates or available)
    if not object_name:
        message = "{} objects have a shape of their own ({}); name the part with part.object"
        return InputError("NO_OBJECT", path, message, len(candidates), names)
    if candidates:
        message = "{} objects have the label {!r}; change the label of one object"
        return InputError("NO_OBJECT", path, message, len(candidates), object_name)
    message = "no object with a shape is called {!r}; use one of {}"
    return InputError("NO_OBJECT", path, message, object_name, names)


def _content_of(source: Any, path: str) -> tuple[Any, str]:
    """Return the shape or mesh of an object in document coordinates, and its label."""
    linked_files.refuse_missing(source, path)
    if not is_mesh(source):
        if renumbers(source):
            raise InputError(
                "NO_OBJECT",
                path,
                "{} lists the contents of a group twice, so its face numbers are ambiguous; name "
                "an object in the group, or remove the contents from the group",
                source.Label,
            )
        shape = global_shape(source).copy()
        refuse_mixed(source)
        return shape, source.Label
    mesh, frame = mesh_of(source)
    return placed_mesh(mesh, App.Matrix(*frame.ravel().tolist())), source.Label


def _elements(document: Any, name: str) -> list[ArrayElement]:
    """Return the link array element that a name such as `Array.1` means, if no object has this
    name.
    """
    array, _, number = name.rpartition(".")
    if not number.isdigit():
        return []
    arrays = [obj for obj in document.Objects if array in (obj.Name, obj.Label)]
    return [
        ArrayElement(obj, int(number))
        for obj in arrays
        if int(number) < max(element_count(obj), len(elements_of(obj)))
    ]
