# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulate an existing program, edited or from another source, in a cell, and write a report.

No plan is needed: the controller's post reads the moves from the program text.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..core.geometry.job_files import MB, read_content
from ..core.issues import ERROR, NOTE, InputError, Issue, Text
from ..core.kinematics import cell as cells
from ..core.kinematics import jacobian
from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from ..core.parameters.cell import CellParameters
from ..core.parameters.joints import JointParameters
from ..core.parameters.program import ProgramParameters
from ..core.planning.program import build_header
from ..core.planning.task import CONDITION_FLOOR
from ..core.preflight import clearance
from ..core.preflight.promise import Promise, row_place
from ..core.read_moves import ReadMoves
from ..core.simulation import rapid_contacts, waypoints
from ..core.simulation.achievable_feed import spread_to_deposit_rows
from ..objects.checks import controllers
from ..posts import catalogue
from ..read_back import followed, selected
from ..read_back.selected import Finding, into_platform, selection_findings
from ..report import figures
from ..sections import cell as job_cell
from ..sections import tree
from . import output_folder as outputs
from .host import require_freecad
from .job import job

# issue codes of broken promises about joints and rapids, in the order of the promises
CODES = ("LIMIT", "UNREACHABLE", "SPEED", "SINGULAR", "RAPID_COLLISION")
LARGEST_MB, MOST_FILES = 200, 2_000
RAPID_PLACES = 20_000
LONGEST_STATEMENT = 80  # maximum number of characters of a statement in a message
DIGITS = 0.5  # % of maximum axis speed; speed tolerance for rounded numbers in the text


class Known(NamedTuple):
    """Context of a program text: cell, program and joint parameters.

    program: None if only a cell is given. bead: bead width and height, mm; None without a job.
    """

    cell: CellParameters
    program: ProgramParameters | None
    joints: JointParameters
    bead: tuple[float, float] | None


class Result(NamedTuple):
    """Absolute paths of the written files, issues, and exit status, 0 or 3."""

    paths: list[str]
    issues: list[Issue]
    exit_status: int


def check(
    programs: Sequence[str], cell_file: str, post: str | None, folder: str | None, session: Any
) -> Result:
    """Simulate a program in a cell and write a report.

    programs: program files, or a folder. cell_file: a job file or a cell file. post: name of the
    post that reads the program; the default is the job's post, else the machine's first post that
    accepts the text. folder: output folder; the default is out/<name>-check next to the program.
    Raises InputError and then writes nothing.
    """
    require_freecad()
    from freecad_am.objects import user_machines

    files = _files(programs)
    context = _known(cell_file)
    cell = cells.resolve(context.cell, np.eye(4), folders=user_machines.folders())
    name, moves = _read(files, _posts(cell, context, post))
    settings = context.program or ProgramParameters(post=name)
    motion = followed.drive(
        cell, build_header(cell, settings, catalogue.controller(name), "check"), moves
    )
    promises = _promises(motion, cell, context)
    findings = [
        Finding(
            Issue(
                ERROR,
                code,
                Text("{} - fails: {}", entry.promise, entry.figure),
                *(entry.place or (None, None, None)),
            ),
            entry.row,
        )
        for code, entry in zip(CODES, promises, strict=True)
        if entry.ok is False
    ]
    findings += [*selected.switching_findings(motion, moves), *into_platform(motion, cell)]
    job_numbers = context.program and (context.program.user_frame, context.program.tool_frame)
    findings += selection_findings(motion, moves, job_numbers)
    if not motion.deposit.any():
        findings.append(
            Finding(Issue(NOTE, "NO_DEPOSIT", "the program never switches the deposit on"), None)
        )
    lines = [entry.line(motion, moves) for entry in findings]
    issues = [_add_line(entry.issue, line) for entry, line in zip(findings, lines, strict=True)]
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
            entry
            for entry in (outputs.WAYPOINTS, outputs.REPORT)
            if os.path.isfile(os.path.join(written.folder, entry))
        }
        written_paths = [os.path.join(written.folder, entry) for entry in written.publish(earlier)]
    return Result(written_paths, issues, 3 if any(entry.level == ERROR for entry in issues) else 0)


