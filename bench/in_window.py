# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a measuring script in FreeCAD's window under Xvfb, and what such a script begins and ends with.

The script is told by FRAMES_TO where to write what it finds, and by FRAMES_OF which checkout it measures.
"""

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


def freecad() -> str | None:
    """FreeCAD with a window, None where it or a screen for it is missing, which is told."""
    found = shutil.which("freecad") or shutil.which("FreeCAD")
    if not found or not shutil.which("xvfb-run"):
        print("bench: no freecad or no xvfb-run: frames are not measured", file=sys.stderr)
        return None
    return found


def measured(program: str, script: Path, folder: Path, longest: int, **more: str) -> Any:
    """What a script finds; `longest`: s it may take; `more`: of its environment."""
    sys.path.insert(0, str(ROOT))
    from tests.window import SCREEN, private_home

    told = folder / "told.json"
    path = os.pathsep.join([str(script.parent), *filter(None, [os.environ.get("PYTHONPATH")])])
    env = {
        **private_home(folder),
        "FRAMES_TO": str(told),
        "FRAMES_OF": str(ROOT),
        "PYTHONPATH": path,
        **more,
    }
    # drawn as users have it: with the cube of views, and with as many threads as the processor has
    for name in ("VIRTUAL_ENV", "BENCH_INSIDE", "LP_NUM_THREADS"):
        env.pop(name, None)
    preferences = folder / "user.cfg"
    without = '<FCBool Name="ShowNaviCube" Value="0"/>'
    preferences.write_text(
        preferences.read_text(encoding="utf-8").replace(without, ""), encoding="utf-8"
    )
    window = ["xvfb-run", "-a", "-s", SCREEN, "timeout", "-k", "5", str(longest)]
    done = subprocess.run(
        [*window, program, str(script)],
        env=env,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    if not told.is_file():
        print(done.stderr[-2000:], file=sys.stderr)
        raise AssertionError("no frames were measured")
    return json.loads(told.read_text(encoding="utf-8"))


def found_by(script: Path, longest: int) -> Any:
    """What a script that needs nothing else finds; an empty list without a window."""
    program = freecad()
    if program is None:
        return []
    with tempfile.TemporaryDirectory() as folder:
        return measured(program, script, Path(folder), longest)


# ---- in the window


def settle(seconds: float) -> None:
    """Let the window come to rest."""
    import FreeCADGui as Gui

    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        Gui.updateGui()
        time.sleep(0.01)


class Drawn:
    """Tells when a view has drawn its scene, and counts it where what it is to show is there."""

    def __init__(self, view, there=lambda: True) -> None:
        from pivy import coin

        self.there, self.count = there, 0
        self.node, self.drawing = coin.SoCallback(), coin.SoGLRenderAction.getClassTypeId()
        self.node.setCallback(self._seen)
        view.getSceneGraph().addChild(self.node)

    def _seen(self, _: object, action) -> None:
        self.count += (
            action.isOfType(self.drawing) and self.there()
        )  # FreeCAD's own is derived from it

    def after(self, act) -> float:
        """ms from before the act until it is drawn."""
        import FreeCADGui as Gui

        start, count = time.perf_counter(), self.count
        act()
        while self.count == count and time.perf_counter() < start + 5.0:
            Gui.updateGui()
        return 1e3 * (time.perf_counter() - start)


def begin(measure: Callable[[], Any]) -> None:
    """Measure once the window is there, write what is found, end FreeCAD; nothing outside of FreeCAD."""
    if "FreeCAD" in sys.modules:
        from PySide import QtCore

        QtCore.QTimer.singleShot(0, lambda: _go(measure))


def _go(measure: Callable[[], Any]) -> None:
    code = 1
    try:
        sys.path.insert(0, os.environ["FRAMES_OF"])
        found = measure()
        with open(os.environ["FRAMES_TO"], "w", encoding="utf-8") as file:
            json.dump(found, file)
        code = 0
    except BaseException:
        print(traceback.format_exc(), file=sys.__stderr__)
    finally:
        if sys.__stderr__ is not None:
            sys.__stderr__.flush()
        os._exit(code)
