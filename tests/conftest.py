# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make FreeCAD importable in the Python that runs the tests, and skip tests of the window without
one."""

import gc
import os
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

# xdist passes the module path of its parent process to the workers in PYTHONPATH too; commands that
# the tests start must not inherit it
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.pop("PYTHONPATH", None)
# set by tests/gui_runner.py
module_path = os.environ.get("FREECAD_MODULE_PATH", "").split(os.pathsep)
sys.path += [folder for folder in module_path if folder and folder not in sys.path]

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

import FreeCAD  # noqa: E402

if (
    not FreeCAD.GuiUp
):  # as the commands do (freecad_am/batch/boot.py): collecting less often saves a tenth of the time
    gc.set_threshold(300_000, 50, 50)

REASON_LINES, REASON_WIDTH = 6, 220  # limits of a failed test's reason in the summary
SLOWEST_FILES, LONG_RUN_S = 25, 60.0  # a run longer than this lists its slowest files


def pytest_addoption(parser):
    parser.addoption(
        "--long", action="store_true", help="run what is marked as long too (docs/testing.md)"
    )


def covering(variants):
    """Return the names of variants that together cover each value of each parameter. Variants with
    new values only are chosen first."""
    covered_values, names = set(), []
    for quantifier in (all, any):
        for item in variants:
            values = {(name, id(value)) for name, value in item.callspec.params.items()}
            if item.nodeid not in names and quantifier(
                value not in covered_values for value in values
            ):
                names.append(item.nodeid)
                covered_values |= values
    return names


def rest_of_variants(items):
    """Return the names of the variants of tests marked `always` that count as long. The mark names
    the variants that stay short; without names, a covering set of variants stays short."""
    variants, spared = {}, set()
    for item in items:
        if item.get_closest_marker("always"):
            variants.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for test, test_variants in variants.items():
        names = test_variants[0].get_closest_marker("always").args
        short_names = (
            [item.nodeid for item in test_variants if item.callspec.id in names]
            if names
            else covering(test_variants)
        )
        if names and len(test_variants) > 1 and len(short_names) < len(names):
            raise pytest.UsageError(f"{test} has not all of the variants {names}")
        spared.update(item.nodeid for item in test_variants if item.nodeid not in short_names)
    return spared


def pytest_collection_modifyitems(config, items):
    named = tuple(
        word for word in config.args if "::" in word
    )  # a test named on the command line runs even if it is long
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
    """Start the workers in the user's locale, because importing FreeCAD sets C for child
    processes."""
    for name in ("LANG", "LC_ALL"):
        if name in os.environ:
            os.putenv(name, os.environ[name])
        else:
            os.unsetenv(name)


@pytest.hookimpl(optionalhook=True, tryfirst=True)
def pytest_handlecrashitem():
    """Count a crash as a failure: no plugin may run the test again."""
    return True


def print_slowest_files(terminalreporter):
    """Print the slowest test files and their times if the run is long."""
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
    """Print the slowest files, then the failures and totals that tests/run.py sums up."""
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
    """Open an empty document and close it after the test."""
    document = FreeCAD.newDocument("Test")
    name = document.Name
    yield document
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


@pytest.fixture
def no_remedies(monkeypatch):
    """Skip the search for remedies of infeasible jobs, which plans a job several times."""
    monkeypatch.setattr("freecad_am.objects.joint_path.remedies", lambda *_: [])
    monkeypatch.setattr("freecad_am.api.suit", lambda *_: None)


@pytest.fixture(scope="session")
def root():
    """Return the top folder of the repository."""
    return ROOT
