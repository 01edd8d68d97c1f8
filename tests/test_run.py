# SPDX-License-Identifier: LGPL-2.1-or-later
"""Test the test runner: repeated window tests, crashes, hangs, totals, and the selection of
tests."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests import run
from tests.run import Outcome

SOUND = "total: 7 passed, 0 failed, 0 skipped\n"
CRASHED = "Fatal Python error: Segmentation fault\n"
NAMES = [f"tests/gui/test_flow.py::test_{letter}" for letter in "abcdefghi"]


def summary(passed, *failed, reason="late"):
    lines = "".join(f"failed: {name}\n    {reason}\n" for name in failed)
    return f"{lines}total: {passed} passed, {len(failed)} failed, 0 skipped\n"


@pytest.fixture
def windows(monkeypatch):
    """Return a stub of the window run that yields the given outcomes: status and output."""
    waiting, calls = [], []

    def in_windows(arguments):
        calls.append(arguments)
        return Outcome("window", *waiting.pop(0))

    monkeypatch.setattr(run, "in_windows", in_windows)
    monkeypatch.setattr(run, "freecad", lambda: "freecad")
    return waiting, calls


A, B = NAMES[:2]


@pytest.mark.parametrize(
    ("first", "second", "status", "failed", "passed"),
    [
        ((0, SOUND), None, 0, 0, 7),
        ((1, summary(5, A, B)), (0, summary(2)), 0, 0, 7),
        ((1, summary(5, A, B)), (1, summary(1, B)), 1, 1, 6),
        ((1, summary(5, A, B)), (0, "total: 1 passed, 0 failed, 1 skipped\n"), 1, 1, 6),
        ((1, summary(5, A, B)), (1, CRASHED), 1, 2, 5),
        ((1, summary(5, *NAMES)), None, 1, 9, 5),
        ((1, CRASHED), None, 1, 1, 0),
        ((139, CRASHED), None, 139, 1, 0),
        ((1, summary(5, A, reason=f"worker 'gw0' {run.CRASH} 'a'")), None, 1, 1, 5),
    ],
    ids=[
        "sound",
        "second",
        "again",
        "skipped",
        "crash then",
        "too many",
        "crash",
        "crash by its status",
        "crash of a worker",
    ],
)
def test_few_that_failed_are_run_once_more(windows, first, second, status, failed, passed):
    waiting, calls = windows
    waiting += [outcome for outcome in (first, second) if outcome is not None]
    outcome = run.run_windows(["tests/gui"])
    assert outcome.counts()[:2] == [passed, failed] and not waiting
    assert run.summarize([outcome]) == (1 if failed else 0)
    assert bool(outcome.status) == bool(status)
    assert calls == [["tests/gui"], *([[A, B]] if second is not None else [])]


def test_of_a_run_that_stops_early_nothing_is_run_once_more(windows):
    waiting, calls = windows
    waiting.append((1, summary(3, A)))
    assert run.run_windows(["-x", "tests/gui"]).status == 1 and len(calls) == 1


def test_of_a_test_that_failed_twice_the_end_tells_why(windows, capsys):
    waiting, _ = windows
    waiting += [(1, summary(5, A, B)), (1, summary(1, B, reason="broken again"))]
    assert run.summarize([run.run_windows(["tests/gui"])]) == 1
    assert capsys.readouterr().out.splitlines() == [
        run.SUMMARY,
        f"tried twice: {A} {B}  [window]",
        f"failed: {B}  [window]",
        "    broken again",
        "total: 6 passed, 1 failed, 0 skipped",
    ]


@pytest.mark.parametrize(
    ("ends", "status", "total"),
    [
        ([(0, summary(3)), (0, "total: 2 passed, 0 failed, 1 skipped\n")], 0, (5, 0, 1)),
        ([(1, summary(3, A)), (0, summary(2))], 1, (5, 1, 0)),
        ([(0, summary(3)), (139, CRASHED)], 1, (3, 1, 0)),
        ([(124, "...."), (0, summary(3))], 1, (3, 1, 0)),
        ([(0, summary(3)), (run.NO_TESTS, summary(0))], 0, (3, 0, 0)),
        ([(0, summary(3)), (run.UNABLE, "FreeCAD 1.0 is NOT tested\n")], 0, (3, 0, 0)),
        ([(run.NO_TESTS, summary(0)), (run.NO_TESTS, summary(0))], 1, (0, 0, 0)),
    ],
    ids=["sound", "failed", "crash", "too long", "none in one", "no such version", "none"],
)
def test_the_last_line_sums_up_all_runs(capsys, ends, status, total):
    assert run.summarize([Outcome(f"run {k}", *end) for k, end in enumerate(ends)]) == status
    passed, failed, skipped = total
    last_line = capsys.readouterr().out.splitlines()[-1]
    assert last_line == f"total: {passed} passed, {failed} failed, {skipped} skipped"


LONG_TESTS = """\
import pytest

@pytest.mark.long
def test_a():
    pass

def test_b():
    pass
"""


VARIANTS = """\
import pytest

@pytest.mark.parametrize("a", [1, 2, 3])
@pytest.mark.parametrize("b", "xy")
@pytest.mark.always
def test_c(a, b):
    print("ran", a, b)

@pytest.mark.parametrize("a", [1, 2, 3])
@pytest.mark.always("2")
def test_d(a):
    print("ran", a)
