# SPDX-License-Identifier: LGPL-2.1-or-later
"""Output folder: files appear completely or not at all, and only files of this program are removed.

Nothing is written or removed outside the folder.
"""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from ..core.issues import InputError, Text
from ..posts import own_programs as earlier_posts
from . import child, staging
from .job.job import Job

WAYPOINTS, REPORT, PAGE, PROGRAMS, WIRES, TRAJECTORIES = (
    "waypoints.csv",
    "report.json",
    "report.html",
    "program",
    "wires",
    "trajectories",
)
DOCUMENT_ENDING = ".FCStd"
LARGEST_REPORT = 1 << 28  # bytes; maximum size of an earlier report to read for its outputs


class Outputs:
    """Collect the files of a run in a hidden folder of the target, then move them into place.

    Context manager: leaving the context without `publish` removes all collected files and leaves
    the target folder unchanged. Raises InputError UNWRITABLE immediately if the target is not
    writable or a link leads outside. `session` receives messages about other runs in the same
    folder, and about the files.
    """

    def __init__(self, folder: str, session: Any = None) -> None:
        self.folder = os.path.abspath(folder)
        self._session = session
        self._made: list[str] = []
        self._staging: Any = None
        try:
            with staging.uninterrupted():
                self._make_folder()
                staging.refuse(
                    self.folder, [f"{inside}/any" for inside in (PROGRAMS, WIRES, TRAJECTORIES)]
                )
                self._staging = staging.Staging(self.folder)
                child.report_outputs(self.folder, self._made)
            if self._staging.others and session is not None:
                session.say(
                    f"note[BUSY] {self.folder}: another run writes into the same folder, and the outputs of the later "
                    "run remain; choose another folder with -o"
                )
        except (OSError, ValueError) as error:
            self._remove()
            raise self._unwritable(getattr(error, "filename", None) or self.folder, error) from None
        except BaseException:  # Ctrl-C
            self._remove()
            raise

    def __enter__(self) -> Outputs:
        return self

    def __exit__(self, *_: object) -> None:
        self._remove()

    def path(self, name: str) -> str:
        """Return the path for writing the file `name` of the run; `name` uses slashes."""
        path = os.path.join(self._staging.files, *name.split("/"))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def write(self, name: str, data: bytes | Iterable[str]) -> None:
        """Write a file of the run. Text chunks are written as UTF-8 with unchanged line ends."""
        try:
            with open(self.path(name), "wb") as stream:
                stream.writelines(
                    [data] if isinstance(data, bytes) else (chunk.encode() for chunk in data)
                )
        except OSError as error:
            raise self._unwritable(os.path.join(self.folder, *name.split("/")), error) from None

    def publish(self, earlier: set[str]) -> list[str]:
        """Move all files into place and return their sorted names. Signals wait until the end.

        Files in `earlier` without a successor are removed first, because no program may stay next
        to a report that does not list it. The report is moved last.
        """
        names = sorted(_files(self._staging.files))
        with staging.uninterrupted():
            try:
                self._staging.publish(
                    sorted(names, key=lambda name: (name == REPORT, name)),
                    sorted(earlier - set(names)),
                )
            except OSError as error:
                raise self._unwritable(error.filename or self.folder, error) from None
            if self._session is not None:
                self._session.outcome = "the outputs were already complete"
        return names

    def _unwritable(self, path: str, error: Exception) -> InputError:
        reason = getattr(error, "strerror", None) or str(error)
        message = Text(
            "the outputs cannot be written ({}); check the folder, or choose another folder with "
            "-o",
            reason,
        )
        return InputError("UNWRITABLE", path, message)

    def _make_folder(self) -> None:
        missing = []
        path = self.folder
        while not os.path.lexists(path):
            missing.append(path)
            path = os.path.dirname(path)
        for path in reversed(missing):
            try:
                os.mkdir(path)
                self._made.append(path)
            except FileExistsError:
                if not os.path.isdir(path):  # another row of the batch may have made the folder
                    raise

    def _remove(self) -> None:
        """Remove all collected files, and new folders that contain no published file."""
        with staging.uninterrupted():
            if self._staging is not None:
                self._staging.remove()
            for path in reversed(self._made):
                try:
                    os.rmdir(path)
                except OSError:  # the folder contains published files
                    return


def earlier_programs(folder: str) -> set[str]:
    """Return the names of earlier robot programs in program/, with their part files."""
    if os.path.islink(os.path.join(folder, PROGRAMS)):
        return set()
    programs_by_post = earlier_posts.programs(os.path.join(folder, PROGRAMS)).values()
    return {f"{PROGRAMS}/{name}" for names in programs_by_post for name in names}


def earlier_outputs(folder: str) -> set[str]:
    """Return the output names of an earlier run: files listed in its report, and its programs."""
    names = earlier_programs(folder)
    report = _earlier_report(folder)
    if report is None:
        return names
    listed = {
        name
        for name in report["programs"]
        if staging.is_inside(name) and name.startswith(PROGRAMS + "/")
    }
    present = {name for name in listed if not _is_behind_link(folder, name)}
    return names | present | {WAYPOINTS, REPORT, PAGE, report["name"] + DOCUMENT_ENDING}


def _is_behind_link(folder: str, name: str) -> bool:
    try:
        staging.refuse(folder, [name])
    except OSError:
        return True
    return False


def _earlier_report(folder: str) -> dict[str, Any] | None:
    path = os.path.join(folder, REPORT)
    try:
        if not os.path.isfile(path) or os.path.getsize(path) > LARGEST_REPORT:
            return None
        with open(path, encoding="utf-8") as stream:
            report = json.load(stream)
    except (OSError, ValueError, RecursionError):
        return None
    if (
        not isinstance(report, dict)
        or not isinstance(report.get("programs"), list)
        or "issues" not in report
    ):
        return None  # not ours
    name = report.get("name")
    return report if staging.is_inside(name) and "/" not in str(name) else None


def _files(folder: str) -> Iterator[str]:
    for root, _, files in os.walk(folder):
        for file in files:
            yield os.path.relpath(os.path.join(root, file), folder).replace(os.sep, "/")


# ---- Job and results in the form that the report needs


def results(stages: Any, programs: Sequence[str]) -> Any:
    """Return the results of the completed stages for the report."""
    from freecad_am import api
    from freecad_am.objects.checks import preflight

    from ..report.figures import Results

    path = stages.joint_path
    survey = functools.cache(preflight.survey_of(stages.toolpath, path, stages.job.program))
    return Results(
        api.result(stages.toolpath),
        None if path is None else api.result(path),
        0.0 if path is None else path.Seconds,
        stages.issues,
        programs,
        lambda: survey().distances,
        lambda: preflight.stage_preflight(stages.toolpath, path, stages.program, survey),
    )


def job(read_job: Job, stages: Any) -> Any:
    """Return the job in the form that the report needs."""
    from ..report import figures

    features = tuple(
        figures.Feature(
            feature_read.name,
            feature_read.strategy,
            feature_read.build_direction,
            feature_read.process,
            functools.partial(_result, feature),
        )
        for feature_read, feature in zip(read_job.features, stages.features, strict=True)
    )
    return figures.Job(read_job.name, features, read_job.process, read_job.joints, read_job.cell)


def _result(obj: Any) -> Any:
    from freecad_am import api

    return api.result(obj)
