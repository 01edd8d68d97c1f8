# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a program only its controller can show: the last lines of a preflight."""

from __future__ import annotations


def on_controller(*promises: str) -> tuple[str, ...]:
    """What has to hold on the controller, one sentence each; docs/posts says how it is set."""
    return promises
