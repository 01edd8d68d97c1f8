# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run commands as freecad_am/batch/boot.py does, each in a copy of this process, which has loaded
FreeCAD and all modules. Each request is a line of JSON on stdin: [folder, environment, file for
stdout, file for stderr, words, processor seconds, bytes, own group]; limits of 0 mean none, and the
last entry gives the copy a process group. The answer goes to the descriptor in the first argument:
a line with the number of the copy when it has started, and a line with the exit status (negative
for a signal), processor seconds, and MB of the largest process. This process computes nothing and
has one thread: in a copy of a process that has meshed, OpenCASCADE 7.8 would wait for threads that
are not copied."""

import contextlib
import gc
import importlib
import json
import os
import pkgutil
import resource
import sys
import traceback
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import freecad_am
from freecad_am.batch import cli, host

# what a command imports besides the package's modules; some of it may be missing
EXTERNAL_MODULES = (
    "Part",
    "Mesh",
    "MeshPart",
    "PyKDL",
    "yaml",
    "shapely",
    "matplotlib.backends.backend_svg",
)
NOT_OF_COMMANDS = (
    "freecad_am.gui",
    "freecad_am.batch.boot",
)  # those of a window, and those that start a command


def load_all():
    """Import every module that a command may import; each takes a second otherwise."""
    for name in EXTERNAL_MODULES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    for module in pkgutil.walk_packages(freecad_am.__path__, "freecad_am."):
        if not module.name.startswith(NOT_OF_COMMANDS):
            importlib.import_module(module.name)
    draw_first_chart()


def draw_first_chart():
    """Let matplotlib find its fonts once for all commands, which takes half a second."""
    with contextlib.suppress(ImportError):
        from freecad_am.plots import chart, draw, files

        quantity = chart.Quantity("x", "mm")
        curve = chart.Curve("z", numpy.arange(3.0), numpy.arange(3.0))
        first_chart = chart.Chart("First", quantity, quantity, (curve,))
        files.inline(draw.figure([first_chart], chart.PAGE, 460, 230)[0], first_chart.title)


def be_command(folder, environment, out, err, words, seconds, memory):
    """Run a command and exit."""
    status = 1
    try:
        for kind, limit in ((resource.RLIMIT_CPU, seconds), (resource.RLIMIT_AS, memory)):
            if limit:
                resource.setrlimit(kind, (limit, limit))
        os.environ.clear()
        os.environ.update(environment)
        nothing = os.open(os.devnull, os.O_RDONLY)
        files = [os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC) for name in (out, err)]
        for number, stream in enumerate([nothing, *files]):
            os.dup2(stream, number)
            os.close(stream)
        os.chdir(folder)
        status = cli.main(words)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def main():
    host.find_freecad()
    import FreeCAD  # noqa: F401  before Part

    load_all()
    gc.set_threshold(300_000, 50, 50)  # and no copy may scan the objects that all of them share
    gc.freeze()
    answer = int(sys.argv[1])
    for line in sys.stdin:
        assert len(os.listdir("/proc/self/task")) == 1, "this process is to have one thread"
        *request, own_group = json.loads(line)
        process = os.fork()
        if not process:
            be_command(*request)
        if own_group:
            os.setpgid(process, process)
        os.write(answer, f"{process}\n".encode())
        _, status, used = os.wait4(process, 0)
        seconds, memory = used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3
        os.write(
            answer, f"{os.waitstatus_to_exitcode(status)} {seconds:.3f} {memory:.1f}\n".encode()
        )


if __name__ == "__main__":
    main()
