# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compares files of measured points with what a job or a saved document plans, and writes what came of it."""

from __future__ import annotations

import json
import os
from typing import Any

from freecad_am.core.issues import InputError, Text, Word

from . import paths
from .outputs import folder as outputs

FIGURES, DATA, PAGE, DOCUMENT = (
    "inspection.csv",
    "inspection.json",
    "inspection.html",
    "inspection.FCStd",
)
_KEPT = {"measured", "planned", "file", "label", "inspection"}


def inspect(
    source: str,
    measured: tuple[str, ...],
    folder: str | None,
    settings: tuple[str, ...],
    name: str,
    session: Any,
) -> list[str]:
    """The paths of the files written: figures of every file of measured points, and over them mean and standard deviation.

    source: a job file, whose part is compared, or an FCStd document, of which `name` (Name or Label) is, by default its one
    feature. settings: key=value, parameters of an inspection. They go into `folder`, by default out/<name>-inspection
    beside the source. Raises InputError and InfeasibleError; then nothing is written.
    """
    values = _values(settings)
    paths.require_freecad()
    import FreeCAD

    stem = os.path.splitext(os.path.basename(source))[0]
    target = folder or os.path.join(
        os.path.dirname(os.path.abspath(source)), "out", f"{stem}-inspection"
    )
    labels = _labels(measured)
    with outputs.Outputs(target, session) as files:
        session.progress("opening ...")
        document, planned = _opened(source, name, session)
        try:
            made = [
                _made(document, planned, path, label, values, session)
                for path, label in zip(measured, labels, strict=True)
            ]
            _write(files, f"{document.Label}, {planned.Label}", made, labels)
            document.saveAs(files.path(DOCUMENT))
        finally:
            FreeCAD.closeDocument(document.Name)
        earlier = {
            entry
            for entry in (FIGURES, DATA, PAGE, DOCUMENT)
            if os.path.isfile(os.path.join(files.folder, entry))
        }
        return [os.path.join(files.folder, entry) for entry in files.publish(earlier)]


def _values(settings: tuple[str, ...]) -> dict[str, str]:
    found = {}
    for text in settings:
        key, sign, value = text.partition("=")
        if not sign or key.strip() in _KEPT:
            raise InputError(
                "USAGE",
                "freecad-am inspect",
                "{!r} is not a setting; give such as --set tolerance=0.3",
                text,
            )
        found[key.strip()] = value.strip()
    return found


def _labels(measured: tuple[str, ...]) -> list[str]:
    """What the files are called in tables and names of files, each another way."""
    found: list[str] = []
    for path in measured:
        label = os.path.splitext(os.path.basename(path))[0] or "points"
        number = 2
        while label in found:
            label, number = f"{label.rpartition(' ')[0] or label} {number}", number + 1
        found.append(label)
    return found


def _opened(source: str, name: str, session: Any) -> tuple[Any, Any]:
    """A document, and the object in it that was measured."""
    if source.lower().endswith(".fcstd"):
        return _of_document(source, name)
    if name:
        raise InputError(
            "USAGE",
            "freecad-am inspect",
            "--object is for FCStd documents; leave it out of a job, whose part is compared",
        )
    import FreeCAD

    from .job import job

    read = job.read_job(source)
    document = FreeCAD.newDocument("Inspection")
    try:
        document.Label, document.UndoMode = read.name, 0
        return document, _feature(document, read, session)
    except BaseException:
        FreeCAD.closeDocument(document.Name)
        raise


def _feature(document: Any, read: Any, session: Any) -> Any:
    """The feature of a job; its toolpath need not be made."""
    from .job.shapes import Shapes

    session.progress("feature ...")
    return Shapes(document, read, 0).make_feature([])


def _of_document(path: str, name: str) -> tuple[Any, Any]:
    import FreeCAD

    from freecad_am import api
    from freecad_am.objects.shapes import document_file

    label = os.path.basename(path)
    if not os.path.isfile(path):
        raise InputError("NO_FILE", path, "there is no such file; check the path")
    document = document_file.opened(path, label)
    known = api.stages_of(document, "feature") if not name else list(document.Objects)
    found = (
        known
        if not name
        else [one for one in known if one.Name == name]
        or [one for one in known if one.Label == name]
    )
    if len(found) != 1:
        FreeCAD.closeDocument(document.Name)
        text = (
            Text("{} objects are called {!r}", len(found), name)
            if name
            else Text("it has {} features; choose with --object", len(found))
        )
        raise InputError("NO_OBJECT", label, "{}; name what was measured", Word(text))
    return document, found[0]


def _made(
    document: Any, planned: Any, path: str, label: str, values: dict[str, str], session: Any
) -> Any:
    from freecad_am import api

    session.progress(f"{label} ...")
    made = api.inspect(document, planned, os.path.abspath(path), label, **values)
    session.check()
    session.issues(api.issues(made))
    return api.result(made)


def _write(files: outputs.Outputs, planned: str, made: list[Any], labels: list[str]) -> None:
    from freecad_am.core.inspection import table

    from .outputs import inspection_page

    compared = table.compared(made)
    several = len(made) > 1
    heads = ["figure", "unit", *labels, *(("mean", "standard deviation") if several else ())]
    lines = [",".join(map(_quoted, heads))]
    for name, unit, values, mean, deviation in compared:
        numbers = [*values, *((mean, deviation) if several else ())]
        lines.append(
            ",".join(
                [_quoted(name), unit, *("" if one is None else f"{one:.6f}" for one in numbers)]
            )
        )
    files.write(FIGURES, ["\n".join(lines) + "\n"])
    data = {"version": 1, "planned": planned, "inspections": [table.as_data(one) for one in made]}
    files.write(DATA, [json.dumps(data, indent=1, ensure_ascii=False) + "\n"])
    for one, label in zip(made, labels, strict=True):
        files.write(f"{label}-deviations.csv", table.deviations(one))
    files.write(PAGE, [inspection_page.render(planned, made, labels)])


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'
