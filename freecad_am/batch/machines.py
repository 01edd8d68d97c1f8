# SPDX-License-Identifier: LGPL-2.1-or-later
"""List known machines, and export a machine to formats of other programs."""

from __future__ import annotations

import math
from typing import Any

from ..core.geometry import frames
from ..core.issues import InputError
from ..core.kinematics.machines import machine
from ..objects.fields import quantities
from .host import require_freecad


def listing() -> str:
    """Return a line per built-in or user-defined machine, with its id for job files and title."""
    require_freecad()
    from freecad_am.objects import user_machines

    return _lines(machine.known(user_machines.folders()))


def chosen(maker: str | None, reach: str | None, payload: str | None, post: str | None) -> str:
    """Return the lines of `listing` for selected machines, with reach, payload and posts.

    `machine.select_machines` selects the machines. reach, payload: length and mass as user input;
    raises InputError for invalid input.
    """
    require_freecad()
    from freecad_am.core.parameters import field
    from freecad_am.objects import user_machines
    from freecad_am.posts import catalogue

    if post is not None:
        catalogue.load(post)
    min_reach = 0.0 if reach is None else quantities.read(reach, field.LENGTH, "--reach")
    entries = machine.select_machines(
        machine.entries(user_machines.folders()),
        maker,
        min_reach,
        0.0 if payload is None else _mass(payload),
        post,
    )
    return _lines([(entry.id, f"{entry.title}{_figures(entry)}") for entry in entries])


def _lines(entries: list[tuple[str, str]]) -> str:
    width = max((len(identity) for identity, _ in entries), default=0)
    return "".join(f"{identity:<{width}}  {title}\n" for identity, title in entries)


def _figures(entry: Any) -> str:
    figures = [f"reach {entry.reach:g} mm"] if entry.reach is not None else []
    figures += [f"payload {entry.payload:g} kg"] if entry.payload is not None else []
    figures += [f"post {' '.join(entry.posts)}"] if entry.posts else []
    return "".join(f", {figure}" for figure in figures)


def _mass(text: str) -> float:
    number = text.strip().removesuffix("kg").strip()
    try:
        mass = float(number)
    except ValueError:
        mass = math.nan
    if not 0.0 <= mass < math.inf:
        raise InputError(
            "BAD_VALUE", "--payload", "{!r} is not a mass; give kilograms such as 20 kg", text
        )
    return mass


def export_text(name: str, form: str) -> str:
    """Export a machine, given by id or file, as `urdf`, or as a table `dh` or `modified-dh`.

    Tables are in mm and degrees, one line per row, between the base pose and the tool pose (x y z
    and roll pitch yaw as in URDF).
    """
    require_freecad()
    from freecad_am.objects import user_machines

    machine_loaded = machine.load(name, user_machines.folders())
    if form == "urdf":
        from freecad_am.core.kinematics.urdf import text as urdf_text

        return urdf_text.text(machine_loaded)
    from freecad_am.core.kinematics.machines import denavit_hartenberg

    table = denavit_hartenberg.table_of(machine_loaded.chain, form == "modified-dh")
    joints = [
        [math.degrees(row.theta), row.d, row.a, math.degrees(row.alpha)] for row in table.rows
    ]
    lines = [f"before {_words(_pose(table.before))}", "axis theta d a alpha"]
    lines += [f"{axis} {_words(row)}" for axis, row in zip(machine_loaded.axes, joints)]
    return "\n".join([*lines, f"after {_words(_pose(table.after))}", ""])


def _pose(pose: Any) -> list[float]:
    return [
        *pose[:3, 3].tolist(),
        *(math.degrees(-angle) for angle in frames.to_bryant(pose[:3, :3].T).tolist()),
    ]


def _words(values: list[float]) -> str:
    # round off numerical noise
    return " ".join(f"{round(value, 10) + 0.0:.13g}" for value in values)
