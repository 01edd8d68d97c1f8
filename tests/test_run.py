# SPDX-License-Identifier: LGPL-2.1-or-later
"""The runner itself: what it makes of tests of the window that fail, and of a FreeCAD that crashes."""

import os
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from tests import conftest, run, run_parts

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
    ids=[
        "sound",
        "second",
        "again",
        "skipped",
        "crash then",
        "too many",
        "crash",
        "crash by its status",
    ],
)
def test_few_that_failed_are_run_once_more(windows, first, second, status, failed, passed):
    waiting, asked = windows
    waiting += [one for one in (first, second) if one is not None]
    found, text = run.run_window_tests(["tests/gui"])
    told = run.counts(text)
    assert (found, told["failed"], told["passed"], waiting) == (status, failed, passed, [])
    assert asked == [["tests/gui"], *([first[2]] if second is not None else [])]


QUIET = "..s..F.. [ 50%]\n....s... [100%]\n"


@pytest.mark.parametrize(
    ("text", "counted"),
    [
        (QUIET, (13, 1, 2)),
        (QUIET + "=== FAILURES ===\nE   assert 1 == 2\n", (13, 1, 2)),
        (QUIET + "3 passed, 1 skipped in 2.00s\n", (3, 0, 1)),
        (QUIET.splitlines()[0] + "\n" + CRASHED, (0, 0, 0)),
    ],
    ids=["quiet", "quiet with a failure", "with a summary", "crashed on the way"],
)
def test_tests_are_counted_without_a_summary_too(text, counted):
    """`-q` beside the one of the settings takes pytest's last line away."""
    assert tuple(run.counts(text).values()) == counted


def test_options_of_pytest_are_its_own(windows):
    """With -x the first run is not a whole one."""
    waiting, asked = windows
    waiting.append((1, ENDED.format(1, 3), ["a"]))
    assert run.run_window_tests(["-x", "tests/gui"])[0] == 1 and len(asked) == 1


def test_long_ones_leave_the_second_try(windows):
    waiting, asked = windows
    waiting += [(1, ENDED.format(1, 3), ["a"]), (0, "1 passed in 9.00s", [])]
    words = [
        "--long",
        "tests/gui",
        "--ignore=tests/gui/test_flow.py",
    ]  # as the part has that takes the rest
    assert run.run_window_tests(words)[0] == 0 and asked == [words, ["a"]]


LONG = """\
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
    """What pytest does with a file of tests beside our conftest.py."""
    (folder / "conftest.py").write_text(
        (Path(__file__).parent / "conftest.py")
        .read_text(encoding="utf-8")
        .replace("Path(__file__).resolve().parent.parent", f"Path({str(run.ROOT)!r})"),
        encoding="utf-8",
    )
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
        env={name: value for name, value in os.environ.items() if name != "TEST_TIMES"},
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
    done = pytest_of(tmp_path, LONG, words)
    assert done.returncode == 0 and ran in done.stdout.splitlines()[-1], done.stdout


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


@pytest.mark.parametrize(
    ("status", "text", "told"),
    [
        (1, CRASHED, "FreeCAD ended with status 1 at tests/gui/test_a.py::test_b"),
        (
            run.TOO_LONG,
            "...",
            f"FreeCAD was stopped after {run.WINDOW_TIMEOUT} s at tests/gui/test_a.py::test_b",
        ),
        (1, ENDED.format(2, 5), ""),
        (0, "7 passed in 9.00s", ""),
    ],
    ids=["crash", "too long", "failed", "sound"],
)
def test_an_end_without_a_summary_is_told_with_the_test_at_hand(
    monkeypatch, capsys, status, text, told
):
    def watched(command, env):
        Path(env["LAST_TEST"]).write_text("tests/gui/test_a.py::test_b", encoding="utf-8")
        return status, text

    monkeypatch.setattr(run, "watched", watched)
    ended, found, failed = run.in_window("freecad", ["tests/gui"])
    assert (ended, found[: len(text)], failed) == (status, text, [])
    assert capsys.readouterr().out.strip().removeprefix("freecad-am: ") == told
    why, _, at = told.partition(" at ")
    assert run_parts.failures(found) == ({at: [f"{why} here"]} if told else {})


@pytest.fixture
def parts(monkeypatch):
    """Runs the runner with parts of its own: (status, text) each; its exit status."""

    def ran(*ends):
        made = [
            run_parts.Part(f"part {number}", lambda end=end: end) for number, end in enumerate(ends)
        ]
        monkeypatch.setattr(run, "all_parts", lambda arguments: made)
        monkeypatch.setattr(
            run, "compile_modules", lambda: None
        )  # they are, and looking at each takes a second and a half
        return run.main()

    return ran


@pytest.mark.parametrize(
    ("ends", "status", "total"),
    [
        (
            [(0, "3 passed in 1.00s"), (0, "2 passed, 1 skipped in 2.00s")],
            0,
            "5 passed, 0 failed, 1 skipped",
        ),
        (
            [(1, "1 failed, 3 passed in 1.00s"), (0, "2 passed in 2.00s")],
            1,
            "5 passed, 1 failed, 0 skipped",
        ),
        ([(0, "3 passed in 1.00s"), (139, CRASHED)], 1, "3 passed, 1 failed, 0 skipped"),
        ([(run.TOO_LONG, "...."), (0, "3 passed in 1.00s")], 1, "3 passed, 1 failed, 0 skipped"),
        (
            [(0, "3 passed in 1.00s"), (run.NO_TESTS, "4 deselected in 1.00s")],
            0,
            "3 passed, 0 failed, 0 skipped",
        ),
        ([(run.NO_TESTS, ""), (run.NO_TESTS, "")], 1, "0 passed, 0 failed, 0 skipped"),
    ],
    ids=["sound", "failed", "crash", "too long", "none in one", "none"],
)
def test_the_last_line_sums_up_all_parts(parts, capsys, ends, status, total):
    assert parts(*ends) == status
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == f"total: {total}"
    assert [line.split("s  ")[-1] for line in lines if "  part " in line] == ["part 0", "part 1"]


BROKEN = """\
import pytest

