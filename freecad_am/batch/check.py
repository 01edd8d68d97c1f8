# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drives a program that is there - edited, or written by somebody else - in a cell, and says what it does.

Nothing of a plan is asked: the moves are those of the text, read by the post of its controller.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from freecad_am.core.geometry.file_content import MB, read_content
from freecad_am.core.issues import ERROR, NOTE, InputError, Issue, Text
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics import jacobian
from freecad_am.core.kinematics.cell import Cell
from freecad_am.core.motion import Motion
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.program.build import without_moves
from freecad_am.core.planning.task import CONDITION_FLOOR
from freecad_am.core.preflight import clearance, joints
from freecad_am.core.preflight.promise import Promise, row_place
from freecad_am.core.read_moves import ReadMoves
from freecad_am.core.simulation import rapid_look, waypoints
from freecad_am.core.simulation.margins import spread_to_deposit_rows
from freecad_am.objects.checks import controllers
from freecad_am.posts import catalogue
from freecad_am.read_back import driven, switched
from freecad_am.read_back.finding import Finding
from freecad_am.read_back.into_platform import into_platform
from freecad_am.read_back.selected import selection_findings
from freecad_am.report import figures
from freecad_am.sections import cell as job_cell
from freecad_am.sections import tree

from . import paths
from .job import job
from .outputs import folder as outputs

# of the promises about joints and rapids, in their order, where one is not kept
CODES = ("LIMIT", "UNREACHABLE", "SPEED", "SINGULAR", "RAPID_COLLISION")
LARGEST_MB, MOST_FILES = 200, 2_000
RAPID_PLACES = 20_000
LONGEST_STATEMENT = 80  # characters of one that a message shows
DIGITS = 0.5  # % of an axis's largest speed: by so much a move is quicker that a text has with few digits


class Known(NamedTuple):
    """What is told of a program beside its text: the cell, how programs are written, what joints are to keep, and the width
    and height of beads, None where only a cell is given."""

    cell: CellParameters
    program: ProgramParameters | None
    joints: JointParameters
    bead: tuple[float, float] | None


class Result(NamedTuple):
    """Absolute paths of what was written, the issues, and the exit status, 0 or 3."""

    paths: list[str]
    issues: list[Issue]
    exit_status: int


def check(
    programs: Sequence[str], cell_file: str, post: str | None, folder: str | None, session: Any
) -> Result:
    """Drive the program of these files, or of all files of a folder, in a cell and write what it does.

    cell_file: a job file, or a file with a cell alone. post: the name of the one that reads it, by default that of the job,
    else the first one of the machine's that understands it. It goes into `folder`, by default out/<name>-check beside the
    program. Raises InputError; then nothing is written.
    """
    paths.require_freecad()
    from freecad_am.objects import user_machines

    files = _files(programs)
    known = _known(cell_file)
    cell = cells.resolve(known.cell, np.eye(4), folders=user_machines.folders())
    name, read = _read(files, _posts(cell, known, post))
    settings = known.program or ProgramParameters(post=name)
    motion = driven.driven(
        cell, without_moves(cell, settings, catalogue.controller(name), "check"), read
    )
    promises = _promises(motion, cell, known)
    findings = [
        Finding(
            Issue(
                ERROR,
                code,
                Text("{} - it does not: {}", one.promise, one.figure),
                *(one.place or (None, None, None)),
            ),
            one.row,
        )
        for code, one in zip(CODES, promises, strict=True)
        if one.ok is False
    ]
    findings += [*switched.switching_findings(motion, read), *into_platform(motion, cell)]
    job_numbers = known.program and (known.program.user_frame, known.program.tool_frame)
    findings += selection_findings(motion, read, job_numbers)
    if not motion.deposit.any():
        findings.append(
            Finding(Issue(NOTE, "NO_DEPOSIT", "the program never switches the deposit on"), None)
        )
    lines = [one.line(motion, read) for one in findings]
    issues = [_with_line(one.issue, line) for one, line in zip(findings, lines, strict=True)]
    stem = os.path.splitext(os.path.basename(catalogue.main_file(files)))[0]
    target = folder or os.path.join(
        os.path.dirname(os.path.abspath(programs[0])), "out", f"{stem}-check"
    )
    with outputs.Outputs(target, session) as written:
        written.write(
            outputs.WAYPOINTS, waypoints.text(motion, cell.machine.columns, cell.machine.units)
        )
        written.write(
            outputs.REPORT,
            [figures.text(_report(stem, name, motion, cell, promises, issues, lines))],
        )
        earlier = {
            one
            for one in (outputs.WAYPOINTS, outputs.REPORT)
            if os.path.isfile(os.path.join(written.folder, one))
        }
        made = [os.path.join(written.folder, one) for one in written.publish(earlier)]
    return Result(made, issues, 3 if any(one.level == ERROR for one in issues) else 0)


