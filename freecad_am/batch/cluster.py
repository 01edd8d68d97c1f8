# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan batch rows on the workers of a Dask cluster, a third-party engine (decision 0018).

Code and files are sent with the rows, and outputs return with the results. So workers do not need
access to the local folders. Dask repeats the rows of a lost worker.
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
ANSWER = 10.0  # s; timeout for an answer of the scheduler
START_TIMEOUT_S = 180.0  # s; timeout for all workers to load FreeCAD
LOSS_TIMEOUT_S = 60.0  # s; timeout after the scheduler or all workers are lost
POLL_S = 0.5  # s; polling interval
AHEAD = 2  # number of submitted rows per worker thread
MAX_FILE_BYTES = 1 << 30  # bytes; maximum size of a file sent to the cluster


class Cluster:
    """Context manager of the workers of a scheduler, ready for the rows of one batch."""

    def __init__(self, address: str, session: Session) -> None:
        """Connect to the scheduler and prepare the workers.

        Raises InputError NO_DASK without Dask; SCHEDULER if the scheduler does not answer, if the
        Dask versions differ, or if a worker has no FreeCAD.
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
        """Yield rows with their results as rows finish.

        The outputs of a yielded row are stored below `folder` and recorded in the journal. Raises
        InputError SCHEDULER if the scheduler or all workers are lost for LOSS_TIMEOUT_S.
        """
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
        """Submit rows; return the rows by future."""
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
        """Return the future of a local file, which is sent once for all rows."""
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
        """Send content to the cluster; return its future. Dask restores it if a worker is lost."""
        return self._client.submit(
            self._module.keep_content, content, pure=False, key=f"freecad-am-{name}-{self._token}"
        )

    def _make_ready(self) -> None:
        """Report the versions of every worker.

        Raises InputError without workers, or if a worker cannot plan.
        """
        from distributed import wait

        workers = sorted(self._workers())
        if not workers:
            raise InputError(
                CODE,
                WHERE,
                "{} has no workers; start workers with: dask worker {}",
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
                    "the worker cannot plan: {}; install FreeCAD on its machine, or stop the "
                    "worker",
                    _failure_text(future),
                )
            if future.status == "finished":
                self._report_versions(worker, future.result())

    def _report_versions(self, worker: str, worker_versions: dict[str, str]) -> None:
        """Report the versions of a worker once, and warn if they differ from local versions."""
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
                f"warning[VERSIONS] {worker}: this machine has {ours}; rows of the worker may differ from local "
                "rows in the last digits"
            )

    def _result(
        self, future: Any, row: Row, folder: str, dry: bool, journal: Journal
    ) -> dict[str, Any]:
        """Return the result of a row. The outputs are stored and recorded even on Ctrl-C."""
        if future.status != "finished":
            if future.status == "error" and type(future.exception()).__name__ == "KilledWorker":
                message = "every worker that planned the row was lost; check the memory of the workers, and plan the row separately"
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
            "the scheduler has no more workers"
            if self._client.status == "running"
            else "the scheduler no longer answers"
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
        return Client(address, timeout=ANSWER)  # `wait` uses this timeout too
    except Exception as error:  # socket errors, name resolution, unreadable messages
        why = " ".join(str(error).split()) or type(error).__name__
        raise InputError(
            CODE,
            WHERE,
            "no scheduler answers at {!r} ({}); start a scheduler with `dask scheduler`, pass "
            "its address, such as tcp://host:8786, and use the same version of Dask on all "
            "machines",
            address,
            why,
        ) from None


def _refuse_versions(address: str, client: Any) -> None:
    """Raise InputError SCHEDULER if scheduler or workers have another Dask version.

    With mixed versions, results arrive late, never, or as Dask errors.
    """
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
                "{}: {} has distributed {}, but the command has {}; install the same version on "
                "all machines",
                address,
                where,
                theirs,
                ours,
            )


def _sent_module(client: Any) -> Any:
    """Send the worker module to current and future workers; import it under the same name here."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), f"{WORKER}.py")
    client.upload_file(path)
    if WORKER not in sys.modules:
        spec = importlib.util.spec_from_file_location(WORKER, path)
        assert spec is not None and spec.loader is not None
        sys.modules[WORKER] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[WORKER])
    return sys.modules[WORKER]


def _order(row: Row, dry: bool) -> dict[str, Any]:
    """Return the order for a worker: the job of a row, with the files and links that it names."""
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
    """Wait briefly; return the futures that have ended in any way.

    A result lost with its worker has not ended, because Dask computes it again.
    """
    from distributed import wait

    try:
        wait(futures, timeout=POLL_S, return_when="FIRST_COMPLETED")
    except Exception:  # timeout, or cancelled futures, which their status shows
        time.sleep(0.02)
    return [future for future in futures if future.status not in ("pending", "lost")]


def _failure_text(future: Any) -> str:
    if future.status != "error":
        return Text("the row was {}", future.status)
    return " ".join(str(future.exception()).split()) or type(future.exception()).__name__
