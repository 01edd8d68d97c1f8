# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes FreeCAD importable in whatever Python runs the tests, and skips GUI tests where there is no window."""

import contextlib
import gc
import os
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

import FreeCAD  # noqa: E402

if (
    not FreeCAD.GuiUp
):  # as commands have it (freecad_am/batch/boot.py): a tenth of the time of what is computed here
    gc.set_threshold(300_000, 50, 50)

WHY, LONGEST = 6, 220  # lines of why a test failed, and characters of each


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


def used():
    """s of the processor of this process, of those that it has started, and of theirs that ended."""
    ticks = 0
    for thread in os.listdir("/proc/self/task"):
        started = ""
        with contextlib.suppress(OSError):  # the thread has just ended
            started = Path(f"/proc/self/task/{thread}/children").read_text(encoding="ascii")
        for process in started.split():
            with contextlib.suppress(OSError, ValueError):  # it has just ended
                stat = Path(f"/proc/{process}/stat").read_text(encoding="utf-8", errors="replace")
                ticks += sum(map(int, stat.rpartition(")")[2].split()[11:15]))
    return sum(os.times()[:4]) + ticks / os.sysconf("SC_CLK_TCK")


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    """Adds what a test took, and the fixtures made for it, to the file of TEST_TIMES: s, s of processor, name."""
    file = os.environ.get("TEST_TIMES")
    began, before = time.monotonic(), used() if file else 0.0
    yield
    if file:
        with open(file, "a", encoding="utf-8") as stream:
            stream.write(f"{time.monotonic() - began:.2f}\t{used() - before:.2f}\t{item.nodeid}\n")


def pytest_terminal_summary(terminalreporter):
    """Names what failed and the first lines of why, for the end of tests/run.py, which may be all that is seen of a run."""
    for kind in ("failed", "error"):
        for report in terminalreporter.stats.get(kind, ()):
            crash = getattr(report.longrepr, "reprcrash", None)
            shown = str(report.longrepr).splitlines()[-WHY:]
            if crash:
                shown = [f"{crash.path}:{crash.lineno}", *crash.message.splitlines()][:WHY]
            told = "".join(f"\n    {line[:LONGEST]}" for line in shown)
            terminalreporter.write_line(f"failed: {report.nodeid}{told}")


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