def _add_line(issue: Issue, line: tuple[str, int] | None) -> Issue:
    """Return the issue with its program line appended to the message, if the line is known."""
    return (
        issue
        if line is None
        else replace(issue, message=Text("{}; {} line {}", issue.message, *line))
    )


def _files(programs: Sequence[str]) -> dict[str, bytes]:
    """Read the program files. Return contents by file name, or by relative path in a folder."""
    paths: dict[str, str] = {}
    for program in programs:
        if os.path.isdir(program):
            inside = (
                os.path.join(top, name) for top, _, names in os.walk(program) for name in names
            )
            for path in itertools.islice(inside, MOST_FILES + 1):
                paths[os.path.relpath(path, program).replace(os.sep, "/")] = path
        else:
            paths[os.path.basename(program)] = program
    where = os.path.basename(os.path.abspath(programs[0]))
    if not paths:
        raise InputError(
            "NO_FILE",
            where,
            "the folder holds no program; pass the program files, or the folder that contains them",
        )
    if len(paths) > MOST_FILES:
        raise InputError(
            "BAD_FILE",
            where,
            "the folder holds more than {} files; pass the program files by name",
            MOST_FILES,
        )
    contents, remaining = {}, LARGEST_MB * MB
    for name, path in sorted(paths.items()):
        try:
            contents[name] = read_content(path, LARGEST_MB, "BAD_FILE", name)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise InputError(
                "NO_FILE",
                name,
                "the file cannot be read ({}); pass the files of the program",
                reason,
            ) from None
        remaining -= len(contents[name])
        if remaining < 0:
            raise InputError(
                "BAD_FILE",
                where,
                "the files are larger than {} MB in total; pass only the program files",
                LARGEST_MB,
            )
    return contents


def _known(path: str) -> Known:
    """Read the context from a job file or a cell file."""
    values = tree.read(path).values
    if not {"part", "features", "cell"} & set(values):
        return Known(job_cell.read_cell_file(os.path.abspath(path)), None, JointParameters(), None)
    if not {"part", "features"} & set(values):
        read_cell = job.read_without_part(path)
        return Known(read_cell.cell, read_cell.program, read_cell.joints, None)
    job_read = job.read_job(path)
    if job_read.cell is None:
        raise InputError(
            "NO_CELL",
            f"{os.path.basename(path)}: cell",
            "the job has no cell to run a program in; add the section `cell`",
        )
    heights = max(feature.strategy.layer_height for feature in job_read.features)
    return Known(
        job_read.cell, job_read.program, job_read.joints, (job_read.process.bead_width, heights)
    )


def _posts(cell: Cell, context: Known, post: str | None) -> tuple[str, ...]:
    """Return the names of the posts that may read a program, the most likely post first."""
    if post is not None:
        return (post,)
    if context.program is not None and context.program.post != "none":
        return (context.program.post,)
    posts = controllers.readers(cell)
    return catalogue.NAMES if posts is None else posts


def _read(files: dict[str, bytes], posts: Sequence[str]) -> tuple[str, ReadMoves]:
    """Return the first post that can read the files, and the moves.

    If no post can, raise the InputError of the first post.
    """
    refusals = []
    for name in posts:
        try:
            return name, catalogue.load(name).read(files)
        except InputError as error:
            refusals.append(_add_statement(error, files))
    if not refusals:
        raise InputError(
            "UNKNOWN_POST",
            "cell.machine",
            "no post reads programs for the machine of the cell; choose a post with --post",
        )
    raise refusals[0]


