# SPDX-License-Identifier: LGPL-2.1-or-later
"""The work of a Dask worker for a batch. The file is sent to workers separately and imports nothing
of the package.

Our code comes as an archive, which is unpacked in the worker's own folder, next to the files of the
jobs. Rows are planned by a process of `row_host.py`, found by the launcher: a worker's Python needs
neither FreeCAD nor numpy. There are as many such processes as the worker has rows at the same time,
and they end with it.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import queue
import shutil
import subprocess
import tempfile
import threading
import time
import zipfile
from typing import Any

MAX_MESSAGE_LENGTH = 2000  # characters of the message of a process that does not start
ENDED = "the batch has ended"
_ATTRIBUTE = "_freecad_am_batches"  # of the worker: this module may be sent again, by another batch


class Batch:
    """The folder and the processes of one batch on one worker."""

    def __init__(self, folder: str, settings: dict[str, Any]) -> None:
        self.path = tempfile.mkdtemp(prefix="freecad-am-", dir=folder)
        self.settings = {
            **settings,
            "copies": os.path.join(self.path, "copies"),
            "folder": self.path,
        }
        self.versions: dict[str, str] = {}
        self._idle: queue.SimpleQueue[subprocess.Popen[str]] = queue.SimpleQueue()
        self._all: list[subprocess.Popen[str]] = []
        self._lock = threading.Lock()
        self._stopped = False

    def unpacked(
        self, package: bytes, files: list[tuple[str, bytes]], links: list[tuple[str, str]]
    ) -> None:
        """Write missing code and files to their places."""
        with self._lock:
            if not os.path.isdir(os.path.join(self.path, "code")):
                with zipfile.ZipFile(io.BytesIO(package)) as archive:
                    archive.extractall(os.path.join(self.path, "unpacking"))
                os.replace(os.path.join(self.path, "unpacking"), os.path.join(self.path, "code"))
            for name, content in files:
                target = self.settings["copies"] + name
                if not os.path.exists(target):
                    os.makedirs(os.path.dirname(target), exist_ok=True)
                    with open(target, "wb") as stream:
                        stream.write(content)
            for name, link_target in links:
                target = self.settings["copies"] + name
                if not os.path.lexists(target):
                    os.makedirs(os.path.dirname(target), exist_ok=True)
                    os.symlink(self.settings["copies"] + link_target, target)

    def ask(self, order: dict[str, Any]) -> dict[str, Any]:
        """The answer of a process. RuntimeError, with its message, if no process starts."""
        process = self._process()
        answer = _exchanged(process, order)
        if answer is None:
            raise RuntimeError(_last_words(process))
        self._idle.put(process)
        return answer

    def stop(self) -> None:
        """End the process, even during work, and remove its folder."""
        with self._lock:
            self._stopped = True
            for process in self._all:
                with contextlib.suppress(OSError):
                    process.terminate()
            for process in self._all:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(10.0)
                if process.poll() is None:
                    process.kill()
        until = time.monotonic() + 5.0
        while (
            os.path.exists(self.path) and time.monotonic() < until
        ):  # a row that is being stopped may still write there
            shutil.rmtree(self.path, ignore_errors=True)

    def _process(self) -> subprocess.Popen[str]:
        with contextlib.suppress(queue.Empty):
            return self._idle.get_nowait()
        with self._lock:
            if self._stopped:
                raise RuntimeError(ENDED)
            process = subprocess.Popen(
                ["/bin/sh", os.path.join(self.path, "code", "freecad-am"), "rows"],
                text=True,
                cwd=self.path,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
            )
            self._all.append(process)
        answer = _exchanged(process, self.settings)
        if answer is None:
            raise RuntimeError(_last_words(process))
        self.versions = answer
        return process


def keep_content(content: bytes) -> bytes:
    """The content: a file of a batch as a result of its own, which Dask makes again where it is lost with a worker."""
    return content


def ready(token: str, settings: dict[str, Any], package: bytes) -> dict[str, str]:
    """The versions of the software on the worker; RuntimeError if FreeCAD is missing."""
    batch = _batch(token, settings)
    batch.unpacked(package, [], [])
    return dict(batch.ask({"versions": True}))


def planned(
    token: str, settings: dict[str, Any], order: dict[str, Any], package: bytes, *contents: bytes
) -> dict[str, Any]:
    """The result of a row, with its outputs as `files`, the worker's address and its versions."""
    from distributed import get_worker

    batch = _batch(token, settings)
    request = dict(order)
    batch.unpacked(
        package, list(zip(request.pop("files"), contents, strict=True)), request.pop("links")
    )
    with tempfile.TemporaryDirectory(dir=batch.path) as folder:
        result = batch.ask({**request, "folder": os.path.join(folder, "row")})
        result["files"] = dict(_files(os.path.join(folder, "row")))
    return {**result, "worker": get_worker().address, "versions": batch.versions}


def stop(token: str, dask_worker: Any) -> None:
    """End what this worker does for a batch. `dask_worker` is put in by Dask."""
    with _making:
        batches: dict[str, Batch | None] = dask_worker.__dict__.setdefault(_ATTRIBUTE, {})
        batch, batches[token] = (
            batches.get(token),
            None,
        )  # rows that were given out may still begin here
    if batch is not None:
        batch.stop()


_making = threading.Lock()


def _batch(token: str, settings: dict[str, Any]) -> Batch:
    from distributed import get_worker

    worker = get_worker()
    with _making:
        batches: dict[str, Batch | None] = worker.__dict__.setdefault(_ATTRIBUTE, {})
        if token not in batches:
            batches[token] = Batch(worker.local_directory, settings)
        batch = batches[token]
    if batch is None:
        raise RuntimeError(ENDED)
    return batch


def _exchanged(process: subprocess.Popen[str], request: dict[str, Any]) -> Any:
    """The answer of a process to a line; None if it ends."""
    assert process.stdin is not None and process.stdout is not None
    try:
        process.stdin.write(json.dumps(request) + "\n")
        process.stdin.flush()
        line = process.stdout.readline()
    except OSError:
        return None
    return json.loads(line) if line.endswith("\n") else None


def _last_words(process: subprocess.Popen[str]) -> str:
    assert process.stderr is not None
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(10.0)
    process.kill()
    message = " ".join(process.stderr.read().split())
    return (
        message[-MAX_MESSAGE_LENGTH:]
        or f"the process that plans rows ended with status {process.returncode}"
    )


def _files(folder: str) -> Any:
    """Names, with slashes, and contents of the files in a folder."""
    for subfolder, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(subfolder, name)
            with open(path, "rb") as stream:
                yield os.path.relpath(path, folder).replace(os.sep, "/"), stream.read()
