# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inspect measured points against a job or saved document, and export programs of documents."""

from __future__ import annotations

import json
import os
from typing import Any

from ..core.issues import InfeasibleError, InputError, Issue, Text, Word
from ..report import inspection_page
from . import output_folder as outputs
from .host import require_freecad

_PROGRAMS, _PATHS = ("program",), ("joint path", "toolpath", "program")


WIRE_KINDS, TRAJECTORY = ("step", "dxf"), "json"


def export(
    path: str, folder: str | None, names: tuple[str, ...], session: Any, kind: str = ""
) -> list[str]:
    """Export the programs of a document and return the paths of the written files.

    names: Names or Labels of the objects to export; empty for all programs. Files are written to
    program/ in `folder`, by default out/<document> next to the document. The document does not
    change. kind: one of WIRE_KINDS writes to wires/ instead, TRAJECTORY to trajectories/, one file
    for each joint path, or for each named toolpath, joint path or program. Raises InputError and InfeasibleError and then
    writes nothing.
    """
    label = os.path.basename(path)
    if not os.path.isfile(path):
        raise InputError("NO_FILE", path, "the file does not exist; check the path")
    if not path.lower().endswith(".fcstd"):
        raise InputError(
            "UNSUPPORTED_FILE", label, "programs are in FreeCAD documents; give a .FCStd file"
        )
    require_freecad()
    import FreeCAD

    from ..objects.shapes import linked_files

    target = folder or os.path.join(
        os.path.dirname(os.path.abspath(path)), "out", os.path.splitext(label)[0]
    )
    with outputs.Outputs(target, session) as files:
        session.progress("opening ...")
        open_before = set(FreeCAD.listDocuments())
        document = linked_files.opened(path, label)
        try:
            linked_files.renew_changed(document)
            if kind:
                _write_paths(
                    _chosen(document, label, names, _PATHS, "NO_PATH"), kind, files, session
                )
            else:
                for name, content in _files(
                    _chosen(document, label, names, _PROGRAMS, "NO_PROGRAM"), session
                ).items():
                    files.write(f"{outputs.PROGRAMS}/{name}", content)
        finally:
            # close linked documents, which FreeCAD opened with the document
            for name in set(FreeCAD.listDocuments()) - open_before:
                FreeCAD.closeDocument(name)
        earlier = set() if names or kind else outputs.earlier_programs(files.folder)
        return [os.path.join(files.folder, name) for name in files.publish(earlier)]