def _add_statement(error: InputError, files: dict[str, bytes]) -> InputError:
    """Return the error with the program statement appended, unless the message contains it."""
    file, _, number = error.where.rpartition(" line ")
    lines = files.get(file, b"").decode("latin-1").splitlines()
    if not number.isdigit() or not 0 < int(number) <= len(lines):
        return error
    statement = lines[int(number) - 1].strip()[:LONGEST_STATEMENT]
    if not statement or repr(statement) in error.message:
        return error
    return InputError(error.code, error.where, "{} ({!r})", error.message, statement)


def _promises(motion: Motion, cell: Cell, context: Known) -> list[Promise]:
    """Return the preflight promises that apply to a program text, in the order of CODES."""
    rows = np.flatnonzero(motion.deposit)
    condition, thresholds = np.full(len(rows), np.nan), np.full(len(rows), np.nan)
    reached = motion.reachable[rows]
    if cell.machine.free and reached.any():
        min_condition = context.joints.min_condition
        thresholds[:] = CONDITION_FLOOR if isinstance(min_condition, str) else min_condition
        condition[reached] = _condition(
            cell, motion.joints[rows[reached]], context.joints.characteristic_length
        )
    promises = clearance.promises(
        motion,
        cell,
        spread_to_deposit_rows(motion.deposit, condition),
        spread_to_deposit_rows(motion.deposit, thresholds),
        DIGITS,
    )
    promises[1] = replace(
        promises[1],
        how="inverse kinematics of the positions in the text, and joint values simulated",
    )
    if context.bead is None:
        how = "not checked: a cell does not define the width and height of beads; give a job"
        return [*promises, Promise(clearance.ON_RAPIDS, how, None)]
    rapid_check = rapid_contacts.looked_at(
        motion, followed.beads(motion), cell, [], *context.bead, RAPID_PLACES
    )
    row = int(rapid_check.rows[0]) if len(rapid_check.rows) else None
    location = None if row is None else row_place(motion, row)
    how = f"rapids simulated at {rapid_check.places} places against the platform and the deposit at that time; other obstacles are unknown"
    met = float(len(rapid_check.rows))
    return [
        *promises,
        Promise(clearance.ON_RAPIDS, how, not met, met, "rapids", 0.0, location, row=row),
    ]


def _condition(cell: Cell, serial: Any, length: float) -> Any:
    """Return inverse condition numbers (n,) at the deposition point for joints (n, axes).

    External axes are excluded. length: characteristic length, mm.
    """
    chain = cell.robot.chain
    robot_joints = serial[:, : chain.axes]
    flange = chain.forward(robot_joints)
    point = cell.deposition_point(flange)
    return jacobian.condition(jacobian.jacobian(chain, robot_joints, point), length)


def _report(
    name: str,
    post: str,
    motion: Motion,
    cell: Cell,
    promises: Sequence[Promise],
    issues: Sequence[Issue],
    lines: Sequence[tuple[str, int] | None],
) -> dict[str, Any]:
    """Return the report keys that a program text can provide."""
    deposited, reached = motion.deposit & motion.moves, motion.reachable
    steps = np.linalg.norm(np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1)
    displayed_joints = motion.joints[reached] / cell.machine.unit_values
    starts = motion.deposit & (motion.point == 0)
    return {
        "version": figures.VERSION,
        "name": name,
        "post": post,
        "status": "infeasible" if any(entry.level == ERROR for entry in issues) else "ok",
        "issues": [
            {**entry.as_dict(), **dict(zip(("file", "line"), line or (None, None), strict=True))}
            for entry, line in zip(issues, lines, strict=True)
        ],
        "counts": {
            "layers": len(np.unique(motion.layer[motion.deposit])),
            "beads": int(starts.sum()),
            "points": int(motion.deposit.sum()),
        },
        "length_mm": float(steps[deposited].sum()),
        "duration_s": motion.total_time,
        "joints": {
            "min_deg": displayed_joints.min(axis=0).tolist() if len(displayed_joints) else None,
            "max_deg": displayed_joints.max(axis=0).tolist() if len(displayed_joints) else None,
        },
        "preflight": [entry.as_dict() for entry in promises],
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
