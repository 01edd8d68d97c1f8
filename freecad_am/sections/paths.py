# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths in job files and cell files."""

from __future__ import annotations

import os

from ..core.geometry.located import expanded, located


def absolute(file: str, path: str) -> str:
    """`file` as an absolute path; relative ones start at the folder of the job file `path`."""
    found = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(path)), expanded(file)))
    located(found)  # who collects what a job is made of is told of it
    return found
