# SPDX-License-Identifier: LGPL-2.1-or-later
"""The runner itself: what it makes of tests of the window that fail, and of a FreeCAD that crashes."""

import shutil

import pytest

from tests import run

ENDED = "{} failed, {} passed in 9.00s\n"
CRASHED = "Fatal Python error: Segmentation fault\n"


@pytest.fixture
def windows(monkeypatch):
    """Each item is what one FreeCAD does: status, output, tests that failed."""
    waiting, asked = [], []

    def in_window(freecad, arguments):
        asked.append(arguments)
        return waiting.pop(0)

    monkeypatch.setattr(run, "in_window", in_window)
    monkeypatch.setattr(shutil, "which", lambda name: name)
    return waiting, asked


@pytest.mark.parametrize(
    ("first", "second", "status", "failed", "passed"),
    [
        ((0, "7 passed in 9.00s", []), None, 0, 0, 7),
        ((1, ENDED.format(2, 5), ["a", "b"]), (0, "2 passed in 1.00s", []), 0, 0, 7),
        ((1, ENDED.format(2, 5), ["a", "b"]), (1, ENDED.format(1, 1), ["b"]), 1, 1, 6),
        ((1, ENDED.format(2, 5), ["a", "b"]), (0, "1 passed, 1 skipped in 1.00s", []), 1, 1, 6),
        ((1, ENDED.format(2, 5), ["a", "b"]), (1, CRASHED, []), 1, 2, 5),
        ((1, ENDED.format(9, 5), list("abcdefghi")), None, 1, 9, 5),
        ((1, CRASHED, ["a"]), None, 1, 0, 0),
        ((139, CRASHED, ["a"]), None, 139, 0, 0),
    ],
    ids=["sound", "second", "again", "skipped", "crash then", "too many", "crash", "crash by its status"],
)
def test_few_that_failed_are_run_once_more(windows, first, second, status, failed, passed):
    waiting, asked = windows
    waiting += [one for one in (first, second) if one is not None]
    found, text = run.run_window_tests(["tests/gui"])
    told = run.counts(text)
    assert (found, told["failed"], told["passed"], waiting) == (status, failed, passed, [])
    assert asked == [["tests/gui"], *([first[2]] if second is not None else [])]


def test_options_of_pytest_are_its_own(windows):
    """With -x the first run is no whole one."""
    waiting, asked = windows
    waiting.append((1, ENDED.format(1, 3), ["a"]))
    assert run.run_window_tests(["-x", "tests/gui"])[0] == 1 and len(asked) == 1
