# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of the tests: as many at the same time as keep the cores busy, each with its name before its lines, and what each
has taken."""

from __future__ import annotations

import os
import re
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MORE = 0.45  # of a core, that parts at the same time may ask for beyond those that are there
TIMES = "freecad-am: what the parts took, and s of processor"
SLOWEST = 10  # tests told of with what they took
EXPLAINED = 10  # tests that failed told of with why, and all the others by their names
LAST = 8  # lines of a part that ended without telling what failed
FAILURE = "failed: "  # before the name of a test in the lines of tests/conftest.py; why it failed stands below, indented
# where parts run side by side, what nobody reads: a part's progress, and FreeCAD's banner
NOISE = re.compile(
    r"[.FEsxX]+ +\[ *\d+%\]|[ #]*#[ #]*|FreeCAD (?:\S+, Libs:|is free|wouldn't be) .*|© Juergen Riegel.*"
)


@dataclass
class Part:
    """Some of the tests, run by one command after the other. `load`: the share of a core that they use, as those of a window
    wait for much; `wall`, `used`: s, and s of processor, that they took."""

    name: str
    run: Callable[[], tuple[int, str]]
    load: float = 1.0
    wall: float = 0.0
    used: float = 0.0
    status: int = 1
    text: str = ""

    def done(self) -> Part:
        """Run, with what comes out told under the part's name."""
        AT_HAND.set(self)
        began = time.monotonic()
        self.status, self.text = self.run()
        self.wall = time.monotonic() - began
        if PREFIXED:
            say(f"freecad-am: ended after {self.wall:.0f} s with status {self.status}")
        return self


AT_HAND: ContextVar[Part | None] = ContextVar("part", default=None)  # of this thread
PREFIXED = False  # several parts at the same time


def say(text: str) -> None:
    """A line, with the name of its part where several run at the same time."""
    part = AT_HAND.get()
    for line in text.splitlines() or [""]:
        print(
            f"{part.name:<18} | {line}\n" if part and PREFIXED else f"{line}\n", end="", flush=True
        )


def watched(command: list[str], env: dict[str, str]) -> tuple[int, str]:
    """Run a command, pass its output on as it comes, and return status and output."""
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
        if not (PREFIXED and NOISE.fullmatch(line.rstrip("\n"))):
            say(line)
    _, ended, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(ended)
    part = AT_HAND.get()
    if part:
        part.used += usage.ru_utime + usage.ru_stime
    return process.returncode, "".join(lines)


def run_parts(parts: list[Part]) -> None:
    """All of them in their order, but for one that finds no room while a later one does."""
    global PREFIXED
    PREFIXED = len(parts) > 1
    room = len(os.sched_getaffinity(0)) + MORE
    waiting, running = list(parts), dict[Future[Part], Part]()
    with ThreadPoolExecutor(max(1, len(parts))) as pool:
        try:
            while waiting or running:
                for part in list(waiting):
                    if not running or part.load + sum(one.load for one in running.values()) <= room:
                        running[pool.submit(part.done)] = part
                        waiting.remove(part)
                for ended in wait(running, return_when=FIRST_COMPLETED).done:
                    del running[ended]
                    ended.result()
        except BaseException:  # Ctrl-C, which the tests at hand get too
            pool.shutdown(cancel_futures=True)
            raise


def tell_times(parts: list[Part], wall: float, tests: str) -> None:
    """What each part took, and the slowest tests, from the lines that tests/conftest.py wrote."""
    print(TIMES, flush=True)
    for part in parts:
        print(f"  {part.wall:7.1f} s {part.used:7.1f} s  {part.name}")
    if len(parts) > 1:
        print(f"  {wall:7.1f} s {sum(part.used for part in parts):7.1f} s  in all")
    rows = [
        (float(took), float(used), name)
        for took, used, name in (line.split("\t", 2) for line in tests.splitlines())
    ]
    slowest = sorted((row for row in rows if row[0] >= 1.0), reverse=True)[:SLOWEST]
    if slowest:
        print(f"freecad-am: the slowest of {len(rows)} tests")
    for took, used, name in slowest:
        print(f"  {took:7.1f} s {used:7.1f} s  {name[:160]}")


def failures(text: str) -> dict[str, Sequence[str]]:
    """The tests that failed and the first lines of why, as tests/conftest.py or a runner in another FreeCAD told of them."""
    found: dict[str, Sequence[str]] = {}
    for name, why in re.findall(rf"^{FAILURE}(.+)\n((?:    .*\n)*)", text, re.MULTILINE):
        found[name] = [line[4:] for line in why.splitlines()] or found.get(name, [])
    return found


def told_of(found: Mapping[str, Sequence[str]]) -> str:
    """The lines that `failures` reads."""
    return "".join(
        f"{FAILURE}{name}\n" + "".join(f"    {line}\n" for line in why)
        for name, why in found.items()
    )


def tell_failures(parts: list[Part], sound: tuple[int, ...]) -> None:
    """What failed in which part, and why; of a part that ended otherwise than with one of the statuses `sound` and told
    nothing, its last lines. Tests that passed at their second try are named too."""
    told = 0
    for part in parts:
        found = failures(part.text)
        if not found and part.status not in sound:
            lines = [
                line
                for line in part.text.splitlines()
                if line.strip() and not NOISE.fullmatch(line)
            ]
            found = {f"ended with status {part.status}": lines[-LAST:]}
        for name, why in found.items():
            told += 1
            print(
                told_of(
                    {
                        f"{name}  [{part.name}]" if len(parts) > 1 else name: why
                        if told <= EXPLAINED
                        else []
                    }
                ),
                end="",
            )
        for names in re.findall(r"^total: .* at the second try: (.*)", part.text, re.MULTILINE):
            print(f"tried twice: {names}  [{part.name}]")
