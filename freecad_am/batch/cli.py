# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command line of the headless commands plan, export, batch, inspect, check, place and machines.

Each command imports its modules when it runs. Start-up dominates the run time of a small job, and
command line errors should appear immediately.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from typing import Any, NoReturn

from ..core.issues import InputError

SUCCESS, OUR_FAULT, BAD_INPUT, INFEASIBLE, INTERRUPTED = 0, 1, 2, 3, 130
SHAPES = ("plan", "export", "inspect", "place")  # commands that read shapes


def main(argv: list[str]) -> int:
    """Run one command and return its exit status. Messages go to stderr, results to stdout.

    Commands that read shapes run in a child process, because the geometry kernel may crash.
    """
    from freecad_am.batch import console

    if argv[1:] and argv[0] in SHAPES:
        from freecad_am.batch import child

        def say(line: str) -> None:
            print(console.escaped(line), file=sys.stderr)

        return child.run_in_child(lambda: _main(argv), os.path.basename(argv[1]) or argv[1], say)
    return _main(argv)


def _main(argv: list[str]) -> int:
    from freecad_am.batch import console

    with console.Session() as session:
        try:
            return _run(argv, session)
        except KeyboardInterrupt:
            return _interrupted(session)
        except BrokenPipeError:
            return SUCCESS  # the reader closed the pipe, which is not an error
        except Exception as error:
            # FreeCAD 1.0 modules interrupted during import raise other errors or stay empty
            return _interrupted(session) if session.interrupted else _failed(error, session)


def _run(argv: list[str], session: Any) -> int:

    from freecad_am.core.issues import InputError

    command_line_parser, parsers = command_parsers()
    if not argv or argv[0] in ("-h", "--help", "help"):
        session.out(command_line_parser.format_help())
        return SUCCESS if argv else BAD_INPUT
    command, words = argv[0], argv[1:]
    for word in argv:
        if not word.isascii() and word != word.encode("utf-8", "replace").decode("utf-8"):
            printable = word.encode("utf-8", "backslashreplace").decode("utf-8")
            raise InputError(
                "USAGE",
                "command line",
                "{!r} holds bytes that are not UTF-8; use a name in UTF-8",
                printable,
            )
    if command not in parsers:
        import difflib

        close_matches = difflib.get_close_matches(
            command, (*parsers, "demo", "test", "bench", "docs"), n=1
        )
        hint = (
            f"did you mean {close_matches[0]}?"
            if close_matches
            else f"use one of {', '.join(parsers)}"
        )
        raise InputError("USAGE", "command line", "unknown command {!r}; {}", command, hint)
    parser = parsers[command]
    if "-h" in words or "--help" in words:
        session.out(parser.format_help())
        return SUCCESS
    options = parser.parse_args(words)
    return RUN_COMMANDS[command](options, session)


def _interrupted(session: Any) -> int:
    session.say(f"interrupted: {session.outcome}")
    return INTERRUPTED


def _failed(error: Exception, session: Any) -> int:
    from freecad_am.core.issues import AmError

    if os.environ.get("FREECAD_AM_DEBUG"):
        import traceback

        for line in traceback.format_exc().rstrip().split("\n"):
            session.say(line)
    if isinstance(error, AmError):
        session.say(error.line())
        return error.exit_status
    what = " ".join(str(error).split()) or "no message"
    session.say(
        f"error[INTERNAL] {type(error).__name__}: {what}; please report this bug with the job "
        "(FREECAD_AM_DEBUG=1 shows where)"
    )
    return OUR_FAULT


def _plan(options: Any, session: Any) -> int:
    from freecad_am.batch import run
    from freecad_am.batch.job import job

    job_read = job.read_job(options.job)
    result = run.run(
        job_read, options.output or run.default_folder(job_read), session, page=not options.no_page
    )
    _tell_paths(result.paths, session)
    return result.exit_status


def _tell_paths(paths: list[str], session: Any) -> None:
    from freecad_am.batch.console import escaped

    session.out("".join(f"{escaped(path)}\n" for path in paths))


def _export(options: Any, session: Any) -> int:
    from . import measured

    paths = measured.export(
        options.document, options.output, tuple(options.object), session, options.paths
    )
    _tell_paths(paths, session)
    return SUCCESS


