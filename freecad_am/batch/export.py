# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes the programs of a saved document, computed again from its shapes."""

from __future__ import annotations

import os
from typing import Any

from freecad_am.core.issues import InputError

from . import outputs, paths


def export(path: str, folder: str | None, names: tuple[str, ...], session: Any) -> list[str]:
    """The paths of the files written: the programs of the document, or of the objects called `names` (Name or Label).

    They go into program/ of `folder`, by default out/<document> beside the document, which itself is not changed.
    Raises InputError and InfeasibleError; then nothing is written.
    """
    label = os.path.basename(path)
    if not os.path.isfile(path):
        raise InputError("NO_FILE", path, "there is no such file; check the path")
    if not path.lower().endswith(".fcstd"):
        raise InputError("UNSUPPORTED_FILE", label, "programs are in FreeCAD documents; give a .FCStd file")
    paths.require_freecad()
    import FreeCAD

    target = folder or os.path.join(os.path.dirname(os.path.abspath(path)), "out", os.path.splitext(label)[0])
    with outputs.Outputs(target) as files:
        session.progress("opening ...")
        try:
            document = FreeCAD.openDocument(path, True)
        except (OSError, RuntimeError, ValueError, AttributeError):
            raise InputError("BAD_FILE", label, "it cannot be read as a FreeCAD document; save it again") from None
        try:
            for name, content in _files(_programs(document, label, names), session).items():
                files.write(f"{outputs.PROGRAMS}/{name}", content)
        finally:
            FreeCAD.closeDocument(document.Name)
        earlier = set() if names else outputs.earlier_programs(files.folder)
        return [os.path.join(files.folder, name) for name in files.publish(earlier)]


def _programs(document: Any, label: str, names: tuple[str, ...]) -> list[Any]:
    from freecad_am import api

    programs = api.stages_of(document, "program")
    known = ", ".join(obj.Label for obj in programs) or "none"
    if not programs:
        raise InputError("NO_PROGRAM", label, "the document has no programs; make one with the workbench")
    chosen = []
    for name in names:
        found = [obj for obj in programs if obj.Name == name] or [obj for obj in programs if obj.Label == name]
        if len(found) != 1:
            raise InputError("NO_OBJECT", label, f"{len(found)} programs are called {name!r}; there are {known}")
        chosen += found
    return chosen or programs


def _files(programs: list[Any], session: Any) -> dict[str, bytes]:
    """File name -> content. Raises InputError where two programs want the same file."""
    from freecad_am import api

    files: dict[str, bytes] = {}
    for program in dict.fromkeys(programs):
        session.progress(f"computing {program.Label} ...")
        api.recompute(program, force=True)
        session.check()
        session.issues(api.issues(program))
        for name, content in api.result(program).files.items():
            if files.setdefault(name, content) != content:
                raise InputError("SAME_NAME", program.Label, f"two programs write {name}; give one another name")
    return files