def _with_line(issue: Issue, line: tuple[str, int] | None) -> Issue:
    """The issue with the line of the program that it is about, where that is known."""
    return (
        issue
        if line is None
        else replace(issue, message=Text("{}; {} line {}", issue.message, *line))
    )


def _files(programs: Sequence[str]) -> dict[str, bytes]:
    """The files by their names as controllers know them; those of a folder by their paths in it."""
    found: dict[str, str] = {}
    for one in programs:
        if os.path.isdir(one):
            inside = (os.path.join(top, name) for top, _, names in os.walk(one) for name in names)
            for path in itertools.islice(inside, MOST_FILES + 1):
                found[os.path.relpath(path, one).replace(os.sep, "/")] = path
        else:
            found[os.path.basename(one)] = one
    where = os.path.basename(os.path.abspath(programs[0]))
    if not found:
        raise InputError(
            "NO_FILE",
            where,
            "the folder holds no program; name its files, or the folder they are in",
        )
    if len(found) > MOST_FILES:
        raise InputError(
            "BAD_FILE",
            where,
            "the folder holds more than {} files; name those of the program",
            MOST_FILES,
        )
    read, remaining = {}, LARGEST_MB * MB
    for name, path in sorted(found.items()):
        try:
            read[name] = read_content(path, LARGEST_MB, "BAD_FILE", name)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise InputError(
                "NO_FILE", name, "it cannot be read ({}); name the program's files", reason
            ) from None
        remaining -= len(read[name])
        if remaining < 0:
            raise InputError(
                "BAD_FILE",
                where,
                "its files are larger than {} MB together; name those of the program alone",
                LARGEST_MB,
            )
    return read


def _known(path: str) -> Known:
    """What a job file, or a file with a cell alone, tells."""
    values = tree.read(path).values
    if not {"part", "features", "cell"} & set(values):
        return Known(job_cell.of_file(os.path.abspath(path)), None, JointParameters(), None)
    if not {"part", "features"} & set(values):
        read_cell = job.read_without_part(path)
        return Known(read_cell.cell, read_cell.program, read_cell.joints, None)
    read = job.read_job(path)
    if read.cell is None:
        raise InputError(
            "NO_CELL",
            f"{os.path.basename(path)}: cell",
            "the job has no cell to drive a program in; add one",
        )
    heights = max(one.strategy.layer_height for one in read.features)
    return Known(read.cell, read.program, read.joints, (read.process.bead_width, heights))


def _posts(cell: Cell, known: Known, post: str | None) -> tuple[str, ...]:
    """The names of the posts that may read a program, the most likely one first."""
    if post is not None:
        return (post,)
    if known.program is not None and known.program.post != "none":
        return (known.program.post,)
    posts = controllers.readers(cell)
    return catalogue.NAMES if posts is None else posts


def _read(files: dict[str, bytes], posts: Sequence[str]) -> tuple[str, ReadMoves]:
    """The post that understands the files, and their moves. Raises InputError of the one that came first."""
    refusals = []
    for name in posts:
        try:
            return name, catalogue.load(name).read(files)
        except InputError as error:
            refusals.append(_with_statement(error, files))
    if not refusals:
        raise InputError(
            "UNKNOWN_POST",
            "cell.machine",
            "no post reads programs of this machine; name one with --post",
        )
    raise refusals[0]