def _batch(options: Any, session: Any) -> int:
    from freecad_am.batch import rows

    if options.scheduler and options.jobs is not None:
        from freecad_am.core.issues import InputError

        raise InputError(
            "USAGE",
            "freecad-am batch",
            "-j sets the number of local rows, but --scheduler plans on a cluster, whose workers "
            "set their own number; remove one of the two options",
        )
    how = rows.How(options.jobs or 1, options.scheduler or "", options.resume, options.dry_run)
    return rows.run(options.table, options.job, options.output, how, session)


def _inspect(options: Any, session: Any) -> int:
    from freecad_am.batch import measured

    paths = measured.inspect(
        options.source,
        tuple(options.measured),
        options.output,
        tuple(options.settings),
        options.object,
        session,
    )
    _tell_paths(paths, session)
    return SUCCESS


def _check(options: Any, session: Any) -> int:
    from freecad_am.batch import check

    result = check.check(options.program, options.cell, options.post, options.output, session)
    session.issues(result.issues)
    _tell_paths(result.paths, session)
    return result.exit_status


def _place(options: Any, session: Any) -> int:
    from freecad_am.batch import place
    from freecad_am.batch.job import job

    result = place.place(job.read_job(options.job), options.output, session)
    session.issues(result.issues)
    session.out(f"{result.line}\n" if result.line else "")
    return result.exit_status


def _machines(options: Any, session: Any) -> int:
    from freecad_am.batch import machines
    from freecad_am.core.issues import InputError

    if options.form is None and options.machine is not None:
        raise InputError(
            "USAGE",
            "freecad-am machines",
            "the output format for {!r} is missing; use --urdf, --dh or --modified-dh",
            options.machine,
        )
    if options.form is not None and options.machine is None:
        raise InputError(
            "USAGE", "freecad-am machines", "--{} needs the name of a machine", options.form
        )
    criteria = (options.maker, options.reach, options.payload, options.post)
    filtered = any(criterion is not None for criterion in criteria)
    if filtered and options.machine is not None:
        raise InputError(
            "USAGE",
            "freecad-am machines",
            "--maker, --reach, --payload and --post filter the list; remove {!r} or these options",
            options.machine,
        )
    if options.machine is not None:
        session.out(machines.export_text(options.machine, options.form))
    else:
        session.out(machines.chosen(*criteria) if filtered else machines.listing())
    return SUCCESS


RUN_COMMANDS: dict[str, Callable[[Any, Any], int]] = {
    "plan": _plan,
    "export": _export,
    "batch": _batch,
    "inspect": _inspect,
    "check": _check,
    "place": _place,
    "machines": _machines,
}


