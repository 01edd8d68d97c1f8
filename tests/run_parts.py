# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of the tests: as many at the same time as keep the cores busy, each with its name before its lines, and what each
has taken."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MORE = 0.25  # of a core, that parts at the same time may ask for beyond those that are there
SLOWEST = 10  # tests told of with what they took


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
        return self


AT_HAND: ContextVar[Part | None] = ContextVar("part", default=None)  # of this thread
PREFIXED = False  # several parts at the same time


def say(text: str) -> None:
    """A line, with the name of its part where several run at the same time."""
    part = AT_HAND.get()
    for line in text.splitlines() or [""]:
        print(f"{part.name:<18} | {line}\n" if part and PREFIXED else f"{line}\n", end="", flush=True)


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
    print("freecad-am: what the parts took, and s of processor", flush=True)
    for part in parts:
        print(f"  {part.wall:7.1f} s {part.used:7.1f} s  {part.name}")
    if len(parts) > 1:
        print(f"  {wall:7.1f} s {sum(part.used for part in parts):7.1f} s  in all")
    rows = [(float(took), float(used), name) for took, used, name in (line.split("\t", 2) for line in tests.splitlines())]
    slowest = sorted((row for row in rows if row[0] >= 1.0), reverse=True)[:SLOWEST]
    if slowest:
        print(f"freecad-am: the slowest of {len(rows)} tests")
    for took, used, name in slowest:
        print(f"  {took:7.1f} s {used:7.1f} s  {name[:160]}")