@pytest.mark.parametrize("size", [1, 2])
def test_a(size):
    assert size == 1, "one\\ntwo"

@pytest.fixture
def cup():
    raise OSError("no cup")

def test_b(cup):
    pass
"""


def test_the_end_names_what_failed_and_why(tmp_path, parts, capsys):
    """All that may be seen of a run are its last lines."""
    (tmp_path / "conftest.py").write_text(
        (Path(__file__).parent / "conftest.py")
        .read_text(encoding="utf-8")
        .replace("Path(__file__).resolve().parent.parent", f"Path({str(run.ROOT)!r})"),
        encoding="utf-8",
    )
    (tmp_path / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    (tmp_path / "test_it.py").write_text(BROKEN, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "."],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env={name: value for name, value in os.environ.items() if name != "TEST_TIMES"},
    )
    killed = "freecad-am: tests in FreeCAD 1.0\n" + "a line\n" * 20 + "... [ 3%]\nKilled\n"
    assert parts((1, done.stdout), (0, "2 passed in 1.00s"), (137, killed)) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "total: 3 passed, 3 failed, 0 skipped"
    last = lines[lines.index(next(line for line in lines if line.startswith("failed: "))) : -1]
    assert [line for line in last if not line.startswith("    ")] == [
        "failed: test_it.py::test_a[2]  [part 0]",
        "failed: test_it.py::test_b  [part 0]",
        "failed: ended with status 137  [part 2]",
    ]
    assert last[1].startswith("    ") and last[1].endswith("test_it.py:5") and "      two" in last
    assert any("OSError: no cup" in line for line in last) and last[-1] == "    Killed"
    assert last.count("    a line") == run_parts.LAST - 1


def test_of_a_test_that_failed_twice_the_end_tells_why(windows, monkeypatch, capsys):
    waiting, _ = windows
    first = run_parts.told_of({"a": ["late"], "b": ["broken"]}) + ENDED.format(2, 5)
    waiting += [
        (1, first, ["a", "b"]),
        (1, run_parts.told_of({"b": ["broken again"]}) + ENDED.format(1, 1), ["b"]),
    ]
    monkeypatch.setattr(
        run,
        "all_parts",
        lambda arguments: [run_parts.Part("window", lambda: run.run_window_tests(["a"]))],
    )
    assert run.main() == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-4:-1] == ["failed: b", "    broken again", "tried twice: a b  [window]"]
    assert lines[-1] == "total: 6 passed, 1 failed, 0 skipped"


def test_a_failure_in_another_version_is_told_once_with_its_part(monkeypatch, capsys):
    """Those that passed there at the second try are not told as failed."""
    inside = (
        run_parts.told_of({"a": ["late"]})
        + f"{run_parts.TIMES}\n"
        + run_parts.told_of({"b": ["why"]})
        + ("total: 6 passed, 1 failed, 0 skipped\n")
    )
    monkeypatch.setattr(run, "watched", lambda command, env: (1, inside))
    status, text = run.run_in_version("1.0", [])
    assert (
        status == 1
        and run_parts.failures(text) == {"b": ["why"]}
        and run.counts(text)["passed"] == 6
    )


def test_progress_is_not_told_where_parts_run_side_by_side(tmp_path, monkeypatch, capsys):
    written = "....F.ss [ 31%]\n  #   ##  # \nE   assert 1 == 2\n\n# a comment\n3 passed in 2.00s\n"
    (tmp_path / "text").write_text(written, encoding="utf-8")
    command = ["cat", str(tmp_path / "text")]
    monkeypatch.setattr(run_parts, "PREFIXED", True)
    assert run_parts.watched(command, dict(os.environ)) == (0, written)
    assert capsys.readouterr().out == "E   assert 1 == 2\n\n# a comment\n3 passed in 2.00s\n"
    monkeypatch.setattr(run_parts, "PREFIXED", False)
    assert run_parts.watched(command, dict(os.environ)) == (0, written)
    assert capsys.readouterr().out == written


def test_a_part_that_cannot_run_is_no_sound_end(parts):
    def broken():
        raise OSError("no such program")

    with pytest.raises(OSError, match="no such program"):
        run_parts.run_parts([run_parts.Part("one", broken), run_parts.Part("two", lambda: (0, ""))])


def test_the_parts_have_every_file_of_tests_once(monkeypatch):
    asked = []
    monkeypatch.setattr(run, "run_headless", lambda words: asked.append(words) or (0, ""))
    monkeypatch.setattr(run, "run_window_tests", lambda words: asked.append(words) or (0, ""))
    monkeypatch.setattr("tests.posts.interpreters.provide", lambda: None)
    parts = run.all_parts(["--long"])
    assert (
        len({part.name for part in parts}) == len(parts) == len(run.FOLDERS) + len(run.WINDOWS) + 2
    )
    for part in parts:
        part.run()
    assert all("--long" in words for words in asked)
    for file in (run.ROOT / "tests").rglob("test_*.py"):
        around = [file, *file.parents]
        left_out = [
            {run.ROOT / word.removeprefix("--ignore=") for word in words if "=" in word}
            for words in asked
        ]
        given = [
            {run.ROOT / word for word in words if not word.startswith("--")} for words in asked
        ]
        takes = [
            bool(some & set(around)) and not less & set(around)
            for some, less in zip(given, left_out)
        ]
        assert takes.count(True) == 1, (file, takes)


def test_what_is_named_is_one_part_and_so_is_a_file_of_the_window():
    names = [
        part.name for part in run.all_parts(["-x", "tests/test_run.py", "tests/gui/test_flow.py"])
    ]
    assert names == ["window", "headless"]


def test_parts_run_side_by_side_as_far_as_the_cores_go(monkeypatch):
    """Two windows, which wait much, and something beside them; what finds no room lets a smaller one go first."""
    monkeypatch.setattr("os.sched_getaffinity", lambda process: {0, 1})
    running, seen, order, lock = [], [], [], threading.Lock()

    def one(name, seconds):
        with lock:
            order.append(name)
            running.append(name)
            seen.append(sorted(running))
        time.sleep(seconds)
        with lock:
            running.remove(name)
        return 0, ""

    parts = [
        run_parts.Part(name, lambda name=name, seconds=seconds: one(name, seconds), load)
        for name, load, seconds in (
            ("w1", 0.6, 0.6),
            ("w2", 0.6, 0.9),
            ("h1", 1.0, 0.3),
            ("h2", 1.0, 0.3),
            ("w3", 0.6, 0.1),
        )
    ]
    run_parts.run_parts(parts)
    room = 2.0 + run_parts.MORE
    assert (
        3 * run.WAITING + 2 * run.LEFT <= room < 3 * run.WAITING + 3 * run.LEFT
    )  # three windows and two parts behind them
    assert (
        room < run.LEFT + 2.0
    )  # and without a window, two that may look at the clock have the cores for themselves
    loads = {part.name: part.load for part in parts}
    assert max(sum(loads[name] for name in names) for names in seen) <= 2.0 + run_parts.MORE
    assert ["h1", "w1", "w2"] in seen and sorted(order) == sorted(loads) and not running
    assert all(part.status == 0 for part in parts)


def test_what_runs_in_another_version_exists():
    for word in (*run.HEADLESS_OF_VERSION, *run.LONG_IN_VERSION, *run.WINDOW_OF_VERSION):
        file, _, name = re.sub("^--[a-z]+=", "", word).partition("::")
        assert (run.ROOT / file).exists(), word
        name = name.partition("[")[0]
        assert not name or f"def {name}(" in (run.ROOT / file).read_text(encoding="utf-8"), word


def test_the_time_of_a_test_is_told_while_threads_end():
    ended = threading.Event()

    def come_and_go():
        while not ended.is_set():
            thread = threading.Thread(target=int)
            thread.start()
            thread.join()

    busy = [threading.Thread(target=come_and_go) for _ in range(3)]
    for thread in busy:
        thread.start()
    try:
        times = [conftest.used() for _ in range(400)]
    finally:
        ended.set()
        for thread in busy:
            thread.join()
    assert times == sorted(times) and times[-1] > 0
