# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of a batch planned by the workers of a Dask cluster, a third-party engine (decision 0018).

Code and files are sent with the rows, and outputs come back with the results, so workers need no
access to our folders. Dask repeats the rows of a lost worker.
"""

from __future__ import annotations

import contextlib
import importlib.util
import os
import sys
import time
import uuid
from collections.abc import Iterator
from typing import Any

from ..core.issues import InputError, Text, Word
from . import output_folder as outputs
from . import staging, versions
from .console import Session
from .row_table import Journal, Row

WHERE, CODE = "--scheduler", "SCHEDULER"
WORKER = "freecad_am_row_worker"
ANSWER = 10.0  # s for a scheduler to answer
START_TIMEOUT_S = 180.0  # s for every worker to have FreeCAD loaded
LOSS_TIMEOUT_S = 60.0  # s without scheduler or without workers that are waited
POLL_S = 0.5  # s between polls
AHEAD = 2  # rows given out for each that can be planned at the same time
MAX_FILE_BYTES = 1 << 30  # bytes of a file that goes along


class Cluster:
    """The workers of a scheduler, ready for the rows of one batch; a context manager."""

    def __init__(self, address: str, session: Session) -> None:
        """Raises InputError NO_DASK, or SCHEDULER if it does not answer, if it or a worker has
        another version of Dask, or if a worker has no FreeCAD.
        """
        self._address, self._session = address, session
        self._reported: set[str] = set()
        self._token = uuid.uuid4().hex
        self._kept: dict[str, Any] = {}
        self._client = _connected(address)
        try:
            _refuse_versions(address, self._client)
            self._module = _sent_module(self._client)
            self._settings = _settings()
            self._package = self._sent(versions.package(), "code")
            self._make_ready()
        except BaseException:
            self._close()
            raise

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    def planned(
        self, rows: list[Row], folder: str, dry: bool, journal: Journal
    ) -> Iterator[tuple[Row, dict[str, Any]]]:
        """Rows with their results, as they end; their outputs are in place below `folder`, and written down. Raises
        InputError SCHEDULER where scheduler or workers are gone for a minute."""
        waiting, running = list(reversed(rows)), {}
        since = time.monotonic()
        try:
            while waiting or running:
                count = AHEAD * max(1, self._threads()) - len(running)
                if waiting and count > 0:
                    next_rows, waiting = waiting[-count:][::-1], waiting[:-count]
                    running.update(self._submit(next_rows, dry))
                finished = [future for future in _first_done(list(running)) if future in running]
                for future in finished:
                    row = running.pop(future)
                    yield row, self._result(future, row, folder, dry, journal)
                self._session.check()
                since = time.monotonic() if finished or self._is_there() else since
                if time.monotonic() - since > LOSS_TIMEOUT_S:
                    raise self._lost_error()
        finally:
            with contextlib.suppress(Exception):
                self._client.cancel(list(running), force=True)

    def _submit(self, rows: list[Row], dry: bool) -> dict[Any, Row]:
        """The rows by their futures."""
        orders = [_order(row, dry) for row in rows]
        contents = [[self._package, *map(self._file, order["files"])] for order in orders]
        futures = self._client.map(
            self._module.plan_row,
            orders,
            contents,
            key=[f"freecad-am-row-{row.number}-{self._token}" for row in rows],
            pure=False,
            token=self._token,
            settings=self._settings,
        )
        return dict(zip(futures, rows, strict=True))

    def _file(self, path: str) -> Any:
        """A local file on the cluster, sent once for all rows."""
        if path not in self._kept:
            if os.path.getsize(path) > MAX_FILE_BYTES:
                raise InputError(
                    CODE,
                    path,
                    "a file of more than 1 GB is not sent to a cluster; plan without --scheduler",
                )
            with open(path, "rb") as stream:
                self._kept[path] = self._sent(stream.read(), f"file-{len(self._kept)}")
        return self._kept[path]

    def _sent(self, content: bytes, name: str) -> Any:
        """A result on the cluster that is made of the content again if the worker that has it is lost."""
        return self._client.submit(
            self._module.keep_content, content, pure=False, key=f"freecad-am-{name}-{self._token}"
        )

    def _make_ready(self) -> None:
        """Report the versions of every worker. Raises InputError without workers, or if one cannot plan."""
        from distributed import wait

        workers = sorted(self._workers())
        if not workers:
            raise InputError(
                CODE,
                WHERE,
                "{} has no workers; start some with: dask worker {}",
                self._address,
                self._address,
            )
        futures = {
            worker: self._client.submit(
                self._module.check_worker,
                self._token,
                self._settings,
                self._package,
                workers=[worker],
                pure=False,
                key=f"freecad-am-ready-{number}-{self._token}",
            )
            for number, worker in enumerate(workers)
        }
        with contextlib.suppress(TimeoutError):
            wait(list(futures.values()), timeout=START_TIMEOUT_S)
        for worker, future in futures.items():
            if future.status == "error":
                raise InputError(
                    CODE,
                    worker,
                    "this worker cannot plan: {}; install FreeCAD there, or end it",
                    _failure_text(future),
                )
            if future.status == "finished":
                self._report_versions(worker, future.result())

    def _report_versions(self, worker: str, worker_versions: dict[str, str]) -> None:
        """The versions of a worker, the first time."""
        if worker in self._reported:
            return
        self._reported.add(worker)
        local_versions = versions.found_versions()
        differing = [
            name
            for name in sorted({*local_versions, *worker_versions})
            if local_versions.get(name) != worker_versions.get(name)
        ]
        text = ", ".join(f"{name} {version}" for name, version in worker_versions.items())
        self._session.say(f"note[WORKER] {worker}: {text}")
        if differing:
            ours = ", ".join(f"{name} {local_versions.get(name, 'missing')}" for name in differing)
            self._session.say(
                f"warning[VERSIONS] {worker}: here is {ours}; last digits of its rows may differ from what is "
                "planned here"
            )

    def _result(
        self, future: Any, row: Row, folder: str, dry: bool, journal: Journal
    ) -> dict[str, Any]:
        """Return the result of a row; its outputs are moved and recorded even on Ctrl-C."""
        if future.status != "finished":
            if future.status == "error" and type(future.exception()).__name__ == "KilledWorker":
                message = (
                    "each worker that planned it was lost; check their memory, and plan "
                    "this row separately"
                )
                return {"exit": 1, "message": message, "lines": [f"error[LOST] row: {message}"]}
            raise InputError(
                CODE,
                WHERE,
                "{} gave up row {}: {}; finished rows are complete: use --resume to plan the rest",
                self._address,
                row.number,
                _failure_text(future),
            )
        result: dict[str, Any] = future.result()
        self._report_versions(result.pop("worker"), result.pop("versions"))
        contents = result.pop("files")
        with staging.uninterrupted():
            if contents:
                with outputs.Outputs(os.path.join(folder, row.folder)) as files:
                    for name, content in contents.items():
                        files.write(name, content)
                    files.publish(outputs.earlier_outputs(files.folder))
            journal.keep(row, dry, result)
        return result

    def _threads(self) -> int:
        return sum(int(worker["nthreads"]) for worker in self._workers().values())

    def _workers(self) -> dict[str, Any]:
        workers: dict[str, Any] = self._client.scheduler_info().get("workers", {})
        return workers

    def _is_there(self) -> bool:
        return self._client.status == "running" and bool(self._workers())

    def _lost_error(self) -> InputError:
        what = (
            "it has no workers any more"
            if self._client.status == "running"
            else "it does not answer any more"
        )
        return InputError(
            CODE,
            WHERE,
            "{}: {}; finished rows are complete: use --resume to plan the rest",
            self._address,
            Word(what),
        )

    def _close(self) -> None:
        with contextlib.suppress(Exception):
            if self._client.status == "running":
                self._client.run(self._module.stop, self._token, on_error="ignore")
        with contextlib.suppress(Exception):
            self._client.close(timeout=ANSWER)


def _connected(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError(
            "NO_DASK",
            WHERE,
            "planning on a cluster needs Dask, which is not installed ({}); install "
            "python3-distributed, or remove the option",
            error,
        ) from None
    try:
        return Client(address, timeout=ANSWER)  # which `wait` goes by
    except Exception as error:  # of sockets, of names, of messages that are not understood
        why = " ".join(str(error).split()) or type(error).__name__
        raise InputError(
            CODE,
            WHERE,
            "no scheduler answers at {!r} ({}); start one with: dask scheduler, pass its "
            "address, such as tcp://host:8786, and use the same version of Dask everywhere",
            address,
            why,
        ) from None


def _refuse_versions(address: str, client: Any) -> None:
    """Dask promises nothing between versions: results come late, not at all, or end in errors of its own."""
    reported_versions = client.get_versions()
    ours = reported_versions["client"]["packages"]["distributed"]
    for where, info in (
        ("scheduler", reported_versions["scheduler"]),
        *sorted(reported_versions["workers"].items()),
    ):
        theirs = (info or {}).get("packages", {}).get("distributed")
        if theirs != ours:
            raise InputError(
                CODE,
                WHERE,
                "{}: {} has distributed {}, this command {}; install the same version everywhere",
                address,
                where,
                theirs,
                ours,
            )


def _sent_module(client: Any) -> Any:
    """The module of workers, sent to present and future workers, and imported here under the same
    name.
    """
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), f"{WORKER}.py")
    client.upload_file(path)
    if WORKER not in sys.modules:
        spec = importlib.util.spec_from_file_location(WORKER, path)
        assert spec is not None and spec.loader is not None
        sys.modules[WORKER] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[WORKER])
    return sys.modules[WORKER]


def _order(row: Row, dry: bool) -> dict[str, Any]:
    """What a worker needs to plan a row: the job, and the files and links that it names."""
    names = [name for name in sorted(row.files) if os.path.isfile(name)]
    links = [(name, os.path.realpath(name)) for name in names if os.path.realpath(name) != name]
    return {
        "label": row.label,
        "values": row.tree().values,
        "path": os.path.abspath(row.path),
        "dry": dry,
        "files": sorted({os.path.realpath(name) for name in names}),
        "links": links,
    }


def _settings() -> dict[str, Any]:
    from freecad_am.objects import user_machines

    return {
        "machines": [os.path.abspath(folder) for folder in user_machines.folders()],
        "home": os.path.expanduser("~"),
    }


def _first_done(futures: list[Any]) -> list[Any]:
    """The futures that have ended in any way, after a short wait. A result that was lost with its
    worker before it was fetched has not ended: Dask makes it again.
    """
    from distributed import wait

    try:
        wait(futures, timeout=POLL_S, return_when="FIRST_COMPLETED")
    except Exception:  # nothing yet, or some cancelled at once, which their status shows
        time.sleep(0.02)
    return [future for future in futures if future.status not in ("pending", "lost")]


def _failure_text(future: Any) -> str:
    if future.status != "error":
        return Text("it was {}", future.status)
    return " ".join(str(future.exception()).split()) or type(future.exception()).__name__
