# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start FreeCAD's main window under Xvfb as a worker of pytest-xdist, which takes this file for a Python.

xdist talks to its workers through stdin and stdout. FreeCAD prints its banner to stdout, and xvfb-run may close stdin, so
both pipes are passed on as other descriptors, which tests/gui_runner.py uses.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FIRST_PIPE = 20  # the lowest descriptor of a pipe to xdist
SCREEN = "-screen 0 1400x900x24 -dpi 96 -nolisten tcp"
PREFERENCES = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
<FCParamGroup Name="General"><FCText Name="AutoloadModule">RoboticAMWorkbench</FCText>
<FCBool Name="ShowSplasher" Value="0"/><FCText Name="Language">English</FCText></FCParamGroup>
<FCParamGroup Name="View"><FCBool Name="UseNavigationAnimations" Value="0"/><FCBool Name="ShowNaviCube" Value="0"/>
<FCBool Name="CornerCoordSystem" Value="0"/></FCParamGroup>
<FCParamGroup Name="Document"><FCBool Name="RecoveryEnabled" Value="0"/><FCBool Name="AutoSaveEnabled" Value="0"/>
</FCParamGroup><FCParamGroup Name="Mod"><FCParamGroup Name="Start"><FCBool Name="ShowOnStartup" Value="0"/>
<FCBool Name="FirstStart2024" Value="0"/></FCParamGroup></FCParamGroup></FCParamGroup>
<FCParamGroup Name="MainWindow"><FCBool Name="Maximized" Value="1"/></FCParamGroup></FCParamGroup></FCParamGroup>
</FCParameters>
"""


def private_home(folder: Path) -> dict[str, str]:
    """Return an environment with a new FreeCAD profile in the folder, with this workbench linked into it."""
    (folder / "Mod").mkdir()
    (folder / "Mod" / "RoboticAM").symlink_to(ROOT)
    (folder / "user.cfg").write_text(PREFERENCES, encoding="utf-8")
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700)
    return {
        **os.environ,
        **{f"XDG_{name}_HOME": str(folder / name.lower()) for name in ("CONFIG", "CACHE", "DATA")},
        "XDG_RUNTIME_DIR": str(runtime),
        "FREECAD_USER_HOME": str(folder),
        # the start page's browser does not run as root otherwise
        "QTWEBENGINE_DISABLE_SANDBOX": "1",
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "LP_NUM_THREADS": "0",
        "QT_QPA_PLATFORM": "xcb",
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        # otherwise each new home makes its own list of fonts
        "MPLCONFIGDIR": os.environ.get("MPLCONFIGDIR", os.path.expanduser("~/.cache/matplotlib")),
        # several workers run at the same time, and their threads would wait for each other's cores
        "OPENBLAS_NUM_THREADS": os.environ.get("OPENBLAS_NUM_THREADS", "1"),
    }


def freecad() -> str | None:
    """Return the path of FreeCAD, None if FreeCAD or xvfb-run is missing."""
    program = shutil.which("freecad") or shutil.which("FreeCAD")
    return program if shutil.which("xvfb-run") else None


def main() -> int:
    """Run FreeCAD until xdist closes the pipe, and return its exit status."""
    # xvfb-run keeps some of the lowest descriptors for itself
    pipes = tuple(fcntl.fcntl(stream, fcntl.F_DUPFD, FIRST_PIPE) for stream in (0, 1))
    with tempfile.TemporaryDirectory() as folder:
        env = {**private_home(Path(folder)), "WORKER_PIPES": f"{pipes[0]} {pipes[1]}"}
        env.pop("VIRTUAL_ENV", None)
        # with a folder of its own xvfb-run fails if it cannot remove that folder
        screen = ["xvfb-run", "-a", "-f", str(Path(folder) / "Xauthority"), "-s", SCREEN]
        command = [*screen, freecad() or "freecad", str(ROOT / "tests" / "gui_runner.py")]
        return subprocess.run(
            command,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            pass_fds=pipes,
            check=False,
        ).returncode


if __name__ == "__main__":
    sys.exit(main())
