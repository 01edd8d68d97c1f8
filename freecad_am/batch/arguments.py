# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line of the headless commands, by subparsers of argparse."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import NoReturn

from ..core.issues import InputError

PROGRAM = "freecad-am"


class Parser(argparse.ArgumentParser):
    """A parser that raises its errors as errors of user input, with the help command to use."""

    def error(self, message: str) -> NoReturn:
        """Raise InputError USAGE."""
        raise InputError("USAGE", self.prog, "{}; try {} --help", message, self.prog)


def command_parsers() -> tuple[Parser, dict[str, Parser]]:
    """Return the parser of the whole command line, and the commands' parsers by name.

    Help is not an action of the parsers: the session prints it, with escapes where the terminal
    needs them.
    """
    command_line_parser = Parser(prog=PROGRAM, allow_abbrev=False, add_help=False)
    command_line_parser.usage = f"{PROGRAM} COMMAND"
    command_line_parser.epilog = (
        f"demo, test, bench and docs: see the README; {PROGRAM} COMMAND --help tells the rest"
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
    parser.add_argument("--no-page", action="store_true", help="leave report.html out")


def _add_place(parser: Parser) -> None:
    parser.add_argument("job", metavar="JOB.yaml")


def _add_export(parser: Parser) -> None:
    parser.add_argument("document", metavar="DOC.FCStd")
    parser.add_argument(
        "--object", metavar="NAME", nargs="+", action="extend", default=[], help="Name or Label"
    )
    parser.add_argument(
        "--wires", choices=("step", "dxf"), default="", help="write paths as wires, not programs"
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
    parser.add_argument(
        "--cell", metavar="FILE", required=True, help="a job, or a cell in a file of its own"
    )
    parser.add_argument(
        "--post",
        metavar="NAME",
        help="the post that reads it; default: the post of the job or of the machine",
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
        "--resume", action="store_true", help="keep the rows that an earlier run completed"
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="check all rows, and plan none of them"
    )


def _add_machines(parser: Parser) -> None:
    parser.add_argument(
        "machine", metavar="NAME", nargs="?", help="a machine of the list, or a machine file"
    )
    forms = parser.add_mutually_exclusive_group()
    for option, form, words in (
        ("--urdf", "urdf", "write it as URDF, without shapes"),
        ("--dh", "dh", "write its table of Denavit and Hartenberg, in mm and degrees"),
        ("--modified-dh", "modified-dh", "the same by Craig"),
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
    """The number of processes that a user asks for. argparse names the option in its error."""
    if not text.isdecimal() or not 1 <= int(text) <= 256:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes from 1 to 256")
    return int(text)


# for each command: its purpose, whether it writes outputs, and the function that adds its arguments
COMMANDS: dict[str, tuple[str, bool, Callable[[Parser], None]]] = {
    "plan": ("plan one job, from part to programs", True, _add_plan),
    "export": ("recompute a saved document and write its programs", True, _add_export),
    "batch": ("plan one job per row of a table of job keys", True, _add_batch),
    "inspect": ("compare measured points with the plan", True, _add_inspect),
    "check": ("drive a program that was edited, or written elsewhere, in a cell", True, _add_check),
    "place": (
        "find feasible positions of the part, and the best pose in its cell",
        True,
        _add_place,
    ),
    "machines": (
        "list the known machines, or write one as URDF or as a table",
        False,
        _add_machines,
    ),
}
