# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs every test: plain and headless ones here, those of the window in FreeCAD under Xvfb; sums both up.

Arguments go to pytest, both times.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GUI_TIMEOUT = "1200"
SCREEN = "-screen 0 1400x900x24 -dpi 96 -nolisten tcp"
PREFERENCES = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
<FCParamGroup Name="General"><FCText Name="AutoloadModule">RoboticAMWorkbench</FCText>
<FCBool Name="ShowSplasher" Value="0"/><FCText Name="Language">English</FCText></FCParamGroup>
<FCParamGroup Name="View"><FCBool Name="UseNavigationAnimations" Value="0"/></FCParamGroup>
<FCParamGroup Name="Document"><FCBool Name="RecoveryEnabled" Value="0"/><FCBool Name="AutoSaveEnabled" Value="0"/>
</FCParamGroup><FCParamGroup Name="Mod"><FCParamGroup Name="Start"><FCBool Name="ShowOnStartup" Value="0"/>
<FCBool Name="FirstStart2024" Value="0"/></FCParamGroup></FCParamGroup></FCParamGroup>
<FCParamGroup Name="MainWindow"><FCBool Name="Maximized" Value="1"/></FCParamGroup></FCParamGroup></FCParamGroup>
</FCParameters>
"""


def private_home(folder: Path) -> dict[str, str]:
    """An environment with a fresh FreeCAD profile in the folder and this workbench linked into it."""
    (folder / "Mod").mkdir()
    (folder / "Mod" / "RoboticAM").symlink_to(ROOT)
    (folder / "user.cfg").write_text(PREFERENCES, encoding="utf-8")
    places = {f"XDG_{name}_HOME": str(folder / name.lower()) for name in ("CONFIG", "CACHE", "DATA")}
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700)
    return {
        **os.environ, **places, "XDG_RUNTIME_DIR": str(runtime), "FREECAD_USER_HOME": str(folder),
        # the start page's browser will not run as root otherwise
        "QTWEBENGINE_DISABLE_SANDBOX": "1", "LIBGL_ALWAYS_SOFTWARE": "1", "QT_QPA_PLATFORM": "xcb",
        "PYTHONDONTWRITEBYTECODE": "1", "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
    }


def watched(command: list[str], env: dict[str, str]) -> tuple[int, str]:
    """Run a command, pass its output on as it comes, and return status and output."""
    process = subprocess.Popen(
        command, cwd=ROOT, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        errors="replace",
    )
    lines = []
    assert process.stdout is not None
    for line in process.stdout:
        lines.append(line)
        print(line, end="", flush=True)
    return process.wait(), "".join(lines)


def counts(text: str) -> dict[str, int]:
    """Passed, failed and skipped of the last summary line of pytest."""
    found = {"passed": 0, "failed": 0, "skipped": 0}
    summaries = [line for line in text.splitlines() if re.search(r"\d+ (passed|failed|error|skipped).* in [\d.]+s", line)]
    for number, word in re.findall(r"(\d+) (passed|failed|errors?|skipped)", summaries[-1] if summaries else ""):
        found["failed" if word.startswith("error") else word] += int(number)
    return found


def run_window_tests(arguments: list[str]) -> tuple[int, str]:
    """The tests of tests/gui in FreeCAD's main window."""
    freecad = shutil.which("freecad") or shutil.which("FreeCAD")
    if not freecad or not shutil.which("xvfb-run"):
        print("freecad-am: no freecad or no xvfb-run: the tests of the window are NOT run", flush=True)
        return 1, ""
    with tempfile.TemporaryDirectory() as folder:
        env = private_home(Path(folder))
        env["PYTEST_ARGUMENTS"] = shlex.join(arguments or ["tests/gui"])
        env.pop("VIRTUAL_ENV", None)
        window = ["xvfb-run", "-a", "-s", SCREEN, "timeout", "-k", "5", GUI_TIMEOUT]
        return watched([*window, freecad, str(ROOT / "tests" / "gui_runner.py")], env)


def main() -> int:
    arguments = sys.argv[1:]
    if not arguments or any("posts" in word for word in arguments):
        sys.path.insert(0, str(ROOT))
        from tests.posts import interpreters

        interpreters.provide()
    with tempfile.TemporaryDirectory() as folder:
        print("freecad-am: plain and headless tests", flush=True)
        plain = watched([sys.executable, "-m", "pytest", *arguments, "--ignore=tests/gui"], private_home(Path(folder)))
    results = [plain]
    if not arguments or any("gui" in word for word in arguments):
        print("freecad-am: tests of the window, under Xvfb", flush=True)
        results.append(run_window_tests(arguments))
    total = [counts(text) for _, text in results]
    summed = {word: sum(part[word] for part in total) for word in ("passed", "failed", "skipped")}
    failed = summed["failed"] + sum(status != 0 and not part["failed"] for (status, _), part in zip(results, total))
    print(f"total: {summed['passed']} passed, {failed} failed, {summed['skipped']} skipped", flush=True)
    return 0 if failed == 0 and summed["passed"] else 1


if __name__ == "__main__":
    sys.exit(main())
