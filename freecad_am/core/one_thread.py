# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits the linear algebra libraries below numpy and scipy to one thread.

With more threads OpenBLAS rounds differently, even for six equations, and our small matrices take
many times as long: docs/decisions/0016-one-thread.md. A process of our own gets the limit by
`ENVIRONMENT`, before it loads numpy. In FreeCAD numpy may be loaded already and other code uses it
too, so the limit is set for our work and then reset.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import glob
import importlib.machinery
import importlib.util
import os
import sys
import threading
from collections.abc import Callable, Iterator
from typing import NamedTuple

# settings of the libraries that numpy may be built on: OpenBLAS, any with OpenMP, MKL, BLIS,
# Apple's
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
# functions that get and set the number; the wheels of numpy and scipy have their own names for
# those in OpenBLAS
_NUMBERS = (
    *(
        (f"{before}openblas_get_num_threads{after}", f"{before}openblas_set_num_threads{after}")
        for before in ("", "scipy_")
        for after in ("", "64_")
    ),
    ("MKL_Get_Max_Threads", "MKL_Set_Num_Threads"),
    ("bli_thread_get_num_threads", "bli_thread_set_num_threads"),
)
_OPENMP = ("omp_get_max_threads", "omp_set_num_threads")  # the number for the calling thread only


class _Number(NamedTuple):
    """The thread limit of a library: its functions to get and set it."""

    get: Callable[[], int]
    set: Callable[[int], None]


_lock = threading.Lock()
_holders = 0
_before: list[int] = []


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Within it, and within `hold` and `release`, linear algebra runs in one thread; afterwards in as many as before."""
    hold()
    try:
        yield
    finally:
        release()


def hold() -> None:
    """From now on one thread, until `release` was called as many times as this."""
    global _holders, _before
    with _lock:
        if not _holders:
            _before = [number.get() for number in _numbers()]
        _holders += 1
        limit_calling_thread()


def release() -> None:
    """The other end of `hold`."""
    global _holders
    with _lock:
        _holders -= 1
        if not _holders:
            for number, before in zip(_numbers(), _before):
                number.set(before)


def limit_calling_thread() -> None:
    """One thread also for what the calling thread asks for: a library with OpenMP has a number for each."""
    for number in _numbers():
        number.set(1)


@functools.cache
def _numbers() -> tuple[_Number, ...]:
    """Return the thread limits of the libraries below numpy and scipy; empty if they only have one
    thread.
    """
    found: dict[int, _Number] = {}
    for file in _files():
        try:
            library = ctypes.CDLL(file)
        except OSError:
            continue
        for names in (*_NUMBERS, _OPENMP):
            # the linker looks through what the file itself depends on, too
            if all(hasattr(library, name) for name in names):
                get, set_to = (getattr(library, name) for name in names)
                found[ctypes.cast(set_to, ctypes.c_void_p).value or 0] = _Number(get, set_to)
    return tuple(found.values())


def _files() -> list[str]:
    """The modules of numpy and scipy that are linked with linear algebra, and the libraries themselves where the linker does
    not look through dependencies (Windows). scipy is not imported for it: most jobs never need its half."""
    files = []
    for package, module in (("numpy", "_umath_linalg"), ("scipy", "_fblas")):
        spec = importlib.util.find_spec(package)
        for folder in (spec.submodule_search_locations or ()) if spec else ():
            files += [
                os.path.join(folder, "linalg", module + ending)
                for ending in importlib.machinery.EXTENSION_SUFFIXES
            ]
            if os.name == "nt":
                files += glob.glob(os.path.join(glob.escape(f"{folder}.libs"), "*openblas*.dll"))
    if os.name == "nt":
        for place in {
            os.path.dirname(sys.executable),
            os.path.join(sys.prefix, "bin"),
            os.path.join(sys.prefix, "Library", "bin"),
        }:
            for name in ("*openblas*.dll", "mkl_rt*.dll"):
                files += glob.glob(os.path.join(glob.escape(place), name))
    return [file for file in files if os.path.exists(file)]