if __name__ == "__main__":
    status = main(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # skip FreeCAD's slow teardown; the process exit frees the resources


# ---- Command line of the headless commands, with argparse subparsers

PROGRAM = "freecad-am"


class Parser(argparse.ArgumentParser):
    """A parser that raises InputError for usage errors and names the help command."""

    def error(self, message: str) -> NoReturn:
        """Raise InputError USAGE."""
        raise InputError("USAGE", self.prog, "{}; try {} --help", message, self.prog)


def command_parsers() -> tuple[Parser, dict[str, Parser]]:
    """Return the parser of the whole command line and the command parsers by name.

    The parsers have no help action: the session prints help with escapes that the terminal needs.
    """
    command_line_parser = Parser(prog=PROGRAM, allow_abbrev=False, add_help=False)
    command_line_parser.usage = f"{PROGRAM} COMMAND"
    command_line_parser.epilog = (
        f"demo, test, bench and docs: see the README; {PROGRAM} COMMAND --help lists the options"
    )
    commands = command_line_parser.add_subparsers(
        title="commands", metavar="COMMAND", dest="command"
    )
    output = Parser(add_help=False)
    output.add_argument(
        "-o",
        "--output",
        metavar="DIR",
        help="folder of the outputs; default: out/<name> next to the job",
    )
    parsers = {}
    for name, (summary, has_outputs, add_arguments) in COMMANDS.items():
        parser = commands.add_parser(
            name,
            prog=f"{PROGRAM} {name}",
            help=summary,
            description=summary,
            parents=[output] if has_outputs else [],
            allow_abbrev=False,
            add_help=False,
        )
        add_arguments(parser)
        parsers[name] = parser
    return command_line_parser, parsers


def _add_plan(parser: Parser) -> None:
    parser.add_argument("job", metavar="JOB.yaml")
    parser.add_argument("--no-page", action="store_true", help="do not write report.html")


def _add_place(parser: Parser) -> None:
    parser.add_argument("job", metavar="JOB.yaml")


def _add_export(parser: Parser) -> None:
    parser.add_argument("document", metavar="DOC.FCStd")
    parser.add_argument(
        "--object", metavar="NAME", nargs="+", action="extend", default=[], help="Name or Label"
    )
    kinds = parser.add_mutually_exclusive_group()
    kinds.add_argument(
        "--wires",
        choices=("step", "dxf"),
        default="",
        dest="paths",
        help="write paths as wires, not programs",
    )
    kinds.add_argument(
        "--trajectory",
        action="store_const",
        const="json",
        dest="paths",
        help="write joint paths as JointTrajectory of ROS, not programs",
    )


def _add_inspect(parser: Parser) -> None:
    parser.add_argument("source", metavar="JOB.yaml|DOC.FCStd")
    parser.add_argument(
        "--measured",
        metavar="FILE",
        nargs="+",
        action="extend",
        required=True,
        help="points (csv, txt, xyz, asc) or scans (stl, obj, ply)",
    )
    parser.add_argument(
        "--set",
        metavar="KEY=VALUE",
        nargs="+",
        action="extend",
        default=[],
        dest="settings",
        help="parameters of the inspection, such as tolerance=0.3 probe_radius=1.5 heights='15 25 35'",
    )
    parser.add_argument(
        "--object", metavar="NAME", default="", help="Name or Label of the measured object"
    )


def _add_check(parser: Parser) -> None:
    parser.add_argument(
        "program", metavar="PROGRAM", nargs="+", help="the files of a program, or their folder"
    )
    parser.add_argument("--cell", metavar="FILE", required=True, help="job file or cell file")
    parser.add_argument(
        "--post",
        metavar="NAME",
        help="post that reads the program; default: the post of the job or of the machine",
    )


def _add_batch(parser: Parser) -> None:
    parser.add_argument("table", metavar="TABLE.csv")
    parser.add_argument("--job", metavar="JOB.yaml", required=True)
    parser.add_argument(
        "-j", "--jobs", metavar="N", type=_process_count, help="rows planned at the same time"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="plan on the workers of this Dask scheduler"
    )
    parser.add_argument(
        "--resume", action="store_true", help="keep the rows completed by an earlier run"
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="check all rows without planning any row"
    )


def _add_machines(parser: Parser) -> None:
    parser.add_argument(
        "machine", metavar="NAME", nargs="?", help="a machine of the list, or a machine file"
    )
    forms = parser.add_mutually_exclusive_group()
    for option, form, words in (
        ("--urdf", "urdf", "write the machine as URDF, without shapes"),
        ("--dh", "dh", "write the Denavit-Hartenberg table of the machine, in mm and degrees"),
        (
            "--modified-dh",
            "modified-dh",
            "write the modified (Craig) Denavit-Hartenberg table, in mm and degrees",
        ),
    ):
        forms.add_argument(option, action="store_const", const=form, dest="form", help=words)
    parser.add_argument("--maker", metavar="NAME", help="list machines of this manufacturer")
    parser.add_argument("--reach", metavar="LENGTH", help="list machines with at least this reach")
    parser.add_argument(
        "--payload", metavar="MASS", help="list machines with at least this payload"
    )
    parser.add_argument(
        "--post",
        metavar="NAME",
        help="list machines with controllers that read the programs of this post",
    )


def _process_count(text: str) -> int:
    """Parse the number of processes. argparse adds the option name to the error."""
    if not text.isdecimal() or not 1 <= int(text) <= 256:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes from 1 to 256")
    return int(text)


# for each command: summary, whether it writes outputs, and the function that adds its arguments
COMMANDS: dict[str, tuple[str, bool, Callable[[Parser], None]]] = {
    "plan": ("plan one job, from part to programs", True, _add_plan),
    "export": ("recompute a saved document and write its programs", True, _add_export),
    "batch": ("plan one job per row of a table of job keys", True, _add_batch),
    "inspect": ("compare measured points with the plan", True, _add_inspect),
    "check": ("check an edited or foreign program in a cell", True, _add_check),
    "place": (
        "find feasible positions of the part, and the best pose in its cell",
        True,
        _add_place,
    ),
    "machines": (
        "list the known machines, or write a machine as URDF or table",
        False,
        _add_machines,
    ),
}