"""


def pytest_of(folder, text, words):
    """Run pytest on a file of tests next to this project's conftest.py."""
    conftest = (Path(__file__).parent / "conftest.py").read_text(encoding="utf-8")
    conftest = conftest.replace(
        "Path(__file__).resolve().parent.parent", f"Path({str(run.ROOT)!r})"
    )
    (folder / "conftest.py").write_text(conftest, encoding="utf-8")
    (folder / "pytest.ini").write_text(
        "[pytest]\nmarkers =\n  long: longer\n  always: some\n", encoding="utf-8"
    )
    (folder / "test_it.py").write_text(text, encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={
            **{name: value for name, value in os.environ.items() if "PYTEST" not in name},
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        },
    )


@pytest.mark.parametrize(
    ("words", "ran"),
    [
        (["."], "1 passed, 1 deselected"),
        (["--long", "."], "2 passed"),
        (["test_it.py::test_a"], "1 passed"),
    ],
    ids=["always", "long", "named"],
)
def test_long_ones_run_where_they_are_asked_for(tmp_path, words, ran):
    process = pytest_of(tmp_path, LONG_TESTS, words)
    assert process.returncode == 0 and ran in process.stdout.splitlines()[-1], process.stdout


def test_of_the_variants_each_value_runs_always_and_the_rest_with_the_long_ones(tmp_path):
    always = pytest_of(tmp_path, VARIANTS, ["-s", "."]).stdout
    crossed = re.findall(r"ran (\d) (\w)", always)
    assert (
        len(crossed) == 3
        and {a for a, _ in crossed} == {"1", "2", "3"}
        and {b for _, b in crossed} == {"x", "y"}
    )
    assert re.findall(r"ran (\d)$", always, re.MULTILINE) == ["2"]
    assert "9 passed" in pytest_of(tmp_path, VARIANTS, ["--long", "."]).stdout
    assert "1 passed" in pytest_of(tmp_path, VARIANTS, ["test_it.py::test_d[3]"]).stdout
    wrong = pytest_of(tmp_path, VARIANTS.replace('"2"', '"4"'), ["."])
    assert wrong.returncode and "has not all of the variants" in wrong.stdout + wrong.stderr


BROKEN = """\
import os
import time
import pytest

@pytest.mark.parametrize("size", [1, 2])
def test_a(size):
    assert size == 1, "one\\ntwo"

@pytest.fixture
def cup():
    raise OSError("no cup")

def test_b(cup):
    pass

def test_crash():
    os.abort()

def test_hang():
    time.sleep(60)

def test_last():
    pass
"""


def test_the_end_names_what_failed_crashed_or_hung_and_why(tmp_path, capsys):
    """A crashed or hanging worker is replaced, and the tests after it run."""
    workers = [*run.PLUGINS, "-n", "1", "--timeout=5", "--timeout-method=thread", "."]
    process = pytest_of(tmp_path, BROKEN, workers)
    outcome = Outcome("headless", process.returncode, process.stdout)
    assert run.summarize([outcome]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "total: 2 passed, 4 failed, 0 skipped", process.stdout + process.stderr
    failed = {line[8:] for line in lines if line.startswith("failed: ")}
    names = {"test_a[2]", "test_b", "test_crash", "test_hang"}
    assert failed == {f"test_it.py::{name}  [headless]" for name in names}
    reasons = outcome.failures()
    assert reasons["test_it.py::test_a[2]"][0].endswith("test_it.py:7")
    assert "  two" in reasons["test_it.py::test_a[2]"]
    assert any("OSError: no cup" in line for line in reasons["test_it.py::test_b"])
    for name in ("test_crash", "test_hang"):
        assert run.CRASH in reasons[f"test_it.py::{name}"][0]


def test_a_run_that_ends_without_totals_is_a_failure_with_its_last_lines(capsys):
    killed = "a line\n" * 20 + "... [ 3%]\nKilled\n"
    assert run.summarize([Outcome("headless", 137, killed)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[1] == "failed: ended with status 137  [headless]"
    assert lines[-2] == "    Killed" and lines.count("    a line") == 6


def test_a_failure_in_another_version_is_told_once_with_its_part(monkeypatch):
    """The summary does not report tests that pass in the other version at the second try."""
    inside = summary(5, A) + f"{run.SUMMARY}\n" + summary(6, B, reason="why")
    monkeypatch.setattr(run, "stream", lambda name, command, env: Outcome(name, 1, inside))
    outcome = run.run_in_version("1.0", [])
    assert (outcome.status, outcome.failures(), outcome.counts()) == (1, {B: ["why"]}, [6, 1, 0])


def test_output_is_shown_as_it_comes_after_the_name_of_its_run(capsys):
    outcome = run.stream("headless", ["printf", "a\\nb\\n"], dict(os.environ))
    assert (outcome.status, outcome.text) == (0, "a\nb\n")
    assert capsys.readouterr().out.splitlines()[:2] == ["headless     | a", "headless     | b"]


@pytest.mark.parametrize(
    ("arguments", "headless", "window"),
    [
        ([], [], ["tests/gui"]),
        (["--long"], ["--long"], ["--long", "tests/gui"]),
        (["tests/core"], ["tests/core"], None),
        (["tests/gui/test_flow.py"], None, ["tests/gui/test_flow.py"]),
        (["-x", "tests/test_run.py", A], ["-x", "tests/test_run.py"], ["-x", A]),
        (["tests"], ["tests"], ["tests/gui"]),
    ],
)
def test_each_test_runs_in_the_window_or_without(arguments, headless, window):
    assert run.split_arguments(arguments) == (headless, window)


def test_what_runs_in_another_version_exists():
    for word in (*run.HEADLESS_OF_VERSION, *run.WINDOW_OF_VERSION):
        file, _, name = word.removeprefix("--deselect=").partition("::")
        assert (run.ROOT / file).exists(), word
        name = name.partition("[")[0]
        assert not name or f"def {name}(" in (run.ROOT / file).read_text(encoding="utf-8"), word
