# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes FreeCAD importable in whatever Python runs the tests, and skips GUI tests where there is no window."""

import gc
import os
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

# xdist gives its workers the path of the process that started them, in PYTHONPATH too, which commands would inherit
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.pop("PYTHONPATH", None)
module_path = os.environ.get("FREECAD_MODULE_PATH", "").split(os.pathsep)  # tests/gui_runner.py
sys.path += [folder for folder in module_path if folder and folder not in sys.path]

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

import FreeCAD  # noqa: E402

if (
    not FreeCAD.GuiUp
):  # as commands have it (freecad_am/batch/boot.py): a tenth of the time of what is computed here
    gc.set_threshold(300_000, 50, 50)

REASON_LINES, REASON_WIDTH = 6, 220  # of a failed test in the summary
SLOWEST_FILES, LONG_RUN_S = 25, 60.0  # files are listed where the tests take longer


def pytest_addoption(parser):
    parser.addoption(
        "--long", action="store_true", help="run what is marked as long too (docs/testing.md)"
    )


def covering(variants):
    """Names of some variants, in which each value of each parameter is: first those of which every value is new."""
    seen, chosen = set(), []
    for ask in (all, any):
        for item in variants:
            values = {(name, id(value)) for name, value in item.callspec.params.items()}
            if item.nodeid not in chosen and ask(value not in seen for value in values):
                chosen.append(item.nodeid)
                seen |= values
    return chosen


def rest_of_variants(items):
    """Names of the variants of tests marked `always` that count as long: all but the named ones, or, without names, all but
    as many as have each value of each parameter."""
    variants, spared = {}, set()
    for item in items:
        if item.get_closest_marker("always"):
            variants.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for test, of_one in variants.items():
        names = of_one[0].get_closest_marker("always").args
        stay = (
            [item.nodeid for item in of_one if item.callspec.id in names]
            if names
            else covering(of_one)
        )
        if names and len(of_one) > 1 and len(stay) < len(names):
            raise pytest.UsageError(f"{test} has not all of the variants {names}")
        spared.update(item.nodeid for item in of_one if item.nodeid not in stay)
    return spared


def pytest_collection_modifyitems(config, items):
    named = tuple(
        word for word in config.args if "::" in word
    )  # one that is named runs in any case
    spared = rest_of_variants(items)
    long = [item for item in items if item.get_closest_marker("long") or item.nodeid in spared]
    long = [item for item in long if not item.nodeid.startswith(named)]
    if long and not config.option.long:
        config.hook.pytest_deselected(items=long)
        items[:] = [item for item in items if item not in long]
    for item in items:
        if item.get_closest_marker("gui") and not FreeCAD.GuiUp:
            item.add_marker(
                pytest.mark.skip(
                    reason="no FreeCAD main window: ./freecad-am test opens one under Xvfb"
                )
            )


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes():
    """Start workers in the locale of the user: importing FreeCAD sets C for processes that are started."""
    for name in ("LANG", "LC_ALL"):
        if name in os.environ:
            os.putenv(name, os.environ[name])
        else:
            os.unsetenv(name)


@pytest.hookimpl(optionalhook=True, tryfirst=True)
def pytest_handlecrashitem():
    """A crash is a failure: no plugin runs the test once more."""
    return True


def print_slowest_files(terminalreporter):
    """Print the time of the slowest files of tests, with what they share, where they take long."""
    seconds = Counter()
    for reports in terminalreporter.stats.values():
        for report in reports:
            if hasattr(report, "duration") and hasattr(report, "nodeid"):
                seconds[report.nodeid.partition("::")[0]] += report.duration
    if sum(seconds.values()) < LONG_RUN_S:
        return
    terminalreporter.write_line(f"slowest files of {sum(seconds.values()):.0f} s:")
    for name, duration in seconds.most_common(SLOWEST_FILES):
        terminalreporter.write_line(f"{duration:8.0f} s {name}")


def pytest_terminal_summary(terminalreporter):
    """Print the slowest files, and the failures and totals that tests/run.py sums up."""
    print_slowest_files(terminalreporter)
    stats = terminalreporter.stats
    failed = [*stats.get("failed", ()), *stats.get("error", ())]
    for report in failed:
        crash = getattr(report.longrepr, "reprcrash", None)
        lines = str(report.longrepr).splitlines()[-REASON_LINES:]
        if crash:
            lines = [f"{crash.path}:{crash.lineno}", *crash.message.splitlines()][:REASON_LINES]
        reason = "".join(f"\n    {line[:REASON_WIDTH]}" for line in lines)
        terminalreporter.write_line(f"failed: {report.nodeid}{reason}")
    passed, skipped = (len(stats.get(outcome, ())) for outcome in ("passed", "skipped"))
    terminalreporter.write_line(f"total: {passed} passed, {len(failed)} failed, {skipped} skipped")


@pytest.fixture
def doc():
    """An empty document, closed afterwards."""
    document = FreeCAD.newDocument("Test")
    name = document.Name
    yield document
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


@pytest.fixture
def no_remedies(monkeypatch):
    """What would make an infeasible job feasible is not looked for: it is planned several times over for that."""
    monkeypatch.setattr("freecad_am.objects.joint_path.remedies", lambda *_: [])
    monkeypatch.setattr("freecad_am.api.suit", lambda *_: None)


@pytest.fixture(scope="session")
def root():
    """The top folder of the repository."""
    return ROOT
