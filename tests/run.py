# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run the tests with pytest-xdist: headless tests in plain Python, tests of the window in FreeCADs under Xvfb.

Arguments go to pytest; `--long` also runs the tests marked as long (docs/testing.md). `--with-freecad 1.0` as the first
arguments also runs the tests that depend on FreeCAD's version in that version (tests/versions/run.sh).
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.window import freecad, private_home  # noqa: E402

VERSION_SCRIPT = ROOT / "tests" / "versions" / "run.sh"
CORES = len(os.sched_getaffinity(0))
# one more than the cores, because a window waits for more than half of its time
WINDOWS = CORES + 1
NICENESS = 15  # lowers the priority of headless tests, so that no click in a window comes late
TEST_LIMIT_S, LONG_TEST_LIMIT_S = 600, 4 * 3600
RETRIED_TESTS = 8  # if at most this many tests of the window fail, they run again
EXPLAINED_FAILURES = 10  # the summary explains this many failures and only names the others
TESTS_FAILED, NO_TESTS, UNABLE = 1, 5, 77  # exit statuses of pytest and of tests/versions/run.sh
CRASH = "crashed while running"  # xdist's text about a crashed worker
SUMMARY = "freecad-am: summary"
PLUGINS = ("-p", "xdist.plugin", "-p", "pytest_timeout")
# tests that depend on FreeCAD's version; those marked `any_version` run with --long only
HEADLESS_OF_VERSION = (
    *(f"tests/{name}" for name in ("objects", "brep", "kdl", "posts", "interop")),
    "tests/test_package.py",
    *(f"tests/batch/test_{name}.py" for name in ("plan_command", "export_command", "interruption")),
)
WINDOW_OF_VERSION = (
    *(
        f"tests/gui/test_{name}.py"
        for name in ("fields", "long_work", "picking", "reopen", "robust_events", "samples")
    ),
    "tests/gui/test_clicks.py::test_from_a_selected_shape_to_a_program_by_clicks",
    "tests/gui/test_robust.py::test_closed_panels_leave_nothing_behind",
    "tests/gui/test_robust.py::test_a_job_copied_into_another_document[True]",
    "tests/gui/test_robust.py::test_a_document_closed_while_a_panel_is_open",
    *(
        f"--deselect=tests/gui/test_long_work.py::test_cancel_ends_the_work_and_leaves_the_document_as_it_was[{stage}]"
        for stage in ("joints", "wall", "hub")
    ),
)


@dataclass
class Outcome:
    """Hold what one run of pytest printed in its summary (tests/conftest.py)."""

    name: str
    status: int
    text: str

    def counts(self) -> list[int]:
        """Return how many tests passed, failed and were skipped."""
        totals = re.findall(r"^total: (\d+) \w+, (\d+) \w+, (\d+) \w+", self.text, re.MULTILINE)
        passed, failed, skipped = map(int, totals[-1] if totals else (0, 0, 0))
        broken = self.status not in (0, NO_TESTS, UNABLE) and not failed
        return [passed, failed + broken, skipped]

    def failures(self) -> dict[str, list[str]]:
        """Return the failed tests, each with the lines of its reason."""
        matches = re.findall(r"^failed: (.+)\n((?:    .*\n)*)", self.text, re.MULTILINE)
        failures = {name: [line[4:] for line in reason.splitlines()] for name, reason in matches}
        if not failures and self.counts()[1]:
            failures[f"ended with status {self.status}"] = self.text.splitlines()[-8:]
        return failures