def _with_statement(error: InputError, files: dict[str, bytes]) -> InputError:
    """The error with the statement that stands on the line it names, where it does not show that itself."""
    file, _, number = error.where.rpartition(" line ")
    lines = files.get(file, b"").decode("latin-1").splitlines()
    if not number.isdigit() or not 0 < int(number) <= len(lines):
        return error
    statement = lines[int(number) - 1].strip()[:LONGEST_STATEMENT]
    if not statement or repr(statement) in error.message:
        return error
    return InputError(error.code, error.where, "{} ({!r})", error.message, statement)


def _promises(motion: Motion, cell: Cell, known: Known) -> list[Promise]:
    """Those of the preflight that a text alone can keep or break, in the order of CODES."""
    rows = np.flatnonzero(motion.deposit)
    condition, least = np.full(len(rows), np.nan), np.full(len(rows), np.nan)
    reached = motion.reachable[rows]
    if cell.machine.free and reached.any():
        asked = known.joints.min_condition
        least[:] = CONDITION_FLOOR if isinstance(asked, str) else asked
        condition[reached] = _condition(
            cell, motion.joints[rows[reached]], known.joints.characteristic_length
        )
    found = joints.promises(
        motion,
        cell,
        spread_to_deposit_rows(motion.deposit, condition),
        spread_to_deposit_rows(motion.deposit, least),
        DIGITS,
    )
    found[1] = replace(
        found[1], how="inverse kinematics of what the text tells in positions, and joints driven"
    )
    if known.bead is None:
        how = "not checked: a cell alone does not tell how wide and high beads are; give a job"
        return [*found, Promise(clearance.ON_RAPIDS, how, None)]
    looked = rapid_look.looked_at(motion, driven.beads(motion), cell, [], *known.bead, RAPID_PLACES)
    row = int(looked.rows[0]) if len(looked.rows) else None
    place = None if row is None else row_place(motion, row)
    how = f"driven at {looked.places} places against the platform and what is deposited by then; no other body is known"
    met = float(len(looked.rows))
    return [*found, Promise(clearance.ON_RAPIDS, how, not met, met, "rapids", 0.0, place, row=row)]


def _condition(cell: Cell, serial: Any, length: float) -> Any:
    """(n,) of the robot alone at the deposition point, for joints (n, axes)."""
    chain = cell.robot.chain
    own = serial[:, : chain.axes]
    flange = chain.forward(own)
    point = cell.deposition_point(flange)
    return jacobian.condition(jacobian.jacobian(chain, own, point), length)


def _report(
    name: str,
    post: str,
    motion: Motion,
    cell: Cell,
    promises: Sequence[Promise],
    issues: Sequence[Issue],
    lines: Sequence[tuple[str, int] | None],
) -> dict[str, Any]:
    """The keys of a plan's report that a text alone can fill."""
    deposited, reached = motion.deposit & motion.moves, motion.reachable
    way = np.linalg.norm(np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1)
    shown = motion.joints[reached] / cell.machine.unit_values
    starts = motion.deposit & (motion.point == 0)
    return {
        "version": figures.VERSION,
        "name": name,
        "post": post,
        "status": "infeasible" if any(one.level == ERROR for one in issues) else "ok",
        "issues": [
            {**one.as_dict(), **dict(zip(("file", "line"), line or (None, None), strict=True))}
            for one, line in zip(issues, lines, strict=True)
        ],
        "counts": {
            "layers": len(np.unique(motion.layer[motion.deposit])),
            "beads": int(starts.sum()),
            "points": int(motion.deposit.sum()),
        },
        "length_mm": float(way[deposited].sum()),
        "duration_s": motion.total_time,
        "joints": {
            "min_deg": shown.min(axis=0).tolist() if len(shown) else None,
            "max_deg": shown.max(axis=0).tolist() if len(shown) else None,
        },
        "preflight": [one.as_dict() for one in promises],
        "machine": {
            "id": cell.machine.id,
            "title": cell.machine.title,
            "setup": cell.setup,
            "limits": cell.limits.name,
            "axes": list(cell.machine.columns),
            "labels": list(cell.machine.axes),
            "units": list(cell.machine.units),
            "controller": cell.machine.controller_remark,
        },
    }
