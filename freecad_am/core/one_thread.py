# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limit the linear algebra libraries of numpy and scipy to one thread.

With more threads OpenBLAS rounds differently, even for six equations, and our small matrices take
many times as long: docs/decisions/0016-one-thread.md. A process that we start gets the limit from
`ENVIRONMENT` before it loads numpy. In FreeCAD, numpy may already be loaded and is shared with
other code, so we set the limit for our work and then restore it. threadpoolctl finds the libraries
if it is installed.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import glob
import importlib.util
import os
import threading
from collections.abc import Callable, Iterator
from typing import NamedTuple

# environment variables of the libraries that numpy may use: OpenBLAS, OpenMP, MKL, BLIS and Apple
# Accelerate
ENVIRONMENT = dict.fromkeys(
    (
        "OPENBLAS_NUM_THREADS",
        "OMP_NUM_THREADS",
        "MKL_NUM_THREADS",
        "BLIS_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
    ),
    "1",
)
# getter and setter of the thread count in OpenBLAS (renamed in the wheels of numpy and scipy), MKL
# and OpenMP. OpenMP has a separate thread count for each calling thread
_FUNCTIONS = (
    *(
        (f"{before}openblas_get_num_threads{after}", f"{before}openblas_set_num_threads{after}")
        for before in ("", "scipy_")
        for after in ("", "64_")
    ),
    ("MKL_Get_Max_Threads", "MKL_Set_Num_Threads"),
    ("omp_get_max_threads", "omp_set_num_threads"),
)


class _Number(NamedTuple):
    """Getter and setter of a library's thread count."""

    get: Callable[[], int]
    set: Callable[[int], None]


class _Limit:
    """The thread limit of this process, with a count of its holders."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._holders = 0
        self._before: list[int] = []

    def hold(self) -> None:
        with self._lock:
            if not self._holders:
                self._before = [number.get() for number in _numbers()]
            self._holders += 1
            limit_calling_thread()

    def release(self) -> None:
        with self._lock:
            self._holders -= 1
            if not self._holders:
                for number, before in zip(_numbers(), self._before):
                    number.set(before)


_limit = _Limit()


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Run linear algebra in one thread within this context."""
    hold()
    try:
        yield
    finally:
        release()


def hold() -> None:
    """Run linear algebra in one thread until each `hold` has a matching `release`."""
    _limit.hold()


def release() -> None:
    """End one `hold`; the last `release` restores the thread counts."""
    _limit.release()


def limit_calling_thread() -> None:
    """Limit the calling thread too: OpenMP has a separate thread count for each thread."""
    for number in _numbers():
        number.set(1)


@functools.cache
def _numbers() -> tuple[_Number, ...]:
    """Return the thread counts of the libraries that numpy and scipy use."""
    try:
        from threadpoolctl import ThreadpoolController
    except ImportError:
        return _search_numbers()
    import scipy.linalg  # noqa: F401  threadpoolctl sees only libraries that are loaded

    return tuple(
        _Number(library.get_num_threads, library.set_num_threads)
        for library in ThreadpoolController().lib_controllers
    )


def _search_numbers() -> tuple[_Number, ...]:
    """Find the thread counts without threadpoolctl.

    This needs a linker that searches the dependencies of a module for functions, so it does not
    work on Windows.
    """
    numbers: dict[int, _Number] = {}
    for file in _linked_modules():
        with contextlib.suppress(OSError):
            library = ctypes.CDLL(file)
            for names in _FUNCTIONS:
                if all(hasattr(library, name) for name in names):
                    get, set_to = (getattr(library, name) for name in names)
                    address = ctypes.cast(set_to, ctypes.c_void_p).value or 0
                    numbers[address] = _Number(get, set_to)
    return tuple(numbers.values())


def _linked_modules() -> list[str]:
    """Return the linear algebra modules of numpy and scipy, without importing scipy."""
    files = []
    for package, module in (("numpy", "_umath_linalg"), ("scipy", "_fblas")):
        spec = importlib.util.find_spec(package)
        for folder in (spec.submodule_search_locations or ()) if spec else ():
            files += glob.glob(os.path.join(glob.escape(folder), "linalg", f"{module}.*"))
    return files
