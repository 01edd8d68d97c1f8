# SPDX-License-Identifier: LGPL-2.1-or-later
"""The headless commands: plan, export, batch, inspect, check, place, machines.

What a command needs is imported when it runs: starting is most of the time of a small job, and a slip on the
command line should be told at once.
"""

from __future__ import annotations

import os
import sys
from typing import Any

DONE, OUR_FAULT, BAD_INPUT, INFEASIBLE, INTERRUPTED = 0, 1, 2, 3, 130
COMMANDS = ("plan", "export", "batch", "inspect", "check", "place", "machines")
SHAPES = ("plan", "export", "inspect", "place")  # commands that read shapes
USAGE = """usage: freecad-am COMMAND

  plan JOB.yaml [-o DIR] [--no-page]                one job: part to programs; DIR is out/<name> beside the job file
  export DOC.FCStd [-o DIR] [--object NAME ...]     recompute a saved document and write its programs; with
                                                    --wires step|dxf its paths as wires instead
  batch TABLE.csv --job JOB.yaml [-o DIR] [-j N]    one plan per row of a table of job keys; --scheduler ADDRESS of a
                                                    Dask cluster, --resume, --dry-run
  inspect JOB.yaml|DOC.FCStd --measured FILE ...    compare measured points with what is planned; -o DIR,
                                                    --set tolerance=0.3 ..., of a document --object NAME
  check PROGRAM ... --cell JOB.yaml|CELL.yaml       drive a program that was edited, or written elsewhere, in a cell;
                                                    -o DIR, --post NAME
  place JOB.yaml [-o DIR]                           where the part can stand: place.csv, place.html, and the best pose
                                                    as a line of YAML for the section cell
  machines [NAME --urdf | --dh | --modified-dh]     list the machines known, or write one as URDF or as a table;
                                                    list some: --maker KUKA --reach '2 m' --payload '20 kg' --post kuka
  demo | test | bench                               see the README
"""


def main(argv: list[str]) -> int:
    """Run one command; the exit status. Messages go to stderr, what was asked for to stdout.

    A command that reads shapes runs in a copy of this process, which may crash.
    """
    from freecad_am.batch import console

    if argv[1:] and argv[0] in SHAPES:
        from freecad_am.batch import supervised

        def say(line: str) -> None:
            print(console.escaped(line), file=sys.stderr)

        return supervised.supervised(lambda: _main(argv), os.path.basename(argv[1]) or argv[1], say)
    return _main(argv)


def _main(argv: list[str]) -> int:
    from freecad_am.batch import console

    with console.Session() as session:
        try:
            return _run(argv, session)
        except KeyboardInterrupt:
            return _interrupted(session)
        except BrokenPipeError:
            return DONE  # nobody reads on, which is for the reader to decide
        except Exception as error:
            # modules of FreeCAD 1.0 that are interrupted while they are imported raise something else, or end up empty
            return _interrupted(session) if session.interrupted else _failed(error, session)


def _run(argv: list[str], session: Any) -> int:
    from freecad_am.core.issues import InputError

    if not argv or argv[0] in ("-h", "--help", "help"):
        session.out(USAGE)
        return DONE if argv else BAD_INPUT
    command, words = argv[0], argv[1:]
    for word in argv:
        if not word.isascii() and word != word.encode("utf-8", "replace").decode("utf-8"):
            shown = word.encode("utf-8", "backslashreplace").decode("utf-8")
            raise InputError(
                "USAGE",
                "command line",
                "{!r} holds bytes that are not UTF-8; use a name in UTF-8",
                shown,
            )
    if command not in COMMANDS:
        import difflib

        near = difflib.get_close_matches(command, (*COMMANDS, "demo", "test", "bench", "docs"), n=1)
        hint = f"did you mean {near[0]}?" if near else f"use one of {', '.join(COMMANDS)}"
        raise InputError("USAGE", "command line", "there is no command {!r}; {}", command, hint)
    parser = _parser(command)
    if "-h" in words or "--help" in words:
        session.out(parser.format_help())
        return DONE
    options = parser.parse_args(words)
    status: int = getattr(sys.modules[__name__], f"_{command}")(options, session)
    return status


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


