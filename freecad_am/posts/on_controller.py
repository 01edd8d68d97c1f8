# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks of a program that only its controller can do: the last lines of a preflight."""

from __future__ import annotations


def controller_checks(*promises: str) -> tuple[str, ...]:
    """Requirements on the controller, one sentence each; docs/posts describes the settings."""
    return promises