def _chosen(
    document: Any, label: str, names: tuple[str, ...], kinds: tuple[str, ...], code: str
) -> list[Any]:
    """Return the stages called `names` of the given kinds.

    Without names, return all stages of the first kind that exists.
    """
    from freecad_am import api
    from freecad_am.objects.shapes import linked_files

    of_kinds = [api.stages_of(document, kind) for kind in kinds]
    candidates = [obj for objects in of_kinds for obj in objects]
    if not candidates:
        raise InputError(
            code, label, "the document has no {}s; create them in the workbench", kinds[0]
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
            message = "{!r} is the label of several {}s; use a name instead of the label"
            raise InputError("NO_OBJECT", label, message, name, kinds[0])
        selected += matches
    selected = selected or next(objects for objects in of_kinds if objects)
    for obj in selected:
        linked_files.refuse_missing_of(obj, label)
    return selected


def _write_paths(paths: list[Any], kind: str, files: outputs.Outputs, session: Any) -> None:
    """Write paths as wires or trajectories. Raises InputError if two have the same file name."""
    from freecad_am import api

    folder = outputs.WIRES if kind in WIRE_KINDS else outputs.TRAJECTORIES
    written: set[str] = set()
    for obj in dict.fromkeys(paths):
        session.progress(f"computing {obj.Label} ...")
        api.recompute(obj)
        session.check()
        name = Text("{}/{}.{}", folder, obj.Label.replace(os.sep, "-"), kind)
        if name in written:
            raise InputError(
                "SAME_NAME",
                obj.Label,
                "two paths write {}; change the label of one path",
                Word(name),
            )
        written.add(name)
        if kind in WIRE_KINDS:
            api.export_wires(obj, files.path(name), rapids=True)
        else:
            api.export_joint_trajectory(obj, files.path(name))


def _files(programs: list[Any], session: Any) -> dict[str, bytes]:
    """Return file contents by name. Raises InputError if two programs have the same file name."""
    from freecad_am import api

    files: dict[str, bytes] = {}
    reported: dict[Issue, None] = {}
    for program in dict.fromkeys(programs):
        session.progress(f"computing {program.Label} ...")
        try:
            api.recompute(program, force=True)
        except InfeasibleError:  # warnings of other stages may explain the error
            _report_findings(program, reported, session)
            raise
        session.check()
        _report_findings(program, reported, session)
        for name, content in api.result(program).files.items():
            if files.setdefault(name, content) != content:
                raise InputError(
                    "SAME_NAME",
                    program.Label,
                    "two programs write {}; change the name of one program",
                    name,
                )
    return files


def _report_findings(program: Any, reported: dict[Issue, None], session: Any) -> None:
    """Report the issues of a program and its inputs that are not in `reported`; add them to it."""
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


FIGURES, DATA, PAGE, DOCUMENT = (
    "inspection.csv",
    "inspection.json",
    "inspection.html",
    "inspection.FCStd",
)
_RESERVED_KEYS = {"measured", "planned", "file", "label", "inspection"}


def inspect(
    source: str,
    measured: tuple[str, ...],
    folder: str | None,
    settings: tuple[str, ...],
    name: str,
    session: Any,
) -> list[str]:
    """Inspect files of measured points and return the paths of the written files.

    Write results for each file, and mean and standard deviation over all files. source: a job file,
    or an FCStd document with the nominal object `name` (Name or Label), by default its only
    feature. settings: inspection parameters as key=value. folder: output folder, by default
    out/<name>-inspection next to the source. Raises InputError and InfeasibleError and then writes
    nothing.
    """
    values = _values(settings)
    require_freecad()
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
            results = [
                _inspection_result(document, planned, path, label, values, session)
                for path, label in zip(measured, labels, strict=True)
            ]
            _write(files, f"{document.Label}, {planned.Label}", results, labels)
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
    values = {}
    for text in settings:
        key, sign, value = text.partition("=")
        if not sign or key.strip() in _RESERVED_KEYS:
            raise InputError(
                "USAGE",
                "freecad-am inspect",
                "{!r} is not a setting; use the form --set tolerance=0.3",
                text,
            )
        values[key.strip()] = value.strip()
    return values


def _labels(measured: tuple[str, ...]) -> list[str]:
    """Return distinct labels of the measured files, for tables and file names."""
    labels: list[str] = []
    for path in measured:
        label = os.path.splitext(os.path.basename(path))[0] or "points"
        number = 2
        while label in labels:
            label, number = f"{label.rpartition(' ')[0] or label} {number}", number + 1
        labels.append(label)
    return labels


def _opened(source: str, name: str, session: Any) -> tuple[Any, Any]:
    """Open the source; return the document and the measured object."""
    if source.lower().endswith(".fcstd"):
        return _open_document(source, name)
    if name:
        raise InputError(
            "USAGE",
            "freecad-am inspect",
            "--object selects an object of an FCStd document, but a job is compared with its own "
            "part; remove --object",
        )
    import FreeCAD

    from .job import job

    job_read = job.read_job(source)
    document = FreeCAD.newDocument("Inspection")
    try:
        document.Label, document.UndoMode = job_read.name, 0
        return document, _feature(document, job_read, session)
    except BaseException:
        FreeCAD.closeDocument(document.Name)
        raise


def _feature(document: Any, job_read: Any, session: Any) -> Any:
    """Make the feature of a job, without its toolpath."""
    from .job.shapes import Shapes

    session.progress("feature ...")
    return Shapes(document, job_read, 0).make_feature([])


def _open_document(path: str, name: str) -> tuple[Any, Any]:
    import FreeCAD

    from freecad_am import api

    from ..objects.shapes import linked_files

    label = os.path.basename(path)
    if not os.path.isfile(path):
        raise InputError("NO_FILE", path, "the file does not exist; check the path")
    document = linked_files.opened(path, label)
    candidates = api.stages_of(document, "feature") if not name else list(document.Objects)
    matches = (
        candidates
        if not name
        else [candidate for candidate in candidates if candidate.Name == name]
        or [candidate for candidate in candidates if candidate.Label == name]
    )
    if len(matches) != 1:
        FreeCAD.closeDocument(document.Name)
        text = (
            Text("{} objects have the label {!r}", len(matches), name)
            if name
            else Text("the job has {} features; choose a feature with --object", len(matches))
        )
        raise InputError("NO_OBJECT", label, "{}; choose the measured object", Word(text))
    return document, matches[0]


def _inspection_result(
    document: Any, planned: Any, path: str, label: str, values: dict[str, str], session: Any
) -> Any:
    from freecad_am import api

    session.progress(f"{label} ...")
    inspection = api.inspect(document, planned, os.path.abspath(path), label, **values)
    session.check()
    session.issues(api.issues(inspection))
    return api.result(inspection)


def _write(files: outputs.Outputs, planned: str, results: list[Any], labels: list[str]) -> None:
    from freecad_am.core.inspection import table

    compared = table.compared(results)
    several = len(results) > 1
    heads = ["figure", "unit", *labels, *(("mean", "standard deviation") if several else ())]
    lines = [",".join(map(_quoted, heads))]
    for name, unit, values, mean, deviation in compared:
        numbers = [*values, *((mean, deviation) if several else ())]
        lines.append(
            ",".join(
                [
                    _quoted(name),
                    unit,
                    *("" if result is None else f"{result:.6f}" for result in numbers),
                ]
            )
        )
    files.write(FIGURES, ["\n".join(lines) + "\n"])
    data = {
        "version": 1,
        "planned": planned,
        "inspections": [table.as_data(result) for result in results],
    }
    files.write(DATA, [json.dumps(data, indent=1, ensure_ascii=False) + "\n"])
    for result, label in zip(results, labels, strict=True):
        files.write(f"{label}-deviations.csv", table.deviations(result))
    files.write(PAGE, [inspection_page.render(planned, results, labels)])


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'
