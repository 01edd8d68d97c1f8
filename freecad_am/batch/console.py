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

DEBOUNCE_S = 1.0  # s; repeated Ctrl-C within this time is one, from the terminal and the parent
LEADING_CODES = ("REMEDY", "NO_REMEDY")  # codes of remedies, listed first
_MAX_ISSUES = 12  # maximum number of issues on stderr; the report lists all issues
MAX_LINE_LENGTH = 4000  # characters; a message may contain a very long value
# characters that move the cursor, end a line or change the writing direction; names with such
# characters could forge messages
_UNSEEN = re.compile(
    "[\\x00-\\x1f\\x7f-\\x9f\\u061c\\u200e\\u200f\\u2028\\u2029\\u202a-\\u202e\\u2066-\\u2069\\ufeff\\ud800-\\udfff]"
)


def escaped(text: str) -> str:
    """Return the text on one line, with control characters escaped as in Python."""
    return _UNSEEN.sub(
        lambda match: repr(match[0])[1:-1] if match[0].isascii() else f"\\u{ord(match[0]):04x}",
        text,
    )


class Session:
    """Console of one command. Within the context, libraries cannot write to the console.

    FreeCAD and OpenCASCADE write to file descriptors 1 and 2, which would mix with the results.
    """

    def __init__(self) -> None:
        self.interrupted = False  # whether Ctrl-C was pressed
        self._when = 0.0
        self.outcome = "nothing was written"  # message if the command is interrupted
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
        """Write to stdout, with control characters escaped except line ends and tabs."""
        self._clear()
        lines = ("\t".join(map(escaped, line.split("\t"))) for line in text.split("\n"))
        _write(self._saved[0], "\n".join(lines))

    def say(self, line: str) -> None:
        """Write one line to stderr, with control characters escaped and long lines shortened."""
        self._clear()
        text = escaped(line)
        if len(text) > MAX_LINE_LENGTH:
            text = f"{text[: MAX_LINE_LENGTH // 2]} ... {text[-MAX_LINE_LENGTH // 2 :]}"
        _write(self._saved[1], text + "\n")

    def issues(self, findings: Iterable[Issue], elsewhere: str = "are in report.json") -> None:
        """Write issues to stderr, remedies first, then errors.

        Issues of one kind in several layers share a line. After _MAX_ISSUES lines, only the number
        of remaining issues is given, with `elsewhere`.
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
        """Show the current activity on a terminal; end the command if Ctrl-C was pressed."""
        self.check()
        if self._tty:
            self._clear()
            _write(self._saved[1], escaped(text))
            self._progress = text

    def check(self) -> None:
        """Raise KeyboardInterrupt if FreeCAD swallowed a Ctrl-C."""
        if self.interrupted:
            raise KeyboardInterrupt

    def _clear(self) -> None:
        if self._progress:
            _write(self._saved[1], "\r\x1b[K")
            self._progress = ""

    def _handle(self, number: int) -> None:
        # set the handler even if a shell that started the command in the background ignores signals
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
    except OSError:  # closed by the parent process
        return os.open(os.devnull, os.O_WRONLY)


def _write(descriptor: int, text: str) -> None:
    data = text.encode("utf-8", "replace")
    while data:
        data = data[os.write(descriptor, data) :]
