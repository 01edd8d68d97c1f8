# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run the named benchmarks, or all; exit with status 1 when a ratio is missed. With `--smallest`
each benchmark runs once at its smallest size and no figure is judged: CI proves in this way that
every benchmark still runs. Peers from the package index are installed into the benchmark's own
environment (.bench-env), which sees the distribution's packages; nothing else uses it."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path

BENCH_FOLDER = Path(__file__).resolve().parent
ENVIRONMENT = BENCH_FOLDER.parent / ".bench-env"
PEERS = (
    "eaik==1.2.2",
    "trimesh==5.2.0",
    "python-fcl==0.7.0.11",
    "ssik==8.2.0",
    "sympy",
    "mpmath",
    "cython",
)  # the last three are dependencies of ssik
# compas_slicer and its imports: it asks for an older numpy, but works with the distribution's
SLICER = (
    "compas_slicer==0.7.0",
    "compas<2",
    "libigl<2.5",
    "networkx<3.2",
    "progressbar2<4.4",
    "python-utils",
    "pyclipper",
    "rdp",
    "imageio",
    "jsonschema",
    "schema",
    "typing_extensions",
)
BENCHMARKS = (
    "arm",
    "collision",
    "filling",
    "infill",
    "kinematics",
    "ladder",
    "load",
    "long_work",
    "paths",
    "planning",
    "positioner",
    "simulation",
    "slicing",
    "surface",
    "threads",
    "walls",
    "whole",
)
SMALLEST_OPTION = "--smallest"
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


def environment_python() -> Path | None:
    """Return the Python of the benchmark's environment, creating and filling it if missing; None
    when that fails."""
    python = ENVIRONMENT / "bin" / "python"
    installed = ENVIRONMENT / "peers.txt"
    if (
        python.exists()
        and installed.exists()
        and installed.read_text(encoding="utf-8").split() == [*PEERS, *SLICER]
    ):
        return python
    print(f"bench: making {ENVIRONMENT.name} with {', '.join(PEERS)}", file=sys.stderr)
    process = subprocess.run(
        [sys.executable, "-m", "venv", "--system-site-packages", str(ENVIRONMENT)], check=False
    )
    if process.returncode == 0:
        # keep the distribution's numpy and scipy: FreeCAD is built against them
        filled = subprocess.run(
            [str(python), "-m", "pip", "install", "-q", "--no-deps", *PEERS], check=False
        )
        if filled.returncode == 0:
            if subprocess.run(
                [str(python), "-m", "pip", "install", "-q", "--no-deps", *SLICER], check=False
            ).returncode:
                print(
                    "bench: compas_slicer could not be installed; its row goes without",
                    file=sys.stderr,
                )
            installed.write_text("\n".join((*PEERS, *SLICER)) + "\n", encoding="utf-8")
            return python
    print("bench: the peers could not be installed; their rows go without", file=sys.stderr)
    return None


def main(words: list[str]) -> int:
    """Run benchmarks, each in its own process, so that the memory of one does not count in the next.

    Parameters
    ----------
    words
        Names of benchmarks, all when there are none, and `--smallest`.

    Returns
    -------
    int
        0, 1 when a ratio is missed or a benchmark fails, 2 for an unknown name.
    """
    if SMALLEST_OPTION in words:
        os.environ["BENCH_SMALLEST"] = "1"  # read by bench/sizes.py
    names = [word for word in words if word != SMALLEST_OPTION]
    for name in names:
        if name not in BENCHMARKS:
            print(
                f"error[USAGE] bench: there is no benchmark {name!r}; use {', '.join(BENCHMARKS)}",
                file=sys.stderr,
            )
            return 2
    if len(names) == 1:
        return _run(names[0])
    return max(
        subprocess.run([sys.executable, __file__, name], check=False).returncode
        for name in names or BENCHMARKS
    )


def _run(name: str) -> int:
    """Print a line per comparison, and before them the load and speed of the machine, which medians
    partly compensate."""
    sys.path[:0] = [str(BENCH_FOLDER.parent), str(BENCH_FOLDER)]
    from freecad_am.batch import host

    import sizes
    from pace import pace

    host.find_freecad()
    busy = f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors"
    print(f"{name} ({busy}, a fixed piece of work in {pace():.2f} ms)", flush=True)
    short = False
    judged = not sizes.is_smallest()
    for row in importlib.import_module(name).run():
        short |= row.short and judged
        print(row.line(judged), flush=True)
    return int(short)


if __name__ == "__main__":
    if "BENCH_INSIDE" not in os.environ:
        python = environment_python()
        inside = {**os.environ, **ONE_THREAD, "BENCH_INSIDE": "1"}
        os.execve(
            python or sys.executable,
            [str(python or sys.executable), __file__, *sys.argv[1:]],
            inside,
        )
    sys.exit(main(sys.argv[1:]))