def _parser(command: str) -> Any:
    import argparse

    from freecad_am.core.issues import InputError

    class Parser(argparse.ArgumentParser):
        def error(self, message: str) -> Any:
            raise InputError(
                "USAGE", f"freecad-am {command}", "{}; try freecad-am {} --help", message, command
            )

    parser = Parser(prog=f"freecad-am {command}", allow_abbrev=False, add_help=False)
    if command == "machines":
        _choose_machines(parser)
        return parser
    parser.add_argument("-o", "--output", metavar="DIR", help="folder of the outputs")
    if command == "plan":
        parser.add_argument("job", metavar="JOB.yaml")
        parser.add_argument("--no-page", action="store_true", help="leave report.html out")
    elif command == "place":
        parser.add_argument("job", metavar="JOB.yaml")
    elif command == "export":
        parser.add_argument("document", metavar="DOC.FCStd")
        parser.add_argument(
            "--object", metavar="NAME", nargs="+", action="extend", default=[], help="Name or Label"
        )
        parser.add_argument(
            "--wires",
            choices=("step", "dxf"),
            default="",
            help="write paths as wires instead of programs",
        )
    elif command == "inspect":
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
            "--object",
            metavar="NAME",
            default="",
            help="Name or Label of what was measured, of a document",
        )
    elif command == "check":
        parser.add_argument(
            "program", metavar="PROGRAM", nargs="+", help="the files of a program, or their folder"
        )
        parser.add_argument(
            "--cell", metavar="FILE", required=True, help="a job, or a cell in a file of its own"
        )
        parser.add_argument(
            "--post",
            metavar="NAME",
            help="the post that reads it; else that of the job or of the machine",
        )
    else:
        _choose_rows(parser)
    return parser


def _choose_rows(parser: Any) -> None:
    """The words of `batch`."""
    parser.add_argument("table", metavar="TABLE.csv")
    parser.add_argument("--job", metavar="JOB.yaml", required=True)
    parser.add_argument(
        "-j", "--jobs", metavar="N", type=_count, help="rows planned at the same time, 1 without"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="plan on the workers of this Dask scheduler"
    )
    parser.add_argument(
        "--resume", action="store_true", help="keep the rows that an earlier run has done"
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="look whether rows are refused, and plan none"
    )


def _choose_machines(parser: Any) -> None:
    """The words of `machines`."""
    parser.add_argument(
        "machine", metavar="NAME", nargs="?", help="a machine of the list, or a machine file"
    )
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument(
        "--urdf",
        action="store_const",
        const="urdf",
        dest="form",
        help="write it as URDF, without looks",
    )
    forms.add_argument(
        "--dh",
        action="store_const",
        const="dh",
        dest="form",
        help="write its table of Denavit and Hartenberg, in mm and degrees",
    )
    forms.add_argument(
        "--modified-dh",
        action="store_const",
        const="modified-dh",
        dest="form",
        help="the same by Craig",
    )
    parser.add_argument("--maker", metavar="NAME", help="list those of this maker")
    parser.add_argument("--reach", metavar="LENGTH", help="list those that reach so far at least")
    parser.add_argument(
        "--payload", metavar="MASS", help="list those that are known to carry so much at least"
    )
    parser.add_argument(
        "--post", metavar="NAME", help="list those whose controllers read the programs of this post"
    )


def _count(text: str) -> int:
    import argparse

    if not text.isdecimal() or not 1 <= int(text) <= 256:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes from 1 to 256")
    return int(text)


def _plan(options: Any, session: Any) -> int:
    from freecad_am.batch import run
    from freecad_am.batch.job import job

    read = job.read_job(options.job)
    result = run.run(
        read, options.output or run.default_folder(read), session, page=not options.no_page
    )
    _tell_paths(result.paths, session)
    return result.exit_status


def _tell_paths(paths: list[str], session: Any) -> None:
    from freecad_am.batch.console import escaped

    session.out("".join(f"{escaped(path)}\n" for path in paths))


def _export(options: Any, session: Any) -> int:
    from freecad_am.batch import export

    paths = export.export(
        options.document, options.output, tuple(options.object), session, options.wires
    )
    _tell_paths(paths, session)
    return DONE


def _batch(options: Any, session: Any) -> int:
    from freecad_am.batch.rows import rows

    if options.scheduler and options.jobs is not None:
        from freecad_am.core.issues import InputError

        raise InputError(
            "USAGE",
            "freecad-am batch",
            "-j is of rows on this machine, and --scheduler of those on a "
            "cluster, whose workers have their own number; leave one of them out",
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
    return DONE


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
            "in what form is {!r} to be written? Use --urdf, --dh or --modified-dh",
            options.machine,
        )
    if options.form is not None and options.machine is None:
        raise InputError(
            "USAGE", "freecad-am machines", "--{} of what machine? Give its name", options.form
        )
    wanted = (options.maker, options.reach, options.payload, options.post)
    filtered = any(one is not None for one in wanted)
    if filtered and options.machine is not None:
        raise InputError(
            "USAGE",
            "freecad-am machines",
            "--maker, --reach, --payload and --post choose from the list; leave {!r} out, or them",
            options.machine,
        )
    if options.machine is not None:
        session.out(machines.written(options.machine, options.form))
    else:
        session.out(machines.chosen(*wanted) if filtered else machines.listing())
    return DONE


if __name__ == "__main__":
    status = main(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # FreeCAD takes its time to tear down what the end of the process frees anyway
