# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes the programs of a saved document, or its paths as wires, computed again from its shapes."""

from __future__ import annotations

import os
from typing import Any

from freecad_am.core.issues import InfeasibleError, InputError, Issue, Text, Word

from . import paths
from .outputs import folder as outputs

_PROGRAMS, _PATHS = ("program",), ("joint path", "toolpath", "program")


def export(
    path: str, folder: str | None, names: tuple[str, ...], session: Any, wires: str = ""
) -> list[str]:
    """The paths of the files written: the programs of the document, or of the objects called `names` (Name or Label).

    They go into program/ of `folder`, by default out/<document> next to the document, which is not
    changed. wires: 'step' or 'dxf' writes into wires/ instead, a file for each joint path, or for
    each toolpath, joint path or program that is named. Raises InputError and InfeasibleError; then
    nothing is written.
    """
    label = os.path.basename(path)
    if not os.path.isfile(path):
        raise InputError("NO_FILE", path, "the file does not exist; check the path")
    if not path.lower().endswith(".fcstd"):
        raise InputError(
            "UNSUPPORTED_FILE", label, "programs are in FreeCAD documents; give a .FCStd file"
        )
    paths.require_freecad()
    import FreeCAD

    from freecad_am.objects.shapes import document_file, linked_files

    target = folder or os.path.join(
        os.path.dirname(os.path.abspath(path)), "out", os.path.splitext(label)[0]
    )
    with outputs.Outputs(target, session) as files:
        session.progress("opening ...")
        open_before = set(FreeCAD.listDocuments())
        document = document_file.opened(path, label)
        try:
            linked_files.renew_changed(document)
            if wires:
                _write_wires(
                    _chosen(document, label, names, _PATHS, "NO_PATH"), wires, files, session
                )
            else:
                for name, content in _files(
                    _chosen(document, label, names, _PROGRAMS, "NO_PROGRAM"), session
                ).items():
                    files.write(f"{outputs.PROGRAMS}/{name}", content)
        finally:
            # linked documents were opened with it
            for name in set(FreeCAD.listDocuments()) - open_before:
                FreeCAD.closeDocument(name)
        earlier = set() if names or wires else outputs.earlier_programs(files.folder)
        return [os.path.join(files.folder, name) for name in files.publish(earlier)]


def _chosen(
    document: Any, label: str, names: tuple[str, ...], kinds: tuple[str, ...], code: str
) -> list[Any]:
    """The objects called `names` among objects of some kinds, else all objects of the first kind
    present.
    """
    from freecad_am import api
    from freecad_am.objects.shapes import linked_files

    of_kinds = [api.stages_of(document, kind) for kind in kinds]
    candidates = [obj for objects in of_kinds for obj in objects]
    if not candidates:
        raise InputError(
            code, label, "the document has no {}s; create one with the workbench", kinds[0]
        )
    labels = ", ".join(obj.Label for obj in candidates)
    selected = []
    for name in names:
        matches = [obj for obj in candidates if obj.Name == name] or [
            obj for obj in candidates if obj.Label == name
        ]
        if not matches:
            message = "no {} is called {!r}; name one of {}"
            raise InputError("NO_OBJECT", label, message, kinds[0], name, labels)
        if len(matches) > 1:
            message = "{!r} is the label of several {}s; use the name of one"
            raise InputError("NO_OBJECT", label, message, name, kinds[0])
        selected += matches
    selected = selected or next(objects for objects in of_kinds if objects)
    for obj in selected:
        linked_files.refuse_missing_of(obj, label)
    return selected


def _write_wires(paths: list[Any], kind: str, files: outputs.Outputs, session: Any) -> None:
    """Raises InputError where two paths want the same file."""
    from freecad_am import api

    written: set[str] = set()
    for obj in dict.fromkeys(paths):
        session.progress(f"computing {obj.Label} ...")
        api.recompute(obj)
        session.check()
        name = Text("{}/{}.{}", outputs.WIRES, obj.Label.replace(os.sep, "-"), kind)
        if name in written:
            raise InputError(
                "SAME_NAME", obj.Label, "two paths write {}; change one label", Word(name)
            )
        written.add(name)
        api.export_wires(obj, files.path(name), rapids=True)


def _files(programs: list[Any], session: Any) -> dict[str, bytes]:
    """File name -> content. Raises InputError where two programs want the same file."""
    from freecad_am import api

    files: dict[str, bytes] = {}
    reported: dict[Issue, None] = {}
    for program in dict.fromkeys(programs):
        session.progress(f"computing {program.Label} ...")
        try:
            api.recompute(program, force=True)
        except InfeasibleError:  # what one ends with may be the fault of what another warns about
            _report_findings(program, reported, session)
            raise
        session.check()
        _report_findings(program, reported, session)
        for name, content in api.result(program).files.items():
            if files.setdefault(name, content) != content:
                raise InputError(
                    "SAME_NAME", program.Label, "two programs write {}; change one name", name
                )
    return files


def _report_findings(program: Any, reported: dict[Issue, None], session: Any) -> None:
    """Report findings of a program and its inputs, except those in `reported`, and add them to it."""
    from freecad_am import api

    inputs = [
        obj
        for obj in api.stages_of(program.Document)
        if obj is program or obj in program.OutListRecursive
    ]
    new_findings = dict.fromkeys(
        issue
        for stage_input in inputs
        for issue in api.issues(stage_input)
        if issue not in reported
    )
    reported |= new_findings
    session.issues(new_findings, "are in the document")