def stream(name: str, command: Sequence[str], env: dict[str, str]) -> Outcome:
    """Run a command and print its output while it runs, with the run's name before each line."""
    start = time.monotonic()
    process = subprocess.Popen(
        command,
        cwd=ROOT,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    lines = []
    assert process.stdout is not None
    for line in process.stdout:
        lines.append(line)
        print(f"{name:<12} | {line}", end="", flush=True)
    status = process.wait()
    print(f"{name:<12} | {time.monotonic() - start:.0f} s, status {status}", flush=True)
    return Outcome(name, status, "".join(lines))


def run_pytest(name: str, arguments: Sequence[str], workers: Sequence[str], nice: int) -> Outcome:
    """Run pytest with the given workers of xdist, in a new home."""
    long = "--long" in arguments or any("::" in word for word in arguments)
    limit = LONG_TEST_LIMIT_S if long else TEST_LIMIT_S
    options = [*PLUGINS, f"--timeout={limit}", "--timeout-method=thread", "--durations=10"]
    command = ["nice", "-n", str(nice), sys.executable, "-u", "-m", "pytest", *options]
    with tempfile.TemporaryDirectory() as folder:
        env = private_home(Path(folder))
        # other versions print hundreds of lines about their own modules
        if env.get("FREECAD_AM_VERSION"):
            env["PYTEST_ADDOPTS"] = "--disable-warnings"
        return stream(name, [*command, *workers, *arguments], env)


def run_headless(arguments: Sequence[str]) -> Outcome:
    """Run tests in plain Python, one file at a time on each core."""
    if os.environ.get("FREECAD_AM_VERSION"):
        # golden files already hold the programs equal in all versions
        arguments = [*arguments, "--ignore=tests/posts/test_interpreters.py"]
    elif not paths_of(arguments) or any("posts" in word for word in arguments):
        from tests.posts import interpreters

        interpreters.provide()
    workers = ["-n", str(CORES), "--dist", "loadfile"]
    return run_pytest("headless", [*arguments, "--ignore=tests/gui"], workers, NICENESS)


def run_windows(arguments: Sequence[str]) -> Outcome:
    """Run tests in FreeCAD's main window, and repeat a few failed tests in a new FreeCAD. On a busy
    machine, a click or a key of a test may come too early. A crash always counts as a failure."""
    if freecad() is None:
        return Outcome("window", TESTS_FAILED, "no freecad or no xvfb-run for the window\n")
    outcome = in_windows(arguments)
    failures = outcome.failures()
    crashed = any(CRASH in " ".join(reason) for reason in failures.values())
    is_retried = outcome.status == TESTS_FAILED and 0 < len(failures) <= RETRIED_TESTS
    stopped = any(word.startswith(("-x", "--exitfirst", "--maxfail")) for word in arguments)
    if not is_retried or crashed or stopped or not all(file_of(name).exists() for name in failures):
        return outcome
    return merge_retry(outcome, in_windows([*failures]))


def in_windows(arguments: Sequence[str]) -> Outcome:
    """Run tests in as many FreeCADs as have work."""
    count = min(WINDOWS, sum(100 if file_of(word).is_dir() else 1 for word in paths_of(arguments)))
    worker = f"popen//python={sys.executable} {ROOT / 'tests' / 'window.py'}"
    return run_pytest("window", arguments, ["--dist", "loadfile", "--tx", f"{count}*{worker}"], 0)


def merge_retry(first_run: Outcome, second_run: Outcome) -> Outcome:
    """Return the combined outcome of a run and the second run of its failed tests."""
    retried, (passed, _, skipped) = first_run.failures(), first_run.counts()
    cured = second_run.counts()[0]
    failures = {name: retried.get(name, []) for name in retried if name in second_run.failures()}
    failures = {**failures, **second_run.failures()} if cured < len(retried) else {}
    text = f"tried twice: {' '.join(retried)}\n" + describe_failures(failures)
    text += f"total: {passed + cured} passed, {len(retried) - cured} failed, {skipped} skipped\n"
    return Outcome(first_run.name, TESTS_FAILED if cured < len(retried) else 0, text)


def run_in_version(version: str, arguments: Sequence[str]) -> Outcome:
    """Run tests in another version of FreeCAD."""
    outcome = stream(
        f"FreeCAD {version}", [str(VERSION_SCRIPT), version, *arguments], {**os.environ}
    )
    return Outcome(outcome.name, outcome.status, outcome.text.rpartition(SUMMARY)[2])


def file_of(word: str) -> Path:
    """Return the file or folder that an argument of pytest names."""
    return (ROOT / word.partition("::")[0]).resolve()


def paths_of(arguments: Sequence[str]) -> list[str]:
    """Return the folders, files and tests among pytest's arguments."""
    return [word for word in arguments if not word.startswith("-") and file_of(word).exists()]


def split_arguments(arguments: Sequence[str]) -> tuple[list[str] | None, list[str] | None]:
    """Return pytest's arguments for the headless run and for the window run. None means that this
    run has no tests."""
    gui = ROOT / "tests" / "gui"
    paths = paths_of(arguments)
    options = [word for word in arguments if word not in paths]
    inside = [word for word in paths if file_of(word).is_relative_to(gui)]
    outside = [word for word in paths if word not in inside]
    around = not paths or any(gui.is_relative_to(file_of(word)) for word in paths)
    window = inside or (["tests/gui"] if around else [])
    return (
        [*options, *outside] if outside or not paths else None,
        [*options, *window] if window else None,
    )


def describe_failures(failures: dict[str, list[str]]) -> str:
    """Return the lines that `Outcome.failures` reads."""
    return "".join(
        f"failed: {name}\n" + "".join(f"    {line}\n" for line in reason)
        for name, reason in failures.items()
    )


def summarize(outcomes: Sequence[Outcome]) -> int:
    """Print the failures and totals of all runs and return the exit status."""
    print(SUMMARY)
    explained = 0
    for outcome in outcomes:
        for line in re.findall(r"^tried twice: .*", outcome.text, re.MULTILINE):
            print(f"{line}  [{outcome.name}]")
        for name, reason in outcome.failures().items():
            explained += 1
            reason_lines = reason if explained <= EXPLAINED_FAILURES else []
            print(describe_failures({f"{name}  [{outcome.name}]": reason_lines}), end="")
    passed, failed, skipped = map(sum, zip(*(outcome.counts() for outcome in outcomes)))
    print(f"total: {passed} passed, {failed} failed, {skipped} skipped", flush=True)
    return 0 if passed and not failed else 1


def main(arguments: list[str]) -> int:
    """Run the headless tests and the window tests at the same time and return the exit status."""
    version = ""
    if arguments[:1] == ["--with-freecad"] and len(arguments) > 1:
        version, arguments = arguments[1], arguments[2:]
        # takes minutes, and mostly waits for the network
        subprocess.Popen(
            [str(VERSION_SCRIPT), version, "--make"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    # compile once: the test processes write no bytecode
    compiling = ["-m", "compileall", "-q", "--invalidation-mode", "checked-hash", "freecad_am"]
    subprocess.run([sys.executable, *compiling], cwd=ROOT, capture_output=True, check=False)

    headless, window = split_arguments(arguments)
    selection = ["--long"] if "--long" in arguments else ["-m", "not any_version"]

    def run_chain(arguments, run_tests, slots):
        outcomes = [] if arguments is None else [run_tests(arguments)]
        if version:
            outcomes.append(run_in_version(version, [*selection, *slots]))
        return outcomes

    with ThreadPoolExecutor(2) as pool:
        chains = [
            pool.submit(run_chain, window, run_windows, WINDOW_OF_VERSION),
            pool.submit(run_chain, headless, run_headless, HEADLESS_OF_VERSION),
        ]
        return summarize([outcome for chain in chains for outcome in chain.result()])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
