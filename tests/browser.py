# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drive a page in headless Chromium through its debugging pipe."""

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

BROWSER_READS, BROWSER_WRITES, FIRST_FREE = (
    3,
    4,
    10,
)  # descriptors of the pipe in the browser, and the first number that is free for our ends

TIMEOUT_S = 60  # s


def find_browser() -> str | None:
    """Return the browser of this machine, None if there is none."""
    return next(filter(None, map(shutil.which, NAMES)), None)


def _pipe() -> tuple[int, int]:
    """Return both ends of a pipe, with numbers that the browser does not use for its own."""
    ends = os.pipe()
    descriptors = tuple(fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, FIRST_FREE) for end in ends)
    for end in ends:
        os.close(end)
    return descriptors[0], descriptors[1]


class Browser:
    """Control one page. `errors` holds the errors on its console and its uncaught exceptions."""

    def __init__(self, page: Path, profile: Path) -> None:
        (browser_in, into), (out, write) = _pipe(), _pipe()

        def connect_pipe() -> None:
            os.dup2(browser_in, BROWSER_READS)
            os.dup2(write, BROWSER_WRITES)

        self._process = subprocess.Popen(
            [str(find_browser()), *OPTIONS, f"--user-data-dir={profile}", "about:blank"],
            preexec_fn=connect_pipe,
            pass_fds=(BROWSER_READS, BROWSER_WRITES),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(browser_in)
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
        """Return the value of an expression in the page; wait for it if it is a promise."""
        reply = self._ask(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in reply:
            raise AssertionError(reply["exceptionDetails"])
        return reply["result"].get("value")

    def mouse(self, kind: str, x: float, y: float, **options: Any) -> None:
        """Press, move or release the mouse, or turn its wheel, at a position in the window."""
        self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, **options)

    def picture(self) -> str:
        """Return the window as PNG, in base64."""
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
            reply = self._next()
            if reply.get("id") == number:
                if "error" in reply:
                    raise AssertionError(reply["error"])
                answer: dict[str, Any] = reply["result"]
                return answer
            self._heard(reply)

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._held:
            if not select.select([self._out], [], [], TIMEOUT_S)[0]:
                self._process.kill()
                raise TimeoutError(f"the browser has said nothing for {TIMEOUT_S} s")
            data = os.read(self._out, 65536)
            if not data:
                raise EOFError("the browser is gone")
            self._held += data
        message, self._held = self._held.split(b"\0", 1)
        reply: dict[str, Any] = json.loads(message)
        return reply

    def _heard(self, event: dict[str, Any]) -> None:
        params = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(params["exceptionDetails"]))
        elif event.get("method") == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])
        elif event.get("method") == "Runtime.consoleAPICalled" and params["type"] == "error":
            self.errors.append(json.dumps(params["args"]))
