# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dask worker functions of a batch. The file is sent separately and imports nothing of the package.

The package arrives as an archive, which is unpacked in the worker's folder next to the job files.
The launcher in the archive plans each row as a separate command, so the worker's Python needs
neither FreeCAD nor numpy.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import subprocess
import tempfile
import threading
import time
import zipfile
from typing import Any

MAX_MESSAGE_LENGTH = 2000  # characters; maximum length of a start-up error message
ENDED = "the batch has ended"
_ATTRIBUTE = "_freecad_am_batches"  # worker attribute: another batch may send this module again


class Batch:
    """Folder and processes of one batch on one worker."""

    def __init__(self, folder: str) -> None:
        self.path = os.path.realpath(tempfile.mkdtemp(prefix="freecad-am-", dir=folder))
        self.code, self.copies, self._temporary = (
            os.path.join(self.path, name) for name in ("code", "copies", "temporary")
        )
        os.makedirs(self._temporary)
        self._running: set[subprocess.Popen[str]] = set()
        self._lock = threading.Lock()
        self._stopped = False

    def unpack(
        self, package: bytes, files: list[tuple[str, bytes]], links: list[tuple[str, str]]
    ) -> None:
        """Write missing code and files to the batch folder."""
        with self._lock:
            if not os.path.isdir(self.code):
                with zipfile.ZipFile(io.BytesIO(package)) as archive:
                    archive.extractall(os.path.join(self.path, "unpacking"))
                os.replace(os.path.join(self.path, "unpacking"), self.code)
            for name, content in files:
                target = self.copies + name
                if not os.path.exists(target):
                    os.makedirs(os.path.dirname(target), exist_ok=True)
                    with open(target, "wb") as stream:
                        stream.write(content)
            for name, link_target in links:
                target = self.copies + name
                if not os.path.lexists(target):
                    os.makedirs(os.path.dirname(target), exist_ok=True)
                    os.symlink(self.copies + link_target, target)

    def run(self, settings: dict[str, Any], order: dict[str, Any] | None) -> dict[str, Any]:
        """Return the software versions and, for an order, its result.

        Raises RuntimeError, with the message of the process, if the process ends without an answer.
        """
        process = self._start(settings)
        try:
            assert process.stdin is not None and process.stdout is not None
            with contextlib.suppress(OSError):  # the process has ended
                process.stdin.write(json.dumps({"folder": self.path, "order": order}) + "\n")
                process.stdin.flush()
            answer = process.stdout.read()
            process.wait()
        finally:
            process.kill()
            with self._lock:
                self._running.discard(process)
        if answer.endswith("\n"):
            result: dict[str, Any] = json.loads(answer)
            return result
        raise RuntimeError(_message(process))

    def stop(self) -> None:
        """Stop the processes, even during work, and remove the folder."""
        with self._lock:
            self._stopped, running = True, list(self._running)
        for process in running:
            with contextlib.suppress(OSError):
                process.terminate()
        for process in running:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(10.0)
            process.kill()
        until = time.monotonic() + 5.0
        while os.path.exists(self.path) and time.monotonic() < until:
            shutil.rmtree(self.path, ignore_errors=True)  # an ending row may still write there

    def _start(self, settings: dict[str, Any]) -> subprocess.Popen[str]:
        relocation = {
            "copies": self.copies,
            "local": [self.code, self.path],
            "home": settings["home"],
            "machines": settings["machines"],
        }
        with self._lock:
            if self._stopped:
                raise RuntimeError(ENDED)
            process = subprocess.Popen(
                ["/bin/sh", os.path.join(self.code, "freecad-am"), "row"],
                text=True,
                cwd=self.path,
                env={
                    **os.environ,
                    "TMPDIR": self._temporary,
                    "FREECAD_AM_FILES": json.dumps(relocation),
                },
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
            )
            self._running.add(process)
            return process


def keep_content(content: bytes) -> bytes:
    """Return the content, so that a batch file is a Dask result, which Dask recreates if lost."""
    return content


def check_worker(token: str, settings: dict[str, Any], package: bytes) -> dict[str, str]:
    """Return the software versions on the worker. Raises RuntimeError if FreeCAD is missing."""
    batch = _batch(token)
    batch.unpack(package, [], [])
    versions: dict[str, str] = batch.run(settings, None)["versions"]
    return versions


def plan_row(
    order: dict[str, Any], contents: list[bytes], token: str, settings: dict[str, Any]
) -> dict[str, Any]:
    """Plan a row; return its result with outputs as `files`, worker address and versions.

    contents: the package archive, then each file that the order names.
    """
    from distributed import get_worker

    batch = _batch(token)
    order = dict(order)
    names, links = order.pop("files"), order.pop("links")
    batch.unpack(contents[0], list(zip(names, contents[1:], strict=True)), links)
    with tempfile.TemporaryDirectory(dir=batch.path) as folder:
        outputs = os.path.join(folder, "row")
        answer = batch.run(settings, {**order, "folder": outputs})
        files = dict(_files(outputs))
    return {
        **answer["result"],
        "files": files,
        "worker": get_worker().address,
        "versions": answer["versions"],
    }


def stop(token: str, dask_worker: Any) -> None:
    """Stop the work of a batch on this worker. Dask passes `dask_worker`."""
    with _lock:
        batches: dict[str, Batch | None] = dask_worker.__dict__.setdefault(_ATTRIBUTE, {})
        batch, batches[token] = batches.get(token), None  # submitted rows may still start
    if batch is not None:
        batch.stop()


_lock = threading.Lock()


def _batch(token: str) -> Batch:
    from distributed import get_worker

    worker = get_worker()
    with _lock:
        batches: dict[str, Batch | None] = worker.__dict__.setdefault(_ATTRIBUTE, {})
        if token not in batches:
            batches[token] = Batch(worker.local_directory)
        batch = batches[token]
    if batch is None:
        raise RuntimeError(ENDED)
    return batch


def _message(process: subprocess.Popen[str]) -> str:
    """Return the error message of a process that has ended."""
    assert process.stderr is not None
    message = " ".join(process.stderr.read().split())
    return (
        message[-MAX_MESSAGE_LENGTH:]
        or f"the process that plans rows ended with status {process.returncode}"
    )


def _files(folder: str) -> Any:
    """Yield names, with slashes, and contents of the files in a folder."""
    for subfolder, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(subfolder, name)
            with open(path, "rb") as stream:
                yield os.path.relpath(path, folder).replace(os.sep, "/"), stream.read()
