# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of the machines known."""

from __future__ import annotations

from freecad_am.core.kinematics import machine

from . import paths


def listing() -> str:
    """One line per machine, built in or the user's: its id for the job file and its title."""
    paths.require_freecad()
    from freecad_am.objects import user_machines

    known = machine.known(user_machines.folders())
    width = max((len(identity) for identity, _ in known), default=0)
    return "".join(f"{identity:<{width}}  {title}\n" for identity, title in known)
