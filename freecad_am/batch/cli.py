# SPDX-License-Identifier: LGPL-2.1-or-later
"""The headless commands: plan, export, batch, inspect, check, place, machines.

What a command needs is imported when it runs: starting is most of the time of a small job, and a
slip on the command line should be reported at once.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Any

SUCCESS, OUR_FAULT, BAD_INPUT, INFEASIBLE, INTERRUPTED = 0, 1, 2, 3, 130
SHAPES = ("plan", "export", "inspect", "place")  # commands that read shapes


def main(argv: list[str]) -> int:
    """Run one command; the exit status. Messages go to stderr, results to stdout.

    A command that reads shapes runs in a child process, which may crash.
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
            return SUCCESS  # the reader has closed the pipe, which is its decision
        except Exception as error:
            # modules of FreeCAD 1.0 that are interrupted while they are imported raise something else, or end up empty
            return _interrupted(session) if session.interrupted else _failed(error, session)


def _run(argv: list[str], session: Any) -> int:
    from freecad_am.batch.arguments import command_parsers
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
        f"error[INTERNAL] {type(error).__name__}: {what}; this is our fault, please report it with the job "
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
        options.document, options.output, tuple(options.object), session, options.wires
    )
    _tell_paths(paths, session)
    return SUCCESS


def _batch(options: Any, session: Any) -> int:
    from freecad_am.batch.rows import rows

    if options.scheduler and options.jobs is not None:
        from freecad_am.core.issues import InputError

        raise InputError(
            "USAGE",
            "freecad-am batch",
            "-j sets the number of local rows, and --scheduler plans on a cluster, whose workers "
            "set their own number; remove one option",
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
    os._exit(status)  # FreeCAD takes its time to tear down what the end of the process frees anyway
