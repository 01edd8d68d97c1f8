# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run a measuring script in FreeCAD's window under Xvfb; helpers with which such a script starts
and ends. FRAMES_TO names the file for its results, FRAMES_OF the checkout to measure."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent


def find_freecad() -> str | None:
    """Return FreeCAD with a window, or None with a message if FreeCAD or xvfb-run is missing."""
    program = shutil.which("freecad") or shutil.which("FreeCAD")
    if not program or not shutil.which("xvfb-run"):
        print("bench: no freecad or no xvfb-run: frames are not measured", file=sys.stderr)
        return None
    return program


def measure_in_window(program: str, script: Path, folder: Path, longest: int, **more: str) -> Any:
    """Run a script and return its result; `longest` is its time limit (s), `more` extends its
    environment."""
    sys.path.insert(0, str(ROOT))
    from tests.window import SCREEN, private_home

    result_file = folder / "told.json"
    path = os.pathsep.join([str(script.parent), *filter(None, [os.environ.get("PYTHONPATH")])])
    env = {
        **private_home(folder),
        "FRAMES_TO": str(result_file),
        "FRAMES_OF": str(ROOT),
        "PYTHONPATH": path,
        **more,
    }
    # drawn as users see it: with the navigation cube and as many threads as the processor has
    for name in ("VIRTUAL_ENV", "BENCH_INSIDE", "LP_NUM_THREADS"):
        env.pop(name, None)
    preferences = folder / "user.cfg"
    without = '<FCBool Name="ShowNaviCube" Value="0"/>'
    preferences.write_text(
        preferences.read_text(encoding="utf-8").replace(without, ""), encoding="utf-8"
    )
    window = ["xvfb-run", "-a", "-s", SCREEN, "timeout", "-k", "5", str(longest)]
    process = subprocess.run(
        [*window, program, str(script)],
        env=env,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    if not result_file.is_file():
        print(process.stderr[-2000:], file=sys.stderr)
        raise AssertionError("no frames were measured")
    return json.loads(result_file.read_text(encoding="utf-8"))


def run_script(script: Path, longest: int) -> Any:
    """Return the result of a script without further inputs; an empty list without a window."""
    program = find_freecad()
    if program is None:
        return []
    with tempfile.TemporaryDirectory() as folder:
        return measure_in_window(program, script, Path(folder), longest)


# ---- in the window


def settle(seconds: float) -> None:
    """Process events until the window is idle."""
    import FreeCADGui as Gui

    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        Gui.updateGui()
        time.sleep(0.01)


class Drawn:
    """Detect when a view has drawn its scene, counting a drawing only if `there` returns true."""

    def __init__(self, view, there=lambda: True) -> None:
        from pivy import coin

        self.there, self.count = there, 0
        self.node, self.drawing = coin.SoCallback(), coin.SoGLRenderAction.getClassTypeId()
        self.node.setCallback(self._count_draw)
        view.getSceneGraph().addChild(self.node)

    def _count_draw(self, _: object, action) -> None:
        self.count += (
            action.isOfType(self.drawing) and self.there()
        )  # FreeCAD's render action derives from it

    def after(self, act) -> float:
        """Return ms from the start of an action until the view has drawn it."""
        import FreeCADGui as Gui

        start, count = time.perf_counter(), self.count
        act()
        while self.count == count and time.perf_counter() < start + 5.0:
            Gui.updateGui()
        return 1e3 * (time.perf_counter() - start)


def begin(measure: Callable[[], Any]) -> None:
    """Measure once the window exists, write the result and end FreeCAD; do nothing outside
    FreeCAD."""
    if "FreeCAD" in sys.modules:
        from PySide import QtCore

        QtCore.QTimer.singleShot(0, lambda: _go(measure))


def _go(measure: Callable[[], Any]) -> None:
    code = 1
    try:
        sys.path.insert(0, os.environ["FRAMES_OF"])
        result = measure()
        with open(os.environ["FRAMES_TO"], "w", encoding="utf-8") as file:
            json.dump(result, file)
        code = 0
    except BaseException:
        print(traceback.format_exc(), file=sys.__stderr__)
    finally:
        if sys.__stderr__ is not None:
            sys.__stderr__.flush()
        os._exit(code)
