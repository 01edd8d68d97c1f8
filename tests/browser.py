# SPDX-License-Identifier: LGPL-2.1-or-later
"""A page in Chromium without a window, asked and driven through its debugging pipe."""

from __future__ import annotations

import fcntl
import itertools
import json
import os
import select
import shutil
import subprocess
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome")
OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--remote-debugging-pipe",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-extensions",
    "--window-size=1200,1100",
)

READS, WRITES, FREE = (
    3,
    4,
    10,
)  # what the browser calls its ends of the pipe; from where numbers are neither

PATIENCE = 60  # s


def found() -> str | None:
    """The browser of this machine, None without one."""
    return next(filter(None, map(shutil.which, NAMES)), None)


def _pipe() -> tuple[int, int]:
    """Both ends of a pipe, with numbers that the browser's are not."""
    ends = os.pipe()
    found = tuple(fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, FREE) for end in ends)
    for end in ends:
        os.close(end)
    return found[0], found[1]


class Browser:
    """One page. `errors`: what it wrote to the console as errors, and exceptions that nobody caught."""

    def __init__(self, page: Path, profile: Path) -> None:
        (read, into), (out, write) = _pipe(), _pipe()

        def joined() -> None:
            os.dup2(read, READS)
            os.dup2(write, WRITES)

        self._process = subprocess.Popen(
            [str(found()), *OPTIONS, f"--user-data-dir={profile}", "about:blank"],
            preexec_fn=joined,
            pass_fds=(READS, WRITES),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(read)
        os.close(write)
        self._into, self._out = into, out
        self._numbers = itertools.count(1)
        self._held = b""
        self.errors: list[str] = []
        target = self._ask("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._ask("Target.attachToTarget", targetId=target, flatten=True)[
            "sessionId"
        ]
        for domain in ("Runtime", "Log", "Page"):
            self._ask(f"{domain}.enable")
        self._ask("Page.navigate", url=page.resolve().as_uri())
        self.run(
            "new Promise((done) => document.readyState === 'complete' ? done() : addEventListener('load', done))"
        )

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: Any) -> None:
        self._process.kill()
        self._process.wait(timeout=20)
        os.close(self._into)
        os.close(self._out)

    def run(self, script: str) -> Any:
        """The value of an expression in the page; of a promise what it comes to."""
        told = self._ask(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in told:
            raise AssertionError(told["exceptionDetails"])
        return told["result"].get("value")

    def mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        """The mouse is pressed, moved, released or its wheel turned, at a place of the window."""
        self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def picture(self) -> str:
        """The window as PNG, in base64."""
        return str(self._ask("Page.captureScreenshot", format="png")["data"])

    def _ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        number = next(self._numbers)
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters}
        if hasattr(self, "_session"):
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._into, data) :]
        while True:
            told = self._next()
            if told.get("id") == number:
                if "error" in told:
                    raise AssertionError(told["error"])
                answer: dict[str, Any] = told["result"]
                return answer
            self._heard(told)

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._held:
            if not select.select([self._out], [], [], PATIENCE)[0]:
                self._process.kill()
                raise TimeoutError(f"the browser has said nothing for {PATIENCE} s")
            data = os.read(self._out, 65536)
            if not data:
                raise EOFError("the browser is gone")
            self._held += data
        message, self._held = self._held.split(b"\0", 1)
        told: dict[str, Any] = json.loads(message)
        return told

    def _heard(self, told: dict[str, Any]) -> None:
        more = told.get("params", {})
        if told.get("method") == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(more["exceptionDetails"]))
        elif told.get("method") == "Log.entryAdded" and more["entry"]["level"] == "error":
            self.errors.append(more["entry"]["text"])
        elif told.get("method") == "Runtime.consoleAPICalled" and more["type"] == "error":
            self.errors.append(json.dumps(more["args"]))
