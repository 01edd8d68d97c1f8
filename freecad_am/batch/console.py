# SPDX-License-Identifier: LGPL-2.1-or-later
"""Output of a command: stdout for results, stderr for messages, progress only on a terminal."""

from __future__ import annotations

import os
import re
import signal
import sys
import threading
import time
from collections.abc import Iterable
from typing import Any

from ..core.issues import ERROR, Issue, summarised
from .child import report_stopping

DEBOUNCE_S = 1.0  # s within which a second Ctrl-C is the first: a terminal sends it, and the process that waits for us
LEADING_CODES = ("REMEDY", "NO_REMEDY")  # codes of remedies, listed first
_MAX_ISSUES = 12  # on stderr; the report has them all
MAX_LINE_LENGTH = 4000  # signs of a line: a value in it may be as long as a file
# signs that move the cursor, end a line or turn the direction of writing: in a name they could forge what we say
_UNSEEN = re.compile(
    "[\\x00-\\x1f\\x7f-\\x9f\\u061c\\u200e\\u200f\\u2028\\u2029\\u202a-\\u202e\\u2066-\\u2069\\ufeff\\ud800-\\udfff]"
)


def escaped(text: str) -> str:
    """The text on one line, with control signs, ends of lines and what turns writing round as Python would write them."""
    return _UNSEEN.sub(
        lambda match: repr(match[0])[1:-1] if match[0].isascii() else f"\\u{ord(match[0]):04x}",
        text,
    )


class Session:
    """The console of one command. Between `__enter__` and `__exit__` the libraries underneath cannot write to it.

    FreeCAD and OpenCASCADE write to the file descriptors 1 and 2, which would mix with what the user asked for.
    """

    def __init__(self) -> None:
        self.interrupted = False  # whether Ctrl-C was pressed
        self._when = 0.0
        self.outcome = "nothing was written"  # message when the command is interrupted
        self._progress = ""

    def __enter__(self) -> Session:
        self._handle(signal.SIGINT)
        self._handle(signal.SIGTERM)
        sys.stdout.flush()
        sys.stderr.flush()
        self._saved = (_duplicate(1), _duplicate(2))
        self._tty = os.isatty(2)
        if not os.environ.get("FREECAD_AM_DEBUG"):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            os.close(nowhere)
        return self

    def __exit__(self, *_: object) -> None:
        self._clear()
        sys.stdout.flush()
        sys.stderr.flush()
        for number, saved in zip((1, 2), self._saved):
            os.dup2(saved, number)
            os.close(saved)

    def out(self, text: str) -> None:
        """Write to stdout; control signs other than ends of lines and tabs as `escaped` writes them."""
        self._clear()
        lines = ("\t".join(map(escaped, line.split("\t"))) for line in text.split("\n"))
        _write(self._saved[0], "\n".join(lines))

    def say(self, line: str) -> None:
        """Write one line to stderr, with control signs escaped; a very long line is shortened in
        its middle.
        """
        self._clear()
        text = escaped(line)
        if len(text) > MAX_LINE_LENGTH:
            text = f"{text[: MAX_LINE_LENGTH // 2]} ... {text[-MAX_LINE_LENGTH // 2 :]}"
        _write(self._saved[1], text + "\n")

    def issues(self, findings: Iterable[Issue], elsewhere: str = "stand in report.json") -> None:
        """Write findings to stderr, first remedies, then errors.

        Findings of one kind in several layers are one line. After a dozen lines the rest is counted, with where it is.
        """
        ordered = sorted(
            summarised(findings),
            key=lambda issue: (issue.code not in LEADING_CODES, issue.level != ERROR),
        )
        for issue in ordered[:_MAX_ISSUES]:
            self.say(
                f"{issue.level}[{issue.code}] {issue.where or 'job'}: {' '.join(issue.message.split())}"
            )
        if len(ordered) > _MAX_ISSUES:
            self.say(f"note[MORE] job: {len(ordered) - _MAX_ISSUES} more findings {elsewhere}")

    def progress(self, text: str) -> None:
        """Show the current activity, only on a terminal; ends the command if Ctrl-C was pressed."""
        self.check()
        if self._tty:
            self._clear()
            _write(self._saved[1], escaped(text))
            self._progress = text

    def check(self) -> None:
        """Raise KeyboardInterrupt if FreeCAD has swallowed a Ctrl-C while it was working."""
        if self.interrupted:
            raise KeyboardInterrupt

    def _clear(self) -> None:
        if self._progress:
            _write(self._saved[1], "\r\x1b[K")
            self._progress = ""

    def _handle(self, number: int) -> None:
        # set also where the shell that started us in the background had it ignored
        if threading.current_thread() is threading.main_thread():
            signal.signal(number, self._interrupt)

    def _interrupt(self, *_: Any) -> None:
        now = time.monotonic()
        if self.interrupted and now - self._when < DEBOUNCE_S:
            return
        self.interrupted, self._when = True, now
        report_stopping()
        raise KeyboardInterrupt


def _duplicate(descriptor: int) -> int:
    try:
        return os.dup(descriptor)
    except OSError:  # closed by who started us
        return os.open(os.devnull, os.O_WRONLY)


def _write(descriptor: int, text: str) -> None:
    data = text.encode("utf-8", "replace")
    while data:
        data = data[os.write(descriptor, data) :]
