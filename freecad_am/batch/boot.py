# SPDX-License-Identifier: LGPL-2.1-or-later
"""Entry point of the launcher: check this Python and run the command in the same process.

If FreeCAD, numpy, scipy or yaml is missing, continue in the next Python of FREECAD_AM_NEXT. The
script runs in plain Python and in freecadcmd. freecadcmd imports a script as a module, and after an
exception may run it again and exit with 0, so no exception may leave this script.
"""

import os
import runpy
import sys

SCRIPT_FOLDER = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(SCRIPT_FOLDER))
NOBODY = 2
OPTIONAL_MODULES = (
    "PyKDL",
    "shapely",
    "matplotlib",
)  # modules that jobs beyond the demo need for programs, solids and plots
SCRIPTS = {
    "test": os.path.join("tests", "run.py"),
    "bench": os.path.join("bench", "run.py"),
    "docs": os.path.join("docs", "reference", "build.py"),
    "row": os.path.join("freecad_am", "batch", "cluster_row.py"),  # for workers of a cluster
}


def arguments():
    """Return the arguments of the script; freecadcmd only passes arguments after a double dash."""
    return (
        sys.argv[sys.argv.index("--") + 1 :] if "FREECAD_AM_HOSTED" in os.environ else sys.argv[1:]
    )


def hand_over(missing, words):
    """Continue in the next Python of the list; return the exit status if no Python is left."""
    next_pythons = os.environ.get("FREECAD_AM_NEXT", "").split("\n")[1:]
    if not next_pythons:
        print(
            f"error[NO_FREECAD] freecad-am: no Python here has FreeCAD, numpy, scipy and yaml (the last one tried lacks "
            f"{', '.join(missing)}); on Debian: apt-get install freecad python3-scipy python3-yaml, else name a Python in "
            "FREECAD_AM_PYTHON",
            file=sys.stderr,
        )
        return NOBODY
    script = os.path.join(SCRIPT_FOLDER, "boot.py")
    environment = {**os.environ, "FREECAD_AM_NEXT": "\n".join(next_pythons)}
    hosted = os.path.basename(next_pythons[0]).lower().startswith("freecad")
    command = [next_pythons[0], script, *(["--"] if hosted else []), *words]
    if hosted:
        environment["FREECAD_AM_HOSTED"] = "1"
    return os.execvpe(next_pythons[0], command, environment)


def run(words):
    """Run a command and return its exit status."""
    sys.path[:] = [ROOT] + [
        entry for entry in sys.path if os.path.abspath(entry or ".") != SCRIPT_FOLDER
    ]
    if sys.pycache_prefix is None and not os.access(SCRIPT_FOLDER, os.W_OK):
        sys.dont_write_bytecode = True
    from freecad_am.batch import host
    from freecad_am.core.one_thread import ENVIRONMENT

    os.environ.update(ENVIRONMENT)  # before importing numpy, and for child processes
    host.provide_home()
    missing = host.missing_modules()
    if missing:
        return hand_over(missing, words)
    if words[:1] == ["ready"]:
        import importlib.util

        return 0 if all(map(importlib.util.find_spec, OPTIONAL_MODULES)) else 1
    if words[:1] and words[0] in SCRIPTS:
        sys.argv[:] = [os.path.join(ROOT, SCRIPTS[words[0]]), *words[1:]]
        runpy.run_path(sys.argv[0], run_name="__main__")
        return 0
    demo = words[:1] == ["demo"]
    if demo:
        example = os.path.join(ROOT, "resources", "examples", "hemisphere.yaml")
        words = ["plan", example, "-o", os.path.join("out", "hemisphere"), *words[1:]]
    from freecad_am.batch import cli

    status = cli.main(words)
    if demo and status == 0:
        folder = words[3]
        print(
            f"freecad-am: open {folder}/report.html in a browser, and {folder}/hemisphere.FCStd in FreeCAD",
            file=sys.stderr,
        )
    return status


def open_streams():
    """Replace streams that the shell has closed (`>&-`) by the null device.

    Otherwise the next opened file would get the descriptor of the stream.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if getattr(sys, name) is None:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free descriptor
            setattr(sys, name, open(number, mode, closefd=False))  # noqa: SIM115 - open until exit


def main():
    """Run the command and exit with its status, skipping FreeCAD's clean-up."""
    status = 1
    open_streams()
    try:
        status = run(arguments())
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except KeyboardInterrupt:
        status = 130
    except BaseException:  # freecadcmd would run the script again
        import traceback

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


if __name__ in (
    "__main__",
    "boot",
):  # run as a script; freecadcmd imports scripts under their name, without the package
    main()
